/* SPDX-License-Identifier: MIT */
/*
 * zones_count_tracks: counts the tracks that enter, stay in and leave polygons on the ground.
 */
#include "rhotrack/zones.h"

#include <string.h>

#include "rhotrack/detail/approx.h"
#include "rhotrack/types.h"

#define ZONES_MAGIC 0x5a4f4e45u

/* Speed at which a track leaves a queue, over the speed below which it joins it. */
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

/* A side of a polygon: from a corner to the next corner. */
struct zone_side {
    float x_m, y_m, to_x_m, to_y_m;
};

static struct zone_side side_of_zone(const struct rho_zone *zone, unsigned i)
{
    const unsigned next = i + 1u < zone->num_corners ? i + 1u : 0;
    return (struct zone_side){zone->x_m[i], zone->y_m[i], zone->x_m[next], zone->y_m[next]};
}

static int has_nonzero_area(const struct rho_zone *zone)
{
    float twice_m2 = 0.0f;
    for (unsigned i = 0; i < zone->num_corners; i++) {
        const struct zone_side side = side_of_zone(zone, i);
        twice_m2 += (side.x_m - zone->x_m[0]) * (side.to_y_m - zone->y_m[0]) -
                    (side.to_x_m - zone->x_m[0]) * (side.y_m - zone->y_m[0]);
    }
    return twice_m2 > 0.0f || twice_m2 < 0.0f;
}

static int is_usable_zone(const struct rho_zone *zone)
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
    return has_nonzero_area(zone);
}

static struct rho_extent bounds_with_margin(const struct rho_zone *zone)
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
    if (!is_usable_zone(zone)) {
        return RHO_ERROR_VALUE;
    }
    for (unsigned i = 0; i < zones->num_zones; i++) {
        if (zones->zones[i].zone_id == zone->zone_id) {
            return RHO_ERROR_VALUE;
        }
    }
    zones->bounds[zones->num_zones] = bounds_with_margin(zone);
    zones->zones[zones->num_zones++] = *zone;
    return RHO_OK;
}

/* ---- places ---------------------------------------------------------------------------------- */

static int is_within_bounds(const struct rho_extent *bounds, float x_m, float y_m)
{
    return x_m >= bounds->x_min_m && x_m <= bounds->x_max_m && y_m >= bounds->y_min_m &&
           y_m <= bounds->y_max_m;
}

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

static float distance2_to_side(const struct zone_side *side, float x_m, float y_m)
{
    const float along_x_m = side->to_x_m - side->x_m, along_y_m = side->to_y_m - side->y_m;
    const float off_x_m = x_m - side->x_m, off_y_m = y_m - side->y_m;
    const float length2_m2 = along_x_m * along_x_m + along_y_m * along_y_m;
    float share = off_x_m * along_x_m + off_y_m * along_y_m;
    share = share <= 0.0f ? 0.0f : share >= length2_m2 ? 1.0f : share / length2_m2;
    const float left_x_m = off_x_m - share * along_x_m, left_y_m = off_y_m - share * along_y_m;
    return left_x_m * left_x_m + left_y_m * left_y_m;
}

static int is_within_margin_of_border(const struct rho_zone *zone, float x_m, float y_m)
{
    int is_within = 0;
    for (unsigned i = 0; i < zone->num_corners && !is_within; i++) {
        const struct zone_side side = side_of_zone(zone, i);
        is_within = distance2_to_side(&side, x_m, y_m) <= zone->margin_m * zone->margin_m;
    }
    return is_within;
}

/* ---- events ---------------------------------------------------------------------------------- */

/* The values of a reported track that zones use. */
struct zone_track {
    uint32_t track_id;
    float x_m, y_m, vx_mps, vy_mps, speed_mps;
    int is_believed; /* 1: the track is confirmed, and may enter zones */
};

static struct zone_track zone_track_from_report(const struct rho_track_report *track)
{
    const float vx_mps = track->state[RHO_VX], vy_mps = track->state[RHO_VY];
    return (struct zone_track){.track_id = track->track_id,
                               .x_m = track->state[RHO_X],
                               .y_m = track->state[RHO_Y],
                               .vx_mps = vx_mps,
                               .vy_mps = vy_mps,
                               .speed_mps = rho_sqrt(vx_mps * vx_mps + vy_mps * vy_mps),
                               .is_believed = track->status == RHO_TRACK_CONFIRMED};
}

/*
 * 1 where a track moves along the zone's heading, -1 against it, 0 where it is slow or there is
 * none.
 */
