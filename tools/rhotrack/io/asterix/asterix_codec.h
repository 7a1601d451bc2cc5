/* SPDX-License-Identifier: MIT */
/*
 * asterix_codec: decoding and encoding of ASTERIX, EUROCONTROL's format of radar messages: CAT048
 * (plots of one radar), CAT034 (service messages: antenna crossings, the radar's place), their
 * forerunners CAT001 and CAT002, and CAT062 (tracks).
 *
 * Data blocks (category, length, records) of any category are separated. Records of these five are
 * split by their field specification, with the length of every item of the standard profiles
 * (CAT048 1.27 to 1.32, CAT034 1.27 to 1.29, CAT001 1.2 to 1.4, CAT002 1.0 to 1.2, CAT062 1.18 to
 * 1.21), so that any valid record can be skipped. No heap, no recursion; nothing is read beyond the
 * bytes given.
 * Cost: proportional to the bytes.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_CODEC_H
#define RHOTRACK_TOOL_ASTERIX_CODEC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ASTERIX_OLD_PLOTS 1u /* category numbers */
#define ASTERIX_OLD_SERVICE 2u
#define ASTERIX_SERVICE 34u
#define ASTERIX_PLOTS 48u
#define ASTERIX_TRACKS 62u

#define ASTERIX_HEADER_BYTES 3u
#define ASTERIX_BLOCK_MAX 65535u
#define ASTERIX_MAX_ITEMS 35
#define ASTERIX_TIME_HZ 128 /* units of times of day in a second */
#define ASTERIX_DAY (86400 * ASTERIX_TIME_HZ)
#define ASTERIX_TURN 65536             /* units of azimuth in a turn, clockwise from north */
#define ASTERIX_RANGE_M (1852.0 / 256) /* unit of ranges, metres */
#define ASTERIX_HEIGHT_M (25 * 0.3048) /* unit of heights and flight levels: 25 ft in metres */

struct asterix_block {
    uint8_t category;
    const uint8_t *records; /* first byte of the block's records, inside the bytes given */
    size_t size;            /* bytes of all its records */
};

/* Error of decoding: its place and the reason. */
#define ASTERIX_REASON_BYTES 120
struct asterix_error {
    size_t at; /* byte offset from the start of the bytes given */
    char reason[ASTERIX_REASON_BYTES];
};

/*
 * Reads the header of the data block that the bytes begin with; the whole block has size +
 * ASTERIX_HEADER_BYTES bytes. Returns false and sets *error where its length is below 3, or beyond
 * the bytes.
 */
bool asterix_block_read(const uint8_t *data, size_t size, struct asterix_block *block,
                        struct asterix_error *error);

/*
 * Properties of a category: its records can be decoded; they are plots of a radar; they are service
 * messages of a radar (antenna crossings).
 */
bool asterix_category_is_known(uint8_t category);
bool asterix_category_is_plots(uint8_t category);
bool asterix_category_is_service(uint8_t category);

/*
 * One record split into items, which are indexed by their place in the category's profile from 0;
 * NULL where the record does not have the item.
 */
struct asterix_record {
    uint8_t category;
    bool is_track; /* CAT001: a track of the radar, with the profile of tracks instead of plots */
    size_t size;   /* bytes of the record */
    const uint8_t *items[ASTERIX_MAX_ITEMS];
    uint16_t sizes[ASTERIX_MAX_ITEMS];
};

/*
 * Splits the record of a known category that the bytes begin with. Returns false and sets *error
 * where an item ends beyond the bytes, or is not one of the category.
 */
bool asterix_record_read(uint8_t category, const uint8_t *data, size_t size,
                         struct asterix_record *record, struct asterix_error *error);

/* The source that records of a block of CAT001 have from the block's first one. */
struct asterix_block_source {
    bool is_given;
    uint8_t item[2];
};

/*
 * Completes a record of CAT001 without its source (I001/010), which radars give in a block's first
 * record alone. `source` must live as long as the record.
 *   is_first  it is the block's first record
 */
void asterix_record_complete_source(struct asterix_record *record, bool is_first,
                                    struct asterix_block_source *source);

struct asterix_source {
    bool is_given;
    uint8_t sac, sic; /* system area code and system identification code */
};

/* A radar's sensor number: SAC * 256 + SIC as int16, negative for SAC 128 and more. */
int32_t asterix_sensor_id(const struct asterix_source *source);

/*
 * One plot (CAT048 or CAT001), or the plot of a radar's own track. Values that are not given are 0.
 * Comments name the CAT048 item that a value comes from.
 */
