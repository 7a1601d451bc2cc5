/* SPDX-License-Identifier: MIT */
/*
 * Values that the tracker has learned of its sensors, as messages: receivers read the values in
 * use.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/publish.h"

static struct rho_tracker tracker;

static void describe_sensor(int32_t sensor_id, float pd, float range_max_m)
{
    const struct rho_sensor sensor = {.sensor_id = sensor_id, .pd = pd, .range_max_m = range_max_m};

    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
}

static void start_tracker_with_two_sensors(void)
{
    struct rho_tracker_config config;

    rho_tracker_config_default(&config);
    config.gate = RHO_TRACKER_BEST;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    tracker.time_us = 1234567;
    describe_sensor(3, 0.75f, 60000.0f);
    describe_sensor(40000, 0.5f, 1000.0f);
}

/* Publishes the message and decodes it as receivers do. */
static struct rho_message_learned publish_and_read_sensor(unsigned place)
{
    struct rho_message_learned filled, read;
    uint8_t buffer[RHO_MESSAGE_LEARNED_MAX_SIZE];
    size_t size = 0;

    memset(&filled, 0x5a, sizeof filled);
    assert_int_equal(rho_publish_learned(&tracker, place, &filled), 1);
    assert_int_equal(filled.scan, 0);
    assert_int_equal(filled.epoch, 0);
    assert_int_equal(rho_message_learned_encode(&filled, buffer, sizeof buffer, &size), RHO_OK);
    assert_int_equal(rho_message_learned_decode(buffer, size, &read), RHO_OK);
    assert_int_equal(rho_message_learned_validate(&read, NULL), RHO_OK);
    return read;
}

static void before_learning_values_are_as_stated(void **state)
{
    (void)state;
    start_tracker_with_two_sensors();
    const struct rho_message_learned learned = publish_and_read_sensor(0);
    assert_int_equal(learned.utime, 1234567);
    assert_int_equal(learned.sensor_id, 3);
    assert_int_equal(learned.innovations, 0);
    assert_int_equal(learned.looks, 0);
    assert_float_equal(learned.sigma_range_factor, 1.0f, 0.0f);
    assert_float_equal(learned.sigma_cross_factor, 1.0f, 0.0f);
    assert_float_equal(learned.range_max_m, 60000.0f, 0.0f);
    assert_float_equal(learned.pd_stated, 0.75f, 0.0f);
    for (int ring = 0; ring < RHO_LEARN_RINGS; ring++) {
        assert_float_equal(learned.pd[ring], 0.75f, 0.0f);
    }
    assert_int_equal(publish_and_read_sensor(1).sensor_id,
                     -1); /* the sensor's id is beyond int16_t */
}

/* Twice the noise in range, P_D as stated in most rings, and half of it in the last one. */
static void learned_values_sent_are_those_in_use(void **state)
{
    (void)state;
    start_tracker_with_two_sensors();
    tracker.sensors[0].learned.log_noise[0] = 1.3862944f;
    tracker.sensors[0].learned.innovations = 900;
    tracker.sensors[0].looks = 1300.0f;
    tracker.sensors[0].hits = 975.0f;
    tracker.sensors[0].places[5].excess = -0.5f;
    const struct rho_message_learned learned = publish_and_read_sensor(0);
    assert_int_equal(learned.innovations, 900);
    assert_int_equal(learned.looks, 1300);
    assert_float_equal(learned.sigma_range_factor, 2.0f, 1e-5f);
    assert_float_equal(learned.sigma_cross_factor, 1.0f, 0.0f);
    assert_float_equal(learned.pd[0], 0.75f, 0.0f);
    assert_float_equal(learned.pd[5], 0.375f, 1e-5f);
    assert_float_equal(publish_and_read_sensor(1).sigma_range_factor, 1.0f, 0.0f);
}

static void rows_without_a_sensor_fill_no_message(void **state)
{
    struct rho_message_learned learned = {.sensor_id = 77};

    (void)state;
    start_tracker_with_two_sensors();
    assert_int_equal(rho_publish_learned(&tracker, 2, &learned), 0);
    assert_int_equal(rho_publish_learned(NULL, 0, &learned), 0);
    assert_int_equal(rho_publish_learned(&tracker, 0, NULL), 0);
    tracker.magic = 0;
    assert_int_equal(rho_publish_learned(&tracker, 0, &learned), 0);
    assert_int_equal(learned.sensor_id, 77);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(before_learning_values_are_as_stated),
        cmocka_unit_test(learned_values_sent_are_those_in_use),
        cmocka_unit_test(rows_without_a_sensor_fill_no_message),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
