/* SPDX-License-Identifier: MIT */
/*
 * kalman: six-state Kalman filter, nearly constant velocity, updated by one scalar at a time.
 *
 * State [x y z vx vy vz] in metres and metres a second; covariance as the lower triangle row by row (linalg.h), 21
 * floats: symmetric by construction. An axis that was never measured has zero state and zero variance and stays so.
 * Scalar updates need no matrix inverse: a measurement whose noise couples no axes is one update an axis, and gives the
 * same estimate as the vector update. Noise along a line of sight couples x, y and z, but not the axes of its own
 * frame: the estimate is turned there, updated, and turned back.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_KALMAN_H
#define RHOTRACK_KALMAN_H

#include "rhotrack/linalg.h"
#include "rhotrack/measurement.h"
#include "rhotrack/status.h"

#define RHO_KALMAN_STATES 6
#define RHO_KALMAN_VARIANCE_MIN 1.0e-9f /* of a measured element; updates keep it there */
#define RHO_KALMAN_VARIANCE_MAX 1.0e12f /* beyond, the filter says nothing: RHO_ERROR_VALUE */

struct rho_kalman {
    float state[RHO_KALMAN_STATES];
    float covariance[RHO_TRIANGLE(RHO_KALMAN_STATES)];
};

/* Everything zero: no axis measured. Constant cost. */
void rho_kalman_init(struct rho_kalman *kalman);

/*
 * Opens axis 0 (x), 1 (y) or 2 (z) with a first position and its variance, velocity 0 with its variance; covariances
 * with the other axes become 0. Errors: NULL, VALUE (axis, not finite, variance outside
 * RHO_KALMAN_VARIANCE_MIN .. MAX). Constant cost.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_open_axis(struct rho_kalman *kalman, int axis,
                                                    float position_m, float position_variance,
                                                    float velocity_variance);

/*
 * Moves the estimate on by dt_s, -1e5 .. 1e5. noise_density is the power spectral density of white acceleration on
 * each open axis, (m/s^2)^2 s = m^2/s^3, >= 0: Q = density [dt^3/3 dt^2/2; dt^2/2 dt], so that one long step equals
 * several short ones. Going back (dt_s < 0) adds no noise: forth and back without noise is the identity but for
 * rounding.
 * Errors: NULL, VALUE (arguments, or a result beyond RHO_KALMAN_VARIANCE_MAX; unchanged).
 * Cost: about 240 instructions. Stack: 72 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_predict(struct rho_kalman *kalman, float dt_s,
                                                  float noise_density);

/*
 * Adds noise of its own to each open axis: a step of the papers that state Q a step, whatever its interval.
 * Errors: NULL, VALUE (a variance negative or not finite, a result beyond RHO_KALMAN_VARIANCE_MAX); unchanged.
 * Cost: about 60 instructions. Stack: 16 bytes.
 */
RHO_MUST_CHECK enum rho_status
rho_kalman_add_noise(struct rho_kalman *kalman, float position_variance, float velocity_variance);

