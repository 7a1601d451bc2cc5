/* SPDX-License-Identifier: MIT */
#include "picture/plot_by_time.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "picture/plan_view_map.h"
#include "picture/plot_bearings.h"

#define TRACKS_MARKED 30 /* most tracks that are drawn with markers on their lines */
#define LABEL_WIDTH_PIXELS 30.0
#define LABEL_HEIGHT_PIXELS 15.0
#define ARROW_PIXELS 45.0  /* longest arrow, that of the fastest track */
#define ELLIPSE_PIXELS 2.0 /* smallest ellipse drawn: smaller ones would look like dots */
#define ELLIPSE_SIGMAS 2.0
#define WORDS_BYTES 160

static struct map start_map_of_all_data(const struct picture *picture,
                                        const struct picture_data *data)
{
    struct map_box box = map_box_empty();
    map_box_include_points(&box, &data->plots);
    map_box_include_points(&box, &data->tracks);
    map_box_include_points(&box, &data->truth);
    map_box_include_radars(&box, data);
    const struct plot_points sensors = {data->bearings.sensors, data->bearings.num_sensors};
    map_box_include_points(&box, &sensors);
    return map_start(picture, box);
}

/*
 * Time span of all data as text, such as ", 67 s from t_s = 3 on"; empty where nothing has a time.
 */
static const char *format_time_span(const struct picture_data *data, char text[WORDS_BYTES])
{
    int64_t from_us = INT64_MAX, to_us = INT64_MIN;
    const struct plot_points *const all[] = {&data->plots, &data->tracks, &data->truth};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
        for (size_t i = 0; i < all[k]->count; i++) {
            const int64_t time_us = all[k]->list[i].time_us;
            from_us = time_us < from_us ? time_us : from_us;
            to_us = time_us > to_us ? time_us : to_us;
        }
    }
    for (size_t i = 0; i < data->bearings.count; i++) {
        const int64_t time_us = data->bearings.list[i].time_us;
        from_us = time_us < from_us ? time_us : from_us;
        to_us = time_us > to_us ? time_us : to_us;
    }
    text[0] = '\0';
    if (from_us <= to_us) {
        const double span_s = ((double)to_us - (double)from_us) * 1e-6;
        snprintf(text, WORDS_BYTES,
                 span_s < 9999.5 ? ", %.4g s from t_s = %.15g on" : ", %.0f s from t_s = %.15g on",
                 span_s, round((double)from_us * 1e-5) * 0.1);
    }
    return text;
}

/*
 * Number of plots or bearings as text: "1526 plots", "48 bearings" or "20000 of 1000000 plots
 * drawn".
 */
static const char *format_plot_count(const struct picture_data *data, char text[WORDS_BYTES])
{
    const size_t count = data->plots.count, drawn = map_num_plots_drawn(count);
    if (count == 0 && data->bearings.count > 0) {
        snprintf(text, WORDS_BYTES, "%zu bearings", data->bearings.count);
    } else if (drawn < count) {
        snprintf(text, WORDS_BYTES, "%zu of %zu plots drawn", drawn, count);
    } else {
        snprintf(text, WORDS_BYTES, "%zu plots", count);
    }
    return text;
}

void plot_scans_coloured_by_time(struct picture *picture, const struct picture_data *data)
{
    const struct map map = start_map_of_all_data(picture, data);
    const size_t drawn = map_num_plots_drawn(data->plots.count);
    char plots[WORDS_BYTES], times[WORDS_BYTES], time[WORDS_BYTES];
    picture_data_write_time_label(data, time, sizeof time);
    picture_set_title(picture, "%s%s", format_plot_count(data, plots),
                      format_time_span(data, times));
    map_write_sampled_plots(&map, &data->plots, picture_data_time_origin_us(data));
    map_write_range_rings(&map, data->radars, data->num_radars);
    fprintf(map.script,
            "set cblabel '%s'\nset palette defined (0 '#00204d', 0.5 '#7c7b78', 1 '#ffd940')\n"
            "plot NaN notitle",
            time);
    map_draw_range_rings(&map, data->radars, data->num_radars);
    fprintf(map.script, ", \\\n $plots using 1:2:3 with points pt 7 ps %.2f lc palette notitle\n",
            0.45 - 0.25 * fmin(1.0, sqrt((double)drawn / MAP_PLOTS_MAX)));
}

