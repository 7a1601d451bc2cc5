/* SPDX-License-Identifier: MIT */
#include "io/rows/trajectory_row.h"

#include <math.h>

#include "io/rows/rows_in_memory.h"

static enum column_id id_column(const struct trajectory_columns *columns)
{
    return columns->in_file.at[COL_TRACK_ID] >= 0 ? COL_TRACK_ID : COL_TARGET_ID;
}

struct trajectory_columns trajectory_columns_find(const struct table *table,
                                                  const struct parameters *parameters)
{
    struct trajectory_columns columns = {.in_file = columns_find(table)};

    if (id_column(&columns) == COL_TARGET_ID) {
        columns.geodetic = geodetic_open(table, parameters);
    }
    (void)columns_need(&columns.in_file, COL_T_S);
    (void)columns_need(&columns.in_file, id_column(&columns));
    columns.has_z = columns.in_file.at[COL_ALT_M] >= 0;
    if (!geodetic_has_places(columns.geodetic)) {
        (void)columns_need(&columns.in_file, COL_X_M);
        (void)columns_need(&columns.in_file, COL_Y_M);
        columns.has_z = columns.in_file.at[COL_Z_M] >= 0;
    }
    return columns;
}

void trajectory_columns_free(struct trajectory_columns *columns)
{
    geodetic_close(columns->geodetic);
    columns->geodetic = NULL;
}

bool trajectory_row_has_place(const struct trajectory_columns *columns, size_t row)
{
    const struct row_check check = {.columns = &columns->in_file, .row = row};

    return row_has_cell(&check, geodetic_has_places(columns->geodetic) ? COL_LAT_DEG : COL_X_M);
}

static double number_or(const struct columns *columns, size_t row, enum column_id column,
                        double otherwise)
{
    return table_number_or(columns->table, row, columns->at[column], otherwise);
}

static void read_place(const struct trajectory_columns *columns, size_t row,
                       struct trajectory_row *path)
{
    const struct columns *in_file = &columns->in_file;
    char reason[ROW_REASON_BYTES];
    const struct row_check check = {.columns = in_file, .row = row, .reason = reason};
    double place_m[3];
    bool has_alt;

    if (!geodetic_has_places(columns->geodetic)) {
        path->x_m = table_number_at(in_file->table, row, in_file->at[COL_X_M]);
        path->y_m = table_number_at(in_file->table, row, in_file->at[COL_Y_M]);
        path->z_m = number_or(in_file, row, COL_Z_M, 0.0);
        return;
    }
    if (!geodetic_read_place(columns->geodetic, &check, place_m, &has_alt)) {
        table_fail_at_row(in_file->table, row, "%s", reason);
    }
    path->x_m = place_m[0];
    path->y_m = place_m[1];
    path->z_m = place_m[2];
}

/* Exit 2 where there is a reason why the cell is bad. */
static void fail_if_bad_cell(const struct columns *columns, size_t row, enum column_id column,
                             const char *reason)
{
    char buffer[TABLE_TEXT_BYTES];

    if (reason) {
        table_fail_at_row(columns->table, row, "%s: '%s' %s", column_name(column),
                          table_cell_text(columns->table, row, columns->at[column], buffer),
                          reason);
    }
}

static int read_status(const struct columns *columns, size_t row)
{
    const int at = columns->at[COL_STATUS];

    if (at < 0) {
        return RHO_MESSAGE_TRACK_CONFIRMED;
    }
    for (int status = 1; status <= ROWS_STATUS_MAX; status++) {
        if (table_is_word(columns->table, row, at, rows_track_status_name(status))) {
            return status;
        }
    }
    fail_if_bad_cell(columns, row, COL_STATUS,
                     "is none of tentative, confirmed, coasting, deleted");
    return 0;
}

struct trajectory_row trajectory_row_read(const struct trajectory_columns *columns, size_t row)
{
    static const enum column_id covariance[] = {COL_COV_X_X,   COL_COV_Y_X,   COL_COV_Y_Y,
                                                COL_COV_VX_VX, COL_COV_VY_VX, COL_COV_VY_VY};
    const struct columns *in_file = &columns->in_file;
    const enum column_id id = id_column(columns);
    struct trajectory_row path;

    fail_if_bad_cell(in_file, row, COL_T_S,
                     table_read_time_us(in_file->table, row, in_file->at[COL_T_S], &path.time_us));
    fail_if_bad_cell(in_file, row, id,
                     table_read_int32(in_file->table, row, in_file->at[id], &path.id));
    read_place(columns, row, &path);
    path.vx_mps = number_or(in_file, row, COL_VX_MPS, NAN);
    path.vy_mps = number_or(in_file, row, COL_VY_MPS, NAN);
    path.vz_mps = number_or(in_file, row, COL_VZ_MPS, 0.0);
    for (size_t i = 0; i < sizeof covariance / sizeof *covariance; i++) {
        path.covariance[i] = number_or(in_file, row, covariance[i], NAN);
    }
    path.status = read_status(in_file, row);
    return path;
}
