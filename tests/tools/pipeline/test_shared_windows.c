/* SPDX-License-Identifier: MIT */
/*
 * Which radars start tracks from one window: two that see much the same, in the order in which they
 * were described.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "pipeline/pipeline.h"

#define SECOND_US INT64_C(1000000)

static struct pipeline chain;

static void open_chain(double initiators)
{
    struct parameters parameters;

    parameters_set_defaults(&parameters);
    parameters.value[PARAMETER_INITIATORS] = initiators;
    for (int32_t id = 1; id <= 7; id++) {
        char assignment[40];

        snprintf(assignment, sizeof assignment, "sensor.%d.range_max_m=80000", (int)id);
        parameters_set_assignment(&parameters, assignment);
    }
    pipeline_open(&chain, &parameters);
}

static void describe(int32_t sensor_id, float x_m, float range_max_m)
{
    const struct rho_sensor sensor = {
        .sensor_id = sensor_id, .x_m = x_m, .pd = 0.9f, .range_max_m = range_max_m};

    assert_int_equal(rho_tracker_set_sensor(chain.tracker, &sensor), RHO_OK);
}

static struct rho_initiator *of(int32_t sensor_id)
{
    const struct rho_scan scan = {.sensor_id = sensor_id};

    return pipeline_initiator_of_scan(&chain, &scan);
}

static void radars_that_see_the_same_share_a_window(void **state)
{
    (void)state;
    open_chain(INITIATORS_PAIRS);
    describe(7, 0.0f, 80e3f);
    describe(3, 60e3f, 80e3f);
    struct rho_initiator *first = of(7);
    assert_ptr_equal(of(3), first);
    assert_ptr_equal(of(7), first);
    assert_int_equal(chain.num_initiators, 1);
}

static void a_third_one_has_its_own_and_pairs_with_the_fourth(void **state)
{
    (void)state;
    open_chain(INITIATORS_PAIRS);
    for (int32_t id = 1; id <= 3; id++) {
        describe(id, 0.0f, 80e3f);
    }
    struct rho_initiator *third = of(3);
    assert_ptr_not_equal(of(1), third);
    assert_ptr_equal(of(2), of(1));
    describe(4, 0.0f, 80e3f);
    assert_ptr_equal(of(4), third);
    assert_ptr_equal(of(3), third);
    assert_ptr_equal(of(2), of(1)); /* pairs stay */
}

static void others_have_a_window_each(void **state)
{
    (void)state;
    open_chain(INITIATORS_PAIRS);
    describe(1, 0.0f, 80e3f);
    describe(2, 65e3f, 80e3f); /* too far away */
    describe(3, 0.0f, 40e3f);  /* sees a quarter of it */
    assert_ptr_not_equal(of(1), of(2));
    assert_ptr_not_equal(of(1), of(3));
    assert_ptr_not_equal(of(99), of(1)); /* nobody described it */
    open_chain(INITIATORS_SENSOR);
    describe(1, 0.0f, 80e3f);
    describe(2, 0.0f, 80e3f);
    assert_ptr_not_equal(of(1), of(2));
    open_chain(INITIATORS_ONE);
    assert_ptr_equal(of(1), of(99));
}

/* In a file all sensors are what they say. */
static void live_a_sensor_that_the_config_does_not_name_pairs_with_nobody(void **state)
{
    (void)state;
    for (int is_live = 0; is_live < 2; is_live++) {
        chain.is_live = is_live;
        open_chain(INITIATORS_PAIRS);
        describe(1, 0.0f, 80e3f);
        describe(8, 0.0f, 80e3f);
        assert_int_equal(of(8) == of(1), !is_live);
        describe(2, 0.0f, 80e3f);
        assert_int_equal(of(2) == of(1), is_live);
    }
    chain.is_live = false;
}

static void sectors_have_their_radar_s_own(void **state)
{
    (void)state;
    open_chain(INITIATORS_PAIRS);
    describe(1, 0.0f, 80e3f);
    describe(2, 0.0f, 80e3f);
    const struct rho_scan sector = {.sensor_id = 2, .sector_to_rad = 1.0f};
    assert_ptr_not_equal(pipeline_initiator_of_scan(&chain, &sector), of(1));
}

