/* SPDX-License-Identifier: MIT */
/* Made by tools/codegen from lcm_types/. Not to be edited: `make codegen`. */
/* clang-format off */
/* message_names: names of messages and members; firmware need not link them. */
#include "rhotrack/message.h"

/* Offset and name of a member; tables have the members in their order. */
struct member_name {
    uint16_t offset;
    char text[21];
};

/* Name of the last member that begins at the offset or before; an array is one member. */
static const char *find_member_name(const struct member_name *names, unsigned count,
                                    uint16_t offset)
{
    unsigned i = 0;

    while (i + 1 < count && names[i + 1].offset <= offset) {
        i++;
    }
    return names[i].text;
}

static const struct member_name accumulator_cell_names[] = {
    {offsetof(struct rho_message_accumulator_cell, rho_m), "rho_m"},
    {offsetof(struct rho_message_accumulator_cell, theta_rad), "theta_rad"},
    {offsetof(struct rho_message_accumulator_cell, votes), "votes"},
    {offsetof(struct rho_message_accumulator_cell, scan_mask), "scan_mask"},
    {offsetof(struct rho_message_accumulator_cell, plots), "plots"},
    {offsetof(struct rho_message_accumulator_cell, track_id), "track_id"},
};

static const struct member_name body_names[] = {
    {offsetof(struct rho_message_body, track_id), "track_id"},
    {offsetof(struct rho_message_body, x_m), "x_m"},
    {offsetof(struct rho_message_body, y_m), "y_m"},
    {offsetof(struct rho_message_body, reference_x_m), "reference_x_m"},
    {offsetof(struct rho_message_body, reference_y_m), "reference_y_m"},
    {offsetof(struct rho_message_body, length_m), "length_m"},
    {offsetof(struct rho_message_body, width_m), "width_m"},
    {offsetof(struct rho_message_body, heading_rad), "heading_rad"},
    {offsetof(struct rho_message_body, sigma_length_m), "sigma_length_m"},
    {offsetof(struct rho_message_body, sigma_width_m), "sigma_width_m"},
    {offsetof(struct rho_message_body, sigma_heading_rad), "sigma_heading_rad"},
    {offsetof(struct rho_message_body, sigma_along_m), "sigma_along_m"},
    {offsetof(struct rho_message_body, sigma_across_m), "sigma_across_m"},
    {offsetof(struct rho_message_body, plots), "plots"},
};

static const struct member_name command_answer_names[] = {
    {offsetof(struct rho_message_command_answer, utime), "utime"},
    {offsetof(struct rho_message_command_answer, scan), "scan"},
    {offsetof(struct rho_message_command_answer, epoch), "epoch"},
    {offsetof(struct rho_message_command_answer, number), "number"},
    {offsetof(struct rho_message_command_answer, action), "action"},
    {offsetof(struct rho_message_command_answer, status), "status"},
    {offsetof(struct rho_message_command_answer, track_id), "track_id"},
};

static const struct member_name command_names[] = {
    {offsetof(struct rho_message_command, utime), "utime"},
    {offsetof(struct rho_message_command, number), "number"},
    {offsetof(struct rho_message_command, action), "action"},
    {offsetof(struct rho_message_command, track_id), "track_id"},
    {offsetof(struct rho_message_command, new_id), "new_id"},
    {offsetof(struct rho_message_command, x_m), "x_m"},
    {offsetof(struct rho_message_command, y_m), "y_m"},
    {offsetof(struct rho_message_command, x_max_m), "x_max_m"},
    {offsetof(struct rho_message_command, y_max_m), "y_max_m"},
    {offsetof(struct rho_message_command, sigma_m), "sigma_m"},
    {offsetof(struct rho_message_command, vx_mps), "vx_mps"},
    {offsetof(struct rho_message_command, vy_mps), "vy_mps"},
    {offsetof(struct rho_message_command, sigma_mps), "sigma_mps"},
};

static const struct member_name direction_names[] = {
    {offsetof(struct rho_message_direction, dt_us), "dt_us"},
    {offsetof(struct rho_message_direction, bearing_rad), "bearing_rad"},
    {offsetof(struct rho_message_direction, elevation_rad), "elevation_rad"},
    {offsetof(struct rho_message_direction, snr_db), "snr_db"},
    {offsetof(struct rho_message_direction, has_elevation), "has_elevation"},
};

static const struct member_name echo_names[] = {
    {offsetof(struct rho_message_echo, sensor_id), "sensor_id"},
    {offsetof(struct rho_message_echo, hits), "hits"},
    {offsetof(struct rho_message_echo, unseen), "unseen"},
    {offsetof(struct rho_message_echo, x_m), "x_m"},
    {offsetof(struct rho_message_echo, y_m), "y_m"},
    {offsetof(struct rho_message_echo, vx_mps), "vx_mps"},
    {offsetof(struct rho_message_echo, vy_mps), "vy_mps"},
    {offsetof(struct rho_message_echo, sigma_range_m), "sigma_range_m"},
    {offsetof(struct rho_message_echo, sigma_cross_m), "sigma_cross_m"},
    {offsetof(struct rho_message_echo, chance), "chance"},
};

