/* SPDX-License-Identifier: MIT */
/*
 * GOSPA and OSPA compared with hand-made cases, with every possible pairing of small random sets,
 * and with a dense assignment over whole sets (gospa_vectors.h).
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "evaluation/gospa.h"

#include "vectors/gospa_vectors.h"

#define TOLERANCE 1e-6

static uint32_t seed = 11;

static double uniform(double from, double to)
{
    seed = seed * 1664525u + 1013904223u;
    return from + (to - from) * (double)(seed >> 8) / 16777216.0;
}

static double distance_squared(const struct gospa_place *a, const struct gospa_place *b)
{
    return pow(a->x_m - b->x_m, 2) + pow(a->y_m - b->y_m, 2) + pow(a->z_m - b->z_m, 2);
}

/* Least squared GOSPA over all pairings: each target takes a free track or none. */
static double least_gospa2_of_all_pairings(const struct gospa_place *targets, int num_targets,
                                           const struct gospa_place *tracks, int num_tracks,
                                           double cutoff_m, int i, unsigned used)
{
    double half = cutoff_m * cutoff_m / 2.0;
    if (i == num_targets) {
        return half * (num_tracks - __builtin_popcount(used));
    }
    double best = half + least_gospa2_of_all_pairings(targets, num_targets, tracks, num_tracks,
                                                      cutoff_m, i + 1, used);
    for (int j = 0; j < num_tracks; j++) {
        if (!(used >> j & 1u)) {
            double rest = least_gospa2_of_all_pairings(targets, num_targets, tracks, num_tracks,
                                                       cutoff_m, i + 1, used | 1u << j);
            best = fmin(best, fmin(distance_squared(&targets[i], &tracks[j]), 2.0 * half) + rest);
        }
    }
    return best;
}

static void small_random_sets_get_the_optimal_pairing(void **state)
{
    (void)state;
    for (int round = 0; round < 600; round++) {
        struct gospa_place targets[5], tracks[5];
        int num_targets = round % 6, num_tracks = round / 6 % 6, track_of[5], pairs = 0;
        for (int i = 0; i < 5; i++) {
            targets[i] = (struct gospa_place){uniform(0, 30), uniform(0, 30), uniform(0, 5)};
            tracks[i] = (struct gospa_place){uniform(0, 30), uniform(0, 30), uniform(0, 5)};
        }
        struct gospa result =
            gospa_compare(targets, (size_t)num_targets, tracks, (size_t)num_tracks, 10.0, track_of);
        double expected =
            least_gospa2_of_all_pairings(targets, num_targets, tracks, num_tracks, 10.0, 0, 0);
        assert_true(fabs(result.squared_m2 - expected) < TOLERANCE);
        for (int i = 0; i < num_targets; i++) {
            pairs += track_of[i] >= 0;
        }
        assert_int_equal(pairs, result.pairs);
        assert_int_equal(result.missed, num_targets - pairs);
        assert_int_equal(result.false_tracks, num_tracks - pairs);
    }
}

/*
 * The returned pairs fit the result: each track once, each pair nearer than the cutoff, squares
 * that sum to the localisation error.
 */
static void check_pairs_fit_result(const struct gospa *result, const struct gospa_place *targets,
                                   size_t num_targets, const struct gospa_place *tracks,
                                   size_t num_tracks, double cutoff_m, const int *track_of)
{
    bool *is_taken = calloc(num_tracks + 1, sizeof *is_taken);
    double localisation_m2 = 0.0;
    size_t pairs = 0;
    for (size_t i = 0; i < num_targets; i++) {
        if (track_of[i] >= 0) {
            assert_true((size_t)track_of[i] < num_tracks && !is_taken[track_of[i]]);
            assert_true(distance_squared(&targets[i], &tracks[track_of[i]]) < cutoff_m * cutoff_m);
            is_taken[track_of[i]] = true;
            localisation_m2 += distance_squared(&targets[i], &tracks[track_of[i]]);
            pairs++;
        }
    }
    double squared_m2 = localisation_m2 +
                        cutoff_m * cutoff_m / 2.0 * (double)(num_targets + num_tracks - 2 * pairs);
    assert_true(fabs(result->localisation_m2 - localisation_m2) <= 1e-12 * localisation_m2);
    assert_true(fabs(result->squared_m2 - squared_m2) <= 1e-12 * squared_m2);
    assert_true(result->pairs == pairs && result->missed == num_targets - pairs &&
                result->false_tracks == num_tracks - pairs);
    free(is_taken);
}

/* Separate groups in any order, on whole metres so that several pairings may be equally good. */
static void separate_groups_get_the_optimal_pairing(void **state)
{
    (void)state;
    for (int round = 0; round < 400; round++) {
        struct gospa_place targets[7], tracks[7];
        int num_targets = round % 8, num_tracks = round / 8 % 8, track_of[7];
        double side_m = round % 3 == 0 ? 4.0 : 9.0;
        for (int i = 0; i < 7; i++) {
            targets[i] =
                (struct gospa_place){floor(uniform(0, 3)) * 20.0 + floor(uniform(0, side_m)),
                                     floor(uniform(0, side_m)), floor(uniform(0, 2)) * 50.0};
            tracks[i] =
                (struct gospa_place){floor(uniform(0, 3)) * 20.0 + floor(uniform(0, side_m)),
                                     floor(uniform(0, side_m)), floor(uniform(0, 2)) * 50.0};
        }
        struct gospa result =
            gospa_compare(targets, (size_t)num_targets, tracks, (size_t)num_tracks, 5.0, track_of);
        double expected =
            least_gospa2_of_all_pairings(targets, num_targets, tracks, num_tracks, 5.0, 0, 0);
        assert_true(fabs(result.squared_m2 - expected) < TOLERANCE);
        check_pairs_fit_result(&result, targets, (size_t)num_targets, tracks, (size_t)num_tracks,
                               5.0, track_of);
    }
}

