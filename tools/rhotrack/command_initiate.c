/* SPDX-License-Identifier: MIT */
/* initiate: track initiation alone, on the last scans of a file as one batch. */
#include <cjson/cJSON.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "commands.h"
#include "initiation/initiate_hough.h"
#include "initiation/initiate_passive.h"
#include "initiation/initiate_passive_paper.h"
#include "io/output/initiated_output.h"
#include "io/scans/bearing_reader.h"
#include "io/scans/plot_reader.h"
#include "io/turns/merged_sectors.h"
#include "pipeline/hidden_turns.h"
#include "rhotrack/tracker.h"

struct initiation_run {
    struct rho_initiator *initiator;
    int64_t time_us; /* time of the batch's last scan */
    uint64_t scans, plots, plots_no_room;
    int64_t wall_us;
};

static void push_scan_to_initiator(struct initiation_run *batch, const struct rho_scan *scan,
                                   const struct rho_sensor *sensor)
{
    static uint8_t fates[RHO_MAX_PLOTS];
    struct rho_scan held = *scan;
    uint32_t left_unused = 0;
    int64_t start_us;

    if (held.num_plots > RHO_MAX_PLOTS) {
        held.num_plots = RHO_MAX_PLOTS;
    }
    memset(fates, RHO_FATE_HELD, sizeof fates);
    start_us = monotonic_clock_us();
    must_succeed(rho_initiator_push(batch->initiator, &held, sensor, fates, &left_unused),
                 "initiator");
    batch->wall_us += monotonic_clock_us() - start_us;
    batch->time_us = scan->time_us;
    batch->scans++;
    batch->plots += scan->num_plots;
    batch->plots_no_room += scan->num_plots - held.num_plots;
}

/* Reads the batch, and searches it by kernel. */
static void search_batch_by_kernel(struct initiation_run *batch, const struct command_line *line)
{
    struct rho_initiator_config config;
    struct plot_reader *reader;
    int64_t start_us;

    parameters_to_initiator(&line->parameters, &config);
    batch->initiator = must_alloc(sizeof *batch->initiator);
    must_succeed(rho_initiator_init(batch->initiator, sizeof *batch->initiator, &config),
                 "initiator");
    reader =
        plot_reader_open(line->arguments, line->num_arguments, &line->parameters, line->keep_going);
    /* the last scans that fit the initiation window; sectors of a turn are joined to one scan */
    struct revolutions revolutions = revolutions_read_last(reader, batch->initiator->config.scans);

    for (size_t i = 0; i < revolutions.count; i++) {
        const struct revolution *turn = &revolutions.list[i];

        push_scan_to_initiator(batch, &turn->scan, turn->has_sensor ? &turn->sensor : NULL);
    }
    if (revolutions.count > 0) {
        hidden_turns_print(batch->time_us - revolutions.list[0].scan.time_us, revolutions.count,
                           &line->parameters, stderr);
    }
    revolutions_free(&revolutions);
    start_us = monotonic_clock_us();
    must_succeed(rho_initiator_search(batch->initiator, RHO_SEARCH_BATCH), "initiator");
    batch->wall_us += monotonic_clock_us() - start_us;
    plot_reader_report_skipped(reader);
    if (batch->plots_no_room) {
        fprintf(stderr, "rhotrack: %" PRIu64 " plots beyond %d a scan are left out\n",
                batch->plots_no_room, RHO_MAX_PLOTS);
    }
    if (batch->initiator->budget.partial_steps > 0) {
        fprintf(stderr, "rhotrack: %" PRIu32 " plots were not fully tried for tracks (work_max)\n",
                batch->initiator->budget.plots_not_tried);
    }
    plot_reader_close(reader);
}

static void write_found_tracks(const struct initiation_run *batch, const char *path)
{
    struct initiated_output *found = initiated_output_open(path);

    for (unsigned i = 0; i < batch->initiator->num_candidates; i++) {
        struct initiated row =
            initiated_from_candidate(i + 1, batch->time_us, &batch->initiator->candidates[i]);

        initiated_output_add_row(found, &row);
    }
    initiated_output_close(found);
}

