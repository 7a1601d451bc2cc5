/* SPDX-License-Identifier: MIT */
/*
 * experiment_two_radars_page: the tables as a page, with pictures of one run and of the biases'
 * errors.
 */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "experiment_two_radars.h"
#include "page.h"
#include "picture/picture.h"

#define DEG_RAD 0.017453292519943295
#define KM(metres) ((metres) / 1e3)
#define ZOOM_S 80.0

/* ---- one run --------------------------------------------------------------------------------- */

static void put_way(FILE *file, const struct scene_path *path, double from_s, double until_s,
                    double step_s)
{
    const int steps = (int)((until_s - from_s) / step_s);

    for (int i = 0; i <= steps; i++) {
        struct motion at = path_at(path, from_s + i * step_s);

        fprintf(file, "%.4f %.4f\n", KM(at.x_m), KM(at.y_m));
    }
}

static void put_paths(FILE *file, const struct scene_run *run)
{
    fprintf(file, "$paths << EOD\n");
    for (size_t target = 0; target < run->num_paths; target++) {
        put_way(file, &run->paths[target], 0.0, run->scene->duration_s, 5.0);
        fprintf(file, "\n\n");
    }
    fprintf(file, "EOD\n");
}

static void put_radars(FILE *file, const struct scene *scene)
{
    fprintf(file, "$reach << EOD\n");
    for (size_t a = 0; a < RADARS; a++) {
        const struct scene_sensor *radar = &scene->sensors[a];

        for (int i = 0; i <= 90; i++) {
            double range_m = radar->coverage.range_m.hi;

            fprintf(file, "%.3f %.3f\n", KM(radar->x_m + range_m * cos(4.0 * i * DEG_RAD)),
                    KM(radar->y_m + range_m * sin(4.0 * i * DEG_RAD)));
        }
        fprintf(file, "\n\n");
    }
    fprintf(file, "EOD\n$radars << EOD\n");
    for (size_t a = 0; a < RADARS; a++) {
        fprintf(file, "%.3f %.3f\n", KM(scene->sensors[a].x_m), KM(scene->sensors[a].y_m));
    }
    fprintf(file, "EOD\n");
}

static void draw_map(const struct scene_run *run, const char *path)
{
    struct picture picture = picture_open(path, 900, 800);

    put_paths(picture.script, run);
    put_radars(picture.script, run->scene);
    fprintf(picture.script,
            "set size ratio -1\nset xlabel 'x east (km)'\nset ylabel 'y north (km)'\n"
            "plot $reach with lines lw 1.5 dt 2 lc rgb '#808080' title 'how far they see', \\\n"
            " $radars with points pt 9 ps 2 lc rgb '#d55e00' title 'radars', \\\n"
            " $paths with lines lw 2 lc rgb '#0072b2' title 'aircraft'\n");
    picture_close(&picture);
}

/* ---- one aircraft ---------------------------------------------------------------------------- */

/* The target that is nearest to a place half-way between the radars, and north, at half time. */
static size_t choose_target(const struct scene_run *run, double middle_s)
{
    double nearest_m = INFINITY;
    size_t chosen = 0;

    for (size_t target = 0; target < run->num_paths; target++) {
        struct motion at = path_at(&run->paths[target], middle_s);
        double distance_m = hypot(at.x_m - 40000.0, at.y_m - 40000.0);

        if (distance_m < nearest_m) {
            nearest_m = distance_m;
            chosen = target;
        }
    }
    return chosen;
}

static void put_plots(FILE *file, const struct scene_run *run, size_t radar, size_t target,
                      double middle_s, const struct radars_found *found)
{
    const struct scene_sensor *sensor = &run->scene->sensors[radar];
    double off_m = sensor->range_bias_m + (found ? found->off[radar][REGISTER_RANGE] : 0.0);
    double off_rad = sensor->azimuth_bias_rad + (found ? found->off[radar][REGISTER_AZIMUTH] : 0.0);

    fprintf(file, "$%s%zu << EOD\n", found ? "right" : "raw", radar + 1);
    for (size_t i = 0; i < run->num_scans; i++) {
        const struct scene_scan *scan = &run->scans[i];

        for (size_t k = 0; scan->sensor == radar && k < scan->num_plots; k++) {
            const struct scene_plot *plot = &scan->plots[k];
            double range_m = plot->range_m - (found ? off_m : 0.0);
            double azimuth_rad = plot->azimuth_rad - (found ? off_rad : 0.0);

            if (plot->target_id == (int)target && fabs(plot->t_s - middle_s) < ZOOM_S / 2.0) {
                fprintf(file, "%.4f %.4f\n", KM(sensor->x_m + range_m * cos(azimuth_rad)),
                        KM(sensor->y_m + range_m * sin(azimuth_rad)));
            }
        }
    }
    fprintf(file, "EOD\n");
}

