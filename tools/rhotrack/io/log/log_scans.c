/* SPDX-License-Identifier: MIT */
#include "io/log/log_scans.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "base/common.h"
#include "io/log/lcm_log.h"
#include "io/scans/out_of_sequence_counts.h"
#include "rhotrack/message.h"

/* of rho_scan_assembler_config */
#define HOLD_MAX_MS 10000.0
#define LATE_MAX_S 60.0

/* ---- Kinds ---- */

unsigned log_scans_kinds(const char *path)
{
    struct lcm_log_reader *reader;
    struct lcm_log_event event;
    struct stat status;
    unsigned kinds = 0;

    if (!stat(path, &status) && S_ISFIFO(status.st_mode)) {
        fail(EXIT_USAGE, "%s: a log is looked at twice, so that a pipe will not do", path);
    }
    reader = lcm_log_open(path);
    while (lcm_log_next(reader, &event)) {
        if (text_begins_with(event.channel, RHO_MESSAGE_PLOT_SCAN_CHANNEL) ||
            text_begins_with(event.channel, RHO_MESSAGE_POLAR_SCAN_CHANNEL)) {
            kinds |= LOG_HAS_PLOTS;
        } else if (text_begins_with(event.channel, RHO_MESSAGE_BEARING_SCAN_CHANNEL)) {
            kinds |= LOG_HAS_BEARINGS;
        }
    }
    lcm_log_close(reader);
    return kinds;
}

/* ---- Scans ---- */

struct log_scans {
    const char *path;
    const struct parameters *parameters;
    bool is_held; /* by the caller */
    struct rho_scan_assembler *assembler;
    struct out_of_sequence_counts order;
    struct lcm_log_reader *reader;
    struct lcm_log_event event;
    int64_t clock_us;   /* the latest event's */
    int64_t heard_us;   /* the last scan's last part's */
    bool has_event;     /* the assembler has not taken it yet */
    bool is_over;       /* there are no more events */
    uint64_t num_given; /* by the assembler */
    uint64_t first;     /* what it gives before this one is left out */
};

/*
 * A log's events may stand at the times that the sensors said, as `convert` writes them: a sensor
 * whose time bias is taken off comes so much too early or too late then, and is waited for. Nobody
 * waits for a file.
 */
int64_t log_scans_hold_us(const struct parameters *parameters)
{
    int32_t least_us, largest_us;

    parameters_time_biases_us(parameters, &least_us, &largest_us);
    return llround(parameters->value[PARAMETER_HOLD_MS] * 1e3) + largest_us - least_us;
}

/*
 * The caller holds the scans, with all the room there is: the assembler, which has less and would
 * drop out-of-sequence scans, holds none, and takes none for out of sequence too early.
 */
static void lengthen_waits(struct parameters *parameters, bool is_held)
{
    double hold_ms = (double)log_scans_hold_us(parameters) * 1e-3;
    double clocks_ms = hold_ms - parameters->value[PARAMETER_HOLD_MS];

    parameters->value[PARAMETER_HOLD_MS] = fmin(is_held ? clocks_ms : hold_ms, HOLD_MAX_MS);
    parameters->value[PARAMETER_LATE_MAX_S] =
        fmin(parameters->value[PARAMETER_LATE_MAX_S] + hold_ms * 1e-3, LATE_MAX_S);
}

/* The assembler as it was before the first event. */
static void start_assembler(struct log_scans *scans)
{
    struct parameters parameters = *scans->parameters;

    lengthen_waits(&parameters, scans->is_held);
    parameters_to_assembler(&parameters, scans->assembler);
    scans->assembler->config.is_record = 1;
    scans->order = (struct out_of_sequence_counts){0};
    scans->reader = lcm_log_open(scans->path);
    scans->has_event = scans->is_over = false;
    scans->clock_us = INT64_MIN;
    scans->num_given = 0;
}

/* Offers the event to the assembler, which may have no room before something is taken from it. */
static void offer_event(struct log_scans *scans)
{
    const struct lcm_log_event *event = &scans->event;

    scans->has_event = out_of_sequence_counts_take_message(&scans->order, scans->assembler,
                                                           event->channel, event->data, event->size,
                                                           event->utime) == RHO_ERROR_CAPACITY;
}

static void next_event(struct log_scans *scans)
{
    scans->is_over = !lcm_log_next(scans->reader, &scans->event);
    if (!scans->is_over) {
        scans->clock_us =
            scans->event.utime > scans->clock_us ? scans->event.utime : scans->clock_us;
        offer_event(scans);
    }
}

static int64_t now_us(const struct log_scans *scans)
{
    return scans->is_over ? INT64_MAX : scans->event.utime;
}

/* The next scan of all. An event that waits is offered again after each call for the next scan. */
static bool take_next_scan(struct log_scans *scans, struct rho_scan_assembler_item *item)
{
    for (;;) {
        if (scans->has_event) {
            offer_event(scans);
        }
        if (rho_scan_assembler_next(scans->assembler, now_us(scans), item)) {
            scans->num_given++;
            scans->heard_us = item->heard_us;
            return true;
        }
        if (scans->is_over) {
            return false;
        }
        if (!scans->has_event) {
            next_event(scans);
        }
    }
}

