/* SPDX-License-Identifier: MIT */
/*
 * A fifth of the scans of one or two radars is received out of order, behind the radar's next scan.
 * In the reorder buffer they change nothing; later they update the tracks; if they are dropped, the
 * tracks' loss is measured.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "live/node_core.h"
#include "rhotrack/message.h"

#define START_US INT64_C(1790000000000000) /* microseconds since 1970, in 2026 */
#define ROUND_US INT64_C(4000000)
#define ROUNDS 150
#define FIRST_ROUND 15 /* errors count from this round on */
#define TARGETS 10
#define SENSORS_MAX 2
#define CLUTTER 20
#define SIGMA_M 30.0
#define DELAY_US INT64_C(50000) /* delay of messages that are in order */
#define SHARE 0.2
#define SEEDS 10

struct event {
    int64_t received_us;
    int16_t sensor_id;
    int32_t scan;
};

struct live {
    struct parameters parameters;
    struct node_core *core;
    struct event events[SENSORS_MAX * ROUNDS];
    unsigned num_events;
    /* by round, from the last report of its time; NAN: no report */
    double sum_m2[ROUNDS];
    unsigned found[ROUNDS];
    uint32_t tracks[TARGETS]; /* identity of the last track near each target; 0: none so far */
    /* changes of identity, and targets without a track at the end */
    unsigned lost;
    uint64_t seed;
};

/* Figures over the rounds that have a report in this run and in the one it is compared with. */
struct figures {
    double sum_m2, rmse_m;
    unsigned found, rounds, lost, scans;
    uint32_t late, retrodicted, stale;
    struct scan_losses losses; /* losses of the last run */
};

/*
 * ---- truth and scans --------------------------------------------------------------------------
 */

/* Lanes 20 km apart; every second target turns by 1 degree a second from 200 to 290 s. */
static void true_place_of(int target, double t_s, double place_m[2])
{
    const double speed = 120.0 + 12.0 * target, turn = target % 2 ? M_PI / 180.0 : 0.0;
    const double from_s = 200.0, to_s = 290.0;
    const double in_s = turn > 0.0 ? fmin(fmax(t_s - from_s, 0.0), to_s - from_s) : 0.0;
    const double before_s = turn > 0.0 ? fmin(t_s, from_s) : t_s;
    const double behind_s = turn > 0.0 ? fmax(t_s - to_s, 0.0) : 0.0;
    const double heading = turn * in_s;

    place_m[0] = -40000.0 + speed * (before_s + behind_s * cos(heading));
    place_m[1] = -90000.0 + 20000.0 * target + speed * behind_s * sin(heading);
    if (turn > 0.0) {
        place_m[0] += speed / turn * sin(heading);
        place_m[1] += speed / turn * (1.0 - cos(heading));
    }
}

static int64_t time_of_scan(int16_t sensor_id, int32_t scan)
{
    return START_US + scan * ROUND_US + (sensor_id - 1) * ROUND_US / 2;
}

static void add_plot(struct rho_message_plot_scan *scan, double x_m, double y_m)
{
    scan->plots[scan->num_plots++] =
        (struct rho_message_plot){.x_m = (float)x_m, .y_m = (float)y_m, .sigma_m = (float)SIGMA_M};
}

/* Sends a scan, with the same plots whenever it is sent. */
static void send_scan(struct live *live, const struct event *event)
{
    static struct rho_message_plot_scan scan;
    struct random random =
        random_start(live->seed, (uint64_t)event->sensor_id, (uint64_t)event->scan);
    uint8_t buffer[RHO_MESSAGE_PLOT_SCAN_MAX_SIZE];
    char channel[32];
    size_t size;

    scan = (struct rho_message_plot_scan){.utime = time_of_scan(event->sensor_id, event->scan),
                                          .scan = event->scan,
                                          .sensor_id = event->sensor_id,
                                          .kind = RHO_MESSAGE_PLOT_SCAN_POSITION_2D,
                                          .num_parts = 1};
    for (int i = 0; i < TARGETS; i++) {
        double place_m[2], dx_m = SIGMA_M * random_normal(&random),
                           dy_m = SIGMA_M * random_normal(&random);

        true_place_of(i, (double)(scan.utime - START_US) / 1e6, place_m);
        if (random_uniform(&random) < 0.9) {
            add_plot(&scan, place_m[0] + dx_m, place_m[1] + dy_m);
        }
    }
    for (int i = 0; i < CLUTTER; i++) {
        const double x_m = random_between(&random, -50000.0, 120000.0);

        add_plot(&scan, x_m, random_between(&random, -100000.0, 140000.0));
    }
    assert_int_equal(rho_message_plot_scan_encode(&scan, buffer, sizeof buffer, &size), RHO_OK);
    snprintf(channel, sizeof channel, "%s%d", RHO_MESSAGE_PLOT_SCAN_CHANNEL, event->sensor_id);
    node_core_take_message(live->core, channel, buffer, size, event->received_us);
}

