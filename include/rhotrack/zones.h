/* SPDX-License-Identifier: MIT */
/*
 * zones: counts the tracks that enter, stay in and leave polygons on the ground, such as a lane, a
 * stop line, a berth or a fairway.
 *
 *     rho_zones_init(&zones, sizeof zones);
 *     rho_zones_add(&zones, &zone);                              each one once
 *     while (rho_tracker_step(&tracker, &initiator, &scan, &report) == RHO_OK) {
 *         rho_zones_step(&zones, &report);
 *         ... zones.events[0 .. num_events - 1], zones.counts[0 .. num_zones - 1]
 *     }
 *
 * A confirmed track enters a zone when its estimate lies in the polygon, and leaves it when it lies
 * margin_m outside: noise at the border counts once. A coasting track stays, and can leave. A track
 * that ends in a zone has not left it. Places are x and y of the tracker's frame.
 *
 * A track in a zone joins its queue when it is slower than queue_mps, and leaves the queue when it
 * is faster than twice that.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_ZONES_H
#define RHOTRACK_ZONES_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/tracker.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

#define RHO_ZONE_CORNERS 8
/* Places for zones: RHO_MAX_ZONES, and 1 in a build without them. */
#define RHO_ZONE_PLACES (RHO_MAX_ZONES > 0 ? RHO_MAX_ZONES : 1)
#define RHO_ZONE_EVENTS 64 /* largest number of events of a step */

/* Largest values of a zone's fields; the heading may have either sign. */
#define RHO_ZONE_HEADING_MAX_RAD 7.0f
#define RHO_ZONE_MARGIN_MAX_M 1e5f
#define RHO_ZONE_QUEUE_MAX_MPS 1e3f

struct rho_zone {
    int32_t zone_id; /* identity of the zone, different for each zone */
    /* number of corners, 3 .. RHO_ZONE_CORNERS, in either sense; sides must not cross */
    uint16_t num_corners;
    uint16_t has_heading; /* 1: the zone is a lane, and tracks go along it or against it */
    float x_m[RHO_ZONE_CORNERS], y_m[RHO_ZONE_CORNERS]; /* corners, within RHO_LIMIT_POSITION_M */
    float heading_rad; /* heading of the lane, counter-clockwise from +x; -7 .. 7 rad */
    /* distance outside of the polygon at which a track leaves the zone, 0 .. 1e5 m */
    float margin_m;
    /* speed below which a track joins the queue, 0 .. 1e3 m/s; 0: there is no queue */
    float queue_mps;
};

enum rho_zone_change {
    RHO_ZONE_ENTERS = 0,
    RHO_ZONE_LEAVES,
    RHO_ZONE_ENDS, /* the track has ended in the zone */
    RHO_NUM_ZONE_CHANGES
};

struct rho_zone_event {
    int32_t zone_id;
    uint32_t track_id;
    uint8_t change; /* enum rho_zone_change: what the track did */
    /* 1: the track goes along the lane, -1: against it; 0: it stands, or the zone is no lane */
    int8_t direction;
    float speed_mps; /* speed of the track; of an ended track its last speed */
    float dwell_s;   /* time since the track entered the zone */
};

/* Counts of one zone; counters saturate. */
struct rho_zone_counts {
    /* tracks since rho_zones_add that entered, left, and ended inside */
    uint32_t entered, left, ended;
    uint32_t along, against; /* tracks that left along the lane's heading, and against it */
    uint16_t inside, queued; /* tracks inside now, and in the queue */
    float speed_mps;         /* mean speed of the tracks inside; 0 where there are none */
    /* first to last queued track along the lane; without a lane, the diagonal of their extent */
    float queue_m;
    float dwell_mean_s, dwell_max_s; /* mean and longest time inside of the tracks that left */
};

/* A track that is in one or more zones. */
struct rho_zone_visitor {
    uint32_t track_id;
    uint32_t inside, queued; /* bit i is set: the track is inside zone i, and in its queue */
    float speed_mps;
    int64_t since_us[RHO_ZONE_PLACES];
};

struct rho_zones {
    uint32_t magic;
    uint16_t num_zones, num_events, num_visitors;
    /* events beyond RHO_ZONE_EVENTS in a step, since rho_zones_init; their tracks are counted */
    uint32_t events_dropped;
    int64_t time_us; /* time of the last step */
    struct rho_zone zones[RHO_ZONE_PLACES];
    struct rho_extent bounds[RHO_ZONE_PLACES]; /* private: limits of the zones with their margins */
    /* counts of the zones, in the order of the zones */
    struct rho_zone_counts counts[RHO_ZONE_PLACES];
    struct rho_zone_event events[RHO_ZONE_EVENTS]; /* events of the last step */
    struct rho_zone_visitor visitors[RHO_MAX_TRACKS];
};

/* Prepares an empty set of zones. Errors: NULL, SIZE. Cost: sizeof(zones) bytes cleared. */
RHO_MUST_CHECK enum rho_status rho_zones_init(struct rho_zones *zones, size_t size);

/*
 * Adds a zone, which is copied. Errors: NULL, STATE (not initialised), CAPACITY (RHO_MAX_ZONES are
 * there), VALUE (a field outside its range, a zone_id that is there, an area of 0); *zones is
 * unchanged. Cost: corners. Stack: 112 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_zones_add(struct rho_zones *zones, const struct rho_zone *zone);

/*
 * Counts the tracks of a report. Where its time is before that of the last report, all tracks that
 * were in zones have ended first. Errors: NULL, STATE, VALUE (more than RHO_MAX_TRACKS tracks).
 * Cost: tracks times zones, and corners where a track is near. Stack: 720 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_zones_step(struct rho_zones *zones,
                                              const struct rho_report *report);

/* Name of a change: "enters", "leaves" or "ends"; "unknown" for any other value. */
const char *rho_zone_change_name(enum rho_zone_change change);

RHO_END_C

#endif
