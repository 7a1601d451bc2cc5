/* SPDX-License-Identifier: MIT */
/*
 * scan_assembler: messages of sensors in, whole scans out, in the order of time. Scans that are
 * lost, out of sequence, duplicate or faulty are counted.
 *
 *     while (a message has come) {
 *         while (rho_scan_assembler_take(&assembler, channel, data, size, now_us) ==
 *                RHO_ERROR_CAPACITY) {
 *             step what rho_scan_assembler_next gives, once, and try again
 *         }
 *         while (rho_scan_assembler_next(&assembler, now_us, &item)) {
 *             step item
 *         }
 *     }
 *
 * LCM does not say who sent a message, so no sender is trusted. The effect of a message is bounded,
 * and one sensor that fails or lies leaves the scans of others as they are, unless it uses their
 * numbers.
 *
 * Parts      A scan is complete when all its parts are here. It goes out incomplete, and is
 *            counted, when a newer scan of its sensor begins, when hold_us has passed since its
 *            last part, or when a later scan of another sensor has been held that long (unless
 *            hold_us is 0). Parts are in their order; those that contradict the first one to come
 *            are refused.
 * Order      Scans of different sensors go out in the order of time: a complete scan waits, hold_us
 *            at most, until every other live sensor has sent one that is not older, and behind a
 *            skipped number, or less than an interval before such a scan, for that number. A single
 *            sensor's scans wait for nothing else. A sensor is live for jump_max_us after its last
 *            scan.
 * Out of     A skipped number may come after all, behind newer ones. Where nothing newer has gone
 * sequence   out, its scan takes its place in the order of time. Otherwise it goes out behind the
 *            newer scans, late_max_us at most, for a tracker that takes out-of-sequence scans;
 *            late bearings are not taken. No other scan waits for it, except while its parts are
 *            coming or for the number before it. It only takes free room, for one scan of a sensor
 *            at a time while parts are missing, and is dropped for every scan in sequence.
 * Numbers    A scan is the next one of its sensor where its number is higher by 1 ..
 *            RHO_SCAN_ASSEMBLER_SKIP_MAX (numbers wrap) and its time is later, and fits what its
 *            numbers usually take or its reception, within hold_us and a 64th of jump_max_us; where
 *            it skips numbers, they took at least 3/4 of what they usually take, and are lost. A
 *            number that is 0 to 31 lower is a duplicate or out of sequence: the latter where it
 *            was skipped, and its time lies before the newest by 3/4 to 3/2 of what its numbers
 *            usually take. Any other scan, and another epoch, is refused until follow_scans such
 *            scans agree with one another: the sensor has restarted, has another interval, or its
 *            clock has stepped. So one damaged or foreign message does not make the scans that
 *            follow it look old. Where RHO_MAX_SENSORS is above 1, so are duplicates in a row from
 *            the oldest remembered number on, as of a record that is played again.
 * Newcomers  A newcomer is a sensor that was heard for less than half as long as another one that
 *            still sends (heard within three intervals or an eighth of jump_max_us) and was heard
 *            for a minute. Times count up to ten minutes, so a sensor is a newcomer for five at
 *            most. There is none in a record (is_record).
 *            A newcomer has no vote on the clock. Its scan waits until an established sensor has
 *            sent one that is not older, or is by its own clock hold_us beyond that time; and until
 *            no part of an older scan of an established sensor is missing. It gives way to scans of
 *            established sensors, and is lost then (sensors_no_room).
 *            All newcomers that are neither `allowed` nor described (rho_scan_assembler_set_sensor)
 *            share one scan between two of the others, because empty scans in a row would end
 *            tracks, and share stranger_plots_per_s: messages beyond that are dropped
 *            (messages_flooded). Their sigmas are not below those of `other`.
 * Senders    Where `allowed` holds a sensor_id, messages of any other sensor are dropped. The first
 *            part of a sensor's newest scan that comes again with other contents is counted
 *            (scans_other), and has_two_senders stays 1 in its source: two senders use its number.
 * Clock      A sensor's clock goes on from its newest scan as the reception clock does, or at its
 *            own pace where a record is played. A scan is refused where its time is more than
 *            hold_us and an eighth of jump_max_us off the clocks of most other live sensors, either
 *            way; or more than jump_max_us, beside a sensor that has sent one scan so far, and off
 *            the last accepted scan. Of a scan that its network delays, its sensor's clock counts.
 *            A sensor whose clock stepped must come nearer to the others than half of the step, and
 *            one that was off within a 64th of jump_max_us. When more sensors, without newcomers,
 *            agree on another time than on the present one, the assembler follows that time:
 *            is_restart tells, and tracks of earlier scans do not go on. Between equal numbers the
 *            reception clock decides, if it is near none of the present clocks, and else the sensor
 *            that came first. A sensor that restarts before the scans that went out, while no other
 *            one tells the time, sets it back.
 * Flood      More than flood_per_s messages of one sensor in a second are dropped. Unknown sensors
 *            and newcomers share one such limit. A new sensor takes the place of the one that was
 *            not heard for longest, but never that of a sensor that tells the common time, has sent
 *            follow_scans scans and is heard, or was for longer than it is silent. For want of
 *            room, neither a new sensor nor a newcomer cuts short a scan of such an established
 *            sensor, nor makes it out of sequence while its parts are still coming.
 *
 * The channel tells which sensor sent a message: RHO_PLOTS_<n>, RHO_POLAR_<n>, RHO_BEARINGS_<n> or
 * RHO_DIRECTIONS_<n>, with n the message's sensor_id; the last two are scans of bearings. The
 * reception clock counts microseconds from any epoch. It must go on, and should run as fast as the
 * sensors' clocks do: a replay gives the times at which the record was made.
 * The object holds no pointers: a memcpy is a snapshot.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_SCAN_ASSEMBLER_H
#define RHOTRACK_SCAN_ASSEMBLER_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

/* Largest number of scan numbers that a sensor may skip and still be accepted at once. */
#define RHO_SCAN_ASSEMBLER_SKIP_MAX 64

