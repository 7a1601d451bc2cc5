/* SPDX-License-Identifier: MIT */
/*
 * Assembly of single sensors' scans into frames: any order of arrival, late scans, clocks that
 * jump, refused scans; compared with a model made of lists.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/detail/recent_bearing_frames.h"
#include "rhotrack/frames.h"

#define SENSORS RHO_MAX_PASSIVE_SENSORS
#define SECOND_US INT64_C(1000000)
#define TOLERANCE_US INT64_C(50000)

static struct rho_frames frames, before;
static struct rho_frame_view view;

static uint64_t random_state;

static uint32_t random_below(uint32_t count)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)((random_state >> 33) % count);
}

/* A scan with its bearings. The first bearing is `tag`, by which a test recognises the scan. */
struct sent {
    struct rho_bearing_scan scan;
    struct rho_bearing bearings[2 * RHO_MAX_BEARINGS];
};

static struct rho_bearing_scan *make_scan(struct sent *sent, unsigned sensor, int64_t time_us,
                                          unsigned num_bearings, unsigned tag)
{
    memset(sent, 0, sizeof *sent);
    sent->scan = (struct rho_bearing_scan){.time_us = time_us,
                                           .sensor_id = 40 - 10 * (int32_t)sensor,
                                           .x_m = 1000.0f * (float)sensor,
                                           .y_m = -5.0f,
                                           .z_m = 10.0f * (float)sensor,
                                           .sector_from_rad = -0.5f,
                                           .sector_to_rad = 0.25f * (float)sensor,
                                           .num_bearings = num_bearings,
                                           .bearings = sent->bearings};
    for (unsigned i = 0; i < num_bearings; i++) {
        sent->bearings[i] = (struct rho_bearing){.offset_us = (int32_t)i,
                                                 .bearing_rad = (float)(tag + i),
                                                 .sigma_rad = 0.01f,
                                                 .snr_db = (float)sensor,
                                                 .elevation_rad = 0.5f,
                                                 .sigma_elevation_rad = 0.02f};
    }
    return &sent->scan;
}

static struct rho_frames_config default_config(void)
{
    struct rho_frames_config config;
    rho_frames_config_default(&config);
    return config;
}

static void init_frames(const struct rho_frames_config *config)
{
    assert_int_equal(rho_frames_init(&frames, sizeof frames, config), RHO_OK);
}

static void init_default_frames(void)
{
    struct rho_frames_config config = default_config();
    init_frames(&config);
}

/* Returns the number of scans of the frame that the push closed; 0: none closed. */
static unsigned push_bearings_and_count_closed_scans(unsigned sensor, int64_t time_us,
                                                     unsigned num_bearings, unsigned tag)
{
    struct sent sent;
    assert_int_equal(rho_frames_push(&frames, make_scan(&sent, sensor, time_us, num_bearings, tag)),
                     RHO_OK);
    memset(&sent, 0x5a, sizeof sent); /* the frames keep a copy */
    int has_closed = rho_frames_closed(&frames, &view);
    assert_int_equal(has_closed, view.frame.num_scans > 0);
    return view.frame.num_scans;
}

static unsigned push_scan_and_count_closed_scans(unsigned sensor, int64_t time_us)
{
    return push_bearings_and_count_closed_scans(sensor, time_us, 1, 0);
}

static unsigned close_frame_and_count_its_scans(void)
{
    assert_int_equal(rho_frames_close(&frames), RHO_OK);
    (void)rho_frames_closed(&frames, &view);
    return view.frame.num_scans;
}

/* Pushes `count` frames of two sensors, one a second from time 0. */
static void push_complete_frames(unsigned count)
{
    for (unsigned k = 0; k < count; k++) {
        assert_int_equal(push_scan_and_count_closed_scans(0, k * SECOND_US), 0);
        assert_int_equal(push_scan_and_count_closed_scans(1, k * SECOND_US), 2);
    }
}

static void a_frame_closes_with_its_last_sensor(void **state)
{
    (void)state;
    init_default_frames();
    assert_int_equal(push_bearings_and_count_closed_scans(0, 7, 2, 100), 0);
    assert_int_equal(push_bearings_and_count_closed_scans(1, 5, 1, 200), 2);
    assert_int_equal(view.frame.time_us, 5);
    assert_int_equal(view.is_restart, 0);
    const struct rho_bearing_scan *scans = view.frame.scans;
    assert_int_equal(scans[0].sensor_id, 30);
    assert_int_equal(scans[1].sensor_id, 40);
    assert_int_equal(scans[0].time_us, 5);
    assert_int_equal(scans[1].time_us, 7);
    assert_int_equal(scans[0].num_bearings, 1);
    assert_int_equal(scans[1].num_bearings, 2);
    assert_true(scans[0].x_m == 1000.0f && scans[0].y_m == -5.0f && scans[1].x_m == 0.0f);
    assert_true(scans[0].z_m == 10.0f && scans[1].z_m == 0.0f);
    assert_true(scans[0].bearings[0].elevation_rad == 0.5f);
    assert_true(scans[0].bearings[0].sigma_elevation_rad == 0.02f);
    assert_true(scans[0].sector_from_rad == -0.5f && scans[0].sector_to_rad == 0.25f);
    assert_true(scans[0].bearings[0].bearing_rad == 200.0f);
    assert_true(scans[1].bearings[1].bearing_rad == 101.0f);
    assert_int_equal(scans[1].bearings[1].offset_us, 1);
    assert_true(scans[1].bearings[1].sigma_rad == 0.01f && scans[0].bearings[0].snr_db == 1.0f);
}

