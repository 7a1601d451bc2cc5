/* SPDX-License-Identifier: MIT */
/*
 * asterix_scans: what radars say in ASTERIX, put together to scans.
 *
 * A radar that tells its antenna's crossings (CAT034, CAT002: north markers, sectors) has a look
 * from each to the next: a sector, or a whole turn, with plots or without. A plot belongs to the
 * look that saw its azimuth nearest to its time, whatever order the messages come in; a look is
 * complete hold_s after its end. Plots before the first crossing have looks as wide as the first,
 * at most a turn back. Each look is a scan, or all looks of a turn are one. Radars without
 * crossings have plots alone.
 *
 * Times of day become seconds since the midnight before the first record: a time half a day or more
 * before the one before is of the next day. A time more than a minute off is believed only when the
 * next one is like it.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_SCANS_H
#define RHOTRACK_TOOL_ASTERIX_SCANS_H

#include "io/asterix/asterix.h"
#include "io/asterix/asterix_antenna.h"

struct asterix_mark {
    int64_t time_128; /* since the midnight before the first record */
    uint32_t range;
    uint16_t azimuth;
    bool has_alt, has_doppler;
    int16_t alt; /* in ASTERIX_HEIGHT_M: of a 3-D radar, else the flight level */
    bool
        is_ground; /* the height made a ground range of the slant range, and does not count else: */
    double ground_m;
    int16_t doppler_mps; /* as I048/120 has it */
};

struct asterix_scan {
    int32_t sensor_id;
    bool is_numbered; /* else: a plot of a radar without crossings */
    int32_t number;   /* of the sensor, from 1 */
    bool is_turn;     /* a whole one, or it is not known where the antenna looked */
    struct asterix_look look;
    int64_t time_128; /* its start */
    struct asterix_place place;
    const struct asterix_mark
        *marks; /* by time; valid until the next call. has_alt, has_doppler: all or none */
    size_t count;
};

/* Counts of the records' fates; those of plots add up to `plots`. */
struct asterix_counts {
    uint64_t plots, services; /* records of both kinds */
    uint64_t placed;          /* plots: in a scan */
    uint64_t not_real;        /* simulated, test targets, field monitors */
    uint64_t no_detection;    /* a radar's own track, predicted */
    uint64_t
        /* without source, time or position; or a range of 0, or beyond what 040 can say */
        incomplete;
    uint64_t bad_times;      /* of day beyond 24 h, or a jump that nothing confirms */
    uint64_t late;           /* their scan was complete */
    uint64_t unplaced;       /* no look of the antenna is known that saw them */
    uint64_t no_room;        /* more than ASTERIX_MAX_SENSORS radars */
    uint64_t services_left;  /* without source, type or time; a time or place that goes back */
    uint64_t services_other; /* of other types than north marker and sector crossing */
    uint64_t gaps;           /* looks that are not known: crossings are missing */
    uint64_t levels_bad;     /* of plots that stay: flight levels not validated, or garbled */
    uint64_t dopplers_bad;   /* doubtful ones */
    uint64_t dopplers_raw;   /* ambiguous ones */
    uint64_t dopplers_left;  /* the scan has plots without */
    uint64_t levels_left;    /* the same of heights: they count for the range alone */
};

#define ASTERIX_MAX_SENSORS 256

struct asterix_scans;

struct asterix_rules {
    double hold_s;   /* how long the plots of a look may come after its end */
    bool is_by_turn; /* a scan is a turn, else a look */
    double
        /* plots of a radar without crossings are one scan; 0: each is one without a number */
        interval_s;
    double wait_s; /* a radar that told no crossings for so long has none */
};
struct asterix_scans *asterix_scans_open(const struct asterix_rules *rules);
void asterix_scans_close(struct asterix_scans *scans);

/*
 * Looks at a record without taking it: which radars tell crossings, and where they stand, is known
 * from then on. A radar that was looked at is not waited for.
 */
void asterix_scans_preview_record(struct asterix_scans *scans, const struct asterix_record *record);

/*
 * The radars that are known: how many, and of each its number and whether it said where it stands.
 */
size_t asterix_scans_num_sensors(const struct asterix_scans *scans);
bool asterix_scans_sensor_at(const struct asterix_scans *scans, size_t index, int32_t *sensor_id);

/*
 * The first record's time is the one of its time of day that is nearest to this one; without, of
 * the first day.
 */
void asterix_scans_start_near(struct asterix_scans *scans, int64_t time_128);

/* Takes a record of a radar's plots, or of its antenna. */
void asterix_scans_take_record(struct asterix_scans *scans, const struct asterix_record *record);

/* Nothing comes any more: what there is becomes scans. */
void asterix_scans_finish(struct asterix_scans *scans);

/* The next complete scan; false: none yet. Scans of one radar come in the order of time. */
bool asterix_scans_next(struct asterix_scans *scans, struct asterix_scan *scan);

/* Nothing that comes later is before this time. INT64_MAX at the end. */
int64_t asterix_scans_settled_128(const struct asterix_scans *scans);

const struct asterix_counts *asterix_scans_counts(const struct asterix_scans *scans);

/* 1/128 s as microseconds, to the nearest. */
int64_t asterix_time_us(int64_t time_128);

#endif
