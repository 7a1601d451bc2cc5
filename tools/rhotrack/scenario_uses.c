/* SPDX-License-Identifier: MIT */
/* Which scenarios use which of the parameters that are made for scenarios. */
#include <stdio.h>
#include <string.h>

#include "common.h"
#include "scenario.h"

#define TURNING "polar, doppler, rotating"

#define RADARS "two-radars"
#define WITH_AREA "air-traffic, " TURNING

struct use {
    enum parameter_id id;
    const char *scenarios; /* by ", " */
    const char *by_sensor; /* where it is set for each sensor alone */
};

/* All use num_scans and interval_s. */
static const struct use uses[] = {
    {PARAMETER_CLUTTER_PER_KM2, "air-traffic, polar, doppler", NULL},
    {PARAMETER_CLUTTER_PER_SCAN, "air-traffic, two-radars, " TURNING, NULL},
    {PARAMETER_TRUE_PD, "air-traffic, " TURNING, NULL},
    {PARAMETER_TRUE_SIGMA_M, "air-traffic", NULL},
    {PARAMETER_FADES_PER_HOUR, "air-traffic", NULL},
    {PARAMETER_FADE_SCANS, "air-traffic", NULL},
    {PARAMETER_SPOTS, "air-traffic", NULL},
    {PARAMETER_SPOT_CLUTTER, "air-traffic", NULL},
    {PARAMETER_PERSISTENT_SOURCES, "air-traffic", NULL},
    {PARAMETER_MERGE_M, "air-traffic", NULL},
    {PARAMETER_CROSSING_SHARE, "air-traffic", NULL},
    {PARAMETER_RANGE_RATE, TURNING, NULL},
    {PARAMETER_STATIC_CLUTTER, "doppler", NULL},
    {PARAMETER_TARGETS, "air-traffic, two-radars, " TURNING, NULL},
    {PARAMETER_SPACING_M, "two-radars", NULL},
    {PARAMETER_SECTORS_PER_TURN, "rotating, two-radars", NULL},
    {PARAMETER_SECOND_INTERVAL_S, "two-radars", NULL},
    {PARAMETER_TRUE_RANGE_BIAS_M, "two-radars", NULL},
    {PARAMETER_TRUE_AZIMUTH_BIAS_RAD, "two-radars", NULL},
    {PARAMETER_TRUE_TIME_BIAS_S, "two-radars", NULL},
    {PARAMETER_LATE_SHARE, "two-radars", NULL},
    {PARAMETER_LATE_MS, "two-radars", NULL},
};

/*
 * What trackers use, too, may come from a file that is theirs; by --set it is meant here. Others of theirs are not here: they
 * go to scenario.ini.
 */
static const struct use trackers_uses[] = {
    {PARAMETER_SIGMA_M, "air-traffic", NULL},       {PARAMETER_SIGMA_RANGE_M, TURNING, RADARS},
    {PARAMETER_SIGMA_AZIMUTH_RAD, TURNING, RADARS}, {PARAMETER_SIGMA_RANGE_RATE_MPS, TURNING, NULL},
    {PARAMETER_PD, "air-traffic", RADARS},          {PARAMETER_RANGE_MIN_M, TURNING, RADARS},
    {PARAMETER_RANGE_MAX_M, TURNING, RADARS},       {PARAMETER_AREA_X_MIN_M, WITH_AREA, NULL},
    {PARAMETER_AREA_X_MAX_M, WITH_AREA, NULL},      {PARAMETER_AREA_Y_MIN_M, WITH_AREA, NULL},
    {PARAMETER_AREA_Y_MAX_M, WITH_AREA, NULL},
};

static bool is_among(const char *names, const char *name)
{
    size_t length = strlen(name);

    for (; *names; names += strspn(names, ", ")) {
        size_t word = strcspn(names, ",");

        if (word == length && strncmp(names, name, length) == 0) {
            return true;
        }
        names += word;
    }
    return false;
}

static bool has_effect(const struct use *use, const char *name, const struct parameters *parameters)
{
    return parameters->source[use->id] <= SOURCE_METHOD || is_among(use->scenarios, name);
}

static _Noreturn void refuse(const struct use *use, const char *name)
{
    const char *key = parameters_name(use->id);

    if (use->by_sensor && is_among(use->by_sensor, name)) {
        fail(EXIT_USAGE, "simulate %s: %s has no effect here; set sensor.N.%s", name, key, key);
    }
    fail(EXIT_USAGE, "simulate %s: %s has no effect here; it is for %s", name, key, use->scenarios);
}

void scenario_check_uses(const char *name, const struct parameters *parameters)
{
    for (size_t i = 0; i < sizeof trackers_uses / sizeof trackers_uses[0]; i++) {
        const struct use *use = &trackers_uses[i];

        if (parameters->source[use->id] == SOURCE_SET && !has_effect(use, name, parameters)) {
            refuse(use, name);
        }
    }
    for (size_t i = 0; i < sizeof uses / sizeof uses[0]; i++) {
        if (has_effect(&uses[i], name, parameters)) {
            continue;
        }
        if (parameters->source[uses[i].id] == SOURCE_SET) {
            refuse(&uses[i], name);
        }
        fprintf(stderr, "rhotrack: simulate %s: %s of --config has no effect here; it is for %s\n",
                name, parameters_name(uses[i].id), uses[i].scenarios);
    }
}
