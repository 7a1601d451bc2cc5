/* SPDX-License-Identifier: MIT */
/*
 * passive_search: how the parts of passive work together.
 *
 *   passive.c          configuration, frames, the order of a search
 *   passive_points.c   crossings, votes, lines
 *   passive_near.c     bearings near a hypothesis
 *   passive_fit.c      its fit, score and covariance
 *   passive_mix.c      candidates from two others' bearings
 *   passive_select.c   candidates, and what of them become tracks
 *   passive_choose.c   which of them are tracks together, by what they share
 *   passive_set.c      fitted together, and weighed against others
 */
#ifndef RHOTRACK_PASSIVE_SEARCH_H
#define RHOTRACK_PASSIVE_SEARCH_H

#include "rhotrack/passive.h"

#define RHO_PASSIVE_STATES 4
#define RHO_PASSIVE_GAIN_MIN_NAT 1.0e-3f /* what rounding cannot make */

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
    int is_second; /* pass: claimed bearings are not there, and no third sensor is asked */
    uint16_t theta_cells, rho_cells;
    float cosine[RHO_PASSIVE_THETA_CELLS], sine[RHO_PASSIVE_THETA_CELLS];
    uint8_t row_votes[RHO_PASSIVE_THETA_CELLS]; /* the most in a row of cells */
    uint32_t worst_point;                       /* the least certain; num_points: not known */
    uint16_t candidates_taken;                  /* away again, so far */
};

/* Every field within its range. */
int rho_passive_is_usable(const struct rho_passive_config *config);

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

/* From a sensor to a state's place at a scan. */
struct rho_passive_way {
    float x_m, y_m;
};
struct rho_passive_way rho_passive_way_to(const struct rho_passive_search *search, unsigned scan,
                                          unsigned sensor, const float state_m[RHO_PASSIVE_STATES]);

/* A bearing beside a state. */
struct rho_passive_near {
    int which; /* place among those held, from 0; -1: none within nine sigmas */
    struct rho_passive_way way;
    float off_m; /* from the place to the bearing's ray */
    float sigma_rad;
};

/* The nearest bearing of a look. claimed_too 0: bearings that are claimed are not there. */
struct rho_passive_near rho_passive_nearest(const struct rho_passive_search *search, unsigned scan,
                                            unsigned sensor,
                                            const float state_m[RHO_PASSIVE_STATES],
                                            int claimed_too);

/* The claimed bearing (from 1) however far off; 0: none. */
struct rho_passive_near rho_passive_claimed(const struct rho_passive_search *search, unsigned scan,
                                            unsigned sensor,
                                            const float state_m[RHO_PASSIVE_STATES],
                                            unsigned claim);

/* Its error, measured less expected, in sigmas. */
float rho_passive_sigmas_off(const struct rho_passive_near *near);

/* Where bearings are, by direction: before any of the following. */
void rho_passive_mark_bearings(struct rho_passive_search *search);

/* How well bearings agree with a state; each counts less the more sigmas it is off, from 9 on nothing. 0 where it is told
 * early that it cannot be more than `least`. */
float rho_passive_agreement(const struct rho_passive_search *search,
                            const float state_m[RHO_PASSIVE_STATES], float least);

/* Bearings by scan and sensor, their places counted from 1; 0: none. A row of such an array. */
typedef uint8_t rho_passive_claim[RHO_MAX_PASSIVE_SENSORS];
typedef const uint8_t rho_passive_const_claim[RHO_MAX_PASSIVE_SENSORS];

/* Four Gauss-Newton steps to the nearest bearings, within 8, 5, 3.5 and 3.5 sigmas. claimed_too 0: bearings that are
 * claimed are not there. */
void rho_passive_fit(const struct rho_passive_search *search, float state_m[RHO_PASSIVE_STATES],
                     int claimed_too);

/* One step to the bearings that it claims. */
void rho_passive_fit_claimed(const struct rho_passive_search *search,
                             float state_m[RHO_PASSIVE_STATES], rho_passive_const_claim *claim);

