/* SPDX-License-Identifier: MIT */
/*
 * A radar that is heard for minutes, and an attacker's datagrams, live: the radar's track goes on,
 * and a new target is found as early as without the attack. Each step's run time is added to the
 * node's clock.
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
#define SECOND_US INT64_C(1000000)
#define DELAY_US INT64_C(5000)
#define CLUTTER 10
#define STRANGERS 8
#define DATAGRAMS 14000
#define SIGMA_M 20.0
#define NEAR_M 1000.0

/* ---- the scene ------------------------------------------------------------------------------- */

static int64_t attack_s, end_s; /* start of the attack and of the new target, end of the run */

struct datagram {
    int64_t received_us, time_us;
    int32_t scan;
    /* num_plots 0: the radar's own scan at this time */
    int16_t sensor_id, part, num_parts, num_plots;
    float sigma_m, half_m;
    int is_polar; /* a polar scan without plots */
};

struct live {
    struct parameters parameters;
    struct node_core *core;
    struct datagram datagrams[DATAGRAMS];
    unsigned count;
    int64_t now_us; /* reception clock, delayed by the time that steps take */
    uint32_t hits;  /* hits of the old target's track */
    int64_t updated_us, gap_us;
    int64_t found_us; /* when the new target's track was confirmed; 0: not so far */
};

static double target_x_m(int target, double t_s)
{
    return target == 0 ? -20000.0 + 100.0 * t_s : 30000.0 - 120.0 * (t_s - attack_s);
}

static double target_y_m(int target, double t_s)
{
    return target == 0 ? 10000.0 - 50.0 * t_s : -20000.0 + 60.0 * (t_s - attack_s);
}

static void put_plot(struct rho_message_plot_scan *scan, double x_m, double y_m, double sigma_m)
{
    scan->plots[scan->num_plots++] =
        (struct rho_message_plot){.x_m = (float)x_m, .y_m = (float)y_m, .sigma_m = (float)sigma_m};
}

static void put_plots_of_targets_and_clutter(struct rho_message_plot_scan *scan,
                                             struct random *random)
{
    const double t_s = (double)(scan->utime - START_US) / 1e6;

    for (int i = 0; i < (t_s < attack_s ? 1 : 2); i++) {
        const double dx_m = SIGMA_M * random_normal(random), dy_m = SIGMA_M * random_normal(random);

        put_plot(scan, target_x_m(i, t_s) + dx_m, target_y_m(i, t_s) + dy_m, SIGMA_M);
    }
    for (int i = 0; i < CLUTTER; i++) {
        const double x_m = random_between(random, -50000.0, 50000.0);

        put_plot(scan, x_m, random_between(random, -50000.0, 50000.0), SIGMA_M);
    }
}

static void take_message_and_advance_clock_by_its_work(struct live *live, const char *channel,
                                                       int16_t sensor_id, const uint8_t *message,
                                                       size_t size)
{
    char name[32];
    int64_t start_us;

    snprintf(name, sizeof name, "%s%d", channel, sensor_id);
    start_us = monotonic_clock_us();
    node_core_take_message(live->core, name, message, size, live->now_us);
    live->now_us += monotonic_clock_us() - start_us;
}

static void send_empty_polar_scan(struct live *live, const struct datagram *datagram)
{
    const struct rho_message_polar_scan nothing = {.utime = datagram->time_us,
                                                   .scan = datagram->scan,
                                                   .sensor_id = datagram->sensor_id,
                                                   .num_parts = 1};
    uint8_t buffer[RHO_MESSAGE_POLAR_SCAN_MAX_SIZE];
    size_t size;

    assert_int_equal(rho_message_polar_scan_encode(&nothing, buffer, sizeof buffer, &size), RHO_OK);
    take_message_and_advance_clock_by_its_work(live, RHO_MESSAGE_POLAR_SCAN_CHANNEL,
                                               datagram->sensor_id, buffer, size);
}

