/* SPDX-License-Identifier: MIT */
/* Made by make_message_table.py from lcm_types/. */
/*
 * Included once for each family of structs: MESSAGE_TABLE(name) names a table, MESSAGE_STRUCT(s)
 * the C type of struct s, MESSAGE_HEAD(s, m) is the offset of a member in the struct of the members
 * before the list, MESSAGE_LIST_IS_POINTER whether the struct holds a pointer to its list. The
 * tables' own types stand in tests/unit/wire/message_shape.h.
 */
#ifndef RHOTRACK_TEST_MESSAGE_TABLE
#define RHOTRACK_TEST_MESSAGE_TABLE
#define MESSAGES_WITHOUT_LIST(X) X(accumulator_cell, ACCUMULATOR_CELL) X(body, BODY) X(command_answer, COMMAND_ANSWER) X(command, COMMAND) X(direction, DIRECTION) X(echo, ECHO) X(ghost, GHOST) X(hypothesis, HYPOTHESIS) X(learned, LEARNED) X(peak, PEAK) X(plane_row, PLANE_ROW) X(plot, PLOT) X(polar_plot, POLAR_PLOT) X(sensor, SENSOR) X(setting_answer, SETTING_ANSWER) X(setting, SETTING) X(status, STATUS) X(track_life, TRACK_LIFE) X(track, TRACK) X(truth, TRUTH) X(work, WORK) X(zone_event, ZONE_EVENT) X(zone, ZONE)
#define MESSAGES_WITH_LIST(X) X(accumulator, ACCUMULATOR, "RHO_ACCUMULATOR") X(bearing_scan, BEARING_SCAN, "RHO_BEARINGS_") X(body_list, BODY_LIST, "RHO_BODIES") X(clutter_map, CLUTTER_MAP, "RHO_CLUTTER") X(direction_scan, DIRECTION_SCAN, "RHO_DIRECTIONS_") X(ghost_matrix, GHOST_MATRIX, "RHO_GHOSTS") X(hypotheses, HYPOTHESES, "RHO_HYPOTHESES") X(life, LIFE, "RHO_LIFE") X(peak_list, PEAK_LIST, "RHO_PEAKS") X(plane, PLANE, "RHO_PLANE") X(plot_scan, PLOT_SCAN, "RHO_PLOTS_") X(polar_scan, POLAR_SCAN, "RHO_POLAR_") X(sensor_list, SENSOR_LIST, "RHO_SENSORS") X(track_list, TRACK_LIST, "RHO_TRACKS") X(truth_list, TRUTH_LIST, "RHO_TRUTH") X(zone_event_list, ZONE_EVENT_LIST, "RHO_ZONE_EVENTS") X(zone_list, ZONE_LIST, "RHO_ZONES")
#endif

static const struct message_member MESSAGE_TABLE(accumulator_cell)[] = {
    {"rho_m", offsetof(MESSAGE_STRUCT(accumulator_cell), rho_m), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"theta_rad", offsetof(MESSAGE_STRUCT(accumulator_cell), theta_rad), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(6.3)},
    {"votes", offsetof(MESSAGE_STRUCT(accumulator_cell), votes), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e9)},
    {"scan_mask", offsetof(MESSAGE_STRUCT(accumulator_cell), scan_mask), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(65535)},
    {"plots", offsetof(MESSAGE_STRUCT(accumulator_cell), plots), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"track_id", offsetof(MESSAGE_STRUCT(accumulator_cell), track_id), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
};

static const struct message_member MESSAGE_TABLE(body)[] = {
    {"track_id", offsetof(MESSAGE_STRUCT(body), track_id), 0, 4, 1, .rule = MEMBER_ANY},
    {"x_m", offsetof(MESSAGE_STRUCT(body), x_m), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"y_m", offsetof(MESSAGE_STRUCT(body), y_m), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"reference_x_m", offsetof(MESSAGE_STRUCT(body), reference_x_m), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"reference_y_m", offsetof(MESSAGE_STRUCT(body), reference_y_m), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"length_m", offsetof(MESSAGE_STRUCT(body), length_m), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e5)},
    {"width_m", offsetof(MESSAGE_STRUCT(body), width_m), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e5)},
    {"heading_rad", offsetof(MESSAGE_STRUCT(body), heading_rad), 0, 4, 1, .is_float = true, .low = (float)(-4), .high = (float)(4)},
    {"sigma_length_m", offsetof(MESSAGE_STRUCT(body), sigma_length_m), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e5)},
    {"sigma_width_m", offsetof(MESSAGE_STRUCT(body), sigma_width_m), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e5)},
    {"sigma_heading_rad", offsetof(MESSAGE_STRUCT(body), sigma_heading_rad), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(10)},
    {"sigma_along_m", offsetof(MESSAGE_STRUCT(body), sigma_along_m), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e5)},
    {"sigma_across_m", offsetof(MESSAGE_STRUCT(body), sigma_across_m), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e5)},
    {"plots", offsetof(MESSAGE_STRUCT(body), plots), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e9)},
};

static const struct message_member MESSAGE_TABLE(command_answer)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(command_answer), utime), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(command_answer), scan), 0, 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(command_answer), epoch), 0, 4, 1, .rule = MEMBER_ANY},
    {"number", offsetof(MESSAGE_STRUCT(command_answer), number), 0, 4, 1, .rule = MEMBER_ANY},
    {"action", offsetof(MESSAGE_STRUCT(command_answer), action), 0, 1, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(127)},
    {"status", offsetof(MESSAGE_STRUCT(command_answer), status), 0, 1, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(127)},
    {"track_id", offsetof(MESSAGE_STRUCT(command_answer), track_id), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
};

static const struct message_member MESSAGE_TABLE(command)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(command), utime), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"number", offsetof(MESSAGE_STRUCT(command), number), 0, 4, 1, .rule = MEMBER_ANY},
    {"action", offsetof(MESSAGE_STRUCT(command), action), 0, 1, 1, .rule = MEMBER_ONE_OF, .choices = {1, 2, 3, 4, 5, 6, 7}, .num_choices = 7},
    {"track_id", offsetof(MESSAGE_STRUCT(command), track_id), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"new_id", offsetof(MESSAGE_STRUCT(command), new_id), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"x_m", offsetof(MESSAGE_STRUCT(command), x_m), 0, 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"y_m", offsetof(MESSAGE_STRUCT(command), y_m), 0, 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"x_max_m", offsetof(MESSAGE_STRUCT(command), x_max_m), 0, 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"y_max_m", offsetof(MESSAGE_STRUCT(command), y_max_m), 0, 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"sigma_m", offsetof(MESSAGE_STRUCT(command), sigma_m), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e5)},
    {"vx_mps", offsetof(MESSAGE_STRUCT(command), vx_mps), 0, 4, 1, .is_float = true, .low = (float)(-2e4), .high = (float)(2e4)},
    {"vy_mps", offsetof(MESSAGE_STRUCT(command), vy_mps), 0, 4, 1, .is_float = true, .low = (float)(-2e4), .high = (float)(2e4)},
    {"sigma_mps", offsetof(MESSAGE_STRUCT(command), sigma_mps), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e5)},
};

static const struct message_member MESSAGE_TABLE(direction)[] = {
    {"dt_us", offsetof(MESSAGE_STRUCT(direction), dt_us), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(-60000000), .max = INT64_C(60000000)},
    {"bearing_rad", offsetof(MESSAGE_STRUCT(direction), bearing_rad), 0, 4, 1, .is_float = true, .low = (float)(-3.1415927), .high = (float)(3.1415927)},
    {"elevation_rad", offsetof(MESSAGE_STRUCT(direction), elevation_rad), 0, 4, 1, .is_float = true, .low = (float)(-1.5707964), .high = (float)(1.5707964)},
    {"snr_db", offsetof(MESSAGE_STRUCT(direction), snr_db), 0, 4, 1, .is_float = true, .low = (float)(-1000), .high = (float)(1000)},
    {"has_elevation", offsetof(MESSAGE_STRUCT(direction), has_elevation), 0, 1, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(1)},
};

