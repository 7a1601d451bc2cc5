/* SPDX-License-Identifier: MIT */
/*
 * False tracks an hour: thresholds that follow from clutter, and what they keep. Noise of 10 m, scans of 2 s, targets of
 * 100 to 400 m/s.
 */
#include "initiator_setup.h"
#include "rhotrack/tracker.h"

#define SCANS 7
#define SCAN_S 2.0
#define MNAT 1e-3

static const struct rho_extent square = {-2500.0f, 2500.0f, -2500.0f, 2500.0f};
static const int counts[] = {0, 1, 5, 25, 100, 250}; /* clutter plots a scan */
static const float rates[] = {1e-4f, 0.01f, 0.1f, 1.0f, 10.0f, 100.0f, 1e4f};

static struct rho_initiator_config usual(float false_tracks_per_hour)
{
    struct rho_initiator_config config;
    rho_initiator_config_default(&config);
    config.v_min_mps = 100.0f;
    config.v_max_mps = 400.0f;
    config.false_tracks_per_hour = false_tracks_per_hour;
    config.area_is_fixed = 1;
    config.area = square;
    return config;
}

/* A window of clutter, the same at every call. */
static void push_clutter(const struct rho_initiator_config *config, int count, double scan_s)
{
    random_state = 3;
    start(config);
    for (int k = 0; k < SCANS; k++) {
        add_clutter(&config->area, count);
        push(scan_s * k);
    }
}

static void search_clutter(const struct rho_initiator_config *config, int count)
{
    push_clutter(config, count, SCAN_S);
    search(RHO_SEARCH_NEWEST);
}

static unsigned confirmed(void)
{
    unsigned n = 0;
    for (unsigned i = 0; i < initiator.num_candidates; i++) {
        n += initiator.candidates[i].score_mnat >= initiator.confirm_mnat;
    }
    return n;
}

/* ---- thresholds ------------------------------------------------------------------------------- */

static void a_clear_sky_confirms_a_target_at_its_third_plot(void **state)
{
    (void)state;
    for (int i = 0; i < 200; i++) {
        struct rho_initiator_config config = usual(1.0f);
        double heading = uniform(0.0, 2.0 * PI), v_mps = uniform(120.0, 380.0);
        start(&config);
        for (int empty = 0; empty < i % 5; empty++) {
            push(SCAN_S * empty);
        }
        for (int k = 0; k < 3; k++) {
            double way_m = v_mps * SCAN_S * (k - 1);
            add(way_m * cos(heading) + uniform(-10.0, 10.0),
                way_m * sin(heading) + uniform(-10.0, 10.0), 10.0, 10.0);
            push(SCAN_S * (k + i % 5));
            search(RHO_SEARCH_NEWEST);
            assert_int_equal(initiator.num_candidates, k == 2);
        }
        assert_int_equal(confirmed(), 1);
    }
}

static void confirming_falls_as_more_false_tracks_are_allowed_but_not_below_starting(void **state)
{
    (void)state;
    for (size_t c = 0; c < NUM(counts); c++) {
        int32_t before_mnat = INT32_MAX, highest_mnat = 0, lowest_mnat = 0;
        unsigned tracks = 0, candidates = 0;
        for (size_t r = 0; r < NUM(rates); r++) {
            struct rho_initiator_config config = usual(rates[r]);
            search_clutter(&config, counts[c]);
            assert_true(initiator.confirm_mnat <= before_mnat);
            assert_true(initiator.start_mnat <= initiator.confirm_mnat);
            assert_true(initiator.num_candidates >= candidates);
            assert_true(confirmed() >= tracks);
            before_mnat = initiator.confirm_mnat;
            tracks = confirmed();
            candidates = initiator.num_candidates;
            highest_mnat = r == 0 ? initiator.confirm_mnat : highest_mnat;
            lowest_mnat = initiator.confirm_mnat;
        }
        /* 18 nat of rates: a set that is e times rarer scores about a nat more */
        print_message("%d plots a scan: %d .. %d mnat\n", counts[c], (int)lowest_mnat,
                      (int)highest_mnat);
        assert_true(counts[c] < 5 || highest_mnat - lowest_mnat > 8000);
        assert_int_equal(counts[c] >= 100 ? candidates : 1, counts[c] >= 100 ? candidates : 1);
    }
}

