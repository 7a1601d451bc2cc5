/* SPDX-License-Identifier: MIT */
/*
 * pipeline: the library's objects for the whole pipeline, scans in, tracks out, in memory of their
 * own.
 */
#ifndef RHOTRACK_TOOL_PIPELINE_H
#define RHOTRACK_TOOL_PIPELINE_H

#include "rhotrack/paper_starts.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/zones.h"
#include "settings/parameters.h"

/* Which sensors' plots start tracks together: the parameter initiators. */
enum { INITIATORS_PAIRS, INITIATORS_SENSOR, INITIATORS_ONE };

/* The initiator of a sensor, or of the sensors that share its window (pipeline_window_of). */
struct pipeline_initiator {
    int32_t sensor_id;
    struct rho_initiator *initiator;
};

struct pipeline {
    struct rho_initiator *initiator; /* that of the newest scan */
    /* one a window, in the order in which these came; or one for all */
    struct pipeline_initiator *initiators;
    size_t num_initiators, num_allocated, capacity;
    bool has_one_initiator, has_pairs, has_sensor;
    bool is_live;                   /* anybody may send: set before pipeline_open */
    int32_t named[RHO_MAX_SENSORS]; /* sensors of which the parameters say something */
    size_t num_named;
    struct rho_initiator_config start;
    bool is_told;
    struct rho_settings told, settings; /* at the first pipeline_open; now */
    struct rho_passive *passive;        /* NULL before pipeline_open_passive */
    /* the papers' methods where the parameters ask for them; else NULL */
    struct rho_paper_starts *starts;
    struct rho_passive_paper *paper;
    struct rho_zones *zones;                 /* NULL where the parameters have none */
    struct rho_reflector_learning *learning; /* NULL where the parameters want none */
    struct rho_tracker *tracker;
    struct rho_report *report;
    struct rho_plot *plots; /* RHO_MAX_PLOTS, for the caller's scans */
};

struct pipeline pipeline_start(void);
void pipeline_free(struct pipeline *pipeline);

/* What options say of the methods; each may be NULL. */
struct pipeline_options {
    const char *gate, *method;
    const char *pipeline; /* "paper": the papers' methods from bearings and plots to tracks */
};

/*
 * The parameters gate, method and bearings_method from options, and what is customary with the
 * methods. Values that the tracker has not: exit 2.
 */
void pipeline_set_options(struct parameters *parameters, const struct pipeline_options *options);

/* Ready for a first scan. */
void pipeline_open(struct pipeline *pipeline, const struct parameters *parameters);

/* The same with bearings: the tracks that these start. After pipeline_open. */
void pipeline_open_passive(struct pipeline *pipeline, const struct parameters *parameters);

/* That of a window, which is the pipeline's from then on. */
struct rho_initiator *pipeline_initiator_of_window(struct pipeline *pipeline, int32_t sensor_id);

/*
 * The sensor by which a scan's window is named: the scan's own, or the one described earlier that
 * sees the same.
 */
int32_t pipeline_window_of(const struct pipeline *pipeline, const struct rho_scan *scan);

/* Where a scan's plots start tracks: before its step, after its sensor was described. */
struct rho_initiator *pipeline_initiator_of_scan(struct pipeline *pipeline,
                                                 const struct rho_scan *scan);

/* Bearings of another clock are none of the batch's: as pipeline_open leaves the initiators. */
void pipeline_reopen_passive_paper(struct pipeline *pipeline);

/*
 * After a step of the tracker without an initiator (NULL): the papers' methods start tracks. One of
 * scan and frame. Nothing where the parameters ask for the default ones.
 */
void pipeline_start_paper_tracks(struct pipeline *pipeline, const struct rho_scan *scan,
                                 const struct rho_frame *frame);

/*
 * Other parameters from the next step on: tracks, and all that was learned, go on. The search by
 * bearings, and the papers' methods, keep those that they were opened with.
 */
void pipeline_reconfigure(struct pipeline *pipeline, const struct parameters *parameters);

/* After a step of plots and its starts: walls are learned. */
void pipeline_learn_walls(struct pipeline *pipeline, const struct rho_scan *scan);

/* After a step and its starts: the zones count its tracks. */
void pipeline_count_zones(struct pipeline *pipeline);

/* One step; the report is the pipeline's. */
void pipeline_step(struct pipeline *pipeline, const struct rho_scan *scan);
void pipeline_step_frame(struct pipeline *pipeline, const struct rho_frame *frame);

#endif
