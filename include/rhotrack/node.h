/* SPDX-License-Identifier: MIT */
/*
 * node: the whole live tracker without its network: takes messages of sensors and operators, makes
 * messages of tracks.
 *
 *     static struct rho_node node;
 *
 *     rho_settings_preset(&settings, RHO_PRESET_MARINE);
 *     rho_node_init(&node, sizeof node, &settings);
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
 *     while (rho_node_next(&node, now_us) != RHO_NODE_NOTHING) {
 *         for (part = 0; part < rho_node_num_messages(&node); part++) {
 *             if (rho_node_publish(&node, part, buffer, sizeof buffer, &size) == RHO_OK) {
 *                 send(rho_node_channel(&node, part), buffer, size);
 *             }
 *         }
 *     }
 *
 * The node holds all that the build has (config.h): scan assembler, tracker, report, the first
 * initiation window, passive search, the papers' methods, zones, learned walls, an operator's
 * commands. All may be read; what the tracker is told (sensors, walls, excluded
 * areas) is told to node.tracker by its own functions, known sensors to node.assembler
 * (rho_scan_assembler_set_sensor), between two calls of the node.
 *
 * Chain      A step of a scan: its window's initiator, rho_tracker_step, starts by the papers'
 *            method where that is chosen, learning of walls, commands of the operator, zones. A
 *            scan of bearings likewise, without windows and walls.
 * Order      Scans are stepped in the order in which the scan assembler gives them.
 * Windows    Two radars of much the same coverage start tracks from one window (RHO_NODE_PAIRS):
 *            with twice the plots they find targets sooner. They pair in the order of their
 *            descriptions. Three radars would be too many for a window of seven scans; and radars
 *            with very different times of a turn, with sectors, or that came as messages and are
 *            not described to the assembler, do not share. A radar that leaves a shared window
 *            takes its scans along. The node holds one window; storage for others is given by
 *            rho_node_add_storage. Where there is none, radars share the last one.
 * Sensors    Each sensor is described to the tracker before its scan is stepped. Where the tracker
 *            has no room for another one, it forgets those that have been silent for jump_max_us.
 * Restart    Where the sensors' clock was set, tracks cannot go on: after the last step of the old
 *            time the node begins anew, with the next epoch. Configuration, counters, zones, walls,
 *            excluded areas and the clutter map's standing echoes stay; tracks, windows and the
 *            searches' batches are empty.
 * Commands   Run after the next step, at most a minute later, and answered. Nothing proves who sent
 *            them: takes_commands is for private networks. A setting changes the node's settings as
 *            if it had been started with them.
 * Snapshot   rho_node_list_parts and rho_snapshot_save save the node, rho_node_load loads it. Where
 *            the first scan is more than jump_max_us older than the snapshot, the node restarts.
 *
 * A program that has scans already calls rho_node_step_scan and rho_node_step_bearings instead
 * of rho_node_take and rho_node_next.
 *
 * Stack: 40 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_NODE_H
#define RHOTRACK_NODE_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/initiator.h"
#include "rhotrack/message.h"
#include "rhotrack/paper_starts.h"
#include "rhotrack/passive.h"
#include "rhotrack/passive_paper.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/scan_assembler.h"
#include "rhotrack/settings.h"
#include "rhotrack/snapshot.h"
#include "rhotrack/tracker.h"
#include "rhotrack/types.h"
#include "rhotrack/zones.h"

RHO_BEGIN_C

/* 1 where the build has bearings; the search for tracks in them; the papers' search in them. */
#define RHO_NODE_HAS_BEARINGS (((RHO_SCAN_KINDS)&4) != 0)
#define RHO_NODE_HAS_PASSIVE (RHO_NODE_HAS_BEARINGS && (RHO_SEARCHES))
#define RHO_NODE_HAS_PASSIVE_PAPER (RHO_NODE_HAS_BEARINGS && (RHO_PAPERS))

