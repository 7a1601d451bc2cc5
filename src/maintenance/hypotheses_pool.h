/* SPDX-License-Identifier: MIT */
/*
 * The pool's inside. Private to src/maintenance/hypotheses*.c.
 */
#ifndef RHOTRACK_HYPOTHESES_POOL_H
#define RHOTRACK_HYPOTHESES_POOL_H

#include "rhotrack/hypotheses.h"

/* hypotheses.c */
int rho_hypotheses_is_ready(const struct rho_hypotheses *pool);
int rho_hypotheses_is_open(const struct rho_hypotheses *pool, uint16_t slot);

/* A node of the pool; there must be one. */
uint16_t rho_hypotheses_allot(struct rho_hypotheses *pool);
void rho_hypotheses_release(struct rho_hypotheses *pool, uint16_t node);

/* Sees to free nodes, so that a slot could have `wanted`, at the cost of slots that have more. Returns how many it can. */
unsigned rho_hypotheses_make_room(struct rho_hypotheses *pool, uint16_t slot, unsigned wanted);

/* Moves one filter to another time without mixing: to a plot's own, or back from it. */
enum rho_status rho_hypotheses_move(struct rho_hypotheses *pool, struct rho_imm *imm,
                                    int64_t from_us, int64_t to_us);

/* The step of an interval, kept until another one is asked for. */
const struct rho_imm_step *rho_hypotheses_step(struct rho_hypotheses *pool, int64_t from_us,
                                               int64_t to_us);

/* ln of the sum of e^weight over a slot's hypotheses. */
float rho_hypotheses_log_sum(const struct rho_hypotheses *pool, uint16_t slot);

#endif
