/* SPDX-License-Identifier: MIT */
/*
 * Initiation from plots with a covariance, a height and a range rate of their own: votes, fits and
 * scores.
 */
#include "initiator_single_track_config.h"
#include "straight_fit.h"

#define Z RHO_MEASURES_Z
#define RATE RHO_MEASURES_RANGE_RATE

/* Searches three targets in clutter; in odd windows plots have their own times. */
static void search_window_of_three_targets_in_clutter(int window, double sigma_cross_m)
{
    struct rho_initiator_config config = usual_config();
    config.score_min_nat = -3.0f;
    config.area = (struct rho_extent){1000.0f, 6000.0f, -2500.0f, 2500.0f};
    random_state = (uint64_t)window + 1;
    start_initiator(&config);
    double path[3][4];
    for (int i = 0; i < 3; i++) {
        double heading = uniform(0.0, 2.0 * PI), v_mps = uniform(50.0, 350.0);
        path[i][0] = uniform(2500.0, 4500.0), path[i][1] = uniform(-1000.0, 1000.0);
        path[i][2] = v_mps * cos(heading), path[i][3] = v_mps * sin(heading);
    }
    for (int k = 0; k < SCANS; k++) {
        add_clutter_plots(&config.area, 40);
        for (int i = 0; i < 3; i++) {
            double t_s = SCAN_S * (k - 3);
            add_plot(path[i][0] + path[i][2] * t_s + 10.0 * normal(),
                     path[i][1] + path[i][3] * t_s + 10.0 * normal(), 10.0, 10.0);
        }
        for (uint32_t i = 0; i < num_plots; i++) {
            plots[i].sigma_cross_m = (float)sigma_cross_m;
            plots[i].offset_us = window % 2 ? (int32_t)uniform(0.0, 1.9e6) : 0;
        }
        push_plots(SCAN_S * k);
    }
    search_window(RHO_SEARCH_BATCH);
}

static void noise_of_nearly_equal_axes_gives_the_isotropic_result(void **state)
{
    (void)state;
    static struct rho_candidate isotropic[RHO_MAX_CANDIDATES];
    int found = 0;
    for (int window = 0; window < 60; window++) {
        search_window_of_three_targets_in_clutter(window, 10.0);
        unsigned n = initiator.num_candidates;
        memcpy(isotropic, initiator.candidates, sizeof isotropic);
        search_window_of_three_targets_in_clutter(
            window, 10.00390625); /* the next larger sigma that a window stores */
        assert_int_equal(initiator.num_candidates, n);
        for (unsigned i = 0; i < n; i++, found++) {
            const struct rho_candidate *a = &isotropic[i], *b = &initiator.candidates[i];
            assert_int_equal(a->mask, b->mask);
            assert_int_equal(a->hits, b->hits);
            assert_memory_equal(a->plot, b->plot, sizeof a->plot);
            assert_float_equal(a->score_mnat, b->score_mnat, 8.0);
            assert_float_equal(a->x_m, b->x_m, 0.05);
            assert_float_equal(a->vy_mps, b->vy_mps, 0.01);
            assert_false(b->has_z);
        }
    }
    assert_true(found > 100);
}

/*
 * Errors of the middle scan's plot. The target passes (20 km, 0) northwards at 100 m/s, at a height
 * of 1000 m, with the range rates that the sensor measures.
 */
struct middle {
    double dx_m, dy_m, dz_m, rate_mps;
};

static void search_passing_target(struct middle off, uint32_t measures,
                                  const struct rho_sensor *sensor)
{
    struct rho_initiator_config config = usual_config();
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        const struct middle by = k == 3 ? off : (struct middle){0};
        double dx_m = 20000.0 - sensor->x_m, dy_m = 100.0 * SCAN_S * (k - 3) - sensor->y_m;
        struct rho_plot *plot =
            add_plot(20000.0 + by.dx_m, 100.0 * SCAN_S * (k - 3) + by.dy_m, 15.0, 180.0);
        plot->z_m = (float)(1000.0 + by.dz_m);
        plot->sigma_up_m = 40.0f;
        plot->range_rate_mps = (float)(100.0 * dy_m / hypot(dx_m, dy_m) + by.rate_mps);
        plot->sigma_range_rate_mps = 1.0f;
        push_scan((struct rho_scan){.measures = measures}, SCAN_S * k, sensor);
    }
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, 1);
}