static const struct message_member MESSAGE_TABLE(echo)[] = {
    {"sensor_id", offsetof(MESSAGE_STRUCT(echo), sensor_id), 0, 2, 1, .rule = MEMBER_ANY},
    {"hits", offsetof(MESSAGE_STRUCT(echo), hits), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(32767)},
    {"unseen", offsetof(MESSAGE_STRUCT(echo), unseen), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"x_m", offsetof(MESSAGE_STRUCT(echo), x_m), 0, 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"y_m", offsetof(MESSAGE_STRUCT(echo), y_m), 0, 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"vx_mps", offsetof(MESSAGE_STRUCT(echo), vx_mps), 0, 4, 1, .is_float = true, .low = (float)(-2e4), .high = (float)(2e4)},
    {"vy_mps", offsetof(MESSAGE_STRUCT(echo), vy_mps), 0, 4, 1, .is_float = true, .low = (float)(-2e4), .high = (float)(2e4)},
    {"sigma_range_m", offsetof(MESSAGE_STRUCT(echo), sigma_range_m), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e6)},
    {"sigma_cross_m", offsetof(MESSAGE_STRUCT(echo), sigma_cross_m), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e6)},
    {"chance", offsetof(MESSAGE_STRUCT(echo), chance), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
};

static const struct message_member MESSAGE_TABLE(ghost)[] = {
    {"row", offsetof(MESSAGE_STRUCT(ghost), row), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"column", offsetof(MESSAGE_STRUCT(ghost), column), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"reason", offsetof(MESSAGE_STRUCT(ghost), reason), 0, 1, 1, .rule = MEMBER_ONE_OF, .choices = {0, 1, 2, 3, 4, 5, 6}, .num_choices = 7},
    {"delta_rad", offsetof(MESSAGE_STRUCT(ghost), delta_rad), 0, 4, 1, .is_float = true, .low = (float)(-3.15), .high = (float)(3.15)},
    {"x_m", offsetof(MESSAGE_STRUCT(ghost), x_m), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"y_m", offsetof(MESSAGE_STRUCT(ghost), y_m), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
};

static const struct message_member MESSAGE_TABLE(hypothesis)[] = {
    {"share", offsetof(MESSAGE_STRUCT(hypothesis), share), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"x_m", offsetof(MESSAGE_STRUCT(hypothesis), x_m), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"y_m", offsetof(MESSAGE_STRUCT(hypothesis), y_m), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"vx_mps", offsetof(MESSAGE_STRUCT(hypothesis), vx_mps), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"vy_mps", offsetof(MESSAGE_STRUCT(hypothesis), vy_mps), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"maneuver_probability", offsetof(MESSAGE_STRUCT(hypothesis), maneuver_probability), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"plots", offsetof(MESSAGE_STRUCT(hypothesis), plots), 0, 2, 3, .rule = MEMBER_ANY},
};

static const struct message_member MESSAGE_TABLE(learned)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(learned), utime), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(learned), scan), 0, 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(learned), epoch), 0, 4, 1, .rule = MEMBER_ANY},
    {"sensor_id", offsetof(MESSAGE_STRUCT(learned), sensor_id), 0, 2, 1, .rule = MEMBER_ANY},
    {"innovations", offsetof(MESSAGE_STRUCT(learned), innovations), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"sigma_range_factor", offsetof(MESSAGE_STRUCT(learned), sigma_range_factor), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(100)},
    {"sigma_cross_factor", offsetof(MESSAGE_STRUCT(learned), sigma_cross_factor), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(100)},
    {"looks", offsetof(MESSAGE_STRUCT(learned), looks), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"range_max_m", offsetof(MESSAGE_STRUCT(learned), range_max_m), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e9)},
    {"pd_stated", offsetof(MESSAGE_STRUCT(learned), pd_stated), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"pd", offsetof(MESSAGE_STRUCT(learned), pd), 0, 4, 6, .is_float = true, .low = (float)(0), .high = (float)(1)},
};

static const struct message_member MESSAGE_TABLE(peak)[] = {
    {"rho_m", offsetof(MESSAGE_STRUCT(peak), rho_m), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"theta_rad", offsetof(MESSAGE_STRUCT(peak), theta_rad), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(3.1415927)},
    {"speed_mps", offsetof(MESSAGE_STRUCT(peak), speed_mps), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e6)},
    {"score_nat", offsetof(MESSAGE_STRUCT(peak), score_nat), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"scans_hit", offsetof(MESSAGE_STRUCT(peak), scans_hit), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"sensor_pairs", offsetof(MESSAGE_STRUCT(peak), sensor_pairs), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
};

static const struct message_member MESSAGE_TABLE(plane_row)[] = {
    {"votes", offsetof(MESSAGE_STRUCT(plane_row), votes), 0, 1, 64, .rule = MEMBER_ANY},
};

static const struct message_member MESSAGE_TABLE(plot)[] = {
    {"dt_us", offsetof(MESSAGE_STRUCT(plot), dt_us), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(-60000000), .max = INT64_C(60000000)},
    {"x_m", offsetof(MESSAGE_STRUCT(plot), x_m), 0, 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"y_m", offsetof(MESSAGE_STRUCT(plot), y_m), 0, 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"z_m", offsetof(MESSAGE_STRUCT(plot), z_m), 0, 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"vx_mps", offsetof(MESSAGE_STRUCT(plot), vx_mps), 0, 4, 1, .is_float = true, .low = (float)(-2e4), .high = (float)(2e4)},
    {"vy_mps", offsetof(MESSAGE_STRUCT(plot), vy_mps), 0, 4, 1, .is_float = true, .low = (float)(-2e4), .high = (float)(2e4)},
    {"vz_mps", offsetof(MESSAGE_STRUCT(plot), vz_mps), 0, 4, 1, .is_float = true, .low = (float)(-2e4), .high = (float)(2e4)},
    {"sigma_m", offsetof(MESSAGE_STRUCT(plot), sigma_m), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e5)},
    {"sigma_mps", offsetof(MESSAGE_STRUCT(plot), sigma_mps), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e5)},
    {"snr_db", offsetof(MESSAGE_STRUCT(plot), snr_db), 0, 4, 1, .is_float = true, .low = (float)(-1000), .high = (float)(1000)},
};

static const struct message_member MESSAGE_TABLE(polar_plot)[] = {
    {"dt_us", offsetof(MESSAGE_STRUCT(polar_plot), dt_us), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(-60000000), .max = INT64_C(60000000)},
    {"range_m", offsetof(MESSAGE_STRUCT(polar_plot), range_m), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(2e6)},
    {"azimuth_rad", offsetof(MESSAGE_STRUCT(polar_plot), azimuth_rad), 0, 4, 1, .is_float = true, .low = (float)(-3.1415927), .high = (float)(3.1415927)},
    {"elevation_rad", offsetof(MESSAGE_STRUCT(polar_plot), elevation_rad), 0, 4, 1, .is_float = true, .low = (float)(-1.5707964), .high = (float)(1.5707964)},
    {"range_rate_mps", offsetof(MESSAGE_STRUCT(polar_plot), range_rate_mps), 0, 4, 1, .is_float = true, .low = (float)(-2e4), .high = (float)(2e4)},
    {"snr_db", offsetof(MESSAGE_STRUCT(polar_plot), snr_db), 0, 4, 1, .is_float = true, .low = (float)(-1000), .high = (float)(1000)},
};

static const struct message_member MESSAGE_TABLE(sensor)[] = {
    {"sensor_id", offsetof(MESSAGE_STRUCT(sensor), sensor_id), 0, 2, 1, .rule = MEMBER_ANY},
    {"kind", offsetof(MESSAGE_STRUCT(sensor), kind), 0, 1, 1, .rule = MEMBER_ONE_OF, .choices = {1, 2, 3}, .num_choices = 3},
    {"is_silent", offsetof(MESSAGE_STRUCT(sensor), is_silent), 0, 1, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(1)},
    {"is_off_clock", offsetof(MESSAGE_STRUCT(sensor), is_off_clock), 0, 1, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(1)},
    {"is_doubted", offsetof(MESSAGE_STRUCT(sensor), is_doubted), 0, 1, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(1)},
    {"scans", offsetof(MESSAGE_STRUCT(sensor), scans), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"scan_utime", offsetof(MESSAGE_STRUCT(sensor), scan_utime), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"heard_age_us", offsetof(MESSAGE_STRUCT(sensor), heard_age_us), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"interval_us", offsetof(MESSAGE_STRUCT(sensor), interval_us), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"watched", offsetof(MESSAGE_STRUCT(sensor), watched), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"watched_hits", offsetof(MESSAGE_STRUCT(sensor), watched_hits), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"seen_share", offsetof(MESSAGE_STRUCT(sensor), seen_share), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"innovation_factor", offsetof(MESSAGE_STRUCT(sensor), innovation_factor), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e12)},
};

