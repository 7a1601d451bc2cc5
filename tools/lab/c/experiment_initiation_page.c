/* SPDX-License-Identifier: MIT */
#include "experiment_initiation_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "page.h"
#include "picture/picture.h"

/* ---- bars and figures ------------------------------------------------------------------------ */

/* gnuplot would take the underscores and carets of a case's name as markup. */
static void put_name(FILE *file, const char *name)
{
    fputc('"', file);
    for (; *name; name++) {
        if (strchr("_^{}@&~", *name)) {
            fputs("\\\\", file);
        }
        fputc(*name, file);
    }
    fputc('"', file);
}

static void put_value(FILE *file, double value)
{
    if (isnan(value)) {
        fprintf(file, " NaN");
    } else {
        fprintf(file, " %.5g", value);
    }
}

static bool has_targets(const struct initiation_summary *summary)
{
    return !isnan(summary->pd);
}

/*
 * Found as its bar counts it, the clairvoyant's, the bar; false tracks and their bar. One row a
 * case, the first on top.
 */
static void put_rows(FILE *file, const struct initiation_summary *summaries, bool need_targets)
{
    fprintf(file, "$rows << EOD\n");
    for (size_t i = initiation_num_cases(); i-- > 0;) {
        const struct initiation_summary *summary = &summaries[i];
        if (need_targets && !has_targets(summary)) {
            continue;
        }
        put_name(file, summary->of->name);
        put_value(file, summary->of->all_count ? summary->all_found : summary->pd);
        put_value(file, summary->of->all_count ? NAN : summary->clairvoyant);
        put_value(file, summary->of->bars.found_min);
        put_value(file, summary->false_a_run);
        put_value(file, summary->of->bars.false_max);
        fprintf(file, "\n");
    }
    fprintf(file, "EOD\n");
}

static void draw_found(const struct initiation_summary *summaries, const char *path)
{
    struct picture picture = picture_open(path, 1100, 900);
    put_rows(picture.script, summaries, true);
    fprintf(
        picture.script,
        "set key bottom left inside\nset xrange [-0.02:1.02]\nset offsets 0,0,0.7,0.7\n"
        "set xlabel 'share found'\n"
        "plot $rows using 4:0:ytic(1) with points pt 2 ps 1.1 lw 2 lc rgb '#7f7f7f' title 'bar', "
        "\\\n"
        " '' using 3:0 with points pt 6 ps 1.5 lw 2 lc rgb '#d55e00' title 'clairvoyant fit', \\\n"
        " '' using 2:0 with points pt 7 ps 0.9 lc rgb '#0072b2' title 'rhotrack'\n");
    picture_close(&picture);
}

static void draw_false(const struct initiation_summary *summaries, const char *path)
{
    struct picture picture = picture_open(path, 1100, 900);
    put_rows(picture.script, summaries, false);
    fprintf(picture.script,
            "set key bottom right inside\nset xrange [-0.01:*]\nset offsets 0,0,0.7,0.7\n"
            "set xlabel 'false tracks a run'\n"
            "plot $rows using 6:0:ytic(1) with points pt 2 ps 1.1 lw 2 lc rgb '#7f7f7f' title "
            "'bar', \\\n"
            " '' using 5:0 with points pt 7 ps 0.9 lc rgb '#0072b2' title 'rhotrack'\n");
    picture_close(&picture);
}

/* ---- one run --------------------------------------------------------------------------------- */

struct example {
    struct scenario_plan plan;
    struct simulation *simulation;
    struct rho_initiator *initiator;
};

static void put_plots(FILE *file, const struct simulation *simulation, bool of_targets)
{
    fprintf(file, "$%s << EOD\n", of_targets ? "targets" : "clutter");
    for (size_t i = 0; i < simulation->num_scans; i++) {
        const struct simulated_scan *scan = &simulation->scans[i];
        for (size_t j = 0; j < scan->num_plots; j++) {
            if ((scan->plots[j].target_id >= 0) == of_targets) {
                fprintf(file, "%.3f %.3f\n", scan->plots[j].x_m / 1e3, scan->plots[j].y_m / 1e3);
            }
        }
    }
    fprintf(file, "EOD\n");
}

/* Each candidate from the first scan to the last. */
static void put_tracks(FILE *file, const struct rho_initiator *initiator, double span_s)
{
    fprintf(file, "$tracks << EOD\n");
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        const struct rho_candidate *track = &initiator->candidates[i];
        fprintf(file, "%.4f %.4f\n", (track->x_m - track->vx_mps * span_s) / 1e3,
                (track->y_m - track->vy_mps * span_s) / 1e3);
        fprintf(file, "%.4f %.4f\n\n\n", track->x_m / 1e3, track->y_m / 1e3);
    }
    fprintf(file, "EOD\n");
}

