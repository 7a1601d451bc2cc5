/* SPDX-License-Identifier: MIT */
/*
 * asterix_decode: decodes the values of items. Lengths were checked before: an
 * item that is there has all bytes of its form.
 */
#include "base/big_endian.h"
#include "io/asterix/asterix_codec.h"
#include "io/asterix/asterix_item_lengths.h"

static uint32_t read_unsigned(const uint8_t *data, int bytes)
{
    return (uint32_t)load_big_endian(data, bytes);
}

/* The lowest `bits` bits as a two's complement number. */
static int32_t sign_extend(uint32_t value, int bits)
{
    uint32_t top = UINT32_C(1) << (bits - 1), all = top | (top - 1);

    value &= all;
    return value & top ? -(int32_t)(all - value) - 1 : (int32_t)value;
}

static int32_t read_signed(const uint8_t *data, int bytes)
{
    return sign_extend(read_unsigned(data, bytes), 8 * bytes);
}

static struct asterix_source read_source(const uint8_t *item)
{
    return item ? (struct asterix_source){.is_given = true, .sac = item[0], .sic = item[1]}
                : (struct asterix_source){.is_given = false};
}

int32_t asterix_sensor_id(const struct asterix_source *source)
{
    return sign_extend((uint32_t)source->sac << 8 | source->sic, 16);
}

/* I048/020, target report descriptor. Its second byte is there where the first has FX set. */
static void read_target_report_descriptor(const uint8_t *item, size_t size,
                                          struct asterix_plot *plot)
{
    plot->has_type = true;
    plot->type = item[0] >> 5;
    plot->is_simulated = item[0] >> 4 & 1;
    plot->is_fixed = item[0] >> 1 & 1;
    if (size > 1) {
        plot->is_test = item[1] >> 7 & 1;
        plot->is_beyond = item[1] >> 6 & 1;
    }
}

/* I048/120, radial Doppler speed: the calculated speed comes first where it is there. */
static void read_doppler(const uint8_t *item, struct asterix_plot *plot)
{
    plot->has_doppler = item[0] >> 7 & 1;
    plot->has_raw_doppler = item[0] >> 6 & 1;
    if (plot->has_doppler) {
        plot->is_doppler_bad = item[1] >> 7 & 1;
        plot->doppler_mps = (int16_t)sign_extend(read_unsigned(item + 1, 2), 10);
    }
}

static void read_cat048_plot(const struct asterix_record *record, struct asterix_plot *plot)
{
    const uint8_t *time = record->items[I048_140], *position = record->items[I048_040];

    *plot = (struct asterix_plot){.source = read_source(record->items[I048_010])};
    if (time) {
        plot->has_time = true;
        plot->time_128 = read_unsigned(time, 3);
    }
    if (record->items[I048_020]) {
        read_target_report_descriptor(record->items[I048_020], record->sizes[I048_020], plot);
    }
    if (position) {
        plot->has_position = true;
        plot->range = (uint16_t)read_unsigned(position, 2);
        plot->azimuth = (uint16_t)read_unsigned(position + 2, 2);
    }
    const uint8_t *level = record->items[I048_090], *height = record->items[I048_110];

    if (level) {
        plot->has_level = true;
        plot->is_level_bad = level[0] >> 6 != 0;
        plot->level = (int16_t)sign_extend(read_unsigned(level, 2), 14);
    }
    if (height) {
        plot->has_height = true;
        plot->height = (int16_t)sign_extend(read_unsigned(height, 2), 14);
    }
    if (record->items[I048_120]) {
        read_doppler(record->items[I048_120], plot);
    }
    const uint8_t *mode_a = record->items[I048_070], *address = record->items[I048_220];
    const uint8_t *track = record->items[I048_161];

    plot->has_mode_a = mode_a;
    plot->mode_a = mode_a ? (uint16_t)(read_unsigned(mode_a, 2) & 0xfff) : 0;
    plot->has_address = address;
    plot->address = address ? read_unsigned(address, 3) : 0;
    plot->has_track = track;
    plot->track = track ? (uint16_t)(read_unsigned(track, 2) & 0xfff) : 0;
}

