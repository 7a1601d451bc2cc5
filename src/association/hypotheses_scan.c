/* SPDX-License-Identifier: MIT */
/*
 * hypotheses_scan: hypotheses score the plots of a scan (gate_box.c begins it), and the best of
 * their children go on.
 */
#include <float.h>
#include <string.h>

#include "hypotheses_pool.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/imm_notch.h"

/* The most that a hypothesis loses at once for its speed. */
#define SPEED_LOSS_MAX_NAT 10.0f

/* ---- score ----------------------------------------------------------------------------------- */

/* ln of the clutter's density in two or three axes. */
static float log_clutter(const struct rho_hypotheses_clutter *clutter, uint32_t measures,
                         int num_axes)
{
    return clutter->log_per_m2 + (num_axes > 2 ? clutter->log_per_m : 0.0f) +
           (measures & RHO_MEASURES_VELOCITY ? (float)num_axes * clutter->log_per_mps : 0.0f) +
           (measures & RHO_MEASURES_RANGE_RATE ? clutter->log_per_range_rate : 0.0f);
}

/* A plot, and its pd over the clutter's density, ln: without and with heights. */
struct offer {
    const struct rho_imm_plot *seen;
    int64_t time_us;
    float level, high;
    int16_t row;
};

/*
 * Adds to the hypothesis' list of its best plots, of equals behind the earlier ones. Returns its
 * weight with the plot.
 */
static inline float note_candidate(struct rho_hypothesis *at, float gain_nat, float probability,
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

/* The range rates that the slot's hypotheses expect, kept while plots come. */
static void expect_range_rates(struct rho_hypotheses *pool, uint16_t slot,
                               const struct rho_sensor *sensor)
{
    if (pool->gate_slot == slot && !(pool->gate_variance_m2 > 0.0f)) {
        return;
    }
    pool->gate_variance_m2 = 0.0f;
    pool->gate_slot = slot;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        rho_imm_predict_rates(&pool->opened.rates[i], &pool->nodes[pool->node_of[slot][i]].imm,
                              sensor);
    }
}

/*
 * At the plot's own time. The expected range rates are known at the hypotheses' time alone; NULL:
 * not yet.
 */
static inline int score_hypothesis(struct rho_hypotheses *pool, const struct rho_imm_rates *rates,
                                   const struct rho_hypothesis *at, const struct offer *offer,
                                   struct rho_imm_match *match)
{
    if (rates && at->time_us == offer->time_us) {
        return rho_imm_score_plot_with_rates(&at->imm, rates, offer->seen, match);
    }
    const struct rho_imm *imm = rho_hypotheses_filter_at(pool, at, offer->time_us);
    return imm && rho_imm_score_plot(imm, offer->seen, match);
}

/* Scores one by one. Returns the weight of the best hypothesis with the plot; -FLT_MAX: none. */
static float score_each_hypothesis(struct rho_hypotheses *pool, uint16_t slot,
                                   const struct offer *offer)
{
    const uint16_t *nodes = pool->node_of[slot];
    struct rho_imm_match match;
    float best = -FLT_MAX;
    const struct rho_imm_rates *rates = 0;
    if (pool->nodes[nodes[0]].time_us == offer->time_us) { /* so are the others, most often */
        rates = pool->opened.rates;
        if (offer->seen->measures & RHO_MEASURES_RANGE_RATE) {
            expect_range_rates(pool, slot, offer->seen->sensor);
        }
    }
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        struct rho_hypothesis *at = &pool->nodes[nodes[i]];
        if (score_hypothesis(pool, rates ? &rates[i] : 0, at, offer, &match)) {
            const float pd_over_clutter = match.num_axes > 2 ? offer->high : offer->level;
            const float score = note_candidate(at, pd_over_clutter + match.log_likelihood,
                                               match.probability, offer->row);
            best = score > best ? score : best;
        }
    }
    return best;
}

/* The gates of all the slot's hypotheses at one time, kept while plots of the same noise come. */
static void open_gates(struct rho_hypotheses *pool, uint16_t slot, float variance_m2, int has_z,
                       int64_t time_us)
{
    pool->gate_variance_m2 = variance_m2;
    pool->gate_slot = slot;
    pool->gate_has_z = (uint8_t)has_z;
    pool->gate_is_usable = 1;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][i]];
        pool->gate_is_usable =
            pool->gate_is_usable && at->time_us == time_us &&
            rho_imm_open_gate(&pool->opened.gates[i], &at->imm, variance_m2, has_z);
    }
}

