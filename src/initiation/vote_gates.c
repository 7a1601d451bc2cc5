/* SPDX-License-Identifier: MIT */
/* vote_gates: narrows the gates of votes where the noise of a radar's plots grows with range. */
#include "kernels.h"
#include "rhotrack/detail/approx.h"

/*
 * Bounds the noise of a single radar by range. Kernels' gates are wide enough for the noise of the
 * farthest plots; nearer plots have less noise where it comes from an angle. Without bounds
 * (several places, isotropic noise, process noise) sigma_least_m is 0.
 */
void rho_vote_gates_bound(struct search *search)
{
    const struct rho_sensor *first = &rho_search_scan(search, 0)->sensor;
    search->sigma_least_m = 0.0f;
    if (rho_search_is_isotropic(search) || search->fit_process_m2 > 0.0f) {
        return;
    }
    for (unsigned m = 1; m < search->num_scans; m++) {
        const struct rho_sensor *sensor = &rho_search_scan(search, m)->sensor;
        if (!rho_is_equal(sensor->x_m, first->x_m) || !rho_is_equal(sensor->y_m, first->y_m)) {
            return;
        }
    }
    for (unsigned m = 0; m < search->num_scans; m++) {
        const struct rho_window_scan *scan = rho_search_scan(search, m);
        for (unsigned i = 0; i < scan->num_plots; i++) {
            float sigma_m = rho_window_decode_sigma(scan->plots[i].sigma_range);
            search->sigma_near_m = rho_larger(sigma_m, search->sigma_near_m);
        }
        if (scan->num_plots > 0 &&
            (search->sigma_least_m <= 0.0f || scan->sigma_max_m < search->sigma_least_m)) {
            search->sigma_least_m = scan->sigma_max_m;
        }
    }
    /* the largest ratio of noise to range of the plots with more noise than sigma_near_m */
    for (unsigned m = 0; m < search->num_scans; m++) {
        const struct rho_window_scan *scan = rho_search_scan(search, m);
        float per2 = search->sigma_per_m * search->sigma_per_m;
        for (unsigned i = 0; i < scan->num_plots; i++) {
            const struct rho_window_plot *plot = &scan->plots[i];
            float sigma_m = rho_window_larger_sigma_m(plot);
            float x_m = plot->x_m - scan->sensor.x_m, y_m = plot->y_m - scan->sensor.y_m;
            float range2_m2 = x_m * x_m + y_m * y_m, sigma2_m2 = sigma_m * sigma_m;
            if (sigma_m > search->sigma_near_m && sigma2_m2 > per2 * range2_m2) {
                per2 = range2_m2 > 1.0f ? sigma2_m2 / range2_m2 : sigma2_m2;
            }
        }
        search->sigma_per_m = rho_sqrt(per2);
    }
}

/*
 * The sine of the angle between a plot's line of sight and the last plot's is at most far_m over
 * its range, so that at most sigma_per_m far_m of its noise across lies along the latter.
 */
void rho_vote_gates_of_ending(const struct search *search, float far_m, struct ending *ending)
{
    ending->gate_share = ending->along_share = 1.0f;
    ending->along_x = ending->along_y = 0.0f;
    if (search->sigma_least_m <= 0.0f) {
        return;
    }
    const struct rho_sensor *sensor = &rho_search_scan(search, 0)->sensor;
    float x_m = ending->plot->x_m - sensor->x_m, y_m = ending->plot->y_m - sensor->y_m;
    float range_m = rho_sqrt(x_m * x_m + y_m * y_m);
    float across_m = search->sigma_per_m * (range_m + far_m);
    float turned_m = search->sigma_per_m * far_m;
    float along_m = rho_sqrt(search->sigma_near_m * search->sigma_near_m + turned_m * turned_m);
    across_m = rho_larger(across_m, search->sigma_near_m);
    if (across_m < search->sigma_least_m) {
        ending->gate_share = across_m / search->sigma_least_m;
    }
    if (along_m < search->sigma_least_m && range_m > 1.0f) {
        ending->along_share = along_m / search->sigma_least_m;
        ending->along_x = x_m / range_m;
        ending->along_y = y_m / range_m;
    }
}
