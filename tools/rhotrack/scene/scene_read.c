/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "base/common.h"
#include "base/portable_math.h"
#include "scene/scene.h"

#define VERSION 1
#define PLACE_MAX_M 2e6
#define RANGE_MAX_M 2e6
#define DURATION_MAX_S 1e6
#define PLOTS_MAX 1e5

static struct scene_coverage read_coverage(struct json_object *object,
                                           struct scene_coverage otherwise)
{
    struct scene_coverage coverage = otherwise;
    double sector_rad[2];

    coverage.range_m = json_read_span(object, "range_m", 0, RANGE_MAX_M, otherwise.range_m);
    if (json_read_numbers(object, "sector_rad", 2, -PORTABLE_TURN, PORTABLE_TURN, sector_rad)) {
        coverage.has_sector = true;
        coverage.from_rad = sector_rad[0];
        coverage.to_rad = sector_rad[1];
    }
    return coverage;
}

static void read_from_and_until(struct json_object *object, double *from_s, double *until_s)
{
    *from_s = json_read_number(object, "from_s", -DURATION_MAX_S, DURATION_MAX_S, -INFINITY);
    *until_s = json_read_number(object, "until_s", -DURATION_MAX_S, DURATION_MAX_S, INFINITY);
    if (*until_s <= *from_s) {
        json_fail_key(object, "until_s", "is not after from_s");
    }
}

/* Reads "sensors": [1, 3] as a bit mask of sensor indices; all bits where the key is missing. */
static uint32_t read_sensor_mask(struct json_object *object, const struct scene *scene)
{
    struct json_list list = json_read_list(object, "sensors", 2 * SCENE_SENSORS_MAX);
    uint32_t sensors = 0;

    for (size_t i = 0; i < list.count; i++) {
        double id = json_element_number(&list, i, 0, 32767);
        size_t index = 0;

        while (index < scene->num_sensors && scene->sensors[index].sensor_id != id) {
            index++;
        }
        if (index == scene->num_sensors) {
            json_fail(&list.place, "there is no sensor %g", id);
        }
        sensors |= UINT32_C(1) << index;
    }
    return list.item ? sensors : UINT32_MAX;
}

/* Reads a probability: a number, or a list [[range, probability], ...] with ascending ranges. */
static struct scene_curve read_pd_curve(struct json_object *object, const char *key,
                                        double otherwise)
{
    struct scene_curve curve = {.count = 1, .value = {otherwise}};

    if (json_has_key(object, key) &&
        cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(object->item, key))) {
        struct json_list list = json_read_list(object, key, SCENE_CURVE_MAX);

        if (list.count == 0) {
            json_fail(&list.place, "is empty");
        }
        for (curve.count = 0; curve.count < list.count; curve.count++) {
            double point[2];

            json_element_numbers(&list, curve.count, 2, 0, RANGE_MAX_M, point);
            if (point[1] > 1.0) {
                json_fail(&list.place, "a probability of %.10g is above 1", point[1]);
            }
            if (curve.count > 0 && point[0] <= curve.range_m[curve.count - 1]) {
                json_fail(&list.place, "ranges must increase");
            }
            curve.range_m[curve.count] = point[0];
            curve.value[curve.count] = point[1];
        }
    } else {
        curve.value[0] = json_read_number(object, key, 0, 1, otherwise);
    }
    return curve;
}

