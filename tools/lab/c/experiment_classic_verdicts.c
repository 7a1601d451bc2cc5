/* SPDX-License-Identifier: MIT */
/*
 * What must hold of the paper's experiments: agreement with the reference, work, what was found
 * about the claims.
 */
#include <math.h>
#include <stdarg.h>

#include "base/common.h"
#include "experiment_classic.h"

#define ERRORS 4.0 /* tolerance, standard errors of the difference */
#define VOTES_TOLERANCE 0.03
#define DENSE_SHARE 0.5
#define ROUNDING 1e-9

static const char *const figure_names[CLASSIC_FIGURES] = {"detected",       "met",   "false peaks",
                                                          "discrimination", "top 3", "error of rho",
                                                          "error of theta", "votes", "decline"};

static struct classic_verdict *add(struct classic_report *report, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static struct classic_verdict *add(struct classic_report *report, const char *format, ...)
{
    report->verdicts =
        must_realloc(report->verdicts, (report->num_verdicts + 1) * sizeof *report->verdicts);
    struct classic_verdict *verdict = &report->verdicts[report->num_verdicts++];
    va_list list;
    *verdict = (struct classic_verdict){.value = NAN};
    va_start(list, format);
    vsnprintf(verdict->what, sizeof verdict->what, format, list);
    va_end(list);
    return verdict;
}

static void expect_near(struct classic_verdict *verdict, double value, double expected,
                        double tolerance)
{
    verdict->value = value;
    verdict->expected = expected;
    verdict->tolerance = tolerance;
    verdict->relation = "~";
    verdict->is_held = fabs(value - expected) <= tolerance + ROUNDING;
}

static void expect_at_most(struct classic_verdict *verdict, double value, double bar)
{
    verdict->value = value;
    verdict->expected = bar;
    verdict->relation = "<=";
    verdict->is_held = value <= bar + ROUNDING;
}

static void expect_at_least(struct classic_verdict *verdict, double value, double bar)
{
    expect_at_most(verdict, -value, -bar);
    verdict->value = value;
    verdict->expected = bar;
    verdict->relation = ">=";
}

/* ---- the reference --------------------------------------------------------------------------- */

/* Variance that a run's figure has, by what kind of number it is. */
static double usual_variance(enum classic_figure figure, double mean)
{
    switch (figure) {
    case CLASSIC_DETECTED:
    case CLASSIC_MET:
    case CLASSIC_TOP3:
        return mean * (1.0 - mean) / INITIATION_TARGETS_MAX;
    case CLASSIC_FALSE:
        return mean;
    case CLASSIC_DISCRIMINATION:
        return mean * fmax(2.0 - mean, 0.0) / INITIATION_TARGETS_MAX;
    default:
        return mean * mean;
    }
}

/*
 * Few runs can all come out the same. Counts vary at least as usual; with others, a usual run more
 * is reckoned with.
 */
static double variance_of(enum classic_figure figure, double mean, double variance, double runs)
{
    double usual = usual_variance(figure, mean);
    bool is_count = figure <= CLASSIC_FALSE || figure == CLASSIC_TOP3;
    return is_count ? fmax(variance, usual) : (runs * variance + usual) / (runs + 1.0);
}

/*
 * Standard error of the difference between these runs' mean and the reference's, which is taken to
 * vary as much.
 */
static double error_of_difference(const struct classic_report *report,
                                  const struct classic_summary *summary, enum classic_figure figure,
                                  double expected)
{
    double runs = (double)report->num_runs, all = runs + CLASSIC_REFERENCE_RUNS;
    double pooled = (runs * summary->mean[figure] + CLASSIC_REFERENCE_RUNS * expected) / all;
    double own = runs * summary->error[figure] * summary->error[figure];
    double variance = variance_of(figure, pooled, own, runs);
    return sqrt(variance * (1.0 / runs + 1.0 / CLASSIC_REFERENCE_RUNS));
}

static void judge_figure(struct classic_report *report, size_t situation, size_t method,
                         enum classic_figure figure)
{
    const struct classic_summary *summary = &report->summaries[situation][method];
    struct classic_expected expected = classic_expected(situation, method, figure);
    if (expected.is_given && !isnan(summary->mean[figure])) {
        double error = error_of_difference(report, summary, figure, expected.value);
        expect_near(add(report, "%s %s: %s", summary->situation->name, classic_method_names[method],
                        figure_names[figure]),
                    summary->mean[figure], expected.value, ERRORS * error + expected.rounding);
    }
}

static void judge_reference(struct classic_report *report)
{
    for (size_t situation = 0; situation < SITUATIONS; situation++) {
        for (size_t method = 0; method < CLASSIC_KERNEL; method++) {
            for (enum classic_figure figure = 0;
                 figure <= CLASSIC_VOTES && classic_has(report, method); figure++) {
                judge_figure(report, situation, method, figure);
            }
        }
    }
}

/* ---- work ------------------------------------------------------------------------------------ */

static void judge_work(struct classic_report *report)
{
    static const struct {
        size_t method;
        double votes;
    } expected[] = {{RHO_HOUGH_HT, 2.26e6},
                    {RHO_HOUGH_MHT, 63e3},
                    {RHO_HOUGH_IHT, 9.4e3},
                    {RHO_HOUGH_NHT_C, 535e3}};
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++) {
        size_t method = expected[i].method;
        if (classic_has(report, method)) {
            const struct classic_summary *summary = &report->summaries[SITUATION_IV][method];
            expect_near(add(report, "work, IV %s: votes within 3 %% and the error of the mean",
                            classic_method_names[method]),
                        summary->mean[CLASSIC_VOTES], expected[i].votes,
                        VOTES_TOLERANCE * expected[i].votes +
                            ERRORS * summary->error[CLASSIC_VOTES]);
        }
    }
    for (size_t i = 0; i < report->num_times && classic_has(report, RHO_HOUGH_NHT_C); i++) {
        const struct classic_time *time = &report->times[i];
        if (time->per_km2 == classic_situations[SITUATION_IV].of.clutter_per_km2) {
            expect_at_most(add(report, "work, IV NHT C: time / dense HT's"),
                           time->time_us[RHO_HOUGH_NHT_C] / time->time_us[CLASSIC_DENSE],
                           DENSE_SHARE);
        }
    }
}

