/* SPDX-License-Identifier: MIT */
/*
 * clutter: how dense is clutter here? Contributors, in their order: the background, of the scan or
 * of a later part of it (expected_clutter.c); echoes and strobes that come back (echo_clutter.c),
 * to which second plots of targets are added once plots are claimed (second_plots.c).
 */
#include "clutter.h"

void rho_clutter_open(struct rho_tracker *tracker, struct rho_look *look, struct rho_work *work)
{
    if (RHO_CLAIMS_BEYOND && look->first_row > 0) {
        rho_clutter_measure_part(look);
    } else if (RHO_MAX_ECHOES > 0) {
        rho_echoes_predict(tracker, look, work);
    }
}

float rho_clutter_log_at_plot(const struct rho_look *look, float log_background, uint32_t row)
{
    return log_background + (RHO_MAX_ECHOES > 0 ? rho_echoes_log_ratio_at(look, row) : 0.0f);
}
