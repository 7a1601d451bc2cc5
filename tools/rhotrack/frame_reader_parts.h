/* SPDX-License-Identifier: MIT */
/* Private to frame_reader: scans while their rows are collected, and how they become frames. */
#ifndef RHOTRACK_TOOL_FRAME_READER_PARTS_H
#define RHOTRACK_TOOL_FRAME_READER_PARTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "frame_reader.h"
#include "row_check.h"
#include "scan_numbers.h"

#define NO_ENTRY SIZE_MAX

/* A scan while its rows are collected. */
struct frame_entry {
    struct rho_bearing_scan scan;
    struct row_number number;
    const char *path; /* of its first row, as are */
    uint32_t line;
    int64_t start_us;
    size_t order; /* over all files */
    size_t first_bearing;
    bool has_time; /* scan.time_us is settled, by a row that saw nothing; else it is start_us */
};

/* A bearing and the scan that it belongs to. */
struct frame_member {
    size_t entry;
    int64_t time_us; /* of its row */
    struct rho_bearing bearing;
};

/* A sensor, where it was first named, and its newest scan in this file. */
struct known_sensor {
    struct frame_sensor sensor;
    const char *path;
    uint32_t line;
    size_t open; /* or NO_ENTRY */
};

struct frame_reader {
    const struct parameters *parameters;
    bool keep_going;
    int64_t interval_us, tolerance_us;
    struct known_sensor known[RHO_MAX_SENSORS];
    struct frame_sensor sensors[RHO_MAX_SENSORS]; /* the same, sorted */
    size_t num_sensors;
    struct scan_numbers numbers; /* of this file */
    struct frame_entry *entries;
    size_t num_entries, entries_capacity;
    struct frame_member *members;
    size_t num_members, members_capacity;
    struct rho_bearing *bearings;   /* all, scan by scan */
    struct rho_bearing_scan *scans; /* all, frame by frame */
    struct rho_frame *frames;
    size_t num_frames, next;
    uint64_t frames_incomplete, rows_skipped;
};

/* Places the bearings scan by scan, in the order of their rows. */
void frame_reader_place_bearings(struct frame_reader *reader);

/* Sorts the scans by time, leaves out or refuses what is there twice, and makes frames of them. */
void frame_reader_make_frames(struct frame_reader *reader);

#endif
