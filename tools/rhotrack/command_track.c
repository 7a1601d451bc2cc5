/* SPDX-License-Identifier: MIT */
/* track: runs the whole pipeline on files: scans in, tracks out. */
#include <cjson/cJSON.h>
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/common.h"
#include "base/state_file.h"
#include "command_line.h"
#include "commands.h"
#include "initiation/last_bearings.h"
#include "io/output/clutter_map_file.h"
#include "io/output/tracks_output.h"
#include "io/output/zone_output.h"
#include "io/scans/bearing_reader.h"
#include "io/scans/merged_inputs.h"
#include "io/scans/plot_reader.h"
#include "next_command.h"
#include "pipeline/hidden_turns.h"
#include "pipeline/learned_report.h"
#include "pipeline/no_tracks_reason.h"
#include "pipeline/pipeline.h"
#include "pipeline/pipeline_show.h"
#include "pipeline/plots_beside_tracks.h"
#include "settings/initiation_methods.h"

struct tracking {
    struct pipeline pipeline;
    const struct parameters *parameters;
    struct pipeline_show *show; /* messages of --show; NULL: none */
    struct clutter_map_file clutter;
    struct zone_events_output zones;
    struct no_tracks seen;
    struct plots_beside_tracks beside;
    int64_t sum_us, max_us;
};

/*
 * Describes all passive sensors at the start; exit 2 where bearings of sensors
 * so many or so far apart cannot be searched.
 */
static void check_and_set_passive_sensors(struct tracking *tracking,
                                          const struct merged_inputs *inputs,
                                          const struct parameters *parameters)
{
    size_t count;
    const struct frame_sensor *sensors = merged_inputs_passive_sensors(inputs, &count);

    if (count > 0) {
        struct parameters customary = *parameters;

        method_suggest_parameters(METHOD_PASSIVE, &customary);
        bearing_sensors_check(sensors, count, &tracking->pipeline.node->passive.batch, &customary);
    }
    for (size_t i = 0; i < count; i++) {
        struct rho_sensor sensor;

        if (parameters_to_sensor(parameters, sensors[i].sensor_id, &sensor)) {
            sensor.x_m = sensors[i].x_m;
            sensor.y_m = sensors[i].y_m;
            sensor.range_max_m = (float)parameters_range_max_m(parameters, sensors[i].sensor_id);
            must_set_sensor(&tracking->pipeline.node->tracker, &sensor);
        }
    }
}

static void write_zone_events(void *context)
{
    struct tracking *tracking = context;

    if (pipeline_zones(&tracking->pipeline)) {
        zone_events_output_write(&tracking->zones, pipeline_zones(&tracking->pipeline));
    }
}

static void step_and_time_input(struct tracking *tracking, const struct input *input)
{
    int64_t start_us, took_us;

    if (input->sensor) {
        must_set_sensor(&tracking->pipeline.node->tracker, input->sensor);
    }
    start_us = monotonic_clock_us();
    if (input->scan) {
        no_tracks_reason_add_scan(&tracking->seen, input->scan);
        pipeline_step(&tracking->pipeline, input->scan);
        write_zone_events(tracking);
    } else {
        pipeline_step_frame(&tracking->pipeline, input->frame, write_zone_events, tracking);
    }
    took_us = monotonic_clock_us() - start_us;
    tracking->sum_us += took_us;
    if (took_us > tracking->max_us) {
        tracking->max_us = took_us;
    }
}

/* Destination of --show messages: the log of the tracks, at the time of the step. */
struct shown {
    struct tracks_output *tracks;
    int64_t time_us;
};

static void write_show_message(void *context, const char *channel, const uint8_t *data, size_t size)
{
    const struct shown *shown = context;

    tracks_output_log_message(shown->tracks, shown->time_us, channel, data, size);
}

/* Whether a body is to be looked for: nobody told its length. */
static bool is_body_sought(const struct tracking *tracking)
{
    return !(tracking->parameters->value[PARAMETER_BODY_MAX_M] > 0.0);
}

