/* SPDX-License-Identifier: MIT */
/* publish: plays files as live sensors would: sends their messages over LCM at their times. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "base/common.h"
#include "commands.h"
#include "io/asterix/asterix_udp_receiver.h"
#include "io/log/lcm_log.h"
#include "io/log/message_shift.h"
#include "io/log/message_source.h"
#include "io/scans/scan_interval_hint.h"
#include "live/publish_stop.h"
#include "rhotrack/udpm.h"
#include "transport/transport.h"

#define NS_PER_S 1000000000
/* longest sleep: a signal just before a sleep is noticed after this long */
#define PIECE_NS 100000000
#define LATEST_S 1e9 /* longest wait for an event, seconds */

/* A channel and its range of scan numbers in the first pass. */
struct channel {
    char name[RHO_UDPM_MAX_CHANNEL + 1];
    int32_t first_scan, last_scan;
    bool has_scans;
};

struct player {
    const struct command_line *line;
    struct transport *transport;
    struct channel *channels;
    size_t num_channels, capacity;
    uint8_t *buffer; /* copy of a message whose times or epoch are changed */
    size_t buffer_bytes;
    int32_t epoch; /* epoch of messages made of CSV rows; 0: the messages keep their own */
    int64_t first_us, last_us;
    uint64_t times;    /* distinct event times of the first pass */
    uint64_t start_ns; /* CLOCK_MONOTONIC at the first event */
    uint64_t passes, skipped;
    bool is_over;    /* the time of --for has passed */
    double shift_us; /* offset of this pass's times */
    double lag_max_s;
    struct scan_interval_hint plots; /* scan intervals of the plots in the first pass */
};

/* Whether the time of the playback is over, or a signal has come. */
static bool is_playback_stopped(const struct player *player)
{
    return player->is_over || publish_is_stopped();
}

static uint64_t monotonic_ns(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * NS_PER_S + (uint64_t)now.tv_nsec;
}

/*
 * Sleeps until an absolute deadline, so that delays do not add up; ends early on signals and --for.
 */
static void sleep_until(struct player *player, uint64_t deadline_ns)
{
    uint64_t now_ns = monotonic_ns();
    uint64_t end_ns = player->line->seconds > 0
                          ? player->start_ns + (uint64_t)(player->line->seconds * 1e9)
                          : UINT64_MAX;

    while (!is_playback_stopped(player) && now_ns < deadline_ns) {
        uint64_t next_ns = deadline_ns - now_ns > PIECE_NS ? now_ns + PIECE_NS : deadline_ns;
        struct timespec next = {(time_t)(next_ns / NS_PER_S), (long)(next_ns % NS_PER_S)};

        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, NULL);
        now_ns = monotonic_ns();
        player->is_over = now_ns >= end_ns;
    }
    player->is_over = now_ns >= end_ns;
}

/* Waits for an event's time on the playback clock; a time in the past does not wait. */
static void wait_for_event_time(struct player *player, int64_t utime)
{
    double after_s = 0;

    if (player->line->speed > 0) {
        after_s = ((double)utime - (double)player->first_us + player->shift_us) * 1e-6 /
                  player->line->speed;
    }
    uint64_t deadline_ns =
        player->start_ns + (uint64_t)(fmin(fmax(after_s, 0), LATEST_S) * NS_PER_S);
    sleep_until(player, deadline_ns);
    if (player->line->speed > 0 && !is_playback_stopped(player)) {
        player->lag_max_s =
            fmax(player->lag_max_s, (double)(monotonic_ns() - deadline_ns) / NS_PER_S);
    }
}

static struct channel *find_or_add_channel(struct player *player, const char *name)
{
    struct channel *channel;

    for (size_t i = 0; i < player->num_channels; i++) {
        if (strcmp(player->channels[i].name, name) == 0) {
            return &player->channels[i];
        }
    }
    player->channels = must_make_room_for_one(player->channels, player->num_channels,
                                              &player->capacity, sizeof *player->channels);
    channel = &player->channels[player->num_channels++];
    *channel = (struct channel){.has_scans = false};
    snprintf(channel->name, sizeof channel->name, "%s", name);
    return channel;
}

/* Records an event of the first pass: its time, and the range of its channel's scan numbers. */
static void record_first_pass_event(struct player *player, const struct message_event *event)
{
    struct channel *channel = find_or_add_channel(player, event->channel);
    int32_t scan;

    if (player->passes > 0) {
        return;
    }
    scan_interval_hint_count(&player->plots, event);
    player->times += player->times == 0 || event->utime != player->last_us;
    player->last_us = event->utime;
    if (message_scan_number(event->data, event->size, &scan)) {
        channel->first_scan = channel->has_scans ? channel->first_scan : scan;
        channel->last_scan = scan;
        channel->has_scans = true;
    }
}

/* Time from pass to pass: the duration of the first pass plus one mean interval of its events. */
static double pass_duration_us(const struct player *player)
{
    double duration_us = (double)player->last_us - (double)player->first_us;

    return player->times > 1 && duration_us > 0
               ? duration_us + duration_us / (double)(player->times - 1)
               : 1e6;
}