static int does_middle_plot_vote(struct middle off, uint32_t measures,
                                 const struct rho_sensor *sensor)
{
    search_passing_target(off, measures, sensor);
    assert_int_equal(initiator.candidates[0].mask | 1u << 3, 0x7f); /* all other plots vote */
    return initiator.candidates[0].mask >> 3 & 1u;
}

static void plots_off_across_the_line_of_sight_vote_and_off_along_do_not(void **state)
{
    (void)state;
    const struct rho_sensor origin = sensor_at(0.0, 0.0);
    const struct middle along = {.dx_m = 100.0}, across = {.dy_m = 100.0};
    assert_false(does_middle_plot_vote(along, 0, &origin));
    assert_true(does_middle_plot_vote(across, 0, &origin));
}

static void error_ellipses_turn_with_the_direction_of_the_sensor(void **state)
{
    (void)state;
    const struct rho_sensor south = sensor_at(20000.0, -30000.0);
    const struct rho_sensor southwest = sensor_at(-10000.0, -30000.0);
    const struct middle east_m = {.dx_m = 100.0}, north_m = {.dy_m = 100.0};
    const struct middle away = {.dx_m = 70.0, .dy_m = 70.0}, past = {.dx_m = 70.0, .dy_m = -70.0};
    assert_true(does_middle_plot_vote(east_m, 0, &south));
    assert_false(does_middle_plot_vote(north_m, 0, &south));
    assert_false(does_middle_plot_vote(away, 0, &southwest));
    assert_true(does_middle_plot_vote(past, 0, &southwest));
}

/*
 * True if the middle plot of a target far from the sensor votes, this many sigmas off along or
 * across the line of sight.
 */
static int does_offset_plot_vote(double sigmas, int is_across, double sigma_range_m,
                                 double sigma_cross_m)
{
    struct rho_initiator_config config = usual_config();
    const struct rho_sensor far = sensor_at(-800000.0, 0.0); /* all lines of sight are parallel */
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        double dx_m = k == 3 && !is_across ? sigmas * sigma_range_m : 0.0;
        double dy_m = k == 3 && is_across ? sigmas * sigma_cross_m : 0.0;
        add_plot(20000.0 + dx_m, 100.0 * SCAN_S * (k - 3) + dy_m, sigma_range_m, sigma_cross_m);
        push_scan((struct rho_scan){0}, SCAN_S * k, &far);
    }
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, 1);
    return initiator.candidates[0].mask >> 3 & 1u;
}

static double gate_limit_sigmas(int is_across, double sigma_range_m, double sigma_cross_m)
{
    double low = 0.0, high = 8.0;
    for (int i = 0; i < 16; i++) {
        double middle = 0.5 * (low + high);
        *(does_offset_plot_vote(middle, is_across, sigma_range_m, sigma_cross_m) ? &low : &high) =
            middle;
    }
    assert_true(low > 3.0 && high < 7.0);
    return low;
}

static void gates_end_at_the_same_number_of_sigmas_for_any_noise(void **state)
{
    (void)state;
    double isotropic = gate_limit_sigmas(0, 15.0, 15.0);
    assert_float_equal(gate_limit_sigmas(1, 15.0, 15.0), isotropic, 0.001);
    assert_float_equal(gate_limit_sigmas(0, 15.0, 180.0), isotropic, 0.01);
    assert_float_equal(gate_limit_sigmas(1, 15.0, 180.0), isotropic, 0.01);
    assert_float_equal(gate_limit_sigmas(0, 180.0, 15.0), isotropic, 0.01);
}

static void a_plot_at_another_height_does_not_vote(void **state)
{
    (void)state;
    const struct rho_sensor origin = sensor_at(0.0, 0.0);
    const struct middle near = {.dz_m = 100.0}, high = {.dz_m = 400.0}, low = {.dz_m = -400.0};
    assert_true(does_middle_plot_vote(near, Z, &origin));
    assert_false(does_middle_plot_vote(high, Z, &origin));
    assert_false(does_middle_plot_vote(low, Z, &origin));
    assert_true(does_middle_plot_vote(high, 0, &origin));
}

