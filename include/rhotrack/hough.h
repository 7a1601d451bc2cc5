/* SPDX-License-Identifier: MIT */
/*
 * hough: track initiation by the Hough transform as in the literature, for comparison and teaching:
 * with single plots (HT), with pairs of plots (MHT), with pairs within limits of speed (IHT), and
 * neutrosophic (NHT). In operation use the initiator.
 *
 * A line of the plane is a point (rho, theta). The plane of all such points is divided into cells
 * that plots vote for:
 *
 *     HT    every plot, in each row of theta: the cell of the line through it
 *     MHT   every pair of plots of successive scans ("candidate temporary track"): the cell of the
 *           line through both
 *     IHT   pairs as in MHT, where v_min <= distance / time <= v_max, eq. (20)
 *     NHT   pairs as in IHT, where a pair of the two scans before ("kernel") has nearly the same
 *           line; the vote is the membership, eq. (27)
 *
 * Peaks are the cells with at least votes_min votes and at least the share tau of the most votes,
 * except cells near a better peak.
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
#include "rhotrack/detail/votes_picture.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

/* Counts of votes are in units of 1/65536 vote: this is one vote. Sums saturate. */
#define RHO_HOUGH_VOTE 65536u

/* Largest number of cells within 2 eps of a line, in rho and in theta. */
#define RHO_HOUGH_REACH_MAX 255u

enum rho_hough_method {
    RHO_HOUGH_HT,
    RHO_HOUGH_MHT,
    RHO_HOUGH_IHT,
    /*
     * NHT, reading A of the paper, which does not say clearly which cells a vote is for: the cell
     * of the pair alone, literally (23).
     */
    RHO_HOUGH_NHT_A,
    /*
     * NHT, reading C of the paper: a vote is for all cells within 2 eps of the pair's cell,
     * weighted by (15), the "list of all the parameter points".
     */
    RHO_HOUGH_NHT_C
};

struct rho_hough_config {
    enum rho_hough_method method;
    /*
     * Extent and cells of the plane, as in struct rho_accumulator_config. rho is signed: (10) as
     * printed has |rho|, which takes two mirrored lines for one, and n_rho in (25) counts cells of
     * both signs. theta is in [0, pi): see rho_angle_line for (9).
     */
    float rho_max_m, rho_cell_m, theta_cell_rad;
    /*
     * epsilon of (15), (27), (28): kernels of a line are within 2 eps of it in rho and in theta,
     * ends included, also across the ends of theta; so are peaks that a better peak suppresses. At
     * least 1 mm and 0.1 mrad, at most RHO_HOUGH_REACH_MAX / 2 cells and 0.5 rad.
     */
    float eps_rho_m, eps_theta_rad;
    /* limits of a candidate pair's speed: 0 <= v_min < v_max <= RHO_LIMIT_SPEED_MPS; IHT and NHT */
    float v_min_mps, v_max_mps;
    /*
     * P_F and lambda_k of (29), 0 .. 1 and 0 .. 1e6: a pair whose T and I are both below F =
     * lambda_k P_F^2 does not vote. As (24) and (30) contradict each other, the vote is max(T, I),
     * and F is only this threshold.
     */
    float p_false, lambda_k;
    /*
     * 1: the vote counts I, the nearness of the pair's line to the line between the two nearest
     * kernels, through the midpoints of their plots; 0: not. No effect of I could be measured.
     */
    int uses_indeterminacy;
    /* votes of HT: distinct scans, or points, as in the paper; the other methods ignore it */
    enum rho_accumulator_votes votes;
    /*
     * thresholds of a peak: tau, its share of the most votes, eq. (32), 0 .. 1 (the paper gives no
     * value); votes_min, its votes, 0 .. 65535, without which clutter alone always has a peak
     */
    float tau, votes_min;
    int keeps_all_cells; /* 1: no suppression: every cell above the thresholds is listed */
};

/*
 * Plots in the order of their scans, at most 65535 a scan, and the time of each plot, in seconds
 * from any origin. The arrays stay the caller's.
 */
struct rho_hough_points {
    struct rho_accumulator_points at;
    const float *t_s;
};

