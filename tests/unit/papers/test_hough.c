/* SPDX-License-Identifier: MIT */
/*
 * Known results of the papers' methods: the ideal scene of Table 1 and the radar plots of Table 3.
 * The Hough transform compared with double precision, the plots that voted for a cell, and the fit
 * through them.
 */
#include "expect_hough_cells_and_peaks.h"

#define NUM(array) (sizeof(array) / sizeof((array)[0]))

static const enum rho_hough_method methods[] = {RHO_HOUGH_HT, RHO_HOUGH_MHT, RHO_HOUGH_IHT,
                                                RHO_HOUGH_NHT_A, RHO_HOUGH_NHT_C};

static struct line line_of_target(int target)
{
    return line_of_plots((unsigned)target, (unsigned)(target + 3));
}

/* The best peak near a line; 0 votes if there is none. */
static struct rho_accumulator_peak peak_near(struct line line)
{
    for (uint32_t i = 0; i < result.num_peaks; i++) {
        struct line at = {rho_hough_rho_m(&hough, peaks[i].rho_cell),
                          rho_hough_theta_rad(&hough, peaks[i].theta_cell)};
        struct line away = line_offset(line, at);
        if (fabs(away.rho) < 10.0 && fabs(away.theta) < 0.003) {
            return peaks[i];
        }
    }
    return (struct rho_accumulator_peak){0};
}

static void the_three_targets_of_table_1_have_the_most_votes(void **state)
{
    (void)state;
    const uint32_t highest[] = {7, 6, 6, 5};
    add_scene_of_table_1(7, 0.0, 0);
    for (size_t i = 0; i < NUM(highest); i++) {
        use_paper_values(methods[i]);
        find_peaks();
        assert_in_range(result.votes_max, highest[i] * RHO_HOUGH_VOTE - 20,
                        highest[i] * RHO_HOUGH_VOTE);
        for (int target = 0; target < 3; target++) {
            assert_true(peak_near(line_of_target(target)).votes + RHO_HOUGH_VOTE >=
                        result.votes_max);
        }
        assert_int_equal(result.pairs, methods[i] == RHO_HOUGH_HT ? 0 : 54);
    }
}

/* With speed limits and kernels the three targets are the only peaks. */
static void neutrosophic_methods_find_only_the_targets_of_table_1(void **state)
{
    (void)state;
    add_scene_of_table_1(7, 0.0, 0);
    use_paper_values(RHO_HOUGH_NHT_A);
    find_peaks();
    assert_int_equal(result.num_peaks, 3);
    use_paper_values(RHO_HOUGH_NHT_C);
    find_peaks();
    assert_int_equal(result.num_peaks, 3);
    assert_int_equal(result.votes, 3 * 5 * 289);
}

#ifdef RHO_PROFILE_WORKSTATION /* needs 14400 cells of rho */

static void add_plots_of_table_3(void)
{
    static const float plots[7][3][2] = {{{-23793, 24841}, {-2548, 21411}, {-7021, 14156}},
                                         {{-21011, 25246}, {-5080, 20251}, {-8675, 16448}},
                                         {{-18300, 25575}, {-7720, 19125}, {-10248, 18720}},
                                         {{-15547, 25858}, {-10322, 17938}, {-11849, 21086}},
                                         {{-12823, 26185}, {-12766, 16739}, {-13363, 23508}},
                                         {{-10050, 26402}, {-15310, 15467}, {-14961, 25823}},
                                         {{-7248, 26643}, {-17794, 14169}, {-16459, 28155}}};
    points.at.num_scans = 0;
    for (unsigned scan = 0; scan < 7; scan++) {
        start_scan();
        for (int i = 0; i < 3; i++) {
            add_plot((double)plots[scan][i][0], (double)plots[scan][i][1], 10.0 * scan);
        }
    }
}

/* The radar plots are not straight enough for cells of 1 mrad: no method has a high peak. */
static void the_plots_of_table_3_make_no_high_peak(void **state)
{
    (void)state;
    const double highest[] = {3.0, 1.0, 1.0, 0.0533};
    add_plots_of_table_3();
    for (size_t i = 0; i < NUM(highest); i++) {
        use_paper_values_all_cells(methods[i]);
        config.rho_max_m = 36000.0f;
        find_peaks();
        expect_reference();
        expect_cells(methods[i] == RHO_HOUGH_NHT_A ? 8.0 : 0.0);
        assert_float_equal(result.votes_max / 65536.0, highest[i], 6e-5);
        assert_int_equal(result.pairs, i ? 54 : 0);
        assert_int_equal(result.candidates, i ? 21 : 0);
    }
    assert_int_equal(result.votes, 1);
    assert_int_equal(result.num_peaks, 1);
}

#endif

