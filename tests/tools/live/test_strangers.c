/* SPDX-License-Identifier: MIT */
/*
 * A radar that is heard for minutes, and datagrams of somebody else, live: its track goes on, and a
 * new target is found when it would have been. The time that a step takes is taken from the
 * node.
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

#define START_US INT64_C(1790000000000000) /* since 1970: 2026 */
#define SECOND_US INT64_C(1000000)
#define DELAY_US INT64_C(5000)
#define CLUTTER 10
#define STRANGERS 8
#define DATAGRAMS 6000
#define SIGMA_M 20.0
#define NEAR_M 1000.0

/*
 * ---- the scene --------------------------------------------------------------------------------
 */

static int64_t attack_s, end_s; /* of the attack and of the new target */

struct datagram {
    int64_t received_us, time_us;
    int32_t scan;
    int16_t sensor_id, part, num_parts, num_plots; /* num_plots 0: the radar's scan of this time */
    float sigma_m, half_m;
    int is_polar; /* without plots */
};

struct live {
    struct parameters parameters;
    struct node_core *core;
    struct datagram datagrams[DATAGRAMS];
    unsigned count;
    int64_t now_us; /* reception clock, as the node's work lets it see it */
    uint32_t hits;  /* of the old target's track */
    int64_t updated_us, gap_us;
    int64_t found_us; /* the new target's track was confirmed; 0: not so far */
};

static double x_of(int target, double t_s)
{
    return target == 0 ? -20000.0 + 100.0 * t_s : 30000.0 - 120.0 * (t_s - attack_s);
}

static double y_of(int target, double t_s)
{
    return target == 0 ? 10000.0 - 50.0 * t_s : -20000.0 + 60.0 * (t_s - attack_s);
}

static void put_plot(struct rho_message_plot_scan *scan, double x_m, double y_m, double sigma_m)
{
    scan->plots[scan->num_plots++] =
        (struct rho_message_plot){.x_m = (float)x_m, .y_m = (float)y_m, .sigma_m = (float)sigma_m};
}

static void put_radar(struct rho_message_plot_scan *scan, struct random *random)
{
    const double t_s = (double)(scan->utime - START_US) / 1e6;

    for (int i = 0; i < (t_s < attack_s ? 1 : 2); i++) {
        const double dx_m = SIGMA_M * random_normal(random), dy_m = SIGMA_M * random_normal(random);

        put_plot(scan, x_of(i, t_s) + dx_m, y_of(i, t_s) + dy_m, SIGMA_M);
    }
    for (int i = 0; i < CLUTTER; i++) {
        const double x_m = random_between(random, -50000.0, 50000.0);

        put_plot(scan, x_m, random_between(random, -50000.0, 50000.0), SIGMA_M);
    }
}

static void take(struct live *live, const char *channel, int16_t sensor_id, const uint8_t *message,
                 size_t size)
{
    char name[32];
    int64_t start_us;

    snprintf(name, sizeof name, "%s%d", channel, sensor_id);
    start_us = clock_us();
    node_core_take_message(live->core, name, message, size, live->now_us);
    live->now_us += clock_us() - start_us;
}

static void send_polar(struct live *live, const struct datagram *datagram)
{
    const struct rho_message_polar_scan nothing = {.utime = datagram->time_us,
                                                   .scan = datagram->scan,
                                                   .sensor_id = datagram->sensor_id,
                                                   .num_parts = 1};
    uint8_t buffer[RHO_MESSAGE_POLAR_SCAN_MAX_SIZE];
    size_t size;

    assert_int_equal(rho_message_polar_scan_encode(&nothing, buffer, sizeof buffer, &size), RHO_OK);
    take(live, RHO_MESSAGE_POLAR_SCAN_CHANNEL, datagram->sensor_id, buffer, size);
}

