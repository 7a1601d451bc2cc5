/* SPDX-License-Identifier: MIT */
/* Private to feed: a message's heading, which of a sensor's scans are believed, and how messages become plots. */
#ifndef RHOTRACK_FEED_PARTS_H
#define RHOTRACK_FEED_PARTS_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/feed.h"
#include "rhotrack/message.h"

/* One message, decoded: the one of its kind. */
union feed_message {
    struct rho_message_plot_scan plots;
    struct rho_message_polar_scan polar;
    struct rho_message_bearing_scan bearings;
};

/* What all kinds say of the scan they are a part of. */
struct feed_heading {
    struct rho_feed_place place;
    uint32_t measures;
    float sector_from_rad, sector_to_rad;
    float x_m, y_m, z_m; /* of the sensor; 0, 0, 0: not said */
    uint16_t part, num_parts;
    uint16_t num_inputs;
    int16_t sensor_id;
    uint8_t kind;   /* enum rho_feed_kind */
    uint8_t is_new; /* a newcomer's that the config does not name */
    uint32_t check; /* of the message's bytes; never 0 */
};

/* What a scan's number and time are worth. */
enum feed_verdict {
    FEED_NEXT,         /* believed */
    FEED_FOLLOW,       /* believed, as it agrees with those before it that were not */
    FEED_DUPLICATE,    /* was there */
    FEED_SKIPPED,      /* believed: older, was not there, and is of use */
    FEED_LATE,         /* older */
    FEED_STRAY_NUMBER, /* not believed: its number or epoch */
    FEED_STRAY_TIME    /* not believed: its time */
};

/*
 * Of source.check: no first part was there; the scan was refused, as it was not a newcomer's turn.
 * Above: the part's.
 */
#define FEED_CHECK_NONE 0u
#define FEED_CHECK_NO_TURN 1u

/* ---- feed_admit.c: numbers and clocks ---- */

enum feed_verdict rho_feed_judge(const struct rho_feed *feed, const struct rho_feed_source *source,
                                 const struct rho_feed_place *place, int64_t now_us);

/* A scan that was not believed is remembered, for those that may agree with it. */
void rho_feed_note_stray(const struct rho_feed_config *config, struct rho_feed_source *source,
                         const struct rho_feed_place *place);

/* A believed scan: the sensor has come to here. Returns how many numbers were skipped. */
uint32_t rho_feed_note_place(const struct rho_feed_config *config, struct rho_feed_source *source,
                             const struct rho_feed_place *place, enum feed_verdict verdict,
                             int64_t now_us);

/* A late scan of this time is of use: nothing newer has gone out, or a tracker still takes it. */
int rho_feed_is_in_time(const struct rho_feed *feed, enum rho_feed_kind kind, int64_t time_us);

/* A skipped number has come: its sensor stays where it was. */
void rho_feed_note_skipped(struct rho_feed_source *source, int32_t scan);

/* The number before this one was skipped, and may still come. */
int rho_feed_awaits(const struct rho_feed_source *source, int32_t scan);

/* For how long the sensor was heard that was heard for longest, of those that are live and proven. */
uint32_t rho_feed_eldest_us(const struct rho_feed *feed, int64_t now_us);

/* Beside it, one heard for known_us is a newcomer: it has no say in the time, and waits for the others. */
int rho_feed_is_new(uint32_t known_us, uint32_t eldest_us);

/*
 * When on the reception clock the scan may go out for what sensors say that are no newcomers; INT64_MIN: at once. With
 * INT64_MAX a part of an older scan of theirs is waited for.
 */
int64_t rho_feed_early_until_us(const struct rho_feed *feed, const struct rho_feed_slot *slot);

/* It has shown by follow_scans scans that it is no chance message. */
int rho_feed_is_proven(const struct rho_feed_config *config, const struct rho_feed_source *source);

/*
 * True where a believed scan's time is the common clock's, or becomes it (then feed->is_restart is set). A scan off the
 * clock is counted in its source.
 */
int rho_feed_is_on_clock(struct rho_feed *feed, struct rho_feed_source *source, int64_t time_us,
                         enum feed_verdict verdict, int64_t now_us);

