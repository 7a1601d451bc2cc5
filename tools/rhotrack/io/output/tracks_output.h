/* SPDX-License-Identifier: MIT */
/*
 * tracks_output: writes tracks to a file: CSV; where its name ends with .lcm an LCM log of
 * RHO_TRACKS messages, one list for each step, at the scans' times; with .geojson GeoJSON
 * (geojson_tracks_writer.h); with .ast or .asterix an ASTERIX recording of the same lists
 * (asterix_track_writer.h).
 */
#ifndef RHOTRACK_TOOL_TRACKS_OUTPUT_H
#define RHOTRACK_TOOL_TRACKS_OUTPUT_H

#include <stdbool.h>
#include <stdint.h>

#include "rhotrack/tracker.h"
#include "settings/parameters.h"

struct tracks_output;

/*
 * Opens the output. path NULL: CSV to standard output. A log's tracks always have their covariance,
 * GeoJSON never. Errors: exit 1; 2 where GeoJSON has no origin, or covariances are requested of it
 * or of ASTERIX.
 */
struct tracks_output *tracks_output_open(const char *path, const struct parameters *parameters,
                                         bool with_covariance);

/*
 * Opens an output whose file exists from the start, and has each step's rows once they are flushed.
 * GeoJSON is refused: exit 2.
 */
struct tracks_output *tracks_output_open_in_place(const char *path,
                                                  const struct parameters *parameters,
                                                  bool with_covariance);
void tracks_output_flush(struct tracks_output *tracks);

/*
 * Adds columns of the tracks' bodies in the tracker to CSV, and body lists to a log. To be called
 * before the first row.
 */
void tracks_output_add_body_columns(struct tracks_output *tracks,
                                    const struct rho_tracker *tracker);

/* Writes all tracks of a step. */
void tracks_output_write_report(struct tracks_output *tracks, const struct rho_report *report);

/* For logs: number and epoch of the last step, and writing a further message at a step's time. */
int32_t tracks_output_step_number(const struct tracks_output *tracks);
int32_t tracks_output_epoch(void);
void tracks_output_log_message(struct tracks_output *tracks, int64_t time_us, const char *channel,
                               const uint8_t *data, size_t size);

/* Writes a step with a single track. */
void tracks_output_write_track(struct tracks_output *tracks, int64_t time_us,
                               const struct rho_track_report *track);

/* Closes the output; the file then appears under its name. */
void tracks_output_close(struct tracks_output *tracks);

/* Whether an output of this name is an LCM log. */
bool tracks_output_path_is_log(const char *path);

#endif
