/* SPDX-License-Identifier: MIT */
/* The parameter space of each method as a picture, as in the paper's Figs. 7 .. 10 and 15. */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "experiment_classic.h"
#include "picture/picture.h"
#include "workers.h"

#define CELLS_ROOM 2500000u
#define COLUMNS 125 /* blocks of cells, along rho */
#define ROWS 100    /* along theta */
#define PANELS_ACROSS 3u
#define PANEL_WIDTH 480u
#define PANEL_HEIGHT 390u
#define PLANES_STREAM 4000

/* The highest cell of each block, as a share of the plane's highest. */
struct blocks {
    double share[ROWS][COLUMNS];
    double most; /* votes */
};

static void fill_blocks(struct blocks *blocks, const struct classic_tools *tools,
                        const struct rho_hough_result *result)
{
    const struct rho_hough *classic = tools->classic;
    *blocks = (struct blocks){.most = (double)result->votes_max / RHO_HOUGH_VOTE};
    for (uint32_t i = 0; i < result->num_peaks; i++) {
        const struct rho_accumulator_peak *cell = &tools->peaks[i];
        double *share = &blocks->share[cell->theta_cell * ROWS / classic->theta_cells]
                                      [cell->rho_cell * COLUMNS / classic->rho_cells];
        *share = fmax(*share, (double)cell->votes / (double)result->votes_max);
    }
}

static void put_blocks(FILE *file, const struct blocks *blocks, size_t method)
{
    fprintf(file, "$plane%zu << EOD\n", method);
    for (size_t row = 0; row < ROWS; row++) {
        for (size_t column = 0; column < COLUMNS; column++) {
            fprintf(file, "%.3g ", blocks->share[row][column]);
        }
        fprintf(file, "\n");
    }
    fprintf(file, "EOD\n");
}

static void put_lines(FILE *file, const struct classic_data *data)
{
    fprintf(file, "$lines << EOD\n");
    for (size_t target = 0; target < data->plan.num_targets; target++) {
        struct classic_line line = classic_true_line(&data->plan, target);
        fprintf(file, "%.4f %.4f\n", line.rho_m / 1e3, line.theta_rad);
    }
    fprintf(file, "EOD\n");
}

/* Grey below the threshold, coloured above. */
static void put_look(FILE *file, const struct classic_data *data, size_t across, size_t down)
{
    double half_km = (double)data->situation->rho_max_m / 1e3;
    fprintf(
        file,
        "set palette defined (0 '#ffffff', 0.001 '#d8d8d8', 0.499 '#8a8a8a', 0.5 '#f0d000', 0.75 "
        "'#e06000', 1 "
        "'#8b0000')\nset cbrange [0:1]\nset xrange [%g:%g]\nset yrange [0:3.1416]\nset ytics 1\n"
        "set xlabel 'rho (km)' offset 0,0.4\nset ylabel 'theta (rad)' offset 0.8,0\n"
        "unset colorbox\nunset key\nset grid front lc rgb '#dddddd' lt 1 lw 0.5\n"
        "set multiplot layout %zu,%zu title \"%s\" font ',18' margins %g,0.98,%g,%g "
        "spacing %g,%g\n",
        -half_km, half_km, down, across, data->situation->text, 0.17 / (double)across,
        0.16 / (double)down, 1.0 - 0.2 / (double)down, 0.19 / (double)across, 0.31 / (double)down);
}

/* In the free corner at the lower right, with the last panel. */
static void put_legend(FILE *file, size_t across, size_t down)
{
    double left = (double)(across - 1) / (double)across, width = 1.0 / (double)across;
    double height = 1.0 / (double)down;
    fprintf(
        file,
        "set colorbox horizontal user origin %g,%g size %g,%g\n"
        "set cblabel \"highest cell of a block / highest of all\\ngrey: below tau, not listed\"\n"
        "set key at screen %g,%g right bottom samplen 1 noreverse\n",
        left + 0.2 * width, 0.45 * height, 0.65 * width, 0.06 * height, left + 0.85 * width,
        0.62 * height);
}

