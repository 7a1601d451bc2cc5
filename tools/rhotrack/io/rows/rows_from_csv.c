/* SPDX-License-Identifier: MIT */
#include "io/rows/rows_from_csv.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/csv/frame_gaps.h"
#include "io/csv/row_cells.h"
#include "io/csv/sensor_names.h"
#include "io/rows/rows_geodetic.h"
#include "io/scans/scan_numbers.h"

/* State of reading a table. */
struct reading {
    struct rows_file *file;
    struct columns columns; /* those that the file's kind does not use count as missing */
    const struct parameters *parameters;
    struct rows_geodetic geodetic;
    struct frame_gaps gaps;
    struct scan_numbers numbers; /* numbered scans, by the indices of their first rows */
    bool has_last;
    int64_t last_us; /* latest time of a row, or of its reception where that is given */
};

static const struct rows_kind *kind_of_columns(const struct columns *columns)
{
    static const struct {
        enum column_id column;
        int kind;
    } marks[] = {{COL_TRACK_ID, ROWS_TRACKS}, {COL_TARGET_ID, ROWS_TRUTH},
                 {COL_RANGE_M, ROWS_POLAR},   {COL_X_M, ROWS_PLOTS},
                 {COL_LAT_DEG, ROWS_PLOTS},   {COL_BEARING_RAD, ROWS_BEARINGS}};

    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        /* simulated plots may name their target, and have a sensor */
        if (columns->at[marks[i].column] >= 0 &&
            !(marks[i].kind == ROWS_TRUTH && columns->at[COL_SENSOR_ID] >= 0)) {
            return rows_kinds[marks[i].kind];
        }
    }
    table_fail_at_row(columns->table, TABLE_HEADER,
                      "neither plots, polar plots, bearings, truth nor tracks: no column 'x_m', "
                      "'lat_deg', 'range_m', 'bearing_rad', 'target_id' or 'track_id'");
}

static void check_columns(struct reading *reading)
{
    struct columns *columns = &reading->columns;
    const struct rows_kind *kind = reading->file->rows.kind;

    (void)columns_need(columns, COL_T_S);
    if (kind == &rows_kind_bearings || (kind->has_sensor && reading->parameters->num_sensors > 1)) {
        (void)columns_need(columns, COL_SENSOR_ID);
    }
    columns->at[COL_RECEIVED_S] = kind->has_received ? columns->at[COL_RECEIVED_S] : -1;
    columns->at[COL_EPOCH] = kind->has_epoch ? columns->at[COL_EPOCH] : -1;
    reading->file->rows.has_received = columns->at[COL_RECEIVED_S] >= 0;
    reading->file->has_scan = columns->at[COL_SCAN] >= 0;
    reading->file->has_epoch = columns->at[COL_EPOCH] >= 0;
    reading->file->has_frames =
        columns->at[COL_T_S] >= 0 && table_is_frame_number(columns->table, columns->at[COL_T_S]);
    reading->geodetic = rows_geodetic_open(columns->table, kind, reading->parameters);
    for (int i = 0; i < kind->num_columns; i++) {
        const struct rows_column *column = &kind->columns[i];

        columns_refuse_two_units(columns, column->id);
        if ((column->flags & COLUMN_NEEDED) &&
            !rows_geodetic_replaces(&reading->geodetic, column)) {
            (void)columns_need(columns, column->id);
        }
    }
    if (kind == &rows_kind_polar) {
        columns_refuse_both(columns, COL_RANGE_M, COL_X_M);
    }
    columns_need_both(columns, COL_SENSOR_X_M, COL_SENSOR_Y_M);
    columns_need_both(columns, COL_SECTOR_FROM_RAD, COL_SECTOR_TO_RAD);
}

static bool read_status(const struct row_check *check, enum column_id column, double *value)
{
    const int at = check->columns->at[column];

    for (int i = 1; i <= ROWS_STATUS_MAX; i++) {
        if (table_is_word(check->columns->table, check->row, at, rows_track_status_name(i))) {
            *value = i;
            return true;
        }
    }
    return row_refuse_cell(check, column, "is none of tentative, confirmed, coasting, deleted");
}

