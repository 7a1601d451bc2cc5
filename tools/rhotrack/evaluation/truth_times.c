/* SPDX-License-Identifier: MIT */
#include "evaluation/truth_times.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "evaluation/alignment.h"

#define FILLED_TIMES_MAX 10000 /* in one stretch without tracks; the interval grows beyond */
#define FEWEST_TRACK_TIMES 3   /* fewer do not say that the truth has more times than scans */

struct time_list {
    int64_t *us; /* ascending; times within ALIGNMENT_LEAST_US are one, the first */
    size_t count, capacity;
};

/* A target's rows by time, of several at one time the last. */
struct truth_path {
    const struct timed_point *rows;
    size_t count;
    int64_t interval_us, gap_us; /* of its rows: median (0 of one row), longest without gap */
};

struct truth_paths {
    struct timed_point *rows; /* of all targets, by identity, then by time */
    struct truth_path *list;
    size_t count;
};

static int by_identity_time_and_row(const void *a, const void *b)
{
    const struct timed_point *one = a, *other = b;

    if (one->point.id != other->point.id) {
        return one->point.id < other->point.id ? -1 : 1;
    }
    if (one->time_us != other->time_us) {
        return one->time_us < other->time_us ? -1 : 1;
    }
    return (one->row > other->row) - (one->row < other->row);
}

static int by_time_and_row(const void *a, const void *b)
{
    const struct timed_point *one = a, *other = b;

    if (one->time_us != other->time_us) {
        return one->time_us < other->time_us ? -1 : 1;
    }
    return (one->row > other->row) - (one->row < other->row);
}

static int by_value(const void *a, const void *b)
{
    const int64_t *one = a, *other = b;

    return (*one > *other) - (*one < *other);
}

/* Copy sorted by identity and time; of rows of one identity at one time the last one stays. */
static struct timed_points sorted_by_identity(const struct timed_points *points)
{
    struct timed_points sorted = {.list = must_calloc(points->count + 1, sizeof *sorted.list)};

    memcpy(sorted.list, points->list, points->count * sizeof *sorted.list);
    qsort(sorted.list, points->count, sizeof *sorted.list, by_identity_time_and_row);
    for (size_t i = 0; i < points->count; i++) {
        const struct timed_point *last = &sorted.list[sorted.count - (sorted.count > 0)];
        bool is_again = sorted.count > 0 && last->point.id == sorted.list[i].point.id &&
                        last->time_us == sorted.list[i].time_us;
        sorted.count += !is_again;
        sorted.list[sorted.count - 1] = sorted.list[i];
    }
    return sorted;
}

/* Index one past the last row of the identity at index `begin`. */
static size_t end_of_identity(const struct timed_points *points, size_t begin)
{
    size_t end = begin;

    while (end < points->count && points->list[end].point.id == points->list[begin].point.id) {
        end++;
    }
    return end;
}

static int64_t median_interval_us(const struct timed_point *rows, size_t count)
{
    int64_t *intervals_us = must_calloc(count, sizeof *intervals_us);

    for (size_t i = 1; i < count; i++) {
        intervals_us[i - 1] = rows[i].time_us - rows[i - 1].time_us;
    }
    qsort(intervals_us, count - 1, sizeof *intervals_us, by_value);
    int64_t median_us = count > 1 ? intervals_us[(count - 2) / 2] : 0;
    free(intervals_us);
    return median_us;
}

static struct truth_paths truth_paths_of(const struct timed_points *truth, int64_t gap_us)
{
    struct timed_points sorted = sorted_by_identity(truth);
    struct truth_paths paths = {.rows = sorted.list};
    size_t capacity = 0;

    for (size_t begin = 0, end; begin < sorted.count; begin = end) {
        end = end_of_identity(&sorted, begin);
        int64_t interval_us = median_interval_us(&sorted.list[begin], end - begin);
        paths.list = must_make_room_for_one(paths.list, paths.count, &capacity, sizeof *paths.list);
        paths.list[paths.count++] = (struct truth_path){
            .rows = &sorted.list[begin],
            .count = end - begin,
            .interval_us = interval_us,
            .gap_us = gap_us > 0 ? gap_us
                      : interval_us < INT64_MAX / TRUTH_GAP_INTERVALS
                          ? TRUTH_GAP_INTERVALS * interval_us
                          : INT64_MAX,
        };
    }
    return paths;
}

