/* SPDX-License-Identifier: MIT */
/*
 * Radars over the same targets, one of which is blind or biased for a while: it becomes suspect,
 * tracks follow the others, and it is trusted again when it agrees. No good radar is ever suspect,
 * however small a noise the biased one claims.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "random_draws.h"
#include "rhotrack/tracker.h"

#define TARGETS 8
#define OTHER 1
#define SENSORS_MAX 3
#define SIGMA_M 30.0
#define ROUND_S 4.0
#define LOST_MAX 2 /* misses in a row by chance */
/* more clutter than a scan's capacity, so that targets come in its second part */
#define CLUTTER (2 * RHO_MAX_PLOTS + 40)

static struct rho_tracker tracker;
static struct rho_initiator initiators[SENSORS_MAX];
static struct rho_report report;
static uint64_t seed = 5;

/* The fault of the radar OTHER. */
enum fault { NONE, SHIFTED, FAR_OFF, DEAD };

struct scene {
    int sensors; /* number of radars; all but OTHER are good */
    enum fault fault;
    int from, to; /* rounds in which OTHER is faulty */
    double turn_radps;
    int clutter; /* clutter plots of OTHER: half before the targets' plots, half behind */
    /*
     * true sigmas by sensor id, 0: SIGMA_M; sigma that OTHER claims while faulty, 0: the true one;
     * its shift, 0: 4 SIGMA_M
     */
    double sigma_m[SENSORS_MAX + 1], claim_m, shift_m;
    /* results from round 20 on */
    double sum_m2;
    int judged, lost, tracks_most, first_suspect, last_suspect;
};

static void describe_sensor(int32_t sensor_id)
{
    const struct rho_sensor sensor = {.sensor_id = sensor_id, .pd = 0.9f, .range_max_m = 4e5f};

    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
}

static void start_tracker(void)
{
    struct rho_tracker_config config;
    struct rho_initiator_config start_config;

    random_state = seed;
    rho_tracker_config_default(&config);
    rho_initiator_config_default(&start_config);
    config.v_max_mps = start_config.v_max_mps = 400.0f;
    config.accel_max_mps2 = 10.0f;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    for (int i = 0; i < SENSORS_MAX; i++) {
        assert_int_equal(rho_initiator_init(&initiators[i], sizeof initiators[i], &start_config),
                         RHO_OK);
        describe_sensor(i + 1);
    }
}

/* Targets on straight lines or in circles, 90 km apart. */
static void true_place_of(const struct scene *scene, int target, double t_s, double place_m[2])
{
    double heading = 0.7 * target, speed = 150.0 + 10.0 * target, w = scene->turn_radps;

    place_m[0] = 90000.0 * (target % 4) - 135000.0;
    place_m[1] = 90000.0 * (target / 4);
    if (w > 0.0) {
        place_m[0] += speed / w * (sin(heading + w * t_s) - sin(heading));
        place_m[1] -= speed / w * (cos(heading + w * t_s) - cos(heading));
    } else {
        place_m[0] += speed * cos(heading) * t_s;
        place_m[1] += speed * sin(heading) * t_s;
    }
}

static uint32_t add_clutter_plots(struct rho_plot *plots, uint32_t count, int more)
{
    for (int i = 0; i < more; i++) {
        plots[count++] = (struct rho_plot){.x_m = (float)uniform(-1e6, 1e6),
                                           .y_m = (float)uniform(-1e6, 1e6),
                                           .sigma_range_m = (float)SIGMA_M,
                                           .sigma_cross_m = (float)SIGMA_M};
    }
    return count;
}

static double value_or_default(double value, double otherwise)
{
    return value > 0.0 ? value : otherwise;
}

