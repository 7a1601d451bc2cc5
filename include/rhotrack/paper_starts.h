/* SPDX-License-Identifier: MIT */
/*
 * paper_starts: tracks that start by the papers' methods, live: after each step of a tracker that
 * has no initiator, what no track has claimed goes to a Hough transform.
 *
 *     rho_tracker_step(tracker, NULL, scan, report)
 *     rho_paper_starts_step(starts, tracker, scan, report)                    plots: hough.h
 *
 *     rho_tracker_step_frame(tracker, NULL, frame, report)
 *     rho_passive_paper_step(paper, tracker, frame, report)                   bearings:
 *                                                                             passive_paper.h
 *
 * A line starts a confirmed track where plots of enough scans, the newest among them, voted for it.
 * With a tracker of gate hough and input estimation this is the papers' system: ghost matrix or
 * neutrosophic votes, integer accumulators, Kalman filter with input estimation, Hough gate.
 *
 * The papers say nothing of a line that starts a track twice. Here claimed plots do not vote, and a
 * line without a plot of the newest scan starts nothing.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_PAPER_STARTS_H
#define RHOTRACK_PAPER_STARTS_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/detail/window.h"
#include "rhotrack/hough.h"
#include "rhotrack/passive_paper.h"
#include "rhotrack/tracker.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Lines of a scan that can start tracks; of more those of the most votes do. */
#define RHO_PAPER_PEAKS 32

struct rho_paper_starts_config {
    struct rho_hough_config hough;
    uint16_t scans;     /* N, the window: 3 .. RHO_MAX_SCANS; the paper's 4 */
    uint16_t scans_min; /* a line needs plots of so many: 2 .. N; 0: four fifths, rounded up */
};

/* Counters of the last search; they saturate. */
struct rho_paper_starts_work {
    uint32_t peaks, started;
    uint32_t short_lines; /* too few scans, or none of the newest */
    uint32_t refused;     /* the tracker had no room, or could not follow the plots */
};

/* A peak of the last search: whose plots voted, and the track that it started. */
struct rho_paper_line {
    struct rho_hough_track line; /* at the newest scan */
    uint32_t track_id;           /* 0: none */
};

struct rho_paper_starts {
    uint32_t magic;
    struct rho_paper_starts_config config;
    struct rho_window window; /* of the plots that no track has claimed */
    struct rho_hough hough;
    struct rho_hough_result result; /* of the last search */
    struct rho_accumulator_peak peaks[RHO_PAPER_PEAKS];
    struct rho_paper_line lines[RHO_PAPER_PEAKS]; /* of the peaks: result.num_peaks of them */
    struct rho_paper_starts_work work;
    uint32_t has_searched; /* 1: the last step did; 0: it had too few scans, or an old one */
    /* the window as the transform takes it; times count from the newest scan */
    uint32_t num_scans, scan_end[RHO_MAX_SCANS];
    float x_m[RHO_MAX_SCANS * RHO_MAX_PLOTS], y_m[RHO_MAX_SCANS * RHO_MAX_PLOTS];
    float t_s[RHO_MAX_SCANS * RHO_MAX_PLOTS];
};

/* The method's values of rho_hough_config_default, 4 scans, scans_min 0. Constant cost. */
void rho_paper_starts_config_default(struct rho_paper_starts_config *config,
                                     enum rho_hough_method method);

/*
 * Prepares an empty window; the config is copied.
 *   size   sizeof(struct rho_paper_starts) of the caller
 * Errors: NULL, SIZE, CONFIG (any field outside its range). Cost: sizeof(starts) bytes cleared.
 * Stack: 250 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_paper_starts_init(struct rho_paper_starts *starts, size_t size,
                                                     const struct rho_paper_starts_config *config);

/*
 * Takes the plots of the tracker's last step whose fate is NO_ROOM: they become HELD, in the report
 * and in the tracker's counters, as an initiator would have kept them. Then searches the window,
 * and starts tracks, which the report has from then on.
 *   scan  as it was stepped; an out-of-sequence scan is left alone
 * Errors: NULL, STATE (not initialised, or the report is not of the tracker's last step), and those
 * of rho_hough_find. Cost: rho_hough_find of the window; a line rho_hough_track, N look-ups and
 * rho_tracker_start_track. Stack: 4 KB.
 */
RHO_MUST_CHECK enum rho_status rho_paper_starts_step(struct rho_paper_starts *starts,
                                                     struct rho_tracker *tracker,
                                                     const struct rho_scan *scan,
                                                     struct rho_report *report);

/*
 * The points of the last search, for rho_hough_plane and rho_hough_vote: they stay in *starts until
 * the next step. Without a search so far they have no scans. Constant cost.
 */
struct rho_hough_points rho_paper_starts_points(const struct rho_paper_starts *starts);

/*
 * The same for a frame of bearings: unclaimed ones go into the paper's batch, and each line that
 * all pairs of sensors confirm starts a track. Its covariance is that of the fit through the line's
 * crossings, by their scatter. Errors: NULL, STATE, and those of rho_passive_paper_push. Cost:
 * rho_passive_paper_search, once the batch is full. Stack: 4 KB.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_step(struct rho_passive_paper *paper,
                                                      struct rho_tracker *tracker,
                                                      const struct rho_frame *frame,
                                                      struct rho_report *report);

#ifdef __cplusplus
}
#endif

#endif
