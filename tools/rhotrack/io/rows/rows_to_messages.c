/* SPDX-License-Identifier: MIT */
#include "io/rows/rows_to_messages.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/csv/row_cells.h"

#define OWN_TIME_MAX_US 60000000 /* limit of dt_us in messages; scan_interval_s is never longer */

/* State of grouping a file's rows into scans; rows of one scan are adjacent after sorting. */
struct scan_grouping {
    struct rows_to_messages *scans;
    struct rows_file *file;
    const struct rows_kind *kind;
    int64_t interval_us;
    struct row *rows;
    /* for lists without numbers: index of the row before with the same identity and time */
    size_t *before;
};

static int by_scan_and_order(const void *a, const void *b)
{
    const struct row *one = a, *other = b;
    int order = rows_compare_int64(one->sensor_id, other->sensor_id);

    order = order ? order : rows_compare_int64(one->epoch, other->epoch);
    order = order ? order : rows_compare_int64(one->scan, other->scan);
    return order ? order : rows_compare_int64((int64_t)one->order, (int64_t)other->order);
}

/* Order of lists' rows: by time as well, since the file may have them in any order. */
static int by_epoch_scan_time_and_order(const void *a, const void *b)
{
    const struct row *one = a, *other = b;
    int order = rows_compare_int64(one->epoch, other->epoch);

    order = order ? order : rows_compare_int64(one->scan, other->scan);
    order = order ? order : rows_compare_int64(one->time_us, other->time_us);
    return order ? order : rows_compare_int64((int64_t)one->order, (int64_t)other->order);
}

struct named_row {
    int64_t time_us;
    double name;
    size_t row;
};

/* Order by time, then by track or target, then by row. */
static int by_time_name_and_row(const void *a, const void *b)
{
    const struct named_row *one = a, *other = b;
    int order = rows_compare_int64(one->time_us, other->time_us);

    order = order ? order : (one->name > other->name) - (one->name < other->name);
    return order ? order : (one->row > other->row) - (one->row < other->row);
}

/*
 * For each row, finds the row before with the same track or target at the same time; SIZE_MAX where
 * there is none.
 */
static void find_repeated_ids(struct scan_grouping *grouping)
{
    size_t count = grouping->file->rows.count;
    struct named_row *named = must_alloc(count * sizeof *named);

    grouping->before = must_alloc(count * sizeof *grouping->before);
    for (size_t i = 0; i < count; i++) {
        named[i] = (struct named_row){grouping->rows[i].time_us,
                                      rows_cells(&grouping->file->rows, &grouping->rows[i])[0], i};
    }
    qsort(named, count, sizeof *named, by_time_name_and_row);
    for (size_t i = 0; i < count; i++) {
        bool is_again = i > 0 && named[i].time_us == named[i - 1].time_us &&
                        !(named[i].name > named[i - 1].name);

        grouping->before[named[i].row] = is_again ? named[i - 1].row : SIZE_MAX;
    }
    free(named);
}

static bool is_same_cell(double one, double other)
{
    return rows_is_cell_empty(one) ? rows_is_cell_empty(other) : one <= other && one >= other;
}

/* Name of the first column with that flag in which two rows differ, or NULL. */
static const char *find_differing_column(const struct scan_grouping *grouping, const double *cells,
                                         const double *others, unsigned flag)
{
    for (int i = 0; i < grouping->kind->num_columns; i++) {
        if ((grouping->kind->columns[i].flags & flag) && !is_same_cell(cells[i], others[i])) {
            return column_name(grouping->kind->columns[i].id);
        }
    }
    return NULL;
}

/*
 * Whether a row belongs to the turn that begins with the row first, and agrees with the turn's
 * newest row that has a measurement, so that one scan of messages can hold it.
 */
