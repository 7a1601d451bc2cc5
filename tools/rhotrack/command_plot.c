/* SPDX-License-Identifier: MIT */
/* plot: pictures of plots, tracks, errors and of the parameter space. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "commands.h"
#include "io/output/clutter_file.h"
#include "picture/map.h"
#include "picture/picture.h"
#include "picture/plot_bearings.h"
#include "picture/plot_clutter.h"
#include "picture/plot_data.h"
#include "picture/plot_errors.h"
#include "picture/plot_parameter_space.h"
#include "picture/plot_votes.h"

/* From so many points on a picture has small marks. */
#define MANY_POINTS 1500

static double mark_size(const struct plot_points *points, double size)
{
    return points->count > MANY_POINTS ? 0.5 * size : size;
}

/* ---- maps ---- */

static void draw_scans(struct picture *picture, const struct plot_data *data)
{
    struct map map = map_start(picture->script, data);
    map_put_points(&map, "plots", &data->plots);
    fprintf(map.script,
            "set key off\nset cblabel 'time (s)'\nset palette defined (0 '#00204d', "
            "0.5 '#7c7b78', 1 '#ffd940')\n"
            "plot $plots using 1:2:3 with points pt 7 ps %g lc palette\n",
            mark_size(&data->plots, 0.45));
}

/*
 * The straight line on which a track was found, back from its first row to the first plot's time.
 */
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

/* The legend's name of track number `index`; empty: none. */
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
    bool many = plot_data_ids(tracks) > PLOT_LEGEND_MAX;
    while (plot_data_next(tracks, &at, &one)) {
        char title[40];
        name_track(title, sizeof title, one.list[0].id, index, many);
        fprintf(map->script,
                ", \\\n $tracks index %zu using 1:2 with linespoints lw %g pt %d ps %g lc rgb "
                "'%s' %s",
                index, mark_size(tracks, 2.5), picture_marker(index),
                tracks->count > MANY_POINTS ? 0.25 : 0.9, picture_colour(index), title);
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
        fprintf(
            map.script,
            ", \\\n $truth using 1:2 with linespoints lw 1 dt 2 pt 6 ps %g lc rgb '#000000' title "
            "'truth'",
            data->truth.count > MANY_POINTS ? 0.3 : 1.3);
    }
    if (data->tracks.count) {
        fprintf(map.script, ", \\\n $starts using 1:2 with lines lw 1.5 dt 3 lc rgb '#444444' "
                            "title 'line that started a track'");
    }
    plot_track_lines(&map, &data->tracks);
    fprintf(map.script, "\n");
}

/* ---- the command ---- */

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
        fail(EXIT_USAGE,
             "plot: no picture '%s'; there is: scans, tracks, parameter-space, errors, "
             "clutter-map",
             kind);
    } else if (data->plots.count + data->tracks.count + data->truth.count == 0) {
        fail(EXIT_USAGE, "plot tracks: the files hold nothing to draw");
    }
}

/* Read before the picture is begun, so that a refused input leaves no half picture. */
struct findings {
    struct revolutions revolutions;
    struct plot_errors errors;
    struct plot_votes *votes; /* of --method; else NULL */
};

static void find_votes(struct findings *findings, const struct plot_data *data,
                       struct command_line *line)
{
    const enum method method = method_find(line->method);

    if (method == METHOD_KERNEL || method_takes_bearings(method)) {
        fail(EXIT_USAGE,
             "plot parameter-space: %s has no accumulator of plots; ht, mht, iht and "
             "nht have one",
             method_name(method));
    }
    method_suggest(method, &line->parameters);
    findings->revolutions = plot_parameter_space_read(
        data, &line->parameters, (size_t)line->parameters.value[PARAMETER_SCANS]);
    findings->votes = plot_votes_find(method, &findings->revolutions, &line->parameters);
}

static struct findings find(const char *kind, const struct plot_data *data,
                            struct command_line *line)
{
    const struct parameters *parameters = &line->parameters;
    struct findings findings = {.revolutions = {.count = 0}};
    if (strcmp(kind, "errors") == 0) {
        findings.errors = plot_errors_find(data, parameters);
    } else if (strcmp(kind, "parameter-space") == 0 && line->method) {
        find_votes(&findings, data, line);
    } else if (strcmp(kind, "parameter-space") == 0) {
        findings.revolutions = plot_parameter_space_read(data, parameters, RHO_MAX_SCANS);
    }
    return findings;
}

static void draw(const char *kind, struct picture *picture, const struct plot_data *data,
                 const struct findings *findings)
{
    if (strcmp(kind, "scans") == 0 && data->bearings.num_sensors) {
        plot_bearings(picture, data);
    } else if (strcmp(kind, "scans") == 0) {
        draw_scans(picture, data);
    } else if (strcmp(kind, "tracks") == 0) {
        draw_tracks(picture, data);
    } else if (strcmp(kind, "errors") == 0) {
        plot_errors(picture, data, &findings->errors);
    } else if (findings->votes) {
        plot_votes(picture, findings->votes);
    } else {
        plot_parameter_space(picture, data, &findings->revolutions);
    }
}

/* The map, and files of plots that are drawn beneath. */
static int plot_clutter_map(const struct command_line *line)
{
    size_t count;
    struct clutter_echo *echoes =
        clutter_file_echoes(line->arguments[1], &line->parameters, &count);
    struct plot_data data =
        plot_data_read(line->arguments + 2, line->num_arguments - 2, &line->parameters);
    if (line->num_arguments > 2) {
        need(&data.plots, "clutter-map", "plots (t_s, x_m, y_m)");
    }
    struct picture picture = picture_open(line->output, 1000, 900);
    plot_clutter(&picture, echoes, count, &data, &line->parameters);
    picture_close(&picture);
    free(echoes);
    plot_data_free(&data);
    return 0;
}

int command_plot(struct command_line *line)
{
    if (line->num_arguments < 2 || !line->output) {
        fail(EXIT_USAGE, "plot: give a picture (scans, tracks, parameter-space, errors, "
                         "clutter-map), files, and -o FILE.svg");
    }
    const char *kind = line->arguments[0];
    if (line->method && strcmp(kind, "parameter-space") != 0) {
        fail(EXIT_USAGE, "plot %s: --method is for parameter-space", kind);
    }
    if (strcmp(kind, "clutter-map") == 0) {
        return plot_clutter_map(line);
    }
    struct plot_data data =
        plot_data_read(line->arguments + 1, line->num_arguments - 1, &line->parameters);
    check_content(kind, &data);
    struct findings findings = find(kind, &data, line);
    struct picture picture = picture_open(line->output, 1100, 680);
    draw(kind, &picture, &data, &findings);
    picture_close(&picture);
    revolutions_free(&findings.revolutions);
    plot_errors_free(&findings.errors);
    plot_votes_free(findings.votes);
    plot_data_free(&data);
    return 0;
}
