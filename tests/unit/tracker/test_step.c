/* SPDX-License-Identifier: MIT */
/*
 * The functions below a step's phases (step.h), each limit at both of its sides: sensor health,
 * sectors, what clutter is expected, how tracks end, shares of work. Sensors and tracks are made by
 * hand, which takes the private header: those of a scene never stand at a limit.
 */
#include "../../src/tracker/step.h"
#include "rhotrack/operator.h"
#include "rhotrack/reflectors.h"
#include "tracker_setup.h"

static const struct rho_sensor radar = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 1e5f};
static struct rho_scan scan;
static struct step at;

static void prepare(void)
{
    use_usual_configs(1);
    config.work_max = 0;
    begin_tracker();
    memset(&report, 0, sizeof report);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    tracker.unclaimed_plots = 100.0f; /* on 100 by 100 km */
    tracker.extent = (struct rho_extent){-50000.0f, 50000.0f, -50000.0f, 50000.0f};
    scan = (struct rho_scan){.sensor_id = 1, .plots = plots};
    at = (struct step){.tracker = &tracker,
                       .time_us = 100000000,
                       .scan = &scan,
                       .report = &report,
                       .sensor = &radar,
                       .in_view = {3},
                       .sigma_max_m = 10.0f,
                       .log_pd = -0.1f,
                       .log_miss = -2.3f};
}

/* 20 km away at this azimuth, with such sigmas. */
static struct rho_track *have_track(double azimuth_rad, double sigma_m)
{
    struct rho_track *track = &tracker.tracks[tracker.num_tracks];
    *track = (struct rho_track){.track_id = ++tracker.num_tracks,
                                .status = RHO_TRACK_CONFIRMED,
                                .hits = 8,
                                .plot = -1,
                                .was_confirmed = 1,
                                .time_us = at.time_us};
    track->kalman.state[RHO_X] = (float)(20000.0 * cos(azimuth_rad));
    track->kalman.state[RHO_Y] = (float)(20000.0 * sin(azimuth_rad));
    for (int axis = 0; axis < 2; axis++) {
        track->kalman.covariance[RHO_AT(axis, axis)] = (float)(sigma_m * sigma_m);
        track->kalman.covariance[RHO_AT(3 + axis, 3 + axis)] = 1.0f;
    }
    return track;
}

static void put(double x_m, double y_m)
{
    (void)add_plot(x_m, y_m, 10.0);
    report.fates[num_plots - 1] = RHO_FATE_HELD;
    scan.num_plots = at.num_inputs = at.num_gated = num_plots;
}

/* ---- sensor health --------------------------------------------------------------------------- */

#if RHO_SECTORS

/* The radar and three others that agree with it: all see what they should, all are as fine. */
static struct rho_tracker_look *have_looks(void)
{
    prepare();
    tracker.num_looks = 4;
    for (int i = 0; i < 4; i++) {
        tracker.looks[i] = (struct rho_tracker_look){.sensor_id = 1 + i,
                                                     .time_us = at.time_us,
                                                     .seen_share = 0.9f,
                                                     .distance2 = 1.0f,
                                                     .sigma_m = 10.0f,
                                                     .watched = 16,
                                                     .watched_hits = 16};
    }
    tracker.config.pd = 0.9f;
    return tracker.looks;
}

static int is_suspect(void)
{
    (void)rho_tracker_update_suspect_and_sigma_factor(&at);
    return at.is_suspect;
}

/* It sees less than 0.3 of what it should, over 12 looks or more, and one other does agree. */
static void a_sensor_that_sees_too_little_is_suspect(void **state)
{
    (void)state;
    for (int i = 0; i < 8; i++) {
        struct rho_tracker_look *looks = have_looks();
        looks[0].seen_share = i == 1 ? 0.28f : 0.26f;
        looks[0].watched = i == 2 ? 11 : 12;
        tracker.num_looks = 2;
        looks[1].watched = i == 3 ? 11 : 12;
        looks[1].seen_share = i == 4 ? 0.53f : 0.55f;
        looks[1].distance2 = i == 5 ? 2.6f : 2.4f;
        looks[1].time_us = at.time_us - (i == 6 ? 61000000 : 59000000);
        assert_int_equal(is_suspect(), i == 0 || i == 7);
    }
}

/* Its squared distances are above 4 of 12 plots or more, and two others agree. */
static void a_sensor_that_is_off_is_suspect(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct rho_tracker_look *looks = have_looks();
        looks[0].distance2 = i == 1 ? 3.9f : 4.1f;
        looks[0].watched_hits = i == 2 ? 11 : 12;
        tracker.num_looks = 3;
        looks[2].is_suspect = i == 3;
        assert_int_equal(is_suspect(), i == 0);
    }
}

