/* SPDX-License-Identifier: MIT */
/*
 * row_cells: reads and checks cells of one row of plots or bearings, and gives the
 * reason where one is bad.
 *
 * Functions named row_read_... and row_check_... return false where the row is bad, with the reason
 * set.
 */
#ifndef RHOTRACK_TOOL_ROW_CELLS_H
#define RHOTRACK_TOOL_ROW_CELLS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/csv/columns.h"

#define ROW_REASON_BYTES 200

/* The row under check. */
struct row_check {
    const struct columns *columns;
    size_t row;
    char *reason; /* buffer of ROW_REASON_BYTES */
};

/*
 * Sets the reason why the row is bad, and always returns false; row_refuse_cell names the cell, its
 * text, and why, or "is empty".
 */
bool row_refuse(const struct row_check *check, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
bool row_refuse_cell(const struct row_check *check, enum column_id column, const char *why);

/* Whether there is such a column, and the row's cell in it is not empty. */
bool row_has_cell(const struct row_check *check, enum column_id column);

/* Reads a time, or a whole number; the column must be there. */
bool row_read_time(const struct row_check *check, enum column_id column, int64_t *time_us);
bool row_read_int32(const struct row_check *check, enum column_id column, int32_t *value);

/* Reads a number within min .. max, as float32 or double. */
bool row_read_float(const struct row_check *check, enum column_id column, float min, float max,
                    float *value);
bool row_read_double(const struct row_check *check, enum column_id column, double min, double max,
                     double *value);
/* Reads an angle of up to ROW_ANGLE_MAX rad, and wraps it to half a turn either side of 0. */
#define ROW_ANGLE_MAX 1e6
bool row_read_and_wrap_angle_rad(const struct row_check *check, enum column_id column,
                                 float *angle_rad);

bool row_read_position(const struct row_check *check, enum column_id column, float *value);
bool row_read_sigma_rad(const struct row_check *check, enum column_id column, double otherwise,
                        float *value);

/* Reads cells that may be missing; the values are then unchanged. */
bool row_read_sector(const struct row_check *check, float *from_rad, float *to_rad);
bool row_read_snr(const struct row_check *check, float *snr_db);

/* Checks that the time is within the library's limits once the sensor's time bias is subtracted. */
bool row_check_unbiased_time(const struct row_check *check, int64_t time_us, int32_t bias_us);

/*
 * Refuses a row whose time, of reception where is_received, is before that of an earlier one;
 * always returns false.
 */
bool row_refuse_decrease(const struct row_check *check, bool is_received, int64_t from_us,
                         int64_t to_us);

/* Reads the reception time; *received_us is unchanged where the file has none. */
bool row_read_received(const struct row_check *check, int64_t *received_us);

/*
 * Checks that a row was received at scan_us, as the other rows of its scan, unless the scan has a
 * number or is gathered over an interval, when reception times may differ.
 */
bool row_check_received(const struct row_check *check, int64_t received_us, int64_t scan_us,
                        bool has_number, int64_t interval_us);

/*
 * Number of a row's scan, where the file has one: rows of one sensor with equal numbers form one
 * scan, whatever their times.
 */
struct scan_number {
    bool is_given;
    int32_t scan, epoch; /* epoch: 0 where not given */
};
bool row_read_scan_number(const struct row_check *check, struct scan_number *number);

/*
 * Whether a row joins a scan that began at start_us: by their numbers where both have one, else by
 * time, within interval_us.
 */
bool row_joins_scan(const struct scan_number *number, int64_t time_us,
                    const struct scan_number *scan, int64_t start_us, int64_t interval_us);

#endif
