/* SPDX-License-Identifier: MIT */
/*
 * publish_sensor_reception_and_health: messages of the state of each sensor: reception, clock, and
 * sensor health.
 */
#include "rhotrack/publish.h"

#define PART_SENSORS RHO_MESSAGE_SENSOR_LIST_MAX_SENSORS

/* ---- One sensor ---- */

static int8_t message_kind_of_source(const struct rho_scan_assembler_source *source)
{
    return source->kind == RHO_SCAN_ASSEMBLER_PLOTS   ? RHO_MESSAGE_SENSOR_PLOTS
           : source->kind == RHO_SCAN_ASSEMBLER_POLAR ? RHO_MESSAGE_SENSOR_POLAR
                                                      : RHO_MESSAGE_SENSOR_BEARINGS;
}

static int32_t clamp_to_int32(uint64_t value)
{
    return (int32_t)(value < INT32_MAX ? value : INT32_MAX);
}

int rho_publish_sensor(const struct rho_scan_assembler *assembler,
                       const struct rho_tracker *tracker, int64_t now_us, unsigned place,
                       struct rho_message_sensor *sensor)
{
    const struct rho_scan_assembler_source *source =
        assembler && place < RHO_MAX_SENSORS ? &assembler->sources[place] : NULL;

    if (!sensor || !source || !source->is_used) {
        return 0;
    }
    *sensor = (struct rho_message_sensor){
        .sensor_id = source->sensor_id,
        .kind = message_kind_of_source(source),
        .is_silent =
            rho_elapsed_us(now_us, source->heard_us) > (uint64_t)assembler->config.jump_max_us,
        .is_off_clock = source->off_clock > 0,
        .scans = source->scans,
        .scan_utime = source->place.time_us,
        .heard_age_us = clamp_to_int32(rho_elapsed_us(now_us, source->heard_us)),
        .interval_us = clamp_to_int32(source->interval_us),
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

/* ---- All of them ---- */

static unsigned count_used_sources(const struct rho_scan_assembler *assembler)
{
    unsigned count = 0;

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        count += assembler->sources[i].is_used != 0;
    }
    return count;
}

static unsigned num_parts_for_sensors(unsigned sensors)
{
    return sensors <= PART_SENSORS ? 1 : (sensors + PART_SENSORS - 1) / PART_SENSORS;
}

uint16_t rho_publish_num_sensor_parts(const struct rho_scan_assembler *assembler)
{
    return (uint16_t)num_parts_for_sensors(assembler ? count_used_sources(assembler) : 0);
}

enum rho_status rho_publish_sensors(const struct rho_scan_assembler *assembler,
                                    const struct rho_tracker *tracker, int64_t now_us,
                                    uint16_t part, struct rho_message_sensor_list *list)
{
    struct rho_message_sensor sensor;
    unsigned sensors, at = 0;

    if (!assembler || !list) {
        return RHO_ERROR_NULL;
    }
    sensors = count_used_sources(assembler);
    if (part >= num_parts_for_sensors(sensors)) {
        return RHO_ERROR_VALUE;
    }
    list->utime = tracker ? tracker->time_us : 0;
    list->scan = list->epoch = 0;
    list->num_sensors_total = (int16_t)sensors;
    list->part = (int16_t)part;
    list->num_parts = (int16_t)num_parts_for_sensors(sensors);
    list->num_sensors = 0;
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        if (rho_publish_sensor(assembler, tracker, now_us, i, &sensor) &&
            at++ / PART_SENSORS == part) {
            list->sensors[list->num_sensors++] = sensor;
        }
    }
    return RHO_OK;
}
