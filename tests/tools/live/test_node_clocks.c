/* SPDX-License-Identifier: MIT */
/*
 * Radars that see the same targets, live, and a clock that steps: tracks of the radars whose clocks
 * are right go on where they were, the node does not begin anew, and the sensor whose clock stepped
 * is named. Networks that stall and records that are played at any pace are no such clocks.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h" /* before cmocka's macro fail */

#include <cmocka.h>

#include "base/random.h"
#include "live/node_core.h"
#include "live/node_sensor_warnings.h"
#include "rhotrack/message.h"

#define START_US INT64_C(1790000000000000) /* microseconds since 1970, in 2026 */
#define DELAY_US INT64_C(5000)
#define RADARS_MAX 3
#define TARGETS 3
#define CLUTTER 5
#define SCANS_MAX 1000
#define SIGMA_M 20.0
#define NEAR_M 1000.0
#define STEP_S 120 /* when a clock steps */
#define END_S 320

/* ---- the scene ------------------------------------------------------------------------------- */

struct scene {
    double interval_s[RADARS_MAX]; /* 0: there is no such radar */
    double step_s;                 /* of the clocks of the first radars */
    int num_stepping;
    double step_back_s;    /* when the step is taken back; 0: it stays */
    double drift;          /* of the first radar's clock, s/s */
    double reception_s;    /* of the node's clock against that of the right radars */
    double stall_s;        /* each minute the first radar's network stalls for so long */
    int is_stall_of_all;   /* 1: all radars' networks stall */
    double jitter_s, pace; /* of the network; of a record that is played */
};

struct received_scan {
    int64_t received_us;
    double true_s; /* when it was measured */
    int32_t scan;
    int16_t sensor_id;
};

struct live {
    const struct scene *scene;
    struct node_core *core;
    struct received_scan scans[SCANS_MAX];
    unsigned count;
    int16_t sensor_id; /* whose message was taken last */
    double now_s;      /* true time */
    struct rho_scan_assembler_counters counters;
    /* from the step on: */
    unsigned began_anew;
    double gap_s, hit_s; /* longest time without a right radar's hit of target 0; the last hit */
    double sum_m, sums;  /* distances of tracks from targets at scans of right radars */
    int is_named, is_other_named; /* 1: a stepping sensor was off the clock; a right one was ill */
};

static double target_x_m(int target, double t_s)
{
    return -20000.0 + 20000.0 * target + 100.0 * t_s;
}

static double target_y_m(int target, double t_s)
{
    return 10000.0 + 3000.0 * target - 60.0 * t_s;
}

static int is_right(const struct scene *scene, int16_t sensor_id)
{
    return sensor_id > scene->num_stepping;
}

/* Time by a radar's clock. */
static double clock_s(const struct scene *scene, int16_t sensor_id, double true_s)
{
    const double end_s = scene->step_back_s > 0.0 ? scene->step_back_s : 2.0 * END_S;
    double time_s = true_s + (sensor_id == 1 ? scene->drift * true_s : 0.0);

    if (!is_right(scene, sensor_id) && true_s >= STEP_S && true_s < end_s) {
        time_s += scene->step_s;
    }
    return time_s;
}

