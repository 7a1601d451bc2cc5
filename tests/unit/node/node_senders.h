/* SPDX-License-Identifier: MIT */
/* A node, and what sensors send to it. */
#ifndef RHOTRACK_TESTS_NODE_SENDERS_H
#define RHOTRACK_TESTS_NODE_SENDERS_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "rhotrack/node.h"
#include "rhotrack/publish.h"

#define SECOND_US INT64_C(1000000)
#define EPOCH 7

static struct rho_node node;
static int64_t now_us;

/* What the node did, in order: S scan, F frame, R restart, A answers. */
static char done[4096];

/* Messages that the node published: number by channel, and the last one of the wanted channel. */
static const char *wanted = "";
static unsigned num_wanted;
static uint8_t last[RHO_MESSAGE_ZONE_EVENT_LIST_MAX_SIZE + RHO_MESSAGE_TRACK_LIST_MAX_SIZE];
static size_t last_size;

static inline struct rho_node_config default_config(void)
{
    struct rho_settings settings;
    struct rho_node_config config;

    rho_settings_default(&settings);
    rho_node_config_default(&config, &settings);
    config.epoch = EPOCH;
    return config;
}

static inline void start_node(const struct rho_node_config *config)
{
    struct rho_settings settings;

    rho_settings_default(&settings);
    assert_int_equal(rho_node_init(&node, sizeof node, &settings), RHO_OK);
    assert_int_equal(rho_node_configure(&node, config), RHO_OK);
    now_us = 1000 * SECOND_US;
    done[0] = '\0';
    wanted = "";
    num_wanted = 0;
}

static inline void start_default_node(void)
{
    const struct rho_node_config config = default_config();

    start_node(&config);
}

static inline void keep_wanted_messages(void)
{
    static uint8_t bytes[sizeof last];

    for (uint16_t part = 0; part < rho_node_num_messages(&node); part++) {
        size_t size = 0;

        assert_int_equal(rho_node_publish(&node, part, bytes, sizeof bytes, &size), RHO_OK);
        if (strcmp(rho_node_channel(&node, part), wanted) == 0) {
            num_wanted++;
            memcpy(last, bytes, size);
            last_size = size;
        }
    }
}

static inline void run_until(int64_t until_us)
{
    enum rho_node_due due;

    while ((due = rho_node_next(&node, until_us)) != RHO_NODE_NOTHING) {
        size_t length = strlen(done);

        assert_true(length + 1 < sizeof done);
        done[length] = "-SBRA"[due];
        done[length + 1] = '\0';
        keep_wanted_messages();
    }
}

static inline void take_message(const char *channel, const uint8_t *data, size_t size)
{
    while (rho_node_take(&node, channel, data, size, now_us) == RHO_ERROR_CAPACITY) {
        run_until(now_us);
    }
    run_until(now_us);
}

static inline void take_of_sensor(const char *prefix, int sensor_id, const uint8_t *data,
                                  size_t size)
{
    char channel[40];

    snprintf(channel, sizeof channel, "%s%d", prefix, sensor_id);
    take_message(channel, data, size);
}

/* Sends the first part of a polar scan, with one plot. */
static inline void send_polar(int16_t sensor_id, int32_t scan, int64_t time_us, int16_t num_parts,
                              float range_m)
{
    static struct rho_message_polar_scan message;
    uint8_t bytes[RHO_MESSAGE_POLAR_SCAN_MAX_SIZE];
    size_t size;

    message = (struct rho_message_polar_scan){.utime = time_us,
                                              .scan = scan,
                                              .sensor_id = sensor_id,
                                              .sensor_x_m = 1000.0f * sensor_id,
                                              .num_parts = num_parts,
                                              .num_polar_plots = 1};
    message.polar_plots[0].range_m = range_m;
    assert_int_equal(rho_message_polar_scan_encode(&message, bytes, sizeof bytes, &size), RHO_OK);
    take_of_sensor(RHO_MESSAGE_POLAR_SCAN_CHANNEL, sensor_id, bytes, size);
}

/* A whole scan; scan numbers are seconds, the target flies away from the radar. */
static inline void send_scan(int16_t sensor_id, int32_t scan, int64_t time_us)
{
    send_polar(sensor_id, scan, time_us, 1, 20000.0f + 100.0f * (float)scan);
}

static inline void send_bearing(int16_t sensor_id, float y_m, int32_t scan, int64_t time_us)
{
    static struct rho_message_bearing_scan message;
    uint8_t bytes[RHO_MESSAGE_BEARING_SCAN_MAX_SIZE];
    size_t size;

    message = (struct rho_message_bearing_scan){.utime = time_us,
                                                .scan = scan,
                                                .sensor_id = sensor_id,
                                                .sensor_y_m = y_m,
                                                .num_bearings = 1};
    message.bearing_rad[0] = atan2f(200.0f * (float)scan - y_m, 30000.0f);
    assert_int_equal(rho_message_bearing_scan_encode(&message, bytes, sizeof bytes, &size), RHO_OK);
    take_of_sensor(RHO_MESSAGE_BEARING_SCAN_CHANNEL, sensor_id, bytes, size);
}

/* The same bearing with an elevation, of a sensor 50 m up. */
static inline void send_direction(int16_t sensor_id, float y_m, int32_t scan, int64_t time_us)
{
    static struct rho_message_direction_scan message;
    uint8_t bytes[RHO_MESSAGE_DIRECTION_SCAN_MAX_SIZE];
    size_t size;

    message = (struct rho_message_direction_scan){.utime = time_us,
                                                  .scan = scan,
                                                  .sensor_id = sensor_id,
                                                  .sensor_y_m = y_m,
                                                  .sensor_z_m = 50.0f,
                                                  .num_directions = 1};
    message.directions[0] =
        (struct rho_message_direction){.bearing_rad = atan2f(200.0f * (float)scan - y_m, 30000.0f),
                                       .elevation_rad = 0.125f,
                                       .has_elevation = 1};
    assert_int_equal(rho_message_direction_scan_encode(&message, bytes, sizeof bytes, &size),
                     RHO_OK);
    take_of_sensor(RHO_MESSAGE_DIRECTION_SCAN_CHANNEL, sensor_id, bytes, size);
}

#endif
