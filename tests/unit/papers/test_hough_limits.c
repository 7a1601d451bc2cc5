/* SPDX-License-Identifier: MIT */
/*
 * Limits of the papers' methods: refused inputs, full capacities, and extreme inputs: no plots, one
 * scan, sixteen scans, plots at one place or one time. Earlier contents of the object do not
 * matter.
 */
#include <float.h>

#include "expect_hough_cells_and_peaks.h"
#include "rhotrack/types.h"

#define NUM(array) (sizeof(array) / sizeof((array)[0]))

static const enum rho_hough_method methods[] = {RHO_HOUGH_HT, RHO_HOUGH_MHT, RHO_HOUGH_IHT,
                                                RHO_HOUGH_NHT_A, RHO_HOUGH_NHT_C};

static struct rho_hough was;

static void expect_config_refused(void)
{
    memset(&hough, 0x5a, sizeof hough);
    was = hough;
    assert_int_equal(rho_hough_init(&hough, sizeof hough, &config), RHO_ERROR_CONFIG);
    assert_memory_equal(&hough, &was, sizeof was);
}

static void expect_config_accepted(void)
{
    assert_int_equal(rho_hough_init(&hough, sizeof hough, &config), RHO_OK);
}

#define REFUSED(field, value)                                                                      \
    (use_paper_values(RHO_HOUGH_NHT_C), config.field = (value), expect_config_refused())
#define ACCEPTED(field, value)                                                                     \
    (use_paper_values(RHO_HOUGH_NHT_C), config.field = (value), expect_config_accepted())

static void bad_planes_are_refused(void **state)
{
    (void)state;
    const float never[] = {0.0f, -1.0f, NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < NUM(never); i++) {
        REFUSED(rho_max_m, never[i]);
        REFUSED(rho_cell_m, never[i]);
        REFUSED(theta_cell_rad, never[i]);
        REFUSED(eps_rho_m, never[i]);
        REFUSED(eps_theta_rad, never[i]);
    }
    REFUSED(rho_max_m, 2.6f * RHO_MAX_RHO_CELLS);
    ACCEPTED(rho_max_m, 2.5f * RHO_MAX_RHO_CELLS);
    REFUSED(theta_cell_rad, 9e-5f);
    REFUSED(theta_cell_rad, 3.2f);
    REFUSED(eps_rho_m, 0.0009f);
    ACCEPTED(eps_rho_m, 0.0011f);
    REFUSED(eps_theta_rad, 9e-5f);
    ACCEPTED(eps_theta_rad, 1.1e-4f);
    REFUSED(eps_rho_m, 5.0f * 128.0f); /* a neighbourhood of 256 cells */
    ACCEPTED(eps_rho_m, 5.0f * 127.0f);
    REFUSED(eps_theta_rad, 0.128f);
    ACCEPTED(eps_theta_rad, 0.127f);
    use_paper_values(RHO_HOUGH_MHT);
    config.theta_cell_rad = 0.1f;
    config.eps_theta_rad = 0.5f;
    expect_config_accepted();
    config.eps_theta_rad = 0.501f;
    expect_config_refused();
}

static void bad_thresholds_are_refused(void **state)
{
    (void)state;
    const float never[] = {-1.0f, -FLT_MIN, NAN};
    for (size_t i = 0; i < NUM(never); i++) {
        REFUSED(v_min_mps, never[i]);
        REFUSED(v_max_mps, never[i]);
        REFUSED(p_false, never[i]);
        REFUSED(lambda_k, never[i]);
        REFUSED(tau, never[i]);
        REFUSED(votes_min, never[i]);
    }
    REFUSED(v_min_mps, 400.0f); /* equal to v_max_mps */
    REFUSED(v_min_mps, 401.0f);
    REFUSED(v_min_mps, INFINITY);
    REFUSED(p_false, 1.001f);
    REFUSED(tau, 1.001f);
    ACCEPTED(v_min_mps, 0.0f);
    ACCEPTED(p_false, 0.0f);
    ACCEPTED(p_false, 1.0f);
    ACCEPTED(lambda_k, 0.0f);
    ACCEPTED(tau, 1.0f);
    ACCEPTED(lambda_k, 9e5f);
    REFUSED(lambda_k, 1.1e6f);
    ACCEPTED(votes_min, 65000.0f);
    REFUSED(votes_min, 66000.0f);
    REFUSED(method, (enum rho_hough_method)5);
    REFUSED(method, (enum rho_hough_method)77);
    use_paper_values(RHO_HOUGH_HT);
    config.votes = (enum rho_accumulator_votes)2;
    expect_config_refused();
}

