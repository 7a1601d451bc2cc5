/* SPDX-License-Identifier: MIT */
/*
 * notch: range rates at which a radar is blind, and what a look without a plot says there.
 *
 * A radar that takes off what stands sees no target within notch_mps of zero Doppler, nor within as
 * much of a multiple of its blind speed (struct rho_sensor). Range rates are those over ground: the
 * motion of the radar itself is taken off. Of an estimate with the range rate r ~ N(m, s^2) the
 * share q = P(r in the notch) of looks is blind, so a miss has the probability
 *
 *      L = 1 - pd + pd q
 *
 * and is evidence of r: its density after the miss is (1 - pd) N(r; m, s^2) / L, and 1 / L of it
 * within the notch. rho_notch_miss gives the estimate that mean and that variance, as a measurement
 * of r would. A target that was braking is thereby held in the notch until it is seen again.
 *
 * Stack: 250 bytes at most.
 */
#ifndef RHOTRACK_NOTCH_H
#define RHOTRACK_NOTCH_H

#include "rhotrack/config.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A target that is no faster than so many times the notch may stand. */
#define RHO_NOTCH_STAND_WIDTHS 2.0f

/* A look that yields no plot of a target. */
struct rho_notch_look {
    float pd; /* of range rates that the radar sees */
    /* the target may stand: what is slow enough to stand, and is not seen, does */
    uint8_t may_stand;
};

/* True of a sensor that is blind somewhere: known to the compiler where there is no such. */
static inline int rho_notch_has(const struct rho_sensor *sensor)
{
    return RHO_DOPPLER_NOTCH && sensor && sensor->notch_mps > 0.0f;
}

/* True where the notch of a sensor is within its limits. */
int rho_notch_is_usable(const struct rho_sensor *sensor);

/*
 * The share of looks that are blind to an estimate [x y z vx vy vz ...] with the triangle of its
 * covariance; its z counts where its variance is above 0. 0 of a sensor without a notch, or where
 * the estimate is. Cost: about 300 instructions, and 150 for each blind speed within 4 sigma.
 */
float rho_notch_share(const struct rho_sensor *sensor, const float *state, const float *covariance);

/*
 * The estimate of num_states elements, 6 or 9 (with accelerations), after a look without a plot.
 * Returns the probability of that. Cost: as rho_notch_share, and num_states^2 * 5.
 */
float rho_notch_miss(const struct rho_sensor *sensor, const struct rho_notch_look *look,
                     int num_states, float *state, float *covariance);

#ifdef __cplusplus
}
#endif

#endif
