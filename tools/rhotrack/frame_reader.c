/* SPDX-License-Identifier: MIT */
#include "frame_reader.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "bearing_row.h"
#include "common.h"
#include "frame_reader_parts.h"
#include "lcm_log.h"
#include "log_scans.h"
#include "table.h"

#define SAME_PLACE_M 1.0

bool frame_reader_is_bearings(const char *path)
{
    struct stat status;
    struct table *table;
    bool is_bearings;

    if (lcm_log_is_log(path)) {
        return log_scans_kinds(path) == LOG_HAS_BEARINGS;
    }
    if (stat(path, &status) || !S_ISREG(status.st_mode)) {
        return false; /* a pipe could not be read again */
    }
    table = table_read_header(path);
    is_bearings = bearing_columns_are_there(table);
    table_free(table);
    return is_bearings;
}

/* ---- Sensors ---- */

static struct known_sensor *find_sensor(struct frame_reader *reader, int32_t sensor_id)
{
    for (size_t i = 0; i < reader->num_sensors; i++) {
        if (reader->known[i].sensor.sensor_id == sensor_id) {
            return &reader->known[i];
        }
    }
    return NULL;
}

/* Where a sensor was named, as seen from a row of the table: the file only where it is another. */
#define WHERE_BYTES 120
static const char *where(const struct known_sensor *known, const char *path, char text[WHERE_BYTES])
{
    int length = snprintf(text, WHERE_BYTES, "%.9g, %.9g, line %u", (double)known->sensor.x_m,
                          (double)known->sensor.y_m, (unsigned)known->line);

    if (known->path != path) {
        snprintf(text + length, WHERE_BYTES - (size_t)length, " of %.60s", known->path);
    }
    return text;
}

static bool check_new_sensor(struct frame_reader *reader, const char *path,
                             const struct bearing_row *row, const struct row_check *check)
{
    char text[WHERE_BYTES];

    for (size_t i = 0; i < reader->num_sensors; i++) {
        const struct frame_sensor *other = &reader->known[i].sensor;

        if (hypot((double)row->x_m - (double)other->x_m, (double)row->y_m - (double)other->y_m) <
            SAME_PLACE_M) {
            return row_refuse(check, "sensor %d is where sensor %d is: %s", (int)row->sensor_id,
                              (int)other->sensor_id, where(&reader->known[i], path, text));
        }
    }
    return reader->num_sensors < RHO_MAX_SENSORS ||
           row_refuse(check, "sensor %d is one more than %d sensors", (int)row->sensor_id,
                      RHO_MAX_SENSORS);
}

static bool check_sensor(struct frame_reader *reader, const char *path,
                         const struct bearing_row *row, const struct row_check *check)
{
    const struct known_sensor *known = find_sensor(reader, row->sensor_id);
    char text[WHERE_BYTES];

    if (!known) {
        return check_new_sensor(reader, path, row, check);
    }
    if (row->x_m < known->sensor.x_m || row->x_m > known->sensor.x_m ||
        row->y_m < known->sensor.y_m || row->y_m > known->sensor.y_m) {
        return row_refuse(check, "sensor %d has moved: it was at %s", (int)row->sensor_id,
                          where(known, path, text));
    }
    return true;
}

/* ---- Rows to scans ---- */

/* The scan that a row belongs to: that of its number, else the sensor's newest; NULL: it begins one. */
static struct frame_entry *find_entry(const struct frame_reader *reader,
                                      const struct known_sensor *known,
                                      const struct bearing_row *row)
{
    size_t index = scan_numbers_find(&reader->numbers, row->sensor_id, &row->number);
    struct frame_entry *entry;

    if (!known || known->open == NO_ENTRY) {
        return NULL;
    }
    entry = &reader->entries[index == SCAN_NUMBERS_NONE ? known->open : index];
    return row_joins(&row->number, row->time_us, &entry->number, entry->start_us,
                     reader->interval_us)
               ? entry
               : NULL;
}

static struct known_sensor *have_sensor(struct frame_reader *reader, const char *path,
                                        uint32_t line, const struct bearing_row *row)
{
    struct known_sensor *known = find_sensor(reader, row->sensor_id);

    if (!known) {
        known = &reader->known[reader->num_sensors++];
        *known = (struct known_sensor){.sensor = {row->sensor_id, row->x_m, row->y_m},
                                       .path = path,
                                       .line = line,
                                       .open = NO_ENTRY};
    }
    return known;
}

