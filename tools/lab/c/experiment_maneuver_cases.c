/* SPDX-License-Identifier: MIT */
/* The maneuver experiment's cases and methods, and the bars of the default. */
#include <math.h>

#include "experiment_maneuver.h"

#define COUNT_OF(array) (sizeof(array) / sizeof(array)[0])
#define PAPER_RUNS 500
#define DENSE_RUNS 200 /* at 100 clutter plots */
#define CLOSED_RUNS 500
#define PD_RUNS 200
#define USUAL_G 12.0 /* 118 m/s^2: what the tracker is told of targets that pull up to 10 g */

/* ---- methods --------------------------------------------------------------------------------- */

#define HOUGH(text, estimates, forgetting, noise)                                                  \
    {                                                                                              \
        .name = (text), .gate = MAINTAIN_HOUGH, .has_input_estimation = (estimates),               \
        .gamma = (forgetting), .filter_noise = (noise)                                             \
    }
#define NEAREST(physical, forgetting)                                                              \
    {                                                                                              \
        .name = "nearest", .gate = MAINTAIN_NEAREST, .has_input_estimation = true,                 \
        .has_physical_input = (physical), .gamma = (forgetting), .filter_noise = 1.0               \
    }
#define BEST(text, pd)                                                                             \
    {                                                                                              \
        .name = (text), .gate = MAINTAIN_BEST, .has_input_estimation = true, .gamma = 1.0,         \
        .filter_noise = 1.0, .assumed_pd = (pd)                                                    \
    }
#define CLAIRVOYANT                                                                                \
    {                                                                                              \
        .name = "clairvoyant", .kind = MANEUVER_CLAIRVOYANT                                        \
    }
#define TRUE_IMM                                                                                   \
    {                                                                                              \
        .name = "IMM, true plots", .kind = MANEUVER_TRUE_IMM                                       \
    }

static const struct maneuver_method paper_methods[] = {
    [MANEUVER_I] = HOUGH("I", true, 1.0, 1.0),
    [MANEUVER_I_FORGETS] = HOUGH("I, gamma .5", true, 0.5, 1.0),
    [MANEUVER_II] = HOUGH("II", false, 1.0, 1.0),
    [MANEUVER_III] = {.name = "III",
                      .gate = MAINTAIN_NONE,
                      .has_input_estimation = true,
                      .gamma = 1.0,
                      .filter_noise = 1.0},
    [MANEUVER_NEAREST] = NEAREST(false, 0.5),
    [MANEUVER_KNOWS_ALL] = CLAIRVOYANT,
    [MANEUVER_DEFAULT] = BEST("default", 0.0),
};

#define FILTERS(noise)                                                                             \
    HOUGH("II", false, 1.0, noise), HOUGH("I", true, 1.0, noise),                                  \
        HOUGH("I, gamma .7", true, 0.7, noise), HOUGH("I, gamma .5", true, 0.5, noise)

const double maneuver_noises[MANEUVER_NOISES] = {1.0, 0.01, 1e-4};
static const struct maneuver_method noise_methods[] = {FILTERS(1.0), FILTERS(0.1), FILTERS(0.01)};

/* The literal D is blind where only places are measured. */
#define CLOSED(physical)                                                                           \
    {                                                                                              \
        [MANEUVER_CLOSED_DEFAULT] = BEST("default", 0.0), [MANEUVER_CLOSED_IMM] = TRUE_IMM,        \
        [MANEUVER_CLOSED_ALL] = CLAIRVOYANT,                                                       \
        [MANEUVER_CLOSED_PAPER] = {.name = "paper",                                                \
                                   .gate = MAINTAIN_HOUGH,                                         \
                                   .has_input_estimation = true,                                   \
                                   .has_physical_input = (physical),                               \
                                   .gamma = 1.0,                                                   \
                                   .filter_noise = 1.0},                                           \
        [MANEUVER_CLOSED_NEAREST] = NEAREST(physical, 1.0),                                        \
    }

static const struct maneuver_method closed_methods[] = CLOSED(true);
static const struct maneuver_method closed_velocity_methods[] = CLOSED(false);

static const struct maneuver_method polar_methods[] = {
    [MANEUVER_CLOSED_DEFAULT] = BEST("default", 0.0),
    [MANEUVER_CLOSED_IMM] = TRUE_IMM,
    [MANEUVER_CLOSED_ALL] = CLAIRVOYANT,
};

