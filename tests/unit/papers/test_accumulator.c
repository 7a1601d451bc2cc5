/* SPDX-License-Identifier: MIT */
/*
 * The streamed accumulator has the same peaks as one that holds the whole plane
 * (accumulator_reference.h).
 */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "accumulator_reference.h"
#include "rhotrack/detail/accumulator.h"
#include "rhotrack/types.h"

static uint32_t suppress_peaks(uint32_t num_peaks)
{
    struct rho_peak_distance distance = {accumulator.theta_cells, accumulator.rho_cells, 8, 8};
    return rho_peak_list_suppress(peaks, num_peaks, &distance);
}

static void peaks_agree_with_the_whole_plane_at_the_papers_cells(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    scatter_points(7, 60, 2500.0);
    expect_same_peaks(&config);
    scatter_points(7, 1500, 2900.0); /* more points than are stored one by one */
    config.min_votes = 5;
    expect_same_peaks(&config);
}

static void peaks_agree_with_the_whole_plane_at_coarse_cells(void **state)
{
    (void)state;
    for (int run = 0; run < 120; run++) {
        struct rho_accumulator_config config = {
            .rho_max_m = run % 2 ? 60000.0f : 20000.0f, /* some points are outside */
            .rho_cell_m = run % 5 ? 100.0f : 2000.0f,
            .theta_cell_rad = run % 5 ? 0.5f * DEG_RAD : 5.0f * DEG_RAD,
            .votes = run % 4 ? RHO_VOTES_SCANS : RHO_VOTES_POINTS,
            .min_votes = (uint16_t)(1 + run % 6)};
        unsigned num_scans = 1 + (unsigned)run % RHO_ACCUMULATOR_SCANS_MAX;
        unsigned count = (unsigned)uniform(0.0, run % 3 ? 250.0 : POINTS_MAX);
        scatter_points(num_scans, count, 25000.0);
        expect_same_peaks(&config);
    }
}

/* With few points and many, each of which takes another way through the rows. */
static void a_picture_has_the_votes_of_every_cell(void **state)
{
    (void)state;
    static uint32_t votes[36 * 86];
    for (int run = 0; run < 8; run++) {
        struct rho_accumulator_config config = paper_cells();
        struct rho_votes_picture picture = {.height = 36, .width = 86, .votes = votes};
        config.rho_cell_m = 100.0f;
        config.theta_cell_rad = 5.1f * DEG_RAD;
        config.votes = run % 2 ? RHO_VOTES_SCANS : RHO_VOTES_POINTS;
        scatter_points(run % 4 < 2 ? 7 : 12, run < 4 ? 40 : POINTS_MAX, 4000.0);
        init_accumulator_with_config(&config);
        assert_int_equal(rho_accumulator_plane(&accumulator, &points, &picture), RHO_OK);
        fill_plane();
        for (int i = 0; i < 36 * 86; i++) {
            assert_int_equal(votes[i], votes_at(i / 86, i % 86));
        }
        free(plane);
        picture.width = 87;
        assert_int_equal(rho_accumulator_plane(&accumulator, &points, &picture), RHO_ERROR_VALUE);
        assert_int_equal(rho_accumulator_plane(&accumulator, NULL, &picture), RHO_ERROR_NULL);
    }
}

/* A target on a line, with one point a scan. */
static void add_points_on_line(unsigned num_scans, double from_x_m, double from_y_m, double dx_m,
                               double dy_m)
{
    points.num_scans = num_scans;
    for (unsigned scan = 0; scan < num_scans; scan++) {
        x_m[scan] = (float)(from_x_m + dx_m * scan);
        y_m[scan] = (float)(from_y_m + dy_m * scan);
        scan_end[scan] = scan + 1;
    }
}

static void a_line_is_found_at_its_theta_and_rho(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    for (int heading = 0; heading < 36; heading++) {
        double course = (10.0 * heading + 3.0) * DEG_RAD;
        add_points_on_line(7, 800.0, 300.0, 400.0 * cos(course), 400.0 * sin(course));
        config.min_votes = 7;
        init_accumulator_with_config(&config);
        find_peaks(16);
        assert_true(result.num_peaks >= 1);
        assert_int_equal(peaks[0].mask, 0x7f);
        double theta = rho_accumulator_theta_rad(&accumulator, peaks[0].theta_cell);
        double rho =
            (peaks[0].rho_cell + 0.5) * (double)config.rho_cell_m - (double)config.rho_max_m;
        double normal = course + 1.5707963267948966;
        double turned = sin(theta - normal); /* 0 for parallel or opposite directions */
        assert_float_equal(turned, 0.0, 0.004);
        assert_float_equal(800.0 * cos(theta) + 300.0 * sin(theta), rho, 8.0);
    }
}

