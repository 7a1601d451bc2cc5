/* SPDX-License-Identifier: MIT */
/*
 * register: estimates the biases of radars from the targets that several of them see.
 *
 * The library's tracker makes tracks of each radar's plots alone. Tracks of different radars that
 * stay close together are matched as one target (register_match). The targets' paths are cut into
 * segments, each modelled as a parabola common to all radars. Least squares over all segments give
 * the range, azimuth and time biases of all radars at once; the parabolas' coefficients are
 * eliminated, and outlying plots have less weight (register_solve). Tracks are matched again with
 * the new biases until the matches no longer change.
 *
 * The configured biases are already subtracted from the plots; the estimate is the remainder. Only
 * differences of time biases can be observed: the reference radar's time is taken as true.
 * Estimation is in the horizontal plane; measured heights are not used.
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
    /* configured bias plus estimated remainder; the configured one where not known */
    double value;
    double sigma; /* standard deviation of the estimate; 0 for the reference radar's time */
    /* false where sigma is more than half of a plot's noise, or no target is in common */
    bool is_known;
};

struct register_radar {
    int32_t sensor_id;
    size_t scans, plots, tracks; /* tracks: number of confirmed tracks */
    size_t common_plots;         /* plots in the path segments that were used */
    struct register_bias biases[NUM_REGISTER_KINDS];
};

struct register_result {
    size_t num_radars;
    struct register_radar *radars;      /* in the order of sensor_id */
    size_t reference;                   /* index of the radar whose time is taken as true */
    size_t targets;                     /* number of targets seen by several radars */
    size_t segments, segments_left_out; /* path segments used, and those left out as no parabolas */
    size_t plots;                       /* plots in the segments used */
    /* ratio of the plots' actual noise to their sigmas; the biases' sigmas include it */
    double misfit;
    size_t rounds;
};

struct register_data;

struct register_data *register_start(const struct parameters *parameters);

/*
 * Adds one scan of a radar; scans may come in any order, and sectors are put together to turns.
 * Returns NULL, or the reason why the scan was not added: its radar moves, or its plots are not in
 * range and azimuth (their sigmas along and across are equal).
 */
const char *register_add_scan(struct register_data *data, const struct rho_scan *scan,
                              const struct rho_sensor *sensor);

/* Number of radars of which scans have been seen. */
size_t register_num_radars(const struct register_data *data);

/*
 * Estimates the biases of all radars from the scans added; register_result_free frees the result.
 * The pipeline is used for tracking and stays the caller's.
 */
struct register_result register_estimate_biases(struct register_data *data,
                                                struct pipeline *pipeline);

void register_result_free(struct register_result *result);
void register_free(struct register_data *data);

#endif