static void step_and_write_input(struct tracking *tracking, const struct input *input,
                                 struct tracks_output *tracks)
{
    step_and_time_input(tracking, input);
    if (input->scan && is_body_sought(tracking)) {
        plots_beside_tracks_add_scan(&tracking->beside, input->scan,
                                     &tracking->pipeline.node->report);
    }
    if (tracks) {
        tracks_output_write_report(tracks, &tracking->pipeline.node->report);
    }
    if (tracking->show) {
        struct shown shown = {tracks, tracking->pipeline.node->report.time_us};
        const struct pipeline_show_output output = {&shown, write_show_message};

        pipeline_show_step(tracking->show, &tracking->pipeline, input->frame != NULL,
                           tracks_output_step_number(tracks), tracks_output_epoch(), shown.time_us,
                           &output);
    }
}

/* Steps and writes all inputs; shows progress unless the tracks are written on the terminal. */
static void step_and_write_all_inputs(struct tracking *tracking, struct merged_inputs *inputs,
                                      struct tracks_output *tracks, bool are_tracks_on_terminal)
{
    struct progress progress = progress_start("scans", 0);
    uint64_t done = 0;

    for (struct input input = merged_inputs_next(inputs); input.scan || input.frame;
         input = merged_inputs_next(inputs)) {
        step_and_write_input(tracking, &input, tracks);
        done++;
        if (!are_tracks_on_terminal) {
            progress_show_by_bytes(&progress, done, merged_inputs_bytes_read(inputs),
                                   merged_inputs_total_bytes(inputs));
        }
    }
    progress_end(&progress);
}

static volatile sig_atomic_t is_stopped;

static void on_stop_signal(int number)
{
    (void)number;
    is_stopped = 1;
}

static void stop_at_signal_unless_ignored(int number)
{
    struct sigaction action = {.sa_handler = on_stop_signal};

    if (!is_signal_ignored(number)) {
        sigaction(number, &action, NULL);
    }
}

/* Steps all scans that are complete by now; returns whether there were any. */
static bool step_complete_scans(struct tracking *tracking, struct merged_inputs *inputs,
                                struct tracks_output *tracks)
{
    struct input input = {.scan = NULL};
    bool has_any = false;

    while (!is_stopped && (input = merged_inputs_next(inputs)).scan) {
        step_and_write_input(tracking, &input, tracks);
        if (tracks) {
            tracks_output_flush(tracks);
        }
        has_any = true;
    }
    return has_any;
}

/*
 * Steps scans as the file grows, until a signal, the end of a pipe, or the end of the file. Returns
 * why the file ended ("has become shorter"), or NULL.
 */
static const char *track_growing_file(struct tracking *tracking, struct merged_inputs *inputs,
                                      struct tracks_output *tracks, int64_t quiet_us)
{
    const struct timespec pause = {.tv_nsec = 100000000};
    struct plot_reader *reader = merged_inputs_scan_reader(inputs);
    uint64_t position = 0;
    int64_t since_us = monotonic_clock_us();
    const char *why = NULL;

    while (!is_stopped) {
        (void)clutter_map_file_save_if_due(&tracking->clutter,
                                           &tracking->pipeline.node->tracker.clutter_map);
        why = plot_reader_why_not_followed(
            reader); /* rows added before the file ended are still read */
        if (step_complete_scans(tracking, inputs, tracks) ||
            position != merged_inputs_bytes_read(inputs) || plot_reader_is_mid_row(reader)) {
            since_us = monotonic_clock_us();
            position = merged_inputs_bytes_read(inputs);
        }
        if (why || !plot_reader_waits(reader)) {
            break;
        }
        if (monotonic_clock_us() - since_us >= quiet_us) {
            plot_reader_complete_scans(reader);
        }
        nanosleep(&pause, NULL);
    }
    return why;
}

