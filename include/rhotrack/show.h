/* SPDX-License-Identifier: MIT */
/*
 * show: what a step thought, as messages: ghost matrices (RHO_GHOSTS), accumulators and their
 * planes (RHO_ACCUMULATOR, RHO_PLANE), hypotheses of tracks (RHO_HYPOTHESES).
 *
 *     rho_show_begin(&show, &source, now_us);                    after a step and its starts
 *     while ((channel = rho_show_next(&show, &source, buffer, sizeof buffer, &size))) {
 *         send(channel, buffer, size);
 *     }
 *
 * It changes nothing of what is shown, and nothing pays for it that is not linked with it. Each
 * kind has a rate. A picture (all pairs of sensors of a frame, or all planes of a search) is sent
 * whole or not at all: it begins while the kind is within its rate, and what is beyond it delays
 * the next one. Tracks take turns. Messages that were left out are counted, and told in each
 * message.
 *
 * Stack: 64 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_SHOW_H
#define RHOTRACK_SHOW_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/message.h"
#include "rhotrack/paper_starts.h"
#include "rhotrack/passive_paper.h"
#include "rhotrack/tracker.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

enum rho_show_kind {
    RHO_SHOW_GHOSTS,     /* ghost_matrix_t: each pair of sensors in the newest frame */
    RHO_SHOW_VOTES,      /* accumulator_t and plane_t: the last search */
    RHO_SHOW_HYPOTHESES, /* hypotheses_t: each track */
    RHO_NUM_SHOW_KINDS
};

/* Rows and columns of a plane_t, and the words that its picture takes. */
#define RHO_SHOW_SIDE 64u
#define RHO_SHOW_PICTURE (RHO_SHOW_SIDE * RHO_SHOW_SIDE)

/* Longest message. */
#define RHO_SHOW_MAX_SIZE 1472u

struct rho_show_config {
    uint16_t kinds;          /* bit k: kind k is shown */
    uint16_t messages_per_s; /* of a kind, 1 .. 10000: over a second, or a picture */
    uint32_t *picture;       /* RHO_SHOW_PICTURE words of the caller; NULL: no plane_t */
};

/* The objects after a step. */
struct rho_show_source {
    const struct rho_tracker *tracker;
    const struct rho_report *report;
    /* that took part in the step; else NULL. Their scratch is used: no result of theirs changes */
    struct rho_paper_starts *starts;
    struct rho_passive_paper *paper;
    int32_t step, epoch; /* in the messages */
};

struct rho_show_rate {
    int64_t since_us;  /* of now_us: up to when credit_us counts */
    int64_t credit_us; /* time in which nothing was sent, a second at most; below 0: too much was */
    uint32_t not_sent; /* messages, since init; saturates */
    uint32_t left, at; /* messages of this step: to come; the number of the next one */
    uint8_t has_time;
};

struct rho_show {
    uint32_t magic;
    struct rho_show_config config;
    struct rho_show_rate rates[RHO_NUM_SHOW_KINDS];
    uint32_t last_track_id; /* that was shown */
    uint32_t votes_max;     /* of the picture */
};

/* All kinds, 50 messages a second, no picture. Constant cost. */
void rho_show_config_default(struct rho_show_config *config);

/*
 * Errors: NULL, SIZE, CONFIG (no kind or an unknown one, the rate). The picture stays the caller's.
 * Constant cost. Stack: 160 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_show_init(struct rho_show *show, size_t size,
                                             const struct rho_show_config *config);

/*
 * Decides which messages the step has: one of which rho_show_next has not told all is over.
 *   now_us  clock of the rates; one that goes back begins them anew
 * Without a show that is initialised, a tracker or a report nothing is shown. Cost: tracks, and
 * pairs of sensors. Stack: 330 bytes.
 */
void rho_show_begin(struct rho_show *show, const struct rho_show_source *source, int64_t now_us);

/*
 * Writes the next message of the step, whose objects have not changed since rho_show_begin.
 *   buffer  of RHO_SHOW_MAX_SIZE bytes or more
 * Returns its channel; NULL: there is no more, or the buffer is too small. Cost: of a ghost matrix
 * rho_passive_paper_ghosts a part; of an accumulator_t rho_passive_paper_cells, and with a picture
 * rho_hough_plane or rho_passive_paper_plane; of a track rho_tracker_evidence_of. Stack: 4.5 KB
 * with 8 bearings a scan, 7 KB with 16.
 */
const char *rho_show_next(struct rho_show *show, const struct rho_show_source *source,
                          uint8_t *buffer, size_t capacity, size_t *size);

/* Messages of a kind that its rate has left out so far; 0 of no such kind. Constant cost. */
uint32_t rho_show_not_sent(const struct rho_show *show, enum rho_show_kind kind);

#ifdef __cplusplus
}
#endif

#endif
