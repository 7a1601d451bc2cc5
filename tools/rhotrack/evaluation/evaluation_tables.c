/* SPDX-License-Identifier: MIT */
#include "evaluation/evaluation_tables.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/identity_map.h"
#include "evaluation/alignment.h"
#include "io/rows/trajectory_row.h"
#include "rhotrack/message.h"

struct timed_point {
    int64_t time_us;
    size_t row; /* row in the table that it was read from */
    struct evaluation_point point;
};

struct points {
    const struct table *table;
    struct timed_point *list; /* sorted by time, then by row of the file */
    size_t count;
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

/* Reads the confirmed and coasting rows of a truth or tracks table, sorted by time. */
static struct points read_confirmed_points(const struct table *table,
                                           const struct parameters *parameters)
{
    struct trajectory_columns columns = trajectory_columns_find(table, parameters);
    struct points points = {.table = table,
                            .list = must_calloc(table->num_rows, sizeof *points.list),
                            .has_z = columns.has_z,
                            .has_vz = columns.in_file.at[COL_VZ_MPS] >= 0};
    for (size_t row = 0; row < table->num_rows; row++) {
        const struct trajectory_row path = trajectory_row_read(&columns, row);
        if (path.status == RHO_MESSAGE_TRACK_CONFIRMED ||
            path.status == RHO_MESSAGE_TRACK_COASTING) {
            points.list[points.count++] = (struct timed_point){
                .time_us = path.time_us, .row = row, .point = point_from_row(&path)};
        }
    }
    trajectory_columns_free(&columns);
    qsort(points.list, points.count, sizeof points.list[0], compare_points_by_time_and_row);
    return points;
}

/*
 * Sets heights (vertical velocities) to 0 unless compares_z (compares_vz): they are compared only
 * where both truth and tracks have them.
 */
static void zero_uncompared_heights(struct points *points, bool compares_z, bool compares_vz)
{
    for (size_t i = 0; i < points->count; i++) {
        struct evaluation_point *point = &points->list[i].point;
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

static struct alignment_times view_of_point_times(const struct points *points)
{
    return (struct alignment_times){
        .first_us = &points->list->time_us, .stride = sizeof *points->list, .count = points->count};
}

/*
 * Replaces the tracks' points by their points at the truth's times (see
 * alignment.h). Exits with an error where a track time is further than most_us from
 * every truth time.
 */
static void extrapolate_tracks(struct points *tracks, const struct points *truth, int64_t most_us)
{
    struct alignment_times track_times = view_of_point_times(tracks),
                           truth_times = view_of_point_times(truth);
    size_t unmatched = alignment_find_unmatched(track_times, truth_times, most_us);
    if (unmatched < tracks->count) {
        alignment_fail_unmatched(tracks->table, tracks->list[unmatched].row, most_us);
    }
    struct alignment alignment = alignment_list_rows(track_times, truth_times, most_us);
    struct points aligned = *tracks;
    aligned.list = must_calloc(alignment.count + 1, sizeof *aligned.list);
    aligned.count = alignment.count;
    for (size_t i = 0; i < alignment.count; i++) {
        aligned.list[i] =
            extrapolated_to_time(&tracks->list[alignment.list[i].row], alignment.list[i].to_us);
    }
    free(alignment.list);
    free(tracks->list);
    *tracks = aligned;
}

/* Index one past the last point from `from` on whose time is at most time_us plus 1 ms. */
static size_t index_past_points_up_to_time(const struct points *points, size_t first,
                                           int64_t time_us)
{
    while (first < points->count && points->list[first].time_us <= time_us + ALIGNMENT_LEAST_US) {
        first++;
    }
    return first;
}

/*
 * Exits with an error if the track point at index `at` is earlier than time_us: the truth has no
 * such time.
 */
static void check_truth_has_time(const struct points *tracks, size_t index, int64_t time_us)
{
    if (index < tracks->count && tracks->list[index].time_us < time_us - ALIGNMENT_LEAST_US) {
        alignment_fail_unmatched(tracks->table, tracks->list[index].row, ALIGNMENT_LEAST_US);
    }
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
static size_t keep_last_point_of_each_id(struct last_times *last, const struct points *points,
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

static void evaluate_all_times(struct evaluation *e, const struct points *truth,
                               const struct points *tracks)
{
    struct evaluation_point *targets_now = must_calloc(truth->count, sizeof *targets_now);
    struct evaluation_point *tracks_now = must_calloc(tracks->count, sizeof *tracks_now);
    struct last_times last_target = {0}, last_track = {0};
    size_t target = 0, track = 0;
    while (target < truth->count) {
        int64_t time_us = truth->list[target].time_us;
        check_truth_has_time(tracks, track, time_us);
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
    check_truth_has_time(tracks, track, INT64_MAX);
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
    struct points truth = read_confirmed_points(truth_table, parameters);
    struct points tracks = read_confirmed_points(tracks_table, parameters);
    zero_uncompared_heights(&truth, truth.has_z && tracks.has_z, truth.has_vz && tracks.has_vz);
    zero_uncompared_heights(&tracks, truth.has_z && tracks.has_z, truth.has_vz && tracks.has_vz);
    int64_t tolerance_us = alignment_tolerance_us(parameters);
    if (tolerance_us > ALIGNMENT_LEAST_US) {
        extrapolate_tracks(&tracks, &truth, tolerance_us);
    }
    evaluate_all_times(e, &truth, &tracks);
    free(truth.list);
    free(tracks.list);
    return e;
}
