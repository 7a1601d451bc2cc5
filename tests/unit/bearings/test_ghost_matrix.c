/* SPDX-License-Identifier: MIT */
/*
 * The ghost matrix: the paper's pruning steps by hand, and shares of ghosts and targets that
 * pruning removes in many simulated scans.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/detail/ghost_matrix.h"

#define PI 3.14159265358979323846
#define DEG_RAD (PI / 180.0)
#define RANGE_MAX_M 100000.0f
#define TARGETS_MAX 6

static uint64_t random_state = 7;

static double uniform(double from, double to)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return from + (to - from) * (double)(random_state >> 11) / 9007199254740992.0;
}

static double normal(void)
{
    return sqrt(-2.0 * log(uniform(1e-12, 1.0))) * cos(uniform(0.0, 2.0 * PI));
}

static struct rho_crossing_base base;
static struct rho_ghost_matrix matrix;

static void set_paper_base(void) /* sensors at (0, +-10 km), as in the paper */
{
    assert_int_equal(rho_crossing_set_base(&base, 0.0f, -10e3f, 0.0f, 10e3f), RHO_OK);
}

/* Sets the matrix from rows of text: '1' is a crossing, '0' is none. */
static void set_matrix(unsigned rows, unsigned columns, const char *const *text)
{
    memset(&matrix, 0, sizeof matrix);
    matrix.rows = (uint16_t)rows;
    matrix.columns = (uint16_t)columns;
    for (unsigned i = 0; i < rows; i++) {
        for (unsigned j = 0; j < columns; j++) {
            matrix.reason[i][j] = text[i][j] == '1' ? RHO_GHOST_KEPT : RHO_GHOST_RANGE;
            matrix.delta_rad[i][j] = text[i][j] == '1' ? 0.1f : 0.0f;
        }
    }
}

static void expect_reasons(const char *const *text)
{
    static const char letters[RHO_NUM_GHOST_REASONS] = {'1', 's', 'a', '0', 'r', 'c', 'u'};
    for (unsigned i = 0; i < matrix.rows; i++) {
        for (unsigned j = 0; j < matrix.columns; j++) {
            assert_int_equal(letters[matrix.reason[i][j]], text[i][j]);
            assert_int_equal(matrix.delta_rad[i][j] > 0.0f, text[i][j] == '1');
        }
    }
}

static void a_rows_only_crossing_removes_the_others_of_its_column(void **state)
{
    (void)state;
    set_matrix(2, 2, (const char *const[]){"10", "11"});
    assert_int_equal(rho_ghost_prune(&matrix, RHO_GHOST_LITERAL), 1);
    expect_reasons((const char *const[]){"10", "r1"});
}

static void removals_leave_further_rows_with_one_crossing(void **state)
{
    (void)state;
    set_matrix(3, 3, (const char *const[]){"111", "110", "100"});
    assert_int_equal(rho_ghost_prune(&matrix, RHO_GHOST_LITERAL), 3);
    expect_reasons((const char *const[]){"rr1", "r10", "100"});
}

static void columns_with_one_crossing_are_pruned_after_rows(void **state)
{
    (void)state;
    set_matrix(2, 3, (const char *const[]){"110", "111"});
    assert_int_equal(rho_ghost_prune(&matrix, RHO_GHOST_LITERAL), 3);
    expect_reasons((const char *const[]){"1c0", "cc1"});
}

static void without_single_crossings_nothing_is_removed(void **state)
{
    (void)state;
    set_matrix(2, 2, (const char *const[]){"11", "11"});
    assert_int_equal(rho_ghost_prune(&matrix, RHO_GHOST_LITERAL), 0);
    assert_int_equal(rho_ghost_prune(&matrix, RHO_GHOST_SAFE), 0);
    expect_reasons((const char *const[]){"11", "11"});
}