static void scans_join_a_frame_within_the_tolerance_of_its_earliest(void **state)
{
    (void)state;
    init_default_frames();
    assert_int_equal(push_scan_and_count_closed_scans(0, 0), 0);
    assert_int_equal(push_scan_and_count_closed_scans(1, TOLERANCE_US), 2);
    assert_int_equal(push_scan_and_count_closed_scans(0, SECOND_US), 0);
    /* too late for the frame, which it closes */
    assert_int_equal(push_scan_and_count_closed_scans(1, SECOND_US + TOLERANCE_US + 1), 1);
    assert_int_equal(view.frame.time_us, SECOND_US);
    assert_int_equal(view.frame.scans[0].sensor_id, 40);
    assert_int_equal(close_frame_and_count_its_scans(), 1);
    assert_int_equal(frames.counters.frames, 3);
    assert_int_equal(frames.counters.frames_incomplete, 2);
    assert_int_equal(frames.sensors[0].missing, 1);
    assert_int_equal(frames.sensors[1].missing, 1);
}

static void a_scan_that_is_earlier_may_join_the_open_frame(void **state)
{
    (void)state;
    init_default_frames();
    push_complete_frames(1);
    assert_int_equal(push_scan_and_count_closed_scans(0, SECOND_US), 0);
    assert_int_equal(push_scan_and_count_closed_scans(1, SECOND_US - TOLERANCE_US), 2);
    assert_int_equal(view.frame.time_us, SECOND_US - TOLERANCE_US);
    assert_int_equal(push_scan_and_count_closed_scans(0, 2 * SECOND_US), 0);
    /* too early for the open frame */
    assert_int_equal(push_scan_and_count_closed_scans(1, 2 * SECOND_US - TOLERANCE_US - 1), 0);
    assert_int_equal(frames.counters.scans_late, 1);
    assert_int_equal(close_frame_and_count_its_scans(), 1);
}

static void a_sensor_that_reports_again_closes_the_frame(void **state)
{
    (void)state;
    init_default_frames();
    push_complete_frames(1);
    assert_int_equal(push_scan_and_count_closed_scans(0, SECOND_US), 0);
    assert_int_equal(push_scan_and_count_closed_scans(0, SECOND_US + 1), 1);
    assert_int_equal(view.frame.time_us, SECOND_US);
    assert_int_equal(push_scan_and_count_closed_scans(1, SECOND_US + 2), 2);
    assert_int_equal(view.frame.time_us, SECOND_US + 1);
    assert_int_equal(push_scan_and_count_closed_scans(0, 2 * SECOND_US), 0);
    assert_int_equal(push_scan_and_count_closed_scans(0, 2 * SECOND_US),
                     0); /* repeated: frames must differ in time */
    assert_int_equal(frames.counters.scans_late, 1);
}

static void the_caller_closes_a_frame(void **state)
{
    (void)state;
    init_default_frames();
    assert_int_equal(close_frame_and_count_its_scans(), 0);
    assert_int_equal(push_scan_and_count_closed_scans(0, 0), 0);
    assert_int_equal(close_frame_and_count_its_scans(), 1);
    assert_int_equal(close_frame_and_count_its_scans(), 0);
    assert_int_equal(push_scan_and_count_closed_scans(0, 0), 0);
    assert_int_equal(frames.counters.scans_late, 1);
    assert_int_equal(frames.counters.frames, 1);
    assert_int_equal(frames.counters.frames_incomplete, 0); /* no other sensor is known */
}

static void a_frame_waits_for_the_smallest_number_of_sensors(void **state)
{
    (void)state;
    struct rho_frames_config config = default_config();
    config.sensors_min = SENSORS;
    init_frames(&config);
    for (unsigned s = 0; s < SENSORS; s++) {
        assert_int_equal(push_scan_and_count_closed_scans(s, s), s + 1 == SENSORS ? SENSORS : 0);
    }
    assert_int_equal(frames.counters.frames_incomplete, 0);
}

static void late_scans_are_counted_and_left_out(void **state)
{
    (void)state;
    init_default_frames();
    push_complete_frames(3);
    assert_int_equal(push_scan_and_count_closed_scans(0, 2 * SECOND_US), 0);
    assert_int_equal(push_scan_and_count_closed_scans(1, SECOND_US), 0);
    assert_int_equal(frames.counters.scans_late, 2);
    assert_int_equal(frames.counters.scans_taken, 6);
    assert_int_equal(close_frame_and_count_its_scans(), 0);
    assert_int_equal(push_scan_and_count_closed_scans(0, 2 * SECOND_US + 1), 0);
    assert_int_equal(frames.counters.scans_taken, 7);
}

