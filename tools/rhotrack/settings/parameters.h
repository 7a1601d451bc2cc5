/* SPDX-License-Identifier: MIT */
/*
 * parameters: all parameters of --set and --config: units, defaults, ranges, values and their
 * sources.
 *
 * Precedence, highest first: CSV column (applied by the readers), --set, --config FILE (INI), a
 * method's or scenario's own default, the default of the table below.
 */
#ifndef RHOTRACK_TOOL_PARAMETERS_H
#define RHOTRACK_TOOL_PARAMETERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "rhotrack/initiator.h"
#include "rhotrack/scan_assembler.h"
#include "rhotrack/settings.h"
#include "rhotrack/tracker.h"
#include "rhotrack/zones.h"

/*
 * Table of parameters: X(id, name, unit, default, min, max, is_integer, has_default, text). A
 * parameter with has_default 0 is unset until a source sets it.
 */
#define PARAMETERS(X)                                                                              \
    X(SCANS, "scans", "-", 7, 3, 12, 1, 1, "N: scans in the initiation window")                    \
    X(MIN_SCANS, "min_scans", "-", 0, 0, 12, 1, 1,                                                 \
      "M: scans of the window that must have voted; 0: chosen from the "                           \
      "clutter density")                                                                           \
    X(FALSE_TRACKS_PER_HOUR, "false_tracks_per_hour", "1/h", 1, 1e-6, 1e6, 0, 1,                   \
      "wanted rate of confirmed tracks from clutter")                                              \
    X(SCORE_MIN_NAT, "score_min_nat", "nat", 0, -100, 1000, 0, 0,                                  \
      "score that starts and confirms a track; overrides false_tracks_per_hour")                   \
    X(SIGMA_M, "sigma_m", "m", 10, 0.001, 1e5, 0, 1, "position noise of a plot, each axis")        \
    X(SIGMA_MPS, "sigma_mps", "m/s", 1, 0.001, 1e5, 0, 1, "velocity noise of a plot, each axis")   \
    X(SIGMA_RANGE_M, "sigma_range_m", "m", 15, 0.001, 1e5, 0, 1, "range noise of a plot")          \
    X(SIGMA_AZIMUTH_RAD, "sigma_azimuth_rad", "rad", 0.003, 1e-6, 0.5, 0, 1,                       \
      "azimuth noise of a plot")                                                                   \
    X(SIGMA_ELEVATION_RAD, "sigma_elevation_rad", "rad", 0.003, 1e-6, 0.5, 0, 1,                   \
      "elevation noise of a polar plot")                                                           \
    X(SIGMA_ALT_M, "sigma_alt_m", "m", 30, 0.001, 1e5, 0, 1,                                       \
      "noise of alt_m of a polar plot, a transponder's height")                                    \
    X(SIGMA_RANGE_RATE_MPS, "sigma_range_rate_mps", "m/s", 1, 0.001, 1e5, 0, 1,                    \
      "range-rate noise of a plot")                                                                \
    X(RANGE_RATE_SPAN_MPS, "range_rate_span_mps", "m/s", 0, 0, 4e4, 0, 1,                          \
      "range rates are known up to multiples of it; 0: not ambiguous")                             \
    X(NOTCH_MPS, "notch_mps", "m/s", 0, 0, 4e4, 0, 1,                                              \
      "a sensor is blind to range rates over ground within it of 0; 0: to none")                   \
    X(BLIND_SPEED_MPS, "blind_speed_mps", "m/s", 0, 0, 4e4, 0, 1,                                  \
      "and within notch_mps of multiples of it, as of pulse repetition frequencies; 0: to none")   \
    X(RESOLUTION_RANGE_M, "resolution_range_m", "m", 0, 0, 1e5, 0, 1,                              \
      "of two targets nearer than that in range, azimuth and range rate a sensor makes one plot; " \
      "0: not known")                                                                              \
    X(RESOLUTION_AZIMUTH_RAD, "resolution_azimuth_rad", "rad", 0, 0, 1, 0, 1,                      \
      "in azimuth; 0: not known")                                                                  \
    X(RESOLUTION_RANGE_RATE_MPS, "resolution_range_rate_mps", "m/s", 0, 0, 1e4, 0, 1,              \
      "in range rate; 0: range rates do not tell targets apart")                                   \
    X(SIGMA_RAD, "sigma_rad", "rad", 0.00175, 1e-6, 0.5, 0, 1,                                     \
      "bearing noise of a passive sensor")                                                         \
    X(FRAME_TOLERANCE_S, "frame_tolerance_s", "s", 0.05, 0, 60, 0, 1,                              \
      "looks of passive sensors within it are one frame of initiate")                              \
    X(PD, "pd", "-", 0.9, 0.01, 0.999, 0, 1, "assumed probability of detection")                   \
    X(V_MIN_MPS, "v_min_mps", "m/s", 0, 0, 2e4, 0, 1,                                              \
      "slowest target; what is surely slower is none")                                             \
    X(V_MAX_MPS, "v_max_mps", "m/s", 700, 1, 2e4, 0, 1, "fastest target")                          \
    X(RANGE_MIN_M, "range_min_m", "m", 0, 0, 2e6, 0, 1, "nearest range a sensor sees")             \
    X(RANGE_MAX_M, "range_max_m", "m", 100000, 1, 2e6, 0, 1, "farthest range a sensor sees")       \
    X(ACCEL_MAX_MPS2, "accel_max_mps2", "m/s^2", 30, 0, 1000, 0, 1,                                \
      "manoeuvres that maintenance follows")                                                       \
    X(STEADY_S, "steady_s", "s", 0, 0, 1e5, 0, 1,                                                  \
      "mean time between manoeuvres of agile targets; 0: as long as they last")                    \
    X(INITIATORS, "initiators", "-", 0, 0, 2, 1, 1,                                                \
      "tracks start from the plots of two radars that see the same, of each sensor, or of all")    \
    X(PROCESS_NOISE_MPS2, "process_noise_mps2", "m/s^2", 0, 0, 1000, 0, 1,                         \
      "acceleration that the initiation window allows for; 0: straight")                           \
    X(TURN_MPS2, "turn_mps2", "m/s^2", 0, 0, 1000, 0, 0,                                           \
      "standard deviation of targets' accelerations while found; 0: straight; unset: accel_max/5") \
    X(BODY_MAX_M, "body_max_m", "m", 0, 0, 5000, 0, 1,                                             \
      "longest target, which may give several plots a scan; 0: targets are points")                \
    X(WORK_MAX, "work_max", "-", RHO_WORK_MAX, 0, 1e8, 1, 1,                                       \
      "units of work, a scan (20 to 200 instructions), tracks first; 0: no limit")                 \
    X(COAST_SCANS_MAX, "coast_scans_max", "-", 5, 1, 255, 1, 1,                                    \
      "scans for which a track may coast, as its target may be hidden or out of sight")            \
    X(STANDING, "standing", "-", 0, 0, 1, 1, 1,                                                    \
      "what never moved is clutter, or may be a target, where v_min_mps is 0")                     \
    X(LATE_MAX_S, "late_max_s", "s", 20, 0, 60, 0, 1,                                              \
      "older scans update tracks where they are no older than the newest by this")                 \
    X(LEARN_NOISE_MIN, "learn_noise_min", "-", 0.7, 0.1, 1, 0, 0,                                  \
      "plots' sigmas as learned: least share of those stated that is used; 1: never less")         \
    X(LEARN_NOISE_MAX, "learn_noise_max", "-", 4, 1, 10, 0, 0,                                     \
      "the same: the most; 1: never more")                                                         \
    X(LEARN_PD_MIN, "learn_pd_min", "-", 0.1, 0.1, 1, 0, 0,                                        \
      "pd as learned: least share of that stated; 1: as stated")                                   \
    X(LEARN_REFLECTORS, "learn_reflectors", "-", 1, 0, 1, 1, 1,                                    \
      "walls that show targets twice are learned; 0: those of reflectors alone are known")         \
    X(SCAN_INTERVAL_S, "scan_interval_s", "s", 0, 0, 60, 0, 1,                                     \
      "rows of a sensor within it are one scan; 0: rows of equal t_s; unset: turns, if found")     \
    X(FRAME_RATE_HZ, "frame_rate_hz", "Hz", 0, 0.01, 1000, 0, 0,                                   \
      "column frame in place of t_s: times are numbers of frames over it")                         \
    X(AREA_X_MIN_M, "area_x_min_m", "m", 0, -2e6, 2e6, 0, 0,                                       \
      "area of clutter and births; unset: seen so far")                                            \
    X(AREA_X_MAX_M, "area_x_max_m", "m", 0, -2e6, 2e6, 0, 0, "")                                   \
    X(AREA_Y_MIN_M, "area_y_min_m", "m", 0, -2e6, 2e6, 0, 0, "")                                   \
    X(AREA_Y_MAX_M, "area_y_max_m", "m", 0, -2e6, 2e6, 0, 0, "")                                   \
    X(HOLD_MS, "hold_ms", "ms", 20, 0, 10000, 0, 1,                                                \
      "messages, and rows with received_s: wait for parts of a scan, and for earlier scans")       \
    X(JUMP_MAX_S, "jump_max_s", "s", 30, 1, 3600, 0, 1,                                            \
      "messages: gap in a sensor's times, or between sensors, that is believed at once")           \
    X(FOLLOW_SCANS, "follow_scans", "-", 3, 2, 255, 1, 1,                                          \
      "messages: scans in a row that must agree on new numbers or times")                          \
    X(FLOOD_PER_S, "flood_per_s", "1/s", 10000, 1, 1e6, 1, 1,                                      \
      "messages: of one sensor that are looked at")                                                \
    X(STRANGER_PLOTS_PER_S, "stranger_plots_per_s", "1/s", 256, 1, 1e6, 1, 1,                      \
      "messages: plots of all newcomers that are not named here")                                  \
    X(FOLLOW_QUIET_S, "follow_quiet_s", "s", 2, 0.1, 3600, 0, 1,                                   \
      "track --follow: the last scan is complete when the file has not grown for so long")         \
    X(ASTERIX_SCANS, "asterix_scans", "-", 0, 0, 1, 1, 1,                                          \
      "recordings in ASTERIX: a scan is each sector of a turn of the antenna, or all of it")       \
    X(ASTERIX_HOLD_S, "asterix_hold_s", "s", 1, 0.1, 60, 0, 1,                                     \
      "publish udp://: wait for the plots of a sector so long after its end")                      \
    X(ASTERIX_SAC, "asterix_sac", "-", 0, 0, 255, 1, 1,                                            \
      "system area and identification code of tracks written in ASTERIX")                          \
    X(ASTERIX_SIC, "asterix_sic", "-", 0, 0, 255, 1, 1, "")                                        \
    X(LOG_FILE_MB, "log_file_mb", "MB", 0, 0, 1e6, 0, 1,                                           \
      "node --log: so much goes into a file, then into another one; 0: any")                       \
    X(LOG_FILE_S, "log_file_s", "s", 0, 0, 31622400, 0, 1,                                         \
      "node --log: a new file at each multiple of it, UTC (86400: at midnight); 0: none")          \
    X(LOG_FILES, "log_files", "-", 0, 0, 1e6, 1, 1,                                                \
      "node --log: earlier files that are kept, the newest; 0: all")                               \
    X(ORIGIN_LAT_DEG, "origin_lat_deg", "deg", 0, -90, 90, 0, 0,                                   \
      "of the local frame, where latitudes and longitudes are used; passed on in RHO_STATUS")      \
    X(ORIGIN_LON_DEG, "origin_lon_deg", "deg", 0, -180, 180, 0, 0, "")                             \
    X(ORIGIN_ALT_M, "origin_alt_m", "m", 0, -1e4, 1e5, 0, 0,                                       \
      "above the WGS 84 ellipsoid; unset: 0")                                                      \
    X(D_RHO_M, "d_rho_m", "m", 5, 0.001, 1e5, 0, 1, "all methods but kernel: cell of rho")         \
    X(D_THETA_RAD, "d_theta_rad", "rad", 0.001, 1e-4, 0.5, 0, 1,                                   \
      "all methods but kernel: cell of theta")                                                     \
    X(EPS_RHO_M, "eps_rho_m", "m", 20, 0.001, 1e5, 0, 1,                                           \
      "ht, mht, iht, nht: within 2 of it lines are neighbours, and peaks are one")                 \
    X(EPS_THETA_RAD, "eps_theta_rad", "rad", 0.004, 1e-4, 0.5, 0, 1, "the same in theta")          \
    X(P_FALSE, "p_false", "-", 0.01, 0, 1, 0, 1, "nht: P_F, false alarm rate of the sensor")       \
    X(LAMBDA_K, "lambda_k", "-", 1, 0, 1e6, 0, 1,                                                  \
      "nht: adjustment factor of the falsity lambda_k P_F^2")                                      \
    X(TAU, "tau", "-", 0.5, 0, 1, 0, 1,                                                            \
      "ht, mht, iht, nht: votes of a peak, as a share of the most")                                \
    X(VOTES_MIN, "votes_min", "-", 0, 0, 65535, 0, 1,                                              \
      "ht, mht, iht, nht, passive-paper: votes of a peak; 0: passive-paper takes 4/5 of the "      \
      "scans")                                                                                     \
    X(NHT_READING, "nht_reading", "-", 1, 0, 1, 1, 1,                                              \
      "nht: votes go to the pair's own cell (a) or all cells around it (c)")                       \
    X(NHT_INDETERMINACY, "nht_indeterminacy", "-", 0, 0, 1, 1, 1,                                  \
      "nht: 1: the line between the two best kernels counts too")                                  \
    X(VOTE, "vote", "-", 0, 0, 1, 1, 1,                                                            \
      "ht, passive-paper: a cell's votes are distinct scans, or plots")                            \
    X(PRUNE, "prune", "-", 0, 0, 2, 1, 1,                                                          \
      "passive-paper: which crossings of bearings are left out as ghosts")                         \
    X(METHOD, "method", "-", 0, 0, 4, 1, 1,                                                        \
      "track, node: how plots start tracks; --method goes before it")                              \
    X(BEARINGS_METHOD, "bearings_method", "-", 0, 0, 1, 1, 1,                                      \
      "track, node: how bearings start tracks; --method goes before it")                           \
    X(GATE, "gate", "-", 0, 0, 3, 1, 1,                                                            \
      "how tracks choose their plots; --gate goes before it; none: maintain alone")                \
    X(INPUT_ESTIMATION, "input_estimation", "-", 0, 0, 1, 1, 1,                                    \
      "track: 1: hough and nearest estimate inputs, as maintain does")                             \
    X(GAMMA, "gamma", "-", 1, 0.01, 1, 0, 1,                                                       \
      "hough, nearest: forgetting of the estimated input a scan; 1: none")                         \
    X(INPUT_MODEL, "input_model", "-", 0, 0, 1, 1, 1,                                              \
      "hough, nearest: what an input does to a place in T: nothing, as the paper, or T^2/2")       \
    X(INPUT_SIGMA_MPS2, "input_sigma_mps2", "m/s^2", 22.36, 0.001, 1e4, 0, 1,                      \
      "hough, nearest: inputs before they are estimated, each axis; root of V(0)")                 \
    X(ONSET_CONFIDENCE, "onset_confidence", "-", 0.95, 0.5, 0.9999, 0, 1,                          \
      "hough, nearest: of the test for an input")                                                  \
    X(FILTER_NOISE_M, "filter_noise_m", "m", 1, 0, 1e5, 0, 1,                                      \
      "hough, nearest: process noise a scan, each axis; root of Q")                                \
    X(FILTER_NOISE_MPS, "filter_noise_mps", "m/s", 1, 0, 1e4, 0, 1, "the same of velocities")      \
    X(INITIAL_VARIANCE, "initial_variance", "-", 0, 0, 1e12, 0, 1,                                 \
      "hough, nearest: P(0|0) is this times I; 0: by the plots' noise and v_max_mps")              \
    X(PLANES, "planes", "-", 7, 1, 7, 1, 1, "hough: planes of velocity space that count")          \
    X(GATE_THETA_DEG, "gate_theta_deg", "deg", 5, 0.1, 90, 0, 1, "hough: cell of theta")           \
    X(GATE_WINDOW_M, "gate_window_m", "m", 0, 0, 4e6, 0, 1,                                        \
      "hough: plots so near to the prediction are candidates; 0: as accel_max_mps2 needs")         \
    X(GOSPA_CUTOFF_M, "gospa_cutoff_m", "m", 1000, 0.001, 1e6, 0, 1,                               \
      "distance beyond which a track and a target are not paired")                                 \
    X(TURNING_MPS2, "turning_mps2", "m/s^2", 0.02, 0, 1e4, 0, 1,                                   \
      "evaluate: a target whose velocity changes by more turns")                                   \
    X(REFERENCE_SENSOR, "reference_sensor", "-", 0, -2147483648.0, 2147483647, 1, 0,               \
      "register: the radar whose time counts as right; unset: the lowest number")                  \
    X(TIME_TOLERANCE_S, "time_tolerance_s", "s", 0.001, 0.001, 60, 0, 1,                           \
      "evaluate: the truth's times have the nearest tracks, so far off at most, led there")        \
    X(TRUTH_GAP_S, "truth_gap_s", "s", 0, 0, 1e6, 0, 1,                                            \
      "evaluate: no target between truth rows farther apart; 0: 5 times its usual interval")

