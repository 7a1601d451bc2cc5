/* SPDX-License-Identifier: MIT */
/*
 * GeoJSON maps of tracks: which features there are, when they are written, and lines cut at
 * longitude 180.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cjson/cJSON.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/output/geojson_tracks_writer.h"

#define S 1000000 /* microseconds in a second */

/* A map written to memory. */
struct map {
    struct parameters parameters;
    char *text;
    size_t bytes;
    FILE *file;
    struct geojson *geojson;
};

static void open_map(struct map *map, const char *lat_deg, const char *lon_deg)
{
    char reason[PARAMETER_REASON_BYTES];

    *map = (struct map){.text = NULL};
    parameters_set_defaults(&map->parameters);
    assert_true(parameters_assign(&map->parameters, "origin_lat_deg", lat_deg, SOURCE_SET, reason));
    assert_true(parameters_assign(&map->parameters, "origin_lon_deg", lon_deg, SOURCE_SET, reason));
    map->file = open_memstream(&map->text, &map->bytes);
    map->geojson = geojson_open(map->file, &map->parameters);
}

static void add_row(struct map *map, int32_t track_id, int second, const char *status, float x_m,
                    float z_m)
{
    const struct geojson_row row = {.time_us = (int64_t)second * S,
                                    .track_id = track_id,
                                    .status = status,
                                    .state = {x_m, 0, z_m, 100, 0, 0},
                                    .sigma_m = 5,
                                    .hits = second};

    geojson_add_row(map->geojson, &row);
}

static cJSON *close_and_parse_map(struct map *map)
{
    cJSON *root;

    geojson_end_and_free(map->geojson);
    assert_int_equal(fclose(map->file), 0);
    root = cJSON_Parse(map->text);
    free(map->text);
    assert_non_null(root);
    assert_string_equal(cJSON_GetObjectItem(root, "type")->valuestring, "FeatureCollection");
    return root;
}

static const cJSON *feature_at(const cJSON *root, int index)
{
    return cJSON_GetArrayItem(cJSON_GetObjectItem(root, "features"), index);
}

static int num_features(const cJSON *root)
{
    return cJSON_GetArraySize(cJSON_GetObjectItem(root, "features"));
}

static const cJSON *property_of_feature(const cJSON *root, int index, const char *name)
{
    const cJSON *properties = cJSON_GetObjectItem(feature_at(root, index), "properties");
    const cJSON *item = cJSON_GetObjectItem(properties, name);

    assert_non_null(item);
    return item;
}

static const cJSON *coordinates_of_feature(const cJSON *root, int index, const char *type)
{
    const cJSON *geometry = cJSON_GetObjectItem(feature_at(root, index), "geometry");

    assert_string_equal(cJSON_GetObjectItem(geometry, "type")->valuestring, type);
    return cJSON_GetObjectItem(geometry, "coordinates");
}

static double number_at(const cJSON *array, int index)
{
    return cJSON_GetArrayItem(array, index)->valuedouble;
}

static void a_track_becomes_a_line_and_a_point(void **state)
{
    struct map map;
    cJSON *root;
    const cJSON *place;

    (void)state;
    open_map(&map, "50", "10");
    add_row(&map, 7, 1, "tentative", 0, 500);
    add_row(&map, 7, 2, "confirmed", 100, 500);
    add_row(&map, 7, 3, "coasting", 200, 500);
    root = close_and_parse_map(&map);
    assert_int_equal(num_features(root), 2);
    assert_int_equal(cJSON_GetArraySize(coordinates_of_feature(root, 0, "LineString")), 3);
    assert_int_equal(cJSON_GetArraySize(property_of_feature(root, 0, "t_s")), 3);
    place = coordinates_of_feature(root, 1, "Point");
    /* longitude first; 200 m east at 50 degrees north */
    assert_true(fabs(number_at(place, 0) - 10 - 200 / 71695.0) < 1e-6);
    assert_true(fabs(number_at(place, 1) - 50) < 1e-6);
    assert_true(fabs(number_at(place, 2) - 500) < 0.02);
    assert_true(property_of_feature(root, 1, "t_s")->valuedouble == 3);
    assert_string_equal(property_of_feature(root, 1, "status")->valuestring, "coasting");
    assert_true(fabs(property_of_feature(root, 1, "heading_deg")->valuedouble - 90) < 0.01);
    assert_true(property_of_feature(root, 1, "speed_mps")->valuedouble == 100);
    assert_true(cJSON_IsFalse(property_of_feature(root, 1, "is_over")));
    cJSON_Delete(root);
}

