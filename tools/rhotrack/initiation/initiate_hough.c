/* SPDX-License-Identifier: MIT */
#include "initiation/initiate_hough.h"

#include <cjson/cJSON.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "io/output/initiated_output.h"
#include "io/scans/hough_batch.h"
#include "io/scans/plot_reader.h"
#include "io/turns/merged_sectors.h"
#include "pipeline/pipeline.h"

#define CELLS_MAX (UINT32_C(1) << 20)
#define PAIRS_MANY 1e7
struct hough_search {
    struct hough_batch batch;
    struct rho_hough *hough;
    struct rho_accumulator_peak *peaks;
    struct rho_hough_result result;
    int64_t wall_us;
};

static void read_last_revolutions(struct hough_batch *batch, const struct command_line *line)
{
    struct plot_reader *reader =
        plot_reader_open(line->arguments, line->num_arguments, &line->parameters, line->keep_going);
    struct revolutions revolutions =
        revolutions_read_last(reader, (size_t)line->parameters.value[PARAMETER_SCANS]);

    *batch = hough_batch_from_revolutions(&revolutions);
    revolutions_free(&revolutions);
    plot_reader_report_skipped(reader);
    hough_batch_report_beyond(batch);
    plot_reader_close(reader);
}

static void warn_of_dropped_votes(const struct rho_hough_result *result)
{
    if (result->cells_dropped) {
        fprintf(stderr,
                "rhotrack: more than %" PRIu32 " cells above the thresholds: the lowest are left "
                "out; raise tau or votes_min\n",
                CELLS_MAX);
    }
    if (result->votes_dropped || result->kernels_dropped) {
        fprintf(stderr,
                "rhotrack: %" PRIu32 " votes and %" PRIu32 " kernels found no room in their row\n",
                result->votes_dropped, result->kernels_dropped);
    }
}

/*
 * Warns where every pair of plots votes (mht) and the accumulator takes so many passes that the
 * search lasts minutes.
 */
static void warn_of_long_search(const struct rho_hough *hough,
                                const struct rho_hough_points *points)
{
    double pairs = 0;

    for (unsigned scan = 1; scan < points->at.num_scans; scan++) {
        uint32_t before = scan > 1 ? points->at.scan_end[scan - 2] : 0;

        pairs += (double)(points->at.scan_end[scan - 1] - before) *
                 (points->at.scan_end[scan] - points->at.scan_end[scan - 1]);
    }
    if (hough->config.method == RHO_HOUGH_MHT && pairs > PAIRS_MANY) {
        fprintf(stderr,
                "rhotrack: %.3g pairs vote, in about %.0f passes over all of them; method iht "
                "leaves out pairs that no target can fly\n",
                pairs, ceil(2.0 * pairs / RHO_MAX_HOUGH_CELLS));
    }
}

static void search_batch_for_peaks(struct hough_search *search, const struct command_line *line,
                                   enum method method)
{
    struct parameters fitted = line->parameters;
    struct rho_hough_points points = hough_batch_points(&search->batch);
    struct rho_hough_config config;

    method_widen_cells_to_range(&fitted, search->batch.range_m);
    config = method_hough_config(method, &fitted, search->batch.range_m);
    must_succeed(rho_hough_init(search->hough, sizeof *search->hough, &config), "hough");
    warn_of_long_search(search->hough, &points);
    int64_t start_us = monotonic_clock_us();
    must_succeed(rho_hough_find(search->hough, &points, search->peaks, CELLS_MAX, &search->result),
                 "hough");
    search->wall_us = monotonic_clock_us() - start_us;
    if (method == METHOD_HT) {
        rho_hough_count_pairs(search->hough, &points, &search->result.pairs,
                              &search->result.candidates);
    }
    warn_of_dropped_votes(&search->result);
}

static double peak_votes(const struct rho_accumulator_peak *peak)
{
    return round(1e6 * peak->votes / RHO_HOUGH_VOTE) / 1e6;
}

