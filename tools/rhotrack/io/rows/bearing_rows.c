/* SPDX-License-Identifier: MIT */
/*
 * bearing_rows: rows of bearings, and their messages, one for each scan: bearing_scan_t, with one
 * time, of a sensor that stays where it is; direction_scan_t for files that say more.
 */
#include "io/rows/rows_in_memory.h"

enum column {
    SENSOR_X_M,
    SENSOR_Y_M,
    SENSOR_Z_M,
    BEARING_RAD,
    ELEVATION_RAD,
    SIGMA_RAD,
    SIGMA_ELEVATION_RAD,
    SECTOR_FROM_RAD,
    SECTOR_TO_RAD,
    SNR_DB,
    NUM_COLUMNS
};

enum { IN_FILE = COLUMN_NEEDED | COLUMN_ALWAYS };

enum group { NO_GROUP, SECTOR };

static const struct rows_column columns[NUM_COLUMNS] = {
    [SENSOR_X_M] = {COL_SENSOR_X_M, IN_FILE | COLUMN_OF_SCAN | COLUMN_STAYS, NO_GROUP},
    [SENSOR_Y_M] = {COL_SENSOR_Y_M, IN_FILE | COLUMN_OF_SCAN | COLUMN_STAYS, NO_GROUP},
    [SENSOR_Z_M] = {COL_SENSOR_Z_M, COLUMN_OF_SCAN | COLUMN_NOT_ZERO | COLUMN_WIDER, NO_GROUP},
    [BEARING_RAD] = {COL_BEARING_RAD, IN_FILE | COLUMN_MEASURED | COLUMN_ANGLE, NO_GROUP},
    [ELEVATION_RAD] = {COL_ELEVATION_RAD, COLUMN_MEASURED | COLUMN_WIDER, NO_GROUP},
    [SIGMA_RAD] = {COL_SIGMA_RAD, COLUMN_OF_PLOTS, NO_GROUP},
    [SIGMA_ELEVATION_RAD] = {COL_SIGMA_ELEVATION_RAD, COLUMN_OF_PLOTS, NO_GROUP},
    [SECTOR_FROM_RAD] = {COL_SECTOR_FROM_RAD, COLUMN_OF_SCAN | COLUMN_NOT_ZERO | COLUMN_WIDER,
                         SECTOR},
    [SECTOR_TO_RAD] = {COL_SECTOR_TO_RAD, COLUMN_OF_SCAN | COLUMN_NOT_ZERO | COLUMN_WIDER, SECTOR},
    [SNR_DB] = {COL_SNR_DB, COLUMN_NOT_ZERO | COLUMN_WIDER, NO_GROUP},
};

static const char *why_bearing_missing(const double *cells)
{
    return rows_is_cell_empty(cells[BEARING_RAD]) ? "the bearing is empty" : NULL;
}

ROWS_CHECKED_CODEC(bearing_scan)
ROWS_CHECKED_CODEC(direction_scan)

static size_t encode_bearing_scan_part(const struct rows_part *part, uint8_t *buffer,
                                       const char **field)
{
    const double *head = rows_scan_first_row_cells(part);
    const double *first = part->count ? rows_part_cells(part, 0) : head;
    struct rho_message_bearing_scan message = {
        ROWS_SENSOR_FIELDS(part),
        .sensor_x_m = rows_float_or_zero(head[SENSOR_X_M]),
        .sensor_y_m = rows_float_or_zero(head[SENSOR_Y_M]),
        .sigma_rad = rows_float_or_zero(first[SIGMA_RAD]),
        .num_bearings = (int16_t)part->count,
    };

    for (size_t i = 0; i < part->count; i++) {
        message.bearing_rad[i] = rows_float_or_zero(rows_part_cells(part, i)[BEARING_RAD]);
    }
    return encode_checked_bearing_scan(&message, buffer, field);
}

/* Fills the cells that all rows of the message share; returns them. */
static double *put_bearing_scan_cells(double *cells, const struct rho_message_bearing_scan *message)
{
    cells[SENSOR_X_M] = (double)message->sensor_x_m;
    cells[SENSOR_Y_M] = (double)message->sensor_y_m;
    cells[SIGMA_RAD] = rows_zero_to_empty_cell(message->sigma_rad);
    return cells;
}

static enum rho_status decode_bearing_scan_to_rows(const uint8_t *data, size_t size,
                                                   struct rows *rows, struct rows_message *out,
                                                   const char **field)
{
    struct rho_message_bearing_scan message;
    const enum rho_status status = decode_checked_bearing_scan(data, size, &message, field);

    if (status != RHO_OK) {
        return status;
    }
    const struct row key = ROWS_SENSOR_KEY(message);

    put_bearing_scan_cells(rows_begin_message(rows, out, &key, 0, 1, message.num_bearings),
                           &message);
    for (int i = 0; i < message.num_bearings; i++) {
        put_bearing_scan_cells(rows_add_message_row(rows, out, 0), &message)[BEARING_RAD] =
            (double)message.bearing_rad[i];
    }
    return RHO_OK;
}

