/* SPDX-License-Identifier: MIT */
/*
 * node: a live tracker without its network: messages of sensors in, messages of tracks out.
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
 *            closes when nothing has come for as long as its sensors may differ and messages wait.
 * Sensors    Each sensor is described to the tracker before its scan is stepped. Where the tracker
 *            has no room for another one, it forgets those that have been silent for jump_max_us.
 *            A passive sensor that is silent for so long and keeps another one out of the frames,
 *            and one that stands at another place in 16 scans in a row, make the frames begin anew.
 * Restart    The sensors' clock was set: tracks do not go on across that. RHO_NODE_RESTART says so
 *            after the last step of the old time; frames and search have begun anew by then.
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

/* A scan of plots that waits for the open frame. */
struct rho_node_waiting {
    struct rho_scan scan;
    struct rho_sensor sensor;
    int has_sensor;
    struct rho_plot plots[RHO_MAX_PLOTS];
};

struct rho_node_config {
    struct rho_scan_assembler *assembler;
    struct rho_tracker *tracker;
    struct rho_report *report; /* of the last step */
    struct rho_frames *frames; /* NULL: scans of bearings are refused; then passive is NULL, too */
    /*
     * NULL: after rho_node_step the caller starts tracks from the frame that rho_frames_closed
     * shows, as rho_passive_paper_step does; sensors farther apart than apart_max_m (of its
     * batch) are refused
     */
    struct rho_passive *passive;
    float apart_max_m;                /* above 0 with frames and without passive; else not used */
    struct rho_node_waiting *waiting; /* waiting_max of them; NULL where that is 0 */
    uint16_t waiting_max;
    /* Range of passive sensors of which no range is known (2 RHO_LIMIT_POSITION_M); 0: that one. */
    float passive_range_max_m;
    int32_t epoch; /* boot number, in the messages */
};

/* Since init; all saturate. */
struct rho_node_counters {
    uint32_t steps;
    uint32_t restarts;
    uint32_t scans_early;      /* given before hold_us had passed: another scan needed their room */
    uint32_t scans_refused;    /* the tracker does not take the scan, or not its sensor */
    uint32_t plots_refused;    /* of scans whose sensor the tracker does not take */
    uint32_t frames_refused;   /* likewise by the tracker */
    uint32_t bearings_refused; /* scans: the sensor is too far from the others, or one too many */
    uint32_t sensors_refused;  /* descriptions */
    uint32_t sensors_forgotten; /* descriptions of silent sensors */
};

/* Step times since the last rho_node_status. */
struct rho_node_timing {
    uint32_t sum_us, max_us, steps;
};

enum rho_node_due {
    RHO_NODE_NOTHING = 0,
    RHO_NODE_SCAN,   /* rho_node_step steps a scan of plots: `scan` of the node */
    RHO_NODE_FRAME,  /* rho_node_step steps a frame of bearings */
    RHO_NODE_RESTART /* tracker and initiators have to begin anew */
};

struct rho_node {
    uint32_t magic;
    int32_t step;  /* number of the last step; wraps */
    int32_t epoch; /* the caller's: to be another one after each restart */
    struct rho_node_config config;
    struct rho_node_counters counters;
    struct rho_node_timing timing;
    struct rho_scan scan;                /* to be stepped */
    struct rho_scan_assembler_item item; /* private: the scan that was taken last */
    int64_t now_us;                      /* reception clock, of the last call that told it */
    int64_t frame_due_us; /* private: when the open frame closes; INT64_MAX: with another scan */
    uint16_t first_waiting, num_waiting; /* private: in the order of time */
    uint8_t
        is_restored;  /* the caller's: 1: the tracker is a snapshot's, and no scan has come since */
    uint8_t has_item; /* private, as all that follow */
    uint8_t is_making_room;
    uint8_t is_forgetting;
    uint8_t has_closed;
    uint8_t due;          /* enum rho_node_due */
    uint8_t stepped;      /* likewise, of the last step */
    uint8_t next_learned; /* place of the sensor that rho_node_learned tells of next */
    uint8_t refused_scans[RHO_MAX_PASSIVE_SENSORS]; /* in a row, of each of the frames' sensors */
};

