/* SPDX-License-Identifier: MIT */
/*
 * hypotheses: the pool, its slots, prediction, and the mean over a slot. hypotheses_scan.c lets them grow by a scan's plots.
 */
#include "rhotrack/hypotheses.h"

#include <string.h>

#include "hypotheses_pool.h"
#include "rhotrack/approx.h"

#define POOL_MAGIC 0x4859504fu /* "HYPO" */

/* Less likely ones do not show in the mean. */
#define WEIGHT_SHOWN_MIN (-9.0f)

/* ---- the pool --------------------------------------------------------------------------------- */

static int is_ready(const struct rho_hypotheses *pool)
{
    return pool->magic == POOL_MAGIC;
}

int rho_hypotheses_is_open(const struct rho_hypotheses *pool, uint16_t slot)
{
    return is_ready(pool) && slot < RHO_HYPOTHESES_SLOTS && pool->num_of[slot] > 0;
}

uint16_t rho_hypotheses_allot(struct rho_hypotheses *pool)
{
    return pool->spare[--pool->num_free];
}

void rho_hypotheses_release(struct rho_hypotheses *pool, uint16_t node)
{
    pool->spare[pool->num_free++] = node;
}

/* The slot with the most hypotheses, of equals the first, but for one. */
static uint16_t richest(const struct rho_hypotheses *pool, uint16_t but)
{
    uint16_t found = but;
    for (uint16_t slot = 0; slot < RHO_HYPOTHESES_SLOTS; slot++) {
        if (slot != but && pool->num_of[slot] > (found == but ? 0 : pool->num_of[found])) {
            found = slot;
        }
    }
    return found;
}

unsigned rho_hypotheses_make_room(struct rho_hypotheses *pool, uint16_t slot, unsigned wanted)
{
    unsigned own = slot < RHO_HYPOTHESES_SLOTS ? pool->num_of[slot] : 0;
    while (own + pool->num_free < wanted) {
        uint16_t giver = richest(pool, slot);
        unsigned most = giver == slot ? 0 : pool->num_of[giver];
        if (most < 2 || most <= own + pool->num_free) {
            pool->hypotheses_cut = rho_count(pool->hypotheses_cut, wanted - own - pool->num_free);
            return own + pool->num_free;
        }
        pool->hypotheses_cut = rho_count(pool->hypotheses_cut, 1);
        pool->num_of[giver]--;
        rho_hypotheses_release(pool, pool->node_of[giver][pool->num_of[giver]]);
    }
    return wanted;
}

enum rho_status rho_hypotheses_init(struct rho_hypotheses *pool, size_t size,
                                    const struct rho_imm_model *model)
{
    if (!pool || !model) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *pool) {
        return RHO_ERROR_SIZE;
    }
    if (!rho_imm_model_is_usable(model)) {
        return RHO_ERROR_CONFIG;
    }
    struct rho_imm_model copy = *model;
    memset(pool, 0, sizeof *pool);
    pool->model = copy;
    pool->num_free = RHO_MAX_HYPOTHESES;
    for (unsigned i = 0; i < RHO_MAX_HYPOTHESES; i++) {
        pool->spare[i] = (uint16_t)(RHO_MAX_HYPOTHESES - 1u - i);
    }
    rho_imm_step_open(&pool->step, model, 0.0f);
    pool->magic = POOL_MAGIC;
    return RHO_OK;
}

/* ---- slots ------------------------------------------------------------------------------------ */

static int find_slot(const struct rho_hypotheses *pool, uint16_t *slot)
{
    for (uint16_t i = 0; i < RHO_HYPOTHESES_SLOTS; i++) {
        if (pool->num_of[i] == 0) {
            *slot = i;
            return 1;
        }
    }
    return 0;
}

enum rho_status rho_hypotheses_open(struct rho_hypotheses *pool, const struct rho_kalman *estimate,
                                    int64_t time_us, uint16_t *slot)
{
    if (!pool || !estimate || !slot) {
        return RHO_ERROR_NULL;
    }
    if (!is_ready(pool)) {
        return RHO_ERROR_STATE;
    }
    uint16_t found = 0;
    if (!find_slot(pool, &found) || rho_hypotheses_make_room(pool, found, 1) < 1) {
        return RHO_ERROR_CAPACITY;
    }
    uint16_t node = rho_hypotheses_allot(pool);
    struct rho_hypothesis *first = &pool->nodes[node];
    memset(first, 0, sizeof *first);
    rho_imm_start(&first->imm, &pool->model, estimate);
    first->time_us = time_us;
    for (int i = 0; i < RHO_HYPOTHESES_MEMORY; i++) {
        first->picks[i] = RHO_HYPOTHESES_MISS;
    }
    pool->node_of[found][0] = node;
    pool->num_of[found] = 1;
    *slot = found;
    return RHO_OK;
}

void rho_hypotheses_close(struct rho_hypotheses *pool, uint16_t slot)
{
    if (!pool || !rho_hypotheses_is_open(pool, slot)) {
        return;
    }
    for (unsigned i = pool->num_of[slot]; i > 0; i--) {
        rho_hypotheses_release(pool, pool->node_of[slot][i - 1]);
    }
    pool->num_of[slot] = 0;
}

unsigned rho_hypotheses_count(const struct rho_hypotheses *pool, uint16_t slot)
{
    return pool && rho_hypotheses_is_open(pool, slot) ? pool->num_of[slot] : 0;
}

const struct rho_hypothesis *rho_hypotheses_at(const struct rho_hypotheses *pool, uint16_t slot,
                                               unsigned index)
{
    return index < rho_hypotheses_count(pool, slot) ? &pool->nodes[pool->node_of[slot][index]] : 0;
}

/* ---- predict ---------------------------------------------------------------------------------- */

