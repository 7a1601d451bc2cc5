/* SPDX-License-Identifier: MIT */
/*
 * sensors: the table of sensors, one row a sensor. Described sensors have the first rows, in the
 * order of their descriptions; sensors that were only heard have the rows behind them.
 */
#include <string.h>

#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/doppler_notch.h"
#include "rhotrack/detail/measurement.h"
#include "sensors.h"

unsigned rho_sensors_row(const struct rho_tracker *tracker, int32_t sensor_id)
{
    unsigned row = 0;
    while (row < tracker->num_rows && tracker->sensors[row].sensor.sensor_id != sensor_id) {
        row++;
    }
    return row;
}

const struct rho_sensor *rho_sensors_find(const struct rho_tracker *tracker, int32_t sensor_id)
{
    const unsigned row = rho_sensors_row(tracker, sensor_id);
    return row < tracker->num_sensors ? &tracker->sensors[row].sensor : 0;
}

const struct rho_tracker_look *rho_tracker_look_of(const struct rho_tracker *tracker,
                                                   int32_t sensor_id)
{
    const unsigned row = tracker ? rho_sensors_row(tracker, sensor_id) : 0;
    return tracker && row < tracker->num_rows && tracker->sensors[row].look.count > 0
               ? &tracker->sensors[row].look
               : 0;
}

int rho_sensors_is_usable(const struct rho_sensor *sensor)
{
    return rho_measurement_is_valid_site(sensor) && rho_is_within(sensor->pd, 0.01f, 0.999f) &&
           rho_is_within(sensor->range_min_m, 0.0f, 2.0f * RHO_LIMIT_POSITION_M) &&
           rho_is_within(sensor->range_max_m, 0.0f, 2.0f * RHO_LIMIT_POSITION_M) &&
           sensor->range_min_m < sensor->range_max_m &&
           (!RHO_DOPPLER_NOTCH || rho_notch_is_valid(sensor)) &&
           (!RHO_SHARES_PLOTS || rho_cell_is_usable(sensor)) &&
           rho_angle_is_valid_sector(sensor->sector_from_rad, sensor->sector_to_rad);
}

/* The pace's time is that of the newest scan of the fixed direction only. */
static int64_t heard_us(const struct rho_tracker_sensor *row)
{
    const int64_t pace_us = row->pace.time_us;
    return row->look.count > 0 && row->look.time_us > pace_us ? row->look.time_us : pace_us;
}

/*
 * A cleared row for a new sensor, behind all others: in a full table that of the undescribed sensor
 * heard longest ago. num_rows RHO_MAX_SENSORS: all rows are of described sensors.
 */
static unsigned make_row(struct rho_tracker *tracker, int32_t sensor_id)
{
    unsigned row = tracker->num_rows;
    if (row == RHO_MAX_SENSORS) {
        row = tracker->num_sensors;
        for (unsigned i = row + 1u; RHO_MAX_SENSORS > 1 && i < RHO_MAX_SENSORS; i++) {
            row = heard_us(&tracker->sensors[i]) < heard_us(&tracker->sensors[row]) ? i : row;
        }
    } else {
        tracker->num_rows++;
    }
    if (row < RHO_MAX_SENSORS) {
        /* clears the padding, too, as snapshots hold it */
        memset(&tracker->sensors[row], 0, sizeof tracker->sensors[row]);
        tracker->sensors[row].sensor.sensor_id = sensor_id;
    }
    return row;
}

struct rho_tracker_sensor *rho_sensors_hear(struct rho_tracker *tracker, int32_t sensor_id)
{
    unsigned row = rho_sensors_row(tracker, sensor_id);
    row = row < tracker->num_rows ? row : make_row(tracker, sensor_id);
    return row < RHO_MAX_SENSORS ? &tracker->sensors[row] : 0;
}

static void swap_rows(struct rho_tracker_sensor *one, struct rho_tracker_sensor *other)
{
    unsigned char *a = (unsigned char *)one, *b = (unsigned char *)other;
    for (size_t i = 0; RHO_MAX_SENSORS > 1 && one != other && i < sizeof *one; i++) {
        const unsigned char byte = a[i];
        a[i] = b[i];
        b[i] = byte;
    }
}

enum rho_status rho_tracker_set_sensor(struct rho_tracker *tracker, const struct rho_sensor *sensor)
{
    const enum rho_status status = rho_tracker_check(tracker, sensor != 0);
    if (status != RHO_OK || !rho_sensors_is_usable(sensor)) {
        return status != RHO_OK ? status : RHO_ERROR_CONFIG;
    }
    unsigned row = rho_sensors_row(tracker, sensor->sensor_id);
    if (row >= tracker->num_sensors) {
        if (tracker->num_sensors == RHO_MAX_SENSORS) {
            return RHO_ERROR_CAPACITY;
        }
        row = row < tracker->num_rows ? row : make_row(tracker, sensor->sensor_id);
        swap_rows(&tracker->sensors[row], &tracker->sensors[tracker->num_sensors]);
        row = tracker->num_sensors++;
    }
    tracker->sensors[row].sensor = *sensor;
    return RHO_OK;
}

enum rho_status rho_tracker_forget_sensor(struct rho_tracker *tracker, int32_t sensor_id)
{
    const enum rho_status status = rho_tracker_check(tracker, 1);
    const unsigned row = status == RHO_OK ? rho_sensors_row(tracker, sensor_id) : 0;
    if (status != RHO_OK || row >= tracker->num_sensors) {
        return status != RHO_OK ? status : RHO_ERROR_STATE;
    }
    struct rho_tracker_sensor *rows = tracker->sensors;
    tracker->num_sensors--;
    tracker->num_rows--;
    swap_rows(&rows[row], &rows[tracker->num_sensors]);
    swap_rows(&rows[tracker->num_sensors], &rows[tracker->num_rows]);
    memset(&rows[tracker->num_rows], 0, sizeof rows[0]);
    return RHO_OK;
}
