/* SPDX-License-Identifier: MIT */
#include "io/rows/read_truth_or_track_row.h"

#include <math.h>

#include "io/rows/rows_in_memory.h"

struct trajectory_columns trajectory_columns_find(const struct table *table,
                                                  const struct parameters *parameters)
{
    const bool is_tracks = table_find_column(table, "track_id") >= 0;
    struct geodetic_columns *geodetic = is_tracks ? NULL : geodetic_columns_open(table, parameters);
    const bool has_places = geodetic_columns_has_place_columns(geodetic);
    return (struct trajectory_columns){
        .table = table,
        .time = table_need_column(table, "t_s"),
        .id = table_need_column(table, is_tracks ? "track_id" : "target_id"),
        .status = table_find_column(table, "status"),
        .x = has_places ? table_find_column(table, "lat_deg") : table_need_column(table, "x_m"),
        .y = has_places ? table_find_column(table, "lon_deg") : table_need_column(table, "y_m"),
        .z = table_find_column(table, has_places ? "alt_m" : "z_m"),
        .vx = table_find_column(table, "vx_mps"),
        .vy = table_find_column(table, "vy_mps"),
        .vz = table_find_column(table, "vz_mps"),
        .covariance = {table_find_column(table, "cov_x_x"), table_find_column(table, "cov_y_x"),
                       table_find_column(table, "cov_y_y"), table_find_column(table, "cov_vx_vx"),
                       table_find_column(table, "cov_vy_vx"),
                       table_find_column(table, "cov_vy_vy")},
        .geodetic = geodetic,
    };
}

void trajectory_columns_free(struct trajectory_columns *columns)
{
    geodetic_columns_close(columns->geodetic);
    columns->geodetic = NULL;
}

bool trajectory_row_has_place(const struct trajectory_columns *columns, size_t row)
{
    return !table_is_cell_empty(columns->table, row, columns->x);
}

static void read_place(const struct trajectory_columns *columns, size_t row,
                       struct trajectory_row *path)
{
    const struct table *table = columns->table;
    char reason[ROW_REASON_BYTES];
    const struct row_check check = {.table = table, .row = row, .reason = reason};
    double place_m[3];
    bool has_alt;
    if (!geodetic_columns_has_place_columns(columns->geodetic)) {
        path->x_m = table_number_at(table, row, columns->x);
        path->y_m = table_number_at(table, row, columns->y);
        path->z_m = table_number_or(table, row, columns->z, 0.0);
        return;
    }
    if (!geodetic_columns_read_place(columns->geodetic, &check, place_m, &has_alt)) {
        table_fail_at_row(table, row, "%s", reason);
    }
    path->x_m = place_m[0];
    path->y_m = place_m[1];
    path->z_m = place_m[2];
}

/* Exit 2 where there is a reason why the cell is bad. */
static void fail_if_bad_cell(const struct trajectory_columns *columns, size_t row, int column,
                             const char *reason)
{
    char buffer[TABLE_TEXT_BYTES];
    if (reason) {
        table_fail_at_row(columns->table, row, "%s: '%s' %s", columns->table->names[column],
                          table_cell_text(columns->table, row, column, buffer), reason);
    }
}

static int read_status(const struct trajectory_columns *columns, size_t row)
{
    int status = RHO_MESSAGE_TRACK_CONFIRMED;
    if (columns->status >= 0) {
        for (status = 1; status <= ROWS_STATUS_MAX; status++) {
            if (table_is_word(columns->table, row, columns->status,
                              rows_track_status_name(status))) {
                return status;
            }
        }
        fail_if_bad_cell(columns, row, columns->status,
                         "is none of tentative, confirmed, coasting, deleted");
    }
    return status;
}

struct trajectory_row trajectory_row_read(const struct trajectory_columns *columns, size_t row)
{
    const struct table *table = columns->table;
    struct trajectory_row path;
    fail_if_bad_cell(columns, row, columns->time,
                     table_read_time_us(table, row, columns->time, &path.time_us));
    fail_if_bad_cell(columns, row, columns->id,
                     table_read_int32(table, row, columns->id, &path.id));
    read_place(columns, row, &path);
    path.vx_mps = table_number_or(table, row, columns->vx, NAN);
    path.vy_mps = table_number_or(table, row, columns->vy, NAN);
    path.vz_mps = table_number_or(table, row, columns->vz, 0.0);
    for (size_t i = 0; i < sizeof path.covariance / sizeof path.covariance[0]; i++) {
        path.covariance[i] = table_number_or(table, row, columns->covariance[i], NAN);
    }
    path.status = read_status(columns, row);
    return path;
}
