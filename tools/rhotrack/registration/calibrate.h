/* SPDX-License-Identifier: MIT */
/*
 * calibrate: what radars are like, from a recording of theirs.
 *
 * Each radar's plots become tracks by the library's tracker, alone (register_tracks). Their paths
 * are cut into segments of ten plots, each a parabola; what the plots lie beside these, along the
 * line of sight and across, is the radar's noise: the tracks are found again with it, until it
 * stays. Then the tracks tell the rest.
 */
#ifndef RHOTRACK_TOOL_CALIBRATE_H
#define RHOTRACK_TOOL_CALIBRATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "pipeline/pipeline.h"
#include "settings/parameters.h"

enum calibrate_kind {
    CALIBRATE_RANGE = 0, /* of plots without a range: the noise of each axis */
    CALIBRATE_AZIMUTH,   /* of these: not known */
    CALIBRATE_PD,
    CALIBRATE_CLUTTER, /* plots a turn */
    CALIBRATE_TURN,
    CALIBRATE_FASTEST,
    CALIBRATE_SLOWEST, /* of those that surely move */
    NUM_CALIBRATE_KINDS
};

struct calibrate_figure {
    bool is_known;
    double value, sigma;
};

struct calibrate_radar {
    int32_t sensor_id;
    bool is_round; /* plots have places, and no range */
    size_t scans, turns, plots, tracks;
    size_t segments, segments_left_out; /* left out: no parabolas */
    struct calibrate_figure figures[NUM_CALIBRATE_KINDS];
    /* of the next plots of tracks beside where the last ones lead: squares over what is expected
     * by the noise that was stated, cut at 4, 1 on average where that is right */
    double innovations;
    size_t num_innovations;
    double area_km2; /* that clutter is spread over */
};

struct calibrate_result {
    size_t num_radars;
    struct calibrate_radar *radars; /* by sensor_id */
};

struct register_data;

/* Of the scans that were taken (register_data.h). The pipeline is the caller's. calibrate_free what
 * comes back. */
struct calibrate_result calibrate(struct register_data *data, struct pipeline *pipeline);
void calibrate_free(struct calibrate_result *result);

#endif
