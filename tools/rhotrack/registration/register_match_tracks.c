/* SPDX-License-Identifier: MIT */
/*
 * register_match_tracks: matches tracks of different radars that follow one target.
 *
 * Two tracks are compared while both have plots: each plot of one with the place interpolated
 * between two plots of the other. Pairs are joined nearest first, unless a radar would have two
 * tracks of the joined target at one time.
 */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "registration/register_data.h"

/* longest interval between two plots of a track in which its place is interpolated */
#define GAP_MAX_S 35.0
#define COMPARISONS_MIN 5
/*
 * Largest mean squared Mahalanobis distance of a matching pair (2 is expected where a pair is right
 * and flies straight), and the value at which one comparison is cut.
 */
#define CLOSE_MEAN_D2 6.0
#define FAR_D2 25.0
#define FAR_M 20000.0 /* root of the summed squared distances at which a comparison stops early */

struct comparison {
    size_t count;
    double sum_m2, sum_d2;
};

/* A track's plots after subtracting the biases, with their variances. */
struct course {
    const struct radar_track *track;
    size_t radar, count;
    struct corrected *at;
    double *along_m2, *cross_m2; /* variances of the plots along and across the line of sight */
};

struct pair {
    size_t first, second; /* indices of the two tracks */
    double distance;
};

/*
 * Makes a course of a track: its plots corrected by the biases, with variances for the given ratio
 * of actual noise to sigmas.
 */
static void make_course(const struct register_data *data, const struct radar_track *track,
                        double noise_factor, struct course *course)
{
    const struct radar_data *radar = &data->radars[track->radar];

    *course = (struct course){.track = track, .radar = track->radar, .count = track->count};
    course->at = must_calloc(track->count + 1, sizeof *course->at);
    course->along_m2 = must_calloc(track->count + 1, sizeof *course->along_m2);
    course->cross_m2 = must_calloc(track->count + 1, sizeof *course->cross_m2);
    for (size_t i = 0; i < track->count; i++) {
        const struct radar_plot *plot = &radar->plots[track->plots[i]];

        course->at[i] = register_correct_plot(data, radar, plot);
        course->along_m2[i] = pow(noise_factor * plot->sigma_range_m, 2.0);
        course->cross_m2[i] = pow(noise_factor * plot->sigma_cross_m, 2.0);
    }
}

static void free_course(struct course *course)
{
    free(course->at);
    free(course->along_m2);
    free(course->cross_m2);
}

/* Adds share times the covariance (xx, xy, yy) of plot i of the course to sum. */
static void add_plot_covariance(const struct course *course, size_t i, double share, double sum[3])
{
    const struct corrected *at = &course->at[i];
    double c = at->cos_azimuth, s = at->sin_azimuth;
    double along_m2 = share * course->along_m2[i], cross_m2 = share * course->cross_m2[i];

    sum[0] += c * c * along_m2 + s * s * cross_m2;
    sum[1] += c * s * (along_m2 - cross_m2);
    sum[2] += s * s * along_m2 + c * c * cross_m2;
}

static double mahalanobis2(const double covariance[3], double dx_m, double dy_m)
{
    double determinant = covariance[0] * covariance[2] - covariance[1] * covariance[1];

    return (covariance[2] * dx_m * dx_m - 2.0 * covariance[1] * dx_m * dy_m +
            covariance[0] * dy_m * dy_m) /
           determinant;
}

/*
 * Compares plot i of `of` with the place interpolated between plots k and k + 1 of `between`, and
 * adds the squared distances to sum.
 */
static void add_squared_distance(const struct course *of, size_t i, const struct course *between,
                                 size_t k, struct comparison *sum)
{
    const struct corrected *from = &between->at[k], *to = &between->at[k + 1], *at = &of->at[i];
    double share = (at->t_s - from->t_s) / (to->t_s - from->t_s);
    double dx_m = at->x_m - from->x_m - share * (to->x_m - from->x_m);
    double dy_m = at->y_m - from->y_m - share * (to->y_m - from->y_m);
    double covariance[3] = {0};

    add_plot_covariance(of, i, 1.0, covariance);
    add_plot_covariance(between, k, (1.0 - share) * (1.0 - share), covariance);
    add_plot_covariance(between, k + 1, share * share, covariance);
    sum->count++;
    sum->sum_m2 += dx_m * dx_m + dy_m * dy_m;
    sum->sum_d2 += fmin(mahalanobis2(covariance, dx_m, dy_m), FAR_D2);
}

/* Squared distances of one track's plots to the course of another. */
static struct comparison sum_squared_distances(const struct course *of,
                                               const struct course *between)
{
    struct comparison sum = {0};
    size_t k = 0;

    for (size_t i = 0; i < of->count; i++) {
        double t_s = of->at[i].t_s;

        while (k + 1 < between->count && between->at[k + 1].t_s < t_s) {
            k++;
        }
        if (k + 1 < between->count && between->at[k].t_s <= t_s &&
            between->at[k + 1].t_s > between->at[k].t_s &&
            between->at[k + 1].t_s - between->at[k].t_s <= GAP_MAX_S) {
            add_squared_distance(of, i, between, k, &sum);
            if (sum.sum_m2 > FAR_M * FAR_M) {
                break;
            }
        }
    }
    return sum;
}

