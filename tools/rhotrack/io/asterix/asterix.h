/* SPDX-License-Identifier: MIT */
/*
 * asterix: EUROCONTROL's format of radar messages, from bytes to values: CAT048 (plots of one
 * radar), CAT034 (what the radar says of its antenna and itself), their forerunners CAT001 and
 * CAT002, and CAT062 (tracks).
 *
 * Data blocks (category, length, records) of any category are told apart. Records of these five
 * are taken apart by their field specification, with the length of every item of the standard
 * profiles (CAT048 1.27 to 1.32, CAT034 1.27 to 1.29, CAT001 1.2 to 1.4, CAT002 1.0 to 1.2, CAT062
 * 1.18 to 1.21), so that any valid record can be skipped. No heap, no recursion; nothing is read
 * beyond the bytes that are given.
 * Cost: proportional to the bytes.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_H
#define RHOTRACK_TOOL_ASTERIX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ASTERIX_OLD_PLOTS 1u /* categories */
#define ASTERIX_OLD_SERVICE 2u
#define ASTERIX_SERVICE 34u
#define ASTERIX_PLOTS 48u
#define ASTERIX_TRACKS 62u

#define ASTERIX_HEADER_BYTES 3u
#define ASTERIX_BLOCK_MAX 65535u
#define ASTERIX_MAX_ITEMS 35
#define ASTERIX_TIME_HZ 128 /* times of day count 1/128 s */
#define ASTERIX_DAY (86400 * ASTERIX_TIME_HZ)
#define ASTERIX_TURN 65536             /* azimuths count 1/65536 turn, clockwise from north */
#define ASTERIX_RANGE_M (1852.0 / 256) /* ranges count this */
#define ASTERIX_HEIGHT_M (25 * 0.3048) /* heights and flight levels count 25 ft */

/* ---- Blocks and records ---- */

struct asterix_block {
    uint8_t category;
    const uint8_t *records; /* inside the bytes that were given */
    size_t size;            /* of the records */
};

/* The place of an error, and the reason. */
#define ASTERIX_REASON_BYTES 120
struct asterix_error {
    size_t at; /* after the bytes that were given */
    char reason[ASTERIX_REASON_BYTES];
};

/*
 * The block that the bytes begin with; its whole length is size + ASTERIX_HEADER_BYTES. False and
 * *error where there is none: a length below 3, or beyond the bytes.
 */
bool asterix_block_read(const uint8_t *data, size_t size, struct asterix_block *block,
                        struct asterix_error *error);

/* Whether records of the category can be taken apart; are a radar's plots, or of its antenna. */
bool asterix_category_is_known(uint8_t category);
bool asterix_category_is_plots(uint8_t category);
bool asterix_category_is_service(uint8_t category);

/* Items by their place in the profile, from 0; NULL where the record has none. */
struct asterix_record {
    uint8_t category;
    bool is_track; /* CAT001: by the profile of the radar's own tracks, not by that of plots */
    size_t size;   /* of the record */
    const uint8_t *items[ASTERIX_MAX_ITEMS];
    uint16_t sizes[ASTERIX_MAX_ITEMS];
};

/*
 * The record of a known category that the bytes begin with. False and *error where there is none:
 * an item beyond the bytes, or one that the category does not have.
 */
bool asterix_record_read(uint8_t category, const uint8_t *data, size_t size,
                         struct asterix_record *record, struct asterix_error *error);

/* ---- Values ---- */

struct asterix_source {
    bool is_given;
    uint8_t sac, sic; /* area and identification code */
};

/*
 * A radar's number: SAC * 256 + SIC as int16 has it, so that SAC 128 and more give numbers below 0.
 */
int32_t asterix_sensor_id(const struct asterix_source *source);

/* I048 or I001: one plot, or the plot of a radar's own track. Values that are not given are 0. */
struct asterix_plot {
    struct asterix_source source;
    bool has_time;          /* 140 */
    uint32_t time_128;      /* 1/128 s since midnight, UTC; may be a day or more, which is wrong */
    bool is_time_truncated; /* I001/141: time_128 is the rest of it after multiples of 512 s */
    bool has_type;          /* 020 */
    uint8_t type;           /* 0: no detection, 1: primary, 2: secondary, 3: both, 4 .. 7: Mode S */
    bool is_simulated, is_test, is_fixed; /* fixed: a field monitor's transponder */
    bool is_beyond;                       /* the range is beyond what 040 can say */
    bool has_position;                    /* 040 */
    uint32_t range;                       /* slant range in ASTERIX_RANGE_M */
    uint16_t azimuth;                     /* 1/ASTERIX_TURN turn */
    bool has_level, is_level_bad;         /* 090; bad: not validated, or garbled */
    int16_t level;                        /* in ASTERIX_HEIGHT_M, of the standard atmosphere */
    bool has_height;                      /* 110 */
    int16_t height;                   /* in ASTERIX_HEIGHT_M above mean sea level, by a 3-D radar */
    bool has_doppler, is_doppler_bad; /* 120, calculated; bad: doubtful */
    int16_t doppler_mps;
    bool has_raw_doppler; /* 120, raw: ambiguous speeds that are not read */
    bool has_mode_a;      /* 070 */
    uint16_t mode_a;
    bool has_address; /* 220 */
    uint32_t address;
    bool has_track; /* 161 */
    uint16_t track;
};
void asterix_plot_read(const struct asterix_record *record, struct asterix_plot *plot);

/* WGS 84; the height is above mean sea level by the standard. */
struct asterix_place {
    bool is_given;
    double lat_deg, lon_deg, alt_m;
};

#define ASTERIX_NORTH 1 /* types of I034 */
#define ASTERIX_SECTOR 2

/* I034 or I002: what the radar says of its antenna, and (I034) of its place. */
struct asterix_service {
    struct asterix_source source;
    bool has_type; /* 000 */
    uint8_t type;
    bool has_time; /* 030 */
    uint32_t time_128;
    bool has_sector; /* 020 */
    uint8_t sector;  /* the antenna's azimuth in 1/256 turn */
    bool has_period; /* 041 */
    uint16_t period_128;
    struct asterix_place place; /* 120 */
};
void asterix_service_read(const struct asterix_record *record, struct asterix_service *service);

/* I062: one track, as far as rhotrack writes it. */
struct asterix_track {
    struct asterix_source source;
    bool has_time; /* 070 */
    uint32_t time_128;
    bool has_number; /* 040 */
    uint16_t number;
    bool has_status; /* 080 */
    bool is_tentative, is_first, is_last, is_coasting, is_monosensor;
    bool has_place; /* 100 */
    double x_m, y_m;
    bool has_geodetic; /* 105 */
    double lat_deg, lon_deg;
    bool has_velocity; /* 185 */
    double vx_mps, vy_mps;
    bool has_accel; /* 210 */
    double ax_mps2, ay_mps2;
    bool has_altitude; /* 130, above the ellipsoid */
    double alt_m;
    bool has_climb; /* 220 */
    double climb_mps;
    bool has_sigma; /* 500, APC and ATV */
    double sigma_x_m, sigma_y_m, sigma_vx_mps, sigma_vy_mps;
};
void asterix_track_read(const struct asterix_record *record, struct asterix_track *track);

/*
 * The record of a track: the items that it has. Values beyond what an item holds become its
 * largest. Returns the number of bytes written.
 */
#define ASTERIX_TRACK_BYTES 64
size_t asterix_track_write(const struct asterix_track *track, uint8_t record[ASTERIX_TRACK_BYTES]);

#endif
