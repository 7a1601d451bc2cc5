/* SPDX-License-Identifier: MIT */
/* Effect of a sensor's coverage and detection probability on the score of hits and misses. */
#include "initiator_single_track_config.h"

/*
 * Score of a target at 20 km range and azimuth 0 that scan 2 misses. Each scan has one plot, so
 * that both sensors have equal clutter; odd scans are those of `odd`.
 */
static int32_t score_with_one_miss(struct rho_scan scan, const struct rho_sensor *even,
                                   const struct rho_sensor *odd)
{
    struct rho_initiator_config config = usual_config();
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        if (k == 2) {
            add_plot(40000.0, 19000.0, 10.0, 10.0);
        } else {
            add_plot(20000.0 + 100.0 * SCAN_S * k, 0.0, 10.0, 10.0);
        }
        const struct rho_sensor *sensor = k % 2 ? odd : even;
        scan.sensor_id = sensor ? sensor->sensor_id : 0;
        push_scan(scan, SCAN_S * k, sensor);
    }
    search_window(RHO_SEARCH_BATCH);
    assert_int_equal(initiator.num_candidates, 1);
    assert_int_equal(initiator.candidates[0].mask, 0x7b);
    return initiator.candidates[0].score_mnat;
}

static void expect_score_difference(int32_t score_mnat, int32_t than_mnat, double nat)
{
    assert_float_equal(score_mnat - than_mnat, 1000.0 * nat, 2.0);
}

static void misses_count_only_inside_the_sensors_coverage(void **state)
{
    (void)state;
    const struct rho_scan whole = {0}, ahead = {.sector_from_rad = -1.0f, .sector_to_rad = 1.0f};
    const struct rho_scan aside = {.sector_from_rad = 1.0f, .sector_to_rad = 2.0f};
    const struct rho_sensor all = sensor_at(0.0, 0.0);
    struct rho_sensor far = all, near = all, turned = all, facing = all;
    far.range_min_m = 25000.0f, near.range_max_m = 15000.0f;
    turned.sector_from_rad = 1.0f, turned.sector_to_rad = 2.0f;
    facing.sector_from_rad = -1.0f, facing.sector_to_rad = 1.0f;
    int32_t looked = score_with_one_miss(whole, &all, &all);
    assert_int_equal(score_with_one_miss(whole, NULL, NULL), looked);
    assert_int_equal(score_with_one_miss(ahead, &all, &all), looked);
    assert_int_equal(score_with_one_miss(whole, &facing, &facing), looked);
    expect_score_difference(score_with_one_miss(aside, &all, &all), looked, -log(1.0 - PD));
    expect_score_difference(score_with_one_miss(aside, NULL, NULL), looked, -log(1.0 - PD));
    expect_score_difference(score_with_one_miss(whole, &far, &far), looked, -log(1.0 - PD));
    expect_score_difference(score_with_one_miss(whole, &near, &near), looked, -log(1.0 - PD));
    expect_score_difference(score_with_one_miss(whole, &turned, &turned), looked, -log(1.0 - PD));
}

/* The same sector, from another sensor's place, may contain the target or not. */
static void sectors_and_ranges_are_seen_from_the_sensors_place(void **state)
{
    (void)state;
    const struct rho_scan north = {.sector_from_rad = 1.0f, .sector_to_rad = 2.0f};
    const struct rho_sensor below = sensor_at(20000.0, -20000.0);
    struct rho_sensor beside = sensor_at(-20000.0, 0.0);
    int32_t looked = score_with_one_miss((struct rho_scan){0}, NULL, NULL);
    assert_int_equal(score_with_one_miss(north, &below, &below), looked);
    beside.range_max_m = 30000.0f;
    expect_score_difference(score_with_one_miss((struct rho_scan){0}, &beside, &beside), looked,
                            -log(1.0 - PD));
}

static void a_sensors_own_detection_probability_is_used(void **state)
{
    (void)state;
    const struct rho_scan scan = {0};
    struct rho_sensor weak = sensor_at(0.0, 0.0), strong = weak;
    weak.sensor_id = 1, weak.pd = 0.6f;
    strong.sensor_id = 2, strong.pd = 0.98f;
    int32_t usual_mnat = score_with_one_miss(scan, NULL, NULL);
    expect_score_difference(score_with_one_miss(scan, &weak, &weak), usual_mnat,
                            6.0 * log(0.6 / PD) + log(0.4 / (1.0 - PD)));
    /* weak: three hits and the miss; strong: three hits */
    expect_score_difference(score_with_one_miss(scan, &weak, &strong), usual_mnat,
                            3.0 * log(0.6 / PD) + 3.0 * log(0.98 / PD) + log(0.4 / (1.0 - PD)));
    expect_score_difference(score_with_one_miss(scan, &strong, NULL), usual_mnat,
                            3.0 * log(0.98 / PD) + log(0.02 / (1.0 - PD)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(misses_count_only_inside_the_sensors_coverage),
        cmocka_unit_test(sectors_and_ranges_are_seen_from_the_sensors_place),
        cmocka_unit_test(a_sensors_own_detection_probability_is_used),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