/* Number of series of refused scans that are remembered for each sensor. */
#define RHO_SCAN_ASSEMBLER_STRAYS 4

/*
 * Longest time for which a sensor counts as heard, and the time that another one must have been
 * heard for before any sensor is a newcomer.
 */
#define RHO_SCAN_ASSEMBLER_TRUST_US 600000000u
#define RHO_SCAN_ASSEMBLER_EQUALS_US 60000000u

/* Noise of measurements whose message states none: above 0, within the limits of types.h. */
struct rho_scan_assembler_noise {
    float sigma_m, sigma_mps; /* noise of Cartesian plots */
    /* noise of polar plots; the elevation's also that of directions */
    float sigma_range_m, sigma_azimuth_rad, sigma_elevation_rad, sigma_range_rate_mps;
    float sigma_rad; /* noise of bearings */
};

/*
 * What is known of a sensor beforehand. A polar message or bearing says the sensor's place itself;
 * the place here counts for plots, and for polar messages that say 0, 0, 0. Biases of range and
 * azimuth are taken off polar plots and bearings. time_bias_s is taken off each scan's time before
 * it is looked at in any way: order, numbers, clock; plots keep their time after their scan's. One
 * that is changed while the sensor sends looks as if its clock was set.
 */
struct rho_scan_assembler_sensor {
    struct rho_sensor sensor;
    struct rho_scan_assembler_noise noise;
};

