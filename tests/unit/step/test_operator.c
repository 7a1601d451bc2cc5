/* SPDX-License-Identifier: MIT */
/*
 * An operator's changes between two steps: tracks start, end, get other identities and freeze by
 * hand. Refused calls change no byte.
 */
#include "rhotrack/operator.h"

#include "step_looks.h"
#include "two_flights.h"

/* ---- tracks started by hand ------------------------------------------------------------------ */

static void an_operator_starts_a_track_at_a_place(void **state)
{
    const struct rho_operator_start start = {
        .x_m = 500.0f, .y_m = 6000.0f, .sigma_m = 50.0f, .vx_mps = 50.0f, .sigma_mps = 20.0f};
    (void)state;
    prepare_tracker();
    assert_int_equal(rho_tracker_start_at(&tracker, &start, &report), RHO_OK);
    const struct rho_track_report *track = only_track_within_200_m(6000.0);
    assert_non_null(track);
    assert_int_equal(track->status, RHO_TRACK_CONFIRMED);
    assert_int_equal(track->track_id, 3);
    assert_int_equal(tracker.counters.tracks_started, 3);
    assert_true(fabsf(track->state[0] - 500.0f) < 1.0f);
    assert_true(fabsf(track->state[3] - 50.0f) < 1.0f);
    assert_true(rho_tracker_is_sound(&tracker));
    for (int i = 0; i < 3; i++) {
        add_noisy_plot(500.0 + 50.0 * (i + 1), 6000.0, 10.0);
        step_scan_of_flights(next_k++, 1);
        assert_int_equal(only_track_within_200_m(6000.0)->track_id, 3);
        assert_int_equal(only_track_within_200_m(6000.0)->hits, i + 2);
    }
    assert_int_equal(report.num_tracks, 3);
}

/* Without plots a track started by hand ends like any other. */
static void a_track_started_by_hand_ends_without_plots(void **state)
{
    const struct rho_operator_start start = {.x_m = 500.0f, .y_m = 6000.0f, .sigma_m = 50.0f};
    (void)state;
    prepare_tracker();
    assert_int_equal(rho_tracker_start_at(&tracker, &start, &report), RHO_OK);
    assert_true(only_track_within_200_m(6000.0)->sigma_mps > 100.0f);
    assert_int_equal(only_track_within_200_m(6000.0)->status, RHO_TRACK_CONFIRMED);
    run_scans(1, 1);
    assert_non_null(only_track_within_200_m(6000.0));
    int scans = 1, shown = 0;
    for (; only_track_within_200_m(6000.0) && scans < 30; scans++) {
        shown += only_track_within_200_m(6000.0)->status != RHO_TRACK_TENTATIVE;
        run_scans(1, 1);
    }
    assert_in_range(scans, 2, 10);
    assert_in_range(shown, 0, 2); /* nothing tells that its target was ever there */
    assert_null(only_track_within_200_m(6000.0));
    assert_int_equal(report.num_ended, 1);
    assert_int_equal(report.ended[0], 3);
}

