/* SPDX-License-Identifier: MIT */
/* zones: counts the tracks that enter, stay in and leave polygons on the ground. */
#include "rhotrack/zones.h"

#include <string.h>

#include "policy.h"
#include "rhotrack/detail/approx.h"

enum { ZONES_MAGIC = 0x5a4f4e45 };

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

/* A side of a polygon: from a corner to the next corner. */
struct zone_side {
    float x_m, y_m, to_x_m, to_y_m;
};

static struct zone_side side_of_zone(const struct rho_zone *zone, unsigned i)
{
    const unsigned next = i + 1u < zone->num_corners ? i + 1u : 0;
    return (struct zone_side){zone->x_m[i], zone->y_m[i], zone->x_m[next], zone->y_m[next]};
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
    if (zone->num_corners < 3 || zone->num_corners > RHO_ZONE_CORNERS || zone->has_heading > 1 ||
        !rho_is_within(zone->heading_rad, -RHO_ZONE_HEADING_MAX_RAD, RHO_ZONE_HEADING_MAX_RAD) ||
        !rho_is_within(zone->margin_m, 0.0f, RHO_ZONE_MARGIN_MAX_M) ||
        !rho_is_within(zone->queue_mps, 0.0f, RHO_ZONE_QUEUE_MAX_MPS)) {
        return RHO_ERROR_VALUE;
    }
    for (unsigned i = 0; i < zones->num_zones; i++) {
        if (zones->zones[i].zone_id == zone->zone_id) {
            return RHO_ERROR_VALUE;
        }
    }
    float twice_m2 = 0.0f; /* twice the polygon's area */
    for (unsigned i = 0; i < zone->num_corners; i++) {
        const struct zone_side side = side_of_zone(zone, i);
        if (!rho_is_coordinate(side.x_m) || !rho_is_coordinate(side.y_m)) {
            return RHO_ERROR_VALUE;
        }
        twice_m2 += (side.x_m - zone->x_m[0]) * (side.to_y_m - zone->y_m[0]) -
                    (side.to_x_m - zone->x_m[0]) * (side.y_m - zone->y_m[0]);
    }
    if (!(twice_m2 > 0.0f || twice_m2 < 0.0f)) {
        return RHO_ERROR_VALUE;
    }
    struct rho_extent bounds = {zone->x_m[0], zone->x_m[0], zone->y_m[0], zone->y_m[0]};
    for (unsigned i = 1; i < zone->num_corners; i++) {
        bounds.x_min_m = rho_smaller(zone->x_m[i], bounds.x_min_m);
        bounds.x_max_m = rho_larger(zone->x_m[i], bounds.x_max_m);
        bounds.y_min_m = rho_smaller(zone->y_m[i], bounds.y_min_m);
        bounds.y_max_m = rho_larger(zone->y_m[i], bounds.y_max_m);
    }
    zones->bounds[zones->num_zones] =
        (struct rho_extent){bounds.x_min_m - zone->margin_m, bounds.x_max_m + zone->margin_m,
                            bounds.y_min_m - zone->margin_m, bounds.y_max_m + zone->margin_m};
    zones->zones[zones->num_zones++] = *zone;
    return RHO_OK;
}

/* Places */

/* 1 where a ray from the place to the east crosses an odd number of the polygon's sides. */
static int is_inside_polygon(const struct rho_zone *zone, float x_m, float y_m)
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

/* Events */

/* Component along a zone's heading of a place or velocity. */
static float along_heading(const struct rho_zone *zone, float x, float y)
{
    return x * rho_cos(zone->heading_rad) + y * rho_sin(zone->heading_rad);
}

/* 1: a track moves along the zone's heading, -1: against it, 0: it is slow, or there is none. */
static int8_t direction_along_lane(const struct rho_zone *zone,
                                   const struct rho_track_report *track, float speed_mps)
{
    if (!zone->has_heading || !(speed_mps > zone->queue_mps)) {
        return 0;
    }
    const float along_mps = along_heading(zone, track->state[RHO_VX], track->state[RHO_VY]);
    return (int8_t)(along_mps > 0.0f ? 1 : along_mps < 0.0f ? -1 : 0);
}