static void other_sizes_and_null_are_refused(void **state)
{
    (void)state;
    use_paper_values(RHO_HOUGH_IHT);
    memset(&hough, 0x5a, sizeof hough);
    was = hough;
    assert_int_equal(rho_hough_init(NULL, sizeof hough, &config), RHO_ERROR_NULL);
    assert_int_equal(rho_hough_init(&hough, sizeof hough, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_hough_init(&hough, sizeof hough - 1, &config), RHO_ERROR_SIZE);
    assert_int_equal(rho_hough_init(&hough, 0, &config), RHO_ERROR_SIZE);
    assert_memory_equal(&hough, &was, sizeof was);
}

static void default_configurations_are_the_papers(void **state)
{
    (void)state;
    for (size_t i = 0; i < NUM(methods); i++) {
        memset(&config, 0x5a, sizeof config);
        rho_hough_config_default(&config, methods[i]);
        expect_config_accepted();
        assert_int_equal(config.method, methods[i]);
        assert_true(config.rho_cell_m == 5.0f && config.theta_cell_rad == 0.001f);
        assert_true(config.eps_rho_m == 20.0f && config.eps_theta_rad == 0.004f);
        assert_true(config.v_min_mps == 100.0f && config.v_max_mps == 400.0f);
        assert_true(config.p_false == 0.01f && config.lambda_k == 1.0f && config.tau == 0.5f);
        assert_true(config.votes_min == 0.0f && !config.keeps_all_cells);
        assert_true(config.votes == RHO_VOTES_POINTS && !config.uses_indeterminacy);
        assert_float_equal(config.rho_max_m, 2.5 * RHO_MAX_RHO_CELLS, 0.01);
    }
}

static void cells_have_the_theta_and_rho_of_their_centres(void **state)
{
    (void)state;
    use_paper_values(RHO_HOUGH_MHT);
    prepare_hough();
    assert_float_equal(rho_hough_theta_rad(&hough, 0), 0.0005, 1e-9);
    assert_float_equal(rho_hough_theta_rad(&hough, 3141), 3.1415, 1e-6);
    assert_float_equal(rho_hough_rho_m(&hough, 0), -4997.5, 1e-3);
    assert_float_equal(rho_hough_rho_m(&hough, 1999), 4997.5, 1e-3);
    assert_true(sizeof hough <= RHO_RAM_HOUGH_BYTES);
}

/* Expects the input refused; peaks, result and track stay as they were. */
static void expect_input_refused(enum rho_status expected, const struct rho_hough_points *input)
{
    static struct rho_accumulator_peak some[4], some_were[4];
    struct rho_hough_result results, results_were;
    struct rho_hough_track track, track_was;
    memset(some, 0x3c, sizeof some);
    memset(&results, 0x3c, sizeof results);
    memset(&track, 0x3c, sizeof track);
    memcpy(some_were, some, sizeof some);
    results_were = results;
    track_was = track;
    assert_int_equal(rho_hough_find(&hough, input, some, 4, &results), expected);
    assert_int_equal(rho_hough_track(&hough, input, 0, 0, 0.0f, &track), expected);
    assert_memory_equal(some, some_were, sizeof some);
    assert_memory_equal(&results, &results_were, sizeof results);
    assert_memory_equal(&track, &track_was, sizeof track);
}

static void null_is_refused(void **state)
{
    (void)state;
    struct rho_hough_track track;
    add_scene_of_table_1(3, 0.0, 0);
    for (size_t i = 0; i < NUM(methods); i++) {
        struct rho_hough_points without[4] = {points, points, points, points};
        without[0].at.x_m = NULL;
        without[1].at.y_m = NULL;
        without[2].at.scan_end = NULL;
        without[3].t_s = NULL;
        use_paper_values(methods[i]);
        prepare_hough();
        for (size_t k = 0; k < NUM(without); k++) {
            expect_input_refused(RHO_ERROR_NULL, &without[k]);
        }
        expect_input_refused(RHO_ERROR_NULL, NULL);
        assert_int_equal(rho_hough_find(NULL, &points, peaks, 4, &result), RHO_ERROR_NULL);
        assert_int_equal(rho_hough_find(&hough, &points, NULL, 4, &result), RHO_ERROR_NULL);
        assert_int_equal(rho_hough_find(&hough, &points, peaks, 4, NULL), RHO_ERROR_NULL);
        assert_int_equal(rho_hough_track(NULL, &points, 0, 0, 0.0f, &track), RHO_ERROR_NULL);
        assert_int_equal(rho_hough_track(&hough, &points, 0, 0, 0.0f, NULL), RHO_ERROR_NULL);
    }
}

static void numbers_that_are_not_finite_or_too_large_are_refused(void **state)
{
    (void)state;
    const float bad[] = {NAN, INFINITY, -INFINITY, 2.001e6f, -FLT_MAX};
    float *const of[] = {x_m, y_m, t_s};
    add_scene_of_table_1(3, 0.0, 0);
    for (size_t i = 0; i < NUM(methods) * NUM(of) * NUM(bad); i++) {
        float *value = &of[i / NUM(bad) % NUM(of)][i % 9], before = *value;
        use_paper_values(methods[i / NUM(bad) / NUM(of)]);
        prepare_hough();
        *value = of[i / NUM(bad) % NUM(of)] == t_s ? bad[i % 3] : bad[i % NUM(bad)];
        expect_input_refused(RHO_ERROR_VALUE, &points);
        *value = before;
    }
}

static void cells_outside_the_plane_and_bad_times_are_refused(void **state)
{
    (void)state;
    const unsigned outside[][2] = {
        {3142, 0}, {0, 2000}, {65536, 0}, {0, 65536}, {UINT32_MAX, UINT32_MAX}};
    struct rho_hough_track track, track_was;
    memset(&track, 0x3c, sizeof track);
    track_was = track;
    add_scene_of_table_1(3, 0.0, 0);
    for (size_t i = 0; i < NUM(methods); i++) {
        use_paper_values(methods[i]);
        prepare_hough();
        for (size_t k = 0; k < NUM(outside); k++) {
            assert_int_equal(
                rho_hough_track(&hough, &points, outside[k][0], outside[k][1], 0.0f, &track),
                RHO_ERROR_VALUE);
        }
        assert_int_equal(rho_hough_track(&hough, &points, 5, 5, NAN, &track), RHO_ERROR_VALUE);
        assert_memory_equal(&track, &track_was, sizeof track);
    }
}

static void scans_out_of_order_or_too_many_are_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < NUM(methods); i++) {
        use_paper_values(methods[i]);
        prepare_hough();
        add_scene_of_table_1(4, 0.0, 0);
        scan_end[1] = 10; /* beyond the end of the next scan */
        expect_input_refused(RHO_ERROR_VALUE, &points);
        add_scene_of_table_1(16, 0.0, 0);
        scan_end[16] = scan_end[15];
        points.at.num_scans = 17;
        expect_input_refused(RHO_ERROR_VALUE, &points);
    }
}

