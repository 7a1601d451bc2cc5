/* SPDX-License-Identifier: MIT */
/*
 * passive_paper: straight lines from the bearings of two to RHO_MAX_PASSIVE_SENSORS sensors, by the
 * paper's method to the letter. For comparison; passive is what finds tracks.
 *
 *   1 cross     each pair of sensors K, L, scan by scan; ghosts are pruned (ghost)
 *   2 vote      a crossing that is left votes in its pair's accumulator, in one cell of each row
 *               of theta, at
 *
 *                   rho = rho^K + rho_cor^K                                            eq. (3)
 *                       = D_ij^K cos(z_i^K - theta) + D_K cos(alpha_K - theta)
 *
 *               D_ij^K, z_i^K: range and bearing of the crossing from sensor K, which is at the
 *               polar coordinates D_K, alpha_K
 *   3 accept    cells with T votes or more, of distinct scans or crossings; with three sensors or
 *               more, a cell must be accepted in the accumulators of all pairs, there or in a
 *               neighbour: the ghosts of different pairs lie elsewhere
 *   4 choose    the cell with the most votes of all pairs together, the middle one of equal
 *               neighbours; then the next one that is not within 4 cells of theta and 3 of rho
 *
 * A line has no time. Its position and velocity are a least-squares fit through the crossings that
 * voted for it, ghosts among them.
 *
 * Source: passive Hough transform paper (see crossing.h), sections 3 and 4; src/DESIGN.md says how
 * it is read.
 *
 * Stack: 32 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_PASSIVE_PAPER_H
#define RHOTRACK_PASSIVE_PAPER_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/detail/accumulator.h"
#include "rhotrack/detail/batch.h"
#include "rhotrack/detail/ghost.h"
#include "rhotrack/detail/plane.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rho_passive_paper_config {
    uint16_t scans;     /* N, the batch: 4 .. RHO_MAX_PASSIVE_SCANS */
    uint16_t votes_min; /* T: 1 .. 255; 0: four fifths of the scans that are held, rounded up */
    float range_max_m;  /* range limit of all sensors: 1000 .. 500000 */
    /*
     * 2 range_max_m over it: at most RHO_PAPER_RHO_CELLS; what is left holds half the sensors'
     * distance to either side
     */
    float rho_cell_m;
    float theta_cell_rad;             /* pi over it: at most RHO_PAPER_THETA_CELLS; at most 0.5 */
    enum rho_accumulator_votes votes; /* distinct scans, or crossings: their count stops at 255 */
    enum rho_ghost_rule rule;         /* of step 1 */
};

/* A line, through the centre of its cell. */
struct rho_passive_paper_line {
    float rho_m, theta_rad; /* x cos(theta) + y sin(theta) = rho; 0 <= theta < pi */
    uint16_t votes;         /* the least of any pair of sensors, each where it confirms the line */
    uint16_t votes_sum;     /* of all pairs in the line's own cell; the most first; stops at 254 */
    uint16_t scans;         /* bit k: a crossing of scan k voted for it, 0 the oldest */
    uint16_t crossings;     /* that did, of all pairs */
    uint16_t has_state;     /* 1: they are of two scans or more, and gave the state */
    uint16_t reserved;      /* 0 */
    float x_m, y_m, vx_mps, vy_mps; /* at the newest scan; 0 without has_state */
    /*
     * covariance of x and vx, and of y and vy alike, by the scatter of the crossings about the fit,
     * no less than that of a place within the cell; m^2, m^2/s, (m/s)^2
     */
    float place_m2, place_velocity_m2ps, velocity_m2ps2;
    uint32_t track_id; /* of the track that rho_passive_paper_step started by it; 0: none */
};

/* Counters of a search, and of what exceeded a capacity. All saturate. */
struct rho_passive_paper_work {
    uint32_t crossings, ghosts; /* all pairs of bearings; removed before voting */
    /*
     * of one pair of sensors beyond RHO_MAX_PAPER_CROSSINGS: the newest scans'; none in the default
     * profiles
     */
    uint32_t points_dropped;
    uint32_t votes;         /* crossings that are left times rows */
    uint32_t cells;         /* accepted, and confirmed by every pair */
    uint32_t lines_dropped; /* beyond RHO_MAX_PASSIVE_LINES: those of the lowest votes_sum */
};

/* A crossing that was not pruned; the origin is the sensors' centroid. */
struct rho_passive_paper_point {
    float x_m, y_m;
};

/* Sums of the crossings that voted for a line: n, and of u, x, y from the first one. */
struct rho_passive_paper_fit {
    int16_t row, column; /* the line's cell */
    uint32_t count;
    float first_x_m, first_y_m;
    float u, uu, x_m, y_m, ux_m, uy_m; /* u: the scan's time, -1 .. 1 over the batch */
    float rr_m2;                       /* of x^2 + y^2 */
};

