/* SPDX-License-Identifier: MIT */
#include "picture/plot_errors.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "evaluation/alignment.h"
#include "evaluation/gospa.h"

#define MARKERS_MAX 40 /* most markers on a line; closer ones cannot be told apart */

/*
 * Collects places and indices (*at) of the points at one time, except tentative ones; returns their
 * number.
 */
static size_t collect_points_at_time(const struct plot_points *points, int64_t time_us,
                                     size_t *indices, struct gospa_place *places)
{
    size_t count = 0;
    for (size_t i = 0; i < points->count; i++) {
        if (points->list[i].time_us == time_us && !points->list[i].is_tentative) {
            places[count] = (struct gospa_place){points->list[i].x_m, points->list[i].y_m, 0.0};
            indices[count++] = i;
        }
    }
    return count;
}

struct error_finder {
    const struct plot_points *truth;
    struct plot_points aligned_tracks; /* tracks extrapolated to the truth's times */
    double cutoff_m;
    double *error_m; /* by index of the truth's points; NAN: no track; negative: not yet computed */
    size_t *targets, *tracks;
    struct gospa_place *target_places, *track_places;
    int *track_of;
};

static void find_errors_at_time(struct error_finder *finder, int64_t time_us)
{
    size_t num_targets =
        collect_points_at_time(finder->truth, time_us, finder->targets, finder->target_places);
    size_t num_tracks = collect_points_at_time(&finder->aligned_tracks, time_us, finder->tracks,
                                               finder->track_places);
    gospa_compare(finder->target_places, num_targets, finder->track_places, num_tracks,
                  finder->cutoff_m, finder->track_of);
    for (size_t i = 0; i < num_targets; i++) {
        double *error_m = &finder->error_m[finder->targets[i]];
        *error_m = NAN;
        if (finder->track_of[i] >= 0) {
            const struct gospa_place *track = &finder->track_places[finder->track_of[i]];
            *error_m = hypot(track->x_m - finder->target_places[i].x_m,
                             track->y_m - finder->target_places[i].y_m);
        }
    }
}

static void find_all_errors(struct error_finder *finder)
{
    const struct plot_points *truth = finder->truth;
    for (size_t i = 0; i < truth->count; i++) {
        finder->error_m[i] = -1.0;
    }
    for (size_t i = 0; i < truth->count; i++) {
        if (finder->error_m[i] < 0.0) {
            find_errors_at_time(finder, truth->list[i].time_us);
        }
    }
}

/* Exits with 2 where no target ever has a track: gnuplot cannot draw an empty picture. */
static void fail_if_no_error_known(const struct error_finder *finder)
{
    for (size_t i = 0; i < finder->truth->count; i++) {
        if (!isnan(finder->error_m[i])) {
            return;
        }
    }
    fail(EXIT_USAGE, "plot errors: no target has a track within gospa_cutoff_m (%g m) at any time",
         finder->cutoff_m);
}

static int by_time(const void *a, const void *b)
{
    const struct plot_point *one = a, *other = b;
    if (one->time_us != other->time_us) {
        return one->time_us < other->time_us ? -1 : 1;
    }
    return (one->id > other->id) - (one->id < other->id);
}

/* Copy of the points sorted by time, without tentative ones. */
static struct plot_points confirmed_points_by_time(const struct plot_points *points)
{
    struct plot_points sorted = {.list = must_calloc(points->count + 1, sizeof *sorted.list)};
    for (size_t i = 0; i < points->count; i++) {
        if (!points->list[i].is_tentative) {
            sorted.list[sorted.count++] = points->list[i];
        }
    }
    qsort(sorted.list, sorted.count, sizeof *sorted.list, by_time);
    return sorted;
}

static struct alignment_times strided_view_of_point_times(const struct plot_points *points)
{
    return (struct alignment_times){
        .first_us = &points->list->time_us, .stride = sizeof *points->list, .count = points->count};
}

static struct plot_point extrapolated_to_time(const struct plot_point *point, int64_t to_us)
{
    struct plot_point at = *point;
    double by_s = (double)(to_us - point->time_us) * 1e-6;
    at.time_us = to_us;
    at.x_m += by_s * point->vx_mps;
    at.y_m += by_s * point->vy_mps;
    return at;
}

/*
 * The tracks' points extrapolated to the truth's times; exits with 2 where a track time has no
 * truth time within most_us.
 */
