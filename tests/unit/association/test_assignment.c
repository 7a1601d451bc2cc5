/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/detail/assignment.h"

#define SMALL_MAX 6
#define NO_PAIR 1

static struct rho_assignment assignment;

/* Linear congruential generator of Numerical Recipes: every machine tests the same problems. */
static uint32_t seed;

static uint32_t next_random(uint32_t below)
{
    seed = seed * 1664525u + 1013904223u;
    return (uint32_t)(((uint64_t)seed * below) >> 32);
}

static int initialise(void **state)
{
    (void)state;
    seed = 12345;
    return rho_assignment_init(&assignment, sizeof assignment) != RHO_OK;
}

static void begin_problem(unsigned num_rows, unsigned num_columns)
{
    assert_int_equal(rho_assignment_begin(&assignment, num_rows, num_columns), RHO_OK);
}

static void add_pair(unsigned row, unsigned column, int32_t cost)
{
    assert_int_equal(rho_assignment_offer_pair(&assignment, row, column, cost), RHO_OK);
}

static int column_of_row(unsigned row)
{
    return rho_assignment_column(&assignment, row);
}

/* --- against enumeration of all assignments -------------------------------------------------- */

struct problem {
    unsigned num_rows, num_columns;
    int32_t cost[SMALL_MAX][SMALL_MAX]; /* NO_PAIR: the row and the column are no pair */
};

static int64_t least_total_by_enumeration(const struct problem *p, unsigned row, unsigned used)
{
    int64_t least;

    if (row == p->num_rows) {
        return 0;
    }
    least = least_total_by_enumeration(p, row + 1, used);
    for (unsigned column = 0; column < p->num_columns; ++column) {
        if (p->cost[row][column] < 0 && !(used & 1u << column)) {
            const int64_t total =
                p->cost[row][column] + least_total_by_enumeration(p, row + 1, used | 1u << column);

            least = total < least ? total : least;
        }
    }
    return least;
}

static struct problem random_problem(uint32_t cost_max, uint32_t density_percent)
{
    struct problem p = {.num_rows = next_random(SMALL_MAX + 1),
                        .num_columns = next_random(SMALL_MAX + 1)};

    for (unsigned i = 0; i < SMALL_MAX; ++i) {
        for (unsigned j = 0; j < SMALL_MAX; ++j) {
            const int32_t cost = -(int32_t)(next_random(cost_max) + 1);

            p.cost[i][j] = next_random(100) < density_percent ? cost : NO_PAIR;
        }
    }
    return p;
}

static void add_all_pairs(const struct problem *p, int is_reversed)
{
    begin_problem(p->num_rows, p->num_columns);
    for (unsigned i = 0; i < p->num_rows; ++i) {
        for (unsigned k = 0; k < p->num_columns; ++k) {
            const unsigned j = is_reversed ? p->num_columns - 1 - k : k;

            if (p->cost[i][j] < 0) {
                add_pair(i, j, p->cost[i][j]);
            }
        }
    }
}

/* Checks that each assigned column is a pair of its row and used once; returns the sum of costs. */
static int64_t check_assignment_and_sum_costs(const struct problem *p)
{
    unsigned used = 0;
    int64_t total = 0;

    for (unsigned i = 0; i < p->num_rows; ++i) {
        const int column = column_of_row(i);

        if (column != RHO_ASSIGNMENT_NONE) {
            assert_in_range(column, 0, p->num_columns - 1);
            assert_true(p->cost[i][column] < 0);
            assert_false(used & 1u << column);
            used |= 1u << column;
            total += p->cost[i][column];
        }
    }
    return total;
}

static void compare_random_problems_with_enumeration(int count, uint32_t cost_max,
                                                     uint32_t density_percent)
{
    for (int k = 0; k < count; ++k) {
        const struct problem p = random_problem(cost_max, density_percent);
        int columns[SMALL_MAX];

        add_all_pairs(&p, 0);
        rho_assignment_solve(&assignment);
        assert_int_equal(check_assignment_and_sum_costs(&p), least_total_by_enumeration(&p, 0, 0));
        for (unsigned i = 0; i < p.num_rows; ++i) {
            columns[i] = column_of_row(i);
        }
        add_all_pairs(&p, 1); /* the order in which pairs are added does not matter */
        rho_assignment_solve(&assignment);
        for (unsigned i = 0; i < p.num_rows; ++i) {
            assert_int_equal(column_of_row(i), columns[i]);
        }
    }
}

