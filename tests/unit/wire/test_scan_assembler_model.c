/* SPDX-License-Identifier: MIT */
/*
 * Random streams of sensors with faults of every kind, compared with a plain model of the rules
 * (scan_assembler_model.h).
 */
#include "scan_assembler_model.h"

#define SENSORS 10
#define PAST 40

struct sender {
    int64_t next_us, off_us; /* reception time; offset of its own clock */
    int64_t interval_us;
    int32_t scan, epoch;
    uint8_t kind;
    int parts;
};

static struct sender senders[SENSORS];
static struct look past[PAST];
static unsigned num_past;
static int64_t now_us;
static unsigned given, taken, pressed, restarted, skipped;

static void compare_counters(void)
{
    if (memcmp(&assembler.counters, &model.counters, sizeof assembler.counters) != 0) {
        expect_counters_are(model.counters);
    }
}

static void compare_inputs(const struct model_scan *scan)
{
    unsigned row = 0;

    for (int part = 0; part < scan->num_parts; part++) {
        for (unsigned i = 0; scan->is_here[part] && i < scan->parts[part].count; i++, row++) {
            int32_t tag = scan->parts[part].tag + (int32_t)i;

            if (item.kind == RHO_SCAN_ASSEMBLER_BEARINGS) {
                assert_true(item.bearings.bearings[row].bearing_rad == (float)tag * 1e-3f);
            } else if (item.kind == RHO_SCAN_ASSEMBLER_PLOTS) {
                assert_true(item.scan.plots[row].x_m == (float)tag);
            }
        }
    }
    assert_int_equal(row, item.kind == RHO_SCAN_ASSEMBLER_BEARINGS ? item.bearings.num_bearings
                                                                   : item.scan.num_plots);
}

static int next_of_both(int64_t at_us)
{
    int is_restart = 0, is_there = rho_scan_assembler_next(&assembler, at_us, &item);
    const struct model_scan *scan = model_next_scan(at_us, &is_restart);

    assert_int_equal(is_there, scan != NULL);
    assert_true(is_there || rho_scan_assembler_due_us(&assembler) > at_us || at_us == INT64_MAX);
    if (scan) {
        assert_int_equal(item.kind, scan->kind);
        assert_int_equal(item_sensor(), scan->id);
        assert_int_equal(item_time_us(), scan->place.time_us);
        assert_int_equal(item.is_restart, is_restart);
        assert_int_equal(item.parts_missing, (unsigned)scan->num_parts - model_count_parts(scan));
        compare_inputs(scan);
        given++;
        restarted += (unsigned)is_restart;
    }
    compare_counters();
    return is_there;
}

/* Offers a part to both; some scans are kept back until others have come. */
static struct look kept[4];
static unsigned num_kept;

static void offer_to_both(const struct look *look)
{
    for (;;) {
        uint32_t late = assembler.counters.scans_late, accepted = assembler.counters.scans_accepted;
        enum rho_status status = take_message_status(look, now_us);

        skipped +=
            assembler.counters.scans_late > late && assembler.counters.scans_accepted > accepted;

        assert_int_equal(status, model_take_part(look, now_us));
        compare_counters();
        if (status != RHO_ERROR_CAPACITY) {
            break;
        }
        pressed++;
        (void)next_of_both(now_us);
    }
    taken++;
    past[num_past++ % PAST] = *look;
}

/* Random streams */

static int64_t random_time_below(int64_t most)
{
    return (int64_t)random_below((uint32_t)most);
}

static struct look part_of_next_scan(const struct sender *sender, int part)
{
    return (struct look){.time_us = sender->next_us + sender->off_us,
                         .scan = sender->scan,
                         .epoch = sender->epoch,
                         .sensor_id = (int16_t)(sender - senders),
                         .kind = sender->kind,
                         .part = (int16_t)part,
                         .num_parts = (int16_t)sender->parts,
                         .count = (uint16_t)random_below(4),
                         .tag = (int32_t)random_below(3000)};
}

/* Changes one value of the message. */
static void damage_part(struct look *look)
{
    switch (random_below(6)) {
    case 0:
        look->scan = (int32_t)((uint32_t)look->scan ^ UINT32_C(1) << random_below(32));
        break;
    case 1:
        look->time_us += (random_below(2) ? 1 : -1) * (INT64_C(1) << random_below(40));
        break;
    case 2:
        look->epoch ^= 1 << random_below(4);
        break;
    case 3:
        look->num_parts = (int16_t)(look->kind == RHO_SCAN_ASSEMBLER_BEARINGS
                                        ? 1
                                        : look->part + 1 + random_time_below(3));
        break;
    case 4:
        look->sensor_id = (int16_t)(100 + random_time_below(20));
        break;
    default:
        look->scan = (int32_t)((uint32_t)look->scan + random_below(5) - 2u);
        break;
    }
}

