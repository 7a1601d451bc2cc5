/* SPDX-License-Identifier: MIT */
#include "io/scans/scan_source.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/common.h"
#include "io/csv/frame_gaps.h"
#include "io/csv/table_stream.h"
#include "io/log/lcm_log.h"
#include "io/log/log_scans.h"
#include "io/scans/reorder_buffer.h"
#include "io/scans/repeated_rows.h"
#include "io/scans/rows_to_scans.h"
#include "io/turns/antenna_turns.h"

/* newer scans of its sensor after which a followed, numbered scan is complete */
#define FOLLOW_BEGUN_MAX 2

struct scan_source {
    const char *path;
    const struct parameters *parameters;
    struct scan_source_options options;
    struct log_scans *log;       /* NULL: the file is not a log */
    struct table_stream *stream; /* NULL: the file is a log */
    bool has_columns, has_good, is_over, waits, is_complete;
    struct measurement_columns columns;
    struct antenna_turns *turns; /* NULL: rows are gathered by their times and numbers */
    struct rows_to_scans gather;
    struct reorder_buffer reorder; /* for a file with reception times, or a log */
    uint32_t item;                 /* of a log: number of the newest scan of bearings, from 1 */
    struct frame_gaps gaps;
    struct repeated_rows *repeated; /* NULL: the file is a log */
    uint64_t rows_skipped;          /* bad rows found here; the stream counts its own */
};

/* Checks that a row has the values that all rows of its scan must share. */
static bool check_row_fits_scan(const struct scan_source *source, const struct gathered_scan *scan,
                                const struct measurement_row *row, const struct row_check *check)
{
    if (!scan || source->turns) {
        return true; /* a turn measures what all its rows measure */
    }
    if (row->sector_from_rad != scan->sector_from_rad ||
        row->sector_to_rad != scan->sector_to_rad) {
        return row_refuse(check, "the sector differs from that of the scan's first row");
    }
    if (row->sensor.x_m != scan->sensor.x_m || row->sensor.y_m != scan->sensor.y_m ||
        row->sensor.z_m != scan->sensor.z_m) {
        return row_refuse(check, "the sensor's place differs from that of the scan's first row");
    }
    return !row->has_measurement || !scan->has_measures || row->measures == scan->measures ||
           row_refuse(check, "height, velocity or range rate must be given in all rows of a scan "
                             "or in none");
}

/* Checks a row's sensor against the sensors of bearings of all files. */
static bool check_bearing_sensor_has_room(const struct scan_source *source,
                                          const struct measurement_row *row,
                                          const struct row_check *check)
{
    return source->options.kind == RECORD_PLOTS ||
           passive_sensors_check_row(source->options.known, row, check);
}

static bool check_received_fits_scan(const struct rows_to_scans *gather,
                                     const struct gathered_scan *scan,
                                     const struct measurement_row *row,
                                     const struct row_check *check)
{
    return !scan || !gather->has_clock ||
           row_check_received(check, row->received_us, scan->heard_us,
                              row->number.is_given && scan->number.is_given, gather->interval_us);
}

static struct gathered_scan *begin_scan_with_heading_of_row(struct scan_source *source,
                                                            const struct measurement_row *row)
{
    const struct gathered_scan scan = {.sensor_id = row->sensor_id,
                                       .number = row->number,
                                       .bias_us = row->bias_us,
                                       .line = row->line,
                                       .sector_from_rad = row->sector_from_rad,
                                       .sector_to_rad = row->sector_to_rad,
                                       .has_sensor = row->has_sensor,
                                       .sensor = row->sensor};

    return rows_to_scans_begin_scan(&source->gather, &scan, row->time_us);
}

static void add_row_to_scan(struct scan_source *source, struct gathered_scan *scan,
                            const struct measurement_row *row)
{
    bool is_bearing = source->options.kind == RECORD_BEARINGS;

    if (is_bearing) {
        passive_sensors_add(source->options.known, source->path, row);
    }
    scan = scan ? scan : begin_scan_with_heading_of_row(source, row);
    if (!row->has_measurement) {
        rows_to_scans_add_empty_row(&source->gather, scan, row->time_us);
        return;
    }
    scan->measures =
        source->turns && scan->has_measures ? scan->measures & row->measures : row->measures;
    scan->has_measures = true;
    rows_to_scans_add_element(&source->gather, scan, row->time_us,
                              is_bearing ? (const void *)&row->bearing : &row->plot);
}

