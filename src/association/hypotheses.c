/* SPDX-License-Identifier: MIT */
/* hypotheses: the pool of hypotheses, its slots, prediction, and the mean over a slot. */
#include "rhotrack/detail/hypotheses.h"

#include <string.h>

#include "hypotheses_pool.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

int rho_hypotheses_is_open(const struct rho_hypotheses *pool, uint16_t slot)
{
    return slot < RHO_HYPOTHESES_SLOTS && pool->num_of[slot] > 0;
}

uint16_t rho_hypotheses_pop_node(struct rho_hypotheses *pool)
{
    return pool->spare[--pool->num_free];
}

void rho_hypotheses_push_node(struct rho_hypotheses *pool, uint16_t node)
{
    pool->spare[pool->num_free++] = node;
}

unsigned rho_hypotheses_make_room(struct rho_hypotheses *pool, uint16_t slot, unsigned wanted)
{
    unsigned own = slot < RHO_HYPOTHESES_SLOTS ? pool->num_of[slot] : 0;
    while (own + pool->num_free < wanted) {
        uint16_t giver = slot; /* the slot with the most hypotheses, of equals the first */
        unsigned most = 0;
        for (uint16_t other = 0; other < RHO_HYPOTHESES_SLOTS; other++) {
            if (other != slot && pool->num_of[other] > most) {
                giver = other;
                most = pool->num_of[other];
            }
        }
        if (most < 2 || most <= own + pool->num_free) {
            pool->hypotheses_cut = rho_count(pool->hypotheses_cut, wanted - own - pool->num_free);
            return own + pool->num_free;
        }
        pool->hypotheses_cut = rho_count(pool->hypotheses_cut, 1);
        pool->num_of[giver]--;
        rho_hypotheses_push_node(pool, pool->node_of[giver][pool->num_of[giver]]);
    }
    return wanted;
}

