/* SPDX-License-Identifier: MIT */
#include "evaluation/evaluation_output.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/common.h"
#include "base/text_table.h"
#include "evaluation/evaluation_figures.h"
#include "evaluation/evaluation_state.h"
#include "io/csv/tracks_writer.h"

static void print_targets(const struct evaluation *e, FILE *file)
{
    size_t count;
    struct evaluation_target *targets = evaluation_results_by_target(e, &count);
    struct text_table table =
        text_table_start(0, "target|first s|last s|found s|kept until s|completeness|"
                            "switches|fragments|rmse m|median m|95 % m|rmse m/s|nees");
    for (size_t i = 0; i < count; i++) {
        const struct evaluation_target *t = &targets[i];
        char found_s[TEXT_TABLE_NUMBER], until_s[TEXT_TABLE_NUMBER], texts[5][TEXT_TABLE_NUMBER];
        bool is_found = t->paired > 0;
        text_table_add_row(
            &table, "%d|%.1f|%.1f|%s|%s|%.3f|%zu|%zu|%s|%s|%s|%s|%s", t->id,
            (double)t->first_us * 1e-6, (double)t->last_us * 1e-6,
            text_table_number_or_dash(found_s, 1, is_found ? (double)t->found_us * 1e-6 : NAN),
            text_table_number_or_dash(until_s, 1, is_found ? (double)t->kept_until_us * 1e-6 : NAN),
            (double)t->paired / (double)t->scans, t->switches, t->fragments,
            text_table_number_or_dash(texts[0], 1, t->errors.rmse_m),
            text_table_number_or_dash(texts[1], 1, t->errors.median_m),
            text_table_number_or_dash(texts[2], 1, t->errors.p95_m),
            text_table_number_or_dash(texts[3], 2, t->errors.rmse_mps),
            text_table_number_or_dash(texts[4], 2, t->errors.nees));
    }
    fputc('\n', file);
    text_table_print(&table, file);
    text_table_free(&table);
    free(targets);
}

static const char *const motion_names[EVALUATION_MOTIONS] = {
    [EVALUATION_STRAIGHT] = "straight",
    [EVALUATION_TURNING] = "turning",
    [EVALUATION_COASTING] = "coasting",
};

/* Adds a row with the errors of one motion to the table. */
static void add_errors_row_of_motion_kind(struct text_table *table, const char *name,
                                          const struct evaluation_errors *of)
{
    char texts[6][TEXT_TABLE_NUMBER];
    text_table_add_row(table, "%s|%zu|%s|%s|%s|%s|%s|%s", name, of->pairs,
                       text_table_number_or_dash(texts[0], 1, of->rmse_m),
                       text_table_number_or_dash(texts[1], 2, of->rmse_mps),
                       text_table_number_or_dash(texts[2], 2, of->nees / EVALUATION_AXES),
                       text_table_number_or_dash(texts[3], 3, of->nees_inside),
                       text_table_number_or_dash(texts[4], 2, of->velocity_ratio),
                       text_table_number_or_dash(texts[5], 3, of->velocity_inside));
}

/*
 * Prints a table of errors by motion. Where covariances are right, ratios are 1 and shares inside
 * the 95 % ellipse are 0.95.
 */
static void print_errors_by_motion(const struct evaluation_result *result, FILE *file)
{
    struct text_table table = text_table_start(
        1, "pairs|number|rmse m|rmse m/s|place ratio|inside|velocity ratio|inside");
    for (int i = 0; i < EVALUATION_MOTIONS; i++) {
        add_errors_row_of_motion_kind(&table, motion_names[i], &result->by_motion[i]);
    }
    add_errors_row_of_motion_kind(&table, "all", &result->errors);
    fputc('\n', file);
    text_table_print(&table, file);
    text_table_free(&table);
}

