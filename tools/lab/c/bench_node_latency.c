/* SPDX-License-Identifier: MIT */
/*
 * bench_node_latency: the time from a scan's last datagram to its tracks, over UDP multicast on
 * this machine. The node runs in a process of its own, as in use; this program is the sensor and
 * the viewer.
 */
#include "bench_codec.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/common.h"
#include "base/random.h"
#include "commands.h"
#include "pipeline/pipeline.h"
#include "rhotrack/message.h"
#include "rhotrack/udpm.h"
#include "scenario_simulation.h"
#include "transport/transport.h"

/*
 * Sends 50 scans a second of 100 plots each, in three parts. By their time stamps scans are 10 s
 * apart, as those of `bench track`, so that the tracker has the work of a surveillance radar:
 * targets move from scan to scan, and clutter lies elsewhere in each.
 */
enum { SCANS = 550, WARM_UP = 50, SCANS_PER_S = 50, PLOTS = 100, TARGETS = 8, PARTS = 3 };
enum { PERIOD_NS = 1000000000 / SCANS_PER_S, READY_NS = 2000000000, NS_PER_US = 1000 };

#define INTERVAL_US INT64_C(10000000)
#define HALF_AREA_M 250e3
#define SIGMA_M 50.0
#define MEDIAN_US_MOST 1000.0
#define P99_US_MOST 5000.0

struct session {
    struct transport *transport;
    struct random random;
    int64_t sent_ns[SCANS], done_ns[SCANS]; /* CLOCK_MONOTONIC; done 0: no tracks came */
    int tracks;                             /* number in the last track list */
    bool is_ready;
};

