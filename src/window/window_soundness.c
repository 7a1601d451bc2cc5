/* SPDX-License-Identifier: MIT */
/* window_soundness: checks that a window of unknown origin (a snapshot) is consistent. */
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/measurement.h"
#include "rhotrack/detail/window.h"

/* True where the bins' starts ascend and plots lie in their bins, as pushes move plots by bins. */
static int has_sound_bins(const struct rho_window_scan *scan)
{
    const unsigned num_bins = (unsigned)scan->bins_x * scan->bins_y;
    if (num_bins < 1 || num_bins > RHO_MAX_BINS || scan->bin_start[0] != 0 ||
        scan->bin_start[num_bins] != scan->num_plots) {
        return 0;
    }
    for (unsigned bin = 0; bin < num_bins; bin++) {
        if (scan->bin_start[bin] > scan->bin_start[bin + 1] ||
            scan->bin_start[bin + 1] > scan->num_plots) {
            return 0;
        }
        for (unsigned i = scan->bin_start[bin]; i < scan->bin_start[bin + 1]; i++) {
            const struct rho_window_plot *plot = &scan->plots[i];
            if (rho_window_bin_at(scan, plot->x_m, plot->y_m) != bin) {
                return 0;
            }
        }
    }
    return 1;
}

static int is_sound_scan(const struct rho_window_scan *scan)
{
    if (!rho_is_stored_time(scan->time_us) ||
        !rho_angle_is_valid_sector(scan->sector_from_rad, scan->sector_to_rad) ||
        !rho_measurement_is_valid_site(&scan->sensor) ||
        !rho_is_within(scan->sensor.pd, 0.0f, 1.0f) || scan->num_plots > RHO_MAX_PLOTS ||
        scan->num_unused > scan->num_plots || !rho_are_finite(&scan->bin_x0_m, 1) ||
        !rho_are_finite(&scan->bin_y0_m, 1) || !rho_is_within(scan->bins_per_m_x, 0.0f, 1e6f) ||
        !rho_is_within(scan->bins_per_m_y, 0.0f, 1e6f) ||
        !rho_is_within(scan->sigma_max_m, 0.0f, 1e7f) || !rho_are_finite(&scan->offset_min_s, 1) ||
        !rho_are_finite(&scan->offset_max_s, 1)) {
        return 0;
    }
    for (unsigned i = 0; i < scan->num_plots; i++) {
        const struct rho_window_plot *plot = &scan->plots[i];
        if (!rho_is_coordinate(plot->x_m) || !rho_is_coordinate(plot->y_m) ||
            !rho_is_coordinate(plot->z_m) ||
            !rho_is_within(plot->offset_s, -2e-6f * RHO_LIMIT_OFFSET_US,
                           2e-6f * RHO_LIMIT_OFFSET_US) ||
            !rho_are_finite(&plot->range_rate_mps, 1)) {
            return 0;
        }
    }
    return has_sound_bins(scan);
}

int rho_window_is_sound(const struct rho_window *window)
{
    int64_t before_us = INT64_MIN;
    if (window->scans_max < 1 || window->scans_max > RHO_MAX_SCANS ||
        window->num_scans > window->scans_max || window->first >= window->scans_max ||
        !rho_is_within(window->side_min_m, 0.0f, 1e30f) ||
        !rho_is_coordinate(window->extent.x_min_m) || !rho_is_coordinate(window->extent.x_max_m) ||
        !rho_is_coordinate(window->extent.y_min_m) || !rho_is_coordinate(window->extent.y_max_m)) {
        return 0;
    }
    for (unsigned m = 0; m < window->num_scans; m++) {
        const struct rho_window_scan *scan = &window->ring[(window->first + m) % window->scans_max];
        if (scan->time_us < before_us || !is_sound_scan(scan)) {
            return 0;
        }
        before_us = scan->time_us;
    }
    if (window->num_scans > 0) {
        /* the record of the newest sector, or whole scan, must fit to the newest held scan */
        const struct rho_window_sector *newest = &window->newest;
        if (!rho_is_stored_time(newest->time_us) || newest->time_us < before_us ||
            newest->time_us - before_us > RHO_LIMIT_OFFSET_US ||
            !rho_are_finite(&newest->offset_min_s, 1)) {
            return 0;
        }
    }
    return rho_window_accepts(window, INT64_MAX);
}
