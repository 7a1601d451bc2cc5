/* SPDX-License-Identifier: MIT */
/* publish_sensors: messages of each sensor: reception, clock, health, and learned noise and pd. */
#include "message_clamps.h"
#include "rhotrack/publish.h"

#define PART_SENSORS RHO_MESSAGE_SENSOR_LIST_MAX_SENSORS

int rho_publish_sensor(const struct rho_scan_assembler *assembler,
                       const struct rho_tracker *tracker, int64_t now_us, unsigned place,
                       struct rho_message_sensor *sensor)
{
    const struct rho_scan_assembler_source *source =
        assembler && place < RHO_MAX_SENSORS ? &assembler->sources[place] : NULL;
    if (!sensor || !source || !source->is_used) {
        return 0;
    }
    const uint64_t age_us = rho_elapsed_us(now_us, source->heard_us);
    *sensor = (struct rho_message_sensor){
        .sensor_id = source->sensor_id,
        .kind = source->kind == RHO_SCAN_ASSEMBLER_PLOTS   ? RHO_MESSAGE_SENSOR_PLOTS
                : source->kind == RHO_SCAN_ASSEMBLER_POLAR ? RHO_MESSAGE_SENSOR_POLAR
                                                           : RHO_MESSAGE_SENSOR_BEARINGS,
        .is_silent = age_us > (uint64_t)assembler->config.jump_max_us,
        .is_off_clock = source->off_clock > 0,
        .scans = source->scans,
        .scan_utime = source->place.time_us,
        .heard_age_us = (int32_t)(age_us < INT32_MAX ? age_us : INT32_MAX),
        .interval_us = rho_clamp_to_int32(source->interval_us),
    };
    if (RHO_SECTORS && tracker && source->kind != RHO_SCAN_ASSEMBLER_BEARINGS) {
        const struct rho_tracker_look *look = rho_tracker_look_of(tracker, source->sensor_id);
        if (look) {
            sensor->is_doubted = look->is_suspect != 0;
            sensor->watched = (int16_t)look->watched;
            sensor->watched_hits = (int16_t)look->watched_hits;
            sensor->seen_share = look->seen_share;
            sensor->innovation_factor = look->distance2;
        }
    }
    return 1;
}

static unsigned count_sources(const struct rho_scan_assembler *assembler)
{
    unsigned count = 0;
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        count += assembler->sources[i].is_used != 0;
    }
    return count;
}

uint16_t rho_publish_num_sensor_parts(const struct rho_scan_assembler *assembler)
{
    return (uint16_t)rho_num_parts(assembler ? count_sources(assembler) : 0, PART_SENSORS);
}

enum rho_status rho_publish_sensors(const struct rho_scan_assembler *assembler,
                                    const struct rho_tracker *tracker, int64_t now_us,
                                    uint16_t part, struct rho_message_sensor_list *list)
{
    struct rho_message_sensor sensor;
    unsigned at = 0;
    if (!assembler || !list) {
        return RHO_ERROR_NULL;
    }
    const unsigned sensors = count_sources(assembler);
    const unsigned num_parts = rho_num_parts(sensors, PART_SENSORS);
    if (part >= num_parts) {
        return RHO_ERROR_VALUE;
    }
    list->utime = tracker ? tracker->time_us : 0;
    list->scan = list->epoch = 0;
    list->num_sensors_total = (int16_t)sensors;
    list->part = (int16_t)part;
    list->num_parts = (int16_t)num_parts;
    list->num_sensors = 0;
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        if (rho_publish_sensor(assembler, tracker, now_us, i, &sensor) &&
            at++ / PART_SENSORS == part) {
            list->sensors[list->num_sensors++] = sensor;
        }
    }
    return RHO_OK;
}

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
