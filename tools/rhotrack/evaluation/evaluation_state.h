/* SPDX-License-Identifier: MIT */
/* Internal state of an evaluation: what it keeps for each target, track and pair. */
#ifndef RHOTRACK_TOOL_EVALUATION_STATE_H
#define RHOTRACK_TOOL_EVALUATION_STATE_H

#include <stdbool.h>

#include "base/identity_map.h"
#include "evaluation/evaluation.h"

#define NO_TRACK SIZE_MAX
/* number of axes, x and y: the mean NEES (e^T P^-1 e) where covariances are right */
#define EVALUATION_AXES 2.0

/* What is accumulated for a target over its times; fields as in evaluation_target. */
struct target_life {
    int64_t first_us, last_us, found_us, kept_until_us;
    size_t scans, paired, delay_scans, switches, fragments;
    size_t track;    /* index of the track last paired with the target, or NO_TRACK */
    bool is_tracked; /* paired with a track at the target's last time */
    enum evaluation_motion motion;
    double velocity_mps[3]; /* true velocity at the target's last time */
};

struct track_life {
    size_t scans, paired;
};

struct pair_error {
    size_t target; /* index of the target in evaluation.targets */
    enum evaluation_motion motion;
    /* errors of position and velocity, and their NEES; NAN where not known */
    double error_m, error_mps, nees, velocity_nees;
};

struct evaluation {
    double cutoff_m, turning_mps2;
    struct identity_numbers target_ids, track_ids;
    /* indexed by the number that target_ids gives; tracks by that of track_ids */
    struct target_life *targets;
    struct track_life *tracks;
    size_t targets_capacity, tracks_capacity;
    struct evaluation_scan *scans;
    size_t num_scans, scans_capacity;
    struct pair_error *pairs; /* errors of all pairs, by time */
    size_t num_pairs, pairs_capacity;
};

/* sum / count; NAN where count is 0. */
double evaluation_mean_or_nan(double sum, size_t count);

#endif
