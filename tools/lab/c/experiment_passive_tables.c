/* SPDX-License-Identifier: MIT */
#include <math.h>

#include "base/common.h"
#include "experiment_passive_report.h"

#define TEXT GRID_NUMBER
#define RAD_DEG 57.29577951308232

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

/* ---- the tables ------------------------------------------------------------------------------ */

struct grid passive_pruning_grid(const struct passive_report *report)
{
    struct grid grid = grid_start(1, "pruning alone|ghosts: eliminated|literal|safe|"
                                     "targets: eliminated|literal|safe");
    for (size_t i = 0; i < passive_num_pruning_cases; i++) {
        const struct passive_pruned *measured = report->pruning[i].by_rule;
        const struct passive_pruned *reference = passive_pruning_cases[i].reference;
        char ghosts[PASSIVE_RULES][TEXT], targets[PASSIVE_RULES][TEXT];
        for (int rule = 0; rule < PASSIVE_RULES; rule++) {
            beside(ghosts[rule], 3, measured[rule].ghosts, reference[rule].ghosts);
            beside(targets[rule], 4, measured[rule].targets, reference[rule].targets);
        }
        grid_row(&grid, "%s|%s|%s|%s|%s|%s|%s", passive_pruning_cases[i].name, ghosts[0], ghosts[1],
                 ghosts[2], targets[0], targets[1], targets[2]);
    }
    return grid;
}

static void add_paper_row(struct grid *grid, const struct passive_paper_case *of, int rule,
                          const struct passive_found *found)
{
    const struct passive_found *reference = &of->reference[rule];
    char share[TEXT], ghosts[TEXT], exact[TEXT];
    grid_row(grid, "%s|%s|%u of %d|%s|%s|%s", of->name, passive_rule_names[rule], of->votes_min,
             PASSIVE_SCANS, beside(share, 3, found->share, reference->share),
             beside(ghosts, 2, found->ghosts_a_run, reference->ghosts_a_run),
             beside(exact, 2, found->exact, reference->exact));
}

struct grid passive_paper_grid(const struct passive_report *report)
{
    struct grid grid = grid_start(2, "the paper's method|pruning|T|Pd|ghosts a run|exact");
    for (size_t i = 0; i < passive_num_paper_cases; i++) {
        for (int rule = 0; rule < PASSIVE_RULES; rule++) {
            if (passive_paper_cases[i].has_rule[rule]) {
                add_paper_row(&grid, &passive_paper_cases[i], rule,
                              &report->paper[i].by_rule[rule]);
            }
        }
    }
    return grid;
}

struct grid passive_figures_grid(const struct passive_report *report)
{
    struct grid grid = grid_start(3, "figures|sensors|pruning|target crossings|ghosts|T|"
                                     "targets' lines|ghosts' lines");
    for (size_t i = 0; i < PASSIVE_FIGURES; i++) {
        const struct passive_figure *of = &report->figures[i];
        grid_row(&grid, "%s|%s|%s|%zu|%zu|%u of %d|%zu|%zu", of->figures, of->sensors,
                 passive_rule_names[of->rule], of->crossings, of->ghosts, of->votes_min,
                 PASSIVE_SCANS, of->lines.found, of->lines.ghosts);
    }
    return grid;
}

struct grid passive_default_grid(const struct passive_report *report)
{
    struct grid grid = grid_start(1, "the default|Pd|ghosts a run|exact|rms km|fit's|ratio|"
                                     "theta deg|fit's|rho km|fit's|NEES|own's|mixed|ms");
    for (size_t i = 0; i < passive_num_default_cases; i++) {
        const struct passive_default_case *of = &passive_default_cases[i];
        const struct passive_default_summary *is = &report->defaults[i];
        double own = (double)is->own_nees.count / (double)is->nees.count;
        char text[14][TEXT];
        grid_row(&grid, "%s|%s|%s|%s|%s|%s|%s|%s|%s|%s|%s|%s|%s|%s|%s", of->name,
                 beside(text[0], 3, is->found.share, of->reference.share),
                 beside(text[1], 3, is->found.ghosts_a_run, of->reference.ghosts_a_run),
                 beside(text[2], 2, is->found.exact, of->reference.exact),
                 beside(text[3], 3, is->rms_m / 1e3, of->reference_rms_m / 1e3),
                 grid_number(text[4], 3, is->fit_rms_m / 1e3),
                 grid_number(text[5], 3, is->rms_m / is->fit_rms_m),
                 grid_number(text[6], 2, is->line_off.theta_rad * RAD_DEG),
                 grid_number(text[7], 2, is->fit_line_off.theta_rad * RAD_DEG),
                 grid_number(text[8], 3, is->line_off.rho_m / 1e3),
                 grid_number(text[9], 3, is->fit_line_off.rho_m / 1e3),
                 grid_number(text[10], 2, is->nees.mean),
                 grid_number(text[11], 2, is->own_nees.mean), grid_number(text[12], 3, 1.0 - own),
                 grid_number(text[13], 2, is->search_ms));
    }
    return grid;
}

