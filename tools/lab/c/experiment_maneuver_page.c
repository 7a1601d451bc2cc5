/* SPDX-License-Identifier: MIT */
#include <stdlib.h>

#include "base/common.h"
#include "experiment_maneuver_report.h"
#include "page.h"

static void put_table(struct page *page, struct grid grid)
{
    page_table(page, &grid);
    grid_free(&grid);
}

/* ---- centred on the truth -------------------------------------------------------------------- */

static void put_paper(struct page *page, const struct maneuver_report *report)
{
    page_heading(page, "The paper's methods, clutter around the truth");
    page_text(
        page,
        "Places and velocities are measured, R = Q = I; a target that pulls 10 g: pop-up or weave. "
        "N clutter plots lie uniformly within half the beam's width, R sin(0.6 degrees), of the "
        "target, 639 to 314 m, with the velocities that would have brought them from where it "
        "was; the first three scans are clean. %zu runs, %zu with 100 clutter plots; "
        "measured/reference.",
        report->paper.runs[0], report->paper.runs[3]);
    page_text(
        page,
        "Method I: Hough gate and input estimation as printed; with gamma .5 the estimated input "
        "is forgotten by half a scan. II: no input estimation. III: a plot at random. Nearest: the "
        "nearest plot, gamma .5. Clairvoyant: knows the target's plots and its input, double "
        "precision. Default: believes in physical motion, so that the paper's noise of 1 m and 1 "
        "m/s a scan in a target's path is a surprise to it. Inside: share of the runs with every "
        "axis within the beam's radius. Wrong: "
        "share of scans in which clutter was taken. Most: of all runs. Rms: 3-D, of all runs, "
        "after 2 s. Extreme: medians of the runs' extreme velocity errors.");
    put_table(page, maneuver_paper_grid(report));
}

static void put_noise(struct page *page, const struct maneuver_report *report)
{
    page_heading(page, "Where the paper's contrast appears");
    page_text(
        page,
        "With the paper's Q = R = I Method II passes: velocities are measured, and the gain is "
        "0.6. The same scenes with true process noise 1e-4 I, 4 clutter plots, pop-up, %zu runs: "
        "only filters that believe in a Q about as small lose the target without input "
        "estimation, and with it, unless it forgets.",
        report->noise.runs[0]);
    put_table(page, maneuver_noise_grid(report));
}

static void put_pictures(struct page *page, const struct maneuver_report *report)
{
    page_heading(page, "The paper's figures");
    page_text(page,
              "Four clutter plots. Coloured: run 0 of seed %llu; grey: what %d runs' errors lie "
              "between, all axes.",
              (unsigned long long)report->seed, MANEUVER_FIRST_RUNS);
    for (size_t i = 0; i < maneuver_num_pictures; i++) {
        page_figure(page, maneuver_pictures[i].file, maneuver_pictures[i].caption);
    }
}

/* ---- the beam follows the prediction --------------------------------------------------------- */

static void put_closed(struct page *page, const struct maneuver_report *report)
{
    page_heading(page, "The beam follows the prediction");
    page_text(
        page,
        "Physical accelerations with noise of 2 m/s^2 a scan; places are measured, or velocities "
        "too; clutter lies around the tracker's own prediction, and a target outside the beam is "
        "not seen. Weave unless said otherwise; told 12 g unless said otherwise. Lost: share of "
        "the runs in which the place was off by more than the beam's radius at any time, %%; "
        "measured/reference; %zu runs a case. The default gets the clutter's density and P_D, "
        "0.995 at most. Paper: Method I, physical D where only places are measured. Nearest: the "
        "same with the nearest plot. IMM and clairvoyant: double precision, know the plots. "
        "Hypotheses: the default's, mean. Polar: 15 m, 3 mrad, from 61 km on; a radar that looks "
        "all round.",
        report->closed.runs[0]);
    put_table(page, maneuver_lost_grid(report));
    page_text(page, "Errors of the tracks that were kept, after 2 s: of the default, over those of "
                    "the IMM in the same runs, and of the clairvoyant. NIS: of the target's plot, "
                    "1 a dimension where the covariance is right.");
    put_table(page, maneuver_error_grid(report));
    page_heading(page, "Another P_D than the true one");
    page_text(page, "The default with 10 g, 10 m, 10 clutter plots and a true P_D of .9; %zu runs.",
              report->pd.runs[0]);
    put_table(page, maneuver_pd_grid(report));
}

static void write_page(const struct maneuver_report *report, const char *path)
{
    struct page page = page_open(path, "Targets that manoeuvre in clutter");
    page_text(&page,
              "The experiments of a novel tracking algorithm by integrating the Kalman filter, "
              "input estimation, and clutter elimination algorithm to track maneuvering targets "
              "in cluttered environments, and the default beside it; 161 scans 0.25 s apart, seed "
              "%llu: %d bars held, %d missed. The paper gives no manoeuvres: these are ours. "
              "References were measured by an independent implementation in double precision.",
              (unsigned long long)report->seed, report->verdicts.held, report->verdicts.missed);
    put_paper(&page, report);
    put_noise(&page, report);
    put_closed(&page, report);
    put_pictures(&page, report);
    page_heading(&page, "What must hold");
    page_table(&page, &report->verdicts.grid);
    page_close(&page);
}

void maneuver_page(const struct maneuver_report *report, const char *folder)
{
    make_folder(folder);
    char *page = path_join(folder, "index.html");
    for (size_t i = 0; i < maneuver_num_pictures; i++) {
        maneuver_draw(&maneuver_pictures[i], report->seed, folder);
    }
    write_page(report, page);
    free(page);
}
