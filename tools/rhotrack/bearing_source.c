/* SPDX-License-Identifier: MIT */
#include "bearing_source.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bearing_row.h"
#include "common.h"
#include "gather.h"
#include "lcm_log.h"
#include "log_scans.h"
#include "table_stream.h"

#define SAME_PLACE_M 1.0

struct bearing_source {
    const char *path;
    const struct parameters *parameters;
    bool keep_going;
    struct known_sensors *known;
    struct log_scans *log;       /* or NULL, and */
    struct table_stream *stream; /* or NULL */
    struct bearing_columns columns;
    struct gather gather;
    bool has_good, is_over;
    uint32_t item;         /* of the log: the newest scan of bearings, 1-based */
    uint64_t rows_skipped; /* but those of the stream */
};

void bearing_scan_free(struct bearing_scan *scan)
{
    free((void *)scan->scan.bearings);
    *scan = (struct bearing_scan){.path = NULL};
}

/* ---- Sensors ---- */

static const struct known_sensor *find_sensor(const struct known_sensors *known, int32_t sensor_id)
{
    for (size_t i = 0; i < known->count; i++) {
        if (known->list[i].sensor.sensor_id == sensor_id) {
            return &known->list[i];
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

static bool check_new_sensor(const struct bearing_source *source, const struct bearing_row *row,
                             const struct row_check *check)
{
    const struct known_sensors *known = source->known;
    char text[WHERE_BYTES];

    for (size_t i = 0; i < known->count; i++) {
        const struct frame_sensor *other = &known->list[i].sensor;

        if (hypot((double)row->x_m - (double)other->x_m, (double)row->y_m - (double)other->y_m) <
            SAME_PLACE_M) {
            return row_refuse(check, "sensor %d is where sensor %d is: %s", (int)row->sensor_id,
                              (int)other->sensor_id, where(&known->list[i], source->path, text));
        }
    }
    if (known->is_closed) {
        return row_refuse(check, "sensor %d is new: the file has grown", (int)row->sensor_id);
    }
    return known->count < RHO_MAX_SENSORS ||
           row_refuse(check, "sensor %d is one more than %d sensors", (int)row->sensor_id,
                      RHO_MAX_SENSORS);
}

static bool check_sensor(const struct bearing_source *source, const struct bearing_row *row,
                         const struct row_check *check)
{
    const struct known_sensor *known = find_sensor(source->known, row->sensor_id);
    char text[WHERE_BYTES];

    if (!known) {
        return check_new_sensor(source, row, check);
    }
    if (row->x_m < known->sensor.x_m || row->x_m > known->sensor.x_m ||
        row->y_m < known->sensor.y_m || row->y_m > known->sensor.y_m) {
        return row_refuse(check, "sensor %d has moved: it was at %s", (int)row->sensor_id,
                          where(known, source->path, text));
    }
    return true;
}

static void have_sensor(struct bearing_source *source, uint32_t line, int32_t sensor_id, float x_m,
                        float y_m)
{
    struct known_sensors *known = source->known;

    if (!find_sensor(known, sensor_id)) {
        known->list[known->count++] = (struct known_sensor){
            .sensor = {sensor_id, x_m, y_m}, .path = source->path, .line = line};
    }
}

/* ---- Rows to scans ---- */

static bool check_sector(const struct gathered *scan, const struct bearing_row *row,
                         const struct row_check *check)
{
    return !scan ||
           (row->sector_from_rad == scan->sector_from_rad &&
            row->sector_to_rad == scan->sector_to_rad) ||
           row_refuse(check, "the sector is not that of the scan's first row");
}

static struct gathered *begin_scan(struct bearing_source *source, uint32_t line,
                                   const struct bearing_row *row)
{
    const struct gathered scan = {.sensor_id = row->sensor_id,
                                  .number = row->number,
                                  .bias_us = row->bias_us,
                                  .line = line,
                                  .sector_from_rad = row->sector_from_rad,
                                  .sector_to_rad = row->sector_to_rad,
                                  .sensor = {.x_m = row->x_m, .y_m = row->y_m}};

    return gather_begin(&source->gather, &scan, row->time_us);
}

static void add_row(struct bearing_source *source, uint32_t line, struct gathered *scan,
                    const struct bearing_row *row)
{
    have_sensor(source, line, row->sensor_id, row->x_m, row->y_m);
    scan = scan ? scan : begin_scan(source, line, row);
    if (row->has_bearing) {
        gather_add(&source->gather, scan, row->time_us, &row->bearing);
    } else {
        gather_add_nothing(&source->gather, scan, row->time_us);
    }
}

/* The row that the table has. */
static void take_row(struct bearing_source *source, const struct table *table)
{
    char reason[ROW_REASON_BYTES];
    const struct row_check check = {.table = table, .row = 0, .reason = reason};
    struct gathered *scan = NULL;
    struct bearing_row row;
    bool is_good = bearing_row_read(table, &source->columns, 0, source->parameters, &row, reason);

    if (is_good) {
        scan = gather_find(&source->gather, row.sensor_id, &row.number, row.time_us);
        is_good = gather_check_time(&source->gather, scan, row.time_us, &check) &&
                  check_sector(scan, &row, &check) && check_sensor(source, &row, &check);
    }
    if (is_good) {
        source->has_good = true;
        add_row(source, table->lines[0], scan, &row);
        return;
    }
    if (!source->keep_going) {
        table_fail(table, 0, "%s", reason);
    }
    source->rows_skipped++;
}

static void read_row(struct bearing_source *source)
{
    enum table_stream_found found = table_stream_next(source->stream);
    const struct table *table = table_stream_table(source->stream);

    if (found == TABLE_STREAM_ROW) {
        take_row(source, table);
        return;
    }
    source->is_over = true;
    if (!source->has_good && !bearing_source_rows_skipped(source)) {
        table_need_rows(table);
    }
    if (!source->has_good) {
        table_fail(table, TABLE_HEADER, "not one good row after the header");
    }
}

/* ---- Scans ---- */

static void fill_scan(const struct bearing_source *source, struct bearing_scan *out,
                      struct gathered *scan)
{
    struct rho_bearing *bearings = scan->elements;

    for (size_t i = 0; i < scan->count; i++) {
        bearings[i].offset_us += (int32_t)(scan->times_us[i] - scan->time_us);
    }
    *out = (struct bearing_scan){.scan = {.time_us = gathered_time_us(scan),
                                          .sensor_id = scan->sensor_id,
                                          .x_m = scan->sensor.x_m,
                                          .y_m = scan->sensor.y_m,
                                          .sector_from_rad = scan->sector_from_rad,
                                          .sector_to_rad = scan->sector_to_rad,
                                          .num_bearings = (uint32_t)scan->count,
                                          .bearings = bearings},
                                 .path = source->path,
                                 .line = scan->line};
    scan->elements = NULL;
    gathered_free(scan);
}

static bool next_of_table(struct bearing_source *source, struct bearing_scan *scan)
{
    struct gathered gathered;

    while (!gather_take(&source->gather, source->is_over, &gathered)) {
        if (source->is_over) {
            return false;
        }
        read_row(source);
    }
    fill_scan(source, scan, &gathered);
    return true;
}

/* ---- Logs to scans ---- */

/* The item's heading as a row; its place in the log stands for a line. */
static bool take_item(struct bearing_source *source, const struct rho_bearing_scan *item)
{
    const struct bearing_row row = {
        .sensor_id = item->sensor_id, .x_m = item->x_m, .y_m = item->y_m};
    char reason[ROW_REASON_BYTES];
    const struct row_check check = {.reason = reason};

    source->item++;
    if (check_sensor(source, &row, &check)) {
        have_sensor(source, source->item, item->sensor_id, item->x_m, item->y_m);
        return true;
    }
    if (!source->keep_going) {
        fail(EXIT_USAGE, "%s: scan %u of bearings: %s", source->path, (unsigned)source->item,
             reason);
    }
    source->rows_skipped += item->num_bearings ? item->num_bearings : 1;
    return false;
}

static bool next_of_log(struct bearing_source *source, struct bearing_scan *scan)
{
    struct rho_feed_item item;

    do {
        if (!log_scans_next(source->log, &item)) {
            return false;
        }
    } while (item.kind != RHO_FEED_BEARINGS || !take_item(source, &item.bearings));
    *scan =
        (struct bearing_scan){.scan = item.bearings, .path = source->path, .line = source->item};
    scan->scan.bearings = NULL;
    if (item.bearings.num_bearings > 0) {
        struct rho_bearing *bearings = must_calloc(item.bearings.num_bearings, sizeof *bearings);

        scan->scan.bearings =
            memcpy(bearings, item.bearings.bearings, item.bearings.num_bearings * sizeof *bearings);
    }
    return true;
}

bool bearing_source_next(struct bearing_source *source, struct bearing_scan *scan)
{
    return source->log ? next_of_log(source, scan) : next_of_table(source, scan);
}

/* ---- Opening ---- */

static void open_table(struct bearing_source *source)
{
    int32_t least_us;

    source->stream = table_stream_open(source->path, NULL, source->keep_going, false);
    source->columns = bearing_columns_find(table_stream_table(source->stream));
    gather_start(&source->gather, sizeof(struct rho_bearing),
                 llround(source->parameters->value[PARAMETER_SCAN_INTERVAL_S] * 1e6));
    parameters_time_biases_us(source->parameters, &least_us, &source->gather.bias_max_us);
}

/* Of a log that has plots, too, their reader says what is wrong. */
struct bearing_source *bearing_source_open(const char *path, const struct parameters *parameters,
                                           bool keep_going, struct known_sensors *known)
{
    struct bearing_source *source = must_calloc(1, sizeof *source);

    *source = (struct bearing_source){
        .path = path, .parameters = parameters, .keep_going = keep_going, .known = known};
    if (lcm_log_is_log(path)) {
        source->log = log_scans_open(path, parameters, keep_going,
                                     log_scans_kinds(path) == LOG_HAS_BEARINGS, false);
    } else {
        open_table(source);
    }
    return source;
}

static void close_table(struct bearing_source *source)
{
    gather_free(&source->gather);
    table_stream_close(source->stream);
}

void bearing_source_rewind(struct bearing_source *source)
{
    source->has_good = source->is_over = false;
    source->item = 0;
    source->rows_skipped = 0;
    if (source->log) {
        log_scans_rewind(source->log);
    } else {
        close_table(source);
        open_table(source);
    }
}

uint64_t bearing_source_rows_skipped(const struct bearing_source *source)
{
    return source->rows_skipped +
           (source->stream ? table_stream_table(source->stream)->rows_skipped : 0);
}

uint64_t bearing_source_position(const struct bearing_source *source)
{
    return source->log ? log_scans_position(source->log) : table_stream_position(source->stream);
}

void bearing_source_close(struct bearing_source *source)
{
    if (source->log) {
        log_scans_close(source->log);
    } else {
        close_table(source);
    }
    free(source);
}
