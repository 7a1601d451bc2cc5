/* SPDX-License-Identifier: MIT */
/*
 * hough: track initiation as the literature does it, for comparison and teaching: the Hough
 * transform (HT), with pairs of plots (MHT), with pairs that a target can fly (IHT), and the
 * neutrosophic one (NHT). For work use the initiator.
 *
 * A line of the plane is a point (rho, theta). The plane of all such points is divided into cells
 * that plots vote for:
 *
 *     HT    every plot, in each row of theta: the cell of the line through it
 *     MHT   every pair of plots of successive scans ("candidate temporary track"): the cell of the
 *           line through both
 *     IHT   the same, where v_min <= distance / time <= v_max, eq. (20)
 *     NHT   the same, where a pair of the scans before ("kernel") has nearly the same line; the
 *           vote is the membership, eq. (27)
 *
 * Peaks are the cells with at least votes_min votes and a share of tau of the most votes, except
 * those near a better peak.
 *
 * Not all cells are stored. HT streams rows of theta (accumulator). The votes of pairs go into a
 * hash of fixed size; if it is too small, the rows of theta are searched in several passes. Results
 * do not depend on its size.
 *
 * Source: Fan et al., "Neutrosophic Hough Transform-Based Track Initiation Method for Multiple
 * Target Tracking"; where the paper leaves a choice or has a misprint, the comment of the
 * field or function states the choice. src/DESIGN.md has the reasons and the limits of these
 * methods: the paper's claims hold up to about 0.6 m of noise, not at its own 10 m.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_HOUGH_H
#define RHOTRACK_HOUGH_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/detail/accumulator.h"
#include "rhotrack/detail/plane.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One vote in the units of all counts, of 1/65536 vote; sums saturate. */
#define RHO_HOUGH_VOTE 65536u

/* Largest number of cells within 2 eps, in each direction. */
#define RHO_HOUGH_REACH_MAX 255u

enum rho_hough_method {
    RHO_HOUGH_HT,
    RHO_HOUGH_MHT,
    RHO_HOUGH_IHT,
    /*
     * Where an NHT vote goes, the paper does not say clearly. Reading A: to the pair's own cell,
     * literally (23).
     */
    RHO_HOUGH_NHT_A,
    /*
     * Reading C: to all cells within 2 eps of the pair's, weighted by (15), the "list of all the
     * parameter points".
     */
    RHO_HOUGH_NHT_C
};

struct rho_hough_config {
    enum rho_hough_method method;
    /*
     * The plane: as in struct rho_accumulator_config. rho is signed: (10) as printed takes |rho|,
     * which makes one line of two mirror ones, and n_rho in (25) is for either sign. theta is in
     * [0, pi): see rho_angle_line for (9).
     */
    float rho_max_m, rho_cell_m, theta_cell_rad;
    /*
     * epsilon of (15), (27), (28): kernels lie within 2 eps, ends included, in rho and in theta,
     * also round the end of theta; so do peaks that a better one suppresses. At least 1 mm and 0.1
     * mrad, at most RHO_HOUGH_REACH_MAX / 2 cells and 0.5 rad.
     */
    float eps_rho_m, eps_theta_rad;
    float v_min_mps, v_max_mps; /* 0 <= v_min < v_max <= RHO_LIMIT_SPEED_MPS; IHT and NHT */
    /*
     * P_F and lambda_k of (29): F = lambda_k P_F^2, and a pair whose T and I are below F does not
     * vote. (24) and (30) cannot both hold: votes are max(T, I), and F only this threshold. p_false
     * 0 .. 1, lambda_k 0 .. 1e6.
     */
    float p_false, lambda_k;
    /*
     * I: how near the pair's line is to that between the two best kernels, through the midpoints of
     * their plots. It changes nothing that could be measured; 0: left out
     */
    int uses_indeterminacy;
    enum rho_accumulator_votes votes; /* HT only; the paper counts points */
    /*
     * Thresholds: share of the most votes, eq. (32), 0 .. 1 (the paper gives none); and votes, 0 ..
     * 65535, which (32) lacks: by it clutter alone always has a "target".
     */
    float tau, votes_min;
    int keeps_all_cells; /* no suppression: every cell above the thresholds is listed */
};

/*
 * Plots in the order of their scans, and the time of each, seconds from any origin. The arrays stay
 * the caller's. A scan has at most 65535.
 */