/* Items of CAT001 that both profiles have; cat001_item knows their indices. */
enum { OLD_010, OLD_020, OLD_040, OLD_070, OLD_090, OLD_120, OLD_141, OLD_161, NUM_OLD };

static const uint8_t *cat001_item(const struct asterix_record *record, int item)
{
    static const int places[2][NUM_OLD] = {{0, 1, 2, 3, 4, 8, 6, -1}, {0, 1, 3, 6, 7, 11, 8, 2}};
    const int place = places[record->is_track][item];

    return place < 0 ? NULL : record->items[place];
}

/* I001/020 has a second byte where the first has FX set. Doppler speeds of CAT001 are raw. */
static void read_cat001_plot(const struct asterix_record *record, struct asterix_plot *plot)
{
    const uint8_t *type = cat001_item(record, OLD_020), *position = cat001_item(record, OLD_040);
    const uint8_t *time = cat001_item(record, OLD_141), *level = cat001_item(record, OLD_090);
    const uint8_t *mode_a = cat001_item(record, OLD_070), *track = cat001_item(record, OLD_161);

    *plot = (struct asterix_plot){.source = read_source(cat001_item(record, OLD_010)),
                                  .has_time = time,
                                  .is_time_truncated = time,
                                  .has_type = type,
                                  .has_position = position,
                                  .has_level = level,
                                  .has_raw_doppler = cat001_item(record, OLD_120),
                                  .has_mode_a = mode_a,
                                  .has_track = track};
    plot->time_128 = time ? read_unsigned(time, 2) : 0;
    if (type) {
        plot->type = type[0] >> 4 & 3;
        plot->is_simulated = type[0] >> 6 & 1;
        plot->is_fixed = type[0] >> 1 & 1;
        plot->is_test = (type[0] & 1) && type[1] >> 7;
    }
    plot->range = position ? 2 * read_unsigned(position, 2) : 0;
    plot->azimuth = position ? (uint16_t)read_unsigned(position + 2, 2) : 0;
    plot->is_level_bad = level && level[0] >> 6 != 0;
    plot->level = level ? (int16_t)sign_extend(read_unsigned(level, 2), 14) : 0;
    plot->mode_a = mode_a ? (uint16_t)(read_unsigned(mode_a, 2) & 0xfff) : 0;
    plot->track = track ? (uint16_t)read_unsigned(track, 2) : 0;
}

void asterix_plot_read(const struct asterix_record *record, struct asterix_plot *plot)
{
    if (record->category == ASTERIX_OLD_PLOTS) {
        read_cat001_plot(record, plot);
    } else {
        read_cat048_plot(record, plot);
    }
}

#define QUARTER_TURN 4194304 /* 90 degrees in units of item I034/120 */

/*
 * I034/120, the radar's place: height in metres, latitude and longitude in 180/2^23 degrees. A
 * latitude beyond the poles counts as missing.
 */
static void read_radar_place(const uint8_t *item, struct asterix_service *service)
{
    int32_t lat = read_signed(item + 2, 3);

    if (lat < -QUARTER_TURN || lat > QUARTER_TURN) {
        return;
    }
    service->place =
        (struct asterix_place){.is_given = true,
                               .alt_m = read_signed(item, 2),
                               .lat_deg = lat * (180.0 / 8388608),
                               .lon_deg = read_signed(item + 5, 3) * (180.0 / 8388608)};
}

void asterix_service_read(const struct asterix_record *record, struct asterix_service *service)
{
    const bool is_old = record->category == ASTERIX_OLD_SERVICE;
    const uint8_t *source = record->items[is_old ? I002_010 : I034_010];
    const uint8_t *type = record->items[is_old ? I002_000 : I034_000];
    const uint8_t *time = record->items[is_old ? I002_030 : I034_030];
    const uint8_t *sector = record->items[is_old ? I002_020 : I034_020];
    const uint8_t *period = record->items[is_old ? I002_041 : I034_041];

    *service = (struct asterix_service){.source = read_source(source)};
    service->has_type = type;
    service->type = type ? type[0] : 0;
    service->has_time = time;
    service->time_128 = time ? read_unsigned(time, 3) : 0;
    service->has_sector = sector;
    service->sector = sector ? sector[0] : 0;
    service->has_period = period;
    service->period_128 = period ? (uint16_t)read_unsigned(period, 2) : 0;
    if (!is_old && record->items[I034_120]) {
        read_radar_place(record->items[I034_120], service);
    }
}

