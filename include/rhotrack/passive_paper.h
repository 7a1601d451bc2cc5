/* SPDX-License-Identifier: MIT */
/*
 * passive_paper: straight lines from the bearings of two to RHO_MAX_PASSIVE_SENSORS sensors, by the
 * passive Hough transform exactly as the paper has it. For comparison: passive.h finds tracks.
 *
 *   1 cross     each pair of sensors K, L, scan by scan; ghosts are pruned (ghost)
 *   2 vote      each crossing that was not pruned votes in the accumulator of its pair of sensors,
 *               in one cell of each row of theta, at
 *
 *                   rho = rho^K + rho_cor^K                                            eq. (3)
 *                       = D_ij^K cos(z_i^K - theta) + D_K cos(alpha_K - theta)
 *
 *               D_ij^K, z_i^K: range and bearing of the crossing from sensor K, which is at the
 *               polar coordinates D_K, alpha_K
 *   3 accept    cells with T votes or more, of distinct scans or crossings; with three sensors or
 *               more, all pairs of sensors must confirm a cell by T votes in the cell itself or a
 *               neighbour, which ghosts rarely pass: those of different pairs are in other places
 *   4 choose    the cell with the most votes of all pairs together, the middle one of equal
 *               neighbours; then the next one that is not on a chosen cell's ridge: within 4 cells
 *               of its theta, within 3 of rho of the line through its voters' mean place
 *
 * A line has no time. Its position and velocity are a least-squares fit through the crossings that
 * voted for it, ghosts among them.
 *
 * Source: passive Hough transform paper (see bearing_crossing.h), sections 3 and 4; src/DESIGN.md
 * says how it is read.
 *
 * Stack: 32 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_PASSIVE_PAPER_H
#define RHOTRACK_PASSIVE_PAPER_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/detail/accumulator.h"
#include "rhotrack/detail/ghost_matrix.h"
#include "rhotrack/detail/recent_bearing_frames.h"
#include "rhotrack/detail/votes_picture.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

struct rho_passive_paper_config {
    uint16_t scans; /* number of scans in the batch, N: 3 .. RHO_MAX_PASSIVE_SCANS */
    /* votes that a cell needs, T: 1 .. 255; 0: four fifths of the scans in the batch, rounded up */
    uint16_t votes_min;
    float range_max_m; /* range limit of all sensors: 1000 .. 500000 */
    /*
     * size of the cells of rho; 2 range_max_m / rho_cell_m: at most RHO_PAPER_RHO_CELLS; cells that
     * are left hold half the sensors' distance to either side
     */
    float rho_cell_m;
    /* size of the cells of theta: at most 0.5; pi over it at most RHO_PAPER_THETA_CELLS */
    float theta_cell_rad;
    /* votes of a cell: distinct scans, or crossings, whose count stops at 255 */
    enum rho_accumulator_votes votes;
    enum rho_ghost_rule rule; /* rule by which ghosts are pruned in step 1 */
};

/* A line found by a search, through the centre of its cell. */
struct rho_passive_paper_line {
    float rho_m, theta_rad; /* the line x cos(theta) + y sin(theta) = rho; 0 <= theta < pi */
    /* votes of the pair of sensors that gave the line least, in the cell that confirms it */
    uint16_t votes;
    /* sum of all pairs' votes in the line's own cell, by which lines are ordered; stops at 254 */
    uint16_t votes_sum;
    uint16_t scans; /* scans whose crossings voted for the line: bit k for scan k, 0 the oldest */
    uint16_t crossings; /* number of crossings of all pairs that voted for the line */
    /* 1: the crossings are of two scans or more, and gave position and velocity */
    uint16_t has_state;
    uint16_t reserved; /* always 0 */
    /* position and velocity at the newest scan; 0 without has_state */
    float x_m, y_m, vx_mps, vy_mps;
    /*
     * covariance of x and vx, the same for y and vy: scatter of the crossings about the fit, at
     * least that of a position within the cell; m^2, m^2/s, (m/s)^2
     */
    float place_m2, place_velocity_m2ps, velocity_m2ps2;
    /* id of the track that rho_passive_paper_step started from the line; 0: no track */
    uint32_t track_id;
};

