/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/kalman.h"

#include <float.h>
#include <stddef.h>

#include "rhotrack/detail/angle.h"

/* Indices in the triangle: variance of element i, cov(velocity of axis a, position of axis b). */
#define DIAGONAL(i) RHO_AT(i, i)
#define VELOCITY_POSITION(a, b) (RHO_TRIANGLE(RHO_AXES + (a)) + (b))

/* Prediction of one axis. All axes are computed and checked before any is stored. */
struct axis_prediction {
    float position_m, position_variance, velocity_variance, mixed;
};

static int is_valid_variance(float v)
{
    return v >= RHO_VARIANCE_MIN && v <= RHO_VARIANCE_MAX;
}

/* Predicts an axis: F x, F P F^T + Q, F = [1 dt; 0 1]; noise: density x dt. False beyond limits. */
static inline int predict_axis(struct axis_prediction *next, const struct rho_kalman *kalman,
                               int axis, float dt_s, float noise)
{
    const float *p = kalman->covariance;
    const float position = p[DIAGONAL(axis)];
    const float velocity = p[DIAGONAL(RHO_AXES + axis)];
    const float mixed = p[VELOCITY_POSITION(axis, axis)];
    const float q = position > 0.0f ? noise : 0.0f;
    const float moved = dt_s * velocity;
    const float moved_twice = dt_s * moved;
    /*
     * raised by thirty-two units of rounding of the positive terms: more than the error of any sum
     * in its row, forth or back in time, so that a positive definite covariance stays so
     */
    const float predicted = position + moved_twice + 2.0f * dt_s * mixed +
                            (position + moved_twice) * RHO_ROUNDING_UNITS(32) +
                            q * dt_s * dt_s * (1.0f / 3.0f);
    /* zero marks a closed axis and stays; a negative value stays, too, and is refused */
    const int is_low = predicted >= 0.0f && predicted < RHO_VARIANCE_MIN && position > 0.0f;
    next->position_m = kalman->state[axis] + dt_s * kalman->state[RHO_AXES + axis];
    next->position_variance = is_low ? RHO_VARIANCE_MIN : predicted;
    next->velocity_variance = velocity + q;
    next->mixed = mixed + moved + 0.5f * dt_s * q;
    return rho_is_finite(next->position_m) && next->position_variance >= 0.0f &&
           next->position_variance <= RHO_VARIANCE_MAX && next->velocity_variance >= 0.0f &&
           next->velocity_variance <= RHO_VARIANCE_MAX;
}

void rho_kalman_init(struct rho_kalman *kalman)
{
    *kalman = (struct rho_kalman){.state = {0.0f}};
}

enum rho_status rho_kalman_open_axis(struct rho_kalman *kalman, int axis, float position_m,
                                     float position_variance, float velocity_variance)
{
    if (axis < 0 || axis >= RHO_AXES || !rho_is_finite(position_m) ||
        !is_valid_variance(position_variance) || !is_valid_variance(velocity_variance)) {
        return RHO_ERROR_VALUE;
    }
    for (int i = 0; i < RHO_KALMAN_STATES; ++i) {
        kalman->covariance[RHO_AT(axis, i)] = 0.0f;
        kalman->covariance[RHO_AT(RHO_AXES + axis, i)] = 0.0f;
    }
    kalman->state[axis] = position_m;
    kalman->state[RHO_AXES + axis] = 0.0f;
    kalman->covariance[DIAGONAL(axis)] = position_variance;
    kalman->covariance[DIAGONAL(RHO_AXES + axis)] = velocity_variance;
    return RHO_OK;
}

void rho_kalman_set_equal_variances(struct rho_kalman *kalman, float variance)
{
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        for (int j = 0; j <= i; j++) {
            kalman->covariance[RHO_AT(i, j)] =
                i == j && rho_kalman_has_axis(kalman, i % 3) ? variance : 0.0f;
        }
    }
}

