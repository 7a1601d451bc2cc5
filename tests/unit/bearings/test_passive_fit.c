/* SPDX-License-Identifier: MIT */
/*
 * Limits of the passive search: steps of a fit, floors of its densities, votes of its lines. A
 * private header is included, as no drawn scene makes a fit diverge.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "../../src/bearings/passive_search.h"
#include "passive_scene.h"

static struct rho_passive passive = {.config = {.range_max_m = 1000.0f}};
static struct rho_passive_search search = {.passive = &passive, .half_s = 10.0f};

/* Without bearings the displacement goes to 0 in steps of a tenth of the range, 1000 m. */
static void a_fit_stays_in_two_ranges_and_steps_at_most_a_tenth(void **state)
{
    struct rho_passive_candidate track = {.state_m = {5000.0f, -5000.0f, 500.0f, -60.0f}};
    const float *state_m = track.state_m;
    (void)state;
    rho_passive_step_to_claims(&search, &track);
    assert_true(fabsf(state_m[0] - 2000.0f) < 1e-3f && fabsf(state_m[1] + 2000.0f) < 1e-3f);
    assert_true(fabsf(state_m[2] - 400.0f) < 1e-3f && fabsf(state_m[3]) < 1e-3f);
}

/*
 * Four bearings in eight scans of pi rad are less than the floor of 0.3 a radian; the smallest
 * sigma is the largest one / 200.
 */
static void false_bearing_density_and_smallest_sigma_have_floors(void **state)
{
    static struct rho_passive few = {.config = {.pd = 0.9f,
                                                .field_of_view_rad = 3.14159265f,
                                                .theta_cell_rad = 0.0872665f,
                                                .rho_cell_m = 2000.0f}};
    struct rho_passive_search prepared = {.passive = &few};
    (void)state;
    few.batch.num_scans = 4;
    few.batch.num_sensors = 2;
    for (unsigned k = 0; k < 4; k++) {
        few.batch.time_us[k] = 10000000 * (int64_t)k;
        few.batch.was_seen[k][0] = few.batch.was_seen[k][1] = 1;
        few.batch.num_bearings[k][0] = 1;
        few.batch.bearings[k][0][0].sigma_rad = k == 2 ? 0.02f : 1e-6f;
        few.batch.bearings[k][0][0].cosine = 1.0f;
    }
    rho_passive_prepare(&prepared);
    assert_true(fabs((double)prepared.hit_nat - log(0.9 / (0.3 * sqrt(2.0 * PI)))) < 1e-4);
    assert_true(fabs((double)prepared.sigma_min_rad - 1e-4) < 1e-8);
}

/*
 * Crossings of two scans: on one line if of one target, else too far apart for any line. The second
 * pass must not accept a line of one vote either, though half of two is one.
 */
static void a_line_needs_two_votes(void **state)
{
    static struct rho_passive searched;
    static struct scene scene;
    (void)state;
    random_state = 5;
    scene = scene_of(2, 1, 0.1, 1.0, 0.0);
    draw_scene(&scene);
    for (unsigned k = 1; k < 7; k++) {
        scene.look[k][1].is_absent = 1;
    }
    assert_int_equal(search_scene(&searched, &scene), RHO_OK);
    assert_int_equal(searched.work.crossings, 2);
    assert_true(searched.work.peaks > 0);
    scene = scene_of(2, 0, 0.1, 1.0, 0.0);
    scene.scans = 4;
    draw_scene(&scene);
    for (unsigned k = 0; k < 4; k++) {
        scene.look[k][1].is_absent = k % 2;
        add_bearing(&scene.look[k][0], k < 2 ? 0.3 : -0.9, 1e-3, -1);
        add_bearing(&scene.look[k][1], k < 2 ? -0.1 : -1.2, 1e-3, -1);
    }
    assert_int_equal(search_scene(&searched, &scene), RHO_OK);
    assert_int_equal(searched.work.crossings, 2);
    assert_int_equal(searched.work.peaks, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fit_stays_in_two_ranges_and_steps_at_most_a_tenth),
        cmocka_unit_test(false_bearing_density_and_smallest_sigma_have_floors),
        cmocka_unit_test(a_line_needs_two_votes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
