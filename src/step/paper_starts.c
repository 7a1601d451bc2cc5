/* SPDX-License-Identifier: MIT */
/*
 * paper_starts: starts tracks by the papers' Hough transforms, between two steps of a tracker.
 *
 * Plots and bearings that no track has claimed are kept and searched for lines. A line with plots
 * in the newest scan and in enough scans starts a track.
 */
#include "rhotrack/paper_starts.h"

#include <string.h>

#include "batch_frame.h"
#include "phases.h"
#include "rhotrack/detail/approx.h"

#define STARTS_MAGIC 0x50535431u

/* Standard deviations within which a line's plots are, from the motion fitted to its voters. */
#define GATE_SIGMAS 3.0f

/* ---- configuration --------------------------------------------------------------------------- */

void rho_paper_starts_config_default(struct rho_paper_starts_config *config,
                                     enum rho_hough_method method)
{
    if (config) {
        *config = (struct rho_paper_starts_config){.scans = 4};
        rho_hough_config_default(&config->hough, method);
    }
}

static int is_usable_config(const struct rho_paper_starts_config *config)
{
    return config->scans >= 3 && config->scans <= RHO_MAX_SCANS &&
           (config->scans_min == 0 ||
            (config->scans_min >= 2 && config->scans_min <= config->scans));
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
    if (!is_usable_config(&kept)) {
        return RHO_ERROR_CONFIG;
    }
    starts->magic = 0;
    enum rho_status status = rho_hough_init(&starts->hough, sizeof starts->hough, &kept.hough);
    if (status != RHO_OK) {
        return status;
    }
    memset(&starts->result, 0, sizeof starts->result);
    memset(&starts->work, 0, sizeof starts->work);
    starts->has_searched = starts->num_scans = 0;
    starts->config = kept;
    starts->magic = STARTS_MAGIC;
    return rho_window_init(&starts->window, sizeof starts->window, kept.scans, 0, 0.0f);
}

/* ---- what is kept ---------------------------------------------------------------------------- */

/* The state of the tracker's last step, made from its report, as functions of a step take it. */
static struct step step_from_report(struct rho_tracker *tracker, struct rho_report *report)
{
    return (struct step){.tracker = tracker,
                         .report = report,
                         .look = {.tracker = tracker,
                                  .fates = report->fates,
                                  .time_us = report->time_us,
                                  .num_inputs = report->num_plots,
                                  .num_gated = report->num_plots < RHO_MAX_PLOTS ? report->num_plots
                                                                                 : RHO_MAX_PLOTS}};
}

static int has_stepped(const struct rho_tracker *tracker)
{
    return rho_tracker_is_ready(tracker) && tracker->has_time;
}

/* Moves inputs from the counters of NO_ROOM to those of HELD: the step had no initiator. */
static void recount_no_room_as_held(const struct step *step, uint32_t held)
{
    uint32_t *fates = step->tracker->counters.fates;
    step->report->fates_total[RHO_FATE_NO_ROOM] -= held;
    step->report->fates_total[RHO_FATE_HELD] += held;
    fates[RHO_FATE_HELD] = rho_count(fates[RHO_FATE_HELD], held);
    fates[RHO_FATE_NO_ROOM] -= held < fates[RHO_FATE_NO_ROOM] ? held : fates[RHO_FATE_NO_ROOM];
}

/* Unclaimed inputs become HELD, so that the window or the batch takes them. */
static void mark_no_room_as_held(uint8_t *fates, uint32_t num)
{
    for (uint32_t i = 0; i < num; i++) {
        fates[i] = fates[i] == RHO_FATE_NO_ROOM ? (uint8_t)RHO_FATE_HELD : fates[i];
    }
}

static uint32_t count_inputs_with_fate(const uint8_t *fates, uint32_t num, enum rho_fate fate)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < num; i++) {
        count += fates[i] == fate;
    }
    return count;
}

/* ---- plots ----------------------------------------------------------------------------------- */

static enum rho_status push_plots_into_window(struct rho_paper_starts *starts,
                                              const struct step *step, const struct rho_scan *scan)
{
    const struct rho_sensor *sensor = rho_sensors_find(step->tracker, scan->sensor_id);
    struct rho_scan held = *scan;
    uint8_t *fates = step->report->fates;
    held.num_plots = held.num_plots < step->look.num_gated ? held.num_plots : step->look.num_gated;
    const uint32_t before = count_inputs_with_fate(fates, held.num_plots, RHO_FATE_NO_ROOM);
    mark_no_room_as_held(fates, held.num_plots);
    enum rho_status status = rho_window_push(&starts->window, &held, sensor, fates,
                                             &step->tracker->counters.plots_clutter);
    recount_no_room_as_held(
        step, before - count_inputs_with_fate(fates, held.num_plots, RHO_FATE_NO_ROOM));
    return status;
}