struct rho_scan_assembler_config {
    /*
     * longest time that a scan waits, 0 .. 10 s; 0: no scan waits for other sensors, and parts only
     * for a newer scan
     */
    int64_t hold_us;
    /* longest delay of out-of-sequence scans behind the newest given one, 0 .. 60 s; 0: dropped */
    int64_t late_max_us;
    /* silence that ends a sensor's say in order and clock, largest jump of a clock, 1 s .. 1 h */
    int64_t jump_max_us;
    uint32_t flood_per_s; /* largest number of messages of a sensor in a second, 1 .. 1e6 */
    /* scans that must agree before a restarted sensor or another clock is followed, 2 .. 255 */
    uint32_t follow_scans;
    uint16_t gives_other; /* 1: items of sensors that were not described have the sensor `other` */
    uint16_t is_record;   /* 1: scans come from a file, and no sensor is a newcomer */
    /* most plots a second, 1 .. 1e6, of all newcomers together that the config does not name */
    uint32_t stranger_plots_per_s;
    uint32_t reserved; /* padding: 0 */
    /* number of sensor_ids in `allowed`, 0 .. RHO_MAX_SENSORS; 0: all sensors are allowed */
    uint32_t num_allowed;
    /* sensor_ids whose messages are not dropped; an even count leaves no padding */
    int16_t allowed[(RHO_MAX_SENSORS + 1) / 2 * 2];
    /* description of sensors that are not described; its sensor_id is not used */
    struct rho_scan_assembler_sensor other;
};

/* Counters of a scan assembler since rho_scan_assembler_init; all saturate. */
struct rho_scan_assembler_counters {
    uint32_t messages_bad; /* messages with an invalid length, count, value or sensor number */
    uint32_t messages_wrong_type; /* messages whose fingerprint is not that of the channel */
    /* messages beyond flood_per_s; newcomers' beyond stranger_plots_per_s, or out of turn */
    uint32_t messages_flooded;
    uint32_t messages_not_allowed; /* messages of a sensor that is not in `allowed` */
    uint32_t scans_accepted;       /* scans of which a first part was accepted */
    /*
     * older than one of the same sensor that was accepted, whatever becomes of them (those that
     * found room are accepted, too), but for those of newcomers without a turn; and those of a
     * clock that was given up
     */
    uint32_t scans_late;
    /* scans or parts that were received before, and parts of scans that were closed before */
    uint32_t scans_duplicate;
    /*
     * duplicates with other contents, not counted in scans_duplicate: two senders use one
     * sensor_id, or a message was damaged
     */
    uint32_t scans_other;
    /* scan numbers that were skipped; scans that come after all are counted in scans_late, too */
    uint32_t scans_lost;
    /* messages that contradict other parts of their scan, or the sensor's numbers */
    uint32_t scans_bad;
    uint32_t scans_incomplete; /* scans that went out without some of their parts */
    /* scans refused for their time: far off the sensor's other scans, or off the common clock */
    uint32_t clock_jumps;
    uint32_t sensor_restarts; /* restarts of a sensor: new numbers or times that were followed */
    /* messages of sensors beyond RHO_MAX_SENSORS, or without room in RHO_MAX_OPEN_SCANS */
    uint32_t sensors_no_room;
    uint32_t bearings_in; /* bearings of accepted scans */
    /* last plots or bearings of accepted scans, beyond RHO_MAX_PLOTS or RHO_MAX_BEARINGS */
    uint32_t plots_no_room;
};

enum rho_scan_assembler_kind {
    RHO_SCAN_ASSEMBLER_PLOTS = 0,
    RHO_SCAN_ASSEMBLER_POLAR,
    RHO_SCAN_ASSEMBLER_BEARINGS,
    RHO_NUM_SCAN_ASSEMBLER_KINDS
};

/* 1 for kinds of scans that the library is built with. */
#define RHO_SCAN_ASSEMBLER_HAS(kind) (((RHO_SCAN_KINDS) >> (kind)&1) != 0)

/* 1 where a kind is `which`; a constant where the build has no such kind, or no other. */
#define RHO_SCAN_ASSEMBLER_IS(kind, which)                                                         \
    ((RHO_SCAN_KINDS) == 1 << (which) || (RHO_SCAN_ASSEMBLER_HAS(which) && (kind) == (which)))

/* Position of a scan in its sensor's sequence: time, number and epoch. */
struct rho_scan_assembler_place {
    int64_t time_us;
    int32_t scan, epoch;
};

