/* SPDX-License-Identifier: MIT */
/* Made by tools/codegen from lcm_types/. Not to be edited: `make codegen`. */
/* clang-format off */
#include "rhotrack/message.h"

#include <float.h>

#include "message_codec.h"

static const struct message_run accumulator_cell_runs[] = {
    {offsetof(struct rho_message_accumulator_cell, rho_m), 4, 4},
    {offsetof(struct rho_message_accumulator_cell, plots), 2, 1},
    {offsetof(struct rho_message_accumulator_cell, track_id), 4, 1},
};
static const struct message_int_rule accumulator_cell_ints[] = {
    {offsetof(struct rho_message_accumulator_cell, scan_mask), 4, 1, MESSAGE_RANGE, 0, 65535},
    {offsetof(struct rho_message_accumulator_cell, plots), 2, 1, MESSAGE_RANGE, 0, 32767},
    {offsetof(struct rho_message_accumulator_cell, track_id), 4, 1, MESSAGE_RANGE, 0, 2147483647},
};
static const struct message_float_rule accumulator_cell_floats[] = {
    {offsetof(struct rho_message_accumulator_cell, rho_m), 1, -FLT_MAX, FLT_MAX},
    {offsetof(struct rho_message_accumulator_cell, theta_rad), 1, 0.0f, 6.3f},
    {offsetof(struct rho_message_accumulator_cell, votes), 1, 0.0f, 1000000000.0f},
};
static const struct message_format accumulator_cell_format = {
    RHO_MESSAGE_ACCUMULATOR_CELL_FINGERPRINT,
    {accumulator_cell_runs, 3, 22}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules accumulator_cell_rules = {
    &accumulator_cell_format,
    {accumulator_cell_ints, accumulator_cell_floats, 3, 3},
    {0, 0, 0, 0}};

static const struct message_run body_runs[] = {
    {offsetof(struct rho_message_body, track_id), 4, 14},
};
static const struct message_float_rule body_floats[] = {
    {offsetof(struct rho_message_body, x_m), 4, -FLT_MAX, FLT_MAX},
    {offsetof(struct rho_message_body, length_m), 2, 0.0f, 100000.0f},
    {offsetof(struct rho_message_body, heading_rad), 1, -4.0f, 4.0f},
    {offsetof(struct rho_message_body, sigma_length_m), 2, 0.0f, 100000.0f},
    {offsetof(struct rho_message_body, sigma_heading_rad), 1, 0.0f, 10.0f},
    {offsetof(struct rho_message_body, sigma_along_m), 2, 0.0f, 100000.0f},
    {offsetof(struct rho_message_body, plots), 1, 0.0f, 1000000000.0f},
};
static const struct message_format body_format = {
    RHO_MESSAGE_BODY_FINGERPRINT,
    {body_runs, 1, 56}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules body_rules = {
    &body_format,
    {0, body_floats, 0, 7},
    {0, 0, 0, 0}};

static const struct message_run command_answer_runs[] = {
    {offsetof(struct rho_message_command_answer, utime), 8, 1},
    {offsetof(struct rho_message_command_answer, scan), 4, 3},
    {offsetof(struct rho_message_command_answer, action), 1, 2},
    {offsetof(struct rho_message_command_answer, track_id), 4, 1},
};
static const struct message_int_rule command_answer_ints[] = {
    {offsetof(struct rho_message_command_answer, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_command_answer, action), 1, 1, MESSAGE_RANGE, 1, 127},
    {offsetof(struct rho_message_command_answer, status), 1, 1, MESSAGE_RANGE, 0, 127},
    {offsetof(struct rho_message_command_answer, track_id), 4, 1, MESSAGE_RANGE, 0, 2147483647},
};
static const struct message_format command_answer_format = {
    RHO_MESSAGE_COMMAND_ANSWER_FINGERPRINT,
    {command_answer_runs, 4, 26}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules command_answer_rules = {
    &command_answer_format,
    {command_answer_ints, 0, 4, 0},
    {0, 0, 0, 0}};

static const struct message_run command_runs[] = {
    {offsetof(struct rho_message_command, utime), 8, 1},
    {offsetof(struct rho_message_command, number), 4, 1},
    {offsetof(struct rho_message_command, action), 1, 1},
    {offsetof(struct rho_message_command, track_id), 4, 10},
};
static const struct message_int_rule command_ints[] = {
    {offsetof(struct rho_message_command, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_command, action), 1, 1, MESSAGE_ONE_OF, 0, 1 << 1 | 1 << 2 | 1 << 3
     | 1 << 4 | 1 << 5 | 1 << 6 | 1 << 7},
    {offsetof(struct rho_message_command, track_id), 4, 2, MESSAGE_RANGE, 0, 2147483647},
};
static const struct message_float_rule command_floats[] = {
    {offsetof(struct rho_message_command, x_m), 4, -2000000.0f, 2000000.0f},
    {offsetof(struct rho_message_command, sigma_m), 1, 0.0f, 100000.0f},
    {offsetof(struct rho_message_command, vx_mps), 2, -20000.0f, 20000.0f},
    {offsetof(struct rho_message_command, sigma_mps), 1, 0.0f, 100000.0f},
};
static const struct message_format command_format = {
    RHO_MESSAGE_COMMAND_FINGERPRINT,
    {command_runs, 4, 53}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules command_rules = {
    &command_format,
    {command_ints, command_floats, 3, 4},
    {0, 0, 0, 0}};

static const struct message_run direction_runs[] = {
    {offsetof(struct rho_message_direction, dt_us), 4, 4},
    {offsetof(struct rho_message_direction, has_elevation), 1, 1},
};
static const struct message_int_rule direction_ints[] = {
    {offsetof(struct rho_message_direction, dt_us), 4, 1, MESSAGE_RANGE, -60000000, 60000000},
    {offsetof(struct rho_message_direction, has_elevation), 1, 1, MESSAGE_RANGE, 0, 1},
};
static const struct message_float_rule direction_floats[] = {
    {offsetof(struct rho_message_direction, bearing_rad), 1, -3.1415927f, 3.1415927f},
    {offsetof(struct rho_message_direction, elevation_rad), 1, -1.5707964f, 1.5707964f},
    {offsetof(struct rho_message_direction, snr_db), 1, -1000.0f, 1000.0f},
};
static const struct message_format direction_format = {
    RHO_MESSAGE_DIRECTION_FINGERPRINT,
    {direction_runs, 2, 17}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules direction_rules = {
    &direction_format,
    {direction_ints, direction_floats, 2, 3},
    {0, 0, 0, 0}};

static const struct message_run echo_runs[] = {
    {offsetof(struct rho_message_echo, sensor_id), 2, 3},
    {offsetof(struct rho_message_echo, x_m), 4, 7},
};
static const struct message_int_rule echo_ints[] = {
    {offsetof(struct rho_message_echo, hits), 2, 1, MESSAGE_RANGE, 1, 32767},
    {offsetof(struct rho_message_echo, unseen), 2, 1, MESSAGE_RANGE, 0, 32767},
};
static const struct message_float_rule echo_floats[] = {
    {offsetof(struct rho_message_echo, x_m), 2, -2000000.0f, 2000000.0f},
    {offsetof(struct rho_message_echo, vx_mps), 2, -20000.0f, 20000.0f},
    {offsetof(struct rho_message_echo, sigma_range_m), 2, 0.0f, 1000000.0f},
    {offsetof(struct rho_message_echo, chance), 1, 0.0f, 1.0f},
};
static const struct message_format echo_format = {
    RHO_MESSAGE_ECHO_FINGERPRINT,
    {echo_runs, 2, 34}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules echo_rules = {
    &echo_format,
    {echo_ints, echo_floats, 2, 4},
    {0, 0, 0, 0}};

static const struct message_run ghost_runs[] = {
    {offsetof(struct rho_message_ghost, row), 2, 2},
    {offsetof(struct rho_message_ghost, reason), 1, 1},
    {offsetof(struct rho_message_ghost, delta_rad), 4, 3},
};
static const struct message_int_rule ghost_ints[] = {
    {offsetof(struct rho_message_ghost, row), 2, 2, MESSAGE_RANGE, 0, 32767},
    {offsetof(struct rho_message_ghost, reason), 1, 1, MESSAGE_ONE_OF, 0, 1 << 0 | 1 << 1 | 1 << 2 |
     1 << 3 | 1 << 4 | 1 << 5 | 1 << 6},
};
static const struct message_float_rule ghost_floats[] = {
    {offsetof(struct rho_message_ghost, delta_rad), 1, -3.15f, 3.15f},
    {offsetof(struct rho_message_ghost, x_m), 2, -FLT_MAX, FLT_MAX},
};
static const struct message_format ghost_format = {
    RHO_MESSAGE_GHOST_FINGERPRINT,
    {ghost_runs, 3, 17}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules ghost_rules = {
    &ghost_format,
    {ghost_ints, ghost_floats, 2, 2},
    {0, 0, 0, 0}};

static const struct message_run hypothesis_runs[] = {
    {offsetof(struct rho_message_hypothesis, share), 4, 6},
    {offsetof(struct rho_message_hypothesis, plots), 2, 3},
};
static const struct message_float_rule hypothesis_floats[] = {
    {offsetof(struct rho_message_hypothesis, share), 1, 0.0f, 1.0f},
    {offsetof(struct rho_message_hypothesis, x_m), 4, -FLT_MAX, FLT_MAX},
    {offsetof(struct rho_message_hypothesis, maneuver_probability), 1, 0.0f, 1.0f},
};
static const struct message_format hypothesis_format = {
    RHO_MESSAGE_HYPOTHESIS_FINGERPRINT,
    {hypothesis_runs, 2, 30}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules hypothesis_rules = {
    &hypothesis_format,
    {0, hypothesis_floats, 0, 3},
    {0, 0, 0, 0}};

static const struct message_run learned_runs[] = {
    {offsetof(struct rho_message_learned, utime), 8, 1},
    {offsetof(struct rho_message_learned, scan), 4, 2},
    {offsetof(struct rho_message_learned, sensor_id), 2, 2},
    {offsetof(struct rho_message_learned, sigma_range_factor), 4, 11},
};
static const struct message_int_rule learned_ints[] = {
    {offsetof(struct rho_message_learned, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_learned, innovations), 2, 1, MESSAGE_RANGE, 0, 32767},
    {offsetof(struct rho_message_learned, looks), 4, 1, MESSAGE_RANGE, 0, 2147483647},
};
static const struct message_float_rule learned_floats[] = {
    {offsetof(struct rho_message_learned, sigma_range_factor), 2, 0.0f, 100.0f},
    {offsetof(struct rho_message_learned, range_max_m), 1, 0.0f, 1000000000.0f},
    {offsetof(struct rho_message_learned, pd_stated), 7, 0.0f, 1.0f},
};
static const struct message_format learned_format = {
    RHO_MESSAGE_LEARNED_FINGERPRINT,
    {learned_runs, 4, 64}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules learned_rules = {
    &learned_format,
    {learned_ints, learned_floats, 3, 3},
    {0, 0, 0, 0}};

static const struct message_run peak_runs[] = {
    {offsetof(struct rho_message_peak, rho_m), 4, 4},
    {offsetof(struct rho_message_peak, scans_hit), 2, 2},
};
static const struct message_int_rule peak_ints[] = {
    {offsetof(struct rho_message_peak, scans_hit), 2, 2, MESSAGE_RANGE, 0, 32767},
};
static const struct message_float_rule peak_floats[] = {
    {offsetof(struct rho_message_peak, rho_m), 1, -FLT_MAX, FLT_MAX},
    {offsetof(struct rho_message_peak, theta_rad), 1, 0.0f, 3.1415927f},
    {offsetof(struct rho_message_peak, speed_mps), 1, 0.0f, 1000000.0f},
    {offsetof(struct rho_message_peak, score_nat), 1, -FLT_MAX, FLT_MAX},
};
static const struct message_format peak_format = {
    RHO_MESSAGE_PEAK_FINGERPRINT,
    {peak_runs, 2, 20}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules peak_rules = {
    &peak_format,
    {peak_ints, peak_floats, 1, 4},
    {0, 0, 0, 0}};

static const struct message_run plane_row_runs[] = {
    {offsetof(struct rho_message_plane_row, votes), 1, 64},
};
static const struct message_format plane_row_format = {
    RHO_MESSAGE_PLANE_ROW_FINGERPRINT,
    {plane_row_runs, 1, 64}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules plane_row_rules = {
    &plane_row_format,
    {0, 0, 0, 0},
    {0, 0, 0, 0}};

static const struct message_run plot_runs[] = {
    {offsetof(struct rho_message_plot, dt_us), 4, 10},
};
static const struct message_int_rule plot_ints[] = {
    {offsetof(struct rho_message_plot, dt_us), 4, 1, MESSAGE_RANGE, -60000000, 60000000},
};
static const struct message_float_rule plot_floats[] = {
    {offsetof(struct rho_message_plot, x_m), 3, -2000000.0f, 2000000.0f},
    {offsetof(struct rho_message_plot, vx_mps), 3, -20000.0f, 20000.0f},
    {offsetof(struct rho_message_plot, sigma_m), 2, 0.0f, 100000.0f},
    {offsetof(struct rho_message_plot, snr_db), 1, -1000.0f, 1000.0f},
};
static const struct message_format plot_format = {
    RHO_MESSAGE_PLOT_FINGERPRINT,
    {plot_runs, 1, 40}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules plot_rules = {
    &plot_format,
    {plot_ints, plot_floats, 1, 4},
    {0, 0, 0, 0}};

static const struct message_run polar_plot_runs[] = {
    {offsetof(struct rho_message_polar_plot, dt_us), 4, 6},
};
static const struct message_int_rule polar_plot_ints[] = {
    {offsetof(struct rho_message_polar_plot, dt_us), 4, 1, MESSAGE_RANGE, -60000000, 60000000},
};
static const struct message_float_rule polar_plot_floats[] = {
    {offsetof(struct rho_message_polar_plot, range_m), 1, 0.0f, 2000000.0f},
    {offsetof(struct rho_message_polar_plot, azimuth_rad), 1, -3.1415927f, 3.1415927f},
    {offsetof(struct rho_message_polar_plot, elevation_rad), 1, -1.5707964f, 1.5707964f},
    {offsetof(struct rho_message_polar_plot, range_rate_mps), 1, -20000.0f, 20000.0f},
    {offsetof(struct rho_message_polar_plot, snr_db), 1, -1000.0f, 1000.0f},
};
static const struct message_format polar_plot_format = {
    RHO_MESSAGE_POLAR_PLOT_FINGERPRINT,
    {polar_plot_runs, 1, 24}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules polar_plot_rules = {
    &polar_plot_format,
    {polar_plot_ints, polar_plot_floats, 1, 5},
    {0, 0, 0, 0}};

static const struct message_run sensor_runs[] = {
    {offsetof(struct rho_message_sensor, sensor_id), 2, 1},
    {offsetof(struct rho_message_sensor, kind), 1, 4},
    {offsetof(struct rho_message_sensor, scans), 4, 1},
    {offsetof(struct rho_message_sensor, scan_utime), 8, 1},
    {offsetof(struct rho_message_sensor, heard_age_us), 4, 2},
    {offsetof(struct rho_message_sensor, watched), 2, 2},
    {offsetof(struct rho_message_sensor, seen_share), 4, 2},
};
static const struct message_int_rule sensor_ints[] = {
    {offsetof(struct rho_message_sensor, kind), 1, 1, MESSAGE_ONE_OF, 0, 1 << 1 | 1 << 2 | 1 << 3},
    {offsetof(struct rho_message_sensor, is_silent), 1, 3, MESSAGE_RANGE, 0, 1},
    {offsetof(struct rho_message_sensor, scans), 4, 1, MESSAGE_RANGE, 0, 2147483647},
    {offsetof(struct rho_message_sensor, scan_utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_sensor, heard_age_us), 4, 2, MESSAGE_RANGE, 0, 2147483647},
    {offsetof(struct rho_message_sensor, watched), 2, 2, MESSAGE_RANGE, 0, 32767},
};
static const struct message_float_rule sensor_floats[] = {
    {offsetof(struct rho_message_sensor, seen_share), 1, 0.0f, 1.0f},
    {offsetof(struct rho_message_sensor, innovation_factor), 1, 0.0f, 1000000000000.0f},
};
static const struct message_format sensor_format = {
    RHO_MESSAGE_SENSOR_FINGERPRINT,
    {sensor_runs, 7, 38}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules sensor_rules = {
    &sensor_format,
    {sensor_ints, sensor_floats, 6, 2},
    {0, 0, 0, 0}};

static const struct message_run setting_answer_runs[] = {
    {offsetof(struct rho_message_setting_answer, utime), 8, 1},
    {offsetof(struct rho_message_setting_answer, scan), 4, 3},
    {offsetof(struct rho_message_setting_answer, field), 2, 1},
    {offsetof(struct rho_message_setting_answer, status), 1, 2},
    {offsetof(struct rho_message_setting_answer, fault_field), 2, 1},
    {offsetof(struct rho_message_setting_answer, value), 4, 3},
};
static const struct message_int_rule setting_answer_ints[] = {
    {offsetof(struct rho_message_setting_answer, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_setting_answer, field), 2, 1, MESSAGE_RANGE, 0, 32767},
    {offsetof(struct rho_message_setting_answer, status), 1, 1, MESSAGE_RANGE, 0, 127},
    {offsetof(struct rho_message_setting_answer, applies), 1, 1, MESSAGE_ONE_OF, 0, 1 << 0 | 1 << 1
     | 1 << 2 | 1 << 3 | 1 << 4},
    {offsetof(struct rho_message_setting_answer, fault_field), 2, 1, MESSAGE_RANGE, 0, 32767},
};
static const struct message_float_rule setting_answer_floats[] = {
    {offsetof(struct rho_message_setting_answer, value), 3, -FLT_MAX, FLT_MAX},
};
static const struct message_format setting_answer_format = {
    RHO_MESSAGE_SETTING_ANSWER_FINGERPRINT,
    {setting_answer_runs, 6, 38}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules setting_answer_rules = {
    &setting_answer_format,
    {setting_answer_ints, setting_answer_floats, 5, 1},
    {0, 0, 0, 0}};

static const struct message_run setting_runs[] = {
    {offsetof(struct rho_message_setting, utime), 8, 1},
    {offsetof(struct rho_message_setting, number), 4, 1},
    {offsetof(struct rho_message_setting, field), 2, 1},
    {offsetof(struct rho_message_setting, value), 4, 1},
};
static const struct message_int_rule setting_ints[] = {
    {offsetof(struct rho_message_setting, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_setting, field), 2, 1, MESSAGE_RANGE, 1, 18},
};
static const struct message_float_rule setting_floats[] = {
    {offsetof(struct rho_message_setting, value), 1, -FLT_MAX, FLT_MAX},
};
static const struct message_format setting_format = {
    RHO_MESSAGE_SETTING_FINGERPRINT,
    {setting_runs, 4, 18}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules setting_rules = {
    &setting_format,
    {setting_ints, setting_floats, 2, 1},
    {0, 0, 0, 0}};

static const struct message_run status_runs[] = {
    {offsetof(struct rho_message_status, utime), 8, 1},
    {offsetof(struct rho_message_status, scan), 4, 25},
    {offsetof(struct rho_message_status, tracks_tentative), 2, 3},
    {offsetof(struct rho_message_status, step_us), 4, 6},
};
static const struct message_int_rule status_ints[] = {
    {offsetof(struct rho_message_status, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_status, scans_accepted), 4, 23, MESSAGE_RANGE, 0, 2147483647},
    {offsetof(struct rho_message_status, tracks_tentative), 2, 3, MESSAGE_RANGE, 0, 32767},
    {offsetof(struct rho_message_status, origin_lat_1e7deg), 4, 1, MESSAGE_RANGE, -900000000,
     900000000},
    {offsetof(struct rho_message_status, origin_lon_1e7deg), 4, 1, MESSAGE_RANGE, -1800000000,
     1800000000},
};
static const struct message_float_rule status_floats[] = {
    {offsetof(struct rho_message_status, step_us), 3, 0.0f, 1000000000000.0f},
};
static const struct message_format status_format = {
    RHO_MESSAGE_STATUS_FINGERPRINT,
    {status_runs, 4, 138}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules status_rules = {
    &status_format,
    {status_ints, status_floats, 5, 1},
    {0, 0, 0, 0}};

static const struct message_run track_life_runs[] = {
    {offsetof(struct rho_message_track_life, track_id), 4, 3},
};
static const struct message_float_rule track_life_floats[] = {
    {offsetof(struct rho_message_track_life, existence), 2, 0.0f, 1.0f},
};
static const struct message_format track_life_format = {
    RHO_MESSAGE_TRACK_LIFE_FINGERPRINT,
    {track_life_runs, 1, 12}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules track_life_rules = {
    &track_life_format,
    {0, track_life_floats, 0, 1},
    {0, 0, 0, 0}};

static const struct message_run track_runs[] = {
    {offsetof(struct rho_message_track, track_id), 4, 1},
    {offsetof(struct rho_message_track, status), 1, 1},
    {offsetof(struct rho_message_track, hits), 2, 4},
    {offsetof(struct rho_message_track, update_age_us), 4, 33},
};
static const struct message_int_rule track_ints[] = {
    {offsetof(struct rho_message_track, status), 1, 1, MESSAGE_ONE_OF, 0, 1 << 1 | 1 << 2 | 1 << 3 |
     1 << 4},
    {offsetof(struct rho_message_track, hits), 2, 2, MESSAGE_RANGE, 0, 32767},
    {offsetof(struct rho_message_track, plot), 2, 1, MESSAGE_RANGE, -1, 32767},
    {offsetof(struct rho_message_track, update_age_us), 4, 1, MESSAGE_RANGE, 0, 2147483647},
};
static const struct message_float_rule track_floats[] = {
    {offsetof(struct rho_message_track, x_m), 10, -FLT_MAX, FLT_MAX},
    {offsetof(struct rho_message_track, maneuver_probability), 1, 0.0f, 1.0f},
    {offsetof(struct rho_message_track, covariance), 21, -FLT_MAX, FLT_MAX},
};
static const struct message_format track_format = {
    RHO_MESSAGE_TRACK_FINGERPRINT,
    {track_runs, 4, 145}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules track_rules = {
    &track_format,
    {track_ints, track_floats, 4, 3},
    {0, 0, 0, 0}};

static const struct message_run truth_runs[] = {
    {offsetof(struct rho_message_truth, target_id), 4, 7},
};
static const struct message_float_rule truth_floats[] = {
    {offsetof(struct rho_message_truth, x_m), 3, -2000000.0f, 2000000.0f},
    {offsetof(struct rho_message_truth, vx_mps), 3, -20000.0f, 20000.0f},
};
static const struct message_format truth_format = {
    RHO_MESSAGE_TRUTH_FINGERPRINT,
    {truth_runs, 1, 28}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules truth_rules = {
    &truth_format,
    {0, truth_floats, 0, 2},
    {0, 0, 0, 0}};

static const struct message_run work_runs[] = {
    {offsetof(struct rho_message_work, utime), 8, 1},
    {offsetof(struct rho_message_work, scan), 4, 2},
    {offsetof(struct rho_message_work, num_steps), 8, 8},
};
static const struct message_int_rule work_ints[] = {
    {offsetof(struct rho_message_work, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_work, num_steps), 8, 8, MESSAGE_COUNT, 0, 0},
};
static const struct message_format work_format = {
    RHO_MESSAGE_WORK_FINGERPRINT,
    {work_runs, 3, 80}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules work_rules = {
    &work_format,
    {work_ints, 0, 2, 0},
    {0, 0, 0, 0}};

static const struct message_run zone_event_runs[] = {
    {offsetof(struct rho_message_zone_event, zone_id), 4, 2},
    {offsetof(struct rho_message_zone_event, change), 1, 2},
    {offsetof(struct rho_message_zone_event, speed_mps), 4, 2},
};
static const struct message_int_rule zone_event_ints[] = {
    {offsetof(struct rho_message_zone_event, change), 1, 1, MESSAGE_ONE_OF, 0, 1 << 0 | 1 << 1 | 1
     << 2},
    {offsetof(struct rho_message_zone_event, direction), 1, 1, MESSAGE_RANGE, -1, 1},
};
static const struct message_float_rule zone_event_floats[] = {
    {offsetof(struct rho_message_zone_event, speed_mps), 1, 0.0f, 1000000.0f},
    {offsetof(struct rho_message_zone_event, dwell_s), 1, 0.0f, 1000000000.0f},
};
static const struct message_format zone_event_format = {
    RHO_MESSAGE_ZONE_EVENT_FINGERPRINT,
    {zone_event_runs, 3, 18}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules zone_event_rules = {
    &zone_event_format,
    {zone_event_ints, zone_event_floats, 2, 2},
    {0, 0, 0, 0}};

static const struct message_run zone_runs[] = {
    {offsetof(struct rho_message_zone, zone_id), 4, 1},
    {offsetof(struct rho_message_zone, inside), 2, 2},
    {offsetof(struct rho_message_zone, entered), 4, 9},
};
static const struct message_int_rule zone_ints[] = {
    {offsetof(struct rho_message_zone, inside), 2, 2, MESSAGE_RANGE, 0, 32767},
    {offsetof(struct rho_message_zone, entered), 4, 5, MESSAGE_RANGE, 0, 2147483647},
};
static const struct message_float_rule zone_floats[] = {
    {offsetof(struct rho_message_zone, speed_mps), 1, 0.0f, 1000000.0f},
    {offsetof(struct rho_message_zone, queue_m), 3, 0.0f, 1000000000.0f},
};
static const struct message_format zone_format = {
    RHO_MESSAGE_ZONE_FINGERPRINT,
    {zone_runs, 3, 44}, {0, 0, 0},
    0, 0, 0, 0};
static const struct message_rules zone_rules = {
    &zone_format,
    {zone_ints, zone_floats, 2, 2},
    {0, 0, 0, 0}};

static const struct message_run accumulator_runs[] = {
    {offsetof(struct rho_message_accumulator, utime), 8, 1},
    {offsetof(struct rho_message_accumulator, scan), 4, 2},
    {offsetof(struct rho_message_accumulator, method), 1, 2},
    {offsetof(struct rho_message_accumulator, sensor_a_id), 2, 3},
    {offsetof(struct rho_message_accumulator, oldest_utime), 8, 1},
    {offsetof(struct rho_message_accumulator, origin_x_m), 4, 4},
    {offsetof(struct rho_message_accumulator, rho_cells), 2, 2},
    {offsetof(struct rho_message_accumulator, votes_max), 4, 3},
    {offsetof(struct rho_message_accumulator, num_cells_total), 2, 1},
};
static const struct message_int_rule accumulator_ints[] = {
    {offsetof(struct rho_message_accumulator, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_accumulator, method), 1, 1, MESSAGE_ONE_OF, 0, 1 << 1 | 1 << 2 | 1
     << 3 | 1 << 4 | 1 << 5},
    {offsetof(struct rho_message_accumulator, has_pair), 1, 1, MESSAGE_RANGE, 0, 1},
    {offsetof(struct rho_message_accumulator, num_scans), 2, 1, MESSAGE_RANGE, 1, 16},
    {offsetof(struct rho_message_accumulator, oldest_utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_accumulator, rho_cells), 2, 2, MESSAGE_RANGE, 1, 32767},
    {offsetof(struct rho_message_accumulator, not_sent), 4, 1, MESSAGE_RANGE, 0, 2147483647},
    {offsetof(struct rho_message_accumulator, num_cells_total), 2, 1, MESSAGE_RANGE, 0, 32767},
};
static const struct message_float_rule accumulator_floats[] = {
    {offsetof(struct rho_message_accumulator, origin_x_m), 2, -2000000.0f, 2000000.0f},
    {offsetof(struct rho_message_accumulator, rho_min_m), 2, -FLT_MAX, FLT_MAX},
    {offsetof(struct rho_message_accumulator, votes_max), 2, 0.0f, 1000000000.0f},
};
static const struct message_format accumulator_format = {
    RHO_MESSAGE_ACCUMULATOR_FINGERPRINT,
    {accumulator_runs, 9, 66}, {accumulator_cell_runs, 3, 22},
    offsetof(struct rho_message_accumulator, num_cells),
    offsetof(struct rho_message_accumulator, cells),
    sizeof(struct rho_message_accumulator_cell), RHO_MESSAGE_ACCUMULATOR_MAX_CELLS};
static const struct message_rules accumulator_rules = {
    &accumulator_format,
    {accumulator_ints, accumulator_floats, 8, 3},
    {accumulator_cell_ints, accumulator_cell_floats, 3, 3}};

static const struct message_run bearing_scan_runs[] = {
    {offsetof(struct rho_message_bearing_scan, utime), 8, 1},
    {offsetof(struct rho_message_bearing_scan, scan), 4, 2},
    {offsetof(struct rho_message_bearing_scan, sensor_id), 2, 1},
    {offsetof(struct rho_message_bearing_scan, sensor_x_m), 4, 3},
};
static const struct message_int_rule bearing_scan_ints[] = {
    {offsetof(struct rho_message_bearing_scan, utime), 8, 1, MESSAGE_TIME, 0, 0},
};
static const struct message_float_rule bearing_scan_floats[] = {
    {offsetof(struct rho_message_bearing_scan, sensor_x_m), 2, -2000000.0f, 2000000.0f},
    {offsetof(struct rho_message_bearing_scan, sigma_rad), 1, 0.0f, 0.5f},
};
static const struct message_run bearing_scan_element_runs[] = {
    {0, 4, 1},
};
static const struct message_float_rule bearing_scan_element_floats[] = {
    {0, 1, -3.1415927f, 3.1415927f},
};
static const struct message_format bearing_scan_format = {
    RHO_MESSAGE_BEARING_SCAN_FINGERPRINT,
    {bearing_scan_runs, 4, 30}, {bearing_scan_element_runs, 1, 4},
    offsetof(struct rho_message_bearing_scan, num_bearings),
    offsetof(struct rho_message_bearing_scan, bearing_rad),
    sizeof(float), RHO_MESSAGE_BEARING_SCAN_MAX_BEARING_RAD};
static const struct message_rules bearing_scan_rules = {
    &bearing_scan_format,
    {bearing_scan_ints, bearing_scan_floats, 1, 2},
    {0, bearing_scan_element_floats, 0, 1}};

static const struct message_run body_list_runs[] = {
    {offsetof(struct rho_message_body_list, utime), 8, 1},
    {offsetof(struct rho_message_body_list, scan), 4, 2},
    {offsetof(struct rho_message_body_list, part), 2, 2},
};
static const struct message_int_rule body_list_ints[] = {
    {offsetof(struct rho_message_body_list, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_body_list, num_parts), 2, 1, MESSAGE_RANGE, 1, 32767},
    {offsetof(struct rho_message_body_list, part), 2, 1, MESSAGE_BELOW, 0, offsetof(struct
     rho_message_body_list, num_parts)},
};
static const struct message_format body_list_format = {
    RHO_MESSAGE_BODY_LIST_FINGERPRINT,
    {body_list_runs, 3, 20}, {body_runs, 1, 56},
    offsetof(struct rho_message_body_list, num_bodies),
    offsetof(struct rho_message_body_list, bodies),
    sizeof(struct rho_message_body), RHO_MESSAGE_BODY_LIST_MAX_BODIES};
static const struct message_rules body_list_rules = {
    &body_list_format,
    {body_list_ints, 0, 3, 0},
    {0, body_floats, 0, 7}};

static const struct message_run clutter_map_runs[] = {
    {offsetof(struct rho_message_clutter_map, utime), 8, 1},
    {offsetof(struct rho_message_clutter_map, scan), 4, 2},
    {offsetof(struct rho_message_clutter_map, num_echoes_total), 2, 3},
};
static const struct message_int_rule clutter_map_ints[] = {
    {offsetof(struct rho_message_clutter_map, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_clutter_map, num_echoes_total), 2, 1, MESSAGE_RANGE, 0, 32767},
    {offsetof(struct rho_message_clutter_map, num_parts), 2, 1, MESSAGE_RANGE, 1, 32767},
    {offsetof(struct rho_message_clutter_map, part), 2, 1, MESSAGE_BELOW, 0, offsetof(struct
     rho_message_clutter_map, num_parts)},
};
static const struct message_format clutter_map_format = {
    RHO_MESSAGE_CLUTTER_MAP_FINGERPRINT,
    {clutter_map_runs, 3, 22}, {echo_runs, 2, 34},
    offsetof(struct rho_message_clutter_map, num_echoes),
    offsetof(struct rho_message_clutter_map, echoes),
    sizeof(struct rho_message_echo), RHO_MESSAGE_CLUTTER_MAP_MAX_ECHOES};
static const struct message_rules clutter_map_rules = {
    &clutter_map_format,
    {clutter_map_ints, 0, 4, 0},
    {echo_ints, echo_floats, 2, 4}};

static const struct message_run direction_scan_runs[] = {
    {offsetof(struct rho_message_direction_scan, utime), 8, 1},
    {offsetof(struct rho_message_direction_scan, scan), 4, 2},
    {offsetof(struct rho_message_direction_scan, sensor_id), 2, 1},
    {offsetof(struct rho_message_direction_scan, sensor_x_m), 4, 7},
};
static const struct message_int_rule direction_scan_ints[] = {
    {offsetof(struct rho_message_direction_scan, utime), 8, 1, MESSAGE_TIME, 0, 0},
};
static const struct message_float_rule direction_scan_floats[] = {
    {offsetof(struct rho_message_direction_scan, sensor_x_m), 3, -2000000.0f, 2000000.0f},
    {offsetof(struct rho_message_direction_scan, sigma_rad), 2, 0.0f, 0.5f},
    {offsetof(struct rho_message_direction_scan, sector_from_rad), 2, -6.2831855f, 6.2831855f},
};
static const struct message_format direction_scan_format = {
    RHO_MESSAGE_DIRECTION_SCAN_FINGERPRINT,
    {direction_scan_runs, 4, 46}, {direction_runs, 2, 17},
    offsetof(struct rho_message_direction_scan, num_directions),
    offsetof(struct rho_message_direction_scan, directions),
    sizeof(struct rho_message_direction), RHO_MESSAGE_DIRECTION_SCAN_MAX_DIRECTIONS};
static const struct message_rules direction_scan_rules = {
    &direction_scan_format,
    {direction_scan_ints, direction_scan_floats, 1, 3},
    {direction_ints, direction_floats, 2, 3}};

static const struct message_run ghost_matrix_runs[] = {
    {offsetof(struct rho_message_ghost_matrix, utime), 8, 1},
    {offsetof(struct rho_message_ghost_matrix, scan), 4, 2},
    {offsetof(struct rho_message_ghost_matrix, sensor_a_id), 2, 2},
    {offsetof(struct rho_message_ghost_matrix, sensor_a_x_m), 4, 5},
    {offsetof(struct rho_message_ghost_matrix, rule), 1, 1},
    {offsetof(struct rho_message_ghost_matrix, num_rows), 2, 2},
    {offsetof(struct rho_message_ghost_matrix, not_sent), 4, 1},
    {offsetof(struct rho_message_ghost_matrix, part), 2, 2},
};
static const struct message_int_rule ghost_matrix_ints[] = {
    {offsetof(struct rho_message_ghost_matrix, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_ghost_matrix, rule), 1, 1, MESSAGE_ONE_OF, 0, 1 << 0 | 1 << 1 | 1
     << 2},
    {offsetof(struct rho_message_ghost_matrix, num_rows), 2, 2, MESSAGE_RANGE, 0, 255},
    {offsetof(struct rho_message_ghost_matrix, not_sent), 4, 1, MESSAGE_RANGE, 0, 2147483647},
    {offsetof(struct rho_message_ghost_matrix, num_parts), 2, 1, MESSAGE_RANGE, 1, 32767},
    {offsetof(struct rho_message_ghost_matrix, part), 2, 1, MESSAGE_BELOW, 0, offsetof(struct
     rho_message_ghost_matrix, num_parts)},
};
static const struct message_float_rule ghost_matrix_floats[] = {
    {offsetof(struct rho_message_ghost_matrix, sensor_a_x_m), 4, -2000000.0f, 2000000.0f},
    {offsetof(struct rho_message_ghost_matrix, range_max_m), 1, 0.0f, 1000000000.0f},
};
static const struct message_format ghost_matrix_format = {
    RHO_MESSAGE_GHOST_MATRIX_FINGERPRINT,
    {ghost_matrix_runs, 8, 53}, {ghost_runs, 3, 17},
    offsetof(struct rho_message_ghost_matrix, num_elements),
    offsetof(struct rho_message_ghost_matrix, elements),
    sizeof(struct rho_message_ghost), RHO_MESSAGE_GHOST_MATRIX_MAX_ELEMENTS};
static const struct message_rules ghost_matrix_rules = {
    &ghost_matrix_format,
    {ghost_matrix_ints, ghost_matrix_floats, 6, 2},
    {ghost_ints, ghost_floats, 2, 2}};

static const struct message_run hypotheses_runs[] = {
    {offsetof(struct rho_message_hypotheses, utime), 8, 1},
    {offsetof(struct rho_message_hypotheses, scan), 4, 7},
    {offsetof(struct rho_message_hypotheses, evidence), 1, 1},
    {offsetof(struct rho_message_hypotheses, support), 4, 4},
};
static const struct message_int_rule hypotheses_ints[] = {
    {offsetof(struct rho_message_hypotheses, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_hypotheses, evidence), 1, 1, MESSAGE_ONE_OF, 0, 1 << 0 | 1 << 1 | 1
     << 2},
    {offsetof(struct rho_message_hypotheses, not_sent), 4, 1, MESSAGE_RANGE, 0, 2147483647},
};
static const struct message_float_rule hypotheses_floats[] = {
    {offsetof(struct rho_message_hypotheses, score_nat), 1, -FLT_MAX, FLT_MAX},
    {offsetof(struct rho_message_hypotheses, calm), 3, 0.0f, 1.0f},
    {offsetof(struct rho_message_hypotheses, support), 3, 0.0f, 1.0f},
};
static const struct message_format hypotheses_format = {
    RHO_MESSAGE_HYPOTHESES_FINGERPRINT,
    {hypotheses_runs, 4, 53}, {hypothesis_runs, 2, 30},
    offsetof(struct rho_message_hypotheses, num_hypotheses),
    offsetof(struct rho_message_hypotheses, hypotheses),
    sizeof(struct rho_message_hypothesis), RHO_MESSAGE_HYPOTHESES_MAX_HYPOTHESES};
static const struct message_rules hypotheses_rules = {
    &hypotheses_format,
    {hypotheses_ints, hypotheses_floats, 3, 3},
    {0, hypothesis_floats, 0, 3}};

static const struct message_run life_runs[] = {
    {offsetof(struct rho_message_life, utime), 8, 1},
    {offsetof(struct rho_message_life, scan), 4, 6},
    {offsetof(struct rho_message_life, num_tracks_total), 2, 3},
};
static const struct message_int_rule life_ints[] = {
    {offsetof(struct rho_message_life, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_life, num_tracks_total), 2, 1, MESSAGE_RANGE, 0, 32767},
    {offsetof(struct rho_message_life, num_parts), 2, 1, MESSAGE_RANGE, 1, 32767},
    {offsetof(struct rho_message_life, part), 2, 1, MESSAGE_BELOW, 0, offsetof(struct
     rho_message_life, num_parts)},
};
static const struct message_float_rule life_floats[] = {
    {offsetof(struct rho_message_life, death_rate), 2, 0.0f, 1.0f},
    {offsetof(struct rho_message_life, appear_rate), 1, 0.0f, 2.0f},
    {offsetof(struct rho_message_life, lived_scans), 1, 0.0f, 1000000000.0f},
};
static const struct message_format life_format = {
    RHO_MESSAGE_LIFE_FINGERPRINT,
    {life_runs, 3, 38}, {track_life_runs, 1, 12},
    offsetof(struct rho_message_life, num_tracks),
    offsetof(struct rho_message_life, tracks),
    sizeof(struct rho_message_track_life), RHO_MESSAGE_LIFE_MAX_TRACKS};
static const struct message_rules life_rules = {
    &life_format,
    {life_ints, life_floats, 4, 3},
    {0, track_life_floats, 0, 1}};

static const struct message_run peak_list_runs[] = {
    {offsetof(struct rho_message_peak_list, utime), 8, 1},
    {offsetof(struct rho_message_peak_list, scan), 4, 1},
};
static const struct message_int_rule peak_list_ints[] = {
    {offsetof(struct rho_message_peak_list, utime), 8, 1, MESSAGE_TIME, 0, 0},
};
static const struct message_format peak_list_format = {
    RHO_MESSAGE_PEAK_LIST_FINGERPRINT,
    {peak_list_runs, 2, 12}, {peak_runs, 2, 20},
    offsetof(struct rho_message_peak_list, num_peaks),
    offsetof(struct rho_message_peak_list, peaks),
    sizeof(struct rho_message_peak), RHO_MESSAGE_PEAK_LIST_MAX_PEAKS};
static const struct message_rules peak_list_rules = {
    &peak_list_format,
    {peak_list_ints, 0, 1, 0},
    {peak_ints, peak_floats, 1, 4}};

static const struct message_run plane_runs[] = {
    {offsetof(struct rho_message_plane, utime), 8, 1},
    {offsetof(struct rho_message_plane, scan), 4, 2},
    {offsetof(struct rho_message_plane, method), 1, 2},
    {offsetof(struct rho_message_plane, sensor_a_id), 2, 2},
    {offsetof(struct rho_message_plane, votes_max), 4, 1},
    {offsetof(struct rho_message_plane, part), 2, 2},
};
static const struct message_int_rule plane_ints[] = {
    {offsetof(struct rho_message_plane, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_plane, method), 1, 1, MESSAGE_RANGE, 1, 5},
    {offsetof(struct rho_message_plane, has_pair), 1, 1, MESSAGE_RANGE, 0, 1},
    {offsetof(struct rho_message_plane, num_parts), 2, 1, MESSAGE_RANGE, 1, 32767},
    {offsetof(struct rho_message_plane, part), 2, 1, MESSAGE_BELOW, 0, offsetof(struct
     rho_message_plane, num_parts)},
};
static const struct message_float_rule plane_floats[] = {
    {offsetof(struct rho_message_plane, votes_max), 1, 0.0f, 1000000000.0f},
};
static const struct message_format plane_format = {
    RHO_MESSAGE_PLANE_FINGERPRINT,
    {plane_runs, 6, 30}, {plane_row_runs, 1, 64},
    offsetof(struct rho_message_plane, num_rows),
    offsetof(struct rho_message_plane, rows),
    sizeof(struct rho_message_plane_row), RHO_MESSAGE_PLANE_MAX_ROWS};
static const struct message_rules plane_rules = {
    &plane_format,
    {plane_ints, plane_floats, 5, 1},
    {0, 0, 0, 0}};

static const struct message_run plot_scan_runs[] = {
    {offsetof(struct rho_message_plot_scan, utime), 8, 1},
    {offsetof(struct rho_message_plot_scan, scan), 4, 2},
    {offsetof(struct rho_message_plot_scan, sensor_id), 2, 1},
    {offsetof(struct rho_message_plot_scan, kind), 1, 1},
    {offsetof(struct rho_message_plot_scan, part), 2, 2},
    {offsetof(struct rho_message_plot_scan, sector_from_rad), 4, 2},
};
static const struct message_int_rule plot_scan_ints[] = {
    {offsetof(struct rho_message_plot_scan, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_plot_scan, kind), 1, 1, MESSAGE_ONE_OF, 0, 1 << 2 | 1 << 3 | 1 << 4
     | 1 << 6},
    {offsetof(struct rho_message_plot_scan, num_parts), 2, 1, MESSAGE_RANGE, 1, 32767},
    {offsetof(struct rho_message_plot_scan, part), 2, 1, MESSAGE_BELOW, 0, offsetof(struct
     rho_message_plot_scan, num_parts)},
};
static const struct message_float_rule plot_scan_floats[] = {
    {offsetof(struct rho_message_plot_scan, sector_from_rad), 2, -6.2831855f, 6.2831855f},
};
static const struct message_format plot_scan_format = {
    RHO_MESSAGE_PLOT_SCAN_FINGERPRINT,
    {plot_scan_runs, 6, 31}, {plot_runs, 1, 40},
    offsetof(struct rho_message_plot_scan, num_plots),
    offsetof(struct rho_message_plot_scan, plots),
    sizeof(struct rho_message_plot), RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS};
static const struct message_rules plot_scan_rules = {
    &plot_scan_format,
    {plot_scan_ints, plot_scan_floats, 4, 1},
    {plot_ints, plot_floats, 1, 4}};

static const struct message_run polar_scan_runs[] = {
    {offsetof(struct rho_message_polar_scan, utime), 8, 1},
    {offsetof(struct rho_message_polar_scan, scan), 4, 2},
    {offsetof(struct rho_message_polar_scan, sensor_id), 2, 1},
    {offsetof(struct rho_message_polar_scan, has_elevation), 1, 2},
    {offsetof(struct rho_message_polar_scan, part), 2, 2},
    {offsetof(struct rho_message_polar_scan, sensor_x_m), 4, 9},
};
static const struct message_int_rule polar_scan_ints[] = {
    {offsetof(struct rho_message_polar_scan, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_polar_scan, has_elevation), 1, 2, MESSAGE_RANGE, 0, 1},
    {offsetof(struct rho_message_polar_scan, num_parts), 2, 1, MESSAGE_RANGE, 1, 32767},
    {offsetof(struct rho_message_polar_scan, part), 2, 1, MESSAGE_BELOW, 0, offsetof(struct
     rho_message_polar_scan, num_parts)},
};
static const struct message_float_rule polar_scan_floats[] = {
    {offsetof(struct rho_message_polar_scan, sensor_x_m), 3, -2000000.0f, 2000000.0f},
    {offsetof(struct rho_message_polar_scan, sigma_range_m), 1, 0.0f, 100000.0f},
    {offsetof(struct rho_message_polar_scan, sigma_azimuth_rad), 2, 0.0f, 0.5f},
    {offsetof(struct rho_message_polar_scan, sigma_range_rate_mps), 1, 0.0f, 100000.0f},
    {offsetof(struct rho_message_polar_scan, sector_from_rad), 2, -6.2831855f, 6.2831855f},
};
static const struct message_format polar_scan_format = {
    RHO_MESSAGE_POLAR_SCAN_FINGERPRINT,
    {polar_scan_runs, 6, 60}, {polar_plot_runs, 1, 24},
    offsetof(struct rho_message_polar_scan, num_polar_plots),
    offsetof(struct rho_message_polar_scan, polar_plots),
    sizeof(struct rho_message_polar_plot), RHO_MESSAGE_POLAR_SCAN_MAX_POLAR_PLOTS};
static const struct message_rules polar_scan_rules = {
    &polar_scan_format,
    {polar_scan_ints, polar_scan_floats, 4, 5},
    {polar_plot_ints, polar_plot_floats, 1, 5}};

static const struct message_run sensor_list_runs[] = {
    {offsetof(struct rho_message_sensor_list, utime), 8, 1},
    {offsetof(struct rho_message_sensor_list, scan), 4, 2},
    {offsetof(struct rho_message_sensor_list, num_sensors_total), 2, 3},
};
static const struct message_int_rule sensor_list_ints[] = {
    {offsetof(struct rho_message_sensor_list, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_sensor_list, num_sensors_total), 2, 1, MESSAGE_RANGE, 0, 32767},
    {offsetof(struct rho_message_sensor_list, num_parts), 2, 1, MESSAGE_RANGE, 1, 32767},
    {offsetof(struct rho_message_sensor_list, part), 2, 1, MESSAGE_BELOW, 0, offsetof(struct
     rho_message_sensor_list, num_parts)},
};
static const struct message_format sensor_list_format = {
    RHO_MESSAGE_SENSOR_LIST_FINGERPRINT,
    {sensor_list_runs, 3, 22}, {sensor_runs, 7, 38},
    offsetof(struct rho_message_sensor_list, num_sensors),
    offsetof(struct rho_message_sensor_list, sensors),
    sizeof(struct rho_message_sensor), RHO_MESSAGE_SENSOR_LIST_MAX_SENSORS};
static const struct message_rules sensor_list_rules = {
    &sensor_list_format,
    {sensor_list_ints, 0, 4, 0},
    {sensor_ints, sensor_floats, 6, 2}};

static const struct message_run track_list_runs[] = {
    {offsetof(struct rho_message_track_list, utime), 8, 1},
    {offsetof(struct rho_message_track_list, scan), 4, 2},
    {offsetof(struct rho_message_track_list, num_tracks_total), 2, 3},
};
static const struct message_int_rule track_list_ints[] = {
    {offsetof(struct rho_message_track_list, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_track_list, num_tracks_total), 2, 1, MESSAGE_RANGE, 0, 32767},
    {offsetof(struct rho_message_track_list, num_parts), 2, 1, MESSAGE_RANGE, 1, 32767},
    {offsetof(struct rho_message_track_list, part), 2, 1, MESSAGE_BELOW, 0, offsetof(struct
     rho_message_track_list, num_parts)},
};
static const struct message_format track_list_format = {
    RHO_MESSAGE_TRACK_LIST_FINGERPRINT,
    {track_list_runs, 3, 22}, {track_runs, 4, 145},
    offsetof(struct rho_message_track_list, num_tracks),
    offsetof(struct rho_message_track_list, tracks),
    sizeof(struct rho_message_track), RHO_MESSAGE_TRACK_LIST_MAX_TRACKS};
static const struct message_rules track_list_rules = {
    &track_list_format,
    {track_list_ints, 0, 4, 0},
    {track_ints, track_floats, 4, 3}};

static const struct message_run truth_list_runs[] = {
    {offsetof(struct rho_message_truth_list, utime), 8, 1},
    {offsetof(struct rho_message_truth_list, scan), 4, 1},
    {offsetof(struct rho_message_truth_list, part), 2, 2},
};
static const struct message_int_rule truth_list_ints[] = {
    {offsetof(struct rho_message_truth_list, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_truth_list, num_parts), 2, 1, MESSAGE_RANGE, 1, 32767},
    {offsetof(struct rho_message_truth_list, part), 2, 1, MESSAGE_BELOW, 0, offsetof(struct
     rho_message_truth_list, num_parts)},
};
static const struct message_format truth_list_format = {
    RHO_MESSAGE_TRUTH_LIST_FINGERPRINT,
    {truth_list_runs, 3, 16}, {truth_runs, 1, 28},
    offsetof(struct rho_message_truth_list, num_targets),
    offsetof(struct rho_message_truth_list, targets),
    sizeof(struct rho_message_truth), RHO_MESSAGE_TRUTH_LIST_MAX_TARGETS};
static const struct message_rules truth_list_rules = {
    &truth_list_format,
    {truth_list_ints, 0, 3, 0},
    {0, truth_floats, 0, 2}};

static const struct message_run zone_event_list_runs[] = {
    {offsetof(struct rho_message_zone_event_list, utime), 8, 1},
    {offsetof(struct rho_message_zone_event_list, scan), 4, 2},
};
static const struct message_int_rule zone_event_list_ints[] = {
    {offsetof(struct rho_message_zone_event_list, utime), 8, 1, MESSAGE_TIME, 0, 0},
};
static const struct message_format zone_event_list_format = {
    RHO_MESSAGE_ZONE_EVENT_LIST_FINGERPRINT,
    {zone_event_list_runs, 2, 16}, {zone_event_runs, 3, 18},
    offsetof(struct rho_message_zone_event_list, num_events),
    offsetof(struct rho_message_zone_event_list, events),
    sizeof(struct rho_message_zone_event), RHO_MESSAGE_ZONE_EVENT_LIST_MAX_EVENTS};
static const struct message_rules zone_event_list_rules = {
    &zone_event_list_format,
    {zone_event_list_ints, 0, 1, 0},
    {zone_event_ints, zone_event_floats, 2, 2}};

static const struct message_run zone_list_runs[] = {
    {offsetof(struct rho_message_zone_list, utime), 8, 1},
    {offsetof(struct rho_message_zone_list, scan), 4, 3},
};
static const struct message_int_rule zone_list_ints[] = {
    {offsetof(struct rho_message_zone_list, utime), 8, 1, MESSAGE_TIME, 0, 0},
    {offsetof(struct rho_message_zone_list, events_dropped), 4, 1, MESSAGE_RANGE, 0, 2147483647},
};
static const struct message_format zone_list_format = {
    RHO_MESSAGE_ZONE_LIST_FINGERPRINT,
    {zone_list_runs, 2, 20}, {zone_runs, 3, 44},
    offsetof(struct rho_message_zone_list, num_zones),
    offsetof(struct rho_message_zone_list, zones),
    sizeof(struct rho_message_zone), RHO_MESSAGE_ZONE_LIST_MAX_ZONES};
static const struct message_rules zone_list_rules = {
    &zone_list_format,
    {zone_list_ints, 0, 2, 0},
    {zone_ints, zone_floats, 2, 2}};

typedef char accumulator_head_fits[
    offsetof(struct rho_message_accumulator, num_cells_total) ==
    offsetof(struct rho_message_accumulator_head, num_cells_total) ? 1 : -1];
typedef char bearing_scan_head_fits[
    offsetof(struct rho_message_bearing_scan, sigma_rad) ==
    offsetof(struct rho_message_bearing_scan_head, sigma_rad) ? 1 : -1];
typedef char body_list_head_fits[
    offsetof(struct rho_message_body_list, num_parts) ==
    offsetof(struct rho_message_body_list_head, num_parts) ? 1 : -1];
typedef char clutter_map_head_fits[
    offsetof(struct rho_message_clutter_map, num_parts) ==
    offsetof(struct rho_message_clutter_map_head, num_parts) ? 1 : -1];
typedef char direction_scan_head_fits[
    offsetof(struct rho_message_direction_scan, sector_to_rad) ==
    offsetof(struct rho_message_direction_scan_head, sector_to_rad) ? 1 : -1];
typedef char ghost_matrix_head_fits[
    offsetof(struct rho_message_ghost_matrix, num_parts) ==
    offsetof(struct rho_message_ghost_matrix_head, num_parts) ? 1 : -1];
typedef char hypotheses_head_fits[
    offsetof(struct rho_message_hypotheses, not_sent) ==
    offsetof(struct rho_message_hypotheses_head, not_sent) ? 1 : -1];
typedef char life_head_fits[
    offsetof(struct rho_message_life, num_parts) ==
    offsetof(struct rho_message_life_head, num_parts) ? 1 : -1];
typedef char peak_list_head_fits[
    offsetof(struct rho_message_peak_list, scan) ==
    offsetof(struct rho_message_peak_list_head, scan) ? 1 : -1];
typedef char plane_head_fits[
    offsetof(struct rho_message_plane, num_parts) ==
    offsetof(struct rho_message_plane_head, num_parts) ? 1 : -1];
typedef char plot_scan_head_fits[
    offsetof(struct rho_message_plot_scan, sector_to_rad) ==
    offsetof(struct rho_message_plot_scan_head, sector_to_rad) ? 1 : -1];
typedef char polar_scan_head_fits[
    offsetof(struct rho_message_polar_scan, sector_to_rad) ==
    offsetof(struct rho_message_polar_scan_head, sector_to_rad) ? 1 : -1];
typedef char sensor_list_head_fits[
    offsetof(struct rho_message_sensor_list, num_parts) ==
    offsetof(struct rho_message_sensor_list_head, num_parts) ? 1 : -1];
typedef char track_list_head_fits[
    offsetof(struct rho_message_track_list, num_parts) ==
    offsetof(struct rho_message_track_list_head, num_parts) ? 1 : -1];
typedef char truth_list_head_fits[
    offsetof(struct rho_message_truth_list, num_parts) ==
    offsetof(struct rho_message_truth_list_head, num_parts) ? 1 : -1];
typedef char zone_event_list_head_fits[
    offsetof(struct rho_message_zone_event_list, epoch) ==
    offsetof(struct rho_message_zone_event_list_head, epoch) ? 1 : -1];
typedef char zone_list_head_fits[
    offsetof(struct rho_message_zone_list, events_dropped) ==
    offsetof(struct rho_message_zone_list_head, events_dropped) ? 1 : -1];

uint64_t rho_message_fingerprint(enum rho_message_type type)
{
    static const uint64_t fingerprints[RHO_NUM_MESSAGE_TYPES] = {
        RHO_MESSAGE_ACCUMULATOR_CELL_FINGERPRINT,
        RHO_MESSAGE_BODY_FINGERPRINT,
        RHO_MESSAGE_COMMAND_ANSWER_FINGERPRINT,
        RHO_MESSAGE_COMMAND_FINGERPRINT,
        RHO_MESSAGE_DIRECTION_FINGERPRINT,
        RHO_MESSAGE_ECHO_FINGERPRINT,
        RHO_MESSAGE_GHOST_FINGERPRINT,
        RHO_MESSAGE_HYPOTHESIS_FINGERPRINT,
        RHO_MESSAGE_LEARNED_FINGERPRINT,
        RHO_MESSAGE_PEAK_FINGERPRINT,
        RHO_MESSAGE_PLANE_ROW_FINGERPRINT,
        RHO_MESSAGE_PLOT_FINGERPRINT,
        RHO_MESSAGE_POLAR_PLOT_FINGERPRINT,
        RHO_MESSAGE_SENSOR_FINGERPRINT,
        RHO_MESSAGE_SETTING_ANSWER_FINGERPRINT,
        RHO_MESSAGE_SETTING_FINGERPRINT,
        RHO_MESSAGE_STATUS_FINGERPRINT,
        RHO_MESSAGE_TRACK_LIFE_FINGERPRINT,
        RHO_MESSAGE_TRACK_FINGERPRINT,
        RHO_MESSAGE_TRUTH_FINGERPRINT,
        RHO_MESSAGE_WORK_FINGERPRINT,
        RHO_MESSAGE_ZONE_EVENT_FINGERPRINT,
        RHO_MESSAGE_ZONE_FINGERPRINT,
        RHO_MESSAGE_ACCUMULATOR_FINGERPRINT,
        RHO_MESSAGE_BEARING_SCAN_FINGERPRINT,
        RHO_MESSAGE_BODY_LIST_FINGERPRINT,
        RHO_MESSAGE_CLUTTER_MAP_FINGERPRINT,
        RHO_MESSAGE_DIRECTION_SCAN_FINGERPRINT,
        RHO_MESSAGE_GHOST_MATRIX_FINGERPRINT,
        RHO_MESSAGE_HYPOTHESES_FINGERPRINT,
        RHO_MESSAGE_LIFE_FINGERPRINT,
        RHO_MESSAGE_PEAK_LIST_FINGERPRINT,
        RHO_MESSAGE_PLANE_FINGERPRINT,
        RHO_MESSAGE_PLOT_SCAN_FINGERPRINT,
        RHO_MESSAGE_POLAR_SCAN_FINGERPRINT,
        RHO_MESSAGE_SENSOR_LIST_FINGERPRINT,
        RHO_MESSAGE_TRACK_LIST_FINGERPRINT,
        RHO_MESSAGE_TRUTH_LIST_FINGERPRINT,
        RHO_MESSAGE_ZONE_EVENT_LIST_FINGERPRINT,
        RHO_MESSAGE_ZONE_LIST_FINGERPRINT,
    };

    return (unsigned)type < RHO_NUM_MESSAGE_TYPES ? fingerprints[type] : 0;
}

enum rho_message_type rho_message_type_of(const uint8_t *data, size_t size)
{
    uint64_t fingerprint = 0;
    int type = 0;

    if (!data || size < MESSAGE_FINGERPRINT_BYTES) {
        return RHO_NUM_MESSAGE_TYPES;
    }
    for (unsigned i = 0; i < MESSAGE_FINGERPRINT_BYTES; i++) {
        fingerprint = fingerprint << 8 | data[i];
    }
    while (type < RHO_NUM_MESSAGE_TYPES &&
           rho_message_fingerprint((enum rho_message_type)type) != fingerprint) {
        type++;
    }
    return (enum rho_message_type)type;
}

enum rho_status rho_message_accumulator_cell_encode(
    const struct rho_message_accumulator_cell *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&accumulator_cell_format, message, buffer, capacity, size);
}

enum rho_status rho_message_accumulator_cell_decode(
    const uint8_t *data, size_t size, struct rho_message_accumulator_cell *message)
{
    return rho_message_decode(&accumulator_cell_format, data, size, message);
}

enum rho_status rho_message_accumulator_cell_validate(
    const struct rho_message_accumulator_cell *message, struct rho_message_place *place)
{
    return rho_message_validate(&accumulator_cell_rules, message, place);
}

enum rho_status rho_message_body_encode(
    const struct rho_message_body *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&body_format, message, buffer, capacity, size);
}

enum rho_status rho_message_body_decode(
    const uint8_t *data, size_t size, struct rho_message_body *message)
{
    return rho_message_decode(&body_format, data, size, message);
}

enum rho_status rho_message_body_validate(
    const struct rho_message_body *message, struct rho_message_place *place)
{
    return rho_message_validate(&body_rules, message, place);
}

enum rho_status rho_message_command_answer_encode(
    const struct rho_message_command_answer *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&command_answer_format, message, buffer, capacity, size);
}

enum rho_status rho_message_command_answer_decode(
    const uint8_t *data, size_t size, struct rho_message_command_answer *message)
{
    return rho_message_decode(&command_answer_format, data, size, message);
}

enum rho_status rho_message_command_answer_validate(
    const struct rho_message_command_answer *message, struct rho_message_place *place)
{
    return rho_message_validate(&command_answer_rules, message, place);
}

enum rho_status rho_message_command_encode(
    const struct rho_message_command *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&command_format, message, buffer, capacity, size);
}

enum rho_status rho_message_command_decode(
    const uint8_t *data, size_t size, struct rho_message_command *message)
{
    return rho_message_decode(&command_format, data, size, message);
}

enum rho_status rho_message_command_validate(
    const struct rho_message_command *message, struct rho_message_place *place)
{
    return rho_message_validate(&command_rules, message, place);
}

enum rho_status rho_message_direction_encode(
    const struct rho_message_direction *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&direction_format, message, buffer, capacity, size);
}

enum rho_status rho_message_direction_decode(
    const uint8_t *data, size_t size, struct rho_message_direction *message)
{
    return rho_message_decode(&direction_format, data, size, message);
}

enum rho_status rho_message_direction_validate(
    const struct rho_message_direction *message, struct rho_message_place *place)
{
    return rho_message_validate(&direction_rules, message, place);
}

enum rho_status rho_message_echo_encode(
    const struct rho_message_echo *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&echo_format, message, buffer, capacity, size);
}

enum rho_status rho_message_echo_decode(
    const uint8_t *data, size_t size, struct rho_message_echo *message)
{
    return rho_message_decode(&echo_format, data, size, message);
}

enum rho_status rho_message_echo_validate(
    const struct rho_message_echo *message, struct rho_message_place *place)
{
    return rho_message_validate(&echo_rules, message, place);
}

enum rho_status rho_message_ghost_encode(
    const struct rho_message_ghost *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&ghost_format, message, buffer, capacity, size);
}

enum rho_status rho_message_ghost_decode(
    const uint8_t *data, size_t size, struct rho_message_ghost *message)
{
    return rho_message_decode(&ghost_format, data, size, message);
}

enum rho_status rho_message_ghost_validate(
    const struct rho_message_ghost *message, struct rho_message_place *place)
{
    return rho_message_validate(&ghost_rules, message, place);
}

enum rho_status rho_message_hypothesis_encode(
    const struct rho_message_hypothesis *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&hypothesis_format, message, buffer, capacity, size);
}

enum rho_status rho_message_hypothesis_decode(
    const uint8_t *data, size_t size, struct rho_message_hypothesis *message)
{
    return rho_message_decode(&hypothesis_format, data, size, message);
}

enum rho_status rho_message_hypothesis_validate(
    const struct rho_message_hypothesis *message, struct rho_message_place *place)
{
    return rho_message_validate(&hypothesis_rules, message, place);
}

enum rho_status rho_message_learned_encode(
    const struct rho_message_learned *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&learned_format, message, buffer, capacity, size);
}

enum rho_status rho_message_learned_decode(
    const uint8_t *data, size_t size, struct rho_message_learned *message)
{
    return rho_message_decode(&learned_format, data, size, message);
}

enum rho_status rho_message_learned_validate(
    const struct rho_message_learned *message, struct rho_message_place *place)
{
    return rho_message_validate(&learned_rules, message, place);
}

enum rho_status rho_message_peak_encode(
    const struct rho_message_peak *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&peak_format, message, buffer, capacity, size);
}

enum rho_status rho_message_peak_decode(
    const uint8_t *data, size_t size, struct rho_message_peak *message)
{
    return rho_message_decode(&peak_format, data, size, message);
}

enum rho_status rho_message_peak_validate(
    const struct rho_message_peak *message, struct rho_message_place *place)
{
    return rho_message_validate(&peak_rules, message, place);
}

enum rho_status rho_message_plane_row_encode(
    const struct rho_message_plane_row *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&plane_row_format, message, buffer, capacity, size);
}

enum rho_status rho_message_plane_row_decode(
    const uint8_t *data, size_t size, struct rho_message_plane_row *message)
{
    return rho_message_decode(&plane_row_format, data, size, message);
}

enum rho_status rho_message_plane_row_validate(
    const struct rho_message_plane_row *message, struct rho_message_place *place)
{
    return rho_message_validate(&plane_row_rules, message, place);
}

enum rho_status rho_message_plot_encode(
    const struct rho_message_plot *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&plot_format, message, buffer, capacity, size);
}

enum rho_status rho_message_plot_decode(
    const uint8_t *data, size_t size, struct rho_message_plot *message)
{
    return rho_message_decode(&plot_format, data, size, message);
}

enum rho_status rho_message_plot_validate(
    const struct rho_message_plot *message, struct rho_message_place *place)
{
    return rho_message_validate(&plot_rules, message, place);
}

enum rho_status rho_message_polar_plot_encode(
    const struct rho_message_polar_plot *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&polar_plot_format, message, buffer, capacity, size);
}

enum rho_status rho_message_polar_plot_decode(
    const uint8_t *data, size_t size, struct rho_message_polar_plot *message)
{
    return rho_message_decode(&polar_plot_format, data, size, message);
}

enum rho_status rho_message_polar_plot_validate(
    const struct rho_message_polar_plot *message, struct rho_message_place *place)
{
    return rho_message_validate(&polar_plot_rules, message, place);
}

enum rho_status rho_message_sensor_encode(
    const struct rho_message_sensor *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&sensor_format, message, buffer, capacity, size);
}

enum rho_status rho_message_sensor_decode(
    const uint8_t *data, size_t size, struct rho_message_sensor *message)
{
    return rho_message_decode(&sensor_format, data, size, message);
}

enum rho_status rho_message_sensor_validate(
    const struct rho_message_sensor *message, struct rho_message_place *place)
{
    return rho_message_validate(&sensor_rules, message, place);
}

enum rho_status rho_message_setting_answer_encode(
    const struct rho_message_setting_answer *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&setting_answer_format, message, buffer, capacity, size);
}

enum rho_status rho_message_setting_answer_decode(
    const uint8_t *data, size_t size, struct rho_message_setting_answer *message)
{
    return rho_message_decode(&setting_answer_format, data, size, message);
}

enum rho_status rho_message_setting_answer_validate(
    const struct rho_message_setting_answer *message, struct rho_message_place *place)
{
    return rho_message_validate(&setting_answer_rules, message, place);
}

enum rho_status rho_message_setting_encode(
    const struct rho_message_setting *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&setting_format, message, buffer, capacity, size);
}

enum rho_status rho_message_setting_decode(
    const uint8_t *data, size_t size, struct rho_message_setting *message)
{
    return rho_message_decode(&setting_format, data, size, message);
}

enum rho_status rho_message_setting_validate(
    const struct rho_message_setting *message, struct rho_message_place *place)
{
    return rho_message_validate(&setting_rules, message, place);
}

enum rho_status rho_message_status_encode(
    const struct rho_message_status *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&status_format, message, buffer, capacity, size);
}

enum rho_status rho_message_status_decode(
    const uint8_t *data, size_t size, struct rho_message_status *message)
{
    return rho_message_decode(&status_format, data, size, message);
}

enum rho_status rho_message_status_validate(
    const struct rho_message_status *message, struct rho_message_place *place)
{
    return rho_message_validate(&status_rules, message, place);
}

enum rho_status rho_message_track_life_encode(
    const struct rho_message_track_life *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&track_life_format, message, buffer, capacity, size);
}

enum rho_status rho_message_track_life_decode(
    const uint8_t *data, size_t size, struct rho_message_track_life *message)
{
    return rho_message_decode(&track_life_format, data, size, message);
}

enum rho_status rho_message_track_life_validate(
    const struct rho_message_track_life *message, struct rho_message_place *place)
{
    return rho_message_validate(&track_life_rules, message, place);
}

enum rho_status rho_message_track_encode(
    const struct rho_message_track *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&track_format, message, buffer, capacity, size);
}

enum rho_status rho_message_track_decode(
    const uint8_t *data, size_t size, struct rho_message_track *message)
{
    return rho_message_decode(&track_format, data, size, message);
}

enum rho_status rho_message_track_validate(
    const struct rho_message_track *message, struct rho_message_place *place)
{
    return rho_message_validate(&track_rules, message, place);
}

enum rho_status rho_message_truth_encode(
    const struct rho_message_truth *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&truth_format, message, buffer, capacity, size);
}

enum rho_status rho_message_truth_decode(
    const uint8_t *data, size_t size, struct rho_message_truth *message)
{
    return rho_message_decode(&truth_format, data, size, message);
}

enum rho_status rho_message_truth_validate(
    const struct rho_message_truth *message, struct rho_message_place *place)
{
    return rho_message_validate(&truth_rules, message, place);
}

enum rho_status rho_message_work_encode(
    const struct rho_message_work *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&work_format, message, buffer, capacity, size);
}

enum rho_status rho_message_work_decode(
    const uint8_t *data, size_t size, struct rho_message_work *message)
{
    return rho_message_decode(&work_format, data, size, message);
}

enum rho_status rho_message_work_validate(
    const struct rho_message_work *message, struct rho_message_place *place)
{
    return rho_message_validate(&work_rules, message, place);
}

enum rho_status rho_message_zone_event_encode(
    const struct rho_message_zone_event *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&zone_event_format, message, buffer, capacity, size);
}

