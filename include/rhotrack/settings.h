/* SPDX-License-Identifier: MIT */
/*
 * settings: the properties of a radar and of its targets, set once for tracker and initiators.
 *
 *     struct rho_settings settings;
 *     struct rho_tracker_config track;
 *     struct rho_initiator_config start;
 *
 *     rho_settings_preset(&settings, RHO_PRESET_MARINE);
 *     settings.range_max_m = 20000.0f;
 *     if (rho_settings_check(&settings, &fault) != RHO_OK) {
 *         ... fault.field, fault.value, fault.min, fault.max
 *     }
 *     rho_tracker_config_default(&track);
 *     rho_initiator_config_default(&start);
 *     rho_settings_apply(&settings, &track, &start, NULL);
 *
 * A field that several configs have stands here once, so that tracker and initiators cannot
 * contradict each other. Fields of one config alone (gate, learn_noise_min, ...) are set
 * in that config after rho_settings_apply.
 *
 * While tracking, the same configs go to the live objects; tracks, identities and all that was
 * learned go on:
 *
 *     track = tracker.config;
 *     start = initiator.config;
 *     rho_settings_apply(&settings, &track, &start, NULL);
 *     rho_tracker_reconfigure(&tracker, &track);
 *     rho_initiator_reconfigure(&initiator, &start);
 *
 * Your radar, from its data sheet to the fields; tools/examples/presets has a program for each
 * preset below:
 *
 *   turns a minute, frame time    scan_interval_s: 60 / turns; the frame of a radar that stares
 *   instrumented and least range  range_max_m, range_min_m
 *   pulse, bandwidth              sigma_range_m: the cell, 150 m a us or 150 m / MHz, / 3.5
 *   beam width                    sigma_azimuth_rad, sigma_elevation_rad: / 4; monopulse: / 10
 *   accuracy, rms                 the sigma itself
 *   velocity resolution           sigma_range_rate_mps: / 3.5; scans have RHO_MEASURES_RANGE_RATE
 *   resolution                    resolution_range_m, resolution_azimuth_rad of struct rho_sensor;
 *                                 beside others resolution_range_rate_mps
 *   elevations                    scans have RHO_MEASURES_Z; z_m of struct rho_sensor
 *   unambiguous velocity +-v      range_rate_span_mps of struct rho_sensor: 2 v
 *   MTI: lowest and blind speed   notch_mps, blind_speed_mps of struct rho_sensor
 *   blanked or staring sector     sector_from_rad, sector_to_rad of struct rho_sensor
 *   plots in sectors of a turn    sector_from_rad, sector_to_rad of each scan
 *   place, mast, north mark       x_m, y_m, z_m, azimuth_bias_rad of struct rho_sensor
 *   a radar that moves            its place set anew before each scan; plots are over ground
 *   P_D of your targets           pd
 *   false-alarm rate              none: clutter is measured; false_tracks_per_hour is chosen
 *   your targets                  v_min_mps, v_max_mps, accel_max_mps2
 *
 * Compass angles, clockwise from north, are pi/2 - a here.
 *
 * Each field below says when it applies then: [step] from the next step on; [window] likewise, but
 * the initiation window begins anew, so that no track starts before its scans have come; [sensor]
 * by rho_tracker_set_sensor, from the next step on; [plot] by the plots that have it. A passive
 * search has its settings from rho_passive_init on: its batch begins anew, its tracks go on.
 *
 * Settings that rho_settings_check accepts are accepted by rho_tracker_init, rho_initiator_init,
 * rho_passive_init and rho_tracker_set_sensor. No settings object needs to be kept.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_SETTINGS_H
#define RHOTRACK_SETTINGS_H

#include <stdint.h>

#include "rhotrack/detail/window.h"
#include "rhotrack/initiator.h"
#include "rhotrack/passive.h"
#include "rhotrack/tracker.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

struct rho_settings {
    /* targets */
    /* [step] lowest speed of targets: 0 .. v_max_mps, exclusive; 0: targets may stand */
    float v_min_mps;
    float v_max_mps;      /* [step] highest speed of targets: 1 .. RHO_LIMIT_SPEED_MPS */
    float accel_max_mps2; /* [step] strongest manoeuvre that tracks follow: 0 .. 1000 */

    /* the sensor */
    /* [step, sensor] probability that a look sees the target: 0.01 .. 0.999 */
    float pd;
    /* [step] time from a look at a place to the next, a turn of the antenna: 1e-3 .. 3600 */
    float scan_interval_s;
    /* [plot] standard deviations of a plot: 1e-3 .. 1e5 m and m/s, 1e-6 .. 0.5 rad */
    float sigma_range_m, sigma_azimuth_rad, sigma_elevation_rad, sigma_range_rate_mps;
    float sigma_rad; /* [plot] standard deviation of a passive sensor's bearing: 1e-6 .. 0.5 */
    /* [sensor] range limits: 0 .. range_max_m, exclusive; 1 .. 2 RHO_LIMIT_POSITION_M */
    float range_min_m, range_max_m;
    /* [window] watched rectangle: min below max, each within RHO_LIMIT_POSITION_M either way */
    struct rho_extent area;
    /*
     * [window] 1: clutter and new targets are spread over `area`; 0: over the extent of plots seen
     */
    uint16_t area_is_fixed;

    /* decisions */
    uint16_t scans; /* [window] scans in the initiation window: 3 .. RHO_MAX_SCANS */
    /* [step] scans of the window in which a target needs a plot: 3 .. scans; 0: from the clutter */
    uint16_t min_scans;
    uint16_t coast_scans_max; /* [step] scans for which a track may coast: 1 .. 255 */
    uint32_t standing; /* [step] enum rho_tracker_standing: may tracks be of what never moved? */
    /* [step] tracks of clutter alone that are accepted: 1e-6 .. 1e6 */
    float false_tracks_per_hour;
    /*
     * [step] limit of the work of a step, units (struct rho_tracker_work): 0 .. RHO_LIMIT_WORK; 0:
     * none
     */
    uint32_t work_max;
};