/*
 * Writes the line that started each track: back from its first row with its first velocity, to the
 * time of the first plot or for at most six scans.
 */
static void put_tracks_before_start(const struct map *map, const struct picture_data *data)
{
    struct plot_points one;
    size_t at = 0;
    int64_t first_us = data->plots.count ? data->plots.list[0].time_us : INT64_MAX;
    fprintf(map->script, "$starts << EOD\n");
    while (picture_data_next_identity(&data->tracks, &at, &one)) {
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
        map_write_point(map, &origin, 0);
        map_write_point(map, start, 0);
        fprintf(map->script, "\n\n");
    }
    fprintf(map->script, "EOD\n");
}

static bool do_labels_overlap(const struct map *map, const struct plot_point *one,
                              const struct plot_point *other)
{
    return fabs(one->x_m - other->x_m) * map->pixels_per_m < LABEL_WIDTH_PIXELS &&
           fabs(one->y_m - other->y_m) * map->pixels_per_m < LABEL_HEIGHT_PIXELS;
}

/* Labels the ends of tracks with their ids, except where a label would overlap another. */
static void put_track_labels(const struct map *map, const struct plot_points *tracks)
{
    struct plot_points one;
    struct plot_point *labelled = must_calloc(tracks->count + 1, sizeof *labelled);
    size_t at = 0, count = 0;
    while (picture_data_next_identity(tracks, &at, &one)) {
        const struct plot_point *end = &one.list[one.count - 1];
        size_t i = 0;
        while (i < count && !do_labels_overlap(map, end, &labelled[i])) {
            i++;
        }
        if (i == count) {
            labelled[count++] = *end;
            fprintf(map->script, "set label '%d' at %.6g,%.6g offset 0.7,0.5 front font ',12'\n",
                    end->id, end->x_m / map->unit_m, end->y_m / map->unit_m);
        }
    }
    free(labelled);
}

/* Seconds of motion that an arrow shows: the fastest track's arrow is at most ARROW_PIXELS long. */
static double arrow_time_s(const struct map *map, const struct plot_points *tracks)
{
    struct plot_points one;
    size_t at = 0;
    double fastest_mps = 0.0;
    while (picture_data_next_identity(tracks, &at, &one)) {
        const struct plot_point *end = &one.list[one.count - 1];
        fastest_mps = fmax(fastest_mps, hypot(end->vx_mps, end->vy_mps));
    }
    return fastest_mps > 0.0
               ? map_round_down_to_1_2_5(ARROW_PIXELS / map->pixels_per_m / fastest_mps)
               : 0.0;
}

static void put_arrows_and_ellipses(const struct map *map, const struct plot_points *tracks)
{
    const double time_s = arrow_time_s(map, tracks);
    struct plot_points one;
    size_t at = 0, index = 0;
    while (picture_data_next_identity(tracks, &at, &one)) {
        const struct plot_point *end = &one.list[one.count - 1];
        const double x = end->x_m / map->unit_m, y = end->y_m / map->unit_m;
        struct plot_ellipse ellipse;
        fprintf(map->script,
                "set arrow from %.6g,%.6g rto %.6g,%.6g head filled size screen 0.006,18 lw 1.2 lc "
                "rgb '%s' front\n",
                x, y, end->vx_mps * time_s / map->unit_m, end->vy_mps * time_s / map->unit_m,
                picture_colour(index));
        if (picture_data_sigma_ellipse(end, &ellipse) &&
            ELLIPSE_SIGMAS * ellipse.major_m * map->pixels_per_m >= ELLIPSE_PIXELS) {
            const double axes = 2.0 * ELLIPSE_SIGMAS / map->unit_m;
            fprintf(map->script,
                    "set object ellipse center %.6g,%.6g size %.6g,%.6g angle %.6g units xx front "
                    "fs empty border rgb '%s' lw 1\n",
                    x, y, axes * ellipse.major_m, axes * ellipse.minor_m,
                    ellipse.angle_rad * 180.0 / M_PI, picture_colour(index));
        }
        index++;
    }
}

