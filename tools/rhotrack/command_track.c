/* SPDX-License-Identifier: MIT */
/* track: the whole chain, scans in, tracks out. */
#include <cjson/cJSON.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "bearings_batch.h"
#include "chain.h"
#include "commands.h"
#include "common.h"
#include "frame_reader.h"
#include "inputs.h"
#include "method.h"
#include "tracks_output.h"

struct tracking {
    struct chain chain;
    int64_t sum_us, max_us;
};

/* ---- Steps ---- */

/* What is known of the sensor goes before its scan; it may have moved. */
static void describe(struct tracking *tracking, const struct rho_sensor *sensor)
{
    enum rho_status status = rho_tracker_set_sensor(tracking->chain.tracker, sensor);

    if (status == RHO_ERROR_CAPACITY) {
        fail(EXIT_USAGE, "more than %d sensors with places or limits of their own",
             RHO_MAX_SENSORS);
    }
    must_succeed(status, "sensor");
}

/* Passive sensors stand still and are known from the start. */
static void describe_passive(struct tracking *tracking, const struct inputs *inputs,
                             const struct parameters *parameters)
{
    size_t count;
    const struct frame_sensor *sensors = inputs_passive_sensors(inputs, &count);

    if (count > 0) {
        struct parameters customary = *parameters;

        method_suggest(METHOD_PASSIVE, &customary);
        bearings_check_sensors(sensors, count, &tracking->chain.passive->batch, &customary);
    }
    for (size_t i = 0; i < count; i++) {
        struct rho_sensor sensor;

        if (parameters_to_sensor(parameters, sensors[i].sensor_id, &sensor)) {
            sensor.x_m = sensors[i].x_m;
            sensor.y_m = sensors[i].y_m;
            sensor.range_max_m = (float)parameters_range_max_m(parameters, sensors[i].sensor_id);
            describe(tracking, &sensor);
        }
    }
}

static void step(struct tracking *tracking, const struct input *input)
{
    int64_t start_us, took_us;

    if (input->sensor) {
        describe(tracking, input->sensor);
    }
    start_us = clock_us();
    if (input->scan) {
        chain_step(&tracking->chain, input->scan);
    } else {
        chain_step_frame(&tracking->chain, input->frame);
    }
    took_us = clock_us() - start_us;
    tracking->sum_us += took_us;
    if (took_us > tracking->max_us) {
        tracking->max_us = took_us;
    }
}

static void step_all(struct tracking *tracking, struct inputs *inputs, uint64_t total,
                     struct tracks_output *tracks)
{
    struct progress progress = progress_start("scans", total);
    uint64_t done = 0;

    for (struct input input = inputs_next(inputs); input.scan || input.frame;
         input = inputs_next(inputs)) {
        step(tracking, &input);
        if (tracks) {
            tracks_output_report(tracks, tracking->chain.report);
        }
        progress_show(&progress, ++done);
    }
    progress_end(&progress);
}

/* ---- What it comes to ---- */

static double mean_us(const struct tracking *tracking, const struct inputs_counts *counts)
{
    return (double)tracking->sum_us / (double)counts->steps;
}

static void print_summary(const struct tracking *tracking, const struct inputs_counts *counts)
{
    const struct rho_tracker_counters *counters = &tracking->chain.tracker->counters;

    fprintf(stderr,
            "rhotrack: %" PRIu64 " scans, %" PRIu64 " plots, %" PRIu32 " tracks confirmed; lost: "
            "%" PRIu32 " invalid, %" PRIu32 " stale, %" PRIu32 " no room",
            counts->steps, counts->plots, counters->tracks_confirmed,
            counters->fates[RHO_FATE_INVALID], counters->fates[RHO_FATE_STALE],
            counters->fates[RHO_FATE_NO_ROOM]);
    if (counts->frames_incomplete) {
        fprintf(stderr, ", %" PRIu64 " frames miss a sensor%s", counts->frames_incomplete,
                counts->frames_incomplete == counts->frames ? " (all: see frame_tolerance_s)" : "");
    }
    if (counts->rows_skipped) {
        fprintf(stderr, ", %" PRIu64 " bad rows skipped", counts->rows_skipped);
    }
    fprintf(stderr, "; %.0f us a scan, %" PRId64 " at most\n", mean_us(tracking, counts),
            tracking->max_us);
}

