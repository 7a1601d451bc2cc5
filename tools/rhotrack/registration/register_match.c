/* SPDX-License-Identifier: MIT */
/*
 * register_match: which tracks of different radars are one target.
 *
 * Two tracks are compared wherever both have plots: each plot of one with the place between two
 * plots of the other. Pairs are taken nearest first, and a track belongs to no two targets' worth
 * of tracks at a time.
 */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "registration/register_data.h"

#define GAP_MAX_S 35.0 /* between plots of a track; beyond, nobody knows where it was */
#define COMPARISONS_MIN 5
/*
 * mean squared distance in sigmas, 2 where the pair is right and flies straight, and what one
 * comparison counts at most
 */
#define CLOSE_MEAN_D2 6.0
#define FAR_D2 25.0
#define FAR_M 20000.0 /* root of the sum: the rest of the way is not looked at */

struct comparison {
    size_t count;
    double sum_m2, sum_d2;
};

/* A track's plots, corrected. */
struct course {
    const struct radar_track *track;
    size_t radar, count;
    struct corrected *at;
    double *along_m2, *cross_m2; /* variances */
};

struct pair {
    size_t first, second; /* tracks */
    double distance;
};

/* ---- one pair ---- */

/* noise: of the plots over what their sigmas say */
static void load_course(const struct register_data *data, const struct radar_track *track,
                        double noise, struct course *course)
{
    const struct radar_data *radar = &data->radars[track->radar];

    *course = (struct course){.track = track, .radar = track->radar, .count = track->count};
    course->at = must_calloc(track->count + 1, sizeof *course->at);
    course->along_m2 = must_calloc(track->count + 1, sizeof *course->along_m2);
    course->cross_m2 = must_calloc(track->count + 1, sizeof *course->cross_m2);
    for (size_t i = 0; i < track->count; i++) {
        const struct radar_plot *plot = &radar->plots[track->plots[i]];

        course->at[i] = register_correct_plot(data, radar, plot);
        course->along_m2[i] = pow(noise * plot->sigma_range_m, 2.0);
        course->cross_m2[i] = pow(noise * plot->sigma_cross_m, 2.0);
    }
}

static void free_course(struct course *course)
{
    free(course->at);
    free(course->along_m2);
    free(course->cross_m2);
}

static void add_covariance(const struct course *course, size_t i, double share, double sum[3])
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

/* Plot i of `of` against the place of `between` at that time, from its plots k and k + 1. */
static void compare_plot_with_course(const struct course *of, size_t i,
                                     const struct course *between, size_t k, struct comparison *sum)
{
    const struct corrected *from = &between->at[k], *to = &between->at[k + 1], *at = &of->at[i];
    double share = (at->t_s - from->t_s) / (to->t_s - from->t_s);
    double dx_m = at->x_m - from->x_m - share * (to->x_m - from->x_m);
    double dy_m = at->y_m - from->y_m - share * (to->y_m - from->y_m);
    double covariance[3] = {0};

    add_covariance(of, i, 1.0, covariance);
    add_covariance(between, k, (1.0 - share) * (1.0 - share), covariance);
    add_covariance(between, k + 1, share * share, covariance);
    sum->count++;
    sum->sum_m2 += dx_m * dx_m + dy_m * dy_m;
    sum->sum_d2 += fmin(mahalanobis2(covariance, dx_m, dy_m), FAR_D2);
}

static struct comparison compare_with_course(const struct course *of, const struct course *between)
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
            compare_plot_with_course(of, i, between, k, &sum);
            if (sum.sum_m2 > FAR_M * FAR_M) {
                break;
            }
        }
    }
    return sum;
}

static bool overlap_in_time(const struct course *one, const struct course *other)
{
    return one->count > 1 && other->count > 1 && one->at[0].t_s < other->at[other->count - 1].t_s &&
           other->at[0].t_s < one->at[one->count - 1].t_s;
}

/*
 * Each plot of one track is compared with the course between the plots of the other. Of both ways
 * round the one with more comparisons counts.
 */
static bool is_one_target(const struct course *one, const struct course *other, double gate_m,
                          double misfit, double *distance)
{
    struct comparison sum = compare_with_course(one, other), back = compare_with_course(other, one);

    sum = back.count > sum.count ? back : sum;
    if (sum.count < COMPARISONS_MIN) {
        return false;
    }
    *distance = sum.sum_m2 / (double)sum.count;
    if (*distance > gate_m * gate_m) {
        return false;
    }
    if (misfit > 0.0) {
        *distance = sum.sum_d2 / (double)sum.count;
        return *distance <= CLOSE_MEAN_D2;
    }
    return true;
}

/* ---- all pairs ---- */

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

static struct pairs find_pairs(const struct register_data *data, const struct course *courses,
                               double gate_m, double misfit)
{
    struct pairs pairs = {0};

    for (size_t i = 0; i < data->num_tracks; i++) {
        for (size_t j = i + 1; j < data->num_tracks; j++) {
            struct pair pair = {i, j, 0.0};

            if (courses[i].radar != courses[j].radar && overlap_in_time(&courses[i], &courses[j]) &&
                is_one_target(&courses[i], &courses[j], gate_m, misfit, &pair.distance)) {
                pairs.list = must_grow(pairs.list, pairs.count, &pairs.room, sizeof *pairs.list);
                pairs.list[pairs.count++] = pair;
            }
        }
    }
    if (pairs.count > 0) {
        qsort(pairs.list, pairs.count, sizeof *pairs.list, by_distance);
    }
    return pairs;
}

/* Two targets can be one unless a radar had a track of each at the same time. */
static bool can_join_targets(const struct course *courses, const size_t *targets, size_t num_tracks,
                             size_t one, size_t other)
{
    for (size_t i = 0; i < num_tracks; i++) {
        for (size_t j = 0; targets[i] == one && j < num_tracks; j++) {
            if (targets[j] == other && courses[i].radar == courses[j].radar &&
                overlap_in_time(&courses[i], &courses[j])) {
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

static bool store_targets(struct register_data *data, const size_t *targets)
{
    bool is_changed = false;

    for (size_t i = 0; i < data->num_tracks; i++) {
        is_changed |= data->tracks[i].target != targets[i];
        data->tracks[i].target = targets[i];
    }
    return is_changed;
}

bool register_match_tracks(struct register_data *data, double gate_m, double misfit)
{
    struct course *courses = must_calloc(data->num_tracks + 1, sizeof *courses);
    size_t *targets = must_calloc(data->num_tracks + 1, sizeof *targets);
    struct pairs pairs;
    bool is_changed;

    for (size_t i = 0; i < data->num_tracks; i++) {
        targets[i] = i;
        load_course(data, &data->tracks[i], fmax(1.0, misfit), &courses[i]);
    }
    pairs = find_pairs(data, courses, gate_m, misfit);
    for (size_t i = 0; i < pairs.count; i++) {
        size_t one = targets[pairs.list[i].first], other = targets[pairs.list[i].second];

        if (one != other && can_join_targets(courses, targets, data->num_tracks, one, other)) {
            join_targets(targets, data->num_tracks, one, other);
        }
    }
    is_changed = store_targets(data, targets);
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

        /* counted once, at its first track, whose number it has */
        for (size_t j = i + 1; data->tracks[i].target == i && j < data->num_tracks; j++) {
            is_common |=
                data->tracks[j].target == i && data->tracks[j].radar != data->tracks[i].radar;
        }
        common += is_common;
    }
    return common;
}
