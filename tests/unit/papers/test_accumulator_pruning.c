/* SPDX-License-Identifier: MIT */
/*
 * The accumulator's search with pruning has the same peaks and counts as without it, and as the
 * whole plane, for any points and thresholds.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "accumulator_reference.h"
#include "rhotrack/detail/accumulator.h"

static struct rho_accumulator_result plain;

static int random_below(int n)
{
    return (int)uniform(0.0, n);
}

/*
 * Expects equal results with and without pruning; leaves those with pruning in `peaks` and
 * `result`.
 */
static void expect_same_without_pruning(struct rho_accumulator_config config, uint32_t room)
{
    config.no_pruning = 1;
    init_accumulator_with_config(&config);
    find_peaks(room);
    plain = result;
    memcpy(expected, peaks, plain.num_peaks * sizeof expected[0]);
    config.no_pruning = 0;
    init_accumulator_with_config(&config);
    find_peaks(room);
    assert_int_equal(result.num_peaks, plain.num_peaks);
    /* a point at the border of two cells may vote for the other one: a peak more or less */
    assert_in_range(result.peaks_dropped + 1, plain.peaks_dropped, plain.peaks_dropped + 2);
    assert_int_equal(result.votes, plain.votes);
    assert_int_equal(result.votes_max, plain.votes_max);
    assert_memory_equal(peaks, expected, plain.num_peaks * sizeof peaks[0]);
}

static void expect_peaks_of_whole_plane(const struct rho_accumulator_config *config)
{
    uint32_t count = result.num_peaks;
    of = config;
    assert_int_equal(list_peaks_of_whole_plane(), count);
    assert_memory_equal(peaks, expected, count * sizeof peaks[0]);
}

/* Adds points scan by scan: one of each target, then clutter. */
static void add_targets_and_clutter(unsigned num_scans, unsigned num_targets, unsigned clutter,
                                    double half_m)
{
    double from_m[16][2], step_m[16][2];
    unsigned i = 0;
    points.num_scans = num_scans;
    for (unsigned target = 0; target < num_targets; target++) {
        for (int axis = 0; axis < 2; axis++) {
            from_m[target][axis] = uniform(-0.6 * half_m, 0.6 * half_m);
            /* one step in four is 0, so that targets move along an axis or stand still */
            step_m[target][axis] =
                random_below(4) ? uniform(-0.3 * half_m, 0.3 * half_m) / num_scans : 0.0;
        }
    }
    for (unsigned scan = 0; scan < num_scans; scan++) {
        for (unsigned target = 0; target < num_targets; target++, i++) {
            x_m[i] = (float)(from_m[target][0] + step_m[target][0] * scan);
            y_m[i] = (float)(from_m[target][1] + step_m[target][1] * scan);
        }
        for (unsigned k = clutter * scan / num_scans; k < clutter * (scan + 1) / num_scans;
             k++, i++) {
            x_m[i] = (float)uniform(-half_m, half_m);
            y_m[i] = (float)uniform(-half_m, half_m);
        }
        scan_end[scan] = i;
    }
}

/* Shifts and shrinks all points, or puts some at the origin, on one place, or near an axis. */
static void distort_points(int kind, double half_m)
{
    unsigned n = scan_end[points.num_scans - 1];
    float shift_m = (float)uniform(-0.9 * half_m, 0.9 * half_m);
    for (unsigned i = 0; i < n; i++) {
        if (kind == 1) {
            x_m[i] = 0.05f * x_m[i] + shift_m;
            y_m[i] = 0.05f * y_m[i] - shift_m;
        } else if (kind == 2 && i % 3 == 0) {
            x_m[i] = y_m[i] = 0.0f;
        } else if (kind == 3 && i % 4 == 0) {
            x_m[i] = shift_m;
            y_m[i] = 0.0f;
        } else if (kind == 4) { /* close to the line where theta begins and ends */
            x_m[i] = shift_m + 1e-3f * x_m[i];
        } else if (kind == 5) {
            y_m[i] = 1e-4f * y_m[i];
        }
    }
}

static struct rho_accumulator_config random_config(double half_m, int is_paper, unsigned num_scans)
{
    struct rho_accumulator_config config = paper_cells();
    config.rho_max_m = (float)(1.42 * half_m * uniform(0.9, 1.5)); /* some points may be outside */
    config.rho_cell_m = 5.0f;
    if (!is_paper) {
        config.rho_cell_m = config.rho_max_m * (float)uniform(0.002, 0.3);
        config.theta_cell_rad = (float)exp(uniform(log(0.001), log(1.0)));
    }
    config.votes = random_below(3) ? RHO_VOTES_SCANS : RHO_VOTES_POINTS;
    config.min_votes = (uint16_t)(1 + random_below((int)num_scans + 1));
    config.min_share = random_below(3) ? 0.0f : (float)uniform(0.0, 1.0);
    return config;
}

static struct rho_accumulator_config random_case(int is_paper, unsigned clutter_max)
{
    static const double halves_m[] = {100.0, 1000.0, 2300.0};
    double half_m = halves_m[random_below(3)];
    unsigned num_scans = 1 + (unsigned)random_below(RHO_ACCUMULATOR_SCANS_MAX);
    add_targets_and_clutter(num_scans, (unsigned)random_below(5),
                            (unsigned)random_below((int)clutter_max), half_m);
    distort_points(random_below(8), half_m);
    return random_config(half_m, is_paper, num_scans);
}

