/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/votes_picture.h"

#include <string.h>

/* True where the window lies within all cells, and the picture's size is 1 .. the window's. */
static int is_window_valid(unsigned first, unsigned count, unsigned size, unsigned all)
{
    return count > 0 && first + count <= all && size > 0 && size <= count;
}

enum rho_status rho_votes_picture_init(struct rho_votes_picture *plane, unsigned theta_cells,
                                       unsigned rho_cells)
{
    if (!plane || !plane->votes) {
        return RHO_ERROR_NULL;
    }
    struct rho_votes_picture whole = *plane;
    if (whole.theta_cells == 0) {
        whole.first_theta = 0;
        whole.theta_cells = (uint16_t)theta_cells;
    }
    if (whole.rho_cells == 0) {
        whole.first_rho = 0;
        whole.rho_cells = (uint16_t)rho_cells;
    }
    if (!is_window_valid(whole.first_theta, whole.theta_cells, whole.height, theta_cells) ||
        !is_window_valid(whole.first_rho, whole.rho_cells, whole.width, rho_cells)) {
        return RHO_ERROR_VALUE;
    }
    *plane = whole;
    memset(plane->votes, 0, (size_t)plane->height * plane->width * sizeof plane->votes[0]);
    return RHO_OK;
}

void rho_votes_picture_enter_cell(struct rho_votes_picture *plane, unsigned theta_cell,
                                  unsigned rho_cell, uint32_t votes)
{
    const unsigned row = theta_cell - plane->first_theta, column = rho_cell - plane->first_rho;
    if (row >= plane->theta_cells || column >= plane->rho_cells) {
        return; /* cells before the window wrap to large numbers, and are left out too */
    }
    const unsigned y = row * plane->height / plane->theta_cells;
    const unsigned x = column * plane->width / plane->rho_cells;
    uint32_t *most = &plane->votes[y * plane->width + x];
    *most = votes > *most ? votes : *most;
}
