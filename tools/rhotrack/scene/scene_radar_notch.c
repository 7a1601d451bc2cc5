/* SPDX-License-Identifier: MIT */
#include "scene/scene_radar_notch.h"

#include <math.h>

#define RATE_MAX_MPS 2e4

struct scene_notch scene_notch_read_told(struct json_object *object, struct scene_notch own)
{
    struct scene_notch notch = own;

    notch.mps = json_read_number(object, "notch_mps", 0, RATE_MAX_MPS, own.mps);
    notch.blind_mps = json_read_number(object, "blind_speed_mps", 0, RATE_MAX_MPS, own.blind_mps);
    if (notch.blind_mps > 0.0 && notch.blind_mps <= 2.0 * notch.mps) {
        json_fail_key(object, "blind_speed_mps", "must be more than twice notch_mps");
    }
    return notch;
}

struct scene_notch scene_notch_read(struct json_object *object)
{
    struct scene_notch notch = scene_notch_read_told(object, (struct scene_notch){.pd = 0.0});

    notch.pd = json_read_number(object, "notch_pd", 0, 1, 0);
    return notch;
}

double scene_notch_pd(const struct scene_notch *notch, double range_rate_mps, double pd)
{
    double off_mps =
        notch->blind_mps > 0.0 ? remainder(range_rate_mps, notch->blind_mps) : range_rate_mps;

    return fabs(off_mps) < notch->mps ? fmin(pd, notch->pd) : pd;
}

void scene_notch_write_settings(const struct scene_notch *notch, FILE *file)
{
    if (notch->mps > 0.0) {
        fprintf(file, "notch_mps = %.9g\n", notch->mps);
    }
    if (notch->mps > 0.0 && notch->blind_mps > 0.0) {
        fprintf(file, "blind_speed_mps = %.9g\n", notch->blind_mps);
    }
}
