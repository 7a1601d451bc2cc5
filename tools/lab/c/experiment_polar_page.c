/* SPDX-License-Identifier: MIT */
#include "experiment_polar_page.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "page.h"
#include "picture/picture.h"

#define KM(metres) ((metres) / 1e3)

/* ---- one run --------------------------------------------------------------------------------- */

static void put_plots(FILE *file, const struct simulation *simulation, bool of_targets)
{
    fprintf(file, "$%s << EOD\n", of_targets ? "targets" : "clutter");
    for (size_t turn = 0; turn < POLAR_WINDOW; turn++) {
        const struct simulated_scan *scan = &simulation->scans[turn];
        for (size_t i = 0; i < scan->num_plots; i++) {
            if ((scan->plots[i].target_id >= 0) == of_targets) {
                fprintf(file, "%.3f %.3f\n", KM(scan->plots[i].x_m), KM(scan->plots[i].y_m));
            }
        }
    }
    fprintf(file, "EOD\n");
}

static void put_candidates(FILE *file, const struct rho_initiator *initiator, double span_s)
{
    fprintf(file, "$tracks << EOD\n");
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        const struct rho_candidate *track = &initiator->candidates[i];
        fprintf(file, "%.4f %.4f\n%.4f %.4f\n\n\n", KM(track->x_m - track->vx_mps * span_s),
                KM(track->y_m - track->vy_mps * span_s), KM(track->x_m), KM(track->y_m));
    }
    fprintf(file, "EOD\n");
}

static void draw_map(const struct simulation *simulation, const struct rho_initiator *initiator,
                     const char *path)
{
    struct picture picture = picture_open(path, 1200, 800);
    put_plots(picture.script, simulation, false);
    put_plots(picture.script, simulation, true);
    put_candidates(picture.script, initiator, simulation->interval_s * (POLAR_WINDOW - 1));
    fprintf(picture.script,
            "set size ratio -1\nset xlabel 'x east (km)'\nset ylabel 'y north (km)'\n"
            "set xrange [-68:68]\nset yrange [-68:68]\n"
            "plot $clutter with points pt 7 ps 0.15 lc rgb '#b0b0b0' title 'clutter plots', \\\n"
            " $targets with points pt 6 ps 0.9 lw 1.5 lc rgb '#000000' title 'target plots', \\\n"
            " $tracks with lines lw 3 lc rgb '#0072b2' title 'tracks found'\n");
    picture_close(&picture);
}

/* ---- gates ----------------------------------------------------------------------------------- */

struct spread {
    double xx_m2, xy_m2, yy_m2;
};

static struct spread noise_of(const struct scenario_radar *radar, const struct simulated_plot *plot,
                              bool is_isotropic)
{
    double ca = cos(plot->azimuth_rad), sa = sin(plot->azimuth_rad);
    double across_m2 = pow(plot->range_m * radar->sigma_azimuth_rad, 2.0);
    double along_m2 = is_isotropic ? across_m2 : pow(radar->sigma_range_m, 2.0);
    return (struct spread){ca * ca * along_m2 + sa * sa * across_m2,
                           ca * sa * (along_m2 - across_m2),
                           sa * sa * along_m2 + ca * ca * across_m2};
}

static void add_spread(struct spread *sum, struct spread other, double factor)
{
    sum->xx_m2 += factor * other.xx_m2;
    sum->xy_m2 += factor * other.xy_m2;
    sum->yy_m2 += factor * other.yy_m2;
}

/* The gate's border: the places whose squared distance is 13.8 (99.9 %). */
static void put_gate(FILE *file, double x_m, double y_m, const struct spread *spread)
{
    double l11 = sqrt(spread->xx_m2), l21 = spread->xy_m2 / l11;
    double l22 = sqrt(spread->yy_m2 - l21 * l21), reach = sqrt((double)RHO_GATE_CHI2_2D);
    for (int i = 0; i <= 72; i++) {
        double angle_rad = i * 0.08726646259971647;
        double u = reach * cos(angle_rad), v = reach * sin(angle_rad);
        fprintf(file, "%.4f %.4f\n", KM(x_m + l11 * u), KM(y_m + l21 * u + l22 * v));
    }
    fprintf(file, "\n\n");
}

