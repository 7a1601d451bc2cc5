/* SPDX-License-Identifier: MIT */
/*
 * hough_search: state and functions that the files of the Hough methods (HT, MHT, IHT, NHT) share.
 * Each file calls only files above it in this list:
 *
 * - hough_geometry.c: rows and columns of the plane
 * - hough_votes.c: the hash of cells with votes; the spread of NHT_C over their neighbours
 * - hough_pairs.c: pairs of plots, their lines, and the votes that the kernels of NHT give them
 * - hough_voters.c: the plots that voted for a cell, the track through them; memberships
 * - hough.c: configuration, passes over theta, thresholds and suppression
 */
#ifndef RHOTRACK_HOUGH_SEARCH_H
#define RHOTRACK_HOUGH_SEARCH_H

#include "rhotrack/detail/angle.h"
#include "rhotrack/hough.h"

/* Rows of theta from `first` on; beyond the last row they continue with row 0. */
struct rho_hough_rows {
    int32_t first, count;
};

/* State of one pass over all pairs of plots, for lines in some rows of theta. */
struct rho_hough_pass {
    struct rho_hough *hough;
    const struct rho_hough_points *points;
    struct rho_hough_rows wanted; /* rows of theta whose cells are listed as possible peaks */
    struct rho_hough_rows voting; /* rows of theta whose lines vote for cells of the wanted rows */
    /* rows of theta whose lines are kernels of lines in the voting rows */
    struct rho_hough_rows held;
    enum rho_hough_component component;
    /* plane in which cells are noted; NULL: cells are listed as possible peaks */
    struct rho_votes_picture *plane;
    /* lines outside the held rows are rejected by the border normals, without an arctangent */
    int can_reject;
    float from_x, from_y, to_x, to_y;
    int stops_when_full, is_full;
    uint32_t table_size; /* slots of the hash table of cells: a power of two */
    uint32_t num_cells, most_kernels;
    /* kernels of the previous and the current pair of scans, by the parity of the scan */
    uint32_t num_kernels[2];
    /* counters of this pass, added to the search's result if the pass is complete */
    struct rho_hough_result found;
};

/* Two plots of successive scans, as indices among the plots of all scans. */
struct rho_hough_pair {
    uint32_t first, second;
};

int rho_hough_has_row(const struct rho_hough *hough, struct rho_hough_rows rows, int32_t row);
int32_t rho_hough_row_of_theta(const struct rho_hough *hough, float theta_rad);
/* Column of the cell at rho_m; -1: beyond rho_max_m. */
int32_t rho_hough_column_of_rho(const struct rho_hough *hough, float rho_m);
uint32_t rho_hough_scan_start(const struct rho_hough_points *points, unsigned scan);

enum rho_hough_speed_check { RHO_SPEED_NO_LINE, RHO_SPEED_OUTSIDE, RHO_SPEED_WITHIN };

/*
 * Whether the speed from the first plot of a pair to the second is within the limits; NO_LINE: both
 * are at the same position.
 */
enum rho_hough_speed_check rho_hough_speed_check(const struct rho_hough *hough,
                                                 const struct rho_hough_points *points,
                                                 struct rho_hough_pair pair);
int rho_hough_uses_kernels(const struct rho_hough *hough);
struct rho_line rho_hough_line_through_pair(const struct rho_hough_points *points,
                                            struct rho_hough_pair pair);
/* The two kernels nearest to a line, by the squared distance (drho / eps)^2 + (dtheta / eps)^2. */
struct rho_hough_nearest {
    float distance2[2];
    uint32_t count; /* number of kernels found: 0 .. 2 */
    struct rho_hough_pair pair[2];
};

/*
 * Enters a kernel into the two nearest of a line if it is within 2 eps and nearer. Among equally
 * near kernels the one with the lower plots counts.
 */
void rho_hough_rank_kernel(const struct rho_hough *hough, struct rho_line line,
                           struct rho_line kernel, struct rho_hough_pair pair,
                           struct rho_hough_nearest *nearest);
/* The vote of a pair of plots, in units of 1 / RHO_HOUGH_VOTE, and its memberships. */
struct rho_hough_vote {
    uint32_t weight; /* as the method counts it; 0: none */
    struct rho_hough_memberships of;
};

/* Vote of a pair with these nearest kernels. */
struct rho_hough_vote rho_hough_vote_of_line(const struct rho_hough *hough,
                                             const struct rho_hough_points *points,
                                             struct rho_line line,
                                             const struct rho_hough_nearest *nearest);
/* Lets all pairs of plots vote, for the rows of a pass. */
void rho_hough_vote_pairs(struct rho_hough_pass *pass);

void rho_hough_clear_cells(struct rho_hough_pass *pass);
void rho_hough_add_votes(struct rho_hough_pass *pass, struct rho_line line, uint32_t votes);
/* Fills the weights that spread votes, by distance in rows or columns, in 1 / RHO_HOUGH_VOTE. */
void rho_hough_spread_weights(uint32_t shares[RHO_HOUGH_REACH_MAX + 1], unsigned reach, float cell,
                              float eps);
uint32_t rho_hough_scale_votes(uint32_t votes, uint32_t share);
/* Adds the summed cells of the wanted rows to the list; list NULL: to the plane of the pass. */
void rho_hough_collect_cells(struct rho_hough_pass *pass, struct rho_peak_list *list);
/* Memberships of the vote of a pair whose second plot is of scan `scan`. */
struct rho_hough_memberships rho_hough_memberships_of_pair(const struct rho_hough *hough,
                                                           const struct rho_hough_points *points,
                                                           unsigned scan,
                                                           struct rho_hough_pair pair);
/*
 * Fits *track through the plots that voted for a cell: rho_hough_track with checked arguments; with
 * HT the accumulator must be set up.
 */
void rho_hough_fit_track_to_voters(struct rho_hough *hough, const struct rho_hough_points *points,
                                   unsigned theta_cell, unsigned rho_cell, float at_s,
                                   struct rho_hough_track *track);

#endif
