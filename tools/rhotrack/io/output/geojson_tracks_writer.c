/* SPDX-License-Identifier: MIT */
#include "io/output/geojson_tracks_writer.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/identity_map.h"
#include "io/csv/local_frame.h"

struct point {
    int64_t time_us;
    float place_m[3];
};

/* A track that has not been written yet. */
struct track {
    struct point *points;
    size_t count, capacity;
    struct geojson_row last; /* newest row */
    bool was_confirmed, has_height, is_over;
    uint64_t seen_at; /* value of geojson.times at its newest row */
};

struct geojson {
    FILE *file;
    struct local_frame *frame;
    double origin_alt_m;
    struct identity_numbers ids;
    struct track **tracks;  /* tracks by number; NULL: written already */
    size_t capacity, first; /* all tracks before `first` are written */
    uint64_t times;
    int64_t newest_us;
    bool has_features;
};

bool geojson_path_is_geojson(const char *path)
{
    return path && path_ends_with(path, ".geojson");
}

struct geojson *geojson_open(FILE *file, const struct parameters *parameters)
{
    struct geojson *geojson;

    if (!parameters_has_origin(parameters)) {
        fail(EXIT_USAGE, "GeoJSON has latitudes and longitudes: %s", parameters_no_origin);
    }
    geojson = must_calloc(1, sizeof *geojson);
    geojson->file = file;
    geojson->frame = parameters_open_local_frame(parameters);
    geojson->origin_alt_m = parameters->value[PARAMETER_ORIGIN_ALT_M];
    geojson->newest_us = INT64_MIN;
    return geojson;
}

/* Rounds to 1/steps, so that no more digits are written. */
static double round_to_steps(double value, double steps)
{
    return round(value * steps) / steps;
}

static void place_on_earth(const struct geojson *geojson, const struct track *track,
                           const float place_m[3], double on_earth[3])
{
    const double local_m[3] = {(double)place_m[0], (double)place_m[1], (double)place_m[2]};

    if (track->has_height) {
        local_frame_to_geodetic(geojson->frame, local_m, on_earth);
    } else {
        local_frame_at_height(geojson->frame, local_m[0], local_m[1], geojson->origin_alt_m,
                              on_earth);
    }
}

static cJSON *lon_lat_alt_json_array(const double on_earth[3], bool has_height)
{
    cJSON *position = cJSON_CreateArray();

    cJSON_AddItemToArray(position, cJSON_CreateNumber(round_to_steps(on_earth[1], 1e7)));
    cJSON_AddItemToArray(position, cJSON_CreateNumber(round_to_steps(on_earth[0], 1e7)));
    if (has_height) {
        cJSON_AddItemToArray(position, cJSON_CreateNumber(round_to_steps(on_earth[2], 100)));
    }
    return position;
}

static cJSON *time_in_seconds_json(double time_us)
{
    return cJSON_CreateNumber(time_us * 1e-6);
}

/*
 * Heading and climb at the target, where north and up differ from those at the origin: from two
 * positions a second apart.
 */
static void add_motion_properties(const struct geojson *geojson, const struct track *track,
                                  cJSON *properties)
{
    const float *state = track->last.state;
    double here[3], there[3], motion_mps[3];
    struct local_frame *own;

    place_on_earth(geojson, track, state, here);
    place_on_earth(geojson, track,
                   (const float[3]){state[0] + state[3], state[1] + state[4], state[2] + state[5]},
                   there);
    own = local_frame_open(here[0], here[1], here[2]);
    local_frame_to_local(own, there, motion_mps);
    local_frame_close(own);
    cJSON_AddNumberToObject(properties, "speed_mps",
                            round_to_steps(sqrt((double)state[3] * (double)state[3] +
                                                (double)state[4] * (double)state[4] +
                                                (double)state[5] * (double)state[5]),
                                           100));
    cJSON_AddNumberToObject(
        properties, "heading_deg",
        round_to_steps(fmod(atan2(motion_mps[0], motion_mps[1]) * 57.29577951308232 + 360, 360),
                       100));
    if (track->has_height) {
        cJSON_AddNumberToObject(properties, "climb_mps", round_to_steps(motion_mps[2], 100));
    }
}