/* The same plots whenever they are sent. */
static void send(struct live *live, const struct datagram *datagram)
{
    static struct rho_message_plot_scan scan;
    struct random random = random_start(1, (uint64_t)datagram->sensor_id,
                                        (uint64_t)(datagram->scan * 1000 + datagram->part));
    uint8_t buffer[RHO_MESSAGE_PLOT_SCAN_MAX_SIZE];
    size_t size;

    if (datagram->is_polar) {
        send_polar(live, datagram);
        return;
    }
    scan = (struct rho_message_plot_scan){.utime = datagram->time_us,
                                          .scan = datagram->scan,
                                          .sensor_id = datagram->sensor_id,
                                          .kind = RHO_MESSAGE_PLOT_SCAN_POSITION_2D,
                                          .part = datagram->part,
                                          .num_parts = datagram->num_parts};
    if (datagram->num_plots == 0) {
        put_radar(&scan, &random);
    }
    for (int i = 0; i < datagram->num_plots; i++) {
        const double half_m = datagram->half_m > 0.0f ? (double)datagram->half_m : 50000.0;
        const double x_m = random_between(&random, -half_m, half_m);

        put_plot(&scan, x_m, random_between(&random, -half_m, half_m), datagram->sigma_m);
    }
    assert_int_equal(rho_message_plot_scan_encode(&scan, buffer, sizeof buffer, &size), RHO_OK);
    take(live, RHO_MESSAGE_PLOT_SCAN_CHANNEL, datagram->sensor_id, buffer, size);
}

static void add(struct live *live, struct datagram datagram)
{
    assert_true(live->count < DATAGRAMS);
    datagram.num_parts = (int16_t)(datagram.num_parts > 0 ? datagram.num_parts : 1);
    live->datagrams[live->count++] = datagram;
}

static void add_radar(struct live *live, int64_t interval_us)
{
    for (int32_t i = 0; i * interval_us < end_s * SECOND_US; i++) {
        const int64_t time_us = START_US + i * interval_us;

        add(live,
            (struct datagram){
                .received_us = time_us + DELAY_US, .time_us = time_us, .scan = i, .sensor_id = 1});
    }
}

/*
 * ---- what came of it --------------------------------------------------------------------------
 */

static const struct rho_track_report *nearest(const struct rho_report *report, int target)
{
    const double t_s = (double)(report->time_us - START_US) / 1e6;
    const struct rho_track_report *best = NULL;
    double best_m = NEAR_M;

    for (uint32_t i = 0; i < report->num_tracks; i++) {
        const struct rho_track_report *track = &report->tracks[i];
        const double away_m = hypot((double)track->state[0] - x_of(target, t_s),
                                    (double)track->state[1] - y_of(target, t_s));

        if (track->status != RHO_TRACK_TENTATIVE && away_m < best_m) {
            best_m = away_m;
            best = track;
        }
    }
    return best;
}

/* After each step. A track that is not hit, and one that is not there, is a gap. */
static void judge(void *context, const struct rho_report *report)
{
    struct live *live = context;
    const struct rho_track_report *track = nearest(report, 0);
    const int64_t gap_us = live->now_us - live->updated_us;

    if (live->now_us >= START_US + attack_s * SECOND_US && gap_us > live->gap_us) {
        live->gap_us = gap_us;
    }
    if (track && track->hits != live->hits) {
        live->hits = track->hits;
        live->updated_us = live->now_us;
    }
    if (live->found_us == 0 && nearest(report, 1)) {
        live->found_us = live->now_us;
    }
}

static void ignore(void *context, const char *channel, const uint8_t *data, size_t size)
{
    (void)context;
    (void)channel;
    (void)data;
    (void)size;
}

static int by_reception(const void *a, const void *b)
{
    const struct datagram *first = a, *second = b;

    return (first->received_us > second->received_us) - (first->received_us < second->received_us);
}

static void start(struct live *live, int64_t interval_us)
{
    char reason[PARAMETER_REASON_BYTES];

    *live = (struct live){.now_us = 0};
    parameters_set_defaults(&live->parameters);
    assert_true(parameters_assign(&live->parameters, "v_max_mps", "400", SOURCE_CONFIG, reason));
    add_radar(live, interval_us);
}