static void find_columns(struct scan_source *source, const struct table *table)
{
    if (source->has_columns || !table->names) {
        return;
    }
    if (source->options.follow && measurement_row_is_bearings(table)) {
        table_fail_at_row(table, TABLE_HEADER, "--follow takes plots, but this file has bearings");
    }
    source->columns = measurement_columns_find(table, source->parameters, source->options.kind,
                                               !source->options.may_lack_sensor);
    source->has_columns = true;
    if (source->columns.in_file.at[COL_RECEIVED_S] >= 0) {
        source->gather.begun_max = FOLLOW_BEGUN_MAX;
    }
}

/* Numbers a row by the turn of its antenna, where the file's turns were found. */
static void number_row_by_turn(const struct scan_source *source, struct measurement_row *row)
{
    const double place_m[2] = {(double)row->plot.x_m - (double)row->sensor.x_m,
                               (double)row->plot.y_m - (double)row->sensor.y_m};
    const int32_t number =
        source->turns ? antenna_turns_number_row(source->turns, row->sensor_id, row->time_us,
                                                 row->has_measurement ? place_m : NULL)
                      : 0;

    if (number > 0) {
        row->number = (struct scan_number){.is_given = true, .scan = number};
    }
}

/*
 * Adds scans without plots for the frames before a row in which its sensor saw nothing. They take
 * the sensor's place and the sector from this row, the one after the gap.
 */
static void add_frames_without_rows(struct scan_source *source, const struct measurement_row *row)
{
    const struct frame_gap gap = frame_gaps_before_row(&source->gaps, &source->columns.in_file,
                                                       row->sensor_id, row->time_us);
    struct measurement_row look = *row;

    look.has_measurement = false;
    for (int i = 0; i < gap.count; i++) {
        look.time_us = frame_gap_time_us(&gap, i);
        add_row_to_scan(
            source,
            rows_to_scans_find_scan(&source->gather, look.sensor_id, &look.number, look.time_us),
            &look);
    }
}

/* Checks the table's row and adds it to a scan; a bad row is an error, or skipped and counted. */
static void process_table_row(struct scan_source *source, const struct table *table)
{
    char reason[ROW_REASON_BYTES];
    const struct row_check check = {.columns = &source->columns.in_file, .reason = reason};
    struct gathered_scan *scan = NULL;
    struct measurement_row row;
    bool is_good;

    find_columns(source, table);
    is_good = measurement_row_read(&source->columns, 0, source->parameters, &row, reason);
    if (is_good && repeated_rows_leaves_out(source->repeated, &row)) {
        source->has_good = true;
        return;
    }
    if (is_good && source->columns.in_file.at[COL_RECEIVED_S] >= 0) {
        rows_to_scans_set_reception(&source->gather, row.received_us);
    }
    if (is_good) {
        add_frames_without_rows(source, &row);
        number_row_by_turn(source, &row);
        scan = rows_to_scans_find_scan(&source->gather, row.sensor_id, &row.number, row.time_us);
        is_good = rows_to_scans_check_time(&source->gather, source->turns ? NULL : scan,
                                           row.time_us, &check) &&
                  check_received_fits_scan(&source->gather, scan, &row, &check) &&
                  check_row_fits_scan(source, scan, &row, &check) &&
                  check_bearing_sensor_has_room(source, &row, &check);
    }
    if (is_good) {
        source->has_good = true;
        add_row_to_scan(source, scan, &row);
        return;
    }
    if (!source->options.keep_going) {
        table_fail_at_row(table, 0, "%s", reason);
    }
    source->rows_skipped++;
}

/*
 * Exit 2 where a file ends without a good row, unless it is followed, when rows may not have come
 * yet.
 */
static void need_any_good_row(const struct scan_source *source, const struct table *table)
{
    if (source->has_good || source->options.follow) {
        return;
    }
    if (!scan_source_rows_skipped(source)) {
        table_need_rows(table);
    }
    table_fail_at_row(table, TABLE_HEADER, "no valid row after the header");
}

/* Reads one more row and processes it, or notes the end, or that none is there yet. */
static void process_next_row(struct scan_source *source)
{
    enum table_stream_found found = table_stream_next(source->stream);
    const struct table *table = table_stream_table(source->stream);

    source->waits = found == TABLE_STREAM_WAITS;
    if (found == TABLE_STREAM_ROW) {
        source->is_complete = false;
        process_table_row(source, table);
    } else if (found == TABLE_STREAM_END) {
        source->is_over = true;
        need_any_good_row(source, table);
    }
}

