/* SPDX-License-Identifier: MIT */
/*
 * kernel_schedule: the order in which the newest plots get the work of the search.
 *
 * The last plots of kernels are tried by classes of their number of near plots, the cheapest first,
 * so that targets in thin clutter are found however dense clutter is elsewhere. A search that
 * leaves plots out tells the next one where to begin.
 */
#include "search.h"

/* Share of the work of a scan that is kept for the choice among the candidates: 1 of so many. */
#define CHOICE_SHARE 4u

/*
 * Of the work for the newest plots, 1 of KEPT_SHARE is kept in equal parts for the plots that are
 * not tried yet. Of the rest each plot may take 1 of FREE_PARTS.
 */
#define KEPT_SHARE 2u
#define FREE_PARTS 4u

/*
 * Kernels of turning targets may take as much work as those of straight ones took; an eighth of it
 * where plots have positions alone, which hardly reveal turns; and this number of units in any
 * case.
 */
#define TURN_SHARE_OF_PLACES 8u
#define TURN_UNITS_MIN 4000u

#define CLASSES RHO_INITIATOR_CLASSES

/* One pass over the newest plots. A pass that leaves plots out tells where the next one begins. */
struct round {
    unsigned tried, waiting; /* plots */
    uint32_t kept_units;     /* for each that waits */
    int is_found;            /* the next begin is known */
    struct rho_initiator_resume next;
};

/* Cost class by the number of near plots: octaves and half octaves from 8 on. */
static unsigned cost_class_of(unsigned near)
{
    unsigned class = near < 8u ? near : 8u;
    for (; near >= 16u && class + 2u < CLASSES; near /= 2u) {
        class += 2u;
    }
    return class + (near >= 12u && class + 1u < CLASSES);
}

/* Plots of earlier sectors of the revolution were the ends of kernels when they came. */
static int is_of_newest_sector(const struct search *search, const struct rho_window_plot *plot)
{
    return !search->newest || plot->offset_s >= search->newest->offset_min_s;
}

/* Sorts the plots at which kernels may end into classes. Returns their number. */
static unsigned sort_endings(struct search *search, const struct fan *fan)
{
    const struct rho_window_scan *scan = fan->spans[0].scan_b;
    unsigned count = 0;
    for (unsigned j = 0; j < scan->num_plots; j++) {
        unsigned class = CLASSES;
        if (!(scan->marks[j] & search->skip_flags) &&
            is_of_newest_sector(search, &scan->plots[j])) {
            class = cost_class_of(rho_initiator_count_plots_near(search, fan, j));
            count++;
        }
        search->initiator->cost_class[j] = (uint8_t) class;
    }
    return count;
}

/*
 * The next pass begins with the first plot left out, or the one behind it where that was the first
 * of this pass.
 */
static void try_kernels_of_plot(struct search *search, const struct fan *fan, unsigned j,
                                struct round *round)
{
    int is_done = rho_initiator_try_kernels_to(search, fan, j);
    if (!is_done) {
        struct rho_initiator *initiator = search->initiator;
        initiator->budget.plots_not_tried = rho_count(initiator->budget.plots_not_tried, 1);
        search->is_partial = 1;
    }
    if (!round->is_found && (round->tried == 1u || (round->tried > 0 && !is_done))) {
        round->next.cost_class = search->initiator->cost_class[j];
        round->next.plot = (uint16_t)j;
        round->is_found = !is_done;
    }
    round->tried++;
}

/*
 * Limit of the work after a plot: the share of each plot that waits is not touched, and it takes a
 * part of the rest.
 */
static uint32_t work_limit_of(const struct search *search, const struct round *round,
                              uint32_t end_units)
{
    if (end_units == UINT32_MAX) {
        return UINT32_MAX; /* no limit */
    }
    uint32_t ceiling = end_units - round->kept_units * round->waiting;
    uint32_t own = rho_count(rho_initiator_spent(search), round->kept_units);
    unsigned others = round->waiting < FREE_PARTS - 1u ? round->waiting : FREE_PARTS - 1u;
    return own < ceiling ? own + (ceiling - own) / (others + 1u) : ceiling;
}

/* The plots of a class from `first` to before `end`. */
static void try_kernels_of_class(struct search *search, const struct fan *fan, unsigned class,
                                 unsigned first, unsigned end, struct round *round)
{
    const uint32_t end_units = search->limit_units;
    for (unsigned j = first; j < end; j++) {
        if (search->initiator->cost_class[j] == class) {
            round->waiting--;
            search->limit_units = work_limit_of(search, round, end_units);
            try_kernels_of_plot(search, fan, j, round);
        }
    }
    search->limit_units = end_units;
}

/* All kernels that end in scan b, those of the cheapest plots first, from `begin` on. */
static void try_kernels_of_scan(struct search *search, unsigned b, uint32_t units,
                                const struct rho_initiator_resume *begin)
{
    struct fan fan;
    rho_initiator_open_fan(search, b, &fan);
    if (fan.num_spans == 0) {
        return;
    }
    const unsigned num_plots = fan.spans[0].scan_b->num_plots;
    struct round round = {.waiting = sort_endings(search, &fan)};
    unsigned first = begin->plot < num_plots ? begin->plot : num_plots;
    round.kept_units = round.waiting > 0 ? units / (KEPT_SHARE * round.waiting) : 0u;
    try_kernels_of_class(search, &fan, begin->cost_class, first, num_plots, &round);
    for (unsigned i = 1; i < CLASSES; i++) {
        try_kernels_of_class(search, &fan, (begin->cost_class + i) % CLASSES, 0, num_plots, &round);
    }
    try_kernels_of_class(search, &fan, begin->cost_class, 0, first, &round);
    search->next = round.is_found || (search->is_partial && round.tried > 1u)
                       ? round.next
                       : (struct rho_initiator_resume){0, 0};
}

/* In a batch, each scan at which kernels may end has its own work. */
void rho_initiator_try_kernels(struct search *search)
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
        try_kernels_of_scan(search, b, units, is_batch ? &cheapest : &initiator->budget.resume);
    }
    search->limit_units = work_max > 0 ? end_units : UINT32_MAX;
}

/*
 * The same for turning targets, with the work that is left, and no more than a share of the work of
 * the straight ones. Plots that this leaves out are not counted as such.
 */
void rho_initiator_try_turning_kernels(struct search *search)
{
    static const struct rho_initiator_resume cheapest = {0, 0};
    struct rho_initiator_budget *budget = &search->initiator->budget;
    const struct rho_initiator_resume next = search->next;
    const uint32_t plots_not_tried = budget->plots_not_tried, work_max = search->work_max;
    const uint32_t spent = rho_initiator_spent(search), end_units = search->limit_units;
    uint32_t units = work_max - work_max / CHOICE_SHARE;
    units = work_max == 0 ? UINT32_MAX : units > spent ? units - spent : 0u;
    const uint32_t share = search->has_more ? spent : spent / TURN_SHARE_OF_PLACES;
    const uint32_t most = share > TURN_UNITS_MIN ? share : TURN_UNITS_MIN;
    units = units < most ? units : most;
    search->limit_units = rho_count(spent, units);
    try_kernels_of_scan(search, search->num_scans - 1u, units, &cheapest);
    search->limit_units = end_units;
    search->next = next;
    search->is_partial = 0;
    budget->plots_not_tried = plots_not_tried;
}
