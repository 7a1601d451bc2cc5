/* SPDX-License-Identifier: MIT */
/* experiment_two_radars_page: the tables as a page, with pictures of one run and of the biases' errors. */
#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "experiment_two_radars.h"
#include "page.h"
#include "picture.h"

#define DEG_RAD 0.017453292519943295
#define KM(metres) ((metres) / 1e3)
#define ZOOM_S 80.0

/* ---- one run ---------------------------------------------------------------------------------- */

static void put_paths(FILE *file, const struct simulation *simulation)
{
    size_t step = simulation->targets_a_scan;

    fprintf(file, "$paths << EOD\n");
    for (size_t target = 0; target < step; target++) {
        for (size_t i = 0; i < simulation->num_times; i += 50) {
            const struct truth_point *at = &simulation->truth[i * step + target];

            fprintf(file, "%.3f %.3f\n", KM(at->x_m), KM(at->y_m));
        }
        fprintf(file, "\n\n");
    }
    fprintf(file, "EOD\n");
}

static void put_radars(FILE *file, const struct scenario_record *record)
{
    fprintf(file, "$reach << EOD\n");
    for (size_t a = 0; a < record->num_antennas; a++) {
        const struct scenario_antenna *antenna = &record->antennas[a];

        for (int i = 0; i <= 90; i++) {
            fprintf(file, "%.3f %.3f\n",
                    KM(antenna->x_m + antenna->range_max_m * cos(4.0 * i * DEG_RAD)),
                    KM(antenna->y_m + antenna->range_max_m * sin(4.0 * i * DEG_RAD)));
        }
        fprintf(file, "\n\n");
    }
    fprintf(file, "EOD\n$radars << EOD\n");
    for (size_t a = 0; a < record->num_antennas; a++) {
        fprintf(file, "%.3f %.3f\n", KM(record->antennas[a].x_m), KM(record->antennas[a].y_m));
    }
    fprintf(file, "EOD\n");
}

static void draw_map(const struct simulation *simulation, const char *path)
{
    struct picture picture = picture_open(path, 900, 800);

    put_paths(picture.script, simulation);
    put_radars(picture.script, simulation->record);
    fprintf(picture.script,
            "set size ratio -1\nset xlabel 'x east (km)'\nset ylabel 'y north (km)'\n"
            "plot $reach with lines lw 1.5 dt 2 lc rgb '#808080' title 'how far they see', \\\n"
            " $radars with points pt 9 ps 2 lc rgb '#d55e00' title 'radars', \\\n"
            " $paths with lines lw 2 lc rgb '#0072b2' title 'aircraft'\n");
    picture_close(&picture);
}

/* ---- one aircraft ----------------------------------------------------------------------------- */

/* The target that is nearest to a place half-way between the radars, and north, at half time. */
static size_t choose_target(const struct simulation *simulation, double *middle_s)
{
    size_t step = simulation->targets_a_scan, chosen = 0;
    const struct truth_point *truth = &simulation->truth[simulation->num_times / 2 * step];
    double nearest_m = INFINITY;

    for (size_t target = 0; target < step; target++) {
        double distance_m = hypot(truth[target].x_m - 40000.0, truth[target].y_m - 40000.0);

        if (distance_m < nearest_m) {
            nearest_m = distance_m;
            chosen = target;
        }
    }
    *middle_s = truth->t_s;
    return chosen;
}

static void put_plots(FILE *file, const struct simulation *simulation, size_t target,
                      double middle_s, const struct radars_found *found)
{
    const struct scenario_record *record = simulation->record;

    for (size_t a = 0; a < RADARS; a++) {
        const struct scenario_antenna *antenna = &record->antennas[a];
        double range_bias_m = antenna->range_bias_m + (found ? found->off[a][REGISTER_RANGE] : 0.0);
        double azimuth_bias_rad =
            antenna->azimuth_bias_rad + (found ? found->off[a][REGISTER_AZIMUTH] : 0.0);

        fprintf(file, "$%s%zu << EOD\n", found ? "right" : "raw", a + 1);
        for (size_t i = 0; i < record->views[a].num_sectors; i++) {
            for (size_t j = 0; j < record->views[a].sectors[i].num_plots; j++) {
                const struct antenna_plot *plot = &record->views[a].sectors[i].plots[j];
                double range_m = plot->range_m - (found ? range_bias_m : 0.0);
                double azimuth_rad = plot->azimuth_rad - (found ? azimuth_bias_rad : 0.0);

                if (plot->target_id == (int)target && fabs(plot->t_s - middle_s) < ZOOM_S / 2.0) {
                    fprintf(file, "%.4f %.4f\n", KM(antenna->x_m + range_m * cos(azimuth_rad)),
                            KM(antenna->y_m + range_m * sin(azimuth_rad)));
                }
            }
        }
        fprintf(file, "EOD\n");
    }
}

static void put_truth(FILE *file, const struct simulation *simulation, size_t target,
                      double middle_s)
{
    size_t step = simulation->targets_a_scan;

    fprintf(file, "$truth << EOD\n");
    for (size_t i = 0; i < simulation->num_times; i++) {
        const struct truth_point *at = &simulation->truth[i * step + target];

        if (fabs(at->t_s - middle_s) < ZOOM_S / 2.0) {
            fprintf(file, "%.4f %.4f\n", KM(at->x_m), KM(at->y_m));
        }
    }
    fprintf(file, "EOD\n");
}

/* As measured (found NULL), or with the biases taken off. */
static void draw_plots(const struct simulation *simulation, const struct radars_found *found,
                       const char *path)
{
    struct picture picture = picture_open(path, 900, 600);
    const char *kind = found ? "right" : "raw";
    double middle_s;
    size_t target = choose_target(simulation, &middle_s);

    put_plots(picture.script, simulation, target, middle_s, found);
    put_truth(picture.script, simulation, target, middle_s);
    fprintf(picture.script,
            "set size ratio -1\nset xlabel 'x east (km)'\nset ylabel 'y north (km)'\n"
            "set key top left\n"
            "plot $truth with lines lw 2 lc rgb '#000000' title 'where it flies', \\\n"
            " $%s1 with points pt 7 ps 0.9 lc rgb '#d55e00' title 'plots of radar 1', \\\n"
            " $%s2 with points pt 5 ps 0.8 lc rgb '#0072b2' title 'plots of radar 2'\n",
            kind, kind);
    picture_close(&picture);
}

/* ---- errors ----------------------------------------------------------------------------------- */

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

/* ---- the page --------------------------------------------------------------------------------- */

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
    struct parameters parameters = radars_parameters();
    struct simulation *simulation = scenario_simulate("two-radars", &parameters, summary->seed, 0);
    char *paths[sizeof names / sizeof names[0]];

    make_folder(folder);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        paths[i] = path_join(folder, names[i]);
    }
    draw_map(simulation, paths[0]);
    draw_plots(simulation, NULL, paths[1]);
    draw_plots(simulation, &summary->runs[0].found, paths[2]);
    draw_errors(summary, REGISTER_RANGE, "error of the range bias (m)", 1.0, paths[3]);
    draw_errors(summary, REGISTER_AZIMUTH, "error of the azimuth bias (degrees)", DEG_RAD,
                paths[4]);
    write_page(summary, verdicts, paths[5]);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        free(paths[i]);
    }
    simulation_free(simulation);
}