static bool joins_turn(const struct scan_grouping *grouping, size_t first, size_t index)
{
    const struct row *row = &grouping->rows[index], *other = &grouping->rows[index - 1];
    const double *cells = rows_cells(&grouping->file->rows, row), *others;

    while (other > &grouping->rows[first] &&
           !rows_row_has_measurement(&grouping->file->rows, other)) {
        other--;
    }
    others = rows_cells(&grouping->file->rows, other);
    return row->turn == grouping->rows[first].turn &&
           row->time_us - grouping->rows[first].time_us <= OWN_TIME_MAX_US &&
           !find_differing_column(grouping, cells, others, COLUMN_OF_SCAN) &&
           (!rows_row_has_measurement(&grouping->file->rows, row) ||
            !rows_row_has_measurement(&grouping->file->rows, other) ||
            (!find_differing_column(grouping, cells, others, COLUMN_OF_PLOTS) &&
             (!grouping->kind->pattern ||
              grouping->kind->pattern(cells) == grouping->kind->pattern(others))));
}

/* Whether a row belongs to the scan or list that begins with the row first. */
static bool joins_scan(const struct scan_grouping *grouping, size_t first, size_t index)
{
    const struct row *start = &grouping->rows[first], *row = &grouping->rows[index];

    if (row->sensor_id != start->sensor_id || row->epoch != start->epoch ||
        row->scan != start->scan) {
        return false;
    }
    if (!grouping->kind->has_sensor) {
        return row->time_us == start->time_us &&
               (!grouping->before || grouping->before[index] == SIZE_MAX ||
                grouping->before[index] < first);
    }
    if (row->turn > 0) {
        return joins_turn(grouping, first, index);
    }
    if (grouping->file->has_scan) {
        return llabs(row->time_us - start->time_us) <= OWN_TIME_MAX_US;
    }
    return row->time_us == start->time_us ||
           (row->time_us > start->time_us && row->time_us - grouping->interval_us < start->time_us);
}

/*
 * Checks that a row with a measurement agrees with the scan's first such row, and refuses it
 * otherwise.
 */
static bool check_plot_fits_scan(struct scan_grouping *grouping, const struct rows_scan *scan,
                                 const struct row *row)
{
    const struct row *first = &grouping->rows[scan->first];
    const double *cells = rows_cells(&grouping->file->rows, row);
    const double *others = rows_cells(&grouping->file->rows, first);
    const char *name = find_differing_column(grouping, cells, others, COLUMN_OF_PLOTS);

    if (name) {
        rows_refuse_row(grouping->file, row,
                        "%s differs from that of the scan's other rows: a message has one", name);
        return false;
    }
    if (grouping->kind->pattern &&
        grouping->kind->pattern(cells) != grouping->kind->pattern(others)) {
        rows_refuse_row(
            grouping->file, row,
            "height, velocity or range rate must be given in all rows of a scan or in none");
        return false;
    }
    if (grouping->kind->rows_max > 0 && scan->count >= grouping->kind->rows_max) {
        rows_refuse_row(grouping->file, row,
                        "a scan has more than %zu rows, the limit of a message",
                        grouping->kind->rows_max);
        return false;
    }
    return true;
}

static bool check_received_fits_scan(struct scan_grouping *grouping, const struct rows_scan *scan,
                                     const struct row *row)
{
    char reason[ROW_REASON_BYTES];
    const struct row_check check = {.reason = reason};

    if (grouping->file->rows.has_received &&
        !row_check_received(&check, row->received_us, scan->head.received_us,
                            grouping->file->has_scan, grouping->interval_us)) {
        rows_refuse_row(grouping->file, row, "%s", reason);
        return false;
    }
    return true;
}

static bool check_row_fits_scan(struct scan_grouping *grouping, const struct rows_scan *scan,
                                const struct row *row)
{
    const char *name =
        find_differing_column(grouping, rows_cells(&grouping->file->rows, row),
                              rows_cells(&grouping->file->rows, &scan->head), COLUMN_OF_SCAN);

    if (name) {
        rows_refuse_row(grouping->file, row, "%s differs from that of the scan's first row", name);
        return false;
    }
    if (!check_received_fits_scan(grouping, scan, row)) {
        return false;
    }
    if (grouping->kind->has_one_time && row->time_us != scan->utime) {
        rows_refuse_row(
            grouping->file, row,
            "t_s differs from that of the scan's first row: a scan of bearings has one time");
        return false;
    }
    return true;
}

