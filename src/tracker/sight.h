/* SPDX-License-Identifier: MIT */
/* sight: would this look see this track? Private to the rooms from src/tracker on. */
#ifndef RHOTRACK_SIGHT_H
#define RHOTRACK_SIGHT_H

#include "look.h"

/* ln of the probabilities that the sensor detects a target at the track's place or misses it. */
struct detection {
    float log_pd, log_miss;
};

/*
 * counted_pd.c: sets log_pd and log_miss by the look's sensor, or the default pd, and by what was
 * counted of it. row: NULL, nothing.
 */
void rho_pd_open(struct rho_look *look, const struct rho_tracker_sensor *row);
/* P_D of the sensor that sees most: the look's, or another's that has shown more. */
float rho_pd_most(const struct rho_look *look);
/* Counts a look at a track, `visible` of which a hit is expected, as a hit by a probability. */
void rho_pd_count(struct rho_tracker_sensor *row, float visible, float hit);
/* The same of plots, by the track's place, too; ratio: G of track_life.c, which tells a hit. */
void rho_pd_count_place(const struct rho_look *look, struct rho_track *track, float visible,
                        float ratio);
/* Takes a track's last misses back from its place: it ends, and its target was probably gone. */
void rho_pd_take_back(const struct rho_look *look, const struct rho_track *track);
/* Whether a miss of the track tells that it stands on; *miss: how much, as of one in a notch. */
int rho_pd_miss_at_rest(const struct rho_look *look, const struct rho_track *track,
                        struct rho_notch_look *miss);
/* Detection at a track's place, outside of the notch. */
struct detection rho_pd_detection(const struct rho_look *look, const struct rho_track *track);

/* Limit of the evidence of one look: beyond it nothing changes, and powers stay finite. */
#define RHO_LOOK_LIMIT_NAT 30.0f

/* sight.c */
/* True where the look may see a track at all; bearings: every track that is not frozen. */
int rho_look_may_see(const struct rho_look *look, const struct rho_track *track);
/* True where a track without a plot in this scan counts a miss: sensor not suspect, gate passed. */
int rho_look_may_miss(const struct rho_look *look, const struct rho_track *track);
/* Detection of the track's target; of one that is surely visible. */
struct detection rho_look_detection(const struct rho_look *look, const struct rho_track *track);
struct detection rho_look_visible(const struct rho_look *look, const struct rho_track *track);

/* track_life.c: detection of a track whose target may be hidden */
struct detection rho_life_detection(const struct rho_track *track, struct detection visible);

/* coverage.c: true where a plot, within its noise, is in the stated coverage; NULL covers all */
int rho_coverage_holds_plot(const struct rho_sensor *sensor, const struct rho_plot *plot,
                            uint32_t measures);
/* True where a bearing is in the sensor's stated sector, or nearer to it than the margin. */
int rho_coverage_holds_bearing(const struct rho_sensor *sensor, float bearing_rad,
                               float margin_rad);
/* True where the scan may see a track, by sector and range, with a margin. */
int rho_coverage_may_see(const struct rho_look *look, const struct rho_track *track);
/* True where the scan may see the track of this row, as found when tracks were predicted. */
static inline int rho_look_has_in_view(const struct rho_look *look, unsigned row)
{
    return (look->in_view[row / 32] >> row % 32 & 1u) != 0;
}
/* True where the sensor, looking at this sector, covers the track's place. */
int rho_coverage_holds_track(const struct rho_look *look, float sector_from_rad,
                             float sector_to_rad, const struct rho_track *track);

/* sector_turns.c (RHO_SECTORS): how the sectors of one turn follow each other */
#define RHO_TRACKER_SILENT_US 60000000 /* sensors that have been silent longer are ignored */
int rho_turn_is_sound(const struct rho_tracker_look *health);
/* Records the scan's sector and time for its sensor, and finds which way the antenna turns. */
void rho_turn_note_look(struct rho_tracker *tracker, struct rho_look *look);
/* Stores in a track with a plot of this scan that the scan's sensor saw it last. */
void rho_turn_note_seen(const struct rho_look *look, struct rho_track *track);
/* True of the two sensors that saw the track last. */
int rho_turn_was_seen_by(const struct rho_track *track, int32_t sensor_id);
/* Sets the tracker's thresholds: lowest start and highest confirm threshold of all sensors. */
void rho_turn_merge_thresholds(struct rho_tracker *tracker, const struct rho_look *look);
/* True where the track claimed a plot in the previous sector of the same turn of the antenna. */
int rho_turn_saw_before(const struct rho_look *look, const struct rho_track *track);
/* True where the antenna has passed the track's gate, or, if not turning, the scan covers it. */
int rho_turn_has_passed(const struct rho_look *look, const struct rho_track *track);
/* Number of scans of this sector's width in one turn of the antenna; 1 where it does not turn. */
float rho_turn_num_scans(const struct rho_look *look);

/* blind_looks.c (RHO_DOPPLER_NOTCH): blind_percent of tracks in view, before plots are scored */
void rho_notch_mark_tracks(struct rho_tracker *tracker, struct rho_look *look);
/* Detection of a track that may be in the sensor's notch; elsewhere: outside of the notch. */
struct detection rho_notch_detection(const struct rho_look *look, const struct rho_track *track,
                                     struct detection elsewhere);
/* True where at least half of the looks at the track are blind: no plot is no miss then. */
static inline int rho_notch_is_mostly_blind(const struct rho_track *track)
{
    return RHO_DOPPLER_NOTCH && track->blind_percent >= 50;
}
/* After a blind look without a plot: the track coasts, and counts as seen, not as missed. */
void rho_notch_coast(const struct rho_look *look, struct rho_track *track);

#endif
