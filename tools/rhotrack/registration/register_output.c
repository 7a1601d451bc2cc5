/* SPDX-License-Identifier: MIT */
#include "registration/register_output.h"

#include <cjson/cJSON.h>
#include <math.h>

#include "base/common.h"
#include "base/text_table.h"

#define DEG_RAD 0.017453292519943295

static const struct {
    const char *what, *parameter, *json, *json_sigma, *unit;
} bias_kinds[NUM_REGISTER_KINDS] = {
    {"range", "range_bias_m", "range_bias_m", "range_bias_sigma_m", "m"},
    {"azimuth", "azimuth_bias_rad", "azimuth_bias_rad", "azimuth_bias_sigma_rad", "rad"},
    {"time", "time_bias_s", "time_bias_s", "time_bias_sigma_s", "s"},
};

/* Whether the bias is the time bias of the reference radar, which is taken as known. */
static bool is_reference_time_bias(const struct register_result *result, size_t radar, size_t kind)
{
    return radar == result->reference && kind == REGISTER_TIME;
}

bool register_knows_any_bias(const struct register_result *result)
{
    for (size_t i = 0; i < result->num_radars; i++) {
        for (size_t kind = 0; kind < NUM_REGISTER_KINDS; kind++) {
            if (result->radars[i].biases[kind].is_known &&
                !is_reference_time_bias(result, i, kind)) {
                return true;
            }
        }
    }
    return false;
}

static void add_bias_row(struct text_table *table, const struct register_result *result,
                         size_t radar)
{
    const struct register_radar *of = &result->radars[radar];
    static const int digits[NUM_REGISTER_KINDS] = {1, 4, 4};
    char texts[2 * NUM_REGISTER_KINDS][TEXT_TABLE_NUMBER];
    const char *cells[2 * NUM_REGISTER_KINDS];

    for (size_t kind = 0; kind < NUM_REGISTER_KINDS; kind++) {
        const struct register_bias *bias = &of->biases[kind];
        double factor = kind == REGISTER_AZIMUTH ? 1.0 / DEG_RAD : 1.0;
        bool is_taken = is_reference_time_bias(result, radar, kind);
        double value = bias->is_known || is_taken ? factor * bias->value : NAN;
        double sigma = bias->is_known && !is_taken ? factor * bias->sigma : NAN;

        cells[2 * kind] = text_table_number_or_dash(texts[2 * kind], digits[kind], value);
        cells[2 * kind + 1] = text_table_number_or_dash(texts[2 * kind + 1], digits[kind], sigma);
    }
    text_table_add_row(table, "%d|%zu|%zu|%zu|%s|%s|%s|%s|%s|%s", (int)of->sensor_id, of->plots,
                       of->tracks, of->common_plots, cells[0], cells[1], cells[2], cells[3],
                       cells[4], cells[5]);
}

/* Prints each bias that is not known, with the reason. */
static void print_unknown_biases(const struct register_result *result, FILE *out)
{
    for (size_t i = 0; i < result->num_radars; i++) {
        const struct register_radar *of = &result->radars[i];

        if (of->common_plots == 0) {
            fprintf(out, "radar %d: not known, as it has no target in common with another\n",
                    (int)of->sensor_id);
            continue;
        }
        for (size_t kind = 0; kind < NUM_REGISTER_KINDS; kind++) {
            if (!of->biases[kind].is_known && !is_reference_time_bias(result, i, kind)) {
                fprintf(out,
                        "radar %d, %s: not known; its sigma of %.3g %s is beyond half of a plot's "
                        "noise: too "
                        "few targets, or all in one place or direction\n",
                        (int)of->sensor_id, bias_kinds[kind].what, of->biases[kind].sigma,
                        bias_kinds[kind].unit);
            }
        }
    }
}

