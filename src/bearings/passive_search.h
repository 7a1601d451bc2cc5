/* SPDX-License-Identifier: MIT */
/*
 * passive_search: state of one search of the passive initiator, and the functions that its phases
 * share. A file may call files above it in this list, never files below it:
 *
 * - bearing_match.c: the bearings that match a state
 * - passive_fit.c: Gauss-Newton fit, score and covariance of a state
 * - candidate_list.c: the list of candidates for tracks
 * - best_subset.c: the subset of candidates with the highest total score
 * - joint_fit.c: one-to-one assignment of bearings to the chosen tracks, and their fits
 * - passive_prepare.c: geometry, times, likelihood ratios
 * - known_tracks.c: the tracks that are followed already, as candidates
 * - passive_crossings.c: phase 1: crossings of all pairs of sensors
 * - starts.c: phase 2: constant velocities through pairs of crossings
 * - final_tracks.c: phases 3 and 4: the best set of candidates, the tracks with their margins
 * - passive.c: configuration, frames, the sequence of phases of a search
 */
#ifndef RHOTRACK_PASSIVE_SEARCH_H
#define RHOTRACK_PASSIVE_SEARCH_H

#include "rhotrack/detail/approx.h"
#include "rhotrack/passive.h"

/*
 * A state is the position at mid-batch (x, y) and the displacement in half the batch (dx, dy), all
 * in metres, from the looks' centroid: the position at a look is (x, y) + step (dx, dy). The height
 * and its displacement come last: a search without elevations leaves them alone.
 */
enum {
    RHO_PASSIVE_X,
    RHO_PASSIVE_Y,
    RHO_PASSIVE_DX,
    RHO_PASSIVE_DY,
    RHO_PASSIVE_Z,
    RHO_PASSIVE_DZ,
    RHO_PASSIVE_STATES
};

/* Time of a look, from -1 for the first row's to 1 for the newest look's, and its place. */
struct rho_passive_look {
    float step, x_m, y_m, z_m;
};

