/* SPDX-License-Identifier: MIT */
/*
 * zones: tracks that enter, stay in and leave polygons.
 */
#include "rhotrack/zones.h"

#include <string.h>

#include "rhotrack/detail/approx.h"
#include "rhotrack/types.h"

#define ZONES_MAGIC 0x5a4f4e45u

/* A track leaves the queue at so many times the speed at which it joins it. */
#define QUEUE_LEFT 2.0f

/* ---- setting up ------------------------------------------------------------------------------ */

enum rho_status rho_zones_init(struct rho_zones *zones, size_t size)
{
    if (!zones) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *zones) {
        return RHO_ERROR_SIZE;
    }
    memset(zones, 0, sizeof *zones);
    zones->magic = ZONES_MAGIC;
    return RHO_OK;
}

/* Corner i, and the one behind it. */
struct side {
    float x_m, y_m, to_x_m, to_y_m;
};

static struct side side_of(const struct rho_zone *zone, unsigned i)
{
    const unsigned next = i + 1u < zone->num_corners ? i + 1u : 0;
    return (struct side){zone->x_m[i], zone->y_m[i], zone->x_m[next], zone->y_m[next]};
}

static int has_area(const struct rho_zone *zone)
{
    float twice_m2 = 0.0f;
    for (unsigned i = 0; i < zone->num_corners; i++) {
        const struct side side = side_of(zone, i);
        twice_m2 += (side.x_m - zone->x_m[0]) * (side.to_y_m - zone->y_m[0]) -
                    (side.to_x_m - zone->x_m[0]) * (side.y_m - zone->y_m[0]);
    }
    return twice_m2 > 0.0f || twice_m2 < 0.0f;
}

static int is_usable(const struct rho_zone *zone)
{
    if (zone->num_corners < 3 || zone->num_corners > RHO_ZONE_CORNERS || zone->has_heading > 1 ||
        !rho_is_within(zone->heading_rad, -RHO_ZONE_HEADING_MAX_RAD, RHO_ZONE_HEADING_MAX_RAD) ||
        !rho_is_within(zone->margin_m, 0.0f, RHO_ZONE_MARGIN_MAX_M) ||
        !rho_is_within(zone->queue_mps, 0.0f, RHO_ZONE_QUEUE_MAX_MPS)) {
        return 0;
    }
    for (unsigned i = 0; i < zone->num_corners; i++) {
        if (!rho_is_within(zone->x_m[i], -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M) ||
            !rho_is_within(zone->y_m[i], -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M)) {
            return 0;
        }
    }
    return has_area(zone);
}

static struct rho_extent bounds_of(const struct rho_zone *zone)
{
    struct rho_extent bounds = {zone->x_m[0], zone->x_m[0], zone->y_m[0], zone->y_m[0]};
    for (unsigned i = 1; i < zone->num_corners; i++) {
        const float x_m = zone->x_m[i], y_m = zone->y_m[i];
        bounds.x_min_m = x_m < bounds.x_min_m ? x_m : bounds.x_min_m;
        bounds.x_max_m = x_m > bounds.x_max_m ? x_m : bounds.x_max_m;
        bounds.y_min_m = y_m < bounds.y_min_m ? y_m : bounds.y_min_m;
        bounds.y_max_m = y_m > bounds.y_max_m ? y_m : bounds.y_max_m;
    }
    return (struct rho_extent){bounds.x_min_m - zone->margin_m, bounds.x_max_m + zone->margin_m,
                               bounds.y_min_m - zone->margin_m, bounds.y_max_m + zone->margin_m};
}

enum rho_status rho_zones_add(struct rho_zones *zones, const struct rho_zone *zone)
{
    if (!zones || !zone) {
        return RHO_ERROR_NULL;
    }
    if (zones->magic != ZONES_MAGIC) {
        return RHO_ERROR_STATE;
    }
    if (zones->num_zones == RHO_MAX_ZONES) {
        return RHO_ERROR_CAPACITY;
    }
    if (!is_usable(zone)) {
        return RHO_ERROR_VALUE;
    }
    for (unsigned i = 0; i < zones->num_zones; i++) {
        if (zones->zones[i].zone_id == zone->zone_id) {
            return RHO_ERROR_VALUE;
        }
    }
    zones->bounds[zones->num_zones] = bounds_of(zone);
    zones->zones[zones->num_zones++] = *zone;
    return RHO_OK;
}

