/* SPDX-License-Identifier: MIT */
/*
 * truth_rows: rows of true target positions, and truth_list_t messages.
 */
#include "io/rows/rows_in_memory.h"

enum column { TARGET_ID, X_M, Y_M, Z_M, VX_MPS, VY_MPS, VZ_MPS, NUM_COLUMNS };

enum { IN_FILE = COLUMN_NEEDED | COLUMN_FILLED | COLUMN_ALWAYS, VELOCITY = 1 };

static const struct rows_column columns[NUM_COLUMNS] = {
    [TARGET_ID] = {COL_TARGET_ID, IN_FILE | COLUMN_MEASURED | COLUMN_INT32, 0},
    [X_M] = {COL_X_M, IN_FILE, 0},
    [Y_M] = {COL_Y_M, IN_FILE, 0},
    [Z_M] = {COL_Z_M, COLUMN_NOT_ZERO, 0},
    [VX_MPS] = {COL_VX_MPS, COLUMN_NOT_ZERO, VELOCITY},
    [VY_MPS] = {COL_VY_MPS, COLUMN_NOT_ZERO, VELOCITY},
    [VZ_MPS] = {COL_VZ_MPS, COLUMN_NOT_ZERO, 0},
};

ROWS_CHECKED_CODEC(truth_list)

static struct rho_message_truth message_target_of(const double *cells)
{
    return (struct rho_message_truth){
        .target_id = (int32_t)cells[TARGET_ID],
        .x_m = rows_float_or_zero(cells[X_M]),
        .y_m = rows_float_or_zero(cells[Y_M]),
        .z_m = rows_float_or_zero(cells[Z_M]),
        .vx_mps = rows_float_or_zero(cells[VX_MPS]),
        .vy_mps = rows_float_or_zero(cells[VY_MPS]),
        .vz_mps = rows_float_or_zero(cells[VZ_MPS]),
    };
}

static size_t encode_truth_part(const struct rows_part *part, uint8_t *buffer, const char **field)
{
    struct rho_message_truth_list message = {
        .utime = part->scan->utime,
        .scan = part->scan->head.scan,
        .part = part->part,
        .num_parts = part->scan->num_parts,
        .num_targets = (int16_t)part->count,
    };

    for (size_t i = 0; i < part->count; i++) {
        message.targets[i] = message_target_of(rows_part_cells(part, i));
    }
    return encode_checked_truth_list(&message, buffer, field);
}

static void put_target_cells(double *cells, const struct rho_message_truth *target)
{
    cells[TARGET_ID] = target->target_id;
    cells[X_M] = (double)target->x_m;
    cells[Y_M] = (double)target->y_m;
    cells[Z_M] = (double)target->z_m;
    cells[VX_MPS] = (double)target->vx_mps;
    cells[VY_MPS] = (double)target->vy_mps;
    cells[VZ_MPS] = (double)target->vz_mps;
}

static enum rho_status decode_truth_list_to_rows(const uint8_t *data, size_t size,
                                                 struct rows *rows, struct rows_message *out,
                                                 const char **field)
{
    struct rho_message_truth_list message;
    const enum rho_status status = decode_checked_truth_list(data, size, &message, field);

    if (status != RHO_OK) {
        return status;
    }
    const struct row key = {.time_us = message.utime, .scan = message.scan};

    rows_begin_message(rows, out, &key, message.part, message.num_parts, message.num_targets);
    for (int i = 0; i < message.num_targets; i++) {
        put_target_cells(rows_add_message_row(rows, out, 0), &message.targets[i]);
    }
    return RHO_OK;
}

const struct rows_kind rows_kind_truth = {
    .name = "truth",
    .channel = RHO_MESSAGE_TRUTH_LIST_CHANNEL,
    .type = RHO_MESSAGE_TYPE_TRUTH_LIST,
    .has_one_time = true,
    .columns = columns,
    .num_columns = NUM_COLUMNS,
    .part_max = RHO_MESSAGE_TRUTH_LIST_MAX_TARGETS,
    .encode = encode_truth_part,
    .decode = decode_truth_list_to_rows,
};
