/* SPDX-License-Identifier: MIT */
/*
 * The tracker's inside: what the phases of one step share. Private to src/tracker/tracker*.c.
 */
#ifndef RHOTRACK_TRACKER_STEP_H
#define RHOTRACK_TRACKER_STEP_H

#include "rhotrack/tracker.h"

#define LOG_TWO_PI 1.83787707f

/* The least side of an area that clutter is spread over. */
#define RHO_CLUTTER_SIDE_MIN_M 1000.0f

/* The work of a phase, of which each track that waits has a share. */
struct work_share {
    uint32_t end, kept; /* units: until where; for each that waits */
    unsigned waiting;
};

/* Limits of places, inclusive. */
struct plot_box {
    float x_min_m, x_max_m, y_min_m, y_max_m;
};

#define RHO_PLOT_BOXES 8

struct step {
    struct rho_tracker *tracker;
    int64_t time_us;
    /* a scan of plots, and who starts tracks of them, or NULL */
    const struct rho_scan *scan;
    struct rho_initiator *initiator;
    /* or a frame of bearings, and who starts tracks of these, or NULL */
    const struct rho_frame *frame;
    struct rho_passive *passive;
    struct rho_report *report;
    const struct rho_sensor *sensor;     /* that looks; NULL: not in the table */
    struct rho_tracker_learned *learned; /* of it; NULL: likewise, or of a frame */
#if RHO_SECTORS
    int is_doubted; /* the sensor contradicts the others */
    uint16_t look;  /* count of the sensor's scans; 0: not known */
    float
        turning; /* the scan is the sector after the one before: 1 counter-clockwise, -1 clockwise; else 0 */
#endif
    int is_late;         /* older than what was stepped before */
    uint32_t num_inputs; /* plots or bearings */
    uint32_t num_gated;  /* of them: have a place in report->fates */
    /* of the plots that have none: claimed, invalid */
    uint32_t num_beyond_claimed, num_beyond_invalid;
    int has_more_parts; /* of the scan: tracks that have no plot yet may have one there */
    /* of a part beyond the first: its own density, and the whole scan's plots over those of the first; 0: the first */
    float part_per_m2, part_share;
    /* of the scan's valid plots, the most: noise on any axis, own time either way */
    float sigma_max_m, offset_max_s;
    uint32_t work, plots_not_tried; /* units; plots */
    struct work_share share;        /* of the phase that tracks are in */
    int is_partial;
    /* bit i: track i is within the scan's reach, or there is no scan but a frame */
    uint32_t reached[(RHO_MAX_TRACKS + 31) / 32];
#if RHO_PLOT_STRIPS == 1
    struct plot_box boxes[RHO_PLOT_BOXES]; /* of plots that follow each other, as many in each */
    uint32_t plots_of_box;
#endif
    struct rho_track_model model;
    float log_pd;
    float log_miss;  /* ln(1 - pd) */
    float asked_nat; /* evidence that a young track needs to be believed; 0: none is asked */
    float miss_nat;  /* what a miss takes from it */
    /* ln of what clutter is spread over: RHO_CLUTTER_HEIGHT_M; the range rates that a target may have, m/s */
    float log_height, log_rates;
#if RHO_AMBIGUOUS_RANGE_RATES
    float log_range_rates; /* of them, those that the sensor tells apart */
#endif
    float range_rates_mps; /* these, not their ln */
};

/* ln of what clutter's range rates are spread over, m/s. */
static inline float rho_tracker_log_range_rates(const struct step *step)
{
#if RHO_AMBIGUOUS_RANGE_RATES
    return step->log_range_rates;
#else
    return step->log_rates;
#endif
}

/* tracker.c: what a step may be asked */
int rho_tracker_is_ready(const struct rho_tracker *tracker);
int rho_tracker_is_usable(const struct rho_tracker_config *config);
int rho_tracker_is_usable_sensor(const struct rho_sensor *sensor);
/* The filter of tracks of plots. */
enum rho_track_filter rho_tracker_filter_of(const struct rho_tracker_config *config);
int rho_tracker_is_time(int64_t time_us);
int rho_tracker_is_late(const struct rho_tracker *tracker, int64_t time_us);

/* NULL: not in the table */
const struct rho_sensor *rho_tracker_find_sensor(const struct rho_tracker *tracker,
                                                 int32_t sensor_id);

/* Which plots can be believed: their fates. */
void rho_tracker_judge_plots(struct step *step);

