/* SPDX-License-Identifier: MIT */
/* Excluded areas: their plots start no track, and tracks pass through. */
#include "rhotrack/operator.h"

#include "two_flights.h"

static const struct rho_extent north = {-10000.0f, 10000.0f, 1000.0f, 3000.0f};

static void plots_in_an_excluded_area_start_no_track(void **state)
{
    (void)state;
    for (int is_excluded = 0; is_excluded < 2; is_excluded++) {
        use_usual_configs(7);
        begin_tracker();
        next_k = 0;
        if (is_excluded) {
            assert_int_equal(rho_tracker_exclude_area(&tracker, &north), RHO_OK);
        }
        run_scans(12, 1);
        assert_int_equal(only_track_within_200_m(2000.0) == NULL, is_excluded);
        assert_non_null(only_track_within_200_m(-2000.0));
        assert_int_equal(tracker.counters.plots_excluded, is_excluded ? 12 : 0);
        assert_int_equal(report.fates_total[RHO_FATE_GHOST], is_excluded);
    }
    assert_true(rho_tracker_is_sound(&tracker));
    assert_int_equal(rho_tracker_include_place(&tracker, 0.0f, 2000.0f), RHO_OK);
    run_scans(8, 1);
    assert_non_null(only_track_within_200_m(2000.0));
    assert_int_equal(tracker.counters.plots_excluded, 12);
}

static void tracks_pass_through_an_excluded_area(void **state)
{
    (void)state;
    prepare_tracker();
    const uint32_t passing = only_track_within_200_m(2000.0)->track_id;
    const uint16_t hits = only_track_within_200_m(2000.0)->hits;
    assert_int_equal(rho_tracker_exclude_area(&tracker, &north), RHO_OK);
    run_scans(8, 1);
    assert_int_equal(only_track_within_200_m(2000.0)->track_id, passing);
    assert_int_equal(only_track_within_200_m(2000.0)->hits, hits + 8);
    assert_int_equal(tracker.counters.plots_excluded, 0);
    run_scans(3 * config.coast_scans_max, 0);
    assert_null(only_track_within_200_m(2000.0));
    run_scans(8, 1); /* its target, back again, starts no track */
    assert_null(only_track_within_200_m(2000.0));
}

/* A track that probably has no target leaves its plots to new ones: but not in an excluded area. */
static void plots_of_weak_tracks_start_none_there_either(void **state)
{
    (void)state;
    for (int is_excluded = 0; is_excluded < 2; is_excluded++) {
        prepare_tracker();
        const uint32_t id = only_track_within_200_m(2000.0)->track_id;
        const uint32_t started = tracker.counters.tracks_started;
        if (is_excluded) {
            assert_int_equal(rho_tracker_exclude_area(&tracker, &north), RHO_OK);
        }
        for (int k = 0; k < 8; k++) {
            for (unsigned i = 0; i < tracker.num_tracks; i++) {
                struct rho_track *track = &tracker.tracks[i];
                if (track->track_id == id) {
                    track->was_confirmed = 0;
                    track->status = RHO_TRACK_TENTATIVE;
                    track->score_mnat = tracker.start_mnat;
                    track->visible = 1e-12f;
                    track->hidden = 0.0f;
                }
            }
            run_scans(1, 1);
        }
        assert_int_equal(tracker.counters.tracks_started > started, !is_excluded);
    }
}

static void bad_excluded_areas_are_refused(void **state)
{
    struct rho_extent bad[] = {north, north, north, north};
    (void)state;
    prepare_tracker();
    bad[0].x_min_m = NAN;
    bad[1].x_max_m = 3e6f;
    bad[2].x_max_m = bad[2].x_min_m;
    bad[3].y_min_m = 4000.0f;
    remember_state();
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(rho_tracker_exclude_area(&tracker, &bad[i]), RHO_ERROR_VALUE);
    }
    assert_int_equal(rho_tracker_exclude_area(NULL, &north), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_exclude_area(&tracker, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_include_place(NULL, 0.0f, 0.0f), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_include_place(&tracker, 0.0f, 2000.0f), RHO_ERROR_VALUE);
    check_unchanged();
    for (int i = 0; i < RHO_MAX_EXCLUDED_AREAS; i++) {
        const struct rho_extent area = {1000.0f * (float)i, 1000.0f * (float)i + 500.0f, 0.0f,
                                        1.0f};
        assert_int_equal(rho_tracker_exclude_area(&tracker, &area), RHO_OK);
    }
    remember_state();
    assert_int_equal(rho_tracker_exclude_area(&tracker, &north), RHO_ERROR_CAPACITY);
    assert_int_equal(rho_tracker_include_place(&tracker, 700.0f, 0.5f), RHO_ERROR_VALUE);
    check_unchanged();
    assert_int_equal(rho_tracker_include_place(&tracker, 1500.0f, 0.0f), RHO_OK);
    assert_int_equal(tracker.num_excluded, RHO_MAX_EXCLUDED_AREAS - 1);
    assert_true(tracker.excluded[1].x_min_m > 1999.0f);
    tracker.excluded[1].x_min_m = NAN;
    assert_false(rho_tracker_is_sound(&tracker));
    tracker.num_excluded = RHO_MAX_EXCLUDED_AREAS + 1;
    assert_false(rho_tracker_is_sound(&tracker));
}

/* Eight comparisons of a plot with an area cost one unit of work. */
static void comparisons_with_areas_are_counted_as_work(void **state)
{
    uint32_t work[2];
    (void)state;
    for (int is_told = 0; is_told < 2; is_told++) {
        use_usual_configs(7);
        begin_tracker();
        for (int i = 0; i < 4 && is_told; i++) {
            const struct rho_extent area = {-9000.0f, -8000.0f, 0.0f, 1.0f + (float)i};
            assert_int_equal(rho_tracker_exclude_area(&tracker, &area), RHO_OK);
        }
        for (int i = 0; i < 64; i++) {
            (void)add_plot(1000.0 * i, 0.0, 10.0);
        }
        step_at(0.0);
        assert_int_equal(report.fates_total[RHO_FATE_HELD], 64);
        work[is_told] = tracker.work.work;
    }
    assert_int_equal(work[1] - work[0], 64 * 4 / 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plots_in_an_excluded_area_start_no_track),
        cmocka_unit_test(tracks_pass_through_an_excluded_area),
        cmocka_unit_test(plots_of_weak_tracks_start_none_there_either),
        cmocka_unit_test(bad_excluded_areas_are_refused),
        cmocka_unit_test(comparisons_with_areas_are_counted_as_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
