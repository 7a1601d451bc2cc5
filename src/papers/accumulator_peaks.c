/* SPDX-License-Identifier: MIT */
/* accumulator_peaks: a heap of the best peaks, and suppression of peaks near a better one. */
#include "rhotrack/detail/accumulator.h"

#include <string.h>

#include "rhotrack/types.h"

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

/* Moves a peak down a heap of n peaks, the worst at the top, until all below are better. */
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

void rho_peak_list_offer(struct rho_peak_list *list, struct rho_accumulator_peak peak)
{
    if (peak.votes < list->min_votes) {
        return;
    }
    if (peak.votes > list->votes_max) {
        list->votes_max = peak.votes;
        /* min_share of them, rounded up; at most votes_max, as float may round up */
        float share = list->min_share * (float)peak.votes;
        uint32_t least = share < 4294967296.0f ? (uint32_t)share : peak.votes;
        least += (float)least < share;
        least = least < peak.votes ? least : peak.votes;
        list->min_votes = least > list->min_votes ? least : list->min_votes;
    }
    if (list->num_peaks < list->max_peaks) {
        uint32_t place = list->num_peaks++;
        while (place > 0 && is_better_peak(&list->peaks[(place - 1u) / 2u], &peak)) {
            list->peaks[place] = list->peaks[(place - 1u) / 2u];
            place = (place - 1u) / 2u;
        }
        list->peaks[place] = peak;
        return;
    }
    list->peaks_dropped = rho_count(list->peaks_dropped, 1);
    if (list->max_peaks > 0 && is_better_peak(&peak, &list->peaks[0])) {
        list->peaks[0] = peak;
        sink_peak(list->peaks, list->num_peaks, 0);
    }
}

void rho_peak_list_sort(struct rho_peak_list *list)
{
    struct rho_accumulator_peak *heap = list->peaks;
    uint32_t n = 0;
    for (uint32_t i = 0; i < list->num_peaks; i++) {
        if (heap[i].votes >= list->min_votes) {
            heap[n++] = heap[i];
        }
    }
    if (n < list->num_peaks) {
        list->num_peaks = n;
        /* peaks dropped for lack of room were worse, and so below the threshold too */
        list->peaks_dropped = 0;
        for (uint32_t i = n / 2u; i > 0; i--) {
            sink_peak(heap, n, i - 1u);
        }
    }
    while (n > 1) {
        struct rho_accumulator_peak lowest = heap[0];
        heap[0] = heap[--n];
        heap[n] = lowest;
        sink_peak(heap, n, 0);
    }
}

/*
 * Kept peaks, hashed by blocks of the plane: two peaks in one block are always near each other, so
 * a block has one kept peak at most; those near a cell are in its block or the eight around it.
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

static int has_peak_near_in_block(const struct kept *kept, struct place place, int32_t theta_block,
                                  int32_t rho_block)
{
    uint32_t at = hash_block(theta_block, rho_block), number;
    while ((number = kept->table[at & (kept->size - 1u)]) != 0) {
        const struct rho_accumulator_peak *peak = &kept->peaks[number - 1u];
        if (block_of_cell(peak->theta_cell, kept->distance->theta) == theta_block &&
            block_of_cell(peak->rho_cell, kept->distance->rho) == rho_block) {
            return is_peak_near(peak, place, kept->distance);
        }
        at++;
    }
    return 0;
}

static int has_kept_peak_near(const struct kept *kept, struct place place)
{
    const struct rho_peak_distance *distance = kept->distance;
    int32_t theta_last = block_of_cell(place.theta + distance->theta, distance->theta);
    int32_t rho_last = block_of_cell(place.rho + distance->rho, distance->rho);
    int32_t theta = block_of_cell(place.theta - distance->theta, distance->theta);
    int32_t rho_first = block_of_cell(place.rho - distance->rho, distance->rho);
    for (theta = theta < 0 ? 0 : theta; kept->size > 0 && theta <= theta_last; theta++) {
        for (int32_t rho = rho_first < 0 ? 0 : rho_first; rho <= rho_last; rho++) {
            if (has_peak_near_in_block(kept, place, theta, rho)) {
                return 1;
            }
        }
    }
    for (uint32_t i = kept->num_listed; i < kept->num_peaks; i++) {
        if (is_peak_near(&kept->peaks[i], place, distance)) {
            return 1;
        }
    }
    return 0;
}

/*
 * Adds the last kept peak to the hash table, unless an earlier one was left out or the table is two
 * thirds full: a third stays free, so that searches are short.
 */
static void hash_kept_peak(struct kept *kept)
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
    int32_t reach = distance->theta, num_theta = distance->theta_cells;
    if (num_scratch > 0) {
        memset(scratch, 0, num_scratch * sizeof *scratch);
    }
    for (uint32_t i = 0; i < num_peaks; i++) {
        /* kept peaks are better; across the ends of theta rho is reversed */
        int32_t theta = peaks[i].theta_cell, rho = peaks[i].rho_cell;
        int32_t turned = (int32_t)distance->rho_cells - 1 - rho;
        int is_suppressed =
            has_kept_peak_near(&kept, (struct place){theta, rho}) ||
            (theta < reach &&
             has_kept_peak_near(&kept, (struct place){theta + num_theta, turned})) ||
            (theta + reach >= num_theta &&
             has_kept_peak_near(&kept, (struct place){theta - num_theta, turned}));
        if (!is_suppressed) {
            peaks[kept.num_peaks++] = peaks[i];
            hash_kept_peak(&kept);
        }
    }
    return kept.num_peaks;
}
