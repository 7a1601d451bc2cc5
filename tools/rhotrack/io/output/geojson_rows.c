/* SPDX-License-Identifier: MIT */
#include "io/output/geojson_rows.h"

#include <stdlib.h>

#include "io/output/geojson_tracks_writer.h"

static int by_time(const void *a, const void *b)
{
    const struct row *one = a, *other = b;

    return one->time_us != other->time_us
               ? rows_compare_int64(one->time_us, other->time_us)
               : (one->order > other->order) - (one->order < other->order);
}

static int int_or_zero_of_cell(double cell)
{
    return rows_is_cell_empty(cell) ? 0 : (int)cell;
}

static void add_track_row(struct geojson *geojson, const struct rows *rows, const struct row *row)
{
    static const enum column_id state[] = {COL_X_M,    COL_Y_M,    COL_Z_M,
                                           COL_VX_MPS, COL_VY_MPS, COL_VZ_MPS};
    const double *cells = rows_cells(rows, row);
    struct geojson_row track = {
        .time_us = row->time_us,
        .track_id = (int32_t)cells[rows_column_index(rows->kind, COL_TRACK_ID)],
        .status = rows_track_status_name((int)cells[rows_column_index(rows->kind, COL_STATUS)]),
        .sigma_m = rows_float_or_zero(cells[rows_column_index(rows->kind, COL_SIGMA_M)]),
        .hits = int_or_zero_of_cell(cells[rows_column_index(rows->kind, COL_HITS)]),
        .misses = int_or_zero_of_cell(cells[rows_column_index(rows->kind, COL_MISSES)])};

    for (int i = 0; i < 6; i++) {
        track.state[i] = rows_float_or_zero(cells[rows_column_index(rows->kind, state[i])]);
    }
    geojson_add_row(geojson, &track);
}

void geojson_write_rows(FILE *file, struct rows *rows, const struct parameters *parameters)
{
    struct geojson *geojson = geojson_open(file, parameters);

    qsort(rows->list, rows->count, sizeof *rows->list, by_time);
    for (size_t i = 0; i < rows->count; i++) {
        if (rows_row_has_measurement(rows, &rows->list[i])) {
            add_track_row(geojson, rows, &rows->list[i]);
        }
    }
    geojson_end_and_free(geojson);
}
