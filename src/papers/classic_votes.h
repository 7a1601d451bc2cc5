/* SPDX-License-Identifier: MIT */
/*
 * classic_votes: the methods' parts, as their files share them. Each file calls only those above
 * it.
 *
 *   classic_plane.c    rows and columns of the plane
 *   classic_cells.c    the hash of cells with votes; the spread of NHT_C over their neighbours
 *   classic_pairs.c    pairs of plots, their lines, and the votes that the kernels of NHT give them
 *   classic_track.c    the plots that voted for a cell, and the track fitted through them
 *   classic.c          configuration, passes over theta, thresholds and suppression
 */
#ifndef RHOTRACK_CLASSIC_VOTES_H
#define RHOTRACK_CLASSIC_VOTES_H

#include "rhotrack/classic.h"
#include "rhotrack/detail/angle.h"

/* Rows of theta from first on, across the end. */
struct rho_classic_rows {
    int32_t first, count;
};

/* One pass over all pairs, for the lines in some rows of theta. */
struct rho_classic_pass {
    struct rho_classic *classic;
    const struct rho_classic_points *points;
    struct rho_classic_rows wanted; /* rows whose cells are listed */
    struct rho_classic_rows voting; /* rows whose lines vote for such cells */
    struct rho_classic_rows held;   /* rows whose lines are kernels of such lines */
    int can_reject; /* lines outside are rejected by the border normals, without an arctangent */
    float from_x, from_y, to_x, to_y;
    int stops_when_full, is_full;
    uint32_t table_size; /* of the cells in use: a power of two */
    uint32_t num_cells, most_kernels;
    uint32_t num_kernels[2];         /* of the previous and the current pair of scans, by parity */
    struct rho_classic_result found; /* counters of the pass */
};

/* Two plots of successive scans: indices among the plots of all scans. */
struct rho_classic_pair {
    uint32_t first, second;
};

/* ---- the plane ---- */

int rho_classic_has_row(const struct rho_classic *classic, struct rho_classic_rows rows,
                        int32_t row);
int32_t rho_classic_row(const struct rho_classic *classic, float theta_rad);
/* -1 beyond rho_max. */
int32_t rho_classic_column(const struct rho_classic *classic, float rho_m);
uint32_t rho_classic_scan_start(const struct rho_classic_points *points, unsigned scan);

/* ---- pairs ---- */

enum rho_classic_speed { RHO_SPEED_NO_LINE, RHO_SPEED_OUTSIDE, RHO_SPEED_WITHIN };

/*
 * Whether the speed from the first plot to the second is within the limits; NO_LINE: same position.
 */
enum rho_classic_speed rho_classic_speed(const struct rho_classic *classic,
                                         const struct rho_classic_points *points,
                                         struct rho_classic_pair pair);
int rho_classic_uses_kernels(const struct rho_classic *classic);
struct rho_line rho_classic_line(const struct rho_classic_points *points,
                                 struct rho_classic_pair pair);

/* The two kernels nearest to a line, by (drho / eps)^2 + (dtheta / eps)^2. */
struct rho_classic_nearest {
    float distance2[2];
    uint32_t count; /* 0 .. 2 */
    struct rho_classic_pair pair[2];
};

/*
 * Adds a kernel if it is within 2 eps of the line. Of equally near kernels the one of the first
 * plots counts.
 */
void rho_classic_compare_kernel(const struct rho_classic *classic, struct rho_line line,
                                struct rho_line kernel, struct rho_classic_pair pair,
                                struct rho_classic_nearest *nearest);

/* The vote of a pair with these kernels, in units of 1 / RHO_CLASSIC_VOTE; 0: none. */
uint32_t rho_classic_vote_weight(const struct rho_classic *classic,
                                 const struct rho_classic_points *points, struct rho_line line,
                                 const struct rho_classic_nearest *nearest);

/* All pairs of a pass vote. */
void rho_classic_vote_pairs(struct rho_classic_pass *pass);

/* ---- cells ---- */

void rho_classic_clear_cells(struct rho_classic_pass *pass);
void rho_classic_add_votes(struct rho_classic_pass *pass, struct rho_line line, uint32_t votes);

/* Weights by distance in rows or columns, in units of 1 / RHO_CLASSIC_VOTE. */
void rho_classic_spread_weights(uint32_t shares[RHO_CLASSIC_REACH_MAX + 1], unsigned reach,
                                float cell, float eps);
uint32_t rho_classic_scale(uint32_t votes, uint32_t share);

/* Lists the cells of the wanted rows with all their votes. */
void rho_classic_collect(struct rho_classic_pass *pass, struct rho_peak_list *list);

/* ---- voters ---- */

/* rho_classic_track of arguments that were checked; for HT the accumulator is set up. */
void rho_classic_find_voters(struct rho_classic *classic, const struct rho_classic_points *points,
                             unsigned theta_cell, unsigned rho_cell, float at_s,
                             struct rho_classic_track *track);

#endif
