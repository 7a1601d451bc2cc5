/* SPDX-License-Identifier: MIT */
/*
 * register_data: the radars, scans, plots and tracks that all parts of
 * register and calibrate work on.
 */
#ifndef RHOTRACK_TOOL_REGISTER_DATA_H
#define RHOTRACK_TOOL_REGISTER_DATA_H

#include "registration/register.h"

/*
 * A plot of a radar; radars, plots and tracks are referred to by their index in the arrays of
 * radar_data and register_data.
 */
struct radar_plot {
    int64_t time_us;
    double range_m, azimuth_rad; /* relative to the radar, with the configured biases subtracted */
    double sigma_range_m, sigma_cross_m;
    struct rho_plot plot;
};

struct radar_scan {
    int64_t time_us;
    double from_rad, to_rad;
    size_t first, count; /* index of the scan's first plot, and number of its plots */
};

/* A confirmed track of one radar alone: indices of its plots in the order of time. */
struct radar_track {
    size_t radar;
    size_t count, capacity;
    size_t *plots;
    size_t earlier; /* plots used to start the track, before the first of plots */
    size_t target;  /* number of the matched target, equal for all its tracks */
};

struct radar_data {
    struct rho_sensor sensor;
    size_t num_scans, scans_room, num_plots, plots_room;
    struct radar_scan *scans;
    struct radar_plot *plots;
    /* remaining biases after the configured ones, as estimated so far */
    double bias[NUM_REGISTER_KINDS];
    size_t claimed; /* plots that tracks claimed in the last run of the tracker */
};

struct register_data {
    const struct parameters *parameters;
    int64_t start_us; /* time of the first scan; t_s counts from here */
    size_t num_radars, radars_room;
    struct radar_data *radars;
    size_t num_tracks, tracks_room;
    struct radar_track *tracks;
};

/* Adds one scan of a radar without checking it: Cartesian plots are taken, too. */
void register_add_unchecked_scan(struct register_data *data, const struct rho_scan *scan,
                                 const struct rho_sensor *sensor);

/* Time and place of a plot after subtracting the biases estimated so far. */
struct corrected {
    double t_s, x_m, y_m;
    double cos_azimuth, sin_azimuth, range_m;
};
struct corrected register_correct_plot(const struct register_data *data,
                                       const struct radar_data *radar,
                                       const struct radar_plot *plot);

/*
 * Make the confirmed tracks of all radars, or of one: sort its scans by time, join sectors to turns
 * and step the tracker. In register_tracks.c.
 */
void register_track_all_radars(struct register_data *data, struct pipeline *pipeline);
void register_track_one_radar(struct register_data *data, size_t radar_number,
                              struct pipeline *pipeline);

/*
 * Index one past the last scan of the turn that begins with scan `first`. In
 * register_tracks.c.
 */
size_t register_find_scan_after_turn(const struct radar_data *radar, size_t first);

/*
 * Matches the tracks of different radars to targets with the biases estimated so far, and sets each
 * track's `target`; true where any changed. gate_m: largest rms distance of two matched tracks.
 * misfit: ratio of the plots' noise to their sigmas, with which tracks must also agree
 * statistically; 0: they need not. In register_match_tracks.c.
 */
bool register_update_matches(struct register_data *data, double gate_m, double misfit);

/* Number of targets of which several radars have tracks. */
size_t register_num_common_targets(const struct register_data *data);

/* Result of the least squares for the biases. */
struct solution {
    size_t segments, segments_left_out, plots;
    double misfit, speed_mps;
    size_t *radar_plots; /* of each radar: number of plots in the segments used */
    double *sigma;       /* standard deviations of each radar's NUM_REGISTER_KINDS biases */
};
/*
 * Estimates the radars' biases by least squares and stores them in data; the reference radar's time
 * bias is kept. In register_solve_biases.c.
 */
struct solution register_solve_biases(struct register_data *data, size_t reference);
void bias_solution_free(struct solution *solution);

#endif
