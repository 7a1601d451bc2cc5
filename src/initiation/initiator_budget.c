/* SPDX-License-Identifier: MIT */
/*
 * initiator_budget: how much work a search may do, and which of the newest plots it is spent on first.
 */
#include "initiator_search.h"

/* Work in units: a plot compared, or a row of bins looked at, is one. */
#define KERNEL_UNITS 2u
#define LOOKUP_UNITS 3u
#define FIT_UNITS 400u

/* Of each scan's work, what the choice among the candidates is sure of. */
#define CHOICE_SHARE 4u

/* Of the work for the newest plots half is kept, in even shares for those that wait; of the rest each takes a quarter at most. */
#define KEPT_SHARE 2u
#define FREE_PARTS 4u

/*
 * Kernels of turns may take as much as those of straight targets took; an eighth where plots have
 * places alone, which show hardly more turns so; and so many units in any case.
 */
#define TURN_SHARE_OF_PLACES 8u
#define TURN_UNITS_MIN 4000u

#define CLASSES RHO_INITIATOR_CLASSES

/* ---- what is spent ---------------------------------------------------------------------------- */

uint32_t rho_initiator_spent(const struct search *search)
{
    const struct rho_initiator_work *work = &search->initiator->work;
    uint64_t units = (uint64_t)work->window.passed + work->window.distances +
                     (uint64_t)work->window.lookups * LOOKUP_UNITS +
                     (uint64_t)work->seeds * KERNEL_UNITS + (uint64_t)work->fits * FIT_UNITS;
    return units < UINT32_MAX ? (uint32_t)units : UINT32_MAX;
}

int rho_initiator_is_spent(const struct search *search)
{
    return rho_initiator_spent(search) > search->limit_units;
}

void rho_initiator_charge(const struct search *search, uint32_t units)
{
    struct rho_window_work *work = &search->initiator->work.window;
    work->passed = rho_count(work->passed, units);
}

/* ---- the newest plots ------------------------------------------------------------------------- */

/* A search that leaves plots out says where the next one begins: its order goes on from there, and comes round. */
struct turn {
    unsigned tried, waiting; /* plots */
    uint32_t kept_units;     /* for each that waits */
    int is_settled;          /* the next begin is known */
    struct rho_initiator_turn next;
};

/* By octaves and halves of them from 8 on. */
static unsigned class_of(unsigned crowd)
{
    unsigned class = crowd < 8u ? crowd : 8u;
    for (; crowd >= 16u && class + 2u < CLASSES; crowd /= 2u) {
        class += 2u;
    }
    return class + (crowd >= 12u && class + 1u < CLASSES);
}

#if RHO_SECTORS
/* Plots of the turn's earlier sectors have been the ends of kernels when they came. */
static int is_new(const struct search *search, const struct rho_window_plot *plot)
{
    return !search->newest || plot->offset_s >= search->newest->offset_min_s;
}
#else
static int is_new(const struct search *search, const struct rho_window_plot *plot)
{
    (void)search, (void)plot;
    return 1;
}
#endif

/* Puts the plots that kernels may end in into classes. Returns how many they are. */
static unsigned sort_endings(struct search *search, const struct fan *fan)
{
    const struct rho_window_scan *scan = fan->spans[0].scan_b;
    unsigned count = 0;
    for (unsigned j = 0; j < scan->num_plots; j++) {
        unsigned class = CLASSES;
        if (!(scan->marks[j] & search->skip_flags) && is_new(search, &scan->plots[j])) {
            class = class_of(rho_initiator_crowd(search, fan, j));
            count++;
        }
        search->initiator->cost_class[j] = (uint8_t) class;
    }
    return count;
}

/* The next turn begins with the first plot left out, or the one behind where that was this turn's first. */
static void try_plot(struct search *search, const struct fan *fan, unsigned j, struct turn *turn)
{
    int is_done = rho_initiator_try_ending(search, fan, j);
    if (!is_done) {
        struct rho_initiator *initiator = search->initiator;
        initiator->budget.plots_not_tried = rho_count(initiator->budget.plots_not_tried, 1);
        search->is_partial = 1;
    }
    if (!turn->is_settled && (turn->tried == 1u || (turn->tried > 0 && !is_done))) {
        turn->next.cost_class = search->initiator->cost_class[j];
        turn->next.plot = (uint16_t)j;
        turn->is_settled = !is_done;
    }
    turn->tried++;
}

