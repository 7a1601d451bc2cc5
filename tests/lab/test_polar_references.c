/* SPDX-License-Identifier: MIT */
/*
 * What the polar experiment measures the library against: double_filter and clairvoyant_polar_fit,
 * on cases whose answers are known by hand.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "base/random.h"
#include "clairvoyant_polar.h"
#include "double_filter.h"
#include "rhotrack/track.h"

#define SEED 4711
#define PI 3.141592653589793

static const struct scenario_radar radar = {.is_used = true,
                                            .sigma_range_m = 15.0,
                                            .sigma_azimuth_rad = 0.003,
                                            .sigma_range_rate_mps = 1.0,
                                            .range_min_m = 1000.0,
                                            .range_max_m = 60000.0};

static struct scenario_radar with_range_rate(const struct scenario_radar *of)
{
    struct scenario_radar with = *of;
    with.has_range_rate = true;
    return with;
}

static struct simulated_plot plot_at(double range_m, double azimuth_rad, double range_rate_mps)
{
    return (struct simulated_plot){
        .range_m = range_m, .azimuth_rad = azimuth_rad, .range_rate_mps = range_rate_mps};
}

/* What a radar without errors sees of a target. */
static struct simulated_plot look_at(double x_m, double y_m, double vx_mps, double vy_mps)
{
    double range_m = hypot(x_m, y_m);
    return plot_at(range_m, atan2(y_m, x_m), (x_m * vx_mps + y_m * vy_mps) / range_m);
}

static void assert_near(const char *what, double value, double expected, double most)
{
    if (!(fabs(value - expected) <= most)) {
        fail_msg("%s: %.12g, expected %.12g +- %.3g", what, value, expected, most);
    }
}

/* Standard deviations and products along and across the line of sight. */
static double turned(const struct double_filter *filter, double azimuth_rad, int first,
                     int is_across)
{
    double c = is_across ? -sin(azimuth_rad) : cos(azimuth_rad);
    double s = is_across ? cos(azimuth_rad) : sin(azimuth_rad);
    return c * c * filter->covariance[first][first] +
           2.0 * c * s * filter->covariance[first][first + 1] +
           s * s * filter->covariance[first + 1][first + 1];
}

/* ---- double_filter --------------------------------------------------------------------------- */

/* A target known to stand still: the mean of n plots, with an nth of their variances. */
static void a_standing_target_is_the_mean_of_its_plots(void **state)
{
    const double range_m = 30000.0;
    (void)state;
    for (double azimuth_rad = -3.0; azimuth_rad < 3.0; azimuth_rad += 0.7) {
        struct simulated_plot plot = plot_at(range_m - 6.0, azimuth_rad, 0.0);
        struct double_filter filter = double_filter_open(&radar, 0.0, &plot, 0.0);
        for (int n = 2; n <= 9; n++) {
            double off_m = n % 2 ? -6.0 : 6.0;
            plot = plot_at(range_m + off_m, azimuth_rad, 0.0);
            double_filter_predict(&filter, 4.0 * n, 0.0);
            double_filter_update(&filter, &radar, &plot);
            double mean_m = range_m - (n % 2 ? 6.0 / n : 0.0);
            assert_near("x", filter.state[0], mean_m * cos(azimuth_rad), 1e-6);
            assert_near("y", filter.state[1], mean_m * sin(azimuth_rad), 1e-6);
            assert_near("along", turned(&filter, azimuth_rad, 0, 0), 225.0 / n, 1e-6);
            /* the first plot's range and the estimates' differ by 2e-4 */
            assert_near("across", turned(&filter, azimuth_rad, 0, 1), 8100.0 / n, 8100.0 * 1e-3);
            assert_near("speed", hypot(filter.state[2], filter.state[3]), 0.0, 1e-9);
        }
    }
}