static void bad_starts_by_hand_are_refused(void **state)
{
    struct rho_operator_start start = {.x_m = 500.0f, .y_m = 6000.0f, .sigma_m = 50.0f};
    struct rho_operator_start bad[] = {start, start, start, start, start};
    (void)state;
    use_usual_configs(7);
    begin_tracker();
    report.time_us = 0;
    assert_int_equal(rho_tracker_start_at(&tracker, &start, &report), RHO_ERROR_STATE);
    prepare_tracker();
    bad[0].x_m = NAN;
    bad[1].y_m = 3e6f;
    bad[2].sigma_m = 0.0f;
    bad[3].sigma_mps = -1.0f;
    bad[4].sigma_mps = NAN;
    remember_state();
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(rho_tracker_start_at(&tracker, &bad[i], &report), RHO_ERROR_VALUE);
    }
    assert_int_equal(rho_tracker_start_at(NULL, &start, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_start_at(&tracker, NULL, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_start_at(&tracker, &start, NULL), RHO_ERROR_NULL);
    check_unchanged();
    report.time_us--;
    assert_int_equal(rho_tracker_start_at(&tracker, &start, &report), RHO_ERROR_STATE);
    report.time_us++;
    check_unchanged();
    while (tracker.num_tracks < RHO_MAX_TRACKS) {
        start.y_m += 100.0f;
        assert_int_equal(rho_tracker_start_at(&tracker, &start, &report), RHO_OK);
    }
    remember_state();
    assert_int_equal(rho_tracker_start_at(&tracker, &start, &report), RHO_ERROR_CAPACITY);
    assert_int_equal(tracker.counters.tracks_no_room, 1);
    tracker.counters.tracks_no_room = 0; /* nothing else is changed */
    check_unchanged();
}

/* The start would end another track, which the full report could not list. */
static void a_start_needs_room_in_the_report(void **state)
{
    struct rho_operator_start start = {.x_m = 1000.0f, .y_m = 5000.0f, .sigma_m = 20.0f};
    (void)state;
    prepare_tracker();
    while (tracker.num_tracks < RHO_MAX_TRACKS) {
        start.y_m += 100.0f;
        assert_int_equal(rho_tracker_start_at(&tracker, &start, &report), RHO_OK);
    }
    tracker.tracks[1].status = RHO_TRACK_TENTATIVE;
    tracker.tracks[1].visible = 0.1f;
    report.num_ended = RHO_MAX_TRACKS;
    assert_int_equal(rho_tracker_start_at(&tracker, &start, &report), RHO_ERROR_CAPACITY);
    assert_int_equal(report.num_ended, RHO_MAX_TRACKS);
    assert_int_equal(tracker.num_tracks, RHO_MAX_TRACKS);
    report.num_ended = RHO_MAX_TRACKS - 1;
    assert_int_equal(rho_tracker_start_at(&tracker, &start, &report), RHO_OK);
    assert_int_equal(report.ended[RHO_MAX_TRACKS - 1], 2);
}

/* ---- tracks dropped by hand ------------------------------------------------------------------ */

static void an_operator_drops_one_track(void **state)
{
    (void)state;
    prepare_tracker();
    const uint32_t lost = only_track_within_200_m(2000.0)->track_id;
    const uint32_t kept = only_track_within_200_m(-2000.0)->track_id;
    assert_int_equal(rho_tracker_drop_track(&tracker, lost, &report), RHO_OK);
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].track_id, kept);
    assert_int_equal(report.num_ended, 1);
    assert_int_equal(report.ended[0], lost);
    assert_int_equal(tracker.counters.tracks_dropped, 1);
    assert_int_equal(tracker.counters.tracks_ended, 1);
    assert_true(rho_tracker_is_sound(&tracker));
    remember_state();
    assert_int_equal(rho_tracker_drop_track(&tracker, lost, &report), RHO_ERROR_VALUE);
    assert_int_equal(rho_tracker_drop_track(&tracker, 0, &report), RHO_ERROR_VALUE);
    assert_int_equal(rho_tracker_drop_track(NULL, kept, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_drop_track(&tracker, kept, NULL), RHO_ERROR_NULL);
    check_unchanged();
    run_scans(8, 1); /* its target is found again and gets another identity */
    assert_int_equal(only_track_within_200_m(2000.0)->track_id, 3);
    assert_int_equal(only_track_within_200_m(-2000.0)->track_id, kept);
}

/* If the report's list of ended tracks is full, the track stays. */
static void a_drop_needs_room_in_the_report(void **state)
{
    (void)state;
    prepare_tracker();
    report.num_ended = RHO_MAX_TRACKS;
    remember_state();
    assert_int_equal(rho_tracker_drop_track(&tracker, 1, &report), RHO_ERROR_CAPACITY);
    assert_int_equal(rho_tracker_renumber_track(&tracker, 1, 9, &report), RHO_ERROR_CAPACITY);
    check_unchanged();
    report.num_ended = RHO_MAX_TRACKS - 1;
    assert_int_equal(rho_tracker_drop_track(&tracker, 1, &report), RHO_OK);
    assert_int_equal(report.ended[RHO_MAX_TRACKS - 1], 1);
}

/* ---- tracks renumbered ----------------------------------------------------------------------- */

static void an_operator_renumbers_a_track_upwards_and_back(void **state)
{
    (void)state;
    prepare_tracker();
    const uint32_t old_id = only_track_within_200_m(2000.0)->track_id, other_id = 3 - old_id;
    assert_int_equal(rho_tracker_renumber_track(&tracker, old_id, 40, &report), RHO_OK);
    assert_int_equal(only_track_within_200_m(2000.0)->track_id, 40);
    assert_int_equal(only_track_within_200_m(-2000.0)->track_id, other_id);
    assert_int_equal(report.num_ended, 1);
    assert_int_equal(report.ended[0], old_id);
    assert_int_equal(tracker.counters.tracks_ended, 0);
    run_scans(4, 1); /* each step checks that tracks are in order of identity */
    assert_int_equal(only_track_within_200_m(2000.0)->track_id, 40);
    assert_int_equal(only_track_within_200_m(2000.0)->hits, only_track_within_200_m(-2000.0)->hits);
    assert_int_equal(rho_tracker_renumber_track(&tracker, 40, old_id, &report), RHO_OK);
    assert_int_equal(report.tracks[0].track_id, 1);
    assert_int_equal(report.tracks[1].track_id, 2);
    assert_true(rho_tracker_is_sound(&tracker));
    run_scans(4, 1);
    assert_int_equal(only_track_within_200_m(2000.0)->track_id, old_id);
    /* no later track gets an identity given by hand */
    assert_int_equal(rho_tracker_drop_track(&tracker, old_id, &report), RHO_OK);
    run_scans(8, 1);
    assert_int_equal(only_track_within_200_m(2000.0)->track_id, 41);
}

