/* SPDX-License-Identifier: MIT */
/*
 * body_doubt: whether the plots of a body are those of two targets.
 *
 * Looks of several plots are compared with what one rigid body can show. It is no longer than the
 * longest. And as long as it keeps its heading, its range rates are no plane over it that is
 * steeper than a turn explains. Two cars in neighbouring lanes, one faster than the other, show
 * that within a few seconds, long before they are seen apart; two of one lane that were never
 * farther apart than a truck is long show their length.
 */
#include "../tracker/step.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/body_filter.h"

/* Looks that count. */
#define MEMORY_LOOKS 80.0f
/* So many of them, and this share, are longer than the longest body by so many sigmas of a plot:
 * more than stray plots are. */
#define LONG_LOOKS 4.0f
#define LONG_SHARE 0.1f
#define LONG_SIGMAS 4.0f
/*
 * A heading keeps within this, and a sigma of it, of its mean; else range rates begin anew: parts
 * of a body that turns have others.
 */
#define STEADY_RAD 0.1f
/* A heading that keeps within that may have turned by so many times as much. */
#define TURN_SHARE 2.0f
/* ... and shows within so many looks that it turns. */
#define STEADY_LOOKS 30.0f
/* The square of so many sigmas of a velocity across the line of sight, which turns range rates. */
#define UNKNOWN_SHARE 4.0f
/* A chi-square of two dimensions: looks are many, and their errors not independent. */
#define APART_CHI2 40.0f
/* Squares of places across the line of sight are known to this share of their noise. */
#define SIDE_SHARE 0.2f
/* Places are no line: 1 less the square of their correlation. */
#define PLANE_SHARE 0.1f

static float steady_rad(const struct rho_body_filter *body)
{
    return STEADY_RAD + body->heading_sigma_rad;
}

static void forget_rates(struct rho_body_doubt *doubt, const struct rho_body_filter *body)
{
    *doubt = (struct rho_body_doubt){.looks = doubt->looks,
                                     .long_looks = doubt->long_looks,
                                     .cos_heading = body->cos_heading,
                                     .sin_heading = body->sin_heading,
                                     .time_us = doubt->time_us,
                                     .doubled = doubt->doubled,
                                     .doubled_us = doubt->doubled_us};
}

/* By the time and the look that have gone by. */
static void fade(struct rho_body_doubt *doubt, const struct rho_body_filter *body, float passed_s)
{
    const float share = 1.0f - 1.0f / MEMORY_LOOKS;
    doubt->looks = share * doubt->looks + 1.0f;
    doubt->long_looks *= share;
    const float turned_rad = rho_angle_difference(rho_atan2(doubt->sin_heading, doubt->cos_heading),
                                                  rho_atan2(body->sin_heading, body->cos_heading));
    if (doubt->plots_beyond_one <= 0.0f || turned_rad > steady_rad(body) ||
        turned_rad < -steady_rad(body)) {
        forget_rates(doubt, body);
        return;
    }
    doubt->steady_looks *= share;
    doubt->time_s = share * doubt->time_s + passed_s;
    doubt->cos_heading += (1.0f - share) * (body->cos_heading - doubt->cos_heading);
    doubt->sin_heading += (1.0f - share) * (body->sin_heading - doubt->sin_heading);
    doubt->plots_beyond_one *= share;
    doubt->far_m2 *= share;
    doubt->side_m2 *= share;
    doubt->cross_m2 *= share;
    doubt->rates_m2ps2 *= share;
    doubt->side_noise_m2 *= share;
    doubt->far_m2ps *= share;
    doubt->side_m2ps *= share;
    doubt->rate_noise_m2ps2 *= share;
    doubt->unknown_m2ps2 *= share;
}

/* Sums over a look's plots: places along the line of sight and across, and range rates. */
struct sums {
    float n, far, side, rate, far2, cross, side2, rate2, rate_far, rate_side;
    float side_noise_m2, rate_noise_m2ps2;
    float first_m, last_m, noise_m2; /* along the body */
};

static struct sums sums_of(const struct step *step, const struct rho_scan *scan, unsigned row)
{
    const struct rho_bodies *bodies = &step->tracker->bodies;
    struct sums sums = {.first_m = 1e9f, .last_m = -1e9f};
    const struct rho_groups *groups = &bodies->groups;
    struct body_plot at;
    float axes[3];
    for (unsigned i =
             rho_tracker_uncontested(groups, groups->first[step->tracker->tracks[row].plot]);
         i != RHO_NO_ROW; i = rho_tracker_uncontested(groups, groups->next[i])) {
        const struct rho_plot *plot = &scan->plots[i];
        if (!rho_tracker_place_on_body(step, scan, row, i, &at) &&
            (scan->measures & RHO_MEASURES_RANGE_RATE)) {
            continue; /* at the sensor */
        }
        rho_tracker_noise_on_body(step, &bodies->of[row], plot, axes);
        const float far_m = at.line[0] * at.dx_m + at.line[1] * at.dy_m,
                    side_m = at.line[0] * at.dy_m - at.line[1] * at.dx_m;
        sums.n += 1.0f;
        sums.far += far_m;
        sums.side += side_m;
        sums.rate += at.rate_mps;
        sums.far2 += far_m * far_m;
        sums.cross += far_m * side_m;
        sums.side2 += side_m * side_m;
        sums.rate2 += at.rate_mps * at.rate_mps;
        sums.rate_far += at.rate_mps * far_m;
        sums.rate_side += at.rate_mps * side_m;
        sums.side_noise_m2 += plot->sigma_cross_m * plot->sigma_cross_m;
        sums.rate_noise_m2ps2 += plot->sigma_range_rate_mps * plot->sigma_range_rate_mps;
        sums.first_m = rho_smaller(sums.first_m, at.along_m);
        sums.last_m = rho_larger(sums.last_m, at.along_m);
        sums.noise_m2 = rho_larger(sums.noise_m2, axes[0]);
    }
    return sums;
}