/* Rows 0 and 1 have only column 0: the literal rule gives it to row 0, the safe rule keeps both. */
static void of_two_beams_with_one_crossing_the_literal_rule_keeps_the_first(void **state)
{
    (void)state;
    set_matrix(2, 2, (const char *const[]){"10", "10"});
    assert_int_equal(rho_ghost_prune(&matrix, RHO_GHOST_LITERAL), 1);
    expect_reasons((const char *const[]){"10", "r0"});
    set_matrix(2, 2, (const char *const[]){"10", "10"});
    assert_int_equal(rho_ghost_prune(&matrix, RHO_GHOST_SAFE), 0);
    expect_reasons((const char *const[]){"10", "10"});
}

static void the_safe_rule_prunes_square_matrices_only(void **state)
{
    (void)state;
    set_matrix(2, 3, (const char *const[]){"110", "111"});
    assert_int_equal(rho_ghost_prune(&matrix, RHO_GHOST_SAFE), 0);
    set_matrix(3, 3, (const char *const[]){"111", "110", "100"});
    assert_int_equal(rho_ghost_prune(&matrix, RHO_GHOST_SAFE), 3);
    expect_reasons((const char *const[]){"uu1", "u10", "100"});
    set_matrix(3, 3, (const char *const[]){"111", "110", "100"});
    assert_int_equal(rho_ghost_prune(&matrix, RHO_GHOST_NO_RULE), 0);
    expect_reasons((const char *const[]){"111", "110", "100"});
}

/*
 * Two rows share the first two columns: no row has a single crossing, but the third row's must be
 * column 2.
 */
static void the_safe_rule_prunes_by_matchings_without_single_crossings(void **state)
{
    (void)state;
    set_matrix(3, 3, (const char *const[]){"110", "110", "111"});
    assert_int_equal(rho_ghost_prune(&matrix, RHO_GHOST_SAFE), 2);
    expect_reasons((const char *const[]){"110", "110", "uu1"});
    set_matrix(3, 3, (const char *const[]){"110", "110", "110"});
    assert_int_equal(rho_ghost_prune(&matrix, RHO_GHOST_SAFE), 0);
}

/*
 * Marks in `found` the crossings of all complete matchings of the rows from i with the columns in
 * `left`; returns their number.
 */
static unsigned add_matchings(unsigned i, unsigned left, uint16_t found[])
{
    unsigned matchings = 0;
    if (i == matrix.rows) {
        return 1;
    }
    for (unsigned j = 0; j < matrix.columns; j++) {
        if ((left >> j & 1u) && matrix.reason[i][j] == RHO_GHOST_KEPT) {
            const unsigned more = add_matchings(i + 1, left & ~(1u << j), found);
            found[i] |= (uint16_t)((more > 0) << j);
            matchings += more;
        }
    }
    return matchings;
}

static void draw_random_matrix(unsigned size, double share)
{
    memset(&matrix, 0, sizeof matrix);
    matrix.rows = matrix.columns = (uint16_t)size;
    for (unsigned i = 0; i < size; i++) {
        for (unsigned j = 0; j < size; j++) {
            const int meets = uniform(0.0, 1.0) < share;
            matrix.reason[i][j] = meets ? RHO_GHOST_KEPT : RHO_GHOST_APART;
            matrix.delta_rad[i][j] = meets ? 0.1f : 0.0f;
        }
    }
}

/* Compared with all complete matchings, enumerated. */
static void the_safe_rule_keeps_all_crossings_of_complete_matchings(void **state)
{
    unsigned without = 0, removed = 0;
    (void)state;
    for (unsigned draw = 0; draw < 2000; draw++) {
        const unsigned size = 1 + draw % (RHO_MAX_BEARINGS < 7 ? RHO_MAX_BEARINGS : 7);
        uint16_t found[RHO_MAX_BEARINGS] = {0};
        draw_random_matrix(size, uniform(0.2, 0.9));
        const struct rho_ghost_matrix before = matrix;
        const unsigned matchings = add_matchings(0, (1u << size) - 1u, found);
        const unsigned now = rho_ghost_prune(&matrix, RHO_GHOST_SAFE);
        without += matchings == 0;
        removed += now;
        for (unsigned i = 0; i < size; i++) {
            for (unsigned j = 0; j < size; j++) {
                const int was_kept = before.reason[i][j] == RHO_GHOST_KEPT;
                const int is_kept = matrix.reason[i][j] == RHO_GHOST_KEPT;
                assert_int_equal(is_kept,
                                 matchings > 0 ? was_kept && (found[i] >> j & 1) : was_kept);
            }
        }
    }
    assert_in_range(without, 200, 1800);
    assert_true(removed > 500);
}

