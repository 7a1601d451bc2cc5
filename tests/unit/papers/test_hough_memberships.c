/* SPDX-License-Identifier: MIT */
/*
 * Truth T, indeterminacy I and falsity F of the neutrosophic paper: memberships of a vote compared
 * with double precision, the matrices C_T, C_I and C_F as their sums, eq. (19) compared with eq.
 * (24), and planes of votes compared with the cells of a search.
 */
#include "expect_hough_cells_and_peaks.h"

#define NUM(array) (sizeof(array) / sizeof((array)[0]))
#define ROWS_MAX 400u
#define COLUMNS_MAX 420u
#define PARTS 16.0 /* largest rounding error of a vote, in 1 / 65536 */

static uint32_t pictures[RHO_NUM_HOUGH_COMPONENTS][ROWS_MAX * COLUMNS_MAX];

/* Sets cells of 25 m and 8 mrad, so that a picture holds the whole plane. */
static void use_coarse_cells(enum rho_hough_method method)
{
    use_paper_values_all_cells(method);
    config.rho_cell_m = 25.0f;
    config.theta_cell_rad = 0.008f;
    config.eps_rho_m = 40.0f;
    config.eps_theta_rad = 0.02f;
}

static struct rho_votes_picture whole_plane(enum rho_hough_component component)
{
    struct rho_votes_picture plane = {
        .height = hough.theta_cells, .width = hough.rho_cells, .votes = pictures[component]};
    assert_true(hough.theta_cells <= ROWS_MAX && hough.rho_cells <= COLUMNS_MAX);
    return plane;
}

static void draw_plane(enum rho_hough_component component)
{
    struct rho_votes_picture plane = whole_plane(component);
    assert_int_equal(rho_hough_plane(&hough, &points, component, &plane), RHO_OK);
}

static struct rho_hough_memberships memberships_of_pair(unsigned first, unsigned second)
{
    struct rho_hough_memberships of;
    memset(&of, 0x5a, sizeof of);
    assert_int_equal(rho_hough_vote(&hough, &points, first, second, &of), RHO_OK);
    return of;
}

static void a_vote_has_truth_indeterminacy_and_falsity(void **state)
{
    (void)state;
    set_scene_of_pair_between_two_kernels();
    add_plot(500.0, 3000.0, 4.0); /* too far for a target of 400 m/s */
    use_paper_values_all_cells(RHO_HOUGH_NHT_A);
    prepare_hough();
    struct rho_hough_memberships of = memberships_of_pair(4, 5);
    assert_float_equal(of.truth, 65536.0 * exp(-0.18), 4.0);
    assert_float_equal(of.indeterminacy, 65536.0 * exp(-0.10125), 4.0);
    assert_int_equal(of.falsity, 7); /* 65536 P_F^2 = 6.55, rounded */
    config.lambda_k = 1e6f;
    prepare_hough();
    of = memberships_of_pair(4, 5);
    assert_int_equal(of.falsity, RHO_HOUGH_VOTE); /* a membership is 1 at most */
    of = memberships_of_pair(4, 6);
    /* the pair is no candidate, eq. (20) */
    assert_int_equal(of.truth + of.indeterminacy + of.falsity, 0);
    of = memberships_of_pair(0, 2);
    /* without an earlier scan there is no kernel */
    assert_int_equal(of.truth + of.indeterminacy + of.falsity, 0);
}

/* Truth from the nearest kernel in double precision; -1: so near a limit that float may differ. */
static double expected_truth_of_pair(unsigned first, unsigned second)
{
    const struct line line = line_of_plots(first, second);
    const unsigned scan = scan_of(second);
    double best = 0.0;
    for (unsigned i = scan_start(scan - 2); i < scan_end[scan - 2]; i++) {
        for (unsigned j = scan_start(scan - 1); j < scan_end[scan - 1]; j++) {
            const double d_m = hypot((double)(x_m[j] - x_m[i]), (double)(y_m[j] - y_m[i]));
            const double dt_s = (double)(t_s[j] - t_s[i]);
            const struct line off = line_offset(line, line_of_plots(i, j));
            const double rho = fabs(off.rho) / (2.0 * (double)config.eps_rho_m);
            const double theta = fabs(off.theta) / (2.0 * (double)config.eps_theta_rad);
            const int is_near = rho < 1.001 && theta < 1.001;
            const int is_speed = d_m > 0.999 * (double)config.v_min_mps * dt_s &&
                                 d_m < 1.001 * (double)config.v_max_mps * dt_s;
            const int is_sure = rho < 0.999 && theta < 0.999 &&
                                d_m > 1.001 * (double)config.v_min_mps * dt_s &&
                                d_m < 0.999 * (double)config.v_max_mps * dt_s;
            if (is_near && is_speed) {
                const double mu = gaussian_of_offset(off);
                if (!is_sure && mu > best) {
                    return -1.0;
                }
                best = mu > best ? mu : best;
            }
        }
    }
    return best;
}

