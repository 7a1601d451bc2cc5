/* SPDX-License-Identifier: MIT */
/* hypotheses_scan: scores a scan's plots with a track's hypotheses, which it expands and prunes. */
#include <float.h>
#include <string.h>

#include "hypotheses_pool.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/imm_notch.h"

/* ln of the clutter's density in all measured dimensions, with two or three axes of position. */
static float log_clutter_density(const struct rho_hypotheses_clutter *clutter, uint32_t measures,
                                 int num_axes)
{
    return clutter->log_per_m2 + (num_axes > 2 ? clutter->log_per_m : 0.0f) +
           (measures & RHO_MEASURES_VELOCITY ? (float)num_axes * clutter->log_per_mps : 0.0f) +
           (measures & RHO_MEASURES_RANGE_RATE ? clutter->log_per_range_rate : 0.0f);
}

/* A plot, and ln of pd over the clutter's density without (level) and with (high) a height. */
struct offered_plot {
    const struct rho_imm_plot *seen;
    int64_t time_us;
    float level, high;
    int16_t row;
};

/* Inserts a plot into a list of best plots, behind equals. Returns the weight with the plot. */
static inline float list_candidate(struct rho_hypothesis *at, float gain_nat, float probability,
                                   int16_t row)
{
    struct rho_hypotheses_candidate *list = at->candidates;
    unsigned place = at->num_candidates;
    if (place < RHO_HYPOTHESES_CHILDREN) {
        at->num_candidates++;
    } else if (!(gain_nat > list[--place].gain_nat)) {
        return at->weight_nat + gain_nat;
    }
    for (; place > 0 && list[place - 1].gain_nat < gain_nat; place--) {
        list[place] = list[place - 1];
    }
    list[place] = (struct rho_hypotheses_candidate){gain_nat, probability, row};
    return at->weight_nat + gain_nat;
}

/*
 * Scores a plot with each hypothesis in turn, at the plot's own time. Returns the weight of the
 * best hypothesis with the plot; -FLT_MAX: the plot is in no gate.
 */
static float score_by_hypotheses(struct rho_hypotheses *pool, uint16_t slot,
                                 const struct offered_plot *offer)
{
    const uint16_t *nodes = pool->node_of[slot];
    /* most often all hypotheses have the plot's time: range rates are predicted once a scan */
    const int has_rates = pool->nodes[nodes[0]].time_us == offer->time_us;
    if (has_rates && (offer->seen->measures & RHO_MEASURES_RANGE_RATE) &&
        (pool->gate_slot != slot || pool->gate_variance_m2 > 0.0f)) {
        pool->gate_variance_m2 = 0.0f;
        pool->gate_slot = slot;
        for (unsigned i = 0; i < pool->num_of[slot]; i++) {
            rho_imm_predict_range_rates(&pool->opened.rates[i], &pool->nodes[nodes[i]].imm,
                                        offer->seen->sensor);
        }
    }
    struct rho_imm_match match;
    float best = -FLT_MAX;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        struct rho_hypothesis *at = &pool->nodes[nodes[i]];
        int is_in_gate;
        if (has_rates && at->time_us == offer->time_us) {
            is_in_gate =
                rho_imm_score_with_rates(&at->imm, &pool->opened.rates[i], offer->seen, &match);
        } else {
            const struct rho_imm *imm = rho_hypotheses_filter_at(pool, at, offer->time_us);
            is_in_gate = imm && rho_imm_score_plot(imm, offer->seen, &match);
        }
        if (is_in_gate) {
            const float pd_over_clutter = match.num_axes > 2 ? offer->high : offer->level;
            const float score = list_candidate(at, pd_over_clutter + match.log_likelihood,
                                               match.probability, offer->row);
            best = score > best ? score : best;
        }
    }
    return best;
}

/*
 * True where a plot can be scored in gates prepared at the hypotheses' time; prepares them for the
 * plot's noise if they are for another noise or slot.
 */
