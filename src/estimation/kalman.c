/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/kalman.h"

#include <float.h>
#include <stddef.h>

#define NUM_AXES 3
#define TIME_STEP_MAX_S 1.0e5f

/*
 * A predicted position variance is raised by 2^-19 of its positive terms, thirty-two units of
 * float32's rounding: more than the error of any sum in its row, forth or back in time, so that a
 * positive definite covariance stays so.
 */
#define ROUNDING_ALLOWANCE (1.0f / 524288.0f)

/*
 * Indices in the packed triangle: of the variance of element i, and of cov(velocity of axis a,
 * position of axis b).
 */
#define DIAGONAL(i) RHO_AT(i, i)
#define VELOCITY_POSITION(a, b) (RHO_TRIANGLE(NUM_AXES + (a)) + (b))

/* Prediction of one axis. All axes are computed and checked before any is stored. */
struct axis_prediction {
    float position_m, position_variance, velocity_variance, mixed;
};

static int is_valid_variance(float v)
{
    return v >= RHO_KALMAN_VARIANCE_MIN && v <= RHO_KALMAN_VARIANCE_MAX;
}

/*
 * Raises a variance of an open axis to the floor. Zero marks a closed axis and stays; a negative
 * value stays, too, and is refused later.
 */
static inline float floored_if_open(float variance, float variance_before)
{
    const int is_low =
        variance >= 0.0f && variance < RHO_KALMAN_VARIANCE_MIN && variance_before > 0.0f;

    return is_low ? RHO_KALMAN_VARIANCE_MIN : variance;
}

/*
 * Predicts one axis: F x and F P F^T + Q, F = [1 dt; 0 1]. noise: density x dt. False where the
 * result is beyond the limits.
 */
static inline int predict_axis(struct axis_prediction *next, const struct rho_kalman *kalman,
                               int axis, float dt_s, float noise)
{
    const float *p = kalman->covariance;
    const float position = p[DIAGONAL(axis)];
    const float velocity = p[DIAGONAL(NUM_AXES + axis)];
    const float mixed = p[VELOCITY_POSITION(axis, axis)];
    const float q = position > 0.0f ? noise : 0.0f;
    const float moved = dt_s * velocity;
    const float moved_twice = dt_s * moved;
    const float predicted = position + moved_twice + 2.0f * dt_s * mixed +
                            (position + moved_twice) * ROUNDING_ALLOWANCE +
                            q * dt_s * dt_s * (1.0f / 3.0f);

    next->position_m = kalman->state[axis] + dt_s * kalman->state[NUM_AXES + axis];
    next->position_variance = floored_if_open(predicted, position);
    next->velocity_variance = velocity + q;
    next->mixed = mixed + moved + 0.5f * dt_s * q;
    return rho_is_finite(next->position_m) && next->position_variance >= 0.0f &&
           next->position_variance <= RHO_KALMAN_VARIANCE_MAX && next->velocity_variance >= 0.0f &&
           next->velocity_variance <= RHO_KALMAN_VARIANCE_MAX;
}

/*
 * Predicts the covariances of two axes, F P F^T: with P = [A C^T; C V] this is A + dt (C + C^T) +
 * dt^2 V and C + dt V. One of the two C is predicted first, so that A needs one multiplication.
 */
static inline void predict_axis_pair(float *p, int a, int b, float dt_s)
{
    const float moved = dt_s * p[VELOCITY_POSITION(a, NUM_AXES + b)];
    const float mixed_ab = p[VELOCITY_POSITION(a, b)] + moved;
    const float mixed_ba = p[VELOCITY_POSITION(b, a)];

    p[RHO_TRIANGLE(a) + b] += dt_s * (mixed_ab + mixed_ba);
    p[VELOCITY_POSITION(a, b)] = mixed_ab;
    p[VELOCITY_POSITION(b, a)] = mixed_ba + moved;
}

static inline void store_predicted_axis(struct rho_kalman *kalman, int axis,
                                        const struct axis_prediction *next)
{
    kalman->state[axis] = next->position_m;
    kalman->covariance[DIAGONAL(axis)] = next->position_variance;
    kalman->covariance[DIAGONAL(NUM_AXES + axis)] = next->velocity_variance;
    kalman->covariance[VELOCITY_POSITION(axis, axis)] = next->mixed;
}

