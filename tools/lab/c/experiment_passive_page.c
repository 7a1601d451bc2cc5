/* SPDX-License-Identifier: MIT */
#include <stdlib.h>

#include "base/common.h"
#include "experiment_passive_report.h"
#include "page.h"

static void put_table(struct page *page, struct grid grid)
{
    page_table(page, &grid);
    grid_free(&grid);
}

/* ---- the paper's figures --------------------------------------------------------------------- */

static const struct {
    const char *picture, *caption;
} pictures[] = {
    {"figure-2.svg", "Fig. 2, feature space: two real trajectories, and the ghosts in view."},
    {"figure-6.svg", "Fig. 6, parameter space histogram: what the crossings of Fig. 2 vote for."},
    {"figure-7.svg", "Fig. 7, parameter space after threshold detection: cells with T votes."},
    {"figure-3.svg", "Fig. 3, feature space: the same after pruning."},
    {"figure-8.svg", "Fig. 8, parameter space histogram after pruning."},
    {"figure-9.svg", "Fig. 9, parameter space after pruning and threshold detection."},
    {"figure-4.svg", "Fig. 4, three sensors observe two trajectories: crossings of each pair "
                     "that pruning leaves."},
    {"figure-5.svg", "Fig. 5, parameter space for the three-sensor case: the lines of each pair, "
                     "and those that all pairs confirm."},
};

static void put_figures(struct page *page, const struct passive_report *report)
{
    page_heading(page, "The paper's figures");
    page_text(
        page,
        "Scenes with the paper's sensors at (10 km, -90 degrees) and (10 km, 90 degrees), the "
        "third "
        "at (10 km, 0): two targets, eight scans, 0.05 degrees, nothing missed, nothing false; "
        "cells of 2 "
        "degrees and 1 km, votes of distinct scans. They are fixed (runs %d and %d of seed %d), "
        "and were "
        "sought so that they show what the paper's figures do; the tables say how often it is so.",
        PASSIVE_FIGURES_TWO_RUN, PASSIVE_FIGURES_THREE_RUN, PASSIVE_FIGURES_SEED);
    put_table(page, passive_figures_grid(report));
    for (size_t i = 0; i < sizeof pictures / sizeof pictures[0]; i++) {
        page_figure(page, pictures[i].picture, pictures[i].caption);
    }
}

/* ---- tables ---------------------------------------------------------------------------------- */

static void put_pruning(struct page *page, const struct passive_report *report)
{
    page_heading(page, "Pruning alone");
    page_text(
        page,
        "Sensors 1 and 2, 0.1 degrees, %zu runs of 8 scans; measured/reference. Shares of "
        "the ghosts that are removed and of the targets' crossings that are lost. Eliminated: by "
        "side and range, step 1 of the paper. Literal: steps 2 to 2.6, too. Safe: these where as "
        "many "
        "bearings came from both sensors and each keeps a crossing. P_D: probability of "
        "detection, FA: mean false bearings of a look; 1 and 0 where clean.",
        report->pruning_runs);
    put_table(page, passive_pruning_grid(report));
}

static void put_paper(struct page *page, const struct passive_report *report)
{
    page_heading(page, "The paper's method");
    page_text(page,
              "s sensors, t targets, degrees; %zu runs, measured/reference. Pd: share of the "
              "targets with a line within 6 degrees and 3 km. Ghosts: lines with no such target. "
              "Exact: share of the runs with all targets and no ghost.",
              report->paper_runs);
    put_table(page, passive_paper_grid(report));
}

static void put_default(struct page *page, const struct passive_report *report)
{
    char note[PASSIVE_NOTE];
    page_heading(page, "The default");
    page_text(page,
              "%zu runs, measured/reference. Found: a track within 1 km at mid-batch, or 4 "
              "standard deviations of the fit where that is more; of several the nearest over the "
              "batch. Fit: with the target's own bearings, in double precision. Rms: of the place "
              "at mid-batch. Theta, rho: median errors of the line. NEES: of the state at the "
              "newest scan, 4 where its covariance is right; own's: of tracks with none but their "
              "target's bearings; mixed: share of the others. Ms: median processor time of a "
              "search.",
              report->default_runs);
    put_table(page, passive_default_grid(report));
    page_text(page, "%s", passive_nees_note(report, note));
}

static void put_chain(struct page *page, const struct passive_report *report)
{
    page_heading(page, "Bearings through the tracker");
    page_text(page,
              "The whole chain, %zu runs, 10 s a frame, 0.1 degrees, targets of 150 to 250 m/s. "
              "Tracked: share of the targets with a believed track within 1 km, or 4 of its "
              "standard deviations where that is more, at the last frame. False: believed tracks "
              "that are so near to a target in less than half of their frames. Filter: an extended "
              "Kalman filter in double precision with the target's own bearings, opened with a fit "
              "to those of the first 8 frames; rms of the place over the same frames.",
              report->chain_runs);
    put_table(page, passive_chain_grid(report->chain));
}

static void write_page(const struct passive_report *report, const char *path)
{
    struct page page = page_open(path, "Bearings of passive sensors");
    page_text(
        &page,
        "The experiments of the passive Hough transform with ghost elimination, and the "
        "default beside it; 8 scans 10 s apart, targets 20 to 75 km ahead, seed %llu: %d bars "
        "held, %d missed. The paper gives no scan interval, noise, cells, threshold, misses "
        "or false alarms: these are ours. References were measured by an independent "
        "implementation in double precision with 50 to 300 runs.",
        (unsigned long long)report->seed, report->verdicts.held, report->verdicts.missed);
    put_pruning(&page, report);
    if (report->paper != NULL) {
        put_figures(&page, report);
        put_paper(&page, report);
    }
    if (report->defaults != NULL) {
        put_default(&page, report);
        put_chain(&page, report);
    }
    page_heading(&page, "What must hold");
    page_table(&page, &report->verdicts.grid);
    page_close(&page);
}

void passive_page(const struct passive_report *report, const char *folder)
{
    make_folder(folder);
    char *page = path_join(folder, "index.html");
    if (report->paper != NULL) {
        passive_draw_pictures(report->figures, folder);
    }
    write_page(report, page);
    free(page);
}