static void step_sensor_scan(const struct scene *scene, int32_t sensor_id, double t_s,
                             int is_faulty)
{
    static struct rho_plot plots[TARGETS + CLUTTER];
    const int clutter = sensor_id == OTHER ? scene->clutter / 2 : 0;
    struct rho_scan scan = {.time_us = (int64_t)llround(1e6 * t_s), .sensor_id = sensor_id};
    const double sigma_m = value_or_default(scene->sigma_m[sensor_id], SIGMA_M),
                 claim_m = is_faulty ? value_or_default(scene->claim_m, sigma_m) : sigma_m;
    double shift_m = !is_faulty                ? 0.0
                     : scene->fault == SHIFTED ? value_or_default(scene->shift_m, 4.0 * SIGMA_M)
                     : scene->fault == FAR_OFF ? 3000.0
                                               : 0.0;

    scan.num_plots = add_clutter_plots(plots, 0, clutter);
    for (int i = 0; i < TARGETS; i++) {
        double place_m[2], dx_m = sigma_m * normal(), dy_m = sigma_m * normal();

        true_place_of(scene, i, t_s, place_m);
        if (uniform(0.0, 1.0) < 0.9 && !(is_faulty && scene->fault == DEAD)) {
            plots[scan.num_plots++] = (struct rho_plot){.x_m = (float)(place_m[0] + dx_m + shift_m),
                                                        .y_m = (float)(place_m[1] + dy_m + shift_m),
                                                        .sigma_range_m = (float)claim_m,
                                                        .sigma_cross_m = (float)claim_m};
        }
    }
    scan.num_plots = add_clutter_plots(plots, scan.num_plots, clutter);
    scan.plots = plots;
    assert_int_equal(rho_tracker_step(&tracker, &initiators[sensor_id - 1], &scan, &report),
                     RHO_OK);
}

static void note_errors(struct scene *scene, double t_s)
{
    int confirmed = 0;

    for (uint32_t k = 0; k < report.num_tracks; k++) {
        confirmed += report.tracks[k].status != RHO_TRACK_TENTATIVE;
    }
    scene->tracks_most = confirmed > scene->tracks_most ? confirmed : scene->tracks_most;
    for (int i = 0; i < TARGETS; i++) {
        double place_m[2], best_m = 1000.0;

        true_place_of(scene, i, t_s, place_m);
        for (uint32_t k = 0; k < report.num_tracks; k++) {
            double error_m = hypot((double)report.tracks[k].state[0] - place_m[0],
                                   (double)report.tracks[k].state[1] - place_m[1]);

            if (report.tracks[k].status != RHO_TRACK_TENTATIVE && error_m < best_m) {
                best_m = error_m;
            }
        }
        scene->lost += best_m >= 1000.0;
        scene->sum_m2 += best_m < 1000.0 ? best_m * best_m : 0.0;
        scene->judged += best_m < 1000.0;
    }
}

static int is_suspect(int32_t sensor_id)
{
    return rho_tracker_look_of(&tracker, sensor_id)->is_suspect;
}

/* Each round all radars look once, a second apart. */
static void run_rounds(struct scene *scene, int rounds)
{
    scene->first_suspect = scene->last_suspect = -1;
    start_tracker();
    for (int round = 0; round < rounds; round++) {
        double t_s = ROUND_S * round;

        step_sensor_scan(scene, OTHER, t_s, round >= scene->from && round < scene->to);
        if (is_suspect(OTHER)) {
            scene->first_suspect = scene->first_suspect < 0 ? round : scene->first_suspect;
            scene->last_suspect = round;
        }
        for (int32_t good = OTHER + 1; good <= scene->sensors; good++) {
            step_sensor_scan(scene, good, t_s + good - OTHER, 0);
            assert_int_equal(is_suspect(good), 0);
        }
        if (round >= 20) {
            note_errors(scene, t_s + scene->sensors - OTHER);
        }
    }
}

static double rmse_m(const struct scene *scene)
{
    return sqrt(scene->sum_m2 / scene->judged);
}

static void agreeing_sensors_are_never_suspect(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        struct scene scene = {.sensors = 2, .turn_radps = 0.02 * k}; /* turns of up to 9 m/s^2 */

        run_rounds(&scene, 100);
        assert_int_equal(scene.first_suspect, -1);
        assert_in_range(scene.lost, 0, LOST_MAX);
        assert_int_equal(scene.tracks_most, TARGETS);
        assert_int_equal(tracker.counters.sensors_suspected, 0);
    }
}

static void a_biased_sensor_becomes_suspect_and_is_weighted_down(void **state)
{
    struct scene well = {.sensors = 3, .fault = NONE},
                 lies = {.sensors = 3, .fault = SHIFTED, .from = 30, .to = 1000};
    (void)state;
    run_rounds(&well, 100);
    run_rounds(&lies, 100);
    print_message("all well %.1f m, one off by %.0f m: %.1f m, suspect from round %d\n",
                  rmse_m(&well), 4.0 * SIGMA_M * 1.414, rmse_m(&lies), lies.first_suspect);
    assert_in_range(lies.first_suspect, 31, 36);
    assert_int_equal(lies.last_suspect, 99);
    assert_in_range(lies.lost, 0, LOST_MAX);
    assert_int_equal(lies.tracks_most, TARGETS);
    /* without OTHER a third of the measurements is missing */
    assert_true(rmse_m(&lies) < 1.6 * rmse_m(&well));
}