/* Sends a datagram, with the same plots whenever it is sent. */
static void send_datagram(struct live *live, const struct datagram *datagram)
{
    static struct rho_message_plot_scan scan;
    struct random random = random_start(1, (uint64_t)datagram->sensor_id,
                                        (uint64_t)(datagram->scan * 1000 + datagram->part));
    uint8_t buffer[RHO_MESSAGE_PLOT_SCAN_MAX_SIZE];
    size_t size;

    if (datagram->is_polar) {
        send_empty_polar_scan(live, datagram);
        return;
    }
    scan = (struct rho_message_plot_scan){.utime = datagram->time_us,
                                          .scan = datagram->scan,
                                          .sensor_id = datagram->sensor_id,
                                          .kind = RHO_MESSAGE_PLOT_SCAN_POSITION_2D,
                                          .part = datagram->part,
                                          .num_parts = datagram->num_parts};
    if (datagram->num_plots == 0) {
        put_plots_of_targets_and_clutter(&scan, &random);
    }
    for (int i = 0; i < datagram->num_plots; i++) {
        const double half_m = datagram->half_m > 0.0f ? (double)datagram->half_m : 50000.0;
        const double x_m = random_between(&random, -half_m, half_m);

        put_plot(&scan, x_m, random_between(&random, -half_m, half_m), datagram->sigma_m);
    }
    assert_int_equal(rho_message_plot_scan_encode(&scan, buffer, sizeof buffer, &size), RHO_OK);
    take_message_and_advance_clock_by_its_work(live, RHO_MESSAGE_PLOT_SCAN_CHANNEL,
                                               datagram->sensor_id, buffer, size);
}

static void add_datagram(struct live *live, struct datagram datagram)
{
    assert_true(live->count < DATAGRAMS);
    datagram.num_parts = (int16_t)(datagram.num_parts > 0 ? datagram.num_parts : 1);
    live->datagrams[live->count++] = datagram;
}

static void add_radar_scans(struct live *live, int64_t interval_us)
{
    for (int32_t i = 0; i * interval_us < end_s * SECOND_US; i++) {
        const int64_t time_us = START_US + i * interval_us;

        add_datagram(live, (struct datagram){.received_us = time_us + DELAY_US,
                                             .time_us = time_us,
                                             .scan = i,
                                             .sensor_id = 1});
    }
}

/* ---- gaps of the track, and the new target --------------------------------------------------- */

static const struct rho_track_report *track_nearest_to(const struct rho_report *report, int target)
{
    const double t_s = (double)(report->time_us - START_US) / 1e6;
    const struct rho_track_report *best = NULL;
    double best_m = NEAR_M;

    for (uint32_t i = 0; i < report->num_tracks; i++) {
        const struct rho_track_report *track = &report->tracks[i];
        const double away_m = hypot((double)track->state[0] - target_x_m(target, t_s),
                                    (double)track->state[1] - target_y_m(target, t_s));

        if (track->status != RHO_TRACK_TENTATIVE && away_m < best_m) {
            best_m = away_m;
            best = track;
        }
    }
    return best;
}

/* Called after each step: time without a hit, or without a track, is a gap. */
static void note_longest_gap_in_hits_and_time_found(void *context, const struct rho_report *report)
{
    struct live *live = context;
    const struct rho_track_report *track = track_nearest_to(report, 0);
    const int64_t gap_us = live->now_us - live->updated_us;

    if (live->now_us >= START_US + attack_s * SECOND_US && gap_us > live->gap_us) {
        live->gap_us = gap_us;
    }
    if (track && track->hits != live->hits) {
        live->hits = track->hits;
        live->updated_us = live->now_us;
    }
    if (live->found_us == 0 && track_nearest_to(report, 1)) {
        live->found_us = live->now_us;
    }
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
    const struct datagram *first = a, *second = b;

    return (first->received_us > second->received_us) - (first->received_us < second->received_us);
}

