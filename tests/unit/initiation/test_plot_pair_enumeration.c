/* SPDX-License-Identifier: MIT */
/*
 * Kernels over long spans need more votes than M, as misses lower the score: in even clutter this
 * saves work and keeps the candidates. M alone counts in thin clutter and where other radars' scans
 * lie between.
 */
#include "initiator_setup.h"

#define SCANS 7
#define SCAN_S 10.0
#define TARGETS 8
#define CLUTTER 240

static const struct rho_extent square = {-8000.0f, 8000.0f, -8000.0f, 8000.0f};

static struct rho_initiator_config test_config(void)
{
    struct rho_initiator_config config;
    rho_initiator_config_default(&config);
    config.v_max_mps = 140.0f;
    config.work_max = 0;
    config.area_is_fixed = 1;
    config.area = square;
    return config;
}

static void push_scan_of_radar(int k, int32_t sensor_id, const struct rho_sensor *radar)
{
    struct rho_sensor sensor = *radar;
    sensor.sensor_id = sensor_id;
    push_scan((struct rho_scan){.sensor_id = sensor_id}, SCAN_S * k, &sensor);
}

/* Even clutter and targets with some misses, seen by this number of radars in turn. */
static void search_even_clutter(int radars)
{
    const struct rho_initiator_config config = test_config();
    const struct rho_sensor radar = sensor_at(0.0, 0.0);
    random_state = 5;
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        add_clutter_plots(&square, CLUTTER);
        for (int i = 0; i < TARGETS; i++) {
            double x_m = -4000.0 + 80.0 * SCAN_S * k + 10.0 * normal();
            double y_m = 1800.0 * i - 6500.0 + 10.0 * normal();
            if ((i + k) % 6 > 0) {
                add_plot(x_m, y_m, 10.0, 10.0);
            }
        }
        push_scan_of_radar(k, 1 + k % radars, &radar);
    }
    search_window(RHO_SEARCH_NEWEST);
}

static void kernels_that_cannot_start_a_track_are_skipped(void **state)
{
    (void)state;
    struct rho_candidate found[RHO_MAX_CANDIDATES];
    search_even_clutter(2); /* with two radars in turn M alone counts for every span */
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

/* A target without noise that has a plot in even scans only. */
static void add_plot_in_even_scans(int k, double y_m)
{
    if (k % 2 == 0) {
        add_plot(-7000.0 + 60.0 * SCAN_S * k, y_m, 10.0, 10.0);
    }
}

static int is_even_scan_track_found(double y_m)
{
    for (unsigned i = 0; i < initiator.num_candidates; i++) {
        const struct rho_candidate *candidate = &initiator.candidates[i];
        if (candidate->mask == 0x55 && fabs((double)candidate->y_m - y_m) < 1.0) {
            return 1;
        }
    }
    return 0;
}

static void misses_of_a_radar_outside_its_range_do_not_count(void **state)
{
    (void)state;
    const struct rho_initiator_config config = test_config();
    const struct rho_sensor first = sensor_at(0.0, 0.0);
    struct rho_sensor second = sensor_at(0.0, -8000.0);
    second.range_max_m = 11000.0f;
    random_state = 5;
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        add_clutter_plots(&square, CLUTTER);
        add_plot_in_even_scans(k, 6500.0);
        push_scan_of_radar(k, 1 + k % 2, k % 2 ? &second : &first);
    }
    search_window(RHO_SEARCH_NEWEST);
    assert_true(is_even_scan_track_found(6500.0));
}

static void fewer_votes_start_a_track_in_thin_clutter(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    const struct rho_sensor radar = sensor_at(0.0, 0.0);
    const struct rho_extent south = {-8000.0f, 8000.0f, -8000.0f, 0.0f};
    random_state = 5;
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        add_clutter_plots(&south, CLUTTER);
        add_plot_in_even_scans(k, 6000.0);
        push_scan_of_radar(k, 1, &radar);
    }
    search_window(RHO_SEARCH_NEWEST);
    assert_true(is_even_scan_track_found(6000.0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kernels_that_cannot_start_a_track_are_skipped),
        cmocka_unit_test(misses_of_a_radar_outside_its_range_do_not_count),
        cmocka_unit_test(fewer_votes_start_a_track_in_thin_clutter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
