/* SPDX-License-Identifier: MIT */
/*
 * Thresholds of the initiation from clutter and an allowed rate of false tracks, and the rates that
 * result. Noise of 10 m, scans of 2 s, targets of 100 to 400 m/s. The prior of a turn is tested
 * through a private header, as scores show it only in sums.
 */
#include "../../src/initiation/search.h"
#include "initiator_setup.h"
#include "rhotrack/tracker.h"

#define SCANS 7
#define SCAN_S 2.0
#define MNAT 1e-3

static const struct rho_extent square = {-2500.0f, 2500.0f, -2500.0f, 2500.0f};
static const int counts[] = {0, 1, 5, 25, 100, 250}; /* clutter plots a scan */
static const float rates[] = {1e-4f, 0.01f, 0.1f, 1.0f, 10.0f, 100.0f, 1e4f};

static struct rho_initiator_config test_config(float false_tracks_per_hour)
{
    struct rho_initiator_config config;
    rho_initiator_config_default(&config);
    config.v_min_mps = 100.0f;
    config.v_max_mps = 400.0f;
    config.false_tracks_per_hour = false_tracks_per_hour;
    config.work_max = 0; /* no limit, so that thresholds alone decide */
    config.area_is_fixed = 1;
    config.area = square;
    return config;
}

/*
 * Pushes a window of clutter, equal at every call, and targets in line, each seen from one scan
 * later on than the one before.
 */
static void push_clutter_and_targets(const struct rho_initiator_config *config, int count,
                                     int targets, double scan_s)
{
    random_state = 3;
    start_initiator(config);
    for (int k = 0; k < SCANS; k++) {
        add_clutter_plots(&config->area, count);
        for (int i = 0; i < targets && i <= k; i++) {
            double y_m = -2000.0 + 1000.0 * i + 8.0 * normal();
            add_plot(100.0 * scan_s * (k - 3) + 8.0 * normal(), y_m, 10.0, 10.0);
        }
        push_plots(scan_s * k);
    }
}

static void search_clutter(const struct rho_initiator_config *config, int count)
{
    push_clutter_and_targets(config, count, 0, SCAN_S);
    search_window(RHO_SEARCH_NEWEST);
}

static void search_targets(const struct rho_initiator_config *config, int count)
{
    push_clutter_and_targets(config, count, 5, SCAN_S);
    search_window(RHO_SEARCH_NEWEST);
}

static unsigned count_confirmed(void)
{
    unsigned n = 0;
    for (unsigned i = 0; i < initiator.num_candidates; i++) {
        n += initiator.candidates[i].score_mnat >= initiator.confirm_mnat;
    }
    return n;
}

static void a_target_without_clutter_is_confirmed_at_its_third_plot(void **state)
{
    (void)state;
    for (int i = 0; i < 200; i++) {
        struct rho_initiator_config config = test_config(1.0f);
        double heading = uniform(0.0, 2.0 * PI), v_mps = uniform(120.0, 380.0);
        start_initiator(&config);
        for (int empty = 0; empty < i % 5; empty++) {
            push_plots(SCAN_S * empty);
        }
        for (int k = 0; k < 3; k++) {
            double way_m = v_mps * SCAN_S * (k - 1);
            add_plot(way_m * cos(heading) + uniform(-10.0, 10.0),
                     way_m * sin(heading) + uniform(-10.0, 10.0), 10.0, 10.0);
            push_plots(SCAN_S * (k + i % 5));
            search_window(RHO_SEARCH_NEWEST);
            assert_int_equal(initiator.num_candidates, k == 2);
        }
        assert_int_equal(count_confirmed(), 1);
    }
}