void register_print(const struct register_result *result, FILE *out)
{
    struct text_table table =
        text_table_start(0, "radar|plots|tracks|in common|range bias m|sigma|azimuth bias "
                            "deg|sigma|time bias s|sigma");

    for (size_t i = 0; i < result->num_radars; i++) {
        add_bias_row(&table, result, i);
    }
    text_table_print(&table, out);
    fprintf(out,
            "\n%zu targets in common, %zu plots in %zu segments of their paths (%zu more left out "
            "as no "
            "parabolas); the plots' noise is %.2f of what their sigmas say\n",
            result->targets, result->plots, result->segments, result->segments_left_out,
            result->misfit);
    fprintf(out,
            "the time of radar %d counts as right: plots tell differences of time alone; azimuths "
            "counter-clockwise\n",
            (int)result->radars[result->reference].sensor_id);
    print_unknown_biases(result, out);
    text_table_free(&table);
}

static cJSON *radar_biases_json(const struct register_result *result, size_t radar)
{
    const struct register_radar *of = &result->radars[radar];
    cJSON *object = cJSON_CreateObject();

    cJSON_AddNumberToObject(object, "sensor_id", of->sensor_id);
    cJSON_AddNumberToObject(object, "scans", (double)of->scans);
    cJSON_AddNumberToObject(object, "plots", (double)of->plots);
    cJSON_AddNumberToObject(object, "tracks", (double)of->tracks);
    cJSON_AddNumberToObject(object, "common_plots", (double)of->common_plots);
    for (size_t kind = 0; kind < NUM_REGISTER_KINDS; kind++) {
        const struct register_bias *bias = &of->biases[kind];
        bool is_shown = bias->is_known || is_reference_time_bias(result, radar, kind);

        json_add_number_or_null(object, bias_kinds[kind].json, is_shown ? bias->value : NAN);
        json_add_number_or_null(object, bias_kinds[kind].json_sigma,
                                of->common_plots > 0 ? bias->sigma : NAN);
    }
    return object;
}

void register_print_json(const struct register_result *result, uint64_t rows_skipped)
{
    cJSON *object = cJSON_CreateObject(), *radars = cJSON_AddArrayToObject(object, "radars");

    for (size_t i = 0; i < result->num_radars; i++) {
        cJSON_AddItemToArray(radars, radar_biases_json(result, i));
    }
    cJSON_AddNumberToObject(object, "reference_sensor",
                            result->radars[result->reference].sensor_id);
    cJSON_AddNumberToObject(object, "targets", (double)result->targets);
    cJSON_AddNumberToObject(object, "pieces", (double)result->segments);
    cJSON_AddNumberToObject(object, "pieces_left_out", (double)result->segments_left_out);
    cJSON_AddNumberToObject(object, "plots", (double)result->plots);
    cJSON_AddNumberToObject(object, "misfit", result->misfit);
    cJSON_AddNumberToObject(object, "rounds", (double)result->rounds);
    cJSON_AddNumberToObject(object, "rows_skipped", (double)rows_skipped);
    json_print_and_delete(object);
}

void register_write_ini(const struct register_result *result, const char *path)
{
    struct output output = output_open(path);

    fprintf(output.file, "# biases from %zu common targets; the time of radar %d counts as right\n",
            result->targets, (int)result->radars[result->reference].sensor_id);
    for (size_t i = 0; i < result->num_radars; i++) {
        const struct register_radar *of = &result->radars[i];

        fprintf(output.file, "\n[sensor %d]\n", (int)of->sensor_id);
        for (size_t kind = 0; kind < NUM_REGISTER_KINDS; kind++) {
            const struct register_bias *bias = &of->biases[kind];

            if (is_reference_time_bias(result, i, kind)) {
                fprintf(output.file, "%s = %.9f\n", bias_kinds[kind].parameter, bias->value);
            } else if (bias->is_known) {
                fprintf(output.file, "# sigma %.9f\n%s = %.9f\n", bias->sigma,
                        bias_kinds[kind].parameter, bias->value);
            } else {
                fprintf(output.file, "# %s: not known\n", bias_kinds[kind].parameter);
            }
        }
    }
    output_close(&output);
}
