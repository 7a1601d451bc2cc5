/* SPDX-License-Identifier: MIT */
/*
 * plane: a window of a parameter space in the caller's memory, cell by cell or made small.
 *
 *     window of cells       picture of 2 x 3, each the most votes of its block
 *     0 1 | 0 0 | 0 2
 *     0 0 | 0 7 | 0 0        1 7 2
 *     ----+-----+----
 *     0 3 | 0 0 | 1 1        3 0 1
 *
 * A search does not keep its plane: it is too large (accumulator.h). The points that it had are
 * kept, and rho_hough_plane and rho_passive_paper_plane let them vote again.
 *
 * Stack: 32 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_PLANE_H
#define RHOTRACK_PLANE_H

#include <stdint.h>

#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rho_plane {
    /* the window, in cells; no cells of theta, or of rho: all of them, from the first */
    uint16_t first_theta, theta_cells, first_rho, rho_cells;
    uint16_t height, width; /* of the picture, at most the window's cells: rows of theta, of rho */
    uint32_t *votes;        /* height x width, row by row; the caller's */
};

/*
 * Completes the window, and clears the picture.
 *   theta_cells, rho_cells  of the whole plane
 * Errors: NULL, VALUE (a window beyond the plane, or a picture without cells or with more than it).
 * Cost: the picture. Stack: 120 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_plane_open(struct rho_plane *plane, unsigned theta_cells,
                                              unsigned rho_cells);

/* A cell of the whole plane has so many votes; outside of the window it is left out. */
void rho_plane_note(struct rho_plane *plane, unsigned theta_cell, unsigned rho_cell,
                    uint32_t votes);

#ifdef __cplusplus
}
#endif

#endif
