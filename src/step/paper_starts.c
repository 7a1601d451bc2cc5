/* SPDX-License-Identifier: MIT */
/*
 * paper_starts: starts tracks by the papers' Hough transforms, between two steps of a tracker.
 *
 * Plots and bearings that no track has claimed are kept and searched for lines. A line with plots
 * in the newest scan and in enough scans starts a track.
 */
#include "rhotrack/paper_starts.h"

#include <string.h>

#include "phases.h"
#include "policy.h"

#define STARTS_MAGIC 0x50535431u

void rho_paper_starts_config_default(struct rho_paper_starts_config *config,
                                     enum rho_hough_method method)
{
    if (config) {
        *config = (struct rho_paper_starts_config){.scans = 4};
        rho_hough_config_default(&config->hough, method);
    }
}

enum rho_status rho_paper_starts_init(struct rho_paper_starts *starts, size_t size,
                                      const struct rho_paper_starts_config *config)
{
    if (!starts || !config) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *starts) {
        return RHO_ERROR_SIZE;
    }
    const struct rho_paper_starts_config kept = *config; /* config may point into *starts */
    if (kept.scans < 3 || kept.scans > RHO_MAX_SCANS ||
        (kept.scans_min != 0 && (kept.scans_min < 2 || kept.scans_min > kept.scans))) {
        return RHO_ERROR_CONFIG;
    }
    starts->magic = 0;
    enum rho_status status = rho_hough_init(&starts->hough, sizeof starts->hough, &kept.hough);
    if (status != RHO_OK) {
        return status;
    }
    memset(&starts->result, 0, sizeof starts->result);
    starts->has_searched = starts->num_scans = 0;
    starts->config = kept;
    starts->magic = STARTS_MAGIC;
    return rho_window_init(&starts->window, sizeof starts->window, kept.scans, 0);
}

/* Number of the inputs of a step that have a place in the report's fates. */
static uint32_t num_with_fates(const struct rho_report *report)
{
    return report->num_plots < RHO_MAX_PLOTS ? report->num_plots : RHO_MAX_PLOTS;
}

/* Unclaimed inputs, NO_ROOM as the step had no initiator, become HELD. Returns their number. */
static uint32_t hold_unclaimed(uint8_t *fates, uint32_t num)
{
    uint32_t held = 0;
    for (uint32_t i = 0; i < num; i++) {
        held += fates[i] == RHO_FATE_NO_ROOM;
        fates[i] = fates[i] == RHO_FATE_NO_ROOM ? (uint8_t)RHO_FATE_HELD : fates[i];
    }
    return held;
}

/* Moves held inputs, but for those without room again, from the counters of NO_ROOM to HELD's. */
static void recount_held(struct rho_tracker *tracker, struct rho_report *report,
                         const uint8_t *fates, uint32_t num, uint32_t held)
{
    uint32_t *counted = tracker->counters.fates;
    for (uint32_t i = 0; i < num; i++) {
        held -= fates[i] == RHO_FATE_NO_ROOM;
    }
    report->fates_total[RHO_FATE_NO_ROOM] -= held;
    report->fates_total[RHO_FATE_HELD] += held;
    counted[RHO_FATE_HELD] = rho_count(counted[RHO_FATE_HELD], held);
    counted[RHO_FATE_NO_ROOM] -=
        held < counted[RHO_FATE_NO_ROOM] ? held : counted[RHO_FATE_NO_ROOM];
}

struct rho_hough_points rho_paper_starts_points(const struct rho_paper_starts *starts)
{
    return (struct rho_hough_points){
        .at = {starts->x_m, starts->y_m, starts->num_scans, starts->scan_end}, .t_s = starts->t_s};
}

