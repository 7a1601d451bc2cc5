/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "experiment_classic.h"
#include "page.h"
#include "picture/picture.h"

/* ---- curves ---------------------------------------------------------------------------------- */

/* Line type 1 .. 6, the same in all pictures. */
#define STYLE(method) ((method) + 1)

static void put_value(FILE *file, double value)
{
    if (isfinite(value)) {
        fprintf(file, " %.5g", value);
    } else {
        fprintf(file, " NaN");
    }
}

static bool is_swept(const struct classic_report *report, size_t method)
{
    return report->sweep[0][method].situation != NULL;
}

static bool has_sweep(const struct classic_report *report)
{
    bool has = false;
    for (size_t method = 0; method < CLASSIC_KERNEL; method++) {
        has |= is_swept(report, method);
    }
    return has;
}

/*
 * A row for each noise: its number, its name, then a figure of each method. A logarithmic axis
 * starts at `least`.
 */
static void put_sweep(FILE *file, const struct classic_report *report, enum classic_figure figure,
                      double least)
{
    fprintf(file, "$sweep%d << EOD\n", (int)figure);
    for (size_t i = 0; i < CLASSIC_NOISES; i++) {
        fprintf(file, "%zu \"%g\"", i, report->sweep_situations[i].noise_m);
        for (size_t method = 0; method < CLASSIC_METHODS; method++) {
            put_value(file, is_swept(report, method)
                                ? fmax(report->sweep[i][method].mean[figure], least)
                                : NAN);
        }
        fprintf(file, "\n");
    }
    fprintf(file, "EOD\n");
}

static void plot_sweep(FILE *file, const struct classic_report *report, enum classic_figure figure)
{
    const char *separator = "plot ";
    for (size_t method = 0; method < CLASSIC_METHODS; method++) {
        if (is_swept(report, method)) {
            fprintf(file, "%s$sweep%d using 1:%zu:xtic(2) with linespoints lt %zu title '%s'",
                    separator, (int)figure, method + 3, STYLE(method),
                    classic_method_names[method]);
            separator = ", \\\n ";
        }
    }
    fprintf(file, "\n");
}

static void draw_sweep(const struct classic_report *report, const char *path)
{
    struct picture picture = picture_open(path, 1300, 480);
    FILE *file = picture.script;
    put_sweep(file, report, CLASSIC_DETECTED, 0.0);
    put_sweep(file, report, CLASSIC_FALSE, 0.01);
    fprintf(file, "set multiplot layout 1,2\nset xrange [-0.3:6.3]\nset xlabel 'noise (m)'\n"
                  "set ylabel 'share of the targets detected'\nset yrange [0:1.05]\nunset key\n"
                  "set rmargin at screen 0.43\n");
    plot_sweep(file, report, CLASSIC_DETECTED);
    fprintf(file,
            "set lmargin at screen 0.53\nset rmargin at screen 0.87\nset logscale y\n"
            "set yrange [0.007:5000]\nset ytics ('0' 0.01, '0.1' 0.1, '1' 1, '10' 10, '100' 100, "
            "'1000' 1000)\nset ylabel 'false peaks a run'\nset key outside right top\n");
    plot_sweep(file, report, CLASSIC_FALSE);
    fprintf(file, "unset multiplot\n");
    picture_close(&picture);
}

static void put_times(FILE *file, const struct classic_report *report)
{
    fprintf(file, "$times << EOD\n");
    for (size_t i = 0; i < report->num_times; i++) {
        const struct classic_time *time = &report->times[i];
        fprintf(file, "%g", time->per_km2);
        for (size_t method = 0; method <= CLASSIC_METHODS; method++) {
            put_value(file, time->time_us[method] / 1e3);
        }
        for (size_t method = 0; method <= CLASSIC_METHODS; method++) {
            put_value(file, time->votes[method]);
        }
        fprintf(file, "\n");
    }
    fprintf(file, "EOD\n");
}