struct asterix_plot {
    struct asterix_source source;
    bool has_time; /* I048/140, time of day */
    /* 1/128 s since midnight, UTC; a day or more is an error of the radar */
    uint32_t time_128;
    bool is_time_truncated; /* I001/141: time_128 is the time of day modulo 512 s */
    bool has_type;          /* I048/020, target report descriptor */
    uint8_t type;           /* 0: no detection, 1: primary, 2: secondary, 3: both, 4 .. 7: Mode S */
    bool is_simulated, is_test, is_fixed; /* is_fixed: plot of a field monitor's transponder */
    bool is_beyond;                       /* the range exceeds the largest that item 040 can hold */
    bool has_position;                    /* I048/040, measured range and azimuth */
    uint32_t range;                       /* slant range in ASTERIX_RANGE_M */
    uint16_t azimuth;                     /* in 1/ASTERIX_TURN of a turn, clockwise from north */
    /* I048/090, flight level; bad: not validated, or garbled */
    bool has_level, is_level_bad;
    /* flight level in ASTERIX_HEIGHT_M, by the standard atmosphere */
    int16_t level;
    bool has_height;                  /* I048/110, height by a 3-D radar */
    int16_t height;                   /* in ASTERIX_HEIGHT_M above mean sea level */
    bool has_doppler, is_doppler_bad; /* I048/120, calculated Doppler speed; bad: doubtful */
    int16_t doppler_mps;
    bool has_raw_doppler; /* I048/120, raw Doppler speeds: ambiguous, and not read */
    bool has_mode_a;      /* I048/070, Mode A code */
    uint16_t mode_a;
    bool has_address; /* I048/220, aircraft address */
    uint32_t address;
    bool has_track; /* I048/161, track number */
    uint16_t track;
};
void asterix_plot_read(const struct asterix_record *record, struct asterix_plot *plot);

/* A place in WGS 84; alt_m is above mean sea level by the standard. */
struct asterix_place {
    bool is_given;
    double lat_deg, lon_deg, alt_m;
};

#define ASTERIX_NORTH 1 /* message types in item I034/000: north marker, sector crossing */
#define ASTERIX_SECTOR 2

/*
 * One service message (CAT034 or CAT002): an antenna crossing, and in CAT034 the radar's place.
 * Comments name the CAT034 item that a value comes from.
 */
struct asterix_service {
    struct asterix_source source;
    bool has_type; /* I034/000, message type */
    uint8_t type;
    bool has_time; /* I034/030, time of day */
    uint32_t time_128;
    bool has_sector; /* I034/020, sector number */
    uint8_t sector;  /* the antenna's azimuth in 1/256 of a turn */
    bool has_period; /* I034/041, antenna rotation period */
    uint16_t period_128;
    struct asterix_place place; /* I034/120, the radar's place */
};
void asterix_service_read(const struct asterix_record *record, struct asterix_service *service);

/*
 * One track (CAT062), with the items that rhotrack writes. Comments name the item that a value
 * comes from.
 */
struct asterix_track {
    struct asterix_source source;
    bool has_time; /* I062/070, time of day */
    uint32_t time_128;
    bool has_number; /* I062/040, track number */
    uint16_t number;
    bool has_status; /* I062/080, track status */
    bool is_tentative, is_first, is_last, is_coasting, is_monosensor;
    bool has_place; /* I062/100, Cartesian position */
    double x_m, y_m;
    bool has_geodetic; /* I062/105, WGS 84 position */
    double lat_deg, lon_deg;
    bool has_velocity; /* I062/185, Cartesian velocity */
    double vx_mps, vy_mps;
    bool has_accel; /* I062/210, acceleration */
    double ax_mps2, ay_mps2;
    bool has_altitude; /* I062/130, altitude above the ellipsoid */
    double alt_m;
    bool has_climb; /* I062/220, rate of climb */
    double climb_mps;
    bool has_sigma; /* I062/500, estimated accuracies APC (position) and ATV (velocity) */
    double sigma_x_m, sigma_y_m, sigma_vx_mps, sigma_vy_mps;
};
void asterix_track_read(const struct asterix_record *record, struct asterix_track *track);

/*
 * Encodes a track as a record of CAT062 with the items that the track has. Values beyond what an
 * item can hold become the largest that it can. Returns the number of bytes written.
 */
#define ASTERIX_TRACK_BYTES 64
size_t asterix_track_encode(const struct asterix_track *track, uint8_t record[ASTERIX_TRACK_BYTES]);

#endif