/* Whole turns of both, until it is known how long they are. */
static void turn(int first_s, int second_s)
{
    for (int t_s = 0; t_s <= 60; t_s++) {
        for (int32_t id = 1; id <= 2; id++) {
            const struct rho_scan scan = {.sensor_id = id, .time_us = t_s * SECOND_US};

            if (t_s % (id == 1 ? first_s : second_s) == 0) {
                pipeline_step(&chain, &scan);
            }
        }
    }
}

static void turns_that_differ_much_part_them(void **state)
{
    (void)state;
    static const int turns_s[][3] = {{4, 5, 1}, {5, 4, 1}, {4, 4, 1}, {4, 10, 0}, {1, 2, 0}};

    for (size_t i = 0; i < sizeof turns_s / sizeof turns_s[0]; i++) {
        open_chain(INITIATORS_PAIRS);
        describe(1, 0.0f, 80e3f);
        describe(2, 0.0f, 80e3f);
        turn(turns_s[i][0], turns_s[i][1]);
        assert_int_equal(of(1) == of(2), turns_s[i][2]);
    }
}

/* Seven turns of 10 s, the first ones of which went into the window that both shared. */
static void who_parts_takes_its_scans_along(void **state)
{
    (void)state;
    open_chain(INITIATORS_PAIRS);
    describe(1, 0.0f, 80e3f);
    describe(2, 0.0f, 80e3f);
    turn(4, 10);
    struct rho_window *window = &of(2)->window;
    assert_ptr_not_equal(of(2), of(1));
    assert_int_equal(window->num_scans, 7);
    for (unsigned m = 0; m < window->num_scans; m++) {
        assert_int_equal(rho_window_scan_at(window, m)->time_us, m * 10 * SECOND_US);
        assert_int_equal(rho_window_scan_at(window, m)->sensor.sensor_id, 2);
    }
}

static bool share_a_window(float first_s, float second_s)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct rho_tracker_pace *pace = &chain.tracker->paces[i];

        pace->interval_s = pace->sensor_id == 1   ? first_s
                           : pace->sensor_id == 2 ? second_s
                                                  : pace->interval_s;
    }
    return of(1) == of(2);
}

/* Near 1.5 turns during a turn of the other they do not change windows by turns. */
static void who_has_parted_pairs_again_well_below(void **state)
{
    (void)state;
    for (int is_slow = 0; is_slow < 2; is_slow++) {
        const float slow_s = is_slow ? 10.0f : 4.0f;

        open_chain(INITIATORS_PAIRS);
        describe(1, 0.0f, 80e3f);
        describe(2, 0.0f, 80e3f);
        turn(4, 4);
        assert_true(share_a_window(slow_s, slow_s / 1.45f));
        assert_true(share_a_window(slow_s, slow_s / 1.49f));
        assert_false(share_a_window(slow_s, slow_s / 1.51f));
        assert_false(share_a_window(slow_s, slow_s / 1.49f));
        assert_false(share_a_window(slow_s / 1.45f, slow_s));
        assert_true(share_a_window(slow_s, slow_s / 1.35f));
    }
}

static int start_chain(void **state)
{
    (void)state;
    chain = pipeline_allocate();
    return 0;
}

static int end_chain(void **state)
{
    (void)state;
    pipeline_free(&chain);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radars_that_see_the_same_share_a_window),
        cmocka_unit_test(a_third_one_has_its_own_and_pairs_with_the_fourth),
        cmocka_unit_test(others_have_a_window_each),
        cmocka_unit_test(live_a_sensor_that_the_config_does_not_name_pairs_with_nobody),
        cmocka_unit_test(sectors_have_their_radar_s_own),
        cmocka_unit_test(turns_that_differ_much_part_them),
        cmocka_unit_test(who_parts_takes_its_scans_along),
        cmocka_unit_test(who_has_parted_pairs_again_well_below),
    };
    return cmocka_run_group_tests(tests, start_chain, end_chain);
}