static void tracks_never_confirmed_are_left_out(void **state)
{
    struct map map;
    cJSON *root;

    (void)state;
    open_map(&map, "50", "10");
    for (int second = 0; second < 9; second++) {
        add_row(&map, 1, second, "tentative", 0, 0);
    }
    root = close_and_parse_map(&map);
    assert_int_equal(num_features(root), 0);
    cJSON_Delete(root);
}

static void a_track_of_one_row_becomes_a_point_alone(void **state)
{
    struct map map;
    cJSON *root;

    (void)state;
    open_map(&map, "50", "10");
    add_row(&map, 1, 0, "confirmed", 0, 0);
    root = close_and_parse_map(&map);
    assert_int_equal(num_features(root), 1);
    assert_int_equal(cJSON_GetArraySize(coordinates_of_feature(root, 0, "Point")),
                     2); /* without a height */
    cJSON_Delete(root);
}

/* Tracks that a time does not list have ended and are written at once. */
static void a_track_is_written_once_it_has_ended(void **state)
{
    struct map map;
    cJSON *root;
    size_t before;

    (void)state;
    open_map(&map, "50", "10");
    for (int second = 0; second < 4; second++) {
        add_row(&map, 1, second, "confirmed", 0, 0);
        if (second < 2) {
            add_row(&map, 2, second, "confirmed", 500, 0);
        }
        if (second == 2) {
            fflush(map.file);
            before = map.bytes;
        }
        geojson_end_time(map.geojson);
    }
    fflush(map.file);
    assert_int_equal(before, 0);
    assert_true(map.bytes > 100);
    root = close_and_parse_map(&map);
    assert_int_equal(num_features(root), 4);
    assert_true(property_of_feature(root, 0, "track_id")->valuedouble == 2);
    assert_true(cJSON_IsTrue(property_of_feature(root, 0, "is_over")));
    assert_true(property_of_feature(root, 2, "track_id")->valuedouble == 1);
    assert_true(cJSON_IsFalse(property_of_feature(root, 2, "is_over")));
    cJSON_Delete(root);
}

static void rows_of_status_deleted_add_no_point(void **state)
{
    struct map map;
    cJSON *root;

    (void)state;
    open_map(&map, "50", "10");
    add_row(&map, 1, 0, "confirmed", 0, 0);
    add_row(&map, 1, 1, "confirmed", 100, 0);
    add_row(&map, 1, 2, "deleted", 0, 0);
    root = close_and_parse_map(&map);
    assert_int_equal(cJSON_GetArraySize(coordinates_of_feature(root, 0, "LineString")), 2);
    assert_string_equal(property_of_feature(root, 0, "status")->valuestring, "confirmed");
    assert_true(cJSON_IsTrue(property_of_feature(root, 0, "is_over")));
    cJSON_Delete(root);
}

/* From 300 m west of the longitude to 100 m east in 4 s: the crossing is after 3 s. */
static void check_line_cut_at_180(const char *lon_deg, float from_x_m, float to_x_m,
                                  double side_deg)
{
    struct map map;
    cJSON *root;
    const cJSON *pieces, *times;

    open_map(&map, "0", lon_deg);
    add_row(&map, 1, 10, "confirmed", from_x_m, 0);
    add_row(&map, 1, 14, "confirmed", to_x_m, 0);
    root = close_and_parse_map(&map);
    pieces = coordinates_of_feature(root, 0, "MultiLineString");
    times = property_of_feature(root, 0, "t_s");
    assert_int_equal(cJSON_GetArraySize(pieces), 2);
    assert_int_equal(cJSON_GetArraySize(times), 4);
    for (int i = 0; i < 2; i++) {
        const cJSON *piece = cJSON_GetArrayItem(pieces, i);

        assert_int_equal(cJSON_GetArraySize(piece), 2);
        assert_true(number_at(cJSON_GetArrayItem(piece, 1 - i), 0) == (i ? -side_deg : side_deg));
        assert_true(fabs(number_at(times, 1 + i) - 13) < 0.001);
    }
    cJSON_Delete(root);
}

static void lines_are_cut_at_longitude_180(void **state)
{
    (void)state;
    check_line_cut_at_180("180", -300, 100, 180);
    check_line_cut_at_180("-180", 300, -100, -180);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_track_becomes_a_line_and_a_point),
        cmocka_unit_test(tracks_never_confirmed_are_left_out),
        cmocka_unit_test(a_track_of_one_row_becomes_a_point_alone),
        cmocka_unit_test(a_track_is_written_once_it_has_ended),
        cmocka_unit_test(rows_of_status_deleted_add_no_point),
        cmocka_unit_test(lines_are_cut_at_longitude_180),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