static const struct simulated_plot *plot_of(const struct simulation *simulation, size_t turn,
                                            int target)
{
    const struct simulated_scan *scan = &simulation->scans[turn];
    size_t i = 0;
    while (i + 1 < scan->num_plots && scan->plots[i].target_id != target) {
        i++;
    }
    return &scan->plots[i];
}

/* A target's plots of the first and last turn make a kernel; its gates in the turns between. */
static void put_gates(FILE *file, const struct simulation *simulation, int target,
                      bool is_isotropic)
{
    const struct simulated_plot *from = plot_of(simulation, 0, target);
    const struct simulated_plot *to = plot_of(simulation, POLAR_WINDOW - 1, target);
    fprintf(file, "$%s << EOD\n", is_isotropic ? "wide" : "own");
    for (size_t turn = 1; turn + 1 < POLAR_WINDOW; turn++) {
        double al = (double)turn / (POLAR_WINDOW - 1);
        struct spread spread = {0.0, 0.0, 0.0};
        add_spread(&spread, noise_of(&simulation->radar, from, is_isotropic), (1 - al) * (1 - al));
        add_spread(&spread, noise_of(&simulation->radar, to, is_isotropic), al * al);
        add_spread(&spread,
                   noise_of(&simulation->radar, plot_of(simulation, turn, target), is_isotropic),
                   1.0);
        put_gate(file, from->x_m + al * (to->x_m - from->x_m),
                 from->y_m + al * (to->y_m - from->y_m), &spread);
    }
    fprintf(file, "EOD\n");
}

/* The target whose last plot is farthest out; the run has no misses. */
static int choose_target(const struct simulation *simulation)
{
    int chosen = 0;
    for (int target = 1; target < (int)simulation->num_targets; target++) {
        if (plot_of(simulation, POLAR_WINDOW - 1, target)->range_m >
            plot_of(simulation, POLAR_WINDOW - 1, chosen)->range_m) {
            chosen = target;
        }
    }
    return chosen;
}

static void draw_gates(const struct simulation *simulation, const char *path)
{
    int target = choose_target(simulation);
    const struct simulated_plot *from = plot_of(simulation, 0, target);
    const struct simulated_plot *to = plot_of(simulation, POLAR_WINDOW - 1, target);
    double x_km = KM(from->x_m + to->x_m) / 2.0, y_km = KM(from->y_m + to->y_m) / 2.0;
    double half_km = KM(hypot(to->x_m - from->x_m, to->y_m - from->y_m)) / 2.0 + 1.0;
    struct picture picture = picture_open(path, 1200, 800);
    put_plots(picture.script, simulation, false);
    put_plots(picture.script, simulation, true);
    put_gates(picture.script, simulation, target, true);
    put_gates(picture.script, simulation, target, false);
    fprintf(picture.script,
            "set size ratio -1\nset xlabel 'x east (km)'\nset ylabel 'y north (km)'\n"
            "set xrange [%.3f:%.3f]\nset yrange [%.3f:%.3f]\n"
            "plot $clutter with points pt 7 ps 0.4 lc rgb '#909090' title 'clutter plots', \\\n"
            " $wide with lines lw 1.5 lc rgb '#d55e00' title 'gates, one isotropic sigma', \\\n"
            " $own with lines lw 2 lc rgb '#0072b2' title 'gates, own covariance', \\\n"
            " $targets with points pt 6 ps 1.2 lw 1.5 lc rgb '#000000' title 'target plots'\n",
            x_km - half_km, x_km + half_km, y_km - half_km, y_km + half_km);
    picture_close(&picture);
}

static void draw_run(uint64_t seed, const char *map, const char *gates)
{
    struct parameters parameters;
    struct simulation *simulation =
        polar_simulation(polar_clutter[POLAR_LEVELS - 1], 1.0, seed, 0, &parameters);
    struct pipeline chain = pipeline_start();
    polar_search(&polar_cases[0], &parameters, simulation, &chain);
    draw_map(simulation, chain.initiator, map);
    draw_gates(simulation, gates);
    pipeline_free(&chain);
    simulation_free(simulation);
}

/* ---- errors ---------------------------------------------------------------------------------- */

static void put_errors(FILE *file, const char *name, const double *sums_m2, const size_t *counts)
{
    fprintf(file, "$%s << EOD\n", name);
    for (size_t turn = 0; turn < POLAR_TURNS_MAX; turn++) {
        if (counts[turn] > 0) {
            fprintf(file, "%zu %.2f\n", turn + 1, sqrt(sums_m2[turn] / (double)counts[turn]));
        }
    }
    fprintf(file, "EOD\n");
}

