/* SPDX-License-Identifier: MIT */
/*
 * tracker: scans in, tracks out.
 *
 *     static struct rho_tracker tracker;
 *     static struct rho_initiator initiator;
 *     static struct rho_report report;
 *     ...
 *     rho_tracker_step(&tracker, &initiator, &scan, &report);
 *
 * One step a scan, in the order of time:
 *   predict   every live track that the scan can see (sector and range, with a margin) to its time
 *   claim     gate the plots, and assign them to tracks, each at most one
 *   update    the tracks with the plots that they were assigned
 *   age       count misses where the sensor looked; confirm tracks, and end them
 *   initiate  tracks from the plots that no track claimed
 *   report    tracks, one fate a plot, counters
 *
 * A scan is a whole turn of a radar, or a sector of a turn (RHO_SECTORS): sectors that each begin
 * where the previous one ended, clockwise or counter-clockwise, make up one turn. A target at the
 * edge of two sectors has one hit or one miss a turn; tracks start as from whole turns.
 *
 * A sensor that does not see the tracks that others see, or sees them elsewhere, is suspect (struct
 * rho_tracker_look, which rho_tracker_look_of returns). If the sensor was described, its plots are
 * given more noise.
 *
 * The stated coverage of a sensor (rho_tracker_set_sensor) bounds its plots, its misses, and the
 * time that tracks live without either. A track that no sensor covers ends after the time of
 * coast_scans_max scans. A track that a sensor covers, but does not look at, ends after four times
 * as long.
 *
 * A track that was confirmed has a probability that its target exists and is visible, or exists and
 * is hidden. Each look of each sensor changes it by that sensor's own P_D and clutter, so that a
 * sensor that sees little says little. Scans in which a sensor sees nothing of all its tracks are
 * taken for the sensor's. A track is reported as confirmed or coasting while the target probably
 * exists and clutter would not fill its place. Below that it is in doubt, where messages and files
 * leave it out, and it ends where next to nothing is left. How often targets leave and are hidden
 * is learned (rho_tracker_life).
 *
 * Where more tracks are found to be seldom seen than false_tracks_per_hour allows, a track stays
 * tentative until it is seen as often as targets are. A track also ends when the sigma of its place
 * exceeds its sensor's maximum range. Time is that of the scans: the tracks of a silent sensor end
 * at steps of other sensors, or at its own next step.
 *
 * A scan that is stepped twice counts twice, unless it is its sensor's newest; rho_scan_assembler
 * removes such copies. With several radars each scan is a step, in the order of time, with the
 * initiator of its sensor or a common one. Radars that send sectors need one initiator each.
 *
 * Earlier reports are never amended by later scans. The same scans give the same bytes on
 * every machine: there is no clock, no random number and no global variable inside. Calls on one
 * tracker must not overlap; several trackers are independent. The objects hold no pointers: a
 * memcpy is a snapshot (rhotrack/snapshot.h: one for flash or a file).
 *
 * Stack: 104 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_TRACKER_H
#define RHOTRACK_TRACKER_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/body.h"
#include "rhotrack/config.h"
#include "rhotrack/detail/assignment.h"
#include "rhotrack/detail/gate.h"
#include "rhotrack/detail/hypotheses.h"
#include "rhotrack/detail/input_estimation.h"
#include "rhotrack/detail/recurring_clutter_map.h"
#include "rhotrack/detail/second_plots.h"
#include "rhotrack/detail/track.h"
#include "rhotrack/detail/window.h"
#include "rhotrack/initiator.h"
#include "rhotrack/passive.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

/* How tracks choose among plots, and their filter; tracks of bearings have a Kalman filter. */
enum rho_tracker_gate {
    RHO_TRACKER_BEST = 0, /* several hypotheses over two motion models: imm, hypotheses */
    /* the method of the paper: Hough clutter elimination in a window of plots, input estimation */
    RHO_TRACKER_HOUGH,
    /* the likeliest plot in the gate, with input estimation: least work and memory */
    RHO_TRACKER_NEAREST,
    RHO_NUM_TRACKER_GATES
};

