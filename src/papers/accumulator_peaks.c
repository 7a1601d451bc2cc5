/* SPDX-License-Identifier: MIT */
/* accumulator_peaks: a heap of the best peaks, and suppression of peaks near a better one. */
#include "rhotrack/detail/accumulator.h"

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

/* Across the ends of theta rho is reversed. */
static int are_near(const struct rho_accumulator_peak *a, const struct rho_accumulator_peak *b,
                    const struct rho_peak_distance *distance)
{
    int theta = a->theta_cell - b->theta_cell, rho = a->rho_cell - b->rho_cell;
    int turned = a->rho_cell + b->rho_cell - (distance->rho_cells - 1);
    theta = theta < 0 ? -theta : theta;
    return (theta <= distance->theta && rho <= distance->rho && -rho <= distance->rho) ||
           (distance->theta_cells - theta <= distance->theta && turned <= distance->rho &&
            -turned <= distance->rho);
}

uint32_t rho_peak_list_suppress(struct rho_accumulator_peak *peaks, uint32_t num_peaks,
                                const struct rho_peak_distance *distance)
{
    uint32_t num_kept = 0;
    for (uint32_t i = 0; i < num_peaks; i++) {
        uint32_t better = num_kept; /* backwards: of equal votes the next peak is often beside */
        while (better > 0 && !are_near(&peaks[better - 1u], &peaks[i], distance)) {
            better--;
        }
        if (better == 0) {
            peaks[num_kept++] = peaks[i];
        }
    }
    return num_kept;
}
