/* SPDX-License-Identifier: MIT */
/* plot: pictures of plots, tracks, errors, the parameter space of lines, and clutter maps. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "command_line.h"
#include "commands.h"
#include "io/output/clutter_map_file.h"
#include "picture/gnuplot_picture_file.h"
#include "picture/interactive_map_page.h"
#include "picture/picture_data.h"
#include "picture/plot_bearings.h"
#include "picture/plot_by_time.h"
#include "picture/plot_clutter_map.h"
#include "picture/plot_errors.h"
#include "picture/plot_parameter_space.h"
#include "picture/plot_votes.h"

static void require_points(const struct plot_points *points, const char *kind, const char *what)
{
    if (points->count == 0) {
        fail(EXIT_USAGE, "plot %s: no file with %s is given", kind, what);
    }
}

/*
 * Exit 2 where the data have no times but the truth's, at which the slider of an HTML page stops.
 */
static void check_page_has_data(const struct picture_data *data)
{
    if (data->plots.count + data->tracks.count + data->bearings.count == 0) {
        fail(EXIT_USAGE, "plot: a page needs plots, tracks or bearings beside the truth; "
                         "-o NAME.svg or NAME.png draws truth alone");
    }
}

static void check_data_for_kind(const char *kind, const struct picture_data *data)
{
    const bool shows_bearings = strcmp(kind, "scans") == 0 || strcmp(kind, "tracks") == 0;
    if (data->bearings.has_own_file && !shows_bearings) {
        fail(
            EXIT_USAGE,
            "plot %s: bearings (column 'bearing_rad') are shown only by plot scans and plot tracks",
            kind);
    }
    if (shows_bearings && data->bearings.num_sensors) {
        return;
    }
    if (strcmp(kind, "scans") == 0 || strcmp(kind, "parameter-space") == 0) {
        require_points(&data->plots, kind, "plots (t_s, x_m, y_m)");
    } else if (strcmp(kind, "errors") == 0) {
        require_points(&data->truth, kind, "truth (target_id)");
    } else if (strcmp(kind, "tracks") != 0) {
        fail(
            EXIT_USAGE,
            "plot: no picture '%s'; there are: scans, tracks, parameter-space, errors, clutter-map",
            kind);
    } else if (data->plots.count + data->tracks.count + data->truth.count == 0) {
        fail(EXIT_USAGE, "plot tracks: the files hold nothing to draw");
    }
}

/*
 * Results that are computed before the picture is opened, so that bad input leaves no part of it.
 */
struct drawn_results {
    struct revolutions revolutions;
    struct plot_errors errors;
    struct plot_votes *votes; /* accumulator of --method; NULL: no method */
};

static void compute_votes_of_method(struct drawn_results *results, const struct picture_data *data,
                                    struct command_line *line)
{
    const enum method method = method_must_find(line->method);

    if (method == METHOD_KERNEL || method_takes_bearings(method)) {
        fail(EXIT_USAGE,
             "plot parameter-space: %s has no accumulator of plots; ht, mht, iht and "
             "nht have one",
             method_name(method));
    }
    method_suggest_parameters(method, &line->parameters);
    results->revolutions = plot_parameter_space_read(
        data, &line->parameters, (size_t)line->parameters.value[PARAMETER_SCANS]);
    results->votes = plot_votes_compute_pictures(method, &results->revolutions, &line->parameters);
}

/* Computes the errors or the votes that the picture shows. */
static struct drawn_results compute_drawing(const char *kind, const struct picture_data *data,
                                            struct command_line *line)
{
    const struct parameters *parameters = &line->parameters;
    struct drawn_results results = {.revolutions = {.count = 0}};
    if (strcmp(kind, "errors") == 0) {
        results.errors = plot_errors_find(data, parameters);
    } else if (strcmp(kind, "parameter-space") == 0 && line->method) {
        compute_votes_of_method(&results, data, line);
    } else if (strcmp(kind, "parameter-space") == 0) {
        results.revolutions = plot_parameter_space_read(data, parameters, RHO_MAX_SCANS);
    }
    return results;
}

static void draw_picture_of_kind(const char *kind, struct picture *picture,
                                 const struct picture_data *data,
                                 const struct drawn_results *results)
{
    if (strcmp(kind, "scans") == 0 && data->bearings.num_sensors) {
        plot_bearings(picture, data);
    } else if (strcmp(kind, "scans") == 0) {
        plot_scans_coloured_by_time(picture, data);
    } else if (strcmp(kind, "tracks") == 0) {
        plot_tracks(picture, data);
    } else if (strcmp(kind, "errors") == 0) {
        plot_errors(picture, data, &results->errors);
    } else if (results->votes) {
        plot_votes(picture, results->votes);
    } else {
        plot_hough_votes(picture, data, &results->revolutions);
    }
}

/* Draws the clutter map, over the plots of further files. */
static int plot_clutter_map(const struct command_line *line)
{
    size_t count;
    struct clutter_echo *echoes =
        clutter_map_file_read_echoes(line->arguments[1], &line->parameters, &count);
    struct picture_data data =
        picture_data_read(line->arguments + 2, line->num_arguments - 2, &line->parameters);
    if (line->num_arguments > 2) {
        require_points(&data.plots, "clutter-map", "plots (t_s, x_m, y_m)");
    }
    struct picture picture = picture_open(line->output, 1000, 900);
    plot_clutter(&picture, echoes, count, &data, &line->parameters);
    picture_draw_and_close(&picture);
    free(echoes);
    picture_data_free(&data);
    return 0;
}

int command_plot(struct command_line *line)
{
    if (line->num_arguments < 2 || !line->output) {
        fail(EXIT_USAGE, "plot: give a picture (scans, tracks, parameter-space, errors, "
                         "clutter-map), files, and -o NAME.svg, NAME.png or NAME.html");
    }
    const char *kind = line->arguments[0];
    const bool is_map = strcmp(kind, "scans") == 0 || strcmp(kind, "tracks") == 0;
    if (html_page_path_is_html(line->output) && !is_map) {
        fail(EXIT_USAGE,
             "%s: only plot scans and plot tracks make a page; plot %s makes NAME.svg or NAME.png",
             line->output, kind);
    }
    picture_check_path(line->output);
    refuse_output_that_is_an_input(line);
    if (line->method && strcmp(kind, "parameter-space") != 0) {
        fail(EXIT_USAGE, "plot %s: --method is for parameter-space", kind);
    }
    if (strcmp(kind, "clutter-map") == 0) {
        return plot_clutter_map(line);
    }
    struct picture_data data =
        picture_data_read(line->arguments + 1, line->num_arguments - 1, &line->parameters);
    check_data_for_kind(kind, &data);
    if (html_page_path_is_html(line->output)) {
        check_page_has_data(&data);
        html_page_write(line->output, &data, &line->parameters);
        picture_data_free(&data);
        return 0;
    }
    struct drawn_results results = compute_drawing(kind, &data, line);
    struct picture picture = picture_open(line->output, 1100, 680);
    draw_picture_of_kind(kind, &picture, &data, &results);
    picture_draw_and_close(&picture);
    revolutions_free(&results.revolutions);
    plot_errors_free(&results.errors);
    plot_votes_free(results.votes);
    picture_data_free(&data);
    return 0;
}
