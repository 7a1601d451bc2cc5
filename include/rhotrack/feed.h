/* SPDX-License-Identifier: MIT */
/*
 * feed: messages of sensors in, whole scans out, in the order of time; what is lost, late, double or wrong is counted.
 *
 *     while (a message has come) {
 *         while (rho_feed_take(&feed, channel, data, size, now_us) == RHO_ERROR_CAPACITY) {
 *             step what rho_feed_next gives, once, and try again
 *         }
 *         while (rho_feed_next(&feed, now_us, &item)) {
 *             step item
 *         }
 *     }
 *
 * Nobody is trusted: LCM does not say who sent a message. What a message can do is bounded, and one sensor that fails
 * or lies leaves the scans of the others as they are. Who sends in a sensor's name can do harm to that sensor.
 *
 * Parts      A scan is complete when all its parts are here. It goes out incomplete, and is counted, when a newer scan
 *            of its sensor begins, hold_us has passed since its last part, or a later scan of another sensor has been
 *            held that long (but with hold_us 0). Plots are in the order of the parts. The part that comes first
 *            counts: those that say something else of the scan are refused.
 * Order      A complete scan waits until every other live sensor has sent one that is not older, hold_us at most: scans
 *            of different sensors go out in the order of time. A scan behind a number that was skipped waits for that
 *            one, not for those before it, hold_us at most, too, and so does what comes less than an interval before
 *            it; else with one sensor nothing waits. A sensor is live for jump_max_us after its last scan.
 * Late       A number that was skipped may come after all, behind newer ones. Where nothing newer has gone out it takes
 *            its place in the order of time. Else it goes out behind what is newer by late_max_us at most, for a
 *            tracker that takes late scans; bearings, whose frames are over, do not. It does not move its sensor on,
 *            and makes no other scan wait but for its parts, nor for the number before it. It takes room that is free,
 *            of a sensor one at a time to wait for parts, and gives way to whatever is not late: then it is dropped.
 * Numbers    A scan is the next one of its sensor where its number is 1 .. RHO_FEED_SKIP_MAX higher (it wraps), its
 *            time later, and both go together: it took no longer than half as long again as its numbers usually take,
 *            or as nothing was heard of the sensor, and where it skips numbers no shorter than three quarters of that.
 *            Numbers that were skipped are lost; 0 or up to 31 lower is double or late. Of the late ones those are
 *            taken that were skipped, and whose time is as far before the newest as their numbers usually take: no
 *            shorter than three quarters of that, no longer than half as long again. Anything else, and another
 *            epoch, is refused until follow_scans such scans agree with one another: the sensor restarted, or goes
 *            another pace. So one damaged message, or one that was not the sensor's, does not make those that follow it
 *            look old.
 * Newcomers  A newcomer is a sensor heard for less than half as long as another one that still sends, which was
 *            heard for a minute. Who is silent for three intervals (an eighth to half of jump_max_us) makes nobody one. Ten minutes are as good as hours: nobody is one for more than five. A lone sensor is none, nor is
 *            any in the first minute, nor in a record (is_record).
 *            A newcomer has no vote on the clock. Its scan waits until one that is no newcomer has sent what is not
 *            older, or by its own clock is hold_us beyond that time; and until no part of an older scan of such a one
 *            is missing. It gives way to scans of those, and is lost then (sensors_no_room).
 *            All newcomers that are neither `allowed` nor described (rho_feed_set_sensor) have one scan between two of
 *            the others, as empty ones in a row would end tracks, and stranger_plots_per_s: what is beyond is not
 *            looked at (messages_flooded). None of their plots is surer than `other` says.
 * Allowed    Where `allowed` holds a sensor_id, messages of any other sensor are not looked at.
 * Twins      The first part of a sensor's newest scan that comes again with other contents is counted (scans_other), and
 *            has_twin stays 1 in its source: two senders use its number. The one that came first counts.
 * Clock      A scan is refused where most other live sensors say that its time is another one: more than an
 *            eighth of jump_max_us and hold_us ahead of what their last scans and the reception clock make it now, or
 *            two of their intervals, or as far before their last scans; jump_max_us of one that has sent one scan so
 *            far. So is one more than jump_max_us off the last accepted one. One wrong clock does not make the other
 *            sensors late. When more sensors, newcomers left out, agree on another time than on the present one, that
 *            time is followed: is_restart tells, and what was made of earlier scans does not go on. Where as many say
 *            the one as the other, the reception clock decides if it is near one of them alone, and else who came
 *            first. Of sensors that are no newcomers, a clock that is ahead by less makes the other sensors late in the
 *            tracker for as long as it goes on.
 * Flood      More than flood_per_s messages of one sensor in a second are not looked at. Sensors that are not known,
 *            and newcomers, share one such measure. A new sensor takes the place of one that was not heard for longest,
 *            never that of one that is heard, tells the common time and has proved itself by follow_scans scans; nor
 *            does it, or a newcomer, for want of room, cut short a scan of such a one that is none, or make it late
 *            while its parts are still coming.
 *
 * Which sensor sent a message is told by its channel: RHO_PLOTS_<n>, RHO_POLAR_<n>, RHO_BEARINGS_<n>, with n the
 * message's sensor_id. The reception clock: microseconds, any epoch. It has to go on, and should go as fast as the
 * sensors' clocks do: who replays a record gives the times at which it was recorded.
 * The object holds no pointers: a memcpy is a snapshot.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_FEED_H
#define RHOTRACK_FEED_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/status.h"
#include "rhotrack/types.h"

/* Numbers that a sensor may skip and still be believed at once. */
#define RHO_FEED_SKIP_MAX 64

