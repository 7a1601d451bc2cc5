/* SPDX-License-Identifier: MIT */
/*
 * geojson: tracks as GeoJSON (RFC 7946) for maps: QGIS, geojson.io, Leaflet.
 *
 * A FeatureCollection with two features for each track that was ever confirmed: its way as a
 * LineString (cut into a MultiLineString where it crosses longitude 180), and its last place as a
 * Point. Positions are longitude, latitude and, of tracks with heights, metres above the WGS 84
 * ellipsoid; tracks without heights are put at the origin's height. Properties of both: track_id,
 * kind ("track", "place"), status (the last one), is_over, speed_mps, heading_deg (clockwise from
 * true north at the target), climb_mps (of tracks with heights), sigma_m, hits, misses. A line has
 * t_s, the time of each of its positions; a place has t_s of its own.
 *
 * A track is written when it is over. Memory: 24 bytes for each row of those that go on.
 */
#ifndef RHOTRACK_TOOL_GEOJSON_H
#define RHOTRACK_TOOL_GEOJSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "settings/parameters.h"

struct geojson;

/* A track at a time, in the local frame. */
struct geojson_row {
    int64_t time_us;
    int32_t track_id;
    const char *
        /* "tentative" ...; a track that is "deleted" is over, and the row is no place of it */
        status;
    float state[6]; /* x, y, z, vx, vy, vz */
    float sigma_m;
    int hits, misses;
};

/* Begins the collection. Exit 2 without an origin. The file stays the caller's. */
struct geojson *geojson_open(FILE *file, const struct parameters *parameters);

/* A track's rows come in the order of time; those of other tracks may stand between them. */
void geojson_add_row(struct geojson *geojson, const struct geojson_row *row);

/* All tracks of a time have been added: those that go on. The others are over, and are written. */
void geojson_end_time(struct geojson *geojson);

/* Writes those that are left, and ends the collection. */
void geojson_close(struct geojson *geojson);

/* Whether an output of this name is GeoJSON: NAME.geojson. */
bool geojson_path_is_geojson(const char *path);

#endif