/* A line near theta = 0 is in the first and the last row: after suppression it is one peak. */
static void a_line_at_the_end_of_theta_is_one_peak(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    for (int i = 0; i < 21; i++) {
        double tilt_rad = (i - 10) * 2e-4;
        add_points_on_line(7, 2002.5 - 1200.0 * tilt_rad, -1200.0, 400.0 * tilt_rad, 400.0);
        config.min_votes = 7;
        init_accumulator_with_config(&config);
        find_peaks(PEAKS_MAX);
        uint32_t kept = suppress_peaks(result.num_peaks);
        assert_int_equal(kept, 1);
    }
}

static void a_scan_votes_once_in_a_cell_and_points_vote_each(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    points.num_scans = 3;
    for (unsigned i = 0; i < 12; i++) {
        x_m[i] = 1000.0f + 100.0f * (float)i;
        y_m[i] = 500.0f;
    }
    scan_end[0] = 10;
    scan_end[1] = 11;
    scan_end[2] = 12;
    init_accumulator_with_config(&config);
    find_peaks(4);
    assert_int_equal(peaks[0].votes, 3);
    config.votes = RHO_VOTES_POINTS;
    init_accumulator_with_config(&config);
    find_peaks(4);
    assert_int_equal(peaks[0].votes, 12);
    assert_int_equal(peaks[0].mask, 0);
}

static void the_best_peaks_are_kept_and_the_others_counted(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    scatter_points(7, 200, 2500.0);
    config.min_votes = 2;
    init_accumulator_with_config(&config);
    find_peaks(PEAKS_MAX);
    uint32_t all = result.num_peaks, votes = result.votes;
    assert_true(all > 100);
    assert_int_equal(votes, 200u * accumulator.theta_cells);
    memcpy(expected, peaks, all * sizeof peaks[0]);
    for (uint32_t most = 0; most < 100; most += 9) {
        find_peaks(most);
        assert_int_equal(result.num_peaks, most);
        assert_int_equal(result.peaks_dropped, all - most);
        assert_memory_equal(peaks, expected, most * sizeof peaks[0]);
    }
}

/* The result is the same for any room for peaks, wherever the cell with most votes is found. */
static void a_threshold_may_be_a_share_of_the_most_votes(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    for (int run = 0; run < 8; run++) {
        scatter_points(7, run % 2 ? 200 : 1500, 2500.0);
        config.min_votes = 2;
        config.min_share = 0.0f;
        config.votes = run % 4 ? RHO_VOTES_SCANS : RHO_VOTES_POINTS;
        init_accumulator_with_config(&config);
        find_peaks(PEAKS_MAX);
        uint32_t most = result.votes_max, least = (uint32_t)ceil(0.6 * most), count = 0;
        while (count < result.num_peaks && peaks[count].votes >= least) {
            count++;
        }
        memcpy(expected, peaks, count * sizeof peaks[0]);
        config.min_share = 0.6f;
        init_accumulator_with_config(&config);
        for (uint32_t room = count + 1; room <= PEAKS_MAX;
             room = room < PEAKS_MAX ? PEAKS_MAX : room + 1) {
            find_peaks(room);
            assert_int_equal(result.num_peaks, count);
            assert_int_equal(result.votes_max, most);
            assert_int_equal(result.peaks_dropped, 0);
            assert_memory_equal(peaks, expected, count * sizeof peaks[0]);
        }
        find_peaks(count / 2);
        assert_int_equal(result.num_peaks, count / 2);
        assert_true(result.peaks_dropped >= count - count / 2);
        assert_memory_equal(peaks, expected, count / 2 * sizeof peaks[0]);
    }
}

/* Beyond 2^24 float does not hold a number of votes exactly. */
static void a_share_of_1_keeps_the_peak_with_the_most_votes(void **state)
{
    (void)state;
    const uint32_t votes[] = {16777219u, 33554435u, 4294967295u, 4000000001u, 1u};
    for (size_t i = 0; i < sizeof votes / sizeof votes[0]; i++) {
        struct rho_accumulator_peak room[2];
        struct rho_peak_list list = {.peaks = room, .max_peaks = 2, .min_share = 1.0f};
        rho_peak_list_offer(&list, (struct rho_accumulator_peak){.votes = votes[i]});
        rho_peak_list_offer(&list, (struct rho_accumulator_peak){.votes = votes[i] / 2u});
        rho_peak_list_sort(&list);
        assert_int_equal(list.num_peaks, 1);
        assert_int_equal(room[0].votes, votes[i]);
    }
}

