/* SPDX-License-Identifier: MIT */
/* Extents from plots spread over a rectangle: without their noise, whatever the heading. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "random_draws.h"
#include "rhotrack/detail/body_extent_filter.h"

/* n plots of a body of 12 by 3 m, each axis with so much noise. */
static void add_plot(struct rho_body_look *look, double along_m, double across_m, double sigma_m)
{
    look->num_plots++;
    look->along_m2 += (float)(along_m * along_m);
    look->across_m2 += (float)(across_m * across_m);
    look->cross_m2 += (float)(along_m * across_m);
    look->noise_along_m2 += (float)(sigma_m * sigma_m);
    look->noise_across_m2 += (float)(sigma_m * sigma_m);
}

static struct rho_body_look look_of(unsigned n, double sigma_m)
{
    struct rho_body_look look = {0};
    for (unsigned i = 0; i < n; i++) {
        double along_m = uniform(-6.0, 6.0), across_m = uniform(-1.5, 1.5);
        along_m += sigma_m * normal();
        across_m += sigma_m * normal();
        add_plot(&look, along_m, across_m, sigma_m);
    }
    return look;
}

static void moves(struct rho_body_filter *body, float vx_mps, float vy_mps, float variance)
{
    rho_body_set_heading_if_moving(body, (const float[2]){vx_mps, vy_mps},
                                   (const float[3]){variance, 0, variance});
}

static void sides_without_noise(void **state)
{
    static const double sigmas_m[] = {0.01, 0.5, 1.0};
    (void)state;
    random_state = 3;
    for (int i = 0; i < 3; i++) {
        struct rho_body_filter body;
        struct rho_body shape;
        rho_body_filter_init(&body, 7, 9.0f);
        moves(&body, 0.0f, 20.0f, 0.0f);
        for (int k = 0; k < 400; k++) {
            const struct rho_body_look look = look_of(1u + (unsigned)k % 5u, sigmas_m[i]);
            rho_body_add_plots(&body, &look);
        }
        rho_body_shape(&body, &shape);
        assert_int_equal(body.track_id, 7);
        assert_true(rho_body_along_bound_m2(&body) < 1.1f * body.along_m2);
        assert_true(fabs((double)shape.length_m - 12.0) < 0.8);
        assert_true(fabs((double)shape.width_m - 3.0) < 0.7);
        assert_true(fabs((double)shape.length_m - 12.0) < 3.0 * (double)shape.sigma_length_m);
        assert_true(fabs((double)shape.width_m - 3.0) < 3.0 * (double)shape.sigma_width_m);
        assert_true(shape.sigma_length_m < 2.0f && shape.sigma_width_m < 1.0f);
        assert_true(fabs((double)shape.heading_rad - 1.570796) < 1e-5);
        assert_true(shape.plots == 500.0f);
        assert_true(shape.sigma_along_m < 0.5f && shape.sigma_along_m > shape.sigma_across_m);
    }
}

/* n scatterers of a body of 12 by 2 m, each seen .7 of the time, at a heading that is off. */
static struct rho_body_look look_at(const double (*places_m)[2], unsigned n, double off_rad,
                                    double sigma_m)
{
    struct rho_body_look look = {0};
    for (unsigned i = 0; i < n; i++) {
        const double along_m = places_m[i][0] + sigma_m * normal(),
                     across_m = places_m[i][1] + off_rad * along_m + sigma_m * normal();
        if (uniform(0.0, 1.0) < 0.7) {
            add_plot(&look, along_m, across_m, sigma_m);
        }
    }
    return look;
}

/* Parts of both sides, each with one scatterer anywhere in it; their mean is the track's place. */
static void place(double (*places_m)[2], unsigned n)
{
    double mean_m[2] = {0.0, 0.0};
    unsigned side[16];
    for (unsigned i = 0; i < n; i++) {
        const unsigned other = (unsigned)uniform(0.0, i + 0.999);
        side[i] = i;
        side[i] = side[other];
        side[other] = i;
    }
    for (unsigned i = 0; i < n; i++) {
        places_m[i][0] = 12.0 * ((i + uniform(0.0, 1.0)) / n - 0.5);
        places_m[i][1] = 2.0 * ((side[i] + uniform(0.0, 1.0)) / n - 0.5);
        mean_m[0] += places_m[i][0] / n;
        mean_m[1] += places_m[i][1] / n;
    }
    for (unsigned i = 0; i < n; i++) {
        places_m[i][0] -= mean_m[0];
        places_m[i][1] -= mean_m[1];
    }
}