enum rho_status rho_kalman_predict(struct rho_kalman *kalman, float dt_s, float noise_density)
{
    const float noise = dt_s > 0.0f ? noise_density * dt_s : 0.0f;
    struct axis_prediction next[RHO_AXES];
    if (!(dt_s >= -RHO_KALMAN_STEP_MAX_S && dt_s <= RHO_KALMAN_STEP_MAX_S &&
          noise_density >= 0.0f && noise_density <= FLT_MAX)) {
        return RHO_ERROR_VALUE;
    }
    if (!(dt_s > 0.0f || dt_s < 0.0f)) {
        return RHO_OK; /* dt 0: the estimate stays bit for bit */
    }
    RHO_UNROLL
    for (int axis = 0; axis < RHO_AXES; ++axis) {
        if (!predict_axis(&next[axis], kalman, axis, dt_s, noise)) {
            return RHO_ERROR_VALUE;
        }
    }
    /*
     * covariances of two axes, F P F^T: with P = [A C^T; C V] this is A + dt (C + C^T) + dt^2 V and
     * C + dt V; one of the two C is predicted first, so that A needs one multiplication
     */
    float *p = kalman->covariance;
    RHO_UNROLL
    for (int a = 1; a < RHO_AXES; ++a) {
        RHO_UNROLL
        for (int b = 0; b < a; ++b) {
            const float moved = dt_s * p[VELOCITY_POSITION(a, RHO_AXES + b)];
            const float mixed_ab = p[VELOCITY_POSITION(a, b)] + moved;
            const float mixed_ba = p[VELOCITY_POSITION(b, a)];
            p[RHO_TRIANGLE(a) + b] += dt_s * (mixed_ab + mixed_ba);
            p[VELOCITY_POSITION(a, b)] = mixed_ab;
            p[VELOCITY_POSITION(b, a)] = mixed_ba + moved;
        }
    }
    RHO_UNROLL
    for (int axis = 0; axis < RHO_AXES; ++axis) {
        kalman->state[axis] = next[axis].position_m;
        p[DIAGONAL(axis)] = next[axis].position_variance;
        p[DIAGONAL(RHO_AXES + axis)] = next[axis].velocity_variance;
        p[VELOCITY_POSITION(axis, axis)] = next[axis].mixed;
    }
    return RHO_OK;
}

static void floor_variances(struct rho_kalman *kalman)
{
    rho_kalman_floor_variances(kalman->covariance, RHO_KALMAN_STATES);
}

enum rho_status rho_kalman_update(struct rho_kalman *kalman, int element, float value,
                                  float variance, float *nis)
{
    if (element < 0 || element >= RHO_KALMAN_STATES || !rho_is_finite(value) ||
        !(variance > 0.0f && variance <= FLT_MAX)) {
        return RHO_ERROR_VALUE;
    }
    /* noise below the floor could make the variance 0, which marks a closed axis */
    const float noise = rho_kalman_floored(variance);
    const enum rho_status status = rho_linalg_update6_element(
        kalman->state, kalman->covariance, element, value - kalman->state[element], noise, nis);
    if (status == RHO_OK) {
        floor_variances(kalman);
    }
    return status;
}

enum rho_status rho_kalman_update_row(struct rho_kalman *kalman, const float row[6],
                                      float innovation, float variance)
{
    if (!rho_is_finite(innovation) || !(variance > 0.0f && variance <= FLT_MAX)) {
        return RHO_ERROR_VALUE;
    }
    const float noise = rho_kalman_floored(variance);
    const enum rho_status status =
        rho_linalg_update6_row(kalman->state, kalman->covariance, row, innovation, noise);
    if (status == RHO_OK) {
        floor_variances(kalman);
    }
    return status;
}

static void rotate_vector(float v[3], int a, int b, float c, float s)
{
    const float was_a = v[a], was_b = v[b];
    v[a] = c * was_a + s * was_b;
    v[b] = c * was_b - s * was_a;
}

/* Rotates the frame of the estimate, positions and velocities, in the plane of axes a and b. */
static void rotate_estimate(struct rho_kalman *kalman, int a, int b, float c, float s)
{
    rotate_vector(&kalman->state[0], a, b, c, s);
    rotate_vector(&kalman->state[RHO_AXES], a, b, c, s);
    rho_linalg_rotate6(kalman->covariance, a, b, c, s);
    rho_linalg_rotate6(kalman->covariance, RHO_AXES + a, RHO_AXES + b, c, s);
}

