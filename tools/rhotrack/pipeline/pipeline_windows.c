/* SPDX-License-Identifier: MIT */
/*
 * pipeline_windows: which sensors' plots start tracks together.
 *
 * Two radars that see much the same ground start tracks from one window: with twice as many plots a
 * second they find targets sooner. They pair in the order in which they were described. Three are
 * too many for a window of seven scans, and the faster of two whose turns differ much would leave
 * the other no room. Live, sensors that the config does not name pair with nobody: a stranger's
 * scans would take half of a radar's window.
 */
#include <math.h>

#include "pipeline/pipeline.h"
#include "rhotrack/detail/angle.h"

/*
 * The places' distance and the ranges' difference, together, are at most this share of the shorter
 * range: then each sees about half of what the other sees.
 */
#define APART_MAX 0.8f
/*
 * Turns of one during a turn of the other; fewer where they have parted, so that they do not part
 * and pair again by turns.
 */
#define TURNS_MAX 1.5f
#define TURNS_AGAIN_MAX 1.4f

/* Time from one look to the next; 0: not known yet. */
static float look_interval_s(const struct rho_tracker *tracker, int32_t sensor_id)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        if (tracker->paces[i].sensor_id == sensor_id) {
            return tracker->paces[i].interval_s;
        }
    }
    return 0.0f;
}

static bool see_same_ground(const struct rho_tracker *tracker, const struct rho_sensor *one,
                            const struct rho_sensor *other, float turns_max)
{
    const float apart_m = hypotf(one->x_m - other->x_m, one->y_m - other->y_m);
    const float one_s = look_interval_s(tracker, one->sensor_id);
    const float other_s = look_interval_s(tracker, other->sensor_id);
    const bool is_known = one_s > 0.0f && other_s > 0.0f;

    return rho_angle_is_circle(one->sector_from_rad, one->sector_to_rad) &&
           rho_angle_is_circle(other->sector_from_rad, other->sector_to_rad) &&
           apart_m + fabsf(one->range_max_m - other->range_max_m) <=
               APART_MAX * fminf(one->range_max_m, other->range_max_m) &&
           (!is_known || fmaxf(one_s, other_s) <= turns_max * fminf(one_s, other_s));
}

/*
 * Its plots were in a window of its own at some time: it has parted from whom it might pair with.
 */
static bool had_own_window(const struct pipeline *pipeline, int32_t sensor_id)
{
    for (size_t i = 0; i < pipeline->num_initiators && pipeline->has_sensor; i++) {
        if (pipeline->initiators[i].sensor_id == sensor_id) {
            return true;
        }
    }
    return false;
}

static bool is_sensor_in_config(const struct pipeline *pipeline, int32_t sensor_id)
{
    for (size_t i = 0; i < pipeline->num_named && pipeline->is_live; i++) {
        if (pipeline->named[i] == sensor_id) {
            return true;
        }
    }
    return !pipeline->is_live;
}

int32_t pipeline_window_of(const struct pipeline *pipeline, const struct rho_scan *scan)
{
    const struct rho_tracker *tracker = pipeline->tracker;
    bool is_paired[RHO_MAX_SENSORS] = {false};

    if (!rho_angle_is_circle(scan->sector_from_rad, scan->sector_to_rad)) {
        return scan->sensor_id;
    }
    for (unsigned i = 0; i < tracker->num_sensors; i++) {
        const struct rho_sensor *one = &tracker->sensors[i];

        for (unsigned j = i + 1; j < tracker->num_sensors && !is_paired[i]; j++) {
            const struct rho_sensor *other = &tracker->sensors[j];

            is_paired[i] =
                !is_paired[j] && is_sensor_in_config(pipeline, one->sensor_id) &&
                is_sensor_in_config(pipeline, other->sensor_id) &&
                see_same_ground(tracker, one, other,
                                had_own_window(pipeline, other->sensor_id) ? TURNS_AGAIN_MAX
                                                                           : TURNS_MAX);
            is_paired[j] |= is_paired[i];
            if (is_paired[i] && other->sensor_id == scan->sensor_id) {
                return one->sensor_id;
            }
        }
    }
    return scan->sensor_id;
}