static void a_wrong_range_rate_keeps_a_plot_from_voting(void **state)
{
    (void)state;
    const struct rho_sensor origin = sensor_at(0.0, 0.0);
    const struct middle good = {.rate_mps = 2.0}, bad = {.rate_mps = 40.0};
    assert_true(does_middle_plot_vote(good, RATE, &origin));
    assert_false(does_middle_plot_vote(bad, RATE, &origin));
    assert_false(does_middle_plot_vote(bad, RATE | Z, &origin));
    assert_true(does_middle_plot_vote(bad, 0, &origin));
}

/*
 * A range rate of 2 v_max m/s possible ones is worth ln(800 / 2.5) nat a hit, less what the fit
 * absorbs.
 */
static void matching_range_rates_raise_the_score(void **state)
{
    (void)state;
    const struct rho_sensor origin = sensor_at(0.0, 0.0);
    int32_t without, right, wrong;
    search_passing_target((struct middle){0}, 0, &origin);
    without = initiator.candidates[0].score_mnat;
    search_passing_target((struct middle){0}, RATE, &origin);
    right = initiator.candidates[0].score_mnat;
    search_passing_target((struct middle){.rate_mps = 2.0}, RATE, &origin);
    wrong = initiator.candidates[0].score_mnat;
    assert_true(right > without + 30000);
    assert_in_range(right - wrong, 500, 3000); /* two sigmas: 2 nat, less what the fit absorbs */
}

/*
 * A target at 15 km range and 5 km height that recedes at 200 m/s. Taken as level, it would have a
 * range rate 10 m/s larger; every other scan measures no height.
 */
static void a_fitted_height_is_used_for_range_rates_of_level_scans(void **state)
{
    (void)state;
    const struct rho_sensor origin = sensor_at(0.0, 0.0);
    struct rho_initiator_config config = usual_config();
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        double x_m = 15000.0 + 200.0 * SCAN_S * k;
        struct rho_plot *plot = add_plot(x_m, 0.0, 15.0, 45.0);
        plot->z_m = 5000.0f;
        plot->sigma_up_m = 45.0f;
        plot->range_rate_mps = (float)(200.0 * x_m / hypot(x_m, 5000.0));
        plot->sigma_range_rate_mps = 1.0f;
        push_scan((struct rho_scan){.measures = k % 2 ? RATE : RATE | Z}, SCAN_S * k, &origin);
    }
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, 1);
    assert_int_equal(initiator.candidates[0].mask, 0x7f);
}

static struct straight_plot seen[SCANS];

/* Whole numbers, which a window stores exactly. */
static double random_whole_numbered_sigma(double sigma_max)
{
    return floor(uniform(2.0, sigma_max));
}

/*
 * A random track: level without heights, low if only some scans measure them. Scan k measures
 * measures[k]; two sensors take turns.
 */
static void push_random_track(const uint32_t measures[SCANS])
{
    double rise = (measures[0] & Z) ? 1.0 : (measures[1] & Z) ? 0.1 : 0.0;
    double state[6] = {uniform(15e3, 27e3),    uniform(-8e3, 8e3),     rise * uniform(2e3, 9e3),
                       uniform(-250.0, 250.0), uniform(-250.0, 250.0), rise * uniform(-50.0, 50.0)};
    for (int k = 0; k < SCANS; k++) {
        int32_t offset_us = (int32_t)uniform(-5e5, 5e5);
        double t_s = SCAN_S * (k - SCANS + 1) + (double)(float)(offset_us * 1e-6f);
        struct rho_sensor sensor = k % 2 ? sensor_at(-7000.0, 3000.0) : sensor_at(0.0, -500.0);
        struct straight_plot *of = &seen[k];
        *of = (struct straight_plot){
            .t_s = t_s,
            .sensor_m = {sensor.x_m, sensor.y_m},
            .sigma_m = {random_whole_numbered_sigma(40), random_whole_numbered_sigma(300), 25.0},
            .sigma_rate_mps = random_whole_numbered_sigma(9),
            .has_z = (measures[k] & Z) != 0,
            .has_rate = (measures[k] & RATE) != 0};
        double rate = 0.0, range2 = 0.0;
        for (int i = 0; i < 3; i++) {
            /* noise of half a sigma along, so that each plot is in its gate */
            of->at_m[i] = (float)(state[i] + state[i + 3] * t_s + of->sigma_m[0] * normal() * 0.5);
            double d_m = state[i] + state[i + 3] * t_s - of->sensor_m[i];
            rate += d_m * state[i + 3];
            range2 += d_m * d_m;
        }
        of->rate_mps = (float)(rate / sqrt(range2) + 0.5 * of->sigma_rate_mps * normal());
        struct rho_plot *plot = add_plot(of->at_m[0], of->at_m[1], of->sigma_m[0], of->sigma_m[1]);
        plot->offset_us = offset_us;
        plot->z_m = (float)of->at_m[2];
        plot->sigma_up_m = (float)of->sigma_m[2];
        plot->range_rate_mps = (float)of->rate_mps;
        plot->sigma_range_rate_mps = (float)of->sigma_rate_mps;
        push_scan((struct rho_scan){.measures = measures[k]}, SCAN_S * k, &sensor);
    }
}