/*
 * I062/080, track status: bit CNF in the first byte, TSB and TSE in the second, CST in the fourth.
 */
static void read_track_status(const uint8_t *item, size_t size, struct asterix_track *track)
{
    track->has_status = true;
    track->is_monosensor = item[0] >> 7 & 1;
    track->is_tentative = item[0] >> 1 & 1;
    track->is_last = size > 1 && (item[1] >> 6 & 1);
    track->is_first = size > 1 && (item[1] >> 5 & 1);
    track->is_coasting = size > 3 && (item[3] >> 7 & 1);
}

/* I062/500, parts APC and ATV; the table has the lengths of the five parts before ATV. */
static void read_track_sigmas(const uint8_t *item, size_t size, struct asterix_track *track)
{
    static const uint8_t bytes[] = {4, 2, 4, 1, 1};
    const uint8_t *at = item + (item[0] & 1 ? 2 : 1), *velocity = at;

    if (!(item[0] >> 7 & 1) || !(item[0] >> 2 & 1)) {
        return;
    }
    for (int i = 0; i < 5; i++) {
        velocity += item[0] >> (7 - i) & 1 ? bytes[i] : 0;
    }
    track->has_sigma = velocity + 2 <= item + size;
    track->sigma_x_m = 0.5 * read_unsigned(at, 2);
    track->sigma_y_m = 0.5 * read_unsigned(at + 2, 2);
    track->sigma_vx_mps = track->has_sigma ? 0.25 * velocity[0] : 0;
    track->sigma_vy_mps = track->has_sigma ? 0.25 * velocity[1] : 0;
}

static void read_track_motion(const struct asterix_record *record, struct asterix_track *track)
{
    const uint8_t *velocity = record->items[I062_185], *accel = record->items[I062_210];
    const uint8_t *climb = record->items[I062_220];

    if (velocity) {
        track->has_velocity = true;
        track->vx_mps = 0.25 * read_signed(velocity, 2);
        track->vy_mps = 0.25 * read_signed(velocity + 2, 2);
    }
    if (accel) {
        track->has_accel = true;
        track->ax_mps2 = 0.25 * read_signed(accel, 1);
        track->ay_mps2 = 0.25 * read_signed(accel + 1, 1);
    }
    if (climb) {
        track->has_climb = true;
        track->climb_mps = 6.25 * 0.3048 / 60 * read_signed(climb, 2);
    }
}

static void read_track_position(const struct asterix_record *record, struct asterix_track *track)
{
    const uint8_t *place = record->items[I062_100], *geodetic = record->items[I062_105];
    const uint8_t *altitude = record->items[I062_130];

    if (place) {
        track->has_place = true;
        track->x_m = 0.5 * read_signed(place, 3);
        track->y_m = 0.5 * read_signed(place + 3, 3);
    }
    if (geodetic) {
        track->has_geodetic = true;
        track->lat_deg = read_signed(geodetic, 4) * (180.0 / 33554432);
        track->lon_deg = read_signed(geodetic + 4, 4) * (180.0 / 33554432);
    }
    if (altitude) {
        track->has_altitude = true;
        track->alt_m = 6.25 * 0.3048 * read_signed(altitude, 2);
    }
}

void asterix_track_read(const struct asterix_record *record, struct asterix_track *track)
{
    const uint8_t *time = record->items[I062_070], *number = record->items[I062_040];

    *track = (struct asterix_track){.source = read_source(record->items[I062_010])};
    track->has_time = time;
    track->time_128 = time ? read_unsigned(time, 3) : 0;
    track->has_number = number;
    track->number = number ? (uint16_t)read_unsigned(number, 2) : 0;
    if (record->items[I062_080]) {
        read_track_status(record->items[I062_080], record->sizes[I062_080], track);
    }
    read_track_position(record, track);
    read_track_motion(record, track);
    if (record->items[I062_500]) {
        read_track_sigmas(record->items[I062_500], record->sizes[I062_500], track);
    }
}
