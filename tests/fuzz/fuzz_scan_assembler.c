/* SPDX-License-Identifier: MIT */
/*
 * The scan assembler, driven by a script: good messages, damaged ones, any bytes, steps of the
 * reception clock, and calls for due scans. After each step its guarantees are checked: counts of
 * fates add up, scans are within their capacities and in order of time, and two calls of next
 * always make room.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "rhotrack/message.h"
#include "rhotrack/scan_assembler.h"
#include "rhotrack/types.h"

#define SENSORS 5
#define SLOT_FREE 0 /* values of a slot's private state */
#define SLOT_GIVEN 3

static struct rho_scan_assembler assembler;
static struct rho_scan_assembler_item item;
static uint64_t given;

/* ---- the script ------------------------------------------------------------------------------ */

struct script {
    const uint8_t *data;
    size_t size;
};

/* The next bytes of the script as a number; 0s behind its end. */
static uint64_t read_number(struct script *script, unsigned bytes)
{
    uint64_t value = 0;

    for (unsigned i = 0; i < bytes; i++) {
        value = value << 8 | (script->size > 0 ? *script->data : 0);
        script->data += script->size > 0;
        script->size -= script->size > 0;
    }
    return value;
}

static int64_t read_signed_number(struct script *script, unsigned bytes)
{
    uint64_t value = read_number(script, bytes), half = UINT64_C(1) << (8 * bytes - 1);

    return value < half ? (int64_t)value : -(int64_t)(2 * (half - 1) + 1 - value) - 1;
}

/* ---- checks ---------------------------------------------------------------------------------- */

static unsigned count_waiting_scans(void)
{
    unsigned count = 0;

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        count += assembler.slots[i].state != SLOT_FREE && assembler.slots[i].state != SLOT_GIVEN;
    }
    return count;
}

static uint64_t count_parts_in_slots(void)
{
    uint64_t count = 0;

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        count += assembler.slots[i].state != SLOT_FREE ? assembler.slots[i].parts_here : 0u;
        CHECK(assembler.slots[i].parts_here <= assembler.slots[i].num_parts);
    }
    return count;
}

static uint64_t count_refused_messages(void)
{
    const struct rho_scan_assembler_counters *counters = &assembler.counters;

    return (uint64_t)counters->messages_bad + counters->messages_wrong_type +
           counters->messages_flooded + counters->scans_late + counters->scans_duplicate +
           counters->scans_bad + counters->clock_jumps + counters->sensors_no_room +
           counters->messages_not_allowed + counters->scans_other;
}

/*
 * Each accepted scan waits, was given, or was dropped: for a new clock or, if it was a newcomer's,
 * for lack of room.
 */
static void check_fates_of_scans(void)
{
    uint64_t there = given + count_waiting_scans();

    CHECK(assembler.counters.scans_accepted >= there);
    CHECK(assembler.counters.scans_accepted - there <=
          (uint64_t)assembler.counters.scans_late + assembler.counters.sensors_no_room);
    CHECK(assembler.counters.scans_incomplete <= assembler.counters.scans_accepted);
}

static void check_given_item(void)
{
    int is_bearings = item.kind == RHO_SCAN_ASSEMBLER_BEARINGS;
    int64_t time_us = is_bearings ? item.bearings.time_us : item.scan.time_us;

    CHECK(item.kind < RHO_NUM_SCAN_ASSEMBLER_KINDS);
    CHECK(time_us >= -RHO_LIMIT_TIME_US && time_us <= RHO_LIMIT_TIME_US);
    CHECK(item.is_restart == 0 || item.is_restart == 1);
    if (is_bearings) {
        CHECK(item.bearings.num_bearings <= RHO_MAX_BEARINGS);
        for (unsigned i = 0; i < item.bearings.num_bearings; i++) {
            CHECK(rho_is_within(item.bearings.bearings[i].bearing_rad, -3.15f, 3.15f));
            CHECK(rho_is_within(item.bearings.bearings[i].elevation_rad, -1.58f, 1.58f));
        }
    } else {
        CHECK(item.scan.num_plots <= RHO_MAX_PLOTS);
        for (unsigned i = 0; i < item.scan.num_plots; i++) {
            CHECK(item.scan.plots[i].x_m >= -4.5e6f); /* false for NaN, too */
        }
    }
}