static void offer_scan(struct sender *sender, unsigned faults)
{
    int first = (int)random_below((uint32_t)sender->parts);

    for (int i = 0; i < sender->parts; i++) {
        struct look look = part_of_next_scan(sender, (first + i) % sender->parts);

        if (random_below(1000) < faults) {
            struct look other = look;
            damage_part(&other);
            offer_to_both(&other);
        }
        if (random_below(400) < faults && num_kept < 4) {
            kept[num_kept++] = look;
        } else if (random_below(1000) >= faults) {
            offer_to_both(&look);
        }
        if (num_kept > 0 && random_below(8) == 0) {
            offer_to_both(&kept[--num_kept]);
        }
        if (random_below(4) == 0) {
            now_us += random_time_below(3000);
            (void)next_of_both(now_us);
        }
    }
}

static void change_sender(struct sender *sender)
{
    switch (random_below(6)) {
    case 0:
        sender->epoch++;
        sender->scan = (int32_t)random_time_below(50);
        break;
    case 1:
        sender->off_us =
            (random_time_below(5) - 2) * (random_below(2) ? 18 * SECOND_US : 3600 * SECOND_US);
        break;
    case 2:
        sender->off_us = 0;
        break;
    case 3:
        sender->interval_us = 20000 + random_time_below(2000000);
        break;
    case 4:
        sender->next_us +=
            random_time_below(60000000); /* the sensor is silent for up to a minute */
        break;
    default:
        sender->scan = INT32_MAX - (int32_t)random_time_below(10);
        break;
    }
}

static void compare_on_random_stream(uint32_t seed, unsigned steps, unsigned faults,
                                     const struct rho_scan_assembler_config *config)
{
    random_state = seed;
    start_assembler_with(config);
    model_start(config);
    now_us = random_below(2) ? 0 : INT64_C(-3000000000);
    for (unsigned i = 0; i < SENSORS; i++) {
        senders[i] = (struct sender){.next_us = now_us + random_time_below(1000000),
                                     .interval_us = 20000 + random_time_below(2000000),
                                     .scan = (int32_t)random_time_below(1000),
                                     .kind = (uint8_t)(i % 3),
                                     .parts = i % 3 == 2 ? 1 : 1 + (int)i % 4};
    }
    num_past = num_kept = 0;
    for (unsigned step = 0; step < steps; step++) {
        struct sender *sender = &senders[0];

        for (unsigned i = 1; i < SENSORS; i++) {
            sender = senders[i].next_us < sender->next_us ? &senders[i] : sender;
        }
        while (rho_scan_assembler_due_us(&assembler) < sender->next_us &&
               next_of_both(rho_scan_assembler_due_us(&assembler))) {
        }
        now_us = sender->next_us > now_us ? sender->next_us + random_time_below(10000) : now_us;
        offer_scan(sender, faults);
        sender->scan = sender->scan < INT32_MAX ? sender->scan + 1 : INT32_MIN;
        sender->next_us += sender->interval_us + random_time_below(sender->interval_us / 10);
        if (num_past > 0 && random_below(1000) < faults) {
            offer_to_both(&past[random_below(num_past < PAST ? num_past : PAST)]);
        }
        if (random_below(3000) < faults) {
            change_sender(sender);
        }
        if (random_below(20000) < faults) {
            now_us -= random_time_below(100000);
        }
        while (random_below(3) && next_of_both(now_us)) {
        }
    }
    while (next_of_both(INT64_MAX)) {
    }
}

static void the_assembler_behaves_like_the_model(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    given = taken = pressed = restarted = skipped = 0;
    for (uint32_t seed = 1; seed <= 60; seed++) {
        config.hold_us = seed % 5 == 0 ? 0 : (int64_t)(seed % 7) * 15000;
        config.follow_scans = (uint16_t)(2 + seed % 3);
        config.flood_per_s = seed % 4 == 0 ? 12 : 10000;
        config.late_max_us = (int64_t)(seed % 4) * 5000000;
        config.jump_max_us = seed % 2 ? 30000000 : 3000000;
        compare_on_random_stream(seed, 2000, seed % 3 == 0 ? 0 : seed * 5, &config);
    }
    assert_in_range(taken, 200000, 2000000);
    assert_in_range(given, 50000, 2000000);
    assert_in_range(restarted, 20, 100000);
    assert_in_range(skipped, RHO_MAX_OPEN_SCANS > 4 ? 200 : 100, 100000);
    print_message("%u scans taken late\n", skipped);
    assert_true(pressed > 20 || RHO_MAX_OPEN_SCANS > 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_assembler_behaves_like_the_model),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