static void identities_in_use_are_refused(void **state)
{
    (void)state;
    prepare_tracker();
    remember_state();
    assert_int_equal(rho_tracker_renumber_track(&tracker, 1, 2, &report), RHO_ERROR_VALUE);
    assert_int_equal(rho_tracker_renumber_track(&tracker, 1, 1, &report), RHO_ERROR_VALUE);
    assert_int_equal(rho_tracker_renumber_track(&tracker, 1, 0, &report), RHO_ERROR_VALUE);
    assert_int_equal(rho_tracker_renumber_track(&tracker, 1, RHO_LIMIT_TRACK_ID + 1u, &report),
                     RHO_ERROR_VALUE);
    assert_int_equal(rho_tracker_renumber_track(&tracker, 3, 4, &report), RHO_ERROR_VALUE);
    assert_int_equal(rho_tracker_renumber_track(NULL, 1, 4, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_renumber_track(&tracker, 1, 4, NULL), RHO_ERROR_NULL);
    check_unchanged();
    assert_int_equal(rho_tracker_renumber_track(&tracker, 1, RHO_LIMIT_TRACK_ID, &report), RHO_OK);
    assert_int_equal(tracker.next_track_id, RHO_LIMIT_TRACK_ID + 1u);
}

/* Tracks that keep their rows keep their evidence, others have none. */
static void evidence_is_kept_for_tracks_that_keep_their_row(void **state)
{
    struct rho_tracker_evidence evidence;
    (void)state;
    if (!RHO_KEEPS_OFFERS) {
        skip();
    }
    prepare_tracker();
    assert_true(rho_tracker_evidence_of(&tracker, 0, &evidence));
    assert_true(rho_tracker_evidence_of(&tracker, 1, &evidence));
    assert_int_equal(rho_tracker_renumber_track(&tracker, 2, 5, &report), RHO_OK);
    assert_true(rho_tracker_evidence_of(&tracker, 1, &evidence));
    assert_int_equal(rho_tracker_renumber_track(&tracker, 1, 9, &report), RHO_OK);
    assert_false(rho_tracker_evidence_of(&tracker, 0, &evidence));
    assert_false(rho_tracker_evidence_of(&tracker, 1, &evidence));
}

/* ---- frozen tracks --------------------------------------------------------------------------- */

static void a_frozen_track_coasts_until_it_is_thawed(void **state)
{
    (void)state;
    prepare_tracker();
    const uint32_t frozen = only_track_within_200_m(2000.0)->track_id;
    const uint16_t hits = only_track_within_200_m(2000.0)->hits;
    assert_int_equal(rho_tracker_freeze_track(&tracker, frozen, 1, &report), RHO_OK);
    assert_int_equal(only_track_within_200_m(2000.0)->status, RHO_TRACK_COASTING);
    assert_int_equal(only_track_within_200_m(2000.0)->plot, -1);
    run_scans(4 * config.coast_scans_max, 0);
    const struct rho_track_report *track = only_track_within_200_m(2000.0);
    assert_non_null(track);
    assert_int_equal(track->track_id, frozen);
    assert_int_equal(track->hits, hits);
    assert_int_equal(track->misses, 0);
    assert_int_equal(track->status, RHO_TRACK_COASTING);
    assert_true(fabs(track->state[0] - (-3000.0 + 100.0 * (next_k - 1))) < 400.0);
    assert_true(rho_tracker_is_sound(&tracker));
    assert_int_equal(rho_tracker_freeze_track(&tracker, frozen, 0, &report), RHO_OK);
    run_scans(6, 1);
    assert_int_equal(report.num_tracks, 2);
    assert_int_equal(report_of(frozen)->hits, hits + 6);
    assert_int_equal(report_of(frozen)->status, RHO_TRACK_CONFIRMED);
}

/* A frozen track takes no plots, though its target is seen; thawed, it ends for lack of plots. */
static void a_frozen_track_takes_no_plots(void **state)
{
    (void)state;
    prepare_tracker();
    const uint32_t frozen = only_track_within_200_m(2000.0)->track_id;
    const uint16_t hits = only_track_within_200_m(2000.0)->hits;
    assert_int_equal(rho_tracker_freeze_track(&tracker, frozen, 1, &report), RHO_OK);
    run_scans(3, 1);
    assert_int_equal(report_of(frozen)->hits, hits);
    assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], 1);
    assert_int_equal(rho_tracker_freeze_track(&tracker, frozen, 0, &report), RHO_OK);
    run_scans(config.coast_scans_max - 1, 0);
    assert_non_null(report_of(frozen));
    run_scans(3 * config.coast_scans_max, 0);
    assert_null(report_of(frozen));
}

