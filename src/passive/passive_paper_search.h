/* SPDX-License-Identifier: MIT */
/*
 * passive_paper_search: how the parts of passive_paper work together.
 *
 *   passive_paper.c        configuration, frames, the order of a search
 *   passive_paper_votes.c  crossings, rows of votes, confirmation by all pairs
 *   passive_paper_lines.c  which cells are lines, and what their crossings say of a target
 */
#ifndef RHOTRACK_PASSIVE_PAPER_SEARCH_H
#define RHOTRACK_PASSIVE_PAPER_SEARCH_H

#include "rhotrack/passive_paper.h"

/* What a search goes by. Places count from the sensors' middle. */
struct rho_passive_paper_search {
    struct rho_passive_paper *paper;
    float middle_x_m, middle_y_m;
    unsigned num_sensors; /* that looked */
    uint8_t sensors[RHO_MAX_PASSIVE_SENSORS];
    int rows, columns;                      /* cells of theta and of rho */
    int near;                               /* cells beside a place that confirm it: 0 or 1 */
    float half_s;                           /* of the time from the first scan to the last */
    float step[RHO_MAX_PASSIVE_SCANS];      /* -1 .. 1 */
    struct rho_passive_paper_work per_pair; /* of the last one crossed */
};

struct rho_passive_paper_direction {
    float cosine, sine;
};

/*
 * The middle of a row. Rows before the first and behind the last go on: rho has there the sign that it has beside them,
 * and the row is the other end's turned round.
 */
struct rho_passive_paper_direction
rho_passive_paper_direction(const struct rho_passive_paper_search *search, int row);

/* Crossings of two of the sensors, pruned, into paper->points. */
void rho_passive_paper_cross(struct rho_passive_paper_search *search, unsigned a, unsigned b);

/* The column where a crossing votes, or -1. */
int rho_passive_paper_column(const struct rho_passive_paper_search *search,
                             struct rho_passive_paper_direction direction,
                             const struct rho_passive_paper_point *point);

/* Votes of the crossings in a row. */
void rho_passive_paper_vote_row(const struct rho_passive_paper_search *search, int row,
                                uint8_t counts[RHO_PAPER_RHO_CELLS]);

/* All pairs' votes into paper->cells. */
void rho_passive_paper_vote(struct rho_passive_paper_search *search);

/* Lines from the cells, and their states. */
void rho_passive_paper_choose(struct rho_passive_paper_search *search);
void rho_passive_paper_fit(struct rho_passive_paper_search *search);

#endif
