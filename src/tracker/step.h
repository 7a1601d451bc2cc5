/* SPDX-License-Identifier: MIT */
/* step: one step, and what ends its tracks. Private to the rooms from src/tracker on. */
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
    struct rho_scan *grouped;      /* with bodies: room for a scan of a plot for each group */
    struct rho_work work;
    float needed_nat; /* evidence that a new track needs to be confirmed; 0: none */
    float miss_nat;   /* evidence that a miss takes from a new track */
    /* plots beyond RHO_MAX_PLOTS that were claimed, and that are invalid */
    uint32_t num_beyond_claimed, num_beyond_invalid;
};

/* retrodiction.c (RHO_SECTORS): scans older than the newest step that may still update tracks */
/* True of an out-of-sequence scan within late_max_s that is not its sensor's newest one again. */
int rho_retrodiction_accepts(const struct rho_look *look);
/* Then tracks, step and report return to the newest time, or end. 0: the scan was in sequence. */
int rho_retrodiction_return(struct step *step);

/* track_life.c: limits of score and misses that confirm and end the tracks of a step */
struct rho_track_limits rho_life_limits(const struct rho_look *look);
/* Confirms a track, makes it tentative or ends it, and counts it. */
void rho_life_apply(const struct step *step, struct rho_track *track,
                    const struct rho_track_limits *limits);
/* Ends a track: it stays in the table as FREE until rho_life_remove_ended. */
void rho_life_end(const struct step *step, struct rho_track *track);
/* Removes the FREE tracks from the table, with their rows of the assignment. */
void rho_life_remove_ended(struct rho_tracker *tracker);

/* early_ends.c: more evidence for new tracks where many end early */
#define RHO_ESTABLISHED_HITS 16
static inline int rho_life_is_established(const struct rho_track *track)
{
    return track->hits >= RHO_ESTABLISHED_HITS;
}
/* Fades the counts of tracks, learns the manoeuvre interval, and sets needed_nat and miss_nat. */
void rho_evidence_update(struct step *step);
/* True of a track that is not established and has less evidence than needed_nat. */
int rho_evidence_is_lacking(const struct step *step, const struct rho_track *track);
/* Counts a track that becomes established in this step. */
void rho_evidence_count_established(struct rho_tracker *tracker, const struct rho_track *track);
/* Counts an ended track if it ended early. */
void rho_evidence_count_ended(const struct step *step, const struct rho_track *track);

/* manoeuvre_interval.c: mean time between manoeuvres; learned from established tracks over dt_s */
void rho_manoeuvres_learn(struct rho_tracker *tracker, const struct rho_look *look, float dt_s);
/* Sets the mean time between manoeuvres to its default where no scan came for long. */
void rho_manoeuvres_reset(struct rho_tracker *tracker, int64_t time_us);

/*
 * unseen_tracks.c: 1 where a track is to end, as no sensor observed it for too long. Smooths the
 * time between its hits, and lowers its score where it is doubtful after a long silence.
 */
int rho_unseen_update(const struct rho_look *look, struct rho_track *track, int is_missed,
                      const struct rho_track_limits *limits);
/* True where sigma of the track's place exceeds the maximum range of its last sensor. */
int rho_unseen_is_lost(const struct rho_tracker *tracker, const struct rho_track *track);

/* tracker_setup.c: the filter that a configuration gives to tracks of plots */
enum rho_track_filter rho_tracker_filter(const struct rho_tracker_config *config);
int rho_tracker_is_usable(const struct rho_tracker_config *config);

/* reflectors.c (RHO_MAX_REFLECTORS): unclaimed plots at images of tracks become GHOST */
void rho_images_mark_plots(const struct rho_look *look, struct rho_work *work);
/* Ends tracks that move as the mirror image of another track, after new tracks have started. */
void rho_images_end_tracks(struct step *step);
int rho_images_are_sound(const struct rho_tracker *tracker);

/* excluded_areas.c (RHO_MAX_EXCLUDED_AREAS): unclaimed plots in excluded areas become GHOST */
void rho_areas_mark_plots(struct rho_tracker *tracker, const struct rho_look *look,
                          struct rho_work *work);
int rho_areas_hold_plot(const struct rho_look *look, uint32_t plot);
static inline int rho_areas_exclude(const struct rho_look *look, uint32_t plot)
{
    return RHO_MAX_EXCLUDED_AREAS > 0 && rho_areas_hold_plot(look, plot);
}
int rho_areas_are_sound(const struct rho_tracker *tracker);

#endif