struct rho_hough_result {
    uint32_t num_peaks;
    /* upper bound of the cells above the thresholds left out for lack of room, the lowest ones */
    uint32_t cells_dropped;
    uint32_t pairs;      /* pairs of plots of successive scans; 0 for HT */
    uint32_t candidates; /* pairs of plots within the limits of speed; 0 for HT */
    uint32_t votes;      /* number of additions to a cell, other than 0 */
    uint32_t cells;      /* number of cells with votes; 0 for HT */
    uint32_t votes_max;  /* most votes of a cell, in units of 1 / RHO_HOUGH_VOTE */
    uint32_t passes;     /* number of passes over parts of theta */
    /* left out as one row of theta had more than RHO_MAX_HOUGH_CELLS, RHO_MAX_HOUGH_KERNELS */
    uint32_t votes_dropped, kernels_dropped;
};

/*
 * The neutrosophic memberships of a pair's vote, eq. (14), in units of 1 / RHO_HOUGH_VOTE; 0 for
 * methods other than NHT.
 *   truth          the pair continues the nearest kernel, eq. (27); 0: there is no kernel
 *   indeterminacy  the pair is near the line midway between the two nearest kernels, so that it may
 *                  continue either; 0: there are not two. The vote counts it if uses_indeterminacy
 *   falsity        two false alarms make the pair, eq. (29), at most one vote
 * The three need not sum up to 1: (30), by which they do, contradicts (24).
 */
struct rho_hough_memberships {
    uint32_t truth, indeterminacy, falsity;
};

/* The quantity whose sums the cells of a plane hold. */
enum rho_hough_component {
    RHO_HOUGH_VOTES,         /* votes, as the method counts them, eq. (31): C */
    RHO_HOUGH_TRUTH,         /* truth memberships, eq. (16): C_T */
    RHO_HOUGH_INDETERMINACY, /* indeterminacy memberships, eq. (17): C_I */
    RHO_HOUGH_FALSITY,       /* falsity memberships, eq. (18): C_F */
    /*
     * the largest of the three memberships of each vote, eq. (24) as printed. (19) takes the
     * largest sum instead: never more, and equal where one membership is largest in all votes
     */
    RHO_HOUGH_LARGEST,
    RHO_NUM_HOUGH_COMPONENTS
};

/* Votes of a cell, and the position and velocity fitted through the plots that voted for it. */
struct rho_hough_track {
    /* votes of the cell, in 1 / RHO_HOUGH_VOTE; reading C: rounded, by up to 2 units a pair */
    uint32_t votes;
    uint32_t num_plots; /* number of plots that voted, each counted once */
    uint16_t mask;      /* scans of the plots that voted: bit m for scan m */
    uint16_t scans;     /* number of scans in mask */
    /* 1: the plots are of two scans or more; 0: position is their mean, and velocity 0 */
    int has_velocity;
    float x_m, y_m, vx_mps, vy_mps;
    /* sums of the memberships, C_T, C_I and C_F; 0 for methods other than NHT */
    struct rho_hough_memberships sums;
};

struct rho_hough_cell {
    uint32_t key; /* position of the cell: theta_cell << 16 | rho_cell */
    uint32_t votes;
};

/* A kernel: a pair of plots of the two scans before, with the line through them. */
struct rho_hough_kernel {
    float rho_m, theta_rad;
    uint16_t first, second;
    uint16_t next; /* next kernel of the same hash chain, index from 1; 0: end of the chain */
};

struct rho_hough {
    uint32_t magic;
    uint16_t theta_cells, rho_cells;
    uint16_t theta_reach, rho_reach; /* number of cells within 2 eps */
    struct rho_hough_config config;
    union {
        struct rho_accumulator accumulator; /* method HT */
        struct {
            struct rho_hough_cell cells[RHO_MAX_HOUGH_CELLS];
            union {
                struct {
                    uint16_t heads[RHO_HOUGH_CHAINS];
                    struct rho_hough_kernel list[2][RHO_MAX_HOUGH_KERNELS];
                } kernels;
                /* NHT_C: sums of one row of cells, when all pairs have voted */
                uint32_t row[RHO_MAX_RHO_CELLS];
            } step;
        } sparse;
    } work;
};

/*
 * The paper's values: cells of 5 m and 1 mrad, eps 20 m and 4 mrad, 100 .. 400 m/s, P_F 0.01,
 * lambda_k 1, tau 0.5, votes of points, no I. Not from the paper: votes_min 0, suppression of cells
 * near a better one, and the largest rho_max that RHO_MAX_RHO_CELLS allows. Constant cost.
 */
