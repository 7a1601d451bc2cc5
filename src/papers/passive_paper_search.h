/* SPDX-License-Identifier: MIT */
/*
 * passive_paper_search: one search by the paper's method, as its files share it.
 *
 *   passive_paper_votes.c  crossings, votes in rows of theta, confirmation by all pairs
 *   passive_paper_lines.c  the choice of the lines, and the fits through their crossings
 *   passive_paper.c        configuration, frames, the plan of a search
 */
#ifndef RHOTRACK_PASSIVE_PAPER_SEARCH_H
#define RHOTRACK_PASSIVE_PAPER_SEARCH_H

#include "rhotrack/passive_paper.h"

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

/* Crossings of two sensors, pruned, into paper->points. */
void rho_passive_paper_cross(struct rho_passive_paper_search *search, unsigned a, unsigned b);

/* The column in which a crossing votes, or -1. */
int rho_passive_paper_column(const struct rho_passive_paper_search *search,
                             struct rho_passive_paper_direction direction,
                             const struct rho_passive_paper_point *point);

/* Votes of the crossings in a row. */
void rho_passive_paper_vote_row(const struct rho_passive_paper_search *search, int row,
                                uint8_t counts[RHO_PAPER_RHO_CELLS]);

/* Votes of all pairs into paper->cells. */
void rho_passive_paper_vote(struct rho_passive_paper_search *search);

/* Chooses lines from the cells, and fits their states. */
void rho_passive_paper_choose(struct rho_passive_paper_search *search);
void rho_passive_paper_fit(struct rho_passive_paper_search *search);

#endif
