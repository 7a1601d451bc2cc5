/* SPDX-License-Identifier: MIT */
/* experiment_air_traffic_verdicts: what must hold. */
#include <math.h>

#include "experiment_air_traffic.h"

#define LEAST_WANTED 20.0 /* tracks: a rate from fewer says little */

/* Times are of one core; the least mean of all runs, as other programs can only make it slower. */
static const struct bars {
    double targets, clutter, complete, false_a_scan, ms;
    bool is_near_limit;
} bars[] = {
    {50, 100, 0.95, 1.0, 1.0, true},
    {50, 1000, 0.94, 1.5, 10.0, false},
    {50, 5000, 0.90, 5.0, 80.0, false},
    {1000, 5000, NAN, NAN, 150.0, false},
};

static void judge_case(struct verdicts *verdicts, const struct bars *of,
                       const struct air_result *result)
{
    const char *what = "aircraft, clutter";

    if (!isnan(of->complete)) {
        verdicts_at_least(verdicts, result->tracks[0].completeness, of->complete,
                          "%g %s %g: completeness", of->targets, what, of->clutter);
        verdicts_at_most(verdicts, result->tracks[0].false_a_scan, of->false_a_scan,
                         "%g %s %g: false tracks a scan", of->targets, what, of->clutter);
    }
    verdicts_at_most(verdicts, result->us / 1e3, of->ms, "%g %s %g: ms a scan", of->targets, what,
                     of->clutter);
    for (size_t i = 0; i < AIR_CUTOFFS && of->is_near_limit; i++) {
        verdicts_at_most(verdicts, result->tracks[i].gospa_m / result->limit[i].gospa_m, 1.05,
                         "%g %s %g: GOSPA with cutoff %g m over the limit's", of->targets, what,
                         of->clutter, air_cutoffs_m[i]);
    }
}

static void judge_grid(struct air_report *report)
{
    for (size_t i = 0; i < sizeof bars / sizeof bars[0]; i++) {
        for (size_t j = 0; j < air_num_cases(); j++) {
            const struct air_case *of = &air_cases[j];
            if (of->group == AIR_GRID && fabs(of->targets - bars[i].targets) < 0.5 &&
                fabs(of->clutter - bars[i].clutter) < 0.5) {
                judge_case(&report->verdicts, &bars[i], &report->results[j]);
            }
        }
    }
}

static void judge_pairs(struct air_report *report)
{
    for (size_t i = 0; i < AIR_PAIRS; i++) {
        if (!isnan(air_pairs[i].kept_least)) {
            verdicts_at_least(&report->verdicts, report->pairs[i].kept, air_pairs[i].kept_least,
                              "%s: runs without a switch", air_pairs[i].name);
        }
        verdicts_at_most(&report->verdicts, report->pairs[i].lost, 0.0, "%s: runs that lost one",
                         air_pairs[i].name);
    }
}

static void judge_clutter(struct air_report *report)
{
    for (size_t i = 0; i < AIR_ALARMS; i++) {
        double wanted = air_alarms[i].wanted_per_hour;
        double over = report->alarms[i].confirmed / report->alarms[i].hours / wanted;
        if (report->alarms[i].hours * wanted >= LEAST_WANTED) {
            verdicts_at_most(&report->verdicts, over, 2.0,
                             "clutter %g alone, %g wanted: false tracks over wanted",
                             air_alarms[i].clutter, wanted);
            verdicts_at_least(&report->verdicts, over, 0.5,
                              "clutter %g alone, %g wanted: false tracks over wanted",
                              air_alarms[i].clutter, wanted);
        }
    }
}

static void judge_rivals(struct air_report *report)
{
    const struct air_rival *own = &report->rivals.own;

    for (size_t i = 0; i < AIR_RIVALS && report->rivals.missing == NULL; i++) {
        const struct air_rival *other = &report->rivals.others[i];
        verdicts_at_most(&report->verdicts, own->figures.gospa_m / other->figures.gospa_m, 0.9,
                         "GOSPA over that of %s", other->name);
        verdicts_at_least(&report->verdicts, other->us / own->us, 400.0,
                          "time of %s over rhotrack's", other->name);
    }
}

void air_judge(struct air_report *report)
{
    report->verdicts = verdicts_start();
    if ((report->parts & AIR_PART_GRID) != 0) {
        judge_grid(report);
    }
    if ((report->parts & AIR_PART_PAIRS) != 0) {
        judge_pairs(report);
    }
    if ((report->parts & AIR_PART_CLUTTER) != 0) {
        judge_clutter(report);
    }
    if ((report->parts & AIR_PART_RIVALS) != 0) {
        judge_rivals(report);
    }
}
