/* SPDX-License-Identifier: MIT */
#include "node_passive.h"

#include <math.h>
#include <string.h>

#include "common.h"

/* Fewer passive sensors give no positions. */
#define SENSORS_MIN 2

/* Scans of one sensor that are refused in a row until it is believed that it has moved. */
#define MOVED_SCANS 16

/*
 * Nobody knows how many passive sensors there are before the first frame: it waits for as many as there can be, until
 * the next frame's scans come, or for its time. Were it closed by the second sensor, the others would be late.
 */
static void open_frames(struct node_passive *passive)
{
    const double *value = passive->parameters->value;
    struct rho_frames_config config;

    rho_frames_config_default(&config);
    config.tolerance_us = llround(value[PARAMETER_FRAME_TOLERANCE_S] * 1e6);
    config.jump_max_us = llround(value[PARAMETER_JUMP_MAX_S] * 1e6);
    config.follow_scans = (uint16_t)value[PARAMETER_FOLLOW_SCANS];
    config.sensors_min = RHO_MAX_PASSIVE_SENSORS;
    if (rho_frames_init(&passive->frames, sizeof passive->frames, &config) != RHO_OK) {
        fail(EXIT_USAGE, "node: frame_tolerance_s has to be 10 s at most, and below jump_max_s");
    }
}

void node_passive_open(struct node_passive *passive, const struct parameters *parameters)
{
    passive->parameters = parameters;
    memset(passive->refused_scans, 0, sizeof passive->refused_scans);
    open_frames(passive);
}

void node_passive_forget(struct node_passive *passive)
{
    struct rho_frames_counters counters = passive->frames.counters;

    open_frames(passive);
    counters.scans_taken = 0; /* by this frames know that there is no clock yet */
    passive->frames.counters = counters;
    memset(passive->refused_scans, 0, sizeof passive->refused_scans);
}

void node_passive_has_frame(struct node_passive *passive)
{
    passive->frames.config.sensors_min = SENSORS_MIN;
}

/*
 * The cells of a search hold sensors that are not farther apart than this. A frame with one that is would be refused as
 * a whole, so the sensor is, which came last.
 */
static int is_near(const struct node_passive *passive, const struct rho_bearing_scan *scan,
                   float apart_max_m)
{
    for (unsigned i = 0; i < passive->frames.num_sensors; i++) {
        const struct rho_frames_sensor *known = &passive->frames.sensors[i];
        float apart_m = hypotf(known->x_m - scan->x_m, known->y_m - scan->y_m);

        if (apart_m > apart_max_m) {
            return 0;
        }
    }
    return 1;
}

int node_passive_take(struct node_passive *passive, const struct rho_bearing_scan *scan,
                      float apart_max_m)
{
    if (!is_near(passive, scan, apart_max_m) || rho_frames_push(&passive->frames, scan) != RHO_OK) {
        return 0;
    }
    for (unsigned i = 0; i < passive->frames.num_sensors; i++) {
        if (passive->frames.sensors[i].sensor_id == scan->sensor_id) {
            passive->refused_scans[i] = 0;
        }
    }
    return 1;
}

int node_is_heard(const struct rho_feed *feed, int32_t sensor_id, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_feed_source *source = &feed->sources[i];

        if (source->is_used && source->sensor_id == sensor_id &&
            (now_us <= source->heard_us ||
             (uint64_t)now_us - (uint64_t)source->heard_us <= (uint64_t)feed->config.jump_max_us)) {
            return 1;
        }
    }
    return 0;
}

int node_passive_is_blocked(struct node_passive *passive, const struct rho_feed *feed,
                            const struct rho_bearing_scan *scan, int64_t now_us)
{
    for (unsigned i = 0; i < passive->frames.num_sensors; i++) {
        int32_t sensor_id = passive->frames.sensors[i].sensor_id;

        if (sensor_id == scan->sensor_id ? ++passive->refused_scans[i] >= MOVED_SCANS
                                         : !node_is_heard(feed, sensor_id, now_us)) {
            return 1;
        }
    }
    return 0;
}
