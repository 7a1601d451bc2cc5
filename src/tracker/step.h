/* SPDX-License-Identifier: MIT */
/*
 * step: the state of one step, and the functions below the phases of src/step: those call them, and
 * none of them calls a phase. Private to src/tracker, src/bodies, src/step and src/walls.
 *
 * Options of config.h: every build compiles every function, and callers ask the option first
 * (`if (RHO_SECTORS)`), so that the linker leaves out what a build does not need.
 */
#ifndef RHOTRACK_STEP_H
#define RHOTRACK_STEP_H

#include "rhotrack/tracker.h"

#define RHO_TRACKER_MAGIC 0x5452434bu /* "TRCK" */

#define LOG_TWO_PI 1.83787707f

/* The least side of an area that clutter is spread over. */
#define RHO_CLUTTER_SIDE_MIN_M 1000.0f

/* The work of a phase; each track that waits has a share of it. */
struct work_share {
    uint32_t end, kept; /* units: total at which the phase ends; reserved for each waiting track */
    unsigned waiting;
};

/* Limits of places, inclusive. */
struct plot_box {
    float x_min_m, x_max_m, y_min_m, y_max_m;
};

#define RHO_PLOT_BOXES 8

/* Parts of RHO_MAX_PLOTS plots that a large scan is claimed in; plots beyond are ignored. */
#define RHO_TRACKER_PARTS_MAX 4u

struct step {
    struct rho_tracker *tracker;
    int64_t time_us;
    /* a scan of plots, and the initiator that starts tracks from them, or NULL */
    const struct rho_scan *scan;
    struct rho_initiator *initiator;
    /* or a frame of bearings, and the initiator of these, or NULL */
    const struct rho_frame *frame;
    struct rho_passive *passive;
    struct rho_report *report;
    const struct rho_sensor *sensor;     /* of the scan; NULL: not described */
    struct rho_tracker_learned *learned; /* of it; NULL: likewise, or of a frame */
    int is_suspect;                      /* the sensor contradicts the others */
    uint16_t look;                       /* count of the sensor's scans; 0: not known */
    /* the scan is the sector after the one before: 1 counter-clockwise, -1 clockwise; else 0 */
    float turning;
    int is_late;         /* out of sequence: older than the newest step */
    uint32_t num_inputs; /* plots or bearings */
    uint32_t num_gated;  /* of them: have a place in report->fates */
    /* of the plots that have none: claimed, invalid */
    uint32_t num_beyond_claimed, num_beyond_invalid;
    uint32_t first_row; /* in the whole scan, of the part that is claimed (scan_overflow) */
    int has_more_parts; /* tracks without a plot may find one in a later part */
    /* of a later part: its own clutter density, and the whole scan's plots over the first part's */
    float part_per_m2, part_share;
    /* of the scan's valid plots, the largest: noise on any axis, own time either way */
    float sigma_max_m, offset_max_s;
    uint32_t work, plots_not_tried; /* units; plots */
    struct work_share share;        /* of the phase that runs */
    int is_partial;
    /* bit i: track i is in the scan's field of view and was predicted */
    uint32_t in_view[(RHO_MAX_TRACKS + 31) / 32];
    struct plot_box boxes[RHO_PLOT_BOXES]; /* of plots that follow each other, as many in each */
    uint32_t plots_of_box;
    struct rho_track_model model;
    float log_pd;
    float log_miss;                   /* ln(1 - pd) of the scan's sensor */
    struct rho_notch_look notch_look; /* of the scan's sensor; 0 where it has no notch */
    float needed_nat;                 /* evidence that a new track needs to be confirmed; 0: none */
    float miss_nat;                   /* what a miss takes from it */
    /* ln of what clutter is spread over: RHO_CLUTTER_HEIGHT_M; velocities of one axis, m/s */
    float log_height, log_rates;
    float log_range_rates; /* range rates that the sensor tells apart, m/s */
    float range_rates_mps; /* the same without the logarithm */
};

static inline int rho_tracker_is_ready(const struct rho_tracker *tracker)
{
    return tracker->magic == RHO_TRACKER_MAGIC;
}

/* Scores may be added and subtracted. */
#define RHO_SCORE_MAX_MNAT 1000000000

