/* SPDX-License-Identifier: MIT */
#include "live/node_print.h"

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
#include "live/node_sensors.h"

#define DEG_PER_RAD 57.29577951308232

enum { PERIOD_US = 100000, HEAD_LINES = 4, ROWS_DEFAULT = 24 };

/* ---- Standard output that may be full ---- */

/* Bytes that can be written without waiting: a pipe that is ready takes as many. */
enum { PIECE_BYTES = 4096, LOOK_MS = 100 };

/* A text to fill; finish_text hands it on. */
static FILE *begin_text(struct node_print *print)
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

/* Room on standard output within wait_ms; a record waits for it until the node is told to end. */
static bool is_output_ready(const struct node_print *print, int wait_ms)
{
    struct pollfd out = {.fd = STDOUT_FILENO, .events = POLLOUT};
    int ready = poll(&out, 1, wait_ms);

    while (ready == 0 && !print->is_live && !is_end_signal_pending()) {
        ready = poll(&out, 1, LOOK_MS);
    }
    return ready > 0;
}

/* Writes until all is written, or standard output takes no more within wait_ms. */
static void push_pending_text(struct node_print *print, int wait_ms)
{
    while (is_text_pending(print) && !print->error && is_output_ready(print, wait_ms)) {
        const size_t left = print->size - print->at;
        const ssize_t written =
            write(STDOUT_FILENO, print->text + print->at, left < PIECE_BYTES ? left : PIECE_BYTES);

        print->error = written < 0 && errno != EINTR && errno != EAGAIN ? errno : 0;
        print->at += written > 0 ? (size_t)written : 0;
    }
}

static void finish_text(struct node_print *print, FILE *text)
{
    fclose(text);
    print->at = 0;
    push_pending_text(print, 0);
}

