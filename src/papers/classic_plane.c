/* SPDX-License-Identifier: MIT */
/*
 * classic_plane: rows and columns of the plane (rho, theta), and where the points of a scan begin.
 */
#include "classic_votes.h"

uint32_t rho_classic_scan_start(const struct rho_classic_points *points, unsigned scan)
{
    return scan > 0 ? points->at.scan_end[scan - 1u] : 0u;
}

int rho_classic_has_row(const struct rho_classic *classic, struct rho_classic_rows rows,
                        int32_t row)
{
    int32_t behind = (row - rows.first) % classic->theta_cells;
    return (behind < 0 ? behind + classic->theta_cells : behind) < rows.count;
}

int32_t rho_classic_row(const struct rho_classic *classic, float theta_rad)
{
    int32_t row = (int32_t)(theta_rad / classic->config.theta_cell_rad);
    return row < classic->theta_cells ? row : classic->theta_cells - 1;
}

int32_t rho_classic_column(const struct rho_classic *classic, float rho_m)
{
    float column = (rho_m + classic->config.rho_max_m) / classic->config.rho_cell_m;
    return column >= 0.0f && column < (float)classic->rho_cells ? (int32_t)column : -1;
}

float rho_classic_theta_rad(const struct rho_classic *classic, unsigned theta_cell)
{
    return ((float)theta_cell + 0.5f) * classic->config.theta_cell_rad;
}

float rho_classic_rho_m(const struct rho_classic *classic, unsigned rho_cell)
{
    return ((float)rho_cell + 0.5f) * classic->config.rho_cell_m - classic->config.rho_max_m;
}
