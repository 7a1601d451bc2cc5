/* SPDX-License-Identifier: MIT */
/*
 * bearing_crossing: the position at which bearings from two places cross.
 *
 *              o  delta, the angle between the bearings
 *             / \
 *    range_a /   \ range_b        delta = |beta_b| - |beta_a|
 *           /     \               range_a = B sin |beta_b| / sin delta     (law of sines)
 *      a --/-------\-- b          range_b = B sin |beta_a| / sin delta
 *         beta_a    beta_b
 *
 * B is the length of the base. beta_a and beta_b are bearings from its direction a -> b, positive
 * to its left, negative to its right.
 *
 * The rays meet only where both are on one side of the base and delta is positive. Far crossings,
 * and those near the base's extension, have a small delta: ranges are compared by products, and
 * nothing is divided that may be 0. Lengths in metres, angles in radians counter-clockwise from +x,
 * any geometry, sensors that look all round.
 *
 * Source: the passive Hough transform with ghost elimination (the paper's title and authors are
 * lost in the copies that circulate): the differences Delta_ij of section 3, and the ranges D_ij of
 * step 1.2, derived again above.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_BEARING_CROSSING_H
#define RHOTRACK_BEARING_CROSSING_H

#include "rhotrack/types.h"

RHO_BEGIN_C

/* The base: positions of two sensors, at least RHO_CROSSING_BASE_MIN_M apart. */
#define RHO_CROSSING_BASE_MIN_M 1.0f

struct rho_crossing_base {
    float x_a_m, y_a_m, x_b_m, y_b_m;
    float length_m, direction_rad; /* length and direction of the base, from a to b */
};

/* Whether two bearings cross, or why not. */
enum rho_crossing_fate {
    RHO_CROSSING_MEETS = 0,
    RHO_CROSSING_SIDES, /* the bearings point to different sides of the base */
    /* delta <= 0: the bearings are parallel, or would cross behind the sensors */
    RHO_CROSSING_APART,
    RHO_CROSSING_RANGE /* the bearings cross beyond the largest range of a sensor */
};

struct rho_crossing {
    float x_m, y_m;
    float delta_rad;
    float range_a_m, range_b_m;
};

/*
 * Computes the base from the positions of two sensors. Errors: VALUE (a place not finite or beyond
 * RHO_LIMIT_POSITION_M, the places nearer to each other than RHO_CROSSING_BASE_MIN_M); *base is
 * unchanged. Cost: an arctangent, a square root. Stack: 56 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_crossing_set_base(struct rho_crossing_base *base, float x_a_m,
                                                     float y_a_m, float x_b_m, float y_b_m);

/*
 * The crossing of a bearing from a (bearing_a_rad) and one from b. Both finite; range_max_m > 0.
 * *crossing is filled only with RHO_CROSSING_MEETS. A bearing that is not finite:
 * RHO_CROSSING_APART. Within 80 km, and with a delta of 0.02 to pi - 0.02 rad, the place is within
 * a metre of exact arithmetic; nearer to pi the crossing is between the sensors, which point at
 * each other. Cost: three sines and cosines, two divisions. Stack: 110 bytes.
 */
enum rho_crossing_fate rho_crossing_find(const struct rho_crossing_base *base, float bearing_a_rad,
                                         float bearing_b_rad, float range_max_m,
                                         struct rho_crossing *crossing);

/* delta alone; -pi where the bearings point to different sides of the base. Constant cost. */
float rho_crossing_angle_rad(const struct rho_crossing_base *base, float bearing_a_rad,
                             float bearing_b_rad);

/* A bearing's direction from its sensor, the range of a crossing along it, and its sigma. */
struct rho_crossing_ray {
    float cosine, sine, range_m, sigma_rad;
};

/*
 * Covariance of a crossing, xx, xy, yy, for independent errors of the bearings: a bearing's error
 * moves the place along the other's ray, range / sin(delta) a radian.
 * Cost: two divisions. Stack: 64 bytes.
 */
void rho_crossing_covariance(const struct rho_crossing_ray *a, const struct rho_crossing_ray *b,
                             float covariance_m2[3]);

RHO_END_C

#endif
