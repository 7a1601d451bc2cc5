/* SPDX-License-Identifier: MIT */
#include "picture/plot_parameter_space.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "io/scans/plot_reader.h"
#include "picture/plan_view_map.h"
#include "rhotrack/config.h"
#include "rhotrack/detail/angle.h"

#define PI 3.14159265358979323846

#define RHO_CELLS 480
#define THETA_CELLS 540

struct votes {
    double rho_min_m, rho_max_m;
    uint16_t count[RHO_CELLS][THETA_CELLS];
};

static double theta_of_cell_rad(int cell)
{
    return (cell + 0.5) * PI / THETA_CELLS;
}

static double rho_of_plot_m(const struct rho_plot *plot, double theta)
{
    return (double)plot->x_m * cos(theta) + (double)plot->y_m * sin(theta);
}

/* Counts the plot in one rho cell for each theta cell: the cells of all lines through it. */
static void cast_votes_of_plot(struct votes *votes, const struct rho_plot *plot)
{
    double cells_per_m = RHO_CELLS / (votes->rho_max_m - votes->rho_min_m);
    for (int t = 0; t < THETA_CELLS; t++) {
        int cell =
            (int)((rho_of_plot_m(plot, theta_of_cell_rad(t)) - votes->rho_min_m) * cells_per_m);
        votes->count[cell][t] = (uint16_t)(votes->count[cell][t] + 1u);
    }
}

static void put_votes(FILE *script, const struct votes *votes, double unit_m)
{
    fprintf(script, "$votes << EOD\n");
    for (int r = 0; r < RHO_CELLS; r++) {
        double width_m = (votes->rho_max_m - votes->rho_min_m) / RHO_CELLS;
        double rho = (votes->rho_min_m + (r + 0.5) * width_m) / unit_m;
        for (int t = 0; t < THETA_CELLS; t++) {
            fprintf(script, "%.5g %.5g %d\n", theta_of_cell_rad(t) * 180.0 / PI, rho,
                    votes->count[r][t]);
        }
        fprintf(script, "\n");
    }
    fprintf(script, "EOD\n");
}

/* Writes theta and rho of the tracks' lines. */
static void put_track_lines(FILE *script, const struct plot_points *tracks, double unit_m)
{
    struct plot_points one;
    size_t at = 0;
    fprintf(script, "$lines << EOD\n");
    while (picture_data_next_identity(tracks, &at, &one)) {
        const struct plot_point *end = &one.list[one.count - 1];
        struct rho_line line = rho_angle_line((float)end->x_m, (float)end->y_m, (float)end->vx_mps,
                                              (float)end->vy_mps);
        fprintf(script, "%.5g %.5g %d\n", line.theta_rad * 180.0 / PI, line.rho_m / unit_m,
                end->id);
    }
    fprintf(script, "EOD\n");
}

/*
 * Reads the plots again as scans and returns the last ones: the table of plots does not show which
 * belong to one scan.
 */
struct revolutions plot_parameter_space_read(const struct picture_data *data,
                                             const struct parameters *parameters, size_t scans)
{
    uint32_t num_plots = 0;
    for (int i = 0; i < data->num_plot_paths; i++) {
        if (regular_file_size_or_zero(data->plot_paths[i]) == 0) {
            fail(EXIT_USAGE,
                 "plot parameter-space: %s: plots are read twice and cannot come through a pipe",
                 data->plot_paths[i]);
        }
    }
    struct plot_reader *reader =
        plot_reader_open_sensorless(data->plot_paths, data->num_plot_paths, parameters);
    struct revolutions revolutions = revolutions_read_last(reader, scans);
    for (size_t i = 0; i < revolutions.count; i++) {
        num_plots += revolutions.list[i].scan.num_plots;
    }
    if (num_plots == 0) {
        fail(EXIT_USAGE, "plot parameter-space: the last %zu scans have no plots",
             revolutions.count);
    }
    plot_reader_close(reader);
    return revolutions;
}

void plot_hough_votes(struct picture *picture, const struct picture_data *data,
                      const struct revolutions *revolutions)
{
    struct votes *votes = must_calloc(1, sizeof *votes);
    votes->rho_min_m = INFINITY;
    votes->rho_max_m = -INFINITY;
    for (size_t i = 0; i < revolutions->count; i++) {
        for (uint32_t p = 0; p < revolutions->list[i].scan.num_plots; p++) {
            for (int t = 0; t < THETA_CELLS; t++) {
                double rho_m = rho_of_plot_m(&revolutions->list[i].plots[p], theta_of_cell_rad(t));
                votes->rho_min_m = fmin(votes->rho_min_m, rho_m - 1.0);
                votes->rho_max_m = fmax(votes->rho_max_m, rho_m + 1.0);
            }
        }
    }
    for (size_t i = 0; i < revolutions->count; i++) {
        for (uint32_t p = 0; p < revolutions->list[i].scan.num_plots; p++) {
            cast_votes_of_plot(votes, &revolutions->list[i].plots[p]);
        }
    }
    double unit_m = votes->rho_max_m - votes->rho_min_m > MAP_KILOMETRES_FROM_M ? 1000.0 : 1.0;
    put_votes(picture->script, votes, unit_m);
    put_track_lines(picture->script, &data->tracks, unit_m);
    picture_set_title(picture, "Parameter space: the lines through the plots of the last %zu scans",
                      revolutions->count);
    fprintf(
        picture->script,
        "set key outside bottom left horizontal\nset xrange [0:180]\nset yrange [%.6g:%.6g]\n"
        "set xtics 30\nset xlabel 'theta, direction of the normal (degrees)'\n"
        "set ylabel 'rho, signed distance from the origin (%s)'\nset cblabel 'plots that voted'\n"
        "set palette defined (0 '#ffffff', 0.15 '#d0dff0', 0.5 '#5a9bd0', 1 '#08306b')\nset "
        "cbrange [0:*]\n"
        "set style textbox opaque fillcolor rgb '#ffffff' noborder margins 0.6,0.4\n"
        "plot $votes using 1:2:3 with image notitle",
        votes->rho_min_m / unit_m, votes->rho_max_m / unit_m, unit_m > 1.0 ? "km" : "m");
    if (data->tracks.count) {
        fprintf(
            picture->script,
            ", \\\n $lines using 1:2 with points pt 6 ps 2.4 lw 3 lc rgb '#ffffff' notitle, \\\n"
            " $lines using 1:2 with points pt 6 ps 2.4 lw 1.6 lc rgb '#d55e00' title 'the tracks'' "
            "lines', \\\n"
            " $lines using 1:2:(sprintf('track %%d', $3)) with labels left boxed offset 1.8,1.1 "
            "tc rgb '#000000' notitle");
    }
    fprintf(picture->script, "\n");
    free(votes);
}