/* Takes so much out of the bucket; 0: it holds less, and is as it was. */
int rho_feed_draw(struct rho_feed_bucket *bucket, uint32_t count, uint32_t per_s, int64_t now_us);

/* ---- feed_slots.c: scans that are put together ---- */

enum feed_slot_state {
    FEED_SLOT_FREE = 0,
    FEED_SLOT_OPEN,     /* parts are missing */
    FEED_SLOT_COMPLETE, /* waits for its turn; parts may be missing for good */
    FEED_SLOT_GIVEN     /* the caller reads it */
};

/* How a scan came, among those of its sensor. */
enum feed_slot_order {
    FEED_ORDER_NEXT = 0, /* behind all others: the number before it may be waited for */
    FEED_ORDER_LATE,     /* before a newer one, which had skipped it */
    FEED_ORDER_OLD /* with other numbers than its sensor has now, or its sensor is no longer known */
};

void rho_feed_count_one(uint32_t *counter);

/* NULL: none. */
struct rho_feed_slot *rho_feed_find_state(struct rho_feed *feed, enum feed_slot_state state);
struct rho_feed_slot *rho_feed_find_scan(struct rho_feed *feed,
                                         const struct rho_feed_source *source,
                                         const struct feed_heading *heading);

/* The sensor has a late scan whose parts are still coming. */
int rho_feed_has_late_open(const struct rho_feed *feed, const struct rho_feed_source *source);

/*
 * What makes room, and neither makes a proven sensor's scan late whose parts are still coming, nor cuts it short: the
 * first complete scan that is not early, or else an open one of a sensor that is a newcomer, or not proven.
 */
struct rho_feed_slot *rho_feed_find_spare(struct rho_feed *feed, int64_t now_us);

/* The slot begins with this scan. */
void rho_feed_open_slot(struct rho_feed *feed, struct rho_feed_slot *slot,
                        const struct rho_feed_source *source, const struct feed_heading *heading,
                        enum feed_slot_order order);

/* Nothing more is waited for. */
void rho_feed_close_slot(struct rho_feed *feed, struct rho_feed_slot *slot);

/* The same of all open scans of a sensor. Where its numbers hold no more, none of its scans waits for one. */
void rho_feed_close_open(struct rho_feed *feed, const struct rho_feed_source *source, int is_over);

/*
 * A free slot. A late scan gives way to it, and is not sent out then: that could make others late. So does a newcomer's
 * that is early, but not to newcomers. NULL: there is none.
 */
struct rho_feed_slot *rho_feed_make_free(struct rho_feed *feed, int is_new, int64_t now_us);

/* Of the clock that held before: what cannot be stepped any more. */
void rho_feed_drop_slots(struct rho_feed *feed);

/* A part of a scan that was there before: the same, or another sender's. */
void rho_feed_count_double(struct rho_feed *feed, struct rho_feed_source *source,
                           const struct feed_heading *heading);

/* Another part of the slot's scan; it may be there already, or contradict the others. */
void rho_feed_add_part(struct rho_feed *feed, struct rho_feed_slot *slot,
                       const struct feed_heading *heading, const union feed_message *message,
                       int64_t now_us);

/* Whose turn it is; NULL: nobody's yet. */
struct rho_feed_slot *rho_feed_find_due(struct rho_feed *feed, int64_t now_us);

void rho_feed_fill_item(const struct rho_feed_slot *slot, struct rho_feed_item *item);

/* ---- feed_fill.c: messages ---- */

/* Decodes and validates; the heading is the message's. */
enum rho_status rho_feed_open_message(enum rho_feed_kind kind, const uint8_t *data, size_t size,
                                      union feed_message *message, struct feed_heading *heading);

/* Takes the sensor's time bias off the scan's time: it is the common clock's then. 0: and beyond its limit. */
int rho_feed_right_time(const struct rho_feed *feed, struct feed_heading *heading);

/* Puts a part's plots or bearings in their place in the slot, and counts what finds no room. */
void rho_feed_fill(struct rho_feed *feed, struct rho_feed_slot *slot,
                   const struct feed_heading *heading, const union feed_message *message);

/* What is known of a sensor; the config's `other` where it was not described. */
const struct rho_feed_sensor *rho_feed_known(const struct rho_feed *feed, int32_t sensor_id);

#endif