/* Finds in each scan the plot nearest to a line's fitted motion; returns the number of plots. */
static unsigned find_plots_of_line(struct rho_paper_starts *starts,
                                   const struct rho_hough_track *line,
                                   struct rho_candidate *candidate)
{
    struct rho_window *window = &starts->window;
    const struct rho_window_scan *newest = rho_window_scan_at(window, window->num_scans - 1u);
    struct rho_window_work work = {0};
    const float cell_m = starts->hough.config.rho_cell_m;
    candidate->mask = 0;
    candidate->hits = 0;
    for (unsigned m = 0; m < window->num_scans; m++) {
        const struct rho_window_scan *scan = rho_window_scan_at(window, m);
        const float t_s = rho_seconds_between(newest->time_us, scan->time_us);
        const struct rho_window_place place = {
            .x_m = line->x_m + t_s * line->vx_mps,
            .y_m = line->y_m + t_s * line->vy_mps,
            .vx_mps = line->vx_mps,
            .vy_mps = line->vy_mps,
            .noise = {.xx_m2 = cell_m * cell_m},
            .factor = 1.0f,
            .gate_radius_m = LINE_SIGMAS * (cell_m + scan->sigma_max_m),
            .skip_flags = RHO_WINDOW_INITIATED,
        };
        const int nearest =
            rho_window_nearest_isotropic(scan, &place, LINE_SIGMAS * LINE_SIGMAS, &work);
        if (nearest >= 0) {
            candidate->plot[m] = (uint16_t)nearest;
            candidate->mask = (uint16_t)(candidate->mask | 1u << m);
            candidate->hits++;
        }
    }
    return candidate->hits;
}

static int is_in_newest_scan(unsigned mask, unsigned num_scans)
{
    return num_scans > 0 && (mask >> (num_scans - 1u) & 1u) != 0;
}

/* Identity of the track that started last: the tracker's list is in the order of starts. */
static uint32_t newest_track_id(const struct rho_tracker *tracker)
{
    return tracker->tracks[tracker->num_tracks - 1u].track_id;
}

static void start_from_line(struct rho_paper_starts *starts, struct rho_tracker *tracker,
                            struct rho_paper_line *peak, unsigned scans_min,
                            struct rho_report *report)
{
    const struct rho_hough_track *line = &peak->line;
    struct rho_window *window = &starts->window;
    uint32_t *initiated = &tracker->counters.plots_initiated;
    struct rho_candidate candidate;
    struct rho_track_plot plots[RHO_MAX_SCANS];
    peak->track_id = 0;
    if (!line->has_velocity || find_plots_of_line(starts, line, &candidate) < scans_min ||
        !is_in_newest_scan(candidate.mask, window->num_scans)) {
        return;
    }
    const unsigned num = rho_step_candidate_plots(window, &candidate, plots);
    if (rho_tracker_start_track(tracker, plots, num, 0, report) != RHO_OK) {
        return;
    }
    peak->track_id = newest_track_id(tracker);
    /* its plots start no other track */
    for (unsigned m = 0; m < window->num_scans; m++) {
        if ((unsigned)candidate.mask >> m & 1u) {
            struct rho_window_scan *scan = rho_window_scan_at(window, m);
            scan->marks[candidate.plot[m]] |= RHO_WINDOW_INITIATED;
            scan->num_unused--;
        }
    }
    *initiated = rho_count(*initiated, candidate.hits);
}

enum rho_status rho_paper_starts_step(struct rho_paper_starts *starts, struct rho_tracker *tracker,
                                      const struct rho_scan *scan, struct rho_report *report)
{
    if (!starts || !tracker || !scan || !report) {
        return RHO_ERROR_NULL;
    }
    if (starts->magic != STARTS_MAGIC || !rho_tracker_is_ready(tracker) || !tracker->has_time) {
        return RHO_ERROR_STATE;
    }
    starts->has_searched = 0;
    if (report->time_us != tracker->time_us ||
        !rho_window_accepts(&starts->window, scan->time_us)) {
        return RHO_OK;
    }
    const struct rho_paper_starts_config *config = &starts->config;
    const unsigned scans_min =
        config->scans_min > 0 ? config->scans_min : (4u * config->scans + 4u) / 5u;
    const uint32_t most = num_with_fates(report);
    struct rho_scan held = *scan;
    held.num_plots = held.num_plots < most ? held.num_plots : most;
    const uint32_t num_held = hold_unclaimed(report->fates, held.num_plots);
    enum rho_status status =
        rho_window_push(&starts->window, &held, rho_sensors_find(tracker, scan->sensor_id),
                        report->fates, &tracker->counters.plots_clutter);
    recount_held(tracker, report, report->fates, held.num_plots, num_held);
    if (status != RHO_OK || starts->window.num_scans < scans_min) {
        return status;
    }
    /* the transform takes the window's plots, but for those that have started tracks */
    struct rho_window *window = &starts->window;
    const int64_t newest_us = rho_window_scan_at(window, window->num_scans - 1u)->time_us;
    uint32_t num = 0;
    for (unsigned m = 0; m < window->num_scans; m++) {
        const struct rho_window_scan *kept = rho_window_scan_at(window, m);
        const float scan_s = -rho_seconds_between(kept->time_us, newest_us);
        for (unsigned i = 0; i < kept->num_plots; i++) {
            if (!(kept->marks[i] & RHO_WINDOW_INITIATED)) {
                starts->x_m[num] = kept->plots[i].x_m;
                starts->y_m[num] = kept->plots[i].y_m;
                starts->t_s[num++] = scan_s + kept->plots[i].offset_s;
            }
        }
        starts->scan_end[m] = num;
    }
    starts->num_scans = window->num_scans;
    const struct rho_hough_points points = rho_paper_starts_points(starts);
    status =
        rho_hough_find(&starts->hough, &points, starts->peaks, RHO_PAPER_PEAKS, &starts->result);
    for (uint32_t i = 0; status == RHO_OK && i < starts->result.num_peaks; i++) {
        status = rho_hough_track(&starts->hough, &points, starts->peaks[i].theta_cell,
                                 starts->peaks[i].rho_cell, 0.0f, &starts->lines[i].line);
        if (status == RHO_OK) {
            start_from_line(starts, tracker, &starts->lines[i], scans_min, report);
        }
    }
    starts->has_searched = status == RHO_OK;
    return status;
}