static void a_silent_sensor_is_waited_for_three_frames(void **state)
{
    (void)state;
    unsigned closed_late = 0;
    init_default_frames();
    push_complete_frames(1);
    for (unsigned k = 1; k <= 10; k++) { /* sensor 2 reports, sensor 1 has fallen silent */
        closed_late += push_scan_and_count_closed_scans(0, k * SECOND_US) > 0;
        (void)push_scan_and_count_closed_scans(2, k * SECOND_US);
    }
    assert_int_equal(closed_late, 3); /* frames that only the next scan closed */
    assert_int_equal(frames.sensors[1].silent, 10);
    assert_int_equal(frames.sensors[1].missing, 10);
    assert_int_equal(frames.counters.frames, 11);
    assert_int_equal(push_scan_and_count_closed_scans(1, 10 * SECOND_US + 1),
                     0); /* sensor 1 reports again */
    assert_int_equal(push_scan_and_count_closed_scans(0, 11 * SECOND_US), 1);
    assert_int_equal(push_scan_and_count_closed_scans(2, 11 * SECOND_US),
                     0); /* sensor 1 is waited for again */
    assert_int_equal(push_scan_and_count_closed_scans(1, 11 * SECOND_US), 3);
}

static void a_sensor_that_joins_last_is_late_only_once(void **state)
{
    (void)state;
    init_default_frames();
    for (unsigned k = 0; k < 8; k++) { /* sensor 2 is unknown when the first frame closes */
        (void)push_scan_and_count_closed_scans(0, k * SECOND_US + 2);
        (void)push_scan_and_count_closed_scans(1, k * SECOND_US + 1);
        (void)push_scan_and_count_closed_scans(2, k * SECOND_US);
    }
    assert_int_equal(frames.counters.scans_late, 1);
    assert_int_equal(frames.counters.frames, 8);
    assert_int_equal(frames.counters.scans_taken, 23);
}

static void single_scans_with_wrong_times_change_nothing(void **state)
{
    (void)state;
    init_default_frames();
    push_complete_frames(3);
    assert_int_equal(push_scan_and_count_closed_scans(0, 3 * SECOND_US), 0);
    assert_int_equal(push_scan_and_count_closed_scans(1, RHO_LIMIT_TIME_US), 0);
    assert_int_equal(push_scan_and_count_closed_scans(1, -RHO_LIMIT_TIME_US), 0);
    assert_int_equal(push_scan_and_count_closed_scans(1, 3 * SECOND_US), 2);
    assert_int_equal(frames.counters.scans_off_clock, 2);
    assert_int_equal(frames.counters.scans_late, 0);
    assert_int_equal(frames.counters.clock_jumps, 0);
}

static void a_scan_beyond_the_largest_time_jump_is_off_the_clock(void **state)
{
    (void)state;
    init_default_frames();
    push_complete_frames(1);
    assert_int_equal(push_scan_and_count_closed_scans(0, 30 * SECOND_US), 0);
    assert_int_equal(push_scan_and_count_closed_scans(1, 0), 0);
    assert_int_equal(frames.counters.scans_late, 1);
    assert_int_equal(push_scan_and_count_closed_scans(0, 60 * SECOND_US + 1), 0);
    assert_int_equal(push_scan_and_count_closed_scans(1, -1), 0);
    assert_int_equal(frames.counters.scans_off_clock, 2);
    assert_int_equal(frames.counters.scans_taken, 3);
}

static void one_sensor_with_a_wrong_clock_does_not_stop_the_others(void **state)
{
    (void)state;
    const int64_t ahead_us = 3600 * SECOND_US;
    init_default_frames();
    for (unsigned k = 0; k < 1000; k++) {
        int64_t time_us = k * SECOND_US;
        (void)push_scan_and_count_closed_scans(0, time_us);
        (void)push_scan_and_count_closed_scans(1, time_us);
        (void)push_scan_and_count_closed_scans(2, k < 5 ? time_us : time_us + ahead_us);
    }
    assert_int_equal(frames.counters.clock_jumps, 0);
    assert_int_equal(frames.counters.scans_off_clock, 995);
    /* sensor 2's first, as two sensors completed that frame */
    assert_int_equal(frames.counters.scans_late, 1);
    assert_int_equal(frames.counters.scans_taken, 2004);
}

static void the_clock_of_most_sensors_wins_over_a_wrong_first_one(void **state)
{
    (void)state;
    unsigned restarts = 0;
    int64_t last_us = INT64_MAX;
    init_default_frames();
    for (unsigned k = 0; k < 20; k++) {
        for (unsigned s = 0; s < 3; s++) {
            int64_t time_us = k * SECOND_US + (s == 0 ? 3600 * SECOND_US : 0);
            if (push_scan_and_count_closed_scans(s, time_us) > 0) {
                assert_true(view.is_restart || view.frame.time_us > last_us ||
                            frames.counters.frames == 1);
                restarts += (unsigned)view.is_restart;
                last_us = view.frame.time_us;
            }
        }
    }
    assert_int_equal(restarts, 1);
    assert_int_equal(frames.counters.clock_jumps, 1);
    assert_true(last_us < 30 * SECOND_US);
    assert_true(frames.counters.frames > 12);
}