static void small_problems_are_solved_exactly(void **state)
{
    (void)state;
    compare_random_problems_with_enumeration(2000, 10000, 90);
    compare_random_problems_with_enumeration(2000, 10000, 40);
}

static void small_problems_full_of_ties_are_solved_exactly(void **state)
{
    (void)state;
    compare_random_problems_with_enumeration(2000, 1, 60);
    compare_random_problems_with_enumeration(2000, 3, 70);
    compare_random_problems_with_enumeration(1000, 2, 100);
}

static void small_problems_with_the_largest_costs_are_solved_exactly(void **state)
{
    (void)state;
    compare_random_problems_with_enumeration(2000, RHO_ASSIGNMENT_COST_MAX, 80);
    /* problems of the largest size, costs nearly equal: long augmenting paths */
    for (int k = 0; k < 500; ++k) {
        struct problem p = random_problem(5, 100);

        for (unsigned i = 0; i < SMALL_MAX * SMALL_MAX; ++i) {
            p.cost[i / SMALL_MAX][i % SMALL_MAX] -= RHO_ASSIGNMENT_COST_MAX - 5;
        }
        add_all_pairs(&p, 0);
        rho_assignment_solve(&assignment);
        assert_int_equal(check_assignment_and_sum_costs(&p), least_total_by_enumeration(&p, 0, 0));
    }
}

/*
 * --- problems by hand --------------------------------------------------------------------------
 */

static void two_rows_are_assigned_for_the_least_total_cost(void **state)
{
    (void)state;
    begin_problem(2, 2);
    add_pair(0, 0, -10);
    add_pair(0, 1, -9);
    add_pair(1, 0, -8);
    rho_assignment_solve(&assignment);
    assert_int_equal(column_of_row(0), 1);
    assert_int_equal(column_of_row(1), 0);
}

/* Row 0 has only column 0 and leaves it to row 1, whose cost there is less. */
static void a_row_stays_unassigned_if_the_total_cost_is_less(void **state)
{
    (void)state;
    begin_problem(2, 1);
    add_pair(0, 0, -5);
    add_pair(1, 0, -6);
    rho_assignment_solve(&assignment);
    assert_int_equal(column_of_row(0), RHO_ASSIGNMENT_NONE);
    assert_int_equal(column_of_row(1), 0);
}

static void ties_go_to_the_first_row_and_column(void **state)
{
    (void)state;
    begin_problem(3, 2);
    for (unsigned i = 0; i < 3; ++i) {
        add_pair(i, 1, -7);
        add_pair(i, 0, -7);
    }
    rho_assignment_solve(&assignment);
    assert_int_equal(column_of_row(0), 0);
    assert_int_equal(column_of_row(1), 1);
    assert_int_equal(column_of_row(2), RHO_ASSIGNMENT_NONE);
}

/*
 * Each row prefers the column of its own number; the last row takes column 0 and moves all others.
 */
static void one_new_row_moves_a_long_chain_of_rows(void **state)
{
    const unsigned n = RHO_MAX_TRACKS < RHO_MAX_PLOTS ? RHO_MAX_TRACKS : RHO_MAX_PLOTS;

    (void)state;
    begin_problem(n, n);
    for (unsigned i = 0; i + 1 < n; ++i) {
        add_pair(i, i, -100000);
        add_pair(i, i + 1, -99999);
    }
    add_pair(n - 1, 0, -1000000);
    rho_assignment_solve(&assignment);
    for (unsigned i = 0; i + 1 < n; ++i) {
        assert_int_equal(column_of_row(i), i + 1);
    }
    assert_int_equal(column_of_row(n - 1), 0);
}

static void problems_without_useful_pairs_assign_nothing(void **state)
{
    (void)state;
    begin_problem(0, 0);
    rho_assignment_solve(&assignment);
    assert_int_equal(column_of_row(0), RHO_ASSIGNMENT_NONE);
    begin_problem(3, 0);
    rho_assignment_solve(&assignment);
    assert_int_equal(column_of_row(2), RHO_ASSIGNMENT_NONE);
    begin_problem(2, 2);
    add_pair(0, 0, 0);
    add_pair(1, 1, RHO_ASSIGNMENT_COST_MAX);
    rho_assignment_solve(&assignment);
    assert_int_equal(column_of_row(0), RHO_ASSIGNMENT_NONE);
    assert_int_equal(column_of_row(1), RHO_ASSIGNMENT_NONE);
}

