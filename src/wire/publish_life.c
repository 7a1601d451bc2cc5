/* SPDX-License-Identifier: MIT */
/* publish_life: messages of the lives of tracks: learned rates, and each track's probabilities. */
#include "message_clamps.h"
#include "rhotrack/publish.h"

enum rho_status rho_publish_life(const struct rho_tracker *tracker, int32_t step, int32_t epoch,
                                 uint16_t part, uint8_t *buffer, size_t capacity, size_t *size)
{
    if (!tracker || !buffer || !size) {
        return RHO_ERROR_NULL;
    }
    const unsigned most = RHO_MESSAGE_LIFE_MAX_TRACKS;
    const unsigned num_parts = rho_num_parts(tracker->num_tracks, most);
    if (part >= num_parts) {
        return RHO_ERROR_VALUE;
    }
    const struct rho_tracker_life life = rho_tracker_life(tracker);
    const struct rho_message_life_head head = {.utime = tracker->time_us,
                                               .scan = step,
                                               .epoch = epoch,
                                               .death_rate = life.death,
                                               .hide_rate = life.hide,
                                               .appear_rate = life.appear,
                                               .lived_scans = life.lived_scans,
                                               .num_tracks_total = (int16_t)tracker->num_tracks,
                                               .part = (int16_t)part,
                                               .num_parts = (int16_t)num_parts};
    struct rho_message_writer writer;
    enum rho_status status = rho_message_life_begin(&writer, buffer, capacity, &head);
    for (unsigned i = part * most;
         i < tracker->num_tracks && i < (part + 1u) * most && status == RHO_OK; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        const int32_t id = (int32_t)(track->track_id & INT32_MAX);
        const struct rho_message_track_life message = {id, rho_track_existence(track),
                                                       track->visible};
        status = rho_message_life_add(&writer, &message);
    }
    return status == RHO_OK ? rho_message_end(&writer, size) : status;
}