static void set_parameters_and_plan_radar_scans(struct live *live, int64_t interval_us)
{
    char reason[PARAMETER_REASON_BYTES];

    *live = (struct live){.now_us = 0};
    parameters_set_defaults(&live->parameters);
    assert_true(parameters_assign(&live->parameters, "v_max_mps", "400", SOURCE_CONFIG, reason));
    add_radar_scans(live, interval_us);
}

static void run_node(struct live *live)
{
    const struct node_core_events events = {.context = live,
                                            .send = ignore_message,
                                            .stepped = note_longest_gap_in_hits_and_time_found};

    live->core = node_core_open(&live->parameters, 1, &events);
    qsort(live->datagrams, live->count, sizeof live->datagrams[0], compare_reception_times);
    live->updated_us = START_US + attack_s * SECOND_US;
    for (unsigned i = 0; i < live->count; i++) {
        const int64_t received_us = live->datagrams[i].received_us;
        int64_t due_us;

        while ((due_us = node_core_due_us(live->core)) < received_us) {
            live->now_us = due_us > live->now_us ? due_us : live->now_us;
            node_core_tick(live->core, live->now_us);
        }
        live->now_us = received_us > live->now_us ? received_us : live->now_us;
        send_datagram(live, &live->datagrams[i]);
    }
    node_core_flush(live->core);
    if (live->now_us - live->updated_us > live->gap_us) {
        live->gap_us = live->now_us - live->updated_us;
    }
}

/* ---- attacks --------------------------------------------------------------------------------- */

typedef void attacker(struct live *live, int64_t from_us);

static void attack_with_nothing(struct live *live, int64_t from_us)
{
    (void)live;
    (void)from_us;
}

/*
 * Scans with as many plots as the messages hold, all near one place: every pair of plots may be a
 * target.
 */
