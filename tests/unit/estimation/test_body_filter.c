/* SPDX-License-Identifier: MIT */
/* Extents from plots spread over a rectangle: without their noise, whatever the heading. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "draws.h"
#include "rhotrack/detail/body_filter.h"

/* n plots of a body of 12 by 3 m, each axis with so much noise. */
static struct rho_body_look look_of(unsigned n, double sigma_m)
{
    struct rho_body_look look = {.num_plots = n};
    for (unsigned i = 0; i < n; i++) {
        double along_m = uniform(-6.0, 6.0), across_m = uniform(-1.5, 1.5);
        along_m += sigma_m * normal();
        across_m += sigma_m * normal();
        look.along_m2 += (float)(along_m * along_m);
        look.across_m2 += (float)(across_m * across_m);
        look.noise_along_m2 += (float)(sigma_m * sigma_m);
        look.noise_across_m2 += (float)(sigma_m * sigma_m);
    }
    return look;
}

static void moves(struct rho_body_filter *body, float vx_mps, float vy_mps, float variance)
{
    rho_body_turn(body, (const float[2]){vx_mps, vy_mps}, (const float[3]){variance, 0, variance});
}

static void sides_without_noise(void **state)
{
    static const double sigmas_m[] = {0.01, 0.5, 1.0};
    (void)state;
    random_state = 3;
    for (int i = 0; i < 3; i++) {
        struct rho_body_filter body;
        struct rho_body shape;
        rho_body_start(&body, 7, 9.0f);
        moves(&body, 0.0f, 20.0f, 0.0f);
        for (int k = 0; k < 400; k++) {
            const struct rho_body_look look = look_of(1u + (unsigned)k % 5u, sigmas_m[i]);
            rho_body_add(&body, &look);
        }
        rho_body_shape(&body, &shape);
        assert_int_equal(body.track_id, 7);
        assert_true(rho_body_most_along_m2(&body) < 1.1f * body.along_m2);
        assert_true(fabs((double)shape.length_m - 12.0) < 0.8);
        assert_true(fabs((double)shape.width_m - 3.0) < 0.7);
        assert_true(fabs((double)shape.length_m - 12.0) < 3.0 * (double)shape.sigma_length_m);
        assert_true(fabs((double)shape.width_m - 3.0) < 3.0 * (double)shape.sigma_width_m);
        assert_true(shape.sigma_length_m < 2.0f && shape.sigma_width_m < 1.0f);
        assert_true(fabs((double)shape.heading_rad - 1.570796) < 1e-5);
        assert_true(shape.plots > 400.0f && shape.plots < 500.0f);
        assert_true(shape.sigma_along_m < 0.5f && shape.sigma_along_m > shape.sigma_across_m);
    }
}

/* Errors of the heading make a body look wider; that is expected. */
static void heading_errors_are_no_width(void **state)
{
    struct rho_body_filter body;
    struct rho_body shape;
    (void)state;
    random_state = 5;
    rho_body_start(&body, 1, 9.0f);
    for (int k = 0; k < 300; k++) {
        struct rho_body_look look = {.num_plots = 4};
        const double off_rad = 0.1 * normal();
        moves(&body, 10.0f, 0.0f, 1.43f); /* sigma 0.12 rad: conservative by a third, as expected */
        for (int i = 0; i < 4; i++) {
            const double along_m = uniform(-6.0, 6.0),
                         across_m = uniform(-1.0, 1.0) + off_rad * along_m;
            look.along_m2 += (float)(along_m * along_m);
            look.across_m2 += (float)(across_m * across_m);
        }
        rho_body_add(&body, &look);
    }
    rho_body_shape(&body, &shape);
    assert_true(fabs((double)shape.width_m - 2.0) < 0.25);
}

static void heading_comes_from_sure_velocities(void **state)
{
    struct rho_body_filter body;
    struct rho_body_look look = look_of(5, 0.1);
    (void)state;
    rho_body_start(&body, 1, 9.0f);
    moves(&body, 1.0f, 0.0f, 0.2f);
    assert_int_equal(body.has_heading, 0);
    rho_body_add(&body, &look);
    assert_true(body.along_m2 == 9.0f && body.most_plots == 5);
    /* as long as nothing is known, a gate counts on more */
    assert_true(rho_body_most_along_m2(&body) > 1.5f * 9.0f);
    moves(&body, 0.0f, 0.0f, 0.0f);
    assert_int_equal(body.has_heading, 0);
    moves(&body, 3.0f, 4.0f, 0.25f);
    assert_int_equal(body.has_heading, 1);
    assert_true(fabs((double)body.cos_heading - 0.6) < 1e-6 &&
                fabs((double)body.sin_heading - 0.8) < 1e-6 &&
                fabs((double)body.heading_sigma_rad - 0.1) < 1e-6);
    look.num_plots = 0;
    rho_body_add(&body, &look);
    assert_true(body.along_m2 == 9.0f);
}

static void axes_there_and_back(void **state)
{
    struct rho_body_filter body;
    float world[3], axes[3];
    (void)state;
    rho_body_start(&body, 1, 9.0f);
    moves(&body, 3.0f, 4.0f, 0.0f);
    body.along_m2 = 16.0f;
    body.across_m2 = 1.0f;
    rho_body_spread(&body, world);
    assert_true(fabs((double)world[0] - (0.36 * 16 + 0.64)) < 1e-5 &&
                fabs((double)world[1] - 0.48 * 15) < 1e-5 &&
                fabs((double)world[2] - (0.64 * 16 + 0.36)) < 1e-5);
    rho_body_to_axes(&body, world, axes);
    assert_true(fabs((double)axes[0] - 16) < 1e-5 && fabs((double)axes[1]) < 1e-5 &&
                fabs((double)axes[2] - 1) < 1e-5);
}

/* A body that seems to have no width, or less, is as slim as bodies are. */
static void width_has_a_floor(void **state)
{
    struct rho_body_filter body;
    struct rho_body shape;
    (void)state;
    rho_body_start(&body, 1, 9.0f);
    moves(&body, 10.0f, 0.0f, 0.0f);
    for (int k = 0; k < 50; k++) {
        const struct rho_body_look look = {.num_plots = 3,
                                           .along_m2 = 3.0f * 12.0f,
                                           .noise_along_m2 = 0.03f,
                                           .noise_across_m2 = 0.03f};
        rho_body_add(&body, &look);
    }
    rho_body_shape(&body, &shape);
    assert_true(fabs((double)(shape.length_m / shape.width_m) - 16.0) < 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sides_without_noise),
        cmocka_unit_test(heading_errors_are_no_width),
        cmocka_unit_test(heading_comes_from_sure_velocities),
        cmocka_unit_test(axes_there_and_back),
        cmocka_unit_test(width_has_a_floor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