/* Updates one axis with a position; opens a closed one. */
static enum rho_status update_axis(struct rho_kalman *kalman, int axis, float place_m,
                                   float variance, float velocity_variance)
{
    if (!rho_kalman_has_axis(kalman, axis)) {
        return rho_kalman_open_axis(kalman, axis, place_m, variance, velocity_variance);
    }
    return rho_kalman_update(kalman, axis, place_m, variance, NULL);
}

static enum rho_status update_axes(struct rho_kalman *kalman, int num_axes, const float place_m[3],
                                   const float variance[3], float velocity_variance)
{
    enum rho_status status = RHO_OK;
    for (int axis = 0; axis < num_axes && status == RHO_OK; ++axis) {
        status = update_axis(kalman, axis, place_m[axis], variance[axis], velocity_variance);
    }
    return status;
}

/*
 * Updates with a position in the frame of the plot's noise. The axes are all open, or all closed.
 * The estimate is taken relative to the plot: rotating a far position would cost digits.
 */
static enum rho_status update_in_noise_frame(struct rho_kalman *kalman, int num_axes,
                                             const struct rho_measurement *seen,
                                             float velocity_variance)
{
    static const float here_m[3] = {0.0f, 0.0f, 0.0f};
    const int has_elevation = num_axes == RHO_AXES;
    for (int axis = 0; axis < num_axes; ++axis) {
        kalman->state[axis] -= seen->place_m[axis];
    }
    rotate_estimate(kalman, RHO_X, RHO_Y, seen->cos_azimuth, seen->sin_azimuth);
    if (has_elevation) {
        rotate_estimate(kalman, RHO_X, RHO_Z, seen->cos_elevation, seen->sin_elevation);
    }
    const enum rho_status status =
        update_axes(kalman, num_axes, here_m, seen->variance_m2, velocity_variance);
    if (has_elevation) {
        rotate_estimate(kalman, RHO_X, RHO_Z, seen->cos_elevation, -seen->sin_elevation);
    }
    rotate_estimate(kalman, RHO_X, RHO_Y, seen->cos_azimuth, -seen->sin_azimuth);
    for (int axis = 0; axis < num_axes; ++axis) {
        kalman->state[axis] += seen->place_m[axis];
    }
    return status;
}

enum rho_status rho_kalman_update_position(struct rho_kalman *kalman,
                                           const struct rho_measurement *measurement,
                                           float velocity_variance)
{
    const int num_axes = measurement->has_z ? RHO_AXES : 2;
    if (!rho_are_finite(measurement->place_m, (size_t)num_axes)) {
        return RHO_ERROR_VALUE;
    }
    if (measurement->is_isotropic) {
        return update_axes(kalman, num_axes, measurement->place_m, measurement->variance_m2,
                           velocity_variance);
    }
    const int is_open = rho_kalman_has_axis(kalman, RHO_X);
    if (is_open != rho_kalman_has_axis(kalman, RHO_Y)) {
        return RHO_ERROR_VALUE;
    }
    if (!measurement->has_z || is_open == rho_kalman_has_axis(kalman, RHO_Z)) {
        return update_in_noise_frame(kalman, num_axes, measurement, velocity_variance);
    }
    /* only one of (x, y) and z is open: z is updated apart, with its own variance */
    struct rho_measurement level = *measurement;
    float covariance[6];
    rho_measurement_covariance(measurement, covariance);
    level.variance_m2[0] = rho_measurement_ground_m2(measurement);
    level.has_z = 0;
    const enum rho_status status = update_in_noise_frame(kalman, 2, &level, velocity_variance);
    return status == RHO_OK ? update_axis(kalman, RHO_Z, measurement->place_m[2],
                                          covariance[RHO_ZZ], velocity_variance)
                            : status;
}