/* Others that are off themselves count up to 0.7 of its distance. */
static void others_that_are_less_off_are_witnesses(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct rho_tracker_look *looks = have_looks();
        tracker.num_looks = 3;
        looks[0].distance2 = 5.0f;
        looks[1].distance2 = looks[2].distance2 = i ? 3.6f : 3.4f;
        assert_int_equal(is_suspect(), !i);
    }
}

/* One as fine and one 1.9 times as coarse are not enough. */
static void a_coarse_sensor_and_a_fine_one_cannot_tell(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct rho_tracker_look *looks = have_looks();
        tracker.num_looks = 3;
        looks[0].distance2 = 5.0f;
        looks[1].sigma_m = i ? 19.5f : 18.5f;
        assert_int_equal(is_suspect(), !i);
    }
}

static void a_suspect_sensor_is_trusted_when_it_agrees(void **state)
{
    static const float distance2[] = {2.4f, 2.6f, 1.0f, 19.0f, 25.0f},
                       shares[] = {0.55f, 0.9f, 0.53f, 0.9f, 0.9f};
    static const float factors[] = {1.0f, 2.6f, 1.0f, 19.0f, 20.0f};
    (void)state;
    for (int i = 0; i < 5; i++) {
        struct rho_tracker_look *looks = have_looks();
        looks[0].is_suspect = 1;
        looks[0].distance2 = distance2[i];
        looks[0].seen_share = shares[i];
        assert_float_equal(rho_tracker_update_suspect_and_sigma_factor(&at), factors[i], 1e-6);
        assert_int_equal(at.is_suspect, i > 0);
    }
}

/* Means are of the last sixteen looks; a plot out of the gate counts 9. */
static void looks_at_tracks_of_others_are_averaged(void **state)
{
    (void)state;
    for (int is_seen = 0; is_seen < 2; is_seen++) {
        struct rho_tracker_look *looks = have_looks();
        struct rho_track *track = have_track(0.0, 10.0);
        looks[0].seen_share = 0.8f;
        track->is_shared = 1;
        track->sensor_id = 2;
        put(20000.0, 5000.0);
        assert_int_equal(rho_assignment_begin(&tracker.assignment, 1, 1), RHO_OK);
        if (is_seen) {
            rho_tracker_add_assignment_pair(&at, 0, 0, 5.0f);
        }
        rho_tracker_solve_assignment(&at);
        rho_tracker_update_sensor_health(&at);
        assert_int_equal(looks[0].watched, 16);
        assert_float_equal(looks[0].seen_share, 0.8 + (is_seen - 0.8) / 16.0, 1e-6);
        assert_float_equal(looks[0].distance2, is_seen ? 1.0 + 8.0 / 16.0 : 1.0, 1e-6);
    }
}

/* ---- sectors --------------------------------------------------------------------------------- */

/* Three sigmas of 200 m at 20 km are 0.03 rad. */
static void an_antenna_has_passed_where_the_gate_ends(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        prepare();
        scan.sector_to_rad = 0.5f;
        at.turning = 1.0f;
        assert_int_equal(
            rho_tracker_has_antenna_passed_gate(&at, have_track(i ? 0.475 : 0.465, 200.0)), !i);
        at.turning = -1.0f;
        assert_int_equal(
            rho_tracker_has_antenna_passed_gate(&at, have_track(i ? 0.025 : 0.035, 200.0)), !i);
    }
}

/* Thresholds are those of sensors that were heard in the last minute. */
static void thresholds_of_silent_sensors_are_left_out(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct rho_tracker_look *looks = have_looks();
        looks[1].time_us = at.time_us - (i ? 61000000 : 59000000);
        looks[1].start_mnat = -5000;
        looks[1].confirm_mnat = 9000;
        tracker.num_looks = 2;
        at.initiator = &initiator;
        initiator.start_mnat = tracker.start_mnat = 1000;
        initiator.confirm_mnat = tracker.confirm_mnat = 4000;
        rho_tracker_merge_sensor_thresholds(&at);
        assert_int_equal(tracker.start_mnat, i ? 1000 : -5000);
        assert_int_equal(tracker.confirm_mnat, i ? 4000 : 9000);
    }
}

#endif

/* ---- clutter that is expected ---------------------------------------------------------------- */

static void clutter_is_smoothed_over_ten_scans(void **state)
{
    float mean = 10.0f;
    (void)state;
    rho_tracker_smooth_mean(&mean, 30.0f);
    assert_float_equal(mean, 12.0, 1e-5);
}