/* The biased radar pulls the tracks, so the others appear biased as well, but less. */
static void a_biased_sensor_is_found_in_every_random_run(void **state)
{
    (void)state;
    for (seed = 1; seed <= 20; seed++) {
        struct scene scene = {.sensors = 3, .fault = SHIFTED, .from = 30, .to = 1000};

        run_rounds(&scene, 60);
        assert_in_range(scene.first_suspect, 30, 36);
        assert_int_equal(scene.last_suspect, 59);
        assert_in_range(scene.lost, 0, LOST_MAX);
    }
    seed = 5;
}

/*
 * Two witnesses of equal noise, or two coarser ones that are less biased, suffice; a claimed small
 * noise does not help.
 */
static void beside_a_biased_sensor_unlike_good_ones_are_not_suspect(void **state)
{
    const struct scene scenes[] = {
        {.sigma_m = {0.0, 50.0, 30.0, 100.0}, .claim_m = 15.0, .shift_m = 120.0},
        {.sigma_m = {0.0, 100.0, 30.0, 100.0}, .claim_m = 10.0, .shift_m = 120.0},
        {.sigma_m = {0.0, 30.0, 30.0, 100.0}, .claim_m = 5.0, .shift_m = 120.0},
        {.sigma_m = {0.0, 30.0, 30.0, 100.0}, .claim_m = 30.0, .shift_m = 120.0},
        {.sigma_m = {0.0, 30.0, 30.0, 60.0}, .claim_m = 10.0, .shift_m = 80.0},
        {.sigma_m = {0.0, 10.0, 30.0, 100.0}, .claim_m = 10.0, .shift_m = 120.0},
        {.sigma_m = {0.0, 30.0, 100.0, 100.0}, .claim_m = 30.0, .shift_m = 240.0},
        {.sigma_m = {0.0, 30.0, 10.0, 100.0}, .claim_m = 30.0, .shift_m = 120.0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        for (seed = 1; seed <= 10; seed++) {
            struct scene scene = scenes[i];

            scene.sensors = 3;
            scene.fault = SHIFTED;
            scene.from = 30;
            scene.to = 1000;
            run_rounds(&scene, 100); /* checks the good radars after each step */
        }
    }
    seed = 5;
}

/* It pulls the tracks most, yet appears more biased than two coarser radars. */
static void a_biased_sensor_claiming_less_noise_is_mostly_found(void **state)
{
    int found = 0;
    (void)state;
    for (seed = 1; seed <= 20; seed++) {
        struct scene scene = {
            .sensors = 3, .fault = SHIFTED, .from = 30, .to = 1000, .claim_m = 10.0};

        run_rounds(&scene, 60);
        found += scene.first_suspect >= 0;
    }
    seed = 5;
    print_message("30 m that claims 10 m, off by 170 m: suspect in %d runs of 20\n", found);
    assert_true(found >= 10);
}

/* Its plots are outside all gates and start no second tracks. */
static void a_sensor_3_km_off_starts_no_second_tracks(void **state)
{
    struct scene scene = {.sensors = 2, .fault = FAR_OFF, .from = 30, .to = 1000};
    (void)state;
    run_rounds(&scene, 100);
    assert_in_range(scene.first_suspect, 31, 34);
    assert_int_equal(scene.last_suspect, 99);
    assert_int_equal(scene.tracks_most, TARGETS);
    assert_in_range(scene.lost, 0, LOST_MAX);
    assert_int_equal(tracker.counters.sensors_suspected, 1);
}

static void a_blind_sensor_ends_no_track(void **state)
{
    struct scene scene = {.sensors = 2, .fault = DEAD, .from = 30, .to = 1000};
    (void)state;
    run_rounds(&scene, 100);
    assert_in_range(scene.first_suspect, 31, 34);
    assert_in_range(scene.lost, 0, LOST_MAX);
    assert_int_equal(scene.tracks_most, TARGETS);
}

static void a_sensor_no_longer_biased_is_trusted_again(void **state)
{
    const enum fault faults[] = {SHIFTED, FAR_OFF, DEAD};
    (void)state;
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        struct scene scene = {.sensors = 3, .fault = faults[i], .from = 30, .to = 60};

        run_rounds(&scene, 100);
        assert_in_range(scene.last_suspect, 59, 75);
        assert_in_range(scene.lost, 0, LOST_MAX);
        assert_int_equal(scene.tracks_most, TARGETS);
        assert_true(tracker.sensors[0].sensor.sigma_range_percent <= 150);
    }
}

