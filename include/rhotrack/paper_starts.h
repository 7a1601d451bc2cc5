/* SPDX-License-Identifier: MIT */
/*
 * paper_starts: starts tracks by the papers' methods, live: after each step of a tracker that has
 * no initiator, the plots or bearings that no track has claimed go to a Hough transform.
 *
 *     rho_tracker_step(tracker, NULL, scan, report)
 *     rho_paper_starts_step(starts, tracker, scan, report)                    plots: hough.h
 *
 *     rho_tracker_step_bearings(tracker, NULL, scan, report)
 *     rho_passive_paper_step(paper, tracker, scan, report)                    bearings:
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

RHO_BEGIN_C

/* Largest number of a scan's lines that can start tracks: those with the most votes. */
#define RHO_PAPER_PEAKS 32

struct rho_paper_starts_config {
    struct rho_hough_config hough;
    uint16_t scans; /* N, scans in the window: 3 .. RHO_MAX_SCANS; the paper's 4 */
    /* least number of scans in which a line has plots, 2 .. N; 0: four fifths of N, rounded up */
    uint16_t scans_min;
};

/* A peak of the last search: the line of the plots that voted, and the track that it started. */
struct rho_paper_line {
    struct rho_hough_track line; /* line and motion, at the time of the newest scan */
    /*
     * identity of the started track; 0: none, as the line has plots in too few scans, or none in
     * the newest one, or the tracker had no room, or could not follow the plots
     */
    uint32_t track_id;
};

struct rho_paper_starts {
    uint32_t magic;
    struct rho_paper_starts_config config;
    struct rho_window window; /* window of the plots that no track has claimed */
    struct rho_hough hough;
    struct rho_hough_result result; /* result of the last search */
    struct rho_accumulator_peak peaks[RHO_PAPER_PEAKS];
    struct rho_paper_line lines[RHO_PAPER_PEAKS]; /* lines of the peaks: result.num_peaks of them */
    /* 1: the last step searched; 0: the window had too few scans, or the scan was too old */
    uint32_t has_searched;
    /* the window in the arrays of the Hough transform; times are relative to the newest scan */
    uint32_t num_scans, scan_end[RHO_MAX_SCANS];
    float x_m[RHO_MAX_SCANS * RHO_MAX_PLOTS], y_m[RHO_MAX_SCANS * RHO_MAX_PLOTS];
    float t_s[RHO_MAX_SCANS * RHO_MAX_PLOTS];
};

/* Default: the method's values of rho_hough_config_default, 4 scans, scans_min 0. Constant cost. */
void rho_paper_starts_config_default(struct rho_paper_starts_config *config,
                                     enum rho_hough_method method);

/*
 * Prepares an empty window; the config is copied.
 *   size   sizeof(struct rho_paper_starts) of the caller
 * Errors: NULL, SIZE, CONFIG (a field outside its range). Cost: sizeof(starts). Stack: 250 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_paper_starts_init(struct rho_paper_starts *starts, size_t size,
                                                     const struct rho_paper_starts_config *config);

/*
 * Puts the plots of the tracker's last step whose fate is NO_ROOM into the window: they become
 * HELD, in the report and in the tracker's counters, as with an initiator. Then searches the
 * window, and starts tracks, which are added to the report.
 *   scan  scan of the last step; an out-of-sequence scan is ignored
 * Errors: NULL, STATE (not initialised, or the report is not of the tracker's last step), and those
 * of rho_hough_find. Cost: rho_hough_find of the window; a line rho_hough_track, N look-ups and
 * rho_tracker_start_track. Stack: 4 KB.
 */
RHO_MUST_CHECK enum rho_status rho_paper_starts_step(struct rho_paper_starts *starts,
                                                     struct rho_tracker *tracker,
                                                     const struct rho_scan *scan,
                                                     struct rho_report *report);

/*
 * Returns the points of the last search, for rho_hough_plane and rho_hough_vote: they stay in
 * *starts until the next step. Before the first search they have no scans. Constant cost.
 */
struct rho_hough_points rho_paper_starts_points(const struct rho_paper_starts *starts);

/*
 * Starts tracks from bearings: unclaimed ones go into the paper's batch, and once each sensor has
 * looked, each line that all pairs of sensors confirm starts a track. The track's covariance is
 * that of the fit through the line's crossings, by their scatter. Errors: NULL, STATE, and those of
 * rho_passive_paper_push. Cost: rho_passive_paper_search of a full batch. Stack: 4 KB.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_step(struct rho_passive_paper *paper,
                                                      struct rho_tracker *tracker,
                                                      const struct rho_bearing_scan *scan,
                                                      struct rho_report *report);

RHO_END_C

#endif
