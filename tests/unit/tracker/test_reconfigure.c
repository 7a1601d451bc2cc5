/* SPDX-License-Identifier: MIT */
/* Settings changed while tracking: tracks go on, and each field applies when settings.h says. */
#include "rhotrack/operator.h"
#include "rhotrack/settings.h"
#include "tracker_setup.h"

static struct rho_settings settings;
static struct rho_tracker before;
static int next_k;

/*
 * Steps scans of a target along x that may turn by turn_mps2, and of a slow one; num_seen: 1, the
 * slow one.
 */
static double x_m, y_m, vx_mps, vy_mps;

static void step_scans(int scans, double turn_mps2, int num_seen)
{
    for (int i = 0; i < scans; i++, next_k++) {
        if (num_seen > 1) {
            add_noisy_plot(x_m, y_m, 10.0);
        }
        if (num_seen > 0) {
            add_noisy_plot(4000.0 + 30.0 * next_k, 3000.0, 10.0);
        }
        step_at(next_k);
        x_m += vx_mps;
        y_m += vy_mps + 0.5 * turn_mps2;
        vy_mps += turn_mps2;
    }
}

static void apply_settings(void)
{
    config = tracker.config;
    initiation = initiator.config;
    rho_settings_apply(&settings, &config, &initiation, NULL);
    assert_int_equal(rho_tracker_reconfigure(&tracker, &config), RHO_OK);
    assert_int_equal(rho_initiator_reconfigure(&initiator, &initiation), RHO_OK);
    assert_true(rho_tracker_is_sound(&tracker));
}

static void start_tracker(void)
{
    use_usual_configs(3);
    rho_settings_default(&settings);
    settings.scan_interval_s = 1.0f;
    settings.accel_max_mps2 = 0.5f;
    rho_settings_apply(&settings, &config, &initiation, NULL);
    begin_tracker();
    next_k = 0;
    x_m = -5000.0;
    y_m = 0.0;
    vx_mps = 100.0;
    vy_mps = 0.0;
    step_scans(20, 0.0, 2);
    assert_int_equal(report.num_tracks, 2);
}

static void tracks_survive_a_change_of_settings(void **state)
{
    (void)state;
    start_tracker();
    const uint16_t hits[2] = {report.tracks[0].hits, report.tracks[1].hits};
    const uint32_t ids[2] = {report.tracks[0].track_id, report.tracks[1].track_id};
    settings.v_max_mps = 300.0f;
    settings.accel_max_mps2 = 40.0f;
    settings.pd = 0.7f;
    settings.scans = 5;
    settings.coast_scans_max = 9;
    settings.false_tracks_per_hour = 5.0f;
    settings.work_max = 50000;
    settings.area_is_fixed = 1;
    settings.area = (struct rho_extent){-2e4f, 2e4f, -2e4f, 2e4f};
    apply_settings();
    assert_true(tracker.config.accel_max_mps2 > 39.0f);
    step_scans(10, 0.0, 2);
    assert_int_equal(report.num_tracks, 2);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(report.tracks[i].track_id, ids[i]);
        assert_int_equal(report.tracks[i].hits, hits[i] + 10);
        assert_int_equal(report.tracks[i].status, RHO_TRACK_CONFIRMED);
    }
    assert_int_equal(tracker.counters.tracks_ended, 0);
}

/* Echoes are forgotten where what never moved may be a target from now on. */
static void standing_targets_clear_the_clutter_map(void **state)
{
    (void)state;
    if (RHO_MAX_ECHOES == 0) {
        skip();
    }
    for (uint16_t standing = 0; standing < 2; standing++) {
        start_tracker();
        assert_int_equal(rho_clutter_map_teach(&tracker.clutter_map, 0, 0.0f, 9e3f, 9.0f, 9.0f, 20),
                         RHO_OK);
        settings.standing = standing;
        apply_settings();
        assert_int_equal(tracker.config.standing, standing);
        uint32_t place = 0;
        assert_int_equal(!rho_clutter_map_next_known(&tracker.clutter_map, &place), standing);
    }
}

/* A turn of 4 g is followed only after the limit of accelerations was raised. */
static void a_raised_acceleration_limit_applies_from_the_next_step(void **state)
{
    (void)state;
    if (!RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES)) {
        skip();
    }
    for (int is_told = 0; is_told < 2; is_told++) {
        start_tracker();
        const struct rho_track_report *track =
            report.tracks[0].state[1] < 1000.0f ? &report.tracks[0] : &report.tracks[1];
        const uint32_t track_id = track->track_id;
        settings.accel_max_mps2 = is_told ? 50.0f : 0.5f;
        apply_settings();
        step_scans(4, 40.0, 2);
        assert_int_equal(report_of(track_id) && report_of(track_id)->misses == 0, is_told);
    }
}

