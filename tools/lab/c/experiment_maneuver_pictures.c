/* SPDX-License-Identifier: MIT */
/*
 * The paper's figures: positions that were taken, and errors over time, of one run and within those
 * of fifty.
 */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "experiment_maneuver_report.h"
#include "picture/picture.h"

#define RUNS MANEUVER_FIRST_RUNS
#define LEAST_VIEW_M 800.0 /* the paper's axis */
#define POPUP 0            /* cases of four clutter plots */
#define WEAVE 4

#define PAPER(name, text, what, number, by)                                                        \
    {                                                                                              \
        name, text, what, &maneuver_paper_cases[number], number, by, MANEUVER_PAPER_STREAM         \
    }
#define NOISE(name, text, what, by)                                                                \
    {                                                                                              \
        name, text, what, &maneuver_noise_case, 0, by, MANEUVER_NOISE_STREAM                       \
    }
#define FIRST_OF_LAST_NOISE ((MANEUVER_NOISES - 1) * MANEUVER_NOISE_METHODS)

const struct maneuver_picture maneuver_pictures[] = {
    PAPER("figure-2.svg", "Fig. 2, positions that Method I takes, pop-up.", MANEUVER_DRAW_USED,
          POPUP, MANEUVER_I),
    PAPER("figure-3.svg", "Fig. 3, positions that Method III takes, pop-up.", MANEUVER_DRAW_USED,
          POPUP, MANEUVER_III),
    PAPER("figure-4.svg", "Fig. 4, position errors of Method I, pop-up.", MANEUVER_DRAW_OFF_M,
          POPUP, MANEUVER_I),
    PAPER("figure-5.svg", "Fig. 5, velocity errors of Method I, pop-up.", MANEUVER_DRAW_OFF_MPS,
          POPUP, MANEUVER_I),
    PAPER("figure-6.svg", "Fig. 6, position errors of Method II, pop-up.", MANEUVER_DRAW_OFF_M,
          POPUP, MANEUVER_II),
    PAPER("figure-7.svg", "Fig. 7, velocity errors of Method II, pop-up.", MANEUVER_DRAW_OFF_MPS,
          POPUP, MANEUVER_II),
    PAPER("figure-8.svg", "Fig. 8, position errors of Method III, pop-up.", MANEUVER_DRAW_OFF_M,
          POPUP, MANEUVER_III),
    PAPER("figure-9.svg", "Fig. 9, velocity errors of Method III, pop-up.", MANEUVER_DRAW_OFF_MPS,
          POPUP, MANEUVER_III),
    PAPER("figure-10.svg", "Fig. 10, position errors of Method I, weave (the paper's scenario 2).",
          MANEUVER_DRAW_OFF_M, WEAVE, MANEUVER_I),
    PAPER("figure-11.svg", "Fig. 11, velocity errors of Method I, weave.", MANEUVER_DRAW_OFF_MPS,
          WEAVE, MANEUVER_I),
    PAPER("figure-12.svg", "Fig. 12, position errors of Method II, weave.", MANEUVER_DRAW_OFF_M,
          WEAVE, MANEUVER_II),
    PAPER("figure-13.svg", "Fig. 13, velocity errors of Method II, weave.", MANEUVER_DRAW_OFF_MPS,
          WEAVE, MANEUVER_II),
    PAPER("figure-14.svg", "Fig. 14, position errors of Method III, weave.", MANEUVER_DRAW_OFF_M,
          WEAVE, MANEUVER_III),
    PAPER("figure-15.svg", "Fig. 15, velocity errors of Method III, weave.", MANEUVER_DRAW_OFF_MPS,
          WEAVE, MANEUVER_III),
    NOISE("method-2-narrow-position.svg",
          "The paper's contrast: position errors of Method II, pop-up, with Q = 1e-4 I.",
          MANEUVER_DRAW_OFF_M, FIRST_OF_LAST_NOISE),
    NOISE("method-2-narrow-velocity.svg", "Velocity errors of Method II, pop-up, with Q = 1e-4 I.",
          MANEUVER_DRAW_OFF_MPS, FIRST_OF_LAST_NOISE),
    NOISE("method-1-narrow-position.svg",
          "Position errors of Method I with gamma .5, pop-up, with Q = 1e-4 I.",
          MANEUVER_DRAW_OFF_M, FIRST_OF_LAST_NOISE + MANEUVER_NOISE_METHODS - 1),
    NOISE("method-1-narrow-velocity.svg",
          "Velocity errors of Method I with gamma .5, pop-up, with Q = 1e-4 I.",
          MANEUVER_DRAW_OFF_MPS, FIRST_OF_LAST_NOISE + MANEUVER_NOISE_METHODS - 1),
    PAPER("default-popup-position.svg", "Position errors of the default, pop-up.",
          MANEUVER_DRAW_OFF_M, POPUP, MANEUVER_DEFAULT),
    PAPER("default-popup-velocity.svg", "Velocity errors of the default, pop-up.",
          MANEUVER_DRAW_OFF_MPS, POPUP, MANEUVER_DEFAULT),
    PAPER("default-weave-position.svg", "Position errors of the default, weave.",
          MANEUVER_DRAW_OFF_M, WEAVE, MANEUVER_DEFAULT),
    PAPER("default-weave-velocity.svg", "Velocity errors of the default, weave.",
          MANEUVER_DRAW_OFF_MPS, WEAVE, MANEUVER_DEFAULT),
};
const size_t maneuver_num_pictures = sizeof maneuver_pictures / sizeof maneuver_pictures[0];

