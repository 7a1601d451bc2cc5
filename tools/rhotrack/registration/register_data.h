/* SPDX-License-Identifier: MIT */
/* register_data: what the parts of register share. */
#ifndef RHOTRACK_TOOL_REGISTER_DATA_H
#define RHOTRACK_TOOL_REGISTER_DATA_H

#include "registration/register.h"

/* Indices of radars, plots and tracks are those of the arrays below. */
struct radar_plot {
    int64_t time_us;
    double range_m, azimuth_rad; /* as the radar sees it, the configured biases taken off */
    double sigma_range_m, sigma_cross_m;
    struct rho_plot plot;
};

struct radar_scan {
    int64_t time_us;
    uint32_t measures;
    double from_rad, to_rad;
    size_t first, count; /* plots */
};

/* A confirmed track of one radar alone: its plots in the order of time. */
struct radar_track {
    size_t radar;
    size_t count, capacity;
    size_t *plots;
    size_t earlier; /* plots that it was started with, before the first of these */
    size_t target;  /* the tracks of one target have the same */
};

struct radar_data {
    struct rho_sensor sensor;
    size_t num_scans, scans_room, num_plots, plots_room;
    struct radar_scan *scans;
    struct radar_plot *plots;
    double bias[NUM_REGISTER_KINDS]; /* what is left of them, as estimated so far */
};

struct register_data {
    const struct parameters *parameters;
    int64_t start_us; /* times are taken from here */
    size_t num_radars, radars_room;
    struct radar_data *radars;
    size_t num_tracks, tracks_room;
    struct radar_track *tracks;
};

/* As register_add_scan, of any plots. */
void register_add_any_scan(struct register_data *data, const struct rho_scan *scan,
                           const struct rho_sensor *sensor);

/* Where and when a plot was, with the biases as estimated so far. */
struct corrected {
    double t_s, x_m, y_m;
    double cos_azimuth, sin_azimuth, range_m;
};
struct corrected register_correct_plot(const struct register_data *data,
                                       const struct radar_data *radar,
                                       const struct radar_plot *plot);

/* Scans by time, sectors put together to turns; then every radar's tracks. register_tracks.c */
void register_track_all_radars(struct register_data *data, struct pipeline *pipeline);
void register_track_one_radar(struct register_data *data, size_t number, struct pipeline *pipeline);

/* One past the last scan of the turn that begins with `first`. register_tracks.c */
size_t register_turn_end(const struct radar_data *radar, size_t first);

/*
 * Which tracks are one target, by the biases as estimated so far: their number `target`. gate_m:
 * rms distance of two tracks. misfit: they are to be together by their noise, too, which is so much
 * of what their sigmas say; 0: they need not be. True where anything changed. register_match.c
 */
bool register_match_tracks(struct register_data *data, double gate_m, double misfit);

/* Targets that several radars have tracks of. */
size_t register_num_common_targets(const struct register_data *data);

/* The result of the least squares. register_solve.c */
struct solution {
    size_t segments, segments_left_out, plots;
    double misfit, speed_mps;
    size_t *radar_plots; /* of each radar */
    double *sigma;       /* of each radar's NUM_REGISTER_KINDS biases */
};
/* Changes the radars' biases. The reference's time stays. */
struct solution register_solve_biases(struct register_data *data, size_t reference);
void solution_free(struct solution *solution);

#endif