/* Rates that differ by 18 nat move the threshold by about as much, if there is enough clutter. */
static void the_confirmation_threshold_falls_with_the_allowed_rate(void **state)
{
    (void)state;
    for (size_t c = 0; c < NUM(counts); c++) {
        int32_t before_mnat = INT32_MAX, highest_mnat = 0;
        for (size_t r = 0; r < NUM(rates); r++) {
            struct rho_initiator_config config = test_config(rates[r]);
            search_clutter(&config, counts[c]);
            assert_true(initiator.confirm_mnat <= before_mnat);
            assert_true(initiator.start_mnat <= initiator.confirm_mnat);
            before_mnat = initiator.confirm_mnat;
            highest_mnat = r == 0 ? initiator.confirm_mnat : highest_mnat;
        }
        assert_true(counts[c] < 5 || highest_mnat - before_mnat > 8000);
        assert_int_equal(before_mnat,
                         /* at 10 000 an hour every started track is confirmed */
                         initiator.start_mnat);
    }
}

static void a_higher_allowed_rate_never_gives_fewer_tracks(void **state)
{
    (void)state;
    unsigned first = 0, last = 0, unsure = 0;
    for (size_t c = 0; c < NUM(counts); c++) {
        unsigned tracks = 0, candidates = 0;
        for (size_t r = 0; r < NUM(rates); r++) {
            struct rho_initiator_config config = test_config(rates[r]);
            search_targets(&config, counts[c]);
            assert_true(initiator.num_candidates >= candidates);
            assert_true(count_confirmed() >= tracks);
            candidates = initiator.num_candidates;
            tracks = count_confirmed();
            first += r == 0 ? tracks : 0;
            unsure += r == 0 ? candidates - tracks : 0;
        }
        last += tracks;
    }
    assert_true(last > first + 5);
    assert_true(unsure > 5); /* tracks that start unconfirmed */
}

static void candidates_reach_the_start_threshold(void **state)
{
    (void)state;
    unsigned found = 0;
    for (size_t c = 0; c < NUM(counts); c++) {
        struct rho_initiator_config config = test_config(1.0f);
        search_targets(&config, counts[c]);
        found += initiator.num_candidates;
        for (unsigned i = 0; i < initiator.num_candidates; i++) {
            assert_true(initiator.candidates[i].score_mnat >= initiator.start_mnat);
            assert_true(initiator.candidates[i].hits >= initiator.min_scans);
        }
    }
    assert_true(found > 10);
}

static void denser_clutter_requires_more_votes(void **state)
{
    (void)state;
    unsigned before = 3;
    for (size_t c = 1; c < NUM(counts); c++) {
        struct rho_initiator_config config = test_config(1.0f);
        config.area = (struct rho_extent){-1000.0f, 1000.0f, -1000.0f, 1000.0f};
        search_clutter(&config, counts[c]);
        assert_in_range(initiator.min_scans, before, c == 1 ? 3 : SCANS);
        before = initiator.min_scans;
    }
    assert_int_equal(before, SCANS); /* 250 plots in 4 km^2 */
}

static void without_a_rate_the_configured_score_is_the_threshold(void **state)
{
    (void)state;
    static const float scores[] = {-3.0f, 0.0f, 7.25f};
    for (size_t i = 0; i < NUM(scores); i++) {
        struct rho_initiator_config config = test_config(0.0f);
        config.score_min_nat = scores[i];
        config.min_scans = 3;
        search_targets(&config, 25);
        assert_true(initiator.num_candidates > 0);
        assert_int_equal(initiator.start_mnat, (int)(scores[i] * 1000.0f));
        assert_int_equal(initiator.confirm_mnat, initiator.start_mnat);
        for (unsigned k = 0; k < initiator.num_candidates; k++) {
            assert_true(initiator.candidates[k].score_mnat >= initiator.start_mnat);
        }
    }
}