/* Scans until the track of the target that is seen no more has ended. */
static int scans_until_end(uint16_t coast_scans_max)
{
    int scans = 0;
    start_tracker();
    settings.coast_scans_max = coast_scans_max;
    apply_settings();
    for (; report.num_tracks > 1 && scans < 200; scans++) {
        step_scans(1, 0.0, 1);
    }
    return scans;
}

/* A target that is hidden for longer on average is waited for for longer. */
static void changed_end_rules_apply_from_the_next_step(void **state)
{
    (void)state;
    const int scans[3] = {scans_until_end(2), scans_until_end(5), scans_until_end(20)};
    print_message("ended after %d, %d and %d scans\n", scans[0], scans[1], scans[2]);
    assert_in_range(scans[0], 3, 10);
    assert_in_range(scans[1], scans[0] + 4, 20);
    assert_in_range(scans[2], scans[1] + 15, 80);

    start_tracker();
    settings.v_min_mps = 50.0f;
    apply_settings();
    step_scans(1, 0.0, 2);
    assert_int_equal(report.num_tracks, 1);
    assert_true(report.tracks[0].state[3] > 90.0f);
}

static void refused_settings_change_nothing(void **state)
{
    (void)state;
    start_tracker();
    memcpy(&before, &tracker, sizeof before);
    config = tracker.config;
    config.pd = 1.5f;
    assert_int_equal(rho_tracker_reconfigure(&tracker, &config), RHO_ERROR_CONFIG);
    config = tracker.config;
    config.v_max_mps = NAN;
    assert_int_equal(rho_tracker_reconfigure(&tracker, &config), RHO_ERROR_CONFIG);
    config = tracker.config;
    config.gate = RHO_TRACKER_NEAREST; /* another filter, which needs a tracker without tracks */
    assert_int_equal(rho_tracker_reconfigure(&tracker, &config), RHO_ERROR_STATE);
    assert_int_equal(rho_tracker_reconfigure(&tracker, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_reconfigure(NULL, &config), RHO_ERROR_NULL);
    assert_memory_equal(&before, &tracker, sizeof before);
    for (int i = 0; i < 100 && report.num_tracks > 0; i++) {
        step_scans(1, 0.0, 0);
    }
    assert_int_equal(report.num_tracks, 0);
    assert_int_equal(rho_tracker_reconfigure(&tracker, &config), RHO_OK);
    step_scans(20, 0.0, 2);
    assert_int_equal(report.num_tracks, 2);
    assert_true(rho_tracker_is_sound(&tracker));
    memset(&tracker, 0, sizeof tracker);
    assert_int_equal(rho_tracker_reconfigure(&tracker, &config), RHO_ERROR_STATE);
}

/* The sensors' clock was set: tracks and sensors go, what has no time stays. */
static void a_restart_drops_tracks_and_keeps_settings(void **state)
{
    const struct rho_extent area = {1e3f, 2e3f, 1e3f, 2e3f};
    static struct rho_tracker empty;

    (void)state;
    assert_int_equal(rho_tracker_restart(NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_restart(&empty), RHO_ERROR_STATE);
    start_tracker();
    if (RHO_MAX_EXCLUDED_AREAS > 0) {
        assert_int_equal(rho_tracker_exclude_area(&tracker, &area), RHO_OK);
    }
    memcpy(&before, &tracker, sizeof before);
    assert_int_equal(rho_tracker_restart(&tracker), RHO_OK);
    assert_true(before.num_tracks > 0);
    assert_int_equal(tracker.num_tracks, 0);
    assert_int_equal(tracker.num_sensors, 0);
    assert_int_equal(tracker.has_time, 0);
    assert_memory_equal(&tracker.config, &before.config, sizeof before.config);
    assert_memory_equal(&tracker.counters, &before.counters, sizeof before.counters);
    assert_memory_equal(&tracker.work, &before.work, sizeof before.work);
    assert_memory_equal(&tracker.excluded, &before.excluded, sizeof before.excluded);
    assert_int_equal(tracker.num_excluded, before.num_excluded);
    assert_true(rho_tracker_is_sound(&tracker));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tracks_survive_a_change_of_settings),
        cmocka_unit_test(standing_targets_clear_the_clutter_map),
        cmocka_unit_test(a_raised_acceleration_limit_applies_from_the_next_step),
        cmocka_unit_test(changed_end_rules_apply_from_the_next_step),
        cmocka_unit_test(refused_settings_change_nothing),
        cmocka_unit_test(a_restart_drops_tracks_and_keeps_settings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
