/* SPDX-License-Identifier: MIT */
/*
 * Copies of a sensor's own messages with random bits flipped, sent before and after the originals.
 * A valid damaged copy received first takes the original's place, as nothing distinguishes them.
 * Counted are the missing scans, and those given as they were sent.
 */
#include "scan_assembler_setup.h"

#define SCANS_S 300

struct radar {
    int64_t interval_us;
    uint8_t kind;
    int16_t parts;
    uint16_t count;
};

static const struct radar radar = {SECOND_US, RHO_SCAN_ASSEMBLER_PLOTS, 1, 8};
static const struct radar direction_finder = {100000, RHO_SCAN_ASSEMBLER_BEARINGS, 1, 4};
static const struct radar surveillance = {2500000, RHO_SCAN_ASSEMBLER_PLOTS, 3, 34};

static const struct radar *sender;
static unsigned sent, intact, there;

static struct look part_of_scan(int64_t scan, int part)
{
    return (struct look){.time_us = (100 + scan) * sender->interval_us,
                         .scan = (int32_t)(1000 + scan),
                         .epoch = 77,
                         .sensor_id = 1,
                         .kind = sender->kind,
                         .part = (int16_t)part,
                         .num_parts = sender->parts,
                         .count = sender->count,
                         .tag = (int32_t)(scan % 10) * 110 + part * sender->count};
}

static void compare_item_with_sent(void)
{
    int64_t scan = item_time_us() / sender->interval_us - 100;
    unsigned total = (unsigned)sender->parts * sender->count, same = 0;
    unsigned count =
        item.kind == RHO_SCAN_ASSEMBLER_BEARINGS ? item.bearings.num_bearings : item.scan.num_plots;

    if (item_time_us() % sender->interval_us != 0) {
        return;
    }
    for (unsigned i = 0; i < count && i < total; i++) {
        float tag = (float)(scan % 10 * 110 + i);
        same += item.kind == RHO_SCAN_ASSEMBLER_BEARINGS
                    ? item.bearings.bearings[i].bearing_rad == tag * 1e-3f
                    : item.scan.plots[i].x_m == tag;
    }
    there++;
    intact += same == total && count == total;
}

static void take_all_items_and_compare(int64_t now_us)
{
    while (rho_scan_assembler_next(&assembler, now_us, &item)) {
        compare_item_with_sent();
    }
}

static void send_bytes(const uint8_t *bytes, size_t size, int64_t now_us)
{
    while (take_bytes(channel_of(sender->kind, 1), bytes, size, now_us) == RHO_ERROR_CAPACITY) {
        if (rho_scan_assembler_next(&assembler, now_us, &item)) {
            compare_item_with_sent();
        }
    }
    take_all_items_and_compare(now_us);
}

static void send_damaged(const uint8_t *bytes, size_t size, unsigned copies, int64_t now_us)
{
    uint8_t damaged[DATAGRAM];

    for (unsigned i = 0; i < copies; i++) {
        unsigned flips = 1 + random_below(8);

        memcpy(damaged, bytes, size);
        for (; flips > 0; flips--) {
            uint32_t bit = random_below((uint32_t)size * 8);
            damaged[bit / 8] = (uint8_t)(damaged[bit / 8] ^ 1u << bit % 8);
        }
        send_bytes(damaged, size, now_us);
    }
}

static void run_with_damaged_copies(const struct radar *of, unsigned before, unsigned behind)
{
    int64_t scans = SCANS_S * SECOND_US / of->interval_us;
    uint8_t bytes[DATAGRAM];

    sender = of;
    start_assembler();
    random_state = 7;
    sent = intact = there = 0;
    for (int64_t scan = 0; scan < scans; scan++, sent++) {
        for (int part = 0; part < of->parts; part++) {
            struct look look = part_of_scan(scan, part);
            size_t size = pack_message(&look, bytes);

            send_damaged(bytes, size, scan > 5 ? before : 0, look.time_us + 5000);
            send_bytes(bytes, size, look.time_us + 5000);
            send_damaged(bytes, size, scan > 5 ? behind : 0, look.time_us + 5000);
        }
    }
    take_all_items_and_compare(INT64_MAX);
}

static void expect_missing_at_most(unsigned percent_most)
{
    if (there * 100 < sent * (100 - percent_most)) {
        fail_msg("%u of %u scans came through, %u intact", there, sent, intact);
    }
}

static void expect_intact_at_least(unsigned percent_least)
{
    if (intact * 100 < sent * percent_least) {
        fail_msg("%u of %u scans are intact", intact, sent);
    }
}

static void damaged_copies_after_the_originals_harm_few_scans(void **state)
{
    const struct radar *const radars[] = {&radar, &direction_finder};

    (void)state;
    for (unsigned i = 0; i < 2; i++) {
        run_with_damaged_copies(radars[i], 0, 1);
        expect_intact_at_least(99);
        run_with_damaged_copies(radars[i], 0, 10);
        expect_intact_at_least(99);
        run_with_damaged_copies(radars[i], 0, 200);
        expect_intact_at_least(94);
    }
    run_with_damaged_copies(&surveillance, 0, 1);
    expect_intact_at_least(99);
    run_with_damaged_copies(&surveillance, 0,
                            10); /* a copy of one part may claim to be the next part */
    expect_intact_at_least(95);
    run_with_damaged_copies(&surveillance, 0, 200);
    expect_missing_at_most(2);
}

/* Scans given with another time count as missing, too. */
static void damaged_copies_before_the_originals_hide_few_scans(void **state)
{
    (void)state;
    run_with_damaged_copies(&radar, 1, 0);
    expect_missing_at_most(3);
    run_with_damaged_copies(&radar, 100, 100);
    expect_missing_at_most(6);
    run_with_damaged_copies(&surveillance, 100, 100);
    expect_missing_at_most(3);
    run_with_damaged_copies(&direction_finder, 1, 1);
    expect_missing_at_most(5);
    run_with_damaged_copies(&direction_finder, 100, 100); /* 2000 copies a second */
    expect_missing_at_most(25);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damaged_copies_after_the_originals_harm_few_scans),
        cmocka_unit_test(damaged_copies_before_the_originals_hide_few_scans),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