/* Raises a variance of an open axis to the floor; 0 marks a closed axis and stays. */
static inline void raise_nonzero_to_floor(float *variance)
{
    if (*variance < RHO_KALMAN_VARIANCE_MIN && (*variance > 0.0f || *variance < 0.0f)) {
        *variance = RHO_KALMAN_VARIANCE_MIN;
    }
}

static void raise_variances_to_floor(struct rho_kalman *kalman)
{
    RHO_UNROLL
    for (int i = 0; i < RHO_KALMAN_STATES; ++i) {
        raise_nonzero_to_floor(&kalman->covariance[DIAGONAL(i)]);
    }
}

void rho_kalman_init(struct rho_kalman *kalman)
{
    static const struct rho_kalman nothing_measured = {.state = {0.0f}, .covariance = {0.0f}};

    if (kalman != NULL) {
        *kalman = nothing_measured;
    }
}

enum rho_status rho_kalman_open_axis(struct rho_kalman *kalman, int axis, float position_m,
                                     float position_variance, float velocity_variance)
{
    int i;

    if (kalman == NULL) {
        return RHO_ERROR_NULL;
    }
    if (axis < 0 || axis >= NUM_AXES || !rho_is_finite(position_m) ||
        !is_valid_variance(position_variance) || !is_valid_variance(velocity_variance)) {
        return RHO_ERROR_VALUE;
    }
    for (i = 0; i < RHO_KALMAN_STATES; ++i) {
        kalman->covariance[RHO_AT(axis, i)] = 0.0f;
        kalman->covariance[RHO_AT(NUM_AXES + axis, i)] = 0.0f;
    }
    kalman->state[axis] = position_m;
    kalman->state[NUM_AXES + axis] = 0.0f;
    kalman->covariance[DIAGONAL(axis)] = position_variance;
    kalman->covariance[DIAGONAL(NUM_AXES + axis)] = velocity_variance;
    return RHO_OK;
}

void rho_kalman_set_equal_variances(struct rho_kalman *kalman, float variance)
{
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        for (int j = 0; j <= i; j++) {
            kalman->covariance[RHO_AT(i, j)] =
                i == j && rho_kalman_has_estimate_on_axis(kalman, i % 3) ? variance : 0.0f;
        }
    }
}

enum rho_status rho_kalman_predict(struct rho_kalman *kalman, float dt_s, float noise_density)
{
    const float noise = dt_s > 0.0f ? noise_density * dt_s : 0.0f;
    struct axis_prediction next[NUM_AXES];

    if (kalman == NULL) {
        return RHO_ERROR_NULL;
    }
    if (!(dt_s >= -TIME_STEP_MAX_S && dt_s <= TIME_STEP_MAX_S && noise_density >= 0.0f &&
          noise_density <= FLT_MAX)) {
        return RHO_ERROR_VALUE;
    }
    if (!(dt_s > 0.0f || dt_s < 0.0f)) {
        return RHO_OK; /* dt 0: the estimate stays bit for bit */
    }
    RHO_UNROLL
    for (int axis = 0; axis < NUM_AXES; ++axis) {
        if (!predict_axis(&next[axis], kalman, axis, dt_s, noise)) {
            return RHO_ERROR_VALUE;
        }
    }
    RHO_UNROLL
    for (int axis = 1; axis < NUM_AXES; ++axis) {
        RHO_UNROLL
        for (int other = 0; other < axis; ++other) {
            predict_axis_pair(kalman->covariance, axis, other, dt_s);
        }
    }
    RHO_UNROLL
    for (int axis = 0; axis < NUM_AXES; ++axis) {
        store_predicted_axis(kalman, axis, &next[axis]);
    }
    return RHO_OK;
}

/* True where the sum of a variance and `by` is within the limit; false for NaN. */
static int can_add_variance(float variance, float added)
{
    return variance + added <= RHO_KALMAN_VARIANCE_MAX;
}

