/* SPDX-License-Identifier: MIT */
/* nearest_plot: held scans and plots of a window, their bins, the plot nearest to a place. */
#include "policy.h"
#include "rhotrack/detail/measurement.h"
#include "rhotrack/detail/window.h"
#include "sigma_code.h"

float rho_window_decode_sigma(uint16_t code)
{
    return sigma_of_code(code);
}

float rho_window_larger_sigma_m(const struct rho_window_plot *plot)
{
    return sigma_of_code(larger_sigma_code(plot));
}

struct rho_window_scan *rho_window_scan_at(struct rho_window *window, unsigned m)
{
    const unsigned place = window->first + m;
    return &window->ring[place < window->scans_max ? place : place - window->scans_max];
}

static int column_at(const struct rho_window_scan *scan, float x_m)
{
    return rho_cell_at((x_m - scan->bin_x0_m) * scan->bins_per_m_x, scan->bins_x);
}

static int row_at(const struct rho_window_scan *scan, float y_m)
{
    return rho_cell_at((y_m - scan->bin_y0_m) * scan->bins_per_m_y, scan->bins_y);
}

unsigned rho_window_bin_at(const struct rho_window_scan *scan, float x_m, float y_m)
{
    return (unsigned)(row_at(scan, y_m) * scan->bins_x + column_at(scan, x_m));
}

struct rho_window_bins rho_window_bins_under(const struct rho_window_scan *scan,
                                             const struct rho_extent *under)
{
    return (struct rho_window_bins){column_at(scan, under->x_min_m),
                                    column_at(scan, under->x_max_m), row_at(scan, under->y_min_m),
                                    row_at(scan, under->y_max_m)};
}

/* Bins under a gate that moves with the plots' offsets from the scan's time. */
static struct rho_window_bins bins_around_gate(const struct rho_window_scan *scan,
                                               const struct rho_window_place *place)
{
    const float first_s = scan->offset_min_s, last_s = scan->offset_max_s;
    const float x_m = place->x_m, vx_mps = place->vx_mps, y_m = place->y_m, vy_mps = place->vy_mps;
    const float radius_m = place->gate_radius_m;
    const struct rho_extent around = {x_m - radius_m + vx_mps * (vx_mps > 0.0f ? first_s : last_s),
                                      x_m + radius_m + vx_mps * (vx_mps > 0.0f ? last_s : first_s),
                                      y_m - radius_m + vy_mps * (vy_mps > 0.0f ? first_s : last_s),
                                      y_m + radius_m + vy_mps * (vy_mps > 0.0f ? last_s : first_s)};
    return rho_window_bins_under(scan, &around);
}

static void count_lookup(struct rho_window_work *work, const struct rho_window_bins *bins,
                         unsigned compared, unsigned more_units)
{
    work->lookups = rho_count(work->lookups, 1);
    work->distances = rho_count(work->distances, compared);
    work->passed =
        rho_count(work->passed, (uint32_t)(bins->row_last - bins->row_first) + 1u + more_units);
}

int rho_window_nearest_isotropic(const struct rho_window_scan *scan,
                                 const struct rho_window_place *place, float gate_chi2,
                                 struct rho_window_work *work)
{
    const struct rho_window_bins bins = bins_around_gate(scan, place);
    /*
     * distance2 / variance is compared by cross-multiplication. The limit itself is the first
     * bound: a plot exactly on the gate counts as outside
     */
    float best_m2 = gate_chi2, best_variance_m2 = 1.0f;
    int index = -1;
    unsigned compared = 0;
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned from = start[bins.column_first], to = start[bins.column_last + 1];
        for (unsigned i = from; i < to; i++) {
            const struct rho_window_plot *plot = &scan->plots[i];
            float dx_m = plot->x_m - place->x_m - place->vx_mps * plot->offset_s;
            float dy_m = plot->y_m - place->y_m - place->vy_mps * plot->offset_s;
            float distance2_m2 = dx_m * dx_m + dy_m * dy_m;
            float sigma_m = rho_window_larger_sigma_m(plot);
            float variance_m2 = place->noise.xx_m2 + place->factor * sigma_m * sigma_m;
            if (distance2_m2 * best_variance_m2 < best_m2 * variance_m2 &&
                !(scan->marks[i] & place->skip_flags)) {
                index = (int)i;
                best_m2 = distance2_m2;
                best_variance_m2 = variance_m2;
            }
        }
        compared += to - from;
    }
    count_lookup(work, &bins, compared, 0);
    return index;
}

