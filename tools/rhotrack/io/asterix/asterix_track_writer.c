/* SPDX-License-Identifier: MIT */
#include "io/asterix/asterix_track_writer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/asterix/asterix_codec.h"
#include "io/csv/local_frame.h"

/* One track of a list. */
struct entry {
    int32_t track_id;
    struct asterix_track track;
};

struct list {
    struct entry *entries; /* sorted by track_id */
    size_t count, capacity;
};

struct asterix_track_writer {
    FILE *file;
    struct asterix_source source;
    struct local_frame *frame; /* NULL where the origin is not set */
    struct list now, before;   /* list being collected, and the list written last */
    bool has_sensor, is_multisensor;
    int16_t sensor_id; /* sensor of the first track */
    uint8_t block[ASTERIX_TRACKS_BLOCK];
    size_t size; /* bytes of the block so far; 0: none is begun */
};

bool asterix_track_writer_is_path(const char *path)
{
    return path && (path_ends_with(path, ".ast") || path_ends_with(path, ".asterix"));
}

void asterix_track_writer_check(const char *path, bool with_covariance)
{
    if (with_covariance && asterix_track_writer_is_path(path)) {
        fail(EXIT_USAGE,
             "%s: CAT062 cannot hold covariances (--covariance); it has standard deviations "
             "(I062/500) in any case",
             path);
    }
}

struct asterix_track_writer *asterix_track_writer_open(FILE *file,
                                                       const struct parameters *parameters)
{
    struct asterix_track_writer *tracks = must_calloc(1, sizeof *tracks);

    tracks->file = file;
    tracks->source =
        (struct asterix_source){.is_given = true,
                                .sac = (uint8_t)parameters->value[PARAMETER_ASTERIX_SAC],
                                .sic = (uint8_t)parameters->value[PARAMETER_ASTERIX_SIC]};
    if (parameters_has_origin(parameters)) {
        tracks->frame = parameters_open_local_frame(parameters);
    }
    return tracks;
}

void asterix_track_writer_free(struct asterix_track_writer *tracks)
{
    if (tracks) {
        local_frame_close(tracks->frame);
        free(tracks->now.entries);
        free(tracks->before.entries);
        free(tracks);
    }
}

static void write_block(struct asterix_track_writer *tracks)
{
    if (tracks->size > 0) {
        tracks->block[0] = ASTERIX_TRACKS;
        tracks->block[1] = (uint8_t)(tracks->size >> 8);
        tracks->block[2] = (uint8_t)tracks->size;
        fwrite(tracks->block, 1, tracks->size, tracks->file);
        tracks->size = 0;
    }
}

static void add_track_record(struct asterix_track_writer *tracks, const struct asterix_track *track)
{
    uint8_t record[ASTERIX_TRACK_BYTES];
    size_t size = asterix_track_encode(track, record);

    if (tracks->size + size > sizeof tracks->block) {
        write_block(tracks);
    }
    if (tracks->size == 0) {
        tracks->size = ASTERIX_HEADER_BYTES;
    }
    memcpy(tracks->block + tracks->size, record, size);
    tracks->size += size;
}

/* Time of day in 1/128 s from utime in microseconds. */
static uint32_t time_of_day_128(int64_t utime)
{
    int64_t day_us = INT64_C(86400000000), of_day = utime % day_us;

    of_day = of_day < 0 ? of_day + day_us : of_day;
    return (uint32_t)((of_day * ASTERIX_TIME_HZ + 500000) / 1000000 % ASTERIX_DAY);
}

/* Diagonal element of the covariance, which is stored as its lower triangle. */
static double variance_of_state(const struct rho_message_track *track, int state)
{
    return (double)track->covariance[state * (state + 1) / 2 + state];
}

static double sigma_of_state(const struct rho_message_track *track, int state)
{
    return sqrt(fmax(0.0, variance_of_state(track, state)));
}

static void set_geodetic_position(const struct asterix_track_writer *tracks,
                                  const struct rho_message_track *message,
                                  struct asterix_track *track)
{
    const double place_m[3] = {(double)message->x_m, (double)message->y_m, (double)message->z_m};
    bool has_height = variance_of_state(message, 2) > 0;
    double geodetic[3];

    if (!tracks->frame) {
        return;
    }
    local_frame_to_geodetic(tracks->frame, place_m, geodetic);
    track->has_geodetic = true;
    track->lat_deg = geodetic[0];
    track->lon_deg = geodetic[1];
    track->has_altitude = track->has_climb = has_height;
    track->alt_m = geodetic[2];
    track->climb_mps = (double)message->vz_mps;
}

