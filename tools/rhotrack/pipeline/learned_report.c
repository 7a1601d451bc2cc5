/* SPDX-License-Identifier: MIT */
#include "pipeline/learned_report.h"

#include <cjson/cJSON.h>
#include <inttypes.h>
#include <math.h>

#include "base/common.h"

static void print_learned_walls(const struct rho_reflector_learning *walls, FILE *to)
{
    struct rho_reflector wall;

    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        if (rho_reflector_learning_wall(walls, i, &wall)) {
            fprintf(to, ", a wall is learned: %.1f %.1f %.1f %.1f", (double)wall.from_x_m,
                    (double)wall.from_y_m, (double)wall.to_x_m, (double)wall.to_y_m);
        }
    }
}

unsigned learned_report_num_standing(const struct rho_clutter_map *map)
{
    const struct rho_echo *echo;
    uint32_t place = 0;
    unsigned count = 0;

    while ((echo = rho_clutter_map_next_known(map, &place))) {
        count += rho_clutter_map_is_echo_standing(echo) != 0;
    }
    return count;
}

void learned_report_print(const struct rho_tracker *tracker,
                          const struct rho_reflector_learning *walls, FILE *to)
{
    for (uint32_t i = 0; i < tracker->num_sensors; i++) {
        const struct rho_sensor *sensor = &tracker->sensors[i].sensor;
        struct rho_tracker_known known;
        float least = sensor->pd;

        must_succeed(rho_tracker_known_of(tracker, sensor->sensor_id, &known), "sensor");
        for (int ring = 0; ring < RHO_LEARN_RINGS; ring++) {
            least = known.pd[ring] < least ? known.pd[ring] : least;
        }
        if (fabsf(known.range_factor - 1) + fabsf(known.cross_factor - 1) > 0) {
            fprintf(to, ", sensor %" PRId32 "'s noise is %.2f times as stated, across %.2f",
                    sensor->sensor_id, (double)known.range_factor, (double)known.cross_factor);
        }
        if (least < sensor->pd) {
            fprintf(to, ", sensor %" PRId32 "'s pd is down to %.2f", sensor->sensor_id,
                    (double)least);
        }
        if (known.lasting_rad > 0) {
            fprintf(to, ", sensor %" PRId32 "'s bearings have lasting errors of %.3f rad",
                    sensor->sensor_id, (double)known.lasting_rad);
        }
        if (known.notch_mps > 0) {
            fprintf(to, ", sensor %" PRId32 " is blind within %.1f m/s of zero Doppler",
                    sensor->sensor_id, (double)known.notch_mps);
        }
    }
    print_learned_walls(walls, to);
    if (learned_report_num_standing(&tracker->clutter_map) > 0) {
        fprintf(to, ", echoes that stand: %u", learned_report_num_standing(&tracker->clutter_map));
    }
}

struct cJSON *learned_report_sensors_json(const struct rho_tracker *tracker)
{
    cJSON *list = cJSON_CreateArray();

    for (uint32_t i = 0; i < tracker->num_sensors; i++) {
        const struct rho_sensor *sensor = &tracker->sensors[i].sensor;
        cJSON *object = cJSON_CreateObject(), *rings = cJSON_CreateArray();
        struct rho_tracker_known known;

        must_succeed(rho_tracker_known_of(tracker, sensor->sensor_id, &known), "sensor");
        cJSON_AddNumberToObject(object, "sensor_id", sensor->sensor_id);
        cJSON_AddNumberToObject(object, "sigma_range_factor", (double)known.range_factor);
        cJSON_AddNumberToObject(object, "sigma_cross_factor", (double)known.cross_factor);
        cJSON_AddNumberToObject(object, "innovations", known.innovations);
        cJSON_AddNumberToObject(object, "pd_stated", (double)sensor->pd);
        for (int ring = 0; ring < RHO_LEARN_RINGS; ring++) {
            cJSON_AddItemToArray(rings, cJSON_CreateNumber((double)known.pd[ring]));
        }
        cJSON_AddItemToObject(object, "pd", rings);
        cJSON_AddNumberToObject(object, "looks", known.looks);
        if (known.lasting_rad > 0) {
            cJSON_AddNumberToObject(object, "lasting_rad", (double)known.lasting_rad);
        }
        if (known.notch_mps > 0) {
            cJSON_AddNumberToObject(object, "notch_mps", (double)known.notch_mps);
        }
        if (known.resolution_range_sigmas > 0) {
            cJSON_AddNumberToObject(object, "resolution_range_sigmas",
                                    (double)known.resolution_range_sigmas);
        }
        if (known.resolution_cross_sigmas > 0) {
            cJSON_AddNumberToObject(object, "resolution_cross_sigmas",
                                    (double)known.resolution_cross_sigmas);
        }
        cJSON_AddItemToArray(list, object);
    }
    return list;
}

struct cJSON *learned_report_life_json(const struct rho_tracker *tracker)
{
    const struct rho_tracker_life life = rho_tracker_life(tracker);
    cJSON *object = cJSON_CreateObject(), *list = cJSON_CreateArray();

    cJSON_AddNumberToObject(object, "death_rate", (double)life.death);
    cJSON_AddNumberToObject(object, "hide_rate", (double)life.hide);
    cJSON_AddNumberToObject(object, "appear_rate", (double)life.appear);
    cJSON_AddNumberToObject(object, "lived_scans", (double)life.lived_scans);
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        cJSON *probabilities = cJSON_CreateObject();

        cJSON_AddNumberToObject(probabilities, "track_id", track->track_id);
        cJSON_AddNumberToObject(probabilities, "existence", (double)rho_track_existence(track));
        cJSON_AddNumberToObject(probabilities, "visibility", (double)track->visible);
        cJSON_AddItemToArray(list, probabilities);
    }
    cJSON_AddItemToObject(object, "tracks", list);
    return object;
}

unsigned learned_report_num_walls(const struct rho_reflector_learning *walls)
{
    struct rho_reflector wall;
    unsigned count = 0;

    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        count += rho_reflector_learning_wall(walls, i, &wall) != 0;
    }
    return count;
}

struct cJSON *learned_report_walls_json(const struct rho_reflector_learning *walls)
{
    cJSON *list = cJSON_CreateArray();
    struct rho_reflector wall;

    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        if (rho_reflector_learning_wall(walls, i, &wall)) {
            const double places[4] = {(double)wall.from_x_m, (double)wall.from_y_m,
                                      (double)wall.to_x_m, (double)wall.to_y_m};
            cJSON *object = cJSON_CreateObject();

            cJSON_AddItemToObject(object, "from_m", cJSON_CreateDoubleArray(places, 2));
            cJSON_AddItemToObject(object, "to_m", cJSON_CreateDoubleArray(places + 2, 2));
            cJSON_AddNumberToObject(object, "witnesses", walls->lines[i].witnesses_for);
            cJSON_AddItemToArray(list, object);
        }
    }
    return list;
}