/* Counters of a search, and of items left out for lack of room. All saturate. */
struct rho_passive_paper_work {
    /* crossings of all pairs of bearings, and those removed as ghosts */
    uint32_t crossings, ghosts;
    /* crossings of a pair of sensors beyond RHO_MAX_PAPER_CROSSINGS, of the newest scans */
    uint32_t points_dropped;
    uint32_t votes;         /* votes cast: crossings that were not removed, times rows */
    uint32_t cells;         /* cells that every pair of sensors confirms */
    uint32_t lines_dropped; /* lines beyond RHO_MAX_PASSIVE_LINES, with the lowest votes_sum */
};

/* A crossing of two bearings that was not pruned, relative to the sensors' centroid. */
struct rho_passive_paper_point {
    float x_m, y_m;
};

/* Sums of a least-squares fit through a line's crossings, relative to the first one. */
struct rho_passive_paper_fit {
    int16_t row, column; /* cell of the line */
    uint32_t count;
    float first_x_m, first_y_m;
    /* sums of u, u^2, x, y, u x, u y; u is the time of the scan, -1 .. 1 over the batch */
    float u, uu, x_m, y_m, ux_m, uy_m;
    float rr_m2; /* sum of x^2 + y^2 */
};

struct rho_passive_paper {
    uint32_t magic;
    struct rho_passive_paper_config config;
    uint16_t votes_min; /* T, the votes that a cell needed in the last search */
    /* number of lines found by the last search; they are sorted by votes_sum, highest first */
    uint16_t num_lines;
    struct rho_passive_paper_line lines[RHO_MAX_PASSIVE_LINES];
    struct rho_passive_paper_work work;
    struct rho_batch batch;
    /*
     * scratch of a search: of all pairs of sensors 1 and the votes, or 0 where they do not confirm;
     * of one pair three rows, and its crossings, of scan k from scan_end[k - 1] to scan_end[k] - 1
     */
    struct rho_passive_paper_fit fits[RHO_MAX_PASSIVE_LINES];
    uint8_t cells[RHO_PAPER_THETA_CELLS][RHO_PAPER_RHO_CELLS];
    uint8_t rows[3][RHO_PAPER_RHO_CELLS];
    uint16_t scan_end[RHO_MAX_PASSIVE_SCANS];
    struct rho_passive_paper_point points[RHO_MAX_PAPER_CROSSINGS];
};

/*
 * Defaults: scans 8, votes_min 0, range 100 km, cells of 1 km and 2 degrees, votes of scans, the
 * literal rule. Constant cost.
 */
void rho_passive_paper_config_default(struct rho_passive_paper_config *config);

/*
 * Initialises the search with an empty batch; the config is copied.
 *   object_size   sizeof(struct rho_passive_paper) of the caller
 * Errors: NULL, SIZE, CONFIG (any field outside its range); *paper is unchanged. Cost:
 * sizeof(paper) bytes cleared. Stack: 160 bytes.
 */
RHO_MUST_CHECK enum rho_status
rho_passive_paper_init(struct rho_passive_paper *paper, size_t object_size,
                       const struct rho_passive_paper_config *config);

/*
 * Adds a frame of bearings to the batch by rho_batch_push, and discards the lines of the last
 * search.
 *   fates  in and out, one for each bearing: set those that may vote to RHO_FATE_HELD
 * Errors: those of rho_batch_push; VALUE also for fates that were not set: a value that is no fate,
 * or bearings of which none is HELD. A frame of which tracks claim all is pushed without bearings.
 * Stack: 250 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_push(struct rho_passive_paper *paper,
                                                      const struct rho_frame *frame,
                                                      uint8_t *fates);

/*
 * Searches the batch for lines. Results: paper->lines[0 .. num_lines - 1]. Sensors without a scan
 * in the batch are left out.
 * Errors: NULL, STATE (not initialised). Fewer than 3 frames, or one sensor: RHO_OK and no line.
 * Cost: for each pair of sensors its crossings times the rows of theta, and times the lines; cells
 * times lines, with those dropped. Stack: 1.5 KB with 8 bearings a scan, 4 KB with 16.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_search(struct rho_passive_paper *paper);

/* Two sensors that have scans in the batch, as indices in batch.sensors. */
struct rho_passive_paper_pair {
    uint8_t a, b;
};

