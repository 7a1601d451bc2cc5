/* SPDX-License-Identifier: MIT */
/*
 * accumulator_geometry: the plane (rho, theta): number of cells, values at their centres, and the
 * cell of each point in a row of theta, whose loops over points are hot.
 */
#include "accumulator_search.h"
#include "rhotrack/detail/approx.h"

enum rho_status rho_accumulator_count_cells(const struct rho_accumulator_config *config,
                                            uint16_t *theta_cells, uint16_t *rho_cells)
{
    if (!rho_is_within(config->rho_cell_m, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_POSITION_M) ||
        !rho_is_within(config->rho_max_m, 0.5f * config->rho_cell_m,
                       config->rho_cell_m * 0.5f * (float)RHO_MAX_RHO_CELLS) ||
        !rho_is_within(config->theta_cell_rad, 1.0e-4f, RHO_PI) ||
        (config->votes != RHO_VOTES_SCANS && config->votes != RHO_VOTES_POINTS) ||
        config->min_votes < 1 || !rho_is_within(config->min_share, 0.0f, 1.0f) ||
        config->no_pruning > 1) {
        return RHO_ERROR_CONFIG;
    }
    float rows = RHO_PI / config->theta_cell_rad;
    *theta_cells = (uint16_t)((float)(uint16_t)rows < rows ? rows + 1.0f : rows);
    *rho_cells = (uint16_t)(2.0f * config->rho_max_m / config->rho_cell_m + 0.5f);
    return RHO_OK;
}

float rho_accumulator_theta_rad(const struct rho_accumulator *accumulator, unsigned theta_cell)
{
    return ((float)theta_cell + 0.5f) * accumulator->config.theta_cell_rad;
}

struct rho_accumulator_projection
rho_accumulator_projection(const struct rho_accumulator *accumulator, unsigned theta_cell)
{
    float theta_rad = rho_accumulator_theta_rad(accumulator, theta_cell);
    return (struct rho_accumulator_projection){rho_cos(theta_rad) * accumulator->cells_per_m,
                                               rho_sin(theta_rad) * accumulator->cells_per_m,
                                               accumulator->first_cell};
}

void rho_accumulator_project(const float *restrict x_m, const float *restrict y_m, unsigned n,
                             struct rho_accumulator_projection place, int32_t *restrict cells)
{
    for (unsigned i = 0; i < n; i++) {
        cells[i] = (int32_t)(x_m[i] * place.by_x + y_m[i] * place.by_y + place.first);
    }
}

unsigned rho_accumulator_clamp_cells(const float *restrict x_m, const float *restrict y_m,
                                     unsigned n, struct rho_accumulator_projection place,
                                     float last, int32_t *restrict cells)
{
    unsigned outside = 0;
    for (unsigned i = 0; i < n; i++) {
        float cell = x_m[i] * place.by_x + y_m[i] * place.by_y + place.first;
        cell = cell > 0.0f ? cell : 0.0f;
        cell = cell < last ? cell : last;
        cells[i] = (int32_t)cell;
        outside += cells[i] == 0 || cells[i] == (int32_t)last;
    }
    return outside;
}

int rho_accumulator_cell_of_point(const struct rho_accumulator *accumulator, unsigned theta_cell,
                                  float x_m, float y_m)
{
    int32_t cell;
    float last = (float)(accumulator->rho_cells + 1u);
    unsigned outside = rho_accumulator_clamp_cells(
        &x_m, &y_m, 1, rho_accumulator_projection(accumulator, theta_cell), last, &cell);
    return outside ? -1 : cell - 1;
}