static const struct maneuver_method pd_methods[MANEUVER_PDS] = {
    BEST("0.7", 0.7), BEST("0.8", 0.8), BEST("0.9", 0.9), BEST("0.97", 0.97), BEST("0.99", 0.99)};

/* ---- centred on the truth -------------------------------------------------------------------- */

#define NO_BARS                                                                                    \
    {                                                                                              \
        NAN, NAN, false                                                                            \
    }
#define PAPER_SETTING(path, count, variance)                                                       \
    {                                                                                              \
        .profile = (path), .pull_g = 10.0, .truth = MANEUVER_LITERAL, .noise = (variance),         \
        .sensor = MANEUVER_VELOCITIES, .sigma_m = 1.0, .sigma_mps = 1.0, .clutter = (count),       \
        .pd = 1.0, .beam = MANEUVER_AT_TRUTH, .accel_max_g = USUAL_G                               \
    }
#define PAPER(text, path, count, number)                                                           \
    {                                                                                              \
        text, PAPER_SETTING(path, count, 1.0), paper_methods, MANEUVER_PAPER_METHODS, number,      \
            NO_BARS                                                                                \
    }

const struct maneuver_case maneuver_paper_cases[] = {
    PAPER("pop-up, N 4", MANEUVER_POPUP, 4, PAPER_RUNS),
    PAPER("pop-up, N 10", MANEUVER_POPUP, 10, PAPER_RUNS),
    PAPER("pop-up, N 30", MANEUVER_POPUP, 30, PAPER_RUNS),
    PAPER("pop-up, N 100", MANEUVER_POPUP, 100, DENSE_RUNS),
    PAPER("weave, N 4", MANEUVER_WEAVE, 4, PAPER_RUNS),
    PAPER("weave, N 10", MANEUVER_WEAVE, 10, PAPER_RUNS),
    PAPER("weave, N 30", MANEUVER_WEAVE, 30, PAPER_RUNS),
    PAPER("weave, N 100", MANEUVER_WEAVE, 100, DENSE_RUNS),
};
const size_t maneuver_num_paper_cases = COUNT_OF(maneuver_paper_cases);

const struct maneuver_case maneuver_noise_case = {"pop-up, N 4, true Q 1e-4 I",
                                                  PAPER_SETTING(MANEUVER_POPUP, 4, 1e-4),
                                                  noise_methods,
                                                  MANEUVER_NOISES *MANEUVER_NOISE_METHODS,
                                                  PAPER_RUNS,
                                                  NO_BARS};

/* ---- the beam follows the prediction --------------------------------------------------------- */

#define CLOSED_SETTING(path, g, sigma, count, detection, width_g)                                  \
    {                                                                                              \
        .profile = (path), .pull_g = (g), .truth = MANEUVER_PHYSICAL, .noise = 2.0,                \
        .sensor = MANEUVER_PLACES, .sigma_m = (sigma), .clutter = (count), .pd = (detection),      \
        .beam = MANEUVER_AT_PREDICTION, .accel_max_g = (width_g)                                   \
    }
#define VELOCITY_SETTING(g, sigma, count, detection)                                               \
    {                                                                                              \
        .profile = MANEUVER_WEAVE, .pull_g = (g), .truth = MANEUVER_PHYSICAL, .noise = 2.0,        \
        .sensor = MANEUVER_VELOCITIES, .sigma_m = (sigma), .sigma_mps = (sigma),                   \
        .clutter = (count), .pd = (detection), .beam = MANEUVER_AT_PREDICTION,                     \
        .accel_max_g = USUAL_G                                                                     \
    }
#define POLAR_SETTING(kind, count)                                                                 \
    {                                                                                              \
        .profile = MANEUVER_WEAVE, .pull_g = 10.0, .truth = MANEUVER_PHYSICAL, .noise = 2.0,       \
        .sensor = (kind), .sigma_m = 15.0, .sigma_rad = 3e-3, .clutter = (count), .pd = 0.9,       \
        .beam = MANEUVER_ALL_ROUND, .accel_max_g = USUAL_G                                         \
    }
#define WITH(setting, methods, ...)                                                                \
    setting, methods, COUNT_OF(methods), CLOSED_RUNS,                                              \
    {                                                                                              \
        __VA_ARGS__                                                                                \
    }
#define WEAVE(g, sigma, count, pd, ...)                                                            \
    WITH(CLOSED_SETTING(MANEUVER_WEAVE, g, sigma, count, pd, USUAL_G), closed_methods, __VA_ARGS__)
