/* SPDX-License-Identifier: MIT */
#include "asterix_text.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "asterix_file.h"
#include "common.h"

#define HOLD_S 5.0 /* waiting costs nothing in a file */

/* A row, ready to be written. */
struct line {
    int64_t time_128;
    uint64_t order;
    char *text;
};

struct asterix_text {
    char *path;
    struct asterix_file *file;
    struct asterix_scans *scans;
    struct asterix_columns columns;
    struct line *lines; /* by time from `next` on */
    size_t count, capacity, next;
    uint64_t order, late;
    int64_t given_128; /* the newest row's that was given out */
    bool has_header, has_given, is_over;
    bool has_interval; /* plots of radars without crossings become scans here */
    int32_t placeless[ASTERIX_MAX_SENSORS]; /* radars whose place nobody says, beside others */
    size_t num_placeless;
};

const char asterix_text_no_tracks[] =
    "tracks (CAT062), which are written and not read: give their CSV file or LCM log";

/* ---- Looking at the file ---- */

/* What a record tells of the whole file. */
static bool note(struct asterix_text *text, const struct asterix_record *record)
{
    struct asterix_service service;
    struct asterix_plot plot;

    asterix_scans_look(text->scans, record);
    if (record->category == ASTERIX_PLOTS) {
        asterix_plot_read(record, &plot);
        return plot.has_position;
    }
    asterix_service_read(record, &service);
    text->columns.has_place |= service.place.is_given;
    text->columns.has_scan |=
        service.has_type && (service.type == ASTERIX_NORTH || service.type == ASTERIX_SECTOR);
    return service.has_type && service.has_time;
}

static void look_through(struct asterix_text *text, bool keep_going)
{
    struct asterix_file *file = asterix_file_open(text->path, keep_going);
    struct asterix_record record;
    bool has_any = false;

    while (asterix_file_next(file, &record)) {
        has_any |= note(text, &record);
    }
    if (!has_any && asterix_file_others(file, ASTERIX_TRACKS) > 0) {
        fail(EXIT_USAGE, "%s: %s", text->path, asterix_text_no_tracks);
    }
    if (!has_any) {
        fail(EXIT_USAGE,
             "%s: not one plot (CAT048), north marker or sector crossing (CAT034) in it",
             text->path);
    }
    asterix_file_close(file);
}

/* A radar whose place nobody says stands at the origin, which is right of one radar alone and without places on the earth. */
static void find_placeless(struct asterix_text *text, const struct parameters *parameters)
{
    size_t count = asterix_scans_num_sensors(text->scans);
    int32_t sensor_id;

    if (count < 2 && !parameters_has_origin(parameters)) {
        return;
    }
    for (size_t i = 0; i < count; i++) {
        if (!asterix_scans_sensor(text->scans, i, &sensor_id) &&
            isnan(parameters_of_sensor(parameters, sensor_id, SENSOR_X_M, NAN))) {
            text->placeless[text->num_placeless++] = sensor_id;
        }
    }
}

struct asterix_text *asterix_text_open(const char *path, const struct parameters *parameters,
                                       bool keep_going)
{
    struct asterix_rules rules = {.hold_s = HOLD_S};
    struct asterix_text *text = must_calloc(1, sizeof *text);

    if (parameters) {
        rules = asterix_text_rules(parameters, HOLD_S, 0);
    }
    text->path = must_copy(path);
    text->columns.has_scan = rules.interval_s > 0;
    text->has_interval = rules.interval_s > 0;
    text->scans = asterix_scans_open(&rules);
    look_through(text, keep_going);
    if (parameters) {
        find_placeless(text, parameters);
    }
    text->file = asterix_file_open(path, keep_going);
    return text;
}

/* ---- Rows ---- */

