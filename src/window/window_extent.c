/* SPDX-License-Identifier: MIT */
/* window_extent: rectangles of the plane; the window's extent, which follows the held plots. */
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/window.h"

float rho_extent_width_m(const struct rho_extent *extent, float side_min_m)
{
    return rho_larger(extent->x_max_m - extent->x_min_m, side_min_m);
}

float rho_extent_height_m(const struct rho_extent *extent, float side_min_m)
{
    return rho_larger(extent->y_max_m - extent->y_min_m, side_min_m);
}

float rho_extent_area_m2(const struct rho_extent *extent, float side_min_m)
{
    return rho_extent_width_m(extent, side_min_m) * rho_extent_height_m(extent, side_min_m);
}

void rho_extent_add(struct rho_extent *extent, float x_m, float y_m)
{
    if (!(extent->x_min_m <= extent->x_max_m)) {
        extent->x_min_m = extent->x_max_m = x_m;
        extent->y_min_m = extent->y_max_m = y_m;
        return;
    }
    extent->x_min_m = rho_smaller(x_m, extent->x_min_m);
    extent->x_max_m = rho_larger(x_m, extent->x_max_m);
    extent->y_min_m = rho_smaller(y_m, extent->y_min_m);
    extent->y_max_m = rho_larger(y_m, extent->y_max_m);
}

/* Mean, spread and extent of the held plots without outliers. */
struct plot_spread {
    /* number of plots; mean of x and y; sum of squares about the mean of x and y */
    float plots, mean_m[2], sum2_m2[2];
    struct rho_extent extent;
};

/* Adds a plot to mean and sum of squares (Welford), unless `before` makes it an outlier. */
static void add_plot(struct plot_spread *spread, const struct plot_spread *before, float x_m,
                     float y_m)
{
    const float place_m[2] = {x_m, y_m};
    const float dx_m = x_m - before->mean_m[0], dy_m = y_m - before->mean_m[1];
    if (before->plots >= OUTLIER_PLOTS &&
        (dx_m * dx_m * before->plots > OUTLIER_SIGMAS2 * before->sum2_m2[0] ||
         dy_m * dy_m * before->plots > OUTLIER_SIGMAS2 * before->sum2_m2[1])) {
        return;
    }
    spread->plots += 1.0f;
    for (int axis = 0; axis < 2; axis++) {
        float off_m = place_m[axis] - spread->mean_m[axis];
        spread->mean_m[axis] += off_m / spread->plots;
        spread->sum2_m2[axis] += off_m * (place_m[axis] - spread->mean_m[axis]);
    }
    rho_extent_add(&spread->extent, x_m, y_m);
}

/* A side moves outwards at once, and inwards slowly. */
static float moved_side_m(float was, float is, int is_wider)
{
    return is_wider ? is : was + EXTENT_DECAY * (is - was);
}

/* Outliers are left out: they would make clutter look thin. */
void rho_window_update_extent(struct rho_window *window)
{
    struct plot_spread spread = {0}, before;
    for (int round = 0; round < OUTLIER_ROUNDS; round++) {
        before = spread;
        spread = (struct plot_spread){.extent = {1.0f, 0.0f, 1.0f, 0.0f}};
        for (unsigned m = 0; m < window->num_scans; m++) {
            const struct rho_window_scan *held = rho_window_scan_at(window, m);
            for (unsigned i = 0; i < held->num_plots; i++) {
                add_plot(&spread, &before, held->plots[i].x_m, held->plots[i].y_m);
            }
        }
    }
    struct rho_extent *was = &window->extent, is = spread.extent;
    if (spread.plots < 1.0f) {
        return;
    }
    if (window->num_scans == 1) {
        *was = is;
    }
    was->x_min_m = moved_side_m(was->x_min_m, is.x_min_m, is.x_min_m < was->x_min_m);
    was->x_max_m = moved_side_m(was->x_max_m, is.x_max_m, is.x_max_m > was->x_max_m);
    was->y_min_m = moved_side_m(was->y_min_m, is.y_min_m, is.y_min_m < was->y_min_m);
    was->y_max_m = moved_side_m(was->y_max_m, is.y_max_m, is.y_max_m > was->y_max_m);
}
