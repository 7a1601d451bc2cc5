/* SPDX-License-Identifier: MIT */
/*
 * phases: the phases of a step, in their order, each a file; step.c calls them for a scan of plots,
 * bearing_step.c for one of bearings. No phase calls an earlier one. Private to src/step.
 */
#ifndef RHOTRACK_PHASES_H
#define RHOTRACK_PHASES_H

#include "../bodies/bodies.h"
#include "../tracker/clutter.h"
#include "../tracker/plots.h"
#include "../tracker/sensors.h"
#include "../tracker/step.h"

/*
 * begin.c: clears the report, and counts the scan. Returns 0 where the inputs are too old for the
 * tracker: their fates are then STALE, and of the later phases only rho_step_report follows.
 */
int rho_step_begin(struct step *step);
/* Sets the step's motion model, the filter of new tracks, and the volumes of clutter densities. */
void rho_step_set_model(struct rho_tracker *tracker, struct rho_look *look);
int rho_step_is_usable_time(int64_t time_us);
/* True where no step of the tracker has a later time. */
int rho_step_is_newest(const struct rho_tracker *tracker, int64_t time_us);

/* predict.c: moves the tracks that a look can see to the time of the step */
void rho_step_predict(struct step *step);

/* looks.c: opens the look of a scan: its sensor with pd, notch and noise */
void rho_step_open_scan(struct rho_tracker *tracker, struct rho_look *look);
/* Claims and updates by the scan, in parts if it is large. */
void rho_step_take_scan(struct step *step);
/* claim.c: gates a look's plots, and assigns them to tracks; changes no track */
void rho_step_claim(struct rho_tracker *tracker, struct rho_look *look, struct rho_work *work);
/* update.c: tracks take the plots that they were assigned */
void rho_step_update(struct rho_tracker *tracker, struct rho_look *look, struct rho_work *work);

/*
 * bearing_looks.c: opens the look of a scan of bearings; claims and updates by it. *sensor: gets
 * its sensor; owners: RHO_MAX_BEARINGS, get the tracks of the bearings that are claimed.
 */
void rho_step_take_bearings(struct step *step, struct rho_sensor *sensor,
                            struct rho_batch_owner *owners);

/* age.c: counts misses, confirms and ends tracks */
void rho_step_age(struct step *step);

/* initiate.c: tracks start from unclaimed plots; the clutter map and counts are updated */
void rho_step_initiate(struct step *step);
/* bearing_initiation.c: tracks start from bearings, and give way to better ones */
void rho_step_initiate_bearings(struct step *step, const struct rho_batch_owner *owners);

/* settle.c: brings the tracks to the time that the report has */
void rho_step_settle(struct step *step);

/* report.c: merges each track's hypotheses at the step's time; reports all, or the tracks alone */
void rho_step_merge_estimates(const struct step *step);
void rho_step_report(const struct step *step);
void rho_step_report_tracks(const struct step *step);

/* targets.c: which plots are one target, or two? Before claims, at the update, after starts */
void rho_targets_group_plots(struct step *step);
void rho_targets_share_plots(struct rho_tracker *tracker, const struct rho_look *look);
void rho_targets_split(struct step *step);

/*
 * removal.c: must this track or plot go? Second tracks, once plots are claimed; each track as it
 * ages, its miss counted; plots, before starts; tracks of images, after starts.
 */
void rho_removal_of_duplicates(struct step *step);
void rho_removal_of_track(struct step *step, struct rho_track *track);
void rho_removal_of_plots(struct rho_tracker *tracker, const struct rho_look *look,
                          struct rho_work *work);
void rho_removal_of_images(struct step *step);

/* speed_limits.c: 1 where a track is surely slower than v_min_mps: it follows a standing object */
int rho_speed_is_slow(const struct rho_tracker_config *config, const struct rho_track *track);
/* Counts successive updates that leave a track faster than any target. 1: enough to end it. */
int rho_speed_count_fast(const struct rho_tracker_config *config, struct rho_track *track);

/* merged_plots.c: pairs of tracks share merged plots, before other tracks take their plots */
void rho_step_share_merged(struct rho_tracker *tracker, const struct rho_look *look);

/* split_bodies.c: a track whose body is surely two targets becomes two tracks */
void rho_step_split_bodies(struct step *step, const struct rho_scan *scan);

/* track_starts.c: ends the track of a row, and closes the gap. */
void rho_step_end_track(struct step *step, unsigned row);
/*
 * track_starts.c: adds a started track to the tracker's; returns 0 where there is no room, and the
 * track has ended. Of a full tracker the tentative track that exists least ends for a likelier one.
 */
int rho_step_admit(struct step *step, struct rho_track *track, int32_t confirm_mnat);
/* Puts a track, begun anew, into the place of the one with its identity. */
void rho_step_restart(struct step *step, unsigned row, struct rho_track *track,
                      int32_t confirm_mnat);
/*
 * Makes *step from the newest step and its report, for changes of tracks between two steps. STATE:
 * the tracker has made no step, or the report is of another one.
 */
enum rho_status rho_step_reopen(struct rho_tracker *tracker, struct rho_report *report,
                                struct step *step);
/* Copies a candidate's plots from the window in the order of their scans; returns their number. */
unsigned rho_step_candidate_plots(struct rho_window *window, const struct rho_candidate *candidate,
                                  struct rho_track_plot *plots);
/* Gives all inputs of the look with one fate another. */
void rho_step_replace_fates(const struct rho_look *look, enum rho_fate from, enum rho_fate to);

#endif
