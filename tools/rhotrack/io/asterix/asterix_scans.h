/* SPDX-License-Identifier: MIT */
/*
 * asterix_scans: forms scans from the ASTERIX plots and service messages of radars.
 *
 * A radar that reports its antenna's crossings (CAT034, CAT002: north markers, sectors) has a look
 * between each two of them: a sector, or a whole turn, with plots or without. A plot belongs to the
 * look that passed its azimuth nearest to its time, whatever order the messages come in; a look is
 * complete hold_s after its end. Looks before the first crossing are made as wide as the first one,
 * at most a turn back. Each look is a scan, or all looks of a turn are one. Radars without
 * crossings have plots alone.
 *
 * Times of day become seconds since the midnight before the first record: a time of day that is
 * half a day or more before the newest belongs to the next day. A time more than a minute off is
 * accepted only when the next one confirms it.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_SCANS_H
#define RHOTRACK_TOOL_ASTERIX_SCANS_H

#include "io/asterix/asterix_antenna.h"
#include "io/asterix/asterix_codec.h"

struct asterix_scan_plot {
    int64_t time_128; /* 1/128 s since the midnight before the first record */
    uint32_t range;
    uint16_t azimuth;
    bool has_alt, has_doppler;
    int16_t alt;    /* in ASTERIX_HEIGHT_M: height by a 3-D radar, else the flight level */
    bool is_ground; /* ground_m replaces range: it was computed from slant range and height */
    double ground_m;
    int16_t doppler_mps; /* as in I048/120 */
};

struct asterix_scan {
    int32_t sensor_id;
    bool is_numbered; /* false: a single plot of a radar without crossings */
    int32_t number;   /* the radar's scan number, from 1 */
    bool is_turn;     /* a whole turn, or the antenna's sector is not known */
    struct asterix_look look;
    int64_t time_128; /* start of the scan */
    struct asterix_place place;
    /* plots by time, valid until the next call; either all or none have has_alt, has_doppler */
    const struct asterix_scan_plot *marks;
    size_t count;
};

/* Counts of records by outcome; those of plots add up to `plots`. */
struct asterix_counts {
    uint64_t plots, services; /* records of plots and of antenna messages */
    uint64_t placed;          /* plots in a scan */
    uint64_t not_real;        /* plots simulated, of test targets, or of field monitors */
    uint64_t no_detection;    /* reports of a radar's own predicted track */
    /* plots without source, time or position; or with a range of 0, or beyond item 040 */
    uint64_t incomplete;
    /* plots with a time of day beyond 24 h, or a jump in time that nothing confirms */
    uint64_t bad_times;
    uint64_t late;     /* plots after their scan was complete */
    uint64_t unplaced; /* plots that no known look of the antenna passed */
    uint64_t no_room;  /* plots of radars beyond ASTERIX_MAX_SENSORS */
    /* antenna messages without source, type or time, or with a time that goes back */
    uint64_t services_left;
    uint64_t services_other; /* messages of other types than north marker and sector crossing */
    uint64_t gaps;           /* gaps in the looks, where crossings are missing */
    /* plots in scans without their flight level: not validated, or garbled */
    uint64_t levels_bad;
    uint64_t dopplers_bad;  /* plots in scans without their Doppler speed: doubtful */
    uint64_t dopplers_raw;  /* plots in scans without a Doppler speed: only ambiguous raw ones */
    uint64_t dopplers_left; /* Doppler speeds dropped, since other plots of the scan have none */
    /* heights used for ground ranges alone, since other plots of the scan have none */
    uint64_t levels_left;
};

#define ASTERIX_MAX_SENSORS 256

struct asterix_scans;

struct asterix_rules {
    double hold_s;     /* how long after the end of a look its plots may arrive */
    bool is_by_turn;   /* all looks of a turn form one scan; else each look is one */
    double interval_s; /* duration of scans of radars without crossings; 0: each plot is a scan */
    double wait_s;     /* a radar without crossings for this time is taken to report none */
};
struct asterix_scans *asterix_scans_open(const struct asterix_rules *rules);
void asterix_scans_close(struct asterix_scans *scans);

/*
 * Notes a record's radar, its place, and whether it reports crossings, without processing its
 * plots. Radars that were previewed are not waited for.
 */
void asterix_scans_preview_record(struct asterix_scans *scans, const struct asterix_record *record);

/*
 * The radars known so far: their number; and for one of them its sensor number (set) and whether it
 * stated its place (returned).
 */
size_t asterix_scans_num_sensors(const struct asterix_scans *scans);
bool asterix_scans_sensor_has_place(const struct asterix_scans *scans, size_t index,
                                    int32_t *sensor_id);

/*
 * Sets a reference time: the first record's time of day is taken on the day that is nearest to it.
 * Without, times start on the first day.
 */
void asterix_scans_set_day(struct asterix_scans *scans, int64_t time_128);

/* Processes a record of plots or an antenna message of a radar. */
void asterix_scans_take_record(struct asterix_scans *scans, const struct asterix_record *record);

/* Ends the input: all open looks become scans. */
void asterix_scans_finish(struct asterix_scans *scans);

/*
 * Takes the next complete scan. Returns false where none is complete yet. Scans of one radar come
 * in the order of time.
 */
bool asterix_scans_next(struct asterix_scans *scans, struct asterix_scan *scan);

/* Time before which no more scans or plots can come. INT64_MAX at the end. */
int64_t asterix_scans_settled_time_128(const struct asterix_scans *scans);

const struct asterix_counts *asterix_scans_counts(const struct asterix_scans *scans);

/* Converts 1/128 s to microseconds, rounded to the nearest. */
int64_t asterix_time_us(int64_t time_128);

#endif
