/* SPDX-License-Identifier: MIT */
/*
 * phases: the six phases of a step, in their order, each a file. step.c calls them for a scan of
 * plots, bearing_frame.c for a frame of bearings. No phase calls an earlier one. Private to
 * src/step.
 */
#ifndef RHOTRACK_PHASES_H
#define RHOTRACK_PHASES_H

#include "../tracker/step.h"

/*
 * step_begin.c: the report begins; 0 where the inputs are too late for the tracker and have their
 * fates. rho_tracker_report ends the step in either case.
 */
int rho_tracker_begin_step(struct step *step);
/* Sets how targets may move, and the filter of new tracks. */
void rho_tracker_set_model(struct step *step);
/* Uses the pd of step->sensor. */
void rho_tracker_set_pd(struct step *step);
int rho_tracker_is_usable_time(int64_t time_us);
int rho_tracker_is_late(const struct rho_tracker *tracker, int64_t time_us);

/* predict.c: the tracks that the scan can see; one track */
void rho_tracker_predict(struct step *step);
void rho_tracker_predict_track(struct step *step, struct rho_track *track);

/* claim.c: gates the plots and assigns them to tracks; changes no track */
void rho_tracker_claim(struct step *step);

/* update.c: tracks take the plots that they were assigned */
void rho_tracker_update(struct step *step);

/* age.c: misses, ends and confirmations of all tracks; of one, after its miss was counted */
void rho_tracker_age(struct step *step);
void rho_tracker_age_track(struct step *step, struct rho_track *track, int is_missed,
                           const struct rho_track_limits *limits);

/* initiate.c, bearing_initiation.c: tracks start from what no track claimed */
void rho_tracker_initiate(struct step *step);
void rho_tracker_initiate_passive(struct step *step);

/* report.c: one estimate for each track at the step's time; fates, counters and tracks */
void rho_tracker_merge_estimates(struct step *step);
void rho_tracker_report(struct step *step);
void rho_tracker_report_tracks(const struct step *step);

/* scan_overflow.c: claim and update in parts, of a scan of more than RHO_MAX_PLOTS plots */
void rho_tracker_claim_parts(struct step *step);

/* merged_plots.c: pairs of tracks take one plot, before the others take theirs */
void rho_tracker_share_merged_plots(struct step *step);

/* split_bodies.c: tracks of bodies that are surely two targets become two */
void rho_tracker_split_bodies(struct step *step, const struct rho_scan *scan);

/*
 * track_starts.c: a started track of any initiator joins the others where there is room; else it
 * ends, and 0. rho_tracker_start_track does the same between two steps.
 */
int rho_tracker_admit_track(struct step *step, struct rho_track *track,
                            const struct rho_track_limits *limits);
/*
 * What is done between two steps goes on from the newest one, whose report it still is; STATE where
 * there is none.
 */
enum rho_status rho_tracker_resume_step(struct rho_tracker *tracker, struct rho_report *report,
                                        struct step *step);
/* The candidate's plots in the order of their scans; returns how many. */
unsigned rho_tracker_gather_plots(struct rho_window *window, const struct rho_candidate *candidate,
                                  struct rho_track_plot *plots);
/* Without an initiator, unclaimed plots and bearings are held nowhere. */
void rho_tracker_refuse_unclaimed(struct step *step);

#endif