struct rho_hough_points rho_paper_starts_points(const struct rho_paper_starts *starts)
{
    return (struct rho_hough_points){
        .at = {starts->x_m, starts->y_m, starts->num_scans, starts->scan_end}, .t_s = starts->t_s};
}

/* Copies the window into the transform's arrays, without plots that have started tracks. */
static struct rho_hough_points gather_unused_points(struct rho_paper_starts *starts)
{
    struct rho_window *window = &starts->window;
    const int64_t newest_us = rho_window_scan_at(window, window->num_scans - 1u)->time_us;
    uint32_t num = 0;
    for (unsigned m = 0; m < window->num_scans; m++) {
        const struct rho_window_scan *scan = rho_window_scan_at(window, m);
        const float scan_s = -rho_seconds_between(scan->time_us, newest_us);
        for (unsigned i = 0; i < scan->num_plots; i++) {
            if (!(scan->marks[i] & RHO_WINDOW_INITIATED)) {
                starts->x_m[num] = scan->plots[i].x_m;
                starts->y_m[num] = scan->plots[i].y_m;
                starts->t_s[num++] = scan_s + scan->plots[i].offset_s;
            }
        }
        starts->scan_end[m] = num;
    }
    starts->num_scans = window->num_scans;
    return rho_paper_starts_points(starts);
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
        const struct rho_window_query query = {
            .x_m = line->x_m + t_s * line->vx_mps,
            .y_m = line->y_m + t_s * line->vy_mps,
            .vx_mps = line->vx_mps,
            .vy_mps = line->vy_mps,
            .variance_m2 = cell_m * cell_m,
            .sigma_factor = 1.0f,
            .gate_chi2 = GATE_SIGMAS * GATE_SIGMAS,
            .gate_radius_m = GATE_SIGMAS * (cell_m + scan->sigma_max_m),
            .skip_flags = RHO_WINDOW_INITIATED,
        };
        const int nearest = rho_window_nearest_isotropic(scan, &query, &work);
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

/* Marks a candidate's plots in the window: they start no other track. */
static void mark_plots_used(struct rho_paper_starts *starts, const struct rho_candidate *candidate,
                            struct rho_tracker_counters *counters)
{
    for (unsigned m = 0; m < starts->window.num_scans; m++) {
        if ((unsigned)candidate->mask >> m & 1u) {
            struct rho_window_scan *scan = rho_window_scan_at(&starts->window, m);
            scan->marks[candidate->plot[m]] |= RHO_WINDOW_INITIATED;
            scan->num_unused--;
        }
    }
    counters->plots_initiated = rho_count(counters->plots_initiated, candidate->hits);
}

/* Identity of the track that started last: the tracker's list is in the order of starts. */
static uint32_t newest_track_id(const struct rho_tracker *tracker)
{
    return tracker->tracks[tracker->num_tracks - 1u].track_id;
}

static void start_track_from_line(struct rho_paper_starts *starts, struct rho_tracker *tracker,
                                  struct rho_paper_line *peak, unsigned scans_min,
                                  struct rho_report *report)
{
    const struct rho_hough_track *line = &peak->line;
    struct rho_candidate candidate;
    struct rho_track_plot plots[RHO_MAX_SCANS];
    peak->track_id = 0;
    if (!line->has_velocity || find_plots_of_line(starts, line, &candidate) < scans_min ||
        !is_in_newest_scan(candidate.mask, starts->window.num_scans)) {
        starts->work.short_lines = rho_count(starts->work.short_lines, 1);
        return;
    }
    const unsigned num = rho_step_candidate_plots(&starts->window, &candidate, plots);
    if (rho_tracker_start_track(tracker, plots, num, 0, report) == RHO_OK) {
        peak->track_id = newest_track_id(tracker);
        mark_plots_used(starts, &candidate, &tracker->counters);
        starts->work.started = rho_count(starts->work.started, 1);
    } else {
        starts->work.refused = rho_count(starts->work.refused, 1);
    }
}

static unsigned num_scans_needed_or_four_fifths(unsigned scans_min, unsigned scans)
{
    return scans_min > 0 ? scans_min : (4u * scans + 4u) / 5u;
}

enum rho_status rho_paper_starts_step(struct rho_paper_starts *starts, struct rho_tracker *tracker,
                                      const struct rho_scan *scan, struct rho_report *report)
{
    if (!starts || !tracker || !scan || !report) {
        return RHO_ERROR_NULL;
    }
    if (starts->magic != STARTS_MAGIC || !has_stepped(tracker)) {
        return RHO_ERROR_STATE;
    }
    struct step step = step_from_report(tracker, report);
    memset(&starts->work, 0, sizeof starts->work);
    starts->has_searched = 0;
    if (report->time_us != tracker->time_us ||
        !rho_window_accepts(&starts->window, scan->time_us)) {
        return RHO_OK;
    }
    enum rho_status status = push_plots_into_window(starts, &step, scan);
    const unsigned scans_min =
        num_scans_needed_or_four_fifths(starts->config.scans_min, starts->config.scans);
    if (status != RHO_OK || starts->window.num_scans < scans_min) {
        return status;
    }
    const struct rho_hough_points points = gather_unused_points(starts);
    status =
        rho_hough_find(&starts->hough, &points, starts->peaks, RHO_PAPER_PEAKS, &starts->result);
    starts->work.peaks = starts->result.num_peaks;
    for (uint32_t i = 0; status == RHO_OK && i < starts->result.num_peaks; i++) {
        status = rho_hough_track(&starts->hough, &points, starts->peaks[i].theta_cell,
                                 starts->peaks[i].rho_cell, 0.0f, &starts->lines[i].line);
        if (status == RHO_OK) {
            start_track_from_line(starts, tracker, &starts->lines[i], scans_min, report);
        }
    }
    starts->has_searched = status == RHO_OK;
    return status;
}

/* ---- bearings -------------------------------------------------------------------------------- */

/* Kalman estimate of a line's x, y, vx and vy; the fit gives no covariance between the axes. */
static struct rho_kalman estimate_from_line(const struct rho_passive_paper_line *line)
{
    struct rho_kalman estimate;
    const float state[4] = {line->x_m, line->y_m, line->vx_mps, line->vy_mps};
    rho_kalman_init(&estimate);
    for (int axis = 0; axis < 2; axis++) {
        estimate.state[axis] = state[axis];
        estimate.state[3 + axis] = state[2 + axis];
        estimate.covariance[RHO_AT(axis, axis)] = line->place_m2;
        estimate.covariance[RHO_AT(3 + axis, axis)] = line->place_velocity_m2ps;
        estimate.covariance[RHO_AT(3 + axis, 3 + axis)] = line->velocity_m2ps2;
    }
    return estimate;
}

static void start_tracks_from_lines(struct rho_passive_paper *paper, struct rho_tracker *tracker,
                                    struct rho_report *report)
{
    for (unsigned i = 0; i < paper->num_lines; i++) {
        struct rho_passive_paper_line *line = &paper->lines[i];
        if (line->has_state && is_in_newest_scan(line->scans, paper->batch.num_scans)) {
            const struct rho_kalman estimate = estimate_from_line(line);
            /* no track where the tracker has no room, or the fitted covariance is refused */
            if (rho_tracker_start_estimate(tracker, &estimate, paper->batch.sensors[0].sensor_id,
                                           (uint16_t)rho_count_bits(line->scans), 0,
                                           report) == RHO_OK) {
                line->track_id = newest_track_id(tracker);
            }
        }
    }
}

static uint32_t num_bearings_in_frame(const struct batch_frame *held)
{
    uint32_t num = 0;
    for (uint32_t i = 0; i < held->frame.num_scans; i++) {
        num += held->scans[i].num_bearings;
    }
    return num;
}

enum rho_status rho_passive_paper_step(struct rho_passive_paper *paper, struct rho_tracker *tracker,
                                       const struct rho_frame *frame, struct rho_report *report)
{
    if (!paper || !tracker || !frame || !report) {
        return RHO_ERROR_NULL;
    }
    if (!has_stepped(tracker)) {
        return RHO_ERROR_STATE;
    }
    struct step step = step_from_report(tracker, report);
    struct batch_frame held;
    step.frame = frame;
    if (report->time_us != tracker->time_us || frame->num_scans > RHO_MAX_PASSIVE_SENSORS) {
        return RHO_OK;
    }
    rho_step_frame_to_batch(&step, &held);
    const uint32_t num = num_bearings_in_frame(&held);
    const uint32_t before = count_inputs_with_fate(held.fates, num, RHO_FATE_NO_ROOM);
    mark_no_room_as_held(held.fates, num);
    enum rho_status status = rho_passive_paper_push(paper, &held.frame, held.fates);
    if (status != RHO_OK) {
        return status;
    }
    rho_step_batch_to_report(&step, &held);
    recount_no_room_as_held(&step,
                            before - count_inputs_with_fate(held.fates, num, RHO_FATE_NO_ROOM));
    if (paper->batch.num_scans == paper->batch.scans_max) {
        status = rho_passive_paper_search(paper);
        if (status == RHO_OK) {
            start_tracks_from_lines(paper, tracker, report);
        }
    }
    return status;
}