/* As measured (found NULL), or with the biases taken off. */
static void draw_plots(const struct scene_run *run, const struct radars_found *found,
                       const char *path)
{
    struct picture picture = picture_open(path, 900, 600);
    const char *kind = found ? "right" : "raw";
    double middle_s = 0.5 * run->scene->duration_s;
    size_t target = choose_target(run, middle_s);

    for (size_t radar = 0; radar < RADARS; radar++) {
        put_plots(picture.script, run, radar, target, middle_s, found);
    }
    fprintf(picture.script, "$truth << EOD\n");
    put_way(picture.script, &run->paths[target], middle_s - ZOOM_S / 2.0, middle_s + ZOOM_S / 2.0,
            0.5);
    fprintf(picture.script, "EOD\n");
    fprintf(picture.script,
            "set size ratio -1\nset xlabel 'x east (km)'\nset ylabel 'y north (km)'\n"
            "set key top left\n"
            "plot $truth with lines lw 2 lc rgb '#000000' title 'where it flies', \\\n"
            " $%s1 with points pt 7 ps 0.9 lc rgb '#d55e00' title 'plots of radar 1', \\\n"
            " $%s2 with points pt 5 ps 0.8 lc rgb '#0072b2' title 'plots of radar 2'\n",
            kind, kind);
    picture_close(&picture);
}

/* ---- errors ---------------------------------------------------------------------------------- */

static void draw_errors(const struct radars_summary *summary, size_t kind, const char *what,
                        double unit, const char *path)
{
    struct picture picture = picture_open(path, 1000, 420);
    FILE *file = picture.script;

    for (size_t a = 0; a < RADARS; a++) {
        fprintf(file, "$radar%zu << EOD\n", a + 1);
        for (size_t run = 0; run < summary->num_runs; run++) {
            const struct radars_found *found = &summary->runs[run].found;

            if (found->is_known[a][kind]) {
                fprintf(file, "%.2f %.6f %.6f\n", (double)run + 0.2 * (double)a,
                        found->off[a][kind] / unit, found->sigma[a][kind] / unit);
            }
        }
        fprintf(file, "EOD\n");
    }
    fprintf(
        file,
        "set xlabel 'run'\nset ylabel '%s'\nset xzeroaxis\nplot $radar1 with yerrorbars pt 7 ps "
        "0.7 lc rgb '#d55e00' title 'radar 1, one sigma', \\\n"
        " $radar2 with yerrorbars pt 5 ps 0.7 lc rgb '#0072b2' title 'radar 2'\n",
        what);
    picture_close(&picture);
}

/* ---- the page -------------------------------------------------------------------------------- */

static void write_page(const struct radars_summary *summary, const struct verdicts *verdicts,
                       const char *path)
{
    struct page page = page_open(path, "Two radars: biases, and what they do to tracks");
    struct grid biases = radars_biases_grid(summary), tracks = radars_tracks_grid(summary);

    page_text(
        &page,
        "Scenario two-radars, %zu runs, seed %llu: %d bars held, %d missed. Radar 1 turns in 10 "
        "s (70 m, 1.5 mrad, P_D 0.9), radar 2 in 4 s (40 m, 2 mrad, P_D 0.8), 80 km east of it. "
        "Radar 1 measures 50 m and 0.1 degrees too much, radar 2 as much too little. 20 aircraft "
        "fly 10 minutes, most of the time where both see them.",
        summary->num_runs, (unsigned long long)summary->seed, verdicts->held, verdicts->missed);
    page_figure(&page, "map.svg", "A run: the aircraft, and how far the radars see.");
    page_figure(&page, "raw.svg", "An aircraft of it, 80 s, as the radars measure it.");
    page_figure(&page, "right.svg", "The same with the biases taken off that register found.");
    page_heading(&page, "Biases");
    page_text(&page,
              "Estimates of both radars (of time: of the second one), from the run's own plots. "
              "Sigma is what register says itself.");
    page_table(&page, &biases);
    page_figure(&page, "range.svg", "Errors of the range biases.");
    page_figure(&page, "azimuth.svg", "Errors of the azimuth biases.");
    page_heading(&page, "Tracks");
    page_text(
        &page,
        "Confirmed tracks, looked at each second. Errors and duplicates where both radars see, "
        "an error being that of the target's nearest track within the GOSPA cutoff, a duplicate "
        "each further track there. Scans are stepped in the order of their times, as they are "
        "where one waits for the late ones, but in the last case.");
    page_table(&page, &tracks);
    page_heading(&page, "What must hold");
    page_table(&page, &verdicts->grid);
    page_close(&page);
    grid_free(&biases);
    grid_free(&tracks);
}

void radars_page(const struct radars_summary *summary, const struct verdicts *verdicts,
                 const char *folder)
{
    static const char *const names[] = {"map.svg",   "raw.svg",     "right.svg",
                                        "range.svg", "azimuth.svg", "index.html"};
    struct scene *scene = radars_scene();
    struct scene_run *run = scene_observe(scene, summary->seed, 0);
    char *paths[sizeof names / sizeof names[0]];

    make_folder(folder);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        paths[i] = path_join(folder, names[i]);
    }
    draw_map(run, paths[0]);
    draw_plots(run, NULL, paths[1]);
    draw_plots(run, &summary->runs[0].found, paths[2]);
    draw_errors(summary, REGISTER_RANGE, "error of the range bias (m)", 1.0, paths[3]);
    draw_errors(summary, REGISTER_AZIMUTH, "error of the azimuth bias (degrees)", DEG_RAD,
                paths[4]);
    write_page(summary, verdicts, paths[5]);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        free(paths[i]);
    }
    scene_run_free(run);
    scene_free(scene);
}