/* Adds an event of a track in a zone, and tells the time that it was there. */
static float add_event(struct rho_zones *zones, const struct rho_zone_visitor *visitor,
                       unsigned place, enum rho_zone_change change, int8_t direction)
{
    const float dwell_s = rho_seconds_between(visitor->since_us[place], zones->time_us);
    if (zones->num_events < RHO_ZONE_EVENTS) {
        zones->events[zones->num_events++] =
            (struct rho_zone_event){.zone_id = zones->zones[place].zone_id,
                                    .track_id = visitor->track_id,
                                    .change = (uint8_t)change,
                                    .direction = direction,
                                    .speed_mps = visitor->speed_mps,
                                    .dwell_s = dwell_s};
    } else {
        zones->events_dropped = rho_count(zones->events_dropped, 1);
    }
    return dwell_s;
}

/* Counts a track that is no longer reported as ended, in each zone that it was in. */
static void end_visits(struct rho_zones *zones, const struct rho_zone_visitor *visitor)
{
    for (unsigned place = 0; place < zones->num_zones; place++) {
        if (visitor->inside >> place & 1u) {
            zones->counts[place].ended = rho_count(zones->counts[place].ended, 1);
            (void)add_event(zones, visitor, place, RHO_ZONE_ENDS, 0);
        }
    }
}

/* A step */

/* The tracks in a zone, and the extent of the queued tracks: along the lane, or in x and y. */
struct occupants {
    unsigned inside, queued;
    float speed_sum_mps;
    float min_m[2], max_m[2];
};

static void update_zone(struct rho_zones *zones, struct rho_zone_visitor *visitor, unsigned place,
                        const struct rho_track_report *track, struct occupants *occupants)
{
    const float x_m = track->state[RHO_X], y_m = track->state[RHO_Y];
    const float speed_mps = visitor->speed_mps;
    const struct rho_zone *zone = &zones->zones[place];
    struct rho_zone_counts *counts = &zones->counts[place];
    const uint32_t bit = (uint32_t)1 << place;
    const int was_inside = (visitor->inside & bit) != 0;
    const int inside = is_inside_polygon(zone, x_m, y_m);
    int leaves = was_inside && !inside; /* and is farther than the margin from each side */
    for (unsigned i = 0; i < zone->num_corners && leaves; i++) {
        const struct zone_side side = side_of_zone(zone, i);
        const float along_x_m = side.to_x_m - side.x_m, along_y_m = side.to_y_m - side.y_m;
        const float off_x_m = x_m - side.x_m, off_y_m = y_m - side.y_m;
        const float length2_m2 = along_x_m * along_x_m + along_y_m * along_y_m;
        float share = off_x_m * along_x_m + off_y_m * along_y_m;
        share = share <= 0.0f ? 0.0f : share >= length2_m2 ? 1.0f : share / length2_m2;
        const float left_x_m = off_x_m - share * along_x_m, left_y_m = off_y_m - share * along_y_m;
        leaves = !(left_x_m * left_x_m + left_y_m * left_y_m <= zone->margin_m * zone->margin_m);
    }
    if (!was_inside && inside && track->status == RHO_TRACK_CONFIRMED) {
        visitor->inside |= bit;
        visitor->since_us[place] = zones->time_us;
        counts->entered = rho_count(counts->entered, 1);
        (void)add_event(zones, visitor, place, RHO_ZONE_ENTERS,
                        direction_along_lane(zone, track, speed_mps));
    } else if (leaves) {
        const int8_t direction = direction_along_lane(zone, track, speed_mps);
        const float dwell_s = add_event(zones, visitor, place, RHO_ZONE_LEAVES, direction);
        visitor->inside &= ~bit;
        visitor->queued &= ~bit;
        counts->left = rho_count(counts->left, 1);
        counts->along = rho_count(counts->along, direction > 0);
        counts->against = rho_count(counts->against, direction < 0);
        counts->dwell_mean_s += (dwell_s - counts->dwell_mean_s) / (float)counts->left;
        counts->dwell_max_s = rho_larger(dwell_s, counts->dwell_max_s);
    }
    if (!(visitor->inside & bit)) {
        return;
    }
    /* counts the track, and lets it join or leave the zone's queue by its speed */
    const float limit_mps = (visitor->queued & bit ? QUEUE_LEFT : 1.0f) * zone->queue_mps;
    occupants->inside++;
    occupants->speed_sum_mps += speed_mps;
    if (!(speed_mps < limit_mps)) {
        visitor->queued &= ~bit;
        return;
    }
    visitor->queued |= bit;
    float at_m[2] = {x_m, y_m};
    if (zone->has_heading) {
        at_m[0] = along_heading(zone, x_m, y_m);
        at_m[1] = 0.0f;
    }
    for (int axis = 0; axis < 2; axis++) {
        if (occupants->queued == 0 || at_m[axis] < occupants->min_m[axis]) {
            occupants->min_m[axis] = at_m[axis];
        }
        if (occupants->queued == 0 || at_m[axis] > occupants->max_m[axis]) {
            occupants->max_m[axis] = at_m[axis];
        }
    }
    occupants->queued++;
}