static void results_equal_a_dense_assignment(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof gospa_cases / sizeof *gospa_cases; i++) {
        const struct gospa_case *c = &gospa_cases[i];
        const struct gospa_place *targets = &gospa_places[c->targets];
        const struct gospa_place *tracks = &gospa_places[c->tracks];
        int track_of[60];
        struct gospa result =
            gospa_compare(targets, c->num_targets, tracks, c->num_tracks, c->cutoff_m, track_of);
        if (fabs(sqrt(result.squared_m2) - c->gospa_m) > 1e-11 * c->gospa_m ||
            fabs(result.ospa_m - c->ospa_m) > 1e-11 * c->ospa_m) {
            fail_msg("%s: GOSPA %.13g, OSPA %.13g", c->name, sqrt(result.squared_m2),
                     result.ospa_m);
        }
        if (c->pairs >= 0) {
            assert_int_equal(result.pairs, c->pairs);
            assert_true(fabs(result.localisation_m2 - c->localisation_m2) <=
                        1e-11 * c->localisation_m2);
        }
        check_pairs_fit_result(&result, targets, c->num_targets, tracks, c->num_tracks, c->cutoff_m,
                               track_of);
    }
}

/*
 * 30 000 targets and 20 000 tracks, each 3 m from its target, targets 20 m apart: one dense
 * assignment would take hours and 5 GB.
 */
static void large_spread_out_sets_are_paired_quickly(void **state)
{
    (void)state;
    enum { SIDE = 200, TARGETS = 30000, TRACKS = 20000 };
    struct gospa_place *targets = calloc(TARGETS, sizeof *targets);
    struct gospa_place *tracks = calloc(TRACKS, sizeof *tracks);
    int *track_of = calloc(TARGETS, sizeof *track_of);
    for (int i = 0; i < TARGETS; i++) {
        targets[i] = (struct gospa_place){20.0 * (i % SIDE), 20.0 * (i / SIDE), 0.0};
    }
    for (int i = 0; i < TRACKS; i++) {
        tracks[i] = targets[TRACKS - 1 - i];
        tracks[i].x_m += 3.0;
    }
    struct gospa result = gospa_compare(targets, TARGETS, tracks, TRACKS, 10.0, track_of);
    assert_int_equal(result.pairs, TRACKS);
    assert_true(fabs(result.localisation_m2 - 9.0 * TRACKS) < TOLERANCE);
    assert_int_equal(track_of[0], TRACKS - 1);
    assert_int_equal(track_of[TRACKS - 1], 0);
    assert_int_equal(track_of[TRACKS], -1);
    free(targets);
    free(tracks);
    free(track_of);
}

static void hand_made_sets_have_known_gospa_and_ospa(void **state)
{
    (void)state;
    const struct gospa_place targets[2] = {{0, 0, 0}, {100, 0, 0}};
    const struct gospa_place tracks[3] = {{103, 4, 0}, {0, 6, 0}, {900, 900, 0}};
    int track_of[2];
    struct gospa result = gospa_compare(targets, 2, tracks, 3, 20.0, track_of);
    assert_int_equal(track_of[0], 1);
    assert_int_equal(track_of[1], 0);
    assert_true(fabs(result.localisation_m2 - (36.0 + 25.0)) < TOLERANCE);
    assert_true(fabs(result.squared_m2 - (36.0 + 25.0 + 200.0)) < TOLERANCE);
    assert_true(fabs(result.ospa_m - sqrt((36.0 + 25.0 + 400.0) / 3.0)) < TOLERANCE);
    result = gospa_compare(targets, 2, tracks, 0, 20.0, track_of);
    assert_true(fabs(result.squared_m2 - 400.0) < TOLERANCE);
    assert_true(fabs(result.ospa_m - 20.0) < TOLERANCE);
    assert_int_equal(track_of[0], -1);
    result = gospa_compare(targets, 0, tracks, 0, 20.0, NULL);
    assert_true(fabs(result.squared_m2) < TOLERANCE && fabs(result.ospa_m) < TOLERANCE);
}

/* A target and a track exactly the cutoff apart are left unpaired by the best pairing. */
static void points_exactly_the_cutoff_apart_are_no_pair(void **state)
{
    (void)state;
    const struct gospa_place targets[2] = {{0, 0, 0}, {2.5, 4, 0}};
    const struct gospa_place tracks[2] = {{5, 0, 0}, {2.5, 4, 0}};
    int track_of[2];
    struct gospa result = gospa_compare(targets, 2, tracks, 2, 5.0, track_of);
    assert_true(track_of[0] == -1 && track_of[1] == 1);
    assert_true(result.pairs == 1 && result.missed == 1 && result.false_tracks == 1);
    assert_true(fabs(result.squared_m2 - 25.0) < TOLERANCE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_random_sets_get_the_optimal_pairing),
        cmocka_unit_test(separate_groups_get_the_optimal_pairing),
        cmocka_unit_test(results_equal_a_dense_assignment),
        cmocka_unit_test(large_spread_out_sets_are_paired_quickly),
        cmocka_unit_test(hand_made_sets_have_known_gospa_and_ospa),
        cmocka_unit_test(points_exactly_the_cutoff_apart_are_no_pair),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