enum rho_status rho_kalman_add_noise(struct rho_kalman *kalman, float position_variance,
                                     float velocity_variance)
{
    int axis;

    if (kalman == NULL) {
        return RHO_ERROR_NULL;
    }
    if (!(position_variance >= 0.0f && velocity_variance >= 0.0f)) {
        return RHO_ERROR_VALUE;
    }
    for (axis = 0; axis < NUM_AXES; ++axis) {
        if (!can_add_variance(kalman->covariance[DIAGONAL(axis)], position_variance) ||
            !can_add_variance(kalman->covariance[DIAGONAL(NUM_AXES + axis)], velocity_variance)) {
            return RHO_ERROR_VALUE;
        }
    }
    for (axis = 0; axis < NUM_AXES; ++axis) {
        if (rho_kalman_has_estimate_on_axis(kalman, axis)) {
            kalman->covariance[DIAGONAL(axis)] += position_variance;
            kalman->covariance[DIAGONAL(NUM_AXES + axis)] += velocity_variance;
        }
    }
    return RHO_OK;
}

enum rho_status rho_kalman_update(struct rho_kalman *kalman, int element, float value,
                                  float variance, float *nis)
{
    enum rho_status status;
    float noise;

    if (kalman == NULL) {
        return RHO_ERROR_NULL;
    }
    if (element < 0 || element >= RHO_KALMAN_STATES || !rho_is_finite(value) ||
        !(variance > 0.0f && variance <= FLT_MAX)) {
        return RHO_ERROR_VALUE;
    }
    /* noise below the floor could make the variance 0, which marks a closed axis */
    noise = variance < RHO_KALMAN_VARIANCE_MIN ? RHO_KALMAN_VARIANCE_MIN : variance;
    status = rho_linalg_update6_element(kalman->state, kalman->covariance, element,
                                        value - kalman->state[element], noise, nis);
    if (status == RHO_OK) {
        raise_variances_to_floor(kalman);
    }
    return status;
}

enum rho_status rho_kalman_update_row(struct rho_kalman *kalman, const float row[6],
                                      float innovation, float variance, float *nis)
{
    enum rho_status status;
    float noise;

    if (kalman == NULL || row == NULL) {
        return RHO_ERROR_NULL;
    }
    if (!rho_is_finite(innovation) || !(variance > 0.0f && variance <= FLT_MAX)) {
        return RHO_ERROR_VALUE;
    }
    noise = variance < RHO_KALMAN_VARIANCE_MIN ? RHO_KALMAN_VARIANCE_MIN : variance;
    status = rho_linalg_update6_row(kalman->state, kalman->covariance, row, innovation, noise, nis);
    if (status == RHO_OK) {
        raise_variances_to_floor(kalman);
    }
    return status;
}

/* ---- positions with noise of their own frame ---- */

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
    rotate_vector(&kalman->state[NUM_AXES], a, b, c, s);
    rho_linalg_rotate6(kalman->covariance, a, b, c, s);
    rho_linalg_rotate6(kalman->covariance, NUM_AXES + a, NUM_AXES + b, c, s);
}

/* Updates one axis with a position, or opens it. */
static enum rho_status open_or_update_axis(struct rho_kalman *kalman, int axis, float place_m,
                                           float variance, float velocity_variance)
{
    if (!rho_kalman_has_estimate_on_axis(kalman, axis)) {
        return rho_kalman_open_axis(kalman, axis, place_m, variance, velocity_variance);
    }
    return rho_kalman_update(kalman, axis, place_m, variance, NULL);
}

static enum rho_status open_or_update_axes(struct rho_kalman *kalman, int num_axes,
                                           const float place_m[3], const float variance[3],
                                           float velocity_variance)
{
    enum rho_status status = RHO_OK;
    int axis;

    for (axis = 0; axis < num_axes && status == RHO_OK; ++axis) {
        status =
            open_or_update_axis(kalman, axis, place_m[axis], variance[axis], velocity_variance);
    }
    return status;
}

/*
 * Updates with a position in the frame of the plot's noise. The axes are all open, or all closed.
 * The estimate is taken relative to the plot: rotating a position far from the origin would cost
 * digits.
 */
static enum rho_status update_in_noise_frame(struct rho_kalman *kalman, int num_axes,
                                             const struct rho_measurement *seen,
                                             float velocity_variance)
{
    static const float here_m[3] = {0.0f, 0.0f, 0.0f};
    const int has_elevation = num_axes == NUM_AXES;
    enum rho_status status;
    int axis;

    for (axis = 0; axis < num_axes; ++axis) {
        kalman->state[axis] -= seen->place_m[axis];
    }
    rotate_estimate(kalman, RHO_X, RHO_Y, seen->cos_azimuth, seen->sin_azimuth);
    if (has_elevation) {
        rotate_estimate(kalman, RHO_X, RHO_Z, seen->cos_elevation, seen->sin_elevation);
    }
    status = open_or_update_axes(kalman, num_axes, here_m, seen->variance_m2, velocity_variance);
    if (has_elevation) {
        rotate_estimate(kalman, RHO_X, RHO_Z, seen->cos_elevation, -seen->sin_elevation);
    }
    rotate_estimate(kalman, RHO_X, RHO_Y, seen->cos_azimuth, -seen->sin_azimuth);
    for (axis = 0; axis < num_axes; ++axis) {
        kalman->state[axis] += seen->place_m[axis];
    }
    return status;
}

