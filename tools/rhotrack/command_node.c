/* SPDX-License-Identifier: MIT */
/* node: the live tracker: receives sensors' LCM messages, and publishes tracks as LCM messages. */
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/signalfd.h>
#include <time.h>
#include <unistd.h>

#include "base/common.h"
#include "base/state_file.h"
#include "commands.h"
#include "io/output/clutter_map_file.h"
#include "io/scans/scan_interval_hint.h"
#include "live/command_gate.h"
#include "live/duplicate_senders.h"
#include "live/metrics_page_server.h"
#include "live/node_core.h"
#include "live/node_log_writer.h"
#include "live/node_loss_counts.h"
#include "live/node_print_tracks.h"
#include "live/node_sensor_warnings.h"
#include "live/prometheus_metrics.h"
#include "live/service_notify.h"
#include "live/standby.h"
#include "live/state_saver.h"
#include "live/stderr_time_stamps.h"
#include "pipeline/pipeline.h"
#include "rhotrack/message.h"
#include "transport/transport.h"

enum {
    HINT_SCANS = 1000,
    TURN_MESSAGES = 256,  /* most messages taken in a row before signals and timers are checked */
    STATUS_US = 1000000,  /* interval of RHO_STATUS messages */
    CLUTTER_STATUSES = 5, /* one RHO_CLUTTER message for this many RHO_STATUS messages */
    WARNING_US = 1000000, /* shortest interval between warnings of the same cause */
    RESTARTS_SAID = 8,    /* most sensor restarts reported within WARNING_US */
    MISSING_US = 3000000, /* a missing scan counts as lost after this long */
    END_US = 350000,      /* longest wait for outputs (print, log) at the end */
    END_MOST_US = 500000, /* longest time from the signal to end until the process exits */
    SAVES_MOST = 20       /* so often as long again, while state files are written */
};

/* No message for so long after the start is told: longer than most radars' turns. */
enum { NOTHING_US = 12000000 };

struct warning {
    uint64_t said;
    int64_t said_us;
    bool is_more;   /* since more_us the count exceeds the count of the last warning */
    uint64_t least; /* smallest count since more_us */
    int64_t more_us;
    uint64_t counted; /* count when the last message was taken */
    bool has_sensor;  /* the event counted last came from the sensor sensor_id */
    int16_t sensor_id;
};

struct node {
    struct transport *transport;
    struct node_core *core;
    struct node_print print;
    struct node_log *log;      /* NULL: no log is written */
    struct page_server *pages; /* serves the metrics page; NULL: no metrics */
    const struct parameters *parameters;
    struct state_saver snapshot, clutter_map;
    struct warning warnings[NODE_TALLIES];
    struct node_sensors sensors;
    struct duplicate_senders senders;
    struct command_gate gate;
    struct service service;
    struct standby standby;
    uint32_t listed_steps;           /* counter of steps at the last list of tracks that was sent */
    int64_t start_us;                /* monotonic time of the start */
    bool is_silence_told;            /* a line says that no message was heard since the start */
    struct scan_interval_hint plots; /* scan intervals of the first HINT_SCANS scans */
    /* signal descriptors: `signals` of SIGTERM and SIGINT, `hang_ups` of SIGHUP */
    int signals, hang_ups;
    atomic_bool is_saving;     /* at the end: state files are written */
    bool has_terminal;         /* the node was started from a terminal, and ends with it */
    int64_t status_us, end_us; /* monotonic times: next status; end of --for */
    int64_t finish_us;         /* monotonic time until which outputs are waited for at the end */
    unsigned statuses;         /* status messages sent so far */
    bool knows_wall[RHO_LEARNED_REFLECTORS];
    int64_t restarts_us;      /* monotonic time of the first restart counted in `restarts` */
    unsigned restarts;        /* sensor restarts within WARNING_US from restarts_us on */
    bool is_over, is_waiting; /* is_waiting: no message is left to receive */
    int exit_code;
    uint64_t taken; /* messages taken so far */
};

/* ---- Log ---- */

/*
 * True for printable ASCII: common readers of LCM logs fail on other channel names, which a hostile
 * sender can use.
 */
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

