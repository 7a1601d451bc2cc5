/* SPDX-License-Identifier: MIT */
/*
 * hypotheses_pool_predict_and_estimate: the pool of hypotheses, its slots, prediction, and the mean
 * over a slot. hypotheses_scan.c extends the hypotheses by the plots of a scan.
 */
#include "rhotrack/detail/hypotheses.h"

#include <string.h>

#include "hypotheses_nodes_filters_and_weights.h"
#include "rhotrack/detail/approx.h"

/*
 * Least share of a hypothesis in the mean, e^-9 of the best one: less likely ones have no visible
 * effect.
 */
#define SHARE_SHOWN_MIN 1.2340980e-4f

/* ---- the pool -------------------------------------------------------------------------------- */

static int is_ready(const struct rho_hypotheses *pool)
{
    return pool->magic == RHO_HYPOTHESES_MAGIC;
}

int rho_hypotheses_has_any_in_slot(const struct rho_hypotheses *pool, uint16_t slot)
{
    return is_ready(pool) && slot < RHO_HYPOTHESES_SLOTS && pool->num_of[slot] > 0;
}

uint16_t rho_hypotheses_pop_free_hypothesis_node(struct rho_hypotheses *pool)
{
    return pool->spare[--pool->num_free];
}

void rho_hypotheses_push_free_node(struct rho_hypotheses *pool, uint16_t node)
{
    pool->spare[pool->num_free++] = node;
}

/*
 * Slot with the most hypotheses, of equals the first, except for except_slot, which is returned
 * where all others are free.
 */
static uint16_t slot_with_most_hypotheses(const struct rho_hypotheses *pool, uint16_t except_slot)
{
    uint16_t found = except_slot;
    for (uint16_t slot = 0; slot < RHO_HYPOTHESES_SLOTS; slot++) {
        if (slot != except_slot &&
            pool->num_of[slot] > (found == except_slot ? 0 : pool->num_of[found])) {
            found = slot;
        }
    }
    return found;
}

unsigned rho_hypotheses_room_after_cutting_others(struct rho_hypotheses *pool, uint16_t slot,
                                                  unsigned wanted)
{
    unsigned own = slot < RHO_HYPOTHESES_SLOTS ? pool->num_of[slot] : 0;
    while (own + pool->num_free < wanted) {
        uint16_t giver = slot_with_most_hypotheses(pool, slot);
        unsigned most = giver == slot ? 0 : pool->num_of[giver];
        if (most < 2 || most <= own + pool->num_free) {
            pool->hypotheses_cut = rho_count(pool->hypotheses_cut, wanted - own - pool->num_free);
            return own + pool->num_free;
        }
        pool->hypotheses_cut = rho_count(pool->hypotheses_cut, 1);
        pool->num_of[giver]--;
        rho_hypotheses_push_free_node(pool, pool->node_of[giver][pool->num_of[giver]]);
    }
    return wanted;
}

enum rho_status rho_hypotheses_init(struct rho_hypotheses *pool, size_t object_size,
                                    const struct rho_imm_model *model)
{
    if (!pool || !model) {
        return RHO_ERROR_NULL;
    }
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

enum rho_status rho_hypotheses_set_model_but_calm_time(struct rho_hypotheses *pool,
                                                       const struct rho_imm_model *model)
{
    if (!pool || !model) {
        return RHO_ERROR_NULL;
    }
    struct rho_imm_model kept = *model;
    kept.calm_s = pool->model.calm_s;
    if (!rho_imm_model_is_usable(&kept)) {
        return RHO_ERROR_CONFIG;
    }
    pool->model = kept;
    rho_imm_prepare_step(&pool->step, &pool->model, pool->step.dt_s);
    return RHO_OK;
}

void rho_hypotheses_set_mean_manoeuvre_interval(struct rho_hypotheses *pool, float calm_s)
{
    if (pool->model.calm_s > 0.0f && (calm_s < pool->model.calm_s || calm_s > pool->model.calm_s)) {
        pool->model.calm_s = calm_s;
        rho_imm_prepare_step(&pool->step, &pool->model, pool->step.dt_s);
    }
}

/* ---- slots ----------------------------------------------------------------------------------- */

static int find_free_slot(const struct rho_hypotheses *pool, uint16_t *slot)
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
    if (!find_free_slot(pool, &found) ||
        rho_hypotheses_room_after_cutting_others(pool, found, 1) < 1) {
        return RHO_ERROR_CAPACITY;
    }
    uint16_t node = rho_hypotheses_pop_free_hypothesis_node(pool);
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
    if (!pool || !rho_hypotheses_has_any_in_slot(pool, slot)) {
        return;
    }
    for (unsigned i = pool->num_of[slot]; i > 0; i--) {
        rho_hypotheses_push_free_node(pool, pool->node_of[slot][i - 1]);
    }
    pool->num_of[slot] = 0;
}

