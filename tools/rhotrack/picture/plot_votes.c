/* SPDX-License-Identifier: MIT */
#include "picture/plot_votes.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "io/scans/hough_batch.h"
#include "picture/plan_view_map.h"

#define THETA_BLOCKS 270
#define RHO_BLOCKS 240
#define PICTURES 4
#define MARGIN_CELLS 10
#define DEGREES_PER_RAD 57.29577951308232

struct plot_votes {
    enum method method;
    unsigned count; /* number of pictures: 4 for the neutrosophic method, else 1 */
    unsigned height, width;
    double from_deg, to_deg, from_m, to_m; /* part of the parameter space that holds all votes */
    uint32_t of[PICTURES][THETA_BLOCKS * RHO_BLOCKS];
};

/* What each picture shows of the cells: their votes, or one of the three sums of memberships. */
static const struct {
    enum rho_hough_component component;
    const char *title;
} pictures[PICTURES] = {{RHO_HOUGH_VOTES, "votes, C"},
                        {RHO_HOUGH_TRUTH, "truth, C_T"},
                        {RHO_HOUGH_INDETERMINACY, "indeterminacy, C_I"},
                        {RHO_HOUGH_FALSITY, "falsity, C_F"}};

static unsigned smaller_of(unsigned cells, unsigned most)
{
    return cells < most ? cells : most;
}

/* A range of cells of one axis of the accumulator. */
struct range {
    unsigned first, last;
};

static void include_block_in_range(struct range *range, unsigned block, unsigned blocks,
                                   unsigned cells)
{
    const unsigned from = block * cells / blocks, to = (block + 1) * cells / blocks;

    range->first = from < range->first ? from : range->first;
    range->last = to > range->last ? to : range->last;
}

static struct range range_with_margin(struct range range, unsigned cells)
{
    if (range.first > range.last) {
        return (struct range){0, cells - 1}; /* no votes: the whole axis */
    }
    range.first -= smaller_of(range.first, MARGIN_CELLS);
    range.last = smaller_of(range.last + MARGIN_CELLS, cells - 1);
    return range;
}

/*
 * Window of accumulator cells with any vote, plus a margin; `whole` holds the last picture's
 * component: of the neutrosophic method falsity, for which every candidate votes.
 */
static struct rho_votes_picture window_around_votes(const struct rho_hough *hough,
                                                    const struct rho_votes_picture *whole)
{
    struct range theta = {hough->theta_cells, 0}, rho = {hough->rho_cells, 0};

    for (unsigned y = 0; y < whole->height; y++) {
        for (unsigned x = 0; x < whole->width; x++) {
            if (whole->votes[y * whole->width + x] > 0) {
                include_block_in_range(&theta, y, whole->height, hough->theta_cells);
                include_block_in_range(&rho, x, whole->width, hough->rho_cells);
            }
        }
    }
    theta = range_with_margin(theta, hough->theta_cells);
    rho = range_with_margin(rho, hough->rho_cells);
    const unsigned rows = theta.last - theta.first + 1, columns = rho.last - rho.first + 1;

    return (struct rho_votes_picture){.first_theta = (uint16_t)theta.first,
                                      .theta_cells = (uint16_t)rows,
                                      .first_rho = (uint16_t)rho.first,
                                      .rho_cells = (uint16_t)columns,
                                      .height = (uint16_t)smaller_of(rows, THETA_BLOCKS),
                                      .width = (uint16_t)smaller_of(columns, RHO_BLOCKS)};
}

static void compute_vote_pictures(struct plot_votes *votes, const struct rho_hough_config *config,
                                  const struct rho_hough_points *points)
{
    struct rho_hough *hough = must_alloc(sizeof *hough);

    must_succeed(rho_hough_init(hough, sizeof *hough, config), "hough");
    struct rho_votes_picture whole = {.height =
                                          (uint16_t)smaller_of(hough->theta_cells, THETA_BLOCKS),
                                      .width = (uint16_t)smaller_of(hough->rho_cells, RHO_BLOCKS),
                                      .votes = votes->of[0]};
    must_succeed(rho_hough_plane(hough, points, pictures[votes->count - 1].component, &whole),
                 "hough");
    struct rho_votes_picture plane = window_around_votes(hough, &whole);
    for (unsigned i = 0; i < votes->count; i++) {
        plane.votes = votes->of[i];
        must_succeed(rho_hough_plane(hough, points, pictures[i].component, &plane), "hough");
    }
    const double cell_deg = (double)config->theta_cell_rad * DEGREES_PER_RAD;

    votes->height = plane.height;
    votes->width = plane.width;
    votes->from_deg = plane.first_theta * cell_deg;
    votes->to_deg = (plane.first_theta + plane.theta_cells) * cell_deg;
    votes->from_m = plane.first_rho * (double)config->rho_cell_m - (double)config->rho_max_m;
    votes->to_m = votes->from_m + plane.rho_cells * (double)config->rho_cell_m;
    free(hough);
}

