/* SPDX-License-Identifier: MIT */
/*
 * The functions below a step's phases (step.h), each limit at both sides: sensor health, sectors,
 * expected clutter, ends of tracks, shares of work. Sensors and tracks are made by hand, with the
 * private header, as those of a scene never stand exactly at a limit.
 */
#include "../../src/tracker/clutter.h"
#include "../../src/tracker/plots.h"
#include "../../src/tracker/sensors.h"
#include "../../src/tracker/step.h"
#include "rhotrack/operator.h"
#include "rhotrack/reflectors.h"
#include "tracker_setup.h"

static const struct rho_sensor radar = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 1e5f};
static struct rho_scan scan;
static struct step at;

static void start_step(void)
{
    use_usual_configs(1);
    config.work_max = 0;
    begin_tracker();
    memset(&report, 0, sizeof report);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    tracker.unclaimed_plots = 100.0f; /* on an area of 100 by 100 km */
    tracker.extent = (struct rho_extent){-50000.0f, 50000.0f, -50000.0f, 50000.0f};
    scan = (struct rho_scan){.sensor_id = 1, .plots = plots};
    tracker.num_rows = 1;
    tracker.sensors[0].sensor.sensor_id = 1;
    at = (struct step){.tracker = &tracker,
                       .report = &report,
                       .look = {.tracker = &tracker,
                                .fates = report.fates,
                                .teaches = 1,
                                .row = tracker.sensors,
                                .time_us = 100000000,
                                .scan = &scan,
                                .sensor = &radar,
                                .in_view = {3},
                                .sigma_max_m = 10.0f,
                                .log_pd = -0.1f,
                                .log_miss = -2.3f}};
}

/* A confirmed track 20 km away at this azimuth, with this sigma on both axes. */
static struct rho_track *make_track(double azimuth_rad, double sigma_m)
{
    struct rho_track *track = &tracker.tracks[tracker.num_tracks];
    *track = (struct rho_track){.track_id = ++tracker.num_tracks,
                                .status = RHO_TRACK_CONFIRMED,
                                .hits = 8,
                                .plot = -1,
                                .was_confirmed = 1,
                                .visible = 1.0f,
                                .seen_share = 1.0f,
                                .time_us = at.look.time_us};
    track->kalman.state[RHO_X] = (float)(20000.0 * cos(azimuth_rad));
    track->kalman.state[RHO_Y] = (float)(20000.0 * sin(azimuth_rad));
    for (int axis = 0; axis < 2; axis++) {
        track->kalman.covariance[RHO_AT(axis, axis)] = (float)(sigma_m * sigma_m);
        track->kalman.covariance[RHO_AT(3 + axis, 3 + axis)] = 1.0f;
    }
    return track;
}

static void add_plot_at(double x_m, double y_m)
{
    (void)add_plot(x_m, y_m, 10.0);
    report.fates[num_plots - 1] = RHO_FATE_HELD;
    scan.num_plots = at.look.num_inputs = at.look.num_gated = num_plots;
}

/* ---- sensor health --------------------------------------------------------------------------- */

#if RHO_SECTORS

/* The radar and three others: all see what they should, with the same noise. */
static struct rho_tracker_sensor *make_agreeing_sensors(void)
{
    start_step();
    tracker.num_rows = 4;
    for (int i = 0; i < 4; i++) {
        tracker.sensors[i].sensor.sensor_id = 1 + i;
        tracker.sensors[i].look = (struct rho_tracker_look){.count = 1,
                                                            .time_us = at.look.time_us,
                                                            .seen_share = 0.9f,
                                                            .distance2 = 1.0f,
                                                            .sigma_m = 10.0f,
                                                            .watched = 16,
                                                            .watched_hits = 16};
    }
    tracker.config.pd = 0.9f;
    at.look.row = tracker.sensors;
    return tracker.sensors;
}

static int is_sensor_suspect(void)
{
    (void)rho_health_sigma_factor(&tracker, &at.look);
    return at.look.is_suspect;
}

/*
 * A sensor is suspect below 0.3 of the expected detections over at least 12 looks, if one other
 * agrees.
 */
