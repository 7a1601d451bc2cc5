/* SPDX-License-Identifier: MIT */
/*
 * The batch of bearings, a ring of frames: sensors, refusals, fates, the oldest frame, removal;
 * compared with a simple model.
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
static struct rho_passive passive;
static struct scene scene;

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

/* Makes a frame; each scan has `num` bearings, 0.1 rad from each other. */
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
                .bearing_rad = 0.1f * (float)i + 0.01f * (float)s, .sigma_rad = 0.002f};
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
    assert_int_equal(rho_batch_push(&batch, &given.frame, given.fates), RHO_OK);
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
    assert_int_equal(rho_batch_push(&batch, &given.frame, given.fates), status);
    assert_memory_equal(&batch, &before, sizeof batch);
    assert_memory_equal(given.fates, fates, sizeof fates);
}

static void null_pointers_are_refused(void **state)
{
    (void)state;
    prepare_refusal_tests();
    assert_int_equal(rho_batch_accepts(NULL, &given.frame), RHO_ERROR_NULL);
    assert_int_equal(rho_batch_accepts(&batch, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_batch_push(NULL, &given.frame, given.fates), RHO_ERROR_NULL);
    assert_int_equal(rho_batch_push(&batch, NULL, given.fates), RHO_ERROR_NULL);
    assert_int_equal(rho_batch_push(&batch, &given.frame, NULL), RHO_ERROR_NULL);
    given.scans[1].bearings = NULL;
    expect_frame_refused(RHO_ERROR_NULL);
    given.scans[1].num_bearings = 0;
    push_frame(); /* a scan without bearings may have no array */
    prepare_refusal_tests();
    given.frame.scans = NULL;
    expect_frame_refused(RHO_ERROR_NULL);
    given.frame.num_scans = 0;
    assert_int_equal(rho_batch_push(&batch, &given.frame, NULL), RHO_OK);
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
    given.frame.time_us = INT64_MAX;
    push_frame();
    assert_true(rho_batch_is_sound(&batch)); /* an unsound batch could not be saved */
}

/* The known sensors, 20 and 21, are 3 km apart. */
static void sensors_that_moved_or_are_too_near_or_far_are_refused(void **state)
{
    (void)state;
    const float bad_x_m[] = {NAN,
                             INFINITY,
                             -INFINITY,
                             1.01f * RHO_LIMIT_POSITION_M,
                             -1.01f * RHO_LIMIT_POSITION_M,
                             0.0f,                  /* the place of sensor 20 */
                             3000.0f + APART_MAX_M, /* too far from sensor 20 */
                             0.99f,
                             -0.99f,
                             3000.99f, /* too near to sensor 20 or 21 */
                             -APART_MAX_M - 1.0f};
    prepare_refusal_tests();
    given.scans[1].x_m += 0.25f;
    expect_frame_refused(RHO_ERROR_VALUE);
    given.scans[1] = (struct rho_bearing_scan){.sensor_id = 20, .y_m = 0.25f};
    expect_frame_refused(RHO_ERROR_VALUE);
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

/*
 * The two sensors are both new: each is at an allowed distance of the known ones, but not of the
 * other.
 */
static void new_sensors_of_one_frame_must_be_at_allowed_distances(void **state)
{
    (void)state;
    const float far_y_m = 0.8f * APART_MAX_M;
    prepare_refusal_tests();
    given.scans[0] = (struct rho_bearing_scan){.sensor_id = 98, .y_m = 5000.0f};
    given.scans[1] = (struct rho_bearing_scan){.sensor_id = 98, .y_m = 6000.0f};
    expect_frame_refused(RHO_ERROR_VALUE);
    given.scans[1] = (struct rho_bearing_scan){.sensor_id = 99, .y_m = 5000.5f};
    expect_frame_refused(RHO_ERROR_VALUE);
    given.scans[0] = (struct rho_bearing_scan){.sensor_id = 98, .y_m = far_y_m};
    given.scans[1] = (struct rho_bearing_scan){.sensor_id = 99, .y_m = -far_y_m};
    expect_frame_refused(RHO_ERROR_VALUE);
    given.scans[0] = (struct rho_bearing_scan){.sensor_id = 20};
    given.scans[1] = given.scans[0];
    expect_frame_refused(RHO_ERROR_VALUE);
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
        assert_float_equal(batch.bearings[0][0][1].bearing_rad, 0.2, 1e-6);
    }
    make_frame(2, 2, 1);
    given.bearings[0][0] =
        (struct rho_bearing){.bearing_rad = (float)PI, .sigma_rad = RHO_LIMIT_SIGMA_RAD_MIN};
    given.bearings[1][0] =
        (struct rho_bearing){.bearing_rad = -(float)PI, .sigma_rad = RHO_LIMIT_SIGMA_RAD_MAX};
    push_frame();
    assert_int_equal(given.fates[0] + given.fates[1], 2 * RHO_FATE_HELD);
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

struct plain_bearing {
    float bearing_rad, sigma_rad;
    int is_out;
};

struct plain_look {
    int was_seen;
    unsigned num;
    struct plain_bearing bearings[RHO_MAX_BEARINGS];
};

static struct plain_frame {
    int64_t time_us;
    struct plain_look look[RHO_MAX_PASSIVE_SENSORS];
} frames[RHO_MAX_PASSIVE_SCANS];
static unsigned num_frames, num_known;
static int32_t known_id[RHO_MAX_PASSIVE_SENSORS];

static void plain_drop_removed(struct plain_look *look)
{
    unsigned kept = 0;
    for (unsigned i = 0; i < look->num; i++) {
        if (!look->bearings[i].is_out) {
            look->bearings[kept++] = look->bearings[i];
        }
    }
    look->num = kept;
}

static void plain_drop_all_removed(void)
{
    for (unsigned k = 0; k < num_frames; k++) {
        for (unsigned s = 0; s < RHO_MAX_PASSIVE_SENSORS; s++) {
            plain_drop_removed(&frames[k].look[s]);
        }
    }
}

static unsigned plain_number_of_sensor(int32_t sensor_id)
{
    unsigned s = 0;
    while (s < num_known && known_id[s] != sensor_id) {
        s++;
    }
    if (s == num_known) {
        known_id[num_known++] = sensor_id;
    }
    return s;
}

/* Returns a bearing's fate; a held one is stored. */
static uint8_t plain_add_bearing(struct plain_look *look, const struct rho_bearing *bearing,
                                 uint8_t fate)
{
    if (fate != RHO_FATE_HELD) {
        return fate;
    }
    if (!(fabs((double)bearing->bearing_rad) < 3.1416)) {
        return RHO_FATE_INVALID;
    }
    if (look->num == RHO_MAX_BEARINGS) {
        return RHO_FATE_NO_ROOM;
    }
    look->bearings[look->num++] =
        (struct plain_bearing){bearing->bearing_rad, bearing->sigma_rad, 0};
    return RHO_FATE_HELD;
}

/*
 * Pushes `given` into the model; returns how many bearings left with the oldest frame. The expected
 * fates are written over `fates`.
 */
static unsigned plain_push_and_count_bearings_dropped(unsigned scans_max, uint8_t *fates)
{
    unsigned num_left = 0;
    plain_drop_all_removed();
    if (num_frames == scans_max) {
        for (unsigned s = 0; s < RHO_MAX_PASSIVE_SENSORS; s++) {
            num_left += frames[0].look[s].num;
        }
        for (unsigned k = 1; k < num_frames; k++) {
            frames[k - 1] = frames[k];
        }
        num_frames--;
    }
    struct plain_frame *frame = &frames[num_frames++];
    memset(frame, 0, sizeof *frame);
    frame->time_us = given.frame.time_us;
    for (unsigned i = 0; i < given.frame.num_scans; i++) {
        struct plain_look *look = &frame->look[plain_number_of_sensor(given.scans[i].sensor_id)];
        look->was_seen = 1;
        for (unsigned j = 0; j < given.scans[i].num_bearings; j++, fates++) {
            *fates = plain_add_bearing(look, &given.scans[i].bearings[j], *fates);
        }
    }
    return num_left;
}

/* A random number of sensors in random order, with random bearings, some of them invalid. */
static void make_random_frame(int64_t time_us)
{
    make_frame(time_us, RHO_MAX_PASSIVE_SENSORS, BEARINGS);
    for (unsigned i = RHO_MAX_PASSIVE_SENSORS; i > 1; i--) {
        unsigned j = (unsigned)uniform(0.0, i);
        struct rho_bearing_scan scan = given.scans[i - 1];
        given.scans[i - 1] = given.scans[j];
        given.scans[j] = scan;
    }
    given.frame.num_scans = (unsigned)uniform(0.0, RHO_MAX_PASSIVE_SENSORS + 0.999);
    for (unsigned s = 0; s < given.frame.num_scans; s++) {
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

static void push_random_frame(unsigned scans_max)
{
    uint8_t fates[sizeof given.fates];
    memcpy(fates, given.fates, sizeof fates);
    unsigned num_left = plain_push_and_count_bearings_dropped(scans_max, fates);
    push_frame();
    assert_memory_equal(given.fates, fates, sizeof fates);
    assert_int_equal(batch.num_left, num_left);
}

/* Removes random bearings by a claim, which names removed and absent ones, too. */
static void remove_random_bearings(void)
{
    uint8_t claim[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
    unsigned count = 0;
    for (unsigned k = 0; k < RHO_MAX_PASSIVE_SCANS; k++) {
        for (unsigned s = 0; s < RHO_MAX_PASSIVE_SENSORS; s++) {
            unsigned place =
                uniform(0.0, 1.0) < 0.5 ? 0 : (unsigned)uniform(0.0, RHO_MAX_BEARINGS + 2.0);
            claim[k][s] = (uint8_t)place;
            if (k < num_frames && place > 0 && place <= frames[k].look[s].num) {
                struct plain_bearing *bearing = &frames[k].look[s].bearings[place - 1];
                count += !bearing->is_out;
                bearing->is_out = 1;
            }
        }
    }
    assert_int_equal(rho_batch_remove(&batch, claim), count);
}

static void expect_bearings_of_scan(unsigned k, unsigned s)
{
    const struct plain_look *look = &frames[k].look[s];
    assert_int_equal(batch.was_seen[k][s], look->was_seen);
    assert_int_equal(batch.num_bearings[k][s], look->num);
    for (unsigned i = 0; i < look->num; i++) {
        const struct rho_batch_bearing *bearing = &batch.bearings[k][s][i];
        double bearing_rad = (double)look->bearings[i].bearing_rad;
        assert_true(bearing->bearing_rad == look->bearings[i].bearing_rad);
        assert_true(bearing->sigma_rad ==
                    (look->bearings[i].is_out ? 0.0f : look->bearings[i].sigma_rad));
        assert_float_equal(bearing->cosine, cos(bearing_rad), 2e-7);
        assert_float_equal(bearing->sine, sin(bearing_rad), 2e-7);
    }
}

static void expect_batch_agrees_with_model(void)
{
    assert_int_equal(batch.num_scans, num_frames);
    assert_int_equal(batch.num_sensors, num_known);
    for (unsigned s = 0; s < num_known; s++) {
        assert_int_equal(batch.sensors[s].sensor_id, known_id[s]);
        assert_float_equal(batch.sensors[s].x_m, sensor_x_m((unsigned)known_id[s] - 20), 0.0);
    }
    for (unsigned k = 0; k < num_frames; k++) {
        assert_int_equal(batch.time_us[k], frames[k].time_us);
        for (unsigned s = 0; s < num_known; s++) {
            expect_bearings_of_scan(k, s);
        }
    }
}

static void random_calls_agree_with_a_simple_model(void **state)
{
    (void)state;
    const unsigned sizes[] = {1, 2, 5, RHO_MAX_PASSIVE_SCANS};
    random_state = 11;
    for (unsigned run = 0; run < NUM(sizes); run++) {
        init_batch(sizes[run]);
        num_frames = num_known = 0;
        for (unsigned step = 0; step < 400; step++) {
            double what = uniform(0.0, 1.0);
            if (what < 0.5) {
                make_random_frame((int64_t)step - 7);
                push_random_frame(sizes[run]);
            } else if (what < 0.9) {
                remove_random_bearings();
            } else {
                rho_batch_compact(&batch);
                plain_drop_all_removed();
            }
            expect_batch_agrees_with_model();
        }
    }
}

/* Two targets seen by two sensors, searched for. */
static void search_two_target_scene(unsigned seed)
{
    random_state = seed;
    scene = scene_of(2, 2, 0.1, 1.0, 0.5);
    draw_scene(&scene);
    assert_int_equal(search_scene(&passive, &scene), RHO_OK);
}

static int are_track_states_near(const struct rho_passive_track *a,
                                 const struct rho_passive_track *b)
{
    return hypot((double)(a->x_m - b->x_m), (double)(a->y_m - b->y_m)) < 100.0 &&
           hypot((double)(a->vx_mps - b->vx_mps), (double)(a->vy_mps - b->vy_mps)) < 5.0;
}

static unsigned count_held_bearings(void)
{
    unsigned count = 0;
    for (unsigned k = 0; k < passive.batch.num_scans; k++) {
        for (unsigned s = 0; s < passive.batch.num_sensors; s++) {
            count += passive.batch.num_bearings[k][s];
        }
    }
    return count;
}

/* Once a track's bearings are consumed, the search finds the other track and nothing else. */
static void a_track_that_was_started_is_not_found_again(void **state)
{
    (void)state;
    unsigned runs = 0;
    for (unsigned seed = 1; seed <= 20; seed++) {
        search_two_target_scene(seed);
        if (passive.num_tracks != 2) {
            continue;
        }
        for (unsigned first = 0; first < 2; first++) {
            search_two_target_scene(seed);
            const struct rho_passive_track gone = passive.tracks[first];
            const struct rho_passive_track kept = passive.tracks[1 - first];
            unsigned held = count_held_bearings();
            assert_int_equal(rho_passive_consume(&passive, &gone), gone.hits);
            assert_int_equal(rho_passive_search(&passive), RHO_OK);
            assert_int_equal(count_held_bearings(), held - gone.hits);
            assert_true(are_tracks_finite_with_right_claims(&passive));
            assert_int_equal(passive.num_tracks, 1);
            assert_true(are_track_states_near(&passive.tracks[0], &kept));
            assert_int_equal(passive.tracks[0].hits, kept.hits);
            runs++;
        }
    }
    print_message("searched again after a start: %u runs\n", runs);
    assert_true(runs >= 32);
}

/* Both claims are of the same search. */
static void tracks_of_one_search_are_consumed_together(void **state)
{
    (void)state;
    search_two_target_scene(1);
    assert_int_equal(passive.num_tracks, 2);
    unsigned held = count_held_bearings(), hits = passive.tracks[0].hits + passive.tracks[1].hits;
    for (unsigned i = 0; i < 2; i++) {
        assert_int_equal(rho_passive_consume(&passive, &passive.tracks[i]), passive.tracks[i].hits);
    }
    assert_int_equal(rho_passive_search(&passive), RHO_OK);
    assert_int_equal(count_held_bearings(), held - hits);
    assert_int_equal(passive.num_tracks, 0);
}

static void consuming_an_empty_or_invalid_track_changes_nothing(void **state)
{
    (void)state;
    search_two_target_scene(1);
    struct rho_passive_track nothing = {.hits = 9};
    struct rho_passive copy = passive;
    assert_int_equal(rho_passive_consume(NULL, &nothing), 0);
    assert_int_equal(rho_passive_consume(&passive, NULL), 0);
    assert_int_equal(rho_passive_consume(&passive, &nothing), 0);
    assert_memory_equal(&passive, &copy, sizeof passive);
    memset(nothing.claim, 255, sizeof nothing.claim); /* claims of bearings beyond the capacity */
    assert_int_equal(rho_passive_consume(&passive, &nothing), 0);
    assert_memory_equal(&passive, &copy, sizeof passive);
    passive.magic = copy.magic = 0;
    assert_int_equal(rho_passive_consume(&passive, &copy.tracks[0]), 0);
    assert_memory_equal(&passive, &copy, sizeof passive);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(init_refuses_values_out_of_range),
        cmocka_unit_test(a_sensor_keeps_the_number_of_its_first_scan),
        cmocka_unit_test(null_pointers_are_refused),
        cmocka_unit_test(a_frame_must_be_newer_than_the_newest),
        cmocka_unit_test(sensors_that_moved_or_are_too_near_or_far_are_refused),
        cmocka_unit_test(new_sensors_of_one_frame_must_be_at_allowed_distances),
        cmocka_unit_test(sensors_beyond_the_capacity_are_refused),
        cmocka_unit_test(fates_tell_which_bearings_are_held_or_invalid),
        cmocka_unit_test(bearings_beyond_the_capacity_find_no_room),
        cmocka_unit_test(random_calls_agree_with_a_simple_model),
        cmocka_unit_test(a_track_that_was_started_is_not_found_again),
        cmocka_unit_test(tracks_of_one_search_are_consumed_together),
        cmocka_unit_test(consuming_an_empty_or_invalid_track_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
