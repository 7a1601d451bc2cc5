/* SPDX-License-Identifier: MIT */
/* Scenario air-traffic, simulated and looked up. Include after cmocka.h. */
#ifndef TRAFFIC_SCENE_H
#define TRAFFIC_SCENE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenario.h"

#define SEED 1903
#define PI 3.141592653589793
#define DEG_RAD (PI / 180.0)
#define HALF_M 250000.0

static inline void assert_within(const char *what, double value, double expected, double most)
{
    print_message("%s: %.5f, expected %.5f +- %.5f\n", what, value, expected, most);
    assert_true(fabs(value - expected) <= most);
}

/* ---- simulations ------------------------------------------------------------------------------ */

static inline struct parameters parameters_of(double targets, double num_scans, double clutter)
{
    struct parameters parameters;

    parameters_default(&parameters);
    scenario_suggest("air-traffic", &parameters);
    parameters_suggest(&parameters, PARAMETER_TARGETS, targets);
    parameters_suggest(&parameters, PARAMETER_NUM_SCANS, num_scans);
    parameters_suggest(&parameters, PARAMETER_CLUTTER_PER_SCAN, clutter);
    return parameters;
}

static inline struct simulation *simulate(const struct parameters *parameters)
{
    return scenario_simulate("air-traffic", parameters, SEED, 0);
}

static inline const struct truth_point *truth_of_scan(const struct simulation *simulation,
                                                      size_t scan)
{
    return &simulation->truth[scan * simulation->targets_a_scan];
}

/* The target at a scan, or NULL. */
static inline const struct truth_point *find(const struct simulation *simulation, size_t scan,
                                             int id)
{
    const struct truth_point *truth = truth_of_scan(simulation, scan);

    for (size_t i = 0; i < simulation->targets_a_scan; i++) {
        if (truth[i].target_id == id) {
            return &truth[i];
        }
    }
    return NULL;
}

static inline const struct simulated_plot *find_plot(const struct simulated_scan *scan, int id)
{
    for (size_t i = 0; i < scan->num_plots; i++) {
        if (scan->plots[i].target_id == id) {
            return &scan->plots[i];
        }
    }
    return NULL;
}

static inline size_t count_false(const struct simulated_scan *scan)
{
    size_t count = 0;

    for (size_t i = 0; i < scan->num_plots; i++) {
        count += scan->plots[i].target_id < 0;
    }
    return count;
}

/* First and last scan of each target. */
struct life {
    size_t first, last;
};

static inline struct life *lives_of(const struct simulation *simulation)
{
    struct life *lives = calloc(simulation->num_targets + 1, sizeof *lives);

    assert_non_null(lives);
    for (size_t i = 0; i < simulation->num_truth; i++) {
        size_t scan = i / simulation->targets_a_scan;
        struct life *life = &lives[simulation->truth[i].target_id];
        life->first = life->last == 0 ? scan + 1 : life->first;
        life->last = scan + 1; /* one more, so that 0 is none */
    }
    return lives;
}

#endif