static const struct member_name ghost_names[] = {
    {offsetof(struct rho_message_ghost, row), "row"},
    {offsetof(struct rho_message_ghost, column), "column"},
    {offsetof(struct rho_message_ghost, reason), "reason"},
    {offsetof(struct rho_message_ghost, delta_rad), "delta_rad"},
    {offsetof(struct rho_message_ghost, x_m), "x_m"},
    {offsetof(struct rho_message_ghost, y_m), "y_m"},
};

static const struct member_name hypothesis_names[] = {
    {offsetof(struct rho_message_hypothesis, share), "share"},
    {offsetof(struct rho_message_hypothesis, x_m), "x_m"},
    {offsetof(struct rho_message_hypothesis, y_m), "y_m"},
    {offsetof(struct rho_message_hypothesis, vx_mps), "vx_mps"},
    {offsetof(struct rho_message_hypothesis, vy_mps), "vy_mps"},
    {offsetof(struct rho_message_hypothesis, maneuver_probability), "maneuver_probability"},
    {offsetof(struct rho_message_hypothesis, plots), "plots"},
};

static const struct member_name learned_names[] = {
    {offsetof(struct rho_message_learned, utime), "utime"},
    {offsetof(struct rho_message_learned, scan), "scan"},
    {offsetof(struct rho_message_learned, epoch), "epoch"},
    {offsetof(struct rho_message_learned, sensor_id), "sensor_id"},
    {offsetof(struct rho_message_learned, innovations), "innovations"},
    {offsetof(struct rho_message_learned, sigma_range_factor), "sigma_range_factor"},
    {offsetof(struct rho_message_learned, sigma_cross_factor), "sigma_cross_factor"},
    {offsetof(struct rho_message_learned, looks), "looks"},
    {offsetof(struct rho_message_learned, range_max_m), "range_max_m"},
    {offsetof(struct rho_message_learned, pd_stated), "pd_stated"},
    {offsetof(struct rho_message_learned, pd), "pd"},
};

static const struct member_name peak_names[] = {
    {offsetof(struct rho_message_peak, rho_m), "rho_m"},
    {offsetof(struct rho_message_peak, theta_rad), "theta_rad"},
    {offsetof(struct rho_message_peak, speed_mps), "speed_mps"},
    {offsetof(struct rho_message_peak, score_nat), "score_nat"},
    {offsetof(struct rho_message_peak, scans_hit), "scans_hit"},
    {offsetof(struct rho_message_peak, sensor_pairs), "sensor_pairs"},
};

static const struct member_name plane_row_names[] = {
    {offsetof(struct rho_message_plane_row, votes), "votes"},
};

static const struct member_name plot_names[] = {
    {offsetof(struct rho_message_plot, dt_us), "dt_us"},
    {offsetof(struct rho_message_plot, x_m), "x_m"},
    {offsetof(struct rho_message_plot, y_m), "y_m"},
    {offsetof(struct rho_message_plot, z_m), "z_m"},
    {offsetof(struct rho_message_plot, vx_mps), "vx_mps"},
    {offsetof(struct rho_message_plot, vy_mps), "vy_mps"},
    {offsetof(struct rho_message_plot, vz_mps), "vz_mps"},
    {offsetof(struct rho_message_plot, sigma_m), "sigma_m"},
    {offsetof(struct rho_message_plot, sigma_mps), "sigma_mps"},
    {offsetof(struct rho_message_plot, snr_db), "snr_db"},
};

static const struct member_name polar_plot_names[] = {
    {offsetof(struct rho_message_polar_plot, dt_us), "dt_us"},
    {offsetof(struct rho_message_polar_plot, range_m), "range_m"},
    {offsetof(struct rho_message_polar_plot, azimuth_rad), "azimuth_rad"},
    {offsetof(struct rho_message_polar_plot, elevation_rad), "elevation_rad"},
    {offsetof(struct rho_message_polar_plot, range_rate_mps), "range_rate_mps"},
    {offsetof(struct rho_message_polar_plot, snr_db), "snr_db"},
};

static const struct member_name sensor_names[] = {
    {offsetof(struct rho_message_sensor, sensor_id), "sensor_id"},
    {offsetof(struct rho_message_sensor, kind), "kind"},
    {offsetof(struct rho_message_sensor, is_silent), "is_silent"},
    {offsetof(struct rho_message_sensor, is_off_clock), "is_off_clock"},
    {offsetof(struct rho_message_sensor, is_doubted), "is_doubted"},
    {offsetof(struct rho_message_sensor, scans), "scans"},
    {offsetof(struct rho_message_sensor, scan_utime), "scan_utime"},
    {offsetof(struct rho_message_sensor, heard_age_us), "heard_age_us"},
    {offsetof(struct rho_message_sensor, interval_us), "interval_us"},
    {offsetof(struct rho_message_sensor, watched), "watched"},
    {offsetof(struct rho_message_sensor, watched_hits), "watched_hits"},
    {offsetof(struct rho_message_sensor, seen_share), "seen_share"},
    {offsetof(struct rho_message_sensor, innovation_factor), "innovation_factor"},
};

