/* SPDX-License-Identifier: MIT */
/*
 * Long spans need more votes than M where misses cost a set its score: less work and the same
 * candidates in even clutter; M alone where clutter is thinner, or where other radars' scans lie
 * between.
 */
#include "initiator_setup.h"

#define SCANS 7
#define SCAN_S 10.0
#define TARGETS 8
#define CLUTTER 240

static const struct rho_extent square = {-8000.0f, 8000.0f, -8000.0f, 8000.0f};

static struct rho_initiator_config usual(void)
{
    struct rho_initiator_config config;
    rho_initiator_config_default(&config);
    config.v_max_mps = 140.0f;
    config.work_max = 0;
    config.area_is_fixed = 1;
    config.area = square;
    return config;
}

static void push_from(int k, int32_t sensor_id, const struct rho_sensor *radar)
{
    struct rho_sensor sensor = *radar;
    sensor.sensor_id = sensor_id;
    push_scan((struct rho_scan){.sensor_id = sensor_id}, SCAN_S * k, &sensor);
}

/* Even clutter and targets that a scan misses now and then, of so many radars in turns. */
static void search_even_clutter(int radars)
{
    const struct rho_initiator_config config = usual();
    const struct rho_sensor radar = sensor_at(0.0, 0.0);
    random_state = 5;
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        add_clutter(&square, CLUTTER);
        for (int i = 0; i < TARGETS; i++) {
            double x_m = -4000.0 + 80.0 * SCAN_S * k + 10.0 * normal();
            double y_m = 1800.0 * i - 6500.0 + 10.0 * normal();
            if ((i + k) % 6 > 0) {
                add_plot(x_m, y_m, 10.0, 10.0);
            }
        }
        push_from(k, 1 + k % radars, &radar);
    }
    search_window(RHO_SEARCH_NEWEST);
}

static void long_spans_that_cannot_start_a_track_cost_nothing(void **state)
{
    (void)state;
    struct rho_candidate found[RHO_MAX_CANDIDATES];
    search_even_clutter(2); /* with two radars in turns M holds for every span */
    const unsigned count = initiator.num_candidates;
    const uint32_t work = initiator.budget.work;
    memcpy(found, initiator.candidates, sizeof found);
    search_even_clutter(1);
    print_message("%u candidates, M %u; work %u, by M alone %u\n", count, initiator.min_scans,
                  initiator.budget.work, work);
    assert_true(count >= TARGETS - 2);
    assert_int_equal(initiator.num_candidates, count);
    for (unsigned i = 0; i < count; i++) {
        assert_int_equal(initiator.candidates[i].mask, found[i].mask);
        assert_memory_equal(initiator.candidates[i].plot, found[i].plot, sizeof found[i].plot);
    }
    assert_true(RHO_MAX_PLOTS <= 64 || (double)initiator.budget.work < 0.7 * work);
}

/* A target without noise that every second scan sees. */
static void add_every_second(int k, double y_m)
{
    if (k % 2 == 0) {
        add_plot(-7000.0 + 60.0 * SCAN_S * k, y_m, 10.0, 10.0);
    }
}

static int has_every_second(double y_m)
{
    for (unsigned i = 0; i < initiator.num_candidates; i++) {
        const struct rho_candidate *candidate = &initiator.candidates[i];
        if (candidate->mask == 0x55 && fabs((double)candidate->y_m - y_m) < 1.0) {
            return 1;
        }
    }
    return 0;
}

static void misses_of_a_radar_that_does_not_look_there_do_not_count(void **state)
{
    (void)state;
    const struct rho_initiator_config config = usual();
    const struct rho_sensor first = sensor_at(0.0, 0.0);
    struct rho_sensor second = sensor_at(0.0, -8000.0);
    second.range_max_m = 11000.0f;
    random_state = 5;
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        add_clutter(&square, CLUTTER);
        add_every_second(k, 6500.0);
        push_from(k, 1 + k % 2, k % 2 ? &second : &first);
    }
    search_window(RHO_SEARCH_NEWEST);
    assert_true(has_every_second(6500.0));
}

static void fewer_votes_are_enough_where_clutter_is_thin(void **state)
{
    (void)state;
    struct rho_initiator_config config = usual();
    const struct rho_sensor radar = sensor_at(0.0, 0.0);
    const struct rho_extent south = {-8000.0f, 8000.0f, -8000.0f, 0.0f};
    random_state = 5;
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        add_clutter(&south, CLUTTER);
        add_every_second(k, 6000.0);
        push_from(k, 1, &radar);
    }
    search_window(RHO_SEARCH_NEWEST);
    assert_true(has_every_second(6000.0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(long_spans_that_cannot_start_a_track_cost_nothing),
        cmocka_unit_test(misses_of_a_radar_that_does_not_look_there_do_not_count),
        cmocka_unit_test(fewer_votes_are_enough_where_clutter_is_thin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
