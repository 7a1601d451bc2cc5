/* SPDX-License-Identifier: MIT */
/*
 * rows_to_scans: gathers the rows of one file into scans in the order of time, and keeps only scans
 * in memory that may get more rows.
 *
 * Rows of one sensor form scans by row_joins_scan: a row belongs to the scan of its number, else to
 * the sensor's newest scan. Times of rows must not go back, except within a numbered scan. A scan
 * is complete once rows have a time that is too late for it: for a numbered scan
 * RHO_LIMIT_OFFSET_US after its first row.
 *
 * A sensor's time bias is subtracted from the times of its scans: rows come by the sensors' clocks,
 * scans go out in the order of the common clock. A scan waits until no further row can begin an
 * earlier one, at most bias_max_us: the largest bias of all described sensors, since a sensor may
 * still appear.
 *
 * Where rows have reception times, these must not go back instead, and they complete scans, which
 * are given out in the order of reception. A scan gathered over an interval is then also complete
 * when its sensor's next scan has begun.
 */
#ifndef RHOTRACK_TOOL_ROWS_TO_SCANS_H
#define RHOTRACK_TOOL_ROWS_TO_SCANS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/csv/row_cells.h"
#include "io/scans/scan_numbers.h"
#include "rhotrack/types.h"

/* A scan under way with its `count` plots or bearings, each with the time of its row. */
struct gathered_scan {
    int32_t sensor_id;
    struct scan_number number;
    int32_t bias_us;  /* time bias of its sensor, not yet subtracted from the scan's times */
    int64_t start_us; /* time of its first row */
    /* reception times of its first and last row; without reception, these rows' own times */
    int64_t begun_us, heard_us;
    /* time of the scan: its first row's; if numbered, that of its row without a measurement */
    int64_t time_us;
    bool has_time;        /* time_us comes from a row without a measurement */
    size_t order;         /* index of the scan in the file */
    uint32_t line;        /* line of its first row */
    unsigned begun_since; /* scans of the same sensor that began after it */
    float sector_from_rad, sector_to_rad;
    bool has_sensor; /* a description of the sensor was given; its position is set in any case */
    struct rho_sensor sensor;
    bool has_measures; /* measures is set, by the first plot */
    uint32_t measures;
    void *elements;
    int64_t *times_us;
    size_t count, capacity, times_capacity;
};

/* The scans of a file that are not complete yet. Initialised by rows_to_scans_start. */
struct rows_to_scans {
    size_t element_bytes;
    int64_t interval_us;
    int32_t bias_max_us; /* largest time bias of a sensor; 0 where none is positive */
    /* a numbered scan is also complete after so many newer ones of its sensor; 0: never */
    unsigned begun_max;
    struct gathered_scan *scans; /* scans in memory, in the order of their first rows */
    size_t count, capacity;
    size_t order; /* index in the file of the next scan to begin */
    struct scan_numbers numbers;
    bool has_rows, has_given;
    int64_t last_us; /* latest time of a row, or of its reception where that is given */
    bool has_clock;  /* the next row has a reception time, clock_us */
    int64_t clock_us;
    int64_t given_us; /* time of the newest scan given out, on the common clock */
};

void rows_to_scans_start(struct rows_to_scans *gather, size_t element_bytes, int64_t interval_us);

/*
 * Sets the reception time of the row that is checked and added next. Either all rows have one, or
 * none.
 */
void rows_to_scans_set_reception(struct rows_to_scans *gather, int64_t received_us);

/*
 * The scan in memory that a row belongs to, or NULL where it begins a new one. Valid until the next
 * scan begins or is taken.
 */
struct gathered_scan *rows_to_scans_find_scan(struct rows_to_scans *gather, int32_t sensor_id,
                                              const struct scan_number *number, int64_t time_us);

/*
 * Checks that a row's time does not go back; scan: the scan that the row belongs to, or NULL.
 * Returns false and sets the reason where it does.
 */
bool rows_to_scans_check_time(const struct rows_to_scans *gather, const struct gathered_scan *scan,
                              int64_t time_us, const struct row_check *check);

/* Begins a scan at time_us with the sensor, number, bias, sector and line of `heading`. */
struct gathered_scan *rows_to_scans_begin_scan(struct rows_to_scans *gather,
                                               const struct gathered_scan *heading,
                                               int64_t time_us);

/* Adds a row to a scan: a plot or bearing, or a row without a measurement. */
void rows_to_scans_add_element(struct rows_to_scans *gather, struct gathered_scan *scan,
                               int64_t time_us, const void *element);
void rows_to_scans_add_empty_row(struct rows_to_scans *gather, struct gathered_scan *scan,
                                 int64_t time_us);

/* Time of a scan on the common clock, its sensor's bias subtracted. */
int64_t gathered_scan_time_us(const struct gathered_scan *scan);

/*
 * Takes out the next complete scan, or with all the next scan, complete or not. The caller then
 * owns its memory. Returns false where there is none.
 */
bool rows_to_scans_take_scan(struct rows_to_scans *gather, bool all, struct gathered_scan *scan);
void gathered_scan_free(struct gathered_scan *scan);

void rows_to_scans_free(struct rows_to_scans *gather);

#endif