static const struct member_name setting_answer_names[] = {
    {offsetof(struct rho_message_setting_answer, utime), "utime"},
    {offsetof(struct rho_message_setting_answer, scan), "scan"},
    {offsetof(struct rho_message_setting_answer, epoch), "epoch"},
    {offsetof(struct rho_message_setting_answer, number), "number"},
    {offsetof(struct rho_message_setting_answer, field), "field"},
    {offsetof(struct rho_message_setting_answer, status), "status"},
    {offsetof(struct rho_message_setting_answer, applies), "applies"},
    {offsetof(struct rho_message_setting_answer, fault_field), "fault_field"},
    {offsetof(struct rho_message_setting_answer, value), "value"},
    {offsetof(struct rho_message_setting_answer, min), "min"},
    {offsetof(struct rho_message_setting_answer, max), "max"},
};

static const struct member_name setting_names[] = {
    {offsetof(struct rho_message_setting, utime), "utime"},
    {offsetof(struct rho_message_setting, number), "number"},
    {offsetof(struct rho_message_setting, field), "field"},
    {offsetof(struct rho_message_setting, value), "value"},
};

static const struct member_name status_names[] = {
    {offsetof(struct rho_message_status, utime), "utime"},
    {offsetof(struct rho_message_status, scan), "scan"},
    {offsetof(struct rho_message_status, epoch), "epoch"},
    {offsetof(struct rho_message_status, scans_accepted), "scans_accepted"},
    {offsetof(struct rho_message_status, scans_late), "scans_late"},
    {offsetof(struct rho_message_status, scans_duplicate), "scans_duplicate"},
    {offsetof(struct rho_message_status, scans_lost), "scans_lost"},
    {offsetof(struct rho_message_status, scans_bad), "scans_bad"},
    {offsetof(struct rho_message_status, messages_bad), "messages_bad"},
    {offsetof(struct rho_message_status, messages_wrong_type), "messages_wrong_type"},
    {offsetof(struct rho_message_status, messages_flooded), "messages_flooded"},
    {offsetof(struct rho_message_status, frames_incomplete), "frames_incomplete"},
    {offsetof(struct rho_message_status, scans_incomplete), "scans_incomplete"},
    {offsetof(struct rho_message_status, fragments_refused), "fragments_refused"},
    {offsetof(struct rho_message_status, clock_jumps), "clock_jumps"},
    {offsetof(struct rho_message_status, sensor_restarts), "sensor_restarts"},
    {offsetof(struct rho_message_status, plots_in), "plots_in"},
    {offsetof(struct rho_message_status, plots_claimed), "plots_claimed"},
    {offsetof(struct rho_message_status, plots_held), "plots_held"},
    {offsetof(struct rho_message_status, plots_initiated), "plots_initiated"},
    {offsetof(struct rho_message_status, plots_clutter), "plots_clutter"},
    {offsetof(struct rho_message_status, inputs_stale), "inputs_stale"},
    {offsetof(struct rho_message_status, inputs_invalid), "inputs_invalid"},
    {offsetof(struct rho_message_status, inputs_no_room), "inputs_no_room"},
    {offsetof(struct rho_message_status, bearings_in), "bearings_in"},
    {offsetof(struct rho_message_status, ghosts_pruned), "ghosts_pruned"},
    {offsetof(struct rho_message_status, tracks_tentative), "tracks_tentative"},
    {offsetof(struct rho_message_status, tracks_confirmed), "tracks_confirmed"},
    {offsetof(struct rho_message_status, tracks_coasting), "tracks_coasting"},
    {offsetof(struct rho_message_status, step_us), "step_us"},
    {offsetof(struct rho_message_status, step_max_us), "step_max_us"},
    {offsetof(struct rho_message_status, clutter_per_km2), "clutter_per_km2"},
    {offsetof(struct rho_message_status, origin_lat_1e7deg), "origin_lat_1e7deg"},
    {offsetof(struct rho_message_status, origin_lon_1e7deg), "origin_lon_1e7deg"},
    {offsetof(struct rho_message_status, origin_alt_mm), "origin_alt_mm"},
};

static const struct member_name track_life_names[] = {
    {offsetof(struct rho_message_track_life, track_id), "track_id"},
    {offsetof(struct rho_message_track_life, existence), "existence"},
    {offsetof(struct rho_message_track_life, visibility), "visibility"},
};

static const struct member_name track_names[] = {
    {offsetof(struct rho_message_track, track_id), "track_id"},
    {offsetof(struct rho_message_track, status), "status"},
    {offsetof(struct rho_message_track, hits), "hits"},
    {offsetof(struct rho_message_track, misses), "misses"},
    {offsetof(struct rho_message_track, sensor_id), "sensor_id"},
    {offsetof(struct rho_message_track, plot), "plot"},
    {offsetof(struct rho_message_track, update_age_us), "update_age_us"},
    {offsetof(struct rho_message_track, x_m), "x_m"},
    {offsetof(struct rho_message_track, y_m), "y_m"},
    {offsetof(struct rho_message_track, z_m), "z_m"},
    {offsetof(struct rho_message_track, vx_mps), "vx_mps"},
    {offsetof(struct rho_message_track, vy_mps), "vy_mps"},
    {offsetof(struct rho_message_track, vz_mps), "vz_mps"},
    {offsetof(struct rho_message_track, ax_mps2), "ax_mps2"},
    {offsetof(struct rho_message_track, ay_mps2), "ay_mps2"},
    {offsetof(struct rho_message_track, az_mps2), "az_mps2"},
    {offsetof(struct rho_message_track, score_nat), "score_nat"},
    {offsetof(struct rho_message_track, maneuver_probability), "maneuver_probability"},
    {offsetof(struct rho_message_track, covariance), "covariance"},
};