/* Scans of more plots than the capacity are watched, too. */
static void sensors_of_overfull_scans_are_watched(void **state)
{
    const enum fault faults[] = {NONE, SHIFTED, FAR_OFF, DEAD};
    (void)state;
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        struct scene scene = {
            .sensors = 3, .fault = faults[i], .from = 30, .to = 60, .clutter = CLUTTER};

        run_rounds(&scene, 100);
        assert_in_range(scene.lost, 0, LOST_MAX);
        if (faults[i] == NONE) {
            const struct rho_tracker_look *look = rho_tracker_look_of(&tracker, OTHER);

            assert_int_equal(scene.first_suspect, -1);
            assert_true(look->seen_share > 0.7f); /* P_D is 0.9, over the last 16 looks */
            assert_int_equal(look->watched, 16);
        } else {
            assert_in_range(scene.first_suspect, 30, 36);
            assert_in_range(scene.last_suspect, 59, 75);
        }
    }
}

/*
 * Two radars that contradict each other: neither can be trusted more, so both count on, and the
 * error shows.
 */
static void of_two_contradicting_sensors_none_is_suspect(void **state)
{
    struct scene scene = {.sensors = 2, .fault = SHIFTED, .from = 30, .to = 1000};
    (void)state;
    run_rounds(&scene, 100);
    assert_int_equal(scene.first_suspect, -1);
    assert_in_range(scene.lost, 0, LOST_MAX);
    assert_int_equal(scene.tracks_most, TARGETS);
    for (int32_t sensor = 1; sensor <= 2; sensor++) {
        assert_true(rho_tracker_look_of(&tracker, sensor)->distance2 > 2.5f);
    }
}

/* A single radar has no witness. */
static void a_single_sensor_is_never_suspect(void **state)
{
    struct scene scene = {.fault = DEAD, .from = 30, .to = 50};
    (void)state;
    start_tracker();
    for (int round = 0; round < 60; round++) {
        step_sensor_scan(&scene, OTHER, ROUND_S * round, round >= scene.from && round < scene.to);
        assert_int_equal(is_suspect(OTHER), 0);
    }
    assert_int_equal(tracker.counters.sensors_suspected, 0);
}

/* ---- limits of suspicion --------------------------------------------------------------------- */

#define PD 0.9f

/*
 * Sensor 1 is biased or blind, 2 and 3 are witnesses; all with the fewest looks that are compared.
 */
static struct rho_tracker_look seen[SENSORS_MAX];

static void set_equal_health(void)
{
    start_tracker();
    for (int i = 0; i < SENSORS_MAX; i++) {
        seen[i] = (struct rho_tracker_look){.watched = 12,
                                            .watched_hits = 12,
                                            .seen_share = PD,
                                            .distance2 = 1.0f,
                                            .sigma_m = 30.0f};
    }
}

static void step_empty_scan(int32_t sensor_id, int64_t time_us)
{
    const struct rho_scan scan = {.time_us = time_us, .sensor_id = sensor_id};
    assert_int_equal(rho_tracker_step(&tracker, &initiators[sensor_id - 1], &scan, &report),
                     RHO_OK);
}

/* Whether sensor 1 is suspect at its next scan, t_s seconds after the others' scans. */
static int is_suspect_after(double t_s)
{
    for (int32_t id = SENSORS_MAX; id >= 1; id--) {
        step_empty_scan(id, SENSORS_MAX - id);
    }
    for (unsigned i = 0; i < tracker.num_rows; i++) {
        struct rho_tracker_look *look = &tracker.sensors[i].look;
        const struct rho_tracker_look *as = &seen[tracker.sensors[i].sensor.sensor_id - 1];
        look->watched = as->watched;
        look->watched_hits = as->watched_hits;
        look->seen_share = as->seen_share;
        look->distance2 = as->distance2;
        look->sigma_m = as->sigma_m;
        look->is_suspect = as->is_suspect;
    }
    step_empty_scan(1, (int64_t)(1e6 * t_s));
    return is_suspect(1);
}

/*
 * Sensor 1 sees less than 0.3 of the expected detections, and one other sees 0.6 at the same
 * places.
 */
