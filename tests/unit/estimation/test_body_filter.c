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
        look.cross_m2 += (float)(along_m * across_m);
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
            look.num_plots++;
            look.along_m2 += (float)(along_m * along_m);
            look.across_m2 += (float)(across_m * across_m);
            look.cross_m2 += (float)(along_m * across_m);
            look.noise_along_m2 += (float)(sigma_m * sigma_m);
            look.noise_across_m2 += (float)(sigma_m * sigma_m);
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
            rho_body_start(&body, 1, 9.0f);
            for (int k = 0; k < 200; k++) {
                off_rad = k % 10 ? off_rad : 0.1 * normal();
                /* velocities are better than they are said to be: sigma .18 rad */
                moves(&body, 10.0f, 0.0f, 3.3f);
                const struct rho_body_look look =
                    look_at((const double(*)[2])places_m, counts[c], off_rad, 0.3);
                rho_body_add(&body, &look);
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

/* One look that a neighbour's plot strays into: not a wide body for the rest of the track's life. */
static void a_stray_plot_is_no_width(void **state)
{
    struct rho_body_filter body;
    struct rho_body shape;
    (void)state;
    random_state = 7;
    rho_body_start(&body, 1, 9.0f);
    moves(&body, 10.0f, 0.0f, 0.0f);
    for (int k = 0; k < 40; k++) {
        struct rho_body_look look = look_of(3, 0.1);
        look.across_m2 += k == 0 ? 150.0f : 0.0f;
        rho_body_add(&body, &look);
    }
    rho_body_shape(&body, &shape);
    assert_true(shape.width_m < 4.0f);
}

/* All are seen: their mean is known. Of several one is missed, or all but one. */
static void those_missed_move_the_mean(void **state)
{
    struct rho_body_filter body;
    (void)state;
    rho_body_start(&body, 1, 9.0f);
    assert_true(rho_body_missed_share(&body, 1) == 1.0f);
    body.most_plots = 5;
    assert_true(rho_body_missed_share(&body, 1) == 1.0f);
    assert_true(rho_body_missed_share(&body, 5) < 0.05f);
    assert_true(rho_body_missed_share(&body, 8) < 0.05f);
    assert_true(fabs((double)rho_body_missed_share(&body, 4) - 0.25) < 0.05);
    assert_true(fabs((double)rho_body_missed_share(&body, 2) - 0.75) < 0.05);
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

/* ---- figures --------------------------------------------------------------------------------- */

static void expect_close(double is, double wanted)
{
    assert_true(fabs(is - wanted) <= 2e-5 * fabs(wanted));
}

static void a_heading_takes_a_speed_of_three_sigmas(void **state)
{
    struct rho_body_filter body;
    (void)state;
    rho_body_start(&body, 1, 9.0f);
    moves(&body, 2.9f, 0.0f, 1.0f);
    assert_int_equal(body.has_heading, 0);
    moves(&body, 3.1f, 0.0f, 1.0f);
    assert_int_equal(body.has_heading, 1);
}

/* Before and after the first heading: four plots' worth of the prior more, and a third as wide. */
static void what_a_new_body_is_taken_for(void **state)
{
    struct rho_body_filter body;
    float world[3];
    (void)state;
    rho_body_start(&body, 1, 9.0f);
    expect_close((double)rho_body_most_along_m2(&body), 9.0 + 9.0 * 4.0 / 4.3);
    moves(&body, 10.0f, 0.0f, 0.0f);
    rho_body_spread(&body, world);
    expect_close((double)world[0], 9.0);
    expect_close((double)world[2], 9.0 / 9.0);
}

/* One axis by the head of body_filter.c, in double precision. */
struct axis {
    double mean_m2, weight;
};

static void learn(struct axis *axis, double kept, double usual_m2, double mean_m2, double own_m2,
                  double n)
{
    const double share = usual_m2 / (usual_m2 + own_m2);
    axis->weight = kept * axis->weight + n * share * share;
    axis->mean_m2 += n * share * share / axis->weight * (mean_m2 - own_m2 - axis->mean_m2);
    axis->weight = fmax(axis->weight, 0.01);
}

/* The sigma of a side, by what few plots, scatterers that stay and the heading leave of it. */
static double sigma_of_side(double spread_m2, double usual_m2, double turned_m2, double weight,
                            double most)
{
    const double length_m = sqrt(12.0 * spread_m2);
    const double drawn_m = 6.0 * fmax(spread_m2, usual_m2) * sqrt(2.0 / weight) / length_m;
    return sqrt(drawn_m * drawn_m + pow(length_m / pow(most, 1.5), 2.0) +
                pow(6.0 * turned_m2 / length_m, 2.0));
}

/* Looks of few plots and of many, of less spread than their noise, and of noise alone. */
static void every_look_as_derived(void **state)
{
    static const struct rho_body_look looks[] = {
        {2, 30.0f, 3.0f, 0.5f, 0.4f},       {5, 80.0f, 2.0f, 1.0f, 0.8f},
        {1, 4.0f, 0.02f, 0.3f, 0.2f},       {300, 3500.0f, 250.0f, 90.0f, 60.0f},
        {400, 4000.0f, 300.0f, 1e3f, 1e3f}, {8, 1.0f, 0.1f, 900.0f, 90.0f},
        {600, 1.0f, 1.0f, 600.0f, 600.0f},  {600, 1.0f, 1.0f, 6e7f, 6e7f},
    };
    const double prior_m2 = 9.0, heading_rad = 0.12, turned = 0.7 * heading_rad * heading_rad;
    struct axis along = {prior_m2, 0.3}, across = {prior_m2 / 9.0, 0.3};
    double width_m2 = across.mean_m2, plots = 1.0, most = 0.0;
    struct rho_body_filter body;
    struct rho_body shape;
    (void)state;
    rho_body_start(&body, 1, (float)prior_m2);
    moves(&body, 10.0f, 0.0f, 1.44f);
    for (size_t i = 0; i < sizeof looks / sizeof looks[0]; i++) {
        const struct rho_body_look *look = &looks[i];
        const double n = look->num_plots, kept = fmax(1.0 - n / 500.0, 0.0);
        const double usual_m2 = fmax(along.mean_m2, prior_m2 / 16.0);
        const double before_m2 = along.mean_m2;
        rho_body_add(&body, look);
        learn(&along, kept, usual_m2, (double)look->along_m2 / n,
              (double)look->noise_along_m2 / n + turned * width_m2, n);
        along.mean_m2 = fmax(along.mean_m2, 1e-3);
        learn(&across, kept, fmax(along.mean_m2, prior_m2 / 16.0) / 36.0,
              (double)look->across_m2 / n, (double)look->noise_across_m2 / n + turned * before_m2,
              n);
        width_m2 = fmax(across.mean_m2, along.mean_m2 / 256.0);
        plots = kept * plots + n;
        most = fmax(most, n);
        rho_body_shape(&body, &shape);
        expect_close((double)shape.length_m, sqrt(12.0 * along.mean_m2));
        expect_close((double)shape.width_m, sqrt(12.0 * width_m2));
        expect_close((double)shape.plots, plots);
        expect_close((double)rho_body_most_along_m2(&body),
                     along.mean_m2 + prior_m2 * 4.0 / (4.0 + along.weight));
        const double now_m2 = fmax(along.mean_m2, prior_m2 / 16.0);
        expect_close((double)shape.sigma_length_m,
                     sigma_of_side(along.mean_m2, now_m2, turned * width_m2, along.weight, most));
        expect_close(
            (double)shape.sigma_width_m,
            sigma_of_side(width_m2, now_m2 / 36.0, turned * along.mean_m2, across.weight, most));
    }
    expect_close(along.mean_m2, 1e-3);
    expect_close(along.weight, 0.01);
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
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
