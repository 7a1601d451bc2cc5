/* SPDX-License-Identifier: MIT */
/*
 * votes_picture: a picture of the votes in a window of the parameter plane (rho, theta), cell by
 * cell or reduced, in the caller's memory.
 *
 *     window of cells       picture of 2 x 3, each with the most votes of its block
 *     0 1 | 0 0 | 0 2
 *     0 0 | 0 7 | 0 0        1 7 2
 *     ----+-----+----
 *     0 3 | 0 0 | 1 1        3 0 1
 *
 * A Hough search does not keep its plane, which is too large (accumulator.h). To show it,
 * rho_hough_plane and rho_passive_paper_plane let the points of the search vote again.
 *
 * Stack: 32 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_VOTES_PICTURE_H
#define RHOTRACK_VOTES_PICTURE_H

#include <stdint.h>

#include "rhotrack/types.h"

RHO_BEGIN_C

struct rho_votes_picture {
    /* window of cells to show; theta_cells or rho_cells 0: all cells in that direction */
    uint16_t first_theta, theta_cells, first_rho, rho_cells;
    /* rows (theta) and columns (rho) of the picture, at most as many as the window has */
    uint16_t height, width;
    /* height x width, row by row, of the caller; an element has the most votes of its block */
    uint32_t *votes;
};

/*
 * Checks the window, sets a window without cells to the whole plane, and clears the picture.
 *   theta_cells, rho_cells  size of the whole plane
 * Errors: NULL, VALUE (a window beyond the plane, or a picture that is empty or larger than it).
 * Cost: the picture. Stack: 120 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_votes_picture_init(struct rho_votes_picture *plane,
                                                      unsigned theta_cells, unsigned rho_cells);

/* Enters the votes of a cell of the whole plane; cells outside the window are ignored. */
void rho_votes_picture_enter_cell(struct rho_votes_picture *plane, unsigned theta_cell,
                                  unsigned rho_cell, uint32_t votes);

RHO_END_C

#endif