/* Whether tracks may be of echoes that never moved, where v_min_mps is 0. */
enum rho_tracker_standing {
    /* they are clutter once they have come back a few times; what moved, and then stands, is not */
    RHO_STANDING_CLUTTER = 0,
    /* they are targets: ships at berth, hovering drones, queues; and masts that are not taught */
    RHO_STANDING_TARGETS,
    RHO_NUM_STANDING
};

struct rho_tracker_config {
    float pd; /* detection probability of sensors that are not described: 0.01 .. 0.999 */
    /*
     * speed of the slowest target: a track that is surely slower is dropped; 0: none is. 0 ..
     * v_max_mps. The initiator should have the same value, or it starts such tracks again and again
     */
    float v_min_mps;
    /*
     * speed of the fastest target, and standard deviation of a new track's velocity before its
     * second plot: 1 .. RHO_LIMIT_SPEED_MPS. A track ends after three updates in a row with a speed
     * above it by a tenth, and by two standard deviations
     */
    float v_max_mps;
    float accel_max_mps2; /* largest acceleration of a manoeuvre: 0 .. 1000 */
    /*
     * gate best: mean time between manoeuvres of agile targets, 0 .. 1e5; at least the mean length
     * of a manoeuvre. A target that keeps straight becomes calm after a minute on average; the mean
     * time until it manoeuvres is then max(C, steady_s) (imm.h): C is 300 s, doubled up to 2400 s
     * where hardly any established track turns
     */
    float steady_s;
    /*
     * largest age of an out-of-sequence scan, against the newest scan, with which it still updates
     * tracks: 0 .. 60 s; 0: none does. Without RHO_SECTORS none does at any value
     */
    float late_max_s;
    /*
     * bounds of values learned for a sensor (struct rho_tracker_learned): factors on its sigmas,
     * 0.1 .. 1 and 1 .. 10; pd over the stated pd, 0.1 .. 1. 1: no learning in that direction
     */
    float learn_noise_min, learn_noise_max, learn_pd_min;
    /*
     * scans for which a track may coast, 1 .. 255: a hidden target appears again after 0.7 times
     * as many on average; a track that no sensor can see ends after the time of so many scans of
     * the sensors that saw it last
     */
    uint16_t coast_scans_max;
    uint8_t gate;      /* enum rho_tracker_gate */
    uint8_t planes;    /* gate hough: RHO_GATE_PLANE_... of the Hough transforms */
    uint32_t standing; /* enum rho_tracker_standing */
    /*
     * gates hough and nearest: input estimation; with is_estimated 0 a Kalman filter with white
     * acceleration of half accel_max for 1 s. Ignored where RHO_FILTERS has no input estimation
     */
    struct rho_input_config input;
    float theta_cell_rad; /* gate hough: size of a cell in theta, 1e-3 .. pi/2 */
    /*
     * gate hough: half side of the square about the prediction whose plots are candidates, at least
     * the box of the chi-square gate: 0 .. 2 RHO_LIMIT_POSITION_M, which is the whole scan, the
     * beam of the paper. 0: that box, widened by the distance that accel_max moves a target in
     * twice the time since the track's last plot. In scans without velocities the candidates are
     * the plots in the chi-square gate
     */
    float hough_window_m;
    /*
     * units of work (struct rho_tracker_work) that a step may do, up to 1e8; 0: no limit. Tracks
     * have half of it at most, clutter a quarter, and the search the rest, up to its own work_max
     */
    uint32_t work_max;
};

