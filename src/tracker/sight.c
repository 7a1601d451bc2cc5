/* SPDX-License-Identifier: MIT */
/*
 * sight: would this look see this track? Three answers, each with its contributors in their order:
 * whether it may see the track at all, whether no plot is then a miss, and how probable a plot is.
 */
#include "clutter.h"
#include "plots.h"
#include "sensors.h"
#include "step.h"

int rho_look_may_see(const struct rho_look *look, const struct rho_track *track)
{
    return !rho_tracker_is_track_frozen(track) &&
           (!look->scan || (rho_tracker_may_scan_see_track(look, track) &&
                            !(RHO_SECTORS && rho_tracker_was_seen_in_last_sector(look, track)) &&
                            !rho_tracker_is_only_seen_by_suspect_sensor(look, track)));
}

int rho_tracker_may_count_miss(const struct rho_look *look, const struct rho_track *track)
{
    if (RHO_SECTORS) {
        return !look->is_suspect && rho_tracker_has_antenna_passed_gate(look, track);
    }
    return rho_tracker_sector_covers_track_place(look, look->scan->sector_from_rad,
                                                 look->scan->sector_to_rad, track);
}

struct detection rho_tracker_log_pd_and_log_miss_of_track(const struct rho_look *look,
                                                          const struct rho_track *track)
{
    const struct detection stated = {look->log_pd, look->log_miss};
    const struct detection learned = rho_tracker_detection_by_range(look, track, stated);
    return RHO_DOPPLER_NOTCH && track->blind_percent > 0
               ? rho_tracker_detection_in_notch(look, track, learned)
               : learned;
}
