/* SPDX-License-Identifier: MIT */
/* node: the live tracker: LCM messages of sensors in, LCM messages of tracks out. */
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/common.h"
#include "commands.h"
#include "io/output/clutter_file.h"
#include "io/scans/scan_interval_hint.h"
#include "live/error_lines.h"
#include "live/metrics.h"
#include "live/node_core.h"
#include "live/node_log.h"
#include "live/node_print.h"
#include "live/node_sensors.h"
#include "live/node_tally.h"
#include "live/page_server.h"
#include "live/senders.h"
#include "pipeline/pipeline.h"
#include "rhotrack/message.h"
#include "transport/transport.h"

enum {
    HINT_SCANS = 1000,
    TURN_MESSAGES = 256,  /* taken before signals and clocks are looked at again */
    STATUS_US = 1000000,  /* from one RHO_STATUS to the next */
    CLUTTER_STATUSES = 5, /* statuses from one RHO_CLUTTER to the next */
    WARNING_US = 1000000, /* from one warning of a cause to the next */
    RESTARTS_SAID = 8,    /* of sensors, within that time */
    MISSING_US = 3000000, /* that a scan must be missing for before it is called lost */
    SNAPSHOT_US = 60000000,
    END_US = 350000,     /* for the outputs at the end */
    END_MOST_US = 500000 /* for the whole program, once it is told to end */
};

struct warning {
    uint64_t said;
    int64_t said_us;
    bool is_more;   /* the count exceeds the last warning, since more_us */
    uint64_t least; /* since more_us */
    int64_t more_us;
    uint64_t counted; /* when the last message was taken */
    bool has_sensor;  /* the last one that it counts was of this sensor */
    int16_t sensor_id;
};

struct node {
    struct transport *transport;
    struct node_core *core;
    struct node_print print;
    struct node_log *log;      /* NULL: none */
    struct page_server *pages; /* of metrics; NULL: none */
    const struct parameters *parameters;
    const char *snapshot_path; /* NULL: none */
    int64_t snapshot_us;       /* clock_us: when the next one is due */
    pid_t snapshot_writer;     /* 0: none is at work */
    pid_t clutter_writer;      /* likewise */
    struct warning warnings[NODE_TALLIES];
    struct node_sensors sensors;
    struct senders senders;
    struct scan_interval_hint plots; /* of the first HINT_SCANS scans */
    struct clutter_file clutter;
    int signals, hang_ups;     /* descriptors: SIGTERM and SIGINT; SIGHUP */
    bool has_terminal;         /* and ends with it */
    int64_t status_us, end_us; /* clock_us: when the next status is due; when it is over */
    int64_t finish_us;         /* clock_us: until when outputs are waited for at the end */
    unsigned statuses;         /* that were sent */
    bool knows_wall[RHO_LEARNED_REFLECTORS];
    int64_t restarts_us;      /* clock_us: of the first of the restarts below */
    unsigned restarts;        /* of sensors, within WARNING_US */
    bool is_over, is_waiting; /* waiting: nothing is left to receive */
    int exit_code;
    uint64_t taken; /* messages */
};

/* ---- Log ---- */

/* Stock readers of logs want channels that are text, which a hostile one need not be. */
static bool is_printable_channel(const char *channel)
{
    while (*channel > ' ' && *channel <= '~') {
        channel++;
    }
    return *channel == '\0';
}

static void log_message(struct node *node, int64_t time_us, const char *channel,
                        const uint8_t *data, size_t size)
{
    if (node->log && is_printable_channel(channel)) {
        node_log_put_event(node->log, time_us, channel, data, size);
    }
}

/* ---- Files that are saved ---- */

/* A file that cannot be saved does not end the tracking. */
static void note_save_result(struct node *node, bool is_saved)
{
    node->exit_code = is_saved ? node->exit_code : EXIT_RUNTIME;
}

/* True where the process that writes has ended, or there was none; *code is its exit code then. */
static bool has_writer_ended(pid_t *writer, int options, int *code)
{
    int status = 0;

    if (*writer && waitpid(*writer, &status, options) == 0) {
        return false;
    }
    *writer = 0;
    *code = WIFEXITED(status) ? WEXITSTATUS(status) : EXIT_RUNTIME;
    return true;
}

/* One that is not written does not end the tracking; the next one may be. */
static void warn_of_unwritten_snapshot(struct node *node, const char *why)
{
    fprintf(stderr, "rhotrack: %s: %s; the snapshot is not written\n", node->snapshot_path, why);
    node->exit_code = EXIT_RUNTIME;
}

