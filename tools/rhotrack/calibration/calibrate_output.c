/* SPDX-License-Identifier: MIT */
#include "calibration/calibrate_output.h"

#include <cjson/cJSON.h>
#include <math.h>

#include "base/common.h"
#include "base/text_table.h"

/* Factors of the fastest and slowest observed speed that give v_max_mps and v_min_mps. */
#define FASTER 1.3
#define SLOWER 0.6
#define SPEED_SIGMAS 3.0
#define SPEED_MAX_LEAST_MPS 1.0

static const struct {
    const char *what, *unit, *json, *why_not;
} figure_kinds[NUM_CALIBRATE_KINDS] = {
    {"range noise", "m", "sigma_range_m",
     "fewer than four segments of tracks, or most are no parabolas"},
    {"azimuth noise", "rad", "sigma_azimuth_rad",
     "fewer than four segments of tracks, or most are no parabolas"},
    {"pd", "", "pd", "gate best looked at tracks fewer than 50 times"},
    {"clutter a turn", "plots", "clutter_plots", "fewer than six turns"},
    {"turn", "s", "turn_s", "fewer than seven turns"},
    {"fastest", "m/s", "fastest_mps", "nothing was tracked for 20 plots that surely moves"},
    {"slowest that moves", "m/s", "slowest_mps",
     "nothing was tracked for 20 plots that surely moves"},
};

static const char *figure_title(const struct calibrate_radar *of, int kind)
{
    return of->is_isotropic && kind == CALIBRATE_RANGE ? "noise, each axis"
                                                       : figure_kinds[kind].what;
}

/* Whether the figure exists for the radar: plots without a range have no azimuth noise. */
static bool has_radar_figure(const struct calibrate_radar *of, int kind)
{
    return !(of->is_isotropic && kind == CALIBRATE_AZIMUTH);
}

static const char *reason_of_unknown(const struct calibrate_radar *of, int kind)
{
    return of->has_bodies && (kind == CALIBRATE_RANGE || kind == CALIBRATE_AZIMUTH)
               ? "the extent of targets that give several plots hides it"
               : figure_kinds[kind].why_not;
}

bool calibrate_knows_noise_or_pd(const struct calibrate_result *result)
{
    for (size_t i = 0; i < result->num_radars; i++) {
        const struct calibrate_figure *figures = result->radars[i].figures;

        if (figures[CALIBRATE_RANGE].is_known || figures[CALIBRATE_PD].is_known) {
            return true;
        }
    }
    return false;
}

void calibrate_print(const struct calibrate_result *result, FILE *out)
{
    struct text_table table = text_table_start(2, "radar|what|value|sigma|unit");

    for (size_t i = 0; i < result->num_radars; i++) {
        const struct calibrate_radar *of = &result->radars[i];

        for (int kind = 0; kind < NUM_CALIBRATE_KINDS; kind++) {
            const struct calibrate_figure *figure = &of->figures[kind];

            if (figure->is_known) {
                text_table_add_row(&table, "%d|%s|%.4g|%.2g|%s", (int)of->sensor_id,
                                   figure_title(of, kind), figure->value, figure->sigma,
                                   figure_kinds[kind].unit);
            }
        }
    }
    text_table_print(&table, out);
    for (size_t i = 0; i < result->num_radars; i++) {
        const struct calibrate_radar *of = &result->radars[i];

        fprintf(out,
                "radar %d: %zu plots in %zu turns, %zu tracks, %zu segments of them (%zu more left "
                "out as no parabolas)",
                (int)of->sensor_id, of->plots, of->turns, of->tracks, of->segments,
                of->segments_left_out);
        if (of->num_innovations > 0) {
            fprintf(out, "; squared innovations by the noise as stated: %.2f of 1",
                    of->innovations);
        }
        fprintf(out, "\n");
        for (int kind = 0; kind < NUM_CALIBRATE_KINDS; kind++) {
            if (!of->figures[kind].is_known && has_radar_figure(of, kind)) {
                fprintf(out, "radar %d, %s: not known: %s\n", (int)of->sensor_id,
                        figure_title(of, kind), reason_of_unknown(of, kind));
            }
        }
    }
    text_table_free(&table);
    if (result->body.body_max_m > 0.0) {
        fprintf(out, "body_max_m %g: %.1f plots beside each track within %.3g m\n",
                result->body.body_max_m, result->body.plots, result->body.distance_m);
    }
}