enum parameter_id {
#define X(id, name, unit, value, min, max, is_integer, has_default, text) PARAMETER_##id,
    PARAMETERS(X)
#undef X
        NUM_PARAMETERS,
    /* Settings of experiments' scenarios, without names: not settable by users. */
    PARAMETER_CLUTTER_PER_KM2 = NUM_PARAMETERS,
    PARAMETER_CLUTTER_PER_SCAN,
    PARAMETER_TRUE_PD,
    PARAMETER_MERGE_M,
    PARAMETER_NUM_SCANS,
    PARAMETER_INTERVAL_S,
    PARAMETER_TARGETS,
    PARAMETER_SPACING_M,
    NUM_VALUES
};

#define PARAMETER_REASON_BYTES 256

/* late_max_s is so many scan intervals, and PARAMETER_LATE_LIMIT_S at most. */
#define PARAMETER_LATE_SCANS 2.0
#define PARAMETER_LATE_LIMIT_S 60.0

enum parameter_source {
    SOURCE_UNSET,
    SOURCE_DEFAULT,
    SOURCE_METHOD,
    SOURCE_PRESET,
    SOURCE_CONFIG,
    SOURCE_SET
};

/*
 * Table of the parameters of a single sensor, of INI section [sensor N] or --set
 * sensor.N.key=value: X(id, name, unit, min, max, text).
 */
