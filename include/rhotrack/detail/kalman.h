/* SPDX-License-Identifier: MIT */
/*
 * kalman: six-state Kalman filter, nearly constant velocity, updated by one scalar at a time.
 *
 * State [x y z vx vy vz] in metres and metres a second; covariance as the lower triangle row by row
 * (linalg.h), 21 floats: symmetric by construction. An axis that was never measured is closed: its
 * state and variances are 0 and stay 0. Scalar updates need no matrix inverse: a measurement with
 * independent noise on the axes is one update per axis, which gives the same estimate as the vector
 * update. Noise with the axes of a line of sight couples x, y and z, but is independent in the
 * frame of these axes: the estimate is rotated into that frame, updated, and rotated back.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_KALMAN_H
#define RHOTRACK_KALMAN_H

#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"
#include "rhotrack/detail/measurement.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

#define RHO_AXES 3
#define RHO_KALMAN_STATES (2 * RHO_AXES)

/* Indices of the state's elements, and of the positions' covariances in the packed triangle. */
#define RHO_X 0
#define RHO_Y 1
#define RHO_Z 2
#define RHO_VX 3
#define RHO_VY 4
#define RHO_VZ 5
#define RHO_XX RHO_AT(RHO_X, RHO_X)
#define RHO_YX RHO_AT(RHO_Y, RHO_X)
#define RHO_YY RHO_AT(RHO_Y, RHO_Y)
#define RHO_ZX RHO_AT(RHO_Z, RHO_X)
#define RHO_ZY RHO_AT(RHO_Z, RHO_Y)
#define RHO_ZZ RHO_AT(RHO_Z, RHO_Z)

/* largest interval of a prediction, either way */
#define RHO_KALMAN_STEP_MAX_S 1.0e5f

struct rho_kalman {
    float state[RHO_KALMAN_STATES];
    float covariance[RHO_TRIANGLE(RHO_KALMAN_STATES)];
};

/* A variance raised to the floor: with less an open axis would look closed. No stack. */
static inline float rho_kalman_floored(float variance)
{
    return variance > RHO_VARIANCE_MIN ? variance : RHO_VARIANCE_MIN;
}

/* Raises the variances of n states to the floor; 0 marks a closed axis and stays. No stack. */
static inline void rho_kalman_floor_variances(float *covariance, int n)
{
    RHO_UNROLL
    for (int i = 0; i < n; i++) {
        float *variance = &covariance[RHO_AT(i, i)];
        if (*variance < RHO_VARIANCE_MIN && (*variance > 0.0f || *variance < 0.0f)) {
            *variance = RHO_VARIANCE_MIN;
        }
    }
}

/* Sets all axes closed: state and covariance are 0. Constant cost. */
void rho_kalman_init(struct rho_kalman *kalman);

/*
 * Opens axis 0 (x), 1 (y) or 2 (z) with a first position and its variance, velocity 0 with its
 * variance; covariances with the other axes become 0. Errors: VALUE (axis, not finite, variance
 * outside RHO_VARIANCE_MIN .. MAX). Constant cost.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_open_axis(struct rho_kalman *kalman, int axis,
                                                    float position_m, float position_variance,
                                                    float velocity_variance);

/* Sets the open axes' covariance to variance, RHO_VARIANCE_MIN .. MAX, times I. Constant cost. */
void rho_kalman_set_equal_variances(struct rho_kalman *kalman, float variance);

/*
 * Moves the estimate on by dt_s, -1e5 .. 1e5. noise_density is the power spectral density of white
 * acceleration on each open axis, (m/s^2)^2 s = m^2/s^3, >= 0: Q = density [dt^3/3 dt^2/2; dt^2/2
 * dt], so that one long step equals several short ones. Going back (dt_s < 0) adds no noise: forth
 * and back without noise is the identity but for rounding. Errors: VALUE (arguments, or a result
 * beyond RHO_VARIANCE_MAX; unchanged). Cost: about 240 instructions. Stack: 72 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_predict(struct rho_kalman *kalman, float dt_s,
                                                  float noise_density);

/*
 * One scalar update: element 0 .. 5 of the state was measured as value with the given variance > 0
 * (raised to RHO_VARIANCE_MIN). *nis (may be NULL) gets the normalised innovation squared.
 * An element of an axis that is not open is left unchanged. Errors: VALUE (element, value or
 * variance, a result not finite), SINGULAR (innovation variance not positive and finite);
 * unchanged. Cost: about 300 instructions. Stack: 144 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_update(struct rho_kalman *kalman, int element,
                                                 float value, float variance, float *nis);

/*
 * One scalar update: row . state was measured, `innovation` is its measured minus predicted value,
 * `variance` its noise.
 * Errors: as rho_kalman_update. Cost: about 590 instructions. Stack: 200 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_update_row(struct rho_kalman *kalman, const float row[6],
                                                     float innovation, float variance);

/*
 * Updates with a position: x and y, and z where it was measured. An axis that is not open is opened
 * with its place and its noise, and a velocity of 0 with variance velocity_variance. After an error
 * the filter is partly updated: work on a copy where that matters. Errors: as rho_kalman_update and
 * rho_kalman_open_axis.
 * Cost: a scalar update an axis, and where the noise is not isotropic 2 rotations (with z 4) into
 * its frame and as many back, about 200 instructions each. Stack: 310 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_update_position(struct rho_kalman *kalman,
                                                          const struct rho_measurement *measurement,
                                                          float velocity_variance);

/* A scalar measurement, linearised at an estimate: the arguments of rho_kalman_update_row. */
struct rho_kalman_row {
    float row[RHO_KALMAN_STATES];
    float innovation; /* innovation: measured minus predicted */
    float variance;   /* noise variance, and that of the linearisation's error */
};