static inline int rho_tracker_is_score(int32_t mnat)
{
    return mnat >= -RHO_SCORE_MAX_MNAT && mnat <= RHO_SCORE_MAX_MNAT;
}

/* ---- scans ----------------------------------------------------------------------------------- */

/* out_of_sequence.c (RHO_SECTORS): scans older than the newest step that may still update tracks */
void rho_tracker_set_late_default(struct rho_tracker_config *config);
int rho_tracker_is_late_max_usable(const struct rho_tracker_config *config);
int rho_tracker_takes_late_scan(const struct step *step);
void rho_tracker_count_late_scan(struct step *step);
/* Remembers the time that an out-of-sequence scan moves the track back from. */
void rho_tracker_note_time_ahead(struct rho_track *track);
int rho_tracker_is_sound_ahead(const struct rho_track *track);
/* Unclaimed plots of an out-of-sequence scan that start no track are stale. */
void rho_tracker_refuse_stale_plots(struct step *step);
/* Ends an out-of-sequence scan: tracks return to the newest time. */
void rho_tracker_end_late_scan(struct step *step);

/*
 * plot_index.c: the rows of the plots near a place. Those between these limits are among them:
 *     struct plots_near near = rho_tracker_plots_near(step, x_min_m, x_max_m, y_min_m, y_max_m);
 *     for (uint32_t row; rho_tracker_next_plot_near(step, &near, &row);)
 */
struct plots_near {
    uint32_t next, end; /* places in the order of the strip or box that is read */
    unsigned box;       /* the next one */
    struct plot_box within;
};

void rho_tracker_sort_plots(struct step *step);
struct plots_near rho_tracker_plots_near(const struct step *step, float x_min_m, float x_max_m,
                                         float y_min_m, float y_max_m);
int rho_tracker_next_box_near(const struct step *step, struct plots_near *near);

static inline int rho_tracker_next_plot_near(const struct step *step, struct plots_near *near,
                                             uint32_t *row)
{
    if (near->next >= near->end &&
        (RHO_PLOT_STRIPS > 1 || !rho_tracker_next_box_near(step, near))) {
        return 0;
    }
    *row = RHO_PLOT_STRIPS > 1 ? step->tracker->strips.plots[near->next] : near->next;
    near->next++;
    return 1;
}

/* Between the limits, sides included. */
static inline int rho_tracker_is_within(const struct plots_near *near, const struct rho_plot *plot)
{
    return plot->x_m >= near->within.x_min_m && plot->x_m <= near->within.x_max_m &&
           plot->y_m >= near->within.y_min_m && plot->y_m <= near->within.y_max_m;
}

/* An upper bound of the number of those plots. */
static inline uint32_t rho_tracker_max_plots_near(const struct step *step,
                                                  const struct plots_near *near)
{
    return RHO_PLOT_STRIPS > 1 ? near->end - near->next : step->num_gated;
}

/* ---- sensors --------------------------------------------------------------------------------- */

/* sensor_table.c: sensors that were described. Place in the table: num_sensors where it is none */
unsigned rho_tracker_place_of_sensor(const struct rho_tracker *tracker, int32_t sensor_id);
const struct rho_sensor *rho_tracker_find_sensor(const struct rho_tracker *tracker,
                                                 int32_t sensor_id); /* NULL: not described */
int rho_tracker_is_usable_sensor(const struct rho_sensor *sensor);

/*
 * coverage.c: whether a plot may be a target's in the sensor's stated coverage (NULL: not known);
 * a bearing whose noise is within the margin; whether the scan can see a track at all, and as
 * rho_tracker_predict found that, by the track's row
 */
int rho_tracker_covers(const struct rho_sensor *sensor, const struct rho_plot *plot,
                       uint32_t measures);
int rho_tracker_covers_bearing(const struct rho_sensor *sensor, float bearing_rad,
                               float margin_rad);
int rho_tracker_may_see(const struct step *step, const struct rho_track *track);
int rho_tracker_is_in_view(const struct step *step, unsigned row);
/* The sensor looked where the track is: in this sector; in the scan, so that no plot is a miss. */
int rho_tracker_looked_at(const struct step *step, float sector_from_rad, float sector_to_rad,
                          const struct rho_track *track);
