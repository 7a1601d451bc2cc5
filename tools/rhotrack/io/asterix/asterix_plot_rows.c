/* SPDX-License-Identifier: MIT */
#include "io/asterix/asterix_plot_rows.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/asterix/asterix_file.h"

#define PI 3.141592653589793
#define HOLD_S 5.0 /* wait for late plots of a look; waiting costs nothing in a file */

enum column {
    AT_T_S,
    AT_SENSOR_ID,
    AT_RANGE_M,
    AT_AZIMUTH_RAD,
    AT_ALT_M,
    AT_RANGE_RATE_MPS,
    AT_SENSOR_LAT_DEG,
    AT_SENSOR_LON_DEG,
    AT_SENSOR_ALT_M,
    AT_SECTOR_FROM_RAD,
    AT_SECTOR_TO_RAD,
    AT_SCAN,
    NUM_COLUMNS
};

static const struct table_column all_columns[NUM_COLUMNS] = {
    [AT_T_S] = {.name = "t_s", .decimals = 6},
    [AT_SENSOR_ID] = {.name = "sensor_id", .decimals = 0},
    [AT_RANGE_M] = {.name = "range_m", .decimals = 6},
    [AT_AZIMUTH_RAD] = {.name = "azimuth_rad", .decimals = 9},
    [AT_ALT_M] = {.name = "alt_m", .decimals = 2},
    [AT_RANGE_RATE_MPS] = {.name = "range_rate_mps", .decimals = 0},
    [AT_SENSOR_LAT_DEG] = {.name = "sensor_lat_deg", .decimals = 9},
    [AT_SENSOR_LON_DEG] = {.name = "sensor_lon_deg", .decimals = 9},
    [AT_SENSOR_ALT_M] = {.name = "sensor_alt_m", .decimals = 0},
    [AT_SECTOR_FROM_RAD] = {.name = "sector_from_rad", .decimals = 9},
    [AT_SECTOR_TO_RAD] = {.name = "sector_to_rad", .decimals = 9},
    [AT_SCAN] = {.name = "scan", .decimals = 0},
};

static bool has_table_column(const struct asterix_columns *columns, int column)
{
    if (column >= AT_SECTOR_FROM_RAD) {
        return columns->has_scan;
    }
    return column < AT_SENSOR_LAT_DEG || columns->has_place;
}

struct table *asterix_plot_rows_empty_table(const char *path, const struct asterix_columns *columns)
{
    struct table_column list[NUM_COLUMNS];
    size_t count = 0;

    for (int i = 0; i < NUM_COLUMNS; i++) {
        if (has_table_column(columns, i)) {
            list[count++] = all_columns[i];
        }
    }
    return table_make_empty_of_numbers(path, list, count);
}

/* A row of the table: its time, its rank among rows of equal time, and its cells by enum column. */
struct output_row {
    int64_t time_128;
    uint64_t order;
    double cells[NUM_COLUMNS];
};

/*
 * Azimuth in radians counter-clockwise from east, -pi .. pi, from ASTERIX units clockwise from
 * north.
 */
static double azimuth_rad_from_units(uint32_t azimuth)
{
    return remainder(PI / 2 - 2 * PI / ASTERIX_TURN * azimuth, 2 * PI);
}

/*
 * Sets a cell, rounded to the column's decimals, so that a converted CSV file gives equal values.
 */