/* Spread over 1 by 1 km at least, and no thinner than 1e-12 a square metre. */
static void clutter_has_an_area_and_a_density(void **state)
{
    const struct rho_plot plot = {.x_m = 1.0f};
    (void)state;
    prepare();
    assert_float_equal(rho_tracker_background_density_at_plot(&at, &plot), 1e-8, 1e-12);
    tracker.extent = (struct rho_extent){0.0f, 10.0f, 0.0f, 10.0f};
    assert_float_equal(rho_tracker_background_density_at_plot(&at, &plot), 100.0 / 1e6, 1e-7);
    tracker.extent = (struct rho_extent){-2e7f, 2e7f, -2e7f, 2e7f};
    assert_float_equal(1e12 * (double)rho_tracker_background_density_at_plot(&at, &plot), 1.0,
                       1e-4);
}

/* ---- how tracks end -------------------------------------------------------------------------- */

/* One in a hundred is given up while tentative. */
static void a_tentative_track_falls_by_a_hundred_to_one(void **state)
{
    (void)state;
    prepare();
    tracker.start_mnat = 2000;
    tracker.looks_max = 1;
    const struct rho_track_limits limits = rho_tracker_track_limits(&at);
    assert_float_equal(limits.tentative_mnat, 2000.0 - 1000.0 * log(100.0), 1.0);
    assert_float_equal(limits.doubt_mnat, 1000.0 * log(200.0), 1.0);
    assert_float_equal(limits.fall_mnat, 5.0 * 2302.6, 2.0);
}

/* Up to three clutter plots in its gate of three sigmas a track that has moved may hide. */
static void a_track_hides_where_there_is_little_clutter(void **state)
{
    const double sigma_m = sqrt(3.0 / (3.14159265 * 9.0 * 1e-8));
    (void)state;
    for (int i = 0; i < 2; i++) {
        prepare();
        struct rho_track *track = have_track(0.0, sigma_m * (i ? 1.01 : 0.99));
        tracker.looks_max = 1;
        track->hits = 20;
        track->has_taken_back = 1;
        track->misses_in_row = 5;
        const struct rho_track_limits limits = rho_tracker_track_limits(&at);
        rho_tracker_apply_thresholds(&at, track, &limits);
        assert_int_equal(track->status, i ? RHO_TRACK_FREE : RHO_TRACK_TENTATIVE);
    }
}

/* ---- what a sensor sees ---------------------------------------------------------------------- */

/* Four sigmas beyond the range. */
static void plots_at_the_border_are_covered(void **state)
{
    (void)state;
    const struct rho_plot inside = {.x_m = 1e5f + 39.0f, .sigma_range_m = 10.0f},
                          outside = {.x_m = 1e5f + 41.0f, .sigma_range_m = 10.0f};
    assert_true(rho_tracker_coverage_holds_plot(&radar, &inside, 0));
    assert_false(rho_tracker_coverage_holds_plot(&radar, &outside, 0));
}

/* A radar with a notch of 10 m/s; a track across its line of sight is in it, 99 % at most. */
static void a_track_is_blind_for_five_minutes_in_little_clutter(void **state)
{
    const double sigma_m = sqrt(3.0 / (3.14159265 * 9.0 * 1e-8));
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct rho_sensor notched = radar;
        notched.notch_mps = 10.0f;
        prepare();
        at.sensor = &notched;
        at.time_us = 400000000;
        struct rho_track *track = have_track(0.0, i < 2 ? 10.0 : sigma_m * (i == 2 ? 0.99 : 1.01));
        track->filter = RHO_TRACK_KALMAN;
        track->kalman.state[RHO_VY] = 100.0f;
        track->kalman.covariance[RHO_AT(3, 3)] = track->kalman.covariance[RHO_AT(4, 4)] = 1e-4f;
        track->updated_us = at.time_us - (i == 1 ? 301000000 : 299000000);
        rho_tracker_set_blind_percents(&at);
        if (i < 2) {
            assert_int_equal(track->blind_percent, i == 0 ? 99 : 0);
        } else {
            assert_int_equal(track->blind_percent > 0, i == 2);
        }
    }
}

static void a_few_targets_in_the_notch_are_seen(void **state)
{
    struct rho_sensor notched = radar;
    (void)state;
    notched.notch_mps = 10.0f;
    prepare();
    at.sensor = &notched;
    struct rho_track *track = have_track(0.0, 10.0);
    track->kalman.state[RHO_VY] = 100.0f;
    track->blind_percent = 80;
    const struct detection seen = rho_tracker_detection_with_notch(&at, track);
    const double pd = exp((double)at.log_pd);
    assert_float_equal(seen.log_pd, log(pd * 0.2 + 0.03 * 0.8), 1e-5);
    assert_float_equal(seen.log_miss, log(1.0 - pd * 0.2), 1e-5);
}

