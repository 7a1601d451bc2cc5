/* SPDX-License-Identifier: MIT */
/*
 * experiment_passive_report: all runs of the passive experiment in figures, as tables, verdicts,
 * JSON and a page.
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_PASSIVE_REPORT_H
#define RHOTRACK_TOOL_EXPERIMENT_PASSIVE_REPORT_H

#include <cjson/cJSON.h>

#include "base/grid.h"
#include "experiment_passive.h"
#include "experiment_passive_chain.h"
#include "verdicts.h"

struct passive_pruning_summary {
    struct passive_pruned by_rule[PASSIVE_RULES];
};

struct passive_paper_summary {
    struct passive_found by_rule[PASSIVE_RULES];
};

/* Mean over so many tracks. */
struct passive_nees {
    double mean;
    size_t count;
};

/*
 * Of the found targets: root mean squares of the place, medians of the lines; NAN where there is
 * none.
 */
struct passive_default_summary {
    struct passive_found found;
    double rms_m, fit_rms_m;
    struct passive_line line_off, fit_line_off;
    struct passive_nees nees, own_nees; /* of all, of those with their own bearings alone */
    double search_ms;                   /* median */
};

/*
 * One of the scenes of the paper's figures: what is left of its crossings, and which lines are
 * found in them.
 */
struct passive_figure {
    const char *figures; /* their numbers */
    const char *sensors;
    unsigned mask; /* of the sensors */
    enum rho_ghost_rule rule;
    unsigned votes_min;
    size_t crossings, ghosts; /* of targets, others */
    struct passive_matched lines;
};
#define PASSIVE_FIGURES 6

struct passive_report {
    const char *method; /* "passive", "passive-paper", NULL: both */
    uint64_t seed;
    size_t pruning_runs, paper_runs, default_runs,
        chain_runs; /* of a case; 0: the table is left out */
    struct passive_pruning_summary *pruning;
    struct passive_paper_summary *paper;
    struct passive_default_summary *defaults;
    struct passive_chain_summary *chain;            /* of chain_runs a case */
    struct passive_figure figures[PASSIVE_FIGURES]; /* with the paper's method */
    /* of found targets that do not start on the base's extension */
    struct passive_nees nees;       /* all */
    struct passive_nees clean_nees; /* of cases without misses and false bearings */
    struct passive_nees own_nees;   /* those with their own bearings alone */
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
struct grid passive_figures_grid(const struct passive_report *report);
struct grid passive_default_grid(const struct passive_report *report);

/* What was pooled for NEES, as a sentence. */
#define PASSIVE_NOTE 320
const char *passive_nees_note(const struct passive_report *report, char text[PASSIVE_NOTE]);
void passive_report_print(const struct passive_report *report);

/* The verdicts become the object's. experiment_passive_tables.c */
cJSON *passive_report_json(struct passive_report *report);

/* FOLDER/index.html and its pictures. experiment_passive_page.c */
void passive_page(const struct passive_report *report, const char *folder);

/*
 * The scenes of the paper's figures: two targets, eight scans, nothing missed, nothing false. They
 * were sought among many so that they show what the paper's do. Of 2 sensors: ghosts lie in view
 * and on lines, and pruning removes them all. Of 3: it does not, and pairs of sensors find ghosts'
 * lines that the others do not confirm. experiment_passive_figures.c
 */
#define PASSIVE_FIGURES_SEED 1
#define PASSIVE_FIGURES_TWO_RUN 12
#define PASSIVE_FIGURES_THREE_RUN 1361
struct passive_scene passive_figures_scene(size_t sensors);
void passive_figures_make(struct passive_figure figures[PASSIVE_FIGURES]);

/* FOLDER/figure-2.svg .. figure-9.svg. experiment_passive_pictures.c */
void passive_draw_pictures(const struct passive_figure figures[PASSIVE_FIGURES],
                           const char *folder);

#endif