/*
 * Quiet time after which the last scan is complete: follow_quiet_s plus the spread of the sensors'
 * time biases, as scans wait for sensors whose clocks are behind.
 */
static int64_t follow_quiet_us(const struct parameters *parameters)
{
    int32_t least_us, largest_us;

    parameters_time_bias_range_us(parameters, &least_us, &largest_us);
    return llround(parameters->value[PARAMETER_FOLLOW_QUIET_S] * 1e6) +
           ((int64_t)largest_us - least_us);
}

/* Tracks a growing input to its end; scans still incomplete at the end are stepped as they are. */
static const char *follow_input(struct tracking *tracking, struct merged_inputs *inputs,
                                struct tracks_output *tracks, const struct parameters *parameters)
{
    struct input input;
    const char *why;

    stop_at_signal_unless_ignored(SIGINT);
    stop_at_signal_unless_ignored(SIGTERM);
    if (tracks) {
        tracks_output_flush(tracks);
    }
    why = track_growing_file(tracking, inputs, tracks, follow_quiet_us(parameters));
    plot_reader_end_reading(merged_inputs_scan_reader(inputs));
    while ((input = merged_inputs_next(inputs)).scan) {
        step_and_write_input(tracking, &input, tracks);
    }
    return why;
}

static double mean_step_us(const struct tracking *tracking,
                           const struct merged_inputs_counts *counts)
{
    return counts->steps ? (double)tracking->sum_us / (double)counts->steps : 0;
}

/* Names the parameter that, if increased, would let late scans be used; "" where none can be. */
static const char *advice_on_late_scans(const struct parameters *parameters, uint32_t num_too_late)
{
    if (parameters->value[PARAMETER_HOLD_MS] < parameters_text(PARAMETER_HOLD_MS).max) {
        return "; hold_ms waits longer";
    }
    return num_too_late > 0 && parameters->value[PARAMETER_LATE_MAX_S] <
                                   parameters_text(PARAMETER_LATE_MAX_S).max
               ? "; late_max_s takes older ones"
               : "";
}

static void print_summary(const struct tracking *tracking,
                          const struct merged_inputs_counts *counts,
                          const struct parameters *parameters)
{
    const struct rho_tracker_counters *counters = &tracking->pipeline.node->tracker.counters;
    const struct rho_tracker_work *work = &tracking->pipeline.node->tracker.work;

    fprintf(stderr,
            "rhotrack: %" PRIu64 " scans, %" PRIu64 " plots, %" PRIu32 " tracks confirmed; lost: "
            "%" PRIu32 " invalid, %" PRIu32 " stale, %" PRIu32 " no room",
            counts->steps, counts->plots, counters->tracks_confirmed,
            counters->fates[RHO_FATE_INVALID], counters->fates[RHO_FATE_STALE],
            counters->fates[RHO_FATE_NO_ROOM]);
    if (counters->scans_late + counters->scans_retrodicted > 0) {
        fprintf(stderr, " (scans: %" PRIu32 " late, used for tracks alone, %" PRIu32 " too late%s)",
                counters->scans_retrodicted, counters->scans_late,
                advice_on_late_scans(parameters, counters->scans_late));
    }
    /* where all do, sensors look at times of their own */
    if (counts->frames_incomplete > 0 && counts->frames_incomplete < counts->frames) {
        fprintf(stderr, ", %" PRIu64 " frames miss a sensor", counts->frames_incomplete);
    }
    if (counters->tracks_too_fast > 0) {
        fprintf(stderr, ", %" PRIu32 " tracks ended, faster than v_max_mps=%g",
                counters->tracks_too_fast, parameters->value[PARAMETER_V_MAX_MPS]);
    }
    if (counts->rows_skipped) {
        fprintf(stderr, ", %" PRIu64 " bad rows skipped", counts->rows_skipped);
    }
    const struct rho_tracker *tracker = &tracking->pipeline.node->tracker;
    for (uint32_t i = 0; i < tracker->num_rows; i++) {
        if (tracker->sensors[i].look.is_suspect) {
            fprintf(stderr, ", sensor %" PRId32 " contradicts the others",
                    tracker->sensors[i].sensor.sensor_id);
        }
    }
    learned_report_print(&tracking->pipeline.node->tracker, pipeline_learning(&tracking->pipeline),
                         stderr);
    if (work->partial_steps > 0) {
        fprintf(stderr, ", in %" PRIu32 " scans work_max left out plots, %" PRIu32 " times",
                work->partial_steps, work->plots_not_tried);
    }
    if (work->partial_steps == 0 && counters->candidates_dropped > 0) {
        fprintf(stderr, ", candidates of tracks beyond the search's room or work: %" PRIu32,
                counters->candidates_dropped);
    }
    if (pipeline_show_num_not_sent(tracking->show) > 0) {
        fprintf(stderr, ", messages of --show beyond its rate: %" PRIu64,
                pipeline_show_num_not_sent(tracking->show));
    }
    fprintf(stderr, "; %.0f us a scan, %" PRId64 " at most\n", mean_step_us(tracking, counts),
            tracking->max_us);
}