/* True where the plot can be scored in the open gates, which are at the hypotheses' time. */
static int fits_open_gates(struct rho_hypotheses *pool, uint16_t slot,
                           const struct rho_imm_plot *seen, int64_t time_us)
{
    const float variance_m2 = seen->position.variance_m2[0];
    if (!seen->position.is_isotropic || pool->nodes[pool->node_of[slot][0]].time_us != time_us ||
        (seen->measures & (RHO_MEASURES_VELOCITY | RHO_MEASURES_RANGE_RATE)) != 0) {
        return 0;
    }
    if (pool->gate_slot != slot || pool->gate_has_z != seen->position.has_z ||
        variance_m2 < pool->gate_variance_m2 || variance_m2 > pool->gate_variance_m2) {
        open_gates(pool, slot, variance_m2, seen->position.has_z, time_us);
    }
    return pool->gate_is_usable;
}

/* A gain no better than this changes neither the hypothesis' list nor the best. */
static inline float least_useful_gain(const struct rho_hypothesis *at, float best)
{
    if (at->num_candidates < RHO_HYPOTHESES_CHILDREN) {
        return -FLT_MAX;
    }
    const float others = best - at->weight_nat;
    const float last = at->candidates[RHO_HYPOTHESES_CHILDREN - 1].gain_nat;
    return last < others ? last : others;
}

/*
 * A place alone; base: ln of pd over the clutter's density. Returns the better one of `best` and
 * the weight with the plot.
 */
static inline float score_in_gate(struct rho_hypothesis *at, const struct rho_imm_gate *gate,
                                  const float place_m[3], int16_t row, float base, float best)
{
    float log_likelihood, probability;
    if (!rho_imm_score_in_gate(gate, place_m, least_useful_gain(at, best) - base, &log_likelihood,
                               &probability)) {
        return best;
    }
    const float made = note_candidate(at, base + log_likelihood, probability, row);
    return made > best ? made : best;
}

/* The same as score_each_hypothesis, in the gates that are open. */
static float score_in_gates(struct rho_hypotheses *pool, uint16_t slot, const struct offer *offer)
{
    const uint16_t *nodes = pool->node_of[slot];
    float best = -FLT_MAX;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_imm_gate *gate = &pool->opened.gates[i];
        best = score_in_gate(&pool->nodes[nodes[i]], gate, offer->seen->position.place_m,
                             offer->row, gate->num_axes > 2 ? offer->high : offer->level, best);
    }
    return best;
}

