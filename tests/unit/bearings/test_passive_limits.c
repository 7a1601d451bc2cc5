/* SPDX-License-Identifier: MIT */
/*
 * Tracks from bearings at their limits: refused frames and configurations, invalid bearings, full
 * capacities, hostile input.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "passive_scene.h"
#include "rhotrack/passive.h"

static struct rho_passive passive, before;
static struct scene scene;
static struct full_frame full;

static void init_passive(const struct rho_passive_config *config)
{
    assert_int_equal(rho_passive_init(&passive, sizeof passive, config), RHO_OK);
}

static void init_default_passive(void)
{
    assert_int_equal(start_passive(&passive), RHO_OK);
}

/* Draws a scene, pushes and searches its first five frames, and puts the sixth into `full`. */
static void prepare_batch(void)
{
    random_state = 3;
    scene = scene_of(2, 2, 0.1, 1.0, 0.0);
    draw_scene(&scene);
    init_default_passive();
    for (unsigned k = 0; k < 5; k++) {
        assert_int_equal(push_scan(&passive, &scene, k), RHO_OK);
    }
    assert_int_equal(rho_passive_search(&passive), RHO_OK);
    fill_frame(&scene, 5, &full);
    before = passive;
}

static void expect_frame_refused(enum rho_status status)
{
    uint8_t fates[sizeof full.fates];
    memcpy(fates, full.fates, sizeof fates);
    assert_int_equal(rho_passive_accepts(&passive, &full.frame), status);
    assert_int_equal(rho_passive_push(&passive, &full.frame, full.fates), status);
    assert_memory_equal(&passive, &before, sizeof passive);
    assert_memory_equal(full.fates, fates, sizeof fates);
}

static void expect_config_status(const struct rho_passive_config *config, enum rho_status status)
{
    memset(&passive, 0x5a, sizeof passive);
    before = passive;
    assert_int_equal(rho_passive_init(&passive, sizeof passive, config), status);
    if (status != RHO_OK) {
        assert_memory_equal(&passive, &before, sizeof passive);
    }
}

#define EXPECT_FIELD(field, value, status)                                                         \
    do {                                                                                           \
        struct rho_passive_config config;                                                          \
        rho_passive_config_default(&config);                                                       \
        config.field = (value);                                                                    \
        expect_config_status(&config, (status));                                                   \
    } while (0)

static void numbers_of_scans_out_of_range_are_refused(void **state)
{
    (void)state;
    EXPECT_FIELD(scans, RHO_BATCH_SCANS_MIN - 1, RHO_ERROR_CONFIG);
    EXPECT_FIELD(scans, RHO_BATCH_SCANS_MIN, RHO_OK);
    EXPECT_FIELD(scans, RHO_MAX_PASSIVE_SCANS, RHO_OK);
    EXPECT_FIELD(scans, RHO_MAX_PASSIVE_SCANS + 1, RHO_ERROR_CONFIG);
    EXPECT_FIELD(scans, 0, RHO_ERROR_CONFIG);
}