struct rho_passive_paper {
    uint32_t magic;
    struct rho_passive_paper_config config;
    uint16_t votes_min; /* T of the last search */
    uint16_t num_lines; /* found by the last search, the highest votes_sum first */
    struct rho_passive_paper_line lines[RHO_MAX_PASSIVE_LINES];
    struct rho_passive_paper_work work;
    struct rho_batch batch;
    /*
     * scratch of a search: of all pairs of sensors 1 and the votes, or 0 where they do not confirm;
     * of one pair three rows, and its crossings, those of scan k from scan_end[k - 1] to
     * scan_end[k] - 1
     */
    struct rho_passive_paper_fit fits[RHO_MAX_PASSIVE_LINES];
    uint8_t cells[RHO_PAPER_THETA_CELLS][RHO_PAPER_RHO_CELLS];
    uint8_t rows[3][RHO_PAPER_RHO_CELLS];
    uint16_t scan_end[RHO_MAX_PASSIVE_SCANS];
    struct rho_passive_paper_point points[RHO_MAX_PAPER_CROSSINGS];
};

/*
 * scans 8, votes_min 0, range 100 km, cells of 1 km and 2 degrees, votes of scans, the literal
 * rule. Constant cost.
 */
void rho_passive_paper_config_default(struct rho_passive_paper_config *config);

/*
 * Prepares an empty batch; the config is copied.
 *   size   sizeof(struct rho_passive_paper) of the caller
 * Errors: NULL, SIZE, CONFIG (any field outside its range); *paper is unchanged. Cost:
 * sizeof(paper) bytes cleared.
 * Stack: 160 bytes.
 */
RHO_MUST_CHECK enum rho_status
rho_passive_paper_init(struct rho_passive_paper *paper, size_t size,
                       const struct rho_passive_paper_config *config);

/*
 * Takes a frame: rho_batch_push of the batch, and its errors. The lines of the last search are
 * gone.
 * Stack: 160 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_push(struct rho_passive_paper *paper,
                                                      const struct rho_frame *frame,
                                                      uint8_t *fates);

/*
 * Searches the batch. Results: paper->lines[0 .. num_lines - 1]. Sensors without a scan in the
 * batch are left out.
 * Errors: NULL, STATE (not initialised). Fewer than 4 frames, or one sensor: RHO_OK and no line.
 * Cost: for each pair of sensors its crossings times the rows, and times the lines; cells times
 * lines (also those dropped). Stack: 1.5 KB with 8 bearings a scan, 4 KB with 16.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_search(struct rho_passive_paper *paper);

/* Two sensors with scans in the batch: their places among batch.sensors. */
struct rho_passive_paper_pair {
    uint8_t a, b;
};

/*
 * The pairs of a search, in its order: number from 0. Returns 0 beyond the last one, and *pair is
 * unchanged. Cost: scans times sensors. Stack: 180 bytes.
 */
int rho_passive_paper_pair(const struct rho_passive_paper *paper, unsigned number,
                           struct rho_passive_paper_pair *pair);

/* Where the cells of a search are: its rho is measured from the origin. */
struct rho_passive_paper_space {
    float origin_x_m, origin_y_m, rho_max_m; /* rho from -rho_max_m to rho_max_m */
    uint16_t theta_cells, rho_cells;
};

/*
 * Errors: NULL, STATE (not initialised, or no sensor in the batch). Cost: scans times sensors.
 * Stack: 200 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_space(const struct rho_passive_paper *paper,
                                                       struct rho_passive_paper_space *space);

/*
 * Step 1 for one scan and pair: the ghost matrix, pruned by the config's rule. It is that of the
 * last search until the next frame is pushed.
 *   scan  of the batch, 0 the oldest
 * Errors: NULL, STATE (not initialised), VALUE (no such scan or pair). Cost: rho_ghost_fill and
 * rho_ghost_prune. Stack: 1 KB with 8 bearings a scan, 3 KB with 16.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_ghosts(const struct rho_passive_paper *paper,
                                                        const struct rho_passive_paper_pair *pair,
                                                        unsigned scan,
                                                        struct rho_ghost_matrix *matrix);

/*
 * Step 2: the votes of a pair's accumulator; of all pairs (NULL) the sums, in the cells that every
 * pair confirms, and 0 in the others. They are those of the last search until the next frame is
 * pushed; the lines stay as they are.
 * Errors: NULL (paper), STATE (not initialised, or too little in the batch to search), VALUE (no
 * such pair), and those of rho_plane_open. Cost: the voting of rho_passive_paper_search. Stack:
 * 1.6 KB with 8 bearings a scan, 4 KB with 16.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_plane(struct rho_passive_paper *paper,
                                                       const struct rho_passive_paper_pair *pair,
                                                       struct rho_plane *plane);

/*
 * Step 3 for one pair: the cells with T votes or more in its accumulator, best first, none near a
 * better one (step 4). Lifetime, errors and stack as above; NULL also for peaks and num_peaks.
 *   peaks  room for max_peaks cells, from which they are chosen; their masks are filled
 * Cost: the voting of a pair, and the crossings a cell.
 */
RHO_MUST_CHECK enum rho_status rho_passive_paper_cells(struct rho_passive_paper *paper,
                                                       const struct rho_passive_paper_pair *pair,
                                                       struct rho_accumulator_peak *peaks,
                                                       uint32_t max_peaks, uint32_t *num_peaks);

/*
 * Eq. (3): rho of the line in direction theta through what a sensor at (x_m, y_m) sees at this
 * range and bearing. Any two sensors that see the same agree. All finite, angles within 16 turns.
 * Constant cost, stack 64 bytes.
 */
float rho_passive_paper_rho_m(float range_m, float bearing_rad, float x_m, float y_m,
                              float theta_rad);

#ifdef __cplusplus
}
#endif

#endif