/* The lines y = 500 and y = -500, which |rho| alone would not tell apart, and x = +-500. */
static void lines_mirrored_in_an_axis_are_two_peaks(void **state)
{
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        points.at.num_scans = 0;
        for (unsigned scan = 0; scan < 7; scan++) {
            double along = -1000.0 + 450.0 * scan;
            start_scan();
            for (int side = -1; side <= 1; side += 2) {
                double across = side * 502.5;
                add_plot(turned ? across : along, turned ? along : across, 2.0 * scan);
            }
        }
        for (size_t i = 0; i < NUM(methods); i++) {
            use_paper_values(methods[i]);
            config.tau = 0.8f;
            find_peaks();
            assert_int_equal(result.num_peaks, 2);
            assert_int_equal(peaks[0].votes, peaks[1].votes);
            assert_int_equal(peaks[0].rho_cell + peaks[1].rho_cell, 1999);
            assert_true(peaks[0].rho_cell >= 1099 || peaks[0].rho_cell <= 900);
        }
    }
}

static void hough_votes_agree_with_double_precision(void **state)
{
    (void)state;
    random_state = 21;
    for (int run = 0; run < 6; run++) {
        add_scene_of_table_1(7 + (unsigned)run, 20.0, 0);
        add_plot(run % 2 ? 6000.0 : 4000.0, 100.0, 12.0); /* a plot partly beyond rho_max */
        use_paper_values_all_cells(RHO_HOUGH_HT);
        config.votes = run % 3 ? RHO_VOTES_POINTS : RHO_VOTES_SCANS;
        find_peaks();
        expect_reference();
        expect_cells(0.0);
        assert_int_equal(result.pairs + result.candidates + result.cells, 0);
        for (uint32_t i = 0; i < result.num_peaks; i++) {
            unsigned mask = peaks[i].mask, bits = 0;
            for (; mask; mask &= mask - 1) {
                bits++;
            }
            assert_int_equal(bits * RHO_HOUGH_VOTE, run % 3 ? 0 : peaks[i].votes);
        }
        config.tau = 0.5f;
        config.votes_min = (float)(run % 4);
        config.keeps_all_cells = 0;
        size_t num = choose_from_listed();
        find_peaks();
        expect_peaks_as_listed(num);
    }
}

/* Each scan has three plots on the line: 12 points, 4 scans. */
static void votes_count_points_or_scans(void **state)
{
    (void)state;
    points.at.num_scans = 0;
    for (unsigned scan = 0; scan < 4; scan++) {
        start_scan();
        for (int i = 0; i < 3; i++) {
            add_plot(300.0 * scan + 100.0 * i, 1002.5, 2.0 * scan);
        }
    }
    use_paper_values(RHO_HOUGH_HT);
    find_peaks();
    assert_int_equal(peaks[0].votes, 12 * RHO_HOUGH_VOTE);
    assert_int_equal(peaks[0].mask, 0);
    assert_int_equal(result.votes, 12 * 3142);
    config.votes = RHO_VOTES_SCANS;
    find_peaks();
    assert_int_equal(peaks[0].votes, 4 * RHO_HOUGH_VOTE);
    assert_int_equal(peaks[0].mask, 0xf);
}

/* The plots that voted for a cell; is_sure is 0 if some vote was near a limit. */
struct voters {
    uint8_t plots[PLOTS_MAX];
    int is_sure;
};

static struct voters voters;

static void note_expected_voter_of_peak(unsigned plot, int is_sure)
{
    voters.plots[plot] = 1;
    voters.is_sure &= is_sure;
}

/* True if a vote for the pair's own cell also counts for this cell. */
static int does_vote_reach_cell(struct place cell, struct place own)
{
    if (config.method == RHO_HOUGH_NHT_C) {
        return is_peak_within_neighbourhood(&(struct peak){0.0, own}, &(struct peak){0.0, cell});
    }
    return own.theta == cell.theta && own.rho == cell.rho;
}

static void add_voters_of_pair(const struct pair *pair, const struct pairs *kernels,
                               struct place cell)
{
    struct place places[5];
    int num = possible_places_of_line(pair->line, places), getting = 0;
    for (int i = 0; i < num; i++) {
        getting += does_vote_reach_cell(cell, places[i]);
    }
    struct vote_bounds bounds =
        getting ? vote_bounds_of_pair(pair, kernels) : (struct vote_bounds){0.0, 0.0, 0.0};
    if (bounds.most > 0.0) {
        int is_sure = num == 1 && bounds.least > 0.0;
        note_expected_voter_of_peak(pair->a, is_sure);
        note_expected_voter_of_peak(pair->b, is_sure);
    }
}