static int is_sure_candidate(unsigned first, unsigned second)
{
    const double d_m =
        hypot((double)(x_m[second] - x_m[first]), (double)(y_m[second] - y_m[first]));
    const double dt_s = (double)(t_s[second] - t_s[first]);
    return d_m > 1.001 * (double)config.v_min_mps * dt_s &&
           d_m < 0.999 * (double)config.v_max_mps * dt_s;
}

static void the_truth_of_a_vote_is_that_of_the_nearest_kernel(void **state)
{
    (void)state;
    unsigned compared = 0, true_ones = 0;
    random_state = 31;
    add_scene_of_table_1(4, 0.5, 1);
    use_coarse_cells(RHO_HOUGH_NHT_A);
    prepare_hough();
    for (unsigned i = scan_start(1); i < scan_end[2]; i++) {
        const unsigned scan = scan_of(i) + 1u;
        for (unsigned j = scan_start(scan); j < scan_end[scan]; j++) {
            const double truth =
                scan >= 2 && is_sure_candidate(i, j) ? expected_truth_of_pair(i, j) : -1.0;
            if (truth >= 0.0) {
                assert_float_equal(memberships_of_pair(i, j).truth, 65536.0 * truth, PARTS);
                compared++;
                true_ones += truth > 0.0;
            }
        }
    }
    print_message("%u votes, of %u truth is not 0\n", compared, true_ones);
    assert_true(compared > 1000 && true_ones > 50 && true_ones < compared);
}

static uint32_t component_of(const struct rho_hough_memberships *of,
                             enum rho_hough_component component)
{
    const uint32_t parts[] = {[RHO_HOUGH_TRUTH] = of->truth,
                              [RHO_HOUGH_INDETERMINACY] = of->indeterminacy,
                              [RHO_HOUGH_FALSITY] = of->falsity};
    uint32_t largest = 0;
    for (int i = RHO_HOUGH_TRUTH; i <= RHO_HOUGH_FALSITY; i++) {
        largest = parts[i] > largest ? parts[i] : largest;
    }
    return component == RHO_HOUGH_LARGEST ? largest : parts[component];
}

/*
 * Eqs. (16) to (18) and the sum in (24), cell by cell; pairs near a border of cells may be in the
 * next one.
 */
static void matrices_are_the_sums_of_memberships(void **state)
{
    (void)state;
    static uint32_t sums[RHO_NUM_HOUGH_COMPONENTS][ROWS_MAX * COLUMNS_MAX];
    static uint8_t is_unsure[ROWS_MAX * COLUMNS_MAX];
    random_state = 32;
    add_scene_of_table_1(5, 2.0, 1);
    use_coarse_cells(RHO_HOUGH_NHT_A);
    prepare_hough();
    memset(sums, 0, sizeof sums);
    memset(is_unsure, 0, sizeof is_unsure);
    for (unsigned i = scan_start(1); i < scan_end[3]; i++) {
        const unsigned scan = scan_of(i) + 1u;
        for (unsigned j = scan_start(scan); j < scan_end[scan]; j++) {
            const struct rho_hough_memberships of = memberships_of_pair(i, j);
            const struct line line = line_of_plots(i, j);
            if (!is_in_plane(place_of(line)) || of.falsity == 0) {
                continue;
            }
            for (int side = 0; side < 9; side++) {
                const struct line moved = {line.rho + 0.05 * (side % 3 - 1),
                                           line.theta + 2e-5 * (side / 3 - 1)};
                const struct place place = wrapped_place(place_of(wrapped_line(moved)));
                const unsigned at = (unsigned)(place.theta * num_rho() + place.rho);
                is_unsure[at] |= is_in_plane(place) && (place.theta != place_of(line).theta ||
                                                        place.rho != place_of(line).rho);
            }
            const unsigned own = (unsigned)sort_key_of_place(place_of(line));
            for (int c = RHO_HOUGH_TRUTH; c < RHO_NUM_HOUGH_COMPONENTS; c++) {
                sums[c][own] += component_of(&of, (enum rho_hough_component)c);
            }
        }
    }
    for (int c = RHO_HOUGH_TRUTH; c < RHO_NUM_HOUGH_COMPONENTS; c++) {
        unsigned same = 0, off = 0, filled = 0;
        draw_plane((enum rho_hough_component)c);
        for (unsigned i = 0; i < (unsigned)hough.theta_cells * hough.rho_cells; i++) {
            filled += pictures[c][i] > 0;
            same += pictures[c][i] > 0 && pictures[c][i] == sums[c][i];
            off += pictures[c][i] != sums[c][i] && !is_unsure[i];
        }
        print_message("component %d: %u cells, %u the same\n", c, filled, same);
        assert_true(filled > 100 && same > filled - filled / 20);
        assert_in_range(off, 0, filled / 50); /* pairs near a border of cells */
    }
}

