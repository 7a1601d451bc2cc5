/* SPDX-License-Identifier: MIT */
/*
 * calibrate_noise: estimates the noise, pd, clutter, turn time and target speeds of radars
 * from a recording of their plots.
 *
 * The library's tracker makes tracks of each radar's plots alone (register_tracks). The tracks are
 * cut into segments of ten plots, and a parabola is fitted to each; the residuals along and across
 * the line of sight give the radar's noise. Tracks are found again with this noise until it
 * converges. The other figures come from the last tracks, pd from what the tracker has learned.
 */
#ifndef RHOTRACK_TOOL_CALIBRATE_NOISE_H
#define RHOTRACK_TOOL_CALIBRATE_NOISE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "pipeline/pipeline.h"
#include "pipeline/plots_beside_tracks.h"
#include "settings/parameters.h"

enum calibrate_kind {
    CALIBRATE_RANGE = 0, /* noise of range; of plots without a range: noise of each axis */
    CALIBRATE_AZIMUTH,   /* noise of azimuth; not known of plots without a range */
    CALIBRATE_PD,
    CALIBRATE_CLUTTER, /* clutter plots a turn of the antenna */
    CALIBRATE_TURN,
    CALIBRATE_FASTEST,
    CALIBRATE_SLOWEST, /* slowest of the tracks that certainly move */
    NUM_CALIBRATE_KINDS
};

struct calibrate_figure {
    bool is_known;
    double value, sigma;
    bool is_stated; /* not known: the value is the stated one */
};

struct calibrate_radar {
    int32_t sensor_id;
    bool has_bodies;   /* targets give several plots: their extent hides the noise */
    bool is_isotropic; /* plots are Cartesian, with equal sigmas on all axes */
    size_t scans, turns, plots, tracks;
    size_t segments, segments_left_out; /* left out: segments that fit no parabola */
    /* with bodies the noise is not known, but has the stated value where plots tell it */
    struct calibrate_figure figures[NUM_CALIBRATE_KINDS];
    /*
     * mean normalised innovation squared of tracks' plots, extrapolated from the four plots before
     * with the stated noise; each cut at 4, and scaled to be 1 where the stated noise is right
     */
    double innovations;
    size_t num_innovations;
    double area_km2; /* area over which clutter is spread */
};

struct calibrate_result {
    size_t num_radars;
    struct calibrate_radar *radars; /* in the order of sensor_id */
    struct found_body body;         /* as found; body_max_m is 0 also where it was told */
};

struct register_data;

/*
 * Calibrates every radar from the scans in data (register_data.h);
 * calibrate_result_free frees the result. The pipeline is used for tracking and stays the caller's.
 */
struct calibrate_result calibrate(struct register_data *data, struct pipeline *pipeline);
void calibrate_result_free(struct calibrate_result *result);

#endif
