/* SPDX-License-Identifier: MIT */
/* search_budget: the work that a search has done, in units, and whether it exceeds the limit. */
#include "search.h"

/*
 * Units of work of a kernel, a look-up and a fit. A unit is one plot compared, or one row of bins.
 */
#define KERNEL_UNITS 2u
#define LOOKUP_UNITS 3u
#define FIT_UNITS 400u

uint32_t rho_initiator_work_spent(const struct search *search)
{
    const struct rho_initiator_work *work = &search->initiator->work;
    uint64_t units = (uint64_t)work->window.passed + work->window.distances +
                     (uint64_t)work->window.lookups * LOOKUP_UNITS +
                     (uint64_t)work->seeds * KERNEL_UNITS + (uint64_t)work->fits * FIT_UNITS;
    return units < UINT32_MAX ? (uint32_t)units : UINT32_MAX;
}

int rho_initiator_is_work_limit_exceeded(const struct search *search)
{
    return rho_initiator_work_spent(search) > search->limit_units;
}

void rho_initiator_charge_work(const struct search *search, uint32_t units)
{
    struct rho_window_work *work = &search->initiator->work.window;
    work->passed = rho_count(work->passed, units);
}

/* Records the work of a search, whether it was partial, and where the next search begins. */
void rho_initiator_record_work_and_resume_place(struct search *search)
{
    struct rho_initiator_budget *budget = &search->initiator->budget;
    budget->work = rho_initiator_work_spent(search);
    budget->work_worst = budget->work > budget->work_worst ? budget->work : budget->work_worst;
    budget->partial_steps = rho_count(budget->partial_steps, search->is_partial ? 1u : 0u);
    if (search->kind == RHO_SEARCH_NEWEST) {
        budget->resume = search->next;
    }
}
