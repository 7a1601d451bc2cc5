/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/bearing_crossing.h"

#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"

enum rho_status rho_crossing_set_base(struct rho_crossing_base *base, float x_a_m, float y_a_m,
                                      float x_b_m, float y_b_m)
{
    if (!rho_is_coordinate(x_a_m) || !rho_is_coordinate(y_a_m) || !rho_is_coordinate(x_b_m) ||
        !rho_is_coordinate(y_b_m)) {
        return RHO_ERROR_VALUE;
    }
    float dx_m = x_b_m - x_a_m, dy_m = y_b_m - y_a_m;
    float length_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    if (!(length_m >= RHO_CROSSING_BASE_MIN_M)) {
        return RHO_ERROR_VALUE;
    }
    *base = (struct rho_crossing_base){.x_a_m = x_a_m,
                                       .y_a_m = y_a_m,
                                       .x_b_m = x_b_m,
                                       .y_b_m = y_b_m,
                                       .length_m = length_m,
                                       .direction_rad = rho_atan2(dy_m, dx_m)};
    return RHO_OK;
}

/* Angles of two bearings to the base; delta, of the bearings themselves, is exact where small. */
struct base_angles {
    float a_rad, b_rad; /* |beta_a| and |beta_b| */
    float delta_rad;
    int are_on_one_side;
};

static struct base_angles crossing_angles(const struct rho_crossing_base *base, float bearing_a_rad,
                                          float bearing_b_rad)
{
    float a_rad = rho_angle_difference(bearing_a_rad, base->direction_rad);
    float b_rad = rho_angle_difference(bearing_b_rad, base->direction_rad);
    float turn_rad = rho_angle_difference(bearing_b_rad, bearing_a_rad);
    return (struct base_angles){.a_rad = rho_magnitude(a_rad),
                                .b_rad = rho_magnitude(b_rad),
                                .delta_rad = a_rad + b_rad < 0.0f ? -turn_rad : turn_rad,
                                .are_on_one_side = !(a_rad * b_rad < 0.0f)};
}

/* B sin(beta): a sensor's distance from the other's ray, without the rounded base direction. */
static float ray_distance_m(const struct rho_crossing_base *base, float bearing_rad)
{
    float dx_m = base->x_b_m - base->x_a_m, dy_m = base->y_b_m - base->y_a_m;
    return rho_magnitude(dx_m * rho_sin(bearing_rad) - dy_m * rho_cos(bearing_rad));
}

float rho_crossing_angle_rad(const struct rho_crossing_base *base, float bearing_a_rad,
                             float bearing_b_rad)
{
    struct base_angles angles = crossing_angles(base, bearing_a_rad, bearing_b_rad);
    return angles.are_on_one_side ? angles.delta_rad : -RHO_PI;
}

enum rho_crossing_fate rho_crossing_find(const struct rho_crossing_base *base, float bearing_a_rad,
                                         float bearing_b_rad, float range_max_m,
                                         struct rho_crossing *crossing)
{
    struct base_angles angles = crossing_angles(base, bearing_a_rad, bearing_b_rad);
    if (!angles.are_on_one_side) {
        return RHO_CROSSING_SIDES;
    }
    if (!(angles.delta_rad > DELTA_MIN_RAD)) { /* true for NaN, too */
        return RHO_CROSSING_APART;
    }
    float sine = rho_sin(angles.delta_rad);
    float over_a_m = ray_distance_m(base, bearing_b_rad);
    float over_b_m = ray_distance_m(base, bearing_a_rad);
    if (!(over_a_m <= range_max_m * sine && over_b_m <= range_max_m * sine)) {
        return RHO_CROSSING_RANGE;
    }
    crossing->delta_rad = angles.delta_rad;
    crossing->range_a_m = over_a_m / sine;
    crossing->range_b_m = over_b_m / sine;
    /* from the nearer sensor: sin(delta)'s rounding is a share of the range, and moves it less */
    const int from_a = crossing->range_a_m <= crossing->range_b_m;
    const float bearing_rad = from_a ? bearing_a_rad : bearing_b_rad;
    const float range_m = from_a ? crossing->range_a_m : crossing->range_b_m;
    crossing->x_m = (from_a ? base->x_a_m : base->x_b_m) + range_m * rho_cos(bearing_rad);
    crossing->y_m = (from_a ? base->y_a_m : base->y_b_m) + range_m * rho_sin(bearing_rad);
    return RHO_CROSSING_MEETS;
}

void rho_crossing_covariance(const struct rho_crossing_ray *a, const struct rho_crossing_ray *b,
                             float covariance_m2[3])
{
    const float sine = a->cosine * b->sine - a->sine * b->cosine;
    /* a's bearing error moves the place along b's ray, and b's error along a's ray */
    const float along_b_m = a->range_m * a->sigma_rad / sine;
    const float along_a_m = b->range_m * b->sigma_rad / sine;
    const float ax_m = along_a_m * a->cosine, ay_m = along_a_m * a->sine;
    const float bx_m = along_b_m * b->cosine, by_m = along_b_m * b->sine;
    covariance_m2[0] = ax_m * ax_m + bx_m * bx_m;
    covariance_m2[1] = ax_m * ay_m + bx_m * by_m;
    covariance_m2[2] = ay_m * ay_m + by_m * by_m;
}