static void a_scan_has_65535_plots_at_most(void **state)
{
    (void)state;
    for (int extra = 0; extra < 2; extra++) {
        points.at.num_scans = 0;
        start_scan();
        start_scan();
        for (int i = 0; i < 65535 + extra; i++) {
            add_plot(0.01 * i, 100.0, 0.0);
        }
        start_scan();
        add_plot(0.0, 300.0, 2.0);
        for (size_t i = 0; i < NUM(methods); i++) {
            use_paper_values(methods[i]);
            prepare_hough();
            if (extra) {
                expect_input_refused(RHO_ERROR_VALUE, &points);
            } else if (methods[i] == RHO_HOUGH_NHT_A || methods[i] == RHO_HOUGH_NHT_C) {
                find_peaks();
                assert_int_equal(result.pairs, 65535);
                assert_int_equal(result.votes, 0);
            }
        }
    }
}

static void an_object_without_init_is_refused(void **state)
{
    (void)state;
    add_scene_of_table_1(3, 0.0, 0);
    memset(&hough, 0, sizeof hough);
    expect_input_refused(RHO_ERROR_STATE, &points);
    memset(&hough, 0x5a, sizeof hough);
    expect_input_refused(RHO_ERROR_STATE, &points);
}

/* Limits of the header: 1 mm for eps_rho_m, 1e9 s for times. */
static void limits_are_those_of_the_header(void **state)
{
    (void)state;
    ACCEPTED(eps_rho_m, 0.001f);
    add_scene_of_table_1(3, 0.0, 0);
    t_s[4] = 0.999e9f;
    use_paper_values(RHO_HOUGH_MHT);
    find_peaks();
    t_s[4] = 1.001e9f;
    prepare_hough();
    expect_input_refused(RHO_ERROR_VALUE, &points);
}

