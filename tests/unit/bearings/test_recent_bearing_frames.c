/* SPDX-License-Identifier: MIT */
/*
 * The batch of bearings, a ring of rows of looks: sensors, refusals, fates, owners, the row that a
 * look joins, the oldest row; compared with a simple model.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "passive_scene.h"
#include "rhotrack/detail/recent_bearing_frames.h"

#define NUM(array) (sizeof(array) / sizeof((array)[0]))
#define APART_MAX_M 50000.0f
#define BEARINGS (RHO_MAX_BEARINGS + 4u)

static struct rho_batch batch, before;

/* A valid frame, its scans and bearings, and the bearings' fates. */
static struct {
    struct rho_frame frame;
    struct rho_bearing_scan scans[RHO_MAX_PASSIVE_SENSORS + 1];
    struct rho_bearing bearings[RHO_MAX_PASSIVE_SENSORS + 1][BEARINGS];
    uint8_t fates[(RHO_MAX_PASSIVE_SENSORS + 1) * BEARINGS];
} given;

static float sensor_x_m(unsigned sensor)
{
    return 3000.0f * (float)sensor;
}

/* Makes a frame; each scan has `num` bearings, 0.08 rad from each other. */
static void make_frame(int64_t time_us, unsigned num_sensors, unsigned num)
{
    memset(&given, 0, sizeof given);
    memset(given.fates, RHO_FATE_HELD, sizeof given.fates);
    given.frame.time_us = time_us;
    given.frame.num_scans = num_sensors;
    given.frame.scans = given.scans;
    for (unsigned s = 0; s < num_sensors; s++) {
        given.scans[s] = (struct rho_bearing_scan){.time_us = time_us,
                                                   .sensor_id = (int32_t)(20 + s),
                                                   .x_m = sensor_x_m(s),
                                                   .num_bearings = num,
                                                   .bearings = given.bearings[s]};
        for (unsigned i = 0; i < num; i++) {
            given.bearings[s][i] = (struct rho_bearing){
                .bearing_rad = 0.08f * (float)i + 0.01f * (float)s, .sigma_rad = 0.002f};
        }
    }
}

static void init_batch(unsigned scans_max)
{
    assert_int_equal(rho_batch_init(&batch, scans_max, APART_MAX_M), RHO_OK);
}

static void push_frame(void)
{
    assert_int_equal(rho_batch_accepts(&batch, &given.frame), RHO_OK);
    assert_int_equal(rho_batch_push(&batch, &given.frame, given.fates, NULL), RHO_OK);
}

/* Pushes frames of two sensors with two bearings each, at times 1 to count. */
static void push_frames(unsigned count)
{
    for (unsigned k = 1; k <= count; k++) {
        make_frame(k, 2, 2);
        push_frame();
    }
}

static void init_refuses_values_out_of_range(void **state)
{
    (void)state;
    const float bad_m[] = {
        NAN, INFINITY, -1.0f, 0.0f, 0.99f * RHO_CROSSING_BASE_MIN_M, 4.01f * RHO_LIMIT_POSITION_M};
    memset(&batch, 0x5a, sizeof batch);
    before = batch;
    assert_int_equal(rho_batch_init(NULL, 4, APART_MAX_M), RHO_ERROR_NULL);
    assert_int_equal(rho_batch_init(&batch, 0, APART_MAX_M), RHO_ERROR_CONFIG);
    assert_int_equal(rho_batch_init(&batch, RHO_MAX_PASSIVE_SCANS + 1, APART_MAX_M),
                     RHO_ERROR_CONFIG);
    assert_int_equal(rho_batch_init(&batch, UINT32_MAX, APART_MAX_M), RHO_ERROR_CONFIG);
    for (unsigned i = 0; i < NUM(bad_m); i++) {
        assert_int_equal(rho_batch_init(&batch, 4, bad_m[i]), RHO_ERROR_CONFIG);
    }
    assert_memory_equal(&batch, &before, sizeof batch);
    assert_int_equal(rho_batch_init(&batch, 1, RHO_CROSSING_BASE_MIN_M), RHO_OK);
    assert_int_equal(rho_batch_init(&batch, RHO_MAX_PASSIVE_SCANS, 4.0f * RHO_LIMIT_POSITION_M),
                     RHO_OK);
    assert_int_equal(batch.num_scans + batch.num_sensors, 0);
}

/* The order of later scans and missing sensors do not change the numbers. */
static void a_sensor_keeps_the_number_of_its_first_scan(void **state)
{
    (void)state;
    init_batch(4);
    make_frame(1, 2, 1);
    given.scans[0].sensor_id = -5;
    push_frame();
    assert_int_equal(batch.num_sensors, 2);
    assert_int_equal(batch.sensors[0].sensor_id, -5);
    assert_int_equal(batch.sensors[1].sensor_id, 21);
    assert_float_equal(batch.sensors[1].x_m, sensor_x_m(1), 0.0);
    make_frame(2, 3, 2); /* scans of sensors 22 and 21, none of sensor -5 */
    given.scans[0] = given.scans[2];
    given.frame.num_scans = 2;
    push_frame();
    assert_int_equal(batch.num_sensors, 3);
    assert_int_equal(batch.sensors[2].sensor_id, 22);
    const uint8_t seen[3] = {0, 1, 1}, num[3] = {0, 2, 2};
    assert_memory_equal(batch.was_seen[1], seen, sizeof seen);
    assert_memory_equal(batch.num_bearings[1], num, sizeof num);
    assert_float_equal(batch.bearings[1][2][1].bearing_rad, given.bearings[2][1].bearing_rad, 0.0);
}

/* Three frames are pushed, and `given` is a valid fourth one. */
static void prepare_refusal_tests(void)
{
    init_batch(4);
    push_frames(3);
    make_frame(4, 2, 2);
    before = batch;
}

