/* SPDX-License-Identifier: MIT */
/*
 * publish_received_asterix: receives radars' ASTERIX datagrams live, and publishes their scans as
 * LCM messages.
 */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "base/common.h"
#include "io/asterix/asterix_plot_rows.h"
#include "io/asterix/asterix_udp_receiver.h"
#include "io/csv/csv_table.h"
#include "io/log/message_shift.h"
#include "io/rows/rows_from_csv.h"
#include "io/rows/rows_to_messages.h"
#include "live/publish_stop.h"

#define WAIT_S 30.0 /* wait for a radar's place, and for its antenna messages */
#define POLL_MS 100
#define DATAGRAM_MAX 65536

struct forwarding {
    const struct command_line *line;
    struct parameters parameters; /* parameters, with the origin once a radar has told its place */
    const char *url;
    struct transport *transport;
    struct asterix_scans *scans;
    struct asterix_datagram_counts heard;
    int32_t epoch;
    struct first {
        int32_t sensor_id;
        int64_t time_128;
    } firsts[ASTERIX_MAX_SENSORS]; /* sensor and time of each radar's first scan */
    size_t num_firsts;
    uint64_t scans_sent, scans_early, scans_free, rows_skipped;
};

/* ---- Places ---- */

/* True within WAIT_S of a radar's first scan, whose time is recorded. */
static bool is_radar_scan_due(struct forwarding *forwarding, const struct asterix_scan *scan)
{
    size_t i = 0;

    while (i < forwarding->num_firsts && forwarding->firsts[i].sensor_id != scan->sensor_id) {
        i++;
    }
    if (i == forwarding->num_firsts) { /* asterix_scans gives at most ASTERIX_MAX_SENSORS radars */
        forwarding->firsts[forwarding->num_firsts++] =
            (struct first){scan->sensor_id, scan->time_128};
    }
    return scan->time_128 - forwarding->firsts[i].time_128 < (int64_t)(WAIT_S * ASTERIX_TIME_HZ);
}

/*
 * True where the radar's place is unknown and may still arrive: a scan published at a wrong place
 * would make its tracks jump later.
 */
static bool is_radar_place_awaited(struct forwarding *forwarding, const struct asterix_scan *scan)
{
    return is_radar_scan_due(forwarding, scan) && !scan->place.is_given &&
           isnan(parameters_value_of_sensor(&forwarding->parameters, scan->sensor_id, SENSOR_X_M,
                                            NAN));
}

static void set_missing_origin(struct forwarding *forwarding, const struct asterix_place *place)
{
    struct parameters *parameters = &forwarding->parameters;

    if (place->is_given && !parameters_has_origin(parameters)) {
        asterix_set_default_origin(forwarding->url, place, parameters);
    }
}

/* ---- Scans to messages ---- */

static struct table *make_table_of_scan(const struct forwarding *forwarding,
                                        const struct asterix_scan *scan)
{
    const struct asterix_columns columns = {.has_place = scan->place.is_given, .has_scan = true};
    struct table *table = asterix_plot_rows_empty_table(forwarding->url, &columns);

    asterix_plot_rows_add_scan(table, scan);
    return table;
}

static void send_rows_as_messages(struct forwarding *forwarding, struct rows_file *file)
{
    struct rows_to_messages scans;
    struct rows_at at = {.scan = 0};
    struct rows_output output;

    rows_to_messages_make_scans(&scans, file, 0);
    while (rows_to_messages_next_message(&scans, &at, &output)) {
        message_replace_epoch_number(output.data, output.size, PUBLISH_EPOCH_OF_CSV,
                                     forwarding->epoch);
        publish_send_message(forwarding->transport, output.channel, output.data, output.size);
    }
    rows_to_messages_free(&scans);
    forwarding->scans_sent++;
}

static void send_scan_unless_place_awaited(struct forwarding *forwarding,
                                           const struct asterix_scan *scan)
{
    struct rows_file file;
    struct table *table;

    set_missing_origin(forwarding, &scan->place);
    if (!scan->is_numbered) {
        forwarding->scans_free++;
        return;
    }
    if (is_radar_place_awaited(forwarding, scan)) {
        forwarding->scans_early++;
        return;
    }
    table = make_table_of_scan(forwarding, scan);
    if (rows_read_table_and_has_any(&file, forwarding->url, table, &forwarding->parameters, true)) {
        send_rows_as_messages(forwarding, &file);
    }
    forwarding->rows_skipped += file.rows_skipped;
    rows_file_free(&file);
    table_free(table);
}

