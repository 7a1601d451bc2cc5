/* SPDX-License-Identifier: MIT */
/* The passive experiment's cases, what was measured elsewhere, and the bars of the default. */
#include <math.h>

#include "experiment_passive.h"

#define COUNT_OF(array) (sizeof(array) / sizeof(array)[0])
#define NONE                                                                                       \
    {                                                                                              \
        NAN, NAN, NAN                                                                              \
    }

/* Sensors, targets, sigma in degrees, P_D, false bearings a look. */
#define AHEAD(sensors, targets, sigma_deg, pd, false_mean)                                         \
    {                                                                                              \
        sensors, targets, sigma_deg, pd, false_mean, PASSIVE_AHEAD, false                          \
    }
#define CLEAN(sensors, targets, sigma_deg) AHEAD(sensors, targets, sigma_deg, 1.0, 0.0)
#define CROWDED(sensors, targets) AHEAD(sensors, targets, 0.1, 0.9, 1.0)
#define EXTENSION(sensors)                                                                         \
    {                                                                                              \
        sensors, 2, 0.1, 1.0, 0.0, PASSIVE_EXTENSION, false                                        \
    }
#define NEAR(sensors)                                                                              \
    {                                                                                              \
        sensors, 3, 0.1, 0.9, 1.0, PASSIVE_NEAR, false                                             \
    }

/* By rule: elimination alone, literal, safe. */
const struct passive_pruning_case passive_pruning_cases[] = {
    {"2 targets, clean", CLEAN(2, 2, 0.1), {{.395, 0.0}, {.790, 0.0}, {.790, 0.0}}},
    {"2 targets, P_D .9", AHEAD(2, 2, 0.1, 0.9, 0.0), {{.366, 0.0}, {.714, .0525}, {.655, 0.0}}},
    {"2 targets, FA 1", AHEAD(2, 2, 0.1, 1.0, 1.0), {{.470, 0.0}, {.734, .1456}, {.505, .0012}}},
    {"2 targets, P_D .9 FA 1", CROWDED(2, 2), {{.475, 0.0}, {.715, .1734}, {.502, .0028}}},
    {"2 targets, P_D .9 FA 3",
     AHEAD(2, 2, 0.1, 0.9, 3.0),
     {{.505, 0.0}, {.692, .2002}, {.508, .0008}}},
    {"4 targets, clean", CLEAN(2, 4, 0.1), {{.386, 0.0}, {.727, 0.0}, {.727, 0.0}}},
    {"4 targets, P_D .9 FA 1", CROWDED(2, 4), {{.441, 0.0}, {.681, .0998}, {.471, .0008}}},
    {"6 targets, clean", CLEAN(2, 6, 0.1), {{.384, 0.0}, {.635, 0.0}, {.635, 0.0}}},
    {"6 targets, P_D .9 FA 1", CROWDED(2, 6), {{.422, 0.0}, {.601, .0619}, {.443, .0014}}},
    {"2 on the base's extension, clean",
     EXTENSION(2),
     {{.720, .0431}, {.914, .0523}, {.905, .0440}}},
};
const size_t passive_num_pruning_cases = COUNT_OF(passive_pruning_cases);

/* Threshold T; which rules; by rule: found, ghosts a run, exact. */
const struct passive_paper_case passive_paper_cases[] = {
    {"2s 2t .05 clean",
     CLEAN(2, 2, 0.05),
     7,
     {true, true, false},
     {{.907, 2.50, .09}, {.922, 0.41, .64}, NONE}},
    {"2s 2t .1 clean",
     CLEAN(2, 2, 0.1),
     7,
     {true, true, false},
     {{.835, 2.43, .09}, {.850, 0.35, .56}, NONE}},
    {"2s 2t .2 clean",
     CLEAN(2, 2, 0.2),
     6,
     {true, true, false},
     {{.797, 3.62, .03}, {.805, 0.90, .36}, NONE}},
    {"2s 2t .5 clean",
     CLEAN(2, 2, 0.5),
     5,
     {true, true, false},
     {{.672, 5.85, .00}, {.672, 1.96, .12}, NONE}},
    {"2s 2t .1 P_D .9 FA 1",
     CROWDED(2, 2),
     5,
     {true, true, true},
     {{.880, 6.16, .01}, {.698, 1.19, .17}, {.873, 5.15, .03}}},
    {"3s 2t .1 clean",
     CLEAN(3, 2, 0.1),
     7,
     {true, true, false},
     {{.372, 0.23, .10}, {.360, 0.07, .12}, NONE}},
    {"3s 4t .1 P_D .9 FA 1",
     CROWDED(3, 4),
     5,
     {true, true, false},
     {{.583, 9.15, .00}, {.416, 1.03, .01}, NONE}},
};
const size_t passive_num_paper_cases = COUNT_OF(passive_paper_cases);

/* Found, ghosts a run, exact, root mean square error of the place in m. */
#define REFERENCE(found, ghosts_a_run, exact, rms_m)                                               \
    .reference = {(found), (ghosts_a_run), (exact)}, .reference_rms_m = (rms_m)
#define BARS(found, ghosts) .found_min = (found), .ghosts_max = (ghosts)
#define NO_BARS BARS(NAN, NAN)