/* Two plots and any speed: displacement over time, twice the variance over time squared. */
static void two_plots_give_a_velocity(void **state)
{
    (void)state;
    struct simulated_plot first = plot_at(30000.0, 1.0, 0.0), second = plot_at(30600.0, 1.0, 0.0);
    struct double_filter filter = double_filter_open(&radar, 10.0, &first, 1e6);
    double_filter_predict(&filter, 14.0, 0.0);
    double_filter_update(&filter, &radar, &second);
    assert_near("time", filter.t_s, 14.0, 0.0);
    assert_near("vx", filter.state[2], 150.0 * cos(1.0), 1e-3);
    assert_near("vy", filter.state[3], 150.0 * sin(1.0), 1e-3);
    assert_near("along", turned(&filter, 1.0, 0, 0), 225.0, 1e-3);
    assert_near("speed along", turned(&filter, 1.0, 2, 0), 2.0 * 225.0 / 16.0, 1e-3);
    double across_m2 = 9e-6 * (30000.0 * 30000.0 + 30600.0 * 30600.0);
    assert_near("speed across", turned(&filter, 1.0, 2, 1), across_m2 / 16.0,
                0.02 * across_m2 / 16.0);
}

/* One scalar of variance 1 against a prior of variance 100^2 about zero. */
static void a_range_rate_tells_the_speed_along_the_line_of_sight(void **state)
{
    const struct scenario_radar with = with_range_rate(&radar);
    const double share = 1e4 / (1e4 + 1.0);
    (void)state;
    struct simulated_plot plot = plot_at(30000.0, 2.5, -80.0);
    struct double_filter filter = double_filter_open(&with, 0.0, &plot, 100.0);
    assert_near("vx", filter.state[2], -80.0 * share * cos(2.5), 1e-9);
    assert_near("vy", filter.state[3], -80.0 * share * sin(2.5), 1e-9);
    assert_near("along", turned(&filter, 2.5, 2, 0), share, 1e-9);
    assert_near("across", turned(&filter, 2.5, 2, 1), 1e4, 1e-6);
    filter = double_filter_open(&radar, 0.0, &plot, 100.0);
    assert_near("without", hypot(filter.state[2], filter.state[3]), 0.0, 0.0);
    double_filter_update(&filter, &radar, &plot);
    assert_near("and later", hypot(filter.state[2], filter.state[3]), 0.0, 0.0);
    double_filter_update(&filter, &with, &plot);
    assert_near("speed", hypot(filter.state[2], filter.state[3]), 80.0 * share, 1e-6);
}

/* q [t^3/3 t^2/2; t^2/2 t], whatever the steps; back without noise. */
static void white_acceleration_adds_up(void **state)
{
    const double q = 6.25;
    struct double_filter filter = {.state = {1.0, 2.0, 3.0, 4.0}};
    (void)state;
    for (int i = 1; i <= 8; i++) {
        double_filter_predict(&filter, 0.5 * i, q);
    }
    for (int axis = 0; axis < 2; axis++) {
        assert_near("place", filter.covariance[axis][axis], q * 64.0 / 3.0, 1e-9);
        assert_near("both", filter.covariance[axis][axis + 2], q * 8.0, 1e-9);
        assert_near("and back", filter.covariance[axis + 2][axis], q * 8.0, 1e-9);
        assert_near("speed", filter.covariance[axis + 2][axis + 2], q * 4.0, 1e-9);
        assert_near("state", filter.state[axis], 1.0 + axis + 4.0 * (3.0 + axis), 1e-9);
    }
    double_filter_predict(&filter, 0.0, q);
    assert_near("noise stays", filter.covariance[2][2], q * 4.0, 1e-9);
    /* 64/3 - 2 4 8 + 16 4 = 64/3: the place 4 s ago is as uncertain as the present one was */
    assert_near("place then", filter.covariance[0][0], q * 64.0 / 3.0, 1e-9);
    assert_near("state then", filter.state[0], 1.0, 1e-9);
}

static void the_cut_of_the_azimuth_is_no_jump(void **state)
{
    (void)state;
    struct simulated_plot first = plot_at(30000.0, PI - 1e-4, 0.0);
    struct simulated_plot second = plot_at(30000.0, -PI + 1e-4, 0.0);
    struct double_filter filter = double_filter_open(&radar, 0.0, &first, 0.0);
    double_filter_update(&filter, &radar, &second);
    assert_near("x", filter.state[0], -30000.0, 0.01);
    assert_near("y", filter.state[1], 0.0, 0.01);
}

/*
 * A straight target past the radar, its plots with errors: both filters take the same, with the
 * library's noise.
 */
struct twins {
    struct rho_track track;
    struct double_filter filter;
};

