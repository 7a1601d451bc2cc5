/* SPDX-License-Identifier: MIT */
/*
 * passive_paper_search: state of one search by the paper's passive Hough transform, and
 * the functions that its files share.
 *
 * - passive_paper_votes.c: pairs of sensors, crossings, votes, confirmation by all pairs
 * - passive_paper_lines.c: the choice of the lines, and the fits through their crossings
 * - passive_paper.c: configuration, frames, the sequence of steps of a search
 * - passive_paper_view.c: intermediate results of a search: ghost matrices, planes of votes
 */
#ifndef RHOTRACK_PASSIVE_PAPER_SEARCH_H
#define RHOTRACK_PASSIVE_PAPER_SEARCH_H

#include "rhotrack/passive_paper.h"

enum { RHO_PASSIVE_PAPER_MAGIC = 0x50504150 }; /* "PPAP" in ASCII */

/* Values computed once for a search. Positions are relative to the sensors' centroid. */
struct rho_passive_paper_search {
    struct rho_passive_paper *paper;
    float middle_x_m, middle_y_m;
    unsigned num_sensors; /* number of sensors with a scan in the batch */
    uint8_t sensors[RHO_MAX_PASSIVE_SENSORS];
    int rows;     /* number of cells of theta */
    int near;     /* distance at which neighbouring cells confirm a cell: 0 or 1 */
    float half_s; /* half the time from the first scan to the last */
    /* time of each scan, from -1 for the first to 1 for the last */
    float step[RHO_MAX_PASSIVE_SCANS];
    struct rho_passive_paper_work per_pair; /* counters of the pair of sensors crossed last */
};

struct rho_passive_paper_direction {
    float cosine, sine;
};

/*
 * Normal of the lines at the centre of a row of theta. Rows before the first and after the last
 * continue theta, and rho with the sign that goes with it.
 */
struct rho_passive_paper_direction
rho_passive_paper_direction(const struct rho_passive_paper_search *search, int row);
/* Sets the search's sensors, those with scans in the batch, and their centroid. */
void rho_passive_paper_list_sensors(const struct rho_batch *batch,
                                    struct rho_passive_paper_search *search);
/*
 * Begins a search: sets sensors and rows, and T, the votes that a cell needs. Returns 0 where the
 * batch has too few scans or sensors to search.
 */
int rho_passive_paper_begin(struct rho_passive_paper *paper,
                            struct rho_passive_paper_search *search);
unsigned rho_passive_paper_theta_rows(const struct rho_passive_paper_config *config);
/*
 * Sets the baseline of two sensors, and fills and prunes the ghost matrix of their bearings in a
 * scan. Returns 0 where they are too near each other.
 */
int rho_passive_paper_fill_ghosts(const struct rho_passive_paper *paper,
                                  const struct rho_passive_paper_search *search,
                                  struct rho_passive_paper_pair pair, unsigned scan,
                                  struct rho_crossing_base *base, struct rho_ghost_matrix *matrix);
/* Crosses two sensors' bearings in all scans; those kept go to paper->points. */
void rho_passive_paper_cross(struct rho_passive_paper_search *search,
                             struct rho_passive_paper_pair pair);
/* Column (cell of rho) in which a crossing votes for lines of a direction; -1: outside. */
int rho_passive_paper_column(const struct rho_passive_paper_search *search,
                             struct rho_passive_paper_direction direction,
                             const struct rho_passive_paper_point *point);
/* Counts the votes of the stored crossings for each cell of a row of theta. */
void rho_passive_paper_count_row(const struct rho_passive_paper_search *search, int row,
                                 uint8_t counts[RHO_PAPER_RHO_CELLS]);
/* Sums the votes of all pairs of sensors into paper->cells, 0 where not all confirm a cell. */
void rho_passive_paper_vote_pairs(struct rho_passive_paper_search *search);
/*
 * Takes the next peak from paper->cells: the highest cell, the middle one of equal neighbours. The
 * cells near it become 0. Returns its height; 0: all cells are 0, and *peak is unchanged.
 */
unsigned rho_passive_paper_take_peak(const struct rho_passive_paper_search *search,
                                     struct rho_accumulator_peak *peak);
/* Chooses lines from the cells, most votes first; then fits position and velocity to each. */
void rho_passive_paper_pick_lines(struct rho_passive_paper_search *search);
void rho_passive_paper_fit_lines(struct rho_passive_paper_search *search);

#endif
