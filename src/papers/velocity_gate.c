/* SPDX-License-Identifier: MIT */
/*
 * velocity_gate: Hough gate of the paper: in each plane of velocity space, the line (rho, theta)
 * on which a straight target's velocity stays; plots are gated by their distance from it.
 */
#include <stddef.h>
#include <stdint.h>

#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/gate.h"

#define PLANES_ALL (RHO_GATE_PLANE_XY | RHO_GATE_PLANE_XZ | RHO_GATE_PLANE_YZ)

/* the two velocity components that span each plane */
static const uint8_t axes_of[RHO_GATE_PLANES][2] = {{0, 1}, {0, 2}, {1, 2}};

static float cell_centre_rad(int32_t cell, float theta_cell_rad)
{
    return ((float)cell + 0.5f) * theta_cell_rad;
}

/*
 * The theta cell with the centre nearest to an angle in [0, pi), a circle: the last cell and the
 * first are neighbours. An angle on the border of two cells gets the lower one.
 */
static int32_t nearest_theta_cell(float theta_rad, float theta_cell_rad, int32_t num)
{
    int32_t cell = (int32_t)(theta_rad / theta_cell_rad);

    if (cell >= num) {
        cell = num - 1;
    } else if (cell > 0 && theta_rad - (float)cell * theta_cell_rad < TIE_RAD) {
        cell -= 1;
    }
    const float off_rad = rho_magnitude(cell_centre_rad(cell, theta_cell_rad) - theta_rad);
    const float first_rad = cell_centre_rad(0, theta_cell_rad) + RHO_PI - theta_rad;
    const float last_rad = theta_rad + RHO_PI - cell_centre_rad(num - 1, theta_cell_rad);
    if (first_rad < off_rad + TIE_RAD) {
        return 0;
    }
    return last_rad < off_rad - TIE_RAD ? num - 1 : cell;
}

/*
 * The cell centre theta at which a change (da, db) of the velocity changes rho least: rho changes
 * by |d| |cos(theta - phi)|, phi the direction of the change, so that theta is at right angles to
 * phi. Without a change the first cell is taken.
 */
static float theta_of_least_rho_change(float da, float db, float theta_cell_rad, int32_t num_cells)
{
    float theta_rad;

    if (!(da < 0.0f || da > 0.0f || db < 0.0f || db > 0.0f)) {
        return cell_centre_rad(0, theta_cell_rad);
    }
    theta_rad = rho_atan2(da, -db);
    if (theta_rad < 0.0f) {
        theta_rad += RHO_PI;
    }
    if (theta_rad >= RHO_PI) {
        theta_rad = 0.0f;
    }
    return cell_centre_rad(nearest_theta_cell(theta_rad, theta_cell_rad, num_cells),
                           theta_cell_rad);
}

enum rho_status rho_gate_hough_init(struct rho_gate_hough *hough, uint8_t plane_mask,
                                    float theta_cell_rad, const float before_mps[3],
                                    const float newest_mps[3])
{
    float change_mps[3];

    if (hough == NULL || before_mps == NULL || newest_mps == NULL) {
        return RHO_ERROR_NULL;
    }
    if (plane_mask == 0 || plane_mask > PLANES_ALL ||
        !(theta_cell_rad >= 1.0e-3f && theta_cell_rad <= RHO_HALF_PI)) {
        return RHO_ERROR_VALUE;
    }
    for (int i = 0; i < 3; i++) {
        change_mps[i] = newest_mps[i] - before_mps[i];
        if (!rho_is_finite(newest_mps[i]) || !rho_is_finite(change_mps[i])) {
            return RHO_ERROR_VALUE;
        }
    }
    /* the number of theta cells whose centre is below pi */
    int32_t num_cells = (int32_t)(RHO_PI / theta_cell_rad + 0.5f);
    num_cells -= !(cell_centre_rad(num_cells - 1, theta_cell_rad) < RHO_PI);
    *hough = (struct rho_gate_hough){.planes = plane_mask,
                                     .newest_mps = {newest_mps[0], newest_mps[1], newest_mps[2]}};
    for (int plane = 0; plane < RHO_GATE_PLANES; plane++) {
        if (plane_mask & (1u << plane)) {
            const uint8_t *axes = axes_of[plane];
            float theta_rad = theta_of_least_rho_change(change_mps[axes[0]], change_mps[axes[1]],
                                                        theta_cell_rad, num_cells);
            hough->cos_theta[plane] = rho_cos(theta_rad);
            hough->sin_theta[plane] = rho_sin(theta_rad);
        }
    }
    return RHO_OK;
}

/* Distance of a velocity change from the line in a plane; 0 where cosine and sine are 0. */
static float plane_distance_mps(const struct rho_gate_hough *hough, int plane, float a_mps,
                                float b_mps)
{
    return rho_magnitude(a_mps * hough->cos_theta[plane] + b_mps * hough->sin_theta[plane]);
}

float rho_gate_hough_distance_mps(const struct rho_gate_hough *hough, const float velocity_mps[3])
{
    const float x_mps = velocity_mps[0] - hough->newest_mps[0];
    const float y_mps = velocity_mps[1] - hough->newest_mps[1];
    const float z_mps = velocity_mps[2] - hough->newest_mps[2];

    return plane_distance_mps(hough, 0, x_mps, y_mps) + plane_distance_mps(hough, 1, x_mps, z_mps) +
           plane_distance_mps(hough, 2, y_mps, z_mps);
}