/* One vote is less than a threshold of 1.000001, a hundredth of 1 / 65536 above it. */
static void thresholds_are_not_rounded_down(void **state)
{
    (void)state;
    add_scene_of_table_1(2, 0.0, 0);
    use_paper_values_all_cells(RHO_HOUGH_IHT);
    config.votes_min = 1.0f;
    find_peaks();
    assert_int_equal(result.num_peaks, 3);
    config.votes_min = 1.000001f;
    find_peaks();
    assert_int_equal(result.num_peaks, 0);
}

static void the_best_peaks_are_the_same_for_any_room(void **state)
{
    (void)state;
    static struct rho_accumulator_peak all[CELLS_MAX];
    random_state = 31;
    add_scene_of_table_1(7, 10.0, 1);
    for (size_t i = 1; i < NUM(methods); i++) {
        use_paper_values_all_cells(methods[i]);
        find_peaks();
        uint32_t num = result.num_peaks, room = 0;
        memcpy(all, peaks, num * sizeof *all);
        for (; room < num; room = 5 * room + 1) {
            find_limited_peaks(room);
            assert_int_equal(result.num_peaks, room);
            assert_int_equal(result.cells_dropped, num - room);
            assert_memory_equal(peaks, all, room * sizeof *all);
            if (room < 4000) {
                config.keeps_all_cells = 0;
                size_t kept = choose_from_listed();
                find_limited_peaks(room);
                expect_peaks_as_listed(kept);
                config.keeps_all_cells = 1;
            }
        }
        find_limited_peaks(num);
        assert_int_equal(result.num_peaks, num);
        assert_int_equal(result.cells_dropped, 0);
    }
}

static void a_relative_threshold_counts_the_cells_it_drops(void **state)
{
    (void)state;
    random_state = 32;
    add_scene_of_table_1(7, 10.0, 1);
    for (size_t i = 0; i < NUM(methods); i++) {
        use_paper_values(methods[i]);
        config.keeps_all_cells = 1;
        config.tau = i ? 0.25f : 0.6f;
        find_peaks();
        uint32_t num = result.num_peaks;
        assert_true(num > 8);
        struct rho_accumulator_peak first[8];
        memcpy(first, peaks, sizeof first);
        find_limited_peaks(8);
        assert_int_equal(result.num_peaks, 8);
        assert_true(result.cells_dropped >= num - 8);
        assert_memory_equal(peaks, first, sizeof first);
    }
}

/* With targets abreast one direction has more kernels than fit. */
#ifndef RHO_PROFILE_WORKSTATION

static void add_targets_abreast(unsigned num)
{
    points.at.num_scans = 0;
    for (unsigned scan = 0; scan < 3; scan++) {
        start_scan();
        for (unsigned i = 0; i < num; i++) {
            add_plot(10.0 * i, 320.0 * scan, 2.0 * scan);
        }
    }
}

static void kernels_beyond_the_capacity_are_counted(void **state)
{
    (void)state;
    add_targets_abreast(RHO_MAX_HOUGH_KERNELS);
    use_paper_values_all_cells(RHO_HOUGH_NHT_A);
    config.v_min_mps = 150.0f;
    config.v_max_mps = 162.0f;
    find_peaks(); /* the kernels fit exactly */
    expect_reference();
    expect_cells(4.0);
    uint32_t cells_with_room = result.num_peaks;
    add_targets_abreast(RHO_MAX_HOUGH_KERNELS + 44);
    find_limited_peaks(CELLS_MAX);
    assert_true(result.kernels_dropped >= 44);
    assert_true(result.num_peaks >= cells_with_room / 2);
    expect_reference();
    for (uint32_t i = 0; i < result.num_peaks; i++) {
        const struct cell *cell =
            find_cell(peaks[i].theta_cell * (uint32_t)num_rho() + peaks[i].rho_cell);
        assert_non_null(cell);
        assert_true(peaks[i].votes <= cell->bounds.most * RHO_HOUGH_VOTE + 4.0 * cell->sources);
    }
}

#endif

static void expect_nothing(void)
{
    find_peaks();
    assert_int_equal(result.num_peaks + result.pairs + result.candidates + result.votes, 0);
    assert_int_equal(result.cells + result.votes_max, 0);
}

