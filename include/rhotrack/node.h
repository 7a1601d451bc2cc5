/* SPDX-License-Identifier: MIT */
/*
 * node: a live tracker without its network: takes messages of sensors, makes messages of tracks.
 *
 *     for (;;) {
 *         if (a message has come) {
 *             while (rho_node_take(&node, channel, data, size, now_us) == RHO_ERROR_CAPACITY) {
 *                 run();
 *             }
 *         }
 *         run();
 *         wait for a message, until rho_node_due_us(&node) at the latest
 *     }
 *
 * where run() makes the steps that are due and sends what they have made:
 *
 *     while ((due = rho_node_next(&node, now_us)) != RHO_NODE_NOTHING) {
 *         if (due == RHO_NODE_RESTART) {
 *             initialise tracker and initiators again; set node.epoch to another number
 *         } else if (rho_node_step(&node, &initiator) == RHO_OK) {
 *             for (part = 0; part < rho_node_num_messages(&node); part++) {
 *                 rho_node_publish(&node, &initiator, part, buffer, sizeof buffer, &size);
 *                 send(rho_node_channel(&node, part), buffer, size);
 *             }
 *         }
 *     }
 *
 * The caller owns every object that the node works with, and initialises each of them by its own
 * function before rho_node_init: scan assembler, tracker, initiators, and for passive sensors their
 * frames and their search. The node holds pointers to them and no other state of theirs.
 *
 * Order      Scans are stepped in the order in which the scan assembler gives them. Scans of
 *            bearings become frames; scans of plots wait for the open frame where that began before
 *            them, as far as there is room (waiting_max): else the frame closes. An open frame
 *            closes when no scan has come for tolerance_us of the frames and hold_us together.
 * Sensors    Each sensor is described to the tracker before its scan is stepped. Where the tracker
 *            has no room for another one, it forgets those that have been silent for jump_max_us.
 *            Frames begin anew where a passive sensor that is silent for jump_max_us keeps another
 *            one out of them, and where 16 successive scans of a passive sensor are refused: it may
 *            have moved.
 * Restart    Where the sensors' clock was set, tracks cannot go on. RHO_NODE_RESTART says so after
 *            the last step of the old time; frames and passive search are empty again by then.
 * Snapshot   After a snapshot of the tracker was loaded, is_restored = 1 makes the node restart
 *            where the first scan is more than jump_max_us older than the snapshot.
 *
 * Stack: 32 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_NODE_H
#define RHOTRACK_NODE_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/frames.h"
#include "rhotrack/initiator.h"
#include "rhotrack/message.h"
#include "rhotrack/passive.h"
#include "rhotrack/scan_assembler.h"
#include "rhotrack/tracker.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A scan of plots that waits for the step of the open frame. */
struct rho_node_waiting {
    struct rho_scan scan;
    struct rho_sensor sensor;
    int has_sensor;
    struct rho_plot plots[RHO_MAX_PLOTS];
};

struct rho_node_config {
    struct rho_scan_assembler *assembler;
    struct rho_tracker *tracker;
    struct rho_report *report; /* report of the last step */
    /* frames of bearings; NULL: scans of bearings are refused, and passive is NULL, too */
    struct rho_frames *frames;
    /*
     * NULL: after rho_node_step the caller starts tracks from the frame that rho_frames_closed
     * shows, as rho_passive_paper_step does; sensors farther apart than apart_max_m (of its
     * batch) are refused
     */
    struct rho_passive *passive;
    /* largest distance of two passive sensors, above 0; used with frames and without passive */
    float apart_max_m;
    /* array of waiting_max entries; NULL where waiting_max is 0 */
    struct rho_node_waiting *waiting;
    uint16_t waiting_max;
    /* largest range of passive sensors whose range is not described; 0: 2 RHO_LIMIT_POSITION_M */
    float passive_range_max_m;
    int32_t epoch; /* boot number in the messages that are published */
};

/* Counters of a node since rho_node_init; all saturate. */
struct rho_node_counters {
    uint32_t steps;
    uint32_t restarts;
    /* scans stepped before hold_us had passed, because another scan needed their room */
    uint32_t scans_early;
    uint32_t scans_refused;  /* scans that the tracker refused, or whose sensor it refused */
    uint32_t plots_refused;  /* plots of scans whose sensor the tracker refused */
    uint32_t frames_refused; /* frames that the tracker refused */
    /* scans of bearings whose sensor is too far from the others, or has no room in the frames */
    uint32_t bearings_refused;
    uint32_t sensors_refused; /* descriptions of sensors that the tracker refused */
    /* descriptions of silent sensors that the tracker was made to forget */
    uint32_t sensors_forgotten;
};

/* Durations of the steps since the last rho_node_status. */
struct rho_node_timing {
    uint32_t sum_us, max_us, steps;
};

enum rho_node_due {
    RHO_NODE_NOTHING = 0,
    RHO_NODE_SCAN,   /* a scan of plots, `scan` of the node, is due: rho_node_step steps it */
    RHO_NODE_FRAME,  /* a frame of bearings is due: rho_node_step steps it */
    RHO_NODE_RESTART /* tracker and initiators are to be initialised anew */
};

