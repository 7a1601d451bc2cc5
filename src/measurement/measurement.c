/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/measurement.h"

#include <float.h>

#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"

/* Least range at which a line of sight is defined. */
#define RANGE_LEAST_M 1.0f
#define ROUNDING_ALLOWANCE (1.0f / 4194304.0f)

#define RANGE_MAX_M RHO_LIMIT_POSITION_M

/* ---- ranges of values ------------------------------------------------------------------------ */

static int is_valid_speed(float v_mps)
{
    return rho_is_within(v_mps, -RHO_LIMIT_SPEED_MPS, RHO_LIMIT_SPEED_MPS);
}

static int is_valid_sigma(float sigma)
{
    return rho_is_within(sigma, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_SIGMA_MAX);
}

static int is_valid_sigma_rad(float sigma_rad)
{
    return rho_is_within(sigma_rad, RHO_LIMIT_SIGMA_RAD_MIN, RHO_LIMIT_SIGMA_RAD_MAX);
}

static int is_valid_offset(int64_t offset_us)
{
    return offset_us <= RHO_LIMIT_OFFSET_US && offset_us >= -RHO_LIMIT_OFFSET_US;
}

static int is_valid_velocity(const struct rho_plot *plot, uint32_t measures)
{
    return is_valid_speed(plot->vx_mps) && is_valid_speed(plot->vy_mps) &&
           (!(measures & RHO_MEASURES_Z) || is_valid_speed(plot->vz_mps)) &&
           is_valid_sigma(plot->sigma_mps);
}

int rho_measurement_is_valid_plot(const struct rho_plot *plot, uint32_t measures)
{
    if (!is_valid_offset(plot->offset_us) || !rho_is_coordinate(plot->x_m) ||
        !rho_is_coordinate(plot->y_m) || !is_valid_sigma(plot->sigma_range_m) ||
        !is_valid_sigma(plot->sigma_cross_m)) {
        return 0;
    }
    if ((measures & RHO_MEASURES_Z) &&
        !(rho_is_coordinate(plot->z_m) && is_valid_sigma(plot->sigma_up_m))) {
        return 0;
    }
    if ((measures & RHO_MEASURES_RANGE_RATE) &&
        !(is_valid_speed(plot->range_rate_mps) && is_valid_sigma(plot->sigma_range_rate_mps))) {
        return 0;
    }
    return !(measures & RHO_MEASURES_VELOCITY) || is_valid_velocity(plot, measures);
}

/*
 * True for a span of range rates of 0 (not ambiguous), or one within its limits in a build with
 * RHO_AMBIGUOUS_RANGE_RATES.
 */
static int is_valid_range_rate_span(float span_mps)
{
    return rho_is_within(span_mps, 0.0f, 0.0f) ||
           (RHO_AMBIGUOUS_RANGE_RATES &&
            rho_is_within(span_mps, RHO_LIMIT_SPAN_MIN_MPS, RHO_LIMIT_SPAN_MAX_MPS));
}

int rho_measurement_has_valid_place_and_biases(const struct rho_sensor *sensor)
{
    return is_valid_range_rate_span(sensor->range_rate_span_mps) &&
           rho_is_coordinate(sensor->x_m) && rho_is_coordinate(sensor->y_m) &&
           rho_is_coordinate(sensor->z_m) &&
           rho_is_within(sensor->range_bias_m, -RHO_LIMIT_BIAS_M, RHO_LIMIT_BIAS_M) &&
           rho_is_within(sensor->azimuth_bias_rad, -RHO_LIMIT_BIAS_RAD, RHO_LIMIT_BIAS_RAD) &&
           rho_is_within(sensor->time_bias_s, -RHO_LIMIT_BIAS_S, RHO_LIMIT_BIAS_S);
}

int32_t rho_measurement_time_bias_us(const struct rho_sensor *sensor)
{
    float bias_us = sensor->time_bias_s * 1e6f; /* 32 bits hold RHO_LIMIT_BIAS_S in microseconds */
    return (int32_t)(bias_us + (bias_us < 0.0f ? -0.5f : 0.5f));
}

