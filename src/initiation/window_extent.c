/* SPDX-License-Identifier: MIT */
/*
 * window_extent: rectangles of the plane, and the one that the plots lie in, where the area is not given.
 */
#include "window_extent.h"

/* Where the area is not given: plots farther out than so many standard deviations are left out, in so many rounds, once
 * there are a dozen; and what it was before gives way to what it is now by this share a scan. */
#define OUTLIER_SIGMAS2 9.0f
#define OUTLIER_ROUNDS 3
#define OUTLIER_PLOTS 12.0f
#define EXTENT_DECAY 0.02f

/* ---- extents ---------------------------------------------------------------------------------- */

static float at_least(float v, float limit)
{
    return v > limit ? v : limit;
}

float rho_extent_width_m(const struct rho_extent *extent, float side_min_m)
{
    return at_least(extent->x_max_m - extent->x_min_m, side_min_m);
}

float rho_extent_height_m(const struct rho_extent *extent, float side_min_m)
{
    return at_least(extent->y_max_m - extent->y_min_m, side_min_m);
}

float rho_extent_area_m2(const struct rho_extent *extent, float side_min_m)
{
    return at_least(rho_extent_width_m(extent, side_min_m), 0.0f) *
           at_least(rho_extent_height_m(extent, side_min_m), 0.0f);
}

void rho_extent_add(struct rho_extent *extent, float x_m, float y_m)
{
    if (!(extent->x_min_m <= extent->x_max_m)) {
        extent->x_min_m = extent->x_max_m = x_m;
        extent->y_min_m = extent->y_max_m = y_m;
        return;
    }
    extent->x_min_m = x_m < extent->x_min_m ? x_m : extent->x_min_m;
    extent->x_max_m = x_m > extent->x_max_m ? x_m : extent->x_max_m;
    extent->y_min_m = y_m < extent->y_min_m ? y_m : extent->y_min_m;
    extent->y_max_m = y_m > extent->y_max_m ? y_m : extent->y_max_m;
}

/* ---- the area that the plots show ------------------------------------------------------------- */

/* Plots within some standard deviations of a mean, one axis after the other. */
struct crowd {
    float plots, mean_m[2], sum2_m2[2]; /* of the last round: the others are outliers */
    struct rho_extent extent;
};

static int is_far(const struct crowd *crowd, float x_m, float y_m)
{
    float dx_m = x_m - crowd->mean_m[0], dy_m = y_m - crowd->mean_m[1];
    return crowd->plots >= OUTLIER_PLOTS &&
           (dx_m * dx_m * crowd->plots > OUTLIER_SIGMAS2 * crowd->sum2_m2[0] ||
            dy_m * dy_m * crowd->plots > OUTLIER_SIGMAS2 * crowd->sum2_m2[1]);
}

/* Welford's running mean and sum of squares. */
static void join(struct crowd *crowd, const struct crowd *before, float x_m, float y_m)
{
    const float place_m[2] = {x_m, y_m};
    if (is_far(before, x_m, y_m)) {
        return;
    }
    crowd->plots += 1.0f;
    for (int axis = 0; axis < 2; axis++) {
        float off_m = place_m[axis] - crowd->mean_m[axis];
        crowd->mean_m[axis] += off_m / crowd->plots;
        crowd->sum2_m2[axis] += off_m * (place_m[axis] - crowd->mean_m[axis]);
    }
    rho_extent_add(&crowd->extent, x_m, y_m);
}

static void join_all(struct crowd *crowd, const struct crowd *before, struct rho_window *window)
{
    *crowd = (struct crowd){.extent = {1.0f, 0.0f, 1.0f, 0.0f}};
    for (unsigned m = 0; m < window->num_scans; m++) {
        const struct rho_window_scan *held = rho_window_scan_at(window, m);
        for (unsigned i = 0; i < held->num_plots; i++) {
            join(crowd, before, held->plots[i].x_m, held->plots[i].y_m);
        }
    }
}

static float decayed(float was, float is, int is_wider)
{
    return is_wider ? is : was + EXTENT_DECAY * (is - was);
}

/* Outliers would make clutter look thin everywhere. */
void rho_window_follow_extent(struct rho_window *window)
{
    struct crowd crowd = {0}, before;
    for (int round = 0; round < OUTLIER_ROUNDS; round++) {
        before = crowd;
        join_all(&crowd, &before, window);
    }
    struct rho_extent *was = &window->extent, is = crowd.extent;
    if (crowd.plots < 1.0f) {
        return;
    }
    if (window->num_scans == 1) {
        *was = is;
    }
    was->x_min_m = decayed(was->x_min_m, is.x_min_m, is.x_min_m < was->x_min_m);
    was->x_max_m = decayed(was->x_max_m, is.x_max_m, is.x_max_m > was->x_max_m);
    was->y_min_m = decayed(was->y_min_m, is.y_min_m, is.y_min_m < was->y_min_m);
    was->y_max_m = decayed(was->y_max_m, is.y_max_m, is.y_max_m > was->y_max_m);
}
