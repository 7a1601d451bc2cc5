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

static uint64_t read_scans_counting_bad_rows(const struct command_line *line,
                                             struct register_data *data)
{
    struct merged_inputs *inputs = merged_inputs_open(line->arguments, line->num_arguments,
                                                      &line->parameters, line->keep_going);
    struct progress progress = progress_start("scans", 0);
    uint64_t done = 0, skipped;

    if (merged_inputs_have_bearings(inputs)) {
        fail(EXIT_USAGE, "calibrate takes plots, not bearings");
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
    struct calibrate_result result;
    uint64_t rows_skipped;

    command_line_check_ini_output(line, "calibrate");
    pipeline_options_to_parameters(&line->parameters,
                                   &(struct pipeline_options){.gate = line->gate});
    rows_skipped = read_scans_counting_bad_rows(line, data);
    if (register_num_radars(data) == 0) {
        fail(EXIT_USAGE, "calibrate: the input has no plots");
    }
    result = calibrate(data, &pipeline);
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