static void a_batch_search_uses_the_configured_score_at_any_rate(void **state)
{
    (void)state;
    static struct rho_candidate without[RHO_MAX_CANDIDATES];
    unsigned n = 0;
    for (size_t r = 0; r <= NUM(rates); r++) {
        struct rho_initiator_config config = test_config(r == 0 ? 0.0f : rates[r - 1]);
        config.score_min_nat = -12.0f;
        push_clutter_and_targets(&config, 60, 5, SCAN_S);
        search_window(RHO_SEARCH_BATCH);
        assert_int_equal(initiator.start_mnat, -12000);
        assert_int_equal(initiator.confirm_mnat, -12000);
        if (r == 0) {
            n = initiator.num_candidates;
            memcpy(without, initiator.candidates, sizeof without);
        }
        assert_true(n > 0);
        assert_int_equal(initiator.num_candidates, n);
        assert_memory_equal(initiator.candidates, without, n * sizeof without[0]);
    }
}

static void the_same_scans_give_the_same_thresholds(void **state)
{
    (void)state;
    for (size_t c = 0; c < NUM(counts); c++) {
        static struct rho_initiator before;
        struct rho_initiator_config config = test_config(0.3f);
        search_targets(&config, counts[c]);
        before = initiator;
        search_window(RHO_SEARCH_NEWEST);
        assert_memory_equal(&before, &initiator, sizeof before);
        search_targets(&config, counts[c]);
        assert_memory_equal(&before, &initiator, sizeof before);
    }
}

/* Twice the speeds and half the interval give the same plots, and twice as many scans an hour. */
static void half_the_scan_interval_acts_as_half_the_allowed_rate(void **state)
{
    (void)state;
    for (size_t c = 2; c < NUM(counts); c++) {
        struct rho_initiator_config config = test_config(0.5f), fast = test_config(1.0f);
        search_clutter(&config, counts[c]);
        int32_t half_mnat = initiator.confirm_mnat;
        config.false_tracks_per_hour = 1.0f;
        search_clutter(&config, counts[c]);
        assert_true(half_mnat > initiator.confirm_mnat);
        fast.v_min_mps *= 2.0f;
        fast.v_max_mps *= 2.0f;
        push_clutter_and_targets(&fast, counts[c], 0, 0.5 * SCAN_S);
        search_window(RHO_SEARCH_NEWEST);
        assert_float_equal(initiator.confirm_mnat, half_mnat, 5.0);
    }
}

/*
 * Four times the area at the same density has four times the chance tracks, as a quarter of the
 * allowed rate has; scores fall by ln 4, as the prior is spread over more area. The area's edge
 * makes half a nat of difference.
 */
static void four_times_the_area_acts_as_a_quarter_of_the_allowed_rate(void **state)
{
    (void)state;
    static const int few[] = {1, 6, 25, 60};
    for (size_t c = 0; c < NUM(few); c++) {
        struct rho_initiator_config config = test_config(1.0f), quarter = test_config(0.25f);
        search_clutter(&config, few[c]);
        double small_nat = MNAT * initiator.confirm_mnat;
        search_clutter(&quarter, few[c]);
        double quarter_nat = MNAT * initiator.confirm_mnat;
        config.area = (struct rho_extent){-5000.0f, 5000.0f, -5000.0f, 5000.0f};
        search_clutter(&config, 4 * few[c]);
        double large_nat = MNAT * initiator.confirm_mnat + log(4.0);
        assert_true(large_nat > small_nat + 0.2);
        assert_float_equal(large_nat, quarter_nat, 0.7);
    }
}

static void search_with_range_rates(uint32_t measures, int count)
{
    struct rho_initiator_config config = test_config(1.0f);
    random_state = 3;
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        add_clutter_plots(&square, count);
        for (uint32_t i = 0; i < num_plots; i++) {
            plots[i].range_rate_mps = (float)uniform(-400.0, 400.0);
            plots[i].sigma_range_rate_mps = 1.0f;
        }
        push_scan((struct rho_scan){.measures = measures}, SCAN_S * k, NULL);
    }
    search_window(RHO_SEARCH_NEWEST);
}

