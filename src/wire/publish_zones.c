/* SPDX-License-Identifier: MIT */
/* publish_zones: messages of the zones' counts and events. */
#include "message_clamps.h"
#include "rhotrack/publish.h"

void rho_publish_zones(const struct rho_zones *zones, struct rho_message_zone_list *list)
{
    if (!list) {
        return;
    }
    list->utime = zones ? zones->time_us : 0;
    list->scan = list->epoch = 0;
    list->events_dropped = zones ? rho_clamp_to_int32(zones->events_dropped) : 0;
    list->num_zones = zones ? (int16_t)zones->num_zones : 0;
    for (int i = 0; i < list->num_zones; i++) {
        const struct rho_zone_counts *counts = &zones->counts[i];
        list->zones[i] = (struct rho_message_zone){
            .zone_id = zones->zones[i].zone_id,
            .inside = (int16_t)counts->inside,
            .queued = (int16_t)counts->queued,
            .entered = rho_clamp_to_int32(counts->entered),
            .left = rho_clamp_to_int32(counts->left),
            .ended = rho_clamp_to_int32(counts->ended),
            .along = rho_clamp_to_int32(counts->along),
            .against = rho_clamp_to_int32(counts->against),
            .speed_mps = counts->speed_mps,
            .queue_m = counts->queue_m,
            .dwell_mean_s = counts->dwell_mean_s,
            .dwell_max_s = counts->dwell_max_s,
        };
    }
}

void rho_publish_zone_events(const struct rho_zones *zones,
                             struct rho_message_zone_event_list *list)
{
    if (!list) {
        return;
    }
    list->utime = zones ? zones->time_us : 0;
    list->scan = list->epoch = 0;
    list->num_events = zones ? (int16_t)zones->num_events : 0;
    for (int i = 0; i < list->num_events; i++) {
        const struct rho_zone_event *event = &zones->events[i];
        list->events[i] = (struct rho_message_zone_event){
            .zone_id = event->zone_id,
            .track_id = (int32_t)event->track_id,
            .change = (int8_t)event->change,
            .direction = event->direction,
            .speed_mps = event->speed_mps,
            .dwell_s = event->dwell_s,
        };
    }
}