static void fill_plot_scan(struct sensor_scan *out, const struct gathered_scan *scan)
{
    struct rho_plot *plots = scan->elements;

    for (size_t i = 0; i < scan->count; i++) {
        plots[i].offset_us += (int32_t)(scan->times_us[i] - scan->time_us);
    }
    *out = (struct sensor_scan){.scan = {.time_us = gathered_scan_time_us(scan),
                                         .sensor_id = scan->sensor_id,
                                         .sector_from_rad = scan->sector_from_rad,
                                         .sector_to_rad = scan->sector_to_rad,
                                         .measures = scan->measures,
                                         .num_plots = (uint32_t)scan->count,
                                         .plots = plots},
                                .has_sensor = scan->has_sensor,
                                .sensor = scan->sensor};
}

static void fill_bearing_scan(struct sensor_scan *out, const struct gathered_scan *scan)
{
    struct rho_bearing *bearings = scan->elements;

    for (size_t i = 0; i < scan->count; i++) {
        bearings[i].offset_us += (int32_t)(scan->times_us[i] - scan->time_us);
    }
    *out = (struct sensor_scan){.is_bearings = true,
                                .bearings = {.time_us = gathered_scan_time_us(scan),
                                             .sensor_id = scan->sensor_id,
                                             .x_m = scan->sensor.x_m,
                                             .y_m = scan->sensor.y_m,
                                             .z_m = scan->sensor.z_m,
                                             .sector_from_rad = scan->sector_from_rad,
                                             .sector_to_rad = scan->sector_to_rad,
                                             .num_bearings = (uint32_t)scan->count,
                                             .bearings = bearings},
                                .line = scan->line};
}

/* Takes the next complete scan of a table. *heard_us: reception time of its last row. */
static bool next_gathered_scan(struct scan_source *source, struct sensor_scan *scan,
                               int64_t *heard_us)
{
    struct gathered_scan gathered;

    while (!rows_to_scans_take_scan(&source->gather, source->is_over || source->is_complete,
                                    &gathered)) {
        if (source->is_over) {
            return false;
        }
        process_next_row(source);
        if (source->waits) {
            return false;
        }
    }
    *heard_us = gathered.heard_us;
    if (source->options.kind == RECORD_BEARINGS) {
        fill_bearing_scan(scan, &gathered);
    } else {
        fill_plot_scan(scan, &gathered);
    }
    scan->path = source->path;
    gathered.elements = NULL;
    gathered_scan_free(&gathered);
    return true;
}

/* Next scan of a table; where rows have reception times, scans wait hold_ms for earlier ones. */
static bool next_table_scan(struct scan_source *source, struct sensor_scan *scan)
{
    int64_t heard_us;

    while (!reorder_buffer_take(&source->reorder, false, scan)) {
        struct sensor_scan next;

        if (!next_gathered_scan(source, &next, &heard_us)) {
            return (source->is_over || source->is_complete) &&
                   reorder_buffer_take(&source->reorder, true, scan);
        }
        if (source->columns.in_file.at[COL_RECEIVED_S] < 0) {
            *scan = next;
            return true;
        }
        reorder_buffer_put(&source->reorder, &next, heard_us, heard_us);
    }
    return true;
}

/*
 * Adds the sensor of a log's scan of bearings, or refuses the scan where the sensor is bad; the
 * scan's number stands for a line.
 */
static bool add_or_refuse_bearing_sensor(struct scan_source *source,
                                         const struct rho_bearing_scan *item)
{
    const struct measurement_row row = {.sensor_id = item->sensor_id,
                                        .line = ++source->item,
                                        .sensor = {.x_m = item->x_m, .y_m = item->y_m}};
    char reason[ROW_REASON_BYTES];
    const struct row_check check = {.reason = reason};

    if (passive_sensors_check_row(source->options.known, &row, &check)) {
        passive_sensors_add(source->options.known, source->path, &row);
        return true;
    }
    if (!source->options.keep_going) {
        fail(EXIT_USAGE, "%s: scan %u of bearings: %s", source->path, (unsigned)source->item,
             reason);
    }
    source->rows_skipped += item->num_bearings ? item->num_bearings : 1;
    return false;
}

/* Whether the item is of the wanted kind, and of a sensor that is accepted. */
static bool accept_item(struct scan_source *source, const struct rho_scan_assembler_item *item)
{
    bool is_bearings = item->kind == RHO_SCAN_ASSEMBLER_BEARINGS;

    return is_bearings == (source->options.kind == RECORD_BEARINGS) &&
           (!is_bearings || add_or_refuse_bearing_sensor(source, &item->bearings));
}

