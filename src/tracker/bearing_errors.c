/* SPDX-License-Identifier: MIT */
/*
 * bearing_errors: errors of a passive sensor's bearings that last, as of a camera that is turned by
 * some degrees, or sees a near ship's bow and later its stern.
 *
 * Such errors do not average out, and pull tracks away from their plots. They show where a bearing
 * follows a plot of the same track, which the track's velocity takes to the bearing's time: the
 * squared difference is s on average by both stated noises, and s + v with lasting errors of the
 * variance v. Over such pairs, each with the weight 1 / (s + v)^2 of its own noise,
 *
 *      v = sum of weight (off^2 - s) / sum of weights
 *
 * where that is more than two of its standard errors, sqrt(2 / sum of weights); else 0. Bearings
 * are gated by their noise and v. In estimates v counts as often as the sensor looks in 20 s, so
 * that all its bearings of that time count as one.
 */
#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "sensors.h"

float rho_bearing_errors_rad2(const struct rho_bearing_errors *errors)
{
    return errors->excess > LASTING_SIGMAS * rho_sqrt(2.0f * errors->weight)
               ? errors->excess / errors->weight
               : 0.0f;
}

void rho_bearing_errors_open(struct rho_look *look, const struct rho_tracker_sensor *row)
{
    look->lasting_rad2 = row && look->tracker->config.learn_noise_max > 1.0f
                             ? rho_bearing_errors_rad2(&row->bearing_errors)
                             : 0.0f;
    look->lasting_looks =
        row && row->pace.interval_s < LASTING_S
            ? LASTING_S / rho_larger(row->pace.interval_s, LASTING_S / LASTING_LOOKS_MAX)
            : 1.0f;
}

void rho_bearing_errors_compare(const struct rho_look *look, struct rho_bearing_errors *errors,
                                struct rho_track *track, const struct rho_bearing *bearing)
{
    const int64_t time_us = look->bearings->time_us + bearing->offset_us;
    const float since_s = rho_seconds_between(track->updated_us, time_us);
    const float dx_m = track->plot_m[0] + since_s * track->kalman.state[3] - look->bearings->x_m;
    const float dy_m = track->plot_m[1] + since_s * track->kalman.state[4] - look->bearings->y_m;
    const float range2_m2 = dx_m * dx_m + dy_m * dy_m;
    if (track->has_new_plot && track->was_confirmed && range2_m2 > 1.0f) {
        const float off_rad = rho_angle_wrap(bearing->bearing_rad - rho_atan2(dy_m, dx_m));
        const float noise_rad2 = bearing->sigma_rad * bearing->sigma_rad +
                                 track->plot_sigma_m * track->plot_sigma_m / range2_m2;
        const float variance_rad2 = noise_rad2 + look->lasting_rad2;
        const float weight = 1.0f / (variance_rad2 * variance_rad2);
        const float square_rad2 = rho_smaller(off_rad * off_rad, PAIR_CHI2 * variance_rad2);
        const float keep = errors->pairs > (float)LEARNED_MAX ? 0.5f : 1.0f;
        errors->pairs = keep * errors->pairs + 1.0f;
        errors->weight = keep * errors->weight + weight;
        errors->excess = keep * errors->excess + weight * (square_rad2 - noise_rad2);
    }
    track->has_new_plot = 0;
}

int rho_bearing_errors_are_sound(const struct rho_bearing_errors *errors)
{
    return rho_is_within(errors->pairs, 0.0f, 1e9f) && rho_is_within(errors->weight, 0.0f, 1e36f) &&
           rho_is_within(errors->excess, -1e36f, 1e36f);
}
