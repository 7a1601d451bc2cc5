/* SPDX-License-Identifier: MIT */
/*
 * track_rows: rows of tracks, and track_list_t messages. Messages have the
 * covariance, files sigma_m and sigma_mps, and the covariance where requested: a file without it
 * gives a covariance that is equal on all measured axes, with these sigmas.
 */
#include <math.h>

#include "io/rows/rows_in_memory.h"

enum { AXES = 3, STATES = 6, COVARIANCES = 21 };

enum column {
    TRACK_ID,
    STATUS,
    STATE, /* x_m .. vz_mps */
    ACCELERATION = STATE + STATES,
    SIGMA_M = ACCELERATION + AXES,
    SIGMA_MPS,
    HITS,
    MISSES,
    SENSOR_ID,
    PLOT,
    COVARIANCE,
    UPDATE_AGE_US = COVARIANCE + COVARIANCES,
    SCORE_NAT,
    MANEUVER_PROBABILITY,
    NUM_COLUMNS
};

enum {
    IN_FILE = COLUMN_NEEDED | COLUMN_FILLED | COLUMN_ALWAYS,
    INT16 = COLUMN_ALWAYS | COLUMN_INT16
};

#define COVARIANCE_COLUMN(index, name)                                                             \
    [COVARIANCE + (index)] = {COL_COV_##name, COLUMN_COVARIANCE, 0}

static const struct rows_column columns[NUM_COLUMNS] = {
    [TRACK_ID] = {COL_TRACK_ID, IN_FILE | COLUMN_MEASURED | COLUMN_INT32, 0},
    [STATUS] = {COL_STATUS, IN_FILE | COLUMN_STATUS, 0},
    [STATE] = {COL_X_M, IN_FILE, 0},
    [STATE + 1] = {COL_Y_M, IN_FILE, 0},
    [STATE + 2] = {COL_Z_M, COLUMN_ALWAYS, 0},
    [STATE + 3] = {COL_VX_MPS, COLUMN_ALWAYS, 0},
    [STATE + 4] = {COL_VY_MPS, COLUMN_ALWAYS, 0},
    [STATE + 5] = {COL_VZ_MPS, COLUMN_ALWAYS, 0},
    [ACCELERATION] = {COL_AX_MPS2, COLUMN_ALWAYS, 0},
    [ACCELERATION + 1] = {COL_AY_MPS2, COLUMN_ALWAYS, 0},
    [ACCELERATION + 2] = {COL_AZ_MPS2, COLUMN_ALWAYS, 0},
    [SIGMA_M] = {COL_SIGMA_M, COLUMN_ALWAYS, 0},
    [SIGMA_MPS] = {COL_SIGMA_MPS, COLUMN_ALWAYS, 0},
    [HITS] = {COL_HITS, INT16, 0},
    [MISSES] = {COL_MISSES, INT16, 0},
    [SENSOR_ID] = {COL_SENSOR_ID, INT16, 0},
    [PLOT] = {COL_PLOT, INT16, 0},
    COVARIANCE_COLUMN(0, X_X),
    COVARIANCE_COLUMN(1, Y_X),
    COVARIANCE_COLUMN(2, Y_Y),
    COVARIANCE_COLUMN(3, Z_X),
    COVARIANCE_COLUMN(4, Z_Y),
    COVARIANCE_COLUMN(5, Z_Z),
    COVARIANCE_COLUMN(6, VX_X),
    COVARIANCE_COLUMN(7, VX_Y),
    COVARIANCE_COLUMN(8, VX_Z),
    COVARIANCE_COLUMN(9, VX_VX),
    COVARIANCE_COLUMN(10, VY_X),
    COVARIANCE_COLUMN(11, VY_Y),
    COVARIANCE_COLUMN(12, VY_Z),
    COVARIANCE_COLUMN(13, VY_VX),
    COVARIANCE_COLUMN(14, VY_VY),
    COVARIANCE_COLUMN(15, VZ_X),
    COVARIANCE_COLUMN(16, VZ_Y),
    COVARIANCE_COLUMN(17, VZ_Z),
    COVARIANCE_COLUMN(18, VZ_VX),
    COVARIANCE_COLUMN(19, VZ_VY),
    COVARIANCE_COLUMN(20, VZ_VZ),
    [UPDATE_AGE_US] = {COL_UPDATE_AGE_US, COLUMN_INT32 | COLUMN_NOT_ZERO, 0},
    [SCORE_NAT] = {COL_SCORE_NAT, COLUMN_NOT_ZERO, 0},
    [MANEUVER_PROBABILITY] = {COL_MANEUVER_PROBABILITY, COLUMN_NOT_ZERO, 0},
};

ROWS_CHECKED_CODEC(track_list)

/* Index of a variance in the covariance, which is stored as its lower triangle. */
static int variance_index(int state)
{
    return state * (state + 1) / 2 + state;
}

/* limits of a sigma whose square float32 can hold */
#define SIGMA_MIN 1e-18
#define SIGMA_MAX 1e18

static bool is_sigma_encodable(double cell)
{
    return !(cell < 0.0) && !(cell > 0.0 && cell < SIGMA_MIN) && !(cell > SIGMA_MAX);
}

static const char *why_track_sigmas_invalid(const double *cells)
{
    if (!is_sigma_encodable(cells[SIGMA_M]) || !is_sigma_encodable(cells[SIGMA_MPS])) {
        return is_sigma_encodable(cells[SIGMA_M])
                   ? "sigma_mps is neither 0 nor within 1e-18 .. 1e18"
                   : "sigma_m is neither 0 nor within 1e-18 .. 1e18";
    }
    return NULL;
}

static bool has_covariance(const double *cells)
{
    for (int i = 0; i < COVARIANCES; i++) {
        if (!rows_is_cell_empty(cells[COVARIANCE + i])) {
            return true;
        }
    }
    return false;
}

/*
 * Equal variances on the measured axes; z counts as measured where the row has a height or climb.
 */
static void covariance_from_sigmas(const double *cells, float *covariance)
{
    float sigma_m = rows_float_or_zero(cells[SIGMA_M]),
          sigma_mps = rows_float_or_zero(cells[SIGMA_MPS]);
    bool has_height = rows_float_or_zero(cells[STATE + 2]) != 0.0f ||
                      rows_float_or_zero(cells[STATE + 5]) != 0.0f;

    for (int axis = 0; axis < (has_height ? AXES : AXES - 1); axis++) {
        covariance[variance_index(axis)] = sigma_m * sigma_m;
        covariance[variance_index(AXES + axis)] = sigma_mps * sigma_mps;
    }
}

static struct rho_message_track message_track_of(const double *cells)
{
    const double *state = cells + STATE, *acceleration = cells + ACCELERATION;
    struct rho_message_track track = {
        .track_id = (int32_t)cells[TRACK_ID],
        .status = (int8_t)cells[STATUS],
        .hits = (int16_t)rows_float_or_zero(cells[HITS]),
        .misses = (int16_t)rows_float_or_zero(cells[MISSES]),
        .sensor_id = (int16_t)rows_float_or_zero(cells[SENSOR_ID]),
        .plot = rows_is_cell_empty(cells[PLOT]) ? -1 : (int16_t)cells[PLOT],
        .update_age_us =
            rows_is_cell_empty(cells[UPDATE_AGE_US]) ? 0 : (int32_t)cells[UPDATE_AGE_US],
        .x_m = rows_float_or_zero(state[0]),
        .y_m = rows_float_or_zero(state[1]),
        .z_m = rows_float_or_zero(state[2]),
        .vx_mps = rows_float_or_zero(state[3]),
        .vy_mps = rows_float_or_zero(state[4]),
        .vz_mps = rows_float_or_zero(state[5]),
        .ax_mps2 = rows_float_or_zero(acceleration[0]),
        .ay_mps2 = rows_float_or_zero(acceleration[1]),
        .az_mps2 = rows_float_or_zero(acceleration[2]),
        .score_nat = rows_float_or_zero(cells[SCORE_NAT]),
        .maneuver_probability = rows_float_or_zero(cells[MANEUVER_PROBABILITY]),
    };

    for (int i = 0; i < COVARIANCES; i++) {
        track.covariance[i] = rows_float_or_zero(cells[COVARIANCE + i]);
    }
    if (!has_covariance(cells)) {
        covariance_from_sigmas(cells, track.covariance);
    }
    return track;
}

static size_t encode_track_list_part(const struct rows_part *part, uint8_t *buffer,
                                     const char **field)
{
    struct rho_message_track_list message = {
        .utime = part->scan->utime,
        .scan = part->scan->head.scan,
        .epoch = part->scan->head.epoch,
        .num_tracks_total = (int16_t)part->scan->count,
        .part = part->part,
        .num_parts = part->scan->num_parts,
        .num_tracks = (int16_t)part->count,
    };

    for (size_t i = 0; i < part->count; i++) {
        message.tracks[i] = message_track_of(rows_part_cells(part, i));
    }
    return encode_checked_track_list(&message, buffer, field);
}

/*
 * Root mean variance over the measured axes, as the tracker computes it: the axes on which position
 * or velocity has a variance.
 */
static double rms_sigma_of(const float *covariance, int first_state)
{
    float sum = 0.0f;
    int axes = 0;

    for (int axis = 0; axis < AXES; axis++) {
        if (covariance[variance_index(axis)] > 0.0f ||
            covariance[variance_index(AXES + axis)] > 0.0f) {
            sum += covariance[variance_index(first_state + axis)];
            axes++;
        }
    }
    return axes > 0 && sum > 0.0f ? (double)sqrtf(sum / (float)axes) : 0.0;
}

static void put_track_cells(double *cells, const struct rho_message_track *track)
{
    const float states[] = {track->x_m,     track->y_m,     track->z_m,
                            track->vx_mps,  track->vy_mps,  track->vz_mps,
                            track->ax_mps2, track->ay_mps2, track->az_mps2};

    cells[TRACK_ID] = track->track_id;
    cells[STATUS] = track->status;
    for (int i = 0; i < STATES + AXES; i++) {
        cells[STATE + i] = (double)states[i];
    }
    cells[SIGMA_M] = rms_sigma_of(track->covariance, 0);
    cells[SIGMA_MPS] = rms_sigma_of(track->covariance, AXES);
    cells[HITS] = track->hits;
    cells[MISSES] = track->misses;
    cells[SENSOR_ID] = track->sensor_id;
    cells[PLOT] = track->plot;
    for (int i = 0; i < COVARIANCES; i++) {
        cells[COVARIANCE + i] = (double)track->covariance[i];
    }
    cells[UPDATE_AGE_US] = track->update_age_us;
    cells[SCORE_NAT] = (double)track->score_nat;
    cells[MANEUVER_PROBABILITY] = (double)track->maneuver_probability;
}

static enum rho_status decode_track_list_to_rows(const uint8_t *data, size_t size,
                                                 struct rows *rows, struct rows_message *out,
                                                 const char **field)
{
    struct rho_message_track_list message;
    const enum rho_status status = decode_checked_track_list(data, size, &message, field);

    if (status != RHO_OK) {
        return status;
    }
    const struct row key = {.time_us = message.utime, .epoch = message.epoch, .scan = message.scan};

    rows_begin_message(rows, out, &key, message.part, message.num_parts, message.num_tracks);
    for (int i = 0; i < message.num_tracks; i++) {
        put_track_cells(rows_add_message_row(rows, out, 0), &message.tracks[i]);
    }
    return RHO_OK;
}

const struct rows_kind rows_kind_tracks = {
    .name = "tracks",
    .channel = RHO_MESSAGE_TRACK_LIST_CHANNEL,
    .type = RHO_MESSAGE_TYPE_TRACK_LIST,
    .has_epoch = true,
    .has_one_time = true,
    .rows_max = INT16_MAX,
    .columns = columns,
    .num_columns = NUM_COLUMNS,
    .why_not = why_track_sigmas_invalid,
    .part_max = RHO_MESSAGE_TRACK_LIST_MAX_TRACKS,
    .encode = encode_track_list_part,
    .decode = decode_track_list_to_rows,
};