static void a_jump_of_all_clocks_restarts_the_frames(void **state)
{
    (void)state;
    static const int64_t jumps_us[] = {100000 * SECOND_US, -100000 * SECOND_US};
    for (unsigned i = 0; i < 2; i++) {
        init_default_frames();
        push_complete_frames(3);
        assert_int_equal(push_scan_and_count_closed_scans(0, 3 * SECOND_US), 0);
        for (unsigned k = 0; k < 4; k++) {
            assert_int_equal(
                push_scan_and_count_closed_scans(k % 2, k / 2 * SECOND_US + jumps_us[i]), 0);
        }
        /* closes the last frame before the jump */
        assert_int_equal(push_scan_and_count_closed_scans(0, 2 * SECOND_US + jumps_us[i]), 1);
        assert_int_equal(view.frame.time_us, 3 * SECOND_US);
        assert_int_equal(view.is_restart, 0);
        assert_int_equal(push_scan_and_count_closed_scans(1, 2 * SECOND_US + jumps_us[i] - 1), 2);
        assert_int_equal(view.is_restart, 1);
        assert_int_equal(push_scan_and_count_closed_scans(0, 3 * SECOND_US + jumps_us[i]), 0);
        assert_int_equal(push_scan_and_count_closed_scans(1, 3 * SECOND_US + jumps_us[i]), 2);
        assert_int_equal(view.is_restart, 0);
        assert_int_equal(frames.counters.scans_off_clock, 4);
        assert_int_equal(frames.counters.clock_jumps, 1);
    }
}

#define ROUNDS 6

/* Scan of sensor s in round k; times are within the tolerance and some are equal. */
static struct rho_bearing_scan *scan_of_round(struct sent *sent, unsigned k, unsigned s)
{
    int64_t time_us = k * SECOND_US + (int64_t)(s * 7919u * (k + 1u) % 3u) * (TOLERANCE_US / 2);
    return make_scan(sent, s, time_us, (s + k) % (RHO_MAX_BEARINGS + 1u), 100 * k + 10 * s);
}

/* The contents of a view without its pointers, to be compared by bytes. */
struct shown {
    int64_t time_us;
    uint32_t num_scans;
    int is_restart;
    struct rho_bearing_scan scans[SENSORS];
    struct rho_bearing bearings[SENSORS][RHO_MAX_BEARINGS];
};

static void copy_view(const struct rho_frame_view *from, struct shown *shown)
{
    memset(shown, 0, sizeof *shown);
    shown->time_us = from->frame.time_us;
    shown->num_scans = from->frame.num_scans;
    shown->is_restart = from->is_restart;
    for (unsigned i = 0; i < from->frame.num_scans; i++) {
        const struct rho_bearing_scan *scan = &from->frame.scans[i];
        memcpy(&shown->scans[i], scan, sizeof *scan);
        shown->scans[i].bearings = NULL;
        assert_true(scan->num_bearings <= RHO_MAX_BEARINGS);
        memcpy(shown->bearings[i], scan->bearings, scan->num_bearings * sizeof scan->bearings[0]);
    }
}

/* Writes permutation number `which` of 0 to count - 1 into `order`. */
static void make_permutation(unsigned which, unsigned count, unsigned *order)
{
    for (unsigned i = 0; i < count; i++) {
        unsigned place = which % (i + 1u);
        which /= i + 1u;
        memmove(order + place + 1, order + place, (i - place) * sizeof *order);
        order[place] = i;
    }
}

/* Runs rounds of scans, each round in the permutation after the last one's; copies the frames. */
static void run_rounds_in_order(unsigned which, struct shown shown[ROUNDS])
{
    struct rho_frames_config config = default_config();
    config.sensors_min = SENSORS;
    init_frames(&config);
    for (unsigned k = 0; k < ROUNDS; k++) {
        unsigned order[SENSORS], closed = 0;
        make_permutation(which + k * (which > 0), SENSORS, order);
        for (unsigned i = 0; i < SENSORS; i++) {
            struct sent sent;
            assert_int_equal(rho_frames_push(&frames, scan_of_round(&sent, k, order[i])), RHO_OK);
            if (rho_frames_closed(&frames, &view)) {
                copy_view(&view, &shown[k]);
                closed++;
            }
        }
        assert_int_equal(closed, 1);
    }
}

static void the_order_of_arrival_within_the_tolerance_does_not_matter(void **state)
{
    (void)state;
    static struct shown first[ROUNDS], other[ROUNDS];
    unsigned permutations = 1;
    for (unsigned i = 2; i <= SENSORS; i++) {
        permutations *= i;
    }
    run_rounds_in_order(0, first);
    for (unsigned k = 0; k < ROUNDS; k++) {
        assert_int_equal(first[k].num_scans, SENSORS);
    }
    const unsigned step = permutations > 720 ? 97 : 1; /* of eight sensors one in 97 */
    for (unsigned which = 1; which < permutations; which += step) {
        run_rounds_in_order(which, other);
        assert_memory_equal(other, first, sizeof first);
    }
}

#define MODEL_SCANS 400

/*
 * All scans pushed so far; times and members of frames are searched for in these lists each time.
 */
struct model {
    unsigned count;
    int64_t time_us[MODEL_SCANS];
    unsigned sensor[MODEL_SCANS];
    unsigned frame[MODEL_SCANS]; /* number of the scan's frame, from 1; 0: late */
    unsigned frames;             /* number of frames; the last one is open unless is_closed */
    int is_closed;
    unsigned seen[SENSORS]; /* seen: 1 for a known sensor; silent: frames in a row without it */
    unsigned silent[SENSORS];
};

