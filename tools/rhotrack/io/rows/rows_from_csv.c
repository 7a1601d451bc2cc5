/* SPDX-License-Identifier: MIT */
#include "io/rows/rows_from_csv.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/csv/row_cells_read_and_check.h"
#include "io/csv/table_columns_and_cells.h"
#include "io/rows/rows_lat_lon_to_local_frame.h"
#include "io/scans/hash_table_of_scans_by_number.h"

/* State of reading a table; columns are indices into it, -1 where it has no such column. */
struct reading {
    struct rows_file *file;
    const struct table *table;
    const struct parameters *parameters;
    int t_s, received_s, sensor_id, scan, epoch;
    int columns[ROWS_MAX_COLUMNS];
    bool is_degrees[ROWS_MAX_COLUMNS];
    int place; /* first column of a radar's position in the kind's columns, else -1 */
    struct rows_geodetic_columns geodetic;
    struct scan_numbers numbers; /* numbered scans, by the indices of their first rows */
    bool has_last;
    int64_t last_us; /* latest time of a row, or of its reception where that is given */
};

/* ---- Columns ---- */

static const struct rows_kind *kind_of_table(const struct table *table)
{
    static const struct {
        const char *name;
        int kind;
    } marks[] = {{"track_id", ROWS_TRACKS}, {"target_id", ROWS_TRUTH},
                 {"range_m", ROWS_POLAR},   {"x_m", ROWS_PLOTS},
                 {"lat_deg", ROWS_PLOTS},   {"bearing_rad", ROWS_BEARINGS}};

    bool has_sensor = table_find_column(table, "sensor_id") >= 0;

    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        /* simulated plots may name their target, and have a sensor */
        if (table_find_column(table, marks[i].name) >= 0 &&
            !(marks[i].kind == ROWS_TRUTH && has_sensor)) {
            return rows_kinds[marks[i].kind];
        }
    }
    table_fail_at_row(table, TABLE_HEADER,
                      "neither plots, polar plots, bearings, truth nor tracks: no column 'x_m', "
                      "'lat_deg', 'range_m', 'bearing_rad', 'target_id' or 'track_id'");
}

static int find_column(const struct reading *reading, const struct rows_column *column,
                       bool *is_degrees)
{
    const struct table *table = reading->table;
    int plain = table_find_column(table, column->name);
    int degrees = column->degrees ? table_find_column(table, column->degrees) : -1;

    if (plain >= 0 && degrees >= 0) {
        table_fail_at_row(table, TABLE_HEADER, "columns '%s' and '%s' exclude each other",
                          column->name, column->degrees);
    }
    *is_degrees = degrees >= 0;
    if (degrees < 0 && (column->flags & COLUMN_NEEDED) &&
        !rows_geodetic_columns_replaces_column(&reading->geodetic, column)) {
        return table_need_column(table, column->name);
    }
    return degrees >= 0 ? degrees : plain;
}

static void find_columns(struct reading *reading)
{
    const struct table *table = reading->table;
    const struct rows_kind *kind = reading->file->rows.kind;

    reading->t_s = table_need_column(table, "t_s");
    reading->sensor_id = -1;
    if (kind->has_sensor) {
        bool is_needed = kind == &rows_kind_bearings || reading->parameters->num_sensors > 0;

        reading->sensor_id =
            (is_needed ? table_need_column : table_find_column)(table, "sensor_id");
    }
    reading->received_s = kind->has_received ? table_find_column(table, "received_s") : -1;
    reading->file->rows.has_received = reading->received_s >= 0;
    reading->scan = table_find_column(table, "scan");
    reading->epoch = kind->has_epoch ? table_find_column(table, "epoch") : -1;
    reading->file->has_scan = reading->scan >= 0;
    reading->file->has_epoch = reading->epoch >= 0;
    reading->place = -1;
    reading->geodetic = rows_geodetic_columns_open(table, kind, reading->parameters);
    for (int i = 0; i < kind->num_columns; i++) {
        reading->columns[i] = find_column(reading, &kind->columns[i], &reading->is_degrees[i]);
        if (kind == &rows_kind_polar && strcmp(kind->columns[i].name, "sensor_x_m") == 0) {
            reading->place = i;
        }
    }
    if (kind == &rows_kind_polar && table_find_column(table, "x_m") >= 0) {
        table_fail_at_row(table, TABLE_HEADER, "columns 'range_m' and 'x_m' exclude each other");
    }
    row_need_both_columns_or_neither(table, "sensor_x_m", "sensor_y_m");
    row_need_both_columns_or_neither(table, "sector_from_rad", "sector_to_rad");
}

