/* SPDX-License-Identifier: MIT */
/*
 * radars_sharing_window: which radars share an initiation window.
 *
 * Two radars with much the same coverage start tracks from one window: with twice the plot rate
 * they find targets sooner. Radars pair in the order of their descriptions. Three radars would be
 * too many for a window of seven scans, and of two with very different revolution times the faster
 * would fill the window. In live operation, sensors that the configuration does not name share no
 * window: a stranger's scans would take half of it.
 */
#include <math.h>

#include "pipeline/pipeline.h"
#include "rhotrack/detail/angle.h"

/*
 * Coverages are much the same where the distance of the radars plus the difference of their ranges
 * is at most this share of the shorter range: each then sees about half of the other's coverage.
 */
#define APART_MAX 0.8f
/*
 * Largest ratio of two radars' revolution times in a shared window; smaller for pairing again after
 * a separation, so that radars do not pair and part repeatedly.
 */
#define TURNS_MAX 1.5f
#define TURNS_AGAIN_MAX 1.4f

/* Interval between a sensor's scans; 0: not known yet. */
static float sensor_scan_interval_s(const struct rho_tracker *tracker, int32_t sensor_id)
{
    for (unsigned i = 0; i < tracker->num_rows; i++) {
        if (tracker->sensors[i].sensor.sensor_id == sensor_id) {
            return tracker->sensors[i].pace.interval_s;
        }
    }
    return 0.0f;
}

static bool have_like_coverage_and_turns(const struct rho_tracker *tracker,
                                         const struct rho_sensor *one,
                                         const struct rho_sensor *other, float turns_max)
{
    const float apart_m = hypotf(one->x_m - other->x_m, one->y_m - other->y_m);
    const float one_s = sensor_scan_interval_s(tracker, one->sensor_id);
    const float other_s = sensor_scan_interval_s(tracker, other->sensor_id);
    const bool is_known = one_s > 0.0f && other_s > 0.0f;

    return rho_angle_is_circle(one->sector_from_rad, one->sector_to_rad) &&
           rho_angle_is_circle(other->sector_from_rad, other->sector_to_rad) &&
           apart_m + fabsf(one->range_max_m - other->range_max_m) <=
               APART_MAX * fminf(one->range_max_m, other->range_max_m) &&
           (!is_known || fmaxf(one_s, other_s) <= turns_max * fminf(one_s, other_s));
}

/*
 * True where the sensor had a window of its own before: it has parted from a window that it shared.
 */
static bool had_sensor_own_window(const struct pipeline *pipeline, int32_t sensor_id)
{
    for (size_t i = 0; i < pipeline->num_initiators && pipeline->has_sensor; i++) {
        if (pipeline->initiators[i].sensor_id == sensor_id) {
            return true;
        }
    }
    return false;
}

static bool may_sensor_share_window(const struct pipeline *pipeline, int32_t sensor_id)
{
    for (size_t i = 0; i < pipeline->num_named && pipeline->is_live; i++) {
        if (pipeline->named[i] == sensor_id) {
            return true;
        }
    }
    return !pipeline->is_live;
}

int32_t pipeline_window_sensor_id(const struct pipeline *pipeline, const struct rho_scan *scan)
{
    const struct rho_tracker *tracker = pipeline->tracker;
    bool is_paired[RHO_MAX_SENSORS] = {false};

    if (!rho_angle_is_circle(scan->sector_from_rad, scan->sector_to_rad)) {
        return scan->sensor_id;
    }
    for (unsigned i = 0; i < tracker->num_sensors; i++) {
        const struct rho_sensor *one = &tracker->sensors[i].sensor;

        for (unsigned j = i + 1; j < tracker->num_sensors && !is_paired[i]; j++) {
            const struct rho_sensor *other = &tracker->sensors[j].sensor;

            is_paired[i] = !is_paired[j] && may_sensor_share_window(pipeline, one->sensor_id) &&
                           may_sensor_share_window(pipeline, other->sensor_id) &&
                           have_like_coverage_and_turns(
                               tracker, one, other,
                               had_sensor_own_window(pipeline, other->sensor_id) ? TURNS_AGAIN_MAX
                                                                                 : TURNS_MAX);
            is_paired[j] |= is_paired[i];
            if (is_paired[i] && other->sensor_id == scan->sensor_id) {
                return one->sensor_id;
            }
        }
    }
    return scan->sensor_id;
}