static struct asterix_track asterix_track_of(const struct asterix_track_writer *tracks,
                                             int64_t utime, const struct rho_message_track *message)
{
    struct asterix_track track = {
        .source = tracks->source,
        .time_128 = time_of_day_128(utime),
        .number = (uint16_t)message->track_id,
        .is_tentative = message->status == RHO_MESSAGE_TRACK_TENTATIVE,
        .is_coasting = message->status == RHO_MESSAGE_TRACK_COASTING,
        .has_place = true,
        .x_m = (double)message->x_m,
        .y_m = (double)message->y_m,
        .has_velocity = true,
        .vx_mps = (double)message->vx_mps,
        .vy_mps = (double)message->vy_mps,
        .has_accel = true,
        .ax_mps2 = (double)message->ax_mps2,
        .ay_mps2 = (double)message->ay_mps2,
        .has_sigma = variance_of_state(message, 0) > 0,
        .sigma_x_m = sigma_of_state(message, 0),
        .sigma_y_m = sigma_of_state(message, 1),
        .sigma_vx_mps = sigma_of_state(message, 3),
        .sigma_vy_mps = sigma_of_state(message, 4),
    };

    set_geodetic_position(tracks, message, &track);
    return track;
}

/* Notes a track's sensor: tracks are monosensor as long as all are of one sensor. */
static void note_sensor_of_track(struct asterix_track_writer *tracks, int16_t sensor_id)
{
    tracks->is_multisensor |= tracks->has_sensor && sensor_id != tracks->sensor_id;
    tracks->sensor_id = tracks->has_sensor ? tracks->sensor_id : sensor_id;
    tracks->has_sensor = true;
}

static int by_track_id(const void *a, const void *b)
{
    const struct entry *one = a, *other = b;

    return (one->track_id > other->track_id) - (one->track_id < other->track_id);
}

static void add_end_record(struct asterix_track_writer *tracks, const struct entry *entry,
                           uint32_t time_128)
{
    struct asterix_track track = entry->track;

    track.is_first = false;
    track.is_last = true;
    track.time_128 = time_128;
    add_track_record(tracks, &track);
}

/* Writes the list's tracks, and end records of those that only the list before had, by track_id. */
static void write_list_and_ends(struct asterix_track_writer *tracks, uint32_t time_128)
{
    const struct list *before = &tracks->before;
    size_t gone = 0;

    for (size_t i = 0; i < tracks->now.count; i++) {
        struct entry *entry = &tracks->now.entries[i];

        while (gone < before->count && before->entries[gone].track_id < entry->track_id) {
            add_end_record(tracks, &before->entries[gone++], time_128);
        }
        entry->track.is_first =
            gone == before->count || before->entries[gone].track_id > entry->track_id;
        gone += !entry->track.is_first;
        entry->track.is_monosensor = !tracks->is_multisensor;
        add_track_record(tracks, &entry->track);
    }
    while (gone < before->count) {
        add_end_record(tracks, &before->entries[gone++], time_128);
    }
    write_block(tracks);
}

static void write_and_keep_list(struct asterix_track_writer *tracks, int64_t utime)
{
    struct list before = tracks->before;

    if (tracks->now.count > 0) {
        qsort(tracks->now.entries, tracks->now.count, sizeof *tracks->now.entries, by_track_id);
    }
    write_list_and_ends(tracks, time_of_day_128(utime));
    tracks->before = tracks->now;
    tracks->now = before;
    tracks->now.count = 0;
}

void asterix_track_writer_add(struct asterix_track_writer *tracks,
                              const struct rho_message_track_list *message)
{
    for (int i = 0; i < message->num_tracks; i++) {
        const struct rho_message_track *track = &message->tracks[i];
        struct list *now = &tracks->now;

        if (track->status != RHO_MESSAGE_TRACK_DELETED) {
            now->entries = must_make_room_for_one(now->entries, now->count, &now->capacity,
                                                  sizeof *now->entries);
            now->entries[now->count++] =
                (struct entry){track->track_id, asterix_track_of(tracks, message->utime, track)};
            note_sensor_of_track(tracks, track->sensor_id);
        }
    }
    if (message->part + 1 >= message->num_parts) {
        write_and_keep_list(tracks, message->utime);
    }
}
