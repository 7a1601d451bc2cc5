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
 * A scan is a whole turn of a radar, or a sector of it (RHO_SECTORS): sectors that go on where the
 * one before ended, either way round, are one turn. A target at the edge of two has one hit or one
 * miss a turn; tracks start as from whole turns.
 *
 * A sensor that does not see the tracks that others see, or sees them elsewhere, is suspect (see
 * struct rho_tracker_look; rho_tracker_look_of finds a sensor's). If it was described, the noise of
 * its plots is taken as larger.
 *
 * The stated coverage of a sensor (rho_tracker_set_sensor) bounds its plots, its misses, and the
 * time that tracks live without either. A track that no sensor covers ends after the time of
 * coast_scans_max scans. A track that a sensor covers, but does not look at, ends after four times
 * as long. When a sensor looks there again after so long, and misses the track or sees it amid
 * clutter, the track is tentative until it is seen once more; it ends at the third miss in a row.
 *
 * Where more confirmed tracks end early than false_tracks_per_hour allows, a new track stays
 * tentative until it is seen as often as targets are, or 16 times. A track also ends when its place
 * is known no better than its sensor's range. Time is that of the scans: the tracks of a silent
 * sensor end at steps of other sensors, or at its own next one.
 *
 * Stepping a scan twice counts it twice, unless it is that sensor's newest: rho_scan_assembler
 * tells them apart. With several radars each scan is a step, in the order of time, with the
 * initiator of its sensor or a common one. Sectors of several radars need an initiator each.
 *
 * Nothing flows back: earlier reports are never amended. The same scans give the same bytes on
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
#include "rhotrack/detail/clutter_map.h"
#include "rhotrack/detail/gate.h"
#include "rhotrack/detail/hypotheses.h"
#include "rhotrack/detail/input.h"
#include "rhotrack/detail/split_plots.h"
#include "rhotrack/detail/track.h"
#include "rhotrack/detail/window.h"
#include "rhotrack/initiator.h"
#include "rhotrack/passive.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * How tracks choose among plots, and the filter that follows the target. Tracks of bearings have a
 * plain Kalman filter.
 */
enum rho_tracker_gate {
    RHO_TRACKER_BEST = 0, /* several hypotheses over two motion models: imm, hypotheses */
    /* the paper: Hough clutter elimination among the plots of a window, input estimation */
    RHO_TRACKER_HOUGH,
    /* the likeliest plot in the gate, input estimation: least work and memory */
    RHO_TRACKER_NEAREST,
    RHO_NUM_TRACKER_GATES
};

struct rho_tracker_config {
    float pd; /* assumed of sensors that are not in the table: 0.01 .. 0.999 */
    /*
     * slowest target: a track that is surely slower follows something that stands, and is dropped;
     * 0: none. 0 .. v_max_mps. The initiator is to have the same, or it starts one after the other
     * there.
     */
    float v_min_mps;
    /*
     * sd of a new track's velocity before its second plot: 1 .. RHO_LIMIT_SPEED_MPS. A track ends
     * that three updates in a row leave faster by a tenth, and by two standard deviations
     */
    float v_max_mps;
    float accel_max_mps2; /* manoeuvres to follow: 0 .. 1000 */
    /*
     * best: mean time between manoeuvres of agile targets, 0 .. 1e5; where that is less than they
     * last, as long as these. A target that keeps straight becomes calm in a minute on average, and
     * keeps straight for max(C, steady_s) then (imm.h): C is 300 s, doubled up to 2400 s where
     * hardly an established track turns
     */
    float steady_s;
    /*
     * scans that are older than the newest by so much at most update tracks all the same; 0: none.
     * 0 .. 60 s; without RHO_SECTORS no older scan updates tracks, whatever stands here
     */
    float late_max_s;
    /*
     * bounds of what is learned of a sensor (struct rho_tracker_learned): of the factors on its
     * plots' sigmas, 0.1 .. 1 and 1 .. 10; and of the share of its stated pd, 0.1 .. 1. With 1
     * nothing is learned on that side
     */
    float learn_noise_min, learn_noise_max, learn_pd_min;
    /*
     * misses in a row that end a track, 1 .. 255: one of 16 hits is only in doubt then, tentative,
     * and ends after 2.4 times as many, as long as its gate is not full of clutter. And scans, in
     * the time that the sensors that saw it last take for them, for which a track coasts that no
     * sensor can see
     */
    uint16_t coast_scans_max;
    uint8_t gate;   /* enum rho_tracker_gate */
    uint8_t planes; /* hough: RHO_GATE_PLANE_... */
    /*
     * gates hough and nearest: is_estimated 0 is a Kalman filter with white acceleration of half
     * accel_max for 1 s; not looked at where RHO_FILTERS has no input estimation
     */
    struct rho_input_config input;
    float theta_cell_rad; /* hough: 1e-3 .. pi/2 */
    /*
     * hough: all plots so near to the prediction, along x and along y, are candidates, at least
     * those in the chi-square gate's box: 0 .. 2 RHO_LIMIT_POSITION_M, the whole scan, which is the
     * paper's beam. 0: that box, wider by as far as accel_max moves a target in twice the time
     * since the track's last plot. Of scans that measure no velocities: those in the chi-square
     * gate
     */
    float hough_window_m;
    /*
     * work that a step may do, up to 1e8 units (struct rho_tracker_work); 0: no limit. Tracks have
     * half of it at most, clutter a quarter, the search what is left, and at most its own work_max
     */
    uint32_t work_max;
};

/* Since init; all saturate. The fates' counters add up to plots_in. */
struct rho_tracker_counters {
    uint32_t scans_accepted, scans_late;
    uint32_t plots_in;
    uint32_t fates[RHO_NUM_FATES];
    uint32_t plots_outside;   /* of the invalid: outside of the stated coverage of their sensor */
    uint32_t plots_initiated; /* of the held: started a track */
    uint32_t plots_clutter;   /* of the held: left the window unused */
    uint32_t tracks_started, tracks_confirmed, tracks_ended;
    /* of the ended: not looked at for longer than coasting allows, or of unknown place; too fast */
    uint32_t tracks_unseen, tracks_too_fast;
    /* starts refused, or tentative tracks that gave way: RHO_MAX_TRACKS */
    uint32_t tracks_no_room;
    uint32_t gate_plots_dropped; /* RHO_MAX_GATE_PLOTS */
    uint32_t candidates_dropped; /* RHO_MAX_CANDIDATES */
    uint32_t updates_refused;    /* numerically impossible updates: the track counts a miss */
    uint32_t hypotheses_cut;     /* RHO_MAX_HYPOTHESES */
    uint32_t scans_retrodicted;  /* of the accepted: late, by late_max_s at most */
    uint32_t sensors_suspected;  /* times that a sensor became suspect */
    /* by an operator: of the ended; plots in excluded areas that no track claimed */
    uint32_t tracks_dropped, plots_excluded;
};

/*
 * Effects of the limits on work. A unit is 40 to 90 instructions of a Cortex-M4: those of struct
 * rho_initiator_budget; 20 to 220 for a plot that one hypothesis of a track scores, or 12 by a
 * Kalman filter's gate; for an echo of clutter and a plot near it 4 or 10, for two plots near each
 * other 12. Where plots crowd in a track's gate those far from its expected place are left out, and
 * the counters move. All saturate, and only rho_tracker_init clears them. work is at most work_max
 * and RHO_TRACKER_WORK_BEYOND: work that was begun is finished. The search of the passive initiator
 * does not count: its cost follows from the capacities alone.
 */
#define RHO_TRACKER_WORK_BEYOND (RHO_INITIATOR_WORK_BEYOND + 64u * RHO_MAX_PLOTS)
struct rho_tracker_work {
    uint32_t work, work_worst; /* units of the last step, of the worst one */
    uint32_t partial_steps;    /* steps that left something out */
    /* newest plots that the search left out; and by each track; echoes and plots' neighbours that
     * were not looked for */
    uint32_t plots_not_tried;
};

/* The plots of the scan that is stepped, by strips of x; of no use with a single strip. */
struct rho_tracker_strips {
    float x_min_m, per_m;
    uint16_t starts[RHO_PLOT_STRIPS + 2]; /* of strip s: from starts[s] to starts[s + 1] in ... */
    uint16_t plots[RHO_PLOT_STRIPS > 1 ? RHO_MAX_PLOTS : 1]; /* ... their rows */
};

/* A sensor's newest scan (RHO_SECTORS). */
struct rho_tracker_look {
    int32_t sensor_id;
    float sector_from_rad, sector_to_rad;
    int64_t time_us;
    /*
     * of the last search of its initiator: scores that start and confirm a track; 0, 0: there was
     * none
     */
    int32_t start_mnat, confirm_mnat;
    /*
     * of confirmed tracks that another sensor had seen before: share of those that it saw where it
     * looked, and the plots' squared distances a dimension, 1 on average where all is well; over
     * the last `watched` looks and hits, 16 at most
     */
    float seen_share, distance2;
    float sigma_m; /* that the newest of these plots claims, the larger one in the plane */
    uint16_t watched, watched_hits;
    uint16_t count; /* its scans so far, 1 .. 65535 round and round */
    /*
     * suspect: it contradicts the others; its plots' noise counts for more, its misses not at all,
     * and it starts no tracks
     */
    uint16_t is_suspect;
};

/* Rings of range of equal widths, out to a sensor's range_max_m, that its pd is learned by. */
#define RHO_LEARN_RINGS 6

/*
 * Intervals of the range rate over ground, either way, from 0 on: the first one to 0.25 m/s, each
 * next one 1.41 times as far, the last one without end (RHO_DOPPLER_NOTCH).
 */
#define RHO_LEARN_RATES (RHO_DOPPLER_NOTCH ? 16 : 1)

/*
 * Noise and detection probability of a described sensor, as its tracks show them. Both begin at the
 * stated values, and are used where they surely differ: sigmas by more than an eighth, within the
 * bounds of the config; pd only where it is less. With the gate best alone: noise of tracks that
 * this sensor alone has seen, pd at looks of the sensor that saw the track last.
 */
struct rho_tracker_learned {
    float log_noise
        [2]; /* ln of what the variances are of those stated, along the line of sight, across */
    uint16_t innovations; /* that they come from; ends at 1000 */
    /*
     * by ring of range: looks at tracks that had been seen at the look before, and those that saw
     * them; both are halved at 1000
     */
    uint16_t looks[RHO_LEARN_RINGS], hits[RHO_LEARN_RINGS];
    uint8_t is_lowered; /* bit i: in ring i pd is used as learned */
    uint8_t ring;       /* that is learned next, one a scan */
    /*
     * the same by the range rate, of a sensor of which no notch was stated. In the first
     * blind_rates intervals it sees targets so much worse than above that it has a notch there,
     * which is used as if it were stated (gate best); those looks are none of the rings'
     */
    unsigned blind_rates : 5;       /* as learned */
    unsigned used_rates : 5;        /* as the sensor's notch_mps has it now */
    unsigned notches_forgotten : 2; /* that were none; after three no more is learned */
    uint8_t rate_looks[RHO_LEARN_RATES], rate_hits[RHO_LEARN_RATES]; /* halved at 250 */
    /* resolution cell, along the line of sight and across: ln of what its square is of the first
     * one's, and the weight of that (RHO_SHARES_PLOTS) */
    float log_cell[2], cell_weight[2];
};

/* How often a sensor looks at a place. */
struct rho_tracker_pace {
    int32_t sensor_id;
    float azimuth_rad; /* a direction: the scans that hold it are counted */
    float interval_s;  /* from one to the next, smoothed; 0: not known yet */
    float x_m, y_m;    /* its place */
    int64_t time_us;   /* of the last of them */
};

/* The plots of a scan as groups (body.h); what a step leaves is of no use after it. */
struct rho_groups {
    uint16_t count;
    uint16_t first[RHO_BODY_PLOTS], last[RHO_BODY_PLOTS]; /* plots of each group, */
    uint16_t next[RHO_BODY_PLOTS];                        /* each with the next one */
    uint16_t of[RHO_BODY_PLOTS];                          /* group of each plot */
    uint16_t owner[RHO_BODY_PLOTS];                       /* track of each plot */
    float misfit[RHO_BODY_PLOTS];                         /* with that */
    uint16_t contender[RHO_BODY_PLOTS];    /* another track whose body explains it nearly as well */
    struct rho_plot plots[RHO_BODY_PLOTS]; /* of each group */
};

/* Targets that are more than points. */
struct rho_bodies {
    float length_max_m; /* 0: they are points */
    uint16_t count;
    struct rho_body_filter of[RHO_BODY_TRACKS]; /* in the order of the tracks */
    struct rho_groups groups;
};

struct rho_tracker {
    uint32_t magic;
    uint32_t next_track_id;
    int64_t time_us; /* of the last accepted scan */
    int has_time;
    /* scores that start and confirm a track: the initiator's, of its last search */
    int32_t start_mnat, confirm_mnat;
    /* a scan, smoothed: the clutter density where no initiator measures it */
    float unclaimed_plots;
    float unclaimed_bearings; /* a passive sensor's scan, smoothed */
    struct rho_extent extent; /* of all valid plots so far */
    uint16_t num_sensors;
    uint16_t num_tracks; /* live ones, in the order of their identities */
    uint16_t looks_max;  /* scans of a frame, the most so far; 1 before */
    struct rho_tracker_config config;
    struct rho_tracker_counters counters;
    struct rho_tracker_work work;
    struct rho_sensor sensors[RHO_MAX_SENSORS];
    struct rho_tracker_learned learned[RHO_MAX_SENSORS]; /* of the same */
    /*
     * tracks that misses ended before they had 16 hits, and those that had; of the last half an
     * hour
     */
    float ended_early, established;
    float straight_s, turning_s; /* of those that had, surely; of the last half an hour, too */
    float wanted_per_hour;       /* false tracks, by the last initiator */
    int64_t counted_us;
    uint32_t num_paces;
    struct rho_tracker_pace paces[RHO_MAX_SENSORS]; /* of the sensors that were heard last */
    uint32_t num_looks;
    struct rho_tracker_look looks[RHO_MAX_SENSORS]; /* of the sensors that came first */
    struct rho_track tracks[RHO_MAX_TRACKS];
    struct rho_assignment assignment;
    struct rho_hypotheses hypotheses; /* of the gate best */
    struct rho_tracker_strips strips;
    struct rho_clutter_map clutter_map;
    struct rho_second_plots second_plots[RHO_MAX_SENSORS]; /* of the sensors that came first */
    uint16_t num_reflectors;
    uint16_t num_excluded;
    struct rho_reflector reflectors[RHO_MAX_REFLECTORS > 0 ? RHO_MAX_REFLECTORS : 1];
    struct rho_extent excluded[RHO_MAX_EXCLUDED_AREAS > 0 ? RHO_MAX_EXCLUDED_AREAS : 1];
    struct rho_bodies bodies;
};

/*
 * One track as reported: the estimate at the step's time. Of a track that the scan could not see it
 * is the last one, moved there with its acceleration.
 */
struct rho_track_report {
    uint32_t track_id;
    enum rho_track_status status;
    uint16_t hits, misses;
    int32_t sensor_id; /* of the last claimed plot */
    int32_t plot;      /* row of the plot claimed in this scan; -1: none */
    /* scan's time after the last claimed plot's own; 0 where that is later */
    int32_t update_age_us;
    float score_nat;
    float state[RHO_KALMAN_STATES];
    float covariance[RHO_TRIANGLE(RHO_KALMAN_STATES)];
    float sigma_m, sigma_mps; /* root mean variance over the measured axes */
    float accel_mps2[3];
    /* best: of the manoeuvring model; else 1 where an input is present, 0 where not */
    float maneuver_probability;
    uint16_t num_hypotheses; /* best; else 1 */
};

/* The result of one step. Tracks in the order of their identities. */
struct rho_report {
    int64_t time_us;
    /*
     * of the scan: fates of the first RHO_MAX_PLOTS follow; the others are claimed, INVALID or
     * NO_ROOM, or STALE of a late scan
     */
    uint32_t num_plots;
    uint16_t num_tracks, num_ended;
    uint32_t is_partial;                 /* work ended before all plots were tried */
    uint32_t fates_total[RHO_NUM_FATES]; /* add up to num_plots */
    uint8_t fates[RHO_MAX_PLOTS];        /* enum rho_fate */
    struct rho_track_report tracks[RHO_MAX_TRACKS];
    /* identities of tracks that had been confirmed and ended in this step */
    uint32_t ended[RHO_MAX_TRACKS];
};

/*
 * Name of a status: "free", "tentative", "confirmed", "coasting"; "unknown" for any other value.
 * Constant cost. Stack: 0 bytes.
 */
const char *rho_track_status_name(enum rho_track_status status);

/*
 * Of one of the tracker's tracks: root of the mean position (velocity) variance over the axes that
 * were measured so far, metres (metres a second). Constant cost. Stack: 32 bytes.
 */
float rho_track_sigma_m(const struct rho_track *track);
float rho_track_sigma_mps(const struct rho_track *track);

/*
 * pd 0.9, v_min 0, v_max 700 m/s, accel_max 30 m/s^2, steady 0 s, late_max 20 s, learn_noise_min
 * 0.7, learn_noise_max 4, learn_pd_min 0.5, coast_scans_max 5, gate best (nearest where RHO_FILTERS
 * has no hypotheses); hough and nearest without input estimation, planes xy, xz and yz, cells of 5
 * degrees. Constant cost. Stack: 80 bytes.
 */
void rho_tracker_config_default(struct rho_tracker_config *config);

/*
 * Prepares an empty tracker; the config is copied.
 *   size   sizeof(struct rho_tracker) of the caller
 * Errors: NULL, SIZE, CONFIG (a field outside its range, or a filter that is none of RHO_FILTERS).
 * Cost: sizeof(tracker) bytes cleared. Stack: 384 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_init(struct rho_tracker *tracker, size_t size,
                                                const struct rho_tracker_config *config);

/*
 * Gives a tracker another configuration, from the next step on; tracks and all that was learned go
 * on. Tracks that it would not keep (slower than v_min, missed coast_scans_max times) end there.
 * Errors: NULL, STATE (not initialised; there are tracks, and their filter is another one: of gate
 * or input.is_estimated), CONFIG (as rho_tracker_init); nothing is changed. Constant cost. Stack:
 * 500 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_reconfigure(struct rho_tracker *tracker,
                                                       const struct rho_tracker_config *config);

/*
 * Describes a sensor, or replaces the description of the same sensor_id; what was learned of it
 * stays, and is applied to the new description.
 * Errors: NULL, STATE, CONFIG (a field outside its range), CAPACITY (RHO_MAX_SENSORS). Cost:
 * RHO_MAX_SENSORS.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_set_sensor(struct rho_tracker *tracker,
                                                      const struct rho_sensor *sensor);

/*
 * Forgets the description of a sensor: its scans use the defaults from then on, and there is room
 * for another one.
 * Errors: NULL, STATE (not initialised, or not described). Cost: RHO_MAX_SENSORS. Stack: 112 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_forget_sensor(struct rho_tracker *tracker,
                                                         int32_t sensor_id);

/* A sensor's noise and detection probability, as learned. */
struct rho_tracker_known {
    float range_factor, cross_factor; /* that its plots' sigmas count */
    float pd[RHO_LEARN_RINGS];        /* by ring of range */
    uint32_t innovations, looks;      /* that was learned from */
    /* learned of a sensor of which no notch was stated (RHO_DOPPLER_NOTCH); 0: none */
    float notch_mps;
    /* resolution cell in sigmas of plots, where none was stated (RHO_SHARES_PLOTS); 0: not learned
     */
    float resolution_range_sigmas, resolution_cross_sigmas;
};

/* Errors: NULL, STATE (not initialised, or the sensor was not described). Constant cost.
 * Stack: 128 bytes. */
RHO_MUST_CHECK enum rho_status rho_tracker_known_of(const struct rho_tracker *tracker,
                                                    int32_t sensor_id,
                                                    struct rho_tracker_known *known);

/*
 * The health of a sensor that has sent scans; NULL: it has sent none, or RHO_MAX_SENSORS others
 * since. Cost: RHO_MAX_SENSORS.
 */
const struct rho_tracker_look *rho_tracker_look_of(const struct rho_tracker *tracker,
                                                   int32_t sensor_id);

/*
 * Of the last step, for one track: how its evidence divides among what may be true. Each plot that
 * the track's gate offered has the odds e^gain over none being the target's, the gain that the gate
 * compares plots by, before plots are given to one track each. So its probability p is e^gain / (1
 * + sum of e^gain); r is the share of this e^gain among those of all tracks for the same plot.
 *
 *     support = sum of p r      shared = sum of p (1 - r)      clutter = 1 - sum of p
 *
 * the truth, indeterminacy and falsity of neutrosophic sets: they add up to 1. Of a frame it is the
 * last sensor's scan, of a scan in parts (RHO_CLAIMS_BEYOND) the last part.
 */
struct rho_tracker_evidence {
    float support; /* plots that the track alone is likely to have given */
    float shared;  /* the part of its plots that other tracks claim, too */
    float clutter; /* that no plot is the target's: those near it are clutter, or there is none */
};

/*
 * track: place among the tracker's tracks, which is that in the report. Returns 0 where nothing is
 * known, and *evidence is unchanged: no such track, started in this step, not looked at, or built
 * without RHO_KEEPS_OFFERS. Cost: offered plots of the track times
 * those of all tracks. Stack: 120 bytes.
 */
int rho_tracker_evidence_of(const struct rho_tracker *tracker, unsigned track,
                            struct rho_tracker_evidence *evidence);

/*
 * Takes one scan through all phases above.
 *   initiator  NULL: existing tracks are maintained, none is started, unclaimed plots are held
 *              nowhere (fate NO_ROOM)
 *   scan       num_plots plots; bad ones get the fate INVALID. Of those beyond RHO_MAX_PLOTS tracks
 *              may claim (RHO_CLAIMS_BEYOND), in the first 4 RHO_MAX_PLOTS and 32767 of the scan;
 *              unclaimed ones are not held, but NO_ROOM. A scan older than the newest
 *              accepted one is late. By late_max_s at most, tracks are moved back to its time,
 *              claim its plots and are missed as at any scan (of a sector: where all of the gate is
 *              in it). Tracks start from it where it is the newest that the initiator was given;
 *              else the other plots are STALE. Beyond that all its plots are, and but for counters
 *              nothing else changes.
 *   report     filled whole, whatever it held before; of a late scan that updates tracks at the
 *              newest scan's time
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
 * (hough.h), or the caller's own. The tracker is stepped without an initiator (NULL); after a
 * step the caller's initiator takes the plots with the fate NO_ROOM, which no track has claimed.
 *   plots      num_plots >= 1 of any scans so far, as rho_track_start takes them; row is that in
 *              the last step's scan, or -1
 *   score_mnat evidence for a target, above the caller's threshold: the track is confirmed at 0 and
 *              more, tentative below until plots have raised it to 0, and ends below -4605. A
 *              tracker that was also stepped with an initiator compares with that one's thresholds
 *   report     of the last step; it shows the new track from now on
 * A full tracker gives up its lowest tentative track below the score (tracks_no_room).
 * Errors: NULL, STATE (not initialised, or the report is not the last step's), VALUE (num_plots, a
 * score at which tracks end or beyond 1e9, a plot later than the last scan by more than
 * RHO_LIMIT_OFFSET_US, a row beyond the scan), CAPACITY (no room), and those of rho_track_start; no
 * track is started, and *report is unchanged.
 * Cost: a filter step a plot, and the report. Stack: 2.9 KB.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_start_track(struct rho_tracker *tracker,
                                                       const struct rho_track_plot *plots,
                                                       unsigned num_plots, int32_t score_mnat,
                                                       struct rho_report *report);

/*
 * The same from an estimate at the time of the last step, made of hits >= 1 scans: of bearings, or
 * by a filter of the caller's own. sensor_id is one of the sensors that saw it. Errors: NULL,
 * STATE, and those of rho_track_start_estimate; VALUE for a score too low. Stack: 2.6 KB.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_start_estimate(struct rho_tracker *tracker,
                                                          const struct rho_kalman *estimate,
                                                          int32_t sensor_id, uint16_t hits,
                                                          int32_t score_mnat,
                                                          struct rho_report *report);

/*
 * Takes one frame of bearings through all phases: its scans in their order, each with the bearings'
 * own times.
 *   passive  NULL: existing tracks are maintained, none is started, unclaimed bearings are held
 *            nowhere (fate NO_ROOM); else its batch takes the unclaimed bearings, and once it is
 *            full it is searched at each step. A found track with passive->start_mnat or more is
 *            started, and confirmed at once.
 *   frame    one scan a sensor; bad bearings get the fate INVALID, those beyond RHO_MAX_BEARINGS of
 *            a scan NO_ROOM. A frame older than the last accepted scan or frame is late: all its
 *            bearings are STALE
 *   report   filled whole; fates in the order of the frame's scans. A track's plot and sensor_id
 *            are those of the last bearing that it claimed
 * A track has one hit or one miss a frame; its score counts every sensor. Frames and scans of plots
 * may be mixed: they update the same tracks.
 * Errors: NULL, STATE (tracker or passive not initialised), CONFIG (passive, without RHO_SEARCHES),
 * VALUE (a place that is no coordinate, a sector beyond one turn either way, a time beyond
 * RHO_LIMIT_TIME_US, a scan farther than RHO_LIMIT_OFFSET_US from its frame), and those of
 * rho_passive_accepts; nothing is changed, *report neither.
 * Cost: live tracks x bearings gate tests, an assignment a scan, updates, and one
 * rho_passive_search.
 * Stack: 4.2 KB (embedded profile).
 */
RHO_MUST_CHECK enum rho_status rho_tracker_step_frame(struct rho_tracker *tracker,
                                                      struct rho_passive *passive,
                                                      const struct rho_frame *frame,
                                                      struct rho_report *report);

/*
 * True where the object may be worked with, wherever its bytes come from (a snapshot, memory that
 * outlived a reset): counts and places are within what they count, numbers within their limits.
 * rho_snapshot_load asks it. Cost: tracks and hypotheses. Stack: 850 bytes.
 */
int rho_tracker_is_sound(const struct rho_tracker *tracker);

#ifdef __cplusplus
}
#endif

#endif
