/* SPDX-License-Identifier: MIT */
/*
 * Methods that vote by pairs, compared with double precision cell by cell: in the paper's clutter,
 * with other parameters, and near the ends of theta, where the embedded build searches theta in
 * parts and the workstation's at once.
 */
#include "expect_hough_cells_and_peaks.h"

#define PARTS 4.0 /* largest rounding error of a voter, 2^-14 of a vote */

static const enum rho_hough_method methods[] = {RHO_HOUGH_MHT, RHO_HOUGH_IHT, RHO_HOUGH_NHT_A,
                                                RHO_HOUGH_NHT_C};

#define NUM(array) (sizeof(array) / sizeof((array)[0]))

/* Allowed error of a vote; midpoints of kernels are rounded once more. */
static double vote_slack(void)
{
    return config.method == RHO_HOUGH_MHT || config.method == RHO_HOUGH_IHT ? 0.0
           : config.uses_indeterminacy                                      ? 4.0 * PARTS
                                                                            : PARTS;
}

/* Compares all cells, then the peaks that follow from them at half of the most votes. */
static void compare_cells_and_peaks(void)
{
    find_peaks();
    expect_reference();
    expect_cells(vote_slack());
    expect_counts();
    config.tau = 0.5f;
    config.keeps_all_cells = 0;
    size_t num = choose_from_listed();
    find_peaks();
    expect_peaks_as_listed(num);
}

static void votes_in_clutter_agree_with_double_precision(void **state)
{
    (void)state;
    uint64_t pairs = 0, at_limits = 0;
    random_state = 11;
    memset(&seen, 0, sizeof seen);
    for (int run = 0; run < 2; run++) {
        add_scene_of_table_1(7, 10.0, 1);
        for (size_t i = 0; i < NUM(methods); i++) {
            use_paper_values_all_cells(methods[i]);
            compare_cells_and_peaks();
            pairs += counted.voters;
            at_limits += counted.at_limits;
        }
    }
    print_message("%llu of %llu voters at a limit, %.3f of the cells exact, off by %.2f parts\n",
                  (unsigned long long)at_limits, (unsigned long long)pairs,
                  (double)seen.exact / (double)seen.cells, seen.worst);
    assert_true(pairs > 100000);
    assert_true((double)at_limits < 0.008 * (double)pairs);
    assert_true((double)seen.exact > 0.97 * (double)seen.cells);
}

static void the_embedded_build_searches_theta_in_parts(void **state)
{
    (void)state;
    random_state = 12;
    add_scene_of_table_1(7, 10.0, 1);
    for (size_t i = 0; i < NUM(methods); i++) {
        use_paper_values_all_cells(methods[i]);
        config.lambda_k = 10.0f;
        find_peaks();
        expect_reference();
        expect_cells(vote_slack());
#ifdef RHO_PROFILE_WORKSTATION
        assert_true(result.passes >= 1);
#else
        assert_true(result.passes > 1 || config.method == RHO_HOUGH_IHT);
        assert_true(result.passes <= 200);
#endif
    }
}

static void votes_agree_for_other_cells_and_limits(void **state)
{
    (void)state;
    random_state = 13;
    for (int run = 0; run < 12; run++) {
        add_scene_of_table_1(3 + (unsigned)run % 5, run % 2 ? 10.0 : 0.5, run % 4 != 3);
        use_paper_values_all_cells(methods[run % 4]);
        config.rho_max_m = run % 3 ? 5000.0f : 2000.0f; /* some lines are beyond rho_max */
        config.rho_cell_m = run % 3 ? 20.0f : 4.0f;
        config.theta_cell_rad = (float)uniform(0.0008, 0.02);
        config.eps_rho_m = (float)uniform(5.0, 60.0);
        config.eps_theta_rad = (float)uniform(0.001, 0.03);
        config.v_min_mps = (float)uniform(0.0, 200.0);
        config.v_max_mps = (float)uniform(250.0, 500.0);
        config.lambda_k = (float)uniform(0.0, 3000.0);
        config.uses_indeterminacy = run / 4 % 2;
        if (config.method == RHO_HOUGH_NHT_A || config.method == RHO_HOUGH_NHT_C) {
            config.rho_max_m = 5000.0f;
            config.rho_cell_m = fmaxf(config.rho_cell_m, 5.0f);
        }
        compare_cells_and_peaks();
    }
}