/* Counters since rho_tracker_init; all saturate. The counters of fates add up to plots_in. */
struct rho_tracker_counters {
    uint32_t scans_accepted, scans_late;
    uint32_t plots_in;
    uint32_t fates[RHO_NUM_FATES];
    uint32_t plots_outside;   /* invalid plots outside of the stated coverage of their sensor */
    uint32_t plots_initiated; /* held plots that started a track */
    uint32_t plots_clutter;   /* held plots that left the window unused */
    uint32_t tracks_started, tracks_confirmed, tracks_ended;
    /* ended tracks: not observed for too long or of too uncertain place; faster than v_max */
    uint32_t tracks_unseen, tracks_too_fast;
    /* starts refused, and tentative tracks ended for another one, as RHO_MAX_TRACKS were there */
    uint32_t tracks_no_room;
    uint32_t gate_plots_dropped; /* plots in a track's gate beyond RHO_MAX_GATE_PLOTS */
    /* candidates beyond RHO_MAX_CANDIDATES; of bearings, crossings beyond room and work */
    uint32_t candidates_dropped;
    uint32_t updates_refused;   /* numerically impossible updates: the track counts a miss */
    uint32_t hypotheses_cut;    /* hypotheses beyond RHO_MAX_HYPOTHESES */
    uint32_t scans_retrodicted; /* accepted scans that were late, by late_max_s at most */
    uint32_t sensors_suspected; /* times that a sensor became suspect */
    /* tracks that an operator ended; unclaimed plots in areas that an operator excluded */
    uint32_t tracks_dropped, plots_excluded;
};

/*
 * Work of steps, and effects of its limit work_max. A unit is 40 to 90 instructions of a Cortex-M4.
 * The search costs units as in struct rho_initiator_budget; a plot that one hypothesis of a track
 * scores 20 to 220, one in a Kalman filter's gate 12; an echo of clutter and a plot near it 4 or
 * 10; two plots near each other 12. Where more plots are near a track than its share allows, those
 * far from its expected place are left out and counted. Counters saturate, and only
 * rho_tracker_init clears them. work is at most work_max + RHO_TRACKER_WORK_BEYOND, as work that
 * was begun is finished. The search in bearings counts its own, struct rho_passive_work.
 */
#define RHO_TRACKER_WORK_BEYOND (RHO_INITIATOR_WORK_BEYOND + 64u * RHO_MAX_PLOTS)
struct rho_tracker_work {
    uint32_t work, work_worst; /* units of work of the last step, and of the worst step so far */
    uint32_t partial_steps;    /* steps in which the limit left out something */
    /* newest plots left out by the search, plots by each track, echoes, and neighbours of plots */
    uint32_t plots_not_tried;
};

/* Rows of the scan's plots, sorted by strips of x in a step; not used with a single strip. */
struct rho_tracker_strips {
    float x_min_m, per_m;                 /* where strip 0 begins; strips per metre */
    uint16_t starts[RHO_PLOT_STRIPS + 2]; /* strip s is plots[starts[s] .. starts[s + 1] - 1] */
    uint16_t plots[RHO_PLOT_STRIPS > 1 ? RHO_MAX_PLOTS : 1]; /* rows of plots, strip by strip */
};

/* A sensor's newest scan, and its health (RHO_SECTORS). */
struct rho_tracker_look {
    float sector_from_rad, sector_to_rad;
    int64_t time_us;
    /* thresholds of its initiator's last search: to start, to confirm a track; 0, 0: no search */
    int32_t start_mnat, confirm_mnat;
    /*
     * health, by confirmed tracks that another sensor had seen before: share of those tracks that
     * this sensor saw where it looked; mean NIS per dimension of its plots, 1 where its noise is as
     * stated. Means over the last `watched` looks and `watched_hits` hits, 16 at most
     */
    float seen_share, distance2;
    float sigma_m; /* stated noise of the newest of these plots, the larger horizontal sigma */
    uint16_t watched, watched_hits;
    uint16_t count; /* scans of the sensor so far, 1 .. 65535 and then 1 again */
    /* it contradicts the others: more noise, its misses do not count, it starts no tracks */
    uint16_t is_suspect;
};

/* Number of rings of range, equally wide up to range_max_m, in each of which a pd is learned. */
#define RHO_LEARN_RINGS 6

/*
 * Number of intervals of the absolute range rate over ground, in each of which looks and hits are
 * counted (RHO_DOPPLER_NOTCH): the first ends at 0.25 m/s, each next one at 1.41 times the end of
 * the one before, the last one has no end.
 */
#define RHO_LEARN_RATES (RHO_DOPPLER_NOTCH ? 16 : 1)

/*
 * Noise of a described sensor, learned from tracks that this sensor alone has seen, with the gate
 * best. It begins at the stated one, and is used where it surely differs: sigmas by more than an
 * eighth, within the bounds of the config.
 */
