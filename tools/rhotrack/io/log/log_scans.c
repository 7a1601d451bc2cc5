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

/* largest values that rho_scan_assembler_config accepts */
#define HOLD_MAX_MS 10000.0
#define LATE_MAX_S 60.0

unsigned log_scans_kinds(const char *path)
{
    struct lcm_log_reader *reader;
    struct lcm_log_event event;
    struct stat status;
    unsigned kinds = 0;

    if (!stat(path, &status) && S_ISFIFO(status.st_mode)) {
        fail(EXIT_USAGE, "%s: an LCM log is read twice and cannot come through a pipe", path);
    }
    reader = lcm_log_open(path);
    while (lcm_log_next(reader, &event)) {
        if (text_begins_with(event.channel, RHO_MESSAGE_PLOT_SCAN_CHANNEL) ||
            text_begins_with(event.channel, RHO_MESSAGE_POLAR_SCAN_CHANNEL)) {
            kinds |= LOG_HAS_PLOTS;
        } else if (text_begins_with(event.channel, RHO_MESSAGE_BEARING_SCAN_CHANNEL) ||
                   text_begins_with(event.channel, RHO_MESSAGE_DIRECTION_SCAN_CHANNEL)) {
            kinds |= LOG_HAS_BEARINGS;
        }
    }
    lcm_log_close(reader);
    return kinds;
}

struct log_scans {
    const char *path;
    const struct parameters *parameters;
    bool is_held; /* the caller's reorder buffer holds scans, not the assembler */
    struct rho_scan_assembler *assembler;
    struct out_of_sequence_counts order;
    struct lcm_log_reader *reader;
    struct lcm_log_event event;
    int64_t clock_us;   /* latest time of the log's events so far */
    int64_t heard_us;   /* reception time of the last part of the newest scan given */
    bool has_event;     /* the assembler had no room for the event: it is offered again */
    bool is_over;       /* the log has no more events */
    uint64_t num_given; /* number of scans that the assembler has given */
    /* number of scans given before the clock was set back, which are left out */
    uint64_t first;
};

/*
 * hold_ms, and the span of the sensors' time biases: in a log that `convert` wrote, events stand at
 * the times that the sensors stated, so that a sensor whose bias is removed comes too early or too
 * late by its bias. Waiting costs nothing in a file.
 */
int64_t log_scans_hold_us(const struct parameters *parameters)
{
    int32_t least_us, largest_us;

    parameters_time_bias_range_us(parameters, &least_us, &largest_us);
    return llround(parameters->value[PARAMETER_HOLD_MS] * 1e3) + largest_us - least_us;
}

/* Opens the log, and sets the assembler to its state before the first event. */
static void open_log_and_assembler(struct log_scans *scans)
{
    struct parameters parameters = *scans->parameters;

    /*
     * Sets the assembler's waits. Where the caller holds the scans, with more room than the
     * assembler, which would drop out-of-sequence scans, the assembler waits only for the sensors'
     * clocks. late_max_s grows by the whole wait, so that scans held for it are not dropped as too
     * late.
     */
    double hold_ms = (double)log_scans_hold_us(&parameters) * 1e-3;
    double clocks_ms = hold_ms - parameters.value[PARAMETER_HOLD_MS];

    parameters.value[PARAMETER_HOLD_MS] = fmin(scans->is_held ? clocks_ms : hold_ms, HOLD_MAX_MS);
    parameters.value[PARAMETER_LATE_MAX_S] =
        fmin(parameters.value[PARAMETER_LATE_MAX_S] + hold_ms * 1e-3, LATE_MAX_S);
    parameters_to_assembler(&parameters, scans->assembler);
    scans->assembler->config.is_record = 1;
    scans->order = (struct out_of_sequence_counts){0};
    scans->reader = lcm_log_open(scans->path);
    scans->has_event = scans->is_over = false;
    scans->clock_us = INT64_MIN;
    scans->num_given = 0;
}

/*
 * Offers the event to the assembler. has_event stays set while the assembler has no room for it:
 * scans must be taken out first.
 */
static void offer_event_to_assembler(struct log_scans *scans)
{
    const struct lcm_log_event *event = &scans->event;

    scans->has_event =
        out_of_sequence_counts_take(&scans->order, scans->assembler, event->channel, event->data,
                                    event->size, event->utime) == RHO_ERROR_CAPACITY;
}

static int64_t assembler_clock_us(const struct log_scans *scans)
{
    return scans->is_over ? INT64_MAX : scans->event.utime;
}