static void put_rounded_cell(struct output_row *row, enum column column, double value)
{
    static const double scales[] = {1, 10, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
    double scale = scales[all_columns[column].decimals];

    row->cells[column] = rint(value * scale) / scale;
}

static void put_plot_cells(struct output_row *row, const struct asterix_scan_plot *mark)
{
    put_rounded_cell(row, AT_RANGE_M,
                     mark->is_ground ? mark->ground_m : mark->range * ASTERIX_RANGE_M);
    put_rounded_cell(row, AT_AZIMUTH_RAD, azimuth_rad_from_units(mark->azimuth));
    if (mark->has_alt) {
        put_rounded_cell(row, AT_ALT_M, mark->alt * ASTERIX_HEIGHT_M);
    }
    if (mark->has_doppler) {
        put_rounded_cell(row, AT_RANGE_RATE_MPS, mark->doppler_mps);
    }
}

/* A row of a scan: of a plot, or with NULL the row without a plot that begins the scan. */
static struct output_row make_row_of_plot_or_scan_start(const struct asterix_scan *scan,
                                                        const struct asterix_scan_plot *mark)
{
    struct output_row row = {.time_128 = mark ? mark->time_128 : scan->time_128};

    for (int i = 0; i < NUM_COLUMNS; i++) {
        row.cells[i] = (double)NAN;
    }
    put_rounded_cell(&row, AT_SENSOR_ID, scan->sensor_id);
    if (mark) {
        put_plot_cells(&row, mark);
    }
    if (scan->place.is_given) {
        put_rounded_cell(&row, AT_SENSOR_LAT_DEG, scan->place.lat_deg);
        put_rounded_cell(&row, AT_SENSOR_LON_DEG, scan->place.lon_deg);
        put_rounded_cell(&row, AT_SENSOR_ALT_M, scan->place.alt_m);
    }
    /*
     * The antenna turns clockwise, so that counter-clockwise the sector goes from its end to its
     * start.
     */
    if (!scan->is_turn) {
        put_rounded_cell(&row, AT_SECTOR_FROM_RAD,
                         azimuth_rad_from_units(scan->look.from + scan->look.advance));
        put_rounded_cell(&row, AT_SECTOR_TO_RAD, azimuth_rad_from_units(scan->look.from));
    }
    if (scan->is_numbered) {
        put_rounded_cell(&row, AT_SCAN, scan->number);
    }
    return row;
}

static void add_row_to_table(struct table *table, const struct output_row *row, uint32_t line)
{
    double *cells = table_add_row_of_numbers(table, asterix_time_us(row->time_128), line);
    int column = 0;

    for (size_t i = 0; i < table->num_columns; i++) {
        while (strcmp(table->names[i], all_columns[column].name) != 0) {
            column++; /* the table's columns are in the order of enum column */
        }
        cells[i] = row->cells[column];
    }
}

void asterix_plot_rows_add_scan(struct table *table, const struct asterix_scan *scan)
{
    struct output_row row = make_row_of_plot_or_scan_start(scan, NULL);

    add_row_to_table(table, &row, 2);
    for (size_t i = 0; i < scan->count; i++) {
        row = make_row_of_plot_or_scan_start(scan, &scan->marks[i]);
        add_row_to_table(table, &row, (uint32_t)i + 3);
    }
}

struct asterix_plot_rows {
    char *path;
    struct asterix_file *file;
    struct asterix_scans *scans;
    struct asterix_columns columns;
    struct output_row *list; /* rows not given out yet, from `next` on, sorted by time */
    size_t count, capacity, next;
    uint64_t order, late;
    uint32_t line;     /* line number of the next row in the CSV file that `convert` would write */
    int64_t given_128; /* time of the newest row given out */
    bool has_given, is_over, is_hushed;
    bool has_interval; /* scan_interval_s gathers plots of radars without crossings into scans */
    /* radars whose place is not known, where places matter */
    int32_t placeless[ASTERIX_MAX_SENSORS];
    size_t num_placeless;
};

const char asterix_plot_rows_no_tracks[] = "contains tracks (CAT062), but plots are needed; "
                                           "evaluate, plot, convert and publish take tracks";

struct asterix_rules asterix_plot_rows_scan_rules(const struct parameters *parameters,
                                                  double hold_s, double wait_s)
{
    return (struct asterix_rules){
        .hold_s = hold_s,
        .is_by_turn = parameters->value[PARAMETER_ASTERIX_SCANS] > 0.5,
        .interval_s = parameters->value[PARAMETER_SCAN_INTERVAL_S],
        .wait_s = wait_s,
    };
}

void asterix_set_default_origin(const char *path, const struct asterix_place *place,
                                struct parameters *parameters)
{
    parameters_suggest(parameters, PARAMETER_ORIGIN_LAT_DEG, place->lat_deg);
    parameters_suggest(parameters, PARAMETER_ORIGIN_LON_DEG, place->lon_deg);
    parameters_suggest(parameters, PARAMETER_ORIGIN_ALT_M, place->alt_m);
    fprintf(stderr,
            "rhotrack: %s: the origin is origin_lat_deg=%.7f, origin_lon_deg=%.7f, "
            "origin_alt_m=%.0f\n",
            path, place->lat_deg, place->lon_deg, place->alt_m);
}

void asterix_plot_rows_report(const char *path, const struct asterix_counts *counts)
{
    const struct {
        uint64_t count;
        const char *text;
    } lines[] = {
        {counts->not_real, "plots that are simulated, of test targets or of field monitors"},
        {counts->no_detection, "reports without a detection"},
        {counts->incomplete, "plots without source, time or place"},
        {counts->bad_times, "plots with bad times"},
        {counts->late, "late plots"},
        {counts->unplaced, "plots outside all known sectors of the antenna"},
        {counts->no_room, "plots of too many radars"},
        {counts->services_left, "antenna messages without source, time or sector, or late"},
        {counts->gaps, "gaps in the antenna's messages"},
        {counts->levels_left,
         "heights used only to correct the range, in scans with plots without height"},
        {counts->levels_bad, "invalid flight levels"},
        {counts->dopplers_bad, "doubtful Doppler speeds"},
        {counts->dopplers_raw, "ambiguous Doppler speeds"},
        {counts->dopplers_left,
         "Doppler speeds left out, in scans with plots without Doppler speed"},
    };
    const char *between = "";

    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        if (lines[i].count > 0) {
            if (!*between) {
                fprintf(stderr, "rhotrack: %s: ", path);
            }
            fprintf(stderr, "%s%" PRIu64 " %s", between, lines[i].count, lines[i].text);
            between = ", ";
        }
    }
    if (*between) {
        fputc('\n', stderr);
    }
}

