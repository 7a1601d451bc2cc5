/* SPDX-License-Identifier: MIT */
/*
 * Length and width of bodies from plots spread over a rectangle: plot noise removed, any heading.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "random_draws.h"
#include "rhotrack/detail/body_extent_filter.h"

#define ASPECT 3.0 /* length over width */

/* Adds a plot in body axes with the same noise along and across. */
static void add_plot_to_look(struct rho_body_look *look, double along_m, double across_m,
                             double sigma_m)
{
    look->num_plots++;
    look->along_m2 += (float)(along_m * along_m);
    look->across_m2 += (float)(across_m * across_m);
    look->cross_m2 += (float)(along_m * across_m);
    look->noise_along_m2 += (float)(sigma_m * sigma_m);
    look->noise_across_m2 += (float)(sigma_m * sigma_m);
}

static struct rho_body_look random_look(unsigned n, double sigma_m)
{
    struct rho_body_look look = {0};
    for (unsigned i = 0; i < n; i++) {
        double along_m = uniform(-6.0, 6.0), across_m = uniform(-1.5, 1.5);
        along_m += sigma_m * normal();
        across_m += sigma_m * normal();
        add_plot_to_look(&look, along_m, across_m, sigma_m);
    }
    return look;
}

static void set_velocity(struct rho_body_filter *body, float vx_mps, float vy_mps, float variance)
{
    rho_body_set_heading_if_moving(body, (const float[2]){vx_mps, vy_mps},
                                   (const float[3]){variance, 0, variance});
}