static int ensure_gates(struct rho_hypotheses *pool, uint16_t slot, const struct rho_imm_plot *seen,
                        int64_t time_us)
{
    const float variance_m2 = seen->position.variance_m2[0];
    const int has_z = seen->position.has_z;
    if (!seen->position.is_isotropic || pool->nodes[pool->node_of[slot][0]].time_us != time_us ||
        (seen->measures & (RHO_MEASURES_VELOCITY | RHO_MEASURES_RANGE_RATE)) != 0) {
        return 0;
    }
    if (pool->gate_slot == slot && pool->gate_has_z == has_z &&
        !(variance_m2 < pool->gate_variance_m2 || variance_m2 > pool->gate_variance_m2)) {
        return pool->gate_is_usable;
    }
    pool->gate_variance_m2 = variance_m2;
    pool->gate_slot = slot;
    pool->gate_has_z = (uint8_t)has_z;
    pool->gate_is_usable = 1;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][i]];
        pool->gate_is_usable =
            pool->gate_is_usable && at->time_us == time_us &&
            rho_imm_prepare_gate(&pool->opened.gates[i], &at->imm, variance_m2, has_z);
    }
    return pool->gate_is_usable;
}

/* Scores a plot of a position alone in the prepared gates; returns as score_by_hypotheses. */
static float score_in_gates(struct rho_hypotheses *pool, uint16_t slot,
                            const struct offered_plot *offer)
{
    const uint16_t *nodes = pool->node_of[slot];
    float best = -FLT_MAX;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_imm_gate *gate = &pool->opened.gates[i];
        struct rho_hypothesis *at = &pool->nodes[nodes[i]];
        const float pd_over_clutter = gate->num_axes > 2 ? offer->high : offer->level;
        /* gain that a plot must exceed to enter the hypothesis' list or to be better than `best` */
        float least = -FLT_MAX, log_likelihood, probability;
        if (at->num_candidates == RHO_HYPOTHESES_CHILDREN) {
            const float others = best - at->weight_nat;
            const float last = at->candidates[RHO_HYPOTHESES_CHILDREN - 1].gain_nat;
            least = last < others ? last : others;
        }
        if (rho_imm_score_in_gate(gate, offer->seen->position.place_m, least - pd_over_clutter,
                                  &log_likelihood, &probability)) {
            const float made =
                list_candidate(at, pd_over_clutter + log_likelihood, probability, offer->row);
            best = made > best ? made : best;
        }
    }
    return best;
}

int rho_hypotheses_score_plot(struct rho_hypotheses *pool, uint16_t slot,
                              const struct rho_imm_plot *seen, int64_t time_us, int16_t row,
                              float log_pd, const struct rho_hypotheses_clutter *clutter,
                              float *best_weight_nat)
{
    if (!rho_hypotheses_is_open(pool, slot)) {
        return 0;
    }
    const struct offered_plot offer = {
        .seen = seen,
        .time_us = time_us,
        .level = log_pd - log_clutter_density(clutter, seen->measures, 2),
        .high = log_pd - log_clutter_density(clutter, seen->measures, 3),
        .row = row,
    };
    const float best = ensure_gates(pool, slot, seen, time_us)
                           ? score_in_gates(pool, slot, &offer)
                           : score_by_hypotheses(pool, slot, &offer);
    if (!(best > -FLT_MAX)) {
        return 0;
    }
    *best_weight_nat = best;
    return 1;
}

int rho_hypotheses_has_candidates(const struct rho_hypotheses *pool, uint16_t slot)
{
    unsigned candidates = 0;
    for (unsigned i = 0; i < rho_hypotheses_count(pool, slot); i++) {
        candidates += pool->nodes[pool->node_of[slot][i]].num_candidates;
    }
    return candidates > 0;
}

/* True where two children have the same plots in the last scans. */
static inline int have_same_picks(const struct rho_hypotheses *pool, const uint16_t *nodes,
                                  const struct rho_hypotheses_child *a,
                                  const struct rho_hypotheses_child *b)
{
    if (a->row != b->row) {
        return 0;
    }
    const int16_t *picks = pool->nodes[nodes[a->parent]].picks;
    const int16_t *others = pool->nodes[nodes[b->parent]].picks;
    int differ = 0;
    for (int k = 1; k < RHO_HYPOTHESES_MEMORY; k++) {
        differ |= picks[k] ^ others[k];
    }
    return differ == 0;
}

/*
 * Inserts a child into the list of the heaviest, of equals behind the earlier ones; the lightest
 * drops out of a full list. Of two children with the same recent plots the heavier one is kept.
 * Returns the list's length.
 */
static unsigned insert_child(struct rho_hypotheses *pool, const uint16_t *nodes, unsigned num,
                             const struct rho_hypotheses_child *child)
{
    struct rho_hypotheses_child *list = pool->children;
    unsigned gap = 0; /* entry that is overwritten */
    while (gap < num && !have_same_picks(pool, nodes, &list[gap], child)) {
        gap++;
    }
    if (gap < num && !(child->weight_nat > list[gap].weight_nat)) {
        return num;
    }
    const unsigned more = gap == num && num < RHO_HYPOTHESES_OF_TRACK;
    gap = gap < RHO_HYPOTHESES_OF_TRACK ? gap : RHO_HYPOTHESES_OF_TRACK - 1;
    for (; gap > 0 && list[gap - 1].weight_nat < child->weight_nat; gap--) {
        list[gap] = list[gap - 1];
    }
    list[gap] = *child;
    return num + more;
}

