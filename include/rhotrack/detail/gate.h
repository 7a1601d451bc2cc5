/* SPDX-License-Identifier: MIT */
/*
 * gate: tests which plots or bearings may belong to a track, by one of two gates.
 *
 * Hough clutter elimination selects the plot whose velocity best continues the straight line of the
 * last two estimates' velocities. The gate `nearest` compares the squared Mahalanobis distance of
 * plot and prediction at the plot's own time, by the covariances of both, with a chi-square limit
 * of 99.9 %: in two dimensions, and one more each for height and range rate where measured.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_GATE_H
#define RHOTRACK_GATE_H

#include "rhotrack/detail/kalman.h"
#include "rhotrack/detail/measurement.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

/* Planes of velocity space that the Hough gate uses; values to be or-ed. */
#define RHO_GATE_PLANE_XY 1u
#define RHO_GATE_PLANE_XZ 2u
#define RHO_GATE_PLANE_YZ 4u
#define RHO_GATE_PLANES 3

/*
 * A target that flies straight has estimated velocities that lie on one line of velocity space: in
 * each plane the angle theta* is found whose rho changed least between the last two estimates, and
 * the plot whose velocity changes rho least is taken for the target's.
 */
struct rho_gate_hough {
    uint8_t planes; /* planes of velocity space that are used, RHO_GATE_PLANE_... */
    float newest_mps[3];
    /* cosine and sine of theta*, by plane */
    float cos_theta[RHO_GATE_PLANES], sin_theta[RHO_GATE_PLANES];
};

/*
 * Finds theta* in each of the planes: the cell (j - 1/2) theta_cell_rad, j = 1, 2, ..., in [0, pi),
 * whose rho changed least from the estimate before the last to the last; of equals the lowest. That
 * cell is the nearest to the direction at right angles to the velocity's change: cells of any size
 * cost the same. Directions within 1e-6 rad of the border of two cells count as on it. Errors:
 * NULL, VALUE (planes, cell not in 1e-3 .. pi/2, velocities or their change not finite); *hough is
 * unchanged. Cost: about 820 instructions for three planes. Stack: 130 bytes. Source: the paper
 * named in rhotrack/detail/input_estimation.h, (20) to (28).
 */
RHO_MUST_CHECK enum rho_status rho_gate_hough_init(struct rho_gate_hough *hough, uint8_t planes,
                                                   float theta_cell_rad, const float before_mps[3],
                                                   const float newest_mps[3]);

/*
 * Hough residual of a plot: how far its velocity would change rho at theta*, summed over planes,
 * m/s; the paper's (29), (30). NaN where the velocity is. Cost: 45 instructions. Stack: 8 bytes.
 */
float rho_gate_hough_distance_mps(const struct rho_gate_hough *hough, const float velocity_mps[3]);

/* The predicted range rate, its variance, and its covariances with the position. */
struct rho_gate_rate {
    int is_known; /* 0: the track is at the sensor's position, and has no range rate */
    float rate_mps, variance, covariance[3];
};

/* A track's prediction at a scan's time. The sensor is referred to, not copied. */
struct rho_gate {
    struct rho_kalman predicted;
    /* density of white acceleration, m^2/s^3, for predictions to a plot's own time */
    float noise_density;
    const struct rho_sensor *sensor; /* sensor of the scan; NULL: one at the origin */
    uint32_t measures;               /* quantities that the scan measures, RHO_MEASURES_... */
    int has_z;                       /* 1: the track has a height */
    struct rho_gate_rate rate;       /* predicted range rate; unset where the scan measures none */
};

struct rho_gate_result {
    float distance2; /* squared Mahalanobis distance, the NIS */
    float log_det;   /* ln det of the innovation covariance, m^2 an axis, (m/s)^2 of a range rate */
    int has_z;       /* 1: height is one of the tested dimensions */
    int has_range_rate; /* 1: range rate is one of the tested dimensions */
};

/*
 * Opens a gate: copies a track's prediction at a scan's time, and predicts its range rate if the
 * scan measures it. Cost: the copy, and 300 instructions for range rates. Stack: 150 bytes.
 */
void rho_gate_open(struct rho_gate *gate, const struct rho_kalman *predicted, float noise_density,
                   const struct rho_sensor *sensor, uint32_t measures);

/*
 * Half widths, along x and y, of a box about the prediction that contains all plots in the gate
 * with sigmas of at most sigma_max_m and own times of at most offset_max_s either way. NaN where
 * the prediction is. Cost: about 60 instructions.
 */
void rho_gate_box(const struct rho_gate *gate, float sigma_max_m, float offset_max_s,
                  float half_widths_m[2]);

/*
 * Tests a valid plot. Returns 1 and fills *result where the plot is in the gate, else 0 (also where
 * the covariance is not positive definite). Height is tested where plot and track have one; a range
 * rate where the scan measures it, the prediction is not at the sensor's position, and an ambiguous
 * range rate can be unfolded (measurement.h). The prediction is moved to the plot's own time.
 * Cost: about 30 instructions; for plots inside the gate's box about 350 more, as many again for a
 * plot with an own time, and 300 for its range rate. Stack: 850 bytes.
 */
int rho_gate_test(const struct rho_gate *gate, const struct rho_plot *plot,
                  struct rho_gate_result *result);

RHO_END_C

#endif