static const struct member_name truth_names[] = {
    {offsetof(struct rho_message_truth, target_id), "target_id"},
    {offsetof(struct rho_message_truth, x_m), "x_m"},
    {offsetof(struct rho_message_truth, y_m), "y_m"},
    {offsetof(struct rho_message_truth, z_m), "z_m"},
    {offsetof(struct rho_message_truth, vx_mps), "vx_mps"},
    {offsetof(struct rho_message_truth, vy_mps), "vy_mps"},
    {offsetof(struct rho_message_truth, vz_mps), "vz_mps"},
};

static const struct member_name work_names[] = {
    {offsetof(struct rho_message_work, utime), "utime"},
    {offsetof(struct rho_message_work, scan), "scan"},
    {offsetof(struct rho_message_work, epoch), "epoch"},
    {offsetof(struct rho_message_work, num_steps), "num_steps"},
    {offsetof(struct rho_message_work, work_max), "work_max"},
    {offsetof(struct rho_message_work, work), "work"},
    {offsetof(struct rho_message_work, work_worst), "work_worst"},
    {offsetof(struct rho_message_work, partial_steps), "partial_steps"},
    {offsetof(struct rho_message_work, plots_not_tried), "plots_not_tried"},
    {offsetof(struct rho_message_work, reports_not_printed), "reports_not_printed"},
    {offsetof(struct rho_message_work, events_not_logged), "events_not_logged"},
};

static const struct member_name zone_event_names[] = {
    {offsetof(struct rho_message_zone_event, zone_id), "zone_id"},
    {offsetof(struct rho_message_zone_event, track_id), "track_id"},
    {offsetof(struct rho_message_zone_event, change), "change"},
    {offsetof(struct rho_message_zone_event, direction), "direction"},
    {offsetof(struct rho_message_zone_event, speed_mps), "speed_mps"},
    {offsetof(struct rho_message_zone_event, dwell_s), "dwell_s"},
};

static const struct member_name zone_names[] = {
    {offsetof(struct rho_message_zone, zone_id), "zone_id"},
    {offsetof(struct rho_message_zone, inside), "inside"},
    {offsetof(struct rho_message_zone, queued), "queued"},
    {offsetof(struct rho_message_zone, entered), "entered"},
    {offsetof(struct rho_message_zone, left), "left"},
    {offsetof(struct rho_message_zone, ended), "ended"},
    {offsetof(struct rho_message_zone, along), "along"},
    {offsetof(struct rho_message_zone, against), "against"},
    {offsetof(struct rho_message_zone, speed_mps), "speed_mps"},
    {offsetof(struct rho_message_zone, queue_m), "queue_m"},
    {offsetof(struct rho_message_zone, dwell_mean_s), "dwell_mean_s"},
    {offsetof(struct rho_message_zone, dwell_max_s), "dwell_max_s"},
};

static const struct member_name accumulator_names[] = {
    {offsetof(struct rho_message_accumulator, utime), "utime"},
    {offsetof(struct rho_message_accumulator, scan), "scan"},
    {offsetof(struct rho_message_accumulator, epoch), "epoch"},
    {offsetof(struct rho_message_accumulator, method), "method"},
    {offsetof(struct rho_message_accumulator, has_pair), "has_pair"},
    {offsetof(struct rho_message_accumulator, sensor_a_id), "sensor_a_id"},
    {offsetof(struct rho_message_accumulator, sensor_b_id), "sensor_b_id"},
    {offsetof(struct rho_message_accumulator, num_scans), "num_scans"},
    {offsetof(struct rho_message_accumulator, oldest_utime), "oldest_utime"},
    {offsetof(struct rho_message_accumulator, origin_x_m), "origin_x_m"},
    {offsetof(struct rho_message_accumulator, origin_y_m), "origin_y_m"},
    {offsetof(struct rho_message_accumulator, rho_min_m), "rho_min_m"},
    {offsetof(struct rho_message_accumulator, rho_max_m), "rho_max_m"},
    {offsetof(struct rho_message_accumulator, rho_cells), "rho_cells"},
    {offsetof(struct rho_message_accumulator, theta_cells), "theta_cells"},
    {offsetof(struct rho_message_accumulator, votes_max), "votes_max"},
    {offsetof(struct rho_message_accumulator, votes_min), "votes_min"},
    {offsetof(struct rho_message_accumulator, not_sent), "not_sent"},
    {offsetof(struct rho_message_accumulator, num_cells_total), "num_cells_total"},
    {offsetof(struct rho_message_accumulator, num_cells), "num_cells"},
    {offsetof(struct rho_message_accumulator, cells), "cells"},
};

static const struct member_name bearing_scan_names[] = {
    {offsetof(struct rho_message_bearing_scan, utime), "utime"},
    {offsetof(struct rho_message_bearing_scan, scan), "scan"},
    {offsetof(struct rho_message_bearing_scan, epoch), "epoch"},
    {offsetof(struct rho_message_bearing_scan, sensor_id), "sensor_id"},
    {offsetof(struct rho_message_bearing_scan, sensor_x_m), "sensor_x_m"},
    {offsetof(struct rho_message_bearing_scan, sensor_y_m), "sensor_y_m"},
    {offsetof(struct rho_message_bearing_scan, sigma_rad), "sigma_rad"},
    {offsetof(struct rho_message_bearing_scan, num_bearings), "num_bearings"},
    {offsetof(struct rho_message_bearing_scan, bearing_rad), "bearing_rad"},
};