/* ---- polar plots ----------------------------------------------------------------------------- */

/* True where the measured fields of a polar plot are finite and within their limits. */
static int is_valid_polar_plot(const struct rho_polar_plot *polar, uint32_t measures)
{
    if (!(polar->range_m > 0.0f && polar->range_m <= RANGE_MAX_M) ||
        !rho_is_within(polar->azimuth_rad, -RHO_PI, RHO_PI) ||
        !is_valid_sigma(polar->sigma_range_m) || !is_valid_sigma_rad(polar->sigma_azimuth_rad)) {
        return 0;
    }
    if ((measures & RHO_MEASURES_Z) &&
        !(rho_is_within(polar->elevation_rad, -RHO_HALF_PI, RHO_HALF_PI) &&
          is_valid_sigma_rad(polar->sigma_elevation_rad))) {
        return 0;
    }
    return !(measures & RHO_MEASURES_RANGE_RATE) ||
           (is_valid_speed(polar->range_rate_mps) && is_valid_sigma(polar->sigma_range_rate_mps));
}

/* A polar plot from which the sensor's biases are subtracted, and the sensor's position. */
struct unbiased_polar {
    float range_m, azimuth_rad, elevation_rad;
    float variance_azimuth, variance_elevation; /* variances of the angles, rad^2 */
    int64_t offset_us;
    float x_m, y_m, z_m;
};

static struct unbiased_polar remove_biases(const struct rho_polar_plot *polar, uint32_t measures,
                                           const struct rho_sensor *sensor)
{
    struct unbiased_polar seen = {
        .range_m = polar->range_m,
        .azimuth_rad = polar->azimuth_rad,
        .variance_azimuth = polar->sigma_azimuth_rad * polar->sigma_azimuth_rad,
        .offset_us = polar->offset_us,
    };
    if (measures & RHO_MEASURES_Z) {
        seen.elevation_rad = polar->elevation_rad;
        seen.variance_elevation = polar->sigma_elevation_rad * polar->sigma_elevation_rad;
    }
    if (sensor) {
        seen.range_m -= sensor->range_bias_m;
        seen.azimuth_rad -= sensor->azimuth_bias_rad;
        seen.offset_us -= rho_measurement_time_bias_us(sensor);
        seen.x_m = sensor->x_m;
        seen.y_m = sensor->y_m;
        seen.z_m = sensor->z_m;
    }
    return seen;
}

static float root_sum_squares(float a, float b)
{
    return rho_sqrt(a * a + b * b);
}

/* Limits a sigma that was converted from an angle to metres: near the sensor it goes to 0. */
static float clamp_sigma_m(float sigma_m)
{
    if (!(sigma_m > RHO_LIMIT_SIGMA_MIN)) {
        return RHO_LIMIT_SIGMA_MIN;
    }
    return sigma_m < RHO_LIMIT_SIGMA_MAX ? sigma_m : RHO_LIMIT_SIGMA_MAX;
}

static void unbiased_polar_to_plot(const struct unbiased_polar *seen,
                                   const struct rho_polar_plot *polar, uint32_t measures,
                                   struct rho_plot *plot)
{
    int z = (measures & RHO_MEASURES_Z) != 0;
    float cos_elevation = rho_cos(seen->elevation_rad);
    /*
     * gains e^(sigma^2 / 2) against the bias of the conversion, to the second order: exact to
     * float32 for sigmas up to 0.1 rad, to 3e-4 at 0.5 rad
     */
    float half_azimuth = 0.5f * seen->variance_azimuth,
          half_elevation = 0.5f * seen->variance_elevation;
    float azimuth_gain = 1.0f + half_azimuth * (1.0f + 0.5f * half_azimuth);
    float elevation_gain = 1.0f + half_elevation * (1.0f + 0.5f * half_elevation);
    float level_m = seen->range_m * elevation_gain * cos_elevation;
    float ground_m = level_m * azimuth_gain;
    float spread_m = 0.70710678f * root_sum_squares(level_m * seen->variance_azimuth,
                                                    seen->range_m * seen->variance_elevation);

