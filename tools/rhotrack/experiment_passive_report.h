/* SPDX-License-Identifier: MIT */
/* experiment_passive_report: all runs of the passive experiment in figures, as tables, verdicts, JSON and a page. */
#ifndef RHOTRACK_TOOL_EXPERIMENT_PASSIVE_REPORT_H
#define RHOTRACK_TOOL_EXPERIMENT_PASSIVE_REPORT_H

#include <cjson/cJSON.h>

#include "experiment_passive.h"
#include "grid.h"
#include "verdicts.h"

struct passive_pruning_summary {
    struct passive_pruned by_rule[PASSIVE_RULES];
};

struct passive_paper_summary {
    struct passive_found by_rule[PASSIVE_RULES];
};

/* Of the found targets: root mean squares of the place, medians of the lines; NAN where there is none. */
struct passive_default_summary {
    struct passive_found found;
    double rms_m, fit_rms_m;
    struct passive_line line_off, fit_line_off;
    double nees; /* mean */
    size_t num_hits;
    double search_ms; /* median */
};

struct passive_report {
    const char *method; /* "passive", "passive-paper", NULL: both */
    uint64_t seed;
    size_t pruning_runs, paper_runs, default_runs; /* of a case; 0: the table is left out */
    struct passive_pruning_summary *pruning;
    struct passive_paper_summary *paper;
    struct passive_default_summary *defaults;
    double pooled_nees; /* of all found targets but those on the base's extension */
    struct verdicts verdicts;
};

/* Makes all runs. num_runs 0: each table's customary number. */
struct passive_report *passive_report_make(const char *method, uint64_t seed, size_t num_runs);
void passive_report_free(struct passive_report *report);

/* By enum rho_ghost_rule. experiment_passive_verdicts.c */
extern const char *const passive_rule_names[PASSIVE_RULES];

/* The bars of what the report has, into report->verdicts. experiment_passive_verdicts.c */
void passive_judge(struct passive_report *report);

/* Measured figures beside the references: "0.98/0.97". experiment_passive_tables.c */
struct grid passive_pruning_grid(const struct passive_report *report);
struct grid passive_paper_grid(const struct passive_report *report);
struct grid passive_default_grid(const struct passive_report *report);
void passive_report_print(const struct passive_report *report);

/* The verdicts become the object's. experiment_passive_tables.c */
cJSON *passive_report_json(struct passive_report *report);

/* FOLDER/index.html and its pictures. experiment_passive_page.c */
void passive_page(const struct passive_report *report, const char *folder);

/* The paper's figures 2 to 9 into FOLDER. experiment_passive_pictures.c */
struct passive_picture {
    const char *name; /* of the file */
    const char *caption;
};
extern const struct passive_picture passive_pictures[];
extern const size_t passive_num_pictures;
void passive_draw_pictures(const char *folder);

#endif