#define SENSOR_PARAMETERS(X)                                                                       \
    X(PD, "pd", "-", 0.01, 0.999, "assumed probability of detection")                              \
    X(SIGMA_M, "sigma_m", "m", 0.001, 1e5, "position noise of a plot, each axis")                  \
    X(SIGMA_MPS, "sigma_mps", "m/s", 0.001, 1e5, "velocity noise of a plot, each axis")            \
    X(SIGMA_RANGE_M, "sigma_range_m", "m", 0.001, 1e5, "range noise of a plot")                    \
    X(SIGMA_AZIMUTH_RAD, "sigma_azimuth_rad", "rad", 1e-6, 0.5, "azimuth noise of a plot")         \
    X(SIGMA_ELEVATION_RAD, "sigma_elevation_rad", "rad", 1e-6, 0.5,                                \
      "elevation noise of a polar plot")                                                           \
    X(SIGMA_ALT_M, "sigma_alt_m", "m", 0.001, 1e5, "noise of alt_m of a polar plot")               \
    X(SIGMA_RANGE_RATE_MPS, "sigma_range_rate_mps", "m/s", 0.001, 1e5,                             \
      "range-rate noise of a plot")                                                                \
    X(RANGE_RATE_SPAN_MPS, "range_rate_span_mps", "m/s", 0, 4e4,                                   \
      "its range rates are known up to multiples of it")                                           \
    X(NOTCH_MPS, "notch_mps", "m/s", 0, 4e4, "it is blind to range rates within it of 0")          \
    X(BLIND_SPEED_MPS, "blind_speed_mps", "m/s", 0, 4e4,                                           \
      "and within notch_mps of multiples of it")                                                   \
    X(RESOLUTION_RANGE_M, "resolution_range_m", "m", 0, 1e5,                                       \
      "it makes one plot of two targets nearer than that in range, azimuth and range rate")        \
    X(RESOLUTION_AZIMUTH_RAD, "resolution_azimuth_rad", "rad", 0, 1, "in azimuth")                 \
    X(RESOLUTION_RANGE_RATE_MPS, "resolution_range_rate_mps", "m/s", 0, 1e4, "in range rate")      \
    X(SIGMA_RAD, "sigma_rad", "rad", 1e-6, 0.5, "bearing noise of a passive sensor")               \
    X(RANGE_BIAS_M, "range_bias_m", "m", -1e4, 1e4, "it measures ranges so much too long")         \
    X(AZIMUTH_BIAS_RAD, "azimuth_bias_rad", "rad", -0.5, 0.5,                                      \
      "it measures azimuths so much too far counter-clockwise")                                    \
    X(TIME_BIAS_S, "time_bias_s", "s", -10, 10, "its plots are so much older than they say")       \
    X(RANGE_MIN_M, "range_min_m", "m", 0, 2e6, "nearest range it sees")                            \
    X(RANGE_MAX_M, "range_max_m", "m", 1, 2e6, "farthest range it sees")                           \
    X(SECTOR_FROM_RAD, "sector_from_rad", "rad", -6.2831853, 6.2831853,                            \
      "it can look counter-clockwise from here")                                                   \
    X(SECTOR_TO_RAD, "sector_to_rad", "rad", -6.2831853, 6.2831853, "to here; equal: all round")   \
    X(X_M, "x_m", "m", -2e6, 2e6, "its place")                                                     \
    X(Y_M, "y_m", "m", -2e6, 2e6, "")                                                              \
    X(Z_M, "z_m", "m", -2e6, 2e6, "")                                                              \
    X(LAT_DEG, "lat_deg", "deg", -90, 90, "its place on the earth, instead of x_m, y_m, z_m")      \
    X(LON_DEG, "lon_deg", "deg", -180, 360, "")                                                    \
    X(ALT_M, "alt_m", "m", -1e4, 1e5, "above the WGS 84 ellipsoid; unset: origin_alt_m")