static void send_scan(struct live *live, const struct received_scan *received)
{
    static struct rho_message_plot_scan scan;
    struct random random = random_start(1, (uint64_t)received->sensor_id, (uint64_t)received->scan);
    uint8_t buffer[RHO_MESSAGE_PLOT_SCAN_MAX_SIZE];
    char channel[32];
    size_t size;

    scan = (struct rho_message_plot_scan){
        .utime =
            START_US + llround(1e6 * clock_s(live->scene, received->sensor_id, received->true_s)),
        .scan = received->scan,
        .sensor_id = received->sensor_id,
        .kind = RHO_MESSAGE_PLOT_SCAN_POSITION_2D,
        .num_parts = 1};
    for (int i = 0; i < TARGETS + CLUTTER; i++) {
        const double dx_m = i < TARGETS ? SIGMA_M * random_normal(&random)
                                        : random_between(&random, -50000.0, 50000.0);
        const double dy_m = i < TARGETS ? SIGMA_M * random_normal(&random)
                                        : random_between(&random, -50000.0, 50000.0);

        scan.plots[scan.num_plots++] = (struct rho_message_plot){
            .x_m = (float)(dx_m + (i < TARGETS ? target_x_m(i, received->true_s) : 0.0)),
            .y_m = (float)(dy_m + (i < TARGETS ? target_y_m(i, received->true_s) : 0.0)),
            .sigma_m = (float)SIGMA_M};
    }
    assert_int_equal(rho_message_plot_scan_encode(&scan, buffer, sizeof buffer, &size), RHO_OK);
    snprintf(channel, sizeof channel, "%s%d", RHO_MESSAGE_PLOT_SCAN_CHANNEL, received->sensor_id);
    live->sensor_id = received->sensor_id;
    live->now_s = received->true_s;
    node_core_take_message(live->core, channel, buffer, size, received->received_us);
}

/* ---- figures --------------------------------------------------------------------------------- */

static void note_sensors(struct live *live)
{
    struct rho_message_sensor sensors[RHO_MAX_SENSORS];
    const unsigned count = node_core_list_sensors(live->core, sensors);
    double ahead_s;

    for (unsigned i = 0; i < count; i++) {
        if (is_right(live->scene, sensors[i].sensor_id)) {
            live->is_other_named |= sensors[i].is_off_clock || sensors[i].is_doubted;
        } else if (node_core_is_off_clock(live->core, sensors[i].sensor_id, &ahead_s)) {
            live->is_named = 1;
            assert_true(fabs(ahead_s - live->scene->step_s) < 0.5);
        }
    }
}

static void note_step(void *context, const struct rho_report *report)
{
    struct live *live = context;
    const double t_s = (double)(report->time_us - START_US) / 1e6;
    const double gap_s = live->now_s - live->hit_s;

    if (live->now_s < STEP_S) {
        live->hit_s = live->now_s;
        return;
    }
    note_sensors(live);
    live->gap_s = gap_s > live->gap_s ? gap_s : live->gap_s;
    for (uint32_t i = 0; i < report->num_tracks && is_right(live->scene, live->sensor_id); i++) {
        const struct rho_track_report *track = &report->tracks[i];

        for (int j = 0; j < TARGETS; j++) {
            const double away_m = hypot((double)track->state[0] - target_x_m(j, t_s),
                                        (double)track->state[1] - target_y_m(j, t_s));

            if (track->status != RHO_TRACK_TENTATIVE && away_m < NEAR_M) {
                live->hit_s = j == 0 && track->plot >= 0 ? live->now_s : live->hit_s;
                live->sum_m += away_m;
                live->sums++;
            }
        }
    }
}

static void note_began_anew(void *context)
{
    ((struct live *)context)->began_anew++;
}

static void ignore_message(void *context, const char *channel, const uint8_t *data, size_t size)
{
    (void)context;
    (void)channel;
    (void)data;
    (void)size;
}

static int compare_reception_times(const void *a, const void *b)
{
    const struct received_scan *first = a, *second = b;

    return (first->received_us > second->received_us) - (first->received_us < second->received_us);
}

/* When a radar's scan is received, by the time of the right radars. */
static double received_s(const struct scene *scene, int16_t sensor_id, double true_s,
                         struct random *random)
{
    const double since_s = fmod(true_s, 60.0);
    double late_s = scene->jitter_s * random_between(random, 0.0, 1.0);

    if ((sensor_id == 1 || scene->is_stall_of_all) && true_s > 20.0 && since_s < scene->stall_s) {
        late_s += scene->stall_s - since_s;
    }
    return (true_s + late_s) / (scene->pace > 0.0 ? scene->pace : 1.0);
}

