/* SPDX-License-Identifier: MIT */
/*
 * step: the state of one step, and the functions of src/tracker and src/bodies. The phases of a
 * step in src/step call these functions, which call no phase. Private to src/tracker, src/bodies,
 * src/step and src/walls.
 *
 * Options of config.h: every build compiles every function, and callers test the option first
 * (`if (RHO_SECTORS)`), so that the linker leaves out functions that a build does not need.
 */
#ifndef RHOTRACK_STEP_H
#define RHOTRACK_STEP_H

#include "rhotrack/tracker.h"

#define RHO_TRACKER_MAGIC 0x5452434bu /* "TRCK" */

#define LOG_TWO_PI 1.83787707f

/* Least side of the area over which unclaimed plots are spread for a clutter density. */
#define RHO_CLUTTER_SIDE_MIN_M 1000.0f

/* Budget of the phase that runs, in units of work. */
struct work_share {
    uint32_t end, kept; /* spent at which the phase ends; reserved for each waiting track */
    unsigned waiting;   /* tracks of which no plots were scored yet */
};

/* A rectangle of places, sides included. */
struct plot_box {
    float x_min_m, x_max_m, y_min_m, y_max_m;
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

/*
 * One sensor's detections at one time, as a step takes them: a scan of plots, a part of a large
 * one, or one scan of a frame of bearings. Opened once, const for all that ask it.
 */
struct rho_look {
    const struct rho_tracker *tracker; /* whose tracks it looks at */
    const struct rho_scan *scan;       /* its plots; NULL: bearings */
    uint8_t *fates;                    /* of its plots, those of the report */
    /* the row of its sensor; NULL: the table is full of described sensors, or bearings */
    struct rho_tracker_sensor *row;
    const struct rho_sensor *sensor;     /* its sensor as described; NULL: not described */
    struct rho_tracker_learned *learned; /* of this sensor; NULL: not described, or bearings */
    /* measures the density of clutter, and starts tracks from its plots; NULL: none */
    struct rho_initiator *initiator;
    struct rho_track_model
        model; /* how tracks move to its time, and the filters that follow them */
    int64_t time_us;
    int is_suspect; /* its sensor contradicts the others */
    uint16_t count; /* count of the sensor's scans; 0: not known */
    /* its sector continues the previous one: 1 counter-clockwise, -1 clockwise; else 0 */
    float turning;
    int is_late;         /* it is out of sequence: older than the newest step */
    uint32_t num_inputs; /* plots or bearings */
    uint32_t num_gated;  /* of these the ones with a place in fates: the first RHO_MAX_PLOTS */
    uint32_t first_row;  /* row in the scan of the first plot of the part that is claimed now */
    int has_more_parts;  /* tracks without a plot may find one in a later part of the scan */
    /* a later part's own clutter density; and the scan's plots over RHO_MAX_PLOTS, 0: first part */
    float part_per_m2, part_share;
    /* largest noise on any axis, and largest time offset either way, of the valid plots */
    float sigma_max_m, offset_max_s;
    /* bit i: track i is in the field of view and was predicted */
    uint32_t in_view[(RHO_MAX_TRACKS + 31) / 32];
    struct plot_box boxes[RHO_PLOT_BOXES]; /* bounding boxes of runs of successive plots */
    uint32_t plots_of_box;                 /* plots in each run */
    float log_pd, log_miss;                /* ln of pd and of 1 - pd, outside of the notch */
    struct rho_notch_look notch_look; /* what a sensor with a Doppler notch sees; 0: no notch */
    /* ln of the intervals in which clutter is uniform: height, m; velocity on one axis, m/s */
    float log_height, log_rates;
    float log_range_rates; /* ln of range_rates_mps */
    float range_rates_mps; /* interval of range rates in which clutter is uniform, m/s */
};

/* One step: predict, then for each look claim and update, then age, initiate and report. */
struct step {
    struct rho_tracker *tracker;
    struct rho_report *report;
    struct rho_passive *passive;   /* starts tracks from bearings; NULL: none, or plots */
    const struct rho_frame *frame; /* the frame of bearings; NULL: plots */
    struct rho_look look;          /* the look that is claimed now */
    struct rho_work work;
    float needed_nat; /* evidence that a new track needs to be confirmed; 0: none */
    float miss_nat;   /* evidence that a miss takes from a new track */
    /* plots beyond RHO_MAX_PLOTS that were claimed, and that are invalid */
    uint32_t num_beyond_claimed, num_beyond_invalid;
};

static inline int rho_tracker_is_ready(const struct rho_tracker *tracker)
{
    return tracker->magic == RHO_TRACKER_MAGIC;
}

/* Largest track score either way, mnat: sums of two scores fit 32 bits. */
#define RHO_SCORE_MAX_MNAT 1000000000

static inline int rho_tracker_is_score_in_range(int32_t mnat)
{
    return mnat >= -RHO_SCORE_MAX_MNAT && mnat <= RHO_SCORE_MAX_MNAT;
}

/* ---- scans ----------------------------------------------------------------------------------- */

/*
 * out_of_sequence_by_retrodiction.c (RHO_SECTORS): scans older than the newest step that may still
 * update tracks
 */
void rho_tracker_set_late_max_default(struct rho_tracker_config *config);
int rho_tracker_is_late_max_usable(const struct rho_tracker_config *config);
/* True of an out-of-sequence scan within late_max_s that is not its sensor's newest one again. */
int rho_tracker_accepts_late_scan(const struct rho_look *look);
/* Counts an out-of-sequence scan that still updates tracks. */
void rho_tracker_count_late_scan(struct rho_tracker *tracker);
/* Stores the track's time before an out-of-sequence scan moves the track back. */
void rho_tracker_store_track_time_before_late_scan(struct rho_track *track);
int rho_tracker_is_sound_stored_track_time(const struct rho_track *track);
/* Gives the held plots of an out-of-sequence scan the fate STALE. */
void rho_tracker_mark_unused_late_plots_stale(const struct rho_look *look);
/* After an out-of-sequence scan: tracks, step and report return to the newest time. */
void rho_tracker_return_tracks_to_newest_time(struct step *step);

/*
 * plot_index.c: iterates over rows of plots, a superset of the held plots in a rectangle:
 *     struct plots_near near = rho_tracker_plots_near(step, x_min_m, x_max_m, y_min_m, y_max_m);
 *     for (uint32_t row; rho_tracker_next_plot_near(step, &near, &row);)
 */
struct plots_near {
    uint32_t next, end;     /* places in the strip or box that is read */
    unsigned box;           /* the box that is read next */
    struct plot_box within; /* the rectangle */
};

/* Sorts the scan's held plots into strips, or bounds their boxes. */
void rho_tracker_index_plots(struct rho_tracker *tracker, struct rho_look *look);
struct plots_near rho_tracker_plots_near(const struct rho_tracker *tracker, float x_min_m,
                                         float x_max_m, float y_min_m, float y_max_m);
int rho_tracker_next_box_near(const struct rho_look *look, struct plots_near *near);

static inline int rho_tracker_next_plot_near(const struct rho_look *look, struct plots_near *near,
                                             uint32_t *row)
{
    if (near->next >= near->end &&
        (RHO_PLOT_STRIPS > 1 || !rho_tracker_next_box_near(look, near))) {
        return 0;
    }
    *row = RHO_PLOT_STRIPS > 1 ? look->tracker->strips.plots[near->next] : near->next;
    near->next++;
    return 1;
}

/* True where a plot is in the iterator's rectangle, sides included. */
static inline int rho_tracker_is_plot_within(const struct plots_near *near,
                                             const struct rho_plot *plot)
{
    return plot->x_m >= near->within.x_min_m && plot->x_m <= near->within.x_max_m &&
           plot->y_m >= near->within.y_min_m && plot->y_m <= near->within.y_max_m;
}

/* Upper bound of the number of plots that the iterator has still to give. */
static inline uint32_t rho_tracker_max_num_plots_near(const struct rho_look *look,
                                                      const struct plots_near *near)
{
    return RHO_PLOT_STRIPS > 1 ? near->end - near->next : look->num_gated;
}

/* ---- sensors --------------------------------------------------------------------------------- */

/* sensors.c: index of a sensor's row in tracker->sensors; num_rows: it has none */
unsigned rho_tracker_row_of(const struct rho_tracker *tracker, int32_t sensor_id);
/* Row of a sensor that sends a scan; NULL: all rows are of other, described sensors. */
struct rho_tracker_sensor *rho_tracker_hear_sensor(struct rho_tracker *tracker, int32_t sensor_id);
const struct rho_sensor *rho_tracker_find_sensor(const struct rho_tracker *tracker,
                                                 int32_t sensor_id); /* NULL: not described */
int rho_tracker_is_usable_sensor(const struct rho_sensor *sensor);
int rho_tracker_has_sound_sensors(const struct rho_tracker *tracker);

/*
 * coverage_of_tracks_by_scan.c: true where a plot, within its noise, is in the sensor's stated
 * coverage. sensor NULL: it covers all
 */
int rho_tracker_coverage_holds_plot(const struct rho_sensor *sensor, const struct rho_plot *plot,
                                    uint32_t measures);
/* True where a bearing is in the sensor's stated sector, or nearer to it than the margin. */
int rho_tracker_coverage_holds_bearing(const struct rho_sensor *sensor, float bearing_rad,
                                       float margin_rad);
/* True where the scan may see a track, by sector and range, with a margin. */
int rho_tracker_may_scan_see_track(const struct rho_look *look, const struct rho_track *track);
/* True where the scan may see the track of this row, as found when tracks were predicted. */
int rho_tracker_is_track_in_view(const struct rho_look *look, unsigned row);
/* True where the sensor, looking at this sector, covers the track's place. */
int rho_tracker_sector_covers_track_place(const struct rho_look *look, float sector_from_rad,
                                          float sector_to_rad, const struct rho_track *track);
/* True where a track without a plot in this scan counts a miss: sensor not suspect, gate passed. */
int rho_tracker_may_count_miss(const struct rho_look *look, const struct rho_track *track);

/*
 * one_look_per_turn_across_sectors.c (RHO_SECTORS): how the sectors of one turn follow each other
 */
#define RHO_TRACKER_SILENT_US 60000000 /* sensors that have been silent longer are ignored */
int rho_tracker_is_sound_look(const struct rho_tracker_look *look);
/* Records the scan's sector and time for its sensor, and finds which way the antenna turns. */
void rho_tracker_record_look_and_antenna_turning(struct rho_tracker *tracker,
                                                 struct rho_look *look);
/* Stores in a track with a plot of this scan that the scan's sensor saw it last. */
void rho_tracker_record_seeing_sensor(const struct rho_look *look, struct rho_track *track);
/* True of the two sensors that saw the track last. */
int rho_tracker_is_among_last_two_sensors(const struct rho_track *track, int32_t sensor_id);
/* Sets the tracker's thresholds: lowest start and highest confirm threshold of all sensors. */
void rho_tracker_merge_sensor_thresholds(struct rho_tracker *tracker, const struct rho_look *look);
/* True where the track claimed a plot in the previous sector of the same turn of the antenna. */
int rho_tracker_was_seen_in_last_sector(const struct rho_look *look, const struct rho_track *track);
/*
 * True where the antenna has passed the end of the track's gate in this scan, or, with an antenna
 * that does not turn, the scan covers the track's place.
 */
int rho_tracker_has_antenna_passed_gate(const struct rho_look *look, const struct rho_track *track);
/* Number of scans of this sector's width in one turn of the antenna; 1 where it does not turn. */
float rho_tracker_scans_per_turn(const struct rho_look *look);

/* sensor_health.c (RHO_SECTORS): finds sensors that contradict the others */
/* Decides whether the scan's sensor is suspect. Returns the factor on its plots' sigmas. */
float rho_tracker_update_suspect_and_sigma_factor(struct rho_tracker *tracker,
                                                  struct rho_look *look);
/* Compares the assigned plots with the tracks' predictions, before tracks are updated. */
void rho_tracker_update_sensor_health(struct rho_tracker *tracker, struct rho_look *look);
/* True where the scan's sensor is suspect and no other sensor has seen the track. */
static inline int rho_tracker_is_only_seen_by_suspect_sensor(const struct rho_look *look,
                                                             const struct rho_track *track)
{
    return look->is_suspect && !track->is_shared;
}

/*
 * sensor_learning.c: noise, pd and notch of a sensor, estimated from established tracks. Noise is
 * set before plots are gated, and learned between assignment and update. suspicion: factor of
 * sensor_health on the sigmas of a suspect sensor, else 1
 */
void rho_tracker_apply_learned_noise(const struct rho_look *look, float suspicion);
/* Writes the learned noise factors, times suspicion, into this description of the sensor. */
void rho_tracker_write_noise_factors(const struct rho_look *look, float suspicion,
                                     struct rho_sensor *sensor);
/* (RHO_DOPPLER_NOTCH) Writes the learned notch into a description that states none. */
void rho_tracker_apply_learned_notch(const struct rho_look *look);
/* Learns noise, pd and notch of the scan's sensor from this scan's plots and misses. */
void rho_tracker_learn_sensor(struct rho_tracker *tracker, const struct rho_look *look);
int rho_tracker_is_sound_learned(const struct rho_tracker_learned *learned);
/* Detection probability of the scan's sensor over all ranges, for its initiator. */
float rho_tracker_pd_over_all_ranges(const struct rho_look *look);
/*
 * ln of the probabilities that the sensor detects a target at the track's place and that it misses
 * it, outside of the Doppler notch
 */
struct detection {
    float log_pd, log_miss;
};
struct detection rho_tracker_detection_without_notch(const struct rho_look *look,
                                                     const struct rho_track *track);

/*
 * blind_looks_in_doppler_notch.c (RHO_DOPPLER_NOTCH): looks of a sensor with a notch. Sets
 * blind_percent of the tracks in view, before plots are scored
 */
void rho_tracker_set_notch_blind_percents(struct step *step);
/* Sets blind_percent of all tracks to 0, at the end of a step. */
void rho_tracker_clear_blind_percents(struct rho_tracker *tracker);
/* Probabilities, ln, of detection and miss of a track that may be in the sensor's notch. */
struct detection rho_tracker_detection_with_notch(const struct rho_look *look,
                                                  const struct rho_track *track);
static inline struct detection
rho_tracker_log_pd_and_log_miss_of_track(const struct rho_look *look, const struct rho_track *track)
{
    return RHO_DOPPLER_NOTCH && track->blind_percent > 0
               ? rho_tracker_detection_with_notch(look, track)
               : rho_tracker_detection_without_notch(look, track);
}
/* True where at least half of the looks at the track are blind: no plot is no miss then. */
static inline int rho_tracker_is_track_mostly_in_notch(const struct rho_track *track)
{
    return RHO_DOPPLER_NOTCH && track->blind_percent >= 50;
}
/* After a blind look without a plot: the track coasts, and counts as seen, not as missed. */
void rho_tracker_set_blind_track_coasting(const struct rho_look *look, struct rho_track *track);

/* ---- images ---------------------------------------------------------------------------------- */

/*
 * reflectors.c (RHO_MAX_REFLECTORS): gives unclaimed plots at the mirror images of tracks the fate
 * GHOST, before new tracks start
 */
void rho_tracker_mark_image_plots_as_ghosts(const struct rho_look *look, struct rho_work *work);
/* Ends tracks that move as the mirror image of another track, after new tracks have started. */
void rho_tracker_end_image_tracks(struct step *step);
int rho_tracker_has_sound_reflectors(const struct rho_tracker *tracker);

/* ---- an operator ---------------------------------------------------------------------------- */

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
/* True of a track that an operator has frozen: it is in no scan's view, and does not age. */
static inline int rho_tracker_is_track_frozen(const struct rho_track *track)
{
    return RHO_MAX_EXCLUDED_AREAS > 0 && track->is_frozen;
}

/* ---- resolution ------------------------------------------------------------------------------ */

/*
 * resolution_cell_size_learning.c (RHO_SHARES_PLOTS): distances at which a sensor does not resolve
 * two targets
 */
int rho_tracker_has_usable_resolution_cell(const struct rho_sensor *sensor);
/* Variances of such distances at a plot's place, along the line of sight and across it. */
void rho_tracker_unresolved_variances_at_plot(const struct rho_look *look,
                                              const struct rho_plot *plot,
                                              const struct rho_measurement *seen, float near_m2[2]);
/* Variance of differences of range rate that are not resolved, (m/s)^2; 0: the rate is not used. */
float rho_tracker_unresolved_range_rate_variance(const struct rho_sensor *sensor);
/* A pair of near tracks that the resolution cell is learned from; [2]: along, across. */
struct apart {
    float is_one;       /* probability that a plot is merged, of both targets */
    float of_one_m2[2]; /* expected squared distance of the targets if it is merged */
    float of_two_m2[2]; /* expected squared distance of the targets if it is of one of them */
    float near_m2[2];   /* variances by rho_tracker_unresolved_variances_at_plot */
};
void rho_tracker_learn_resolution_cell(const struct rho_look *look, const struct apart *apart);
/* Learned resolution cell on an axis, in sigmas of a plot; 0: not learned yet. */
float rho_tracker_learned_cell_sigmas(const struct rho_tracker_learned *learned, int axis);
int rho_tracker_is_sound_learned_cell(const struct rho_tracker_learned *learned);

/* ---- bodies ---------------------------------------------------------------------------------- */

/* In struct rho_groups: a row that stands for no plot, no group or no track. */
#define RHO_NO_ROW UINT16_MAX
/* Plots from which the extent of a track's body counts as known. */
#define RHO_BODY_NEW_PLOTS 30.0f

/* True where targets may give several plots a scan (rho_tracker_set_body_max). */
static inline int rho_tracker_has_bodies(const struct rho_tracker *tracker)
{
    return RHO_BODIES && tracker->bodies.length_max_m > 0.0f;
}
/*
 * plot_groups.c (RHO_BODIES): after tracks were predicted, replaces the step's scan by `grouped`,
 * with one plot for each group
 */
void rho_tracker_group_plots(struct step *step, struct rho_scan *grouped);
/* Before the report: restores the scan, and turns fates and rows of groups into those of plots. */
void rho_tracker_ungroup_plots(struct rho_tracker *tracker, struct rho_look *look,
                               const struct rho_scan *scan);
/* body_extents.c (RHO_BODIES): puts the bodies in the order of the tracks, with new ones added */
void rho_tracker_align_bodies_with_tracks(struct rho_tracker *tracker);
/* Sets the heading of a track's body to that of the track's velocity. */
void rho_tracker_set_body_heading(struct rho_tracker *tracker, unsigned row);
/* Updates each track's body with the plots of its group, before rho_tracker_ungroup_plots. */
void rho_tracker_update_bodies(struct rho_tracker *tracker, const struct rho_look *look,
                               const struct rho_scan *scan);
/* A plot's range rate less that of a target at the plot's place with the track's velocity. */
struct range_rate_residual {
    float mps;
    float variance_m2ps2;  /* variance by the noise of the plot's range rate and of its azimuth */
    float line_turn_m2ps2; /* the azimuth's part of it: its error turns the line of sight */
    float sight_line[2];   /* unit vector from the sensor to the plot, x and y */
};
/* Returns 0 where no range rate was measured, or the plot is at the sensor. */
int rho_tracker_range_rate_residual(const struct rho_look *look, const struct rho_scan *scan,
                                    const struct rho_track *track, const struct rho_plot *plot,
                                    struct range_rate_residual *rate);
/*
 * A plot relative to its track's estimate: in x and y, and along and across the body; and its range
 * rate by rho_tracker_range_rate_residual, whose result rho_tracker_locate_on_body_is_rate_usable
 * returns.
 */
struct body_plot {
    float dx_m, dy_m, along_m, across_m;
    struct range_rate_residual rate;
};
int rho_tracker_locate_on_body_is_rate_usable(const struct rho_look *look,
                                              const struct rho_scan *scan, unsigned row,
                                              unsigned plot, struct body_plot *at);

/* Variances of a plot's own noise in the axes of a body: along, cross, across. */
void rho_tracker_rotate_plot_noise_to_body_axes(const struct rho_look *look,
                                                const struct rho_body_filter *body,
                                                const struct rho_plot *plot, float axes[3]);
/* The first plot, from this one of a group on, that no other track contends for; or RHO_NO_ROW. */
static inline unsigned rho_tracker_first_uncontested_plot(const struct rho_groups *groups,
                                                          unsigned plot)
{
    while (plot != RHO_NO_ROW && groups->contender[plot] != RHO_NO_ROW) {
        plot = groups->next[plot];
    }
    return plot;
}

/* body_split_evidence.c: reasons for which a body is taken to be two targets */
enum rho_body_split {
    RHO_BODY_ONE, /* no reason: one target */
    RHO_BODY_TOO_WIDE,
    RHO_BODY_TOO_LONG,
    RHO_BODY_MOVES_APART /* range rates differ from part to part by more than a turn explains */
};
/* Adds this scan's plots of a track to the evidence that its body is two targets. */
void rho_tracker_add_body_split_evidence(struct rho_tracker *tracker, const struct rho_look *look,
                                         const struct rho_scan *scan, unsigned row);
/* The reason, by that evidence, for which a track's body is two targets; or RHO_BODY_ONE. */
enum rho_body_split rho_tracker_find_body_split_reason(const struct rho_tracker *tracker,
                                                       unsigned row);
/* True of a live track in view within RHO_BODY_TRACKS: plots may be grouped for it. */
static inline int rho_tracker_may_own_group_of_plots(const struct rho_look *look, unsigned row)
{
    return RHO_BODIES && row < RHO_BODY_TRACKS &&
           look->tracker->tracks[row].status != RHO_TRACK_FREE &&
           rho_tracker_is_track_in_view(look, row);
}
/* duplicate_tracks.c: ends one of two tracks of one target; the other track gets its plots */
void rho_tracker_end_duplicate_tracks(struct step *step);
/* Prior variance of a place on a body, on each axis. */
float rho_tracker_prior_place_variance_on_body_m2(const struct rho_tracker *tracker);
int rho_tracker_has_sound_bodies(const struct rho_tracker *tracker);

/* ---- work ------------------------------------------------------------------------------------ */

/*
 * work_budget.c: chooses the plots near a track that are scored within work_max. A phase begins;
 * then for each waiting track, where there may be more plots near it than its share allows, they
 * are counted by octaves of squared distance, and the nearest are chosen
 */
#define RHO_WORK_OCTAVES 40u
/*
 * A phase may do work_max / N units of work, with N for echoes of clutter; for claims and for
 * updates each; for second plots; for second plots of new tracks; for images; for groups.
 */
#define RHO_WORK_ECHOES_SHARE 8u
#define RHO_WORK_TRACKS_SHARE 4u
#define RHO_WORK_SECOND_SHARE 16u
#define RHO_WORK_STARTS_SHARE 16u
#define RHO_WORK_IMAGES_SHARE 16u
#define RHO_WORK_GROUPS_SHARE 4u
/* Plots that an iteration passes over for one unit of work. */
#define RHO_WORK_PASSED_A_UNIT 4u
/* The plots near a track that are to be scored: the nearest ones that its share allows. */
struct plot_choice {
    uint32_t most, units;                 /* plots that may be scored; units of work for each */
    uint32_t num_near;                    /* plots counted near the track */
    int is_partial;                       /* not all plots near the track are chosen */
    unsigned last;                        /* farthest octave of distance with chosen plots */
    uint32_t of_last;                     /* plots of that octave that may still be chosen */
    uint16_t in_octave[RHO_WORK_OCTAVES]; /* plots counted in each octave */
};
/* Begins a phase in which tracks score plots, with a reserved share for each track in view. */
void rho_tracker_begin_phase_with_share_per_track(const struct rho_look *look,
                                                  struct rho_work *work);
/* Begins a phase that may do work_max / divisor units of work. */
void rho_tracker_begin_work_phase(const struct rho_tracker *tracker, struct rho_work *work,
                                  uint32_t divisor);
static inline void rho_tracker_spend_work(struct rho_work *work, uint32_t units)
{
    work->spent = rho_count(work->spent, units);
}

/* Releases the reserved share of one waiting track. */
static inline void rho_tracker_release_work_share_of_one_track(struct rho_work *work)
{
    work->share.waiting -= work->share.waiting > 0 ? 1u : 0u;
}

static inline int rho_tracker_is_phase_work_spent(struct rho_work *work)
{
    return work->spent > work->share.end;
}

struct plot_choice rho_tracker_begin_choice_of_plots_to_score(const struct rho_look *look,
                                                              struct rho_work *work,
                                                              const struct rho_track *track);
void rho_tracker_count_plot_in_distance_octave(struct plot_choice *choice,
                                               const struct rho_track *track,
                                               const struct rho_plot *plot);
void rho_tracker_limit_choice_to_nearest_plots(struct rho_work *work, struct plot_choice *choice);
/* True where a plot is chosen; its units of work are spent. */
int rho_tracker_spend_score_work_if_plot_chosen(struct rho_work *work, struct plot_choice *choice,
                                                const struct rho_track *track,
                                                const struct rho_plot *plot);
/* Units of work that are left for the initiator's search; 0: no limit. */
uint32_t rho_tracker_work_left_for_search(const struct rho_look *look, struct rho_work *work);
void rho_tracker_record_work(struct step *step);

/* ---- clutter --------------------------------------------------------------------------------- */

/* expected_clutter.c: density of clutter plots at a place, without echoes and strobes, 1/m^2 */
float rho_tracker_background_density(const struct rho_look *look, float x_m, float y_m);
/* Density of clutter at a plot's place, without echoes and strobes, 1/m^2; above 0. */
float rho_tracker_background_density_at_plot(const struct rho_look *look,
                                             const struct rho_plot *plot);
/* ln of the density of clutter at the track's place, in the part of the scan that is claimed. */
float rho_tracker_log_clutter_density_at_track(const struct rho_look *look,
                                               const struct rho_track *track);
/* Clutter plots expected within three standard deviations of the track's place; 0 in a frame. */
float rho_tracker_expected_clutter_in_gate(const struct step *step, const struct rho_track *track);
/* Measures the clutter density of a later part of the scan, from its held plots. */
void rho_tracker_measure_density_of_held_plots(struct rho_look *look);
/* Smooths the number of unclaimed plots, after new tracks have started. */
void rho_tracker_smooth_unclaimed_count(struct rho_tracker *tracker, const struct rho_look *look);
/* Moves a mean of ten scans by a tenth of its difference to the newest value. */
void rho_tracker_smooth_mean(float *mean, float newest);

/* clutter_map_in_step.c (RHO_MAX_ECHOES): the clutter map in a step */
void rho_tracker_init_clutter_map(struct rho_tracker *tracker);
int rho_tracker_has_sound_clutter_map(const struct rho_tracker *tracker);
int rho_tracker_has_sound_echo_returns(const struct rho_track *track);
/* Computes the density of echoes and strobes at the plots of a scan (first part), before claims. */
void rho_tracker_predict_clutter_at_plots(struct rho_tracker *tracker, const struct rho_look *look,
                                          struct rho_work *work);
/*
 * ln of the clutter density at a plot with echoes, strobes and second plots, over that without; 0
 * in later parts of a scan.
 */
float rho_tracker_log_echo_over_background_density(const struct rho_look *look, uint32_t row);
/*
 * Stores rho_tracker_log_echo_over_background_density of the scan's plots with the held plots in
 * the window.
 */
void rho_tracker_store_echo_ratios_in_window(const struct rho_look *look);
/* Updates the clutter map with the scan's plots, after new tracks have started. */
void rho_tracker_update_clutter_map(struct rho_tracker *tracker, const struct rho_look *look);
/*
 * Likelihood ratio of a range rate that is off_mps from the expected one, against clutter that is
 * uniform in all range rates. Half of such rates are taken to be as expected, with the variance and
 * that of 1 m/s, and half to be uniform, too.
 */
float rho_tracker_range_rate_likelihood_ratio(const struct rho_look *look, float off_mps,
                                              float variance);
/* Stores the place where a track starts, to tell later whether it has moved. */
void rho_tracker_store_start_place(struct rho_track *track);
/* Sums into a new track the probabilities that its candidate's plots were returns of echoes. */
void rho_tracker_sum_echo_returns_at_start(const struct rho_look *look,
                                           const struct rho_candidate *candidate,
                                           struct rho_track *track);
/* True where a track was found to be of a moving target, and its returns left the clutter map. */
int rho_tracker_is_known_moving_target(const struct rho_track *track);

/*
 * second_plots_and_duplicate_tracks.c (RHO_MAX_ECHOES): near claimed plots, before tracks age,
 * learns how often second plots of a target come, raises the clutter density there, and ends the
 * younger of two tracks of one target
 */
void rho_tracker_learn_second_plots_and_end_duplicates(struct step *step);
int rho_tracker_is_sound_second_plots(const struct rho_second_plots *table);
int rho_tracker_has_sound_track_second_plots(const struct rho_track *track);
/*
 * After a start: raises the clutter density at the window's plots near the candidate's plots, as
 * they may be second plots of the same target.
 */
void rho_tracker_raise_window_clutter_near_start(const struct rho_look *look, struct rho_work *work,
                                                 const struct rho_candidate *candidate);

/* ---- plots and tracks ------------------------------------------------------------------------ */

/* plot_scores.c: scores of pairs of a track and a plot or bearing, for the assignment */
/* Converts nats to integer thousandths, within the range of the assignment's costs. */
int32_t rho_tracker_nat_to_mnat(float nat);
/* Makes the gate of a track about its merged estimate. measures: of the scan; 0 for bearings. */
void rho_tracker_open_track_gate(const struct rho_look *look, const struct rho_track *track,
                                 uint32_t measures, struct rho_gate *gate);
/*
 * Adds a track (row) and an input (column) as a pair to the assignment. gain_nat: score over that
 * of a miss; a pair always costs less than a miss.
 */
void rho_tracker_add_assignment_pair(struct rho_tracker *tracker, unsigned row, uint32_t column,
                                     float gain_nat);
/* Score of a pair over clutter. Returns 0 where the pair was not added; *gain_nat stays. */
int rho_tracker_find_pair_gain(const struct rho_look *look, unsigned row, int column,
                               float *gain_nat);
/* Removes an ended track's row from the assignment, and moves later rows up by one. */
void rho_tracker_remove_assignment_row(struct rho_tracker *tracker, unsigned row);

/* Solves the assignment, and counts plots that were dropped for lack of room in gates. */
void rho_tracker_solve_assignment(struct rho_tracker *tracker);

/*
 * Log-likelihood ratio of a plot in a track's Kalman gate, against clutter. log_density:
 * rho_tracker_log_clutter_density_at_track of the track
 */
float rho_tracker_score_plot(const struct rho_look *look, const struct rho_track *track,
                             const struct rho_gate_result *result, float log_density, uint32_t row);
/* ln of the probability of a miss; 0 where the scan counts no miss of the track. */
float rho_tracker_log_miss_probability(const struct rho_look *look, const struct rho_track *track);
/*
 * Iterates over the plots near a track with hypotheses that are not assigned to another track, each
 * scored by every hypothesis; gain_nat is the score over clutter:
 *     rho_tracker_begin_plot_scores(step, row, &scores);
 *     while (rho_tracker_next_plot_score(step, &scores, &plot, &gain_nat))
 */
struct plot_scores {
    unsigned track_row;
    float log_pd;
    struct rho_hypotheses_clutter clutter;
    struct rho_hypotheses_box box;
    struct plots_near near;
    struct plot_choice choice;
};
void rho_tracker_begin_plot_scores(struct rho_tracker *tracker, const struct rho_look *look,
                                   struct rho_work *work, unsigned row, struct plot_scores *scores);
int rho_tracker_next_plot_score(struct rho_tracker *tracker, const struct rho_look *look,
                                struct rho_work *work, struct plot_scores *scores, uint32_t *plot,
                                float *gain_nat);
/* A plot of the scan with its time, sensor and row, as rho_track_update_by_plot takes it. */
struct rho_track_plot rho_tracker_make_track_plot(const struct rho_look *look, int row);

/* ---- life cycle ------------------------------------------------------------------------------ */

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

/* end_unobserved_tracks.c: scan intervals of sensors, and tracks that no sensor looks at */
/* Measures the scan interval of a sensor, which is at the origin if NULL. */
void rho_tracker_update_scan_interval(struct rho_tracker_pace *pace,
                                      const struct rho_sensor *sensor, int64_t time_us,
                                      float sector_from_rad, float sector_to_rad);
/*
 * Returns 1 where a track is to end, as it was not observed for too long. Also smooths the time
 * between the track's hits, and lowers its score where it is doubtful after a long silence.
 */
int rho_tracker_update_and_test_unobserved(const struct step *step, struct rho_track *track,
                                           int is_missed, const struct rho_track_limits *limits);
/* True where sigma of the track's place exceeds the maximum range of its last sensor. */
int rho_tracker_is_place_too_uncertain(const struct rho_tracker *tracker,
                                       const struct rho_track *track);

/* tracker_setup.c: the filter that a configuration gives to tracks of plots */
enum rho_track_filter rho_tracker_filter_of_config(const struct rho_tracker_config *config);
int rho_tracker_is_usable_config(const struct rho_tracker_config *config);

#endif
