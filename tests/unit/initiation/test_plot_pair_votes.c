/* SPDX-License-Identifier: MIT */
/* The multiples of the span that a search tries for an ambiguous range rate. */
#include "initiator_setup.h"

/*
 * Number of fits, one for each multiple with all votes. Three plots with sigmas of 100 m are of a
 * target at 200 m/s, whose range rates are measured modulo the span.
 */
static unsigned count_fits_with_span(double span_mps)
{
    struct rho_initiator_config config;
    struct rho_sensor sensor = sensor_at(0.0, 0.0);
    rho_initiator_config_default(&config);
    config.scans = config.min_scans = 3;
    config.v_max_mps = 400.0f;
    config.score_min_nat = -30.0f;
    config.false_tracks_per_hour = 0.0f;
    sensor.range_rate_span_mps = (float)span_mps;
    start_initiator(&config);
    for (int k = 0; k < 3; k++) {
        struct rho_plot *plot = add_plot(40000.0 - 400.0 * k, 0.0, 100.0, 100.0);
        plot->range_rate_mps = (float)remainder(-200.0, span_mps);
        plot->sigma_range_rate_mps = 0.3f;
        push_scan((struct rho_scan){.measures = RHO_MEASURES_RANGE_RATE}, 2.0 * k, &sensor);
    }
    search_window(RHO_SEARCH_BATCH);
    return initiator.work.fits;
}

/*
 * Multiples within the gate of the places, 2.6 times 35 m/s to either side, and at most eight to
 * either side.
 */
static void at_most_eight_multiples_of_the_span_are_tried_to_either_side(void **state)
{
    static const struct {
        double span_mps;
        unsigned fits;
    } cases[] = {{400.0, 1}, {50.0, 5}, {20.0, 11}, {9.0, 17}, {4.0, 17}, {1.0, 17}};
    (void)state;
    if (!RHO_AMBIGUOUS_RANGE_RATES) {
        skip();
    }
    for (size_t i = 0; i < NUM(cases); i++) {
        print_message("%.0f m/s: %u\n", cases[i].span_mps, count_fits_with_span(cases[i].span_mps));
        assert_int_equal(initiator.work.fits, cases[i].fits);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(at_most_eight_multiples_of_the_span_are_tried_to_either_side),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