/* Makes the exit code a failure where events could not be written; tracking goes on. */
static void report_and_retry_log(struct node *node)
{
    if (!node_log_report_and_retry(node->log)) {
        node->exit_code = EXIT_RUNTIME;
    }
}

/* ---- Files that are saved ---- */

static bool save_snapshot(void *context, const char *path)
{
    return node_core_save_snapshot(context, path);
}

static bool save_clutter_map(void *context, const char *path)
{
    return clutter_map_file_write(path, node_core_clutter_map(context));
}

/* Exit 2 where a file that is written would take the place of another one. */
static void check_state_files(const struct command_line *line)
{
    const char *const paths[] = {line->snapshot, line->clutter_map};
    const char *const what[] = {"snapshot", "clutter map"};

    state_file_refuse_same(paths[0], what[0], paths[1], what[1]);
    for (int i = 0; i < 2; i++) {
        state_file_refuse_same(paths[i], what[i], line->log, "log");
        if (paths[i] && transport_url_is_same_file(line->lcm, paths[i])) {
            fail(EXIT_USAGE, "%s: the input cannot be the %s", paths[i], what[i]);
        }
        for (size_t k = 0; k + 1 < line->num_settings; k += 2) {
            if (strcmp(line->settings[k], "--config") == 0) {
                state_file_refuse_same(paths[i], what[i], line->settings[k + 1], "config");
            }
        }
    }
}

/*
 * Reads the state files and goes on with what they hold. A damaged one is set aside, so that a
 * service runs on; where even that fails it is not written.
 */
static void restore_state(struct node *node, const struct command_line *line)
{
    enum pipeline_restored restored = PIPELINE_NO_FILE;

    node->snapshot = (struct state_saver){
        .path = line->snapshot, .what = "snapshot", .save = save_snapshot, .context = node->core};
    node->clutter_map = (struct state_saver){.path = line->clutter_map,
                                             .what = "clutter map",
                                             .save = save_clutter_map,
                                             .context = node->core};
    if (line->snapshot) {
        restored = node_core_restore_snapshot(node->core, line->snapshot);
    }
    if (restored == PIPELINE_RESTORED) {
        fprintf(stderr, "rhotrack: %s: tracks continue from the snapshot\n", line->snapshot);
    } else if (restored == PIPELINE_STUCK) {
        node->snapshot.path = NULL;
        node->exit_code = EXIT_RUNTIME;
    }
    if (line->clutter_map && /* the snapshot has the map, too */
        !clutter_map_file_restore(
            line->clutter_map, &line->parameters,
            restored == PIPELINE_RESTORED ? NULL : node_core_clutter_map(node->core))) {
        node->clutter_map.path = NULL;
        node->exit_code = EXIT_RUNTIME;
    }
    state_saver_start(&node->snapshot, node->status_us);
    state_saver_start(&node->clutter_map, node->status_us);
}

static void save_state_at_end(struct node *node)
{
    atomic_store(&node->is_saving, true);
    const bool is_snapshot_saved = state_saver_save_at_end(&node->snapshot);

    if (!state_saver_save_at_end(&node->clutter_map) || !is_snapshot_saved) {
        node->exit_code = EXIT_RUNTIME;
    }
    atomic_store(&node->is_saving, false);
}

/* ---- Calls of the core ---- */

static void send_and_log_message(void *context, const char *channel, const uint8_t *data,
                                 size_t size)
{
    struct node *node = context;

    command_gate_note_answer(&node->gate, channel, data, size,
                             node->print.is_terminal ? NULL : stderr);
    if (!standby_may_send(&node->standby, monotonic_clock_us())) {
        return;
    }
    if (strcmp(channel, RHO_MESSAGE_TRACK_LIST_CHANNEL) == 0) {
        node->listed_steps = node_core_node_counters(node->core)->steps;
    }
    /* failures are counted by the transport */
    (void)transport_send(node->transport, channel, data, size);
    if (node->log) {
        log_message(node, transport_now_us(node->transport), channel, data, size);
    }
}

/*
 * Prints sensors that became suspect, silent or sound again. Called at each step, so that no change
 * is missed; prints nothing while the terminal shows a table.
 */