/* Of a sensor's scans that were not believed, so many are remembered: others between them do no harm. */
#define RHO_FEED_STRAYS 4

/* A sensor heard for so long is as good as one heard for hours. Before the second, all are equals. */
#define RHO_FEED_TRUST_US 600000000u
#define RHO_FEED_EQUALS_US 60000000u

/* Noise where the messages say 0; each above 0 and within the limits of types.h. */
struct rho_feed_noise {
    float sigma_m, sigma_mps; /* of plots */
    float sigma_range_m, sigma_azimuth_rad, sigma_elevation_rad, sigma_range_rate_mps; /* polar */
    float sigma_rad; /* bearings */
};

/*
 * What is known of a sensor beforehand. A polar message or bearing says the sensor's place itself; the place here
 * counts for plots, and for polar messages that say 0, 0, 0. Biases of range and azimuth are taken off polar plots and
 * bearings. time_bias_s is taken off each scan's time before it is looked at in any way: order, numbers, clock; plots
 * keep their time after their scan's. One that is changed while the sensor sends looks as if its clock was set.
 */
struct rho_feed_sensor {
    struct rho_sensor sensor;
    struct rho_feed_noise noise;
};

struct rho_feed_config {
    int64_t
        hold_us; /* 0 .. 10 s; 0: nothing waits for other sensors, and parts wait for a newer scan alone */
    int64_t
        late_max_us; /* 0 .. 60 s; 0: what comes behind a newer scan that has gone out is dropped */
    int64_t jump_max_us;   /* 1 s .. 1 h */
    uint32_t flood_per_s;  /* 1 .. 1e6 */
    uint32_t follow_scans; /* 2 .. 255 */
    uint16_t is_told;   /* 1: items have a sensor also where `other` is all that is known of it */
    uint16_t is_record; /* 1: nobody is a newcomer: for files */
    uint32_t stranger_plots_per_s; /* 1 .. 1e6: of all newcomers that are not named, together */
    uint32_t num_allowed;          /* 0 .. RHO_MAX_SENSORS; 0: all sensors are */
    /* sensor_ids; messages of any other are not looked at; an even number, so that nothing is padded */
    int16_t allowed[(RHO_MAX_SENSORS + 1) / 2 * 2];
    struct rho_feed_sensor
        other; /* holds for sensors that are not described; its sensor_id is not looked at */
};