static void truth_paths_free(struct truth_paths *paths)
{
    free(paths->rows);
    free(paths->list);
}

/*
 * At the share u of an interval of t_s seconds from a to b; with the velocities va and vb by the
 * cubic that has them, too, without them (NAN) straight.
 */
static double interpolated(double a, double va, double b, double vb, double t_s, double u)
{
    double straight = a + (b - a) * u;
    double bent = u * (1.0 - u) * ((1.0 - u) * (va * t_s - (b - a)) - u * (vb * t_s - (b - a)));

    return isfinite(bent) ? straight + bent : straight;
}

static struct evaluation_point point_between(const struct timed_point *before,
                                             const struct timed_point *after, int64_t time_us)
{
    const struct evaluation_point *a = &before->point, *b = &after->point;
    double t_s = (double)(after->time_us - before->time_us) * 1e-6;
    double u = (double)(time_us - before->time_us) * 1e-6 / t_s;
    struct evaluation_point point = *a;

    point.x_m = interpolated(a->x_m, a->vx_mps, b->x_m, b->vx_mps, t_s, u);
    point.y_m = interpolated(a->y_m, a->vy_mps, b->y_m, b->vy_mps, t_s, u);
    point.z_m = a->z_m + (b->z_m - a->z_m) * u;
    point.vx_mps = a->vx_mps + (b->vx_mps - a->vx_mps) * u;
    point.vy_mps = a->vy_mps + (b->vy_mps - a->vy_mps) * u;
    point.vz_mps = a->vz_mps + (b->vz_mps - a->vz_mps) * u;
    return point;
}