static size_t add_entry(struct frame_reader *reader, const char *path, uint32_t line,
                        const struct bearing_row *row)
{
    reader->entries = must_grow(reader->entries, reader->num_entries, &reader->entries_capacity,
                                sizeof *reader->entries);
    reader->entries[reader->num_entries] = (struct frame_entry){
        .scan = {.time_us = row->time_us,
                 .sensor_id = row->sensor_id,
                 .x_m = row->x_m,
                 .y_m = row->y_m,
                 .sector_from_rad = row->sector_from_rad,
                 .sector_to_rad = row->sector_to_rad},
        .number = row->number,
        .path = path,
        .line = line,
        .start_us = row->time_us,
        .order = reader->num_entries,
    };
    return reader->num_entries++;
}

static void add_member(struct frame_reader *reader, size_t index, const struct bearing_row *row)
{
    reader->members = must_grow(reader->members, reader->num_members, &reader->members_capacity,
                                sizeof *reader->members);
    reader->members[reader->num_members++] =
        (struct frame_member){index, row->time_us, row->bearing};
    reader->entries[index].scan.num_bearings++;
}

static void add_row(struct frame_reader *reader, const char *path, uint32_t line,
                    const struct bearing_row *row)
{
    struct known_sensor *known = have_sensor(reader, path, line, row);
    struct frame_entry *entry = find_entry(reader, known, row);

    if (!entry) {
        known->open = add_entry(reader, path, line, row);
        scan_numbers_set(&reader->numbers, row->sensor_id, &row->number, known->open);
        entry = &reader->entries[known->open];
    }
    if (row->has_bearing) {
        add_member(reader, (size_t)(entry - reader->entries), row);
    } else if (row->number.is_given && !entry->has_time) {
        entry->has_time = true;
        entry->scan.time_us = row->time_us;
    }
}

static bool check_order(struct frame_reader *reader, const struct bearing_row *row,
                        const int64_t *last_us, const struct row_check *check)
{
    const struct frame_entry *entry = find_entry(reader, find_sensor(reader, row->sensor_id), row);
    bool is_within = row->number.is_given && entry;

    if (last_us && row->time_us < *last_us && !is_within) {
        return row_refuse(check, "time goes back from %.6f s to %.6f s", (double)*last_us * 1e-6,
                          (double)row->time_us * 1e-6);
    }
    return !entry ||
           (row->sector_from_rad == entry->scan.sector_from_rad &&
            row->sector_to_rad == entry->scan.sector_to_rad) ||
           row_refuse(check, "the sector is not that of the scan's first row");
}

static void read_table(struct frame_reader *reader, const struct table *table, const char *path)
{
    struct bearing_columns columns = bearing_columns_find(table);
    char reason[ROW_REASON_BYTES];
    struct bearing_row row;
    int64_t last_us = 0;
    bool has_last = false;

    for (size_t i = 0; i < table->num_rows; i++) {
        const struct row_check check = {.table = table, .row = i, .reason = reason};

        if (!bearing_row_read(table, &columns, i, reader->parameters, &row, reason) ||
            !check_order(reader, &row, has_last ? &last_us : NULL, &check) ||
            !check_sensor(reader, path, &row, &check)) {
            if (!reader->keep_going) {
                table_fail(table, i, "%s", reason);
            }
            reader->rows_skipped++;
            continue;
        }
        last_us = has_last && last_us > row.time_us ? last_us : row.time_us;
        has_last = true;
        add_row(reader, path, table->lines[i], &row);
    }
    if (!has_last) {
        table_fail(table, TABLE_HEADER, "not one good row after the header");
    }
}

/* ---- Logs to scans ---- */

/* The item's heading as a row; its place in the log stands for a line. */
static void add_item(struct frame_reader *reader, const char *path, uint32_t number,
                     const struct rho_bearing_scan *scan)
{
    struct bearing_row row = {.time_us = scan->time_us,
                              .sensor_id = scan->sensor_id,
                              .x_m = scan->x_m,
                              .y_m = scan->y_m,
                              .sector_from_rad = scan->sector_from_rad,
                              .sector_to_rad = scan->sector_to_rad,
                              .has_bearing = scan->num_bearings > 0};
    char reason[ROW_REASON_BYTES];
    const struct row_check check = {.reason = reason};

    if (!check_sensor(reader, path, &row, &check)) {
        if (!reader->keep_going) {
            fail(EXIT_USAGE, "%s: scan %u of bearings: %s", path, (unsigned)number, reason);
        }
        reader->rows_skipped += scan->num_bearings ? scan->num_bearings : 1;
        return;
    }
    have_sensor(reader, path, number, &row)->open = NO_ENTRY;
    for (uint32_t i = 0; i < scan->num_bearings || i == 0; i++) {
        if (scan->num_bearings > 0) {
            row.bearing = scan->bearings[i];
        }
        add_row(reader, path, number, &row);
    }
}

