/* SPDX-License-Identifier: MIT */
/*
 * search_order: the order in which the newest plots are searched, and the work that each gets.
 *
 * Kernels are tried by classes of the number of plots near their last plot, the cheapest first, so
 * that targets in thin clutter are found however dense clutter is elsewhere. A search that leaves
 * plots out records the plot with which the next one begins.
 */
#include "kernels.h"
#include "policy.h"

#define CLASSES RHO_INITIATOR_CLASSES

/* State of one pass over the plots of the newest scan. */
struct pass {
    unsigned tried, waiting; /* numbers of plots tried, and not tried yet */
    uint32_t kept_units;     /* units of work reserved for each waiting plot */
    int is_found;            /* `next` is final: a plot was left out */
    struct rho_initiator_resume next;
};

/* Cost class by the number of near plots: below 8 itself, then octaves and half octaves. */
static unsigned cost_class_by_near_plots(unsigned near)
{
    unsigned class = near < 8u ? near : 8u;
    for (; near >= 16u && class + 2u < CLASSES; near /= 2u) {
        class += 2u;
    }
    return class + (near >= 12u && class + 1u < CLASSES);
}

/*
 * Tries the kernels that end in the plots of a cost class, from index `first` to before `end`.
 * Where the work does not suffice for a plot, it counts as not tried. The next search begins with
 * the first plot left out, or the one behind it where that was the first of this pass.
 */
static void try_cost_class(struct search *search, const struct span_list *list, unsigned class,
                           unsigned first, unsigned end, struct pass *pass)
{
    struct rho_initiator *initiator = search->initiator;
    const uint32_t end_units = search->limit_units;
    for (unsigned j = first; j < end; j++) {
        if (initiator->cost_class[j] != class) {
            continue;
        }
        pass->waiting--;
        if (end_units != UINT32_MAX) { /* UINT32_MAX: no limit */
            /* the shares of the waiting plots stay; the plot may take a part of the rest */
            uint32_t ceiling = end_units - pass->kept_units * pass->waiting;
            uint32_t own = rho_count(rho_search_work_spent(search), pass->kept_units);
            unsigned others =
                pass->waiting < PLOT_FREE_PARTS - 1u ? pass->waiting : PLOT_FREE_PARTS - 1u;
            search->limit_units = own < ceiling ? own + (ceiling - own) / (others + 1u) : ceiling;
        }
        const int is_done = rho_kernels_try_ending(search, list, j);
        if (!is_done) {
            initiator->budget.plots_not_tried = rho_count(initiator->budget.plots_not_tried, 1);
            search->is_partial = 1;
        }
        if (!pass->is_found && (pass->tried == 1u || (pass->tried > 0 && !is_done))) {
            pass->next.cost_class = initiator->cost_class[j];
            pass->next.plot = (uint16_t)j;
            pass->is_found = !is_done;
        }
        pass->tried++;
    }
    search->limit_units = end_units;
}

/* Tries all kernels that end in scan b, the cheapest plots first, from `begin` on. */
static void try_kernels_ending_in_scan(struct search *search, unsigned b, uint32_t units,
                                       const struct rho_initiator_resume *begin)
{
    struct span_list list;
    rho_kernels_list_spans(search, b, &list);
    if (list.num_spans == 0) {
        return;
    }
    const struct rho_window_scan *scan = list.spans[0].scan_b;
    const unsigned num_plots = scan->num_plots;
    struct pass pass = {.waiting = 0};
    for (unsigned j = 0; j < num_plots; j++) {
        unsigned class = CLASSES; /* of plots at which no kernel may end */
        /* kernels that end in earlier sectors were tried when those came */
        if (!(scan->marks[j] & search->skip_flags) &&
            (!search->newest || scan->plots[j].offset_s >= search->newest->offset_min_s)) {
            class = cost_class_by_near_plots(rho_kernels_count_near(search, &list, j));
            pass.waiting++;
        }
        search->initiator->cost_class[j] = (uint8_t) class;
    }
    unsigned first = begin->plot < num_plots ? begin->plot : num_plots;
    pass.kept_units = pass.waiting > 0 ? units / (PLOT_KEPT_SHARE * pass.waiting) : 0u;
    try_cost_class(search, &list, begin->cost_class, first, num_plots, &pass);
    for (unsigned i = 1; i < CLASSES; i++) {
        try_cost_class(search, &list, (begin->cost_class + i) % CLASSES, 0, num_plots, &pass);
    }
    try_cost_class(search, &list, begin->cost_class, 0, first, &pass);
    search->next = pass.is_found || (search->is_partial && pass.tried > 1u)
                       ? pass.next
                       : (struct rho_initiator_resume){0, 0};
}

/* In a batch, each scan at which kernels may end has its own work. */
void rho_kernels_try_straight(struct search *search)
{
    static const struct rho_initiator_resume cheapest = {0, 0};
    struct rho_initiator *initiator = search->initiator;
    const int is_batch = search->kind == RHO_SEARCH_BATCH;
    const unsigned last = search->num_scans - 1u;
    const uint32_t work_max = search->work_max, units = work_max - work_max / CHOICE_SHARE;
    uint32_t end_units = 0;
    for (unsigned b = is_batch ? search->min_scans - 1u : last; b <= last; b++) {
        search->limit_units = work_max > 0 ? end_units + units : UINT32_MAX;
        end_units = rho_count(end_units, work_max);
        try_kernels_ending_in_scan(search, b, units,
                                   is_batch ? &cheapest : &initiator->budget.resume);
    }
    search->limit_units = work_max > 0 ? end_units : UINT32_MAX;
}

/* Takes a share of the work on straight targets; plots left out do not count as not tried. */
void rho_kernels_try_turning(struct search *search)
{
    static const struct rho_initiator_resume cheapest = {0, 0};
    struct rho_initiator_budget *budget = &search->initiator->budget;
    const struct rho_initiator_resume next = search->next;
    const uint32_t plots_not_tried = budget->plots_not_tried, work_max = search->work_max;
    const uint32_t spent = rho_search_work_spent(search), end_units = search->limit_units;
    uint32_t units = work_max - work_max / CHOICE_SHARE;
    units = work_max == 0 ? UINT32_MAX : units > spent ? units - spent : 0u;
    const uint32_t share = search->has_more ? spent : spent / TURN_SHARE_OF_PLACES;
    const uint32_t most = share > TURN_UNITS_MIN ? share : TURN_UNITS_MIN;
    units = units < most ? units : most;
    search->limit_units = rho_count(spent, units);
    try_kernels_ending_in_scan(search, search->num_scans - 1u, units, &cheapest);
    search->limit_units = end_units;
    search->next = next;
    search->is_partial = 0;
    budget->plots_not_tried = plots_not_tried;
}