static void expect_frame_refused(enum rho_status status)
{
    uint8_t fates[sizeof given.fates];
    memcpy(fates, given.fates, sizeof fates);
    assert_int_equal(rho_batch_accepts(&batch, &given.frame), status);
    assert_int_equal(rho_batch_push(&batch, &given.frame, given.fates, NULL), status);
    assert_memory_equal(&batch, &before, sizeof batch);
    assert_memory_equal(given.fates, fates, sizeof fates);
}

static void null_pointers_are_refused(void **state)
{
    (void)state;
    prepare_refusal_tests();
    assert_int_equal(rho_batch_accepts(NULL, &given.frame), RHO_ERROR_NULL);
    assert_int_equal(rho_batch_accepts(&batch, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_batch_push(NULL, &given.frame, given.fates, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_batch_push(&batch, NULL, given.fates, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_batch_push(&batch, &given.frame, NULL, NULL), RHO_ERROR_NULL);
    given.scans[1].bearings = NULL;
    expect_frame_refused(RHO_ERROR_NULL);
    given.scans[1].num_bearings = 0;
    push_frame(); /* a scan without bearings may have no array */
    prepare_refusal_tests();
    given.frame.scans = NULL;
    expect_frame_refused(RHO_ERROR_NULL);
    given.frame.num_scans = 0;
    assert_int_equal(rho_batch_push(&batch, &given.frame, NULL, NULL), RHO_OK);
    assert_int_equal(batch.num_scans, 4);
}

static void a_frame_must_be_newer_than_the_newest(void **state)
{
    (void)state;
    const int64_t bad_us[] = {3, 2, 0, -4, INT64_MIN};
    prepare_refusal_tests();
    for (unsigned i = 0; i < NUM(bad_us); i++) {
        given.frame.time_us = bad_us[i];
        expect_frame_refused(RHO_ERROR_STATE);
    }
    make_frame(INT64_MAX, 2, 2);
    push_frame();
    assert_int_equal(batch.num_scans, 4);
    assert_true(rho_batch_is_sound(&batch)); /* an unsound batch could not be saved */
}

/* The known sensors, 20 and 21, are 3 km apart. */
static void sensors_too_far_or_at_no_place_are_refused(void **state)
{
    (void)state;
    const float bad_x_m[] = {NAN,
                             INFINITY,
                             -INFINITY,
                             1.01f * RHO_LIMIT_POSITION_M,
                             -1.01f * RHO_LIMIT_POSITION_M,
                             3001.0f + APART_MAX_M, /* too far from sensors 20 and 21 */
                             -APART_MAX_M - 1.0f};
    prepare_refusal_tests();
    for (unsigned i = 0; i < NUM(bad_x_m); i++) {
        given.scans[1] = (struct rho_bearing_scan){.sensor_id = 99, .x_m = bad_x_m[i]};
        expect_frame_refused(RHO_ERROR_VALUE);
        given.scans[1] = (struct rho_bearing_scan){.sensor_id = 21, .x_m = bad_x_m[i]};
        expect_frame_refused(RHO_ERROR_VALUE);
    }
    given.scans[1] = (struct rho_bearing_scan){.sensor_id = 99, .x_m = 4000.0f, .y_m = NAN};
    expect_frame_refused(RHO_ERROR_VALUE);
    given.scans[1].y_m = 0.0f;
    push_frame();
    assert_int_equal(batch.num_sensors, 3);
}

/* The two sensors are both new: each is near enough to the known ones, but not to the other. */
static void new_sensors_of_one_frame_must_be_at_allowed_distances(void **state)
{
    (void)state;
    const float far_y_m = 0.8f * APART_MAX_M;
    prepare_refusal_tests();
    given.scans[0] = (struct rho_bearing_scan){.sensor_id = 98, .y_m = 5000.0f};
    given.scans[1] = (struct rho_bearing_scan){.sensor_id = 98, .y_m = 6000.0f};
    expect_frame_refused(RHO_ERROR_VALUE); /* one sensor twice */
    given.scans[0] = (struct rho_bearing_scan){.sensor_id = 98, .y_m = far_y_m};
    given.scans[1] = (struct rho_bearing_scan){.sensor_id = 99, .y_m = -far_y_m};
    expect_frame_refused(RHO_ERROR_VALUE);
    given.scans[0] = (struct rho_bearing_scan){.sensor_id = 20};
    given.scans[1] = given.scans[0];
    expect_frame_refused(RHO_ERROR_VALUE);
}

static void scans_too_long_before_or_after_their_frame_are_refused(void **state)
{
    (void)state;
    prepare_refusal_tests();
    given.scans[1].time_us = given.frame.time_us + RHO_LIMIT_OFFSET_US + 1;
    expect_frame_refused(RHO_ERROR_VALUE);
    given.scans[1].time_us = given.frame.time_us - RHO_LIMIT_OFFSET_US - 1;
    expect_frame_refused(RHO_ERROR_VALUE);
    given.scans[1].time_us = INT64_MIN;
    expect_frame_refused(RHO_ERROR_VALUE);
    given.scans[0].time_us = given.frame.time_us + RHO_LIMIT_OFFSET_US;
    given.scans[1].time_us = given.frame.time_us - RHO_LIMIT_OFFSET_US;
    push_frame();
    assert_int_equal(batch.looks[3][0].offset_us, RHO_LIMIT_OFFSET_US);
    assert_int_equal(batch.looks[3][1].offset_us, -RHO_LIMIT_OFFSET_US);
    assert_int_equal(batch.newest_us, 4);
}

/* A known sensor moves to the place of the other, and a new one is there, too. */
static void sensors_may_move_and_stand_together(void **state)
{
    (void)state;
    prepare_refusal_tests();
    given.scans[1].x_m = 0.25f;
    given.scans[1].y_m = -40.0f;
    push_frame();
    assert_int_equal(batch.num_sensors, 2);
    assert_true(batch.sensors[1].x_m == 0.25f && batch.sensors[1].y_m == -40.0f);
    assert_true(batch.looks[2][1].x_m == sensor_x_m(1) && batch.looks[2][1].y_m == 0.0f);
    assert_true(batch.looks[3][1].x_m == 0.25f && batch.looks[3][1].y_m == -40.0f);
    make_frame(5, 2, 2);
    given.scans[0] = (struct rho_bearing_scan){.time_us = 5, .sensor_id = 99, .x_m = 0.25f};
    given.scans[1] = (struct rho_bearing_scan){.time_us = 5, .sensor_id = 21, .x_m = 0.25f};
    push_frame();
    assert_int_equal(batch.num_sensors, 3);
    assert_true(batch.sensors[2].x_m == 0.25f && batch.sensors[1].x_m == 0.25f);
    assert_true(rho_batch_is_sound(&batch));
}

static void sensors_beyond_the_capacity_are_refused(void **state)
{
    (void)state;
    init_batch(4);
    make_frame(1, RHO_MAX_PASSIVE_SENSORS + 1, 1);
    before = batch;
    expect_frame_refused(RHO_ERROR_CAPACITY); /* all in one frame */
    given.frame.num_scans--;
    push_frame();
    make_frame(2, 1, 1);
    given.scans[0].sensor_id = 99;
    given.scans[0].x_m = sensor_x_m(RHO_MAX_PASSIVE_SENSORS);
    before = batch;
    expect_frame_refused(RHO_ERROR_CAPACITY); /* one new sensor in a later frame */
}

static void fates_tell_which_bearings_are_held_or_invalid(void **state)
{
    (void)state;
    const float bad_rad[] = {NAN, INFINITY, -INFINITY, 3.1417f, -3.1417f};
    const float bad_sigma_rad[] = {NAN, 0.0f, -0.1f, 0.9f * RHO_LIMIT_SIGMA_RAD_MIN, 0.51f};
    for (unsigned i = 0; i < NUM(bad_rad); i++) {
        init_batch(4);
        make_frame(1, 2, 4);
        given.bearings[0][1].bearing_rad = bad_rad[i];
        given.bearings[1][2].sigma_rad = bad_sigma_rad[i];
        push_frame();
        for (unsigned place = 0; place < 8; place++) {
            assert_int_equal(given.fates[place],
                             place == 1 || place == 6 ? RHO_FATE_INVALID : RHO_FATE_HELD);
        }
        assert_int_equal(batch.num_bearings[0][0], 3);
        assert_float_equal(batch.bearings[0][0][1].bearing_rad, 0.16, 1e-6);
    }
    make_frame(2, 2, 1);
    given.bearings[0][0] =
        (struct rho_bearing){.bearing_rad = (float)PI, .sigma_rad = RHO_LIMIT_SIGMA_RAD_MIN};
    given.bearings[1][0] =
        (struct rho_bearing){.bearing_rad = -(float)PI, .sigma_rad = RHO_LIMIT_SIGMA_RAD_MAX};
    push_frame();
    assert_int_equal(given.fates[0] + given.fates[1], 2 * RHO_FATE_HELD);
}

static void elevations_are_held_as_slopes_from_the_sensors_height(void **state)
{
    (void)state;
    init_batch(4);
    make_frame(1, 2, 4);
    given.scans[0].z_m = 250.0f;
    given.scans[1].z_m = -30.0f;
    for (unsigned i = 0; i < 4; i++) {
        given.bearings[1][i].elevation_rad = 0.45f * (float)i - 0.45f;
        given.bearings[1][i].sigma_elevation_rad = i < 3 ? 0.01f : 0.0f;
    }
    given.bearings[0][2].elevation_rad = 1.5f; /* too steep: the bearing alone is held */
    given.bearings[0][2].sigma_elevation_rad = 0.01f;
    push_frame();
    assert_true(rho_batch_is_sound(&batch));
    assert_true(batch.looks[0][0].z_m == 250.0f && batch.looks[0][1].z_m == -30.0f);
    for (unsigned i = 0; i < 4; i++) {
        const struct rho_batch_bearing *with = &batch.bearings[0][1][i];
        const double slope = tan(0.45 * i - 0.45);
        assert_true(batch.bearings[0][0][i].sigma_slope == 0.0f);
        assert_float_equal(with->sigma_slope, i < 3 ? 0.01 * (1.0 + slope * slope) : 0.0, 1e-6);
        assert_true(i == 3 || fabs((double)with->slope - slope) < 1e-6);
    }
}

/* The steepest and least certain elevation that is valid leaves a sound batch. */
static void extreme_elevations_leave_a_sound_batch(void **state)
{
    const float extreme_rad[] = {1.4f, -1.4f, 1.57079637f, -1.57079637f};
    (void)state;
    for (unsigned i = 0; i < NUM(extreme_rad); i++) {
        init_batch(4);
        make_frame(1, 1, 1);
        given.bearings[0][0].elevation_rad = extreme_rad[i];
        given.bearings[0][0].sigma_elevation_rad = RHO_LIMIT_SIGMA_RAD_MAX;
        push_frame();
        assert_int_equal(given.fates[0], RHO_FATE_HELD);
        assert_true(rho_batch_is_sound(&batch));
    }
}

static void bearings_with_invalid_elevations_are_invalid(void **state)
{
    const struct rho_bearing bad[] = {
        {.elevation_rad = NAN, .sigma_elevation_rad = 0.01f},
        {.elevation_rad = 1.6f, .sigma_elevation_rad = 0.01f},
        {.elevation_rad = 0.1f, .sigma_elevation_rad = NAN},
        {.elevation_rad = 0.1f, .sigma_elevation_rad = -0.01f},
        {.elevation_rad = 0.1f, .sigma_elevation_rad = 0.6f},
    };
    (void)state;
    for (unsigned i = 0; i < NUM(bad); i++) {
        init_batch(4);
        make_frame(1, 1, 3);
        given.bearings[0][1].elevation_rad = bad[i].elevation_rad;
        given.bearings[0][1].sigma_elevation_rad = bad[i].sigma_elevation_rad;
        push_frame();
        assert_int_equal(given.fates[0], RHO_FATE_HELD);
        assert_int_equal(given.fates[1], RHO_FATE_INVALID);
        assert_int_equal(given.fates[2], RHO_FATE_HELD);
        assert_int_equal(batch.num_bearings[0][0], 2);
    }
}

/*
 * Invalid and claimed bearings take no room; the fates of the second scan follow those of the
 * first.
 */
static void bearings_beyond_the_capacity_find_no_room(void **state)
{
    (void)state;
    init_batch(4);
    make_frame(1, 2, BEARINGS);
    given.bearings[0][0].bearing_rad = NAN;
    given.fates[1] = RHO_FATE_CLAIMED;
    given.fates[2] = RHO_FATE_GHOST;
    push_frame();
    for (unsigned i = 0; i < BEARINGS; i++) {
        assert_int_equal(given.fates[i], i == 0                      ? RHO_FATE_INVALID
                                         : i == 1                    ? RHO_FATE_CLAIMED
                                         : i == 2                    ? RHO_FATE_GHOST
                                         : i - 3 >= RHO_MAX_BEARINGS ? RHO_FATE_NO_ROOM
                                                                     : RHO_FATE_HELD);
        assert_int_equal(given.fates[BEARINGS + i],
                         i >= RHO_MAX_BEARINGS ? RHO_FATE_NO_ROOM : RHO_FATE_HELD);
    }
    assert_int_equal(batch.num_bearings[0][0], RHO_MAX_BEARINGS);
    assert_int_equal(batch.num_bearings[0][1], RHO_MAX_BEARINGS);
}

/* ---- owners ---------------------------------------------------------------------------------- */

/* Claimed bearings are stored with their owners; ghosts are not, nor anything invalid. */
static void bearings_of_owners_are_stored_with_them(void **state)
{
    struct rho_batch_owner owners[8] = {{0}};
    (void)state;
    init_batch(4);
    make_frame(1, 2, 4);
    for (unsigned i = 0; i < 8; i++) {
        owners[i] = (struct rho_batch_owner){.track_id = i % 2 ? 70 + i : 0, .density_nat = 0.5f};
        given.fates[i] = i % 2 ? RHO_FATE_CLAIMED : RHO_FATE_HELD;
    }
    given.fates[2] = RHO_FATE_GHOST;
    given.bearings[1][1].sigma_rad = NAN;
    assert_int_equal(rho_batch_push(&batch, &given.frame, given.fates, owners), RHO_OK);
    const uint32_t first[3] = {0, 71, 73}, second[3] = {0, 0, 77};
    assert_int_equal(batch.num_bearings[0][0], 3);
    assert_int_equal(batch.num_bearings[0][1], 3);
    for (unsigned i = 0; i < 3; i++) {
        assert_int_equal(batch.bearings[0][0][i].owner.track_id, first[i]);
        assert_int_equal(batch.bearings[0][1][i].owner.track_id, second[i]);
        assert_true(batch.bearings[0][0][i].owner.density_nat == 0.5f);
    }
    assert_int_equal(given.fates[1], RHO_FATE_CLAIMED);
    assert_int_equal(given.fates[2], RHO_FATE_GHOST);
    assert_int_equal(given.fates[5], RHO_FATE_INVALID);
}

/* Only bearings without an owner count as left when their row goes. */
static void bearings_of_owners_do_not_count_as_left(void **state)
{
    struct rho_batch_owner owners[4] = {{.track_id = 9}, {.track_id = 0}, {.track_id = 9}};
    (void)state;
    init_batch(1);
    make_frame(1, 2, 2);
    given.fates[0] = given.fates[2] = RHO_FATE_CLAIMED;
    assert_int_equal(rho_batch_push(&batch, &given.frame, given.fates, owners), RHO_OK);
    assert_int_equal(batch.num_bearings[0][0] + batch.num_bearings[0][1], 4);
    assert_int_equal(batch.num_left, 0);
    make_frame(2, 2, 2);
    push_frame();
    assert_int_equal(batch.num_left, 2);
}

/* ---- rows ------------------------------------------------------------------------------------ */

#define SECOND_US INT64_C(1000000)

/* Pushes a scan of one sensor with two bearings, as a frame of its own. */
static void push_single(unsigned sensor, int64_t time_us)
{
    make_frame(time_us, sensor + 1, 2);
    given.frame.scans = &given.scans[sensor];
    given.frame.num_scans = 1;
    push_frame();
    assert_int_equal(batch.newest_us, time_us);
}

static void expect_rows(unsigned num, int is_whole, int is_due)
{
    assert_int_equal(batch.num_scans, num);
    assert_int_equal(batch.is_whole, is_whole);
    assert_int_equal(batch.is_due, is_due);
}

/* The place of a sensor's look in the newest row, after its time; -1: none. */
static int64_t newest_offset_us(unsigned sensor)
{
    return batch.was_seen[batch.num_scans - 1][sensor]
               ? batch.looks[batch.num_scans - 1][sensor].offset_us
               : -1;
}

/* Two sensors look in turn every `interval_us`, until both have looked in `rows` rows. */
static void push_rows_of_two(unsigned rows, int64_t interval_us)
{
    init_batch(8);
    for (unsigned k = 0; k < rows; k++) {
        push_single(0, k * interval_us);
        push_single(1, k * interval_us + interval_us / 2);
    }
    expect_rows(rows, 1, 1);
}

static void single_scans_join_the_newest_row_that_lacks_them(void **state)
{
    (void)state;
    init_batch(8);
    push_single(0, 0);
    expect_rows(1, 1, 1); /* no other sensor is known */
    push_single(1, 3 * SECOND_US);
    expect_rows(1, 1, 1);
    push_single(2, 6 * SECOND_US);
    expect_rows(1, 1, 1);
    push_single(0, 10 * SECOND_US);
    expect_rows(2, 0, 0);
    push_single(1, 13 * SECOND_US);
    expect_rows(2, 0, 0);
    push_single(2, 16 * SECOND_US);
    expect_rows(2, 1, 1);
    for (unsigned k = 0; k < 2; k++) {
        assert_int_equal(batch.time_us[k], 10 * SECOND_US * k);
        for (unsigned s = 0; s < 3; s++) {
            assert_int_equal(batch.was_seen[k][s], 1);
            assert_int_equal(batch.num_bearings[k][s], 2);
            assert_int_equal(batch.looks[k][s].offset_us, 3 * SECOND_US * s);
        }
    }
}

static void a_row_that_waits_takes_a_newer_look_for_an_older_one(void **state)
{
    (void)state;
    push_rows_of_two(2, 10 * SECOND_US);
    push_single(0, 20 * SECOND_US);
    expect_rows(3, 0, 0);
    make_frame(24 * SECOND_US, 1, 1);
    given.bearings[0][0].bearing_rad = -1.5f;
    given.scans[0].x_m = 7.0f;
    push_frame();
    expect_rows(3, 0, 0);
    assert_int_equal(batch.num_left, 2);
    assert_int_equal(batch.time_us[2], 20 * SECOND_US);
    assert_int_equal(newest_offset_us(0), 4 * SECOND_US);
    assert_int_equal(batch.num_bearings[2][0], 1);
    assert_true(batch.bearings[2][0][0].bearing_rad == -1.5f);
    assert_true(batch.looks[2][0].x_m == 7.0f && batch.sensors[0].x_m == 7.0f);
    push_single(1, 25 * SECOND_US);
    expect_rows(3, 1, 1);
    assert_int_equal(newest_offset_us(1), 5 * SECOND_US);
    assert_int_equal(batch.num_left, 0);
    push_single(0, 26 * SECOND_US); /* the row waits for no sensor */
    expect_rows(4, 0, 0);
}

/* Nine tenths of ten seconds, the interval of both sensors. */
static void a_row_ends_at_nine_tenths_of_the_longest_interval(void **state)
{
    (void)state;
    push_rows_of_two(2, 10 * SECOND_US);
    push_single(0, 20 * SECOND_US);
    push_single(0, 29 * SECOND_US - 1000);
    expect_rows(3, 0, 0);
    push_rows_of_two(2, 10 * SECOND_US);
    push_single(0, 20 * SECOND_US);
    push_single(0, 29 * SECOND_US);
    expect_rows(4, 0, 1); /* the row that ended was not whole */
    assert_int_equal(newest_offset_us(0), 0);
    assert_int_equal(newest_offset_us(1), -1);
    push_rows_of_two(2, 10 * SECOND_US);
    push_single(0, 20 * SECOND_US);
    push_single(1, 29 * SECOND_US); /* a sensor that the row lacks is too late for it, too */
    expect_rows(4, 0, 1);
}

/* However long the intervals are, a look is at most RHO_LIMIT_OFFSET_US after its row. */
static void a_row_ends_at_the_largest_offset(void **state)
{
    (void)state;
    push_rows_of_two(2, 100 * SECOND_US);
    push_single(0, 200 * SECOND_US);
    push_single(1, 200 * SECOND_US + RHO_LIMIT_OFFSET_US - 1);
    expect_rows(3, 1, 1);
    push_rows_of_two(2, 100 * SECOND_US);
    push_single(0, 200 * SECOND_US);
    push_single(1, 200 * SECOND_US + RHO_LIMIT_OFFSET_US);
    expect_rows(4, 0, 1);
}

/* A sensor that is silent keeps no row open for longer than an interval. */
static void a_silent_sensor_leaves_rows_that_are_due_when_they_end(void **state)
{
    (void)state;
    push_rows_of_two(2, 10 * SECOND_US);
    push_single(0, 20 * SECOND_US);
    expect_rows(3, 0, 0);
    for (unsigned k = 3; k < 8; k++) {
        push_single(0, 10 * SECOND_US * k);
        expect_rows(k + 1, 0, 1);
    }
    push_single(1, 75 * SECOND_US);
    expect_rows(8, 1, 1);
    push_single(0, 80 * SECOND_US);
    expect_rows(8, 0, 0);
    assert_int_equal(batch.time_us[7], 80 * SECOND_US);
}

/* A frame of several sensors is a row of its own, which a sensor that was missing may join. */
static void a_frame_of_several_sensors_makes_a_row_whole(void **state)
{
    (void)state;
    init_batch(8);
    for (unsigned k = 0; k < 2; k++) {
        make_frame(10 * SECOND_US * k, 3, 1);
        push_frame();
        expect_rows(k + 1, 1, 1);
    }
    make_frame(20 * SECOND_US, 2, 1);
    push_frame();
    expect_rows(3, 1, 1); /* sensor 2 is missing */
    push_single(2, 22 * SECOND_US);
    assert_int_equal(batch.num_scans, 3);
    assert_int_equal(batch.is_whole, 1);
    assert_int_equal(newest_offset_us(2), 2 * SECOND_US);
    push_single(2, 24 * SECOND_US);
    expect_rows(4, 0, 0);
}

/* The row has a frame of two of four sensors: the third one's look does not change that. */
static void a_row_with_a_frame_of_several_sensors_stays_whole(void **state)
{
    (void)state;
    if (RHO_MAX_PASSIVE_SENSORS < 4) {
        return;
    }
    init_batch(8);
    for (unsigned k = 0; k < 2; k++) {
        make_frame(10 * SECOND_US * k, 4, 1);
        push_frame();
    }
    make_frame(20 * SECOND_US, 2, 1);
    push_frame();
    push_single(2, 22 * SECOND_US);
    assert_int_equal(batch.num_scans, 3);
    assert_int_equal(batch.is_whole, 1);
    push_single(0, 31 * SECOND_US); /* beyond 0.9 of the twelve seconds of sensor 2 */
    expect_rows(4, 0, 0);
}

/* Times as far apart as they may be are no interval, and no row is that long. */
/* A caller who states the frame's time alone means it for all its scans. */
static void a_scan_without_a_time_is_of_its_frames(void **state)
{
    (void)state;
    init_batch(4);
    push_single(0, 100000000);
    given.scans[0].time_us = 0;
    given.frame.time_us = 110000000;
    assert_int_equal(rho_batch_push(&batch, &given.frame, given.fates, NULL), RHO_OK);
    assert_int_equal(batch.time_us[1] + batch.looks[1][0].offset_us, 110000000);
}

static void the_first_and_last_possible_times_are_different_rows(void **state)
{
    (void)state;
    init_batch(8);
    push_single(0, INT64_MIN);
    push_single(1, INT64_MAX);
    assert_int_equal(batch.num_scans, 2);
    assert_true(rho_batch_is_sound(&batch));
}

/* ---- a simple model -------------------------------------------------------------------------- */

struct plain_bearing {
    float bearing_rad, sigma_rad;
    uint32_t track_id;
};

struct plain_look {
    int was_seen;
    int64_t time_us;
    float x_m;
    unsigned num;
    struct plain_bearing bearings[RHO_MAX_BEARINGS];
};

static struct plain_row {
    int64_t time_us;
    struct plain_look look[RHO_MAX_PASSIVE_SENSORS];
} rows[RHO_MAX_PASSIVE_SCANS];
static unsigned num_rows, num_known;
static int32_t known_id[RHO_MAX_PASSIVE_SENSORS];
static float known_x_m[RHO_MAX_PASSIVE_SENSORS];

/* Number of a known sensor; num_known: it is not. */
static unsigned plain_number_of_sensor(int32_t sensor_id)
{
    unsigned s = 0;
    while (s < num_known && known_id[s] != sensor_id) {
        s++;
    }
    return s;
}

static unsigned plain_count_free_bearings(const struct plain_look *look)
{
    unsigned count = 0;
    for (unsigned i = 0; i < look->num; i++) {
        count += look->bearings[i].track_id == 0;
    }
    return count;
}

/* Longest time from the last look of a sensor but one to its last; four of the shortest at most. */
static int64_t plain_longest_interval_us(void)
{
    int64_t longest_us = 0, shortest_us = INT64_MAX / 8;
    for (unsigned s = 0; s < num_known; s++) {
        int64_t last_us = 0, interval_us = 0;
        unsigned looks = 0;
        for (unsigned k = 0; k < num_rows; k++) {
            if (rows[k].look[s].was_seen) {
                interval_us = looks++ > 0 ? rows[k].look[s].time_us - last_us : 0;
                last_us = rows[k].look[s].time_us;
            }
        }
        longest_us = interval_us > longest_us ? interval_us : longest_us;
        shortest_us = interval_us > 0 && interval_us < shortest_us ? interval_us : shortest_us;
    }
    return longest_us < 4 * shortest_us ? longest_us : 4 * shortest_us;
}

static int plain_row_lacks_one(const struct plain_row *row)
{
    unsigned seen = 0;
    for (unsigned s = 0; s < num_known; s++) {
        seen += (unsigned)row->look[s].was_seen;
    }
    return seen < num_known;
}

/* Whether the row lacks all sensors of `given`. */
static int plain_row_lacks_given(const struct plain_row *row)
{
    for (unsigned i = 0; i < given.frame.num_scans; i++) {
        unsigned s = plain_number_of_sensor(given.scans[i].sensor_id);
        if (s < num_known && row->look[s].was_seen) {
            return 0;
        }
    }
    return 1;
}

/* Whether `given` joins the newest row: it lacks a look, and is not too old. */
static int plain_joins(void)
{
    if (num_rows == 0) {
        return 0;
    }
    const struct plain_row *newest = &rows[num_rows - 1];
    int64_t age_us = given.frame.time_us - newest->time_us;
    int64_t interval_us = plain_longest_interval_us();
    return (interval_us == 0 || 10 * age_us < 9 * interval_us) &&
           (plain_row_lacks_given(newest) || plain_row_lacks_one(newest));
}

/* Returns a bearing's fate; a held one, and a claimed one with an owner, is stored. */
static uint8_t plain_add_bearing(struct plain_look *look, const struct rho_bearing *bearing,
                                 uint8_t fate, const struct rho_batch_owner *owner)
{
    if (fate != RHO_FATE_HELD && !(owner && fate == RHO_FATE_CLAIMED)) {
        return fate;
    }
    if (!(fabs((double)bearing->bearing_rad) < 3.1416)) {
        return RHO_FATE_INVALID;
    }
    if (look->num == RHO_MAX_BEARINGS) {
        return RHO_FATE_NO_ROOM;
    }
    look->bearings[look->num++] = (struct plain_bearing){bearing->bearing_rad, bearing->sigma_rad,
                                                         owner ? owner->track_id : 0};
    return fate;
}

/*
 * Pushes `given` into the model; returns how many bearings without an owner left. The expected
 * fates are written over `fates`.
 */
static unsigned plain_push_and_count_bearings_left(unsigned rows_max, uint8_t *fates,
                                                   const struct rho_batch_owner *owners)
{
    unsigned num_left = 0;
    if (!plain_joins()) {
        if (num_rows == rows_max) {
            for (unsigned s = 0; s < RHO_MAX_PASSIVE_SENSORS; s++) {
                num_left += plain_count_free_bearings(&rows[0].look[s]);
            }
            for (unsigned k = 1; k < num_rows; k++) {
                rows[k - 1] = rows[k];
            }
            num_rows--;
        }
        memset(&rows[num_rows], 0, sizeof rows[0]);
        rows[num_rows++].time_us = given.frame.time_us;
    }
    for (unsigned i = 0, place = 0; i < given.frame.num_scans; i++) {
        unsigned s = plain_number_of_sensor(given.scans[i].sensor_id);
        struct plain_look *look = &rows[num_rows - 1].look[s];
        num_left += plain_count_free_bearings(look);
        num_known += s == num_known;
        known_id[s] = given.scans[i].sensor_id;
        known_x_m[s] = given.scans[i].x_m;
        *look = (struct plain_look){.was_seen = 1,
                                    .time_us = given.scans[i].time_us ? given.scans[i].time_us
                                                                      : given.frame.time_us,
                                    .x_m = given.scans[i].x_m};
        for (unsigned j = 0; j < given.scans[i].num_bearings; j++, place++) {
            fates[place] = plain_add_bearing(look, &given.scans[i].bearings[j], fates[place],
                                             owners ? &owners[place] : NULL);
        }
    }
    return num_left;
}

/*
 * A random number of sensors in random order, often one, at places and times of their own, with
 * random bearings, some of them invalid.
 */
static void make_random_frame(int64_t time_us)
{
    make_frame(time_us, RHO_MAX_PASSIVE_SENSORS, BEARINGS);
    for (unsigned i = RHO_MAX_PASSIVE_SENSORS; i > 1; i--) {
        unsigned j = (unsigned)uniform(0.0, i);
        struct rho_bearing_scan scan = given.scans[i - 1];
        given.scans[i - 1] = given.scans[j];
        given.scans[j] = scan;
    }
    given.frame.num_scans =
        uniform(0.0, 1.0) < 0.6 ? 1 : (unsigned)uniform(0.0, RHO_MAX_PASSIVE_SENSORS + 0.999);
    for (unsigned s = 0; s < given.frame.num_scans; s++) {
        given.scans[s].time_us += given.frame.num_scans > 1 ? (int64_t)uniform(-9.0, 9.0) : 0;
        given.scans[s].x_m += (float)uniform(-100.0, 100.0);
        given.scans[s].num_bearings = (unsigned)uniform(0.0, BEARINGS);
        for (unsigned i = 0; i < BEARINGS; i++) {
            given.bearings[s][i].bearing_rad = (float)uniform(-PI, 1.1 * PI);
            given.bearings[s][i].sigma_rad = (float)uniform(1e-4, 0.4);
        }
    }
    for (unsigned i = 0; i < sizeof given.fates; i++) {
        given.fates[i] = uniform(0.0, 1.0) < 0.1 ? RHO_FATE_CLAIMED : RHO_FATE_HELD;
    }
}

static void push_random_frame(unsigned rows_max)
{
    uint8_t fates[sizeof given.fates];
    struct rho_batch_owner owners[sizeof given.fates];
    const struct rho_batch_owner *used = uniform(0.0, 1.0) < 0.5 ? owners : NULL;
    for (unsigned i = 0; i < NUM(owners); i++) {
        owners[i] = (struct rho_batch_owner){
            .track_id = given.fates[i] == RHO_FATE_CLAIMED ? 1 + i : 0,
            .density_nat = given.fates[i] == RHO_FATE_CLAIMED ? 1.0f : 0.0f};
    }
    memcpy(fates, given.fates, sizeof fates);
    unsigned num_left = plain_push_and_count_bearings_left(rows_max, fates, used);
    assert_int_equal(rho_batch_push(&batch, &given.frame, given.fates, used), RHO_OK);
    assert_memory_equal(given.fates, fates, sizeof fates);
    assert_int_equal(batch.num_left, num_left);
    assert_int_equal(batch.newest_us, given.frame.time_us);
}

static void expect_look(unsigned k, unsigned s)
{
    const struct plain_look *look = &rows[k].look[s];
    assert_int_equal(batch.was_seen[k][s], look->was_seen);
    assert_int_equal(batch.num_bearings[k][s], look->num);
    if (look->was_seen) {
        assert_int_equal(batch.time_us[k] + batch.looks[k][s].offset_us, look->time_us);
        assert_true(batch.looks[k][s].x_m == look->x_m);
    }
    for (unsigned i = 0; i < look->num; i++) {
        const struct rho_batch_bearing *bearing = &batch.bearings[k][s][i];
        double bearing_rad = (double)look->bearings[i].bearing_rad;
        assert_true(bearing->bearing_rad == look->bearings[i].bearing_rad);
        assert_true(bearing->sigma_rad == look->bearings[i].sigma_rad);
        assert_int_equal(bearing->owner.track_id, look->bearings[i].track_id);
        assert_float_equal(bearing->cosine, cos(bearing_rad), 2e-7);
        assert_float_equal(bearing->sine, sin(bearing_rad), 2e-7);
    }
}

static void expect_batch_agrees_with_model(void)
{
    assert_int_equal(batch.num_scans, num_rows);
    assert_int_equal(batch.num_sensors, num_known);
    for (unsigned s = 0; s < num_known; s++) {
        assert_int_equal(batch.sensors[s].sensor_id, known_id[s]);
        assert_true(batch.sensors[s].x_m == known_x_m[s]);
    }
    for (unsigned k = 0; k < num_rows; k++) {
        assert_int_equal(batch.time_us[k], rows[k].time_us);
        for (unsigned s = 0; s < num_known; s++) {
            expect_look(k, s);
        }
    }
    assert_true(rho_batch_is_sound(&batch));
}

static void random_calls_agree_with_a_simple_model(void **state)
{
    (void)state;
    const unsigned sizes[] = {1, 2, 5, RHO_MAX_PASSIVE_SCANS};
    unsigned joined = 0;
    random_state = 11;
    for (unsigned run = 0; run < NUM(sizes); run++) {
        int64_t time_us = -50;
        init_batch(sizes[run]);
        num_rows = num_known = 0;
        for (unsigned step = 0; step < 400; step++) {
            time_us += (int64_t)uniform(1.0, 12.0);
            make_random_frame(time_us);
            joined += (unsigned)plain_joins();
            push_random_frame(sizes[run]);
            expect_batch_agrees_with_model();
        }
    }
    print_message("rows: %u of 1600 frames joined one\n", joined);
    assert_in_range(joined, 400, 1400);
}

static void sensors_at_no_height_are_refused(void **state)
{
    const float bad_z_m[] = {NAN, INFINITY, -INFINITY, 1.01f * RHO_LIMIT_POSITION_M};
    (void)state;
    prepare_refusal_tests();
    for (unsigned i = 0; i < NUM(bad_z_m); i++) {
        given.scans[1].z_m = bad_z_m[i];
        expect_frame_refused(RHO_ERROR_VALUE);
    }
}

/* Pushes one look of a sensor, with two bearings. */
static void push_look(int64_t time_us, unsigned sensor)
{
    make_frame(time_us, sensor + 1u, 2);
    given.scans[0] = given.scans[sensor];
    given.frame.num_scans = 1;
    push_frame();
}

static void looks_of_one_time_share_a_row(void **state)
{
    (void)state;
    init_batch(4);
    push_look(1000000, 0);
    push_look(1000000, 1);
    push_look(2000000, 1);
    push_look(2000000, 0);
    assert_int_equal(batch.num_scans, 2);
    assert_int_equal(batch.num_bearings[1][0] + batch.num_bearings[1][1], 4);
    assert_true(batch.is_whole && batch.is_due);
    before = batch;
    make_frame(2000000, 1, 2);
    expect_frame_refused(RHO_ERROR_STATE); /* the sensor's second look at that time */
    make_frame(1999999, 1, 2);
    expect_frame_refused(RHO_ERROR_STATE);
}

/* Two sensors look each second, a third one now and then: rows wait for it four seconds at most. */
static void a_sensor_that_looks_now_and_then_keeps_no_row_open(void **state)
{
    (void)state;
    unsigned due = 0;
    init_batch(4);
    for (int64_t t_s = 0; t_s < 120; t_s++) {
        push_look(1000000 * t_s, 0);
        due += batch.is_due;
        push_look(1000000 * t_s, 1);
        due += batch.is_due;
        if (t_s == 0 || t_s == 6 || t_s == 18 || t_s == 42 || t_s == 90) {
            push_look(1000000 * t_s, 2);
        }
        assert_true(batch.newest_us - batch.time_us[batch.num_scans - 1u] < 4000000);
    }
    assert_true(due > 25);
}

/* While all are heard there is no room for another one, whose looks would not be told apart. */
static void a_silent_sensor_makes_room_for_another_one(void **state)
{
    (void)state;
    init_batch(4);
    for (unsigned s = 0; s < RHO_MAX_PASSIVE_SENSORS; s++) {
        push_look(1 + s, s);
    }
    for (int64_t time_us = 30000000; time_us <= 60000000; time_us += 30000000) {
        for (unsigned s = 1; s < RHO_MAX_PASSIVE_SENSORS; s++) {
            push_look(time_us + s, s);
        }
    }
    make_frame(60000001 + RHO_MAX_PASSIVE_SENSORS, 1, 2);
    given.scans[0].sensor_id = 99;
    push_frame(); /* sensor 20 was silent for more than a minute */
    assert_int_equal(batch.num_sensors, RHO_MAX_PASSIVE_SENSORS);
    assert_int_equal(batch.sensors[0].sensor_id, 99);
    unsigned kept = 0;
    for (unsigned k = 0; k < batch.num_scans; k++) {
        kept += batch.num_bearings[k][0];
    }
    assert_int_equal(kept, 2); /* the other one's own: those of sensor 20 are gone */
    assert_float_equal(batch.looks[0][0].x_m, 0.0, 0.0);
    before = batch;
    make_frame(60000002 + RHO_MAX_PASSIVE_SENSORS, 1, 2);
    expect_frame_refused(RHO_ERROR_CAPACITY); /* sensor 20 again, as all are heard */
    assert_true(rho_batch_is_sound(&batch));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(init_refuses_values_out_of_range),
        cmocka_unit_test(looks_of_one_time_share_a_row),
        cmocka_unit_test(a_sensor_that_looks_now_and_then_keeps_no_row_open),
        cmocka_unit_test(a_silent_sensor_makes_room_for_another_one),
        cmocka_unit_test(a_sensor_keeps_the_number_of_its_first_scan),
        cmocka_unit_test(null_pointers_are_refused),
        cmocka_unit_test(a_frame_must_be_newer_than_the_newest),
        cmocka_unit_test(sensors_too_far_or_at_no_place_are_refused),
        cmocka_unit_test(new_sensors_of_one_frame_must_be_at_allowed_distances),
        cmocka_unit_test(a_scan_without_a_time_is_of_its_frames),
        cmocka_unit_test(scans_too_long_before_or_after_their_frame_are_refused),
        cmocka_unit_test(sensors_may_move_and_stand_together),
        cmocka_unit_test(sensors_beyond_the_capacity_are_refused),
        cmocka_unit_test(fates_tell_which_bearings_are_held_or_invalid),
        cmocka_unit_test(elevations_are_held_as_slopes_from_the_sensors_height),
        cmocka_unit_test(extreme_elevations_leave_a_sound_batch),
        cmocka_unit_test(bearings_with_invalid_elevations_are_invalid),
        cmocka_unit_test(bearings_beyond_the_capacity_find_no_room),
        cmocka_unit_test(bearings_of_owners_are_stored_with_them),
        cmocka_unit_test(bearings_of_owners_do_not_count_as_left),
        cmocka_unit_test(single_scans_join_the_newest_row_that_lacks_them),
        cmocka_unit_test(a_row_that_waits_takes_a_newer_look_for_an_older_one),
        cmocka_unit_test(a_row_ends_at_nine_tenths_of_the_longest_interval),
        cmocka_unit_test(a_row_ends_at_the_largest_offset),
        cmocka_unit_test(a_silent_sensor_leaves_rows_that_are_due_when_they_end),
        cmocka_unit_test(a_frame_of_several_sensors_makes_a_row_whole),
        cmocka_unit_test(a_row_with_a_frame_of_several_sensors_stays_whole),
        cmocka_unit_test(the_first_and_last_possible_times_are_different_rows),
        cmocka_unit_test(random_calls_agree_with_a_simple_model),
        cmocka_unit_test(sensors_at_no_height_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
