/* SPDX-License-Identifier: MIT */
/*
 * accumulator: Hough voting for points on straight lines, exact at any cell size, in a few
 * kilobytes.
 *
 * A line is rho = x cos(theta) + y sin(theta). Every point votes, for each cell of theta, in the
 * cell of rho where a line through it lies. The plane of all cells would take a hundred megabytes
 * at 5 m and 1 mrad; it is never stored. One row of theta at a time gets its votes and is searched
 * for peaks, the cells with enough votes. rho_peak_list_suppress drops those near a better one.
 *
 * Votes are distinct scans (a bit each: a scan votes once in a cell, for any number of its points)
 * or points. Peaks are the same, cell by cell, as those of an accumulator that holds the whole
 * plane.
 *
 * Source: the Hough transform as in Fan et al., "Neutrosophic Hough Transform-Based Track
 * Initiation Method for Multiple Target Tracking", eq. (6), with rho signed.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_ACCUMULATOR_H
#define RHOTRACK_ACCUMULATOR_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/detail/votes_picture.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

/* Largest number of scans, each of which has a bit in a cell. */
#define RHO_ACCUMULATOR_SCANS_MAX 16u

enum rho_accumulator_votes {
    RHO_VOTES_SCANS, /* votes of a cell are the distinct scans with a point on its line */
    RHO_VOTES_POINTS /* votes of a cell are the points on its line; the count stops at 65535 */
};

struct rho_accumulator_config {
    /* the plane has cells of rho from -rho_max_m to rho_max_m; points outside do not vote */
    float rho_max_m;
    /* size of the cells of rho; 2 rho_max_m / rho_cell_m, rounded, is 1 .. RHO_MAX_RHO_CELLS */
    float rho_cell_m;
    /*
     * size of the cells of theta: 1e-4 .. pi; cell i is at (i + 1/2) theta_cell_rad; the last cell
     * may reach beyond pi
     */
    float theta_cell_rad;
    enum rho_accumulator_votes votes;
    uint16_t min_votes; /* smallest number of votes of a peak; at least 1 */
    /* smallest votes of a peak as a share of the most votes of all cells: 0 .. 1 */
    float min_share;
    /* 1: every point votes in every row: the same, but slower; 0: skips rows without peaks */
    uint8_t no_pruning;
};

/* Points in the order of their scans. The arrays stay the caller's. */
struct rho_accumulator_points {
    const float *x_m, *y_m;
    unsigned num_scans; /* number of scans: 0 .. RHO_ACCUMULATOR_SCANS_MAX */
    /* scan m has points scan_end[m - 1] .. scan_end[m] - 1, scan 0 from 0; must not fall */
    const uint32_t *scan_end;
};

struct rho_accumulator_peak {
    uint32_t votes;
    uint16_t theta_cell, rho_cell;
    uint32_t mask; /* scans that voted: bit m for scan m; 0 with RHO_VOTES_POINTS */
};

struct rho_accumulator_result {
    uint32_t num_peaks;
    /* peaks beyond the caller's capacity, the lowest; with min_share an upper bound; saturates */
    uint32_t peaks_dropped;
    /* votes cast: points times rows of theta, without points beyond rho_max_m; saturates */
    uint32_t votes;
    /* most votes of a cell, among cells with at least min_votes; 0: no such cell */
    uint32_t votes_max;
};

/*
 * The best peaks of a search, in an array of the caller. Peaks are added in any order; a heap keeps
 * the best by votes, then lower theta_cell, then lower rho_cell. The user sets the first four
 * fields, and the others to 0.
 */
struct rho_peak_list {
    struct rho_accumulator_peak *peaks;
    uint32_t max_peaks; /* capacity of peaks[] */
    uint32_t min_votes; /* smallest votes of a peak; rises with votes_max by min_share */
    float min_share;    /* smallest votes of a peak as a share of votes_max */
    uint32_t num_peaks;
    uint32_t peaks_dropped; /* number of peaks that were added beyond max_peaks; saturates */
    uint32_t votes_max;
};

/* Size of the plane, and the largest distance at which a peak suppresses a worse one. */
struct rho_peak_distance {
    uint16_t theta_cells, rho_cells; /* number of cells of the plane */
    /* peaks within both distances of a better peak, in cells, are suppressed */
    uint16_t theta, rho;
};