    *plot = (struct rho_plot){
        .offset_us = (int32_t)seen->offset_us,
        .x_m = seen->x_m + ground_m * rho_cos(seen->azimuth_rad),
        .y_m = seen->y_m + ground_m * rho_sin(seen->azimuth_rad),
        .range_rate_mps = (measures & RHO_MEASURES_RANGE_RATE) ? polar->range_rate_mps : 0.0f,
        .sigma_range_m = clamp_sigma_m(root_sum_squares(polar->sigma_range_m, spread_m)),
        .sigma_cross_m = clamp_sigma_m(level_m * polar->sigma_azimuth_rad),
        .sigma_range_rate_mps =
            (measures & RHO_MEASURES_RANGE_RATE) ? polar->sigma_range_rate_mps : 0.0f,
        .snr_db = polar->snr_db,
    };
    if (z) {
        plot->z_m = seen->z_m + seen->range_m * elevation_gain * rho_sin(seen->elevation_rad);
        plot->sigma_up_m = clamp_sigma_m(seen->range_m * polar->sigma_elevation_rad);
    }
}

enum rho_status rho_measurement_from_polar(const struct rho_polar_plot *polar, uint32_t measures,
                                           const struct rho_sensor *sensor, struct rho_plot *plot)
{
    struct rho_plot converted;
    if (!polar || !plot) {
        return RHO_ERROR_NULL;
    }
    if (!is_valid_polar_plot(polar, measures) ||
        (sensor && !rho_measurement_has_valid_place_and_biases(sensor))) {
        return RHO_ERROR_VALUE;
    }
    struct unbiased_polar seen = remove_biases(polar, measures, sensor);
    if (!(seen.range_m > 0.0f && seen.range_m <= RANGE_MAX_M) || !is_valid_offset(seen.offset_us)) {
        return RHO_ERROR_VALUE;
    }
    unbiased_polar_to_plot(&seen, polar, measures, &converted);
    if (!rho_measurement_is_valid_plot(&converted, measures & ~RHO_MEASURES_VELOCITY)) {
        return RHO_ERROR_VALUE;
    }
    *plot = converted;
    return RHO_OK;
}

/* ---- the frame of the noise ------------------------------------------------------------------ */

/*
 * Fills a measurement of a plot at the sensor's position, which has no line of sight: the largest
 * variance on all axes.
 */
static void fill_isotropic_noise(const struct rho_plot *plot,
                                 const struct rho_sigma_factors *factors,
                                 struct rho_measurement *out)
{
    float sigma_m = rho_plot_sigma_m(plot);
    if (out->has_z) {
        sigma_m = rho_larger(sigma_m, plot->sigma_up_m);
    }
    sigma_m *= factors->range > factors->cross ? factors->range : factors->cross;
    out->cos_azimuth = out->cos_elevation = 1.0f;
    out->sin_azimuth = out->sin_elevation = 0.0f;
    out->variance_m2[0] = out->variance_m2[1] = out->variance_m2[2] = sigma_m * sigma_m;
    out->is_isotropic = 1;
}

static void fill_elevation(float ground_m, float dz_m, struct rho_measurement *out)
{
    float range_m = out->has_z ? root_sum_squares(ground_m, dz_m) : ground_m;
    out->cos_elevation = out->has_z ? ground_m / range_m : 1.0f;
    out->sin_elevation = out->has_z ? dz_m / range_m : 0.0f;
}

static int are_equal(float a, float b)
{
    return a <= b && a >= b;
}

/* Variance of a sigma that is multiplied by its sensor's factor. */
static float scaled_variance(float sigma_m, float factor)
{
    return sigma_m * sigma_m * (factor * factor);
}