/* ---- Cells ---- */

static bool read_status(const struct row_check *check, int column, double *value)
{
    for (int i = 1; i <= ROWS_STATUS_MAX; i++) {
        if (table_is_word(check->table, check->row, column, rows_track_status_name(i))) {
            *value = i;
            return true;
        }
    }
    return row_refuse_cell(check, column, "is none of tentative, confirmed, coasting, deleted");
}

static bool read_int32(const struct row_check *check, int column, int32_t *value)
{
    const char *why = table_read_int32(check->table, check->row, column, value);

    return !why || row_refuse_cell(check, column, why);
}

static bool read_int16(const struct row_check *check, int column, int32_t *value)
{
    if (!read_int32(check, column, value)) {
        return false;
    }
    return (*value >= INT16_MIN && *value <= INT16_MAX) ||
           row_refuse_cell(check, column, "is outside -32768 .. 32767, the range of messages");
}

static bool read_float(const struct row_check *check, int column, double *value)
{
    float number;
    const char *why = table_read_float(check->table, check->row, column, &number);

    *value = (double)number;
    return !why || row_refuse_cell(check, column, why);
}

static bool read_degrees_into_column_unit(const struct row_check *check, int column,
                                          const struct rows_column *described, double *value)
{
    double degrees = 0.0;
    const char *why = table_read_number(check->table, check->row, column, &degrees);

    if (why) {
        return row_refuse_cell(check, column, why);
    }
    if (fabs(degrees) > ROW_ANGLE_MAX) {
        return row_refuse_cell(check, column, "is outside -1000000 .. 1000000");
    }
    *value = (double)(float)described->from_degrees(degrees);
    return true;
}

static bool read_cell(const struct reading *reading, const struct row_check *check, int index,
                      double *value)
{
    const struct rows_column *described = &reading->file->rows.kind->columns[index];
    int column = reading->columns[index];
    int32_t whole = 0;
    float angle_rad = 0;

    if (described->flags & COLUMN_ANGLE && !reading->is_degrees[index]) {
        bool is_good = row_read_and_wrap_angle_rad(check, column, &angle_rad);

        *value = (double)angle_rad;
        return is_good;
    }
    if (reading->is_degrees[index]) {
        return read_degrees_into_column_unit(check, column, described, value);
    }
    if (described->flags & COLUMN_STATUS) {
        return read_status(check, column, value);
    }
    if (described->flags & (COLUMN_INT16 | COLUMN_INT32)) {
        bool is_good = described->flags & COLUMN_INT16 ? read_int16(check, column, &whole)
                                                       : read_int32(check, column, &whole);

        *value = whole;
        return is_good;
    }
    if (!read_float(check, column, value)) {
        return false;
    }
    return !(described->flags & COLUMN_NO_ROOM) || rows_is_plus_zero((float)*value) ||
           row_refuse(check, "%s cannot be stored in a %s", described->name,
                      rho_message_type_name(reading->file->rows.kind->type));
}

static bool read_cells(const struct reading *reading, const struct row_check *check, double *cells)
{
    const struct rows_kind *kind = reading->file->rows.kind;

    for (int i = 0; i < kind->num_columns; i++) {
        if (row_has_cell(check, reading->columns[i])) {
            if (!read_cell(reading, check, i, &cells[i])) {
                return false;
            }
        } else if ((kind->columns[i].flags & COLUMN_FILLED) &&
                   !rows_geodetic_columns_replaces_column(&reading->geodetic, &kind->columns[i])) {
            return row_refuse(check, "%s is empty", kind->columns[i].name);
        }
    }
    return true;
}