static void add_voters_of_pairs(struct place cell)
{
    struct pairs before = {NULL, 0};
    for (unsigned scan = 1; scan < points.at.num_scans; scan++) {
        struct pairs pairs = voting_pairs_of_scan(scan);
        for (size_t i = 0; i < pairs.num; i++) {
            add_voters_of_pair(&pairs.list[i], &before, cell);
        }
        free(before.list);
        before = pairs;
    }
    free(before.list);
}

static void add_voters_of_plots(struct rho_accumulator_peak peak)
{
    double theta = ((double)peak.theta_cell + 0.5) * (double)config.theta_cell_rad;
    for (unsigned i = 0; i < num_plots(); i++) {
        double rho = (double)x_m[i] * cos(theta) + (double)y_m[i] * sin(theta);
        double at = (rho + (double)config.rho_max_m) / (double)config.rho_cell_m - peak.rho_cell;
        if (at > -4e-3 && at < 1.0 + 4e-3) {
            note_expected_voter_of_peak(i, at > 4e-3 && at < 1.0 - 4e-3);
        }
    }
}

static void find_voters(struct rho_accumulator_peak peak)
{
    memset(&voters, 0, sizeof voters);
    voters.is_sure = 1;
    if (config.method == RHO_HOUGH_HT) {
        add_voters_of_plots(peak);
    } else {
        add_voters_of_pairs((struct place){peak.theta_cell, peak.rho_cell});
    }
}

/* Sums of a least squares line about the mean time. */
struct fit {
    unsigned num, mask;
    double t, z, zt, tt;
};

static struct fit fit_through(const float *z)
{
    struct fit fit = {0};
    for (unsigned i = 0; i < num_plots(); i++) {
        if (voters.plots[i]) {
            fit.num++;
            fit.mask |= 1u << scan_of(i);
            fit.t += (double)t_s[i];
            fit.z += (double)z[i];
        }
    }
    fit.t /= fit.num;
    fit.z /= fit.num;
    for (unsigned i = 0; i < num_plots(); i++) {
        if (voters.plots[i]) {
            fit.zt += ((double)z[i] - fit.z) * ((double)t_s[i] - fit.t);
            fit.tt += ((double)t_s[i] - fit.t) * ((double)t_s[i] - fit.t);
        }
    }
    return fit;
}

static unsigned count_set_bits(unsigned mask)
{
    unsigned n = 0;
    for (; mask; mask &= mask - 1) {
        n++;
    }
    return n;
}

static void expect_fit_of_axis(const struct fit *fit, int has_velocity, float at, float velocity,
                               double at_s)
{
    double slope = has_velocity ? fit->zt / fit->tt : 0.0;
    assert_float_equal(velocity, slope, 2e-3);
    double place = fit->z + slope * (at_s - fit->t);
    assert_float_equal(at, place, 1e-2 + 2e-6 * fabs(place));
}

static void expect_track_of_peak(struct rho_accumulator_peak peak, float at_s)
{
    struct rho_hough_track track;
    memset(&track, 0x5a, sizeof track);
    assert_int_equal(rho_hough_track(&hough, &points, peak.theta_cell, peak.rho_cell, at_s, &track),
                     RHO_OK);
    struct fit x = fit_through(x_m), y = fit_through(y_m);
    uint32_t slack = config.method == RHO_HOUGH_NHT_C ? 2 * x.num : 0;
    assert_true(track.votes <= peak.votes + slack && peak.votes <= track.votes + slack);
    assert_int_equal(track.num_plots, x.num);
    assert_int_equal(track.mask, x.mask);
    assert_int_equal(track.scans, count_set_bits(x.mask));
    assert_true(!peak.mask || track.mask == peak.mask);
    assert_int_equal(!!track.has_velocity, track.scans >= 2);
    expect_fit_of_axis(&x, track.has_velocity, track.x_m, track.vx_mps, (double)at_s);
    expect_fit_of_axis(&y, track.has_velocity, track.y_m, track.vy_mps, (double)at_s);
}

/* Compares tracks of the ten best cells, and of every step-th further one. */
static unsigned expect_tracks_of_peaks(uint32_t step)
{
    unsigned sure = 0;
    for (uint32_t i = 0; i < result.num_peaks; i += i < 10 ? 1 : step) {
        find_voters(peaks[i]);
        if (voters.is_sure) {
            expect_track_of_peak(peaks[i], (float)(i % 4) * 5.0f - 3.0f);
            sure++;
        }
    }
    return sure;
}

static void tracks_are_fitted_to_the_plots_that_voted(void **state)
{
    (void)state;
    unsigned sure = 0;
    random_state = 22;
    for (int run = 0; run < 20; run++) {
        add_scene_of_table_1(run % 3 ? 7 : 4, run % 2 ? 10.0 : 0.5, run < 10);
        use_paper_values(methods[run % 5]);
        config.uses_indeterminacy = run % 2;
        config.votes = run < 10 ? RHO_VOTES_POINTS : RHO_VOTES_SCANS;
        config.tau = 0.3f;
        config.lambda_k = 10.0f;
        find_peaks();
        sure += expect_tracks_of_peaks(1 + result.num_peaks / 10);
    }
    assert_true(sure > 150);
}

