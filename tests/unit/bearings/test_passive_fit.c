/* SPDX-License-Identifier: MIT */
/*
 * Limits of the passive search: steps of a fit, floors of its densities, pairs of its crossings. A
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

static struct rho_passive passive = {.config = {.range_max_m = 1000.0f, .v_max_mps = 100.0f}};
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

/* Four scans of two sensors; the first sensor has bearings in the first `bearings` of them. */
static struct rho_passive_search prepare_few_bearings(struct rho_passive *few, unsigned bearings)
{
    struct rho_passive_search prepared = {.passive = few};
    *few = (struct rho_passive){.config = {.pd = 0.9f, .field_of_view_rad = 3.14159265f}};
    few->batch.num_scans = 4;
    few->batch.num_sensors = 2;
    few->batch.newest_us = 30000000;
    for (unsigned k = 0; k < 4; k++) {
        few->batch.time_us[k] = 10000000 * (int64_t)k;
        few->batch.was_seen[k][0] = few->batch.was_seen[k][1] = 1;
        few->batch.num_bearings[k][0] = k < bearings;
        few->batch.bearings[k][0][0].sigma_rad = k == 1 ? 0.02f : 1e-6f;
        few->batch.bearings[k][0][0].cosine = 1.0f;
    }
    rho_passive_prepare(&prepared);
    return prepared;
}

static void expect_hit_nat(const struct rho_passive_search *prepared, double false_a_look)
{
    assert_true(fabs((double)prepared->hit_nat - log(0.9 * PI / false_a_look)) < 1e-4);
}

/*
 * Two bearings in eight looks are less than the floor of 0.3 a look; the smallest sigma is the
 * largest one / 200.
 */
static void false_bearing_density_and_smallest_sigma_have_floors(void **state)
{
    static struct rho_passive few;
    (void)state;
    struct rho_passive_search prepared = prepare_few_bearings(&few, 2);
    expect_hit_nat(&prepared, 0.3);
    assert_true(fabs((double)prepared.sigma_min_rad - 1e-4) < 1e-8);
    prepared = prepare_few_bearings(&few, 4);
    expect_hit_nat(&prepared, 4.0 / 8.0);
}

/* Candidates' scores follow the density, once for each of their bearings. */
static void bearings_that_tracks_claim_or_own_are_not_false(void **state)
{
    static struct rho_passive few;
    (void)state;
    struct rho_passive_search prepared = prepare_few_bearings(&few, 4);
    few.num_candidates = 1;
    few.candidates[0].hits = 7;
    few.candidates[0].score_nat = 10.0f;
    few.is_claimed[0][0][0] = RHO_PASSIVE_CLAIMED;
    rho_passive_set_density(&prepared);
    expect_hit_nat(&prepared, 3.0 / 8.0);
    assert_true(fabs((double)few.candidates[0].score_nat - 10.0 - 7.0 * log(4.0 / 3.0)) < 1e-4);
    few.batch.bearings[3][0][0].owner.track_id = 9;
    rho_passive_set_density(&prepared);
    expect_hit_nat(&prepared, 0.3); /* two bearings are left */
    few.is_claimed[0][0][0] = RHO_PASSIVE_FREE;
    few.batch.bearings[3][0][0].owner.track_id = 0;
    rho_passive_set_density(&prepared);
    expect_hit_nat(&prepared, 4.0 / 8.0);
    assert_true(fabs((double)few.candidates[0].score_nat - 10.0) < 1e-4);
}

/*
 * Eight crossings of one target: the pairs of them that are a third of the rows apart are
 * hypotheses, (8 - 3) (8 - 2) / 2 of them; none is fitted twice.
 */
static void pairs_of_crossings_a_third_of_the_rows_apart_are_hypotheses(void **state)
{
    static struct rho_passive searched;
    static struct scene scene;
    (void)state;
    random_state = 5;
    scene = scene_of(2, 1, 0.1, 1.0, 0.0);
    draw_scene(&scene);
    assert_int_equal(search_scene(&searched, &scene), RHO_OK);
    assert_int_equal(searched.work.crossings, 8);
    assert_int_equal(searched.work.hypotheses, 15);
    assert_int_equal(searched.num_tracks, 1);
    for (unsigned k = 1; k < 7; k++) { /* two crossings are one pair, of four bearings */
        scene.look[k][1].is_absent = 1;
    }
    assert_int_equal(search_scene(&searched, &scene), RHO_OK);
    assert_int_equal(searched.work.crossings, 2);
    assert_true(searched.work.hypotheses > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fit_stays_in_two_ranges_and_steps_at_most_a_tenth),
        cmocka_unit_test(false_bearing_density_and_smallest_sigma_have_floors),
        cmocka_unit_test(bearings_that_tracks_claim_or_own_are_not_false),
        cmocka_unit_test(pairs_of_crossings_a_third_of_the_rows_apart_are_hypotheses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
