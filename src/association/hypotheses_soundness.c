/* SPDX-License-Identifier: MIT */
/* hypotheses_soundness: whether a pool of unknown origin (a snapshot) is safe to use. */
#include "hypotheses_pool.h"

/* Number of nodes that one pass over the lists checks, to bound the stack. */
enum { PASS_NODES = 256 };

struct pass {
    unsigned first;
    uint8_t is_met[PASS_NODES];
};

static void mark_node_met(struct pass *pass, uint16_t node)
{
    if (node >= pass->first && node - pass->first < PASS_NODES) {
        pass->is_met[node - pass->first] = 1;
    }
}

/* True where the free list and the slots' lists contain each node of the pool exactly once. */
static int has_each_node_once(const struct rho_hypotheses *pool)
{
    unsigned named = pool->num_free;
    for (unsigned slot = 0; slot < RHO_HYPOTHESES_SLOTS; slot++) {
        if (pool->num_of[slot] > RHO_HYPOTHESES_OF_TRACK) {
            return 0;
        }
        named += pool->num_of[slot];
    }
    if (pool->num_free > RHO_MAX_HYPOTHESES || named != RHO_MAX_HYPOTHESES) {
        return 0;
    }
    /* the lists have as many entries as there are nodes: each is listed once if all are listed */
    for (unsigned first = 0; first < RHO_MAX_HYPOTHESES; first += PASS_NODES) {
        struct pass pass = {.first = first};
        for (unsigned i = 0; i < pool->num_free; i++) {
            mark_node_met(&pass, pool->spare[i]);
        }
        for (unsigned slot = 0; slot < RHO_HYPOTHESES_SLOTS; slot++) {
            for (unsigned i = 0; i < pool->num_of[slot]; i++) {
                mark_node_met(&pass, pool->node_of[slot][i]);
            }
        }
        for (unsigned i = 0; i < PASS_NODES && first + i < RHO_MAX_HYPOTHESES; i++) {
            if (!pass.is_met[i]) {
                return 0;
            }
        }
    }
    return 1;
}

static int is_sound_node(const struct rho_hypothesis *at)
{
    return rho_is_stored_time(at->time_us) && rho_is_within(at->weight_nat, -1e9f, 1e9f) &&
           rho_is_within(at->share, 0.0f, 1e9f) && at->num_candidates <= RHO_HYPOTHESES_CHILDREN &&
           rho_are_finite(at->imm.steady.state, RHO_KALMAN_STATES) &&
           rho_are_finite(at->imm.steady.covariance, RHO_TRIANGLE(RHO_KALMAN_STATES)) &&
           rho_are_finite(at->imm.state, RHO_IMM_STATES) &&
           rho_are_finite(at->imm.covariance, RHO_TRIANGLE(RHO_IMM_STATES)) &&
           rho_is_within(at->imm.probability, 0.0f, 1.0f) &&
           rho_is_within(at->imm.calm, 0.0f, 1.0f);
}

int rho_hypotheses_is_sound(const struct rho_hypotheses *pool)
{
    const struct rho_imm_step *step = &pool->step;
    if (pool->magic != RHO_HYPOTHESES_MAGIC || !rho_imm_model_is_usable(&pool->model) ||
        !rho_is_within(step->dt_s, -1e13f, 1e13f) || !rho_is_within(step->begins, 0.0f, 1.0f) ||
        !rho_is_within(step->ends, 0.0f, 1.0f) || !rho_is_within(step->calm_begins, 0.0f, 1.0f) ||
        !rho_is_within(step->settles, 0.0f, 1.0f) || !rho_is_within(step->odds_over, 0.0f, 1.0f) ||
        !rho_is_within(step->quiet_density, 0.0f, 1e8f) ||
        !rho_is_within(step->calm_density, 0.0f, step->quiet_density) ||
        !has_each_node_once(pool)) {
        return 0;
    }
    for (unsigned slot = 0; slot < RHO_HYPOTHESES_SLOTS; slot++) {
        for (unsigned i = 0; i < pool->num_of[slot]; i++) {
            if (!is_sound_node(&pool->nodes[pool->node_of[slot][i]])) {
                return 0;
            }
        }
    }
    return 1;
}