void evaluation_print(const struct evaluation *e, bool by_target)
{
    struct evaluation_result result = evaluation_result(e);
    struct evaluation_figures figures = evaluation_figures_overall(&result);
    struct output output = output_open(NULL);
    for (size_t i = 0; i < figures.count; i++) {
        double value = figures.list[i].value;
        int digits = fabs(value) < 1e5 ? 6 : 10; /* large counts and times are not rounded */
        if (isfinite(value)) {
            fprintf(output.file, "%-22s %12.*g\n", figures.list[i].name, digits, value);
        } else {
            fprintf(output.file, "%-22s %12s\n", figures.list[i].name, "-");
        }
    }
    print_errors_by_motion(&result, output.file);
    if (by_target) {
        print_targets(e, output.file);
    }
    output_close(&output);
}

static cJSON *figures_json(const struct evaluation_figures *figures)
{
    cJSON *object = cJSON_CreateObject();
    for (size_t i = 0; i < figures->count; i++) {
        json_add_number_or_null(object, figures->list[i].name, figures->list[i].value);
    }
    return object;
}

static cJSON *motions_json(const struct evaluation_result *result)
{
    cJSON *object = cJSON_CreateObject();
    for (int i = 0; i < EVALUATION_MOTIONS; i++) {
        struct evaluation_figures figures = evaluation_motion_figures(&result->by_motion[i]);
        cJSON_AddItemToObject(object, motion_names[i], figures_json(&figures));
    }
    return object;
}

static cJSON *targets_json(const struct evaluation *e)
{
    size_t count;
    struct evaluation_target *targets = evaluation_results_by_target(e, &count);
    cJSON *list = cJSON_CreateArray();
    for (size_t i = 0; i < count; i++) {
        struct evaluation_figures figures = evaluation_figures_target(&targets[i]);
        cJSON_AddItemToArray(list, figures_json(&figures));
    }
    free(targets);
    return list;
}

static cJSON *figures_over_time_json(const struct evaluation *e)
{
    size_t count;
    const struct evaluation_scan *scans = evaluation_results_over_time(e, &count);
    cJSON *list = cJSON_CreateArray();
    for (size_t i = 0; i < count; i++) {
        struct evaluation_figures figures = evaluation_figures_scan(&scans[i]);
        cJSON_AddItemToArray(list, figures_json(&figures));
    }
    return list;
}

void evaluation_print_json(const struct evaluation *e)
{
    struct evaluation_result result = evaluation_result(e);
    struct evaluation_figures figures = evaluation_figures_overall(&result);
    cJSON *object = figures_json(&figures);
    cJSON_AddItemToObject(object, "by_motion", motions_json(&result));
    cJSON_AddItemToObject(object, "by_target", targets_json(e));
    cJSON_AddItemToObject(object, "over_time", figures_over_time_json(e));
    json_print_and_delete(object);
}

static void write_time_row(FILE *file, const struct evaluation_scan *scan)
{
    struct evaluation_figures figures = evaluation_figures_scan(scan);
    tracks_write_time(file, scan->time_us);
    for (size_t i = 1; i < figures.count; i++) {
        if (isfinite(figures.list[i].value)) {
            fprintf(file, ",%.9g", figures.list[i].value);
        } else {
            fputc(',', file);
        }
    }
    fputc('\n', file);
}

void evaluation_write_csv_over_time(const struct evaluation *e, const char *path)
{
    const struct evaluation_scan none = {0};
    struct evaluation_figures head = evaluation_figures_scan(&none);
    struct output output = output_open(path);
    size_t count;
    const struct evaluation_scan *scans = evaluation_results_over_time(e, &count);
    for (size_t i = 0; i < head.count; i++) {
        fprintf(output.file, "%s%s", i == 0 ? "" : ",", head.list[i].name);
    }
    fputc('\n', output.file);
    for (size_t i = 0; i < count; i++) {
        write_time_row(output.file, &scans[i]);
    }
    output_close(&output);
}
