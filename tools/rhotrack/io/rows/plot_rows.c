/* SPDX-License-Identifier: MIT */
/*
 * plot_rows: rows of Cartesian plots, and plot_scan_t messages.
 */
#include "io/rows/rows_in_memory.h"

enum column {
    X_M,
    Y_M,
    Z_M,
    VX_MPS,
    VY_MPS,
    VZ_MPS,
    SIGMA_M,
    SIGMA_MPS,
    SNR_DB,
    SECTOR_FROM_RAD,
    SECTOR_TO_RAD,
    RANGE_RATE_MPS,
    NUM_COLUMNS
};

enum group { NO_GROUP, SECTOR, VELOCITY };

static const struct rows_column columns[NUM_COLUMNS] = {
    [X_M] = {COL_X_M, COLUMN_NEEDED | COLUMN_MEASURED | COLUMN_ALWAYS, NO_GROUP},
    [Y_M] = {COL_Y_M, COLUMN_NEEDED | COLUMN_MEASURED | COLUMN_ALWAYS, NO_GROUP},
    [Z_M] = {COL_Z_M, COLUMN_MEASURED, NO_GROUP},
    [VX_MPS] = {COL_VX_MPS, COLUMN_MEASURED, VELOCITY},
    [VY_MPS] = {COL_VY_MPS, COLUMN_MEASURED, VELOCITY},
    [VZ_MPS] = {COL_VZ_MPS, COLUMN_MEASURED, NO_GROUP},
    [SIGMA_M] = {COL_SIGMA_M, 0, NO_GROUP},
    [SIGMA_MPS] = {COL_SIGMA_MPS, 0, NO_GROUP},
    [SNR_DB] = {COL_SNR_DB, 0, NO_GROUP},
    [SECTOR_FROM_RAD] = {COL_SECTOR_FROM_RAD, COLUMN_OF_SCAN, SECTOR},
    [SECTOR_TO_RAD] = {COL_SECTOR_TO_RAD, COLUMN_OF_SCAN, SECTOR},
    [RANGE_RATE_MPS] = {COL_RANGE_RATE_MPS, COLUMN_NO_ROOM, NO_GROUP},
};

ROWS_CHECKED_CODEC(plot_scan)

/* A plot with a velocity and a height must have a vertical velocity too. */
static const char *why_plot_cells_incomplete(const double *cells)
{
    if (rows_is_cell_empty(cells[X_M]) || rows_is_cell_empty(cells[Y_M])) {
        return rows_is_cell_empty(cells[X_M]) ? "x_m is empty" : "y_m is empty";
    }
    if (rows_is_cell_empty(cells[VX_MPS]) != rows_is_cell_empty(cells[VY_MPS])) {
        return rows_is_cell_empty(cells[VX_MPS]) ? "vx_mps is missing beside vy_mps"
                                                 : "vy_mps is missing beside vx_mps";
    }
    if (rows_is_cell_empty(cells[VX_MPS]) && !rows_is_cell_empty(cells[VZ_MPS])) {
        return "vx_mps and vy_mps are missing beside vz_mps";
    }
    if (!rows_is_cell_empty(cells[VX_MPS]) && rows_is_cell_empty(cells[VZ_MPS]) &&
        !rows_is_cell_empty(cells[Z_M])) {
        return "vz_mps is missing beside z_m and vx_mps";
    }
    return NULL;
}

/* The kind of a plot: with or without height and velocity. */
static int plot_scan_kind(const double *cells)
{
    bool has_height = !rows_is_cell_empty(cells[Z_M]);

    if (rows_is_cell_empty(cells[VX_MPS])) {
        return has_height ? RHO_MESSAGE_PLOT_SCAN_POSITION_3D : RHO_MESSAGE_PLOT_SCAN_POSITION_2D;
    }
    return has_height ? RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_3D
                      : RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_2D;
}

static struct rho_message_plot message_plot_of(const struct rows_part *part, size_t index)
{
    const double *cells = rows_part_cells(part, index);

