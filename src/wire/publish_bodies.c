/* SPDX-License-Identifier: MIT */
/* publish_bodies: messages of the bodies (extents) of the tracks. */
#include "message_clamps.h"
#include "rhotrack/publish.h"

#define PART_BODIES RHO_MESSAGE_BODY_LIST_MAX_BODIES

uint16_t rho_publish_num_body_parts(const struct rho_tracker *tracker,
                                    const struct rho_report *report)
{
    unsigned count = 0;
    if (!RHO_BODIES || !tracker || !report || !(tracker->bodies.length_max_m > 0.0f)) {
        return 0;
    }
    for (unsigned i = 0; i < report->num_tracks; i++) {
        count += !report->tracks[i].is_in_doubt && rho_tracker_has_body(tracker, i) ? 1 : 0;
    }
    return (uint16_t)rho_num_parts(count, PART_BODIES);
}

enum rho_status rho_publish_bodies(const struct rho_tracker *tracker,
                                   const struct rho_report *report, int32_t step, int32_t epoch,
                                   uint16_t part, uint8_t *buffer, size_t capacity, size_t *size)
{
    if (!tracker || !report || !buffer || !size) {
        return RHO_ERROR_NULL;
    }
    const uint16_t num_parts = rho_publish_num_body_parts(tracker, report);
    if (part >= num_parts) {
        return RHO_ERROR_VALUE;
    }
    const struct rho_message_body_list_head head = {.utime = report->time_us,
                                                    .scan = step,
                                                    .epoch = epoch,
                                                    .part = (int16_t)part,
                                                    .num_parts = (int16_t)num_parts};
    struct rho_message_writer writer;
    struct rho_body body;
    enum rho_status status = rho_message_body_list_begin(&writer, buffer, capacity, &head);
    unsigned place = 0;
    for (unsigned i = 0; i < report->num_tracks && status == RHO_OK; i++) {
        const struct rho_track_report *track = &report->tracks[i];
        if (track->is_in_doubt || !rho_tracker_has_body(tracker, i) ||
            place++ / PART_BODIES != part || !rho_tracker_body_of(tracker, i, &body)) {
            continue;
        }
        /* The track's position stands for the body's centre: plots of it do not tell it apart. */
        const struct rho_message_body message = {
            .track_id = (int32_t)(track->track_id & INT32_MAX),
            .x_m = track->state[RHO_X],
            .y_m = track->state[RHO_Y],
            .reference_x_m = track->state[RHO_X],
            .reference_y_m = track->state[RHO_Y],
            .length_m = body.length_m,
            .width_m = body.width_m,
            .heading_rad = body.heading_rad,
            .sigma_length_m = body.sigma_length_m,
            .sigma_width_m = body.sigma_width_m,
            .sigma_heading_rad = body.sigma_heading_rad,
            .sigma_along_m = body.sigma_along_m,
            .sigma_across_m = body.sigma_across_m,
            .plots = body.plots,
        };
        status = rho_message_body_list_add(&writer, &message);
    }
    return status == RHO_OK ? rho_message_end(&writer, size) : status;
}
