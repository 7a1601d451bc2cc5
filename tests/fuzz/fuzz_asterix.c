/* SPDX-License-Identifier: MIT */
/*
 * ASTERIX from the network: any bytes as one datagram, put together to scans. The first byte
 * selects the rules: scans by turn or by interval, and whether the radars' messages are known
 * before. Recordings are read by fuzz_tables. Checked: every plot has one fate; scans of a radar
 * come in order of time, none before the time that was declared settled; plots lie within their
 * scan and measure the same; table cells are empty or finite.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/asterix/asterix_plot_rows.h"
#include "io/asterix/asterix_udp_receiver.h"

static void abort_unless(bool holds)
{
    if (!holds) {
        abort();
    }
}

/* Rows of a scan are records whose cells are empty or finite numbers. */
static void check_scan_table_cells_are_finite(const struct asterix_scan *scan)
{
    const struct asterix_columns columns = {.has_place = true, .has_scan = true};
    struct table *table = asterix_plot_rows_empty_table("", &columns);

    asterix_plot_rows_add_scan(table, scan);
    abort_unless(table->num_columns == 12 && table->num_rows == scan->count + 1);
    for (size_t i = 0; i < table->num_rows * table->num_columns; i++) {
        abort_unless(isnan(table->numbers[i]) || isfinite((float)table->numbers[i]));
    }
    table_free(table);
}

static void check_scan(const struct asterix_scan *scan, int64_t not_before_128)
{
    abort_unless(scan->time_128 >= not_before_128 && scan->number > 0);
    abort_unless(scan->look.advance > 0 && scan->look.advance <= ASTERIX_TURN);
    abort_unless(scan->look.end_128 >= scan->look.start_128 &&
                 (scan->is_numbered || scan->count == 1));
    check_scan_table_cells_are_finite(scan);
    for (size_t i = 0; i < scan->count; i++) {
        const struct asterix_scan_plot *mark = &scan->marks[i];

        abort_unless(mark->time_128 >= not_before_128 && mark->range > 0);
        abort_unless(i == 0 || mark->time_128 >= mark[-1].time_128);
        abort_unless(mark->has_alt == scan->marks[0].has_alt);
        abort_unless(mark->has_doppler == scan->marks[0].has_doppler);
    }
}

/*
 * Checks the completed scans; none is earlier than settled_128, the time declared settled before.
 */
static size_t check_scans_and_count_plots(struct asterix_scans *scans, int64_t settled_128)
{
    struct asterix_scan scan;
    size_t count = 0;

    while (asterix_scans_next(scans, &scan)) {
        check_scan(&scan, settled_128);
        count += scan.count;
    }
    return count;
}

static void preview_all_records(struct asterix_scans *scans, const uint8_t *data, size_t size)
{
    struct asterix_block block;
    struct asterix_record record;
    struct asterix_error error;

    for (size_t at = 0; at < size && asterix_block_read(data + at, size - at, &block, &error);
         at += ASTERIX_HEADER_BYTES + block.size) {
        for (size_t i = 0; i < block.size && asterix_record_read(block.category, block.records + i,
                                                                 block.size - i, &record, &error);
             i += record.size) {
            struct asterix_track track;

            asterix_scans_preview_record(scans, &record);
            if (record.category == ASTERIX_TRACKS) {
                asterix_track_read(&record, &track);
            }
        }
    }
}

/* Radars in the datagram: 1, or 2 for two and more. */
static int count_radars_up_to_two(const uint8_t *data, size_t size)
{
    struct asterix_block block;
    struct asterix_record record;
    struct asterix_error error;
    const uint8_t *source = NULL;

    for (size_t at = 0; at < size && asterix_block_read(data + at, size - at, &block, &error);
         at += ASTERIX_HEADER_BYTES + block.size) {
        for (size_t i = 0; i < block.size && asterix_record_read(block.category, block.records + i,
                                                                 block.size - i, &record, &error);
             i += record.size) {
            if (record.items[0] && source && memcmp(source, record.items[0], 2) != 0) {
                return 2;
            }
            source = record.items[0] ? record.items[0] : source;
        }
    }
    return source ? 1 : 0;
}

/* Feeds the bytes as datagrams of one ASTERIX block each. */
static size_t take_datagrams_and_count_plots(struct asterix_scans *scans, const uint8_t *data,
                                             size_t size, struct asterix_datagram_counts *heard)
{
    /* with several radars, one's clock may be behind the other's */
    bool has_one_radar = count_radars_up_to_two(data, size) <= 1;
    struct asterix_block block;
    struct asterix_error error;
    size_t count = 0, bytes;

    for (size_t at = 0; at < size; at += bytes) {
        int64_t settled_128 = has_one_radar ? asterix_scans_settled_time_128(scans) : INT64_MIN;

        settled_128 =
            settled_128 == INT64_MAX ? INT64_MIN : settled_128; /* INT64_MAX: no message so far */
        bytes = asterix_block_read(data + at, size - at, &block, &error)
                    ? ASTERIX_HEADER_BYTES + block.size
                    : size - at;
        asterix_datagram_take_records(scans, data + at, bytes, heard);
        count += check_scans_and_count_plots(scans, settled_128);
    }
    return count;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct asterix_rules rules = {.hold_s = 1, .wait_s = 30};
    struct asterix_datagram_counts heard = {.datagrams = 0};
    const struct asterix_counts *counts;
    struct asterix_scans *scans;
    size_t placed;

    if (size == 0) {
        return 0;
    }
    rules.is_by_turn = (data[0] & 1) != 0;
    rules.interval_s = (data[0] & 2) != 0 ? 4 : 0;
    scans = asterix_scans_open(&rules);
    if (data[0] & 4) {
        preview_all_records(scans, data + 1, size - 1);
    }
    placed = take_datagrams_and_count_plots(scans, data + 1, size - 1, &heard);
    asterix_scans_finish(scans);
    placed += check_scans_and_count_plots(scans, INT64_MIN);
    counts = asterix_scans_counts(scans);
    abort_unless(placed == counts->placed);
    abort_unless(counts->plots == counts->placed + counts->not_real + counts->no_detection +
                                      counts->incomplete + counts->bad_times + counts->late +
                                      counts->unplaced + counts->no_room);
    abort_unless(asterix_scans_settled_time_128(scans) == INT64_MAX);
    asterix_scans_close(scans);
    return 0;
}
