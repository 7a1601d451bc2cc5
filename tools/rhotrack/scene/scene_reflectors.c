/* SPDX-License-Identifier: MIT */
#include "scene/scene_reflectors.h"

#include <math.h>

#include "base/portable_math.h"

#define PLACE_MAX_M 2e6

struct scene_reflectors scene_reflectors_read(struct json_object *root)
{
    struct json_list list = json_read_list(root, "reflectors", SCENE_REFLECTORS_MAX);
    struct scene_reflectors reflectors = {.count = list.count};

    for (size_t i = 0; i < list.count; i++) {
        struct json_object one = json_element(&list, i);
        struct scene_reflector *reflector = &reflectors.items[i];

        json_read_text(&one, "text", NULL);
        json_require_key(&one, "from_m");
        json_require_key(&one, "to_m");
        json_read_numbers(&one, "from_m", 2, -PLACE_MAX_M, PLACE_MAX_M, reflector->from_m);
        json_read_numbers(&one, "to_m", 2, -PLACE_MAX_M, PLACE_MAX_M, reflector->to_m);
        reflector->probability = json_read_number(&one, "probability", 0, 1, 1);
        reflector->is_told = json_read_flag(&one, "is_told", true);
        if (portable_hypot(reflector->to_m[0] - reflector->from_m[0],
                           reflector->to_m[1] - reflector->from_m[1]) < 1.0) {
            json_fail_key(&one, "to_m", "is less than 1 m from from_m");
        }
        json_refuse_unknown_keys(&one);
    }
    return reflectors;
}

bool scene_reflector_image(const struct scene_reflector *reflector, double sensor_x_m,
                           double sensor_y_m, const struct motion *at, struct motion *image)
{
    const double *from_m = reflector->from_m;
    double x = reflector->to_m[0] - from_m[0], y = reflector->to_m[1] - from_m[1];
    double length_m = portable_hypot(x, y), along_m, crossing_m, target_m, sensor_m, sensor_along_m;

    x /= length_m;
    y /= length_m;
    along_m = (at->x_m - from_m[0]) * x + (at->y_m - from_m[1]) * y;
    target_m = (at->y_m - from_m[1]) * x - (at->x_m - from_m[0]) * y;
    sensor_along_m = (sensor_x_m - from_m[0]) * x + (sensor_y_m - from_m[1]) * y;
    sensor_m = (sensor_y_m - from_m[1]) * x - (sensor_x_m - from_m[0]) * y;
    if (!(target_m * sensor_m > 0.0)) {
        return false;
    }
    crossing_m = sensor_along_m + (along_m - sensor_along_m) * sensor_m / (sensor_m + target_m);
    *image = *at;
    image->x_m += 2.0 * target_m * y;
    image->y_m -= 2.0 * target_m * x;
    along_m = at->vx_mps * x + at->vy_mps * y;
    image->vx_mps = 2.0 * along_m * x - at->vx_mps;
    image->vy_mps = 2.0 * along_m * y - at->vy_mps;
    return crossing_m >= 0.0 && crossing_m <= length_m;
}

void scene_reflectors_write_told(const struct scene_reflectors *reflectors, FILE *file)
{
    const char *before = "reflectors = ";

    for (size_t i = 0; i < reflectors->count; i++) {
        const struct scene_reflector *one = &reflectors->items[i];

        if (one->is_told) {
            fprintf(file, "%s%.9g %.9g %.9g %.9g", before, one->from_m[0], one->from_m[1],
                    one->to_m[0], one->to_m[1]);
            before = ", ";
        }
    }
    if (*before == ',') {
        fputc('\n', file);
    }
}
