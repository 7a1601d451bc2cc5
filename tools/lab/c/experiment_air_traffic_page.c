/* SPDX-License-Identifier: MIT */
/* experiment_air_traffic_page: pictures, and the page. */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "experiment_air_traffic.h"
#include "page.h"
#include "picture/picture.h"

/* ---- figures against clutter ----------------------------------------------------------------- */

typedef double (*figure_of)(const struct air_result *result, bool is_limit);

static double gospa_m(const struct air_result *result, bool is_limit)
{
    return is_limit ? result->limit[0].gospa_m : result->tracks[0].gospa_m;
}

static double complete(const struct air_result *result, bool is_limit)
{
    return is_limit ? result->limit[0].completeness : result->tracks[0].completeness;
}

static double false_a_scan(const struct air_result *result, bool is_limit)
{
    return is_limit ? result->limit[0].false_a_scan : result->tracks[0].false_a_scan;
}

static double time_ms(const struct air_result *result, bool is_limit)
{
    (void)is_limit;
    return result->us / 1e3;
}

static const double levels[] = {10, 50, 200, 1000};
#define LEVELS (sizeof levels / sizeof levels[0])

/* A picture: a curve for each number of aircraft, over that number to a power. */
struct curves {
    const char *name, *label, *more, *caption;
    figure_of of;
    double power;
    bool has_limit;
};

static const struct curves pictures[] = {
    {"gospa.svg", "GOSPA over the root of the number of aircraft, m", "set yrange [0:*]",
     "GOSPA (p 2, alpha 2, cutoff 1 km) over the root of the number of aircraft; dashed: the "
     "limit. Runs "
     "with 1000 aircraft are short, and aircraft have no track in the first scans.",
     gospa_m, 0.5, true},
    {"complete.svg", "completeness", "set yrange [*:1.002]",
     "Share of the aircraft's scans that have a track.", complete, 0.0, true},
    {"false.svg", "false tracks a scan and aircraft", "set yrange [0:*]",
     "Tracks without an aircraft, a scan and aircraft.", false_a_scan, 1.0, true},
    {"time.svg", "ms a scan", "set logscale y", "Time of a scan, one core.", time_ms, 0.0, false},
};
#define PICTURES (sizeof pictures / sizeof pictures[0])

/* Clutter 0 stands at 10 on the logarithmic axis. */
static void put_level(FILE *file, const struct air_report *report, size_t level,
                      const struct curves *curves)
{
    double scale = pow(levels[level], -curves->power);

    fprintf(file, "$level%zu << EOD\n", level);
    for (size_t i = 0; i < air_num_cases(); i++) {
        const struct air_case *of = &air_cases[i];
        if (of->group == AIR_GRID && fabs(of->targets - levels[level]) < 0.5) {
            fprintf(file, "%g %g %g\n", fmax(of->clutter, 10.0),
                    scale * curves->of(&report->results[i], false),
                    scale * curves->of(&report->results[i], true));
        }
    }
    fprintf(file, "EOD\n");
}

static void draw_curves(const struct air_report *report, const struct curves *curves,
                        const char *path)
{
    struct picture picture = picture_open(path, 1000, 520);
    FILE *file = picture.script;

    for (size_t level = 0; level < LEVELS; level++) {
        put_level(file, report, level, curves);
    }
    fprintf(
        file,
        "set logscale x\nset xrange [8:7000]\nset xtics ('0' 10, '100' 100, '1000' 1000, '5000' "
        "5000)\nset xlabel 'clutter plots a scan'\nset ylabel '%s'\nset key outside right\n%s\n"
        "plot ",
        curves->label, curves->more);
    for (size_t level = 0; level < LEVELS; level++) {
        fprintf(
            file, "%s$level%zu using 1:2 with linespoints lw 2 lt %zu pt %d title '%g aircraft'",
            level == 0 ? "" : ", \\\n ", level, level + 1, picture_marker(level), levels[level]);
        if (curves->has_limit) {
            fprintf(file,
                    ", \\\n $level%zu using 1:3 with lines lw 1.5 dt 2 lt %zu title 'its limit'",
                    level, level + 1);
        }
    }
    fprintf(file, "\n");
    picture_close(&picture);
}