static void without_plots_there_are_no_pairs_and_peaks(void **state)
{
    (void)state;
    const struct rho_hough_points none = {.at = {.num_scans = 0}};
    for (size_t i = 0; i < NUM(methods); i++) {
        use_paper_values_all_cells(methods[i]);
        points.at.num_scans = 0;
        expect_nothing();
        assert_int_equal(rho_hough_find(&hough, &none, peaks, 4, &result), RHO_OK);
        assert_int_equal(result.num_peaks, 0);
        for (unsigned scan = 0; scan < 16; scan++) {
            start_scan();
        }
        expect_nothing();
        if (methods[i] != RHO_HOUGH_HT) {
            add_scene_of_table_1(1, 0.0, 0);
            expect_nothing();
        }
    }
}

/* Pairs are made of successive scans only. */
static void no_pair_spans_a_scan_without_plots(void **state)
{
    (void)state;
    for (size_t i = 1; i < NUM(methods); i++) {
        points.at.num_scans = 0;
        for (unsigned scan = 0; scan < 7; scan++) {
            start_scan();
            if (scan != 3) {
                add_plot(100.0 + 400.0 * scan, 1002.5, 2.0 * scan);
            }
        }
        use_paper_values_all_cells(methods[i]);
        find_peaks();
        assert_int_equal(result.pairs, 4);
        assert_int_equal(result.candidates, 4);
        assert_int_equal(peaks[0].votes, RHO_HOUGH_VOTE * (i < 3 ? 4u : 2u));
    }
}

static void two_plots_in_one_place_do_not_vote(void **state)
{
    (void)state;
    points.at.num_scans = 0;
    for (unsigned scan = 0; scan < 4; scan++) {
        start_scan();
        add_plot(500.0, 700.0, 2.0 * scan);
        add_plot(-0.0, 0.0, 2.0 * scan);
    }
    for (size_t i = 1; i < NUM(methods); i++) {
        use_paper_values_all_cells(methods[i]);
        config.v_min_mps = 0.0f;
        config.v_max_mps = 1000.0f;
        find_peaks();
        expect_reference();
        expect_cells(4.0);
        assert_int_equal(result.pairs, 12);
        assert_true(result.candidates >= 6);
        assert_int_equal(peaks[0].votes, RHO_HOUGH_VOTE * (i < 3 ? 6u : 4u));
    }
}

static void pairs_without_a_time_difference_are_no_candidates(void **state)
{
    (void)state;
    for (int step = -1; step <= 0; step++) {
        points.at.num_scans = 0;
        for (unsigned scan = 0; scan < 5; scan++) {
            start_scan();
            add_plot(300.0 * scan, 1002.5, 2.0 * scan * step);
        }
        for (size_t i = 0; i < NUM(methods); i++) {
            use_paper_values_all_cells(methods[i]);
            config.v_min_mps = 0.0f;
            find_peaks();
            assert_int_equal(result.candidates, 0);
            assert_int_equal(result.votes_max, i > 1 ? 0 : RHO_HOUGH_VOTE * (methods[i] ? 4u : 5u));
        }
    }
}

static void all_sixteen_scans_vote(void **state)
{
    (void)state;
    points.at.num_scans = 0;
    for (unsigned scan = 0; scan < 16; scan++) {
        start_scan();
        add_plot(-2000.0 + 250.0 * scan, 1002.5, (double)scan);
    }
    const uint32_t highest[] = {16, 15, 15, 14, 14};
    for (size_t i = 0; i < NUM(methods); i++) {
        struct rho_hough_track track;
        use_paper_values(methods[i]);
        find_peaks();
        assert_int_equal(peaks[0].votes, highest[i] * RHO_HOUGH_VOTE);
        assert_int_equal(
            rho_hough_track(&hough, &points, peaks[0].theta_cell, peaks[0].rho_cell, 15.0f, &track),
            RHO_OK);
        assert_int_equal(track.mask, i < 3 ? 0xffff : 0xfffe);
        assert_int_equal(track.scans, i < 3 ? 16 : 15);
        assert_float_equal(track.x_m, 1750.0, 0.01);
        assert_float_equal(track.vx_mps, 250.0, 0.001);
    }
}

static void pairs_are_counted_without_a_search(void **state)
{
    (void)state;
    uint32_t pairs = 7, candidates = 7;
    random_state = 33;
    add_scene_of_table_1(7, 10.0, 1);
    use_paper_values(RHO_HOUGH_IHT);
    find_peaks();
    rho_hough_count_pairs(&hough, &points, &pairs, &candidates);
    assert_int_equal(pairs, result.pairs);
    assert_int_equal(candidates, result.candidates);
    assert_true(pairs > 10 * candidates / 2 && candidates > 1000);
}