struct plot_votes *plot_votes_compute_pictures(enum method method,
                                               const struct revolutions *revolutions,
                                               const struct parameters *parameters)
{
    struct parameters fitted = *parameters;
    struct plot_votes *votes = must_calloc(1, sizeof *votes);
    struct hough_batch batch = hough_batch_from_revolutions(revolutions);
    struct rho_hough_points points = hough_batch_points(&batch);

    method_widen_cells_to_range(&fitted, batch.range_m);
    struct rho_hough_config config = method_hough_config(method, &fitted, batch.range_m);

    hough_batch_report_beyond(&batch);
    votes->method = method;
    votes->count = method == METHOD_NHT ? PICTURES : 1;
    compute_vote_pictures(votes, &config, &points);
    hough_batch_free(&batch);
    return votes;
}

/* Largest vote of a picture; 1 where there is none, so that the colour scale is not empty. */
static double max_votes_of_picture(const struct plot_votes *votes, unsigned picture)
{
    uint32_t most = 0;

    for (unsigned i = 0; i < votes->height * votes->width; i++) {
        most = votes->of[picture][i] > most ? votes->of[picture][i] : most;
    }
    return most > 0 ? most / (double)RHO_HOUGH_VOTE : 1.0;
}

static void put_votes_of_picture(FILE *script, const struct plot_votes *votes, unsigned number,
                                 double unit_m)
{
    const double step_m = (votes->to_m - votes->from_m) / votes->width;
    const double step_deg = (votes->to_deg - votes->from_deg) / votes->height;

    fprintf(script, "$of%u << EOD\n", number);
    for (unsigned theta = 0; theta < votes->height; theta++) {
        for (unsigned rho = 0; rho < votes->width; rho++) {
            fprintf(script, "%.5g %.5g %.5g\n", votes->from_deg + (theta + 0.5) * step_deg,
                    (votes->from_m + (rho + 0.5) * step_m) / unit_m,
                    votes->of[number][theta * votes->width + rho] / (double)RHO_HOUGH_VOTE);
        }
        fprintf(script, "\n");
    }
    fprintf(script, "EOD\n");
}

void plot_votes(struct picture *picture, const struct plot_votes *votes)
{
    const double unit_m = votes->to_m - votes->from_m > MAP_KILOMETRES_FROM_M ? 1000.0 : 1.0;
    FILE *script = picture->script;

    for (unsigned i = 0; i < votes->count; i++) {
        put_votes_of_picture(script, votes, i, unit_m);
    }
    fprintf(script,
            "set key off\nset xrange [%.6g:%.6g]\nset yrange [%.6g:%.6g]\n"
            "set xlabel 'theta (degrees)'\nset ylabel 'rho (%s)'\n"
            "set palette defined (0 '#ffffff', 0.02 '#d0dff0', 0.4 '#5a9bd0', 1 '#08306b')\n",
            votes->from_deg, votes->to_deg, votes->from_m / unit_m, votes->to_m / unit_m,
            unit_m > 1.0 ? "km" : "m");
    if (votes->count > 1) {
        fprintf(script, "set multiplot layout 2,2\n");
    }
    for (unsigned i = 0; i < votes->count; i++) {
        fprintf(script,
                "set title '%s: %s' noenhanced\nset cbrange [0:%.6g]\n"
                "plot $of%u using 1:2:3 with image\n",
                method_name(votes->method), pictures[i].title, max_votes_of_picture(votes, i), i);
    }
    if (votes->count > 1) {
        fprintf(script, "unset multiplot\n");
    }
}

void plot_votes_free(struct plot_votes *votes)
{
    free(votes);
}