/* The pd of the sensor that looks. */
void rho_tracker_set_pd(struct step *step);

/* A count of clutter goes into its smoothed mean. */
void rho_tracker_smooth(float *mean, float newest);

/* A report begins; 0 where the inputs are late, and have their fates. It ends with rho_tracker_close in any case. */
int rho_tracker_open(struct step *step);
void rho_tracker_close(struct step *step);

/*
 * tracker_learn.c: noise and pd as tracks show them. Before plots are gated the sensor's noise is
 * set; between assignment and update it is learned; ln of what a hit and a miss of a track are
 * likely
 */
struct odds {
    float log_pd, log_miss;
};
void rho_tracker_set_noise(struct step *step);
/* What is learned of the sensor's noise, times so much, as the sensor's own. */
void rho_tracker_use_noise(const struct step *step, float doubt, struct rho_sensor *sensor);
void rho_tracker_learn(struct step *step);
struct odds rho_tracker_odds(const struct step *step, const struct rho_track *track);
int rho_tracker_is_sound_learned(const struct rho_tracker_learned *learned);
/* Of the sensor that looks, for its initiator: over all ranges. */
float rho_tracker_mean_pd(const struct step *step);

/* tracker_sector.c: what sectors of a turn are to each other */
#if RHO_SECTORS
/* Who has said nothing for so long has no say any more. */
#define RHO_TRACKER_SILENT_US 60000000

/* What is known of the sensor that looks; NULL: nothing. */
struct rho_tracker_look *rho_tracker_own_look(struct step *step);
void rho_tracker_forget_look(struct rho_tracker *tracker, int32_t sensor_id);

/* The track has a plot of this scan, or has not. */
void rho_tracker_note_sight(const struct step *step, struct rho_track *track);

/*
 * tracker_doubt.c: before its plots are gated, how many times its sigmas count; and between
 * assignment and update: whether the sensor agrees with others
 */
float rho_tracker_weigh_sensor(struct step *step);
void rho_tracker_watch(struct step *step);
/* The track is known from the sensor's word alone, which is doubted. */
static inline int rho_tracker_is_hearsay(const struct step *step, const struct rho_track *track)
{
    return step->is_doubted && !track->is_shared;
}

void rho_tracker_note_look(struct step *step);
/* The initiator's thresholds are the tracker's; beside them, those of the other sensors'. */
void rho_tracker_note_thresholds(struct step *step);
/* tracker_late.c: scans that are older than what was stepped, and may still update tracks */
int rho_tracker_is_late_usable(const struct rho_tracker_config *config);
int rho_tracker_takes_late(const struct step *step);
void rho_tracker_begin_late(struct step *step);
static inline void rho_tracker_note_ahead(struct rho_track *track)
{
    track->ahead_us = track->time_us;
}
void rho_tracker_end_late(struct step *step);
/* The track took a plot in the sector before: the antenna is still at the same pass. */
int rho_tracker_was_seen(const struct step *step, const struct rho_track *track);
/* The antenna has passed all of the track's gate in this scan, or the sensor looked there at once. */
int rho_tracker_has_passed(const struct step *step, const struct rho_track *track);
/* How many such scans make a turn, where they do. */
float rho_tracker_turns(const struct step *step);
#else
static inline void rho_tracker_note_look(struct step *step)
{
    (void)step;
}

static inline void rho_tracker_note_thresholds(struct step *step)
{
    (void)step;
}

static inline float rho_tracker_weigh_sensor(struct step *step)
{
    (void)step;
    return 1.0f;
}

static inline void rho_tracker_forget_look(struct rho_tracker *tracker, int32_t sensor_id)
{
    (void)tracker, (void)sensor_id;
}

static inline void rho_tracker_note_sight(const struct step *step, struct rho_track *track)
{
    (void)step, (void)track;
}

static inline void rho_tracker_watch(struct step *step)
{
    (void)step;
}

static inline int rho_tracker_is_hearsay(const struct step *step, const struct rho_track *track)
{
    (void)step, (void)track;
    return 0;
}

static inline int rho_tracker_is_late_usable(const struct rho_tracker_config *config)
{
    (void)config;
    return 1;
}

static inline int rho_tracker_takes_late(const struct step *step)
{
    (void)step;
    return 0;
}

static inline void rho_tracker_begin_late(struct step *step)
{
    (void)step;
}

