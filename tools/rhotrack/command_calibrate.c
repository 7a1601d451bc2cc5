/* SPDX-License-Identifier: MIT */
/*
 * calibrate: estimates noise, pd, clutter, turn time and target speeds of radars from a recording.
 */

#include "base/common.h"
#include "calibration/calibrate_noise.h"
#include "calibration/calibrate_output.h"
#include "command_line.h"
#include "commands.h"
#include "io/scans/merged_inputs.h"
#include "registration/register_data.h"

/*
 * Reads the scans; where beside is not NULL, tracks them as `track` does for it, up to the first
 * scan of a radar beyond those for which the tracker has room.
 */
static uint64_t read_scans_counting_bad_rows(const struct command_line *line,
                                             struct register_data *data, struct pipeline *pipeline,
                                             struct plots_beside_tracks *beside)
{
    struct merged_inputs *inputs = merged_inputs_open(line->arguments, line->num_arguments,
                                                      &line->parameters, line->keep_going);
    struct progress progress = progress_start("scans", 0);
    uint64_t done = 0, skipped;

    if (merged_inputs_have_bearings(inputs)) {
        fail(EXIT_USAGE, "calibrate takes plots, not bearings");
    }
    if (beside) {
        pipeline_open(pipeline, &line->parameters);
    }
    for (struct input input = merged_inputs_next(inputs); input.scan;
         input = merged_inputs_next(inputs)) {
        struct rho_sensor sensor;

        if (input.sensor) {
            sensor = *input.sensor;
        } else {
            parameters_sensor_or_default(&line->parameters, input.scan->sensor_id, &sensor);
        }
        register_add_unchecked_scan(data, input.scan, &sensor);
        if (beside && register_num_radars(data) <= RHO_MAX_SENSORS) {
            if (input.sensor) {
                must_set_sensor(&pipeline->node->tracker, input.sensor);
            }
            pipeline_step(pipeline, input.scan);
            plots_beside_tracks_add_scan(beside, input.scan, &pipeline->node->report);
        }
        progress_show_by_bytes(&progress, ++done, merged_inputs_bytes_read(inputs),
                               merged_inputs_total_bytes(inputs));
    }
    progress_end(&progress);
    skipped = merged_inputs_counts(inputs).rows_skipped;
    merged_inputs_close(inputs);
    return skipped;
}

static void print_calibration(const struct command_line *line,
                              const struct calibrate_result *result, uint64_t rows_skipped)
{
    struct output output;

    if (line->json) {
        calibrate_print_json(result, rows_skipped);
    } else if (is_output_explicitly_stdout(line)) {
        calibrate_print(result, stderr);
    } else {
        output = output_open(NULL);
        calibrate_print(result, output.file);
        output_close(&output);
    }
    print_rows_skipped(rows_skipped);
}

int command_calibrate(struct command_line *line)
{
    struct register_data *data = register_start(&line->parameters);
    struct pipeline pipeline = pipeline_allocate();
    struct plots_beside_tracks beside = {.looks = 0};
    struct calibrate_result result;
    struct found_body body = {0.0, 0.0, 0.0};
    bool is_body_told;
    uint64_t rows_skipped;

    command_line_check_ini_output(line, "calibrate");
    pipeline_options_to_parameters(&line->parameters,
                                   &(struct pipeline_options){.gate = line->gate});
    is_body_told = line->parameters.value[PARAMETER_BODY_MAX_M] > 0.0;
    rows_skipped =
        read_scans_counting_bad_rows(line, data, &pipeline, is_body_told ? NULL : &beside);
    if (register_num_radars(data) == 0) {
        fail(EXIT_USAGE, "calibrate: the input has no plots");
    }
    if (!is_body_told && register_num_radars(data) <= RHO_MAX_SENSORS) {
        body = plots_beside_tracks_find_body(&beside);
        line->parameters.value[PARAMETER_BODY_MAX_M] = body.body_max_m;
    }
    result = calibrate(data, &pipeline);
    result.body = body;
    print_calibration(line, &result, rows_skipped);
    if (!calibrate_knows_noise_or_pd(&result)) {
        fail(EXIT_RUNTIME, "calibrate: too few tracks to estimate noise "
                           "or pd of any radar");
    }
    if (line->output) {
        calibrate_write_ini(&result, line->output);
    }
    calibrate_result_free(&result);
    register_free(data);
    pipeline_free(&pipeline);
    return 0;
}
