/* SPDX-License-Identifier: MIT */
/* step_looks: the looks of a frame of bearings, stepped one after the other. */
#ifndef STEP_LOOKS_H
#define STEP_LOOKS_H

#include <string.h>

#include "rhotrack/paper_starts.h"
#include "rhotrack/tracker.h"

static inline int64_t time_of_look(const struct rho_frame *frame, uint32_t i)
{
    return frame->scans[i].time_us != 0 ? frame->scans[i].time_us : frame->time_us;
}

/* Place of look i of a frame in the order of time. */
static inline uint32_t turn_of_look(const struct rho_frame *frame, uint32_t i)
{
    uint32_t turn = 0;
    for (uint32_t k = 0; k < frame->num_scans; k++) {
        const int64_t other_us = time_of_look(frame, k), own_us = time_of_look(frame, i);
        turn += other_us < own_us || (other_us == own_us && k < i);
    }
    return turn;
}

/*
 * Steps all scans of a frame in the order of time, those without a time at the frame's. *report is
 * then the last one's, with the fates of all bearings in the frame's order, and all ended tracks.
 * Stops at an error, and returns it. paper: starts tracks, too; NULL: none.
 */
static inline enum rho_status step_looks(struct rho_tracker *of, struct rho_passive *starts,
                                         struct rho_passive_paper *paper,
                                         const struct rho_frame *frame, struct rho_report *to)
{
    static struct rho_report all; /* too large for a stack */
    all.num_ended = 0;
    memset(all.fates_total, 0, sizeof all.fates_total);
    for (uint32_t turn = 0; turn < frame->num_scans; turn++) {
        uint32_t i = 0, first = 0;
        while (turn_of_look(frame, i) != turn) {
            first += frame->scans[i++].num_bearings;
        }
        struct rho_bearing_scan look = frame->scans[i];
        look.time_us = time_of_look(frame, i);
        enum rho_status status = rho_tracker_step_bearings(of, starts, &look, to);
        if (status == RHO_OK && paper) {
            status = rho_passive_paper_step(paper, of, &look, to);
        }
        if (status != RHO_OK) {
            return status;
        }
        for (uint32_t k = 0; k < to->num_plots && first + k < RHO_MAX_PLOTS; k++) {
            all.fates[first + k] = to->fates[k];
        }
        for (unsigned k = 0; k < RHO_NUM_FATES; k++) {
            all.fates_total[k] += to->fates_total[k];
        }
        for (unsigned k = 0; k < to->num_ended && all.num_ended < RHO_MAX_TRACKS; k++) {
            all.ended[all.num_ended++] = to->ended[k];
        }
    }
    to->num_plots = 0;
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        to->num_plots += frame->scans[i].num_bearings;
    }
    to->num_ended = all.num_ended;
    memcpy(to->ended, all.ended, sizeof to->ended);
    memcpy(to->fates, all.fates, sizeof to->fates);
    memcpy(to->fates_total, all.fates_total, sizeof to->fates_total);
    return RHO_OK;
}

#endif
