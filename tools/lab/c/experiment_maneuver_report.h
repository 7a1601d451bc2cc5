/* SPDX-License-Identifier: MIT */
/*
 * experiment_maneuver_report: all runs of the maneuver experiment in figures, as tables, verdicts,
 * JSON and a page.
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_MANEUVER_REPORT_H
#define RHOTRACK_TOOL_EXPERIMENT_MANEUVER_REPORT_H

#include <cjson/cJSON.h>

#include "base/grid.h"
#include "experiment_maneuver.h"
#include "verdicts.h"

#define MANEUVER_FIRST_RUNS 50 /* the paper's number */

/* One method's runs of a case; NAN where there is nothing to say. Kept runs: not lost. */
struct maneuver_summary {
    double inside, first_inside;     /* shares of the runs, of the first 50 */
    double wrong;                    /* share of the scans */
    double lost;                     /* share of the runs */
    double most_off_m;               /* of all runs */
    double least_mps, most_mps;      /* medians of the runs' extreme velocity errors */
    double rms_m, rms_mps;           /* of all runs */
    double kept_rms_m, kept_rms_mps; /* of the kept */
    double imm_ratio,
        imm_speed_ratio; /* kept over what the IMM that knows the plots has in the same runs */
    double nis;          /* of the kept, over the dimensions */
    double hypotheses;
    unsigned long refused;
};

/* Cases with the runs that were made of each, case by case. */
struct maneuver_table {
    const struct maneuver_case *cases;
    size_t num_cases;
    uint64_t stream; /* of the first case */
    size_t *runs;
    struct maneuver_summary (*by_method)[MANEUVER_METHODS_MAX];
};

struct maneuver_report {
    uint64_t seed;
    struct maneuver_table paper, noise, closed, pd;
    struct verdicts verdicts;
};

/* Makes all runs. num_runs 0: each case's customary number. */
struct maneuver_report *maneuver_report_make(uint64_t seed, size_t num_runs);
void maneuver_report_free(struct maneuver_report *report);

/*
 * Of one method's `runs` outcomes, `stride` apart; imm: the outcomes of the IMM that knows the
 * plots, NULL: none.
 */
struct maneuver_summary maneuver_summarise(const struct maneuver_outcome *outcomes,
                                           const struct maneuver_outcome *imm, size_t runs,
                                           size_t stride);

/* Streams of the tables' first cases. */
#define MANEUVER_PAPER_STREAM 9000
#define MANEUVER_NOISE_STREAM 9100
#define MANEUVER_CLOSED_STREAM 9200
#define MANEUVER_PD_STREAM 9300

/* The bars, into report->verdicts. experiment_maneuver_verdicts.c */
void maneuver_judge(struct maneuver_report *report);

/* Measured figures beside the references. experiment_maneuver_tables.c */
struct grid maneuver_paper_grid(const struct maneuver_report *report);
struct grid maneuver_noise_grid(const struct maneuver_report *report);
struct grid maneuver_lost_grid(const struct maneuver_report *report);
struct grid maneuver_error_grid(const struct maneuver_report *report);
struct grid maneuver_pd_grid(const struct maneuver_report *report);
void maneuver_report_print(const struct maneuver_report *report);

/* The verdicts become the object's. experiment_maneuver_tables.c */
cJSON *maneuver_report_json(struct maneuver_report *report);

/* FOLDER/index.html and its pictures. experiment_maneuver_page.c */
void maneuver_page(const struct maneuver_report *report, const char *folder);

/* ---- pictures: experiment_maneuver_pictures.c ------------------------------------------------ */

enum maneuver_drawn { MANEUVER_DRAW_USED, MANEUVER_DRAW_OFF_M, MANEUVER_DRAW_OFF_MPS };

struct maneuver_picture {
    const char *file, *caption;
    enum maneuver_drawn drawn;
    const struct maneuver_case *of;
    size_t case_number, method; /* the case's place in its table */
    uint64_t stream;            /* of the table */
};
extern const struct maneuver_picture maneuver_pictures[];
extern const size_t maneuver_num_pictures;

void maneuver_draw(const struct maneuver_picture *picture, uint64_t seed, const char *folder);

#endif
