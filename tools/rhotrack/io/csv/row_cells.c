/* SPDX-License-Identifier: MIT */
#include "io/csv/row_cells.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "rhotrack/types.h"

#define TURN 6.283185307179586

bool row_refuse(const struct row_check *check, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(check->reason, ROW_REASON_BYTES, format, arguments);
    va_end(arguments);
    return false;
}

bool row_refuse_cell(const struct row_check *check, enum column_id column, const char *why)
{
    const struct table *table = check->columns->table;
    const int at = check->columns->at[column];
    const char *name = table->names[at];
    char buffer[TABLE_TEXT_BYTES];

    if (table_is_cell_empty(table, check->row, at)) {
        return row_refuse(check, "%s is empty", name);
    }
    return row_refuse(check, "%s '%.40s' %s", name, table_cell_text(table, check->row, at, buffer),
                      why);
}

bool row_has_cell(const struct row_check *check, enum column_id column)
{
    const int at = check->columns->at[column];

    return at >= 0 && !table_is_cell_empty(check->columns->table, check->row, at);
}

bool row_read_double(const struct row_check *check, enum column_id column, double min, double max,
                     double *value)
{
    const struct table *table = check->columns->table;
    const int at = check->columns->at[column];
    char buffer[TABLE_TEXT_BYTES];
    double number;
    const char *why = table_read_number(table, check->row, at, &number);

    if (why) {
        return row_refuse_cell(check, column, why);
    }
    if (number < min || number > max) {
        return row_refuse(check, "%s %.40s is outside %.9g .. %.9g", table->names[at],
                          table_cell_text(table, check->row, at, buffer), min, max);
    }
    *value = number;
    return true;
}

bool row_read_float(const struct row_check *check, enum column_id column, float min, float max,
                    float *value)
{
    double number = 0.0;

    if (!row_read_double(check, column, (double)min, (double)max, &number)) {
        return false;
    }
    *value = (float)number;
    return true;
}

bool row_read_and_wrap_angle_rad(const struct row_check *check, enum column_id column,
                                 float *angle_rad)
{
    /* the float nearest to pi, as files may have it */
    static const double half_turn = 3.1415927410125732;
    double number = 0.0;

    if (!row_read_double(check, column, -ROW_ANGLE_MAX, ROW_ANGLE_MAX, &number)) {
        return false;
    }
    *angle_rad = (float)(fabs(number) > half_turn ? remainder(number, TURN) : number);
    return true;
}

bool row_read_position(const struct row_check *check, enum column_id column, float *value)
{
    return row_read_float(check, column, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M, value);
}

bool row_read_sigma_rad(const struct row_check *check, enum column_id column, double otherwise,
                        float *value)
{
    if (row_has_cell(check, column)) {
        return row_read_float(check, column, RHO_LIMIT_SIGMA_RAD_MIN, RHO_LIMIT_SIGMA_RAD_MAX,
                              value);
    }
    *value = (float)otherwise;
    return true;
}

bool row_read_sector(const struct row_check *check, float *from_rad, float *to_rad)
{
    static const float turn = 6.2831855f;

    if (!row_has_cell(check, COL_SECTOR_FROM_RAD) && !row_has_cell(check, COL_SECTOR_TO_RAD)) {
        return true;
    }
    return row_read_float(check, COL_SECTOR_FROM_RAD, -turn, turn, from_rad) &&
           row_read_float(check, COL_SECTOR_TO_RAD, -turn, turn, to_rad);
}

bool row_read_snr(const struct row_check *check, float *snr_db)
{
    return !row_has_cell(check, COL_SNR_DB) ||
           row_read_float(check, COL_SNR_DB, -1000.0f, 1000.0f, snr_db);
}

bool row_read_time(const struct row_check *check, enum column_id column, int64_t *time_us)
{
    const char *why =
        table_read_time_us(check->columns->table, check->row, check->columns->at[column], time_us);

    return !why || row_refuse_cell(check, column, why);
}

bool row_read_int32(const struct row_check *check, enum column_id column, int32_t *value)
{
    const char *why =
        table_read_int32(check->columns->table, check->row, check->columns->at[column], value);

    return !why || row_refuse_cell(check, column, why);
}

bool row_check_unbiased_time(const struct row_check *check, int64_t time_us, int32_t bias_us)
{
    int64_t right_us = time_us - bias_us;

    return (right_us >= -RHO_LIMIT_TIME_US && right_us <= RHO_LIMIT_TIME_US) ||
           row_refuse(check, "t_s minus the sensor's time_bias_s is beyond 4e12 s");
}

bool row_refuse_decrease(const struct row_check *check, bool is_received, int64_t from_us,
                         int64_t to_us)
{
    const struct columns *columns = check->columns;

    if (!is_received && columns && table_is_frame_number(columns->table, columns->at[COL_T_S])) {
        return row_refuse_cell(check, COL_T_S,
                               "is less than one before it: where the radar counted anew, a new "
                               "file has to begin");
    }
    return row_refuse(check, "%s decreases from %.6f s to %.6f s",
                      is_received ? "received_s" : "time", (double)from_us * 1e-6,
                      (double)to_us * 1e-6);
}

bool row_read_received(const struct row_check *check, int64_t *received_us)
{
    return check->columns->at[COL_RECEIVED_S] < 0 ||
           row_read_time(check, COL_RECEIVED_S, received_us);
}

bool row_check_received(const struct row_check *check, int64_t received_us, int64_t scan_us,
                        bool has_number, int64_t interval_us)
{
    return has_number || interval_us > 0 || received_us == scan_us ||
           row_refuse(check,
                      "received_s is %.6f s, but %.6f s in the scan's other rows: they may differ "
                      "only with a column 'scan' or with scan_interval_s",
                      (double)received_us * 1e-6, (double)scan_us * 1e-6);
}

bool row_read_scan_number(const struct row_check *check, struct scan_number *number)
{
    *number = (struct scan_number){.is_given = row_has_cell(check, COL_SCAN)};
    return !number->is_given ||
           (row_read_int32(check, COL_SCAN, &number->scan) &&
            (!row_has_cell(check, COL_EPOCH) || row_read_int32(check, COL_EPOCH, &number->epoch)));
}

bool row_joins_scan(const struct scan_number *number, int64_t time_us,
                    const struct scan_number *scan, int64_t start_us, int64_t interval_us)
{
    int64_t offset_us = time_us - start_us;

    if (number->is_given && scan->is_given) {
        return number->scan == scan->scan && number->epoch == scan->epoch &&
               offset_us >= -RHO_LIMIT_OFFSET_US && offset_us <= RHO_LIMIT_OFFSET_US;
    }
    return offset_us == 0 || (offset_us > 0 && offset_us < interval_us);
}