static const struct member_name body_list_names[] = {
    {offsetof(struct rho_message_body_list, utime), "utime"},
    {offsetof(struct rho_message_body_list, scan), "scan"},
    {offsetof(struct rho_message_body_list, epoch), "epoch"},
    {offsetof(struct rho_message_body_list, part), "part"},
    {offsetof(struct rho_message_body_list, num_parts), "num_parts"},
    {offsetof(struct rho_message_body_list, num_bodies), "num_bodies"},
    {offsetof(struct rho_message_body_list, bodies), "bodies"},
};

static const struct member_name clutter_map_names[] = {
    {offsetof(struct rho_message_clutter_map, utime), "utime"},
    {offsetof(struct rho_message_clutter_map, scan), "scan"},
    {offsetof(struct rho_message_clutter_map, epoch), "epoch"},
    {offsetof(struct rho_message_clutter_map, num_echoes_total), "num_echoes_total"},
    {offsetof(struct rho_message_clutter_map, part), "part"},
    {offsetof(struct rho_message_clutter_map, num_parts), "num_parts"},
    {offsetof(struct rho_message_clutter_map, num_echoes), "num_echoes"},
    {offsetof(struct rho_message_clutter_map, echoes), "echoes"},
};

static const struct member_name direction_scan_names[] = {
    {offsetof(struct rho_message_direction_scan, utime), "utime"},
    {offsetof(struct rho_message_direction_scan, scan), "scan"},
    {offsetof(struct rho_message_direction_scan, epoch), "epoch"},
    {offsetof(struct rho_message_direction_scan, sensor_id), "sensor_id"},
    {offsetof(struct rho_message_direction_scan, sensor_x_m), "sensor_x_m"},
    {offsetof(struct rho_message_direction_scan, sensor_y_m), "sensor_y_m"},
    {offsetof(struct rho_message_direction_scan, sensor_z_m), "sensor_z_m"},
    {offsetof(struct rho_message_direction_scan, sigma_rad), "sigma_rad"},
    {offsetof(struct rho_message_direction_scan, sigma_elevation_rad), "sigma_elevation_rad"},
    {offsetof(struct rho_message_direction_scan, sector_from_rad), "sector_from_rad"},
    {offsetof(struct rho_message_direction_scan, sector_to_rad), "sector_to_rad"},
    {offsetof(struct rho_message_direction_scan, num_directions), "num_directions"},
    {offsetof(struct rho_message_direction_scan, directions), "directions"},
};

static const struct member_name ghost_matrix_names[] = {
    {offsetof(struct rho_message_ghost_matrix, utime), "utime"},
    {offsetof(struct rho_message_ghost_matrix, scan), "scan"},
    {offsetof(struct rho_message_ghost_matrix, epoch), "epoch"},
    {offsetof(struct rho_message_ghost_matrix, sensor_a_id), "sensor_a_id"},
    {offsetof(struct rho_message_ghost_matrix, sensor_b_id), "sensor_b_id"},
    {offsetof(struct rho_message_ghost_matrix, sensor_a_x_m), "sensor_a_x_m"},
    {offsetof(struct rho_message_ghost_matrix, sensor_a_y_m), "sensor_a_y_m"},
    {offsetof(struct rho_message_ghost_matrix, sensor_b_x_m), "sensor_b_x_m"},
    {offsetof(struct rho_message_ghost_matrix, sensor_b_y_m), "sensor_b_y_m"},
    {offsetof(struct rho_message_ghost_matrix, range_max_m), "range_max_m"},
    {offsetof(struct rho_message_ghost_matrix, rule), "rule"},
    {offsetof(struct rho_message_ghost_matrix, num_rows), "num_rows"},
    {offsetof(struct rho_message_ghost_matrix, num_columns), "num_columns"},
    {offsetof(struct rho_message_ghost_matrix, not_sent), "not_sent"},
    {offsetof(struct rho_message_ghost_matrix, part), "part"},
    {offsetof(struct rho_message_ghost_matrix, num_parts), "num_parts"},
    {offsetof(struct rho_message_ghost_matrix, num_elements), "num_elements"},
    {offsetof(struct rho_message_ghost_matrix, elements), "elements"},
};

static const struct member_name hypotheses_names[] = {
    {offsetof(struct rho_message_hypotheses, utime), "utime"},
    {offsetof(struct rho_message_hypotheses, scan), "scan"},
    {offsetof(struct rho_message_hypotheses, epoch), "epoch"},
    {offsetof(struct rho_message_hypotheses, track_id), "track_id"},
    {offsetof(struct rho_message_hypotheses, score_nat), "score_nat"},
    {offsetof(struct rho_message_hypotheses, calm), "calm"},
    {offsetof(struct rho_message_hypotheses, steady), "steady"},
    {offsetof(struct rho_message_hypotheses, maneuver), "maneuver"},
    {offsetof(struct rho_message_hypotheses, evidence), "evidence"},
    {offsetof(struct rho_message_hypotheses, support), "support"},
    {offsetof(struct rho_message_hypotheses, shared), "shared"},
    {offsetof(struct rho_message_hypotheses, clutter), "clutter"},
    {offsetof(struct rho_message_hypotheses, not_sent), "not_sent"},
    {offsetof(struct rho_message_hypotheses, num_hypotheses), "num_hypotheses"},
    {offsetof(struct rho_message_hypotheses, hypotheses), "hypotheses"},
};