struct rho_hough_points {
    struct rho_accumulator_points at;
    const float *t_s;
};

struct rho_hough_result {
    uint32_t num_peaks;
    /*
     * cells above the thresholds beyond the caller's capacity, at most so many; peaks are right
     * down to the lowest
     */
    uint32_t cells_dropped;
    uint32_t pairs;      /* of plots of successive scans; 0 for HT */
    uint32_t candidates; /* of them within the limits of speed; 0 for HT */
    uint32_t votes;      /* contributions to a cell that are not 0 */
    uint32_t cells;      /* with votes; 0 for HT */
    uint32_t votes_max;  /* parts of a vote */
    uint32_t passes;     /* over parts of theta */
    /*
     * what a single row of theta had too much of, for RHO_MAX_HOUGH_CELLS and
     * RHO_MAX_HOUGH_KERNELS
     */
    uint32_t votes_dropped, kernels_dropped;
};

/*
 * The memberships of a vote, eq. (14), in parts of a vote; those of NHT alone are not 0.
 *   truth          of the line as that of the nearest kernel, eq. (27); 0: there is none
 *   indeterminacy  as the line between the two nearest kernels, in the middle of their plots: which
 *                  of the two candidate tracks the plots continue is not known; 0: there are not
 *                  two. Whether the vote counts it, uses_indeterminacy says
 *   falsity        that two false alarms make the pair, eq. (29), at most a vote
 * Each is a possibility of its own: (30) cannot hold beside (24).
 */
struct rho_hough_memberships {
    uint32_t truth, indeterminacy, falsity;
};

/* What a cell has a sum of. */
enum rho_hough_component {
    RHO_HOUGH_VOTES,         /* what the method counts, eq. (31): C */
    RHO_HOUGH_TRUTH,         /* eq. (16): C_T */
    RHO_HOUGH_INDETERMINACY, /* eq. (17): C_I */
    RHO_HOUGH_FALSITY,       /* eq. (18): C_F */
    /*
     * eq. (24) as printed, the largest of the three. (19) takes the largest of the sums instead,
     * which is no more in any cell, and equal where the same membership is largest in all votes
     */
    RHO_HOUGH_LARGEST,
    RHO_NUM_HOUGH_COMPONENTS
};

/* The voters of a cell, and the position and velocity fitted through them. */
struct rho_hough_track {
    uint32_t votes;     /* parts of a vote; with reading C, to 2 of them a pair */
    uint32_t num_plots; /* each counted once */
    uint16_t mask;      /* bit m: a plot of scan m */
    uint16_t scans;     /* bits in mask */
    int has_velocity;   /* two scans or more; else the mean position, and velocity 0 */
    float x_m, y_m, vx_mps, vy_mps;
    struct rho_hough_memberships sums; /* C_T, C_I and C_F in the cell; 0 but for NHT */
};

struct rho_hough_cell {
    uint32_t key; /* theta_cell << 16 | rho_cell */
    uint32_t votes;
};

/* A pair of plots of the scans before: indices within them. */
struct rho_hough_kernel {
    float rho_m, theta_rad;
    uint16_t first, second;
    uint16_t next; /* of the same chain, from 1; 0: none */
};

struct rho_hough {
    uint32_t magic;
    uint16_t theta_cells, rho_cells;
    uint16_t theta_reach, rho_reach; /* cells within 2 eps */
    struct rho_hough_config config;
    union {
        struct rho_accumulator accumulator; /* HT */
        struct {
            struct rho_hough_cell cells[RHO_MAX_HOUGH_CELLS];
            union {
                struct {
                    uint16_t heads[RHO_HOUGH_CHAINS];
                    struct rho_hough_kernel list[2][RHO_MAX_HOUGH_KERNELS];
                } kernels;
                uint32_t row[RHO_MAX_RHO_CELLS]; /* NHT_C: of cells, when all pairs have voted */
            } step;
        } sparse;
        uint32_t kept[RHO_MAX_HOUGH_CELLS]; /* when peaks are suppressed */
    } work;
};

/*
 * The paper's values: 5 m, 1 mrad, eps 20 m and 4 mrad, 100 .. 400 m/s, P_F 0.01, lambda_k 1, tau
 * 0.5, points count, no I; votes_min 0, cells near a better one suppressed, and rho_max the largest
 * that RHO_MAX_RHO_CELLS allows. Constant cost.
 */