static void range_rates_lower_votes_and_thresholds(void **state)
{
    (void)state;
    for (size_t c = 1; c < NUM(counts); c++) {
        search_with_range_rates(0, counts[c]);
        int32_t start_mnat = initiator.start_mnat, confirm_mnat = initiator.confirm_mnat;
        unsigned min_scans = initiator.min_scans;
        search_with_range_rates(RHO_MEASURES_RANGE_RATE, counts[c]);
        assert_true(initiator.min_scans <= min_scans);
        assert_true(initiator.start_mnat < start_mnat ||
                    start_mnat == -10000); /* the lowest threshold there is */
        assert_true(counts[c] > 100 || initiator.confirm_mnat < confirm_mnat - 2000);
    }
    assert_true(initiator.min_scans <= 4); /* 250 plots a scan: 5 without range rates */
}

/* allowed false tracks an hour: high enough to count, a third of what clutter could start */
#define WANTED 60.0f

/*
 * Confirmed tracks an hour in 4 x 2.5 km of clutter with this mean number of plots a scan; with
 * heights or range rates the noise is that of a radar 8 km away.
 */
static double false_tracks_an_hour(int scans, double mean, uint32_t measures)
{
    static struct rho_tracker tracker;
    static struct rho_report report;
    const struct rho_sensor away = sensor_at(-8000.0, 0.0);
    struct rho_initiator_config config = test_config(WANTED);
    struct rho_tracker_config maintain;
    config.area = (struct rho_extent){0.0f, 4000.0f, -1000.0f, 1500.0f};
    rho_tracker_config_default(&maintain);
    maintain.v_max_mps = config.v_max_mps;
    start_initiator(&config);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &maintain), RHO_OK);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &away), RHO_OK);
    for (int k = 0; k < scans; k++) {
        struct rho_scan scan = {
            .time_us = (int64_t)(SCAN_S * 1e6) * k, .measures = measures, .plots = plots};
        num_plots = 0;
        add_clutter_plots(&config.area, poisson(mean));
        for (uint32_t i = 0; i < num_plots; i++) {
            plots[i].sigma_cross_m = measures ? 100.0f : 10.0f;
            plots[i].z_m = (float)uniform(0.0, 20000.0);
            plots[i].sigma_up_m = 30.0f;
            plots[i].range_rate_mps = (float)uniform(-400.0, 400.0);
            plots[i].sigma_range_rate_mps = 5.0f;
        }
        scan.num_plots = num_plots;
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
    }
    return tracker.counters.tracks_confirmed * 3600.0 / (scans * SCAN_S);
}

/* About 100, 27 and 23 tracks are confirmed: standard deviations of 6, 12 and 12 an hour. */
static void clutter_makes_about_the_allowed_number_of_tracks(void **state)
{
    (void)state;
    random_state = 11;
    const double found[] = {false_tracks_an_hour(3000, 10.0, 0),
                            false_tracks_an_hour(800, 30.0, RHO_MEASURES_Z),
                            false_tracks_an_hour(700, 60.0, RHO_MEASURES_RANGE_RATE)};
    for (size_t i = 0; i < NUM(found); i++) {
        print_message("%.0f an hour wanted, confirmed %.0f\n", WANTED, found[i]);
        assert_true(found[i] > 0.5 * WANTED && found[i] < 2.0 * WANTED);
    }
}

/*
 * Process noise bends tracks by many sigmas; 100 plots a scan on 95 x 95 km, 10 s. Clutter may
 * start 0.1 tracks a search and starts 0.02, as the same plots can be bent in several ways. With
 * the mean of the bends' variances, which differ by a hundred, it would start 0.003.
 */
