/* SPDX-License-Identifier: MIT */
/* Made by tools/codegen from lcm_types/. Not to be edited: `make codegen`. */
/* clang-format off */
/*
 * message: the bytes of rhotrack's LCM messages, to and from structs. No heap, no liblcm, no state.
 *
 * A message is its fingerprint (8 bytes: which struct, which version of it) and its members in
 * their order, big endian, without gaps. Fields have the names, units and ranges of lcm_types/. The
 * capacity of a list is RHO_MESSAGE_<STRUCT>_MAX_<LIST>. The longest message of a struct has
 * RHO_MESSAGE_<STRUCT>_MAX_SIZE bytes, which fit one datagram.
 *
 * For each struct S:
 *   rho_message_S_encode    struct to bytes. Errors: NULL, COUNT (of the list: negative, or beyond
 *                           its MAX), CAPACITY (of the buffer); nothing is written. Values are not
 *                           checked: validate does that.
 *   rho_message_S_decode    bytes to struct, all of them. Errors: NULL, SHORT, TYPE (another
 *                           fingerprint), COUNT, TRAILING; *message is unchanged. Elements beyond
 *                           the list's count are unchanged in any case.
 *   rho_message_S_validate  are all values finite, in their ranges, one of their constants? Errors:
 *                           NULL, COUNT, VALUE; *place (may be NULL) tells which member, and
 *                           rho_message_S_field its name.
 * and where S ends with a list, to write it without a copy of the list:
 *   rho_message_S_begin     the members before the count (struct rho_message_S_head) go to the
 *                           buffer. Errors: NULL, CAPACITY; *writer is unchanged, and is not to be
 *                           added to.
 *   rho_message_S_add       one element more. Errors: NULL, STATE (not begun, or begun as another
 *                           struct), CAPACITY (of the buffer or the list); the message so far stays
 *                           whole.
 *   rho_message_end         the message's length; the writer is empty then.
 *
 * Any bytes of any length may be decoded. data and buffer need no alignment. Calls are independent
 * of one another.
 * Cost: proportional to the bytes, 2 instructions a byte to encode or decode, 6 to validate
 * (`make instructions`).
 * Stack: 130 bytes.
 */
#ifndef RHOTRACK_MESSAGE_H
#define RHOTRACK_MESSAGE_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

enum rho_message_type {
    RHO_MESSAGE_TYPE_ACCUMULATOR_CELL = 0,
    RHO_MESSAGE_TYPE_BODY,
    RHO_MESSAGE_TYPE_COMMAND_ANSWER,
    RHO_MESSAGE_TYPE_COMMAND,
    RHO_MESSAGE_TYPE_ECHO,
    RHO_MESSAGE_TYPE_GHOST,
    RHO_MESSAGE_TYPE_HYPOTHESIS,
    RHO_MESSAGE_TYPE_LEARNED,
    RHO_MESSAGE_TYPE_PEAK,
    RHO_MESSAGE_TYPE_PLANE_ROW,
    RHO_MESSAGE_TYPE_PLOT,
    RHO_MESSAGE_TYPE_POLAR_PLOT,
    RHO_MESSAGE_TYPE_SENSOR,
    RHO_MESSAGE_TYPE_SETTING_ANSWER,
    RHO_MESSAGE_TYPE_SETTING,
    RHO_MESSAGE_TYPE_STATUS,
    RHO_MESSAGE_TYPE_TRACK,
    RHO_MESSAGE_TYPE_TRUTH,
    RHO_MESSAGE_TYPE_WORK,
    RHO_MESSAGE_TYPE_ZONE_EVENT,
    RHO_MESSAGE_TYPE_ZONE,
    RHO_MESSAGE_TYPE_ACCUMULATOR,
    RHO_MESSAGE_TYPE_BEARING_SCAN,
    RHO_MESSAGE_TYPE_BODY_LIST,
    RHO_MESSAGE_TYPE_CLUTTER_MAP,
    RHO_MESSAGE_TYPE_GHOST_MATRIX,
    RHO_MESSAGE_TYPE_HYPOTHESES,
    RHO_MESSAGE_TYPE_PEAK_LIST,
    RHO_MESSAGE_TYPE_PLANE,
    RHO_MESSAGE_TYPE_PLOT_SCAN,
    RHO_MESSAGE_TYPE_POLAR_SCAN,
    RHO_MESSAGE_TYPE_SENSOR_LIST,
    RHO_MESSAGE_TYPE_TRACK_LIST,
    RHO_MESSAGE_TYPE_TRUTH_LIST,
    RHO_MESSAGE_TYPE_ZONE_EVENT_LIST,
    RHO_MESSAGE_TYPE_ZONE_LIST,
    RHO_NUM_MESSAGE_TYPES /* count of the values above, not a message */
};

/* A member that validate refuses. */
struct rho_message_place {
    uint16_t offset; /* in its struct */
    int16_t element; /* of the list; -1: before it */
};

/* A message that is written; the caller's buffer holds a whole message at any time. */
struct rho_message_writer {
    uint8_t *buffer;
    size_t capacity, size; /* bytes; size: so far */
    uint64_t fingerprint;
    uint16_t count; /* elements so far */
};

/* The type by its fingerprint; RHO_NUM_MESSAGE_TYPES: none of these. Constant cost. */
enum rho_message_type rho_message_type_of(const uint8_t *data, size_t size);

/* The fingerprint, and the name as in lcm_types/ ("plot_scan_t"); 0 and "unknown" for others. */
uint64_t rho_message_fingerprint(enum rho_message_type type);
const char *rho_message_type_name(enum rho_message_type type);

/* The length of what was begun and added. Errors: NULL, STATE (not begun). Constant cost. */
RHO_MUST_CHECK enum rho_status rho_message_end(struct rho_message_writer *writer, size_t *size);

/* ---- accumulator_cell_t ---- */

/* One of the fullest cells of an accumulator_t: the line x cos(theta) + y sin(theta) = rho. */

#define RHO_MESSAGE_ACCUMULATOR_CELL_FINGERPRINT UINT64_C(0x7dc022df7b25d931)
#define RHO_MESSAGE_ACCUMULATOR_CELL_MAX_SIZE 30u