static void add_dense_plots(int num_per_scan)
{
    points.at.num_scans = 0;
    for (unsigned scan = 0; scan < 5; scan++) {
        start_scan();
        for (int i = 0; i < num_per_scan; i++) {
            add_plot_in_rectangle(-600.0, 600.0, -600.0, 600.0, 2.0 * scan);
        }
    }
}

/*
 * Planes of 4 to hundreds of rows with neighbourhoods of up to a quarter of them; the last row is
 * almost nothing or almost complete.
 */
static void votes_agree_for_planes_of_few_rows(void **state)
{
    (void)state;
    random_state = 19;
    for (int run = 0; run < 48; run++) {
        int rows = run < 24 ? 3 + run : 20 + 19 * (run - 24);
        double part = run % 3 ? uniform(0.0, 1.0) : run % 2 ? 0.02 : 0.98;
        add_dense_plots(12);
        use_paper_values_all_cells(methods[run % 4]);
        config.theta_cell_rad = (float)(REFERENCE_PI / (rows + part));
        config.eps_theta_rad =
            (float)fmin(uniform(0.2, run % 7 ? 8.0 : 100.0) * (double)config.theta_cell_rad, 0.5);
        config.eps_rho_m = (float)uniform(1.0, run % 7 ? 100.0 : 20.0);
        config.uses_indeterminacy = run & 4;
        compare_cells_and_peaks();
    }
}

/* Planes that the embedded build searches in parts, each with a view of the next one. */
static void votes_agree_when_theta_is_searched_in_parts(void **state)
{
    (void)state;
    random_state = 21;
    for (int run = 0; run < 16; run++) {
        double part = run % 8 < 4 ? 0.02 : 0.98;
        add_dense_plots(60);
        use_paper_values_all_cells(methods[run % 4]);
        config.theta_cell_rad = (float)(REFERENCE_PI / ((run < 8 ? 200.0 : 260.0) + part));
        config.eps_theta_rad = (run < 8 ? 0.6f : 1.1f) * config.theta_cell_rad;
        compare_cells_and_peaks();
#ifndef RHO_PROFILE_WORKSTATION
        assert_true(result.passes > 1);
#endif
    }
}

/* FNV-1a hashes of all cells and their votes, which every build and profile must give. */
static void all_builds_give_the_same_cells(void **state)
{
    (void)state;
    const uint32_t known[] = {0xcca5ed50, 0x994fa7e5, 0xd65131f6, 0x4ba4b3d6};
    random_state = 20;
    add_scene_of_table_1(7, 10.0, 1);
    for (size_t i = 0; i < NUM(methods); i++) {
        uint32_t hash = 2166136261u;
        use_paper_values_all_cells(methods[i]);
        find_peaks();
        for (uint32_t k = 0; k < result.num_peaks; k++) {
            const uint32_t words[] = {peaks[k].theta_cell, peaks[k].rho_cell, peaks[k].votes};
            for (size_t byte = 0; byte < 12; byte++) {
                hash = (hash ^ (words[byte / 4] >> byte % 4 * 8 & 255u)) * 16777619u;
            }
        }
        assert_int_equal(hash, known[i]);
    }
}

static void add_vertical_targets(double noise_m, double lean)
{
    points.at.num_scans = 0;
    for (unsigned scan = 0; scan < 7; scan++) {
        start_scan();
        for (int i = 0; i < 8; i++) {
            double along = (i % 2 ? -1.0 : 1.0) * (-1400.0 + 450.0 * scan);
            double x = -3502.5 + 1000.0 * i + (i % 3 - 1) * lean * along;
            add_noisy_plot(x, along, 2.0 * scan, noise_m);
        }
    }
}

static void votes_agree_for_lines_near_the_ends_of_theta(void **state)
{
    (void)state;
    random_state = 16;
    for (int run = 0; run < 24; run++) {
        add_vertical_targets(run % 3 * 0.8, run / 3 % 2 * 0.001);
        use_paper_values_all_cells(methods[run % 4]);
        config.uses_indeterminacy = run & 8;
        compare_cells_and_peaks();
    }
}

/*
 * Vertical targets 1 km apart with a little noise: the pairs of each support each other and make
 * one peak.
 */