static void a_sensor_that_sees_too_little_is_suspect(void **state)
{
    (void)state;
    for (int i = 0; i < 8; i++) {
        struct rho_tracker_sensor *sensors = make_agreeing_sensors();
        sensors[0].look.seen_share = i == 1 ? 0.28f : 0.26f;
        sensors[0].look.watched = i == 2 ? 11 : 12;
        tracker.num_rows = 2;
        sensors[1].look.watched = i == 3 ? 11 : 12;
        sensors[1].look.seen_share = i == 4 ? 0.53f : 0.55f;
        sensors[1].look.distance2 = i == 5 ? 2.6f : 2.4f;
        sensors[1].look.time_us = at.look.time_us - (i == 6 ? 61000000 : 59000000);
        assert_int_equal(is_sensor_suspect(), i == 0 || i == 7);
    }
}

/*
 * A sensor is suspect if its squared distances are above 4, over at least 12 plots, if two others
 * agree.
 */
static void a_biased_sensor_is_suspect(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct rho_tracker_sensor *sensors = make_agreeing_sensors();
        sensors[0].look.distance2 = i == 1 ? 3.9f : 4.1f;
        sensors[0].look.watched_hits = i == 2 ? 11 : 12;
        tracker.num_rows = 3;
        sensors[2].look.is_suspect = i == 3;
        assert_int_equal(is_sensor_suspect(), i == 0);
    }
}

/* Others that are biased, too, are witnesses up to 0.7 of its distance. */
static void less_biased_sensors_are_witnesses(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct rho_tracker_sensor *sensors = make_agreeing_sensors();
        tracker.num_rows = 3;
        sensors[0].look.distance2 = 5.0f;
        sensors[1].look.distance2 = sensors[2].look.distance2 = i ? 3.6f : 3.4f;
        assert_int_equal(is_sensor_suspect(), !i);
    }
}

/* Two witnesses are needed; one of more than 1.9 times the noise does not count. */
static void witnesses_have_at_most_1_9_times_the_noise(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct rho_tracker_sensor *sensors = make_agreeing_sensors();
        tracker.num_rows = 3;
        sensors[0].look.distance2 = 5.0f;
        sensors[1].look.sigma_m = i ? 19.5f : 18.5f;
        assert_int_equal(is_sensor_suspect(), !i);
    }
}

static void a_suspect_sensor_that_agrees_is_trusted_again(void **state)
{
    static const float distance2[] = {2.4f, 2.6f, 1.0f, 19.0f, 25.0f},
                       shares[] = {0.55f, 0.9f, 0.53f, 0.9f, 0.9f};
    static const float factors[] = {1.0f, 2.6f, 1.0f, 19.0f, 20.0f};
    (void)state;
    for (int i = 0; i < 5; i++) {
        struct rho_tracker_sensor *sensors = make_agreeing_sensors();
        sensors[0].look.is_suspect = 1;
        sensors[0].look.distance2 = distance2[i];
        sensors[0].look.seen_share = shares[i];
        assert_float_equal(rho_health_sigma_factor(&tracker, &at.look), factors[i], 1e-6);
        assert_int_equal(at.look.is_suspect, i > 0);
    }
}

/* Means are over the last sixteen looks; a plot outside the gate counts 9. */
static void sensor_health_averages_the_last_sixteen_looks(void **state)
{
    (void)state;
    for (int is_seen = 0; is_seen < 2; is_seen++) {
        struct rho_tracker_sensor *sensors = make_agreeing_sensors();
        struct rho_track *track = make_track(0.0, 10.0);
        sensors[0].look.seen_share = 0.8f;
        track->is_shared = 1;
        track->sensor_id = 2;
        add_plot_at(20000.0, 5000.0);
        assert_int_equal(rho_assignment_begin(&tracker.assignment, 1, 1), RHO_OK);
        if (is_seen) {
            rho_score_add_pair(&tracker, 0, 0, 5.0f);
        }
        rho_score_solve(&tracker);
        rho_health_compare(&tracker, &at.look);
        assert_int_equal(sensors[0].look.watched, 16);
        assert_float_equal(sensors[0].look.seen_share, 0.8 + (is_seen - 0.8) / 16.0, 1e-6);
        assert_float_equal(sensors[0].look.distance2, is_seen ? 1.0 + 8.0 / 16.0 : 1.0, 1e-6);
    }
}

