/* SPDX-License-Identifier: MIT */
/* Made by tools/codegen from lcm_types/. Not to be edited: `make codegen`. */
/* clang-format off */
/*
 * message: encodes structs as LCM messages of rhotrack, and decodes them. No heap, liblcm or state.
 *
 * A message is a fingerprint (8 bytes, different for each struct and version) and the members in
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
 *   rho_message_S_validate  tests that all values are finite, in their ranges, and one of their
 *                           constants. Errors: NULL, COUNT, VALUE; *place (may be NULL) tells the
 *                           member, and rho_message_S_field its name.
 * and where S ends with a list, to write a message without a copy of the list:
 *   rho_message_S_begin     the members before the count (struct rho_message_S_head) go to the
 *                           buffer. Errors: NULL, CAPACITY; *writer is unchanged, and is not to be
 *                           added to.
 *   rho_message_S_add       adds one element. Errors: NULL, STATE (not begun, or begun as another
 *                           struct), CAPACITY (of the buffer or the list); the message so far stays
 *                           whole.
 *   rho_message_end         returns the message's length, and empties the writer.
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
    RHO_MESSAGE_TYPE_DIRECTION,
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
    RHO_MESSAGE_TYPE_TRACK_LIFE,
    RHO_MESSAGE_TYPE_TRACK,
    RHO_MESSAGE_TYPE_TRUTH,
    RHO_MESSAGE_TYPE_WORK,
    RHO_MESSAGE_TYPE_ZONE_EVENT,
    RHO_MESSAGE_TYPE_ZONE,
    RHO_MESSAGE_TYPE_ACCUMULATOR,
    RHO_MESSAGE_TYPE_BEARING_SCAN,
    RHO_MESSAGE_TYPE_BODY_LIST,
    RHO_MESSAGE_TYPE_CLUTTER_MAP,
    RHO_MESSAGE_TYPE_DIRECTION_SCAN,
    RHO_MESSAGE_TYPE_GHOST_MATRIX,
    RHO_MESSAGE_TYPE_HYPOTHESES,
    RHO_MESSAGE_TYPE_LIFE,
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

/* Place of the first member that a validate function refuses. */
struct rho_message_place {
    uint16_t offset; /* offset of the member in its struct, bytes */
    int16_t element; /* index of the list element that has the member; -1: it is before the list */
};

/* A message that is written element by element; the buffer holds a whole message at any time. */
struct rho_message_writer {
    uint8_t *buffer;
    size_t capacity, size; /* bytes of the buffer, and of the message so far */
    uint64_t fingerprint;
    uint16_t count; /* list elements written so far */
};

/* Type of a message by its fingerprint; RHO_NUM_MESSAGE_TYPES: an unknown one. Constant cost. */
enum rho_message_type rho_message_type_of(const uint8_t *data, size_t size);

/* Fingerprint and name ("plot_scan_t") of a message type; 0 and "unknown" for any other value. */
uint64_t rho_message_fingerprint(enum rho_message_type type);
const char *rho_message_type_name(enum rho_message_type type);

/* Ends a message; *size: its length. Errors: NULL, STATE (not begun). Constant cost. */
RHO_MUST_CHECK enum rho_status rho_message_end(struct rho_message_writer *writer, size_t *size);

/*
 * accumulator_cell_t: one of the fullest cells of an accumulator_t: the line x cos(theta) + y
 * sin(theta) = rho.
 */

#define RHO_MESSAGE_ACCUMULATOR_CELL_FINGERPRINT UINT64_C(0x7dc022df7b25d931)
#define RHO_MESSAGE_ACCUMULATOR_CELL_MAX_SIZE 30u

