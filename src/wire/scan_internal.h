/* SPDX-License-Identifier: MIT */
/*
 * Functions that are private to the scan assembler: decoding of messages, admission of scans, slots
 * in which scans are assembled, and the conversion of messages to plots.
 */
#ifndef RHOTRACK_SCAN_INTERNAL_H
#define RHOTRACK_SCAN_INTERNAL_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/message.h"
#include "rhotrack/scan_assembler.h"

enum { SCAN_MAGIC = 0x66656564 /* of an initialised assembler */ };

/* A decoded message: the member of its kind. */
union scan_message {
    struct rho_message_plot_scan plots;
    struct rho_message_polar_scan polar;
    struct rho_message_bearing_scan bearings;
    struct rho_message_direction_scan directions;
};

/* Kinds of messages: those of scans, and directions, whose scans are of bearings. */
enum { SCAN_MESSAGE_DIRECTIONS = RHO_NUM_SCAN_ASSEMBLER_KINDS, NUM_SCAN_MESSAGES };

/* Values of a message that do not depend on its kind: of its part, and of the scan of that part. */
struct scan_heading {
    struct rho_scan_assembler_place place;
    uint32_t measures;
    float sector_from_rad, sector_to_rad;
    float x_m, y_m, z_m; /* position of the sensor; 0, 0, 0: not stated */
    uint16_t part, num_parts;
    uint16_t num_inputs;
    int16_t sensor_id;
    uint8_t kind;           /* enum rho_scan_assembler_kind */
    uint8_t is_new;         /* 1: the sensor is a newcomer that the config does not name */
    uint8_t has_directions; /* 1: bearings of a direction_scan_t */
    uint32_t check;         /* checksum of the message's bytes; above CHECK_NOT_ADMITTED */
};

/* Classification of a scan by its number and time. */
enum scan_verdict {
    SCAN_NEXT,            /* accepted: it follows the sensor's newest scan */
    SCAN_RESTARTS_SENSOR, /* accepted: it continues a series of refused scans */
    SCAN_DUPLICATE,       /* refused: received before */
    SCAN_OUT_OF_SEQUENCE, /* accepted: its number was skipped, and it is still usable */
    SCAN_TOO_LATE,        /* refused: older than the newest scan, and not usable any more */
    SCAN_WRONG_NUMBER,    /* refused for its number or epoch */
    SCAN_WRONG_TIME       /* refused for its time */
};

/* Values of source.check; higher ones are checksums of the first part of the newest scan. */
enum scan_check {
    CHECK_NONE = 0,    /* no first part was received */
    CHECK_NOT_ADMITTED /* the scan of a newcomer was refused its turn */
};

/* 1 in builds for several sensors: only these have newcomers, and votes on the clock. */
#define HAS_OTHERS (RHO_MAX_SENSORS > 1)

/*
 * 1 in builds that use out-of-sequence scans: the tracker takes them, or the newer scan may still
 * wait in a slot.
 */
#define TAKES_LATE ((RHO_SECTORS) || RHO_MAX_OPEN_SCANS > 1)

/*
 * 1 in builds that follow a sensor which begins again with numbers and times that it has sent. With
 * one sensor there is no room for that: its epoch, numbers or clock tell of a restart.
 */
#define FOLLOWS_REPEATS HAS_OTHERS

/* scan_admission.c: numbers and clocks */

/* Classifies a scan by the numbers and times of its sensor's scans before it. */
enum scan_verdict rho_scan_classify(const struct rho_scan_assembler *assembler,
                                    const struct rho_scan_assembler_source *source,
                                    const struct rho_scan_assembler_place *place, int64_t now_us);

/* 1 where a refused scan may belong to a new sequence of its sensor, if others agree with it. */
int rho_scan_may_begin_sequence(const struct rho_scan_assembler_config *config,
                                const struct rho_scan_assembler_source *source,
                                const struct rho_scan_assembler_place *place,
                                enum scan_verdict verdict);

/* Adds a refused scan to the series that it continues, or begins a series of refused scans. */
void rho_scan_remember_refused(const struct rho_scan_assembler_config *config,
                               struct rho_scan_assembler_source *source,
                               const struct rho_scan_assembler_place *place);

/* Makes an accepted scan its sensor's newest. Returns the number of skipped scan numbers. */
uint32_t rho_scan_set_newest(const struct rho_scan_assembler_config *config,
                             struct rho_scan_assembler_source *source,
                             const struct rho_scan_assembler_place *place,
                             enum scan_verdict verdict, int64_t now_us);

/* 1 where time_us is at most late_max_us (bearings: 0) before the newest scan that went out. */
int rho_scan_is_in_time(const struct rho_scan_assembler *assembler,
                        enum rho_scan_assembler_kind kind, int64_t time_us);

/* Marks a skipped scan number as received; the sensor's newest scan stays the same. */
void rho_scan_mark_received(struct rho_scan_assembler_source *source, int32_t scan);

/* 1 where the scan number before `scan` was skipped, and may still come. */
int rho_scan_awaits_previous(const struct rho_scan_assembler_source *source, int32_t scan);

/* 1 where a sensor has sent scans, and the last of them at most jump_max_us ago. */
int rho_scan_is_live(const struct rho_scan_assembler *assembler,
                     const struct rho_scan_assembler_source *source, int64_t now_us);

/* 1 where a sensor has sent at least follow_scans accepted scans. */
int rho_scan_is_proven(const struct rho_scan_assembler_config *config,
                       const struct rho_scan_assembler_source *source);

/* Longest time for which any proven sensor that still sends was heard; 0: there is none. */
uint32_t rho_scan_eldest_known_us(const struct rho_scan_assembler *assembler, int64_t now_us);