/* ---- sectors --------------------------------------------------------------------------------- */

/* Three sigmas of 200 m at 20 km are 0.03 rad. */
static void the_antenna_has_passed_a_track_three_sigmas_behind_it(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        start_step();
        scan.sector_to_rad = 0.5f;
        at.look.turning = 1.0f;
        assert_int_equal(rho_turn_has_passed(&at.look, make_track(i ? 0.475 : 0.465, 200.0)), !i);
        at.look.turning = -1.0f;
        assert_int_equal(rho_turn_has_passed(&at.look, make_track(i ? 0.025 : 0.035, 200.0)), !i);
    }
}

/* Thresholds are merged over sensors heard in the last minute. */
static void thresholds_of_silent_sensors_are_left_out(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct rho_tracker_sensor *sensors = make_agreeing_sensors();
        sensors[1].look.time_us = at.look.time_us - (i ? 61000000 : 59000000);
        sensors[1].look.start_mnat = -5000;
        sensors[1].look.confirm_mnat = 9000;
        tracker.num_rows = 2;
        at.look.initiator = &initiator;
        initiator.start_mnat = tracker.start_mnat = 1000;
        initiator.confirm_mnat = tracker.confirm_mnat = 4000;
        rho_turn_merge_thresholds(&tracker, &at.look);
        assert_int_equal(tracker.start_mnat, i ? 1000 : -5000);
        assert_int_equal(tracker.confirm_mnat, i ? 4000 : 9000);
    }
}

#endif

/* ---- expected clutter ------------------------------------------------------------------------ */

static void clutter_counts_are_averaged_over_ten_scans(void **state)
{
    float mean = 10.0f;
    (void)state;
    rho_clutter_smooth_mean(&mean, 30.0f);
    assert_float_equal(mean, 12.0, 1e-5);
}

/* The density counts over at least 1 by 1 km, and is at least 1e-12 a square metre. */
static void clutter_density_has_a_least_area_and_value(void **state)
{
    const struct rho_plot plot = {.x_m = 1.0f};
    (void)state;
    start_step();
    assert_float_equal(rho_clutter_background_at(&at.look, &plot), 1e-8, 1e-12);
    tracker.extent = (struct rho_extent){0.0f, 10.0f, 0.0f, 10.0f};
    assert_float_equal(rho_clutter_background_at(&at.look, &plot), 100.0 / 1e6, 1e-7);
    tracker.extent = (struct rho_extent){-2e7f, 2e7f, -2e7f, 2e7f};
    assert_float_equal(1e12 * (double)rho_clutter_background_at(&at.look, &plot), 1.0, 1e-4);
}

/* ---- how tracks end -------------------------------------------------------------------------- */

/* Status of a track with this existence, of which the given part is hidden. */
static int status_by_existence(enum rho_track_status before, double exists, double hidden_part)
{
    start_step();
    struct rho_track *track = make_track(0.0, 10.0);
    track->status = (uint8_t)before;
    track->hits = RHO_ESTABLISHED_HITS;
    track->hidden = (float)(exists * hidden_part);
    track->visible = (float)exists - track->hidden;
    rho_life_apply(&at, track, 0);
    return track->status;
}

/* Confirmed from the confirm threshold on; ended when one in a hundred is true. */
static void tentative_tracks_end_when_one_in_a_hundred_is_true(void **state)
{
    const int least_mnat = (int)ceil(2000.0 - 1000.0 * log(100.0));
    const int scores_mnat[4] = {least_mnat - 1, least_mnat + 1, 4999, 5001};
    (void)state;
    for (int i = 0; i < 4; i++) {
        start_step();
        tracker.start_mnat = 2000;
        struct rho_track *track = make_track(0.0, 10.0);
        track->status = RHO_TRACK_TENTATIVE;
        track->was_confirmed = 0;
        track->score_mnat = scores_mnat[i];
        rho_life_apply(&at, track, 5000);
        assert_int_equal(track->status, i == 0   ? RHO_TRACK_FREE
                                        : i == 3 ? RHO_TRACK_CONFIRMED
                                                 : RHO_TRACK_TENTATIVE);
        assert_int_equal(report.num_ended, 0);
        assert_int_equal(tracker.counters.tracks_confirmed, i == 3);
    }
}