struct rho_tracker_learned {
    /* ln of learned over stated variance of plots, along the line of sight and across it */
    float log_noise[2];
    uint16_t innovations; /* innovations that log_noise was learned from; stops at 1000 */
    /*
     * looks and hits by interval of range rate, for a sensor of which no notch was stated. Where pd
     * in the first blind_rates intervals is far below that at faster ones, the sensor has a notch
     * there, which is used as if it were stated (gate best); its looks do not count for pd
     */
    unsigned blind_rates : 5;       /* intervals of the learned notch; 0: no notch */
    unsigned used_rates : 5;        /* those that the sensor's notch_mps covers now; 0: none */
    unsigned notches_forgotten : 2; /* false notches so far; after three none is learned */
    uint8_t rate_looks[RHO_LEARN_RATES], rate_hits[RHO_LEARN_RATES]; /* halved at 250 */
    /*
     * resolution cell along the line of sight and across it: ln of its square over that of the
     * default, and the weight of the estimate (RHO_SHARES_PLOTS)
     */
    float log_cell[2], cell_weight[2];
};

/* Pairs of a passive sensor's bearing and a plot of its track before it (bearing_errors.c). */
struct rho_bearing_errors {
    float pairs;  /* number; halved with the sums at 1000 */
    float weight; /* sum of weights */
    float excess; /* sum of weights times squares beyond the stated noise */
};

/* Scan interval of a sensor, measured in one direction. */
struct rho_tracker_pace {
    int32_t is_heard;  /* the sensor has sent a scan */
    float azimuth_rad; /* the direction: scans whose sector holds it are timed */
    float interval_s;  /* smoothed time between such scans; 0: not known yet */
    float x_m, y_m;    /* place of the sensor */
    int64_t time_us;   /* time of the last such scan */
};

/* Rings of range, then octants of azimuth, counter-clockwise from +x (east). */
#define RHO_PD_PLACES (RHO_LEARN_RINGS + 8)

/* Looks at visible targets at a place of a sensor, and their hits. */
struct rho_pd_place {
    float looks, hits; /* looks: times the ratio of the other kind of place */
    float excess;      /* hits over those expected by P_D of all looks, less 1; 0: chance */
};

/*
 * All that a tracker holds of one sensor. A sensor that is heard without a description has a row,
 * too, as long as there is room: a described sensor takes the place of the undescribed one that was
 * heard longest ago, and so does a new undescribed one.
 */
struct rho_tracker_sensor {
    /* as described, with learned noise and notch; of an undescribed one sensor_id alone */
    struct rho_sensor sensor;
    struct rho_tracker_learned learned; /* of a described sensor */
    struct rho_tracker_pace pace;
    float blind; /* probability that its next look sees no target, as its last one saw none */
    struct rho_tracker_look look; /* count 0: it has sent no scan of plots */
    struct rho_second_plots second_plots;
    float unclaimed_bearings; /* mean per scan */
    struct rho_bearing_errors bearing_errors;
    float looks, hits; /* looks at tracks that probably exist, and their probable hits */
    struct rho_pd_place places[RHO_PD_PLACES];
};

/* Groups of a scan's plots, each of one target (body.h); valid within a step only. */
struct rho_groups {
    uint16_t count;                                       /* groups */
    uint16_t first[RHO_BODY_PLOTS], last[RHO_BODY_PLOTS]; /* first and last plot of each group */
    uint16_t next[RHO_BODY_PLOTS];                        /* next plot in a plot's group */
    uint16_t of[RHO_BODY_PLOTS];                          /* group of each plot */
    uint16_t owner[RHO_BODY_PLOTS];        /* track whose body explains each plot best */
    float misfit[RHO_BODY_PLOTS];          /* -2 ln of each plot's likelihood by its owner's body */
    uint16_t contender[RHO_BODY_PLOTS];    /* track whose body explains a plot nearly as well */
    struct rho_plot plots[RHO_BODY_PLOTS]; /* each group as one plot */
};

