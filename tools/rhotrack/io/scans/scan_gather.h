/* SPDX-License-Identifier: MIT */
/*
 * scan_gather: rows of one file to scans, in the order of time, with those scans alone in memory
 * that may get more rows.
 *
 * Rows of one sensor are a scan as row_joins_scan has it: a row belongs to the scan of its number,
 * else to the sensor's newest one. Their times do not go back, but within a scan that has a number.
 * A scan is complete when rows have come to a time that cannot be its own: of a numbered one
 * RHO_LIMIT_OFFSET_US after its first row.
 *
 * A sensor's time bias, where it has one, is taken off its scan's time: rows come by the sensors'
 * clocks, scans go out in the order of the common one. They wait until no row to come can begin one
 * that is before them, bias_max_us at most: the largest of all sensors that are described, for one
 * that has not come yet may still come.
 *
 * Where rows say when they were received, these are the times that do not go back, and that
 * complete scans; those are given out as they were received. A scan that is gathered over an
 * interval is complete when its sensor's next one has begun, too.
 */
#ifndef RHOTRACK_TOOL_SCAN_GATHER_H
#define RHOTRACK_TOOL_SCAN_GATHER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/csv/row_check.h"
#include "io/scans/scan_numbers.h"
#include "rhotrack/types.h"

/* A scan and what its rows saw: `count` plots or bearings, each with the time of its row. */
struct gathered_scan {
    int32_t sensor_id;
    struct row_number number;
    int32_t bias_us;  /* of its sensor's clock, on which all times of the scan are */
    int64_t start_us; /* of its first row */
    int64_t begun_us,
        /* its first and its last row were received; without such times: start_us, its last row's */
        heard_us;
    int64_t
        time_us;   /* its own: the first row's, or with a number that of the row that saw nothing */
    bool has_time; /* by such a row */
    size_t order;  /* among the file's scans */
    uint32_t line; /* of its first row */
    unsigned begun_since; /* scans of its sensor */
    float sector_from_rad, sector_to_rad;
    bool has_sensor; /* the sensor below is described; its place is set in any case */
    struct rho_sensor sensor;
    bool has_measures; /* its first plot has come */
    uint32_t measures;
    void *elements;
    int64_t *times_us;
    size_t count, capacity, times_capacity;
};

/* Starts by scan_gather_start. */
struct scan_gather {
    size_t element_bytes;
    int64_t interval_us;
    int32_t bias_max_us; /* no sensor has a larger one; 0: none has one above 0 */
    unsigned begun_max; /* a numbered scan is complete after so many of its sensor, too; 0: never */
    struct gathered_scan *scans; /* those in memory, in the order of their first rows */
    size_t count, capacity;
    size_t order; /* of the next one */
    struct scan_numbers numbers;
    bool has_rows, has_given;
    int64_t last_us; /* the latest time of a row, or when the last one was received */
    bool has_clock;  /* the row that comes was received at ... */
    int64_t clock_us;
    int64_t given_us; /* the newest scan's that was given out, on the common clock */
};

void scan_gather_start(struct scan_gather *gather, size_t element_bytes, int64_t interval_us);

/* When the row was received that is checked and added next. Of all rows, or of none. */
void scan_gather_set_reception(struct scan_gather *gather, int64_t clock_us);

/*
 * The scan that such a row belongs to; NULL: it begins one. Valid until the next scan begins or is
 * taken.
 */
struct gathered_scan *scan_gather_find_scan(struct scan_gather *gather, int32_t sensor_id,
                                            const struct row_number *number, int64_t time_us);

/*
 * The row's time is not before those that came: returns true, or false and the reason. scan: the
 * one that it belongs to.
 */
bool scan_gather_check_time(const struct scan_gather *gather, const struct gathered_scan *scan,
                            int64_t time_us, const struct row_check *check);

/* Begins a scan with what is set of this one: sensor, number, bias, sector, line. */
struct gathered_scan *scan_gather_begin_scan(struct scan_gather *gather,
                                             const struct gathered_scan *scan, int64_t time_us);

/* A row of the scan: a plot or bearing, or one that says that the sensor saw nothing. */
void scan_gather_add_element(struct scan_gather *gather, struct gathered_scan *scan,
                             int64_t time_us, const void *element);
void scan_gather_add_empty_row(struct scan_gather *gather, struct gathered_scan *scan,
                               int64_t time_us);

/* The scan's time on the common clock. */
int64_t gathered_scan_time_us(const struct gathered_scan *scan);

/*
 * Takes out the next scan, if there is a complete one; with all, complete or not. Its memory is the
 * caller's then.
 */
bool scan_gather_take_scan(struct scan_gather *gather, bool all, struct gathered_scan *scan);
void gathered_scan_free(struct gathered_scan *scan);

void scan_gather_free(struct scan_gather *gather);

#endif