static cJSON *fates_json(const struct rho_tracker_counters *counters)
{
    cJSON *object = cJSON_CreateObject();

    for (int i = 0; i < RHO_NUM_FATES; i++) {
        cJSON_AddNumberToObject(object, rho_fate_name((enum rho_fate)i), counters->fates[i]);
    }
    return object;
}

static cJSON *counters_json(const struct rho_tracker_counters *counters)
{
    cJSON *object = cJSON_CreateObject();

    cJSON_AddNumberToObject(object, "scans_accepted", counters->scans_accepted);
    cJSON_AddNumberToObject(object, "scans_late", counters->scans_late);
    cJSON_AddNumberToObject(object, "plots_initiated", counters->plots_initiated);
    cJSON_AddNumberToObject(object, "plots_clutter", counters->plots_clutter);
    cJSON_AddNumberToObject(object, "tracks_started", counters->tracks_started);
    cJSON_AddNumberToObject(object, "tracks_ended", counters->tracks_ended);
    cJSON_AddNumberToObject(object, "tracks_no_room", counters->tracks_no_room);
    cJSON_AddNumberToObject(object, "gate_plots_dropped", counters->gate_plots_dropped);
    cJSON_AddNumberToObject(object, "candidates_dropped", counters->candidates_dropped);
    cJSON_AddNumberToObject(object, "updates_refused", counters->updates_refused);
    cJSON_AddNumberToObject(object, "hypotheses_cut", counters->hypotheses_cut);
    return object;
}

static size_t count_bytes(const struct tracking *tracking, const struct inputs *inputs)
{
    return sizeof *tracking->chain.tracker +
           (inputs_have_plots(inputs) ? sizeof *tracking->chain.initiator : 0) +
           (inputs_have_bearings(inputs) ? sizeof *tracking->chain.passive : 0);
}

static void print_json(const struct tracking *tracking, const struct inputs *inputs,
                       const struct inputs_counts *counts)
{
    const struct rho_tracker_counters *counters = &tracking->chain.tracker->counters;
    cJSON *object = cJSON_CreateObject();

    cJSON_AddNumberToObject(object, "scans", (double)counts->steps);
    cJSON_AddNumberToObject(object, "plots", (double)counts->plots);
    cJSON_AddNumberToObject(object, "frames", (double)counts->frames);
    cJSON_AddNumberToObject(object, "frames_incomplete", (double)counts->frames_incomplete);
    cJSON_AddNumberToObject(object, "rows_skipped", (double)counts->rows_skipped);
    cJSON_AddNumberToObject(object, "tracks_confirmed", counters->tracks_confirmed);
    cJSON_AddItemToObject(object, "fates", fates_json(counters));
    cJSON_AddNumberToObject(object, "mean_us", mean_us(tracking, counts));
    cJSON_AddNumberToObject(object, "max_us", (double)tracking->max_us);
    cJSON_AddNumberToObject(object, "state_bytes", (double)count_bytes(tracking, inputs));
    cJSON_AddItemToObject(object, "counters", counters_json(counters));
    json_print(object);
}

/* Where there are bearings alone, what is customary with them holds for the tracks as well. */
static void open_chain(struct tracking *tracking, const struct inputs *inputs,
                       struct parameters *parameters)
{
    if (!inputs_have_plots(inputs)) {
        method_suggest(METHOD_PASSIVE, parameters);
    }
    chain_open(&tracking->chain, parameters);
    if (inputs_have_bearings(inputs)) {
        chain_open_passive(&tracking->chain, parameters);
    }
    describe_passive(tracking, inputs, parameters);
}

int command_track(struct command_line *line)
{
    bool has_file = line->output || !line->json;
    struct inputs *inputs;
    struct inputs_counts counts;
    struct tracks_output *tracks;
    struct tracking tracking = {.chain = chain_start()};

    chain_set_gate(&line->parameters, line->gate);
    inputs = inputs_open(line->arguments, line->num_arguments, &line->parameters, line->keep_going);
    open_chain(&tracking, inputs, &line->parameters);
    counts = inputs_counts(inputs);
    tracks = has_file ? tracks_output_open(line->output, line->covariance) : NULL;
    step_all(&tracking, inputs, counts.steps, tracks);
    tracks_output_close(tracks);
    print_summary(&tracking, &counts);
    if (line->json) {
        print_json(&tracking, inputs, &counts);
    }
    inputs_close(inputs);
    chain_free(&tracking.chain);
    return 0;
}
