/* SPDX-License-Identifier: MIT */
/*
 * The paper's figures: feature space (places) and parameter space (lines), before and after
 * pruning.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "experiment_passive_report.h"
#include "picture/picture.h"

#define PI 3.141592653589793
#define KM(metres) ((metres) / 1e3)
#define VIEW_KM 80
#define RHO_HALF_CELLS 110 /* of 1 km, to either side */
#define THETA_CELLS 90
#define SENSORS_MAX 3

static const char *const pair_names[] = {"sensors 1 and 2", "sensors 1 and 3", "sensors 2 and 3"};
static const size_t pairs[][2] = {{0, 1}, {0, 2}, {1, 2}};
#define PAIRS 3
static const double sizes[] = {1.5, 1.0, 0.6}; /* of markers, so that none hides another */

/* ---- crossings ------------------------------------------------------------------------------- */

static struct rho_crossing crossing_of(const struct passive_scene *scene, size_t scan,
                                       const size_t pair[2], size_t i, size_t j)
{
    struct rho_crossing_base base = passive_base(scene, pair[0], pair[1]);
    struct rho_crossing crossing = {.x_m = 0.0f};
    const struct simulated_look *a = passive_look(scene, scan, pair[0]);
    const struct simulated_look *b = passive_look(scene, scan, pair[1]);
    rho_crossing_find(&base, (float)a->bearings[i].bearing_rad, (float)b->bearings[j].bearing_rad,
                      (float)PASSIVE_RANGE_MAX_M, &crossing);
    return crossing;
}

/* Calls back with each crossing of a pair that the rule leaves. */
static void each_crossing(const struct passive_scene *scene, const size_t pair[2],
                          enum rho_ghost_rule rule,
                          void (*take)(void *context, size_t scan, bool is_target,
                                       const struct rho_crossing *crossing),
                          void *context)
{
    for (size_t scan = 0; scan < PASSIVE_SCANS; scan++) {
        struct rho_ghost_matrix matrix = passive_matrix(scene, scan, pair[0], pair[1], rule);
        for (size_t i = 0; i < matrix.rows; i++) {
            for (size_t j = 0; j < matrix.columns; j++) {
                if (matrix.reason[i][j] == RHO_GHOST_KEPT) {
                    struct rho_crossing crossing = crossing_of(scene, scan, pair, i, j);
                    take(context, scan, passive_is_target(scene, scan, pair[0], i, pair[1], j),
                         &crossing);
                }
            }
        }
    }
}

/* ---- feature space --------------------------------------------------------------------------- */

static void put_truth(FILE *file, const struct passive_scene *scene)
{
    fprintf(file, "$truth << EOD\n");
    for (size_t target = 0; target < scene->of->targets; target++) {
        for (size_t scan = 0; scan < PASSIVE_SCANS; scan++) {
            struct truth_point truth = passive_truth(scene, target, scene->times_s[scan]);
            fprintf(file, "%.4f %.4f\n", KM(truth.x_m), KM(truth.y_m));
        }
        fprintf(file, "\n\n");
    }
    fprintf(file, "EOD\n$sensors << EOD\n");
    for (size_t sensor = 0; sensor < scene->of->sensors; sensor++) {
        fprintf(file, "%.4f %.4f %zu\n", KM(scene->plan.passive.sensors[sensor].x_m),
                KM(scene->plan.passive.sensors[sensor].y_m), sensor + 1);
    }
    fprintf(file, "EOD\n");
}

/* One kind of crossings. */
struct kind {
    FILE *file;
    bool targets, ghosts;
};

static void put_crossing(void *context, size_t scan, bool is_target,
                         const struct rho_crossing *crossing)
{
    struct kind *kind = context;
    (void)scan;
    if (is_target ? kind->targets : kind->ghosts) {
        fprintf(kind->file, "%.4f %.4f\n", KM((double)crossing->x_m), KM((double)crossing->y_m));
    }
}

/* Where there is none, a place outside the picture: gnuplot has no empty data. */
static void put_crossings(const char *name, struct kind kind, const struct passive_scene *scene,
                          const size_t pair[2], enum rho_ghost_rule rule)
{
    fprintf(kind.file, "$%s << EOD\n1000 1000\n", name);
    each_crossing(scene, pair, rule, put_crossing, &kind);
    fprintf(kind.file, "EOD\n");
}

static void put_map(FILE *file)
{
    fprintf(file,
            "set size ratio -1\nset xlabel 'x (km)'\nset ylabel 'y (km)'\n"
            "set xrange [-%d:%d]\nset yrange [-%d:%d]\nset key outside top center horizontal\n"
            "set label 1 '1' at 0,-10 offset -2.2,0\nset label 2 '2' at 0,10 offset -2.2,0\n",
            VIEW_KM, VIEW_KM, VIEW_KM, VIEW_KM);
}