/* ---- what is drawn --------------------------------------------------------------------------- */

/* The first run's values, and between what all runs' lie. */
struct curves {
    double value[MANEUVER_SCANS][3];
    double least[MANEUVER_SCANS], most[MANEUVER_SCANS];
    double radius_m[MANEUVER_SCANS];
};

static const double *values_of(const struct maneuver_trace *trace, enum maneuver_drawn drawn,
                               size_t scan)
{
    return drawn == MANEUVER_DRAW_USED    ? trace->used_m[scan]
           : drawn == MANEUVER_DRAW_OFF_M ? trace->off_m[scan]
                                          : trace->off_mps[scan];
}

static void add_run(struct curves *curves, const struct maneuver_trace *trace,
                    enum maneuver_drawn drawn, bool is_first)
{
    for (size_t scan = 0; scan < MANEUVER_SCANS; scan++) {
        const double *values = values_of(trace, drawn, scan);
        for (int i = 0; i < 3; i++) {
            bool is_start = is_first && i == 0;
            curves->least[scan] = is_start ? values[i] : fmin(curves->least[scan], values[i]);
            curves->most[scan] = is_start ? values[i] : fmax(curves->most[scan], values[i]);
            if (is_first) {
                curves->value[scan][i] = values[i];
            }
        }
    }
}

static struct curves *curves_of(const struct maneuver_picture *picture, uint64_t seed)
{
    struct curves *curves = must_calloc(1, sizeof *curves);
    for (size_t run = 0; run < RUNS; run++) {
        struct maneuver_scene scene;
        struct maneuver_trace trace;
        maneuver_scene_draw(&scene, &picture->of->setting, seed,
                            picture->stream + picture->case_number, run);
        maneuver_follow(&trace, &scene, &picture->of->methods[picture->method]);
        add_run(curves, &trace, picture->drawn, run == 0);
        for (size_t scan = 0; scan < MANEUVER_SCANS && run == 0; scan++) {
            curves->radius_m[scan] = scene.radius_m[scan];
        }
    }
    return curves;
}

/* ---- how ------------------------------------------------------------------------------------- */

static void put_curves(FILE *file, const struct curves *curves, double unit)
{
    fprintf(file, "$curves << EOD\n");
    for (size_t scan = 0; scan < MANEUVER_SCANS; scan++) {
        fprintf(file, "%.2f %.6g %.6g %.6g %.6g %.6g %.6g\n", (double)scan * MANEUVER_INTERVAL_S,
                curves->value[scan][0] / unit, curves->value[scan][1] / unit,
                curves->value[scan][2] / unit, curves->least[scan] / unit,
                curves->most[scan] / unit, curves->radius_m[scan]);
    }
    fprintf(file, "EOD\n");
}

static double widest(const struct curves *curves)
{
    double most = LEAST_VIEW_M;
    for (size_t scan = 0; scan < MANEUVER_SCANS; scan++) {
        most = fmax(most, 1.1 * fmax(-curves->least[scan], curves->most[scan]));
    }
    return most;
}

static const char axes[] =
    " $curves using 1:2 with lines lw 2 lc rgb '#0072b2' title 'x, downrange', \\\n"
    " $curves using 1:3 with lines lw 2 lc rgb '#d55e00' title 'y, offrange', \\\n"
    " $curves using 1:4 with lines lw 2 lc rgb '#009e73' title 'z, altitude'";

static void put_errors(FILE *file, const struct curves *curves, enum maneuver_drawn drawn)
{
    bool is_place = drawn == MANEUVER_DRAW_OFF_M;
    if (is_place) {
        double view_m = widest(curves);
        fprintf(file, "set yrange [%g:%g]\n", -view_m, view_m);
    }
    fprintf(file,
            "set ylabel '%s'\nplot $curves using 1:5:6 with filledcurves lc rgb '#d9d9d9' "
            "title 'all of %d runs', \\\n%s",
            is_place ? "errors in position (m)" : "errors in velocity (m/s)", RUNS, axes);
    if (is_place) {
        fprintf(file, ", \\\n $curves using 1:7 with lines lw 2 dt 2 lc rgb '#000000' title "
                      "'beam', \\\n"
                      " $curves using 1:(-$7) with lines lw 2 dt 2 lc rgb '#000000' notitle");
    }
    fprintf(file, "\n");
}

void maneuver_draw(const struct maneuver_picture *picture, uint64_t seed, const char *folder)
{
    char *path = path_join(folder, picture->file);
    struct curves *curves = curves_of(picture, seed);
    struct picture svg = picture_open(path, 900, 480);
    FILE *file = svg.script;
    put_curves(file, curves, picture->drawn == MANEUVER_DRAW_USED ? 1e3 : 1.0);
    fprintf(
        file,
        "set xlabel 'time (s)'\nset xrange [0:40]\n"
        "set key outside top center horizontal maxrows 1 samplen 2\nset datafile missing 'nan'\n");
    if (picture->drawn == MANEUVER_DRAW_USED) {
        fprintf(file, "set ylabel 'position of the plot taken (km)'\nplot %s\n", axes);
    } else {
        put_errors(file, curves, picture->drawn);
    }
    picture_close(&svg);
    free(curves);
    free(path);
}
