/* SPDX-License-Identifier: MIT */
/* show_writers: the messages of each kind, which are numbered from 0 in a step. */
#ifndef RHOTRACK_SHOW_WRITERS_H
#define RHOTRACK_SHOW_WRITERS_H

#include "rhotrack/publish.h"

/* A message that is written. Writers begin it, and rho_show_next ends it where they return OK. */
struct rho_show_output {
    uint8_t *buffer;
    size_t capacity;
    int32_t not_sent; /* messages of its kind that were left out so far */
    struct rho_message_writer writer;
    const char *channel;
};

/* show_ghosts.c: messages of the ghost matrices of the newest frame */
uint32_t rho_show_count_ghosts(const struct rho_show_source *source);
enum rho_status rho_show_write_ghosts(const struct rho_show_source *source, uint32_t number,
                                      struct rho_show_output *output);

/* show_accumulators.c: messages of accumulators; an accumulator's first one makes its picture */
uint32_t rho_show_count_accumulators(const struct rho_show *show,
                                     const struct rho_show_source *source);
enum rho_status rho_show_write_accumulator(struct rho_show *show,
                                           const struct rho_show_source *source, uint32_t number,
                                           struct rho_show_output *output);

/* show_hypotheses.c: the message of a track's hypotheses; track: its row in the tracker */
enum rho_status rho_show_write_hypotheses(const struct rho_show_source *source, unsigned track,
                                          struct rho_show_output *output);

#endif