enum rho_status rho_hypotheses_init(struct rho_hypotheses *pool, size_t object_size,
                                    const struct rho_imm_model *model)
{
    if (object_size != sizeof *pool) {
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
    rho_imm_prepare_step(&pool->step, model, 0.0f);
    pool->magic = RHO_HYPOTHESES_MAGIC;
    return RHO_OK;
}

enum rho_status rho_hypotheses_set_model(struct rho_hypotheses *pool,
                                         const struct rho_imm_model *model)
{
    struct rho_imm_model kept = *model;
    kept.calm_s = pool->model.calm_s;
    if (!rho_imm_model_is_usable(&kept)) {
        return RHO_ERROR_CONFIG;
    }
    pool->model = kept;
    rho_imm_prepare_step(&pool->step, &pool->model, pool->step.dt_s);
    return RHO_OK;
}

void rho_hypotheses_set_calm_s(struct rho_hypotheses *pool, float calm_s)
{
    if (pool->model.calm_s > 0.0f && (calm_s < pool->model.calm_s || calm_s > pool->model.calm_s)) {
        pool->model.calm_s = calm_s;
        rho_imm_prepare_step(&pool->step, &pool->model, pool->step.dt_s);
    }
}

/* A node off the pool's stack, for a hypothesis that starts from an estimate. */
static uint16_t start_node(struct rho_hypotheses *pool, const struct rho_kalman *estimate,
                           int64_t time_us, float weight_nat)
{
    const uint16_t node = rho_hypotheses_pop_node(pool);
    struct rho_hypothesis *first = &pool->nodes[node];
    memset(first, 0, sizeof *first);
    rho_imm_start(&first->imm, &pool->model, estimate);
    first->time_us = time_us;
    first->weight_nat = weight_nat;
    first->share = rho_exp(weight_nat);
    for (int i = 0; i < RHO_HYPOTHESES_MEMORY; i++) {
        first->picks[i] = RHO_HYPOTHESES_MISS;
    }
    return node;
}

enum rho_status rho_hypotheses_open(struct rho_hypotheses *pool, const struct rho_kalman *estimate,
                                    int64_t time_us, uint16_t *slot)
{
    uint16_t found = 0;
    while (found < RHO_HYPOTHESES_SLOTS && pool->num_of[found] > 0) {
        found++;
    }
    if (found == RHO_HYPOTHESES_SLOTS || rho_hypotheses_make_room(pool, found, 1) < 1) {
        return RHO_ERROR_CAPACITY;
    }
    pool->node_of[found][0] = start_node(pool, estimate, time_us, 0.0f);
    pool->num_of[found] = 1;
    *slot = found;
    return RHO_OK;
}

void rho_hypotheses_add(struct rho_hypotheses *pool, uint16_t slot,
                        const struct rho_kalman *estimate, int64_t time_us, float weight_nat)
{
    uint16_t *nodes = pool->node_of[slot];
    unsigned place = pool->num_of[slot];
    if (place == RHO_HYPOTHESES_OF_TRACK) {
        rho_hypotheses_push_node(pool, nodes[--place]);
    }
    pool->num_of[slot] = (uint8_t)place;
    if (rho_hypotheses_make_room(pool, slot, place + 1u) == place) {
        return;
    }
    const uint16_t node = start_node(pool, estimate, time_us, weight_nat);
    for (; place > 0 && pool->nodes[nodes[place - 1]].weight_nat < weight_nat; place--) {
        nodes[place] = nodes[place - 1];
    }
    nodes[place] = node;
    pool->num_of[slot]++;
}

void rho_hypotheses_close(struct rho_hypotheses *pool, uint16_t slot)
{
    if (!rho_hypotheses_is_open(pool, slot)) {
        return;
    }
    for (unsigned i = pool->num_of[slot]; i > 0; i--) {
        rho_hypotheses_push_node(pool, pool->node_of[slot][i - 1]);
    }
    pool->num_of[slot] = 0;
}

unsigned rho_hypotheses_count(const struct rho_hypotheses *pool, uint16_t slot)
{
    return rho_hypotheses_is_open(pool, slot) ? pool->num_of[slot] : 0;
}

const struct rho_hypothesis *rho_hypotheses_at(const struct rho_hypotheses *pool, uint16_t slot,
                                               unsigned index)
{
    return index < rho_hypotheses_count(pool, slot) ? &pool->nodes[pool->node_of[slot][index]] : 0;
}

/* Transition of the models over an interval, which is kept until another interval is needed. */
static const struct rho_imm_step *cached_step(struct rho_hypotheses *pool, int64_t from_us,
                                              int64_t to_us)
{
    float dt_s = rho_seconds_between(from_us, to_us);
    if (dt_s < pool->step.dt_s || dt_s > pool->step.dt_s) {
        rho_imm_prepare_step(&pool->step, &pool->model, dt_s);
    }
    return &pool->step;
}

enum rho_status rho_hypotheses_predict_filter(struct rho_hypotheses *pool, struct rho_imm *imm,
                                              int64_t from_us, int64_t to_us)
{
    return from_us == to_us ? RHO_OK
                            : rho_imm_predict_unmixed(imm, cached_step(pool, from_us, to_us));
}

const struct rho_imm *rho_hypotheses_filter_at(struct rho_hypotheses *pool,
                                               const struct rho_hypothesis *at, int64_t time_us)
{
    if (at->time_us == time_us) {
        return &at->imm;
    }
    pool->scratch = at->imm;
    return rho_hypotheses_predict_filter(pool, &pool->scratch, at->time_us, time_us) == RHO_OK
               ? &pool->scratch
               : 0;
}

float rho_hypotheses_rebase_weights(struct rho_hypotheses *pool, uint16_t slot)
{
    const float best = pool->nodes[pool->node_of[slot][0]].weight_nat;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][i]];
        at->weight_nat -= best;
        at->share = rho_exp(at->weight_nat);
    }
    return best;
}