static bool check_int16(const struct row_check *check, enum column_id column, int32_t value)
{
    return (value >= INT16_MIN && value <= INT16_MAX) ||
           row_refuse_cell(check, column, "is outside -32768 .. 32767, the range of messages");
}

static bool read_int16(const struct row_check *check, enum column_id column, int32_t *value)
{
    return row_read_int32(check, column, value) && check_int16(check, column, *value);
}

static bool read_float(const struct row_check *check, enum column_id column, double *value)
{
    const struct columns *columns = check->columns;
    float number;
    const char *why = table_read_float(columns->table, check->row, columns->at[column], &number);

    *value = (double)number;
    return !why || row_refuse_cell(check, column, why);
}

static bool read_degrees(const struct row_check *check, enum column_id column, double *value)
{
    const struct columns *columns = check->columns;
    double degrees = 0.0;
    const char *why = table_read_number(columns->table, check->row, columns->at[column], &degrees);

    if (why) {
        return row_refuse_cell(check, column, why);
    }
    if (fabs(degrees) > ROW_ANGLE_MAX) {
        return row_refuse_cell(check, column, "is outside -1000000 .. 1000000");
    }
    *value = (double)(float)column_radians(column, degrees);
    return true;
}

static bool read_cell(const struct rows_kind *kind, const struct row_check *check, int index,
                      double *value)
{
    const struct rows_column *column = &kind->columns[index];
    int32_t whole = 0;
    float angle_rad = 0;
    bool is_good;

    if (columns_has_degrees(check->columns, column->id)) {
        return read_degrees(check, column->id, value);
    }
    if (column->flags & COLUMN_ANGLE) {
        is_good = row_read_and_wrap_angle_rad(check, column->id, &angle_rad);
        *value = (double)angle_rad;
        return is_good;
    }
    if (column->flags & COLUMN_STATUS) {
        return read_status(check, column->id, value);
    }
    if (column->flags & (COLUMN_INT16 | COLUMN_INT32)) {
        is_good = column->flags & COLUMN_INT16 ? read_int16(check, column->id, &whole)
                                               : row_read_int32(check, column->id, &whole);
        *value = whole;
        return is_good;
    }
    if (!read_float(check, column->id, value)) {
        return false;
    }
    return !(column->flags & COLUMN_NO_ROOM) || rows_is_plus_zero((float)*value) ||
           row_refuse(check, "%s cannot be stored in a %s", column_name(column->id),
                      rho_message_type_name(kind->type));
}

static bool read_cells(const struct reading *reading, const struct row_check *check, double *cells)
{
    const struct rows_kind *kind = reading->file->rows.kind;

    for (int i = 0; i < kind->num_columns; i++) {
        if (row_has_cell(check, kind->columns[i].id)) {
            if (!read_cell(kind, check, i, &cells[i])) {
                return false;
            }
        } else if ((kind->columns[i].flags & COLUMN_FILLED) &&
                   !rows_geodetic_replaces(&reading->geodetic, &kind->columns[i])) {
            return row_refuse(check, "%s is empty", column_name(kind->columns[i].id));
        }
    }
    return true;
}

/*
 * Fills a sensor's position from the parameters where its row does not state it. One of bearings
 * that has none there is left empty.
 */
static void fill_missing_sensor_place(const struct reading *reading, int32_t sensor_id,
                                      double *cells)
{
    static const enum sensor_parameter_id ids[] = {SENSOR_X_M, SENSOR_Y_M, SENSOR_Z_M};
    static const enum column_id columns[] = {COL_SENSOR_X_M, COL_SENSOR_Y_M, COL_SENSOR_Z_M};

    const struct rows_kind *kind = reading->file->rows.kind;
    const bool is_passive = kind == &rows_kind_bearings;

    for (int i = 0; (kind == &rows_kind_polar || is_passive) && i < 3; i++) {
        double *cell = &cells[rows_column_index(kind, columns[i])];

        if (rows_is_cell_empty(*cell)) {
            *cell = (double)(float)parameters_value_of_sensor(reading->parameters, sensor_id,
                                                              ids[i], is_passive ? *cell : 0.0);
        }
    }
}