/*
 * Errors of the heading, ten looks each, make a body look wider. By how far its plots seem turned
 * they are told from the width. Errors are as large as the sigmas say, for any number of
 * scatterers: mean squares over 100 bodies, which scatter by .15 or so.
 */
static void sides_are_off_by_their_sigmas(void **state)
{
    static const unsigned counts[] = {3, 5, 10};
    (void)state;
    random_state = 5;
    for (int c = 0; c < 3; c++) {
        double length = 0.0, width = 0.0, mean_m = 0.0;
        for (int run = 0; run < 100; run++) {
            struct rho_body_filter body;
            struct rho_body shape;
            double places_m[16][2], off_rad = 0.0;
            place(places_m, counts[c]);
            rho_body_filter_init(&body, 1, 9.0f);
            for (int k = 0; k < 200; k++) {
                off_rad = k % 10 ? off_rad : 0.1 * normal();
                /* velocities are better than they are said to be: sigma .18 rad */
                moves(&body, 10.0f, 0.0f, 3.3f);
                const struct rho_body_look look =
                    look_at((const double(*)[2])places_m, counts[c], off_rad, 0.3);
                rho_body_add_plots(&body, &look);
            }
            rho_body_shape(&body, &shape);
            length += pow((double)((shape.length_m - 12.0f) / shape.sigma_length_m), 2.0) / 100.0;
            width += pow((double)((shape.width_m - 2.0f) / shape.sigma_width_m), 2.0) / 100.0;
            mean_m += (double)shape.width_m / 100.0;
        }
        print_message("%u: %.2f %.2f, %.2f m\n", counts[c], length, width, mean_m);
        assert_true(length > 0.4 && length < 1.8);
        assert_true(width > 0.4 && width < 1.8);
        assert_true(fabs(mean_m - 2.0) < 0.3);
    }
}

/*
 * One look that a neighbour's plot strays into: not a wide body for the rest of the track's life.
 */
static void a_stray_plot_is_no_width(void **state)
{
    struct rho_body_filter body;
    struct rho_body shape;
    (void)state;
    random_state = 7;
    rho_body_filter_init(&body, 1, 9.0f);
    moves(&body, 10.0f, 0.0f, 0.0f);
    for (int k = 0; k < 40; k++) {
        struct rho_body_look look = look_of(3, 0.1);
        look.across_m2 += k == 0 ? 150.0f : 0.0f;
        rho_body_add_plots(&body, &look);
    }
    rho_body_shape(&body, &shape);
    assert_true(shape.width_m < 4.0f);
}

/* All are seen: their mean is known. Of several one is missed, or all but one. */
static void those_missed_move_the_mean(void **state)
{
    struct rho_body_filter body;
    (void)state;
    rho_body_filter_init(&body, 1, 9.0f);
    assert_true(rho_body_mean_variance_share(&body, 1) == 1.0f);
    body.most_plots = 5;
    assert_true(rho_body_mean_variance_share(&body, 1) == 1.0f);
    assert_true(rho_body_mean_variance_share(&body, 5) < 0.05f);
    assert_true(rho_body_mean_variance_share(&body, 8) < 0.05f);
    assert_true(fabs((double)rho_body_mean_variance_share(&body, 4) - 0.25) < 0.05);
    assert_true(fabs((double)rho_body_mean_variance_share(&body, 2) - 0.75) < 0.05);
}

