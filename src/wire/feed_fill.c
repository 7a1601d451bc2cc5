/* SPDX-License-Identifier: MIT */
#include <float.h>
#include <string.h>

#include "feed_parts.h"
#include "rhotrack/angle.h"
#include "rhotrack/measurement.h"

#define NOT_A_PLACE FLT_MAX /* beyond every limit: the tracker's fate of it is INVALID */

/* ---- Headings ---- */

static struct feed_heading plots_heading(const struct rho_message_plot_scan *scan)
{
    struct feed_heading heading = {
        .place = {scan->utime, scan->scan, scan->epoch},
        .sector_from_rad = scan->sector_from_rad,
        .sector_to_rad = scan->sector_to_rad,
        .part = (uint16_t)scan->part,
        .num_parts = (uint16_t)scan->num_parts,
        .num_inputs = (uint16_t)scan->num_plots,
        .sensor_id = scan->sensor_id,
        .kind = RHO_FEED_PLOTS,
    };

    if (scan->kind == RHO_MESSAGE_PLOT_SCAN_POSITION_3D ||
        scan->kind == RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_3D) {
        heading.measures |= RHO_MEASURES_Z;
    }
    if (scan->kind == RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_2D ||
        scan->kind == RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_3D) {
        heading.measures |= RHO_MEASURES_VELOCITY;
    }
    return heading;
}

static struct feed_heading polar_heading(const struct rho_message_polar_scan *scan)
{
    return (struct feed_heading){
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
        .kind = RHO_FEED_POLAR,
    };
}

static struct feed_heading bearings_heading(const struct rho_message_bearing_scan *scan)
{
    return (struct feed_heading){
        .place = {scan->utime, scan->scan, scan->epoch},
        .x_m = scan->sensor_x_m,
        .y_m = scan->sensor_y_m,
        .num_parts = 1,
        .num_inputs = (uint16_t)scan->num_bearings,
        .sensor_id = scan->sensor_id,
        .kind = RHO_FEED_BEARINGS,
    };
}

enum rho_status rho_feed_open_message(enum rho_feed_kind kind, const uint8_t *data, size_t size,
                                      union feed_message *message, struct feed_heading *heading)
{
    enum rho_status status;

    if (RHO_FEED_IS(kind, RHO_FEED_BEARINGS)) {
        status = rho_message_bearing_scan_decode(data, size, &message->bearings);
        if (status == RHO_OK) {
            status = rho_message_bearing_scan_validate(&message->bearings, NULL);
            *heading = bearings_heading(&message->bearings);
        }
    } else if (RHO_FEED_IS(kind, RHO_FEED_PLOTS)) {
        status = rho_message_plot_scan_decode(data, size, &message->plots);
        if (status == RHO_OK) {
            status = rho_message_plot_scan_validate(&message->plots, NULL);
            *heading = plots_heading(&message->plots);
        }
    } else {
        status = rho_message_polar_scan_decode(data, size, &message->polar);
        if (status == RHO_OK) {
            status = rho_message_polar_scan_validate(&message->polar, NULL);
            *heading = polar_heading(&message->polar);
        }
    }
    return status;
}

/* ---- Plots and bearings ---- */

/* A newcomer's plots do not pull tracks more than those of a sensor that says nothing. */
static float or_else(float said, float otherwise, int is_new)
{
    return said > 0.0f && !(is_new && said < otherwise) ? said : otherwise;
}

static void fill_plots(struct rho_plot *to, unsigned count,
                       const struct rho_message_plot_scan *scan, const struct rho_feed_noise *noise,
                       int is_new)
{
    for (unsigned i = 0; i < count; i++) {
        const struct rho_message_plot *plot = &scan->plots[i];
        float sigma_m = or_else(plot->sigma_m, noise->sigma_m, is_new);

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
                                  .sigma_mps = or_else(plot->sigma_mps, noise->sigma_mps, is_new),
                                  .sigma_range_rate_mps = noise->sigma_range_rate_mps,
                                  .snr_db = plot->snr_db};
    }
}