int rho_hypotheses_score_plot(struct rho_hypotheses *pool, uint16_t slot,
                              const struct rho_imm_plot *seen, int64_t time_us, int16_t row,
                              float log_pd, const struct rho_hypotheses_clutter *clutter,
                              float *gain_nat)
{
    if (!pool || !seen || !clutter || !gain_nat || !rho_hypotheses_is_open(pool, slot)) {
        return 0;
    }
    const struct offer offer = {
        .seen = seen,
        .time_us = time_us,
        .level = log_pd - log_clutter(clutter, seen->measures, 2),
        .high = log_pd - log_clutter(clutter, seen->measures, 3),
        .row = row,
    };
    const float best = fits_open_gates(pool, slot, seen, time_us)
                           ? score_in_gates(pool, slot, &offer)
                           : score_each_hypothesis(pool, slot, &offer);
    if (!(best > -FLT_MAX)) {
        return 0;
    }
    *gain_nat = best;
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

/* ---- commit ---------------------------------------------------------------------------------- */

static int is_free_plot(const struct rho_hypotheses_scan *scan, int16_t row)
{
    return !scan->claims || scan->claims[row] < 0 || scan->claims[row] == scan->own;
}

/* The same plots in the last scans: the heavier one has the likelier history. */
static inline int has_same_plots(const struct rho_hypotheses *pool, const uint16_t *nodes,
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
 * Adds to the list of the heaviest, of equals behind the earlier ones; the lightest falls out of a
 * full list. Of two that are the same the heavier one stays.
 */
static unsigned insert_child(struct rho_hypotheses *pool, const uint16_t *nodes, unsigned num,
                             const struct rho_hypotheses_child *child)
{
    struct rho_hypotheses_child *list = pool->children;
    unsigned gap = 0; /* what makes room */
    while (gap < num && !has_same_plots(pool, nodes, &list[gap], child)) {
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

/* True where a child of that weight would not enter the list. */
static inline int is_too_light(const struct rho_hypotheses *pool, unsigned num, float weight_nat)
{
    return num == RHO_HYPOTHESES_OF_TRACK && !(weight_nat > pool->children[num - 1].weight_nat);
}

/* The heaviest children, the heaviest first. No filter has been touched yet. */
static unsigned expand_children(struct rho_hypotheses *pool, uint16_t slot,
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
                break; /* so are the others, which come behind it */
            }
            child.row = at->candidates[k].row;
            child.candidate = (uint8_t)k;
            if (is_free_plot(scan, child.row)) {
                num = insert_child(pool, nodes, num, &child);
            }
        }
        child.weight_nat = at->weight_nat + scan->log_miss;
        child.row = RHO_HYPOTHESES_MISS;
        if (!is_too_light(pool, num, child.weight_nat)) {
            num = insert_child(pool, nodes, num, &child);
        }
    }
    return num;
}

/* The children that go on: none much lighter than the best. */
static unsigned choose_children(struct rho_hypotheses *pool, uint16_t slot,
                                const struct rho_hypotheses_scan *scan)
{
    unsigned num = expand_children(pool, slot, scan);
    const float least = pool->children[0].weight_nat + RHO_HYPOTHESES_WEIGHT_MIN;
    while (num > 1 && pool->children[num - 1].weight_nat < least) {
        num--;
    }
    return rho_hypotheses_make_room(pool, slot, num);
}

/* A refused update leaves the filter as it was predicted: as `before`. */
static int16_t take_plot(struct rho_hypotheses *pool, struct rho_hypothesis *at,
                         const struct rho_imm *before, const struct rho_imm_plot *seen,
                         int64_t time_us, const struct rho_imm_match *match, int16_t row)
{
    if (rho_hypotheses_move_filter(pool, &at->imm, at->time_us, time_us) == RHO_OK &&
        rho_imm_update(&at->imm, &pool->model, seen, match) == RHO_OK) {
        at->time_us = time_us;
        return row;
    }
    at->imm = *before;
    pool->updates_refused = rho_count(pool->updates_refused, 1);
    return RHO_HYPOTHESES_MISS;
}

/*
 * Loss of an estimate faster than any target, nat: half the squared excess in standard deviations
 * of the speed. By the likelier model.
 */
static float loss_of_excess_speed(const struct rho_imm *imm, float most_mps)
{
    const float *state = imm->probability > 0.5f ? imm->state : imm->steady.state;
    const float *covariance = imm->probability > 0.5f ? imm->covariance : imm->steady.covariance;
    const float *v = &state[3];
    const float speed2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    float variance = 0.0f; /* times the squared speed */
    if (!(most_mps > 0.0f) || !(speed2 > most_mps * most_mps)) {
        return 0.0f;
    }
    for (int i = 0; i < 3; i++) {
        variance += v[i] * v[i] * covariance[RHO_AT(3 + i, 3 + i)];
        for (int j = 0; j < i; j++) {
            variance += 2.0f * v[i] * v[j] * covariance[RHO_AT(3 + i, 3 + j)];
        }
    }
    const float excess_mps = rho_sqrt(speed2) - most_mps;
    const float loss = 0.5f * excess_mps * excess_mps * speed2;
    return loss < SPEED_LOSS_MAX_NAT * variance ? loss / variance : SPEED_LOSS_MAX_NAT;
}

/* A refused update weighs as a miss. Weights are still those of the scan. */
static void advance_hypothesis(struct rho_hypotheses *pool, struct rho_hypothesis *at,
                               const struct rho_imm *before, const struct rho_hypotheses_scan *scan,
                               const struct rho_hypotheses_child *child,
                               const struct rho_imm_plot *seen)
{
    const float as_miss = at->weight_nat + scan->log_miss;
    int16_t row = child->row;
    if (row >= 0) {
        const struct rho_hypotheses_candidate *chosen = &at->candidates[child->candidate];
        const struct rho_imm_match match = {.probability = chosen->probability};
        row = take_plot(pool, at, before, seen, scan->time_us + scan->plots[row].offset_us, &match,
                        row);
    }
    for (int k = 1; k < RHO_HYPOTHESES_MEMORY; k++) {
        at->picks[k - 1] = at->picks[k];
    }
    at->picks[RHO_HYPOTHESES_MEMORY - 1] = row;
    at->weight_nat = row == child->row ? child->weight_nat : as_miss;
    if (row >= 0) {
        at->weight_nat -= loss_of_excess_speed(&at->imm, pool->model.speed_max_mps);
    } else if (RHO_DOPPLER_NOTCH && scan->look && scan->log_miss < 0.0f) {
        rho_imm_miss(&at->imm, scan->sensor, scan->look);
    }
}

/*
 * Advances a copy, while the parent has more children; the last child takes the parent's node,
 * whose filter is kept in case the update is refused.
 */
static uint16_t advance_child(struct rho_hypotheses *pool, uint16_t parent, int is_last,
                              const struct rho_hypotheses_scan *scan,
                              const struct rho_hypotheses_child *child,
                              const struct rho_imm_plot *seen)
{
    struct rho_hypothesis *from = &pool->nodes[parent];
    if (!is_last) {
        const uint16_t node = rho_hypotheses_allot_node(pool);
        pool->nodes[node] = *from;
        advance_hypothesis(pool, &pool->nodes[node], &from->imm, scan, child, seen);
        return node;
    }
    if (child->row >= 0) {
        pool->scratch = from->imm;
    }
    advance_hypothesis(pool, from, &pool->scratch, scan, child, seen);
    return parent;
}

/*
 * Parents without children give their nodes back; the others' last child takes the node, the others
 * copies of it.
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
            rho_hypotheses_release_node(pool, pool->node_of[slot][i]);
        }
    }
    for (unsigned i = 0; i < num; i++) {
        const struct rho_hypotheses_child *child = &pool->children[i];
        const int is_last = --uses[child->parent] == 0;
        if (child->row >= 0 && child->row != opened) { /* often it is that of the one before */
            opened = child->row;
            rho_imm_open_plot(&seen, &scan->plots[opened], scan->measures, scan->sensor);
        }
        nodes[i] =
            advance_child(pool, pool->node_of[slot][child->parent], is_last, scan, child, &seen);
    }
    memcpy(pool->node_of[slot], nodes, num * sizeof nodes[0]);
    pool->num_of[slot] = (uint8_t)num;
}

