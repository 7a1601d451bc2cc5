/* SPDX-License-Identifier: MIT */
#include "io/output/zone_output.h"

#include <inttypes.h>

struct zone_events_output zone_events_output_open(const char *path)
{
    struct zone_events_output output = {.output = {NULL, NULL, NULL}};

    if (path) {
        output.output = output_open(path);
        fputs("t_s,zone_id,track_id,change,direction,speed_mps,dwell_s\n", output.output.file);
    }
    return output;
}

void zone_events_output_write(const struct zone_events_output *output,
                              const struct rho_zones *zones)
{
    for (unsigned i = 0; output->output.file && i < zones->num_events; i++) {
        const struct rho_zone_event *event = &zones->events[i];

        fprintf(output->output.file, "%.6f,%" PRId32 ",%" PRIu32 ",%s,%d,%.9g,",
                (double)zones->time_us / 1e6, event->zone_id, event->track_id,
                rho_zone_change_name((enum rho_zone_change)event->change), event->direction,
                (double)event->speed_mps);
        fprintf(output->output.file, event->change == RHO_ZONE_ENTERS ? "\n" : "%.6g\n",
                (double)event->dwell_s);
    }
}

void zone_events_output_close(struct zone_events_output *output)
{
    if (output->output.file) {
        output_close(&output->output);
    }
}

void zones_print_counts(const struct rho_zones *zones)
{
    for (unsigned i = 0; i < zones->num_zones; i++) {
        const struct rho_zone_counts *counts = &zones->counts[i];

        fprintf(stderr, "zone %" PRId32 ": %" PRIu32 " entered, %" PRIu32 " left",
                zones->zones[i].zone_id, counts->entered, counts->left);
        if (zones->zones[i].has_heading) {
            fprintf(stderr, " (%" PRIu32 " along, %" PRIu32 " against)", counts->along,
                    counts->against);
        }
        fprintf(stderr,
                ", %" PRIu32 " ended inside; %u inside, %u queued; dwell %.3g s, %.3g at most\n",
                counts->ended, counts->inside, counts->queued, (double)counts->dwell_mean_s,
                (double)counts->dwell_max_s);
    }
    if (zones->events_dropped > 0) {
        fprintf(stderr, "zones: %" PRIu32 " events had no room\n", zones->events_dropped);
    }
}

cJSON *zones_counts_json(const struct rho_zones *zones)
{
    cJSON *list = cJSON_CreateArray();

    for (unsigned i = 0; i < zones->num_zones; i++) {
        const struct rho_zone_counts *counts = &zones->counts[i];
        cJSON *object = cJSON_CreateObject();

        cJSON_AddNumberToObject(object, "zone_id", zones->zones[i].zone_id);
        cJSON_AddNumberToObject(object, "entered", counts->entered);
        cJSON_AddNumberToObject(object, "left", counts->left);
        cJSON_AddNumberToObject(object, "ended", counts->ended);
        cJSON_AddNumberToObject(object, "along", counts->along);
        cJSON_AddNumberToObject(object, "against", counts->against);
        cJSON_AddNumberToObject(object, "inside", counts->inside);
        cJSON_AddNumberToObject(object, "queued", counts->queued);
        cJSON_AddNumberToObject(object, "queue_m", (double)counts->queue_m);
        cJSON_AddNumberToObject(object, "speed_mps", (double)counts->speed_mps);
        cJSON_AddNumberToObject(object, "dwell_mean_s", (double)counts->dwell_mean_s);
        cJSON_AddNumberToObject(object, "dwell_max_s", (double)counts->dwell_max_s);
        cJSON_AddItemToArray(list, object);
    }
    return list;
}
