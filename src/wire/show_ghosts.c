/* SPDX-License-Identifier: MIT */
/* show_ghosts: messages of the newest row's ghost matrices, one matrix for each sensor pair. */
#include "message_clamps.h"
#include "show_writers.h"

#define PART_ELEMENTS RHO_MESSAGE_GHOST_MATRIX_MAX_ELEMENTS

static unsigned num_matrix_parts(const struct rho_batch *batch,
                                 const struct rho_passive_paper_pair *pair)
{
    const uint8_t *num = batch->num_bearings[batch->num_scans - 1u];
    return rho_num_parts((unsigned)num[pair->a] * num[pair->b], PART_ELEMENTS);
}

/*
 * Finds the sensor pair and the part of its matrix that a message number stands for. Returns 0
 * beyond the last message; *before is the number of all messages then.
 */
static int find_part(const struct rho_show_source *source, uint32_t number,
                     struct rho_passive_paper_pair *pair, unsigned *part, uint32_t *before)
{
    const struct rho_batch *batch = source->paper ? &source->paper->batch : NULL;
    const unsigned scan = batch ? batch->num_scans - 1u : 0;
    *before = 0;
    if (!batch || !batch->is_due || batch->newest_us != source->report->time_us) {
        return 0; /* the step has ended no row */
    }
    for (unsigned i = 0; rho_passive_paper_pair(source->paper, i, pair); i++) {
        const uint8_t *was_seen = batch->was_seen[scan];
        const unsigned parts =
            was_seen[pair->a] && was_seen[pair->b] ? num_matrix_parts(batch, pair) : 0;
        if (number < *before + parts) {
            *part = number - *before;
            return 1;
        }
        *before += parts;
    }
    return 0;
}

uint32_t rho_show_count_ghosts(const struct rho_show_source *source)
{
    struct rho_passive_paper_pair pair;
    uint32_t all;
    unsigned part;
    (void)find_part(source, UINT32_MAX, &pair, &part, &all);
    return all;
}

/*
 * Makes the message of one crossing of two sensors' bearings, an element of the ghost matrix. Its
 * angle is computed anew, as pruning has set it to 0 in the matrix.
 */
static struct rho_message_ghost ghost_of_element(const struct rho_passive_paper *paper,
                                                 const struct rho_passive_paper_pair *pair,
                                                 const struct rho_crossing_base *base,
                                                 const struct rho_ghost_matrix *matrix,
                                                 unsigned element)
{
    static const int8_t reasons[RHO_NUM_GHOST_REASONS] = {
        [RHO_GHOST_KEPT] = RHO_MESSAGE_GHOST_KEPT,
        [RHO_GHOST_SIDES] = RHO_MESSAGE_GHOST_SIDES,
        [RHO_GHOST_APART] = RHO_MESSAGE_GHOST_APART,
        [RHO_GHOST_RANGE] = RHO_MESSAGE_GHOST_RANGE,
        [RHO_GHOST_ROW] = RHO_MESSAGE_GHOST_ROW,
        [RHO_GHOST_COLUMN] = RHO_MESSAGE_GHOST_COLUMN,
        [RHO_GHOST_UNMATCHED] = RHO_MESSAGE_GHOST_UNMATCHED};
    const unsigned scan = paper->batch.num_scans - 1u;
    const unsigned row = element / matrix->columns, column = element % matrix->columns;
    const unsigned reason = matrix->reason[row][column];
    const float a_rad = paper->batch.bearings[scan][pair->a][row].bearing_rad;
    const float b_rad = paper->batch.bearings[scan][pair->b][column].bearing_rad;
    struct rho_message_ghost ghost = {.row = (int16_t)row,
                                      .column = (int16_t)column,
                                      .reason = reasons[reason],
                                      .delta_rad = rho_crossing_angle_rad(base, a_rad, b_rad)};
    struct rho_crossing crossing;
    if (reason != RHO_GHOST_SIDES && reason != RHO_GHOST_APART && reason != RHO_GHOST_RANGE &&
        rho_crossing_find(base, a_rad, b_rad, paper->config.range_max_m, &crossing) ==
            RHO_CROSSING_MEETS) {
        ghost.x_m = crossing.x_m;
        ghost.y_m = crossing.y_m;
    }
    return ghost;
}

enum rho_status rho_show_write_ghosts(const struct rho_show_source *source, uint32_t number,
                                      struct rho_show_output *output)
{
    const struct rho_passive_paper *paper = source->paper;
    struct rho_passive_paper_pair pair;
    struct rho_ghost_matrix matrix;
    struct rho_crossing_base base;
    uint32_t before;
    unsigned part;
    if (!find_part(source, number, &pair, &part, &before) ||
        rho_passive_paper_ghosts(paper, &pair, paper->batch.num_scans - 1u, &matrix) != RHO_OK) {
        return RHO_ERROR_STATE;
    }
    const unsigned scan = paper->batch.num_scans - 1u;
    const struct rho_batch_look *a = &paper->batch.looks[scan][pair.a];
    const struct rho_batch_look *b = &paper->batch.looks[scan][pair.b];
    const struct rho_message_ghost_matrix_head head = {
        .utime = paper->batch.time_us[scan],
        .scan = source->step,
        .epoch = source->epoch,
        .sensor_a_id = rho_clamp_sensor_id(paper->batch.sensors[pair.a].sensor_id),
        .sensor_b_id = rho_clamp_sensor_id(paper->batch.sensors[pair.b].sensor_id),
        .sensor_a_x_m = a->x_m,
        .sensor_a_y_m = a->y_m,
        .sensor_b_x_m = b->x_m,
        .sensor_b_y_m = b->y_m,
        .range_max_m = paper->config.range_max_m,
        .rule = (int8_t)paper->config.rule,
        .num_rows = (int16_t)matrix.rows,
        .num_columns = (int16_t)matrix.columns,
        .not_sent = output->not_sent,
        .part = (int16_t)part,
        .num_parts = (int16_t)num_matrix_parts(&paper->batch, &pair)};
    const unsigned all = (unsigned)matrix.rows * matrix.columns;
    enum rho_status status = rho_crossing_set_base(&base, a->x_m, a->y_m, b->x_m, b->y_m);
    output->channel = RHO_MESSAGE_GHOST_MATRIX_CHANNEL;
    if (status == RHO_OK) {
        status = rho_message_ghost_matrix_begin(&output->writer, output->buffer, output->capacity,
                                                &head);
    }
    for (unsigned i = part * PART_ELEMENTS;
         i < all && i < (part + 1u) * PART_ELEMENTS && status == RHO_OK; i++) {
        const struct rho_message_ghost ghost = ghost_of_element(paper, &pair, &base, &matrix, i);
        status = rho_message_ghost_matrix_add(&output->writer, &ghost);
    }
    return status;
}