/* A line of sight over the zenith becomes that of the other side; half a turn at most. */
static void fold_over_zenith(const struct rows_kind *kind, double *cells)
{
    const bool is_polar = kind == &rows_kind_polar;

    if (is_polar || kind == &rows_kind_bearings) {
        double *elevation = &cells[rows_column_index(kind, COL_ELEVATION_RAD)];
        double *azimuth =
            &cells[rows_column_index(kind, is_polar ? COL_AZIMUTH_RAD : COL_BEARING_RAD)];

        if (!rows_is_cell_empty(*elevation) && !rows_is_cell_empty(*azimuth) && *elevation > 0.0 &&
            *elevation <= (double)3.1415927f) {
            columns_fold_over_zenith(elevation, azimuth);
            *elevation = (double)(float)*elevation;
            *azimuth = (double)(float)*azimuth;
        }
    }
}

/* Reads the row's times, its sensor and its scan's numbers. */
static bool read_row_head(const struct reading *reading, const struct row_check *check,
                          struct row *row)
{
    const int *at = reading->columns.at;
    const bool is_sensors = reading->file->rows.kind->has_sensor;
    const bool has_sensor = is_sensors && at[COL_SENSOR_ID] >= 0;

    row->epoch = 1;
    row->sensor_id = is_sensors ? parameters_lone_sensor_id(reading->parameters) : 0;
    return row_read_time(check, COL_T_S, &row->time_us) &&
           row_read_received(check, &row->received_us) &&
           (!has_sensor || (sensor_names_read(check, reading->parameters, &row->sensor_id) &&
                            check_int16(check, COL_SENSOR_ID, row->sensor_id))) &&
           (at[COL_SCAN] < 0 || row_read_int32(check, COL_SCAN, &row->scan)) &&
           (at[COL_EPOCH] < 0 || row_read_int32(check, COL_EPOCH, &row->epoch));
}

/* Encodes the newest row as a message of its own, and refuses a row that no message can hold. */
static bool check_newest_row_by_encoding(const struct reading *reading,
                                         const struct row_check *check)
{
    const struct rows *rows = &reading->file->rows;
    const struct row *row = &rows->list[rows->count - 1];
    struct rows_scan scan = {.utime = row->time_us, .head = *row, .count = 1, .num_parts = 1};
    struct rows_part part = {.rows = rows, .scan = &scan, .first = rows->count - 1};
    const struct rows_kind *kind = rows_kind_of_row(rows, row);
    uint8_t message[ROWS_MESSAGE_BYTES];
    char buffer[TABLE_TEXT_BYTES];
    const char *field = "a value";
    int column;

    part.count = rows_row_has_measurement(rows, row);
    if (kind->encode(&part, message, &field) > 0) {
        return true;
    }
    column = table_find_column(check->columns->table, field);
    return row_refuse(
        check, "%s%s%.40s is outside the range of a %s", field, column < 0 ? "" : " ",
        column < 0 ? "" : table_cell_text(check->columns->table, check->row, column, buffer),
        rho_message_type_name(kind->type));
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
    return reading->file->rows.has_received ? row->received_us : row->time_us;
}

