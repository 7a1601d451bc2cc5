/* SPDX-License-Identifier: MIT */
/* publish: plays files as sensors: their messages in time over LCM. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "base/common.h"
#include "commands.h"
#include "io/asterix/asterix_udp.h"
#include "io/log/lcm_log.h"
#include "io/log/message_shift.h"
#include "io/log/message_source.h"
#include "io/scans/scan_interval_hint.h"
#include "live/publish.h"
#include "rhotrack/udpm.h"
#include "transport/transport.h"

#define NS_PER_S 1000000000
#define PIECE_NS 100000000 /* a signal between a look and a sleep is noticed after this long */
#define LATEST_S 1e9       /* nobody waits as long */

/* A channel in the first pass, and the numbers of its scans. */
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
    uint8_t *buffer; /* of a message that is changed */
    size_t buffer_bytes;
    int32_t epoch; /* for those of CSV; 0: as they are */
    int64_t first_us, last_us;
    uint64_t times;    /* different ones, of the first pass */
    uint64_t start_ns; /* CLOCK_MONOTONIC: of the first event */
    uint64_t passes, skipped;
    bool is_over;    /* its time is */
    double shift_us; /* of this pass */
    double lag_max_s;
    struct scan_interval_hint plots; /* of the first pass */
};

/* ---- Time ---- */

static bool is_playing_over(const struct player *player)
{
    return player->is_over || publish_is_stopped();
}

static uint64_t monotonic_ns(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * NS_PER_S + (uint64_t)now.tv_nsec;
}

/* Deadlines are absolute: what one sleep is late, the next is not. */
static void sleep_until(struct player *player, uint64_t deadline_ns)
{
    uint64_t now_ns = monotonic_ns();
    uint64_t end_ns = player->line->seconds > 0
                          ? player->start_ns + (uint64_t)(player->line->seconds * 1e9)
                          : UINT64_MAX;

    while (!is_playing_over(player) && now_ns < deadline_ns) {
        uint64_t next_ns = deadline_ns - now_ns > PIECE_NS ? now_ns + PIECE_NS : deadline_ns;
        struct timespec next = {(time_t)(next_ns / NS_PER_S), (long)(next_ns % NS_PER_S)};

        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, NULL);
        now_ns = monotonic_ns();
        player->is_over = now_ns >= end_ns;
    }
    player->is_over = now_ns >= end_ns;
}

/* Waits for an event's time; times that go back are now. */
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
    if (player->line->speed > 0 && !is_playing_over(player)) {
        player->lag_max_s =
            fmax(player->lag_max_s, (double)(monotonic_ns() - deadline_ns) / NS_PER_S);
    }
}

/* ---- What goes on from pass to pass ---- */

static struct channel *find_channel(struct player *player, const char *name)
{
    struct channel *channel;

    for (size_t i = 0; i < player->num_channels; i++) {
        if (strcmp(player->channels[i].name, name) == 0) {
            return &player->channels[i];
        }
    }
    player->channels = must_grow(player->channels, player->num_channels, &player->capacity,
                                 sizeof *player->channels);
    channel = &player->channels[player->num_channels++];
    *channel = (struct channel){.has_scans = false};
    snprintf(channel->name, sizeof channel->name, "%s", name);
    return channel;
}

/* Counts an event of the first pass: its time, and the scans of its channel. */
static void note_first_pass_event(struct player *player, const struct message_event *event)
{
    struct channel *channel = find_channel(player, event->channel);
    int32_t scan;

    if (player->passes > 0) {
        return;
    }
    scan_interval_hint_add_message(&player->plots, event);
    player->times += player->times == 0 || event->utime != player->last_us;
    player->last_us = event->utime;
    if (message_scan_number(event->data, event->size, &scan)) {
        channel->first_scan = channel->has_scans ? channel->first_scan : scan;
        channel->last_scan = scan;
        channel->has_scans = true;
    }
}

/* A pass begins one mean interval after the end of the one before. */
static double pass_duration_us(const struct player *player)
{
    double duration_us = (double)player->last_us - (double)player->first_us;

    return player->times > 1 && duration_us > 0
               ? duration_us + duration_us / (double)(player->times - 1)
               : 1e6;
}

static uint32_t scans_in_pass(const struct channel *channel)
{
    return (uint32_t)channel->last_scan - (uint32_t)channel->first_scan + 1;
}

/* The message as it is to be sent. */
static const uint8_t *message_for_pass(struct player *player, const struct message_event *event)
{
    const struct channel *channel = find_channel(player, event->channel);

    if (player->passes == 0 && !player->epoch) {
        return event->data;
    }
    if (event->size > player->buffer_bytes) {
        player->buffer_bytes = event->size;
        player->buffer = must_realloc(player->buffer, player->buffer_bytes);
    }
    memcpy(player->buffer, event->data, event->size);
    if (player->epoch) {
        message_set_epoch(player->buffer, event->size, PUBLISH_EPOCH_OF_CSV, player->epoch);
    }
    if (player->passes > 0) {
        message_shift_in_time(player->buffer, event->size, (int64_t)player->shift_us,
                              (uint32_t)player->passes * scans_in_pass(channel));
    }
    return player->buffer;
}

/* ---- Sending ---- */

static void send_event(struct player *player, const struct message_event *event)
{
    player->skipped += !publish_send_message(player->transport, event->channel,
                                             message_for_pass(player, event), event->size);
}

static struct message_source *open_messages(const struct command_line *line)
{
    return message_source_open(line->arguments, line->num_arguments, &line->parameters,
                               line->keep_going);
}

/* One pass; the source is closed. */
static void play_pass(struct player *player, struct message_source *source)
{
    struct message_event event;

    while (!is_playing_over(player) && message_source_next(source, &event)) {
        if (!player->start_ns) {
            player->start_ns = monotonic_ns();
            player->first_us = event.utime;
        }
        note_first_pass_event(player, &event);
        wait_for_event_time(player, event.utime);
        if (!is_playing_over(player)) {
            send_event(player, &event);
        }
    }
    message_source_report(source);
    message_source_close(source);
    player->passes++;
    player->shift_us = pass_duration_us(player) * (double)player->passes;
}

/* ---- Epochs ---- */

/*
 * Whether a CSV file's header, its first line that is no comment, names the column. A pipe is not
 * looked into.
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
 * A sensor that begins anew says so by its epoch; logs and files that say one keep it. 0 stands for
 * none.
 */
static int32_t epoch_for_csv(const struct command_line *line)
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
    struct player player = {.line = line, .epoch = epoch_for_csv(line)};
    struct message_source *source;

    if (asterix_udp_is_url(line->arguments[0])) {
        return publish_asterix(line);
    }
    for (int i = 0; i < line->num_arguments; i++) {
        if (transport_url_is_file(line->lcm, line->arguments[i])) {
            fail(EXIT_USAGE, "publish: %s would be written over what is read", line->arguments[i]);
        }
    }
    publish_watch_signals();
    source = open_messages(line); /* what is wrong with it is said before a log is emptied */
    player.transport = transport_open(line->lcm, TRANSPORT_SEND);
    play_pass(&player, source);
    while (line->loop && !is_playing_over(&player)) {
        play_pass(&player, open_messages(line));
    }
    print_summary(&player);
    transport_close(player.transport);
    scan_interval_hint_free(&player.plots);
    free(player.channels);
    free(player.buffer);
    return 0;
}
