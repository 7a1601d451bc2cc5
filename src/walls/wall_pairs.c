/* SPDX-License-Identifier: MIT */
/*
 * wall_pairs: finds pairs of tracks that move as a target and its image in a wall.
 * The line half way between the two may be the wall.
 */
#include <string.h>

#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "wall_line.h"

/*
 * True where two tracks may be a target and its image: beside each other, equally fast along the
 * line whose direction their velocities give, sensor and target on one side of it and the image on
 * the other. Fills the line half way between the two, which is the wall if they are, and the place
 * where the line of sight to the image crosses it.
 */
static int may_be_image_pair(const struct rho_sensor *sensor, const struct rho_track_report *target,
                             const struct rho_track_report *image,
                             struct rho_learned_reflector *line, float crossing_m[2])
{
    const float *t = target->state, *g = image->state;
    const float dx_m = g[RHO_X] - t[RHO_X], dy_m = g[RHO_Y] - t[RHO_Y];
    const float vx_mps = 0.5f * (g[RHO_VX] + t[RHO_VX]), vy_mps = 0.5f * (g[RHO_VY] + t[RHO_VY]);
    const float speed_mps = rho_sqrt(vx_mps * vx_mps + vy_mps * vy_mps);
    const float apart_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    const float sigma_m2 = target->sigma_m * target->sigma_m + image->sigma_m * image->sigma_m;
    if (!(speed_mps > 0.0f) || apart_m * apart_m < APART_SIGMAS * APART_SIGMAS * sigma_m2) {
        return 0;
    }
    const float c = vx_mps / speed_mps, s = vy_mps / speed_mps;
    const float across_mps2 = variance_along(target->covariance, RHO_VX, -s, c) +
                              variance_along(image->covariance, RHO_VX, -s, c);
    const float along_mps2 = variance_along(target->covariance, RHO_VX, c, s) +
                             variance_along(image->covariance, RHO_VX, c, s);
    const float turned = 0.25f * across_mps2 / (speed_mps * speed_mps);
    const float along_m2 = variance_along(target->covariance, RHO_X, c, s) +
                           variance_along(image->covariance, RHO_X, c, s) +
                           turned * apart_m * apart_m;
    const float off_m = dx_m * c + dy_m * s;
    const float off_mps = (g[RHO_VX] - t[RHO_VX]) * c + (g[RHO_VY] - t[RHO_VY]) * s;
    if (turned * SPEED_SIGMAS * SPEED_SIGMAS > 1.0f || !(along_m2 > 0.0f) || !(along_mps2 > 0.0f) ||
        off_m * off_m / along_m2 + off_mps * off_mps / along_mps2 > PAIR_CHI2) {
        return 0;
    }
    memset(line, 0, sizeof *line);
    line->x_m = 0.5f * (t[RHO_X] + g[RHO_X]);
    line->y_m = 0.5f * (t[RHO_Y] + g[RHO_Y]);
    line->cos_along = c;
    line->sin_along = s;
    line->variance[0] = 0.25f * (variance_along(target->covariance, RHO_X, -s, c) +
                                 variance_along(image->covariance, RHO_X, -s, c));
    line->variance[2] = turned;
    line->pairs = 1.0f;
    line->sigma_m = target->sigma_m;
    line->is_taken = 1;
    const float x_m = sensor ? sensor->x_m : 0.0f, y_m = sensor ? sensor->y_m : 0.0f;
    float along_m;
    const float sensor_m = off_line_m(line, x_m, y_m, &along_m);
    const float target_m = off_line_m(line, t[RHO_X], t[RHO_Y], &along_m);
    const float image_m = off_line_m(line, g[RHO_X], g[RHO_Y], &along_m);
    if (!(sensor_m * target_m > 0.0f) || !(sensor_m * image_m < 0.0f)) {
        return 0;
    }
    const float part = sensor_m / (sensor_m - image_m);
    crossing_m[0] = x_m + part * (g[RHO_X] - x_m);
    crossing_m[1] = y_m + part * (g[RHO_Y] - y_m);
    return 1;
}

/*
 * True where the line that a pair of tracks gives agrees with a learned line, in place and
 * direction.
 */
static int does_pair_fit_line(const struct rho_learned_reflector *line,
                              const struct rho_learned_reflector *pair)
{
    float along_m;
    const float off_m = off_line_m(line, pair->x_m, pair->y_m, &along_m);
    const float limit_m2 = line_variance_at(line, along_m) + pair->variance[0];
    /* tracks may move either way along the line: the sign of the cosine does not matter */
    const float cosine = pair->cos_along * line->cos_along + pair->sin_along * line->sin_along;
    const float sine = pair->sin_along * line->cos_along - pair->cos_along * line->sin_along;
    const float turned = cosine > 0.0f ? sine - line->slope : -sine - line->slope;
    return off_m * off_m <= ERROR_SIGMAS * ERROR_SIGMAS * limit_m2 &&
           turned * turned <= ERROR_SIGMAS * ERROR_SIGMAS * (pair->variance[2] + line->variance[2]);
}

/*
 * Refines the learned line on which a pair of tracks lies. Where there is none, the pair takes a
 * count off the unused line with the fewest pairs, and replaces that line once its count is spent.
 */
static void learn_line(struct rho_reflector_learning *learning,
                       const struct rho_learned_reflector *pair, const float crossing_m[2])
{
    struct rho_learned_reflector *least = 0;
    float along_m, across_m;
    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        struct rho_learned_reflector *line = &learning->lines[i];
        if (line->is_taken && does_pair_fit_line(line, pair)) {
            to_line_frame(line, pair->x_m, pair->y_m, &along_m, &across_m);
            refine_line(line, along_m, across_m, (float)ALIKE_LOOKS * pair->variance[0]);
            to_line_frame(line, crossing_m[0], crossing_m[1], &along_m, &across_m);
            lengthen_line_to(line, along_m);
            line->pairs += 1.0f;
            return;
        }
        if (!line->is_used && (!least || line->pairs < least->pairs)) {
            least = line;
        }
    }
    if (!least) {
        return;
    }
    least->pairs -= 1.0f;
    if (least->pairs < 0.0f) {
        memcpy(least, pair, sizeof *least); /* with its padding, which a snapshot has, too */
        to_line_frame(least, crossing_m[0], crossing_m[1], &least->from_m, &across_m);
        least->to_m = least->from_m;
    }
}

void rho_reflector_learning_pairs(struct rho_reflector_learning *learning,
                                  const struct rho_sensor *sensor, const struct rho_scan *scan,
                                  const struct rho_report *report)
{
    const uint32_t num_tracks = report->num_tracks, all = num_tracks * num_tracks;
    struct rho_learned_reflector pair_line;
    float crossing_m[2];
    for (uint32_t i = 0; i < PAIRS_MAX && i < all; i++) {
        const uint32_t pair = learning->next_pair < all ? learning->next_pair : 0;
        const struct rho_track_report *target = &report->tracks[pair / num_tracks],
                                      *image = &report->tracks[pair % num_tracks];
        learning->next_pair = pair + 1u;
        if (target != image && may_have_image(target, scan) && image->plot >= 0 &&
            image->hits >= IMAGE_HITS &&
            may_be_image_pair(sensor, target, image, &pair_line, crossing_m)) {
            learn_line(learning, &pair_line, crossing_m);
        }
    }
}
