/* SPDX-License-Identifier: MIT */
/* plot: pictures of plots, tracks, errors and of the parameter space. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "common.h"
#include "gospa.h"
#include "map.h"
#include "picture.h"
#include "plot_bearings.h"
#include "plot_data.h"
#include "plot_parameter_space.h"

#define LEGEND_TRACKS_MAX 8 /* more tracks than that get no line of their own in the legend */

/* ---- maps ------------------------------------------------------------------------------------- */

static void draw_scans(struct picture *picture, const struct plot_data *data)
{
    struct map map = map_start(picture->script, data);
    map_put_points(&map, "plots", &data->plots);
    fprintf(map.script, "set key off\nset cblabel 'time (s)'\nset palette defined (0 '#00204d', "
                        "0.5 '#7c7b78', 1 '#ffd940')\n"
                        "plot $plots using 1:2:3 with points pt 7 ps 0.45 lc palette\n");
}

/* The straight line on which a track was found, back from its first row to the first plot's time. */
static void put_start_lines(const struct map *map, const struct plot_data *data)
{
    struct plot_points one;
    size_t at = 0;
    int64_t first_us = data->plots.count ? data->plots.list[0].time_us : INT64_MAX;
    fprintf(map->script, "$starts << EOD\n");
    while (plot_data_next(&data->tracks, &at, &one)) {
        const struct plot_point *start = &one.list[0];
        double back_s = (double)(start->time_us - first_us) * 1e-6;
        struct plot_point origin = *start;
        back_s =
            back_s > 0.0
                ? fmin(back_s,
                       6.0 * (double)(one.count > 1 ? one.list[1].time_us - start->time_us : 0) *
                           1e-6)
                : 0.0;
        origin.x_m -= back_s * start->vx_mps;
        origin.y_m -= back_s * start->vy_mps;
        map_put_point(map, &origin);
        map_put_point(map, start);
        fprintf(map->script, "\n\n");
    }
    fprintf(map->script, "EOD\n");
}

static void put_labels(const struct map *map, const struct plot_points *tracks)
{
    struct plot_points one;
    size_t at = 0;
    while (plot_data_next(tracks, &at, &one)) {
        const struct plot_point *end = &one.list[one.count - 1];
        fprintf(map->script, "set label '%d' at %.6g,%.6g offset 0.8,0.6 front\n", end->id,
                end->x_m / map->unit_m, end->y_m / map->unit_m);
    }
}

static size_t count_ids(const struct plot_points *points)
{
    struct plot_points one;
    size_t at = 0, count = 0;
    while (plot_data_next(points, &at, &one)) {
        count++;
    }
    return count;
}

/* What the legend calls track number `index`; empty: nothing. */
static void name_track(char *title, size_t size, int32_t id, size_t index, bool many)
{
    if (!many) {
        snprintf(title, size, "title 'track %d'", id);
    } else {
        snprintf(title, size, "%s", index == 0 ? "title 'tracks'" : "notitle");
    }
}

static void plot_track_lines(const struct map *map, const struct plot_points *tracks)
{
    struct plot_points one;
    size_t at = 0, index = 0;
    bool many = count_ids(tracks) > LEGEND_TRACKS_MAX;
    while (plot_data_next(tracks, &at, &one)) {
        char title[40];
        name_track(title, sizeof title, one.list[0].id, index, many);
        fprintf(map->script,
                ", \\\n $tracks index %zu using 1:2 with linespoints lw 2.5 pt %d ps 0.9 lc rgb "
                "'%s' %s",
                index, picture_marker(index), picture_colour(index), title);
        index++;
    }
}

static void draw_tracks(struct picture *picture, const struct plot_data *data)
{
    struct map map = map_start(picture->script, data);
    map_put_points(&map, "plots", &data->plots);
    map_put_points(&map, "truth", &data->truth);
    map_put_points(&map, "tracks", &data->tracks);
    put_start_lines(&map, data);
    put_labels(&map, &data->tracks);
    fprintf(map.script, "plot NaN notitle");
    if (data->plots.count) {
        fprintf(map.script,
                ", \\\n $plots using 1:2 with points pt 7 ps 0.3 lc rgb '#a8a8a8' title 'plots'");
    }
    if (data->truth.count) {
        fprintf(map.script, ", \\\n $truth using 1:2 with linespoints lw 1 dt 2 pt 6 ps 1.3 lc rgb "
                            "'#000000' title 'truth'");
    }
    if (data->tracks.count) {
        fprintf(map.script, ", \\\n $starts using 1:2 with lines lw 1.5 dt 3 lc rgb '#444444' "
                            "title 'line that started a track'");
    }
    plot_track_lines(&map, &data->tracks);
    fprintf(map.script, "\n");
}

/* ---- errors ----------------------------------------------------------------------------------- */

/* Indices of the points of one time; tracks count once they are confirmed. */
static size_t points_at(const struct plot_points *points, int64_t time_us, size_t *at,
                        struct gospa_place *places)
{
    size_t count = 0;
    for (size_t i = 0; i < points->count; i++) {
        if (points->list[i].time_us == time_us && !points->list[i].is_tentative) {
            places[count] = (struct gospa_place){points->list[i].x_m, points->list[i].y_m, 0.0};
            at[count++] = i;
        }
    }
    return count;
}

struct error_finder {
    const struct plot_data *data;
    double cutoff_m;
    double *error_m; /* by row of the truth; NAN: no track; negative: not yet known */
    size_t *targets, *tracks;
    struct gospa_place *target_places, *track_places;
    int *track_of;
};

