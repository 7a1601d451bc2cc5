/* SPDX-License-Identifier: MIT */
/* Scans of one sensor that come behind newer ones of it: in their place where they can be, else late, else not at all. */
#include "feed_setup.h"

/* One sensor's scans 1 .. count, one a second. */
static void begin_with(const struct rho_feed_config *config, int32_t count)
{
    start_with(config);
    for (int32_t i = 1; i <= count; i++) {
        take_scan(1, i, i * SECOND_US);
        next_is(i * SECOND_US, 1, i * SECOND_US);
    }
    next_is_none(count * SECOND_US);
}

static void begin(int32_t count)
{
    struct rho_feed_config config = usual();

    begin_with(&config, count);
}

/* Scan `scan` at its time, received at now_us. */
static void late(int32_t scan, int64_t now_us)
{
    struct look look = {
        .time_us = scan * SECOND_US, .scan = scan, .sensor_id = 1, .count = 1, .tag = scan};

    take(&look, now_us);
}

static void two_that_are_swapped_go_out_in_order(void **state)
{
    (void)state;
    begin(5);
    late(7, 7 * SECOND_US);
    next_is_none(7 * SECOND_US); /* 6 may come */
    assert_int_equal(rho_feed_due_us(&feed), 7 * SECOND_US + HOLD_US);
    late(6, 7 * SECOND_US + HOLD_US - 1);
    next_is(7 * SECOND_US + HOLD_US - 1, 1, 6 * SECOND_US);
    assert_true(item.scan.plots[0].x_m == 6.0f);
    next_is(7 * SECOND_US + HOLD_US - 1, 1, 7 * SECOND_US);
    take_scan(1, 8, 8 * SECOND_US);
    next_is(8 * SECOND_US, 1, 8 * SECOND_US); /* nothing waits any more */
    COUNTERS_ARE(.scans_accepted = 8, .scans_late = 1, .scans_lost = 1);
}

static void a_number_that_is_lost_is_waited_for_once(void **state)
{
    (void)state;
    begin(5);
    late(7, 7 * SECOND_US);
    next_is_none(7 * SECOND_US + HOLD_US - 1);
    next_is(7 * SECOND_US + HOLD_US, 1, 7 * SECOND_US);
    take_scan(1, 8, 8 * SECOND_US);
    next_is(8 * SECOND_US, 1, 8 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 7, .scans_lost = 1);
}

static void nothing_is_waited_for_where_nothing_is_held(void **state)
{
    struct rho_feed_config config = usual();

    (void)state;
    config.hold_us = 0;
    begin_with(&config, 5);
    late(7, 7 * SECOND_US);
    next_is(7 * SECOND_US, 1, 7 * SECOND_US);
    late(6, 7 * SECOND_US); /* late, but of use */
    next_is(7 * SECOND_US, 1, 6 * SECOND_US);
}

static void one_that_is_later_goes_out_late(void **state)
{
    (void)state;
    begin(5);
    late(7, 7 * SECOND_US);
    next_is(8 * SECOND_US, 1, 7 * SECOND_US);
    late(6, 8 * SECOND_US);
    next_is(8 * SECOND_US, 1, 6 * SECOND_US); /* at once: what it would wait for has gone out */
    take_scan(1, 8, 8 * SECOND_US);
    next_is(8 * SECOND_US, 1, 8 * SECOND_US);
    assert_int_equal(feed.sources[0].interval_us, SECOND_US);
    assert_int_equal(feed.sources[0].place.scan, 8);
    COUNTERS_ARE(.scans_accepted = 8, .scans_late = 1, .scans_lost = 1);
}

