/* SPDX-License-Identifier: MIT */
/*
 * Which subset of candidates becomes tracks. Candidates are made by hand through a private header,
 * as drawn scenes seldom have a best subset that starts from the ninth candidate.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "../../src/bearings/passive_search.h"

static struct rho_passive passive;
static struct rho_passive_search search = {
    .passive = &passive, .half_s = 35.0f, .share_nat = 100.0f};

/* Adds a candidate that claims bearing 1 of sensor 0 in the scans of this bit mask. */
static void add_candidate(float score_nat, unsigned scans)
{
    struct rho_passive_candidate *candidate = &passive.candidates[passive.num_candidates++];
    *candidate = (struct rho_passive_candidate){.score_nat = score_nat};
    for (unsigned k = 0; k < 8; k++) {
        candidate->claim[k][0] = (uint8_t)(scans >> k & 1u);
        candidate->hits += scans >> k & 1u;
    }
}

static void begin_candidates(void)
{
    memset(&passive, 0, sizeof passive);
    passive.batch.num_scans = 8;
    passive.batch.num_sensors = 1;
    passive.config.range_max_m = 100e3f;
    passive.config.v_max_mps = 450.0f;
    for (unsigned k = 0; k < 8; k++) {
        passive.batch.bearings[k][0][0] =
            (struct rho_batch_bearing){.cosine = 1.0f, .sigma_rad = 1e-3f};
    }
}

/*
 * `before` candidates of about 20 nat that exclude all others, then two of 15 nat that can be
 * tracks together. Returns the score of the subset chosen.
 */
static float total_nat_chosen_after_exclusive_candidates(unsigned before)
{
    struct rho_passive_choice best;
    begin_candidates();
    for (unsigned i = 0; i < before; i++) {
        add_candidate(20.0f - 0.1f * (float)i, 3);
    }
    add_candidate(15.0f, 1);
    add_candidate(15.0f, 2);
    rho_passive_choose(&search, &best);
    return best.total_nat;
}

static void the_best_subset_of_the_first_twelve_starts_is_chosen(void **state)
{
    (void)state;
    assert_true(total_nat_chosen_after_exclusive_candidates(0) == 30.0f);
    assert_true(total_nat_chosen_after_exclusive_candidates(8) == 30.0f);
    assert_true(total_nat_chosen_after_exclusive_candidates(11) == 30.0f);
    assert_true(total_nat_chosen_after_exclusive_candidates(12) == 20.0f);
    assert_true(total_nat_chosen_after_exclusive_candidates(18) == 20.0f);
}

static void a_candidate_worth_less_than_a_millinat_is_left_out(void **state)
{
    struct rho_passive_choice best;
    (void)state;
    for (int i = 0; i < 2; i++) {
        begin_candidates();
        /* twelve starts, so that none begins with the last candidate */
        for (int strong = 0; strong < 12; strong++) {
            add_candidate(5.0f, 0);
        }
        add_candidate(i ? 1.4e-3f : 0.7e-3f, 0);
        rho_passive_choose(&search, &best);
        assert_int_equal(best.is_in[11], 1);
        assert_int_equal(best.is_in[12], i);
    }
}

/*
 * With seven of ten bearings in common the second candidate is excluded as the same target, with
 * six it is not.
 */
static void a_candidate_sharing_70_percent_of_bearings_is_excluded(void **state)
{
    struct rho_passive_choice best;
    (void)state;
    for (int i = 0; i < 2; i++) {
        begin_candidates();
        add_candidate(20.0f, 0xff);
        passive.candidates[0].hits = 10;
        add_candidate(10.0f, i ? 0x7f : 0x3f);
        passive.candidates[0].state_m[RHO_PASSIVE_X] = 50e3f;
        passive.candidates[1].state_m[RHO_PASSIVE_X] = 50e3f;
        passive.candidates[1].state_m[RHO_PASSIVE_Y] = 5e3f; /* not where the first one is */
        rho_passive_choose(&search, &best);
        assert_int_equal(best.is_in[0], 1);
        rho_passive_exclude_target(&best, 0);
        assert_int_equal(best.is_out[0], 1);
        assert_int_equal(best.is_out[1], i);
        rho_passive_add_gaining(&best, best.count);
        assert_int_equal(best.is_in[1], !i);
    }
}

/*
 * Eight bearings of 1 mrad at 50 km leave a sigma of 50 m / sqrt(8) across them: a candidate within
 * five of these is at the target, though it shares no bearing with it.
 */
static void a_candidate_within_five_sigmas_of_a_target_is_excluded(void **state)
{
    struct rho_passive_choice best;
    (void)state;
    for (int i = 0; i < 2; i++) {
        begin_candidates();
        add_candidate(20.0f, 0xff);
        add_candidate(10.0f, 0);
        passive.candidates[0].state_m[RHO_PASSIVE_X] = 50e3f;
        passive.candidates[1].state_m[RHO_PASSIVE_X] = 50e3f;
        passive.candidates[1].state_m[RHO_PASSIVE_Y] = (i ? 4.95f : 5.05f) * 50.0f / 2.828427f;
        rho_passive_choose(&search, &best);
        assert_int_equal(best.is_in[0] + best.is_in[1], 2);
        rho_passive_exclude_target(&best, 0);
        assert_int_equal(best.is_out[0], 1);
        assert_int_equal(best.is_out[1], i);
        assert_int_equal(best.is_in[1], !i);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_best_subset_of_the_first_twelve_starts_is_chosen),
        cmocka_unit_test(a_candidate_worth_less_than_a_millinat_is_left_out),
        cmocka_unit_test(a_candidate_sharing_70_percent_of_bearings_is_excluded),
        cmocka_unit_test(a_candidate_within_five_sigmas_of_a_target_is_excluded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