enum rho_status rho_passive_paper_step(struct rho_passive_paper *paper, struct rho_tracker *tracker,
                                       const struct rho_bearing_scan *scan,
                                       struct rho_report *report)
{
    if (!paper || !tracker || !scan || !report) {
        return RHO_ERROR_NULL;
    }
    if (!rho_tracker_is_ready(tracker) || !tracker->has_time) {
        return RHO_ERROR_STATE;
    }
    if (report->time_us != tracker->time_us) {
        return RHO_OK;
    }
    const uint32_t most = num_with_fates(report);
    struct rho_bearing_scan held = *scan;
    held.num_bearings = held.num_bearings < most ? held.num_bearings : most;
    held.num_bearings = held.num_bearings < RHO_MAX_BEARINGS ? held.num_bearings : RHO_MAX_BEARINGS;
    const struct rho_frame frame = {.time_us = scan->time_us, .scans = &held, .num_scans = 1};
    enum rho_status status = rho_batch_accepts(&paper->batch, &frame);
    if (status != RHO_OK) {
        return status;
    }
    const uint32_t num = held.num_bearings, num_held = hold_unclaimed(report->fates, num);
    held.num_bearings = num_held > 0 ? num : 0; /* tracks claim all, but the sensor has looked */
    status = rho_passive_paper_push(paper, &frame, report->fates);
    if (status != RHO_OK) {
        return status;
    }
    recount_held(tracker, report, report->fates, num, num_held);
    if (paper->batch.num_scans < paper->batch.scans_max || !paper->batch.is_due) {
        return RHO_OK;
    }
    status = rho_passive_paper_search(paper);
    for (unsigned i = 0; status == RHO_OK && i < paper->num_lines; i++) {
        struct rho_passive_paper_line *line = &paper->lines[i];
        if (!line->has_state || !is_in_newest_scan(line->scans, paper->batch.num_scans)) {
            continue;
        }
        /* the fit gives no covariance between the axes */
        const float state[4] = {line->x_m, line->y_m, line->vx_mps, line->vy_mps};
        struct rho_kalman estimate;
        rho_kalman_init(&estimate);
        for (int axis = 0; axis < 2; axis++) {
            estimate.state[axis] = state[axis];
            estimate.state[3 + axis] = state[2 + axis];
            estimate.covariance[RHO_AT(axis, axis)] = line->place_m2;
            estimate.covariance[RHO_AT(3 + axis, axis)] = line->place_velocity_m2ps;
            estimate.covariance[RHO_AT(3 + axis, 3 + axis)] = line->velocity_m2ps2;
        }
        /* no track where the tracker has no room, or the fitted covariance is refused */
        if (rho_tracker_start_estimate(tracker, &estimate, paper->batch.sensors[0].sensor_id,
                                       (uint16_t)rho_count_bits(line->scans), 0,
                                       report) == RHO_OK) {
            line->track_id = newest_track_id(tracker);
        }
    }
    return status;
}