static struct rho_track_plot library_plot(const struct scenario_radar *of, double t_s,
                                          const struct simulated_plot *plot)
{
    struct rho_polar_plot polar = {
        .range_m = (float)plot->range_m,
        .azimuth_rad = (float)plot->azimuth_rad,
        .range_rate_mps = (float)plot->range_rate_mps,
        .sigma_range_m = (float)of->sigma_range_m,
        .sigma_azimuth_rad = (float)of->sigma_azimuth_rad,
        .sigma_range_rate_mps = (float)of->sigma_range_rate_mps,
    };
    struct rho_track_plot made = {.time_us = llround(t_s * 1e6),
                                  .measures = of->has_range_rate ? RHO_MEASURES_RANGE_RATE : 0u};
    assert_int_equal(rho_measurement_from_polar(&polar, made.measures, NULL, &made.plot), RHO_OK);
    return made;
}

static struct simulated_plot noisy_plot(const struct scenario_radar *of, double t_s,
                                        struct random *random)
{
    double vx_mps = -120.0, vy_mps = 60.0;
    struct simulated_plot plot =
        look_at(35000.0 + vx_mps * t_s, 12000.0 + vy_mps * t_s, vx_mps, vy_mps);
    plot.range_m += of->sigma_range_m * random_normal(random);
    plot.azimuth_rad += of->sigma_azimuth_rad * random_normal(random);
    plot.range_rate_mps += of->sigma_range_rate_mps * random_normal(random);
    return plot;
}

/*
 * The filters differ where they are not linear: r sigma^2 / 2 = 0.17 m along the line of sight at
 * 37 km, an azimuth's error beside a range's, 15 m x 0.003 = 0.05 m, and how far the estimate is
 * off across where its rows are taken, e^2 / 2 r = 0.5 m for e = 200 m: up to a tenth of the
 * estimate's own sigma, 8 m along. With range rates, which turn with the line of sight, a little
 * more.
 */
static void compare(const struct twins *twins, bool has_range_rate)
{
    const struct double_filter *filter = &twins->filter;
    for (int i = 0; i < 4; i++) {
        int of = i < 2 ? i : i + 1; /* the library's states have z between */
        double sigma = sqrt(filter->covariance[i][i]);
        double variance = (double)twins->track.kalman.covariance[RHO_AT(of, of)];
        assert_near("state", (double)twins->track.kalman.state[of], filter->state[i],
                    (has_range_rate ? 0.15 : 0.1) * sigma);
        assert_near("variance", variance / filter->covariance[i][i], 1.0, 0.05);
    }
}

static void the_librarys_track_agrees(void **state)
{
    const struct rho_track_model model = {.speed_sigma_mps = 400.0f, .noise_density = 6.25f};
    (void)state;
    for (int run = 0; run < 40; run++) {
        const struct scenario_radar of = run % 2 ? with_range_rate(&radar) : radar;
        struct random random = random_start(SEED, 1, (uint64_t)run);
        struct twins twins;
        struct rho_track_plot first[2];
        for (int k = 0; k < 30; k++) {
            double t_s = 4.0 * k;
            struct simulated_plot plot = noisy_plot(&of, t_s, &random);
            struct rho_track_plot made = library_plot(&of, t_s, &plot);
            if (k == 0) {
                twins.filter = double_filter_open(&of, t_s, &plot, 400.0);
            } else {
                double_filter_predict(&twins.filter, t_s, 6.25);
                double_filter_update(&twins.filter, &of, &plot);
            }
            if (k < 2) {
                first[k] = made;
            } else {
                assert_int_equal(rho_track_update(&twins.track, &made, &model, 0), RHO_OK);
            }
            if (k == 1) {
                assert_int_equal(rho_track_start(&twins.track, 1, first, 2, &model, 0), RHO_OK);
            }
            if (k >= 5) {
                compare(&twins, of.has_range_rate);
            }
        }
    }
}

/* ---- clairvoyant_polar ----------------------------------------------------------------------- */

#define PLOTS 7

static const struct clairvoyant_model model = {.num_scans = 8,
                                               .interval_s = 4.0,
                                               .sigma_m = 30.0,
                                               .pd = 0.9,
                                               .area_m2 = 1.44e10,
                                               .v_min_mps = 20.0,
                                               .v_max_mps = 400.0};

