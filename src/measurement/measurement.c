/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/measurement.h"

#include <float.h>

#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"

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
    return !(measures & RHO_MEASURES_VELOCITY) ||
           (is_valid_speed(plot->vx_mps) && is_valid_speed(plot->vy_mps) &&
            (!(measures & RHO_MEASURES_Z) || is_valid_speed(plot->vz_mps)) &&
            is_valid_sigma(plot->sigma_mps));
}

int rho_measurement_is_valid_site(const struct rho_sensor *sensor)
{
    const float span_mps = sensor->range_rate_span_mps; /* 0: range rates are not ambiguous */
    return (rho_is_within(span_mps, 0.0f, 0.0f) ||
            (RHO_AMBIGUOUS_RANGE_RATES &&
             rho_is_within(span_mps, RHO_LIMIT_SPAN_MIN_MPS, RHO_LIMIT_SPAN_MAX_MPS))) &&
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

static float root_sum_squares(float a, float b)
{
    return rho_sqrt(a * a + b * b);
}

/* Limits a sigma that was converted from an angle to metres: near the sensor it goes to 0. */
static float clamp_sigma_m(float sigma_m)
{
    return rho_smaller(rho_larger(sigma_m, RHO_LIMIT_SIGMA_MIN), RHO_LIMIT_SIGMA_MAX);
}

enum rho_status rho_measurement_from_polar(const struct rho_polar_plot *polar, uint32_t measures,
                                           const struct rho_sensor *sensor, struct rho_plot *plot)
{
    const int has_z = (measures & RHO_MEASURES_Z) != 0;
    const int has_rate = (measures & RHO_MEASURES_RANGE_RATE) != 0;
    if (!polar || !plot) {
        return RHO_ERROR_NULL;
    }
    if (!(polar->range_m > 0.0f && polar->range_m <= RHO_LIMIT_POSITION_M) ||
        !rho_is_within(polar->azimuth_rad, -RHO_PI, RHO_PI) ||
        !is_valid_sigma(polar->sigma_range_m) || !is_valid_sigma_rad(polar->sigma_azimuth_rad) ||
        (has_z && !(rho_is_within(polar->elevation_rad, -RHO_HALF_PI, RHO_HALF_PI) &&
                    is_valid_sigma_rad(polar->sigma_elevation_rad))) ||
        (sensor && !rho_measurement_is_valid_site(sensor))) {
        return RHO_ERROR_VALUE;
    }
    const float range_m = polar->range_m - (sensor ? sensor->range_bias_m : 0.0f);
    const float azimuth_rad = polar->azimuth_rad - (sensor ? sensor->azimuth_bias_rad : 0.0f);
    const float elevation_rad = has_z ? polar->elevation_rad : 0.0f;
    const float sigma_elevation_rad = has_z ? polar->sigma_elevation_rad : 0.0f;
    const int64_t offset_us =
        (int64_t)polar->offset_us - (sensor ? rho_measurement_time_bias_us(sensor) : 0);
    if (!(range_m > 0.0f && range_m <= RHO_LIMIT_POSITION_M) || !is_valid_offset(offset_us)) {
        return RHO_ERROR_VALUE;
    }
    /* e^(sigma^2 / 2) against the conversion's bias: exact up to 0.1 rad, to 3e-4 at 0.5 rad */
    const float variance_azimuth = polar->sigma_azimuth_rad * polar->sigma_azimuth_rad;
    const float variance_elevation = sigma_elevation_rad * sigma_elevation_rad;
    const float half_azimuth = 0.5f * variance_azimuth, half_elevation = 0.5f * variance_elevation;
    const float azimuth_gain = 1.0f + half_azimuth * (1.0f + 0.5f * half_azimuth);
    const float elevation_gain = 1.0f + half_elevation * (1.0f + 0.5f * half_elevation);
    const float level_m = range_m * elevation_gain * (has_z ? rho_cos(elevation_rad) : 1.0f);
    const float ground_m = level_m * azimuth_gain;
    const float spread_m =
        0.70710678f * root_sum_squares(level_m * variance_azimuth, range_m * variance_elevation);
    struct rho_plot converted = {
        .offset_us = (int32_t)offset_us,
        .x_m = (sensor ? sensor->x_m : 0.0f) + ground_m * rho_cos(azimuth_rad),
        .y_m = (sensor ? sensor->y_m : 0.0f) + ground_m * rho_sin(azimuth_rad),
        .range_rate_mps = has_rate ? polar->range_rate_mps : 0.0f,
        .sigma_range_m = clamp_sigma_m(root_sum_squares(polar->sigma_range_m, spread_m)),
        .sigma_cross_m = clamp_sigma_m(level_m * polar->sigma_azimuth_rad),
        .sigma_range_rate_mps = has_rate ? polar->sigma_range_rate_mps : 0.0f,
        .snr_db = polar->snr_db,
    };
    if (has_z) {
        converted.z_m =
            (sensor ? sensor->z_m : 0.0f) + range_m * elevation_gain * rho_sin(elevation_rad);
        converted.sigma_up_m = clamp_sigma_m(range_m * polar->sigma_elevation_rad);
    }
    if (!rho_measurement_is_valid_plot(&converted, measures & ~RHO_MEASURES_VELOCITY)) {
        return RHO_ERROR_VALUE;
    }
    *plot = converted;
    return RHO_OK;
}

/* Variance of a sigma that is multiplied by its sensor's factor. */
static float scaled_variance(float sigma_m, float factor)
{
    return sigma_m * sigma_m * (factor * factor);
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

float rho_measurement_factor_max(const struct rho_sensor *sensor)
{
    const struct rho_sigma_factors factors = rho_measurement_sigma_factors(sensor);
    return rho_larger(rho_larger(factors.range, factors.cross), 1.0f);
}

int rho_bearing_is_valid(const struct rho_bearing *bearing)
{
    const int has_elevation =
        bearing->sigma_elevation_rad < 0.0f || bearing->sigma_elevation_rad > 0.0f;
    return rho_is_within(bearing->bearing_rad, -RHO_PI, RHO_PI) &&
           is_valid_sigma_rad(bearing->sigma_rad) && rho_is_finite(bearing->sigma_elevation_rad) &&
           (!has_elevation || (is_valid_sigma_rad(bearing->sigma_elevation_rad) &&
                               rho_is_within(bearing->elevation_rad, -RHO_HALF_PI, RHO_HALF_PI)));
}

struct rho_slope rho_measurement_slope(const struct rho_bearing_scan *scan,
                                       const struct rho_bearing *bearing)
{
    struct rho_slope slope = {.x_m = scan->x_m, .y_m = scan->y_m, .z_m = scan->z_m};
    if (bearing->sigma_elevation_rad > 0.0f &&
        rho_magnitude(bearing->elevation_rad) <= RHO_ELEVATION_MAX_RAD) {
        const float cosine = rho_cos(bearing->elevation_rad);
        slope.value = rho_sin(bearing->elevation_rad) / cosine;
        slope.sigma = bearing->sigma_elevation_rad / (cosine * cosine);
    }
    return slope;
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
    if (!(ground_m >= RHO_RANGE_LEAST_M)) {
        if (!out->has_z || !(root_sum_squares(ground_m, dz_m) >= RHO_RANGE_LEAST_M)) {
            float sigma_m = rho_plot_sigma_m(plot);
            if (out->has_z) {
                sigma_m = rho_larger(sigma_m, plot->sigma_up_m);
            }
            sigma_m *= rho_larger(factors.range, factors.cross);
            out->cos_azimuth = out->cos_elevation = 1.0f;
            out->sin_azimuth = out->sin_elevation = 0.0f;
            out->variance_m2[0] = out->variance_m2[1] = out->variance_m2[2] = sigma_m * sigma_m;
            out->is_isotropic = 1;
            return;
        }
        ground_m = dx_m = RHO_LIMIT_SIGMA_MIN; /* plot overhead: any azimuth will do */
        dy_m = 0.0f;
    }
    out->cos_azimuth = dx_m / ground_m;
    out->sin_azimuth = dy_m / ground_m;
    const float range_m = out->has_z ? root_sum_squares(ground_m, dz_m) : ground_m;
    out->cos_elevation = out->has_z ? ground_m / range_m : 1.0f;
    out->sin_elevation = out->has_z ? dz_m / range_m : 0.0f;
    out->variance_m2[0] = scaled_variance(plot->sigma_range_m, factors.range);
    out->variance_m2[1] = scaled_variance(plot->sigma_cross_m, factors.cross);
    out->variance_m2[2] = 0.0f;
    if (out->has_z) {
        /* no factor of heights is learned: the one nearer to 1 where both are on one side of it */
        const float least = rho_smaller(factors.range, factors.cross);
        const float most = rho_larger(factors.range, factors.cross);
        out->variance_m2[2] = scaled_variance(plot->sigma_up_m, least > 1.0f  ? least
                                                                : most < 1.0f ? most
                                                                              : 1.0f);
    }
    out->is_isotropic = rho_is_equal(out->variance_m2[0], out->variance_m2[1]) &&
                        (!out->has_z || rho_is_equal(out->variance_m2[0], out->variance_m2[2]));
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
    /* level: variance of the ground range; slant: covariance of that range and the height */
    float level = ce * ce * variance[0] + se * se * variance[2];
    float slant = ce * se * (variance[0] - variance[2]);
    /* allowance for rounding: very thin ellipses would not be positive definite */
    float allowance = rho_larger(level, variance[1]) * RHO_ROUNDING_UNITS(4);
    covariance[0] = ca * ca * level + sa * sa * variance[1] + allowance;
    covariance[1] = ca * sa * (level - variance[1]);
    covariance[2] = sa * sa * level + ca * ca * variance[1] + allowance;
    covariance[3] = ca * slant;
    covariance[4] = sa * slant;
    covariance[5] = se * se * variance[0] + ce * ce * variance[2];
}

int rho_measurement_predict_rate(const float state[6], const struct rho_sensor *sensor, int use_z,
                                 float row[6], float *rate_mps)
{
    float along[3] = {state[0] - (sensor ? sensor->x_m : 0.0f),
                      state[1] - (sensor ? sensor->y_m : 0.0f),
                      use_z ? state[2] - (sensor ? sensor->z_m : 0.0f) : 0.0f};
    const float velocity[3] = {state[3], state[4], use_z ? state[5] : 0.0f};
    float range_m = rho_sqrt(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
    if (!(range_m >= RHO_RANGE_LEAST_M)) {
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

float rho_measurement_innovation_mps(const struct rho_sensor *sensor, float measured_mps,
                                     float expected_mps)
{
    float error_mps = measured_mps - expected_mps;
    if (!rho_measurement_is_ambiguous(sensor)) {
        return error_mps;
    }
    float turns = error_mps / sensor->range_rate_span_mps;
    if (!rho_is_within(turns, -1.0e6f, 1.0e6f)) {
        return error_mps;
    }
    int32_t whole = (int32_t)(turns + (turns < 0.0f ? -0.5f : 0.5f));
    return error_mps - (float)whole * sensor->range_rate_span_mps;
}

int rho_measurement_can_unfold(const struct rho_sensor *sensor, float variance)
{
    if (!rho_measurement_is_ambiguous(sensor)) {
        return 1;
    }
    float half_mps = 0.5f * sensor->range_rate_span_mps;
    return CLEAR_SIGMAS * CLEAR_SIGMAS * variance <= half_mps * half_mps;
}

/* In place, with less stack than rho_linalg_cholesky. Returns 0 where not positive definite. */
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

int rho_measurement_unfold_rate(const struct rho_sensor *sensor, int num, const float *covariance,
                                float *innovation)
{
    enum { INNOVATIONS_MAX = 3 + 3 + 1 }; /* three of place, three of velocity, one range rate */
    float factor[RHO_TRIANGLE(INNOVATIONS_MAX)] = {0.0f}, whitened[INNOVATIONS_MAX] = {0.0f};
    float expected_mps = 0.0f;
    const int last = num - 1;
    if (!rho_measurement_is_ambiguous(sensor)) {
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
    if (!rho_measurement_can_unfold(sensor, sd_mps * sd_mps)) {
        return 0;
    }
    innovation[last] =
        expected_mps + rho_measurement_innovation_mps(sensor, innovation[last], expected_mps);
    return 1;
}

float rho_measurement_log_aliases(const struct rho_sensor *sensor, float v_max_mps)
{
    if (!rho_measurement_is_ambiguous(sensor) ||
        !(sensor->range_rate_span_mps < 2.0f * v_max_mps)) {
        return 0.0f;
    }
    return rho_log(2.0f * v_max_mps / sensor->range_rate_span_mps);
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