unsigned rho_hypotheses_count(const struct rho_hypotheses *pool, uint16_t slot)
{
    return pool && rho_hypotheses_has_any_in_slot(pool, slot) ? pool->num_of[slot] : 0;
}

const struct rho_hypothesis *rho_hypotheses_at(const struct rho_hypotheses *pool, uint16_t slot,
                                               unsigned index)
{
    return index < rho_hypotheses_count(pool, slot) ? &pool->nodes[pool->node_of[slot][index]] : 0;
}

/* ---- predict --------------------------------------------------------------------------------- */

/* Transition of the models over an interval, which is kept until another interval is needed. */
static const struct rho_imm_step *cached_step_of_interval(struct rho_hypotheses *pool,
                                                          int64_t from_us, int64_t to_us)
{
    float dt_s = rho_seconds_between(from_us, to_us);
    if (dt_s < pool->step.dt_s || dt_s > pool->step.dt_s) {
        rho_imm_prepare_step(&pool->step, &pool->model, dt_s);
    }
    return &pool->step;
}

enum rho_status rho_hypotheses_predict_one_filter_unmixed(struct rho_hypotheses *pool,
                                                          struct rho_imm *imm, int64_t from_us,
                                                          int64_t to_us)
{
    return from_us == to_us
               ? RHO_OK
               : rho_imm_predict_unmixed(imm, cached_step_of_interval(pool, from_us, to_us));
}

