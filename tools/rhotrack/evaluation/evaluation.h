/* SPDX-License-Identifier: MIT */
/*
 * evaluation: compares tracks with the true targets, time by time; reads and writes no files.
 *
 * At every time the tracks are paired with the targets anew, by the pairing of least total cost
 * (gospa.h). All figures come from these pairs. A figure that is not known (no pair, no velocity,
 * no covariance) is NAN. Quantiles interpolate between neighbouring values; they are exact, as all
 * errors are kept. Memory: some 150 bytes an identity, 130 a time and 48 a pair; growing arrays may
 * hold twice that.
 */
#ifndef RHOTRACK_TOOL_EVALUATION_H
#define RHOTRACK_TOOL_EVALUATION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * A target or a track at one time. Where truth or tracks lack heights or vertical velocities, the
 * caller sets those of both to 0, so that they are not compared.
 */
struct evaluation_point {
    int32_t id;
    double x_m, y_m, z_m;
    double vx_mps, vy_mps, vz_mps; /* velocity; NAN where not known */
    /* covariances of a track's position and of its velocity in x and y; 0 or NAN where not known */
    double cov_xx_m2, cov_yx_m2, cov_yy_m2;
    double cov_vxx_m2ps2, cov_vyx_m2ps2, cov_vyy_m2ps2;
    bool is_coasting; /* of a track: the last scan had no plot for it */
};

/*
 * Motion of a pair of target and track; errors are averaged for each motion separately. A coasting
 * track counts as COASTING alone. Otherwise the target is TURNING (or speeding up) if its velocity
 * changed since its previous time by more than the turning limit times the interval, else STRAIGHT.
 */
enum evaluation_motion {
    EVALUATION_STRAIGHT,
    EVALUATION_TURNING,
    EVALUATION_COASTING,
    EVALUATION_MOTIONS,
    EVALUATION_NO_MOTION =
        EVALUATION_MOTIONS /* motion not known: at a target's first time, or without velocities */
};

/* default acceleration from which a target counts as turning */
#define EVALUATION_TURNING_MPS2 0.02

struct evaluation_errors {
    size_t pairs;
    /* errors of position: root mean square, median, 95 % quantile */
    double rmse_m, median_m, p95_m;
    /* errors of velocity, over the pairs in which both velocities are known */
    double rmse_mps, median_mps, p95_mps;
    /*
     * nees: mean of e^T P^-1 e of the position error in x and y, over the pairs with a covariance;
     * 2 where covariances are right. nees_inside: share of targets inside the 95 % ellipse; 0.95
     * where they are right. velocity_ratio: mean NEES of the velocity error divided by 2; above 1
     * the velocity covariance is too small. velocity_inside: as nees_inside, of the velocity.
     */
    double nees, nees_inside;
    double velocity_ratio, velocity_inside;
};

struct evaluation_result {
    size_t scans; /* number of evaluated times */
    int64_t first_us, last_us;
    size_t targets, targets_found, tracks;
    size_t false_tracks; /* tracks unpaired in more than half of their rows */
    /* GOSPA and its localisation part: root mean square over the times */
    double gospa_m, gospa_localisation_m;
    /* unpaired targets and unpaired tracks: mean number a time */
    double gospa_missed, gospa_false;
    double ospa_m; /* OSPA: mean over the times */
    /* share of all (target, time) points that are paired with a track */
    double completeness;
    /* completeness without the points before a target's first pairing */
    double completeness_once_found;
    double false_per_scan; /* equal to gospa_false */
    /* false_tracks divided by the hours from first to last time */
    double false_per_hour;
    /* times at which a target got another track than its previous one */
    size_t switches;
    /* times at which a target was paired again after a gap without a track */
    size_t fragments;
    /* from a target's first time to its first track: mean over the targets found */
    double delay_scans, delay_s;
    struct evaluation_errors errors;
    struct evaluation_errors by_motion[EVALUATION_MOTIONS];
};

/* Results of one target, over the times at which it exists in the truth. */
struct evaluation_target {
    int32_t id;
    int64_t first_us, last_us;
    int64_t found_us, kept_until_us; /* first and last time with a track; valid where paired > 0 */
    /* number of times at which the target exists, and at which it has a track */
    size_t scans, paired;
    size_t delay_scans; /* number of the target's times before found_us */
    size_t switches, fragments;
    struct evaluation_errors errors;
};

struct evaluation_scan {
    int64_t time_us;
    size_t targets, tracks, pairs;
    size_t switches, fragments; /* switches and fragments (see evaluation_result) at this time */
    double gospa_m, ospa_m;
    double localisation_m2, missed_m2, false_m2; /* the three parts of gospa_m squared */
    double rmse_m, rmse_mps, nees, velocity_ratio;
};

struct evaluation;

struct evaluation *evaluation_start(double cutoff_m);

/* Sets the acceleration above which a target counts as turning, from the next time added on. */
void evaluation_set_turning_limit(struct evaluation *e, double turning_mps2);

/*
 * Adds the targets and tracks of one time, which must be later than the times added before. An id
 * may appear once in each list; either list may be empty.
 */
void evaluation_add_time(struct evaluation *e, int64_t time_us,
                         const struct evaluation_point *targets, size_t num_targets,
                         const struct evaluation_point *tracks, size_t num_tracks);

/* Figures over all times added so far; more times may be added afterwards. */
struct evaluation_result evaluation_result(const struct evaluation *e);

/* Results of every target, in the order of ids; the caller frees the array. */
struct evaluation_target *evaluation_results_by_target(const struct evaluation *e, size_t *count);

/* Results of every time, in ascending order; valid until the next call of evaluation_add_time. */
const struct evaluation_scan *evaluation_results_over_time(const struct evaluation *e,
                                                           size_t *count);

void evaluation_free(struct evaluation *e);

#endif