static void plot_times(FILE *file, const struct classic_report *report, bool is_votes)
{
    size_t first = is_votes ? CLASSIC_METHODS + 3 : 2;
    const char *separator = "plot ";
    for (size_t method = 0; method < CLASSIC_METHODS; method++) {
        if (classic_has(report, method) && (!is_votes || method < CLASSIC_KERNEL)) {
            fprintf(file, "%s$times using 1:%zu with linespoints lt %zu title '%s%s'", separator,
                    first + method, STYLE(method), classic_method_names[method],
                    method == RHO_HOUGH_HT ? ", streamed" : "");
            separator = ", \\\n ";
        }
    }
    if (!is_votes) {
        fprintf(file, "%s$times using 1:%zu with linespoints lt 8 dt 2 title 'HT, dense plane'",
                separator, first + CLASSIC_DENSE);
    }
    fprintf(file, "\n");
}

static void draw_times(const struct classic_report *report, const char *path)
{
    struct picture picture = picture_open(path, 1300, 480);
    FILE *file = picture.script;
    put_times(file, report);
    fprintf(file, "set multiplot layout 1,2\nset logscale xy\nset xrange [0.08:40]\n"
                  "set xlabel 'clutter plots a square kilometre and scan'\n"
                  "set ylabel 'votes'\nset format y '10^{%%T}'\nunset key\n"
                  "set rmargin at screen 0.38\n");
    if (report->methods != 1u << CLASSIC_KERNEL) {
        plot_times(file, report, true);
    }
    fprintf(file, "set lmargin at screen 0.47\nset rmargin at screen 0.79\nset format y '%%g'\n"
                  "set ylabel 'time of a search (ms)'\nset key outside right top\n");
    plot_times(file, report, false);
    fprintf(file, "unset multiplot\n");
    picture_close(&picture);
}

/* ---- what was found -------------------------------------------------------------------------- */

static double mean(const struct classic_report *report, size_t situation, size_t method,
                   enum classic_figure figure)
{
    return report->summaries[situation][method].mean[figure];
}

#define DETECTED(situation, method) mean(report, situation, method, CLASSIC_DETECTED)
#define FALSE_PEAKS(situation, method) mean(report, situation, method, CLASSIC_FALSE)
#define DISCRIMINATION(situation, method) mean(report, situation, method, CLASSIC_DISCRIMINATION)
#define VOTES(situation, method) mean(report, situation, method, CLASSIC_VOTES)

static void put_first_situations(const struct classic_report *report, struct page *page)
{
    page_text(page,
              "Situation I, Fig. 7: all methods do well. This holds: HT, MHT and IHT detect all "
              "targets, NHT %.2f of them (a missed plot takes two pairs from it, and a third "
              "one's kernel), and the targets' peaks are twice as high as what tau leaves out.",
              DETECTED(SITUATION_I, RHO_HOUGH_NHT_C));
    page_text(page,
              "Situation II, Fig. 8: noise harms MHT and IHT, not HT and NHT. For HT this holds "
              "(%.2f detected, discrimination %.2f, though with %.0f false peaks), and for MHT and "
              "IHT (discrimination %.2f and %.2f). For NHT it does not: %.2f (A) and %.2f (C) are "
              "detected. The lines of one pair of plots and the next differ by sigma sqrt(6) / (v "
              "T): 43 to 61 mrad at 10 m, but kernels are sought within 8 mrad. Six of seven pairs "
              "find none, and do not vote.",
              DETECTED(SITUATION_II, RHO_HOUGH_HT), DISCRIMINATION(SITUATION_II, RHO_HOUGH_HT),
              FALSE_PEAKS(SITUATION_II, RHO_HOUGH_HT), DISCRIMINATION(SITUATION_II, RHO_HOUGH_MHT),
              DISCRIMINATION(SITUATION_II, RHO_HOUGH_IHT), DETECTED(SITUATION_II, RHO_HOUGH_NHT_A),
              DETECTED(SITUATION_II, RHO_HOUGH_NHT_C));
}