/*
 * Prepares a node; the config is copied. The objects are initialised and empty, or a snapshot's.
 *   size   sizeof(struct rho_node) of the caller
 * Errors: NULL (also of an object that is not there), SIZE, STATE (frames that are not
 * initialised), CONFIG (a range that is negative or not finite). Cost: sizeof(node) bytes cleared.
 * Stack: 120 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_node_init(struct rho_node *node, size_t size,
                                             const struct rho_node_config *config);

/*
 * Takes one message; any bytes may be given: rho_scan_assembler_take says what becomes of them.
 * Errors: NULL, STATE (not initialised), TYPE (no sensor's channel), CAPACITY: do what
 * rho_node_next says until it is RHO_NODE_NOTHING, and take the message again.
 * Stack: 2 KB.
 */
RHO_MUST_CHECK enum rho_status rho_node_take(struct rho_node *node, const char *channel,
                                             const uint8_t *data, size_t size, int64_t now_us);

/*
 * The next task of the caller. now_us INT64_MAX: all that is there is stepped.
 * RHO_NODE_NOTHING also where the node is not initialised. Cost: that of rho_scan_assembler_next,
 * the plots of a scan copied where it waits, of passive sensors that of rho_frames_push.
 * Stack: 450 bytes.
 */
enum rho_node_due rho_node_next(struct rho_node *node, int64_t now_us);

/*
 * Steps what rho_node_next has given, once.
 *   initiator  of a scan: where its plots start tracks; NULL: nowhere. Of a frame it is not used.
 * Errors: NULL (node), STATE (nothing is due), those of rho_tracker_step, which are counted; the
 * report is that of the step before, then. Cost: that of rho_tracker_step.
 * Stack: 4 KB.
 */
RHO_MUST_CHECK enum rho_status rho_node_step(struct rho_node *node,
                                             struct rho_initiator *initiator);

/* Counts the time that a step took, for rho_node_status. Constant cost. */
void rho_node_count_time(struct rho_node *node, int64_t took_us);

/*
 * When rho_node_next is to be called though no message has come, by the reception clock;
 * INT64_MAX: not before one comes. Cost: RHO_MAX_OPEN_SCANS times RHO_MAX_SENSORS.
 * Stack: 190 bytes.
 */
int64_t rho_node_due_us(const struct rho_node *node);

/*
 * Messages of the last step: its tracks in parts, then its peaks, then the bodies of its tracks in
 * parts, where the tracker was told of bodies. Cost: then that of rho_publish_num_body_parts.
 */
uint16_t rho_node_num_messages(const struct rho_node *node);

/* The channel of such a message. Constant cost. */
const char *rho_node_channel(const struct rho_node *node, uint16_t part);

/*
 * Writes a message of the last step.
 *   initiator  that of the step: its candidates are the peaks; NULL: none. Of a frame not used.
 *   part       0 .. rho_node_num_messages - 1
 * Errors: NULL, VALUE (no such part), CAPACITY (of the buffer); *size is unchanged. Cost: that of
 * rho_publish_tracks, rho_publish_bodies and rho_publish_peaks. Stack: 480 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_node_publish(const struct rho_node *node,
                                                const struct rho_initiator *initiator,
                                                uint16_t part, uint8_t *buffer, size_t capacity,
                                                size_t *size);

/*
 * Fills status_t but for fragments_refused and the origin, which are the caller's; step times begin
 * anew.
 *   initiator  its density of clutter is told; NULL: 0
 * Cost: that of rho_publish_status. Stack: 200 bytes.
 */
void rho_node_status(struct rho_node *node, const struct rho_initiator *initiator,
                     struct rho_message_status *status);

/*
 * Fills work_t but for reports_not_printed and events_not_logged, which are the caller's.
 * Constant cost. Stack: 120 bytes.
 */
void rho_node_work(const struct rho_node *node, struct rho_message_work *work);

/*
 * Fills learned_t of one described sensor: at each call of the next one.
 * Returns 0 where no sensor is described; *learned is unchanged then. Cost: that of
 * rho_publish_learned. Stack: 248 bytes.
 */
int rho_node_learned(struct rho_node *node, struct rho_message_learned *learned);

#ifdef __cplusplus
}
#endif

#endif