static void a_vertical_target_is_one_peak(void **state)
{
    (void)state;
    random_state = 17;
    unsigned kernels_beyond = 0;
    for (int run = 0; run < 10; run++) {
        add_vertical_targets(0.1, 0.0);
        use_paper_values(RHO_HOUGH_NHT_A);
        config.tau = 0.25f;
        config.votes_min = 1.8f;
        find_peaks();
        assert_int_equal(result.num_peaks, 8);
        assert_int_equal(result.votes, 40); /* 8 targets with 5 linked pairs each */
        assert_int_equal(result.candidates, 48);
        for (uint32_t i = 0; i < result.num_peaks; i++) {
            for (uint32_t k = 0; k < i; k++) {
                double other = rho_hough_rho_m(&hough, peaks[k].rho_cell);
                other = abs(peaks[i].theta_cell - peaks[k].theta_cell) > 1571 ? -other : other;
                assert_true(fabs(rho_hough_rho_m(&hough, peaks[i].rho_cell) - other) > 400.0);
            }
            kernels_beyond += peaks[i].theta_cell > 1571;
        }
    }
    assert_true(kernels_beyond > 5);
}

/* For exactly vertical lines, in any direction and on either side, theta is 0 and rho is x. */
static void a_vertical_line_is_in_the_first_row(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        double x = i & 1 ? -1502.5 : 1502.5, dy = i & 2 ? -500.0 : 500.0;
        points.at.num_scans = 0;
        for (unsigned scan = 0; scan < 5; scan++) {
            start_scan();
            add_plot(x, dy * (scan - 2.0), 2.0 * scan);
        }
        for (size_t m = 0; m < 3; m++) {
            use_paper_values(methods[m]);
            find_peaks();
            assert_int_equal(result.num_peaks, 1);
            assert_int_equal(peaks[0].theta_cell, 0);
            assert_int_equal(peaks[0].rho_cell, i & 1 ? 699 : 1300);
            assert_int_equal(peaks[0].votes, RHO_HOUGH_VOTE * (m < 2 ? 4u : 3u));
        }
    }
}

/*
 * Reading C of the paper spreads a vote over 17 x 17 cells; beyond the end of theta these are
 * mirrored.
 */
static void a_vote_is_spread_across_the_end_of_theta(void **state)
{
    (void)state;
    points.at.num_scans = 0;
    for (unsigned scan = 0; scan < 3; scan++) {
        start_scan();
        add_plot(1502.5, 500.0 * scan, 2.0 * scan);
    }
    use_paper_values_all_cells(RHO_HOUGH_NHT_C);
    find_peaks();
    assert_int_equal(result.votes, 289);
    assert_int_equal(result.num_peaks, 289);
    assert_int_equal(peaks[0].votes, RHO_HOUGH_VOTE);
    unsigned mirrored = 0;
    for (uint32_t i = 0; i < result.num_peaks; i++) {
        int is_beyond = peaks[i].theta_cell > 1571, centre = is_beyond ? 1999 - 1300 : 1300;
        int a = is_beyond ? peaks[i].theta_cell - 3142 : peaks[i].theta_cell;
        int b = peaks[i].rho_cell - centre;
        double weight = exp(-(a * a / 32.0 + b * b / 32.0));
        mirrored += is_beyond;
        assert_in_range(abs(b), 0, 8);
        assert_float_equal(peaks[i].votes, 65536.0 * weight, 2.0);
    }
    assert_int_equal(mirrored, 8 * 17);
}

static void a_vote_is_not_spread_beyond_the_largest_rho(void **state)
{
    (void)state;
    points.at.num_scans = 0;
    for (unsigned scan = 0; scan < 3; scan++) {
        start_scan();
        add_plot(500.0 * scan, 4982.5, 2.0 * scan); /* in the fourth cell from the end of rho */
    }
    use_paper_values_all_cells(RHO_HOUGH_NHT_C);
    find_peaks();
    assert_int_equal(result.votes, 17 * (9 + 3));
    expect_reference();
    expect_cells(vote_slack());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(votes_in_clutter_agree_with_double_precision),
        cmocka_unit_test(the_embedded_build_searches_theta_in_parts),
        cmocka_unit_test(votes_agree_for_other_cells_and_limits),
        cmocka_unit_test(votes_agree_for_planes_of_few_rows),
        cmocka_unit_test(votes_agree_when_theta_is_searched_in_parts),
        cmocka_unit_test(all_builds_give_the_same_cells),
        cmocka_unit_test(votes_agree_for_lines_near_the_ends_of_theta),
        cmocka_unit_test(a_vertical_target_is_one_peak),
        cmocka_unit_test(a_vertical_line_is_in_the_first_row),
        cmocka_unit_test(a_vote_is_spread_across_the_end_of_theta),
        cmocka_unit_test(a_vote_is_not_spread_beyond_the_largest_rho),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