/*
 * Time of a scan: with numbers that of its row without a measurement, which may stand anywhere,
 * else of its first row.
 */
static int64_t scan_time_us(const struct scan_grouping *grouping, size_t first, size_t end)
{
    for (size_t i = first; grouping->file->has_scan && i < end; i++) {
        if (!rows_row_has_measurement(&grouping->file->rows, &grouping->rows[i])) {
            return grouping->rows[i].time_us;
        }
    }
    return grouping->rows[first].time_us;
}

/*
 * The kind of messages that hold all scans of the file: the wider one where a row needs it or has a
 * time of its own, or a sensor moves.
 */
static const struct rows_kind *kind_of_messages(const struct scan_grouping *grouping)
{
    const struct rows *rows = &grouping->file->rows;
    size_t first = 0;

    for (size_t i = 0; grouping->kind->wider && i < rows->count; i++) {
        const struct row *row = &grouping->rows[i], *before = &grouping->rows[i - (i > 0)];

        first = i > first && joins_scan(grouping, first, i) ? first : i;
        if (rows_kind_of_row(rows, row) != grouping->kind ||
            row->time_us != grouping->rows[first].time_us ||
            (row->sensor_id == before->sensor_id &&
             find_differing_column(grouping, rows_cells(rows, row), rows_cells(rows, before),
                                   COLUMN_STAYS))) {
            return grouping->kind->wider;
        }
    }
    return grouping->kind;
}

/* Number of rows, from the first of the rest of a scan on, that fit one message. */
static size_t rows_that_fit(const struct rows_kind *kind, const struct rows_part *rest)
{
    size_t count = rest->count > 0;

    while (count < rest->count && count < kind->part_max &&
           (!kind->fit || kind->fit(rows_part_cells(rest, 0), rows_part_cells(rest, count)))) {
        count++;
    }
    return count;
}

static size_t count_parts(const struct scan_grouping *grouping, const struct rows_scan *scan)
{
    struct rows_part rest = {
        .rows = &grouping->file->rows, .scan = scan, .first = scan->first, .count = scan->count};
    size_t parts = 0;

    while (rest.count > 0) {
        size_t taken = rows_that_fit(grouping->kind, &rest);

        rest.first += taken;
        rest.count -= taken;
        parts++;
    }
    return parts > 0 ? parts : 1;
}

/* Makes a scan of the rows first .. end; those with a measurement are moved together. */
static void add_scan_of_rows(struct scan_grouping *grouping, size_t first, size_t end)
{
    struct rows_to_messages *scans = grouping->scans;
    struct rows_scan scan = {.utime = scan_time_us(grouping, first, end),
                             .head = grouping->rows[first],
                             .first = first,
                             .order = grouping->rows[first].order};
    size_t parts;

    scan.due_us =
        grouping->file->rows.has_received ? grouping->rows[end - 1].received_us : scan.utime;
    for (size_t i = first; i < end; i++) {
        struct row row = grouping->rows[i];
        bool is_plot = rows_row_has_measurement(&grouping->file->rows, &row);

        if (!check_row_fits_scan(grouping, &scan, &row) ||
            (is_plot && scan.count > 0 && !check_plot_fits_scan(grouping, &scan, &row))) {
            continue;
        }
        if (is_plot) {
            grouping->rows[first + scan.count++] = row;
        }
    }
    parts = count_parts(grouping, &scan);
    if (parts > INT16_MAX) {
        rows_refuse_row(grouping->file, &scan.head,
                        "a scan of %zu parts; messages can number 32767", parts);
        return;
    }
    scan.num_parts = (int16_t)parts;
    scans->list =
        must_make_room_for_one(scans->list, scans->count, &scans->capacity, sizeof *scans->list);
    scans->list[scans->count++] = scan;
}

static int by_sensor_epoch_and_time(const void *a, const void *b)
{
    const struct rows_scan *one = a, *other = b;
    int order = rows_compare_int64(one->head.sensor_id, other->head.sensor_id);

    order = order ? order : rows_compare_int64(one->head.epoch, other->head.epoch);
    order = order ? order : rows_compare_int64(one->utime, other->utime);
    return order ? order : rows_compare_int64((int64_t)one->order, (int64_t)other->order);
}

