/* SPDX-License-Identifier: MIT */
/*
 * Values that the assembler and the tracker hold of each sensor, as messages: receivers read the
 * same values.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/publish.h"

#define PART RHO_MESSAGE_SENSOR_LIST_MAX_SENSORS
#define NOW_US INT64_C(5000000000)

static struct rho_tracker tracker;
static struct rho_scan_assembler assembler;
static struct rho_message_sensor_list list;

static void fill_sources(unsigned num_sources)
{
    struct rho_scan_assembler_config config;

    rho_scan_assembler_config_default(&config);
    assert_int_equal(rho_scan_assembler_init(&assembler, sizeof assembler, &config), RHO_OK);
    memset(&tracker, 0, sizeof tracker);
    for (unsigned i = 0; i < num_sources; i++) {
        assembler.sources[i] = (struct rho_scan_assembler_source){
            .place = {.time_us = 1000 + i, .scan = 7, .epoch = 1},
            .heard_us = NOW_US - 10 * (int64_t)i,
            .interval_us = 4000000 + i,
            .scans = (uint16_t)(i + 1),
            .sensor_id = (int16_t)(100 + i),
            .kind = (uint8_t)(i % RHO_NUM_SCAN_ASSEMBLER_KINDS),
            .is_used = 1,
        };
    }
}

/* Publishes the part and decodes it as receivers do. */
static void publish_and_read_part(const struct rho_tracker *of, uint16_t part)
{
    static struct rho_message_sensor_list filled;
    uint8_t buffer[RHO_MESSAGE_SENSOR_LIST_MAX_SIZE];
    size_t size = 0;

    memset(&filled, 0x5a, sizeof filled);
    assert_int_equal(rho_publish_sensors(&assembler, of, NOW_US, part, &filled), RHO_OK);
    assert_int_equal(filled.scan, 0);
    assert_int_equal(filled.epoch, 0);
    assert_int_equal(rho_message_sensor_list_encode(&filled, buffer, sizeof buffer, &size), RHO_OK);
    assert_int_equal(rho_message_sensor_list_decode(buffer, size, &list), RHO_OK);
    assert_int_equal(rho_message_sensor_list_validate(&list, NULL), RHO_OK);
}

static void without_sensors_one_empty_part_is_sent(void **state)
{
    struct rho_message_sensor sensor;

    (void)state;
    fill_sources(0);
    assert_int_equal(rho_publish_num_sensor_parts(&assembler), 1);
    assert_int_equal(rho_publish_num_sensor_parts(NULL), 1);
    publish_and_read_part(&tracker, 0);
    assert_int_equal(list.num_sensors, 0);
    assert_int_equal(list.num_sensors_total, 0);
    assert_int_equal(rho_publish_sensor(&assembler, &tracker, 0, 0, &sensor), 0);
    assert_int_equal(rho_publish_sensor(NULL, &tracker, 0, 0, &sensor), 0);
    assert_int_equal(rho_publish_sensors(NULL, &tracker, 0, 0, &list), RHO_ERROR_NULL);
    assert_int_equal(rho_publish_sensors(&assembler, &tracker, 0, 0, NULL), RHO_ERROR_NULL);
    list.part = 77;
    assert_int_equal(rho_publish_sensors(&assembler, &tracker, 0, 1, &list), RHO_ERROR_VALUE);
    assert_int_equal(list.part, 77);
}

/* As many sensors as fit, in the order of their places, even if a place in between is free. */
static void every_sensor_is_sent_in_one_part(void **state)
{
    const unsigned used = RHO_MAX_SENSORS - 1;
    unsigned found = 0, hole = RHO_MAX_SENSORS / 2;

    (void)state;
    fill_sources(RHO_MAX_SENSORS);
    assembler.sources[hole].is_used = 0;
    tracker.time_us = -77;
    assert_int_equal(rho_publish_num_sensor_parts(&assembler), (used + PART - 1) / PART);
    for (uint16_t part = 0; part < rho_publish_num_sensor_parts(&assembler); part++) {
        publish_and_read_part(&tracker, part);
        assert_true(list.utime == -77);
        assert_int_equal(list.part, part);
        assert_int_equal(list.num_sensors_total, used);
        for (int i = 0; i < list.num_sensors; i++, found++) {
            const unsigned place = found + (found >= hole);

            assert_int_equal(list.sensors[i].sensor_id, 100 + place);
            assert_int_equal(list.sensors[i].kind, 1 + place % 3);
            assert_int_equal(list.sensors[i].scans, place + 1);
            assert_true(list.sensors[i].scan_utime == 1000 + (int64_t)place);
            assert_int_equal(list.sensors[i].heard_age_us, 10 * place);
            assert_int_equal(list.sensors[i].interval_us, 4000000 + place);
            assert_int_equal(list.sensors[i].is_silent + list.sensors[i].is_off_clock, 0);
        }
    }
    assert_int_equal(found, used);
}