static void heading_comes_from_sure_velocities(void **state)
{
    struct rho_body_filter body;
    struct rho_body_look look = look_of(5, 0.1);
    (void)state;
    rho_body_filter_init(&body, 1, 9.0f);
    moves(&body, 1.0f, 0.0f, 0.2f);
    assert_int_equal(body.has_heading, 0);
    rho_body_add_plots(&body, &look);
    assert_true(body.along_m2 == 9.0f && body.most_plots == 5);
    /* as long as nothing is known, a gate counts on more */
    assert_true(rho_body_along_bound_m2(&body) > 1.5f * 9.0f);
    moves(&body, 0.0f, 0.0f, 0.0f);
    assert_int_equal(body.has_heading, 0);
    moves(&body, 3.0f, 4.0f, 0.25f);
    assert_int_equal(body.has_heading, 1);
    assert_true(fabs((double)body.cos_heading - 0.6) < 1e-6 &&
                fabs((double)body.sin_heading - 0.8) < 1e-6 &&
                fabs((double)body.heading_sigma_rad - 0.1) < 1e-6);
    look.num_plots = 0;
    rho_body_add_plots(&body, &look);
    assert_true(body.along_m2 == 9.0f);
}

static void axes_there_and_back(void **state)
{
    struct rho_body_filter body;
    float world[3], axes[3];
    (void)state;
    rho_body_filter_init(&body, 1, 9.0f);
    moves(&body, 3.0f, 4.0f, 0.0f);
    body.along_m2 = 16.0f;
    body.across_m2 = 1.0f;
    rho_body_place_covariance(&body, world);
    assert_true(fabs((double)world[0] - (0.36 * 16 + 0.64)) < 1e-5 &&
                fabs((double)world[1] - 0.48 * 15) < 1e-5 &&
                fabs((double)world[2] - (0.64 * 16 + 0.36)) < 1e-5);
    rho_body_rotate_covariance(&body, world, axes);
    assert_true(fabs((double)axes[0] - 16) < 1e-5 && fabs((double)axes[1]) < 1e-5 &&
                fabs((double)axes[2] - 1) < 1e-5);
}

/* A body that seems to have no width, or less, is as slim as bodies are. */
static void width_has_a_floor(void **state)
{
    struct rho_body_filter body;
    struct rho_body shape;
    (void)state;
    rho_body_filter_init(&body, 1, 9.0f);
    moves(&body, 10.0f, 0.0f, 0.0f);
    for (int k = 0; k < 50; k++) {
        const struct rho_body_look look = {.num_plots = 3,
                                           .along_m2 = 3.0f * 12.0f,
                                           .noise_along_m2 = 0.03f,
                                           .noise_across_m2 = 0.03f};
        rho_body_add_plots(&body, &look);
    }
    rho_body_shape(&body, &shape);
    assert_true(fabs((double)(shape.length_m / shape.width_m) - 16.0) < 1e-3);
}

/* ---- figures --------------------------------------------------------------------------------- */

static void expect_close(double is, double wanted)
{
    assert_true(fabs(is - wanted) <= 2e-5 * fabs(wanted));
}

static void a_heading_takes_a_speed_of_three_sigmas(void **state)
{
    struct rho_body_filter body;
    (void)state;
    rho_body_filter_init(&body, 1, 9.0f);
    moves(&body, 2.9f, 0.0f, 1.0f);
    assert_int_equal(body.has_heading, 0);
    moves(&body, 3.1f, 0.0f, 1.0f);
    assert_int_equal(body.has_heading, 1);
}

/*
 * Before and after the first heading: as long as it is thought plus what 20 weights leave open, and
 * a third as wide.
 */
static void what_a_new_body_is_taken_for(void **state)
{
    struct rho_body_filter body;
    float world[3];
    (void)state;
    rho_body_filter_init(&body, 1, 9.0f);
    expect_close((double)rho_body_along_bound_m2(&body), 9.0 + 9.0 * 20.0 / 20.3);
    moves(&body, 10.0f, 0.0f, 0.0f);
    rho_body_place_covariance(&body, world);
    expect_close((double)world[0], 9.0);
    expect_close((double)world[2], 9.0 / 9.0);
}

/* Both axes by the head of body_extent_filter.c, in double precision. */
struct axis {
    double mean_m2, weight, variance_m4, prior_share;
};
struct reference {
    struct axis along, across;
    double along_m2, across_m2, slope, slope_weight, plots, most;
};

static const double prior_m2 = 9.0, turned = 0.3 * 0.12 * 0.12; /* heading of .12 rad */

static double squares_of(double v_m2, double own_m2)
{
    return pow(own_m2 / v_m2 + 1.0, 2.0) - 1.0 + 0.2;
}