const struct rho_sensor *rho_window_sensor_if_described(const struct rho_window_scan *scan)
{
    return scan->sensor.pd > 0.0f ? &scan->sensor : 0;
}

struct rho_plot rho_window_unpack_plot(const struct rho_window_scan *scan, unsigned index)
{
    const struct rho_window_plot *held = &scan->plots[index];
    struct rho_plot plot = {
        .offset_us = (int32_t)(held->offset_s * 1e6f + (held->offset_s < 0.0f ? -0.5f : 0.5f)),
        .x_m = held->x_m,
        .y_m = held->y_m,
        .z_m = held->z_m,
        .range_rate_mps = held->range_rate_mps,
        .sigma_range_m = rho_window_decode_sigma(held->sigma_range),
        .sigma_cross_m = rho_window_decode_sigma(held->sigma_cross),
        .sigma_up_m = rho_window_decode_sigma(held->sigma_up),
        .sigma_range_rate_mps = rho_window_decode_sigma(held->sigma_range_rate),
    };
    return plot;
}

static float squared_sigma_of_code(uint16_t code)
{
    return rho_square(rho_window_decode_sigma(code));
}

struct rho_window_plot_noise rho_window_plot_noise(const struct rho_window_scan *scan,
                                                   const struct rho_window_plot *plot)
{
    float dx_m = plot->x_m - scan->sensor.x_m, dy_m = plot->y_m - scan->sensor.y_m;
    float ground2_m2 = dx_m * dx_m + dy_m * dy_m;
    float along_m2 = squared_sigma_of_code(plot->sigma_range),
          cross_m2 = squared_sigma_of_code(plot->sigma_cross);
    struct rho_window_plot_noise noise = {.zz_m2 = squared_sigma_of_code(plot->sigma_up)};
    if (!(ground2_m2 >= RANGE_LEAST_M2)) {
        noise.xx_m2 = noise.yy_m2 = along_m2 > cross_m2 ? along_m2 : cross_m2;
        return noise;
    }
    if (scan->measures & RHO_MEASURES_Z) {
        float dz_m = plot->z_m - scan->sensor.z_m;
        float rise = dz_m * dz_m / (ground2_m2 + dz_m * dz_m); /* sin^2 of the elevation */
        float up_m2 = noise.zz_m2;
        noise.zz_m2 = up_m2 + rise * (along_m2 - up_m2);
        along_m2 += rise * (up_m2 - along_m2);
    }
    float per_m2 = 1.0f / ground2_m2, xx = dx_m * dx_m * per_m2, yy = dy_m * dy_m * per_m2;
    /* allowance for rounding, so that thin ellipses stay positive definite */
    float allowance_m2 = (along_m2 > cross_m2 ? along_m2 : cross_m2) * (1.0f / 4194304.0f);
    noise.xx_m2 = xx * along_m2 + yy * cross_m2 + allowance_m2;
    noise.xy_m2 = (along_m2 - cross_m2) * dx_m * dy_m * per_m2;
    noise.yy_m2 = yy * along_m2 + xx * cross_m2 + allowance_m2;
    return noise;
}

int rho_window_compare_range_rate(const struct rho_window_scan *scan,
                                  const struct rho_window_plot *plot,
                                  const struct rho_window_place *place,
                                  struct rho_window_range_rate *seen)
{
    /* scans without heights: the height of the place gives the elevation of the line of sight */
    float z_m =
        scan->measures & RHO_MEASURES_Z ? plot->z_m : place->z_m + place->vz_mps * plot->offset_s;
    float state[6] = {plot->x_m,
                      plot->y_m,
                      z_m,
                      place->vx_mps + place->ax_mps2 * plot->offset_s,
                      place->vy_mps + place->ay_mps2 * plot->offset_s,
                      place->vz_mps};
    const struct rho_window_plot_noise *noise = &place->velocity_noise;
    float row[6], rate_mps;
    for (int i = 0; i < 3 && RHO_AMBIGUOUS_RANGE_RATES; i++) {
        state[i + 3] += place->more_mps[i];
    }
    if (!rho_measurement_predict_rate(state, &scan->sensor, place->has_z, row, &rate_mps)) {
        return 0;
    }
    /* derivatives of the range rate by position, and by velocity */
    const float *turn = row, *u = row + 3;
    seen->error_mps = rho_measurement_innovation_mps(&scan->sensor, plot->range_rate_mps, rate_mps);
    float turned2 = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    seen->variance = place->factor * (squared_sigma_of_code(plot->sigma_range_rate) +
                                      turned2 * squared_sigma_of_code(larger_sigma_code(plot))) +
                     noise->xx_m2 * u[0] * u[0] + 2.0f * noise->xy_m2 * u[0] * u[1] +
                     noise->yy_m2 * u[1] * u[1] + noise->zz_m2 * u[2] * u[2];
    for (int i = 0; i < 3; i++) {
        seen->along[i] = u[i];
    }
    return 1;
}