static void send_complete_scans(struct forwarding *forwarding)
{
    struct asterix_scan scan;

    while (asterix_scans_next(forwarding->scans, &scan)) {
        send_scan_unless_place_awaited(forwarding, &scan);
    }
}

/* ---- Listening ---- */

static void receive_and_publish_until_end(struct forwarding *forwarding, int receiver)
{
    uint8_t *datagram = must_alloc(DATAGRAM_MAX);
    struct pollfd ready = {.fd = receiver, .events = POLLIN};
    int64_t start_us = monotonic_clock_us();

    while (!publish_is_stopped() &&
           (forwarding->line->seconds <= 0 ||
            (double)(monotonic_clock_us() - start_us) < forwarding->line->seconds * 1e6)) {
        ssize_t got;

        if (poll(&ready, 1, POLL_MS) <= 0) {
            continue;
        }
        got = recv(receiver, datagram, DATAGRAM_MAX, MSG_DONTWAIT);
        if (got >= 0) {
            asterix_datagram_take_records(forwarding->scans, datagram, (size_t)got,
                                          &forwarding->heard);
            send_complete_scans(forwarding);
        } else if (errno != EAGAIN && errno != EINTR && errno != ECONNREFUSED) {
            fail(EXIT_RUNTIME, "%s: %s", forwarding->url, strerror(errno));
        }
    }
    asterix_scans_finish(forwarding->scans);
    send_complete_scans(forwarding);
    free(datagram);
}

static void print_datagram_counts(const struct forwarding *forwarding)
{
    const struct asterix_counts *counts = asterix_scans_counts(forwarding->scans);

    asterix_plot_rows_report(forwarding->url, counts);
    print_count_unless_zero(forwarding->url, forwarding->heard.bad,
                            "datagrams used up to an error in them");
    print_count_unless_zero(forwarding->url, forwarding->heard.others,
                            "data blocks of other categories left out");
    print_count_unless_zero(forwarding->url, forwarding->scans_early,
                            "scans left out before the radar's place was known");
    print_count_unless_zero(
        forwarding->url, forwarding->scans_free,
        "plots left out, of radars without antenna messages: set scan_interval_s");
    print_count_unless_zero(forwarding->url, forwarding->rows_skipped, "bad rows skipped");
    fprintf(stderr,
            "rhotrack: %" PRIu64 " datagrams, %" PRIu64 " plots of %zu radars, %" PRIu64
            " scans sent\n",
            forwarding->heard.datagrams, counts->plots, forwarding->num_firsts,
            forwarding->scans_sent);
}

/* Dates the times of ASTERIX, which count from midnight, by the current day. */
static void date_scans_by_today(struct asterix_scans *scans)
{
    struct timespec now;

    clock_gettime(CLOCK_REALTIME, &now);
    asterix_scans_set_day(scans, (int64_t)now.tv_sec * ASTERIX_TIME_HZ);
}

int publish_asterix(const struct command_line *line)
{
    struct asterix_rules rules;
    struct forwarding *forwarding = must_calloc(1, sizeof *forwarding);
    int receiver;

    if (line->num_arguments > 1 || line->loop) {
        fail(EXIT_USAGE, "publish: %s must be the only input, and without --loop",
             line->arguments[0]);
    }
    if (line->speed < 1 || line->speed > 1) {
        fail(EXIT_USAGE, "publish: %s is a live input, and --speed is for files",
             line->arguments[0]);
    }
    parameters_check_together(&line->parameters);
    forwarding->line = line;
    forwarding->parameters = line->parameters;
    forwarding->url = line->arguments[0];
    forwarding->epoch = publish_run_epoch();
    rules = asterix_plot_rows_scan_rules(&line->parameters,
                                         line->parameters.value[PARAMETER_ASTERIX_HOLD_S], WAIT_S);
    forwarding->scans = asterix_scans_open(&rules);
    date_scans_by_today(forwarding->scans);
    publish_watch_signals();
    /* opened first: an error here leaves an output log untouched */
    receiver = asterix_udp_receiver_open(forwarding->url);
    forwarding->transport = transport_open(line->lcm, TRANSPORT_SEND);
    receive_and_publish_until_end(forwarding, receiver);
    print_datagram_counts(forwarding);
    close(receiver);
    transport_close(forwarding->transport);
    asterix_scans_close(forwarding->scans);
    free(forwarding);
    return 0;
}