/* Series of scans that were refused for their number or time, and agree with one another. */
struct rho_scan_assembler_stray {
    struct rho_scan_assembler_place place; /* position of the newest scan of the series */
    uint32_t scans;    /* number of scans in the series; 0: there is no series */
    uint32_t reserved; /* padding: 0 */
};

/* Token bucket of a rate limit: the tokens left until it is filled again, once a second. */
struct rho_scan_assembler_bucket {
    int64_t full_us; /* reception time at which the bucket was full */
    uint32_t left;
    uint32_t reserved; /* padding: 0 */
};

/* One sensor's stream of messages. */
struct rho_scan_assembler_source {
    struct rho_scan_assembler_place place; /* position of the newest accepted scan */
    /* series of refused scans, the last extended first */
    struct rho_scan_assembler_stray strays[RHO_SCAN_ASSEMBLER_STRAYS];
    int64_t heard_us; /* reception time of the last accepted scan */
    struct rho_scan_assembler_bucket messages;
    uint32_t seen;    /* bit i is set: scan number place.scan - i was received */
    uint32_t skipped; /* bit i is set: scan number place.scan - i was skipped, and may still come */
    uint32_t interval_us; /* smoothed time from one scan number to the next; 0: not known yet */
    /* time for which it was heard, by the reception clock, up to RHO_SCAN_ASSEMBLER_TRUST_US */
    uint32_t known_us;
    uint32_t told_us;  /* the same by the sensor's own clock; saturates */
    uint32_t delay_us; /* private: delay of the newest scan, beyond that of scans before it */
    /* private: checksum of the newest scan's first part, as it was received first */
    uint32_t check;
    uint16_t scans; /* number of accepted scans; saturates */
    /* successive scans off the common clock; saturates; 0: the sensor is on the common clock */
    uint8_t off_clock;
    uint8_t has_two_senders; /* 1: a scan was received twice, with different contents */
    int16_t sensor_id;
    uint8_t kind; /* kind of the sensor's scans, enum rho_scan_assembler_kind */
    uint8_t is_used;
};

/* A slot in which a scan is assembled of its parts. */
struct rho_scan_assembler_slot {
    struct rho_scan_assembler_place place;
    int64_t heard_us; /* reception time of the last part */
    uint32_t measures;
    float sector_from_rad, sector_to_rad;
    struct rho_sensor sensor;
    uint16_t source; /* index of the scan's sensor in `sources` */
    uint16_t num_parts, parts_here;
    uint16_t num_inputs; /* number of plots or bearings that are kept */
    uint8_t state;       /* private: state of the slot */
    uint8_t kind;        /* kind of the scan, enum rho_scan_assembler_kind */
    uint8_t has_sensor;
    uint8_t order; /* private: position in the sensor's sequence */
    /* for each received part, 1 more than its plots or bearings; 0: the part is missing */
    uint16_t parts[RHO_MAX_PARTS];
    struct rho_bearing bearings[RHO_MAX_BEARINGS];
    struct rho_plot plots[RHO_MAX_PLOTS];
};

struct rho_scan_assembler {
    uint32_t magic;
    uint16_t num_known;
    uint16_t is_pressed; /* 1: a scan found no room, and the oldest goes out at the next call */
    int64_t clock_us;    /* time of the newest accepted scan: the common clock */
    int64_t out_us;      /* time of the newest scan that went out; INT64_MIN: none has */
    uint16_t has_clock;
    uint16_t is_restart; /* 1: the next scan that goes out is the first on another clock */
    uint32_t newcomers;  /* scans of newcomers since the last scan of an established sensor */
    struct rho_scan_assembler_config config;
    struct rho_scan_assembler_counters counters;
    /* rate limit of the messages of newcomers and unknown sensors together */
    struct rho_scan_assembler_bucket strangers;
    struct rho_scan_assembler_bucket stranger_plots;
    struct rho_scan_assembler_source sources[RHO_MAX_SENSORS];
    struct rho_scan_assembler_sensor known[RHO_MAX_SENSORS];
    struct rho_scan_assembler_slot slots[RHO_MAX_OPEN_SCANS];
};

