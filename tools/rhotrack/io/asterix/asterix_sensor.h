/* SPDX-License-Identifier: MIT */
/* Private to asterix_scans: one radar, its antenna, and its plots that are no complete scan yet. */
#ifndef RHOTRACK_TOOL_ASTERIX_SENSOR_H
#define RHOTRACK_TOOL_ASTERIX_SENSOR_H

#include "io/asterix/asterix_scans.h"

struct asterix_marks {
    struct asterix_mark *list;
    size_t count, capacity;
};

/* A scan on its way. The look's start is there in any case. */
struct asterix_open_scan {
    bool has_look;
    struct asterix_look look;
    struct asterix_marks marks;
};

/* Starts as zeros, and the number. */
struct asterix_sensor {
    int32_t sensor_id;
    bool has_crossings; /* it tells them */
    bool is_known;      /* whether it does was looked at, or waited for */
    struct asterix_place place;
    bool has_clock;
    int64_t first_128, clock_128; /* its first time, and its latest */
    int64_t seen_128;             /* the latest of all radars when it was heard last */
    bool has_suspect;
    int64_t suspect_128; /* a time that jumped */
    struct asterix_antenna antenna;
    struct asterix_open_scan *open; /* by their starts */
    size_t num_open, open_capacity;
    bool has_settled, has_closed; /* closed: a look was complete */
    int64_t settled_128;          /* nothing comes before it */
    bool has_turn;
    struct asterix_open_scan turn; /* complete looks that are no whole turn yet */
    struct asterix_marks waiting;  /* no look is known yet that saw them */
    int32_t scan;                  /* number of the newest one */
};

/*
 * Time of day as a time that goes on at midnight, or false: a jump. reference: where the radar has
 * no time yet.
 */
bool asterix_sensor_unwrap_time(struct asterix_sensor *sensor, uint32_t time_of_day_128,
                                const int64_t *reference_128, int64_t *time_128);

/* Nothing of the sensor that comes is before this time, but what is late. It never goes back. */
int64_t asterix_sensor_settled_time(struct asterix_sensor *sensor, int64_t hold_128);

/* The antenna crosses an azimuth. Returns false where that is before the newest crossing. */
bool asterix_sensor_cross_azimuth(struct asterix_sensor *sensor, int64_t time_128, uint16_t azimuth,
                                  int64_t hold_128, struct asterix_counts *counts);

/* A plot: into a look that saw it, or kept until there is one. */
void asterix_sensor_add_plot(struct asterix_sensor *sensor, const struct asterix_mark *mark,
                             int64_t hold_128);

/*
 * A plot of a radar without crossings: into a scan of interval_128, or of its own where that is 0.
 */
void asterix_sensor_add_plot_by_time(struct asterix_sensor *sensor, const struct asterix_mark *mark,
                                     int64_t interval_128);

/* Plots that waited for a look in vain, if it is over, are given up. */
void asterix_sensor_drop_waiting(struct asterix_sensor *sensor, bool all,
                                 struct asterix_counts *counts);

/* Plots since the newest north crossing become a scan. */
void asterix_sensor_end_last_look(struct asterix_sensor *sensor, int64_t hold_128);

/* The first open scan, which is taken out: its marks are the caller's. */
struct asterix_open_scan asterix_sensor_take_scan(struct asterix_sensor *sensor);

/*
 * A complete look after those of the turn: false, and nothing is changed, where it does not go on
 * where they end.
 */
bool asterix_sensor_extend_turn(struct asterix_sensor *sensor, struct asterix_open_scan *open);

/*
 * Heights and speeds count where all plots of a scan have them; else heights make ground ranges of
 * slant ranges.
 */
void asterix_marks_all_or_none(struct asterix_marks *marks, const struct asterix_place *place,
                               struct asterix_counts *counts);

void asterix_marks_add(struct asterix_marks *marks, const struct asterix_mark *mark);
void asterix_sensor_free(struct asterix_sensor *sensor);

#endif