static void clutter_starts_no_more_than_allowed_with_process_noise(void **state)
{
    const int searches = 600;
    struct rho_initiator_config config = test_config(20.0f);
    unsigned starts = 0;
    (void)state;
    random_state = 5;
    config.v_min_mps = 50.0f;
    config.v_max_mps = 300.0f;
    config.pd = 0.95f;
    config.process_noise_mps2 = 10.0f;
    config.area = (struct rho_extent){-47500.0f, 47500.0f, -47500.0f, 47500.0f};
    start_initiator(&config);
    for (int k = 0; k < searches; k++) {
        for (int i = poisson(100.0); i > 0; i--) {
            add_plot(uniform(-47500.0, 47500.0), uniform(-47500.0, 47500.0), 50.0, 50.0);
        }
        push_plots(10.0 * k);
        search_window(RHO_SEARCH_NEWEST);
        starts += initiator.num_candidates;
        for (unsigned i = 0; i < initiator.num_candidates; i++) {
            (void)rho_initiator_consume(&initiator, &initiator.candidates[i]);
        }
    }
    print_message("starts a search: 0.1 allowed, %.3f\n", (double)starts / searches);
    assert_true(starts > 0.01 * searches && starts < 0.2 * searches);
}

/*
 * Thresholds in mnat by clutter and rate; each bound, step and prior of the model changes them. A
 * profile that samples more places may differ by less than a tenth of a nat.
 */
static void thresholds_of_given_clutter_are_unchanged(void **state)
{
    static const struct {
        int count;
        float rate, pd;
        int32_t start_mnat, confirm_mnat;
        int min_scans;
        /* votes required by age of the first scan; 8: no track can start there */
        uint8_t span_hits[SCANS];
        double thin;
    } cases[] = {
        {5, 1e-4f, 0.9f, -4771, 12670, 3, {3, 3, 3, 3, 3, 8, 8}, 1.82571803e-05},
        {5, 1.0f, 0.9f, -4771, 5036, 3, {3, 3, 3, 3, 3, 8, 8}, 1.82571803e-05},
        {25, 1e-4f, 0.9f, 49, 13093, 3, {4, 4, 4, 4, 3, 8, 8}, 7.91798229e-05},
        {25, 1.0f, 0.9f, 49, 4745, 3, {4, 4, 4, 4, 3, 8, 8}, 7.91798229e-05},
        {100, 1e-4f, 0.9f, -381, 12883, 4, {5, 5, 4, 4, 8, 8, 8}, 3.11258918e-04},
        {250, 1.0f, 0.9f, -1954, 4307, 6, {6, 6, 8, 8, 8, 8, 8}, 9.01470543e-04},
        {1, 1e-6f, 0.9f, -10000, 17879, 3, {3, 3, 3, 3, 3, 8, 8}, 3.85714839e-06},
        {100, 1e4f, 0.9f, -381, -381, 4, {5, 5, 4, 4, 8, 8, 8}, 3.11258918e-04},
        {25, 1e-6f, 0.05f, -10000, 174, 4, {4, 4, 4, 4, 8, 8, 8}, 7.91798229e-05},
        {100, 1.0f, 0.1f, -10000, -5842, 5, {5, 5, 5, 8, 8, 8, 8}, 3.11258918e-04},
    };
    const int is_sampled_alike = RHO_MAX_PLOTS <= 256;
    const float within_mnat = is_sampled_alike ? 0.5f : 100.0f;
    (void)state;
    for (size_t i = 0; i < NUM(cases); i++) {
        struct rho_initiator_config config = test_config(cases[i].rate);
        config.pd = cases[i].pd;
        search_clutter(&config, cases[i].count);
        assert_float_equal(initiator.start_mnat, cases[i].start_mnat, within_mnat);
        assert_float_equal(initiator.confirm_mnat, cases[i].confirm_mnat, within_mnat);
        assert_int_equal(initiator.min_scans, cases[i].min_scans);
        for (int k = 0; k < SCANS && is_sampled_alike; k++) {
            assert_int_equal(initiator.span_hits[k], cases[i].span_hits[k]);
        }
        assert_float_equal(initiator.thin_clutter, cases[i].thin,
                           (is_sampled_alike ? 0.01 : 0.1) * cases[i].thin);
    }
}

