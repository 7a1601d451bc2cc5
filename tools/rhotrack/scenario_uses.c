/* SPDX-License-Identifier: MIT */
/* Which scenarios use which of the parameters that are made for scenarios. */
#include <stdio.h>
#include <string.h>

#include "common.h"
#include "scenario.h"

#define SKY "air-traffic, parallel, crossing-angle, formation" /* with merge_m a sky of their own */
#define ON_PLANE                                                                                   \
    "crossing, parallel, crossing-angle, same-line, clutter, slow-turn, traffic, air-traffic, "    \
    "formation"
#define TURNING "polar, doppler, rotating"
#define PASSIVE "passive-two, passive-three, passive-clutter"
#define BEAM "popup, weave, hard-turn"

/* All use num_scans and interval_s. What trackers use, too, is not here: it goes to scenario.ini, or may come from there. */
static const struct {
    enum parameter_id id;
    const char *scenarios; /* by ", " */
} uses[] = {
    {PARAMETER_CLUTTER_PER_KM2, ON_PLANE ", radar, polar, doppler, " BEAM},
    {PARAMETER_CLUTTER_PER_SCAN, ON_PLANE ", radar, two-radars, " TURNING ", " BEAM},
    {PARAMETER_TRUE_PD, ON_PLANE ", radar, " TURNING ", " PASSIVE ", " BEAM},
    {PARAMETER_TRUE_SIGMA_M, ON_PLANE ", " BEAM},
    {PARAMETER_FADES_PER_HOUR, SKY},
    {PARAMETER_FADE_SCANS, SKY},
    {PARAMETER_SPOTS, SKY},
    {PARAMETER_SPOT_CLUTTER, SKY},
    {PARAMETER_PERSISTENT_SOURCES, SKY},
    {PARAMETER_MERGE_M, SKY},
    {PARAMETER_CROSSING_SHARE, "air-traffic"},
    {PARAMETER_RANGE_RATE, TURNING},
    {PARAMETER_STATIC_CLUTTER, "doppler"},
    {PARAMETER_TARGETS, "traffic, air-traffic, two-radars, " TURNING ", " PASSIVE},
    {PARAMETER_SENSORS, PASSIVE},
    {PARAMETER_FALSE_ALARMS, PASSIVE},
    {PARAMETER_SPACING_M, "parallel, same-line, formation, two-radars"},
    {PARAMETER_CROSSING_DEG, "crossing-angle, formation"},
    {PARAMETER_TURN_DEG, "slow-turn"},
    {PARAMETER_SPEED_MPS, "parallel, crossing-angle, same-line, slow-turn, formation"},
    {PARAMETER_SECOND_SPEED_MPS, "same-line"},
    {PARAMETER_ACCEL_G, BEAM},
    {PARAMETER_VELOCITY, BEAM},
    {PARAMETER_BEAM_DEG, BEAM},
    {PARAMETER_CLEAN_SCANS, BEAM},
    {PARAMETER_TRUE_MODEL, BEAM},
    {PARAMETER_TRUE_NOISE_MPS2, BEAM},
    {PARAMETER_TRUE_NOISE_M, BEAM},
    {PARAMETER_TRUE_NOISE_MPS, BEAM},
    {PARAMETER_SECTORS_PER_TURN, "rotating, two-radars"},
    {PARAMETER_SECOND_INTERVAL_S, "two-radars"},
    {PARAMETER_TRUE_RANGE_BIAS_M, "two-radars"},
    {PARAMETER_TRUE_AZIMUTH_BIAS_RAD, "two-radars"},
    {PARAMETER_TRUE_TIME_BIAS_S, "two-radars"},
    {PARAMETER_LATE_SHARE, "two-radars"},
    {PARAMETER_LATE_MS, "two-radars"},
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

void scenario_check_uses(const char *name, const struct parameters *parameters)
{
    for (size_t i = 0; i < sizeof uses / sizeof uses[0]; i++) {
        enum parameter_source source = parameters->source[uses[i].id];

        if (source <= SOURCE_METHOD || is_among(uses[i].scenarios, name)) {
            continue;
        }
        if (source == SOURCE_SET) {
            fail(EXIT_USAGE, "simulate %s: %s has no effect here; it is for %s", name,
                 parameters_name(uses[i].id), uses[i].scenarios);
        }
        fprintf(stderr, "rhotrack: simulate %s: %s of --config has no effect here; it is for %s\n",
                name, parameters_name(uses[i].id), uses[i].scenarios);
    }
}
