/* SPDX-License-Identifier: MIT */
/*
 * Inside of the pool of hypotheses. Private to hypotheses*.c and gate_box.c.
 */
#ifndef RHOTRACK_HYPOTHESES_POOL_H
#define RHOTRACK_HYPOTHESES_POOL_H

#include "rhotrack/detail/hypotheses.h"

#define RHO_HYPOTHESES_MAGIC 0x4859504fu /* "HYPO" */

/* hypotheses.c */
int rho_hypotheses_is_open(const struct rho_hypotheses *pool, uint16_t slot);

/* A node of the pool; there must be one. */
uint16_t rho_hypotheses_allot_node(struct rho_hypotheses *pool);
void rho_hypotheses_release_node(struct rho_hypotheses *pool, uint16_t node);

/*
 * Frees nodes of the slots with the most hypotheses, so that this slot can have `wanted`. Returns
 * how many it can have.
 */
unsigned rho_hypotheses_make_room(struct rho_hypotheses *pool, uint16_t slot, unsigned wanted);

/* Moves one filter to another time without mixing: to a plot's own, or back from it. */
enum rho_status rho_hypotheses_move_filter(struct rho_hypotheses *pool, struct rho_imm *imm,
                                           int64_t from_us, int64_t to_us);

/*
 * A hypothesis' filter at a time that need not be its own, there in the pool's scratch; NULL where
 * it cannot be moved.
 */
const struct rho_imm *rho_hypotheses_filter_at(struct rho_hypotheses *pool,
                                               const struct rho_hypothesis *at, int64_t time_us);

/*
 * Makes the weight of the best, the slot's first, 0 again and updates all shares. Returns the
 * weight that it had.
 */
float rho_hypotheses_rebase_weights(struct rho_hypotheses *pool, uint16_t slot);

/* The sum of a slot's shares. */
float rho_hypotheses_sum_of_shares(const struct rho_hypotheses *pool, uint16_t slot);

#endif