static void plan_scans(struct live *live)
{
    const struct scene *scene = live->scene;

    for (int16_t radar = 0; radar < RADARS_MAX && scene->interval_s[radar] > 0.0; radar++) {
        struct random random = random_start(2, (uint64_t)radar, 0);

        for (int32_t i = 0; i * scene->interval_s[radar] < END_S; i++) {
            const int16_t sensor_id = (int16_t)(radar + 1);
            const double true_s = (i + 0.31 * radar) * scene->interval_s[radar];
            const double heard_s = received_s(scene, sensor_id, true_s, &random);

            assert_true(live->count < SCANS_MAX);
            live->scans[live->count++] = (struct received_scan){
                .received_us = START_US + llround(1e6 * (heard_s + scene->reception_s)) + DELAY_US,
                .true_s = true_s,
                .scan = i,
                .sensor_id = sensor_id};
        }
    }
    qsort(live->scans, live->count, sizeof live->scans[0], compare_reception_times);
}

/* Runs a node over all scans; `to` gets the lines on its sensors at the end of each scan. */
static void run_scene(struct live *live, const struct scene *scene, FILE *to)
{
    struct parameters parameters;
    struct node_sensors said = {.count = 0};
    char reason[PARAMETER_REASON_BYTES];
    const struct node_core_events events = {.context = live,
                                            .send = ignore_message,
                                            .stepped = note_step,
                                            .began_anew = note_began_anew};

    *live = (struct live){.scene = scene};
    parameters_set_defaults(&parameters);
    assert_true(parameters_assign(&parameters, "v_max_mps", "400", SOURCE_CONFIG, reason));
    live->core = node_core_open(&parameters, 1, &events);
    plan_scans(live);
    for (unsigned i = 0; i < live->count; i++) {
        int64_t due_us;

        while ((due_us = node_core_due_us(live->core)) < live->scans[i].received_us) {
            node_core_tick(live->core, due_us);
        }
        send_scan(live, &live->scans[i]);
        node_sensors_print_changes(&said, live->core, to);
    }
    node_core_flush(live->core);
    live->gap_s = END_S - live->hit_s > live->gap_s ? END_S - live->hit_s : live->gap_s;
    live->counters = *node_core_assembler_counters(live->core);
    node_core_close(live->core);
}

/* ---- tests ----------------------------------------------------------------------------------- */

static const double radars_s[][RADARS_MAX] = {{4.0, 4.0},       {1.0, 1.0},      {5.0, 5.0},
                                              {1.0, 12.0},      {12.0, 1.0},     {4.0, 4.0, 4.0},
                                              {1.0, 4.0, 12.0}, {12.0, 4.0, 1.0}};

/* Longest time between two scans of right radars, of which one may be lost beside a step. */
static double longest_gap_s(const struct scene *scene)
{
    double least_s = END_S;

    for (int i = scene->num_stepping; i < RADARS_MAX && scene->interval_s[i] > 0.0; i++) {
        least_s = scene->interval_s[i] < least_s ? scene->interval_s[i] : least_s;
    }
    return 1.3 * least_s;
}

static void expect_right_radars_go_on(const struct live *live)
{
    assert_int_equal(live->began_anew, 0);
    assert_false(live->is_other_named);
    assert_true(live->gap_s <= longest_gap_s(live->scene));
    assert_true(live->sums > 0 && live->sum_m / live->sums < 60.0);
}

static void a_clock_that_steps_is_left_aside_and_named(void **state)
{
    static const double steps_s[] = {0.1, 0.3, 1.0,  2.0,  3.7,  4.0,
                                     4.3, 8.0, 15.0, 25.0, 31.0, 60.0};
    static struct live live;

    (void)state;
    for (unsigned i = 0; i < sizeof radars_s / sizeof radars_s[0]; i++) {
        for (unsigned j = 0; j < 2 * sizeof steps_s / sizeof steps_s[0]; j++) {
            struct scene scene = {.step_s = j % 2 ? -steps_s[j / 2] : steps_s[j / 2],
                                  .num_stepping = 1,
                                  .reception_s = j % 3 == 0 ? 1000.0 : 0.0};

            memcpy(scene.interval_s, radars_s[i], sizeof scene.interval_s);
            run_scene(&live, &scene, NULL);
            expect_right_radars_go_on(&live);
            assert_int_equal(live.is_named, fabs(scene.step_s) >= 1.0);
        }
    }
}

