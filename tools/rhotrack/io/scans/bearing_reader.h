/* SPDX-License-Identifier: MIT */
/*
 * bearing_reader: reads files of bearings as frames, merged by time. LCM logs are read as
 * log_scans.h describes, CSV files by these columns:
 * t_s,sensor_id,sensor_x_m,sensor_y_m[,sensor_z_m],bearing_rad[,elevation_rad][,sigma_rad]
 * [,sigma_elevation_rad][,sector_from_rad,sector_to_rad][,snr_db];
 * others are ignored. Bearings are counter-clockwise from +x. Rows of one sensor with the same t_s
 * (or within scan_interval_s) form one scan; with a column scan, rows of the same scan and epoch. A
 * row without a bearing is a scan without detections. Scans of different sensors within
 * frame_tolerance_s of the first form one frame, which closes when all sensors of the files have
 * reported, one of them reports again, or time has moved on.
 */
#ifndef RHOTRACK_TOOL_BEARING_READER_H
#define RHOTRACK_TOOL_BEARING_READER_H

#include <stdbool.h>

#include "io/scans/passive_sensors.h"
#include "rhotrack/types.h"
#include "settings/parameters.h"

struct bearing_reader;

struct bearing_reader_counts {
    uint64_t frames, scans, bearings;
    uint64_t frames_incomplete; /* frames without a scan of every sensor of the files */
    uint64_t rows_skipped;      /* bad rows skipped with keep_going */
};

/*
 * Whether the file's header names bearings, or the log has bearings and no plots. Also false where
 * that cannot be told: no such file, a pipe.
 */
bool bearing_reader_is_bearings(const char *path);

/*
 * Opens the files and reads them once, to know all sensors from the start;
 * bearing_reader_next reads them again. Memory does not grow with the files. Errors as
 * `rhotrack: FILE:LINE: what is wrong`, exit 2; with keep_going bad rows are skipped and counted
 * instead. A sensor that moves, two sensors at one place, and more than RHO_MAX_SENSORS are errors
 * of their rows.
 */
struct bearing_reader *bearing_reader_open(char *const *paths, int num_paths,
                                           const struct parameters *parameters, bool keep_going);

/* Exit 2 where the files have fewer than two sensors, which give no positions. */
void bearing_reader_need_two(const struct bearing_reader *reader);

/*
 * Reads the next frame, valid until the next call, or returns NULL after the last. Frames come in
 * the order of time, which is that of their first scan; a frame's scans in the order of sensor_id.
 */
const struct rho_frame *bearing_reader_next(struct bearing_reader *reader);

/*
 * Restricts reading to the last `frames` frames, and reports on standard error if frames are left
 * out.
 */
void bearing_reader_keep_last(struct bearing_reader *reader, uint64_t frames);

/* Number of frames in the files. */
uint64_t bearing_reader_num_frames(const struct bearing_reader *reader);

/* Bytes read of all files, for progress bars. */
uint64_t bearing_reader_position(const struct bearing_reader *reader);

/* The sensors of the files, *count of them in the order of sensor_id, valid until the close. */
const struct frame_sensor *bearing_reader_sensors(const struct bearing_reader *reader,
                                                  size_t *count);

/* Counts over all frames of the files, read or not. */
struct bearing_reader_counts bearing_reader_counts(const struct bearing_reader *reader);

/* Reports skipped bad rows and incomplete frames, if any, on standard error. */
void bearing_reader_report(const struct bearing_reader *reader);
void bearing_reader_close(struct bearing_reader *reader);

#endif
