/* SPDX-License-Identifier: MIT */
#include "log_scans.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common.h"
#include "lcm_log.h"
#include "rhotrack/message.h"

/* ---- Kinds ---- */

static bool begins_with(const char *channel, const char *prefix)
{
    return strncmp(channel, prefix, strlen(prefix)) == 0;
}

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
        if (begins_with(event.channel, RHO_MESSAGE_PLOT_SCAN_CHANNEL) ||
            begins_with(event.channel, RHO_MESSAGE_POLAR_SCAN_CHANNEL)) {
            kinds |= LOG_HAS_PLOTS;
        } else if (begins_with(event.channel, RHO_MESSAGE_BEARING_SCAN_CHANNEL)) {
            kinds |= LOG_HAS_BEARINGS;
        }
    }
    lcm_log_close(reader);
    return kinds;
}

/* ---- Scans ---- */

static void *copy_of(const void *from, size_t count, size_t size)
{
    void *copy = must_calloc(count + 1, size);

    if (count > 0) {
        memcpy(copy, from, count * size);
    }
    return copy;
}

static void clear(struct log_scans *scans)
{
    for (size_t i = 0; i < scans->count; i++) {
        free((void *)scans->items[i].scan.plots);
        free((void *)scans->items[i].bearings.bearings);
    }
    scans->count = 0;
}

static void add_item(struct log_scans *scans, const struct rho_feed_item *item)
{
    struct rho_feed_item *copy;

    scans->items = must_grow(scans->items, scans->count, &scans->capacity, sizeof *scans->items);
    copy = &scans->items[scans->count++];
    *copy = *item;
    if (item->kind == RHO_FEED_BEARINGS) {
        copy->bearings.bearings = copy_of(item->bearings.bearings, item->bearings.num_bearings,
                                          sizeof *item->bearings.bearings);
    } else {
        copy->scan.plots =
            copy_of(item->scan.plots, item->scan.num_plots, sizeof *item->scan.plots);
    }
}

static int64_t time_of(const struct rho_feed_item *item)
{
    return item->kind == RHO_FEED_BEARINGS ? item->bearings.time_us : item->scan.time_us;
}

/* The clock was set back: two recordings in one file cannot be stepped as one. */
static bool goes_back(const struct log_scans *scans, const struct rho_feed_item *item)
{
    return item->is_restart && scans->count > 0 &&
           time_of(item) < time_of(&scans->items[scans->count - 1]);
}

static void start_anew(struct log_scans *scans, const char *path, const struct rho_feed_item *item,
                       bool keep_going)
{
    double time_s = 1e-6 * (double)time_of(item);

    if (!keep_going) {
        fail(EXIT_USAGE,
             "%s: the sensors' clock starts anew at %.6f s: two recordings in one? With "
             "--keep-going only what comes from there on is taken",
             path, time_s);
    }
    fprintf(stderr,
            "rhotrack: %s: the sensors' clock starts anew at %.6f s: %zu scans before are left "
            "out\n",
            path, time_s, scans->count);
    clear(scans);
}

/* Everything that is due, or with `once` one scan. */
static void take_due(struct log_scans *scans, struct rho_feed *feed, const char *path,
                     int64_t now_us, bool keep_going, bool once)
{
    struct rho_feed_item item;

    while (rho_feed_next(feed, now_us, &item)) {
        if (goes_back(scans, &item)) {
            start_anew(scans, path, &item, keep_going);
        }
        add_item(scans, &item);
        if (once) {
            return;
        }
    }
}

static void read_events(struct log_scans *scans, struct rho_feed *feed,
                        struct lcm_log_reader *reader, const char *path, bool keep_going)
{
    struct lcm_log_event event;

    while (lcm_log_next(reader, &event)) {
        while (rho_feed_take(feed, event.channel, event.data, event.size, event.utime) ==
               RHO_ERROR_CAPACITY) {
            take_due(scans, feed, path, event.utime, keep_going, true);
        }
        take_due(scans, feed, path, event.utime, keep_going, false);
    }
    take_due(scans, feed, path, INT64_MAX, keep_going, false);
}

/* ---- What was wrong ---- */

static void say_counters(const char *path, const struct rho_feed_counters *counters)
{
    const struct {
        uint32_t count;
        const char *text;
    } lines[] = {
        {counters->messages_bad, "bad messages"},
        {counters->messages_wrong_type, "messages of another type or version"},
        {counters->messages_flooded, "messages beyond flood_per_s"},
        {counters->scans_bad, "scans with bad numbers"},
        {counters->clock_jumps, "scans with bad times"},
        {counters->scans_late, "scans late"},
        {counters->scans_duplicate, "scans or parts double"},
        {counters->scans_lost, "scans lost"},
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

struct log_scans log_scans_read(const char *path, const struct parameters *parameters,
                                bool keep_going, bool is_told)
{
    struct rho_feed *feed = must_alloc(sizeof *feed);
    struct lcm_log_reader *reader = lcm_log_open(path);
    struct log_scans scans = {NULL, 0, 0};

    parameters_to_feed(parameters, feed);
    read_events(&scans, feed, reader, path, keep_going);
    if (is_told) {
        lcm_log_report(reader);
        say_counters(path, &feed->counters);
    }
    lcm_log_close(reader);
    free(feed);
    if (scans.count == 0) {
        fail(EXIT_USAGE, "%s: not one scan of a sensor (channels %s<n>, %s<n>, %s<n>)", path,
             RHO_MESSAGE_PLOT_SCAN_CHANNEL, RHO_MESSAGE_POLAR_SCAN_CHANNEL,
             RHO_MESSAGE_BEARING_SCAN_CHANNEL);
    }
    return scans;
}

void log_scans_free(struct log_scans *scans)
{
    clear(scans);
    free(scans->items);
    scans->items = NULL;
}