static void every_candidate_of_a_kept_rate_reaches_the_start_threshold(void **state)
{
    (void)state;
    unsigned found = 0;
    for (size_t c = 0; c < NUM(counts); c++) {
        struct rho_initiator_config config = usual(1.0f);
        search_clutter(&config, counts[c]);
        found += initiator.num_candidates;
        for (unsigned i = 0; i < initiator.num_candidates; i++) {
            assert_true(initiator.candidates[i].score_mnat >= initiator.start_mnat);
            assert_true(initiator.candidates[i].hits >= initiator.min_scans);
        }
    }
    print_message("found %u\n", found);
}

static void denser_clutter_asks_for_more_votes(void **state)
{
    (void)state;
    unsigned before = 3, first = 0;
    for (size_t c = 0; c < NUM(counts); c++) {
        struct rho_initiator_config config = usual(1.0f);
        search_clutter(&config, counts[c]);
        print_message("M %u\n", initiator.min_scans);
        assert_true(initiator.min_scans >= before);
        before = initiator.min_scans;
        first = c == 0 ? before : first;
    }
    assert_int_equal(first, 3);
    assert_true(before >= 5);
}

static void without_a_rate_the_least_score_is_the_threshold(void **state)
{
    (void)state;
    static const float scores[] = {-3.0f, 0.0f, 7.25f};
    for (size_t i = 0; i < NUM(scores); i++) {
        struct rho_initiator_config config = usual(0.0f);
        config.score_min_nat = scores[i];
        config.min_scans = 3;
        search_clutter(&config, 25);
        assert_int_equal(initiator.start_mnat, (int)(scores[i] * 1000.0f));
        assert_int_equal(initiator.confirm_mnat, initiator.start_mnat);
        for (unsigned k = 0; k < initiator.num_candidates; k++) {
            assert_true(initiator.candidates[k].score_mnat >= initiator.start_mnat);
        }
    }
}

static void a_batch_goes_by_the_least_score_whatever_the_rate(void **state)
{
    (void)state;
    static struct rho_candidate without[RHO_MAX_CANDIDATES];
    unsigned n = 0;
    for (size_t r = 0; r <= NUM(rates); r++) {
        struct rho_initiator_config config = usual(r == 0 ? 0.0f : rates[r - 1]);
        config.score_min_nat = -12.0f;
        push_clutter(&config, 60, SCAN_S);
        search(RHO_SEARCH_BATCH);
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
        struct rho_initiator_config config = usual(0.3f);
        search_clutter(&config, counts[c]);
        before = initiator;
        search(RHO_SEARCH_NEWEST);
        assert_memory_equal(&before, &initiator, sizeof before);
        search_clutter(&config, counts[c]);
        assert_memory_equal(&before, &initiator, sizeof before);
    }
}

/* ---- what they follow from -------------------------------------------------------------------- */

/* Everything twice as fast is the same pictures, twice as many an hour. */
static void a_shorter_scan_interval_confirms_as_half_the_rate_does(void **state)
{
    (void)state;
    for (size_t c = 2; c < NUM(counts); c++) {
        struct rho_initiator_config config = usual(0.5f), fast = usual(1.0f);
        search_clutter(&config, counts[c]);
        int32_t half_mnat = initiator.confirm_mnat;
        config.false_tracks_per_hour = 1.0f;
        search_clutter(&config, counts[c]);
        assert_true(half_mnat > initiator.confirm_mnat);
        fast.v_min_mps *= 2.0f;
        fast.v_max_mps *= 2.0f;
        push_clutter(&fast, counts[c], 0.5 * SCAN_S);
        search(RHO_SEARCH_NEWEST);
        assert_float_equal(initiator.confirm_mnat, half_mnat, 5.0);
    }
}

/*
 * The prior of a place falls by ln 4 where the area is four times as large, and so do all scores; the threshold must fall by
 * less, for there are four times the chances.
 */