/* Interval of the sensor that looks most often; 0: none has looked twice. */
static int64_t shortest_interval_us(const struct rho_tracker *tracker)
{
    double shortest_s = 0;

    for (uint32_t i = 0; i < tracker->num_rows; i++) {
        const double interval_s = (double)tracker->sensors[i].pace.interval_s;

        if (interval_s > 0 && !(shortest_s > 0 && shortest_s < interval_s)) {
            shortest_s = interval_s;
        }
    }
    return llround(1e6 * shortest_s);
}

static cJSON *plot_fates_json(const struct rho_tracker_counters *counters)
{
    cJSON *object = cJSON_CreateObject();

    for (int i = 0; i < RHO_NUM_FATES; i++) {
        cJSON_AddNumberToObject(object, rho_fate_name((enum rho_fate)i), counters->fates[i]);
    }
    return object;
}

static cJSON *counters_json(const struct rho_tracker *tracker)
{
    const struct rho_tracker_counters *counters = &tracker->counters;
    cJSON *object = cJSON_CreateObject();

    cJSON_AddNumberToObject(object, "scans_accepted", counters->scans_accepted);
    cJSON_AddNumberToObject(object, "scans_late", counters->scans_late);
    cJSON_AddNumberToObject(object, "scans_retrodicted", counters->scans_retrodicted);
    cJSON_AddNumberToObject(object, "sensors_doubted", counters->sensors_suspected);
    cJSON_AddNumberToObject(object, "plots_outside", counters->plots_outside);
    cJSON_AddNumberToObject(object, "plots_initiated", counters->plots_initiated);
    cJSON_AddNumberToObject(object, "plots_clutter", counters->plots_clutter);
    cJSON_AddNumberToObject(object, "tracks_started", counters->tracks_started);
    cJSON_AddNumberToObject(object, "tracks_ended", counters->tracks_ended);
    cJSON_AddNumberToObject(object, "tracks_unseen", counters->tracks_unseen);
    cJSON_AddNumberToObject(object, "tracks_too_fast", counters->tracks_too_fast);
    cJSON_AddNumberToObject(object, "tracks_no_room", counters->tracks_no_room);
    cJSON_AddNumberToObject(object, "gate_plots_dropped", counters->gate_plots_dropped);
    cJSON_AddNumberToObject(object, "candidates_dropped", counters->candidates_dropped);
    cJSON_AddNumberToObject(object, "updates_refused", counters->updates_refused);
    cJSON_AddNumberToObject(object, "hypotheses_cut", counters->hypotheses_cut);
    cJSON_AddNumberToObject(object, "echoes_dropped", tracker->clutter_map.echoes_dropped);
    return object;
}