static void put_last_situations(const struct classic_report *report, struct page *page)
{
    page_text(page,
              "Situation III, Fig. 9: clutter harms HT, not the others. This holds: HT's highest "
              "false peak is above the targets' (discrimination %.2f, %.0f false peaks); MHT is at "
              "the edge (%.2f, %.0f); IHT (%.2f) and NHT (%.2f and %.2f) tell them apart. IHT "
              "needs %.0f votes for it; MHT casts %.0f, NHT C %.0f and HT %.0f.",
              DISCRIMINATION(SITUATION_III, RHO_HOUGH_HT), FALSE_PEAKS(SITUATION_III, RHO_HOUGH_HT),
              DISCRIMINATION(SITUATION_III, RHO_HOUGH_MHT),
              FALSE_PEAKS(SITUATION_III, RHO_HOUGH_MHT),
              DISCRIMINATION(SITUATION_III, RHO_HOUGH_IHT),
              DISCRIMINATION(SITUATION_III, RHO_HOUGH_NHT_A),
              DISCRIMINATION(SITUATION_III, RHO_HOUGH_NHT_C), VOTES(SITUATION_III, RHO_HOUGH_IHT),
              VOTES(SITUATION_III, RHO_HOUGH_MHT), VOTES(SITUATION_III, RHO_HOUGH_NHT_C),
              VOTES(SITUATION_III, RHO_HOUGH_HT));
    page_text(
        page,
        "Situation IV, Fig. 10: only NHT still tells targets from clutter. This does not "
        "hold: no method does (discrimination HT %.2f, MHT %.2f, IHT %.2f, NHT %.2f and "
        "%.2f). HT's %.2f detected are chance: its %.0f false peaks cover the plane. NHT has "
        "the fewest false peaks (%.0f and %.0f), and detects %.2f and %.2f.",
        DISCRIMINATION(SITUATION_IV, RHO_HOUGH_HT), DISCRIMINATION(SITUATION_IV, RHO_HOUGH_MHT),
        DISCRIMINATION(SITUATION_IV, RHO_HOUGH_IHT), DISCRIMINATION(SITUATION_IV, RHO_HOUGH_NHT_A),
        DISCRIMINATION(SITUATION_IV, RHO_HOUGH_NHT_C), DETECTED(SITUATION_IV, RHO_HOUGH_HT),
        FALSE_PEAKS(SITUATION_IV, RHO_HOUGH_HT), FALSE_PEAKS(SITUATION_IV, RHO_HOUGH_NHT_A),
        FALSE_PEAKS(SITUATION_IV, RHO_HOUGH_NHT_C), DETECTED(SITUATION_IV, RHO_HOUGH_NHT_A),
        DETECTED(SITUATION_IV, RHO_HOUGH_NHT_C));
}

static void put_run_times(const struct classic_report *report, struct page *page)
{
    const struct classic_time *time = &report->times[3];
    const struct classic_time *last = &report->times[report->num_times - 1];
    page_text(page,
              "Run time, Fig. 11: HT takes most, then NHT, MHT, IHT. At %g clutter plots a square "
              "kilometre: HT on a whole plane %.1f ms, streamed %.1f ms, MHT %.1f ms, NHT C %.1f "
              "ms, NHT A %.1f ms, IHT %.1f ms. That a whole plane takes most holds there, and that "
              "IHT is quicker than MHT. That NHT takes more than MHT does not: MHT lets every pair "
              "vote, NHT asks for a target's speed first. It changes with the clutter: HT's work "
              "grows like the number of plots, MHT's and IHT's like its square, NHT's faster, as "
              "each pair meets those before. At %g a square kilometre NHT C takes %.2f times as "
              "long as HT on a whole plane.",
              time->per_km2, time->time_us[CLASSIC_DENSE] / 1e3, time->time_us[RHO_HOUGH_HT] / 1e3,
              time->time_us[RHO_HOUGH_MHT] / 1e3, time->time_us[RHO_HOUGH_NHT_C] / 1e3,
              time->time_us[RHO_HOUGH_NHT_A] / 1e3, time->time_us[RHO_HOUGH_IHT] / 1e3,
              last->per_km2, last->time_us[RHO_HOUGH_NHT_C] / last->time_us[CLASSIC_DENSE]);
}

