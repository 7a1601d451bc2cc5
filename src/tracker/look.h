/* SPDX-License-Identifier: MIT */
/*
 * look: one sensor's detections at one time, as features see them, and the work of a step.
 * Private to the rooms from src/tracker on.
 *
 * Options of config.h: every build compiles every function, and callers test the option first
 * (`if (RHO_SECTORS)`), so that the linker leaves out functions that a build does not need.
 */
#ifndef RHOTRACK_LOOK_H
#define RHOTRACK_LOOK_H

#include "rhotrack/tracker.h"

#define RHO_TRACKER_MAGIC 0x5452434bu /* "TRCK" */

/* Least side of the area over which unclaimed plots are spread for a clutter density. */
#define RHO_CLUTTER_SIDE_MIN_M 1000.0f

/* Budget of the phase that runs, in units of work. */
struct work_share {
    uint32_t end, kept; /* spent at which the phase ends; reserved for each waiting track */
    unsigned waiting;   /* tracks of which no plots were scored yet */
};

/* Runs of successive plots with a bounding box each, where the plot index has one strip. */
#define RHO_PLOT_BOXES 8

/* Most parts of RHO_MAX_PLOTS plots in which a large scan is claimed; further plots are ignored. */
#define RHO_TRACKER_PARTS_MAX 4u

/* Work of a step, in units, and the budget of the phase that runs. */
struct rho_work {
    uint32_t spent, plots_not_tried; /* units so far; plots left out by the budget */
    struct work_share share;         /* budget of the phase that runs */
    int is_partial;                  /* the budget has left out something */
};

/* A scan of plots, a part of a large one, or a scan of bearings; const for all that ask it. */
struct rho_look {
    const struct rho_tracker *tracker;       /* whose tracks it looks at */
    const struct rho_scan *scan;             /* its plots; NULL: bearings */
    const struct rho_bearing_scan *bearings; /* its bearings; NULL: plots */
    uint8_t *fates;                          /* of its plots or bearings, those of the report */
    /* the row of its sensor; NULL: the table is full of described sensors, or bearings */
    struct rho_tracker_sensor *row;
    const struct rho_sensor *sensor;     /* its sensor as described; NULL: not described */
    struct rho_tracker_learned *learned; /* of this sensor; NULL: not described, or bearings */
    /* measures the density of clutter, and starts tracks from its plots; NULL: none */
    struct rho_initiator *initiator;
    struct rho_track_model model; /* how tracks move to its time, and their filters */
    int64_t time_us;
    uint16_t count;     /* count of the sensor's scans; 0: not known */
    uint8_t is_suspect; /* its sensor contradicts the others */
    /* it changes what is learned, and what tracks remember; 0: it is out of sequence */
    uint8_t teaches;
    uint8_t starts;         /* tracks may start from its plots */
    uint8_t has_more_parts; /* tracks without a plot may find one in a later part of the scan */
    /* its sector continues the previous one: 1 counter-clockwise, -1 clockwise; else 0 */
    float turning;
    uint32_t num_inputs; /* plots or bearings */
    uint32_t num_gated;  /* of these the ones with a place in fates: the first RHO_MAX_PLOTS */
    uint32_t first_row;  /* row in the scan of the first plot of the part that is claimed now */
    /* a later part's own clutter density; and the scan's plots over RHO_MAX_PLOTS, 0: first part */
    float part_per_m2, part_share;
    /* largest noise on any axis, and largest time offset either way, of the valid plots */
    float sigma_max_m, offset_max_s;
    /* bit i: track i is in the field of view and was predicted */
    uint32_t in_view[(RHO_MAX_TRACKS + 31) / 32];
    struct rho_extent boxes[RHO_PLOT_BOXES]; /* bounding boxes of runs of successive plots */
    uint32_t plots_of_box;                   /* plots in each run */
    float pd, log_pd, log_miss;              /* P_D outside of the notch; ln of it, and of 1 - it */
    float log_false_bearings;                /* ln of the density of false bearings a radian */
    /* variance of its bearings' lasting errors, and looks that share one; 0: none is known */
    float lasting_rad2, lasting_looks;
    struct rho_notch_look notch_look; /* what a sensor with a Doppler notch sees; 0: no notch */
    /* ln of the intervals in which clutter is uniform: height, m; velocity on one axis, m/s */
    float log_height, log_rates;
    float log_range_rates; /* ln of range_rates_mps */
    float range_rates_mps; /* interval of range rates in which clutter is uniform, m/s */
};

/* Its bearings fill their room: others, and those of targets among them, may have been left out. */
static inline int rho_look_is_full(const struct rho_look *look)
{
    return look->bearings && look->bearings->num_bearings >= RHO_MAX_BEARINGS;
}

/* The record of the sensor's scans; NULL: none came in sequence, as of one that is always late. */
static inline struct rho_tracker_look *rho_look_record(const struct rho_look *look)
{
    return look->row && look->row->look.count > 0 ? &look->row->look : 0;
}

static inline int rho_tracker_is_ready(const struct rho_tracker *tracker)
{
    return tracker->magic == RHO_TRACKER_MAGIC;
}

/* NULL where the tracker or another argument of a call is, STATE before rho_tracker_init. */
static inline enum rho_status rho_tracker_check(const struct rho_tracker *tracker, int has_others)
{
    return !tracker || !has_others          ? RHO_ERROR_NULL
           : !rho_tracker_is_ready(tracker) ? RHO_ERROR_STATE
                                            : RHO_OK;
}

/* Largest track score either way, mnat: sums of two scores fit 32 bits. */
#define RHO_SCORE_MAX_MNAT 1000000000

static inline int rho_tracker_is_score_in_range(int32_t mnat)
{
    return mnat >= -RHO_SCORE_MAX_MNAT && mnat <= RHO_SCORE_MAX_MNAT;
}

/* True of a track that an operator has frozen: it is in no scan's view, and does not age. */
static inline int rho_track_is_frozen(const struct rho_track *track)
{
    return RHO_MAX_EXCLUDED_AREAS > 0 && track->is_frozen;
}

/* True where targets may give several plots a scan (rho_tracker_set_body_max). */
static inline int rho_bodies_are_used(const struct rho_tracker *tracker)
{
    return RHO_BODIES && tracker->bodies.length_max_m > 0.0f;
}
/* body_extents.c of src/bodies */
int rho_bodies_are_sound(const struct rho_tracker *tracker);

#endif