struct sighting {
    double times_s[PLOTS];
    struct simulated_plot plots[PLOTS];
};

/* At unequal times, one turn's plot missing. */
static struct sighting sight(double x_m, double y_m, double vx_mps, double vy_mps)
{
    struct sighting seen;
    for (int i = 0; i < PLOTS; i++) {
        double t_s = 4.0 * (i < 3 ? i : i + 1) + 0.3 * (i % 3);
        seen.times_s[i] = t_s;
        seen.plots[i] = look_at(x_m + vx_mps * t_s, y_m + vy_mps * t_s, vx_mps, vy_mps);
    }
    return seen;
}

static struct clairvoyant_fit fit_of(const struct scenario_radar *of, const struct sighting *seen)
{
    struct clairvoyant_polar polar = {
        .model = &model, .radar = of, .has_range_rate = of->has_range_rate, .clutter_mean = 100.0};
    return clairvoyant_polar_fit(&polar, seen->times_s, seen->plots, PLOTS);
}

static void plots_without_errors_give_the_velocity(void **state)
{
    const struct scenario_radar with = with_range_rate(&radar);
    (void)state;
    for (int i = 0; i < 16; i++) {
        double azimuth_rad = -PI + 0.4 * i, heading_rad = 1.3 * i;
        double vx_mps = 250.0 * cos(heading_rad), vy_mps = 250.0 * sin(heading_rad);
        struct sighting seen =
            sight(30000.0 * cos(azimuth_rad), 30000.0 * sin(azimuth_rad), vx_mps, vy_mps);
        for (int rates = 0; rates < 2; rates++) {
            struct clairvoyant_fit fit = fit_of(rates ? &with : &radar, &seen);
            assert_near("vx", fit.vx_mps, vx_mps, 1e-6);
            assert_near("vy", fit.vy_mps, vy_mps, 1e-6);
            assert_near("chi-square", fit.chi2, 0.0, 1e-9);
        }
    }
}

/*
 * Plots of one range have one noise across, range x azimuth sigma. Where it is the range's sigma
 * too, noise is isotropic and the fit is the other one's, whose plots need not lie on a line for
 * that.
 */
static void where_noise_is_isotropic_the_score_is_the_isotropic_fits(void **state)
{
    struct scenario_radar even = radar;
    even.sigma_range_m = model.sigma_m;
    even.sigma_azimuth_rad = model.sigma_m / 30000.0;
    (void)state;
    for (int run = 0; run < 20; run++) {
        struct random random = random_start(SEED, 2, (uint64_t)run);
        struct sighting seen = sight(30000.0, 0.0, 0.0, 100.0);
        struct clairvoyant_plot plots[PLOTS];
        for (int i = 0; i < PLOTS; i++) {
            struct simulated_plot *plot = &seen.plots[i];
            plot->range_m = 30000.0;
            plot->azimuth_rad += 0.3 * run + even.sigma_azimuth_rad * random_normal(&random);
            plots[i] = (struct clairvoyant_plot){
                .t_s = seen.times_s[i],
                .x_m = plot->range_m * cos(plot->azimuth_rad),
                .y_m = plot->range_m * sin(plot->azimuth_rad),
                .density_per_m2 = 100.0 / (2.0 * PI * 30000.0 * 59000.0),
            };
        }
        struct clairvoyant_fit polar = fit_of(&even, &seen);
        struct clairvoyant_fit plain = clairvoyant_fit(&model, plots, PLOTS);
        assert_true(plain.chi2 > 0.1);
        assert_near("chi-square", polar.chi2, plain.chi2, 1e-6);
        assert_near("score", polar.score_nat, plain.score_nat, 1e-6);
        assert_near("vx", polar.vx_mps, plain.vx_mps, 1e-6);
        assert_near("vy", polar.vy_mps, plain.vy_mps, 1e-6);
    }
}

