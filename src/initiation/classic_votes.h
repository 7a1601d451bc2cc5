/* SPDX-License-Identifier: MIT */
/*
 * classic_votes: how the parts of classic work together.
 *
 *   classic.c          the plane, passes over theta, thresholds and suppression
 *   classic_pairs.c    pairs of plots, their lines, and what NHT's kernels give them
 *   classic_cells.c    the cells that they voted for; NHT_C's spread over their neighbours
 *   classic_track.c    who voted for a cell
 */
#ifndef RHOTRACK_CLASSIC_VOTES_H
#define RHOTRACK_CLASSIC_VOTES_H

#include "rhotrack/angle.h"
#include "rhotrack/classic.h"

/* Rows of theta from first on, round the end. */
struct rho_classic_rows {
    int32_t first, count;
};

/* One pass: the pairs of all scans, and the votes of those whose line is in some rows. */
struct rho_classic_pass {
    struct rho_classic *classic;
    const struct rho_classic_points *points;
    struct rho_classic_rows wanted; /* whose cells are collected */
    struct rho_classic_rows voting; /* whose lines vote for such cells */
    struct rho_classic_rows held;   /* whose lines are kernels for such lines */
    int can_reject;                 /* by the borders' normals, without an arctangent */
    float from_x, from_y, to_x, to_y;
    int stops_when_full, is_full;
    uint32_t table_size; /* of the cells in use: a power of two */
    uint32_t num_cells, most_kernels;
    uint32_t num_kernels[2];         /* of the scans before and of these, by the step's parity */
    struct rho_classic_result found; /* candidates, votes, cells and what was dropped */
};

/* Two plots of successive scans: numbers over all scans. */
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

/* Whether a target can fly from one to the other; or they are in one place, and have no line. */
enum rho_classic_speed rho_classic_speed(const struct rho_classic *classic,
                                         const struct rho_classic_points *points,
                                         struct rho_classic_pair pair);
int rho_classic_uses_kernels(const struct rho_classic *classic);
struct rho_line rho_classic_line(const struct rho_classic_points *points,
                                 struct rho_classic_pair pair);

/* Lines near a given one: the closest, and the next. Distances are (drho / eps)^2 + (dtheta / eps)^2. */
struct rho_classic_nearest {
    float distance2[2];
    uint32_t count; /* 0 .. 2 */
    struct rho_classic_pair pair[2];
};

/* Takes a kernel into account, where it is within 2 eps of the line. Of equally near ones that of the first plots counts. */
void rho_classic_compare(const struct rho_classic *classic, struct rho_line line,
                         struct rho_line kernel, struct rho_classic_pair pair,
                         struct rho_classic_nearest *nearest);

/* The vote of a pair with these kernels, in parts of a vote; 0: none. */
uint32_t rho_classic_weight(const struct rho_classic *classic,
                            const struct rho_classic_points *points, struct rho_line line,
                            const struct rho_classic_nearest *nearest);

/* All pairs of a pass vote. */
void rho_classic_vote(struct rho_classic_pass *pass);

/* ---- cells ---- */

void rho_classic_clear_cells(struct rho_classic_pass *pass);
void rho_classic_add(struct rho_classic_pass *pass, struct rho_line line, uint32_t votes);

/* Shares of a vote, in its parts, that cells so many rows or columns away get. */
void rho_classic_shares(uint32_t shares[RHO_CLASSIC_REACH_MAX + 1], unsigned reach, float cell,
                        float eps);
uint32_t rho_classic_share(uint32_t votes, uint32_t share);

/* The cells of the wanted rows, with all their votes, into the list. */
void rho_classic_collect(struct rho_classic_pass *pass, struct rho_peak_list *list);

/* ---- who voted ---- */

/* rho_classic_track of arguments that were checked; for HT the accumulator is set up. */
void rho_classic_look(struct rho_classic *classic, const struct rho_classic_points *points,
                      unsigned theta_cell, unsigned rho_cell, float at_s,
                      struct rho_classic_track *track);

#endif