static bool has_snapshot_writer_ended(struct node *node, int options)
{
    int code;
    const bool is_ended = has_writer_ended(&node->snapshot_writer, options, &code);

    if (is_ended && code) {
        warn_of_unwritten_snapshot(node, strerror(code));
    }
    return is_ended;
}

/* In a process of its own, as the copy of what is here now: messages do not wait for the disk. */
static void start_snapshot_writer(struct node *node)
{
    node->snapshot_writer = fork();
    if (node->snapshot_writer == 0) {
        _exit(node_core_save_snapshot(node->core, node->snapshot_path) ? 0 : errno);
    }
    if (node->snapshot_writer < 0) {
        node->snapshot_writer = 0;
        warn_of_unwritten_snapshot(node, strerror(errno));
    }
}

static void write_snapshot_when_due(struct node *node, int64_t now_us)
{
    if (node->snapshot_path && now_us >= node->snapshot_us &&
        has_snapshot_writer_ended(node, WNOHANG)) {
        node->snapshot_us = now_us + SNAPSHOT_US;
        start_snapshot_writer(node);
    }
}

static void write_last_snapshot(struct node *node)
{
    if (node->snapshot_path) {
        (void)has_snapshot_writer_ended(node, 0);
        if (!node_core_save_snapshot(node->core, node->snapshot_path)) {
            warn_of_unwritten_snapshot(node, strerror(errno));
        }
    }
}

static bool has_clutter_writer_ended(struct node *node, int options)
{
    int code;
    const bool is_ended = has_writer_ended(&node->clutter_writer, options, &code);

    note_save_result(node, !is_ended || code == 0);
    return is_ended;
}

/* In a process of its own, too, which says itself what goes wrong. */
static void save_clutter_when_due(struct node *node)
{
    if (clutter_file_is_due(&node->clutter) && has_clutter_writer_ended(node, WNOHANG)) {
        node->clutter.saved_us = clock_us();
        node->clutter_writer = fork();
        if (node->clutter_writer == 0) {
            _exit(clutter_file_save(&node->clutter, node_core_clutter_map(node->core))
                      ? 0
                      : EXIT_RUNTIME);
        }
        note_save_result(node, node->clutter_writer > 0);
        node->clutter_writer = node->clutter_writer > 0 ? node->clutter_writer : 0;
    }
}

static void save_last_clutter(struct node *node)
{
    (void)has_clutter_writer_ended(node, 0);
    note_save_result(node, clutter_file_save(&node->clutter, node_core_clutter_map(node->core)));
}

/* ---- Calls of the core ---- */

static void send_core_message(void *context, const char *channel, const uint8_t *data, size_t size)
{
    struct node *node = context;

    (void)transport_send(node->transport, channel, data, size); /* counted */
    if (node->log) {
        log_message(node, transport_now_us(node->transport), channel, data, size);
    }
}

/*
 * At each step, so that no change is missed however many of them come at once. Nothing is said
 * while the terminal shows a table.
 */
static void tell_of_sensor_changes(struct node *node)
{
    node_sensors_print_changes(&node->sensors, node->core, node->print.is_terminal ? NULL : stderr);
}

/* A wall that is learned, or forgotten, is told of once. */
static void tell_of_wall_changes(struct node *node)
{
    struct rho_reflector wall;

    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        const bool is_known = node_core_learned_wall(node->core, i, &wall);

        if (is_known && !node->knows_wall[i]) {
            fprintf(stderr, "rhotrack: a wall is learned: %.1f %.1f %.1f %.1f\n",
                    (double)wall.from_x_m, (double)wall.from_y_m, (double)wall.to_x_m,
                    (double)wall.to_y_m);
        } else if (!is_known && node->knows_wall[i]) {
            fputs("rhotrack: a wall that was learned shows no images any more\n", stderr);
        }
        node->knows_wall[i] = is_known;
    }
}

static void tell_of_step(void *context, const struct rho_report *report)
{
    struct node *node = context;

    node_print_note_step(&node->print, report);
    tell_of_sensor_changes(node);
    if (!node->print.is_terminal) {
        tell_of_wall_changes(node);
    }
}

