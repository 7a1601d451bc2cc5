/* SPDX-License-Identifier: MIT */
#include "lab_input.h"

#include <math.h>

struct rho_plot lab_isotropic_plot(double x_m, double y_m, double sigma_m)
{
    return (struct rho_plot){.x_m = (float)x_m,
                             .y_m = (float)y_m,
                             .sigma_range_m = (float)sigma_m,
                             .sigma_cross_m = (float)sigma_m,
                             .sigma_up_m = (float)sigma_m};
}

size_t lab_draw_clutter_plots(struct pipeline *chain, const struct parameters *parameters,
                              double mean, struct random *random)
{
    size_t count = random_poisson(random, mean);
    double sigma_m = parameters->value[PARAMETER_SIGMA_M];

    count = count < RHO_MAX_PLOTS ? count : RHO_MAX_PLOTS;
    for (size_t i = 0; i < count; i++) {
        double x_m = random_between(random, parameters->value[PARAMETER_AREA_X_MIN_M],
                                    parameters->value[PARAMETER_AREA_X_MAX_M]);
        double y_m = random_between(random, parameters->value[PARAMETER_AREA_Y_MIN_M],
                                    parameters->value[PARAMETER_AREA_Y_MAX_M]);
        chain->plots[i] = lab_isotropic_plot(x_m, y_m, sigma_m);
    }
    return count;
}

struct rho_bearing_scan lab_bearing_scan_of_look(const struct scenario_passive *passive,
                                                 const struct simulated_look *look,
                                                 struct rho_bearing *bearings, size_t bearings_max)
{
    size_t count = look->num_bearings < bearings_max ? look->num_bearings : bearings_max;

    for (size_t i = 0; i < count; i++) {
        bearings[i] = (struct rho_bearing){.bearing_rad = (float)look->bearings[i].bearing_rad,
                                           .sigma_rad = (float)passive->sigma_rad};
    }
    return (struct rho_bearing_scan){.time_us = llround(look->t_s * 1e6),
                                     .sensor_id = (int32_t)look->sensor + 1,
                                     .x_m = (float)passive->sensors[look->sensor].x_m,
                                     .y_m = (float)passive->sensors[look->sensor].y_m,
                                     .num_bearings = (uint32_t)count,
                                     .bearings = bearings};
}
