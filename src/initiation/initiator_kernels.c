/* SPDX-License-Identifier: MIT */
/*
 * initiator_kernels: pairs of plots, and the scans between that vote for their line and speed.
 */
#include "initiator_search.h"
#include "rhotrack/approx.h"

/* The voter's plot nearest to where the kernel says, in the gate of all three plots' noise; -1: none. */
static int vote(struct search *search, const struct span *span, unsigned m, struct kernel *kernel)
{
    if (!rho_initiator_is_isotropic(search)) {
        return rho_initiator_own_vote(search, span, m, kernel);
    }
    const struct voter *voter = &span->voters[span->b - m - 1u];
    struct rho_window_query *query = &kernel->query;
    float after_s = search->time_s[m] - search->time_s[span->a];
    float al = (after_s - kernel->from->offset_s) / kernel->duration_s;
    query->x_m = kernel->from->x_m + al * kernel->dx_m;
    query->y_m = kernel->from->y_m + al * kernel->dy_m;
    query->variance_m2 =
        (1.0f - al) * (1.0f - al) * kernel->from_m2 + al * al * kernel->to_m2 + voter->process_m2;
    query->reach_m = kernel->reach_share * voter->reach_m;
    return rho_window_nearest(rho_window_scan_at(&search->initiator->window, m), query,
                              &search->initiator->work.window);
}

static void add_vote(struct plot_set *set, unsigned m, int plot)
{
    set->mask |= 1u << m;
    set->hits++;
    set->plot[m] = (uint16_t)plot;
}

/* Whether this is the kernel's vote nearest to its end: else it is tried where that one is. */
static int takes_first(struct search *search, const struct span *span,
                       const struct first_vote *first, struct kernel *kernel, struct plot_set *set)
{
    unsigned m = span->b - first->gap;
    if (vote(search, span, m, kernel) != (int)first->index) {
        return 0;
    }
    add_vote(set, m, (int)first->index);
    while (++m < span->b) {
        if (vote(search, span, m, kernel) >= 0) {
            return 0;
        }
    }
    return 1;
}

/*
 * Lets the scans between vote. 1 where enough do. The scan in the middle has the narrowest gate, and rejects most: of those before
 * the first vote it votes first, then its neighbours outwards.
 */
static int vote_all(struct search *search, const struct span *span, const struct first_vote *first,
                    struct kernel *kernel, struct plot_set *set)
{
    *set = (struct plot_set){.mask = 1u << span->a | 1u << span->b, .hits = 2};
    set->plot[span->a] = (uint16_t)(kernel->from - span->scan_a->plots);
    set->plot[span->b] = (uint16_t)(kernel->to - span->scan_b->plots);
    if (first->gap > 0 && !takes_first(search, span, first, kernel, set)) {
        return 0;
    }
    unsigned misses = first->gap > 0 ? first->gap - 1u : 0u, middle = (span->a + span->b + 1u) / 2u;
    for (unsigned k = 0; k + 1u < (unsigned)span->b - span->a; k++) {
        unsigned m = k % 2u ? middle - (k + 1u) / 2u : middle + k / 2u;
        if (m + first->gap >= span->b && first->gap > 0) {
            continue;
        }
        int plot = vote(search, span, m, kernel);
        if (plot >= 0) {
            add_vote(set, m, plot);
        } else if (++misses > span->misses_max) {
            return 0;
        }
    }
    return 1;
}

static float squared(float v)
{
    return v * v;
}

/*
 * What a kernel costs beside its votes, units: with noise of its plots' own; where these measure
 * more than places; and of a range rate each meaning.
 */
#define OWN_UNITS 4u
#define MORE_UNITS 16u
#define ALIAS_UNITS 8u

/* The noise of a kernel's ends. 0 where their range rates or heights contradict it. */
static int complete(struct search *search, const struct span *span, struct kernel *kernel)
{
    search->initiator->work.seeds = rho_count(search->initiator->work.seeds, 1);
    if (!rho_initiator_is_isotropic(search)) {
        rho_initiator_charge(search, search->has_more ? MORE_UNITS : OWN_UNITS);
        return rho_initiator_own_kernel(search, span, kernel);
    }
    kernel->from_m2 = squared(rho_window_sigma_m(kernel->from));
    kernel->to_m2 = squared(rho_window_sigma_m(kernel->to));
    kernel->query = (struct rho_window_query){
        .vx_mps = kernel->dx_m / kernel->duration_s,
        .vy_mps = kernel->dy_m / kernel->duration_s,
        .sigma_factor = 1.0f,
        .gate_chi2 = RHO_GATE_CHI2_2D,
        .skip_flags = search->skip_flags,
    };
    return 1;
}

