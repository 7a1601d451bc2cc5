/* SPDX-License-Identifier: MIT */
/*
 * rows_bearings_message_codec: rows of bearings, and bearing_scan_t messages: one time, one sigma
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
    [SENSOR_X_M] = {"sensor_x_m", IN_FILE | COLUMN_FILLED | COLUMN_OF_SCAN, 0, NULL, NULL},
    [SENSOR_Y_M] = {"sensor_y_m", IN_FILE | COLUMN_FILLED | COLUMN_OF_SCAN, 0, NULL, NULL},
    [BEARING_RAD] = {"bearing_rad", IN_FILE | COLUMN_MEASURED | COLUMN_ANGLE, 0, NULL, NULL},
    [SIGMA_RAD] = {"sigma_rad", COLUMN_OF_PLOTS, 0, NULL, NULL},
    [SECTOR_FROM_RAD] = {"sector_from_rad", COLUMN_NO_ROOM, 0, NULL, NULL},
    [SECTOR_TO_RAD] = {"sector_to_rad", COLUMN_NO_ROOM, 0, NULL, NULL},
    [SNR_DB] = {"snr_db", COLUMN_NO_ROOM, 0, NULL, NULL},
};

static size_t rows_in_one_message(const struct rows_part *rest)
{
    return rest->count;
}

static size_t encode_bearing_scan_part(const struct rows_part *part, uint8_t *buffer,
                                       const char **field)
{
    const double *head = rows_scan_first_row_cells(part);
    const double *first = part->count ? rows_part_cells(part, 0) : head;
    struct rho_message_place place;
    size_t size;
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
    if (rho_message_bearing_scan_validate(&message, &place) != RHO_OK) {
        *field = rho_message_bearing_scan_field(&place);
        return 0;
    }
    return rho_message_bearing_scan_encode(&message, buffer, ROWS_MESSAGE_BYTES, &size) == RHO_OK
               ? size
               : 0;
}

static double *put_sensor_place_and_sigma_cells(double *cells,
                                                const struct rho_message_bearing_scan *message)
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
    struct rho_message_place place;
    enum rho_status status = rho_message_bearing_scan_decode(data, size, &message);

    if (status != RHO_OK) {
        return status;
    }
    status = rho_message_bearing_scan_validate(&message, &place);
    if (status != RHO_OK) {
        *field = rho_message_bearing_scan_field(&place);
        return status;
    }
    out->key = (struct row){.time_us = message.utime,
                            .sensor_id = message.sensor_id,
                            .epoch = message.epoch,
                            .scan = message.scan};
    out->part = 0;
    out->num_parts = 1;
    put_sensor_place_and_sigma_cells(rows_add_message_row(rows, out, 0), &message);
    out->first = rows->count;
    out->count = (size_t)message.num_bearings;
    for (int i = 0; i < message.num_bearings; i++) {
        put_sensor_place_and_sigma_cells(rows_add_message_row(rows, out, 0),
                                         &message)[BEARING_RAD] = (double)message.bearing_rad[i];
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
    .fit = rows_in_one_message,
    .encode = encode_bearing_scan_part,
    .decode = decode_bearing_scan_to_rows,
};
