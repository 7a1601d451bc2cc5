/* SPDX-License-Identifier: MIT */
/*
 * passive_search: one search of the passive initiator, as its phases share it. A file may call
 * those above it in this list, never those below it:
 *
 *   passive_match.c        the bearings that match a state
 *   passive_fit.c          Gauss-Newton fit, score and covariance of a state
 *   passive_candidates.c   the list of candidates for tracks
 *   passive_choice.c       the subset of candidates with the highest total score
 *   passive_joint_fit.c    one-to-one assignment of bearings to the chosen tracks, and their fits
 *   passive_margins.c      margins of the tracks against the best other sets
 *
 *   passive_prepare.c      geometry, times, likelihood ratios
 *   passive_crossings.c    phase 1: crossings of all pairs of sensors
 *   passive_lines.c        phase 2: votes, and the lines with the most votes
 *   passive_hypotheses.c   phase 3: constant velocities through pairs of a line's crossings
 *   passive_selection.c    phases 4 and 5: the best set of candidates, and the tracks
 *   bearing_swap.c         candidates from two candidates that have swapped their bearings
 *   passive.c              configuration, frames, the plan of a search
 */
#ifndef RHOTRACK_PASSIVE_SEARCH_H
#define RHOTRACK_PASSIVE_SEARCH_H

#include "rhotrack/detail/approx.h"
#include "rhotrack/passive.h"

/*
 * A state is the position at mid-batch (x, y) and the displacement in half the batch (dx, dy), all
 * in metres: the position at scan k is (x, y) + step[k] (dx, dy). The origin is the sensors'
 * centroid.
 */
#define RHO_PASSIVE_STATES 4
#define RHO_PASSIVE_X 0
#define RHO_PASSIVE_Y 1
#define RHO_PASSIVE_DX 2
#define RHO_PASSIVE_DY 3

#define RHO_PASSIVE_GAIN_MIN_NAT 1.0e-3f /* above rounding errors */
#define RHO_PASSIVE_SPREAD_SIGMAS 2.0f   /* of a crossing's rho: its votes, and lines it is on */

/* Values computed once for a search. Positions count from the sensors' centroid. */
struct rho_passive_search {
    struct rho_passive *passive;
    float middle_x_m, middle_y_m; /* the centroid */
    float x_m[RHO_MAX_PASSIVE_SENSORS], y_m[RHO_MAX_PASSIVE_SENSORS];
    float half_s;                      /* half the time from the first scan to the last */
    float step[RHO_MAX_PASSIVE_SCANS]; /* -1 .. 1 */
    float hit_nat;       /* score of a bearing with residual 0, plus ln of its sigma in rad */
    float miss_nat;      /* score of a look without a bearing */
    float share_nat;     /* penalty for a bearing that two candidates claim */
    float sigma_min_rad; /* bearings with a smaller sigma get this one */
    unsigned looks;      /* scans times sensors that reported */
    int is_second;       /* second pass: claimed bearings are left out, no third sensor is needed */
    uint16_t theta_cells, rho_cells;
    float cosine[RHO_PASSIVE_THETA_CELLS], sine[RHO_PASSIVE_THETA_CELLS];
    uint8_t row_votes[RHO_PASSIVE_THETA_CELLS]; /* largest number of votes in a row of cells */
    uint32_t worst_point;        /* the least certain crossing; num_points: not known */
    uint16_t candidates_removed; /* so far */
};

/* Fills the search from the batch. */
void rho_passive_prepare(struct rho_passive_search *search);

/* Fills passive->start_mnat from the number of crossings of the first pass. */
void rho_passive_set_start_score(const struct rho_passive_search *search);

/* ---- phase 1: crossings ---- */

/* Crossings of all pairs of sensors into passive->points. */
void rho_passive_find_crossings(struct rho_passive_search *search);

/* Trace of a crossing's covariance. */
static inline float rho_passive_uncertainty_m2(const struct rho_passive_point *point)
{
    return point->xx_m2 + point->yy_m2;
}

