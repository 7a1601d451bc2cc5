/* SPDX-License-Identifier: MIT */
/*
 * experiment_classic: the experiments of Fan et al., "Neutrosophic Hough Transform-Based Track
 * Initiation Method for Multiple Target Tracking", section V, with its methods (rhotrack/hough.h)
 * and the default.
 *
 * A target is detected when a peak is within 40 m and 8 mrad (2 eps) of the line through its true
 * positions; it is met when a peak's line is within 30 m (real data: 100 m) of its true positions
 * in the mean. Other peaks are false.
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_CLASSIC_H
#define RHOTRACK_TOOL_EXPERIMENT_CLASSIC_H

#include <cjson/cJSON.h>

#include "base/grid.h"
#include "experiment_initiation.h"
#include "rhotrack/hough.h"

/* The paper's methods, numbered as in enum rho_hough_method, then the default. */
enum { CLASSIC_KERNEL = RHO_HOUGH_NHT_C + 1, CLASSIC_METHODS };

extern const char *const classic_method_names[CLASSIC_METHODS];

/*
 * Bit m: method m. "ht", "mht", "iht", "nht" (both readings), "kernel"; NULL: all. 0: there is no
 * such method.
 */
unsigned classic_methods_named(const char *name);

/* ---- Situations ------------------------------------------------------------------------------ */

enum {
    SITUATION_I,
    SITUATION_II,
    SITUATION_III,
    SITUATION_IV,
    SITUATION_THIN,
    SITUATION_REAL,
    SITUATION_REAL_DENSE,
    SITUATIONS
};

struct classic_situation {
    const char *name, *text;
    const char *figure; /* of the paper; NULL: none */
    struct initiation_case of;
    double noise_m;
    float rho_max_m;
    double near_m; /* that a peak's line may be from a target it meets */
};

extern const struct classic_situation classic_situations[SITUATIONS];

/* ---- figures --------------------------------------------------------------------------------- */

enum classic_figure {
    CLASSIC_DETECTED, /* share of the targets */
    CLASSIC_MET,      /* share of the targets */
    CLASSIC_FALSE,    /* peaks */
    /*
     * mean over the targets: highest cell near the true line / highest false peak, or tau of the
     * most votes, below which nothing is listed
     */
    CLASSIC_DISCRIMINATION,
    CLASSIC_TOP3,  /* share of the targets: detected by one of the three highest peaks */
    CLASSIC_RHO,   /* m; mean absolute error of peaks that detect a target: divergence */
    CLASSIC_THETA, /* mrad */
    CLASSIC_VOTES,
    /* 1 - highest cell near the true line / its height without noise, clutter and misses */
    CLASSIC_DECLINE,
    CLASSIC_FIGURES
};

/*
 * What an independent implementation, double precision on a plane that is wholly there, measured in
 * 200 runs: "2.26M", "9..12" for anything between, "" for none. Its last digit is rounded.
 */
#define CLASSIC_REFERENCE_RUNS 200
struct classic_reference {
    const char *figures[CLASSIC_VOTES + 1];
};
extern const struct classic_reference classic_references[SITUATIONS][CLASSIC_KERNEL];

struct classic_expected {
    bool is_given;
    double value, rounding; /* +- */
};
struct classic_expected classic_expected(size_t situation, size_t method,
                                         enum classic_figure figure);

/*
 * The paper's Table 2: its word for row 0 discrimination, 1 divergence, 2 decline; NULL for the
 * default and beyond Situation IV.
 */
const char *classic_word(size_t situation, size_t method, size_t row);

/* ---- one run --------------------------------------------------------------------------------- */

struct classic_plots {
    float *x_m, *y_m, *t_s;
    uint32_t scan_end[INITIATION_SCANS];
};

/* Memory that a thread needs for all methods. */
struct classic_tools {
    struct rho_hough *classic;
    struct rho_accumulator *rows;
    struct rho_accumulator_peak *peaks;
    uint32_t max_peaks;
    struct rho_initiator *initiator;
    struct classic_plots plots, chosen; /* of one run; those near a line */
    struct rho_hough_points points;
};
struct classic_tools classic_tools_start(uint32_t max_peaks);
void classic_tools_free(struct classic_tools *tools);

/* One run's plots and truth. */
struct classic_data {
    const struct classic_situation *situation;
    struct scenario_plan plan;
    struct simulation *simulation;
};
struct classic_data classic_simulate(const struct classic_situation *situation, uint64_t seed,
                                     uint64_t stream, uint64_t run);
void classic_data_free(struct classic_data *data);

/* The data become the tools' points. */
void classic_load(struct classic_tools *tools, const struct classic_data *data);

