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
        rho_tracker_end_image_tracks(step);
    }
    if (!(RHO_SECTORS && rho_tracker_return_to_newest_time(step))) {
        rho_step_merge_estimates(step);
    }
    if (look->scan && rho_tracker_has_bodies(step->tracker)) {
        rho_tracker_update_bodies(step->tracker, look, step->whole);
        rho_tracker_split_tracks_of_two_targets(step, step->whole);
        rho_tracker_ungroup_plots(step->tracker, &step->look, step->whole);
    }
}
