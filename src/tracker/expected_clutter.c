/* SPDX-License-Identifier: MIT */
/*
 * expected_clutter: how many false plots are expected where a track is.
 *
 * The initiator measures the density of clutter. Where it has measured none, the density is the
 * number of unclaimed plots of a scan, smoothed over ten scans, over the area of all plots so far.
 */
#include "clutter.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "sight.h"

enum rho_status rho_tracker_set_clutter(struct rho_tracker *tracker, float per_m2)
{
    const enum rho_status status = rho_tracker_check(tracker, 1);
    if (status != RHO_OK || !rho_is_within(per_m2, 0.0f, 1e30f)) {
        return status != RHO_OK ? status : RHO_ERROR_VALUE;
    }
    tracker->clutter_per_m2 = per_m2;
    return RHO_OK;
}

float rho_clutter_background(const struct rho_look *look, float x_m, float y_m)
{
    const struct rho_tracker *tracker = look->tracker;
    if (look->initiator) {
        float density = rho_initiator_density(look->initiator, look->scan->sensor_id, x_m, y_m);
        if (density > 0.0f) {
            return density;
        }
    }
    if (tracker->clutter_per_m2 > 0.0f) {
        return tracker->clutter_per_m2;
    }
    float area_m2 = rho_extent_area_m2(&tracker->extent, RHO_CLUTTER_SIDE_MIN_M);
    return (tracker->unclaimed_plots > 1.0f ? tracker->unclaimed_plots : 1.0f) / area_m2;
}

float rho_clutter_background_at(const struct rho_look *look, const struct rho_plot *plot)
{
    const float density = rho_clutter_background(look, plot->x_m, plot->y_m);
    return rho_larger(density, 1e-12f); /* its logarithm is taken */
}

/* The background in the part of the scan that is claimed. */
static float part_density(const struct rho_look *look, float x_m, float y_m)
{
    float density = rho_clutter_background(look, x_m, y_m);
    if (RHO_CLAIMS_BEYOND && look->part_share > 0.0f) {
        density *= look->part_share;
        density = look->part_per_m2 > density ? look->part_per_m2 : density;
    }
    return density;
}

float rho_clutter_log_at_track(const struct rho_look *look, const struct rho_track *track)
{
    return rho_log(part_density(look, track->kalman.state[0], track->kalman.state[1]));
}

float rho_clutter_in_gate(const struct rho_look *look, const struct rho_track *track)
{
    if (!look->scan) {
        return 0.0f;
    }
    const float sigma_m = rho_track_sigma_m(track);
    return 0.5f * RHO_TWO_PI * GATE_CIRCLE_SIGMAS * GATE_CIRCLE_SIGMAS * sigma_m * sigma_m *
           part_density(look, track->kalman.state[0], track->kalman.state[1]);
}

/*
 * The initiator has measured the density of the first parts of earlier scans alone. The density of
 * a later part is that of its held plots over their extent, or that of the first part times the
 * scan's plots over RHO_MAX_PLOTS, whichever is larger.
 */
void rho_clutter_measure_part(struct rho_look *look)
{
    struct rho_extent extent = {0.0f, 0.0f, 0.0f, 0.0f};
    float num = 0.0f;
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (look->fates[i] == RHO_FATE_HELD) {
            const struct rho_plot *plot = &look->scan->plots[i];
            if (num < 1.0f) {
                extent = (struct rho_extent){plot->x_m, plot->x_m, plot->y_m, plot->y_m};
            }
            rho_extent_add(&extent, plot->x_m, plot->y_m);
            num += 1.0f;
        }
    }
    look->part_per_m2 = num / rho_extent_area_m2(&extent, RHO_CLUTTER_SIDE_MIN_M);
    look->part_share = (float)look->num_inputs / (float)RHO_MAX_PLOTS;
}

void rho_clutter_smooth_mean(float *mean, float newest)
{
    *mean += NEWEST_SCAN_WEIGHT * (newest - *mean);
}

void rho_clutter_count_unclaimed(struct rho_tracker *tracker, const struct rho_look *look)
{
    float unclaimed = 0.0f;
    for (uint32_t i = 0; i < look->num_gated; i++) {
        uint8_t fate = look->fates[i];
        unclaimed += fate == RHO_FATE_HELD || fate == RHO_FATE_NO_ROOM ? 1.0f : 0.0f;
    }
    rho_clutter_smooth_mean(&tracker->unclaimed_plots,
                            unclaimed * (RHO_SECTORS ? rho_turn_num_scans(look) : 1.0f));
}
