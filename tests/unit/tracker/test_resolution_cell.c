/* SPDX-License-Identifier: MIT */
/*
 * The resolution cell of a sensor: pairs share a plot within the one that was stated, and where
 * none was, pairs that share plots or have their own say how large it is.
 */
#include "rhotrack/snapshot.h"
#include "tracker_setup.h"

#if RHO_SHARES_PLOTS

#define SENSOR 1
#define SIGMA_M 50.0
#define AT_M 50000.0 /* east of the sensor: ranges along x, azimuths along y */
#define SPEED_MPS 50.0
#define APART_M 1000.0
#define APPROACH 60
#define BESIDE 80 /* from APPROACH to here they fly beside each other */

static struct rho_sensor radar;

static void begin_radar(uint64_t seed)
{
    use_usual_configs(seed);
    config.pd = initiation.pd = 0.95f;
    radar = (struct rho_sensor){.sensor_id = SENSOR, .pd = 0.95f, .range_max_m = 2e5f};
}

static void begin_pair(void)
{
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
}

static void look(int k)
{
    step_scan((struct rho_scan){.time_us = INT64_C(1000000) * k, .sensor_id = SENSOR});
}

/* Half of what lies between both: from APART_M to apart_m, and so on. */
static double half_m_at(int k, double apart_m)
{
    const double left = k < APPROACH ? 1.0 - (double)k / APPROACH : 0.0;
    return 0.5 * (apart_m + (APART_M - apart_m) * left * left * (3.0 - 2.0 * left));
}

/* Both fly north-east of each other, in range or in azimuth; seen as two, or as one. */
static void see(int k, double half_m, int in_range, int as_one)
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

static unsigned shares(void)
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
 * They come near each other; then there is one plot, in the middle or of the first one alone.
 * Returns scans in which they shared it.
 */
static unsigned merge_at(double apart_m, int in_range, int is_of_both, int scans)
{
    unsigned shared = 0;
    begin_pair();
    for (int k = 0; k < BESIDE + scans; k++) {
        see(k, half_m_at(k, apart_m), in_range, k >= BESIDE && is_of_both);
        num_plots -= k >= BESIDE && !is_of_both;
        look(k);
        shared += k >= BESIDE ? shares() : 0;
    }
    return shared;
}

static void two_within_the_stated_cell_share_a_plot(void **state)
{
    (void)state;
    for (int in_range = 0; in_range <= 1; in_range++) {
        unsigned wide = 0, narrow = 0;
        for (uint64_t seed = 1; seed <= 10; seed++) {
            begin_radar(seed);
            radar.resolution_range_m = in_range ? 600.0f : 50.0f;
            radar.resolution_azimuth_rad = in_range ? 0.001f : 600.0f / (float)AT_M;
            wide += merge_at(150.0, in_range, 0, 4);
            begin_radar(seed);
            radar.resolution_range_m = 50.0f;
            radar.resolution_azimuth_rad = 0.001f;
            narrow += merge_at(150.0, in_range, 0, 4);
        }
        print_message("%s: %u and %u of 40 shared\n", in_range ? "range" : "azimuth", wide, narrow);
        assert_true(wide >= 28);
        assert_true(narrow <= 18);
    }
}

/* One overtakes the other; they are never seen as one where range rates tell them apart. */
static unsigned overtake(float cell_mps)
{
    unsigned shared = 0;
    begin_radar(7);
    radar.resolution_range_m = 600.0f;
    radar.resolution_azimuth_rad = 0.02f;
    radar.resolution_range_rate_mps = cell_mps;
    begin_pair();
    for (int k = 0; k < 60; k++) {
        for (int side = -1; side <= 1; side += 2) {
            const double speed_mps = 150.0 + 2.0 * side;
            if (k >= 28 && k <= 32 && side > 0) {
                continue; /* a miss */
            }
            add_noisy_plot(AT_M + speed_mps * (k - 30), 10.0 * side, SIGMA_M);
            plots[num_plots - 1u].range_rate_mps = (float)speed_mps;
            plots[num_plots - 1u].sigma_range_rate_mps = 2.0f;
        }
        step_scan((struct rho_scan){.time_us = INT64_C(1000000) * k,
                                    .sensor_id = SENSOR,
                                    .measures = RHO_MEASURES_RANGE_RATE});
        shared += shares();
    }
    return shared;
}

static void range_rates_tell_targets_apart(void **state)
{
    (void)state;
    assert_true(overtake(0.0f) >= 3);
    assert_int_equal(overtake(0.5f), 0);
}

/* ---- learned --------------------------------------------------------------------------------- */

static struct rho_tracker_known known(void)
{
    struct rho_tracker_known is;
    assert_int_equal(rho_tracker_known_of(&tracker, SENSOR, &is), RHO_OK);
    return is;
}