/* ---- order of reception ---------------------------------------------------------------------- */

static int compare_reception_times(const void *a, const void *b)
{
    const struct event *first = a, *second = b;

    return (first->received_us > second->received_us) - (first->received_us < second->received_us);
}

/*
 * lag_us: delay of an out-of-order scan after its radar's next scan; below 0: all scans in order.
 */
static void plan_receptions_some_out_of_order(struct live *live, int16_t sensors, int64_t lag_us)
{
    for (int16_t sensor_id = 1; sensor_id <= sensors; sensor_id++) {
        struct random random = random_start(1000 + live->seed, (uint64_t)sensor_id, 0);
        bool was_late = false;

        for (int32_t scan = 0; scan < ROUNDS; scan++) {
            const bool is_drawn = random_uniform(&random) < SHARE / (1.0 - SHARE);
            const bool is_late = lag_us >= 0 && is_drawn && !was_late && scan > 5;
            const int64_t time_us = time_of_scan(sensor_id, scan + is_late);

            live->events[live->num_events++] =
                (struct event){time_us + DELAY_US + (is_late ? lag_us : 0), sensor_id, scan};
            was_late = is_late;
        }
    }
    qsort(live->events, live->num_events, sizeof live->events[0], compare_reception_times);
}

/* ---- errors and losses ----------------------------------------------------------------------- */

/* Called after each step; the last step of a round counts. */
static void note_errors(void *context, const struct rho_report *report)
{
    struct live *live = context;
    const int32_t round = (int32_t)((report->time_us - START_US) / ROUND_US);
    const double t_s = (double)(report->time_us - START_US) / 1e6;

    if (round < 0 || round >= ROUNDS) {
        return;
    }
    live->sum_m2[round] = 0.0;
    live->found[round] = 0;
    for (int i = 0; i < TARGETS; i++) {
        double place_m[2], best_m = 1000.0;
        uint32_t best = 0;

        true_place_of(i, t_s, place_m);
        for (uint32_t k = 0; k < report->num_tracks; k++) {
            const double error_m = hypot((double)report->tracks[k].state[0] - place_m[0],
                                         (double)report->tracks[k].state[1] - place_m[1]);

            if (report->tracks[k].status != RHO_TRACK_TENTATIVE && error_m < best_m) {
                best_m = error_m;
                best = report->tracks[k].track_id;
            }
        }
        live->lost += live->tracks[i] > 0 && best > 0 && best != live->tracks[i];
        live->tracks[i] = best > 0 ? best : live->tracks[i];
        live->sum_m2[round] += best_m < 1000.0 ? best_m * best_m : 0.0;
        live->found[round] += best_m < 1000.0;
    }
}

static void ignore_message(void *context, const char *channel, const uint8_t *data, size_t size)
{
    (void)context;
    (void)channel;
    (void)data;
    (void)size;
}

static void run_node(struct live *live, uint64_t seed, int16_t sensors, int64_t lag_us,
                     const char *hold_ms, const char *late_max_s)
{
    const struct node_core_events events = {
        .context = live, .send = ignore_message, .stepped = note_errors};
    char reason[PARAMETER_REASON_BYTES];

    *live = (struct live){.seed = seed};
    parameters_set_defaults(&live->parameters);
    assert_true(
        parameters_assign(&live->parameters, "late_max_s", late_max_s, SOURCE_CONFIG, reason));
    assert_true(parameters_assign(&live->parameters, "hold_ms", hold_ms, SOURCE_CONFIG, reason));
    assert_true(parameters_assign(&live->parameters, "v_max_mps", "400", SOURCE_CONFIG, reason));
    assert_true(
        parameters_assign(&live->parameters, "accel_max_mps2", "10", SOURCE_CONFIG, reason));
    live->core = node_core_open(&live->parameters, 1, &events);
    for (int i = 0; i < ROUNDS; i++) {
        live->sum_m2[i] = (double)NAN;
    }
    plan_receptions_some_out_of_order(live, sensors, lag_us);
    for (unsigned i = 0; i < live->num_events; i++) {
        while (node_core_due_us(live->core) < live->events[i].received_us) {
            node_core_tick(live->core, node_core_due_us(live->core));
        }
        send_scan(live, &live->events[i]);
    }
    node_core_flush(live->core);
    live->lost += TARGETS - live->found[ROUNDS - 1];
}

static void add_run(struct figures *figures, const struct live *live, const struct live *with)
{
    const struct rho_tracker_counters *tracker = node_core_tracker_counters(live->core);

    for (int i = FIRST_ROUND; i < ROUNDS; i++) {
        if (!isnan(live->sum_m2[i]) && !isnan(with->sum_m2[i])) {
            figures->rounds++;
            figures->found += live->found[i];
            figures->sum_m2 += live->sum_m2[i];
        }
    }
    figures->rmse_m = sqrt(figures->sum_m2 / figures->found);
    figures->lost += live->lost;
    figures->scans += live->num_events;
    figures->late += node_core_assembler_counters(live->core)->scans_late;
    figures->losses = out_of_sequence_counts_losses(node_core_used_out_of_sequence(live->core),
                                                    node_core_assembler_counters(live->core));
    figures->retrodicted += tracker->scans_retrodicted;
    figures->stale += tracker->fates[RHO_FATE_STALE];
}