static const struct member_name life_names[] = {
    {offsetof(struct rho_message_life, utime), "utime"},
    {offsetof(struct rho_message_life, scan), "scan"},
    {offsetof(struct rho_message_life, epoch), "epoch"},
    {offsetof(struct rho_message_life, death_rate), "death_rate"},
    {offsetof(struct rho_message_life, hide_rate), "hide_rate"},
    {offsetof(struct rho_message_life, appear_rate), "appear_rate"},
    {offsetof(struct rho_message_life, lived_scans), "lived_scans"},
    {offsetof(struct rho_message_life, num_tracks_total), "num_tracks_total"},
    {offsetof(struct rho_message_life, part), "part"},
    {offsetof(struct rho_message_life, num_parts), "num_parts"},
    {offsetof(struct rho_message_life, num_tracks), "num_tracks"},
    {offsetof(struct rho_message_life, tracks), "tracks"},
};

static const struct member_name peak_list_names[] = {
    {offsetof(struct rho_message_peak_list, utime), "utime"},
    {offsetof(struct rho_message_peak_list, scan), "scan"},
    {offsetof(struct rho_message_peak_list, num_peaks), "num_peaks"},
    {offsetof(struct rho_message_peak_list, peaks), "peaks"},
};

static const struct member_name plane_names[] = {
    {offsetof(struct rho_message_plane, utime), "utime"},
    {offsetof(struct rho_message_plane, scan), "scan"},
    {offsetof(struct rho_message_plane, epoch), "epoch"},
    {offsetof(struct rho_message_plane, method), "method"},
    {offsetof(struct rho_message_plane, has_pair), "has_pair"},
    {offsetof(struct rho_message_plane, sensor_a_id), "sensor_a_id"},
    {offsetof(struct rho_message_plane, sensor_b_id), "sensor_b_id"},
    {offsetof(struct rho_message_plane, votes_max), "votes_max"},
    {offsetof(struct rho_message_plane, part), "part"},
    {offsetof(struct rho_message_plane, num_parts), "num_parts"},
    {offsetof(struct rho_message_plane, num_rows), "num_rows"},
    {offsetof(struct rho_message_plane, rows), "rows"},
};

static const struct member_name plot_scan_names[] = {
    {offsetof(struct rho_message_plot_scan, utime), "utime"},
    {offsetof(struct rho_message_plot_scan, scan), "scan"},
    {offsetof(struct rho_message_plot_scan, epoch), "epoch"},
    {offsetof(struct rho_message_plot_scan, sensor_id), "sensor_id"},
    {offsetof(struct rho_message_plot_scan, kind), "kind"},
    {offsetof(struct rho_message_plot_scan, part), "part"},
    {offsetof(struct rho_message_plot_scan, num_parts), "num_parts"},
    {offsetof(struct rho_message_plot_scan, sector_from_rad), "sector_from_rad"},
    {offsetof(struct rho_message_plot_scan, sector_to_rad), "sector_to_rad"},
    {offsetof(struct rho_message_plot_scan, num_plots), "num_plots"},
    {offsetof(struct rho_message_plot_scan, plots), "plots"},
};

static const struct member_name polar_scan_names[] = {
    {offsetof(struct rho_message_polar_scan, utime), "utime"},
    {offsetof(struct rho_message_polar_scan, scan), "scan"},
    {offsetof(struct rho_message_polar_scan, epoch), "epoch"},
    {offsetof(struct rho_message_polar_scan, sensor_id), "sensor_id"},
    {offsetof(struct rho_message_polar_scan, has_elevation), "has_elevation"},
    {offsetof(struct rho_message_polar_scan, has_range_rate), "has_range_rate"},
    {offsetof(struct rho_message_polar_scan, part), "part"},
    {offsetof(struct rho_message_polar_scan, num_parts), "num_parts"},
    {offsetof(struct rho_message_polar_scan, sensor_x_m), "sensor_x_m"},
    {offsetof(struct rho_message_polar_scan, sensor_y_m), "sensor_y_m"},
    {offsetof(struct rho_message_polar_scan, sensor_z_m), "sensor_z_m"},
    {offsetof(struct rho_message_polar_scan, sigma_range_m), "sigma_range_m"},
    {offsetof(struct rho_message_polar_scan, sigma_azimuth_rad), "sigma_azimuth_rad"},
    {offsetof(struct rho_message_polar_scan, sigma_elevation_rad), "sigma_elevation_rad"},
    {offsetof(struct rho_message_polar_scan, sigma_range_rate_mps), "sigma_range_rate_mps"},
    {offsetof(struct rho_message_polar_scan, sector_from_rad), "sector_from_rad"},
    {offsetof(struct rho_message_polar_scan, sector_to_rad), "sector_to_rad"},
    {offsetof(struct rho_message_polar_scan, num_polar_plots), "num_polar_plots"},
    {offsetof(struct rho_message_polar_scan, polar_plots), "polar_plots"},
};