struct rho_accumulator {
    uint32_t magic;
    uint16_t theta_cells, rho_cells;
    struct rho_accumulator_config config;
    /* the cell of rho_m, after a guard cell, is first_cell + rho_m cells_per_m */
    float cells_per_m, first_cell;
    /* row of 8-bit cells (16-bit: over 8 scans or 255 points), with guard cells at the ends */
    uint16_t row[RHO_MAX_RHO_CELLS + RHO_ACCUMULATOR_PADDING];
    int32_t cells[RHO_ACCUMULATOR_SPARSE_MAX]; /* cells of points in the row */
    /* scratch where there are few points */
    struct {
        float x_m[RHO_ACCUMULATOR_SPARSE_MAX], y_m[RHO_ACCUMULATOR_SPARSE_MAX];
        int32_t bins[RHO_ACCUMULATOR_SPARSE_MAX];
        uint16_t bits[RHO_ACCUMULATOR_SPARSE_MAX];        /* bit of each point's scan in a cell */
        uint16_t reached[RHO_ACCUMULATOR_SPARSE_MAX + 1]; /* cells that reached min_votes */
        uint16_t votes[RHO_ACCUMULATOR_BINS + 2], are_enough[RHO_ACCUMULATOR_BINS + 2];
    } few;
};

/* Rows of theta and cells of rho in the plane of a config. Errors: CONFIG. Constant cost. */
RHO_MUST_CHECK enum rho_status
rho_accumulator_count_cells(const struct rho_accumulator_config *config, uint16_t *theta_cells,
                            uint16_t *rho_cells);

/* Checks points as rho_accumulator_find_peaks does: its errors NULL and VALUE. Cost: the points. */
RHO_MUST_CHECK enum rho_status
rho_accumulator_check_points(const struct rho_accumulator_points *points);

/*
 * Initialises an accumulator; the config is copied.
 *   object_size   sizeof(struct rho_accumulator) of the caller
 * Errors: NULL, SIZE, CONFIG (any field outside its range). Cost: constant.
 */
RHO_MUST_CHECK enum rho_status rho_accumulator_init(struct rho_accumulator *accumulator,
                                                    size_t object_size,
                                                    const struct rho_accumulator_config *config);

/*
 * Lets all points vote, and finds the peaks.
 *   peaks   room for max_peaks; gets the best peaks, best first: by votes, then lower theta_cell,
 *           then lower rho_cell
 *   result  all fields are filled
 * A cell is a peak if it has at least min_votes, and min_share of the most votes.
 * Errors: NULL, STATE (not initialised), VALUE (num_scans, scan_end, a point not finite or beyond
 * RHO_LIMIT_POSITION_M); nothing but *accumulator's scratch is changed. Cost: theta cells times
 * (points, and the rho cells where there are more than RHO_ACCUMULATOR_SPARSE_MAX points), and
 * max_peaks' logarithm for each peak. With at most RHO_ACCUMULATOR_SPARSE_MAX points, all
 * within rho_max_m, and min_votes of 3 or more, rows that cannot have a peak are skipped: with few
 * points this saves up to 29/30 of the cost. Stack: 660 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_accumulator_find_peaks(
    struct rho_accumulator *accumulator, const struct rho_accumulator_points *points,
    struct rho_accumulator_peak *peaks, uint32_t max_peaks, struct rho_accumulator_result *result);

/*
 * Notes the votes of all points in a picture of the plane. Errors: as rho_accumulator_find_peaks,
 * and those of rho_votes_picture_init. Cost: as there. Stack: 660 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_accumulator_plane(struct rho_accumulator *accumulator,
                                                     const struct rho_accumulator_points *points,
                                                     struct rho_votes_picture *plane);

/*
 * Adds a peak to the list, unless it has fewer votes than min_votes; a full list drops its worst
 * peak. Cost: the logarithm of max_peaks. Stack: 120 bytes.
 */
void rho_peak_list_offer(struct rho_peak_list *list, struct rho_accumulator_peak peak);

/* Sorts the peaks, best first, and drops those below min_share of votes_max. Cost: n log n. */
void rho_peak_list_sort(struct rho_peak_list *list);

/*
 * Suppresses peaks near a better one. The list is sorted, best first: each peak that is kept drops
 * all worse peaks near it, also across the ends of theta. Returns the number of peaks kept, which
 * are moved to the front. Cost: the peaks times those kept. Stack: 60 bytes.
 */
uint32_t rho_peak_list_suppress(struct rho_accumulator_peak *peaks, uint32_t num_peaks,
                                const struct rho_peak_distance *distance);

/* Cell of rho in which a point votes in a row of theta; -1: the point is beyond rho_max_m there. */
int rho_accumulator_cell_of_point(const struct rho_accumulator *accumulator, unsigned theta_cell,
                                  float x_m, float y_m);

/* theta of the lines through the centres of a row of cells. Constant cost. */
float rho_accumulator_theta_rad(const struct rho_accumulator *accumulator, unsigned theta_cell);

RHO_END_C

#endif
