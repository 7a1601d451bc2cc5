/* SPDX-License-Identifier: MIT */
/*
 * hough_votes: the methods' parts, as their files share them. Each file calls only those above
 * it.
 *
 *   hough_plane.c    rows and columns of the plane
 *   hough_cells.c    the hash of cells with votes; the spread of NHT_C over their neighbours
 *   hough_pairs.c    pairs of plots, their lines, and the votes that the kernels of NHT give them
 *   hough_track.c    the plots that voted for a cell, and the track fitted through them; the
 *                    memberships of a vote
 *   hough.c          configuration, passes over theta, thresholds and suppression
 */
#ifndef RHOTRACK_HOUGH_VOTES_H
#define RHOTRACK_HOUGH_VOTES_H

#include "rhotrack/detail/angle.h"
#include "rhotrack/hough.h"

/* Rows of theta from first on, across the end. */
struct rho_hough_rows {
    int32_t first, count;
};

/* One pass over all pairs, for the lines in some rows of theta. */
struct rho_hough_pass {
    struct rho_hough *hough;
    const struct rho_hough_points *points;
    struct rho_hough_rows wanted; /* rows whose cells are listed */
    struct rho_hough_rows voting; /* rows whose lines vote for such cells */
    struct rho_hough_rows held;   /* rows whose lines are kernels of such lines */
    enum rho_hough_component component;
    struct rho_plane *plane; /* where cells are noted instead of listed; NULL: they are listed */
    int can_reject; /* lines outside are rejected by the border normals, without an arctangent */
    float from_x, from_y, to_x, to_y;
    int stops_when_full, is_full;
    uint32_t table_size; /* of the cells in use: a power of two */
    uint32_t num_cells, most_kernels;
    uint32_t num_kernels[2];       /* of the previous and the current pair of scans, by parity */
    struct rho_hough_result found; /* counters of the pass */
};

/* Two plots of successive scans: indices among the plots of all scans. */
struct rho_hough_pair {
    uint32_t first, second;
};

/* ---- the plane ---- */

int rho_hough_has_row(const struct rho_hough *hough, struct rho_hough_rows rows, int32_t row);
int32_t rho_hough_row(const struct rho_hough *hough, float theta_rad);
/* -1 beyond rho_max. */
int32_t rho_hough_column(const struct rho_hough *hough, float rho_m);
uint32_t rho_hough_scan_start(const struct rho_hough_points *points, unsigned scan);

/* ---- pairs ---- */

enum rho_hough_speed { RHO_SPEED_NO_LINE, RHO_SPEED_OUTSIDE, RHO_SPEED_WITHIN };

/*
 * Whether the speed from the first plot to the second is within the limits; NO_LINE: same position.
 */
enum rho_hough_speed rho_hough_speed(const struct rho_hough *hough,
                                     const struct rho_hough_points *points,
                                     struct rho_hough_pair pair);
int rho_hough_uses_kernels(const struct rho_hough *hough);
struct rho_line rho_hough_line(const struct rho_hough_points *points, struct rho_hough_pair pair);

/* The two kernels nearest to a line, by (drho / eps)^2 + (dtheta / eps)^2. */
struct rho_hough_nearest {
    float distance2[2];
    uint32_t count; /* 0 .. 2 */
    struct rho_hough_pair pair[2];
};

/*
 * Adds a kernel if it is within 2 eps of the line. Of equally near kernels the one of the first
 * plots counts.
 */
void rho_hough_compare_kernel(const struct rho_hough *hough, struct rho_line line,
                              struct rho_line kernel, struct rho_hough_pair pair,
                              struct rho_hough_nearest *nearest);

/* The vote of a pair with these kernels, in units of 1 / RHO_HOUGH_VOTE; 0: none. */
uint32_t rho_hough_vote_weight(const struct rho_hough *hough, const struct rho_hough_points *points,
                               struct rho_line line, const struct rho_hough_nearest *nearest);
struct rho_hough_memberships rho_hough_memberships_of(const struct rho_hough *hough,
                                                      const struct rho_hough_points *points,
                                                      struct rho_line line,
                                                      const struct rho_hough_nearest *nearest);

/* All pairs of a pass vote. */
void rho_hough_vote_pairs(struct rho_hough_pass *pass);

/* ---- cells ---- */

void rho_hough_clear_cells(struct rho_hough_pass *pass);
void rho_hough_add_votes(struct rho_hough_pass *pass, struct rho_line line, uint32_t votes);

/* Weights by distance in rows or columns, in units of 1 / RHO_HOUGH_VOTE. */
void rho_hough_spread_weights(uint32_t shares[RHO_HOUGH_REACH_MAX + 1], unsigned reach, float cell,
                              float eps);
uint32_t rho_hough_scale_votes(uint32_t votes, uint32_t share);

/* Lists the cells of the wanted rows with all their votes; NULL: notes them in the pass' plane. */
void rho_hough_collect_cells(struct rho_hough_pass *pass, struct rho_peak_list *list);

/* ---- voters ---- */

/* Those of a pair whose second plot is of the scan. */
struct rho_hough_memberships rho_hough_pair_memberships(const struct rho_hough *hough,
                                                        const struct rho_hough_points *points,
                                                        unsigned scan, struct rho_hough_pair pair);

/* rho_hough_track of arguments that were checked; for HT the accumulator is set up. */
void rho_hough_find_voters(struct rho_hough *hough, const struct rho_hough_points *points,
                           unsigned theta_cell, unsigned rho_cell, float at_s,
                           struct rho_hough_track *track);

#endif