/* No miss confirms a track for the first time, even where the threshold has fallen below it. */
static void a_missed_track_is_not_confirmed_for_the_first_time(void **state)
{
    (void)state;
    for (int misses = 0; misses < 2; misses++) {
        start_step();
        struct rho_track *track = make_track(0.0, 10.0);
        track->status = RHO_TRACK_TENTATIVE;
        track->was_confirmed = 0;
        track->score_mnat = 9000;
        track->misses_in_row = (uint8_t)misses;
        rho_life_apply(&at, track, 5000);
        assert_int_equal(track->status, misses ? RHO_TRACK_TENTATIVE : RHO_TRACK_CONFIRMED);
    }
}

/* Shown from 0.48 on, shown again from 0.8 on, and ended below 0.05. */
static void existence_decides_what_is_shown_and_ends(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        const double hidden = 0.5 * i;
        assert_int_equal(status_by_existence(RHO_TRACK_CONFIRMED, 0.49, hidden),
                         RHO_TRACK_CONFIRMED);
        assert_int_equal(status_by_existence(RHO_TRACK_COASTING, 0.49, hidden), RHO_TRACK_COASTING);
        assert_int_equal(status_by_existence(RHO_TRACK_COASTING, 0.47, hidden),
                         RHO_TRACK_TENTATIVE);
        assert_int_equal(status_by_existence(RHO_TRACK_TENTATIVE, 0.79, hidden),
                         RHO_TRACK_TENTATIVE);
        assert_int_equal(status_by_existence(RHO_TRACK_TENTATIVE, 0.81, hidden),
                         RHO_TRACK_CONFIRMED);
        assert_int_equal(status_by_existence(RHO_TRACK_COASTING, 0.021, hidden),
                         RHO_TRACK_TENTATIVE);
        assert_int_equal(report.num_ended, 0);
        assert_int_equal(status_by_existence(RHO_TRACK_COASTING, 0.019, hidden), RHO_TRACK_FREE);
        assert_int_equal(report.num_ended, 1);
    }
}

/*
 * No place is shown that clutter would fill: more than one plot of it is expected in the gate of
 * three sigmas. An estimate no wider than the scan's widest plot is known.
 */
static void places_that_clutter_would_fill_are_not_shown(void **state)
{
    const double sigma_m = sqrt(1.0 / (3.14159265 * 9.0 * 1e-8));
    (void)state;
    for (int i = 0; i < 5; i++) {
        const double plot_sigma_m = sigma_m * (i == 2 ? 1.02 : i == 3 ? 1.0 : 0.1);
        start_step();
        struct rho_track *track = make_track(0.0, sigma_m * (i == 0 ? 0.99 : 1.01));
        (void)add_plot(20000.0, 0.0, plot_sigma_m);
        scan.num_plots = 1;
        at.look.sigma_max_m = (float)plot_sigma_m;
        /* a track that is not looked at is left alone */
        track->time_us = at.look.time_us - (i == 4 ? 1 : 0);
        rho_life_doubt_places(&tracker, &at.look);
        assert_int_equal(track->status,
                         i == 1 || i == 3 ? RHO_TRACK_TENTATIVE : RHO_TRACK_CONFIRMED);
    }
}

/* ---- soundness of a track's life ------------------------------------------------------------- */

static struct rho_track *make_living_track(void)
{
    start_step();
    struct rho_track *track = make_track(0.0, 10.0);
    track->visible = 0.9f;
    track->hidden = 0.05f;
    return track;
}

