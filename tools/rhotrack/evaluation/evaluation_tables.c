/* SPDX-License-Identifier: MIT */
#include "evaluation/evaluation_tables.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/identity_map.h"
#include "evaluation/alignment.h"
#include "evaluation/truth_times.h"
#include "io/rows/trajectory_row.h"
#include "rhotrack/message.h"

struct points {
    const struct table *table;
    struct timed_points at;
    bool has_z, has_vz;
};

static struct evaluation_point point_from_row(const struct trajectory_row *path)
{
    return (struct evaluation_point){
        .id = path->id,
        .x_m = path->x_m,
        .y_m = path->y_m,
        .z_m = path->z_m,
        .vx_mps = path->vx_mps,
        .vy_mps = path->vy_mps,
        .vz_mps = path->vz_mps,
        .cov_xx_m2 = path->covariance[0],
        .cov_yx_m2 = path->covariance[1],
        .cov_yy_m2 = path->covariance[2],
        .cov_vxx_m2ps2 = path->covariance[3],
        .cov_vyx_m2ps2 = path->covariance[4],
        .cov_vyy_m2ps2 = path->covariance[5],
        .is_coasting = path->status == RHO_MESSAGE_TRACK_COASTING,
    };
}

static int compare_points_by_time_and_row(const void *a, const void *b)
{
    const struct timed_point *one = a, *other = b;
    if (one->time_us != other->time_us) {
        return one->time_us < other->time_us ? -1 : 1;
    }
    return one->row < other->row ? -1 : one->row > other->row;
}

/* Reads the rows of a truth or tracks table, sorted by time. */
static struct points read_points(const struct table *table, const struct parameters *parameters)
{
    struct trajectory_columns columns = trajectory_columns_find(table, parameters);
    struct points points = {.table = table,
                            .at.list = must_calloc(table->num_rows, sizeof *points.at.list),
                            .has_z = columns.has_z,
                            .has_vz = columns.in_file.at[COL_VZ_MPS] >= 0};
    for (size_t row = 0; row < table->num_rows; row++) {
        const struct trajectory_row path = trajectory_row_read(&columns, row);
        bool is_shown =
            path.status == RHO_MESSAGE_TRACK_CONFIRMED || path.status == RHO_MESSAGE_TRACK_COASTING;
        points.at.list[points.at.count++] = (struct timed_point){.time_us = path.time_us,
                                                                 .row = row,
                                                                 .is_tentative = !is_shown,
                                                                 .point = point_from_row(&path)};
    }
    trajectory_columns_free(&columns);
    qsort(points.at.list, points.at.count, sizeof points.at.list[0],
          compare_points_by_time_and_row);
    return points;
}

static void leave_out_tentative(struct timed_points *points)
{
    size_t kept = 0;
    for (size_t i = 0; i < points->count; i++) {
        if (!points->list[i].is_tentative) {
            points->list[kept++] = points->list[i];
        }
    }
    points->count = kept;
}

/*
 * Sets heights (vertical velocities) to 0 unless compares_z (compares_vz): they are compared only
 * where both truth and tracks have them.
 */
static void zero_uncompared_heights(struct points *points, bool compares_z, bool compares_vz)
{
    for (size_t i = 0; i < points->at.count; i++) {
        struct evaluation_point *point = &points->at.list[i].point;
        point->z_m = compares_z ? point->z_m : 0.0;
        point->vz_mps = compares_vz ? point->vz_mps : 0.0;
    }
}

/*
 * A track's point extrapolated with its own velocity to a nearby time; without a velocity only the
 * time is changed.
 */
static struct timed_point extrapolated_to_time(const struct timed_point *timed, int64_t to_us)
{
    struct timed_point at = *timed;
    double by_s = (double)(to_us - timed->time_us) * 1e-6;
    at.time_us = to_us;
    if (!isnan(at.point.vx_mps)) {
        at.point.x_m += by_s * at.point.vx_mps;
        at.point.y_m += by_s * at.point.vy_mps;
        at.point.z_m += by_s * at.point.vz_mps;
    }
    return at;
}

