/* SPDX-License-Identifier: MIT */
/*
 * passive_paper_search: one search by the paper's method, as its files share it.
 *
 *   passive_paper_votes.c  crossings, votes in rows of theta, confirmation by all pairs
 *   passive_paper_lines.c  the choice of the lines, and the fits through their crossings
 *   passive_paper.c        configuration, frames, the plan of a search
 *   passive_paper_view.c   what a search had: ghost matrices, planes
 */
#ifndef RHOTRACK_PASSIVE_PAPER_SEARCH_H
#define RHOTRACK_PASSIVE_PAPER_SEARCH_H

#include "rhotrack/passive_paper.h"

#define RHO_PASSIVE_PAPER_MAGIC 0x50504150u /* "PPAP" */

/* Neighbouring cells that are not chosen as another line. */
#define RHO_PASSIVE_PAPER_NEAR_ROWS 4
#define RHO_PASSIVE_PAPER_NEAR_COLUMNS 3

/* Values computed once for a search. The origin is the sensors' centroid. */
struct rho_passive_paper_search {
    struct rho_passive_paper *paper;
    float middle_x_m, middle_y_m;
    unsigned num_sensors; /* with a scan in the batch */
    uint8_t sensors[RHO_MAX_PASSIVE_SENSORS];
    int rows, columns;                      /* cells of theta and of rho */
    int near;                               /* neighbours that confirm a cell: 0 or 1 */
    float half_s;                           /* half the time from the first scan to the last */
    float step[RHO_MAX_PASSIVE_SCANS];      /* -1 .. 1 */
    struct rho_passive_paper_work per_pair; /* counters of the last pair */
};

struct rho_passive_paper_direction {
    float cosine, sine;
};

/*
 * The direction of the centre of a row. Rows before the first and after the last continue theta,
 * with the sign of rho that continues it.
 */
struct rho_passive_paper_direction
rho_passive_paper_direction(const struct rho_passive_paper_search *search, int row);

/* The sensors with scans in the batch, and their centroid. */
void rho_passive_paper_set_sensors(const struct rho_batch *batch,
                                   struct rho_passive_paper_search *search);

/* The cells, and T. Returns 0 where there is too little to search. */
int rho_passive_paper_set_cells(struct rho_passive_paper_search *search);
unsigned rho_passive_paper_rows(const struct rho_passive_paper_config *config);

/* Base of two sensors about the centroid; 0: there is none. */
int rho_passive_paper_set_base(const struct rho_passive_paper_search *search,
                               const struct rho_batch *batch, unsigned a, unsigned b,
                               struct rho_crossing_base *base);

/* The pruned ghost matrix of two sensors' bearings in a scan, which it collects. */
struct rho_passive_paper_bearings {
    float a_rad[RHO_MAX_BEARINGS], b_rad[RHO_MAX_BEARINGS];
};
int rho_passive_paper_prune_ghosts(const struct rho_passive_paper_config *config,
                                   const struct rho_batch *batch,
                                   const struct rho_crossing_base *base, unsigned scan,
                                   struct rho_passive_paper_pair pair,
                                   struct rho_passive_paper_bearings *bearings,
                                   struct rho_ghost_matrix *matrix);

/* Crossings of two sensors, pruned, into paper->points. */
void rho_passive_paper_cross_sensors(struct rho_passive_paper_search *search, unsigned a,
                                     unsigned b);

/* The column in which a crossing votes, or -1. */
int rho_passive_paper_column(const struct rho_passive_paper_search *search,
                             struct rho_passive_paper_direction direction,
                             const struct rho_passive_paper_point *point);

/* Votes of the crossings for the cells of a row of theta. */
void rho_passive_paper_vote_row(const struct rho_passive_paper_search *search, int row,
                                uint8_t counts[RHO_PAPER_RHO_CELLS]);

/* Votes of all pairs into paper->cells. */
void rho_passive_paper_vote_for_cells(struct rho_passive_paper_search *search);

/* Chooses lines from the cells, and fits their states. */
void rho_passive_paper_choose_lines(struct rho_passive_paper_search *search);
void rho_passive_paper_fit_lines(struct rho_passive_paper_search *search);

#endif