/* Reads "told", what a tracker is told about a sensor; by default the truth, except biases. */
static void read_told_values(struct json_object *object, struct scene_sensor *sensor)
{
    struct scene_stated *told = &sensor->told;
    struct json_object below;

    *told = (struct scene_stated){.x_m = sensor->x_m,
                                  .y_m = sensor->y_m,
                                  .pd = fmin(0.999, fmax(0.01, sensor->pd.value[0])),
                                  .sigma_m = sensor->sigma_m,
                                  .sigma_mps = sensor->sigma_mps,
                                  .sigma_range_m = sensor->sigma_range_m,
                                  .sigma_azimuth_rad = sensor->sigma_azimuth_rad,
                                  .sigma_range_rate_mps = sensor->sigma_range_rate_mps,
                                  .sigma_rad = sensor->sigma_rad,
                                  .sigma_elevation_rad = sensor->sigma_elevation_rad,
                                  .coverage = sensor->coverage,
                                  .notch = sensor->notch};
    if (!json_read_object(object, "told", &below)) {
        return;
    }
    told->pd = json_read_number(&below, "pd", 0.01, 0.999, told->pd);
    if (sensor->is_passive) {
        told->sigma_rad = json_read_number(&below, "sigma_rad", 1e-6, 0.5, told->sigma_rad);
        if (sensor->sigma_elevation_rad > 0.0) {
            told->sigma_elevation_rad = json_read_number(&below, "sigma_elevation_rad", 1e-6, 0.5,
                                                         told->sigma_elevation_rad);
        }
    } else if (sensor->is_cartesian) {
        told->sigma_m = json_read_number(&below, "sigma_m", 1e-3, 1e5, told->sigma_m);
        if (sensor->sigma_mps > 0.0) {
            told->sigma_mps = json_read_number(&below, "sigma_mps", 1e-3, 1e5, told->sigma_mps);
        }
    } else {
        told->sigma_range_m =
            json_read_number(&below, "sigma_range_m", 1e-3, 1e5, told->sigma_range_m);
        told->sigma_azimuth_rad =
            json_read_number(&below, "sigma_azimuth_rad", 1e-6, 0.5, told->sigma_azimuth_rad);
        told->sigma_range_rate_mps =
            json_read_number(&below, "sigma_range_rate_mps", 1e-3, 1e5, told->sigma_range_rate_mps);
        told->range_bias_m = json_read_number(&below, "range_bias_m", -1e4, 1e4, 0);
        told->notch = scene_notch_read_told(&below, told->notch);
    }
    json_read_xy(&below, "at_m", PLACE_MAX_M, &told->x_m, &told->y_m);
    told->azimuth_bias_rad = json_read_number(&below, "azimuth_bias_rad", -0.5, 0.5, 0);
    told->time_bias_s = json_read_number(&below, "time_bias_s", -10, 10, 0);
    told->coverage = read_coverage(&below, told->coverage);
    json_refuse_unknown_keys(&below);
}

/* Reads how the antenna rotates (turn_s), or that it sees everything at once every interval_s. */
static void read_antenna_motion(struct json_object *object, struct scene_sensor *sensor)
{
    json_exclude_keys(object, "turn_s", "interval_s");
    sensor->turns = json_has_key(object, "turn_s");
    sensor->turn_s = json_read_number(object, "turn_s", 1e-3, 3600, 0);
    sensor->turn_s = json_read_number(object, "interval_s", 1e-3, 3600, sensor->turn_s);
    if (!(sensor->turn_s > 0.0)) {
        json_fail(&object->place, "turn_s or interval_s is missing");
    }
    sensor->sectors = 1;
    if (sensor->turns) {
        sensor->sectors = (size_t)json_read_count(object, "sectors", 1, 360, 1);
        sensor->is_counter_clockwise = json_read_flag(object, "is_counter_clockwise", false);
        sensor->starts_rad =
            json_read_span(object, "start_rad", -PORTABLE_TURN, PORTABLE_TURN,
                           (struct json_span){PORTABLE_PI / 2.0, PORTABLE_PI / 2.0});
    }
    sensor->starts_s =
        json_read_span(object, "start_s", -3600, DURATION_MAX_S, (struct json_span){0, 0});
    sensor->start_s = sensor->starts_s.lo;
    sensor->start_rad = sensor->starts_rad.lo;
    sensor->late_share = json_read_number(object, "late_share", 0, 1, 0);
    sensor->late_s = json_read_number(object, "late_s", 0, 60, 0);
}