/*
 * Updates x and y in the frame of the noise, and z separately with its own variance, where only one
 * of (x, y) and z is open.
 */
static enum rho_status update_xy_and_height_separately(struct rho_kalman *kalman,
                                                       const struct rho_measurement *seen,
                                                       float velocity_variance)
{
    struct rho_measurement level = *seen;
    float covariance[6];
    enum rho_status status;

    rho_measurement_covariance(seen, covariance);
    level.variance_m2[0] = seen->cos_elevation * seen->cos_elevation * seen->variance_m2[0] +
                           seen->sin_elevation * seen->sin_elevation * seen->variance_m2[2];
    level.has_z = 0;
    status = update_in_noise_frame(kalman, 2, &level, velocity_variance);
    if (status == RHO_OK) {
        status = open_or_update_axis(kalman, RHO_Z, seen->place_m[2], covariance[RHO_ZZ],
                                     velocity_variance);
    }
    return status;
}

static int is_finite_place(const float place_m[3], int num_axes)
{
    return rho_is_finite(place_m[0]) && rho_is_finite(place_m[1]) &&
           (num_axes < NUM_AXES || rho_is_finite(place_m[2]));
}

enum rho_status rho_kalman_update_position(struct rho_kalman *kalman,
                                           const struct rho_measurement *measurement,
                                           float velocity_variance)
{
    const int num_axes = measurement != NULL && measurement->has_z ? NUM_AXES : 2;

    if (kalman == NULL || measurement == NULL) {
        return RHO_ERROR_NULL;
    }
    if (!is_finite_place(measurement->place_m, num_axes)) {
        return RHO_ERROR_VALUE;
    }
    if (measurement->is_isotropic) {
        return open_or_update_axes(kalman, num_axes, measurement->place_m, measurement->variance_m2,
                                   velocity_variance);
    }
    if (rho_kalman_has_estimate_on_axis(kalman, RHO_X) !=
        rho_kalman_has_estimate_on_axis(kalman, RHO_Y)) {
        return RHO_ERROR_VALUE;
    }
    if (measurement->has_z && rho_kalman_has_estimate_on_axis(kalman, RHO_X) !=
                                  rho_kalman_has_estimate_on_axis(kalman, RHO_Z)) {
        return update_xy_and_height_separately(kalman, measurement, velocity_variance);
    }
    return update_in_noise_frame(kalman, num_axes, measurement, velocity_variance);
}

/*
 * Variance of a range rate that the linearisation leaves out if the position's sigma is large
 * against the range: a position error of sigma rotates the line of sight by sigma / range, which
 * changes the range rate by up to (sigma / range)^2 / 2 times the speed.
 */
static float range_rate_nonlinearity_variance(const struct rho_kalman *kalman,
                                              const struct rho_sensor *sensor)
{
    const float *state = kalman->state;
    float range2_m2 = 0.0f, spread_m2 = 0.0f, speed2 = 0.0f;
    const float place_m[NUM_AXES] = {sensor ? sensor->x_m : 0.0f, sensor ? sensor->y_m : 0.0f,
                                     sensor ? sensor->z_m : 0.0f};
    for (int axis = 0; axis < NUM_AXES; axis++) {
        if (rho_kalman_has_estimate_on_axis(kalman, axis)) {
            float off_m = state[axis] - place_m[axis];
            range2_m2 += off_m * off_m;
            spread_m2 += kalman->covariance[DIAGONAL(axis)];
            speed2 += state[axis + NUM_AXES] * state[axis + NUM_AXES];
        }
    }
    float share = spread_m2 / range2_m2;
    return 0.5f * speed2 * share * share;
}

int rho_kalman_linearise_range_rate(const struct rho_kalman *kalman,
                                    const struct rho_sensor *sensor, float rate_mps, float variance,
                                    struct rho_kalman_row *seen)
{
    float predicted_mps;