/* ---- operating characteristic ---------------------------------------------------------------- */

static void draw_operation(const struct air_report *report, const char *path)
{
    static const size_t by[] = {3, 4, 5, 6, 8, 10};
    struct picture picture = picture_open(path, 1000, 620);
    FILE *file = picture.script;

    fprintf(file, "$cases << EOD\n");
    for (size_t i = 0; i < air_num_cases(); i++) {
        const struct air_result *of = &report->results[i];
        if (air_cases[i].group == AIR_OPERATION) {
            /* none seen: half a track */
            fprintf(file, "%g", fmax(of->alarms, 0.5) / of->alarm_hours);
            for (size_t k = 0; k < sizeof by / sizeof by[0]; k++) {
                fprintf(file, " %g", of->found[by[k] - 1] / of->alive[by[k] - 1]);
            }
            fprintf(file, "\n");
        }
    }
    fprintf(file,
            "EOD\nset logscale x\nset xlabel 'false tracks an hour in clutter alone'\nset ylabel "
            "'share of the "
            "aircraft that have a track'\nset yrange [-0.02:1.02]\nset key outside right\nplot ");
    for (size_t k = 0; k < sizeof by / sizeof by[0]; k++) {
        fprintf(file, "%s$cases using 1:%zu with linespoints lw 2 lt %zu pt %d title 'by scan %zu'",
                k == 0 ? "" : ", \\\n ", k + 2, k + 1, picture_marker(k), by[k]);
    }
    fprintf(file, "\n");
    picture_close(&picture);
}

/* ---- the page -------------------------------------------------------------------------------- */

static void draw_grid(const struct air_report *report, const char *folder)
{
    for (size_t i = 0; i < PICTURES; i++) {
        char *path = path_join(folder, pictures[i].name);
        draw_curves(report, &pictures[i], path);
        free(path);
    }
}

static void put_pictures(struct page *page, const struct air_report *report)
{
    for (size_t i = 0; i < PICTURES && (report->parts & AIR_PART_GRID) != 0; i++) {
        page_figure(page, pictures[i].name, pictures[i].caption);
    }
    if ((report->parts & AIR_PART_OPERATION) != 0) {
        page_figure(page, "operation.svg",
                    "Detection by scan k of an aircraft's life against false tracks an hour: "
                    "false_tracks_per_hour from 0.01 to 10000.");
    }
}

static void write_page(const struct air_report *report, const char *path)
{
    struct page page = page_open(path, "Air traffic");
    struct air_table tables[AIR_TABLES];
    size_t count = air_tables(report, tables);

    page_text(
        &page,
        "%zu runs, seed %llu: %d bars held, %d missed. 500 x 500 km, a scan every 10 s, sigma "
        "50 m, P_D 0.95; aircraft come and go, %s.",
        report->num_runs, (unsigned long long)report->seed, report->verdicts.held,
        report->verdicts.missed, "turn, hold and cross");
    put_pictures(&page, report);
    for (size_t i = 0; i < count; i++) {
        page_heading(&page, tables[i].heading);
        page_text(&page, "%s", tables[i].text);
        page_table(&page, &tables[i].grid);
        grid_free(&tables[i].grid);
    }
    page_heading(&page, "What must hold");
    page_table(&page, &report->verdicts.grid);
    page_close(&page);
}

void air_page(const struct air_report *report, const char *folder)
{
    char *page = path_join(folder, "index.html"), *operation = path_join(folder, "operation.svg");

    make_folder(folder);
    if ((report->parts & AIR_PART_GRID) != 0) {
        draw_grid(report, folder);
    }
    if ((report->parts & AIR_PART_OPERATION) != 0) {
        draw_operation(report, operation);
    }
    write_page(report, page);
    free(page);
    free(operation);
}