/* ---- places ---------------------------------------------------------------------------------- */

static int is_near(const struct rho_extent *bounds, float x_m, float y_m)
{
    return x_m >= bounds->x_min_m && x_m <= bounds->x_max_m && y_m >= bounds->y_min_m &&
           y_m <= bounds->y_max_m;
}

/* A ray to the east crosses an odd number of sides. */
static int is_inside(const struct rho_zone *zone, float x_m, float y_m)
{
    int inside = 0;
    unsigned before = zone->num_corners - 1u;
    for (unsigned i = 0; i < zone->num_corners; i++) {
        if ((zone->y_m[i] > y_m) != (zone->y_m[before] > y_m)) {
            const float share = (y_m - zone->y_m[i]) / (zone->y_m[before] - zone->y_m[i]);
            inside ^= x_m < zone->x_m[i] + share * (zone->x_m[before] - zone->x_m[i]);
        }
        before = i;
    }
    return inside;
}

static float distance2_to(const struct side *side, float x_m, float y_m)
{
    const float along_x_m = side->to_x_m - side->x_m, along_y_m = side->to_y_m - side->y_m;
    const float off_x_m = x_m - side->x_m, off_y_m = y_m - side->y_m;
    const float length2_m2 = along_x_m * along_x_m + along_y_m * along_y_m;
    float share = off_x_m * along_x_m + off_y_m * along_y_m;
    share = share <= 0.0f ? 0.0f : share >= length2_m2 ? 1.0f : share / length2_m2;
    const float left_x_m = off_x_m - share * along_x_m, left_y_m = off_y_m - share * along_y_m;
    return left_x_m * left_x_m + left_y_m * left_y_m;
}

static int is_within_margin(const struct rho_zone *zone, float x_m, float y_m)
{
    int is_within = 0;
    for (unsigned i = 0; i < zone->num_corners && !is_within; i++) {
        const struct side side = side_of(zone, i);
        is_within = distance2_to(&side, x_m, y_m) <= zone->margin_m * zone->margin_m;
    }
    return is_within;
}

/* ---- events ---------------------------------------------------------------------------------- */

/* A track as the zones see it. */
struct sight {
    uint32_t track_id;
    float x_m, y_m, vx_mps, vy_mps, speed_mps;
    int is_believed; /* confirmed, so that it may enter */
};

static struct sight sight_of(const struct rho_track_report *track)
{
    const float vx_mps = track->state[RHO_VX], vy_mps = track->state[RHO_VY];
    return (struct sight){.track_id = track->track_id,
                          .x_m = track->state[RHO_X],
                          .y_m = track->state[RHO_Y],
                          .vx_mps = vx_mps,
                          .vy_mps = vy_mps,
                          .speed_mps = rho_sqrt(vx_mps * vx_mps + vy_mps * vy_mps),
                          .is_believed = track->status == RHO_TRACK_CONFIRMED};
}

static int8_t direction_of(const struct rho_zone *zone, const struct sight *sight)
{
    if (!zone->has_heading || !(sight->speed_mps > zone->queue_mps)) {
        return 0;
    }
    const float along_mps =
        sight->vx_mps * rho_cos(zone->heading_rad) + sight->vy_mps * rho_sin(zone->heading_rad);
    return (int8_t)(along_mps > 0.0f ? 1 : along_mps < 0.0f ? -1 : 0);
}

static void add_event(struct rho_zones *zones, const struct rho_zone_event *event)
{
    if (zones->num_events < RHO_ZONE_EVENTS) {
        zones->events[zones->num_events++] = *event;
    } else {
        zones->events_dropped = rho_count(zones->events_dropped, 1);
    }
}

static void enter(struct rho_zones *zones, struct rho_zone_visitor *visitor, unsigned place,
                  const struct sight *sight)
{
    visitor->inside |= 1u << place;
    visitor->since_us[place] = zones->time_us;
    zones->counts[place].entered = rho_count(zones->counts[place].entered, 1);
    add_event(zones, &(struct rho_zone_event){
                         .zone_id = zones->zones[place].zone_id,
                         .track_id = sight->track_id,
                         .change = RHO_ZONE_ENTERS,
                         .direction = direction_of(&zones->zones[place], sight),
                         .speed_mps = sight->speed_mps,
                     });
}