static void probabilities_outside_0_to_1_are_unsound(void **state)
{
    static const float bad[] = {-1e-6f, 1.00001f, NAN, INFINITY, -INFINITY};
    (void)state;
    assert_true(rho_life_is_sound(make_living_track()));
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        make_living_track()->visible = bad[i];
        assert_false(rho_life_is_sound(tracker.tracks));
        make_living_track()->hidden = bad[i];
        assert_false(rho_life_is_sound(tracker.tracks));
        make_living_track()->appeared = bad[i];
        assert_false(rho_life_is_sound(tracker.tracks));
        make_living_track()->seen_share = bad[i];
        assert_false(rho_life_is_sound(tracker.tracks));
    }
    make_living_track()->seen_share = 0.0f; /* evidence is divided by it */
    assert_false(rho_life_is_sound(tracker.tracks));
    make_living_track()->look_nat = NAN;
    assert_false(rho_life_is_sound(tracker.tracks));
    make_living_track()->seen_nat = -1.0f;
    assert_false(rho_life_is_sound(tracker.tracks));
    make_living_track()->missed = -1.0f;
    assert_false(rho_life_is_sound(tracker.tracks));
}

/* ---- coverage and notch of a sensor ---------------------------------------------------------- */

/* Plots up to four sigmas beyond the range count as covered. */
static void plots_four_sigmas_beyond_the_range_are_covered(void **state)
{
    (void)state;
    const struct rho_plot inside = {.x_m = 1e5f + 39.0f, .sigma_range_m = 10.0f},
                          outside = {.x_m = 1e5f + 41.0f, .sigma_range_m = 10.0f};
    assert_true(rho_coverage_holds_plot(&radar, &inside, 0));
    assert_false(rho_coverage_holds_plot(&radar, &outside, 0));
}

/* A radar with a notch of 10 m/s; a track across its line of sight is in it with at most 99 %. */
static void tracks_stay_in_the_notch_for_five_minutes_at_most(void **state)
{
    const double sigma_m = sqrt(3.0 / (3.14159265 * 9.0 * 1e-8));
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct rho_sensor notched = radar;
        notched.notch_mps = 10.0f;
        start_step();
        at.look.sensor = &notched;
        at.look.time_us = 400000000;
        struct rho_track *track = make_track(0.0, i < 2 ? 10.0 : sigma_m * (i == 2 ? 0.99 : 1.01));
        track->filter = RHO_TRACK_KALMAN;
        track->kalman.state[RHO_VY] = 100.0f;
        track->kalman.covariance[RHO_AT(3, 3)] = track->kalman.covariance[RHO_AT(4, 4)] = 1e-4f;
        track->updated_us = at.look.time_us - (i == 1 ? 301000000 : 299000000);
        rho_notch_mark_tracks(&tracker, &at.look);
        if (i < 2) {
            assert_int_equal(track->blind_percent, i == 0 ? 99 : 0);
        } else {
            assert_int_equal(track->blind_percent > 0, i == 2);
        }
    }
}

static void a_look_in_the_notch_has_a_small_pd(void **state)
{
    struct rho_sensor notched = radar;
    (void)state;
    notched.notch_mps = 10.0f;
    start_step();
    at.look.sensor = &notched;
    struct rho_track *track = make_track(0.0, 10.0);
    track->kalman.state[RHO_VY] = 100.0f;
    track->blind_percent = 80;
    const struct detection seen = rho_look_detection(&at.look, track);
    const double pd = exp((double)at.look.log_pd);
    assert_float_equal(seen.log_pd, log(pd * 0.2 + 0.03 * 0.8), 1e-5);
    assert_float_equal(seen.log_miss, log(1.0 - pd * 0.2), 1e-5);
}

/* Steps up to a minute apart teach the manoeuvre interval; a longer silence starts anew. */
static void manoeuvres_are_learned_in_gaps_up_to_a_minute(void **state)
{
    (void)state;
    if (!RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES)) {
        skip();
    }
    for (int i = 0; i < 2; i++) {
        start_step();
        make_track(0.0, 10.0)->hits = 16;
        at.look.model.hypotheses = &tracker.hypotheses;
        rho_manoeuvres_learn(&tracker, &at.look, i ? 61.0f : 59.0f);
        assert_float_equal(tracker.straight_s, i ? 0.0 : 59.0, 1e-4);
        tracker.straight_s = 7.0f;
        tracker.time_us = 0;
        rho_manoeuvres_reset(&tracker, i ? 61000000 : 59000000);
        assert_float_equal(tracker.straight_s, i ? 0.0 : 7.0, 1e-4);
    }
}

