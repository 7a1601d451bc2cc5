/* SPDX-License-Identifier: MIT */
/* step: one step, and what ends its tracks. Private to the rooms from src/tracker on. */
#ifndef RHOTRACK_STEP_H
#define RHOTRACK_STEP_H

#include "look.h"

/* One step: predict, then for each look claim and update, then age, initiate and report. */
struct step {
    struct rho_tracker *tracker;
    struct rho_report *report;
    struct rho_passive *passive;  /* starts tracks from bearings; NULL: none, or plots */
    struct rho_look look;         /* the look that is claimed now */
    const struct rho_scan *whole; /* with bodies: the scan whose plots were grouped */
    struct rho_scan *grouped;     /* with bodies: room for a scan of a plot for each group */
    struct rho_work work;
    float miss_nat;   /* evidence that a miss takes from a track */
    float needed_nat; /* evidence that a new track needs to be confirmed; 0: none */
    /* plots beyond RHO_MAX_PLOTS that were claimed, and that are invalid */
    uint32_t num_beyond_claimed, num_beyond_invalid;
};

/* retrodiction.c (RHO_SECTORS): scans older than the newest step that may still update tracks */
/* True of an out-of-sequence scan within late_max_s that is not its sensor's newest one again. */
int rho_retrodiction_accepts(const struct rho_look *look);
/* Then tracks, step and report return to the newest time, or end. 0: the scan was in sequence. */
int rho_retrodiction_return(struct step *step);

/* track_life.c: probability that a new track of this score exists, shown from confirm_mnat on */
float rho_life_at_start(int32_t score_mnat, int32_t confirm_mnat);
/* The life of a new track begins. */
void rho_life_begin(struct rho_track *track, int64_t time_us, int32_t confirm_mnat);
/* Least score of tracks that were never confirmed. */
int32_t rho_life_least_mnat(const struct rho_tracker *tracker);
/*
 * Lets time go by until the look's: targets may have gone, become hidden or visible. Tracks in the
 * look's notch are marked before.
 */
void rho_life_pass(struct rho_tracker *tracker, const struct rho_look *look);
/* Weighs what the look has told of each track. */
void rho_life_weigh(struct rho_tracker *tracker, const struct rho_look *look);
/* Confirms a track, makes it tentative or ends it, and counts it. */
void rho_life_apply(const struct step *step, struct rho_track *track, int32_t confirm_mnat);
/* Makes tracks tentative whose place is so uncertain that clutter would fill it. */
void rho_life_doubt_places(struct rho_tracker *tracker, const struct rho_look *look);
int rho_life_is_sound(const struct rho_track *track);
/* Ends a track: it stays in the table as FREE until rho_life_remove_ended. */
void rho_life_end(const struct step *step, struct rho_track *track);
/* Row of the living track with this identity; RHO_MAX_TRACKS: none. */
unsigned rho_tracker_find_row(const struct rho_tracker *tracker, uint32_t track_id);
/* Removes the FREE tracks from the table, with their rows of the assignment. */
void rho_life_remove_ended(struct rho_tracker *tracker);

/* seldom_seen.c: more evidence for new tracks where many objects are seldom seen */
#define RHO_ESTABLISHED_HITS 16
static inline int rho_life_is_established(const struct rho_track *track)
{
    return track->hits >= RHO_ESTABLISHED_HITS;
}
/* Fades the counts of tracks, learns the manoeuvre interval, and sets needed_nat and miss_nat. */
void rho_evidence_update(struct step *step);
/* True of a track that has less evidence than needed_nat. */
int rho_evidence_is_lacking(const struct step *step, const struct rho_track *track);
/* Counts a track that becomes established in this step, or is found to be seldom seen. */
void rho_evidence_count(const struct step *step, struct rho_track *track);

/* manoeuvre_interval.c: mean time between manoeuvres; learned from established tracks over dt_s */
void rho_manoeuvres_learn(struct rho_tracker *tracker, const struct rho_look *look, float dt_s);
/* Sets the mean time between manoeuvres to its default where no scan came for long. */
void rho_manoeuvres_reset(struct rho_tracker *tracker, int64_t time_us);

/*
 * unseen_tracks.c: 1 where a track is to end, as no sensor observed it for too long. Smooths the
 * time between its hits.
 */
int rho_unseen_update(const struct rho_look *look, struct rho_track *track);
/* Scan interval of the slowest sensor that covers a track or saw it last; 0: unknown. */
float rho_unseen_interval_s(const struct rho_look *look, const struct rho_track *track);
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
/*
 * Reflects a state and its covariance in a wall. Returns 0, with *image undefined, where the line
 * of sight to the image does not cross the wall, lengthened by the slack at both ends.
 *   sensor      the sensor that looks; NULL: at the origin
 *   crossing_m  place along the wall, from its beginning, where the line of sight crosses it
 */
int rho_reflector_mirror_state(const struct rho_reflector *reflector,
                               const struct rho_sensor *sensor, float slack_m,
                               const struct rho_kalman *of, struct rho_kalman *image,
                               float *crossing_m);

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
