/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/ghost.h"

#include "rhotrack/types.h"

#define ANGLE_MAX_RAD 100.0f /* of angle.h */

/* ---- elimination ----------------------------------------------------------------------------- */

static int are_finite(const float *bearings_rad, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        if (!rho_is_within(bearings_rad[i], -ANGLE_MAX_RAD, ANGLE_MAX_RAD)) {
            return 0;
        }
    }
    return 1;
}

static uint8_t reason_of(enum rho_crossing_fate fate)
{
    switch (fate) {
    case RHO_CROSSING_SIDES:
        return RHO_GHOST_SIDES;
    case RHO_CROSSING_RANGE:
        return RHO_GHOST_RANGE;
    case RHO_CROSSING_MEETS:
        return RHO_GHOST_KEPT;
    case RHO_CROSSING_APART:
    case RHO_NUM_CROSSING_FATES:
    default:
        return RHO_GHOST_APART;
    }
}

enum rho_status rho_ghost_fill(struct rho_ghost_matrix *matrix,
                               const struct rho_crossing_base *base, const float *bearings_a_rad,
                               unsigned num_a, const float *bearings_b_rad, unsigned num_b,
                               float range_max_m)
{
    if (!matrix || !base || (num_a > 0 && !bearings_a_rad) || (num_b > 0 && !bearings_b_rad)) {
        return RHO_ERROR_NULL;
    }
    if (num_a > RHO_MAX_BEARINGS || num_b > RHO_MAX_BEARINGS) {
        return RHO_ERROR_CAPACITY;
    }
    if (!are_finite(bearings_a_rad, num_a) || !are_finite(bearings_b_rad, num_b) ||
        !(range_max_m > 0.0f)) {
        return RHO_ERROR_VALUE;
    }
    matrix->rows = (uint16_t)num_a;
    matrix->columns = (uint16_t)num_b;
    for (unsigned i = 0; i < num_a; i++) {
        for (unsigned j = 0; j < num_b; j++) {
            struct rho_crossing crossing;
            enum rho_crossing_fate fate = rho_crossing_find(
                base, bearings_a_rad[i], bearings_b_rad[j], range_max_m, &crossing);
            matrix->delta_rad[i][j] = fate == RHO_CROSSING_MEETS ? crossing.delta_rad : 0.0f;
            matrix->reason[i][j] = reason_of(fate);
        }
    }
    return RHO_OK;
}

/* ---- pruning --------------------------------------------------------------------------------- */

/* Rows of a matrix, or its columns: the paper's rules are the same for both. */
struct beams {
    struct rho_ghost_matrix *matrix;
    unsigned count, others; /* beams of this sensor, and of the other one */
    int are_columns;
};

static int is_kept(const struct beams *beams, unsigned beam, unsigned other)
{
    const struct rho_ghost_matrix *matrix = beams->matrix;
    return (beams->are_columns ? matrix->reason[other][beam] : matrix->reason[beam][other]) ==
           RHO_GHOST_KEPT;
}

static void remove_crossing(const struct beams *beams, unsigned beam, unsigned other)
{
    unsigned row = beams->are_columns ? other : beam, column = beams->are_columns ? beam : other;
    beams->matrix->delta_rad[row][column] = 0.0f;
    beams->matrix->reason[row][column] = beams->are_columns ? RHO_GHOST_COLUMN : RHO_GHOST_ROW;
}

/* How many crossings a beam has; *only is one of them. */
static unsigned count_kept(const struct beams *beams, unsigned beam, unsigned *only)
{
    unsigned count = 0;
    for (unsigned other = 0; other < beams->others; other++) {
        if (is_kept(beams, beam, other)) {
            *only = other;
            count++;
        }
    }
    return count;
}

/*
 * The first beam with a single crossing that is not done; the number of beams where there is none.
 */
static unsigned find_single(const struct beams *beams, const uint8_t *done, unsigned *only)
{
    unsigned beam = 0;
    while (beam < beams->count && (done[beam] || count_kept(beams, beam, only) != 1)) {
        beam++;
    }
    return beam;
}

/*
 * Steps 2.1 to 2.4: a beam's only crossing is its target, and the other beam's too, whose other
 * crossings are ghosts.
 */
static unsigned prune_beams(const struct beams *beams, uint8_t *done, uint8_t *others_done)
{
    unsigned removed = 0, only = 0, beam;
    while ((beam = find_single(beams, done, &only)) < beams->count) {
        for (unsigned i = 0; i < beams->count; i++) {
            if (i != beam && is_kept(beams, i, only)) {
                remove_crossing(beams, i, only);
                removed++;
            }
        }
        done[beam] = others_done[only] = 1;
    }
    return removed;
}

static unsigned prune(struct rho_ghost_matrix *matrix)
{
    uint8_t rows_done[RHO_MAX_BEARINGS] = {0}, columns_done[RHO_MAX_BEARINGS] = {0};
    struct beams rows = {matrix, matrix->rows, matrix->columns, 0};
    struct beams columns = {matrix, matrix->columns, matrix->rows, 1};
    unsigned removed = prune_beams(&rows, rows_done, columns_done);
    return removed + prune_beams(&columns, columns_done, rows_done);
}

static int every_beam_has_one(struct rho_ghost_matrix *matrix)
{
    struct beams both[2] = {{matrix, matrix->rows, matrix->columns, 0},
                            {matrix, matrix->columns, matrix->rows, 1}};
    for (unsigned side = 0; side < 2; side++) {
        for (unsigned beam = 0; beam < both[side].count; beam++) {
            unsigned only;
            if (count_kept(&both[side], beam, &only) == 0) {
                return 0;
            }
        }
    }
    return 1;
}

unsigned rho_ghost_prune(struct rho_ghost_matrix *matrix, enum rho_ghost_rule rule)
{
    if (rule == RHO_GHOST_LITERAL) {
        return prune(matrix);
    }
    if (rule != RHO_GHOST_SAFE || matrix->rows != matrix->columns) {
        return 0;
    }
    struct rho_ghost_matrix tried = *matrix;
    unsigned removed = prune(&tried);
    if (!every_beam_has_one(&tried)) {
        return 0;
    }
    *matrix = tried;
    return removed;
}

/* Characters, not pointers: nothing to relocate. */
static const char names[RHO_NUM_GHOST_REASONS][7] = {
    [RHO_GHOST_KEPT] = "kept",   [RHO_GHOST_SIDES] = "sides", [RHO_GHOST_APART] = "apart",
    [RHO_GHOST_RANGE] = "range", [RHO_GHOST_ROW] = "row",     [RHO_GHOST_COLUMN] = "column",
};

const char *rho_ghost_reason_name(enum rho_ghost_reason reason)
{
    return (unsigned)reason < RHO_NUM_GHOST_REASONS ? names[reason] : "unknown";
}