enum sensor_parameter_id {
#define X(id, name, unit, min, max, text) SENSOR_##id,
    SENSOR_PARAMETERS(X)
#undef X
        NUM_SENSOR_PARAMETERS
};

struct sensor_parameters {
    int32_t sensor_id;
    double value[NUM_SENSOR_PARAMETERS];
    /* SOURCE_UNSET: the value for all sensors holds */
    enum parameter_source source[NUM_SENSOR_PARAMETERS];
    /*
     * azimuth in the local frame minus azimuth in the sensor's own axes, for a sensor placed by
     * lat_deg, lon_deg: the meridian convergence; else 0
     */
    double turn_rad;
};

/* Name of a sensor for printed lines: the key `name` of its INI section. */
#define SENSOR_NAME_BYTES 32
struct sensor_name {
    int32_t sensor_id;
    char text[SENSOR_NAME_BYTES];
    enum parameter_source source;
};

/* Parameters of a zone, keys of INI section [zone N]. */
enum zone_parameter_id {
    ZONE_CORNERS_M,
    ZONE_HEADING_RAD,
    ZONE_MARGIN_M,
    ZONE_QUEUE_MPS,
    NUM_ZONE_PARAMETERS
};

struct zone_parameters {
    struct rho_zone zone;
    enum parameter_source source[NUM_ZONE_PARAMETERS];
};

