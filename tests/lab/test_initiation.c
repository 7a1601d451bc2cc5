/* SPDX-License-Identifier: MIT */
/*
 * The main cases of `rhotrack experiment initiation` with few runs and a fixed seed. The bounds are
 * four standard deviations of so few runs away from the figures of many (the comment at each case).
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "experiment_initiation.h"

#define RUNS 60
#define SEED 4711

static struct rho_initiator initiator;

static struct initiation_summary run_case(const char *name)
{
    static struct initiation_run runs[RUNS];
    for (size_t i = 0; i < initiation_num_cases(); i++) {
        const struct initiation_case *of = initiation_case_at(i);
        if (strcmp(of->name, name) == 0) {
            for (size_t run = 0; run < RUNS; run++) {
                struct random random = random_start(SEED, i, run);
                runs[run] = initiation_run(of, &initiator, &random);
            }
            return initiation_summarise(of, runs, RUNS);
        }
    }
    fail_msg("no case '%s'", name);
    return (struct initiation_summary){0};
}

static void expect(const char *name, double pd_min, double false_max)
{
    struct initiation_summary summary = run_case(name);
    print_message("%s: Pd %.3f, clairvoyant %.3f, false %.3f a run\n", name, summary.pd,
                  summary.clairvoyant, summary.false_a_run);
    assert_true(isnan(pd_min) || summary.pd >= pd_min);
    assert_true(summary.false_a_run <= false_max);
    assert_true(isnan(summary.clairvoyant) || summary.pd >= summary.clairvoyant - 0.05);
}

static void targets_in_thin_clutter_are_found(void **state)
{
    (void)state;
    expect("Table 1, 0/km^2, P_D 0.99", 0.98, 0.0);  /* 1.000, 0 */
    expect("Table 1, 1/km^2, P_D 0.99", 0.98, 0.05); /* 0.999, 0 */
}

static void targets_in_dense_clutter_are_found(void **state)
{
    (void)state;
    expect("Table 1, 10/km^2, P_D 0.99", 0.94, 0.12); /* 0.982, 0.013 */
    expect("Table 1, 10/km^2, P_D 0.9", 0.72, 0.20);  /* 0.84, 0.047 */
    expect("Table 1, 30/km^2, P_D 0.99", 0.68, 0.35); /* 0.80, 0.10 */
}

static void the_real_aircraft_are_found(void **state)
{
    (void)state;
    expect("Table 3, 100 clutter plots a scan", 0.98, 0.15); /* 1.000, 0.02 */
}

static void neighbours_are_told_apart(void **state)
{
    (void)state;
    expect("parallel, 20 m", 0.94, 0.1);
    expect("parallel, 50 m", 0.94, 0.15);
    expect("crossing at 10 deg", 0.96, 0.1);
    expect("same line, overtaking", 0.96, 0.1);
    expect("vertical, x = 0", 0.96, 0.1);
}

static void clutter_alone_starts_few_tracks(void **state)
{
    (void)state;
    expect("clutter only, 10/km^2, score_min -3 nat", NAN, 0.15);
    expect("clutter only, 10/km^2, score_min 0 nat", NAN, 0.05);
    expect("Table 1, 5/km^2 with a hot spot of 50/km^2", 0.93, 0.12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(targets_in_thin_clutter_are_found),
        cmocka_unit_test(targets_in_dense_clutter_are_found),
        cmocka_unit_test(the_real_aircraft_are_found),
        cmocka_unit_test(neighbours_are_told_apart),
        cmocka_unit_test(clutter_alone_starts_few_tracks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
