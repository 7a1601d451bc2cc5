/* SPDX-License-Identifier: MIT */
/*
 * angle: angles on the circle, and lines as points (rho, theta).
 *
 * Constant cost, stack 80 bytes at most. |angle| <= 100 rad (16 turns) is accepted; NaN beyond.
 */
#ifndef RHOTRACK_ANGLE_H
#define RHOTRACK_ANGLE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A line of the plane: rho_m = x cos(theta_rad) + y sin(theta_rad), rho signed, 0 <= theta < pi. */
struct rho_line {
    float rho_m;
    float theta_rad;
};

/* Wraps an angle into -pi <= angle < pi. */
float rho_angle_wrap(float angle_rad);

/* a - b by the shorter way, in -pi <= difference < pi. */
float rho_angle_difference(float a_rad, float b_rad);

/* True where the ends of a sector are equal: it is the whole circle. */
static inline int rho_angle_is_circle(float from_rad, float to_rad)
{
    return from_rad <= to_rad && from_rad >= to_rad;
}

/* Width of a sector, above 0 and up to 2 pi. NaN where an end is NaN. */
float rho_angle_sector_width(float from_rad, float to_rad);

/*
 * The end of a sector that the next sector continues: the nearer one, if the gap is gap_max_rad or
 * less; both ends, or-ed, where the next sector closes the circle. 0 where the gap is larger, the
 * sectors overlap, or one of them is the whole circle. Ends within 1 mrad, or a quarter of the
 * narrower sector, count as equal. LEFT: the next sector follows counter-clockwise, from the end
 * `to`; RIGHT: it follows clockwise, from the end `from`.
 */
#define RHO_ANGLE_CONTINUES_LEFT 1u
#define RHO_ANGLE_CONTINUES_RIGHT 2u
unsigned rho_angle_continued_ends(float from_rad, float to_rad, float next_from_rad,
                                  float next_to_rad, float gap_max_rad);

/*
 * True (1) where the direction lies in the sector that runs counter-clockwise from .. to, ends
 * included; equal ends are the whole circle. The tolerance is 1e-6 rad, so that -pi .. pi and 0 ..
 * 2 pi are the whole circle, too. False for NaN.
 */
int rho_angle_in_sector(float angle_rad, float from_rad, float to_rad);

/* True where both ends of a sector are finite and within -2 pi .. 2 pi. */
int rho_angle_is_valid_sector(float from_rad, float to_rad);

/*
 * The line through (x_m, y_m) along (dx, dy), which is not (0, 0) but finite (else NaN); theta =
 * atan2(dx, -dy) brought into [0, pi), rho signed to match (Fan et al., "Neutrosophic Hough
 * Transform-Based Track Initiation Method ...", eqs. (9), (10), corrected: taken literally theta
 * falls outside [0, pi), and rho loses its sign, which merges mirror lines).
 */
struct rho_line rho_angle_line(float x_m, float y_m, float dx, float dy);

/* Index of one of num_cells equal cells over [0, pi), the nearest; 0 for NaN or num_cells < 1. */
int32_t rho_angle_clamped_theta_cell(float theta_rad, int32_t num_cells);

#ifdef __cplusplus
}
#endif

#endif
