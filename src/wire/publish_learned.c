/* SPDX-License-Identifier: MIT */
/*
 * publish_learned: fills the message with the noise and pd that the tracker has learned for
 * a sensor.
 */
#include "message_clamps.h"
#include "rhotrack/publish.h"

int rho_publish_learned(const struct rho_tracker *tracker, unsigned place,
                        struct rho_message_learned *learned)
{
    struct rho_tracker_known known;
    const struct rho_sensor *sensor =
        tracker && place < tracker->num_sensors ? &tracker->sensors[place].sensor : NULL;

    if (!learned || !sensor || rho_tracker_known_of(tracker, sensor->sensor_id, &known) != RHO_OK) {
        return 0;
    }
    *learned = (struct rho_message_learned){
        .utime = tracker->time_us,
        .sensor_id = rho_clamp_sensor_id(sensor->sensor_id),
        .innovations = rho_clamp_to_int16(known.innovations),
        .sigma_range_factor = known.range_factor,
        .sigma_cross_factor = known.cross_factor,
        .looks = (int32_t)known.looks,
        .range_max_m = sensor->range_max_m,
        .pd_stated = sensor->pd,
    };
    for (unsigned ring = 0; ring < RHO_LEARN_RINGS; ring++) {
        learned->pd[ring] = known.pd[ring];
    }
    return 1;
}
