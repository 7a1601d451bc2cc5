/* SPDX-License-Identifier: MIT */
/*
 * asterix_antenna: where a turning antenna looked when, from the times at which it crossed north or
 * the borders of sectors.
 *
 * Times are 1/128 s, azimuths 1/65536 turn clockwise from north. The antenna turns clockwise.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_ANTENNA_H
#define RHOTRACK_TOOL_ASTERIX_ANTENNA_H

#include <stdbool.h>
#include <stdint.h>

/* From one crossing to the next: a sector, or a whole turn. */
struct asterix_look {
    int64_t start_128, end_128; /* end > start */
    uint16_t from;              /* azimuth at the start */
    uint32_t advance;           /* how far it turned: 1 .. ASTERIX_TURN */
};

/* Starts as zeros. */
struct asterix_antenna {
    bool has_last;
    int64_t last_128; /* the newest crossing */
    uint16_t last;
    int64_t period_128; /* of a turn: as the radar says, or else the newest look's; 0: not known */
    bool is_period_said;
};

enum asterix_crossing {
    ASTERIX_LOOKED, /* *look is set */
    /* the first crossing, or the first after a gap: looks are counted from here on */
    ASTERIX_BEGUN,
    ASTERIX_AGAIN, /* the same crossing once more, as north marker and as sector for one */
    ASTERIX_BACK   /* not after the one before: not taken */
};

/* The antenna crosses an azimuth. *is_gap: crossings before it are missing, a turn or more. */
enum asterix_crossing asterix_antenna_cross(struct asterix_antenna *antenna, int64_t time_128,
                                            uint16_t azimuth, struct asterix_look *look,
                                            bool *is_gap);

/* How long a turn takes at the look's own speed. */
int64_t asterix_look_turn_time_128(const struct asterix_look *look);

/*
 * Whether the antenna looked there in this look, and how long before or after it did the time is. A
 * plot of half a turn before or after is one of another look.
 */
bool asterix_look_saw(const struct asterix_look *look, int64_t time_128, uint16_t azimuth,
                      int64_t *distance_128);

/* The look since the newest crossing, up to a time. False where nothing is known of it. */
bool asterix_antenna_look_so_far(const struct asterix_antenna *antenna, int64_t time_128,
                                 struct asterix_look *look);

#endif