/* Names sensors that begin again, but within WARNING_US no more than RESTARTS_SAID of them. */
static void on_sensor_restart(void *context, int16_t sensor_id)
{
    struct node *node = context;
    const int64_t now_us = clock_us();

    if (now_us >= node->restarts_us + WARNING_US) {
        node->restarts_us = now_us;
        node->restarts = 0;
    }
    if (!node->print.is_terminal && node->restarts++ < RESTARTS_SAID) {
        fprintf(stderr, "rhotrack: sensor %d begins again: a restart, or a record played again\n",
                sensor_id);
    }
}

static void on_new_clock(void *context)
{
    const struct node *node = context;

    if (!node->print.is_terminal) {
        fputs("rhotrack: the sensors' time is another one: tracks begin anew\n", stderr);
    }
}

/* ---- Warnings and the summary ---- */

/*
 * The count that is certain by now: of a count that may fall again its least value of the last
 * MISSING_US, as a skipped number is lost only where its scan does not come a moment later.
 */
static uint64_t certain_count(struct warning *warning, const struct node_tally *tally,
                              int64_t now_us)
{
    bool was_more = warning->is_more;

    warning->is_more = tally->count > warning->said;
    if (tally->kind != NODE_TALLY_MAY_FALL || !warning->is_more) {
        return tally->count;
    }
    if (!was_more) {
        warning->more_us = now_us;
    }
    warning->least = was_more && warning->least < tally->count ? warning->least : tally->count;
    return now_us >= warning->more_us + MISSING_US ? warning->least : warning->said;
}

static void warn_of_tally(struct warning *warning, const struct node_tally *tally, int64_t now_us)
{
    uint64_t count = certain_count(warning, tally, now_us);

    if (tally->kind != NODE_TALLY_USUAL && count > warning->said &&
        now_us >= warning->said_us + WARNING_US) {
        warning->said = count;
        warning->said_us = now_us;
        warning->is_more = false;
        fprintf(stderr, "rhotrack: %s: %" PRIu64 " so far", tally->name, count);
        if (warning->has_sensor) {
            fprintf(stderr, ", the last one of sensor %d", warning->sensor_id);
        }
        fputs("\n", stderr);
    }
}

/* After a message of this channel: the counts that rose with it are of its sensor. */
static void note_sensor_of_counts(struct node *node, const char *channel)
{
    struct node_tally tallies[NODE_TALLIES];
    int16_t sensor_id = 0;
    const bool has_sensor = senders_read_sensor_id(channel, &sensor_id);

    node_tally_all(node->core, node->transport, tallies);
    for (int i = 0; i < NODE_TALLIES; i++) {
        struct warning *warning = &node->warnings[i];

        if (tallies[i].is_of_message && tallies[i].count > warning->counted) {
            warning->has_sensor = has_sensor;
            warning->sensor_id = sensor_id;
        }
        warning->counted = tallies[i].count;
    }
}

/* Each cause at most once a second, and nothing while the terminal shows a table. */
static void warn_of_losses(struct node *node)
{
    struct node_tally tallies[NODE_TALLIES];
    int64_t now_us = clock_us();

    if (node->print.is_terminal) {
        return;
    }
    node_tally_all(node->core, node->transport, tallies);
    for (int i = 0; i < NODE_TALLIES; i++) {
        warn_of_tally(&node->warnings[i], &tallies[i], now_us);
    }
}

static void print_summary(const struct node *node)
{
    const struct rho_tracker_counters *tracker = node_core_tracker_counters(node->core);
    struct transport_counters network = transport_counters(node->transport);
    struct node_tally tallies[NODE_TALLIES];
    const uint64_t events_left_out = node_log_events_left_out(node->log);

    fprintf(stderr,
            "rhotrack: %" PRIu64 " messages in, %" PRIu64 " out; %" PRIu32 " steps, %" PRIu32
            " plots, %" PRIu32 " tracks confirmed; %.0f us a step, %.0f at most",
            node->taken, network.sent, node_core_node_counters(node->core)->steps,
            tracker->plots_in, tracker->tracks_confirmed, node_core_mean_step_us(node->core),
            node_core_max_step_us(node->core));
    node_core_print_learned(node->core, stderr);
    fprintf(stderr, "\n");
    node_tally_all(node->core, node->transport, tallies);
    for (int i = 0; i < NODE_TALLIES; i++) {
        if (tallies[i].count) {
            fprintf(stderr, "rhotrack: %s: %" PRIu64 "\n", tallies[i].name, tallies[i].count);
        }
    }
    if (node->print.left_out > 0) {
        fprintf(stderr, "rhotrack: reports not printed: %" PRIu64 "\n", node->print.left_out);
    }
    if (node_core_num_not_shown(node->core) > 0) {
        fprintf(stderr, "rhotrack: messages of --show beyond its rate: %" PRIu64 "\n",
                node_core_num_not_shown(node->core));
    }
    if (events_left_out > 0) {
        fprintf(stderr, "rhotrack: events not logged: %" PRIu64 "\n", events_left_out);
    }
    node_sensors_print_bad(node->core, stderr);
    if (error_lines_is_lossy()) {
        fputs("rhotrack: standard error was full for a while: lines of it are missing\n", stderr);
    }
}