static void a_new_problem_forgets_the_last_one(void **state)
{
    (void)state;
    begin_problem(2, 2);
    add_pair(0, 0, -5);
    add_pair(1, 0, -9);
    rho_assignment_solve(&assignment);
    begin_problem(2, 2);
    assert_int_equal(column_of_row(0), RHO_ASSIGNMENT_NONE);
    assert_int_equal(column_of_row(1), RHO_ASSIGNMENT_NONE);
    add_pair(0, 0, -5);
    rho_assignment_solve(&assignment);
    assert_int_equal(column_of_row(0), 0);
    assert_int_equal(column_of_row(1), RHO_ASSIGNMENT_NONE);
    add_pair(1, 0, -6); /* a pair is added after a solve, and the problem is solved twice more */
    rho_assignment_solve(&assignment);
    rho_assignment_solve(&assignment);
    assert_int_equal(column_of_row(0), RHO_ASSIGNMENT_NONE);
    assert_int_equal(column_of_row(1), 0);
}

/* --- capacity ------------------------------------------------------------------------------ */

static void a_full_row_drops_its_most_expensive_pairs(void **state)
{
    const unsigned more = 3, n = RHO_MAX_GATE_PLOTS + more;

    (void)state;
    begin_problem(1, n);
    for (unsigned j = 0; j < n; ++j) { /* costs fall: each new pair stays */
        add_pair(0, j, -(int32_t)(10 + j));
    }
    assert_int_equal(assignment.pairs_dropped, more);
    assert_int_equal(assignment.num_pairs[0], RHO_MAX_GATE_PLOTS);
    rho_assignment_solve(&assignment);
    assert_int_equal(column_of_row(0), n - 1);
    begin_problem(1, n);
    assert_int_equal(assignment.pairs_dropped, 0);
    for (unsigned j = 0; j < n; ++j) { /* costs rise: each new pair is dropped */
        add_pair(0, j, -(int32_t)(1000 - j));
    }
    assert_int_equal(assignment.pairs_dropped, more);
    for (unsigned j = 0; j < RHO_MAX_GATE_PLOTS; ++j) {
        assert_int_equal(assignment.pairs[0][j].column, j);
    }
}

/* Of pairs with equal costs the highest columns are dropped, whatever the order of adding. */
static void a_full_row_keeps_the_lower_columns_of_equal_costs(void **state)
{
    const unsigned n = RHO_MAX_GATE_PLOTS + 2;
    uint64_t kept = 0;

    (void)state;
    begin_problem(1, n);
    for (unsigned k = 0; k < n; ++k) {
        add_pair(0, n - 1 - k, -5);
    }
    assert_int_equal(assignment.pairs_dropped, 2);
    for (unsigned i = 0; i < RHO_MAX_GATE_PLOTS; ++i) {
        kept |= UINT64_C(1) << assignment.pairs[0][i].column;
    }
    assert_int_equal(kept, (UINT64_C(1) << RHO_MAX_GATE_PLOTS) - 1);
}

static void the_count_of_dropped_pairs_saturates(void **state)
{
    (void)state;
    begin_problem(1, RHO_MAX_GATE_PLOTS + 1);
    for (unsigned j = 0; j < RHO_MAX_GATE_PLOTS; ++j) {
        add_pair(0, j, -5);
    }
    assignment.pairs_dropped = UINT32_MAX;
    add_pair(0, RHO_MAX_GATE_PLOTS, -4);
    assert_int_equal(assignment.pairs_dropped, UINT32_MAX);
}

/* As when a track ends and the last row takes its place: the pairs move with it. */
static void pairs_of_a_row_are_moved_to_another_row(void **state)
{
    (void)state;
    begin_problem(3, 4);
    add_pair(0, 1, -5);
    add_pair(1, 2, -6);
    add_pair(1, 3, -7);
    rho_assignment_move_pairs(&assignment, 1, 0);
    assert_int_equal(assignment.num_pairs[0], 2);
    assert_int_equal(assignment.pairs[0][1].column, 3);
    assert_int_equal(assignment.pairs[0][1].cost, -7);
    assert_int_equal(assignment.num_pairs[1], 0);
    rho_assignment_move_pairs(&assignment, 0, 0);
    rho_assignment_move_pairs(&assignment, 3, 0); /* row 3 does not exist */
    rho_assignment_move_pairs(&assignment, 0, 3);
    assert_int_equal(assignment.num_pairs[0], 2);
}

