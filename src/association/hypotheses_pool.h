/* SPDX-License-Identifier: MIT */
/* hypotheses_pool: the pool's nodes and filters. Private to hypotheses*.c and gate_box.c. */
#ifndef RHOTRACK_HYPOTHESES_POOL_H
#define RHOTRACK_HYPOTHESES_POOL_H

#include "rhotrack/detail/hypotheses.h"

enum { RHO_HYPOTHESES_MAGIC = 0x4859504f }; /* "HYPO" */

/* True where a slot of an initialised pool has hypotheses. */
int rho_hypotheses_is_open(const struct rho_hypotheses *pool, uint16_t slot);

/* Takes a node off the pool's stack of free nodes; num_free must not be 0. */
uint16_t rho_hypotheses_pop_node(struct rho_hypotheses *pool);
/* Puts a node, which no slot lists any more, on the pool's stack of free nodes. */
void rho_hypotheses_push_node(struct rho_hypotheses *pool, uint16_t node);

/*
 * Makes room for `wanted` hypotheses of a slot: removes the least likely hypotheses of the slots
 * with the most. Returns how many the slot can have, at most `wanted`.
 */
unsigned rho_hypotheses_make_room(struct rho_hypotheses *pool, uint16_t slot, unsigned wanted);

/* Predicts one filter to another time without mixing its models: to a plot's own time, or back. */
enum rho_status rho_hypotheses_predict_filter(struct rho_hypotheses *pool, struct rho_imm *imm,
                                              int64_t from_us, int64_t to_us);

/* A hypothesis' filter, or its copy in scratch, at a time; NULL where the prediction fails. */
const struct rho_imm *rho_hypotheses_filter_at(struct rho_hypotheses *pool,
                                               const struct rho_hypothesis *at, int64_t time_us);

/* Subtracts the first hypothesis' weight, the best, from all, sets shares, and returns it. */
float rho_hypotheses_rebase_weights(struct rho_hypotheses *pool, uint16_t slot);

/* Sum of the shares, e^weight, of a slot's hypotheses. */
float rho_hypotheses_sum_of_shares(const struct rho_hypotheses *pool, uint16_t slot);

#endif
