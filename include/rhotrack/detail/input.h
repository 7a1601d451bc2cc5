/* SPDX-License-Identifier: MIT */
/*
 * input: a Kalman filter that also estimates the target's acceleration, its unknown input.
 *
 * Two stages. `bare` is a Kalman filter without input. Its response to a constant input since the
 * onset k is linear, with the sensitivities M (after an update) and N (after a prediction), one
 * column per axis,
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
 * coupled ones. A scan of a position and a velocity with the Hough gate of five plots: 4770
 * instructions.
 *
 *     rho_input_predict(&input, &config, dt_s);
 *     rho_input_update_position(&input, &config, &measurement);   further measurements follow
 *     rho_input_decide(&input, &config);                          once per scan with a plot
 *     rho_input_estimate(&input, &kalman);                        at any time
 *
 * Source: the input estimation of "a novel tracking algorithm by integrating the Kalman filter,
 * input estimation, and clutter elimination algorithm to track maneuvering targets in cluttered
 * environments", (2) to (18).
 *
 * Stack: 32 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_INPUT_H
#define RHOTRACK_INPUT_H

#include <stdint.h>

#include "rhotrack/detail/kalman.h"
#include "rhotrack/detail/measurement.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define RHO_INPUT_AXES 3

/* Effect of a constant input in an interval T on position and velocity. */
enum rho_input_model {
    RHO_INPUT_LITERAL = 0, /* the paper's D: 0 and T. No input is found from positions alone */
    RHO_INPUT_PHYSICAL,    /* T^2 / 2 and T */
    RHO_NUM_INPUT_MODELS
};

struct rho_input_config {
    uint16_t is_estimated; /* 0: a plain Kalman filter */
    uint16_t model;        /* enum rho_input_model */
    float sigma_mps2;      /* initial sd of the input, sqrt(V(0)): 1e-3 .. 1e5 */
    float threshold;       /* an input is present above so many sigmas: > 0 */
    float gamma; /* forgetting: V / gamma at each prediction, V(0) at most; 1: none. > 0 .. 1 */
    float noise_density; /* white acceleration, m^2/s^3: >= 0 */
    /* the paper's Q: sd added at each prediction, independent of its interval: 0 .. 1e6 */
    float noise_m, noise_mps;
    float velocity_variance; /* of an axis that opens later: RHO_KALMAN_VARIANCE_MIN .. MAX */
    /*
     * the paper's P(0|0) is this times I, m^2 and (m/s)^2, taken by whoever starts a track
     * (rho_kalman_set_covariance): 0 .. RHO_KALMAN_VARIANCE_MAX. 0: what its plots make of it
     */
    float initial_variance;
};

struct rho_input {
    struct rho_kalman bare; /* the filter without input */
    /* by input: N after a prediction, M after an update */
    float sensitivity[RHO_INPUT_AXES][RHO_KALMAN_STATES];
    float input_mps2[RHO_INPUT_AXES];             /* u */
    float variance[RHO_TRIANGLE(RHO_INPUT_AXES)]; /* V, (m/s^2)^2 */
    uint32_t present;                             /* bit an axis: x 1, y 2, z 4 */
};

/*
 * Two-sided threshold of a standard normal: 0.95 gives 1.96. Absolute error <= 1e-3 for 0 .. .9999;
 * NaN outside 0 .. 1, exclusive of 1. Cost: a logarithm, a square root. Stack: 32 bytes.
 */
float rho_input_threshold(float confidence);

/*
 * As in the paper: literal D, sigma 22.36 m/s^2, confidence .95, gamma 1, noise 1 m and 1 m/s;
 * velocity sd 700 m/s.
 */
void rho_input_config_default(struct rho_input_config *config);

/* True where every field is finite and within its range. */
int rho_input_is_usable(const struct rho_input_config *config);

/*
 * Starts from an estimate, without input. Errors: NULL, CONFIG (not usable; the calls below do not
 * look again). Constant cost. Stack: 200 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_start(struct rho_input *input,
                                               const struct rho_input_config *config,
                                               const struct rho_kalman *estimate);

/*
 * Moves on by dt_s: the bare filter, N, forgetting. Back (dt_s < 0) there is neither noise nor
 * forgetting, and dt_s 0 changes nothing. Errors: as rho_kalman_predict, also where an input that
 * is present makes the result too uncertain.
 * Cost: about 730 instructions with forgetting, 1050 coupled. Stack: 600 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_predict(struct rho_input *input,
                                                 const struct rho_input_config *config, float dt_s);

/*
 * One scalar update of element 0 .. 5 of the state. Errors: as rho_kalman_update; VALUE where an
 * input would be beyond 1e12. Cost: about 460 instructions, 880 coupled. Stack: 550 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_update(struct rho_input *input,
                                                const struct rho_input_config *config, int element,
                                                float value, float variance);

/*
 * One scalar update: row . state was measured, `innovation` is its measured value minus that of the
 * bare filter.
 * Errors: as rho_kalman_update_row, and above. Cost: about 1500 instructions. Stack: 520 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_update_row(struct rho_input *input,
                                                    const struct rho_input_config *config,
                                                    const float row[6], float innovation,
                                                    float variance);

/*
 * Updates with a position, in the frame of its noise. Axes that are not open are opened as
 * rho_kalman_update_position does. Errors: as there. Cost: an update an axis; where the noise is
 * not isotropic, one by a row. Stack: 1050 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_update_position(struct rho_input *input,
                                                         const struct rho_input_config *config,
                                                         const struct rho_measurement *measurement);

/*
 * Updates with a range rate, linearised at the corrected estimate. Errors: as
 * rho_kalman_update_range_rate.
 * Cost: the estimate, and an update by a row. Stack: 740 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_update_range_rate(struct rho_input *input,
                                                           const struct rho_input_config *config,
                                                           const struct rho_sensor *sensor,
                                                           float rate_mps, float variance);

/*
 * Updates with a bearing from a place, linearised at the corrected estimate. Errors: as
 * rho_kalman_update_bearing.
 * Cost: as above. Stack: 760 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_input_update_bearing(struct rho_input *input,
                                                        const struct rho_input_config *config,
                                                        float x_m, float y_m, float bearing_rad,
                                                        float sigma_rad);

/*
 * Tests each axis, starts anew where no input is present, and takes one that has stopped into the
 * estimate. Once a scan, after what the plot measures; a scan without a plot decides nothing. Where
 * the inputs of axes are correlated the weakest is tested first, and the others as they are without
 * it. Cost: about 110 instructions, 300 where three inputs stop, 1500 where they are coupled.
 * Stack: 140 bytes.
 */
void rho_input_decide(struct rho_input *input, const struct rho_input_config *config);

/*
 * The corrected estimate, (14) to (18). Cost: about 260 instructions, 2100 coupled.
 * Stack: 160 bytes.
 */
void rho_input_estimate(const struct rho_input *input, struct rho_kalman *estimate);

/*
 * The same as a gate has to see it: an axis without input may have got one since the last plot, of
 * 0 with variance V(0).
 * Cost and stack as above.
 */
void rho_input_expect(const struct rho_input *input, struct rho_kalman *estimate);

#ifdef __cplusplus
}
#endif

#endif