static void put_real_data(const struct classic_report *report, struct page *page)
{
    page_text(page,
              "Real data, Fig. 15: only NHT identifies the three targets. This does not hold. Of "
              "Table 3's plots alone, without clutter or misses, %.0f pair votes in reading A: the "
              "aircraft turn slightly, and at 25 km from the origin that moves the lines of two "
              "plots by up to 850 m and 40 mrad. With 10 clutter plots a scan NHT detects %.3f and "
              "%.3f; HT detects %.2f among %.0f false peaks. The paper's density of 10 a square "
              "kilometre would be 3840 plots a scan; its run times (HT 63 times MHT) fit 58.",
              report->table3_votes, DETECTED(SITUATION_REAL, RHO_HOUGH_NHT_A),
              DETECTED(SITUATION_REAL, RHO_HOUGH_NHT_C), DETECTED(SITUATION_REAL, RHO_HOUGH_HT),
              FALSE_PEAKS(SITUATION_REAL, RHO_HOUGH_HT));
}

static void put_default(const struct classic_report *report, struct page *page)
{
    const struct classic_summary *iv = &report->summaries[SITUATION_IV][CLASSIC_KERNEL];
    const struct classic_summary *real = &report->summaries[SITUATION_REAL_DENSE][CLASSIC_KERNEL];
    page_text(page,
              "The default is told 10 m (real data: 60 m) throughout, and takes five plots of "
              "seven. In Situation IV it meets %.3f of the targets with %.3f false peaks a run, "
              "on the real data with 100 clutter plots a scan %.3f with %.3f. Its share detected "
              "(%.2f in Situation IV) is what the window allows: the angle of the best line "
              "through seven plots scatters by 3.3 to 4.7 mrad, and the window ends at 8 mrad.",
              iv->mean[CLASSIC_MET], iv->mean[CLASSIC_FALSE], real->mean[CLASSIC_MET],
              real->mean[CLASSIC_FALSE], iv->mean[CLASSIC_DETECTED]);
}

static void put_findings(const struct classic_report *report, struct page *page)
{
    page_heading(page, "What the paper claims, and what was found");
    put_first_situations(report, page);
    put_last_situations(report, page);

    put_run_times(report, page);
    put_real_data(report, page);
    put_default(report, page);
}

/* ---- the page -------------------------------------------------------------------------------- */

static void put_head(const struct classic_report *report, struct page *page)
{
    page_text(page,
              "The experiments of Fan et al., \"Neutrosophic Hough Transform-Based Track "
              "Initiation Method for Multiple Target Tracking\", section V, runs a case %zu, seed "
              "%llu: Table 1's three targets, and Table 3's real plots, 7 scans, P_D 0.99; cells "
              "of 5 m and 1 mrad, eps 20 m and 4 mrad, 100 to 400 m/s, P_F 0.01, tau 0.5 (the "
              "paper gives none), rho signed. Where NHT's votes go, the paper leaves open: reading "
              "A, to the pair's own cell; reading C, to all cells within 2 eps.",
              report->num_runs, (unsigned long long)report->seed);
    page_text(page,
              "Detected: a peak is within 40 m and 8 mrad of the line through the target's true "
              "positions. Met: a peak's line is within 30 m (real data: 100 m) of them in the "
              "mean. Other peaks are false; at most 4096 peaks are counted. Discrimination: the "
              "highest cell near a target's line over the highest false peak, or over tau of the "
              "highest cell, below which nothing is listed. Top 3: share of the targets that one "
              "of the three highest peaks detects. rho, theta: mean absolute errors of peaks that "
              "detect.");
}

