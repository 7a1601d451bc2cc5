/* SPDX-License-Identifier: MIT */
/*
 * sudden_turns: follows a body that turns at once, as a person at a wall. Its plots are where they
 * are expected, with other range rates, all of them: that is hardly clutter, and the filter, which
 * expects a turn of some looks, would lose them. The velocity becomes uncertain, and the plots are
 * the track's. A body of one or two plots cannot say so; a settled one that has all need not.
 */
#include "bodies.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

/* What the plots of a look say of a turn. */
struct turn_evidence {
    float nat;          /* ln of the likelihoods' ratio of a turn to none */
    float turned, kept; /* plots that speak for it, and against it */
};

/* True where a plot is in the gate of the outline's places, and has a range rate. */
static int is_in_place(const struct body_outline *outline, const struct outline_fit *fit)
{
    const float along_m2 = fit->noise_m2[0] + outline->along_m2, cross_m2 = fit->noise_m2[1],
                across_m2 = fit->noise_m2[2];
    return fit->has_rate && across_m2 * fit->along_m * fit->along_m -
                                    2.0f * cross_m2 * fit->along_m * fit->across_m +
                                    along_m2 * fit->across_m * fit->across_m <=
                                TURN_GATE_CHI2 * (along_m2 * across_m2 - cross_m2 * cross_m2);
}

/* ln of the likelihoods' ratio of a range rate by a velocity that has changed at once to none. */
static float plot_evidence(const struct outline_fit *fit, float turn_mps)
{
    const float usual = rho_bodies_rate_variance(fit, TURN_USUAL_RADPS),
                loose = usual + turn_mps * turn_mps;
    const float nat = 0.5f * (fit->rate_mps * fit->rate_mps * (1.0f / usual - 1.0f / loose) -
                              rho_log(loose / usual));
    return rho_smaller(nat, TURN_PLOT_NAT);
}

/* The plots that may be of a track which has turned. */
static struct plots_near near_outline(const struct rho_look *look,
                                      const struct body_outline *outline)
{
    const float half_m = BODY_GATE_SIGMAS * (rho_sqrt(outline->error_m2[0] + outline->error_m2[2] +
                                                      outline->along_m2 + outline->across_m2) +
                                             look->sigma_max_m) +
                         rho_bodies_moved_m(look, outline->velocity_mps);
    return rho_plots_near(look->tracker, outline->place_m[0] - half_m, outline->place_m[0] + half_m,
                          outline->place_m[1] - half_m, outline->place_m[1] + half_m);
}

/* The next of these plots that is no track's, or the track's own where is_own_too. */
static int next_plot(struct step *step, struct plots_near *near, unsigned row, int is_own_too,
                     uint32_t *plot)
{
    const struct rho_look *look = &step->look;
    while (!rho_work_is_spent(&step->work) && rho_plots_next(look, near, plot)) {
        const unsigned owner = step->tracker->bodies.groups.owner[*plot];
        rho_work_spend(&step->work, PASS_UNITS);
        if ((owner == RHO_NO_ROW || (is_own_too && owner == row)) &&
            look->fates[*plot] == RHO_FATE_HELD &&
            rho_plots_is_within(near, &look->scan->plots[*plot])) {
            return 1;
        }
    }
    return 0;
}

/* Sums over the plots near a track. is_turned: they say so, and those that do are the track's. */
static struct turn_evidence sum_plots(struct step *step, const struct body_outline *outline,
                                      unsigned row, float turn_mps, int is_turned)
{
    struct turn_evidence sum = {.nat = -TURN_NAT};
    struct plots_near near = near_outline(&step->look, outline);
    for (uint32_t i; next_plot(step, &near, row, 1, &i);) {
        struct outline_fit fit;
        rho_work_spend(&step->work, TEST_UNITS);
        rho_bodies_fit_plot(&step->look, outline, &step->look.scan->plots[i], &fit);
        if (!is_in_place(outline, &fit)) {
            continue;
        }
        const float nat = plot_evidence(&fit, turn_mps);
        sum.nat += nat;
        *(nat > 0.0f ? &sum.turned : &sum.kept) += 1.0f;
        if (is_turned && nat > 0.0f) {
            step->tracker->bodies.groups.owner[i] = (uint16_t)row;
        }
    }
    return sum;
}

float rho_bodies_turn_most_mps(const struct rho_tracker *tracker)
{
    return BODY_GATE_SIGMAS * TURN_S * tracker->config.accel_max_mps2;
}

void rho_bodies_follow_turns(struct step *step)
{
    const struct rho_look *look = &step->look;
    struct rho_tracker *tracker = step->tracker;
    const float turn_mps = TURN_S * tracker->config.accel_max_mps2;
    if (!look->teaches || !(look->scan->measures & RHO_MEASURES_RANGE_RATE)) {
        return;
    }
    for (unsigned row = 0; row < tracker->num_tracks && !rho_work_is_spent(&step->work); row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (!rho_bodies_may_own(look, row) || tracker->bodies.of[row].most_plots < TURN_PLOTS ||
            track->misses_in_row > 1) {
            continue;
        }
        struct body_outline outline = rho_bodies_outline_track(look, row);
        rho_work_spend(&step->work, TEST_UNITS);
        const float moved_m =
            turn_mps * rho_smaller(rho_seconds_between(track->updated_us, look->time_us), 1.0f);
        outline.error_m2[0] += moved_m * moved_m;
        outline.error_m2[2] += moved_m * moved_m;
        struct plots_near near = near_outline(look, &outline);
        uint32_t lost;
        if (rho_bodies_is_settled(tracker, row) && !next_plot(step, &near, row, 0, &lost)) {
            continue; /* it has all that are near, and knows its velocity */
        }
        const struct turn_evidence sum = sum_plots(step, &outline, row, turn_mps, 0);
        if (rho_work_is_spent(&step->work)) {
            return; /* not all plots were asked */
        }
        if (sum.nat > 0.0f && sum.turned >= 2.0f * sum.kept &&
            sum.turned >= TURN_SHARE * outline.plots) {
            rho_track_loosen(track, &look->model, turn_mps * turn_mps);
            (void)sum_plots(step, &outline, row, turn_mps, 1);
        }
    }
}