static const struct message_member MESSAGE_TABLE(setting_answer)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(setting_answer), utime), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(setting_answer), scan), 0, 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(setting_answer), epoch), 0, 4, 1, .rule = MEMBER_ANY},
    {"number", offsetof(MESSAGE_STRUCT(setting_answer), number), 0, 4, 1, .rule = MEMBER_ANY},
    {"field", offsetof(MESSAGE_STRUCT(setting_answer), field), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"status", offsetof(MESSAGE_STRUCT(setting_answer), status), 0, 1, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(127)},
    {"applies", offsetof(MESSAGE_STRUCT(setting_answer), applies), 0, 1, 1, .rule = MEMBER_ONE_OF, .choices = {0, 1, 2, 3, 4}, .num_choices = 5},
    {"fault_field", offsetof(MESSAGE_STRUCT(setting_answer), fault_field), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"value", offsetof(MESSAGE_STRUCT(setting_answer), value), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"min", offsetof(MESSAGE_STRUCT(setting_answer), min), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"max", offsetof(MESSAGE_STRUCT(setting_answer), max), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
};

static const struct message_member MESSAGE_TABLE(setting)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(setting), utime), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"number", offsetof(MESSAGE_STRUCT(setting), number), 0, 4, 1, .rule = MEMBER_ANY},
    {"field", offsetof(MESSAGE_STRUCT(setting), field), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(18)},
    {"value", offsetof(MESSAGE_STRUCT(setting), value), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
};

static const struct message_member MESSAGE_TABLE(status)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(status), utime), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(status), scan), 0, 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(status), epoch), 0, 4, 1, .rule = MEMBER_ANY},
    {"scans_accepted", offsetof(MESSAGE_STRUCT(status), scans_accepted), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"scans_late", offsetof(MESSAGE_STRUCT(status), scans_late), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"scans_duplicate", offsetof(MESSAGE_STRUCT(status), scans_duplicate), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"scans_lost", offsetof(MESSAGE_STRUCT(status), scans_lost), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"scans_bad", offsetof(MESSAGE_STRUCT(status), scans_bad), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"messages_bad", offsetof(MESSAGE_STRUCT(status), messages_bad), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"messages_wrong_type", offsetof(MESSAGE_STRUCT(status), messages_wrong_type), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"messages_flooded", offsetof(MESSAGE_STRUCT(status), messages_flooded), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"frames_incomplete", offsetof(MESSAGE_STRUCT(status), frames_incomplete), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"scans_incomplete", offsetof(MESSAGE_STRUCT(status), scans_incomplete), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"fragments_refused", offsetof(MESSAGE_STRUCT(status), fragments_refused), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"clock_jumps", offsetof(MESSAGE_STRUCT(status), clock_jumps), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"sensor_restarts", offsetof(MESSAGE_STRUCT(status), sensor_restarts), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"plots_in", offsetof(MESSAGE_STRUCT(status), plots_in), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"plots_claimed", offsetof(MESSAGE_STRUCT(status), plots_claimed), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"plots_held", offsetof(MESSAGE_STRUCT(status), plots_held), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"plots_initiated", offsetof(MESSAGE_STRUCT(status), plots_initiated), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"plots_clutter", offsetof(MESSAGE_STRUCT(status), plots_clutter), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"inputs_stale", offsetof(MESSAGE_STRUCT(status), inputs_stale), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"inputs_invalid", offsetof(MESSAGE_STRUCT(status), inputs_invalid), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"inputs_no_room", offsetof(MESSAGE_STRUCT(status), inputs_no_room), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"bearings_in", offsetof(MESSAGE_STRUCT(status), bearings_in), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"ghosts_pruned", offsetof(MESSAGE_STRUCT(status), ghosts_pruned), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"tracks_tentative", offsetof(MESSAGE_STRUCT(status), tracks_tentative), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"tracks_confirmed", offsetof(MESSAGE_STRUCT(status), tracks_confirmed), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"tracks_coasting", offsetof(MESSAGE_STRUCT(status), tracks_coasting), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"step_us", offsetof(MESSAGE_STRUCT(status), step_us), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e12)},
    {"step_max_us", offsetof(MESSAGE_STRUCT(status), step_max_us), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e12)},
    {"clutter_per_km2", offsetof(MESSAGE_STRUCT(status), clutter_per_km2), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e12)},
    {"origin_lat_1e7deg", offsetof(MESSAGE_STRUCT(status), origin_lat_1e7deg), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(-900000000), .max = INT64_C(900000000)},
    {"origin_lon_1e7deg", offsetof(MESSAGE_STRUCT(status), origin_lon_1e7deg), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(-1800000000), .max = INT64_C(1800000000)},
    {"origin_alt_mm", offsetof(MESSAGE_STRUCT(status), origin_alt_mm), 0, 4, 1, .rule = MEMBER_ANY},
};

static const struct message_member MESSAGE_TABLE(track_life)[] = {
    {"track_id", offsetof(MESSAGE_STRUCT(track_life), track_id), 0, 4, 1, .rule = MEMBER_ANY},
    {"existence", offsetof(MESSAGE_STRUCT(track_life), existence), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"visibility", offsetof(MESSAGE_STRUCT(track_life), visibility), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
};

static const struct message_member MESSAGE_TABLE(track)[] = {
    {"track_id", offsetof(MESSAGE_STRUCT(track), track_id), 0, 4, 1, .rule = MEMBER_ANY},
    {"status", offsetof(MESSAGE_STRUCT(track), status), 0, 1, 1, .rule = MEMBER_ONE_OF, .choices = {1, 2, 3, 4}, .num_choices = 4},
    {"hits", offsetof(MESSAGE_STRUCT(track), hits), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"misses", offsetof(MESSAGE_STRUCT(track), misses), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"sensor_id", offsetof(MESSAGE_STRUCT(track), sensor_id), 0, 2, 1, .rule = MEMBER_ANY},
    {"plot", offsetof(MESSAGE_STRUCT(track), plot), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(-1), .max = INT64_C(32767)},
    {"update_age_us", offsetof(MESSAGE_STRUCT(track), update_age_us), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"x_m", offsetof(MESSAGE_STRUCT(track), x_m), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"y_m", offsetof(MESSAGE_STRUCT(track), y_m), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"z_m", offsetof(MESSAGE_STRUCT(track), z_m), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"vx_mps", offsetof(MESSAGE_STRUCT(track), vx_mps), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"vy_mps", offsetof(MESSAGE_STRUCT(track), vy_mps), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"vz_mps", offsetof(MESSAGE_STRUCT(track), vz_mps), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"ax_mps2", offsetof(MESSAGE_STRUCT(track), ax_mps2), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"ay_mps2", offsetof(MESSAGE_STRUCT(track), ay_mps2), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"az_mps2", offsetof(MESSAGE_STRUCT(track), az_mps2), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"score_nat", offsetof(MESSAGE_STRUCT(track), score_nat), 0, 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"maneuver_probability", offsetof(MESSAGE_STRUCT(track), maneuver_probability), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"covariance", offsetof(MESSAGE_STRUCT(track), covariance), 0, 4, 21, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
};

static const struct message_member MESSAGE_TABLE(truth)[] = {
    {"target_id", offsetof(MESSAGE_STRUCT(truth), target_id), 0, 4, 1, .rule = MEMBER_ANY},
    {"x_m", offsetof(MESSAGE_STRUCT(truth), x_m), 0, 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"y_m", offsetof(MESSAGE_STRUCT(truth), y_m), 0, 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"z_m", offsetof(MESSAGE_STRUCT(truth), z_m), 0, 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"vx_mps", offsetof(MESSAGE_STRUCT(truth), vx_mps), 0, 4, 1, .is_float = true, .low = (float)(-2e4), .high = (float)(2e4)},
    {"vy_mps", offsetof(MESSAGE_STRUCT(truth), vy_mps), 0, 4, 1, .is_float = true, .low = (float)(-2e4), .high = (float)(2e4)},
    {"vz_mps", offsetof(MESSAGE_STRUCT(truth), vz_mps), 0, 4, 1, .is_float = true, .low = (float)(-2e4), .high = (float)(2e4)},
};

static const struct message_member MESSAGE_TABLE(work)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(work), utime), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(work), scan), 0, 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(work), epoch), 0, 4, 1, .rule = MEMBER_ANY},
    {"num_steps", offsetof(MESSAGE_STRUCT(work), num_steps), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(9223372036854775807)},
    {"work_max", offsetof(MESSAGE_STRUCT(work), work_max), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(9223372036854775807)},
    {"work", offsetof(MESSAGE_STRUCT(work), work), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(9223372036854775807)},
    {"work_worst", offsetof(MESSAGE_STRUCT(work), work_worst), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(9223372036854775807)},
    {"partial_steps", offsetof(MESSAGE_STRUCT(work), partial_steps), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(9223372036854775807)},
    {"plots_not_tried", offsetof(MESSAGE_STRUCT(work), plots_not_tried), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(9223372036854775807)},
    {"reports_not_printed", offsetof(MESSAGE_STRUCT(work), reports_not_printed), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(9223372036854775807)},
    {"events_not_logged", offsetof(MESSAGE_STRUCT(work), events_not_logged), 0, 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(9223372036854775807)},
};

