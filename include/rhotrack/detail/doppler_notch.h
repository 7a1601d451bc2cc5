/* SPDX-License-Identifier: MIT */
/*
 * doppler_notch: a radar's Doppler notch, range rates at which it is blind, and the evidence of a
 * miss.
 *
 * A radar that suppresses standing clutter sees no target within notch_mps of zero Doppler, nor
 * within notch_mps of a multiple of its blind speed (struct rho_sensor). Range rates are those over
 * ground: the motion of the radar itself is subtracted. If an estimate's range rate r is N(m, s^2),
 * looks are blind with the probability q = P(r in the notch), so a miss has the probability
 *
 *      L = 1 - pd + pd q
 *
 * and is evidence of r: its density after the miss is N(r; m, s^2) / L within the notch, and
 * (1 - pd) N(r; m, s^2) / L elsewhere. rho_notch_update_by_miss gives the estimate
 * the mean and variance of this density, as a measurement of r would. A target that was braking is
 * thereby held in the notch until it is seen again.
 *
 * Stack: 270 bytes at most.
 */
#ifndef RHOTRACK_DOPPLER_NOTCH_H
#define RHOTRACK_DOPPLER_NOTCH_H

#include "rhotrack/config.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

/* Most speed of a standing target, in half widths of the notch and in the speed's sigmas. */
#define RHO_NOTCH_STAND_WIDTHS 2.0f

/* A look that yields no plot of a target. */
struct rho_notch_look {
    float pd;       /* probability of detection at range rates outside of the notch */
    float rest_mps; /* above 0: half width of the target's own notch, at rest; pd: over rest's */
    /* 1: a slow target that is missed is taken to stand still */
    uint8_t may_stand;
};

/* True for a sensor with a Doppler notch; constantly 0 in a build without RHO_DOPPLER_NOTCH. */
static inline int rho_notch_sensor_has_notch(const struct rho_sensor *sensor)
{
    return RHO_DOPPLER_NOTCH && sensor && sensor->notch_mps > 0.0f;
}

/* True where a sensor's notch and blind speed are within their limits. */
int rho_notch_is_valid(const struct rho_sensor *sensor);

/*
 * Probability that the range rate of an estimate [x y z vx vy vz ...] is in the notch; covariance:
 * a packed triangle. z counts where its variance is above 0. 0 for a sensor without a notch, or an
 * estimate at the sensor's place. Cost: about 300 instructions, and 150 for each blind speed within
 * 4 sigma.
 */
float rho_notch_blind_probability(const struct rho_sensor *sensor, const float *state,
                                  const float *covariance);

/*
 * Updates an estimate of num_states elements, 6 or 9 (with accelerations), by a look without a
 * plot; sensor: NULL, one at the origin. Returns the probability of the miss. Cost: as
 * rho_notch_blind_probability, and 5 num_states^2.
 */
float rho_notch_update_by_miss(const struct rho_sensor *sensor, const struct rho_notch_look *look,
                               int num_states, float *state, float *covariance);

RHO_END_C

#endif
