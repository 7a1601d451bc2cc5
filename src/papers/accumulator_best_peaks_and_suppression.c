/* SPDX-License-Identifier: MIT */
/*
 * accumulator_best_peaks_and_suppression: the list of the best peaks, kept in a heap, and
 * suppression of peaks near a better one.
 */
#include "rhotrack/detail/accumulator.h"

#include <string.h>

#include "rhotrack/types.h"

/* ---- the list of peaks ----------------------------------------------------------------------- */

/* Order of peaks: more votes, then the lower theta cell, then the lower rho cell. */
static int is_better_peak(const struct rho_accumulator_peak *a,
                          const struct rho_accumulator_peak *b)
{
    if (a->votes != b->votes) {
        return a->votes > b->votes;
    }
    return a->theta_cell != b->theta_cell ? a->theta_cell < b->theta_cell
                                          : a->rho_cell < b->rho_cell;
}

/*
 * Moves the peak at `place` of a heap of n peaks down, until all peaks below it are better. The
 * worst peak is at the top.
 */
static void sink_peak(struct rho_accumulator_peak *heap, uint32_t n, uint32_t place)
{
    struct rho_accumulator_peak peak = heap[place];
    for (uint32_t child = 2u * place + 1u; child < n; child = 2u * place + 1u) {
        child += child + 1u < n && is_better_peak(&heap[child], &heap[child + 1u]);
        if (!is_better_peak(&peak, &heap[child])) {
            break;
        }
        heap[place] = heap[child];
        place = child;
    }
    heap[place] = peak;
}

static void sift_peak_up_heap(struct rho_accumulator_peak *heap, uint32_t place)
{
    struct rho_accumulator_peak peak = heap[place];
    while (place > 0 && is_better_peak(&heap[(place - 1u) / 2u], &peak)) {
        heap[place] = heap[(place - 1u) / 2u];
        place = (place - 1u) / 2u;
    }
    heap[place] = peak;
}

/*
 * Smallest whole number of votes that is at least min_share of votes_max; at most votes_max, as
 * float may round up.
 */
static uint32_t min_votes_by_share(const struct rho_peak_list *list)
{
    float share = list->min_share * (float)list->votes_max;
    uint32_t least = share < 4294967296.0f ? (uint32_t)share : list->votes_max;
    least += (float)least < share;
    return least < list->votes_max ? least : list->votes_max;
}

/* Sets the most votes of a peak, and raises the list's min_votes by its share of them. */
static void set_votes_max_raise_min(struct rho_peak_list *list, uint32_t votes)
{
    list->votes_max = votes;
    uint32_t least = min_votes_by_share(list);
    list->min_votes = least > list->min_votes ? least : list->min_votes;
}

void rho_peak_list_offer(struct rho_peak_list *list, struct rho_accumulator_peak peak)
{
    if (peak.votes < list->min_votes) {
        return;
    }
    if (peak.votes > list->votes_max) {
        set_votes_max_raise_min(list, peak.votes);
    }
    if (list->num_peaks < list->max_peaks) {
        list->peaks[list->num_peaks] = peak;
        sift_peak_up_heap(list->peaks, list->num_peaks++);
        return;
    }
    list->peaks_dropped = rho_count(list->peaks_dropped, 1);
    if (list->max_peaks > 0 && is_better_peak(&peak, &list->peaks[0])) {
        list->peaks[0] = peak;
        sink_peak(list->peaks, list->num_peaks, 0);
    }
}

/*
 * Removes the peaks with fewer than the final min_votes. Returns the number left, no longer a heap.
 */
static uint32_t drop_below_threshold_and_count_left(const struct rho_peak_list *list)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < list->num_peaks; i++) {
        if (list->peaks[i].votes >= list->min_votes) {
            list->peaks[n++] = list->peaks[i];
        }
    }
    return n;
}

/* Sorts a heap of peaks, best first. */
static void sort_peaks(struct rho_accumulator_peak *heap, uint32_t n)
{
    while (n > 1) {
        struct rho_accumulator_peak lowest = heap[0];
        heap[0] = heap[--n];
        heap[n] = lowest;
        sink_peak(heap, n, 0);
    }
}

void rho_peak_list_drop_weak_and_sort(struct rho_peak_list *list)
{
    uint32_t n = drop_below_threshold_and_count_left(list);
    if (n < list->num_peaks) {
        list->num_peaks = n;
        /* peaks dropped for lack of room were worse, and so below the threshold too */
        list->peaks_dropped = 0;
        for (uint32_t i = n / 2u; i > 0; i--) {
            sink_peak(list->peaks, n, i - 1u);
        }
    }
    sort_peaks(list->peaks, n);
}

/* ---- suppression ----------------------------------------------------------------------------- */

/*
 * Kept peaks, hashed by blocks of the plane: two peaks in one block are always near each other,
 * hence a block has one kept peak at most, and kept peaks near a cell are in its block or the eight
 * blocks around it.
 */
struct kept {
    struct rho_accumulator_peak *peaks;
    const struct rho_peak_distance *distance;
    uint32_t *table; /* hash table with open addressing: number of a kept peak, from 1; 0: free */
    uint32_t size, num_peaks, num_listed;
};

/* A cell of the plane; theta may lie beyond its ends. */
struct place {
    int32_t theta, rho;
};

