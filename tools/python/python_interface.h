/* SPDX-License-Identifier: MIT */
/*
 * python_interface: the interface of the Python package to the command-line program:
 * parameters, readers and the pipeline. python_interface.c contains all calls of
 * tools/rhotrack; generate_cffi_binding.py reads this header, too.
 *
 * A call that fails returns NULL or false, and program_last_failure gives the reason. Memory is
 * released with program_..._free. An object must not be used by two threads at a time.
 */
#ifndef RHOTRACK_PYTHON_READERS_AND_PIPELINE_FOR_PYTHON_H
#define RHOTRACK_PYTHON_READERS_AND_PIPELINE_FOR_PYTHON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "rhotrack/rhotrack.h"

/* The message of this thread's last failure; *is_usage: the caller's input was at fault. */
const char *program_last_failure(bool *is_usage);

/* ---- Settings ---- */

struct parameters;
struct program_parameter {
    const char *name, *unit, *text;
    double min, max;
    bool is_number;
    char initial[32], value[32], range[48]; /* as text; initial is the default; empty: unset */
};

/* A copy of the settings, or the defaults for NULL. */
struct parameters *program_settings_new(const struct parameters *from);
void program_settings_free(struct parameters *settings);
bool program_settings_set(struct parameters *settings, const char *key, const char *value);
bool program_settings_load(struct parameters *settings, const char *path);

/* False if values contradict each other, as a lower limit above its upper limit. */
bool program_settings_check(const struct parameters *settings);

/* Describes the parameter of this index, from 0; false if there are fewer. */
bool program_settings_get_parameter(const struct parameters *settings, int index,
                                    struct program_parameter *parameter);

/* ---- Scans ---- */

/* A plot or a bearing, with a field for each column; NaN: not given. */
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

/* Reads all scans of the files as the command `track` does. */
struct program_scans *program_read_scans(char *const *paths, int num_paths,
                                         const struct parameters *settings, bool keep_going);

/* Makes scans of rows: counts[i] rows for scan i, which are bearings if are_frames[i]. */
struct program_scans *program_scans_from_rows(const struct program_row *rows,
                                              const uint32_t *counts, const bool *are_frames,
                                              size_t count, const struct parameters *settings);
void program_scans_free(struct program_scans *scans);

/* The number of rows of a scan, and the rows, written to an array of this length. */
uint32_t program_scan_num_rows(const struct program_scan *scan);
void program_scan_write_rows(const struct program_scan *scan, struct program_row *rows);

/* ---- Tables of truth and tracks ---- */

struct program_table {
    int num_columns; /* without the first column, t_s */
    size_t num_rows;
    const char *const *names; /* of the columns */
    double *t_s, *cells;      /* num_rows; num_rows x num_columns, NaN: empty */
};

/* The kind of a file by its columns: "truth", "tracks", or else "scans". */
const char *program_kind_of_file(const char *path);
/* Reads a table of the kind "truth" or "tracks". */
struct program_table *program_read_table(const char *path, const char *kind,
                                         const struct parameters *settings, bool keep_going);
void program_table_free(struct program_table *table);

/* ---- The tracker ---- */

/* A row of the tracks file without the covariance. */
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
    struct rho_body *bodies; /* NULL: not estimated; NaN: unknown for this track */
    size_t count, capacity;
    bool has_covariances, has_bodies;
};

void program_tracks_free(struct program_tracks *tracks);

struct program_pipeline {
    struct pipeline *pipeline;
    struct parameters *settings;
    bool is_open;
    struct rho_tracker *tracker;                   /* owned by the pipeline */
    const struct rho_report *report;               /* of the last step; owned by the pipeline */
    const struct rho_reflector_learning *learning; /* NULL: walls are not learned */
    uint16_t min_scans;           /* M of the initiator of the last scan of plots; 0: none yet */
    struct program_tracks tracks; /* of the last program_pipeline_run */
};

struct program_pipeline *program_pipeline_new(const struct parameters *settings,
                                              bool has_covariances);
void program_pipeline_free(struct program_pipeline *pipeline);

/* Steps all scans; with collects_tracks the tracks of all steps go to pipeline->tracks. */
bool program_pipeline_run(struct program_pipeline *pipeline, const struct program_scans *scans,
                          bool collects_tracks);

/* ---- Single tracks, each with scans of its own, as in the command `maintain` ---- */

struct program_maintainers {
    size_t count;
    uint64_t *refused;            /* for each track: number of refused updates */
    uint32_t *hypotheses;         /* for each track: number of hypotheses */
    struct program_tracks tracks; /* the started tracks after the last call */
    struct program_maintainer *list;
};

struct program_maintainers *program_maintainers_new(const struct parameters *settings, size_t count,
                                                    bool has_input_estimation, uint64_t seed,
                                                    bool has_covariances);
void program_maintainers_free(struct program_maintainers *maintainers);

/* Predicts all tracks to a time; places_m gets 3 coordinates each, NaN if not started. */
bool program_maintainers_predict(struct program_maintainers *maintainers, double t_s,
                                 double *places_m);

/*
 * Steps tracks by scans: scan i is for track i modulo count. log_densities is the log of each
 * scan's clutter density; NULL: it is estimated.
 */
bool program_maintainers_run(struct program_maintainers *maintainers,
                             const struct program_scans *scans, const double *log_densities);

/* ---- Initiation: configurations of its methods ---- */

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

/* Opens a node; its messages go to send, which runs within calls and must not call the node. */
struct program_node *program_node_new(const struct parameters *settings, int32_t epoch,
                                      program_send *send, void *context);
void program_node_free(struct program_node *node);

/* Takes a message or, if channel is NULL, steps all due input; at INT64_MAX all held input. */
bool program_node_take_or_step(struct program_node *node, const char *channel, const uint8_t *data,
                               size_t size, int64_t now_us);

/* Sends the messages of the node's state; the time at which it next has to step. */
bool program_node_send_status(struct program_node *node);
int64_t program_node_due_us(const struct program_node *node);

/* Replaces `tracks` by the tracks of the last step. */
bool program_node_get_tracks(struct program_node *node, struct program_tracks *tracks);

#endif
