/* SPDX-License-Identifier: MIT */
/* register: estimates the biases of radars from targets that several of them see. */
#include <stdlib.h>

#include "base/common.h"
#include "command_line.h"
#include "commands.h"
#include "io/scans/merged_inputs.h"
#include "pipeline/pipeline.h"
#include "registration/register.h"
#include "registration/register_output.h"

/* A radar without a place is assumed at the origin, which is acceptable for one radar only. */
struct unplaced {
    bool is_any;
    int32_t sensor_id;
};

static void add_scan_or_fail(struct register_data *data, const struct input *input,
                             const struct parameters *parameters, struct unplaced *unplaced)
{
    struct rho_sensor sensor;
    const char *wrong;

    if (input->sensor) {
        sensor = *input->sensor;
    } else {
        parameters_sensor_or_default(parameters, input->scan->sensor_id, &sensor);
        if (unplaced->is_any && unplaced->sensor_id != sensor.sensor_id) {
            fail(EXIT_USAGE,
                 "register: radars %d and %d have no known place; give columns sensor_x_m and "
                 "sensor_y_m, or sensor.N.x_m and sensor.N.y_m",
                 (int)unplaced->sensor_id, (int)sensor.sensor_id);
        }
        *unplaced = (struct unplaced){.is_any = true, .sensor_id = sensor.sensor_id};
    }
    wrong = register_add_scan(data, input->scan, &sensor);
    if (wrong) {
        fail(EXIT_USAGE, "register: sensor %d: %s", (int)sensor.sensor_id, wrong);
    }
}

static uint64_t read_scans_counting_bad_rows(const struct command_line *line,
                                             struct register_data *data)
{
    struct merged_inputs *inputs = merged_inputs_open(line->arguments, line->num_arguments,
                                                      &line->parameters, line->keep_going);
    struct progress progress = progress_start("scans", 0);
    struct unplaced unplaced = {.is_any = false};
    uint64_t done = 0, skipped;

    if (merged_inputs_have_bearings(inputs)) {
        fail(EXIT_USAGE, "register takes plots in range and azimuth, not bearings");
    }
    for (struct input input = merged_inputs_next(inputs); input.scan;
         input = merged_inputs_next(inputs)) {
        add_scan_or_fail(data, &input, &line->parameters, &unplaced);
        progress_show_by_bytes(&progress, ++done, merged_inputs_bytes_read(inputs),
                               merged_inputs_total_bytes(inputs));
    }
    progress_end(&progress);
    skipped = merged_inputs_counts(inputs).rows_skipped;
    merged_inputs_close(inputs);
    return skipped;
}

static void print_biases(const struct command_line *line, const struct register_result *result,
                         uint64_t rows_skipped)
{
    struct output output;

    if (line->json) {
        register_print_json(result, rows_skipped);
    } else if (is_output_explicitly_stdout(line)) {
        register_print(result, stderr);
    } else {
        output = output_open(NULL);
        register_print(result, output.file);
        output_close(&output);
    }
    print_rows_skipped(rows_skipped);
}

int command_register(struct command_line *line)
{
    struct register_data *data = register_start(&line->parameters);
    struct pipeline pipeline = pipeline_allocate();
    struct register_result result;
    uint64_t rows_skipped;

    command_line_check_ini_output(line, "register");
    pipeline_options_to_parameters(&line->parameters,
                                   &(struct pipeline_options){.gate = line->gate});
    rows_skipped = read_scans_counting_bad_rows(line, data);
    if (register_num_radars(data) == 0) {
        fail(EXIT_USAGE, "register: the input has no plots");
    }
    if (register_num_radars(data) == 1) {
        fail(EXIT_USAGE,
             "register: the input has only one radar; biases need targets that two or more see");
    }
    result = register_estimate_biases(data, &pipeline);
    if (result.targets == 0) {
        fail(EXIT_RUNTIME, "register: no target was tracked by two radars at the same time, within "
                           "3 km; the biases are unknown");
    }
    print_biases(line, &result, rows_skipped);
    if (!register_knows_any_bias(&result)) {
        fail(EXIT_RUNTIME,
             "register: %zu common targets are too few to know any bias to half of a plot's noise",
             result.targets);
    }
    if (line->output) {
        register_write_ini(&result, line->output);
    }
    register_result_free(&result);
    register_free(data);
    pipeline_free(&pipeline);
    return 0;
}
