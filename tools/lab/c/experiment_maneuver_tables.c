/* SPDX-License-Identifier: MIT */
#include <math.h>

#include "base/common.h"
#include "experiment_maneuver_report.h"

#define TEXT GRID_NUMBER

/* ---- numbers as text ------------------------------------------------------------------------- */

/* "measured/reference". */
static const char *beside(char text[TEXT], int digits, double value, double reference)
{
    char measured[TEXT], expected[TEXT];
    snprintf(text, TEXT, "%.20s%s%.20s", grid_number(measured, digits, value),
             isnan(reference) ? "" : "/",
             isnan(reference) ? "" : grid_number(expected, digits, reference));
    return text;
}

/* "-21..21". */
static const char *span(char text[TEXT], const struct maneuver_summary *summary)
{
    snprintf(text, TEXT, "%.0f..%.0f", summary->least_mps, summary->most_mps);
    return text;
}

/* ---- centred on the truth -------------------------------------------------------------------- */

static void add_paper_row(struct grid *grid, const char *first, const char *method,
                          const struct maneuver_summary *is,
                          const struct maneuver_reference *reference)
{
    char text[6][TEXT];
    grid_row(grid, "%s|%s|%s|%s|%s|%s|%s|%s", first, method,
             beside(text[0], 1, 100.0 * is->inside, 100.0 * reference->inside),
             beside(text[1], 3, 100.0 * is->wrong, 100.0 * reference->wrong),
             beside(text[2], 0, is->most_off_m, reference->most_off_m),
             beside(text[3], 2, is->rms_m, reference->rms_m), grid_number(text[4], 2, is->rms_mps),
             span(text[5], is));
}

#define PAPER_HEAD "|method|inside %|wrong %|most m|rms m|rms m/s|extreme m/s"

struct grid maneuver_paper_grid(const struct maneuver_report *report)
{
    struct grid grid = grid_start(2, "clutter" PAPER_HEAD);
    for (size_t i = 0; i < report->paper.num_cases; i++) {
        const struct maneuver_case *of = &report->paper.cases[i];
        for (size_t method = 0; method < of->num_methods; method++) {
            add_paper_row(&grid, method == 0 ? of->name : "", of->methods[method].name,
                          &report->paper.by_method[i][method],
                          &maneuver_paper_references[i][method]);
        }
    }
    return grid;
}

struct grid maneuver_noise_grid(const struct maneuver_report *report)
{
    struct grid grid = grid_start(2, "filter's Q" PAPER_HEAD);
    const struct maneuver_case *of = &report->noise.cases[0];
    for (size_t method = 0; method < of->num_methods; method++) {
        char text[TEXT];
        snprintf(text, TEXT, "%g I", maneuver_noises[method / MANEUVER_NOISE_METHODS]);
        add_paper_row(&grid, method % MANEUVER_NOISE_METHODS == 0 ? text : "",
                      of->methods[method].name, &report->noise.by_method[0][method],
                      &maneuver_noise_references[method]);
    }
    return grid;
}

/* ---- the beam follows the prediction --------------------------------------------------------- */

struct grid maneuver_lost_grid(const struct maneuver_report *report)
{
    struct grid grid = grid_start(1, "g, sigma m, clutter, P_D|default|IMM, true plots|clairvoyant|"
                                     "paper|nearest|hypotheses");
    for (size_t i = 0; i < report->closed.num_cases; i++) {
        const struct maneuver_case *of = &report->closed.cases[i];
        const struct maneuver_summary *is = report->closed.by_method[i];
        const struct maneuver_lost_reference *reference = &maneuver_lost_references[i];
        bool has_paper = of->num_methods > MANEUVER_CLOSED_PAPER;
        char text[6][TEXT];
        grid_row(
            &grid, "%s|%s|%s|%s|%s|%s|%s", of->name,
            beside(text[0], 1, 100.0 * is[MANEUVER_CLOSED_DEFAULT].lost,
                   100.0 * reference->by_default),
            grid_number(text[1], 1, 100.0 * is[MANEUVER_CLOSED_IMM].lost),
            grid_number(text[2], 1, 100.0 * is[MANEUVER_CLOSED_ALL].lost),
            beside(text[3], 1, has_paper ? 100.0 * is[MANEUVER_CLOSED_PAPER].lost : NAN,
                   100.0 * reference->by_paper),
            grid_number(text[4], 1, has_paper ? 100.0 * is[MANEUVER_CLOSED_NEAREST].lost : NAN),
            grid_number(text[5], 1, is[MANEUVER_CLOSED_DEFAULT].hypotheses));
    }
    return grid;
}

struct grid maneuver_error_grid(const struct maneuver_report *report)
{
    struct grid grid = grid_start(1, "g, sigma m, clutter, P_D|default rms m|m/s|over the IMM|m/s|"
                                     "clairvoyant rms m|m/s|NIS a dimension|the IMM's");
    for (size_t i = 0; i < report->closed.num_cases; i++) {
        const struct maneuver_summary *is = report->closed.by_method[i];
        const struct maneuver_summary *best = &is[MANEUVER_CLOSED_DEFAULT];
        char text[8][TEXT];
        grid_row(&grid, "%s|%s|%s|%s|%s|%s|%s|%s|%s", report->closed.cases[i].name,
                 grid_number(text[0], 2, best->kept_rms_m),
                 grid_number(text[1], 2, best->kept_rms_mps),
                 grid_number(text[2], 3, best->imm_ratio),
                 grid_number(text[3], 3, best->imm_speed_ratio),
                 grid_number(text[4], 2, is[MANEUVER_CLOSED_ALL].kept_rms_m),
                 grid_number(text[5], 2, is[MANEUVER_CLOSED_ALL].kept_rms_mps),
                 grid_number(text[6], 3, best->nis),
                 grid_number(text[7], 3, is[MANEUVER_CLOSED_IMM].nis));
    }
    return grid;
}