static void a_blind_sensor_is_suspect_by_one_witness(void **state)
{
    (void)state;
    for (int i = 0; i <= 6; i++) {
        set_equal_health();
        seen[0].seen_share = (i == 1 ? 0.32f : 0.28f) * PD;
        seen[0].watched = i == 2 ? 11 : 12;
        seen[1].seen_share = (i == 3 ? 0.58f : 0.62f) * PD;
        seen[1].watched = i == 4 ? 11 : 12;
        seen[1].distance2 = i == 5 ? 2.6f : 2.4f;
        seen[2].seen_share = 0.0f;
        assert_int_equal(is_suspect_after(i == 6 ? 61.0 : 59.0), i == 0);
    }
}

/* Plots of sensor 1 are four times as far off as expected, and two others agree. */
static void a_biased_sensor_is_suspect_by_two_witnesses(void **state)
{
    (void)state;
    for (int i = 0; i <= 4; i++) {
        set_equal_health();
        seen[0].distance2 = i == 1 ? 3.9f : 4.1f;
        seen[0].watched_hits = i == 2 ? 11 : 12;
        seen[1].distance2 = i == 3 ? 2.9f : 2.4f; /* witness limit 0.7 of 4.1: 2.87 */
        seen[2].sigma_m = (i == 4 ? 1.95f : 1.85f) * 30.0f;
        assert_int_equal(is_suspect_after(1.0), i == 0);
    }
}

/*
 * Two witnesses that are less biased, by 0.7, with equal noise; without a good witness left to
 * compare with, it is trusted again at once.
 */
static void less_biased_sensors_are_witnesses(void **state)
{
    (void)state;
    for (int i = 0; i <= 1; i++) {
        set_equal_health();
        seen[0].distance2 = 4.5f;
        seen[1].distance2 = seen[2].distance2 = i == 1 ? 3.2f : 3.1f;
        (void)is_suspect_after(1.0);
        assert_int_equal(tracker.counters.sensors_suspected > 0, i == 0);
    }
}

static void a_suspect_sensor_that_agrees_is_trusted_again(void **state)
{
    (void)state;
    for (int i = 0; i <= 2; i++) {
        set_equal_health();
        seen[0].is_suspect = 1;
        seen[0].distance2 = i == 1 ? 2.6f : 2.4f;
        seen[0].seen_share = (i == 2 ? 0.58f : 0.62f) * PD;
        assert_int_equal(is_suspect_after(1.0), i > 0);
    }
}

/* Plots of a suspect sensor get the noise that they show, up to twenty times. */
static void a_suspect_sensor_gets_the_noise_it_shows(void **state)
{
    static const float shown[] = {0.5f, 15.0f, 19.0f, 30.0f};
    static const int percent[] = {100, 1500, 1900, 2000};
    (void)state;
    for (int i = 0; i < 4; i++) {
        set_equal_health();
        seen[0].is_suspect = 1;
        seen[0].seen_share = 0.1f;
        seen[0].distance2 = shown[i];
        assert_int_equal(is_suspect_after(1.0), 1);
        assert_int_equal(tracker.sensors[0].sensor.sigma_range_percent, percent[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agreeing_sensors_are_never_suspect),
        cmocka_unit_test(a_biased_sensor_becomes_suspect_and_is_weighted_down),
        cmocka_unit_test(a_biased_sensor_is_found_in_every_random_run),
        cmocka_unit_test(beside_a_biased_sensor_unlike_good_ones_are_not_suspect),
        cmocka_unit_test(a_biased_sensor_claiming_less_noise_is_mostly_found),
        cmocka_unit_test(a_sensor_3_km_off_starts_no_second_tracks),
        cmocka_unit_test(a_blind_sensor_ends_no_track),
        cmocka_unit_test(a_sensor_no_longer_biased_is_trusted_again),
        cmocka_unit_test(sensors_of_overfull_scans_are_watched),
        cmocka_unit_test(of_two_contradicting_sensors_none_is_suspect),
        cmocka_unit_test(a_single_sensor_is_never_suspect),
        cmocka_unit_test(a_blind_sensor_is_suspect_by_one_witness),
        cmocka_unit_test(a_biased_sensor_is_suspect_by_two_witnesses),
        cmocka_unit_test(less_biased_sensors_are_witnesses),
        cmocka_unit_test(a_suspect_sensor_that_agrees_is_trusted_again),
        cmocka_unit_test(a_suspect_sensor_gets_the_noise_it_shows),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
