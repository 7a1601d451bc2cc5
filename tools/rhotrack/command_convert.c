/* SPDX-License-Identifier: MIT */
/*
 * convert: CSV file to LCM log, log messages of one kind to CSV, tracks to GeoJSON or ASTERIX
 * CAT062, and ASTERIX recordings to CSV, LCM log or GeoJSON.
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/common.h"
#include "commands.h"
#include "io/asterix/asterix_file.h"
#include "io/asterix/asterix_plot_rows.h"
#include "io/asterix/asterix_track_table.h"
#include "io/asterix/asterix_track_writer.h"
#include "io/csv/csv_table.h"
#include "io/log/lcm_log.h"
#include "io/log/message_source.h"
#include "io/output/geojson_rows.h"
#include "io/output/geojson_tracks_writer.h"
#include "io/rows/rows_from_csv.h"
#include "io/rows/rows_from_messages.h"
#include "io/rows/rows_to_csv.h"

static bool may_be_regular_file(const char *path)
{
    struct stat status;

    return stat(path, &status) ||
           S_ISREG(status.st_mode); /* a missing file counts as regular: the reader reports it */
}

/* An input that cannot be looked into (a pipe) is taken for a log where the output is NAME.csv. */
static bool is_lcm_log_or_pipe_to_csv(const char *input, const char *output)
{
    return lcm_log_is_log(input) ||
           (!may_be_regular_file(input) && !path_ends_with(input, ".csv") &&
            path_ends_with(output, ".csv"));
}

/* Exit 2 where the input is not a CSV table. */
static void check_input_is_table(const char *input)
{
    table_free(table_read_header(input));
}

/*
 * Exit 2 where the ending of the output's name says that it gets the input's own format. Any other
 * name, and standard output, get the other format.
 */
static void check_output_format_differs(const char *input, const char *output, bool from_log)
{
    if (path_ends_with(output, from_log ? ".lcm" : ".csv")) {
        if (!from_log) {
            check_input_is_table(input);
        }
        fail(EXIT_USAGE,
             "convert: %s would be %s, the format of the input; CSV files end with .csv, LCM logs "
             "with .lcm",
             output, from_log ? "an LCM log" : "a CSV file");
    }
}

static void write_messages_to_log(struct message_source *source, const struct command_line *line)
{
    const char *path = line->arguments[1];
    struct output output = output_open(path);
    struct lcm_log_writer writer = {.file = output.file};
    struct message_event event;

    if (isatty(fileno(output.file))) {
        fail(EXIT_USAGE, "convert: an LCM log is not written on a terminal; name a file NAME.lcm");
    }
    while (message_source_next(source, &event)) {
        lcm_log_must_write(&writer, path, event.utime, event.channel, event.data, event.size);
    }
    output_close(&output);
}

static void convert_table_to_log(const struct command_line *line)
{
    struct message_source *source =
        message_source_open(line->arguments, 1, &line->parameters, line->keep_going);

    if (line->kind) {
        fail(EXIT_USAGE, "convert: --kind chooses messages of a log, and %s is a CSV file",
             line->arguments[0]);
    }
    write_messages_to_log(source, line);
    message_source_report_skipped(source);
    message_source_close(source);
}

static void convert_asterix_plots_to_csv(const struct command_line *line)
{
    const char *path = line->arguments[0];
    struct asterix_plot_rows *records =
        asterix_plot_rows_open(path, &line->parameters, line->keep_going);
    struct table *table = asterix_plot_rows_empty_table(path, asterix_plot_rows_columns(records));
    struct output output = output_open(line->arguments[1]);
    struct progress progress = progress_start("rows", 0);
    uint64_t bytes = regular_file_size_or_zero(path), rows = 0;

    table_write_header(output.file, table);
    while (asterix_plot_rows_next(records, table)) {
        table_write_row(output.file, table, 0);
        table->num_rows = 0;
        progress_show_by_bytes(&progress, ++rows, asterix_plot_rows_position(records), bytes);
    }
    progress_end(&progress);
    output_close(&output);
    table_free(table);
    asterix_plot_rows_close(records);
}

static void convert_asterix_tracks_to_csv(const struct command_line *line)
{
    struct table *table =
        asterix_track_table_read(line->arguments[0], &line->parameters, line->keep_going);
    struct output output = output_open(line->arguments[1]);

    table_write_header(output.file, table);
    for (size_t row = 0; row < table->num_rows; row++) {
        table_write_row(output.file, table, row);
    }
    output_close(&output);
    table_free(table);
}