/* Copies a list to new memory; NULL where it is empty. */
static void *copy_array(const void *list, size_t count, size_t bytes)
{
    return count > 0 ? memcpy(must_calloc(count, bytes), list, count * bytes) : NULL;
}

static bool read_log_scan(struct scan_source *source, struct sensor_scan *scan)
{
    struct rho_scan_assembler_item item;

    do {
        if (!log_scans_next(source->log, &item)) {
            return false;
        }
    } while (!accept_item(source, &item));
    *scan = (struct sensor_scan){.is_bearings = item.kind == RHO_SCAN_ASSEMBLER_BEARINGS,
                                 .path = source->path,
                                 .line = source->item};
    if (scan->is_bearings) {
        scan->bearings = item.bearings;
        scan->bearings.bearings = copy_array(item.bearings.bearings, item.bearings.num_bearings,
                                             sizeof(struct rho_bearing));
    } else {
        scan->scan = item.scan;
        scan->scan.plots =
            copy_array(item.scan.plots, item.scan.num_plots, sizeof(struct rho_plot));
        scan->has_sensor = item.has_sensor;
        scan->sensor = item.sensor;
    }
    return true;
}

/*
 * Next scan of a log in the order of time: an assembler has room for RHO_MAX_OPEN_SCANS, and does
 * not wait for a sensor that it has not heard, so that the reorder buffer has to sort its scans.
 */
static bool next_log_scan_in_order(struct scan_source *source, struct sensor_scan *scan)
{
    struct sensor_scan next;

    while (!reorder_buffer_take(&source->reorder, false, scan)) {
        if (!read_log_scan(source, &next)) {
            return reorder_buffer_take(&source->reorder, true, scan);
        }
        if (source->reorder.hold_us == 0) {
            *scan = next;
            return true;
        }
        reorder_buffer_put(&source->reorder, &next, log_scans_scan_received_us(source->log),
                           log_scans_latest_event_us(source->log));
    }
    return true;
}

bool scan_source_next(struct scan_source *source, struct sensor_scan *scan)
{
    return source->log ? next_log_scan_in_order(source, scan) : next_table_scan(source, scan);
}

/*
 * Whether turns may be searched for: the file can be read twice, and states neither numbers of
 * frames or scans nor sectors.
 */
static bool may_have_turns(const struct scan_source *source)
{
    const int *at = source->columns.in_file.at;
    struct stat status;

    return source->has_columns && source->options.kind == RECORD_PLOTS &&
           antenna_turns_are_wanted(source->parameters) &&
           !table_is_frame_number(source->columns.in_file.table, at[COL_T_S]) && at[COL_SCAN] < 0 &&
           at[COL_RECEIVED_S] < 0 && at[COL_SECTOR_FROM_RAD] < 0 &&
           strcmp(source->path, "-") != 0 && stat(source->path, &status) == 0 &&
           S_ISREG(status.st_mode);
}

/* Opens the rows, and finds their columns where the header is known. */
static void open_row_stream(struct scan_source *source)
{
    source->stream = table_stream_open(source->path, source->parameters, source->options.keep_going,
                                       source->options.follow);
    find_columns(source, table_stream_table(source->stream));
}

static void close_row_stream_and_columns(struct scan_source *source)
{
    measurement_columns_free(&source->columns);
    table_stream_close(source->stream);
    source->has_columns = false;
}

/*
 * Searches the first rows for turns of antennas, in a second stream; the source's own is not open.
 */
static void find_antenna_turns(struct scan_source *source)
{
    struct table_stream *stream =
        table_stream_open(source->path, source->parameters, true, source->options.follow);
    struct measurement_columns columns = measurement_columns_find(
        table_stream_table(stream), source->parameters, source->options.kind, false);
    struct measurement_row row;
    char reason[ROW_REASON_BYTES];
    bool goes_on = true;

    table_stream_set_quiet(stream);
    source->turns = antenna_turns_start();
    while (goes_on && table_stream_next(stream) == TABLE_STREAM_ROW) {
        if (!measurement_row_read(&columns, 0, source->parameters, &row, reason)) {
            continue;
        }
        if (!row.has_measurement) {
            antenna_turns_add_empty_row(source->turns, row.sensor_id);
        } else {
            goes_on = antenna_turns_add_row(source->turns, row.sensor_id, row.time_us,
                                            (double)row.plot.x_m - (double)row.sensor.x_m,
                                            (double)row.plot.y_m - (double)row.sensor.y_m);
        }
    }
    measurement_columns_free(&columns);
    table_stream_close(stream);
    if (!antenna_turns_find_rules(source->turns, source->path,
                                  source->parameters->value[PARAMETER_V_MAX_MPS])) {
        antenna_turns_free(source->turns);
        source->turns = NULL;
    }
}