static void earlier_contents_of_the_object_do_not_matter(void **state)
{
    (void)state;
    static struct rho_accumulator_peak first[20000];
    struct rho_hough_result first_result;
    random_state = 34;
    add_scene_of_table_1(7, 10.0, 1);
    for (size_t i = 0; i < 4 * NUM(methods); i++) {
        memset(&hough, 0, sizeof hough);
        use_paper_values(methods[i / 4]);
        config.keeps_all_cells = i & 1;
        config.uses_indeterminacy = 1;
        find_limited_peaks(20000);
        first_result = result;
        memcpy(first, peaks, sizeof first);
        memset(peaks, 0x77, sizeof first);
        memset(&hough, i & 2 ? 0xa5 : 0xff, sizeof hough);
        prepare_hough();
        memset(&hough.work, i & 2 ? 0x01 : 0xa5, sizeof hough.work);
        memset(&result, 0x13, sizeof result);
        for (int again = 0; again < 2; again++) {
            if (methods[i / 4] == RHO_HOUGH_HT && !again) {
                prepare_hough(); /* init sets up the accumulator */
            }
            assert_int_equal(rho_hough_find(&hough, &points, peaks, 20000, &result), RHO_OK);
            assert_memory_equal(&result, &first_result, sizeof result);
            assert_memory_equal(peaks, first, result.num_peaks * sizeof *first);
        }
    }
}

/* Results do not depend on the method or track computed before. */
static void methods_can_be_used_in_turn(void **state)
{
    (void)state;
    uint32_t num[NUM(methods)], most[NUM(methods)];
    struct rho_hough_track track;
    random_state = 35;
    add_scene_of_table_1(7, 10.0, 1);
    for (size_t i = 0; i < 15; i++) {
        size_t k = (i < 5 ? i : 3 * i + i / 5) % 5;
        use_paper_values(methods[k]);
        find_peaks();
        assert_true(i < 5 || (result.num_peaks == num[k] && result.votes_max == most[k]));
        num[k] = result.num_peaks;
        most[k] = result.votes_max;
        uint32_t before = peaks[0].votes;
        assert_int_equal(
            rho_hough_track(&hough, &points, peaks[0].theta_cell, peaks[0].rho_cell, 0.0f, &track),
            RHO_OK);
        assert_int_equal(rho_hough_find(&hough, &points, peaks, CELLS_MAX, &result), RHO_OK);
        assert_int_equal(peaks[0].votes, before);
        assert_int_equal(result.num_peaks, num[k]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_planes_are_refused),
        cmocka_unit_test(bad_thresholds_are_refused),
        cmocka_unit_test(other_sizes_and_null_are_refused),
        cmocka_unit_test(default_configurations_are_the_papers),
        cmocka_unit_test(cells_have_the_theta_and_rho_of_their_centres),
        cmocka_unit_test(null_is_refused),
        cmocka_unit_test(numbers_that_are_not_finite_or_too_large_are_refused),
        cmocka_unit_test(cells_outside_the_plane_and_bad_times_are_refused),
        cmocka_unit_test(scans_out_of_order_or_too_many_are_refused),
        cmocka_unit_test(a_scan_has_65535_plots_at_most),
        cmocka_unit_test(an_object_without_init_is_refused),
        cmocka_unit_test(limits_are_those_of_the_header),
        cmocka_unit_test(thresholds_are_not_rounded_down),
        cmocka_unit_test(the_best_peaks_are_the_same_for_any_room),
        cmocka_unit_test(a_relative_threshold_counts_the_cells_it_drops),
#ifndef RHO_PROFILE_WORKSTATION
        cmocka_unit_test(kernels_beyond_the_capacity_are_counted),
#endif
        cmocka_unit_test(without_plots_there_are_no_pairs_and_peaks),
        cmocka_unit_test(no_pair_spans_a_scan_without_plots),
        cmocka_unit_test(two_plots_in_one_place_do_not_vote),
        cmocka_unit_test(pairs_without_a_time_difference_are_no_candidates),
        cmocka_unit_test(all_sixteen_scans_vote),
        cmocka_unit_test(pairs_are_counted_without_a_search),
        cmocka_unit_test(earlier_contents_of_the_object_do_not_matter),
        cmocka_unit_test(methods_can_be_used_in_turn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
