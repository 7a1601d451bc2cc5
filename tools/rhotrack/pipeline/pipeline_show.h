/* SPDX-License-Identifier: MIT */
/* pipeline_show: what a pipeline's steps thought, as messages: the option --show. */
#ifndef RHOTRACK_TOOL_PIPELINE_SHOW_H
#define RHOTRACK_TOOL_PIPELINE_SHOW_H

#include <stdbool.h>
#include <stdint.h>

#include "pipeline/pipeline.h"

struct pipeline_show;

/* Where messages go. */
struct pipeline_show_output {
    void *context;
    void (*send)(void *context, const char *channel, const uint8_t *data, size_t size);
};

/*
 * kinds: "ghosts,votes,hypotheses", or some of these; NULL: nothing is shown, returns NULL. A word
 * that is none of these, or a kind that no method of the parameters has: exit 2.
 */
struct pipeline_show *pipeline_show_open(const char *kinds, const struct parameters *parameters);

/*
 * After a step and the tracks that it started; a step of bearings is_frame. NULL: nothing.
 *   now_us  clock of the rates
 */
void pipeline_show_step(struct pipeline_show *show, struct pipeline *pipeline, bool is_frame,
                        int32_t step, int32_t epoch, int64_t now_us,
                        const struct pipeline_show_output *output);

/* Messages of all kinds that their rates have left out so far. */
uint64_t pipeline_show_not_sent(const struct pipeline_show *show);

void pipeline_show_close(struct pipeline_show *show);

#endif