/* Fills a radar's position from the parameters where its row does not state it. */
static void fill_missing_radar_place(const struct reading *reading, int32_t sensor_id,
                                     double *cells)
{
    static const enum sensor_parameter_id ids[] = {SENSOR_X_M, SENSOR_Y_M, SENSOR_Z_M};

    if (reading->place < 0) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        if (rows_is_cell_empty(cells[reading->place + i])) {
            cells[reading->place + i] = (double)(float)parameters_value_of_sensor(
                reading->parameters, sensor_id, ids[i], 0.0);
        }
    }
}

/* ---- Rows ---- */

static bool read_time_sensor_and_scan_numbers(const struct reading *reading,
                                              const struct row_check *check, struct row *row)
{
    const char *why = table_read_time_us(check->table, check->row, reading->t_s, &row->time_us);

    if (why) {
        return row_refuse_cell(check, reading->t_s, why);
    }
    row->epoch = 1;
    return row_read_received(check, reading->received_s, &row->received_us) &&
           (reading->sensor_id < 0 || read_int16(check, reading->sensor_id, &row->sensor_id)) &&
           (reading->scan < 0 || read_int32(check, reading->scan, &row->scan)) &&
           (reading->epoch < 0 || read_int32(check, reading->epoch, &row->epoch));
}

/* Encodes the newest row as a message of its own, and refuses a row that no message can hold. */
static bool check_newest_row_by_encoding(const struct reading *reading,
                                         const struct row_check *check)
{
    const struct rows *rows = &reading->file->rows;
    const struct row *row = &rows->list[rows->count - 1];
    struct rows_scan scan = {.utime = row->time_us, .head = *row, .count = 1, .num_parts = 1};
    struct rows_part part = {.rows = rows, .scan = &scan, .first = rows->count - 1};
    uint8_t message[ROWS_MESSAGE_BYTES];
    char buffer[TABLE_TEXT_BYTES];
    const char *field = "a value";
    int column;

    part.count = rows_row_has_measurement(rows, row);
    if (rows->kind->encode(&part, message, &field) > 0) {
        return true;
    }
    column = table_find_column(check->table, field);
    return row_refuse(check, "%s%s%.40s is outside the range of a %s", field, column < 0 ? "" : " ",
                      column < 0 ? "" : table_cell_text(check->table, check->row, column, buffer),
                      rho_message_type_name(rows->kind->type));
}

static struct scan_number scan_and_epoch_number_of_row(const struct reading *reading,
                                                       const struct row *row)
{
    return (struct scan_number){
        .is_given = reading->file->has_scan, .scan = row->scan, .epoch = row->epoch};
}

/* Whether the row belongs to a numbered scan that has begun before. */
static bool is_in_begun_scan(const struct reading *reading, const struct row *row)
{
    const struct scan_number number = scan_and_epoch_number_of_row(reading, row);
    size_t first = scan_numbers_find_scan_index(&reading->numbers, row->sensor_id, &number);

    return first != SCAN_NUMBERS_NONE && row_joins_scan(&number, row->time_us, &number,
                                                        reading->file->rows.list[first].time_us, 0);
}

/* The time by which rows are ordered: of reception where the file has it, else the row's own. */
static int64_t row_order_time_us(const struct reading *reading, const struct row *row)
{
    return reading->received_s >= 0 ? row->received_us : row->time_us;
}

/* Checks that times do not go back, except within a numbered scan; lists may be in any order. */
static bool check_time_order(const struct reading *reading, const struct row_check *check,
                             const struct row *row)
{
    if (!reading->file->rows.kind->has_sensor || !reading->has_last ||
        row_order_time_us(reading, row) >= reading->last_us ||
        (reading->received_s < 0 && is_in_begun_scan(reading, row))) {
        return true;
    }
    return row_refuse(check, "%s decreases from %.6f s to %.6f s",
                      reading->received_s >= 0 ? "received_s" : "time",
                      (double)reading->last_us * 1e-6,
                      (double)row_order_time_us(reading, row) * 1e-6);
}