static size_t encode_direction_scan_part(const struct rows_part *part, uint8_t *buffer,
                                         const char **field)
{
    const double *head = rows_scan_first_row_cells(part);
    const double *first = part->count ? rows_part_cells(part, 0) : head;
    struct rho_message_direction_scan message = {
        ROWS_SENSOR_FIELDS(part),
        .sensor_x_m = rows_float_or_zero(head[SENSOR_X_M]),
        .sensor_y_m = rows_float_or_zero(head[SENSOR_Y_M]),
        .sensor_z_m = rows_float_or_zero(head[SENSOR_Z_M]),
        .sigma_rad = rows_float_or_zero(first[SIGMA_RAD]),
        .sigma_elevation_rad = rows_float_or_zero(first[SIGMA_ELEVATION_RAD]),
        .sector_from_rad = rows_float_or_zero(head[SECTOR_FROM_RAD]),
        .sector_to_rad = rows_float_or_zero(head[SECTOR_TO_RAD]),
        .num_directions = (int16_t)part->count,
    };

    for (size_t i = 0; i < part->count; i++) {
        const double *cells = rows_part_cells(part, i);

        message.directions[i] = (struct rho_message_direction){
            .dt_us = rows_plot_offset_us(part, i),
            .bearing_rad = rows_float_or_zero(cells[BEARING_RAD]),
            .elevation_rad = rows_float_or_zero(cells[ELEVATION_RAD]),
            .snr_db = rows_float_or_zero(cells[SNR_DB]),
            .has_elevation = !rows_is_cell_empty(cells[ELEVATION_RAD]),
        };
    }
    return encode_checked_direction_scan(&message, buffer, field);
}

/* Fills the cells that all rows of the message share; returns them. */
static double *put_direction_scan_cells(double *cells,
                                        const struct rho_message_direction_scan *message)
{
    cells[SENSOR_X_M] = (double)message->sensor_x_m;
    cells[SENSOR_Y_M] = (double)message->sensor_y_m;
    cells[SENSOR_Z_M] = (double)message->sensor_z_m;
    cells[SIGMA_RAD] = rows_zero_to_empty_cell(message->sigma_rad);
    cells[SIGMA_ELEVATION_RAD] = rows_zero_to_empty_cell(message->sigma_elevation_rad);
    rows_put_sector(&cells[SECTOR_FROM_RAD], message->sector_from_rad, message->sector_to_rad);
    return cells;
}

static enum rho_status decode_direction_scan_to_rows(const uint8_t *data, size_t size,
                                                     struct rows *rows, struct rows_message *out,
                                                     const char **field)
{
    struct rho_message_direction_scan message;
    const enum rho_status status = decode_checked_direction_scan(data, size, &message, field);

    if (status != RHO_OK) {
        return status;
    }
    const struct row key = ROWS_SENSOR_KEY(message);

    put_direction_scan_cells(rows_begin_message(rows, out, &key, 0, 1, message.num_directions),
                             &message);
    for (int i = 0; i < message.num_directions; i++) {
        const struct rho_message_direction *direction = &message.directions[i];
        double *cells =
            put_direction_scan_cells(rows_add_message_row(rows, out, direction->dt_us), &message);

        cells[BEARING_RAD] = (double)direction->bearing_rad;
        if (direction->has_elevation) {
            cells[ELEVATION_RAD] = (double)direction->elevation_rad;
        }
        cells[SNR_DB] = rows_zero_to_empty_cell(direction->snr_db);
    }
    return RHO_OK;
}

static const struct rows_kind directions = {
    .name = "bearings",
    .channel = RHO_MESSAGE_DIRECTION_SCAN_CHANNEL,
    .type = RHO_MESSAGE_TYPE_DIRECTION_SCAN,
    .has_sensor = true,
    .has_epoch = true,
    .rows_max = RHO_MESSAGE_DIRECTION_SCAN_MAX_DIRECTIONS,
    .columns = columns,
    .num_columns = NUM_COLUMNS,
    .why_not = why_bearing_missing,
    .part_max = RHO_MESSAGE_DIRECTION_SCAN_MAX_DIRECTIONS,
    .encode = encode_direction_scan_part,
    .decode = decode_direction_scan_to_rows,
};

const struct rows_kind rows_kind_bearings = {
    .name = "bearings",
    .channel = RHO_MESSAGE_BEARING_SCAN_CHANNEL,
    .type = RHO_MESSAGE_TYPE_BEARING_SCAN,
    .has_sensor = true,
    .has_epoch = true,
    .has_one_time = true,
    .rows_max = RHO_MESSAGE_BEARING_SCAN_MAX_BEARING_RAD,
    .columns = columns,
    .num_columns = NUM_COLUMNS,
    .why_not = why_bearing_missing,
    .part_max = RHO_MESSAGE_BEARING_SCAN_MAX_BEARING_RAD,
    .encode = encode_bearing_scan_part,
    .decode = decode_bearing_scan_to_rows,
    .wider = &directions,
};