struct grid maneuver_pd_grid(const struct maneuver_report *report)
{
    struct grid grid = grid_start(0, "assumed P_D|lost %|rms m|rms m/s|NIS a dimension");
    const struct maneuver_case *of = &report->pd.cases[0];
    for (size_t method = 0; method < of->num_methods; method++) {
        const struct maneuver_summary *is = &report->pd.by_method[0][method];
        char text[4][TEXT];
        grid_row(&grid, "%s|%s|%s|%s|%s", of->methods[method].name,
                 beside(text[0], 1, 100.0 * is->lost, 100.0 * maneuver_pd_references[method]),
                 grid_number(text[1], 2, is->kept_rms_m), grid_number(text[2], 2, is->kept_rms_mps),
                 grid_number(text[3], 3, is->nis));
    }
    return grid;
}

/* ---- the terminal ---------------------------------------------------------------------------- */

static void print_grid(const char *title, struct grid grid)
{
    printf("%s\n\n", title);
    grid_print(&grid, stdout);
    printf("\n");
    grid_free(&grid);
}

void maneuver_report_print(const struct maneuver_report *report)
{
    printf("Targets that manoeuvre in clutter, 161 scans of 0.25 s, seed %llu; "
           "measured/reference\n\n",
           (unsigned long long)report->seed);
    print_grid("Clutter around the truth, 10 g, places and velocities, Q = R = I",
               maneuver_paper_grid(report));
    print_grid("The same, pop-up, 4 clutter plots, true process noise 1e-4 I",
               maneuver_noise_grid(report));
    print_grid("The beam follows the prediction: % lost", maneuver_lost_grid(report));
    print_grid("The same, errors of the kept tracks", maneuver_error_grid(report));
    print_grid("The default with 10 g, 10 m, 10 clutter plots, P_D .9, told another P_D",
               maneuver_pd_grid(report));
    verdicts_print(&report->verdicts, stdout);
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static void add_setting(cJSON *object, const struct maneuver_setting *of)
{
    static const char *const sensors[] = {"places", "places and velocities", "polar", "polar 3-D"};
    static const char *const beams[] = {"truth", "prediction", "all round"};
    cJSON_AddStringToObject(object, "profile", maneuver_profile_names[of->profile]);
    json_add_number(object, "pull_g", of->pull_g);
    cJSON_AddStringToObject(object, "sensor", sensors[of->sensor]);
    json_add_number(object, "sigma_m", of->sigma_m);
    json_add_number(object, "sigma_mps", of->sigma_mps);
    json_add_number(object, "sigma_rad", of->sigma_rad);
    json_add_number(object, "clutter", of->clutter);
    json_add_number(object, "pd", of->pd);
    cJSON_AddStringToObject(object, "beam", beams[of->beam]);
    json_add_number(object, "accel_max_g", of->accel_max_g);
}

static cJSON *summary_json(const struct maneuver_method *method, const struct maneuver_summary *is)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "method", method->name);
    if (method->kind == MANEUVER_LIBRARY) {
        json_add_number(object, "gamma", method->gamma);
        json_add_number(object, "filter_noise", method->filter_noise);
    }
    json_add_number(object, "inside", is->inside);
    json_add_number(object, "first_inside", is->first_inside);
    json_add_number(object, "lost", is->lost);
    json_add_number(object, "wrong", is->wrong);
    json_add_number(object, "most_off_m", is->most_off_m);
    json_add_number(object, "rms_m", is->rms_m);
    json_add_number(object, "rms_mps", is->rms_mps);
    json_add_number(object, "least_mps", is->least_mps);
    json_add_number(object, "most_mps", is->most_mps);
    json_add_number(object, "kept_rms_m", is->kept_rms_m);
    json_add_number(object, "kept_rms_mps", is->kept_rms_mps);
    json_add_number(object, "rms_over_imm", is->imm_ratio);
    json_add_number(object, "rms_mps_over_imm", is->imm_speed_ratio);
    json_add_number(object, "nis_per_dimension", is->nis);
    json_add_number(object, "hypotheses", is->hypotheses);
    json_add_number(object, "refused", (double)is->refused);
    return object;
}

static void add_table(cJSON *root, const char *name, const struct maneuver_table *table)
{
    cJSON *list = cJSON_AddArrayToObject(root, name);
    for (size_t i = 0; i < table->num_cases; i++) {
        cJSON *object = cJSON_CreateObject();
        cJSON_AddStringToObject(object, "case", table->cases[i].name);
        add_setting(object, &table->cases[i].setting);
        json_add_number(object, "runs", (double)table->runs[i]);
        cJSON *methods = cJSON_AddArrayToObject(object, "methods");
        for (size_t method = 0; method < table->cases[i].num_methods; method++) {
            cJSON_AddItemToArray(methods, summary_json(&table->cases[i].methods[method],
                                                       &table->by_method[i][method]));
        }
        cJSON_AddItemToArray(list, object);
    }
}

cJSON *maneuver_report_json(struct maneuver_report *report)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "experiment", "maneuver");
    cJSON_AddNumberToObject(root, "seed", (double)report->seed);
    add_table(root, "paper", &report->paper);
    add_table(root, "process_noise", &report->noise);
    add_table(root, "closed_loop", &report->closed);
    add_table(root, "assumed_pd", &report->pd);
    verdicts_to_json(&report->verdicts, root);
    return root;
}
