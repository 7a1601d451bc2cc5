/* SPDX-License-Identifier: MIT */
/*
 * Which radars start tracks from a common window: two of much the same coverage, in the order in
 * which they were described.
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

static void open_pipeline(double initiators_setting)
{
    struct parameters parameters;

    parameters_set_defaults(&parameters);
    parameters.value[PARAMETER_INITIATORS] = initiators_setting;
    for (int32_t id = 1; id <= 7; id++) {
        char assignment[40];

        snprintf(assignment, sizeof assignment, "sensor.%d.range_max_m=80000", (int)id);
        parameters_set_assignment(&parameters, assignment);
    }
    pipeline_open(&chain, &parameters);
}

static void describe_sensor(int32_t sensor_id, float x_m, float range_max_m)
{
    const struct rho_sensor sensor = {
        .sensor_id = sensor_id, .x_m = x_m, .pd = 0.9f, .range_max_m = range_max_m};

    assert_int_equal(rho_tracker_set_sensor(chain.tracker, &sensor), RHO_OK);
}

static struct rho_initiator *initiator_of(int32_t sensor_id)
{
    const struct rho_scan scan = {.sensor_id = sensor_id};

    return pipeline_initiator_of_sensor(&chain, &scan);
}

static void radars_of_the_same_coverage_share_a_window(void **state)
{
    (void)state;
    open_pipeline(INITIATORS_PAIRS);
    describe_sensor(7, 0.0f, 80e3f);
    describe_sensor(3, 60e3f, 80e3f);
    struct rho_initiator *first = initiator_of(7);
    assert_ptr_equal(initiator_of(3), first);
    assert_ptr_equal(initiator_of(7), first);
    assert_int_equal(chain.num_initiators, 1);
}

static void a_third_radar_shares_a_window_with_the_fourth(void **state)
{
    (void)state;
    open_pipeline(INITIATORS_PAIRS);
    for (int32_t id = 1; id <= 3; id++) {
        describe_sensor(id, 0.0f, 80e3f);
    }
    struct rho_initiator *third = initiator_of(3);
    assert_ptr_not_equal(initiator_of(1), third);
    assert_ptr_equal(initiator_of(2), initiator_of(1));
    describe_sensor(4, 0.0f, 80e3f);
    assert_ptr_equal(initiator_of(4), third);
    assert_ptr_equal(initiator_of(3), third);
    assert_ptr_equal(initiator_of(2), initiator_of(1)); /* sensors 1 and 2 stay a pair */
}

static void radars_of_different_coverage_have_a_window_each(void **state)
{
    (void)state;
    open_pipeline(INITIATORS_PAIRS);
    describe_sensor(1, 0.0f, 80e3f);
    describe_sensor(2, 65e3f, 80e3f); /* too far from sensor 1 */
    describe_sensor(3, 0.0f, 40e3f);  /* covers a quarter of sensor 1's area */
    assert_ptr_not_equal(initiator_of(1), initiator_of(2));
    assert_ptr_not_equal(initiator_of(1), initiator_of(3));
    assert_ptr_not_equal(initiator_of(99), initiator_of(1)); /* an undescribed sensor */
    open_pipeline(INITIATORS_SENSOR);
    describe_sensor(1, 0.0f, 80e3f);
    describe_sensor(2, 0.0f, 80e3f);
    assert_ptr_not_equal(initiator_of(1), initiator_of(2));
    open_pipeline(INITIATORS_ONE);
    assert_ptr_equal(initiator_of(1), initiator_of(99));
}

/*
 * Of a file, all sensors are described as the file says, so a sensor missing in the config may
 * share.
 */
static void live_sensors_missing_in_the_config_share_no_window(void **state)
{
    (void)state;
    for (int is_live = 0; is_live < 2; is_live++) {
        chain.is_live = is_live;
        open_pipeline(INITIATORS_PAIRS);
        describe_sensor(1, 0.0f, 80e3f);
        describe_sensor(8, 0.0f, 80e3f);
        assert_int_equal(initiator_of(8) == initiator_of(1), !is_live);
        describe_sensor(2, 0.0f, 80e3f);
        assert_int_equal(initiator_of(2) == initiator_of(1), is_live);
    }
    chain.is_live = false;
}

