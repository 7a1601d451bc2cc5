/* SPDX-License-Identifier: MIT */
/*
 * hypotheses_scan: hypotheses weigh the plots of a scan, and go on with the best of them. hypotheses_reach.c begins it.
 */
#include <string.h>

#include "hypotheses_pool.h"
#include "rhotrack/approx.h"

/* ---- weigh ------------------------------------------------------------------------------------ */

static float log_clutter(const struct rho_hypotheses_clutter *clutter,
                         const struct rho_imm_match *match)
{
    return clutter->log_per_m2 + (match->num_axes > 2 ? clutter->log_per_m : 0.0f) +
           (match->has_velocity ? (float)match->num_axes * clutter->log_per_mps : 0.0f) +
           (match->has_range_rate ? clutter->log_per_range_rate : 0.0f);
}

/* Into the hypothesis' list of its best plots, of equals behind the earlier ones. */
static inline void note_candidate(struct rho_hypothesis *at,
                                  struct rho_hypotheses_candidate candidate)
{
    unsigned place = at->num_candidates;
    if (place < RHO_HYPOTHESES_CHILDREN) {
        at->num_candidates++;
    } else if (!(candidate.gain_nat > at->candidates[--place].gain_nat)) {
        return;
    }
    for (; place > 0 && at->candidates[place - 1].gain_nat < candidate.gain_nat; place--) {
        at->candidates[place] = at->candidates[place - 1];
    }
    at->candidates[place] = candidate;
}

/* At the plot's own time. */
static int match_one(struct rho_hypotheses *pool, const struct rho_hypothesis *at,
                     const struct rho_imm_plot *seen, int64_t time_us, struct rho_imm_match *match)
{
    const struct rho_imm *imm = rho_hypotheses_filter_at(pool, at, time_us);
    return imm && rho_imm_weigh(imm, seen, match);
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
        pool->gate_is_usable = pool->gate_is_usable && at->time_us == time_us &&
                               rho_imm_open_gate(&pool->gates[i], &at->imm, variance_m2, has_z);
    }
}

/* True where the plot can be weighed in gates: they are of the hypotheses' time, and so must the plot be. */
static int has_gates(struct rho_hypotheses *pool, uint16_t slot, const struct rho_imm_plot *seen,
                     int64_t time_us)
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

int rho_hypotheses_weigh(struct rho_hypotheses *pool, uint16_t slot,
                         const struct rho_imm_plot *seen, int64_t time_us, int16_t row,
                         float log_pd, const struct rho_hypotheses_clutter *clutter,
                         float *gain_nat)
{
    struct rho_imm_match match;
    float best = 0.0f;
    int is_seen = 0;
    if (!pool || !seen || !clutter || !gain_nat || !rho_hypotheses_is_open(pool, slot)) {
        return 0;
    }
    const int by_gates = has_gates(pool, slot, seen, time_us);
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][i]];
        if (!(by_gates ? rho_imm_weigh_in(&pool->gates[i], seen->position.place_m, &match)
                       : match_one(pool, at, seen, time_us, &match))) {
            continue;
        }
        const float gain = log_pd + match.log_likelihood - log_clutter(clutter, &match);
        note_candidate(at, (struct rho_hypotheses_candidate){gain, match.probability, row});
        best = !is_seen || at->weight_nat + gain > best ? at->weight_nat + gain : best;
        is_seen = 1;
    }
    if (is_seen) {
        *gain_nat = best;
    }
    return is_seen;
}

int rho_hypotheses_has_candidates(const struct rho_hypotheses *pool, uint16_t slot)
{
    unsigned candidates = 0;
    for (unsigned i = 0; i < rho_hypotheses_count(pool, slot); i++) {
        candidates += pool->nodes[pool->node_of[slot][i]].num_candidates;
    }
    return candidates > 0;
}

/* ---- commit ----------------------------------------------------------------------------------- */

/* In the order of weights; of equals the earlier parent, the earlier plot. */
static unsigned insert_child(struct rho_hypotheses *pool, unsigned num,
                             struct rho_hypotheses_child child)
{
    unsigned place = num;
    for (; place > 0 && pool->children[place - 1].weight_nat < child.weight_nat; place--) {
        pool->children[place] = pool->children[place - 1];
    }
    pool->children[place] = child;
    return num + 1;
}

static int is_free(const struct rho_hypotheses_scan *scan, int16_t row)
{
    return !scan->claims || scan->claims[row] < 0 || scan->claims[row] == scan->own;
}

/* The heaviest child's weight. */
static float find_best(const struct rho_hypotheses *pool, uint16_t slot,
                       const struct rho_hypotheses_scan *scan)
{
    float best = scan->log_miss; /* of the first hypothesis, whose weight is 0 */
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][i]];
        for (unsigned k = 0; k < at->num_candidates; k++) {
            float weight = at->weight_nat + at->candidates[k].gain_nat;
            best = weight > best && is_free(scan, at->candidates[k].row) ? weight : best;
        }
    }
    return best;
}