#if RHO_AMBIGUOUS_RANGE_RATES
/* A kernel whose first plot has an ambiguous range rate is as many kernels as that can mean: from number `next` on, that of the
 * first with votes enough. */
static int vote_aliases(struct search *search, const struct span *span,
                        const struct first_vote *first, struct kernel *kernel, int *next,
                        struct plot_set *set)
{
    struct aliases aliases;
    int number = *next;
    *next = 0;
    if (rho_initiator_is_isotropic(search) ||
        !rho_initiator_open_aliases(span->scan_a, kernel->from, &kernel->place, &aliases)) {
        return vote_all(search, span, first, kernel, set);
    }
    struct rho_window_place place = kernel->place;
    for (int i = aliases.first + number; i <= aliases.last; i++) {
        rho_initiator_charge(search, ALIAS_UNITS);
        rho_initiator_take_alias(&aliases, i, &place, &kernel->place);
        if (rho_initiator_own_end(span, kernel) && vote_all(search, span, first, kernel, set)) {
            *next = i + 1 - aliases.first;
            return 1;
        }
        if (i < aliases.last && rho_initiator_is_spent(search)) {
            search->is_partial = 1;
            return 0;
        }
    }
    return 0;
}
#endif

/* A target's speed, within noise. */
static int is_pair(const struct search *search, const struct span *span,
                   const struct kernel *kernel)
{
    const struct rho_initiator_config *config = &search->initiator->config;
    float distance2_m2 = kernel->dx_m * kernel->dx_m + kernel->dy_m * kernel->dy_m;
    float near_m = config->v_min_mps * kernel->duration_s - span->slack_m;
    float far_m = config->v_max_mps * kernel->duration_s + span->slack_m;
    return kernel->duration_s > 0.0f && distance2_m2 <= far_m * far_m &&
           (near_m < 0.0f || distance2_m2 >= near_m * near_m);
}

/* Whether the first vote can be this kernel's at all. */
static int is_near_first(const struct search *search, const struct span *span,
                         const struct ending *ending, const struct first_vote *first,
                         const struct kernel *kernel)
{
    if (first->gap == 0) {
        return 1;
    }
    unsigned m = span->b - first->gap;
    const struct rho_window_plot *plot =
        &rho_window_scan_at(&search->initiator->window, m)->plots[first->index];
    const struct voter *voter = &span->voters[first->gap - 1u];
    float after_s = search->time_s[m] - search->time_s[span->a];
    float al = (after_s + plot->offset_s - kernel->from->offset_s) / kernel->duration_s;
    float x_m = kernel->from->x_m + al * kernel->dx_m - plot->x_m;
    float y_m = kernel->from->y_m + al * kernel->dy_m - plot->y_m;
    float reach_m = REACH_ROUNDING * ending->reach_share * voter->reach_m + ending->rounding_m;
    float along_m = x_m * ending->along_x + y_m * ending->along_y;
    float along_max_m = REACH_ROUNDING * ending->along_share * voter->reach_m + ending->rounding_m;
    return x_m * x_m + y_m * y_m <= reach_m * reach_m &&
           along_m * along_m <= along_max_m * along_max_m;
}

int rho_initiator_vote_for(struct search *search, const struct span *span,
                           const struct ending *ending, const struct first_vote *first, unsigned i,
                           int *next, struct plot_set *set)
{
    const struct rho_window_plot *from = &span->scan_a->plots[i], *to = ending->plot;
    struct kernel kernel;
    kernel.from = from;
    kernel.to = to;
    kernel.dx_m = to->x_m - from->x_m;
    kernel.dy_m = to->y_m - from->y_m;
    kernel.duration_s = span->gap_s + to->offset_s - from->offset_s;
    kernel.reach_share = ending->reach_share;
    kernel.noise_b = ending->noise;
    if ((span->scan_a->marks[i] & search->skip_flags) || !is_pair(search, span, &kernel) ||
        !is_near_first(search, span, ending, first, &kernel) || rho_initiator_is_spent(search) ||
        !complete(search, span, &kernel)) {
        *next = 0;
        return 0;
    }
#if RHO_AMBIGUOUS_RANGE_RATES
    return vote_aliases(search, span, first, &kernel, next, set);
#else
    *next = 0;
    return vote_all(search, span, first, &kernel, set);
#endif
}
