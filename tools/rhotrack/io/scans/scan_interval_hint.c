/* SPDX-License-Identifier: MIT */
#include "io/scans/scan_interval_hint.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/common.h"
#include "rhotrack/message.h"

#define SOON_US 1000000 /* shorter than a turn of any antenna */
#define LONE_LEAST 10   /* fewest lone scans that are reported of a file */
#define LIVE_LEAST 20   /* fewest scans of a live sensor before it is reported */
#define IRREGULAR 3     /* least ratio of the longest to the shortest interval */

struct lone_scan_counts {
    int16_t sensor_id;
    int64_t last_us; /* time of the sensor's newest scan */
    uint64_t scans, lone;
    int64_t shortest_us, longest_us; /* intervals before lone scans */
    bool is_said;
};

/* Summary of a scan message, by which a scan counts as lone. */
struct scan_summary {
    int16_t sensor_id, num_parts, num_plots;
    bool has_sector;
    int64_t time_us;
};

static bool summarise_first_part(const struct message_event *event, struct scan_summary *summary)
{
    static _Thread_local struct rho_message_plot_scan plots;
    static _Thread_local struct rho_message_polar_scan polar;

    if (text_begins_with(event->channel, RHO_MESSAGE_POLAR_SCAN_CHANNEL) &&
        rho_message_polar_scan_decode(event->data, event->size, &polar) == RHO_OK) {
        *summary = (struct scan_summary){
            polar.sensor_id, polar.num_parts, polar.num_polar_plots,
            polar.sector_from_rad != 0.0f || polar.sector_to_rad != 0.0f, polar.utime};
        return polar.part == 0;
    }
    if (text_begins_with(event->channel, RHO_MESSAGE_PLOT_SCAN_CHANNEL) &&
        rho_message_plot_scan_decode(event->data, event->size, &plots) == RHO_OK) {
        *summary = (struct scan_summary){
            plots.sensor_id, plots.num_parts, plots.num_plots,
            plots.sector_from_rad != 0.0f || plots.sector_to_rad != 0.0f, plots.utime};
        return plots.part == 0;
    }
    return false;
}

/* The sensor's counts, or NULL where it has no scan yet. */
static struct lone_scan_counts *find_counts_of_known_sensor(const struct scan_interval_hint *plots,
                                                            int16_t sensor_id)
{
    for (size_t i = 0; i < plots->count; i++) {
        if (plots->sensors[i].sensor_id == sensor_id) {
            return &plots->sensors[i];
        }
    }
    return NULL;
}

void scan_interval_hint_count(struct scan_interval_hint *plots, const struct message_event *event)
{
    struct lone_scan_counts *sensor;
    struct scan_summary summary;

    if (!summarise_first_part(event, &summary)) {
        return;
    }
    plots->scans++;
    sensor = find_counts_of_known_sensor(plots, summary.sensor_id);
    if (sensor) {
        const int64_t since_us = summary.time_us - sensor->last_us;

        if (summary.num_parts == 1 && summary.num_plots == 1 && !summary.has_sector &&
            since_us < SOON_US) {
            plots->lone++;
            sensor->lone++;
            sensor->shortest_us = since_us < sensor->shortest_us ? since_us : sensor->shortest_us;
            sensor->longest_us = since_us > sensor->longest_us ? since_us : sensor->longest_us;
        }
    } else {
        plots->sensors = must_make_room_for_one(plots->sensors, plots->count, &plots->capacity,
                                                sizeof *plots->sensors);
        sensor = &plots->sensors[plots->count++];
        *sensor = (struct lone_scan_counts){.sensor_id = summary.sensor_id, .shortest_us = SOON_US};
    }
    sensor->scans++;
    sensor->last_us = summary.time_us;
}

void scan_interval_hint_report(const struct scan_interval_hint *plots, const char *path)
{
    if (plots->lone >= LONE_LEAST && plots->lone > plots->scans / 2) {
        fprintf(stderr,
                "rhotrack: %s: %" PRIu64 " of %" PRIu64
                " scans have one plot each: set scan_interval_s if they are parts of one scan\n",
                path, plots->lone, plots->scans);
    }
}

void scan_interval_hint_report_lone(struct scan_interval_hint *plots)
{
    for (size_t i = 0; i < plots->count; i++) {
        struct lone_scan_counts *sensor = &plots->sensors[i];

        if (!sensor->is_said && sensor->scans >= LIVE_LEAST && sensor->lone > sensor->scans / 2 &&
            sensor->longest_us > IRREGULAR * sensor->shortest_us) {
            sensor->is_said = true;
            fprintf(stderr,
                    "rhotrack: sensor %d: %" PRIu64 " of %" PRIu64
                    " scans have one plot each: send a turn as one scan (publish: "
                    "scan_interval_s)\n",
                    sensor->sensor_id, sensor->lone, sensor->scans);
        }
    }
}

void scan_interval_hint_free(struct scan_interval_hint *plots)
{
    free(plots->sensors);
    *plots = (struct scan_interval_hint){.scans = 0};
}