int rho_tracker_scan_looked_at(const struct step *step, const struct rho_track *track);

/* sectors.c (RHO_SECTORS): how the sectors of one turn follow each other */
#define RHO_TRACKER_SILENT_US 60000000 /* sensors that have been silent longer are ignored */
/* The record of looks of the scan's sensor; NULL where there is none. */
struct rho_tracker_look *rho_tracker_own_look(struct step *step);
void rho_tracker_forget_look(struct rho_tracker *tracker, int32_t sensor_id);
int rho_tracker_has_sound_looks(const struct rho_tracker *tracker);
void rho_tracker_note_look(struct step *step);
/* Remembers that the track has a plot of this scan, if it has one. */
void rho_tracker_note_sight(const struct step *step, struct rho_track *track);
/* One of the two sensors that saw the track last. */
int rho_tracker_saw_last(const struct rho_track *track, int32_t sensor_id);
/* The tracker's thresholds: the initiator's, and those of the other sensors'. */
void rho_tracker_note_thresholds(struct step *step);
/* The track took a plot in the sector before: the antenna is still at the same pass. */
int rho_tracker_was_seen_in_last_sector(const struct step *step, const struct rho_track *track);
/*
 * The antenna has passed all of the track's gate in this scan, or the sensor looked there at once.
 */
int rho_tracker_has_passed_gate(const struct step *step, const struct rho_track *track);
/* How many scans of this sector's width make a turn of the antenna; 1 where none do. */
float rho_tracker_scans_a_turn(const struct step *step);
/* A held plot came with an earlier sector of the turn that the window's scan is. */
int rho_tracker_is_of_earlier_sector(const struct rho_window *window,
                                     const struct rho_window_scan *scan, unsigned plot);

/* sensor_health.c (RHO_SECTORS): whether the sensor agrees with the others */
/* Finds whether it is suspect. Returns how many times its variances count. */
float rho_tracker_find_suspect(struct step *step);
/* Compares the assigned plots with the tracks' predictions, before tracks are updated. */
void rho_tracker_update_sensor_health(struct step *step);
/* No other sensor has seen the track, and this one is suspect. */
static inline int rho_tracker_is_only_seen_by_suspect_sensor(const struct step *step,
                                                             const struct rho_track *track)
{
    return step->is_suspect && !track->is_shared;
}

/*
 * sensor_learning.c: the sensor's noise and pd, estimated from the tracks' innovations and misses.
 * The noise is set before plots are gated, and learned between assignment and update. suspicion:
 * the factor by which sensor_health widens the noise of a suspect sensor
 */
void rho_tracker_set_noise(struct step *step, float suspicion);
/* Writes the learned noise, times the factor, into a copy of the sensor. */
void rho_tracker_use_noise(const struct step *step, float suspicion, struct rho_sensor *sensor);
/* (RHO_DOPPLER_NOTCH) Writes the learned notch into a sensor of which none was stated. */
void rho_tracker_use_notch(struct step *step);
void rho_tracker_learn_sensor(struct step *step);
int rho_tracker_is_sound_learned(const struct rho_tracker_learned *learned);
/* Of the scan's sensor, for its initiator: over all ranges. */
float rho_tracker_mean_pd(const struct step *step);
/*
 * ln of the probability that the sensor detects a target where this track is, and that it misses
 * it; whatever its range rate
 */
struct detection {
    float log_pd, log_miss;
};
struct detection rho_tracker_usual_detection(const struct step *step,
                                             const struct rho_track *track);

/*
 * blind_looks.c (RHO_DOPPLER_NOTCH): looks of a sensor with a notch. Finds blind_percent of the
 * tracks in view, before they are offered plots; and forgets it
 */
void rho_tracker_find_blind(struct step *step);
void rho_tracker_forget_blind(struct step *step);
/* Detection and miss of a track, with the range rates that the sensor does not see. */
struct detection rho_tracker_detection_beside_notch(const struct step *step,
                                                    const struct rho_track *track);
