/* SPDX-License-Identifier: MIT */
#include "scene/scene_body.h"

struct scene_body scene_body_read(struct json_object *object)
{
    struct scene_body body = {.scatterers = 0};
    struct json_object one;

    if (!json_read_object(object, "body", &one)) {
        return body;
    }
    json_require_key(&one, "length_m");
    json_require_key(&one, "width_m");
    json_require_key(&one, "scatterers");
    body.length_m = json_read_number(&one, "length_m", 0.01, 1e4, 0);
    body.width_m = json_read_number(&one, "width_m", 0.01, 1e4, 0);
    body.scatterers = json_read_count(&one, "scatterers", 1, SCENE_SCATTERERS_MAX, 0);
    body.seen = json_read_number(&one, "seen", 0, 1, 0.9);
    body.is_anew = json_read_flag(&one, "is_anew", false);
    body.limbs_mps = json_read_number(&one, "limbs_mps", 0, 100, 0);
    if (body.width_m > body.length_m) {
        json_fail_key(&one, "width_m", "is more than length_m");
    }
    json_refuse_unknown_keys(&one);
    return body;
}

void scene_body_draw_scatterers(const struct scene_body *body, struct random *random,
                                double places_m[SCENE_SCATTERERS_MAX][2])
{
    const double parts = (double)body->scatterers;

    for (size_t i = 0; i < body->scatterers; i++) {
        const size_t other = (size_t)random_below(random, i + 1);

        places_m[i][0] = ((double)i + random_uniform(random)) / parts - 0.5;
        places_m[i][0] *= body->length_m;
        /* the parts of the width are assigned in random order (shuffle) */
        places_m[i][1] = i > other ? places_m[other][1] : 0.0;
        places_m[other][1] = ((double)i + random_uniform(random)) / parts - 0.5;
        places_m[other][1] *= body->width_m;
    }
}
