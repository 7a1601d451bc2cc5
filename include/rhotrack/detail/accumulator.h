/* SPDX-License-Identifier: MIT */
/*
 * accumulator: Hough voting for points on straight lines, exact at any cell size, in a few
 * kilobytes.
 *
 * A line is rho = x cos(theta) + y sin(theta). Every point votes, for each cell of theta, in the
 * cell of rho where a line through it lies. The plane of all cells would take a hundred megabytes
 * at 5 m and 1 mrad; it is never stored. One row of theta at a time gets its votes, and only three
 * rows are kept: a cell is a peak if none of its neighbours has more.
 *
 *     theta i - 1   . . . n n n . .
 *     theta i       . . . n P n . .
 *     theta i + 1   . . . n n n . .  <- gets its votes, then row i is searched for peaks
 *
 * (rho, theta) and (-rho, theta +- pi) are one line: before the first row comes the last one with
 * rho reversed, and after the last row the first one with rho reversed.
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
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Largest number of scans. */
#define RHO_ACCUMULATOR_SCANS_MAX 16u

enum rho_accumulator_votes {
    RHO_VOTES_SCANS, /* distinct scans */
    RHO_VOTES_POINTS /* points; the count stops at 65535 */
};

struct rho_accumulator_config {
    float rho_max_m;  /* cells of rho from -rho_max_m to rho_max_m; points outside do not vote */
    float rho_cell_m; /* 2 rho_max_m / rho_cell_m, rounded, is 1 .. RHO_MAX_RHO_CELLS */
    /*
     * 1e-4 .. pi, below pi with neighbours; cell i is at (i + 1/2) theta_cell_rad; the last one may
     * reach beyond pi
     */
    float theta_cell_rad;
    enum rho_accumulator_votes votes;
    uint16_t min_votes; /* of a peak; at least 1 */
    /* 0 .. 1: smallest share of the most votes that a peak has */
    float min_share;
    /* neighbours that a peak is compared with: 0 (every cell with min_votes is a peak), 4 or 8 */
    uint8_t neighbours;
    /* 0 or 1; 1: every point votes in every row: the same result, but slower */
    uint8_t no_pruning;
};

/* Points in the order of their scans. The arrays stay the caller's. */
struct rho_accumulator_points {
    const float *x_m, *y_m;
    unsigned num_scans; /* 0 .. RHO_ACCUMULATOR_SCANS_MAX */
    /* points of scan m: scan_end[m - 1] .. scan_end[m] - 1, scan 0 from 0; must not fall */
    const uint32_t *scan_end;
};

struct rho_accumulator_peak {
    uint32_t votes;
    uint16_t theta_cell, rho_cell;
    uint32_t mask; /* bit m: scan m voted; 0 with RHO_VOTES_POINTS */
};

struct rho_accumulator_result {
    uint32_t num_peaks;
    /* lowest peaks beyond the caller's capacity; with min_share an upper bound; saturates */
    uint32_t peaks_dropped;
    uint32_t votes;     /* points times rows of theta, without those beyond rho_max_m; saturates */
    uint32_t votes_max; /* of the cells with at least min_votes; 0: there is none */
};

/*
 * The best peaks of a search, in an array of the caller. They are added in any order; a heap keeps
 * the best by votes, then lower theta_cell, then lower rho_cell. Set the first four fields, and the
 * others to 0.
 */
struct rho_peak_list {
    struct rho_accumulator_peak *peaks;
    uint32_t max_peaks; /* room */
    uint32_t min_votes; /* of a peak; rises with votes_max */
    float min_share;    /* of votes_max */
    uint32_t num_peaks;
    uint32_t peaks_dropped; /* as above */
    uint32_t votes_max;
};

/* The plane, and the largest distance of peaks that suppress each other. */
struct rho_peak_distance {
    uint16_t theta_cells, rho_cells; /* of the plane */
    uint16_t theta, rho;             /* within both distances only the better peak stays */
};

