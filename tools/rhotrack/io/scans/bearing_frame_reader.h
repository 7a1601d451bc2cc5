/* SPDX-License-Identifier: MIT */
/*
 * bearing_frame_reader: bearing files in, frames out, merged by time. LCM logs are read as
 * log_scans.h has it, and of CSV files columns by name:
 * t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad[,sigma_rad][,sector_from_rad,sector_to_rad]
 *     [,snr_db];
 * others are ignored. Bearings are counter-clockwise from +x. Rows of one sensor with the same t_s
 * (or within scan_interval_s) are one scan; with a column scan those of the same scan and epoch. A
 * row without a bearing is a scan that saw nothing. Scans of different sensors within
 * frame_tolerance_s of the first are one frame, which closes when all sensors of the files have
 * reported, or one of them reports again, or time has moved on.
 */
#ifndef RHOTRACK_TOOL_BEARING_FRAME_READER_H
#define RHOTRACK_TOOL_BEARING_FRAME_READER_H

#include <stdbool.h>

#include "io/scans/known_sensors.h"
#include "rhotrack/types.h"
#include "settings/parameters.h"

struct bearing_frame_reader;

struct bearing_frame_reader_counts {
    uint64_t frames, scans, bearings;
    uint64_t frames_incomplete; /* a sensor of the files is missing in them */
    uint64_t rows_skipped;      /* with keep_going */
};

/*
 * The file's header says that it holds bearings, or the log has those and no plots. False also
 * where it cannot be told: no such file, a pipe.
 */
bool bearing_frame_reader_file_has_bearings(const char *path);

/*
 * Opens the files and reads them through once, since sensors are to be known from the start;
 * bearing_frame_reader_next then reads again. Memory does not grow with the files. Errors as
 * `rhotrack: FILE:LINE: what is wrong`, exit 2; with keep_going bad rows are skipped and counted
 * instead. A sensor that moves, two in one place and more than RHO_MAX_SENSORS are errors of their
 * rows.
 */
struct bearing_frame_reader *bearing_frame_reader_open(char *const *paths, int num_paths,
                                                       const struct parameters *parameters,
                                                       bool keep_going);

/* Fewer than two sensors: exit 2. Positions come from two or more. */
void bearing_frame_reader_need_two_sensors(const struct bearing_frame_reader *reader);

/*
 * The next frame, or NULL after the last; valid until the next call. Frames come in the order of
 * time, which is their first scan's; the scans of a frame in the order of sensor_id.
 */
const struct rho_frame *bearing_frame_reader_next(struct bearing_frame_reader *reader);

/*
 * Leaves out all but the last so many frames, and says so on standard error where that leaves any
 * out.
 */
void bearing_frame_reader_keep_last(struct bearing_frame_reader *reader, uint64_t frames);

/* How many frames there are in all. */
uint64_t bearing_frame_reader_num_frames(const struct bearing_frame_reader *reader);

/* Bytes that were taken of all files (for progress bars). */
uint64_t bearing_frame_reader_position(const struct bearing_frame_reader *reader);

/* The sensors of the files in the order of sensor_id: *count of them, valid until the close. */
const struct frame_sensor *bearing_frame_reader_sensors(const struct bearing_frame_reader *reader,
                                                        size_t *count);

/* Of all frames, whether they were taken or not. */
struct bearing_frame_reader_counts
bearing_frame_reader_counts(const struct bearing_frame_reader *reader);

/* Bad rows that were skipped, and frames that miss a sensor, if any, on standard error. */
void bearing_frame_reader_report_skipped(const struct bearing_frame_reader *reader);
void bearing_frame_reader_close(struct bearing_frame_reader *reader);

#endif
