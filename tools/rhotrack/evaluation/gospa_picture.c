/* SPDX-License-Identifier: MIT */
/*
 * gospa_picture: a picture of GOSPA, its parts and the numbers of targets and tracks over
 * time.
 */
#include <inttypes.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "evaluation/evaluation_output.h"
#include "picture/gnuplot_picture_file.h"

/* times beyond this are drawn as seconds from the first: axis labels have six digits */
#define LONG_TIME_US 1000000000000

/* Time that is drawn as 0: the first time where times are long (LONG_TIME_US), else time 0. */
static int64_t time_axis_origin_us(const struct evaluation_scan *scans, size_t count)
{
    return count > 0 && llabs(scans[count - 1].time_us) >= LONG_TIME_US ? scans[0].time_us : 0;
}

/*
 * Defines the line styles of both panels: the total as a wide grey line, its parts as thin coloured
 * lines; points instead of lines where there is one time only.
 */
static void define_line_styles(FILE *script, size_t num_times)
{
    const char *line = num_times > 1 ? "lines" : "points pt 7 ps 0.8";
    fprintf(script,
            "whole = \"with %s lw 6 lc rgb '#b4b4b4'\"\n"
            "missed = \"with %s lw 2 lc rgb '%s' title 'missed targets'\"\n"
            "false = \"with %s lw 2 lc rgb '%s' title 'false tracks'\"\n"
            "other = \"with %s lw 2 lc rgb '%s'\"\n",
            line, line, picture_colour(1), line, picture_colour(2), line, picture_colour(0));
}

/* Sets a panel's position, key and y range; is_zero: all values are 0, and the range is 0 .. 1. */
static void place_panel(FILE *script, double bottom, double top, bool values_are_zero)
{
    fprintf(script,
            "set yrange [0:%s]\nset tmargin at screen %g\nset bmargin at screen %g\n"
            "set key at screen 0.81,%g left top vertical Left reverse\n",
            values_are_zero ? "1" : "*", top, bottom, top);
}

static void define_time_axis(FILE *script, const struct evaluation_scan *scans, size_t count)
{
    int64_t zero = time_axis_origin_us(scans, count);
    if (count == 1) {
        double time_s = (double)(scans[0].time_us - zero) * 1e-6;
        fprintf(script, "set xrange [%g:%g]\n", time_s - 1.0, time_s + 1.0);
    } else {
        fprintf(script, "set autoscale xfix\n");
    }
    if (zero == 0) {
        fprintf(script, "time = 'time (s)'\n");
    } else {
        fprintf(script, "time = 'time (s), from %.15g on'\n", (double)zero * 1e-6);
    }
}

void evaluation_draw_gospa(const struct evaluation *e, const char *path)
{
    size_t count;
    const struct evaluation_scan *scans = evaluation_results_over_time(e, &count);
    struct evaluation_result result = evaluation_result(e);
    struct picture picture = picture_open(path, 1100, 780);
    FILE *script = picture.script;
    /*
     * Writes a data block with a row a time: time; GOSPA and the roots of its missed, false and
     * localisation parts; numbers of targets, tracks, missed targets and false tracks.
     */
    fprintf(script, "$scans << EOD\n");
    for (size_t i = 0; i < count; i++) {
        const struct evaluation_scan *scan = &scans[i];
        fprintf(script, "%.6f %.6g %.6g %.6g %.6g %zu %zu %zu %zu\n",
                (double)(scan->time_us - time_axis_origin_us(scans, count)) * 1e-6, scan->gospa_m,
                sqrt(scan->missed_m2), sqrt(scan->false_m2), sqrt(scan->localisation_m2),
                scan->targets, scan->tracks, scan->targets - scan->pairs,
                scan->tracks - scan->pairs);
    }
    fprintf(script, "EOD\n");
    define_line_styles(script, count);
    define_time_axis(script, scans, count);
    fprintf(script, "set multiplot\nset lmargin at screen 0.1\nset rmargin at screen 0.79\n");
    place_panel(script, 0.53, 0.97, result.gospa_m <= 0.0);
    fprintf(script, "set ylabel 'GOSPA and the roots of its parts (m)'\nset format x ''\n"
                    "plot $scans using 1:2 @whole title 'GOSPA', \\\n"
                    " '' using 1:3 @missed, '' using 1:4 @false, \\\n"
                    " '' using 1:5 @other title 'localisation'\n");
    place_panel(script, 0.1, 0.49, result.targets + result.tracks == 0);
    fprintf(script, "set xlabel time\nset ylabel 'number'\nset format x '%%g'\n"
                    "plot $scans using 1:6 @whole title 'targets', \\\n"
                    " '' using 1:8 @missed, '' using 1:9 @false, \\\n"
                    " '' using 1:7 @other title 'tracks'\nunset multiplot\n");
    picture_draw_and_close(&picture);
}