/* Legend clause of track number `index`: a title for each track, or with `many` one for all. */
static void format_track_legend(char *title, size_t size, int32_t id, size_t index, bool many)
{
    if (!many) {
        snprintf(title, size, "title 'track %d'", id);
    } else {
        snprintf(title, size, "%s", index == 0 ? "title 'tracks'" : "notitle");
    }
}

static void draw_track_lines(const struct map *map, const struct plot_points *tracks)
{
    struct plot_points one;
    size_t at = 0, index = 0;
    const size_t ids = picture_data_count_identities(tracks);
    while (picture_data_next_identity(tracks, &at, &one)) {
        char title[40];
        format_track_legend(title, sizeof title, one.list[0].id, index, ids > PLOT_LEGEND_MAX);
        fprintf(map->script, ", \\\n $tracks index %zu using 1:2 with ", index);
        if (ids <= TRACKS_MARKED) {
            fprintf(map->script, "linespoints pt %d ps 0.55 pi %zu", picture_marker(index),
                    map_points_between_markers(map, &one));
        } else {
            fprintf(map->script, "lines");
        }
        fprintf(map->script, " lw 1.3 lc rgb '%s' %s", picture_colour(index), title);
        index++;
    }
}

/* Draws true paths as wide transparent lines, so that tracks over them are visible. */
static void draw_truth_paths(const struct map *map, const struct plot_points *truth)
{
    if (truth->count) {
        fprintf(map->script, ", \\\n $truth using 1:2 with lines lw 3.5 lc rgb '#b0000000' title "
                             "'truth'");
    }
}

static void set_tracks_title(const struct picture *picture, const struct map *map,
                             const struct picture_data *data)
{
    char plots[WORDS_BYTES], times[WORDS_BYTES], arrows[WORDS_BYTES] = "";
    const double time_s = arrow_time_s(map, &data->tracks);
    if (time_s > 0.0) {
        snprintf(arrows, sizeof arrows, "; arrows: %g s of motion; ellipses: %g sigma", time_s,
                 ELLIPSE_SIGMAS);
    }
    picture_set_title(picture, "%zu tracks, %s%s%s", picture_data_count_identities(&data->tracks),
                      format_plot_count(data, plots), format_time_span(data, times), arrows);
}

void plot_tracks(struct picture *picture, const struct picture_data *data)
{
    const struct map map = start_map_of_all_data(picture, data);
    const bool has_bearings = data->bearings.num_sensors > 0;
    set_tracks_title(picture, &map, data);
    map_write_sampled_plots(&map, &data->plots, 0);
    map_write_points(&map, "truth", &data->truth);
    map_write_points(&map, "tracks", &data->tracks);
    map_write_range_rings(&map, data->radars, data->num_radars);
    put_tracks_before_start(&map, data);
    put_track_labels(&map, &data->tracks);
    put_arrows_and_ellipses(&map, &data->tracks);
    if (has_bearings) {
        plot_bearings_write_data(&map, &data->bearings);
    }
    fprintf(map.script, "plot NaN notitle");
    map_draw_range_rings(&map, data->radars, data->num_radars);
    if (has_bearings) {
        plot_bearings_draw_rays(&map, &data->bearings);
        plot_bearings_draw_sensors(&map, &data->bearings);
    }
    map_draw_plots(&map, &data->plots);
    draw_truth_paths(&map, &data->truth);
    if (data->tracks.count) {
        fprintf(map.script, ", \\\n $starts using 1:2 with lines lw 1 dt 3 lc rgb '#444444' "
                            "title 'line that started a track'");
    }
    draw_track_lines(&map, &data->tracks);
    fprintf(map.script, "\n");
}