static const char truth_and_sensors[] =
    " $truth with points pt 6 ps 1.6 lw 1 lc rgb '#000000' title 'true positions', \\\n"
    " $sensors with points pt 9 ps 1.2 lc rgb '#009e73' title 'sensors'\n";

static void draw_two(const struct passive_scene *scene, enum rho_ghost_rule rule, const char *path)
{
    struct picture picture = picture_open(path, 860, 860);
    FILE *file = picture.script;
    put_truth(file, scene);
    put_crossings("own", (struct kind){file, true, false}, scene, pairs[0], rule);
    put_crossings("ghosts", (struct kind){file, false, true}, scene, pairs[0], rule);
    put_map(file);
    fprintf(file,
            "plot $own with points pt 2 ps 1 lw 2 lc rgb '#0072b2' title 'crossings, of "
            "targets', \\\n"
            " $ghosts with points pt 2 ps 1 lw 2 lc rgb '#d55e00' title 'ghosts', \\\n%s",
            truth_and_sensors);
    picture_close(&picture);
}

static void draw_three(const struct passive_scene *scene, const char *path)
{
    struct picture picture = picture_open(path, 860, 860);
    FILE *file = picture.script;
    put_truth(file, scene);
    for (size_t i = 0; i < PAIRS; i++) {
        char name[16];
        snprintf(name, sizeof name, "pair%zu", i);
        put_crossings(name, (struct kind){file, true, true}, scene, pairs[i], RHO_GHOST_LITERAL);
    }
    put_map(file);
    fprintf(file, "set label 3 '3' at 10,0 offset 1.3,0\nplot");
    for (size_t i = 0; i < PAIRS; i++) {
        fprintf(file, " $pair%zu with points pt 2 ps %g lw 2 lc rgb '%s' title '%s', \\\n", i,
                sizes[i], picture_colour(i == 2 ? 4 : i), pair_names[i]);
    }
    fprintf(file, "%s", truth_and_sensors);
    picture_close(&picture);
}

/* ---- parameter space ------------------------------------------------------------------------- */

static void put_true_lines(FILE *file, const struct passive_scene *scene)
{
    fprintf(file, "$lines << EOD\n");
    for (size_t target = 0; target < scene->of->targets; target++) {
        struct truth_point truth = passive_truth(scene, target, 0.0);
        struct passive_line line =
            passive_line_of(truth.x_m, truth.y_m, truth.vx_mps, truth.vy_mps);
        fprintf(file, "%.4f %.4f\n", KM(line.rho_m), line.theta_rad * 180.0 / PI);
    }
    fprintf(file, "EOD\n");
}

/* A bit a scan, as the paper's method votes. */
struct plane {
    unsigned scans[THETA_CELLS][2 * RHO_HALF_CELLS];
};

static void vote(void *context, size_t scan, bool is_target, const struct rho_crossing *crossing)
{
    struct plane *plane = context;
    (void)is_target;
    for (int row = 0; row < THETA_CELLS; row++) {
        double theta_rad = (row + 0.5) * PI / THETA_CELLS;
        double rho_km =
            KM((double)crossing->x_m * cos(theta_rad) + (double)crossing->y_m * sin(theta_rad));
        int column = (int)floor(rho_km) + RHO_HALF_CELLS;
        if (column >= 0 && column < 2 * RHO_HALF_CELLS) {
            plane->scans[row][column] |= 1u << scan;
        }
    }
}

static int count_votes(unsigned scans)
{
    int count = 0;
    for (; scans != 0; scans &= scans - 1u) {
        count++;
    }
    return count;
}

/* Cells with so many votes, and one outside the picture: gnuplot has no empty data. */
static void put_plane(FILE *file, const struct plane *plane, int votes_min)
{
    fprintf(file, "$plane << EOD\n1000 1000 0\n");
    for (int row = 0; row < THETA_CELLS; row++) {
        for (int column = 0; column < 2 * RHO_HALF_CELLS; column++) {
            int votes = count_votes(plane->scans[row][column]);
            if (votes >= votes_min) {
                fprintf(file, "%g %g %d\n", column + 0.5 - RHO_HALF_CELLS,
                        (row + 0.5) * 180.0 / THETA_CELLS, votes);
            }
        }
    }
    fprintf(file, "EOD\n");
}

static void put_parameter_axes(FILE *file)
{
    fprintf(file,
            "set xlabel 'rho (km)'\nset ylabel 'theta (degrees)'\nset xrange [-%d:%d]\n"
            "set yrange [0:180]\nset ytics 30\nset key outside top center horizontal\n",
            RHO_HALF_CELLS - 10, RHO_HALF_CELLS - 10);
}