const char *passive_nees_note(const struct passive_report *report, char text[PASSIVE_NOTE])
{
    snprintf(text, PASSIVE_NOTE,
             "NEES, 4 dimensions, of all cases but the base's extension: %.2f over %zu found; %.2f "
             "over the %zu with their own bearings alone; %.2f over the %zu of the clean cases.",
             report->nees.mean, report->nees.count, report->own_nees.mean, report->own_nees.count,
             report->clean_nees.mean, report->clean_nees.count);
    return text;
}

/* ---- the terminal ---------------------------------------------------------------------------- */

static void print_grid(struct grid grid)
{
    grid_print(&grid, stdout);
    printf("\n");
    grid_free(&grid);
}

void passive_report_print(const struct passive_report *report)
{
    printf("Bearings of passive sensors, 8 scans, seed %llu; measured/reference\n\n",
           (unsigned long long)report->seed);
    printf("%zu runs a case; shares of the ghosts that are removed, of the targets' crossings that "
           "are lost\n\n",
           report->pruning_runs);
    print_grid(passive_pruning_grid(report));
    if (report->paper != NULL) {
        printf("%zu runs a case\n\n", report->paper_runs);
        print_grid(passive_paper_grid(report));
        printf("Scenes of the figures: runs %d and %d of seed %d\n\n", PASSIVE_FIGURES_TWO_RUN,
               PASSIVE_FIGURES_THREE_RUN, PASSIVE_FIGURES_SEED);
        print_grid(passive_figures_grid(report));
    }
    if (report->defaults != NULL) {
        printf("%zu runs a case\n\n", report->default_runs);
        print_grid(passive_default_grid(report));
        char text[PASSIVE_NOTE];
        printf("%s\n\n", passive_nees_note(report, text));
        printf("%zu runs a case\n\n", report->chain_runs);
        print_grid(passive_chain_grid(report->chain));
    }
    verdicts_print(&report->verdicts, stdout);
}

/* ---- JSON ------------------------------------------------------------------------------------ */

/* What the case draws. */
static cJSON *case_json(const char *name, const struct passive_setting *setting)
{
    static const char *const regions[] = {"ahead", "base's extension", "near"};
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "case", name);
    json_add_number(object, "sensors", (double)setting->sensors);
    json_add_number(object, "targets", (double)setting->targets);
    json_add_number(object, "sigma_deg", setting->sigma_deg);
    json_add_number(object, "pd", setting->pd);
    json_add_number(object, "false_alarms", setting->false_mean);
    cJSON_AddStringToObject(object, "region", regions[setting->region]);
    cJSON_AddBoolToObject(object, "unequal_intervals", setting->has_unequal_intervals);
    return object;
}

static void add_found(cJSON *object, const struct passive_found *found,
                      const struct passive_found *reference)
{
    json_add_number(object, "found", found->share);
    json_add_number(object, "ghosts_per_run", found->ghosts_a_run);
    json_add_number(object, "exact", found->exact);
    json_add_number(object, "reference_found", reference->share);
    json_add_number(object, "reference_ghosts_per_run", reference->ghosts_a_run);
    json_add_number(object, "reference_exact", reference->exact);
}

static void add_pruning(cJSON *root, const struct passive_report *report)
{
    cJSON *list = cJSON_AddArrayToObject(root, "pruning");
    for (size_t i = 0; i < passive_num_pruning_cases; i++) {
        for (int rule = 0; rule < PASSIVE_RULES; rule++) {
            const struct passive_pruned *measured = &report->pruning[i].by_rule[rule];
            const struct passive_pruned *reference = &passive_pruning_cases[i].reference[rule];
            cJSON *object =
                case_json(passive_pruning_cases[i].name, &passive_pruning_cases[i].setting);
            cJSON_AddStringToObject(object, "rule", passive_rule_names[rule]);
            json_add_number(object, "ghosts_removed", measured->ghosts);
            json_add_number(object, "targets_lost", measured->targets);
            json_add_number(object, "reference_ghosts_removed", reference->ghosts);
            json_add_number(object, "reference_targets_lost", reference->targets);
            cJSON_AddItemToArray(list, object);
        }
    }
    json_add_number(root, "pruning_runs", (double)report->pruning_runs);
}

