/* SPDX-License-Identifier: MIT */
/*
 * pipeline_show: messages of the option --show: ghost matrices,
 * accumulators and hypotheses of steps.
 */
#ifndef RHOTRACK_TOOL_PIPELINE_SHOW_H
#define RHOTRACK_TOOL_PIPELINE_SHOW_H

#include <stdbool.h>
#include <stdint.h>

#include "pipeline/pipeline.h"

struct pipeline_show;

/* Callback that gets the messages. */
struct pipeline_show_output {
    void *context;
    void (*send)(void *context, const char *channel, const uint8_t *data, size_t size);
};

/*
 * Parses the kinds of --show, "ghosts,votes,hypotheses" or some of them; NULL returns NULL. Exit 2
 * for an unknown kind, or one that none of the chosen methods has.
 */
struct pipeline_show *pipeline_show_open(const char *kinds, const struct parameters *parameters);

/*
 * Sends the messages of a step, after the tracks that it started; is_frame: a step of bearings.
 * Does nothing for show NULL.
 *   now_us  clock of the rate limits
 */
void pipeline_show_step(struct pipeline_show *show, struct pipeline *pipeline, bool is_frame,
                        int32_t step, int32_t epoch, int64_t now_us,
                        const struct pipeline_show_output *output);

/* Number of messages so far that the rate limits left out. */
uint64_t pipeline_show_num_not_sent(const struct pipeline_show *show);

void pipeline_show_close(struct pipeline_show *show);

#endif
