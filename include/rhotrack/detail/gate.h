/* SPDX-License-Identifier: MIT */
/*
 * gate: which plots may be a track's?
 *
 * Hough clutter elimination: the plot whose velocity best continues the straight line of the last
 * two estimates. nearest: the squared Mahalanobis distance of the plot from the prediction at the
 * plot's own time, with the covariances of both, against a chi-square limit of 99.9 %. Two
 * dimensions, and one more each where height and range rate count.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_GATE_H
#define RHOTRACK_GATE_H

#include "rhotrack/detail/kalman.h"
#include "rhotrack/detail/measurement.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Hough clutter elimination --------------------------------------------------------------- */

/* Planes of velocity space that the gate uses; values to be or-ed. */
#define RHO_GATE_PLANE_XY 1u
#define RHO_GATE_PLANE_XZ 2u
#define RHO_GATE_PLANE_YZ 4u
#define RHO_GATE_PLANES 3

/*
 * A target that flies straight has estimated velocities that lie on one line of velocity space: in
 * each plane the angle theta* is found whose rho changed least between the last two estimates, and
 * the plot whose velocity changes it least is the target's.
 */
struct rho_gate_hough {
    uint8_t planes; /* RHO_GATE_PLANE_... */
    float newest_mps[3];
    float cos_theta[RHO_GATE_PLANES], sin_theta[RHO_GATE_PLANES]; /* of theta*, by plane */
};

/*
 * Finds theta* in each of the planes: the cell (j - 1/2) theta_cell_rad, j = 1, 2, ..., in [0, pi),
 * whose rho changed least from the estimate before the last to the last; of equals the lowest.
 * That cell is the nearest to the direction at right angles to the velocity's change: cells of any
 * size cost the same. Directions within 1e-6 rad of the border of two cells count as on it.
 * Errors: NULL, VALUE (planes, cell not in 1e-3 .. pi/2, velocities or their change not finite);
 * *hough is unchanged.
 * Cost: about 820 instructions for three planes. Stack: 130 bytes.
 * Source: the paper named in rhotrack/detail/input.h, (20) to (28).
 */
RHO_MUST_CHECK enum rho_status rho_gate_hough_open(struct rho_gate_hough *hough, uint8_t planes,
                                                   float theta_cell_rad, const float before_mps[3],
                                                   const float newest_mps[3]);

/*
 * How far a plot with this velocity would change rho at theta*, summed over the planes, m/s. (29),
 * (30). NaN where the velocity is. Cost: about 45 instructions. Stack: 8 bytes.
 */
float rho_gate_hough_residual_mps(const struct rho_gate_hough *hough, const float velocity_mps[3]);

/* ---- nearest --------------------------------------------------------------------------------- */

/* The range rate that a track would have; covariances with its place. */
struct rho_gate_rate {
    int is_known; /* 0: the track is in the sensor's place */
    float rate_mps, variance, covariance[3];
};

/* A track's prediction at a scan's time, as its gate sees it. The sensor stays the caller's. */
struct rho_gate {
    struct rho_kalman predicted;
    float noise_density;             /* white acceleration until a plot's own time, m^2/s^3 */
    const struct rho_sensor *sensor; /* that looks; NULL: from the origin */
    uint32_t measures;               /* RHO_MEASURES_... of the scan */
    int has_z;                       /* the third axis is open */
    struct rho_gate_rate rate;       /* unset where the scan measures no range rates */
};

struct rho_gate_result {
    float distance2; /* squared Mahalanobis distance */
    float log_det;   /* ln det of the innovation covariance, m^2 an axis, (m/s)^2 of a range rate */
    int has_z;       /* height counts */
    int has_range_rate; /* range rate counts */
};

/*
 * Takes the prediction over. Cost: its bytes, and 300 instructions where range rates are measured.
 * Stack: 150 bytes.
 */
void rho_gate_open(struct rho_gate *gate, const struct rho_kalman *predicted, float noise_density,
                   const struct rho_sensor *sensor, uint32_t measures);

/*
 * How far from the prediction, along x and along y, a plot can be and still be in the gate, whose
 * noise and whose own time, either way, are at most these. NaN where the prediction is. Cost: about
 * 60 instructions.
 */
void rho_gate_box(const struct rho_gate *gate, float sigma_m, float offset_s, float half_m[2]);

/*
 * Tests a valid plot. Returns 1 and fills *result where the plot is in the gate, else 0 (also where
 * the covariance is not positive definite). z counts where both have it, a range rate where the
 * scan measures it and the prediction is not in the sensor's place; an ambiguous one where it is
 * clear which one is meant (measurement.h). The prediction moves on with the plot's own time.
 * Cost: about 30 instructions; for plots inside the gate's box about 350 more, as many again for a
 * plot with an own time, and 300 for its range rate. Stack: 850 bytes.
 */
int rho_gate_test(const struct rho_gate *gate, const struct rho_plot *plot,
                  struct rho_gate_result *result);

/*
 * The same for a bearing from a place: one dimension, log_det of rad^2. Cost: about 200
 * instructions, and a prediction for a bearing with an own time. Stack: 320 bytes.
 */
int rho_gate_test_bearing(const struct rho_gate *gate, const struct rho_bearing *bearing, float x_m,
                          float y_m, struct rho_gate_result *result);

#ifdef __cplusplus
}
#endif

#endif
