/* SPDX-License-Identifier: MIT */
/* search_budget: the work that a search has done, in units, and whether it exceeds the limit. */
#include "search.h"

uint32_t rho_search_work_spent(const struct search *search)
{
    const struct rho_initiator_work *work = &search->initiator->work;
    uint64_t units = (uint64_t)work->window.passed + work->window.distances +
                     (uint64_t)work->window.lookups * LOOKUP_UNITS +
                     (uint64_t)work->seeds * KERNEL_UNITS + (uint64_t)work->fits * FIT_UNITS;
    return units < UINT32_MAX ? (uint32_t)units : UINT32_MAX;
}

int rho_search_is_over_limit(const struct search *search)
{
    return rho_search_work_spent(search) > search->limit_units;
}

void rho_search_charge(const struct search *search, uint32_t units)
{
    struct rho_window_work *work = &search->initiator->work.window;
    work->passed = rho_count(work->passed, units);
}

void rho_search_record_work(struct search *search)
{
    struct rho_initiator_budget *budget = &search->initiator->budget;
    budget->work = rho_search_work_spent(search);
    budget->work_worst = budget->work > budget->work_worst ? budget->work : budget->work_worst;
    budget->partial_steps = rho_count(budget->partial_steps, search->is_partial ? 1u : 0u);
    if (search->kind == RHO_SEARCH_NEWEST) {
        budget->resume = search->next;
    }
}