int rho_kalman_linearise_rate(const struct rho_kalman *kalman, const struct rho_sensor *sensor,
                              float rate_mps, float variance, struct rho_kalman_row *seen)
{
    const float place_m[RHO_AXES] = {sensor ? sensor->x_m : 0.0f, sensor ? sensor->y_m : 0.0f,
                                     sensor ? sensor->z_m : 0.0f};
    const float *state = kalman->state;
    float predicted_mps, range2_m2 = 0.0f, spread_m2 = 0.0f, speed2 = 0.0f;
    if (!rho_measurement_predict_rate(state, sensor, rho_kalman_has_axis(kalman, RHO_Z), seen->row,
                                      &predicted_mps)) {
        return 0;
    }
    /*
     * The linearisation leaves out a variance if the position's sigma is large against the range: a
     * position error of sigma rotates the line of sight by sigma / range, which changes the range
     * rate by up to (sigma / range)^2 / 2 times the speed.
     */
    for (int axis = 0; axis < RHO_AXES; axis++) {
        if (rho_kalman_has_axis(kalman, axis)) {
            const float off_m = state[axis] - place_m[axis];
            range2_m2 += off_m * off_m;
            spread_m2 += kalman->covariance[DIAGONAL(axis)];
            speed2 += state[axis + RHO_AXES] * state[axis + RHO_AXES];
        }
    }
    const float share = spread_m2 / range2_m2, nonlinearity = 0.5f * speed2 * share * share;
    seen->innovation = rho_measurement_innovation_mps(sensor, rate_mps, predicted_mps);
    seen->variance = variance;
    if (variance > 0.0f && nonlinearity <= FLT_MAX) { /* else the update refuses the variance */
        seen->variance += nonlinearity;
    }
    return 1;
}

int rho_kalman_can_unfold(const struct rho_kalman *kalman, const struct rho_sensor *sensor,
                          const struct rho_kalman_row *seen)
{
    float projected[RHO_KALMAN_STATES];
    return !rho_measurement_is_ambiguous(sensor) ||
           rho_measurement_can_unfold(
               sensor,
               rho_linalg_project6(kalman->covariance, seen->row, projected) + seen->variance);
}

enum rho_status rho_kalman_update_range_rate(struct rho_kalman *kalman,
                                             const struct rho_sensor *sensor, float rate_mps,
                                             float variance)
{
    struct rho_kalman_row seen;
    if (!rho_kalman_linearise_rate(kalman, sensor, rate_mps, variance, &seen) ||
        !rho_kalman_can_unfold(kalman, sensor, &seen)) {
        return RHO_OK;
    }
    return rho_kalman_update_row(kalman, seen.row, seen.innovation, seen.variance);
}

int rho_kalman_linearise_bearing(const struct rho_kalman *kalman, float x_m, float y_m,
                                 float bearing_rad, float sigma_rad,
                                 struct rho_kalman_bearing *seen)
{
    const float dx_m = kalman->state[RHO_X] - x_m, dy_m = kalman->state[RHO_Y] - y_m;
    const float range2_m2 = dx_m * dx_m + dy_m * dy_m;
    if (!(range2_m2 >= RHO_RANGE_LEAST_M * RHO_RANGE_LEAST_M) || !(range2_m2 <= FLT_MAX)) {
        return 0;
    }
    const float range_m = rho_sqrt(range2_m2), s = -dy_m / range_m, c = dx_m / range_m;
    for (int i = RHO_Z; i < RHO_KALMAN_STATES; i++) {
        seen->row[i] = 0.0f;
    }
    seen->row[RHO_X] = s;
    seen->row[RHO_Y] = c;
    seen->range_m = range_m;
    seen->off_m = range_m * rho_angle_difference(bearing_rad, rho_atan2(dy_m, dx_m));
    /*
     * The second derivative of the bearing is 1 / range^2 (along times across the line of sight):
     * for errors a along and c across, the linearisation leaves out a c / range metres, with the
     * variance (var a var c + cov^2) / range^2.
     */
    const float *p = kalman->covariance;
    const float xx = p[RHO_XX], xy = p[RHO_YX], yy = p[RHO_YY]; /* across (s, c), along (c, -s) */
    const float across = xx * s * s + 2.0f * xy * s * c + yy * c * c;
    const float along = xx * c * c - 2.0f * xy * s * c + yy * s * s;
    const float both = (xx - yy) * s * c + xy * (c * c - s * s);
    const float sigma_m = sigma_rad * range_m;
    seen->variance_m2 = sigma_m * sigma_m + ((across / range_m) * (along / range_m) +
                                             (both / range_m) * (both / range_m));
    return 1;
}