/*
 * Figure 1 of the paper: of the four crossings of two targets' beams, the two ghosts are removed.
 */
static void figure_1_of_the_paper_keeps_its_targets_alone(void **state)
{
    (void)state;
    const float near_m[2] = {30e3f, 0.0f}, far_m[2] = {60e3f, 25e3f};
    float a[2], b[2];
    set_paper_base();
    for (int i = 0; i < 2; i++) {
        const float *target = i ? far_m : near_m;
        a[i] = atan2f(target[1] + 10e3f, target[0]);
        b[i] = atan2f(target[1] - 10e3f, target[0]);
    }
    assert_int_equal(rho_ghost_fill(&matrix, &base, a, 2, b, 2, RANGE_MAX_M), RHO_OK);
    assert_int_equal(matrix.reason[0][0], RHO_GHOST_KEPT);
    assert_int_equal(matrix.reason[1][1], RHO_GHOST_KEPT);
    assert_float_equal(matrix.delta_rad[0][0], a[0] - b[0], 1e-6);
    rho_ghost_prune(&matrix, RHO_GHOST_LITERAL);
    assert_int_equal(matrix.reason[0][0], RHO_GHOST_KEPT);
    assert_int_equal(matrix.reason[1][1], RHO_GHOST_KEPT);
    assert_int_not_equal(matrix.reason[0][1], RHO_GHOST_KEPT);
    assert_int_not_equal(matrix.reason[1][0], RHO_GHOST_KEPT);
}

struct look {
    unsigned count;
    float bearing_rad[64];
    int target[64]; /* -1 for a false alarm */
};

struct scene {
    double x_m[TARGETS_MAX], y_m[TARGETS_MAX];
    unsigned targets;
    double pd, false_alarms;
};

/* Draws targets 20 to 75 km in front of the sensors, up to 50 km to either side. */
static void draw_targets(struct scene *scene)
{
    for (unsigned i = 0; i < scene->targets; i++) {
        do {
            scene->x_m[i] = uniform(20e3, 75e3);
            scene->y_m[i] = uniform(-50e3, 50e3);
        } while (hypot(scene->x_m[i], scene->y_m[i]) > 78e3);
    }
}

/* The literal rule depends on the order of bearings. */
static void shuffle_bearings(struct look *look)
{
    for (unsigned i = look->count; i > 1; i--) {
        unsigned j = (unsigned)uniform(0.0, i);
        float bearing_rad = look->bearing_rad[i - 1];
        int target = look->target[i - 1];
        look->bearing_rad[i - 1] = look->bearing_rad[j];
        look->target[i - 1] = look->target[j];
        look->bearing_rad[j] = bearing_rad;
        look->target[j] = target;
    }
}

static void draw_bearings_from(const struct scene *scene, double sensor_y_m, struct look *look)
{
    unsigned alarms = 0;
    look->count = 0;
    for (unsigned i = 0; i < scene->targets; i++) {
        if (uniform(0.0, 1.0) < scene->pd) {
            look->target[look->count] = (int)i;
            look->bearing_rad[look->count++] =
                (float)(atan2(scene->y_m[i] - sensor_y_m, scene->x_m[i]) +
                        0.1 * DEG_RAD * normal());
        }
    }
    for (double p = exp(-scene->false_alarms), at = uniform(0.0, 1.0), sum = p; at > sum;) {
        alarms++;
        p *= scene->false_alarms / alarms;
        sum += p;
    }
    for (unsigned i = 0; i < alarms; i++) {
        look->target[look->count] = -1;
        look->bearing_rad[look->count++] = (float)uniform(-0.5 * PI, 0.5 * PI);
    }
    shuffle_bearings(look);
}

