/* SPDX-License-Identifier: MIT */
/*
 * settle: brings the tracks to the time that the report has, after new tracks have started: tracks
 * of images end, each track has one estimate, bodies are updated and split.
 */
#include "phases.h"

void rho_step_settle(struct step *step)
{
    const struct rho_look *look = &step->look;
    if (RHO_MAX_REFLECTORS > 0 && step->tracker->num_reflectors > 0 && look->scan &&
        look->teaches) {
        rho_images_end_tracks(step);
    }
    if (!(RHO_SECTORS && rho_retrodiction_return(step))) {
        rho_step_merge_estimates(step);
    }
    if (look->scan && rho_bodies_are_used(step->tracker)) {
        rho_bodies_update(step->tracker, look, step->whole);
        rho_step_split_bodies(step, step->whole);
        rho_bodies_ungroup(step->tracker, &step->look, step->whole);
    }
}
