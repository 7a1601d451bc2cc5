/* SPDX-License-Identifier: MIT */
/*
 * row_check: cells of one row of a plot or bearing file, checked, and the reason where one is bad.
 *
 * All that return bool return false where the row is bad; the reason is then set.
 */
#ifndef RHOTRACK_TOOL_ROW_CHECK_H
#define RHOTRACK_TOOL_ROW_CHECK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/csv/table.h"

#define ROW_REASON_BYTES 200

/* The row under check; columns below are indices into its table, -1 where the file has none. */
struct row_check {
    const struct table *table;
    size_t row;
    char *reason; /* ROW_REASON_BYTES */
};

/* Sets the reason; always false. Of a cell: its name, its text, and why; "is empty" where it is. */
bool row_refuse(const struct row_check *check, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
bool row_refuse_cell(const struct row_check *check, int column, const char *why);

/* There is such a column, and the row's cell in it is not empty. */
bool row_has_cell(const struct row_check *check, int column);

/*
 * A number within min .. max, also where float32 is too coarse; one of the library's positions; a
 * sigma of an angle.
 */
bool row_read_float(const struct row_check *check, int column, float min, float max, float *value);
bool row_read_double(const struct row_check *check, int column, double min, double max,
                     double *value);
/* An angle of any turn, within half a turn to either side. */
#define ROW_ANGLE_MAX 1e6
bool row_read_angle(const struct row_check *check, int column, float *angle_rad);

bool row_read_position(const struct row_check *check, int column, float *value);
bool row_read_sigma_rad(const struct row_check *check, int column, double otherwise, float *value);

/* Cells that may be missing: then unchanged. */
bool row_read_sector(const struct row_check *check, int from, int to, float *from_rad,
                     float *to_rad);
bool row_read_snr(const struct row_check *check, int column, float *snr_db);

/* Time and sensor; 0 where the file has no such column (-1). */
bool row_read_time_and_sensor(const struct row_check *check, int t_s, int sensor_id,
                              int64_t *time_us, int32_t *sensor);

/* Once the sensor's time bias is off the time is still one that is believed. */
bool row_check_unbiased_time(const struct row_check *check, int64_t time_us, int32_t bias_us);

/* When the row was received; *received_us is left alone where the file does not say. */
bool row_read_received(const struct row_check *check, int column, int64_t *received_us);

/*
 * Whether a row may have been received apart from the other rows of its scan, at scan_us: where the
 * scan has a number, or is gathered over an interval. Else rows of a scan are received together:
 * one that is not would be a scan of its own.
 */
bool row_check_received_together(const struct row_check *check, int64_t received_us,
                                 int64_t scan_us, bool has_number, int64_t interval_us);

/*
 * The scan's number, where the file says it: rows of one sensor with the same are one scan,
 * whatever their own times.
 */
struct row_number {
    bool is_given;
    int32_t scan, epoch; /* epoch: 0 where not given */
};
bool row_read_number(const struct row_check *check, int scan, int epoch, struct row_number *number);

/*
 * Whether a row joins a scan that began at start_us: by their numbers where both have one, else by
 * their times, within interval_us.
 */
bool row_joins_scan(const struct row_number *number, int64_t time_us, const struct row_number *scan,
                    int64_t start_us, int64_t interval_us);

/* Columns that mean something only together: exit 2 where one is there without the other. */
void row_need_both_columns(const struct table *table, const char *first, const char *second);

#endif
