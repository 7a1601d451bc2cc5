/* SPDX-License-Identifier: MIT */
/*
 * publish: what a step of the tracker made, and what it thought, as messages.
 *
 * What it made: tracks, bodies, peaks, counters, sensors, echoes and zones, for RHO_TRACKS,
 * RHO_BODIES, RHO_PEAKS, RHO_STATUS, RHO_WORK, RHO_SENSORS, RHO_LEARNED, RHO_CLUTTER, RHO_ZONES and
 * RHO_ZONE_EVENTS.
 *
 *     for (part = 0; part < rho_publish_num_parts(&report); part++) {
 *         rho_publish_tracks(&report, step, epoch, part, buffer, sizeof buffer, &size);
 *         send(RHO_MESSAGE_TRACK_LIST_CHANNEL, buffer, size);
 *     }
 *
 * Messages are written element by element: nothing but the buffer is needed. `step` is the
 * tracker's own number, one more each, and `epoch` its boot number: receivers see by them what they
 * missed.
 *
 * What it thought is shown: ghost matrices (RHO_GHOSTS), accumulators and their planes
 * (RHO_ACCUMULATOR, RHO_PLANE), hypotheses of tracks (RHO_HYPOTHESES).
 *
 *     rho_show_begin(&show, &source, now_us);                    after a step and its starts
 *     while ((channel = rho_show_next(&show, &source, buffer, sizeof buffer, &size))) {
 *         send(channel, buffer, size);
 *     }
 *
 * A show changes nothing of what it shows, and nothing pays for it that is not linked with it. Each
 * kind has a rate. A picture (all pairs of sensors of a frame, or all planes of a search) is sent
 * whole or not at all: it begins while the kind is within its rate, and what is beyond it delays
 * the next one. Tracks take turns. Messages that were left out are counted, and told in each
 * message.
 *
 * Stack: 32 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_PUBLISH_H
#define RHOTRACK_PUBLISH_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/body.h"
#include "rhotrack/frames.h"
#include "rhotrack/initiator.h"
#include "rhotrack/message.h"
#include "rhotrack/paper_starts.h"
#include "rhotrack/passive.h"
#include "rhotrack/passive_paper.h"
#include "rhotrack/scan_assembler.h"
#include "rhotrack/tracker.h"
#include "rhotrack/types.h"
#include "rhotrack/zones.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- What a step made ------------------------------------------------------------------------ */

/* Messages that the report's tracks take; 1 where there are none. Constant cost. */
uint16_t rho_publish_num_parts(const struct rho_report *report);

/*
 * One part of the report's tracks (track_list_t): first the live ones, then those that ended,
 * DELETED, of which only the identity is said. sensor_id beyond int16_t becomes -1, counts stay at
 * 32767.
 *   part  0 .. rho_publish_num_parts - 1
 * Errors: NULL, VALUE (no such part), CAPACITY (of the buffer); *size is unchanged. Cost: the
 * message's bytes.
 * Stack: 360 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_publish_tracks(const struct rho_report *report, int32_t step,
                                                  int32_t epoch, uint16_t part, uint8_t *buffer,
                                                  size_t capacity, size_t *size);

/*
 * Messages that the bodies of the report's tracks take, 1 where none has one yet; 0: the tracker
 * was not told that its targets have bodies (rhotrack/body.h), or there is no tracker or report.
 *   report  of the tracker's last step
 * Cost: tracks. Stack: 160 bytes.
 */
uint16_t rho_publish_num_body_parts(const struct rho_tracker *tracker,
                                    const struct rho_report *report);