/* Until where a plot may spend: what is kept for each that waits behind is not touched, and of the rest it takes a quarter. */
static uint32_t limit_of(const struct search *search, const struct turn *turn, uint32_t end_units)
{
    if (end_units == UINT32_MAX) {
        return UINT32_MAX; /* no limit */
    }
    uint32_t ceiling = end_units - turn->kept_units * turn->waiting;
    uint32_t own = rho_count(rho_initiator_spent(search), turn->kept_units);
    unsigned others = turn->waiting < FREE_PARTS - 1u ? turn->waiting : FREE_PARTS - 1u;
    return own < ceiling ? own + (ceiling - own) / (others + 1u) : ceiling;
}

/* The plots of a class from `first` to before `end`. */
static void try_class(struct search *search, const struct fan *fan, unsigned class, unsigned first,
                      unsigned end, struct turn *turn)
{
    const uint32_t end_units = search->limit_units;
    for (unsigned j = first; j < end; j++) {
        if (search->initiator->cost_class[j] == class) {
            turn->waiting--;
            search->limit_units = limit_of(search, turn, end_units);
            try_plot(search, fan, j, turn);
        }
    }
    search->limit_units = end_units;
}

/* All kernels that end in scan b, those of the cheapest plots first, but where a turn goes on. */
static void try_scan(struct search *search, unsigned b, uint32_t units,
                     const struct rho_initiator_turn *begin)
{
    struct fan fan;
    rho_initiator_open_fan(search, b, &fan);
    if (fan.num_spans == 0) {
        return;
    }
    const unsigned num_plots = fan.spans[0].scan_b->num_plots;
    struct turn turn = {.waiting = sort_endings(search, &fan)};
    unsigned first = begin->plot < num_plots ? begin->plot : num_plots;
    turn.kept_units = turn.waiting > 0 ? units / (KEPT_SHARE * turn.waiting) : 0u;
    try_class(search, &fan, begin->cost_class, first, num_plots, &turn);
    for (unsigned i = 1; i < CLASSES; i++) {
        try_class(search, &fan, (begin->cost_class + i) % CLASSES, 0, num_plots, &turn);
    }
    try_class(search, &fan, begin->cost_class, 0, first, &turn);
    search->next = turn.is_settled || (search->is_partial && turn.tried > 1u)
                       ? turn.next
                       : (struct rho_initiator_turn){0, 0};
}

/* In a batch every scan that kernels may end in has its work. */
void rho_initiator_try_kernels(struct search *search)
{
    static const struct rho_initiator_turn cheapest = {0, 0};
    struct rho_initiator *initiator = search->initiator;
    const int is_batch = search->kind == RHO_SEARCH_BATCH;
    const unsigned last = search->num_scans - 1u;
    const uint32_t work_max = search->work_max, units = work_max - work_max / CHOICE_SHARE;
    uint32_t end_units = 0;
    for (unsigned b = is_batch ? search->min_scans - 1u : last; b <= last; b++) {
        search->limit_units = work_max > 0 ? end_units + units : UINT32_MAX;
        end_units = rho_count(end_units, work_max);
        try_scan(search, b, units, is_batch ? &cheapest : &initiator->budget.turn);
    }
    search->limit_units = work_max > 0 ? end_units : UINT32_MAX;
}

/*
 * The same for turns, from what is left, and no more than a share of what the straight ones took.
 * That counts as no part left out: half of it is kept for all plots alike.
 */
void rho_initiator_try_turning_kernels(struct search *search)
{
    static const struct rho_initiator_turn cheapest = {0, 0};
    struct rho_initiator_budget *budget = &search->initiator->budget;
    const struct rho_initiator_turn next = search->next;
    const uint32_t plots_not_tried = budget->plots_not_tried, work_max = search->work_max;
    const uint32_t spent = rho_initiator_spent(search), end_units = search->limit_units;
    uint32_t units = work_max - work_max / CHOICE_SHARE;
    units = work_max == 0 ? UINT32_MAX : units > spent ? units - spent : 0u;
    const uint32_t share = search->has_more ? spent : spent / TURN_SHARE_OF_PLACES;
    const uint32_t most = share > TURN_UNITS_MIN ? share : TURN_UNITS_MIN;
    units = units < most ? units : most;
    search->limit_units = rho_count(spent, units);
    try_scan(search, search->num_scans - 1u, units, &cheapest);
    search->limit_units = end_units;
    search->next = next;
    search->is_partial = 0;
    budget->plots_not_tried = plots_not_tried;
}

/* What the search has done is told, and where the next one begins. */
void rho_initiator_close_budget(struct search *search)
{
    struct rho_initiator_budget *budget = &search->initiator->budget;
    budget->work = rho_initiator_spent(search);
    budget->work_worst = budget->work > budget->work_worst ? budget->work : budget->work_worst;
    budget->partial_steps = rho_count(budget->partial_steps, search->is_partial ? 1u : 0u);
    if (search->kind == RHO_SEARCH_NEWEST) {
        budget->turn = search->next;
    }
}
