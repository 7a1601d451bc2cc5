/* SPDX-License-Identifier: MIT */
#include <float.h>
#include <string.h>

#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/measurement.h"
#include "scan_internal.h"

/* Headings */

static struct scan_heading heading_of_plots(const struct rho_message_plot_scan *scan)
{
    const int has_z = scan->kind == RHO_MESSAGE_PLOT_SCAN_POSITION_3D ||
                      scan->kind == RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_3D;
    const int has_velocity = scan->kind == RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_2D ||
                             scan->kind == RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_3D;
    return (struct scan_heading){
        .place = {scan->utime, scan->scan, scan->epoch},
        .measures = (has_z ? RHO_MEASURES_Z : 0u) | (has_velocity ? RHO_MEASURES_VELOCITY : 0u),
        .sector_from_rad = scan->sector_from_rad,
        .sector_to_rad = scan->sector_to_rad,
        .part = (uint16_t)scan->part,
        .num_parts = (uint16_t)scan->num_parts,
        .num_inputs = (uint16_t)scan->num_plots,
        .sensor_id = scan->sensor_id,
        .kind = RHO_SCAN_ASSEMBLER_PLOTS,
    };
}

static struct scan_heading heading_of_polar_plots(const struct rho_message_polar_scan *scan)
{
    return (struct scan_heading){
        .place = {scan->utime, scan->scan, scan->epoch},
        .measures = (scan->has_elevation ? RHO_MEASURES_Z : 0u) |
                    (scan->has_range_rate ? RHO_MEASURES_RANGE_RATE : 0u),
        .sector_from_rad = scan->sector_from_rad,
        .sector_to_rad = scan->sector_to_rad,
        .x_m = scan->sensor_x_m,
        .y_m = scan->sensor_y_m,
        .z_m = scan->sensor_z_m,
        .part = (uint16_t)scan->part,
        .num_parts = (uint16_t)scan->num_parts,
        .num_inputs = (uint16_t)scan->num_polar_plots,
        .sensor_id = scan->sensor_id,
        .kind = RHO_SCAN_ASSEMBLER_POLAR,
    };
}

static struct scan_heading heading_of_bearings(const struct rho_message_bearing_scan *scan)
{
    return (struct scan_heading){
        .place = {scan->utime, scan->scan, scan->epoch},
        .x_m = scan->sensor_x_m,
        .y_m = scan->sensor_y_m,
        .num_parts = 1,
        .num_inputs = (uint16_t)scan->num_bearings,
        .sensor_id = scan->sensor_id,
        .kind = RHO_SCAN_ASSEMBLER_BEARINGS,
    };
}

static struct scan_heading heading_of_directions(const struct rho_message_direction_scan *scan)
{
    return (struct scan_heading){
        .place = {scan->utime, scan->scan, scan->epoch},
        .sector_from_rad = scan->sector_from_rad,
        .sector_to_rad = scan->sector_to_rad,
        .x_m = scan->sensor_x_m,
        .y_m = scan->sensor_y_m,
        .z_m = scan->sensor_z_m,
        .num_parts = 1,
        .num_inputs = (uint16_t)scan->num_directions,
        .sensor_id = scan->sensor_id,
        .kind = RHO_SCAN_ASSEMBLER_BEARINGS,
        .has_directions = 1,
    };
}

const struct rho_scan_assembler_sensor *rho_scan_sensor(const struct rho_scan_assembler *assembler,
                                                        int32_t sensor_id)
{
    for (unsigned i = 0; i < assembler->num_known; i++) {
        if (assembler->known[i].sensor.sensor_id == sensor_id) {
            return &assembler->known[i];
        }
    }
    return &assembler->config.other;
}