/* Up to a minute between steps teaches; a longer silence begins anew. */
static void manoeuvres_are_learned_while_tracks_are_looked_at(void **state)
{
    (void)state;
    if (!RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES)) {
        skip();
    }
    for (int i = 0; i < 2; i++) {
        prepare();
        have_track(0.0, 10.0)->hits = 16;
        at.model.hypotheses = &tracker.hypotheses;
        rho_tracker_learn_manoeuvre_interval(&at, i ? 61.0f : 59.0f);
        assert_float_equal(tracker.straight_s, i ? 0.0 : 59.0, 1e-4);
        tracker.straight_s = 7.0f;
        tracker.time_us = 0;
        rho_tracker_reset_manoeuvre_interval_after_silence(&tracker, i ? 61000000 : 59000000);
        assert_float_equal(tracker.straight_s, i ? 0.0 : 7.0, 1e-4);
    }
}

static void scans_may_be_late_by_a_minute(void **state)
{
    (void)state;
    if (!RHO_SECTORS) {
        skip();
    }
    use_usual_configs(1);
    config.late_max_s = 60.0f;
    assert_true(rho_tracker_is_late_max_usable(&config));
    config.late_max_s = 60.1f;
    assert_false(rho_tracker_is_late_max_usable(&config));
}

/* ---- images ---------------------------------------------------------------------------------- */

#if RHO_MAX_REFLECTORS > 0

/* A wall of 1 km north of the radar, and a track that is seen in it at x, 2 km. */
static struct rho_track *have_wall(float x_m)
{
    static const struct rho_reflector wall = {
        .from_x_m = -500.0f, .from_y_m = 1000.0f, .to_x_m = 500.0f, .to_y_m = 1000.0f};
    prepare();
    assert_int_equal(rho_tracker_set_reflectors(&tracker, &wall, 1), RHO_OK);
    struct rho_track *track = have_track(0.0, 10.0);
    track->kalman.state[RHO_X] = x_m;
    return track;
}

static int is_ghost(float x_m, uint16_t hits)
{
    have_wall(x_m)->hits = hits;
    put((double)x_m, 2000.0);
    rho_tracker_index_plots(&at);
    rho_tracker_mark_image_plots_as_ghosts(&at);
    return report.fates[0] == RHO_FATE_GHOST;
}

/* Of a track of three hits; the line of sight misses the wall by three sigmas of 10 m at most. */
static void a_track_has_an_image_in_a_wall(void **state)
{
    (void)state;
    assert_true(is_ghost(800.0f, 3));
    assert_int_equal(at.work, 12 + 3);
    assert_false(is_ghost(800.0f, 2));
    assert_true(is_ghost(1058.0f, 3));
    assert_false(is_ghost(1062.0f, 3));
}

static int is_image(double off_m, uint16_t hits, uint16_t misses)
{
    have_wall(800.0f)->hits = 30;
    struct rho_track *image = have_track(0.0, 10.0);
    image->kalman.state[RHO_X] = 800.0f;
    image->kalman.state[RHO_Y] = (float)(2000.0 + off_m);
    image->hits = hits;
    image->misses = misses;
    rho_tracker_end_image_tracks(&at);
    return tracker.num_tracks == 1;
}

/* Within a chi-square of 18.5, of both variances; an established one if it is seen seldom. */
static void a_track_at_an_image_ends(void **state)
{
    (void)state;
    assert_true(is_image(sqrt(18.4 * 200.0), 8, 0));
    assert_false(is_image(sqrt(18.6 * 200.0), 8, 0));
    assert_true(is_image(0.0, 20, 14));
    assert_false(is_image(0.0, 20, 13));
}

#endif

/* ---- work ------------------------------------------------------------------------------------ */

#define WORK_MAX 1600000u

static uint32_t share_after(void (*phase)(struct step *step))
{
    prepare();
    tracker.config.work_max = WORK_MAX;
    put(20000.0, 0.0);
    rho_tracker_index_plots(&at);
    phase(&at);
    return at.share.end;
}