enum rho_status rho_kalman_update_bearing(struct rho_kalman *kalman, float x_m, float y_m,
                                          float bearing_rad, float sigma_rad)
{
    struct rho_kalman_bearing seen;
    if (!rho_is_finite(bearing_rad) || !(sigma_rad > 0.0f)) {
        return RHO_ERROR_VALUE;
    }
    if (!rho_kalman_linearise_bearing(kalman, x_m, y_m, bearing_rad, sigma_rad, &seen)) {
        return RHO_OK;
    }
    return rho_kalman_update_row(kalman, seen.row, seen.off_m, seen.variance_m2);
}

int rho_kalman_linearise_slope(const struct rho_kalman *kalman, const struct rho_slope *slope,
                               struct rho_kalman_bearing *seen)
{
    const float dx_m = kalman->state[RHO_X] - slope->x_m, dy_m = kalman->state[RHO_Y] - slope->y_m;
    const float range2_m2 = dx_m * dx_m + dy_m * dy_m;
    if (!(slope->sigma > 0.0f) || !(range2_m2 >= RHO_RANGE_LEAST_M * RHO_RANGE_LEAST_M) ||
        !(range2_m2 <= FLT_MAX)) {
        return 0;
    }
    const float range_m = rho_sqrt(range2_m2), c = dx_m / range_m, s = dy_m / range_m;
    *seen = (struct rho_kalman_bearing){
        .row = {[RHO_X] = -slope->value * c, [RHO_Y] = -slope->value * s, [RHO_Z] = 1.0f},
        .off_m = slope->z_m + slope->value * range_m - kalman->state[RHO_Z],
        .range_m = range_m};
    const float *p = kalman->covariance;
    const float along_m2 = p[RHO_XX] * c * c + 2.0f * p[RHO_YX] * s * c + p[RHO_YY] * s * s;
    seen->variance_m2 = slope->sigma * slope->sigma * (range2_m2 + along_m2);
    return 1;
}

float rho_kalman_slope_density(const struct rho_kalman *kalman, const struct rho_slope *slope,
                               float *nis)
{
    struct rho_kalman_bearing seen;
    float projected[RHO_KALMAN_STATES];
    *nis = 0.0f;
    if (!rho_kalman_has_axis(kalman, RHO_Z) || !rho_kalman_linearise_slope(kalman, slope, &seen)) {
        return 1.0f;
    }
    const float variance_m2 =
        rho_linalg_project6(kalman->covariance, seen.row, projected) + seen.variance_m2;
    *nis = seen.off_m * seen.off_m / variance_m2;
    return seen.range_m * rho_exp(-0.5f * (*nis + RHO_LOG_TWO_PI)) * rho_inverse_sqrt(variance_m2);
}

enum rho_status rho_kalman_open_height(struct rho_kalman *kalman,
                                       const struct rho_kalman_bearing *seen,
                                       float velocity_variance)
{
    float projected[RHO_KALMAN_STATES];
    const float variance_m2 =
        rho_linalg_project6(kalman->covariance, seen->row, projected) * RHO_ROUNDING_ALLOWANCE +
        seen->variance_m2;
    const enum rho_status status = rho_kalman_open_axis(
        kalman, RHO_Z, kalman->state[RHO_Z] + seen->off_m, variance_m2, velocity_variance);
    if (status == RHO_OK) {
        for (int i = 0; i < RHO_KALMAN_STATES; ++i) {
            if (i % RHO_AXES != RHO_Z) {
                kalman->covariance[RHO_AT(RHO_Z, i)] = -projected[i];
            }
        }
    }
    return status;
}

enum rho_status rho_kalman_update_slope(struct rho_kalman *kalman, const struct rho_slope *slope,
                                        float velocity_variance)
{
    struct rho_kalman_bearing seen;
    if (!rho_kalman_linearise_slope(kalman, slope, &seen)) {
        return RHO_OK;
    }
    return rho_kalman_has_axis(kalman, RHO_Z)
               ? rho_kalman_update_row(kalman, seen.row, seen.off_m, seen.variance_m2)
               : rho_kalman_open_height(kalman, &seen, velocity_variance);
}