/* Standard deviation of a crossing's rho in a row of theta. */
static inline float rho_passive_rho_sigma_m(const struct rho_passive_point *point, float cosine,
                                            float sine)
{
    return rho_sqrt(point->xx_m2 * cosine * cosine + 2.0f * point->xy_m2 * cosine * sine +
                    point->yy_m2 * sine * sine);
}

/* ---- phase 2: lines ---- */

/* All crossings vote. */
void rho_passive_vote_for_lines(struct rho_passive_search *search);

struct rho_passive_line {
    float cosine, sine, rho_m;
};

/*
 * The line with the most votes, at least votes_min; its neighbours lose theirs. 0: there is none.
 */
int rho_passive_next_line(struct rho_passive_search *search, unsigned votes_min,
                          struct rho_passive_line *line);

/* ---- phase 3: hypotheses ---- */

/* Constant velocities through pairs of the line's crossings: the best are fitted and offered. */
void rho_passive_fit_hypotheses(struct rho_passive_search *search,
                                const struct rho_passive_line *line);

/* ---- bearings that match a state ---- */

/* From a sensor to the position of a state at a scan. */
struct rho_passive_offset {
    float x_m, y_m;
};
struct rho_passive_offset rho_passive_offset_from_sensor(const struct rho_passive_search *search,
                                                         unsigned scan, unsigned sensor,
                                                         const float state_m[RHO_PASSIVE_STATES]);

/* A bearing compared with a state. */
struct rho_passive_match {
    int bearing; /* index among the bearings held, from 0; -1: none within nine sigmas */
    struct rho_passive_offset offset;
    float cross_range_m; /* distance of the position from the bearing's ray */
    float sigma_rad;
};

/* The nearest bearing of a look. include_claimed 0: claimed bearings are left out. */
struct rho_passive_match rho_passive_match_nearest(const struct rho_passive_search *search,
                                                   unsigned scan, unsigned sensor,
                                                   const float state_m[RHO_PASSIVE_STATES],
                                                   int include_claimed);

/* The claimed bearing (from 1) at any distance; bearing -1 for claim 0. */
struct rho_passive_match rho_passive_match_claimed(const struct rho_passive_search *search,
                                                   unsigned scan, unsigned sensor,
                                                   const float state_m[RHO_PASSIVE_STATES],
                                                   unsigned claim);

/* Measured minus predicted bearing, in sigmas. */
float rho_passive_normalised_residual(const struct rho_passive_match *match);

/* Marks the directions that have a bearing nearby; all functions below need it. */
void rho_passive_mark_directions(struct rho_passive_search *search);

/*
 * Sum over all looks of 1 - (residual / 9 sigmas)^2 of the nearest bearing, 0 beyond nine sigmas.
 * Stops and returns a value of at most `least` as soon as the sum cannot exceed it.
 */
float rho_passive_agreement(const struct rho_passive_search *search,
                            const float state_m[RHO_PASSIVE_STATES], float least);

/* A row of claims: for each sensor of a scan the bearing's index from 1; 0: none. */
typedef uint8_t rho_passive_claim[RHO_MAX_PASSIVE_SENSORS];
typedef const uint8_t rho_passive_const_claim[RHO_MAX_PASSIVE_SENSORS];

/* ---- fit and score of a state ---- */

/* Four Gauss-Newton steps to the nearest bearings, within 8, 5, 3.5 and 3.5 sigmas. */
void rho_passive_fit_nearest(const struct rho_passive_search *search,
                             float state_m[RHO_PASSIVE_STATES], int include_claimed);

/* One Gauss-Newton step to the claimed bearings. */
void rho_passive_fit_claimed(const struct rho_passive_search *search,
                             float state_m[RHO_PASSIVE_STATES], rho_passive_const_claim *claim);

struct rho_passive_score {
    float score_nat, chi2;
    uint16_t hits;
    uint16_t looks_out_of_view; /* looks of sensors whose sector did not contain the position */
    int is_track;               /* hits, chi2, speed and score are within a track's limits */
};

