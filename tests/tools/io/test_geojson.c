/* SPDX-License-Identifier: MIT */
/* Maps of tracks: which features there are, when they are written, what is cut at longitude 180. */
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

#include "io/output/geojson.h"

#define S 1000000 /* us */

/* A map in memory. */
struct map {
    struct parameters parameters;
    char *text;
    size_t bytes;
    FILE *file;
    struct geojson *geojson;
};

static void start(struct map *map, const char *lat_deg, const char *lon_deg)
{
    char reason[PARAMETER_REASON_BYTES];

    *map = (struct map){.text = NULL};
    parameters_set_defaults(&map->parameters);
    assert_true(parameters_assign(&map->parameters, "origin_lat_deg", lat_deg, SOURCE_SET, reason));
    assert_true(parameters_assign(&map->parameters, "origin_lon_deg", lon_deg, SOURCE_SET, reason));
    map->file = open_memstream(&map->text, &map->bytes);
    map->geojson = geojson_open(map->file, &map->parameters);
}

static void add(struct map *map, int32_t track_id, int second, const char *status, float x_m,
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

static cJSON *end(struct map *map)
{
    cJSON *root;

    geojson_close(map->geojson);
    assert_int_equal(fclose(map->file), 0);
    root = cJSON_Parse(map->text);
    free(map->text);
    assert_non_null(root);
    assert_string_equal(cJSON_GetObjectItem(root, "type")->valuestring, "FeatureCollection");
    return root;
}

static const cJSON *feature(const cJSON *root, int index)
{
    return cJSON_GetArrayItem(cJSON_GetObjectItem(root, "features"), index);
}

static int num_features(const cJSON *root)
{
    return cJSON_GetArraySize(cJSON_GetObjectItem(root, "features"));
}

static const cJSON *property(const cJSON *root, int index, const char *name)
{
    const cJSON *properties = cJSON_GetObjectItem(feature(root, index), "properties");
    const cJSON *item = cJSON_GetObjectItem(properties, name);

    assert_non_null(item);
    return item;
}

static const cJSON *coordinates(const cJSON *root, int index, const char *type)
{
    const cJSON *geometry = cJSON_GetObjectItem(feature(root, index), "geometry");

    assert_string_equal(cJSON_GetObjectItem(geometry, "type")->valuestring, type);
    return cJSON_GetObjectItem(geometry, "coordinates");
}

static double number(const cJSON *array, int index)
{
    return cJSON_GetArrayItem(array, index)->valuedouble;
}

static void a_track_is_a_line_and_a_place(void **state)
{
    struct map map;
    cJSON *root;
    const cJSON *place;

    (void)state;
    start(&map, "50", "10");
    add(&map, 7, 1, "tentative", 0, 500);
    add(&map, 7, 2, "confirmed", 100, 500);
    add(&map, 7, 3, "coasting", 200, 500);
    root = end(&map);
    assert_int_equal(num_features(root), 2);
    assert_int_equal(cJSON_GetArraySize(coordinates(root, 0, "LineString")), 3);
    assert_int_equal(cJSON_GetArraySize(property(root, 0, "t_s")), 3);
    place = coordinates(root, 1, "Point");
    /* longitude first; 200 m east at 50 degrees north */
    assert_true(fabs(number(place, 0) - 10 - 200 / 71695.0) < 1e-6);
    assert_true(fabs(number(place, 1) - 50) < 1e-6);
    assert_true(fabs(number(place, 2) - 500) < 0.02);
    assert_true(property(root, 1, "t_s")->valuedouble == 3);
    assert_string_equal(property(root, 1, "status")->valuestring, "coasting");
    assert_true(fabs(property(root, 1, "heading_deg")->valuedouble - 90) < 0.01);
    assert_true(property(root, 1, "speed_mps")->valuedouble == 100);
    assert_true(cJSON_IsFalse(property(root, 1, "is_over")));
    cJSON_Delete(root);
}

static void what_was_never_confirmed_is_left_out(void **state)
{
    struct map map;
    cJSON *root;

    (void)state;
    start(&map, "50", "10");
    for (int second = 0; second < 9; second++) {
        add(&map, 1, second, "tentative", 0, 0);
    }
    root = end(&map);
    assert_int_equal(num_features(root), 0);
    cJSON_Delete(root);
}

static void one_row_is_a_place_alone(void **state)
{
    struct map map;
    cJSON *root;

    (void)state;
    start(&map, "50", "10");
    add(&map, 1, 0, "confirmed", 0, 0);
    root = end(&map);
    assert_int_equal(num_features(root), 1);
    assert_int_equal(cJSON_GetArraySize(coordinates(root, 0, "Point")), 2); /* no height */
    cJSON_Delete(root);
}

/* Those that a time does not name are over, and written then and there. */
static void tracks_are_written_when_they_are_over(void **state)
{
    struct map map;
    cJSON *root;
    size_t before;

    (void)state;
    start(&map, "50", "10");
    for (int second = 0; second < 4; second++) {
        add(&map, 1, second, "confirmed", 0, 0);
        if (second < 2) {
            add(&map, 2, second, "confirmed", 500, 0);
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
    root = end(&map);
    assert_int_equal(num_features(root), 4);
    assert_true(property(root, 0, "track_id")->valuedouble == 2);
    assert_true(cJSON_IsTrue(property(root, 0, "is_over")));
    assert_true(property(root, 2, "track_id")->valuedouble == 1);
    assert_true(cJSON_IsFalse(property(root, 2, "is_over")));
    cJSON_Delete(root);
}

static void a_row_that_says_deleted_is_no_place(void **state)
{
    struct map map;
    cJSON *root;

    (void)state;
    start(&map, "50", "10");
    add(&map, 1, 0, "confirmed", 0, 0);
    add(&map, 1, 1, "confirmed", 100, 0);
    add(&map, 1, 2, "deleted", 0, 0);
    root = end(&map);
    assert_int_equal(cJSON_GetArraySize(coordinates(root, 0, "LineString")), 2);
    assert_string_equal(property(root, 0, "status")->valuestring, "confirmed");
    assert_true(cJSON_IsTrue(property(root, 0, "is_over")));
    cJSON_Delete(root);
}

/* From 300 m west of it to 100 m east, in 4 s: it is crossed after 3 s. */
static void check_cut(const char *lon_deg, float from_x_m, float to_x_m, double side_deg)
{
    struct map map;
    cJSON *root;
    const cJSON *pieces, *times;

    start(&map, "0", lon_deg);
    add(&map, 1, 10, "confirmed", from_x_m, 0);
    add(&map, 1, 14, "confirmed", to_x_m, 0);
    root = end(&map);
    pieces = coordinates(root, 0, "MultiLineString");
    times = property(root, 0, "t_s");
    assert_int_equal(cJSON_GetArraySize(pieces), 2);
    assert_int_equal(cJSON_GetArraySize(times), 4);
    for (int i = 0; i < 2; i++) {
        const cJSON *piece = cJSON_GetArrayItem(pieces, i);

        assert_int_equal(cJSON_GetArraySize(piece), 2);
        assert_true(number(cJSON_GetArrayItem(piece, 1 - i), 0) == (i ? -side_deg : side_deg));
        assert_true(fabs(number(times, 1 + i) - 13) < 0.001);
    }
    cJSON_Delete(root);
}

static void lines_are_cut_at_longitude_180(void **state)
{
    (void)state;
    check_cut("180", -300, 100, 180);
    check_cut("-180", 300, -100, -180);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_track_is_a_line_and_a_place),
        cmocka_unit_test(what_was_never_confirmed_is_left_out),
        cmocka_unit_test(one_row_is_a_place_alone),
        cmocka_unit_test(tracks_are_written_when_they_are_over),
        cmocka_unit_test(a_row_that_says_deleted_is_no_place),
        cmocka_unit_test(lines_are_cut_at_longitude_180),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