/* Index of the last row at or before the time, or 0. */
static size_t index_of_row_before(const struct truth_path *path, int64_t time_us)
{
    size_t low = 0, high = path->count;

    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (path->rows[middle].time_us <= time_us) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* The row of the path at this time, within the tolerance; NULL where it has none. */
static const struct timed_point *row_near(const struct truth_path *path, int64_t time_us,
                                          int64_t tolerance_us)
{
    size_t at = index_of_row_before(path, time_us);

    if (llabs(path->rows[at].time_us - time_us) <= tolerance_us) {
        return &path->rows[at];
    }
    return at + 1 < path->count && path->rows[at + 1].time_us - time_us <= tolerance_us
               ? &path->rows[at + 1]
               : NULL;
}

/* Fills the target's point at this time; false where it does not exist. */
static bool find_target(const struct truth_path *path, int64_t time_us, int64_t tolerance_us,
                        struct timed_point *target)
{
    size_t at = index_of_row_before(path, time_us);
    const struct timed_point *before = &path->rows[at];

    if (before->time_us < time_us && at + 1 < path->count &&
        before[1].time_us - before->time_us <= path->gap_us) {
        *target = *before;
        target->point = point_between(before, &before[1], time_us);
    } else {
        const struct timed_point *near_by = row_near(path, time_us, tolerance_us);
        if (near_by == NULL) {
            return false;
        }
        *target = *near_by;
    }
    target->time_us = time_us;
    return true;
}

static void add_time(struct time_list *times, int64_t time_us)
{
    if (times->count == 0 || time_us > times->us[times->count - 1] + ALIGNMENT_LEAST_US) {
        times->us =
            must_make_room_for_one(times->us, times->count, &times->capacity, sizeof *times->us);
        times->us[times->count++] = time_us;
    }
}

static struct time_list times_of(const struct timed_points *points, bool with_tentative)
{
    struct time_list times = {0};

    for (size_t i = 0; i < points->count; i++) {
        if (with_tentative || !points->list[i].is_tentative) {
            add_time(&times, points->list[i].time_us);
        }
    }
    return times;
}

/* Index of the first time at or after this one. */
static size_t index_of_time_from(const struct time_list *times, int64_t time_us)
{
    size_t low = 0, high = times->count;

    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (times->us[middle] < time_us) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

static bool has_time_near(const struct time_list *times, int64_t time_us, int64_t tolerance_us)
{
    size_t at = index_of_time_from(times, time_us - tolerance_us);

    return at < times->count && times->us[at] <= time_us + tolerance_us;
}

/* Whether the target lacks a row at more than a third of the times of its life. */
static bool target_has_other_times(const struct truth_path *path, const struct time_list *times,
                                   int64_t tolerance_us)
{
    const int64_t last_us = path->rows[path->count - 1].time_us;
    size_t alive = 0, missing = 0;
    struct timed_point target;

    for (size_t i = index_of_time_from(times, path->rows[0].time_us);
         i < times->count && times->us[i] <= last_us; i++) {
        if (find_target(path, times->us[i], tolerance_us, &target)) {
            alive++;
            missing += row_near(path, times->us[i], tolerance_us) == NULL;
        }
    }
    return 3 * missing > alive;
}

static bool some_target_has_other_times(const struct timed_points *truth,
                                        const struct time_list *track_times, int64_t gap_us,
                                        int64_t tolerance_us)
{
    struct truth_paths paths = truth_paths_of(truth, gap_us);
    bool has_other_times = false;

    for (size_t i = 0; i < paths.count && !has_other_times; i++) {
        has_other_times = target_has_other_times(&paths.list[i], track_times, tolerance_us);
    }
    truth_paths_free(&paths);
    return has_other_times;
}

/* Whether between any two times of the tracks the truth has another one. */
static bool has_more_times_than_scans(const struct time_list *truth_times,
                                      const struct time_list *track_times, int64_t tolerance_us)
{
    bool had_track = false;

    for (size_t i = 0; i < truth_times->count; i++) {
        bool has_track = has_time_near(track_times, truth_times->us[i], tolerance_us);
        if (had_track && has_track) {
            return false;
        }
        had_track = has_track;
    }
    return track_times->count >= FEWEST_TRACK_TIMES;
}

bool truth_has_times_of_tracks(const struct timed_points *truth, const struct timed_points *tracks,
                               int64_t gap_us, int64_t tolerance_us)
{
    struct time_list truth_times = times_of(truth, false), track_times = times_of(tracks, false);
    bool are_those = true;

    for (size_t i = 0; i < tracks->count && are_those; i++) {
        are_those = tracks->list[i].is_tentative ||
                    has_time_near(&truth_times, tracks->list[i].time_us, tolerance_us);
    }
    are_those = are_those && !has_more_times_than_scans(&truth_times, &track_times, tolerance_us) &&
                !some_target_has_other_times(truth, &track_times, gap_us, tolerance_us);
    free(truth_times.us);
    free(track_times.us);
    return are_those;
}

/* What the rows of the tracks say about times without any. */
struct track_lives {
    int64_t interval_us; /* half of all tracks' life is in intervals up to this one; 0: none */
    /* for each time of the tracks: tracks with rows there or before, and after */
    size_t *going_on;
};

static int64_t weighted_median_us(int64_t *intervals_us, size_t count)
{
    double sum_us = 0.0, so_far_us = 0.0;

    qsort(intervals_us, count, sizeof *intervals_us, by_value);
    for (size_t i = 0; i < count; i++) {
        sum_us += (double)intervals_us[i];
    }
    for (size_t i = 0; i < count; i++) {
        so_far_us += (double)intervals_us[i];
        if (2.0 * so_far_us >= sum_us) {
            return intervals_us[i];
        }
    }
    return 0;
}

static struct track_lives lives_of(const struct timed_points *tracks, const struct time_list *times)
{
    struct timed_points sorted = sorted_by_identity(tracks);
    int64_t *intervals_us = must_calloc(sorted.count + 1, sizeof *intervals_us);
    size_t num_intervals = 0;
    struct track_lives lives = {.going_on = must_calloc(times->count + 1, sizeof *lives.going_on)};

    for (size_t begin = 0, end; begin < sorted.count; begin = end) {
        end = end_of_identity(&sorted, begin);
        const struct timed_point *last_point = sorted.list + (end - 1);
        for (const struct timed_point *at = sorted.list + begin; at < last_point; at++) {
            intervals_us[num_intervals++] = at[1].time_us - at->time_us;
        }
        size_t first = index_of_time_from(times, sorted.list[begin].time_us - ALIGNMENT_LEAST_US);
        size_t last = index_of_time_from(times, sorted.list[end - 1].time_us - ALIGNMENT_LEAST_US);
        lives.going_on[first]++;
        lives.going_on[last]--; /* unsigned: the sums from the first time on are right again */
    }
    for (size_t i = 1; i < times->count; i++) {
        lives.going_on[i] += lives.going_on[i - 1];
    }
    lives.interval_us = weighted_median_us(intervals_us, num_intervals);
    free(intervals_us);
    free(sorted.list);
    return lives;
}

/* Adds times between two, both left out, in the interval or a longer one. */
static void fill_times(struct time_list *times, int64_t from_us, int64_t to_us, int64_t interval_us)
{
    int64_t least_us = (to_us - from_us) / FILLED_TIMES_MAX + 1;
    int64_t step_us = interval_us > least_us ? interval_us : least_us;

    if (interval_us <= 0 || step_us >= to_us - from_us) {
        return;
    }
    for (int64_t at_us = from_us + step_us; at_us + step_us / 2 < to_us; at_us += step_us) {
        add_time(times, at_us);
    }
}

/* The median interval of the first target with two rows. */
static int64_t interval_of_targets_us(const struct truth_paths *paths)
{
    for (size_t i = 0; i < paths->count; i++) {
        if (paths->list[i].interval_us > 0) {
            return paths->list[i].interval_us;
        }
    }
    return 0;
}

/*
 * All times of the tracks, and those in which scans without any track are likely: before the first
 * time, after the last one, and where no track goes on. They end half an interval beyond the truth.
 */
static struct time_list times_of_scans(const struct timed_points *truth,
                                       const struct timed_points *tracks,
                                       const struct truth_paths *paths)
{
    struct time_list times = {0}, track_times = times_of(tracks, true);
    struct track_lives lives = lives_of(tracks, &track_times);
    const int64_t first_us = tracks->list[0].time_us;
    const int64_t before_us = first_us - truth->list[0].time_us;
    const int64_t after_us = truth->list[truth->count - 1].time_us;
    const int64_t interval_us =
        lives.interval_us > 0 ? lives.interval_us : interval_of_targets_us(paths);

    if (interval_us > 0 && before_us >= interval_us) {
        /* counted back from the first time of the tracks */
        const int64_t from_us = first_us - before_us / interval_us * interval_us;
        add_time(&times, from_us);
        fill_times(&times, from_us, first_us, interval_us);
    }
    for (size_t i = 0; i < track_times.count; i++) {
        add_time(&times, track_times.us[i]);
        if (i + 1 < track_times.count && lives.going_on[i] == 0) {
            fill_times(&times, track_times.us[i], track_times.us[i + 1], interval_us);
        }
    }
    if (track_times.count > 0) {
        fill_times(&times, track_times.us[track_times.count - 1], after_us + (interval_us + 1) / 2,
                   interval_us);
    }
    free(lives.going_on);
    free(track_times.us);
    return times;
}

struct timed_points truth_at_times_of_tracks(const struct timed_points *truth,
                                             const struct timed_points *tracks, int64_t gap_us,
                                             int64_t tolerance_us)
{
    struct truth_paths paths = truth_paths_of(truth, gap_us);
    struct time_list times = times_of_scans(truth, tracks, &paths);
    struct timed_points at_times = {0};
    size_t capacity = 0;

    for (size_t i = 0; i < paths.count; i++) {
        const struct truth_path *path = &paths.list[i];
        const int64_t last_us = path->rows[path->count - 1].time_us + tolerance_us;
        struct timed_point target;
        for (size_t k = index_of_time_from(&times, path->rows[0].time_us - tolerance_us);
             k < times.count && times.us[k] <= last_us; k++) {
            if (find_target(path, times.us[k], tolerance_us, &target)) {
                at_times.list = must_make_room_for_one(at_times.list, at_times.count, &capacity,
                                                       sizeof *at_times.list);
                at_times.list[at_times.count++] = target;
            }
        }
    }
    if (at_times.count > 0) {
        qsort(at_times.list, at_times.count, sizeof *at_times.list, by_time_and_row);
    }
    free(times.us);
    truth_paths_free(&paths);
    return at_times;
}