/*
 * Gets the pair of sensors with this number, from 0, in the order of a search. Returns 0 beyond the
 * last pair, and *pair is unchanged. Cost: scans times sensors. Stack: 180 bytes.
 */
int rho_passive_paper_pair(const struct rho_passive_paper *paper, unsigned number,
                           struct rho_passive_paper_pair *pair);

/* Extent of the cells of a search; rho is measured from the origin. */
struct rho_passive_paper_space {
    /* the origin is the sensors' centroid; cells of rho reach from -rho_max_m to rho_max_m */
    float origin_x_m, origin_y_m, rho_max_m;
    uint16_t theta_cells, rho_cells;
};

/*
 * Extent of the cells of the last search. Errors: NULL, STATE (not initialised, or no sensor in the
 * batch). Cost: scans times sensors. Stack: 200 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_space(const struct rho_passive_paper *paper,
                                                       struct rho_passive_paper_space *space);

/*
 * Step 1 for one scan and one pair of sensors: the ghost matrix, pruned by the config's rule. It is
 * the matrix of the last search until the next frame is pushed.
 *   scan  index of the scan in the batch, 0 the oldest
 * Errors: NULL, STATE (not initialised), VALUE (no such scan or pair). Cost: rho_ghost_fill and
 * rho_ghost_prune. Stack: 1 KB with 8 bearings a scan, 3 KB with 16.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_ghosts(const struct rho_passive_paper *paper,
                                                        const struct rho_passive_paper_pair *pair,
                                                        unsigned scan,
                                                        struct rho_ghost_matrix *matrix);

/*
 * Step 2: a picture of the votes in the accumulator of a pair of sensors. With pair NULL: the sums
 * of the votes of all pairs, in the cells that every pair confirms, and 0 in the others. The votes
 * are those of the last search until the next frame is pushed; the lines stay as they are.
 * Errors: NULL (paper), STATE (not initialised, or too little in the batch to search), VALUE (no
 * such pair), and those of rho_votes_picture_init. Cost: the voting of rho_passive_paper_search.
 * Stack: 1.6 KB with 8 bearings a scan, 4 KB with 16.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_plane(struct rho_passive_paper *paper,
                                                       const struct rho_passive_paper_pair *pair,
                                                       struct rho_votes_picture *plane);

/*
 * Step 3 for one pair of sensors: the cells with T votes or more in its accumulator, best first,
 * without cells on the ridge of a better one (step 4). Lifetime and errors as
 * rho_passive_paper_plane; NULL also for peaks and num_peaks.
 *   peaks  room for max_peaks cells; masks of scans are filled
 * Cost: the voting of a pair, and for each cell found all cells and the crossings.
 * Stack: 1.6 KB with 8 bearings a scan, 4 KB with 16.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_cells(struct rho_passive_paper *paper,
                                                       const struct rho_passive_paper_pair *pair,
                                                       struct rho_accumulator_peak *peaks,
                                                       uint32_t max_peaks, uint32_t *num_peaks);

/*
 * Eq. (3): rho of the line with the normal theta through the place that a sensor at (x_m, y_m)
 * measures at this range and bearing. It is the same from any sensor. All arguments finite, angles
 * within 16 turns. Constant cost, stack 64 bytes.
 */
float rho_passive_paper_rho_m(float range_m, float bearing_rad, float x_m, float y_m,
                              float theta_rad);

RHO_END_C

#endif