/*
 * One scalar update: element 0 .. 5 of the state was measured as value with the given variance > 0 (below
 * RHO_KALMAN_VARIANCE_MIN it counts as that). *nis (may be NULL) gets the normalised innovation squared. On an axis
 * that is not open nothing else changes. Errors: NULL, VALUE (element, value or variance, a result not finite),
 * SINGULAR (innovation variance not positive and finite); unchanged. Cost: about 300 instructions. Stack: 144 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_update(struct rho_kalman *kalman, int element,
                                                 float value, float variance, float *nis);

/*
 * One scalar update: row . state was measured, `innovation` is its measured minus predicted value, `variance` its
 * noise.
 * Errors as above. Cost: about 590 instructions. Stack: 200 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_update_row(struct rho_kalman *kalman, const float row[6],
                                                     float innovation, float variance, float *nis);

/*
 * 1 .. 6 elements of the state were measured together: elements[i] as values[i], the noise's covariance a packed
 * triangle. It is made diagonal once, R = L D L^T without a square root, and each row of L^-1 H is a scalar update.
 * Elements of an axis that is not open are left out. Errors: NULL, VALUE (num, an element, a value or covariance not
 * finite, a result), SINGULAR (R not positive definite, an innovation variance); unchanged.
 * Cost: about 2700 instructions for 3 elements, 6250 for 6. Stack: 570 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_update_correlated(struct rho_kalman *kalman, int num,
                                                            const int elements[],
                                                            const float values[],
                                                            const float covariance[]);

/*
 * Updates with a position: x and y, and z where it was measured. An axis that is not open is opened with its place
 * and its noise, and a velocity of 0 with variance velocity_variance. After an error the filter is partly updated:
 * work on a copy where that matters. Errors: as rho_kalman_update and rho_kalman_open_axis.
 * Cost: a scalar update an axis, and where the noise is not isotropic 2 (with z 4) turns there and as many back, about
 * 200 instructions each. Stack: 310 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_update_position(struct rho_kalman *kalman,
                                                          const struct rho_measurement *measurement,
                                                          float velocity_variance);

/* A scalar measurement of an estimate, linearised there: what rho_kalman_update_row takes. */
struct rho_kalman_row {
    float row[RHO_KALMAN_STATES];
    float innovation; /* measured minus predicted */
    float variance;   /* the noise, and what the derivative leaves out */
};

/*
 * Fills *seen for a range rate with noise `variance`. Returns 0, and fills nothing, where the estimate is nearer than a
 * metre to the sensor. Cost: rho_measurement_range_rate, and a division. Stack: 170 bytes.
 */
int rho_kalman_see_range_rate(const struct rho_kalman *kalman, const struct rho_sensor *sensor,
                              float rate_mps, float variance, struct rho_kalman_row *seen);

/*
 * True where what was seen of a range rate tells the estimate something: always, but where it is ambiguous and the estimate
 * does not tell which one is meant (measurement.h). Cost: rho_linalg_project6 where it is ambiguous.
 */
#if RHO_AMBIGUOUS_RANGE_RATES
int rho_kalman_tells_range_rate(const struct rho_kalman *kalman, const struct rho_sensor *sensor,
                                const struct rho_kalman_row *seen);
#else
static inline int rho_kalman_tells_range_rate(const struct rho_kalman *kalman,
                                              const struct rho_sensor *sensor,
                                              const struct rho_kalman_row *seen)
{
    (void)kalman, (void)sensor, (void)seen;
    return 1;
}
#endif

/*
 * Updates with a range rate seen from `sensor` (NULL: the origin), linearised at the estimate: after the position of
 * the same plot. An estimate nearer than a metre to the sensor has no range rate, and an
 * ambiguous one may tell nothing: nothing is done, RHO_OK.
 * Errors: as rho_kalman_update_row. Cost: that and rho_measurement_range_rate. Stack: 250 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_update_range_rate(struct rho_kalman *kalman,
                                                            const struct rho_sensor *sensor,
                                                            float rate_mps, float variance);

/* A bearing from a place as a scalar measurement of an estimate, in metres across the line of sight. */
struct rho_kalman_bearing {
    float row[RHO_KALMAN_STATES];
    float off_m;       /* measured minus predicted */
    float variance_m2; /* the noise */
    float range_m;
};

/*
 * Fills *seen; to the noise is added what the derivative leaves out where the place is uncertain along and across the line
 * of sight. Returns 0, and fills nothing, where the estimate is nearer than a metre to the place.
 * Cost: an arctangent, a square root, two divisions. Stack: 96 bytes.
 */
int rho_kalman_see_bearing(const struct rho_kalman *kalman, float x_m, float y_m, float bearing_rad,
                           float sigma_rad, struct rho_kalman_bearing *seen);

/*
 * Updates with a bearing from a place, linearised at the estimate. An estimate nearer than a metre to the place has no
 * bearing: nothing is done, RHO_OK.
 * Errors: as rho_kalman_update_row. Cost: that and rho_kalman_see_bearing. Stack: 300 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_kalman_update_bearing(struct rho_kalman *kalman, float x_m,
                                                         float y_m, float bearing_rad,
                                                         float sigma_rad);

/* True where axis 0 .. 2 was opened. */
int rho_kalman_is_open(const struct rho_kalman *kalman, int axis);

#endif