const struct rho_imm *rho_hypotheses_filter_at(struct rho_hypotheses *pool,
                                               const struct rho_hypothesis *at, int64_t time_us)
{
    if (at->time_us == time_us) {
        return &at->imm;
    }
    pool->scratch = at->imm;
    return rho_hypotheses_predict_one_filter_unmixed(pool, &pool->scratch, at->time_us, time_us) ==
                   RHO_OK
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

/* Predicts a hypothesis' filter without process noise and mixing; its time stays as it was. */
static enum rho_status predict_filter_without_noise(struct rho_hypotheses *pool,
                                                    struct rho_hypothesis *at, int64_t time_us)
{
    struct rho_imm_step step = *cached_step_of_interval(pool, at->time_us, time_us);
    memset(step.noise, 0, sizeof step.noise);
    memset(step.quiet_noise, 0, sizeof step.quiet_noise);
    return rho_imm_predict_unmixed(&at->imm, &step);
}

/* Predicts all hypotheses of a slot, and removes those that cannot be predicted. */
static enum rho_status predict_hypotheses_or_remove(struct rho_hypotheses *pool, uint16_t slot,
                                                    int64_t time_us, int is_without_noise)
{
    if (!pool) {
        return RHO_ERROR_NULL;
    }
    if (!rho_hypotheses_has_any_in_slot(pool, slot)) {
        return RHO_ERROR_STATE;
    }
    unsigned left = 0;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        uint16_t node = pool->node_of[slot][i];
        struct rho_hypothesis *at = &pool->nodes[node];
        if (at->time_us != time_us &&
            (is_without_noise
                 ? predict_filter_without_noise(pool, at, time_us)
                 : rho_imm_predict(
                       &at->imm, cached_step_of_interval(pool, at->time_us, time_us))) != RHO_OK) {
            rho_hypotheses_push_free_node(pool, node);
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
        (void)rho_hypotheses_rebase_weights(pool, slot); /* the best hypothesis was removed */
    }
    return RHO_OK;
}

enum rho_status rho_hypotheses_predict(struct rho_hypotheses *pool, uint16_t slot, int64_t time_us)
{
    return predict_hypotheses_or_remove(pool, slot, time_us, 0);
}

enum rho_status rho_hypotheses_predict_noiseless(struct rho_hypotheses *pool, uint16_t slot,
                                                 int64_t time_us)
{
    return predict_hypotheses_or_remove(pool, slot, time_us, 1);
}

/* ---- the mean -------------------------------------------------------------------------------- */

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

/*
 * A model's state minus the place that sums are about, and this deviation times the model's share.
 */
struct deviation {
    float deviation[RHO_KALMAN_STATES], scaled[RHO_KALMAN_STATES];
};

/* Sets element i of both models' deviations, and adds them to the sums by their shares. */
static inline void set_deviations_add_weighted_to_sums(struct moment_sums *sums,
                                                       const struct rho_imm *imm,
                                                       float steady_share, float manoeuvre_share,
                                                       struct deviation *steady,
                                                       struct deviation *manoeuvre, int i)
{
    steady->deviation[i] = imm->steady.state[i] - sums->about[i];
    manoeuvre->deviation[i] = imm->state[i] - sums->about[i];
    steady->scaled[i] = steady_share * steady->deviation[i];
    manoeuvre->scaled[i] = manoeuvre_share * manoeuvre->deviation[i];
    sums->deviation[i] += steady->scaled[i] + manoeuvre->scaled[i];
}

static inline void add_deviation_product(float *restrict out,
                                         const struct deviation *restrict steady,
                                         const struct deviation *restrict manoeuvre, int i, int j)
{
    out[RHO_AT(i, j)] +=
        steady->scaled[i] * steady->deviation[j] + manoeuvre->scaled[i] * manoeuvre->deviation[j];
}

/*
 * Adds products of both models' deviations in the plane. Written out like the functions below: a
 * loop would take three times as long.
 */
static inline void add_plane_deviation_products(float *restrict out,
                                                const struct deviation *restrict steady,
                                                const struct deviation *restrict manoeuvre)
{
    add_deviation_product(out, steady, manoeuvre, 0, 0);
    add_deviation_product(out, steady, manoeuvre, 1, 0);
    add_deviation_product(out, steady, manoeuvre, 1, 1);
    add_deviation_product(out, steady, manoeuvre, 3, 0);
    add_deviation_product(out, steady, manoeuvre, 3, 1);
    add_deviation_product(out, steady, manoeuvre, 3, 3);
    add_deviation_product(out, steady, manoeuvre, 4, 0);
    add_deviation_product(out, steady, manoeuvre, 4, 1);
    add_deviation_product(out, steady, manoeuvre, 4, 3);
    add_deviation_product(out, steady, manoeuvre, 4, 4);
}

static inline void add_height_deviation_products(float *restrict out,
                                                 const struct deviation *restrict steady,
                                                 const struct deviation *restrict manoeuvre)
{
    add_deviation_product(out, steady, manoeuvre, 2, 0);
    add_deviation_product(out, steady, manoeuvre, 2, 1);
    add_deviation_product(out, steady, manoeuvre, 2, 2);
    add_deviation_product(out, steady, manoeuvre, 3, 2);
    add_deviation_product(out, steady, manoeuvre, 4, 2);
    add_deviation_product(out, steady, manoeuvre, 5, 0);
    add_deviation_product(out, steady, manoeuvre, 5, 1);
    add_deviation_product(out, steady, manoeuvre, 5, 2);
    add_deviation_product(out, steady, manoeuvre, 5, 3);
    add_deviation_product(out, steady, manoeuvre, 5, 4);
    add_deviation_product(out, steady, manoeuvre, 5, 5);
}

static inline void add_model_covariances(float *restrict out, const struct rho_imm *restrict imm,
                                         int place, float steady_share, float manoeuvre_share)
{
    out[place] +=
        steady_share * imm->steady.covariance[place] + manoeuvre_share * imm->covariance[place];
}

/* Adds the covariances between x and y; add_axis_covariances adds those within an axis. */
static void add_plane_coupling_covariances(float *restrict out, const struct rho_imm *restrict imm,
                                           float steady_share, float manoeuvre_share)
{
    add_model_covariances(out, imm, RHO_AT(1, 0), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(3, 1), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(4, 0), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(4, 3), steady_share, manoeuvre_share);
}

/* Adds the covariances that couple x and y with the height. */
static void add_height_coupling_covariances(float *restrict out, const struct rho_imm *restrict imm,
                                            float steady_share, float manoeuvre_share)
{
    add_model_covariances(out, imm, RHO_AT(2, 0), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(2, 1), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(3, 2), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(4, 2), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(5, 0), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(5, 1), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(5, 3), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(5, 4), steady_share, manoeuvre_share);
}

static void add_axis_covariances(float *restrict out, const struct rho_imm *restrict imm,
                                 int has_height, float steady_share, float manoeuvre_share)
{
    add_model_covariances(out, imm, RHO_AT(0, 0), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(1, 1), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(3, 0), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(3, 3), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(4, 1), steady_share, manoeuvre_share);
    add_model_covariances(out, imm, RHO_AT(4, 4), steady_share, manoeuvre_share);
    if (has_height) {
        add_model_covariances(out, imm, RHO_AT(2, 2), steady_share, manoeuvre_share);
        add_model_covariances(out, imm, RHO_AT(5, 2), steady_share, manoeuvre_share);
        add_model_covariances(out, imm, RHO_AT(5, 5), steady_share, manoeuvre_share);
    }
}

/* Adds both models of one hypothesis, weighted by its share, to the sums. */
static void add_hypothesis_moments(struct moment_sums *sums, const struct rho_imm *imm, float share)
{
    const float m = share * imm->probability, s = share - m;
    const int has_height = sums->has_height;
    struct deviation steady, manoeuvre;
    set_deviations_add_weighted_to_sums(sums, imm, s, m, &steady, &manoeuvre, 0);
    set_deviations_add_weighted_to_sums(sums, imm, s, m, &steady, &manoeuvre, 1);
    set_deviations_add_weighted_to_sums(sums, imm, s, m, &steady, &manoeuvre, 3);
    set_deviations_add_weighted_to_sums(sums, imm, s, m, &steady, &manoeuvre, 4);
    add_plane_deviation_products(sums->covariance, &steady, &manoeuvre);
    if (has_height) {
        set_deviations_add_weighted_to_sums(sums, imm, s, m, &steady, &manoeuvre, 2);
        set_deviations_add_weighted_to_sums(sums, imm, s, m, &steady, &manoeuvre, 5);
        add_height_deviation_products(sums->covariance, &steady, &manoeuvre);
    }
    add_axis_covariances(sums->covariance, imm, has_height, s, m);
    if (imm->is_coupled) {
        add_plane_coupling_covariances(sums->covariance, imm, s, m);
    }
    if (imm->is_coupled && has_height) {
        add_height_coupling_covariances(sums->covariance, imm, s, m);
    }
    sums->share += share;
    sums->maneuver += m;
    for (int axis = 0; axis < 3; axis++) {
        sums->accel_mps2[axis] += m * imm->state[RHO_KALMAN_STATES + axis];
    }
}

/* Sums moments over a slot's hypotheses at time_us, without those that cannot be moved there. */
static void sum_moments_of_slot(struct rho_hypotheses *pool, uint16_t slot, int64_t time_us,
                                struct moment_sums *sums)
{
    int is_first = 1;
    memset(sums, 0, sizeof *sums);
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_imm *imm = &pool->nodes[pool->node_of[slot][i]].imm;
        sums->has_height |= imm->covariance[RHO_AT(2, 2)] > 0.0f;
    }
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
            add_hypothesis_moments(sums, imm, at->share);
        }
    }
}

enum rho_status rho_hypotheses_estimate(struct rho_hypotheses *pool, uint16_t slot, int64_t time_us,
                                        struct rho_hypotheses_estimate *estimate)
{
    struct moment_sums sums;
    if (!pool || !estimate) {
        return RHO_ERROR_NULL;
    }
    if (!rho_hypotheses_has_any_in_slot(pool, slot)) {
        return RHO_ERROR_STATE;
    }
    sum_moments_of_slot(pool, slot, time_us, &sums);
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
