/* SPDX-License-Identifier: MIT */
/*
 * A plot as an outline sees it: noise and range rate as the measurement's own functions have them,
 * turned to the axes of the body. With the private header.
 */
#include "../../src/bodies/bodies.h"
#include "../../src/tracker/step.h"
#include "hand_made_look.h"
#include "rhotrack/detail/body_extent_filter.h"
#include "rhotrack/detail/measurement.h"

#if RHO_BODIES

static struct rho_sensor radar = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 5e3f, .x_m = 3.0f};

static void expect_close(float is, float wanted, float least)
{
    assert_true(fabsf(is - wanted) <= 1e-4f * fabsf(wanted) + least);
}

/* One plot at a place; the body stands at the origin, heads to 0.5 rad and moves. */
static void compare_at(double x_m, double y_m, double z_m, uint32_t measures)
{
    const struct body_outline outline = {
        .velocity_mps = {4.0f, -7.0f, 2.0f}, .cos_heading = cosf(0.5f), .sin_heading = sinf(0.5f)};
    struct outline_fit fit;
    struct rho_measurement seen;
    float noise_m2[6], axes_m2[3], row[6], rate_mps = 0.0f;
    num_plots = 0;
    struct rho_plot *plot = add_plot(x_m, y_m, 0.2);
    plot->z_m = (float)z_m;
    plot->sigma_cross_m = 0.7f;
    plot->range_rate_mps = 1.5f;
    plot->sigma_range_rate_mps = 0.3f;
    begin_look(0, 0.7f);
    at.look.sensor = &radar;
    scan.measures = measures;
    rho_bodies_see_plot(&at.look, &outline, plot, &fit);
    rho_measurement_from_plot(plot, 0, &radar, &seen);
    rho_measurement_covariance(&seen, noise_m2);
    rho_body_rotate_covariance(outline.cos_heading, outline.sin_heading, noise_m2, axes_m2);
    for (int i = 0; i < 3; i++) {
        expect_close(fit.noise_m2[i], axes_m2[i], 1e-5f);
    }
    const float state[6] = {plot->x_m,
                            plot->y_m,
                            plot->z_m,
                            outline.velocity_mps[0],
                            outline.velocity_mps[1],
                            outline.velocity_mps[2]};
    const int has_rate = (measures & RHO_MEASURES_RANGE_RATE) &&
                         rho_measurement_predict_rate(
                             state, &radar, (measures & RHO_MEASURES_Z) != 0, row, &rate_mps);
    assert_int_equal(fit.has_rate, has_rate);
    expect_close(fit.rate_mps, has_rate ? 1.5f - rate_mps : 0.0f, 1e-5f);
    const float turned_mps = has_rate ? (row[3] * row[1] - row[4] * row[0]) * 0.7f : 0.0f;
    expect_close(fit.line_turn_m2ps2, turned_mps * turned_mps, 1e-5f);
    expect_close(fit.rate_m2ps2, has_rate ? 0.09f + turned_mps * turned_mps : 0.0f, 1e-5f);
    expect_close(fit.sight_line[0], has_rate ? row[3] : 0.0f, 1e-5f);
    expect_close(fit.sight_line[1], has_rate ? row[4] : 0.0f, 1e-5f);
}

static void a_plot_is_seen_as_the_measurement_has_it(void **state)
{
    static const uint32_t measures[] = {0, RHO_MEASURES_RANGE_RATE,
                                        RHO_MEASURES_RANGE_RATE | RHO_MEASURES_Z};
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    for (int percent = 0; percent <= 200; percent += 50) {
        radar.sigma_range_percent = (uint16_t)percent;
        radar.sigma_cross_percent = (uint16_t)(percent ? 250 - percent : 0);
        for (unsigned k = 0; k < 3; k++) {
            compare_at(120.0, -45.0, 0.0, measures[k]);
            compare_at(-20.0, 3.0, 35.0, measures[k]);
            compare_at(3.2, 0.1, 0.0, measures[k]);  /* at the sensor */
            compare_at(3.2, 0.1, 30.0, measures[k]); /* above it */
        }
    }
}

/* The only plot of a look, 100 m east. */
static struct rho_plot *begin_look_with_a_plot(uint32_t measures)
{
    use_usual_configs(1);
    begin_tracker();
    num_plots = 0;
    struct rho_plot *plot = add_plot(100.0, 0.0, 1.0);
    begin_look(0, 1.0f);
    scan.measures = measures;
    return plot;
}