static void read_radar(struct json_object *object, struct scene_sensor *sensor)
{
    json_exclude_keys(object, "sigma_m", "sigma_range_m");
    sensor->is_cartesian = json_has_key(object, "sigma_m");
    sensor->sigma_m = json_read_number(object, "sigma_m", 1e-3, 1e5, 0);
    if (sensor->is_cartesian) {
        sensor->sigma_mps = json_read_number(object, "sigma_mps", 1e-3, 1e5, 0);
    } else {
        json_require_key(object, "sigma_range_m");
        json_require_key(object, "sigma_azimuth_rad");
        sensor->sigma_range_m = json_read_number(object, "sigma_range_m", 1e-3, 1e5, 0);
        sensor->sigma_azimuth_rad = json_read_number(object, "sigma_azimuth_rad", 1e-6, 0.5, 0);
        sensor->has_range_rate = json_has_key(object, "sigma_range_rate_mps");
        sensor->sigma_range_rate_mps =
            json_read_number(object, "sigma_range_rate_mps", 1e-3, 1e5, 0);
        sensor->range_rate_span_mps = json_read_number(object, "range_rate_span_mps", 0, 4e4, 0);
        sensor->notch = scene_notch_read(object);
        sensor->range_bias_m = json_read_number(object, "range_bias_m", -1e4, 1e4, 0);
        sensor->azimuth_bias_rad = json_read_number(object, "azimuth_bias_rad", -0.5, 0.5, 0);
        sensor->time_bias_s = json_read_number(object, "time_bias_s", -10, 10, 0);
        if (sensor->range_rate_span_mps > 0.0 && sensor->range_rate_span_mps < 1.0) {
            json_fail_key(object, "range_rate_span_mps", "must be 0 or 1 and more");
        }
    }
    sensor->resolution_m = json_read_number(object, "resolution_m", 0, 1e5, 0);
    if (!sensor->is_cartesian) {
        sensor->resolution_rad = json_read_number(object, "resolution_rad", 0, 1, 0);
        if (sensor->resolution_m > 0.0) {
            json_require_key(object, "resolution_rad");
        }
    }
}

static void read_passive_sensor(struct json_object *object, struct scene_sensor *sensor)
{
    double sector_rad[2] = {-PORTABLE_PI, PORTABLE_PI};

    sensor->is_passive = true;
    json_require_key(object, "sigma_rad");
    sensor->sigma_rad = json_read_number(object, "sigma_rad", 1e-6, 0.5, 0);
    sensor->sigma_elevation_rad = json_read_number(object, "sigma_elevation_rad", 1e-6, 0.5, 0);
    if (sensor->sigma_elevation_rad > 0.0) {
        sensor->z_m = json_read_number(object, "z_m", -PLACE_MAX_M, PLACE_MAX_M, 0);
    }
    sensor->azimuth_bias_rad = json_read_number(object, "azimuth_bias_rad", -0.5, 0.5, 0);
    sensor->time_bias_s = json_read_number(object, "time_bias_s", -10, 10, 0);
    sensor->sway_rad = json_read_number(object, "sway_rad", 0, 0.5, 0);
    sensor->sway_s = json_read_number(object, "sway_s", 0.1, 86400, 60);
    sensor->false_bearings = json_read_number(object, "false_bearings", 0, 250, 0);
    sensor->is_geometric = json_read_flag(object, "is_geometric", false);
    json_read_numbers(object, "false_sector_rad", 2, -PORTABLE_TURN, PORTABLE_TURN, sector_rad);
    sensor->false_from_rad = sector_rad[0];
    sensor->false_to_rad = sector_rad[1];
    if (sector_rad[0] > sector_rad[1]) {
        json_fail_key(object, "false_sector_rad", "the first is above the second");
    }
}

