/* SPDX-License-Identifier: MIT */
#include "io/rows/rows_in_memory.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"

const char *rows_track_status_name(int status)
{
    static const char *const names[ROWS_STATUS_MAX + 1] = {
        [RHO_MESSAGE_TRACK_TENTATIVE] = "tentative",
        [RHO_MESSAGE_TRACK_CONFIRMED] = "confirmed",
        [RHO_MESSAGE_TRACK_COASTING] = "coasting",
        [RHO_MESSAGE_TRACK_DELETED] = "deleted",
    };

    return names[status];
}

int rows_column_index(const struct rows_kind *kind, enum column_id id)
{
    int i = 0;

    while (kind->columns[i].id != id) {
        i++;
    }
    return i;
}

int rows_compare_int64(int64_t one, int64_t other)
{
    return (one > other) - (one < other);
}

void rows_init(struct rows *rows, const struct rows_kind *kind)
{
    *rows = (struct rows){.kind = kind};
}

void rows_free(struct rows *rows)
{
    free(rows->list);
    free(rows->cells);
}

static void make_room_for_row_cells(struct rows *rows)
{
    if (rows->num_cells + (size_t)rows->kind->num_columns <= rows->cells_capacity) {
        return;
    }
    rows->cells_capacity = 2 * rows->cells_capacity + 16 * ROWS_MAX_COLUMNS;
    rows->cells = must_realloc(rows->cells, rows->cells_capacity * sizeof *rows->cells);
}

double *rows_add_row(struct rows *rows, const struct row *row)
{
    double *cells;

    rows->list =
        must_make_room_for_one(rows->list, rows->count, &rows->capacity, sizeof *rows->list);
    make_room_for_row_cells(rows);
    rows->list[rows->count] = *row;
    rows->list[rows->count++].cells = rows->num_cells;
    cells = rows->cells + rows->num_cells;
    for (int i = 0; i < rows->kind->num_columns; i++) {
        cells[i] = (double)NAN;
    }
    rows->num_cells += (size_t)rows->kind->num_columns;
    return cells;
}

double *rows_cells(const struct rows *rows, const struct row *row)
{
    return rows->cells + row->cells;
}

bool rows_row_has_measurement(const struct rows *rows, const struct row *row)
{
    const double *cells = rows_cells(rows, row);

    for (int i = 0; i < rows->kind->num_columns; i++) {
        if ((rows->kind->columns[i].flags & COLUMN_MEASURED) && !rows_is_cell_empty(cells[i])) {
            return true;
        }
    }
    return false;
}

bool rows_is_cell_written(const struct rows_column *column, double cell)
{
    return !rows_is_cell_empty(cell) &&
           (!(column->flags & COLUMN_NOT_ZERO) || !rows_is_plus_zero((float)cell));
}

const struct rows_kind *rows_kind_of_row(const struct rows *rows, const struct row *row)
{
    const struct rows_kind *kind = rows->kind;
    const double *cells = rows_cells(rows, row);

    for (int i = 0; kind->wider && i < kind->num_columns; i++) {
        if ((kind->columns[i].flags & COLUMN_WIDER) &&
            rows_is_cell_written(&kind->columns[i], cells[i])) {
            return kind->wider;
        }
    }
    return kind;
}

bool rows_is_cell_empty(double cell)
{
    return isnan(cell);
}

float rows_float_or_zero(double cell)
{
    return rows_is_cell_empty(cell) ? 0.0f : (float)cell;
}

bool rows_is_plus_zero(float value)
{
    return fpclassify(value) == FP_ZERO && !signbit(value);
}

double rows_zero_to_empty_cell(float value)
{
    return rows_is_plus_zero(value) ? (double)NAN : (double)value;
}

void rows_put_sector(double cells[2], float from_rad, float to_rad)
{
    if (!rows_is_plus_zero(from_rad) || !rows_is_plus_zero(to_rad)) {
        cells[0] = (double)from_rad;
        cells[1] = (double)to_rad;
    }
}

double *rows_begin_message(struct rows *rows, struct rows_message *message, const struct row *key,
                           int16_t part, int16_t num_parts, int count)
{
    double *cells = rows_add_row(rows, key);

    message->key = *key;
    message->part = part;
    message->num_parts = num_parts;
    message->first = rows->count;
    message->count = (size_t)count;
    return cells;
}

double *rows_add_message_row(struct rows *rows, const struct rows_message *message, int32_t dt_us)
{
    struct row row = message->key;

    row.time_us += dt_us;
    return rows_add_row(rows, &row);
}

int32_t rows_plot_offset_us(const struct rows_part *part, size_t index)
{
    return (int32_t)(part->rows->list[part->first + index].time_us - part->scan->utime);
}

const double *rows_part_cells(const struct rows_part *part, size_t index)
{
    return rows_cells(part->rows, &part->rows->list[part->first + index]);
}

const double *rows_scan_first_row_cells(const struct rows_part *part)
{
    return rows_cells(part->rows, &part->scan->head);
}