/* An error of the velocity across the line of sight turns what range rates show. */
static float seen_turn_radps(const struct step *step, const struct rho_track *track)
{
    const float x_m = track->kalman.state[RHO_X] - (step->sensor ? step->sensor->x_m : 0.0f),
                y_m = track->kalman.state[RHO_Y] - (step->sensor ? step->sensor->y_m : 0.0f);
    return rho_track_sigma_mps(track) / (rho_sqrt(x_m * x_m + y_m * y_m) + 1.0f);
}

static int is_longer(const struct step *step, const struct sums *sums)
{
    return sums->last_m - sums->first_m >
           step->tracker->bodies.length_max_m + LONG_SIGMAS * rho_sqrt(sums->noise_m2);
}

void rho_tracker_doubt_body(const struct step *step, const struct rho_scan *scan, unsigned row)
{
    struct rho_body_filter *body = &step->tracker->bodies.of[row];
    struct rho_body_doubt *doubt = &body->doubt;
    const struct sums sums = sums_of(step, scan, row);
    const float passed_s =
        doubt->looks > 0.0f ? rho_seconds_between(doubt->time_us, step->time_us) : 0.0f;
    if (sums.n < 2.0f || !body->has_heading) {
        return;
    }
    const float mean = 1.0f / sums.n;
    doubt->time_us = step->time_us;
    fade(doubt, body, passed_s);
    doubt->long_looks += is_longer(step, &sums) ? 1.0f : 0.0f;
    if (!(step->scan->measures & RHO_MEASURES_RANGE_RATE) || body->plots < RHO_BODY_NEW_PLOTS) {
        return; /* a new track's velocity is not known well enough */
    }
    doubt->steady_looks += 1.0f;
    doubt->plots_beyond_one += sums.n - 1.0f;
    doubt->far_m2 += sums.far2 - mean * sums.far * sums.far;
    const float side_m2 = sums.side2 - mean * sums.side * sums.side;
    const float turned_radps = seen_turn_radps(step, &step->tracker->tracks[row]);
    doubt->side_m2 += side_m2;
    doubt->unknown_m2ps2 += turned_radps * turned_radps * side_m2;
    doubt->side_noise_m2 += (1.0f - mean) * sums.side_noise_m2;
    doubt->cross_m2 += sums.cross - mean * sums.far * sums.side;
    doubt->rates_m2ps2 += sums.rate2 - mean * sums.rate * sums.rate;
    doubt->far_m2ps += sums.rate_far - mean * sums.rate * sums.far;
    doubt->side_m2ps += sums.rate_side - mean * sums.rate * sums.side;
    doubt->rate_noise_m2ps2 += (1.0f - mean) * sums.rate_noise_m2ps2;
}

/*
 * Range rates as a plane over the body, by least squares. What it explains is noise, or is a turn
 * of as much as the heading may have turned unseen, or the body is no body. Wheels and other parts
 * that move in themselves make all range rates wider.
 */
static int parts_move_apart(const struct rho_body_filter *body)
{
    const struct rho_body_doubt *doubt = &body->doubt;
    const float det = doubt->far_m2 * doubt->side_m2 - doubt->cross_m2 * doubt->cross_m2;
    if (doubt->steady_looks < STEADY_LOOKS ||
        !(det > PLANE_SHARE * doubt->far_m2 * doubt->side_m2)) {
        return 0;
    }
    const float far = doubt->far_m2ps, side = doubt->side_m2ps;
    const float explained = (doubt->side_m2 * far * far - 2.0f * doubt->cross_m2 * far * side +
                             doubt->far_m2 * side * side) /
                            det;
    const float noise = rho_larger(doubt->rate_noise_m2ps2, doubt->rates_m2ps2 - explained);
    const float turn_radps = TURN_SHARE * steady_rad(body) / (doubt->time_s + 1e-6f);
    const float side_m2 =
        rho_larger(doubt->side_m2 - doubt->side_noise_m2, SIDE_SHARE * doubt->side_noise_m2);
    return explained * doubt->plots_beyond_one > APART_CHI2 * noise &&
           explained > doubt->rate_noise_m2ps2 &&
           explained > turn_radps * turn_radps * side_m2 + UNKNOWN_SHARE * doubt->unknown_m2ps2;
}

enum rho_body_split rho_tracker_why_two(const struct step *step, unsigned row)
{
    const struct rho_body_doubt *doubt = &step->tracker->bodies.of[row].doubt;
    if (doubt->long_looks > LONG_LOOKS && doubt->long_looks > LONG_SHARE * doubt->looks) {
        return RHO_BODY_TOO_LONG;
    }
    return parts_move_apart(&step->tracker->bodies.of[row]) ? RHO_BODY_MOVES_APART : RHO_BODY_ONE;
}