static void a_larger_area_asks_for_better_plots(void **state)
{
    (void)state;
    static const int few[] = {1, 6, 25, 60};
    for (size_t c = 0; c < NUM(few); c++) {
        struct rho_initiator_config config = usual(1.0f), large = usual(1.0f);
        search_clutter(&config, few[c]);
        double small_nat = MNAT * initiator.confirm_mnat;
        large.area = (struct rho_extent){-5000.0f, 5000.0f, -5000.0f, 5000.0f};
        search_clutter(&large, 4 * few[c]);
        print_message("area %g -> %g\n", small_nat, MNAT * initiator.confirm_mnat);
        assert_true(MNAT * initiator.confirm_mnat + log(4.0) > small_nat + 0.5);
        assert_true(MNAT * initiator.confirm_mnat + log(4.0) < small_nat + 4.0);
    }
}

static void search_with_range_rates(uint32_t measures, int count)
{
    struct rho_initiator_config config = usual(1.0f);
    random_state = 3;
    start(&config);
    for (int k = 0; k < SCANS; k++) {
        add_clutter(&square, count);
        for (uint32_t i = 0; i < num_plots; i++) {
            plots[i].range_rate_mps = (float)uniform(-400.0, 400.0);
            plots[i].sigma_range_rate_mps = 1.0f;
        }
        push_scan((struct rho_scan){.measures = measures}, SCAN_S * k, NULL);
    }
    search(RHO_SEARCH_NEWEST);
}

static void range_rates_ask_for_fewer_votes_in_the_same_clutter(void **state)
{
    (void)state;
    for (size_t c = 1; c < NUM(counts); c++) {
        search_with_range_rates(0, counts[c]);
        int32_t start_mnat = initiator.start_mnat, confirm_mnat = initiator.confirm_mnat;
        unsigned min_scans = initiator.min_scans;
        search_with_range_rates(RHO_MEASURES_RANGE_RATE, counts[c]);
        print_message("rr %d %d %u -> %d %d %u\n", start_mnat, confirm_mnat, min_scans,
                      initiator.start_mnat, initiator.confirm_mnat, initiator.min_scans);
    }
}

/* ---- kept ------------------------------------------------------------------------------------- */

#define MONTE_CARLO_SCANS 4000

/* A tracker's scans of nothing but clutter at 1/km^2, in 4 x 2.5 km. */
static double false_tracks_an_hour(float wanted)
{
    static struct rho_tracker tracker;
    static struct rho_report report;
    const struct rho_extent area = {0.0f, 4000.0f, -1000.0f, 1500.0f};
    struct rho_initiator_config config = usual(wanted);
    struct rho_tracker_config maintain;
    config.area = area;
    rho_tracker_config_default(&maintain);
    maintain.v_max_mps = config.v_max_mps;
    start(&config);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &maintain), RHO_OK);
    for (int k = 0; k < MONTE_CARLO_SCANS; k++) {
        add_clutter(&area, poisson(10.0));
        struct rho_scan scan = {
            .time_us = (int64_t)(SCAN_S * 1e6) * k, .num_plots = num_plots, .plots = plots};
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
        num_plots = 0;
    }
    return tracker.counters.tracks_confirmed * 3600.0 / (MONTE_CARLO_SCANS * SCAN_S);
}

static void clutter_makes_about_as_many_tracks_as_wanted(void **state)
{
    (void)state;
    random_state = 11;
    double hundred = false_tracks_an_hour(100.0f);
    print_message("wanted 100 an hour, confirmed %.0f\n", hundred);
    assert_true(hundred > 50.0);
    assert_true(hundred < 200.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clear_sky_confirms_a_target_at_its_third_plot),
        cmocka_unit_test(confirming_falls_as_more_false_tracks_are_allowed_but_not_below_starting),
        cmocka_unit_test(every_candidate_of_a_kept_rate_reaches_the_start_threshold),
        cmocka_unit_test(denser_clutter_asks_for_more_votes),
        cmocka_unit_test(without_a_rate_the_least_score_is_the_threshold),
        cmocka_unit_test(a_batch_goes_by_the_least_score_whatever_the_rate),
        cmocka_unit_test(the_same_scans_give_the_same_thresholds),
        cmocka_unit_test(a_shorter_scan_interval_confirms_as_half_the_rate_does),
        cmocka_unit_test(a_larger_area_asks_for_better_plots),
        cmocka_unit_test(range_rates_ask_for_fewer_votes_in_the_same_clutter),
        cmocka_unit_test(clutter_makes_about_as_many_tracks_as_wanted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
