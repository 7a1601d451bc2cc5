/* SPDX-License-Identifier: MIT */
/*
 * geojson_tracks_writer: writes tracks as GeoJSON (RFC 7946) for maps: QGIS, geojson.io, Leaflet.
 *
 * A FeatureCollection with two features for each track that was ever confirmed: its path as a
 * LineString (cut into a MultiLineString where it crosses longitude 180), and its last position as
 * a Point. Coordinates are longitude, latitude and, for tracks with heights, metres above the WGS
 * 84 ellipsoid; tracks without heights are put at the origin's height. Properties of both:
 * track_id, kind ("track", "place"), status (the last one), is_over, speed_mps, heading_deg
 * (clockwise from true north at the target), climb_mps (of tracks with heights), sigma_m, hits,
 * misses. A line has t_s, the time of each of its positions; a point has its t_s.
 *
 * A track is written when it ends. Memory: 24 bytes for each row of the tracks that go on.
 */
#ifndef RHOTRACK_TOOL_GEOJSON_TRACKS_WRITER_H
#define RHOTRACK_TOOL_GEOJSON_TRACKS_WRITER_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "settings/parameters.h"

struct geojson;

/* State of one track at one time, in the local frame. */
struct geojson_row {
    int64_t time_us;
    int32_t track_id;
    /* "tentative" and so on; "deleted": the track has ended, and the row adds no position */
    const char *status;
    float state[6]; /* x, y, z, vx, vy, vz */
    float sigma_m;
    int hits, misses;
};

/* Begins the collection. Exit 2 without an origin. The caller keeps and closes the file. */
struct geojson *geojson_open(FILE *file, const struct parameters *parameters);

/*
 * Adds a row. Rows of one track must come in the order of time; rows of other tracks may be between
 * them.
 */
void geojson_add_row(struct geojson *geojson, const struct geojson_row *row);

/* Ends a time: tracks without a row since the call before have ended, and are written. */
void geojson_end_time(struct geojson *geojson);

/* Writes the remaining tracks, ends the collection, and frees the writer. */
void geojson_end_and_free(struct geojson *geojson);

/* Whether an output of this name is GeoJSON: it ends with .geojson. */
bool geojson_path_is_geojson(const char *path);

#endif
