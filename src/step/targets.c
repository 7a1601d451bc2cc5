/* SPDX-License-Identifier: MIT */
/*
 * targets: which plots are one target, or two? Contributors, in their order: before claims the
 * plots of one body become one plot (src/bodies); at the update two tracks take one merged plot
 * (merged_plots.c); after new tracks have started, the track of a body that is two targets becomes
 * two (split_bodies.c), and fates and rows of groups become those of plots again.
 */
#include "phases.h"

void rho_targets_group_plots(struct step *step)
{
    if (rho_bodies_are_used(step->tracker)) {
        rho_bodies_group(step);
    }
}

void rho_targets_share_plots(struct rho_tracker *tracker, const struct rho_look *look)
{
    if (RHO_SHARES_PLOTS) {
        rho_step_share_merged(tracker, look);
    }
}

void rho_targets_split(struct step *step)
{
    if (rho_bodies_are_used(step->tracker)) {
        rho_bodies_update(step->tracker, &step->look, step->whole);
        rho_step_split_bodies(step, step->whole);
        rho_bodies_ungroup(step->tracker, &step->look, step->whole);
    }
}