static void learn(struct axis *axis, double usual_m2, double seen_m2, double own_m2, double n)
{
    const double more = n / squares_of(usual_m2, own_m2), v_m2 = fmax(axis->mean_m2, 1e-3);
    axis->weight = fmax(1.0 - more / 2500.0, 0.0) * axis->weight + more;
    const double gain = more / axis->weight;
    axis->mean_m2 += gain * (seen_m2 - axis->mean_m2);
    axis->variance_m4 = pow(1.0 - gain, 2.0) * axis->variance_m4 +
                        pow(gain * v_m2, 2.0) * 2.0 / n * squares_of(v_m2, own_m2);
    axis->prior_share *= 1.0 - gain;
}

static double usual_along_m2(const struct reference *body)
{
    return fmax(body->along_m2, prior_m2 / 16.0);
}

static void learn_across(struct reference *body, const struct rho_body_look *look, double missed)
{
    const double n = look->num_plots, noise_m2 = (double)look->noise_across_m2 / n;
    const double usual_m2 = usual_along_m2(body) / 16.0;
    const double along_m2 = fmax((double)look->along_m2, n * 1e-3);
    const double slope_variance = (noise_m2 + missed * usual_m2) / along_m2;
    const double k = turned / (turned + slope_variance), gone = 1.0 - pow(1.0 - k, 2.0);
    const double off = (double)look->cross_m2 / along_m2 - body->slope;
    const double left_m2 = pow(1.0 - k, 2.0) * turned * body->along_m2, own_m2 = noise_m2 + left_m2;
    const double squares_m2 = (double)look->across_m2 - 2.0 * k * off * (double)look->cross_m2 +
                              k * k * along_m2 * (off * off + 1.0 / body->slope_weight);
    const double most_m2 = (n + 12.0) * (fmax(usual_m2, body->across_m2) + own_m2);
    if (n - gone > 0.1) {
        learn(&body->across, usual_m2,
              (fmin(squares_m2, most_m2) - (n - gone) * noise_m2) / (n - missed * gone) - left_m2,
              own_m2, n - gone);
    }
    const double more = 1.0 / (slope_variance + 10.0 * turned);
    body->slope_weight = fmax(1.0 - n / 500.0, 0.0) * body->slope_weight + more;
    body->slope += more / body->slope_weight * off;
}

static void add(struct reference *body, const struct rho_body_look *look)
{
    const double n = look->num_plots;
    body->most = fmax(body->most, n);
    const double missed =
        n > 1.0 ? (body->most - n) / (body->most - 1.0) + 0.5 / pow(body->most, 2.0) : 1.0;
    const double own_m2 = (double)look->noise_along_m2 / n + turned * body->across_m2;
    learn(&body->along, usual_along_m2(body), (double)look->along_m2 / n - own_m2, own_m2, n);
    body->along_m2 = fmax(body->along.mean_m2, 1e-3);
    learn_across(body, look, missed);
    body->across_m2 = fmax(body->across.mean_m2, body->along_m2 / 256.0);
    body->plots = fmin(body->plots + n, 500.0);
}

/* The sigma of a side, by what plots, scatterers that stay and the heading leave of it. */
static double sigma_of_side(const struct axis *axis, double spread_m2, double turned_m2,
                            double most)
{
    const double length_m = sqrt(12.0 * spread_m2), told = 1.0 - axis->prior_share;
    const double stays_m =
        told * length_m / pow(most, 1.5) * (1.0 + told * told * 8.4 / pow(most, 3.0));
    return sqrt(stays_m * stays_m +
                pow(6.0 / length_m, 2.0) * (axis->variance_m4 + turned_m2 * turned_m2));
}

/*
 * Looks of few plots and of many, seen from a body that is turned, with a stray plot, of less
 * spread than their noise, and of noise alone.
 */