/*
 * Sorts: the best is first and weighs 0, and those much lighter are removed. Returns the weight
 * that the best had.
 */
static float sort_and_prune(struct rho_hypotheses *pool, uint16_t slot)
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
        rho_hypotheses_release_node(pool, nodes[i]);
        pool->num_of[slot] = (uint8_t)i;
    }
    return best;
}

enum rho_status rho_hypotheses_commit(struct rho_hypotheses *pool, uint16_t slot,
                                      const struct rho_hypotheses_scan *scan,
                                      struct rho_hypotheses_outcome *outcome)
{
    if (!pool || !scan || !outcome) {
        return RHO_ERROR_NULL;
    }
    if (!rho_hypotheses_is_open(pool, slot)) {
        return RHO_ERROR_STATE;
    }
    const float before = rho_hypotheses_sum_of_shares(pool, slot);
    replace_parents(pool, slot, scan, choose_children(pool, slot, scan));
    const float best = sort_and_prune(pool, slot);
    outcome->row = pool->nodes[pool->node_of[slot][0]].picks[RHO_HYPOTHESES_MEMORY - 1];
    outcome->gain_nat = best + rho_log(rho_hypotheses_sum_of_shares(pool, slot) / before);
    return RHO_OK;
}

/* ---- certain plots --------------------------------------------------------------------------- */

/* Moves a hypothesis to another time. 0: it cannot be moved, and stays as it is. */
static int move_to_time(struct rho_hypotheses *pool, struct rho_hypothesis *at, int64_t time_us)
{
    pool->scratch = at->imm;
    if (rho_hypotheses_move_filter(pool, &at->imm, at->time_us, time_us) != RHO_OK) {
        at->imm = pool->scratch;
        return 0;
    }
    at->time_us = time_us;
    return 1;
}

