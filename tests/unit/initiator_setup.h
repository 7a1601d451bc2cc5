/* SPDX-License-Identifier: MIT */
/* Shared by tests of the initiation: one initiator, scans filled plot by plot, random numbers. */
#ifndef RHOTRACK_TESTS_INITIATOR_SETUP_H
#define RHOTRACK_TESTS_INITIATOR_SETUP_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "random_draws.h"
#include "rhotrack/initiator.h"

#define NUM(array) (sizeof(array) / sizeof((array)[0]))
#define PI 3.14159265358979323846
/* the capacity of the embedded profile, so that tests are equal in both profiles */
#define PLOTS_MAX 256

static struct rho_initiator initiator;
static struct rho_plot plots[PLOTS_MAX];
static uint32_t num_plots;

/* Poisson number by Knuth's product of uniforms, for means of some dozens at most. */
static inline int poisson(double mean)
{
    double product = uniform(0.0, 1.0);
    int n = 0;
    for (; product > exp(-mean); n++) {
        product *= uniform(0.0, 1.0);
    }
    return n;
}

static inline void start_initiator(const struct rho_initiator_config *config)
{
    num_plots = 0;
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, config), RHO_OK);
}

/* Adds a plot; the caller may fill in more fields until the scan is pushed. */
static inline struct rho_plot *add_plot(double x_m, double y_m, double sigma_range_m,
                                        double sigma_cross_m)
{
    assert_true(num_plots < PLOTS_MAX);
    plots[num_plots] = (struct rho_plot){.x_m = (float)x_m,
                                         .y_m = (float)y_m,
                                         .sigma_range_m = (float)sigma_range_m,
                                         .sigma_cross_m = (float)sigma_cross_m};
    return &plots[num_plots++];
}

static inline void add_clutter_plots(const struct rho_extent *area, int count)
{
    for (int i = 0; i < count; i++) {
        double x_m = uniform(area->x_min_m, area->x_max_m);
        add_plot(x_m, uniform(area->y_min_m, area->y_max_m), 10.0, 10.0);
    }
}

/* Pushes the plots added since the last scan; `scan` has its other fields. */
static inline void push_scan(struct rho_scan scan, double t_s, const struct rho_sensor *sensor)
{
    static uint8_t fates[PLOTS_MAX];
    uint32_t unused = 0;
    memset(fates, RHO_FATE_HELD, sizeof fates);
    scan.time_us = llround(t_s * 1e6);
    scan.num_plots = num_plots;
    scan.plots = plots;
    assert_int_equal(rho_initiator_push(&initiator, &scan, sensor, fates, &unused), RHO_OK);
    num_plots = 0;
}

static inline void push_plots(double t_s)
{
    push_scan((struct rho_scan){0}, t_s, NULL);
}

static inline void search_window(enum rho_search kind)
{
    assert_int_equal(rho_initiator_search(&initiator, kind), RHO_OK);
}

/* A sensor without a sector or limit of range, with the default probability of detection. */
static inline struct rho_sensor sensor_at(double x_m, double y_m)
{
    return (struct rho_sensor){
        .x_m = (float)x_m, .y_m = (float)y_m, .pd = 0.9f, .range_max_m = 1.0e6f};
}

#endif