/*
 * One part of these bodies (body_list_t), in the order of the tracks.
 *   part  0 .. rho_publish_num_body_parts - 1
 * Errors: NULL, VALUE (no such part), CAPACITY (of the buffer); *size is unchanged. Cost: tracks.
 * Stack: 340 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_publish_bodies(const struct rho_tracker *tracker,
                                                  const struct rho_report *report, int32_t step,
                                                  int32_t epoch, uint16_t part, uint8_t *buffer,
                                                  size_t capacity, size_t *size);

/*
 * The best candidates of the last searches (peak_list_t), those of plots before those of bearings;
 * each may be NULL.
 * Errors: NULL (buffer, size), CAPACITY (of the buffer); *size is unchanged. Cost: the message's
 * bytes, and a square root and an arctangent a peak. Stack: 280 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_publish_peaks(const struct rho_initiator *initiator,
                                                 const struct rho_passive *passive, int64_t time_us,
                                                 int32_t step, uint8_t *buffer, size_t capacity,
                                                 size_t *size);

/*
 * Fills the counters and numbers of tracks that these objects tell; each may be NULL, and counts as
 * zeros. All other fields are 0: scan, epoch, fragments_refused, step_us, step_max_us and the
 * origin are the caller's. Cost: RHO_MAX_TRACKS. Stack: 120 bytes.
 */
void rho_publish_status(const struct rho_scan_assembler *assembler, const struct rho_frames *frames,
                        const struct rho_tracker *tracker, const struct rho_initiator *initiator,
                        struct rho_message_status *status);

/*
 * Fills what the limit on work did, work_max itself among it; a tracker that is NULL counts as
 * zeros. scan, epoch, num_steps, reports_not_printed and events_not_logged are 0: they are the
 * caller's. Constant cost. Stack: 80 bytes.
 */
void rho_publish_work(const struct rho_tracker *tracker, struct rho_message_work *work);

/*
 * How one sensor is doing (sensor_t): what the assembler hears of it, and of a sensor of plots what
 * the tracker makes of it.
 *   tracker  NULL, or without RHO_SECTORS: nothing is known of that, and is_doubted is 0
 *   now_us   the assembler's reception clock
 *   place    in the assembler: 0 .. RHO_MAX_SENSORS - 1; a sensor keeps its place while it is known
 * Returns 0 where there is no sensor at this place, or assembler or sensor is NULL; *sensor is
 * unchanged then. Cost: RHO_MAX_SENSORS. Stack: 180 bytes.
 */
int rho_publish_sensor(const struct rho_scan_assembler *assembler,
                       const struct rho_tracker *tracker, int64_t now_us, unsigned place,
                       struct rho_message_sensor *sensor);

/* Messages that the assembler's sensors take; 1 where there are none. Cost: RHO_MAX_SENSORS. */
uint16_t rho_publish_num_sensor_parts(const struct rho_scan_assembler *assembler);

/*
 * Fills one part of the list of the sensors that the assembler hears, in the order of their places.
 * `utime` is the tracker's time, 0 without one; scan and epoch are 0: they are the caller's.
 *   part  0 .. rho_publish_num_sensor_parts - 1
 * Errors: NULL (assembler, list), VALUE (no such part); *list is unchanged. Cost: RHO_MAX_SENSORS
 * squared. Stack: 320 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_publish_sensors(const struct rho_scan_assembler *assembler,
                                                   const struct rho_tracker *tracker,
                                                   int64_t now_us, uint16_t part,
                                                   struct rho_message_sensor_list *list);

/*
 * What the tracker has learned of one described sensor, and uses. scan and epoch are 0: they are
 * the caller's. sensor_id beyond int16_t becomes -1.
 *   place  among the tracker's sensors: 0 .. num_sensors - 1
 * Returns 0 where there is no sensor at this place, or tracker or learned is NULL; *learned is
 * unchanged then. Cost: RHO_MAX_SENSORS. Stack: 232 bytes.
 */
int rho_publish_learned(const struct rho_tracker *tracker, unsigned place,
                        struct rho_message_learned *learned);

/*
 * Messages that the known echoes of the tracker's clutter map take; 1 where there are none. Cost:
 * RHO_MAX_ECHOES.
 */
uint16_t rho_publish_num_clutter_parts(const struct rho_tracker *tracker);

/*
 * Fills one part of the list of known echoes (clutter_map_t). `utime` is the tracker's time; scan
 * and epoch are 0: they are the caller's. sensor_id beyond int16_t becomes -1, hits stay at 32767.
 *   part  0 .. rho_publish_num_clutter_parts - 1
 * Errors: NULL, VALUE (no such part); *list is unchanged. Cost: RHO_MAX_ECHOES. Stack: 120 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_publish_clutter(const struct rho_tracker *tracker, uint16_t part,
                                                   struct rho_message_clutter_map *list);

/*
 * What the zones have counted (zone_list_t), and who entered and left in their last step
 * (zone_event_list_t). scan and epoch are 0: they are the caller's. Zones that are NULL have none;
 * counters stay at INT32_MAX. Cost: zones, events. Stack: 80 bytes.
 */
