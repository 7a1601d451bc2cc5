/* SPDX-License-Identifier: MIT */
/*
 * wall_line: arithmetic of a line that may be a wall: places along and across
 * it, its uncertainty and its refinement. Private to src/walls.
 */
#ifndef RHOTRACK_WALL_LINE_H
#define RHOTRACK_WALL_LINE_H

#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/tracker.h"

static inline void to_line_frame(const struct rho_learned_reflector *line, float x_m, float y_m,
                                 float *along_m, float *across_m)
{
    const float dx_m = x_m - line->x_m, dy_m = y_m - line->y_m;
    *along_m = dx_m * line->cos_along + dy_m * line->sin_along;
    *across_m = dy_m * line->cos_along - dx_m * line->sin_along;
}

static inline float line_across_at(const struct rho_learned_reflector *line, float along_m)
{
    return line->offset_m + line->slope * along_m;
}

/*
 * Distance of a place from the line, across the line's frame. Sets *along_m to its place along the
 * frame.
 */
static inline float off_line_m(const struct rho_learned_reflector *line, float x_m, float y_m,
                               float *along_m)
{
    float across_m;
    to_line_frame(line, x_m, y_m, along_m, &across_m);
    return across_m - line_across_at(line, *along_m);
}

static inline float line_variance_at(const struct rho_learned_reflector *line, float along_m)
{
    const float *p = line->variance;
    return p[0] + along_m * (2.0f * p[1] + along_m * p[2]);
}

/*
 * Kalman update of a line's offset and slope with a place half way between a target and its image;
 * the place has no error along the line's frame.
 */
static inline void refine_line(struct rho_learned_reflector *line, float along_m, float across_m,
                               float variance_m2)
{
    float *p = line->variance;
    const float s = line_variance_at(line, along_m) + variance_m2;
    const float to_offset = p[0] + along_m * p[1], to_slope = p[1] + along_m * p[2];
    const float off_m = across_m - line_across_at(line, along_m);
    if (!(s > 0.0f)) {
        return;
    }
    line->offset_m += to_offset / s * off_m;
    line->slope += to_slope / s * off_m;
    p[0] -= to_offset * to_offset / s;
    p[1] -= to_offset * to_slope / s;
    p[2] -= to_slope * to_slope / s;
}

static inline void lengthen_line_to(struct rho_learned_reflector *line, float along_m)
{
    line->from_m = rho_smaller(along_m, line->from_m);
    line->to_m = rho_larger(along_m, line->to_m);
}

/*
 * True where a confirmed track with enough hits has a plot of this scan, so that its image may be
 * sought.
 */
static inline int may_have_image(const struct rho_track_report *track, const struct rho_scan *scan)
{
    return track->plot >= 0 && (uint32_t)track->plot < scan->num_plots &&
           track->status == RHO_TRACK_CONFIRMED && track->hits >= TARGET_HITS;
}

/*
 * Variance along a direction, from a covariance whose x and y have the indices first and first + 1.
 */
static inline float variance_along(const float *covariance, int first, float cos_along,
                                   float sin_along)
{
    return covariance[RHO_AT(first, first)] * cos_along * cos_along +
           2.0f * covariance[RHO_AT(first + 1, first)] * cos_along * sin_along +
           covariance[RHO_AT(first + 1, first + 1)] * sin_along * sin_along;
}

/*
 * Compares at most 256 pairs of tracks. Of pairs that move as a target and its image, the line half
 * way between them refines a learned line, or begins one (wall_pairs.c).
 *   sensor  of the scan; NULL: at the origin
 */
void rho_reflector_learning_pairs(struct rho_reflector_learning *learning,
                                  const struct rho_sensor *sensor, const struct rho_scan *scan,
                                  const struct rho_report *report);

#endif