static void late_max_says_how_late(void **state)
{
    struct rho_feed_config config = usual();

    (void)state;
    for (int32_t behind = 1; behind <= 6; behind++) {
        config.late_max_us = 3 * SECOND_US;
        begin_with(&config, 5);
        late(6 + behind, (6 + behind) * SECOND_US); /* 6 and what follows is skipped */
        next_is(30 * SECOND_US, 1, (6 + behind) * SECOND_US);
        late(6, 30 * SECOND_US);
        assert_int_equal(drain(30 * SECOND_US), behind <= 3);
        COUNTERS_ARE(.scans_accepted = 6 + (behind <= 3), .scans_late = 1,
                     .scans_lost = (uint32_t)behind);
    }
    config.late_max_us = 0;
    begin_with(&config, 5);
    late(7, 7 * SECOND_US);
    late(6, 7 * SECOND_US); /* held, so that it is in time all the same */
    assert_int_equal(drain(7 * SECOND_US), 2);
    COUNTERS_ARE(.scans_accepted = 7, .scans_late = 1, .scans_lost = 1);
}

static void a_time_that_is_not_its_numbers_is_not_taken(void **state)
{
    static const struct {
        int64_t time_us;
        int is_taken;
    } cases[] = {
        /* one number behind 7: a second, less a quarter, more by a half, jitter of 10 ms */
        {7 * SECOND_US - 740000, 1},  {7 * SECOND_US - 739999, 0}, {7 * SECOND_US - 1510000, 1},
        {7 * SECOND_US - 1510001, 0}, {7 * SECOND_US, 0},          {-20 * SECOND_US, 0},
    };

    (void)state;
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct look look = {.time_us = cases[i].time_us, .scan = 6, .sensor_id = 1, .count = 1};

        begin(5);
        late(7, 7 * SECOND_US);
        take(&look, 7 * SECOND_US);
        assert_int_equal(feed.counters.scans_accepted, 6 + cases[i].is_taken);
        assert_int_equal(feed.counters.scans_late, 1);
        /* the real one may still come */
        late(6, 7 * SECOND_US);
        assert_int_equal(feed.counters.scans_accepted, 7);
        assert_int_equal(feed.counters.scans_duplicate, cases[i].is_taken);
    }
}

static void what_was_there_before_the_first_one_is_not_taken(void **state)
{
    (void)state;
    begin(0);
    late(5, 5 * SECOND_US);
    late(4, 5 * SECOND_US);
    late(6, 6 * SECOND_US);
    late(3, 6 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 2, .scans_late = 2);
}

static void several_are_put_in_order(void **state)
{
    static const int32_t order[] = {9, 7, 8, 6};
    const unsigned room = RHO_MAX_OPEN_SCANS < 4 ? RHO_MAX_OPEN_SCANS : 4;

    (void)state;
    begin(5);
    for (unsigned i = 0; i < room; i++) {
        late(order[i], 9 * SECOND_US);
    }
    if (room == 4) {
        for (int32_t scan = 6; scan <= 9; scan++) {
            next_is(9 * SECOND_US, 1, scan * SECOND_US);
        }
    } else { /* 9 and 7: 8 and 6 are waited for */
        next_is_none(9 * SECOND_US);
        next_is(9 * SECOND_US + HOLD_US, 1, 7 * SECOND_US);
        next_is(9 * SECOND_US + HOLD_US, 1, 9 * SECOND_US);
    }
    next_is_none(9 * SECOND_US);
}

static struct look part_of(int32_t scan, int16_t part)
{
    return (struct look){.time_us = scan * SECOND_US,
                         .scan = scan,
                         .sensor_id = 1,
                         .part = part,
                         .num_parts = 2,
                         .count = 1,
                         .tag = 10 * scan + part};
}

static void parts_of_both_may_come_mixed(void **state)
{
    static const struct {
        int32_t scan;
        int16_t part;
    } order[] = {{7, 1}, {6, 1}, {7, 0}, {6, 0}};

    (void)state;
    begin(5);
    for (unsigned i = 0; i < 4; i++) {
        struct look look = part_of(order[i].scan, order[i].part);

        take(&look, 7 * SECOND_US);
    }
    for (int32_t scan = 6; scan <= 7; scan++) {
        next_is(7 * SECOND_US, 1, scan * SECOND_US);
        assert_int_equal(item.scan.num_plots, 2);
        assert_int_equal(item.parts_missing, 0);
        assert_true(item.scan.plots[0].x_m == (float)(10 * scan));
        assert_true(item.scan.plots[1].x_m == (float)(10 * scan + 1));
    }
    COUNTERS_ARE(.scans_accepted = 7, .scans_late = 1, .scans_lost = 1);
}