/* Those that are not too light, the heaviest first. */
static unsigned bear_children(struct rho_hypotheses *pool, uint16_t slot,
                              const struct rho_hypotheses_scan *scan)
{
    const float best = find_best(pool, slot, scan);
    const float least = best + RHO_HYPOTHESES_WEIGHT_MIN;
    unsigned num = 0;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][i]];
        struct rho_hypotheses_child child = {.parent = (uint8_t)i};
        for (unsigned k = 0; k < at->num_candidates; k++) {
            child.weight_nat = at->weight_nat + at->candidates[k].gain_nat;
            child.row = at->candidates[k].row;
            child.candidate = (uint8_t)k;
            if (child.weight_nat >= least && is_free(scan, child.row)) {
                num = insert_child(pool, num, child);
            }
        }
        child.weight_nat = at->weight_nat + scan->log_miss;
        child.row = RHO_HYPOTHESES_MISS;
        if (child.weight_nat >= least) {
            num = insert_child(pool, num, child);
        }
    }
    return num;
}

/* The same plots in the last scans: only how it came there differs, and the better one tells that. */
static int is_repeated(const struct rho_hypotheses *pool, uint16_t slot, unsigned num_kept,
                       const struct rho_hypotheses_child *child)
{
    const int16_t *picks = pool->nodes[pool->node_of[slot][child->parent]].picks;
    for (unsigned i = 0; i < num_kept; i++) {
        const struct rho_hypotheses_child *kept = &pool->children[i];
        const int16_t *others = pool->nodes[pool->node_of[slot][kept->parent]].picks;
        int differ = kept->row != child->row;
        for (int k = 1; k < RHO_HYPOTHESES_MEMORY; k++) {
            differ |= picks[k] != others[k];
        }
        if (!differ) {
            return 1;
        }
    }
    return 0;
}

/* Those that go on move to the front of the list. */
static unsigned choose_children(struct rho_hypotheses *pool, uint16_t slot, unsigned num)
{
    unsigned kept = 0;
    for (unsigned i = 0; i < num && kept < RHO_HYPOTHESES_OF_TRACK; i++) {
        const struct rho_hypotheses_child child = pool->children[i];
        if (!is_repeated(pool, slot, kept, &child)) {
            pool->children[kept++] = child;
        }
    }
    return rho_hypotheses_make_room(pool, slot, kept);
}

/* A refused update leaves the filter as it was predicted. */
static int16_t take_plot(struct rho_hypotheses *pool, struct rho_hypothesis *at,
                         const struct rho_imm_plot *seen, int64_t time_us,
                         const struct rho_imm_match *match, int16_t row)
{
    pool->scratch = at->imm;
    if (rho_hypotheses_move(pool, &at->imm, at->time_us, time_us) == RHO_OK &&
        rho_imm_update(&at->imm, &pool->model, seen, match) == RHO_OK) {
        at->time_us = time_us;
        return row;
    }
    at->imm = pool->scratch;
    pool->updates_refused = rho_count(pool->updates_refused, 1);
    return RHO_HYPOTHESES_MISS;
}

/* One whose update is refused has what a miss weighs. Weights are still those of the scan, the best one's included. */
static void grow(struct rho_hypotheses *pool, struct rho_hypothesis *at,
                 const struct rho_hypotheses_scan *scan, const struct rho_hypotheses_child *child)
{
    const float as_miss = at->weight_nat + scan->log_miss;
    int16_t row = child->row;
    if (row >= 0) {
        const struct rho_plot *plot = &scan->plots[row];
        const struct rho_hypotheses_candidate *chosen = &at->candidates[child->candidate];
        const struct rho_imm_match match = {.probability = chosen->probability};
        struct rho_imm_plot seen;
        rho_imm_open_plot(&seen, plot, scan->measures, scan->sensor);
        row = take_plot(pool, at, &seen, scan->time_us + plot->offset_us, &match, row);
    }
    for (int k = 1; k < RHO_HYPOTHESES_MEMORY; k++) {
        at->picks[k - 1] = at->picks[k];
    }
    at->picks[RHO_HYPOTHESES_MEMORY - 1] = row;
    at->weight_nat = row == child->row ? child->weight_nat : as_miss;
}