/* Writes a log's track lists as ASTERIX CAT062 records; other messages are counted and reported. */
static void convert_tracks_to_asterix(const struct command_line *line)
{
    const char *input = line->arguments[0];
    struct message_source *source =
        message_source_open(line->arguments, 1, &line->parameters, line->keep_going);
    struct output output = output_open(line->arguments[1]);
    struct asterix_track_writer *tracks = asterix_track_writer_open(output.file, &line->parameters);
    struct message_event event;
    struct rho_message_track_list message;
    uint64_t lists = 0, others = 0;

    while (message_source_next(source, &event)) {
        if (strcmp(event.channel, RHO_MESSAGE_TRACK_LIST_CHANNEL) == 0 &&
            rho_message_track_list_decode(event.data, event.size, &message) == RHO_OK) {
            asterix_track_writer_add(tracks, &message);
            lists++;
        } else {
            others++;
        }
    }
    if (lists == 0) {
        fail(EXIT_USAGE, "%s: contains no tracks, and CAT062 holds only tracks", input);
    }
    asterix_track_writer_free(tracks);
    output_close(&output);
    if (others > 0) {
        fprintf(stderr, "rhotrack: %s: %" PRIu64 " other messages left out\n", input, others);
    }
    message_source_report_skipped(source);
    message_source_close(source);
}

struct reading {
    const struct command_line *line;
    const char *path;
    /* kind of rows that are written: of --kind, or of the first message; NULL: none yet */
    const struct rows_kind *kind;
    struct rows_collection collection;
    uint64_t num_messages[NUM_ROWS_KINDS]; /* messages on the channels of each kind of rows */
    uint64_t others;
};

static const struct rows_kind *must_find_rows_kind(const char *name)
{
    for (int i = 0; i < NUM_ROWS_KINDS; i++) {
        if (strcmp(name, rows_kinds[i]->name) == 0) {
            return rows_kinds[i];
        }
    }
    fail(EXIT_USAGE, "convert: --kind '%s' is none of plots, polar, bearings, truth, tracks", name);
}

static void start_rows_of_kind(struct reading *reading, const struct rows_kind *kind)
{
    reading->kind = kind;
    rows_from_messages_start(&reading->collection, kind);
    reading->collection.with_received = true;
}

static void add_rows_of_log_event(struct reading *reading, const struct lcm_log_event *event)
{
    const struct rows_kind *kind = rows_kind_of_channel(event->channel);

    if (!kind) {
        reading->others++;
        return;
    }
    for (int i = 0; i < NUM_ROWS_KINDS; i++) {
        reading->num_messages[i] += rows_kinds[i] == kind;
    }
    if (!reading->kind) {
        start_rows_of_kind(reading, kind);
    }
    rows_from_messages_add_event(&reading->collection, reading->path, event,
                                 reading->line->keep_going);
}

/* Messages by kind as a text: "12 plots, 3 truth". */
static const char *list_kinds_found(const struct reading *reading, char *text, size_t bytes)
{
    size_t length = 0;

    *text = '\0';
    for (int i = 0; i < NUM_ROWS_KINDS; i++) {
        if (reading->num_messages[i] > 0) {
            length +=
                (size_t)snprintf(text + length, bytes - length, "%s%" PRIu64 " %s",
                                 length ? ", " : "", reading->num_messages[i], rows_kinds[i]->name);
        }
    }
    return text;
}

/*
 * Exit 2 where the log lacks messages of the wanted kind, or has several kinds without --kind. Adds
 * the messages of other kinds to the count of messages left out.
 */
static void check_one_kind(struct reading *reading)
{
    char text[200];
    int kinds = 0;

    for (int i = 0; i < NUM_ROWS_KINDS; i++) {
        kinds += reading->num_messages[i] > 0;
    }
    list_kinds_found(reading, text, sizeof text);
    if (kinds == 0) {
        fail(EXIT_USAGE,
             "%s: contains no messages of plots, polar plots, bearings, truth or tracks; %" PRIu64
             " on other channels",
             reading->path, reading->others);
    }
    if (reading->line->kind && reading->collection.count == 0 &&
        reading->collection.messages_bad == 0) {
        fail(EXIT_USAGE, "%s: contains no messages of %s, but %s", reading->path,
             reading->kind->name, text);
    }
    if (!reading->line->kind && kinds > 1) {
        fail(EXIT_USAGE,
             "%s: contains several kinds of messages, and a CSV file holds one (%s): choose by "
             "--kind",
             reading->path, text);
    }
    for (int i = 0; i < NUM_ROWS_KINDS; i++) {
        reading->others += rows_kinds[i] == reading->kind ? 0 : reading->num_messages[i];
    }
}

static void print_left_out_counts(const struct reading *reading, const struct lcm_log_reader *log)
{
    lcm_log_report_skipped(log);
    print_count_unless_zero(reading->path, reading->collection.messages_bad,
                            "bad messages skipped");
    print_count_unless_zero(reading->path, reading->others, "messages on other channels left out");
    print_count_unless_zero(reading->path, reading->collection.messages_again,
                            "repeated messages left out");
    print_count_unless_zero(reading->path, reading->collection.scans_incomplete,
                            "scans or lists lack parts");
    print_count_unless_zero(reading->path, reading->collection.lists_empty,
                            "lists without elements have no row");
}