/* True where a child of weight_nat is too light for the list of the heaviest children. */
static inline int is_too_light(const struct rho_hypotheses *pool, unsigned num, float weight_nat)
{
    return num == RHO_HYPOTHESES_OF_TRACK && !(weight_nat > pool->children[num - 1].weight_nat);
}

/*
 * Lists the children that replace their parents, the heaviest first and none much lighter, without
 * updating any filter, and makes room for them in the pool. Returns their number.
 */
static unsigned select_children(struct rho_hypotheses *pool, uint16_t slot,
                                const struct rho_hypotheses_scan *scan)
{
    const uint16_t *nodes = pool->node_of[slot];
    unsigned num = 0;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_hypothesis *at = &pool->nodes[nodes[i]];
        struct rho_hypotheses_child child = {.parent = (uint8_t)i};
        for (unsigned k = 0; k < at->num_candidates; k++) {
            child.weight_nat = at->weight_nat + at->candidates[k].gain_nat;
            if (is_too_light(pool, num, child.weight_nat)) {
                break; /* the candidates that follow are lighter still */
            }
            child.row = at->candidates[k].row;
            child.candidate = (uint8_t)k;
            const int16_t *claims = scan->claims;
            if (!claims || claims[child.row] < 0 || claims[child.row] == scan->own) {
                num = insert_child(pool, nodes, num, &child);
            }
        }
        child.weight_nat = at->weight_nat + scan->log_miss;
        child.row = RHO_HYPOTHESES_MISS;
        if (!is_too_light(pool, num, child.weight_nat)) {
            num = insert_child(pool, nodes, num, &child);
        }
    }
    const float least = pool->children[0].weight_nat + RHO_HYPOTHESES_WEIGHT_MIN;
    while (num > 1 && pool->children[num - 1].weight_nat < least) {
        num--;
    }
    return rho_hypotheses_make_room(pool, slot, num);
}

/* Loss of weight, nat, for excess speed: half its square in sigmas, by the likelier model. */
static float excess_speed_loss_nat(const struct rho_imm *imm, float speed_max_mps)
{
    const float *state = imm->probability > 0.5f ? imm->state : imm->steady.state;
    const float *covariance = imm->probability > 0.5f ? imm->covariance : imm->steady.covariance;
    const float *v = &state[3];
    const float speed2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    float variance = 0.0f; /* variance of the speed, times the squared speed */
    if (!(speed_max_mps > 0.0f) || !(speed2 > speed_max_mps * speed_max_mps)) {
        return 0.0f;
    }
    for (int i = 0; i < 3; i++) {
        variance += v[i] * v[i] * covariance[RHO_AT(3 + i, 3 + i)];
        for (int j = 0; j < i; j++) {
            variance += 2.0f * v[i] * v[j] * covariance[RHO_AT(3 + i, 3 + j)];
        }
    }
    const float excess_mps = rho_sqrt(speed2) - speed_max_mps;
    const float loss = 0.5f * excess_mps * excess_mps * speed2;
    return loss < SPEED_LOSS_MAX_NAT * variance ? loss / variance : SPEED_LOSS_MAX_NAT;
}

/*
 * Extends a hypothesis by one child: updates filter, history of plots and weight. A plot whose
 * update fails is weighed as a miss, and the filter becomes `before`.
 */