static void open_rows_and_find_turns(struct scan_source *source)
{
    int32_t least_us;

    rows_to_scans_start(&source->gather,
                        source->options.kind == RECORD_BEARINGS ? sizeof(struct rho_bearing)
                                                                : sizeof(struct rho_plot),
                        llround(source->parameters->value[PARAMETER_SCAN_INTERVAL_S] * 1e6));
    parameters_time_bias_range_us(source->parameters, &least_us, &source->gather.bias_max_us);
    source->gather.begun_max = source->options.follow ? FOLLOW_BEGUN_MAX : 0;
    source->repeated = repeated_rows_open();
    source->reorder.hold_us = llround(source->parameters->value[PARAMETER_HOLD_MS] * 1e3);
    open_row_stream(source);
    if (may_have_turns(source)) {
        close_row_stream_and_columns(source);
        find_antenna_turns(source);
        open_row_stream(source);
        source->gather.begun_max = source->turns ? 1 : source->gather.begun_max;
    }
}

struct scan_source *scan_source_open(const char *path, const struct parameters *parameters,
                                     struct scan_source_options options)
{
    struct scan_source *source = must_calloc(1, sizeof *source);

    source->path = path;
    source->parameters = parameters;
    source->options = options;
    if (!lcm_log_is_log(path)) {
        open_rows_and_find_turns(source);
    } else if (options.follow) {
        fail(EXIT_USAGE, "%s: --follow takes CSV files, but this is an LCM log", path);
    } else {
        /*
         * Plots are reordered here, with unlimited room; bearings by the scan assembler. For a log
         * of both kinds only the reader of plots reports faults.
         */
        bool is_plots = source->options.kind == RECORD_PLOTS;

        source->reorder.hold_us = is_plots ? log_scans_hold_us(source->parameters) : 0;
        source->log =
            log_scans_open(source->path, source->parameters, source->options.keep_going,
                           is_plots || log_scans_kinds(source->path) == LOG_HAS_BEARINGS, is_plots);
    }
    return source;
}

/* Closes the rows, with the scans gathered and the turns found so far. */
static void close_rows(struct scan_source *source)
{
    rows_to_scans_free(&source->gather);
    antenna_turns_free(source->turns);
    repeated_rows_free(source->repeated);
    close_row_stream_and_columns(source);
}

void scan_source_rewind(struct scan_source *source)
{
    source->has_good = source->is_over = source->has_columns = false;
    source->item = 0;
    source->gaps = (struct frame_gaps){.has_last = false};
    source->rows_skipped = 0;
    if (source->log) {
        log_scans_rewind(source->log);
    } else {
        close_rows(source);
        open_rows_and_find_turns(source);
    }
}

bool scan_source_waits(const struct scan_source *source)
{
    return source->waits;
}

const char *scan_source_why_not_followed(const struct scan_source *source)
{
    return source->stream ? table_stream_why_not_followed(source->stream) : NULL;
}

bool scan_source_is_mid_row(const struct scan_source *source)
{
    return source->stream && table_stream_is_mid_row(source->stream);
}

void scan_source_complete_scans(struct scan_source *source)
{
    source->is_complete = true;
}

void scan_source_end_reading(struct scan_source *source)
{
    source->is_over = true;
}

uint64_t scan_source_rows_skipped(const struct scan_source *source)
{
    return source->rows_skipped +
           (source->stream ? table_stream_table(source->stream)->rows_skipped : 0);
}

uint64_t scan_source_position(const struct scan_source *source)
{
    return source->log ? log_scans_position(source->log) : table_stream_position(source->stream);
}

void scan_source_close(struct scan_source *source)
{
    if (source->log) {
        log_scans_close(source->log);
    } else {
        frame_gaps_report(&source->gaps, table_stream_table(source->stream)->path);
        repeated_rows_report(source->repeated, source->path);
        close_rows(source);
    }
    reorder_buffer_free(&source->reorder);
    free(source);
}