/* ---- mirror images --------------------------------------------------------------------------- */

#if RHO_MAX_REFLECTORS > 0

/* A wall 1 km north of the radar, and a track at x whose image is 2 km north. */
static struct rho_track *make_wall_and_track(float x_m)
{
    static const struct rho_reflector wall = {
        .from_x_m = -500.0f, .from_y_m = 1000.0f, .to_x_m = 500.0f, .to_y_m = 1000.0f};
    start_step();
    assert_int_equal(rho_tracker_set_reflectors(&tracker, &wall, 1), RHO_OK);
    struct rho_track *track = make_track(0.0, 10.0);
    track->kalman.state[RHO_X] = x_m;
    return track;
}

static int is_plot_ghost(float x_m, uint16_t hits)
{
    make_wall_and_track(x_m)->hits = hits;
    add_plot_at((double)x_m, 2000.0);
    rho_plots_index(&tracker, &at.look);
    rho_images_mark_plots(&at.look, &at.work);
    return report.fates[0] == RHO_FATE_GHOST;
}

/* Tracks of three hits have images; the line of sight may miss the wall by three sigmas of 10 m. */
static void plots_at_images_of_established_tracks_are_ghosts(void **state)
{
    (void)state;
    assert_true(is_plot_ghost(800.0f, 3));
    assert_int_equal(at.work.spent, 12 + 3);
    assert_false(is_plot_ghost(800.0f, 2));
    assert_true(is_plot_ghost(1058.0f, 3));
    assert_false(is_plot_ghost(1062.0f, 3));
}

static int does_track_at_image_end(double off_m, uint16_t hits, uint16_t misses)
{
    make_wall_and_track(800.0f)->hits = 30;
    struct rho_track *image = make_track(0.0, 10.0);
    image->kalman.state[RHO_X] = 800.0f;
    image->kalman.state[RHO_Y] = (float)(2000.0 + off_m);
    image->hits = hits;
    image->misses = misses;
    rho_images_end_tracks(&at);
    return tracker.num_tracks == 1;
}

/*
 * Within a chi-square of 18.5 of both covariances a track ends; an established one if it is seen
 * rarely.
 */
static void tracks_near_an_image_end(void **state)
{
    (void)state;
    assert_true(does_track_at_image_end(sqrt(18.4 * 200.0), 8, 0));
    assert_false(does_track_at_image_end(sqrt(18.6 * 200.0), 8, 0));
    assert_true(does_track_at_image_end(0.0, 20, 14));
    assert_false(does_track_at_image_end(0.0, 20, 13));
}

#endif

/* ---- work ------------------------------------------------------------------------------------ */

#define WORK_MAX 1600000u

static void begin_step_with_plot(void)
{
    start_step();
    tracker.config.work_max = WORK_MAX;
    add_plot_at(20000.0, 0.0);
    rho_plots_index(&tracker, &at.look);
}

static void each_phase_has_its_share_of_work(void **state)
{
    (void)state;
    begin_step_with_plot();
    rho_work_begin_shares(&at.look, &at.work);
    assert_int_equal(at.work.share.end, WORK_MAX / 4);
    if (RHO_MAX_ECHOES > 0) {
        begin_step_with_plot();
        rho_echoes_predict(&tracker, &at.look, &at.work);
        assert_int_equal(at.work.share.end, WORK_MAX / 8);
        begin_step_with_plot();
        rho_second_plots_take_look(&at);
        assert_int_equal(at.work.share.end, WORK_MAX / 16);
    }
    if (RHO_MAX_REFLECTORS > 0) {
        begin_step_with_plot();
        rho_images_mark_plots(&at.look, &at.work);
        assert_int_equal(at.work.share.end, WORK_MAX / 16);
        begin_step_with_plot();
        rho_images_end_tracks(&at);
        assert_int_equal(at.work.share.end, WORK_MAX / 16);
    }
    /* work reserved after the search, with and without images */
    start_step();
    tracker.config.work_max = WORK_MAX;
    at.look.initiator = &initiator;
    initiator.config.work_max = 0;
    assert_int_equal(rho_work_left_for_search(&at.look, &at.work), WORK_MAX - WORK_MAX / 16);
    if (RHO_MAX_REFLECTORS > 0) {
        tracker.num_reflectors = 1;
        assert_int_equal(rho_work_left_for_search(&at.look, &at.work), WORK_MAX - WORK_MAX / 8);
    }
}