/* Predicts all hypotheses of a slot, and removes those that cannot be predicted. */
static enum rho_status predict_slot(struct rho_hypotheses *pool, uint16_t slot, int64_t time_us,
                                    int is_without_noise)
{
    if (!rho_hypotheses_is_open(pool, slot)) {
        return RHO_ERROR_STATE;
    }
    unsigned left = 0;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        uint16_t node = pool->node_of[slot][i];
        struct rho_hypothesis *at = &pool->nodes[node];
        if (at->time_us != time_us) {
            const struct rho_imm_step *step = cached_step(pool, at->time_us, time_us);
            enum rho_status status;
            if (is_without_noise) { /* and without mixing */
                struct rho_imm_step noiseless = *step;
                memset(noiseless.noise, 0, sizeof noiseless.noise);
                memset(noiseless.quiet_noise, 0, sizeof noiseless.quiet_noise);
                status = rho_imm_predict_unmixed(&at->imm, &noiseless);
            } else {
                status = rho_imm_predict(&at->imm, step);
            }
            if (status != RHO_OK) {
                rho_hypotheses_push_node(pool, node);
                continue;
            }
        }
        at->time_us = time_us;
        pool->node_of[slot][left++] = node;
    }
    pool->num_of[slot] = (uint8_t)left;
    if (left == 0) {
        return RHO_ERROR_VALUE;
    }
    if (pool->nodes[pool->node_of[slot][0]].weight_nat < 0.0f) {
        (void)rho_hypotheses_rebase_weights(pool, slot); /* the best hypothesis was removed */
    }
    return RHO_OK;
}

enum rho_status rho_hypotheses_predict(struct rho_hypotheses *pool, uint16_t slot, int64_t time_us)
{
    return predict_slot(pool, slot, time_us, 0);
}

enum rho_status rho_hypotheses_move(struct rho_hypotheses *pool, uint16_t slot, int64_t time_us)
{
    return predict_slot(pool, slot, time_us, 1);
}

void rho_hypotheses_loosen(struct rho_hypotheses *pool, uint16_t slot, float velocity_m2ps2)
{
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        struct rho_imm *imm = &pool->nodes[pool->node_of[slot][i]].imm;
        for (int axis = RHO_VX; axis <= RHO_VY; axis++) {
            imm->steady.covariance[RHO_AT(axis, axis)] += velocity_m2ps2;
            imm->covariance[RHO_AT(axis, axis)] += velocity_m2ps2;
        }
    }
}

float rho_hypotheses_sum_of_shares(const struct rho_hypotheses *pool, uint16_t slot)
{
    float sum = 0.0f;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        sum += pool->nodes[pool->node_of[slot][i]].share;
    }
    return sum;
}

/*
 * Sums over both models of all hypotheses, weighted by their shares. States are taken relative to a
 * place near all of them, so that one pass suffices and no digits cancel.
 */
struct moment_sums {
    float about[RHO_KALMAN_STATES];
    int has_height; /* 1: any hypothesis has a height; 0: sums of z stay 0 */
    float share, maneuver;
    float deviation[RHO_KALMAN_STATES]; /* weighted sum of the states' deviations from `about` */
    float accel_mps2[3];
    float covariance[RHO_TRIANGLE(RHO_KALMAN_STATES)];
};

/* One model of a hypothesis: its share, its deviations from `about`, and these times the share. */
struct weighted_model {
    float share;
    float deviation[RHO_KALMAN_STATES], scaled[RHO_KALMAN_STATES];
};

/* Sets element i of both models' deviations, and adds them to the sums by their shares. */
static inline void add_deviation(struct moment_sums *sums, const struct rho_imm *imm,
                                 struct weighted_model *s, struct weighted_model *m, int i)
{
    s->deviation[i] = imm->steady.state[i] - sums->about[i];
    m->deviation[i] = imm->state[i] - sums->about[i];
    s->scaled[i] = s->share * s->deviation[i];
    m->scaled[i] = m->share * m->deviation[i];
    sums->deviation[i] += s->scaled[i] + m->scaled[i];
}

/*
 * Adds element i, j of the covariance: the product of both models' deviations, and their own, which
 * most hypotheses have within an axis alone.
 */
static inline void add_product(float *restrict out, const struct rho_imm *restrict imm,
                               const struct weighted_model *restrict s,
                               const struct weighted_model *restrict m, int i, int j)
{
    float *sum = &out[RHO_AT(i, j)];
    *sum += s->scaled[i] * s->deviation[j] + m->scaled[i] * m->deviation[j];
    if (i % RHO_AXES == j % RHO_AXES || imm->is_coupled) {
        *sum += s->share * imm->steady.covariance[RHO_AT(i, j)] +
                m->share * imm->covariance[RHO_AT(i, j)];
    }
}