/* Hits of each track found, in descending order, as JSON; *sum gets the sum of all hits. */
static cJSON *track_hits_json(const struct rho_initiator *initiator, double *sum)
{
    int hits[RHO_MAX_CANDIDATES];

    *sum = 0;
    for (int i = 0; i < initiator->num_candidates; i++) {
        hits[i] = initiator->candidates[i].hits;
        *sum += hits[i];
    }
    return sort_descending_into_json_list(hits, initiator->num_candidates);
}

static void print_found_json(const struct initiation_run *batch)
{
    const struct rho_initiator *initiator = batch->initiator;
    cJSON *object = cJSON_CreateObject(), *peaks;
    double votes;

    peaks = track_hits_json(initiator, &votes);
    cJSON_AddStringToObject(object, "method", "kernel");
    cJSON_AddNumberToObject(object, "scans", (double)batch->scans);
    cJSON_AddNumberToObject(object, "plots", (double)batch->plots);
    cJSON_AddNumberToObject(object, "pairs", initiator->work.seeds);
    cJSON_AddNumberToObject(object, "candidates", initiator->work.seeds);
    cJSON_AddNumberToObject(object, "votes", votes);
    cJSON_AddItemToObject(object, "peak_votes", peaks);
    cJSON_AddNumberToObject(object, "tracks", initiator->num_candidates);
    cJSON_AddNumberToObject(object, "state_bytes", (double)sizeof *initiator);
    cJSON_AddNumberToObject(object, "wall_us", (double)batch->wall_us);
    cJSON_AddNumberToObject(object, "min_scans", initiator->min_scans);
    cJSON_AddNumberToObject(object, "lookups", initiator->work.window.lookups);
    cJSON_AddNumberToObject(object, "distances", initiator->work.window.distances);
    cJSON_AddNumberToObject(object, "fits", initiator->work.fits);
    cJSON_AddNumberToObject(object, "candidates_dropped", initiator->work.candidates_dropped);
    json_add_work(object,
                  &(struct rho_tracker_work){.work = initiator->budget.work,
                                             .work_worst = initiator->budget.work_worst,
                                             .partial_steps = initiator->budget.partial_steps,
                                             .plots_not_tried = initiator->budget.plots_not_tried});
    cJSON_AddNumberToObject(object, "plots_no_room", (double)batch->plots_no_room);
    json_print_and_delete(object);
}

static void initiate_kernel(const struct command_line *line)
{
    struct initiation_run batch = {.wall_us = 0};

    search_batch_by_kernel(&batch, line);
    if (line->output || !line->json) {
        write_found_tracks(&batch, line->output);
    }
    if (line->json) {
        print_found_json(&batch);
    }
    free(batch.initiator);
}

/* The method of --method; by default passive for files of bearings, and kernel for plots. */
static enum method choose_method(const struct command_line *line)
{
    bool has_bearings = bearing_reader_is_bearings(line->arguments[0]);

    if (!line->method) {
        return has_bearings ? METHOD_PASSIVE : METHOD_KERNEL;
    }
    enum method method = method_must_find(line->method);
    if (has_bearings && !method_takes_bearings(method)) {
        fail(EXIT_USAGE, "%s: contains bearings, but method %s takes plots; try --method passive",
             line->arguments[0], line->method);
    }
    return method;
}

int command_initiate(struct command_line *line)
{
    enum method method = choose_method(line);

    method_suggest_parameters(method, &line->parameters);
    if (method == METHOD_KERNEL) {
        initiate_kernel(line);
    } else if (method == METHOD_PASSIVE) {
        initiate_passive(line);
    } else if (method == METHOD_PASSIVE_PAPER) {
        initiate_passive_paper(line);
    } else {
        initiate_hough(line, method);
    }
    return 0;
}