static void points_beyond_the_largest_rho_do_not_vote(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    config.min_votes = 1;
    config.rho_max_m = 1000.0f;
    add_points_on_line(1, 3000.0, 0.0, 0.0, 0.0);
    expect_same_peaks(&config);
    /* |3000 cos theta| < 1000 for 2 asin(1 / 3) of pi */
    double share = 2.0 * asin(1.0 / 3.0) / 3.14159265358979;
    assert_float_equal(result.votes, share * accumulator.theta_cells, 3.0);
}

static void earlier_contents_of_the_accumulator_do_not_matter(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    static struct rho_accumulator_peak first[64];
    scatter_points(7, 100, 2500.0);
    init_accumulator_with_config(&config);
    find_peaks(64);
    uint32_t count = result.num_peaks;
    memcpy(first, peaks, sizeof first);
    for (int run = 0; run < 2; run++) {
        memset(accumulator.row, 0xa5, sizeof accumulator.row);
        memset(&accumulator.few, 0xa5, sizeof accumulator.few);
        memset(accumulator.cells, run ? 0x7f : 0xff, sizeof accumulator.cells);
        find_peaks(64);
        assert_int_equal(result.num_peaks, count);
        assert_memory_equal(peaks, first, count * sizeof peaks[0]);
    }
}

static void without_points_there_are_no_peaks(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    init_accumulator_with_config(&config);
    points.num_scans = 0;
    find_peaks(4);
    assert_int_equal(result.num_peaks + result.votes + result.votes_max, 0);
    scatter_points(4, 0, 1.0);
    find_peaks(4);
    assert_int_equal(result.num_peaks + result.votes + result.votes_max, 0);
}

static int are_peaks_near(const struct rho_accumulator_peak *a,
                          const struct rho_accumulator_peak *b, int theta_cells, int rho_cells)
{
    for (int turn = -1; turn <= 1; turn++) {
        int theta = b->theta_cell + turn * num_theta();
        int rho = turn ? num_rho() - 1 - b->rho_cell : b->rho_cell;
        if (abs(a->theta_cell - theta) <= theta_cells && abs(a->rho_cell - rho) <= rho_cells) {
            return 1;
        }
    }
    return 0;
}

static void suppression_keeps_the_best_of_each_neighbourhood(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    scatter_points(7, 150, 2500.0);
    config.min_votes = 3;
    init_accumulator_with_config(&config);
    find_peaks(3000);
    uint32_t all = result.num_peaks, kept = 0;
    for (uint32_t i = 0; i < all; i++) {
        uint32_t k = 0;
        while (k < kept && !are_peaks_near(&expected[k], &peaks[i], 8, 8)) {
            k++;
        }
        if (k == kept) {
            expected[kept++] = peaks[i];
        }
    }
    assert_true(all > 500);
    assert_int_equal(suppress_peaks(all), kept);
    assert_memory_equal(peaks, expected, kept * sizeof peaks[0]);
    assert_true(kept < all);
}

#define REFUSED(field, value)                                                                      \
    do {                                                                                           \
        struct rho_accumulator_config bad = paper_cells();                                         \
        uint16_t rows = 0, cells = 0;                                                              \
        bad.field = (value);                                                                       \
        assert_int_equal(rho_accumulator_count_cells(&bad, &rows, &cells), RHO_ERROR_CONFIG);      \
        assert_int_equal(rho_accumulator_init(&accumulator, sizeof accumulator, &bad),             \
                         RHO_ERROR_CONFIG);                                                        \
    } while (0)