/*
 * Adds both models of one hypothesis, weighted by its share, to the sums. Written out over the
 * elements, as a loop would take three times as long.
 */
static void add_hypothesis(struct moment_sums *sums, const struct rho_imm *imm, float share)
{
    struct weighted_model s, m;
    float *out = sums->covariance;
    m.share = share * imm->probability;
    s.share = share - m.share;
    add_deviation(sums, imm, &s, &m, 0);
    add_deviation(sums, imm, &s, &m, 1);
    add_deviation(sums, imm, &s, &m, 3);
    add_deviation(sums, imm, &s, &m, 4);
    add_product(out, imm, &s, &m, 0, 0);
    add_product(out, imm, &s, &m, 1, 1);
    add_product(out, imm, &s, &m, 3, 0);
    add_product(out, imm, &s, &m, 3, 3);
    add_product(out, imm, &s, &m, 4, 1);
    add_product(out, imm, &s, &m, 4, 4);
    add_product(out, imm, &s, &m, 1, 0);
    add_product(out, imm, &s, &m, 3, 1);
    add_product(out, imm, &s, &m, 4, 0);
    add_product(out, imm, &s, &m, 4, 3);
    if (sums->has_height) {
        add_deviation(sums, imm, &s, &m, 2);
        add_deviation(sums, imm, &s, &m, 5);
        add_product(out, imm, &s, &m, 2, 2);
        add_product(out, imm, &s, &m, 5, 2);
        add_product(out, imm, &s, &m, 5, 5);
        add_product(out, imm, &s, &m, 2, 0);
        add_product(out, imm, &s, &m, 2, 1);
        add_product(out, imm, &s, &m, 3, 2);
        add_product(out, imm, &s, &m, 4, 2);
        add_product(out, imm, &s, &m, 5, 0);
        add_product(out, imm, &s, &m, 5, 1);
        add_product(out, imm, &s, &m, 5, 3);
        add_product(out, imm, &s, &m, 5, 4);
    }
    sums->share += share;
    sums->maneuver += m.share;
    for (int axis = 0; axis < 3; axis++) {
        sums->accel_mps2[axis] += m.share * imm->state[RHO_KALMAN_STATES + axis];
    }
}

enum rho_status rho_hypotheses_estimate(struct rho_hypotheses *pool, uint16_t slot, int64_t time_us,
                                        struct rho_hypotheses_estimate *estimate)
{
    struct moment_sums sums = {.share = 0.0f};
    int is_first = 1;
    if (!rho_hypotheses_is_open(pool, slot)) {
        return RHO_ERROR_STATE;
    }
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_imm *imm = &pool->nodes[pool->node_of[slot][i]].imm;
        sums.has_height |= imm->covariance[RHO_AT(2, 2)] > 0.0f;
    }
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][i]];
        const struct rho_imm *imm =
            at->share < SHARE_SHOWN_MIN ? 0 : rho_hypotheses_filter_at(pool, at, time_us);
        if (!imm) {
            continue; /* next to no share, or it cannot be moved to time_us */
        }
        if (is_first) {
            memcpy(sums.about, imm->probability > 0.5f ? imm->state : imm->steady.state,
                   sizeof sums.about);
            is_first = 0;
        }
        add_hypothesis(&sums, imm, at->share);
    }
    if (!(sums.share > 0.0f)) {
        return RHO_ERROR_VALUE;
    }
    const float inverse = 1.0f / sums.share;
    int place = 0;
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        sums.deviation[i] *= inverse;
        estimate->kalman.state[i] = sums.about[i] + sums.deviation[i];
        for (int j = 0; j <= i; j++, place++) {
            estimate->kalman.covariance[place] =
                sums.covariance[place] * inverse - sums.deviation[i] * sums.deviation[j];
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        estimate->accel_mps2[axis] = sums.accel_mps2[axis] * inverse;
    }
    estimate->maneuver_probability = sums.maneuver * inverse;
    return RHO_OK;
}