/* Removes visitors whose track has ended, with an event, or is in no zone any more. */
static void remove_gone_visitors(struct rho_zones *zones, const struct rho_report *report)
{
    unsigned kept = 0, from = 0; /* a visitor's report is sought from behind the one before */
    for (unsigned i = 0; i < zones->num_visitors; i++) {
        const struct rho_zone_visitor *visitor = &zones->visitors[i];
        int is_reported = 0;
        for (unsigned k = 0; k < report->num_tracks && !is_reported; k++) {
            const unsigned at = (from + k) % report->num_tracks;
            is_reported = report->tracks[at].track_id == visitor->track_id;
            from = is_reported ? at + 1u : from;
        }
        if (!is_reported) {
            end_visits(zones, visitor);
        } else if (visitor->inside != 0) {
            if (kept < i) {
                zones->visitors[kept] = *visitor;
            }
            kept++;
        }
    }
    zones->num_visitors = (uint16_t)kept;
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
            end_visits(zones, &zones->visitors[i]);
        }
        zones->num_visitors = 0;
    }
    zones->time_us = report->time_us;
    remove_gone_visitors(zones, report);
    /* all zones by each track, in the order of the report, and then the zones' counts */
    struct occupants occupants_of[RHO_ZONE_PLACES] = {{0}};
    unsigned from = 0;
    for (unsigned i = 0; i < report->num_tracks; i++) {
        const struct rho_track_report *track = &report->tracks[i];
        const float x_m = track->state[RHO_X], y_m = track->state[RHO_Y];
        const float vx_mps = track->state[RHO_VX], vy_mps = track->state[RHO_VY];
        struct rho_zone_visitor *visitor = NULL;
        for (unsigned k = 0; k < zones->num_visitors && !visitor; k++) {
            const unsigned at = (from + k) % zones->num_visitors;
            if (zones->visitors[at].track_id == track->track_id) {
                from = at + 1u;
                visitor = &zones->visitors[at];
            }
        }
        if (!visitor) { /* the first free one, prepared for a track that is in no zone yet */
            visitor = &zones->visitors[zones->num_visitors];
            visitor->track_id = track->track_id;
            visitor->inside = visitor->queued = 0;
        }
        visitor->speed_mps = rho_sqrt(vx_mps * vx_mps + vy_mps * vy_mps);
        for (unsigned place = 0; place < zones->num_zones; place++) {
            if ((visitor->inside >> place & 1u) ||
                rho_extent_holds(&zones->bounds[place], x_m, y_m)) {
                update_zone(zones, visitor, place, track, &occupants_of[place]);
            }
        }
        if (visitor->inside != 0 && visitor == &zones->visitors[zones->num_visitors]) {
            zones->num_visitors++;
        }
    }
    for (unsigned place = 0; place < zones->num_zones; place++) {
        const struct occupants *occupants = &occupants_of[place];
        struct rho_zone_counts *counts = &zones->counts[place];
        const float x_m = occupants->max_m[0] - occupants->min_m[0],
                    y_m = occupants->max_m[1] - occupants->min_m[1];
        counts->inside = (uint16_t)occupants->inside;
        counts->queued = (uint16_t)occupants->queued;
        counts->queue_m = rho_sqrt(x_m * x_m + y_m * y_m);
        counts->speed_mps =
            occupants->inside > 0 ? occupants->speed_sum_mps / (float)occupants->inside : 0.0f;
    }
    return RHO_OK;
}

const char *rho_zone_change_name(enum rho_zone_change change)
{
    static const char names[RHO_NUM_ZONE_CHANGES][7] = {
        [RHO_ZONE_ENTERS] = "enters", [RHO_ZONE_LEAVES] = "leaves", [RHO_ZONE_ENDS] = "ends"};
    return (unsigned)change < RHO_NUM_ZONE_CHANGES ? names[change] : "unknown";
}
