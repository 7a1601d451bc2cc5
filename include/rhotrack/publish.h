/* SPDX-License-Identifier: MIT */
/*
 * publish: messages of the results of a tracker's step, and of its intermediate results.
 *
 * Results: tracks, bodies, peaks, counters, sensors, lives of tracks, echoes and zones, for
 * RHO_TRACKS, RHO_BODIES, RHO_PEAKS, RHO_STATUS, RHO_WORK, RHO_SENSORS, RHO_LEARNED, RHO_LIFE,
 * RHO_CLUTTER, RHO_ZONES and RHO_ZONE_EVENTS.
 *
 *     for (part = 0; part < rho_publish_num_parts(&report); part++) {
 *         rho_publish_tracks(&report, step, epoch, part, buffer, sizeof buffer, &size);
 *         send(RHO_MESSAGE_TRACK_LIST_CHANNEL, buffer, size);
 *     }
 *
 * Messages are written element by element: nothing but the buffer is needed. `step` is the number
 * of the step, one more each, and `epoch` the tracker's boot number: receivers detect missed
 * messages by them. Functions that fill a struct leave them (scan, epoch) 0 for the caller. A
 * sensor_id beyond int16_t becomes -1, counts stay at the largest value of their member.
 *
 * Intermediate results are sent by a `show`: ghost matrices (RHO_GHOSTS), accumulators and their
 * planes (RHO_ACCUMULATOR, RHO_PLANE), hypotheses of tracks (RHO_HYPOTHESES).
 *
 *     rho_show_begin(&show, &source, now_us);                    after a step and its starts
 *     while ((channel = rho_show_next(&show, &source, buffer, sizeof buffer, &size))) {
 *         send(channel, buffer, size);
 *     }
 *
 * A show does not change the results, and costs nothing where it is not linked. Each kind of
 * message has a rate. A picture (all pairs of sensors of a frame, or all planes of a search) is
 * sent whole or not at all: it begins while the kind is within its rate, and its excess over the
 * rate delays the next picture. Tracks take turns. Messages that were left out are counted, and
 * each message has their number.
 *
 * Stack: 32 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_PUBLISH_H
#define RHOTRACK_PUBLISH_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/body.h"
#include "rhotrack/initiator.h"
#include "rhotrack/message.h"
#include "rhotrack/paper_starts.h"
#include "rhotrack/passive.h"
#include "rhotrack/passive_paper.h"
#include "rhotrack/scan_assembler.h"
#include "rhotrack/tracker.h"
#include "rhotrack/types.h"
#include "rhotrack/zones.h"

RHO_BEGIN_C

/* Results of a step. */

/* Number of messages (parts) of a report's tracks; 1 where it has none. Cost: tracks. */
uint16_t rho_publish_num_parts(const struct rho_report *report);

/*
 * Writes one part of the report's tracks (track_list_t): first the live tracks, but those in doubt,
 * then ended ones with status DELETED and their identity alone.
 *   part  0 .. rho_publish_num_parts - 1
 * Errors: NULL, VALUE (no such part), CAPACITY (of the buffer); *size is unchanged. Cost: the
 * message's bytes, and tracks. Stack: 360 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_publish_tracks(const struct rho_report *report, int32_t step,
                                                  int32_t epoch, uint16_t part, uint8_t *buffer,
                                                  size_t capacity, size_t *size);

/*
 * Number of messages (parts) of the bodies of the report's tracks; 1 where no track has a body yet;
 * 0: the tracker estimates no bodies (rhotrack/body.h), or there is no tracker or report.
 *   report  report of the tracker's last step
 * Cost: tracks. Stack: 160 bytes.
 */
uint16_t rho_publish_num_body_parts(const struct rho_tracker *tracker,
                                    const struct rho_report *report);

/*
 * Writes one part of the bodies of the report's tracks (body_list_t), in the order of the tracks.
 *   part  0 .. rho_publish_num_body_parts - 1
 * Errors: NULL, VALUE (no such part), CAPACITY (of the buffer); *size is unchanged. Cost: tracks.
 * Stack: 340 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_publish_bodies(const struct rho_tracker *tracker,
                                                  const struct rho_report *report, int32_t step,
                                                  int32_t epoch, uint16_t part, uint8_t *buffer,
                                                  size_t capacity, size_t *size);

/*
 * Writes the best candidates of the last searches (peak_list_t): those of plots (initiator), then
 * those of bearings (passive); each may be NULL.
 * Errors: NULL (buffer, size), CAPACITY (of the buffer); *size is unchanged. Cost: the message's
 * bytes, and a square root and an arctangent a peak. Stack: 280 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_publish_peaks(const struct rho_initiator *initiator,
                                                 const struct rho_passive *passive, int64_t time_us,
                                                 int32_t step, uint8_t *buffer, size_t capacity,
                                                 size_t *size);

/*
 * Fills status_t with the counters of these objects and the numbers of tracks; an object that is
 * NULL counts as zeros. fragments_refused, step_us, step_max_us and the origin are 0: the caller
 * fills them. Cost: RHO_MAX_TRACKS. Stack: 120 bytes.
 */
