/* SPDX-License-Identifier: MIT */
/*
 * program: what Python has of the program: its parameters, its readers and its pipeline. All that
 * the package needs of tools/rhotrack is in program.c; native.py reads this file too.
 *
 * A call that fails returns NULL or false, and program_failure tells why. Memory is given back with
 * program_..._free. Objects are not for two threads at a time.
 */
#ifndef RHOTRACK_PYTHON_PROGRAM_H
#define RHOTRACK_PYTHON_PROGRAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "rhotrack/rhotrack.h"

/* The message of this thread's last failure. True: a fault of what was given (exit code 2). */
const char *program_failure(bool *is_usage);

/* ---- Settings ---- */

struct parameters;
struct program_parameter {
    const char *name, *unit, *text;
    double min, max;
    bool is_number;
    char initial[32], value[32], range[48]; /* as text; empty: unset */
};

/* A copy, or the defaults (NULL). */
struct parameters *program_settings(const struct parameters *from);
void program_settings_free(struct parameters *settings);
bool program_settings_set(struct parameters *settings, const char *key, const char *value);
bool program_settings_load(struct parameters *settings, const char *path);

/* What only holds together is so. */
bool program_settings_check(const struct parameters *settings);

/* The parameter of this number, from 0; false: there are fewer. */
bool program_settings_at(const struct parameters *settings, int index,
                         struct program_parameter *parameter);

/* ---- Scans ---- */

/* A plot or a bearing, by its columns. NaN: not said. */
struct program_row {
    double t_s;
    int32_t sensor_id;
    float x_m, y_m, z_m, vx_mps, vy_mps, vz_mps;
    float range_m, azimuth_rad, elevation_rad, range_rate_mps, bearing_rad;
    float sigma_m, sigma_mps, sigma_range_m, sigma_cross_m, sigma_up_m;
    float sigma_azimuth_rad, sigma_elevation_rad, sigma_range_rate_mps, sigma_rad, snr_db;
    float sector_from_rad, sector_to_rad, sensor_x_m, sensor_y_m, sensor_z_m;
};

/* A scan of plots, or a frame of bearings. */
struct program_scan {
    bool is_frame, has_sensor;
    struct rho_scan scan;
    struct rho_sensor sensor;
    struct rho_frame frame;
};
struct program_scans {
    struct program_scan *list;
    size_t count, capacity;
};

/* All scans of files, as `track` takes them. */
struct program_scans *program_read(char *const *paths, int num_paths,
                                   const struct parameters *settings, bool keep_going);

/* Scans of rows: counts[i] rows of each, which are bearings where are_frames[i]. */
struct program_scans *program_scans(const struct program_row *rows, const uint32_t *counts,
                                    const bool *are_frames, size_t count,
                                    const struct parameters *settings);
void program_scans_free(struct program_scans *scans);

/* How many rows a scan has, and the rows. */
uint32_t program_scan_num_rows(const struct program_scan *scan);
void program_scan_rows(const struct program_scan *scan, struct program_row *rows);

/* ---- Tables of truth and tracks ---- */

struct program_table {
    int num_columns; /* all but the first one, t_s */
    size_t num_rows;
    const char *const *names; /* the program's */
    double *t_s, *cells;      /* num_rows; num_rows x num_columns, NaN where one is empty */
};

/* What a file holds by its columns: "truth", "tracks", or else "scans". */
const char *program_kind(const char *path);
/* kind: "truth" or "tracks". */
struct program_table *program_table(const char *path, const char *kind,
                                    const struct parameters *settings, bool keep_going);
void program_table_free(struct program_table *table);

/* ---- The tracker ---- */

/* A row of the tracks file, but for its covariance. */
struct program_track {
    double t_s;
    uint32_t track_id;
    uint32_t status[9]; /* UTF-32 */
    float x_m, y_m, z_m, vx_mps, vy_mps, vz_mps;
    float ax_mps2, ay_mps2, az_mps2, sigma_m, sigma_mps;
    uint16_t hits, misses;
    int32_t sensor_id, plot, update_age_us;
    float score_nat, maneuver_probability;
};
struct program_tracks {
    struct program_track *list;
    float (*covariances)[RHO_TRIANGLE(RHO_KALMAN_STATES)]; /* NULL: not wanted */
    struct rho_body *bodies; /* NULL: targets are points; NaN: none of this track */
    size_t count, capacity;
    bool has_covariances, has_bodies;
};

void program_tracks_free(struct program_tracks *tracks);

struct program_pipeline {
    struct pipeline *pipeline;
    struct parameters *settings;
    bool is_open;
    struct rho_tracker *tracker;                   /* in memory of the pipeline, as */
    const struct rho_report *report;               /* of the last step */
    const struct rho_reflector_learning *learning; /* NULL: walls are not learned */
    uint16_t min_scans;           /* M of the initiator of the newest plots; 0: none yet */
    struct program_tracks tracks; /* of the last program_pipeline_run */
};

struct program_pipeline *program_pipeline(const struct parameters *settings, bool has_covariances);
void program_pipeline_free(struct program_pipeline *pipeline);

/* Steps all scans; with collects_tracks all their tracks are in pipeline->tracks. */
bool program_pipeline_run(struct program_pipeline *pipeline, const struct program_scans *scans,
                          bool collects_tracks);

/* ---- Tracks alone, each with scans of its own, as `maintain` steps one ---- */

struct program_maintainers {
    size_t count;
    uint64_t *refused;            /* of each: updates that were refused */
    uint32_t *hypotheses;         /* of each */
    struct program_tracks tracks; /* of the last call, of those that have started */
    struct program_maintainer *list;
};

struct program_maintainers *program_maintainers(const struct parameters *settings, size_t count,
                                                bool has_input_estimation, uint64_t seed,
                                                bool has_covariances);
void program_maintainers_free(struct program_maintainers *maintainers);

/* Moves all to a time. places_m, 3 each: where a beam should look; NaN: has not started. */
bool program_maintainers_predict(struct program_maintainers *maintainers, double t_s,
                                 double *places_m);

/*
 * Scans of the first track, the second, ... in turn. log_densities: of each scan; NULL: estimated.
 */
bool program_maintainers_run(struct program_maintainers *maintainers,
                             const struct program_scans *scans, const double *log_densities);

/* ---- Initiation: the configs of its methods, by name ---- */

bool program_initiator_config(const struct parameters *settings,
                              struct rho_initiator_config *config);
bool program_hough_config(const struct parameters *settings, const char *method, double range_m,
                          struct rho_hough_config *config);
bool program_passive_config(const struct parameters *settings, struct rho_passive_config *config);
bool program_passive_paper_config(const struct parameters *settings,
                                  struct rho_passive_paper_config *config);

/* ---- The node ---- */

struct program_node;
typedef void program_send(void *context, const char *channel, const uint8_t *data, size_t size);

/* send is called from within program_node_take, and must not call the node. */
struct program_node *program_node(const struct parameters *settings, int32_t epoch,
                                  program_send *send, void *context);
void program_node_free(struct program_node *node);

/* Takes a message, or without a channel steps what is due; at INT64_MAX all that is there. */
bool program_node_take(struct program_node *node, const char *channel, const uint8_t *data,
                       size_t size, int64_t now_us);

/* The node's own messages of its state; what is due next. */
bool program_node_status(struct program_node *node);
int64_t program_node_due_us(const struct program_node *node);

/* The tracks of its last step. */
bool program_node_tracks(struct program_node *node, struct program_tracks *tracks);

#endif
