/* SPDX-License-Identifier: MIT */
/*
 * Encodes tracks as records of CAT062.
 */
#include "io/asterix/asterix_codec.h"

#include <math.h>

#include "base/big_endian.h"
#include "io/asterix/asterix_item_lengths.h"

#define SPECIFICATION_MAX 5 /* largest number of bytes of a field specification */
#define FX 1u

/* A record being encoded: its items, and the field specification that tells which are there. */
struct record_encoder {
    uint8_t items[ASTERIX_TRACK_BYTES];
    size_t size;
    uint8_t specification[SPECIFICATION_MAX];
    size_t specification_size;
};

/*
 * Marks the item at a place of the profile as present; its bytes are put next. Places must ascend.
 */
static void begin_record_item(struct record_encoder *encoder, int place)
{
    encoder->specification[place / 7] |= (uint8_t)(0x80u >> place % 7);
    encoder->specification_size = (size_t)place / 7 + 1;
}

static void put_big_endian(struct record_encoder *encoder, int64_t value, int bytes)
{
    store_big_endian(encoder->items + encoder->size, (uint64_t)value, bytes);
    encoder->size += (size_t)bytes;
}

/*
 * Puts value / unit, rounded and limited to the range of a two's complement number of `bytes`
 * bytes.
 */
static void put_scaled_signed(struct record_encoder *encoder, double value, double unit, int bytes)
{
    double limit = ldexp(1, 8 * bytes - 1);

    put_big_endian(encoder, (int64_t)fmin(fmax(round(value / unit), -limit), limit - 1), bytes);
}

static void put_scaled_unsigned(struct record_encoder *encoder, double value, double unit,
                                int bytes)
{
    put_big_endian(encoder, (int64_t)fmin(fmax(round(value / unit), 0), ldexp(1, 8 * bytes) - 1),
                   bytes);
}

size_t asterix_track_encode(const struct asterix_track *track, uint8_t record[ASTERIX_TRACK_BYTES])
{
    struct record_encoder encoder = {.size = 0};
    size_t size = 0;

    begin_record_item(&encoder, I062_010);
    put_big_endian(&encoder, track->source.sac, 1);
    put_big_endian(&encoder, track->source.sic, 1);
    begin_record_item(&encoder, I062_070);
    put_big_endian(&encoder, track->time_128, 3);
    if (track->has_geodetic) {
        begin_record_item(&encoder, I062_105);
        put_scaled_signed(&encoder, track->lat_deg, 180.0 / 33554432, 4);
        put_scaled_signed(&encoder, track->lon_deg, 180.0 / 33554432, 4);
    }
    if (track->has_place) {
        begin_record_item(&encoder, I062_100);
        put_scaled_signed(&encoder, track->x_m, 0.5, 3);
        put_scaled_signed(&encoder, track->y_m, 0.5, 3);
    }
    if (track->has_velocity) {
        begin_record_item(&encoder, I062_185);
        put_scaled_signed(&encoder, track->vx_mps, 0.25, 2);
        put_scaled_signed(&encoder, track->vy_mps, 0.25, 2);
    }
    if (track->has_accel) {
        begin_record_item(&encoder, I062_210);
        put_scaled_signed(&encoder, track->ax_mps2, 0.25, 1);
        put_scaled_signed(&encoder, track->ay_mps2, 0.25, 1);
    }
    begin_record_item(&encoder, I062_040);
    put_big_endian(&encoder, track->number, 2);
    /* I062/080, track status: as many of its bytes as are needed for the bits set. */
    uint8_t bytes[4] = {
        (uint8_t)(track->is_monosensor << 7 | track->has_altitude << 5 | track->is_tentative << 1),
        (uint8_t)(track->is_last << 6 | track->is_first << 5), 0,
        (uint8_t)(track->is_coasting << 7)};
    int last = track->is_coasting ? 3 : track->is_last || track->is_first ? 1 : 0;

    begin_record_item(&encoder, I062_080);
    for (int i = 0; i <= last; i++) {
        put_big_endian(&encoder, bytes[i] | (i < last ? FX : 0), 1);
    }
    if (track->has_altitude) {
        begin_record_item(&encoder, I062_130);
        put_scaled_signed(&encoder, track->alt_m, 6.25 * 0.3048, 2);
    }
    if (track->has_climb) {
        begin_record_item(&encoder, I062_220);
        put_scaled_signed(&encoder, track->climb_mps, 6.25 * 0.3048 / 60, 2);
    }
    /* I062/500, accuracies: its parts APC and ATV, the first and the sixth. */
    if (track->has_sigma) {
        begin_record_item(&encoder, I062_500);
        put_big_endian(&encoder, 0x80 | 0x04, 1);
        put_scaled_unsigned(&encoder, track->sigma_x_m, 0.5, 2);
        put_scaled_unsigned(&encoder, track->sigma_y_m, 0.5, 2);
        put_scaled_unsigned(&encoder, track->sigma_vx_mps, 0.25, 1);
        put_scaled_unsigned(&encoder, track->sigma_vy_mps, 0.25, 1);
    }
    for (size_t i = 0; i < encoder.specification_size; i++) {
        bool is_last = i + 1 == encoder.specification_size;

        record[size++] = (uint8_t)(encoder.specification[i] | (is_last ? 0 : FX));
    }
    for (size_t i = 0; i < encoder.size; i++) {
        record[size++] = encoder.items[i];
    }
    return size;
}