/* Number by which a channel's scan numbers advance from pass to pass. */
static uint32_t scans_in_pass(const struct channel *channel)
{
    return (uint32_t)channel->last_scan - (uint32_t)channel->first_scan + 1;
}

/*
 * The message for this pass: with the run's epoch, and later passes with shifted times and scans.
 */
static const uint8_t *adapt_message_to_pass(struct player *player,
                                            const struct message_event *event)
{
    const struct channel *channel = find_or_add_channel(player, event->channel);

    if (player->passes == 0 && !player->epoch) {
        return event->data;
    }
    if (event->size > player->buffer_bytes) {
        player->buffer_bytes = event->size;
        player->buffer = must_realloc(player->buffer, player->buffer_bytes);
    }
    memcpy(player->buffer, event->data, event->size);
    if (player->epoch) {
        message_replace_epoch_number(player->buffer, event->size, PUBLISH_EPOCH_OF_CSV,
                                     player->epoch);
    }
    if (player->passes > 0) {
        message_shift_in_time(player->buffer, event->size, (int64_t)player->shift_us,
                              (uint32_t)player->passes * scans_in_pass(channel));
    }
    return player->buffer;
}

static struct message_source *open_input_files_as_messages(const struct command_line *line)
{
    return message_source_open(line->arguments, line->num_arguments, &line->parameters,
                               line->keep_going);
}

/* Sends all messages of the source once at their times, and closes the source. */
static void play_pass(struct player *player, struct message_source *source)
{
    struct message_event event;

    while (!is_playback_stopped(player) && message_source_next(source, &event)) {
        if (!player->start_ns) {
            player->start_ns = monotonic_ns();
            player->first_us = event.utime;
        }
        record_first_pass_event(player, &event);
        wait_for_event_time(player, event.utime);
        if (!is_playback_stopped(player)) {
            player->skipped +=
                !publish_send_message(player->transport, event.channel,
                                      adapt_message_to_pass(player, &event), event.size);
        }
    }
    message_source_report_skipped(source);
    message_source_close(source);
    player->passes++;
    player->shift_us = pass_duration_us(player) * (double)player->passes;
}

/*
 * True where the header of a CSV file (its first line that is not a comment) has a column epoch.
 * False for pipes, which cannot be read twice.
 */
static bool has_epoch_column(const char *path)
{
    char line[4096] = "#";
    struct stat status;
    FILE *file;

    if (stat(path, &status) || !S_ISREG(status.st_mode) || !(file = fopen(path, "r"))) {
        return false;
    }
    while ((*line == '#' || *line == '\n') && fgets(line, sizeof line, file)) {
    }
    fclose(file);
    for (char *rest = NULL, *word = strtok_r(line, ", \t\r\n\"", &rest); word;
         word = strtok_r(NULL, ", \t\r\n\"", &rest)) {
        if (strcmp(word, "epoch") == 0) {
            return true;
        }
    }
    return false;
}

/*
 * The epoch by which messages of CSV files show that their sensors restarted. 0 where a log or a
 * column epoch already gives one.
 */
static int32_t restart_epoch_or_zero(const struct command_line *line)
{
    for (int i = 0; i < line->num_arguments; i++) {
        if (lcm_log_is_log(line->arguments[i]) || has_epoch_column(line->arguments[i])) {
            return 0;
        }
    }
    return publish_run_epoch();
}

static void print_summary(const struct player *player)
{
    struct transport_counters counters = transport_counters(player->transport);
    double seconds = player->start_ns ? (double)(monotonic_ns() - player->start_ns) / NS_PER_S : 0;

    fprintf(stderr,
            "rhotrack: %" PRIu64 " messages on %zu channels in %.1f s, %" PRIu64
            " passes; %.1f ms late at most\n",
            counters.sent, player->num_channels, seconds, player->passes, player->lag_max_s * 1e3);
    scan_interval_hint_report(&player->plots, player->line->arguments[0]);
    if (player->skipped) {
        fprintf(stderr, "rhotrack: %" PRIu64 " messages too long for a datagram are left out\n",
                player->skipped);
    }
}

int command_publish(struct command_line *line)
{
    struct player player = {.line = line, .epoch = restart_epoch_or_zero(line)};
    struct message_source *source;

    if (asterix_udp_receiver_is_url(line->arguments[0])) {
        return publish_asterix(line);
    }
    for (int i = 0; i < line->num_arguments; i++) {
        if (transport_url_is_same_file(line->lcm, line->arguments[i])) {
            fail(EXIT_USAGE, "publish: %s would overwrite the input", line->arguments[i]);
        }
    }
    publish_watch_signals();
    source = open_input_files_as_messages(
        line); /* input errors are reported before the output log is truncated */
    player.transport = transport_open(line->lcm, TRANSPORT_SEND);
    play_pass(&player, source);
    while (line->loop && !is_playback_stopped(&player)) {
        play_pass(&player, open_input_files_as_messages(line));
    }
    print_summary(&player);
    transport_close(player.transport);
    scan_interval_hint_free(&player.plots);
    free(player.channels);
    free(player.buffer);
    return 0;
}