static void print_sensor_changes(struct node *node)
{
    node_sensors_print_changes(&node->sensors, node->core, node->print.is_terminal ? NULL : stderr);
}

/* Prints each wall (reflector) once when it is learned, and once when it is forgotten. */
static void print_wall_changes(struct node *node)
{
    struct rho_reflector wall;

    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        const bool is_known = node_core_get_learned_wall(node->core, i, &wall);

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

static void print_step_changes(void *context, const struct rho_report *report)
{
    struct node *node = context;

    node_print_rows(&node->print, report);
    print_sensor_changes(node);
    if (!node->print.is_terminal) {
        print_wall_changes(node);
    }
}

/* Reports a sensor's restart; at most RESTARTS_SAID restarts within WARNING_US are printed. */
static void print_sensor_restart(void *context, int16_t sensor_id)
{
    struct node *node = context;
    const int64_t now_us = monotonic_clock_us();

    if (now_us >= node->restarts_us + WARNING_US) {
        node->restarts_us = now_us;
        node->restarts = 0;
    }
    if (!node->print.is_terminal && node->restarts++ < RESTARTS_SAID) {
        fprintf(stderr,
                "rhotrack: sensor %d starts again: a restart, or a recording played again\n",
                sensor_id);
    }
}

static void print_clock_change(void *context)
{
    const struct node *node = context;

    if (!node->print.is_terminal) {
        fputs("rhotrack: the sensors' clock was set anew: tracks begin anew\n", stderr);
    }
}

/* ---- Warnings and the summary ---- */

/*
 * The count of losses that is certain by now. A count that may fall again gives its least value of
 * the last MISSING_US: a skipped scan number is lost only if its scan does not arrive later.
 */
static uint64_t certain_loss_count(struct warning *warning, const struct node_loss_counts *tally,
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

static void warn_when_tally_rose(struct warning *warning, const struct node_loss_counts *tally,
                                 int64_t now_us)
{
    uint64_t count = certain_loss_count(warning, tally, now_us);

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

/* Attributes the counts that rose with the last message to the sensor of its channel. */
static void attribute_losses_to_sensor(struct node *node, const char *channel)
{
    struct node_loss_counts tallies[NODE_TALLIES];
    int16_t sensor_id = 0;
    const bool has_sensor = duplicate_senders_sensor_id(channel, &sensor_id);

    node_loss_counts_collect(node->core, node->transport, &node->gate, tallies);
    for (int i = 0; i < NODE_TALLIES; i++) {
        struct warning *warning = &node->warnings[i];

        if (tallies[i].is_of_message && tallies[i].count > warning->counted) {
            warning->has_sensor = has_sensor;
            warning->sensor_id = sensor_id;
        }
        warning->counted = tallies[i].count;
    }
}

/* Warns of each cause at most once a second; prints nothing while the terminal shows a table. */
static void warn_of_losses(struct node *node)
{
    struct node_loss_counts tallies[NODE_TALLIES];
    int64_t now_us = monotonic_clock_us();

    if (node->print.is_terminal) {
        return;
    }
    node_loss_counts_collect(node->core, node->transport, &node->gate, tallies);
    for (int i = 0; i < NODE_TALLIES; i++) {
        warn_when_tally_rose(&node->warnings[i], &tallies[i], now_us);
    }
}

/* Says that nothing has been heard since the start, and when that ends. */
static void warn_of_silence(struct node *node, int64_t now_us)
{
    const char *url = transport_url(node->transport), *place = transport_place(node->transport);
    const bool is_silent = node->taken == 0 && now_us >= node->start_us + NOTHING_US;
    const double since_s = (double)(now_us - node->start_us) / 1e6;

    if (is_silent == node->is_silence_told || !transport_url_is_live(url) ||
        node->print.is_terminal) {
        return;
    }
    node->is_silence_told = is_silent;
    if (is_silent) {
        fprintf(stderr, "rhotrack: no message was heard in the %.0f s since the start; %s\n",
                since_s, *place ? place : url);
    } else {
        fprintf(stderr, "rhotrack: the first message is heard, %.0f s after the start\n", since_s);
    }
}

static void print_summary(const struct node *node)
{
    const struct rho_tracker_counters *tracker = node_core_tracker_counters(node->core);
    struct transport_counters network = transport_counters(node->transport);
    struct node_loss_counts tallies[NODE_TALLIES];
    const uint64_t events_left_out = node_log_events_left_out(node->log);

    fprintf(stderr,
            "rhotrack: %" PRIu64 " messages in, %" PRIu64 " out; %" PRIu32 " steps, %" PRIu32
            " plots, %" PRIu32 " tracks confirmed; %.0f us a step, %.0f at most",
            node->taken, network.sent, node_core_node_counters(node->core)->steps,
            tracker->plots_in, tracker->tracks_confirmed, node_core_mean_step_us(node->core),
            node_core_max_step_us(node->core));
    node_core_print_learned(node->core, stderr);
    fprintf(stderr, "\n");
    node_loss_counts_collect(node->core, node->transport, &node->gate, tallies);
    for (int i = 0; i < NODE_TALLIES; i++) {
        if (tallies[i].count) {
            fprintf(stderr, "rhotrack: %s: %" PRIu64 "\n", tallies[i].name, tallies[i].count);
        }
    }
    if (node->print.left_out > 0) {
        fprintf(stderr, "rhotrack: reports not printed: %" PRIu64 "\n", node->print.left_out);
    }
    if (node_core_num_show_left_out(node->core) > 0) {
        fprintf(stderr, "rhotrack: messages of --show beyond its rate: %" PRIu64 "\n",
                node_core_num_show_left_out(node->core));
    }
    if (events_left_out > 0) {
        fprintf(stderr, "rhotrack: events not logged: %" PRIu64 "\n", events_left_out);
    }
    node_sensors_print_all(node->core, stderr);
    if (error_lines_were_lost()) {
        fputs("rhotrack: standard error was blocked for a while: lines are missing\n", stderr);
    }
}

/* ---- The loop ---- */

/* True where the process still has its controlling terminal. */
static bool has_controlling_terminal(void)
{
    const int descriptor = open("/dev/tty", O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);

    if (descriptor >= 0) {
        close(descriptor);
    }
    return descriptor >= 0;
}

static int block_signals_to_descriptor(const sigset_t *set)
{
    const int descriptor = signalfd(-1, set, SFD_CLOEXEC | SFD_NONBLOCK);

    sigprocmask(SIG_BLOCK, set, NULL);
    if (descriptor < 0) {
        fail(EXIT_RUNTIME, "signalfd: %s", strerror(errno));
    }
    return descriptor;
}

/*
 * Makes signals readable as descriptors, before liblcm starts threads, which inherit the mask. The
 * signals stay blocked: the handler that removes unfinished outputs (common.c) is not needed, as
 * the log is written under its own name.
 */
static void open_signal_descriptors(struct node *node)
{
    sigset_t ends, hang_ups;

    sigemptyset(&ends);
    sigaddset(&ends, SIGINT);
    sigaddset(&ends, SIGTERM);
    sigemptyset(&hang_ups);
    sigaddset(&hang_ups, SIGHUP);
    node->has_terminal = !is_signal_ignored(SIGHUP) && has_controlling_terminal();
    node->signals = block_signals_to_descriptor(&ends);
    node->hang_ups = block_signals_to_descriptor(&hang_ups);
    signal(SIGPIPE, SIG_IGN); /* a closed standard output shows as a write error */
    signal(SIGXFSZ, SIG_IGN); /* a log at the file size limit shows as a write error */
}

/*
 * SIGHUP: a log rotation asks to reopen the log, or the terminal was closed, which ends the node.
 */
static void handle_hangup(struct node *node)
{
    struct signalfd_siginfo info;

    while (read(node->hang_ups, &info, sizeof info) == (ssize_t)sizeof info) {
    }
    if (node->has_terminal && !has_controlling_terminal()) {
        kill(getpid(), SIGTERM);
    } else {
        node_log_reopen(node->log);
    }
}

/*
 * Thread that exits the process END_MOST_US after the signal to end, or later while state files
 * are written, even where the main thread is blocked by a disk or a network.
 */
static void *exit_when_end_takes_too_long(void *context)
{
    const struct timespec left = {0, END_MOST_US * 1000L};
    struct node *node = context;
    struct pollfd here = {.fd = node->signals, .events = POLLIN};

    while (poll(&here, 1, -1) <= 0) {
    }
    nanosleep(&left, NULL);
    for (int i = 0; i < SAVES_MOST && atomic_load(&node->is_saving); i++) {
        nanosleep(&left, NULL);
    }
    error_lines_write_directly("rhotrack: an output does not end in time; it ends without it\n");
    _exit(EXIT_RUNTIME);
}

static void start_end_watchdog(struct node *node)
{
    pthread_t thread;

    if (pthread_create(&thread, NULL, exit_when_end_takes_too_long, node) == 0) {
        pthread_detach(thread);
    }
}

static int64_t earlier_us(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/*
 * Waits for a message, a signal, a metrics client, or the next timer; serves signals and clients.
 */
static void wait_and_serve_descriptors(struct node *node)
{
    struct pollfd here[4] = {{.fd = node->signals, .events = POLLIN},
                             {.fd = node->hang_ups, .events = POLLIN},
                             {.fd = page_server_poll_descriptor(node->pages), .events = POLLIN},
                             {.fd = transport_descriptor(node->transport), .events = POLLIN}};
    int64_t due_us = earlier_us(earlier_us(node->status_us, node->end_us),
                                earlier_us(node_print_due_us(&node->print), node->service.due_us));
    due_us = earlier_us(due_us, standby_due_us(&node->standby));
    int64_t core_due_us = node_core_due_us(node->core), wait_us = due_us - monotonic_clock_us();

    if (core_due_us != INT64_MAX) {
        wait_us = earlier_us(wait_us, core_due_us - transport_now_us(node->transport));
    }
    if (!node->is_waiting || wait_us < 0) {
        wait_us = 0;
    }
    struct timespec wait = {wait_us / 1000000, wait_us % 1000000 * 1000};
    if (ppoll(here, 4, &wait, NULL) > 0) {
        node->is_over |= here[0].revents != 0;
        if (here[1].revents) {
            handle_hangup(node);
        }
        if (here[2].revents) {
            page_server_serve(node->pages);
        }
    }
}

static void end_node_at_end_of_input(struct node *node)
{
    if (transport_url_is_live(transport_url(node->transport))) {
        fprintf(stderr, "rhotrack: %s: the connection is lost\n", transport_url(node->transport));
        node->exit_code = EXIT_RUNTIME;
    }
    node->is_over = true;
}

/* True for channels that nodes publish on: multicast delivers a node's own messages back to it. */
static bool is_output_channel(const char *channel)
{
    return strcmp(channel, RHO_MESSAGE_TRACK_LIST_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_PEAK_LIST_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_STATUS_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_WORK_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_SENSOR_LIST_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_LEARNED_CHANNEL) == 0 ||
           strcmp(channel, RHO_MESSAGE_LIFE_CHANNEL) == 0 ||
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

static void update_scan_interval_hint(struct node *node, const struct transport_message *message)
{
    if (node->plots.scans < HINT_SCANS && !node->print.is_terminal) {
        scan_interval_hint_count(&node->plots,
                                 &(struct message_event){message->received_us, message->channel,
                                                         message->data, message->size});
        scan_interval_hint_report_lone(&node->plots);
    }
}

static void hear_other_node(struct node *node, const struct transport_message *message,
                            int64_t now_us, FILE *to)
{
    int32_t epoch;

    if (!message->sender.is_own && standby_hear(&node->standby, message, now_us, &epoch, to)) {
        node_core_avoid_epoch(node->core, epoch);
    }
}

/*
 * Passes a received message to the core. The log gets channels that begin with RHO_, without
 * commands that are refused here, as a replay would do them; messages that the node published are
 * already logged where they were sent.
 */
static void pass_message_to_core_and_log(struct node *node, const struct transport_message *message)
{
    const int64_t now_us = monotonic_clock_us();
    const bool is_output = is_output_channel(message->channel);
    FILE *to = node->print.is_terminal ? NULL : stderr;

    standby_note_message(&node->standby, message, now_us);
    if (is_output && node->standby.is_on) {
        hear_other_node(node, message, now_us, to);
    } else {
        duplicate_senders_note_message(&node->senders, message, now_us, to);
    }
    if (is_output) {
        return;
    }
    error_lines_set_time(message->received_us);
    node->taken++;
    if (!command_gate_admits(&node->gate, message, node_core_settings(node->core), to)) {
        return;
    }
    update_scan_interval_hint(node, message);
    if (strncmp(message->channel, "RHO_", 4) == 0) {
        log_message(node, message->received_us, message->channel, message->data, message->size);
    }
    node_core_take_message(node->core, message->channel, message->data, message->size,
                           message->received_us);
    attribute_losses_to_sensor(node, message->channel);
}

static void receive_and_process_messages(struct node *node)
{
    struct transport_message message;
    enum transport_found found = TRANSPORT_MESSAGE;

    for (int i = 0; i < TURN_MESSAGES && found == TRANSPORT_MESSAGE; i++) {
        if (is_end_signal_pending()) {
            return;
        }
        found = transport_receive(node->transport, &message);
        if (found == TRANSPORT_MESSAGE) {
            pass_message_to_core_and_log(node, &message);
        }
    }
    node->is_waiting = found == TRANSPORT_NOTHING;
    if (found == TRANSPORT_NOTHING) {
        node_core_tick(node->core, transport_now_us(node->transport));
    } else if (found == TRANSPORT_END) {
        end_node_at_end_of_input(node);
    }
}

static struct node_core_losses collect_losses(const struct node *node)
{
    const struct transport_counters network = transport_counters(node->transport);

    return (struct node_core_losses){.datagrams_refused = network.refused + network.refused_source,
                                     .reports_not_printed = node->print.left_out,
                                     .events_not_logged = node_log_events_left_out(node->log)};
}

static void write_metrics(FILE *out, void *context)
{
    const struct node *node = context;
    const struct prometheus_metrics_source source = {
        .core = node->core,
        .transport = node->transport,
        .gate = &node->gate,
        .parameters = node->parameters,
        .is_publishing = standby_may_send(&node->standby, monotonic_clock_us()),
        .messages_in = node->taken,
        .losses = collect_losses(node),
        .pages_sent = page_server_num_sent(node->pages),
        .clients_refused = page_server_num_refused(node->pages),
    };

    prometheus_metrics_write(out, &source);
}

static void send_status_and_clutter(struct node *node)
{
    const struct node_core_losses losses = collect_losses(node);

    node_core_send_status(node->core, &losses);
    if (node->statuses++ % CLUTTER_STATUSES == 0) {
        node_core_send_clutter_map(node->core);
    }
}

static void refresh_track_table(struct node *node, bool is_end)
{
    if (!node_print_refresh(&node->print, node->core, transport_url(node->transport), is_end)) {
        if (errno != EPIPE) {
            fprintf(stderr, "rhotrack: standard output: %s\n", strerror(errno));
            node->exit_code = EXIT_RUNTIME;
        }
        node->print.is_on = node->print.is_changed = false;
        node->is_over = true; /* the reader of standard output has closed it */
    }
}

/* Tells the service manager, where that is due, what the node does, and that its loop goes on. */
static void tell_service_manager(struct node *node, int64_t now_us)
{
    const char *place = transport_place(node->transport);
    char status[400];

    if (now_us >= node->service.due_us) {
        snprintf(status, sizeof status, "%s; %s%" PRIu64 " messages in, %" PRIu32 " steps",
                 *place ? place : transport_url(node->transport),
                 node->standby.is_heard ? "another node publishes; " : "", node->taken,
                 node_core_node_counters(node->core)->steps);
        service_tell(&node->service, now_us, status);
    }
}

/* Where this node begins to publish it tells its tracks and status at once. */
static void take_standby_turn(struct node *node, int64_t now_us)
{
    if (!standby_take_turn(&node->standby, node->is_waiting, now_us,
                           node->print.is_terminal ? NULL : stderr)) {
        return;
    }
    node->status_us = now_us;
    if (node_core_node_counters(node->core)->steps != node->listed_steps) {
        node_core_send_tracks(node->core);
    }
}

/*
 * Sends the status once a second, refreshes the table, prints warnings, starts due saves, and ends
 * the node at the time of --for.
 */
static void report_save_and_end_when_due(struct node *node)
{
    int64_t now_us = monotonic_clock_us();

    take_standby_turn(node, now_us);
    if (now_us >= node->status_us) {
        node->status_us += STATUS_US;
        if (node->status_us <= now_us) { /* the program was suspended for a while */
            node->status_us = now_us + STATUS_US;
        }
        send_status_and_clutter(node);
        page_server_serve(node->pages); /* drops clients that are too slow */
    }
    state_saver_save_when_due(&node->snapshot, now_us);
    state_saver_save_when_due(&node->clutter_map, now_us);
    transport_tell_place(node->transport, node->print.is_terminal ? NULL : stderr);
    warn_of_silence(node, now_us);
    tell_service_manager(node, now_us);
    node->is_over = node->is_over || now_us >= node->end_us;
    refresh_track_table(node, false);
    warn_of_losses(node);
    print_sensor_changes(node);
    report_and_retry_log(node);
}

static void run_node_until_over(struct node *node)
{
    while (!node->is_over) {
        report_save_and_end_when_due(node);
        wait_and_serve_descriptors(node);
        receive_and_process_messages(node);
    }
    node->finish_us = monotonic_clock_us() + END_US;
    node_core_flush(node->core);
    node->statuses = 0;
    send_status_and_clutter(node);
    refresh_track_table(node, true);
}

/* Waits at most END_US for print and log together, then prints the summary and saves the files. */
static void finish_and_save_outputs(struct node *node)
{
    node_print_finish(&node->print, node->finish_us);
    node_log_finish_queue(node->log, node->finish_us);
    report_and_retry_log(node);
    print_summary(node);
    save_state_at_end(node);
}

static struct node_log_limits log_limits_of_parameters(const struct parameters *parameters)
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
        .status_us = monotonic_clock_us(), .end_us = INT64_MAX, .parameters = &line->parameters};
    const struct node_core_events events = {&node, send_and_log_message, print_step_changes,
                                            print_sensor_restart, print_clock_change};
    const bool is_live = transport_url_is_live(line->lcm);
    const struct node_log_limits limits = log_limits_of_parameters(&line->parameters);
    int exit_code;

    if (line->log && transport_url_is_same_file(line->lcm, line->log)) {
        fail(EXIT_USAGE, "node: %s would overwrite the input", line->log);
    }
    node.gate = command_gate_open(line->commands, line->commanders, line->lcm);
    if (line->standby) {
        node.standby = standby_open(node.status_us, line->lcm);
    }
    pipeline_options_to_parameters(
        &line->parameters, &(struct pipeline_options){line->gate, line->method, line->pipeline});
    check_state_files(line);
    struct pipeline_show *show = pipeline_show_open(line->show, &line->parameters);
    node.core = node_core_open(&line->parameters, (int32_t)(time(NULL) & INT32_MAX), &events);
    error_lines_stamp_stderr(&line->parameters, is_live);
    node_core_set_show(node.core, show);
    if (node.gate.is_open) {
        node_core_allow_commands(node.core);
    }
    node.start_us = node.status_us;
    restore_state(&node, line);
    node.service = service_open();
    open_signal_descriptors(&node);
    start_end_watchdog(&node);
    node.transport = transport_open(line->lcm, TRANSPORT_SEND_AND_RECEIVE);
    node.pages = page_server_open(line->metrics, "/metrics",
                                  "text/plain; version=0.0.4; charset=utf-8", write_metrics, &node);
    node.log = node_log_open(line->log, is_live, &limits);
    node.print = node_print_start_rows_or_table(line->print, is_live);
    if (line->seconds > 0) {
        node.end_us = node.status_us + llround(line->seconds * 1e6);
    }
    run_node_until_over(&node);
    service_close(&node.service);
    finish_and_save_outputs(&node);
    exit_code = node.exit_code;
    page_server_close(node.pages);
    transport_close(node.transport);
    node_core_close(node.core);
    node_log_free_if_written(node.log);
    scan_interval_hint_free(&node.plots);
    close(node.signals);
    close(node.hang_ups);
    return exit_code;
}
