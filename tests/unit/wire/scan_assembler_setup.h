/* SPDX-License-Identifier: MIT */
/* A scan assembler, messages for it that are easily distinguished, and the scans that it gives. */
#ifndef SCAN_ASSEMBLER_SETUP_H
#define SCAN_ASSEMBLER_SETUP_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/message.h"
#include "rhotrack/scan_assembler.h"

#define SECOND_US INT64_C(1000000)
#define HOLD_US INT64_C(20000)
#define JUMP_US INT64_C(30000000)
#define DATAGRAM 1472

static struct rho_scan_assembler assembler;
static struct rho_scan_assembler_item item;

static uint64_t random_state = 1;

static inline uint32_t random_below(uint32_t count)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)((random_state >> 33) % count);
}

/*
 * ---- assemblers -------------------------------------------------------------------------------
 */

static inline struct rho_scan_assembler_config usual_config(void)
{
    struct rho_scan_assembler_config config;

    rho_scan_assembler_config_default(&config);
    return config;
}

static inline void start_assembler_with(const struct rho_scan_assembler_config *config)
{
    assert_int_equal(rho_scan_assembler_init(&assembler, sizeof assembler, config), RHO_OK);
}

static inline void start_assembler(void)
{
    struct rho_scan_assembler_config config = usual_config();

    start_assembler_with(&config);
}

/*
 * ---- messages ---------------------------------------------------------------------------------
 */

/*
 * Contents of one message. Its inputs count up from `tag`: x_m of plots in metres, ranges of polar
 * plots, bearings in mrad.
 */
struct look {
    int64_t time_us;
    int32_t scan, epoch;
    int16_t sensor_id;
    uint8_t kind;            /* enum rho_scan_assembler_kind */
    int16_t part, num_parts; /* num_parts 0 means 1 */
    uint16_t count;
    int32_t tag;
};

static inline int16_t parts_of(const struct look *look)
{
    return (int16_t)(look->num_parts > 0 ? look->num_parts : 1);
}

static inline size_t end_message(struct rho_message_writer *writer)
{
    size_t size = 0;

    assert_int_equal(rho_message_end(writer, &size), RHO_OK);
    return size;
}

static inline size_t pack_plots(const struct look *look, uint8_t *buffer)
{
    struct rho_message_plot_scan_head head = {.utime = look->time_us,
                                              .scan = look->scan,
                                              .epoch = look->epoch,
                                              .sensor_id = look->sensor_id,
                                              .kind = RHO_MESSAGE_PLOT_SCAN_POSITION_2D,
                                              .part = look->part,
                                              .num_parts = parts_of(look)};
    struct rho_message_writer writer;

    assert_int_equal(rho_message_plot_scan_begin(&writer, buffer, DATAGRAM, &head), RHO_OK);
    for (unsigned i = 0; i < look->count; i++) {
        struct rho_message_plot plot = {.x_m = (float)(look->tag + (int32_t)i), .y_m = 1.0f};
        assert_int_equal(rho_message_plot_scan_add(&writer, &plot), RHO_OK);
    }
    return end_message(&writer);
}

static inline size_t pack_polar(const struct look *look, uint8_t *buffer)
{
    struct rho_message_polar_scan_head head = {.utime = look->time_us,
                                               .scan = look->scan,
                                               .epoch = look->epoch,
                                               .sensor_id = look->sensor_id,
                                               .part = look->part,
                                               .num_parts = parts_of(look)};
    struct rho_message_writer writer;

    assert_int_equal(rho_message_polar_scan_begin(&writer, buffer, DATAGRAM, &head), RHO_OK);
    for (unsigned i = 0; i < look->count; i++) {
        struct rho_message_polar_plot plot = {.range_m = (float)(look->tag + (int32_t)i)};
        assert_int_equal(rho_message_polar_scan_add(&writer, &plot), RHO_OK);
    }
    return end_message(&writer);
}