static void add_figures(cJSON *root, const struct passive_report *report)
{
    cJSON *list = cJSON_AddArrayToObject(root, "figures");
    for (size_t i = 0; i < PASSIVE_FIGURES; i++) {
        const struct passive_figure *of = &report->figures[i];
        cJSON *object = cJSON_CreateObject();
        cJSON_AddStringToObject(object, "figures", of->figures);
        cJSON_AddStringToObject(object, "sensors", of->sensors);
        cJSON_AddStringToObject(object, "rule", passive_rule_names[of->rule]);
        json_add_number(object, "target_crossings", (double)of->crossings);
        json_add_number(object, "ghosts", (double)of->ghosts);
        json_add_number(object, "votes_min", of->votes_min);
        json_add_number(object, "target_lines", (double)of->lines.found);
        json_add_number(object, "ghost_lines", (double)of->lines.ghosts);
        cJSON_AddItemToArray(list, object);
    }
}

static void add_paper(cJSON *root, const struct passive_report *report)
{
    cJSON *list = cJSON_AddArrayToObject(root, "paper");
    for (size_t i = 0; i < passive_num_paper_cases; i++) {
        const struct passive_paper_case *of = &passive_paper_cases[i];
        for (int rule = 0; rule < PASSIVE_RULES; rule++) {
            if (of->has_rule[rule]) {
                cJSON *object = case_json(of->name, &of->setting);
                cJSON_AddStringToObject(object, "rule", passive_rule_names[rule]);
                json_add_number(object, "votes_min", of->votes_min);
                add_found(object, &report->paper[i].by_rule[rule], &of->reference[rule]);
                cJSON_AddItemToArray(list, object);
            }
        }
    }
    json_add_number(root, "paper_runs", (double)report->paper_runs);
    add_figures(root, report);
}

static void add_nees(cJSON *object, const char *name, const struct passive_nees *nees)
{
    cJSON *of = cJSON_AddObjectToObject(object, name);
    json_add_number(of, "mean", nees->count > 0 ? nees->mean : NAN);
    json_add_number(of, "tracks", (double)nees->count);
}

static void add_default(cJSON *root, const struct passive_report *report)
{
    cJSON *list = cJSON_AddArrayToObject(root, "default");
    for (size_t i = 0; i < passive_num_default_cases; i++) {
        const struct passive_default_case *of = &passive_default_cases[i];
        const struct passive_default_summary *summary = &report->defaults[i];
        cJSON *object = case_json(of->name, &of->setting);
        add_found(object, &summary->found, &of->reference);
        json_add_number(object, "rms_m", summary->rms_m);
        json_add_number(object, "reference_rms_m", of->reference_rms_m);
        json_add_number(object, "fit_rms_m", summary->fit_rms_m);
        json_add_number(object, "rms_over_fit", summary->rms_m / summary->fit_rms_m);
        json_add_number(object, "theta_error_rad", summary->line_off.theta_rad);
        json_add_number(object, "fit_theta_error_rad", summary->fit_line_off.theta_rad);
        json_add_number(object, "rho_error_m", summary->line_off.rho_m);
        json_add_number(object, "fit_rho_error_m", summary->fit_line_off.rho_m);
        add_nees(object, "nees", &summary->nees);
        add_nees(object, "own_nees", &summary->own_nees);
        json_add_number(object, "search_ms", summary->search_ms);
        cJSON_AddItemToArray(list, object);
    }
    add_nees(root, "nees", &report->nees);
    add_nees(root, "own_nees", &report->own_nees);
    add_nees(root, "clean_nees", &report->clean_nees);
    json_add_number(root, "default_runs", (double)report->default_runs);
}

cJSON *passive_report_json(struct passive_report *report)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "experiment", "passive");
    cJSON_AddStringToObject(root, "method", report->method != NULL ? report->method : "all");
    cJSON_AddNumberToObject(root, "seed", (double)report->seed);
    add_pruning(root, report);
    if (report->paper != NULL) {
        add_paper(root, report);
    }
    if (report->defaults != NULL) {
        add_default(root, report);
        cJSON_AddItemToObject(root, "chain", passive_chain_json(report->chain));
        json_add_number(root, "chain_runs", (double)report->chain_runs);
    }
    verdicts_to_json(&report->verdicts, root);
    return root;
}