/* Twice the clutter is ln 2 a plot less, wherever it is; 0.9 of it at 0.9 of the range. */
static void the_score_knows_the_clutter(void **state)
{
    struct clairvoyant_polar polar = {.model = &model, .radar = &radar, .clutter_mean = 100.0};
    struct sighting seen = sight(30000.0, 10000.0, -200.0, 50.0);
    (void)state;
    double once = clairvoyant_polar_fit(&polar, seen.times_s, seen.plots, PLOTS).score_nat;
    polar.clutter_mean = 200.0;
    double twice = clairvoyant_polar_fit(&polar, seen.times_s, seen.plots, PLOTS).score_nat;
    assert_near("score", twice, once - PLOTS * log(2.0), 1e-9);
}

/*
 * Rates that say nothing, of a sigma of a million metres a second, are a density over a density and
 * leave the rest.
 */
static void vague_range_rates_change_nothing_but_their_density(void **state)
{
    struct scenario_radar vague = with_range_rate(&radar);
    vague.sigma_range_rate_mps = 1e6;
    struct sighting seen = sight(30000.0, 10000.0, -200.0, 50.0);
    (void)state;
    struct clairvoyant_fit without = fit_of(&radar, &seen), with = fit_of(&vague, &seen);
    double density = log(2.0 * 400.0) - log(1e6 * sqrt(2.0 * PI));
    assert_near("score", with.score_nat, without.score_nat + PLOTS * density, 1e-6);
    assert_near("vx", with.vx_mps, without.vx_mps, 1e-6);
}

/* What a radar sees, by the state at the middle of the plots' times. */
static void see_state(const double at[4], double t_s, double seen[3])
{
    struct simulated_plot plot = look_at(at[0] + t_s * at[2], at[1] + t_s * at[3], at[2], at[3]);
    seen[0] = plot.range_m;
    seen[1] = plot.azimuth_rad;
    seen[2] = plot.range_rate_mps;
}

/* Adds what one plot tells of the state: its derivatives by central differences. */
static void add_information(const struct scenario_radar *of, const double at[4], double t_s,
                            double information[4][4])
{
    const double sigmas[3] = {of->sigma_range_m, of->sigma_azimuth_rad, of->sigma_range_rate_mps};
    double rows[3][4];
    for (int i = 0; i < 4; i++) {
        double more[4] = {at[0], at[1], at[2], at[3]}, less[4] = {at[0], at[1], at[2], at[3]};
        double seen_more[3], seen_less[3];
        more[i] += 0.01;
        less[i] -= 0.01;
        see_state(more, t_s, seen_more);
        see_state(less, t_s, seen_less);
        for (int k = 0; k < 3; k++) {
            rows[k][i] = (seen_more[k] - seen_less[k]) / 0.02 / sigmas[k];
        }
    }
    for (int i = 0; i < 16; i++) {
        for (int k = 0; k < 3; k++) {
            information[i / 4][i % 4] += rows[k][i / 4] * rows[k][i % 4];
        }
    }
}

static double log_determinant(double matrix[4][4])
{
    double sum = 0.0;
    for (int pivot = 0; pivot < 4; pivot++) {
        sum += log(matrix[pivot][pivot]);
        for (int i = pivot + 1; i < 4; i++) {
            for (int j = 3; j >= pivot; j--) {
                matrix[i][j] -= matrix[i][pivot] / matrix[pivot][pivot] * matrix[pivot][j];
            }
        }
    }
    return sum;
}

/*
 * A fast target that passes near by: sharp range rates tell of its place too. Without errors the
 * score is the prior, the plots' own densities and the state's information.
 */
static void the_score_holds_what_range_rates_tell(void **state)
{
    struct scenario_radar sharp = with_range_rate(&radar);
    struct sighting seen = sight(9000.0, -3000.0, -150.0, 350.0);
    double middle_s = 0.5 * (seen.times_s[0] + seen.times_s[PLOTS - 1]);
    const double at[4] = {9000.0 - 150.0 * middle_s, -3000.0 + 350.0 * middle_s, -150.0, 350.0};
    double information[4][4] = {{0.0}};
    (void)state;
    sharp.sigma_range_rate_mps = 0.1;
    double expected = log(0.1) + log(0.5) - log(1.44e10 * PI * (400.0 * 400.0 - 20.0 * 20.0)) -
                      0.5 * (3.0 * PLOTS - 4.0) * log(2.0 * PI);
    for (int i = 0; i < PLOTS; i++) {
        double range_m = seen.plots[i].range_m;
        add_information(&sharp, at, seen.times_s[i] - middle_s, information);
        expected += log(0.9 * 800.0 * 2.0 * PI * range_m * 59000.0 / 100.0) -
                    log(15.0 * 0.003 * range_m * 0.1);
    }
    expected -= 0.5 * log_determinant(information);
    assert_near("score", fit_of(&sharp, &seen).score_nat, expected, 1e-5);
}