/* The step of an interval, kept until another one is asked for. */
static const struct rho_imm_step *find_step(struct rho_hypotheses *pool, int64_t from_us,
                                            int64_t to_us)
{
    float dt_s = rho_seconds_between(from_us, to_us);
    if (dt_s < pool->step.dt_s || dt_s > pool->step.dt_s) {
        rho_imm_step_open(&pool->step, &pool->model, dt_s);
    }
    return &pool->step;
}

enum rho_status rho_hypotheses_move(struct rho_hypotheses *pool, struct rho_imm *imm,
                                    int64_t from_us, int64_t to_us)
{
    return from_us == to_us ? RHO_OK : rho_imm_move(imm, find_step(pool, from_us, to_us));
}

const struct rho_imm *rho_hypotheses_filter_at(struct rho_hypotheses *pool,
                                               const struct rho_hypothesis *at, int64_t time_us)
{
    if (at->time_us == time_us) {
        return &at->imm;
    }
    pool->scratch = at->imm;
    return rho_hypotheses_move(pool, &pool->scratch, at->time_us, time_us) == RHO_OK
               ? &pool->scratch
               : 0;
}

float rho_hypotheses_rebase(struct rho_hypotheses *pool, uint16_t slot)
{
    const float best = pool->nodes[pool->node_of[slot][0]].weight_nat;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        pool->nodes[pool->node_of[slot][i]].weight_nat -= best;
    }
    return best;
}

enum rho_status rho_hypotheses_predict(struct rho_hypotheses *pool, uint16_t slot, int64_t time_us)
{
    if (!pool) {
        return RHO_ERROR_NULL;
    }
    if (!rho_hypotheses_is_open(pool, slot)) {
        return RHO_ERROR_STATE;
    }
    unsigned left = 0;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        uint16_t node = pool->node_of[slot][i];
        struct rho_hypothesis *at = &pool->nodes[node];
        if (at->time_us != time_us &&
            rho_imm_predict(&at->imm, find_step(pool, at->time_us, time_us)) != RHO_OK) {
            rho_hypotheses_release(pool, node);
            continue;
        }
        at->time_us = time_us;
        pool->node_of[slot][left++] = node;
    }
    pool->num_of[slot] = (uint8_t)left;
    if (left == 0) {
        return RHO_ERROR_VALUE;
    }
    (void)rho_hypotheses_rebase(pool, slot);
    return RHO_OK;
}

/* ---- the mean --------------------------------------------------------------------------------- */

float rho_hypotheses_log_sum(const struct rho_hypotheses *pool, uint16_t slot)
{
    float sum = 0.0f;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        sum += rho_exp(pool->nodes[pool->node_of[slot][i]].weight_nat);
    }
    return rho_log(sum);
}

/* The mean of both models, with a share in the sum. */
static void add_mean(const struct rho_imm *imm, float share,
                     struct rho_hypotheses_estimate *estimate)
{
    const float m = share * imm->probability, s = share - m;
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        estimate->kalman.state[i] += s * imm->steady.state[i] + m * imm->state[i];
    }
    for (int i = 0; i < 3; i++) {
        estimate->accel_mps2[i] += m * imm->state[RHO_KALMAN_STATES + i];
    }
    estimate->maneuver_probability += m;
}

/* A model's covariance and its way from the mean of all. */
static void add_spread(const float *state, const float *covariance, float share,
                       struct rho_kalman *kalman)
{
    float way[RHO_KALMAN_STATES];
    float *out = kalman->covariance;
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        way[i] = state[i] - kalman->state[i];
        for (int j = 0; j <= i; j++) {
            *out++ += share * (*covariance++ + way[i] * way[j]);
        }
    }
}

/* Shares of the hypotheses that can be seen at all; returns their sum. */
static float share_out(struct rho_hypotheses *pool, uint16_t slot, int64_t time_us,
                       float shares[RHO_HYPOTHESES_OF_TRACK])
{
    float total = 0.0f;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][i]];
        shares[i] =
            at->weight_nat >= WEIGHT_SHOWN_MIN && rho_hypotheses_filter_at(pool, at, time_us)
                ? rho_exp(at->weight_nat)
                : 0.0f;
        total += shares[i];
    }
    return total;
}

enum rho_status rho_hypotheses_estimate(struct rho_hypotheses *pool, uint16_t slot, int64_t time_us,
                                        struct rho_hypotheses_estimate *estimate)
{
    float shares[RHO_HYPOTHESES_OF_TRACK] = {0.0f};
    if (!pool || !estimate) {
        return RHO_ERROR_NULL;
    }
    if (!rho_hypotheses_is_open(pool, slot)) {
        return RHO_ERROR_STATE;
    }
    const unsigned num = pool->num_of[slot];
    const float total = share_out(pool, slot, time_us, shares);
    if (!(total > 0.0f)) {
        return RHO_ERROR_VALUE;
    }
    memset(estimate, 0, sizeof *estimate);
    for (unsigned i = 0; i < num; i++) {
        shares[i] /= total;
        if (shares[i] > 0.0f) {
            add_mean(rho_hypotheses_filter_at(pool, &pool->nodes[pool->node_of[slot][i]], time_us),
                     shares[i], estimate);
        }
    }
    for (unsigned i = 0; i < num; i++) {
        if (shares[i] > 0.0f) {
            const struct rho_imm *imm =
                rho_hypotheses_filter_at(pool, &pool->nodes[pool->node_of[slot][i]], time_us);
            const float m = shares[i] * imm->probability;
            add_spread(imm->steady.state, imm->steady.covariance, shares[i] - m, &estimate->kalman);
            add_spread(imm->state, imm->covariance, m, &estimate->kalman);
        }
    }
    return RHO_OK;
}