static struct initiated fit_track_of_peak(const struct hough_search *search, uint32_t number)
{
    const struct rho_accumulator_peak *peak = &search->peaks[number];
    struct rho_hough_points points = hough_batch_points(&search->batch);
    struct rho_hough_track track;

    must_succeed(
        rho_hough_track(search->hough, &points, peak->theta_cell, peak->rho_cell, 0, &track),
        "hough");
    return (struct initiated){.track_id = number + 1,
                              .time_us = search->batch.time_us,
                              .has_state = track.has_velocity,
                              .x_m = track.x_m,
                              .y_m = track.y_m,
                              .vx_mps = track.vx_mps,
                              .vy_mps = track.vy_mps,
                              .rho_m = rho_hough_rho_m(search->hough, peak->rho_cell),
                              .theta_rad = rho_hough_theta_rad(search->hough, peak->theta_cell),
                              .scans = track.scans,
                              .score = peak_votes(peak)};
}

static void write_found_tracks(const struct hough_search *search, const char *path)
{
    struct initiated_output *found = initiated_output_open(path);
    struct progress progress = progress_start("tracks", search->result.num_peaks);

    for (uint32_t i = 0; i < search->result.num_peaks; i++) {
        struct initiated row = fit_track_of_peak(search, i);

        initiated_output_add_row(found, &row);
        progress_show(&progress, i + 1);
    }
    progress_end(&progress);
    initiated_output_close(found);
}

static void print_search_json(const struct hough_search *search, enum method method)
{
    const struct rho_hough_result *result = &search->result;
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "method", method_name(method));
    if (method == METHOD_NHT) {
        int is_c = search->hough->config.method == RHO_HOUGH_NHT_C;
        cJSON_AddStringToObject(object, "nht_reading", is_c ? "c" : "a");
    }
    cJSON_AddNumberToObject(object, "scans", search->batch.num_scans);
    cJSON_AddNumberToObject(object, "plots", search->batch.num_plots + search->batch.num_invalid);
    cJSON_AddNumberToObject(object, "pairs", result->pairs);
    cJSON_AddNumberToObject(object, "candidates", result->candidates);
    cJSON_AddNumberToObject(object, "votes", result->votes);
    cJSON *list = cJSON_AddArrayToObject(object, "peak_votes");

    for (uint32_t i = 0; i < search->result.num_peaks; i++) {
        cJSON_AddItemToArray(list, cJSON_CreateNumber(peak_votes(&search->peaks[i])));
    }
    cJSON_AddNumberToObject(object, "tracks", result->num_peaks);
    cJSON_AddNumberToObject(object, "state_bytes", (double)sizeof *search->hough);
    cJSON_AddNumberToObject(object, "wall_us", (double)search->wall_us);
    cJSON_AddNumberToObject(object, "cells", result->cells);
    cJSON_AddNumberToObject(object, "passes", result->passes);
    cJSON_AddNumberToObject(object, "cells_dropped", result->cells_dropped);
    cJSON_AddNumberToObject(object, "votes_dropped", result->votes_dropped);
    cJSON_AddNumberToObject(object, "kernels_dropped", result->kernels_dropped);
    cJSON_AddNumberToObject(object, "plots_invalid", search->batch.num_invalid);
    json_print_and_delete(object);
}

void initiate_hough(const struct command_line *line, enum method method)
{
    struct hough_search search = {.hough = must_alloc(sizeof *search.hough),
                                  .peaks = must_calloc(CELLS_MAX, sizeof *search.peaks)};

    read_last_revolutions(&search.batch, line);
    search_batch_for_peaks(&search, line, method);
    if (line->output || !line->json) {
        write_found_tracks(&search, line->output);
    }
    if (line->json) {
        print_search_json(&search, method);
    }
    hough_batch_free(&search.batch);
    free(search.peaks);
    free(search.hough);
}