static enum rho_status update_hypothesis(struct rho_hypotheses *pool, struct rho_hypothesis *at,
                                         const struct rho_imm_plot *seen, int64_t time_us)
{
    struct rho_imm_match match;
    if (!move_to_time(pool, at, time_us)) {
        return RHO_ERROR_VALUE;
    }
    /* far from both predictions, neither model is the likelier one */
    if (!rho_imm_score_plot(&at->imm, seen, &match)) {
        match.probability = at->imm.probability;
    }
    pool->scratch = at->imm;
    enum rho_status status = rho_imm_update(&at->imm, &pool->model, seen, &match);
    if (status != RHO_OK) {
        at->imm = pool->scratch;
    }
    return status;
}

enum rho_status rho_hypotheses_update(struct rho_hypotheses *pool, uint16_t slot,
                                      const struct rho_imm_plot *seen, int64_t time_us)
{
    enum rho_status status = RHO_ERROR_VALUE;
    if (!pool || !seen) {
        return RHO_ERROR_NULL;
    }
    if (!rho_hypotheses_is_open(pool, slot)) {
        return RHO_ERROR_STATE;
    }
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        enum rho_status one =
            update_hypothesis(pool, &pool->nodes[pool->node_of[slot][i]], seen, time_us);
        status = status == RHO_OK ? RHO_OK : one;
        pool->updates_refused = rho_count(pool->updates_refused, one != RHO_OK);
    }
    return status;
}

static enum rho_status update_hypothesis_by_bearing(struct rho_hypotheses *pool,
                                                    struct rho_hypothesis *at, int64_t time_us,
                                                    float x_m, float y_m, float bearing_rad,
                                                    float sigma_rad, float *gain_nat)
{
    *gain_nat = 0.0f;
    if (!move_to_time(pool, at, time_us)) {
        return RHO_ERROR_VALUE;
    }
    pool->scratch = at->imm;
    enum rho_status status =
        rho_imm_update_bearing(&at->imm, x_m, y_m, bearing_rad, sigma_rad, gain_nat);
    if (status != RHO_OK) {
        at->imm = pool->scratch;
        *gain_nat = 0.0f;
    }
    return status;
}

/* A bearing that a hypothesis could not use has left its gain at 0. */
static int has_gain(float gain_nat)
{
    return gain_nat < 0.0f || gain_nat > 0.0f;
}

/*
 * A hypothesis that could not use it must not gain by that: it gets the least gain of the others.
 */
static void add_bearing_gains(struct rho_hypotheses *pool, uint16_t slot,
                              const float gains_nat[RHO_HYPOTHESES_OF_TRACK])
{
    float least = 0.0f;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        if (has_gain(gains_nat[i]) && (!has_gain(least) || gains_nat[i] < least)) {
            least = gains_nat[i];
        }
    }
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        pool->nodes[pool->node_of[slot][i]].weight_nat +=
            has_gain(gains_nat[i]) ? gains_nat[i] : least;
    }
}

enum rho_status rho_hypotheses_update_bearing(struct rho_hypotheses *pool, uint16_t slot,
                                              int64_t time_us, float x_m, float y_m,
                                              float bearing_rad, float sigma_rad)
{
    enum rho_status status = RHO_ERROR_VALUE;
    float gains_nat[RHO_HYPOTHESES_OF_TRACK] = {0.0f};
    if (!pool) {
        return RHO_ERROR_NULL;
    }
    if (!rho_hypotheses_is_open(pool, slot)) {
        return RHO_ERROR_STATE;
    }
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        enum rho_status one =
            update_hypothesis_by_bearing(pool, &pool->nodes[pool->node_of[slot][i]], time_us, x_m,
                                         y_m, bearing_rad, sigma_rad, &gains_nat[i]);
        status = status == RHO_OK ? RHO_OK : one;
        pool->updates_refused = rho_count(pool->updates_refused, one != RHO_OK);
    }
    add_bearing_gains(pool, slot, gains_nat);
    (void)sort_and_prune(pool, slot);
    return status;
}
