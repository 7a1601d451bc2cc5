/* SPDX-License-Identifier: MIT */
/*
 * scenario_antenna: what a turning antenna sees of moving targets: each plot when the antenna passes it, by sectors.
 *
 * Times are those of the radar's clock, which is time_bias_s ahead; azimuths, of plots and of sectors, those that it
 * says, which are azimuth_bias_rad too far. The antenna begins a turn at start_s, when it says start_rad.
 */
#ifndef RHOTRACK_TOOL_SCENARIO_ANTENNA_H
#define RHOTRACK_TOOL_SCENARIO_ANTENNA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "random.h"
#include "scenario.h"

struct scenario_antenna {
    int32_t sensor_id;
    double x_m, y_m;
    double turn_s;
    double start_s, start_rad;
    bool is_counter_clockwise; /* radars turn clockwise */
    size_t sectors;            /* of a turn; 1: a scan is a whole turn */
    double pd;
    double range_min_m, range_max_m; /* of targets, and of clutter */
    bool has_range_rate;
    double sigma_range_m, sigma_azimuth_rad, sigma_range_rate_mps;
    double range_bias_m, azimuth_bias_rad, time_bias_s; /* as of struct rho_sensor */
    double clutter_mean;         /* plots a turn, uniform in range and azimuth */
    double clutter_rate_max_mps; /* its range rates are uniform within, either way */
};

/* Who flies where. `at` says where a target is at a true time; false where it is not there. */
struct antenna_targets {
    size_t count;
    const void *context;
    bool (*at)(const void *context, size_t target, double t_s, struct truth_point *truth);
};

struct antenna_plot {
    double t_s;
    int target_id;            /* -1: clutter */
    struct truth_point truth; /* of a target: then and there, at the true time; else 0 */
    double range_m, azimuth_rad, range_rate_mps; /* range rate 0 where not measured */
};

/* A scan: from start_s to end_s the antenna looked from from_rad counter-clockwise to to_rad; equal: all round. */
struct antenna_sector {
    double start_s, end_s;
    double from_rad, to_rad;
    size_t num_plots; /* in the order of time */
    struct antenna_plot *plots;
};

struct antenna_view {
    size_t num_sectors; /* in the order of time, empty ones too */
    struct antenna_sector *sectors;
    struct antenna_plot *plots; /* of all sectors */
};

/* So many turns. Targets' plots are the same whatever clutter there is, and as many random numbers are drawn for one that
 * is missed. A plot belongs to the sector in which the antenna was; the noise of its azimuth may put it outside. */
struct antenna_view antenna_watch(const struct scenario_antenna *antenna,
                                  const struct antenna_targets *targets, size_t num_turns,
                                  struct random *random);
void antenna_view_free(struct antenna_view *view);

/* ---- the parts of it -------------------------------------------------------------------------- */

/* The azimuth that the antenna says at a time of its clock, within +-pi. */
double antenna_azimuth_rad(const struct scenario_antenna *antenna, double t_s);

/* The next time, after after_s, at which the antenna points to the target, and the target then. False: it is not there. */
bool antenna_meets(const struct scenario_antenna *antenna, const struct antenna_targets *targets,
                   size_t target, double after_s, double *t_s, struct truth_point *truth);

/* A sector, counted over all turns, without its plots. */
struct antenna_sector antenna_sector_at(const struct scenario_antenna *antenna, size_t index);

/* A plot of a target that the antenna meets, with bias and noise. */
struct antenna_plot antenna_measure(const struct scenario_antenna *antenna, double t_s,
                                    const struct truth_point *truth, struct random *random);

#endif