static struct alignment_times view_of_point_times(const struct timed_points *points)
{
    return (struct alignment_times){
        .first_us = &points->list->time_us, .stride = sizeof *points->list, .count = points->count};
}

/*
 * Replaces the tracks' points by their points at the truth's times, at most most_us off (see
 * alignment.h).
 */
static void extrapolate_tracks(struct timed_points *tracks, const struct timed_points *truth,
                               int64_t most_us)
{
    struct alignment alignment =
        alignment_list_rows(view_of_point_times(tracks), view_of_point_times(truth), most_us);
    struct timed_points aligned = {.list = must_calloc(alignment.count + 1, sizeof *aligned.list),
                                   .count = alignment.count};
    for (size_t i = 0; i < alignment.count; i++) {
        aligned.list[i] =
            extrapolated_to_time(&tracks->list[alignment.list[i].row], alignment.list[i].to_us);
    }
    free(alignment.list);
    free(tracks->list);
    *tracks = aligned;
}

/*
 * Exits with 2 where no track time is between the truth's first and last times: they count from
 * other instants, or are of other recordings.
 */
static void refuse_other_recording(const struct points *truth, const struct points *tracks,
                                   int64_t tolerance_us)
{
    const struct timed_points *path = &truth->at;
    char first[TIME_TEXT_BYTES], last[TIME_TEXT_BYTES];
    size_t first_shown = 0;
    for (size_t i = tracks->at.count; i-- > 0;) {
        const struct timed_point *track = &tracks->at.list[i];
        if (track->is_tentative) {
            continue;
        }
        if (path->count > 0 && track->time_us >= path->list[0].time_us - tolerance_us &&
            track->time_us <= path->list[path->count - 1].time_us + tolerance_us) {
            return;
        }
        first_shown = i + 1;
    }
    if (first_shown > 0 && path->count == 0) {
        fail(EXIT_USAGE, "%s has tentative rows alone", truth->table->path);
    }
    if (first_shown > 0) {
        table_fail_at_row(tracks->table, tracks->at.list[first_shown - 1].row,
                          "no track's time is within the truth's times, %s to %s s",
                          decimal_seconds_text(path->list[0].time_us, first),
                          decimal_seconds_text(path->list[path->count - 1].time_us, last));
    }
}

/*
 * Leads tracks to the truth's times where the truth has their times, else the truth to the tracks'
 * times; leaves tentative rows out.
 */
static void bring_to_same_times(struct points *truth, struct points *tracks,
                                const struct parameters *parameters)
{
    int64_t tolerance_us = alignment_tolerance_us(parameters);
    int64_t gap_us = llround(parameters->value[PARAMETER_TRUTH_GAP_S] * 1e6);
    leave_out_tentative(&truth->at);
    refuse_other_recording(truth, tracks, tolerance_us);
    if (truth_has_times_of_tracks(&truth->at, &tracks->at, gap_us, tolerance_us)) {
        leave_out_tentative(&tracks->at);
        if (tolerance_us > ALIGNMENT_LEAST_US) {
            extrapolate_tracks(&tracks->at, &truth->at, tolerance_us);
        }
        return;
    }
    struct timed_points at_tracks =
        truth_at_times_of_tracks(&truth->at, &tracks->at, gap_us, tolerance_us);
    free(truth->at.list);
    truth->at = at_tracks;
    leave_out_tentative(&tracks->at);
}

/* Index one past the last point from `from` on whose time is at most time_us plus 1 ms. */
static size_t index_past_points_up_to_time(const struct timed_points *points, size_t first,
                                           int64_t time_us)
{
    while (first < points->count && points->list[first].time_us <= time_us + ALIGNMENT_LEAST_US) {
        first++;
    }
    return first;
}

/* For each id, the number of the evaluated time at which it was last seen, counting from 1. */
struct last_times {
    struct identity_numbers ids;
    size_t *time; /* indexed by the number that ids gives an identity */
    size_t capacity, now;
};

