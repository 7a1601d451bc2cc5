/* SPDX-License-Identifier: MIT */
/*
 * asterix_antenna: the azimuths of a rotating antenna over time, from the
 * times at which it crossed north or the borders of sectors.
 *
 * Times are 1/128 s, azimuths 1/65536 turn clockwise from north. The antenna turns clockwise.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_ANTENNA_H
#define RHOTRACK_TOOL_ASTERIX_ANTENNA_H

#include <stdbool.h>
#include <stdint.h>

/* The antenna's way from one crossing to the next: a sector, or a whole turn. */
struct asterix_look {
    int64_t start_128, end_128; /* times of the two crossings; end > start */
    uint16_t from;              /* azimuth of the first crossing */
    uint32_t advance;           /* angle turned between the crossings: 1 .. ASTERIX_TURN */
};

/* An antenna's newest crossing and its rotation period. Initialised with zeros. */
struct asterix_antenna {
    bool has_last;
    int64_t last_128; /* time of the newest crossing */
    uint16_t last;
    /* rotation period as the radar stated it, else from the newest look; 0: not known */
    int64_t period_128;
    bool is_period_said;
};

enum asterix_crossing {
    ASTERIX_LOOKED, /* *look is set to the look that the crossing ends */
    /* first crossing, or first after a gap: looks begin here, and none ends */
    ASTERIX_BEGUN,
    /* repetition of the newest crossing, for example as north marker and as sector */
    ASTERIX_AGAIN,
    ASTERIX_BACK /* not later than the newest crossing: ignored */
};

/*
 * Processes a crossing of an azimuth. *is_gap: the time since the crossing before is too long, so
 * that crossings in between are missing.
 */
enum asterix_crossing asterix_antenna_end_look(struct asterix_antenna *antenna, int64_t time_128,
                                               uint16_t azimuth, struct asterix_look *look,
                                               bool *is_gap);

/* Time of a whole turn at the look's own speed. */
int64_t asterix_look_turn_time_128(const struct asterix_look *look);

/*
 * Whether a plot belongs to a look: its azimuth is in the look's sector, and its time is within
 * half a turn of the antenna's passage there; *distance_128 is that time difference.
 */
bool asterix_look_covers_plot(const struct asterix_look *look, int64_t time_128, uint16_t azimuth,
                              int64_t *distance_128);

/*
 * The unfinished look since the newest crossing, up to a given time. Returns false where the
 * antenna's crossings or period are not known, or the time is not within a turn of the crossing.
 */
bool asterix_antenna_look_so_far(const struct asterix_antenna *antenna, int64_t time_128,
                                 struct asterix_look *look);

#endif