/* A line of the plane: rho, and theta in [0, pi). */
struct classic_line {
    double rho_m, theta_rad;
};
struct classic_line classic_true_line(const struct scenario_plan *plan, size_t target);

struct rho_hough_config classic_config(const struct classic_situation *situation, size_t method);

/* Votes and peaks. */
struct rho_hough_result classic_find(struct classic_tools *tools,
                                     const struct rho_hough_config *config,
                                     const struct rho_hough_points *points);

struct classic_run {
    double value[CLASSIC_FIGURES]; /* NAN where there is none; RHO, THETA: sums over the matched */
    double rho2, theta2;           /* sums of squares */
    int matched;                   /* targets detected */
    double time_us;
    int found, false_tracks; /* the default: as its own bars count them, one to one in position */
};

/* One method on one run's data. ideal_votes: the height for DECLINE. */
struct classic_run classic_run(struct classic_tools *tools, const struct classic_data *data,
                               size_t method, double ideal_votes);

/* The most votes of a cell within 40 m and 8 mrad of a line. The tools' peaks are overwritten. */
double classic_near_votes(struct classic_tools *tools, const struct rho_hough_config *config,
                          struct classic_line line);

/*
 * Heights of the targets' cells in Situation I with nothing missed, in the mean over the targets,
 * for each method.
 */
void classic_ideal_votes(struct classic_tools *tools, double ideal_votes[CLASSIC_KERNEL]);

/* ---- HT on a plane that is wholly there ------------------------------------------------------ */

/*
 * Clears, votes, takes what is above the threshold and suppresses; microseconds, and the number of
 * peaks.
 */
double classic_dense_us(struct classic_tools *tools, const struct rho_hough_config *config,
                        uint32_t *num_peaks);

/* ---- all runs -------------------------------------------------------------------------------- */

struct classic_summary {
    const struct classic_situation *situation;
    size_t method;
    double mean[CLASSIC_FIGURES];  /* NAN where there is none */
    double error[CLASSIC_FIGURES]; /* standard error */
    double time_us;                /* median */
    double found, false_tracks;    /* the default's */
};

#define CLASSIC_NOISES 7
#define CLASSIC_DENSITIES 5
#define CLASSIC_DENSE CLASSIC_METHODS /* in times */

struct classic_time {
    double per_km2;
    double time_us[CLASSIC_METHODS + 1]; /* median; NAN where not measured */
    double votes[CLASSIC_METHODS + 1];
};

struct classic_verdict {
    char what[48];
    double value, expected, tolerance; /* a bar: tolerance 0 */
    const char *relation;              /* "~": within the tolerance; "<=", ">=" */
    bool is_held;
};

struct classic_report {
    unsigned methods;
    size_t num_runs, num_sweep_runs;
    uint64_t seed;
    struct classic_summary summaries[SITUATIONS][CLASSIC_METHODS];
    struct classic_situation sweep_situations[CLASSIC_NOISES];
    struct classic_summary sweep[CLASSIC_NOISES][CLASSIC_METHODS];
    struct classic_time times[CLASSIC_DENSITIES];
    size_t num_times;
    double ideal_votes[CLASSIC_KERNEL];
    double table3_votes; /* of reading A on the real plots alone; NAN where not run */
    struct classic_verdict *verdicts;
    size_t num_verdicts;
    int held, missed;
};

/* Everything measured, in new memory. */
struct classic_report *classic_report_make(unsigned methods, uint64_t seed, size_t num_runs);
void classic_report_free(struct classic_report *report);

bool classic_has(const struct classic_report *report, size_t method);
void classic_judge(struct classic_report *report);

/* ---- output ---------------------------------------------------------------------------------- */

struct grid classic_situations_grid(const struct classic_report *report);
struct grid classic_words_grid(const struct classic_report *report);
struct grid classic_sweep_grid(const struct classic_report *report);
struct grid classic_times_grid(const struct classic_report *report);
struct grid classic_verdicts_grid(const struct classic_report *report, bool only_missed);

void classic_print(const struct classic_report *report);
void classic_json(const struct classic_report *report, cJSON *root);

/*
 * Pictures into the folder, text and tables onto the page; the long list of what must hold is a
 * part of its own.
 */
struct page;
void classic_page(const struct classic_report *report, struct page *page, const char *folder);
void classic_page_verdicts(const struct classic_report *report, struct page *page);

/* FOLDER/situation-I.svg and so on, as the paper's Figs. 7 .. 10 and 15. */
void classic_draw_planes(const struct classic_report *report, const char *folder);
void classic_plane_name(char name[32], size_t situation);

#endif