static void every_look_as_derived(void **state)
{
    static const struct rho_body_look looks[] = {
        {2, 30.0f, 3.0f, 4.0f, 0.5f, 0.4f},          {5, 80.0f, 2.0f, 3.0f, 1.0f, 0.8f},
        {1, 4.0f, 0.02f, 0.1f, 0.3f, 0.2f},          {1, 9.0f, 0.5f, 2.0f, 1e-4f, 1e-6f},
        {3, 50.0f, 150.0f, 60.0f, 0.5f, 0.4f},       {4, 50.0f, 3.0f, -9.0f, 0.9f, 0.7f},
        {300, 3500.0f, 250.0f, 99.0f, 90.0f, 60.0f}, {400, 4000.0f, 300.0f, 0.0f, 1e3f, 1e3f},
        {8, 1.0f, 0.1f, 0.1f, 900.0f, 90.0f},        {600, 1.0f, 1.0f, 0.2f, 600.0f, 600.0f},
        {9000, 1.0f, 1.0f, 0.0f, 9e3f, 9e3f},        {600, 1.0f, 1.0f, 0.0f, 6e7f, 6e7f},
    };
    const double width_m2 = prior_m2 / 9.0;
    struct reference reference = {
        .along = {prior_m2, 0.3, 2.0 * prior_m2 * prior_m2 / 0.3, 1.0},
        .across = {width_m2, 6.0, 2.0 * width_m2 * width_m2 / 6.0, 1.0},
        .along_m2 = prior_m2,
        .across_m2 = width_m2,
        .slope_weight = 144.0,
        .plots = 1.0,
    };
    struct rho_body_filter body;
    struct rho_body shape;
    (void)state;
    rho_body_filter_init(&body, 1, (float)prior_m2);
    moves(&body, 10.0f, 0.0f, 1.44f);
    for (size_t i = 0; i < sizeof looks / sizeof looks[0]; i++) {
        rho_body_add_plots(&body, &looks[i]);
        add(&reference, &looks[i]);
        rho_body_shape(&body, &shape);
        const double off_m2 = fmin(turned, 1.0 / reference.slope_weight),
                     off = sqrt(off_m2 * (off_m2 + 4.0 * pow(reference.slope, 2.0)));
        expect_close((double)shape.length_m, sqrt(12.0 * reference.along_m2));
        expect_close((double)shape.width_m, sqrt(12.0 * reference.across_m2));
        expect_close((double)shape.plots, reference.plots);
        expect_close((double)rho_body_along_bound_m2(&body),
                     reference.along_m2 + prior_m2 * 20.0 / (20.0 + reference.along.weight));
        expect_close((double)shape.sigma_length_m,
                     sigma_of_side(&reference.along, reference.along_m2,
                                   off_m2 * reference.across_m2, reference.most));
        expect_close((double)shape.sigma_width_m,
                     sigma_of_side(&reference.across, reference.across_m2, off * reference.along_m2,
                                   reference.most));
    }
    expect_close(reference.along_m2, 1e-3);
}

/*
 * A plot alone, at this place along a body of 3.5 m whose heading is known to .3 rad: the farther
 * out it is, the more of it tells the turn. The width is learned where a tenth of it is left.
 */
static int learns_width(double along_m)
{
    struct rho_body_filter body;
    struct rho_body_look look = {0};
    rho_body_filter_init(&body, 1, 1.0f);
    moves(&body, 10.0f, 0.0f, 9.0f);
    body.along.weight = 2000.0f;
    const float before = body.across.weight;
    add_plot(&look, along_m, 0.0, 0.0);
    rho_body_add_plots(&body, &look);
    return body.across.weight > before;
}

static void a_plot_that_tells_little_but_the_turn_tells_no_width(void **state)
{
    (void)state;
    assert_true(learns_width(1.97));  /* .14 of a plot */
    assert_false(learns_width(2.53)); /* .07 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sides_without_noise),
        cmocka_unit_test(sides_are_off_by_their_sigmas),
        cmocka_unit_test(a_stray_plot_is_no_width),
        cmocka_unit_test(those_missed_move_the_mean),
        cmocka_unit_test(heading_comes_from_sure_velocities),
        cmocka_unit_test(axes_there_and_back),
        cmocka_unit_test(width_has_a_floor),
        cmocka_unit_test(a_heading_takes_a_speed_of_three_sigmas),
        cmocka_unit_test(what_a_new_body_is_taken_for),
        cmocka_unit_test(every_look_as_derived),
        cmocka_unit_test(a_plot_that_tells_little_but_the_turn_tells_no_width),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