/* Parents without children give their nodes back; the others' last child takes the node, the others copies of it. */
static void replace(struct rho_hypotheses *pool, uint16_t slot,
                    const struct rho_hypotheses_scan *scan, unsigned num)
{
    uint8_t uses[RHO_HYPOTHESES_OF_TRACK] = {0};
    uint16_t nodes[RHO_HYPOTHESES_OF_TRACK];
    for (unsigned i = 0; i < num; i++) {
        uses[pool->children[i].parent]++;
    }
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        if (uses[i] == 0) {
            rho_hypotheses_release(pool, pool->node_of[slot][i]);
        }
    }
    for (unsigned i = 0; i < num; i++) {
        const struct rho_hypotheses_child *child = &pool->children[i];
        uint16_t parent = pool->node_of[slot][child->parent];
        nodes[i] = parent;
        if (--uses[child->parent] > 0) {
            nodes[i] = rho_hypotheses_allot(pool);
            pool->nodes[nodes[i]] = pool->nodes[parent];
        }
        grow(pool, &pool->nodes[nodes[i]], scan, child);
    }
    memcpy(pool->node_of[slot], nodes, num * sizeof nodes[0]);
    pool->num_of[slot] = (uint8_t)num;
}

/* The best is first and weighs 0, and those too light beside it are given up. Returns what the best weighed. */
static float order(struct rho_hypotheses *pool, uint16_t slot)
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
    const float best = rho_hypotheses_rebase(pool, slot);
    for (unsigned i = pool->num_of[slot] - 1u;
         pool->nodes[nodes[i]].weight_nat < RHO_HYPOTHESES_WEIGHT_MIN; i--) {
        rho_hypotheses_release(pool, nodes[i]);
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
    float before = rho_hypotheses_log_sum(pool, slot);
    unsigned num = choose_children(pool, slot, bear_children(pool, slot, scan));
    replace(pool, slot, scan, num);
    float best = order(pool, slot);
    outcome->row = pool->nodes[pool->node_of[slot][0]].picks[RHO_HYPOTHESES_MEMORY - 1];
    outcome->gain_nat = best + rho_hypotheses_log_sum(pool, slot) - before;
    return RHO_OK;
}

/* ---- what is known to be the target's ---------------------------------------------------------- */

/* A hypothesis to another time; where that cannot be it stays as it is. */
static int carry(struct rho_hypotheses *pool, struct rho_hypothesis *at, int64_t time_us)
{
    pool->scratch = at->imm;
    if (rho_hypotheses_move(pool, &at->imm, at->time_us, time_us) != RHO_OK) {
        at->imm = pool->scratch;
        return 0;
    }
    at->time_us = time_us;
    return 1;
}

static enum rho_status take_sure(struct rho_hypotheses *pool, struct rho_hypothesis *at,
                                 const struct rho_imm_plot *seen, int64_t time_us)
{
    struct rho_imm_match match;
    if (!carry(pool, at, time_us)) {
        return RHO_ERROR_VALUE;
    }
    /* far from both predictions, neither model is the likelier one */
    if (!rho_imm_weigh(&at->imm, seen, &match)) {
        match.probability = at->imm.probability;
    }
    pool->scratch = at->imm;
    enum rho_status status = rho_imm_update(&at->imm, &pool->model, seen, &match);
    if (status != RHO_OK) {
        at->imm = pool->scratch;
    }
    return status;
}

enum rho_status rho_hypotheses_take(struct rho_hypotheses *pool, uint16_t slot,
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
        enum rho_status one = take_sure(pool, &pool->nodes[pool->node_of[slot][i]], seen, time_us);
        status = status == RHO_OK ? RHO_OK : one;
        pool->updates_refused = rho_count(pool->updates_refused, one != RHO_OK);
    }
    return status;
}

static enum rho_status take_bearing(struct rho_hypotheses *pool, struct rho_hypothesis *at,
                                    int64_t time_us, float x_m, float y_m, float bearing_rad,
                                    float sigma_rad, float *gain_nat)
{
    *gain_nat = 0.0f;
    if (!carry(pool, at, time_us)) {
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

/* A bearing that said nothing to a hypothesis has left its gain at 0. */
static int is_said(float gain_nat)
{
    return gain_nat < 0.0f || gain_nat > 0.0f;
}

/* One that it said nothing to is not the better for it: it gets the least of the others. */
static void add_gains(struct rho_hypotheses *pool, uint16_t slot,
                      const float gains_nat[RHO_HYPOTHESES_OF_TRACK])
{
    float least = 0.0f;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        if (is_said(gains_nat[i]) && (!is_said(least) || gains_nat[i] < least)) {
            least = gains_nat[i];
        }
    }
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        pool->nodes[pool->node_of[slot][i]].weight_nat +=
            is_said(gains_nat[i]) ? gains_nat[i] : least;
    }
}

enum rho_status rho_hypotheses_take_bearing(struct rho_hypotheses *pool, uint16_t slot,
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
        enum rho_status one = take_bearing(pool, &pool->nodes[pool->node_of[slot][i]], time_us, x_m,
                                           y_m, bearing_rad, sigma_rad, &gains_nat[i]);
        status = status == RHO_OK ? RHO_OK : one;
        pool->updates_refused = rho_count(pool->updates_refused, one != RHO_OK);
    }
    add_gains(pool, slot, gains_nat);
    (void)order(pool, slot);
    return status;
}
