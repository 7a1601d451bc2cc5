/* SPDX-License-Identifier: MIT */
/*
 * The resolution cell of a sensor: pairs of targets within the stated cell share a plot; if none
 * was stated, its size is learned from pairs that share plots or have their own.
 */
#include "rhotrack/snapshot.h"
#include "tracker_setup.h"

#if RHO_SHARES_PLOTS

#define SENSOR 1
#define SIGMA_M 50.0
/* metres east of the sensor, so that ranges are along x and azimuths along y */
#define AT_M 50000.0
#define SPEED_MPS 50.0
#define APART_M 1000.0
#define APPROACH 60
#define BESIDE 80 /* scans: from APPROACH to here the pair flies side by side */

static struct rho_sensor radar;

static void set_radar(uint64_t seed)
{
    use_usual_configs(seed);
    config.pd = initiation.pd = 0.95f;
    radar = (struct rho_sensor){.sensor_id = SENSOR, .pd = 0.95f, .range_max_m = 2e5f};
}

static void start_tracker(void)
{
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
}

static void step_scan_at(int k)
{
    step_scan((struct rho_scan){.time_us = INT64_C(1000000) * k, .sensor_id = SENSOR});
}

/* Half the distance of the pair: from APART_M down to apart_m, which it then keeps. */
static double half_gap_at(int k, double apart_m)
{
    const double left = k < APPROACH ? 1.0 - (double)k / APPROACH : 0.0;
    return 0.5 * (apart_m + (APART_M - apart_m) * left * left * (3.0 - 2.0 * left));
}

/* A pair that flies north-east, separated in range or in azimuth; seen as two plots or as one. */
static void see_pair(int k, double half_m, int in_range, int as_one)
{
    const double x_m = AT_M + 5.0 * k, y_m = SPEED_MPS * k - 5000.0;
    for (int side = -1; side <= 1; side += 2) {
        const double off_m = as_one ? 0.0 : side * half_m;
        if (as_one && side > 0) {
            continue;
        }
        add_noisy_plot(x_m + (in_range ? off_m : 0.0), y_m + (in_range ? 0.0 : off_m), SIGMA_M);
    }
}

static unsigned count_merged_pairs(void)
{
    unsigned count = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        for (unsigned k = i + 1; k < report.num_tracks; k++) {
            count += report.tracks[i].plot >= 0 && report.tracks[i].plot == report.tracks[k].plot;
        }
    }
    return count;
}

/*
 * The pair closes in; then there is one plot, in the middle or of the first target alone. Returns
 * scans in which both tracks shared it.
 */
static unsigned count_merged_scans_at(double apart_m, int in_range, int is_of_both, int scans)
{
    unsigned shared = 0;
    start_tracker();
    for (int k = 0; k < BESIDE + scans; k++) {
        see_pair(k, half_gap_at(k, apart_m), in_range, k >= BESIDE && is_of_both);
        num_plots -= k >= BESIDE && !is_of_both;
        step_scan_at(k);
        shared += k >= BESIDE ? count_merged_pairs() : 0;
    }
    return shared;
}

static void targets_within_the_stated_cell_share_a_plot(void **state)
{
    (void)state;
    for (int in_range = 0; in_range <= 1; in_range++) {
        unsigned wide = 0, narrow = 0;
        for (uint64_t seed = 1; seed <= 10; seed++) {
            set_radar(seed);
            radar.resolution_range_m = in_range ? 600.0f : 50.0f;
            radar.resolution_azimuth_rad = in_range ? 0.001f : 600.0f / (float)AT_M;
            wide += count_merged_scans_at(150.0, in_range, 0, 4);
            set_radar(seed);
            radar.resolution_range_m = 50.0f;
            radar.resolution_azimuth_rad = 0.001f;
            narrow += count_merged_scans_at(150.0, in_range, 0, 4);
        }
        print_message("%s: %u and %u of 40 shared\n", in_range ? "range" : "azimuth", wide, narrow);
        assert_true(wide >= 28);
        assert_true(narrow <= 18);
    }
}