static void draw_plane(const struct passive_scene *scene, enum rho_ghost_rule rule, int votes_min,
                       const char *path)
{
    struct picture picture = picture_open(path, 1000, 640);
    struct plane *plane = must_calloc(1, sizeof *plane);
    each_crossing(scene, pairs[0], rule, vote, plane);
    put_plane(picture.script, plane, votes_min);
    put_true_lines(picture.script, scene);
    put_parameter_axes(picture.script);
    fprintf(picture.script,
            "set palette maxcolors 8\n"
            "set palette defined (1 '#dfe7ee', 4 '#8fa5b5', 6 '#f0d000', 7 '#e06000', 8 "
            "'#8b0000')\nset cbrange [0.5:8.5]\nset cbtics 1,1,8\nset cblabel 'scans that "
            "voted'\nset style fill solid noborder\n"
            "plot $plane using 1:2:(0.5):(%g):3 with boxxyerror lc palette notitle, \\\n"
            " $lines with points pt 6 ps 2.4 lw 2 lc rgb '#0072b2' title 'true lines'\n",
            90.0 / THETA_CELLS);
    picture_close(&picture);
    free(plane);
}

static void put_found_lines(FILE *file, const char *name, const struct rho_passive_paper *paper)
{
    fprintf(file, "$%s << EOD\n1000 1000\n", name);
    for (unsigned i = 0; i < paper->num_lines; i++) {
        fprintf(file, "%.4f %.4f\n", KM((double)paper->lines[i].rho_m),
                (double)paper->lines[i].theta_rad * 180.0 / PI);
    }
    fprintf(file, "EOD\n");
}

/* Lines of each pair of sensors, and those that all confirm. */
static void draw_pairs(const struct passive_scene *scene, const struct passive_figure *figures,
                       const char *path)
{
    struct picture picture = picture_open(path, 1000, 640);
    struct rho_passive_paper *paper = must_alloc(sizeof *paper);
    FILE *file = picture.script;
    put_true_lines(file, scene);
    for (size_t i = 0; i <= PAIRS; i++) {
        char name[16];
        snprintf(name, sizeof name, "pair%zu", i);
        passive_paper_search(paper, scene, figures[i].mask, figures[i].votes_min, figures[i].rule);
        put_found_lines(file, name, paper);
    }
    put_parameter_axes(file);
    fprintf(file, "plot");
    for (size_t i = 0; i < PAIRS; i++) {
        fprintf(file, " $pair%zu with points pt %d ps %g lw 2 lc rgb '%s' title '%s', \\\n", i,
                picture_marker(i), 1.4 * sizes[i], picture_colour(i == 2 ? 4 : i), pair_names[i]);
    }
    fprintf(file,
            " $pair%d with points pt 4 ps 3.2 lw 2 lc rgb '#7f7f7f' title 'confirmed by all', \\\n"
            " $lines with points pt 6 ps 2.4 lw 2 lc rgb '#000000' title 'true lines'\n",
            PAIRS);
    picture_close(&picture);
    free(paper);
}

/* ---- all of them ----------------------------------------------------------------------------- */

static char *figure_path(const char *folder, int number)
{
    char name[32];
    snprintf(name, sizeof name, "figure-%d.svg", number);
    return path_join(folder, name);
}

static void draw_spaces(const char *folder, const struct passive_scene *scene,
                        enum rho_ghost_rule rule, const int numbers[3], unsigned votes_min)
{
    char *places = figure_path(folder, numbers[0]), *votes = figure_path(folder, numbers[1]);
    char *accepted = figure_path(folder, numbers[2]);
    draw_two(scene, rule, places);
    draw_plane(scene, rule, 1, votes);
    draw_plane(scene, rule, (int)votes_min, accepted);
    free(places);
    free(votes);
    free(accepted);
}

void passive_draw_pictures(const struct passive_figure figures[PASSIVE_FIGURES], const char *folder)
{
    struct passive_scene two = passive_figures_scene(2), three = passive_figures_scene(SENSORS_MAX);
    char *places = figure_path(folder, 4), *lines = figure_path(folder, 5);
    draw_spaces(folder, &two, figures[0].rule, (const int[]){2, 6, 7}, figures[0].votes_min);
    draw_spaces(folder, &two, figures[1].rule, (const int[]){3, 8, 9}, figures[1].votes_min);
    draw_three(&three, places);
    draw_pairs(&three, &figures[2], lines);
    free(places);
    free(lines);
    passive_scene_free(&two);
    passive_scene_free(&three);
}