static void bad_configs_are_refused(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    assert_int_equal(rho_accumulator_init(NULL, sizeof accumulator, &config), RHO_ERROR_NULL);
    assert_int_equal(rho_accumulator_init(&accumulator, sizeof accumulator, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_accumulator_init(&accumulator, 7, &config), RHO_ERROR_SIZE);
    REFUSED(rho_max_m, 0.0f);
    REFUSED(rho_max_m, NAN);
    REFUSED(rho_max_m, 2.6f * RHO_MAX_RHO_CELLS);
    REFUSED(rho_cell_m, 0.0f);
    REFUSED(rho_cell_m, INFINITY);
    REFUSED(theta_cell_rad, 9e-5f);
    REFUSED(theta_cell_rad, 3.2f);
    REFUSED(theta_cell_rad, NAN);
    REFUSED(votes, (enum rho_accumulator_votes)2);
    REFUSED(min_votes, 0);
    REFUSED(min_share, 1.1f);
    REFUSED(min_share, NAN);
    REFUSED(no_pruning, 2);
    uint16_t rows, cells;
    config.theta_cell_rad = 1.01e-4f;
    assert_int_equal(rho_accumulator_count_cells(&config, &rows, &cells), RHO_OK);
    assert_int_equal(rows, 31105);
}

static void bad_points_are_refused(void **state)
{
    (void)state;
    struct rho_accumulator_config config = paper_cells();
    struct rho_accumulator_points none = {.num_scans = 1};
    const float bad[] = {NAN, INFINITY, -INFINITY, 2.1e6f, -FLT_MAX};
    scatter_points(3, 30, 1000.0);
    init_accumulator_with_config(&config);
    assert_int_equal(rho_accumulator_find_peaks(NULL, &points, peaks, 4, &result), RHO_ERROR_NULL);
    assert_int_equal(rho_accumulator_find_peaks(&accumulator, NULL, peaks, 4, &result),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_accumulator_find_peaks(&accumulator, &points, NULL, 4, &result),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_accumulator_find_peaks(&accumulator, &points, peaks, 4, NULL),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_accumulator_find_peaks(&accumulator, &none, peaks, 4, &result),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_accumulator_check_points(NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_accumulator_check_points(&none), RHO_ERROR_NULL);
    assert_int_equal(rho_accumulator_check_points(&points), RHO_OK);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        float was = x_m[i];
        x_m[i] = bad[i];
        assert_int_equal(rho_accumulator_find_peaks(&accumulator, &points, peaks, 4, &result),
                         RHO_ERROR_VALUE);
        assert_int_equal(rho_accumulator_check_points(&points), RHO_ERROR_VALUE);
        x_m[i] = was;
    }
    points.num_scans = RHO_ACCUMULATOR_SCANS_MAX + 1u;
    assert_int_equal(rho_accumulator_find_peaks(&accumulator, &points, peaks, 4, &result),
                     RHO_ERROR_VALUE);
    assert_int_equal(rho_accumulator_check_points(&points), RHO_ERROR_VALUE);
    points.num_scans = 3;
    scan_end[1] = 31; /* beyond the last scan's end */
    assert_int_equal(rho_accumulator_find_peaks(&accumulator, &points, peaks, 4, &result),
                     RHO_ERROR_VALUE);
    accumulator.magic = 0;
    assert_int_equal(rho_accumulator_find_peaks(&accumulator, &points, peaks, 4, &result),
                     RHO_ERROR_STATE);
}

/* 3142 rows of 1 mrad and 1720 cells of 5 m in 8600 m; an incomplete last row counts. */
static void the_plane_has_the_papers_numbers_of_cells(void **state)
{
    struct rho_accumulator_config config = paper_cells();
    uint16_t rows = 0, cells = 0;

    (void)state;
    assert_int_equal(rho_accumulator_count_cells(&config, &rows, &cells), RHO_OK);
    assert_int_equal(rows, 3142);
    assert_int_equal(cells, 1720);
    config.theta_cell_rad = 0.5f;
    assert_int_equal(rho_accumulator_count_cells(&config, &rows, &cells), RHO_OK);
    assert_int_equal(rows, 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(peaks_agree_with_the_whole_plane_at_the_papers_cells),
        cmocka_unit_test(peaks_agree_with_the_whole_plane_at_coarse_cells),
        cmocka_unit_test(a_picture_has_the_votes_of_every_cell),
        cmocka_unit_test(a_line_is_found_at_its_theta_and_rho),
        cmocka_unit_test(a_line_at_the_end_of_theta_is_one_peak),
        cmocka_unit_test(a_scan_votes_once_in_a_cell_and_points_vote_each),
        cmocka_unit_test(the_best_peaks_are_kept_and_the_others_counted),
        cmocka_unit_test(a_threshold_may_be_a_share_of_the_most_votes),
        cmocka_unit_test(a_share_of_1_keeps_the_peak_with_the_most_votes),
        cmocka_unit_test(points_beyond_the_largest_rho_do_not_vote),
        cmocka_unit_test(earlier_contents_of_the_accumulator_do_not_matter),
        cmocka_unit_test(without_points_there_are_no_peaks),
        cmocka_unit_test(suppression_keeps_the_best_of_each_neighbourhood),
        cmocka_unit_test(bad_configs_are_refused),
        cmocka_unit_test(bad_points_are_refused),
        cmocka_unit_test(the_plane_has_the_papers_numbers_of_cells),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
