/* SPDX-License-Identifier: MIT */
/*
 * looks: a step takes its looks one after the other. Tracks are updated by one look before the next
 * one is claimed, and meet it with narrower gates.
 *
 * A scan of more than RHO_MAX_PLOTS plots is claimed in parts of RHO_MAX_PLOTS, a look each:
 * existing tracks come first, and may claim the plots beyond that limit, too. In each part the
 * tracks that have no plot yet claim one; a track without a plot after the last part is missed.
 * Only plots of the first part have places in fates[] and are held: unclaimed plots of later parts
 * are NO_ROOM.
 */
#include <string.h>

#include "phases.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/doppler_notch.h"
#include "rhotrack/detail/measurement.h"

/* Largest row of a plot that the int16_t field of a track holds. */
#define ROWS_MAX ((uint32_t)INT16_MAX)

void rho_step_open_scan(struct rho_tracker *tracker, struct rho_look *look)
{
    /* the sensor with its pd, notch and noise; a late scan takes no row, and is no history */
    if (RHO_SECTORS && !look->teaches) {
        const unsigned known = rho_sensors_row(tracker, look->scan->sensor_id);
        look->row = known < tracker->num_rows ? &tracker->sensors[known] : 0;
    } else {
        look->row = rho_sensors_hear(tracker, look->scan->sensor_id);
    }
    if (look->row && look->row < &tracker->sensors[tracker->num_sensors]) {
        look->sensor = &look->row->sensor;
        look->learned = &look->row->learned;
    }
    rho_pd_open(look, look->row);
    if (RHO_SECTORS) {
        rho_turn_note_look(tracker, look);
    }
    if ((!RHO_SECTORS || look->teaches) && look->row) {
        rho_pace_update(&look->row->pace, look->sensor, look->time_us, look->scan->sector_from_rad,
                        look->scan->sector_to_rad);
    }
    rho_look_open_noise(tracker, look);
    look->log_range_rates -= rho_measurement_log_aliases(look->sensor, tracker->config.v_max_mps);
    look->range_rates_mps = rho_exp(look->log_range_rates);
}

static void take_parts(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_look *look = &step->look;
    const struct rho_look whole = *look;
    const uint32_t most = RHO_TRACKER_PARTS_MAX * RHO_MAX_PLOTS < ROWS_MAX
                              ? RHO_TRACKER_PARTS_MAX * RHO_MAX_PLOTS
                              : ROWS_MAX;
    const uint32_t end = whole.scan->num_plots < most ? whole.scan->num_plots : most;
    uint8_t fates[RHO_MAX_PLOTS];
    struct rho_scan part;
    for (uint32_t first = 0; first < end; first += RHO_MAX_PLOTS) {
        part = *whole.scan;
        part.plots += first;
        part.num_plots = end - first < RHO_MAX_PLOTS ? end - first : RHO_MAX_PLOTS;
        look->scan = &part;
        look->first_row = first;
        look->num_gated = part.num_plots;
        look->has_more_parts = end - first > RHO_MAX_PLOTS;
        rho_step_claim(tracker, look, &step->work);
        rho_step_update(tracker, look, &step->work);
        /* later parts are not for tracks that were assigned a plot, taken or refused */
        for (unsigned i = 0; i < tracker->num_tracks; i++) {
            struct rho_track *track = &tracker->tracks[i];
            const int had = rho_assignment_column(&tracker->assignment, i) != RHO_ASSIGNMENT_NONE;
            if (rho_look_has_in_view(look, i) && (track->plot >= 0 || had)) {
                track->plot = (int16_t)(track->plot < 0 ? -1 : track->plot + (int32_t)first);
                look->in_view[i / 32] &= ~(1u << i % 32);
            }
        }
        if (first == 0) {
            memcpy(fates, look->fates, sizeof fates);
        }
        for (uint32_t i = 0; i < look->num_gated && first > 0; i++) {
            step->num_beyond_claimed += look->fates[i] == RHO_FATE_CLAIMED ? 1u : 0u;
            step->num_beyond_invalid += look->fates[i] == RHO_FATE_INVALID ? 1u : 0u;
        }
    }
    memcpy(look->fates, fates, sizeof fates);
    memcpy(look->in_view, whole.in_view, sizeof whole.in_view);
    look->part_share = whole.part_share;
    look->part_per_m2 = whole.part_per_m2;
    look->scan = whole.scan;
    look->first_row = whole.first_row;
    look->num_gated = whole.num_gated;
}

void rho_step_take_scan(struct step *step)
{
    struct rho_look *look = &step->look;
    if (rho_notch_sensor_has_notch(look->sensor)) {
        rho_notch_mark_tracks(step->tracker, look);
    }
    rho_life_pass(step->tracker, look);
    rho_targets_group_plots(step);
    if (RHO_CLAIMS_BEYOND && look->num_inputs > RHO_MAX_PLOTS) {
        take_parts(step);
    } else {
        rho_step_claim(step->tracker, look, &step->work);
        rho_step_update(step->tracker, look, &step->work);
    }
}
