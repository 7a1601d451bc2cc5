/* SPDX-License-Identifier: MIT */
/* hough_geometry: (rho, theta) to rows and columns of the plane, and starts of scans. */
#include "hough_search.h"

uint32_t rho_hough_scan_start(const struct rho_hough_points *points, unsigned scan)
{
    return scan > 0 ? points->at.scan_end[scan - 1u] : 0u;
}

int rho_hough_has_row(const struct rho_hough *hough, struct rho_hough_rows rows, int32_t row)
{
    int32_t behind = (row - rows.first) % hough->theta_cells;
    return (behind < 0 ? behind + hough->theta_cells : behind) < rows.count;
}

int32_t rho_hough_row_of_theta(const struct rho_hough *hough, float theta_rad)
{
    int32_t row = (int32_t)(theta_rad / hough->config.theta_cell_rad);
    return row < hough->theta_cells ? row : hough->theta_cells - 1;
}

int32_t rho_hough_column_of_rho(const struct rho_hough *hough, float rho_m)
{
    float column = (rho_m + hough->config.rho_max_m) / hough->config.rho_cell_m;
    return column >= 0.0f && column < (float)hough->rho_cells ? (int32_t)column : -1;
}

float rho_hough_theta_rad(const struct rho_hough *hough, unsigned theta_cell)
{
    return ((float)theta_cell + 0.5f) * hough->config.theta_cell_rad;
}

float rho_hough_rho_m(const struct rho_hough *hough, unsigned rho_cell)
{
    return ((float)rho_cell + 0.5f) * hough->config.rho_cell_m - hough->config.rho_max_m;
}