/*
 * Notes the radar of a record and the columns that it fills. Returns whether it can be used: it has
 * a place of a plot, or the type and time of an antenna message.
 */
static bool preview_record(struct asterix_plot_rows *records, const struct asterix_record *record)
{
    struct asterix_service service;
    struct asterix_plot plot;

    asterix_scans_preview_record(records->scans, record);
    if (asterix_category_is_plots(record->category)) {
        asterix_plot_read(record, &plot);
        return plot.has_position;
    }
    asterix_service_read(record, &service);
    records->columns.has_place |= service.place.is_given;
    records->columns.has_scan |=
        service.has_type && (service.type == ASTERIX_NORTH || service.type == ASTERIX_SECTOR);
    return service.has_type && service.has_time;
}

static void preview_recording(struct asterix_plot_rows *records, bool keep_going)
{
    struct asterix_file *file = asterix_file_open(records->path, keep_going);
    struct asterix_record record;
    bool has_any = false;

    while (asterix_file_next_record(file, &record)) {
        has_any |= preview_record(records, &record);
    }
    if (!has_any && asterix_file_skipped_blocks(file, ASTERIX_TRACKS) > 0) {
        fail(EXIT_USAGE, "%s: %s", records->path, asterix_plot_rows_no_tracks);
    }
    if (!has_any) {
        fail(EXIT_USAGE,
             "%s: contains no plot (CAT048, CAT001), north marker or sector crossing (CAT034, "
             "CAT002)",
             records->path);
    }
    asterix_file_close(file);
}

/*
 * Finds radars without a place, which are put at the origin: that is correct only for a single
 * radar without an origin on the earth.
 */
static void list_placeless_radars(struct asterix_plot_rows *records,
                                  const struct parameters *parameters)
{
    size_t count = asterix_scans_num_sensors(records->scans);
    int32_t sensor_id;

    if (count < 2 && !parameters_has_origin(parameters)) {
        return;
    }
    for (size_t i = 0; i < count; i++) {
        if (!asterix_scans_sensor_has_place(records->scans, i, &sensor_id) &&
            isnan(parameters_value_of_sensor(parameters, sensor_id, SENSOR_X_M, NAN))) {
            records->placeless[records->num_placeless++] = sensor_id;
        }
    }
}

struct asterix_plot_rows *
asterix_plot_rows_open(const char *path, const struct parameters *parameters, bool keep_going)
{
    struct asterix_rules rules = {.hold_s = HOLD_S};
    struct asterix_plot_rows *records = must_calloc(1, sizeof *records);

    if (parameters) {
        rules = asterix_plot_rows_scan_rules(parameters, HOLD_S, 0);
    }
    records->path = must_copy_text(path);
    records->line = 2;
    records->columns.has_scan = rules.interval_s > 0;
    records->has_interval = rules.interval_s > 0;
    records->scans = asterix_scans_open(&rules);
    preview_recording(records, keep_going);
    if (parameters) {
        list_placeless_radars(records, parameters);
    }
    records->file = asterix_file_open(path, keep_going);
    return records;
}

void asterix_plot_rows_set_quiet(struct asterix_plot_rows *records)
{
    records->is_hushed = true;
}