/* Bodies of the tracks, where targets may give several plots a scan. */
struct rho_bodies {
    float length_max_m; /* longest body; 0: targets are points */
    uint16_t count;
    struct rho_body_filter of[RHO_BODY_TRACKS]; /* in the order of the tracks */
    struct rho_groups groups;
};

struct rho_tracker {
    uint32_t magic;
    uint32_t next_track_id;
    int64_t time_us; /* time of the last accepted scan */
    int has_time;    /* a scan was accepted */
    /* track scores that start and that confirm a track, by the initiators' last searches */
    int32_t start_mnat, confirm_mnat;
    /* mean per turn; a clutter density follows from it where no initiator measures one */
    float unclaimed_plots;
    float clutter_per_m2;     /* stated clutter density; 0: none */
    struct rho_extent extent; /* rectangle that holds all valid plots so far */
    uint16_t num_sensors;     /* described sensors: the first rows of `sensors` */
    uint16_t num_rows;   /* rows of `sensors` in use; further ones are of undescribed sensors */
    uint16_t num_tracks; /* live tracks, in the order of their identities */
    struct rho_tracker_config config;
    struct rho_tracker_counters counters;
    struct rho_tracker_work work;
    struct rho_tracker_sensor sensors[RHO_MAX_SENSORS];
    /* counts that fade in half an hour: tracks found to be seldom seen; that reached 16 hits */
    float seldom, established;
    /* of established tracks: scans lived, ends, returns of hidden targets */
    float lived, gone, returned;
    /* seconds of established tracks, fading, too: not surely manoeuvring; surely manoeuvring */
    float straight_s, turning_s;
    float wanted_per_hour; /* false_tracks_per_hour of the last initiator */
    int64_t counted_us;    /* time at which the counts above were faded last */
    struct rho_track tracks[RHO_MAX_TRACKS];
    struct rho_assignment assignment;
    struct rho_hypotheses hypotheses; /* pool of all tracks' hypotheses (gate best) */
    struct rho_tracker_strips strips;
    struct rho_clutter_map clutter_map;
    uint16_t num_reflectors;
    uint16_t num_excluded;
    struct rho_reflector reflectors[RHO_MAX_REFLECTORS > 0 ? RHO_MAX_REFLECTORS : 1];
    struct rho_extent excluded[RHO_MAX_EXCLUDED_AREAS > 0 ? RHO_MAX_EXCLUDED_AREAS : 1];
    struct rho_bodies bodies;
};

/*
 * Report of one track: its estimate at the step's time. For a track that the scan could not see,
 * the last estimate is extrapolated to that time with its acceleration.
 */
struct rho_track_report {
    uint32_t track_id;
    enum rho_track_status status;
    uint16_t hits, misses;
    int32_t sensor_id; /* sensor of the last claimed plot */
    int32_t plot;      /* row of the plot claimed in this scan; -1: none */
    /* time from the last claimed plot to the scan's time; 0 where the plot is later */
    int32_t update_age_us;
    float score_nat;
    float state[RHO_KALMAN_STATES];
    float covariance[RHO_TRIANGLE(RHO_KALMAN_STATES)];
    float sigma_m, sigma_mps; /* rho_track_sigma_m, rho_track_sigma_mps */
    float accel_mps2[3];
    /* gate best: probability of the manoeuvring model; else 1 with an input present, 0 without */
    float maneuver_probability;
    uint16_t num_hypotheses; /* gate best: hypotheses of the track; else 1 */
    uint8_t is_in_doubt;     /* tentative after it was confirmed: messages and files leave it out */
};

/* The result of one step. Tracks in the order of their identities. */
struct rho_report {
    int64_t time_us;
    /*
     * plots of the scan: `fates` holds those of the first RHO_MAX_PLOTS; further plots are CLAIMED,
     * INVALID or NO_ROOM, or STALE in a late scan
     */
    uint32_t num_plots;
    uint16_t num_tracks, num_ended;
    uint32_t is_partial;                 /* the limit on work left out something */
    uint32_t fates_total[RHO_NUM_FATES]; /* number of plots with each fate; sum: num_plots */
    uint8_t fates[RHO_MAX_PLOTS];        /* enum rho_fate */
    struct rho_track_report tracks[RHO_MAX_TRACKS];
    /* identities of tracks that had been confirmed and ended in this step */
    uint32_t ended[RHO_MAX_TRACKS];
};