static const struct message_member MESSAGE_TABLE(zone_event)[] = {
    {"zone_id", offsetof(MESSAGE_STRUCT(zone_event), zone_id), 0, 4, 1, .rule = MEMBER_ANY},
    {"track_id", offsetof(MESSAGE_STRUCT(zone_event), track_id), 0, 4, 1, .rule = MEMBER_ANY},
    {"change", offsetof(MESSAGE_STRUCT(zone_event), change), 0, 1, 1, .rule = MEMBER_ONE_OF, .choices = {0, 1, 2}, .num_choices = 3},
    {"direction", offsetof(MESSAGE_STRUCT(zone_event), direction), 0, 1, 1, .rule = MEMBER_RANGE, .min = INT64_C(-1), .max = INT64_C(1)},
    {"speed_mps", offsetof(MESSAGE_STRUCT(zone_event), speed_mps), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e6)},
    {"dwell_s", offsetof(MESSAGE_STRUCT(zone_event), dwell_s), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e9)},
};

static const struct message_member MESSAGE_TABLE(zone)[] = {
    {"zone_id", offsetof(MESSAGE_STRUCT(zone), zone_id), 0, 4, 1, .rule = MEMBER_ANY},
    {"inside", offsetof(MESSAGE_STRUCT(zone), inside), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"queued", offsetof(MESSAGE_STRUCT(zone), queued), 0, 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"entered", offsetof(MESSAGE_STRUCT(zone), entered), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"left", offsetof(MESSAGE_STRUCT(zone), left), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"ended", offsetof(MESSAGE_STRUCT(zone), ended), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"along", offsetof(MESSAGE_STRUCT(zone), along), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"against", offsetof(MESSAGE_STRUCT(zone), against), 0, 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"speed_mps", offsetof(MESSAGE_STRUCT(zone), speed_mps), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e6)},
    {"queue_m", offsetof(MESSAGE_STRUCT(zone), queue_m), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e9)},
    {"dwell_mean_s", offsetof(MESSAGE_STRUCT(zone), dwell_mean_s), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e9)},
    {"dwell_max_s", offsetof(MESSAGE_STRUCT(zone), dwell_max_s), 0, 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e9)},
};

static const struct message_member MESSAGE_TABLE(accumulator)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(accumulator), utime), MESSAGE_HEAD(accumulator, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(accumulator), scan), MESSAGE_HEAD(accumulator, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(accumulator), epoch), MESSAGE_HEAD(accumulator, epoch), 4, 1, .rule = MEMBER_ANY},
    {"method", offsetof(MESSAGE_STRUCT(accumulator), method), MESSAGE_HEAD(accumulator, method), 1, 1, .rule = MEMBER_ONE_OF, .choices = {1, 2, 3, 4, 5}, .num_choices = 5},
    {"has_pair", offsetof(MESSAGE_STRUCT(accumulator), has_pair), MESSAGE_HEAD(accumulator, has_pair), 1, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(1)},
    {"sensor_a_id", offsetof(MESSAGE_STRUCT(accumulator), sensor_a_id), MESSAGE_HEAD(accumulator, sensor_a_id), 2, 1, .rule = MEMBER_ANY},
    {"sensor_b_id", offsetof(MESSAGE_STRUCT(accumulator), sensor_b_id), MESSAGE_HEAD(accumulator, sensor_b_id), 2, 1, .rule = MEMBER_ANY},
    {"num_scans", offsetof(MESSAGE_STRUCT(accumulator), num_scans), MESSAGE_HEAD(accumulator, num_scans), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(16)},
    {"oldest_utime", offsetof(MESSAGE_STRUCT(accumulator), oldest_utime), MESSAGE_HEAD(accumulator, oldest_utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"origin_x_m", offsetof(MESSAGE_STRUCT(accumulator), origin_x_m), MESSAGE_HEAD(accumulator, origin_x_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"origin_y_m", offsetof(MESSAGE_STRUCT(accumulator), origin_y_m), MESSAGE_HEAD(accumulator, origin_y_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"rho_min_m", offsetof(MESSAGE_STRUCT(accumulator), rho_min_m), MESSAGE_HEAD(accumulator, rho_min_m), 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"rho_max_m", offsetof(MESSAGE_STRUCT(accumulator), rho_max_m), MESSAGE_HEAD(accumulator, rho_max_m), 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"rho_cells", offsetof(MESSAGE_STRUCT(accumulator), rho_cells), MESSAGE_HEAD(accumulator, rho_cells), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(32767)},
    {"theta_cells", offsetof(MESSAGE_STRUCT(accumulator), theta_cells), MESSAGE_HEAD(accumulator, theta_cells), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(32767)},
    {"votes_max", offsetof(MESSAGE_STRUCT(accumulator), votes_max), MESSAGE_HEAD(accumulator, votes_max), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e9)},
    {"votes_min", offsetof(MESSAGE_STRUCT(accumulator), votes_min), MESSAGE_HEAD(accumulator, votes_min), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e9)},
    {"not_sent", offsetof(MESSAGE_STRUCT(accumulator), not_sent), MESSAGE_HEAD(accumulator, not_sent), 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"num_cells_total", offsetof(MESSAGE_STRUCT(accumulator), num_cells_total), MESSAGE_HEAD(accumulator, num_cells_total), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
};

static const struct message_member MESSAGE_TABLE(bearing_scan)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(bearing_scan), utime), MESSAGE_HEAD(bearing_scan, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(bearing_scan), scan), MESSAGE_HEAD(bearing_scan, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(bearing_scan), epoch), MESSAGE_HEAD(bearing_scan, epoch), 4, 1, .rule = MEMBER_ANY},
    {"sensor_id", offsetof(MESSAGE_STRUCT(bearing_scan), sensor_id), MESSAGE_HEAD(bearing_scan, sensor_id), 2, 1, .rule = MEMBER_ANY},
    {"sensor_x_m", offsetof(MESSAGE_STRUCT(bearing_scan), sensor_x_m), MESSAGE_HEAD(bearing_scan, sensor_x_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"sensor_y_m", offsetof(MESSAGE_STRUCT(bearing_scan), sensor_y_m), MESSAGE_HEAD(bearing_scan, sensor_y_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"sigma_rad", offsetof(MESSAGE_STRUCT(bearing_scan), sigma_rad), MESSAGE_HEAD(bearing_scan, sigma_rad), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(0.5)},
};
static const struct message_member MESSAGE_TABLE(bearing_scan_element)[] = {
    {"bearing_rad", 0, 0, 4, 1, .is_float = true, .low = (float)(-3.1415927), .high = (float)(3.1415927)},
};

static const struct message_member MESSAGE_TABLE(body_list)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(body_list), utime), MESSAGE_HEAD(body_list, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(body_list), scan), MESSAGE_HEAD(body_list, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(body_list), epoch), MESSAGE_HEAD(body_list, epoch), 4, 1, .rule = MEMBER_ANY},
    {"part", offsetof(MESSAGE_STRUCT(body_list), part), MESSAGE_HEAD(body_list, part), 2, 1, .rule = MEMBER_BELOW, .other = offsetof(MESSAGE_STRUCT(body_list), num_parts)},
    {"num_parts", offsetof(MESSAGE_STRUCT(body_list), num_parts), MESSAGE_HEAD(body_list, num_parts), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(32767)},
};

