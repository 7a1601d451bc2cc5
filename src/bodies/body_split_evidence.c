/* SPDX-License-Identifier: MIT */
/*
 * body_split_evidence: collects evidence that a track's body is really two targets, and decides on
 * it.
 *
 * The plots of a look are compared with those of one rigid body. Their extent is at most that of
 * the longest body. And while the body keeps its heading, range rates vary over it like a plane no
 * steeper than an unseen turn explains. Two cars in neighbouring lanes, one faster than the other,
 * are told apart by range rates within a few seconds, long before they are resolved; two cars in
 * one lane, so near that they were taken for one truck, are told apart by their length.
 */
#include "bodies.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

static float heading_tolerance_rad(const struct rho_body_filter *body)
{
    return STEADY_RAD + body->heading_sigma_rad;
}

void rho_bodies_sum_plot(struct body_sums *sums, const struct rho_plot *plot,
                         const struct outline_fit *at)
{
    const float values[3] = {at->sight_line[0] * at->dx_m + at->sight_line[1] * at->dy_m,
                             at->sight_line[0] * at->dy_m - at->sight_line[1] * at->dx_m,
                             at->rate_mps};
    sums->first_m = sums->n > 0.0f ? rho_smaller(sums->first_m, at->along_m) : at->along_m;
    sums->last_m = sums->n > 0.0f ? rho_larger(sums->last_m, at->along_m) : at->along_m;
    sums->noise_m2 = rho_larger(sums->noise_m2, at->noise_m2[0]);
    sums->n += 1.0f;
    for (unsigned i = 0, k = 0; i < 3; i++) {
        sums->values[i] += values[i];
        for (unsigned j = 0; j <= i; j++) {
            sums->of[k++] += values[i] * values[j];
        }
    }
    sums->of[BODY_SIDE_NOISE] += plot->sigma_cross_m * plot->sigma_cross_m;
    sums->of[BODY_RATE_NOISE] += plot->sigma_range_rate_mps * plot->sigma_range_rate_mps;
    sums->of[BODY_RATE_UNKNOWN] += at->line_turn_m2ps2;
}

void rho_bodies_add_doubt(struct rho_tracker *tracker, const struct rho_look *look,
                          const struct body_sums *sums, unsigned row)
{
    struct rho_body_filter *body = &tracker->bodies.of[row];
    struct rho_body_doubt *doubt = &body->doubt;
    const float passed_s =
        doubt->looks > 0.0f ? rho_seconds_between(doubt->time_us, look->time_us) : 0.0f;
    if (sums->n < 2.0f || !body->has_heading) {
        return;
    }
    const float mean = 1.0f / sums->n;
    doubt->time_us = look->time_us;
    const float share = 1.0f - 1.0f / DOUBT_MEMORY;
    doubt->looks = share * doubt->looks + 1.0f;
    doubt->long_looks *= share;
    const float ahead =
                    doubt->cos_heading * body->cos_heading + doubt->sin_heading * body->sin_heading,
                aside =
                    doubt->cos_heading * body->sin_heading - doubt->sin_heading * body->cos_heading;
    /* sums of range rates begin anew with a turn: parts of a turning body have different ones */
    const int is_anew = doubt->sums[BODY_PLOTS_BEYOND_ONE] <= 0.0f ||
                        rho_magnitude(aside) > heading_tolerance_rad(body) * ahead;
    const float kept = is_anew ? 0.0f : share;
    doubt->steady_looks *= kept;
    doubt->time_s = is_anew ? 0.0f : share * doubt->time_s + passed_s;
    doubt->cos_heading += (1.0f - kept) * (body->cos_heading - doubt->cos_heading);
    doubt->sin_heading += (1.0f - kept) * (body->sin_heading - doubt->sin_heading);
    for (unsigned k = 0; k < RHO_BODY_SUMS; k++) {
        doubt->sums[k] *= kept;
    }
    if (sums->last_m - sums->first_m >
        tracker->bodies.length_max_m + BODY_ERROR_SIGMAS * rho_sqrt(sums->noise_m2)) {
        doubt->long_looks += 1.0f;
    }
    if (!(look->scan->measures & RHO_MEASURES_RANGE_RATE) || body->plots < SETTLED_LOOKS) {
        return; /* the velocity of a new track is too uncertain for its range rates to be judged */
    }
    doubt->steady_looks += 1.0f;
    /* one sigma of the velocity across the line of sight adds this turn to range rates */
    const struct rho_track *track = &tracker->tracks[row];
    const float x_m = track->kalman.state[RHO_X] - (look->sensor ? look->sensor->x_m : 0.0f),
                y_m = track->kalman.state[RHO_Y] - (look->sensor ? look->sensor->y_m : 0.0f);
    const float turned_radps =
        rho_track_sigma_mps(track) / (rho_sqrt(x_m * x_m + y_m * y_m) + 1.0f);
    const float side_m2 = sums->of[RHO_AT(BODY_SIDE, BODY_SIDE)] -
                          mean * sums->values[BODY_SIDE] * sums->values[BODY_SIDE];
    for (unsigned i = 0, k = 0; i < 3; i++) {
        for (unsigned j = 0; j <= i; j++, k++) {
            doubt->sums[k] += sums->of[k] - mean * sums->values[i] * sums->values[j];
        }
    }
    for (unsigned k = BODY_SIDE_NOISE; k <= BODY_RATE_UNKNOWN; k++) {
        doubt->sums[k] += (1.0f - mean) * sums->of[k];
    }
    doubt->sums[BODY_RATE_UNKNOWN] += turned_radps * turned_radps * side_m2;
    doubt->sums[BODY_PLOTS_BEYOND_ONE] += sums->n - 1.0f;
}