/*
 * --- problems of full size ----------------------------------------------------------------------
 */

static void add_pairs_of_full_problem(void)
{
    begin_problem(RHO_MAX_TRACKS, RHO_MAX_PLOTS);
    for (unsigned i = 0; i < RHO_MAX_TRACKS; ++i) {
        const unsigned reach = RHO_MAX_TRACKS / 2 + 2; /* half as many columns as rows */

        for (unsigned k = 0; k < RHO_MAX_GATE_PLOTS; ++k) {
            const unsigned near = (i / 2 + next_random(12)) % reach % RHO_MAX_PLOTS;
            const int32_t cost = -(int32_t)(1 + next_random(9000));

            /* A column drawn twice for a row is refused: the row has one pair fewer. */
            const enum rho_status status = rho_assignment_offer_pair(&assignment, i, near, cost);
            assert_true(status == RHO_OK || status == RHO_ERROR_VALUE);
        }
    }
}

/*
 * Optimality by duality (Kuhn and Munkres): at the final prices no row has a pair of less reduced
 * cost than its own, and unassigned columns have the price 0.
 */
static void assert_assignment_is_optimal(void)
{
    for (unsigned j = 0; j < assignment.num_columns; ++j) {
        assert_true(assignment.column_price[j] <= 0);
        assert_true(assignment.column_row[j] >= 0 || assignment.column_price[j] == 0);
    }
    for (unsigned i = 0; i < assignment.num_rows; ++i) {
        int32_t gain = 0, least = 0;

        for (unsigned k = 0; k < assignment.num_pairs[i]; ++k) {
            const struct rho_assignment_pair *pair = &assignment.pairs[i][k];
            const int32_t reduced = pair->cost - assignment.column_price[pair->column];

            least = reduced < least ? reduced : least;
            gain = pair->column == column_of_row(i) ? reduced : gain;
        }
        assert_int_equal(gain, least);
        assert_true(column_of_row(i) == RHO_ASSIGNMENT_NONE ||
                    assignment.column_row[column_of_row(i)] == (int)i);
    }
}

static void a_problem_of_full_size_is_solved_exactly(void **state)
{
    (void)state;
    for (int k = 0; k < 5; ++k) {
        add_pairs_of_full_problem();
        rho_assignment_solve(&assignment);
        assert_assignment_is_optimal();
    }
}

static void the_same_input_gives_the_same_answer(void **state)
{
    int16_t answers[RHO_MAX_TRACKS];

    (void)state;
    add_pairs_of_full_problem();
    rho_assignment_solve(&assignment);
    memcpy(answers, assignment.row_column, sizeof answers);
    memset(&assignment, 0xa5, sizeof assignment);
    initialise(NULL);
    add_pairs_of_full_problem();
    rho_assignment_solve(&assignment);
    assert_memory_equal(answers, assignment.row_column, sizeof answers);
}

/* --- refusals ------------------------------------------------------------------------------ */

static struct rho_assignment before;

static void refused_init_changes_nothing(void **state)
{
    (void)state;
    memset(&assignment, 0xa5, sizeof assignment);
    before = assignment;
    assert_int_equal(rho_assignment_init(&assignment, sizeof assignment - 1), RHO_ERROR_SIZE);
    assert_int_equal(rho_assignment_init(&assignment, 0), RHO_ERROR_SIZE);
    assert_memory_equal(&assignment, &before, sizeof before);
}

static void refused_sizes_change_nothing(void **state)
{
    (void)state;
    begin_problem(2, 2);
    add_pair(0, 0, -5);
    before = assignment;
    assert_int_equal(rho_assignment_begin(&assignment, RHO_MAX_TRACKS + 1, 1), RHO_ERROR_CAPACITY);
    assert_int_equal(rho_assignment_begin(&assignment, 1, RHO_MAX_PLOTS + 1), RHO_ERROR_CAPACITY);
    assert_int_equal(rho_assignment_begin(&assignment, UINT32_MAX, UINT32_MAX), RHO_ERROR_CAPACITY);
    assert_int_equal(rho_assignment_begin(&assignment, 65536, 65536), RHO_ERROR_CAPACITY);
    assert_memory_equal(&assignment, &before, sizeof before);
}