struct rho_message_accumulator_cell {
    float rho_m; /* of the cell's centre, from the accumulator's origin; signed, m */
    float theta_rad; /* of its centre, rad; 0 .. 6.3 */
    float votes; /* of the cell; of a neutrosophic transform the sum of memberships; 0 .. 1e9 */
    /* bit m: scan m of the window voted, 0 the oldest; 0: not known; 0 .. 65535 */
    int32_t scan_mask;
    int16_t plots; /* or crossings, that voted; stays at 32767; 0 .. 32767 */
    /* of the track that the line started in this step; 0: none; 0 .. 2147483647 */
    int32_t track_id;
};
RHO_MUST_CHECK enum rho_status rho_message_accumulator_cell_encode(
    const struct rho_message_accumulator_cell *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_accumulator_cell_decode(
    const uint8_t *data, size_t size, struct rho_message_accumulator_cell *message);
RHO_MUST_CHECK enum rho_status rho_message_accumulator_cell_validate(
    const struct rho_message_accumulator_cell *message, struct rho_message_place *place);
const char *rho_message_accumulator_cell_field(const struct rho_message_place *place);

/* ---- body_t ---- */

/* The body of one track: a rectangle, its length along the heading. */

#define RHO_MESSAGE_BODY_FINGERPRINT UINT64_C(0xc79ba5919c3bcda2)
#define RHO_MESSAGE_BODY_MAX_SIZE 64u

struct rho_message_body {
    int32_t track_id; /* as in RHO_TRACKS */
    float x_m; /* centre of the body, m */
    float y_m;
    /* what the track follows, its place in RHO_TRACKS: the mean of what was seen, m */
    float reference_x_m;
    float reference_y_m;
    float length_m; /* 0 .. 1e5 */
    float width_m; /* 0 .. 1e5 */
    float heading_rad; /* counter-clockwise from +x; -4 .. 4 */
    float sigma_length_m; /* standard deviations; 0 .. 1e5 */
    float sigma_width_m; /* 0 .. 1e5 */
    float sigma_heading_rad; /* 0 .. 10 */
    float sigma_along_m; /* of the centre about the reference, along the heading, m; 0 .. 1e5 */
    float sigma_across_m; /* and across it; 0 .. 1e5 */
    float plots; /* that all this comes from; 0 .. 1e9 */
};
RHO_MUST_CHECK enum rho_status rho_message_body_encode(
    const struct rho_message_body *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_body_decode(
    const uint8_t *data, size_t size, struct rho_message_body *message);
RHO_MUST_CHECK enum rho_status rho_message_body_validate(
    const struct rho_message_body *message, struct rho_message_place *place);
const char *rho_message_body_field(const struct rho_message_place *place);

/* ---- command_answer_t ---- */

/* What has become of a command_t. Channel RHO_COMMAND_ANSWERS. */

#define RHO_MESSAGE_COMMAND_ANSWER_CHANNEL "RHO_COMMAND_ANSWERS"
#define RHO_MESSAGE_COMMAND_ANSWER_FINGERPRINT UINT64_C(0x7eb8e21727770191)
#define RHO_MESSAGE_COMMAND_ANSWER_MAX_SIZE 34u

struct rho_message_command_answer {
    /*
     * of the step after which it was done or refused, us; -4000000000000000000 ..
     * 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of this step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    int32_t number; /* of the command */
    int8_t action; /* of the command; 1 .. 127 */
    int8_t status; /* 0: done; else refused, by enum rho_status of rhotrack/types.h; 0 .. 127 */
    int32_t track_id; /* that was started, or changed; 0: none; 0 .. 2147483647 */
};
RHO_MUST_CHECK enum rho_status rho_message_command_answer_encode(
    const struct rho_message_command_answer *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_command_answer_decode(
    const uint8_t *data, size_t size, struct rho_message_command_answer *message);
RHO_MUST_CHECK enum rho_status rho_message_command_answer_validate(
    const struct rho_message_command_answer *message, struct rho_message_place *place);
const char *rho_message_command_answer_field(const struct rho_message_place *place);

/* ---- command_t ---- */

/* What an operator wants of a tracker: after the next step it is done, and answered by */
/* command_answer_t. Members that an action does not use are 0. Channel RHO_COMMANDS. */

#define RHO_MESSAGE_COMMAND_CHANNEL "RHO_COMMANDS"
#define RHO_MESSAGE_COMMAND_FINGERPRINT UINT64_C(0x159912556be04c2f)
#define RHO_MESSAGE_COMMAND_MAX_SIZE 61u
#define RHO_MESSAGE_COMMAND_START 1
#define RHO_MESSAGE_COMMAND_DROP 2
#define RHO_MESSAGE_COMMAND_RENUMBER 3
#define RHO_MESSAGE_COMMAND_FREEZE 4
#define RHO_MESSAGE_COMMAND_THAW 5
#define RHO_MESSAGE_COMMAND_EXCLUDE 6
#define RHO_MESSAGE_COMMAND_INCLUDE 7

struct rho_message_command {
    int64_t utime; /* when it was sent, us; -4000000000000000000 .. 4000000000000000000 */
    int32_t number; /* the sender's: the answer repeats it */
    int8_t action; /* one of START, DROP, RENUMBER, FREEZE, THAW, EXCLUDE, INCLUDE */
    int32_t track_id; /* of DROP, RENUMBER, FREEZE, THAW; 0 .. 2147483647 */
    int32_t new_id; /* of RENUMBER; 0 .. 2147483647 */
    float x_m; /* of START, INCLUDE; of EXCLUDE the least ones, m; -2e6 .. 2e6 */
    float y_m; /* -2e6 .. 2e6 */
    float x_max_m; /* of EXCLUDE, m; -2e6 .. 2e6 */
    float y_max_m; /* -2e6 .. 2e6 */
    float sigma_m; /* of START, m; 0 .. 1e5 */
    float vx_mps; /* of START, m/s; -2e4 .. 2e4 */
    float vy_mps; /* -2e4 .. 2e4 */
    float sigma_mps; /* of START, m/s; 0 .. 1e5 */
};
RHO_MUST_CHECK enum rho_status rho_message_command_encode(
    const struct rho_message_command *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_command_decode(
    const uint8_t *data, size_t size, struct rho_message_command *message);
RHO_MUST_CHECK enum rho_status rho_message_command_validate(
    const struct rho_message_command *message, struct rho_message_place *place);
const char *rho_message_command_field(const struct rho_message_place *place);

/* ---- echo_t ---- */

/* One echo of a clutter_map_t: something that gave clutter plots again and again in its place. */

#define RHO_MESSAGE_ECHO_FINGERPRINT UINT64_C(0xd5072401d660f823)
#define RHO_MESSAGE_ECHO_MAX_SIZE 42u

struct rho_message_echo {
    int16_t sensor_id; /* whose echo it is; -1: beyond int16_t */
    int16_t hits; /* plots of it; stays at 32767; 1 .. 32767 */
    int16_t unseen; /* scans of the sensor that looked there since the last one; 0 .. 32767 */
    float x_m; /* east, m, when the sensor looked there last; -2e6 .. 2e6 */
    float y_m; /* north, m; -2e6 .. 2e6 */
    float vx_mps; /* velocity, m/s; 0: it stands; -2e4 .. 2e4 */
    float vy_mps; /* m/s; -2e4 .. 2e4 */
    /* standard deviation of the place along the sensor's line of sight, m; 0 .. 1e6 */
    float sigma_range_m;
    float sigma_cross_m; /* across it, m; 0 .. 1e6 */
    float chance; /* that the sensor's next look there sees it; 0 .. 1 */
};
RHO_MUST_CHECK enum rho_status rho_message_echo_encode(
    const struct rho_message_echo *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_echo_decode(
    const uint8_t *data, size_t size, struct rho_message_echo *message);
RHO_MUST_CHECK enum rho_status rho_message_echo_validate(
    const struct rho_message_echo *message, struct rho_message_place *place);
const char *rho_message_echo_field(const struct rho_message_place *place);

/* ---- ghost_t ---- */

/* One element of a ghost_matrix_t: the crossing of two bearings. */

#define RHO_MESSAGE_GHOST_FINGERPRINT UINT64_C(0x164d411032cf217a)
#define RHO_MESSAGE_GHOST_MAX_SIZE 25u
#define RHO_MESSAGE_GHOST_KEPT 0
#define RHO_MESSAGE_GHOST_SIDES 1
#define RHO_MESSAGE_GHOST_APART 2
#define RHO_MESSAGE_GHOST_RANGE 3
#define RHO_MESSAGE_GHOST_ROW 4
#define RHO_MESSAGE_GHOST_COLUMN 5
#define RHO_MESSAGE_GHOST_UNMATCHED 6

struct rho_message_ghost {
    /* bearing of sensor a, among those that no track had claimed, from 0; 0 .. 32767 */
    int16_t row;
    int16_t column; /* bearing of sensor b, likewise; 0 .. 32767 */
    /*
     * it was pruned for: different sides of the base, diverging, beyond range_max_m, another
     * bearing's only crossing in its column or row, in no complete matching; one of KEPT, SIDES,
     * APART, RANGE, ROW, COLUMN, UNMATCHED
     */
    int8_t reason;
    /*
     * angle between the bearings, before pruning; 0 or less where they diverge, -pi on different
     * sides; -3.15 .. 3.15
     */
    float delta_rad;
    float x_m; /* of the crossing, east, m; 0 where there is none within range_max_m */
    float y_m; /* north, m */
};
RHO_MUST_CHECK enum rho_status rho_message_ghost_encode(
    const struct rho_message_ghost *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_ghost_decode(
    const uint8_t *data, size_t size, struct rho_message_ghost *message);
RHO_MUST_CHECK enum rho_status rho_message_ghost_validate(
    const struct rho_message_ghost *message, struct rho_message_place *place);
const char *rho_message_ghost_field(const struct rho_message_place *place);

/* ---- hypothesis_t ---- */

/* One hypothesis of a hypotheses_t: which plots were the track's, and where its target is then. */

#define RHO_MESSAGE_HYPOTHESIS_FINGERPRINT UINT64_C(0xf01a62a086282722)
#define RHO_MESSAGE_HYPOTHESIS_MAX_SIZE 38u

struct rho_message_hypothesis {
    float share; /* of the likelihood of all hypotheses of the track; they add up to 1; 0 .. 1 */
    float x_m; /* east, m, at the track's last look */
    float y_m; /* north, m */
    float vx_mps; /* velocity, m/s */
    float vy_mps;
    float maneuver_probability; /* 0 .. 1 */
    /*
     * rows of the plots that it took in the track's last three looks, the newest last; -1: none;
     * -2: not known
     */
    int16_t plots[3];
};
RHO_MUST_CHECK enum rho_status rho_message_hypothesis_encode(
    const struct rho_message_hypothesis *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_hypothesis_decode(
    const uint8_t *data, size_t size, struct rho_message_hypothesis *message);
RHO_MUST_CHECK enum rho_status rho_message_hypothesis_validate(
    const struct rho_message_hypothesis *message, struct rho_message_place *place);
const char *rho_message_hypothesis_field(const struct rho_message_place *place);

/* ---- learned_t ---- */

/*
 * Noise and detection probability of one described sensor, as the tracker has learned and uses
 * them.
 */
/* One message a second, of each sensor in turn, with status_t. Channel RHO_LEARNED. */

#define RHO_MESSAGE_LEARNED_CHANNEL "RHO_LEARNED"
#define RHO_MESSAGE_LEARNED_FINGERPRINT UINT64_C(0x267a29e3c0e96835)
#define RHO_MESSAGE_LEARNED_MAX_SIZE 72u

struct rho_message_learned {
    /* of the last scan that was stepped, us; -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's last step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    int16_t sensor_id;
    int16_t innovations; /* that the factors come from; 0: none is learned; 0 .. 32767 */
    float sigma_range_factor; /* on the stated sigma of range; 0 .. 100 */
    float sigma_cross_factor; /* on the stated sigma across; 0 .. 100 */
    int32_t looks; /* that they come from, of all rings; 0 .. 2147483647 */
    float range_max_m; /* outer edge of the last ring, m; 0 .. 1e9 */
    float pd_stated; /* 0 .. 1 */
    /* from the innermost ring outwards; below pd_stated where targets are seen less; 0 .. 1 */
    float pd[6];
};
RHO_MUST_CHECK enum rho_status rho_message_learned_encode(
    const struct rho_message_learned *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_learned_decode(
    const uint8_t *data, size_t size, struct rho_message_learned *message);
RHO_MUST_CHECK enum rho_status rho_message_learned_validate(
    const struct rho_message_learned *message, struct rho_message_place *place);
const char *rho_message_learned_field(const struct rho_message_place *place);

/* ---- peak_t ---- */

/* One line that initiation found: x cos(theta) + y sin(theta) = rho. */

#define RHO_MESSAGE_PEAK_FINGERPRINT UINT64_C(0xef4db77f70fed866)
#define RHO_MESSAGE_PEAK_MAX_SIZE 28u

struct rho_message_peak {
    float rho_m; /* signed, m */
    float theta_rad; /* rad; 0 .. 3.1415927 */
    float speed_mps; /* along the line, m/s; 0 .. 1e6 */
    float score_nat; /* logarithm of the likelihood that it is a target against clutter */
    int16_t scans_hit; /* scans of the window that voted for it; 0 .. 32767 */
    int16_t sensor_pairs; /* pairs of sensors that confirm it; 0 for plots; 0 .. 32767 */
};
RHO_MUST_CHECK enum rho_status rho_message_peak_encode(
    const struct rho_message_peak *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_peak_decode(
    const uint8_t *data, size_t size, struct rho_message_peak *message);
RHO_MUST_CHECK enum rho_status rho_message_peak_validate(
    const struct rho_message_peak *message, struct rho_message_place *place);
const char *rho_message_peak_field(const struct rho_message_place *place);

/* ---- plane_row_t ---- */

/* One row of a plane_t: a range of theta. */

#define RHO_MESSAGE_PLANE_ROW_FINGERPRINT UINT64_C(0x2e90f16ccca051ec)
#define RHO_MESSAGE_PLANE_ROW_MAX_SIZE 72u

struct rho_message_plane_row {
    /*
     * from rho_min_m to rho_max_m: the most votes of a cell in each block of cells, 0 .. 127:
     * votes_max
     */
    int8_t votes[64];
};
RHO_MUST_CHECK enum rho_status rho_message_plane_row_encode(
    const struct rho_message_plane_row *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_plane_row_decode(
    const uint8_t *data, size_t size, struct rho_message_plane_row *message);
RHO_MUST_CHECK enum rho_status rho_message_plane_row_validate(
    const struct rho_message_plane_row *message, struct rho_message_place *place);
const char *rho_message_plane_row_field(const struct rho_message_place *place);

/* ---- plot_t ---- */

/* One plot of a plot_scan_t: a place, and what else its kind says. What is not measured is 0. */

#define RHO_MESSAGE_PLOT_FINGERPRINT UINT64_C(0x788ad26d7448d55b)
#define RHO_MESSAGE_PLOT_MAX_SIZE 48u

struct rho_message_plot {
    int32_t dt_us; /* own time after the scan's utime, us; -60000000 .. 60000000 */
    float x_m; /* east, m; -2e6 .. 2e6 */
    float y_m; /* north, m; -2e6 .. 2e6 */
    float z_m; /* up, m; -2e6 .. 2e6 */
    float vx_mps; /* velocity, m/s; -2e4 .. 2e4 */
    float vy_mps; /* -2e4 .. 2e4 */
    float vz_mps; /* -2e4 .. 2e4 */
    float sigma_m; /* sd of the noise, each axis, m; 0: not said; 0 .. 1e5 */
    float sigma_mps; /* sd of the velocity's noise, each axis, m/s; 0: not said; 0 .. 1e5 */
    float snr_db; /* 0 where unknown; passed on, not used; -1000 .. 1000 */
};
RHO_MUST_CHECK enum rho_status rho_message_plot_encode(
    const struct rho_message_plot *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_plot_decode(
    const uint8_t *data, size_t size, struct rho_message_plot *message);
RHO_MUST_CHECK enum rho_status rho_message_plot_validate(
    const struct rho_message_plot *message, struct rho_message_place *place);
const char *rho_message_plot_field(const struct rho_message_place *place);

/* ---- polar_plot_t ---- */

/* One plot of a polar_scan_t, as the radar measures it. What is not measured is 0. */

#define RHO_MESSAGE_POLAR_PLOT_FINGERPRINT UINT64_C(0x5482c658708a4062)
#define RHO_MESSAGE_POLAR_PLOT_MAX_SIZE 32u

struct rho_message_polar_plot {
    int32_t dt_us; /* own time after the scan's utime, us; -60000000 .. 60000000 */
    float range_m; /* slant range; without elevation it counts as ground range, m; 0 .. 2e6 */
    float azimuth_rad; /* counter-clockwise from +x (east), rad; -3.1415927 .. 3.1415927 */
    float elevation_rad; /* up from the horizontal, rad; -1.5707964 .. 1.5707964 */
    float range_rate_mps; /* positive: receding, m/s; -2e4 .. 2e4 */
    float snr_db; /* 0 where unknown; passed on, not used; -1000 .. 1000 */
};
RHO_MUST_CHECK enum rho_status rho_message_polar_plot_encode(
    const struct rho_message_polar_plot *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_polar_plot_decode(
    const uint8_t *data, size_t size, struct rho_message_polar_plot *message);
RHO_MUST_CHECK enum rho_status rho_message_polar_plot_validate(
    const struct rho_message_polar_plot *message, struct rho_message_place *place);
const char *rho_message_polar_plot_field(const struct rho_message_place *place);

/* ---- sensor_t ---- */

/* One sensor of a sensor_list_t: whether it is heard, and whether the other sensors bear it out. */

#define RHO_MESSAGE_SENSOR_FINGERPRINT UINT64_C(0x3384d71d72b4cd6c)
#define RHO_MESSAGE_SENSOR_MAX_SIZE 46u
#define RHO_MESSAGE_SENSOR_PLOTS 1
#define RHO_MESSAGE_SENSOR_POLAR 2
#define RHO_MESSAGE_SENSOR_BEARINGS 3

struct rho_message_sensor {
    int16_t sensor_id;
    /* of its messages; one number may send several kinds; one of PLOTS, POLAR, BEARINGS */
    int8_t kind;
    /*
     * 1: nothing was heard of it for so long (jump_max) that no scan waits for it any more; 0 .. 1
     */
    int8_t is_silent;
    /*
     * 1: its clock is not the common one: its scans are refused until enough of them agree; 0 .. 1
     */
    int8_t is_off_clock;
    /*
     * 1: it contradicts the others: it starts no tracks, its misses say nothing, its plots count
     * little; 0 .. 1
     */
    int8_t is_doubted;
    int32_t scans; /* whose number was believed; stays at 65535; 0 .. 2147483647 */
    /* time of measurement of the newest of them, us; -4000000000000000000 .. 4000000000000000000 */
    int64_t scan_utime;
    /* since that was received, by the receiver's clock; stays at 2147483647; 0 .. 2147483647 */
    int32_t heard_age_us;
    /* from scan to scan, smoothed; 0: not known; stays at 2147483647; 0 .. 2147483647 */
    int32_t interval_us;
    int16_t watched; /* looks that the next one is of; below 12 it says little; 0 .. 32767 */
    int16_t watched_hits; /* plots that the last one is of; below 12 it says little; 0 .. 32767 */
    float seen_share; /* of those tracks where it looked, so many had a plot of it; 0 .. 1 */
    /*
     * their innovations' variance over what its sigmas and the tracks' say: 1 where all is well; 0
     * .. 1e12
     */
    float innovation_factor;
};
RHO_MUST_CHECK enum rho_status rho_message_sensor_encode(
    const struct rho_message_sensor *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_sensor_decode(
    const uint8_t *data, size_t size, struct rho_message_sensor *message);
RHO_MUST_CHECK enum rho_status rho_message_sensor_validate(
    const struct rho_message_sensor *message, struct rho_message_place *place);
const char *rho_message_sensor_field(const struct rho_message_place *place);

/* ---- setting_answer_t ---- */

/* What has become of a setting_t. Channel RHO_SETTING_ANSWERS. */

#define RHO_MESSAGE_SETTING_ANSWER_CHANNEL "RHO_SETTING_ANSWERS"
#define RHO_MESSAGE_SETTING_ANSWER_FINGERPRINT UINT64_C(0x9badd0eed11621c3)
#define RHO_MESSAGE_SETTING_ANSWER_MAX_SIZE 46u
#define RHO_MESSAGE_SETTING_ANSWER_NEVER 0
#define RHO_MESSAGE_SETTING_ANSWER_STEP 1
#define RHO_MESSAGE_SETTING_ANSWER_WINDOW 2
#define RHO_MESSAGE_SETTING_ANSWER_SENSOR 3
#define RHO_MESSAGE_SETTING_ANSWER_PLOT 4

struct rho_message_setting_answer {
    /*
     * of the step after which it was changed or refused, us; -4000000000000000000 ..
     * 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of this step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    int32_t number; /* of the setting_t */
    int16_t field; /* of the setting_t; 0 .. 32767 */
    int8_t status; /* 0: changed; else refused, by enum rho_status of rhotrack/types.h; 0 .. 127 */
    int8_t applies; /* when; one of NEVER, STEP, WINDOW, SENSOR, PLOT */
    int16_t fault_field; /* that would be outside its range, this one or another; 0 .. 32767 */
    float value; /* that the field has; refused: that it would have, or that of the fault's field */
    float min; /* of a fault: the range that is allowed */
    float max;
};
RHO_MUST_CHECK enum rho_status rho_message_setting_answer_encode(
    const struct rho_message_setting_answer *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_setting_answer_decode(
    const uint8_t *data, size_t size, struct rho_message_setting_answer *message);
RHO_MUST_CHECK enum rho_status rho_message_setting_answer_validate(
    const struct rho_message_setting_answer *message, struct rho_message_place *place);
const char *rho_message_setting_answer_field(const struct rho_message_place *place);

/* ---- setting_t ---- */

/*
 * One setting of a tracker that an operator wants another way (struct rho_settings): after the next
 */
/* step it is changed, and answered by setting_answer_t. Channel RHO_SETTINGS. */

#define RHO_MESSAGE_SETTING_CHANNEL "RHO_SETTINGS"
#define RHO_MESSAGE_SETTING_FINGERPRINT UINT64_C(0x54c7e8e8af12efbd)
#define RHO_MESSAGE_SETTING_MAX_SIZE 26u
#define RHO_MESSAGE_SETTING_V_MIN_MPS 1
#define RHO_MESSAGE_SETTING_V_MAX_MPS 2
#define RHO_MESSAGE_SETTING_ACCEL_MAX_MPS2 3
#define RHO_MESSAGE_SETTING_PD 4
#define RHO_MESSAGE_SETTING_SCAN_INTERVAL_S 5
#define RHO_MESSAGE_SETTING_SIGMA_RANGE_M 6
#define RHO_MESSAGE_SETTING_SIGMA_AZIMUTH_RAD 7
#define RHO_MESSAGE_SETTING_SIGMA_ELEVATION_RAD 8
#define RHO_MESSAGE_SETTING_SIGMA_RANGE_RATE_MPS 9
#define RHO_MESSAGE_SETTING_SIGMA_RAD 10
#define RHO_MESSAGE_SETTING_RANGE_MIN_M 11
#define RHO_MESSAGE_SETTING_RANGE_MAX_M 12
#define RHO_MESSAGE_SETTING_SCANS 13
#define RHO_MESSAGE_SETTING_MIN_SCANS 14
#define RHO_MESSAGE_SETTING_COAST_SCANS_MAX 15
#define RHO_MESSAGE_SETTING_FALSE_TRACKS_PER_HOUR 16
#define RHO_MESSAGE_SETTING_WORK_MAX 17

struct rho_message_setting {
    int64_t utime; /* when it was sent, us; -4000000000000000000 .. 4000000000000000000 */
    int32_t number; /* the sender's: the answer repeats it */
    int16_t field; /* which setting; 1 .. 17 */
    float value; /* that it is to have */
};
RHO_MUST_CHECK enum rho_status rho_message_setting_encode(
    const struct rho_message_setting *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_setting_decode(
    const uint8_t *data, size_t size, struct rho_message_setting *message);
RHO_MUST_CHECK enum rho_status rho_message_setting_validate(
    const struct rho_message_setting *message, struct rho_message_place *place);
const char *rho_message_setting_field(const struct rho_message_place *place);

/* ---- status_t ---- */

/* How a tracker is doing: once a second, also when nothing comes. Channel RHO_STATUS. */
/* Counters count since the start and stay at 2147483647. */

#define RHO_MESSAGE_STATUS_CHANNEL "RHO_STATUS"
#define RHO_MESSAGE_STATUS_FINGERPRINT UINT64_C(0xa49e27d2cd6c4484)
#define RHO_MESSAGE_STATUS_MAX_SIZE 146u

struct rho_message_status {
    /* of the last scan that was stepped, us; -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's last step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    int32_t scans_accepted; /* taken for a step, whole or not; 0 .. 2147483647 */
    /* older than one of the same sensor that was taken before; 0 .. 2147483647 */
    int32_t scans_late;
    int32_t scans_duplicate; /* scans or parts of them that were there already; 0 .. 2147483647 */
    /* numbers that were skipped; one that comes after all is late, too; 0 .. 2147483647 */
    int32_t scans_lost;
    /* good messages that contradict the sensor's earlier ones or each other; 0 .. 2147483647 */
    int32_t scans_bad;
    /* not a message of this type: length, count, values, sensor; 0 .. 2147483647 */
    int32_t messages_bad;
    /* another fingerprint: another version, or something else; 0 .. 2147483647 */
    int32_t messages_wrong_type;
    int32_t messages_flooded; /* beyond what one channel may send in a second; 0 .. 2147483647 */
    int32_t frames_incomplete; /* of bearings, a sensor is missing in them; 0 .. 2147483647 */
    int32_t scans_incomplete; /* stepped with parts missing; 0 .. 2147483647 */
    /* datagrams of messages in fragments, or no LCM at all; 0 .. 2147483647 */
    int32_t fragments_refused;
    int32_t clock_jumps; /* scans whose time is far off the common clock; 0 .. 2147483647 */
    int32_t sensor_restarts; /* sensors whose numbers began anew; 0 .. 2147483647 */
    int32_t plots_in; /* 0 .. 2147483647 */
    int32_t plots_claimed; /* updated a track; 0 .. 2147483647 */
    int32_t plots_held; /* kept for initiation; 0 .. 2147483647 */
    int32_t plots_initiated; /* of the held: started a track; 0 .. 2147483647 */
    int32_t plots_clutter; /* of the held: left the window unused; 0 .. 2147483647 */
    int32_t inputs_stale; /* older than what was stepped; 0 .. 2147483647 */
    int32_t inputs_invalid; /* not finite, or beyond the limits; 0 .. 2147483647 */
    int32_t inputs_no_room; /* beyond a capacity; 0 .. 2147483647 */
    int32_t bearings_in; /* of plots_in; 0 .. 2147483647 */
    int32_t ghosts_pruned; /* bearings whose crossings are all false; 0 .. 2147483647 */
    int16_t tracks_tentative; /* 0 .. 32767 */
    int16_t tracks_confirmed; /* 0 .. 32767 */
    int16_t tracks_coasting; /* 0 .. 32767 */
    float step_us; /* mean since the last status, us; 0 .. 1e12 */
    float step_max_us; /* longest since the last status, us; 0 .. 1e12 */
    float clutter_per_km2; /* mean over the area, a scan; 0 .. 1e12 */
    /* of the local frame; all three 0: not said; -900000000 .. 900000000 */
    int32_t origin_lat_1e7deg;
    int32_t origin_lon_1e7deg; /* -1800000000 .. 1800000000 */
    int32_t origin_alt_mm;
};
RHO_MUST_CHECK enum rho_status rho_message_status_encode(
    const struct rho_message_status *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_status_decode(
    const uint8_t *data, size_t size, struct rho_message_status *message);
RHO_MUST_CHECK enum rho_status rho_message_status_validate(
    const struct rho_message_status *message, struct rho_message_place *place);
const char *rho_message_status_field(const struct rho_message_place *place);

/* ---- track_t ---- */

/* One track of a track_list_t, at the list's time. */

#define RHO_MESSAGE_TRACK_FINGERPRINT UINT64_C(0x07ff66dc5ae8b2bd)
#define RHO_MESSAGE_TRACK_MAX_SIZE 153u
#define RHO_MESSAGE_TRACK_TENTATIVE 1
#define RHO_MESSAGE_TRACK_CONFIRMED 2
#define RHO_MESSAGE_TRACK_COASTING 3
#define RHO_MESSAGE_TRACK_DELETED 4

struct rho_message_track {
    int32_t track_id; /* never used twice between two restarts */
    /*
     * DELETED: this list names it for the last time; one of TENTATIVE, CONFIRMED, COASTING, DELETED
     */
    int8_t status;
    int16_t hits; /* looks that updated it; stays at 32767; 0 .. 32767 */
    int16_t misses; /* looks that did not; stays at 32767; 0 .. 32767 */
    int16_t sensor_id; /* of the last update */
    int16_t plot; /* row of the update in this scan, from 0; -1: none; -1 .. 32767 */
    int32_t update_age_us; /* the list's time after the last update's own, us; 0 .. 2147483647 */
    float x_m; /* east, m */
    float y_m; /* north, m */
    float z_m; /* up, m; 0 where not measured */
    float vx_mps; /* velocity, m/s */
    float vy_mps;
    float vz_mps;
    float ax_mps2; /* acceleration, m/s^2; 0 where not estimated */
    float ay_mps2;
    float az_mps2;
    float score_nat; /* logarithm of the likelihood that it is a target against clutter */
    float maneuver_probability; /* 0 .. 1 */
    float covariance[21]; /* of x y z vx vy vz: lower triangle, row by row: xx, yx, yy, zx, ... */
};
RHO_MUST_CHECK enum rho_status rho_message_track_encode(
    const struct rho_message_track *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_track_decode(
    const uint8_t *data, size_t size, struct rho_message_track *message);
RHO_MUST_CHECK enum rho_status rho_message_track_validate(
    const struct rho_message_track *message, struct rho_message_place *place);
const char *rho_message_track_field(const struct rho_message_place *place);

/* ---- truth_t ---- */

/* One target of a truth_list_t, at the list's time. */

#define RHO_MESSAGE_TRUTH_FINGERPRINT UINT64_C(0xa0d66a7393c5ab26)
#define RHO_MESSAGE_TRUTH_MAX_SIZE 36u

struct rho_message_truth {
    int32_t target_id;
    float x_m; /* east, m; -2e6 .. 2e6 */
    float y_m; /* north, m; -2e6 .. 2e6 */
    float z_m; /* up, m; -2e6 .. 2e6 */
    float vx_mps; /* velocity, m/s; -2e4 .. 2e4 */
    float vy_mps; /* -2e4 .. 2e4 */
    float vz_mps; /* -2e4 .. 2e4 */
};
RHO_MUST_CHECK enum rho_status rho_message_truth_encode(
    const struct rho_message_truth *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_truth_decode(
    const uint8_t *data, size_t size, struct rho_message_truth *message);
RHO_MUST_CHECK enum rho_status rho_message_truth_validate(
    const struct rho_message_truth *message, struct rho_message_place *place);
const char *rho_message_truth_field(const struct rho_message_place *place);

/* ---- work_t ---- */

/* Counters of a tracker's limits: on the work of its steps, and on the room of its outputs. */
/* Once a second, with status_t. Channel RHO_WORK. */
/* Counters count since the start and stay at the largest number that they may have. */

#define RHO_MESSAGE_WORK_CHANNEL "RHO_WORK"
#define RHO_MESSAGE_WORK_FINGERPRINT UINT64_C(0x7bc3d15e8fc5de7a)
#define RHO_MESSAGE_WORK_MAX_SIZE 88u

struct rho_message_work {
    /* of the last scan that was stepped, us; -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's last step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    int64_t num_steps; /* made so far; 0 .. 9223372036854775807 */
    int64_t work_max; /* that a step may do; 0: any; 0 .. 9223372036854775807 */
    int64_t work; /* of the last step; 0 .. 9223372036854775807 */
    int64_t work_worst; /* of the worst step; 0 .. 9223372036854775807 */
    int64_t partial_steps; /* steps that left something out; 0 .. 9223372036854775807 */
    int64_t plots_not_tried; /* with all that they might go with; 0 .. 9223372036854775807 */
    int64_t reports_not_printed; /* standard output took no more; 0 .. 9223372036854775807 */
    int64_t events_not_logged; /* the log's disk took no more; 0 .. 9223372036854775807 */
};
RHO_MUST_CHECK enum rho_status rho_message_work_encode(
    const struct rho_message_work *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_work_decode(
    const uint8_t *data, size_t size, struct rho_message_work *message);
RHO_MUST_CHECK enum rho_status rho_message_work_validate(
    const struct rho_message_work *message, struct rho_message_place *place);
const char *rho_message_work_field(const struct rho_message_place *place);

/* ---- zone_event_t ---- */

/* A track that has entered or left a zone. */

#define RHO_MESSAGE_ZONE_EVENT_FINGERPRINT UINT64_C(0xebf884c6671cbd66)
#define RHO_MESSAGE_ZONE_EVENT_MAX_SIZE 26u
#define RHO_MESSAGE_ZONE_EVENT_ENTERS 0
#define RHO_MESSAGE_ZONE_EVENT_LEAVES 1
#define RHO_MESSAGE_ZONE_EVENT_ENDS 2

struct rho_message_zone_event {
    int32_t zone_id;
    int32_t track_id;
    int8_t change; /* one of ENTERS, LEAVES, ENDS */
    int8_t direction; /* 1: along the zone's heading, -1: against it, 0: neither; -1 .. 1 */
    float speed_mps; /* m/s; 0 .. 1e6 */
    float dwell_s; /* since it entered, s; 0 .. 1e9 */
};
RHO_MUST_CHECK enum rho_status rho_message_zone_event_encode(
    const struct rho_message_zone_event *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_zone_event_decode(
    const uint8_t *data, size_t size, struct rho_message_zone_event *message);
RHO_MUST_CHECK enum rho_status rho_message_zone_event_validate(
    const struct rho_message_zone_event *message, struct rho_message_place *place);
const char *rho_message_zone_event_field(const struct rho_message_place *place);

/* ---- zone_t ---- */

/* What one zone has counted. Counters stay at the largest number that they may have. */

#define RHO_MESSAGE_ZONE_FINGERPRINT UINT64_C(0xaaaa5228616ec1c3)
#define RHO_MESSAGE_ZONE_MAX_SIZE 52u

struct rho_message_zone {
    int32_t zone_id;
    int16_t inside; /* tracks in it now; 0 .. 32767 */
    int16_t queued; /* of them in its queue; 0 .. 32767 */
    int32_t entered; /* tracks, since the start; 0 .. 2147483647 */
    int32_t left; /* 0 .. 2147483647 */
    int32_t ended; /* whose track ended inside; 0 .. 2147483647 */
    int32_t along; /* of those that left: along the zone's heading; 0 .. 2147483647 */
    int32_t against; /* 0 .. 2147483647 */
    float speed_mps; /* mean of those inside, m/s; 0 of none; 0 .. 1e6 */
    float queue_m; /* from the first queued track to the last, m; 0 .. 1e9 */
    float dwell_mean_s; /* of those that left, s; 0 .. 1e9 */
    float dwell_max_s; /* 0 .. 1e9 */
};
RHO_MUST_CHECK enum rho_status rho_message_zone_encode(
    const struct rho_message_zone *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_zone_decode(
    const uint8_t *data, size_t size, struct rho_message_zone *message);
RHO_MUST_CHECK enum rho_status rho_message_zone_validate(
    const struct rho_message_zone *message, struct rho_message_place *place);
const char *rho_message_zone_field(const struct rho_message_place *place);

/* ---- accumulator_t ---- */

/*
 * The last search in an accumulator: its plane, and the fullest cells, best first. Sent when asked
 * for. Channel RHO_ACCUMULATOR.
 */

#define RHO_MESSAGE_ACCUMULATOR_CHANNEL "RHO_ACCUMULATOR"
#define RHO_MESSAGE_ACCUMULATOR_FINGERPRINT UINT64_C(0x7786e1b4d8d8a35a)
#define RHO_MESSAGE_ACCUMULATOR_MAX_SIZE 1132u
#define RHO_MESSAGE_ACCUMULATOR_MAX_CELLS 48
#define RHO_MESSAGE_ACCUMULATOR_HT 1
#define RHO_MESSAGE_ACCUMULATOR_MHT 2
#define RHO_MESSAGE_ACCUMULATOR_IHT 3
#define RHO_MESSAGE_ACCUMULATOR_NHT 4
#define RHO_MESSAGE_ACCUMULATOR_PASSIVE_PAPER 5

struct rho_message_accumulator {
    /* of the window's newest scan, us; -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    int8_t method; /* one of HT, MHT, IHT, NHT, PASSIVE_PAPER */
    int8_t has_pair; /* 1: of the crossings of one pair of sensors; 0: of all; 0 .. 1 */
    int16_t sensor_a_id; /* of the pair; 0 without one */
    int16_t sensor_b_id;
    int16_t num_scans; /* of the window; 1 .. 16 */
    /* of the window's oldest scan, us; -4000000000000000000 .. 4000000000000000000 */
    int64_t oldest_utime;
    float origin_x_m; /* rho is the distance from here, m; -2e6 .. 2e6 */
    float origin_y_m; /* -2e6 .. 2e6 */
    float rho_min_m; /* edges of the plane, m */
    float rho_max_m;
    int16_t rho_cells; /* from rho_min_m to rho_max_m; 1 .. 32767 */
    int16_t theta_cells; /* from 0 to pi; 1 .. 32767 */
    float votes_max; /* most votes of a cell; 0 .. 1e9 */
    float votes_min; /* of a cell that is listed; 0 .. 1e9 */
    /*
     * messages of this channel and of RHO_PLANE that were left out for their rate, so far; 0 ..
     * 2147483647
     */
    int32_t not_sent;
    int16_t num_cells_total; /* found; the list has the best of them; 0 .. 32767 */
    int16_t num_cells;
    struct rho_message_accumulator_cell cells[RHO_MESSAGE_ACCUMULATOR_MAX_CELLS];
};

struct rho_message_accumulator_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int8_t method;
    int8_t has_pair;
    int16_t sensor_a_id;
    int16_t sensor_b_id;
    int16_t num_scans;
    int64_t oldest_utime;
    float origin_x_m;
    float origin_y_m;
    float rho_min_m;
    float rho_max_m;
    int16_t rho_cells;
    int16_t theta_cells;
    float votes_max;
    float votes_min;
    int32_t not_sent;
    int16_t num_cells_total;
};
RHO_MUST_CHECK enum rho_status rho_message_accumulator_encode(
    const struct rho_message_accumulator *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_accumulator_decode(
    const uint8_t *data, size_t size, struct rho_message_accumulator *message);
RHO_MUST_CHECK enum rho_status rho_message_accumulator_validate(
    const struct rho_message_accumulator *message, struct rho_message_place *place);
const char *rho_message_accumulator_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_accumulator_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_accumulator_head *head);
RHO_MUST_CHECK enum rho_status rho_message_accumulator_add(
    struct rho_message_writer *writer, const struct rho_message_accumulator_cell *cell);

/* ---- bearing_scan_t ---- */

/* Bearings of one look of one passive sensor. Channel RHO_BEARINGS_<sensor_id>. */

#define RHO_MESSAGE_BEARING_SCAN_CHANNEL "RHO_BEARINGS_" /* and the sensor's number */
#define RHO_MESSAGE_BEARING_SCAN_FINGERPRINT UINT64_C(0x66d140164191753b)
#define RHO_MESSAGE_BEARING_SCAN_MAX_SIZE 1064u
#define RHO_MESSAGE_BEARING_SCAN_MAX_BEARING_RAD 256

struct rho_message_bearing_scan {
    /*
     * time of measurement, us of the sensors' common clock; -4000000000000000000 ..
     * 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of this look, one more each; after 2147483647 comes -2147483648 */
    int32_t epoch; /* the sender's boot number: another one after each restart */
    int16_t sensor_id; /* the number in the channel's name */
    float sensor_x_m; /* the sensor's place, the same at every look, m; -2e6 .. 2e6 */
    float sensor_y_m; /* -2e6 .. 2e6 */
    float sigma_rad; /* sd of the noise, rad; 0: not said; 0 .. 0.5 */
    int16_t num_bearings;
    /* to the targets, counter-clockwise from +x (east), rad; -3.1415927 .. 3.1415927 */
    float bearing_rad[RHO_MESSAGE_BEARING_SCAN_MAX_BEARING_RAD];
};

struct rho_message_bearing_scan_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int16_t sensor_id;
    float sensor_x_m;
    float sensor_y_m;
    float sigma_rad;
};
RHO_MUST_CHECK enum rho_status rho_message_bearing_scan_encode(
    const struct rho_message_bearing_scan *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_bearing_scan_decode(
    const uint8_t *data, size_t size, struct rho_message_bearing_scan *message);
RHO_MUST_CHECK enum rho_status rho_message_bearing_scan_validate(
    const struct rho_message_bearing_scan *message, struct rho_message_place *place);
const char *rho_message_bearing_scan_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_bearing_scan_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_bearing_scan_head *head);
RHO_MUST_CHECK enum rho_status rho_message_bearing_scan_add(
    struct rho_message_writer *writer, const float *bearing_rad);

/* ---- body_list_t ---- */

/*
 * The bodies of tracks after one step of a tracker that was told how long targets may be, or a part
 */
/* of them; tracks of which no two plots came in one scan have none. Channel RHO_BODIES. */

#define RHO_MESSAGE_BODY_LIST_CHANNEL "RHO_BODIES"
#define RHO_MESSAGE_BODY_LIST_FINGERPRINT UINT64_C(0xd468c7e7b0d084a9)
#define RHO_MESSAGE_BODY_LIST_MAX_SIZE 1374u
#define RHO_MESSAGE_BODY_LIST_MAX_BODIES 24

struct rho_message_body_list {
    /* of the scan that was stepped, us; -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    int16_t part; /* which part of the list this is, from 0; 0 .. num_parts - 1 */
    int16_t num_parts; /* of the list; an empty list has one; 1 .. 32767 */
    int16_t num_bodies; /* in this part */
    struct rho_message_body bodies[RHO_MESSAGE_BODY_LIST_MAX_BODIES];
};

struct rho_message_body_list_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int16_t part;
    int16_t num_parts;
};
RHO_MUST_CHECK enum rho_status rho_message_body_list_encode(
    const struct rho_message_body_list *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_body_list_decode(
    const uint8_t *data, size_t size, struct rho_message_body_list *message);
RHO_MUST_CHECK enum rho_status rho_message_body_list_validate(
    const struct rho_message_body_list *message, struct rho_message_place *place);
const char *rho_message_body_list_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_body_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_body_list_head *head);
RHO_MUST_CHECK enum rho_status rho_message_body_list_add(
    struct rho_message_writer *writer, const struct rho_message_body *bodie);

/* ---- clutter_map_t ---- */

/*
 * Echoes that a tracker knows: clutter that comes back to its place; or a part of them, every few
 * seconds. Channel RHO_CLUTTER.
 */

#define RHO_MESSAGE_CLUTTER_MAP_CHANNEL "RHO_CLUTTER"
#define RHO_MESSAGE_CLUTTER_MAP_FINGERPRINT UINT64_C(0x62c5de2aae95967f)
#define RHO_MESSAGE_CLUTTER_MAP_MAX_SIZE 1392u
#define RHO_MESSAGE_CLUTTER_MAP_MAX_ECHOES 40

struct rho_message_clutter_map {
    /* of the last scan that was stepped, us; -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's last step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    int16_t num_echoes_total; /* of all parts; 0 .. 32767 */
    int16_t part; /* which part of the list this is, from 0; 0 .. num_parts - 1 */
    int16_t num_parts; /* of the list; an empty list has one; 1 .. 32767 */
    int16_t num_echoes; /* in this part */
    struct rho_message_echo echoes[RHO_MESSAGE_CLUTTER_MAP_MAX_ECHOES];
};

struct rho_message_clutter_map_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int16_t num_echoes_total;
    int16_t part;
    int16_t num_parts;
};
RHO_MUST_CHECK enum rho_status rho_message_clutter_map_encode(
    const struct rho_message_clutter_map *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_clutter_map_decode(
    const uint8_t *data, size_t size, struct rho_message_clutter_map *message);
RHO_MUST_CHECK enum rho_status rho_message_clutter_map_validate(
    const struct rho_message_clutter_map *message, struct rho_message_place *place);
const char *rho_message_clutter_map_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_clutter_map_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_clutter_map_head *head);
RHO_MUST_CHECK enum rho_status rho_message_clutter_map_add(
    struct rho_message_writer *writer, const struct rho_message_echo *echoe);

/* ---- ghost_matrix_t ---- */

/*
 * The ghost matrix of the newest scans of two passive sensors; or a part of it. Sent when asked
 * for. Channel RHO_GHOSTS.
 */

#define RHO_MESSAGE_GHOST_MATRIX_CHANNEL "RHO_GHOSTS"
#define RHO_MESSAGE_GHOST_MATRIX_FINGERPRINT UINT64_C(0xb0ea8488a0c3ed35)
#define RHO_MESSAGE_GHOST_MATRIX_MAX_SIZE 1389u
#define RHO_MESSAGE_GHOST_MATRIX_MAX_ELEMENTS 78
#define RHO_MESSAGE_GHOST_MATRIX_NO_RULE 0
#define RHO_MESSAGE_GHOST_MATRIX_LITERAL 1
#define RHO_MESSAGE_GHOST_MATRIX_SAFE 2

struct rho_message_ghost_matrix {
    int64_t utime; /* of the frame, us; -4000000000000000000 .. 4000000000000000000 */
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    int16_t sensor_a_id; /* rows */
    int16_t sensor_b_id; /* columns */
    float sensor_a_x_m; /* place, east, m; -2e6 .. 2e6 */
    float sensor_a_y_m; /* north, m; -2e6 .. 2e6 */
    float sensor_b_x_m; /* -2e6 .. 2e6 */
    float sensor_b_y_m; /* -2e6 .. 2e6 */
    float range_max_m; /* of both sensors, m; 0 .. 1e9 */
    int8_t rule; /* of pruning; one of NO_RULE, LITERAL, SAFE */
    int16_t num_rows; /* bearings of sensor a; 0 .. 255 */
    int16_t num_columns; /* bearings of sensor b; 0 .. 255 */
    /* messages of this channel that were left out for its rate, so far; 0 .. 2147483647 */
    int32_t not_sent;
    int16_t part; /* which part of the matrix this is, from 0; 0 .. num_parts - 1 */
    int16_t num_parts; /* of the matrix; an empty one has one; 1 .. 32767 */
    int16_t num_elements; /* in this part; row by row */
    struct rho_message_ghost elements[RHO_MESSAGE_GHOST_MATRIX_MAX_ELEMENTS];
};

struct rho_message_ghost_matrix_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int16_t sensor_a_id;
    int16_t sensor_b_id;
    float sensor_a_x_m;
    float sensor_a_y_m;
    float sensor_b_x_m;
    float sensor_b_y_m;
    float range_max_m;
    int8_t rule;
    int16_t num_rows;
    int16_t num_columns;
    int32_t not_sent;
    int16_t part;
    int16_t num_parts;
};
RHO_MUST_CHECK enum rho_status rho_message_ghost_matrix_encode(
    const struct rho_message_ghost_matrix *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_ghost_matrix_decode(
    const uint8_t *data, size_t size, struct rho_message_ghost_matrix *message);
RHO_MUST_CHECK enum rho_status rho_message_ghost_matrix_validate(
    const struct rho_message_ghost_matrix *message, struct rho_message_place *place);
const char *rho_message_ghost_matrix_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_ghost_matrix_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_ghost_matrix_head *head);
RHO_MUST_CHECK enum rho_status rho_message_ghost_matrix_add(
    struct rho_message_writer *writer, const struct rho_message_ghost *element);

/* ---- hypotheses_t ---- */

/*
 * Of one track: its score, its motion models, the evidence of its last look, and its hypotheses,
 * best first. Sent when asked for. Channel RHO_HYPOTHESES.
 */
/*
 * support, shared and clutter are truth, indeterminacy and falsity of neutrosophic sets, and add up
 * to 1. With evidence PLOTS a
 */
/*
 * plot in the track's gate has the probability p to be the target's, before plots are given to one
 * track each, and r is how much
 */
/*
 * likelier it is this track's than another's. With evidence LINE they are of the cell by which a
 * neutrosophic Hough transform
 */
/* started the track: shares of its sums C_T, C_I and C_F. */

#define RHO_MESSAGE_HYPOTHESES_CHANNEL "RHO_HYPOTHESES"
#define RHO_MESSAGE_HYPOTHESES_FINGERPRINT UINT64_C(0xe526c2edcb9c898f)
#define RHO_MESSAGE_HYPOTHESES_MAX_SIZE 303u
#define RHO_MESSAGE_HYPOTHESES_MAX_HYPOTHESES 8
#define RHO_MESSAGE_HYPOTHESES_NO_EVIDENCE 0
#define RHO_MESSAGE_HYPOTHESES_PLOTS 1
#define RHO_MESSAGE_HYPOTHESES_LINE 2

struct rho_message_hypotheses {
    int64_t utime; /* of the step, us; -4000000000000000000 .. 4000000000000000000 */
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    int32_t track_id; /* as in RHO_TRACKS */
    float score_nat;
    /* probabilities of the motion models, which add up to 1: flies straight for minutes; 0 .. 1 */
    float calm;
    float steady; /* flies straight, and may turn soon; 0 .. 1 */
    float maneuver; /* manoeuvres; 0 .. 1 */
    /*
     * PLOTS: of the plots of this step; LINE: of the line by which it started in this step;
     * NO_EVIDENCE: not looked at, or not known; one of NO_EVIDENCE, PLOTS, LINE
     */
    int8_t evidence;
    float support; /* evidence that is the track's own: sum of p r over its plots; C_T; 0 .. 1 */
    /* evidence that other tracks or lines claim, too: sum of p (1 - r); C_I; 0 .. 1 */
    float shared;
    float clutter; /* that none of it is the target's: 1 - sum of p; C_F; 0 .. 1 */
    /* messages of this channel that were left out for its rate, so far; 0 .. 2147483647 */
    int32_t not_sent;
    int16_t num_hypotheses;
    struct rho_message_hypothesis hypotheses[RHO_MESSAGE_HYPOTHESES_MAX_HYPOTHESES];
};

struct rho_message_hypotheses_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int32_t track_id;
    float score_nat;
    float calm;
    float steady;
    float maneuver;
    int8_t evidence;
    float support;
    float shared;
    float clutter;
    int32_t not_sent;
};
RHO_MUST_CHECK enum rho_status rho_message_hypotheses_encode(
    const struct rho_message_hypotheses *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_hypotheses_decode(
    const uint8_t *data, size_t size, struct rho_message_hypotheses *message);
RHO_MUST_CHECK enum rho_status rho_message_hypotheses_validate(
    const struct rho_message_hypotheses *message, struct rho_message_place *place);
const char *rho_message_hypotheses_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_hypotheses_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_hypotheses_head *head);
RHO_MUST_CHECK enum rho_status rho_message_hypotheses_add(
    struct rho_message_writer *writer, const struct rho_message_hypothesis *hypothese);

/* ---- peak_list_t ---- */

/* The best candidates of the last search for new tracks, best first. Channel RHO_PEAKS. */

#define RHO_MESSAGE_PEAK_LIST_CHANNEL "RHO_PEAKS"
#define RHO_MESSAGE_PEAK_LIST_FINGERPRINT UINT64_C(0x68f79b7c84f4d541)
#define RHO_MESSAGE_PEAK_LIST_MAX_SIZE 982u
#define RHO_MESSAGE_PEAK_LIST_MAX_PEAKS 48

struct rho_message_peak_list {
    /* of the scan that was stepped, us; -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int16_t num_peaks;
    struct rho_message_peak peaks[RHO_MESSAGE_PEAK_LIST_MAX_PEAKS];
};

struct rho_message_peak_list_head {
    int64_t utime;
    int32_t scan;
};
RHO_MUST_CHECK enum rho_status rho_message_peak_list_encode(
    const struct rho_message_peak_list *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_peak_list_decode(
    const uint8_t *data, size_t size, struct rho_message_peak_list *message);
RHO_MUST_CHECK enum rho_status rho_message_peak_list_validate(
    const struct rho_message_peak_list *message, struct rho_message_place *place);
const char *rho_message_peak_list_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_peak_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_peak_list_head *head);
RHO_MUST_CHECK enum rho_status rho_message_peak_list_add(
    struct rho_message_writer *writer, const struct rho_message_peak *peak);

/* ---- plane_t ---- */

/*
 * The plane of an accumulator_t of the same scan and pair, made small; a part of it. Sent when
 * asked for. Channel RHO_PLANE.
 */

#define RHO_MESSAGE_PLANE_CHANNEL "RHO_PLANE"
#define RHO_MESSAGE_PLANE_FINGERPRINT UINT64_C(0x3c33f233bec2f5b4)
#define RHO_MESSAGE_PLANE_MAX_SIZE 1064u
#define RHO_MESSAGE_PLANE_MAX_ROWS 16

struct rho_message_plane {
    /*
     * as in the accumulator_t, as all that follow, us; -4000000000000000000 .. 4000000000000000000
     */
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int8_t method; /* 1 .. 5 */
    int8_t has_pair; /* 0 .. 1 */
    int16_t sensor_a_id;
    int16_t sensor_b_id;
    float votes_max; /* that 127 in the rows stands for; 0 .. 1e9 */
    int16_t part; /* which part of the rows this is, from 0; 0 .. num_parts - 1 */
    int16_t num_parts; /* of the rows, at most 64, from theta 0 to pi; 1 .. 32767 */
    int16_t num_rows; /* in this part */
    struct rho_message_plane_row rows[RHO_MESSAGE_PLANE_MAX_ROWS];
};

struct rho_message_plane_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int8_t method;
    int8_t has_pair;
    int16_t sensor_a_id;
    int16_t sensor_b_id;
    float votes_max;
    int16_t part;
    int16_t num_parts;
};
RHO_MUST_CHECK enum rho_status rho_message_plane_encode(
    const struct rho_message_plane *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_plane_decode(
    const uint8_t *data, size_t size, struct rho_message_plane *message);
RHO_MUST_CHECK enum rho_status rho_message_plane_validate(
    const struct rho_message_plane *message, struct rho_message_place *place);
const char *rho_message_plane_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_plane_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_plane_head *head);
RHO_MUST_CHECK enum rho_status rho_message_plane_add(
    struct rho_message_writer *writer, const struct rho_message_plane_row *row);

/* ---- plot_scan_t ---- */

/* Plots of one look of one sensor, or a part of them. Channel RHO_PLOTS_<sensor_id>. */

#define RHO_MESSAGE_PLOT_SCAN_CHANNEL "RHO_PLOTS_" /* and the sensor's number */
#define RHO_MESSAGE_PLOT_SCAN_FINGERPRINT UINT64_C(0x0ec35bb85bc4cbde)
#define RHO_MESSAGE_PLOT_SCAN_MAX_SIZE 1401u
#define RHO_MESSAGE_PLOT_SCAN_POSITION_2D 2
#define RHO_MESSAGE_PLOT_SCAN_POSITION_3D 3
#define RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_2D 4
#define RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_3D 6
#define RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS 34

struct rho_message_plot_scan {
    /*
     * time of measurement, us of the sensors' common clock; -4000000000000000000 ..
     * 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of this look, one more each; after 2147483647 comes -2147483648 */
    int32_t epoch; /* the sender's boot number: another one after each restart */
    int16_t sensor_id; /* the number in the channel's name */
    /*
     * what the plots measure; one of POSITION_2D, POSITION_3D, POSITION_VELOCITY_2D,
     * POSITION_VELOCITY_3D
     */
    int8_t kind;
    int16_t part; /* which part of the scan this is, from 0; 0 .. num_parts - 1 */
    int16_t num_parts; /* of the scan; 1 .. 32767 */
    /* looked at, counter-clockwise from here; rad from +x (east); -6.2831855 .. 6.2831855 */
    float sector_from_rad;
    float sector_to_rad; /* to here; both 0: the whole circle; -6.2831855 .. 6.2831855 */
    int16_t num_plots; /* in this part */
    struct rho_message_plot plots[RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS];
};

struct rho_message_plot_scan_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int16_t sensor_id;
    int8_t kind;
    int16_t part;
    int16_t num_parts;
    float sector_from_rad;
    float sector_to_rad;
};
RHO_MUST_CHECK enum rho_status rho_message_plot_scan_encode(
    const struct rho_message_plot_scan *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_plot_scan_decode(
    const uint8_t *data, size_t size, struct rho_message_plot_scan *message);
RHO_MUST_CHECK enum rho_status rho_message_plot_scan_validate(
    const struct rho_message_plot_scan *message, struct rho_message_place *place);
const char *rho_message_plot_scan_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_plot_scan_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_plot_scan_head *head);
RHO_MUST_CHECK enum rho_status rho_message_plot_scan_add(
    struct rho_message_writer *writer, const struct rho_message_plot *plot);

/* ---- polar_scan_t ---- */

/* Polar plots of one look of one radar, or a part of them. Channel RHO_POLAR_<sensor_id>. */

#define RHO_MESSAGE_POLAR_SCAN_CHANNEL "RHO_POLAR_" /* and the sensor's number */
#define RHO_MESSAGE_POLAR_SCAN_FINGERPRINT UINT64_C(0x0570bdbf57d4a221)
#define RHO_MESSAGE_POLAR_SCAN_MAX_SIZE 1366u
#define RHO_MESSAGE_POLAR_SCAN_MAX_POLAR_PLOTS 54

struct rho_message_polar_scan {
    /*
     * time of measurement, us of the sensors' common clock; -4000000000000000000 ..
     * 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of this look, one more each; after 2147483647 comes -2147483648 */
    int32_t epoch; /* the sender's boot number: another one after each restart */
    int16_t sensor_id; /* the number in the channel's name */
    int8_t has_elevation; /* 1: the plots' elevations count; 0 .. 1 */
    int8_t has_range_rate; /* 1: the plots' range rates count; 0 .. 1 */
    int16_t part; /* which part of the scan this is, from 0; 0 .. num_parts - 1 */
    int16_t num_parts; /* of the scan; 1 .. 32767 */
    float sensor_x_m; /* the radar's place, m; -2e6 .. 2e6 */
    float sensor_y_m; /* -2e6 .. 2e6 */
    float sensor_z_m; /* -2e6 .. 2e6 */
    float sigma_range_m; /* sd of the noise, m; 0: not said; 0 .. 1e5 */
    float sigma_azimuth_rad; /* rad; 0: not said; 0 .. 0.5 */
    float sigma_elevation_rad; /* rad; 0: not said; 0 .. 0.5 */
    float sigma_range_rate_mps; /* m/s; 0: not said; 0 .. 1e5 */
    /* looked at, counter-clockwise from here; rad from +x (east); -6.2831855 .. 6.2831855 */
    float sector_from_rad;
    float sector_to_rad; /* to here; both 0: the whole circle; -6.2831855 .. 6.2831855 */
    int16_t num_polar_plots; /* in this part */
    struct rho_message_polar_plot polar_plots[RHO_MESSAGE_POLAR_SCAN_MAX_POLAR_PLOTS];
};

struct rho_message_polar_scan_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int16_t sensor_id;
    int8_t has_elevation;
    int8_t has_range_rate;
    int16_t part;
    int16_t num_parts;
    float sensor_x_m;
    float sensor_y_m;
    float sensor_z_m;
    float sigma_range_m;
    float sigma_azimuth_rad;
    float sigma_elevation_rad;
    float sigma_range_rate_mps;
    float sector_from_rad;
    float sector_to_rad;
};
RHO_MUST_CHECK enum rho_status rho_message_polar_scan_encode(
    const struct rho_message_polar_scan *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_polar_scan_decode(
    const uint8_t *data, size_t size, struct rho_message_polar_scan *message);
RHO_MUST_CHECK enum rho_status rho_message_polar_scan_validate(
    const struct rho_message_polar_scan *message, struct rho_message_place *place);
const char *rho_message_polar_scan_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_polar_scan_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_polar_scan_head *head);
RHO_MUST_CHECK enum rho_status rho_message_polar_scan_add(
    struct rho_message_writer *writer, const struct rho_message_polar_plot *polar_plot);

/* ---- sensor_list_t ---- */

/*
 * How the sensors are doing that a tracker hears, or a part of them: once a second, with status_t.
 * Channel RHO_SENSORS.
 */

#define RHO_MESSAGE_SENSOR_LIST_CHANNEL "RHO_SENSORS"
#define RHO_MESSAGE_SENSOR_LIST_FINGERPRINT UINT64_C(0x573b8d1ed41bb0ea)
#define RHO_MESSAGE_SENSOR_LIST_MAX_SIZE 1400u
#define RHO_MESSAGE_SENSOR_LIST_MAX_SENSORS 36

struct rho_message_sensor_list {
    /* of the last scan that was stepped, us; -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's last step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    int16_t num_sensors_total; /* of all parts; 0 .. 32767 */
    int16_t part; /* which part of the list this is, from 0; 0 .. num_parts - 1 */
    int16_t num_parts; /* of the list; an empty list has one; 1 .. 32767 */
    int16_t num_sensors; /* in this part */
    struct rho_message_sensor sensors[RHO_MESSAGE_SENSOR_LIST_MAX_SENSORS];
};

struct rho_message_sensor_list_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int16_t num_sensors_total;
    int16_t part;
    int16_t num_parts;
};
RHO_MUST_CHECK enum rho_status rho_message_sensor_list_encode(
    const struct rho_message_sensor_list *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_sensor_list_decode(
    const uint8_t *data, size_t size, struct rho_message_sensor_list *message);
RHO_MUST_CHECK enum rho_status rho_message_sensor_list_validate(
    const struct rho_message_sensor_list *message, struct rho_message_place *place);
const char *rho_message_sensor_list_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_sensor_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_sensor_list_head *head);
RHO_MUST_CHECK enum rho_status rho_message_sensor_list_add(
    struct rho_message_writer *writer, const struct rho_message_sensor *sensor);

/* ---- track_list_t ---- */

/* The tracks after one step of the tracker, or a part of them. Channel RHO_TRACKS. */

#define RHO_MESSAGE_TRACK_LIST_CHANNEL "RHO_TRACKS"
#define RHO_MESSAGE_TRACK_LIST_FINGERPRINT UINT64_C(0x50afcc23bcd9a625)
#define RHO_MESSAGE_TRACK_LIST_MAX_SIZE 1337u
#define RHO_MESSAGE_TRACK_LIST_MAX_TRACKS 9

struct rho_message_track_list {
    /* of the scan that was stepped, us; -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's step, one more each */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    int16_t num_tracks_total; /* of all parts; 0 .. 32767 */
    int16_t part; /* which part of the list this is, from 0; 0 .. num_parts - 1 */
    int16_t num_parts; /* of the list; an empty list has one; 1 .. 32767 */
    int16_t num_tracks; /* in this part */
    struct rho_message_track tracks[RHO_MESSAGE_TRACK_LIST_MAX_TRACKS];
};

struct rho_message_track_list_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int16_t num_tracks_total;
    int16_t part;
    int16_t num_parts;
};
RHO_MUST_CHECK enum rho_status rho_message_track_list_encode(
    const struct rho_message_track_list *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_track_list_decode(
    const uint8_t *data, size_t size, struct rho_message_track_list *message);
RHO_MUST_CHECK enum rho_status rho_message_track_list_validate(
    const struct rho_message_track_list *message, struct rho_message_place *place);
const char *rho_message_track_list_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_track_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_track_list_head *head);
RHO_MUST_CHECK enum rho_status rho_message_track_list_add(
    struct rho_message_writer *writer, const struct rho_message_track *track);

/* ---- truth_list_t ---- */

/*
 * Where the targets of a simulation or a trial really were, or a part of them. Channel RHO_TRUTH.
 */

#define RHO_MESSAGE_TRUTH_LIST_CHANNEL "RHO_TRUTH"
#define RHO_MESSAGE_TRUTH_LIST_FINGERPRINT UINT64_C(0x36f25f198a476da8)
#define RHO_MESSAGE_TRUTH_LIST_MAX_SIZE 1426u
#define RHO_MESSAGE_TRUTH_LIST_MAX_TARGETS 50

struct rho_message_truth_list {
    /* us of the sensors' common clock; -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the list, one more each */
    int16_t part; /* which part of the list this is, from 0; 0 .. num_parts - 1 */
    int16_t num_parts; /* of the list; 1 .. 32767 */
    int16_t num_targets; /* in this part */
    struct rho_message_truth targets[RHO_MESSAGE_TRUTH_LIST_MAX_TARGETS];
};

struct rho_message_truth_list_head {
    int64_t utime;
    int32_t scan;
    int16_t part;
    int16_t num_parts;
};
RHO_MUST_CHECK enum rho_status rho_message_truth_list_encode(
    const struct rho_message_truth_list *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_truth_list_decode(
    const uint8_t *data, size_t size, struct rho_message_truth_list *message);
RHO_MUST_CHECK enum rho_status rho_message_truth_list_validate(
    const struct rho_message_truth_list *message, struct rho_message_place *place);
const char *rho_message_truth_list_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_truth_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_truth_list_head *head);
RHO_MUST_CHECK enum rho_status rho_message_truth_list_add(
    struct rho_message_writer *writer, const struct rho_message_truth *target);

/* ---- zone_event_list_t ---- */

/*
 * Tracks that have entered and left zones in one step; of a step without any there is no message.
 */
/* Channel RHO_ZONE_EVENTS. */

#define RHO_MESSAGE_ZONE_EVENT_LIST_CHANNEL "RHO_ZONE_EVENTS"
#define RHO_MESSAGE_ZONE_EVENT_LIST_FINGERPRINT UINT64_C(0x4945d33ac51d2c5c)
#define RHO_MESSAGE_ZONE_EVENT_LIST_MAX_SIZE 1178u
#define RHO_MESSAGE_ZONE_EVENT_LIST_MAX_EVENTS 64

struct rho_message_zone_event_list {
    int64_t utime; /* of the step, us; -4000000000000000000 .. 4000000000000000000 */
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    int16_t num_events;
    struct rho_message_zone_event events[RHO_MESSAGE_ZONE_EVENT_LIST_MAX_EVENTS];
};

struct rho_message_zone_event_list_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
};
RHO_MUST_CHECK enum rho_status rho_message_zone_event_list_encode(
    const struct rho_message_zone_event_list *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_zone_event_list_decode(
    const uint8_t *data, size_t size, struct rho_message_zone_event_list *message);
RHO_MUST_CHECK enum rho_status rho_message_zone_event_list_validate(
    const struct rho_message_zone_event_list *message, struct rho_message_place *place);
const char *rho_message_zone_event_list_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_zone_event_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_zone_event_list_head *head);
RHO_MUST_CHECK enum rho_status rho_message_zone_event_list_add(
    struct rho_message_writer *writer, const struct rho_message_zone_event *event);

/* ---- zone_list_t ---- */

/* What the tracker's zones have counted. Once a second, with status_t. Channel RHO_ZONES. */

#define RHO_MESSAGE_ZONE_LIST_CHANNEL "RHO_ZONES"
#define RHO_MESSAGE_ZONE_LIST_FINGERPRINT UINT64_C(0xe6266bbc90e0975c)
#define RHO_MESSAGE_ZONE_LIST_MAX_SIZE 1350u
#define RHO_MESSAGE_ZONE_LIST_MAX_ZONES 30

struct rho_message_zone_list {
    int64_t utime; /* of the last step, us; -4000000000000000000 .. 4000000000000000000 */
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    /* of steps with more than zone_event_list_t holds, since the start; 0 .. 2147483647 */
    int32_t events_dropped;
    int16_t num_zones;
    struct rho_message_zone zones[RHO_MESSAGE_ZONE_LIST_MAX_ZONES];
};

struct rho_message_zone_list_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int32_t events_dropped;
};
RHO_MUST_CHECK enum rho_status rho_message_zone_list_encode(
    const struct rho_message_zone_list *message, uint8_t *buffer, size_t capacity, size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_zone_list_decode(
    const uint8_t *data, size_t size, struct rho_message_zone_list *message);
RHO_MUST_CHECK enum rho_status rho_message_zone_list_validate(
    const struct rho_message_zone_list *message, struct rho_message_place *place);
const char *rho_message_zone_list_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_zone_list_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_zone_list_head *head);
RHO_MUST_CHECK enum rho_status rho_message_zone_list_add(
    struct rho_message_writer *writer, const struct rho_message_zone *zone);

#ifdef __cplusplus
}
#endif

#endif