/* "free", "tentative", "confirmed", "coasting"; else "unknown". Constant cost. Stack: 0 bytes. */
const char *rho_track_status_name(enum rho_track_status status);

/*
 * Accuracy of one of the tracker's tracks: root of the mean variance of position (velocity) over
 * the axes that were measured so far, m (m/s). Constant cost. Stack: 32 bytes.
 */
float rho_track_sigma_m(const struct rho_track *track);
float rho_track_sigma_mps(const struct rho_track *track);

/*
 * Fills the default configuration: pd 0.9, v_min 0, v_max 700 m/s, accel_max 30 m/s^2, steady 0 s,
 * late_max 20 s, learn_noise_min 0.7, learn_noise_max 4, learn_pd_min 0.1, coast_scans_max 5, gate
 * best (nearest where RHO_FILTERS has no hypotheses); for the gates hough and nearest no input
 * estimation, planes xy, xz and yz, cells of 5 degrees. Constant cost. Stack: 80 bytes.
 */
void rho_tracker_config_default(struct rho_tracker_config *config);

/*
 * Initialises an empty tracker; the config is copied.
 *   size   sizeof(struct rho_tracker) of the caller
 * Errors: NULL, SIZE, CONFIG (a field outside its range, or a filter that is none of RHO_FILTERS).
 * Cost: sizeof(tracker) bytes cleared. Stack: 420 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_init(struct rho_tracker *tracker, size_t size,
                                                const struct rho_tracker_config *config);

/*
 * Begins anew after a change of the sensors' clock: tracks, sensors and what was learned of them
 * are dropped. Configuration, counters, work, walls, excluded areas, the length of bodies and the
 * clutter map's standing echoes stay.
 * Errors: NULL, STATE (not initialised). Cost: sizeof(tracker) bytes cleared. Stack: 500 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_restart(struct rho_tracker *tracker);

/*
 * Changes the configuration, from the next step on; tracks and all learned values are kept. Tracks
 * that the new configuration does not keep (slower than v_min) end in the next step. Errors: NULL,
 * STATE (not initialised; or there are tracks, and gate or input.is_estimated would change their
 * filter), CONFIG (as rho_tracker_init); nothing is changed. Constant cost. Stack: 500 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_reconfigure(struct rho_tracker *tracker,
                                                       const struct rho_tracker_config *config);

/*
 * Describes a sensor, or replaces its description by sensor_id; values learned for it are kept, and
 * are applied to the new description. Errors: NULL, STATE, CONFIG (a field outside its range),
 * CAPACITY (RHO_MAX_SENSORS). Cost: RHO_MAX_SENSORS. Stack: 120 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_set_sensor(struct rho_tracker *tracker,
                                                      const struct rho_sensor *sensor);

/*
 * Removes the description of a sensor and all that was learned for it: its scans use the defaults
 * from then on, and there is room for another sensor.
 * Errors: NULL, STATE (not initialised, or not described). Cost: RHO_MAX_SENSORS. Stack: 112 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_forget_sensor(struct rho_tracker *tracker,
                                                         int32_t sensor_id);

/*
 * States the clutter density of the next scans, plots a m^2, where no initiator measures it: that
 * of a beam which follows its target does not follow from the plots of all scans. Clutter counts as
 * uniform over 20 km of height and all velocities up to v_max. 0: it is measured, as before a call.
 * Errors: NULL, STATE, VALUE (not 0 .. 1e30). Constant cost.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_set_clutter(struct rho_tracker *tracker, float per_m2);

/* Noise, detection probability, notch and resolution of a sensor, as learned and used. */
struct rho_tracker_known {
    float range_factor, cross_factor; /* factors on the stated sigmas of its plots */
    float pd[RHO_LEARN_RINGS];        /* by ring of range */
    uint32_t innovations, looks;      /* numbers from which factors and pd were learned */
    float lasting_rad;                /* sigma of errors of its bearings that last; 0: none */
    /* notch, learned where none was stated (RHO_DOPPLER_NOTCH); 0: none */
    float notch_mps;
    /* resolution cell in sigmas, learned where none was stated (RHO_SHARES_PLOTS); 0: not yet */
    float resolution_range_sigmas, resolution_cross_sigmas;
};