static cJSON *properties_json(const struct geojson *geojson, const struct track *track,
                              const char *kind)
{
    cJSON *properties = cJSON_CreateObject();

    cJSON_AddNumberToObject(properties, "track_id", (double)(uint32_t)track->last.track_id);
    cJSON_AddStringToObject(properties, "kind", kind);
    cJSON_AddStringToObject(properties, "status", track->last.status);
    cJSON_AddBoolToObject(properties, "is_over", track->is_over);
    add_motion_properties(geojson, track, properties);
    cJSON_AddNumberToObject(properties, "sigma_m",
                            round_to_steps((double)track->last.sigma_m, 100));
    cJSON_AddNumberToObject(properties, "hits", track->last.hits);
    cJSON_AddNumberToObject(properties, "misses", track->last.misses);
    return properties;
}

static void write_feature(struct geojson *geojson, cJSON *geometry, cJSON *properties)
{
    cJSON *feature = cJSON_CreateObject();
    char *text;

    cJSON_AddStringToObject(feature, "type", "Feature");
    cJSON_AddItemToObject(feature, "geometry", geometry);
    cJSON_AddItemToObject(feature, "properties", properties);
    text = cJSON_PrintUnformatted(feature);
    if (!text) {
        fail(EXIT_RUNTIME, "out of memory");
    }
    fputs(geojson->has_features ? ",\n" : "{\"type\":\"FeatureCollection\",\"features\":[\n",
          geojson->file);
    fputs(text, geojson->file);
    geojson->has_features = true;
    cJSON_free(text);
    cJSON_Delete(feature);
}

static cJSON *geometry_json(const char *type, cJSON *coordinates)
{
    cJSON *geometry = cJSON_CreateObject();

    cJSON_AddStringToObject(geometry, "type", type);
    cJSON_AddItemToObject(geometry, "coordinates", coordinates);
    return geometry;
}

/* A line under construction: its pieces, the newest piece, and the times of all positions. */
struct line {
    cJSON *pieces, *piece, *times;
    double on_earth[3], time_us; /* newest position and its time */
    bool has_any;
};

static void add_line_position(struct line *line, const double on_earth[3], double time_us,
                              bool has_height)
{
    cJSON_AddItemToArray(line->piece, lon_lat_alt_json_array(on_earth, has_height));
    cJSON_AddItemToArray(line->times, time_in_seconds_json(time_us));
}

static void begin_line_piece(struct line *line)
{
    line->piece = cJSON_CreateArray();
    cJSON_AddItemToArray(line->pieces, line->piece);
}

/* Ends the piece at longitude 180, and begins the next one on the other side (RFC 7946, 3.1.9). */
static void cut_line_at_180(struct line *line, const double on_earth[3], double time_us,
                            bool has_height)
{
    double side = line->on_earth[1] > 0 ? 180 : -180;
    double step_deg = on_earth[1] + 2 * side - line->on_earth[1];
    double share = (side - line->on_earth[1]) / step_deg;
    double at[3] = {line->on_earth[0] + share * (on_earth[0] - line->on_earth[0]), side,
                    line->on_earth[2] + share * (on_earth[2] - line->on_earth[2])};
    double at_us = line->time_us + share * (time_us - line->time_us);

    add_line_position(line, at, at_us, has_height);
    begin_line_piece(line);
    at[1] = -side;
    add_line_position(line, at, at_us, has_height);
}

static void write_track_line(struct geojson *geojson, const struct track *track)
{
    struct line line = {.pieces = cJSON_CreateArray(), .times = cJSON_CreateArray()};
    cJSON *properties = properties_json(geojson, track, "track");
    bool is_one;

    begin_line_piece(&line);
    for (size_t i = 0; i < track->count; i++) {
        double on_earth[3], time_us = (double)track->points[i].time_us;

        place_on_earth(geojson, track, track->points[i].place_m, on_earth);
        if (line.has_any && fabs(on_earth[1] - line.on_earth[1]) > 180) {
            cut_line_at_180(&line, on_earth, time_us, track->has_height);
        }
        add_line_position(&line, on_earth, time_us, track->has_height);
        memcpy(line.on_earth, on_earth, sizeof line.on_earth);
        line.time_us = time_us;
        line.has_any = true;
    }
    cJSON_AddItemToObject(properties, "t_s", line.times);
    is_one = cJSON_GetArraySize(line.pieces) == 1;
    write_feature(geojson,
                  geometry_json(is_one ? "LineString" : "MultiLineString",
                                is_one ? cJSON_DetachItemFromArray(line.pieces, 0) : line.pieces),
                  properties);
    if (is_one) {
        cJSON_Delete(line.pieces);
    }
}