enum rho_status rho_scan_decode(const struct rho_scan_assembler *assembler, unsigned message_kind,
                                const uint8_t *data, size_t size, union scan_message *message,
                                struct scan_heading *heading)
{
    enum rho_status status;
    if (RHO_SCAN_ASSEMBLER_HAS(RHO_SCAN_ASSEMBLER_BEARINGS) &&
        message_kind == SCAN_MESSAGE_DIRECTIONS) {
        status = rho_message_direction_scan_decode(data, size, &message->directions);
        if (status == RHO_OK) {
            status = rho_message_direction_scan_validate(&message->directions, NULL);
            *heading = heading_of_directions(&message->directions);
        }
    } else if (RHO_SCAN_ASSEMBLER_IS(message_kind, RHO_SCAN_ASSEMBLER_BEARINGS)) {
        status = rho_message_bearing_scan_decode(data, size, &message->bearings);
        if (status == RHO_OK) {
            status = rho_message_bearing_scan_validate(&message->bearings, NULL);
            *heading = heading_of_bearings(&message->bearings);
        }
    } else if (RHO_SCAN_ASSEMBLER_IS(message_kind, RHO_SCAN_ASSEMBLER_PLOTS)) {
        status = rho_message_plot_scan_decode(data, size, &message->plots);
        if (status == RHO_OK) {
            status = rho_message_plot_scan_validate(&message->plots, NULL);
            *heading = heading_of_plots(&message->plots);
        }
    } else {
        status = rho_message_polar_scan_decode(data, size, &message->polar);
        if (status == RHO_OK) {
            status = rho_message_polar_scan_validate(&message->polar, NULL);
            *heading = heading_of_polar_plots(&message->polar);
        }
    }
    if (status != RHO_OK) {
        return status;
    }
    /* cannot overflow: a valid time is within RHO_LIMIT_TIME_US */
    int64_t *time_us = &heading->place.time_us;
    *time_us -=
        rho_measurement_time_bias_us(&rho_scan_sensor(assembler, heading->sensor_id)->sensor);
    return *time_us >= -RHO_LIMIT_TIME_US && *time_us <= RHO_LIMIT_TIME_US ? RHO_OK
                                                                           : RHO_ERROR_VALUE;
}

/* Plots and bearings */

/* The stated sigma, or the default where none is stated, or a newcomer states a smaller one. */
static float stated_sigma(float stated, float fallback, int is_newcomer)
{
    return stated > 0.0f && !(is_newcomer && stated < fallback) ? stated : fallback;
}

static void convert_plots(struct rho_plot *to, unsigned count,
                          const struct rho_message_plot_scan *scan,
                          const struct rho_scan_assembler_noise *noise, int is_newcomer)
{
    for (unsigned i = 0; i < count; i++) {
        const struct rho_message_plot *plot = &scan->plots[i];
        const float sigma_m = stated_sigma(plot->sigma_m, noise->sigma_m, is_newcomer);
        to[i] = (struct rho_plot){.offset_us = plot->dt_us,
                                  .x_m = plot->x_m,
                                  .y_m = plot->y_m,
                                  .z_m = plot->z_m,
                                  .vx_mps = plot->vx_mps,
                                  .vy_mps = plot->vy_mps,
                                  .vz_mps = plot->vz_mps,
                                  .sigma_range_m = sigma_m,
                                  .sigma_cross_m = sigma_m,
                                  .sigma_up_m = sigma_m,
                                  .sigma_mps =
                                      stated_sigma(plot->sigma_mps, noise->sigma_mps, is_newcomer),
                                  .sigma_range_rate_mps = noise->sigma_range_rate_mps,
                                  .snr_db = plot->snr_db};
    }
}

static void convert_polar_plots(struct rho_plot *to, unsigned count,
                                const struct rho_message_polar_scan *scan, uint32_t measures,
                                const struct rho_sensor *sensor,
                                const struct rho_scan_assembler_noise *noise, int is_newcomer)
{
    struct rho_sensor seen_from = *sensor;
    struct rho_polar_plot polar = {
        .sigma_range_m = stated_sigma(scan->sigma_range_m, noise->sigma_range_m, is_newcomer),
        .sigma_azimuth_rad =
            stated_sigma(scan->sigma_azimuth_rad, noise->sigma_azimuth_rad, is_newcomer),
        .sigma_elevation_rad =
            stated_sigma(scan->sigma_elevation_rad, noise->sigma_elevation_rad, is_newcomer),
        .sigma_range_rate_mps =
            stated_sigma(scan->sigma_range_rate_mps, noise->sigma_range_rate_mps, is_newcomer)};
    seen_from.time_bias_s = 0.0f; /* the scan's time has been corrected already */
    for (unsigned i = 0; i < count; i++) {
        const struct rho_message_polar_plot *plot = &scan->polar_plots[i];
        polar.offset_us = plot->dt_us;
        polar.range_m = plot->range_m;
        polar.azimuth_rad = plot->azimuth_rad;
        polar.elevation_rad = plot->elevation_rad;
        polar.range_rate_mps = plot->range_rate_mps;
        polar.snr_db = plot->snr_db;
        /*
         * An invalid plot keeps its row, so that the rows of the plots behind it stay the same, and
         * is at no place: the tracker gives it the fate INVALID.
         */
        if (rho_measurement_from_polar(&polar, measures, &seen_from, &to[i]) != RHO_OK) {
            to[i] = (struct rho_plot){.x_m = FLT_MAX};
        }
    }
}

