/* SPDX-License-Identifier: MIT */
/*
 * bearing_rows: rows of bearings, and bearing_scan_t messages: one time, one sigma
 * and one message for each scan.
 */
#include "io/rows/rows_in_memory.h"

enum column {
    SENSOR_X_M,
    SENSOR_Y_M,
    BEARING_RAD,
    SIGMA_RAD,
    SECTOR_FROM_RAD,
    SECTOR_TO_RAD,
    SNR_DB,
    NUM_COLUMNS
};

enum { IN_FILE = COLUMN_NEEDED | COLUMN_ALWAYS };

static const struct rows_column columns[NUM_COLUMNS] = {
    [SENSOR_X_M] = {COL_SENSOR_X_M, IN_FILE | COLUMN_FILLED | COLUMN_OF_SCAN, 0},
    [SENSOR_Y_M] = {COL_SENSOR_Y_M, IN_FILE | COLUMN_FILLED | COLUMN_OF_SCAN, 0},
    [BEARING_RAD] = {COL_BEARING_RAD, IN_FILE | COLUMN_MEASURED | COLUMN_ANGLE, 0},
    [SIGMA_RAD] = {COL_SIGMA_RAD, COLUMN_OF_PLOTS, 0},
    [SECTOR_FROM_RAD] = {COL_SECTOR_FROM_RAD, COLUMN_NO_ROOM, 0},
    [SECTOR_TO_RAD] = {COL_SECTOR_TO_RAD, COLUMN_NO_ROOM, 0},
    [SNR_DB] = {COL_SNR_DB, COLUMN_NO_ROOM, 0},
};

ROWS_CHECKED_CODEC(bearing_scan)

static size_t encode_bearing_scan_part(const struct rows_part *part, uint8_t *buffer,
                                       const char **field)
{
    const double *head = rows_scan_first_row_cells(part);
    const double *first = part->count ? rows_part_cells(part, 0) : head;
    struct rho_message_bearing_scan message = {
        .utime = part->scan->utime,
        .scan = part->scan->head.scan,
        .epoch = part->scan->head.epoch,
        .sensor_id = (int16_t)part->scan->head.sensor_id,
        .sensor_x_m = rows_float_or_zero(head[SENSOR_X_M]),
        .sensor_y_m = rows_float_or_zero(head[SENSOR_Y_M]),
        .sigma_rad = rows_float_or_zero(first[SIGMA_RAD]),
        .num_bearings = (int16_t)part->count,
    };

    for (size_t i = 0; i < part->count; i++) {
        message.bearing_rad[i] = rows_float_or_zero(rows_part_cells(part, i)[BEARING_RAD]);
    }
    return encode_checked(&message, buffer, field);
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
    const enum rho_status status = decode_checked(data, size, &message, field);

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
    .part_max = RHO_MESSAGE_BEARING_SCAN_MAX_BEARING_RAD,
    .encode = encode_bearing_scan_part,
    .decode = decode_bearing_scan_to_rows,
};