/* The first field that rho_settings_check refuses. */
struct rho_settings_fault {
    const char *field; /* its name in struct rho_settings, as "v_max_mps" or "area.x_min_m" */
    float value;       /* the refused value */
    /* allowed range; max itself is refused for v_min_mps, range_min_m and the area's minima */
    float min, max;
};

/*
 * Kinds of radar. The figures are those of a typical installation, to begin with: what is known
 * better of a radar is set afterwards. EUROCONTROL: Standard Document for Radar Surveillance in
 * En-Route Airspace and Major Terminal Areas, 1997; IMO: resolution MSC.192(79), 2004.
 *
 *                        EN_ROUTE APPROACH  MARINE HARBOUR DRONES TRAFFIC
 *   v_min_mps                  40       20       0       0      0       0
 *   v_max_mps                 350      300      50      40     80      70
 *   accel_max_mps2              6        8       3       2     15      10
 *   pd                        0.9      0.9     0.8     0.9    0.8     0.9
 *   scan_interval_s            10        4     2.5       3      1    0.05
 *   sigma_range_m             120       60      15       5      5     0.2
 *   sigma_azimuth_rad      0.0026   0.0026   0.009   0.002  0.009    0.01
 *   sigma_elevation_rad    0.0026   0.0026   0.009   0.002   0.02    0.02
 *   sigma_range_rate_mps        1        1       1       1    0.5     0.1
 *   range_min_m              2000      500      40      50    100       1
 *   range_max_m            470000   110000   44000   37000  10000     250
 *   false_tracks_per_hour       1        1       1       1    0.2      10
 *   coast_scans_max             5        5      10      10      8      20
 *   standing              CLUTTER  CLUTTER TARGETS TARGETS TARGETS TARGETS
 *
 * Where a kind says nothing else: one false track an hour is what a person deletes by hand;
 * range_min_m is what the receiver needs behind the pulse. Elevations and range rates count where
 * a scan measures them: heights as well as azimuths, or a quarter of a beam of 5 degrees; range
 * rates of coarse Doppler filters. The other fields are those of rho_settings_default.
 */