void rho_hough_config_default(struct rho_hough_config *config, enum rho_hough_method method);

/*
 * Prepares a search; the config is copied.
 *   size   sizeof(struct rho_hough) of the caller
 * Errors: NULL, SIZE, CONFIG (any field outside its range). Constant cost.
 */
RHO_MUST_CHECK enum rho_status rho_hough_init(struct rho_hough *hough, size_t size,
                                              const struct rho_hough_config *config);

/*
 * Votes, and finds the peaks.
 *   peaks   room for max_peaks cells, from which the peaks are chosen: best first, votes in parts
 *           of a vote; mask is 0 but with HT and RHO_VOTES_SCANS
 *   result  filled whole
 * Two plots in one place have no line and do not vote as a pair; nor do lines beyond rho_max_m.
 * Errors: NULL, STATE (not initialised), VALUE (num_scans, scan_end, more than 65535 plots in a
 * scan, a place not finite or beyond RHO_LIMIT_POSITION_M, a time not finite or beyond 1e9 s);
 * nothing but *hough's scratch is changed.
 * Cost: HT as rho_accumulator_find. Others: the pairs, once a pass; NHT_C (2 reach + 1)^2 additions
 * a vote. Then the cells above the thresholds, n log n. Stack: 1 KB, HT 1.9 KB, NHT_C 2.8 KB.
 */
RHO_MUST_CHECK enum rho_status rho_hough_find(struct rho_hough *hough,
                                              const struct rho_hough_points *points,
                                              struct rho_accumulator_peak *peaks,
                                              uint32_t max_peaks, struct rho_hough_result *result);

/*
 * The votes of any cell of the plane, and the plots that cast them.
 *   at_s   time of the position in *track
 * Errors: as above, and VALUE for a cell outside the plane. Cost: the plots, which are also
 * checked anew, and the pairs (NHT: pairs of pairs) of those
 * near the line. Stack: 2.8 KB.
 */
RHO_MUST_CHECK enum rho_status rho_hough_track(struct rho_hough *hough,
                                               const struct rho_hough_points *points,
                                               unsigned theta_cell, unsigned rho_cell, float at_s,
                                               struct rho_hough_track *track);

/*
 * The plane of a component, as the points make it: those of the last search, its plane.
 *   plane  the window and its picture, in the caller's memory
 * Sums are over all candidate pairs, eq. (20), of the third scan and later; with reading C each is
 * spread as the votes are. The cells of RHO_HOUGH_VOTES are those that rho_hough_find compares.
 * Errors: as rho_hough_find, those of rho_plane_open, and VALUE (no such component, one of the
 * memberships with another method than NHT); nothing but *hough's scratch and the picture is
 * changed. Cost: that of rho_hough_find. Stack: 2.9 KB.
 */
RHO_MUST_CHECK enum rho_status rho_hough_plane(struct rho_hough *hough,
                                               const struct rho_hough_points *points,
                                               enum rho_hough_component component,
                                               struct rho_plane *plane);

/*
 * The memberships of one vote: the line through two plots of successive scans. All are 0 where the
 * pair is no candidate, eq. (20), its scan is the second one, or the method is not NHT.
 *   first, second  indices among the plots of all scans
 * Errors: NULL, STATE and VALUE as above, VALUE (no plots of successive scans). Cost: the pairs of
 * the scans before, near the line. Stack: 2.8 KB.
 */
RHO_MUST_CHECK enum rho_status rho_hough_vote(const struct rho_hough *hough,
                                              const struct rho_hough_points *points, uint32_t first,
                                              uint32_t second,
                                              struct rho_hough_memberships *memberships);

/*
 * Pairs of plots of successive scans, and the number within the limits of speed; both saturate.
 * Cost: the pairs.
 */
void rho_hough_count_pairs(const struct rho_hough *hough, const struct rho_hough_points *points,
                           uint32_t *pairs, uint32_t *candidates);

/* The line through the centre of a cell. Constant cost. */
float rho_hough_theta_rad(const struct rho_hough *hough, unsigned theta_cell);
float rho_hough_rho_m(const struct rho_hough *hough, unsigned rho_cell);

#ifdef __cplusplus
}
#endif

#endif