/* Which radars share an initiation window. */
enum rho_node_windows {
    RHO_NODE_PAIRS = 0, /* two of much the same coverage */
    RHO_NODE_SINGLE,    /* none */
    RHO_NODE_ONE,       /* all */
    RHO_NUM_NODE_WINDOWS
};

/* What a node does, besides; 0 where the build does not have it. */
struct rho_node_options {
    uint8_t windows; /* enum rho_node_windows */
    /* 1: the papers' methods start tracks, from plots and from bearings (RHO_PAPERS) */
    uint8_t is_plots_by_paper, is_bearings_by_paper;
    uint8_t learns_reflectors; /* 1: walls are learned (RHO_LEARNS_REFLECTORS) */
    uint8_t takes_commands;    /* 1: an operator's commands are run (RHO_MAX_COMMANDS) */
    uint8_t reserved[3];       /* padding: 0 */
};

/* Configurations of all parts; those that the build does not have are not used. */
struct rho_node_config {
    struct rho_tracker_config tracker;
    struct rho_scan_assembler_config assembler;
    struct rho_initiator_config initiator;
    struct rho_passive_config passive;
    struct rho_paper_starts_config paper_starts;
    struct rho_passive_paper_config passive_paper;
    /* largest range of passive sensors whose range is not described; 0: 2 RHO_LIMIT_POSITION_M */
    float passive_range_max_m;
    float body_max_m; /* longest target that gives several plots (body.h); 0: all give one */
    int32_t epoch;    /* boot number in the messages that are published */
    struct rho_node_options options;
};

/* Counters of a node since rho_node_init; all saturate. */
struct rho_node_counters {
    uint32_t steps;
    uint32_t restarts;
    /* scans stepped before hold_us had passed, because another scan needed their room */
    uint32_t scans_early;
    uint32_t scans_refused; /* scans that the tracker refused, or whose sensor it refused */
    uint32_t plots_refused; /* plots of scans whose sensor the tracker refused */
    /* scans of bearings whose sensor has no room beside the others, or is too far from them */
    uint32_t bearings_refused;
    uint32_t sensors_refused; /* descriptions of sensors that the tracker refused */
    /* descriptions of silent sensors that the tracker was made to forget */
    uint32_t sensors_forgotten;
    uint32_t commands_done, commands_refused; /* answered commands and settings */
    uint32_t commands_bad;                    /* commands that cannot be decoded */
    uint32_t commands_not_allowed;            /* commands that came while none were taken */
};

/* Durations of the steps since the last rho_node_status. */
struct rho_node_timing {
    uint32_t sum_us, max_us, steps;
};

/* What rho_node_next has done. */
enum rho_node_due {
    RHO_NODE_NOTHING = 0,
    RHO_NODE_SCAN,     /* stepped a scan of plots, `scan` of the node */
    RHO_NODE_BEARINGS, /* stepped a scan of bearings */
    RHO_NODE_RESTART,  /* begun anew on another clock of the sensors */
    RHO_NODE_ANSWER    /* refused commands: only their answers are to be published */
};

/* An operator's command or setting that waits for the end of a step; and its answer. */
struct rho_node_command {
    int64_t came_us;
    int is_setting;
    struct rho_message_command command;
    struct rho_message_setting setting;
};
struct rho_node_answer {
    int is_setting;
    struct rho_message_command_answer command;
    struct rho_message_setting_answer setting;
};

/* Commands and answers in the order in which they came. */
struct rho_node_operator {
    uint16_t num_commands, num_answers;
    uint16_t num_shown; /* answers that are messages of the last rho_node_next */
    struct rho_node_command commands[RHO_MAX_COMMANDS + 1];
    struct rho_node_answer answers[RHO_MAX_COMMANDS + 1];
};

/* Initiation windows: places and sensors of those that are used, and place of the newest scan's. */
struct rho_node_window_list {
    uint16_t count, newest;
    uint16_t num_places; /* windows that there is memory for */
    uint16_t has_sensor; /* 1: the first window has its sensor */
    uint32_t shared;     /* scans of radars for which there was no window of their own; saturates */
    int32_t sensor_id[RHO_MAX_WINDOWS];
    /* windows in the storage that the caller gave */
    struct rho_initiator *more[RHO_MAX_WINDOWS > 1 ? RHO_MAX_WINDOWS - 1 : 1];
};

