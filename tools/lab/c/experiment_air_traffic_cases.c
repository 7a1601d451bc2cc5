/* SPDX-License-Identifier: MIT */
/* experiment_air_traffic_cases: what is measured. */
#include <math.h>
#include <string.h>

#include "experiment_air_traffic.h"

#define SCANS 120 /* 20 minutes */
#define SCANS_LARGE 40
#define NONE NAN

const double air_cutoffs_m[AIR_CUTOFFS] = {1000.0, 200.0};

#define GRID(targets, clutter, scans, share)                                                       \
    {                                                                                              \
        AIR_GRID, "as assumed", targets, clutter, scans, share, true,                              \
        {                                                                                          \
            NULL                                                                                   \
        }                                                                                          \
    }
#define STRESS(name, ...)                                                                          \
    {                                                                                              \
        AIR_STRESS, name, 50, 100, SCANS, 1, true,                                                 \
        {                                                                                          \
            __VA_ARGS__                                                                            \
        }                                                                                          \
    }
#define OPERATION(name)                                                                            \
    {                                                                                              \
        AIR_OPERATION, name, 50, 1000, SCANS, 1, false,                                            \
        {                                                                                          \
            "settings.false_tracks_per_hour=" name                                                 \
        }                                                                                          \
    }
#define SPOT(x_km, y_km)                                                                           \
    ",{\"kind\":\"cell\",\"shape\":\"disc\",\"radius_m\":20e3,\"plots\":20,\"at_m\":[" #x_km       \
    "e3," #y_km "e3]}"

const struct air_case air_cases[] = {
    GRID(10, 0, SCANS, 1),
    GRID(10, 100, SCANS, 1),
    GRID(10, 1000, SCANS, 1),
    GRID(10, 5000, SCANS, 2),
    GRID(50, 0, SCANS, 1),
    GRID(50, 100, SCANS, 1),
    GRID(50, 1000, SCANS, 1),
    GRID(50, 5000, SCANS, 2),
    GRID(200, 0, SCANS, 2),
    GRID(200, 100, SCANS, 2),
    GRID(200, 1000, SCANS, 2),
    GRID(200, 5000, SCANS, 4),
    GRID(1000, 0, SCANS_LARGE, 4),
    GRID(1000, 100, SCANS_LARGE, 4),
    GRID(1000, 1000, SCANS_LARGE, 4),
    GRID(1000, 5000, SCANS_LARGE, 4),
    STRESS("fades: 4 an hour, 3 scans",
           "events=[{\"kind\":\"fades\",\"per_hour\":4,\"for_s\":[5,55]}]"),
    STRESS("5 hot spots, 20 plots each",
           "clutter=[{\"kind\":\"uniform\",\"plots\":100}" SPOT(-170, 40) SPOT(-60, -200)
               SPOT(20, 110) SPOT(130, -70) SPOT(210, 180) "]"),
    STRESS("50 persistent sources", "clutter.1={\"kind\":\"standing\",\"count\":50,\"pd\":0.9}"),
    STRESS("merged plots within 1 km, half cross", "radars.0.resolution_m=1000",
           "targets.0.crossing_share=0.5"),
    STRESS("sigma assumed 0.7 of the true one", "radars.0.told={\"sigma_m\":35}"),
    STRESS("sigma assumed 1.5 of the true one", "radars.0.told={\"sigma_m\":75}"),
    STRESS("P_D 0.8, 0.95 assumed", "radars.0.pd=0.8", "radars.0.told={\"pd\":0.95}"),
    STRESS("P_D 0.95, 0.8 assumed", "radars.0.told={\"pd\":0.8}"),
    OPERATION("0.01"),
    OPERATION("0.1"),
    OPERATION("1"),
    OPERATION("10"),
    OPERATION("100"),
    OPERATION("1000"),
    OPERATION("10000"),
};

size_t air_num_cases(void)
{
    return sizeof air_cases / sizeof air_cases[0];
}

/* Sigma is 50 m. */
const struct air_pair air_pairs[AIR_PAIRS] = {
    {"crossing at 10 degrees", "crossing-angle", 41, 0, 0, 395, 0.95},
    {"parallel at 8 sigma", "parallel", 31, 400, 0, 395, 0.95},
    {"parallel at 3 sigma", "parallel", 31, 150, 0, 0, NONE},
    {"meet, 8 sigma, part", "formation", 61, 400, 0, 395, NONE},
    {"meet, 3 sigma, part", "formation", 61, 150, 0, 395, NONE},
    {"meet, 3 sigma, merged within 5, part", "formation", 61, 150, 250, 395, NONE},
};

const struct air_alarm air_alarms[AIR_ALARMS] = {
    {100, 1}, {100, 20}, {1000, 1}, {1000, 20}, {5000, 20},
};

unsigned air_part_named(const char *name)
{
    static const struct {
        const char *name;
        unsigned part;
    } parts[] = {{"grid", AIR_PART_GRID},           {"stress", AIR_PART_STRESS},
                 {"operation", AIR_PART_OPERATION}, {"pairs", AIR_PART_PAIRS},
                 {"clutter", AIR_PART_CLUTTER},     {"rivals", AIR_PART_RIVALS}};

    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        if (strcmp(name, parts[i].name) == 0) {
            return parts[i].part;
        }
    }
    return 0;
}