/* Checks that times do not go back, except within a numbered scan; lists may be in any order. */
static bool check_time_order(const struct reading *reading, const struct row_check *check,
                             const struct row *row)
{
    if (!reading->file->rows.kind->has_sensor || !reading->has_last ||
        row_order_time_us(reading, row) >= reading->last_us ||
        (!reading->file->rows.has_received && is_in_begun_scan(reading, row))) {
        return true;
    }
    return row_refuse_decrease(check, reading->file->rows.has_received, reading->last_us,
                               row_order_time_us(reading, row));
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

static bool check_passive_place(const struct reading *reading, const struct row_check *check,
                                const struct row *row, const double *cells)
{
    static const enum column_id places[] = {COL_SENSOR_X_M, COL_SENSOR_Y_M};

    for (int i = 0; i < 2; i++) {
        if (!rows_is_cell_empty(cells[rows_column_index(&rows_kind_bearings, places[i])])) {
            continue;
        }
        return check->columns->at[places[i]] >= 0 && reading->parameters->num_sensors == 0
                   ? row_refuse_cell(check, places[i], "")
                   : row_refuse(check,
                                "sensor_x_m, sensor_y_m are empty, and [sensor %d] has no place",
                                (int)row->sensor_id);
    }
    return true;
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
    fold_over_zenith(rows->kind, cells);
    fill_missing_sensor_place(reading, row->sensor_id, cells);
    if (!rows_geodetic_fill_cells(&reading->geodetic, check, row->sensor_id, cells)) {
        return false;
    }
    if (rows->kind == &rows_kind_bearings && !check_passive_place(reading, check, row, cells)) {
        return false;
    }
    if (rows->kind->why_not && rows_row_has_measurement(rows, &rows->list[rows->count - 1])) {
        why = rows->kind->why_not(cells);
    }
    return why ? row_refuse(check, "%s", why) : check_newest_row_by_encoding(reading, check);
}

/*
 * Adds scans without plots for the frames before the newest row in which its sensor saw nothing;
 * the row stays the newest one. They take the sensor's place and the sector from this row, the one
 * after the gap.
 */
static void add_frames_without_rows(struct reading *reading)
{
    struct rows *rows = &reading->file->rows;
    const struct rows_kind *kind = rows->kind;
    const struct row newest = rows->list[rows->count - 1];
    const struct frame_gap gap =
        frame_gaps_before_row(&reading->gaps, &reading->columns, newest.sensor_id, newest.time_us);

    for (int i = 0; i < gap.count; i++) {
        struct row *last;
        double *cells = rows_add_row(rows, &newest);

        for (int j = 0; j < kind->num_columns; j++) {
            if (!(kind->columns[j].flags & COLUMN_MEASURED)) {
                cells[j] = rows->cells[newest.cells + (size_t)j];
            }
        }
        last = &rows->list[rows->count - 1];
        last[-1] = last[0];
        last[-1].time_us = frame_gap_time_us(&gap, i);
        last[-1].order = rows->count - 2;
        last[0] = newest;
        last[0].order = rows->count - 1;
    }
}

/* Adds a row of the table where it is good; else returns false with the reason set. */
static bool add_row_or_refuse_with_reason(struct reading *reading, const struct row_check *check)
{
    struct rows *rows = &reading->file->rows;
    struct row row = {.line = check->columns->table->lines[check->row],
                      .order = reading->file->rows.count};

    if (!read_row_head(reading, check, &row)) {
        return false;
    }
    if (!read_and_check_row(reading, check, &row, rows_add_row(rows, &row))) {
        rows->num_cells = rows->list[--rows->count].cells;
        return false;
    }
    note_row_scan_and_latest_time(reading, &row);
    if (rows->kind->has_sensor) {
        add_frames_without_rows(reading);
    }
    return true;
}

static void read_rows(struct reading *reading)
{
    const struct table *table = reading->columns.table;
    char reason[ROW_REASON_BYTES];

    for (size_t i = 0; i < table->num_rows; i++) {
        const struct row_check check = {.columns = &reading->columns, .row = i, .reason = reason};

        if (!add_row_or_refuse_with_reason(reading, &check)) {
            rows_refuse_row(reading->file, &(struct row){.line = table->lines[i]}, "%s", reason);
        }
    }
}

bool rows_read_table_and_has_any(struct rows_file *file, const char *path,
                                 const struct table *table, const struct parameters *parameters,
                                 bool keep_going)
{
    struct reading reading = {
        .file = file, .columns = columns_find(table), .parameters = parameters};

    *file = (struct rows_file){.path = must_copy_text(path),
                               .keep_going = keep_going,
                               .rows_skipped = table->rows_skipped};
    rows_init(&file->rows, kind_of_columns(&reading.columns));
    check_columns(&reading);
    read_rows(&reading);
    rows_geodetic_close(&reading.geodetic);
    frame_gaps_report(&reading.gaps, path);
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