static int64_t item_time_us(const struct rho_scan_assembler_item *item)
{
    return item->kind == RHO_SCAN_ASSEMBLER_BEARINGS ? item->bearings.time_us : item->scan.time_us;
}

/* The clock was set back: two recordings in one file cannot be stepped as one. */
static void leave_out_scans_before(struct log_scans *scans,
                                   const struct rho_scan_assembler_item *item, bool keep_going)
{
    double time_s = 1e-6 * (double)item_time_us(item);
    uint64_t before = scans->num_given - 1;

    if (!keep_going) {
        fail(EXIT_USAGE,
             "%s: the sensors' clock starts anew at %.6f s: two recordings in one? With "
             "--keep-going only what comes from there on is taken",
             scans->path, time_s);
    }
    fprintf(stderr,
            "rhotrack: %s: the sensors' clock starts anew at %.6f s: %" PRIu64
            " scans before are left out\n",
            scans->path, time_s, before - scans->first);
    scans->first = before;
}

/* Goes through the whole log. */
static void look_through_log(struct log_scans *scans, uint64_t bytes, bool keep_going)
{
    struct rho_scan_assembler_item item;
    int64_t last_us = INT64_MIN;
    struct progress progress = progress_start("scans looked through", 0);

    while (take_next_scan(scans, &item)) {
        if (item.is_restart && item_time_us(&item) < last_us) {
            leave_out_scans_before(scans, &item, keep_going);
        }
        last_us = item_time_us(&item);
        progress_show_bytes(&progress, scans->num_given, lcm_log_position(scans->reader), bytes);
    }
    progress_end(&progress);
}

/* ---- What was wrong ---- */

static void report_assembler_faults(const char *path,
                                    const struct rho_scan_assembler_counters *counters,
                                    const struct scan_losses *losses)
{
    const struct {
        uint32_t count;
        const char *text;
    } lines[] = {
        {counters->messages_bad, "bad messages"},
        {counters->messages_wrong_type, "messages of another type or version"},
        {counters->messages_flooded, "messages beyond flood_per_s or stranger_plots_per_s"},
        {counters->messages_not_allowed, "messages of sensors that are not in sensors_allowed"},
        {counters->scans_bad, "scans with bad numbers"},
        {counters->clock_jumps, "scans with bad times"},
        {losses->out_of_order, "scans out of order"},
        {losses->dropped, "scans late, dropped"},
        {counters->scans_duplicate, "scans or parts double"},
        {counters->scans_other, "double with other contents (two senders of one number)"},
        {losses->lost, "scans lost"},
        {counters->scans_incomplete, "scans incomplete"},
        {counters->sensor_restarts, "restarts of sensors"},
        {counters->sensors_no_room, "messages of too many sensors"},
        {counters->plots_no_room, "plots or bearings beyond the capacity of a scan"},
    };
    const char *between = "";

    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        if (lines[i].count > 0) {
            if (!*between) {
                fprintf(stderr, "rhotrack: %s: ", path);
            }
            fprintf(stderr, "%s%" PRIu32 " %s", between, lines[i].count, lines[i].text);
            between = ", ";
        }
    }
    if (*between) {
        fputc('\n', stderr);
    }
}

struct log_scans *log_scans_open(const char *path, const struct parameters *parameters,
                                 bool keep_going, bool is_reported, bool is_held)
{
    struct log_scans *scans = must_calloc(1, sizeof *scans);

    scans->path = path;
    scans->parameters = parameters;
    scans->is_held = is_held;
    scans->assembler = must_alloc(sizeof *scans->assembler);
    start_assembler(scans);
    look_through_log(scans, plain_file_size(path), keep_going);
    if (is_reported) {
        const struct scan_losses losses =
            out_of_sequence_counts_losses(&scans->order, &scans->assembler->counters);

        lcm_log_report_skipped(scans->reader);
        report_assembler_faults(path, &scans->assembler->counters, &losses);
    }
    if (scans->num_given == 0) {
        fail(EXIT_USAGE, "%s: not one scan of a sensor (channels %s<n>, %s<n>, %s<n>)", path,
             RHO_MESSAGE_PLOT_SCAN_CHANNEL, RHO_MESSAGE_POLAR_SCAN_CHANNEL,
             RHO_MESSAGE_BEARING_SCAN_CHANNEL);
    }
    log_scans_rewind(scans);
    return scans;
}

bool log_scans_next(struct log_scans *scans, struct rho_scan_assembler_item *item)
{
    while (take_next_scan(scans, item)) {
        if (scans->num_given > scans->first) {
            return true;
        }
    }
    return false;
}

void log_scans_rewind(struct log_scans *scans)
{
    lcm_log_close(scans->reader);
    start_assembler(scans);
}

int64_t log_scans_clock_us(const struct log_scans *scans)
{
    return scans->clock_us;
}

int64_t log_scans_heard_us(const struct log_scans *scans)
{
    return scans->heard_us;
}

uint64_t log_scans_position(const struct log_scans *scans)
{
    return lcm_log_position(scans->reader);
}

void log_scans_close(struct log_scans *scans)
{
    lcm_log_close(scans->reader);
    free(scans->assembler);
    free(scans);
}
