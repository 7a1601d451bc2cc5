/* SPDX-License-Identifier: MIT */
/* What must hold of the passive experiment. */
#include <math.h>

#include "experiment_passive_report.h"

#define PAPER_SHARE_TOLERANCE 0.07
#define PAPER_GHOSTS_TOLERANCE 0.4 /* or this share of the reference, which is more: */
#define PAPER_GHOSTS_SHARE 0.1
#define RMS_RATIO_MAX 1.08
#define NEES_MIN 3.5 /* of 4 dimensions */
#define NEES_MAX 4.7
#define SEARCH_MS_MAX 10.0
#define TIMED_RUNS_MIN 100

const char *const passive_rule_names[PASSIVE_RULES] = {"elimination alone", "literal", "safe"};

static const struct passive_pruned *pruned(const struct passive_report *report, size_t number,
                                           enum rho_ghost_rule rule)
{
    return &report->pruning[number].by_rule[rule];
}

/* Of cases 0, two targets in the clear, and 3, the same with misses and false bearings. */
static void judge_pruning(struct passive_report *report)
{
    struct verdicts *verdicts = &report->verdicts;
    const struct passive_pruned *literal = pruned(report, 0, RHO_GHOST_LITERAL);
    verdicts_at_least(verdicts, literal->ghosts, 0.74, "pruning, %s, literal: ghosts removed",
                      passive_pruning_cases[0].name);
    verdicts_at_most(verdicts, literal->targets, 0.0, "pruning, %s, literal: targets lost",
                     passive_pruning_cases[0].name);
    verdicts_at_most(verdicts, pruned(report, 3, RHO_GHOST_SAFE)->targets, 0.003,
                     "pruning, %s, safe: targets lost", passive_pruning_cases[3].name);
}

static void judge_paper_rule(struct verdicts *verdicts, const struct passive_paper_case *of,
                             int rule, const struct passive_found *found)
{
    const struct passive_found *reference = &of->reference[rule];
    double most = fmax(PAPER_GHOSTS_TOLERANCE, PAPER_GHOSTS_SHARE * reference->ghosts_a_run);
    verdicts_at_most(verdicts, fabs(found->share - reference->share), PAPER_SHARE_TOLERANCE,
                     "paper's method, %s, %s: Pd off the reference %.3f", of->name,
                     passive_rule_names[rule], reference->share);
    verdicts_at_most(verdicts, fabs(found->ghosts_a_run - reference->ghosts_a_run), most,
                     "paper's method, %s, %s: ghosts a run off the reference %.2f", of->name,
                     passive_rule_names[rule], reference->ghosts_a_run);
}

static void judge_paper(struct passive_report *report)
{
    for (size_t i = 0; i < passive_num_paper_cases; i++) {
        const struct passive_paper_case *of = &passive_paper_cases[i];
        for (int rule = 0; rule < PASSIVE_RULES; rule++) {
            if (of->has_rule[rule]) {
                judge_paper_rule(&report->verdicts, of, rule, &report->paper[i].by_rule[rule]);
            }
        }
    }
}

static void judge_default_case(struct passive_report *report, size_t number)
{
    const struct passive_default_case *of = &passive_default_cases[number];
    const struct passive_default_summary *summary = &report->defaults[number];
    struct verdicts *verdicts = &report->verdicts;
    if (!isnan(of->found_min)) {
        verdicts_at_least(verdicts, summary->found.share, of->found_min, "default, %s: Pd",
                          of->name);
    }
    if (!isnan(of->ghosts_max)) {
        verdicts_at_most(verdicts, summary->found.ghosts_a_run, of->ghosts_max,
                         "default, %s: ghosts a run", of->name);
    }
    if (of->setting.targets > 0) {
        verdicts_at_most(verdicts, summary->rms_m / summary->fit_rms_m, RMS_RATIO_MAX,
                         "default, %s: rms error of the place over the fit's", of->name);
    }
    if (of->has_time_bar && report->default_runs >= TIMED_RUNS_MIN) {
        verdicts_at_most(verdicts, summary->search_ms, SEARCH_MS_MAX,
                         "default, %s: median ms of a search", of->name);
    }
}

static void judge_nees(struct verdicts *verdicts, const struct passive_nees *nees, const char *what)
{
    verdicts_at_least(verdicts, nees->mean, NEES_MIN, "default, %s", what);
    verdicts_at_most(verdicts, nees->mean, NEES_MAX, "default, %s", what);
}

static void judge_default(struct passive_report *report)
{
    for (size_t i = 0; i < passive_num_default_cases; i++) {
        judge_default_case(report, i);
    }
    judge_nees(&report->verdicts, &report->clean_nees, "clean cases ahead: NEES of the found");
    judge_nees(&report->verdicts, &report->nees,
               "all cases but the base's extension: NEES of the found");
    judge_nees(&report->verdicts, &report->own_nees,
               "all cases but the base's extension: NEES of the found with their own bearings "
               "alone");
}

void passive_judge(struct passive_report *report)
{
    report->verdicts = verdicts_start();
    judge_pruning(report);
    if (report->paper != NULL) {
        judge_paper(report);
    }
    if (report->defaults != NULL) {
        judge_default(report);
    }
    if (report->chain != NULL) {
        passive_chain_judge(report->chain, &report->verdicts);
    }
}
