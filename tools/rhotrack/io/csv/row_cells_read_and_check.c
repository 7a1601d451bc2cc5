/* SPDX-License-Identifier: MIT */
#include "io/csv/row_cells_read_and_check.h"

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

bool row_refuse_cell(const struct row_check *check, int column, const char *why)
{
    const char *name = check->table->names[column];
    char buffer[TABLE_TEXT_BYTES];

    if (table_is_cell_empty(check->table, check->row, column)) {
        return row_refuse(check, "%s is empty", name);
    }
    return row_refuse(check, "%s '%.40s' %s", name,
                      table_cell_text(check->table, check->row, column, buffer), why);
}

bool row_has_cell(const struct row_check *check, int column)
{
    return column >= 0 && !table_is_cell_empty(check->table, check->row, column);
}

bool row_read_double(const struct row_check *check, int column, double min, double max,
                     double *value)
{
    char buffer[TABLE_TEXT_BYTES];
    double number;
    const char *why = table_read_number(check->table, check->row, column, &number);

    if (why) {
        return row_refuse_cell(check, column, why);
    }
    if (number < min || number > max) {
        return row_refuse(check, "%s %.40s is outside %.9g .. %.9g", check->table->names[column],
                          table_cell_text(check->table, check->row, column, buffer), min, max);
    }
    *value = number;
    return true;
}

bool row_read_float(const struct row_check *check, int column, float min, float max, float *value)
{
    double number = 0.0;

    if (!row_read_double(check, column, (double)min, (double)max, &number)) {
        return false;
    }
    *value = (float)number;
    return true;
}

bool row_read_and_wrap_angle_rad(const struct row_check *check, int column, float *angle_rad)
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

double row_radians_from_compass_deg(double azimuth_deg)
{
    return remainder(TURN / 4 - azimuth_deg * (TURN / 360), TURN);
}

bool row_read_position(const struct row_check *check, int column, float *value)
{
    return row_read_float(check, column, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M, value);
}

bool row_read_sigma_rad(const struct row_check *check, int column, double otherwise, float *value)
{
    if (row_has_cell(check, column)) {
        return row_read_float(check, column, RHO_LIMIT_SIGMA_RAD_MIN, RHO_LIMIT_SIGMA_RAD_MAX,
                              value);
    }
    *value = (float)otherwise;
    return true;
}

bool row_read_sector(const struct row_check *check, int from_column, int to_column, float *from_rad,
                     float *to_rad)
{
    static const float turn = 6.2831855f;

    if (!row_has_cell(check, from_column) && !row_has_cell(check, to_column)) {
        return true;
    }
    return row_read_float(check, from_column, -turn, turn, from_rad) &&
           row_read_float(check, to_column, -turn, turn, to_rad);
}

bool row_read_snr(const struct row_check *check, int column, float *snr_db)
{
    return !row_has_cell(check, column) || row_read_float(check, column, -1000.0f, 1000.0f, snr_db);
}

bool row_read_time_and_sensor(const struct row_check *check, int time_column, int sensor_column,
                              int64_t *time_us, int32_t *sensor)
{
    const char *why = table_read_time_us(check->table, check->row, time_column, time_us);

    if (why) {
        return row_refuse_cell(check, time_column, why);
    }
    *sensor = 0;
    why = sensor_column < 0 ? NULL
                            : table_read_int32(check->table, check->row, sensor_column, sensor);
    return why ? row_refuse_cell(check, sensor_column, why) : true;
}

bool row_check_unbiased_time(const struct row_check *check, int64_t time_us, int32_t bias_us)
{
    int64_t right_us = time_us - bias_us;

    return (right_us >= -RHO_LIMIT_TIME_US && right_us <= RHO_LIMIT_TIME_US) ||
           row_refuse(check, "t_s minus the sensor's time_bias_s is beyond 4e12 s");
}

bool row_read_received(const struct row_check *check, int column, int64_t *received_us)
{
    const char *why =
        column < 0 ? NULL : table_read_time_us(check->table, check->row, column, received_us);

    return why ? row_refuse_cell(check, column, why) : true;
}

bool row_check_received_same_as_in_scan(const struct row_check *check, int64_t received_us,
                                        int64_t scan_us, bool has_number, int64_t interval_us)
{
    return has_number || interval_us > 0 || received_us == scan_us ||
           row_refuse(check,
                      "received_s is %.6f s, but %.6f s in the scan's other rows: they may differ "
                      "only with a column 'scan' or with scan_interval_s",
                      (double)received_us * 1e-6, (double)scan_us * 1e-6);
}

bool row_read_scan_number(const struct row_check *check, int scan_column, int epoch_column,
                          struct scan_number *number)
{
    const char *why;

    *number = (struct scan_number){.is_given = row_has_cell(check, scan_column)};
    if (!number->is_given) {
        return true;
    }
    why = table_read_int32(check->table, check->row, scan_column, &number->scan);
    if (why) {
        return row_refuse_cell(check, scan_column, why);
    }
    why = row_has_cell(check, epoch_column)
              ? table_read_int32(check->table, check->row, epoch_column, &number->epoch)
              : NULL;
    return why ? row_refuse_cell(check, epoch_column, why) : true;
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

void row_need_both_columns_or_neither(const struct table *table, const char *first,
                                      const char *second)
{
    bool has_first = table_find_column(table, first) >= 0,
         has_second = table_find_column(table, second) >= 0;

    if (has_first != has_second) {
        table_fail_at_row(table, TABLE_HEADER, "no column '%s' beside '%s'",
                          has_first ? second : first, has_first ? first : second);
    }
}