enum rho_status rho_message_zone_event_decode(
    const uint8_t *data, size_t size, struct rho_message_zone_event *message)
{
    return rho_message_decode(&zone_event_format, data, size, message);
}

enum rho_status rho_message_zone_event_validate(
    const struct rho_message_zone_event *message, struct rho_message_place *place)
{
    return rho_message_validate(&zone_event_rules, message, place);
}

enum rho_status rho_message_zone_encode(
    const struct rho_message_zone *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&zone_format, message, buffer, capacity, size);
}

enum rho_status rho_message_zone_decode(
    const uint8_t *data, size_t size, struct rho_message_zone *message)
{
    return rho_message_decode(&zone_format, data, size, message);
}

enum rho_status rho_message_zone_validate(
    const struct rho_message_zone *message, struct rho_message_place *place)
{
    return rho_message_validate(&zone_rules, message, place);
}

enum rho_status rho_message_accumulator_encode(
    const struct rho_message_accumulator *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&accumulator_format, message, buffer, capacity, size);
}

enum rho_status rho_message_accumulator_decode(
    const uint8_t *data, size_t size, struct rho_message_accumulator *message)
{
    return rho_message_decode(&accumulator_format, data, size, message);
}

enum rho_status rho_message_accumulator_validate(
    const struct rho_message_accumulator *message, struct rho_message_place *place)
{
    return rho_message_validate(&accumulator_rules, message, place);
}

