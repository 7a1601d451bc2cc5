/* SPDX-License-Identifier: MIT */
/*
 * scene_text: scenes from JSON text, for the tests of scenes. A figure off by more than four
 * standard deviations fails.
 */
#ifndef TESTS_SCENE_TEXT_H
#define TESTS_SCENE_TEXT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/common.h" /* before cmocka, which has a macro of the name fail */

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/portable_math.h"
#include "scene/scene_observe.h"
#include "scene/scene_persistent.h"

/*
 * JSON of a radar: 80 km range at the origin, 30 m, 3 mrad, 4 s a turn clockwise from north; and
 * further keys.
 */
#define RADAR(more)                                                                                \
    "{\"turn_s\": 4, \"range_m\": [1000, 80000], \"sigma_range_m\": 30, \"sigma_azimuth_rad\": "   \
    "0.003" more "}"
#define SCENE(duration, radars, rest)                                                              \
    "{\"version\": 1, \"duration_s\": " duration ", \"radars\": [" radars "]" rest "}"

static inline struct scene *scene_of_text(const char *text)
{
    return scene_read("test.json", must_copy_text(text), strlen(text), NULL, 0);
}

struct moments {
    double count, sum, squares;
};

static inline void add_moment(struct moments *moments, double value)
{
    moments->count += 1.0;
    moments->sum += value;
    moments->squares += value * value;
}

static inline double mean_of_moments(const struct moments *moments)
{
    return moments->sum / moments->count;
}

static inline double sigma_of_moments(const struct moments *moments)
{
    double mean = mean_of_moments(moments);

    return sqrt(moments->squares / moments->count - mean * mean);
}

#define assert_near(value, expected, tolerance)                                                    \
    do {                                                                                           \
        double near_value = (value), near_expected = (expected);                                   \
        if (!(fabs(near_value - near_expected) <= (tolerance))) {                                  \
            fail_msg("%s is %.9g, not %.9g +- %.3g", #value, near_value, near_expected,            \
                     (double)(tolerance));                                                         \
        }                                                                                          \
    } while (0)

/* Asserts a count of independent events whose mean is `expected`. */
#define assert_poisson(count, expected) assert_near(count, expected, 4.0 * sqrt(expected) + 1.0)

/* Asserts the share of `count` in `all`. */
#define assert_share(count, total, share)                                                          \
    assert_near((double)(count) / (double)(total), share,                                          \
                4.0 * sqrt((share) * (1.0 - (share)) / (double)(total)) + 1e-9)

#endif