static int count_model_frame_scans_and_find_times(const struct model *model, unsigned frame,
                                                  int64_t *first_us, int64_t *last_us)
{
    int count = 0;
    for (unsigned i = 0; i < model->count; i++) {
        if (frame > 0 && model->frame[i] == frame) {
            *first_us = count == 0 || model->time_us[i] < *first_us ? model->time_us[i] : *first_us;
            *last_us = count == 0 || model->time_us[i] > *last_us ? model->time_us[i] : *last_us;
            count++;
        }
    }
    return count;
}

static int model_has(const struct model *model, unsigned frame, unsigned sensor)
{
    for (unsigned i = 0; i < model->count; i++) {
        if (model->frame[i] == frame && model->sensor[i] == sensor) {
            return 1;
        }
    }
    return 0;
}

static void model_close_frame(struct model *model)
{
    for (unsigned s = 0; s < SENSORS; s++) {
        model->silent[s] += model->seen[s] && !model_has(model, model->frames, s);
    }
    model->is_closed = 1;
}

static int model_is_complete(const struct model *model)
{
    unsigned have = 0, lack = 0;
    for (unsigned s = 0; s < SENSORS; s++) {
        have += (unsigned)model_has(model, model->frames, s);
        lack += model->seen[s] && model->silent[s] < 3 && !model_has(model, model->frames, s);
    }
    return have >= 2 && lack == 0;
}

/* Returns the number of the frame that the scan closes, or 0. */
static unsigned model_push_and_find_closed_frame(struct model *model, unsigned sensor,
                                                 int64_t time_us)
{
    int64_t first_us = 0, last_us = 0, closed_us = 0, end_us = 0;
    unsigned open = model->is_closed ? 0 : model->frames, closes = 0;
    unsigned closed = model->is_closed ? model->frames : model->frames - 1u;
    int has_open = count_model_frame_scans_and_find_times(model, open, &first_us, &last_us);
    int has_closed = count_model_frame_scans_and_find_times(model, closed, &closed_us, &end_us);
    int fits = has_open && !model_has(model, open, sensor) && last_us - time_us <= TOLERANCE_US &&
               time_us - first_us <= TOLERANCE_US;
    unsigned i = model->count++;
    model->time_us[i] = time_us;
    model->sensor[i] = sensor;
    model->frame[i] = 0;
    if ((!has_closed || time_us > closed_us) && (fits || !has_open || time_us > first_us)) {
        if (!fits) {
            if (has_open) {
                model_close_frame(model);
                closes = open;
            }
            model->frames++;
            model->is_closed = 0;
        }
        model->frame[i] = model->frames;
    }
    model->seen[sensor] = 1;
    model->silent[sensor] = 0;
    if (model->frame[i] > 0 && model_is_complete(model)) {
        model_close_frame(model);
        closes = model->frames;
    }
    return closes;
}

/* The closed frame has the model's scans, each once, in the order of sensor_id. */
static void compare_closed_frame(const struct model *model, unsigned frame)
{
    int64_t first_us = 0, last_us = 0;
    int count = count_model_frame_scans_and_find_times(model, frame, &first_us, &last_us);
    assert_int_equal(view.frame.num_scans, count);
    if (count == 0) {
        return;
    }
    assert_true(view.frame.time_us == first_us && last_us - first_us <= TOLERANCE_US);
    for (unsigned i = 0; i < view.frame.num_scans; i++) {
        const struct rho_bearing_scan *scan = &view.frame.scans[i];
        unsigned which = (unsigned)scan->bearings[0].bearing_rad;
        assert_int_equal(model->frame[which], frame);
        assert_true(scan->time_us == model->time_us[which]);
        assert_int_equal(scan->sensor_id, 40 - 10 * (int32_t)model->sensor[which]);
        assert_true(i == 0 || scan[-1].sensor_id < scan->sensor_id);
    }
}

/* Times of scans in rounds of 0.1 s: most within the tolerance, some late by a round or more. */
static int64_t random_scan_time(unsigned i)
{
    int64_t round_us = i / SENSORS * 100000;
    unsigned kind = random_below(20);
    int64_t spread_us = random_below(kind < 15 ? 40000 : 90000);
    return round_us + spread_us - (kind == 19 ? random_below(300000) : 0);
}

static void compare_run_with_model(struct model *model, struct rho_batch *batch)
{
    uint32_t late = 0, closed = 0;
    unsigned active = 2 + random_below(SENSORS - 1);
    memset(model, 0, sizeof *model);
    init_default_frames();
    for (unsigned i = 0; i < MODEL_SCANS; i++) {
        unsigned sensor = random_below(10) < 9 ? i % active : random_below(active);
        int64_t time_us = random_scan_time(i);
        unsigned has = push_bearings_and_count_closed_scans(sensor, time_us, 1, i);
        unsigned closes = model_push_and_find_closed_frame(model, sensor, time_us);
        assert_int_equal(has > 0, closes > 0);
        compare_closed_frame(model, closes);
        late += model->frame[i] == 0;
        closed += closes > 0;
        if (has > 0) {
            uint8_t fates[SENSORS] = {RHO_FATE_HELD};
            /* the batch takes frames of rising times only */
            assert_int_equal(rho_batch_push(batch, &view.frame, fates, NULL), RHO_OK);
        }
        assert_int_equal(frames.counters.scans_late, late);
        assert_int_equal(frames.counters.scans_taken, i + 1u - late);
        assert_int_equal(frames.counters.frames, closed);
    }
    assert_true(late > 5 && late < MODEL_SCANS / 2 && closed > 30);
}