/* ---- The loop ---- */

/* Whether the process still has the terminal that it was started from. */
static bool has_terminal(void)
{
    const int descriptor = open("/dev/tty", O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);

    if (descriptor >= 0) {
        close(descriptor);
    }
    return descriptor >= 0;
}

static int open_signal_descriptor(const sigset_t *set)
{
    const int descriptor = signalfd(-1, set, SFD_CLOEXEC | SFD_NONBLOCK);

    sigprocmask(SIG_BLOCK, set, NULL);
    if (descriptor < 0) {
        fail(EXIT_RUNTIME, "signalfd: %s", strerror(errno));
    }
    return descriptor;
}

/*
 * Signals become readable before liblcm starts threads, which inherit that. They stay blocked: what
 * an unfinished output would do about them (common.c) is not needed, for the log is written under
 * its own name.
 */
static void set_up_signals(struct node *node)
{
    sigset_t ends, hang_ups;

    sigemptyset(&ends);
    sigaddset(&ends, SIGINT);
    sigaddset(&ends, SIGTERM);
    sigemptyset(&hang_ups);
    sigaddset(&hang_ups, SIGHUP);
    node->has_terminal = !is_signal_ignored(SIGHUP) && has_terminal();
    node->signals = open_signal_descriptor(&ends);
    node->hang_ups = open_signal_descriptor(&hang_ups);
    signal(SIGPIPE, SIG_IGN); /* standard output that ends shows as a write error */
    signal(SIGXFSZ, SIG_IGN); /* and so does a log that is as long as the system allows */
}

/* SIGHUP: of an operator who has put the log away, or of the terminal that is gone. */
static void handle_hang_up(struct node *node)
{
    struct signalfd_siginfo info;

    while (read(node->hang_ups, &info, sizeof info) == (ssize_t)sizeof info) {
    }
    if (node->has_terminal && !has_terminal()) {
        kill(getpid(), SIGTERM);
    } else {
        node_log_reopen(node->log);
    }
}

/*
 * Whatever the program waits for, a disk or a network: once it is told to end it has END_MOST_US
 * left.
 */
static void *enforce_end_in_time(void *signals)
{
    const struct timespec left = {0, END_MOST_US * 1000L};
    struct pollfd here = {.fd = *(const int *)signals, .events = POLLIN};

    while (poll(&here, 1, -1) <= 0) {
    }
    nanosleep(&left, NULL);
    error_lines_write("rhotrack: an output does not end in time; it ends without it\n");
    _exit(EXIT_RUNTIME);
}

static void start_end_watchdog(int *signals)
{
    pthread_t thread;

    if (pthread_create(&thread, NULL, enforce_end_in_time, signals) == 0) {
        pthread_detach(thread);
    }
}