static int8_t direction_along_lane(const struct rho_zone *zone, const struct zone_track *track)
{
    if (!zone->has_heading || !(track->speed_mps > zone->queue_mps)) {
        return 0;
    }
    const float along_mps =
        track->vx_mps * rho_cos(zone->heading_rad) + track->vy_mps * rho_sin(zone->heading_rad);
    return (int8_t)(along_mps > 0.0f ? 1 : along_mps < 0.0f ? -1 : 0);
}

static void add_zone_event(struct rho_zones *zones, const struct rho_zone_event *event)
{
    if (zones->num_events < RHO_ZONE_EVENTS) {
        zones->events[zones->num_events++] = *event;
    } else {
        zones->events_dropped = rho_count(zones->events_dropped, 1);
    }
}

static void enter_zone(struct rho_zones *zones, struct rho_zone_visitor *visitor, unsigned place,
                       const struct zone_track *track)
{
    visitor->inside |= 1u << place;
    visitor->since_us[place] = zones->time_us;
    zones->counts[place].entered = rho_count(zones->counts[place].entered, 1);
    add_zone_event(zones, &(struct rho_zone_event){
                              .zone_id = zones->zones[place].zone_id,
                              .track_id = track->track_id,
                              .change = RHO_ZONE_ENTERS,
                              .direction = direction_along_lane(&zones->zones[place], track),
                              .speed_mps = track->speed_mps,
                          });
}

static void leave_zone(struct rho_zones *zones, struct rho_zone_visitor *visitor, unsigned place,
                       const struct zone_track *track)
{
    struct rho_zone_counts *counts = &zones->counts[place];
    const float dwell_s = rho_seconds_between(visitor->since_us[place], zones->time_us);
    const int8_t direction = direction_along_lane(&zones->zones[place], track);
    visitor->inside &= ~(1u << place);
    visitor->queued &= ~(1u << place);
    counts->left = rho_count(counts->left, 1);
    counts->along = rho_count(counts->along, direction > 0);
    counts->against = rho_count(counts->against, direction < 0);
    counts->dwell_mean_s += (dwell_s - counts->dwell_mean_s) / (float)counts->left;
    counts->dwell_max_s = dwell_s > counts->dwell_max_s ? dwell_s : counts->dwell_max_s;
    add_zone_event(zones, &(struct rho_zone_event){.zone_id = zones->zones[place].zone_id,
                                                   .track_id = track->track_id,
                                                   .change = RHO_ZONE_LEAVES,
                                                   .direction = direction,
                                                   .speed_mps = track->speed_mps,
                                                   .dwell_s = dwell_s});
}