const struct passive_default_case passive_default_cases[] = {
    {.name = "2s 2t .05 clean",
     .setting = CLEAN(2, 2, 0.05),
     REFERENCE(1.0, 0.0, 1.0, 77),
     BARS(.99, .02)},
    {.name = "2s 2t .1 clean",
     .setting = CLEAN(2, 2, 0.1),
     REFERENCE(1.0, 0.0, 1.0, 153),
     BARS(.99, .02)},
    {.name = "2s 2t .2 clean",
     .setting = CLEAN(2, 2, 0.2),
     REFERENCE(1.0, 0.0, 1.0, 306),
     BARS(.99, .02)},
    {.name = "2s 2t .5 clean",
     .setting = CLEAN(2, 2, 0.5),
     REFERENCE(.985, .025, .98, 785),
     NO_BARS},
    {.name = "3s 2t .1 clean", .setting = CLEAN(3, 2, 0.1), REFERENCE(1.0, 0.0, 1.0, 121), NO_BARS},
    {.name = "3s 2t .5 clean", .setting = CLEAN(3, 2, 0.5), REFERENCE(1.0, 0.0, 1.0, 605), NO_BARS},
    {.name = "2s 2t .1 P_D .9 FA 1",
     .setting = CROWDED(2, 2),
     REFERENCE(.985, .020, .98, 145),
     NO_BARS},
    {.name = "2s 4t .1 P_D .9 FA 1",
     .setting = CROWDED(2, 4),
     REFERENCE(.980, .050, .95, 176),
     BARS(.94, .12)},
    {.name = "2s 6t .1 P_D .9 FA 1",
     .setting = CROWDED(2, 6),
     REFERENCE(.950, .220, .84, 146),
     BARS(.92, NAN)},
    {.name = "3s 2t .1 P_D .9 FA 1",
     .setting = CROWDED(3, 2),
     REFERENCE(.990, .010, .99, 139),
     NO_BARS},
    {.name = "3s 4t .1 P_D .9 FA 1",
     .setting = CROWDED(3, 4),
     REFERENCE(1.0, 0.0, 1.0, 133),
     BARS(.99, .02),
     .has_time_bar = true},
    {.name = "3s 6t .1 P_D .9 FA 1",
     .setting = CROWDED(3, 6),
     REFERENCE(1.0, 0.0, 1.0, 131),
     NO_BARS},
    {.name = "4s 2t .1 P_D .9 FA 1",
     .setting = CROWDED(4, 2),
     REFERENCE(1.0, 0.0, 1.0, 119),
     NO_BARS},
    {.name = "4s 4t .1 P_D .9 FA 1",
     .setting = CROWDED(4, 4),
     REFERENCE(.998, 0.0, .99, 119),
     NO_BARS},
    {.name = "4s 6t .1 P_D .9 FA 1",
     .setting = CROWDED(4, 6),
     REFERENCE(.997, 0.0, .98, 135),
     NO_BARS},
    {.name = "2s 4t .3 P_D .9 FA 1",
     .setting = AHEAD(2, 4, 0.3, 0.9, 1.0),
     REFERENCE(.967, .117, .93, 574),
     NO_BARS},
    {.name = "3s 4t .3 P_D .9 FA 1",
     .setting = AHEAD(3, 4, 0.3, 0.9, 1.0),
     REFERENCE(.996, .017, .98, 442),
     NO_BARS},
    {.name = "2s 3t .1 P_D .9 FA 3",
     .setting = AHEAD(2, 3, 0.1, 0.9, 3.0),
     REFERENCE(.989, .033, .98, 144),
     NO_BARS},
    {.name = "3s 3t .1 P_D .9 FA 3",
     .setting = AHEAD(3, 3, 0.1, 0.9, 3.0),
     REFERENCE(1.0, 0.0, 1.0, 159),
     NO_BARS},
    {.name = "4s 3t .1 P_D .9 FA 3",
     .setting = AHEAD(4, 3, 0.1, 0.9, 3.0),
     REFERENCE(1.0, 0.0, 1.0, 121),
     NO_BARS},
    {.name = "2s 4t .1 P_D .9 FA 1, unequal intervals",
     .setting = {2, 4, 0.1, 0.9, 1.0, PASSIVE_AHEAD, true},
     REFERENCE(.979, .050, .93, 140),
     NO_BARS},
    {.name = "2s 2t .1 clean, base's extension",
     .setting = EXTENSION(2),
     REFERENCE(.985, .020, .97, 2140),
     NO_BARS},
    {.name = "3s 2t .1 clean, base's extension",
     .setting = EXTENSION(3),
     REFERENCE(1.0, 0.0, 1.0, 124),
     NO_BARS},
    {.name = "4s 2t .1 clean, base's extension",
     .setting = EXTENSION(4),
     REFERENCE(1.0, 0.0, 1.0, 70),
     NO_BARS},
    {.name = "2s 3t .1 P_D .9 FA 1, near",
     .setting = NEAR(2),
     REFERENCE(.972, .050, .95, 34),
     NO_BARS},
    {.name = "3s 3t .1 P_D .9 FA 1, near",
     .setting = NEAR(3),
     REFERENCE(.994, 0.0, .98, 26),
     NO_BARS},
    {.name = "2s no target FA 4",
     .setting = AHEAD(2, 0, 0.1, 0.9, 4.0),
     REFERENCE(NAN, 0.0, NAN, NAN),
     BARS(NAN, .01)},
    {.name = "3s no target FA 4",
     .setting = AHEAD(3, 0, 0.1, 0.9, 4.0),
     REFERENCE(NAN, 0.0, NAN, NAN),
     BARS(NAN, .01)},
};
const size_t passive_num_default_cases = COUNT_OF(passive_default_cases);