static void a_cell_of_which_nobody_told_is_learned(void **state)
{
    (void)state;
    for (int in_range = 0; in_range <= 1; in_range++) {
        begin_radar(3);
        (void)merge_at(250.0, in_range, 1, 60);
        const struct rho_tracker_known wide = known();
        begin_radar(3);
        begin_pair();
        for (int k = 0; k < APPROACH + 200; k++) {
            see(k, half_m_at(k, 100.0), in_range, 0);
            look(k);
        }
        const struct rho_tracker_known narrow = known();
        const float learned[2] = {
            in_range ? wide.resolution_range_sigmas : wide.resolution_cross_sigmas,
            in_range ? narrow.resolution_range_sigmas : narrow.resolution_cross_sigmas};
        print_message("seen as one at 5 sigmas: %.2f sigmas; as two at 2: %.2f\n",
                      (double)learned[0], (double)learned[1]);
        assert_true(learned[0] > 2.6f && learned[0] < 8.0f);
        assert_true(learned[1] > 0.3f && learned[1] < 1.8f);
    }
}

/* Of one axis: l, and its weight. */
struct cell {
    double nat, weight;
};

/* Both have plots: Fisher's scoring of ln(1 - p), in double precision. */
static void note_resolved(struct cell cell[2], const double apart_m2[2])
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

static void it_is_learned_as_derived(void **state)
{
    unsigned noted = 0, full = 0;
    (void)state;
    begin_radar(5);
    config.learn_noise_min = config.learn_noise_max = 1.0f;
    begin_pair();
    for (int k = 0; k < 6000; k++) {
        struct rho_tracker_learned *learned = &tracker.learned[0];
        const double half_m = half_m_at(k, 160.0);
        if (k > APPROACH) {
            /* as if pairs had been seen as one in between */
            learned->log_cell[0] = learned->log_cell[1] = 0.4f;
        }
        struct cell cell[2];
        for (int axis = 0; axis < 2; axis++) {
            cell[axis] =
                (struct cell){(double)learned->log_cell[axis], (double)learned->cell_weight[axis]};
        }
        see(k % 1000, half_m, 0, 0);
        const double x_m = (double)plots[0].x_m - (double)plots[1].x_m,
                     y_m = (double)plots[0].y_m - (double)plots[1].y_m,
                     at_y_m = (double)plots[0].y_m, at_x_m = (double)plots[0].x_m;
        const double range_m = hypot(at_x_m, at_y_m), c = at_x_m / range_m, s = at_y_m / range_m;
        const double apart_m2[2] = {pow(c * x_m + s * y_m, 2.0), pow(c * y_m - s * x_m, 2.0)};
        look(k);
        if (k % 1000 < APPROACH || learned->cell_weight[1] <= 0.0f || shares() > 0 ||
            (double)learned->log_cell[1] == cell[1].nat) {
            continue;
        }
        note_resolved(cell, apart_m2);
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

/* ---- what it may be -------------------------------------------------------------------------- */

static void cells_that_are_none_are_refused(void **state)
{
    static const float wrong[] = {-1.0f, NAN, INFINITY};
    (void)state;
    begin_radar(1);
    begin_pair();
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

static void cells_of_unknown_origin_are_checked(void **state)
{
    (void)state;
    begin_radar(1);
    begin_pair();
    assert_true(rho_tracker_is_sound(&tracker));
    static const struct {
        float nat, weight;
    } wrong[] = {{NAN, 1.0f}, {4.3f, 1.0f}, {-4.3f, 1.0f}, {0.0f, -1.0f}, {0.0f, 201.0f}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        for (int axis = 0; axis < 2; axis++) {
            tracker.learned[0].log_cell[axis] = wrong[i].nat;
            tracker.learned[0].cell_weight[axis] = wrong[i].weight;
            assert_false(rho_tracker_is_sound(&tracker));
            tracker.learned[0].log_cell[axis] = tracker.learned[0].cell_weight[axis] = 0.0f;
        }
    }
    tracker.learned[0].log_cell[0] = -4.1f;
    tracker.learned[0].log_cell[1] = 4.1f;
    tracker.learned[0].cell_weight[0] = 199.0f;
    assert_true(rho_tracker_is_sound(&tracker));
    /* 2.355 sigmas, from which l is counted */
    assert_true(fabs((double)known().resolution_range_sigmas - 2.35482 * exp(-2.05)) < 1e-3);
    assert_true(known().resolution_cross_sigmas == 0.0f); /* of no weight */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_within_the_stated_cell_share_a_plot),
        cmocka_unit_test(range_rates_tell_targets_apart),
        cmocka_unit_test(a_cell_of_which_nobody_told_is_learned),
        cmocka_unit_test(it_is_learned_as_derived),
        cmocka_unit_test(cells_that_are_none_are_refused),
        cmocka_unit_test(cells_of_unknown_origin_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
