/* SPDX-License-Identifier: MIT */
/*
 * phases: the six phases of a step, in their order, each a file. step.c calls them for a scan of
 * plots, bearing_frame_step.c for a frame of bearings. No phase calls an earlier one. Private to
 * src/step.
 */
#ifndef RHOTRACK_PHASES_H
#define RHOTRACK_PHASES_H

#include "../tracker/step.h"

/*
 * begin_step_or_refuse_late_scan.c: clears the report, and counts the scan. Returns 0 where the
 * inputs are too old for the tracker: their fates are then STALE, and of the later phases only
 * rho_tracker_report follows.
 */
int rho_tracker_begin_step_unless_late(struct step *step);
/* Sets the step's motion model, the filter of new tracks, and the volumes of clutter densities. */
void rho_tracker_set_motion_model(struct rho_tracker *tracker, struct rho_look *look);
/* Sets step->log_pd and step->log_miss by step->sensor, or by the tracker's default pd. */
void rho_tracker_set_log_pd_of_step(struct rho_look *look);
int rho_tracker_is_usable_time(int64_t time_us);
/* True where a time is before that of the tracker's newest step. */
int rho_tracker_is_late(const struct rho_tracker *tracker, int64_t time_us);

/* predict.c: moves the tracks that the scan can see to the time of the step */
void rho_tracker_predict(struct step *step);
/* Moves a track to the step's time; a track whose covariance has grown too large ends. */
void rho_tracker_predict_or_end_track(struct step *step, struct rho_track *track);

/* claim.c: gates the plots and assigns them to tracks; changes no track */
void rho_tracker_claim(struct rho_tracker *tracker, struct rho_look *look, struct rho_work *work);

/* update.c: tracks take the plots that they were assigned */
void rho_tracker_update(struct rho_tracker *tracker, struct rho_look *look, struct rho_work *work);

/*
 * age.c: counts misses, confirms and ends tracks; rho_tracker_confirm_or_end_track confirms or ends
 * one track whose miss was counted before.
 */
void rho_tracker_age(struct step *step);
void rho_tracker_confirm_or_end_track(struct step *step, struct rho_track *track, int is_missed,
                                      const struct rho_track_limits *limits);

/* initiate.c: tracks start from unclaimed plots; the clutter map and counts are updated */
void rho_tracker_initiate(struct step *step);
/* bearing_initiation.c: tracks start from unclaimed bearings */
void rho_tracker_initiate_passive(struct step *step);

/*
 * report.c: merges the hypotheses of each track into one estimate at the step's time; reports
 * fates, counters and tracks, or the tracks alone.
 */
void rho_tracker_merge_estimates_per_track(struct rho_tracker *tracker,
                                           const struct rho_look *look);
void rho_tracker_report(struct step *step);
void rho_tracker_report_tracks(const struct step *step);

/*
 * claim_large_scan_in_parts.c: claims and updates by a scan of more than RHO_MAX_PLOTS plots, in
 * parts
 */
void rho_tracker_claim_and_update_in_plot_parts(struct step *step);

/* merged_plots.c: pairs of tracks share merged plots, before other tracks take their plots */
void rho_tracker_share_merged_plots(struct rho_tracker *tracker, const struct rho_look *look);

/* split_bodies.c: a track whose body is surely two targets becomes two tracks */
void rho_tracker_split_tracks_of_two_targets(struct step *step, const struct rho_scan *scan);

/*
 * admit_started_track.c: adds a started track to the tracker's; returns 0 where there is no room,
 * and the track has ended. A full tracker ends its lowest tentative track for a track of a higher
 * score.
 */
int rho_tracker_admit_track(struct step *step, struct rho_track *track,
                            const struct rho_track_limits *limits);
/*
 * Makes *step from the newest step and its report, for changes of tracks between two steps. STATE:
 * the tracker has made no step, or the report is of another one.
 */
enum rho_status rho_tracker_reopen_finished_step(struct rho_tracker *tracker,
                                                 struct rho_report *report, struct step *step);
/* Copies a candidate's plots from the window in the order of their scans; returns their number. */
unsigned rho_tracker_copy_candidate_plots(struct rho_window *window,
                                          const struct rho_candidate *candidate,
                                          struct rho_track_plot *plots);
/* Without an initiator nothing holds unclaimed plots and bearings: HELD becomes NO_ROOM. */
void rho_tracker_mark_unclaimed_no_room(const struct rho_look *look);

#endif
