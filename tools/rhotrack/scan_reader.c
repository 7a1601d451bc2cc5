/* SPDX-License-Identifier: MIT */
#include "scan_reader.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "lcm_log.h"
#include "log_scans.h"
#include "plot_row.h"
#include "scan_numbers.h"
#include "table.h"

/* A scan while its rows are collected. */
struct entry {
    struct rho_scan scan;
    struct row_number number;
    int64_t start_us; /* of its first row */
    size_t order;     /* the same, over all files */
    size_t first_plot;
    bool has_measures; /* scan.measures is settled, by its first plot */
    bool
        has_time; /* scan.time_us is settled, by a row that saw nothing; else it is the first row's */
    bool has_sensor;
    struct rho_sensor sensor;
};

/* A plot and the scan that it belongs to. */
struct member {
    size_t entry;
    int64_t time_us; /* of its row */
    struct rho_plot plot;
};

/* A sensor's newest scan. */
struct open_scan {
    int32_t sensor_id;
    size_t entry;
};

struct scan_reader {
    const struct parameters *parameters;
    bool keep_going;
    int64_t interval_us;
    struct entry *entries;
    size_t num_entries, entries_capacity;
    struct member *members;
    size_t num_members, members_capacity;
    struct open_scan *open;
    size_t num_open, open_capacity;
    struct scan_numbers numbers;
    struct rho_plot *plots; /* all, scan by scan */
    size_t next;
    uint64_t rows_skipped;
};

/* ---- Rows to scans ---- */

static size_t add_entry(struct scan_reader *reader, const struct plot_row *row)
{
    struct entry *entry;

    reader->entries = must_grow(reader->entries, reader->num_entries, &reader->entries_capacity,
                                sizeof *reader->entries);
    entry = &reader->entries[reader->num_entries];
    *entry = (struct entry){
        .scan = {.time_us = row->time_us,
                 .sensor_id = row->sensor_id,
                 .sector_from_rad = row->sector_from_rad,
                 .sector_to_rad = row->sector_to_rad},
        .number = row->number,
        .start_us = row->time_us,
        .order = reader->num_entries,
        .has_sensor = row->has_sensor,
        .sensor = row->sensor,
    };
    return reader->num_entries++;
}

static struct open_scan *find_open(const struct scan_reader *reader, int32_t sensor_id)
{
    for (size_t i = 0; i < reader->num_open; i++) {
        if (reader->open[i].sensor_id == sensor_id) {
            return &reader->open[i];
        }
    }
    return NULL;
}

/* The scan that a row belongs to: that of its number, else the sensor's newest; NULL: it begins one. */
static struct entry *find_entry(const struct scan_reader *reader, const struct plot_row *row)
{
    const struct open_scan *open = find_open(reader, row->sensor_id);
    size_t index = scan_numbers_find(&reader->numbers, row->sensor_id, &row->number);
    struct entry *entry;

    if (index == SCAN_NUMBERS_NONE && !open) {
        return NULL;
    }
    entry = &reader->entries[index == SCAN_NUMBERS_NONE ? open->entry : index];
    return row_joins(&row->number, row->time_us, &entry->number, entry->start_us,
                     reader->interval_us)
               ? entry
               : NULL;
}

static size_t begin_entry(struct scan_reader *reader, const struct plot_row *row)
{
    struct open_scan *open = find_open(reader, row->sensor_id);

    if (!open) {
        reader->open =
            must_grow(reader->open, reader->num_open, &reader->open_capacity, sizeof *reader->open);
        open = &reader->open[reader->num_open++];
        open->sensor_id = row->sensor_id;
    }
    open->entry = add_entry(reader, row);
    scan_numbers_set(&reader->numbers, row->sensor_id, &row->number, open->entry);
    return open->entry;
}

static void add_member(struct scan_reader *reader, size_t index, const struct plot_row *row)
{
    struct entry *entry = &reader->entries[index];
    struct member *member;

    reader->members = must_grow(reader->members, reader->num_members, &reader->members_capacity,
                                sizeof *reader->members);
    member = &reader->members[reader->num_members++];
    *member = (struct member){index, row->time_us, row->plot};
    entry->scan.num_plots++;
    entry->scan.measures = row->measures;
    entry->has_measures = true;
}