static void read_and_append_sensor(struct scene *scene, struct json_object *object, bool is_passive)
{
    struct scene_sensor *sensor = &scene->sensors[scene->num_sensors];
    const struct scene_coverage everywhere = {.range_m = {0, is_passive ? RANGE_MAX_M : 100e3}};

    json_read_text(object, "text", NULL);
    sensor->sensor_id =
        (int32_t)json_read_count(object, "sensor_id", 0, 32767, (uint64_t)scene->num_sensors + 1);
    for (size_t i = 0; i < scene->num_sensors; i++) {
        if (scene->sensors[i].sensor_id == sensor->sensor_id) {
            json_fail_key(object, "sensor_id", "sensor %d is defined twice", sensor->sensor_id);
        }
    }
    json_read_xy(object, "at_m", PLACE_MAX_M, &sensor->x_m, &sensor->y_m);
    read_antenna_motion(object, sensor);
    if (is_passive) {
        read_passive_sensor(object, sensor);
    } else {
        read_radar(object, sensor);
    }
    if (!sensor->is_cartesian) {
        sensor->coverage = read_coverage(object, everywhere);
    } else {
        sensor->coverage = (struct scene_coverage){.range_m = {0, 4 * RANGE_MAX_M}};
    }
    sensor->pd = read_pd_curve(object, "pd", 0.9);
    read_told_values(object, sensor);
    json_refuse_unknown_keys(object);
    if (!is_passive && scene->num_sensors > 0 &&
        scene->sensors[0].is_cartesian != sensor->is_cartesian) {
        json_fail(
            &object->place,
            "all radars must measure range and azimuth, or all must measure positions (sigma_m)");
    }
    scene->num_sensors++;
}

static void read_all_sensors(struct scene *scene, struct json_object *root)
{
    struct json_list radars = json_read_list(root, "radars", SCENE_SENSORS_MAX);
    struct json_list passive = json_read_list(root, "passive", SCENE_SENSORS_MAX);

    if (radars.count + passive.count == 0) {
        json_fail(&root->place, "no sensors: neither radars nor passive");
    }
    for (size_t i = 0; i < radars.count; i++) {
        struct json_object one = json_element(&radars, i);

        read_and_append_sensor(scene, &one, false);
    }
    scene->num_radars = scene->num_sensors;
    for (size_t i = 0; i < passive.count; i++) {
        struct json_object one = json_element(&passive, i);

        read_and_append_sensor(scene, &one, true);
        scene->has_elevations = scene->has_elevations ||
                                scene->sensors[scene->num_sensors - 1].sigma_elevation_rad > 0.0;
    }
}

static const struct scene_coverage anywhere = {.range_m = {0, 4 * RANGE_MAX_M}};

static void read_box_or_sector_of_clutter(struct json_object *object, struct scene_clutter *clutter)
{
    clutter->within = read_coverage(object, (struct scene_coverage){.range_m = {-1, -1}});
    clutter->has_box =
        json_read_numbers(object, "box_m", 4, -PLACE_MAX_M, PLACE_MAX_M, clutter->box_m);
    json_exclude_keys(object, "box_m", "range_m");
    json_exclude_keys(object, "box_m", "sector_rad");
    if (clutter->has_box &&
        (clutter->box_m[0] > clutter->box_m[1] || clutter->box_m[2] > clutter->box_m[3])) {
        json_fail_key(object, "box_m", "must be [x_min, x_max, y_min, y_max]");
    }
}

static void read_uniform_clutter(struct json_object *object, struct scene_clutter *clutter)
{
    json_exclude_keys(object, "plots", "plots_per_km2");
    if (!json_has_key(object, "plots_per_km2")) {
        json_require_key(object, "plots");
    }
    clutter->plots = json_read_number(object, "plots", 0, PLOTS_MAX, 0);
    clutter->plots_per_km2 = json_read_number(object, "plots_per_km2", 0, 1e4, 0);
    clutter->rate_max_mps = json_read_number(object, "range_rate_max_mps", 0, 2e4, 0);
    json_exclude_keys(object, "range_rate_max_mps", "range_rate_sigma_mps");
    clutter->rate_sigma_mps = json_read_number(object, "range_rate_sigma_mps", 0, 1e3, 0);
    read_box_or_sector_of_clutter(object, clutter);
}