/* Marks the id as seen at the present time; true if it had not been marked at this time before. */
static bool mark_id_if_unseen_now(struct last_times *last, int32_t id)
{
    size_t known = last->ids.count, number = identity_numbers_find_or_add(&last->ids, id);
    if (number == known) {
        last->time = must_make_room_for_one(last->time, known, &last->capacity, sizeof *last->time);
        last->time[number] = 0;
    }
    bool is_first = last->time[number] != last->now;
    last->time[number] = last->now;
    return is_first;
}

/*
 * Copies points begin .. end - 1, all of one time, to list; of several rows with one id (scans of
 * several sensors at one time) only the last is kept. Returns the length of the list.
 */
static size_t keep_last_point_of_each_id(struct last_times *last, const struct timed_points *points,
                                         size_t begin, size_t end, struct evaluation_point *list)
{
    size_t kept = end - begin;
    last->now++;
    for (size_t i = end; i-- > begin;) {
        if (mark_id_if_unseen_now(last, points->list[i].point.id)) {
            list[--kept] = points->list[i].point;
        }
    }
    memmove(list, list + kept, (end - begin - kept) * sizeof *list);
    return end - begin - kept;
}

/* The truth's next time, or the tracks' where it is earlier by more than 1 ms. */
static int64_t next_time_us(const struct timed_points *truth, size_t target,
                            const struct timed_points *tracks, size_t track)
{
    if (target == truth->count) {
        return tracks->list[track].time_us;
    }
    int64_t truth_us = truth->list[target].time_us;
    bool is_track_next =
        track < tracks->count && tracks->list[track].time_us < truth_us - ALIGNMENT_LEAST_US;
    return is_track_next ? tracks->list[track].time_us : truth_us;
}

static void evaluate_all_times(struct evaluation *e, const struct timed_points *truth,
                               const struct timed_points *tracks)
{
    struct evaluation_point *targets_now = must_calloc(truth->count, sizeof *targets_now);
    struct evaluation_point *tracks_now = must_calloc(tracks->count, sizeof *tracks_now);
    struct last_times last_target = {0}, last_track = {0};
    size_t target = 0, track = 0;
    while (target < truth->count || track < tracks->count) {
        int64_t time_us = next_time_us(truth, target, tracks, track);
        size_t target_end = index_past_points_up_to_time(truth, target, time_us);
        size_t track_end = index_past_points_up_to_time(tracks, track, time_us);
        size_t num_targets =
            keep_last_point_of_each_id(&last_target, truth, target, target_end, targets_now);
        size_t num_tracks =
            keep_last_point_of_each_id(&last_track, tracks, track, track_end, tracks_now);
        evaluation_add_time(e, time_us, targets_now, num_targets, tracks_now, num_tracks);
        target = target_end;
        track = track_end;
    }
    identity_numbers_free(&last_target.ids);
    identity_numbers_free(&last_track.ids);
    free(last_target.time);
    free(last_track.time);
    free(targets_now);
    free(tracks_now);
}

struct evaluation *evaluation_of_tables(const struct table *truth_table,
                                        const struct table *tracks_table,
                                        const struct parameters *parameters, double cutoff_m)
{
    struct evaluation *e = evaluation_start(cutoff_m);
    evaluation_set_turning_limit(e, parameters->value[PARAMETER_TURNING_MPS2]);
    struct points truth = read_points(truth_table, parameters);
    struct points tracks = read_points(tracks_table, parameters);
    zero_uncompared_heights(&truth, truth.has_z && tracks.has_z, truth.has_vz && tracks.has_vz);
    zero_uncompared_heights(&tracks, truth.has_z && tracks.has_z, truth.has_vz && tracks.has_vz);
    bring_to_same_times(&truth, &tracks, parameters);
    evaluate_all_times(e, &truth.at, &tracks.at);
    free(truth.at.list);
    free(tracks.at.list);
    return e;
}
