/* SPDX-License-Identifier: MIT */
/*
 * The tracker's inside: what the phases of one step share. Private to src/tracker/tracker*.c.
 */
#ifndef RHOTRACK_TRACKER_STEP_H
#define RHOTRACK_TRACKER_STEP_H

#include "rhotrack/tracker.h"

struct step {
    struct rho_tracker *tracker;
    struct rho_initiator *initiator; /* or NULL */
    const struct rho_scan *scan;
    struct rho_report *report;
    const struct rho_sensor *sensor; /* NULL: not in the table */
    uint32_t num_gated;              /* plots with a place in report->fates */
    struct rho_track_model model;
    float log_pd;
    float log_miss; /* ln(1 - pd) */
};

/* tracker_claim.c: existing tracks take their plots */
void rho_tracker_predict(struct step *step);
void rho_tracker_claim(struct step *step);
void rho_tracker_update(struct step *step);

/* tracker_life.c: tracks end, are believed, and start */
void rho_tracker_end_track(struct step *step, struct rho_track *track, enum rho_track_status was);
void rho_tracker_age(struct step *step);
void rho_tracker_initiate(struct step *step);

/* Thousandths of a nat, within the assignment's range. */
int32_t rho_tracker_mnat(float nat);

#endif
