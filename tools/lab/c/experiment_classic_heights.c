/* SPDX-License-Identifier: MIT */
/*
 * How high a target's own cells are: the most votes of a cell within 40 m and 8 mrad of its line.
 */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "experiment_classic.h"
#include "pipeline/pipeline.h"

#define NEAR_CELLS 8 /* of 5 m and 1 mrad */

/* HT's votes of the cells of a row near rho, from the very cells that the search goes by. */
static double highest_in_row(const struct classic_tools *tools, unsigned theta_cell, int rho_cell)
{
    unsigned votes[2 * NEAR_CELLS + 1] = {0}, most = 0;
    for (uint32_t i = 0; i < tools->plots.scan_end[tools->points.at.num_scans - 1]; i++) {
        int cell =
            rho_accumulator_cell(tools->rows, theta_cell, tools->plots.x_m[i], tools->plots.y_m[i]);
        if (cell >= 0 && abs(cell - rho_cell) <= NEAR_CELLS) {
            unsigned now = ++votes[cell - rho_cell + NEAR_CELLS];
            most = now > most ? now : most;
        }
    }
    return most;
}

/* The plane that HT's cells are counted on. */
static void set_rows(struct classic_tools *tools, const struct rho_hough_config *config)
{
    const struct rho_accumulator_config plane = {.rho_max_m = config->rho_max_m,
                                                 .rho_cell_m = config->rho_cell_m,
                                                 .theta_cell_rad = config->theta_cell_rad,
                                                 .votes = RHO_VOTES_POINTS,
                                                 .min_votes = 1};
    must_succeed(rho_accumulator_init(tools->rows, sizeof *tools->rows, &plane),
                 "rho_accumulator_init");
}

/*
 * The cell of a line, and whether others are near it: round the end of theta, rho changes its sign.
 */
struct cell {
    int theta, rho, theta_cells, rho_cells;
};

static struct cell cell_of(const struct rho_hough *classic, struct classic_line line)
{
    const struct rho_hough_config *config = &classic->config;
    return (struct cell){
        (int)(line.theta_rad / (double)config->theta_cell_rad),
        (int)floor((line.rho_m + (double)config->rho_max_m) / (double)config->rho_cell_m),
        classic->theta_cells, classic->rho_cells};
}

static bool is_near(const struct cell *cell, const struct rho_accumulator_peak *peak)
{
    int rows = peak->theta_cell - cell->theta, rho = cell->rho;
    if (2 * abs(rows) > cell->theta_cells) {
        rows += rows > 0 ? -cell->theta_cells : cell->theta_cells;
        rho = cell->rho_cells - 1 - rho;
    }
    return abs(rows) <= NEAR_CELLS && abs(peak->rho_cell - rho) <= NEAR_CELLS;
}

static double near_votes_of_points(struct classic_tools *tools, struct cell cell)
{
    double most = 0.0;
    for (int row = cell.theta - NEAR_CELLS; row <= cell.theta + NEAR_CELLS; row++) {
        int turns = row < 0 ? 1 : row >= cell.theta_cells ? -1 : 0;
        int rho = turns != 0 ? cell.rho_cells - 1 - cell.rho : cell.rho;
        most = fmax(most, highest_in_row(tools, (unsigned)(row + turns * cell.theta_cells), rho));
    }
    return most;
}

/*
 * Only plots through which a line goes that matters to the cells near the given one: NEAR_CELLS
 * away, a reach farther pairs that vote there, and another one their kernels; and a cell for what
 * is cut off.
 */
static void choose_points(struct classic_tools *tools, const struct rho_hough_config *config,
                          struct classic_line line)
{
    double cells = 3.0 * NEAR_CELLS + 2.0, cosine = cos(line.theta_rad), sine = sin(line.theta_rad);
    double rho_m = cells * (double)config->rho_cell_m;
    double theta_rad = cells * (double)config->theta_cell_rad;
    const struct rho_hough_points *points = &tools->points;
    struct classic_plots *chosen = &tools->chosen;
    uint32_t count = 0, i = 0;
    for (unsigned scan = 0; scan < points->at.num_scans; scan++) {
        for (; i < points->at.scan_end[scan]; i++) {
            double x_m = (double)points->at.x_m[i], y_m = (double)points->at.y_m[i];
            double off_m = fabs(x_m * cosine + y_m * sine - line.rho_m);
            if (off_m <= rho_m + hypot(x_m, y_m) * tan(theta_rad)) {
                chosen->x_m[count] = points->at.x_m[i];
                chosen->y_m[count] = points->at.y_m[i];
                chosen->t_s[count++] = points->t_s[i];
            }
        }
        chosen->scan_end[scan] = count;
    }
}

/* All cells near the line, from the search itself with the plots that matter. */
static double near_votes_of_pairs(struct classic_tools *tools, struct rho_hough_config config,
                                  struct classic_line line)
{
    const struct classic_plots *chosen = &tools->chosen;
    const struct rho_hough_points points = {
        {chosen->x_m, chosen->y_m, tools->points.at.num_scans, chosen->scan_end}, chosen->t_s};
    struct cell cell = cell_of(tools->classic, line);
    choose_points(tools, &config, line);
    config.tau = config.votes_min = 0.0f;
    config.keeps_all_cells = 1;
    struct rho_hough_result result = classic_find(tools, &config, &points);
    for (uint32_t i = 0; i < result.num_peaks; i++) {
        if (is_near(&cell, &tools->peaks[i])) {
            return (double)tools->peaks[i].votes / RHO_HOUGH_VOTE;
        }
    }
    return 0.0;
}

double classic_near_votes(struct classic_tools *tools, const struct rho_hough_config *config,
                          struct classic_line line)
{
    if (config->method == RHO_HOUGH_HT) {
        set_rows(tools, config);
        return near_votes_of_points(tools, cell_of(tools->classic, line));
    }
    return near_votes_of_pairs(tools, *config, line);
}
