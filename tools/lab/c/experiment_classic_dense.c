/* SPDX-License-Identifier: MIT */
/*
 * The Hough transform on a plane that is wholly there, as the paper has it: the measure of the
 * other methods' times.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "experiment_classic.h"

struct plane {
    size_t width, height; /* cells of rho, of theta */
    uint16_t *votes;
};

static void vote(const struct plane *plane, const struct classic_tools *tools,
                 const struct rho_hough_config *config)
{
    float per_m = 1.0f / config->rho_cell_m, first = config->rho_max_m * per_m,
          end = (float)plane->width;
    uint32_t count = tools->plots.scan_end[tools->points.at.num_scans - 1];
    for (size_t row = 0; row < plane->height; row++) {
        float theta_rad = ((float)row + 0.5f) * config->theta_cell_rad;
        float by_x = cosf(theta_rad) * per_m, by_y = sinf(theta_rad) * per_m;
        uint16_t *votes = plane->votes + row * plane->width;
        for (uint32_t i = 0; i < count; i++) {
            float cell = tools->plots.x_m[i] * by_x + tools->plots.y_m[i] * by_y + first;
            if (cell >= 0.0f && cell < end) {
                votes[(size_t)cell]++;
            }
        }
    }
}

static uint32_t threshold(const struct plane *plane, float tau)
{
    uint16_t most = 0;
    for (size_t i = 0; i < plane->width * plane->height; i++) {
        most = plane->votes[i] > most ? plane->votes[i] : most;
    }
    double votes = ceil((double)tau * most);
    return votes > 1.0 ? (uint32_t)votes : 1u;
}

static uint32_t take_peaks(const struct plane *plane, const struct rho_hough_config *config,
                           struct classic_tools *tools, uint32_t *scratch, uint32_t num_scratch)
{
    const struct rho_peak_distance distance = {
        (uint16_t)plane->height, (uint16_t)plane->width,
        (uint16_t)lrintf(2.0f * config->eps_theta_rad / config->theta_cell_rad),
        (uint16_t)lrintf(2.0f * config->eps_rho_m / config->rho_cell_m)};
    struct rho_peak_list list = {.peaks = tools->peaks,
                                 .max_peaks = tools->max_peaks,
                                 .min_votes = threshold(plane, config->tau)};
    for (size_t i = 0; i < plane->width * plane->height; i++) {
        if (plane->votes[i] >= list.min_votes) {
            rho_peak_list_add(
                &list, (struct rho_accumulator_peak){.votes = plane->votes[i],
                                                     .theta_cell = (uint16_t)(i / plane->width),
                                                     .rho_cell = (uint16_t)(i % plane->width)});
        }
    }
    rho_peak_list_finish(&list);
    return rho_peak_list_suppress(tools->peaks, list.num_peaks, &distance, scratch, num_scratch);
}

double classic_dense_us(struct classic_tools *tools, const struct rho_hough_config *config,
                        uint32_t *num_peaks)
{
    const uint32_t num_scratch = RHO_MAX_HOUGH_CELLS;
    struct plane plane = {
        .width = (size_t)lrintf(2.0f * config->rho_max_m / config->rho_cell_m),
        .height = (size_t)ceil(3.14159265358979323846 / (double)config->theta_cell_rad)};
    uint32_t *scratch = must_calloc(num_scratch, sizeof *scratch);
    plane.votes = must_calloc(plane.width * plane.height, sizeof *plane.votes);
    memset(plane.votes, 1,
           plane.width * plane.height *
               sizeof *plane.votes); /* the memory is there before time counts */
    int64_t start_us = clock_us();
    memset(plane.votes, 0, plane.width * plane.height * sizeof *plane.votes);
    vote(&plane, tools, config);
    *num_peaks = take_peaks(&plane, config, tools, scratch, num_scratch);
    double time_us = (double)(clock_us() - start_us);
    free(plane.votes);
    free(scratch);
    return time_us;
}