static int take_next_item(int64_t now_us)
{
    int is_there = rho_scan_assembler_next(&assembler, now_us, &item);

    if (is_there) {
        given++;
        check_given_item();
    }
    return is_there;
}

static void take_all_due_items(int64_t now_us)
{
    int64_t last_us = INT64_MIN;

    while (take_next_item(now_us)) {
        int64_t time_us =
            item.kind == RHO_SCAN_ASSEMBLER_BEARINGS ? item.bearings.time_us : item.scan.time_us;

        CHECK(time_us >= last_us);
        last_us = time_us;
    }
}

static void offer_message(const char *channel, const uint8_t *data, size_t size, int64_t now_us)
{
    struct rho_scan_assembler_counters before = assembler.counters;
    uint64_t refused = count_refused_messages(), parts = count_parts_in_slots();
    uint8_t *exact = malloc(size > 0 ? size : 1);
    enum rho_status status;
    unsigned tries = 0;

    CHECK(exact);
    memcpy(exact, data, size);
    status = rho_scan_assembler_take(&assembler, channel, exact, size, now_us);
    while (status == RHO_ERROR_CAPACITY) {
        CHECK(memcmp(&before, &assembler.counters, sizeof before) == 0);
        CHECK(++tries <= 2);
        (void)take_next_item(now_us);
        before = assembler.counters;
        refused = count_refused_messages();
        parts = count_parts_in_slots();
        status = rho_scan_assembler_take(&assembler, channel, exact, size, now_us);
    }
    if (status == RHO_OK) {
        CHECK(count_refused_messages() > refused || count_parts_in_slots() > parts);
    } else {
        CHECK(status == RHO_ERROR_TYPE && memcmp(&before, &assembler.counters, sizeof before) == 0);
    }
    free(exact);
}

/* ---- messages that the script sends ---------------------------------------------------------- */

struct sender {
    int64_t time_us;
    int32_t scan, epoch;
};

static size_t write_message(struct script *script, unsigned kind, int16_t sensor_id,
                            const struct sender *sender, uint8_t *buffer, size_t capacity)
{
    static struct rho_message_plot_scan plots;
    static struct rho_message_polar_scan polar;
    static struct rho_message_bearing_scan bearings;
    static struct rho_message_direction_scan directions;
    int16_t parts = (int16_t)(1 + read_number(script, 1) % 4),
            part = (int16_t)(read_number(script, 1) % 5);
    int16_t count = (int16_t)(read_number(script, 1) % 35);
    size_t size = 0;

    if (kind == RHO_SCAN_ASSEMBLER_PLOTS) {
        plots = (struct rho_message_plot_scan){.utime = sender->time_us,
                                               .scan = sender->scan,
                                               .epoch = sender->epoch,
                                               .sensor_id = sensor_id,
                                               .kind = (int8_t)(2 + read_number(script, 1) % 5),
                                               .part = part,
                                               .num_parts = parts,
                                               .num_plots = count};
        (void)!rho_message_plot_scan_encode(&plots, buffer, capacity, &size);
    } else if (kind == RHO_SCAN_ASSEMBLER_POLAR) {
        polar = (struct rho_message_polar_scan){.utime = sender->time_us,
                                                .scan = sender->scan,
                                                .epoch = sender->epoch,
                                                .sensor_id = sensor_id,
                                                .part = part,
                                                .num_parts = parts,
                                                .sensor_x_m = (float)(read_number(script, 1) % 2),
                                                .num_polar_plots = count};
        for (int16_t i = 0; i < count; i++) {
            polar.polar_plots[i].range_m = (float)read_number(script, 1) * 100.0f;
        }
        (void)!rho_message_polar_scan_encode(&polar, buffer, capacity, &size);
    } else if (kind == RHO_SCAN_ASSEMBLER_BEARINGS) {
        bearings = (struct rho_message_bearing_scan){.utime = sender->time_us,
                                                     .scan = sender->scan,
                                                     .epoch = sender->epoch,
                                                     .sensor_id = sensor_id,
                                                     .num_bearings = count};
        (void)!rho_message_bearing_scan_encode(&bearings, buffer, capacity, &size);
    } else {
        directions = (struct rho_message_direction_scan){
            .utime = sender->time_us,
            .scan = sender->scan,
            .epoch = sender->epoch,
            .sensor_id = sensor_id,
            .sensor_z_m = (float)(read_number(script, 1) % 2),
            .sigma_elevation_rad = (float)(read_number(script, 1) % 2) * 0.01f,
            .num_directions = count};
        for (int16_t i = 0; i < count; i++) {
            directions.directions[i] = (struct rho_message_direction){
                .dt_us = (int32_t)read_signed_number(script, 2), .has_elevation = i % 2};
        }
        (void)!rho_message_direction_scan_encode(&directions, buffer, capacity, &size);
    }
    return size;
}