/* A scan to be stepped. Its pointers point into the assembler. */
struct rho_scan_assembler_item {
    enum rho_scan_assembler_kind kind;
    struct rho_scan scan;             /* the scan, where its kind is PLOTS or POLAR */
    struct rho_bearing_scan bearings; /* the scan, where its kind is BEARINGS */
    /* the sensor, for rho_tracker_set_sensor; has_sensor 0: only defaults are known of it */
    struct rho_sensor sensor;
    int has_sensor;
    /* 1: the common clock was set anew: trackers are to start anew, too, before this scan */
    int is_restart;
    uint16_t parts_missing;
    int64_t heard_us; /* reception time of the scan's last part */
};

/*
 * Defaults: hold 20 ms, late_max 20 s (0 without RHO_SECTORS: no tracker takes them), jump_max 30
 * s, flood 10 000 a second, follow_scans 3, stranger_plots 256 a second (embedded: 64), all sensors
 * allowed; other sensors: at the origin, looking everywhere, pd 0.9, no biases; noise 10 m, 1 m/s,
 * 15 m, 3 mrad, 3 mrad, 1 m/s, 1.75 mrad; gives_other 0, is_record 0. Constant cost.
 */
void rho_scan_assembler_config_default(struct rho_scan_assembler_config *config);

/*
 * Prepares an empty assembler; the config is copied.
 *   size   sizeof(struct rho_scan_assembler) of the caller
 * Errors: NULL, SIZE, CONFIG. Cost: sizeof(assembler) bytes cleared.
 */
RHO_MUST_CHECK enum rho_status
rho_scan_assembler_init(struct rho_scan_assembler *assembler, size_t size,
                        const struct rho_scan_assembler_config *config);

/*
 * Describes a sensor, or replaces the description of the same sensor_id: noise, biases, range.
 * Errors: NULL, STATE (not initialised), CONFIG (noise, a place or a bias outside its
 * limits), CAPACITY (RHO_MAX_SENSORS); nothing is changed. Cost: RHO_MAX_SENSORS.
 */
RHO_MUST_CHECK enum rho_status
rho_scan_assembler_set_sensor(struct rho_scan_assembler *assembler,
                              const struct rho_scan_assembler_sensor *sensor);

/*
 * Takes one message; any bytes may be given. RHO_OK also where it was refused: a counter has moved.
 *   channel  ends with NUL
 *   now_us   reception clock
 * Errors: NULL, STATE (not initialised), TYPE (not a sensor's channel, or of a kind that is none of
 * RHO_SCAN_KINDS), CAPACITY (no room for another open scan: call rho_scan_assembler_next once, step
 * what it gives, if anything, and take the message again; two such calls make room); nothing is
 * changed but for that call. Cost: the message's bytes, twice, RHO_MAX_SENSORS, and where parts
 * come out of order the scan's plots moved. Stack: 2 KB: the message as a struct.
 */
RHO_MUST_CHECK enum rho_status rho_scan_assembler_take(struct rho_scan_assembler *assembler,
                                                       const char *channel, const uint8_t *data,
                                                       size_t size, int64_t now_us);

/*
 * The next scan that is due, if there is one; it is valid until the next call of this function.
 * now_us INT64_MAX: all that is there goes out. Returns 0 where nothing is due, or assembler is not
 * initialised. Cost: RHO_MAX_OPEN_SCANS times RHO_MAX_SENSORS. Stack: 300 bytes.
 */
int rho_scan_assembler_next(struct rho_scan_assembler *assembler, int64_t now_us,
                            struct rho_scan_assembler_item *item);

/*
 * When rho_scan_assembler_next should be called though no message comes; INT64_MAX: not before one
 * does. Cost: RHO_MAX_OPEN_SCANS times RHO_MAX_SENSORS. Stack: 180 bytes.
 */
int64_t rho_scan_assembler_due_us(const struct rho_scan_assembler *assembler);

RHO_END_C

#endif