static void read_moving_clutter_cell(struct json_object *object, struct scene_clutter *clutter)
{
    static const char *const shapes[] = {"gaussian", "disc"};

    json_require_key(object, "plots");
    json_require_key(object, "at_m");
    json_require_key(object, "radius_m");
    clutter->plots = json_read_number(object, "plots", 0, PLOTS_MAX, 0);
    clutter->is_disc = json_read_choice(object, "shape", shapes, 2, 0) == 1;
    clutter->radius_m = json_read_number(object, "radius_m", 1, PLACE_MAX_M, 0);
    json_read_xy(object, "at_m", PLACE_MAX_M, &clutter->x_m, &clutter->y_m);
    json_read_xy(object, "velocity_mps", 2e4, &clutter->vx_mps, &clutter->vy_mps);
    clutter->rate_sigma_mps = json_read_number(object, "range_rate_sigma_mps", 0, 1e3, 0);
}

static void read_standing_clutter(struct json_object *object, struct scene_clutter *clutter)
{
    struct json_list list = json_read_list(object, "places_m", 10000);

    json_exclude_keys(object, "count", "places_m");
    clutter->pd = json_read_number(object, "pd", 0, 1, 1);
    clutter->count = json_read_count(object, "count", 0, 10000, 0);
    read_box_or_sector_of_clutter(object, clutter);
    if (list.item) {
        clutter->count = list.count;
        clutter->places_m = must_calloc(list.count + 1, sizeof *clutter->places_m);
        for (size_t i = 0; i < list.count; i++) {
            json_element_numbers(&list, i, 2, -PLACE_MAX_M, PLACE_MAX_M, clutter->places_m[i]);
        }
    } else {
        json_require_key(object, "count");
    }
}

static void read_sea_spikes(struct json_object *object, struct scene_clutter *clutter)
{
    json_require_key(object, "born_per_s");
    json_require_key(object, "life_s");
    clutter->per_s = json_read_number(object, "born_per_s", 0, 1e4, 0);
    clutter->life_s = json_read_span(object, "life_s", 1e-3, 1e5, (struct json_span){0});
    clutter->pd = json_read_number(object, "pd", 0, 1, 1);
    clutter->speed_mps = json_read_number(object, "speed_mps", 0, 2e4, 0);
    read_box_or_sector_of_clutter(object, clutter);
}

static void read_strobe_clutter(struct json_object *object, struct scene_clutter *clutter)
{
    json_require_key(object, "plots");
    json_require_key(object, "azimuth_rad");
    json_require_key(object, "width_rad");
    clutter->plots = json_read_number(object, "plots", 0, PLOTS_MAX, 0);
    clutter->azimuth_rad =
        json_read_number(object, "azimuth_rad", -PORTABLE_TURN, PORTABLE_TURN, 0);
    clutter->width_rad = json_read_number(object, "width_rad", 0, PORTABLE_TURN, 0);
    clutter->azimuth_radps = json_read_number(object, "azimuth_radps", -10, 10, 0);
    clutter->within.range_m =
        json_read_span(object, "range_m", 0, RANGE_MAX_M, (struct json_span){-1, -1});
}

static void read_bird_flock(struct json_object *object, struct scene_clutter *clutter)
{
    json_require_key(object, "count");
    json_require_key(object, "at_m");
    json_require_key(object, "radius_m");
    clutter->count = json_read_count(object, "count", 0, 10000, 0);
    clutter->radius_m = json_read_number(object, "radius_m", 1, PLACE_MAX_M, 0);
    json_read_xy(object, "at_m", PLACE_MAX_M, &clutter->x_m, &clutter->y_m);
    json_read_xy(object, "velocity_mps", 2e4, &clutter->vx_mps, &clutter->vy_mps);
    clutter->speed_mps = json_read_number(object, "speed_mps", 0, 2e4, 0);
    clutter->pd = json_read_number(object, "pd", 0, 1, 1);
}

static void read_second_time_echoes(struct json_object *object, struct scene_clutter *clutter)
{
    json_require_key(object, "unambiguous_range_m");
    clutter->unambiguous_m = json_read_number(object, "unambiguous_range_m", 1, RANGE_MAX_M, 0);
    clutter->pd = json_read_number(object, "pd", 0, 1, 1);
    clutter->targets = targets_read(object, "targets");
}

