/* SPDX-License-Identifier: MIT */
/*
 * Private to the scan assembler: headings of messages, acceptance of scans, slots in which scans
 * are assembled, and the conversion of messages to plots.
 */
#ifndef RHOTRACK_SCAN_ASSEMBLER_PARTS_H
#define RHOTRACK_SCAN_ASSEMBLER_PARTS_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/message.h"
#include "rhotrack/scan_assembler.h"

/* One message, decoded: the one of its kind. */
union scan_message {
    struct rho_message_plot_scan plots;
    struct rho_message_polar_scan polar;
    struct rho_message_bearing_scan bearings;
};

/* The members that messages of all kinds have, of the scan that they are a part of. */
struct scan_heading {
    struct rho_scan_assembler_place place;
    uint32_t measures;
    float sector_from_rad, sector_to_rad;
    float x_m, y_m, z_m; /* of the sensor; 0, 0, 0: not said */
    uint16_t part, num_parts;
    uint16_t num_inputs;
    int16_t sensor_id;
    uint8_t kind;   /* enum rho_scan_assembler_kind */
    uint8_t is_new; /* a newcomer's that the config does not name */
    uint32_t check; /* of the message's bytes; never 0 */
};

/* Classification of a scan by its number and time. */
enum scan_verdict {
    SCAN_NEXT,            /* accepted: it follows the newest one */
    SCAN_RESTARTS_SENSOR, /* accepted: it agrees with scans that were refused before */
    SCAN_DUPLICATE,       /* received before */
    SCAN_OUT_OF_SEQUENCE, /* accepted: its number was skipped, and it is still usable */
    SCAN_TOO_LATE,        /* older, and not usable any more */
    SCAN_WRONG_NUMBER,    /* refused for its number or epoch */
    SCAN_WRONG_TIME       /* refused for its time */
};

/*
 * Values of source.check: no first part was received; the scan was refused, because another
 * newcomer had the turn. Higher values are checksums of the first part.
 */
#define CHECK_NONE 0u
#define CHECK_NOT_ADMITTED (CHECK_NONE + 1u)

/* ---- scan_admission.c: numbers and clocks ---- */

enum scan_verdict rho_scan_assembler_classify(const struct rho_scan_assembler *assembler,
                                              const struct rho_scan_assembler_source *source,
                                              const struct rho_scan_assembler_place *place,
                                              int64_t now_us);

/* Refused, but of the sensor's new sequence if others agree with it. */
int rho_scan_assembler_is_stray(const struct rho_scan_assembler_config *config,
                                const struct rho_scan_assembler_source *source,
                                const struct rho_scan_assembler_place *place,
                                enum scan_verdict verdict);

/* Remembers a refused scan, for those that may agree with it. */
void rho_scan_assembler_note_stray(const struct rho_scan_assembler_config *config,
                                   struct rho_scan_assembler_source *source,
                                   const struct rho_scan_assembler_place *place);

/* The sensor's newest scan is this one. Returns how many numbers were skipped. */
uint32_t rho_scan_assembler_take_newest(const struct rho_scan_assembler_config *config,
                                        struct rho_scan_assembler_source *source,
                                        const struct rho_scan_assembler_place *place,
                                        enum scan_verdict verdict, int64_t now_us);

/* Nothing newer than this time has gone out, or a tracker still takes an out-of-sequence scan. */
int rho_scan_assembler_is_usable_time(const struct rho_scan_assembler *assembler,
                                      enum rho_scan_assembler_kind kind, int64_t time_us);

/* A skipped number was received; the sensor's newest scan stays the same. */
void rho_scan_assembler_mark_received(struct rho_scan_assembler_source *source, int32_t scan);

/* The number before this one was skipped, and may still come. */
int rho_scan_assembler_awaits_previous(const struct rho_scan_assembler_source *source,
                                       int32_t scan);

/* Where there is one sensor at a time, none is heard for longer, and none votes on its clock. */
#define HAS_OTHERS (RHO_MAX_SENSORS > 1)

/*
 * A scan that comes after a newer one is of use to a tracker that takes it, or while the newer one
 * waits.
 */
#define TAKES_LATE ((RHO_SECTORS) || RHO_MAX_OPEN_SCANS > 1)

/*
 * A sensor that begins again with the numbers or times that it has sent is followed. A node of one
 * sensor has no room for that: its sensor's epoch, numbers or clock tell of a restart.
 */
#define FOLLOWS_REPEATS HAS_OTHERS

/* Longest time for which any live and proven sensor was heard. */
uint32_t rho_scan_assembler_longest_known_us(const struct rho_scan_assembler *assembler,
                                             int64_t now_us);

/* Beside it a sensor heard for known_us is a newcomer: no vote on the clock, waits for others. */
int rho_scan_assembler_is_newcomer(uint32_t known_us, uint32_t eldest_us);

/*
 * When a newcomer's scan may go out, by the reception clock; INT64_MIN: at once; INT64_MAX: a part
 * of an older scan of an established sensor is missing.
 */
int64_t rho_scan_assembler_newcomer_release_us(const struct rho_scan_assembler *assembler,
                                               const struct rho_scan_assembler_slot *slot);

/* The sensor has sent follow_scans scans. */
int rho_scan_assembler_is_proven(const struct rho_scan_assembler_config *config,
                                 const struct rho_scan_assembler_source *source);

/* The time of an accepted scan, compared with the common clock of all sensors. */
enum scan_clock {
    CLOCK_OTHER = 0, /* it is of another clock; counted in its source */
    CLOCK_COMMON,
    CLOCK_SET /* the common clock is set to it: waiting scans are of the old clock */
};