void calibrate_print_json(const struct calibrate_result *result, uint64_t rows_skipped)
{
    cJSON *object = cJSON_CreateObject(), *radars = cJSON_AddArrayToObject(object, "radars");

    for (size_t i = 0; i < result->num_radars; i++) {
        const struct calibrate_radar *of = &result->radars[i];
        cJSON *radar = cJSON_CreateObject();

        cJSON_AddNumberToObject(radar, "sensor_id", of->sensor_id);
        cJSON_AddNumberToObject(radar, "scans", (double)of->scans);
        cJSON_AddNumberToObject(radar, "turns", (double)of->turns);
        cJSON_AddNumberToObject(radar, "plots", (double)of->plots);
        cJSON_AddNumberToObject(radar, "tracks", (double)of->tracks);
        cJSON_AddNumberToObject(radar, "pieces", (double)of->segments);
        cJSON_AddNumberToObject(radar, "pieces_left_out", (double)of->segments_left_out);
        for (int kind = 0; kind < NUM_CALIBRATE_KINDS; kind++) {
            const struct calibrate_figure *figure = &of->figures[kind];
            const char *name =
                of->is_isotropic && kind == CALIBRATE_RANGE ? "sigma_m" : figure_kinds[kind].json;
            cJSON *both = cJSON_AddObjectToObject(radar, name);

            json_add_number_or_null(both, "value", figure->is_known ? figure->value : NAN);
            json_add_number_or_null(both, "sigma", figure->is_known ? figure->sigma : NAN);
        }
        json_add_number_or_null(radar, "area_km2", of->area_km2);
        json_add_number_or_null(radar, "innovations", of->innovations);
        cJSON_AddNumberToObject(radar, "num_innovations", (double)of->num_innovations);
        cJSON_AddItemToArray(radars, radar);
    }
    if (result->body.body_max_m > 0.0) {
        cJSON_AddItemToObject(object, "found_body", found_body_json(&result->body));
    }
    cJSON_AddNumberToObject(object, "rows_skipped", (double)rows_skipped);
    json_print_and_delete(object);
}

/* ---- INI ---- */

/* Writes v_max_mps and v_min_mps for all radars: the observed speeds with a margin. */
static void write_speed_limits(const struct calibrate_result *result, FILE *out)
{
    double fastest = 0.0, slowest = 1e9;

    for (size_t i = 0; i < result->num_radars; i++) {
        const struct calibrate_figure *most = &result->radars[i].figures[CALIBRATE_FASTEST];
        const struct calibrate_figure *least = &result->radars[i].figures[CALIBRATE_SLOWEST];

        if (most->is_known) {
            fastest = fmax(fastest, FASTER * most->value + SPEED_SIGMAS * most->sigma);
            slowest = fmin(slowest, SLOWER * (least->value - SPEED_SIGMAS * least->sigma));
        }
    }
    if (fastest > 0.0) {
        fprintf(out,
                "# by targets' speeds, with %.1f times the fastest and %.1f times the slowest\n",
                FASTER, SLOWER);
        fprintf(out, "v_max_mps = %.4g\nv_min_mps = %.4g\n", fmax(fastest, SPEED_MAX_LEAST_MPS),
                fmax(fmin(slowest, fastest), 0.0));
    } else {
        fprintf(out, "# v_max_mps, v_min_mps: not known\n");
    }
}

static void write_figure(FILE *out, const struct calibrate_figure *figure, const char *name,
                         const char *line_prefix)
{
    if (figure->is_known) {
        fprintf(out, "# sigma %.2g\n%s%s = %.6g\n", figure->sigma, line_prefix, name,
                figure->value);
    } else if (figure->is_stated) {
        fprintf(out, "# as stated\n%s%s = %.4g\n", line_prefix, name, figure->value);
    } else {
        fprintf(out, "# %s: not known\n", name);
    }
}

static void write_radar_section(const struct calibrate_radar *of, FILE *out)
{
    struct calibrate_figure pd = of->figures[CALIBRATE_PD];

    pd.value = fmin(fmax(pd.value, 0.01), 0.999);
    fprintf(out, "\n[sensor %d]\n", (int)of->sensor_id);
    write_figure(out, &of->figures[CALIBRATE_RANGE], of->is_isotropic ? "sigma_m" : "sigma_range_m",
                 "");
    if (!of->is_isotropic) {
        write_figure(out, &of->figures[CALIBRATE_AZIMUTH], "sigma_azimuth_rad", "");
    }
    write_figure(out, &pd, "pd", "");
    write_figure(out, &of->figures[CALIBRATE_TURN], "turn_s", "# ");
    write_figure(out, &of->figures[CALIBRATE_CLUTTER], "clutter plots a turn", "# ");
    if (of->figures[CALIBRATE_CLUTTER].is_known && of->area_km2 > 0.0) {
        fprintf(out, "# that is %.3g a km^2, on %.4g km^2\n",
                of->figures[CALIBRATE_CLUTTER].value / of->area_km2, of->area_km2);
    }
}

void calibrate_write_ini(const struct calibrate_result *result, const char *path)
{
    struct output output = output_open(path);

    fprintf(output.file, "# found by rhotrack calibrate; each with its sigma\n");
    write_speed_limits(result, output.file);
    if (result->body.body_max_m > 0.0) {
        fprintf(output.file, "# %.1f plots beside each track within %.3g m\nbody_max_m = %g\n",
                result->body.plots, result->body.distance_m, result->body.body_max_m);
    }
    for (size_t i = 0; i < result->num_radars; i++) {
        write_radar_section(&result->radars[i], output.file);
    }
    output_close(&output);
}