static void advance_hypothesis(struct rho_hypotheses *pool, struct rho_hypothesis *at,
                               const struct rho_imm *before, const struct rho_hypotheses_scan *scan,
                               const struct rho_hypotheses_child *child,
                               const struct rho_imm_plot *seen)
{
    const float as_miss = at->weight_nat + scan->log_miss;
    int16_t row = child->row;
    if (row >= 0) {
        const struct rho_imm_match match = {.probability =
                                                at->candidates[child->candidate].probability};
        const int64_t time_us = scan->time_us + scan->plots[row].offset_us;
        if (rho_hypotheses_predict_filter(pool, &at->imm, at->time_us, time_us) == RHO_OK &&
            rho_imm_update(&at->imm, &pool->model, seen, &match) == RHO_OK) {
            at->time_us = time_us;
        } else {
            at->imm = *before;
            pool->updates_refused = rho_count(pool->updates_refused, 1);
            row = RHO_HYPOTHESES_MISS;
        }
    }
    for (int k = 1; k < RHO_HYPOTHESES_MEMORY; k++) {
        at->picks[k - 1] = at->picks[k];
    }
    at->picks[RHO_HYPOTHESES_MEMORY - 1] = row;
    at->weight_nat = row == child->row ? child->weight_nat : as_miss;
    if (row >= 0) {
        at->weight_nat -= excess_speed_loss_nat(&at->imm, pool->model.speed_max_mps);
    } else if (RHO_DOPPLER_NOTCH && scan->look && scan->log_miss < 0.0f) {
        rho_imm_update_by_miss(&at->imm, scan->sensor, scan->look);
    }
}

/*
 * Replaces a slot's hypotheses by their children. Nodes of parents without children are freed; a
 * parent's last child takes its node, the others get copies.
 */
static void replace_parents(struct rho_hypotheses *pool, uint16_t slot,
                            const struct rho_hypotheses_scan *scan, unsigned num)
{
    uint8_t uses[RHO_HYPOTHESES_OF_TRACK] = {0};
    uint16_t nodes[RHO_HYPOTHESES_OF_TRACK];
    struct rho_imm_plot seen;
    int16_t opened = RHO_HYPOTHESES_MISS;
    for (unsigned i = 0; i < num; i++) {
        uses[pool->children[i].parent]++;
    }
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        if (uses[i] == 0) {
            rho_hypotheses_push_node(pool, pool->node_of[slot][i]);
        }
    }
    for (unsigned i = 0; i < num; i++) {
        const struct rho_hypotheses_child *child = &pool->children[i];
        nodes[i] = pool->node_of[slot][child->parent];
        struct rho_hypothesis *parent = &pool->nodes[nodes[i]];
        const struct rho_imm *before = &parent->imm; /* the filter in case the update fails */
        /* consecutive children often have the same plot */
        if (child->row >= 0 && child->row != opened) {
            opened = child->row;
            rho_imm_prepare_plot(&seen, &scan->plots[opened], scan->measures, scan->sensor);
        }
        if (--uses[child->parent] > 0) {
            nodes[i] = rho_hypotheses_pop_node(pool);
            pool->nodes[nodes[i]] = *parent;
        } else if (child->row >= 0) {
            pool->scratch = parent->imm;
            before = &pool->scratch;
        }
        advance_hypothesis(pool, &pool->nodes[nodes[i]], before, scan, child, &seen);
    }
    memcpy(pool->node_of[slot], nodes, num * sizeof nodes[0]);
    pool->num_of[slot] = (uint8_t)num;
}

/* Sorts a slot's hypotheses, subtracts the best weight, which it returns, and prunes the light. */
static float prune_slot(struct rho_hypotheses *pool, uint16_t slot)
{
    uint16_t *nodes = pool->node_of[slot];
    for (unsigned i = 1; i < pool->num_of[slot]; i++) {
        uint16_t node = nodes[i];
        unsigned place = i;
        for (; place > 0 && pool->nodes[nodes[place - 1]].weight_nat < pool->nodes[node].weight_nat;
             place--) {
            nodes[place] = nodes[place - 1];
        }
        nodes[place] = node;
    }
    const float best = rho_hypotheses_rebase_weights(pool, slot);
    for (unsigned i = pool->num_of[slot] - 1u;
         pool->nodes[nodes[i]].weight_nat < RHO_HYPOTHESES_WEIGHT_MIN; i--) {
        rho_hypotheses_push_node(pool, nodes[i]);
        pool->num_of[slot] = (uint8_t)i;
    }
    return best;
}

enum rho_status rho_hypotheses_commit(struct rho_hypotheses *pool, uint16_t slot,
                                      const struct rho_hypotheses_scan *scan,
                                      struct rho_hypotheses_outcome *outcome)
{
    if (!rho_hypotheses_is_open(pool, slot)) {
        return RHO_ERROR_STATE;
    }
    const float before = rho_hypotheses_sum_of_shares(pool, slot);
    replace_parents(pool, slot, scan, select_children(pool, slot, scan));
    const float best = prune_slot(pool, slot);
    outcome->row = pool->nodes[pool->node_of[slot][0]].picks[RHO_HYPOTHESES_MEMORY - 1];
    outcome->gain_nat = best + rho_log(rho_hypotheses_sum_of_shares(pool, slot) / before);
    return RHO_OK;
}

