/* SPDX-License-Identifier: MIT */
/*
 * The reader of scenes in JSON (`simulate FILE.json`) and of --set, on any text: it is refused with
 * one line, or the scene's numbers are finite and within the lists and capacities of the scene, and
 * the paths of its targets can be drawn. Behind the file follow assignments of --set, each after a
 * byte 1.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "catch_reader_fail.h"
#include "check.h"
#include "scene/scene.h"

#define SETS_MAX 8
#define PATHS_MAX 16
#define BETWEEN 1 /* byte that separates the assignments */

struct reading {
    char *path;
    const char *sets[SETS_MAX];
    size_t num_sets;
};

static void check_number_range_is_finite(struct json_span span)
{
    CHECK(isfinite(span.lo) && isfinite(span.hi) && span.lo <= span.hi);
}

static void check_sensor(const struct scene *scene, size_t i)
{
    const struct scene_sensor *sensor = &scene->sensors[i];

    CHECK(sensor->is_passive == (i >= scene->num_radars));
    CHECK(isfinite(sensor->x_m) && isfinite(sensor->y_m));
    CHECK(sensor->turn_s > 0.0 && isfinite(sensor->turn_s) && sensor->sectors > 0);
    check_number_range_is_finite(sensor->starts_s);
    check_number_range_is_finite(sensor->starts_rad);
    for (size_t k = 0; k < i; k++) {
        CHECK(scene->sensors[k].sensor_id != sensor->sensor_id);
    }
}

/* Whether a source or an event names only sensors in the list (UINT32_MAX: all sensors). */
static bool are_known_sensors(const struct scene *scene, uint32_t sensors)
{
    return sensors == UINT32_MAX || (uint64_t)sensors >> scene->num_sensors == 0;
}

static void check_scene(const struct scene *scene)
{
    CHECK(scene->name && scene->title && scene->settings);
    CHECK(scene->duration_s > 0.0 && isfinite(scene->duration_s) && isfinite(scene->v_max_mps));
    CHECK(scene->num_radars <= scene->num_sensors && scene->num_sensors <= 2 * SCENE_SENSORS_MAX);
    CHECK(scene->num_clutter <= SCENE_ITEMS_MAX && scene->num_events <= SCENE_ITEMS_MAX);
    for (size_t i = 0; i < scene->num_sensors; i++) {
        check_sensor(scene, i);
    }
    for (size_t i = 0; i < scene->num_clutter; i++) {
        CHECK(scene->clutter[i].kind < CLUTTER_KINDS &&
              are_known_sensors(scene, scene->clutter[i].sensors));
        CHECK(isfinite(scene->clutter[i].plots) && isfinite(scene->clutter[i].plots_per_km2));
        check_number_range_is_finite(scene->clutter[i].life_s);
    }
    for (size_t i = 0; i < scene->num_events; i++) {
        CHECK(scene->events[i].kind < EVENT_KINDS &&
              are_known_sensors(scene, scene->events[i].sensors));
        check_number_range_is_finite(scene->events[i].for_s);
    }
    for (size_t i = 0; i < scene->targets.count; i++) {
        const struct target_item *item = &scene->targets.items[i], *parent;

        CHECK(!item->has_parent || item->parent < i);
        parent = &scene->targets.items[item->parent];
        CHECK(!item->has_parent || (parent->count == 0 && parent->flights == 0));
    }
}

/* Draws the paths of the first minute if there are few targets. */
static void draw_target_paths(const struct scene *scene)
{
    const double duration_s = scene->duration_s < 60.0 ? scene->duration_s : 60.0;
    struct scene_path *paths;
    size_t count = 0;

    for (size_t i = 0; i < scene->targets.count; i++) {
        count += 1 + scene->targets.items[i].count + scene->targets.items[i].flights;
    }
    if (count > PATHS_MAX) {
        return;
    }
    paths = targets_draw_paths(&scene->targets, scene->name, duration_s, 1, 0, 0, &count);
    for (size_t i = 0; i < count; i++) {
        CHECK(isfinite(path_motion_at(&paths[i], paths[i].from_s).x_m));
        path_free(&paths[i]);
    }
    free(paths);
}

static void read_scene(void *context)
{
    const struct reading *reading = context;
    struct scene *scene = scene_load_by_name(reading->path, reading->sets, reading->num_sets);

    CHECK(scene);
    check_scene(scene);
    draw_target_paths(scene);
    scene_free(scene);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static bool has_begun;
    struct reading reading = {0};
    size_t file_size = size;
    char *text, *at;

    if (!has_begun) {
        refusal_install_hooks();
        has_begun = true;
    }
    text = malloc(size + 1);
    CHECK(text);
    memcpy(text, data, size);
    text[size] = '\0';
    for (at = memchr(text, BETWEEN, size); at && reading.num_sets < SETS_MAX;
         at = strchr(at, BETWEEN)) {
        file_size = reading.num_sets > 0 ? file_size : (size_t)(at - text);
        *at++ = '\0';
        reading.sets[reading.num_sets++] = at;
    }
    reading.path = refusal_write_file(data, file_size);
    refusal_is_refused(read_scene, &reading);
    free(text);
    return 0;
}