struct parameters {
    double value[NUM_VALUES];
    enum parameter_source source[NUM_VALUES];
    size_t num_sensors;
    struct sensor_parameters sensors[RHO_MAX_SENSORS];
    size_t num_names;
    struct sensor_name names[RHO_MAX_SENSORS];
    uint16_t num_allowed; /* number of sensors in `allowed`; 0: all sensors are allowed */
    int16_t allowed[RHO_MAX_SENSORS];
    enum parameter_source allowed_source;
    size_t num_zones;
    struct zone_parameters zones[RHO_MAX_ZONES];
    uint16_t num_reflectors;
    struct rho_reflector reflectors[RHO_MAX_REFLECTORS];
    enum parameter_source reflectors_source;
    double passive_apart_m; /* largest distance between two passive sensors; 0: not known */
};

void parameters_set_defaults(struct parameters *parameters);

/*
 * Sets a method's or scenario's own default, which holds unless --config or --set sets the
 * parameter.
 */
void parameters_suggest(struct parameters *parameters, enum parameter_id id, double value);

/*
 * Suggests the settings of a kind of radar (rho_settings_preset), named as in Python: marine,
 * en_route, ... --config and --set override them, in any order. Returns false with the reason for
 * an unknown name.
 */
bool parameters_assign_preset(struct parameters *parameters, const char *name,
                              char reason[PARAMETER_REASON_BYTES]);