static int32_t block_of_cell(int32_t cell, unsigned reach)
{
    int32_t size = (int32_t)reach + 1;
    return cell >= 0 ? cell / size : -1;
}

static uint32_t hash_block(int32_t theta_block, int32_t rho_block)
{
    uint32_t key = (uint32_t)theta_block * 0x9e3779b1u ^ (uint32_t)rho_block * 0x85ebca77u;
    return key ^ key >> 15;
}

static int is_peak_near(const struct rho_accumulator_peak *peak, struct place place,
                        const struct rho_peak_distance *distance)
{
    int32_t theta = (int32_t)peak->theta_cell - place.theta;
    int32_t rho = (int32_t)peak->rho_cell - place.rho;
    return (theta < 0 ? -theta : theta) <= distance->theta &&
           (rho < 0 ? -rho : rho) <= distance->rho;
}

static int is_kept_peak_in_block(const struct kept *kept, uint32_t number, int32_t theta_block,
                                 int32_t rho_block)
{
    const struct rho_accumulator_peak *peak = &kept->peaks[number - 1u];
    return block_of_cell(peak->theta_cell, kept->distance->theta) == theta_block &&
           block_of_cell(peak->rho_cell, kept->distance->rho) == rho_block;
}

static int has_peak_near_in_block(const struct kept *kept, struct place place, int32_t theta_block,
                                  int32_t rho_block)
{
    uint32_t at = hash_block(theta_block, rho_block), number;
    while ((number = kept->table[at & (kept->size - 1u)]) != 0) {
        if (is_kept_peak_in_block(kept, number, theta_block, rho_block)) {
            return is_peak_near(&kept->peaks[number - 1u], place, kept->distance);
        }
        at++;
    }
    return 0;
}

static int has_hashed_peak_near(const struct kept *kept, struct place place)
{
    const struct rho_peak_distance *distance = kept->distance;
    int32_t theta_last = block_of_cell(place.theta + distance->theta, distance->theta);
    int32_t rho_last = block_of_cell(place.rho + distance->rho, distance->rho);
    int32_t theta_first = block_of_cell(place.theta - distance->theta, distance->theta);
    int32_t rho_first = block_of_cell(place.rho - distance->rho, distance->rho);
    for (int32_t theta = theta_first < 0 ? 0 : theta_first; theta <= theta_last; theta++) {
        for (int32_t rho = rho_first < 0 ? 0 : rho_first; rho <= rho_last; rho++) {
            if (has_peak_near_in_block(kept, place, theta, rho)) {
                return 1;
            }
        }
    }
    return 0;
}

static int has_kept_peak_near(const struct kept *kept, struct place place)
{
    if (kept->size > 0 && has_hashed_peak_near(kept, place)) {
        return 1;
    }
    for (uint32_t i = kept->num_listed; i < kept->num_peaks; i++) {
        if (is_peak_near(&kept->peaks[i], place, kept->distance)) {
            return 1;
        }
    }
    return 0;
}

/* Whether a kept peak, which is better, is near this peak, also across the ends of theta. */
static int is_suppressed(const struct kept *kept, const struct rho_accumulator_peak *peak)
{
    int32_t theta = peak->theta_cell, num_theta = kept->distance->theta_cells;
    int32_t rho = peak->rho_cell, turned = (int32_t)kept->distance->rho_cells - 1 - rho;
    int32_t reach = kept->distance->theta;
    return has_kept_peak_near(kept, (struct place){theta, rho}) ||
           (theta < reach && has_kept_peak_near(kept, (struct place){theta + num_theta, turned})) ||
           (theta + reach >= num_theta &&
            has_kept_peak_near(kept, (struct place){theta - num_theta, turned}));
}

/*
 * Adds the last kept peak to the hash table, unless an earlier one was left out or the table is two
 * thirds full: a third stays free, so that searches are short.
 */
static void hash_last_kept_peak_if_room(struct kept *kept)
{
    const struct rho_accumulator_peak *peak = &kept->peaks[kept->num_peaks - 1u];
    if (kept->num_listed + 1u < kept->num_peaks || 3u * (kept->num_listed + 1u) > 2u * kept->size) {
        return;
    }
    uint32_t at = hash_block(block_of_cell(peak->theta_cell, kept->distance->theta),
                             block_of_cell(peak->rho_cell, kept->distance->rho));
    while (kept->table[at & (kept->size - 1u)] != 0) {
        at++;
    }
    kept->table[at & (kept->size - 1u)] = kept->num_peaks;
    kept->num_listed++;
}

uint32_t rho_peak_list_suppress(struct rho_accumulator_peak *peaks, uint32_t num_peaks,
                                const struct rho_peak_distance *distance, uint32_t *scratch,
                                uint32_t num_scratch)
{
    struct kept kept = {
        .peaks = peaks, .distance = distance, .table = scratch, .size = num_scratch};
    if (num_scratch > 0) {
        memset(scratch, 0, num_scratch * sizeof *scratch);
    }
    for (uint32_t i = 0; i < num_peaks; i++) {
        if (!is_suppressed(&kept, &peaks[i])) {
            peaks[kept.num_peaks++] = peaks[i];
            hash_last_kept_peak_if_room(&kept);
        }
    }
    return kept.num_peaks;
}