void rho_publish_zones(const struct rho_zones *zones, struct rho_message_zone_list *list);
void rho_publish_zone_events(const struct rho_zones *zones,
                             struct rho_message_zone_event_list *list);

/* ---- What a step thought --------------------------------------------------------------------- */

enum rho_show_kind {
    RHO_SHOW_GHOSTS,     /* ghost_matrix_t: each pair of sensors in the newest frame */
    RHO_SHOW_VOTES,      /* accumulator_t and plane_t: the last search */
    RHO_SHOW_HYPOTHESES, /* hypotheses_t: each track */
    RHO_NUM_SHOW_KINDS
};

/* Rows and columns of a plane_t, and the words that its picture takes. */
#define RHO_SHOW_SIDE 64u
#define RHO_SHOW_PICTURE (RHO_SHOW_SIDE * RHO_SHOW_SIDE)

/* Longest message. */
#define RHO_SHOW_MAX_SIZE 1472u

struct rho_show_config {
    uint16_t kinds;          /* bit k: kind k is shown */
    uint16_t messages_per_s; /* of a kind, 1 .. 10000: over a second, or a picture */
    uint32_t *picture;       /* RHO_SHOW_PICTURE words of the caller; NULL: no plane_t */
};

/* The objects after a step. */
struct rho_show_source {
    const struct rho_tracker *tracker;
    const struct rho_report *report;
    /* that took part in the step; else NULL. Their scratch is used: no result of theirs changes */
    struct rho_paper_starts *starts;
    struct rho_passive_paper *paper;
    int32_t step, epoch; /* in the messages */
};

struct rho_show_rate {
    int64_t since_us;  /* of now_us: up to when credit_us counts */
    int64_t credit_us; /* time in which nothing was sent, a second at most; below 0: too much was */
    uint32_t not_sent; /* messages, since init; saturates */
    uint32_t left, at; /* messages of this step: to come; the number of the next one */
    uint8_t has_time;
};

struct rho_show {
    uint32_t magic;
    struct rho_show_config config;
    struct rho_show_rate rates[RHO_NUM_SHOW_KINDS];
    uint32_t last_track_id; /* that was shown */
    uint32_t votes_max;     /* of the picture */
};

/* All kinds, 50 messages a second, no picture. Constant cost. */
void rho_show_config_default(struct rho_show_config *config);

/*
 * Errors: NULL, SIZE, CONFIG (no kind or an unknown one, the rate). The picture stays the caller's.
 * Constant cost. Stack: 160 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_show_init(struct rho_show *show, size_t size,
                                             const struct rho_show_config *config);

/*
 * Decides which messages the step has: one of which rho_show_next has not told all is over.
 *   now_us  clock of the rates; one that goes back begins them anew
 * Without a show that is initialised, a tracker or a report nothing is shown. Cost: tracks, and
 * pairs of sensors. Stack: 330 bytes.
 */
void rho_show_begin(struct rho_show *show, const struct rho_show_source *source, int64_t now_us);

/*
 * Writes the next message of the step, whose objects have not changed since rho_show_begin.
 *   buffer  of RHO_SHOW_MAX_SIZE bytes or more
 * Returns its channel; NULL: there is no more, or the buffer is too small. Cost: of a ghost matrix
 * rho_passive_paper_ghosts a part; of an accumulator_t rho_passive_paper_cells, and with a picture
 * rho_hough_plane or rho_passive_paper_plane; of a track rho_tracker_evidence_of. Stack: 4.5 KB
 * with 8 bearings a scan, 7 KB with 16.
 */
const char *rho_show_next(struct rho_show *show, const struct rho_show_source *source,
                          uint8_t *buffer, size_t capacity, size_t *size);

/* Messages of a kind that its rate has left out so far; 0 of no such kind. Constant cost. */
uint32_t rho_show_not_sent(const struct rho_show *show, enum rho_show_kind kind);

#ifdef __cplusplus
}
#endif

#endif