static void find_errors_at(struct error_finder *finder, int64_t time_us)
{
    const struct plot_data *data = finder->data;
    size_t num_targets = points_at(&data->truth, time_us, finder->targets, finder->target_places);
    size_t num_tracks = points_at(&data->tracks, time_us, finder->tracks, finder->track_places);
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

static struct error_finder find_errors(const struct plot_data *data, double cutoff_m)
{
    size_t targets = data->truth.count + 1, tracks = data->tracks.count + 1;
    struct error_finder finder = {
        .data = data,
        .cutoff_m = cutoff_m,
        .error_m = must_calloc(targets, sizeof(double)),
        .targets = must_calloc(targets, sizeof(size_t)),
        .tracks = must_calloc(tracks, sizeof(size_t)),
        .target_places = must_calloc(targets, sizeof(struct gospa_place)),
        .track_places = must_calloc(tracks, sizeof(struct gospa_place)),
        .track_of = must_calloc(targets, sizeof(int)),
    };
    for (size_t i = 0; i < data->truth.count; i++) {
        finder.error_m[i] = -1.0;
    }
    for (size_t i = 0; i < data->truth.count; i++) {
        if (finder.error_m[i] < 0.0) {
            find_errors_at(&finder, data->truth.list[i].time_us);
        }
    }
    return finder;
}

static void free_errors(struct error_finder *finder)
{
    free(finder->error_m);
    free(finder->targets);
    free(finder->tracks);
    free(finder->target_places);
    free(finder->track_places);
    free(finder->track_of);
}

static void put_errors(FILE *script, const struct plot_data *data, double cutoff_m)
{
    struct error_finder finder = find_errors(data, cutoff_m);
    fprintf(script, "$errors << EOD\n");
    for (size_t i = 0; i < data->truth.count; i++) {
        const struct plot_point *target = &data->truth.list[i];
        if (i > 0 && target->id != data->truth.list[i - 1].id) {
            fprintf(script, "\n\n");
        }
        fprintf(script, "%.6f ", (double)target->time_us * 1e-6);
        if (isnan(finder.error_m[i])) {
            fprintf(script, "NaN\n");
        } else {
            fprintf(script, "%.6g\n", finder.error_m[i]);
        }
    }
    fprintf(script, "EOD\n");
    free_errors(&finder);
}

static void draw_errors(struct picture *picture, const struct plot_data *data, double cutoff_m)
{
    struct plot_points one;
    size_t at = 0, index = 0, many = count_ids(&data->truth) > LEGEND_TRACKS_MAX;
    put_errors(picture->script, data, cutoff_m);
    fprintf(picture->script,
            "set xlabel 'time (s)'\nset ylabel 'position error (m)'\nset yrange [0:*]\n%splot NaN "
            "notitle",
            many ? "set key off\n" : "");
    while (plot_data_next(&data->truth, &at, &one)) {
        fprintf(picture->script,
                ", \\\n $errors index %zu using 1:2 with linespoints lw 2 pt %d ps 0.8 lc rgb '%s' "
                "title 'target %d'",
                index, picture_marker(index), picture_colour(index), one.list[0].id);
        index++;
    }
    fprintf(picture->script, "\n");
}

/* ---- the command ------------------------------------------------------------------------------ */

static void need(const struct plot_points *points, const char *kind, const char *what)
{
    if (points->count == 0) {
        fail(EXIT_USAGE, "plot %s: no file with %s is given", kind, what);
    }
}

static void check_content(const char *kind, const struct plot_data *data)
{
    if (data->bearings.has_own_file && strcmp(kind, "scans") != 0) {
        fail(EXIT_USAGE, "plot %s: bearings (column 'bearing_rad') are shown by plot scans alone",
             kind);
    }
    if (strcmp(kind, "scans") == 0 && data->bearings.num_sensors) {
        return;
    }
    if (strcmp(kind, "scans") == 0 || strcmp(kind, "parameter-space") == 0) {
        need(&data->plots, kind, "plots (t_s, x_m, y_m)");
    } else if (strcmp(kind, "errors") == 0) {
        need(&data->truth, kind, "truth (target_id)");
    } else if (strcmp(kind, "tracks") != 0) {
        fail(EXIT_USAGE, "plot: no picture '%s'; there is: scans, tracks, parameter-space, errors",
             kind);
    } else if (data->plots.count + data->tracks.count + data->truth.count == 0) {
        fail(EXIT_USAGE, "plot tracks: the files hold nothing to draw");
    }
}

static void draw(const char *kind, struct picture *picture, const struct plot_data *data,
                 const struct parameters *parameters)
{
    if (strcmp(kind, "scans") == 0 && data->bearings.num_sensors) {
        plot_bearings(picture, data);
    } else if (strcmp(kind, "scans") == 0) {
        draw_scans(picture, data);
    } else if (strcmp(kind, "tracks") == 0) {
        draw_tracks(picture, data);
    } else if (strcmp(kind, "errors") == 0) {
        draw_errors(picture, data, parameters->value[PARAMETER_GOSPA_CUTOFF_M]);
    } else {
        plot_parameter_space(picture, data, parameters);
    }
}

int command_plot(struct command_line *line)
{
    if (line->num_arguments < 2 || !line->output) {
        fail(EXIT_USAGE, "plot: give a picture (scans, tracks, parameter-space, errors), files, "
                         "and -o FILE.svg");
    }
    const char *kind = line->arguments[0];
    struct plot_data data =
        plot_data_read(line->arguments + 1, line->num_arguments - 1, &line->parameters);
    check_content(kind, &data);
    struct picture picture = picture_open(line->output, 1100, 680);
    draw(kind, &picture, &data, &line->parameters);
    picture_close(&picture);
    plot_data_free(&data);
    return 0;
}