/* Rates of targets' lives by scan interval: learned over half an hour; appear by the config. */
struct rho_tracker_life {
    float death, hide, appear;
    float lived_scans; /* scans from which they were learned */
};

/* Rates of targets' lives; 0 where the tracker is not initialised. Constant cost. */
struct rho_tracker_life rho_tracker_life(const struct rho_tracker *tracker);

/*
 * Fills the learned values of a described sensor. Errors: NULL, STATE (not initialised, or the
 * sensor was not described). Constant cost. Stack: 128 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_known_of(const struct rho_tracker *tracker,
                                                    int32_t sensor_id,
                                                    struct rho_tracker_known *known);

/*
 * Record of a sensor's newest scan of plots and its health; NULL: it has sent none, or other
 * sensors have taken its row (struct rho_tracker_sensor). Cost: RHO_MAX_SENSORS.
 */
const struct rho_tracker_look *rho_tracker_look_of(const struct rho_tracker *tracker,
                                                   int32_t sensor_id);

/*
 * Probabilities of where a track's plot is, in the last step, before each plot is assigned to one
 * track. gain is the score of a plot in the track's gate over that of a miss, nats. The plot is the
 * target's with the probability p = e^gain / (1 + sum of e^gain over the plots in the gate); r is
 * its e^gain over the sum of e^gain of all tracks for the same plot.
 *
 *     support = sum of p r      shared = sum of p (1 - r)      clutter = 1 - sum of p
 *
 * are the truth, indeterminacy and falsity of neutrosophic sets, and add up to 1. In a scan
 * in parts (RHO_CLAIMS_BEYOND) they are those of the last part.
 */
struct rho_tracker_evidence {
    float support; /* probability of a plot that is this track's alone */
    float shared;  /* probability of a plot that other tracks may have, too */
    float clutter; /* probability that no plot is the target's: those in the gate are clutter */
};

/*
 * Computes the evidence of one track in the last step. track: its index in the report. Returns 0,
 * with *evidence unchanged, where none is known: no such track, started in this step, not looked
 * at, or built without RHO_KEEPS_OFFERS. Cost: plots in the track's gate times those in all gates.
 * Stack: 120 bytes.
 */
int rho_tracker_evidence_of(const struct rho_tracker *tracker, unsigned track,
                            struct rho_tracker_evidence *evidence);

/*
 * Processes one scan of plots in all phases above.
 *   initiator  NULL: existing tracks are maintained, none is started, unclaimed plots are held
 *              nowhere (fate NO_ROOM)
 *   scan       num_plots plots; bad ones get the fate INVALID. Tracks may also claim plots beyond
 *              RHO_MAX_PLOTS (RHO_CLAIMS_BEYOND), up to 4 RHO_MAX_PLOTS and 32767; unclaimed ones
 *              beyond RHO_MAX_PLOTS are NO_ROOM. A scan older than the newest accepted one is late.
 *              If it is late by late_max_s at most, tracks are moved back to its time, claim its
 *              plots and count misses as at any scan (in a sector: where it holds the whole gate).
 *              Tracks start from it where it is the newest scan that the initiator was given; else
 *              its unclaimed plots are STALE. If it is later, all its plots are STALE, and nothing
 *              else changes but counters.
 *   report     filled completely; after a late scan that updates tracks, at the newest scan's time
 * Errors: NULL (tracker, scan, report, plots of a scan that has some), CONFIG (initiator, without
 * RHO_SEARCHES), STATE (tracker or initiator not initialised), VALUE (a sector beyond one turn
 * either way, a time beyond RHO_LIMIT_TIME_US); nothing is changed, *report neither.
 * Cost: live tracks x plots gate tests, the assignment, updates, and one rho_initiator_search of
 * the newest scan.
 * Stack: 3.8 KB (embedded profile).
 */