/* True where the last text is out; else this one is left out, and said so once. */
static bool has_room_for_text(struct node_print *print)
{
    push_pending_text(print, 0);
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

struct node_print node_print_start(bool is_on, bool is_live)
{
    struct node_print print = {
        .is_on = is_on, .is_live = is_live, .is_terminal = is_on && isatty(STDOUT_FILENO)};
    FILE *text;

    if (is_on) {
        text = begin_text(&print);
        if (print.is_terminal) {
            print.is_changed = true; /* the header shows at once that it listens */
            fputs("\033[2J", text);
        } else {
            tracks_write_header(text, (struct tracks_columns){.covariance = false});
        }
        finish_text(&print, text);
    }
    return print;
}

void node_print_note_step(struct node_print *print, const struct rho_report *report)
{
    print->is_changed = print->is_on;
    if (print->is_on && !print->is_terminal && has_room_for_text(print)) {
        FILE *text = begin_text(print);

        tracks_write_report(text, report, (struct tracks_columns){.covariance = false});
        finish_text(print, text);
    }
}

int64_t node_print_due_us(const struct node_print *print)
{
    return print->is_changed || is_text_pending(print) ? print->due_us : INT64_MAX;
}

void node_print_finish(struct node_print *print, int64_t until_us)
{
    const int64_t left_us = until_us - clock_us();

    push_pending_text(print, left_us > 0 ? (int)(left_us / 1000) : 0);
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

static int count_status(const struct rho_report *report, enum rho_track_status status)
{
    int count = 0;

    for (int i = 0; i < report->num_tracks; i++) {
        count += report->tracks[i].status == status;
    }
    return count;
}

/* Lines on standard error where there is no table. */
static void print_sensor_states(const struct node_core *core, FILE *out)
{
    struct rho_message_sensor sensors[RHO_MAX_SENSORS];
    const unsigned count = node_sensors_established(core, sensors);

    for (unsigned i = 0; i < count; i++) {
        if (sensors[i].is_doubted) {
            fprintf(out, "sensor %d contradicts the others  ", sensors[i].sensor_id);
        } else if (sensors[i].is_silent) {
            fprintf(out, "sensor %d is silent  ", sensors[i].sensor_id);
        }
    }
}

static void print_table_head(const struct node_core *core, const char *url, FILE *out)
{
    const struct rho_report *report = node_core_last_report(core);
    const struct rho_scan_assembler_counters *assembler = node_core_assembler_counters(core);
    const struct scan_losses losses =
        out_of_sequence_counts_losses(node_core_sequence_counts(core), assembler);

    fprintf(out, "\033[?7l\033[Hrhotrack node  %s  Ctrl-C ends it\033[K\n", url);
    fprintf(out,
            "%" PRIu32 " steps, %.0f us; tracks: %d confirmed, %d coasting, %d tentative; scans: "
            "%" PRIu32 " lost, %" PRIu32 " out of order, %" PRIu32 " dropped, %" PRIu32
            " bad; %" PRIu32 " bad messages\033[K\n",
            node_core_node_counters(core)->steps, node_core_mean_step_us(core),
            count_status(report, RHO_TRACK_CONFIRMED), count_status(report, RHO_TRACK_COASTING),
            count_status(report, RHO_TRACK_TENTATIVE), losses.lost, losses.out_of_order,
            losses.dropped, assembler->scans_bad, assembler->messages_bad);
    print_sensor_states(core, out);
    fprintf(out, "\033[K\n%6s  %-9s %10s %10s %8s %8s %8s %8s %5s %6s\033[K\n", "track", "status",
            "x km", "y km", "z m", "m/s", "heading", "sigma m", "hits", "misses");
}

/* Headings are clockwise from north, as people say them. */
static void print_track(const struct rho_track_report *track, FILE *out)
{
    double vx_mps = (double)track->state[3], vy_mps = (double)track->state[4];
    double heading_deg = atan2(vx_mps, vy_mps) * DEG_PER_RAD;

    fprintf(out, "%6" PRIu32 "  %-9s %10.3f %10.3f %8.0f %8.1f %7.0f\u00b0 %8.1f %5u %6u\033[K\n",
            track->track_id, rho_track_status_name(track->status), (double)track->state[0] / 1e3,
            (double)track->state[1] / 1e3, (double)track->state[2], hypot(vx_mps, vy_mps),
            heading_deg < 0 ? heading_deg + 360 : heading_deg, (double)track->sigma_m,
            (unsigned)track->hits, (unsigned)track->misses);
}

/* As many as there is room for, tentative ones last. Returns how many these are. */
static int print_tracks(const struct rho_report *report, int room, FILE *out)
{
    int shown = 0;

    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < report->num_tracks && shown < room; i++) {
            if ((report->tracks[i].status == RHO_TRACK_TENTATIVE) == (pass == 1)) {
                print_track(&report->tracks[i], out);
                shown++;
            }
        }
    }
    return shown;
}

static void print_table(const struct node_core *core, const char *url, FILE *out)
{
    const struct rho_report *report = node_core_last_report(core);
    int room = terminal_rows() - HEAD_LINES - 2, shown;

    print_table_head(core, url, out);
    shown = print_tracks(report, room, out);
    if (shown < report->num_tracks) {
        fprintf(out, "%6s  and %d more\033[K\n", "", report->num_tracks - shown);
    }
    fputs("\033[J\033[?7h", out); /* long lines were cut, not wrapped */
}

bool node_print_show(struct node_print *print, const struct node_core *core, const char *url,
                     bool is_end)
{
    int64_t now_us = clock_us();

    if (print->is_on &&
        (is_end || (print->is_changed && (!print->is_terminal || now_us >= print->due_us)))) {
        if (print->is_terminal && has_room_for_text(print)) {
            FILE *text = begin_text(print);

            print_table(core, url, text);
            fputs(is_end ? "\r\033[K" : "", text); /* a ^C */
            finish_text(print, text);
        }
        print->is_changed = false;
    }
    if (print->is_on && now_us >= print->due_us) {
        push_pending_text(print, 0);
        print->due_us = now_us + PERIOD_US;
    }
    errno = print->error;
    return !print->error;
}