/*
 * Linearises a range rate with noise `variance` at an estimate, into *seen. Returns 0, and fills
 * nothing, if the estimate is nearer than a metre to the sensor. Cost:
 * rho_measurement_predict_rate, and a division. Stack: 170 bytes.
 */
int rho_kalman_linearise_rate(const struct rho_kalman *kalman, const struct rho_sensor *sensor,
                              float rate_mps, float variance, struct rho_kalman_row *seen);

/*
 * True unless the range rate is ambiguous and the estimate is too uncertain to unfold it
 * (measurement.h). Cost: rho_linalg_project6 for an ambiguous range rate.
 */
int rho_kalman_can_unfold(const struct rho_kalman *kalman, const struct rho_sensor *sensor,
                          const struct rho_kalman_row *seen);

/*
 * Updates with a range rate seen from `sensor` (NULL: the origin), linearised at the estimate; to
 * be called after the update with the same plot's position. For an estimate nearer than a metre to
 * the sensor, and for an ambiguous range rate that cannot be unfolded, nothing is done: RHO_OK.
 * Errors: as rho_kalman_update_row. Cost: rho_kalman_update_row and
 * rho_measurement_predict_rate. Stack: 250 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_update_range_rate(struct rho_kalman *kalman,
                                                            const struct rho_sensor *sensor,
                                                            float rate_mps, float variance);

/* A bearing as a scalar measurement, linearised, in metres across the line of sight. */
struct rho_kalman_bearing {
    float row[RHO_KALMAN_STATES]; /* (-sin, cos) of x and y */
    float off_m;                  /* innovation: measured minus predicted */
    float variance_m2;            /* variance of the noise, and of the linearisation's error */
    float range_m;
};

/*
 * Linearises a bearing at an estimate, into *seen; the variance includes the error of the
 * linearisation for an uncertain position. Returns 0, and fills nothing, if the estimate is nearer
 * than a metre to the place, or not finite. Cost: an arctangent, a square root, two
 * divisions. Stack: 96 bytes.
 */
int rho_kalman_linearise_bearing(const struct rho_kalman *kalman, float x_m, float y_m,
                                 float bearing_rad, float sigma_rad,
                                 struct rho_kalman_bearing *seen);

/*
 * Updates with a bearing from a place, linearised at the estimate. An estimate nearer than a metre
 * to the place has no bearing: nothing is done, RHO_OK. Errors: as rho_kalman_update_row. Cost:
 * rho_kalman_update_row and rho_kalman_linearise_bearing. Stack: 300 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_update_bearing(struct rho_kalman *kalman, float x_m,
                                                         float y_m, float bearing_rad,
                                                         float sigma_rad);

/*
 * Linearises a slope at an estimate, into *seen, in metres of height; for an estimate without a
 * height off_m is the height itself. Returns 0, and fills nothing, for a slope that is not
 * measured, and as rho_kalman_linearise_bearing. Cost: a square root, a division. Stack: 112 bytes.
 */
int rho_kalman_linearise_slope(const struct rho_kalman *kalman, const struct rho_slope *slope,
                               struct rho_kalman_bearing *seen);

/*
 * Density of a slope where an estimate expects it, and its NIS; 1 and 0 for a slope that is not
 * measured, and without a height: slopes of false bearings are as likely anywhere within a slope of
 * 1. Cost: about 150 instructions. Stack: 200 bytes.
 */
float rho_kalman_slope_density(const struct rho_kalman *kalman, const struct rho_slope *slope,
                               float *nis);

/*
 * Gives an estimate without one the height of a slope linearised at it, or at a better one; its
 * errors go with those of the range. Errors: as rho_kalman_open_axis. Stack: 80 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_open_height(struct rho_kalman *kalman,
                                                      const struct rho_kalman_bearing *seen,
                                                      float velocity_variance);

/*
 * Updates with a slope, or gives a height to an estimate that has none. Nothing is done where it
 * cannot be linearised, RHO_OK. Errors: as rho_kalman_update_row and rho_kalman_open_axis. Cost:
 * rho_kalman_update_row and rho_kalman_linearise_slope. Stack: 300 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_update_slope(struct rho_kalman *kalman,
                                                       const struct rho_slope *slope,
                                                       float velocity_variance);

/* True if axis 0 (x), 1 (y) or 2 (z) was opened. */
static inline int rho_kalman_has_axis(const struct rho_kalman *kalman, int axis)
{
    return kalman->covariance[RHO_AT(axis, axis)] > 0.0f;
}

RHO_END_C

#endif