static cJSON *sensor_health_json(const struct rho_tracker *tracker)
{
    cJSON *list = cJSON_CreateArray();

    for (uint32_t i = 0; i < tracker->num_rows; i++) {
        const struct rho_tracker_look *look = &tracker->sensors[i].look;

        if (look->count == 0) {
            continue; /* a sensor of bearings, or one that was never heard */
        }
        cJSON *object = cJSON_CreateObject();
        cJSON_AddNumberToObject(object, "sensor_id", tracker->sensors[i].sensor.sensor_id);
        cJSON_AddNumberToObject(object, "seen_share", (double)look->seen_share);
        cJSON_AddNumberToObject(object, "distance2", (double)look->distance2);
        cJSON_AddBoolToObject(object, "is_doubted", look->is_suspect);
        cJSON_AddItemToArray(list, object);
    }
    return list;
}

/* The origin of the local frame as JSON; null where it has none on the earth. */
static cJSON *origin_json(const struct parameters *parameters)
{
    cJSON *object;

    if (!parameters_has_origin(parameters)) {
        return cJSON_CreateNull();
    }
    object = cJSON_CreateObject();
    cJSON_AddNumberToObject(object, "lat_deg", parameters->value[PARAMETER_ORIGIN_LAT_DEG]);
    cJSON_AddNumberToObject(object, "lon_deg", parameters->value[PARAMETER_ORIGIN_LON_DEG]);
    cJSON_AddNumberToObject(object, "alt_m", parameters->value[PARAMETER_ORIGIN_ALT_M]);
    return object;
}

static size_t state_memory_bytes(const struct tracking *tracking,
                                 const struct merged_inputs *inputs)
{
    return sizeof tracking->pipeline.node->tracker +
           (merged_inputs_have_plots(inputs)
                ? tracking->pipeline.node->windows.count * sizeof(struct rho_initiator)
                : 0) +
           (merged_inputs_have_bearings(inputs) ? sizeof tracking->pipeline.node->passive : 0);
}

/* Number of known echoes in the clutter map. */
static double count_known_echoes(const struct rho_clutter_map *map)
{
    uint32_t place = 0;
    double num = 0.0;

    while (rho_clutter_map_next_known(map, &place)) {
        num += 1.0;
    }
    return num;
}

static void print_run_json(const struct tracking *tracking, const struct merged_inputs *inputs,
                           const struct merged_inputs_counts *counts,
                           const struct parameters *parameters, const struct found_body *body)
{
    const struct rho_tracker_counters *counters = &tracking->pipeline.node->tracker.counters;
    cJSON *object = cJSON_CreateObject();

    cJSON_AddNumberToObject(object, "scans", (double)counts->steps);
    cJSON_AddNumberToObject(object, "plots", (double)counts->plots);
    cJSON_AddNumberToObject(object, "frames", (double)counts->frames);
    cJSON_AddNumberToObject(object, "frames_incomplete", (double)counts->frames_incomplete);
    cJSON_AddNumberToObject(object, "rows_skipped", (double)counts->rows_skipped);
    cJSON_AddNumberToObject(object, "tracks_confirmed", counters->tracks_confirmed);
    cJSON_AddItemToObject(object, "fates", plot_fates_json(counters));
    cJSON_AddNumberToObject(object, "mean_us", mean_step_us(tracking, counts));
    cJSON_AddNumberToObject(object, "max_us", (double)tracking->max_us);
    cJSON_AddNumberToObject(object, "state_bytes", (double)state_memory_bytes(tracking, inputs));
    json_add_work(object, &tracking->pipeline.node->tracker.work);
    cJSON_AddItemToObject(object, "counters", counters_json(&tracking->pipeline.node->tracker));
    cJSON_AddNumberToObject(object, "echoes_known",
                            count_known_echoes(&tracking->pipeline.node->tracker.clutter_map));
    cJSON_AddNumberToObject(
        object, "echoes_standing",
        learned_report_num_standing(&tracking->pipeline.node->tracker.clutter_map));
    cJSON_AddItemToObject(object, "sensors", sensor_health_json(&tracking->pipeline.node->tracker));
    cJSON_AddItemToObject(object, "learned",
                          learned_report_sensors_json(&tracking->pipeline.node->tracker));
    cJSON_AddItemToObject(object, "life",
                          learned_report_life_json(&tracking->pipeline.node->tracker));
    if (learned_report_num_walls(pipeline_learning(&tracking->pipeline)) > 0) {
        cJSON_AddItemToObject(object, "learned_reflectors",
                              learned_report_walls_json(pipeline_learning(&tracking->pipeline)));
    }
    if (body->body_max_m > 0.0) {
        cJSON_AddItemToObject(object, "found_body", found_body_json(body));
    }
    cJSON_AddItemToObject(object, "origin", origin_json(parameters));
    if (pipeline_zones(&tracking->pipeline)) {
        cJSON_AddItemToObject(object, "zones",
                              zones_counts_json(pipeline_zones(&tracking->pipeline)));
    }
    json_print_and_delete(object);
}