static inline void rho_tracker_note_ahead(struct rho_track *track)
{
    (void)track;
}

static inline void rho_tracker_end_late(struct step *step)
{
    (void)step;
}

static inline int rho_tracker_was_seen(const struct step *step, const struct rho_track *track)
{
    (void)step, (void)track;
    return 0;
}

static inline float rho_tracker_turns(const struct step *step)
{
    (void)step;
    return 1.0f;
}
#endif

/* tracker_reach.c: whether a plot may be a target's in the sensor's stated coverage (NULL: not known); a bearing, the noise of which
 * is within the margin; whether the scan can say anything of a track; as found by rho_tracker_predict, by its row */
int rho_tracker_covers(const struct rho_sensor *sensor, const struct rho_plot *plot,
                       uint32_t measures);
int rho_tracker_covers_bearing(const struct rho_sensor *sensor, float bearing_rad,
                               float margin_rad);
int rho_tracker_reaches(const struct step *step, const struct rho_track *track);
int rho_tracker_is_reached(const struct step *step, unsigned row);

/* tracker_unseen.c: a sensor's scan is noted; and a track, once a step: true where it was not seen for too long */
void rho_tracker_forget_pace(struct rho_tracker *tracker, int32_t sensor_id);
void rho_tracker_note_pace(struct rho_tracker *tracker, const struct rho_sensor *sensor,
                           int64_t time_us, float sector_from_rad, float sector_to_rad);
int rho_tracker_is_long_unseen(const struct step *step, struct rho_track *track, int is_missed,
                               const struct rho_track_limits *limits);
/* The track's place is not known to a part of what its sensor sees. */
int rho_tracker_is_nowhere(const struct step *step, const struct rho_track *track);

/* tracker_calm.c: what grown tracks did since the last step, and so how calm targets are */
void rho_tracker_learn_calm(struct step *step, float dt_s);
void rho_tracker_forget_calm(struct rho_tracker *tracker, int64_t time_us);

/* A track of so many hits has grown up. */
#define RHO_GROWN_HITS 16

/* tracker_young.c: what young tracks are asked for, found once a step; tracks that grow up, and that end */
void rho_tracker_weigh_youth(struct step *step);
int rho_tracker_is_grown(const struct rho_track *track);
int rho_tracker_is_too_young(const struct step *step, const struct rho_track *track);
void rho_tracker_note_growth(struct step *step, const struct rho_track *track);
void rho_tracker_note_death(struct step *step, const struct rho_track *track);

/*
 * tracker_work.c: which of the plots in its reach a track has the time to weigh. A phase begins;
 * then for each track that waits a choice is made: where there may be more plots than `most`, all
 * in reach are noted, and the choice is settled
 */
#define RHO_WORK_OCTAVES 40u
/* Parts of work_max that phases have: of echoes, of claims and of second looks each, of second
 * plots, of the tracks that start. */
#define RHO_WORK_ECHOES_SHARE 8u
#define RHO_WORK_TRACKS_SHARE 4u
#define RHO_WORK_SECOND_SHARE 16u
#define RHO_WORK_STARTS_SHARE 16u
/* Plots that a box passes over are so many a unit. */
#define RHO_WORK_PASSED_A_UNIT 4u
struct plot_choice {
    uint32_t most, units; /* plots; units for each */
    uint32_t in_reach;
    int is_partial;
    unsigned last; /* all plots of the octaves of distance before; of this one: */
    uint32_t of_last;
    uint16_t in_octave[RHO_WORK_OCTAVES];
};
void rho_tracker_begin_work(struct step *step);
/* Another phase, which has such a part of work_max: it spends, and ends where all is spent. */
void rho_tracker_begin_share(struct step *step, uint32_t part);
static inline void rho_tracker_spend(struct step *step, uint32_t units)
{
    step->work = rho_count(step->work, units);
}

/* One that waits does without its share. */
static inline void rho_tracker_waive(struct step *step)
{
    step->share.waiting -= step->share.waiting > 0 ? 1u : 0u;
}

static inline int rho_tracker_is_spent(const struct step *step)
{
    return step->work > step->share.end;
}
struct plot_choice rho_tracker_choose_plots(struct step *step, const struct rho_track *track);
void rho_tracker_note_choice(struct plot_choice *choice, const struct rho_track *track,
                             const struct rho_plot *plot);