/*
 * Sigma factor of heights, for which none is learned: the factor of range or azimuth that is nearer
 * to 1 where both are on one side of 1, else 1.
 */
static float height_sigma_factor(const struct rho_sigma_factors *factors)
{
    const float least = factors->range < factors->cross ? factors->range : factors->cross;
    const float most = rho_larger(factors->range, factors->cross);
    return least > 1.0f ? least : most < 1.0f ? most : 1.0f;
}

struct rho_sigma_factors rho_measurement_sigma_factors(const struct rho_sensor *sensor)
{
    struct rho_sigma_factors factors = {1.0f, 1.0f};
    if (RHO_SIGMAS_VARY && sensor && sensor->sigma_range_percent > 0) {
        factors.range = 0.01f * (float)sensor->sigma_range_percent;
    }
    if (RHO_SIGMAS_VARY && sensor && sensor->sigma_cross_percent > 0) {
        factors.cross = 0.01f * (float)sensor->sigma_cross_percent;
    }
    return factors;
}

float rho_measurement_sigma_factor_at_least_one(const struct rho_sensor *sensor)
{
    const struct rho_sigma_factors factors = rho_measurement_sigma_factors(sensor);
    return rho_larger(rho_larger(factors.range, factors.cross), 1.0f);
}

int rho_measurement_is_valid_bearing(const struct rho_bearing *bearing)
{
    return rho_is_within(bearing->bearing_rad, -RHO_PI, RHO_PI) &&
           rho_is_within(bearing->sigma_rad, RHO_LIMIT_SIGMA_RAD_MIN, RHO_LIMIT_SIGMA_RAD_MAX);
}

void rho_measurement_from_plot(const struct rho_plot *plot, uint32_t measures,
                               const struct rho_sensor *sensor, struct rho_measurement *out)
{
    float dx_m = plot->x_m - (sensor ? sensor->x_m : 0.0f);
    float dy_m = plot->y_m - (sensor ? sensor->y_m : 0.0f);
    float dz_m = plot->z_m - (sensor ? sensor->z_m : 0.0f);
    float ground_m = root_sum_squares(dx_m, dy_m);
    const struct rho_sigma_factors factors = rho_measurement_sigma_factors(sensor);
    out->has_z = (measures & RHO_MEASURES_Z) != 0;
    out->place_m[0] = plot->x_m;
    out->place_m[1] = plot->y_m;
    out->place_m[2] = out->has_z ? plot->z_m : 0.0f;
    if (!(ground_m >= RANGE_LEAST_M)) {
        if (!out->has_z || !(root_sum_squares(ground_m, dz_m) >= RANGE_LEAST_M)) {
            fill_isotropic_noise(plot, &factors, out);
            return;
        }
        ground_m = dx_m = RHO_LIMIT_SIGMA_MIN; /* plot overhead: any azimuth will do */
        dy_m = 0.0f;
    }
    out->cos_azimuth = dx_m / ground_m;
    out->sin_azimuth = dy_m / ground_m;
    fill_elevation(ground_m, dz_m, out);
    out->variance_m2[0] = scaled_variance(plot->sigma_range_m, factors.range);
    out->variance_m2[1] = scaled_variance(plot->sigma_cross_m, factors.cross);
    out->variance_m2[2] =
        out->has_z ? scaled_variance(plot->sigma_up_m, height_sigma_factor(&factors)) : 0.0f;
    out->is_isotropic = are_equal(out->variance_m2[0], out->variance_m2[1]) &&
                        (!out->has_z || are_equal(out->variance_m2[0], out->variance_m2[2]));
}