static inline size_t pack_bearings(const struct look *look, uint8_t *buffer)
{
    struct rho_message_bearing_scan_head head = {.utime = look->time_us,
                                                 .scan = look->scan,
                                                 .epoch = look->epoch,
                                                 .sensor_id = look->sensor_id,
                                                 .sensor_x_m = 5.0f,
                                                 .sensor_y_m = -6.0f};
    struct rho_message_writer writer;

    assert_int_equal(rho_message_bearing_scan_begin(&writer, buffer, DATAGRAM, &head), RHO_OK);
    for (unsigned i = 0; i < look->count; i++) {
        float bearing_rad = (float)(look->tag + (int32_t)i) * 1e-3f;
        assert_int_equal(rho_message_bearing_scan_add(&writer, &bearing_rad), RHO_OK);
    }
    return end_message(&writer);
}

static inline size_t pack_message(const struct look *look, uint8_t *buffer)
{
    return look->kind == RHO_SCAN_ASSEMBLER_PLOTS   ? pack_plots(look, buffer)
           : look->kind == RHO_SCAN_ASSEMBLER_POLAR ? pack_polar(look, buffer)
                                                    : pack_bearings(look, buffer);
}

static inline const char *channel_of(uint8_t kind, int16_t sensor_id)
{
    static const char *const prefixes[] = {"RHO_PLOTS_", "RHO_POLAR_", "RHO_BEARINGS_"};
    static char channel[64];

    snprintf(channel, sizeof channel, "%s%d", prefixes[kind], sensor_id);
    return channel;
}

/* Takes bytes from a buffer of exactly their size, so that sanitizers detect reads beyond it. */
static inline enum rho_status take_bytes(const char *channel, const uint8_t *data, size_t size,
                                         int64_t now_us)
{
    uint8_t *exact = malloc(size > 0 ? size : 1);
    enum rho_status status;

    assert_non_null(exact);
    memcpy(exact, data, size);
    status = rho_scan_assembler_take(&assembler, channel, exact, size, now_us);
    free(exact);
    return status;
}

static inline enum rho_status take_message_status(const struct look *look, int64_t now_us)
{
    uint8_t buffer[DATAGRAM];
    size_t size = pack_message(look, buffer);

    return take_bytes(channel_of(look->kind, look->sensor_id), buffer, size, now_us);
}

static inline void take_message(const struct look *look, int64_t now_us)
{
    assert_int_equal(take_message_status(look, now_us), RHO_OK);
}

/* Takes a whole scan of plots in one part, received at its own time. */
static inline void take_scan(int16_t sensor_id, int32_t scan, int64_t time_us)
{
    struct look look = {
        .time_us = time_us, .scan = scan, .sensor_id = sensor_id, .count = 1, .tag = scan};

    take_message(&look, time_us);
}

/* Scans that are given */

static inline int64_t item_time_us(void)
{
    return item.kind == RHO_SCAN_ASSEMBLER_BEARINGS ? item.bearings.time_us : item.scan.time_us;
}

static inline int32_t item_sensor(void)
{
    return item.kind == RHO_SCAN_ASSEMBLER_BEARINGS ? item.bearings.sensor_id : item.scan.sensor_id;
}

/* The next given scan is that sensor's, of that time. */
static inline void expect_next_scan(int64_t now_us, int32_t sensor_id, int64_t time_us)
{
    assert_int_equal(rho_scan_assembler_next(&assembler, now_us, &item), 1);
    assert_int_equal(item_sensor(), sensor_id);
    assert_int_equal(item_time_us(), time_us);
}

static inline void expect_no_scan(int64_t now_us)
{
    assert_int_equal(rho_scan_assembler_next(&assembler, now_us, &item), 0);
}

static inline unsigned take_all_items(int64_t now_us)
{
    unsigned count = 0;

    while (rho_scan_assembler_next(&assembler, now_us, &item)) {
        count++;
    }
    return count;
}

/* Counters must have exactly these values; fields that are not named are 0. */
static inline void expect_counters_are(struct rho_scan_assembler_counters want)
{
    const uint32_t *is = (const uint32_t *)&assembler.counters, *must = (const uint32_t *)&want;

    for (unsigned i = 0; i < sizeof want / sizeof *is; i++) {
        if (is[i] != must[i]) {
            fail_msg("counter %u is %u, not %u", i, is[i], must[i]);
        }
    }
}

#define COUNTERS_ARE(...) expect_counters_are((struct rho_scan_assembler_counters){__VA_ARGS__})

#endif