/* The next scan of the assembler. An event that waits is offered again after each scan taken. */
static bool assemble_next_scan(struct log_scans *scans, struct rho_scan_assembler_item *item)
{
    for (;;) {
        if (scans->has_event) {
            offer_event_to_assembler(scans);
        }
        if (rho_scan_assembler_next(scans->assembler, assembler_clock_us(scans), item)) {
            scans->num_given++;
            scans->heard_us = item->heard_us;
            return true;
        }
        if (scans->is_over) {
            return false;
        }
        if (!scans->has_event) {
            scans->is_over = !lcm_log_next(scans->reader, &scans->event);
            if (!scans->is_over) {
                scans->clock_us =
                    scans->event.utime > scans->clock_us ? scans->event.utime : scans->clock_us;
                offer_event_to_assembler(scans);
            }
        }
    }
}

static int64_t item_scan_time_us(const struct rho_scan_assembler_item *item)
{
    return item->kind == RHO_SCAN_ASSEMBLER_BEARINGS ? item->bearings.time_us : item->scan.time_us;
}

/*
 * The sensors' clock was set back: two recordings in one file cannot be stepped as one. Exit 2, or
 * the scans before are left out.
 */
static void refuse_clock_restart(struct log_scans *scans,
                                 const struct rho_scan_assembler_item *item, bool keep_going)
{
    double time_s = 1e-6 * (double)item_scan_time_us(item);
    uint64_t before = scans->num_given - 1;

    if (!keep_going) {
        fail(EXIT_USAGE,
             "%s: the sensors' clock is set anew at %.6f s: the log may hold two recordings; "
             "--keep-going uses only the scans from there on",
             scans->path, time_s);
    }
    fprintf(stderr,
            "rhotrack: %s: the sensors' clock is set anew at %.6f s: %" PRIu64
            " earlier scans are left out\n",
            scans->path, time_s, before - scans->first);
    scans->first = before;
}

/*
 * Goes through the whole log to count its scans, and to find the last time the clock was set back.
 */
static void preview_scans(struct log_scans *scans, uint64_t file_bytes, bool keep_going)
{
    struct rho_scan_assembler_item item;
    int64_t last_us = INT64_MIN;
    struct progress progress = progress_start("scans looked through", 0);

    while (assemble_next_scan(scans, &item)) {
        if (item.is_restart && item_scan_time_us(&item) < last_us) {
            refuse_clock_restart(scans, &item, keep_going);
        }
        last_us = item_scan_time_us(&item);
        progress_show_by_bytes(&progress, scans->num_given, lcm_log_position(scans->reader),
                               file_bytes);
    }
    progress_end(&progress);
}

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
        {counters->scans_duplicate, "duplicate scans or parts"},
        {counters->scans_other, "duplicates with other contents (two senders of one number)"},
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
                                 bool keep_going, bool reports_faults, bool caller_holds_scans)
{
    struct log_scans *scans = must_calloc(1, sizeof *scans);

    scans->path = path;
    scans->parameters = parameters;
    scans->is_held = caller_holds_scans;
    scans->assembler = must_alloc(sizeof *scans->assembler);
    open_log_and_assembler(scans);
    preview_scans(scans, regular_file_size_or_zero(path), keep_going);
    if (reports_faults) {
        const struct scan_losses losses =
            out_of_sequence_counts_losses(&scans->order, &scans->assembler->counters);

        lcm_log_report_skipped(scans->reader);
        report_assembler_faults(path, &scans->assembler->counters, &losses);
    }
    if (scans->num_given == 0) {
        fail(EXIT_USAGE, "%s: contains no scan of a sensor (channels %s<n>, %s<n>, %s<n>, %s<n>)",
             path, RHO_MESSAGE_PLOT_SCAN_CHANNEL, RHO_MESSAGE_POLAR_SCAN_CHANNEL,
             RHO_MESSAGE_BEARING_SCAN_CHANNEL, RHO_MESSAGE_DIRECTION_SCAN_CHANNEL);
    }
    log_scans_rewind(scans);
    return scans;
}

bool log_scans_next(struct log_scans *scans, struct rho_scan_assembler_item *item)
{
    while (assemble_next_scan(scans, item)) {
        if (scans->num_given > scans->first) {
            return true;
        }
    }
    return false;
}

void log_scans_rewind(struct log_scans *scans)
{
    lcm_log_close(scans->reader);
    open_log_and_assembler(scans);
}

int64_t log_scans_latest_event_us(const struct log_scans *scans)
{
    return scans->clock_us;
}

int64_t log_scans_scan_received_us(const struct log_scans *scans)
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
