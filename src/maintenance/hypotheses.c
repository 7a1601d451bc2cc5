/* SPDX-License-Identifier: MIT */
/*
 * hypotheses: the pool, its slots, prediction, and the mean over a slot. hypotheses_scan.c lets them grow by a scan's plots.
 */
#include "rhotrack/hypotheses.h"

#include <string.h>

#include "hypotheses_pool.h"
#include "rhotrack/approx.h"

#define POOL_MAGIC 0x4859504fu /* "HYPO" */

/* Less likely ones, e^-9 beside the best one, do not show in the mean. */
#define SHARE_SHOWN_MIN 1.234e-4f

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
    first->share = 1.0f;
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
        struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][i]];
        at->weight_nat -= best;
        at->share = rho_exp(at->weight_nat);
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
    if (pool->nodes[pool->node_of[slot][0]].weight_nat < 0.0f) {
        (void)rho_hypotheses_rebase(pool, slot); /* the best one is gone */
    }
    return RHO_OK;
}

/* ---- the mean --------------------------------------------------------------------------------- */

float rho_hypotheses_log_sum(const struct rho_hypotheses *pool, uint16_t slot)
{
    float sum = 0.0f;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        sum += pool->nodes[pool->node_of[slot][i]].share;
    }
    return rho_log(sum);
}

/*
 * Sums over models of hypotheses, each with its share: about a place near all of them, so that one pass will do and nothing
 * cancels.
 */
struct sums {
    float about[RHO_KALMAN_STATES];
    float share, maneuver;
    float way[RHO_KALMAN_STATES]; /* from there */
    float accel_mps2[3];
    float covariance[RHO_TRIANGLE(RHO_KALMAN_STATES)];
};

/* A covariance and the square of a way, each with its share. Written out: a loop would take three times as long. */
static inline void add_square(float *out, const float *p, float share, const float *way,
                              const float *scaled)
{
    out[0] += share * p[0] + scaled[0] * way[0];
    out[1] += share * p[1] + scaled[1] * way[0];
    out[2] += share * p[2] + scaled[1] * way[1];
    out[3] += share * p[3] + scaled[2] * way[0];
    out[4] += share * p[4] + scaled[2] * way[1];
    out[5] += share * p[5] + scaled[2] * way[2];
    out[6] += share * p[6] + scaled[3] * way[0];
    out[7] += share * p[7] + scaled[3] * way[1];
    out[8] += share * p[8] + scaled[3] * way[2];
    out[9] += share * p[9] + scaled[3] * way[3];
    out[10] += share * p[10] + scaled[4] * way[0];
    out[11] += share * p[11] + scaled[4] * way[1];
    out[12] += share * p[12] + scaled[4] * way[2];
    out[13] += share * p[13] + scaled[4] * way[3];
    out[14] += share * p[14] + scaled[4] * way[4];
    out[15] += share * p[15] + scaled[5] * way[0];
    out[16] += share * p[16] + scaled[5] * way[1];
    out[17] += share * p[17] + scaled[5] * way[2];
    out[18] += share * p[18] + scaled[5] * way[3];
    out[19] += share * p[19] + scaled[5] * way[4];
    out[20] += share * p[20] + scaled[5] * way[5];
}

static void add_model(struct sums *sums, const float *state, const float *covariance, float share)
{
    float way[RHO_KALMAN_STATES], scaled[RHO_KALMAN_STATES];
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        way[i] = state[i] - sums->about[i];
        scaled[i] = share * way[i];
        sums->way[i] += scaled[i];
    }
    add_square(sums->covariance, covariance, share, way, scaled);
}

static void add_hypothesis(struct sums *sums, const struct rho_imm *imm, float share)
{
    const float m = share * imm->probability;
    add_model(sums, imm->steady.state, imm->steady.covariance, share - m);
    add_model(sums, imm->state, imm->covariance, m);
    sums->share += share;
    sums->maneuver += m;
    for (int axis = 0; axis < 3; axis++) {
        sums->accel_mps2[axis] += m * imm->state[RHO_KALMAN_STATES + axis];
    }
}

/* Of the slot's hypotheses that can be moved there. */
static void sum_up(struct rho_hypotheses *pool, uint16_t slot, int64_t time_us, struct sums *sums)
{
    int is_first = 1;
    memset(sums, 0, sizeof *sums);
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][i]];
        const struct rho_imm *imm =
            at->share < SHARE_SHOWN_MIN ? 0 : rho_hypotheses_filter_at(pool, at, time_us);
        if (imm && is_first) {
            memcpy(sums->about, imm->probability > 0.5f ? imm->state : imm->steady.state,
                   sizeof sums->about);
            is_first = 0;
        }
        if (imm) {
            add_hypothesis(sums, imm, at->share);
        }
    }
}

enum rho_status rho_hypotheses_estimate(struct rho_hypotheses *pool, uint16_t slot, int64_t time_us,
                                        struct rho_hypotheses_estimate *estimate)
{
    struct sums sums;
    if (!pool || !estimate) {
        return RHO_ERROR_NULL;
    }
    if (!rho_hypotheses_is_open(pool, slot)) {
        return RHO_ERROR_STATE;
    }
    sum_up(pool, slot, time_us, &sums);
    if (!(sums.share > 0.0f)) {
        return RHO_ERROR_VALUE;
    }
    const float inverse = 1.0f / sums.share;
    int place = 0;
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        sums.way[i] *= inverse;
        estimate->kalman.state[i] = sums.about[i] + sums.way[i];
        for (int j = 0; j <= i; j++, place++) {
            estimate->kalman.covariance[place] =
                sums.covariance[place] * inverse - sums.way[i] * sums.way[j];
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        estimate->accel_mps2[axis] = sums.accel_mps2[axis] * inverse;
    }
    estimate->maneuver_probability = sums.maneuver * inverse;
    return RHO_OK;
}
