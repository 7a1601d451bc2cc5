/* SPDX-License-Identifier: MIT */
/* evaluation: GOSPA and numbers over time. */
#include <math.h>

#include "evaluation_report.h"
#include "picture.h"

/* Columns: time; GOSPA and the roots of its parts: missed, false, localisation; targets, tracks, missed, false. */
static void put_scans(FILE *script, const struct evaluation_scan *scans, size_t count)
{
    fprintf(script, "$scans << EOD\n");
    for (size_t i = 0; i < count; i++) {
        const struct evaluation_scan *scan = &scans[i];
        fprintf(script, "%.6f %.6g %.6g %.6g %.6g %zu %zu %zu %zu\n", (double)scan->time_us * 1e-6,
                scan->gospa_m, sqrt(scan->missed_m2), sqrt(scan->false_m2),
                sqrt(scan->localisation_m2), scan->targets, scan->tracks,
                scan->targets - scan->pairs, scan->tracks - scan->pairs);
    }
    fprintf(script, "EOD\n");
}

/* The same look in both panels: wide and grey what the thin lines are parts of. One time alone makes no line. */
static void define_looks(FILE *script, size_t count)
{
    const char *line = count > 1 ? "lines" : "points pt 7 ps 0.8";
    fprintf(script,
            "whole = \"with %s lw 6 lc rgb '#b4b4b4'\"\n"
            "missed = \"with %s lw 2 lc rgb '%s' title 'missed targets'\"\n"
            "false = \"with %s lw 2 lc rgb '%s' title 'false tracks'\"\n"
            "other = \"with %s lw 2 lc rgb '%s'\"\n",
            line, line, picture_colour(1), line, picture_colour(2), line, picture_colour(0));
}

static void place_panel(FILE *script, double bottom, double top)
{
    fprintf(script,
            "set tmargin at screen %g\nset bmargin at screen %g\n"
            "set key at screen 0.81,%g left top vertical Left reverse\n",
            top, bottom, top);
}

void evaluation_draw(const struct evaluation *e, const char *path)
{
    size_t count;
    const struct evaluation_scan *scans = evaluation_over_time(e, &count);
    struct picture picture = picture_open(path, 1100, 780);
    FILE *script = picture.script;
    put_scans(script, scans, count);
    define_looks(script, count);
    fprintf(script,
            "set multiplot\nset lmargin at screen 0.1\nset rmargin at screen 0.79\n"
            "set yrange [0:*]\n%s",
            count > 1 ? "set autoscale xfix\n" : "");
    place_panel(script, 0.53, 0.97);
    fprintf(script, "set ylabel 'GOSPA and the roots of its parts (m)'\nset format x ''\n"
                    "plot $scans using 1:2 @whole title 'GOSPA', \\\n"
                    " '' using 1:3 @missed, '' using 1:4 @false, \\\n"
                    " '' using 1:5 @other title 'localisation'\n");
    place_panel(script, 0.1, 0.49);
    fprintf(script, "set xlabel 'time (s)'\nset ylabel 'number'\nset format x '%%g'\n"
                    "plot $scans using 1:6 @whole title 'targets', \\\n"
                    " '' using 1:8 @missed, '' using 1:9 @false, \\\n"
                    " '' using 1:7 @other title 'tracks'\nunset multiplot\n");
    picture_close(&picture);
}
