/* SPDX-License-Identifier: MIT */
/*
 * Two targets that fly along x and the tracker that follows both; a test compares the tracker's
 * bytes before and after a refused call.
 */
#ifndef RHOTRACK_TESTS_TWO_FLIGHTS_H
#define RHOTRACK_TESTS_TWO_FLIGHTS_H

#include "tracker_setup.h"

/* Steps with plots of two targets 4 km apart, the first of them only if sees_first. */
static void step_scan_of_flights(int k, int sees_first)
{
    if (sees_first) {
        add_noisy_plot(-3000.0 + 100.0 * k, 2000.0, 10.0);
    }
    add_noisy_plot(-3000.0 + 100.0 * k, -2000.0, 10.0);
    step_at(k);
}

static int next_k;

static void run_scans(int scans, int sees_first)
{
    for (int i = 0; i < scans; i++) {
        step_scan_of_flights(next_k++, sees_first);
    }
}

static void prepare_tracker(void)
{
    use_usual_configs(7);
    begin_tracker();
    next_k = 0;
    run_scans(12, 1);
    assert_int_equal(report.num_tracks, 2);
    assert_int_equal(report.tracks[0].track_id, 1);
    assert_int_equal(report.tracks[1].track_id, 2);
}

/* The only track within 200 m of y_m; NULL: none. */
static const struct rho_track_report *only_track_within_200_m(double y_m)
{
    const struct rho_track_report *found = NULL;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        if (fabs(report.tracks[i].state[1] - y_m) < 200.0) {
            assert_null(found);
            found = &report.tracks[i];
        }
    }
    return found;
}

static struct rho_tracker tracker_before;
static struct rho_report report_before;

static void remember_state(void)
{
    memcpy(&tracker_before, &tracker, sizeof tracker);
    memcpy(&report_before, &report, sizeof report);
}

static void check_unchanged(void)
{
    assert_memory_equal(&tracker_before, &tracker, sizeof tracker);
    assert_memory_equal(&report_before, &report, sizeof report);
}

#endif