/* One target overtakes the other; while range rates resolve them, they are never seen as one. */
static unsigned count_merged_scans_overtaking(float cell_mps)
{
    unsigned shared = 0;
    set_radar(7);
    radar.resolution_range_m = 600.0f;
    radar.resolution_azimuth_rad = 0.02f;
    radar.resolution_range_rate_mps = cell_mps;
    start_tracker();
    for (int k = 0; k < 60; k++) {
        for (int side = -1; side <= 1; side += 2) {
            const double speed_mps = 150.0 + 2.0 * side;
            if (k >= 28 && k <= 32 && side > 0) {
                continue; /* a missed detection */
            }
            add_noisy_plot(AT_M + speed_mps * (k - 30), 10.0 * side, SIGMA_M);
            plots[num_plots - 1u].range_rate_mps = (float)speed_mps;
            plots[num_plots - 1u].sigma_range_rate_mps = 2.0f;
        }
        step_scan((struct rho_scan){.time_us = INT64_C(1000000) * k,
                                    .sensor_id = SENSOR,
                                    .measures = RHO_MEASURES_RANGE_RATE});
        shared += count_merged_pairs();
    }
    return shared;
}

static void targets_of_different_range_rates_share_no_plot(void **state)
{
    (void)state;
    assert_true(count_merged_scans_overtaking(0.0f) >= 3);
    assert_int_equal(count_merged_scans_overtaking(0.5f), 0);
}

/* ---- the learned cell ------------------------------------------------------------------------ */

static struct rho_tracker_known known_of_sensor(void)
{
    struct rho_tracker_known is;
    assert_int_equal(rho_tracker_known_of(&tracker, SENSOR, &is), RHO_OK);
    return is;
}

static void an_unstated_resolution_cell_is_learned(void **state)
{
    (void)state;
    for (int in_range = 0; in_range <= 1; in_range++) {
        set_radar(3);
        (void)count_merged_scans_at(250.0, in_range, 1, 60);
        const struct rho_tracker_known wide = known_of_sensor();
        set_radar(3);
        start_tracker();
        for (int k = 0; k < APPROACH + 200; k++) {
            see_pair(k, half_gap_at(k, 100.0), in_range, 0);
            step_scan_at(k);
        }
        const struct rho_tracker_known narrow = known_of_sensor();
        const float learned[2] = {
            in_range ? wide.resolution_range_sigmas : wide.resolution_cross_sigmas,
            in_range ? narrow.resolution_range_sigmas : narrow.resolution_cross_sigmas};
        print_message("seen as one at 5 sigmas: %.2f sigmas; as two at 2: %.2f\n",
                      (double)learned[0], (double)learned[1]);
        assert_true(learned[0] > 2.6f && learned[0] < 8.0f);
        assert_true(learned[1] > 0.3f && learned[1] < 1.8f);
    }
}

/* The learned cell on one axis: logarithm nat and weight. */
struct cell {
    double nat, weight;
};

/* Both targets have plots: Fisher scoring of ln(1 - p), in double precision. */
static void update_expected_cell_by_resolved_pair(struct cell cell[2], const double apart_m2[2])
{
    double q[2], all = 0.0;
    for (int axis = 0; axis < 2; axis++) {
        q[axis] = apart_m2[axis] / (2.0 * 4.0 * SIGMA_M * SIGMA_M * exp(cell[axis].nat));
        all += q[axis];
    }
    const double p = exp(-all), odds = p / (1.0 - p);
    for (int axis = 0; axis < 2; axis++) {
        cell[axis].weight = fmin(cell[axis].weight + odds * q[axis] * q[axis], 200.0);
        cell[axis].nat -= odds * q[axis] / (4.0 + cell[axis].weight);
    }
}