enum rho_preset {
    /*
     * Air route surveillance, a turn in 10 s. Speeds: a light aircraft against the wind; an
     * airliner of 250 m/s in a jet stream of 100 m/s. Acceleration: a bank of 30 degrees, 5.7
     * m/s^2. Noise and pd: EUROCONTROL's limits for primary radars, 120 m, 0.15 degrees, 0.9. The
     * pulse of some 12 us is blind for 2 km; 470 km is 254 nautical miles.
     */
    RHO_PRESET_EN_ROUTE = 0,
    /*
     * Airport surveillance, a turn in 4 s. Speeds: a light aircraft on final approach against the
     * wind; an overflight. Acceleration: a turn of 3 degrees a second at 150 m/s, 7.9 m/s^2. Range
     * noise is half of EUROCONTROL's limit, as pulses are half as long or shorter; 110 km is 60
     * nautical miles.
     */
    RHO_PRESET_APPROACH,
    /*
     * A ship's X-band radar, 24 turns a minute, plots in coordinates over ground. Speeds: buoys and
     * ships at anchor; fast craft of 97 knots. Acceleration: a small boat's turn. Noise: IMO's
     * limits of 30 m and 1 degree, taken as two standard deviations. pd: IMO calls a target
     * detected that is seen in 8 of 10 scans. Ranges: IMO's nearest, 40 m; the scale of 24 nautical
     * miles. Coasting: small boats are behind waves for several turns, 10 are 25 s.
     */
    RHO_PRESET_MARINE,
    /*
     * Vessel traffic service on the shore, 20 turns a minute. Speeds: ships at berth; fast craft of
     * 78 knots. Acceleration: tugs and pilot boats. Noise: pulses of 50 ns are 7.5 m long, a beam
     * of 0.45 degrees is measured to a quarter of it. 37 km is 20 nautical miles. Coasting: a ship
     * passes behind another one for some 30 s.
     */
    RHO_PRESET_COASTAL_HARBOUR,
    /*
     * Search for small drones, 60 turns a minute. Speeds: a multicopter that hovers; one for races.
     * Acceleration: a bank of 57 degrees, 15 m/s^2. Noise: a bandwidth of 15 MHz has cells of 10 m,
     * beams of 2 degrees are measured to a quarter of it. pd: echoes of 0.01 m^2 at the limit of
     * the range. False tracks: each is an alarm, one in five hours. Coasting: 8 s behind trees.
     */
    RHO_PRESET_DRONE_DEFENCE,
    /*
     * A radar of 24 or 77 GHz that stands at a road, 20 looks a second. Speeds: a queue; a car of
     * 250 km/h. Acceleration: full braking, 1 g. Noise: a bandwidth of 250 MHz has cells of 0.6 m,
     * a small array knows the angle to half a degree, a frame of 20 ms the range rate to 0.1 m/s.
     * 250 m is what 77 GHz reaches, 24 GHz some 100 m. False tracks: vehicles are counted, and
     * ten an hour are few among a thousand. Coasting: 20 looks are 1 s behind a lorry.
     */
    RHO_PRESET_TRAFFIC,
    RHO_NUM_PRESETS /* number of kinds, not a kind */
};

/*
 * Defaults: v_min 0, v_max 700 m/s, accel_max 30 m/s^2, pd 0.9, a scan in 10 s, 15 m, 3 mrad,
 * 3 mrad, 1 m/s, bearings 1.75 mrad, 0 .. 100 km, area from the plots, 1 false track an hour,
 * 7 scans (or RHO_MAX_SCANS), min_scans 0, coast_scans_max 5, RHO_WORK_MAX: with these
 * rho_settings_apply leaves the defaults of tracker and initiator as they are. Constant cost.
 */
void rho_settings_default(struct rho_settings *settings);

/*
 * Fills in the settings of a kind of radar, or for any other value those of rho_settings_default.
 * Constant cost.
 */
void rho_settings_preset(struct rho_settings *settings, enum rho_preset preset);

/*
 * Checks that all fields of the settings are finite and within their ranges.
 *   fault  filled with the first field that is refused; unchanged where none is; may be NULL
 * Errors: NULL (settings), CONFIG. Constant cost.
 */
RHO_MUST_CHECK enum rho_status rho_settings_check(const struct rho_settings *settings,
                                                  struct rho_settings_fault *fault);

/*
 * Puts the settings into the configs of tracker and initiators, which their
 * rho_..._config_default has filled; a config may be NULL. The settings are not checked.
 *   tracker    v_min, v_max, accel_max, pd, coast_scans_max, standing, work_max; late_max_s becomes
 *              two scan intervals, at most 60 s
 *   initiator  v_min, v_max, pd, false_tracks_per_hour, scans, min_scans, work_max, area; turn_mps2
 *              becomes a fifth of accel_max_mps2: targets turn that hard for a whole window
 *   passive    v_max, pd, false_tracks_per_hour, work_max; range_max_m, at least 1 and at most 500
 *              km. `scans`, the rows of its batch, stays as it is
 * Constant cost.
 */
void rho_settings_apply(const struct rho_settings *settings, struct rho_tracker_config *tracker,
                        struct rho_initiator_config *initiator, struct rho_passive_config *passive);

/*
 * Puts pd, range_min_m and range_max_m into the description of a sensor; its other fields, as
 * identity and place, are the caller's. Constant cost.
 */
void rho_settings_apply_sensor(const struct rho_settings *settings, struct rho_sensor *sensor);

/* Puts the four sigmas of the settings into a polar plot; its other fields stay. Constant cost. */
void rho_settings_apply_noise(const struct rho_settings *settings, struct rho_polar_plot *plot);

RHO_END_C

#endif