/* Eight comparisons of a plot with an area cost one unit. */
static void work_for_excluded_areas_is_counted(void **state)
{
    (void)state;
    if (RHO_MAX_EXCLUDED_AREAS < 3) {
        skip();
    }
    start_step();
    for (int i = 0; i < 16; i++) {
        add_plot_at(20000.0 + i, 0.0);
    }
    tracker.num_excluded = 3;
    rho_areas_mark_plots(&tracker, &at.look, &at.work);
    assert_int_equal(at.work.spent, 16 * 3 / 8);
}

/* The plots of a scan are claimed in four parts at most. */
static void a_scan_is_claimed_in_four_parts_at_most(void **state)
{
    (void)state;
    if (!RHO_CLAIMS_BEYOND) {
        skip();
    }
    for (uint32_t parts = 1; parts < 8; parts++) {
        start_step();
        tracker.config.work_max = WORK_MAX;
        at.look.num_inputs = parts * RHO_MAX_PLOTS;
        rho_work_begin_shares(&at.look, &at.work);
        assert_int_equal(at.work.share.end, WORK_MAX / (4 * (parts < 4 ? parts : 4)));
    }
}

/* Scores are limited to a million nat, so that they can be added. */
static void scores_and_thresholds_beyond_a_million_nat_are_unsound(void **state)
{
    (void)state;
    assert_true(rho_tracker_is_score_in_range(1000000000) &&
                rho_tracker_is_score_in_range(-1000000000));
    assert_false(rho_tracker_is_score_in_range(1000000001) ||
                 rho_tracker_is_score_in_range(-1000000001));
    start_step();
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
        cmocka_unit_test(a_biased_sensor_is_suspect),
        cmocka_unit_test(less_biased_sensors_are_witnesses),
        cmocka_unit_test(witnesses_have_at_most_1_9_times_the_noise),
        cmocka_unit_test(a_suspect_sensor_that_agrees_is_trusted_again),
        cmocka_unit_test(sensor_health_averages_the_last_sixteen_looks),
        cmocka_unit_test(the_antenna_has_passed_a_track_three_sigmas_behind_it),
        cmocka_unit_test(thresholds_of_silent_sensors_are_left_out),
#endif
        cmocka_unit_test(clutter_counts_are_averaged_over_ten_scans),
        cmocka_unit_test(clutter_density_has_a_least_area_and_value),
        cmocka_unit_test(tentative_tracks_end_when_one_in_a_hundred_is_true),
        cmocka_unit_test(a_missed_track_is_not_confirmed_for_the_first_time),
        cmocka_unit_test(existence_decides_what_is_shown_and_ends),
        cmocka_unit_test(places_that_clutter_would_fill_are_not_shown),
        cmocka_unit_test(probabilities_outside_0_to_1_are_unsound),
        cmocka_unit_test(plots_four_sigmas_beyond_the_range_are_covered),
        cmocka_unit_test(tracks_stay_in_the_notch_for_five_minutes_at_most),
        cmocka_unit_test(a_look_in_the_notch_has_a_small_pd),
        cmocka_unit_test(manoeuvres_are_learned_in_gaps_up_to_a_minute),
#if RHO_MAX_REFLECTORS > 0
        cmocka_unit_test(plots_at_images_of_established_tracks_are_ghosts),
        cmocka_unit_test(tracks_near_an_image_end),
#endif
        cmocka_unit_test(each_phase_has_its_share_of_work),
        cmocka_unit_test(work_for_excluded_areas_is_counted),
        cmocka_unit_test(a_scan_is_claimed_in_four_parts_at_most),
        cmocka_unit_test(scores_and_thresholds_beyond_a_million_nat_are_unsound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
