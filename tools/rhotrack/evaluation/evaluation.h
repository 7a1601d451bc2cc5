/* SPDX-License-Identifier: MIT */
/*
 * evaluation: tracks against truth, time by time; knows no files.
 *
 * At every time the tracks are paired with the targets anew, best in all (gospa.h). All figures
 * come from these pairs. What is not known (no pair, no velocity, no covariance) is NAN. Quantiles
 * interpolate between neighbours; they are exact, as all errors are kept. Memory: some 150 bytes an
 * identity, 130 a time, 48 a pair, and up to as much again.
 */
#ifndef RHOTRACK_TOOL_EVALUATION_H
#define RHOTRACK_TOOL_EVALUATION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * A target or a track at one time. Heights, and velocities upwards, that are not to count are 0 in
 * both.
 */
struct evaluation_point {
    int32_t id;
    double x_m, y_m, z_m;
    double vx_mps, vy_mps, vz_mps; /* NAN where not known */
    /* of a track: covariances of place and velocity; 0 or NAN where not known */
    double cov_xx_m2, cov_yx_m2, cov_yy_m2;
    double cov_vxx_m2ps2, cov_vyx_m2ps2, cov_vyy_m2ps2;
    bool is_coasting; /* a track that the last scan missed */
};

/*
 * The motion of a pair of target and track; a filter's errors are measured for each motion. A
 * track that coasts counts as that alone; else the target turns (or speeds up) where its velocity
 * changed since the time before by more than the limit a second, and is straight where it did not.
 */
enum evaluation_motion {
    EVALUATION_STRAIGHT,
    EVALUATION_TURNING,
    EVALUATION_COASTING,
    EVALUATION_MOTIONS,
    EVALUATION_NO_MOTION =
        EVALUATION_MOTIONS /* none is known: at a target's first time, or without velocities */
};

#define EVALUATION_TURNING_MPS2 0.02 /* the limit, if no other is set */

struct evaluation_errors {
    size_t pairs;
    double rmse_m, median_m, p95_m;       /* distances; p95: 95 % are less */
    double rmse_mps, median_mps, p95_mps; /* of the pairs with both velocities */
    /*
     * Of the pairs with a covariance, in x and y: mean of e^T P^-1 e, 2 where it is right; share of
     * targets inside the 95 % ellipse, 0.95 where it is right. The same of the velocity, but over
     * those 2: above 1 the covariance is too small.
     */
    double nees, nees_inside;
    double velocity_ratio, velocity_inside;
};

struct evaluation_result {
    size_t scans; /* times */
    int64_t first_us, last_us;
    size_t targets, targets_found, tracks;
    size_t false_tracks;                  /* unpaired in more than half of their rows */
    double gospa_m, gospa_localisation_m; /* root of the mean square over the times */
    double gospa_missed, gospa_false;     /* targets, tracks without a partner, mean a time */
    double ospa_m;                        /* mean over the times */
    double completeness;                  /* share of the (target, time) points that have a track */
    double completeness_once_found;       /* the same, without the points before a target's first */
    double false_per_scan;                /* as gospa_false */
    double false_per_hour;                /* false_tracks over the time from first to last */
    size_t switches;             /* a target's track is another than the one it had before */
    size_t fragments;            /* a target that had a track, and then none, has one again */
    double delay_scans, delay_s; /* from first time to first track, mean over the targets found */
    struct evaluation_errors errors;
    struct evaluation_errors by_motion[EVALUATION_MOTIONS];
};

/* A target, over the times that it was there. */
struct evaluation_target {
    int32_t id;
    int64_t first_us, last_us;
    int64_t found_us, kept_until_us; /* its first and last time with a track; where paired > 0 */
    size_t scans, paired;            /* times that it was there, that it had a track */
    size_t delay_scans;              /* times before found_us */
    size_t switches, fragments;
    struct evaluation_errors errors;
};

struct evaluation_scan {
    int64_t time_us;
    size_t targets, tracks, pairs;
    size_t switches, fragments; /* that happened at this time */
    double gospa_m, ospa_m;
    double localisation_m2, missed_m2, false_m2; /* parts of gospa_m^2 */
    double rmse_m, rmse_mps, nees, velocity_ratio;
};

struct evaluation;

struct evaluation *evaluation_start(double cutoff_m);

/* Sets the least acceleration that counts as a turn, from the next time on. */
void evaluation_set_turning_limit(struct evaluation *e, double turning_mps2);

/* One time, later than those before; no identity twice in a list. Either list may be empty. */
void evaluation_add_time(struct evaluation *e, int64_t time_us,
                         const struct evaluation_point *targets, size_t num_targets,
                         const struct evaluation_point *tracks, size_t num_tracks);

/* All times so far; more may follow. */
struct evaluation_result evaluation_result(const struct evaluation *e);

/* Every target by identity, in new memory of the caller's. */
struct evaluation_target *evaluation_results_by_target(const struct evaluation *e, size_t *count);

/* Every time in order; valid until the next call of evaluation_add_time. */
const struct evaluation_scan *evaluation_results_over_time(const struct evaluation *e,
                                                           size_t *count);

void evaluation_free(struct evaluation *e);

#endif
