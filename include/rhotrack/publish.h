/* SPDX-License-Identifier: MIT */
/*
 * publish: what a step of the tracker made, as messages for RHO_TRACKS, RHO_BODIES, RHO_PEAKS,
 * RHO_STATUS, RHO_WORK, RHO_SENSORS, RHO_LEARNED, RHO_CLUTTER, RHO_ZONES and RHO_ZONE_EVENTS.
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
#include "rhotrack/passive.h"
#include "rhotrack/scan_assembler.h"
#include "rhotrack/tracker.h"
#include "rhotrack/types.h"
#include "rhotrack/zones.h"

#ifdef __cplusplus
extern "C" {
#endif

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

#ifdef __cplusplus
}
#endif

#endif
