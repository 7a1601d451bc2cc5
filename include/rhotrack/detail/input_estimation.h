/* SPDX-License-Identifier: MIT */
/*
 * input_estimation: a Kalman filter that also estimates the target's acceleration, its unknown
 * input.
 *
 * Input estimation in two stages. `bare` is a Kalman filter without input. Its response to a
 * constant input since the onset k is linear, with the sensitivities M (after an update) and N
 * (after a prediction), one column per axis,
 *
 *     N(n+1) = F M(n) + D,    M(n+1) = (I - K H) N(n+1),    M(k) = 0,
 *
 * so the innovations are a linear regression in the input, nu = H N u + e, solved by recursive
 * least squares for its estimate u and variance V. An input is taken as present on an axis while
 * |u| / sqrt(V) is above a threshold. While it is absent M, u and V are reset at each update, so
 * that an onset is detected in one scan; when it ends, M u is added to the estimate and M V M^T to
 * its covariance. The corrected estimate is x + M u with covariance P + M V M^T.
 *
 * A refused call leaves the object unchanged, byte for byte. No pointers: a copy is a snapshot, of
 * 220 bytes. Costs below are for three axes with inputs, first with independent axes, then with
 * coupled ones. A whole scan, a position and a velocity selected from five plots by the Hough gate,
 * costs 4770 instructions.
 *
 *     rho_input_predict(&input, &config, dt_s);
 *     rho_input_update_position(&input, &config, &measurement);   further measurements follow
 *     rho_input_decide(&input, &config);                 once per scan with a plot
 *     rho_input_estimate(&input, &kalman);                        at any time
 *
 * Source: the input estimation of "a novel tracking algorithm by integrating the Kalman filter,
 * input estimation, and clutter elimination algorithm to track maneuvering targets in cluttered
 * environments", (2) to (18).
 *
 * Stack: 32 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_INPUT_ESTIMATION_H
#define RHOTRACK_INPUT_ESTIMATION_H

#include <stdint.h>

#include "rhotrack/detail/kalman.h"
#include "rhotrack/detail/measurement.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

#define RHO_INPUT_AXES 3

/* Effect of a constant input in an interval T on position and velocity. */
enum rho_input_model {
    RHO_INPUT_LITERAL = 0, /* the paper's D: 0 and T. No input is found from positions alone */
    RHO_INPUT_PHYSICAL,    /* a constant acceleration: T^2 / 2 and T */
    RHO_NUM_INPUT_MODELS
};

struct rho_input_config {
    uint16_t is_estimated; /* 1: inputs are estimated; 0: a plain Kalman filter */
    uint16_t model;        /* model of an input's effect, enum rho_input_model */
    float sigma_mps2;      /* initial sd of the input, sqrt(V(0)): 1e-3 .. 1e5 */
    float threshold;       /* sigmas of an input above which it counts as present: > 0 */
    float gamma; /* forgetting: V / gamma at each prediction, V(0) at most; 1: none. > 0 .. 1 */
    float noise_density; /* white acceleration, m^2/s^3: >= 0 */
    /* the paper's Q: sd added at each prediction, independent of its interval: 0 .. 1e6 */
    float noise_m, noise_mps;
    /* velocity variance of an axis that a plot opens: RHO_VARIANCE_MIN .. MAX */
    float velocity_variance;
    /*
     * a new track's covariance, the paper's P(0|0), is this times I, m^2 and (m/s)^2: 0 ..
     * RHO_VARIANCE_MAX; 0: its first plots determine it. Applied by the caller that starts a
     * track (rho_kalman_set_equal_variances)
     */
    float initial_variance;
};

struct rho_input {
    struct rho_kalman bare; /* the filter without input */
    /* derivatives of the state by each input: N after a prediction, M after an update */
    float sensitivity[RHO_INPUT_AXES][RHO_KALMAN_STATES];
    float input_mps2[RHO_INPUT_AXES];             /* u, the estimated inputs */
    float variance[RHO_TRIANGLE(RHO_INPUT_AXES)]; /* V, covariance of the inputs, (m/s^2)^2 */
    /* axes on which an input is present, as bits: x 1, y 2, z 4 */
    uint32_t present;
};

/*
 * Two-sided threshold of a standard normal: 0.95 gives 1.96. Absolute error <= 1e-3 for 0 .. .9999;
 * NaN outside 0 .. 1, exclusive of 1. Cost: a logarithm, a square root. Stack: 32 bytes.
 */