struct rho_passive_judgement {
    float score_nat, chi2;
    uint16_t hits;
    uint16_t looks_away; /* of sensors that could not see it then */
    int is_track;        /* hits, chi2, speed and score are a track's */
};

/* Score and claims of a state: the nearest bearings within 3.5 sigmas. */
struct rho_passive_judgement rho_passive_judge(const struct rho_passive_search *search,
                                               const float state_m[RHO_PASSIVE_STATES],
                                               int claimed_too, rho_passive_claim *claim);

/* The score with given claims. */
struct rho_passive_judgement rho_passive_judge_claimed(const struct rho_passive_search *search,
                                                       const float state_m[RHO_PASSIVE_STATES],
                                                       rho_passive_const_claim *claim);

/* What a bearing of a look (claim, from 1) adds to the score, compared with none; 0 where it is not within 3.5 sigmas. */
float rho_passive_gain(const struct rho_passive_search *search,
                       const float state_m[RHO_PASSIVE_STATES], unsigned scan, unsigned sensor,
                       unsigned claim);

/* Place and velocity at the newest scan, with their covariance, of a track's claims. 0 where there is none. */
int rho_passive_report(const struct rho_passive_search *search,
                       const float state_m[RHO_PASSIVE_STATES], struct rho_passive_track *track);

/* ---- mixing ---- */

/* Fits what one candidate's bearings of a sensor and another's of another sensor make, and offers it. */
void rho_passive_mix(struct rho_passive_search *search);

/* ---- selection ---- */

/* Candidates by score, best first. */
void rho_passive_rank(const struct rho_passive *passive, uint8_t order[RHO_MAX_PASSIVE_CANDIDATES]);

/* A fitted state becomes a candidate, unless it is no track or another one's twin. Returns whether it is a track. */
int rho_passive_offer(struct rho_passive_search *search, const float state_m[RHO_PASSIVE_STATES]);

unsigned rho_passive_count_shared(const struct rho_passive_search *search,
                                  const struct rho_passive_candidate *a,
                                  const struct rho_passive_candidate *b);

/* Candidates in and out of what is chosen together. */
struct rho_passive_choice {
    const struct rho_passive_search *search;
    unsigned count;
    uint8_t is_in[RHO_MAX_PASSIVE_CANDIDATES];
    uint8_t is_out[RHO_MAX_PASSIVE_CANDIDATES]; /* may not come in */
    /* of each, with those chosen: its score less what it shares */
    float gain_nat[RHO_MAX_PASSIVE_CANDIDATES];
    float total_nat;
};

/* The best choice that is found. */
void rho_passive_choose(const struct rho_passive_search *search, struct rho_passive_choice *best);

/* Takes a candidate and its kin out for good. */
void rho_passive_bar(struct rho_passive_choice *choice, unsigned which);

/* Takes one in (count: none), and fills up with what gains. */
void rho_passive_force(struct rho_passive_choice *choice, unsigned which);

/* Leaves one out and fills up again, as long as that gains. */
void rho_passive_improve(struct rho_passive_choice *choice);

/* The chosen ones as a set: bearings are given out anew, one to one, and each is fitted to its own; those that are no
 * tracks then drop out. */
void rho_passive_gather(const struct rho_passive_search *search,
                        const struct rho_passive_choice *choice, struct rho_passive_set *set);

/* What passive->best is worth more than the best others without each of its tracks. Where others are worth more, they
 * become the best. */
void rho_passive_weigh(const struct rho_passive_search *search, struct rho_passive_choice *choice,
                       float margins_nat[RHO_MAX_PASSIVE_TRACKS]);

/* Claims the bearings of the best set of candidates. */
void rho_passive_claim_best(struct rho_passive_search *search);

/* The best set of candidates becomes passive->tracks. */
void rho_passive_select(struct rho_passive_search *search);

#endif