static void convert_log_to_csv(const struct command_line *line)
{
    struct reading reading = {.line = line, .path = line->arguments[0]};
    struct lcm_log_reader *log;
    struct lcm_log_event event;
    struct output output;

    if (line->kind) {
        start_rows_of_kind(&reading, must_find_rows_kind(line->kind));
    }
    log = lcm_log_open(reading.path);
    while (lcm_log_next(log, &event)) {
        add_rows_of_log_event(&reading, &event);
    }
    if (lcm_log_counts(log).events == 0) {
        fail(EXIT_USAGE, "%s: contains no event of an LCM log", reading.path);
    }
    check_one_kind(&reading);
    rows_from_messages_sort(&reading.collection);
    if (reading.collection.rows.count == 0) {
        fail(EXIT_USAGE, "%s: its messages of %s have no rows", reading.path, reading.kind->name);
    }
    output = output_open(line->arguments[1]);
    if (geojson_path_is_geojson(line->arguments[1])) {
        geojson_write_rows(output.file, &reading.collection.rows, &line->parameters);
    } else {
        rows_write_csv(output.file, &reading.collection.rows, line->covariance);
    }
    output_close(&output);
    print_left_out_counts(&reading, log);
    rows_from_messages_free(&reading.collection);
    lcm_log_close(log);
}

static void convert_tracks_to_geojson(const struct command_line *line)
{
    struct rows_file file;
    struct output output;

    rows_read_csv_or_asterix(&file, line->arguments[0], &line->parameters, line->keep_going);
    if (file.rows.kind != &rows_kind_tracks) {
        fail(EXIT_USAGE, "%s: these are %s; GeoJSON is made of tracks", line->arguments[0],
             file.rows.kind->name);
    }
    output = output_open(line->arguments[1]);
    geojson_write_rows(output.file, &file.rows, &line->parameters);
    output_close(&output);
    print_rows_skipped(file.rows_skipped);
    rows_file_free(&file);
}

/* Only tracks can be written as GeoJSON: other kinds and --covariance exit 2; selects the kind. */
static void set_kind_for_geojson(struct command_line *line)
{
    if (line->covariance) {
        fail(EXIT_USAGE, "convert: GeoJSON cannot hold covariances (--covariance)");
    }
    if (line->kind && strcmp(line->kind, rows_kind_tracks.name) != 0) {
        fail(EXIT_USAGE, "convert: --kind %s: GeoJSON is made of tracks", line->kind);
    }
    line->kind = rows_kind_tracks.name;
}

void convert_refuse_radar(const struct command_line *line)
{
    const char *input = line->arguments[0], *output = line->arguments[1];
    bool to_map = geojson_path_is_geojson(output);

    if ((to_map || asterix_track_writer_is_path(output)) && asterix_file_is_asterix(input) &&
        !asterix_file_has_only_tracks(input)) {
        check_input_is_table(input);
        fail(EXIT_USAGE, "%s: a recording of radar plots, not of tracks; %s is made of tracks",
             input, to_map ? "GeoJSON" : "CAT062");
    }
}

int command_convert(struct command_line *line)
{
    bool from_log = is_lcm_log_or_pipe_to_csv(line->arguments[0], line->arguments[1]);
    bool to_map = geojson_path_is_geojson(line->arguments[1]);

    parameters_check_together(&line->parameters);
    output_refuse_other_format(line->arguments[1], "NAME.csv, NAME.lcm, NAME.geojson and NAME.ast");
    if (asterix_track_writer_is_path(line->arguments[1])) {
        asterix_track_writer_check(line->arguments[1], line->covariance);
        convert_tracks_to_asterix(line);
        return 0;
    }
    if (asterix_file_is_asterix(line->arguments[0]) &&
        !path_ends_with(line->arguments[1], ".lcm")) {
        if (line->kind) {
            fail(EXIT_USAGE, "convert: --kind chooses messages of a log, and %s is in ASTERIX",
                 line->arguments[0]);
        }
        if (!asterix_file_has_only_tracks(line->arguments[0])) {
            convert_asterix_plots_to_csv(line);
            return 0;
        }
        if (!to_map) {
            convert_asterix_tracks_to_csv(line);
            return 0;
        }
    }
    check_output_format_differs(line->arguments[0], line->arguments[1], from_log);
    if (to_map) {
        set_kind_for_geojson(line);
    }
    if (to_map && !from_log) {
        convert_tracks_to_geojson(line);
    } else if (from_log) {
        convert_log_to_csv(line);
    } else {
        convert_table_to_log(line);
    }
    return 0;
}