static void each_phase_has_its_share(void **state)
{
    (void)state;
    assert_int_equal(share_after(rho_tracker_begin_work_per_track), WORK_MAX / 4);
    if (RHO_MAX_ECHOES > 0) {
        assert_int_equal(share_after(rho_tracker_predict_clutter_at_plots), WORK_MAX / 8);
        assert_int_equal(share_after(rho_tracker_learn_second_plots_end_duplicates), WORK_MAX / 16);
    }
    if (RHO_MAX_REFLECTORS > 0) {
        assert_int_equal(share_after(rho_tracker_mark_image_plots_as_ghosts), WORK_MAX / 16);
        assert_int_equal(share_after(rho_tracker_end_image_tracks), WORK_MAX / 16);
    }
    /* what is kept of what the search has, with and without images */
    prepare();
    tracker.config.work_max = WORK_MAX;
    at.initiator = &initiator;
    initiator.config.work_max = 0;
    assert_int_equal(rho_tracker_work_left_for_search(&at), WORK_MAX - WORK_MAX / 16);
    if (RHO_MAX_REFLECTORS > 0) {
        tracker.num_reflectors = 1;
        assert_int_equal(rho_tracker_work_left_for_search(&at), WORK_MAX - WORK_MAX / 8);
    }
}

/* Eight comparisons of a plot with an area are one unit. */
static void work_for_excluded_areas_is_counted(void **state)
{
    (void)state;
    if (RHO_MAX_EXCLUDED_AREAS < 3) {
        skip();
    }
    prepare();
    for (int i = 0; i < 16; i++) {
        put(20000.0 + i, 0.0);
    }
    tracker.num_excluded = 3;
    rho_tracker_mark_excluded_plots_as_ghosts(&at);
    assert_int_equal(at.work, 16 * 3 / 8);
}

/* A scan is claimed in four parts at most. */
static void a_scan_has_four_parts(void **state)
{
    (void)state;
    if (!RHO_CLAIMS_BEYOND) {
        skip();
    }
    for (uint32_t parts = 1; parts < 8; parts++) {
        prepare();
        tracker.config.work_max = WORK_MAX;
        at.num_inputs = parts * RHO_MAX_PLOTS;
        rho_tracker_begin_work_per_track(&at);
        assert_int_equal(at.share.end, WORK_MAX / (4 * (parts < 4 ? parts : 4)));
    }
}

/* Scores of a million nat may be added. */
static void scores_have_limits(void **state)
{
    (void)state;
    assert_true(rho_tracker_is_score_in_range(1000000000) &&
                rho_tracker_is_score_in_range(-1000000000));
    assert_false(rho_tracker_is_score_in_range(1000000001) ||
                 rho_tracker_is_score_in_range(-1000000001));
    prepare();
    initiator.confirm_mnat = 1000000000;
    assert_true(rho_initiator_is_sound(&initiator));
    initiator.confirm_mnat = 1000000001;
    assert_false(rho_initiator_is_sound(&initiator));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#if RHO_SECTORS
        cmocka_unit_test(a_sensor_that_sees_too_little_is_suspect),
        cmocka_unit_test(a_sensor_that_is_off_is_suspect),
        cmocka_unit_test(others_that_are_less_off_are_witnesses),
        cmocka_unit_test(a_coarse_sensor_and_a_fine_one_cannot_tell),
        cmocka_unit_test(a_suspect_sensor_is_trusted_when_it_agrees),
        cmocka_unit_test(looks_at_tracks_of_others_are_averaged),
        cmocka_unit_test(an_antenna_has_passed_where_the_gate_ends),
        cmocka_unit_test(thresholds_of_silent_sensors_are_left_out),
#endif
        cmocka_unit_test(clutter_is_smoothed_over_ten_scans),
        cmocka_unit_test(clutter_has_an_area_and_a_density),
        cmocka_unit_test(a_tentative_track_falls_by_a_hundred_to_one),
        cmocka_unit_test(a_track_hides_where_there_is_little_clutter),
        cmocka_unit_test(plots_at_the_border_are_covered),
        cmocka_unit_test(a_track_is_blind_for_five_minutes_in_little_clutter),
        cmocka_unit_test(a_few_targets_in_the_notch_are_seen),
        cmocka_unit_test(manoeuvres_are_learned_while_tracks_are_looked_at),
        cmocka_unit_test(scans_may_be_late_by_a_minute),
#if RHO_MAX_REFLECTORS > 0
        cmocka_unit_test(a_track_has_an_image_in_a_wall),
        cmocka_unit_test(a_track_at_an_image_ends),
#endif
        cmocka_unit_test(each_phase_has_its_share),
        cmocka_unit_test(work_for_excluded_areas_is_counted),
        cmocka_unit_test(a_scan_has_four_parts),
        cmocka_unit_test(scores_have_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