static const struct message_member MESSAGE_TABLE(clutter_map)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(clutter_map), utime), MESSAGE_HEAD(clutter_map, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(clutter_map), scan), MESSAGE_HEAD(clutter_map, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(clutter_map), epoch), MESSAGE_HEAD(clutter_map, epoch), 4, 1, .rule = MEMBER_ANY},
    {"num_echoes_total", offsetof(MESSAGE_STRUCT(clutter_map), num_echoes_total), MESSAGE_HEAD(clutter_map, num_echoes_total), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"part", offsetof(MESSAGE_STRUCT(clutter_map), part), MESSAGE_HEAD(clutter_map, part), 2, 1, .rule = MEMBER_BELOW, .other = offsetof(MESSAGE_STRUCT(clutter_map), num_parts)},
    {"num_parts", offsetof(MESSAGE_STRUCT(clutter_map), num_parts), MESSAGE_HEAD(clutter_map, num_parts), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(32767)},
};

static const struct message_member MESSAGE_TABLE(direction_scan)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(direction_scan), utime), MESSAGE_HEAD(direction_scan, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(direction_scan), scan), MESSAGE_HEAD(direction_scan, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(direction_scan), epoch), MESSAGE_HEAD(direction_scan, epoch), 4, 1, .rule = MEMBER_ANY},
    {"sensor_id", offsetof(MESSAGE_STRUCT(direction_scan), sensor_id), MESSAGE_HEAD(direction_scan, sensor_id), 2, 1, .rule = MEMBER_ANY},
    {"sensor_x_m", offsetof(MESSAGE_STRUCT(direction_scan), sensor_x_m), MESSAGE_HEAD(direction_scan, sensor_x_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"sensor_y_m", offsetof(MESSAGE_STRUCT(direction_scan), sensor_y_m), MESSAGE_HEAD(direction_scan, sensor_y_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"sensor_z_m", offsetof(MESSAGE_STRUCT(direction_scan), sensor_z_m), MESSAGE_HEAD(direction_scan, sensor_z_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"sigma_rad", offsetof(MESSAGE_STRUCT(direction_scan), sigma_rad), MESSAGE_HEAD(direction_scan, sigma_rad), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(0.5)},
    {"sigma_elevation_rad", offsetof(MESSAGE_STRUCT(direction_scan), sigma_elevation_rad), MESSAGE_HEAD(direction_scan, sigma_elevation_rad), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(0.5)},
    {"sector_from_rad", offsetof(MESSAGE_STRUCT(direction_scan), sector_from_rad), MESSAGE_HEAD(direction_scan, sector_from_rad), 4, 1, .is_float = true, .low = (float)(-6.2831855), .high = (float)(6.2831855)},
    {"sector_to_rad", offsetof(MESSAGE_STRUCT(direction_scan), sector_to_rad), MESSAGE_HEAD(direction_scan, sector_to_rad), 4, 1, .is_float = true, .low = (float)(-6.2831855), .high = (float)(6.2831855)},
};

static const struct message_member MESSAGE_TABLE(ghost_matrix)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(ghost_matrix), utime), MESSAGE_HEAD(ghost_matrix, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(ghost_matrix), scan), MESSAGE_HEAD(ghost_matrix, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(ghost_matrix), epoch), MESSAGE_HEAD(ghost_matrix, epoch), 4, 1, .rule = MEMBER_ANY},
    {"sensor_a_id", offsetof(MESSAGE_STRUCT(ghost_matrix), sensor_a_id), MESSAGE_HEAD(ghost_matrix, sensor_a_id), 2, 1, .rule = MEMBER_ANY},
    {"sensor_b_id", offsetof(MESSAGE_STRUCT(ghost_matrix), sensor_b_id), MESSAGE_HEAD(ghost_matrix, sensor_b_id), 2, 1, .rule = MEMBER_ANY},
    {"sensor_a_x_m", offsetof(MESSAGE_STRUCT(ghost_matrix), sensor_a_x_m), MESSAGE_HEAD(ghost_matrix, sensor_a_x_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"sensor_a_y_m", offsetof(MESSAGE_STRUCT(ghost_matrix), sensor_a_y_m), MESSAGE_HEAD(ghost_matrix, sensor_a_y_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"sensor_b_x_m", offsetof(MESSAGE_STRUCT(ghost_matrix), sensor_b_x_m), MESSAGE_HEAD(ghost_matrix, sensor_b_x_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"sensor_b_y_m", offsetof(MESSAGE_STRUCT(ghost_matrix), sensor_b_y_m), MESSAGE_HEAD(ghost_matrix, sensor_b_y_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"range_max_m", offsetof(MESSAGE_STRUCT(ghost_matrix), range_max_m), MESSAGE_HEAD(ghost_matrix, range_max_m), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e9)},
    {"rule", offsetof(MESSAGE_STRUCT(ghost_matrix), rule), MESSAGE_HEAD(ghost_matrix, rule), 1, 1, .rule = MEMBER_ONE_OF, .choices = {0, 1, 2}, .num_choices = 3},
    {"num_rows", offsetof(MESSAGE_STRUCT(ghost_matrix), num_rows), MESSAGE_HEAD(ghost_matrix, num_rows), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(255)},
    {"num_columns", offsetof(MESSAGE_STRUCT(ghost_matrix), num_columns), MESSAGE_HEAD(ghost_matrix, num_columns), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(255)},
    {"not_sent", offsetof(MESSAGE_STRUCT(ghost_matrix), not_sent), MESSAGE_HEAD(ghost_matrix, not_sent), 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
    {"part", offsetof(MESSAGE_STRUCT(ghost_matrix), part), MESSAGE_HEAD(ghost_matrix, part), 2, 1, .rule = MEMBER_BELOW, .other = offsetof(MESSAGE_STRUCT(ghost_matrix), num_parts)},
    {"num_parts", offsetof(MESSAGE_STRUCT(ghost_matrix), num_parts), MESSAGE_HEAD(ghost_matrix, num_parts), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(32767)},
};

static const struct message_member MESSAGE_TABLE(hypotheses)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(hypotheses), utime), MESSAGE_HEAD(hypotheses, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(hypotheses), scan), MESSAGE_HEAD(hypotheses, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(hypotheses), epoch), MESSAGE_HEAD(hypotheses, epoch), 4, 1, .rule = MEMBER_ANY},
    {"track_id", offsetof(MESSAGE_STRUCT(hypotheses), track_id), MESSAGE_HEAD(hypotheses, track_id), 4, 1, .rule = MEMBER_ANY},
    {"score_nat", offsetof(MESSAGE_STRUCT(hypotheses), score_nat), MESSAGE_HEAD(hypotheses, score_nat), 4, 1, .is_float = true, .low = (float)(-FLT_MAX), .high = (float)(FLT_MAX)},
    {"calm", offsetof(MESSAGE_STRUCT(hypotheses), calm), MESSAGE_HEAD(hypotheses, calm), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"steady", offsetof(MESSAGE_STRUCT(hypotheses), steady), MESSAGE_HEAD(hypotheses, steady), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"maneuver", offsetof(MESSAGE_STRUCT(hypotheses), maneuver), MESSAGE_HEAD(hypotheses, maneuver), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"evidence", offsetof(MESSAGE_STRUCT(hypotheses), evidence), MESSAGE_HEAD(hypotheses, evidence), 1, 1, .rule = MEMBER_ONE_OF, .choices = {0, 1, 2}, .num_choices = 3},
    {"support", offsetof(MESSAGE_STRUCT(hypotheses), support), MESSAGE_HEAD(hypotheses, support), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"shared", offsetof(MESSAGE_STRUCT(hypotheses), shared), MESSAGE_HEAD(hypotheses, shared), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"clutter", offsetof(MESSAGE_STRUCT(hypotheses), clutter), MESSAGE_HEAD(hypotheses, clutter), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"not_sent", offsetof(MESSAGE_STRUCT(hypotheses), not_sent), MESSAGE_HEAD(hypotheses, not_sent), 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
};

static const struct message_member MESSAGE_TABLE(life)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(life), utime), MESSAGE_HEAD(life, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(life), scan), MESSAGE_HEAD(life, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(life), epoch), MESSAGE_HEAD(life, epoch), 4, 1, .rule = MEMBER_ANY},
    {"death_rate", offsetof(MESSAGE_STRUCT(life), death_rate), MESSAGE_HEAD(life, death_rate), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"hide_rate", offsetof(MESSAGE_STRUCT(life), hide_rate), MESSAGE_HEAD(life, hide_rate), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1)},
    {"appear_rate", offsetof(MESSAGE_STRUCT(life), appear_rate), MESSAGE_HEAD(life, appear_rate), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(2)},
    {"lived_scans", offsetof(MESSAGE_STRUCT(life), lived_scans), MESSAGE_HEAD(life, lived_scans), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e9)},
    {"num_tracks_total", offsetof(MESSAGE_STRUCT(life), num_tracks_total), MESSAGE_HEAD(life, num_tracks_total), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"part", offsetof(MESSAGE_STRUCT(life), part), MESSAGE_HEAD(life, part), 2, 1, .rule = MEMBER_BELOW, .other = offsetof(MESSAGE_STRUCT(life), num_parts)},
    {"num_parts", offsetof(MESSAGE_STRUCT(life), num_parts), MESSAGE_HEAD(life, num_parts), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(32767)},
};

