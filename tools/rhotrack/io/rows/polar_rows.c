/* SPDX-License-Identifier: MIT */
/*
 * polar_rows: rows of polar plots, and polar_scan_t messages. A message has one set
 * of sigmas: plots with other sigmas go into another part.
 */
#include "io/rows/rows_in_memory.h"

enum column {
    RANGE_M,
    AZIMUTH_RAD,
    ELEVATION_RAD,
    RANGE_RATE_MPS,
    SNR_DB,
    SENSOR_X_M,
    SENSOR_Y_M,
    SENSOR_Z_M,
    SIGMA_RANGE_M,
    SIGMA_AZIMUTH_RAD,
    SIGMA_ELEVATION_RAD,
    SIGMA_RANGE_RATE_MPS,
    SECTOR_FROM_RAD,
    SECTOR_TO_RAD,
    NUM_COLUMNS
};

enum group { NO_GROUP, SECTOR, PLACE };

static const struct rows_column columns[NUM_COLUMNS] = {
    [RANGE_M] = {COL_RANGE_M, COLUMN_NEEDED | COLUMN_MEASURED | COLUMN_ALWAYS, NO_GROUP},
    [AZIMUTH_RAD] = {COL_AZIMUTH_RAD,
                     COLUMN_NEEDED | COLUMN_MEASURED | COLUMN_ALWAYS | COLUMN_ANGLE, NO_GROUP},
    [ELEVATION_RAD] = {COL_ELEVATION_RAD, COLUMN_MEASURED, NO_GROUP},
    [RANGE_RATE_MPS] = {COL_RANGE_RATE_MPS, COLUMN_MEASURED, NO_GROUP},
    [SNR_DB] = {COL_SNR_DB, 0, NO_GROUP},
    [SENSOR_X_M] = {COL_SENSOR_X_M, COLUMN_OF_SCAN | COLUMN_NOT_ZERO, PLACE},
    [SENSOR_Y_M] = {COL_SENSOR_Y_M, COLUMN_OF_SCAN | COLUMN_NOT_ZERO, PLACE},
    [SENSOR_Z_M] = {COL_SENSOR_Z_M, COLUMN_OF_SCAN | COLUMN_NOT_ZERO, PLACE},
    [SIGMA_RANGE_M] = {COL_SIGMA_RANGE_M, 0, NO_GROUP},
    [SIGMA_AZIMUTH_RAD] = {COL_SIGMA_AZIMUTH_RAD, 0, NO_GROUP},
    [SIGMA_ELEVATION_RAD] = {COL_SIGMA_ELEVATION_RAD, 0, NO_GROUP},
    [SIGMA_RANGE_RATE_MPS] = {COL_SIGMA_RANGE_RATE_MPS, 0, NO_GROUP},
    [SECTOR_FROM_RAD] = {COL_SECTOR_FROM_RAD, COLUMN_OF_SCAN, SECTOR},
    [SECTOR_TO_RAD] = {COL_SECTOR_TO_RAD, COLUMN_OF_SCAN, SECTOR},
};

ROWS_CHECKED_CODEC(polar_scan)

static const char *why_range_or_azimuth_missing(const double *cells)
{
    if (rows_is_cell_empty(cells[RANGE_M])) {
        return "range_m is empty";
    }
    return rows_is_cell_empty(cells[AZIMUTH_RAD]) ? "the azimuth is empty" : NULL;
}

static int measured_quantities(const double *cells)
{
    return !rows_is_cell_empty(cells[ELEVATION_RAD]) +
           2 * !rows_is_cell_empty(cells[RANGE_RATE_MPS]);
}

static bool has_same_sigmas(const double *cells, const double *others)
{
    for (int i = SIGMA_RANGE_M; i <= SIGMA_RANGE_RATE_MPS; i++) {
        if (rows_float_or_zero(cells[i]) != rows_float_or_zero(others[i])) {
            return false;
        }
    }
    return true;
}

static struct rho_message_polar_plot message_plot_of(const struct rows_part *part, size_t index)
{
    const double *cells = rows_part_cells(part, index);

    return (struct rho_message_polar_plot){
        .dt_us = rows_plot_offset_us(part, index),
        .range_m = rows_float_or_zero(cells[RANGE_M]),
        .azimuth_rad = rows_float_or_zero(cells[AZIMUTH_RAD]),
        .elevation_rad = rows_float_or_zero(cells[ELEVATION_RAD]),
        .range_rate_mps = rows_float_or_zero(cells[RANGE_RATE_MPS]),
        .snr_db = rows_float_or_zero(cells[SNR_DB]),
    };
}

static struct rho_message_polar_scan message_scan_of(const struct rows_part *part)
{
    const double *head = rows_scan_first_row_cells(part);
    const double *first = part->count ? rows_part_cells(part, 0) : head;

