/* SPDX-License-Identifier: MIT */
/*
 * predict: moves tracks to the time of the step. A track that no look can see stays at its own
 * time: scans of other sectors or sensors change no bit of its estimate.
 */
#include "phases.h"

void rho_step_predict(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_look *look = &step->look;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *track = &tracker->tracks[i];
        track->plot = -1;
        if (RHO_SECTORS) {
            track->ahead_us = track->time_us; /* to return to, from an earlier time of the look */
        }
        if (rho_look_may_see(look, track)) {
            look->in_view[i / 32] |= 1u << i % 32;
            /* the prediction fails where the covariance has grown beyond its limits */
            if (rho_track_predict(track, look->time_us, &look->model) != RHO_OK) {
                rho_life_end(step, track);
            }
        }
    }
    if (look->bearings) {
        rho_step_merge_estimates(step); /* coverage goes by one estimate of each track */
    }
}