static void frames_of_random_scans_agree_with_the_model(void **state)
{
    (void)state;
    static struct model model;
    static struct rho_batch batch;
    random_state = 11;
    for (unsigned run = 0; run < 100; run++) {
        assert_int_equal(rho_batch_init(&batch, 4, 1e6f), RHO_OK);
        compare_run_with_model(&model, &batch);
    }
}

static void bearings_beyond_the_capacity_are_counted(void **state)
{
    (void)state;
    init_default_frames();
    assert_int_equal(push_bearings_and_count_closed_scans(0, 0, RHO_MAX_BEARINGS + 3, 0), 0);
    assert_int_equal(push_bearings_and_count_closed_scans(1, 0, RHO_MAX_BEARINGS, 500), 2);
    assert_int_equal(frames.counters.bearings_no_room, 3);
    assert_int_equal(view.frame.scans[0].num_bearings, RHO_MAX_BEARINGS);
    assert_int_equal(view.frame.scans[1].num_bearings, RHO_MAX_BEARINGS);
    for (unsigned i = 0; i < RHO_MAX_BEARINGS; i++) {
        assert_true(view.frame.scans[1].bearings[i].bearing_rad == (float)i);
    }
}

static void counters_saturate(void **state)
{
    (void)state;
    init_default_frames();
    push_complete_frames(2);
    memset(&frames.counters, 0xff, sizeof frames.counters);
    frames.sensors[0].missing = frames.sensors[0].silent = UINT32_MAX;
    struct rho_frames_counters full = frames.counters;
    assert_int_equal(push_scan_and_count_closed_scans(0, 0), 0);
    assert_int_equal(
        push_bearings_and_count_closed_scans(1, 2 * SECOND_US, RHO_MAX_BEARINGS + 1, 0), 0);
    assert_int_equal(push_scan_and_count_closed_scans(1, 3 * SECOND_US), 1);
    for (unsigned i = 0; i < 5; i++) {
        (void)push_scan_and_count_closed_scans(1, 1000 * SECOND_US);
    }
    assert_memory_equal(&frames.counters, &full, sizeof full);
    assert_true(frames.sensors[0].missing == UINT32_MAX);
}

static void a_copied_object_continues_identically(void **state)
{
    (void)state;
    static struct rho_frames copy;
    struct rho_frame_view of_copy;
    struct shown shown, shown_of_copy;
    struct sent sent;
    random_state = 5;
    init_default_frames();
    for (unsigned i = 0; i < 200; i++) {
        unsigned sensor = random_below(SENSORS);
        int64_t time_us = random_scan_time(i);
        memcpy(&copy, &frames, sizeof copy);
        make_scan(&sent, sensor, time_us, random_below(RHO_MAX_BEARINGS + 1), i);
        assert_int_equal(rho_frames_push(&copy, &sent.scan), RHO_OK);
        assert_int_equal(rho_frames_push(&frames, &sent.scan), RHO_OK);
        assert_memory_equal(&copy, &frames, sizeof copy);
        (void)rho_frames_closed(&frames, &view);
        (void)rho_frames_closed(&copy, &of_copy);
        copy_view(&view, &shown);
        before = frames;
        memset(&frames, 0, sizeof frames); /* the copy must not depend on the original */
        copy_view(&of_copy, &shown_of_copy);
        assert_memory_equal(&shown, &shown_of_copy, sizeof shown);
        frames = before;
    }
}

static void expect_config_status(const struct rho_frames_config *config, enum rho_status status)
{
    memset(&frames, 0x5a, sizeof frames);
    before = frames;
    assert_int_equal(rho_frames_init(&frames, sizeof frames, config), status);
    if (status != RHO_OK) {
        assert_memory_equal(&frames, &before, sizeof frames);
    }
}

#define EXPECT_FIELD(field, value, status)                                                         \
    do {                                                                                           \
        struct rho_frames_config config = default_config();                                        \
        config.field = (value);                                                                    \
        expect_config_status(&config, (status));                                                   \
    } while (0)