static const struct message_member MESSAGE_TABLE(peak_list)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(peak_list), utime), MESSAGE_HEAD(peak_list, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(peak_list), scan), MESSAGE_HEAD(peak_list, scan), 4, 1, .rule = MEMBER_ANY},
};

static const struct message_member MESSAGE_TABLE(plane)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(plane), utime), MESSAGE_HEAD(plane, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(plane), scan), MESSAGE_HEAD(plane, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(plane), epoch), MESSAGE_HEAD(plane, epoch), 4, 1, .rule = MEMBER_ANY},
    {"method", offsetof(MESSAGE_STRUCT(plane), method), MESSAGE_HEAD(plane, method), 1, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(5)},
    {"has_pair", offsetof(MESSAGE_STRUCT(plane), has_pair), MESSAGE_HEAD(plane, has_pair), 1, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(1)},
    {"sensor_a_id", offsetof(MESSAGE_STRUCT(plane), sensor_a_id), MESSAGE_HEAD(plane, sensor_a_id), 2, 1, .rule = MEMBER_ANY},
    {"sensor_b_id", offsetof(MESSAGE_STRUCT(plane), sensor_b_id), MESSAGE_HEAD(plane, sensor_b_id), 2, 1, .rule = MEMBER_ANY},
    {"votes_max", offsetof(MESSAGE_STRUCT(plane), votes_max), MESSAGE_HEAD(plane, votes_max), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e9)},
    {"part", offsetof(MESSAGE_STRUCT(plane), part), MESSAGE_HEAD(plane, part), 2, 1, .rule = MEMBER_BELOW, .other = offsetof(MESSAGE_STRUCT(plane), num_parts)},
    {"num_parts", offsetof(MESSAGE_STRUCT(plane), num_parts), MESSAGE_HEAD(plane, num_parts), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(32767)},
};

static const struct message_member MESSAGE_TABLE(plot_scan)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(plot_scan), utime), MESSAGE_HEAD(plot_scan, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(plot_scan), scan), MESSAGE_HEAD(plot_scan, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(plot_scan), epoch), MESSAGE_HEAD(plot_scan, epoch), 4, 1, .rule = MEMBER_ANY},
    {"sensor_id", offsetof(MESSAGE_STRUCT(plot_scan), sensor_id), MESSAGE_HEAD(plot_scan, sensor_id), 2, 1, .rule = MEMBER_ANY},
    {"kind", offsetof(MESSAGE_STRUCT(plot_scan), kind), MESSAGE_HEAD(plot_scan, kind), 1, 1, .rule = MEMBER_ONE_OF, .choices = {2, 3, 4, 6}, .num_choices = 4},
    {"part", offsetof(MESSAGE_STRUCT(plot_scan), part), MESSAGE_HEAD(plot_scan, part), 2, 1, .rule = MEMBER_BELOW, .other = offsetof(MESSAGE_STRUCT(plot_scan), num_parts)},
    {"num_parts", offsetof(MESSAGE_STRUCT(plot_scan), num_parts), MESSAGE_HEAD(plot_scan, num_parts), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(32767)},
    {"sector_from_rad", offsetof(MESSAGE_STRUCT(plot_scan), sector_from_rad), MESSAGE_HEAD(plot_scan, sector_from_rad), 4, 1, .is_float = true, .low = (float)(-6.2831855), .high = (float)(6.2831855)},
    {"sector_to_rad", offsetof(MESSAGE_STRUCT(plot_scan), sector_to_rad), MESSAGE_HEAD(plot_scan, sector_to_rad), 4, 1, .is_float = true, .low = (float)(-6.2831855), .high = (float)(6.2831855)},
};

static const struct message_member MESSAGE_TABLE(polar_scan)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(polar_scan), utime), MESSAGE_HEAD(polar_scan, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(polar_scan), scan), MESSAGE_HEAD(polar_scan, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(polar_scan), epoch), MESSAGE_HEAD(polar_scan, epoch), 4, 1, .rule = MEMBER_ANY},
    {"sensor_id", offsetof(MESSAGE_STRUCT(polar_scan), sensor_id), MESSAGE_HEAD(polar_scan, sensor_id), 2, 1, .rule = MEMBER_ANY},
    {"has_elevation", offsetof(MESSAGE_STRUCT(polar_scan), has_elevation), MESSAGE_HEAD(polar_scan, has_elevation), 1, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(1)},
    {"has_range_rate", offsetof(MESSAGE_STRUCT(polar_scan), has_range_rate), MESSAGE_HEAD(polar_scan, has_range_rate), 1, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(1)},
    {"part", offsetof(MESSAGE_STRUCT(polar_scan), part), MESSAGE_HEAD(polar_scan, part), 2, 1, .rule = MEMBER_BELOW, .other = offsetof(MESSAGE_STRUCT(polar_scan), num_parts)},
    {"num_parts", offsetof(MESSAGE_STRUCT(polar_scan), num_parts), MESSAGE_HEAD(polar_scan, num_parts), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(32767)},
    {"sensor_x_m", offsetof(MESSAGE_STRUCT(polar_scan), sensor_x_m), MESSAGE_HEAD(polar_scan, sensor_x_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"sensor_y_m", offsetof(MESSAGE_STRUCT(polar_scan), sensor_y_m), MESSAGE_HEAD(polar_scan, sensor_y_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"sensor_z_m", offsetof(MESSAGE_STRUCT(polar_scan), sensor_z_m), MESSAGE_HEAD(polar_scan, sensor_z_m), 4, 1, .is_float = true, .low = (float)(-2e6), .high = (float)(2e6)},
    {"sigma_range_m", offsetof(MESSAGE_STRUCT(polar_scan), sigma_range_m), MESSAGE_HEAD(polar_scan, sigma_range_m), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e5)},
    {"sigma_azimuth_rad", offsetof(MESSAGE_STRUCT(polar_scan), sigma_azimuth_rad), MESSAGE_HEAD(polar_scan, sigma_azimuth_rad), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(0.5)},
    {"sigma_elevation_rad", offsetof(MESSAGE_STRUCT(polar_scan), sigma_elevation_rad), MESSAGE_HEAD(polar_scan, sigma_elevation_rad), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(0.5)},
    {"sigma_range_rate_mps", offsetof(MESSAGE_STRUCT(polar_scan), sigma_range_rate_mps), MESSAGE_HEAD(polar_scan, sigma_range_rate_mps), 4, 1, .is_float = true, .low = (float)(0), .high = (float)(1e5)},
    {"sector_from_rad", offsetof(MESSAGE_STRUCT(polar_scan), sector_from_rad), MESSAGE_HEAD(polar_scan, sector_from_rad), 4, 1, .is_float = true, .low = (float)(-6.2831855), .high = (float)(6.2831855)},
    {"sector_to_rad", offsetof(MESSAGE_STRUCT(polar_scan), sector_to_rad), MESSAGE_HEAD(polar_scan, sector_to_rad), 4, 1, .is_float = true, .low = (float)(-6.2831855), .high = (float)(6.2831855)},
};