struct rho_node {
    uint32_t magic;
    int32_t step;  /* number of the last step; wraps */
    int32_t epoch; /* boot number; the next one after each restart, or as the caller sets it then */
    struct rho_node_counters counters;
    struct rho_node_timing timing;
    struct rho_settings told, settings; /* as at rho_node_init, and as changed by commands */
    uint32_t settings_changed;          /* number of settings that commands changed; saturates */
    struct rho_scan scan;               /* the last scan that was stepped */
    int64_t now_us;                     /* reception time that the caller gave last */

    struct rho_node_window_list windows;

    /* private, up to the parts: the scan that was taken last from the assembler */
    struct rho_scan_assembler_item item;
    float passive_range_max_m;
    struct rho_node_options options;
    uint8_t is_restored; /* 1: a snapshot was loaded, and no scan has come since */
    uint8_t has_item;    /* item holds a scan that is not stepped yet */
    uint8_t is_making_room;
    uint8_t done;         /* enum rho_node_due: what the last call for steps has done */
    uint8_t next_learned; /* place of the sensor whose learned_t rho_node_learned makes next */

    struct rho_report report; /* report of the last step */
    struct rho_scan_assembler assembler;
    struct rho_tracker tracker;
#if RHO_SEARCHES
    struct rho_initiator initiator; /* the first window */
#endif
#if RHO_SEARCHES && RHO_MAX_WINDOWS > 1
    struct rho_plot unpacked[RHO_MAX_PLOTS]; /* private: scratch of a radar that leaves a window */
    uint8_t fates[RHO_MAX_PLOTS];
#endif
#if RHO_NODE_HAS_PASSIVE
    struct rho_passive passive;
#endif
#if RHO_PAPERS
    struct rho_paper_starts paper_starts;
#endif
#if RHO_NODE_HAS_PASSIVE_PAPER
    struct rho_passive_paper passive_paper;
#endif
#if RHO_MAX_ZONES > 0
    struct rho_zones zones;
#endif
#if RHO_LEARNS_REFLECTORS
    struct rho_reflector_learning learning;
#endif
#if RHO_MAX_COMMANDS > 0
    struct rho_node_operator operated; /* private */
#endif
};

/*
 * Fills the configurations with the defaults of all parts and the settings: rho_settings_apply, and
 * for sensors that are not described rho_settings_apply_sensor and the sigmas; papers' cells that
 * hold range_max_m. Epoch 0, pairs of radars; the papers' methods only in a build without the
 * searches; no bodies, no learning of walls, no commands. Constant cost. Stack: 150 bytes.
 */
void rho_node_config_default(struct rho_node_config *config, const struct rho_settings *settings);

/*
 * Prepares a node with rho_node_config_default; the settings are copied.
 *   size   sizeof(struct rho_node) of the caller
 * Errors: NULL, SIZE, CONFIG (settings that rho_settings_check refuses; where RHO_MAX_COMMANDS is
 * 0, to save flash, only those that a part refuses). Cost: sizeof(node) bytes cleared.
 * Stack: 1.5 KB.
 */
RHO_MUST_CHECK enum rho_status rho_node_init(struct rho_node *node, size_t size,
                                             const struct rho_settings *settings);

