/* SPDX-License-Identifier: MIT */
#include "maintenance/scan_clutter_density.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"

#define MEMORY 0.9
#define PLOTS_MIN 0.1
#define SD_UNKNOWN 1000.0
#define AXES 3

enum quantity { PLACE, VELOCITY, RANGE_RATE, NUM_QUANTITIES };

/*
 * Scatter of plots about the mean of their scan, in one quantity (place, velocity or range rate).
 */
struct spread {
    double freedom; /* degrees of freedom: plots less one, summed over scans */
    double squares[AXES][AXES];
    /* sums over plots of their noise variances and of their number */
    double noise2[AXES], num_noise;
};

/* Faded sums over one sensor's scans. */
struct sensor_statistics {
    int32_t sensor_id;
    double scans, plots;
    struct spread spreads[NUM_QUANTITIES];
};

struct scan_clutter_density {
    struct sensor_statistics *sensors;
    size_t count, capacity;
};

struct scan_clutter_density *scan_clutter_density_new(void)
{
    return must_calloc(1, sizeof(struct scan_clutter_density));
}

void scan_clutter_density_free(struct scan_clutter_density *density)
{
    if (density) {
        free(density->sensors);
        free(density);
    }
}

static struct sensor_statistics *find_or_add_sensor(struct scan_clutter_density *density,
                                                    int32_t sensor_id)
{
    for (size_t i = 0; i < density->count; i++) {
        if (density->sensors[i].sensor_id == sensor_id) {
            return &density->sensors[i];
        }
    }
    density->sensors = must_make_room_for_one(density->sensors, density->count, &density->capacity,
                                              sizeof *density->sensors);
    density->sensors[density->count] = (struct sensor_statistics){.sensor_id = sensor_id};
    return &density->sensors[density->count++];
}

/* ---- Plots ---- */

static int num_axes_of_quantity(uint32_t measures, enum quantity quantity)
{
    if (quantity == RANGE_RATE) {
        return measures & RHO_MEASURES_RANGE_RATE ? 1 : 0;
    }
    if (quantity == VELOCITY && !(measures & RHO_MEASURES_VELOCITY)) {
        return 0;
    }
    return measures & RHO_MEASURES_Z ? 3 : 2;
}

/*
 * Gets a plot's values of a quantity, and their noise variance; of a place the larger sigma counts
 * on all axes.
 */
static void values_and_noise_of_plot(const struct rho_plot *plot, enum quantity quantity,
                                     double value[AXES], double *noise2)
{
    const double sigma[NUM_QUANTITIES] = {(double)rho_plot_sigma_m(plot), (double)plot->sigma_mps,
                                          (double)plot->sigma_range_rate_mps};
    const float values[NUM_QUANTITIES][AXES] = {{plot->x_m, plot->y_m, plot->z_m},
                                                {plot->vx_mps, plot->vy_mps, plot->vz_mps},
                                                {plot->range_rate_mps, 0.0f, 0.0f}};

    for (int i = 0; i < AXES; i++) {
        value[i] = (double)values[quantity][i];
    }
    *noise2 = sigma[quantity] * sigma[quantity];
}

static double square(double v)
{
    return v * v;
}

static size_t find_nearest_plot(const struct rho_scan *scan, const double place_m[AXES])
{
    double least = INFINITY, value[AXES], noise2;
    size_t nearest = 0;

    for (size_t i = 0; i < scan->num_plots; i++) {
        double distance2;

        values_and_noise_of_plot(&scan->plots[i], PLACE, value, &noise2);
        distance2 = square(value[0] - place_m[0]) + square(value[1] - place_m[1]);
        if (scan->measures & RHO_MEASURES_Z) {
            distance2 += square(value[2] - place_m[2]);
        }
        if (distance2 < least) {
            least = distance2;
            nearest = i;
        }
    }
    return nearest;
}

/* ---- How far they spread ---- */

static void fade_spread_sums(struct spread *spread)
{
    spread->freedom *= MEMORY;
    spread->num_noise *= MEMORY;
    for (int i = 0; i < AXES; i++) {
        spread->noise2[i] *= MEMORY;
        for (int j = 0; j < AXES; j++) {
            spread->squares[i][j] *= MEMORY;
        }
    }
}