static void leave(struct rho_zones *zones, struct rho_zone_visitor *visitor, unsigned place,
                  const struct sight *sight)
{
    struct rho_zone_counts *counts = &zones->counts[place];
    const float dwell_s = rho_seconds_between(visitor->since_us[place], zones->time_us);
    const int8_t direction = direction_of(&zones->zones[place], sight);
    visitor->inside &= ~(1u << place);
    visitor->queued &= ~(1u << place);
    counts->left = rho_count(counts->left, 1);
    counts->along = rho_count(counts->along, direction > 0);
    counts->against = rho_count(counts->against, direction < 0);
    counts->dwell_mean_s += (dwell_s - counts->dwell_mean_s) / (float)counts->left;
    counts->dwell_max_s = dwell_s > counts->dwell_max_s ? dwell_s : counts->dwell_max_s;
    add_event(zones, &(struct rho_zone_event){.zone_id = zones->zones[place].zone_id,
                                              .track_id = sight->track_id,
                                              .change = RHO_ZONE_LEAVES,
                                              .direction = direction,
                                              .speed_mps = sight->speed_mps,
                                              .dwell_s = dwell_s});
}

/* Its track is no longer reported. */
static void end_visit(struct rho_zones *zones, const struct rho_zone_visitor *visitor)
{
    for (unsigned place = 0; place < zones->num_zones; place++) {
        if (visitor->inside >> place & 1u) {
            zones->counts[place].ended = rho_count(zones->counts[place].ended, 1);
            add_event(zones,
                      &(struct rho_zone_event){.zone_id = zones->zones[place].zone_id,
                                               .track_id = visitor->track_id,
                                               .change = RHO_ZONE_ENDS,
                                               .speed_mps = visitor->speed_mps,
                                               .dwell_s = rho_seconds_between(
                                                   visitor->since_us[place], zones->time_us)});
        }
    }
}

/* ---- a step ---------------------------------------------------------------------------------- */

/* The tracks in a zone; of the queued ones the extent, along the heading or of both axes. */
struct crowd {
    unsigned inside, queued;
    float speed_sum_mps;
    float min_m[2], max_m[2];
};

static void add_to_queue(struct crowd *crowd, const struct rho_zone *zone,
                         const struct sight *sight)
{
    float at_m[2] = {sight->x_m, sight->y_m};
    if (zone->has_heading) {
        at_m[0] = sight->x_m * rho_cos(zone->heading_rad) + sight->y_m * rho_sin(zone->heading_rad);
        at_m[1] = 0.0f;
    }
    for (int axis = 0; axis < 2; axis++) {
        if (crowd->queued == 0 || at_m[axis] < crowd->min_m[axis]) {
            crowd->min_m[axis] = at_m[axis];
        }
        if (crowd->queued == 0 || at_m[axis] > crowd->max_m[axis]) {
            crowd->max_m[axis] = at_m[axis];
        }
    }
    crowd->queued++;
}

static void count_crowd(struct rho_zone_counts *counts, const struct crowd *crowd)
{
    const float x_m = crowd->max_m[0] - crowd->min_m[0], y_m = crowd->max_m[1] - crowd->min_m[1];
    counts->inside = (uint16_t)crowd->inside;
    counts->queued = (uint16_t)crowd->queued;
    counts->queue_m = rho_sqrt(x_m * x_m + y_m * y_m);
    counts->speed_mps = crowd->inside > 0 ? crowd->speed_sum_mps / (float)crowd->inside : 0.0f;
}

static void join_zone(struct crowd *crowd, const struct rho_zone *zone, unsigned place,
                      struct rho_zone_visitor *visitor, const struct sight *sight)
{
    const uint32_t bit = (uint32_t)1 << place;
    const float limit_mps = (visitor->queued & bit ? QUEUE_LEFT : 1.0f) * zone->queue_mps;
    crowd->inside++;
    crowd->speed_sum_mps += sight->speed_mps;
    if (sight->speed_mps < limit_mps) {
        visitor->queued |= bit;
        add_to_queue(crowd, zone, sight);
    } else {
        visitor->queued &= ~bit;
    }
}