static void radars_with_sectors_have_their_own_window(void **state)
{
    (void)state;
    open_pipeline(INITIATORS_PAIRS);
    describe_sensor(1, 0.0f, 80e3f);
    describe_sensor(2, 0.0f, 80e3f);
    const struct rho_scan sector = {.sensor_id = 2, .sector_to_rad = 1.0f};
    assert_ptr_not_equal(pipeline_initiator_of_sensor(&chain, &sector), initiator_of(1));
}

/* Steps whole turns of both radars for a minute, until their turn times are known. */
static void step_turns_of_two_radars(int first_s, int second_s)
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

static void radars_of_different_turn_times_stop_sharing(void **state)
{
    (void)state;
    static const int turns_s[][3] = {{4, 5, 1}, {5, 4, 1}, {4, 4, 1}, {4, 10, 0}, {1, 2, 0}};

    for (size_t i = 0; i < sizeof turns_s / sizeof turns_s[0]; i++) {
        open_pipeline(INITIATORS_PAIRS);
        describe_sensor(1, 0.0f, 80e3f);
        describe_sensor(2, 0.0f, 80e3f);
        step_turns_of_two_radars(turns_s[i][0], turns_s[i][1]);
        assert_int_equal(initiator_of(1) == initiator_of(2), turns_s[i][2]);
    }
}

/* Seven turns of 10 s; the first scans had gone into the window that both radars shared. */
static void a_radar_that_stops_sharing_keeps_its_scans(void **state)
{
    (void)state;
    open_pipeline(INITIATORS_PAIRS);
    describe_sensor(1, 0.0f, 80e3f);
    describe_sensor(2, 0.0f, 80e3f);
    step_turns_of_two_radars(4, 10);
    struct rho_window *window = &initiator_of(2)->window;
    assert_ptr_not_equal(initiator_of(2), initiator_of(1));
    assert_int_equal(window->num_scans, 7);
    for (unsigned m = 0; m < window->num_scans; m++) {
        assert_int_equal(rho_window_scan_at(window, m)->time_us, m * 10 * SECOND_US);
        assert_int_equal(rho_window_scan_at(window, m)->sensor.sensor_id, 2);
    }
}

static bool share_a_window(float first_s, float second_s)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct rho_tracker_pace *pace = &chain.tracker->sensors[i].pace;
        const int32_t id = chain.tracker->sensors[i].sensor.sensor_id;

        pace->interval_s = id == 1 ? first_s : id == 2 ? second_s : pace->interval_s;
    }
    return initiator_of(1) == initiator_of(2);
}

/*
 * Near a ratio of 1.5 turns of one radar to a turn of the other, they do not change windows back
 * and forth.
 */
static void sharing_stops_at_1_5_and_resumes_at_1_4_times_the_turn(void **state)
{
    (void)state;
    for (int is_slow = 0; is_slow < 2; is_slow++) {
        const float slow_s = is_slow ? 10.0f : 4.0f;

        open_pipeline(INITIATORS_PAIRS);
        describe_sensor(1, 0.0f, 80e3f);
        describe_sensor(2, 0.0f, 80e3f);
        step_turns_of_two_radars(4, 4);
        assert_true(share_a_window(slow_s, slow_s / 1.45f));
        assert_true(share_a_window(slow_s, slow_s / 1.49f));
        assert_false(share_a_window(slow_s, slow_s / 1.51f));
        assert_false(share_a_window(slow_s, slow_s / 1.49f));
        assert_false(share_a_window(slow_s / 1.45f, slow_s));
        assert_true(share_a_window(slow_s, slow_s / 1.35f));
    }
}

static int allocate_pipeline(void **state)
{
    (void)state;
    chain = pipeline_allocate();
    return 0;
}

static int free_pipeline(void **state)
{
    (void)state;
    pipeline_free(&chain);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radars_of_the_same_coverage_share_a_window),
        cmocka_unit_test(a_third_radar_shares_a_window_with_the_fourth),
        cmocka_unit_test(radars_of_different_coverage_have_a_window_each),
        cmocka_unit_test(live_sensors_missing_in_the_config_share_no_window),
        cmocka_unit_test(radars_with_sectors_have_their_own_window),
        cmocka_unit_test(radars_of_different_turn_times_stop_sharing),
        cmocka_unit_test(a_radar_that_stops_sharing_keeps_its_scans),
        cmocka_unit_test(sharing_stops_at_1_5_and_resumes_at_1_4_times_the_turn),
    };
    return cmocka_run_group_tests(tests, allocate_pipeline, free_pipeline);
}