static void expect_reference_state_and_score(void)
{
    const struct rho_candidate *track = &initiator.candidates[0];
    double area_m2 = 40e3 * 40e3, log_fisher;
    struct straight_world world = {.area_m2 = area_m2,
                                   .v_max_mps = 400.0,
                                   .pd = PD,
                                   /* clutter of one plot a scan */
                                   .clutter_per_m2 = 1.0 / area_m2};
    struct straight_fit fit = straight_fit_through(seen, SCANS, &log_fisher);
    assert_int_equal(initiator.num_candidates, 1);
    assert_int_equal(track->hits, SCANS);
    assert_int_equal(track->has_z, fit.axes == 3);
    const float place[6] = {track->x_m,    track->y_m,    track->z_m,
                            track->vx_mps, track->vy_mps, track->vz_mps};
    for (int i = 0; i < 6; i++) {
        assert_float_equal(place[i], fit.state[i], i < 3 ? 0.1 : 0.02);
    }
    assert_float_equal(track->score_mnat * 1e-3, straight_score(&world, &fit, SCANS, log_fisher),
                       fit.rates ? 0.02 : 0.003);
}

static void compare_random_tracks(const uint32_t measures[SCANS])
{
    struct rho_initiator_config config = usual_config();
    random_state = 7;
    for (int i = 0; i < 200; i++) {
        start_initiator(&config);
        push_random_track(measures);
        search_window(RHO_SEARCH_BATCH);
        expect_reference_state_and_score();
    }
}

static void fits_of_places_agree_with_double_precision(void **state)
{
    (void)state;
    static const uint32_t none[SCANS] = {0};
    compare_random_tracks(none);
}

static void fits_of_heights_agree_with_double_precision(void **state)
{
    (void)state;
    static const uint32_t all[SCANS] = {Z, Z, Z, Z, Z, Z, Z};
    static const uint32_t some[SCANS] = {Z, 0, Z, 0, 0, Z, 0}, one[SCANS] = {0, 0, Z, 0, 0, 0, 0};
    compare_random_tracks(all);
    compare_random_tracks(some);
    compare_random_tracks(one); /* one height alone tells no climb and does not count */
}

static void fits_of_range_rates_agree_with_double_precision(void **state)
{
    (void)state;
    static const uint32_t all[SCANS] = {RATE, RATE, RATE, RATE, RATE, RATE, RATE};
    static const uint32_t mixed[SCANS] = {RATE, Z, Z | RATE, 0, Z | RATE, RATE, Z};
    static const uint32_t both[SCANS] = {Z | RATE, Z | RATE, Z | RATE, Z | RATE,
                                         Z | RATE, Z | RATE, Z | RATE};
    compare_random_tracks(all);
    compare_random_tracks(both);
    compare_random_tracks(mixed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_of_nearly_equal_axes_gives_the_isotropic_result),
        cmocka_unit_test(plots_off_across_the_line_of_sight_vote_and_off_along_do_not),
        cmocka_unit_test(error_ellipses_turn_with_the_direction_of_the_sensor),
        cmocka_unit_test(gates_end_at_the_same_number_of_sigmas_for_any_noise),
        cmocka_unit_test(a_plot_at_another_height_does_not_vote),
        cmocka_unit_test(a_wrong_range_rate_keeps_a_plot_from_voting),
        cmocka_unit_test(matching_range_rates_raise_the_score),
        cmocka_unit_test(a_fitted_height_is_used_for_range_rates_of_level_scans),
        cmocka_unit_test(fits_of_places_agree_with_double_precision),
        cmocka_unit_test(fits_of_heights_agree_with_double_precision),
        cmocka_unit_test(fits_of_range_rates_agree_with_double_precision),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