static void length_and_width_are_estimated_without_the_plots_noise(void **state)
{
    static const double sigmas_m[] = {0.01, 0.5, 1.0};
    (void)state;
    random_state = 3;
    for (int i = 0; i < 3; i++) {
        struct rho_body_filter body;
        struct rho_body shape;
        rho_body_filter_init(&body, 7, 9.0f, (float)ASPECT);
        set_velocity(&body, 0.0f, 20.0f, 0.0f);
        for (int k = 0; k < 400; k++) {
            const struct rho_body_look look = random_look(1u + (unsigned)k % 5u, sigmas_m[i]);
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

/*
 * Plots of scatterers, each seen with probability 0.7, of a body whose heading is off by off_rad.
 */
static struct rho_body_look look_of_scatterers(const double (*places_m)[2], unsigned n,
                                               double off_rad, double sigma_m)
{
    struct rho_body_look look = {0};
    for (unsigned i = 0; i < n; i++) {
        const double along_m = places_m[i][0] + sigma_m * normal(),
                     across_m = places_m[i][1] + off_rad * along_m + sigma_m * normal();
        if (uniform(0.0, 1.0) < 0.7) {
            add_plot_to_look(&look, along_m, across_m, sigma_m);
        }
    }
    return look;
}

/*
 * Draws one scatterer in each of n parts of a body of 12 by 2 m; their mean, the track's place, is
 * 0.
 */
static void draw_scatterers(double (*places_m)[2], unsigned n)
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
 * The heading's error stays for ten looks and makes a body look wider; the slope of its plots tells
 * it from the width. For any number of scatterers the mean squared error over 100 bodies must be
 * about sigma^2; its standard deviation is some 0.15.
 */
static void errors_of_length_and_width_agree_with_their_sigmas(void **state)
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
            draw_scatterers(places_m, counts[c]);
            rho_body_filter_init(&body, 1, 9.0f, (float)ASPECT);
            for (int k = 0; k < 200; k++) {
                off_rad = k % 10 ? off_rad : 0.1 * normal();
                /* sigma 0.18 rad, though the heading's error is 0.1 rad */
                set_velocity(&body, 10.0f, 0.0f, 3.3f);
                const struct rho_body_look look =
                    look_of_scatterers((const double(*)[2])places_m, counts[c], off_rad, 0.3);
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

/* A neighbour's plot in the first look: the width must recover. */
static void one_stray_plot_does_not_widen_a_body_for_long(void **state)
{
    struct rho_body_filter body;
    struct rho_body shape;
    (void)state;
    random_state = 7;
    rho_body_filter_init(&body, 1, 9.0f, (float)ASPECT);
    set_velocity(&body, 10.0f, 0.0f, 0.0f);
    for (int k = 0; k < 40; k++) {
        struct rho_body_look look = random_look(3, 0.1);
        look.across_m2 += k == 0 ? 150.0f : 0.0f;
        rho_body_add_plots(&body, &look);
    }
    rho_body_shape(&body, &shape);
    assert_true(shape.width_m < 4.0f);
}

/*
 * Two people abreast: the body of both is three times as wide as that of one. Held to 12 squares
 * more than of the old width, 30 plots a look did not show it for seconds.
 */
static void many_plots_show_within_half_a_second_that_a_body_is_wider(void **state)
{
    struct rho_body_filter body;
    struct rho_body shape;
    (void)state;
    random_state = 8;
    rho_body_filter_init(&body, 1, 0.0133f, 1.0f);
    set_velocity(&body, 1.0f, 0.0f, 0.0f);
    for (int k = 0; k < 5; k++) {
        struct rho_body_look look = {0};
        for (int i = 0; i < 30; i++) {
            const double aside_m = i % 2 ? 0.3 : -0.3;
            add_plot_to_look(&look, uniform(-0.2, 0.2) + 0.15 * normal(),
                             aside_m + uniform(-0.2, 0.2) + 0.15 * normal(), 0.15);
        }
        rho_body_add_plots(&body, &look);
    }
    rho_body_shape(&body, &shape);
    assert_true(shape.width_m > 0.9f && shape.width_m < 1.3f);
}

/*
 * If all scatterers are seen the mean is known; the variance rises with the share that is missed.
 */
static void the_variance_of_the_mean_follows_the_share_of_missed_scatterers(void **state)
{
    struct rho_body_filter body;
    (void)state;
    rho_body_filter_init(&body, 1, 9.0f, (float)ASPECT);
    assert_true(rho_body_mean_variance_share(&body, 1) == 1.0f);
    body.most_plots = 5;
    assert_true(rho_body_mean_variance_share(&body, 1) == 1.0f);
    assert_true(rho_body_mean_variance_share(&body, 5) < 0.05f);
    assert_true(rho_body_mean_variance_share(&body, 8) < 0.05f);
    assert_true(fabs((double)rho_body_mean_variance_share(&body, 4) - 0.25) < 0.05);
    assert_true(fabs((double)rho_body_mean_variance_share(&body, 2) - 0.75) < 0.05);
}

static void the_heading_follows_velocities_that_are_well_known(void **state)
{
    struct rho_body_filter body;
    struct rho_body_look look = random_look(5, 0.1);
    (void)state;
    rho_body_filter_init(&body, 1, 9.0f, (float)ASPECT);
    set_velocity(&body, 1.0f, 0.0f, 0.2f);
    assert_int_equal(body.has_heading, 0);
    rho_body_add_plots(&body, &look);
    assert_true(body.along_m2 == 9.0f && body.most_plots == 5);
    /* the bound for gates is larger while the length is unknown */
    assert_true(rho_body_along_bound_m2(&body) > 1.5f * 9.0f);
    set_velocity(&body, 0.0f, 0.0f, 0.0f);
    assert_int_equal(body.has_heading, 0);
    set_velocity(&body, 3.0f, 4.0f, 0.25f);
    assert_int_equal(body.has_heading, 1);
    assert_true(fabs((double)body.cos_heading - 0.6) < 1e-6 &&
                fabs((double)body.sin_heading - 0.8) < 1e-6 &&
                fabs((double)body.heading_sigma_rad - 0.1) < 1e-6);
    look.num_plots = 0;
    rho_body_add_plots(&body, &look);
    assert_true(body.along_m2 == 9.0f);
}

static void rotating_a_covariance_to_body_axes_and_back_restores_it(void **state)
{
    struct rho_body_filter body;
    float world[3], axes[3];
    (void)state;
    rho_body_filter_init(&body, 1, 9.0f, (float)ASPECT);
    set_velocity(&body, 3.0f, 4.0f, 0.0f);
    body.along_m2 = 16.0f;
    body.across_m2 = 1.0f;
    rho_body_place_covariance(&body, world);
    assert_true(fabs((double)world[0] - (0.36 * 16 + 0.64)) < 1e-5 &&
                fabs((double)world[1] - 0.48 * 15) < 1e-5 &&
                fabs((double)world[2] - (0.64 * 16 + 0.36)) < 1e-5);
    rho_body_rotate_covariance(body.cos_heading, body.sin_heading, world, axes);
    assert_true(fabs((double)axes[0] - 16) < 1e-5 && fabs((double)axes[1]) < 1e-5 &&
                fabs((double)axes[2] - 1) < 1e-5);
}

/* Plots without any spread across, or less than their noise: the width is the smallest allowed. */
static void the_width_is_at_least_a_sixteenth_of_the_length(void **state)
{
    struct rho_body_filter body;
    struct rho_body shape;
    (void)state;
    rho_body_filter_init(&body, 1, 9.0f, (float)ASPECT);
    set_velocity(&body, 10.0f, 0.0f, 0.0f);
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

/* ---- constants and formulas ----------------------------------------------------------------- */

static void expect_close(double is, double wanted)
{
    assert_true(fabs(is - wanted) <= 2e-5 * fabs(wanted));
}

static void a_heading_needs_a_speed_of_four_sigmas(void **state)
{
    struct rho_body_filter body;
    (void)state;
    rho_body_filter_init(&body, 1, 9.0f, (float)ASPECT);
    set_velocity(&body, 3.9f, 0.0f, 1.0f);
    assert_int_equal(body.has_heading, 0);
    set_velocity(&body, 4.1f, 0.0f, 1.0f);
    assert_int_equal(body.has_heading, 1);
}

/* Of one who stops, the velocity across the line of sight is noise of an uncertain axis. */
static void noise_of_one_who_stops_turns_no_body(void **state)
{
    struct rho_body_filter body;
    const float stopped_mps[2] = {0.0f, 3.5f}, covariance[3] = {0.01f, 0.0f, 1.0f};
    (void)state;
    rho_body_filter_init(&body, 1, 9.0f, (float)ASPECT);
    set_velocity(&body, 10.0f, 0.0f, 1.0f);
    rho_body_set_heading_if_moving(&body, stopped_mps, covariance);
    assert_true(body.cos_heading == 1.0f);
}

/*
 * The bound along is the prior variance plus its uncertainty at a weight of 20; after the first
 * heading the width is a third of the length.
 */
static void a_new_body_has_the_prior_length_and_a_third_of_it_as_width(void **state)
{
    struct rho_body_filter body;
    float world[3];
    (void)state;
    rho_body_filter_init(&body, 1, 9.0f, (float)ASPECT);
    expect_close((double)rho_body_along_bound_m2(&body), 9.0 + 9.0 * 20.0 / 20.3);
    set_velocity(&body, 10.0f, 0.0f, 0.0f);
    rho_body_place_covariance(&body, world);
    expect_close((double)world[0], 9.0);
    expect_close((double)world[2], 9.0 / 9.0);
}

/* The filter by the formulas at the head of body_extent_filter.c, in double precision. */
struct axis {
    double mean_m2, weight, variance_m4, prior_share;
};
struct reference {
    struct axis along, across;
    double along_m2, across_m2, slope, slope_weight, plots, most;
};

static const double prior_m2 = 9.0, turned = 0.3 * 0.12 * 0.12; /* heading sigma of 0.12 rad */

static double variance_factor(double v_m2, double own_m2)
{
    return pow(own_m2 / v_m2 + 1.0, 2.0) - 1.0 + 0.2;
}

static void update_axis(struct axis *axis, double usual_m2, double seen_m2, double own_m2, double n)
{
    const double more = n / variance_factor(usual_m2, own_m2), v_m2 = fmax(axis->mean_m2, 1e-3);
    axis->weight = fmax(1.0 - more / 2500.0, 0.0) * axis->weight + more;
    const double gain = more / axis->weight;
    axis->mean_m2 += gain * (seen_m2 - axis->mean_m2);
    axis->variance_m4 = pow(1.0 - gain, 2.0) * axis->variance_m4 +
                        pow(gain * v_m2, 2.0) * 2.0 / n * variance_factor(v_m2, own_m2);
    axis->prior_share *= 1.0 - gain;
}

static double length_variance_for_weights_m2(const struct reference *body)
{
    return fmax(body->along_m2, prior_m2 / 16.0);
}

static void update_width(struct reference *body, const struct rho_body_look *look, double missed)
{
    const double n = look->num_plots, noise_m2 = (double)look->noise_across_m2 / n;
    const double usual_m2 = length_variance_for_weights_m2(body) / (ASPECT * ASPECT);
    const double along_m2 = fmax((double)look->along_m2, n * 1e-3);
    const double slope_variance = (noise_m2 + missed * usual_m2) / along_m2;
    const double k = turned / (turned + slope_variance), gone = 1.0 - pow(1.0 - k, 2.0);
    const double off = (double)look->cross_m2 / along_m2 - body->slope;
    const double left_m2 = pow(1.0 - k, 2.0) * turned * body->along_m2, own_m2 = noise_m2 + left_m2;
    const double squares_m2 = (double)look->across_m2 - 2.0 * k * off * (double)look->cross_m2 +
                              k * k * along_m2 * (off * off + 1.0 / body->slope_weight);
    const double most_m2 = (n + fmax(12.0, 3.0 * n)) * (fmax(usual_m2, body->across_m2) + own_m2);
    if (n - gone > 0.1) {
        update_axis(&body->across, usual_m2,
                    (fmin(squares_m2, most_m2) - (n - gone) * noise_m2) / (n - missed * gone) -
                        left_m2,
                    own_m2, n - gone);
    }
    const double more = 1.0 / (slope_variance + 10.0 * turned);
    body->slope_weight = fmax(1.0 - n / 500.0, 0.0) * body->slope_weight + more;
    body->slope += more / body->slope_weight * off;
}

static void update_reference(struct reference *body, const struct rho_body_look *look)
{
    const double n = look->num_plots;
    body->most = fmax(body->most, n);
    const double missed =
        n > 1.0 ? (body->most - n) / (body->most - 1.0) + 0.5 / pow(body->most, 2.0) : 1.0;
    const double own_m2 = (double)look->noise_along_m2 / n + turned * body->across_m2;
    update_axis(&body->along, length_variance_for_weights_m2(body),
                (double)look->along_m2 / n - own_m2, own_m2, n);
    body->along_m2 = fmax(body->along.mean_m2, 1e-3);
    update_width(body, look, missed);
    body->across_m2 = fmax(body->across.mean_m2, body->along_m2 / 256.0);
    body->plots = fmin(body->plots + n, 500.0);
}

/*
 * Sigma of a side from the number of plots, scatterers that stay in place, and the heading's error.
 */
static double expected_sigma_of_side(const struct axis *axis, double spread_m2, double turned_m2,
                                     double most_plots)
{
    const double length_m = sqrt(12.0 * spread_m2), told = 1.0 - axis->prior_share;
    const double stays_m =
        told * length_m / pow(most_plots, 1.5) * (1.0 + told * told * 8.4 / pow(most_plots, 3.0));
    return sqrt(stays_m * stays_m +
                pow(6.0 / length_m, 2.0) * (axis->variance_m4 + turned_m2 * turned_m2));
}

/*
 * Looks with few and many plots, rotated ones, one with a stray plot, some with less spread than
 * noise, and with noise alone.
 */
static void every_update_agrees_with_the_derivation(void **state)
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
    rho_body_filter_init(&body, 1, (float)prior_m2, (float)ASPECT);
    set_velocity(&body, 10.0f, 0.0f, 1.44f);
    for (size_t i = 0; i < sizeof looks / sizeof looks[0]; i++) {
        rho_body_add_plots(&body, &looks[i]);
        update_reference(&reference, &looks[i]);
        rho_body_shape(&body, &shape);
        const double off_m2 = fmin(turned, 1.0 / reference.slope_weight),
                     off = sqrt(off_m2 * (off_m2 + 4.0 * pow(reference.slope, 2.0)));
        expect_close((double)shape.length_m, sqrt(12.0 * reference.along_m2));
        expect_close((double)shape.width_m, sqrt(12.0 * reference.across_m2));
        expect_close((double)shape.plots, reference.plots);
        expect_close((double)rho_body_along_bound_m2(&body),
                     reference.along_m2 + prior_m2 * 20.0 / (20.0 + reference.along.weight));
        expect_close((double)shape.sigma_length_m,
                     expected_sigma_of_side(&reference.along, reference.along_m2,
                                            off_m2 * reference.across_m2, reference.most));
        expect_close((double)shape.sigma_width_m,
                     expected_sigma_of_side(&reference.across, reference.across_m2,
                                            off * reference.along_m2, reference.most));
    }
    expect_close(reference.along_m2, 1e-3);
}

/*
 * Adds one plot at along_m to a body of 3.5 m with a heading sigma of 0.3 rad. The farther out a
 * plot is, the more its offset across is due to the heading; the width is updated if a tenth of it
 * is left.
 */
static int does_plot_update_width(double along_m)
{
    struct rho_body_filter body;
    struct rho_body_look look = {0};
    rho_body_filter_init(&body, 1, 1.0f, (float)ASPECT);
    set_velocity(&body, 10.0f, 0.0f, 0.0f);
    body.heading_sigma_rad = 0.3f;
    body.along.weight = 2000.0f;
    const float before = body.across.weight;
    add_plot_to_look(&look, along_m, 0.0, 0.0);
    rho_body_add_plots(&body, &look);
    return body.across.weight > before;
}

static void a_plot_far_out_along_the_body_does_not_update_the_width(void **state)
{
    (void)state;
    assert_true(does_plot_update_width(2.63));  /* 0.14 of the plot is left */
    assert_false(does_plot_update_width(3.37)); /* 0.07 is left */
}

/* A heading that is known from elsewhere: the first one tells width from length, later ones not. */
static void a_heading_may_be_set(void **state)
{
    struct rho_body_filter body;
    (void)state;
    rho_body_filter_init(&body, 1, 4.0f, 2.0f);
    assert_false(body.has_heading);
    rho_body_set_heading(&body, 0.6f, 0.8f, 0.05f);
    assert_true(body.has_heading);
    assert_true(body.cos_heading == 0.6f && body.sin_heading == 0.8f);
    assert_true(body.heading_sigma_rad == 0.05f && body.across_m2 == 1.0f && body.along_m2 == 4.0f);
    body.across_m2 = 0.5f;
    rho_body_set_heading(&body, 0.8f, 0.6f, 0.02f);
    assert_true(body.cos_heading == 0.8f && body.across_m2 == 0.5f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_heading_may_be_set),
        cmocka_unit_test(length_and_width_are_estimated_without_the_plots_noise),
        cmocka_unit_test(errors_of_length_and_width_agree_with_their_sigmas),
        cmocka_unit_test(one_stray_plot_does_not_widen_a_body_for_long),
        cmocka_unit_test(many_plots_show_within_half_a_second_that_a_body_is_wider),
        cmocka_unit_test(the_variance_of_the_mean_follows_the_share_of_missed_scatterers),
        cmocka_unit_test(the_heading_follows_velocities_that_are_well_known),
        cmocka_unit_test(rotating_a_covariance_to_body_axes_and_back_restores_it),
        cmocka_unit_test(the_width_is_at_least_a_sixteenth_of_the_length),
        cmocka_unit_test(a_heading_needs_a_speed_of_four_sigmas),
        cmocka_unit_test(noise_of_one_who_stops_turns_no_body),
        cmocka_unit_test(a_new_body_has_the_prior_length_and_a_third_of_it_as_width),
        cmocka_unit_test(every_update_agrees_with_the_derivation),
        cmocka_unit_test(a_plot_far_out_along_the_body_does_not_update_the_width),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
