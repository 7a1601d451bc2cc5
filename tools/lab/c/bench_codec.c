/* SPDX-License-Identifier: MIT */
/* bench_codec: the time to encode, decode and validate a message of the greatest length. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "base/common.h"
#include "base/random.h"
#include "base/text_table.h"
#include "bench_codec.h"
#include "pipeline/pipeline.h"
#include "rhotrack/message.h"

enum { CALLS = 20000 };

#define ENCODE_NS_MOST 1000.0

enum action { ENCODE, DECODE, VALIDATE, NUM_ACTIONS };

static const char *const action_names[NUM_ACTIONS] = {"encode", "decode", "validate"};

static double now_ns(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e9 + (double)now.tv_nsec;
}

/* ---- The longest messages ---- */

static void fill_longest_plot_scan(struct rho_message_plot_scan *scan)
{
    struct random random = random_start(1, 0, 0);

    *scan = (struct rho_message_plot_scan){.utime = 1,
                                           .kind = RHO_MESSAGE_PLOT_SCAN_POSITION_2D,
                                           .num_parts = 1,
                                           .num_plots = RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS};
    for (int i = 0; i < scan->num_plots; i++) {
        scan->plots[i] = (struct rho_message_plot){.x_m = (float)random_between(&random, -1e5, 1e5),
                                                   .y_m = (float)random_between(&random, -1e5, 1e5),
                                                   .sigma_m = 50.0f};
    }
}

static void fill_longest_track_list(struct rho_message_track_list *list)
{
    *list = (struct rho_message_track_list){.utime = 1,
                                            .num_tracks_total = RHO_MESSAGE_TRACK_LIST_MAX_TRACKS,
                                            .num_parts = 1,
                                            .num_tracks = RHO_MESSAGE_TRACK_LIST_MAX_TRACKS};
    for (int i = 0; i < list->num_tracks; i++) {
        list->tracks[i] = (struct rho_message_track){.track_id = i,
                                                     .status = RHO_MESSAGE_TRACK_CONFIRMED,
                                                     .x_m = 1234.5f + (float)i,
                                                     .vx_mps = 250.0f};
        list->tracks[i].covariance[0] = 100.0f;
    }
}

/* ---- Calls ---- */

static enum rho_status run_codec_on_plots(enum action action, uint8_t *bytes, size_t *size)
{
    static struct rho_message_plot_scan scan;

    if (scan.num_plots == 0) {
        fill_longest_plot_scan(&scan);
    }
    return action == ENCODE
               ? rho_message_plot_scan_encode(&scan, bytes, RHO_MESSAGE_PLOT_SCAN_MAX_SIZE, size)
           : action == DECODE ? rho_message_plot_scan_decode(bytes, *size, &scan)
                              : rho_message_plot_scan_validate(&scan, NULL);
}

static enum rho_status run_codec_on_tracks(enum action action, uint8_t *bytes, size_t *size)
{
    static struct rho_message_track_list list;

    if (list.num_tracks == 0) {
        fill_longest_track_list(&list);
    }
    return action == ENCODE
               ? rho_message_track_list_encode(&list, bytes, RHO_MESSAGE_TRACK_LIST_MAX_SIZE, size)
           : action == DECODE ? rho_message_track_list_decode(bytes, *size, &list)
                              : rho_message_track_list_validate(&list, NULL);
}

static const struct message {
    const char *name, *json_name;
    enum rho_status (*run)(enum action action, uint8_t *bytes, size_t *size);
} messages[] = {{"plot_scan_t, 34 plots", "plot_scan", run_codec_on_plots},
                {"track_list_t, 9 tracks", "track_list", run_codec_on_tracks}};

static double fastest_call_ns(const struct message *message, enum action action, uint8_t *bytes,
                              size_t *size)
{
    double best_ns = INFINITY;

    for (int round = 0; round < BENCH_ROUNDS; round++) {
        double start_ns = now_ns();

        for (int i = 0; i < CALLS; i++) {
            must_succeed(message->run(action, bytes, size), message->name);
        }
        best_ns = fmin(best_ns, (now_ns() - start_ns) / CALLS);
    }
    return best_ns;
}

void bench_codec(cJSON *json, struct text_table *table, struct verdicts *verdicts)
{
    static uint8_t bytes[RHO_MESSAGE_PLOT_SCAN_MAX_SIZE + RHO_MESSAGE_TRACK_LIST_MAX_SIZE];

    for (size_t i = 0; i < sizeof messages / sizeof messages[0]; i++) {
        double ns[NUM_ACTIONS];
        size_t size = 0;

        for (int action = 0; action < NUM_ACTIONS; action++) {
            ns[action] = fastest_call_ns(&messages[i], (enum action)action, bytes, &size);
            if (json) {
                char name[48];

                snprintf(name, sizeof name, "%s_%s_ns", messages[i].json_name,
                         action_names[action]);
                cJSON_AddNumberToObject(json, name, ns[action]);
            }
        }
        text_table_add_row(table, "%s|%zu|%.0f|%.0f|%.0f", messages[i].name, size, ns[ENCODE],
                           ns[DECODE], ns[VALIDATE]);
        verdicts_add_at_most(verdicts, ns[ENCODE], ENCODE_NS_MOST, "%s: ns to encode",
                             messages[i].name);
    }
}