/*
 * Eq. (19) takes the largest of three sums, eq. (24) sums the largest membership: (24) is no less
 * in any cell, at most the three sums together, and equal if one membership is largest in each
 * vote.
 */
static void the_largest_of_sums_is_at_most_the_sum_of_the_largest(void **state)
{
    (void)state;
    for (int reading = 0; reading < 2; reading++) {
        unsigned less = 0, equal = 0;
        random_state = 33;
        add_scene_of_table_1(6, 3.0, 1);
        use_coarse_cells(reading ? RHO_HOUGH_NHT_C : RHO_HOUGH_NHT_A);
        /* F is 0.5, so that each membership is the largest one somewhere */
        config.lambda_k = 5000.0f;
        prepare_hough();
        for (int c = RHO_HOUGH_TRUTH; c < RHO_NUM_HOUGH_COMPONENTS; c++) {
            draw_plane((enum rho_hough_component)c);
        }
        for (unsigned i = 0; i < (unsigned)hough.theta_cells * hough.rho_cells; i++) {
            const uint32_t of[] = {pictures[RHO_HOUGH_TRUTH][i],
                                   pictures[RHO_HOUGH_INDETERMINACY][i],
                                   pictures[RHO_HOUGH_FALSITY][i]};
            const uint32_t by_24 = pictures[RHO_HOUGH_LARGEST][i], all = of[0] + of[1] + of[2];
            uint32_t by_19 = of[0] > of[1] ? of[0] : of[1];
            by_19 = of[2] > by_19 ? of[2] : by_19;
            /* sums of spread votes are rounded one by one */
            const uint32_t rounding = reading ? 200 : 0;
            assert_true(by_19 <= by_24 + rounding && by_24 <= all + 3 * rounding);
            less += by_19 + rounding < by_24;
            equal += by_24 > 0 && by_19 == by_24;
        }
        print_message("(19) is (24) in %u cells, less in %u\n", equal, less);
        assert_true(equal > 100 && less > 5);
    }
}

static void a_plane_of_votes_agrees_with_the_search(void **state)
{
    (void)state;
    static const enum rho_hough_method methods[] = {RHO_HOUGH_HT, RHO_HOUGH_MHT, RHO_HOUGH_IHT,
                                                    RHO_HOUGH_NHT_A, RHO_HOUGH_NHT_C};
    random_state = 34;
    for (unsigned run = 0; run < 2 * NUM(methods); run++) {
        add_scene_of_table_1(5, 3.0, 1);
        use_coarse_cells(methods[run / 2]);
        config.votes = run % 2 ? RHO_VOTES_SCANS : RHO_VOTES_POINTS;
        config.uses_indeterminacy = run % 2;
        find_peaks();
        draw_plane(RHO_HOUGH_VOTES);
        unsigned filled = 0;
        for (unsigned i = 0; i < (unsigned)hough.theta_cells * hough.rho_cells; i++) {
            filled += pictures[RHO_HOUGH_VOTES][i] > 0;
        }
        assert_int_equal(filled, result.num_peaks);
        for (uint32_t i = 0; i < result.num_peaks; i++) {
            const unsigned at = peaks[i].theta_cell * hough.rho_cells + peaks[i].rho_cell;
            assert_int_equal(pictures[RHO_HOUGH_VOTES][at], peaks[i].votes);
        }
    }
}

/* Sums over the voters of a cell are those of the matrices there. */
static void sums_of_a_track_agree_with_the_matrices_of_its_cell(void **state)
{
    (void)state;
    for (int reading = 0; reading < 2; reading++) {
        random_state = 35;
        add_scene_of_table_1(6, 0.5, 1);
        use_coarse_cells(reading ? RHO_HOUGH_NHT_C : RHO_HOUGH_NHT_A);
        find_peaks();
        for (int c = RHO_HOUGH_TRUTH; c <= RHO_HOUGH_FALSITY; c++) {
            draw_plane((enum rho_hough_component)c);
        }
        assert_true(result.num_peaks > 20);
        for (uint32_t i = 0; i < 20; i++) {
            struct rho_hough_track track;
            const unsigned at = peaks[i].theta_cell * hough.rho_cells + peaks[i].rho_cell;
            assert_int_equal(rho_hough_track(&hough, &points, peaks[i].theta_cell,
                                             peaks[i].rho_cell, 0.0f, &track),
                             RHO_OK);
            assert_float_equal(track.sums.truth, pictures[RHO_HOUGH_TRUTH][at], 100.0);
            assert_float_equal(track.sums.indeterminacy, pictures[RHO_HOUGH_INDETERMINACY][at],
                               100.0);
            if (!reading) { /* 7 parts spread over a neighbourhood are lost by rounding */
                assert_int_equal(track.sums.falsity, pictures[RHO_HOUGH_FALSITY][at]);
            }
        }
    }
}