struct shares {
    double ghosts_removed, targets_lost;
};

static void count_removed_crossings(const struct look *a, const struct look *b, double ghosts[2],
                                    double targets[2])
{
    for (unsigned i = 0; i < a->count; i++) {
        for (unsigned j = 0; j < b->count; j++) {
            double *of = a->target[i] >= 0 && a->target[i] == b->target[j] ? targets : ghosts;
            of[0] += 1.0;
            of[1] += matrix.reason[i][j] != RHO_GHOST_KEPT;
        }
    }
}

static struct shares shares_removed(unsigned targets, double pd, double false_alarms,
                                    enum rho_ghost_rule rule)
{
    struct scene scene = {.targets = targets, .pd = pd, .false_alarms = false_alarms};
    double ghosts[2] = {0}, seen[2] = {0};
    set_paper_base();
    for (int run = 0; run < 4000; run++) {
        struct look a, b;
        draw_targets(&scene);
        draw_bearings_from(&scene, -10e3, &a);
        draw_bearings_from(&scene, 10e3, &b);
        if (a.count > RHO_MAX_BEARINGS || b.count > RHO_MAX_BEARINGS) {
            continue;
        }
        assert_int_equal(rho_ghost_fill(&matrix, &base, a.bearing_rad, a.count, b.bearing_rad,
                                        b.count, RANGE_MAX_M),
                         RHO_OK);
        rho_ghost_prune(&matrix, rule);
        count_removed_crossings(&a, &b, ghosts, seen);
    }
    return (struct shares){ghosts[1] / ghosts[0], seen[1] / seen[0]};
}

static void clean_scans_keep_their_targets_and_lose_their_ghosts(void **state)
{
    (void)state;
    struct shares literal = shares_removed(2, 1.0, 0.0, RHO_GHOST_LITERAL);
    struct shares safe = shares_removed(2, 1.0, 0.0, RHO_GHOST_SAFE);
    struct shares none = shares_removed(2, 1.0, 0.0, RHO_GHOST_NO_RULE);
    print_message("ghosts removed: literal %.3f, safe %.3f, by side and range %.3f\n",
                  literal.ghosts_removed, safe.ghosts_removed, none.ghosts_removed);
    assert_true(literal.ghosts_removed >= 0.74);
    assert_true(safe.ghosts_removed >= 0.74);
    assert_in_range((int)(1000 * none.ghosts_removed), 350, 440);
    assert_true(literal.targets_lost <= 0.0 && safe.targets_lost <= 0.0 &&
                none.targets_lost <= 0.0);
}

/* The literal rule assumes scans without misses and false alarms; the safe rule does not. */
static void misses_and_false_alarms_make_the_literal_rule_lose_targets(void **state)
{
    (void)state;
    struct shares literal = shares_removed(2, 0.9, 1.0, RHO_GHOST_LITERAL);
    struct shares safe = shares_removed(2, 0.9, 1.0, RHO_GHOST_SAFE);
    print_message("targets lost: literal %.4f, safe %.4f; ghosts removed: %.3f, %.3f\n",
                  literal.targets_lost, safe.targets_lost, literal.ghosts_removed,
                  safe.ghosts_removed);
    assert_in_range((int)(1000 * literal.targets_lost), 140, 210);
    assert_true(safe.targets_lost <= 0.003);
    assert_in_range((int)(1000 * safe.ghosts_removed), 450, 550);
}

/* With six targets the safe rule removes more ghosts than the literal one, and no target. */
static void the_safe_rule_removes_more_ghosts_of_six_targets(void **state)
{
    (void)state;
    struct shares literal = shares_removed(6, 1.0, 0.0, RHO_GHOST_LITERAL);
    struct shares safe = shares_removed(6, 1.0, 0.0, RHO_GHOST_SAFE);
    print_message("six targets, ghosts removed: literal %.3f, safe %.3f\n", literal.ghosts_removed,
                  safe.ghosts_removed);
    assert_true(safe.ghosts_removed >= literal.ghosts_removed + 0.05);
    assert_true(safe.targets_lost <= 0.0);
}

