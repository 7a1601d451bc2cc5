/* SPDX-License-Identifier: MIT */
/*
 * tracks_output: tracks to a file: CSV, or where its name ends with .lcm an LCM log of RHO_TRACKS
 * messages, one list a step, at the scans' times, or where it ends with .geojson a map (geojson.h),
 * or with .ast or .asterix the same lists as a recording in ASTERIX (asterix_tracks.h).
 */
#ifndef RHOTRACK_TOOL_TRACKS_OUTPUT_H
#define RHOTRACK_TOOL_TRACKS_OUTPUT_H

#include <stdbool.h>
#include <stdint.h>

#include "rhotrack/tracker.h"
#include "settings/parameters.h"

struct tracks_output;

/*
 * path NULL: CSV to standard output. A log's tracks always have their covariance, a map's never.
 * Errors: exit 1; 2 where a map has no origin, or is asked for with covariances.
 */
struct tracks_output *tracks_output_open(const char *path, const struct parameters *parameters,
                                         bool with_covariance);

/*
 * The same, but the file is there from the start, and each step's rows once they are flushed. A map
 * is refused: exit 2.
 */
struct tracks_output *tracks_output_open_in_place(const char *path,
                                                  const struct parameters *parameters,
                                                  bool with_covariance);
void tracks_output_flush(struct tracks_output *tracks);

/* Rows of CSV have the tracks' bodies in the tracker, too. Before the first of them. */
void tracks_output_add_bodies(struct tracks_output *tracks, const struct rho_tracker *tracker);

/* All tracks of a step. */
void tracks_output_write_report(struct tracks_output *tracks, const struct rho_report *report);

/* The number and epoch of the last step in a log; a message more in it, at the step's time. */
int32_t tracks_output_step_number(const struct tracks_output *tracks);
int32_t tracks_output_epoch(void);
void tracks_output_write_message(struct tracks_output *tracks, int64_t time_us, const char *channel,
                                 const uint8_t *data, size_t size);

/* A step that has one track. */
void tracks_output_write_track(struct tracks_output *tracks, int64_t time_us,
                               const struct rho_track_report *track);

/* The file appears under its name. */
void tracks_output_close(struct tracks_output *tracks);

/* Whether an output of this name is a log. */
bool tracks_output_path_is_log(const char *path);

#endif
