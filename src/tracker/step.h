/* SPDX-License-Identifier: MIT */
/*
 * step: one step, and what ends its tracks. Private to the rooms from src/tracker on.
 */
#ifndef RHOTRACK_STEP_H
#define RHOTRACK_STEP_H

#include "look.h"

/* One step: predict, then for each look claim and update, then age, initiate and report. */
struct step {
    struct rho_tracker *tracker;
    struct rho_report *report;
    struct rho_passive *passive;   /* starts tracks from bearings; NULL: none, or plots */
    const struct rho_frame *frame; /* the frame of bearings; NULL: plots */
    struct rho_look look;          /* the look that is claimed now */
    const struct rho_scan *whole;  /* with bodies: the scan whose plots were grouped */
    struct rho_scan grouped;       /* with bodies: a plot for each group */
    struct rho_work work;
    float needed_nat; /* evidence that a new track needs to be confirmed; 0: none */
    float miss_nat;   /* evidence that a miss takes from a new track */
    /* plots beyond RHO_MAX_PLOTS that were claimed, and that are invalid */
    uint32_t num_beyond_claimed, num_beyond_invalid;
};

/*
 * out_of_sequence_by_retrodiction.c (RHO_SECTORS): scans older than the newest step that may still
 * update tracks
 */
void rho_tracker_set_late_max_default(struct rho_tracker_config *config);
int rho_tracker_is_late_max_usable(const struct rho_tracker_config *config);
/* True of an out-of-sequence scan within late_max_s that is not its sensor's newest one again. */
int rho_tracker_accepts_late_scan(const struct rho_look *look);
/* Stores the track's time before an out-of-sequence scan moves the track back. */
void rho_tracker_keep_track_time(struct rho_track *track);
int rho_tracker_is_sound_stored_track_time(const struct rho_track *track);
/*
 * After an out-of-sequence scan: tracks, step and report return to the newest time, and tracks that
 * cannot return end. 0: the scan was in sequence.
 */
int rho_tracker_return_to_newest_time(struct step *step);

/* confirm_and_end_track.c: limits of score and misses that confirm and end the tracks of a step */
struct rho_track_limits rho_tracker_track_limits(const struct rho_look *look);
/* Confirms a track, makes it tentative or ends it, and counts it. */
void rho_tracker_apply_thresholds(struct step *step, struct rho_track *track,
                                  const struct rho_track_limits *limits);
/* Ends a track: it stays in the table as FREE until rho_tracker_remove_ended_tracks. */
void rho_tracker_end_track(struct step *step, struct rho_track *track);
/* Removes the FREE tracks from the table, with their rows of the assignment. */
void rho_tracker_remove_ended_tracks(struct rho_tracker *tracker);

/* evidence_after_short_lived_tracks.c: more evidence for new tracks where many end early */
#define RHO_ESTABLISHED_HITS 16
static inline int rho_tracker_has_hits_to_be_established(const struct rho_track *track)
{
    return track->hits >= RHO_ESTABLISHED_HITS;
}
/* Fades the counts of tracks, learns the manoeuvre interval, and sets needed_nat and miss_nat. */
void rho_tracker_fade_track_counts_set_evidence_need(struct step *step);
/* True of a track that is not established and has less evidence than needed_nat. */
int rho_tracker_lacks_evidence(const struct step *step, const struct rho_track *track);
/* Counts a track that becomes established in this step. */
void rho_tracker_count_if_newly_established(struct rho_tracker *tracker,
                                            const struct rho_track *track);
/* Counts an ended track if it ended early. */
void rho_tracker_count_if_ended_early(struct step *step, const struct rho_track *track);

/*
 * manoeuvre_interval_learning.c: mean time between manoeuvres; learned from established tracks over
 * dt_s
 */
void rho_tracker_learn_manoeuvre_interval(struct rho_tracker *tracker, const struct rho_look *look,
                                          float dt_s);
/* Sets the mean time between manoeuvres to its default where no scan came for long. */
void rho_tracker_reset_manoeuvre_interval_after_silence(struct rho_tracker *tracker,
                                                        int64_t time_us);

/*
 * end_unobserved_tracks.c: tracks that no sensor looks at. Returns 1 where a track is to end, as it was not observed for too long. Also smooths the time
 * between the track's hits, and lowers its score where it is doubtful after a long silence.
 */
int rho_tracker_update_and_test_unobserved(const struct rho_look *look, struct rho_track *track,
                                           int is_missed, const struct rho_track_limits *limits);
/* True where sigma of the track's place exceeds the maximum range of its last sensor. */
int rho_tracker_is_place_too_uncertain(const struct rho_tracker *tracker,
                                       const struct rho_track *track);

/* tracker_setup.c: the filter that a configuration gives to tracks of plots */
enum rho_track_filter rho_tracker_filter_of_config(const struct rho_tracker_config *config);
int rho_tracker_is_usable_config(const struct rho_tracker_config *config);

/*
 * reflectors.c (RHO_MAX_REFLECTORS): gives unclaimed plots at the mirror images of tracks the fate
 * GHOST, before new tracks start
 */
void rho_tracker_mark_image_plots_as_ghosts(const struct rho_look *look, struct rho_work *work);
/* Ends tracks that move as the mirror image of another track, after new tracks have started. */
void rho_tracker_end_image_tracks(struct step *step);
int rho_tracker_has_sound_reflectors(const struct rho_tracker *tracker);

/*
 * excluded_areas.c (RHO_MAX_EXCLUDED_AREAS): gives unclaimed plots in excluded areas the fate GHOST
 */
void rho_tracker_mark_excluded_plots_as_ghosts(struct rho_tracker *tracker,
                                               const struct rho_look *look, struct rho_work *work);
int rho_tracker_is_in_excluded_area(const struct rho_look *look, uint32_t plot);
static inline int rho_tracker_is_plot_excluded(const struct rho_look *look, uint32_t plot)
{
    return RHO_MAX_EXCLUDED_AREAS > 0 && rho_tracker_is_in_excluded_area(look, plot);
}
int rho_tracker_has_sound_excluded_areas(const struct rho_tracker *tracker);

#endif
