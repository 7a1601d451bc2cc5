/* SPDX-License-Identifier: MIT */
/*
 * measurement: what a sensor measured, as places with a covariance, and as rows for scalar updates.
 *
 * A radar measures range and angles, so its noise is an ellipsoid with the axes of the line of sight: along it, across
 * it in the horizontal plane, and upwards at right angles to both.
 *
 *        up                      along  = (cos e cos a,  cos e sin a, sin e)
 *         |  / along, range      cross  = (-sin a,       cos a,       0)
 *         | /                    up     = (-sin e cos a, -sin e sin a, cos e)
 *     ----o---- cross            a azimuth, e elevation of the plot as the sensor sees it
 *
 * Turned into that frame a plot is two or three scalars of independent noise: no matrix has to be inverted.
 * Plots of a scan without heights lie in the horizontal plane: elevation 0, two axes.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_MEASUREMENT_H
#define RHOTRACK_MEASUREMENT_H

#include <stdint.h>

#include "rhotrack/status.h"
#include "rhotrack/types.h"

/* 99.9 % of the squared Mahalanobis distances of normal errors in so many dimensions. */
#define RHO_GATE_CHI2_1D 10.8276f
#define RHO_GATE_CHI2_2D 13.8155f
#define RHO_GATE_CHI2_3D 16.2662f
#define RHO_GATE_CHI2_4D 18.4668f

/* Where heights count, clutter and births are taken to spread over so many metres of them. */
#define RHO_CLUTTER_HEIGHT_M 20000.0f

/* A plot opened up: its place, the frame of its noise, and the noise's variances. */
struct rho_measurement {
    float place_m[3]; /* x, y, z; z 0 where not measured */
    float cos_azimuth, sin_azimuth;
    float cos_elevation, sin_elevation; /* 1 and 0 where z is not measured */
    float variance_m2[3];               /* along, cross, up */
    int has_z;
    int is_isotropic; /* the variances are equal, over two or three axes: the frame does not matter */
};

/* A sensor's time bias in whole microseconds: its clock is so much ahead. Constant cost. */
int32_t rho_measurement_time_bias_us(const struct rho_sensor *sensor);

/*
 * Makes a plot of a polar one: the sensor's biases are taken off (range, azimuth, time), the place is converted,
 * unbiased, and the angles' noise becomes metres across.
 *   measures  RHO_MEASURES_Z: the elevation counts; RHO_MEASURES_RANGE_RATE: the range rate counts
 *   sensor    NULL: at the origin, without biases
 *   plot      offset, place, range rate, snr and sigmas are filled, the rest is 0
 * The mean of r cos(a + noise) is r cos(a) exp(-sigma^2 / 2): the converted place falls short of the true one by
 * r sigma^2 / 2 along the line of sight, and is moved out again. The noise of the angles also spreads the place along
 * the line of sight, with the variance r^2 sigma^4 / 2, which sigma_range_m gets.
 * Errors: NULL, VALUE (range not in 0 .. RHO_LIMIT_POSITION_M, exclusive of 0, azimuth beyond +-pi, elevation beyond
 * +-pi/2, a sigma outside its limits, range rate beyond RHO_LIMIT_SPEED_MPS, the place or offset beyond its limit, also
 * once the biases are off; any of it not finite); *plot is unchanged. Cost: two sines and cosines. Stack: 220 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_measurement_from_polar(const struct rho_polar_plot *polar,
                                                          uint32_t measures,
                                                          const struct rho_sensor *sensor,
                                                          struct rho_plot *plot);

/* True where everything that the scan measures of the plot is finite and within the limits of types.h. Constant cost. */
int rho_measurement_is_valid(const struct rho_plot *plot, uint32_t measures);

/* True where a bearing is within +-pi and its sigma within the limits of types.h. Constant cost. */
int rho_measurement_is_bearing(const struct rho_bearing *bearing);

/* How many times the sigmas of a sensor's plots count, along the line of sight and across it. */
struct rho_sigma_factors {
    float range, cross;
};

/* As the sensor's percents say; NULL, or where they are 0: once. Constant cost. */
struct rho_sigma_factors rho_measurement_sigma_factors(const struct rho_sensor *sensor);

/* The largest of both, and of 1. Constant cost. */
float rho_measurement_widest_factor(const struct rho_sensor *sensor);

/*
 * Opens up a valid plot of a scan that measures `measures`, seen from `sensor` (NULL: from the
 * origin). A plot in the sensor's own place has no line of sight: its noise is taken as isotropic,
 * the largest of its sigmas. The sensor's factors count; on heights the one that is nearer to 1,
 * where both are on one side of it. Cost: two square roots, two divisions. Stack: 80 bytes.
 */