static void tracks_agree_for_other_cell_sizes(void **state)
{
    (void)state;
    unsigned sure = 0;
    random_state = 24;
    for (int run = 0; run < 20; run++) {
        add_scene_of_table_1(7, 10.0, 0);
        use_paper_values(methods[run % 5]);
        config.keeps_all_cells = 1;
        config.tau = 0.1f;
        config.rho_cell_m = (float)uniform(10.0, 60.0);
        config.theta_cell_rad = (float)(REFERENCE_PI / uniform(6.0, run < 10 ? 60.0 : 2000.0));
        config.eps_rho_m = (float)uniform(5.0, 100.0);
        config.eps_theta_rad = (float)fmin(uniform(0.5, 5.0) * (double)config.theta_cell_rad, 0.5);
        find_peaks();
        sure += expect_tracks_of_peaks(1 + result.num_peaks / 10);
    }
    assert_true(sure > 150);
}

static void tracks_agree_at_the_ends_of_theta(void **state)
{
    (void)state;
    random_state = 23;
    for (int run = 0; run < 15; run++) {
        points.at.num_scans = 0;
        for (unsigned scan = 0; scan < 16; scan++) {
            start_scan();
            add_plot(-1500.0 + 0.5 * normal(), -2000.0 + 250.0 * scan, (double)scan);
            add_plot(900.0 + 0.5 * normal(), 2000.0 - 250.0 * scan, (double)scan);
        }
        use_paper_values(methods[run % 5]);
        config.keeps_all_cells = 1;
        config.tau = 0.1f;
        find_peaks();
        assert_true(expect_tracks_of_peaks(1 + result.num_peaks / 10) > 5);
    }
}

/* The place is extrapolated to any time, and the velocity stays. */
static void a_tracks_velocity_does_not_depend_on_its_time(void **state)
{
    (void)state;
    const float at_s[] = {0.0f, 100.0f, -600.0f, 3600.0f, 100000.0f};
    add_scene_of_table_1(7, 0.0, 0);
    use_paper_values(RHO_HOUGH_IHT);
    find_peaks();
    for (size_t i = 0; i < NUM(at_s); i++) {
        find_voters(peaks[0]);
        expect_track_of_peak(peaks[0], at_s[i]);
    }
}

/* A cell without votes may be asked for. */
static void a_cell_without_votes_has_no_track(void **state)
{
    (void)state;
    add_scene_of_table_1(7, 0.0, 0);
    for (size_t i = 0; i < NUM(methods); i++) {
        struct rho_hough_track track;
        memset(&track, 0x5a, sizeof track);
        use_paper_values(methods[i]);
        prepare_hough();
        assert_int_equal(rho_hough_track(&hough, &points, 3141, 1999, 5.0f, &track), RHO_OK);
        assert_int_equal(track.votes + track.num_plots + track.mask + track.scans, 0);
        assert_int_equal(track.has_velocity, 0);
        assert_true(isfinite(track.x_m) && isfinite(track.y_m));
        assert_true(track.vx_mps == 0.0f && track.vy_mps == 0.0f);
    }
}

/* One plot alone gives a place. */
static void a_track_of_one_scan_has_a_place_and_no_velocity(void **state)
{
    (void)state;
    points.at.num_scans = 0;
    start_scan();
    start_scan();
    add_plot(1000.0, 500.0, 3.0);
    use_paper_values(RHO_HOUGH_HT);
    find_limited_peaks(1);
    find_voters(peaks[0]);
    expect_track_of_peak(peaks[0], 9.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_three_targets_of_table_1_have_the_most_votes),
        cmocka_unit_test(neutrosophic_methods_find_only_the_targets_of_table_1),
#ifdef RHO_PROFILE_WORKSTATION
        cmocka_unit_test(the_plots_of_table_3_make_no_high_peak),
#endif
        cmocka_unit_test(lines_mirrored_in_an_axis_are_two_peaks),
        cmocka_unit_test(hough_votes_agree_with_double_precision),
        cmocka_unit_test(votes_count_points_or_scans),
        cmocka_unit_test(tracks_are_fitted_to_the_plots_that_voted),
        cmocka_unit_test(tracks_agree_for_other_cell_sizes),
        cmocka_unit_test(tracks_agree_at_the_ends_of_theta),
        cmocka_unit_test(a_tracks_velocity_does_not_depend_on_its_time),
        cmocka_unit_test(a_cell_without_votes_has_no_track),
        cmocka_unit_test(a_track_of_one_scan_has_a_place_and_no_velocity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