static void put_tables(const struct classic_report *report, struct page *page)
{
    struct grid situations = classic_situations_grid(report), words = classic_words_grid(report);
    page_heading(page, "All Situations");
    page_text(page,
              "Measured/reference. The reference is an independent implementation in double "
              "precision on a plane that is wholly there, 200 runs. Each figure must agree with it "
              "within four standard errors of the difference and the rounding of what is printed. "
              "Times are medians while all processors were at work.");
    page_table(page, &situations);
    page_heading(page, "Table 2 as numbers");
    page_text(page,
              "The paper's words beside what was measured. Discrimination counts as high above 1: "
              "targets above every false peak, in the mean. Divergence: errors of peaks that "
              "detect. Decline: what the targets' cells lack of their height without noise, "
              "clutter and misses; negative where clutter adds to it. The heights are %.1f (HT), "
              "%.1f (MHT), %.1f (IHT), %.1f (NHT A) and %.1f (NHT C) votes.",
              report->ideal_votes[RHO_HOUGH_HT], report->ideal_votes[RHO_HOUGH_MHT],
              report->ideal_votes[RHO_HOUGH_IHT], report->ideal_votes[RHO_HOUGH_NHT_A],
              report->ideal_votes[RHO_HOUGH_NHT_C]);
    page_table(page, &words);
    grid_free(&situations);
    grid_free(&words);
}

static void put_planes(const struct classic_report *report, struct page *page, const char *folder)
{
    classic_draw_planes(report, folder);
    page_heading(page, "Parameter space, Figs. 7 to 10 and 15");
    for (size_t i = 0; i < SITUATIONS; i++) {
        char name[32], caption[160];
        if (classic_situations[i].figure != NULL) {
            classic_plane_name(name, i);
            snprintf(caption, sizeof caption, "As %s. %s. One run.", classic_situations[i].figure,
                     classic_situations[i].text);
            page_figure(page, name, caption);
        }
    }
}

static void put_sweep_part(const struct classic_report *report, struct page *page,
                           const char *folder)
{
    char *path = path_join(folder, "noise.svg");
    struct grid sweep = classic_sweep_grid(report);
    draw_sweep(report, path);
    page_heading(page, "At which noise Table 2 holds");
    page_text(
        page,
        "Situation IV with other noises, runs a noise %zu. Up to about 0.6 m the paper's order "
        "holds: NHT C detects most, with far fewer false peaks than IHT (without noise IHT "
        "does as well). Beyond, two plots 400 to 570 m apart no longer give an angle to 8 "
        "mrad: 2 eps are three standard deviations at 0.43 to 0.62 m, and the paper's own "
        "noise is 16 to 23 times as much.",
        report->num_sweep_runs);
    page_figure(page, "noise.svg", "Targets detected, and false peaks, against the noise.");
    page_table(page, &sweep);
    grid_free(&sweep);
    free(path);
}

static void put_times_part(const struct classic_report *report, struct page *page,
                           const char *folder)
{
    char *path = path_join(folder, "times.svg");
    struct grid times = classic_times_grid(report);
    draw_times(report, path);
    page_heading(page, "Run times, Fig. 11");
    page_text(page, "Situation IV, one search at a time, medians. The dense HT clears, fills and "
                    "searches a plane of 16-bit counts.");
    page_figure(page, "times.svg", "Votes, and time of a search, against the clutter.");
    page_table(page, &times);
    grid_free(&times);
    free(path);
}

void classic_page_verdicts(const struct classic_report *report, struct page *page)
{
    struct grid verdicts = classic_verdicts_grid(report, false);
    page_heading(page, "What must hold of the paper's experiments");
    page_text(page, "%d held, %d missed.", report->held, report->missed);
    page_table(page, &verdicts);
    grid_free(&verdicts);
}

void classic_page(const struct classic_report *report, struct page *page, const char *folder)
{
    put_head(report, page);
    if (report->methods == (1u << CLASSIC_METHODS) - 1u) {
        put_findings(report, page);
    }
    put_tables(report, page);
    put_planes(report, page, folder);
    if (has_sweep(report)) {
        put_sweep_part(report, page, folder);
    }
    put_times_part(report, page, folder);
}