enum rho_status rho_message_accumulator_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_accumulator_head *head)
{
    return rho_message_begin(&accumulator_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_accumulator_add(
    struct rho_message_writer *writer, const struct rho_message_accumulator_cell *cell)
{
    return rho_message_add(&accumulator_format, writer, cell);
}

enum rho_status rho_message_bearing_scan_encode(
    const struct rho_message_bearing_scan *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&bearing_scan_format, message, buffer, capacity, size);
}

enum rho_status rho_message_bearing_scan_decode(
    const uint8_t *data, size_t size, struct rho_message_bearing_scan *message)
{
    return rho_message_decode(&bearing_scan_format, data, size, message);
}

enum rho_status rho_message_bearing_scan_validate(
    const struct rho_message_bearing_scan *message, struct rho_message_place *place)
{
    return rho_message_validate(&bearing_scan_rules, message, place);
}

enum rho_status rho_message_bearing_scan_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_bearing_scan_head *head)
{
    return rho_message_begin(&bearing_scan_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_bearing_scan_add(
    struct rho_message_writer *writer, const float *bearing_rad)
{
    return rho_message_add(&bearing_scan_format, writer, bearing_rad);
}

enum rho_status rho_message_body_list_encode(
    const struct rho_message_body_list *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&body_list_format, message, buffer, capacity, size);
}

enum rho_status rho_message_body_list_decode(
    const uint8_t *data, size_t size, struct rho_message_body_list *message)
{
    return rho_message_decode(&body_list_format, data, size, message);
}

enum rho_status rho_message_body_list_validate(
    const struct rho_message_body_list *message, struct rho_message_place *place)
{
    return rho_message_validate(&body_list_rules, message, place);
}

enum rho_status rho_message_body_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_body_list_head *head)
{
    return rho_message_begin(&body_list_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_body_list_add(
    struct rho_message_writer *writer, const struct rho_message_body *bodie)
{
    return rho_message_add(&body_list_format, writer, bodie);
}

enum rho_status rho_message_clutter_map_encode(
    const struct rho_message_clutter_map *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&clutter_map_format, message, buffer, capacity, size);
}

enum rho_status rho_message_clutter_map_decode(
    const uint8_t *data, size_t size, struct rho_message_clutter_map *message)
{
    return rho_message_decode(&clutter_map_format, data, size, message);
}

enum rho_status rho_message_clutter_map_validate(
    const struct rho_message_clutter_map *message, struct rho_message_place *place)
{
    return rho_message_validate(&clutter_map_rules, message, place);
}

enum rho_status rho_message_clutter_map_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_clutter_map_head *head)
{
    return rho_message_begin(&clutter_map_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_clutter_map_add(
    struct rho_message_writer *writer, const struct rho_message_echo *echoe)
{
    return rho_message_add(&clutter_map_format, writer, echoe);
}

enum rho_status rho_message_direction_scan_encode(
    const struct rho_message_direction_scan *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&direction_scan_format, message, buffer, capacity, size);
}

enum rho_status rho_message_direction_scan_decode(
    const uint8_t *data, size_t size, struct rho_message_direction_scan *message)
{
    return rho_message_decode(&direction_scan_format, data, size, message);
}

enum rho_status rho_message_direction_scan_validate(
    const struct rho_message_direction_scan *message, struct rho_message_place *place)
{
    return rho_message_validate(&direction_scan_rules, message, place);
}

enum rho_status rho_message_direction_scan_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_direction_scan_head *head)
{
    return rho_message_begin(&direction_scan_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_direction_scan_add(
    struct rho_message_writer *writer, const struct rho_message_direction *direction)
{
    return rho_message_add(&direction_scan_format, writer, direction);
}

enum rho_status rho_message_ghost_matrix_encode(
    const struct rho_message_ghost_matrix *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&ghost_matrix_format, message, buffer, capacity, size);
}

enum rho_status rho_message_ghost_matrix_decode(
    const uint8_t *data, size_t size, struct rho_message_ghost_matrix *message)
{
    return rho_message_decode(&ghost_matrix_format, data, size, message);
}

enum rho_status rho_message_ghost_matrix_validate(
    const struct rho_message_ghost_matrix *message, struct rho_message_place *place)
{
    return rho_message_validate(&ghost_matrix_rules, message, place);
}

enum rho_status rho_message_ghost_matrix_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_ghost_matrix_head *head)
{
    return rho_message_begin(&ghost_matrix_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_ghost_matrix_add(
    struct rho_message_writer *writer, const struct rho_message_ghost *element)
{
    return rho_message_add(&ghost_matrix_format, writer, element);
}

enum rho_status rho_message_hypotheses_encode(
    const struct rho_message_hypotheses *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&hypotheses_format, message, buffer, capacity, size);
}

enum rho_status rho_message_hypotheses_decode(
    const uint8_t *data, size_t size, struct rho_message_hypotheses *message)
{
    return rho_message_decode(&hypotheses_format, data, size, message);
}

enum rho_status rho_message_hypotheses_validate(
    const struct rho_message_hypotheses *message, struct rho_message_place *place)
{
    return rho_message_validate(&hypotheses_rules, message, place);
}

enum rho_status rho_message_hypotheses_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_hypotheses_head *head)
{
    return rho_message_begin(&hypotheses_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_hypotheses_add(
    struct rho_message_writer *writer, const struct rho_message_hypothesis *hypothese)
{
    return rho_message_add(&hypotheses_format, writer, hypothese);
}

enum rho_status rho_message_life_encode(
    const struct rho_message_life *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&life_format, message, buffer, capacity, size);
}

enum rho_status rho_message_life_decode(
    const uint8_t *data, size_t size, struct rho_message_life *message)
{
    return rho_message_decode(&life_format, data, size, message);
}

enum rho_status rho_message_life_validate(
    const struct rho_message_life *message, struct rho_message_place *place)
{
    return rho_message_validate(&life_rules, message, place);
}

enum rho_status rho_message_life_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_life_head *head)
{
    return rho_message_begin(&life_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_life_add(
    struct rho_message_writer *writer, const struct rho_message_track_life *track)
{
    return rho_message_add(&life_format, writer, track);
}

enum rho_status rho_message_peak_list_encode(
    const struct rho_message_peak_list *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&peak_list_format, message, buffer, capacity, size);
}

enum rho_status rho_message_peak_list_decode(
    const uint8_t *data, size_t size, struct rho_message_peak_list *message)
{
    return rho_message_decode(&peak_list_format, data, size, message);
}

enum rho_status rho_message_peak_list_validate(
    const struct rho_message_peak_list *message, struct rho_message_place *place)
{
    return rho_message_validate(&peak_list_rules, message, place);
}

enum rho_status rho_message_peak_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_peak_list_head *head)
{
    return rho_message_begin(&peak_list_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_peak_list_add(
    struct rho_message_writer *writer, const struct rho_message_peak *peak)
{
    return rho_message_add(&peak_list_format, writer, peak);
}

enum rho_status rho_message_plane_encode(
    const struct rho_message_plane *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&plane_format, message, buffer, capacity, size);
}

enum rho_status rho_message_plane_decode(
    const uint8_t *data, size_t size, struct rho_message_plane *message)
{
    return rho_message_decode(&plane_format, data, size, message);
}

enum rho_status rho_message_plane_validate(
    const struct rho_message_plane *message, struct rho_message_place *place)
{
    return rho_message_validate(&plane_rules, message, place);
}

enum rho_status rho_message_plane_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_plane_head *head)
{
    return rho_message_begin(&plane_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_plane_add(
    struct rho_message_writer *writer, const struct rho_message_plane_row *row)
{
    return rho_message_add(&plane_format, writer, row);
}

enum rho_status rho_message_plot_scan_encode(
    const struct rho_message_plot_scan *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&plot_scan_format, message, buffer, capacity, size);
}

enum rho_status rho_message_plot_scan_decode(
    const uint8_t *data, size_t size, struct rho_message_plot_scan *message)
{
    return rho_message_decode(&plot_scan_format, data, size, message);
}

enum rho_status rho_message_plot_scan_validate(
    const struct rho_message_plot_scan *message, struct rho_message_place *place)
{
    return rho_message_validate(&plot_scan_rules, message, place);
}

enum rho_status rho_message_plot_scan_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_plot_scan_head *head)
{
    return rho_message_begin(&plot_scan_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_plot_scan_add(
    struct rho_message_writer *writer, const struct rho_message_plot *plot)
{
    return rho_message_add(&plot_scan_format, writer, plot);
}

enum rho_status rho_message_polar_scan_encode(
    const struct rho_message_polar_scan *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&polar_scan_format, message, buffer, capacity, size);
}

enum rho_status rho_message_polar_scan_decode(
    const uint8_t *data, size_t size, struct rho_message_polar_scan *message)
{
    return rho_message_decode(&polar_scan_format, data, size, message);
}

enum rho_status rho_message_polar_scan_validate(
    const struct rho_message_polar_scan *message, struct rho_message_place *place)
{
    return rho_message_validate(&polar_scan_rules, message, place);
}

enum rho_status rho_message_polar_scan_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_polar_scan_head *head)
{
    return rho_message_begin(&polar_scan_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_polar_scan_add(
    struct rho_message_writer *writer, const struct rho_message_polar_plot *polar_plot)
{
    return rho_message_add(&polar_scan_format, writer, polar_plot);
}

enum rho_status rho_message_sensor_list_encode(
    const struct rho_message_sensor_list *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&sensor_list_format, message, buffer, capacity, size);
}

enum rho_status rho_message_sensor_list_decode(
    const uint8_t *data, size_t size, struct rho_message_sensor_list *message)
{
    return rho_message_decode(&sensor_list_format, data, size, message);
}

enum rho_status rho_message_sensor_list_validate(
    const struct rho_message_sensor_list *message, struct rho_message_place *place)
{
    return rho_message_validate(&sensor_list_rules, message, place);
}

enum rho_status rho_message_sensor_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_sensor_list_head *head)
{
    return rho_message_begin(&sensor_list_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_sensor_list_add(
    struct rho_message_writer *writer, const struct rho_message_sensor *sensor)
{
    return rho_message_add(&sensor_list_format, writer, sensor);
}

enum rho_status rho_message_track_list_encode(
    const struct rho_message_track_list *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&track_list_format, message, buffer, capacity, size);
}

enum rho_status rho_message_track_list_decode(
    const uint8_t *data, size_t size, struct rho_message_track_list *message)
{
    return rho_message_decode(&track_list_format, data, size, message);
}

enum rho_status rho_message_track_list_validate(
    const struct rho_message_track_list *message, struct rho_message_place *place)
{
    return rho_message_validate(&track_list_rules, message, place);
}

enum rho_status rho_message_track_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_track_list_head *head)
{
    return rho_message_begin(&track_list_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_track_list_add(
    struct rho_message_writer *writer, const struct rho_message_track *track)
{
    return rho_message_add(&track_list_format, writer, track);
}

enum rho_status rho_message_truth_list_encode(
    const struct rho_message_truth_list *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&truth_list_format, message, buffer, capacity, size);
}

enum rho_status rho_message_truth_list_decode(
    const uint8_t *data, size_t size, struct rho_message_truth_list *message)
{
    return rho_message_decode(&truth_list_format, data, size, message);
}

enum rho_status rho_message_truth_list_validate(
    const struct rho_message_truth_list *message, struct rho_message_place *place)
{
    return rho_message_validate(&truth_list_rules, message, place);
}

enum rho_status rho_message_truth_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_truth_list_head *head)
{
    return rho_message_begin(&truth_list_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_truth_list_add(
    struct rho_message_writer *writer, const struct rho_message_truth *target)
{
    return rho_message_add(&truth_list_format, writer, target);
}

enum rho_status rho_message_zone_event_list_encode(
    const struct rho_message_zone_event_list *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&zone_event_list_format, message, buffer, capacity, size);
}

enum rho_status rho_message_zone_event_list_decode(
    const uint8_t *data, size_t size, struct rho_message_zone_event_list *message)
{
    return rho_message_decode(&zone_event_list_format, data, size, message);
}

enum rho_status rho_message_zone_event_list_validate(
    const struct rho_message_zone_event_list *message, struct rho_message_place *place)
{
    return rho_message_validate(&zone_event_list_rules, message, place);
}

enum rho_status rho_message_zone_event_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_zone_event_list_head *head)
{
    return rho_message_begin(&zone_event_list_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_zone_event_list_add(
    struct rho_message_writer *writer, const struct rho_message_zone_event *event)
{
    return rho_message_add(&zone_event_list_format, writer, event);
}

enum rho_status rho_message_zone_list_encode(
    const struct rho_message_zone_list *message, uint8_t *buffer, size_t capacity,
    size_t *size)
{
    return rho_message_encode(&zone_list_format, message, buffer, capacity, size);
}

enum rho_status rho_message_zone_list_decode(
    const uint8_t *data, size_t size, struct rho_message_zone_list *message)
{
    return rho_message_decode(&zone_list_format, data, size, message);
}

enum rho_status rho_message_zone_list_validate(
    const struct rho_message_zone_list *message, struct rho_message_place *place)
{
    return rho_message_validate(&zone_list_rules, message, place);
}

enum rho_status rho_message_zone_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_zone_list_head *head)
{
    return rho_message_begin(&zone_list_format, writer, buffer, capacity, head);
}

enum rho_status rho_message_zone_list_add(
    struct rho_message_writer *writer, const struct rho_message_zone *zone)
{
    return rho_message_add(&zone_list_format, writer, zone);
}