static void add_row(struct scan_reader *reader, const struct plot_row *row)
{
    const struct entry *found = find_entry(reader, row);
    size_t index = found ? (size_t)(found - reader->entries) : begin_entry(reader, row);
    struct entry *entry = &reader->entries[index];

    if (row->has_plot) {
        add_member(reader, index, row);
    } else if (row->number.is_given && !entry->has_time) {
        entry->has_time = true;
        entry->scan.time_us = row->time_us;
    }
}

/* What a row must have in common with the scan that it would join. */
static const char *why_not_same_scan(const struct scan_reader *reader, const struct plot_row *row)
{
    const struct entry *entry = find_entry(reader, row);

    if (!entry) {
        return NULL;
    }
    if (row->sector_from_rad != entry->scan.sector_from_rad ||
        row->sector_to_rad != entry->scan.sector_to_rad) {
        return "the sector is not that of the scan's first row";
    }
    if (row->sensor.x_m != entry->sensor.x_m || row->sensor.y_m != entry->sensor.y_m ||
        row->sensor.z_m != entry->sensor.z_m) {
        return "the sensor's place is not that of the scan's first row";
    }
    if (row->has_plot && entry->has_measures && row->measures != entry->scan.measures) {
        return "height, velocity or range rate must be given in all rows of a scan or in none";
    }
    return NULL;
}

static bool check_order(const struct scan_reader *reader, const struct plot_row *row,
                        const int64_t *last_us, char *reason)
{
    const char *why = why_not_same_scan(reader, row);
    bool is_within = row->number.is_given && find_entry(reader, row);

    if (last_us && row->time_us < *last_us && !is_within) {
        snprintf(reason, PLOT_ROW_REASON_BYTES, "time goes back from %.6f s to %.6f s",
                 (double)*last_us * 1e-6, (double)row->time_us * 1e-6);
        return false;
    }
    if (why) {
        snprintf(reason, PLOT_ROW_REASON_BYTES, "%s", why);
    }
    return !why;
}

static void read_table(struct scan_reader *reader, const struct table *table)
{
    struct plot_columns columns = plot_columns_find(table);
    char reason[PLOT_ROW_REASON_BYTES];
    struct plot_row row;
    int64_t last_us = 0;
    bool has_last = false;

    for (size_t i = 0; i < table->num_rows; i++) {
        if (!plot_row_read(table, &columns, i, reader->parameters, &row, reason) ||
            !check_order(reader, &row, has_last ? &last_us : NULL, reason)) {
            if (!reader->keep_going) {
                table_fail(table, i, "%s", reason);
            }
            reader->rows_skipped++;
            continue;
        }
        last_us = has_last && last_us > row.time_us ? last_us : row.time_us;
        has_last = true;
        add_row(reader, &row);
    }
    if (!has_last) {
        table_fail(table, TABLE_HEADER, "not one good row after the header");
    }
}

/* ---- Logs to scans ---- */

static void add_item(struct scan_reader *reader, const struct rho_feed_item *item)
{
    const struct plot_row scan = {.time_us = item->scan.time_us,
                                  .sensor_id = item->scan.sensor_id,
                                  .sector_from_rad = item->scan.sector_from_rad,
                                  .sector_to_rad = item->scan.sector_to_rad,
                                  .has_sensor = item->has_sensor,
                                  .sensor = item->sensor};
    size_t index = add_entry(reader, &scan);

    reader->entries[index].scan.measures = item->scan.measures;
    for (uint32_t i = 0; i < item->scan.num_plots; i++) {
        reader->members = must_grow(reader->members, reader->num_members, &reader->members_capacity,
                                    sizeof *reader->members);
        reader->members[reader->num_members++] =
            (struct member){index, item->scan.time_us, item->scan.plots[i]};
        reader->entries[index].scan.num_plots++;
    }
}

