/* SPDX-License-Identifier: MIT */
#include "record_scans.h"

#include <math.h>

#include "chain.h"
#include "common.h"
#include "rhotrack/measurement.h"

struct rho_sensor record_sensor(const struct scenario_antenna *antenna)
{
    return (struct rho_sensor){.sensor_id = antenna->sensor_id,
                               .x_m = (float)antenna->x_m,
                               .y_m = (float)antenna->y_m,
                               .pd = (float)antenna->pd,
                               .range_min_m = (float)antenna->range_min_m,
                               .range_max_m = (float)antenna->range_max_m};
}

struct rho_scan record_scan(const struct scenario_record *record,
                            const struct record_arrival *arrival, const struct rho_sensor *sensor,
                            struct rho_plot *plots)
{
    const struct scenario_antenna *antenna = &record->antennas[arrival->antenna];
    const struct antenna_sector *sector = &record->views[arrival->antenna].sectors[arrival->sector];
    struct rho_scan scan = {.time_us = record_scan_us(record, arrival),
                            .sensor_id = antenna->sensor_id,
                            .measures = antenna->has_range_rate ? RHO_MEASURES_RANGE_RATE : 0u,
                            .sector_from_rad = (float)sector->from_rad,
                            .sector_to_rad = (float)sector->to_rad,
                            .plots = plots};

    if (sector->num_plots > RHO_MAX_PLOTS) {
        fail(EXIT_RUNTIME, "a scan of more than %d plots", RHO_MAX_PLOTS);
    }
    for (size_t i = 0; i < sector->num_plots; i++) {
        const struct antenna_plot *plot = &sector->plots[i];
        struct rho_polar_plot polar = {
            .offset_us = (int32_t)(llround(plot->t_s * 1e6) - scan.time_us),
            .range_m = (float)plot->range_m,
            .azimuth_rad = (float)plot->azimuth_rad,
            .range_rate_mps = (float)plot->range_rate_mps,
            .sigma_range_m = (float)antenna->sigma_range_m,
            .sigma_azimuth_rad = (float)antenna->sigma_azimuth_rad,
            .sigma_range_rate_mps = (float)antenna->sigma_range_rate_mps};

        must_succeed(
            rho_measurement_from_polar(&polar, scan.measures, sensor, &plots[scan.num_plots++]),
            "rho_measurement_from_polar");
    }
    return scan;
}