/* Values computed once for a search. Positions are relative to the looks' centroid. */
struct rho_passive_search {
    struct rho_passive *passive;
    struct rho_passive_known *known; /* the tracks that are challenged, and safe ones */
    uint32_t num_known;
    float middle_x_m, middle_y_m; /* centroid of the places of all looks */
    float half_s;                 /* half the time from the first row to the newest look */
    struct rho_passive_look at[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
    float hit_nat; /* score of a bearing with a density of 1 per radian */
    /* score of a look in which the track's position was in view but got no bearing */
    float miss_nat;
    float share_nat;     /* penalty of a choice for each bearing that two chosen candidates claim */
    float sigma_min_rad; /* floor of the bearings' sigmas */
    float mean_log_sigma;
    unsigned looks; /* number of reports: pairs of scan and sensor */
    int has_slopes; /* 1: some bearings have an elevation, and states a height */
    /* second pass: claimed bearings are left out, and crossings need no third sensor */
    int is_second;
    uint32_t work_end;             /* the work spent at which a phase ends */
    uint32_t work_share;           /* units that each phase of a pass may spend */
    uint32_t row_begin, row_limit; /* of a row's crossings in passive->points, and of its room */
};

/* Lets what follows spend so many units. */
static inline void rho_passive_allow(struct rho_passive_search *search, uint32_t units)
{
    search->work_end = rho_count(search->passive->work.spent, units);
}

static inline int rho_passive_has_work(const struct rho_passive_search *search)
{
    return search->passive->config.work_max == 0 || search->passive->work.spent < search->work_end;
}

static inline void rho_passive_spend(const struct rho_passive_search *search, uint32_t units)
{
    struct rho_passive_work *work = &search->passive->work;
    work->spent = rho_count(work->spent, units);
}

/* Elements of a state that the bearings of the search tell. */
static inline int rho_passive_num_states(const struct rho_passive_search *search)
{
    return search->has_slopes ? RHO_PASSIVE_STATES : RHO_PASSIVE_Z;
}

/* Computes the values of *search that follow from the batch: geometry, times, likelihood ratios. */
void rho_passive_prepare(struct rho_passive_search *search);
/* Sets the scores of bearings, and of the candidates, by the density of unclaimed bearings. */
void rho_passive_set_density(struct rho_passive_search *search);
/* Sets passive->start_mnat, for the allowed rate of false tracks. */
void rho_passive_set_start_score(const struct rho_passive_search *search);
/* Values of is_claimed: a bearing of a safe track is BLOCKED, and none matches it. */
enum { RHO_PASSIVE_FREE, RHO_PASSIVE_CLAIMED, RHO_PASSIVE_BLOCKED };
/* Blocks the bearings of owners, except known tracks that are not safe, and frees all others. */
void rho_passive_block_bearings(struct rho_passive_search *search);
/* Lists the known tracks as candidates; of safe ones it blocks the bearings on their way. */
void rho_passive_list_known(struct rho_passive_search *search);
/* Crosses the bearings of all pairs of sensors, scan by scan, into passive->points. */
void rho_passive_find_crossings(struct rho_passive_search *search);
/* Time of a crossing: the middle of its looks. */
static inline float rho_passive_crossing_step(const struct rho_passive_search *search,
                                              const struct rho_passive_point *point)
{
    const struct rho_passive_look *at = search->at[point->scan];
    return 0.5f * (at[point->sensors / 8u].step + at[point->sensors % 8u].step);
}

/* The bearing that a crossing claims of a sensor. */
static inline const struct rho_batch_bearing *
rho_passive_bearing_of(const struct rho_passive_search *search,
                       const struct rho_passive_point *point, unsigned sensor)
{
    return &search->passive->batch.bearings[point->scan][sensor][point->claim[sensor] - 1u];
}

/* Uncertainty of a crossing: the trace of its covariance. */
static inline float rho_passive_uncertainty_m2(const struct rho_passive_point *point)
{
    return point->xx_m2 + point->yy_m2;
}

/*
 * The constant-velocity state through two crossings, a the older. Returns 0 where it is too fast.
 */
int rho_passive_connect_crossings(const struct rho_passive_search *search,
                                  const struct rho_passive_point *a,
                                  const struct rho_passive_point *b,
                                  float state_m[RHO_PASSIVE_STATES]);
/* Fits the pairs of crossings that agree best with the bearings, and offers the candidates. */
void rho_passive_fit_pairs(struct rho_passive_search *search);
/* Vector from a sensor to the position of a state at the time of its look. */
struct rho_passive_offset {
    float x_m, y_m, z_m;
};
static inline struct rho_passive_offset
rho_passive_offset_from_sensor(const struct rho_passive_search *search, unsigned scan,
                               unsigned sensor, const float state_m[RHO_PASSIVE_STATES])
{
    const struct rho_passive_look *look = &search->at[scan][sensor];
    return (struct rho_passive_offset){
        .x_m = state_m[RHO_PASSIVE_X] + look->step * state_m[RHO_PASSIVE_DX] - look->x_m,
        .y_m = state_m[RHO_PASSIVE_Y] + look->step * state_m[RHO_PASSIVE_DY] - look->y_m,
        .z_m = state_m[RHO_PASSIVE_Z] + look->step * state_m[RHO_PASSIVE_DZ] - look->z_m};
}
static inline float rho_passive_squared_range_m2(struct rho_passive_offset offset)
{
    return rho_square(offset.x_m) + rho_square(offset.y_m);
}
/* A bearing of a look compared with the position of a state. */
struct rho_passive_match {
    /* index among the bearings of the look, from 0; -1: no bearing within six sigmas */
    int bearing;
    struct rho_passive_offset offset;
    float cross_range_m; /* distance of the state's position from the ray of the bearing, signed */
    float sigma_rad;
    float above_m;     /* height that the slope tells at the state's range, above the state's */
    float sigma_slope; /* 0: without a slope */
};

/* Which bearings may match a state. */
enum rho_passive_matching {
    RHO_PASSIVE_UNCLAIMED = 0,
    RHO_PASSIVE_ALSO_CLAIMED = 1,
    RHO_PASSIVE_BY_SLOPE = 2 /* to be or-ed: the nearest by bearing and slope, else by bearing */
};
/* Matches a state with the nearest bearing of a look. */
struct rho_passive_match rho_passive_match_nearest(const struct rho_passive_search *search,
                                                   unsigned scan, unsigned sensor,
                                                   const float state_m[RHO_PASSIVE_STATES],
                                                   int matching);
/* Matches a state with bearing `claim` (from 1) of a look at any distance; claim 0: none, -1. */
struct rho_passive_match rho_passive_match_claimed(const struct rho_passive_search *search,
                                                   unsigned scan, unsigned sensor,
                                                   const float state_m[RHO_PASSIVE_STATES],
                                                   unsigned claim);
/*
 * Lists, for each direction of each look, the bearings within six sigmas of it. Needed before
 * states are matched with nearest bearings.
 */
void rho_passive_mark_directions(struct rho_passive_search *search);
/*
 * Agreement of a state with the bearings: sum over all looks of 1 - (residual / 6 sigmas)^2 of the
 * nearest bearing, or 0 beyond six sigmas. Stops early, with a value of at most `least`, once the
 * sum cannot exceed `least`.
 */
float rho_passive_agreement(const struct rho_passive_search *search,
                            const float state_m[RHO_PASSIVE_STATES], float least);
/*
 * Fits a state to the nearest unclaimed bearings: four Gauss-Newton steps, in gates of 8 to 3.5
 * sigmas. has_height 0: the first step finds its height, by bearings alone.
 */
void rho_passive_fit_nearest(const struct rho_passive_search *search, int has_height,
                             float state_m[RHO_PASSIVE_STATES]);
/*
 * Improves a track's state by one Gauss-Newton step of limited size towards the bearings that it
 * claims. Returns 0 where the normal equations are singular, and the state stays.
 */
int rho_passive_step_to_claims(const struct rho_passive_search *search,
                               struct rho_passive_candidate *track);

/* Claims for a track's state the nearest bearing of each look within 3.5 sigmas. */
void rho_passive_claim_nearest(const struct rho_passive_search *search, int matching,
                               struct rho_passive_candidate *track);
/* Normal equations a x = b of a fit; a, a lower triangle, is the inverse of its covariance. */
struct rho_passive_equations {
    float a[21], b[RHO_PASSIVE_STATES];
    int num_slopes;
};
/* Those of the bearings that a candidate claims. */
struct rho_passive_equations rho_passive_equate_claims(const struct rho_passive_search *search,
                                                       const struct rho_passive_candidate *track);
/* Squared distance of two states in sigmas. */
float rho_passive_distance2(const struct rho_passive_search *search,
                            const struct rho_passive_equations *equations,
                            const float a_m[RHO_PASSIVE_STATES],
                            const float b_m[RHO_PASSIVE_STATES]);
/* Whether the state's position was within the sensor's sector in the scan. */
int rho_passive_is_in_view(const struct rho_passive_search *search, unsigned scan, unsigned sensor,
                           const float state_m[RHO_PASSIVE_STATES]);
/*
 * Sets a track's score (log-likelihood ratio) and hits, and *chi2, by its claims. Returns whether
 * hits, chi-square, speed, observability and score satisfy the conditions of a track.
 */
int rho_passive_score_claimed(const struct rho_passive_search *search,
                              struct rho_passive_candidate *track, float *chi2);
/*
 * ln of the share of places and speeds, as targets have them before a bearing is seen, that the
 * claimed bearings leave (Laplace's approximation; src/DESIGN.md): with it the likelihood ratio at
 * the fitted state becomes that of a target anywhere.
 */
float rho_passive_prior_nat(const struct rho_passive_search *search,
                            const struct rho_passive_candidate *track);
/* Score of a look with bearing `claim` (from 1) minus that of a miss; 0 beyond 3.5 sigmas. */
float rho_passive_gain_nat(const struct rho_passive_search *search,
                           const float state_m[RHO_PASSIVE_STATES], unsigned scan, unsigned sensor,
                           unsigned claim);
/*
 * Fills the position and velocity at the newest scan of a track, and their covariance, from its
 * state and claims. Returns 0 where the normal equations are singular.
 */
int rho_passive_estimate_track(const struct rho_passive_search *search,
                               const struct rho_passive_candidate *from,
                               struct rho_passive_track *track);
/* Sorts the indices of the candidates by score, best first, into order[]. */
void rho_passive_rank_candidates(const struct rho_passive *passive,
                                 uint8_t order[RHO_MAX_PASSIVE_CANDIDATES]);
/*
 * Scores a fitted state, and adds it to the candidates if it passes the tests of a track and has no
 * better duplicate.
 */
void rho_passive_offer_if_track(struct rho_passive_search *search,
                                const float state_m[RHO_PASSIVE_STATES]);
/* Number of bearings that two candidates both claim. */
unsigned rho_passive_count_shared(const struct rho_passive_search *search,
                                  const struct rho_passive_candidate *a,
                                  const struct rho_passive_candidate *b);
struct rho_passive_choice {
    const struct rho_passive_search *search;
    unsigned count; /* number of candidates */
    uint8_t is_in[RHO_MAX_PASSIVE_CANDIDATES];
    uint8_t is_out[RHO_MAX_PASSIVE_CANDIDATES]; /* excluded: must not be added to the choice */
    /* score of each candidate less the penalties for bearings shared with chosen ones */
    float gain_nat[RHO_MAX_PASSIVE_CANDIDATES];
    float total_nat;
};

/* Finds the choice of candidates with the highest total, by greedy search from several starts. */
void rho_passive_choose(const struct rho_passive_search *search, struct rho_passive_choice *best);
/* Excludes from a choice a candidate and all others that are of its target, or where it is. */
void rho_passive_exclude_target(struct rho_passive_choice *choice, unsigned which);
/* Adds a candidate (which = count: none), then further candidates while the total grows. */
void rho_passive_add_gaining(struct rho_passive_choice *choice, unsigned which);
/* Replaces candidates of a choice, one at a time, by others, as long as the total grows. */
void rho_passive_improve_choice(struct rho_passive_choice *choice);
/* Sets is_claimed of all bearings that a track claims. */
void rho_passive_mark_claims(struct rho_passive *passive, const struct rho_passive_candidate *track,
                             uint8_t is_claimed);
/*
 * Fits the chosen candidates as a set of tracks: bearings are assigned anew, one to one, each track
 * is fitted to its own bearings, and members that fail the tests of a track are dropped.
 */
void rho_passive_fit_jointly(const struct rho_passive_search *search,
                             const struct rho_passive_choice *choice, struct rho_passive_set *set);
/* Marks the bearings of the best set of candidates as claimed, for the second pass. */
void rho_passive_claim_best_set(struct rho_passive_search *search);
/* Turns the best set of candidates into the tracks of the search, with margins, by score. */
void rho_passive_select_tracks(struct rho_passive_search *search);

#endif