static const struct message_member MESSAGE_TABLE(sensor_list)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(sensor_list), utime), MESSAGE_HEAD(sensor_list, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(sensor_list), scan), MESSAGE_HEAD(sensor_list, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(sensor_list), epoch), MESSAGE_HEAD(sensor_list, epoch), 4, 1, .rule = MEMBER_ANY},
    {"num_sensors_total", offsetof(MESSAGE_STRUCT(sensor_list), num_sensors_total), MESSAGE_HEAD(sensor_list, num_sensors_total), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"part", offsetof(MESSAGE_STRUCT(sensor_list), part), MESSAGE_HEAD(sensor_list, part), 2, 1, .rule = MEMBER_BELOW, .other = offsetof(MESSAGE_STRUCT(sensor_list), num_parts)},
    {"num_parts", offsetof(MESSAGE_STRUCT(sensor_list), num_parts), MESSAGE_HEAD(sensor_list, num_parts), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(32767)},
};

static const struct message_member MESSAGE_TABLE(track_list)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(track_list), utime), MESSAGE_HEAD(track_list, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(track_list), scan), MESSAGE_HEAD(track_list, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(track_list), epoch), MESSAGE_HEAD(track_list, epoch), 4, 1, .rule = MEMBER_ANY},
    {"num_tracks_total", offsetof(MESSAGE_STRUCT(track_list), num_tracks_total), MESSAGE_HEAD(track_list, num_tracks_total), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(32767)},
    {"part", offsetof(MESSAGE_STRUCT(track_list), part), MESSAGE_HEAD(track_list, part), 2, 1, .rule = MEMBER_BELOW, .other = offsetof(MESSAGE_STRUCT(track_list), num_parts)},
    {"num_parts", offsetof(MESSAGE_STRUCT(track_list), num_parts), MESSAGE_HEAD(track_list, num_parts), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(32767)},
};

static const struct message_member MESSAGE_TABLE(truth_list)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(truth_list), utime), MESSAGE_HEAD(truth_list, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(truth_list), scan), MESSAGE_HEAD(truth_list, scan), 4, 1, .rule = MEMBER_ANY},
    {"part", offsetof(MESSAGE_STRUCT(truth_list), part), MESSAGE_HEAD(truth_list, part), 2, 1, .rule = MEMBER_BELOW, .other = offsetof(MESSAGE_STRUCT(truth_list), num_parts)},
    {"num_parts", offsetof(MESSAGE_STRUCT(truth_list), num_parts), MESSAGE_HEAD(truth_list, num_parts), 2, 1, .rule = MEMBER_RANGE, .min = INT64_C(1), .max = INT64_C(32767)},
};

static const struct message_member MESSAGE_TABLE(zone_event_list)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(zone_event_list), utime), MESSAGE_HEAD(zone_event_list, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(zone_event_list), scan), MESSAGE_HEAD(zone_event_list, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(zone_event_list), epoch), MESSAGE_HEAD(zone_event_list, epoch), 4, 1, .rule = MEMBER_ANY},
};

static const struct message_member MESSAGE_TABLE(zone_list)[] = {
    {"utime", offsetof(MESSAGE_STRUCT(zone_list), utime), MESSAGE_HEAD(zone_list, utime), 8, 1, .rule = MEMBER_RANGE, .min = INT64_C(-4000000000000000000), .max = INT64_C(4000000000000000000)},
    {"scan", offsetof(MESSAGE_STRUCT(zone_list), scan), MESSAGE_HEAD(zone_list, scan), 4, 1, .rule = MEMBER_ANY},
    {"epoch", offsetof(MESSAGE_STRUCT(zone_list), epoch), MESSAGE_HEAD(zone_list, epoch), 4, 1, .rule = MEMBER_ANY},
    {"events_dropped", offsetof(MESSAGE_STRUCT(zone_list), events_dropped), MESSAGE_HEAD(zone_list, events_dropped), 4, 1, .rule = MEMBER_RANGE, .min = INT64_C(0), .max = INT64_C(2147483647)},
};