/*
 * Gives the parts of an initialised node other configurations; all of them begin anew, but zones,
 * storage and the node's counters stay. Commands that wait are dropped. Errors: NULL, STATE (not
 * initialised), CONFIG (a value that a part refuses, or a part that the build does not have): the
 * node is then to be initialised again. Cost: that of rho_node_init. Stack: 800 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_node_configure(struct rho_node *node,
                                                  const struct rho_node_config *config);

/*
 * Gives the parts for bearings alone other configurations: passive_range_max_m, passive search,
 * and the papers' search where is_bearings_by_paper is set. They begin anew; tracks go on.
 * Errors: NULL, STATE, CONFIG, as rho_node_configure; TYPE (RHO_SCAN_KINDS has no bearings): the
 * node goes on. Cost: their bytes cleared. Stack: 300 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_node_configure_bearings(struct rho_node *node,
                                                           const struct rho_node_config *config);

/*
 * Gives tracker and initiators other configurations from the next step on; tracks, windows and all
 * that was learned go on. Nothing else of the config is used.
 * Errors: NULL, STATE, CONFIG, as rho_tracker_reconfigure and rho_initiator_reconfigure; nothing
 * is changed. Cost: windows. Stack: 560 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_node_reconfigure(struct rho_node *node,
                                                    const struct rho_node_config *config);

/*
 * Applies other settings, from the next step on, to tracker, initiators and the descriptions of
 * sensors: a sensor follows a setting that its description equals (or a range that it does not
 * state). Settings that the node has change nothing.
 * Errors: NULL, STATE, CONFIG (rho_settings_check; or a sensor's least range would not be below its
 * largest); nothing is changed. Cost: windows and sensors. Stack: 920 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_node_set_settings(struct rho_node *node,
                                                     const struct rho_settings *settings);

/* Bytes of storage for further initiation windows. Constant cost. */
size_t rho_node_storage_size(unsigned num_windows);

/* 1 where the next radar would have to share a window for want of storage. Constant cost. */
int rho_node_wants_storage(const struct rho_node *node);

/*
 * Gives storage for as many windows as fit, RHO_MAX_WINDOWS in all; it may be called again. The
 * memory, aligned as struct rho_initiator, stays the caller's until the node is no longer used.
 * Errors: NULL, STATE (not initialised), VALUE (alignment), SIZE (less than a window), CAPACITY (no
 * further window is used). Cost: windows.
 */
RHO_MUST_CHECK enum rho_status rho_node_add_storage(struct rho_node *node, void *memory,
                                                    size_t size);

/*
 * Adds a zone, as rho_zones_add. Errors: those of rho_zones_add; CAPACITY where RHO_MAX_ZONES is 0.
 * Stack: 130 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_node_add_zone(struct rho_node *node,
                                                 const struct rho_zone *zone);

/*
 * Takes one message of any bytes: a sensor's, as rho_scan_assembler_take does, or an operator's.
 * Errors: NULL, STATE (not initialised), TYPE (another channel), CAPACITY: call rho_node_next until
 * it returns RHO_NODE_NOTHING, and take the message again. Stack: 2 KB.
 */
RHO_MUST_CHECK enum rho_status rho_node_take(struct rho_node *node, const char *channel,
                                             const uint8_t *data, size_t size, int64_t now_us);

/*
 * Makes the next step that is due, or restarts the node, and returns what it has done;
 * RHO_NODE_NOTHING also where the node is not initialised. Steps that the tracker refuses are
 * counted and passed over. now_us INT64_MAX: no scan waits any longer, and commands that wait are
 * refused. Cost: that of rho_scan_assembler_next and of the chain. Stack: 4.9 KB.
 */
enum rho_node_due rho_node_next(struct rho_node *node, int64_t now_us);

/* Counts the duration of a step for rho_node_status. Constant cost. */
void rho_node_count_time(struct rho_node *node, int64_t took_us);

/*
 * Reception time at which rho_node_next is to be called even if no message has come; INT64_MAX:
 * only after a message. Cost: RHO_MAX_OPEN_SCANS times RHO_MAX_SENSORS. Stack: 200 bytes.
 */
int64_t rho_node_due_us(const struct rho_node *node);

/*
 * Steps a scan of plots or bearings by the same chain. The tracker is to know its sensor
 * (rho_tracker_set_sensor). Any two radars may share a window. Errors: NULL, STATE (not
 * initialised), TYPE (the build has no such scans), and those of rho_tracker_step and
 * rho_paper_starts_step; after the latter the step was made. Stack: 4.8 KB.
 */