/* Counts a track that is no longer reported as ended, in each zone that it was in. */
static void end_visits_of_track(struct rho_zones *zones, const struct rho_zone_visitor *visitor)
{
    for (unsigned place = 0; place < zones->num_zones; place++) {
        if (visitor->inside >> place & 1u) {
            zones->counts[place].ended = rho_count(zones->counts[place].ended, 1);
            add_zone_event(zones,
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

/* The tracks in a zone, and the extent of the queued tracks: along the lane, or in x and y. */
struct occupants {
    unsigned inside, queued;
    float speed_sum_mps;
    float min_m[2], max_m[2];
};

static void count_queued_track_and_widen_queue(struct occupants *occupants,
                                               const struct rho_zone *zone,
                                               const struct zone_track *track)
{
    float at_m[2] = {track->x_m, track->y_m};
    if (zone->has_heading) {
        at_m[0] = track->x_m * rho_cos(zone->heading_rad) + track->y_m * rho_sin(zone->heading_rad);
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

static void set_current_counts(struct rho_zone_counts *counts, const struct occupants *occupants)
{
    const float x_m = occupants->max_m[0] - occupants->min_m[0],
                y_m = occupants->max_m[1] - occupants->min_m[1];
    counts->inside = (uint16_t)occupants->inside;
    counts->queued = (uint16_t)occupants->queued;
    counts->queue_m = rho_sqrt(x_m * x_m + y_m * y_m);
    counts->speed_mps =
        occupants->inside > 0 ? occupants->speed_sum_mps / (float)occupants->inside : 0.0f;
}

/* Counts a track in a zone, and lets it join or leave the zone's queue by its speed. */
static void count_occupant_and_join_or_leave_traffic_queue(struct occupants *occupants,
                                                           const struct rho_zone *zone,
                                                           unsigned place,
                                                           struct rho_zone_visitor *visitor,
                                                           const struct zone_track *track)
{
    const uint32_t bit = (uint32_t)1 << place;
    const float limit_mps = (visitor->queued & bit ? QUEUE_LEFT : 1.0f) * zone->queue_mps;
    occupants->inside++;
    occupants->speed_sum_mps += track->speed_mps;
    if (track->speed_mps < limit_mps) {
        visitor->queued |= bit;
        count_queued_track_and_widen_queue(occupants, zone, track);
    } else {
        visitor->queued &= ~bit;
    }
}

static void update_track_in_zone(struct rho_zones *zones, struct rho_zone_visitor *visitor,
                                 unsigned place, const struct zone_track *track,
                                 struct occupants *occupants)
{
    const struct rho_zone *zone = &zones->zones[place];
    const int was_inside = (int)(visitor->inside >> place & 1u);
    const int inside = is_inside_polygon(zone, track->x_m, track->y_m);
    if (!was_inside && inside && track->is_believed) {
        enter_zone(zones, visitor, place, track);
    } else if (was_inside && !inside && !is_within_margin_of_border(zone, track->x_m, track->y_m)) {
        leave_zone(zones, visitor, place, track);
    }
    if (visitor->inside >> place & 1u) {
        count_occupant_and_join_or_leave_traffic_queue(occupants, zone, place, visitor, track);
    }
}

static const struct rho_track_report *find_track_report(const struct rho_report *report,
                                                        uint32_t track_id, unsigned *search_from)
{
    for (unsigned i = 0; i < report->num_tracks; i++) {
        const unsigned at = (*search_from + i) % report->num_tracks;
        if (report->tracks[at].track_id == track_id) {
            *search_from = at + 1u;
            return &report->tracks[at];
        }
    }
    return NULL;
}

/* Removes visitors whose track has ended, with an event, or is in no zone any more. */
static void remove_gone_visitors(struct rho_zones *zones, const struct rho_report *report)
{
    unsigned kept = 0, from = 0;
    for (unsigned i = 0; i < zones->num_visitors; i++) {
        const struct rho_zone_visitor *visitor = &zones->visitors[i];
        if (!find_track_report(report, visitor->track_id, &from)) {
            end_visits_of_track(zones, visitor);
        } else if (visitor->inside != 0) {
            if (kept < i) {
                zones->visitors[kept] = *visitor;
            }
            kept++;
        }
    }
    zones->num_visitors = (uint16_t)kept;
}

/* The track's visitor, or the first free one, prepared for a track that is in no zone yet. */
static struct rho_zone_visitor *find_or_prepare_visitor(struct rho_zones *zones, uint32_t track_id,
                                                        unsigned *search_from)
{
    struct rho_zone_visitor *next = &zones->visitors[zones->num_visitors];
    for (unsigned i = 0; i < zones->num_visitors; i++) {
        const unsigned at = (*search_from + i) % zones->num_visitors;
        if (zones->visitors[at].track_id == track_id) {
            *search_from = at + 1u;
            return &zones->visitors[at];
        }
    }
    next->track_id = track_id;
    next->inside = next->queued = 0;
    return next;
}

/* Updates all zones by each track, in the order of the report, and then the zones' counts. */
static void update_tracks_in_zones(struct rho_zones *zones, const struct rho_report *report)
{
    struct occupants occupants_of[RHO_MAX_ZONES] = {{0}};
    unsigned from = 0;
    for (unsigned i = 0; i < report->num_tracks; i++) {
        const struct zone_track track = zone_track_from_report(&report->tracks[i]);
        struct rho_zone_visitor *visitor = find_or_prepare_visitor(zones, track.track_id, &from);
        for (unsigned place = 0; place < zones->num_zones; place++) {
            if ((visitor->inside >> place & 1u) ||
                is_within_bounds(&zones->bounds[place], track.x_m, track.y_m)) {
                update_track_in_zone(zones, visitor, place, &track, &occupants_of[place]);
            }
        }
        visitor->speed_mps = track.speed_mps;
        if (visitor->inside != 0 && visitor == &zones->visitors[zones->num_visitors]) {
            zones->num_visitors++;
        }
    }
    for (unsigned place = 0; place < zones->num_zones; place++) {
        set_current_counts(&zones->counts[place], &occupants_of[place]);
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
            end_visits_of_track(zones, &zones->visitors[i]);
        }
        zones->num_visitors = 0;
    }
    zones->time_us = report->time_us;
    remove_gone_visitors(zones, report);
    update_tracks_in_zones(zones, report);
    return RHO_OK;
}

const char *rho_zone_change_name(enum rho_zone_change change)
{
    static const char names[RHO_NUM_ZONE_CHANGES][7] = {
        [RHO_ZONE_ENTERS] = "enters", [RHO_ZONE_LEAVES] = "leaves", [RHO_ZONE_ENDS] = "ends"};
    return (unsigned)change < RHO_NUM_ZONE_CHANGES ? names[change] : "unknown";
}