static void note_row_scan_and_latest_time(struct reading *reading, const struct row *row)
{
    const struct scan_number number = scan_and_epoch_number_of_row(reading, row);

    if (reading->file->rows.kind->has_sensor && !is_in_begun_scan(reading, row)) {
        scan_numbers_set_scan(&reading->numbers, row->sensor_id, &number,
                              reading->file->rows.count - 1);
    }
    if (!reading->has_last || row_order_time_us(reading, row) > reading->last_us) {
        reading->last_us = row_order_time_us(reading, row);
    }
    reading->has_last = true;
}

/* Reads the cells of the newest row, and checks the row with them. */
static bool read_and_check_row(const struct reading *reading, const struct row_check *check,
                               const struct row *row, double *cells)
{
    const struct rows *rows = &reading->file->rows;
    const char *why = NULL;

    if (!check_time_order(reading, check, row) || !read_cells(reading, check, cells)) {
        return false;
    }
    fill_missing_radar_place(reading, row->sensor_id, cells);
    if (!rows_geodetic_columns_fill_local_cells(&reading->geodetic, check, row->sensor_id, cells)) {
        return false;
    }
    if (rows->kind->why_not && rows_row_has_measurement(rows, &rows->list[rows->count - 1])) {
        why = rows->kind->why_not(cells);
    }
    return why ? row_refuse(check, "%s", why) : check_newest_row_by_encoding(reading, check);
}

/* Adds a row of the table where it is good; else returns false with the reason set. */
static bool add_row_or_refuse_with_reason(struct reading *reading, const struct row_check *check)
{
    struct rows *rows = &reading->file->rows;
    struct row row = {.line = check->table->lines[check->row], .order = check->row};

    if (!read_time_sensor_and_scan_numbers(reading, check, &row)) {
        return false;
    }
    if (!read_and_check_row(reading, check, &row, rows_add_row(rows, &row))) {
        rows->num_cells = rows->list[--rows->count].cells;
        return false;
    }
    note_row_scan_and_latest_time(reading, &row);
    return true;
}

static void read_rows(struct reading *reading)
{
    char reason[ROW_REASON_BYTES];

    for (size_t i = 0; i < reading->table->num_rows; i++) {
        const struct row_check check = {.table = reading->table, .row = i, .reason = reason};

        if (!add_row_or_refuse_with_reason(reading, &check)) {
            rows_refuse_row(reading->file, &(struct row){.line = reading->table->lines[i]}, "%s",
                            reason);
        }
    }
}

bool rows_read_table_and_has_any(struct rows_file *file, const char *path,
                                 const struct table *table, const struct parameters *parameters,
                                 bool keep_going)
{
    struct reading reading = {.file = file, .table = table, .parameters = parameters};

    *file = (struct rows_file){.path = must_copy_text(path),
                               .keep_going = keep_going,
                               .rows_skipped = table->rows_skipped};
    rows_init(&file->rows, kind_of_table(table));
    find_columns(&reading);
    read_rows(&reading);
    rows_geodetic_columns_close(&reading.geodetic);
    scan_numbers_clear(&reading.numbers);
    return reading.has_last;
}

void rows_read_csv_or_asterix(struct rows_file *file, const char *path,
                              const struct parameters *parameters, bool keep_going)
{
    struct table *table = table_read_csv_or_asterix(path, parameters, keep_going);

    table_need_rows(table);
    if (!rows_read_table_and_has_any(file, path, table, parameters, keep_going)) {
        table_fail_at_row(table, TABLE_HEADER, "no valid row after the header");
    }
    table_free(table);
}

void rows_refuse_row(struct rows_file *file, const struct row *row, const char *format, ...)
{
    char message[ROW_REASON_BYTES];
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    if (!file->keep_going) {
        fail(EXIT_USAGE, "%s:%u: %s", file->path, (unsigned)row->line, message);
    }
    file->rows_skipped++;
}

void rows_file_free(struct rows_file *file)
{
    free(file->path);
    rows_free(&file->rows);
    *file = (struct rows_file){.path = NULL};
}