/*
 * Assigns "key=value", "sensor.N.key=value" or "zone.N.key=value" of --set. On errors prints
 * `rhotrack: --set key=value: reason` and exits with 2.
 */
void parameters_set_assignment(struct parameters *parameters, const char *assignment);

/*
 * Loads an INI file with values before any section or in [rhotrack], [sensor N] or [zone N]. Errors
 * are `rhotrack: FILE:LINE: reason`, exit 2.
 */
void parameters_load_ini(struct parameters *parameters, const char *path);

/*
 * Checks constraints between parameters (v_min < v_max, min_scans <= scans, all four sides of the
 * area or none, min < max); exit 2.
 */
void parameters_check_together(const struct parameters *parameters);

/*
 * Converts sensors' places on the earth (lat_deg, lon_deg, alt_m) to x_m, y_m and z_m; to be called
 * once, after all assignments. Exit 2 without an origin, or where a place is incomplete, given
 * twice, or too far from the origin.
 */
void parameters_locate_sensors(struct parameters *parameters);

/*
 * Whether the origin of the local frame is set (exit 2 where only one of its latitude and longitude
 * is), and the local frame at that origin, to be closed by the caller. An unset origin_alt_m counts
 * as 0.
 */
bool parameters_has_origin(const struct parameters *parameters);
struct local_frame;
struct local_frame *parameters_open_local_frame(const struct parameters *parameters);