static void refused_pairs_change_nothing(void **state)
{
    const int32_t too_large = RHO_ASSIGNMENT_COST_MAX + 1;

    (void)state;
    begin_problem(2, 3);
    add_pair(0, 0, -5);
    before = assignment;
    assert_int_equal(rho_assignment_offer_pair(&assignment, 2, 0, -1), RHO_ERROR_VALUE);
    assert_int_equal(rho_assignment_offer_pair(&assignment, UINT32_MAX, 0, -1), RHO_ERROR_VALUE);
    assert_int_equal(rho_assignment_offer_pair(&assignment, 0, 3, -1), RHO_ERROR_VALUE);
    assert_int_equal(rho_assignment_offer_pair(&assignment, 0, 65536, -1), RHO_ERROR_VALUE);
    assert_int_equal(rho_assignment_offer_pair(&assignment, 0, UINT32_MAX, -1), RHO_ERROR_VALUE);
    assert_int_equal(rho_assignment_offer_pair(&assignment, 1, 1, too_large), RHO_ERROR_VALUE);
    assert_int_equal(rho_assignment_offer_pair(&assignment, 1, 1, -too_large), RHO_ERROR_VALUE);
    assert_int_equal(rho_assignment_offer_pair(&assignment, 1, 1, INT32_MIN), RHO_ERROR_VALUE);
    assert_int_equal(rho_assignment_offer_pair(&assignment, 1, 1, INT32_MAX), RHO_ERROR_VALUE);
    /* the pair exists */
    assert_int_equal(rho_assignment_offer_pair(&assignment, 0, 0, -9), RHO_ERROR_VALUE);
    /* a pair of cost 0 is ignored */
    assert_int_equal(rho_assignment_offer_pair(&assignment, 1, 1, 0), RHO_OK);
    assert_memory_equal(&assignment, &before, sizeof before);
    add_pair(1, 1, -RHO_ASSIGNMENT_COST_MAX);
    rho_assignment_solve(&assignment);
    assert_int_equal(column_of_row(1), 1);
    assert_int_equal(column_of_row(2), RHO_ASSIGNMENT_NONE);
    assert_int_equal(column_of_row(UINT32_MAX), RHO_ASSIGNMENT_NONE);
}

static void only_initialised_memory_is_ready(void **state)
{
    static struct rho_assignment other;

    (void)state;
    assert_true(rho_assignment_is_ready(&assignment));
    assert_false(rho_assignment_is_ready(&other));
    memset(&other, 0x5a, sizeof other);
    assert_false(rho_assignment_is_ready(&other));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(small_problems_are_solved_exactly, initialise),
        cmocka_unit_test_setup(small_problems_full_of_ties_are_solved_exactly, initialise),
        cmocka_unit_test_setup(small_problems_with_the_largest_costs_are_solved_exactly,
                               initialise),
        cmocka_unit_test_setup(two_rows_are_assigned_for_the_least_total_cost, initialise),
        cmocka_unit_test_setup(a_row_stays_unassigned_if_the_total_cost_is_less, initialise),
        cmocka_unit_test_setup(ties_go_to_the_first_row_and_column, initialise),
        cmocka_unit_test_setup(one_new_row_moves_a_long_chain_of_rows, initialise),
        cmocka_unit_test_setup(problems_without_useful_pairs_assign_nothing, initialise),
        cmocka_unit_test_setup(a_new_problem_forgets_the_last_one, initialise),
        cmocka_unit_test_setup(a_full_row_drops_its_most_expensive_pairs, initialise),
        cmocka_unit_test_setup(a_full_row_keeps_the_lower_columns_of_equal_costs, initialise),
        cmocka_unit_test_setup(the_count_of_dropped_pairs_saturates, initialise),
        cmocka_unit_test_setup(pairs_of_a_row_are_moved_to_another_row, initialise),
        cmocka_unit_test_setup(a_problem_of_full_size_is_solved_exactly, initialise),
        cmocka_unit_test_setup(the_same_input_gives_the_same_answer, initialise),
        cmocka_unit_test_setup(refused_init_changes_nothing, initialise),
        cmocka_unit_test_setup(refused_sizes_change_nothing, initialise),
        cmocka_unit_test_setup(refused_pairs_change_nothing, initialise),
        cmocka_unit_test_setup(only_initialised_memory_is_ready, initialise),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