static inline struct detection rho_tracker_detection(const struct step *step,
                                                     const struct rho_track *track)
{
    return RHO_DOPPLER_NOTCH && track->blind_percent > 0
               ? rho_tracker_detection_beside_notch(step, track)
               : rho_tracker_usual_detection(step, track);
}
/* More looks at the track than not are blind: that it has no plot is no miss. */
static inline int rho_tracker_is_blind(const struct rho_track *track)
{
    return RHO_DOPPLER_NOTCH && track->blind_percent >= 50;
}
/* A blind look at a track that was confirmed: it coasts, and is not missed. */
void rho_tracker_note_blind_look(const struct step *step, struct rho_track *track);

/* ---- images ---------------------------------------------------------------------------------- */

/*
 * reflectors.c (RHO_MAX_REFLECTORS): unclaimed plots where a track's image would be are ghosts,
 * before starts; tracks that move as one end, after them
 */
void rho_tracker_mark_images(struct step *step);
void rho_tracker_end_images(struct step *step);
int rho_tracker_has_sound_reflectors(const struct rho_tracker *tracker);

/* ---- an operator ---------------------------------------------------------------------------- */

/* excluded_areas.c (RHO_MAX_EXCLUDED_AREAS): unclaimed plots in them are ghosts, before starts */
void rho_tracker_mark_excluded(struct step *step);
int rho_tracker_lies_excluded(const struct step *step, uint32_t plot);
static inline int rho_tracker_is_excluded(const struct step *step, uint32_t plot)
{
    return RHO_MAX_EXCLUDED_AREAS > 0 && rho_tracker_lies_excluded(step, plot);
}
int rho_tracker_has_sound_excluded(const struct rho_tracker *tracker);
/* A frozen track is in no scan's view, and does not age. */
static inline int rho_tracker_is_frozen(const struct rho_track *track)
{
    return RHO_MAX_EXCLUDED_AREAS > 0 && track->is_frozen;
}

/* ---- resolution ------------------------------------------------------------------------------ */

/* resolution_cell.c (RHO_SHARES_PLOTS): two targets of which a sensor makes one plot */
int rho_tracker_is_usable_cell(const struct rho_sensor *sensor);
/* Variances of the distances at which it does, along the line of sight and across it. */
void rho_tracker_cell_at(const struct step *step, const struct rho_plot *plot,
                         const struct rho_measurement *seen, float near_m2[2]);
/* ... and of range rates; 0: they do not tell targets apart. */
float rho_tracker_rate_cell_mps2(const struct rho_sensor *sensor);
/* What a pair of tracks says of the cell, along and across. */
struct apart {
    float is_one;       /* probability that one plot is of both */
    float of_one_m2[2]; /* squared distance of both targets, expected if it is */
    float of_two_m2[2]; /* ... and if it is not */
    float near_m2[2];
};
void rho_tracker_learn_cell(struct step *step, const struct apart *apart);
float rho_tracker_cell_sigmas(const struct rho_tracker_learned *learned, int axis);
int rho_tracker_has_sound_cell(const struct rho_tracker_learned *learned);

/* ---- bodies ---------------------------------------------------------------------------------- */

/* Of groups: the row of no plot, group or track. */
#define RHO_NO_ROW UINT16_MAX
/* The body of a track is known from so many plots on. */
#define RHO_BODY_NEW_PLOTS 30.0f

/* Targets may give several plots a scan. */
static inline int rho_tracker_has_bodies(const struct rho_tracker *tracker)
{
    return RHO_BODIES && tracker->bodies.length_max_m > 0.0f;
}
/*
 * plot_groups.c (RHO_BODIES): the scan becomes that of its groups, after the tracks were predicted;
 * and fates and rows become those of the scan's plots, before the report
 */
void rho_tracker_group_plots(struct step *step, struct rho_scan *grouped);
void rho_tracker_ungroup_plots(struct step *step, const struct rho_scan *scan);
/* body_extents.c (RHO_BODIES): bodies are in the order of the tracks; before rows become those of
 * plots, each learns from its track's plots */
void rho_tracker_align_bodies(struct step *step);
/* The heading of a track's body is that of its velocity. */
void rho_tracker_turn_body(struct rho_tracker *tracker, unsigned row);
void rho_tracker_update_bodies(struct step *step, const struct rho_scan *scan);
/*
 * A plot's range rate less that of the track's velocity there, and the direction of the line of
 * sight. 0: none was measured.
 */
