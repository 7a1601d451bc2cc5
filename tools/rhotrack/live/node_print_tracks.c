/* SPDX-License-Identifier: MIT */
#include "live/node_print_tracks.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/common.h"
#include "io/csv/tracks_writer.h"
#include "live/node_sensor_warnings.h"
#include "pipeline/learned_report.h"

#define DEG_PER_RAD 57.29577951308232

enum { PERIOD_US = 100000, HEAD_LINES = 4, ROWS_DEFAULT = 24 };

/* ---- Standard output that may be full ---- */

/* Largest write to standard output: a pipe that polls as ready takes this much without blocking. */
enum { PIECE_BYTES = 4096, LOOK_MS = 100 };

/* Opens a memory stream for the next output text, which close_and_write_text then writes. */
static FILE *open_memory_stream_for_text(struct node_print *print)
{
    FILE *text = open_memstream(&print->text, &print->size);

    if (!text) {
        fail(EXIT_RUNTIME, "out of memory");
    }
    return text;
}

static bool is_text_pending(const struct node_print *print)
{
    return print->at < print->size;
}

/*
 * True where standard output can take text within wait_ms. A replay waits until it can, or until
 * the node is told to end.
 */
static bool wait_for_output_room(const struct node_print *print, int wait_ms)
{
    struct pollfd out = {.fd = STDOUT_FILENO, .events = POLLOUT};
    int ready = poll(&out, 1, wait_ms);

    while (ready == 0 && !print->is_live && !is_end_signal_pending()) {
        ready = poll(&out, 1, LOOK_MS);
    }
    return ready > 0;
}

/* Writes the pending text until all is written, or standard output blocks for wait_ms. */
static void write_pending_text(struct node_print *print, int wait_ms)
{
    while (is_text_pending(print) && !print->error && wait_for_output_room(print, wait_ms)) {
        const size_t left = print->size - print->at;
        const ssize_t written =
            write(STDOUT_FILENO, print->text + print->at, left < PIECE_BYTES ? left : PIECE_BYTES);

        print->error = written < 0 && errno != EINTR && errno != EAGAIN ? errno : 0;
        print->at += written > 0 ? (size_t)written : 0;
    }
}

static void close_and_write_text(struct node_print *print, FILE *text)
{
    fclose(text);
    print->at = 0;
    write_pending_text(print, 0);
}

/*
 * True where the previous text is completely written. Else counts the new report as left out, and
 * prints so at the first one.
 */
static bool is_last_text_written(struct node_print *print)
{
    write_pending_text(print, 0);
    if (is_text_pending(print)) {
        if (print->left_out++ == 0 && !print->is_terminal) {
            fputs("rhotrack: standard output is full; reports are left out, tracks go on\n",
                  stderr);
        }
        return false;
    }
    free(print->text);
    print->text = NULL;
    print->size = print->at = 0;
    return true;
}

/* ---- Steps ---- */

struct node_print node_print_start_rows_or_table(bool is_on, bool is_live)
{
    struct node_print print = {
        .is_on = is_on, .is_live = is_live, .is_terminal = is_on && isatty(STDOUT_FILENO)};
    FILE *text;

    if (is_on) {
        text = open_memory_stream_for_text(&print);
        if (print.is_terminal) {
            print.is_changed = true; /* shows the table's head before the first step */
            fputs("\033[2J", text);
        } else {
            tracks_write_header(text, (struct tracks_columns){.covariance = false});
        }
        close_and_write_text(&print, text);
    }
    return print;
}

void node_print_rows(struct node_print *print, const struct rho_report *report)
{
    print->is_changed = print->is_on;
    if (print->is_on && !print->is_terminal && is_last_text_written(print)) {
        FILE *text = open_memory_stream_for_text(print);

        tracks_write_report(text, report, (struct tracks_columns){.covariance = false});
        close_and_write_text(print, text);
    }
}

int64_t node_print_due_us(const struct node_print *print)
{
    return print->is_changed || is_text_pending(print) ? print->due_us : INT64_MAX;
}

void node_print_finish(struct node_print *print, int64_t until_us)
{
    const int64_t left_us = until_us - monotonic_clock_us();

    write_pending_text(print, left_us > 0 ? (int)(left_us / 1000) : 0);
    print->left_out += is_text_pending(print);
    free(print->text);
    print->text = NULL;
    print->size = print->at = 0;
}

/* ---- The table ---- */

static int terminal_rows(void)
{
    struct winsize size = {0};

    return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > HEAD_LINES + 1
               ? size.ws_row
               : ROWS_DEFAULT;
}

static int count_tracks_with_status(const struct rho_report *report, enum rho_track_status status)
{
    int count = 0;

    for (int i = 0; i < report->num_tracks; i++) {
        count += report->tracks[i].status == status;
    }
    return count;
}