static void add_row(struct asterix_text *text, const struct asterix_scan *scan,
                    const struct asterix_mark *mark)
{
    int64_t time_128 = mark ? mark->time_128 : scan->time_128;
    char line[ASTERIX_LINE_BYTES];

    if (text->has_given && time_128 < text->given_128) {
        text->late++;
        return;
    }
    asterix_text_row(&text->columns, scan, mark, line);
    text->lines = must_grow(text->lines, text->count, &text->capacity, sizeof *text->lines);
    text->lines[text->count++] =
        (struct line){.time_128 = time_128, .order = text->order++, .text = must_copy(line)};
}

static void add_scan(struct asterix_text *text, const struct asterix_scan *scan)
{
    if (scan->is_numbered) {
        add_row(text, scan, NULL);
    }
    for (size_t i = 0; i < scan->count; i++) {
        add_row(text, scan, &scan->marks[i]);
    }
}

static int by_time(const void *a, const void *b)
{
    const struct line *one = a, *other = b;
    int order = (one->time_128 > other->time_128) - (one->time_128 < other->time_128);

    return order ? order : (one->order > other->order) - (one->order < other->order);
}

/* What is given out goes; what is new comes to its place. */
static void add_scans(struct asterix_text *text)
{
    struct asterix_scan scan;
    size_t before = text->count;

    while (asterix_scans_next(text->scans, &scan)) {
        if (text->next > 0) {
            text->count -= text->next;
            memmove(text->lines, text->lines + text->next, text->count * sizeof *text->lines);
            text->next = 0;
            before = 0;
        }
        add_scan(text, &scan);
    }
    if (text->count != before) {
        qsort(text->lines, text->count, sizeof *text->lines, by_time);
    }
}

static void report(const struct asterix_text *text)
{
    const struct asterix_counts *counts = asterix_scans_counts(text->scans);

    asterix_file_report(text->file);
    asterix_text_report(text->path, counts);
    for (size_t i = 0; i < text->num_placeless; i++) {
        fprintf(stderr,
                "rhotrack: %s: sensor %" PRId32 " does not say where it stands, and is taken to be "
                "at the origin; sensor.%" PRId32 ".lat_deg and lon_deg say it\n",
                text->path, text->placeless[i], text->placeless[i]);
    }
    if (text->late > 0) {
        fprintf(stderr,
                "rhotrack: %s: %" PRIu64 " rows of a radar whose clock is behind left out\n",
                text->path, text->late);
    }
    if (!text->columns.has_scan) {
        fprintf(stderr,
                "rhotrack: %s: no north markers or sector crossings in it: plots of one time are a "
                "scan, but for scan_interval_s\n",
                text->path);
    }
}

/* One record more, or the end. */
static void take_record(struct asterix_text *text)
{
    struct asterix_record record;

    if (asterix_file_next(text->file, &record)) {
        asterix_scans_take(text->scans, &record);
    } else {
        asterix_scans_finish(text->scans);
        text->is_over = true;
    }
    add_scans(text);
    if (text->is_over) {
        report(text);
    }
}

/* A row that nothing can come before any more. */
static bool has_line(const struct asterix_text *text)
{
    return text->next < text->count &&
           (text->is_over ||
            text->lines[text->next].time_128 < asterix_scans_settled_128(text->scans));
}

bool asterix_text_next(struct asterix_text *text, char line[ASTERIX_LINE_BYTES], size_t *length)
{
    struct line *row;

    if (!text->has_header) {
        text->has_header = true;
        asterix_text_header(&text->columns, line);
        *length = strlen(line);
        return true;
    }
    while (!has_line(text)) {
        if (text->is_over) {
            return false;
        }
        take_record(text);
    }
    row = &text->lines[text->next++];
    text->has_given = true;
    text->given_128 = row->time_128;
    *length = strlen(row->text);
    memcpy(line, row->text, *length + 1);
    free(row->text);
    return true;
}

uint64_t asterix_text_position(const struct asterix_text *text)
{
    return asterix_file_position(text->file);
}

void asterix_text_close(struct asterix_text *text)
{
    if (!text) {
        return;
    }
    for (size_t i = text->next; i < text->count; i++) {
        free(text->lines[i].text);
    }
    free(text->lines);
    asterix_scans_close(text->scans);
    asterix_file_close(text->file);
    free(text->path);
    free(text);
}
