/* SPDX-License-Identifier: MIT */
/* GOSPA and OSPA against hand-made cases and against every possible pairing of small random sets. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "gospa.h"

#define TOLERANCE 1e-6

static uint32_t seed = 11;

static double uniform(double from, double to)
{
    seed = seed * 1664525u + 1013904223u;
    return from + (to - from) * (double)(seed >> 8) / 16777216.0;
}

static double squared(const struct gospa_place *a, const struct gospa_place *b)
{
    return pow(a->x_m - b->x_m, 2) + pow(a->y_m - b->y_m, 2) + pow(a->z_m - b->z_m, 2);
}

/* Least GOSPA^2 over all pairings: target i takes a free track or none. */
static double brute(const struct gospa_place *targets, int num_targets,
                    const struct gospa_place *tracks, int num_tracks, double cutoff_m, int i,
                    unsigned used)
{
    double half = cutoff_m * cutoff_m / 2.0;
    if (i == num_targets) {
        return half * (num_tracks - __builtin_popcount(used));
    }
    double best = half + brute(targets, num_targets, tracks, num_tracks, cutoff_m, i + 1, used);
    for (int j = 0; j < num_tracks; j++) {
        if (!(used >> j & 1u)) {
            double rest =
                brute(targets, num_targets, tracks, num_tracks, cutoff_m, i + 1, used | 1u << j);
            best = fmin(best, fmin(squared(&targets[i], &tracks[j]), 2.0 * half) + rest);
        }
    }
    return best;
}

static void random_sets_are_paired_best(void **state)
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
        double expected = brute(targets, num_targets, tracks, num_tracks, 10.0, 0, 0);
        assert_true(fabs(result.squared_m2 - expected) < TOLERANCE);
        for (int i = 0; i < num_targets; i++) {
            pairs += track_of[i] >= 0;
        }
        assert_int_equal(pairs, result.pairs);
        assert_int_equal(result.missed, num_targets - pairs);
        assert_int_equal(result.false_tracks, num_tracks - pairs);
    }
}

static void known_sets_have_known_values(void **state)
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_sets_are_paired_best),
        cmocka_unit_test(known_sets_have_known_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