/* Prints suspect and silent sensors in the table; without a table they go to standard error. */
static void print_bad_sensors(const struct node_core *core, FILE *out)
{
    struct rho_message_sensor sensors[RHO_MAX_SENSORS];
    const unsigned count = node_sensors_list_established(core, sensors);

    for (unsigned i = 0; i < count; i++) {
        if (sensors[i].is_doubted) {
            fprintf(out, "sensor %d contradicts the others  ", sensors[i].sensor_id);
        } else if (sensors[i].is_silent) {
            fprintf(out, "sensor %d is silent  ", sensors[i].sensor_id);
        }
    }
}

static void print_node_and_table_head(const struct node_core *core, const char *url, FILE *out)
{
    const struct rho_report *report = node_core_last_report(core);
    const struct rho_scan_assembler_counters *assembler = node_core_assembler_counters(core);
    const struct scan_losses losses =
        out_of_sequence_counts_losses(node_core_used_out_of_sequence(core), assembler);

    fprintf(out, "\033[?7l\033[Hrhotrack node  %s  Ctrl-C ends it\033[K\n", url);
    fprintf(out,
            "%" PRIu32 " steps, %.0f us; tracks: %d confirmed, %d coasting, %d tentative; echoes "
            "that stand: %u; scans: "
            "%" PRIu32 " lost, %" PRIu32 " out of order, %" PRIu32 " dropped, %" PRIu32
            " bad; %" PRIu32 " bad messages\033[K\n",
            node_core_node_counters(core)->steps, node_core_mean_step_us(core),
            count_tracks_with_status(report, RHO_TRACK_CONFIRMED),
            count_tracks_with_status(report, RHO_TRACK_COASTING),
            count_tracks_with_status(report, RHO_TRACK_TENTATIVE),
            learned_report_num_standing(&node_core_tracker_state(core)->clutter_map), losses.lost,
            losses.out_of_order, losses.dropped, assembler->scans_bad, assembler->messages_bad);
    print_bad_sensors(core, out);
    fprintf(out, "\033[K\n%6s  %-9s %10s %10s %8s %8s %8s %8s %5s %6s\033[K\n", "track", "status",
            "x km", "y km", "z m", "m/s", "heading", "sigma m", "hits", "misses");
}

/* Prints a track's row of the table, with its heading clockwise from north. */
static void print_track_row(const struct rho_track_report *track, FILE *out)
{
    double vx_mps = (double)track->state[3], vy_mps = (double)track->state[4];
    double heading_deg = atan2(vx_mps, vy_mps) * DEG_PER_RAD;

    fprintf(out, "%6" PRIu32 "  %-9s %10.3f %10.3f %8.0f %8.1f %7.0f\u00b0 %8.1f %5u %6u\033[K\n",
            track->track_id, rho_track_status_name(track->status), (double)track->state[0] / 1e3,
            (double)track->state[1] / 1e3, (double)track->state[2], hypot(vx_mps, vy_mps),
            heading_deg < 0 ? heading_deg + 360 : heading_deg, (double)track->sigma_m,
            (unsigned)track->hits, (unsigned)track->misses);
}

/* Prints at most `room` tracks, tentative ones last. Returns the number of printed tracks. */
static int print_track_rows(const struct rho_report *report, int room, FILE *out)
{
    int shown = 0;

    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < report->num_tracks && shown < room; i++) {
            if (!report->tracks[i].is_in_doubt &&
                (report->tracks[i].status == RHO_TRACK_TENTATIVE) == (pass == 1)) {
                print_track_row(&report->tracks[i], out);
                shown++;
            }
        }
    }
    return shown;
}

static void print_track_table(const struct node_core *core, const char *url, FILE *out)
{
    const struct rho_report *report = node_core_last_report(core);
    int room = terminal_rows() - HEAD_LINES - 2, shown;

    print_node_and_table_head(core, url, out);
    shown = print_track_rows(report, room, out);
    if (shown < report->num_tracks) {
        fprintf(out, "%6s  and %d more\033[K\n", "", report->num_tracks - shown);
    }
    fputs("\033[J\033[?7h", out); /* erase the rest of the screen, and wrap long lines again */
}

bool node_print_refresh(struct node_print *print, const struct node_core *core, const char *url,
                        bool is_end)
{
    int64_t now_us = monotonic_clock_us();

    if (print->is_on &&
        (is_end || (print->is_changed && (!print->is_terminal || now_us >= print->due_us)))) {
        if (print->is_terminal && is_last_text_written(print)) {
            FILE *text = open_memory_stream_for_text(print);

            print_track_table(core, url, text);
            fputs(is_end ? "\r\033[K" : "", text); /* overwrites the terminal's ^C */
            close_and_write_text(print, text);
        }
        print->is_changed = false;
    }
    if (print->is_on && now_us >= print->due_us) {
        write_pending_text(print, 0);
        print->due_us = now_us + PERIOD_US;
    }
    errno = print->error;
    return !print->error;
}
