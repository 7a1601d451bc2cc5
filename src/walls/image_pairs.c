/* SPDX-License-Identifier: MIT */
/*
 * image_pairs: two tracks that move as a target and its image say where a wall may be.
 */
#include <string.h>

#include "learned_line.h"
#include "rhotrack/detail/approx.h"

/* Pairs of tracks compared in a step, at most. */
#define PAIRS_MAX 256u

#define IMAGE_HITS 5   /* of one that may be an image */
#define PAIR_CHI2 9.2f /* 99 % in two dimensions: beside each other, at one speed along the line */
#define APART_SIGMAS 6.0f /* between a target and its image */
#define SPEED_SIGMAS 5.0f /* along the line, which has its direction from it */
#define LINE_SIGMAS 3.0f  /* off a line that is known, and off its direction */

/* What two tracks say of a line half way between them. */
struct between {
    float x_m, y_m, cos_along, sin_along;
    float variance_m2, slope_variance; /* across the line; of its direction */
    float crossing_x_m, crossing_y_m;  /* of the line of sight to the image */
    float sigma_m;                     /* of the target's place */
};

/* The line of sight to the image crosses the line, which the target is before. */
static int is_behind(const struct rho_sensor *sensor, const struct rho_track_report *target,
                     const struct rho_track_report *image, struct between *between)
{
    const float x_m = sensor ? sensor->x_m : 0.0f, y_m = sensor ? sensor->y_m : 0.0f;
    const float c = between->cos_along, s = between->sin_along;
    const float sensor_m = (y_m - between->y_m) * c - (x_m - between->x_m) * s;
    const float target_m =
        (target->state[RHO_Y] - between->y_m) * c - (target->state[RHO_X] - between->x_m) * s;
    const float image_m =
        (image->state[RHO_Y] - between->y_m) * c - (image->state[RHO_X] - between->x_m) * s;
    if (!(sensor_m * target_m > 0.0f) || !(sensor_m * image_m < 0.0f)) {
        return 0;
    }
    const float part = sensor_m / (sensor_m - image_m);
    between->crossing_x_m = x_m + part * (image->state[RHO_X] - x_m);
    between->crossing_y_m = y_m + part * (image->state[RHO_Y] - y_m);
    return 1;
}

/* Target and image are beside each other, and as fast along the line, which has its direction from
 * their velocities. */
static int may_be_image(const struct rho_sensor *sensor, const struct rho_track_report *target,
                        const struct rho_track_report *image, struct between *between)
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
    between->x_m = 0.5f * (t[RHO_X] + g[RHO_X]);
    between->y_m = 0.5f * (t[RHO_Y] + g[RHO_Y]);
    between->cos_along = c;
    between->sin_along = s;
    between->variance_m2 = 0.25f * (variance_along(target->covariance, RHO_X, -s, c) +
                                    variance_along(image->covariance, RHO_X, -s, c));
    between->slope_variance = turned;
    between->sigma_m = target->sigma_m;
    return is_behind(sensor, target, image, between);
}

/* The line goes through the place, in the direction that two tracks say. */
static int is_on_line(const struct rho_learned_reflector *line, const struct between *between)
{
    float along_m;
    const float off_m = off_line_m(line, between->x_m, between->y_m, &along_m);
    const float limit_m2 = variance_at(line, along_m) + between->variance_m2;
    /* either way along: the sign of the cosine does not matter */
    const float cosine =
        between->cos_along * line->cos_along + between->sin_along * line->sin_along;
    const float sine = between->sin_along * line->cos_along - between->cos_along * line->sin_along;
    const float turned = cosine > 0.0f ? sine - line->slope : -sine - line->slope;
    return off_m * off_m <= LINE_SIGMAS * LINE_SIGMAS * limit_m2 &&
           turned * turned <=
               LINE_SIGMAS * LINE_SIGMAS * (between->slope_variance + line->variance[2]);
}

static void begin_line(struct rho_learned_reflector *line, const struct between *between)
{
    float across_m;
    memset(line, 0, sizeof *line);
    line->x_m = between->x_m;
    line->y_m = between->y_m;
    line->cos_along = between->cos_along;
    line->sin_along = between->sin_along;
    line->variance[0] = between->variance_m2;
    line->variance[2] = between->slope_variance;
    line->pairs = 1.0f;
    line->sigma_m = between->sigma_m;
    line->is_taken = 1;
    to_frame(line, between->crossing_x_m, between->crossing_y_m, &line->from_m, &across_m);
    line->to_m = line->from_m;
}

/* The line that two tracks are on, or a new one: of those that are only observed, that with the
 * fewest pairs makes room, once others have come as often. */
static void note_pair(struct rho_reflector_learning *learning, const struct between *between)
{
    struct rho_learned_reflector *least = 0;
    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        struct rho_learned_reflector *line = &learning->lines[i];
        if (line->is_taken && is_on_line(line, between)) {
            float along_m, across_m;
            to_frame(line, between->x_m, between->y_m, &along_m, &across_m);
            refine_line(line, along_m, across_m, REPEATED * between->variance_m2);
            to_frame(line, between->crossing_x_m, between->crossing_y_m, &along_m, &across_m);
            lengthen_line_to(line, along_m);
            line->pairs += 1.0f;
            return;
        }
        if (!line->is_used && (!least || line->pairs < least->pairs)) {
            least = line;
        }
    }
    if (least) {
        least->pairs -= 1.0f;
        if (least->pairs < 0.0f) {
            begin_line(least, between);
        }
    }
}

void rho_reflector_learning_note_pairs(struct rho_reflector_learning *learning,
                                       const struct rho_sensor *sensor, const struct rho_scan *scan,
                                       const struct rho_report *report)
{
    const uint32_t num_tracks = report->num_tracks, all = num_tracks * num_tracks;
    struct between between;
    for (uint32_t i = 0; i < PAIRS_MAX && i < all; i++) {
        const uint32_t pair = learning->next_pair < all ? learning->next_pair : 0;
        const struct rho_track_report *target = &report->tracks[pair / num_tracks],
                                      *image = &report->tracks[pair % num_tracks];
        learning->next_pair = pair + 1u;
        if (target != image && is_target(target, scan) && image->plot >= 0 &&
            image->hits >= IMAGE_HITS && may_be_image(sensor, target, image, &between)) {
            note_pair(learning, &between);
        }
    }
}