void rho_publish_status(const struct rho_scan_assembler *assembler,
                        const struct rho_tracker *tracker, const struct rho_initiator *initiator,
                        struct rho_message_status *status);

/*
 * Fills work_t with the limit on work, work_max, and its counters; a tracker that is NULL counts as
 * zeros. num_steps, reports_not_printed and events_not_logged are 0: the caller fills them.
 * Constant cost. Stack: 80 bytes.
 */
void rho_publish_work(const struct rho_tracker *tracker, struct rho_message_work *work);

/*
 * Fills the state of one sensor (sensor_t): its reception by the assembler, and, for a sensor of
 * plots, its health by the tracker.
 *   tracker  NULL, or a build without RHO_SECTORS: the health is not known, and is_doubted is 0
 *   now_us   the assembler's reception clock
 *   place    in the assembler: 0 .. RHO_MAX_SENSORS - 1; a sensor keeps its place while it is known
 * Returns 0 where there is no sensor at this place, or assembler or sensor is NULL; *sensor is
 * unchanged then. Cost: RHO_MAX_SENSORS. Stack: 180 bytes.
 */
int rho_publish_sensor(const struct rho_scan_assembler *assembler,
                       const struct rho_tracker *tracker, int64_t now_us, unsigned place,
                       struct rho_message_sensor *sensor);

/*
 * Number of messages (parts) of the assembler's sensors; 1 where it has none. Cost:
 * RHO_MAX_SENSORS.
 */
uint16_t rho_publish_num_sensor_parts(const struct rho_scan_assembler *assembler);

/*
 * Fills one part of the list of the sensors that the assembler hears, in the order of their places.
 * `utime` is the tracker's time, 0 without one.
 *   part  0 .. rho_publish_num_sensor_parts - 1
 * Errors: NULL (assembler, list), VALUE (no such part); *list is unchanged. Cost: RHO_MAX_SENSORS
 * squared. Stack: 320 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_publish_sensors(const struct rho_scan_assembler *assembler,
                                                   const struct rho_tracker *tracker,
                                                   int64_t now_us, uint16_t part,
                                                   struct rho_message_sensor_list *list);

/*
 * Fills learned_t: noise and pd that the tracker has learned of one described sensor.
 *   place  among the tracker's sensors: 0 .. num_sensors - 1
 * Returns 0 where there is no sensor at this place, or tracker or learned is NULL; *learned is
 * unchanged then. Cost: RHO_MAX_SENSORS. Stack: 232 bytes.
 */
int rho_publish_learned(const struct rho_tracker *tracker, unsigned place,
                        struct rho_message_learned *learned);

/*
 * Writes one part of the lives of the tracker's tracks (life_t): the rates of rho_tracker_life, and
 * for each live track the probabilities that its target exists, and is visible.
 *   part  from 0; part 0 is there without tracks, too
 * Errors: NULL, VALUE (no such part), CAPACITY (of the buffer); *size is unchanged. Cost: the
 * message's bytes. Stack: 256 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_publish_life(const struct rho_tracker *tracker, int32_t step,
                                                int32_t epoch, uint16_t part, uint8_t *buffer,
                                                size_t capacity, size_t *size);

/*
 * Number of messages (parts) of the known echoes in a tracker's clutter map; 1 where there are
 * none. Cost: RHO_MAX_ECHOES.
 */
uint16_t rho_publish_num_clutter_parts(const struct rho_tracker *tracker);

/*
 * Fills one part of the list of known echoes (clutter_map_t). `utime` is the tracker's time.
 *   part  0 .. rho_publish_num_clutter_parts - 1
 * Errors: NULL, VALUE (no such part); *list is unchanged. Cost: RHO_MAX_ECHOES. Stack: 120 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_publish_clutter(const struct rho_tracker *tracker, uint16_t part,
                                                   struct rho_message_clutter_map *list);

/*
 * Fill the zones' counts (zone_list_t), and the entries and exits of tracks in their last step
 * (zone_event_list_t). With zones NULL the lists are empty. Cost: zones, events. Stack: 80 bytes.
 */