/* Probability that the target of this track exists. */
static double existence_of(uint32_t track_id)
{
    for (unsigned i = 0; i < tracker.num_tracks; i++) {
        if (tracker.tracks[i].track_id == track_id) {
            return (double)(tracker.tracks[i].visible + tracker.tracks[i].hidden);
        }
    }
    return 0.0;
}

/*
 * No target leaves while its track is frozen: a thawed track lives on as one that never was. Of
 * targets that were watched for 60 scans instead, a quarter would have left.
 */
static void the_time_in_which_a_track_is_frozen_does_not_count(void **state)
{
    double exists[2][4];
    (void)state;
    for (int is_frozen = 0; is_frozen < 2; is_frozen++) {
        prepare_tracker();
        tracker.config.learn_pd_min = 1.0f; /* what the other track teaches does not count */
        const uint32_t id = only_track_within_200_m(2000.0)->track_id;
        if (is_frozen) {
            assert_int_equal(rho_tracker_freeze_track(&tracker, id, 1, &report), RHO_OK);
            const double before = existence_of(id);
            run_scans(60, 0);
            assert_float_equal(existence_of(id), before, 0.0);
            assert_int_equal(rho_tracker_freeze_track(&tracker, id, 0, &report), RHO_OK);
        }
        for (int i = 0; i < 4; i++) {
            run_scans(1, 0);
            assert_non_null(report_of(id));
            exists[is_frozen][i] = existence_of(id);
        }
    }
    for (int i = 0; i < 4; i++) {
        assert_float_equal(exists[1][i], exists[0][i], 0.05);
    }
    assert_true(exists[1][0] > 0.9);
}

static void refused_freezes_change_nothing(void **state)
{
    (void)state;
    prepare_tracker();
    remember_state();
    assert_int_equal(rho_tracker_freeze_track(&tracker, 3, 1, &report), RHO_ERROR_VALUE);
    assert_int_equal(rho_tracker_freeze_track(NULL, 1, 1, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_freeze_track(&tracker, 1, 1, NULL), RHO_ERROR_NULL);
    tracker.tracks[0].status = RHO_TRACK_TENTATIVE;
    assert_int_equal(rho_tracker_freeze_track(&tracker, tracker.tracks[0].track_id, 1, &report),
                     RHO_ERROR_STATE);
    tracker.tracks[0].status = RHO_TRACK_CONFIRMED;
    check_unchanged();
    tracker.tracks[0].is_frozen = 2;
    assert_false(rho_tracker_is_sound(&tracker));
}

/* A tracker read from a snapshot whose probabilities are none. */
static void probabilities_outside_0_to_1_are_unsound(void **state)
{
    static const float bad[] = {-0.001f, 1.001f, NAN, INFINITY};
    (void)state;
    prepare_tracker();
    assert_true(rho_tracker_is_sound(&tracker));
    remember_state();
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        float *const values[] = {&tracker.tracks[1].visible, &tracker.tracks[1].hidden,
                                 &tracker.tracks[1].seen_share, &tracker.tracks[1].appeared,
                                 &tracker.sensors[0].blind};
        for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
            *values[k] = bad[i];
            assert_false(rho_tracker_is_sound(&tracker));
            tracker = tracker_before;
        }
    }
    float *const counts[] = {&tracker.lived, &tracker.gone, &tracker.returned};
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        *counts[k] = -1.0f;
        assert_false(rho_tracker_is_sound(&tracker));
        tracker = tracker_before;
    }
    assert_true(rho_tracker_is_sound(&tracker));
}

/* ---- frozen tracks in frames of bearings ----------------------------------------------------- */

