/* SPDX-License-Identifier: MIT */
#include "plot_source.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bearing_row.h"
#include "common.h"
#include "gather.h"
#include "hold.h"
#include "lcm_log.h"
#include "log_scans.h"
#include "plot_row.h"
#include "table_stream.h"

#define FOLLOW_BEGUN_MAX 2 /* who waits for a numbered scan's last plots for a minute is late */

struct plot_source {
    const struct parameters *parameters;
    struct plot_source_options options;
    struct log_scans *log;       /* or NULL, and */
    struct table_stream *stream; /* or NULL */
    bool has_columns, has_good, is_over, waits, is_complete;
    struct plot_columns columns;
    struct gather gather;
    struct hold hold;      /* of a file that says when its rows were received, or of a log */
    uint64_t rows_skipped; /* but those of the stream */
};

void plot_scan_free(struct plot_scan *scan)
{
    free((void *)scan->scan.plots);
    *scan = (struct plot_scan){.has_sensor = false};
}

/* ---- Rows to scans ---- */

/* What a row must have in common with the scan that it would join. */
static bool check_scan(const struct gathered *scan, const struct plot_row *row,
                       const struct row_check *check)
{
    if (!scan) {
        return true;
    }
    if (row->sector_from_rad != scan->sector_from_rad ||
        row->sector_to_rad != scan->sector_to_rad) {
        return row_refuse(check, "the sector is not that of the scan's first row");
    }
    if (row->sensor.x_m != scan->sensor.x_m || row->sensor.y_m != scan->sensor.y_m ||
        row->sensor.z_m != scan->sensor.z_m) {
        return row_refuse(check, "the sensor's place is not that of the scan's first row");
    }
    return !row->has_plot || !scan->has_measures || row->measures == scan->measures ||
           row_refuse(check, "height, velocity or range rate must be given in all rows of a scan "
                             "or in none");
}

static bool check_received(const struct gather *gather, const struct gathered *scan,
                           const struct plot_row *row, const struct row_check *check)
{
    return !scan || !gather->has_clock ||
           row_received_with(check, row->received_us, scan->heard_us,
                             row->number.is_given && scan->number.is_given, gather->interval_us);
}

static struct gathered *begin_scan(struct plot_source *source, const struct plot_row *row)
{
    const struct gathered scan = {.sensor_id = row->sensor_id,
                                  .number = row->number,
                                  .bias_us = row->bias_us,
                                  .sector_from_rad = row->sector_from_rad,
                                  .sector_to_rad = row->sector_to_rad,
                                  .has_sensor = row->has_sensor,
                                  .sensor = row->sensor};

    return gather_begin(&source->gather, &scan, row->time_us);
}

static void add_row(struct plot_source *source, struct gathered *scan, const struct plot_row *row)
{
    scan = scan ? scan : begin_scan(source, row);
    if (!row->has_plot) {
        gather_add_nothing(&source->gather, scan, row->time_us);
        return;
    }
    scan->measures = row->measures;
    scan->has_measures = true;
    gather_add(&source->gather, scan, row->time_us, &row->plot);
}

static void find_columns(struct plot_source *source, const struct table *table)
{
    if (source->has_columns || !table->names) {
        return;
    }
    if (source->options.follow && bearing_columns_are_there(table)) {
        table_fail(table, TABLE_HEADER, "--follow takes plots, and these are bearings");
    }
    source->columns =
        plot_columns_find(table, source->parameters, !source->options.may_lack_sensor);
    source->has_columns = true;
    if (source->columns.received_s >= 0) {
        source->gather.begun_max = FOLLOW_BEGUN_MAX;
    }
}

/* The row that the table has. */
static void take_row(struct plot_source *source, const struct table *table)
{
    char reason[ROW_REASON_BYTES];
    const struct row_check check = {.table = table, .row = 0, .reason = reason};
    struct gathered *scan = NULL;
    struct plot_row row;
    bool is_good;

    find_columns(source, table);
    is_good = plot_row_read(table, &source->columns, 0, source->parameters, &row, reason);
    if (is_good && source->columns.received_s >= 0) {
        gather_set_clock(&source->gather, row.received_us);
    }
    if (is_good) {
        scan = gather_find(&source->gather, row.sensor_id, &row.number, row.time_us);
        is_good = gather_check_time(&source->gather, scan, row.time_us, &check) &&
                  check_received(&source->gather, scan, &row, &check) &&
                  check_scan(scan, &row, &check);
    }
    if (is_good) {
        source->has_good = true;
        add_row(source, scan, &row);
        return;
    }
    if (!source->options.keep_going) {
        table_fail(table, 0, "%s", reason);
    }
    source->rows_skipped++;
}

/* A file that ends without a good row; of one that is followed there may have been no time for any. */
static void check_end(const struct plot_source *source, const struct table *table)
{
    if (source->has_good || source->options.follow) {
        return;
    }
    if (!plot_source_rows_skipped(source)) {
        table_need_rows(table);
    }
    table_fail(table, TABLE_HEADER, "not one good row after the header");
}

/* One row more, or the end, or nothing. */
static void read_row(struct plot_source *source)
{
    enum table_stream_found found = table_stream_next(source->stream);
    const struct table *table = table_stream_table(source->stream);

    source->waits = found == TABLE_STREAM_WAITS;
    if (found == TABLE_STREAM_ROW) {
        source->is_complete = false;
        take_row(source, table);
    } else if (found == TABLE_STREAM_END) {
        source->is_over = true;
        check_end(source, table);
    }
}

/* ---- Scans ---- */