static void fill_polar(struct rho_plot *to, unsigned count,
                       const struct rho_message_polar_scan *scan, uint32_t measures,
                       const struct rho_sensor *sensor, const struct rho_feed_noise *noise,
                       int is_new)
{
    struct rho_sensor seen_from = *sensor;
    struct rho_polar_plot polar = {
        .sigma_range_m = or_else(scan->sigma_range_m, noise->sigma_range_m, is_new),
        .sigma_azimuth_rad = or_else(scan->sigma_azimuth_rad, noise->sigma_azimuth_rad, is_new),
        .sigma_elevation_rad =
            or_else(scan->sigma_elevation_rad, noise->sigma_elevation_rad, is_new),
        .sigma_range_rate_mps =
            or_else(scan->sigma_range_rate_mps, noise->sigma_range_rate_mps, is_new)};

    seen_from.time_bias_s = 0.0f; /* it is off the scan's time */
    for (unsigned i = 0; i < count; i++) {
        const struct rho_message_polar_plot *plot = &scan->polar_plots[i];

        polar.offset_us = plot->dt_us;
        polar.range_m = plot->range_m;
        polar.azimuth_rad = plot->azimuth_rad;
        polar.elevation_rad = plot->elevation_rad;
        polar.range_rate_mps = plot->range_rate_mps;
        polar.snr_db = plot->snr_db;
        /* A plot that is no place keeps its row, so that those behind it keep theirs. */
        if (rho_measurement_from_polar(&polar, measures, &seen_from, &to[i]) != RHO_OK) {
            to[i] = (struct rho_plot){.x_m = NOT_A_PLACE};
        }
    }
}

static void fill_bearings(struct rho_bearing *to, unsigned count,
                          const struct rho_message_bearing_scan *scan,
                          const struct rho_feed_sensor *known, int is_new)
{
    for (unsigned i = 0; i < count; i++) {
        float bearing_rad = scan->bearing_rad[i];

        if (known->sensor.azimuth_bias_rad < 0.0f || known->sensor.azimuth_bias_rad > 0.0f) {
            bearing_rad = rho_angle_difference(bearing_rad, known->sensor.azimuth_bias_rad);
        }
        to[i] = (struct rho_bearing){.bearing_rad = bearing_rad,
                                     .sigma_rad =
                                         or_else(scan->sigma_rad, known->noise.sigma_rad, is_new)};
    }
}

const struct rho_feed_sensor *rho_feed_known(const struct rho_feed *feed, int32_t sensor_id)
{
    for (unsigned i = 0; i < feed->num_known; i++) {
        if (feed->known[i].sensor.sensor_id == sensor_id) {
            return &feed->known[i];
        }
    }
    return &feed->config.other;
}

/* A valid time is within its limit, so that the difference fits. */
int rho_feed_right_time(const struct rho_feed *feed, struct feed_heading *heading)
{
    int64_t *time_us = &heading->place.time_us;

    *time_us -= rho_measurement_time_bias_us(&rho_feed_known(feed, heading->sensor_id)->sensor);
    return *time_us >= -RHO_LIMIT_TIME_US && *time_us <= RHO_LIMIT_TIME_US;
}

/* ---- Parts ---- */

/* Inputs of the parts before this one that are here, as far as they are kept. */
static unsigned inputs_before(const struct rho_feed_slot *slot, unsigned part)
{
    unsigned count = 0;

    for (unsigned i = 0; i < part; i++) {
        count += slot->parts[i] > 0 ? slot->parts[i] - 1u : 0u;
    }
    return count < slot->num_inputs ? count : slot->num_inputs;
}

void rho_feed_fill(struct rho_feed *feed, struct rho_feed_slot *slot,
                   const struct feed_heading *heading, const union feed_message *message)
{
    const struct rho_feed_sensor *known = rho_feed_known(feed, heading->sensor_id);
    unsigned room =
        RHO_FEED_IS(heading->kind, RHO_FEED_BEARINGS) ? RHO_MAX_BEARINGS : RHO_MAX_PLOTS;
    unsigned at = inputs_before(slot, heading->part), count = heading->num_inputs;
    unsigned behind = slot->num_inputs - at, dropped = 0;

    /* What comes first counts: a part in between pushes the last ones out. */
    if (at + count > room) {
        dropped += at + count - room;
        count = room - at;
    }
    if (at + count + behind > room) {
        dropped += at + count + behind - room;
        behind = room - at - count;
    }
    if (RHO_FEED_IS(heading->kind, RHO_FEED_BEARINGS)) {
        fill_bearings(slot->bearings + at, count, &message->bearings, known, heading->is_new);
        feed->counters.bearings_in = rho_count(feed->counters.bearings_in, heading->num_inputs);
    } else {
        memmove(slot->plots + at + count, slot->plots + at, behind * sizeof *slot->plots);
        if (RHO_FEED_IS(heading->kind, RHO_FEED_PLOTS)) {
            fill_plots(slot->plots + at, count, &message->plots, &known->noise, heading->is_new);
        } else {
            fill_polar(slot->plots + at, count, &message->polar, heading->measures, &slot->sensor,
                       &known->noise, heading->is_new);
        }
    }
    slot->num_inputs = (uint16_t)(at + count + behind);
    slot->parts[heading->part] = (uint16_t)(heading->num_inputs + 1u);
    slot->parts_here++;
    feed->counters.plots_no_room = rho_count(feed->counters.plots_no_room, dropped);
}