struct rho_node {
    uint32_t magic;
    int32_t step;  /* number of the last step; wraps */
    int32_t epoch; /* boot number, set by the caller: to be another one after each restart */
    struct rho_node_config config;
    struct rho_node_counters counters;
    struct rho_node_timing timing;
    struct rho_scan scan; /* scan that rho_node_step steps */
    /* private: the scan that was taken last from the assembler */
    struct rho_scan_assembler_item item;
    int64_t now_us; /* reception time that the caller gave last */
    /*
     * private: reception time at which the open frame closes; INT64_MAX: only another scan does it
     */
    int64_t frame_due_us;
    uint16_t first_waiting, num_waiting; /* private: ring of waiting scans in the order of time */
    /*
     * set by the caller. 1: the tracker was loaded from a snapshot, and no scan has come since
     */
    uint8_t is_restored;
    /* private: item holds a scan that is not given yet; all following fields are private, too */
    uint8_t has_item;
    uint8_t is_making_room;
    uint8_t is_forgetting;
    uint8_t has_closed;
    uint8_t due;          /* enum rho_node_due: the task that rho_node_next gave last */
    uint8_t stepped;      /* enum rho_node_due: the task that was stepped last */
    uint8_t next_learned; /* place of the sensor whose learned_t rho_node_learned makes next */
    /* successive refused scans of each sensor of the frames */
    uint8_t refused_scans[RHO_MAX_PASSIVE_SENSORS];
};

/*
 * Prepares a node; the config is copied. Its objects are initialised and empty, or from a snapshot.
 *   size   sizeof(struct rho_node) of the caller
 * Errors: NULL (also where an object is missing), SIZE, STATE (frames that are not
 * initialised), CONFIG (a range that is negative or not finite). Cost: sizeof(node) bytes cleared.
 * Stack: 120 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_node_init(struct rho_node *node, size_t size,
                                             const struct rho_node_config *config);

/*
 * Takes one message of any bytes, as rho_scan_assembler_take does.
 * Errors: NULL, STATE (not initialised), TYPE (not a sensor's channel), CAPACITY: do the tasks of
 * rho_node_next until it returns RHO_NODE_NOTHING, and take the message again.
 * Stack: 2 KB.
 */
RHO_MUST_CHECK enum rho_status rho_node_take(struct rho_node *node, const char *channel,
                                             const uint8_t *data, size_t size, int64_t now_us);

/*
 * Returns the next task of the caller; RHO_NODE_NOTHING also where the node is not initialised.
 * now_us INT64_MAX: no scan waits any longer. Cost: that of rho_scan_assembler_next; the plots of a
 * scan are copied where it waits; with passive sensors, that of rho_frames_push.
 * Stack: 450 bytes.
 */
enum rho_node_due rho_node_next(struct rho_node *node, int64_t now_us);

/*
 * Steps the scan or frame that rho_node_next has given, once.
 *   initiator  starts tracks from a scan's plots; NULL: none start. Not used for a frame.
 * Errors: NULL (node), STATE (nothing is due), and those of rho_tracker_step, which are counted;
 * the report then stays that of the step before. Cost: that of rho_tracker_step.
 * Stack: 4 KB.
 */
RHO_MUST_CHECK enum rho_status rho_node_step(struct rho_node *node,
                                             struct rho_initiator *initiator);

/* Counts the duration of a step for rho_node_status. Constant cost. */
void rho_node_count_time(struct rho_node *node, int64_t took_us);

/*
 * Reception time at which rho_node_next is to be called even if no message has come; INT64_MAX:
 * only after a message. Cost: RHO_MAX_OPEN_SCANS times RHO_MAX_SENSORS.
 * Stack: 190 bytes.
 */
int64_t rho_node_due_us(const struct rho_node *node);

/*
 * Number of messages of the last step: tracks in parts, then peaks, then the tracks' bodies in
 * parts where the tracker estimates bodies. Cost: with bodies, that of rho_publish_num_body_parts.
 */
uint16_t rho_node_num_messages(const struct rho_node *node);

/* Channel of a message of the last step; part: as in rho_node_publish. Constant cost. */
const char *rho_node_channel(const struct rho_node *node, uint16_t part);

/*
 * Writes a message of the last step.
 *   initiator  the step's: its candidates are the peaks; NULL: no peaks. Not used after a frame.
 *   part       0 .. rho_node_num_messages - 1
 * Errors: NULL, VALUE (no such part), CAPACITY (of the buffer); *size is unchanged. Cost: that of
 * rho_publish_tracks, rho_publish_bodies and rho_publish_peaks. Stack: 480 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_node_publish(const struct rho_node *node,
                                                const struct rho_initiator *initiator,
                                                uint16_t part, uint8_t *buffer, size_t capacity,
                                                size_t *size);

/*
 * Fills status_t but for fragments_refused and the origin, which the caller fills; the node's step
 * times begin anew.
 *   initiator  tells the density of clutter; NULL: the density is 0
 * Cost: that of rho_publish_status. Stack: 200 bytes.
 */
void rho_node_status(struct rho_node *node, const struct rho_initiator *initiator,
                     struct rho_message_status *status);

/*
 * Fills work_t but for reports_not_printed and events_not_logged, which the caller fills.
 * Constant cost. Stack: 120 bytes.
 */
void rho_node_work(const struct rho_node *node, struct rho_message_work *work);

/*
 * Fills learned_t of one described sensor; successive calls go through all described sensors.
 * Returns 0 where no sensor is described; *learned is unchanged then. Cost: that of
 * rho_publish_learned. Stack: 248 bytes.
 */
int rho_node_learned(struct rho_node *node, struct rho_message_learned *learned);

#ifdef __cplusplus
}
#endif

#endif