static void fill_scan(struct plot_scan *out, struct gathered *scan)
{
    struct rho_plot *plots = scan->elements;

    for (size_t i = 0; i < scan->count; i++) {
        plots[i].offset_us += (int32_t)(scan->times_us[i] - scan->time_us);
    }
    *out = (struct plot_scan){.scan = {.time_us = gathered_time_us(scan),
                                       .sensor_id = scan->sensor_id,
                                       .sector_from_rad = scan->sector_from_rad,
                                       .sector_to_rad = scan->sector_to_rad,
                                       .measures = scan->measures,
                                       .num_plots = (uint32_t)scan->count,
                                       .plots = plots},
                              .has_sensor = scan->has_sensor,
                              .sensor = scan->sensor};
    scan->elements = NULL;
    gathered_free(scan);
}

/* The next one as its rows came. heard_us: its last one. */
static bool next_gathered(struct plot_source *source, struct plot_scan *scan, int64_t *heard_us)
{
    struct gathered gathered;

    while (!gather_take(&source->gather, source->is_over || source->is_complete, &gathered)) {
        if (source->is_over) {
            return false;
        }
        read_row(source);
        if (source->waits) {
            return false;
        }
    }
    *heard_us = gathered.heard_us;
    fill_scan(scan, &gathered);
    return true;
}

/* Where rows say when they were received, scans wait hold_ms for earlier ones. */
static bool next_of_table(struct plot_source *source, struct plot_scan *scan)
{
    int64_t heard_us;

    while (!hold_take(&source->hold, false, scan)) {
        struct plot_scan next;

        if (!next_gathered(source, &next, &heard_us)) {
            return (source->is_over || source->is_complete) && hold_take(&source->hold, true, scan);
        }
        if (source->columns.received_s < 0) {
            *scan = next;
            return true;
        }
        hold_put(&source->hold, &next, heard_us, heard_us);
    }
    return true;
}

static bool take_of_log(struct plot_source *source, struct plot_scan *scan)
{
    struct rho_feed_item item;

    do {
        if (!log_scans_next(source->log, &item)) {
            return false;
        }
    } while (item.kind == RHO_FEED_BEARINGS);
    *scan =
        (struct plot_scan){.scan = item.scan, .has_sensor = item.has_sensor, .sensor = item.sensor};
    scan->scan.plots = NULL;
    if (item.scan.num_plots > 0) {
        struct rho_plot *plots = must_calloc(item.scan.num_plots, sizeof *plots);

        scan->scan.plots = memcpy(plots, item.scan.plots, item.scan.num_plots * sizeof *plots);
    }
    return true;
}

/* A feed has room for RHO_MAX_OPEN_SCANS, and does not wait for a sensor of which it has not heard: what goes out of it too early is
 * put in order here. */
static bool next_of_log(struct plot_source *source, struct plot_scan *scan)
{
    struct plot_scan next;

    while (!hold_take(&source->hold, false, scan)) {
        if (!take_of_log(source, &next)) {
            return hold_take(&source->hold, true, scan);
        }
        if (source->hold.hold_us == 0) {
            *scan = next;
            return true;
        }
        hold_put(&source->hold, &next, log_scans_heard_us(source->log),
                 log_scans_clock_us(source->log));
    }
    return true;
}

bool plot_source_next(struct plot_source *source, struct plot_scan *scan)
{
    return source->log ? next_of_log(source, scan) : next_of_table(source, scan);
}

/* ---- Opening ---- */

static void open_table(struct plot_source *source, const char *path)
{
    int32_t least_us;

    source->stream = table_stream_open(path, source->parameters, source->options.keep_going,
                                       source->options.follow);
    gather_start(&source->gather, sizeof(struct rho_plot),
                 llround(source->parameters->value[PARAMETER_SCAN_INTERVAL_S] * 1e6));
    parameters_time_biases_us(source->parameters, &least_us, &source->gather.bias_max_us);
    source->gather.begun_max = source->options.follow ? FOLLOW_BEGUN_MAX : 0;
    source->hold.hold_us = llround(source->parameters->value[PARAMETER_HOLD_MS] * 1e3);
    find_columns(source, table_stream_table(source->stream));
}

struct plot_source *plot_source_open(const char *path, const struct parameters *parameters,
                                     struct plot_source_options options)
{
    struct plot_source *source = must_calloc(1, sizeof *source);

    source->parameters = parameters;
    source->options = options;
    if (!lcm_log_is_log(path)) {
        open_table(source, path);
    } else if (options.follow) {
        fail(EXIT_USAGE, "%s: --follow takes CSV files, and this is an LCM log", path);
    } else {
        source->hold.hold_us = log_scans_hold_us(parameters);
        source->log = log_scans_open(path, parameters, options.keep_going, true, true);
    }
    return source;
}

bool plot_source_waits(const struct plot_source *source)
{
    return source->waits;
}

const char *plot_source_why_over(const struct plot_source *source)
{
    return source->stream ? table_stream_why_over(source->stream) : NULL;
}

bool plot_source_is_mid_row(const struct plot_source *source)
{
    return source->stream && table_stream_is_mid_row(source->stream);
}

void plot_source_complete(struct plot_source *source)
{
    source->is_complete = true;
}

void plot_source_end(struct plot_source *source)
{
    source->is_over = true;
}

uint64_t plot_source_rows_skipped(const struct plot_source *source)
{
    return source->rows_skipped +
           (source->stream ? table_stream_table(source->stream)->rows_skipped : 0);
}

uint64_t plot_source_position(const struct plot_source *source)
{
    return source->log ? log_scans_position(source->log) : table_stream_position(source->stream);
}

void plot_source_close(struct plot_source *source)
{
    if (source->log) {
        log_scans_close(source->log);
    } else {
        gather_free(&source->gather);
        plot_columns_free(&source->columns);
        table_stream_close(source->stream);
    }
    hold_free(&source->hold);
    free(source);
}