static const struct member_name sensor_list_names[] = {
    {offsetof(struct rho_message_sensor_list, utime), "utime"},
    {offsetof(struct rho_message_sensor_list, scan), "scan"},
    {offsetof(struct rho_message_sensor_list, epoch), "epoch"},
    {offsetof(struct rho_message_sensor_list, num_sensors_total), "num_sensors_total"},
    {offsetof(struct rho_message_sensor_list, part), "part"},
    {offsetof(struct rho_message_sensor_list, num_parts), "num_parts"},
    {offsetof(struct rho_message_sensor_list, num_sensors), "num_sensors"},
    {offsetof(struct rho_message_sensor_list, sensors), "sensors"},
};

static const struct member_name track_list_names[] = {
    {offsetof(struct rho_message_track_list, utime), "utime"},
    {offsetof(struct rho_message_track_list, scan), "scan"},
    {offsetof(struct rho_message_track_list, epoch), "epoch"},
    {offsetof(struct rho_message_track_list, num_tracks_total), "num_tracks_total"},
    {offsetof(struct rho_message_track_list, part), "part"},
    {offsetof(struct rho_message_track_list, num_parts), "num_parts"},
    {offsetof(struct rho_message_track_list, num_tracks), "num_tracks"},
    {offsetof(struct rho_message_track_list, tracks), "tracks"},
};

static const struct member_name truth_list_names[] = {
    {offsetof(struct rho_message_truth_list, utime), "utime"},
    {offsetof(struct rho_message_truth_list, scan), "scan"},
    {offsetof(struct rho_message_truth_list, part), "part"},
    {offsetof(struct rho_message_truth_list, num_parts), "num_parts"},
    {offsetof(struct rho_message_truth_list, num_targets), "num_targets"},
    {offsetof(struct rho_message_truth_list, targets), "targets"},
};

static const struct member_name zone_event_list_names[] = {
    {offsetof(struct rho_message_zone_event_list, utime), "utime"},
    {offsetof(struct rho_message_zone_event_list, scan), "scan"},
    {offsetof(struct rho_message_zone_event_list, epoch), "epoch"},
    {offsetof(struct rho_message_zone_event_list, num_events), "num_events"},
    {offsetof(struct rho_message_zone_event_list, events), "events"},
};

static const struct member_name zone_list_names[] = {
    {offsetof(struct rho_message_zone_list, utime), "utime"},
    {offsetof(struct rho_message_zone_list, scan), "scan"},
    {offsetof(struct rho_message_zone_list, epoch), "epoch"},
    {offsetof(struct rho_message_zone_list, events_dropped), "events_dropped"},
    {offsetof(struct rho_message_zone_list, num_zones), "num_zones"},
    {offsetof(struct rho_message_zone_list, zones), "zones"},
};

const char *rho_message_type_name(enum rho_message_type type)
{
    static const char type_names[RHO_NUM_MESSAGE_TYPES][19] = {
        "accumulator_cell_t",
        "body_t",
        "command_answer_t",
        "command_t",
        "direction_t",
        "echo_t",
        "ghost_t",
        "hypothesis_t",
        "learned_t",
        "peak_t",
        "plane_row_t",
        "plot_t",
        "polar_plot_t",
        "sensor_t",
        "setting_answer_t",
        "setting_t",
        "status_t",
        "track_life_t",
        "track_t",
        "truth_t",
        "work_t",
        "zone_event_t",
        "zone_t",
        "accumulator_t",
        "bearing_scan_t",
        "body_list_t",
        "clutter_map_t",
        "direction_scan_t",
        "ghost_matrix_t",
        "hypotheses_t",
        "life_t",
        "peak_list_t",
        "plane_t",
        "plot_scan_t",
        "polar_scan_t",
        "sensor_list_t",
        "track_list_t",
        "truth_list_t",
        "zone_event_list_t",
        "zone_list_t",
    };

    return (unsigned)type < RHO_NUM_MESSAGE_TYPES ? type_names[type] : "unknown";
}

const char *rho_message_accumulator_cell_field(const struct rho_message_place *place)
{
    return place ? find_member_name(accumulator_cell_names, 6, place->offset) : "unknown";
}

const char *rho_message_body_field(const struct rho_message_place *place)
{
    return place ? find_member_name(body_names, 14, place->offset) : "unknown";
}

const char *rho_message_command_answer_field(const struct rho_message_place *place)
{
    return place ? find_member_name(command_answer_names, 7, place->offset) : "unknown";
}

const char *rho_message_command_field(const struct rho_message_place *place)
{
    return place ? find_member_name(command_names, 13, place->offset) : "unknown";
}

const char *rho_message_direction_field(const struct rho_message_place *place)
{
    return place ? find_member_name(direction_names, 5, place->offset) : "unknown";
}

const char *rho_message_echo_field(const struct rho_message_place *place)
{
    return place ? find_member_name(echo_names, 10, place->offset) : "unknown";
}

const char *rho_message_ghost_field(const struct rho_message_place *place)
{
    return place ? find_member_name(ghost_names, 6, place->offset) : "unknown";
}

const char *rho_message_hypothesis_field(const struct rho_message_place *place)
{
    return place ? find_member_name(hypothesis_names, 7, place->offset) : "unknown";
}

