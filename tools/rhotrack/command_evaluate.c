/* SPDX-License-Identifier: MIT */
/* evaluate: tracks against truth. */
#include <cjson/cJSON.h>
#include <math.h>
#include <string.h>

#include "commands.h"
#include "common.h"
#include "evaluation.h"
#include "evaluation_input.h"
#include "log_table.h"
#include "table.h"

struct figure {
    const char *name;
    double value; /* NAN: null */
};

#define NUM_FIGURES 28

static void fill_figures(const struct evaluation_result *r, struct figure figures[NUM_FIGURES])
{
    const struct figure all[NUM_FIGURES] = {
        {"gospa_m", r->gospa_m},
        {"gospa_localisation_m", r->gospa_localisation_m},
        {"gospa_missed", r->gospa_missed},
        {"gospa_false", r->gospa_false},
        {"ospa_m", r->ospa_m},
        {"completeness", r->completeness},
        {"false_per_scan", r->false_per_scan},
        {"false_per_hour", r->false_per_hour},
        {"switches", (double)r->switches},
        {"fragments", (double)r->fragments},
        {"delay_scans", r->delay_scans},
        {"delay_s", r->delay_s},
        {"rmse_m", r->errors.rmse_m},
        {"median_m", r->errors.median_m},
        {"p95_m", r->errors.p95_m},
        {"rmse_mps", r->errors.rmse_mps},
        {"median_mps", r->errors.median_mps},
        {"p95_mps", r->errors.p95_mps},
        {"nees", r->errors.nees},
        {"nees_inside", r->errors.nees_inside},
        {"targets", (double)r->targets},
        {"targets_found", (double)r->targets_found},
        {"tracks", (double)r->tracks},
        {"false_tracks", (double)r->false_tracks},
        {"pairs", (double)r->errors.pairs},
        {"scans", (double)r->scans},
        {"first_s", (double)r->first_us * 1e-6},
        {"last_s", (double)r->last_us * 1e-6},
    };
    memcpy(figures, all, sizeof all);
}

static void print_figures(const struct figure *figures, bool as_json)
{
    cJSON *object = as_json ? cJSON_CreateObject() : NULL;
    for (size_t i = 0; i < NUM_FIGURES; i++) {
        if (as_json) {
            json_add_number(object, figures[i].name, figures[i].value);
        } else if (isfinite(figures[i].value)) {
            printf("%-22s %12.6g\n", figures[i].name, figures[i].value);
        } else {
            printf("%-22s %12s\n", figures[i].name, "-");
        }
    }
    if (as_json) {
        json_print(object);
    }
}

int command_evaluate(struct command_line *line)
{
    if (line->num_arguments != 2) {
        fail(EXIT_USAGE, "evaluate: give a truth file and a tracks file");
    }
    struct table *truth = log_table_or_csv(line->arguments[0], &rows_kind_truth, line->keep_going);
    struct table *tracks =
        log_table_or_csv(line->arguments[1], &rows_kind_tracks, line->keep_going);
    table_need_rows(truth);
    struct evaluation *e =
        evaluation_read(truth, tracks, line->parameters.value[PARAMETER_GOSPA_CUTOFF_M]);
    struct evaluation_result result = evaluation_result(e);
    struct figure figures[NUM_FIGURES];
    fill_figures(&result, figures);
    print_figures(figures, line->json);
    evaluation_free(e);
    table_free(truth);
    table_free(tracks);
    return 0;
}