static void read_log(struct scan_reader *reader, const char *path)
{
    struct log_scans scans = log_scans_read(path, reader->parameters, reader->keep_going, true);

    for (size_t i = 0; i < scans.count; i++) {
        if (scans.items[i].kind != RHO_FEED_BEARINGS) {
            add_item(reader, &scans.items[i]);
        }
    }
    log_scans_free(&scans);
}

/* ---- All files ---- */

static void read_path(struct scan_reader *reader, const char *path)
{
    struct table *table;

    if (lcm_log_is_log(path)) {
        read_log(reader, path);
        return;
    }
    table = table_read(path, reader->keep_going);
    table_need_rows(table);

    reader->rows_skipped += table->rows_skipped;
    reader->num_open = 0;
    scan_numbers_clear(&reader->numbers);
    read_table(reader, table);
    table_free(table);
}

/* ---- Scans in order ---- */

/* Places the plots scan by scan, in the order of their rows. */
static void place_plots(struct scan_reader *reader)
{
    size_t start = 0;

    reader->plots = must_alloc((reader->num_members + 1) * sizeof *reader->plots);
    for (size_t i = 0; i < reader->num_entries; i++) {
        reader->entries[i].first_plot = start;
        reader->entries[i].scan.plots = reader->plots + start;
        start += reader->entries[i].scan.num_plots;
    }
    for (size_t i = 0; i < reader->num_members; i++) {
        const struct member *member = &reader->members[i];
        struct entry *entry = &reader->entries[member->entry];
        struct rho_plot *plot = &reader->plots[entry->first_plot++];

        *plot = member->plot;
        plot->offset_us += (int32_t)(member->time_us - entry->scan.time_us);
    }
    free(reader->members);
    reader->members = NULL;
}

static int compare_entries(const void *a, const void *b)
{
    const struct entry *first = a, *second = b;

    if (first->scan.time_us != second->scan.time_us) {
        return first->scan.time_us < second->scan.time_us ? -1 : 1;
    }
    return first->order < second->order ? -1 : 1;
}

struct scan_reader *scan_reader_open(char *const *paths, int num_paths,
                                     const struct parameters *parameters, bool keep_going)
{
    struct scan_reader *reader = must_calloc(1, sizeof *reader);

    reader->parameters = parameters;
    reader->keep_going = keep_going;
    reader->interval_us = llround(parameters->value[PARAMETER_SCAN_INTERVAL_S] * 1e6);
    for (int i = 0; i < num_paths; i++) {
        read_path(reader, paths[i]);
    }
    place_plots(reader);
    qsort(reader->entries, reader->num_entries, sizeof *reader->entries, compare_entries);
    return reader;
}

const struct rho_scan *scan_reader_next(struct scan_reader *reader)
{
    return reader->next < reader->num_entries ? &reader->entries[reader->next++].scan : NULL;
}

void scan_reader_skip(struct scan_reader *reader, uint64_t scans)
{
    say_last_taken(scans, reader->num_entries, "scans");
    if (reader->num_entries > scans) {
        reader->next = reader->num_entries - scans;
    }
}

const struct rho_sensor *scan_reader_sensor(const struct scan_reader *reader)
{
    const struct entry *entry = reader->next > 0 ? &reader->entries[reader->next - 1] : NULL;

    return entry && entry->has_sensor ? &entry->sensor : NULL;
}

uint64_t scan_reader_total(const struct scan_reader *reader)
{
    return reader->num_entries;
}

struct scan_reader_counts scan_reader_counts(const struct scan_reader *reader)
{
    return (struct scan_reader_counts){reader->num_entries, reader->num_members,
                                       reader->rows_skipped};
}

void scan_reader_report(const struct scan_reader *reader)
{
    say_rows_skipped(reader->rows_skipped);
}

void scan_reader_close(struct scan_reader *reader)
{
    if (!reader) {
        return;
    }
    free(reader->entries);
    free(reader->open);
    scan_numbers_clear(&reader->numbers);
    free(reader->plots);
    free(reader);
}