/*
 * 1 where a sensor heard for known_us is a newcomer beside one heard for eldest_us: it has no vote
 * on the clock, and its scans wait for others.
 */
int rho_scan_is_newcomer(uint32_t known_us, uint32_t eldest_us);

/*
 * Reception time until which a newcomer's scan is held. INT64_MIN: it may go out at once;
 * INT64_MAX: a part of an older scan of an established sensor is missing.
 */
int64_t rho_scan_held_until_us(const struct rho_scan_assembler *assembler,
                               const struct rho_scan_assembler_slot *slot);

/* The time of an accepted scan, compared with the common clock of all sensors. */
enum scan_clock {
    CLOCK_OTHER = 0, /* the scan is of another clock, and not used; counted in source.off_clock */
    CLOCK_COMMON,
    CLOCK_SET /* the common clock was set to the scan's: waiting scans are of the old clock */
};

/* Compares a scan's time with the common clock, and moves the clock on, or sets it anew. */
enum scan_clock rho_scan_update_clock(struct rho_scan_assembler *assembler,
                                      struct rho_scan_assembler_source *source, int64_t time_us,
                                      enum scan_verdict verdict, int64_t now_us);

/* scan_slots.c: slots of scans */

enum slot_state {
    SLOT_FREE = 0,
    SLOT_OPEN,     /* parts of the scan are missing, and awaited */
    SLOT_COMPLETE, /* no part is awaited, though some may be missing; the scan waits for its turn */
    SLOT_GIVEN     /* the caller of rho_scan_assembler_next reads the scan */
};

/* Position of a slot's scan in its sensor's sequence. */
enum slot_order {
    ORDER_NEXT = 0,        /* the newest scan when it came: may wait for the number before it */
    ORDER_OUT_OF_SEQUENCE, /* older than another scan, which had skipped its number */
    ORDER_OF_OLD_NUMBERS   /* of numbers before a restart, or of a sensor no longer known */
};

/* Adds 1 to a counter, which saturates. */
void rho_scan_increment(uint32_t *counter);

/* The first slot in a state; NULL: there is none. */
struct rho_scan_assembler_slot *rho_slot_in_state(struct rho_scan_assembler *assembler,
                                                  enum slot_state state);

/* The open slot of the scan of a message; NULL: there is none. */
struct rho_scan_assembler_slot *rho_slot_find_open(struct rho_scan_assembler *assembler,
                                                   const struct rho_scan_assembler_source *source,
                                                   const struct scan_heading *heading);

/* 1 where the sensor has an out-of-sequence scan whose parts are still coming. */
int rho_slot_has_out_of_sequence(const struct rho_scan_assembler *assembler,
                                 const struct rho_scan_assembler_source *source);

/*
 * Finds a scan that may go out to make room: the first complete scan that is not a newcomer's held
 * one, or else an open scan of a newcomer or unproven sensor. Its release neither cuts short an
 * established sensor's scan whose parts are still coming, nor makes it out of sequence. NULL: none.
 */
struct rho_scan_assembler_slot *rho_slot_find_spare(struct rho_scan_assembler *assembler,
                                                    int64_t now_us);

/* Begins an accepted scan in a free slot, which there is, without any of its parts. */
struct rho_scan_assembler_slot *rho_slot_open(struct rho_scan_assembler *assembler,
                                              const struct rho_scan_assembler_source *source,
                                              const struct scan_heading *heading,
                                              enum slot_order order);

/* Ends the wait for parts of a sensor's open scans; numbers_restart: its numbers begin anew. */
void rho_slot_complete_all(struct rho_scan_assembler *assembler,
                           const struct rho_scan_assembler_source *source, int numbers_restart);

/*
 * Finds or makes a free slot. An out-of-sequence scan is dropped for it, and, for a scan of an
 * established sensor, a newcomer's held scan. NULL: no slot can be freed.
 *   for_newcomer  1: the slot is for a newcomer's scan
 */
struct rho_scan_assembler_slot *rho_slot_make_free(struct rho_scan_assembler *assembler,
                                                   int for_newcomer, int64_t now_us);

/* Drops all waiting scans: the common clock was set anew, and they are of the old one. */
void rho_slot_drop_waiting(struct rho_scan_assembler *assembler);

/* Counts a part that was received before, with the same bytes or from another sender. */
void rho_slot_count_duplicate(struct rho_scan_assembler *assembler,
                              struct rho_scan_assembler_source *source,
                              const struct scan_heading *heading);

/* Adds a part to its scan; counts one that is there already, or contradicts the others. */
void rho_slot_add_part(struct rho_scan_assembler *assembler, struct rho_scan_assembler_slot *slot,
                       const struct scan_heading *heading, const union scan_message *message,
                       int64_t now_us);

/* scan_decoding.c: decoding of messages */

/*
 * Decodes and validates a message, and fills its heading, whose time is without the sensor's time
 * bias.
 *   message_kind  enum rho_scan_assembler_kind, or SCAN_MESSAGE_DIRECTIONS
 * Errors: those of the message's functions, VALUE (the time is beyond RHO_LIMIT_TIME_US).
 */
enum rho_status rho_scan_decode(const struct rho_scan_assembler *assembler, unsigned message_kind,
                                const uint8_t *data, size_t size, union scan_message *message,
                                struct scan_heading *heading);

/* Inserts a part's plots or bearings in the order of parts; counts those beyond the slot's room. */
void rho_slot_add_measurements(struct rho_scan_assembler *assembler,
                               struct rho_scan_assembler_slot *slot,
                               const struct scan_heading *heading,
                               const union scan_message *message);

/* The description of a sensor, or the config's `other` for one that was not described. */
const struct rho_scan_assembler_sensor *rho_scan_sensor(const struct rho_scan_assembler *assembler,
                                                        int32_t sensor_id);

#endif