#define WIDE(g, sigma, count, pd, ...)                                                             \
    WITH(CLOSED_SETTING(MANEUVER_WEAVE, g, sigma, count, pd, g), closed_methods, __VA_ARGS__)
#define OTHER(path, ...)                                                                           \
    WITH(CLOSED_SETTING(path, 10.0, 10.0, 10, 0.9, USUAL_G), closed_methods, __VA_ARGS__)
#define VELOCITY(g, sigma, count, ...)                                                             \
    WITH(VELOCITY_SETTING(g, sigma, count, 0.9), closed_velocity_methods, __VA_ARGS__)

/* g, sigma in metres, clutter plots, P_D. */
const struct maneuver_case maneuver_closed_cases[] = {
    {"10, 10, 10, 1", WEAVE(10.0, 10.0, 10, 1.0, NAN, 1.15, true)},
    {"10, 10, 30, 1", WEAVE(10.0, 10.0, 30, 1.0, 0.002, NAN, true)},
    {"10, 10, 4, .9", WEAVE(10.0, 10.0, 4, 0.9, NAN, 1.15, true)},
    {"10, 10, 10, .9", WEAVE(10.0, 10.0, 10, 0.9, 0.02, 1.15, true)},
    {"10, 10, 30, .9", WEAVE(10.0, 10.0, 30, 0.9, 0.035, NAN, true)},
    {"10, 10, 100, .9", WEAVE(10.0, 10.0, 100, 0.9, 0.2, NAN, true)},
    {"1, 10, 10, .9", WEAVE(1.0, 10.0, 10, 0.9, 0.01, 1.15, true)},
    {"2, 10, 10, .9", WEAVE(2.0, 10.0, 10, 0.9, 0.01, 1.15, true)},
    {"3, 10, 10, .9", WEAVE(3.0, 10.0, 10, 0.9, 0.01, 1.15, true)},
    {"30, 10, 10, .9", WEAVE(30.0, 10.0, 10, 0.9, NAN, NAN, false)},
    {"30, 10, 10, .9, told 30 g", WIDE(30.0, 10.0, 10, 0.9, 0.15, 1.15, false)},
    {"10, 1, 10, .9", WEAVE(10.0, 1.0, 10, 0.9, NAN, 1.15, true)},
    {"30, 1, 10, .9", WEAVE(30.0, 1.0, 10, 0.9, NAN, NAN, false)},
    {"30, 1, 10, .9, told 30 g", WIDE(30.0, 1.0, 10, 0.9, 0.02, 1.15, false)},
    {"10, 50, 4, 1", WEAVE(10.0, 50.0, 4, 1.0, NAN, NAN, true)},
    {"3, 50, 10, .9", WEAVE(3.0, 50.0, 10, 0.9, NAN, NAN, true)},
    {"pop-up, 10, 10, 10, .9", OTHER(MANEUVER_POPUP, 0.01, 1.15, true)},
    {"turn, 10, 10, 10, .9", OTHER(MANEUVER_TURN, 0.01, 1.15, true)},
    {"velocity, 10, 10, 10, .9", VELOCITY(10.0, 10.0, 10, NAN, 1.15, true)},
    {"velocity, 10, 10, 100, .9", VELOCITY(10.0, 10.0, 100, 0.005, NAN, true)},
    {"velocity, 30, 10, 30, .9", VELOCITY(30.0, 10.0, 30, NAN, NAN, false)},
    {"velocity, 10, 50, 30, .9", VELOCITY(10.0, 50.0, 30, NAN, NAN, true)},
    {"polar 2-D, 10 g, no clutter, .9",
     WITH(POLAR_SETTING(MANEUVER_POLAR, 0), polar_methods, NAN, 1.1, true)},
    {"polar 3-D, 10 g, no clutter, .9",
     WITH(POLAR_SETTING(MANEUVER_POLAR_3D, 0), polar_methods, NAN, 1.1, true)},
    {"polar 3-D, 10 g, N 4, .9",
     WITH(POLAR_SETTING(MANEUVER_POLAR_3D, 4), polar_methods, NAN, NAN, false)},
};
const size_t maneuver_num_closed_cases = COUNT_OF(maneuver_closed_cases);

const struct maneuver_case maneuver_pd_case = {
    "10, 10, 10, .9", CLOSED_SETTING(MANEUVER_WEAVE, 10.0, 10.0, 10, 0.9, USUAL_G),
    pd_methods,       MANEUVER_PDS,
    PD_RUNS,          NO_BARS};