static void convert_bearings(struct rho_bearing *to, unsigned count,
                             const union scan_message *message, const struct scan_heading *heading,
                             const struct rho_scan_assembler_sensor *known)
{
    const struct rho_message_direction_scan *scan = &message->directions;
    const float bias_rad = known->sensor.azimuth_bias_rad;
    const float sigma_rad = heading->has_directions ? scan->sigma_rad : message->bearings.sigma_rad;
    for (unsigned i = 0; i < count; i++) {
        const struct rho_message_direction direction =
            heading->has_directions
                ? scan->directions[i]
                : (struct rho_message_direction){.bearing_rad = message->bearings.bearing_rad[i]};
        to[i] = (struct rho_bearing){
            .offset_us = direction.dt_us,
            .bearing_rad = bias_rad < 0.0f || bias_rad > 0.0f
                               ? rho_angle_difference(direction.bearing_rad, bias_rad)
                               : direction.bearing_rad,
            .sigma_rad = stated_sigma(sigma_rad, known->noise.sigma_rad, heading->is_new),
            .snr_db = direction.snr_db};
        if (direction.has_elevation) {
            to[i].elevation_rad = direction.elevation_rad;
            to[i].sigma_elevation_rad = stated_sigma(
                scan->sigma_elevation_rad, known->noise.sigma_elevation_rad, heading->is_new);
        }
    }
}

void rho_slot_add_measurements(struct rho_scan_assembler *assembler,
                               struct rho_scan_assembler_slot *slot,
                               const struct scan_heading *heading,
                               const union scan_message *message)
{
    const struct rho_scan_assembler_sensor *known = rho_scan_sensor(assembler, heading->sensor_id);
    const int is_bearings = RHO_SCAN_ASSEMBLER_IS(heading->kind, RHO_SCAN_ASSEMBLER_BEARINGS);
    const unsigned room = is_bearings ? RHO_MAX_BEARINGS : RHO_MAX_PLOTS;
    const unsigned all = slot->num_inputs + (unsigned)heading->num_inputs;
    unsigned at = 0, count = heading->num_inputs;
    for (unsigned i = 0; i < heading->part; i++) {
        at += slot->parts[i] > 0 ? slot->parts[i] - 1u : 0u;
    }
    at = at < slot->num_inputs ? at : slot->num_inputs;
    unsigned behind = slot->num_inputs - at;
    /* A full slot keeps the first rows of the scan: a part in between displaces the last ones. */
    count = count < room - at ? count : room - at;
    behind = behind < room - at - count ? behind : room - at - count;
    if (is_bearings) {
        convert_bearings(slot->bearings + at, count, message, heading, known);
        assembler->counters.bearings_in =
            rho_count(assembler->counters.bearings_in, heading->num_inputs);
    } else {
        memmove(slot->plots + at + count, slot->plots + at, behind * sizeof *slot->plots);
        if (RHO_SCAN_ASSEMBLER_IS(heading->kind, RHO_SCAN_ASSEMBLER_PLOTS)) {
            convert_plots(slot->plots + at, count, &message->plots, &known->noise, heading->is_new);
        } else {
            convert_polar_plots(slot->plots + at, count, &message->polar, heading->measures,
                                &slot->sensor, &known->noise, heading->is_new);
        }
    }
    slot->num_inputs = (uint16_t)(at + count + behind);
    slot->parts[heading->part] = (uint16_t)(heading->num_inputs + 1u);
    slot->parts_here++;
    assembler->counters.plots_no_room =
        rho_count(assembler->counters.plots_no_room, all - slot->num_inputs);
}