static void visit_zone(struct rho_zones *zones, struct rho_zone_visitor *visitor, unsigned place,
                       const struct sight *sight, struct crowd *crowd)
{
    const struct rho_zone *zone = &zones->zones[place];
    const int was_inside = (int)(visitor->inside >> place & 1u);
    const int inside = is_inside(zone, sight->x_m, sight->y_m);
    if (!was_inside && inside && sight->is_believed) {
        enter(zones, visitor, place, sight);
    } else if (was_inside && !inside && !is_within_margin(zone, sight->x_m, sight->y_m)) {
        leave(zones, visitor, place, sight);
    }
    if (visitor->inside >> place & 1u) {
        join_zone(crowd, zone, place, visitor, sight);
    }
}

static const struct rho_track_report *find_track(const struct rho_report *report, uint32_t track_id,
                                                 unsigned *from)
{
    for (unsigned i = 0; i < report->num_tracks; i++) {
        const unsigned at = (*from + i) % report->num_tracks;
        if (report->tracks[at].track_id == track_id) {
            *from = at + 1u;
            return &report->tracks[at];
        }
    }
    return NULL;
}

/* Visitors whose track has ended, or that are in no zone any more, make room. */
static void forget_visitors(struct rho_zones *zones, const struct rho_report *report)
{
    unsigned kept = 0, from = 0;
    for (unsigned i = 0; i < zones->num_visitors; i++) {
        const struct rho_zone_visitor *visitor = &zones->visitors[i];
        if (!find_track(report, visitor->track_id, &from)) {
            end_visit(zones, visitor);
        } else if (visitor->inside != 0) {
            if (kept < i) {
                zones->visitors[kept] = *visitor;
            }
            kept++;
        }
    }
    zones->num_visitors = (uint16_t)kept;
}

/* That of the track, or the next one, which is in no zone yet. */
static struct rho_zone_visitor *visitor_of(struct rho_zones *zones, uint32_t track_id,
                                           unsigned *from)
{
    struct rho_zone_visitor *next = &zones->visitors[zones->num_visitors];
    for (unsigned i = 0; i < zones->num_visitors; i++) {
        const unsigned at = (*from + i) % zones->num_visitors;
        if (zones->visitors[at].track_id == track_id) {
            *from = at + 1u;
            return &zones->visitors[at];
        }
    }
    next->track_id = track_id;
    next->inside = next->queued = 0;
    return next;
}

/* Tracks in the order of the report, each through all zones. */
static void visit_zones(struct rho_zones *zones, const struct rho_report *report)
{
    struct crowd crowds[RHO_MAX_ZONES] = {{0}};
    unsigned from = 0;
    for (unsigned i = 0; i < report->num_tracks; i++) {
        const struct sight sight = sight_of(&report->tracks[i]);
        struct rho_zone_visitor *visitor = visitor_of(zones, sight.track_id, &from);
        for (unsigned place = 0; place < zones->num_zones; place++) {
            if ((visitor->inside >> place & 1u) ||
                is_near(&zones->bounds[place], sight.x_m, sight.y_m)) {
                visit_zone(zones, visitor, place, &sight, &crowds[place]);
            }
        }
        visitor->speed_mps = sight.speed_mps;
        if (visitor->inside != 0 && visitor == &zones->visitors[zones->num_visitors]) {
            zones->num_visitors++;
        }
    }
    for (unsigned place = 0; place < zones->num_zones; place++) {
        count_crowd(&zones->counts[place], &crowds[place]);
    }
}

enum rho_status rho_zones_step(struct rho_zones *zones, const struct rho_report *report)
{
    if (!zones || !report) {
        return RHO_ERROR_NULL;
    }
    if (zones->magic != ZONES_MAGIC) {
        return RHO_ERROR_STATE;
    }
    if (report->num_tracks > RHO_MAX_TRACKS) {
        return RHO_ERROR_VALUE;
    }
    zones->num_events = 0;
    if (report->time_us < zones->time_us) {
        for (unsigned i = 0; i < zones->num_visitors; i++) {
            end_visit(zones, &zones->visitors[i]);
        }
        zones->num_visitors = 0;
    }
    zones->time_us = report->time_us;
    forget_visitors(zones, report);
    visit_zones(zones, report);
    return RHO_OK;
}

const char *rho_zone_change_name(enum rho_zone_change change)
{
    static const char names[RHO_NUM_ZONE_CHANGES][7] = {
        [RHO_ZONE_ENTERS] = "enters", [RHO_ZONE_LEAVES] = "leaves", [RHO_ZONE_ENDS] = "ends"};
    return (unsigned)change < RHO_NUM_ZONE_CHANGES ? names[change] : "unknown";
}