static void the_cell_is_learned_by_fisher_scoring(void **state)
{
    unsigned noted = 0, full = 0;
    (void)state;
    set_radar(5);
    config.learn_noise_min = config.learn_noise_max = 1.0f;
    start_tracker();
    for (int k = 0; k < 6000; k++) {
        struct rho_tracker_learned *learned = &tracker.sensors[0].learned;
        const double half_m = half_gap_at(k, 160.0);
        if (k > APPROACH) {
            /* the cell as if pairs had been seen as one in between */
            learned->log_cell[0] = learned->log_cell[1] = 0.4f;
        }
        struct cell cell[2];
        for (int axis = 0; axis < 2; axis++) {
            cell[axis] =
                (struct cell){(double)learned->log_cell[axis], (double)learned->cell_weight[axis]};
        }
        see_pair(k % 1000, half_m, 0, 0);
        const double x_m = (double)plots[0].x_m - (double)plots[1].x_m,
                     y_m = (double)plots[0].y_m - (double)plots[1].y_m,
                     at_y_m = (double)plots[0].y_m, at_x_m = (double)plots[0].x_m;
        const double range_m = hypot(at_x_m, at_y_m), c = at_x_m / range_m, s = at_y_m / range_m;
        const double apart_m2[2] = {pow(c * x_m + s * y_m, 2.0), pow(c * y_m - s * x_m, 2.0)};
        step_scan_at(k);
        if (k % 1000 < APPROACH || learned->cell_weight[1] <= 0.0f || count_merged_pairs() > 0 ||
            (double)learned->log_cell[1] == cell[1].nat) {
            continue;
        }
        update_expected_cell_by_resolved_pair(cell, apart_m2);
        for (int axis = 0; axis < 2; axis++) {
            assert_true(fabs((double)learned->log_cell[axis] - cell[axis].nat) < 1e-3);
            assert_true(fabs((double)learned->cell_weight[axis] - cell[axis].weight) < 1e-2);
        }
        full += learned->cell_weight[1] >= 200.0f;
        noted++;
    }
    print_message("%u noted, %u with all that is remembered\n", noted, full);
    assert_true(noted > 300);
    assert_true(full > 30);
}

/* ---- cells that are refused ------------------------------------------------------------------ */

static void bad_resolution_cells_are_refused(void **state)
{
    static const float wrong[] = {-1.0f, NAN, INFINITY};
    (void)state;
    set_radar(1);
    start_tracker();
    for (size_t i = 0; i < 3; i++) {
        float *fields[] = {&radar.resolution_range_m, &radar.resolution_azimuth_rad,
                           &radar.resolution_range_rate_mps};
        for (size_t f = 0; f < 3; f++) {
            *fields[f] = wrong[i];
            assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_ERROR_CONFIG);
            *fields[f] = 0.0f;
        }
    }
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
}

static void invalid_learned_cells_make_a_tracker_unsound(void **state)
{
    (void)state;
    set_radar(1);
    start_tracker();
    assert_true(rho_tracker_is_sound(&tracker));
    static const struct {
        float nat, weight;
    } wrong[] = {{NAN, 1.0f}, {4.3f, 1.0f}, {-4.3f, 1.0f}, {0.0f, -1.0f}, {0.0f, 201.0f}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        for (int axis = 0; axis < 2; axis++) {
            tracker.sensors[0].learned.log_cell[axis] = wrong[i].nat;
            tracker.sensors[0].learned.cell_weight[axis] = wrong[i].weight;
            assert_false(rho_tracker_is_sound(&tracker));
            tracker.sensors[0].learned.log_cell[axis] =
                tracker.sensors[0].learned.cell_weight[axis] = 0.0f;
        }
    }
    tracker.sensors[0].learned.log_cell[0] = -4.1f;
    tracker.sensors[0].learned.log_cell[1] = 4.1f;
    tracker.sensors[0].learned.cell_weight[0] = 199.0f;
    assert_true(rho_tracker_is_sound(&tracker));
    /* 2.355 sigmas is the unit of the logarithm */
    assert_true(fabs((double)known_of_sensor().resolution_range_sigmas - 2.35482 * exp(-2.05)) <
                1e-3);
    assert_true(known_of_sensor().resolution_cross_sigmas ==
                0.0f); /* weight 0 reads as not learned */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(targets_within_the_stated_cell_share_a_plot),
        cmocka_unit_test(targets_of_different_range_rates_share_no_plot),
        cmocka_unit_test(an_unstated_resolution_cell_is_learned),
        cmocka_unit_test(the_cell_is_learned_by_fisher_scoring),
        cmocka_unit_test(bad_resolution_cells_are_refused),
        cmocka_unit_test(invalid_learned_cells_make_a_tracker_unsound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
