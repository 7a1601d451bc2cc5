/* SPDX-License-Identifier: MIT */
#include "pipeline/no_tracks_reason.h"

#include <inttypes.h>

#define SOON_US 1000000 /* scans of one plot at shorter intervals are parts of a revolution */
#define LONE_LEAST 10   /* smallest number of single-plot scans that is evidence */

void no_tracks_reason_add_scan(struct no_tracks *seen, const struct rho_scan *scan)
{
    const bool has_sector =
        scan->sector_from_rad < scan->sector_to_rad || scan->sector_from_rad > scan->sector_to_rad;

    if (seen->scans == 0) {
        seen->sensor_id = scan->sensor_id;
        seen->first_us = seen->last_us = scan->time_us;
    } else if (scan->sensor_id == seen->sensor_id) {
        seen->lone +=
            scan->num_plots == 1 && !has_sector && scan->time_us - seen->last_us < SOON_US;
        seen->intervals++;
        seen->last_us = scan->time_us;
    }
    seen->scans++;
    seen->plots += scan->num_plots;
}

/* Scans that must hold a plot of the target before a track starts. */
static double scans_needed_for_start(const struct parameters *parameters)
{
    const double min_scans = parameters->value[PARAMETER_MIN_SCANS];

    return min_scans > 0 ? min_scans : 3;
}

void no_tracks_reason_print(const struct no_tracks *seen, const struct rho_tracker *tracker,
                            const struct parameters *parameters, FILE *file)
{
    const struct rho_tracker_counters *counters = &tracker->counters;
    const double *value = parameters->value;
    const double interval_s = seen->intervals > 0 ? (double)(seen->last_us - seen->first_us) *
                                                        1e-6 / (double)seen->intervals
                                                  : 0;

    fprintf(file, "rhotrack: no track: ");
    if (seen->plots == 0) {
        fprintf(file, "the %" PRIu64 " scans hold no plots\n", seen->scans);
    } else if (seen->lone >= LONE_LEAST && seen->lone > seen->scans / 2) {
        fprintf(file,
                "%" PRIu64 " of %" PRIu64 " scans have one plot each, %.3g s apart; where they are "
                "parts of a turn, scan_interval_s with the time of a turn gathers them\n",
                seen->lone, seen->scans, interval_s);
    } else if ((double)seen->scans < scans_needed_for_start(parameters)) {
        fprintf(file,
                "%" PRIu64 " scans, and a start needs plots in %.0f (min_scans) of %.0f (scans)\n",
                seen->scans, scans_needed_for_start(parameters), value[PARAMETER_SCANS]);
    } else if (counters->plots_outside > seen->plots / 2) {
        fprintf(file,
                "%" PRIu32 " of %" PRIu64 " plots lie outside the sensors' coverage "
                "(range_min_m=%g, range_max_m=%g, or the sensor's own)\n",
                counters->plots_outside, seen->plots, value[PARAMETER_RANGE_MIN_M],
                value[PARAMETER_RANGE_MAX_M]);
    } else if (counters->fates[RHO_FATE_STALE] > seen->plots / 2) {
        fprintf(file,
                "%" PRIu32 " of %" PRIu64 " plots are of scans that came after later ones; hold_ms "
                "and late_max_s take more of them\n",
                counters->fates[RHO_FATE_STALE], seen->plots);
    } else if (tracker->work.partial_steps > seen->scans / 2) {
        fprintf(file,
                "work_max=%.0f ended %" PRIu32 " of %" PRIu64
                " scans before all plots were tried\n",
                value[PARAMETER_WORK_MAX], tracker->work.partial_steps, seen->scans);
    } else if (counters->tracks_started > 0) {
        fprintf(file,
                "%" PRIu32 " began, and none had the plots to be confirmed; pd=%g is assumed, and "
                "`rhotrack calibrate` measures it\n",
                counters->tracks_started, value[PARAMETER_PD]);
    } else {
        fprintf(file,
                "this method found no plots that are likelier a target's than false: scans %.3g s "
                "apart, %.5g plots a scan, v_max_mps=%g, sigma_m=%g; `rhotrack calibrate` measures "
                "noise and speeds, and `rhotrack initiate` has other methods\n",
                interval_s, (double)seen->plots / (double)seen->scans, value[PARAMETER_V_MAX_MPS],
                value[PARAMETER_SIGMA_M]);
    }
}
