/* SPDX-License-Identifier: MIT */
/*
 * measurement: plots as places with a covariance, and as rows for scalar Kalman updates.
 *
 * A radar measures range and angles, so its noise is an ellipsoid with the axes of the line of
 * sight: along it, across it in the horizontal plane, and upwards at right angles to both.
 *
 *        up                      along  = (cos e cos a,  cos e sin a, sin e)
 *         |  / along, range      cross  = (-sin a,       cos a,       0)
 *         | /                    up     = (-sin e cos a, -sin e sin a, cos e)
 *     ----o---- cross            a azimuth, e elevation of the plot as the sensor sees it
 *
 * In the frame of the line of sight a plot is two or three scalars of independent noise: no matrix
 * is inverted. Plots of a scan without heights lie in the horizontal plane: elevation 0, two axes.
 *
 * Constant cost where none is said. Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_MEASUREMENT_H
#define RHOTRACK_MEASUREMENT_H

#include <stdint.h>

#include "rhotrack/types.h"

RHO_BEGIN_C

/* Limits of gates: 99.9 % quantiles of chi-square in 1 to 4 dimensions. */
#define RHO_GATE_CHI2_1D 10.8276f
#define RHO_GATE_CHI2_2D 13.8155f
#define RHO_GATE_CHI2_3D 16.2662f
#define RHO_GATE_CHI2_4D 18.4668f

/* Least range at which a line of sight is defined. */
#define RHO_RANGE_LEAST_M 1.0f

/* Heights over which clutter and new targets are assumed to be spread, where measured. */
#define RHO_CLUTTER_HEIGHT_M 20000.0f

/* A plot as its place, the frame of its noise, and the variances in that frame. */
struct rho_measurement {
    float place_m[3]; /* position x, y, z; z is 0 where not measured */
    float cos_azimuth, sin_azimuth;
    float cos_elevation, sin_elevation; /* elevation 0 where z is not measured */
    /* noise variances along the line of sight, across it, and upwards */
    float variance_m2[3];
    int has_z;
    int is_isotropic; /* 1: variances are equal on all axes, and the frame does not matter */
};

/* Time bias of a sensor in whole microseconds. Constant cost. */
int32_t rho_measurement_time_bias_us(const struct rho_sensor *sensor);

/* True where all measured fields of a plot are finite and within the limits of types.h. */
int rho_measurement_is_valid_plot(const struct rho_plot *plot, uint32_t measures);

/*
 * True where a bearing is within +-pi, an elevation that it has within +-pi/2, and their sigmas
 * within the limits of types.h. Constant cost.
 */
int rho_bearing_is_valid(const struct rho_bearing *bearing);

/*
 * Slope of a line of sight from a place: height over ground range. It is linear in both, and the
 * ground range is what bearings tell.
 */
struct rho_slope {
    float x_m, y_m, z_m; /* the place that it is seen from */
    float value, sigma;  /* tangent of the elevation; sigma 0: not measured */
};

/*
 * The slope of a valid bearing of a scan; not measured without an elevation, and nearer to the
 * vertical than RHO_ELEVATION_MAX_RAD leaves. Cost: a sine, a cosine, two divisions. Stack: 80
 * bytes.
 */
#define RHO_ELEVATION_MAX_RAD 1.4f
struct rho_slope rho_measurement_slope(const struct rho_bearing_scan *scan,
                                       const struct rho_bearing *bearing);

/* Factors of the sigmas of a sensor's plots, along the line of sight and across it. */
struct rho_sigma_factors {
    float range, cross;
};

/* Factors of a sensor's sigmas from its percentages; 1 for a percentage of 0, and for NULL. */
struct rho_sigma_factors rho_measurement_sigma_factors(const struct rho_sensor *sensor);

/* The larger one of a sensor's two sigma factors, at least 1. Constant cost. */
float rho_measurement_factor_max(const struct rho_sensor *sensor);