static void a_windows_picture_has_the_most_votes_of_each_block(void **state)
{
    (void)state;
    uint32_t small[4 * 5];
    random_state = 36;
    add_scene_of_table_1(5, 3.0, 1);
    use_coarse_cells(RHO_HOUGH_NHT_C);
    prepare_hough();
    draw_plane(RHO_HOUGH_VOTES);
    struct rho_votes_picture plane = {.first_theta = 40,
                                      .theta_cells = 200,
                                      .first_rho = 100,
                                      .rho_cells = 250,
                                      .height = 4,
                                      .width = 5,
                                      .votes = small};
    assert_int_equal(rho_hough_plane(&hough, &points, RHO_HOUGH_VOTES, &plane), RHO_OK);
    for (unsigned y = 0; y < 4; y++) {
        for (unsigned x = 0; x < 5; x++) {
            uint32_t most = 0;
            for (unsigned i = 40 + 50 * y; i < 90 + 50 * y; i++) {
                for (unsigned j = 100 + 50 * x; j < 150 + 50 * x; j++) {
                    const uint32_t one = pictures[RHO_HOUGH_VOTES][i * hough.rho_cells + j];
                    most = one > most ? one : most;
                }
            }
            assert_int_equal(small[5 * y + x], most);
        }
    }
}

static void invalid_votes_and_planes_are_refused(void **state)
{
    (void)state;
    struct rho_hough_memberships of;
    set_scene_of_pair_between_two_kernels();
    add_plot(500.0, 3000.0, 4.0);
    use_coarse_cells(RHO_HOUGH_IHT);
    prepare_hough();
    struct rho_votes_picture plane = whole_plane(RHO_HOUGH_TRUTH);
    assert_int_equal(rho_hough_plane(&hough, &points, RHO_HOUGH_TRUTH, &plane), RHO_ERROR_VALUE);
    assert_int_equal(rho_hough_plane(&hough, &points, RHO_NUM_HOUGH_COMPONENTS, &plane),
                     RHO_ERROR_VALUE);
    assert_int_equal(rho_hough_plane(NULL, &points, RHO_HOUGH_VOTES, &plane), RHO_ERROR_NULL);
    assert_int_equal(rho_hough_plane(&hough, NULL, RHO_HOUGH_VOTES, &plane), RHO_ERROR_NULL);
    assert_int_equal(rho_hough_plane(&hough, &points, RHO_HOUGH_VOTES, NULL), RHO_ERROR_NULL);
    plane.height = (uint16_t)(hough.theta_cells + 1u);
    assert_int_equal(rho_hough_plane(&hough, &points, RHO_HOUGH_VOTES, &plane), RHO_ERROR_VALUE);
    assert_int_equal(rho_hough_vote(&hough, &points, 4, 5, &of), RHO_OK);
    assert_int_equal(of.truth + of.indeterminacy + of.falsity, 0); /* IHT has no memberships */
    assert_int_equal(rho_hough_vote(&hough, &points, 4, 5, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_hough_vote(NULL, &points, 4, 5, &of), RHO_ERROR_NULL);
    assert_int_equal(rho_hough_vote(&hough, &points, 0, 5, &of), RHO_ERROR_VALUE);
    assert_int_equal(rho_hough_vote(&hough, &points, 5, 4, &of), RHO_ERROR_VALUE);
    assert_int_equal(rho_hough_vote(&hough, &points, 4, 7, &of), RHO_ERROR_VALUE);
    hough.magic = 0;
    assert_int_equal(rho_hough_vote(&hough, &points, 4, 5, &of), RHO_ERROR_STATE);
    assert_int_equal(rho_hough_plane(&hough, &points, RHO_HOUGH_VOTES, &plane), RHO_ERROR_STATE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_vote_has_truth_indeterminacy_and_falsity),
        cmocka_unit_test(the_truth_of_a_vote_is_that_of_the_nearest_kernel),
        cmocka_unit_test(matrices_are_the_sums_of_memberships),
        cmocka_unit_test(the_largest_of_sums_is_at_most_the_sum_of_the_largest),
        cmocka_unit_test(a_plane_of_votes_agrees_with_the_search),
        cmocka_unit_test(sums_of_a_track_agree_with_the_matrices_of_its_cell),
        cmocka_unit_test(a_windows_picture_has_the_most_votes_of_each_block),
        cmocka_unit_test(invalid_votes_and_planes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