void rho_publish_zones(const struct rho_zones *zones, struct rho_message_zone_list *list);
void rho_publish_zone_events(const struct rho_zones *zones,
                             struct rho_message_zone_event_list *list);

/* Intermediate results of a step. */

enum rho_show_kind {
    RHO_SHOW_GHOSTS,     /* ghost_matrix_t of each pair of sensors in a row that ended */
    RHO_SHOW_VOTES,      /* accumulator_t and plane_t of the last search */
    RHO_SHOW_HYPOTHESES, /* hypotheses_t of each track */
    RHO_NUM_SHOW_KINDS
};

/* Rows and columns of a plane_t's picture, and the number of words in its buffer. */
#define RHO_SHOW_SIDE 64u
#define RHO_SHOW_PICTURE (RHO_SHOW_SIDE * RHO_SHOW_SIDE)

/* Bytes of the longest message that a show writes. */
#define RHO_SHOW_MAX_SIZE 1472u

struct rho_show_config {
    uint16_t kinds; /* bit k is set: messages of kind k are made */
    /* largest rate of each kind, 1 .. 10000, over a second or a whole picture */
    uint16_t messages_per_s;
    /* the caller's buffer of RHO_SHOW_PICTURE words for pictures; NULL: no plane_t is made */
    uint32_t *picture;
};

/* Objects of a step whose contents a show makes messages of. */
struct rho_show_source {
    const struct rho_tracker *tracker;
    const struct rho_report *report;
    /* searches that took part in the step, else NULL; their scratch is used, their results stay */
    struct rho_paper_starts *starts;
    struct rho_passive_paper *paper;
    int32_t step, epoch; /* number of the step, and boot number, for the messages */
};

struct rho_show_rate {
    int64_t since_us; /* time now_us up to which credit_us was counted */
    /* credit for sending: time without messages, a second at most; below 0: the rate is exceeded */
    int64_t credit_us;
    uint32_t not_sent; /* messages that were left out since rho_show_init; saturates */
    /* messages of this step that are still to be written; number of the next message */
    uint32_t left, at;
    uint8_t has_time;
};

struct rho_show {
    uint32_t magic;
    struct rho_show_config config;
    struct rho_show_rate rates[RHO_NUM_SHOW_KINDS];
    uint32_t last_track_id; /* identity of the track that was shown last */
    uint32_t votes_max;     /* most votes of a cell in the picture */
};

/* Default: all kinds, 50 messages a second, no picture. Constant cost. */
void rho_show_config_default(struct rho_show_config *config);

/*
 * Prepares a show; the config is copied, the picture's buffer stays the caller's.
 *   size   sizeof(struct rho_show) of the caller
 * Errors: NULL, SIZE, CONFIG (no kind or an unknown one, or a rate outside its range).
 * Constant cost. Stack: 160 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_show_init(struct rho_show *show, size_t size,
                                             const struct rho_show_config *config);

/*
 * Plans the messages of a step; messages of the step before that were not written are dropped.
 *   now_us  clock of the rates; where it goes back the rates begin anew
 * Nothing is planned without an initialised show, a tracker or a report. Cost: tracks, and
 * pairs of sensors. Stack: 360 bytes.
 */
void rho_show_begin(struct rho_show *show, const struct rho_show_source *source, int64_t now_us);

/*
 * Writes the next message of the step, whose objects have not changed since rho_show_begin.
 *   buffer  of RHO_SHOW_MAX_SIZE bytes or more
 * Returns the message's channel; NULL: no message is left, or the buffer is too small. Cost: for a
 * part of a ghost matrix rho_passive_paper_ghosts; for an accumulator_t rho_passive_paper_cells,
 * and with a picture rho_hough_plane or rho_passive_paper_plane, twice; for a track
 * rho_tracker_evidence_of. Stack: 4.5 KB with 8 bearings a scan, 7 KB with 16.
 */
const char *rho_show_next(struct rho_show *show, const struct rho_show_source *source,
                          uint8_t *buffer, size_t capacity, size_t *size);

/* Number of a kind's messages that its rate has left out; 0 for an unknown kind. Constant cost. */
uint32_t rho_show_not_sent(const struct rho_show *show, enum rho_show_kind kind);

RHO_END_C

#endif