/*
 * Fills *out from a valid plot of a scan that measures `measures`, seen from `sensor` (NULL: from
 * the origin). A plot at the sensor's position has no line of sight: its noise is taken as
 * isotropic, with the largest of its sigmas. The sensor's factors scale the sigmas; heights take
 * the factor nearer to 1 where both lie on one side of 1. Cost: two square roots, two divisions.
 * Stack: 88 bytes.
 */
void rho_measurement_from_plot(const struct rho_plot *plot, uint32_t measures,
                               const struct rho_sensor *sensor, struct rho_measurement *out);

/* True where a sensor's place, biases and span are finite and within the limits of types.h. */
int rho_measurement_is_valid_site(const struct rho_sensor *sensor);

/* Covariance of a plot's noise in x, y, z, a lower triangle: xx, yx, yy, zx, zy, zz. */
void rho_measurement_covariance(const struct rho_measurement *measurement, float covariance[6]);

/* Noise variance of the range along the ground. Constant cost. No stack. */
static inline float rho_measurement_ground_m2(const struct rho_measurement *measurement)
{
    const float ce = measurement->cos_elevation, se = measurement->sin_elevation;
    return measurement->has_z
               ? ce * ce * measurement->variance_m2[0] + se * se * measurement->variance_m2[2]
               : measurement->variance_m2[0];
}

/*
 * The range rate that a sensor (NULL: at the origin) would see of a state [x y z vx vy vz], and its
 * derivative by the state: u = (p - s) / |p - s|, rate = u . v, d rate / d v = u, d rate / d p = (v
 * - rate u) / |p - s|. use_z 0: heights are not known; the sensor and the state count as level.
 * Returns 0, and fills nothing, where the state is nearer than a metre to the sensor. Cost: a
 * square root and two divisions. Stack: 56 bytes.
 */
int rho_measurement_predict_rate(const float state[6], const struct rho_sensor *sensor, int use_z,
                                 float row[6], float *rate_mps);

/*
 * Ambiguous range rates: a radar of pulse repetition frequency f and wavelength w measures range
 * rates modulo f w / 2, the sensor's range_rate_span_mps. The multiple that brings the measured
 * range rate nearest to the expected one is added, if three standard deviations of their difference
 * are within half the span. Otherwise the range rate counts as not measured. Range rates of a
 * sensor without a span, or of NULL, are taken as they are.
 */
/* Measured minus expected range rate, brought within +-span/2 if ambiguous. Cost: a division. */
float rho_measurement_innovation_mps(const struct rho_sensor *sensor, float measured_mps,
                                     float expected_mps);

/* True where an innovation's variance, (m/s)^2, is small enough to determine the multiple. */
int rho_measurement_can_unfold(const struct rho_sensor *sensor, float variance);

/*
 * Unfolds an ambiguous range rate, the last one of num (2 .. 7) correlated innovations: the
 * multiple of the span is chosen nearest to the expectation given the other innovations.
 * covariance: of the innovations, a packed triangle. Returns 0, and changes nothing, where the
 * multiple is not determined, or the covariance is not positive definite. Cost: a Cholesky factor
 * of num x num. Stack: 280 bytes.
 */
int rho_measurement_unfold_rate(const struct rho_sensor *sensor, int num, const float *covariance,
                                float *innovation);

/*
 * ln of the number of range rates within -v_max .. v_max that an ambiguous one can stand for; 0 for
 * a sensor whose range rates are not ambiguous. Cost: a logarithm.
 */
float rho_measurement_log_aliases(const struct rho_sensor *sensor, float v_max_mps);

/* True where a sensor's range rates are ambiguous. */
static inline int rho_measurement_is_ambiguous(const struct rho_sensor *sensor)
{
    return RHO_AMBIGUOUS_RANGE_RATES && sensor && sensor->range_rate_span_mps > 0.0f;
}

/*
 * True where a scan covers a place: it is within the scan's sector, and the sensor's sector and
 * range limits. A sensor of NULL is at the origin and covers the scan's sector. Cost: an
 * arctangent.
 */
int rho_measurement_covers(const struct rho_sensor *sensor, float sector_from_rad,
                           float sector_to_rad, float x_m, float y_m);

RHO_END_C

#endif
