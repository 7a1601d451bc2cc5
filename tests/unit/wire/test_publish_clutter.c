/* SPDX-License-Identifier: MIT */
/* Known echoes of the tracker's clutter map as messages: receivers read the map's values. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/publish.h"

#define PART RHO_MESSAGE_CLUTTER_MAP_MAX_ECHOES

static struct rho_tracker tracker;
static struct rho_message_clutter_map list;

static void start_tracker(void)
{
    struct rho_tracker_config config;

    rho_tracker_config_default(&config);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    tracker.time_us = 77;
}

static void teach_echo(int32_t sensor_id, float x_m, uint16_t hits)
{
    assert_int_equal(
        rho_clutter_map_teach(&tracker.clutter_map, sensor_id, x_m, 2.0f, 3.0f, 4.0f, hits),
        RHO_OK);
}

/* Publishes the part and decodes it as receivers do. */
static void publish_and_read_part(uint16_t part)
{
    static struct rho_message_clutter_map filled;
    uint8_t buffer[RHO_MESSAGE_CLUTTER_MAP_MAX_SIZE];
    size_t size = 0;

    memset(&filled, 0x5a, sizeof filled);
    assert_int_equal(rho_publish_clutter(&tracker, part, &filled), RHO_OK);
    assert_int_equal(filled.scan, 0);
    assert_int_equal(filled.epoch, 0);
    assert_int_equal(rho_message_clutter_map_encode(&filled, buffer, sizeof buffer, &size), RHO_OK);
    assert_int_equal(rho_message_clutter_map_decode(buffer, size, &list), RHO_OK);
    assert_int_equal(rho_message_clutter_map_validate(&list, NULL), RHO_OK);
}

static void an_empty_map_is_sent_as_one_empty_part(void **state)
{
    (void)state;
    start_tracker();
    teach_echo(1, 100.0f, RHO_ECHO_KNOWN_HITS - 1); /* an echo of too few hits to be known */
    assert_int_equal(rho_publish_num_clutter_parts(&tracker), 1);
    assert_int_equal(rho_publish_num_clutter_parts(NULL), 1);
    publish_and_read_part(0);
    assert_int_equal(list.num_echoes, 0);
    assert_int_equal(list.num_echoes_total, 0);
    assert_int_equal(list.num_parts, 1);
    assert_int_equal(list.utime, 77);
    assert_int_equal(rho_publish_clutter(NULL, 0, &list), RHO_ERROR_NULL);
    assert_int_equal(rho_publish_clutter(&tracker, 0, NULL), RHO_ERROR_NULL);
    list.part = 77;
    assert_int_equal(rho_publish_clutter(&tracker, 1, &list), RHO_ERROR_VALUE);
    assert_int_equal(list.part, 77);
}

static void every_known_echo_is_sent_in_one_part(void **state)
{
    const int counts[] = {1, PART - 1, PART, PART + 1, 2 * PART + 1, RHO_MAX_ECHOES};

    (void)state;
    for (size_t k = 0; k < sizeof counts / sizeof counts[0]; k++) {
        const int parts = (counts[k] + PART - 1) / PART;
        int found = 0;

        start_tracker();
        for (int i = 0; i < counts[k]; i++) {
            teach_echo(1, (float)i, 6);
        }
        assert_int_equal(rho_publish_num_clutter_parts(&tracker), parts);
        for (int part = 0; part < parts; part++) {
            publish_and_read_part((uint16_t)part);
            assert_int_equal(list.part, part);
            assert_int_equal(list.num_parts, parts);
            assert_int_equal(list.num_echoes_total, counts[k]);
            for (int i = 0; i < list.num_echoes; i++) {
                assert_true(list.echoes[i].x_m == (float)found++);
            }
        }
        assert_int_equal(found, counts[k]);
    }
}

static void an_echo_is_sent_with_its_learned_values(void **state)
{
    (void)state;
    start_tracker();
    teach_echo(7, 100.0f, 20);
    tracker.clutter_map.echoes[0].vx_mps = -5.0f;
    tracker.clutter_map.echoes[0].unseen = 2;
    for (unsigned unseen = 1; unseen < 4; unseen++) {
        assert_int_equal(rho_clutter_map_teach_returns(&tracker.clutter_map, RHO_ECHO_TABLES - 1, 6,
                                                       unseen, 1e6f, 1e5f * (float)unseen),
                         RHO_OK);
    }
    publish_and_read_part(0);
    assert_int_equal(list.echoes[0].sensor_id, 7);
    assert_int_equal(list.echoes[0].hits, 20);
    assert_int_equal(list.echoes[0].unseen, 2);
    assert_true(list.echoes[0].x_m == 100.0f && list.echoes[0].y_m == 2.0f);
    assert_true(list.echoes[0].vx_mps == -5.0f && list.echoes[0].vy_mps == 0.0f);
    assert_true(fabsf(list.echoes[0].sigma_range_m - 3.0f) < 1e-4f);
    assert_true(fabsf(list.echoes[0].sigma_cross_m - 4.0f) < 1e-4f);
    /* chance of a plot in the next look, the third */
    assert_true(fabsf(list.echoes[0].chance - 0.3f) < 1e-3f);
}

/* Values beyond the message's ranges are sent as the largest value. */
static void values_beyond_the_message_are_clamped(void **state)
{
    struct rho_echo *echo = &tracker.clutter_map.echoes[0];

    (void)state;
    start_tracker();
    teach_echo(70000, 100.0f, 65535);
    echo->x_m = 1e8f;
    echo->y_m = -1e8f;
    echo->vx_mps = 1e6f;
    echo->vy_mps = -1e6f;
    echo->along[0] = echo->across[0] = 1e30f;
    echo->unseen = UINT8_MAX;
    publish_and_read_part(0);
    assert_int_equal(list.echoes[0].sensor_id, -1);
    assert_int_equal(list.echoes[0].hits, INT16_MAX);
    assert_true(list.echoes[0].x_m == 2e6f && list.echoes[0].y_m == -2e6f);
    assert_true(list.echoes[0].sigma_range_m == 1e6f && list.echoes[0].sigma_cross_m == 1e6f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_map_is_sent_as_one_empty_part),
        cmocka_unit_test(every_known_echo_is_sent_in_one_part),
        cmocka_unit_test(an_echo_is_sent_with_its_learned_values),
        cmocka_unit_test(values_beyond_the_message_are_clamped),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