    return (struct rho_message_plot){
        .dt_us = rows_plot_offset_us(part, index),
        .x_m = rows_float_or_zero(cells[X_M]),
        .y_m = rows_float_or_zero(cells[Y_M]),
        .z_m = rows_float_or_zero(cells[Z_M]),
        .vx_mps = rows_float_or_zero(cells[VX_MPS]),
        .vy_mps = rows_float_or_zero(cells[VY_MPS]),
        .vz_mps = rows_float_or_zero(cells[VZ_MPS]),
        .sigma_m = rows_float_or_zero(cells[SIGMA_M]),
        .sigma_mps = rows_float_or_zero(cells[SIGMA_MPS]),
        .snr_db = rows_float_or_zero(cells[SNR_DB]),
    };
}

static size_t encode_plot_scan_part(const struct rows_part *part, uint8_t *buffer,
                                    const char **field)
{
    const double *head = rows_scan_first_row_cells(part);
    struct rho_message_plot_scan message = {
        ROWS_SENSOR_FIELDS(part),
        .kind = (int8_t)plot_scan_kind(part->count ? rows_part_cells(part, 0) : head),
        .part = part->part,
        .num_parts = part->scan->num_parts,
        .sector_from_rad = rows_float_or_zero(head[SECTOR_FROM_RAD]),
        .sector_to_rad = rows_float_or_zero(head[SECTOR_TO_RAD]),
        .num_plots = (int16_t)part->count,
    };

    for (size_t i = 0; i < part->count; i++) {
        message.plots[i] = message_plot_of(part, i);
    }
    return encode_checked_plot_scan(&message, buffer, field);
}

static void put_plot_cells(double *cells, const struct rho_message_plot *plot, int kind)
{
    cells[X_M] = (double)plot->x_m;
    cells[Y_M] = (double)plot->y_m;
    if (kind == RHO_MESSAGE_PLOT_SCAN_POSITION_3D ||
        kind == RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_3D) {
        cells[Z_M] = (double)plot->z_m;
    }
    if (kind == RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_2D ||
        kind == RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_3D) {
        cells[VX_MPS] = (double)plot->vx_mps;
        cells[VY_MPS] = (double)plot->vy_mps;
        cells[VZ_MPS] = kind == RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_3D
                            ? (double)plot->vz_mps
                            : rows_zero_to_empty_cell(plot->vz_mps);
    }
    cells[SIGMA_M] = rows_zero_to_empty_cell(plot->sigma_m);
    cells[SIGMA_MPS] = rows_zero_to_empty_cell(plot->sigma_mps);
    cells[SNR_DB] = rows_zero_to_empty_cell(plot->snr_db);
}

static enum rho_status decode_plot_scan_to_rows(const uint8_t *data, size_t size, struct rows *rows,
                                                struct rows_message *out, const char **field)
{
    struct rho_message_plot_scan message;
    double *cells;
    const enum rho_status status = decode_checked_plot_scan(data, size, &message, field);

    if (status != RHO_OK) {
        return status;
    }
    const struct row key = ROWS_SENSOR_KEY(message);

    cells = rows_begin_message(rows, out, &key, message.part, message.num_parts, message.num_plots);
    rows_put_sector(&cells[SECTOR_FROM_RAD], message.sector_from_rad, message.sector_to_rad);
    for (int i = 0; i < message.num_plots; i++) {
        cells = rows_add_message_row(rows, out, message.plots[i].dt_us);
        rows_put_sector(&cells[SECTOR_FROM_RAD], message.sector_from_rad, message.sector_to_rad);
        put_plot_cells(cells, &message.plots[i], message.kind);
    }
    return RHO_OK;
}

const struct rows_kind rows_kind_plots = {
    .name = "plots",
    .channel = RHO_MESSAGE_PLOT_SCAN_CHANNEL,
    .type = RHO_MESSAGE_TYPE_PLOT_SCAN,
    .has_sensor = true,
    .has_epoch = true,
    .has_received = true,
    .columns = columns,
    .num_columns = NUM_COLUMNS,
    .why_not = why_plot_cells_incomplete,
    .pattern = plot_scan_kind,
    .part_max = RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS,
    .encode = encode_plot_scan_part,
    .decode = decode_plot_scan_to_rows,
};
