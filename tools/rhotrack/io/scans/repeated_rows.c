/* SPDX-License-Identifier: MIT */
#include "io/scans/repeated_rows.h"

#include <stdlib.h>
#include <string.h>

#include "base/common.h"

/* Rows that are remembered: a second of a radar of 5000 plots, or of a minute of aircraft. */
enum { PLACES = 8192 };

/* What a row says; its padding is 0. */
struct said {
    int64_t time_us;
    int32_t sensor_id;
    uint32_t measures;
    struct rho_plot plot;
    struct rho_bearing bearing;
    float sensor_m[3], sector_rad[2];
    bool is_there;
};

struct repeated_rows {
    uint64_t repeats, empty_slots;
    unsigned num_with_slots;
    int32_t with_slots[RHO_MAX_SENSORS]; /* sensors that have shown several rows at 0, 0 at once */
    struct said said[PLACES];            /* by their hash; a newer one takes the place */
};

struct repeated_rows *repeated_rows_open(void)
{
    return must_calloc(1, sizeof(struct repeated_rows));
}

/* FNV-1a. */
static size_t place_of(const struct said *said)
{
    const unsigned char *bytes = (const unsigned char *)said;
    uint64_t hash = 14695981039346656037u;

    for (size_t i = 0; i < sizeof *said; i++) {
        hash = (hash ^ bytes[i]) * 1099511628211u;
    }
    return (size_t)(hash >> 32) % PLACES;
}

static bool has_empty_slots(const struct repeated_rows *rows, int32_t sensor_id)
{
    for (unsigned i = 0; i < rows->num_with_slots; i++) {
        if (rows->with_slots[i] == sensor_id) {
            return true;
        }
    }
    return false;
}

/* Whether it is a plot in the plane at 0, 0: a list's empty slot, or a target just there. */
static bool is_at_zero(const struct measurement_row *row)
{
    return row->measures == 0 && !(row->plot.x_m < 0.0f) && !(row->plot.x_m > 0.0f) &&
           !(row->plot.y_m < 0.0f) && !(row->plot.y_m > 0.0f) && row->plot.sigma_range_m > 0.0f;
}

bool repeated_rows_leaves_out(struct repeated_rows *rows, struct measurement_row *row)
{
    struct said said, *place;

    if (!row->has_measurement) {
        return false;
    }
    if (is_at_zero(row) && has_empty_slots(rows, row->sensor_id)) {
        rows->empty_slots++;
        row->has_measurement = false;
        return false;
    }
    memset(&said, 0, sizeof said);
    said.time_us = row->time_us;
    said.sensor_id = row->sensor_id;
    said.measures = row->measures;
    said.plot = row->plot;
    said.bearing = row->bearing;
    said.sensor_m[0] = row->sensor.x_m;
    said.sensor_m[1] = row->sensor.y_m;
    said.sensor_m[2] = row->sensor.z_m;
    said.sector_rad[0] = row->sector_from_rad;
    said.sector_rad[1] = row->sector_to_rad;
    said.is_there = true;
    place = &rows->said[place_of(&said)];
    if (memcmp(place, &said, sizeof said) != 0) {
        *place = said;
        return false;
    }
    if (is_at_zero(row) && rows->num_with_slots < RHO_MAX_SENSORS) {
        rows->with_slots[rows->num_with_slots++] = row->sensor_id;
        rows->empty_slots++;
    } else {
        rows->repeats++;
    }
    return true;
}

void repeated_rows_report(const struct repeated_rows *rows, const char *path)
{
    print_count_unless_zero(path, rows->repeats,
                            "rows say again what another one of their sensor and time says, and "
                            "are left out");
    print_count_unless_zero(path, rows->empty_slots,
                            "rows at 0, 0 are empty slots of a sensor's list");
}

void repeated_rows_free(struct repeated_rows *rows)
{
    free(rows);
}