float rho_window_range_rate_nis(const struct rho_window_scan *scan,
                                const struct rho_window_plot *plot,
                                const struct rho_window_place *place)
{
    struct rho_window_range_rate seen;
    return rho_window_compare_range_rate(scan, plot, place, &seen)
               ? seen.error_mps * seen.error_mps / seen.variance
               : 0.0f;
}

/*
 * NIS of a plot about a place: position, and height and range rate where measured. Returns `limit`
 * or more as soon as that is certain.
 */
static float nis_of_plot(const struct rho_window_scan *scan, const struct rho_window_plot *plot,
                         const struct rho_window_place *place, float limit)
{
    float t_s = plot->offset_s;
    float dx_m = plot->x_m - place->x_m - (place->vx_mps + 0.5f * place->ax_mps2 * t_s) * t_s;
    float dy_m = plot->y_m - place->y_m - (place->vy_mps + 0.5f * place->ay_mps2 * t_s) * t_s;
    if (dx_m * dx_m + dy_m * dy_m > place->gate_radius_m * place->gate_radius_m) {
        return limit;
    }
    struct rho_window_plot_noise noise = rho_window_plot_noise(scan, plot);
    float xx = place->noise.xx_m2 + place->factor * noise.xx_m2;
    float xy = place->noise.xy_m2 + place->factor * noise.xy_m2;
    float yy = place->noise.yy_m2 + place->factor * noise.yy_m2;
    float scaled = yy * dx_m * dx_m - 2.0f * xy * dx_m * dy_m + xx * dy_m * dy_m;
    float determinant = xx * yy - xy * xy;
    if (!(scaled < limit * determinant)) {
        return limit;
    }
    float distance2 = scaled / determinant;
    if ((scan->measures & RHO_MEASURES_Z) && place->has_z) {
        float dz_m = plot->z_m - place->z_m - place->vz_mps * plot->offset_s;
        distance2 += dz_m * dz_m / (place->noise.zz_m2 + place->factor * noise.zz_m2);
    }
    if ((scan->measures & RHO_MEASURES_RANGE_RATE) && distance2 < limit) {
        distance2 += rho_window_range_rate_nis(scan, plot, place);
    }
    return distance2;
}

int rho_window_nearest_plot(const struct rho_window_scan *scan,
                            const struct rho_window_place *place, struct rho_window_work *work)
{
    const struct rho_window_bins bins = bins_around_gate(scan, place);
    const int more = ((scan->measures & RHO_MEASURES_Z) && place->has_z ? 1 : 0) +
                     ((scan->measures & RHO_MEASURES_RANGE_RATE) ? 1 : 0);
    float best = more == 0 ? RHO_GATE_CHI2_2D : more == 1 ? RHO_GATE_CHI2_3D : RHO_GATE_CHI2_4D;
    int index = -1;
    unsigned compared = 0;
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned from = start[bins.column_first], to = start[bins.column_last + 1];
        for (unsigned i = from; i < to; i++) {
            float distance2 = nis_of_plot(scan, &scan->plots[i], place, best);
            if (distance2 < best && !(scan->marks[i] & place->skip_flags)) {
                best = distance2;
                index = (int)i;
            }
        }
        compared += to - from;
    }
    /* a comparison by a plot's own covariance costs two units more than a simple one */
    count_lookup(work, &bins, compared, 2u * compared);
    return index;
}