int rho_tracker_rate_off(const struct step *step, const struct rho_scan *scan,
                         const struct rho_track *track, const struct rho_plot *plot, float line[2],
                         float *off_mps);
/*
 * A plot of a track: from its estimate, in x and y and on the body; and rho_tracker_rate_off, whose
 * outcome it returns.
 */
struct body_plot {
    float dx_m, dy_m, along_m, across_m, rate_mps, line[2];
};
int rho_tracker_place_on_body(const struct step *step, const struct rho_scan *scan, unsigned row,
                              unsigned plot, struct body_plot *at);

/* Variances of a plot's own noise in the axes of a body: along, cross, across. */
void rho_tracker_noise_on_body(const struct step *step, const struct rho_body_filter *body,
                               const struct rho_plot *plot, float axes[3]);
/* From this plot of a group on, the first that no other track contends for. */
static inline unsigned rho_tracker_uncontested(const struct rho_groups *groups, unsigned plot)
{
    while (plot != RHO_NO_ROW && groups->contender[plot] != RHO_NO_ROW) {
        plot = groups->next[plot];
    }
    return plot;
}

/* body_doubt.c: what the plots of a body say of two targets; and for which reason they are two */
enum rho_body_split {
    RHO_BODY_ONE,
    RHO_BODY_TOO_WIDE,
    RHO_BODY_TOO_LONG,
    RHO_BODY_MOVES_APART /* range rates differ from part to part by more than a turn explains */
};
void rho_tracker_doubt_body(const struct step *step, const struct rho_scan *scan, unsigned row);
enum rho_body_split rho_tracker_why_two(const struct step *step, unsigned row);
static inline int rho_tracker_may_own_plots(const struct step *step, unsigned row)
{
    return RHO_BODIES && row < RHO_BODY_TRACKS &&
           step->tracker->tracks[row].status != RHO_TRACK_FREE && rho_tracker_is_in_view(step, row);
}
/* doubled_bodies.c: of two tracks of one target the younger ends, and the other has its plots */
void rho_tracker_end_doubled(struct step *step);
/* Variance of a place on a body that nothing is known of, on each axis. */
float rho_tracker_body_prior_m2(const struct rho_tracker *tracker);
int rho_tracker_has_sound_bodies(const struct rho_tracker *tracker);

/* ---- work ------------------------------------------------------------------------------------ */

/*
 * work_budget.c: which of the plots near a track are scored within work_max. A phase begins; then
 * for each track that waits a choice is made: where there may be more plots than `most`, all near
 * it are counted, and the choice is made by distance
 */
#define RHO_WORK_OCTAVES 40u
/* Shares of work_max, 1 / N: of echoes; of claims and of updates each; of second plots; of the
 * tracks that start; of images; of groups. */
#define RHO_WORK_ECHOES_SHARE 8u
#define RHO_WORK_TRACKS_SHARE 4u
#define RHO_WORK_SECOND_SHARE 16u
#define RHO_WORK_STARTS_SHARE 16u
#define RHO_WORK_IMAGES_SHARE 16u
#define RHO_WORK_GROUPS_SHARE 4u
/* So many plots that a box passes over cost one unit. */
#define RHO_WORK_PASSED_A_UNIT 4u
struct plot_choice {
    uint32_t most, units; /* plots; units for each */
    uint32_t num_near;
    int is_partial;
    unsigned last; /* all plots of the octaves of distance before; of this one: */
    uint32_t of_last;
    uint16_t in_octave[RHO_WORK_OCTAVES];
};
/* Begins the tracks' share of a phase. */
void rho_tracker_begin_work(struct step *step);
/* Begins another phase's share. */
void rho_tracker_begin_share(struct step *step, uint32_t part);
static inline void rho_tracker_spend(struct step *step, uint32_t units)
{
    step->work = rho_count(step->work, units);
}