    if (!rho_measurement_predict_range_rate(kalman->state, sensor,
                                            rho_kalman_has_estimate_on_axis(kalman, RHO_Z),
                                            seen->row, &predicted_mps)) {
        return 0;
    }
    const float nonlinearity = range_rate_nonlinearity_variance(kalman, sensor);
    seen->innovation = rho_measurement_range_rate_innovation_mps(sensor, rate_mps, predicted_mps);
    seen->variance = variance;
    if (variance > 0.0f && nonlinearity <= FLT_MAX) { /* else the update refuses the variance */
        seen->variance += nonlinearity;
    }
    return 1;
}

int rho_kalman_can_unfold_range_rate(const struct rho_kalman *kalman,
                                     const struct rho_sensor *sensor,
                                     const struct rho_kalman_row *seen)
{
    float projected[RHO_KALMAN_STATES];

    return !rho_measurement_has_ambiguous_range_rates(sensor) ||
           rho_measurement_can_unfold_range_rate(
               sensor,
               rho_linalg_project6(kalman->covariance, seen->row, projected) + seen->variance);
}

enum rho_status rho_kalman_update_range_rate(struct rho_kalman *kalman,
                                             const struct rho_sensor *sensor, float rate_mps,
                                             float variance)
{
    struct rho_kalman_row seen;

    if (kalman == NULL) {
        return RHO_ERROR_NULL;
    }
    if (!rho_kalman_linearise_range_rate(kalman, sensor, rate_mps, variance, &seen) ||
        !rho_kalman_can_unfold_range_rate(kalman, sensor, &seen)) {
        return RHO_OK;
    }
    return rho_kalman_update_row(kalman, seen.row, seen.innovation, seen.variance, NULL);
}

/*
 * Variance of a bearing, in metres across, that the linearisation leaves out. The second derivative
 * of the bearing is 1 / range^2 (along times across the line of sight): for errors a along and c
 * across, a c / range metres are left out, with the variance (var a var c + cov^2) / range^2.
 */
static float bearing_nonlinearity_variance(const float *p, const float row[6], float range_m)
{
    const float xx = p[RHO_XX], xy = p[RHO_YX], yy = p[RHO_YY];
    const float s = row[RHO_X], c = row[RHO_Y]; /* unit vectors: across (s, c), along (c, -s) */
    const float across = xx * s * s + 2.0f * xy * s * c + yy * c * c;
    const float along = xx * c * c - 2.0f * xy * s * c + yy * s * s;
    const float both = (xx - yy) * s * c + xy * (c * c - s * s);

    return (across / range_m) * (along / range_m) + (both / range_m) * (both / range_m);
}

int rho_kalman_linearise_bearing(const struct rho_kalman *kalman, float x_m, float y_m,
                                 float bearing_rad, float sigma_rad,
                                 struct rho_kalman_bearing *seen)
{
    if (!rho_measurement_bearing_innovation(kalman->state, x_m, y_m, bearing_rad, seen->row,
                                            &seen->off_m, &seen->range_m)) {
        return 0;
    }
    const float sigma_m = sigma_rad * seen->range_m;
    seen->variance_m2 = sigma_m * sigma_m +
                        bearing_nonlinearity_variance(kalman->covariance, seen->row, seen->range_m);
    return 1;
}

enum rho_status rho_kalman_update_bearing(struct rho_kalman *kalman, float x_m, float y_m,
                                          float bearing_rad, float sigma_rad)
{
    struct rho_kalman_bearing seen;

    if (kalman == NULL) {
        return RHO_ERROR_NULL;
    }
    if (!rho_is_finite(bearing_rad) || !(sigma_rad > 0.0f)) {
        return RHO_ERROR_VALUE;
    }
    if (!rho_kalman_linearise_bearing(kalman, x_m, y_m, bearing_rad, sigma_rad, &seen)) {
        return RHO_OK;
    }
    return rho_kalman_update_row(kalman, seen.row, seen.off_m, seen.variance_m2, NULL);
}

int rho_kalman_has_estimate_on_axis(const struct rho_kalman *kalman, int axis)
{
    return kalman != NULL && axis >= 0 && axis < NUM_AXES &&
           kalman->covariance[DIAGONAL(axis)] > 0.0f;
}