/* Claims the nearest bearings within 3.5 sigmas, and scores the state with them. */
struct rho_passive_score rho_passive_score_nearest(const struct rho_passive_search *search,
                                                   const float state_m[RHO_PASSIVE_STATES],
                                                   int include_claimed, rho_passive_claim *claim);

/* The score with given claims. */
struct rho_passive_score rho_passive_score_claimed(const struct rho_passive_search *search,
                                                   const float state_m[RHO_PASSIVE_STATES],
                                                   rho_passive_const_claim *claim);

/* Score of a look with the bearing `claim` (from 1) minus that of a miss; 0 beyond 3.5 sigmas. */
float rho_passive_score_gain(const struct rho_passive_search *search,
                             const float state_m[RHO_PASSIVE_STATES], unsigned scan,
                             unsigned sensor, unsigned claim);

/*
 * Position and velocity at the newest scan, with their covariance, from a track's claims. 0: the
 * normal equations are singular.
 */
int rho_passive_estimate_track(const struct rho_passive_search *search,
                               const float state_m[RHO_PASSIVE_STATES],
                               struct rho_passive_track *track);

/* ---- candidates ---- */

/* Indices of the candidates, best score first. */
void rho_passive_rank_candidates(const struct rho_passive *passive,
                                 uint8_t order[RHO_MAX_PASSIVE_CANDIDATES]);

/*
 * A fitted state becomes a candidate, unless it is no track or has a better duplicate. Returns
 * whether it is a track.
 */
int rho_passive_offer_candidate(struct rho_passive_search *search,
                                const float state_m[RHO_PASSIVE_STATES]);

/* Number of bearings that both claim. */
unsigned rho_passive_count_shared(const struct rho_passive_search *search,
                                  const struct rho_passive_candidate *a,
                                  const struct rho_passive_candidate *b);

/* Candidates from pairs of candidates that have swapped their bearings. */
void rho_passive_swap_bearings(struct rho_passive_search *search);

/* ---- the choice of candidates ---- */

struct rho_passive_choice {
    const struct rho_passive_search *search;
    unsigned count; /* of candidates */
    uint8_t is_in[RHO_MAX_PASSIVE_CANDIDATES];
    uint8_t is_out[RHO_MAX_PASSIVE_CANDIDATES]; /* excluded: may not be added */
    /* score of each less the penalties for the bearings it shares with the chosen ones */
    float gain_nat[RHO_MAX_PASSIVE_CANDIDATES];
    float total_nat;
};

/* The choice with the highest total that the starts find. */
void rho_passive_choose_candidates(const struct rho_passive_search *search,
                                   struct rho_passive_choice *best);

/* Excludes a candidate and all other candidates of the same target. */
void rho_passive_exclude_target(struct rho_passive_choice *choice, unsigned which);

/* Adds a candidate (count: none), then further ones while the total grows. */
void rho_passive_include_candidate(struct rho_passive_choice *choice, unsigned which);

/* Leaves one out and adds others instead, as long as the total grows. */
void rho_passive_improve_choice(struct rho_passive_choice *choice);

/* ---- tracks fitted together ---- */

/* Sets or clears is_claimed of the claimed bearings. */
void rho_passive_mark_claims(struct rho_passive *passive, rho_passive_const_claim *claims,
                             uint8_t is_claimed);

/*
 * The chosen candidates as a set: bearings are assigned anew, one to one, and each track is fitted
 * to its own bearings. Members that are no tracks then are dropped.
 */
void rho_passive_fit_jointly(const struct rho_passive_search *search,
                             const struct rho_passive_choice *choice, struct rho_passive_set *set);

/*
 * The total of passive->best minus that of the best set without each of its tracks. A set with
 * a higher total becomes passive->best.
 */
void rho_passive_find_margins(const struct rho_passive_search *search,
                              struct rho_passive_choice *choice,
                              float margins_nat[RHO_MAX_PASSIVE_TRACKS]);

/* ---- phases 4 and 5: selection ---- */

/* Claims the bearings of the best set of candidates. */
void rho_passive_claim_best_set(struct rho_passive_search *search);

/* The best set of candidates becomes passive->tracks. */
void rho_passive_select_tracks(struct rho_passive_search *search);

#endif