void rho_measurement_covariance(const struct rho_measurement *measurement, float covariance[6])
{
    float ca = measurement->cos_azimuth, sa = measurement->sin_azimuth;
    float ce = measurement->cos_elevation, se = measurement->sin_elevation;
    const float *variance = measurement->variance_m2;
    if (measurement->is_isotropic) {
        covariance[0] = covariance[2] = variance[1];
        covariance[5] = variance[2];
        covariance[1] = covariance[3] = covariance[4] = 0.0f;
        return;
    }
    /*
     * level: variance of the range along the ground; slant: covariance of that range and the height
     */
    float level = ce * ce * variance[0] + se * se * variance[2];
    float slant = ce * se * (variance[0] - variance[2]);
    /* allowance for rounding: very thin ellipses would not be positive definite */
    float allowance = rho_larger(level, variance[1]) * ROUNDING_ALLOWANCE;
    covariance[0] = ca * ca * level + sa * sa * variance[1] + allowance;
    covariance[1] = ca * sa * (level - variance[1]);
    covariance[2] = sa * sa * level + ca * ca * variance[1] + allowance;
    covariance[3] = ca * slant;
    covariance[4] = sa * slant;
    covariance[5] = se * se * variance[0] + ce * ce * variance[2];
}

/* ---- range rate ------------------------------------------------------------------------------ */

int rho_measurement_predict_range_rate(const float state[6], const struct rho_sensor *sensor,
                                       int use_z, float row[6], float *rate_mps)
{
    float along[3] = {state[0] - (sensor ? sensor->x_m : 0.0f),
                      state[1] - (sensor ? sensor->y_m : 0.0f),
                      use_z ? state[2] - (sensor ? sensor->z_m : 0.0f) : 0.0f};
    const float velocity[3] = {state[3], state[4], use_z ? state[5] : 0.0f};
    float range_m = rho_sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
    if (!(range_m >= RANGE_LEAST_M)) {
        return 0;
    }
    float rate = 0.0f, per_m = 1.0f / range_m;
    for (int i = 0; i < 3; i++) {
        along[i] *= per_m;
        rate += along[i] * velocity[i];
    }
    for (int i = 0; i < 3; i++) {
        row[i] = (velocity[i] - rate * along[i]) * per_m;
        row[i + 3] = along[i];
    }
    *rate_mps = rate;
    return 1;
}

/* ---- ambiguous range rates ------------------------------------------------------------------- */

/* largest innovation: three of place, three of velocity, one range rate */
#define INNOVATIONS_MAX (3 + 3 + 1)
/* multiples of the span beyond which a difference is not unfolded */
#define TURNS_MAX 1.0e6f

/* Standard deviations of the expected range rate that half the span must hold. */
#define CLEAR_SIGMAS 3.0f

float rho_measurement_range_rate_innovation_mps(const struct rho_sensor *sensor, float measured_mps,
                                                float expected_mps)
{
    float error_mps = measured_mps - expected_mps;
    if (!rho_measurement_has_ambiguous_range_rates(sensor)) {
        return error_mps;
    }
    float turns = error_mps / sensor->range_rate_span_mps;
    if (!rho_is_within(turns, -TURNS_MAX, TURNS_MAX)) {
        return error_mps;
    }
    int32_t whole = (int32_t)(turns + (turns < 0.0f ? -0.5f : 0.5f));
    return error_mps - (float)whole * sensor->range_rate_span_mps;
}

int rho_measurement_can_unfold_range_rate(const struct rho_sensor *sensor, float variance)
{
    if (!rho_measurement_has_ambiguous_range_rates(sensor)) {
        return 1;
    }
    float half_mps = 0.5f * sensor->range_rate_span_mps;
    return CLEAR_SIGMAS * CLEAR_SIGMAS * variance <= half_mps * half_mps;
}

/*
 * Cholesky factor of a packed lower triangle, in place, with less stack than rho_linalg_cholesky.
 * Returns 0 where the matrix is not positive definite.
 */
static int cholesky_in_place(int num, float *a)
{
    for (int i = 0; i < num; i++) {
        for (int j = 0; j <= i; j++) {
            float rest = a[RHO_AT(i, j)];
            for (int k = 0; k < j; k++) {
                rest -= a[RHO_AT(i, k)] * a[RHO_AT(j, k)];
            }
            if (i == j && !(rest > 0.0f)) {
                return 0;
            }
            a[RHO_AT(i, j)] = i == j ? rho_sqrt(rest) : rest / a[RHO_AT(j, j)];
        }
    }
    return 1;
}

