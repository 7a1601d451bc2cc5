/* SPDX-License-Identifier: MIT */
/*
 * removal: must this track or plot go? Contributors, in their order. Once plots are claimed: second
 * tracks of one target (second_plots.c; those of one body have ended as its plots were grouped).
 * Each track as it ages: its life (track_life.c), unseen for too long or its place unknown
 * (unseen_tracks.c), too fast (speed_limits.c), too slow. Before starts: plots at images of tracks
 * (reflectors.c) and in excluded areas (excluded_areas.c). After starts: tracks of images.
 */
#include "phases.h"

void rho_removal_of_duplicates(struct step *step)
{
    if (RHO_MAX_ECHOES > 0) {
        rho_second_plots_take_look(step);
    }
}

void rho_removal_of_track(struct step *step, struct rho_track *track)
{
    struct rho_tracker_counters *counters = &step->tracker->counters;
    rho_life_apply(step, track, step->tracker->confirm_mnat);
    const int is_unseen =
        rho_unseen_update(&step->look, track) || rho_unseen_is_lost(step->tracker, track);
    const int is_fast = rho_speed_count_fast(&step->tracker->config, track);
    if (track->status != RHO_TRACK_FREE &&
        (is_unseen || is_fast || rho_speed_is_slow(&step->tracker->config, track))) {
        counters->tracks_unseen = rho_count(counters->tracks_unseen, is_unseen ? 1 : 0);
        counters->tracks_too_fast =
            rho_count(counters->tracks_too_fast, is_fast && !is_unseen ? 1 : 0);
        rho_life_end(step, track);
    }
}

void rho_removal_of_plots(struct rho_tracker *tracker, const struct rho_look *look,
                          struct rho_work *work)
{
    if (RHO_MAX_REFLECTORS > 0 && tracker->num_reflectors > 0) {
        rho_images_mark_plots(look, work);
    }
    if (RHO_MAX_EXCLUDED_AREAS > 0 && tracker->num_excluded > 0) {
        rho_areas_mark_plots(tracker, look, work);
    }
}

void rho_removal_of_images(struct step *step)
{
    if (RHO_MAX_REFLECTORS > 0 && step->tracker->num_reflectors > 0 && step->look.teaches) {
        rho_images_end_tracks(step);
    }
}
