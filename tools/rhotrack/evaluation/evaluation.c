/* SPDX-License-Identifier: MIT */
#include "evaluation/evaluation.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "evaluation/evaluation_state.h"
#include "evaluation/gospa.h"

/* Index of the target with this id in e->targets; a new target starts its life at time_us. */
static size_t find_or_add_target(struct evaluation *e, int32_t id, int64_t time_us)
{
    size_t known = e->target_ids.count;
    size_t number = identity_numbers_find_or_add(&e->target_ids, id);
    if (number == known) {
        e->targets =
            must_make_room_for_one(e->targets, known, &e->targets_capacity, sizeof *e->targets);
        e->targets[number] = (struct target_life){.first_us = time_us,
                                                  .last_us = time_us,
                                                  .track = NO_TRACK,
                                                  .velocity_mps = {NAN, NAN, NAN}};
    }
    return number;
}

/* Index of the track with this id in e->tracks; a new track is added. */
static size_t find_or_add_track(struct evaluation *e, int32_t id)
{
    size_t known = e->track_ids.count;
    size_t number = identity_numbers_find_or_add(&e->track_ids, id);
    if (number == known) {
        e->tracks =
            must_make_room_for_one(e->tracks, known, &e->tracks_capacity, sizeof *e->tracks);
        e->tracks[number] = (struct track_life){0};
    }
    return number;
}

static double norm(double x, double y, double z)
{
    return sqrt(x * x + y * y + z * z);
}

/*
 * NEES e^T P^-1 e of the error e = (ex, ey) with the covariance P = [xx yx; yx yy]; NAN where P is
 * unknown or not positive definite.
 */
static double nees_of_xy_error(double xx, double yx, double yy, double ex, double ey)
{
    double det = xx * yy - yx * yx;
    if (!(xx > 0.0 && det > 0.0)) {
        return NAN;
    }
    return (ex * ex * yy - 2.0 * ex * ey * yx + ey * ey * xx) / det;
}

static struct pair_error error_of_pair(size_t target_index, enum evaluation_motion motion,
                                       const struct evaluation_point *target,
                                       const struct evaluation_point *track)
{
    double ex_m = track->x_m - target->x_m, ey_m = track->y_m - target->y_m;
    double ex_mps = track->vx_mps - target->vx_mps, ey_mps = track->vy_mps - target->vy_mps;
    return (struct pair_error){
        .target = target_index,
        .motion = track->is_coasting ? EVALUATION_COASTING : motion,
        .error_m = norm(ex_m, ey_m, track->z_m - target->z_m),
        .error_mps = norm(ex_mps, ey_mps, track->vz_mps - target->vz_mps),
        .nees = nees_of_xy_error(track->cov_xx_m2, track->cov_yx_m2, track->cov_yy_m2, ex_m, ey_m),
        .velocity_nees = nees_of_xy_error(track->cov_vxx_m2ps2, track->cov_vyx_m2ps2,
                                          track->cov_vyy_m2ps2, ex_mps, ey_mps),
    };
}

/*
 * Classifies the target as straight or turning by the change of its velocity since its previous
 * time, and stores its time and velocity for the next call.
 */
static void classify_target(const struct evaluation *e, struct target_life *life,
                            const struct evaluation_point *target, int64_t time_us)
{
    double *last = life->velocity_mps, passed_s = (double)(time_us - life->last_us) * 1e-6;
    double change_mps =
        norm(target->vx_mps - last[0], target->vy_mps - last[1], target->vz_mps - last[2]);
    life->motion = !isfinite(change_mps)                     ? EVALUATION_NO_MOTION
                   : change_mps > e->turning_mps2 * passed_s ? EVALUATION_TURNING
                                                             : EVALUATION_STRAIGHT;
    life->last_us = time_us;
    last[0] = target->vx_mps;
    last[1] = target->vy_mps;
    last[2] = target->vz_mps;
}

/*
 * Records that the target is paired with the track at the time of scan: its first detection, a
 * switch from another track, a fragment after a gap.
 */
static void record_paired_track(struct target_life *life, size_t track,
                                struct evaluation_scan *scan)
{
    bool is_switch = life->track != NO_TRACK && life->track != track;
    bool is_fragment = life->paired > 0 && !life->is_tracked;

    if (life->paired++ == 0) {
        life->found_us = scan->time_us;
        life->delay_scans = life->scans - 1;
    }
    life->kept_until_us = scan->time_us;
    life->switches += is_switch;
    life->fragments += is_fragment;
    scan->switches += is_switch;
    scan->fragments += is_fragment;
    life->track = track;
}

/*
 * Sums of squared velocity errors and of NEES over the pairs at one time, and how many pairs have a
 * velocity, a covariance and a velocity covariance.
 */
struct time_sums {
    double error2_m2ps2, nees, velocity_nees;
    size_t velocities, covariances, velocity_covariances;
};

