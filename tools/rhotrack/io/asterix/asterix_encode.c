/* SPDX-License-Identifier: MIT */
/* Tracks as records of CAT062. */
#include "io/asterix/asterix.h"

#include <math.h>

#include "io/asterix/asterix_items.h"

#define SPECIFICATION_MAX 5 /* bytes of a field specification */
#define FX 1u

/* A record under way: its items, and which they are. */
struct writing {
    uint8_t items[ASTERIX_TRACK_BYTES];
    size_t size;
    uint8_t specification[SPECIFICATION_MAX];
    size_t specification_size;
};

/* The next items belong to this place of the profile, which goes up from call to call. */
static void begin_item(struct writing *writing, int place)
{
    writing->specification[place / 7] |= (uint8_t)(0x80u >> place % 7);
    writing->specification_size = (size_t)place / 7 + 1;
}

static void put_bytes(struct writing *writing, int64_t value, int bytes)
{
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
        writing->items[writing->size++] = (uint8_t)((uint64_t)value >> shift);
    }
}

/*
 * A quantity to the nearest unit, within what two's complement of so many bytes holds; unsigned:
 * from 0 on.
 */
static void put_signed(struct writing *writing, double value, double unit, int bytes)
{
    double limit = ldexp(1, 8 * bytes - 1);

    put_bytes(writing, (int64_t)fmin(fmax(round(value / unit), -limit), limit - 1), bytes);
}

static void put_unsigned(struct writing *writing, double value, double unit, int bytes)
{
    put_bytes(writing, (int64_t)fmin(fmax(round(value / unit), 0), ldexp(1, 8 * bytes) - 1), bytes);
}

/* 080: as many bytes as say something. */
static void put_status(struct writing *writing, const struct asterix_track *track)
{
    uint8_t bytes[4] = {
        (uint8_t)(track->is_monosensor << 7 | track->has_altitude << 5 | track->is_tentative << 1),
        (uint8_t)(track->is_last << 6 | track->is_first << 5), 0,
        (uint8_t)(track->is_coasting << 7)};
    int last = track->is_coasting ? 3 : track->is_last || track->is_first ? 1 : 0;

    begin_item(writing, I062_080);
    for (int i = 0; i <= last; i++) {
        put_bytes(writing, bytes[i] | (i < last ? FX : 0), 1);
    }
}

static void put_place(struct writing *writing, const struct asterix_track *track)
{
    if (track->has_geodetic) {
        begin_item(writing, I062_105);
        put_signed(writing, track->lat_deg, 180.0 / 33554432, 4);
        put_signed(writing, track->lon_deg, 180.0 / 33554432, 4);
    }
    if (track->has_place) {
        begin_item(writing, I062_100);
        put_signed(writing, track->x_m, 0.5, 3);
        put_signed(writing, track->y_m, 0.5, 3);
    }
}

static void put_motion(struct writing *writing, const struct asterix_track *track)
{
    if (track->has_velocity) {
        begin_item(writing, I062_185);
        put_signed(writing, track->vx_mps, 0.25, 2);
        put_signed(writing, track->vy_mps, 0.25, 2);
    }
    if (track->has_accel) {
        begin_item(writing, I062_210);
        put_signed(writing, track->ax_mps2, 0.25, 1);
        put_signed(writing, track->ay_mps2, 0.25, 1);
    }
}

static void put_height(struct writing *writing, const struct asterix_track *track)
{
    if (track->has_altitude) {
        begin_item(writing, I062_130);
        put_signed(writing, track->alt_m, 6.25 * 0.3048, 2);
    }
    if (track->has_climb) {
        begin_item(writing, I062_220);
        put_signed(writing, track->climb_mps, 6.25 * 0.3048 / 60, 2);
    }
}

/* 500: APC and ATV, the first and the sixth part. */
static void put_accuracies(struct writing *writing, const struct asterix_track *track)
{
    if (track->has_sigma) {
        begin_item(writing, I062_500);
        put_bytes(writing, 0x80 | 0x04, 1);
        put_unsigned(writing, track->sigma_x_m, 0.5, 2);
        put_unsigned(writing, track->sigma_y_m, 0.5, 2);
        put_unsigned(writing, track->sigma_vx_mps, 0.25, 1);
        put_unsigned(writing, track->sigma_vy_mps, 0.25, 1);
    }
}

size_t asterix_track_write(const struct asterix_track *track, uint8_t record[ASTERIX_TRACK_BYTES])
{
    struct writing writing = {.size = 0};
    size_t size = 0;

    begin_item(&writing, I062_010);
    put_bytes(&writing, track->source.sac, 1);
    put_bytes(&writing, track->source.sic, 1);
    begin_item(&writing, I062_070);
    put_bytes(&writing, track->time_128, 3);
    put_place(&writing, track);
    put_motion(&writing, track);
    begin_item(&writing, I062_040);
    put_bytes(&writing, track->number, 2);
    put_status(&writing, track);
    put_height(&writing, track);
    put_accuracies(&writing, track);
    for (size_t i = 0; i < writing.specification_size; i++) {
        bool is_last = i + 1 == writing.specification_size;

        record[size++] = (uint8_t)(writing.specification[i] | (is_last ? 0 : FX));
    }
    for (size_t i = 0; i < writing.size; i++) {
        record[size++] = writing.items[i];
    }
    return size;
}
