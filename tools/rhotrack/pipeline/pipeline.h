/* SPDX-License-Identifier: MIT */
/*
 * pipeline: the library's objects from scans to tracks (initiators, tracker, zones) in allocated
 * memory.
 */
#ifndef RHOTRACK_TOOL_PIPELINE_H
#define RHOTRACK_TOOL_PIPELINE_H

#include "rhotrack/paper_starts.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/zones.h"
#include "settings/parameters.h"

/* Values of the parameter initiators: which sensors share an initiation window. */
enum { INITIATORS_PAIRS, INITIATORS_SENSOR, INITIATORS_ONE };

/* The initiator of one window, named by a sensor (pipeline_window_sensor_id). */
struct pipeline_initiator {
    int32_t sensor_id;
    struct rho_initiator *initiator;
};

struct pipeline {
    struct rho_initiator *initiator; /* initiator of the newest scan */
    /*
     * one initiator a window, in order of first use; the last of 257 is of all further sensors; a
     * single one for INITIATORS_ONE
     */
    struct pipeline_initiator *initiators;
    size_t num_initiators, num_allocated, capacity;
    bool has_one_initiator, has_pairs, has_sensor;
    /* live input, where strangers may send; set before pipeline_open */
    bool is_live;
    int32_t named[RHO_MAX_SENSORS]; /* sensors that the parameters mention */
    size_t num_named;
    struct rho_initiator_config start;
    bool is_told;
    struct rho_settings told, settings; /* settings at the first pipeline_open, and current ones */
    /* initiation from bearings; NULL before pipeline_open_passive */
    struct rho_passive *passive;
    /*
     * the papers' methods for plots and for bearings; NULL where the parameters do not choose them
     */
    struct rho_paper_starts *starts;
    struct rho_passive_paper *paper;
    struct rho_zones *zones;                 /* NULL: the parameters define no zones */
    struct rho_reflector_learning *learning; /* learning of walls; NULL: switched off */
    struct rho_tracker *tracker;
    struct rho_report *report;
    struct rho_plot *plots; /* RHO_MAX_PLOTS, memory for the caller's scans */
};

struct pipeline pipeline_allocate(void);
void pipeline_free(struct pipeline *pipeline);

/* Options that choose methods; each may be NULL. */
struct pipeline_options {
    const char *gate, *method;
    const char *pipeline; /* "paper": the papers' methods from plots and bearings to tracks */
};

/*
 * Sets the parameters gate, method and bearings_method from options, and suggests the methods'
 * customary values. Exit 2 for a gate that the tracker lacks.
 */
void pipeline_options_to_parameters(struct parameters *parameters,
                                    const struct pipeline_options *options);

/* Initialises all objects for a first scan; tracks of an earlier run are dropped. */
void pipeline_open(struct pipeline *pipeline, const struct parameters *parameters);

/* Initialises the initiation of tracks from bearings; after pipeline_open. */
void pipeline_open_passive(struct pipeline *pipeline, const struct parameters *parameters);

/*
 * The initiator of a window, added where it is new and not one of too many; it becomes
 * pipeline->initiator.
 */
struct rho_initiator *pipeline_find_or_add_initiator(struct pipeline *pipeline, int32_t sensor_id);

/*
 * The sensor that names the window of a scan: the scan's own sensor, or a sensor described before
 * it that shares its window.
 */
int32_t pipeline_window_sensor_id(const struct pipeline *pipeline, const struct rho_scan *scan);

/* The initiator for a scan's plots; call after the sensor was described, before the scan's step. */
struct rho_initiator *pipeline_initiator_of_sensor(struct pipeline *pipeline,
                                                   const struct rho_scan *scan);

/* Drops the batch of bearings of passive-paper, after a change of the clock. */
void pipeline_reopen_passive_paper(struct pipeline *pipeline);

/*
 * Starts tracks by the papers' methods, after a step of the tracker without an initiator. Either
 * scan or frame is NULL. Does nothing where the parameters choose the default methods.
 */
void pipeline_start_paper_tracks(struct pipeline *pipeline, const struct rho_scan *scan,
                                 const struct rho_frame *frame);

/*
 * Applies other parameters from the next step on; tracks and learned values are kept. Initiation
 * from bearings and the papers' methods keep the parameters that they were opened with.
 */
void pipeline_reconfigure(struct pipeline *pipeline, const struct parameters *parameters);

/* Learns walls from a scan, after its step and track starts. */
void pipeline_learn_walls(struct pipeline *pipeline, const struct rho_scan *scan);

/* Updates the zones' counts by the tracks, after a step and its track starts. */
void pipeline_count_tracks_in_zones(struct pipeline *pipeline);

/* Steps a scan, or a frame of bearings, completely; the result is in pipeline->report. */
void pipeline_step(struct pipeline *pipeline, const struct rho_scan *scan);
void pipeline_step_frame(struct pipeline *pipeline, const struct rho_frame *frame);

#endif