RHO_MUST_CHECK enum rho_status rho_node_step_scan(struct rho_node *node,
                                                  const struct rho_scan *scan);
RHO_MUST_CHECK enum rho_status rho_node_step_bearings(struct rho_node *node,
                                                      const struct rho_bearing_scan *scan);

/*
 * Number of messages of the last rho_node_next, rho_node_step_scan or rho_node_step_bearings:
 * answers to an operator; after a step tracks in parts, peaks, bodies in parts where the tracker
 * estimates them, and events of zones, if any. Cost: with bodies, that of
 * rho_publish_num_body_parts.
 */
uint16_t rho_node_num_messages(const struct rho_node *node);

/* Channel of one of these messages, by its part as below; NULL: no such part. Cost: as above. */
const char *rho_node_channel(const struct rho_node *node, uint16_t part);

/*
 * Writes one of these messages.
 *   part   0 .. rho_node_num_messages - 1
 * Errors: NULL, STATE, VALUE (no such part), CAPACITY (of the buffer); *size is unchanged. Cost:
 * that of rho_publish_tracks, rho_publish_bodies and rho_publish_peaks. Stack: 480 bytes; with
 * zones 1.6 KB.
 */
RHO_MUST_CHECK enum rho_status rho_node_publish(const struct rho_node *node, uint16_t part,
                                                uint8_t *buffer, size_t capacity, size_t *size);

/*
 * Fills status_t but for fragments_refused and the origin, which the caller fills; the node's step
 * times begin anew. Cost: that of rho_publish_status. Stack: 200 bytes.
 */
void rho_node_status(struct rho_node *node, struct rho_message_status *status);

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

/*
 * Writes part 0, 1, ... of the lives of the node's tracks (life_t), for RHO_MESSAGE_LIFE_CHANNEL.
 * Errors: NULL, STATE (not initialised), VALUE (no such part), CAPACITY; *size is unchanged. Cost:
 * that of rho_publish_life. Stack: 288 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_node_life(const struct rho_node *node, uint16_t part,
                                             uint8_t *buffer, size_t capacity, size_t *size);

/*
 * Window with this place, 0 .. windows.count - 1; that of the newest scan is windows.newest. NULL:
 * there is none. Constant cost.
 */
struct rho_initiator *rho_node_window(struct rho_node *node, unsigned place);

/* Largest number of parts of a node's snapshot. */
#define RHO_NODE_PARTS (RHO_MAX_WINDOWS + 5)

/*
 * Lists the parts for rho_snapshot_save: tracker, windows by their sensors' numbers, passive
 * search, settings as told and as they are, learned walls. They point into node and storage.
 *   parts   RHO_NODE_PARTS of them
 * Returns their number; 0 where the node is not initialised. Cost: windows. Stack: 48 bytes.
 */
unsigned rho_node_list_parts(struct rho_node *node, struct rho_snapshot_part *parts);

/*
 * Loads a snapshot of a node that was initialised and configured alike, and has storage for as many
 * windows. Settings that an operator had changed are applied.
 *   image   as for rho_snapshot_load
 * Errors: those of rho_snapshot_load, CONFIG (the snapshot was made with other settings, or has
 * other parts), CAPACITY (too little storage). Nothing is changed, but windows begin anew. Cost:
 * that of rho_snapshot_load. Stack: 1.6 KB, and 16 bytes a window.
 */
RHO_MUST_CHECK enum rho_status rho_node_load(struct rho_node *node, const void *image, size_t size);

/*
 * Settings in a snapshot of a node, as they were when it was saved. Errors: those of
 * rho_snapshot_list, CONFIG (the image has none). Cost: the checksum. Stack: 280 bytes, and 16 a
 * window.
 */
RHO_MUST_CHECK enum rho_status rho_node_saved_settings(const void *image, size_t size,
                                                       struct rho_settings *settings);

RHO_END_C

#endif
