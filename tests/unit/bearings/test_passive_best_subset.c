/* SPDX-License-Identifier: MIT */
/*
 * Which candidates are tracks together, of candidates that are made by hand: bearings of a scene
 * seldom leave a choice whose best start is the ninth. So the test includes a private header.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "../../src/bearings/passive_search.h"

static struct rho_passive passive;
static struct rho_passive_search search = {.passive = &passive, .share_nat = 100.0f};

/* Claims bearing 1 of sensor 0 in these scans, a bit each. */
static void add(float score_nat, unsigned scans)
{
    struct rho_passive_candidate *candidate = &passive.candidates[passive.num_candidates++];
    *candidate = (struct rho_passive_candidate){.score_nat = score_nat};
    for (unsigned k = 0; k < 8; k++) {
        candidate->claim[k][0] = (uint8_t)(scans >> k & 1u);
        candidate->hits += scans >> k & 1u;
    }
}

static void begin(void)
{
    memset(&passive, 0, sizeof passive);
    passive.batch.num_scans = 8;
    passive.batch.num_sensors = 1;
}

/*
 * So many candidates that leave room for no other one, the best worth 20 nat, and two worth 15
 * each that are tracks together.
 */
static float best_total(unsigned before)
{
    struct rho_passive_choice best;
    begin();
    for (unsigned i = 0; i < before; i++) {
        add(20.0f - 0.1f * (float)i, 3);
    }
    add(15.0f, 1);
    add(15.0f, 2);
    rho_passive_choose_candidates(&search, &best);
    return best.total_nat;
}

static void the_best_choice_of_twelve_starts_is_taken(void **state)
{
    (void)state;
    assert_true(best_total(0) == 30.0f);
    assert_true(best_total(8) == 30.0f);
    assert_true(best_total(11) == 30.0f);
    assert_true(best_total(12) == 20.0f);
    assert_true(best_total(18) == 20.0f);
}

static void a_millinat_is_a_gain_and_less_is_none(void **state)
{
    struct rho_passive_choice best;
    (void)state;
    for (int i = 0; i < 2; i++) {
        begin();
        for (int strong = 0; strong < 12; strong++) { /* no start is left for the last one */
            add(5.0f, 0);
        }
        add(i ? 1.4e-3f : 0.7e-3f, 0);
        rho_passive_choose_candidates(&search, &best);
        assert_int_equal(best.is_in[11], 1);
        assert_int_equal(best.is_in[12], i);
    }
}

/* Seven bearings of ten: the same target, left out with it. Six: another one. */
static void most_bearings_alike_are_one_target(void **state)
{
    struct rho_passive_choice best;
    (void)state;
    for (int i = 0; i < 2; i++) {
        begin();
        add(20.0f, 0xff);
        passive.candidates[0].hits = 10;
        add(10.0f, i ? 0x7f : 0x3f);
        rho_passive_choose_candidates(&search, &best);
        assert_int_equal(best.is_in[0], 1);
        rho_passive_exclude_target(&best, 0);
        assert_int_equal(best.is_out[0], 1);
        assert_int_equal(best.is_out[1], i);
        rho_passive_include_and_extend(&best, best.count);
        assert_int_equal(best.is_in[1], !i);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_best_choice_of_twelve_starts_is_taken),
        cmocka_unit_test(a_millinat_is_a_gain_and_less_is_none),
        cmocka_unit_test(most_bearings_alike_are_one_target),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
