/* SPDX-License-Identifier: MIT */
/*
 * show_parts: the messages of each kind, as show.c asks for them. Messages of a step are numbered
 * from 0; not_sent goes into them.
 */
#ifndef RHOTRACK_SHOW_PARTS_H
#define RHOTRACK_SHOW_PARTS_H

#include "rhotrack/publish.h"

/* One message: where it goes. */
struct rho_show_output {
    uint8_t *buffer;
    size_t capacity;
    size_t *size;
    int32_t not_sent;
};

/* show_ghosts.c */
uint32_t rho_show_num_ghosts(const struct rho_show_source *source);
const char *rho_show_write_ghosts(const struct rho_show_source *source, uint32_t number,
                                  const struct rho_show_output *output);

/* show_votes.c: the first message of a plane makes its picture. */
uint32_t rho_show_num_votes(const struct rho_show *show, const struct rho_show_source *source);
const char *rho_show_write_votes(struct rho_show *show, const struct rho_show_source *source,
                                 uint32_t number, const struct rho_show_output *output);

/* show_hypotheses.c */
const char *rho_show_write_hypotheses(const struct rho_show_source *source, unsigned track,
                                      const struct rho_show_output *output);

static inline int16_t rho_show_id(int32_t sensor_id)
{
    return (int16_t)(sensor_id >= INT16_MIN && sensor_id <= INT16_MAX ? sensor_id : -1);
}

static inline int16_t rho_show_short(uint32_t count)
{
    return (int16_t)(count < INT16_MAX ? count : INT16_MAX);
}

#endif
