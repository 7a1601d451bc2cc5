/* SPDX-License-Identifier: MIT */
/*
 * Private to asterix_scans: state of one radar: its antenna, and the plots of scans under way.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_RADAR_H
#define RHOTRACK_TOOL_ASTERIX_RADAR_H

#include "io/asterix/asterix_scans.h"

struct asterix_scan_plots {
    struct asterix_scan_plot *list;
    size_t count, capacity;
};

/* A scan being filled with plots. Without a look, look holds only its start and end times. */
struct asterix_open_scan {
    bool has_look;
    struct asterix_look look;
    struct asterix_scan_plots marks;
};

/* State of one radar. Initialised with zeros and the sensor number. */
struct asterix_radar {
    int32_t sensor_id;
    bool has_crossings; /* the radar reports antenna crossings */
    bool is_known;      /* has_crossings is final: the file was previewed, or wait_s is over */
    struct asterix_place place;
    bool has_clock;
    int64_t first_128, clock_128; /* first and latest time of the radar */
    int64_t seen_128;             /* latest time of all radars when this one was heard last */
    bool has_suspect;
    int64_t suspect_128; /* a jump in time, not confirmed yet */
    struct asterix_antenna antenna;
    struct asterix_open_scan *open; /* open looks, in the order of their start times */
    size_t num_open, open_capacity;
    bool has_settled, has_closed; /* has_closed: a first look was completed */
    /* time before which no more plots are accepted; it never goes back */
    int64_t settled_128;
    bool has_turn;
    struct asterix_open_scan turn;     /* complete looks that form no whole turn yet */
    struct asterix_scan_plots waiting; /* plots that no known look has passed yet */
    int32_t scan;                      /* number of the newest scan */
};

/*
 * Converts a time of day to a time that continues over midnight. Returns false for a jump in time.
 * reference: a time near the first one; NULL: the first day.
 */
bool asterix_radar_unwrap_time(struct asterix_radar *sensor, uint32_t time_of_day_128,
                               const int64_t *reference_128, int64_t *time_128);

/* Time before which further plots of the radar count as late. It never goes back. */
int64_t asterix_radar_settled_time(struct asterix_radar *sensor, int64_t hold_128);

/*
 * Processes an antenna crossing: may end a look, into which waiting plots then go. Returns false
 * where it is older than the newest crossing, or too late.
 */
bool asterix_radar_end_look(struct asterix_radar *sensor, int64_t time_128, uint16_t azimuth,
                            int64_t hold_128, struct asterix_counts *counts);

/* Adds a plot to the look that passed it, or keeps it until there is one. */
void asterix_radar_place_plot(struct asterix_radar *sensor, const struct asterix_scan_plot *mark,
                              int64_t hold_128);

/*
 * Adds a plot of a radar without crossings to a scan of interval_128, or as a scan of its own where
 * that is 0.
 */
void asterix_radar_add_timed_plot(struct asterix_radar *sensor,
                                  const struct asterix_scan_plot *mark, int64_t interval_128);

/* Drops and counts waiting plots: all, or those that waited longer than any turn takes. */
void asterix_radar_drop_waiting(struct asterix_radar *sensor, bool all,
                                struct asterix_counts *counts);

/* Closes the look since the newest crossing, at the end of input, if plots wait for it. */
void asterix_radar_end_last_look(struct asterix_radar *sensor, int64_t hold_128);

/* Removes and returns the oldest open scan; its plots then belong to the caller. */
struct asterix_open_scan asterix_radar_take_scan(struct asterix_radar *sensor);

/*
 * Adds a complete look to the radar's turn. Returns false, and changes nothing, where the look does
 * not begin where the turn ends.
 */
bool asterix_radar_extend_turn(struct asterix_radar *sensor, struct asterix_open_scan *open);

/*
 * Keeps heights and Doppler speeds only where all plots of a scan have them; else heights convert
 * slant ranges to ground ranges.
 */
void asterix_keep_common_quantities(struct asterix_scan_plots *marks,
                                    const struct asterix_place *place,
                                    struct asterix_counts *counts);

void asterix_radar_free(struct asterix_radar *sensor);

#endif