static void attack_with_120_datagrams_of_crowded_scans(struct live *live, int64_t from_us)
{
    for (int16_t i = 0; i < 120; i++) {
        add_datagram(live, (struct datagram){.received_us = from_us + i * 500,
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

/* Six scans in a row without plots of the targets would end their tracks by misses. */
static void attack_with_120_scans_without_target_plots(struct live *live, int64_t from_us)
{
    for (int16_t i = 0; i < 120; i++) {
        add_datagram(live, (struct datagram){.received_us = from_us + i * 5000,
                                             .time_us = from_us + i * 5000,
                                             .scan = i,
                                             .sensor_id = 9,
                                             .num_plots = 1,
                                             .sigma_m = 20.0f,
                                             .half_m = 100.0f});
    }
}

static void attack_with_a_scan_ahead_each_3_s(struct live *live, int64_t from_us)
{
    for (int32_t i = 0; i < 20; i++) {
        const int64_t now_us = from_us + i * 3 * SECOND_US;

        add_datagram(live, (struct datagram){.received_us = now_us,
                                             .time_us = now_us + 3700000,
                                             .scan = i,
                                             .sensor_id = 9,
                                             .num_plots = 1,
                                             .sigma_m = 20.0f});
    }
}

static void attack_with_eight_scans_an_hour_ahead(struct live *live, int64_t from_us)
{
    for (int32_t i = 0; i < 8; i++) {
        const int64_t now_us = from_us + i * 100000;

        add_datagram(live, (struct datagram){.received_us = now_us,
                                             .time_us = now_us + 3600 * SECOND_US,
                                             .scan = i / 2,
                                             .sensor_id = (int16_t)(8 + i % 2),
                                             .num_plots = 1,
                                             .sigma_m = 20.0f});
    }
}

/* Polar scans, another kind of sensor, under the radar's number, which the config names. */
static void attack_with_polar_scans_of_its_number(struct live *live, int64_t from_us)
{
    char reason[PARAMETER_REASON_BYTES];

    assert_true(parameters_assign(&live->parameters, "sensor.1.range_max_m", "100000",
                                  SOURCE_CONFIG, reason));
    for (int16_t i = 0; i < 120; i++) {
        add_datagram(live, (struct datagram){.received_us = from_us + i * 5000,
                                             .time_us = from_us + i * 5000,
                                             .scan = i,
                                             .sensor_id = 1,
                                             .is_polar = 1});
    }
}

/* An empty scan after each of the radar's scans, until the end. */
static void attack_with_targetless_scan_after_each_of_radar(struct live *live, int64_t from_us)
{
    const int64_t interval_us = live->datagrams[1].time_us - live->datagrams[0].time_us;

    for (int32_t i = 0; i * interval_us < (end_s - attack_s) * SECOND_US; i++) {
        const int64_t time_us = from_us + i * interval_us + DELAY_US;

        add_datagram(live, (struct datagram){.received_us = time_us + DELAY_US,
                                             .time_us = time_us,
                                             .scan = i,
                                             .sensor_id = 9,
                                             .num_plots = 1,
                                             .sigma_m = 20.0f,
                                             .half_m = 100.0f});
    }
}

/* ---- strangers who were heard for five minutes before ---------------------------------------- */

/* 13 scans of sensor 9 in the five minutes before the attack, with a plot each: heard for long. */
static void be_heard_for_five_minutes(struct live *live, int64_t until_us)
{
    for (int32_t i = 0; i < 13; i++) {
        const int64_t now_us = until_us - (13 - i) * 24 * SECOND_US;

        add_datagram(live, (struct datagram){.received_us = now_us,
                                             .time_us = now_us,
                                             .scan = i,
                                             .sensor_id = 9,
                                             .num_plots = 1,
                                             .sigma_m = 20.0f,
                                             .half_m = 100.0f});
    }
}

/* Then 120 without plots of the targets, 5 ms apart. */
static void attack_of_one_heard_with_120_scans_without_target_plots(struct live *live,
                                                                    int64_t from_us)
{
    be_heard_for_five_minutes(live, from_us);
    for (int16_t i = 0; i < 120; i++) {
        add_datagram(live, (struct datagram){.received_us = from_us + i * 5000,
                                             .time_us = from_us + i * 5000,
                                             .scan = 13 + i,
                                             .sensor_id = 9,
                                             .num_plots = 1,
                                             .sigma_m = 20.0f,
                                             .half_m = 100.0f});
    }
}

/* Then one each 2 s, 6 s ahead. */
static void attack_of_one_heard_with_a_scan_6_s_ahead_each_2_s(struct live *live, int64_t from_us)
{
    be_heard_for_five_minutes(live, from_us);
    for (int32_t i = 0; i * 2 < end_s - attack_s; i++) {
        const int64_t now_us = from_us + i * 2 * SECOND_US;

        add_datagram(live, (struct datagram){.received_us = now_us,
                                             .time_us = now_us + 6 * SECOND_US,
                                             .scan = 13 + i,
                                             .sensor_id = 9,
                                             .num_plots = 1,
                                             .sigma_m = 20.0f});
    }
}

static void run_attack_and_print_gap_and_delay(struct live *live, int64_t interval_us,
                                               attacker *attack, const char *what)
{
    set_parameters_and_plan_radar_scans(live, interval_us);
    attack(live, START_US + attack_s * SECOND_US);
    run_node(live);
    print_message("  %-24s gap %.2f s, found after %.2f s, longest step %.3f s\n", what,
                  (double)live->gap_us / 1e6,
                  live->found_us ? (double)(live->found_us - START_US) / 1e6 - attack_s
                                 : (double)NAN,
                  node_core_max_step_us(live->core) / 1e6);
    node_core_close(live->core);
}

struct attack {
    attacker *attack;
    const char *what;
};

/* Each attack compared with the radar alone: gaps are hardly longer, delays by late_max_us. */
static void check_attacks_are_harmless(const struct attack *attacks, unsigned count, int64_t from_s,
                                       int64_t interval_us, int64_t late_max_us)
{
    static struct live alone, live;

    attack_s = from_s;
    end_s = from_s + (interval_us < 10 * SECOND_US ? 60 : 300);
    print_message("a scan each %.2f s\n", (double)interval_us / 1e6);
    run_attack_and_print_gap_and_delay(&alone, interval_us, attack_with_nothing, "nobody");
    assert_true(alone.found_us > 0);
    for (unsigned i = 0; i < count; i++) {
        run_attack_and_print_gap_and_delay(&live, interval_us, attacks[i].attack, attacks[i].what);
        assert_true(live.gap_us <= alone.gap_us + 1500000);
        assert_true(live.found_us > 0 && live.found_us <= alone.found_us + late_max_us);
    }
}

static const struct attack of_newcomers[] = {
    {attack_with_120_datagrams_of_crowded_scans, "120 datagrams, crowds"},
    {attack_with_120_scans_without_target_plots, "120 datagrams, empty"},
    {attack_with_a_scan_ahead_each_3_s, "1 datagram each 3 s"},
    {attack_with_eight_scans_an_hour_ahead, "8 datagrams"},
    {attack_with_polar_scans_of_its_number, "120 polar, in its number"},
    {attack_with_targetless_scan_after_each_of_radar, "1 after each, empty"}};
static const struct attack of_one_heard[] = {
    {attack_of_one_heard_with_120_scans_without_target_plots, "heard, 120 empty"},
    {attack_of_one_heard_with_a_scan_6_s_ahead_each_2_s, "heard, 6 s ahead"}};
#define COUNT_OF(attacks) (sizeof(attacks) / sizeof *(attacks))

static void attacks_do_not_disturb_a_fast_radar(void **state)
{
    (void)state;
    check_attacks_are_harmless(of_newcomers, COUNT_OF(of_newcomers), 120, 50000, SECOND_US);
}

static void attacks_do_not_disturb_a_slow_radar(void **state)
{
    (void)state;
    check_attacks_are_harmless(of_newcomers, COUNT_OF(of_newcomers), 120, 2500000, SECOND_US);
}

/* A radar of 20 s is silent between its scans for more than half of jump_max_s. */
static void attacks_do_not_disturb_a_radar_of_20_s(void **state)
{
    (void)state;
    check_attacks_are_harmless(of_newcomers, COUNT_OF(of_newcomers), 600, 20000000, SECOND_US);
}

static void attacks_of_one_who_was_heard_for_long_do_not_disturb(void **state)
{
    static const int64_t intervals_us[] = {50000, 2500000, 20000000};

    (void)state;
    for (unsigned i = 0; i < COUNT_OF(intervals_us); i++) {
        /* its plots in one spot are objects that the radar seldom sees: evidence is asked for */
        check_attacks_are_harmless(of_one_heard, COUNT_OF(of_one_heard), 600, intervals_us[i],
                                   SECOND_US + 2 * intervals_us[i]);
    }
}

/* Two senders are counted once, however often they alternate. */
static void scans_of_two_senders_of_one_number_are_warned_of_once(void **state)
{
    static struct live live;
    struct node_sensors sensors = {.count = 0};
    char *said = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&said, &size);

    (void)state;
    attack_s = 120;
    end_s = 180;
    set_parameters_and_plan_radar_scans(&live, SECOND_US);
    for (int32_t scan = 1; scan < 120; scan += 40) {
        const int64_t time_us = START_US + scan * SECOND_US;

        add_datagram(&live, (struct datagram){.received_us = time_us + 2 * DELAY_US,
                                              .time_us = time_us,
                                              .scan = scan,
                                              .sensor_id = 1,
                                              .num_plots = 1,
                                              .sigma_m = 20.0f});
    }
    run_node(&live);
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
        cmocka_unit_test(attacks_do_not_disturb_a_fast_radar),
        cmocka_unit_test(attacks_do_not_disturb_a_slow_radar),
        cmocka_unit_test(attacks_do_not_disturb_a_radar_of_20_s),
        cmocka_unit_test(attacks_of_one_who_was_heard_for_long_do_not_disturb),
        cmocka_unit_test(scans_of_two_senders_of_one_number_are_warned_of_once),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
