/* SPDX-License-Identifier: MIT */
/*
 * What an independent implementation in double precision measured of the maneuver experiment's
 * cases.
 */
#include <math.h>

#include "experiment_maneuver.h"

#define UNKNOWN                                                                                    \
    {                                                                                              \
        NAN, NAN, NAN, NAN                                                                         \
    }
/* Methods II and default, and the one that knows plots and input. */
#define OTHERS                                                                                     \
    [MANEUVER_II] = UNKNOWN, [MANEUVER_DEFAULT] = UNKNOWN,                                         \
    [MANEUVER_KNOWS_ALL] = {NAN, NAN, NAN, 1.365}
/* Method I alone. */
#define PRINTED(inside, wrong, most_off_m, rms_m)                                                  \
    {                                                                                              \
        [MANEUVER_I] = {inside, wrong, most_off_m, rms_m}, [MANEUVER_I_FORGETS] = UNKNOWN,         \
        [MANEUVER_III] = UNKNOWN, [MANEUVER_NEAREST] = UNKNOWN, OTHERS                             \
    }

const struct maneuver_reference maneuver_paper_references[][MANEUVER_PAPER_METHODS] = {
    {[MANEUVER_I] = {1.0, 0.00004, 188.0, 1.89},
     [MANEUVER_I_FORGETS] = {1.0, 0.00001, 71.0, 1.42},
     [MANEUVER_III] = {0.29, 0.80, 734.0, 296.0},
     [MANEUVER_NEAREST] = {1.0, 0.0, 4.0, 1.38},
     OTHERS},
    PRINTED(1.0, 0.00014, 163.0, 2.27),
    PRINTED(1.0, 0.00024, 222.0, 2.76),
    {[MANEUVER_I] = {0.995, 0.0035, 469.0, 19.3},
     [MANEUVER_I_FORGETS] = {1.0, 0.00041, 252.0, 3.28},
     [MANEUVER_III] = UNKNOWN,
     [MANEUVER_NEAREST] = {1.0, 0.00003, 4.0, 1.38},
     OTHERS},
    {[MANEUVER_I] = {1.0, 0.0, 4.0, 1.46},
     [MANEUVER_I_FORGETS] = {1.0, 0.0, 4.0, 1.41},
     [MANEUVER_III] = {0.31, 0.80, 734.0, 296.0},
     [MANEUVER_NEAREST] = {1.0, 0.0, 4.0, 1.41},
     OTHERS},
    PRINTED(1.0, 0.00004, 190.0, 1.91),
    PRINTED(1.0, 0.0001, 253.0, 2.68),
    {[MANEUVER_I] = {1.0, 0.00028, 175.0, 2.72},
     [MANEUVER_I_FORGETS] = {1.0, 0.00025, 143.0, 2.19},
     [MANEUVER_III] = UNKNOWN,
     [MANEUVER_NEAREST] = {1.0, 0.00028, 11.0, 1.42},
     OTHERS},
};

#define RMS(inside, rms_m)                                                                         \
    {                                                                                              \
        inside, NAN, NAN, rms_m                                                                    \
    }
const struct maneuver_reference
    maneuver_noise_references[MANEUVER_NOISES * MANEUVER_NOISE_METHODS] = {
        RMS(1.0, 1.27),  RMS(1.0, 1.26),  RMS(1.0, 1.18),   RMS(1.0, 1.19),
        RMS(1.0, 75.0),  RMS(1.0, 69.0),  RMS(1.0, 6.6),    RMS(1.0, 13.0),
        RMS(0.0, 614.0), RMS(0.0, 486.0), RMS(0.994, 34.0), RMS(0.996, 21.0)};

const struct maneuver_lost_reference maneuver_lost_references[] = {
    {0.0, 0.75},  {0.0, 0.99},  {0.0, 1.0},  {0.006, 1.0}, {0.014, 1.0}, {0.12, 1.0}, {0.0, 0.43},
    {NAN, NAN},   {0.0, 0.84},  {0.63, 1.0}, {0.112, NAN}, {0.0, 0.996}, {0.99, 1.0}, {0.002, NAN},
    {0.13, 1.0},  {0.62, 0.98}, {0.0, 0.99}, {0.002, 1.0}, {0.0, 0.99},  {0.0, 1.0},  {0.77, 1.0},
    {0.006, 1.0}, {NAN, NAN},   {NAN, NAN},  {NAN, NAN},
};

const double maneuver_pd_references[MANEUVER_PDS] = {0.0, 0.0, 0.0, 0.005, 0.005};