/* Message for a missing origin: "origin_lat_deg and origin_lon_deg are not set ..." */
extern const char parameters_no_origin[];

/* Gets a sensor's latitude, longitude and altitude; false where its place was not given so. */
bool parameters_sensor_geodetic(const struct parameters *parameters, int32_t sensor_id,
                                double geodetic[3]);

/*
 * Angle to add to a sensor's azimuths for azimuths in the local frame
 * (local_frame_convergence_rad); 0 for sensors that are not placed by latitude and
 * longitude.
 */
double parameters_convergence_rad(const struct parameters *parameters, int32_t sensor_id);

bool parameters_has_value(const struct parameters *parameters, enum parameter_id id);
const char *parameters_name(enum parameter_id id);

/* Sets the parameter gate from --gate; exit 2 for an unknown gate. */
void parameters_set_gate(struct parameters *parameters, const char *gate);

/* Sets the parameter method or bearings_method from --method; exit 2 for an unknown method. */
void parameters_set_method(struct parameters *parameters, const char *method);

/*
 * Assigns one value of any source; key: "key", "sensor.N.key" or "zone.N.key". A value from a
 * source of higher precedence stays. Returns false and the reason on errors.
 */
bool parameters_assign(struct parameters *parameters, const char *key, const char *value,
                       enum parameter_source source, char reason[PARAMETER_REASON_BYTES]);

/* Assigns the parameter reflectors: x y x y of each wall, separated by commas; empty: no walls. */
bool parameters_assign_reflectors(struct parameters *parameters, const char *value,
                                  enum parameter_source source,
                                  char reason[PARAMETER_REASON_BYTES]);
/* Formats the reflectors as parameters_assign_reflectors parses them; "-" for none. */
#define PARAMETER_REFLECTORS_BYTES (72 * RHO_MAX_REFLECTORS)
void parameters_reflectors_text(const struct parameters *parameters,
                                char text[PARAMETER_REFLECTORS_BYTES]);

/* A parameter's entry in the table, for the command config. */
struct parameter_text {
    const char *name, *unit, *text;
    double value, min, max;
    bool is_integer, has_default;
    /* "a|b": the parameter is a word, its value the word's index; NULL: it is a number */
    const char *choices;
    /* with choices "a|b|c": words joined by +, with the sum of 1, 2, 4 as value */
    bool is_sum;
};
struct parameter_text parameters_text(enum parameter_id id);
struct parameter_text parameters_sensor_text(enum sensor_parameter_id id); /* `value` is 0 */
/* Formats a value as the user would type it. */
#define PARAMETER_VALUE_BYTES 32
const char *parameters_value_text(const struct parameter_text *text, double value,
                                  char buffer[PARAMETER_VALUE_BYTES]);