/* ---- findings -------------------------------------------------------------------------------- */

static void judge_sweep(struct classic_report *report)
{
    for (size_t i = 0; i < CLASSIC_NOISES; i++) {
        const struct classic_summary *c = &report->sweep[i][RHO_HOUGH_NHT_C],
                                     *iht = &report->sweep[i][RHO_HOUGH_IHT];
        double noise_m = report->sweep_situations[i].noise_m;
        if (!classic_has(report, RHO_HOUGH_NHT_C)) {
            return;
        }
        if (noise_m <= 0.6) {
            expect_at_least(add(report, "IV at %g m, NHT C: detected", noise_m),
                            c->mean[CLASSIC_DETECTED], 0.8);
        }
        if (noise_m > 0.0 && noise_m <= 0.6 && classic_has(report, RHO_HOUGH_IHT)) {
            expect_at_most(add(report, "IV at %g m, NHT C: false / IHT's", noise_m),
                           c->mean[CLASSIC_FALSE] / iht->mean[CLASSIC_FALSE], 0.5);
        }
        if (noise_m >= 10.0) {
            expect_at_most(add(report, "IV at %g m, NHT C: detected", noise_m),
                           c->mean[CLASSIC_DETECTED], 0.3);
        }
    }
}

static void judge_table3(struct classic_report *report)
{
    if (classic_has(report, RHO_HOUGH_NHT_A)) {
        expect_near(add(report, "Table 3 alone, NHT A: votes"), report->table3_votes, 1.0, 0.0);
    }
}

static void judge_default(struct classic_report *report)
{
    for (size_t i = 0; i < SITUATIONS && classic_has(report, CLASSIC_KERNEL); i++) {
        const struct classic_summary *summary = &report->summaries[i][CLASSIC_KERNEL];
        expect_at_least(add(report, "%s default: met", summary->situation->name),
                        summary->mean[CLASSIC_MET], 0.95);
        expect_at_most(add(report, "%s default: false peaks", summary->situation->name),
                       summary->mean[CLASSIC_FALSE], 0.1);
    }
}

void classic_judge(struct classic_report *report)
{
    judge_reference(report);
    judge_work(report);
    judge_sweep(report);
    judge_table3(report);
    judge_default(report);
    for (size_t i = 0; i < report->num_verdicts; i++) {
        report->held += report->verdicts[i].is_held;
        report->missed += !report->verdicts[i].is_held;
    }
}