void rho_tracker_settle_choice(struct step *step, struct plot_choice *choice);
/* True where the plot is weighed: it costs its units. */
int rho_tracker_takes(struct step *step, struct plot_choice *choice, const struct rho_track *track,
                      const struct rho_plot *plot);
/* For the search. */
uint32_t rho_tracker_work_left(const struct step *step);
/* What the step has done is told. */
void rho_tracker_end_work(struct step *step);

/*
 * tracker_strips.c: the rows of the plots near a place. Those between these limits are among them:
 *     struct plots_near near = rho_tracker_plots_near(step, x_min_m, x_max_m, y_min_m, y_max_m);
 *     for (uint32_t row; rho_tracker_next_plot(step, &near, &row);)
 */
struct plots_near {
    uint32_t next, end; /* places in the order of the strip or box that is looked at */
    unsigned box;       /* the next one */
    struct plot_box within;
};

void rho_tracker_sort_plots(struct step *step);
struct plots_near rho_tracker_plots_near(const struct step *step, float x_min_m, float x_max_m,
                                         float y_min_m, float y_max_m);
#if RHO_PLOT_STRIPS > 1
static inline int rho_tracker_next_plot(const struct step *step, struct plots_near *near,
                                        uint32_t *row)
{
    if (near->next >= near->end) {
        return 0;
    }
    *row = step->tracker->strips.plots[near->next++];
    return 1;
}

/* How many they may be. */
static inline uint32_t rho_tracker_most_near(const struct step *step, const struct plots_near *near)
{
    (void)step;
    return near->end - near->next;
}
#else
int rho_tracker_next_box(const struct step *step, struct plots_near *near);

static inline int rho_tracker_next_plot(const struct step *step, struct plots_near *near,
                                        uint32_t *row)
{
    if (near->next >= near->end && !rho_tracker_next_box(step, near)) {
        return 0;
    }
    *row = near->next++;
    return 1;
}

static inline uint32_t rho_tracker_most_near(const struct step *step, const struct plots_near *near)
{
    (void)near;
    return step->num_gated;
}
#endif

/*
 * tracker_beyond.c: claim and update, of a scan of more than RHO_MAX_PLOTS. What lies beyond so
 * many parts nobody looks at
 */
#define RHO_TRACKER_PARTS_MAX 4u
#if RHO_CLAIMS_BEYOND
void rho_tracker_claim_parts(struct step *step);
#endif

/* tracker_clutter.c: clutter that comes back. Before claims; with the plots that are held; after starts */
#if RHO_MAX_ECHOES > 0
void rho_tracker_look_at_clutter(struct step *step);
/* Of a scan in parts the map has looked at the first alone: the others have no repeats while they are claimed. */
void rho_tracker_use_repeats(struct step *step, int is_first_part);
void rho_tracker_keep_repeats(struct step *step);
void rho_tracker_learn_clutter(struct step *step);
/* ln of how much denser clutter is at this plot than near it. */
float rho_tracker_repeats_nat(const struct step *step, uint32_t row);
/* Density of clutter where the plot is, but never 0: a plot without clutter near it. */
float rho_tracker_believed_density(const struct step *step, const struct rho_plot *plot);
/* What a range rate says that is off from the one expected, over what it says for clutter, which is spread over all rates: half of
 * such rates are as expected, with 1 m/s beside the variance, and half are any. */
float rho_tracker_rate_ratio(const struct step *step, float off_mps, float variance);
/* Where a track starts. */
void rho_tracker_note_place(struct rho_track *track);
/* How far echoes explained the candidate's plots. */
void rho_tracker_note_start(struct step *step, const struct rho_candidate *candidate,
                            struct rho_track *track);
/* It has moved as targets do, and not only from echo to echo. */
static inline int rho_tracker_has_moved(const struct rho_track *track)
{
    return track->has_taken_back;
}
/* tracker_second_plots.c: plots near those that tracks have just claimed are expected, and learned from; a younger track that is
 * the elder's target again ends. Before tracks age */
void rho_tracker_expect_second_plots(struct step *step);
void rho_tracker_forget_second_plots(struct rho_tracker *tracker, int32_t sensor_id);
/* A track has started with the candidate's plots: others near them, in the window, may be its own. */
void rho_tracker_expect_earlier_second_plots(struct step *step,
                                             const struct rho_candidate *candidate);
#else
static inline void rho_tracker_forget_second_plots(struct rho_tracker *tracker, int32_t sensor_id)
{
    (void)tracker, (void)sensor_id;
}