static void silent_and_off_clock_sensors_are_marked(void **state)
{
    struct rho_message_sensor sensor;
    const int64_t jump_us = 30000000;

    (void)state;
    fill_sources(1);
    assert_int_equal(rho_publish_sensor(&assembler, NULL, NOW_US + jump_us, 0, &sensor), 1);
    assert_int_equal(sensor.is_silent, 0);
    assert_int_equal(sensor.heard_age_us, jump_us);
    assert_int_equal(rho_publish_sensor(&assembler, NULL, NOW_US + jump_us + 1, 0, &sensor), 1);
    assert_int_equal(sensor.is_silent, 1);
    assert_int_equal(sensor.is_off_clock, 0);
    /* with the reception clock set back, ages are 0; the widest time span does not overflow */
    assert_int_equal(rho_publish_sensor(&assembler, NULL, INT64_MIN, 0, &sensor), 1);
    assert_int_equal(sensor.is_silent + sensor.heard_age_us, 0);
    assembler.sources[0].heard_us = INT64_MIN;
    assembler.sources[0].interval_us = UINT32_MAX;
    assembler.sources[0].off_clock = 2;
    assert_int_equal(rho_publish_sensor(&assembler, NULL, INT64_MAX, 0, &sensor), 1);
    assert_int_equal(sensor.is_silent, 1);
    assert_int_equal(sensor.heard_age_us, INT32_MAX);
    assert_int_equal(sensor.interval_us, INT32_MAX);
    assert_int_equal(sensor.is_off_clock, 1);
    assert_int_equal(rho_message_sensor_validate(&sensor, NULL), RHO_OK);
}

/* The tracker watches radars; a passive sensor of the same number is a different sensor. */
static void only_sensors_of_plots_are_marked_suspect(void **state)
{
    (void)state;
    fill_sources(3);
    assembler.sources[2].sensor_id = 101; /* a sensor of bearings */
    tracker.num_rows = 2;
    tracker.sensors[0].sensor.sensor_id = 55;
    tracker.sensors[0].look = (struct rho_tracker_look){.count = 1, .is_suspect = 1};
    tracker.sensors[1].sensor.sensor_id = 101;
    tracker.sensors[1].look = (struct rho_tracker_look){.count = 1,
                                                        .seen_share = 0.75f,
                                                        .distance2 = 9.0f,
                                                        .watched = 16,
                                                        .watched_hits = 12,
                                                        .is_suspect = 1};
    publish_and_read_part(&tracker, 0);
    assert_int_equal(list.num_sensors, 3);
    assert_int_equal(list.sensors[0].is_doubted + list.sensors[0].watched, 0);
    assert_int_equal(list.sensors[1].is_doubted, 1);
    assert_int_equal(list.sensors[1].watched, 16);
    assert_int_equal(list.sensors[1].watched_hits, 12);
    assert_float_equal(list.sensors[1].seen_share, 0.75f, 0.0f);
    assert_float_equal(list.sensors[1].innovation_factor, 9.0f, 0.0f);
    assert_int_equal(list.sensors[2].is_doubted + list.sensors[2].watched, 0);
    publish_and_read_part(NULL, 0);
    assert_int_equal(list.sensors[1].is_doubted + list.sensors[1].watched, 0);
    assert_true(list.utime == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_sensors_one_empty_part_is_sent),
        cmocka_unit_test(every_sensor_is_sent_in_one_part),
        cmocka_unit_test(silent_and_off_clock_sensors_are_marked),
        cmocka_unit_test(only_sensors_of_plots_are_marked_suspect),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
