/* SPDX-License-Identifier: MIT */
/*
 * Plots with a covariance, a height and a range rate of their own: what votes, what is fitted, and
 * what it scores.
 */
#include "initiator_east.h"
#include "straight_fit.h"

#define Z RHO_MEASURES_Z
#define RATE RHO_MEASURES_RANGE_RATE

/* ---- two axes that are nearly one ------------------------------------------------------------ */

/* Three targets in clutter; odd windows have plots with times of their own. */
static void random_window(int window, double sigma_cross_m)
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
        add_clutter(&config.area, 40);
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

static void noise_of_nearly_equal_axes_gives_what_isotropic_noise_gives(void **state)
{
    (void)state;
    static struct rho_candidate isotropic[RHO_MAX_CANDIDATES];
    int found = 0;
    for (int window = 0; window < 60; window++) {
        random_window(window, 10.0);
        unsigned n = initiator.num_candidates;
        memcpy(isotropic, initiator.candidates, sizeof isotropic);
        random_window(window, 10.00390625); /* the next that a window holds */
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

/* ---- who votes ------------------------------------------------------------------------------- */

/*
 * A target that passes (20 km, 0) northwards at 100 m/s; the plot of the scan in the middle is off
 * by that much. All measure heights, of 1000 m, and range rates as the sensor sees them.
 */
struct middle {
    double dx_m, dy_m, dz_m, rate_mps;
};

static void pass_by(struct middle off, uint32_t measures, const struct rho_sensor *sensor)
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

static int middle_votes(struct middle off, uint32_t measures, const struct rho_sensor *sensor)
{
    pass_by(off, measures, sensor);
    assert_int_equal(initiator.candidates[0].mask | 1u << 3, 0x7f); /* the others do */
    return initiator.candidates[0].mask >> 3 & 1u;
}

static void an_ellipse_takes_what_is_off_across_the_line_of_sight_alone(void **state)
{
    (void)state;
    const struct rho_sensor origin = sensor_at(0.0, 0.0);
    const struct middle along = {.dx_m = 100.0}, across = {.dy_m = 100.0};
    assert_false(middle_votes(along, 0, &origin));
    assert_true(middle_votes(across, 0, &origin));
}

static void a_sensor_elsewhere_turns_the_ellipses(void **state)
{
    (void)state;
    const struct rho_sensor south = sensor_at(20000.0, -30000.0);
    const struct rho_sensor southwest = sensor_at(-10000.0, -30000.0);
    const struct middle east_m = {.dx_m = 100.0}, north_m = {.dy_m = 100.0};
    const struct middle away = {.dx_m = 70.0, .dy_m = 70.0}, past = {.dx_m = 70.0, .dy_m = -70.0};
    assert_true(middle_votes(east_m, 0, &south));
    assert_false(middle_votes(north_m, 0, &south));
    assert_false(middle_votes(away, 0, &southwest));
    assert_true(middle_votes(past, 0, &southwest));
}

/*
 * Does the middle plot of a target that passes far from the sensor vote, so many sigmas off along
 * or across?
 */
static int votes_off(double sigmas, int is_across, double sigma_range_m, double sigma_cross_m)
{
    struct rho_initiator_config config = usual_config();
    const struct rho_sensor far = sensor_at(-800000.0, 0.0); /* lines of sight are parallel */
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

static double gate_sigmas(int is_across, double sigma_range_m, double sigma_cross_m)
{
    double low = 0.0, high = 8.0;
    for (int i = 0; i < 16; i++) {
        double middle = 0.5 * (low + high);
        *(votes_off(middle, is_across, sigma_range_m, sigma_cross_m) ? &low : &high) = middle;
    }
    assert_true(low > 3.0 && high < 7.0);
    return low;
}

static void gates_end_at_as_many_sigmas_along_and_across_as_of_isotropic_noise(void **state)
{
    (void)state;
    double isotropic = gate_sigmas(0, 15.0, 15.0);
    assert_float_equal(gate_sigmas(1, 15.0, 15.0), isotropic, 0.001);
    assert_float_equal(gate_sigmas(0, 15.0, 180.0), isotropic, 0.01);
    assert_float_equal(gate_sigmas(1, 15.0, 180.0), isotropic, 0.01);
    assert_float_equal(gate_sigmas(0, 180.0, 15.0), isotropic, 0.01);
}

static void a_plot_at_another_height_does_not_vote_where_heights_are_measured(void **state)
{
    (void)state;
    const struct rho_sensor origin = sensor_at(0.0, 0.0);
    const struct middle near = {.dz_m = 100.0}, high = {.dz_m = 400.0}, low = {.dz_m = -400.0};
    assert_true(middle_votes(near, Z, &origin));
    assert_false(middle_votes(high, Z, &origin));
    assert_false(middle_votes(low, Z, &origin));
    assert_true(middle_votes(high, 0, &origin));
}

static void a_wrong_range_rate_keeps_a_plot_from_voting(void **state)
{
    (void)state;
    const struct rho_sensor origin = sensor_at(0.0, 0.0);
    const struct middle good = {.rate_mps = 2.0}, bad = {.rate_mps = 40.0};
    assert_true(middle_votes(good, RATE, &origin));
    assert_false(middle_votes(bad, RATE, &origin));
    assert_false(middle_votes(bad, RATE | Z, &origin));
    assert_true(middle_votes(bad, 0, &origin));
}

/*
 * A range rate that fits is one of 2 v_max m/s of them: worth ln(800 / 2.5) nat a hit, less what
 * the fit takes.
 */
static void right_range_rates_raise_the_score(void **state)
{
    (void)state;
    const struct rho_sensor origin = sensor_at(0.0, 0.0);
    int32_t without, right, wrong;
    pass_by((struct middle){0}, 0, &origin);
    without = initiator.candidates[0].score_mnat;
    pass_by((struct middle){0}, RATE, &origin);
    right = initiator.candidates[0].score_mnat;
    pass_by((struct middle){.rate_mps = 2.0}, RATE, &origin);
    wrong = initiator.candidates[0].score_mnat;
    assert_true(right > without + 30000);
    assert_in_range(right - wrong, 500, 3000); /* two sigmas: 2 nat, less what the fit gives way */
}

/* Outwards at 200 m/s, 5 km up at 15 km: as if level the range rate would be 10 m/s more. */
static void a_known_height_tells_the_range_rates_of_scans_that_measure_none(void **state)
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

/* ---- fit and score against double precision -------------------------------------------------- */

static struct straight_plot seen[SCANS];

/* Integers are held exactly. */
static double random_sigma(double most)
{
    return floor(uniform(2.0, most));
}

/*
 * A random track, level where heights are not measured, and low where only some scans measure them.
 * Scan k measures what measures[k] says, every other scan is another sensor's.
 */
static void random_track(const uint32_t measures[SCANS])
{
    double rise = (measures[0] & Z) ? 1.0 : (measures[1] & Z) ? 0.1 : 0.0;
    double state[6] = {uniform(15e3, 27e3),    uniform(-8e3, 8e3),     rise * uniform(2e3, 9e3),
                       uniform(-250.0, 250.0), uniform(-250.0, 250.0), rise * uniform(-50.0, 50.0)};
    for (int k = 0; k < SCANS; k++) {
        int32_t offset_us = (int32_t)uniform(-5e5, 5e5);
        double t_s = SCAN_S * (k - SCANS + 1) + (double)(float)(offset_us * 1e-6f);
        struct rho_sensor sensor = k % 2 ? sensor_at(-7000.0, 3000.0) : sensor_at(0.0, -500.0);
        struct straight_plot *of = &seen[k];
        *of = (struct straight_plot){.t_s = t_s,
                                     .sensor_m = {sensor.x_m, sensor.y_m},
                                     .sigma_m = {random_sigma(40), random_sigma(300), 25.0},
                                     .sigma_rate_mps = random_sigma(9),
                                     .has_z = (measures[k] & Z) != 0,
                                     .has_rate = (measures[k] & RATE) != 0};
        double rate = 0.0, range2 = 0.0;
        for (int i = 0; i < 3; i++) {
            /* within a sigma along, so that all plots are in every gate */
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

static void expect_straight(void)
{
    const struct rho_candidate *track = &initiator.candidates[0];
    double area_m2 = 40e3 * 40e3, log_fisher;
    struct straight_world world = {.area_m2 = area_m2,
                                   .v_max_mps = 400.0,
                                   .pd = PD,
                                   .clutter_per_m2 = 1.0 / area_m2}; /* one plot a scan */
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

static void expect_straight_tracks(const uint32_t measures[SCANS])
{
    struct rho_initiator_config config = usual_config();
    random_state = 7;
    for (int i = 0; i < 200; i++) {
        start_initiator(&config);
        random_track(measures);
        search_window(RHO_SEARCH_BATCH);
        expect_straight();
    }
}

static void places_are_fitted_and_scored_as_in_double_precision(void **state)
{
    (void)state;
    static const uint32_t none[SCANS] = {0};
    expect_straight_tracks(none);
}

static void heights_are_fitted_and_scored_as_in_double_precision(void **state)
{
    (void)state;
    static const uint32_t all[SCANS] = {Z, Z, Z, Z, Z, Z, Z};
    static const uint32_t some[SCANS] = {Z, 0, Z, 0, 0, Z, 0}, one[SCANS] = {0, 0, Z, 0, 0, 0, 0};
    expect_straight_tracks(all);
    expect_straight_tracks(some);
    expect_straight_tracks(one); /* a single height says nothing of a climb: it does not count */
}

static void range_rates_are_fitted_and_scored_as_in_double_precision(void **state)
{
    (void)state;
    static const uint32_t all[SCANS] = {RATE, RATE, RATE, RATE, RATE, RATE, RATE};
    static const uint32_t mixed[SCANS] = {RATE, Z, Z | RATE, 0, Z | RATE, RATE, Z};
    static const uint32_t both[SCANS] = {Z | RATE, Z | RATE, Z | RATE, Z | RATE,
                                         Z | RATE, Z | RATE, Z | RATE};
    expect_straight_tracks(all);
    expect_straight_tracks(both);
    expect_straight_tracks(mixed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_of_nearly_equal_axes_gives_what_isotropic_noise_gives),
        cmocka_unit_test(an_ellipse_takes_what_is_off_across_the_line_of_sight_alone),
        cmocka_unit_test(a_sensor_elsewhere_turns_the_ellipses),
        cmocka_unit_test(gates_end_at_as_many_sigmas_along_and_across_as_of_isotropic_noise),
        cmocka_unit_test(a_plot_at_another_height_does_not_vote_where_heights_are_measured),
        cmocka_unit_test(a_wrong_range_rate_keeps_a_plot_from_voting),
        cmocka_unit_test(right_range_rates_raise_the_score),
        cmocka_unit_test(a_known_height_tells_the_range_rates_of_scans_that_measure_none),
        cmocka_unit_test(places_are_fitted_and_scored_as_in_double_precision),
        cmocka_unit_test(heights_are_fitted_and_scored_as_in_double_precision),
        cmocka_unit_test(range_rates_are_fitted_and_scored_as_in_double_precision),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