static void read_clutter_about_targets(struct json_object *object, struct scene_clutter *clutter)
{
    json_require_key(object, "count");
    json_require_key(object, "width_rad");
    clutter->count = json_read_count(object, "count", 0, 10000, 0);
    clutter->width_rad = json_read_number(object, "width_rad", 0, PORTABLE_PI, 0);
}

/*
 * Checks that uniformly distributed clutter has an area, and that clutter drawn anew each scan is
 * not seen by a radar that measures velocities, which it does not have.
 */
static void check_clutter(const struct scene *scene, const struct json_object *object,
                          const struct scene_clutter *clutter)
{
    bool is_cartesian = scene->num_radars > 0 && scene->sensors[0].is_cartesian;
    bool is_drawn_anew = clutter->kind == CLUTTER_UNIFORM || clutter->kind == CLUTTER_CELL ||
                         clutter->kind == CLUTTER_STROBE;
    bool is_even = clutter->kind == CLUTTER_UNIFORM || clutter->kind == CLUTTER_SPIKES ||
                   (clutter->kind == CLUTTER_STANDING && !clutter->places_m);

    if (is_even && (is_cartesian || clutter->plots_per_km2 > 0.0) && !clutter->has_box &&
        !scene->has_area) {
        json_fail(&object->place, "needs box_m, or the scene's area");
    }
    for (size_t i = 0; is_drawn_anew && i < scene->num_radars; i++) {
        if (scene->sensors[i].sigma_mps > 0.0 && (clutter->sensors >> i & 1)) {
            json_fail_key(object, "kind", "has no velocities, which sensor %d measures (sigma_mps)",
                          scene->sensors[i].sensor_id);
        }
    }
}

static void read_and_append_clutter(struct scene *scene, struct json_object *object)
{
    static const char *const kinds[CLUTTER_KINDS] = {
        "uniform", "cell",  "standing",           "spikes",
        "strobe",  "flock", "second-time-around", "about-targets"};
    static void (*const readers[CLUTTER_KINDS])(struct json_object *, struct scene_clutter *) = {
        read_uniform_clutter,    read_moving_clutter_cell,  read_standing_clutter,
        read_sea_spikes,         read_strobe_clutter,       read_bird_flock,
        read_second_time_echoes, read_clutter_about_targets};
    struct scene_clutter *clutter = &scene->clutter[scene->num_clutter];

    json_require_key(object, "kind");
    json_read_text(object, "text", NULL);
    clutter->kind = (enum clutter_kind)json_read_choice(object, "kind", kinds, CLUTTER_KINDS, 0);
    clutter->sensors = read_sensor_mask(object, scene);
    clutter->within = anywhere;
    read_from_and_until(object, &clutter->from_s, &clutter->until_s);
    readers[clutter->kind](object, clutter);
    check_clutter(scene, object, clutter);
    json_refuse_unknown_keys(object);
    scene->num_clutter++;
}

static void read_outage_event(struct json_object *object, struct scene_event *event)
{
    json_require_key(object, "from_s");
    json_require_key(object, "until_s");
    event->is_silent = json_read_flag(object, "is_silent", true);
}

static void read_fades_event(struct json_object *object, struct scene_event *event)
{
    struct json_list list = json_read_list(object, "targets", 32);

    event->within = read_coverage(object, anywhere);
    event->pd = json_read_number(object, "pd", 0, 1, 0);
    event->per_hour = json_read_number(object, "per_hour", 0, 3600, 0);
    event->for_s = json_read_span(object, "for_s", 1e-3, 1e6, (struct json_span){0});
    if (event->per_hour > 0.0) {
        json_require_key(object, "for_s");
    }
    event->has_targets = list.item != NULL;
    for (size_t i = 0; i < list.count; i++) {
        double index = json_element_number(&list, i, 0, 31);

        if (index != floor(index)) {
            json_fail(&list.place, "%g is not an index of targets[]", index);
        }
        event->targets |= UINT32_C(1) << (unsigned)index;
    }
}

static void read_mask_event(struct json_object *object, struct scene_event *event)
{
    event->within = read_coverage(object, anywhere);
}