/*
 * Opens the pipeline. Without plots, the customary parameters for bearings hold for tracks as well.
 */
static void open_pipeline(struct tracking *tracking, const struct merged_inputs *inputs,
                          struct parameters *parameters)
{
    if (!merged_inputs_have_plots(inputs)) {
        method_suggest_parameters(METHOD_PASSIVE, parameters);
    }
    pipeline_open(&tracking->pipeline, parameters);
    if (merged_inputs_have_bearings(inputs)) {
        size_t count;
        const struct frame_sensor *sensors = merged_inputs_passive_sensors(inputs, &count);

        parameters->passive_apart_m = bearing_sensors_max_distance_m(sensors, count);
        pipeline_open_passive(&tracking->pipeline, parameters);
    }
    check_and_set_passive_sensors(tracking, inputs, parameters);
}

static struct merged_inputs *open_inputs(const struct command_line *line)
{
    if (!line->follow) {
        return merged_inputs_open(line->arguments, line->num_arguments, &line->parameters,
                                  line->keep_going);
    }
    if (line->num_arguments > 1) {
        fail(EXIT_USAGE, "--follow takes one input");
    }
    refuse_output_that_is_an_input(line); /* --follow writes the output in place */
    return merged_inputs_follow_plots(line->arguments[0], &line->parameters, line->keep_going);
}

static struct tracks_output *open_tracks_output(const struct command_line *line)
{
    if (!line->output && line->json) {
        return NULL;
    }
    return line->follow
               ? tracks_output_open_in_place(line->output, &line->parameters, line->covariance)
               : tracks_output_open(line->output, &line->parameters, line->covariance);
}

static struct zone_events_output open_zone_events_output(const struct command_line *line)
{
    if (line->zone_events && line->parameters.num_zones == 0) {
        fail(EXIT_USAGE, "--zone-events: no zone is set; a --config file has them as [zone N] with "
                         "corners_m = x y, x y, x y");
    }
    return zone_events_output_open(line->zone_events);
}

static void print_summary_zones_and_json(const struct tracking *tracking,
                                         const struct merged_inputs *inputs,
                                         const struct command_line *line)
{
    struct merged_inputs_counts counts = merged_inputs_counts(inputs);
    struct found_body body = {0.0, 0.0, 0.0};

    if (is_body_sought(tracking)) {
        body = plots_beside_tracks_find_body(&tracking->beside);
    }
    print_summary(tracking, &counts, &line->parameters);
    hidden_turns_print(shortest_interval_us(&tracking->pipeline.node->tracker), 2,
                       &line->parameters, stderr);
    if (tracking->pipeline.node->tracker.counters.tracks_confirmed == 0 && counts.frames == 0) {
        no_tracks_reason_print(&tracking->seen, &tracking->pipeline.node->tracker,
                               &line->parameters, stderr);
    }
    if (body.body_max_m > 0.0) {
        fprintf(stderr, "rhotrack: %.1f plots beside each track within %.3g m: body_max_m=%g?\n",
                body.plots, body.distance_m, body.body_max_m);
    }
    if (pipeline_zones(&tracking->pipeline)) {
        zones_print_counts(pipeline_zones(&tracking->pipeline));
    }
    if (line->json) {
        print_run_json(tracking, inputs, &counts, &line->parameters, &body);
    }
}