static void a_late_one_without_its_last_part_goes_out_after_a_while(void **state)
{
    struct rho_feed_config config = usual();
    struct look look = part_of(6, 0);

    (void)state;
    begin(5);
    late(7, 7 * SECOND_US);
    take(&look, 7 * SECOND_US + 10000);
    next_is_none(7 * SECOND_US + HOLD_US - 1);
    next_is(7 * SECOND_US + HOLD_US, 1, 6 * SECOND_US); /* 7 has waited */
    assert_int_equal(item.parts_missing, 1);
    next_is(7 * SECOND_US + HOLD_US, 1, 7 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 7, .scans_late = 1, .scans_lost = 1, .scans_incomplete = 1);
    /* where parts wait for a newer scan alone, that one ends it */
    config.hold_us = 0;
    begin_with(&config, 5);
    late(7, 7 * SECOND_US);
    next_is(7 * SECOND_US, 1, 7 * SECOND_US);
    take(&look, 7 * SECOND_US);
    next_is_none(20 * SECOND_US);
    take_scan(1, 8, 8 * SECOND_US);
    next_is(8 * SECOND_US, 1, 6 * SECOND_US);
    next_is(8 * SECOND_US, 1, 8 * SECOND_US);
    next_is_none(8 * SECOND_US);
}

/* Frames of bearings are over once a later one has begun. */
static void bearings_are_not_late(void **state)
{
    struct look look = {.sensor_id = 1, .kind = RHO_FEED_BEARINGS, .count = 1};
    static const int32_t order[] = {1, 2, 4, 3};

    (void)state;
    for (int is_held = 0; is_held < 2; is_held++) {
        start();
        for (unsigned i = 0; i < 4; i++) {
            look.scan = order[i];
            look.time_us = order[i] * SECOND_US;
            take(&look, 5 * SECOND_US);
            (void)drain(i == 2 && is_held ? 5 * SECOND_US : 6 * SECOND_US);
        }
        COUNTERS_ARE(.scans_accepted = 3 + (uint32_t)is_held, .scans_late = 1, .scans_lost = 1,
                     .bearings_in = 3 + (uint32_t)is_held);
    }
}

/* Others' scans whose parts are still coming are not cut short for it, nor do they lose their room. */
static void a_late_one_takes_nobodys_room(void **state)
{
    (void)state;
    begin(5);
    late(7, 7 * SECOND_US);
    next_is(8 * SECOND_US, 1, 7 * SECOND_US);
    next_is_none(8 * SECOND_US);
    for (int16_t i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct look look = {.time_us = 7 * SECOND_US + 1,
                            .scan = 1,
                            .sensor_id = (int16_t)(10 + i),
                            .kind = RHO_FEED_POLAR,
                            .num_parts = 2};
        if (i < RHO_MAX_SENSORS - 1) {
            take(&look, 8 * SECOND_US);
        }
    }
    late(6, 8 * SECOND_US);
    if (RHO_MAX_OPEN_SCANS < RHO_MAX_SENSORS) {
        assert_int_equal(feed.counters.sensors_no_room, 1);
        assert_int_equal(feed.counters.scans_incomplete, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_that_are_swapped_go_out_in_order),
        cmocka_unit_test(a_number_that_is_lost_is_waited_for_once),
        cmocka_unit_test(nothing_is_waited_for_where_nothing_is_held),
        cmocka_unit_test(one_that_is_later_goes_out_late),
        cmocka_unit_test(late_max_says_how_late),
        cmocka_unit_test(a_time_that_is_not_its_numbers_is_not_taken),
        cmocka_unit_test(what_was_there_before_the_first_one_is_not_taken),
        cmocka_unit_test(several_are_put_in_order),
        cmocka_unit_test(parts_of_both_may_come_mixed),
        cmocka_unit_test(a_late_one_without_its_last_part_goes_out_after_a_while),
        cmocka_unit_test(bearings_are_not_late),
        cmocka_unit_test(a_late_one_takes_nobodys_room),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