static const struct message_shape MESSAGE_TABLE(shapes)[] = {
    {"accumulator_cell_t", MESSAGE_TABLE(accumulator_cell), 6, sizeof(MESSAGE_STRUCT(accumulator_cell)), .element_members = NULL},
    {"body_t", MESSAGE_TABLE(body), 14, sizeof(MESSAGE_STRUCT(body)), .element_members = NULL},
    {"command_answer_t", MESSAGE_TABLE(command_answer), 7, sizeof(MESSAGE_STRUCT(command_answer)), .element_members = NULL},
    {"command_t", MESSAGE_TABLE(command), 13, sizeof(MESSAGE_STRUCT(command)), .element_members = NULL},
    {"direction_t", MESSAGE_TABLE(direction), 5, sizeof(MESSAGE_STRUCT(direction)), .element_members = NULL},
    {"echo_t", MESSAGE_TABLE(echo), 10, sizeof(MESSAGE_STRUCT(echo)), .element_members = NULL},
    {"ghost_t", MESSAGE_TABLE(ghost), 6, sizeof(MESSAGE_STRUCT(ghost)), .element_members = NULL},
    {"hypothesis_t", MESSAGE_TABLE(hypothesis), 7, sizeof(MESSAGE_STRUCT(hypothesis)), .element_members = NULL},
    {"learned_t", MESSAGE_TABLE(learned), 11, sizeof(MESSAGE_STRUCT(learned)), .element_members = NULL},
    {"peak_t", MESSAGE_TABLE(peak), 6, sizeof(MESSAGE_STRUCT(peak)), .element_members = NULL},
    {"plane_row_t", MESSAGE_TABLE(plane_row), 1, sizeof(MESSAGE_STRUCT(plane_row)), .element_members = NULL},
    {"plot_t", MESSAGE_TABLE(plot), 10, sizeof(MESSAGE_STRUCT(plot)), .element_members = NULL},
    {"polar_plot_t", MESSAGE_TABLE(polar_plot), 6, sizeof(MESSAGE_STRUCT(polar_plot)), .element_members = NULL},
    {"sensor_t", MESSAGE_TABLE(sensor), 13, sizeof(MESSAGE_STRUCT(sensor)), .element_members = NULL},
    {"setting_answer_t", MESSAGE_TABLE(setting_answer), 11, sizeof(MESSAGE_STRUCT(setting_answer)), .element_members = NULL},
    {"setting_t", MESSAGE_TABLE(setting), 4, sizeof(MESSAGE_STRUCT(setting)), .element_members = NULL},
    {"status_t", MESSAGE_TABLE(status), 35, sizeof(MESSAGE_STRUCT(status)), .element_members = NULL},
    {"track_life_t", MESSAGE_TABLE(track_life), 3, sizeof(MESSAGE_STRUCT(track_life)), .element_members = NULL},
    {"track_t", MESSAGE_TABLE(track), 19, sizeof(MESSAGE_STRUCT(track)), .element_members = NULL},
    {"truth_t", MESSAGE_TABLE(truth), 7, sizeof(MESSAGE_STRUCT(truth)), .element_members = NULL},
    {"work_t", MESSAGE_TABLE(work), 11, sizeof(MESSAGE_STRUCT(work)), .element_members = NULL},
    {"zone_event_t", MESSAGE_TABLE(zone_event), 6, sizeof(MESSAGE_STRUCT(zone_event)), .element_members = NULL},
    {"zone_t", MESSAGE_TABLE(zone), 12, sizeof(MESSAGE_STRUCT(zone)), .element_members = NULL},
    {"accumulator_t", MESSAGE_TABLE(accumulator), 19, sizeof(MESSAGE_STRUCT(accumulator)),
     {"num_cells", offsetof(MESSAGE_STRUCT(accumulator), num_cells), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(accumulator), cells), MESSAGE_TABLE(accumulator_cell), 6, sizeof(MESSAGE_STRUCT(accumulator_cell)), 22, 48, MESSAGE_LIST_IS_POINTER},
    {"bearing_scan_t", MESSAGE_TABLE(bearing_scan), 7, sizeof(MESSAGE_STRUCT(bearing_scan)),
     {"num_bearings", offsetof(MESSAGE_STRUCT(bearing_scan), num_bearings), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(bearing_scan), bearing_rad), MESSAGE_TABLE(bearing_scan_element), 1, sizeof(float), 4, 256, MESSAGE_LIST_IS_POINTER},
    {"body_list_t", MESSAGE_TABLE(body_list), 5, sizeof(MESSAGE_STRUCT(body_list)),
     {"num_bodies", offsetof(MESSAGE_STRUCT(body_list), num_bodies), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(body_list), bodies), MESSAGE_TABLE(body), 14, sizeof(MESSAGE_STRUCT(body)), 56, 24, MESSAGE_LIST_IS_POINTER},
    {"clutter_map_t", MESSAGE_TABLE(clutter_map), 6, sizeof(MESSAGE_STRUCT(clutter_map)),
     {"num_echoes", offsetof(MESSAGE_STRUCT(clutter_map), num_echoes), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(clutter_map), echoes), MESSAGE_TABLE(echo), 10, sizeof(MESSAGE_STRUCT(echo)), 34, 40, MESSAGE_LIST_IS_POINTER},
    {"direction_scan_t", MESSAGE_TABLE(direction_scan), 11, sizeof(MESSAGE_STRUCT(direction_scan)),
     {"num_directions", offsetof(MESSAGE_STRUCT(direction_scan), num_directions), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(direction_scan), directions), MESSAGE_TABLE(direction), 5, sizeof(MESSAGE_STRUCT(direction)), 17, 64, MESSAGE_LIST_IS_POINTER},
    {"ghost_matrix_t", MESSAGE_TABLE(ghost_matrix), 16, sizeof(MESSAGE_STRUCT(ghost_matrix)),
     {"num_elements", offsetof(MESSAGE_STRUCT(ghost_matrix), num_elements), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(ghost_matrix), elements), MESSAGE_TABLE(ghost), 6, sizeof(MESSAGE_STRUCT(ghost)), 17, 78, MESSAGE_LIST_IS_POINTER},
    {"hypotheses_t", MESSAGE_TABLE(hypotheses), 13, sizeof(MESSAGE_STRUCT(hypotheses)),
     {"num_hypotheses", offsetof(MESSAGE_STRUCT(hypotheses), num_hypotheses), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(hypotheses), hypotheses), MESSAGE_TABLE(hypothesis), 7, sizeof(MESSAGE_STRUCT(hypothesis)), 30, 8, MESSAGE_LIST_IS_POINTER},
    {"life_t", MESSAGE_TABLE(life), 10, sizeof(MESSAGE_STRUCT(life)),
     {"num_tracks", offsetof(MESSAGE_STRUCT(life), num_tracks), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(life), tracks), MESSAGE_TABLE(track_life), 3, sizeof(MESSAGE_STRUCT(track_life)), 12, 100, MESSAGE_LIST_IS_POINTER},
    {"peak_list_t", MESSAGE_TABLE(peak_list), 2, sizeof(MESSAGE_STRUCT(peak_list)),
     {"num_peaks", offsetof(MESSAGE_STRUCT(peak_list), num_peaks), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(peak_list), peaks), MESSAGE_TABLE(peak), 6, sizeof(MESSAGE_STRUCT(peak)), 20, 48, MESSAGE_LIST_IS_POINTER},
    {"plane_t", MESSAGE_TABLE(plane), 10, sizeof(MESSAGE_STRUCT(plane)),
     {"num_rows", offsetof(MESSAGE_STRUCT(plane), num_rows), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(plane), rows), MESSAGE_TABLE(plane_row), 1, sizeof(MESSAGE_STRUCT(plane_row)), 64, 16, MESSAGE_LIST_IS_POINTER},
    {"plot_scan_t", MESSAGE_TABLE(plot_scan), 9, sizeof(MESSAGE_STRUCT(plot_scan)),
     {"num_plots", offsetof(MESSAGE_STRUCT(plot_scan), num_plots), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(plot_scan), plots), MESSAGE_TABLE(plot), 10, sizeof(MESSAGE_STRUCT(plot)), 40, 34, MESSAGE_LIST_IS_POINTER},
    {"polar_scan_t", MESSAGE_TABLE(polar_scan), 17, sizeof(MESSAGE_STRUCT(polar_scan)),
     {"num_polar_plots", offsetof(MESSAGE_STRUCT(polar_scan), num_polar_plots), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(polar_scan), polar_plots), MESSAGE_TABLE(polar_plot), 6, sizeof(MESSAGE_STRUCT(polar_plot)), 24, 54, MESSAGE_LIST_IS_POINTER},
    {"sensor_list_t", MESSAGE_TABLE(sensor_list), 6, sizeof(MESSAGE_STRUCT(sensor_list)),
     {"num_sensors", offsetof(MESSAGE_STRUCT(sensor_list), num_sensors), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(sensor_list), sensors), MESSAGE_TABLE(sensor), 13, sizeof(MESSAGE_STRUCT(sensor)), 38, 36, MESSAGE_LIST_IS_POINTER},
    {"track_list_t", MESSAGE_TABLE(track_list), 6, sizeof(MESSAGE_STRUCT(track_list)),
     {"num_tracks", offsetof(MESSAGE_STRUCT(track_list), num_tracks), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(track_list), tracks), MESSAGE_TABLE(track), 19, sizeof(MESSAGE_STRUCT(track)), 145, 9, MESSAGE_LIST_IS_POINTER},
    {"truth_list_t", MESSAGE_TABLE(truth_list), 4, sizeof(MESSAGE_STRUCT(truth_list)),
     {"num_targets", offsetof(MESSAGE_STRUCT(truth_list), num_targets), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(truth_list), targets), MESSAGE_TABLE(truth), 7, sizeof(MESSAGE_STRUCT(truth)), 28, 50, MESSAGE_LIST_IS_POINTER},
    {"zone_event_list_t", MESSAGE_TABLE(zone_event_list), 3, sizeof(MESSAGE_STRUCT(zone_event_list)),
     {"num_events", offsetof(MESSAGE_STRUCT(zone_event_list), num_events), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(zone_event_list), events), MESSAGE_TABLE(zone_event), 6, sizeof(MESSAGE_STRUCT(zone_event)), 18, 64, MESSAGE_LIST_IS_POINTER},
    {"zone_list_t", MESSAGE_TABLE(zone_list), 4, sizeof(MESSAGE_STRUCT(zone_list)),
     {"num_zones", offsetof(MESSAGE_STRUCT(zone_list), num_zones), 0, 2, 1, .rule = MEMBER_ANY},
     offsetof(MESSAGE_STRUCT(zone_list), zones), MESSAGE_TABLE(zone), 12, sizeof(MESSAGE_STRUCT(zone)), 44, 30, MESSAGE_LIST_IS_POINTER},
};
