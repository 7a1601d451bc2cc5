/* SPDX-License-Identifier: MIT */
/*
 * passive_search: how the parts of passive work together.
 *
 *   passive.c          configuration, frames, the order of a search
 *   passive_points.c   crossings, votes, lines
 *   passive_fit.c      bearings of a hypothesis: score, fit, covariance
 *   passive_select.c   candidates, and which of them are tracks together
 */
#ifndef RHOTRACK_PASSIVE_SEARCH_H
#define RHOTRACK_PASSIVE_SEARCH_H

#include "rhotrack/passive.h"

#define RHO_PASSIVE_STATES 4

/*
 * What a search goes by. Places count from the sensors' middle; a state is the place at mid-batch (x, y) and the way
 * flown in half the batch (dx, dy), so that all four are lengths: the place at scan k is (x, y) + step[k] (dx, dy).
 */
struct rho_passive_search {
    struct rho_passive *passive;
    float middle_x_m, middle_y_m;
    float x_m[RHO_MAX_PASSIVE_SENSORS], y_m[RHO_MAX_PASSIVE_SENSORS];
    float half_s;                      /* of the time from the first scan to the last */
    float step[RHO_MAX_PASSIVE_SCANS]; /* -1 .. 1 */
    float hit_nat, miss_nat; /* a bearing that agrees exactly, times its sigma in rad; none */
    float share_nat;         /* what a bearing that two tracks claim costs one of them */
    float sigma_min_rad;     /* bearings count as no better */
    unsigned looks;          /* scans times sensors that reported */
    unsigned hits_min;
    int is_second; /* pass: claimed bearings are not there, and no third sensor is asked */
    uint16_t theta_cells, rho_cells;
    float cosine[RHO_PASSIVE_THETA_CELLS], sine[RHO_PASSIVE_THETA_CELLS];
    uint8_t row_votes[RHO_PASSIVE_THETA_CELLS]; /* the most in a row of cells */
    uint32_t worst_point;                       /* the least certain; num_points: not known */
    uint16_t candidates_taken;                  /* away again, so far */
};

/* ---- lines ---- */

/* Crossings of all pairs of sensors into passive->points. */
void rho_passive_cross(struct rho_passive_search *search);

/* They vote. */
void rho_passive_vote(struct rho_passive_search *search);

struct rho_passive_line {
    float cosine, sine, rho_m;
};

/* The line with the most votes, at least votes_min; its neighbours are taken off. 0 where there is none. */
int rho_passive_next_line(struct rho_passive_search *search, unsigned votes_min,
                          struct rho_passive_line *line);

/* Constant velocities through pairs of the line's crossings: fits the best of them and hands these on. */
void rho_passive_propose(struct rho_passive_search *search, const struct rho_passive_line *line);

/* ---- bearings of a state ---- */

/* Where bearings are, by direction: before any of the following. */
void rho_passive_mark_bearings(struct rho_passive_search *search);

/* How well bearings agree with a state; each counts less the more sigmas it is off, from 9 on nothing. 0 where it is told
 * early that it cannot be more than `least`. */
float rho_passive_agreement(const struct rho_passive_search *search,
                            const float state_m[RHO_PASSIVE_STATES], float least);

/* Gauss-Newton steps; the gates are in sigmas. claimed_too 0: bearings that are claimed are not there. */
void rho_passive_fit(const struct rho_passive_search *search, float state_m[RHO_PASSIVE_STATES],
                     const float *gates, unsigned num_steps, int claimed_too);

struct rho_passive_judgement {
    float score_nat, chi2;
    uint16_t hits;
    int is_track; /* hits, chi2, speed and score are a track's */
};

/* Score and claims of a state. */
struct rho_passive_judgement
rho_passive_judge(const struct rho_passive_search *search, const float state_m[RHO_PASSIVE_STATES],
                  int claimed_too, uint8_t claim[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS]);

/* Place and velocity at the newest scan, with their covariance. 0 where there is none. */
int rho_passive_report(const struct rho_passive_search *search,
                       const float state_m[RHO_PASSIVE_STATES], struct rho_passive_track *track);

/* ---- mixing ---- */

/* Fits what one candidate's bearings of a sensor and another's of another sensor make, and offers it. */
void rho_passive_mix(struct rho_passive_search *search);

/* ---- selection ---- */

/* Candidates by score, best first. */
void rho_passive_rank(const struct rho_passive *passive,
                      uint8_t order[RHO_MAX_PASSIVE_CANDIDATES]);

/* A fitted state becomes a candidate, unless it is no track or another one's twin. Returns whether it is a track. */
int rho_passive_offer(struct rho_passive_search *search, const float state_m[RHO_PASSIVE_STATES]);

/* The candidates that are tracks together: fitted again each on what the better ones leave, into passive->tracks; their
 * bearings are claimed. */
void rho_passive_select(struct rho_passive_search *search);

#endif