/* Of a log that has plots, too, their reader says what is wrong. */
static void read_log(struct frame_reader *reader, const char *path)
{
    struct log_scans scans = log_scans_read(path, reader->parameters, reader->keep_going,
                                            log_scans_kinds(path) == LOG_HAS_BEARINGS);
    uint32_t number = 0;

    for (size_t i = 0; i < scans.count; i++) {
        if (scans.items[i].kind == RHO_FEED_BEARINGS) {
            add_item(reader, path, ++number, &scans.items[i].bearings);
        }
    }
    log_scans_free(&scans);
}

/* ---- All files ---- */

static void read_path(struct frame_reader *reader, const char *path)
{
    struct table *table;

    if (lcm_log_is_log(path)) {
        read_log(reader, path);
        return;
    }
    table = table_read(path, reader->keep_going);
    table_need_rows(table);
    reader->rows_skipped += table->rows_skipped;
    for (size_t i = 0; i < reader->num_sensors; i++) {
        reader->known[i].open = NO_ENTRY;
    }
    scan_numbers_clear(&reader->numbers);
    read_table(reader, table, path);
    table_free(table);
}

void frame_reader_need_pair(const struct frame_reader *reader)
{
    if (reader->num_sensors < 2) {
        fail(EXIT_USAGE,
             "%s:%u: sensor %d is the only one: positions need bearings of two sensors or more",
             reader->known[0].path, (unsigned)reader->known[0].line,
             (int)reader->known[0].sensor.sensor_id);
    }
}

static int compare_sensors(const void *a, const void *b)
{
    const struct frame_sensor *first = a, *second = b;

    return (first->sensor_id > second->sensor_id) - (first->sensor_id < second->sensor_id);
}

static void sort_sensors(struct frame_reader *reader)
{
    for (size_t i = 0; i < reader->num_sensors; i++) {
        reader->sensors[i] = reader->known[i].sensor;
    }
    qsort(reader->sensors, reader->num_sensors, sizeof *reader->sensors, compare_sensors);
}

struct frame_reader *frame_reader_open(char *const *paths, int num_paths,
                                       const struct parameters *parameters, bool keep_going)
{
    struct frame_reader *reader = must_calloc(1, sizeof *reader);

    reader->parameters = parameters;
    reader->keep_going = keep_going;
    reader->interval_us = llround(parameters->value[PARAMETER_SCAN_INTERVAL_S] * 1e6);
    reader->tolerance_us = llround(parameters->value[PARAMETER_FRAME_TOLERANCE_S] * 1e6);
    for (int i = 0; i < num_paths; i++) {
        read_path(reader, paths[i]);
    }
    sort_sensors(reader);
    frame_reader_place_bearings(reader);
    frame_reader_make_frames(reader);
    return reader;
}

/* ---- What was read ---- */

const struct rho_frame *frame_reader_next(struct frame_reader *reader)
{
    return reader->next < reader->num_frames ? &reader->frames[reader->next++] : NULL;
}

void frame_reader_skip(struct frame_reader *reader, uint64_t frames)
{
    say_last_taken(frames, reader->num_frames, "frames");
    if (reader->num_frames > frames) {
        reader->next = reader->num_frames - frames;
    }
}

uint64_t frame_reader_total(const struct frame_reader *reader)
{
    return reader->num_frames;
}

const struct frame_sensor *frame_reader_sensors(const struct frame_reader *reader, size_t *count)
{
    *count = reader->num_sensors;
    return reader->sensors;
}

struct frame_reader_counts frame_reader_counts(const struct frame_reader *reader)
{
    return (struct frame_reader_counts){.frames = reader->num_frames,
                                        .scans = reader->num_entries,
                                        .bearings = reader->num_members,
                                        .frames_incomplete = reader->frames_incomplete,
                                        .rows_skipped = reader->rows_skipped};
}

void frame_reader_report(const struct frame_reader *reader)
{
    say_rows_skipped(reader->rows_skipped);
    if (reader->frames_incomplete) {
        fprintf(stderr, "rhotrack: %" PRIu64 " of %" PRIu64 " frames miss a sensor\n",
                reader->frames_incomplete, (uint64_t)reader->num_frames);
    }
    if (reader->frames_incomplete == reader->num_frames) {
        fprintf(stderr,
                "rhotrack: frames hold the scans within frame_tolerance_s %.9g of one another\n",
                (double)reader->tolerance_us * 1e-6);
    }
}

void frame_reader_close(struct frame_reader *reader)
{
    if (!reader) {
        return;
    }
    scan_numbers_clear(&reader->numbers);
    free(reader->entries);
    free(reader->bearings);
    free(reader->scans);
    free(reader->frames);
    free(reader);
}