float rho_input_threshold_sigmas(float confidence);

/*
 * Fills *config as in the paper: literal D, sigma 22.36 m/s^2, confidence .95, gamma 1, noise 1 m
 * and 1 m/s; velocity sd 700 m/s. Stack: 72 bytes.
 */
void rho_input_config_default(struct rho_input_config *config);

/* True where every field is finite and within its range. */
int rho_input_is_usable(const struct rho_input_config *config);

/*
 * Starts from an estimate, without input. Errors: CONFIG (config not usable; other calls do not
 * check it). Constant cost. Stack: 200 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_start(struct rho_input *input,
                                               const struct rho_input_config *config,
                                               const struct rho_kalman *estimate);

/*
 * Predicts the bare filter and N by dt_s, and applies forgetting. Back in time (dt_s < 0) there is
 * neither noise nor forgetting, and dt_s 0 changes nothing. Errors: as rho_kalman_predict, and
 * VALUE where the variance of a present input makes the result too uncertain.
 * Cost: about 730 instructions with forgetting, 1050 coupled. Stack: 600 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_predict(struct rho_input *input,
                                                 const struct rho_input_config *config, float dt_s);

/*
 * A scalar update of element 0 .. 5 of the state. Errors: as rho_kalman_update; VALUE where an
 * input would exceed 1e12 m/s^2. Cost: about 460 instructions, 880 coupled. Stack: 552 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_update_element(struct rho_input *input,
                                                        const struct rho_input_config *config,
                                                        int element, float value, float variance);

/*
 * One scalar update: row . state was measured, `innovation` is its measured value minus that of the
 * bare filter. Errors: as rho_kalman_update_row and rho_input_update_element. Cost: about
 * 1500 instructions. Stack: 520 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_update_row(struct rho_input *input,
                                                    const struct rho_input_config *config,
                                                    const float row[6], float innovation,
                                                    float variance);

/*
 * Updates with a position, in the frame of its noise. Opens axes and has errors as
 * rho_kalman_update_position. Cost: rho_input_update_element an axis; where the noise is
 * not isotropic, rho_input_update_row. Stack: 1050 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_update_position(struct rho_input *input,
                                                         const struct rho_input_config *config,
                                                         const struct rho_measurement *measurement);

/*
 * Updates with a range rate, linearised at the corrected estimate. Errors: as
 * rho_kalman_update_range_rate.
 * Cost: rho_input_estimate and rho_input_update_row. Stack: 740 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_update_range_rate(struct rho_input *input,
                                                           const struct rho_input_config *config,
                                                           const struct rho_sensor *sensor,
                                                           float rate_mps, float variance);

/*
 * Updates with a bearing from a place, linearised at the corrected estimate. Errors: as
 * rho_kalman_update_bearing. Cost: as rho_input_update_range_rate. Stack: 760 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_update_bearing(struct rho_input *input,
                                                        const struct rho_input_config *config,
                                                        float x_m, float y_m, float bearing_rad,
                                                        float sigma_rad);

/* Updates with a slope, as rho_kalman_update_slope. Cost: as of a bearing. Stack: 620 bytes. */
RHO_MUST_CHECK enum rho_status rho_input_update_slope(struct rho_input *input,
                                                      const struct rho_input_config *config,
                                                      const struct rho_slope *slope);

/*
 * Tests on each axis whether an input is present, restarts its estimation where none is, and moves
 * the effect of an input that has ended into the estimate. To be called once a scan with a plot,
 * after its updates. If the inputs of axes are correlated, the weakest is tested first, and the
 * others conditioned on its absence. Cost: about 110 instructions, 300 where three inputs end, 1500
 * where they are coupled. Stack: 144 bytes.
 */
void rho_input_decide(struct rho_input *input, const struct rho_input_config *config);

/*
 * Fills *estimate with the corrected estimate, the paper's (14) to (18). Cost: about 260
 * instructions, 2100 coupled. Stack: 160 bytes.
 */
void rho_input_estimate(const struct rho_input *input, struct rho_kalman *estimate);

/*
 * Fills *estimate with the corrected estimate for a gate: an axis without input may have got one
 * since the last plot, so that an input of 0 with variance V(0) is included. Cost as
 * rho_input_estimate, stack as above.
 */
void rho_input_gate_estimate(const struct rho_input *input, struct rho_kalman *estimate);

RHO_END_C

#endif
