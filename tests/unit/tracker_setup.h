/* SPDX-License-Identifier: MIT */
/*
 * Shared by tests of the tracker: a tracker with its initiator, scans filled plot by plot, and
 * checks after each step.
 */
#ifndef RHOTRACK_TESTS_TRACKER_SETUP_H
#define RHOTRACK_TESTS_TRACKER_SETUP_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "random_draws.h"
#include "rhotrack/tracker.h"

#define PLOTS_MAX (RHO_MAX_PLOTS + 1200)

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;
static struct rho_tracker_config config;
static struct rho_initiator_config initiation;
static struct rho_plot plots[PLOTS_MAX];
static uint32_t num_plots;

/*
 * Configurations to be changed before begin_tracker(): four plots in five scans start a track, and
 * it is confirmed at once.
 */
static inline void use_usual_configs(uint64_t seed)
{
    random_state = seed;
    memset(&config, 0, sizeof config);
    memset(&initiation, 0, sizeof initiation);
    rho_tracker_config_default(&config);
    config.late_max_s = 0.0f;
    rho_initiator_config_default(&initiation);
    config.v_max_mps = initiation.v_max_mps = 400.0f;
    config.accel_max_mps2 = 5.0f;
    initiation.scans = 5;
    initiation.min_scans = 4;
    initiation.false_tracks_per_hour = 0.0f;
}

static inline void begin_tracker(void)
{
    num_plots = 0;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &initiation), RHO_OK);
}

/*
 * Begins with thresholds from a rate of false tracks, windows of seven scans and accelerations of
 * up to 20 m/s^2.
 */
static inline void begin_tracker_by_rate(uint64_t seed)
{
    use_usual_configs(seed);
    initiation.scans = 7;
    initiation.min_scans = 0;
    initiation.false_tracks_per_hour = 1.0f;
    config.accel_max_mps2 = 20.0f;
    begin_tracker();
}

/* At most one argument may draw a random number, as the order of evaluation is the compiler's. */
static inline struct rho_plot *add_plot(double x_m, double y_m, double sigma_m)
{
    assert_true(num_plots < PLOTS_MAX);
    plots[num_plots] = (struct rho_plot){.x_m = (float)x_m,
                                         .y_m = (float)y_m,
                                         .sigma_range_m = (float)sigma_m,
                                         .sigma_cross_m = (float)sigma_m};
    return &plots[num_plots++];
}

/* Adds a plot with noise, drawn for x first. */
static inline void add_noisy_plot(double x_m, double y_m, double sigma_m)
{
    const double dx_m = sigma_m * normal(), dy_m = sigma_m * normal();
    (void)add_plot(x_m + dx_m, y_m + dy_m, sigma_m);
}

static inline void check_fate_sums(void)
{
    uint32_t sum = 0, counted = 0, claimed = 0;
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        sum += report.fates_total[fate];
        counted += tracker.counters.fates[fate];
    }
    assert_int_equal(sum, report.num_plots);
    assert_int_equal(counted, tracker.counters.plots_in);
    for (uint32_t i = 0; i < report.num_plots && i < RHO_MAX_PLOTS; i++) {
        claimed += report.fates[i] == RHO_FATE_CLAIMED;
    }
    /* with more plots than RHO_MAX_PLOTS, claimed ones may have no entry in fates[] */
    assert_in_range(report.fates_total[RHO_FATE_CLAIMED], claimed,
                    report.num_plots > RHO_MAX_PLOTS ? claimed + RHO_MAX_TRACKS : claimed);
    for (unsigned i = 1; i < report.num_tracks; i++) {
        assert_true(report.tracks[i - 1].track_id < report.tracks[i].track_id);
    }
}

/* Steps with the plots added since the last scan; `scan` has its other fields. */
static inline void step_scan(struct rho_scan scan)
{
    scan.num_plots = num_plots;
    scan.plots = plots;
    memset(&report, 0xee, sizeof report);
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
    assert_int_equal(report.num_plots, num_plots);
    check_fate_sums();
    num_plots = 0;
}

static inline void step_at(double t_s)
{
    step_scan((struct rho_scan){.time_us = llround(t_s * 1e6)});
}

/* The track with this id; NULL: not reported. */
static inline const struct rho_track_report *report_of(uint32_t track_id)
{
    for (unsigned i = 0; i < report.num_tracks; i++) {
        if (report.tracks[i].track_id == track_id) {
            return &report.tracks[i];
        }
    }
    return NULL;
}

#endif