/* Three sensors see one target; its frozen track keeps hits and score. */
static void frames_of_bearings_leave_frozen_tracks_alone(void **state)
{
    static const float place_m[3][2] = {{0.0f, 0.0f}, {8000.0f, 0.0f}, {4000.0f, -6000.0f}};
    struct rho_bearing bearings[3];
    struct rho_bearing_scan scans[3];
    (void)state;
    for (int is_frozen = 0; is_frozen < 2; is_frozen++) {
        prepare_tracker();
        const struct rho_track_report before = *only_track_within_200_m(2000.0);
        if (is_frozen) {
            assert_int_equal(rho_tracker_freeze_track(&tracker, before.track_id, 1, &report),
                             RHO_OK);
        }
        for (int k = 0; k < 3; k++) {
            const double x_m = -3000.0 + 100.0 * next_k;
            for (int i = 0; i < 3; i++) {
                bearings[i] = (struct rho_bearing){
                    .bearing_rad = (float)atan2(2000.0 - place_m[i][1], x_m - place_m[i][0]),
                    .sigma_rad = 0.002f};
                scans[i] = (struct rho_bearing_scan){.time_us = INT64_C(1000000) * next_k,
                                                     .sensor_id = 11 + i,
                                                     .x_m = place_m[i][0],
                                                     .y_m = place_m[i][1],
                                                     .num_bearings = 1,
                                                     .bearings = &bearings[i]};
            }
            const struct rho_frame frame = {
                .time_us = INT64_C(1000000) * next_k++, .num_scans = 3, .scans = scans};
            assert_int_equal(step_looks(&tracker, NULL, NULL, &frame, &report), RHO_OK);
        }
        const struct rho_track_report *after = report_of(before.track_id);
        assert_non_null(after);
        assert_int_equal(after->hits, before.hits + (is_frozen ? 0 : 9));
        assert_int_equal(after->misses, before.misses);
        assert_int_equal(after->score_nat > before.score_nat, !is_frozen);
    }
}

/* ---- random commands ------------------------------------------------------------------------- */

/* Random commands between noisy steps: the tracker stays sound, with its tracks in order. */
static void random_commands_keep_the_tracker_sound(void **state)
{
    unsigned done = 0;
    (void)state;
    prepare_tracker();
    for (int i = 0; i < 400; i++) {
        for (int k = 0; k < 6; k++) {
            const double x_m = uniform(-5000.0, 5000.0);
            (void)add_plot(x_m, 5000.0, 10.0);
        }
        step_scan_of_flights(next_k++, i % 3 != 0);
        const uint32_t id = 1 + (uint32_t)uniform(0.0, 6.0);
        const struct rho_operator_start start = {
            .x_m = 100.0f * (float)i, .y_m = -7000.0f, .sigma_m = 100.0f};
        done += rho_tracker_freeze_track(&tracker, id, i % 2, &report) == RHO_OK;
        done +=
            rho_tracker_renumber_track(&tracker, id + 1, 1 + (uint32_t)(i % 7), &report) == RHO_OK;
        if (i % 5 == 0) {
            done += rho_tracker_drop_track(&tracker, id, &report) == RHO_OK;
            done += rho_tracker_start_at(&tracker, &start, &report) == RHO_OK;
        }
        assert_true(rho_tracker_is_sound(&tracker));
        check_fate_sums();
    }
    assert_true(done > 80);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_operator_starts_a_track_at_a_place),
        cmocka_unit_test(a_start_needs_room_in_the_report),
        cmocka_unit_test(a_track_started_by_hand_ends_without_plots),
        cmocka_unit_test(bad_starts_by_hand_are_refused),
        cmocka_unit_test(an_operator_drops_one_track),
        cmocka_unit_test(a_drop_needs_room_in_the_report),
        cmocka_unit_test(an_operator_renumbers_a_track_upwards_and_back),
        cmocka_unit_test(identities_in_use_are_refused),
        cmocka_unit_test(evidence_is_kept_for_tracks_that_keep_their_row),
        cmocka_unit_test(a_frozen_track_coasts_until_it_is_thawed),
        cmocka_unit_test(a_frozen_track_takes_no_plots),
        cmocka_unit_test(the_time_in_which_a_track_is_frozen_does_not_count),
        cmocka_unit_test(refused_freezes_change_nothing),
        cmocka_unit_test(probabilities_outside_0_to_1_are_unsound),
        cmocka_unit_test(frames_of_bearings_leave_frozen_tracks_alone),
        cmocka_unit_test(random_commands_keep_the_tracker_sound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
