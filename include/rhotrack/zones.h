/* SPDX-License-Identifier: MIT */
/*
 * zones: polygons on the ground that count the tracks in them, as a lane, a stop line, a berth, a
 * fairway does.
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
 * A track in a zone stands in its queue once it is slower than queue_mps, until it is faster than
 * twice that.
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

#ifdef __cplusplus
extern "C" {
#endif

#define RHO_ZONE_CORNERS 8
#define RHO_ZONE_EVENTS 64 /* of a step */

/* Largest values of a zone's fields, either way of the heading. */
#define RHO_ZONE_HEADING_MAX_RAD 7.0f
#define RHO_ZONE_MARGIN_MAX_M 1e5f
#define RHO_ZONE_QUEUE_MAX_MPS 1e3f

struct rho_zone {
    int32_t zone_id;      /* another one for each zone */
    uint16_t num_corners; /* 3 .. RHO_ZONE_CORNERS, in either sense; sides must not cross */
    uint16_t has_heading; /* 1: a lane, whose tracks go along it or against it */
    float x_m[RHO_ZONE_CORNERS], y_m[RHO_ZONE_CORNERS]; /* within RHO_LIMIT_POSITION_M */
    float heading_rad;                                  /* of the lane, from +x; within 7 rad */
    float margin_m;                                     /* 0 .. 1e5 */
    float queue_mps;                                    /* 0 .. 1e3; 0: there is no queue */
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
    uint8_t change; /* enum rho_zone_change */
    /* 1: along the lane's heading, -1: against it; 0: it stands, or the zone is no lane */
    int8_t direction;
    float speed_mps; /* of a track that has ended the last one */
    float dwell_s;   /* since it entered */
};

/* Of one zone; counters saturate. */
struct rho_zone_counts {
    uint32_t entered, left, ended; /* since rho_zones_add */
    uint32_t along, against;       /* of those that left */
    uint16_t inside, queued;       /* now */
    float speed_mps;               /* mean of those inside; 0 of none */
    /* from the first queued track to the last: along the heading, or of an area its diagonal */
    float queue_m;
    float dwell_mean_s, dwell_max_s; /* of those that left */
};

/* A track that is in some zone. */
struct rho_zone_visitor {
    uint32_t track_id;
    uint32_t inside, queued; /* a bit a zone */
    float speed_mps;
    int64_t since_us[RHO_MAX_ZONES];
};

struct rho_zones {
    uint32_t magic;
    uint16_t num_zones, num_events, num_visitors;
    uint32_t
        events_dropped; /* beyond RHO_ZONE_EVENTS of a step, since init; they count as all do */
    int64_t time_us;    /* of the last step */
    struct rho_zone zones[RHO_MAX_ZONES];
    struct rho_extent bounds[RHO_MAX_ZONES];       /* private: of the zones with their margins */
    struct rho_zone_counts counts[RHO_MAX_ZONES];  /* of the zones in their order */
    struct rho_zone_event events[RHO_ZONE_EVENTS]; /* of the last step */
    struct rho_zone_visitor visitors[RHO_MAX_TRACKS];
};

/* No zone. Errors: NULL, SIZE. Cost: sizeof(zones) bytes cleared. */
RHO_MUST_CHECK enum rho_status rho_zones_init(struct rho_zones *zones, size_t size);

/*
 * Adds a zone, which is copied. Errors: NULL, STATE (not initialised), CAPACITY (RHO_MAX_ZONES are
 * there), VALUE (a field outside its range, a zone_id that is there, an area of 0); *zones is
 * unchanged. Cost: corners.
 */
RHO_MUST_CHECK enum rho_status rho_zones_add(struct rho_zones *zones, const struct rho_zone *zone);

/*
 * Counts the tracks of a report. Of a report whose time is before the last one's all tracks in
 * zones have ended first.
 * Errors: NULL, STATE, VALUE (more than RHO_MAX_TRACKS tracks). Cost: tracks times zones, and
 * corners where a track is near. Stack: 720 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_zones_step(struct rho_zones *zones,
                                              const struct rho_report *report);

/* "enters", "leaves", "ends"; "unknown" for any other value. */
const char *rho_zone_change_name(enum rho_zone_change change);

#ifdef __cplusplus
}
#endif

#endif