static void write_last_place(struct geojson *geojson, const struct track *track)
{
    cJSON *properties = properties_json(geojson, track, "place");
    double on_earth[3];

    cJSON_AddItemToObject(properties, "t_s", time_in_seconds_json((double)track->last.time_us));
    place_on_earth(geojson, track, track->last.state, on_earth);
    write_feature(geojson,
                  geometry_json("Point", lon_lat_alt_json_array(on_earth, track->has_height)),
                  properties);
}

/* Writes the track's line, if it has two positions, and its last position, and frees the track. */
static void write_and_free_track(struct geojson *geojson, struct track *track)
{
    if (track->was_confirmed && track->count > 1) {
        write_track_line(geojson, track);
    }
    if (track->was_confirmed) {
        write_last_place(geojson, track);
    }
    free(track->points);
    free(track);
}

static struct track *find_or_add_track(struct geojson *geojson, int32_t track_id)
{
    size_t known = geojson->ids.count;
    size_t number = identity_numbers_find_or_add(&geojson->ids, track_id);

    if (number == known) {
        geojson->tracks = must_make_room_for_one(geojson->tracks, known, &geojson->capacity,
                                                 sizeof(struct track *));
        geojson->tracks[number] = NULL;
    }
    if (!geojson->tracks[number]) {
        geojson->tracks[number] = must_calloc(1, sizeof(struct track));
        geojson->first = number < geojson->first ? number : geojson->first;
    }
    return geojson->tracks[number];
}

void geojson_add_row(struct geojson *geojson, const struct geojson_row *row)
{
    struct track *track = find_or_add_track(geojson, row->track_id);

    geojson->newest_us = row->time_us > geojson->newest_us ? row->time_us : geojson->newest_us;
    if (strcmp(row->status, "deleted") == 0) {
        track->is_over = true;
        return;
    }
    track->seen_at = geojson->times;
    if (track->was_confirmed && strcmp(row->status, "tentative") == 0) {
        return; /* in doubt: where it is, is not known */
    }
    track->points = must_make_room_for_one(track->points, track->count, &track->capacity,
                                           sizeof *track->points);
    track->points[track->count] = (struct point){.time_us = row->time_us};
    memcpy(track->points[track->count++].place_m, row->state, sizeof(float[3]));
    track->last = *row;
    track->was_confirmed |= strcmp(row->status, "tentative") != 0;
    track->has_height |= row->state[2] != 0.0f || row->state[5] != 0.0f;
}

void geojson_end_time(struct geojson *geojson)
{
    for (size_t i = geojson->first; i < geojson->ids.count; i++) {
        struct track *track = geojson->tracks[i];

        if (track && track->seen_at != geojson->times) {
            track->is_over = true;
            write_and_free_track(geojson, track);
            geojson->tracks[i] = NULL;
        }
    }
    while (geojson->first < geojson->ids.count && !geojson->tracks[geojson->first]) {
        geojson->first++;
    }
    geojson->times++;
}

void geojson_end_and_free(struct geojson *geojson)
{
    for (size_t i = geojson->first; i < geojson->ids.count; i++) {
        struct track *track = geojson->tracks[i];

        if (track) {
            track->is_over |= track->last.time_us < geojson->newest_us;
            write_and_free_track(geojson, track);
        }
    }
    fputs(geojson->has_features ? "\n]}\n" : "{\"type\":\"FeatureCollection\",\"features\":[]}\n",
          geojson->file);
    identity_numbers_free(&geojson->ids);
    free(geojson->tracks);
    local_frame_close(geojson->frame);
    free(geojson);
}