static void pruning_changes_no_peak_and_no_count(void **state)
{
    (void)state;
    unsigned with_peaks = 0, with_more = 0;
    for (int run = 0; run < 1200; run++) {
        struct rho_accumulator_config config = random_case(run % 8 == 0, run % 5 ? 60 : 400);
        expect_same_without_pruning(config, run % 4 ? PEAKS_MAX : 20);
        with_peaks += result.num_peaks > 0;
        with_more += config.min_votes > 2 && result.num_peaks > 0;
    }
    assert_true(with_peaks > 600);
    assert_true(with_more > 300);
}

static void pruned_peaks_agree_with_the_whole_plane(void **state)
{
    (void)state;
    unsigned with_peaks = 0;
    for (int run = 0; run < 200; run++) {
        struct rho_accumulator_config config = random_case(run % 20 == 0, 150);
        config.min_share = 0.0f;
        expect_same_without_pruning(config, PEAKS_MAX);
        expect_peaks_of_whole_plane(&config);
        with_peaks += result.num_peaks > 0;
    }
    assert_true(with_peaks > 100);
}

/* Few points on many cells: hardly any cell has votes but those of the targets. */
static void targets_among_clutter_keep_their_peaks(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    for (int run = 0; run < 60; run++) {
        add_targets_and_clutter(7, 3, 9 + (unsigned)(run % 3) * 60, 2900.0);
        config.min_votes = (uint16_t)(3 + run % 5);
        expect_same_without_pruning(config, PEAKS_MAX);
        assert_true(result.num_peaks > 0);
        assert_int_equal(result.votes_max, 7);
    }
}

/* Sets a point on a line, at along_m from the foot of the perpendicular. */
static void add_point_on_line(unsigned i, double theta, double rho_m, double along_m)
{
    x_m[i] = (float)(rho_m * cos(theta) - along_m * sin(theta));
    y_m[i] = (float)(rho_m * sin(theta) + along_m * cos(theta));
}

/* Points at the two ends of a line separate fastest as theta changes. */
static void a_line_with_points_at_its_ends_alone_is_kept(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    unsigned found = 0;
    for (int run = 0; run < 300; run++) {
        double theta = uniform(0.0, 3.14159), rho_m = uniform(-1500.0, 1500.0);
        double middle_m = uniform(-500.0, 500.0), half_m = uniform(10.0, 2500.0);
        points.num_scans = 6;
        for (unsigned scan = 0; scan < 6; scan++) {
            add_point_on_line(scan, theta, rho_m, middle_m + (scan % 2 ? half_m : -half_m));
            scan_end[scan] = scan + 1;
        }
        config.min_votes = 6;
        expect_same_without_pruning(config, PEAKS_MAX);
        /* for the other lines a border of cells lies between the ends */
        found += result.num_peaks > 0;
    }
    assert_true(found > 150);
}

/* Rows between two lines are skipped; the second line, of fewer points, must not be missed. */
static void a_line_does_not_hide_one_of_larger_theta(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    unsigned found = 0;
    config.min_votes = 3;
    for (int run = 0; run < 1000; run++) {
        double theta = uniform(0.0, 3.0), rho_m = uniform(-1500.0, 1500.0);
        double turn = 0.001 * (3 + random_below(60));
        unsigned i = 0;
        points.num_scans = 7;
        for (unsigned scan = 0; scan < 7; scan++) {
            add_point_on_line(i++, theta, rho_m, 800.0 * scan - 2400.0);
            if (scan % 3 == 0) {
                add_point_on_line(i++, theta + turn, rho_m, 800.0 * scan - 2400.0);
            }
            scan_end[scan] = i;
        }
        expect_same_without_pruning(config, PEAKS_MAX);
        found += result.num_peaks > 1;
    }
    assert_true(found > 300);
}

/* Thresholds above the number of scans, up to the largest. */
static void thresholds_that_no_cell_can_reach_give_no_peaks(void **state)
{
    (void)state;
    const uint16_t least[] = {8, 9, 128, 255, 256, 300, 32768, 65535};
    struct rho_accumulator_config config = paper_cells();
    add_targets_and_clutter(7, 3, 30, 2900.0);
    for (size_t i = 0; i < sizeof least / sizeof least[0]; i++) {
        for (int votes = 0; votes < 2; votes++) {
            config.votes = votes ? RHO_VOTES_POINTS : RHO_VOTES_SCANS;
            config.min_votes = least[i];
            expect_same_without_pruning(config, PEAKS_MAX);
        }
        assert_int_equal(result.votes, 51u * accumulator.theta_cells);
    }
}

/* The largest coordinates and the smallest and largest cells, where rounding is worst. */
static void pruning_loses_no_peak_at_the_largest_coordinates(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    for (int run = 0; run < 30; run++) {
        config.rho_cell_m = run % 2 ? 0.01f : 200.0f;
        config.rho_max_m = 0.499f * config.rho_cell_m * RHO_MAX_RHO_CELLS;
        double half_m = 0.69 * config.rho_max_m;
        config.theta_cell_rad = run % 3 ? 0.001f : 0.0002f;
        config.min_votes = (uint16_t)(5 + run % 3);
        add_targets_and_clutter(7, 4, 20, half_m);
        distort_points(run % 5 == 0, half_m);
        expect_same_without_pruning(config, PEAKS_MAX);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pruning_changes_no_peak_and_no_count),
        cmocka_unit_test(pruned_peaks_agree_with_the_whole_plane),
        cmocka_unit_test(targets_among_clutter_keep_their_peaks),
        cmocka_unit_test(a_line_with_points_at_its_ends_alone_is_kept),
        cmocka_unit_test(a_line_does_not_hide_one_of_larger_theta),
        cmocka_unit_test(thresholds_that_no_cell_can_reach_give_no_peaks),
        cmocka_unit_test(pruning_loses_no_peak_at_the_largest_coordinates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