/*
 * Numbers each sensor's scans in the order of time, even where they were received in another order.
 */
static void number_scans(const struct scan_grouping *grouping)
{
    struct rows_scan *list = grouping->scans->list;
    int32_t number = 0;

    if (grouping->scans->count > 0) {
        qsort(list, grouping->scans->count, sizeof *list, by_sensor_epoch_and_time);
    }
    for (size_t i = 0; i < grouping->scans->count; i++) {
        bool is_next = i > 0 && list[i].head.sensor_id == list[i - 1].head.sensor_id &&
                       list[i].head.epoch == list[i - 1].head.epoch;

        number = is_next && number < INT32_MAX ? number + 1 : 1;
        list[i].head.scan = number;
    }
}

static int by_due_time(const void *a, const void *b)
{
    const struct rows_scan *one = a, *other = b;
    int order = rows_compare_int64(one->due_us, other->due_us);

    return order ? order : rows_compare_int64((int64_t)one->order, (int64_t)other->order);
}

void rows_to_messages_make_scans(struct rows_to_messages *scans, struct rows_file *file,
                                 int64_t interval_us)
{
    struct scan_grouping grouping = {.scans = scans,
                                     .file = file,
                                     .kind = file->rows.kind,
                                     .interval_us = interval_us,
                                     .rows = file->rows.list};

    *scans = (struct rows_to_messages){.file = file};
    qsort(file->rows.list, file->rows.count, sizeof *file->rows.list,
          grouping.kind->has_sensor ? by_scan_and_order : by_epoch_scan_time_and_order);
    if (!grouping.kind->has_sensor && !file->has_scan) {
        find_repeated_ids(&grouping);
    }
    file->rows.kind = grouping.kind = kind_of_messages(&grouping);
    for (size_t first = 0, end; first < file->rows.count; first = end) {
        for (end = first + 1; end < file->rows.count && joins_scan(&grouping, first, end); end++) {
        }
        add_scan_of_rows(&grouping, first, end);
    }
    free(grouping.before);
    if (!file->has_scan) {
        number_scans(&grouping);
    }
    if (scans->count > 0) {
        qsort(scans->list, scans->count, sizeof *scans->list, by_due_time);
    }
}

void rows_to_messages_free(struct rows_to_messages *scans)
{
    free(scans->list);
}

static void format_channel_name(const struct rows_kind *kind, int32_t sensor_id, char *channel)
{
    if (kind->has_sensor) {
        snprintf(channel, ROWS_CHANNEL_BYTES, "%s%" PRId32, kind->channel, sensor_id);
    } else {
        snprintf(channel, ROWS_CHANNEL_BYTES, "%s", kind->channel);
    }
}

bool rows_to_messages_next_message(const struct rows_to_messages *scans, struct rows_at *at,
                                   struct rows_output *output)
{
    const struct rows_kind *kind = scans->file->rows.kind;
    struct rows_part part = {.rows = &scans->file->rows, .part = at->part};
    const char *field = "";

    if (at->scan >= scans->count) {
        return false;
    }
    part.scan = &scans->list[at->scan];
    part.first = part.scan->first + at->row;
    part.count = part.scan->count - at->row;
    part.count = rows_that_fit(kind, &part);
    output->utime = part.scan->due_us;
    format_channel_name(kind, part.scan->head.sensor_id, output->channel);
    output->size = kind->encode(&part, output->data, &field);
    /* each row can be encoded alone: the value fails in this combination of rows */
    if (output->size == 0) {
        fail(EXIT_USAGE, "%s:%u: %s is outside the range of a %s", scans->file->path,
             (unsigned)part.scan->head.line, field, rho_message_type_name(kind->type));
    }
    at->row += part.count;
    at->part++;
    if (at->part >= part.scan->num_parts) {
        *at = (struct rows_at){.scan = at->scan + 1};
    }
    return true;
}
