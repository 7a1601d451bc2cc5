/* SPDX-License-Identifier: MIT */
#include "io/rows/rows_to_csv.h"

#include <inttypes.h>
#include <stdlib.h>

#include "base/common.h"
#include "io/csv/tracks_writer.h"

static bool is_column_wanted(const struct rows *rows, int index, bool with_covariance)
{
    const struct rows_column *column = &rows->kind->columns[index];

    if (column->flags & (COLUMN_ALWAYS | COLUMN_COVARIANCE)) {
        return (column->flags & COLUMN_ALWAYS) || with_covariance;
    }
    for (size_t i = 0; i < rows->count; i++) {
        if (rows_is_cell_written(column, rows_cells(rows, &rows->list[i])[index])) {
            return true;
        }
    }
    return false;
}

static void choose_columns(const struct rows *rows, bool with_covariance, bool *is_chosen)
{
    const struct rows_column *columns = rows->kind->columns;

    for (int i = 0; i < rows->kind->num_columns; i++) {
        is_chosen[i] = is_column_wanted(rows, i, with_covariance);
    }
    for (int i = 0; i < rows->kind->num_columns; i++) {
        for (int j = 0; j < rows->kind->num_columns && !is_chosen[i]; j++) {
            is_chosen[i] = columns[i].group != 0 && columns[j].group == columns[i].group &&
                           is_column_wanted(rows, j, with_covariance);
        }
    }
}

static void write_comma_and_cell(FILE *file, const struct rows_column *column, double cell)
{
    char text[FLOAT_TEXT_BYTES];

    fputc(',', file);
    if (rows_is_cell_empty(cell)) {
        return;
    }
    if (column->flags & COLUMN_STATUS) {
        fputs(rows_track_status_name((int)cell), file);
    } else if (column->flags & (COLUMN_INT16 | COLUMN_INT32)) {
        fprintf(file, "%" PRId32, (int32_t)cell);
    } else if (!(cell < 0.0) && !(cell > 0.0) && !rows_is_plus_zero((float)cell)) {
        fputs("-0", file); /* shortest_float_text does not write -0 */
    } else {
        fputs(shortest_float_text((float)cell, text), file);
    }
}

static void write_header(FILE *file, const struct rows *rows, const bool *is_chosen)
{
    const struct rows_kind *kind = rows->kind;

    fputs(kind->has_sensor ? "t_s,sensor_id" : "t_s", file);
    for (int i = 0; i < kind->num_columns; i++) {
        if (is_chosen[i]) {
            fprintf(file, ",%s", column_name(kind->columns[i].id));
        }
    }
    fprintf(file, ",scan%s%s\n", kind->has_epoch ? ",epoch" : "",
            rows->has_received ? ",received_s" : "");
}

static void write_row(FILE *file, const struct rows *rows, const struct row *row,
                      const bool *is_chosen)
{
    const struct rows_kind *kind = rows->kind;
    const double *cells = rows_cells(rows, row);

    tracks_write_time(file, row->time_us);
    if (kind->has_sensor) {
        fprintf(file, ",%" PRId32, row->sensor_id);
    }
    for (int i = 0; i < kind->num_columns; i++) {
        if (is_chosen[i]) {
            write_comma_and_cell(file, &kind->columns[i], cells[i]);
        }
    }
    fprintf(file, ",%" PRId32, row->scan);
    if (kind->has_epoch) {
        fprintf(file, ",%" PRId32, row->epoch);
    }
    if (rows->has_received) {
        fputc(',', file);
        tracks_write_time(file, row->received_us);
    }
    fputc('\n', file);
}

void rows_write_csv(FILE *file, const struct rows *rows, bool with_covariance)
{
    bool is_chosen[ROWS_MAX_COLUMNS];

    choose_columns(rows, with_covariance, is_chosen);
    write_header(file, rows, is_chosen);
    for (size_t i = 0; i < rows->count; i++) {
        write_row(file, rows, &rows->list[i], is_chosen);
    }
}

/* The number with the fewest digits that gives the same float32, as the CSV file has it. */
static double shortest_float(double cell)
{
    char text[FLOAT_TEXT_BYTES];

    if (!(cell < 0.0) && !(cell > 0.0)) {
        return cell; /* NaN, 0, or -0, which shortest_float_text does not write */
    }
    return strtod(shortest_float_text((float)cell, text), NULL);
}

static struct table *start_table(const char *path, const struct rows *rows, const bool *is_chosen)
{
    struct table_column list[ROWS_MAX_COLUMNS + 4];
    const struct rows_kind *kind = rows->kind;
    size_t count = 0;

    list[count++] = (struct table_column){.name = "t_s"};
    if (kind->has_sensor) {
        list[count++] = (struct table_column){.name = "sensor_id"};
    }
    for (int i = 0; i < kind->num_columns; i++) {
        const struct rows_column *column = &kind->columns[i];

        if (is_chosen[i]) {
            list[count++] = (struct table_column){
                .name = column_name(column->id),
                .decimals = column->flags & (COLUMN_INT16 | COLUMN_INT32) ? 0 : TABLE_SHORTEST,
                .word = column->flags & COLUMN_STATUS ? rows_track_status_name : NULL};
        }
    }
    list[count++] = (struct table_column){.name = "scan"};
    if (kind->has_epoch) {
        list[count++] = (struct table_column){.name = "epoch"};
    }
    return table_make_empty_of_numbers(path, list, count);
}

static void add_row_to_table(struct table *table, const struct rows *rows, const struct row *row,
                             const bool *is_chosen)
{
    const struct rows_kind *kind = rows->kind;
    const double *cells = rows_cells(rows, row);
    double *numbers = table_add_row_of_numbers(table, row->time_us, (uint32_t)table->num_rows + 2);
    size_t at = 1;

    if (kind->has_sensor) {
        numbers[at++] = row->sensor_id;
    }
    for (int i = 0; i < kind->num_columns; i++) {
        if (is_chosen[i]) {
            numbers[at++] = shortest_float(cells[i]);
        }
    }
    numbers[at++] = row->scan;
    if (kind->has_epoch) {
        numbers[at] = row->epoch;
    }
}

struct table *rows_to_table(const char *path, const struct rows *rows)
{
    bool is_chosen[ROWS_MAX_COLUMNS];
    struct table *table;

    choose_columns(rows, true, is_chosen);
    table = start_table(path, rows, is_chosen);
    for (size_t i = 0; i < rows->count; i++) {
        add_row_to_table(table, rows, &rows->list[i], is_chosen);
    }
    return table;
}