static int64_t now_ns(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

/* ---- The scene ---- */

/* The first plots are targets on parallel lines through the area; the others uniform clutter. */
static struct rho_message_plot draw_target_or_clutter_plot(struct session *session, int scan,
                                                           int index)
{
    double x_m = random_between(&session->random, -HALF_AREA_M, HALF_AREA_M);
    double y_m = random_between(&session->random, -HALF_AREA_M, HALF_AREA_M);

    if (index < TARGETS) {
        double along_m = -HALF_AREA_M + 2 * HALF_AREA_M * (scan + 0.5) / SCANS;

        x_m = along_m + SIGMA_M * random_normal(&session->random);
        y_m = (index - 0.5 * TARGETS) * 40e3 + SIGMA_M * random_normal(&session->random);
    }
    return (struct rho_message_plot){
        .x_m = (float)x_m, .y_m = (float)y_m, .sigma_m = (float)SIGMA_M};
}

static void send_scan_part(struct session *session, int scan, int part)
{
    static struct rho_message_plot_scan message;
    uint8_t bytes[RHO_MESSAGE_PLOT_SCAN_MAX_SIZE];
    int first = part * RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS;
    int left = PLOTS - first;
    size_t size;

    message = (struct rho_message_plot_scan){.utime = scan * INTERVAL_US,
                                             .scan = scan,
                                             .epoch = 1,
                                             .sensor_id = 1,
                                             .kind = RHO_MESSAGE_PLOT_SCAN_POSITION_2D,
                                             .part = (int16_t)part,
                                             .num_parts = PARTS};
    message.num_plots =
        (int16_t)(left < RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS ? left : RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS);
    for (int i = 0; i < message.num_plots; i++) {
        message.plots[i] = draw_target_or_clutter_plot(session, scan, first + i);
    }
    must_succeed(rho_message_plot_scan_encode(&message, bytes, sizeof bytes, &size), "plots");
    session->sent_ns[scan] = now_ns(); /* the time of the last part remains */
    if (!transport_send(session->transport, RHO_MESSAGE_PLOT_SCAN_CHANNEL "1", bytes, size)) {
        fail(EXIT_RUNTIME, "%s: %s", transport_url(session->transport), strerror(errno));
    }
}

/* ---- The node ---- */

/* Sets the defaults, then the values of the scene, as a user of the node would set them. */
static void set_parameters_of_scene(struct parameters *parameters)
{
    parameters_set_defaults(parameters);
    scenario_suggest_parameters("traffic", parameters);
    parameters_suggest(parameters, PARAMETER_SIGMA_M, SIGMA_M);
}

/* Runs a silent node in this process until its time limit, unless the parent has ended. */
static _Noreturn void run_node(const char *url, pid_t parent)
{
    static struct command_line line;
    int nowhere = open("/dev/null", O_WRONLY);

    if (nowhere >= 0) {
        dup2(nowhere, STDERR_FILENO);
        dup2(nowhere, STDOUT_FILENO);
    }
    line = (struct command_line){.lcm = url, .seconds = READY_NS / 1e9 + 3.0 * SCANS / SCANS_PER_S};
    set_parameters_of_scene(&line.parameters);
    _exit(getppid() == parent ? command_node(&line) : EXIT_RUNTIME);
}

static void find_free_udp_url(char *url, size_t bytes)
{
    struct sockaddr_in address = {.sin_family = AF_INET};
    socklen_t size = sizeof address;
    int descriptor = socket(AF_INET, SOCK_DGRAM, 0);

    if (descriptor < 0 || bind(descriptor, (struct sockaddr *)&address, size) ||
        getsockname(descriptor, (struct sockaddr *)&address, &size)) {
        fail(EXIT_RUNTIME, "no free port: %s", strerror(errno));
    }
    close(descriptor);
    snprintf(url, bytes, "udpm://" RHO_UDPM_GROUP ":%u?ttl=0", (unsigned)ntohs(address.sin_port));
}

/* ---- The viewer ---- */

static void note_time_of_tracks(struct session *session, const struct transport_message *message)
{
    static struct rho_message_track_list list;
    int64_t scan;

    if (rho_message_track_list_decode(message->data, message->size, &list) != RHO_OK) {
        return;
    }
    scan = list.utime / INTERVAL_US;
    if (scan >= 0 && scan < SCANS && list.part == list.num_parts - 1) {
        session->done_ns[scan] = now_ns();
        session->tracks = list.num_tracks_total;
    }
}

static void listen_until(struct session *session, int64_t end_ns)
{
    struct pollfd here = {.fd = transport_descriptor(session->transport), .events = POLLIN};
    struct transport_message message;

    for (int64_t left_ns = end_ns - now_ns(); left_ns > 0; left_ns = end_ns - now_ns()) {
        struct timespec wait = {left_ns / 1000000000, left_ns % 1000000000};

        if (ppoll(&here, 1, &wait, NULL) <= 0) {
            continue;
        }
        while (transport_receive(session->transport, &message) == TRANSPORT_MESSAGE) {
            if (strcmp(message.channel, RHO_MESSAGE_TRACK_LIST_CHANNEL) == 0) {
                note_time_of_tracks(session, &message);
            } else if (strcmp(message.channel, RHO_MESSAGE_STATUS_CHANNEL) == 0) {
                session->is_ready = true;
            }
        }
    }
}

static void send_scans_at_rate(struct session *session)
{
    int64_t start_ns = now_ns(), give_up_ns = start_ns + READY_NS;

    while (!session->is_ready && start_ns < give_up_ns) {
        listen_until(session, start_ns + 1000000);
        start_ns = now_ns();
    }
    for (int scan = 0; scan < SCANS; scan++) {
        for (int part = 0; part < PARTS; part++) {
            send_scan_part(session, scan, part);
        }
        listen_until(session, start_ns + (int64_t)(scan + 1) * PERIOD_NS);
    }
    listen_until(session, now_ns() + READY_NS / 4);
}

static void fork_node_and_run_session(struct session *session)
{
    char url[64];
    pid_t parent = getpid(), child;

    find_free_udp_url(url, sizeof url);
    fflush(stdout);
    child = fork();
    if (child < 0) {
        fail(EXIT_RUNTIME, "fork: %s", strerror(errno));
    }
    if (child == 0) {
        run_node(url, parent);
    }
    session->transport = transport_open(url, TRANSPORT_SEND_AND_RECEIVE);
    send_scans_at_rate(session);
    transport_close(session->transport);
    kill(child, SIGTERM);
    waitpid(child, NULL, 0);
}

/* ---- The figures ---- */

struct latency {
    double median_us, p99_us, max_us;
    int lost, counted;
};

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static struct latency latency_statistics(const struct session *session)
{
    static double us[SCANS];
    struct latency latency = {NAN, NAN, NAN, 0, 0};

    for (int scan = WARM_UP; scan < SCANS; scan++) {
        if (session->done_ns[scan]) {
            us[latency.counted++] =
                (double)(session->done_ns[scan] - session->sent_ns[scan]) / NS_PER_US;
        } else {
            latency.lost++;
        }
    }
    if (latency.counted > 0) {
        qsort(us, (size_t)latency.counted, sizeof us[0], compare_numbers);
        latency.median_us = us[latency.counted / 2];
        latency.p99_us = us[latency.counted * 99 / 100];
        latency.max_us = us[latency.counted - 1];
    }
    return latency;
}

static void add_latency_json(cJSON *json, const struct latency *latency)
{
    json_add_number_or_null(json, "latency_median_us", latency->median_us);
    json_add_number_or_null(json, "latency_p99_us", latency->p99_us);
    json_add_number_or_null(json, "latency_max_us", latency->max_us);
    cJSON_AddNumberToObject(json, "scans", latency->counted);
    cJSON_AddNumberToObject(json, "scans_lost", latency->lost);
}

static void print_latency(const struct session *session, const struct latency *latency)
{
    struct text_table table = text_table_start(0, "scans|lost|median us|99 % us|max us|tracks");

    printf(
        "node: from a scan's last datagram to its tracks, UDP multicast on this machine; %d scans "
        "a second\nof %d plots in %d parts, %d targets, 500 x 500 km, 10 s from scan to scan by "
        "their own clock\n",
        SCANS_PER_S, PLOTS, PARTS, TARGETS);
    text_table_add_row(&table, "%d|%d|%.0f|%.0f|%.0f|%d", latency->counted, latency->lost,
                       latency->median_us, latency->p99_us, latency->max_us, session->tracks);
    text_table_print(&table, stdout);
    printf("\n");
    text_table_free(&table);
}

void bench_node(const struct bench *bench)
{
    static struct session session;
    cJSON *json = bench->json ? cJSON_AddObjectToObject(bench->json, "node") : NULL;
    struct verdicts verdicts = verdicts_start();
    struct text_table table = text_table_start(1, "message|bytes|encode ns|decode ns|validate ns");
    struct latency latency;

    session.random = random_start(bench->seed, 0, 0);
    fork_node_and_run_session(&session);
    latency = latency_statistics(&session);
    verdicts_add_at_most(&verdicts, latency.median_us, MEDIAN_US_MOST, "latency: us, median");
    verdicts_add_at_most(&verdicts, latency.p99_us, P99_US_MOST, "latency: us, 99 %%");
    verdicts_add_at_most(&verdicts, latency.lost, 0, "scans without tracks");
    bench_codec(json, &table, &verdicts);
    if (json) {
        add_latency_json(json, &latency);
        verdicts_move_to_json(&verdicts, json);
    } else {
        print_latency(&session, &latency);
        text_table_print(&table, stdout);
        printf("\n");
        verdicts_print(&verdicts, stdout);
        printf("\n");
    }
    verdicts_free(&verdicts);
    text_table_free(&table);
}