static inline void rho_tracker_expect_second_plots(struct step *step)
{
    (void)step;
}

static inline void rho_tracker_expect_earlier_second_plots(struct step *step,
                                                           const struct rho_candidate *candidate)
{
    (void)step, (void)candidate;
}

static inline int rho_tracker_has_moved(const struct rho_track *track)
{
    (void)track;
    return 1;
}

static inline void rho_tracker_look_at_clutter(struct step *step)
{
    (void)step;
}

static inline void rho_tracker_use_repeats(struct step *step, int is_first_part)
{
    (void)step, (void)is_first_part;
}

static inline void rho_tracker_keep_repeats(struct step *step)
{
    (void)step;
}

static inline void rho_tracker_learn_clutter(struct step *step)
{
    (void)step;
}

static inline void rho_tracker_note_place(struct rho_track *track)
{
    (void)track;
}

static inline void rho_tracker_note_start(struct step *step, const struct rho_candidate *candidate,
                                          struct rho_track *track)
{
    (void)step, (void)candidate, (void)track;
}

static inline float rho_tracker_repeats_nat(const struct step *step, uint32_t row)
{
    (void)step, (void)row;
    return 0.0f;
}
#endif

/* tracker_claim.c: existing tracks take their plots */
/* Density of clutter that does not come back, plots a m^2. */
float rho_tracker_usual_density(const struct step *step, float x_m, float y_m);
void rho_tracker_predict(struct step *step);
void rho_tracker_claim(struct step *step);
void rho_tracker_update(struct step *step);

/* Plots of clutter that are expected within three standard deviations of the track's place; 0 of bearings. */
float rho_tracker_clutter_in_gate(const struct step *step, const struct rho_track *track);

/* The plot as a track takes it. */
struct rho_track_plot rho_tracker_plot_of(const struct step *step, int row);

/* tracker_shared.c: pairs of tracks take one plot, before the others take theirs: they have `plot` then */
#if RHO_SHARES_PLOTS
void rho_tracker_share(struct step *step);
#else
static inline void rho_tracker_share(struct step *step)
{
    (void)step;
}
#endif

/* tracker_life.c: tracks end, are believed, and start */
void rho_tracker_end_track(struct step *step, struct rho_track *track);
void rho_tracker_age(struct step *step);
void rho_tracker_initiate(struct step *step);

/* A candidate that became a track has its place; 0 where there is none. The limits confirm it, or not. */
int rho_tracker_admit(struct step *step, struct rho_track *track,
                      const struct rho_track_limits *limits);
struct rho_track_limits rho_tracker_limits(const struct step *step);
int rho_tracker_looked_at(const struct step *step, float sector_from_rad, float sector_to_rad,
                          const struct rho_track *track);
int rho_tracker_scan_looked_at(const struct step *step, const struct rho_track *track);

/* tracker_passive.c: tracks start from the bearings that nobody claimed. This file and tracker_frame.c are not needed by
 * who steps plots alone: a linker leaves them and all of passive out. */
void rho_tracker_initiate_passive(struct step *step);

/* How many bearings of a scan, the first of which is the frame's bearing `first`, have a fate of their own and are held. */
uint32_t rho_tracker_num_held(const struct step *step, const struct rho_bearing_scan *scan,
                              uint32_t first);
int rho_tracker_is_bearing(const struct rho_bearing *bearing);

/* The gate of a track that one Kalman filter follows, as it expects the target. */
void rho_tracker_open_gate(const struct step *step, const struct rho_track *track,
                           struct rho_gate *gate);

/* A pair for the assignment: its cost is minus what it gains over a miss. What is in the gate is always better than
 * none. */
void rho_tracker_offer(struct step *step, unsigned row, uint32_t column, float gain_nat);
/*
 * The gain of an offer, not over a miss as the assignment reckons; 0 where there was none, and
 * *gain_nat stays.
 */
int rho_tracker_gain_offered(const struct step *step, unsigned row, int column, float *gain_nat);

/* Solves the assignment, and counts what its gates had no room for. */
void rho_tracker_assign(struct step *step);

/* HELD inputs have nowhere to be held. */
void rho_tracker_refuse_unclaimed(struct step *step);

/* Tracks as the gate wants them: moved to the step's time, with all their hypotheses in one estimate. */
void rho_tracker_settle(struct step *step);

/* Thousandths of a nat, within the assignment's range. */
int32_t rho_tracker_mnat(float nat);

#endif