static bool courses_overlap_in_time(const struct course *one, const struct course *other)
{
    return one->count > 1 && other->count > 1 && one->at[0].t_s < other->at[other->count - 1].t_s &&
           other->at[0].t_s < one->at[one->count - 1].t_s;
}

/*
 * Whether two courses are within the gate, and where misfit is given agree statistically. The
 * direction of comparison with more compared plots counts; *distance is the mean squared distance,
 * in metres or sigmas.
 */
static bool are_courses_of_one_target(const struct course *one, const struct course *other,
                                      double gate_m, double misfit, double *mean_distance2)
{
    struct comparison sum = sum_squared_distances(one, other),
                      back = sum_squared_distances(other, one);

    sum = back.count > sum.count ? back : sum;
    if (sum.count < COMPARISONS_MIN) {
        return false;
    }
    *mean_distance2 = sum.sum_m2 / (double)sum.count;
    if (*mean_distance2 > gate_m * gate_m) {
        return false;
    }
    if (misfit > 0.0) {
        *mean_distance2 = sum.sum_d2 / (double)sum.count;
        return *mean_distance2 <= CLOSE_MEAN_D2;
    }
    return true;
}

struct pairs {
    size_t count, room;
    struct pair *list;
};

static int by_distance(const void *a, const void *b)
{
    const struct pair *one = a, *other = b;

    if (one->distance < other->distance || one->distance > other->distance) {
        return one->distance > other->distance ? 1 : -1;
    }
    if (one->first != other->first) {
        return one->first > other->first ? 1 : -1;
    }
    return (one->second > other->second) - (one->second < other->second);
}

static struct pairs find_matching_pairs(const struct register_data *data,
                                        const struct course *courses, double gate_m, double misfit)
{
    struct pairs pairs = {0};

    for (size_t i = 0; i < data->num_tracks; i++) {
        for (size_t j = i + 1; j < data->num_tracks; j++) {
            struct pair pair = {i, j, 0.0};

            if (courses[i].radar != courses[j].radar &&
                courses_overlap_in_time(&courses[i], &courses[j]) &&
                are_courses_of_one_target(&courses[i], &courses[j], gate_m, misfit,
                                          &pair.distance)) {
                pairs.list = must_make_room_for_one(pairs.list, pairs.count, &pairs.room,
                                                    sizeof *pairs.list);
                pairs.list[pairs.count++] = pair;
            }
        }
    }
    if (pairs.count > 0) {
        qsort(pairs.list, pairs.count, sizeof *pairs.list, by_distance);
    }
    return pairs;
}

/* Whether two targets can be joined: no radar has a track of each at the same time. */
static bool can_join_targets(const struct course *courses, const size_t *targets, size_t num_tracks,
                             size_t one, size_t other)
{
    for (size_t i = 0; i < num_tracks; i++) {
        for (size_t j = 0; targets[i] == one && j < num_tracks; j++) {
            if (targets[j] == other && courses[i].radar == courses[j].radar &&
                courses_overlap_in_time(&courses[i], &courses[j])) {
                return false;
            }
        }
    }
    return true;
}

static void join_targets(size_t *targets, size_t num_tracks, size_t one, size_t other)
{
    size_t kept = one < other ? one : other, gone = one < other ? other : one;

    for (size_t i = 0; i < num_tracks; i++) {
        targets[i] = targets[i] == gone ? kept : targets[i];
    }
}

/* Stores the tracks' target numbers; true where any changed. */
static bool store_track_targets(struct register_data *data, const size_t *targets)
{
    bool is_changed = false;

    for (size_t i = 0; i < data->num_tracks; i++) {
        is_changed |= data->tracks[i].target != targets[i];
        data->tracks[i].target = targets[i];
    }
    return is_changed;
}

bool register_update_matches(struct register_data *data, double gate_m, double misfit)
{
    struct course *courses = must_calloc(data->num_tracks + 1, sizeof *courses);
    size_t *targets = must_calloc(data->num_tracks + 1, sizeof *targets);
    struct pairs pairs;
    bool is_changed;

    for (size_t i = 0; i < data->num_tracks; i++) {
        targets[i] = i;
        make_course(data, &data->tracks[i], fmax(1.0, misfit), &courses[i]);
    }
    pairs = find_matching_pairs(data, courses, gate_m, misfit);
    for (size_t i = 0; i < pairs.count; i++) {
        size_t one = targets[pairs.list[i].first], other = targets[pairs.list[i].second];

        if (one != other && can_join_targets(courses, targets, data->num_tracks, one, other)) {
            join_targets(targets, data->num_tracks, one, other);
        }
    }
    is_changed = store_track_targets(data, targets);
    for (size_t i = 0; i < data->num_tracks; i++) {
        free_course(&courses[i]);
    }
    free(pairs.list);
    free(courses);
    free(targets);
    return is_changed;
}

size_t register_num_common_targets(const struct register_data *data)
{
    size_t common = 0;

    for (size_t i = 0; i < data->num_tracks; i++) {
        bool is_common = false;

        /* a target's number is the index of its first track: count it only there */
        for (size_t j = i + 1; data->tracks[i].target == i && j < data->num_tracks; j++) {
            is_common |=
                data->tracks[j].target == i && data->tracks[j].radar != data->tracks[i].radar;
        }
        common += is_common;
    }
    return common;
}