const char *rho_message_learned_field(const struct rho_message_place *place)
{
    return place ? find_member_name(learned_names, 11, place->offset) : "unknown";
}

const char *rho_message_peak_field(const struct rho_message_place *place)
{
    return place ? find_member_name(peak_names, 6, place->offset) : "unknown";
}

const char *rho_message_plane_row_field(const struct rho_message_place *place)
{
    return place ? find_member_name(plane_row_names, 1, place->offset) : "unknown";
}

const char *rho_message_plot_field(const struct rho_message_place *place)
{
    return place ? find_member_name(plot_names, 10, place->offset) : "unknown";
}

const char *rho_message_polar_plot_field(const struct rho_message_place *place)
{
    return place ? find_member_name(polar_plot_names, 6, place->offset) : "unknown";
}

const char *rho_message_sensor_field(const struct rho_message_place *place)
{
    return place ? find_member_name(sensor_names, 13, place->offset) : "unknown";
}

const char *rho_message_setting_answer_field(const struct rho_message_place *place)
{
    return place ? find_member_name(setting_answer_names, 11, place->offset) : "unknown";
}

const char *rho_message_setting_field(const struct rho_message_place *place)
{
    return place ? find_member_name(setting_names, 4, place->offset) : "unknown";
}

const char *rho_message_status_field(const struct rho_message_place *place)
{
    return place ? find_member_name(status_names, 35, place->offset) : "unknown";
}

const char *rho_message_track_life_field(const struct rho_message_place *place)
{
    return place ? find_member_name(track_life_names, 3, place->offset) : "unknown";
}

const char *rho_message_track_field(const struct rho_message_place *place)
{
    return place ? find_member_name(track_names, 19, place->offset) : "unknown";
}

const char *rho_message_truth_field(const struct rho_message_place *place)
{
    return place ? find_member_name(truth_names, 7, place->offset) : "unknown";
}

const char *rho_message_work_field(const struct rho_message_place *place)
{
    return place ? find_member_name(work_names, 11, place->offset) : "unknown";
}

const char *rho_message_zone_event_field(const struct rho_message_place *place)
{
    return place ? find_member_name(zone_event_names, 6, place->offset) : "unknown";
}

const char *rho_message_zone_field(const struct rho_message_place *place)
{
    return place ? find_member_name(zone_names, 12, place->offset) : "unknown";
}

const char *rho_message_accumulator_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(accumulator_cell_names, 6, place->offset);
    }
    return place ? find_member_name(accumulator_names, 21, place->offset) : "unknown";
}

const char *rho_message_bearing_scan_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return "bearing_rad";
    }
    return place ? find_member_name(bearing_scan_names, 9, place->offset) : "unknown";
}

const char *rho_message_body_list_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(body_names, 14, place->offset);
    }
    return place ? find_member_name(body_list_names, 7, place->offset) : "unknown";
}

const char *rho_message_clutter_map_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(echo_names, 10, place->offset);
    }
    return place ? find_member_name(clutter_map_names, 8, place->offset) : "unknown";
}

const char *rho_message_direction_scan_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(direction_names, 5, place->offset);
    }
    return place ? find_member_name(direction_scan_names, 13, place->offset) : "unknown";
}

const char *rho_message_ghost_matrix_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(ghost_names, 6, place->offset);
    }
    return place ? find_member_name(ghost_matrix_names, 18, place->offset) : "unknown";
}

const char *rho_message_hypotheses_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(hypothesis_names, 7, place->offset);
    }
    return place ? find_member_name(hypotheses_names, 15, place->offset) : "unknown";
}

const char *rho_message_life_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(track_life_names, 3, place->offset);
    }
    return place ? find_member_name(life_names, 12, place->offset) : "unknown";
}

const char *rho_message_peak_list_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(peak_names, 6, place->offset);
    }
    return place ? find_member_name(peak_list_names, 4, place->offset) : "unknown";
}

const char *rho_message_plane_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(plane_row_names, 1, place->offset);
    }
    return place ? find_member_name(plane_names, 12, place->offset) : "unknown";
}

const char *rho_message_plot_scan_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(plot_names, 10, place->offset);
    }
    return place ? find_member_name(plot_scan_names, 11, place->offset) : "unknown";
}

const char *rho_message_polar_scan_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(polar_plot_names, 6, place->offset);
    }
    return place ? find_member_name(polar_scan_names, 19, place->offset) : "unknown";
}

const char *rho_message_sensor_list_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(sensor_names, 13, place->offset);
    }
    return place ? find_member_name(sensor_list_names, 8, place->offset) : "unknown";
}

const char *rho_message_track_list_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(track_names, 19, place->offset);
    }
    return place ? find_member_name(track_list_names, 8, place->offset) : "unknown";
}

const char *rho_message_truth_list_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(truth_names, 7, place->offset);
    }
    return place ? find_member_name(truth_list_names, 6, place->offset) : "unknown";
}

const char *rho_message_zone_event_list_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(zone_event_names, 6, place->offset);
    }
    return place ? find_member_name(zone_event_list_names, 5, place->offset) : "unknown";
}

const char *rho_message_zone_list_field(const struct rho_message_place *place)
{
    if (place && place->element >= 0) {
        return find_member_name(zone_names, 12, place->offset);
    }
    return place ? find_member_name(zone_list_names, 6, place->offset) : "unknown";
}
