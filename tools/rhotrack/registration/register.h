/* SPDX-License-Identifier: MIT */
/*
 * register: the biases of radars from the targets that several of them see.
 *
 * Each radar's plots become tracks by the library's tracker, alone. Tracks of different radars that
 * stay together are one target (register_match). Segments of a target's path, each a parabola that
 * all radars' plots are measured against, give the biases by least squares: range, azimuth and time
 * of every radar at once, the segments' own parameters eliminated, plots far off with less weight
 * (register_solve). The biases bring other tracks together, and so on until nothing changes.
 *
 * Plots come with the biases that are configured taken off; what is found is what is left. Only
 * differences of time can be known: one radar, the reference, has the true time. Level: heights,
 * where measured, are left out.
 */
#ifndef RHOTRACK_TOOL_REGISTER_H
#define RHOTRACK_TOOL_REGISTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "pipeline/pipeline.h"
#include "rhotrack/types.h"
#include "settings/parameters.h"

enum register_kind { REGISTER_RANGE = 0, REGISTER_AZIMUTH, REGISTER_TIME, NUM_REGISTER_KINDS };

/* One bias of one radar, in metres, radians or seconds. */
struct register_bias {
    double value;  /* in all, with what was configured; not known: what was configured */
    double sigma;  /* of the estimate; the reference's time: 0 */
    bool is_known; /* else sigma is more than half of a plot's noise, or nothing is in common */
};

struct register_radar {
    int32_t sensor_id;
    size_t scans, plots, tracks; /* tracks: confirmed ones */
    size_t common_plots;         /* of the segments of path that were used */
    struct register_bias biases[NUM_REGISTER_KINDS];
};

struct register_result {
    size_t num_radars;
    struct register_radar *radars;      /* by sensor_id */
    size_t reference;                   /* whose time counts as right */
    size_t targets;                     /* seen by several radars */
    size_t segments, segments_left_out; /* of their paths; left out: no parabola */
    size_t plots;                       /* of the segments */
    double misfit; /* the plots' noise over what their sigmas say; the biases' sigmas have it in */
    size_t rounds;
};

struct register_data;

struct register_data *register_start(const struct parameters *parameters);

/*
 * One scan of a radar, in any order; sectors are put together to turns. Returns NULL, or what is
 * wrong, and nothing is taken: a radar that moves, plots that are not in range and azimuth (the
 * same sigma along and across).
 */
const char *register_add_scan(struct register_data *data, const struct rho_scan *scan,
                              const struct rho_sensor *sensor);

/* Radars so far. */
size_t register_num_radars(const struct register_data *data);

/* All of it. The pipeline is the caller's. register_result_free what comes back. */
struct register_result register_estimate_biases(struct register_data *data,
                                                struct pipeline *pipeline);

void register_result_free(struct register_result *result);
void register_free(struct register_data *data);

#endif