static void configurations_out_of_range_are_refused(void **state)
{
    (void)state;
    EXPECT_FIELD(tolerance_us, -1, RHO_ERROR_CONFIG);
    EXPECT_FIELD(tolerance_us, 0, RHO_OK);
    EXPECT_FIELD(tolerance_us, 10 * SECOND_US, RHO_OK);
    EXPECT_FIELD(tolerance_us, 10 * SECOND_US + 1, RHO_ERROR_CONFIG);
    EXPECT_FIELD(jump_max_us, TOLERANCE_US, RHO_ERROR_CONFIG);
    EXPECT_FIELD(jump_max_us, TOLERANCE_US + 1, RHO_OK);
    EXPECT_FIELD(jump_max_us, 3600 * SECOND_US, RHO_OK);
    EXPECT_FIELD(jump_max_us, 3600 * SECOND_US + 1, RHO_ERROR_CONFIG);
    EXPECT_FIELD(follow_scans, 1, RHO_ERROR_CONFIG);
    EXPECT_FIELD(follow_scans, 2, RHO_OK);
    EXPECT_FIELD(follow_scans, 255, RHO_OK);
    EXPECT_FIELD(follow_scans, 256, RHO_ERROR_CONFIG);
    EXPECT_FIELD(silent_frames, 0, RHO_ERROR_CONFIG);
    EXPECT_FIELD(silent_frames, 1, RHO_OK);
    EXPECT_FIELD(silent_frames, 255, RHO_OK);
    EXPECT_FIELD(silent_frames, 256, RHO_ERROR_CONFIG);
    EXPECT_FIELD(sensors_min, 1, RHO_ERROR_CONFIG);
    EXPECT_FIELD(sensors_min, SENSORS, RHO_OK);
    EXPECT_FIELD(sensors_min, SENSORS + 1, RHO_ERROR_CONFIG);
    struct rho_frames_config config = default_config();
    assert_int_equal(rho_frames_init(NULL, sizeof frames, &config), RHO_ERROR_NULL);
    assert_int_equal(rho_frames_init(&frames, sizeof frames, NULL), RHO_ERROR_NULL);
    before = frames;
    assert_int_equal(rho_frames_init(&frames, sizeof frames - 1, &config), RHO_ERROR_SIZE);
    assert_memory_equal(&frames, &before, sizeof frames);
    expect_config_status(&config, RHO_OK);
}

/* Prepares two known sensors, a closed frame and an open one. */
static void init_with_closed_and_open_frame(void)
{
    init_default_frames();
    push_complete_frames(1);
    assert_int_equal(push_bearings_and_count_closed_scans(0, SECOND_US, 2, 0), 0);
    before = frames;
}

static void expect_scan_refused(const struct rho_bearing_scan *scan, enum rho_status status)
{
    assert_int_equal(rho_frames_push(&frames, scan), status);
    assert_memory_equal(&frames, &before, sizeof frames);
}

#define EXPECT_REFUSED(sensor, field, value, status)                                               \
    do {                                                                                           \
        struct sent sent;                                                                          \
        make_scan(&sent, sensor, SECOND_US, 1, 0)->field = (value);                                \
        expect_scan_refused(&sent.scan, (status));                                                 \
    } while (0)

static void refused_scans_change_nothing(void **state)
{
    (void)state;
    const float nan = (float)(0.0 * (double)__builtin_inff());
    init_with_closed_and_open_frame();
    EXPECT_REFUSED(1, bearings, NULL, RHO_ERROR_NULL);
    EXPECT_REFUSED(1, time_us, RHO_LIMIT_TIME_US + 1, RHO_ERROR_VALUE);
    EXPECT_REFUSED(1, time_us, INT64_MIN, RHO_ERROR_VALUE);
    EXPECT_REFUSED(1, sector_from_rad, nan, RHO_ERROR_VALUE);
    EXPECT_REFUSED(1, sector_from_rad, 6.3f, RHO_ERROR_VALUE);
    EXPECT_REFUSED(1, sector_to_rad, -6.3f, RHO_ERROR_VALUE);
    EXPECT_REFUSED(1, x_m, nan, RHO_ERROR_VALUE);
    EXPECT_REFUSED(1, x_m, -2.1e6f, RHO_ERROR_VALUE);
    EXPECT_REFUSED(2, x_m, 2.1e6f, RHO_ERROR_VALUE);
    EXPECT_REFUSED(2, y_m, -__builtin_inff(), RHO_ERROR_VALUE);
    EXPECT_REFUSED(1, time_us, -RHO_LIMIT_TIME_US - 1, RHO_ERROR_VALUE);
    expect_scan_refused(NULL, RHO_ERROR_NULL);
    struct sent sent;
    assert_int_equal(rho_frames_push(NULL, make_scan(&sent, 1, 0, 0, 0)), RHO_ERROR_NULL);
    sent.scan.bearings = NULL;
    sent.scan.time_us = SECOND_US;
    /* no bearings: no array is needed */
    assert_int_equal(rho_frames_push(&frames, &sent.scan), RHO_OK);
    (void)rho_frames_closed(&frames, &view);
    assert_int_equal(view.frame.num_scans, 2);
}

static void a_refused_scan_keeps_the_closed_frame(void **state)
{
    (void)state;
    struct sent sent;
    init_default_frames();
    push_complete_frames(1);
    before = frames;
    make_scan(&sent, 1, 0, 1, 0)->x_m = __builtin_inff();
    expect_scan_refused(&sent.scan, RHO_ERROR_VALUE);
    assert_int_equal(rho_frames_closed(&frames, &view), 1);
    assert_int_equal(view.frame.num_scans, 2);
}

static void one_sensor_too_many_is_refused(void **state)
{
    (void)state;
    init_default_frames();
    for (unsigned s = 0; s < SENSORS; s++) {
        (void)push_scan_and_count_closed_scans(s, 0);
    }
    before = frames;
    struct sent sent;
    expect_scan_refused(make_scan(&sent, SENSORS, SECOND_US, 1, 0), RHO_ERROR_CAPACITY);
}