/* Adds a scan's plots, except left_out, to the scatter about their mean (Welford's update). */
static void add_scan_to_spread(struct spread *spread, const struct rho_scan *scan,
                               enum quantity quantity, size_t left_out)
{
    double mean[AXES] = {0.0}, value[AXES], noise2, count = 0.0;

    if (scan->num_plots < 3) {
        return; /* too few plots: the former scatter stays without fading */
    }
    fade_spread_sums(spread);
    for (size_t plot = 0; plot < scan->num_plots; plot++) {
        double off[AXES];

        if (plot == left_out) {
            continue;
        }
        values_and_noise_of_plot(&scan->plots[plot], quantity, value, &noise2);
        count += 1.0;
        spread->num_noise += 1.0;
        for (int i = 0; i < AXES; i++) {
            off[i] = value[i] - mean[i];
            mean[i] += off[i] / count;
            spread->noise2[i] += noise2;
        }
        for (int i = 0; i < AXES; i++) {
            for (int j = 0; j < AXES; j++) {
                spread->squares[i][j] += off[i] * off[j] * (count - 1.0) / count;
            }
        }
    }
    spread->freedom += count - 1.0;
}

/*
 * Covariance of the scatter: variances at least those of the plots' noise, and correlations shrunk
 * where they rest on few plots.
 */
static void fill_scatter_covariance(const struct spread *spread, int axes,
                                    double covariance[AXES][AXES])
{
    double few = fmin(axes / spread->freedom, 1.0), share = 1.0 - few * few;
    double sd[AXES], old[AXES];

    for (int i = 0; i < axes; i++) {
        double noise2 = spread->num_noise > 0.0 ? spread->noise2[i] / spread->num_noise : 0.0;
        double variance = spread->squares[i][i] / spread->freedom;

        old[i] = sqrt(variance);
        sd[i] = sqrt(fmax(variance, noise2));
    }
    for (int i = 0; i < axes; i++) {
        for (int j = 0; j < axes; j++) {
            double scale = old[i] * old[j] > 0.0 ? sd[i] * sd[j] / (old[i] * old[j]) : 0.0;

            covariance[i][j] =
                i == j ? sd[i] * sd[i] : share * scale * spread->squares[i][j] / spread->freedom;
        }
    }
}

static double determinant(double a[AXES][AXES], int axes)
{
    double minor = axes < 2 ? 1.0 : a[0][0] * a[1][1] - a[0][1] * a[1][0];

    if (axes < 3) {
        return axes < 2 ? a[0][0] : minor;
    }
    return a[2][2] * minor - a[2][1] * (a[0][0] * a[1][2] - a[0][2] * a[1][0]) +
           a[2][0] * (a[0][1] * a[1][2] - a[0][2] * a[1][1]);
}

static double log_scatter_volume(const struct spread *spread, int axes)
{
    double covariance[AXES][AXES] = {{0.0}}, d = axes;
    double log_ball = d / 2.0 * log(M_PI * (d + 2.0)) - lgamma(d / 2.0 + 1.0);

    if (!(spread->freedom > 0.5)) {
        return log_ball + d * log(SD_UNKNOWN);
    }
    fill_scatter_covariance(spread, axes, covariance);
    return log_ball + 0.5 * log(determinant(covariance, axes));
}

double scan_clutter_density_add(struct scan_clutter_density *density, const struct rho_scan *scan,
                                const double place_m[3], double pd)
{
    struct sensor_statistics *seen = find_or_add_sensor(density, scan->sensor_id);
    size_t left_out = find_nearest_plot(scan, place_m);
    double log_density;

    seen->scans = seen->scans * MEMORY + 1.0;
    seen->plots = seen->plots * MEMORY + (double)scan->num_plots;
    log_density = log(fmax(seen->plots / seen->scans - pd, PLOTS_MIN));
    for (int quantity = 0; quantity < NUM_QUANTITIES; quantity++) {
        int axes = num_axes_of_quantity(scan->measures, (enum quantity)quantity);

        add_scan_to_spread(&seen->spreads[quantity], scan, (enum quantity)quantity, left_out);
        if (axes > 0) {
            log_density -= log_scatter_volume(&seen->spreads[quantity], axes);
        }
    }
    return log_density;
}