static void print_figures(const char *what, const struct figures *figures)
{
    print_message("  %-28s rmse %.2f m, found %u of %u, tracks lost %u; of %u scans %u late, %u "
                  "moved back\n",
                  what, figures->rmse_m, figures->found, figures->rounds * TARGETS, figures->lost,
                  figures->scans, figures->late, figures->retrodicted);
}

/* Runs scans out of order by lag_us, and the same scans in order. */
static void compare_in_and_out_of_order(int16_t sensors, int64_t lag_us, const char *hold_ms,
                                        const char *late_max_s, struct figures *in_order,
                                        struct figures *out_of_order)
{
    static struct live straight, mixed;

    *in_order = *out_of_order = (struct figures){.rounds = 0};
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        run_node(&straight, seed, sensors, -1, hold_ms, late_max_s);
        run_node(&mixed, seed, sensors, lag_us, hold_ms, late_max_s);
        add_run(in_order, &straight, &mixed);
        add_run(out_of_order, &mixed, &straight);
        node_core_close(straight.core);
        node_core_close(mixed.core);
    }
}

/* About a fifth of the scans is late. */
static void expect_a_fifth_late(const struct figures *figures)
{
    assert_in_range(100 * figures->late / figures->scans, 17, 23);
}

/* The printed losses of the last run: late scans that were used are neither lost nor dropped. */
static void expect_no_scan_dropped(const struct figures *figures)
{
    assert_true(figures->losses.out_of_order > 0);
    assert_int_equal(figures->losses.dropped, 0);
    assert_int_equal(figures->losses.lost, 0);
}

static void check_reorder_buffer_restores_order(int16_t sensors, int64_t lag_us,
                                                const char *hold_ms)
{
    struct figures in_order, out_of_order;

    compare_in_and_out_of_order(sensors, lag_us, hold_ms, "20", &in_order, &out_of_order);
    print_message("%d radars, out of order by a scan and %.0f ms, held %s ms\n", sensors,
                  (double)lag_us / 1e3, hold_ms);
    print_figures("in order", &in_order);
    print_figures("out of order", &out_of_order);
    expect_a_fifth_late(&out_of_order);
    expect_no_scan_dropped(&out_of_order);
    assert_int_equal(out_of_order.retrodicted, 0);
    assert_int_equal(out_of_order.found, in_order.found);
    assert_int_equal(out_of_order.lost, in_order.lost);
    assert_float_equal(out_of_order.rmse_m, in_order.rmse_m, 0.0);
}

/* With two radars the scans of the other one are in between and wait, too. */
static void out_of_order_scans_in_the_reorder_buffer_change_nothing(void **state)
{
    (void)state;
    check_reorder_buffer_restores_order(1, 5000, "20");
    check_reorder_buffer_restores_order(2, 5000, "4500");
}

static void check_out_of_sequence_updates(int16_t sensors)
{
    struct figures in_order, out_of_order, dropped;

    compare_in_and_out_of_order(sensors, 1000000, "20", "0", &in_order, &dropped);
    compare_in_and_out_of_order(sensors, 1000000, "20", "20", &in_order, &out_of_order);
    print_message("%d radars, out of order by a scan and 1 s\n", sensors);
    print_figures("in order", &in_order);
    print_figures("out of order", &out_of_order);
    print_figures("out of order, late_max_s 0", &dropped);
    expect_a_fifth_late(&out_of_order);
    expect_no_scan_dropped(&out_of_order);
    assert_int_equal(dropped.losses.out_of_order, 0);
    assert_true(dropped.losses.dropped > 0);
    assert_true(dropped.losses.lost >= dropped.losses.dropped);
    assert_in_range(out_of_order.retrodicted, out_of_order.late, out_of_order.late + 10);
    assert_int_equal(dropped.retrodicted, 0);
    assert_true(out_of_order.lost <= in_order.lost);
    assert_true(out_of_order.rmse_m < 1.05 * in_order.rmse_m);
    assert_true(dropped.rmse_m > out_of_order.rmse_m);
}

static void late_scans_of_one_radar_update_tracks(void **state)
{
    (void)state;
    check_out_of_sequence_updates(1);
}

static void late_scans_of_two_radars_update_tracks(void **state)
{
    (void)state;
    check_out_of_sequence_updates(2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(out_of_order_scans_in_the_reorder_buffer_change_nothing),
        cmocka_unit_test(late_scans_of_one_radar_update_tracks),
        cmocka_unit_test(late_scans_of_two_radars_update_tracks),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
