/* SPDX-License-Identifier: MIT */
/*
 * hough: one search of the Hough accumulator (`hough POINTS plain|pruned`);
 * tools/gates/instructions.sh counts its instructions. As in `rhotrack bench hough`, the area is
 * 30 x 30 km, with 7 scans, 5 votes and cells of 5 m x 1 mrad. Prints the number of votes, which is
 * the number of points times the rows of theta.
 */
#include <stdlib.h>
#include <string.h>

#include "count.h"
#include "random_draws.h"
#include "rhotrack/detail/accumulator.h"

#define SCANS 7
#define POINTS_MAX 3000
#define PEAKS_MAX 1024

static struct rho_accumulator accumulator;
static struct rho_accumulator_peak peaks[PEAKS_MAX];
static struct rho_accumulator_result result;
static float x_m[POINTS_MAX], y_m[POINTS_MAX];
static uint32_t scan_end[SCANS];
static const struct rho_accumulator_points points = {x_m, y_m, SCANS, scan_end};

static void scatter_points(unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        x_m[i] = draw_uniform(-15000.0f, 15000.0f);
        y_m[i] = draw_uniform(-15000.0f, 15000.0f);
    }
    for (unsigned scan = 0; scan < SCANS; scan++) {
        scan_end[scan] = count * (scan + 1) / SCANS;
    }
}

int main(int argc, char **argv)
{
    struct rho_accumulator_config config = {
        .rho_max_m = 21220.0f, .rho_cell_m = 5.0f, .theta_cell_rad = 0.001f, .min_votes = 5};
    int count = argc == 3 ? atoi(argv[1]) : 0;
    if (count < 1 || count > POINTS_MAX) {
        fprintf(stderr, "hough: give 1 .. %d points, and plain or pruned\n", POINTS_MAX);
        return 2;
    }
    config.no_pruning = strcmp(argv[2], "plain") == 0;
    scatter_points((unsigned)count);
    enum rho_status status = rho_accumulator_init(&accumulator, sizeof accumulator, &config);
    count_begin();
    status = status == RHO_OK
                 ? rho_accumulator_find_peaks(&accumulator, &points, peaks, PEAKS_MAX, &result)
                 : status;
    count_end();
    if (status != RHO_OK) {
        fprintf(stderr, "hough: %s\n", rho_status_name(status));
        return 1;
    }
    printf("%u votes\n", (unsigned)result.votes);
    count_print_totals();
    return 0;
}