static void an_object_without_init_is_refused(void **state)
{
    (void)state;
    struct sent sent;
    memset(&frames, 0, sizeof frames);
    before = frames;
    expect_scan_refused(make_scan(&sent, 0, 0, 1, 0), RHO_ERROR_STATE);
    assert_int_equal(rho_frames_close(&frames), RHO_ERROR_STATE);
    assert_int_equal(rho_frames_close(NULL), RHO_ERROR_NULL);
    assert_memory_equal(&frames, &before, sizeof frames);
    assert_int_equal(rho_frames_closed(&frames, &view), 0);
    assert_int_equal(rho_frames_closed(NULL, &view), 0);
    assert_int_equal(view.frame.num_scans, 0);
    assert_null(view.frame.scans);
    init_default_frames();
    assert_int_equal(rho_frames_closed(&frames, NULL), 0);
}

static void the_first_and_last_possible_times_are_accepted(void **state)
{
    (void)state;
    init_default_frames();
    assert_int_equal(push_scan_and_count_closed_scans(0, -RHO_LIMIT_TIME_US), 0);
    assert_int_equal(push_scan_and_count_closed_scans(1, -RHO_LIMIT_TIME_US), 2);
    for (unsigned i = 0; i < 5; i++) {
        assert_int_equal(push_scan_and_count_closed_scans(0, RHO_LIMIT_TIME_US), 0);
    }
    assert_int_equal(push_scan_and_count_closed_scans(1, RHO_LIMIT_TIME_US - TOLERANCE_US), 2);
    assert_int_equal(view.is_restart, 1);
}

/* Each scan of a frame has the place of its sensor at that time; the newest one is kept. */
static void sensors_may_move_and_stand_together(void **state)
{
    struct sent sent;

    (void)state;
    init_default_frames();
    push_complete_frames(1);
    make_scan(&sent, 0, SECOND_US, 1, 0)->x_m = 250.0f;
    assert_int_equal(rho_frames_push(&frames, &sent.scan), RHO_OK);
    make_scan(&sent, 1, SECOND_US, 1, 0)->x_m = 250.0f;
    assert_int_equal(rho_frames_push(&frames, &sent.scan), RHO_OK);
    assert_int_equal(rho_frames_closed(&frames, &view), 1);
    assert_int_equal(view.frame.num_scans, 2);
    for (unsigned i = 0; i < 2; i++) {
        assert_true(view.scans[i].x_m == 250.0f && view.scans[i].y_m == -5.0f);
        assert_true(frames.sensors[i].x_m == 250.0f);
    }
    make_scan(&sent, 0, 2 * SECOND_US, 1, 0)->y_m = 300.0f;
    assert_int_equal(rho_frames_push(&frames, &sent.scan), RHO_OK);
    make_scan(&sent, 1, 2 * SECOND_US, 1, 0)->y_m = -RHO_LIMIT_POSITION_M;
    assert_int_equal(rho_frames_push(&frames, &sent.scan), RHO_OK);
    assert_int_equal(rho_frames_closed(&frames, &view), 1);
    assert_true(view.scans[1].x_m == 0.0f && view.scans[1].y_m == 300.0f);
    assert_true(view.scans[0].x_m == 1000.0f && view.scans[0].y_m == -RHO_LIMIT_POSITION_M);
    assert_int_equal(frames.num_sensors, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_frame_closes_with_its_last_sensor),
        cmocka_unit_test(scans_join_a_frame_within_the_tolerance_of_its_earliest),
        cmocka_unit_test(a_scan_that_is_earlier_may_join_the_open_frame),
        cmocka_unit_test(a_sensor_that_reports_again_closes_the_frame),
        cmocka_unit_test(the_caller_closes_a_frame),
        cmocka_unit_test(a_frame_waits_for_the_smallest_number_of_sensors),
        cmocka_unit_test(late_scans_are_counted_and_left_out),
        cmocka_unit_test(a_silent_sensor_is_waited_for_three_frames),
        cmocka_unit_test(a_sensor_that_joins_last_is_late_only_once),
        cmocka_unit_test(single_scans_with_wrong_times_change_nothing),
        cmocka_unit_test(a_scan_beyond_the_largest_time_jump_is_off_the_clock),
        cmocka_unit_test(one_sensor_with_a_wrong_clock_does_not_stop_the_others),
        cmocka_unit_test(the_clock_of_most_sensors_wins_over_a_wrong_first_one),
        cmocka_unit_test(a_jump_of_all_clocks_restarts_the_frames),
        cmocka_unit_test(the_order_of_arrival_within_the_tolerance_does_not_matter),
        cmocka_unit_test(frames_of_random_scans_agree_with_the_model),
        cmocka_unit_test(bearings_beyond_the_capacity_are_counted),
        cmocka_unit_test(counters_saturate),
        cmocka_unit_test(a_copied_object_continues_identically),
        cmocka_unit_test(configurations_out_of_range_are_refused),
        cmocka_unit_test(refused_scans_change_nothing),
        cmocka_unit_test(a_refused_scan_keeps_the_closed_frame),
        cmocka_unit_test(one_sensor_too_many_is_refused),
        cmocka_unit_test(an_object_without_init_is_refused),
        cmocka_unit_test(the_first_and_last_possible_times_are_accepted),
        cmocka_unit_test(sensors_may_move_and_stand_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