/*
 * Queues the row of a plot, or with mark NULL the row that begins a scan. A row before the newest
 * one given out is counted as late instead.
 */
static void queue_row_unless_late(struct asterix_plot_rows *records,
                                  const struct asterix_scan *scan,
                                  const struct asterix_scan_plot *mark)
{
    struct output_row row = make_row_of_plot_or_scan_start(scan, mark);

    if (records->has_given && row.time_128 < records->given_128) {
        records->late++;
        return;
    }
    row.order = records->order++;
    records->list = must_make_room_for_one(records->list, records->count, &records->capacity,
                                           sizeof *records->list);
    records->list[records->count++] = row;
}

static int by_time_and_order(const void *a, const void *b)
{
    const struct output_row *one = a, *other = b;
    int order = (one->time_128 > other->time_128) - (one->time_128 < other->time_128);

    return order ? order : (one->order > other->order) - (one->order < other->order);
}

/* Removes the rows that were given out, and adds those of the scans that are complete. */
static void queue_rows_of_complete_scans(struct asterix_plot_rows *records)
{
    struct asterix_scan scan;
    size_t before = records->count;

    while (asterix_scans_next(records->scans, &scan)) {
        if (records->next > 0) {
            records->count -= records->next;
            memmove(records->list, records->list + records->next,
                    records->count * sizeof *records->list);
            records->next = 0;
            before = 0;
        }
        if (scan.is_numbered) {
            queue_row_unless_late(records, &scan, NULL);
        }
        for (size_t i = 0; i < scan.count; i++) {
            queue_row_unless_late(records, &scan, &scan.marks[i]);
        }
    }
    if (records->count != before) {
        qsort(records->list, records->count, sizeof *records->list, by_time_and_order);
    }
}

static void report_at_end(const struct asterix_plot_rows *records)
{
    const struct asterix_counts *counts = asterix_scans_counts(records->scans);

    asterix_file_report_skipped(records->file);
    asterix_plot_rows_report(records->path, counts);
    for (size_t i = 0; i < records->num_placeless; i++) {
        fprintf(stderr,
                "rhotrack: %s: sensor %" PRId32
                " reports no position and is assumed at the origin; set sensor.%" PRId32
                ".lat_deg and lon_deg\n",
                records->path, records->placeless[i], records->placeless[i]);
    }
    if (records->late > 0) {
        fprintf(stderr, "rhotrack: %s: %" PRIu64 " rows left out: their radar's clock is behind\n",
                records->path, records->late);
    }
    if (!records->columns.has_scan) {
        fprintf(stderr,
                "rhotrack: %s: contains no north markers or sector crossings: scans are made from "
                "the plots' times, or by scan_interval_s\n",
                records->path);
    }
}

/* Processes the next record of the file, or its end. */
static void process_next_record(struct asterix_plot_rows *records)
{
    struct asterix_record record;

    if (asterix_file_next_record(records->file, &record)) {
        asterix_scans_take_record(records->scans, &record);
    } else {
        asterix_scans_finish(records->scans);
        records->is_over = true;
    }
    queue_rows_of_complete_scans(records);
    if (records->is_over && !records->is_hushed) {
        report_at_end(records);
    }
}

/* Whether the next row can be given out: no earlier row can follow. */
static bool has_settled_row(const struct asterix_plot_rows *records)
{
    return records->next < records->count &&
           (records->is_over ||
            records->list[records->next].time_128 < asterix_scans_settled_time_128(records->scans));
}

bool asterix_plot_rows_next(struct asterix_plot_rows *records, struct table *table)
{
    const struct output_row *row;

    while (!has_settled_row(records)) {
        if (records->is_over) {
            return false;
        }
        process_next_record(records);
    }
    row = &records->list[records->next++];
    records->has_given = true;
    records->given_128 = row->time_128;
    add_row_to_table(table, row, records->line++);
    return true;
}

const struct asterix_columns *asterix_plot_rows_columns(const struct asterix_plot_rows *records)
{
    return &records->columns;
}

uint64_t asterix_plot_rows_position(const struct asterix_plot_rows *records)
{
    return asterix_file_position(records->file);
}

void asterix_plot_rows_close(struct asterix_plot_rows *records)
{
    if (!records) {
        return;
    }
    free(records->list);
    asterix_scans_close(records->scans);
    asterix_file_close(records->file);
    free(records->path);
    free(records);
}