    return (struct rho_message_polar_scan){
        ROWS_SENSOR_FIELDS(part),
        .has_elevation = !rows_is_cell_empty(first[ELEVATION_RAD]),
        .has_range_rate = !rows_is_cell_empty(first[RANGE_RATE_MPS]),
        .part = part->part,
        .num_parts = part->scan->num_parts,
        .sensor_x_m = rows_float_or_zero(head[SENSOR_X_M]),
        .sensor_y_m = rows_float_or_zero(head[SENSOR_Y_M]),
        .sensor_z_m = rows_float_or_zero(head[SENSOR_Z_M]),
        .sigma_range_m = rows_float_or_zero(first[SIGMA_RANGE_M]),
        .sigma_azimuth_rad = rows_float_or_zero(first[SIGMA_AZIMUTH_RAD]),
        .sigma_elevation_rad = rows_float_or_zero(first[SIGMA_ELEVATION_RAD]),
        .sigma_range_rate_mps = rows_float_or_zero(first[SIGMA_RANGE_RATE_MPS]),
        .sector_from_rad = rows_float_or_zero(head[SECTOR_FROM_RAD]),
        .sector_to_rad = rows_float_or_zero(head[SECTOR_TO_RAD]),
        .num_polar_plots = (int16_t)part->count,
    };
}

static size_t encode_part(const struct rows_part *part, uint8_t *buffer, const char **field)
{
    struct rho_message_polar_scan message = message_scan_of(part);

    for (size_t i = 0; i < part->count; i++) {
        message.polar_plots[i] = message_plot_of(part, i);
    }
    return encode_checked_polar_scan(&message, buffer, field);
}

/*
 * Fills the cells that all rows of the message share. A position is always written, even 0: an
 * empty one would mean the position in the parameters.
 */
static void put_scan_cells(double *cells, const struct rho_message_polar_scan *message)
{
    cells[SENSOR_X_M] = (double)message->sensor_x_m;
    cells[SENSOR_Y_M] = (double)message->sensor_y_m;
    cells[SENSOR_Z_M] = (double)message->sensor_z_m;
    cells[SIGMA_RANGE_M] = rows_zero_to_empty_cell(message->sigma_range_m);
    cells[SIGMA_AZIMUTH_RAD] = rows_zero_to_empty_cell(message->sigma_azimuth_rad);
    cells[SIGMA_ELEVATION_RAD] = rows_zero_to_empty_cell(message->sigma_elevation_rad);
    cells[SIGMA_RANGE_RATE_MPS] = rows_zero_to_empty_cell(message->sigma_range_rate_mps);
    rows_put_sector(&cells[SECTOR_FROM_RAD], message->sector_from_rad, message->sector_to_rad);
}

static void put_plot_cells(double *cells, const struct rho_message_polar_scan *message, int index)
{
    const struct rho_message_polar_plot *plot = &message->polar_plots[index];

    cells[RANGE_M] = (double)plot->range_m;
    cells[AZIMUTH_RAD] = (double)plot->azimuth_rad;
    if (message->has_elevation) {
        cells[ELEVATION_RAD] = (double)plot->elevation_rad;
    }
    if (message->has_range_rate) {
        cells[RANGE_RATE_MPS] = (double)plot->range_rate_mps;
    }
    cells[SNR_DB] = rows_zero_to_empty_cell(plot->snr_db);
}

static enum rho_status decode_polar_scan_to_rows(const uint8_t *data, size_t size,
                                                 struct rows *rows, struct rows_message *out,
                                                 const char **field)
{
    struct rho_message_polar_scan message;
    const enum rho_status status = decode_checked_polar_scan(data, size, &message, field);

    if (status != RHO_OK) {
        return status;
    }
    const struct row key = ROWS_SENSOR_KEY(message);

    put_scan_cells(rows_begin_message(rows, out, &key, message.part, message.num_parts,
                                      message.num_polar_plots),
                   &message);
    for (int i = 0; i < message.num_polar_plots; i++) {
        double *cells = rows_add_message_row(rows, out, message.polar_plots[i].dt_us);

        put_scan_cells(cells, &message);
        put_plot_cells(cells, &message, i);
    }
    return RHO_OK;
}

const struct rows_kind rows_kind_polar = {
    .name = "polar",
    .channel = RHO_MESSAGE_POLAR_SCAN_CHANNEL,
    .type = RHO_MESSAGE_TYPE_POLAR_SCAN,
    .has_sensor = true,
    .has_epoch = true,
    .has_received = true,
    .columns = columns,
    .num_columns = NUM_COLUMNS,
    .why_not = why_range_or_azimuth_missing,
    .pattern = measured_quantities,
    .part_max = RHO_MESSAGE_POLAR_SCAN_MAX_POLAR_PLOTS,
    .fit = has_same_sigmas,
    .encode = encode_part,
    .decode = decode_polar_scan_to_rows,
};