/* Keeps the errors of a pair for the overall figures, and adds the known ones to sums. */
static void add_pair_errors(struct evaluation *e, const struct pair_error *error,
                            struct time_sums *sums)
{
    e->pairs = must_make_room_for_one(e->pairs, e->num_pairs, &e->pairs_capacity, sizeof *e->pairs);
    e->pairs[e->num_pairs++] = *error;
    if (isfinite(error->error_mps)) {
        sums->error2_m2ps2 += error->error_mps * error->error_mps;
        sums->velocities++;
    }
    if (isfinite(error->nees)) {
        sums->nees += error->nees;
        sums->covariances++;
    }
    if (isfinite(error->velocity_nees)) {
        sums->velocity_nees += error->velocity_nees;
        sums->velocity_covariances++;
    }
}

static struct gospa_place *gospa_places_of(const struct evaluation_point *points, size_t count)
{
    struct gospa_place *places = must_calloc(count, sizeof *places);
    for (size_t i = 0; i < count; i++) {
        places[i] = (struct gospa_place){points[i].x_m, points[i].y_m, points[i].z_m};
    }
    return places;
}

static struct gospa pair_targets_with_tracks(const struct evaluation *e,
                                             const struct evaluation_point *targets,
                                             size_t num_targets,
                                             const struct evaluation_point *tracks,
                                             size_t num_tracks, int *track_of)
{
    struct gospa_place *target_places = gospa_places_of(targets, num_targets);
    struct gospa_place *track_places = gospa_places_of(tracks, num_tracks);
    struct gospa gospa =
        gospa_compare(target_places, num_targets, track_places, num_tracks, e->cutoff_m, track_of);
    free(target_places);
    free(track_places);
    return gospa;
}

static void record_targets_at_time(struct evaluation *e, const struct evaluation_point *targets,
                                   size_t num_targets, const struct evaluation_point *tracks,
                                   const int *track_of, struct evaluation_scan *scan)
{
    struct time_sums sums = {0};
    for (size_t i = 0; i < num_targets; i++) {
        size_t number = find_or_add_target(e, targets[i].id, scan->time_us);
        struct target_life *life = &e->targets[number];
        life->scans++;
        classify_target(e, life, &targets[i], scan->time_us);
        if (track_of[i] >= 0) {
            const struct evaluation_point *track = &tracks[track_of[i]];
            struct pair_error error = error_of_pair(number, life->motion, &targets[i], track);
            size_t partner = find_or_add_track(e, track->id);
            record_paired_track(life, partner, scan);
            e->tracks[partner].paired++;
            add_pair_errors(e, &error, &sums);
        }
        life->is_tracked = track_of[i] >= 0;
    }
    scan->rmse_mps = sqrt(evaluation_mean_or_nan(sums.error2_m2ps2, sums.velocities));
    scan->nees = evaluation_mean_or_nan(sums.nees, sums.covariances);
    scan->velocity_ratio =
        evaluation_mean_or_nan(sums.velocity_nees, sums.velocity_covariances) / EVALUATION_AXES;
}

void evaluation_add_time(struct evaluation *e, int64_t time_us,
                         const struct evaluation_point *targets, size_t num_targets,
                         const struct evaluation_point *tracks, size_t num_tracks)
{
    int *track_of = must_calloc(num_targets, sizeof *track_of);
    struct gospa gospa =
        pair_targets_with_tracks(e, targets, num_targets, tracks, num_tracks, track_of);
    double half_m2 = 0.5 * e->cutoff_m * e->cutoff_m;
    struct evaluation_scan scan = {
        .time_us = time_us,
        .targets = num_targets,
        .tracks = num_tracks,
        .pairs = gospa.pairs,
        .gospa_m = sqrt(gospa.squared_m2),
        .ospa_m = gospa.ospa_m,
        .localisation_m2 = gospa.localisation_m2,
        .missed_m2 = half_m2 * (double)gospa.missed,
        .false_m2 = half_m2 * (double)gospa.false_tracks,
        .rmse_m = sqrt(evaluation_mean_or_nan(gospa.localisation_m2, gospa.pairs)),
    };
    for (size_t i = 0; i < num_tracks; i++) {
        size_t number = find_or_add_track(e, tracks[i].id);
        e->tracks[number].scans++;
    }
    record_targets_at_time(e, targets, num_targets, tracks, track_of, &scan);
    e->scans = must_make_room_for_one(e->scans, e->num_scans, &e->scans_capacity, sizeof *e->scans);
    e->scans[e->num_scans++] = scan;
    free(track_of);
}

struct evaluation *evaluation_start(double cutoff_m)
{
    struct evaluation *e = must_calloc(1, sizeof *e);
    e->cutoff_m = cutoff_m;
    e->turning_mps2 = EVALUATION_TURNING_MPS2;
    return e;
}

void evaluation_set_turning_limit(struct evaluation *e, double turning_mps2)
{
    e->turning_mps2 = turning_mps2;
}

const struct evaluation_scan *evaluation_results_over_time(const struct evaluation *e,
                                                           size_t *count)
{
    *count = e->num_scans;
    return e->scans;
}

void evaluation_free(struct evaluation *e)
{
    identity_numbers_free(&e->target_ids);
    identity_numbers_free(&e->track_ids);
    free(e->targets);
    free(e->tracks);
    free(e->scans);
    free(e->pairs);
    free(e);
}