static void draw_example(const struct example *example, const char *path)
{
    double span_s = example->plan.interval_s * (double)(example->plan.num_scans - 1);
    struct picture picture = picture_open(path, 1100, 700);
    put_plots(picture.script, example->simulation, false);
    put_plots(picture.script, example->simulation, true);
    put_tracks(picture.script, example->initiator, span_s);
    fprintf(picture.script,
            "set size ratio -1\nset xlabel 'x east (km)'\nset ylabel 'y north (km)'\n"
            "plot $clutter with points pt 7 ps 0.25 lc rgb '#b0b0b0' title 'clutter plots', \\\n"
            " $targets with points pt 6 ps 1 lw 1.5 lc rgb '#000000' title 'target plots', \\\n"
            " $tracks with lines lw 2.5 lc rgb '#0072b2' title 'tracks found'\n");
    picture_close(&picture);
}

static const struct initiation_case *example_case(void)
{
    for (size_t i = 0; i < initiation_num_cases(); i++) {
        const struct initiation_case *of = initiation_case_at(i);
        if (of->paths == PATHS_CROSSING && of->clutter_per_km2 == 10.0) {
            return of;
        }
    }
    return initiation_case_at(0);
}

static void make_example(uint64_t seed, const char *path)
{
    const struct initiation_case *of = example_case();
    struct random random = random_start(seed, 0, 0);
    struct example example = {.plan = initiation_plan(of, &random),
                              .initiator = must_alloc(sizeof *example.initiator)};
    example.simulation = plan_simulate(&example.plan, &random);
    initiation_judge(of, &example.plan, example.simulation, example.initiator);
    draw_example(&example, path);
    simulation_free(example.simulation);
    plan_free(&example.plan);
    free(example.initiator);
}

/* ---- the page -------------------------------------------------------------------------------- */

static void write_bars(struct page *page, const struct initiation_summary *summaries,
                       size_t num_runs, uint64_t seed)
{
    struct grid cases = initiation_grid(summaries, initiation_num_cases());
    struct grid work = initiation_work_grid(summaries);
    struct initiation_score score = initiation_score(summaries);
    page_heading(page, "The default method's bars");
    page_text(page,
              "Method kernel, %zu runs a case, seed %llu: %d bars held, %d missed. A target is "
              "found when a track is, in the mean over the scans, within the case's tolerance of "
              "it, one to one. The clairvoyant fit knows which plots are the target's, and is held "
              "against the same threshold.",
              num_runs, (unsigned long long)seed, score.held, score.missed);
    page_figure(page, "example.svg",
                "One run: Table 1's three targets among 100 clutter plots a scan, 7 scans, and the "
                "tracks found.");
    page_heading(page, "Targets found");
    page_figure(
        page, "found.svg",
        "Share of the targets found, or of the runs where all were found where the bar is about "
        "these, beside what the clairvoyant fit finds.");
    page_heading(page, "False tracks");
    page_figure(page, "false.svg", "Tracks that are no target's, in the mean over the runs.");
    page_heading(page, "All figures");
    page_table(page, &cases);
    page_heading(page, "Work");
    page_table(page, &work);
    grid_free(&cases);
    grid_free(&work);
}

static void draw_bars(const struct initiation_summary *summaries, uint64_t seed, const char *folder)
{
    char *found = path_join(folder, "found.svg"), *wrong = path_join(folder, "false.svg");
    char *example = path_join(folder, "example.svg");
    draw_found(summaries, found);
    draw_false(summaries, wrong);
    make_example(seed, example);
    free(found);
    free(wrong);
    free(example);
}

void initiation_page(const struct initiation_summary *summaries, const struct classic_report *paper,
                     size_t num_runs, uint64_t seed, const char *folder)
{
    make_folder(folder);
    char *path = path_join(folder, "index.html");
    struct page page = page_open(path, "Track initiation from plots in clutter");
    if (paper != NULL) {
        classic_page(paper, &page, folder);
    }
    if (summaries != NULL) {
        draw_bars(summaries, seed, folder);

        write_bars(&page, summaries, num_runs, seed);
    }
    if (paper != NULL) {
        classic_page_verdicts(paper, &page);
    }

    page_close(&page);
    free(path);
}