/* Moves a hypothesis to another time; scratch has the filter in case this or the update fails. */
static enum rho_status move_hypothesis(struct rho_hypotheses *pool, struct rho_hypothesis *at,
                                       int64_t time_us)
{
    pool->scratch = at->imm;
    const enum rho_status status =
        rho_hypotheses_predict_filter(pool, &at->imm, at->time_us, time_us);
    if (status == RHO_OK) {
        at->time_us = time_us;
        pool->scratch = at->imm;
    }
    return status;
}

/* Ends an update with status `one`; returns RHO_OK where it or an earlier one did not fail. */
static enum rho_status end_update(struct rho_hypotheses *pool, struct rho_hypothesis *at,
                                  enum rho_status one, enum rho_status so_far)
{
    if (one != RHO_OK) {
        at->imm = pool->scratch;
        pool->updates_refused = rho_count(pool->updates_refused, 1);
    }
    return so_far == RHO_OK ? RHO_OK : one;
}

enum rho_status rho_hypotheses_update(struct rho_hypotheses *pool, uint16_t slot,
                                      const struct rho_imm_plot *seen, int64_t time_us)
{
    enum rho_status status = RHO_ERROR_VALUE;
    if (!rho_hypotheses_is_open(pool, slot)) {
        return RHO_ERROR_STATE;
    }
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][i]];
        struct rho_imm_match match;
        enum rho_status one = move_hypothesis(pool, at, time_us);
        if (one == RHO_OK) {
            /* a plot far from both predictions does not change the models' probabilities */
            if (!rho_imm_score_plot(&at->imm, seen, &match)) {
                match.probability = at->imm.probability;
            }
            one = rho_imm_update(&at->imm, &pool->model, seen, &match);
        }
        status = end_update(pool, at, one, status);
    }
    return status;
}

/* The filter of a hypothesis at the time of bearing i; NULL: it cannot be moved there. */
static const struct rho_imm *filter_at_bearing(struct rho_hypotheses *pool,
                                               const struct rho_hypothesis *at,
                                               const struct rho_bearing_scan *scan, unsigned i)
{
    return rho_hypotheses_filter_at(pool, at, scan->time_us + scan->bearings[i].offset_us);
}

int rho_hypotheses_score_bearing(struct rho_hypotheses *pool, uint16_t slot,
                                 const struct rho_weighed_bearings *look, unsigned i,
                                 float *density, float *variance_rad2)
{
    float sum = 0.0f, spread = 0.0f, shares = 0.0f, one, variance;
    for (unsigned k = 0; k < rho_hypotheses_count(pool, slot); k++) {
        const struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][k]];
        const struct rho_imm *imm = filter_at_bearing(pool, at, look->scan, i);
        shares += at->share;
        if (imm && rho_imm_score_bearing(imm, look, i, &one, &variance)) {
            sum += at->share * one;
            spread += at->share * one * variance;
        }
    }
    if (!(sum > 0.0f)) {
        return 0;
    }
    *density = sum / shares;
    *variance_rad2 = spread / sum;
    return 1;
}

enum rho_status rho_hypotheses_update_bearings(struct rho_hypotheses *pool, uint16_t slot,
                                               int64_t time_us,
                                               const struct rho_weighed_bearings *look)
{
    enum rho_status status = RHO_ERROR_VALUE;
    if (!rho_hypotheses_is_open(pool, slot)) {
        return RHO_ERROR_STATE;
    }
    for (unsigned k = 0; k < pool->num_of[slot]; k++) {
        struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][k]];
        struct rho_bearing_mix mixes[2] = {{.hit = 0.0f}, {.hit = 0.0f}};
        float gain_nat = 0.0f;
        for (unsigned i = 0; i < RHO_MAX_BEARINGS; i++) {
            const struct rho_imm *imm =
                look->weight[i] > 0.0f ? filter_at_bearing(pool, at, look->scan, i) : 0;
            if (imm) {
                rho_imm_mix_bearing(imm, look, i, mixes);
            }
        }
        enum rho_status one = move_hypothesis(pool, at, time_us);
        if (one == RHO_OK) {
            one = rho_imm_update_bearings(&at->imm, look, mixes, &gain_nat);
        }
        if (one == RHO_OK) {
            one = rho_imm_update_slope(&at->imm, &pool->model, &look->slope);
        }
        at->weight_nat += gain_nat;
        status = end_update(pool, at, one, status);
    }
    (void)prune_slot(pool, slot);
    return status;
}