static int64_t least_of(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* Until a message, a signal, or whatever is due first. */
static void wait_for_work(struct node *node)
{
    struct pollfd here[4] = {{.fd = node->signals, .events = POLLIN},
                             {.fd = node->hang_ups, .events = POLLIN},
                             {.fd = page_server_descriptor(node->pages), .events = POLLIN},
                             {.fd = transport_descriptor(node->transport), .events = POLLIN}};
    int64_t due_us =
        least_of(least_of(node->status_us, node->end_us), node_print_due_us(&node->print));
    int64_t core_due_us = node_core_due_us(node->core), wait_us = due_us - clock_us();

    if (core_due_us != INT64_MAX) {
        wait_us = least_of(wait_us, core_due_us - transport_now_us(node->transport));
    }
    if (!node->is_waiting || wait_us < 0) {
        wait_us = 0;
    }
    struct timespec wait = {wait_us / 1000000, wait_us % 1000000 * 1000};
    if (ppoll(here, 4, &wait, NULL) > 0) {
        node->is_over |= here[0].revents != 0;
        if (here[1].revents) {
            handle_hang_up(node);
        }
        if (here[2].revents) {
            page_server_serve(node->pages);
        }
    }
}

static void end_after_last_message(struct node *node)
{
    if (transport_url_is_live(transport_url(node->transport))) {
        fprintf(stderr, "rhotrack: %s: the connection is gone\n", transport_url(node->transport));
        node->exit_code = EXIT_RUNTIME;
    }
    node->is_over = true;
}

/* Messages that this node, or another one, has published come back over multicast. */
static bool is_output_channel(const char *channel)
{
    return strcmp(channel, RHO_MESSAGE_TRACK_LIST_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_PEAK_LIST_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_STATUS_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_WORK_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_SENSOR_LIST_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_LEARNED_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_CLUTTER_MAP_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_GHOST_MATRIX_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_ACCUMULATOR_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_PLANE_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_HYPOTHESES_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_ZONE_LIST_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_ZONE_EVENT_LIST_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_BODY_LIST_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_SETTING_ANSWER_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_COMMAND_ANSWER_CHANNEL) == 0;
}

static void watch_scan_intervals(struct node *node, const struct transport_message *message)
{
    if (node->plots.scans < HINT_SCANS && !node->print.is_terminal) {
        scan_interval_hint_add_message(
            &node->plots, &(struct message_event){message->received_us, message->channel,
                                                  message->data, message->size});
        scan_interval_hint_report_live(&node->plots);
    }
}

/*
 * Other programs' channels are left out of the log, and what was published is there as it was sent.
 */
static void take_message(struct node *node, const struct transport_message *message)
{
    senders_note_message(&node->senders, message, clock_us(),
                         node->print.is_terminal ? NULL : stderr);
    if (is_output_channel(message->channel)) {
        return;
    }
    error_lines_set_time(message->received_us);
    node->taken++;
    watch_scan_intervals(node, message);
    if (strncmp(message->channel, "RHO_", 4) == 0) {
        log_message(node, message->received_us, message->channel, message->data, message->size);
    }
    node_core_take_message(node->core, message->channel, message->data, message->size,
                           message->received_us);
    note_sensor_of_counts(node, message->channel);
}

static void take_messages(struct node *node)
{
    struct transport_message message;
    enum transport_found found = TRANSPORT_MESSAGE;

    for (int i = 0; i < TURN_MESSAGES && found == TRANSPORT_MESSAGE; i++) {
        if (is_end_signal_pending()) {
            return;
        }
        found = transport_receive(node->transport, &message);
        if (found == TRANSPORT_MESSAGE) {
            take_message(node, &message);
        }
    }
    node->is_waiting = found == TRANSPORT_NOTHING;
    if (found == TRANSPORT_NOTHING) {
        node_core_tick(node->core, transport_now_us(node->transport));
    } else if (found == TRANSPORT_END) {
        end_after_last_message(node);
    }
}

static struct node_core_losses node_losses(const struct node *node)
{
    const struct transport_counters network = transport_counters(node->transport);

    return (struct node_core_losses){.datagrams_refused = network.refused + network.refused_source,
                                     .reports_not_printed = node->print.left_out,
                                     .events_not_logged = node_log_events_left_out(node->log)};
}

static void write_metrics(FILE *out, void *context)
{
    const struct node *node = context;
    const struct metrics_source source = {
        .core = node->core,
        .transport = node->transport,
        .parameters = node->parameters,
        .messages_in = node->taken,
        .losses = node_losses(node),
        .pages_sent = page_server_num_sent(node->pages),
        .clients_refused = page_server_num_refused(node->pages),
    };

    metrics_write(out, &source);
}

static void send_status(struct node *node)
{
    const struct node_core_losses losses = node_losses(node);

    node_core_send_status(node->core, &losses);
    if (node->statuses++ % CLUTTER_STATUSES == 0) {
        node_core_send_clutter(node->core);
    }
}

static void show_tracks(struct node *node, bool is_end)
{
    if (!node_print_show(&node->print, node->core, transport_url(node->transport), is_end)) {
        if (errno != EPIPE) {
            fprintf(stderr, "rhotrack: standard output: %s\n", strerror(errno));
            node->exit_code = EXIT_RUNTIME;
        }
        node->print.is_on = node->print.is_changed = false;
        node->is_over = true; /* whoever read it has gone */
    }
}

static void do_what_is_due(struct node *node)
{
    int64_t now_us = clock_us();

    if (now_us >= node->status_us) {
        node->status_us += STATUS_US;
        if (node->status_us <= now_us) { /* the program was stopped for a while */
            node->status_us = now_us + STATUS_US;
        }
        send_status(node);
        page_server_serve(node->pages); /* who was too slow goes */
    }
    write_snapshot_when_due(node, now_us);
    node->is_over = node->is_over || now_us >= node->end_us;
    show_tracks(node, false);
    warn_of_losses(node);
    tell_of_sensor_changes(node);
    note_save_result(node, node_log_report_errors(node->log));
    save_clutter_when_due(node);
}

static void run_node(struct node *node)
{
    while (!node->is_over) {
        do_what_is_due(node);
        wait_for_work(node);
        take_messages(node);
    }
    node->finish_us = clock_us() + END_US;
    node_core_flush(node->core);
    node->statuses = 0;
    send_status(node);
    show_tracks(node, true);
}

/* Outputs that take nothing are waited for END_US at most, all together. */
static void finish_outputs(struct node *node)
{
    node_print_finish(&node->print, node->finish_us);
    node_log_finish_queue(node->log, node->finish_us);
    note_save_result(node, node_log_report_errors(node->log));
    print_summary(node);
    write_last_snapshot(node);
    save_last_clutter(node);
}

static struct node_log_limits log_limits(const struct parameters *parameters)
{
    const double *value = parameters->value;

    return (struct node_log_limits){.bytes_max =
                                        (uint64_t)llround(value[PARAMETER_LOG_FILE_MB] * 1e6),
                                    .period_us = llround(value[PARAMETER_LOG_FILE_S] * 1e6),
                                    .files_max = (unsigned)value[PARAMETER_LOG_FILES]};
}

int command_node(struct command_line *line)
{
    struct node node = {
        .status_us = clock_us(), .end_us = INT64_MAX, .parameters = &line->parameters};
    const struct node_core_events events = {&node, send_core_message, tell_of_step,
                                            on_sensor_restart, on_new_clock};
    const bool is_live = transport_url_is_live(line->lcm);
    const struct node_log_limits limits = log_limits(&line->parameters);
    bool is_restored = false; /* the map of clutter, too */
    int exit_code;

    if (line->log && transport_url_is_file(line->lcm, line->log)) {
        fail(EXIT_USAGE, "node: %s would be written over what is read", line->log);
    }
    pipeline_set_options(&line->parameters,
                         &(struct pipeline_options){line->gate, line->method, line->pipeline});
    clutter_file_refuse_same_file(line->clutter_map, line->log, "log");
    if (line->clutter_map && transport_url_is_file(line->lcm, line->clutter_map)) {
        fail(EXIT_USAGE, "%s: the input cannot be the clutter map", line->clutter_map);
    }
    struct pipeline_show *show = pipeline_show_open(line->show, &line->parameters);
    node.core = node_core_open(&line->parameters, (int32_t)(time(NULL) & INT32_MAX), &events);
    error_lines_open(&line->parameters, is_live);
    node_core_set_show(node.core, show);
    if (line->commands) {
        node_core_allow_commands(node.core);
    }
    node.snapshot_path = line->snapshot;
    node.snapshot_us = node.status_us + SNAPSHOT_US;
    if (line->snapshot &&
        node_core_restore_snapshot(node.core, line->snapshot) == PIPELINE_RESTORED) {
        fprintf(stderr, "rhotrack: %s: tracks go on\n", line->snapshot);
        is_restored = true;
    }
    node.clutter = clutter_file_open(line->clutter_map, &line->parameters,
                                     is_restored ? NULL : node_core_clutter_map(node.core));
    set_up_signals(&node);
    start_end_watchdog(&node.signals);
    node.transport = transport_open(line->lcm, TRANSPORT_SEND_AND_RECEIVE);
    node.pages = page_server_open(line->metrics, "/metrics",
                                  "text/plain; version=0.0.4; charset=utf-8", write_metrics, &node);
    node.log = node_log_open(line->log, is_live, &limits);
    node.print = node_print_start(line->print, is_live);
    if (line->seconds > 0) {
        node.end_us = node.status_us + llround(line->seconds * 1e6);
    }
    run_node(&node);
    finish_outputs(&node);
    exit_code = node.exit_code;
    page_server_close(node.pages);
    transport_close(node.transport);
    node_core_close(node.core);
    node_log_close(node.log);
    scan_interval_hint_free(&node.plots);
    close(node.signals);
    close(node.hang_ups);
    return exit_code;
}