int rho_measurement_unfold_range_rate(const struct rho_sensor *sensor, int num,
                                      const float *covariance, float *innovation)
{
    float factor[RHO_TRIANGLE(INNOVATIONS_MAX)] = {0.0f}, whitened[INNOVATIONS_MAX] = {0.0f};
    float expected_mps = 0.0f;
    const int last = num - 1;
    if (!rho_measurement_has_ambiguous_range_rates(sensor)) {
        return 1;
    }
    for (int k = 0; k < RHO_TRIANGLE(num); k++) {
        factor[k] = covariance[k];
    }
    if (!cholesky_in_place(num, factor)) {
        return 0;
    }
    for (int i = 0; i < last; i++) {
        whitened[i] = innovation[i];
    }
    rho_linalg_forward(last, factor, whitened);
    for (int i = 0; i < last; i++) {
        expected_mps += factor[RHO_AT(last, i)] * whitened[i];
    }
    const float sd_mps = factor[RHO_AT(last, last)];
    if (!rho_measurement_can_unfold_range_rate(sensor, sd_mps * sd_mps)) {
        return 0;
    }
    innovation[last] = expected_mps + rho_measurement_range_rate_innovation_mps(
                                          sensor, innovation[last], expected_mps);
    return 1;
}

float rho_measurement_log_num_aliases(const struct rho_sensor *sensor, float v_max_mps)
{
    if (!rho_measurement_has_ambiguous_range_rates(sensor) ||
        !(sensor->range_rate_span_mps < 2.0f * v_max_mps)) {
        return 0.0f;
    }
    return rho_log(2.0f * v_max_mps / sensor->range_rate_span_mps);
}

/* ---- bearings and coverage ------------------------------------------------------------------- */

int rho_measurement_bearing_innovation(const float state[6], float x_m, float y_m,
                                       float bearing_rad, float row[6], float *off_m,
                                       float *range_m)
{
    float dx_m = state[0] - x_m, dy_m = state[1] - y_m;
    float range2_m2 = dx_m * dx_m + dy_m * dy_m;
    if (!(range2_m2 >= RANGE_LEAST_M * RANGE_LEAST_M) || !(range2_m2 <= FLT_MAX)) {
        return 0;
    }
    *range_m = rho_sqrt(range2_m2);
    *off_m = *range_m * rho_angle_difference(bearing_rad, rho_atan2(dy_m, dx_m));
    for (int i = 2; i < 6; i++) {
        row[i] = 0.0f;
    }
    row[0] = -dy_m / *range_m;
    row[1] = dx_m / *range_m;
    return 1;
}

int rho_measurement_covers(const struct rho_sensor *sensor, float sector_from_rad,
                           float sector_to_rad, float x_m, float y_m)
{
    float dx_m = x_m - (sensor ? sensor->x_m : 0.0f);
    float dy_m = y_m - (sensor ? sensor->y_m : 0.0f);
    float range2_m2 = dx_m * dx_m + dy_m * dy_m;
    if (sensor && !(range2_m2 >= sensor->range_min_m * sensor->range_min_m &&
                    range2_m2 <= sensor->range_max_m * sensor->range_max_m)) {
        return 0;
    }
    if (rho_angle_is_circle(sector_from_rad, sector_to_rad) &&
        (!sensor || rho_angle_is_circle(sensor->sector_from_rad, sensor->sector_to_rad))) {
        return range2_m2 <= FLT_MAX; /* most radars look all round: no arctangent is needed */
    }
    float azimuth_rad = rho_atan2(dy_m, dx_m);
    return rho_angle_in_sector(azimuth_rad, sector_from_rad, sector_to_rad) &&
           (!sensor ||
            rho_angle_in_sector(azimuth_rad, sensor->sector_from_rad, sensor->sector_to_rad));
}