/* Since init; all saturate. */
struct rho_feed_counters {
    uint32_t messages_bad;        /* length, count, a value, the sensor's number */
    uint32_t messages_wrong_type; /* the fingerprint is not the channel's */
    uint32_t
        messages_flooded; /* and those of newcomers beyond stranger_plots_per_s, or their turn */
    uint32_t messages_not_allowed; /* of a sensor that is not in `allowed` */
    uint32_t scans_accepted;       /* of which a first part came */
    /*
     * older than one of the same sensor that was accepted, whatever becomes of them (those that
     * found room are accepted, too), but for those of newcomers without a turn; and those of a
     * clock that was given up
     */
    uint32_t scans_late;
    /* scans, or parts of one, that were there before; parts that come when the scan is closed */
    uint32_t scans_duplicate;
    /* of those, not counted there: with another content, so that two senders use one sensor_id (or damage) */
    uint32_t scans_other;
    uint32_t scans_lost;       /* numbers skipped; those that come after all are late, too */
    uint32_t scans_bad;        /* contradict the other parts, or the sensor's numbers */
    uint32_t scans_incomplete; /* went out without some of their parts */
    uint32_t
        clock_jumps; /* refused for their time: far off the sensor's own, or the common clock */
    uint32_t sensor_restarts; /* new numbers or times followed */
    uint32_t sensors_no_room; /* messages of sensors beyond RHO_MAX_SENSORS or RHO_MAX_OPEN_SCANS */
    uint32_t bearings_in;     /* of accepted scans */
    /* of accepted scans beyond RHO_MAX_PLOTS or RHO_MAX_BEARINGS: the last ones */
    uint32_t plots_no_room;
};

enum rho_feed_kind { RHO_FEED_PLOTS = 0, RHO_FEED_POLAR, RHO_FEED_BEARINGS, RHO_NUM_FEED_KINDS };

/* True of kinds that the library is built with. */
#define RHO_FEED_HAS(kind) (((RHO_SCAN_KINDS) >> (kind)&1) != 0)

/* True of that kind: known to the compiler where there is no such, or no other. */
#define RHO_FEED_IS(kind, which)                                                                   \
    ((RHO_SCAN_KINDS) == 1 << (which) || (RHO_FEED_HAS(which) && (kind) == (which)))

/* Where a sensor's scans have come to. */
struct rho_feed_place {
    int64_t time_us;
    int32_t scan, epoch;
};

/* Scans that were not believed, and agree with each other. */
struct rho_feed_stray {
    struct rho_feed_place place; /* the newest of them */
    uint32_t scans;              /* how many; 0: none */
    uint32_t reserved;           /* 0 */
};

/* What may still come before it is filled again, once a second. */
struct rho_feed_bucket {
    int64_t full_us; /* reception clock: when it was full */
    uint32_t left;
    uint32_t reserved; /* 0 */
};

/* One sensor's stream of messages. */
struct rho_feed_source {
    struct rho_feed_place place;                   /* its newest scan whose number was believed */
    struct rho_feed_stray strays[RHO_FEED_STRAYS]; /* the last one first */
    int64_t heard_us;                              /* reception clock: its last believed scan */
    struct rho_feed_bucket messages;
    uint32_t seen;        /* bit i: number place.scan - i was there */
    uint32_t skipped;     /* bit i: it was not, and may still come */
    uint32_t interval_us; /* from number to number, smoothed; 0: not known yet */
    uint32_t known_us;    /* reception clock: for how long it was heard; up to RHO_FEED_TRUST_US */
    uint32_t check;       /* private; of the newest scan's first part, as it came first */
    uint16_t scans;       /* believed; saturates */
    uint8_t off_clock;    /* scans in a row; saturates; 0: it tells the common time */
    uint8_t has_twin;     /* 1: a scan came twice, with different contents */
    int16_t sensor_id;
    uint8_t kind; /* enum rho_feed_kind */
    uint8_t is_used;
};

/* A scan that is put together. */
struct rho_feed_slot {
    struct rho_feed_place place;
    int64_t heard_us; /* reception clock: its last part */
    uint32_t measures;
    float sector_from_rad, sector_to_rad;
    struct rho_sensor sensor;
    uint16_t source; /* index */
    uint16_t num_parts, parts_here;
    uint16_t num_inputs; /* plots or bearings that are kept */
    uint8_t state;       /* private */
    uint8_t kind;        /* enum rho_feed_kind */
    uint8_t has_sensor;
    uint8_t order; /* private */
    uint16_t
        parts[RHO_MAX_PARTS]; /* of each part that is here, 1 more than its inputs; 0: missing */
    struct rho_bearing bearings[RHO_MAX_BEARINGS];
    struct rho_plot plots[RHO_MAX_PLOTS];
};