struct rho_message_accumulator_cell {
    /* signed distance of the cell's line from the accumulator's origin, at the cell's centre, m */
    float rho_m;
    /* angle of the normal of the cell's line, at the cell's centre, rad; range 0 .. 6.3 */
    float theta_rad;
    /* votes of the cell; of a neutrosophic transform the sum of memberships; range 0 .. 1e9 */
    float votes;
    /*
     * bit m is set where scan m of the window voted for the cell, 0 the oldest; 0: not known; range
     * 0 .. 65535
     */
    int32_t scan_mask;
    /* plots or crossings that voted for the cell; stays at 32767; range 0 .. 32767 */
    int16_t plots;
    /* track that the cell's line started in this step; 0: it started none; range 0 .. 2147483647 */
    int32_t track_id;
};
RHO_MUST_CHECK enum rho_status rho_message_accumulator_cell_encode(
    const struct rho_message_accumulator_cell *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_accumulator_cell_decode(
    const uint8_t *data, size_t size, struct rho_message_accumulator_cell *message);
RHO_MUST_CHECK enum rho_status rho_message_accumulator_cell_validate(
    const struct rho_message_accumulator_cell *message, struct rho_message_place *place);
const char *rho_message_accumulator_cell_field(const struct rho_message_place *place);

/* body_t: the body of one track: a rectangle, its length along the heading. */

#define RHO_MESSAGE_BODY_FINGERPRINT UINT64_C(0xc79ba5919c3bcda2)
#define RHO_MESSAGE_BODY_MAX_SIZE 64u

struct rho_message_body {
    int32_t track_id; /* identity of the body's track, as in RHO_TRACKS */
    float x_m; /* centre of the body, east, m */
    float y_m; /* centre of the body, north, m */
    float reference_x_m; /* track's position in RHO_TRACKS, the mean of the body's plots, east, m */
    /* track's position in RHO_TRACKS, the mean of the body's plots, north, m */
    float reference_y_m;
    float length_m; /* length of the body along its heading, m; range 0 .. 1e5 */
    float width_m; /* width of the body across its heading, m; range 0 .. 1e5 */
    float heading_rad; /* heading of the body, counter-clockwise from +x, rad; range -4 .. 4 */
    float sigma_length_m; /* standard deviation of the length, m; range 0 .. 1e5 */
    float sigma_width_m; /* standard deviation of the width, m; range 0 .. 1e5 */
    float sigma_heading_rad; /* standard deviation of the heading, rad; range 0 .. 10 */
    /* standard deviation of the centre from the reference, along the heading, m; range 0 .. 1e5 */
    float sigma_along_m;
    /* standard deviation of the centre from the reference, across the heading, m; range 0 .. 1e5 */
    float sigma_across_m;
    float plots; /* number of plots that the body's size and heading come from; range 0 .. 1e9 */
};
RHO_MUST_CHECK enum rho_status rho_message_body_encode(
    const struct rho_message_body *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_body_decode(
    const uint8_t *data, size_t size, struct rho_message_body *message);
RHO_MUST_CHECK enum rho_status rho_message_body_validate(
    const struct rho_message_body *message, struct rho_message_place *place);
const char *rho_message_body_field(const struct rho_message_place *place);

/* command_answer_t: outcome of a command_t. Channel RHO_COMMAND_ANSWERS. */

#define RHO_MESSAGE_COMMAND_ANSWER_CHANNEL "RHO_COMMAND_ANSWERS"
#define RHO_MESSAGE_COMMAND_ANSWER_FINGERPRINT UINT64_C(0x7eb8e21727770191)
#define RHO_MESSAGE_COMMAND_ANSWER_MAX_SIZE 34u

struct rho_message_command_answer {
    /*
     * time of the step after which the command was done or refused, us; range -4000000000000000000
     * .. 4000000000000000000
     */
    int64_t utime;
    /* number of the tracker's step after which the command was done, as in RHO_TRACKS */
    int32_t scan;
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    int32_t number; /* number of the answered command */
    int8_t action; /* action of the answered command; range 1 .. 127 */
    /*
     * 0: the command was done; else it was refused, by enum rho_status of rhotrack/types.h; range 0
     * .. 127
     */
    int8_t status;
    /* track that the command started or changed; 0: none; range 0 .. 2147483647 */
    int32_t track_id;
};
RHO_MUST_CHECK enum rho_status rho_message_command_answer_encode(
    const struct rho_message_command_answer *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_command_answer_decode(
    const uint8_t *data, size_t size, struct rho_message_command_answer *message);
RHO_MUST_CHECK enum rho_status rho_message_command_answer_validate(
    const struct rho_message_command_answer *message, struct rho_message_place *place);
const char *rho_message_command_answer_field(const struct rho_message_place *place);

/*
 * command_t: an operator's command to a tracker, which does it after the next step, and answers by
 * a command_answer_t. Members that an action does not use are 0. Channel RHO_COMMANDS.
 */

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
    /* time at which the command was sent, us; range -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t number; /* the sender's number of the command, which the answer repeats */
    /* what the tracker is to do; one of START, DROP, RENUMBER, FREEZE, THAW, EXCLUDE, INCLUDE */
    int8_t action;
    int32_t track_id; /* track of DROP, RENUMBER, FREEZE or THAW; range 0 .. 2147483647 */
    int32_t new_id; /* new identity of the track, for RENUMBER; range 0 .. 2147483647 */
    /*
     * position for START or INCLUDE, lower limit of the area for EXCLUDE, east, m; range -2e6 ..
     * 2e6
     */
    float x_m;
    /*
     * position for START or INCLUDE, lower limit of the area for EXCLUDE, north, m; range -2e6 ..
     * 2e6
     */
    float y_m;
    float x_max_m; /* upper limit of the area for EXCLUDE, east, m; range -2e6 .. 2e6 */
    float y_max_m; /* upper limit of the area for EXCLUDE, north, m; range -2e6 .. 2e6 */
    float sigma_m; /* standard deviation of the position for START, m; range 0 .. 1e5 */
    float vx_mps; /* velocity for START, east, m/s; range -2e4 .. 2e4 */
    float vy_mps; /* velocity for START, north, m/s; range -2e4 .. 2e4 */
    /*
     * standard deviation of the velocity for START, m/s; 0: the velocity is not known; range 0 ..
     * 1e5
     */
    float sigma_mps;
};
RHO_MUST_CHECK enum rho_status rho_message_command_encode(
    const struct rho_message_command *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_command_decode(
    const uint8_t *data, size_t size, struct rho_message_command *message);
RHO_MUST_CHECK enum rho_status rho_message_command_validate(
    const struct rho_message_command *message, struct rho_message_place *place);
const char *rho_message_command_field(const struct rho_message_place *place);

/*
 * direction_t: one direction of a direction_scan_t: a bearing, and an elevation where one is
 * measured.
 */

#define RHO_MESSAGE_DIRECTION_FINGERPRINT UINT64_C(0x4cdcf82c8a90b605)
#define RHO_MESSAGE_DIRECTION_MAX_SIZE 25u

struct rho_message_direction {
    /* the direction's own time after the scan's utime, us; range -60000000 .. 60000000 */
    int32_t dt_us;
    /*
     * bearing to the target, counter-clockwise from +x (east), rad; range -3.1415927 .. 3.1415927
     */
    float bearing_rad;
    /* elevation of the target, up from the horizontal, rad; range -1.5707964 .. 1.5707964 */
    float elevation_rad;
    /* signal-to-noise ratio, dB; passed on, not used; 0: not known; range -1000 .. 1000 */
    float snr_db;
    int8_t has_elevation; /* 1: the elevation is measured; 0: only the bearing is; range 0 .. 1 */
};
RHO_MUST_CHECK enum rho_status rho_message_direction_encode(
    const struct rho_message_direction *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_direction_decode(
    const uint8_t *data, size_t size, struct rho_message_direction *message);
RHO_MUST_CHECK enum rho_status rho_message_direction_validate(
    const struct rho_message_direction *message, struct rho_message_place *place);
const char *rho_message_direction_field(const struct rho_message_place *place);

/*
 * echo_t: one echo of a clutter_map_t: an object that gave clutter plots again and again in its
 * place.
 */

#define RHO_MESSAGE_ECHO_FINGERPRINT UINT64_C(0xd5072401d660f823)
#define RHO_MESSAGE_ECHO_MAX_SIZE 42u

struct rho_message_echo {
    int16_t sensor_id; /* sensor that sees the echo; -1: its number is beyond int16_t */
    int16_t hits; /* plots that the echo gave; stays at 32767; range 1 .. 32767 */
    /* scans of the sensor over the echo's place since its last plot; range 0 .. 32767 */
    int16_t unseen;
    /* position of the echo when the sensor looked there last, east, m; range -2e6 .. 2e6 */
    float x_m;
    /* position of the echo when the sensor looked there last, north, m; range -2e6 .. 2e6 */
    float y_m;
    float vx_mps; /* velocity of the echo, east, m/s; 0: it stands; range -2e4 .. 2e4 */
    float vy_mps; /* velocity of the echo, north, m/s; 0: it stands; range -2e4 .. 2e4 */
    /*
     * standard deviation of the echo's position along the sensor's line of sight, m; range 0 .. 1e6
     */
    float sigma_range_m;
    /*
     * standard deviation of the echo's position across the sensor's line of sight, m; range 0 ..
     * 1e6
     */
    float sigma_cross_m;
    /* probability that the sensor's next look there gives a plot of the echo; range 0 .. 1 */
    float chance;
};
RHO_MUST_CHECK enum rho_status rho_message_echo_encode(
    const struct rho_message_echo *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_echo_decode(
    const uint8_t *data, size_t size, struct rho_message_echo *message);
RHO_MUST_CHECK enum rho_status rho_message_echo_validate(
    const struct rho_message_echo *message, struct rho_message_place *place);
const char *rho_message_echo_field(const struct rho_message_place *place);

/* ghost_t: one element of a ghost_matrix_t: the crossing of two bearings. */

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
    /*
     * bearing of sensor a, its place among those that no track had claimed, from 0; range 0 ..
     * 32767
     */
    int16_t row;
    /*
     * bearing of sensor b, its place among those that no track had claimed, from 0; range 0 ..
     * 32767
     */
    int16_t column;
    /*
     * why the crossing was pruned: bearings on different sides of the base, diverging bearings,
     * beyond range_max_m, another bearing's only crossing in the row or column, in no complete
     * matching; one of KEPT, SIDES, APART, RANGE, ROW, COLUMN, UNMATCHED
     */
    int8_t reason;
    /*
     * angle between the two bearings before pruning; 0 or less where they diverge, -pi on different
     * sides of the base; range -3.15 .. 3.15
     */
    float delta_rad;
    float x_m; /* position of the crossing, east, m; 0 where there is none within range_max_m */
    float y_m; /* position of the crossing, north, m; 0 where there is none within range_max_m */
};
RHO_MUST_CHECK enum rho_status rho_message_ghost_encode(
    const struct rho_message_ghost *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_ghost_decode(
    const uint8_t *data, size_t size, struct rho_message_ghost *message);
RHO_MUST_CHECK enum rho_status rho_message_ghost_validate(
    const struct rho_message_ghost *message, struct rho_message_place *place);
const char *rho_message_ghost_field(const struct rho_message_place *place);

/*
 * hypothesis_t: one hypothesis of a hypotheses_t: plots that may be the track's, and the target's
 * state by them.
 */

#define RHO_MESSAGE_HYPOTHESIS_FINGERPRINT UINT64_C(0xf01a62a086282722)
#define RHO_MESSAGE_HYPOTHESIS_MAX_SIZE 38u

struct rho_message_hypothesis {
    /* probability of the hypothesis among all of the track; they add up to 1; range 0 .. 1 */
    float share;
    float x_m; /* position of the target at the track's last look, east, m */
    float y_m; /* position of the target at the track's last look, north, m */
    float vx_mps; /* velocity of the target, east, m/s */
    float vy_mps; /* velocity of the target, north, m/s */
    float maneuver_probability; /* probability that the target manoeuvres; range 0 .. 1 */
    /*
     * rows of the plots of the hypothesis in the track's last three looks, the newest last; -1: no
     * plot; -2: not known
     */
    int16_t plots[3];
};
RHO_MUST_CHECK enum rho_status rho_message_hypothesis_encode(
    const struct rho_message_hypothesis *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_hypothesis_decode(
    const uint8_t *data, size_t size, struct rho_message_hypothesis *message);
RHO_MUST_CHECK enum rho_status rho_message_hypothesis_validate(
    const struct rho_message_hypothesis *message, struct rho_message_place *place);
const char *rho_message_hypothesis_field(const struct rho_message_place *place);

/*
 * learned_t: noise and detection probability that the tracker has learned for one described sensor,
 * and uses. One message a second, of each sensor in turn, with status_t. Channel RHO_LEARNED.
 */

#define RHO_MESSAGE_LEARNED_CHANNEL "RHO_LEARNED"
#define RHO_MESSAGE_LEARNED_FINGERPRINT UINT64_C(0x267a29e3c0e96835)
#define RHO_MESSAGE_LEARNED_MAX_SIZE 72u

struct rho_message_learned {
    /*
     * time of the last scan that was stepped, us; range -4000000000000000000 .. 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of the tracker's last step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    int16_t sensor_id; /* number of the sensor */
    /*
     * number of innovations that the noise factors come from; 0: no factor is learned; range 0 ..
     * 32767
     */
    int16_t innovations;
    /* learned noise in range, over the stated sigma of range; range 0 .. 100 */
    float sigma_range_factor;
    /* learned noise across the line of sight, over the stated sigma across; range 0 .. 100 */
    float sigma_cross_factor;
    /*
     * number of looks that the detection probabilities come from, in all rings; range 0 ..
     * 2147483647
     */
    int32_t looks;
    float range_max_m; /* outer edge of the last ring, m; range 0 .. 1e9 */
    float pd_stated; /* stated detection probability of the sensor; range 0 .. 1 */
    /*
     * learned detection probability of each ring, the innermost first; pd_stated where it is within
     * a tenth of it; range 0 .. 1
     */
    float pd[6];
};
RHO_MUST_CHECK enum rho_status rho_message_learned_encode(
    const struct rho_message_learned *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_learned_decode(
    const uint8_t *data, size_t size, struct rho_message_learned *message);
RHO_MUST_CHECK enum rho_status rho_message_learned_validate(
    const struct rho_message_learned *message, struct rho_message_place *place);
const char *rho_message_learned_field(const struct rho_message_place *place);

/* peak_t: one line that initiation found: x cos(theta) + y sin(theta) = rho. */

#define RHO_MESSAGE_PEAK_FINGERPRINT UINT64_C(0xef4db77f70fed866)
#define RHO_MESSAGE_PEAK_MAX_SIZE 28u

struct rho_message_peak {
    float rho_m; /* signed distance of the line from the origin of the frame, m */
    float theta_rad; /* angle of the line's normal, rad; range 0 .. 3.1415927 */
    float speed_mps; /* speed of the candidate along the line, m/s; range 0 .. 1e6 */
    float score_nat; /* logarithm of the likelihood ratio of a target against clutter */
    int16_t scans_hit; /* scans of the window that voted for the candidate; range 0 .. 32767 */
    /* pairs of sensors that confirm the candidate; 0 for plots; range 0 .. 32767 */
    int16_t sensor_pairs;
};
RHO_MUST_CHECK enum rho_status rho_message_peak_encode(
    const struct rho_message_peak *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_peak_decode(
    const uint8_t *data, size_t size, struct rho_message_peak *message);
RHO_MUST_CHECK enum rho_status rho_message_peak_validate(
    const struct rho_message_peak *message, struct rho_message_place *place);
const char *rho_message_peak_field(const struct rho_message_place *place);

/* plane_row_t: one row of a plane_t: the votes of a range of theta. */

#define RHO_MESSAGE_PLANE_ROW_FINGERPRINT UINT64_C(0x2e90f16ccca051ec)
#define RHO_MESSAGE_PLANE_ROW_MAX_SIZE 72u

struct rho_message_plane_row {
    /*
     * largest votes of a cell in each of 64 blocks from rho_min_m to rho_max_m; 127 stands for
     * votes_max
     */
    int8_t votes[64];
};
RHO_MUST_CHECK enum rho_status rho_message_plane_row_encode(
    const struct rho_message_plane_row *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_plane_row_decode(
    const uint8_t *data, size_t size, struct rho_message_plane_row *message);
RHO_MUST_CHECK enum rho_status rho_message_plane_row_validate(
    const struct rho_message_plane_row *message, struct rho_message_place *place);
const char *rho_message_plane_row_field(const struct rho_message_place *place);

/*
 * plot_t: one plot of a plot_scan_t: a position, and the other values that its kind states.
 * Unmeasured values are 0.
 */

#define RHO_MESSAGE_PLOT_FINGERPRINT UINT64_C(0x788ad26d7448d55b)
#define RHO_MESSAGE_PLOT_MAX_SIZE 48u

struct rho_message_plot {
    int32_t dt_us; /* the plot's own time after the scan's utime, us; range -60000000 .. 60000000 */
    float x_m; /* position of the plot, east, m; range -2e6 .. 2e6 */
    float y_m; /* position of the plot, north, m; range -2e6 .. 2e6 */
    float z_m; /* position of the plot, up, m; range -2e6 .. 2e6 */
    float vx_mps; /* velocity of the plot, east, m/s; range -2e4 .. 2e4 */
    float vy_mps; /* velocity of the plot, north, m/s; range -2e4 .. 2e4 */
    float vz_mps; /* velocity of the plot, up, m/s; range -2e4 .. 2e4 */
    /* standard deviation of the position's noise on each axis, m; 0: not stated; range 0 .. 1e5 */
    float sigma_m;
    /*
     * standard deviation of the velocity's noise on each axis, m/s; 0: not stated; range 0 .. 1e5
     */
    float sigma_mps;
    /*
     * signal-to-noise ratio of the plot, dB; passed on, not used; 0: not known; range -1000 .. 1000
     */
    float snr_db;
};
RHO_MUST_CHECK enum rho_status rho_message_plot_encode(
    const struct rho_message_plot *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_plot_decode(
    const uint8_t *data, size_t size, struct rho_message_plot *message);
RHO_MUST_CHECK enum rho_status rho_message_plot_validate(
    const struct rho_message_plot *message, struct rho_message_place *place);
const char *rho_message_plot_field(const struct rho_message_place *place);

/*
 * polar_plot_t: one plot of a polar_scan_t, as the radar measures it. Values that are not measured
 * are 0.
 */

#define RHO_MESSAGE_POLAR_PLOT_FINGERPRINT UINT64_C(0x5482c658708a4062)
#define RHO_MESSAGE_POLAR_PLOT_MAX_SIZE 32u

struct rho_message_polar_plot {
    int32_t dt_us; /* the plot's own time after the scan's utime, us; range -60000000 .. 60000000 */
    /* slant range of the plot; without elevation it counts as ground range, m; range 0 .. 2e6 */
    float range_m;
    /* azimuth of the plot, counter-clockwise from +x (east), rad; range -3.1415927 .. 3.1415927 */
    float azimuth_rad;
    /* elevation of the plot, up from the horizontal, rad; range -1.5707964 .. 1.5707964 */
    float elevation_rad;
    /* range rate of the plot, positive where it recedes, m/s; range -2e4 .. 2e4 */
    float range_rate_mps;
    /*
     * signal-to-noise ratio of the plot, dB; passed on, not used; 0: not known; range -1000 .. 1000
     */
    float snr_db;
};
RHO_MUST_CHECK enum rho_status rho_message_polar_plot_encode(
    const struct rho_message_polar_plot *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_polar_plot_decode(
    const uint8_t *data, size_t size, struct rho_message_polar_plot *message);
RHO_MUST_CHECK enum rho_status rho_message_polar_plot_validate(
    const struct rho_message_polar_plot *message, struct rho_message_place *place);
const char *rho_message_polar_plot_field(const struct rho_message_place *place);

/*
 * sensor_t: state of one sensor in a sensor_list_t: whether it is heard, and whether the other
 * sensors confirm it.
 */

#define RHO_MESSAGE_SENSOR_FINGERPRINT UINT64_C(0x3384d71d72b4cd6c)
#define RHO_MESSAGE_SENSOR_MAX_SIZE 46u
#define RHO_MESSAGE_SENSOR_PLOTS 1
#define RHO_MESSAGE_SENSOR_POLAR 2
#define RHO_MESSAGE_SENSOR_BEARINGS 3

struct rho_message_sensor {
    int16_t sensor_id; /* number of the sensor */
    /*
     * kind of the sensor's messages; one number may send several kinds; one of PLOTS, POLAR,
     * BEARINGS
     */
    int8_t kind;
    /*
     * 1: the sensor was not heard for so long (jump_max) that no scan waits for it any more; range
     * 0 .. 1
     */
    int8_t is_silent;
    /*
     * 1: the sensor's clock is not the common one: its scans are refused until enough of them
     * agree; range 0 .. 1
     */
    int8_t is_off_clock;
    /*
     * 1: the sensor contradicts the others: it starts no tracks, its misses are ignored, its plots
     * count little; range 0 .. 1
     */
    int8_t is_doubted;
    int32_t scans; /* accepted scans of the sensor; stays at 65535; range 0 .. 2147483647 */
    /*
     * time of measurement of the sensor's newest accepted scan, us; range -4000000000000000000 ..
     * 4000000000000000000
     */
    int64_t scan_utime;
    /*
     * time since the sensor's newest accepted scan was received; stays at 2147483647, us; range 0
     * .. 2147483647
     */
    int32_t heard_age_us;
    /*
     * smoothed time between scans of the sensor, us; 0: not known; stays at 2147483647; range 0 ..
     * 2147483647
     */
    int32_t interval_us;
    /* looks of the sensor that seen_share comes from; below 12 it says little; range 0 .. 32767 */
    int16_t watched;
    /*
     * plots of the sensor that innovation_factor comes from; below 12 it says little; range 0 ..
     * 32767
     */
    int16_t watched_hits;
    /* share of the confirmed tracks in the sensor's view of which it gave a plot; range 0 .. 1 */
    float seen_share;
    /*
     * variance of the sensor's innovations over the variance that its sigmas and the tracks'
     * predict: 1 where all is well; range 0 .. 1e12
     */
    float innovation_factor;
};
RHO_MUST_CHECK enum rho_status rho_message_sensor_encode(
    const struct rho_message_sensor *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_sensor_decode(
    const uint8_t *data, size_t size, struct rho_message_sensor *message);
RHO_MUST_CHECK enum rho_status rho_message_sensor_validate(
    const struct rho_message_sensor *message, struct rho_message_place *place);
const char *rho_message_sensor_field(const struct rho_message_place *place);

/* setting_answer_t: outcome of a setting_t. Channel RHO_SETTING_ANSWERS. */

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
     * time of the step after which the setting was changed or refused, us; range
     * -4000000000000000000 .. 4000000000000000000
     */
    int64_t utime;
    /* number of the tracker's step after which the setting was changed, as in RHO_TRACKS */
    int32_t scan;
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    int32_t number; /* number of the answered setting_t */
    int16_t field; /* field of the answered setting_t; range 0 .. 32767 */
    /*
     * 0: the setting was changed; else it was refused, by enum rho_status of rhotrack/types.h;
     * range 0 .. 127
     */
    int8_t status;
    int8_t applies; /* when the change takes effect; one of NEVER, STEP, WINDOW, SENSOR, PLOT */
    /*
     * field that would be outside its range, the answered one or another; 0: none; range 0 .. 32767
     */
    int16_t fault_field;
    /*
     * new value of the field; refused: the value that was asked for, or that of the fault's field
     */
    float value;
    float min; /* lower limit of the fault's field */
    float max; /* upper limit of the fault's field */
};
RHO_MUST_CHECK enum rho_status rho_message_setting_answer_encode(
    const struct rho_message_setting_answer *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_setting_answer_decode(
    const uint8_t *data, size_t size, struct rho_message_setting_answer *message);
RHO_MUST_CHECK enum rho_status rho_message_setting_answer_validate(
    const struct rho_message_setting_answer *message, struct rho_message_place *place);
const char *rho_message_setting_answer_field(const struct rho_message_place *place);

/*
 * setting_t: an operator's change of one parameter of a tracker (struct rho_settings), made after
 * the next step, and answered by a setting_answer_t. Channel RHO_SETTINGS.
 */

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
#define RHO_MESSAGE_SETTING_STANDING 18

struct rho_message_setting {
    /* time at which the setting was sent, us; range -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t number; /* the sender's number of the setting, which the answer repeats */
    int16_t field; /* parameter that is to be set; range 1 .. 18 */
    float value; /* new value of the parameter */
};
RHO_MUST_CHECK enum rho_status rho_message_setting_encode(
    const struct rho_message_setting *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_setting_decode(
    const uint8_t *data, size_t size, struct rho_message_setting *message);
RHO_MUST_CHECK enum rho_status rho_message_setting_validate(
    const struct rho_message_setting *message, struct rho_message_place *place);
const char *rho_message_setting_field(const struct rho_message_place *place);

/*
 * status_t: status of a tracker: once a second, also when no message comes. Channel RHO_STATUS.
 * Counters count since the start and stay at 2147483647.
 */

#define RHO_MESSAGE_STATUS_CHANNEL "RHO_STATUS"
#define RHO_MESSAGE_STATUS_FINGERPRINT UINT64_C(0xa49e27d2cd6c4484)
#define RHO_MESSAGE_STATUS_MAX_SIZE 146u

struct rho_message_status {
    /*
     * time of the last scan that was stepped, us; range -4000000000000000000 .. 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of the tracker's last step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    /* scans that were accepted for a step, complete or not; range 0 .. 2147483647 */
    int32_t scans_accepted;
    /* scans older than an accepted scan of the same sensor; range 0 .. 2147483647 */
    int32_t scans_late;
    /* scans, or parts of scans, that had been received before; range 0 .. 2147483647 */
    int32_t scans_duplicate;
    /*
     * scan numbers that were skipped; one that comes after all is counted in scans_late, too; range
     * 0 .. 2147483647
     */
    int32_t scans_lost;
    /*
     * valid messages that contradict the sensor's earlier ones, or other parts of their scan; range
     * 0 .. 2147483647
     */
    int32_t scans_bad;
    /*
     * messages that are invalid: length, count, a value or the sensor's number; range 0 ..
     * 2147483647
     */
    int32_t messages_bad;
    /*
     * messages of another fingerprint: of another version, or of another type; range 0 ..
     * 2147483647
     */
    int32_t messages_wrong_type;
    /* messages beyond what one channel may send in a second; range 0 .. 2147483647 */
    int32_t messages_flooded;
    /* 0: bearings are no longer put into frames; range 0 .. 2147483647 */
    int32_t frames_incomplete;
    /* scans that were stepped with parts missing; range 0 .. 2147483647 */
    int32_t scans_incomplete;
    /*
     * datagrams refused as fragments of longer messages, or as no LCM at all; range 0 .. 2147483647
     */
    int32_t fragments_refused;
    int32_t clock_jumps; /* scans whose time is far off the common clock; range 0 .. 2147483647 */
    /* restarts of sensors, whose numbers began anew; range 0 .. 2147483647 */
    int32_t sensor_restarts;
    int32_t plots_in; /* plots and bearings that came in; range 0 .. 2147483647 */
    int32_t plots_claimed; /* plots and bearings that updated a track; range 0 .. 2147483647 */
    /* plots and bearings that were kept for initiation; range 0 .. 2147483647 */
    int32_t plots_held;
    /* held plots and bearings that started a track; range 0 .. 2147483647 */
    int32_t plots_initiated;
    /* held plots and bearings that left the window unused; range 0 .. 2147483647 */
    int32_t plots_clutter;
    /* plots and bearings of scans older than the steps made; range 0 .. 2147483647 */
    int32_t inputs_stale;
    /* plots and bearings that are not finite, or outside the limits; range 0 .. 2147483647 */
    int32_t inputs_invalid;
    int32_t inputs_no_room; /* plots and bearings beyond a capacity; range 0 .. 2147483647 */
    /* bearings that came in; plots_in counts them, too; range 0 .. 2147483647 */
    int32_t bearings_in;
    int32_t ghosts_pruned; /* bearings whose crossings are all false; range 0 .. 2147483647 */
    int16_t tracks_tentative; /* tentative tracks, with those in doubt; range 0 .. 32767 */
    int16_t tracks_confirmed; /* number of confirmed tracks; range 0 .. 32767 */
    int16_t tracks_coasting; /* number of coasting tracks; range 0 .. 32767 */
    float step_us; /* mean duration of a step since the last status, us; range 0 .. 1e12 */
    float step_max_us; /* longest duration of a step since the last status, us; range 0 .. 1e12 */
    /* mean density of clutter plots in a scan, over the area, 1/km^2; range 0 .. 1e12 */
    float clutter_per_km2;
    /*
     * latitude of the local frame's origin, 1e-7 degrees; origin all 0: not stated; range
     * -900000000 .. 900000000
     */
    int32_t origin_lat_1e7deg;
    /* longitude of the local frame's origin, 1e-7 degrees; range -1800000000 .. 1800000000 */
    int32_t origin_lon_1e7deg;
    int32_t origin_alt_mm; /* altitude of the local frame's origin, mm */
};
RHO_MUST_CHECK enum rho_status rho_message_status_encode(
    const struct rho_message_status *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_status_decode(
    const uint8_t *data, size_t size, struct rho_message_status *message);
RHO_MUST_CHECK enum rho_status rho_message_status_validate(
    const struct rho_message_status *message, struct rho_message_place *place);
const char *rho_message_status_field(const struct rho_message_place *place);

/* track_life_t: one track of a life_t: whether its target exists, and whether it is visible. */

#define RHO_MESSAGE_TRACK_LIFE_FINGERPRINT UINT64_C(0x3de08f55ed583a47)
#define RHO_MESSAGE_TRACK_LIFE_MAX_SIZE 20u

struct rho_message_track_life {
    int32_t track_id; /* identity of the track, as in track_t */
    float existence; /* probability that the target exists, visible or hidden; range 0 .. 1 */
    float visibility; /* probability that the target exists and is visible; range 0 .. 1 */
};
RHO_MUST_CHECK enum rho_status rho_message_track_life_encode(
    const struct rho_message_track_life *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_track_life_decode(
    const uint8_t *data, size_t size, struct rho_message_track_life *message);
RHO_MUST_CHECK enum rho_status rho_message_track_life_validate(
    const struct rho_message_track_life *message, struct rho_message_place *place);
const char *rho_message_track_life_field(const struct rho_message_place *place);

/* track_t: one track of a track_list_t, at the list's time. */

#define RHO_MESSAGE_TRACK_FINGERPRINT UINT64_C(0x07ff66dc5ae8b2bd)
#define RHO_MESSAGE_TRACK_MAX_SIZE 153u
#define RHO_MESSAGE_TRACK_TENTATIVE 1
#define RHO_MESSAGE_TRACK_CONFIRMED 2
#define RHO_MESSAGE_TRACK_COASTING 3
#define RHO_MESSAGE_TRACK_DELETED 4

struct rho_message_track {
    int32_t track_id; /* identity of the track, never used twice between two restarts */
    /*
     * state of the track; DELETED: it has ended, and this list names it for the last time; one of
     * TENTATIVE, CONFIRMED, COASTING, DELETED
     */
    int8_t status;
    int16_t hits; /* looks that updated the track; stays at 32767; range 0 .. 32767 */
    int16_t misses; /* looks that missed the track; stays at 32767; range 0 .. 32767 */
    int16_t sensor_id; /* sensor of the track's last update */
    /* row of the plot that updated the track in this scan, from 0; -1: none; range -1 .. 32767 */
    int16_t plot;
    /* time from the track's last update to the list's time, us; range 0 .. 2147483647 */
    int32_t update_age_us;
    float x_m; /* position of the track, east, m */
    float y_m; /* position of the track, north, m */
    float z_m; /* position of the track, up, m; 0 where not measured */
    float vx_mps; /* velocity of the track, east, m/s */
    float vy_mps; /* velocity of the track, north, m/s */
    float vz_mps; /* velocity of the track, up, m/s */
    float ax_mps2; /* acceleration of the track, east, m/s^2; 0 where not estimated */
    float ay_mps2; /* acceleration of the track, north, m/s^2; 0 where not estimated */
    float az_mps2; /* acceleration of the track, up, m/s^2; 0 where not estimated */
    float score_nat; /* track score, log-likelihood ratio of target against clutter */
    float maneuver_probability; /* probability that the target manoeuvres; range 0 .. 1 */
    /* covariance of x y z vx vy vz: lower triangle, row by row: xx, yx, yy, zx, ... */
    float covariance[21];
};
RHO_MUST_CHECK enum rho_status rho_message_track_encode(
    const struct rho_message_track *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_track_decode(
    const uint8_t *data, size_t size, struct rho_message_track *message);
RHO_MUST_CHECK enum rho_status rho_message_track_validate(
    const struct rho_message_track *message, struct rho_message_place *place);
const char *rho_message_track_field(const struct rho_message_place *place);

/* truth_t: one target of a truth_list_t, at the list's time. */

#define RHO_MESSAGE_TRUTH_FINGERPRINT UINT64_C(0xa0d66a7393c5ab26)
#define RHO_MESSAGE_TRUTH_MAX_SIZE 36u

struct rho_message_truth {
    int32_t target_id; /* identity of the target */
    float x_m; /* true position of the target, east, m; range -2e6 .. 2e6 */
    float y_m; /* true position of the target, north, m; range -2e6 .. 2e6 */
    float z_m; /* true position of the target, up, m; range -2e6 .. 2e6 */
    float vx_mps; /* true velocity of the target, east, m/s; range -2e4 .. 2e4 */
    float vy_mps; /* true velocity of the target, north, m/s; range -2e4 .. 2e4 */
    float vz_mps; /* true velocity of the target, up, m/s; range -2e4 .. 2e4 */
};
RHO_MUST_CHECK enum rho_status rho_message_truth_encode(
    const struct rho_message_truth *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_truth_decode(
    const uint8_t *data, size_t size, struct rho_message_truth *message);
RHO_MUST_CHECK enum rho_status rho_message_truth_validate(
    const struct rho_message_truth *message, struct rho_message_place *place);
const char *rho_message_truth_field(const struct rho_message_place *place);

/*
 * work_t: counters of a tracker's limits: on the work of its steps, and on the room of its outputs.
 * Once a second, with status_t. Channel RHO_WORK. Counters count since the start and stay at their
 * largest value.
 */

#define RHO_MESSAGE_WORK_CHANNEL "RHO_WORK"
#define RHO_MESSAGE_WORK_FINGERPRINT UINT64_C(0x7bc3d15e8fc5de7a)
#define RHO_MESSAGE_WORK_MAX_SIZE 88u

struct rho_message_work {
    /*
     * time of the last scan that was stepped, us; range -4000000000000000000 .. 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of the tracker's last step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    int64_t num_steps; /* number of steps made so far; range 0 .. 9223372036854775807 */
    /* limit on the work of a step, units; 0: no limit; range 0 .. 9223372036854775807 */
    int64_t work_max;
    int64_t work; /* work of the last step, units; range 0 .. 9223372036854775807 */
    int64_t work_worst; /* largest work of a step, units; range 0 .. 9223372036854775807 */
    /* steps that left something out for their limit of work; range 0 .. 9223372036854775807 */
    int64_t partial_steps;
    /*
     * plots that a limit of work kept from being tried with all tracks or kernels; range 0 ..
     * 9223372036854775807
     */
    int64_t plots_not_tried;
    /* reports that standard output had no room for; range 0 .. 9223372036854775807 */
    int64_t reports_not_printed;
    /* messages that the log's disk had no room for; range 0 .. 9223372036854775807 */
    int64_t events_not_logged;
};
RHO_MUST_CHECK enum rho_status rho_message_work_encode(
    const struct rho_message_work *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_work_decode(
    const uint8_t *data, size_t size, struct rho_message_work *message);
RHO_MUST_CHECK enum rho_status rho_message_work_validate(
    const struct rho_message_work *message, struct rho_message_place *place);
const char *rho_message_work_field(const struct rho_message_place *place);

/* zone_event_t: a track that has entered or left a zone. */

#define RHO_MESSAGE_ZONE_EVENT_FINGERPRINT UINT64_C(0xebf884c6671cbd66)
#define RHO_MESSAGE_ZONE_EVENT_MAX_SIZE 26u
#define RHO_MESSAGE_ZONE_EVENT_ENTERS 0
#define RHO_MESSAGE_ZONE_EVENT_LEAVES 1
#define RHO_MESSAGE_ZONE_EVENT_ENDS 2

struct rho_message_zone_event {
    int32_t zone_id; /* identity of the zone */
    int32_t track_id; /* identity of the track */
    int8_t change; /* what the track did; one of ENTERS, LEAVES, ENDS */
    /*
     * direction of the track: 1 along the zone's heading, -1 against it, 0 neither; range -1 .. 1
     */
    int8_t direction;
    float speed_mps; /* speed of the track, m/s; range 0 .. 1e6 */
    float dwell_s; /* time since the track entered the zone, s; range 0 .. 1e9 */
};
RHO_MUST_CHECK enum rho_status rho_message_zone_event_encode(
    const struct rho_message_zone_event *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_zone_event_decode(
    const uint8_t *data, size_t size, struct rho_message_zone_event *message);
RHO_MUST_CHECK enum rho_status rho_message_zone_event_validate(
    const struct rho_message_zone_event *message, struct rho_message_place *place);
const char *rho_message_zone_event_field(const struct rho_message_place *place);

/* zone_t: counts of one zone. Counters stay at their largest value. */

#define RHO_MESSAGE_ZONE_FINGERPRINT UINT64_C(0xaaaa5228616ec1c3)
#define RHO_MESSAGE_ZONE_MAX_SIZE 52u

struct rho_message_zone {
    int32_t zone_id; /* identity of the zone */
    int16_t inside; /* tracks in the zone now; range 0 .. 32767 */
    int16_t queued; /* tracks in the zone's queue now; range 0 .. 32767 */
    int32_t entered; /* tracks that entered the zone, since the start; range 0 .. 2147483647 */
    int32_t left; /* tracks that left the zone, since the start; range 0 .. 2147483647 */
    int32_t ended; /* tracks that ended inside the zone, since the start; range 0 .. 2147483647 */
    int32_t along; /* tracks that left along the zone's heading; range 0 .. 2147483647 */
    int32_t against; /* tracks that left against the zone's heading; range 0 .. 2147483647 */
    float speed_mps; /* mean speed of the tracks inside, m/s; 0 of none; range 0 .. 1e6 */
    float queue_m; /* distance from the first queued track to the last, m; range 0 .. 1e9 */
    float dwell_mean_s; /* mean time inside of the tracks that left, s; range 0 .. 1e9 */
    float dwell_max_s; /* longest time inside of the tracks that left, s; range 0 .. 1e9 */
};
RHO_MUST_CHECK enum rho_status rho_message_zone_encode(
    const struct rho_message_zone *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_zone_decode(
    const uint8_t *data, size_t size, struct rho_message_zone *message);
RHO_MUST_CHECK enum rho_status rho_message_zone_validate(
    const struct rho_message_zone *message, struct rho_message_place *place);
const char *rho_message_zone_field(const struct rho_message_place *place);

/*
 * accumulator_t: the accumulator of the last search: its extent, and the fullest cells, best first.
 * Sent when asked for. Channel RHO_ACCUMULATOR.
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
    /* time of the window's newest scan, us; range -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number: another one after each restart */
    /* Hough transform that made the accumulator; one of HT, MHT, IHT, NHT, PASSIVE_PAPER */
    int8_t method;
    /*
     * 1: the accumulator has the crossings of one pair of sensors; 0: those of all sensors; range 0
     * .. 1
     */
    int8_t has_pair;
    int16_t sensor_a_id; /* first sensor of the pair; 0 without a pair */
    int16_t sensor_b_id; /* second sensor of the pair; 0 without a pair */
    int16_t num_scans; /* number of scans in the window; range 1 .. 16 */
    /* time of the window's oldest scan, us; range -4000000000000000000 .. 4000000000000000000 */
    int64_t oldest_utime;
    float origin_x_m; /* point from which rho is measured, east, m; range -2e6 .. 2e6 */
    float origin_y_m; /* point from which rho is measured, north, m; range -2e6 .. 2e6 */
    float rho_min_m; /* lower edge in rho of the cells that a plane_t shows, m */
    float rho_max_m; /* upper edge in rho of these cells: beyond them are no votes, m */
    int16_t rho_cells; /* number of cells from rho_min_m to rho_max_m; range 1 .. 32767 */
    int16_t theta_cells; /* number of cells from theta 0 to pi; range 1 .. 32767 */
    float votes_max; /* votes of the fullest cell; range 0 .. 1e9 */
    float votes_min; /* least votes of a cell that is listed; range 0 .. 1e9 */
    /*
     * messages of this channel and of RHO_PLANE that were left out for their rate, so far; range 0
     * .. 2147483647
     */
    int32_t not_sent;
    /* number of cells that the search found; the list has the best of them; range 0 .. 32767 */
    int16_t num_cells_total;
    int16_t num_cells; /* number of cells in the list */
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
    const struct rho_message_accumulator *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/* bearing_scan_t: bearings of one scan of one passive sensor. Channel RHO_BEARINGS_<sensor_id>. */

#define RHO_MESSAGE_BEARING_SCAN_CHANNEL "RHO_BEARINGS_" /* then the sensor's number */
#define RHO_MESSAGE_BEARING_SCAN_FINGERPRINT UINT64_C(0x66d140164191753b)
#define RHO_MESSAGE_BEARING_SCAN_MAX_SIZE 1064u
#define RHO_MESSAGE_BEARING_SCAN_MAX_BEARING_RAD 256

struct rho_message_bearing_scan {
    /*
     * time of measurement, us of the sensors' common clock; range -4000000000000000000 ..
     * 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of this scan, one more each; after 2147483647 comes -2147483648 */
    int32_t epoch; /* the sender's boot number, another one after each restart */
    int16_t sensor_id; /* number of the sensor, as in the channel's name */
    /* position of the sensor, the same in every scan, east, m; range -2e6 .. 2e6 */
    float sensor_x_m;
    /* position of the sensor, the same in every scan, north, m; range -2e6 .. 2e6 */
    float sensor_y_m;
    /* standard deviation of the bearings' noise, rad; 0: not stated; range 0 .. 0.5 */
    float sigma_rad;
    int16_t num_bearings; /* number of bearings in the list */
    /*
     * bearings to the targets, counter-clockwise from +x (east), rad; range -3.1415927 .. 3.1415927
     */
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
    const struct rho_message_bearing_scan *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/*
 * body_list_t: the bodies of tracks after one step of a tracker that was told how long targets may
 * be, or a part of the list; a track has no body before two of its plots came in one scan. Channel
 * RHO_BODIES.
 */

#define RHO_MESSAGE_BODY_LIST_CHANNEL "RHO_BODIES"
#define RHO_MESSAGE_BODY_LIST_FINGERPRINT UINT64_C(0xd468c7e7b0d084a9)
#define RHO_MESSAGE_BODY_LIST_MAX_SIZE 1374u
#define RHO_MESSAGE_BODY_LIST_MAX_BODIES 24

struct rho_message_body_list {
    /* time of the scan that was stepped, us; range -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    int16_t part; /* number of this part of the list, from 0; range 0 .. num_parts - 1 */
    int16_t num_parts; /* number of parts of the list; an empty list has one; range 1 .. 32767 */
    int16_t num_bodies; /* number of bodies in this part of the list */
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
    const struct rho_message_body_list *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/*
 * clutter_map_t: echoes in a tracker's clutter map: clutter that comes back to its place. All of
 * them, or a part, every few seconds. Channel RHO_CLUTTER.
 */

#define RHO_MESSAGE_CLUTTER_MAP_CHANNEL "RHO_CLUTTER"
#define RHO_MESSAGE_CLUTTER_MAP_FINGERPRINT UINT64_C(0x62c5de2aae95967f)
#define RHO_MESSAGE_CLUTTER_MAP_MAX_SIZE 1392u
#define RHO_MESSAGE_CLUTTER_MAP_MAX_ECHOES 40

struct rho_message_clutter_map {
    /*
     * time of the last scan that was stepped, us; range -4000000000000000000 .. 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of the tracker's last step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    int16_t num_echoes_total; /* number of echoes in all parts of the list; range 0 .. 32767 */
    int16_t part; /* number of this part of the list, from 0; range 0 .. num_parts - 1 */
    int16_t num_parts; /* number of parts of the list; an empty list has one; range 1 .. 32767 */
    int16_t num_echoes; /* number of echoes in this part of the list */
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
    const struct rho_message_clutter_map *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/*
 * direction_scan_t: directions of one scan of one passive sensor, which may move. Channel
 * RHO_DIRECTIONS_<sensor_id>.
 */

#define RHO_MESSAGE_DIRECTION_SCAN_CHANNEL "RHO_DIRECTIONS_" /* then the sensor's number */
#define RHO_MESSAGE_DIRECTION_SCAN_FINGERPRINT UINT64_C(0x73ea0ef7000f017b)
#define RHO_MESSAGE_DIRECTION_SCAN_MAX_SIZE 1144u
#define RHO_MESSAGE_DIRECTION_SCAN_MAX_DIRECTIONS 64

struct rho_message_direction_scan {
    /*
     * time of measurement, us of the sensors' common clock; range -4000000000000000000 ..
     * 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of this scan, one more each; after 2147483647 comes -2147483648 */
    int32_t epoch; /* the sender's boot number, another one after each restart */
    int16_t sensor_id; /* number of the sensor, as in the channel's name */
    float sensor_x_m; /* position of the sensor in this scan, east, m; range -2e6 .. 2e6 */
    float sensor_y_m; /* position of the sensor in this scan, north, m; range -2e6 .. 2e6 */
    float sensor_z_m; /* position of the sensor in this scan, up, m; range -2e6 .. 2e6 */
    /* standard deviation of the bearings' noise, rad; 0: not stated; range 0 .. 0.5 */
    float sigma_rad;
    /* standard deviation of the elevations' noise, rad; 0: not stated; range 0 .. 0.5 */
    float sigma_elevation_rad;
    /*
     * sector that was looked at, first edge of it counter-clockwise, rad from +x (east); range
     * -6.2831855 .. 6.2831855
     */
    float sector_from_rad;
    /* last edge of the sector; both edges 0: the whole circle; range -6.2831855 .. 6.2831855 */
    float sector_to_rad;
    int16_t num_directions; /* number of directions in the list */
    struct rho_message_direction directions[RHO_MESSAGE_DIRECTION_SCAN_MAX_DIRECTIONS];
};

struct rho_message_direction_scan_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int16_t sensor_id;
    float sensor_x_m;
    float sensor_y_m;
    float sensor_z_m;
    float sigma_rad;
    float sigma_elevation_rad;
    float sector_from_rad;
    float sector_to_rad;
};
RHO_MUST_CHECK enum rho_status rho_message_direction_scan_encode(
    const struct rho_message_direction_scan *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_direction_scan_decode(
    const uint8_t *data, size_t size, struct rho_message_direction_scan *message);
RHO_MUST_CHECK enum rho_status rho_message_direction_scan_validate(
    const struct rho_message_direction_scan *message, struct rho_message_place *place);
const char *rho_message_direction_scan_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_direction_scan_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_direction_scan_head *head);
RHO_MUST_CHECK enum rho_status rho_message_direction_scan_add(
    struct rho_message_writer *writer, const struct rho_message_direction *direction);

/*
 * ghost_matrix_t: the ghost matrix of the newest scans of two passive sensors, or a part of it.
 * Sent when asked for. Channel RHO_GHOSTS.
 */

#define RHO_MESSAGE_GHOST_MATRIX_CHANNEL "RHO_GHOSTS"
#define RHO_MESSAGE_GHOST_MATRIX_FINGERPRINT UINT64_C(0xb0ea8488a0c3ed35)
#define RHO_MESSAGE_GHOST_MATRIX_MAX_SIZE 1389u
#define RHO_MESSAGE_GHOST_MATRIX_MAX_ELEMENTS 78
#define RHO_MESSAGE_GHOST_MATRIX_NO_RULE 0
#define RHO_MESSAGE_GHOST_MATRIX_LITERAL 1
#define RHO_MESSAGE_GHOST_MATRIX_SAFE 2

struct rho_message_ghost_matrix {
    int64_t utime; /* time of the frame, us; range -4000000000000000000 .. 4000000000000000000 */
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    int16_t sensor_a_id; /* sensor whose bearings are the rows of the matrix */
    int16_t sensor_b_id; /* sensor whose bearings are the columns of the matrix */
    float sensor_a_x_m; /* position of sensor a, east, m; range -2e6 .. 2e6 */
    float sensor_a_y_m; /* position of sensor a, north, m; range -2e6 .. 2e6 */
    float sensor_b_x_m; /* position of sensor b, east, m; range -2e6 .. 2e6 */
    float sensor_b_y_m; /* position of sensor b, north, m; range -2e6 .. 2e6 */
    float range_max_m; /* longest range of both sensors, m; range 0 .. 1e9 */
    int8_t rule; /* rule by which ghosts are pruned; one of NO_RULE, LITERAL, SAFE */
    int16_t num_rows; /* number of bearings of sensor a; range 0 .. 255 */
    int16_t num_columns; /* number of bearings of sensor b; range 0 .. 255 */
    /* messages of this channel that were left out for its rate, so far; range 0 .. 2147483647 */
    int32_t not_sent;
    int16_t part; /* number of this part of the matrix, from 0; range 0 .. num_parts - 1 */
    int16_t num_parts; /* number of parts of the matrix; an empty one has one; range 1 .. 32767 */
    int16_t num_elements; /* number of elements in this part of the matrix, row by row */
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
    const struct rho_message_ghost_matrix *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/*
 * hypotheses_t: the hypotheses of one track, best first, with its score, motion models, and
 * evidence of the last look. Sent when asked for. Channel RHO_HYPOTHESES. Support, shared and
 * clutter are truth, indeterminacy and falsity of neutrosophic sets, and add up to 1. With evidence
 * PLOTS a plot in the track's gate is the target's with probability p, before plots are assigned to
 * one track each, and this track's with probability r rather than another's. With evidence LINE
 * they are shares of the sums C_T, C_I and C_F of the cell by which a neutrosophic Hough transform
 * started the track.
 */

#define RHO_MESSAGE_HYPOTHESES_CHANNEL "RHO_HYPOTHESES"
#define RHO_MESSAGE_HYPOTHESES_FINGERPRINT UINT64_C(0xe526c2edcb9c898f)
#define RHO_MESSAGE_HYPOTHESES_MAX_SIZE 303u
#define RHO_MESSAGE_HYPOTHESES_MAX_HYPOTHESES 8
#define RHO_MESSAGE_HYPOTHESES_NO_EVIDENCE 0
#define RHO_MESSAGE_HYPOTHESES_PLOTS 1
#define RHO_MESSAGE_HYPOTHESES_LINE 2

struct rho_message_hypotheses {
    int64_t utime; /* time of the step, us; range -4000000000000000000 .. 4000000000000000000 */
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    int32_t track_id; /* identity of the track, as in RHO_TRACKS */
    float score_nat; /* track score, log-likelihood ratio of target against clutter */
    /*
     * probability that the target flies straight for minutes; calm, steady and maneuver add up to
     * 1; range 0 .. 1
     */
    float calm;
    float steady; /* probability that the target flies straight, and may turn soon; range 0 .. 1 */
    float maneuver; /* probability that the target manoeuvres; range 0 .. 1 */
    /*
     * source of the evidence. PLOTS: plots of this step; LINE: the line by which the track started
     * in this step; NO_EVIDENCE: none was sought, or none is known; one of NO_EVIDENCE, PLOTS, LINE
     */
    int8_t evidence;
    /* evidence that is the track's own: sum of p r over its plots; C_T; range 0 .. 1 */
    float support;
    /* evidence that other tracks or lines claim, too: sum of p (1 - r); C_I; range 0 .. 1 */
    float shared;
    float clutter; /* evidence that no plot is the target's: 1 - sum of p; C_F; range 0 .. 1 */
    /* messages of this channel that were left out for its rate, so far; range 0 .. 2147483647 */
    int32_t not_sent;
    int16_t num_hypotheses; /* number of hypotheses in the list */
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
    const struct rho_message_hypotheses *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/*
 * life_t: lives of a tracker's targets: how often they leave and are hidden, as learned, and
 * return, and for each track whether its target exists. All tracks, or a part, once a second.
 * Channel RHO_LIFE.
 */

#define RHO_MESSAGE_LIFE_CHANNEL "RHO_LIFE"
#define RHO_MESSAGE_LIFE_FINGERPRINT UINT64_C(0xeee71746b1a39c0c)
#define RHO_MESSAGE_LIFE_MAX_SIZE 1248u
#define RHO_MESSAGE_LIFE_MAX_TRACKS 100

struct rho_message_life {
    /*
     * time of the last scan that was stepped, us; range -4000000000000000000 .. 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of the tracker's last step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    float death_rate; /* at which targets leave; range 0 .. 1 */
    float hide_rate; /* at which visible targets are hidden; range 0 .. 1 */
    /* at which hidden targets are visible again, by coast_scans_max; range 0 .. 2 */
    float appear_rate;
    /*
     * scan intervals that established tracks lived, from which the rates of death and hiding come;
     * old ones fade; range 0 .. 1e9
     */
    float lived_scans;
    int16_t num_tracks_total; /* number of tracks in all parts of the list; range 0 .. 32767 */
    int16_t part; /* number of this part of the list, from 0; range 0 .. num_parts - 1 */
    int16_t num_parts; /* number of parts of the list; an empty list has one; range 1 .. 32767 */
    int16_t num_tracks; /* number of tracks in this part of the list */
    struct rho_message_track_life tracks[RHO_MESSAGE_LIFE_MAX_TRACKS];
};

struct rho_message_life_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    float death_rate;
    float hide_rate;
    float appear_rate;
    float lived_scans;
    int16_t num_tracks_total;
    int16_t part;
    int16_t num_parts;
};
RHO_MUST_CHECK enum rho_status rho_message_life_encode(
    const struct rho_message_life *message, uint8_t *buffer, size_t capacity,
    size_t *size);
RHO_MUST_CHECK enum rho_status rho_message_life_decode(
    const uint8_t *data, size_t size, struct rho_message_life *message);
RHO_MUST_CHECK enum rho_status rho_message_life_validate(
    const struct rho_message_life *message, struct rho_message_place *place);
const char *rho_message_life_field(const struct rho_message_place *place);
RHO_MUST_CHECK enum rho_status rho_message_life_begin(
    struct rho_message_writer *writer, uint8_t *buffer, size_t capacity,
    const struct rho_message_life_head *head);
RHO_MUST_CHECK enum rho_status rho_message_life_add(
    struct rho_message_writer *writer, const struct rho_message_track_life *track);

/*
 * peak_list_t: the best candidates of the last search for new tracks, best first. Channel
 * RHO_PEAKS.
 */

#define RHO_MESSAGE_PEAK_LIST_CHANNEL "RHO_PEAKS"
#define RHO_MESSAGE_PEAK_LIST_FINGERPRINT UINT64_C(0x68f79b7c84f4d541)
#define RHO_MESSAGE_PEAK_LIST_MAX_SIZE 982u
#define RHO_MESSAGE_PEAK_LIST_MAX_PEAKS 48

struct rho_message_peak_list {
    /* time of the scan that was stepped, us; range -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int16_t num_peaks; /* number of candidates in the list */
    struct rho_message_peak peaks[RHO_MESSAGE_PEAK_LIST_MAX_PEAKS];
};

struct rho_message_peak_list_head {
    int64_t utime;
    int32_t scan;
};
RHO_MUST_CHECK enum rho_status rho_message_peak_list_encode(
    const struct rho_message_peak_list *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/*
 * plane_t: a reduced picture of the accumulator of an accumulator_t of the same scan and pair; a
 * part of it. Sent when asked for. Channel RHO_PLANE.
 */

#define RHO_MESSAGE_PLANE_CHANNEL "RHO_PLANE"
#define RHO_MESSAGE_PLANE_FINGERPRINT UINT64_C(0x3c33f233bec2f5b4)
#define RHO_MESSAGE_PLANE_MAX_SIZE 1064u
#define RHO_MESSAGE_PLANE_MAX_ROWS 16

struct rho_message_plane {
    /*
     * time of the window's newest scan, as in the accumulator_t, us; range -4000000000000000000 ..
     * 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of the tracker's step, as in the accumulator_t */
    int32_t epoch; /* the tracker's boot number, as in the accumulator_t */
    int8_t method; /* Hough transform, as in the accumulator_t; range 1 .. 5 */
    /* 1: votes of one pair of sensors; 0: votes of all, as in the accumulator_t; range 0 .. 1 */
    int8_t has_pair;
    int16_t sensor_a_id; /* first sensor of the pair; 0 without a pair */
    int16_t sensor_b_id; /* second sensor of the pair; 0 without a pair */
    float votes_max; /* number of votes that 127 in the rows stands for; range 0 .. 1e9 */
    int16_t part; /* number of this part of the rows, from 0; range 0 .. num_parts - 1 */
    /*
     * number of parts of the rows, of which there are at most 64, from theta 0 to pi; range 1 ..
     * 32767
     */
    int16_t num_parts;
    int16_t num_rows; /* number of rows in this part */
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
    const struct rho_message_plane *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/*
 * plot_scan_t: plots of one scan of one sensor, or a part of them. Channel RHO_PLOTS_<sensor_id>.
 */

#define RHO_MESSAGE_PLOT_SCAN_CHANNEL "RHO_PLOTS_" /* then the sensor's number */
#define RHO_MESSAGE_PLOT_SCAN_FINGERPRINT UINT64_C(0x0ec35bb85bc4cbde)
#define RHO_MESSAGE_PLOT_SCAN_MAX_SIZE 1401u
#define RHO_MESSAGE_PLOT_SCAN_POSITION_2D 2
#define RHO_MESSAGE_PLOT_SCAN_POSITION_3D 3
#define RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_2D 4
#define RHO_MESSAGE_PLOT_SCAN_POSITION_VELOCITY_3D 6
#define RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS 34

struct rho_message_plot_scan {
    /*
     * time of measurement, us of the sensors' common clock; range -4000000000000000000 ..
     * 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of this scan, one more each; after 2147483647 comes -2147483648 */
    int32_t epoch; /* the sender's boot number, another one after each restart */
    int16_t sensor_id; /* number of the sensor, as in the channel's name */
    /*
     * what the plots measure; one of POSITION_2D, POSITION_3D, POSITION_VELOCITY_2D,
     * POSITION_VELOCITY_3D
     */
    int8_t kind;
    int16_t part; /* number of this part of the scan, from 0; range 0 .. num_parts - 1 */
    int16_t num_parts; /* number of parts of the scan; range 1 .. 32767 */
    /*
     * sector that was looked at, first edge of it counter-clockwise, rad from +x (east); range
     * -6.2831855 .. 6.2831855
     */
    float sector_from_rad;
    /* last edge of the sector; both edges 0: the whole circle; range -6.2831855 .. 6.2831855 */
    float sector_to_rad;
    int16_t num_plots; /* number of plots in this part of the scan */
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
    const struct rho_message_plot_scan *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/*
 * polar_scan_t: polar plots of one scan of one radar, or a part of them. Channel
 * RHO_POLAR_<sensor_id>.
 */

#define RHO_MESSAGE_POLAR_SCAN_CHANNEL "RHO_POLAR_" /* then the sensor's number */
#define RHO_MESSAGE_POLAR_SCAN_FINGERPRINT UINT64_C(0x0570bdbf57d4a221)
#define RHO_MESSAGE_POLAR_SCAN_MAX_SIZE 1366u
#define RHO_MESSAGE_POLAR_SCAN_MAX_POLAR_PLOTS 54

struct rho_message_polar_scan {
    /*
     * time of measurement, us of the sensors' common clock; range -4000000000000000000 ..
     * 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of this scan, one more each; after 2147483647 comes -2147483648 */
    int32_t epoch; /* the sender's boot number, another one after each restart */
    int16_t sensor_id; /* number of the sensor, as in the channel's name */
    int8_t has_elevation; /* 1: the plots' elevations are measured; range 0 .. 1 */
    int8_t has_range_rate; /* 1: the plots' range rates are measured; range 0 .. 1 */
    int16_t part; /* number of this part of the scan, from 0; range 0 .. num_parts - 1 */
    int16_t num_parts; /* number of parts of the scan; range 1 .. 32767 */
    float sensor_x_m; /* position of the radar, east, m; range -2e6 .. 2e6 */
    float sensor_y_m; /* position of the radar, north, m; range -2e6 .. 2e6 */
    float sensor_z_m; /* position of the radar, up, m; range -2e6 .. 2e6 */
    /* standard deviation of the range's noise, m; 0: not stated; range 0 .. 1e5 */
    float sigma_range_m;
    /* standard deviation of the azimuth's noise, rad; 0: not stated; range 0 .. 0.5 */
    float sigma_azimuth_rad;
    /* standard deviation of the elevation's noise, rad; 0: not stated; range 0 .. 0.5 */
    float sigma_elevation_rad;
    /* standard deviation of the range rate's noise, m/s; 0: not stated; range 0 .. 1e5 */
    float sigma_range_rate_mps;
    /*
     * sector that was looked at, first edge of it counter-clockwise, rad from +x (east); range
     * -6.2831855 .. 6.2831855
     */
    float sector_from_rad;
    /* last edge of the sector; both edges 0: the whole circle; range -6.2831855 .. 6.2831855 */
    float sector_to_rad;
    int16_t num_polar_plots; /* number of plots in this part of the scan */
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
    const struct rho_message_polar_scan *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/*
 * sensor_list_t: state of the sensors that a tracker hears, or a part of the list: once a second,
 * with status_t. Channel RHO_SENSORS.
 */

#define RHO_MESSAGE_SENSOR_LIST_CHANNEL "RHO_SENSORS"
#define RHO_MESSAGE_SENSOR_LIST_FINGERPRINT UINT64_C(0x573b8d1ed41bb0ea)
#define RHO_MESSAGE_SENSOR_LIST_MAX_SIZE 1400u
#define RHO_MESSAGE_SENSOR_LIST_MAX_SENSORS 36

struct rho_message_sensor_list {
    /*
     * time of the last scan that was stepped, us; range -4000000000000000000 .. 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of the tracker's last step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    int16_t num_sensors_total; /* number of sensors in all parts of the list; range 0 .. 32767 */
    int16_t part; /* number of this part of the list, from 0; range 0 .. num_parts - 1 */
    int16_t num_parts; /* number of parts of the list; an empty list has one; range 1 .. 32767 */
    int16_t num_sensors; /* number of sensors in this part of the list */
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
    const struct rho_message_sensor_list *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/* track_list_t: the tracks after a step but those in doubt, or a part. Channel RHO_TRACKS. */

#define RHO_MESSAGE_TRACK_LIST_CHANNEL "RHO_TRACKS"
#define RHO_MESSAGE_TRACK_LIST_FINGERPRINT UINT64_C(0x50afcc23bcd9a625)
#define RHO_MESSAGE_TRACK_LIST_MAX_SIZE 1337u
#define RHO_MESSAGE_TRACK_LIST_MAX_TRACKS 9

struct rho_message_track_list {
    /* time of the scan that was stepped, us; range -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's step, one more each */
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    int16_t num_tracks_total; /* number of tracks in all parts of the list; range 0 .. 32767 */
    int16_t part; /* number of this part of the list, from 0; range 0 .. num_parts - 1 */
    int16_t num_parts; /* number of parts of the list; an empty list has one; range 1 .. 32767 */
    int16_t num_tracks; /* number of tracks in this part of the list */
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
    const struct rho_message_track_list *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/*
 * truth_list_t: true positions of the targets of a simulation or a trial, or a part of the list.
 * Channel RHO_TRUTH.
 */

#define RHO_MESSAGE_TRUTH_LIST_CHANNEL "RHO_TRUTH"
#define RHO_MESSAGE_TRUTH_LIST_FINGERPRINT UINT64_C(0x36f25f198a476da8)
#define RHO_MESSAGE_TRUTH_LIST_MAX_SIZE 1426u
#define RHO_MESSAGE_TRUTH_LIST_MAX_TARGETS 50

struct rho_message_truth_list {
    /*
     * time of the true states, us of the sensors' common clock; range -4000000000000000000 ..
     * 4000000000000000000
     */
    int64_t utime;
    int32_t scan; /* number of the list, one more each */
    int16_t part; /* number of this part of the list, from 0; range 0 .. num_parts - 1 */
    int16_t num_parts; /* number of parts of the list; range 1 .. 32767 */
    int16_t num_targets; /* number of targets in this part of the list */
    struct rho_message_truth targets[RHO_MESSAGE_TRUTH_LIST_MAX_TARGETS];
};

struct rho_message_truth_list_head {
    int64_t utime;
    int32_t scan;
    int16_t part;
    int16_t num_parts;
};
RHO_MUST_CHECK enum rho_status rho_message_truth_list_encode(
    const struct rho_message_truth_list *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/*
 * zone_event_list_t: tracks that have entered and left zones in one step; a step without events
 * sends no message. Channel RHO_ZONE_EVENTS.
 */

#define RHO_MESSAGE_ZONE_EVENT_LIST_CHANNEL "RHO_ZONE_EVENTS"
#define RHO_MESSAGE_ZONE_EVENT_LIST_FINGERPRINT UINT64_C(0x4945d33ac51d2c5c)
#define RHO_MESSAGE_ZONE_EVENT_LIST_MAX_SIZE 1178u
#define RHO_MESSAGE_ZONE_EVENT_LIST_MAX_EVENTS 64

struct rho_message_zone_event_list {
    int64_t utime; /* time of the step, us; range -4000000000000000000 .. 4000000000000000000 */
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    int16_t num_events; /* number of events in the list */
    struct rho_message_zone_event events[RHO_MESSAGE_ZONE_EVENT_LIST_MAX_EVENTS];
};

struct rho_message_zone_event_list_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
};
RHO_MUST_CHECK enum rho_status rho_message_zone_event_list_encode(
    const struct rho_message_zone_event_list *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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

/* zone_list_t: counts of the tracker's zones. Once a second, with status_t. Channel RHO_ZONES. */

#define RHO_MESSAGE_ZONE_LIST_CHANNEL "RHO_ZONES"
#define RHO_MESSAGE_ZONE_LIST_FINGERPRINT UINT64_C(0xe6266bbc90e0975c)
#define RHO_MESSAGE_ZONE_LIST_MAX_SIZE 1350u
#define RHO_MESSAGE_ZONE_LIST_MAX_ZONES 30

struct rho_message_zone_list {
    /* time of the last step, us; range -4000000000000000000 .. 4000000000000000000 */
    int64_t utime;
    int32_t scan; /* number of the tracker's step, as in RHO_TRACKS */
    int32_t epoch; /* the tracker's boot number, another one after each restart */
    /*
     * events beyond the room of a step's zone_event_list_t, since the start; range 0 .. 2147483647
     */
    int32_t events_dropped;
    int16_t num_zones; /* number of zones in the list */
    struct rho_message_zone zones[RHO_MESSAGE_ZONE_LIST_MAX_ZONES];
};

struct rho_message_zone_list_head {
    int64_t utime;
    int32_t scan;
    int32_t epoch;
    int32_t events_dropped;
};
RHO_MUST_CHECK enum rho_status rho_message_zone_list_encode(
    const struct rho_message_zone_list *message, uint8_t *buffer, size_t capacity,
    size_t *size);
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
