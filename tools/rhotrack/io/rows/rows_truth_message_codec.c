/* SPDX-License-Identifier: MIT */
/*
 * rows_truth_message_codec: rows of true target positions, and truth_list_t messages.
 */
#include "io/rows/rows_in_memory.h"

enum column { TARGET_ID, X_M, Y_M, Z_M, VX_MPS, VY_MPS, VZ_MPS, NUM_COLUMNS };

enum { IN_FILE = COLUMN_NEEDED | COLUMN_FILLED | COLUMN_ALWAYS, VELOCITY = 1 };

static const struct rows_column columns[NUM_COLUMNS] = {
    [TARGET_ID] = {"target_id", IN_FILE | COLUMN_MEASURED | COLUMN_INT32, 0, NULL, NULL},
    [X_M] = {"x_m", IN_FILE, 0, NULL, NULL},
    [Y_M] = {"y_m", IN_FILE, 0, NULL, NULL},
    [Z_M] = {"z_m", COLUMN_NOT_ZERO, 0, NULL, NULL},
    [VX_MPS] = {"vx_mps", COLUMN_NOT_ZERO, VELOCITY, NULL, NULL},
    [VY_MPS] = {"vy_mps", COLUMN_NOT_ZERO, VELOCITY, NULL, NULL},
    [VZ_MPS] = {"vz_mps", COLUMN_NOT_ZERO, 0, NULL, NULL},
};

static size_t rows_in_one_message(const struct rows_part *rest)
{
    return rest->count < RHO_MESSAGE_TRUTH_LIST_MAX_TARGETS ? rest->count
                                                            : RHO_MESSAGE_TRUTH_LIST_MAX_TARGETS;
}

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
    struct rho_message_place place;
    size_t size;
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
    if (rho_message_truth_list_validate(&message, &place) != RHO_OK) {
        *field = rho_message_truth_list_field(&place);
        return 0;
    }
    return rho_message_truth_list_encode(&message, buffer, ROWS_MESSAGE_BYTES, &size) == RHO_OK
               ? size
               : 0;
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
    struct rho_message_place place;
    enum rho_status status = rho_message_truth_list_decode(data, size, &message);

    if (status != RHO_OK) {
        return status;
    }
    status = rho_message_truth_list_validate(&message, &place);
    if (status != RHO_OK) {
        *field = rho_message_truth_list_field(&place);
        return status;
    }
    out->key = (struct row){.time_us = message.utime, .scan = message.scan};
    out->part = message.part;
    out->num_parts = message.num_parts;
    rows_add_message_row(rows, out, 0);
    out->first = rows->count;
    out->count = (size_t)message.num_targets;
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
    .fit = rows_in_one_message,
    .encode = encode_truth_part,
    .decode = decode_truth_list_to_rows,
};
