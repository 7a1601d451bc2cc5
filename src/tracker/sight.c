/* SPDX-License-Identifier: MIT */
/*
 * sight: would this look see this track? Three answers, each with its contributors in their order:
 * whether it may see the track at all, whether no plot is then a miss, and how probable a plot is.
 */
#include "sensors.h"

int rho_look_may_see(const struct rho_look *look, const struct rho_track *track)
{
    /* the scan of a suspect sensor does not see tracks that no other sensor has seen */
    return !rho_track_is_frozen(track) &&
           (!look->scan || (rho_coverage_may_see(look, track) &&
                            !(RHO_SECTORS && rho_turn_saw_before(look, track)) &&
                            !(look->is_suspect && !track->is_shared)));
}

int rho_look_may_miss(const struct rho_look *look, const struct rho_track *track)
{
    if (RHO_SECTORS) {
        return !look->is_suspect && rho_turn_has_passed(look, track);
    }
    return rho_coverage_holds_track(look, look->scan->sector_from_rad, look->scan->sector_to_rad,
                                    track);
}

struct detection rho_look_visible(const struct rho_look *look, const struct rho_track *track)
{
    struct detection seen = rho_pd_detection(look, track);
    if (RHO_DOPPLER_NOTCH && track->blind_percent > 0) {
        seen = rho_notch_detection(look, track, seen);
    }
    return seen;
}

struct detection rho_look_detection(const struct rho_look *look, const struct rho_track *track)
{
    return rho_life_detection(track, rho_look_visible(look, track));
}