static void a_step_and_its_end_are_said_once(void **state)
{
    static struct live live;
    const struct scene scene = {
        .interval_s = {4.0, 4.0}, .step_s = 8.0, .num_stepping = 1, .step_back_s = STEP_S + 100.0};
    char *said = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&said, &size);

    (void)state;
    run_scene(&live, &scene, to);
    fclose(to);
    expect_right_radars_go_on(&live);
    assert_string_equal(said, "rhotrack: sensor 1: its clock is 8.0 s ahead of the others': its "
                              "scans are left aside until it is right, or sensor.1.time_bias_s = "
                              "8.0 says so\n"
                              "rhotrack: sensor 1: its clock is right again\n");
    free(said);
}

/* The two are the majority: the node begins anew once, and goes on by their time. */
static void two_of_three_clocks_that_step_are_followed_once(void **state)
{
    static const double steps_s[] = {-60.0, -8.0, 8.0, 60.0};
    static struct live live;

    (void)state;
    for (unsigned i = 0; i < sizeof steps_s / sizeof steps_s[0]; i++) {
        const struct scene scene = {
            .interval_s = {4.0, 4.0, 4.0}, .step_s = steps_s[i], .num_stepping = 2};

        run_scene(&live, &scene, NULL);
        assert_int_equal(live.began_anew, 1);
    }
}

static void clocks_that_drift_are_one_clock(void **state)
{
    static struct live live;
    const struct scene slow = {.interval_s = {4.0, 4.0}, .drift = -1e-3};
    const struct scene fast = {.interval_s = {4.0, 4.0}, .drift = 1e-3};

    (void)state;
    run_scene(&live, &slow, NULL);
    expect_right_radars_go_on(&live);
    assert_int_equal(live.counters.clock_jumps, 0);
    run_scene(&live, &fast, NULL);
    expect_right_radars_go_on(&live);
    assert_int_equal(live.counters.clock_jumps, 0);
}

static void expect_no_scan_is_refused(const struct scene *kind)
{
    static struct live live;

    for (unsigned i = 0; i < sizeof radars_s / sizeof radars_s[0]; i++) {
        struct scene scene = *kind;

        memcpy(scene.interval_s, radars_s[i], sizeof scene.interval_s);
        run_scene(&live, &scene, NULL);
        assert_int_equal(live.began_anew, 0);
        assert_int_equal(live.counters.clock_jumps + live.counters.scans_bad, 0);
    }
}

static void networks_that_stall_lose_no_scan(void **state)
{
    (void)state;
    expect_no_scan_is_refused(&(struct scene){.stall_s = 6.0});
    expect_no_scan_is_refused(&(struct scene){.stall_s = 15.0});
    expect_no_scan_is_refused(&(struct scene){.stall_s = 6.0, .is_stall_of_all = 1});
    expect_no_scan_is_refused(&(struct scene){.stall_s = 15.0, .is_stall_of_all = 1});
    expect_no_scan_is_refused(&(struct scene){.jitter_s = 0.9});
}

static void records_of_any_pace_lose_no_scan(void **state)
{
    static const double paces[] = {0.5, 1.4, 1.6, 2.0, 10.0, 100.0};

    (void)state;
    for (unsigned i = 0; i < sizeof paces / sizeof paces[0]; i++) {
        expect_no_scan_is_refused(&(struct scene){.pace = paces[i]});
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clock_that_steps_is_left_aside_and_named),
        cmocka_unit_test(a_step_and_its_end_are_said_once),
        cmocka_unit_test(two_of_three_clocks_that_step_are_followed_once),
        cmocka_unit_test(clocks_that_drift_are_one_clock),
        cmocka_unit_test(networks_that_stall_lose_no_scan),
        cmocka_unit_test(records_of_any_pace_lose_no_scan),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