RHO_MUST_CHECK enum rho_status rho_tracker_step(struct rho_tracker *tracker,
                                                struct rho_initiator *initiator,
                                                const struct rho_scan *scan,
                                                struct rho_report *report);

/*
 * Starts a track from plots that another initiator has found: the papers' Hough transforms
 * (hough.h), or one of the caller. The tracker is stepped without an initiator (NULL); after each
 * step that initiator takes the unclaimed plots, which have the fate NO_ROOM.
 *   plots      num_plots >= 1 of any scans so far, as rho_track_start takes them; row is that in
 *              the last step's scan, or -1
 *   score_mnat track score, less the caller's threshold: the track is confirmed from 0 on,
 *              tentative below until plots have raised it to 0, and ends below -4605. In a tracker
 *              that was also stepped with an initiator, the thresholds of that initiator hold
 *   report     report of the last step; the new track is added to it
 * In a full tracker the tentative track with the lowest score below this one ends (tracks_no_room).
 * Errors: NULL, STATE (not initialised, or the report is not the last step's), VALUE (num_plots, a
 * score at which tracks end or beyond 1e9, a plot later than the last scan by more than
 * RHO_LIMIT_OFFSET_US, a row beyond the scan), CAPACITY (no room), and those of rho_track_start; no
 * track is started, and *report is unchanged.
 * Cost: a filter step a plot, and the report. Stack: 3 KB.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_start_track(struct rho_tracker *tracker,
                                                       const struct rho_track_plot *plots,
                                                       unsigned num_plots, int32_t score_mnat,
                                                       struct rho_report *report);

/*
 * Starts a track, as rho_tracker_start_track, but from an estimate at the time of the last step,
 * made from hits >= 1 scans: from bearings, or by a filter of the caller. sensor_id is one of the
 * sensors of these scans. Errors: NULL, STATE, and those of rho_track_start_estimate; VALUE for a
 * score at which tracks end, a place or speed beyond its limit, and a covariance that is none
 * (variances outside RHO_VARIANCE_MIN .. MAX, not positive definite, or of closed axes).
 * Stack: 2.6 KB.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_start_estimate(struct rho_tracker *tracker,
                                                          const struct rho_kalman *estimate,
                                                          int32_t sensor_id, uint16_t hits,
                                                          int32_t score_mnat,
                                                          struct rho_report *report);

/*
 * Processes one scan of bearings in all phases, as rho_tracker_step does one of plots. Both may be
 * mixed: they update the same tracks. Sensors look when they like; those that look at one time come
 * one after the other.
 *   passive  NULL: existing tracks are maintained, none is started, unclaimed bearings are held
 *            nowhere (fate NO_ROOM); else its batch takes the bearings, and tracks are challenged
 *            (rho_passive_challenge) once a row. A found track with a score of start_mnat or more
 *            is started, confirmed at once, or takes the place of one that it beats.
 *   scan     bad bearings get the fate INVALID, those beyond RHO_MAX_BEARINGS NO_ROOM. A scan older
 *            than the newest accepted one is late: all its bearings are STALE
 *   report   filled whole
 * Errors: NULL, STATE (tracker or passive not initialised; with passive a second scan of one time),
 * CONFIG (passive, without RHO_SEARCHES), VALUE (a place that is no coordinate, a sector beyond one
 * turn either way, a time beyond RHO_LIMIT_TIME_US), and those of rho_passive_accepts; nothing is
 * changed, *report neither.
 * Cost: live tracks x bearings gate tests, an assignment, updates, and once a row of looks a
 * rho_passive_challenge.
 * Stack: 4.8 KB (embedded profile).
 */
RHO_MUST_CHECK enum rho_status rho_tracker_step_bearings(struct rho_tracker *tracker,
                                                         struct rho_passive *passive,
                                                         const struct rho_bearing_scan *scan,
                                                         struct rho_report *report);

/*
 * True where a tracker of unknown origin (a snapshot, memory that outlived a reset) is safe to use:
 * counts and indices are within their arrays, numbers within their limits. rho_snapshot_load tests
 * it. Cost: tracks and hypotheses. Stack: 850 bytes.
 */
int rho_tracker_is_sound(const struct rho_tracker *tracker);

RHO_END_C

#endif
