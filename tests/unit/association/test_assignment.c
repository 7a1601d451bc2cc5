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

/* Numerical Recipes' generator: the tests' own, so that every machine tries the same problems. */
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

static void begin(unsigned num_rows, unsigned num_columns)
{
    assert_int_equal(rho_assignment_begin(&assignment, num_rows, num_columns), RHO_OK);
}

static void add(unsigned row, unsigned column, int32_t cost)
{
    assert_int_equal(rho_assignment_offer_pair(&assignment, row, column, cost), RHO_OK);
}

static int answer(unsigned row)
{
    return rho_assignment_column(&assignment, row);
}

/* --- against all possibilities ------------------------------------------------------------- */

struct problem {
    unsigned num_rows, num_columns;
    int32_t cost[SMALL_MAX][SMALL_MAX]; /* NO_PAIR where there is none */
};

static int64_t least_total(const struct problem *p, unsigned row, unsigned used)
{
    int64_t least;

    if (row == p->num_rows) {
        return 0;
    }
    least = least_total(p, row + 1, used);
    for (unsigned column = 0; column < p->num_columns; ++column) {
        if (p->cost[row][column] < 0 && !(used & 1u << column)) {
            const int64_t total =
                p->cost[row][column] + least_total(p, row + 1, used | 1u << column);

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

static void pose(const struct problem *p, int is_reversed)
{
    begin(p->num_rows, p->num_columns);
    for (unsigned i = 0; i < p->num_rows; ++i) {
        for (unsigned k = 0; k < p->num_columns; ++k) {
            const unsigned j = is_reversed ? p->num_columns - 1 - k : k;

            if (p->cost[i][j] < 0) {
                add(i, j, p->cost[i][j]);
            }
        }
    }
}

/* Checks that the answer is one, and returns its total. */
static int64_t total_of_answer(const struct problem *p)
{
    unsigned used = 0;
    int64_t total = 0;

    for (unsigned i = 0; i < p->num_rows; ++i) {
        const int column = answer(i);

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

static void check_problems(int count, uint32_t cost_max, uint32_t density_percent)
{
    for (int k = 0; k < count; ++k) {
        const struct problem p = random_problem(cost_max, density_percent);
        int columns[SMALL_MAX];

        pose(&p, 0);
        rho_assignment_solve(&assignment);
        assert_int_equal(total_of_answer(&p), least_total(&p, 0, 0));
        for (unsigned i = 0; i < p.num_rows; ++i) {
            columns[i] = answer(i);
        }
        pose(&p, 1); /* the order of a row's pairs decides nothing */
        rho_assignment_solve(&assignment);
        for (unsigned i = 0; i < p.num_rows; ++i) {
            assert_int_equal(answer(i), columns[i]);
        }
    }
}

static void small_problems_are_solved_exactly(void **state)
{
    (void)state;
    check_problems(2000, 10000, 90);
    check_problems(2000, 10000, 40);
}

static void small_problems_full_of_ties(void **state)
{
    (void)state;
    check_problems(2000, 1, 60);
    check_problems(2000, 3, 70);
    check_problems(1000, 2, 100);
}

static void small_problems_with_the_largest_costs(void **state)
{
    (void)state;
    check_problems(2000, RHO_ASSIGNMENT_COST_MAX, 80);
    for (int k = 0; k < 500; ++k) { /* all of nearly the same, largest size: long paths */
        struct problem p = random_problem(5, 100);

        for (unsigned i = 0; i < SMALL_MAX * SMALL_MAX; ++i) {
            p.cost[i / SMALL_MAX][i % SMALL_MAX] -= RHO_ASSIGNMENT_COST_MAX - 5;
        }
        pose(&p, 0);
        rho_assignment_solve(&assignment);
        assert_int_equal(total_of_answer(&p), least_total(&p, 0, 0));
    }
}

/* --- by hand ------------------------------------------------------------------------------- */

static void two_rows_share_by_total(void **state)
{
    (void)state;
    begin(2, 2);
    add(0, 0, -10);
    add(0, 1, -9);
    add(1, 0, -8);
    rho_assignment_solve(&assignment);
    assert_int_equal(answer(0), 1);
    assert_int_equal(answer(1), 0);
}

/* Row 0 had the column first and gives it up: it has no other. */
static void a_row_goes_without_for_the_better_total(void **state)
{
    (void)state;
    begin(2, 1);
    add(0, 0, -5);
    add(1, 0, -6);
    rho_assignment_solve(&assignment);
    assert_int_equal(answer(0), RHO_ASSIGNMENT_NONE);
    assert_int_equal(answer(1), 0);
}

static void equals_go_to_the_first_row_and_column(void **state)
{
    (void)state;
    begin(3, 2);
    for (unsigned i = 0; i < 3; ++i) {
        add(i, 1, -7);
        add(i, 0, -7);
    }
    rho_assignment_solve(&assignment);
    assert_int_equal(answer(0), 0);
    assert_int_equal(answer(1), 1);
    assert_int_equal(answer(2), RHO_ASSIGNMENT_NONE);
}

/* Each row prefers its left neighbour's column; the last row pushes all others along. */
static void a_long_chain_moves_as_one(void **state)
{
    const unsigned n = RHO_MAX_TRACKS < RHO_MAX_PLOTS ? RHO_MAX_TRACKS : RHO_MAX_PLOTS;

    (void)state;
    begin(n, n);
    for (unsigned i = 0; i + 1 < n; ++i) {
        add(i, i, -100000);
        add(i, i + 1, -99999);
    }
    add(n - 1, 0, -1000000);
    rho_assignment_solve(&assignment);
    for (unsigned i = 0; i + 1 < n; ++i) {
        assert_int_equal(answer(i), i + 1);
    }
    assert_int_equal(answer(n - 1), 0);
}

static void problems_without_pairs(void **state)
{
    (void)state;
    begin(0, 0);
    rho_assignment_solve(&assignment);
    assert_int_equal(answer(0), RHO_ASSIGNMENT_NONE);
    begin(3, 0);
    rho_assignment_solve(&assignment);
    assert_int_equal(answer(2), RHO_ASSIGNMENT_NONE);
    begin(2, 2);
    add(0, 0, 0);
    add(1, 1, RHO_ASSIGNMENT_COST_MAX);
    rho_assignment_solve(&assignment);
    assert_int_equal(answer(0), RHO_ASSIGNMENT_NONE);
    assert_int_equal(answer(1), RHO_ASSIGNMENT_NONE);
}

static void a_problem_starts_afresh(void **state)
{
    (void)state;
    begin(2, 2);
    add(0, 0, -5);
    add(1, 0, -9);
    rho_assignment_solve(&assignment);
    begin(2, 2);
    assert_int_equal(answer(0), RHO_ASSIGNMENT_NONE);
    assert_int_equal(answer(1), RHO_ASSIGNMENT_NONE);
    add(0, 0, -5);
    rho_assignment_solve(&assignment);
    assert_int_equal(answer(0), 0);
    assert_int_equal(answer(1), RHO_ASSIGNMENT_NONE);
    add(1, 0, -6); /* more pairs after a solve, and solved again */
    rho_assignment_solve(&assignment);
    rho_assignment_solve(&assignment);
    assert_int_equal(answer(0), RHO_ASSIGNMENT_NONE);
    assert_int_equal(answer(1), 0);
}

/* --- capacity ------------------------------------------------------------------------------ */

static void the_dearest_pairs_of_a_full_row_give_way(void **state)
{
    const unsigned more = 3, n = RHO_MAX_GATE_PLOTS + more;

    (void)state;
    begin(1, n);
    for (unsigned j = 0; j < n; ++j) { /* ever cheaper: each newcomer stays */
        add(0, j, -(int32_t)(10 + j));
    }
    assert_int_equal(assignment.pairs_dropped, more);
    assert_int_equal(assignment.num_pairs[0], RHO_MAX_GATE_PLOTS);
    rho_assignment_solve(&assignment);
    assert_int_equal(answer(0), n - 1);
    begin(1, n);
    assert_int_equal(assignment.pairs_dropped, 0);
    for (unsigned j = 0; j < n; ++j) { /* ever dearer: each newcomer is dropped */
        add(0, j, -(int32_t)(1000 - j));
    }
    assert_int_equal(assignment.pairs_dropped, more);
    for (unsigned j = 0; j < RHO_MAX_GATE_PLOTS; ++j) {
        assert_int_equal(assignment.pairs[0][j].column, j);
    }
}

/* Of equal costs the higher column goes, in whatever order they come. */
static void ties_of_a_full_row_go_by_column(void **state)
{
    const unsigned n = RHO_MAX_GATE_PLOTS + 2;
    uint64_t kept = 0;

    (void)state;
    begin(1, n);
    for (unsigned k = 0; k < n; ++k) {
        add(0, n - 1 - k, -5);
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
    begin(1, RHO_MAX_GATE_PLOTS + 1);
    for (unsigned j = 0; j < RHO_MAX_GATE_PLOTS; ++j) {
        add(0, j, -5);
    }
    assignment.pairs_dropped = UINT32_MAX;
    add(0, RHO_MAX_GATE_PLOTS, -4);
    assert_int_equal(assignment.pairs_dropped, UINT32_MAX);
}

/* A row that has gone: those behind it move up, and their pairs with them. */
static void pairs_move_to_another_row(void **state)
{
    (void)state;
    begin(3, 4);
    add(0, 1, -5);
    add(1, 2, -6);
    add(1, 3, -7);
    rho_assignment_move_pairs(&assignment, 1, 0);
    assert_int_equal(assignment.num_pairs[0], 2);
    assert_int_equal(assignment.pairs[0][1].column, 3);
    assert_int_equal(assignment.pairs[0][1].cost, -7);
    assert_int_equal(assignment.num_pairs[1], 0);
    rho_assignment_move_pairs(&assignment, 0, 0);
    rho_assignment_move_pairs(&assignment, 3, 0); /* no such row */
    rho_assignment_move_pairs(&assignment, 0, 3);
    assert_int_equal(assignment.num_pairs[0], 2);
}

/* --- a full object ------------------------------------------------------------------------- */

static void pose_full_problem(void)
{
    begin(RHO_MAX_TRACKS, RHO_MAX_PLOTS);
    for (unsigned i = 0; i < RHO_MAX_TRACKS; ++i) {
        const unsigned reach = RHO_MAX_TRACKS / 2 + 2; /* columns are scarce: half the rows */

        for (unsigned k = 0; k < RHO_MAX_GATE_PLOTS; ++k) {
            const unsigned near = (i / 2 + next_random(12)) % reach % RHO_MAX_PLOTS;
            const int32_t cost = -(int32_t)(1 + next_random(9000));

            /* Twice the same column is refused: as good as one pair fewer. */
            const enum rho_status status = rho_assignment_offer_pair(&assignment, i, near, cost);
            assert_true(status == RHO_OK || status == RHO_ERROR_VALUE);
        }
    }
}

/*
 * Optimality by duality (Kuhn and Munkres): at the final prices no row would rather have another
 * column of its own, or none, and a column that nobody has costs nothing.
 */
static void assert_optimal(void)
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
            gain = pair->column == answer(i) ? reduced : gain;
        }
        assert_int_equal(gain, least);
        assert_true(answer(i) == RHO_ASSIGNMENT_NONE || assignment.column_row[answer(i)] == (int)i);
    }
}

static void a_full_object_is_solved_exactly(void **state)
{
    (void)state;
    for (int k = 0; k < 5; ++k) {
        pose_full_problem();
        rho_assignment_solve(&assignment);
        assert_optimal();
    }
}

static void the_same_input_gives_the_same_answer(void **state)
{
    int16_t answers[RHO_MAX_TRACKS];

    (void)state;
    pose_full_problem();
    rho_assignment_solve(&assignment);
    memcpy(answers, assignment.row_column, sizeof answers);
    memset(&assignment, 0xa5, sizeof assignment);
    initialise(NULL);
    pose_full_problem();
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
    assert_int_equal(rho_assignment_init(NULL, sizeof assignment), RHO_ERROR_NULL);
    assert_int_equal(rho_assignment_init(&assignment, sizeof assignment - 1), RHO_ERROR_SIZE);
    assert_int_equal(rho_assignment_init(&assignment, 0), RHO_ERROR_SIZE);
    assert_memory_equal(&assignment, &before, sizeof before);
}

static void an_object_without_init_is_refused(void **state)
{
    (void)state;
    for (int filling = 0; filling <= 0xff; filling += 0x55) {
        memset(&assignment, filling, sizeof assignment);
        before = assignment;
        assert_int_equal(rho_assignment_begin(&assignment, 1, 1), RHO_ERROR_STATE);
        assert_int_equal(rho_assignment_offer_pair(&assignment, 0, 0, -1), RHO_ERROR_STATE);
        rho_assignment_solve(&assignment);
        assert_int_equal(answer(0), RHO_ASSIGNMENT_NONE);
        assert_memory_equal(&assignment, &before, sizeof before);
    }
}

static void null_is_refused(void **state)
{
    (void)state;
    assert_int_equal(rho_assignment_begin(NULL, 1, 1), RHO_ERROR_NULL);
    assert_int_equal(rho_assignment_offer_pair(NULL, 0, 0, -1), RHO_ERROR_NULL);
    rho_assignment_solve(NULL);
    assert_int_equal(rho_assignment_column(NULL, 0), RHO_ASSIGNMENT_NONE);
}

static void refused_sizes_change_nothing(void **state)
{
    (void)state;
    begin(2, 2);
    add(0, 0, -5);
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
    begin(2, 3);
    add(0, 0, -5);
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
    assert_int_equal(rho_assignment_offer_pair(&assignment, 0, 0, -9),
                     RHO_ERROR_VALUE);                                         /* has it */
    assert_int_equal(rho_assignment_offer_pair(&assignment, 1, 1, 0), RHO_OK); /* ignored */
    assert_memory_equal(&assignment, &before, sizeof before);
    add(1, 1, -RHO_ASSIGNMENT_COST_MAX);
    rho_assignment_solve(&assignment);
    assert_int_equal(answer(1), 1);
    assert_int_equal(answer(2), RHO_ASSIGNMENT_NONE);
    assert_int_equal(answer(UINT32_MAX), RHO_ASSIGNMENT_NONE);
}

static void memory_is_an_object_once_it_is_initialised(void **state)
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
        cmocka_unit_test_setup(small_problems_full_of_ties, initialise),
        cmocka_unit_test_setup(small_problems_with_the_largest_costs, initialise),
        cmocka_unit_test_setup(two_rows_share_by_total, initialise),
        cmocka_unit_test_setup(a_row_goes_without_for_the_better_total, initialise),
        cmocka_unit_test_setup(equals_go_to_the_first_row_and_column, initialise),
        cmocka_unit_test_setup(a_long_chain_moves_as_one, initialise),
        cmocka_unit_test_setup(problems_without_pairs, initialise),
        cmocka_unit_test_setup(a_problem_starts_afresh, initialise),
        cmocka_unit_test_setup(the_dearest_pairs_of_a_full_row_give_way, initialise),
        cmocka_unit_test_setup(ties_of_a_full_row_go_by_column, initialise),
        cmocka_unit_test_setup(the_count_of_dropped_pairs_saturates, initialise),
        cmocka_unit_test_setup(pairs_move_to_another_row, initialise),
        cmocka_unit_test_setup(a_full_object_is_solved_exactly, initialise),
        cmocka_unit_test_setup(the_same_input_gives_the_same_answer, initialise),
        cmocka_unit_test_setup(refused_init_changes_nothing, initialise),
        cmocka_unit_test_setup(an_object_without_init_is_refused, initialise),
        cmocka_unit_test_setup(null_is_refused, initialise),
        cmocka_unit_test_setup(refused_sizes_change_nothing, initialise),
        cmocka_unit_test_setup(refused_pairs_change_nothing, initialise),
        cmocka_unit_test_setup(memory_is_an_object_once_it_is_initialised, initialise),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