static struct plot_points extrapolate_to_truth(const struct picture_data *data, int64_t most_us)
{
    struct plot_points truth = confirmed_points_by_time(&data->truth);
    struct plot_points tracks = confirmed_points_by_time(&data->tracks);
    struct alignment_times truth_times = strided_view_of_point_times(&truth),
                           track_times = strided_view_of_point_times(&tracks);
    size_t unmatched = alignment_find_unmatched(track_times, truth_times, most_us);
    if (unmatched < tracks.count) {
        alignment_fail_unmatched(tracks.list[unmatched].table, tracks.list[unmatched].row, most_us);
    }
    struct alignment alignment = alignment_list_rows(track_times, truth_times, most_us);
    struct plot_points aligned = {.list = must_calloc(alignment.count + 1, sizeof *aligned.list),
                                  .count = alignment.count};
    for (size_t i = 0; i < alignment.count; i++) {
        aligned.list[i] =
            extrapolated_to_time(&tracks.list[alignment.list[i].row], alignment.list[i].to_us);
    }
    free(alignment.list);
    free(truth.list);
    free(tracks.list);
    return aligned;
}

struct plot_errors plot_errors_find(const struct picture_data *data,
                                    const struct parameters *parameters)
{
    struct plot_points aligned = extrapolate_to_truth(data, alignment_tolerance_us(parameters));
    size_t targets = data->truth.count + 1, tracks = aligned.count + 1;
    struct error_finder finder = {
        .truth = &data->truth,
        .aligned_tracks = aligned,
        .cutoff_m = parameters->value[PARAMETER_GOSPA_CUTOFF_M],
        .error_m = must_calloc(targets, sizeof(double)),
        .targets = must_calloc(targets, sizeof(size_t)),
        .tracks = must_calloc(tracks, sizeof(size_t)),
        .target_places = must_calloc(targets, sizeof(struct gospa_place)),
        .track_places = must_calloc(tracks, sizeof(struct gospa_place)),
        .track_of = must_calloc(targets, sizeof(int)),
    };
    find_all_errors(&finder);
    fail_if_no_error_known(&finder);
    free(finder.aligned_tracks.list);
    free(finder.targets);
    free(finder.tracks);
    free(finder.target_places);
    free(finder.track_places);
    free(finder.track_of);
    return (struct plot_errors){.error_m = finder.error_m};
}

void plot_errors_free(struct plot_errors *errors)
{
    free(errors->error_m);
}

static void put_errors(FILE *script, const struct picture_data *data,
                       const struct plot_errors *errors)
{
    const int64_t zero_us = picture_data_time_origin_us(data);
    fprintf(script, "$errors << EOD\n");
    for (size_t i = 0; i < data->truth.count; i++) {
        const struct plot_point *target = &data->truth.list[i];
        if (i > 0 && target->id != data->truth.list[i - 1].id) {
            fprintf(script, "\n\n");
        }
        fprintf(script, "%.6f ", (double)(target->time_us - zero_us) * 1e-6);
        if (isnan(errors->error_m[i])) {
            fprintf(script, "NaN\n");
        } else {
            fprintf(script, "%.6g\n", errors->error_m[i]);
        }
    }
    fprintf(script, "EOD\n");
}

void plot_errors(struct picture *picture, const struct picture_data *data,
                 const struct plot_errors *errors)
{
    struct plot_points one;
    size_t at = 0, index = 0, many = picture_data_count_identities(&data->truth) > PLOT_LEGEND_MAX;
    char time[80];
    picture_data_write_time_label(data, time, sizeof time);
    picture_set_title(picture, "Position errors of the tracks of %zu targets",
                      picture_data_count_identities(&data->truth));
    put_errors(picture->script, data, errors);
    fprintf(picture->script,
            "set xlabel '%s'\nset ylabel 'position error (m)'\nset yrange [0:*]\n%splot NaN "
            "notitle",
            time, many ? "set key off\n" : "");
    while (picture_data_next_identity(&data->truth, &at, &one)) {
        fprintf(picture->script,
                ", \\\n $errors index %zu using 1:2 with linespoints lw 1.2 pt %d ps %g pi %zu "
                "lc rgb '%s' title 'target %d'",
                index, picture_marker(index), many ? 0.3 : 0.7, one.count / MARKERS_MAX + 1,
                picture_colour(index), one.list[0].id);
        index++;
    }
    fprintf(picture->script, "\n");
}
