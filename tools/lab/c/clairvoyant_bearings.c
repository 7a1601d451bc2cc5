/* SPDX-License-Identifier: MIT */
#include "clairvoyant_bearings.h"

#include <math.h>
#include <string.h>

#define PI 3.141592653589793
#define STEPS 12
#define UNKNOWNS 4

/* Gauss-Jordan; a is positive definite, and used up. */
static void invert(double a[UNKNOWNS][UNKNOWNS], double inverse[UNKNOWNS][UNKNOWNS])
{
    for (int i = 0; i < UNKNOWNS; i++) {
        for (int j = 0; j < UNKNOWNS; j++) {
            inverse[i][j] = i == j;
        }
    }
    for (int i = 0; i < UNKNOWNS; i++) {
        double pivot = a[i][i];
        for (int j = 0; j < UNKNOWNS; j++) {
            a[i][j] /= pivot;
            inverse[i][j] /= pivot;
        }
        for (int row = 0; row < UNKNOWNS; row++) {
            double factor = row == i ? 0.0 : a[row][i];
            for (int j = 0; j < UNKNOWNS; j++) {
                a[row][j] -= factor * a[i][j];
                inverse[row][j] -= factor * inverse[i][j];
            }
        }
    }
}

struct equations {
    double a[UNKNOWNS][UNKNOWNS], b[UNKNOWNS];
};

static void add_bearing(struct equations *equations, const double state[UNKNOWNS],
                        const struct clairvoyant_bearing *bearing)
{
    double dx_m = state[0] + bearing->t_s * state[2] - bearing->sensor_x_m;
    double dy_m = state[1] + bearing->t_s * state[3] - bearing->sensor_y_m;
    double range2_m2 = dx_m * dx_m + dy_m * dy_m;
    double weight = 1.0 / (bearing->sigma_rad * bearing->sigma_rad);
    double off_rad = remainder(bearing->bearing_rad - atan2(dy_m, dx_m), 2.0 * PI);
    double row[UNKNOWNS] = {-dy_m / range2_m2, dx_m / range2_m2, -bearing->t_s * dy_m / range2_m2,
                            bearing->t_s * dx_m / range2_m2};
    for (int i = 0; i < UNKNOWNS; i++) {
        equations->b[i] += weight * row[i] * off_rad;
        for (int j = 0; j < UNKNOWNS; j++) {
            equations->a[i][j] += weight * row[i] * row[j];
        }
    }
}

static struct equations equations_at(const double state[UNKNOWNS],
                                     const struct clairvoyant_bearing *bearings,
                                     size_t num_bearings)
{
    const double belief = 1.0 / (CLAIRVOYANT_BELIEF_MPS * CLAIRVOYANT_BELIEF_MPS);
    struct equations equations = {.b = {0.0, 0.0, -belief * state[2], -belief * state[3]}};
    equations.a[2][2] = equations.a[3][3] = belief;
    for (size_t i = 0; i < num_bearings; i++) {
        add_bearing(&equations, state, &bearings[i]);
    }
    return equations;
}

struct clairvoyant_course clairvoyant_bearings_fit(const struct clairvoyant_bearing *bearings,
                                                   size_t num_bearings, const double start[4])
{
    struct clairvoyant_course course = {.state = {start[0], start[1], start[2], start[3]}};
    for (int step = 0; step < STEPS; step++) {
        struct equations equations = equations_at(course.state, bearings, num_bearings);
        invert(equations.a, course.covariance);
        for (int i = 0; i < UNKNOWNS; i++) {
            for (int j = 0; j < UNKNOWNS; j++) {
                course.state[i] += course.covariance[i][j] * equations.b[j];
            }
        }
    }
    return course;
}

double clairvoyant_nees(const double off[4], const double covariance[4][4])
{
    double a[UNKNOWNS][UNKNOWNS], inverse[UNKNOWNS][UNKNOWNS], sum = 0.0;
    memcpy(a, covariance, sizeof a);
    invert(a, inverse);
    for (int i = 0; i < UNKNOWNS; i++) {
        for (int j = 0; j < UNKNOWNS; j++) {
            sum += off[i] * inverse[i][j] * off[j];
        }
    }
    return sum;
}