static void run(struct live *live)
{
    const struct node_core_events events = {.context = live, .send = ignore, .stepped = judge};

    live->core = node_core_open(&live->parameters, 1, &events);
    qsort(live->datagrams, live->count, sizeof live->datagrams[0], by_reception);
    live->updated_us = START_US + attack_s * SECOND_US;
    for (unsigned i = 0; i < live->count; i++) {
        const int64_t received_us = live->datagrams[i].received_us;
        int64_t due_us;

        while ((due_us = node_core_due_us(live->core)) < received_us) {
            live->now_us = due_us > live->now_us ? due_us : live->now_us;
            node_core_tick(live->core, live->now_us);
        }
        live->now_us = received_us > live->now_us ? received_us : live->now_us;
        send(live, &live->datagrams[i]);
    }
    node_core_flush(live->core);
    if (live->now_us - live->updated_us > live->gap_us) {
        live->gap_us = live->now_us - live->updated_us;
    }
}

/*
 * ---- attacks ----------------------------------------------------------------------------------
 */

typedef void attacker(struct live *live, int64_t from_us);

static void nobody(struct live *live, int64_t from_us)
{
    (void)live;
    (void)from_us;
}

/*
 * Each scan has as many plots as the messages hold, in one spot: every pair of them may be a
 * target.
 */
static void crowds_in_120_datagrams(struct live *live, int64_t from_us)
{
    for (int16_t i = 0; i < 120; i++) {
        add(live, (struct datagram){.received_us = from_us + i * 500,
                                    .time_us = from_us + i / 12 * 300000,
                                    .scan = i / 12,
                                    .sensor_id = 9,
                                    .part = i % 12,
                                    .num_parts = 12,
                                    .num_plots = 34,
                                    .sigma_m = 20.0f,
                                    .half_m = 100.0f});
    }
}

/* Nothing where the targets are: what misses them six times in a row ends their tracks. */
static void scans_in_120_datagrams(struct live *live, int64_t from_us)
{
    for (int16_t i = 0; i < 120; i++) {
        add(live, (struct datagram){.received_us = from_us + i * 5000,
                                    .time_us = from_us + i * 5000,
                                    .scan = i,
                                    .sensor_id = 9,
                                    .num_plots = 1,
                                    .sigma_m = 20.0f,
                                    .half_m = 100.0f});
    }
}

static void one_ahead_each_3_s(struct live *live, int64_t from_us)
{
    for (int32_t i = 0; i < 20; i++) {
        const int64_t now_us = from_us + i * 3 * SECOND_US;

        add(live, (struct datagram){.received_us = now_us,
                                    .time_us = now_us + 3700000,
                                    .scan = i,
                                    .sensor_id = 9,
                                    .num_plots = 1,
                                    .sigma_m = 20.0f});
    }
}

static void eight_an_hour_ahead(struct live *live, int64_t from_us)
{
    for (int32_t i = 0; i < 8; i++) {
        const int64_t now_us = from_us + i * 100000;

        add(live, (struct datagram){.received_us = now_us,
                                    .time_us = now_us + 3600 * SECOND_US,
                                    .scan = i / 2,
                                    .sensor_id = (int16_t)(8 + i % 2),
                                    .num_plots = 1,
                                    .sigma_m = 20.0f});
    }
}

/* As a sensor of another kind, in the number of the radar, which the config names. */
static void polar_scans_in_its_number(struct live *live, int64_t from_us)
{
    char reason[PARAMETER_REASON_BYTES];

    assert_true(parameters_assign(&live->parameters, "sensor.1.range_max_m", "100000",
                                  SOURCE_CONFIG, reason));
    for (int16_t i = 0; i < 120; i++) {
        add(live, (struct datagram){.received_us = from_us + i * 5000,
                                    .time_us = from_us + i * 5000,
                                    .scan = i,
                                    .sensor_id = 1,
                                    .is_polar = 1});
    }
}