/*
 * The four cases at the lower clutter level; part 0: position, 1: its part along the line of sight.
 */
static void draw_errors(const struct polar_summary *summaries, bool along, const char *path)
{
    struct picture picture = picture_open(path, 1100, 520);
    FILE *file = picture.script;
    for (size_t i = 0; i < POLAR_CASES; i++) {
        const struct polar_errors *errors = &summaries[i].errors;
        char name[16];
        snprintf(name, sizeof name, "case%zu", i);
        put_errors(file, name, along ? errors->along_m2 : errors->sum_m2, errors->count);
    }
    put_errors(file, "reference", summaries[0].errors.reference_m2, summaries[0].errors.count);
    fprintf(file, "set xlabel 'turn'\nset ylabel '%s'\nset yrange [0:*]\nset key top right\nplot ",
            along ? "rms error along the line of sight (m)" : "rms position error (m)");
    for (size_t i = 0; i < POLAR_CASES; i++) {
        fprintf(file, "%s$case%zu with linespoints lw 2 lt %zu pt %d title '%s'",
                i == 0 ? "" : ", \\\n ", i, i + 1, picture_marker(i), polar_cases[i].name);
    }
    if (!along) {
        fprintf(file, ", \\\n $reference with lines lw 1.5 dt 2 lc rgb '#000000' title 'own "
                      "covariance, in double precision'");
    }
    fprintf(file, "\n");
    picture_close(&picture);
}

/* ---- the page -------------------------------------------------------------------------------- */

static void write_page(const struct polar_summary *summaries, const struct verdicts *verdicts,
                       size_t num_runs, uint64_t seed, const char *path)
{
    struct page page = page_open(path, "A turning radar: plots in range and azimuth");
    struct grid initiation = polar_initiation_grid(summaries);
    struct grid tracks = polar_tracks_grid(summaries);
    page_text(&page,
              "Scenario polar, %zu runs, seed %llu: three targets at 20 to 60 km, 15 m and 3 mrad, "
              "4 s a turn, clutter uniform in range and azimuth: %d bars held, %d missed. Own "
              "covariance: the library knows each plot's ellipse. One isotropic sigma: it is told "
              "the larger of each plot's sigmas, in all directions.",
              num_runs, (unsigned long long)seed, verdicts->held, verdicts->missed);
    page_figure(&page, "map.svg",
                "A run without misses: seven turns of 1000 clutter plots, and the tracks found.");
    page_figure(&page, "gates.svg",
                "The same run, one target: gates (99.9 %) of the kernel between its first and last "
                "plot, with the plots' own covariance, and with one isotropic sigma.");
    page_heading(&page, "Initiation");
    page_text(&page,
              "A batch of seven turns, at least five plots, score at least 0. The clairvoyant "
              "fit knows which plots are the target's, and the clutter's true density.");
    page_table(&page, &initiation);
    page_heading(&page, "Tracks");
    page_text(&page, "The tracker with the scene's own parameters and one false track an hour "
                     "wanted. The double filter takes the plots that the track took.");
    page_table(&page, &tracks);
    page_figure(&page, "errors.svg",
                "Position error of confirmed tracks, 100 clutter plots a turn.");
    page_figure(&page, "along.svg", "Its part along the line of sight.");
    page_heading(&page, "What must hold");
    page_table(&page, &verdicts->grid);
    page_close(&page);
    grid_free(&initiation);
    grid_free(&tracks);
}

void polar_page(const struct polar_summary *summaries, const struct verdicts *verdicts,
                size_t num_runs, uint64_t seed, const char *folder)
{
    make_folder(folder);
    char *map = path_join(folder, "map.svg"), *gates = path_join(folder, "gates.svg");
    char *errors = path_join(folder, "errors.svg"), *along = path_join(folder, "along.svg");
    char *page = path_join(folder, "index.html");
    draw_run(seed, map, gates);
    draw_errors(summaries, false, errors);
    draw_errors(summaries, true, along);
    write_page(summaries, verdicts, num_runs, seed, page);
    free(map);
    free(gates);
    free(errors);
    free(along);
    free(page);
}