static void send_scripted_message(struct script *script, struct sender senders[SENSORS],
                                  int64_t now_us)
{
    static const char *const prefixes[] = {"RHO_PLOTS_", "RHO_POLAR_", "RHO_BEARINGS_",
                                           "RHO_DIRECTIONS_"};
    uint8_t what = (uint8_t)read_number(script, 1), buffer[1500];
    unsigned kind = what % 4, sensor = what / 4 % SENSORS;
    struct sender message;
    char channel[32];
    size_t size;

    if (what & 0x80) { /* bit 7: the sensor goes on regularly */
        senders[sensor].scan = senders[sensor].scan < INT32_MAX ? senders[sensor].scan + 1 : 0;
        senders[sensor].time_us = now_us;
    }
    message = senders[sensor];
    if (what & 0x40) { /* bit 6: a false time, number or epoch */
        message.scan = (int32_t)((int64_t)message.scan % 1000000 + read_signed_number(script, 1));
        message.time_us = message.time_us / 2 + read_signed_number(script, 4);
        message.epoch = (int32_t)(read_number(script, 1) % 3);
    }
    size = write_message(script, kind, (int16_t)sensor, &message, buffer, sizeof buffer);
    for (uint64_t flips = read_number(script, 1) % 16; flips > 8 && size > 0; flips--) {
        buffer[read_number(script, 2) % size] ^= (uint8_t)read_number(script, 1);
    }
    snprintf(channel, sizeof channel, "%s%u", prefixes[kind], sensor);
    offer_message(channel, buffer, size, now_us);
}

static void send_any_bytes(struct script *script, int64_t now_us)
{
    char channel[24] = "RHO_PLOTS_1";
    size_t size = read_number(script, 1) % 100;

    if (read_number(script, 1) % 4 == 0) {
        snprintf(channel, sizeof channel, "RHO_POLAR_%d", (int)read_signed_number(script, 2));
    }
    size = size < script->size ? size : script->size;
    offer_message(channel, script->data, size, now_us);
    script->data += size;
    script->size -= size;
}

static int64_t move_clock(struct script *script, int64_t now_us)
{
    int64_t step_us = read_signed_number(script, 3) * (read_number(script, 1) % 8 == 0 ? 1000 : 1);

    return now_us / 2 * 2 + (now_us < INT64_MAX / 2 && now_us > INT64_MIN / 2 ? step_us : 0);
}

static int start_assembler(struct script *script)
{
    struct rho_scan_assembler_config config;

    rho_scan_assembler_config_default(&config);
    config.hold_us = (int64_t)(read_number(script, 1) * 1000);
    config.follow_scans = (uint16_t)(2 + read_number(script, 1) % 6);
    config.flood_per_s = (uint32_t)(1 + read_number(script, 1) * 10);
    config.jump_max_us = (int64_t)(1000000 + read_number(script, 1) * 200000);
    config.late_max_us =
        /* takes no byte of its own, so that older inputs keep their meaning */
        (int64_t)(config.follow_scans % 3) * 20000000;
    given = 0;
    return rho_scan_assembler_init(&assembler, sizeof assembler, &config) == RHO_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct script script = {data, size};
    struct sender senders[SENSORS] = {{0}};
    int64_t now_us = 0;

    CHECK(start_assembler(&script));
    while (script.size > 0) {
        uint8_t action = (uint8_t)read_number(&script, 1);

        if (action < 140) {
            send_scripted_message(&script, senders, now_us);
        } else if (action < 160) {
            send_any_bytes(&script, now_us);
        } else if (action < 220) {
            now_us = move_clock(&script, now_us);
        } else if (action < 222) {
            now_us = read_signed_number(&script, 8);
        } else if (action < 240) {
            (void)take_next_item(now_us);
        } else {
            take_all_due_items(now_us);
        }
        (void)rho_scan_assembler_due_us(&assembler);
        check_fates_of_scans();
    }
    take_all_due_items(INT64_MAX);
    CHECK(count_waiting_scans() == 0);
    check_fates_of_scans();
    return 0;
}