void rho_hough_config_default(struct rho_hough_config *config, enum rho_hough_method method);

/*
 * Initialises a search; the config is copied.
 *   object_size   sizeof(struct rho_hough) of the caller
 * Errors: NULL, SIZE, CONFIG (any field outside its range). Constant cost.
 */
RHO_MUST_CHECK enum rho_status rho_hough_init(struct rho_hough *hough, size_t object_size,
                                              const struct rho_hough_config *config);

/*
 * Lets all plots or pairs vote, and finds the peaks.
 *   peaks   room for max_peaks cells, from which the peaks are chosen; best first, votes in units
 *           of 1 / RHO_HOUGH_VOTE; mask is filled with HT and RHO_VOTES_SCANS, else 0
 *   result  all fields are filled
 * A pair of plots in one place has no line and does not vote, nor do lines beyond rho_max_m.
 * Errors: NULL, STATE (not initialised), VALUE (num_scans, scan_end, more than 65535 plots in a
 * scan, a place not finite or beyond RHO_LIMIT_POSITION_M, a time not finite or beyond 1e9 s);
 * nothing but *hough's scratch is changed.
 * Cost: HT as rho_accumulator_find_peaks. Others: the pairs, once a pass; NHT_C (2 reach + 1)^2
 * additions a vote. Then n log n of the cells found. Stack: 2.8 KB, HT 1 KB.
 */
RHO_MUST_CHECK enum rho_status rho_hough_find(struct rho_hough *hough,
                                              const struct rho_hough_points *points,
                                              struct rho_accumulator_peak *peaks,
                                              uint32_t max_peaks, struct rho_hough_result *result);

/*
 * Finds the plots that voted for a cell, and fits a position and velocity through them.
 *   at_s   time of the position in *track
 * Errors: as rho_hough_find, and VALUE for a cell outside the plane. Cost: checking all plots, and
 * the pairs (NHT: pairs of pairs) of the plots near the line. Stack: 2.8 KB.
 */
RHO_MUST_CHECK enum rho_status rho_hough_track(struct rho_hough *hough,
                                               const struct rho_hough_points *points,
                                               unsigned theta_cell, unsigned rho_cell, float at_s,
                                               struct rho_hough_track *track);

/*
 * Fills a picture of the plane with the sums of a component, from the given points; with the points
 * of the last search it is that search's plane.
 *   plane  the window and its picture, in the caller's memory
 * Sums are over all candidate pairs, eq. (20), of the third scan and later, spread like votes with
 * reading C. The sums of RHO_HOUGH_VOTES are the votes that rho_hough_find compares.
 * Errors: as rho_hough_find, those of rho_votes_picture_init, and VALUE (no such component, or
 * memberships of a method other than NHT); nothing but *hough's scratch and the picture is changed.
 * Cost: that of rho_hough_find. Stack: 2.9 KB.
 */
RHO_MUST_CHECK enum rho_status rho_hough_plane(struct rho_hough *hough,
                                               const struct rho_hough_points *points,
                                               enum rho_hough_component component,
                                               struct rho_votes_picture *plane);

/*
 * Computes the memberships of the vote of a pair of plots of successive scans. All are 0 where the
 * pair is no candidate, eq. (20), its second plot is of the second scan, or the method is not NHT.
 *   first, second  indices of the pair's plots among the plots of all scans
 * Errors: as rho_hough_find, and VALUE (the plots are not of successive scans). Cost: the pairs of
 * the two scans before that are near the line. Stack: 2.8 KB.
 */
RHO_MUST_CHECK enum rho_status rho_hough_vote(const struct rho_hough *hough,
                                              const struct rho_hough_points *points, uint32_t first,
                                              uint32_t second,
                                              struct rho_hough_memberships *memberships);

/*
 * Counts the pairs of plots of successive scans, and the candidates among them, whose speed is
 * within the limits; both saturate. Cost: the pairs.
 */
void rho_hough_count_pairs(const struct rho_hough *hough, const struct rho_hough_points *points,
                           uint32_t *pairs, uint32_t *candidates);

/* theta and rho of the line through the centre of a cell. Constant cost. */
float rho_hough_theta_rad(const struct rho_hough *hough, unsigned theta_cell);
float rho_hough_rho_m(const struct rho_hough *hough, unsigned rho_cell);

RHO_END_C

#endif
