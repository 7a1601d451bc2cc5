/* SPDX-License-Identifier: MIT */
#include "io/scans/repeated_rows.h"

#include <stdlib.h>
#include <string.h>

#include "base/common.h"

/* Rows that are remembered: a second of a radar of 5000 plots, or of a minute of aircraft. */
enum { PLACES = 8192 };

/* What a row says, byte by byte. */
enum {
    SAID_BYTES = sizeof(int64_t) + sizeof(int32_t) + sizeof(uint32_t) + sizeof(struct rho_plot) +
                 sizeof(struct rho_bearing) + 5 * sizeof(float)
};

struct said {
    bool is_there;
    unsigned char bytes[SAID_BYTES];
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

static size_t append(struct said *said, size_t at, const void *value, size_t size)
{
    memcpy(said->bytes + at, value, size);
    return at + size;
}

static struct said what_row_says(const struct measurement_row *row)
{
    const float around[] = {row->sensor.x_m, row->sensor.y_m, row->sensor.z_m, row->sector_from_rad,
                            row->sector_to_rad};
    struct said said = {.is_there = true};
    size_t at = append(&said, 0, &row->time_us, sizeof row->time_us);

    at = append(&said, at, &row->sensor_id, sizeof row->sensor_id);
    at = append(&said, at, &row->measures, sizeof row->measures);
    at = append(&said, at, &row->plot, sizeof row->plot);
    at = append(&said, at, &row->bearing, sizeof row->bearing);
    append(&said, at, around, sizeof around);
    return said;
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
    said = what_row_says(row);
    place = &rows->said[(hash_bytes(said.bytes, SAID_BYTES) >> 32) % PLACES];
    if (!place->is_there || memcmp(place->bytes, said.bytes, SAID_BYTES) != 0) {
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