/*
 * Suggests evaluate where a truth.csv stands beside the plots, else a page of the tracks. Notes a
 * scenario.ini beside the plots that was not used.
 */
static void suggest_after_track(const struct command_line *line)
{
    const char *plots = line->arguments[0];
    char *truth = next_command_find_beside(plots, "truth.csv");
    char *config = next_command_find_beside(plots, "scenario.ini");

    if (config && line->num_settings == 0 && isatty(STDERR_FILENO)) {
        fprintf(stderr, "rhotrack: %s is beside the plots but was not used (--config)\n", config);
    }
    if (line->output && path_ends_with(line->output, ".csv") && truth &&
        next_command_can_read(line, truth)) {
        next_command_print(line, (const char *[]){"evaluate", truth, line->output, NULL});
    } else if (line->output && path_ends_with(line->output, ".csv") && strcmp(plots, "-") != 0) {
        next_command_print_page(line, line->arguments, line->num_arguments, line->output);
    }
    free(truth);
    free(config);
}

int command_track(struct command_line *line)
{
    struct tracking tracking = {.pipeline = pipeline_allocate(), .parameters = &line->parameters};
    struct merged_inputs *inputs;
    struct tracks_output *tracks;
    const char *why = NULL;
    bool is_saved, has_tracks;

    pipeline_options_to_parameters(
        &line->parameters, &(struct pipeline_options){line->gate, line->method, line->pipeline});
    for (int i = 0; i < line->num_arguments; i++) {
        state_file_refuse_same(line->clutter_map, "clutter map", line->arguments[i], "input");
    }
    state_file_refuse_same(line->clutter_map, "clutter map", line->output, "output");
    if (line->show && !tracks_output_path_is_log(line->output)) {
        fail(EXIT_USAGE, "--show writes messages: it needs -o NAME.lcm");
    }
    tracking.show = pipeline_show_open(line->show, &line->parameters);
    inputs = open_inputs(line);
    open_pipeline(&tracking, inputs, &line->parameters);
    tracking.clutter = clutter_map_file_open(line->clutter_map, &line->parameters,
                                             &tracking.pipeline.node->tracker.clutter_map);
    tracks = open_tracks_output(line);
    if (tracks && line->parameters.value[PARAMETER_BODY_MAX_M] > 0.0) {
        tracks_output_add_body_columns(tracks, &tracking.pipeline.node->tracker);
    }
    tracking.zones = open_zone_events_output(line);
    if (line->follow) {
        why = follow_input(&tracking, inputs, tracks, &line->parameters);
    } else {
        step_and_write_all_inputs(&tracking, inputs, tracks,
                                  !line->output && isatty(STDOUT_FILENO));
    }
    tracks_output_close(tracks);
    zone_events_output_close(&tracking.zones);
    is_saved =
        clutter_map_file_save(&tracking.clutter, &tracking.pipeline.node->tracker.clutter_map);
    print_summary_zones_and_json(&tracking, inputs, line);
    has_tracks = tracking.pipeline.node->tracker.counters.tracks_confirmed > 0;
    merged_inputs_close(inputs);
    pipeline_show_close(tracking.show);
    pipeline_free(&tracking.pipeline);
    if (why) {
        fail(EXIT_RUNTIME, "%s %s: --follow ends", line->arguments[0], why);
    }
    if (has_tracks) {
        suggest_after_track(line);
    }
    return is_saved ? 0 : EXIT_RUNTIME;
}