static void bad_arguments_are_refused(void **state)
{
    (void)state;
    float bearings[RHO_MAX_BEARINGS + 1] = {0};
    const float bad[] = {0.1f, NAN}, far[] = {99.0f}, farther[] = {101.0f};
    set_paper_base();
    assert_int_equal(rho_ghost_fill(&matrix, &base, far, 1, far, 1, 1.0f), RHO_OK);
    memset(&matrix, 0x5a, sizeof matrix);
    struct rho_ghost_matrix before = matrix;
    assert_int_equal(rho_ghost_fill(NULL, &base, bearings, 1, bearings, 1, 1.0f), RHO_ERROR_NULL);
    assert_int_equal(rho_ghost_fill(&matrix, NULL, bearings, 1, bearings, 1, 1.0f), RHO_ERROR_NULL);
    assert_int_equal(rho_ghost_fill(&matrix, &base, NULL, 1, bearings, 1, 1.0f), RHO_ERROR_NULL);
    assert_int_equal(rho_ghost_fill(&matrix, &base, bearings, 1, NULL, 1, 1.0f), RHO_ERROR_NULL);
    assert_int_equal(
        rho_ghost_fill(&matrix, &base, bearings, RHO_MAX_BEARINGS + 1, bearings, 1, 1.0f),
        RHO_ERROR_CAPACITY);
    assert_int_equal(rho_ghost_fill(&matrix, &base, bad, 2, bearings, 1, 1.0f), RHO_ERROR_VALUE);
    assert_int_equal(rho_ghost_fill(&matrix, &base, farther, 1, far, 1, 1.0f), RHO_ERROR_VALUE);
    assert_int_equal(rho_ghost_fill(&matrix, &base, bearings, 1, bad, 2, 1.0f), RHO_ERROR_VALUE);
    assert_int_equal(rho_ghost_fill(&matrix, &base, bearings, 1, bearings, 1, 0.0f),
                     RHO_ERROR_VALUE);
    assert_int_equal(rho_ghost_fill(&matrix, &base, bearings, 1, bearings, 1, NAN),
                     RHO_ERROR_VALUE);
    assert_memory_equal(&before, &matrix, sizeof matrix);
    assert_int_equal(rho_ghost_fill(&matrix, &base, NULL, 0, NULL, 0, 1.0f), RHO_OK);
    assert_int_equal(rho_ghost_prune(&matrix, RHO_GHOST_SAFE), 0);
}

static void every_reason_has_a_name(void **state)
{
    (void)state;
    static const char *const names[] = {"kept", "sides",  "apart",    "range",
                                        "row",  "column", "unmatched"};
    for (int i = 0; i < RHO_NUM_GHOST_REASONS; i++) {
        assert_string_equal(rho_ghost_reason_name((enum rho_ghost_reason)i), names[i]);
    }
    assert_string_equal(rho_ghost_reason_name(RHO_NUM_GHOST_REASONS), "unknown");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rows_only_crossing_removes_the_others_of_its_column),
        cmocka_unit_test(removals_leave_further_rows_with_one_crossing),
        cmocka_unit_test(columns_with_one_crossing_are_pruned_after_rows),
        cmocka_unit_test(without_single_crossings_nothing_is_removed),
        cmocka_unit_test(of_two_beams_with_one_crossing_the_literal_rule_keeps_the_first),
        cmocka_unit_test(the_safe_rule_prunes_square_matrices_only),
        cmocka_unit_test(the_safe_rule_prunes_by_matchings_without_single_crossings),
        cmocka_unit_test(the_safe_rule_keeps_all_crossings_of_complete_matchings),
        cmocka_unit_test(figure_1_of_the_paper_keeps_its_targets_alone),
        cmocka_unit_test(clean_scans_keep_their_targets_and_lose_their_ghosts),
        cmocka_unit_test(misses_and_false_alarms_make_the_literal_rule_lose_targets),
        cmocka_unit_test(the_safe_rule_removes_more_ghosts_of_six_targets),
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(every_reason_has_a_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
