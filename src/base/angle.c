/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/angle.h"

#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/types.h"

/* Tolerance of comparisons: float32's rounding of an angle that was reduced to one turn. */
#define SECTOR_ROUNDING_RAD 1.0e-6f

/* Counter-clockwise angle from one direction to another, in [0, 2 pi). */
static float ccw_arc_rad(float from_rad, float to_rad)
{
    const float difference = rho_angle_difference(to_rad, from_rad);
    return difference < 0.0f ? difference + RHO_TWO_PI : difference;
}

float rho_angle_wrap(float angle_rad)
{
    if (angle_rad >= -RHO_PI && angle_rad < RHO_PI) {
        return angle_rad;
    }
    if (!(angle_rad >= -RHO_ANGLE_MAX_RAD && angle_rad <= RHO_ANGLE_MAX_RAD)) {
        return rho_log(-1.0f); /* the result is NaN */
    }
    const float turns = angle_rad * 0.159154943f; /* 1 / (2 pi) */
    const int32_t whole = (int32_t)(turns + (angle_rad < 0.0f ? -0.5f : 0.5f));
    const float wrapped = rho_minus_quarters(angle_rad, 4.0f * (float)whole);
    /* The count of turns is rounded: two of all floats end one digit outside of [-pi, pi). */
    return wrapped >= -RHO_PI && wrapped < RHO_PI ? wrapped : -RHO_PI;
}

/* Wrapped before they are subtracted: their difference may exceed a limit, or lose digits. */
float rho_angle_difference(float a_rad, float b_rad)
{
    return rho_angle_wrap(rho_angle_wrap(a_rad) - rho_angle_wrap(b_rad));
}

int rho_angle_is_valid_sector(float from_rad, float to_rad)
{
    return rho_is_within(from_rad, -RHO_TWO_PI, RHO_TWO_PI) &&
           rho_is_within(to_rad, -RHO_TWO_PI, RHO_TWO_PI);
}

float rho_angle_sector_width(float from_rad, float to_rad)
{
    const float width = ccw_arc_rad(from_rad, to_rad);
    return width <= SECTOR_ROUNDING_RAD ? RHO_TWO_PI : width;
}

/*
 * An overlap of two sectors makes the gap between them almost a full turn. One within the tolerance
 * sets the gap to 0; returns 0 for a larger overlap.
 */
static int zero_gap(float *gap_rad, float free_rad, float tolerance_rad)
{
    if (*gap_rad > free_rad + 2.0f * tolerance_rad) {
        if (RHO_TWO_PI - *gap_rad > tolerance_rad) {
            return 0;
        }
        *gap_rad = 0.0f;
    }
    return 1;
}

unsigned rho_angle_continued_ends(float from_rad, float to_rad, float next_from_rad,
                                  float next_to_rad, float gap_max_rad)
{
    const float width_rad = rho_angle_sector_width(from_rad, to_rad);
    const float next_rad = rho_angle_sector_width(next_from_rad, next_to_rad);
    const float narrower_rad = width_rad < next_rad ? width_rad : next_rad;
    const float tolerance_rad =
        0.25f * narrower_rad < END_TOLERANCE_RAD ? 0.25f * narrower_rad : END_TOLERANCE_RAD;
    const float free_rad = RHO_TWO_PI - width_rad - next_rad;
    float left_rad = ccw_arc_rad(to_rad, next_from_rad);
    float right_rad = ccw_arc_rad(next_to_rad, from_rad);
    if (!(free_rad >= -tolerance_rad) || !zero_gap(&left_rad, free_rad, tolerance_rad) ||
        !zero_gap(&right_rad, free_rad, tolerance_rad)) {
        return 0;
    }
    if (left_rad <= tolerance_rad && right_rad <= tolerance_rad) {
        return RHO_ANGLE_CONTINUES_LEFT | RHO_ANGLE_CONTINUES_RIGHT;
    }
    if (left_rad < right_rad) {
        return left_rad <= gap_max_rad + tolerance_rad ? RHO_ANGLE_CONTINUES_LEFT : 0u;
    }
    return right_rad <= gap_max_rad + tolerance_rad ? RHO_ANGLE_CONTINUES_RIGHT : 0u;
}

int rho_angle_in_sector(float angle_rad, float from_rad, float to_rad)
{
    const float width = ccw_arc_rad(from_rad, to_rad);
    const float way = ccw_arc_rad(from_rad, angle_rad);
    if (!(width >= 0.0f && way >= 0.0f)) {
        return 0;
    }
    return width <= SECTOR_ROUNDING_RAD || way <= width + SECTOR_ROUNDING_RAD ||
           way >= RHO_TWO_PI - SECTOR_ROUNDING_RAD;
}

/*
 * rho is the point's component along the normal (-dy, dx): by way of sin(theta) and cos(theta) it
 * would be off by half a metre at 2000 km. The direction is scaled first so that its squares can
 * neither overflow nor vanish.
 */
struct rho_line rho_angle_line(float x_m, float y_m, float dx, float dy)
{
    const float longer = rho_larger(rho_magnitude(dx), rho_magnitude(dy));
    const float ux = dx / longer;
    const float uy = dy / longer;
    const float rho_m = (y_m * ux - x_m * uy) / rho_sqrt(ux * ux + uy * uy);
    const float theta_rad = rho_atan2(ux, -uy);
    struct rho_line line = {.rho_m = rho_m, .theta_rad = theta_rad};
    if (line.theta_rad < 0.0f) {
        line.theta_rad += RHO_PI;
        line.rho_m = -line.rho_m;
    }
    if (line.theta_rad >= RHO_PI) {
        line.theta_rad = 0.0f;
        line.rho_m = -line.rho_m;
    }
    return line;
}

int32_t rho_angle_clamped_theta_cell(float theta_rad, int32_t num_cells)
{
    const float cell = theta_rad * ((float)num_cells / RHO_PI);
    if (!(num_cells > 0 && cell > 0.0f)) {
        return 0;
    }
    return cell >= (float)num_cells ? num_cells - 1 : (int32_t)cell;
}