/* One waiting track gives up its reserved share of the work. */
static inline void rho_tracker_release_share(struct step *step)
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
void rho_tracker_end_choice(struct step *step, struct plot_choice *choice);
/* True where the plot is to be scored: it costs its units. */
int rho_tracker_is_chosen(struct step *step, struct plot_choice *choice,
                          const struct rho_track *track, const struct rho_plot *plot);
/* The units of the step's budget that are left for the search. */
uint32_t rho_tracker_work_left(const struct step *step);
void rho_tracker_end_work(struct step *step);

/* ---- clutter --------------------------------------------------------------------------------- */

/* expected_clutter.c: density of false plots, 1/m^2. Of clutter that does not come back */
float rho_tracker_usual_density(const struct step *step, float x_m, float y_m);
/* Density of false plots where a plot is, but never 0. */
float rho_tracker_density_at_plot(const struct step *step, const struct rho_plot *plot);
/* ln of the density where the track is, in the part of the scan that is claimed. */
float rho_tracker_log_clutter_density(const struct step *step, const struct rho_track *track);
/* False plots expected within three standard deviations of the track's place; 0 in a frame. */
float rho_tracker_clutter_in_gate(const struct step *step, const struct rho_track *track);
/* Measures the density of a later part of the scan. */
void rho_tracker_measure_part_density(struct step *step);
/* The smoothed number of unclaimed plots, after the starts; any such mean. */
void rho_tracker_learn_unclaimed(struct step *step);
void rho_tracker_smooth_mean(float *mean, float newest);

/* clutter_update.c (RHO_MAX_ECHOES): the map of clutter that comes back */
void rho_tracker_open_clutter_map(struct rho_tracker *tracker);
int rho_tracker_has_sound_clutter_map(const struct rho_tracker *tracker);
int rho_tracker_has_sound_returns(const struct rho_track *track);
/* Echoes' densities at the plots of a scan or its first part, before claims. */
void rho_tracker_look_at_clutter(struct step *step);
/* ln of how much denser clutter is at this plot than near it; 0 in later parts of a scan. */
float rho_tracker_repeats_nat(const struct step *step, uint32_t row);
/* The window's plots keep that ratio until they start tracks. */
void rho_tracker_keep_repeats(struct step *step);
/* The map learns from the scan's plots, after starts. */
void rho_tracker_learn_clutter(struct step *step);
/*
 * Likelihood of a range rate that differs so much from the expected one, over its likelihood as
 * clutter, which is spread over all rates: half of such rates are as expected, with 1 m/s beside
 * the variance, and half are any.
 */
float rho_tracker_rate_ratio(const struct step *step, float off_mps, float variance);
/* The place where a track starts; how far echoes explained its candidate's plots. */
void rho_tracker_note_start_place(struct rho_track *track);
void rho_tracker_note_start_echoes(struct step *step, const struct rho_candidate *candidate,
                                   struct rho_track *track);
/* The track has moved as targets do, and not only from echo to echo. */
int rho_tracker_has_moved(const struct rho_track *track);

/*
 * split_plots.c (RHO_MAX_ECHOES): second plots of one target near those that tracks have just
 * claimed; of two tracks of one target the younger ends. Before tracks age
 */
void rho_tracker_expect_second_plots(struct step *step);
void rho_tracker_forget_second_plots(struct rho_tracker *tracker, int32_t sensor_id);
int rho_tracker_has_sound_second_plots(const struct rho_tracker *tracker);
int rho_tracker_has_sound_older_track(const struct rho_track *track);
/*
 * A track has started with the candidate's plots: others near them, in the window, may be its own.
 */
void rho_tracker_expect_earlier_second_plots(struct step *step,
                                             const struct rho_candidate *candidate);

/* ---- plots and tracks ------------------------------------------------------------------------ */

/* plot_scores.c: pairs of a track and a plot or bearing are offered to the assignment */
/* Thousandths of a nat, within the assignment's range. */
int32_t rho_tracker_mnat(float nat);
/* The gate of a track at its one estimate. measures: of the scan; 0 of bearings. */
void rho_tracker_open_gate(const struct step *step, const struct rho_track *track,
                           uint32_t measures, struct rho_gate *gate);