static void read_split_plots_event(struct json_object *object, struct scene_event *event)
{
    const struct json_span none = {0, 0};

    json_require_key(object, "share");
    event->share = json_read_number(object, "share", 0, 1, 0);
    event->range_sigmas = json_read_span(object, "range_sigmas", -1e3, 1e3, none);
    event->azimuth_sigmas = json_read_span(object, "azimuth_sigmas", -1e3, 1e3, none);
    event->range_m = json_read_span(object, "range_m", -1e5, 1e5, none);
    event->azimuth_rad = json_read_span(object, "azimuth_rad", -1, 1, none);
}

static void read_and_append_event(struct scene *scene, struct json_object *object)
{
    static const char *const kinds[EVENT_KINDS] = {"outage", "fades", "mask", "split"};
    static void (*const readers[EVENT_KINDS])(struct json_object *, struct scene_event *) = {
        read_outage_event, read_fades_event, read_mask_event, read_split_plots_event};
    struct scene_event *event = &scene->events[scene->num_events];

    json_require_key(object, "kind");
    json_read_text(object, "text", NULL);
    event->kind = (enum event_kind)json_read_choice(object, "kind", kinds, EVENT_KINDS, 0);
    event->sensors = read_sensor_mask(object, scene);
    read_from_and_until(object, &event->from_s, &event->until_s);
    readers[event->kind](object, event);
    json_refuse_unknown_keys(object);
    scene->num_events++;
}

/* Reads "settings": tracker parameters by the names that `rhotrack config` lists. */
static void read_tracker_settings(struct scene *scene, struct json_object *root)
{
    struct json_object settings;
    struct parameters parameters;
    size_t used = 0, room = 4096;

    scene->settings = must_calloc(room, 1);
    parameters_set_defaults(&parameters);
    scene->v_max_mps = parameters.value[PARAMETER_V_MAX_MPS];
    if (!json_read_object(root, "settings", &settings)) {
        return;
    }
    for (const cJSON *one = settings.item->child; one; one = one->next) {
        char value[64], reason[PARAMETER_REASON_BYTES];

        if (cJSON_IsNumber(one)) {
            snprintf(value, sizeof value, "%.9g", one->valuedouble);
        } else if (cJSON_IsString(one)) {
            snprintf(value, sizeof value, "%s", one->valuestring);
        } else {
            json_fail_key(&settings, one->string, "must be a number or a text");
        }
        if (strchr(one->string, '.') ||
            !parameters_assign(&parameters, one->string, value, SOURCE_CONFIG, reason)) {
            json_fail_key(
                &settings, one->string, "%s",
                strchr(one->string, '.')
                    ? "values that a tracker is given for a sensor belong in the sensor's `told`"
                    : reason);
        }
        if (used + strlen(one->string) + strlen(value) + 5 > room) {
            json_fail(&settings.place, "too many settings");
        }
        used += (size_t)sprintf(scene->settings + used, "%s = %s\n", one->string, value);
    }
    scene->v_max_mps = parameters.value[PARAMETER_V_MAX_MPS];
    if (parameters.value[PARAMETER_V_MIN_MPS] >= parameters.value[PARAMETER_V_MAX_MPS]) {
        json_fail(&settings.place, "v_min_mps must be below v_max_mps");
    }
}

/*
 * Checks the keys "goal" and "oracle", which only the lab uses, so that mistakes in them are found.
 */
static void check_lab_keys(struct json_object *root)
{
    static const char *const figures[] = {"completeness", "false_per_scan", "switches", "rms_m",
                                          "delay_scans"};
    struct json_object below;

    if (json_read_object(root, "goal", &below)) {
        for (size_t i = 0; i < sizeof figures / sizeof figures[0]; i++) {
            const cJSON *item = cJSON_GetObjectItemCaseSensitive(below.item, figures[i]);

            if (cJSON_IsNull(item)) {
                json_has_key(&below, figures[i]);
            } else {
                json_read_number(&below, figures[i], 0, 1e9, 0);
            }
        }
        json_refuse_unknown_keys(&below);
    }
    if (json_read_object(root, "oracle", &below)) {
        json_read_number(&below, "process_noise_mps2", 0, 1e3, 0);
        json_refuse_unknown_keys(&below);
    }
}