/* What is not measured may be anything. */
static void range_rates_that_were_not_measured_are_none(void **state)
{
    const struct body_outline outline = {.velocity_mps = {20.0f, 0.0f, 0.0f}, .cos_heading = 1.0f};
    struct outline_fit fit;
    (void)state;
    struct rho_plot *plot = begin_look_with_a_plot(0);
    plot->range_rate_mps = NAN;
    rho_bodies_see_plot(&at.look, &outline, plot, &fit);
    assert_false(fit.has_rate);
    assert_true(fit.rate_mps == 0.0f && fit.rate_m2ps2 == 0.0f && fit.sight_line[0] == 0.0f);
}

/* Limbs spread range rates: what was learned of them adds, up to twice the noise of the rate. */
static void limbs_spread_range_rates_up_to_twice_their_noise(void **state)
{
    struct body_outline outline = {.velocity_mps = {1.0f, 0.0f, 0.0f}, .cos_heading = 1.0f};
    struct outline_fit fit;
    (void)state;
    struct rho_plot *plot = begin_look_with_a_plot(RHO_MEASURES_RANGE_RATE);
    plot->sigma_range_rate_mps = 0.1f;
    for (int percent = 0; percent <= 800; percent += 50) {
        outline.rates_m2ps2 = 1e-4f * (float)percent;
        rho_bodies_see_plot(&at.look, &outline, plot, &fit);
        expect_close(fit.rate_m2ps2, 0.01f + 1e-4f * (float)(percent < 400 ? percent : 400), 1e-6f);
    }
}

/* One body in place of two that move apart along the line of sight: its range rates have both. */
static void one_body_for_two_has_the_range_rates_of_both(void **state)
{
    const struct body_outline one = {.place_m = {63.0f, 80.0f},
                                     .velocity_mps = {3.0f, 4.0f},
                                     .cos_heading = 1.0f,
                                     .along_m2 = 1.0f,
                                     .across_m2 = 1.0f,
                                     .plots = 6.0f,
                                     .rates_m2ps2 = 0.04f};
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    assert_int_equal(rho_tracker_set_body_max(&tracker, 10.0f), RHO_OK);
    memset(&tracker.bodies.of[0], 0, 2 * sizeof *tracker.bodies.of);
    begin_look(0, 1.0f);
    at.look.sensor = &radar;
    for (int is_along = 0; is_along <= 1; is_along++) {
        struct body_outline other = one;
        other.plots = 2.0f;                              /* a quarter of all */
        other.velocity_mps[0] += is_along ? 0.6f : 0.8f; /* 1 m/s along the line, or across it */
        other.velocity_mps[1] += is_along ? 0.8f : -0.6f;
        const struct body_outline joint = rho_bodies_join_outlines(&at.look, 0, 1, &one, &other);
        expect_close(joint.rates_m2ps2, 0.04f + (is_along ? 0.25f * 0.75f : 0.0f), 1e-6f);
    }
}

/* The widest body: of its length, no less than half of the longest's; people are round. */
static void the_widest_body_follows_its_length(void **state)
{
    (void)state;
    expect_close(rho_bodies_widest_m(20.0f, 12.0f), 3.6f, 0.0f);
    expect_close(rho_bodies_widest_m(20.0f, 5.0f), 3.0f, 0.0f); /* as one of 10 m */
    expect_close(rho_bodies_widest_m(20.0f, 99.0f), 6.0f, 0.0f);
    expect_close(rho_bodies_widest_m(6.0f, 4.4f), 2.5f, 0.0f);
    expect_close(rho_bodies_widest_m(0.8f, 0.4f), 0.8f, 0.0f);
    begin_tracker();
    assert_int_equal(rho_tracker_set_body_max(&tracker, 20.0f), RHO_OK);
    /* an error of the heading shows length as width: two sigmas of it, at most the longest */
    tracker.bodies.of[0].heading_sigma_rad = 0.1f;
    expect_close(rho_bodies_width_most_m(&tracker, 0, 12.0f), 3.6f + 2.4f, 0.0f);
    tracker.bodies.of[0].heading_sigma_rad = 3.14f;
    expect_close(rho_bodies_width_most_m(&tracker, 0, 12.0f), 20.0f, 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plot_is_seen_as_the_measurement_has_it),
        cmocka_unit_test(range_rates_that_were_not_measured_are_none),
        cmocka_unit_test(limbs_spread_range_rates_up_to_twice_their_noise),
        cmocka_unit_test(one_body_for_two_has_the_range_rates_of_both),
        cmocka_unit_test(the_widest_body_follows_its_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
