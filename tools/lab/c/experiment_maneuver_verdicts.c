/* SPDX-License-Identifier: MIT */
/* What must hold of the maneuver experiment. */
#include <math.h>

#include "experiment_maneuver_report.h"

#define FIRST_INSIDE_MIN 1.0 /* Method I, of the paper's 50 runs */
#define INSIDE_MIN 0.995
#define RMS_M_MAX 2.2
#define WRONG_MAX 0.0002
#define VELOCITY_MPS_MAX 25.0 /* median extreme errors, either way */
#define FORGETS_RMS_M_MAX 1.6
#define FORGETS_VELOCITY_MPS_MAX 10.0
#define RANDOM_INSIDE_MAX 0.4
#define NIS_MIN 0.8
#define NIS_MAX 1.05

static double either_way(const struct maneuver_summary *summary)
{
    return fmax(-summary->least_mps, summary->most_mps);
}

/* Of four clutter plots, as in the paper. */
static void judge_paper_case(struct verdicts *verdicts, const struct maneuver_case *of,
                             const struct maneuver_summary *by_method)
{
    const struct maneuver_summary *printed = &by_method[MANEUVER_I];
    const struct maneuver_summary *forgets = &by_method[MANEUVER_I_FORGETS];
    verdicts_at_least(verdicts, printed->first_inside, FIRST_INSIDE_MIN,
                      "Method I, %s: inside the beam, first %d runs", of->name,
                      MANEUVER_FIRST_RUNS);
    verdicts_at_least(verdicts, printed->inside, INSIDE_MIN, "Method I, %s: inside the beam",
                      of->name);
    verdicts_at_most(verdicts, printed->rms_m, RMS_M_MAX, "Method I, %s: rms error, m", of->name);
    verdicts_at_most(verdicts, printed->wrong, WRONG_MAX, "Method I, %s: wrong picks", of->name);
    verdicts_at_most(verdicts, either_way(printed), VELOCITY_MPS_MAX,
                     "Method I, %s: median extreme velocity error, m/s", of->name);
    verdicts_at_most(verdicts, forgets->rms_m, FORGETS_RMS_M_MAX,
                     "Method I with gamma .5, %s: rms error, m", of->name);
    verdicts_at_most(verdicts, either_way(forgets), FORGETS_VELOCITY_MPS_MAX,
                     "Method I with gamma .5, %s: median extreme velocity error, m/s", of->name);
    verdicts_at_most(verdicts, by_method[MANEUVER_III].inside, RANDOM_INSIDE_MAX,
                     "Method III, %s: inside the beam", of->name);
}

static void judge_default(struct verdicts *verdicts, const struct maneuver_case *of,
                          const struct maneuver_summary *summary)
{
    if (!isnan(of->bars.lost_max)) {
        verdicts_at_most(verdicts, summary->lost, of->bars.lost_max, "default, %s: lost", of->name);
    }
    if (!isnan(of->bars.ratio_max)) {
        verdicts_at_most(verdicts, summary->imm_ratio, of->bars.ratio_max,
                         "default, %s: rms error over that of the IMM with true plots", of->name);
    }
    if (of->bars.has_nis) {
        verdicts_at_least(verdicts, summary->nis, NIS_MIN, "default, %s: NIS a dimension",
                          of->name);
        verdicts_at_most(verdicts, summary->nis, NIS_MAX, "default, %s: NIS a dimension", of->name);
    }
}

void maneuver_judge(struct maneuver_report *report)
{
    report->verdicts = verdicts_start();
    for (size_t i = 0; i < report->paper.num_cases; i++) {
        if (report->paper.cases[i].setting.clutter == 4) {
            judge_paper_case(&report->verdicts, &report->paper.cases[i],
                             report->paper.by_method[i]);
        }
    }
    for (size_t i = 0; i < report->closed.num_cases; i++) {
        judge_default(&report->verdicts, &report->closed.cases[i],
                      &report->closed.by_method[i][MANEUVER_CLOSED_DEFAULT]);
    }
}