/*
 * Targets cross the area between two scans: the share that stays is bounded below by a millionth,
 * so that chance tracks remain possible. Half or twice that share would change the threshold.
 */
static void thresholds_exist_for_targets_that_cross_the_area_in_a_scan(void **state)
{
    static const int32_t start_mnat[] = {3044, 6696}, min_scans[] = {7, 4};
    (void)state;
    for (int i = 0; i < 2; i++) {
        const float half_m = 1000.0f * (float)(i + 1);
        struct rho_initiator_config config = test_config(1e-6f);
        config.v_min_mps = 2000.0f;
        config.v_max_mps = 3000.0f;
        config.area = (struct rho_extent){-half_m, half_m, -half_m, half_m};
        search_clutter(&config, 250);
        assert_float_equal(initiator.confirm_mnat, start_mnat[i],
                           RHO_MAX_PLOTS > 256 ? 600.0 : 0.5);
        assert_int_equal(initiator.min_scans, min_scans[i]);
    }
}

/* The prior is a tenth; with a rate to keep it may be lower. */
static void the_prior_of_a_turn_is_a_tenth_or_keeps_the_rate(void **state)
{
    struct search search = {.initiator = &initiator};
    (void)state;
    assert_float_equal(rho_thresholds_log_turn(&search), log(0.1), 1e-6);
    /* sets of half the scans over a tenth of the false starts: 3.5 / 0.1 times e^-2 */
    initiator.config.false_tracks_per_hour = 3600.0f;
    initiator.start_mnat = 2000;
    initiator.confirm_mnat = 9000;
    search.keeps_rate = 1;
    search.interval_s = 1.0f;
    search.num_scans = SCANS;
    assert_float_equal(rho_thresholds_log_turn(&search), log(0.1) - log(35.0) + 2.0, 1e-5);
}

/*
 * A gap of 30 s counts as three intervals, 6 s. Each factor of two of the mean interval moves the
 * threshold by about 0.7 nat.
 */
static void a_pause_counts_as_three_intervals(void **state)
{
    const struct rho_initiator_config config = test_config(1.0f);
    (void)state;
    random_state = 3;
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        add_clutter_plots(&config.area, 25);
        push_plots(SCAN_S * k + (k == SCANS - 1 ? 30.0 : 0.0));
    }
    search_window(RHO_SEARCH_NEWEST);
    assert_float_equal(initiator.start_mnat, -10000, 1.0);
    assert_float_equal(initiator.confirm_mnat, -655, 1.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(thresholds_of_given_clutter_are_unchanged),
        cmocka_unit_test(thresholds_exist_for_targets_that_cross_the_area_in_a_scan),
        cmocka_unit_test(the_prior_of_a_turn_is_a_tenth_or_keeps_the_rate),
        cmocka_unit_test(a_pause_counts_as_three_intervals),
        cmocka_unit_test(a_target_without_clutter_is_confirmed_at_its_third_plot),
        cmocka_unit_test(the_confirmation_threshold_falls_with_the_allowed_rate),
        cmocka_unit_test(a_higher_allowed_rate_never_gives_fewer_tracks),
        cmocka_unit_test(candidates_reach_the_start_threshold),
        cmocka_unit_test(denser_clutter_requires_more_votes),
        cmocka_unit_test(without_a_rate_the_configured_score_is_the_threshold),
        cmocka_unit_test(a_batch_search_uses_the_configured_score_at_any_rate),
        cmocka_unit_test(the_same_scans_give_the_same_thresholds),
        cmocka_unit_test(half_the_scan_interval_acts_as_half_the_allowed_rate),
        cmocka_unit_test(four_times_the_area_acts_as_a_quarter_of_the_allowed_rate),
        cmocka_unit_test(range_rates_lower_votes_and_thresholds),
        cmocka_unit_test(clutter_makes_about_the_allowed_number_of_tracks),
        cmocka_unit_test(clutter_starts_no_more_than_allowed_with_process_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