const char *parameters_source_name(enum parameter_source source);

/*
 * Prints all parameters with unit, default, range, value, source and text, for the command config.
 */
void parameters_print_table(const struct parameters *parameters, FILE *out);

/* True where a source set any parameter of this sensor. */
bool parameters_has_sensor(const struct parameters *parameters, int32_t sensor_id);

/*
 * The sensor of files that name none: the one that is described, where it is the only one; else 0.
 */
int32_t parameters_lone_sensor_id(const struct parameters *parameters);

/* Name of a sensor, NULL: none. A sensor that has only a name does not count as described. */
const char *parameters_sensor_name(const struct parameters *parameters, int32_t sensor_id);

/* A sensor's own value of a parameter; `otherwise` where it has none. */
double parameters_value_of_sensor(const struct parameters *parameters, int32_t sensor_id,
                                  enum sensor_parameter_id id, double otherwise);

/*
 * Whether sources set the noise of a sensor both along and across the line of sight, and none that
 * of each axis, sigma_m: its Cartesian plots, such as a radar's cloud of points, then have that
 * noise, too.
 */
bool parameters_states_polar_noise(const struct parameters *parameters, int32_t sensor_id);

/* Largest range of a sensor: its own range_max_m, or else that of all sensors. */
double parameters_range_max_m(const struct parameters *parameters, int32_t sensor_id);

/*
 * Time bias of a sensor in microseconds; the smallest and the largest bias of all sensors, with 0
 * for sensors without one.
 */
int32_t parameters_time_bias_us(const struct parameters *parameters, int32_t sensor_id);
void parameters_time_bias_range_us(const struct parameters *parameters, int32_t *least_us,
                                   int32_t *largest_us);

/*
 * Describes a sensor for the library. Returns false, with *sensor unchanged, where no parameter of
 * the sensor was set, nor a range limit, span, notch or resolution for all sensors.
 */
bool parameters_to_sensor(const struct parameters *parameters, int32_t sensor_id,
                          struct rho_sensor *sensor);

/*
 * Describes any sensor for the library; without parameters of its own it is at the origin, without
 * biases, and sees everything.
 */
void parameters_sensor_or_default(const struct parameters *parameters, int32_t sensor_id,
                                  struct rho_sensor *sensor);

/*
 * Describes a sensor to the tracker; called before each of its scans, as it may move. Exit 2 where
 * there are more than RHO_MAX_SENSORS.
 */
void must_set_sensor(struct rho_tracker *tracker, const struct rho_sensor *sensor);

/* The library's settings from the parameters, checked by parameters_check_together; exit 2. */
struct rho_settings parameters_to_settings(const struct parameters *parameters);

/*
 * Sets parameters to the values of settings that differ, with the precedence of --set. Returns
 * false, with nothing changed, where a sensor's own range limits conflict with the settings.
 */
bool parameters_adopt_settings(struct parameters *parameters, const struct rho_settings *settings);

void parameters_to_initiator(const struct parameters *parameters,
                             struct rho_initiator_config *config);
void parameters_to_tracker(const struct parameters *parameters, struct rho_tracker_config *config);

/*
 * Initialises the scan assembler from the parameters, with descriptions of all sensors that the
 * parameters mention. Exit 1 where the library refuses them.
 */
void parameters_to_assembler(const struct parameters *parameters,
                             struct rho_scan_assembler *assembler);

/*
 * Updates the assembler's descriptions of sensors from changed parameters, while messages arrive.
 */
void parameters_update_assembler(const struct parameters *parameters,
                                 struct rho_scan_assembler *assembler);

/*
 * Assigns a zone's parameter; key: "N.name" with the zone's number N. Returns false and the reason
 * on errors.
 */
bool parameters_assign_zone(struct parameters *parameters, const char *key, const char *value,
                            enum parameter_source source, char reason[PARAMETER_REASON_BYTES]);

/* Initialises zones from the parameters; exit 2 for a zone without corners or area. */
void parameters_to_zones(const struct parameters *parameters, struct rho_zones *zones);

#endif
