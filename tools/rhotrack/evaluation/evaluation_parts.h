/* SPDX-License-Identifier: MIT */
/* Private to evaluation: what is kept of each identity and each pair. */
#ifndef RHOTRACK_TOOL_EVALUATION_PARTS_H
#define RHOTRACK_TOOL_EVALUATION_PARTS_H

#include <stdbool.h>

#include "base/identity_numbers.h"
#include "evaluation/evaluation.h"

#define NO_TRACK SIZE_MAX
#define EVALUATION_AXES 2.0 /* of covariances: the mean of e^T P^-1 e where they are right */

/* A target through its life. */
struct target_life {
    int64_t first_us, last_us, found_us, kept_until_us;
    size_t scans, paired, delay_scans, switches, fragments;
    size_t track;    /* number of the track that it had last, or NO_TRACK */
    bool is_tracked; /* at its last time */
    enum evaluation_motion motion;
    double velocity_mps[3]; /* at its last time */
};

struct track_life {
    size_t scans, paired;
};

struct pair_error {
    size_t target; /* its number */
    enum evaluation_motion motion;
    double error_m, error_mps, nees, velocity_nees; /* NAN where not known */
};

struct evaluation {
    double cutoff_m, turning_mps2;
    struct identity_numbers target_ids, track_ids;
    struct target_life *targets; /* by number, as are tracks */
    struct track_life *tracks;
    size_t targets_capacity, tracks_capacity;
    struct evaluation_scan *scans;
    size_t num_scans, scans_capacity;
    struct pair_error *pairs; /* in the order of time */
    size_t num_pairs, pairs_capacity;
};

/* NAN where there is none. */
double evaluation_mean(double sum, size_t count);

#endif