/*
 * Root mean square of the velocity's error along the line of sight, of a target that flies along
 * it.
 */
static double radial_error(const struct scenario_radar *of, double *chi2)
{
    const int runs = 1000;
    double sum = 0.0;
    *chi2 = 0.0;
    for (int run = 0; run < runs; run++) {
        struct random random = random_start(SEED, 3, (uint64_t)run);
        struct sighting seen =
            sight(40000.0 * cos(0.7), 40000.0 * sin(0.7), 150.0 * cos(0.7), 150.0 * sin(0.7));
        for (int i = 0; i < PLOTS; i++) {
            seen.plots[i].range_m += of->sigma_range_m * random_normal(&random);
            seen.plots[i].azimuth_rad += of->sigma_azimuth_rad * random_normal(&random);
            seen.plots[i].range_rate_mps += of->sigma_range_rate_mps * random_normal(&random);
        }
        struct clairvoyant_fit fit = fit_of(of, &seen);
        sum += pow(cos(0.7) * fit.vx_mps + sin(0.7) * fit.vy_mps - 150.0, 2.0) / runs;
        *chi2 += fit.chi2 / runs;
    }
    return sqrt(sum);
}

/*
 * Of a line through the ranges, and of seven rates beside. A sample's sigma spreads by 1 / sqrt(2
 * n), its mean chi-square by sqrt(2 freedom / n); four of these.
 */
static void range_rates_sharpen_the_velocity(void **state)
{
    struct scenario_radar sharp = radar;
    sharp.sigma_azimuth_rad = 1e-4; /* straight lines of sight */
    const struct scenario_radar with = with_range_rate(&sharp);
    struct sighting seen = sight(40000.0, 0.0, 0.0, 0.0);
    double mean_s = 0.0, spread_s2 = 0.0, chi2, chi2_with;
    (void)state;
    for (int i = 0; i < PLOTS; i++) {
        mean_s += seen.times_s[i] / PLOTS;
    }
    for (int i = 0; i < PLOTS; i++) {
        spread_s2 += pow(seen.times_s[i] - mean_s, 2.0);
    }
    double of_ranges = 15.0 / sqrt(spread_s2);
    double of_both = 1.0 / sqrt(1.0 / (of_ranges * of_ranges) + PLOTS);
    double without = radial_error(&sharp, &chi2), sharpened = radial_error(&with, &chi2_with);
    print_message("along the line of sight: %.3f m/s, with range rates %.3f\n", without, sharpened);
    assert_near("ranges", without / of_ranges, 1.0, 4.0 / sqrt(2000.0));
    assert_near("both", sharpened / of_both, 1.0, 4.0 / sqrt(2000.0));
    assert_near("freedom", chi2, 2.0 * PLOTS - 4.0, 4.0 * sqrt(20.0 / 1000.0));
    assert_near("with rates", chi2_with, 3.0 * PLOTS - 4.0, 4.0 * sqrt(34.0 / 1000.0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_standing_target_is_the_mean_of_its_plots),
        cmocka_unit_test(two_plots_give_a_velocity),
        cmocka_unit_test(a_range_rate_tells_the_speed_along_the_line_of_sight),
        cmocka_unit_test(white_acceleration_adds_up),
        cmocka_unit_test(the_cut_of_the_azimuth_is_no_jump),
        cmocka_unit_test(the_librarys_track_agrees),
        cmocka_unit_test(plots_without_errors_give_the_velocity),
        cmocka_unit_test(where_noise_is_isotropic_the_score_is_the_isotropic_fits),
        cmocka_unit_test(the_score_knows_the_clutter),
        cmocka_unit_test(vague_range_rates_change_nothing_but_their_density),
        cmocka_unit_test(the_score_holds_what_range_rates_tell),
        cmocka_unit_test(range_rates_sharpen_the_velocity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
