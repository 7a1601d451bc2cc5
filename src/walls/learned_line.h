/* SPDX-License-Identifier: MIT */
/*
 * learned_line: a line that may be a wall, with its uncertainty. Private to src/walls.
 */
#ifndef RHOTRACK_LEARNED_LINE_H
#define RHOTRACK_LEARNED_LINE_H

#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/tracker.h"

#define TARGET_HITS 8 /* of a track that may have an image */
#define REPEATED 8.0f /* a target's errors stay for about so many looks */

static inline void to_frame(const struct rho_learned_reflector *line, float x_m, float y_m,
                            float *along_m, float *across_m)
{
    const float dx_m = x_m - line->x_m, dy_m = y_m - line->y_m;
    *along_m = dx_m * line->cos_along + dy_m * line->sin_along;
    *across_m = dy_m * line->cos_along - dx_m * line->sin_along;
}

static inline float across_at(const struct rho_learned_reflector *line, float along_m)
{
    return line->offset_m + line->slope * along_m;
}

/* How far a place is off the line, and where along it. */
static inline float off_line_m(const struct rho_learned_reflector *line, float x_m, float y_m,
                               float *along_m)
{
    float across_m;
    to_frame(line, x_m, y_m, along_m, &across_m);
    return across_m - across_at(line, *along_m);
}

static inline float variance_at(const struct rho_learned_reflector *line, float along_m)
{
    const float *p = line->variance;
    return p[0] + along_m * (2.0f * p[1] + along_m * p[2]);
}

/* A place half way between a target and its image; the line's frame has no error along it. */
static inline void refine_line(struct rho_learned_reflector *line, float along_m, float across_m,
                               float variance_m2)
{
    float *p = line->variance;
    const float s = variance_at(line, along_m) + variance_m2;
    const float to_offset = p[0] + along_m * p[1], to_slope = p[1] + along_m * p[2];
    const float off_m = across_m - across_at(line, along_m);
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

/* A target that has a plot of this scan, and may have an image. */
static inline int is_target(const struct rho_track_report *track, const struct rho_scan *scan)
{
    return track->plot >= 0 && (uint32_t)track->plot < scan->num_plots &&
           track->status == RHO_TRACK_CONFIRMED && track->hits >= TARGET_HITS;
}

/* Variance in a direction, of a covariance whose x and y are from `first` on. */
static inline float variance_along(const float *covariance, int first, float cos_along,
                                   float sin_along)
{
    return covariance[RHO_AT(first, first)] * cos_along * cos_along +
           2.0f * covariance[RHO_AT(first + 1, first)] * cos_along * sin_along +
           covariance[RHO_AT(first + 1, first + 1)] * sin_along * sin_along;
}

/*
 * Compares 256 pairs of tracks at most, and notes the lines half way between those that move as a
 * target and its image (image_pairs.c).
 *   sensor  of the scan; NULL: it is at the origin
 */
void rho_reflector_learning_note_pairs(struct rho_reflector_learning *learning,
                                       const struct rho_sensor *sensor, const struct rho_scan *scan,
                                       const struct rho_report *report);

#endif
