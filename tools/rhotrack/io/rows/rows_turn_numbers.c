/* SPDX-License-Identifier: MIT */
#include "io/rows/rows_turn_numbers.h"

#include <math.h>

#include "io/turns/antenna_turns.h"

/* Position of a row's plot relative to its sensor. Returns false for a row without a plot. */
static bool plot_place_relative_to_sensor(const struct rows_file *file, const struct row *row,
                                          const struct parameters *parameters, double place_m[2])
{
    const struct rows_kind *kind = file->rows.kind;
    const double *cells = rows_cells(&file->rows, row);

    if (!rows_row_has_measurement(&file->rows, row)) {
        return false;
    }
    if (kind == &rows_kind_polar) {
        const double range_m = cells[rows_column_index(kind, COL_RANGE_M)];
        const double azimuth_rad = cells[rows_column_index(kind, COL_AZIMUTH_RAD)];

        place_m[0] = range_m * cos(azimuth_rad);
        place_m[1] = range_m * sin(azimuth_rad);
    } else {
        struct rho_sensor sensor;

        parameters_sensor_or_default(parameters, row->sensor_id, &sensor);
        place_m[0] = cells[rows_column_index(kind, COL_X_M)] - (double)sensor.x_m;
        place_m[1] = cells[rows_column_index(kind, COL_Y_M)] - (double)sensor.y_m;
    }
    return true;
}

static bool may_have_turns(const struct rows_file *file, const struct parameters *parameters)
{
    const struct rows_kind *kind = file->rows.kind;

    return (kind == &rows_kind_plots || kind == &rows_kind_polar) && !file->has_scan &&
           !file->has_frames && !file->rows.has_received && file->rows.count > 0 &&
           antenna_turns_are_wanted(parameters) &&
           rows_is_cell_empty(rows_cells(
               &file->rows, file->rows.list)[rows_column_index(kind, COL_SECTOR_FROM_RAD)]);
}

void rows_number_turns(struct rows_file *file, const struct parameters *parameters)
{
    struct antenna_turns *turns;
    double place_m[2];
    bool goes_on = true;

    if (!may_have_turns(file, parameters)) {
        return;
    }
    turns = antenna_turns_start();
    for (size_t i = 0; i < file->rows.count && goes_on; i++) {
        const struct row *row = &file->rows.list[i];

        if (plot_place_relative_to_sensor(file, row, parameters, place_m)) {
            goes_on =
                antenna_turns_add_row(turns, row->sensor_id, row->time_us, place_m[0], place_m[1]);
        } else {
            antenna_turns_add_empty_row(turns, row->sensor_id);
        }
    }
    if (antenna_turns_find_rules(turns, file->path, parameters->value[PARAMETER_V_MAX_MPS])) {
        for (size_t i = 0; i < file->rows.count; i++) {
            struct row *row = &file->rows.list[i];
            const bool has_place = plot_place_relative_to_sensor(file, row, parameters, place_m);

            row->turn = antenna_turns_number_row(turns, row->sensor_id, row->time_us,
                                                 has_place ? place_m : NULL);
        }
    }
    antenna_turns_free(turns);
}
