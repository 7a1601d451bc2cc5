/* SPDX-License-Identifier: MIT */
#include "experiment_alarms_page.h"

#include <stdlib.h>

#include "base/common.h"
#include "page.h"
#include "picture/picture.h"

/* One curve a clutter level; the limits as bars. */
static void draw_rates(const struct alarm_figures *figures, const char *path)
{
    struct picture picture = picture_open(path, 1000, 620);
    FILE *file = picture.script;
    for (size_t level = 0; level < ALARM_LEVELS; level++) {
        fprintf(file, "$level%zu << EOD\n", level);
        for (size_t rate = 0; rate < ALARM_RATES; rate++) {
            const struct alarm_summary *of = &figures->alarms[level * ALARM_RATES + rate];
            /* side by side */
            fprintf(file, "%g %g %g %g\n", of->wanted_per_hour * (0.94 + 0.06 * (double)level),
                    of->per_hour, of->low_per_hour, of->high_per_hour);
        }
        fprintf(file, "EOD\n");
    }
    fprintf(file, "set logscale xy\nset xrange [0.5:200]\nset yrange [0.2:400]\n"
                  "set xlabel 'wanted an hour'\nset ylabel 'measured an hour, 95 %% limits'\n"
                  "set key top left inside\n"
                  "plot x with lines lw 1.5 lc rgb '#7f7f7f' title 'as wanted', \\\n"
                  " 2 * x with lines lw 1 dt 2 lc rgb '#7f7f7f' title 'factor 2', \\\n"
                  " x / 2 with lines lw 1 dt 2 lc rgb '#7f7f7f' notitle");
    for (size_t level = 0; level < ALARM_LEVELS; level++) {
        fprintf(file, ", \\\n $level%zu with yerrorbars lw 2 lt %zu pt %d ps 1.2 title '%g a km^2'",
                level, level + 1, picture_marker(level), alarm_per_km2[level]);
    }
    fprintf(file, "\n");
    picture_close(&picture);
}

static void draw_delays(const struct alarm_figures *figures, const char *path)
{
    struct picture picture = picture_open(path, 1000, 520);
    FILE *file = picture.script;
    fprintf(file, "$delays << EOD\n");
    for (size_t i = 0; i < DELAY_LEVELS; i++) {
        fprintf(file, "%zu %g %g %g\n", i, figures->delays[i].per_km2,
                figures->delays[i].confirmed_at, figures->delays[i].possible_at);
    }
    fprintf(file,
            "EOD\nset yrange [0:*]\nset xrange [-0.5:%g]\nset xlabel 'clutter plots a km^2 and "
            "scan'\nset ylabel 'confirmed at scan, mean'\nset key top left inside\n"
            "plot $delays using 1:3:xtic(2) with linespoints lt 1 lw 2 pt 7 title 'rhotrack', \\\n"
            " '' using 1:4 with linespoints lt 2 lw 2 dt 2 pt 6 title 'first possible'\n",
            (double)DELAY_LEVELS - 0.5);
    picture_close(&picture);
}

static void draw_shares(const struct alarm_figures *figures, const char *path)
{
    struct picture picture = picture_open(path, 1000, 520);
    FILE *file = picture.script;
    for (size_t i = 0; i < DELAY_LEVELS; i++) {
        fprintf(file, "$level%zu << EOD\n", i);
        for (size_t scan = 0; scan < DELAY_SCANS; scan++) {
            fprintf(file, "%zu %g\n", scan + 1, figures->delays[i].share_at[scan]);
        }
        fprintf(file, "EOD\n");
    }
    fprintf(file, "set xlabel 'scan'\nset ylabel 'share of the targets confirmed'\n"
                  "set yrange [-0.02:1.02]\nset key outside right\nplot ");
    for (size_t i = 0; i < DELAY_LEVELS; i++) {
        fprintf(file, "%s$level%zu with linespoints lw 2 lt %zu pt %d title '%g a km^2'",
                i == 0 ? "" : ", \\\n ", i, i + 1, picture_marker(i), delay_per_km2[i]);
    }
    fprintf(file, "\n");
    picture_close(&picture);
}

static void write_page(const struct alarm_figures *figures, const struct verdicts *verdicts,
                       size_t num_runs, uint64_t seed, const char *path)
{
    struct page page = page_open(path, "False tracks an hour, and time to confirm");
    struct grid alarms = alarm_grid(figures), delays = delay_grid(figures);
    page_text(&page,
              "%zu runs, seed %llu: %d bars held, %d missed. Area, noise and speeds of the "
              "paper's Table 1, a scan every 2 s, min_scans 0.",
              num_runs, (unsigned long long)seed, verdicts->held, verdicts->missed);
    page_heading(&page, "Clutter alone");
    page_text(&page, "Runs of %d scans without a target: every confirmed track is false.",
              ALARM_SCANS);
    page_figure(&page, "rates.svg", "Confirmed tracks an hour against false_tracks_per_hour.");
    page_table(&page, &alarms);
    page_heading(&page, "Targets");
    page_text(&page, "Three targets from the first scan on, P_D 0.99, 0.9 assumed, one false track "
                     "an hour wanted. First possible: the scan at which a fit through the target's "
                     "own plots reaches the threshold that was in use.");
    page_figure(&page, "delays.svg", "Scans until a target is confirmed.");
    page_figure(&page, "shares.svg", "Targets confirmed by each scan.");
    page_table(&page, &delays);
    page_heading(&page, "What must hold");
    page_table(&page, &verdicts->grid);
    page_close(&page);
    grid_free(&alarms);
    grid_free(&delays);
}

void alarm_page(const struct alarm_figures *figures, const struct verdicts *verdicts,
                size_t num_runs, uint64_t seed, const char *folder)
{
    make_folder(folder);
    char *rates = path_join(folder, "rates.svg"), *delays = path_join(folder, "delays.svg");
    char *shares = path_join(folder, "shares.svg"), *page = path_join(folder, "index.html");
    draw_rates(figures, rates);
    draw_delays(figures, delays);
    draw_shares(figures, shares);
    write_page(figures, verdicts, num_runs, seed, page);
    free(rates);
    free(delays);
    free(shares);
    free(page);
}