static void put_panel(FILE *file, const struct classic_data *data, size_t method, double most)
{
    double width_km = 2.0 * (double)data->situation->rho_max_m / 1e3 / COLUMNS;
    fprintf(
        file,
        "set title '%s: at most %.3g votes'\n"
        "plot $plane%zu matrix using (($1 + 0.5) * %g - %g):(($2 + 0.5) * %g):3 with image "
        "notitle, \\\n $lines with points pt 6 ps 2.2 lw 2 lc rgb '#0072b2' title 'true lines'\n",
        classic_method_names[method], most, method, width_km, width_km * COLUMNS / 2.0,
        3.14159265 / ROWS);
}

static void draw_plane(const struct classic_report *report, struct classic_tools *tools,
                       const struct classic_data *data, const char *path)
{
    size_t count = 0, panel = 0;
    double most[CLASSIC_KERNEL];
    struct blocks *blocks = must_alloc(sizeof *blocks);
    for (size_t method = 0; method < CLASSIC_KERNEL; method++) {
        count += classic_has(report, method);
    }
    size_t across = count + 1 < PANELS_ACROSS ? count + 1 : PANELS_ACROSS;
    size_t down = (count + across) / across;
    struct picture picture =
        picture_open(path, (int)(across * PANEL_WIDTH), (int)(down * PANEL_HEIGHT + 40u));
    put_lines(picture.script, data);
    for (size_t method = 0; method < CLASSIC_KERNEL; method++) {
        if (classic_has(report, method)) {
            struct rho_hough_config config = classic_config(data->situation, method);
            config.tau = 0.0f;
            config.keeps_all_cells = 1;
            struct rho_hough_result result = classic_find(tools, &config, &tools->points);
            fill_blocks(blocks, tools, &result);
            put_blocks(picture.script, blocks, method);
            most[method] = blocks->most;
        }
    }
    put_look(picture.script, data, across, down);
    for (size_t method = 0; method < CLASSIC_KERNEL; method++) {
        if (classic_has(report, method)) {
            if (++panel == count) {
                put_legend(picture.script, across, down);
            }
            put_panel(picture.script, data, method, most[method]);
        }
    }
    fprintf(picture.script, "unset multiplot\n");
    picture_close(&picture);
    free(blocks);
}

/* ---- all of them ----------------------------------------------------------------------------- */

struct gallery {
    const struct classic_report *report;
    const char *folder;
    struct classic_tools tools[WORKERS_MAX];
};

void classic_plane_name(char name[32], size_t situation)
{
    snprintf(name, 32, "situation-%s.svg", classic_situations[situation].name);
    for (char *at = name; *at; at++) {
        *at = *at == ' ' ? '-' : *at;
    }
}

static void draw_one(void *context, size_t worker, size_t index)
{
    struct gallery *gallery = context;
    struct classic_tools *tools = &gallery->tools[worker];
    const struct classic_situation *situation = &classic_situations[index];
    if (situation->figure == NULL) {
        return;
    }
    if (tools->classic == NULL) {
        *tools = classic_tools_start(CELLS_ROOM);
    }
    char name[32];
    classic_plane_name(name, index);
    char *path = path_join(gallery->folder, name);
    struct classic_data data =
        classic_simulate(situation, gallery->report->seed, PLANES_STREAM, index);
    classic_load(tools, &data);
    draw_plane(gallery->report, tools, &data, path);
    classic_data_free(&data);
    free(path);
}

void classic_draw_planes(const struct classic_report *report, const char *folder)
{
    struct gallery gallery = {.report = report, .folder = folder};
    workers_run(SITUATIONS, "pictures", draw_one, &gallery);
    for (size_t i = 0; i < WORKERS_MAX; i++) {
        classic_tools_free(&gallery.tools[i]);
    }
}