static void target_and_sensor_parameters_out_of_range_are_refused(void **state)
{
    (void)state;
    EXPECT_FIELD(range_max_m, 999.0f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(range_max_m, 1000.0f, RHO_OK);
    EXPECT_FIELD(range_max_m, 500001.0f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(v_max_mps, 0.9f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(v_max_mps, 1.0f, RHO_OK);
    EXPECT_FIELD(v_max_mps, RHO_LIMIT_SPEED_MPS, RHO_OK);
    EXPECT_FIELD(v_max_mps, 1.01f * RHO_LIMIT_SPEED_MPS, RHO_ERROR_CONFIG);
    EXPECT_FIELD(pd, 0.009f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(pd, 0.01f, RHO_OK);
    EXPECT_FIELD(pd, 0.999f, RHO_OK);
    EXPECT_FIELD(pd, 1.0f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(field_of_view_rad, 0.009f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(field_of_view_rad, 0.01f, RHO_OK);
    EXPECT_FIELD(field_of_view_rad, (float)(2.0 * PI), RHO_OK);
    EXPECT_FIELD(field_of_view_rad, 6.29f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(false_tracks_per_hour, 0.0f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(false_tracks_per_hour, 0.9e-6f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(false_tracks_per_hour, 1.0e-6f, RHO_OK);
    EXPECT_FIELD(false_tracks_per_hour, 1.0e6f, RHO_OK);
    EXPECT_FIELD(false_tracks_per_hour, 1.1e6f, RHO_ERROR_CONFIG);
    EXPECT_FIELD(work_max, RHO_LIMIT_WORK, RHO_OK);
    EXPECT_FIELD(work_max, RHO_LIMIT_WORK + 1u, RHO_ERROR_CONFIG);
}

static void parameters_that_are_not_finite_are_refused(void **state)
{
    (void)state;
    const float bad[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        EXPECT_FIELD(range_max_m, bad[i], RHO_ERROR_CONFIG);
        EXPECT_FIELD(v_max_mps, bad[i], RHO_ERROR_CONFIG);
        EXPECT_FIELD(pd, bad[i], RHO_ERROR_CONFIG);
        EXPECT_FIELD(field_of_view_rad, bad[i], RHO_ERROR_CONFIG);
        EXPECT_FIELD(false_tracks_per_hour, bad[i], RHO_ERROR_CONFIG);
    }
}

static void the_default_configuration_is_that_of_the_header(void **state)
{
    (void)state;
    struct rho_passive_config config;
    rho_passive_config_default(&config);
    assert_int_equal(config.scans, 8);
    assert_float_equal(config.range_max_m, 100e3, 0.0);
    assert_float_equal(config.v_max_mps, 450.0, 0.0);
    assert_float_equal(config.pd, 0.9, 1e-6);
    assert_float_equal(config.field_of_view_rad, PI, 1e-6);
    assert_float_equal(config.false_tracks_per_hour, 1.0, 0.0);
    assert_int_equal(config.work_max, RHO_WORK_MAX);
    expect_config_status(&config, RHO_OK);
}

static void an_object_can_be_initialised_with_its_own_configuration(void **state)
{
    (void)state;
    prepare_batch();
    assert_int_equal(rho_passive_init(&passive, sizeof passive, &passive.config), RHO_OK);
    assert_int_equal(passive.config.scans, 8);
    assert_int_equal(passive.batch.num_scans + passive.batch.num_sensors, 0);
}

static void null_pointers_are_refused(void **state)
{
    (void)state;
    prepare_batch();
    assert_int_equal(rho_passive_init(NULL, sizeof passive, &passive.config), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_init(&passive, sizeof passive, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_push(NULL, &full.frame, full.fates), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_push(&passive, NULL, full.fates), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_push(&passive, &full.frame, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_search(NULL), RHO_ERROR_NULL);
    full.scans[1].bearings = NULL;
    expect_frame_refused(RHO_ERROR_NULL);
    full.frame.scans = NULL;
    expect_frame_refused(RHO_ERROR_NULL);
}

static void a_wrong_object_size_is_refused(void **state)
{
    (void)state;
    prepare_batch();
    assert_int_equal(rho_passive_init(&passive, sizeof passive - 1, &before.config),
                     RHO_ERROR_SIZE);
    assert_int_equal(rho_passive_init(&passive, 0, &before.config), RHO_ERROR_SIZE);
    assert_memory_equal(&passive, &before, sizeof passive);
}

static void an_object_without_init_is_refused(void **state)
{
    (void)state;
    prepare_batch();
    memset(&passive, 0, sizeof passive);
    before = passive;
    expect_frame_refused(RHO_ERROR_STATE);
    assert_int_equal(rho_passive_search(&passive), RHO_ERROR_STATE);
    assert_memory_equal(&passive, &before, sizeof passive);
}

static void places_that_are_no_coordinates_are_refused(void **state)
{
    (void)state;
    const float bad_m[] = {NAN, INFINITY, -INFINITY, 1.1f * RHO_LIMIT_POSITION_M};
    prepare_batch();
    for (int i = 0; i < 4; i++) {
        full.scans[1].x_m = bad_m[i];
        full.scans[1].y_m = 0.0f;
        expect_frame_refused(RHO_ERROR_VALUE);
        full.scans[1].x_m = 0.0f;
        full.scans[1].y_m = bad_m[i];
        expect_frame_refused(RHO_ERROR_VALUE);
    }
}

/* A known sensor moves, a new one stands at its place, or as far away as places are. */
static void sensors_may_move_stand_together_and_be_far_apart(void **state)
{
    (void)state;
    prepare_batch();
    full.scans[1].x_m += 0.5f;
    assert_int_equal(rho_passive_push(&passive, &full.frame, full.fates), RHO_OK);
    assert_int_equal(passive.batch.num_sensors, 2);
    prepare_batch();
    full.scans[1].sensor_id = 99;
    assert_int_equal(rho_passive_push(&passive, &full.frame, full.fates), RHO_OK);
    assert_int_equal(passive.batch.num_sensors, 3);
    prepare_batch();
    full.scans[1].y_m = RHO_LIMIT_POSITION_M;
    assert_int_equal(rho_passive_push(&passive, &full.frame, full.fates), RHO_OK);
    assert_int_equal(rho_passive_search(&passive), RHO_OK);
    assert_true(are_tracks_finite_with_right_claims(&passive));
}

static void expect_sound_search(void)
{
    assert_int_equal(rho_passive_search(&passive), RHO_OK);
    assert_true(are_tracks_finite_with_right_claims(&passive));
}

static void push_scene(void)
{
    assert_int_equal(push_scans_from(&passive, &scene, 0), RHO_OK);
}

static void fill_scans_with_false_bearings(void)
{
    for (unsigned k = 0; k < scene.scans; k++) {
        for (unsigned s = 0; s < scene.sensors; s++) {
            for (unsigned i = 0; i < RHO_MAX_BEARINGS; i++) {
                add_bearing(&scene.look[k][s], uniform(-1.5, 1.5), 0.5 * DEG_RAD, -1);
            }
        }
    }
}

/* Searches as many sensors, scans and bearings as fit, all of them false. */
static void search_full_batch(void)
{
    struct rho_passive_config config;
    rho_passive_config_default(&config);
    config.scans = RHO_MAX_PASSIVE_SCANS;
    config.work_max = 0;
    random_state = 20;
    scene = scene_of(RHO_MAX_PASSIVE_SENSORS, 0, 0.1, 0.9, 0.0);
    scene.scans = RHO_MAX_PASSIVE_SCANS;
    set_scan_times(&scene);
    fill_scans_with_false_bearings();
    init_passive(&config);
    push_scene();
    expect_sound_search();
}

/* The largest number of sensors and scans, each scan full of false bearings. */
static void a_full_batch_of_false_bearings_makes_one_track_at_most(void **state)
{
    (void)state;
    const struct rho_passive_work *work = &passive.work;
    search_full_batch();
    print_message("full: %u crossings, %u dropped, %u hypotheses, %u fits, %u tracks\n",
                  work->crossings, work->points_dropped, work->hypotheses, work->fits,
                  passive.num_tracks);
    assert_int_equal(work->crossings, RHO_MAX_PASSIVE_SENSORS * (RHO_MAX_PASSIVE_SENSORS - 1) / 2 *
                                          RHO_MAX_PASSIVE_SCANS * RHO_MAX_BEARINGS *
                                          RHO_MAX_BEARINGS);
    assert_true(work->ghosts > 0 && work->points_dropped > 0);
    assert_true(work->hypotheses > 10000 && work->fits > 100);
    assert_in_range(passive.num_tracks, 0, 1); /* one may arise by chance */
}

/* A track of the search is within 2 km of the target. */
static int is_target_found(const struct target *target)
{
    const double t_s = scene.time_s[scene.scans - 1u];
    int is_found = 0;
    for (unsigned i = 0; i < passive.num_tracks; i++) {
        is_found |= hypot((double)passive.tracks[i].x_m - target_x_m(target, t_s),
                          (double)passive.tracks[i].y_m - target_y_m(target, t_s)) < 2e3;
    }
    return is_found;
}

/* Three targets among false bearings, so many in all a look. */
static unsigned count_found_among_false(uint32_t seed, unsigned sensors, double sigma_deg,
                                        unsigned bearings, uint32_t work_max)
{
    struct rho_passive_config config;
    rho_passive_config_default(&config);
    config.work_max = work_max;
    random_state = seed;
    scene = scene_of(sensors, 3, sigma_deg, 1.0, 0.0);
    draw_scene(&scene);
    for (unsigned k = 0; k < scene.scans; k++) {
        for (unsigned s = 0; s < scene.sensors; s++) {
            while (scene.look[k][s].count < bearings) {
                add_bearing(&scene.look[k][s], uniform(-1.5, 1.5), sigma_deg * DEG_RAD, -1);
            }
        }
    }
    init_passive(&config);
    push_scene();
    expect_sound_search();
    unsigned found = 0;
    for (unsigned i = 0; i < scene.targets; i++) {
        found += (unsigned)is_target_found(&scene.target[i]);
    }
    return found;
}

/* Where crossings have no room, those of targets are likely; the most certain ones find 1 of 30. */
static void targets_are_found_where_crossings_have_no_room(void **state)
{
    (void)state;
    const unsigned sensors = RHO_MAX_PASSIVE_SENSORS < 4 ? RHO_MAX_PASSIVE_SENSORS : 4;
    unsigned found = 0, dropped = 0;
    for (uint32_t seed = 1; seed <= 10; seed++) {
        found += count_found_among_false(seed, sensors, 0.5, RHO_MAX_BEARINGS, 0);
        dropped += passive.work.points_dropped > 0;
    }
    print_message("without room: %u of 30 targets, %u searches\n", found, dropped);
    const int has_room = 3 * 8 * RHO_MAX_BEARINGS * RHO_MAX_BEARINGS < 8 * RHO_MAX_PASSIVE_POINTS;
    assert_true(found >= 24 && (dropped >= 8 || has_room));
}

/* The search ends within its work, tells what it left out, and still finds what is plain. */
static void a_search_keeps_to_its_work(void **state)
{
    (void)state;
    const uint32_t fit = 8u * 8u * 3u * (RHO_MAX_BEARINGS + 4u);
    assert_int_equal(count_found_among_false(1, 3, 0.3, 6, 0), 3);
    const uint32_t all = passive.work.spent;
    assert_int_equal(passive.work.points_dropped + passive.work.candidates_dropped, 0);
    assert_int_equal(count_found_among_false(1, 3, 0.3, 6, all / 2u), 3);
    for (uint32_t share = 8; share <= 128; share *= 4) {
        (void)count_found_among_false(1, 3, 0.3, 6, all / share);
        print_message("work of 1/%u: %u of %u\n", share, passive.work.spent, all / share);
        assert_in_range(passive.work.spent, 1, all / share + fit);
        assert_true(passive.work.points_dropped + passive.work.candidates_dropped > 0);
    }
    (void)count_found_among_false(1, 3, 0.3, 6, 1);
    assert_int_equal(passive.num_tracks, 0);
}

/* Searches a scene whose scans all have the same bearings. */
static void search_equal_scans(unsigned sensors, const double *bearings_rad, unsigned count,
                               double sigma_rad)
{
    scene = scene_of(sensors, 0, 0.1, 0.9, 0.0);
    set_scan_times(&scene);
    for (unsigned k = 0; k < scene.scans; k++) {
        for (unsigned s = 0; s < scene.sensors; s++) {
            for (unsigned i = 0; i < count; i++) {
                add_bearing(&scene.look[k][s], bearings_rad[i], sigma_rad, -1);
            }
        }
    }
    init_default_passive();
    push_scene();
    expect_sound_search();
}

static void parallel_bearings_make_no_track(void **state)
{
    (void)state;
    double bearings_rad[RHO_MAX_BEARINGS];
    for (unsigned i = 0; i < RHO_MAX_BEARINGS; i++) {
        bearings_rad[i] = 0.3;
    }
    search_equal_scans(2, bearings_rad, RHO_MAX_BEARINGS, 0.001);
    assert_int_equal(passive.num_tracks, 0);
    search_equal_scans(2, bearings_rad, 1, RHO_LIMIT_SIGMA_RAD_MIN);
    assert_int_equal(passive.num_tracks, 0);
    search_equal_scans(3, bearings_rad, RHO_MAX_BEARINGS, RHO_LIMIT_SIGMA_RAD_MAX);
}

/*
 * With bearings both ways along the base a target may be anywhere on it: tracks have a sigma of 50
 * km at least.
 */
static void bearings_along_the_base_make_no_certain_track(void **state)
{
    (void)state;
    const double along_rad[2] = {0.5 * PI, -0.5 * PI};
    search_equal_scans(2, along_rad, 1, 0.001);
    assert_int_equal(passive.num_tracks, 0);
    search_equal_scans(2, along_rad + 1, 1, 0.001);
    assert_int_equal(passive.num_tracks, 0);
    search_equal_scans(2, along_rad, 2, 0.001);
    for (unsigned i = 0; i < passive.num_tracks; i++) {
        assert_true(passive.tracks[i].covariance[2] > 50e3f * 50e3f);
    }
}

/*
 * On the extension of the base bearings hold no range: tracks are not found, or have a sigma above
 * 500 m.
 */
static void targets_on_the_extended_base_make_no_certain_track(void **state)
{
    (void)state;
    for (unsigned run = 0; run < 20; run++) {
        random_state = 40 + run;
        scene = scene_of(2, 1, 0.1, 1.0, 0.0);
        set_scan_times(&scene);
        scene.target[0] = (struct target){.y_m = uniform(20e3, 70e3), .vy_mps = -200.0};
        see_all_looks(&scene);
        init_default_passive();
        push_scene();
        expect_sound_search();
        for (unsigned i = 0; i < passive.num_tracks; i++) {
            assert_true(passive.tracks[i].covariance[2] > 500.0f * 500.0f);
        }
    }
}

static void a_target_that_passes_over_a_sensor_does_no_harm(void **state)
{
    (void)state;
    random_state = 60;
    scene = scene_of(2, 1, 0.1, 1.0, 0.0);
    set_scan_times(&scene);
    scene.target[0] = (struct target){.x_m = 4e3, .y_m = -10e3, .vx_mps = -100.0};
    see_all_looks(&scene); /* the target is at sensor 0 in the fifth scan */
    init_default_passive();
    push_scene();
    expect_sound_search();
}

static void frames_without_scans_or_bearings_are_accepted(void **state)
{
    (void)state;
    init_default_passive();
    for (unsigned k = 0; k < 10; k++) {
        struct rho_frame frame = {.time_us = (int64_t)k};
        assert_int_equal(rho_passive_push(&passive, &frame, NULL), RHO_OK);
    }
    assert_int_equal(passive.batch.num_scans, 1); /* no look makes a row necessary */
    assert_int_equal(passive.batch.newest_us, 9);
    assert_int_equal(passive.batch.num_sensors, 0);
    expect_sound_search();
    search_equal_scans(2, NULL, 0, 0.001);
    assert_int_equal(passive.batch.num_scans, 8);
    assert_int_equal(passive.num_tracks, 0);
}

/* Intervals of 1 us, and intervals so large that float loses them. */
static void extreme_scan_times_are_accepted(void **state)
{
    (void)state;
    static const int64_t times_us[8] = {INT64_MIN, -RHO_LIMIT_TIME_US, -1,       0, 1,
                                        2,         RHO_LIMIT_TIME_US,  INT64_MAX};
    prepare_batch();
    for (unsigned from = 0; from < 3; from++) {
        init_default_passive();
        for (unsigned k = 0; k < 8; k++) {
            fill_frame(&scene, k, &full);
            full.frame.time_us = from == 0 ? times_us[k] : from == 1 ? k : times_us[7] - 7 + k;
            full.scans[0].time_us = full.scans[1].time_us = full.frame.time_us;
            assert_int_equal(rho_passive_push(&passive, &full.frame, full.fates), RHO_OK);
            assert_int_equal(passive.batch.num_scans, k + 1);
            assert_true(rho_passive_is_sound(&passive)); /* an unsound object could not be saved */
        }
        expect_sound_search();
    }
}

/* A value between `from` and `to`; any float in one of ten draws. */
static float random_float(double from, double to)
{
    return float_or_any(from, to, 0.1);
}

static void make_random_bearings(struct look *look)
{
    look->count = (unsigned)uniform(0.0, RHO_MAX_BEARINGS + 2.0);
    for (unsigned i = 0; i < look->count; i++) {
        look->bearings[i].bearing_rad = random_float(-PI, PI);
        look->bearings[i].sigma_rad = (float)exp(uniform(-7.0, 0.0));
    }
}

static void make_random_frame(unsigned step)
{
    full.frame.time_us = (int64_t)step * (int64_t)exp(uniform(0.0, 17.0));
    for (unsigned s = 0; s < SCENE_SENSORS; s++) {
        struct rho_bearing_scan *scan = &full.scans[s];
        make_random_bearings(&scene.look[0][s]);
        scan->time_us = full.frame.time_us + (int64_t)uniform(-1e5, 1e5);
        scan->time_us += uniform(0.0, 1.0) < 0.03 ? 2 * RHO_LIMIT_OFFSET_US : 0;
        scan->sensor_id = (int32_t)(uniform(0.0, 1.0) < 0.95 ? s : random_bits() % 6);
        scan->x_m = uniform(0.0, 1.0) < 0.03 ? any_float() : 7e3f * (float)(s + 1);
        scan->y_m = uniform(0.0, 1.0) < 0.03 ? any_float() : -3e3f * (float)(s * s);
        scan->num_bearings = scene.look[0][s].count;
        scan->bearings = scene.look[0][s].bearings;
    }
    full.frame.num_scans = (uint32_t)uniform(0.0, RHO_MAX_PASSIVE_SENSORS + 0.999);
    full.frame.scans = full.scans;
}

static void draw_fates(void)
{
    for (unsigned i = 0; i < sizeof full.fates; i++) {
        full.fates[i] = uniform(0.0, 1.0) < 0.05 ? (uint8_t)random_bits() : RHO_FATE_HELD;
    }
}

static void random_frames_leave_sound_tracks(void **state)
{
    (void)state;
    unsigned taken = 0, tracks = 0;
    memset(&full, 0, sizeof full);
    random_state = 70;
    for (unsigned run = 0; run < 12; run++) {
        init_default_passive();
        for (unsigned step = 0; step < 25; step++) {
            make_random_frame(step);
            draw_fates();
            enum rho_status status = rho_passive_push(&passive, &full.frame, full.fates);
            taken += status == RHO_OK;
            tracks += passive.num_tracks;
        }
        expect_sound_search();
        tracks += passive.num_tracks;
    }
    print_message("fuzz: %u frames taken, %u tracks\n", taken, tracks);
    assert_true(taken > 40);
}

static struct rho_passive_config random_config_maybe_invalid(void)
{
    struct rho_passive_config config;
    config.scans = (uint16_t)uniform(3.0, 10.0);
    config.range_max_m = random_float(1e3, 2e5);
    config.v_max_mps = random_float(1.0, 2e3);
    config.pd = random_float(0.01, 0.999);
    config.field_of_view_rad = random_float(0.01, 6.28);
    config.false_tracks_per_hour = random_float(1e-6, 1e6);
    config.work_max = (uint32_t)uniform(0.0, 1.1 * RHO_LIMIT_WORK);
    return config;
}

static void random_configurations_leave_sound_tracks(void **state)
{
    (void)state;
    unsigned taken = 0;
    prepare_batch();
    for (unsigned run = 0; run < 300; run++) {
        struct rho_passive_config config = random_config_maybe_invalid();
        if (rho_passive_init(&passive, sizeof passive, &config) == RHO_OK) {
            enum rho_status status = push_scans_from(&passive, &scene, 0);
            assert_true(status == RHO_OK || status == RHO_ERROR_VALUE);
            taken += status == RHO_OK;
            expect_sound_search();
        }
    }
    print_message("fuzz: %u configurations taken\n", taken);
    assert_true(taken > 30);
}

static void a_small_batch_keeps_the_newest_scans(void **state)
{
    (void)state;
    struct rho_passive_config config;
    rho_passive_config_default(&config);
    prepare_batch();
    for (config.scans = RHO_BATCH_SCANS_MIN; config.scans <= 4; config.scans++) {
        init_passive(&config);
        push_scene();
        assert_int_equal(passive.batch.num_scans, config.scans);
        assert_int_equal(passive.batch.time_us[0], 10000000 * (8 - config.scans));
        expect_sound_search();
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_of_scans_out_of_range_are_refused),
        cmocka_unit_test(target_and_sensor_parameters_out_of_range_are_refused),
        cmocka_unit_test(parameters_that_are_not_finite_are_refused),
        cmocka_unit_test(the_default_configuration_is_that_of_the_header),
        cmocka_unit_test(an_object_can_be_initialised_with_its_own_configuration),
        cmocka_unit_test(null_pointers_are_refused),
        cmocka_unit_test(a_wrong_object_size_is_refused),
        cmocka_unit_test(an_object_without_init_is_refused),
        cmocka_unit_test(places_that_are_no_coordinates_are_refused),
        cmocka_unit_test(sensors_may_move_stand_together_and_be_far_apart),
        cmocka_unit_test(a_full_batch_of_false_bearings_makes_one_track_at_most),
        cmocka_unit_test(targets_are_found_where_crossings_have_no_room),
        cmocka_unit_test(a_search_keeps_to_its_work),
        cmocka_unit_test(parallel_bearings_make_no_track),
        cmocka_unit_test(bearings_along_the_base_make_no_certain_track),
        cmocka_unit_test(targets_on_the_extended_base_make_no_certain_track),
        cmocka_unit_test(a_target_that_passes_over_a_sensor_does_no_harm),
        cmocka_unit_test(frames_without_scans_or_bearings_are_accepted),
        cmocka_unit_test(extreme_scan_times_are_accepted),
        cmocka_unit_test(random_frames_leave_sound_tracks),
        cmocka_unit_test(random_configurations_leave_sound_tracks),
        cmocka_unit_test(a_small_batch_keeps_the_newest_scans),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