/* A gated plot always costs less than a miss. gain_nat: over a miss. */
void rho_tracker_offer(struct step *step, unsigned row, uint32_t column, float gain_nat);
/* The gain of an offer over clutter, not over a miss; 0 where there was none, *gain_nat stays. */
int rho_tracker_gain_offered(const struct step *step, unsigned row, int column, float *gain_nat);
/* Tracks behind a row that is no track's any more have moved up by one: so do their offers. */
void rho_tracker_remove_offer_row(struct rho_tracker *tracker, unsigned row);

/* Solves the assignment, and counts the plots that gates had no room for. */
void rho_tracker_assign(struct step *step);

/*
 * ln of how much likelier a plot is the track's than clutter. With a Kalman filter,
 * of a plot in its gate; log_density: rho_tracker_log_clutter_density
 */
float rho_tracker_score_plot(const struct step *step, const struct rho_track *track,
                             const struct rho_gate_result *result, float log_density, uint32_t row);
/* ln of the probability of a miss; 0 where the sensor did not look. */
float rho_tracker_log_miss(const struct step *step, const struct rho_track *track);
/*
 * With hypotheses: every plot near the track that no other track has been assigned is scored by
 * each hypothesis.
 *     rho_tracker_begin_scores(step, row, &scores);
 *     while (rho_tracker_next_score(step, &scores, &plot, &gain_nat))
 */
struct plot_scores {
    unsigned track_row;
    float log_pd;
    struct rho_hypotheses_clutter clutter;
    struct rho_hypotheses_box box;
    struct plots_near near;
    struct plot_choice choice;
};
void rho_tracker_begin_scores(struct step *step, unsigned row, struct plot_scores *scores);
int rho_tracker_next_score(struct step *step, struct plot_scores *scores, uint32_t *plot,
                           float *gain_nat);
/* The plot as a track takes it. */
struct rho_track_plot rho_tracker_plot_of(const struct step *step, int row);

/* ---- life cycle ------------------------------------------------------------------------------ */

/* life_cycle.c: thresholds confirm and end tracks. Ended ones are FREE until they are removed */
struct rho_track_limits rho_tracker_limits(const struct step *step);
void rho_tracker_apply_thresholds(struct step *step, struct rho_track *track,
                                  const struct rho_track_limits *limits);
void rho_tracker_end_track(struct step *step, struct rho_track *track);
void rho_tracker_remove_ended(struct rho_tracker *tracker);

/* short_lived_tracks.c: evidence that new tracks need to be confirmed, found once a step */
#define RHO_ESTABLISHED_HITS 16
static inline int rho_tracker_is_established(const struct rho_track *track)
{
    return track->hits >= RHO_ESTABLISHED_HITS;
}
void rho_tracker_find_evidence_needed(struct step *step);
int rho_tracker_lacks_evidence(const struct step *step, const struct rho_track *track);
void rho_tracker_note_established(struct step *step, const struct rho_track *track);
void rho_tracker_note_early_end(struct step *step, const struct rho_track *track);

/* manoeuvre_interval.c: mean time between manoeuvres; learned from established tracks over dt_s */
void rho_tracker_learn_manoeuvre_interval(struct step *step, float dt_s);
/* After a silence the mean time between manoeuvres is the default again. */
void rho_tracker_reset_manoeuvre_interval(struct rho_tracker *tracker, int64_t time_us);

/* unobserved_tracks.c: how often sensors look; 1 where a track was not observed for too long */
void rho_tracker_forget_pace(struct rho_tracker *tracker, int32_t sensor_id);
/* sensor: where it looks from; NULL: the origin */
void rho_tracker_note_pace(struct rho_tracker *tracker, int32_t sensor_id,
                           const struct rho_sensor *sensor, int64_t time_us, float sector_from_rad,
                           float sector_to_rad);
int rho_tracker_is_long_unobserved(const struct step *step, struct rho_track *track, int is_missed,
                                   const struct rho_track_limits *limits);
/* The track's place is less well known than the range of its sensor. */
int rho_tracker_is_place_unknown(const struct step *step, const struct rho_track *track);

/* tracker.c: the filter of tracks of plots */
enum rho_track_filter rho_tracker_filter_of(const struct rho_tracker_config *config);
int rho_tracker_is_usable(const struct rho_tracker_config *config);

#endif