struct rho_feed {
    uint32_t magic;
    uint16_t num_known;
    uint16_t is_pressed; /* a scan found no room: the oldest goes out at the next call */
    int64_t clock_us;    /* of the newest accepted scan */
    int64_t out_us;      /* of the newest one that went out; INT64_MIN: none */
    uint16_t has_clock;
    uint16_t is_restart; /* the next scan that goes out is the first on another clock */
    uint32_t newcomers;  /* scans, since the last one of a sensor that is none */
    struct rho_feed_config config;
    struct rho_feed_counters counters;
    struct rho_feed_bucket strangers; /* messages of sensors that are new or unknown */
    struct rho_feed_bucket stranger_plots;
    struct rho_feed_source sources[RHO_MAX_SENSORS];
    struct rho_feed_sensor known[RHO_MAX_SENSORS];
    struct rho_feed_slot slots[RHO_MAX_OPEN_SCANS];
};

/* A scan to step. It points into the object. */
struct rho_feed_item {
    enum rho_feed_kind kind;
    struct rho_scan scan;             /* PLOTS, POLAR */
    struct rho_bearing_scan bearings; /* BEARINGS */
    /* who saw it, for rho_tracker_set_sensor; has_sensor 0: nothing is known but the defaults */
    struct rho_sensor sensor;
    int has_sensor;
    int is_restart; /* the common clock was set anew: trackers start anew as well, before this scan */
    uint16_t parts_missing;
};

/*
 * hold 20 ms, late_max 20 s (0 without RHO_SECTORS: no tracker takes them), jump_max 30 s, flood 10 000 a second,
 * follow_scans 3, stranger_plots 256 a second (embedded: 64), all sensors allowed; other sensors: at the origin,
 * looking everywhere, pd 0.9, no biases; noise 10 m, 1 m/s, 15 m, 3 mrad, 3 mrad, 1 m/s, 1.75 mrad; is_told 0,
 * is_record 0. Constant cost.
 */
void rho_feed_config_default(struct rho_feed_config *config);

/*
 * Prepares an empty feed; the config is copied.
 *   size   sizeof(struct rho_feed) of the caller
 * Errors: NULL, SIZE, CONFIG. Cost: sizeof(feed) bytes cleared.
 */
RHO_MUST_CHECK enum rho_status rho_feed_init(struct rho_feed *feed, size_t size,
                                             const struct rho_feed_config *config);

/*
 * Describes a sensor, or replaces the description of the same sensor_id: noise, biases, reach.
 * Errors: NULL, STATE (not initialised), CONFIG (noise outside its limits, a place or bias that is), CAPACITY
 * (RHO_MAX_SENSORS); nothing is changed. Cost: RHO_MAX_SENSORS.
 */
RHO_MUST_CHECK enum rho_status rho_feed_set_sensor(struct rho_feed *feed,
                                                   const struct rho_feed_sensor *sensor);

/*
 * Takes one message; any bytes may be given. RHO_OK also where it was refused: a counter has moved.
 *   channel  ends with NUL
 *   now_us   reception clock
 * Errors: NULL, STATE (not initialised), TYPE (not a sensor's channel, or of a kind that is none of
 * RHO_SCAN_KINDS), CAPACITY (no room for another open scan: call
 * rho_feed_next once, step what it gives, if anything, and take the message again; two such calls
 * make room); nothing
 * is changed but for that call.
 * Cost: the message's bytes, twice, RHO_MAX_SENSORS, and where parts come out of order the scan's
 * plots moved.
 * Stack: 2 KB: the message as a struct.
 */
RHO_MUST_CHECK enum rho_status rho_feed_take(struct rho_feed *feed, const char *channel,
                                             const uint8_t *data, size_t size, int64_t now_us);

/*
 * The next scan that is due, if there is one; it is valid until the next call of this function. now_us INT64_MAX: all
 * that is there goes out.
 * Returns 0 where nothing is due, or feed is not initialised. Cost: RHO_MAX_OPEN_SCANS times RHO_MAX_SENSORS.
 * Stack: 280 bytes.
 */
int rho_feed_next(struct rho_feed *feed, int64_t now_us, struct rho_feed_item *item);

/*
 * When rho_feed_next should be called though no message comes; INT64_MAX: not before one does.
 * Cost: RHO_MAX_OPEN_SCANS times RHO_MAX_SENSORS. Stack: 170 bytes.
 */
int64_t rho_feed_due_us(const struct rho_feed *feed);

#endif