enum scan_clock rho_scan_assembler_check_clock(struct rho_scan_assembler *assembler,
                                               struct rho_scan_assembler_source *source,
                                               int64_t time_us, enum scan_verdict verdict,
                                               int64_t now_us);

/* Takes count tokens out of the bucket; 0: it holds fewer, and is unchanged. */
int rho_scan_assembler_take_tokens(struct rho_scan_assembler_bucket *bucket, uint32_t count,
                                   uint32_t per_s, int64_t now_us);

/* ---- scan_slots.c: scans that are assembled ---- */

enum slot_state {
    SLOT_FREE = 0,
    SLOT_OPEN,     /* parts are missing */
    SLOT_COMPLETE, /* waits for its turn; parts may be missing for good */
    SLOT_GIVEN     /* the caller reads it */
};

/* Place of a scan in its sensor's sequence. */
enum slot_order {
    ORDER_NEXT = 0,        /* behind all others: the number before it may be waited for */
    ORDER_OUT_OF_SEQUENCE, /* before a newer one, which had skipped it */
    ORDER_OF_OLD_NUMBERS   /* of an earlier numbering, or of a sensor that is no longer known */
};

void rho_scan_assembler_count_one(uint32_t *counter);

/* NULL: none. */
struct rho_scan_assembler_slot *rho_scan_assembler_find_slot(struct rho_scan_assembler *assembler,
                                                             enum slot_state state);
struct rho_scan_assembler_slot *
rho_scan_assembler_find_open_scan(struct rho_scan_assembler *assembler,
                                  const struct rho_scan_assembler_source *source,
                                  const struct scan_heading *heading);

/* The sensor has an out-of-sequence scan whose parts are still coming. */
int rho_scan_assembler_has_open_out_of_sequence(const struct rho_scan_assembler *assembler,
                                                const struct rho_scan_assembler_source *source);

/*
 * A scan that may go out to make room, and by that neither cuts short a proven sensor's scan whose
 * parts are still coming, nor makes it out of sequence: the first complete scan that is not held
 * as a newcomer's, or else an open one of a sensor that is a newcomer or not proven.
 */
struct rho_scan_assembler_slot *
rho_scan_assembler_find_releasable(struct rho_scan_assembler *assembler, int64_t now_us);

/* The slot begins with this scan. */
void rho_scan_assembler_open_scan(struct rho_scan_assembler *assembler,
                                  struct rho_scan_assembler_slot *slot,
                                  const struct rho_scan_assembler_source *source,
                                  const struct scan_heading *heading, enum slot_order order);

/* No more parts are awaited. */
void rho_scan_assembler_complete_scan(struct rho_scan_assembler *assembler,
                                      struct rho_scan_assembler_slot *slot);

/* The same for all open scans of a sensor; is_over: its numbering has ended. */
void rho_scan_assembler_complete_open_scans(struct rho_scan_assembler *assembler,
                                            const struct rho_scan_assembler_source *source,
                                            int is_over);

/*
 * A free slot. An out-of-sequence scan is dropped for it, and for scans of established sensors that
 * of a newcomer that still waits for them. NULL: there is none.
 */
struct rho_scan_assembler_slot *
rho_scan_assembler_make_free_slot(struct rho_scan_assembler *assembler, int is_new, int64_t now_us);

/* Drops the waiting scans, which are of a clock that is given up. */
void rho_scan_assembler_drop_waiting_scans(struct rho_scan_assembler *assembler);

/* Counts a part that was received before, of this or of another sender. */
void rho_scan_assembler_count_duplicate(struct rho_scan_assembler *assembler,
                                        struct rho_scan_assembler_source *source,
                                        const struct scan_heading *heading);

/* Another part of the slot's scan; it may be there already, or contradict the others. */
void rho_scan_assembler_add_part(struct rho_scan_assembler *assembler,
                                 struct rho_scan_assembler_slot *slot,
                                 const struct scan_heading *heading,
                                 const union scan_message *message, int64_t now_us);

/* The next scan to go out; NULL: none is due. */
struct rho_scan_assembler_slot *rho_scan_assembler_find_due(struct rho_scan_assembler *assembler,
                                                            int64_t now_us);

void rho_scan_assembler_fill_item(const struct rho_scan_assembler_slot *slot,
                                  struct rho_scan_assembler_item *item);

/* ---- scan_fill.c: messages ---- */

/* Decodes and validates; the heading is the message's. */
enum rho_status rho_scan_assembler_decode_message(enum rho_scan_assembler_kind kind,
                                                  const uint8_t *data, size_t size,
                                                  union scan_message *message,
                                                  struct scan_heading *heading);

/*
 * Takes the sensor's time bias off the scan's time: it is the common clock's then. 0: and beyond
 * its limit.
 */
int rho_scan_assembler_correct_time_bias(const struct rho_scan_assembler *assembler,
                                         struct scan_heading *heading);

/* Puts a part's plots or bearings in their place in the slot, and counts what finds no room. */
void rho_scan_assembler_add_measurements(struct rho_scan_assembler *assembler,
                                         struct rho_scan_assembler_slot *slot,
                                         const struct scan_heading *heading,
                                         const union scan_message *message);

/* The description of a sensor; the config's `other` where it was not described. */
const struct rho_scan_assembler_sensor *
rho_scan_assembler_description_of(const struct rho_scan_assembler *assembler, int32_t sensor_id);

#endif