/* What a plane over the body explains of the squares of range rates, by least squares. */
static float explained_m2ps2(const float sums[RHO_BODY_SUMS])
{
    const float far_m2 = sums[RHO_AT(BODY_FAR, BODY_FAR)],
                side_m2 = sums[RHO_AT(BODY_SIDE, BODY_SIDE)];
    const float cross_m2 = sums[RHO_AT(BODY_SIDE, BODY_FAR)];
    const float far = sums[RHO_AT(BODY_RATE, BODY_FAR)], side = sums[RHO_AT(BODY_RATE, BODY_SIDE)];
    const float det = far_m2 * side_m2 - cross_m2 * cross_m2;
    return det > PLANE_SHARE * far_m2 * side_m2
               ? (side_m2 * far * far - 2.0f * cross_m2 * far * side + far_m2 * side * side) / det
               : 0.0f;
}

float rho_bodies_limbs_m2ps2(const struct rho_body_filter *body)
{
    const float *sums = body->doubt.sums;
    const float left = sums[RHO_AT(BODY_RATE, BODY_RATE)] - explained_m2ps2(sums) -
                       sums[BODY_RATE_NOISE] - sums[BODY_RATE_UNKNOWN];
    return rho_larger(left, 0.0f) / (sums[BODY_PLOTS_BEYOND_ONE] + 1.0f);
}

/*
 * Where a plane explains more of the range rates than noise, an unseen turn and errors of the
 * velocity and of azimuths do, the plots are of two targets. Wheels and other moving parts raise
 * the noise, which is taken from the residuals.
 */
enum rho_body_split rho_bodies_split_reason(const struct rho_tracker *tracker, unsigned row)
{
    const struct rho_body_filter *body = &tracker->bodies.of[row];
    const struct rho_body_doubt *doubt = &body->doubt;
    if (doubt->long_looks > LONG_LOOKS && doubt->long_looks > LONG_SHARE * doubt->looks) {
        return RHO_BODY_TOO_LONG;
    }
    if (doubt->steady_looks < SETTLED_LOOKS) {
        return RHO_BODY_ONE;
    }
    const float *sums = doubt->sums;
    const float explained = explained_m2ps2(sums);
    const float rate_noise = sums[BODY_RATE_NOISE], side_noise_m2 = sums[BODY_SIDE_NOISE];
    const float noise = rho_larger(rate_noise, sums[RHO_AT(BODY_RATE, BODY_RATE)] - explained);
    const float turn_radps =
        UNSEEN_TURN_SHARE * heading_tolerance_rad(body) / (doubt->time_s + 1e-6f);
    const float side_m2 =
        rho_larger(sums[RHO_AT(BODY_SIDE, BODY_SIDE)] - side_noise_m2, SIDE_SHARE * side_noise_m2);
    const int moves_apart = explained * sums[BODY_PLOTS_BEYOND_ONE] > APART_CHI2 * noise &&
                            explained > rate_noise &&
                            explained > turn_radps * turn_radps * side_m2 +
                                            LOOSE_SIGMAS * LOOSE_SIGMAS * sums[BODY_RATE_UNKNOWN];
    return moves_apart ? RHO_BODY_MOVES_APART : RHO_BODY_ONE;
}