void rho_measurement_open(const struct rho_plot *plot, uint32_t measures,
                          const struct rho_sensor *sensor, struct rho_measurement *out);

/*
 * True where a sensor's place, biases, variance factor and span of range rates are finite and
 * within the limits of types.h. Constant cost.
 */
int rho_measurement_is_sensor(const struct rho_sensor *sensor);

/* The noise's covariance in x, y, z as a lower triangle: xx, yx, yy, zx, zy, zz. Constant cost. */
void rho_measurement_covariance(const struct rho_measurement *measurement, float covariance[6]);

/*
 * The range rate that a sensor (NULL: at the origin) would see of a state [x y z vx vy vz], and its derivative by the
 * state: u = (p - s) / |p - s|, rate = u . v, d rate / d v = u, d rate / d p = (v - rate u) / |p - s|.
 * use_z 0: heights are not known; the sensor and the state count as level.
 * Returns 0, and fills nothing, where the state is nearer than a metre to the sensor. Cost: a square root and two
 * divisions. Stack: 56 bytes.
 */
int rho_measurement_range_rate(const float state[6], const struct rho_sensor *sensor, int use_z,
                               float row[6], float *rate_mps);

/*
 * Ambiguous range rates: a radar of pulse repetition frequency f and wavelength w tells range rates up to multiples of f w / 2,
 * the sensor's range_rate_span_mps. The one meant is the one nearest to what is expected, as long as the expectation is
 * sure enough: three standard deviations of the difference must be within half the span. Where they are not, a range
 * rate counts as if it had not been measured. Of a sensor without a span (or NULL) all of this says nothing new.
 */
#if RHO_AMBIGUOUS_RANGE_RATES
/* Measured minus expected, brought within +-span/2. Cost: a division. */
float rho_measurement_range_rate_error_mps(const struct rho_sensor *sensor, float measured_mps,
                                           float expected_mps);

/* True where a difference of this variance, (m/s)^2, tells which multiple is meant. Constant cost. */
int rho_measurement_is_range_rate_clear(const struct rho_sensor *sensor, float variance);

/*
 * The same for num (2 .. 7) correlated innovations, the last of them a range rate's: it is brought nearest to what the others
 * make of it. covariance: their packed triangle. Returns 0, and changes nothing, where it is not clear even so, or the
 * covariance is not positive definite. Cost: a Cholesky factor of num x num. Stack: 280 bytes.
 */
int rho_measurement_unfold_range_rate(const struct rho_sensor *sensor, int num,
                                      const float *covariance, float *innovation);

/* ln of how many of the range rates -v_max .. v_max a sensor takes for one; 0 where it tells all. Cost: a logarithm. */
float rho_measurement_log_aliases(const struct rho_sensor *sensor, float v_max_mps);

static inline int rho_measurement_has_span(const struct rho_sensor *sensor)
{
    return sensor && sensor->range_rate_span_mps > 0.0f;
}
#else
static inline float rho_measurement_range_rate_error_mps(const struct rho_sensor *sensor,
                                                         float measured_mps, float expected_mps)
{
    (void)sensor;
    return measured_mps - expected_mps;
}

static inline int rho_measurement_is_range_rate_clear(const struct rho_sensor *sensor,
                                                      float variance)
{
    (void)sensor, (void)variance;
    return 1;
}

static inline int rho_measurement_unfold_range_rate(const struct rho_sensor *sensor, int num,
                                                    const float *covariance, float *innovation)
{
    (void)sensor, (void)num, (void)covariance, (void)innovation;
    return 1;
}

static inline float rho_measurement_log_aliases(const struct rho_sensor *sensor, float v_max_mps)
{
    (void)sensor, (void)v_max_mps;
    return 0.0f;
}

static inline int rho_measurement_has_span(const struct rho_sensor *sensor)
{
    (void)sensor;
    return 0;
}
#endif

/*
 * A bearing from a place as a scalar measurement of a state [x y z vx vy vz], in metres across the line of sight: the
 * derivative *row = (-sin, cos) of x and y, *off_m = range times (bearing - the state's own, within +-pi), *range_m.
 * Returns 0, and fills nothing, where the state is nearer than a metre to the place, or not finite.
 * Cost: an arctangent, a square root and a division. Stack: 48 bytes.
 */
int rho_measurement_bearing(const float state[6], float x_m, float y_m, float bearing_rad,
                            float row[6], float *off_m, float *range_m);

/*
 * Did this scan of the sensor look where a target is? Within the scan's sector, the sensor's own, and its range limits.
 * NULL: at the origin, looking everywhere that the scan does. Constant cost, an arctangent.
 */
int rho_measurement_looks_at(const struct rho_sensor *sensor, float sector_from_rad,
                             float sector_to_rad, float x_m, float y_m);

#endif
