/* SPDX-License-Identifier: MIT */
/*
 * rows_polar_message_codec: rows of polar plots, and polar_scan_t messages. A message has one set
 * of sigmas: plots with other sigmas go into another part.
 */
#include "io/csv/row_cells_read_and_check.h"
#include "io/rows/rows_in_memory.h"

#define DEG_RAD 0.017453292519943295

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

static double radians_from_deg(double value)
{
    return value * DEG_RAD;
}

static const struct rows_column columns[NUM_COLUMNS] = {
    [RANGE_M] = {"range_m", COLUMN_NEEDED | COLUMN_MEASURED | COLUMN_ALWAYS, NO_GROUP, NULL, NULL},
    [AZIMUTH_RAD] = {"azimuth_rad", COLUMN_NEEDED | COLUMN_MEASURED | COLUMN_ALWAYS | COLUMN_ANGLE,
                     NO_GROUP, "azimuth_deg", row_radians_from_compass_deg},
    [ELEVATION_RAD] = {"elevation_rad", COLUMN_MEASURED, NO_GROUP, "elevation_deg",
                       radians_from_deg},
    [RANGE_RATE_MPS] = {"range_rate_mps", COLUMN_MEASURED, NO_GROUP, NULL, NULL},
    [SNR_DB] = {"snr_db", 0, NO_GROUP, NULL, NULL},
    [SENSOR_X_M] = {"sensor_x_m", COLUMN_OF_SCAN | COLUMN_NOT_ZERO, PLACE, NULL, NULL},
    [SENSOR_Y_M] = {"sensor_y_m", COLUMN_OF_SCAN | COLUMN_NOT_ZERO, PLACE, NULL, NULL},
    [SENSOR_Z_M] = {"sensor_z_m", COLUMN_OF_SCAN | COLUMN_NOT_ZERO, PLACE, NULL, NULL},
    [SIGMA_RANGE_M] = {"sigma_range_m", 0, NO_GROUP, NULL, NULL},
    [SIGMA_AZIMUTH_RAD] = {"sigma_azimuth_rad", 0, NO_GROUP, NULL, NULL},
    [SIGMA_ELEVATION_RAD] = {"sigma_elevation_rad", 0, NO_GROUP, NULL, NULL},
    [SIGMA_RANGE_RATE_MPS] = {"sigma_range_rate_mps", 0, NO_GROUP, NULL, NULL},
    [SECTOR_FROM_RAD] = {"sector_from_rad", COLUMN_OF_SCAN, SECTOR, NULL, NULL},
    [SECTOR_TO_RAD] = {"sector_to_rad", COLUMN_OF_SCAN, SECTOR, NULL, NULL},
};

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

static size_t rows_of_same_sigmas_in_one_message(const struct rows_part *rest)
{
    size_t count = rest->count < 1 ? 0 : 1;

    while (count < rest->count && count < RHO_MESSAGE_POLAR_SCAN_MAX_POLAR_PLOTS &&
           has_same_sigmas(rows_part_cells(rest, 0), rows_part_cells(rest, count))) {
        count++;
    }
    return count;
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
        .utime = part->scan->utime,
        .scan = part->scan->head.scan,
        .epoch = part->scan->head.epoch,
        .sensor_id = (int16_t)part->scan->head.sensor_id,
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
    struct rho_message_place place;
    size_t size;

    for (size_t i = 0; i < part->count; i++) {
        message.polar_plots[i] = message_plot_of(part, i);
    }
    if (rho_message_polar_scan_validate(&message, &place) != RHO_OK) {
        *field = rho_message_polar_scan_field(&place);
        return 0;
    }
    return rho_message_polar_scan_encode(&message, buffer, ROWS_MESSAGE_BYTES, &size) == RHO_OK
               ? size
               : 0;
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
    if (!rows_is_plus_zero(message->sector_from_rad) ||
        !rows_is_plus_zero(message->sector_to_rad)) {
        cells[SECTOR_FROM_RAD] = (double)message->sector_from_rad;
        cells[SECTOR_TO_RAD] = (double)message->sector_to_rad;
    }
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
    struct rho_message_place place;
    enum rho_status status = rho_message_polar_scan_decode(data, size, &message);

    if (status != RHO_OK) {
        return status;
    }
    status = rho_message_polar_scan_validate(&message, &place);
    if (status != RHO_OK) {
        *field = rho_message_polar_scan_field(&place);
        return status;
    }
    out->key = (struct row){.time_us = message.utime,
                            .sensor_id = message.sensor_id,
                            .epoch = message.epoch,
                            .scan = message.scan};
    out->part = message.part;
    out->num_parts = message.num_parts;
    put_scan_cells(rows_add_message_row(rows, out, 0), &message);
    out->first = rows->count;
    out->count = (size_t)message.num_polar_plots;
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
    .fit = rows_of_same_sigmas_in_one_message,
    .encode = encode_part,
    .decode = decode_polar_scan_to_rows,
};