/* Until the end. */
static void an_empty_one_after_each_of_its(struct live *live, int64_t from_us)
{
    const int64_t interval_us = live->datagrams[1].time_us - live->datagrams[0].time_us;

    for (int32_t i = 0; i * interval_us < (end_s - attack_s) * SECOND_US; i++) {
        const int64_t time_us = from_us + i * interval_us + DELAY_US;

        add(live, (struct datagram){.received_us = time_us + DELAY_US,
                                    .time_us = time_us,
                                    .scan = i,
                                    .sensor_id = 9,
                                    .num_plots = 1,
                                    .sigma_m = 20.0f,
                                    .half_m = 100.0f});
    }
}

static void try(struct live *live, int64_t interval_us, attacker *attack, const char *what)
{
    start(live, interval_us);
    attack(live, START_US + attack_s * SECOND_US);
    run(live);
    print_message("  %-24s gap %.2f s, found after %.2f s, longest step %.3f s\n", what,
                  (double)live->gap_us / 1e6,
                  live->found_us ? (double)(live->found_us - START_US) / 1e6 - attack_s
                                 : (double)NAN,
                  node_core_max_step_us(live->core) / 1e6);
    node_core_close(live->core);
}

/* Beside what the radar alone does. */
static void nobody_is_harmed(int64_t interval_us)
{
    static const struct {
        attacker *attack;
        const char *what;
    } attacks[] = {{crowds_in_120_datagrams, "120 datagrams, crowds"},
                   {scans_in_120_datagrams, "120 datagrams, empty"},
                   {one_ahead_each_3_s, "1 datagram each 3 s"},
                   {eight_an_hour_ahead, "8 datagrams"},
                   {polar_scans_in_its_number, "120 polar, in its number"},
                   {an_empty_one_after_each_of_its, "1 after each, empty"}};
    static struct live alone, live;

    print_message("a scan each %.2f s\n", (double)interval_us / 1e6);
    try(&alone, interval_us, nobody, "nobody");
    assert_true(alone.found_us > 0);
    for (unsigned i = 0; i < sizeof attacks / sizeof attacks[0]; i++) {
        try(&live, interval_us, attacks[i].attack, attacks[i].what);
        assert_true(live.gap_us <= alone.gap_us + 1500000);
        assert_true(live.found_us > 0 && live.found_us <= alone.found_us + SECOND_US);
    }
}

static void a_fast_radar_tracks_on(void **state)
{
    (void)state;
    attack_s = 120;
    end_s = 180;
    nobody_is_harmed(50000);
}

static void a_slow_radar_tracks_on(void **state)
{
    (void)state;
    attack_s = 120;
    end_s = 180;
    nobody_is_harmed(2500000);
}

/* Between two of its scans it was not heard for more than half of jump_max_s. */
static void a_radar_of_20_s_tracks_on(void **state)
{
    (void)state;
    attack_s = 600;
    end_s = 900;
    nobody_is_harmed(20000000);
}

/* Said once, however often it happens. */
static void two_senders_of_one_number_are_told(void **state)
{
    static struct live live;
    struct node_sensors sensors = {.count = 0};
    char *said = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&said, &size);

    (void)state;
    attack_s = 120;
    end_s = 180;
    start(&live, SECOND_US);
    for (int32_t scan = 1; scan < 120; scan += 40) {
        const int64_t time_us = START_US + scan * SECOND_US;

        add(&live, (struct datagram){.received_us = time_us + 2 * DELAY_US,
                                     .time_us = time_us,
                                     .scan = scan,
                                     .sensor_id = 1,
                                     .num_plots = 1,
                                     .sigma_m = 20.0f});
    }
    run(&live);
    for (int i = 0; i < 2; i++) {
        node_sensors_print_changes(&sensors, live.core, to);
    }
    fclose(to);
    assert_string_equal(said, "rhotrack: sensor 1: a scan came twice with different contents: two "
                              "senders use this number\n");
    assert_int_equal(node_core_assembler_counters(live.core)->scans_other, 3);
    node_core_close(live.core);
    free(said);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fast_radar_tracks_on),
        cmocka_unit_test(a_slow_radar_tracks_on),
        cmocka_unit_test(a_radar_of_20_s_tracks_on),
        cmocka_unit_test(two_senders_of_one_number_are_told),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