static void read_area(struct scene *scene, struct json_object *root)
{
    double *area_m = scene->area_m;

    scene->has_area = json_read_numbers(root, "area", 4, -PLACE_MAX_M, PLACE_MAX_M, area_m);
    if (scene->has_area && (area_m[0] >= area_m[1] || area_m[2] >= area_m[3])) {
        json_fail_key(root, "area", "must be [x_min, x_max, y_min, y_max]");
    }
}

static void check_scene_size(const struct scene *scene, const struct json_object *root)
{
    double scans = 0.0, plots = 0.0;

    for (size_t i = 0; i < scene->num_sensors; i++) {
        double turns = ceil(scene->duration_s / scene->sensors[i].turn_s);

        scans += turns * (double)scene->sensors[i].sectors;
        for (size_t k = 0; k < scene->num_clutter; k++) {
            plots += turns * (scene->clutter[k].plots + (double)scene->clutter[k].count);
        }
    }
    if (scans > SCENE_SCANS_MAX || plots > 1e8) {
        json_fail(&root->place, "%.3g scans with %.3g clutter plots are too many (1e7, 1e8)", scans,
                  plots);
    }
}

struct scene *scene_read(const char *name, char *text, size_t length, const char *const *sets,
                         size_t num_sets)
{
    struct json_file file = json_open(name, text, length);
    struct scene *scene = must_calloc(1, sizeof *scene);
    struct json_object root;
    struct json_list list;

    for (size_t i = 0; i < num_sets; i++) {
        json_assign_by_path(&file, sets[i]);
    }
    root = json_root(&file);
    scene->name = must_copy_text(name);
    json_require_key(&root, "version");
    if (json_read_count(&root, "version", 1, 1000, 1) != VERSION) {
        json_fail_key(&root, "version", "this program knows version %d", VERSION);
    }
    scene->title = must_copy_text(json_read_text(&root, "text", ""));
    json_require_key(&root, "duration_s");
    scene->duration_s = json_read_number(&root, "duration_s", 1e-3, DURATION_MAX_S, 0);
    read_area(scene, &root);
    read_tracker_settings(scene, &root);
    read_all_sensors(scene, &root);
    scene->targets = targets_read(&root, "targets");
    for (size_t i = 0; i < scene->targets.count; i++) {
        scene->has_heights = scene->has_heights || scene->targets.items[i].has_height;
    }
    if (scene->has_heights &&
        (scene->num_radars == 0 ? !scene->has_elevations : !scene->sensors[0].is_cartesian)) {
        json_fail_key(&root, "targets",
                      "heights are for radars with sigma_m, or sensors with sigma_elevation_rad");
    }
    list = json_read_list(&root, "clutter", SCENE_ITEMS_MAX);
    for (size_t i = 0; i < list.count; i++) {
        struct json_object one = json_element(&list, i);

        read_and_append_clutter(scene, &one);
    }
    scene->reflectors = scene_reflectors_read(&root);
    list = json_read_list(&root, "events", SCENE_ITEMS_MAX);
    for (size_t i = 0; i < list.count; i++) {
        struct json_object one = json_element(&list, i);

        read_and_append_event(scene, &one);
    }
    if (json_has_key(&root, "platforms") && json_read_list(&root, "platforms", 1000).count > 0) {
        json_fail_key(&root, "platforms", "sensors that move are not simulated yet");
    }
    check_lab_keys(&root);
    json_refuse_unknown_keys(&root);
    check_scene_size(scene, &root);
    json_close(&file);
    free(text);
    return scene;
}

void scene_free(struct scene *scene)
{
    for (size_t i = 0; i < scene->num_clutter; i++) {
        free(scene->clutter[i].places_m);
        targets_free(&scene->clutter[i].targets);
    }
    targets_free(&scene->targets);
    free(scene->settings);
    free(scene->title);
    free(scene->name);
    free(scene);
}
