/* SPDX-License-Identifier: MIT */
/*
 * window_extent: functions of rectangles of the plane; and the window's extent, which follows the
 * held plots where no area is given.
 */
#include "window_extent.h"

#include "rhotrack/detail/approx.h"

/*
 * Outliers among the plots, which the extent leaves out: square of the standard deviations beyond
 * which a plot is one, rounds of leaving out, least number of plots for it; and the share of the
 * difference by which the extent shrinks in a scan.
 */
#define OUTLIER_SIGMAS2 9.0f
#define OUTLIER_ROUNDS 3
#define OUTLIER_PLOTS 12.0f
#define EXTENT_DECAY 0.02f

/* ---- extents --------------------------------------------------------------------------------- */

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
    return rho_larger(rho_extent_width_m(extent, side_min_m), 0.0f) *
           rho_larger(rho_extent_height_m(extent, side_min_m), 0.0f);
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

/* ---- the area that the plots show ------------------------------------------------------------ */

/* Mean, spread and extent of the held plots without outliers. */
struct plot_spread {
    /* number of plots; mean of x and y; sum of squares about the mean of x and y */
    float plots, mean_m[2], sum2_m2[2];
    struct rho_extent extent;
};

static int is_outlier(const struct plot_spread *spread, float x_m, float y_m)
{
    float dx_m = x_m - spread->mean_m[0], dy_m = y_m - spread->mean_m[1];
    return spread->plots >= OUTLIER_PLOTS &&
           (dx_m * dx_m * spread->plots > OUTLIER_SIGMAS2 * spread->sum2_m2[0] ||
            dy_m * dy_m * spread->plots > OUTLIER_SIGMAS2 * spread->sum2_m2[1]);
}

/*
 * Adds a plot to the running mean and sum of squares (Welford), unless `before` makes it an
 * outlier.
 */
static void add_plot_unless_outlier(struct plot_spread *spread, const struct plot_spread *before,
                                    float x_m, float y_m)
{
    const float place_m[2] = {x_m, y_m};
    if (is_outlier(before, x_m, y_m)) {
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

static void gather_spread_without_outliers(struct plot_spread *spread,
                                           const struct plot_spread *before,
                                           struct rho_window *window)
{
    *spread = (struct plot_spread){.extent = {1.0f, 0.0f, 1.0f, 0.0f}};
    for (unsigned m = 0; m < window->num_scans; m++) {
        const struct rho_window_scan *held = rho_window_scan_at(window, m);
        for (unsigned i = 0; i < held->num_plots; i++) {
            add_plot_unless_outlier(spread, before, held->plots[i].x_m, held->plots[i].y_m);
        }
    }
}

static float extent_side_shrinking_slowly_m(float was, float is, int is_wider)
{
    return is_wider ? is : was + EXTENT_DECAY * (is - was);
}

/*
 * Updates the extent by the held plots without outliers, which would make clutter look thin: it
 * grows at once and shrinks slowly.
 */
void rho_window_update_extent(struct rho_window *window)
{
    struct plot_spread spread = {0}, before;
    for (int round = 0; round < OUTLIER_ROUNDS; round++) {
        before = spread;
        gather_spread_without_outliers(&spread, &before, window);
    }
    struct rho_extent *was = &window->extent, is = spread.extent;
    if (spread.plots < 1.0f) {
        return;
    }
    if (window->num_scans == 1) {
        *was = is;
    }
    was->x_min_m =
        extent_side_shrinking_slowly_m(was->x_min_m, is.x_min_m, is.x_min_m < was->x_min_m);
    was->x_max_m =
        extent_side_shrinking_slowly_m(was->x_max_m, is.x_max_m, is.x_max_m > was->x_max_m);
    was->y_min_m =
        extent_side_shrinking_slowly_m(was->y_min_m, is.y_min_m, is.y_min_m < was->y_min_m);
    was->y_max_m =
        extent_side_shrinking_slowly_m(was->y_max_m, is.y_max_m, is.y_max_m > was->y_max_m);
}
