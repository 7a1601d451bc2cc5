/* SPDX-License-Identifier: MIT */
/* chain: the library's objects for the whole chain, scans in, tracks out, in memory of their own. */
#ifndef RHOTRACK_TOOL_CHAIN_H
#define RHOTRACK_TOOL_CHAIN_H

#include "parameters.h"
#include "scenario.h"

/* Whose plots start tracks together: the parameter initiators. */
enum { INITIATORS_PAIRS, INITIATORS_SENSOR, INITIATORS_ONE };

/* Who starts the tracks of a sensor, or of the two that share its window (chain_window_of). */
struct chain_initiator {
    int32_t sensor_id;
    struct rho_initiator *initiator;
};

struct chain {
    struct rho_initiator *initiator; /* that of the newest scan */
    /* one a window, in the order in which these came; or one for all */
    struct chain_initiator *initiators;
    size_t num_initiators, num_allocated, capacity;
    bool has_one_initiator, has_pairs, has_sensor;
    bool is_live;                   /* anybody may send: set before chain_open */
    int32_t named[RHO_MAX_SENSORS]; /* sensors of which the parameters say something */
    size_t num_named;
    struct rho_initiator_config start;
    struct rho_passive *passive; /* NULL before chain_open_passive */
    struct rho_tracker *tracker;
    struct rho_report *report;
    struct rho_plot *plots; /* RHO_MAX_PLOTS, for the caller's scans */
};

struct chain chain_start(void);
void chain_free(struct chain *chain);

/* The parameter gate from --gate, where that was given; gates that the tracker has not: exit 2. */
void chain_set_gate(struct parameters *parameters, const char *gate);

/* Ready for a first scan. */
void chain_open(struct chain *chain, const struct parameters *parameters);

/* The same with bearings: the tracks that these start. After chain_open. */
void chain_open_passive(struct chain *chain, const struct parameters *parameters);

/* That of a window, which is the chain's from then on. */
struct rho_initiator *chain_initiator(struct chain *chain, int32_t sensor_id);

/* The sensor by which a scan's window is named: the scan's own, or the one described earlier that sees the same. */
int32_t chain_window_of(const struct chain *chain, const struct rho_scan *scan);

/* Where a scan's plots start tracks: before its step, after its sensor was described. */
struct rho_initiator *chain_initiator_of(struct chain *chain, const struct rho_scan *scan);

/* One step; the report is the chain's. */
void chain_step(struct chain *chain, const struct rho_scan *scan);
void chain_step_frame(struct chain *chain, const struct rho_frame *frame);

/* A plot with the same noise on all axes. */
struct rho_plot chain_plot(double x_m, double y_m, double sigma_m);

/* Clutter alone, so many plots on average, even over the parameters' area, goes into the chain's plots: how many it is. */
struct random;
size_t chain_fill_clutter(struct chain *chain, const struct parameters *parameters, double mean,
                          struct random *random);

/* A simulated look as the library takes it, `most` bearings of it at most; these go into the caller's array. */
struct rho_bearing_scan chain_look(const struct scenario_passive *passive,
                                   const struct simulated_look *look, struct rho_bearing *bearings,
                                   size_t most);

/* Exit 1 naming what the library refused, and why. */
void must_succeed(enum rho_status status, const char *what);

#endif