struct rho_accumulator {
    uint32_t magic;
    uint16_t theta_cells, rho_cells;
    struct rho_accumulator_config config;
    /* cell of rho: first_cell + rho cells_per_m, after a guard cell */
    float cells_per_m, first_cell;
    /*
     * Three rows of bytes, or of 16 bits for more than 8 scans or 255 points, a guard cell at each
     * end.
     */
    uint16_t rows[3][RHO_MAX_RHO_CELLS + RHO_ACCUMULATOR_PADDING];
    /* sparse rows: the cells that were touched, and those that reached min_votes */
    int32_t touched[3][RHO_ACCUMULATOR_SPARSE_MAX];
    uint16_t reached[3][RHO_ACCUMULATOR_SPARSE_MAX + 1];
    uint16_t num_touched[3], num_reached[3];
    /* dense rows need `scan`, sparse ones `few` */
    union {
        uint16_t scan[RHO_MAX_RHO_CELLS + RHO_ACCUMULATOR_PADDING]; /* votes of one scan */
        struct {
            float x_m[RHO_ACCUMULATOR_SPARSE_MAX], y_m[RHO_ACCUMULATOR_SPARSE_MAX];
            int32_t bins[RHO_ACCUMULATOR_SPARSE_MAX];
            uint16_t bits[RHO_ACCUMULATOR_SPARSE_MAX]; /* of their scans */
            uint16_t votes[RHO_ACCUMULATOR_BINS + 2], are_enough[RHO_ACCUMULATOR_BINS + 2];
        } few;
    } room;
};

/* Rows of theta and cells of rho of a config's plane. Errors: CONFIG. Constant cost. */
RHO_MUST_CHECK enum rho_status rho_accumulator_plane(const struct rho_accumulator_config *config,
                                                     uint16_t *theta_cells, uint16_t *rho_cells);

/* Whether rho_accumulator_find takes these points: its errors NULL and VALUE. Cost: the points. */
RHO_MUST_CHECK enum rho_status rho_accumulator_check(const struct rho_accumulator_points *points);

/*
 * Prepares an accumulator; the config is copied.
 *   size   sizeof(struct rho_accumulator) of the caller
 * Errors: NULL, SIZE, CONFIG (any field outside its range). Cost: constant.
 */
RHO_MUST_CHECK enum rho_status rho_accumulator_init(struct rho_accumulator *accumulator,
                                                    size_t size,
                                                    const struct rho_accumulator_config *config);

/*
 * Votes, and finds the peaks.
 *   peaks   room for max_peaks; the best by votes, then lower theta_cell, then lower rho_cell, in
 *           that order
 *   result  filled whole
 * A cell is a peak if it has at least min_votes, no neighbour has more votes, and no neighbour
 * before it (by theta_cell, then rho_cell) has as many.
 * Errors: NULL, STATE (not initialised), VALUE (num_scans, scan_end, a point not finite or beyond
 * RHO_LIMIT_POSITION_M); nothing but *accumulator's scratch is changed. Cost: theta cells times
 * (points, and the rho cells where there are more than RHO_ACCUMULATOR_SPARSE_MAX points), and
 * max_peaks' logarithm for each peak. With at most RHO_ACCUMULATOR_SPARSE_MAX points, all
 * within rho_max_m, and min_votes of 3 or more, rows that cannot have a peak are skipped: few
 * points cost down to a thirtieth of that. Stack: 1.4 KB.
 */
RHO_MUST_CHECK enum rho_status rho_accumulator_find(struct rho_accumulator *accumulator,
                                                    const struct rho_accumulator_points *points,
                                                    struct rho_accumulator_peak *peaks,
                                                    uint32_t max_peaks,
                                                    struct rho_accumulator_result *result);

/*
 * Adds a cell, unless it has fewer votes than min_votes. Cost: the logarithm of max_peaks.
 * Stack: 120 bytes.
 */
void rho_peak_list_add(struct rho_peak_list *list, struct rho_accumulator_peak peak);

/*
 * Sorts the list, best first, and drops the peaks below the final min_share. Cost: n log n.
 */
void rho_peak_list_finish(struct rho_peak_list *list);

/*
 * Greedy suppression of peaks in the order best first: each kept peak drops all worse ones near it,
 * also across the ends of theta.
 * Returns how many are kept, at the head of the list.
 *   scratch  num_scratch words, a power of two; NULL and 0: none
 * Cost: a few look-ups a peak while scratch holds half as many words again as peaks are kept; kept
 * peaks beyond are compared one by one. Stack: 180 bytes.
 */
uint32_t rho_peak_list_suppress(struct rho_accumulator_peak *peaks, uint32_t num_peaks,
                                const struct rho_peak_distance *distance, uint32_t *scratch,
                                uint32_t num_scratch);

/* The cell of rho in which a point votes in a row of theta; -1: beyond rho_max_m. */
int rho_accumulator_cell(const struct rho_accumulator *accumulator, unsigned theta_cell, float x_m,
                         float y_m);

/* The line through the centre of a cell. Constant cost. */
float rho_accumulator_theta_rad(const struct rho_accumulator *accumulator, unsigned theta_cell);
float rho_accumulator_rho_m(const struct rho_accumulator *accumulator, unsigned rho_cell);

#ifdef __cplusplus
}
#endif

#endif
