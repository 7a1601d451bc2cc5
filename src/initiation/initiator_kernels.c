/* SPDX-License-Identifier: MIT */
/*
 * initiator_kernels: pairs of plots, and the scans between that vote for their line and speed.
 */
#include "initiator_search.h"
#include "rhotrack/approx.h"

/* The scan in the middle has the narrowest gate, and rejects most: it votes first, then its neighbours outwards. */
static void order_votes(struct span *span)
{
    unsigned middle = (span->a + span->b) / 2u;
    span->num_voters = 0;
    for (unsigned step = 0; step < span->b - span->a; step++) {
        unsigned up = middle + step, down = middle - step;
        if (step > 0 && middle >= step && down > span->a) {
            span->voters[span->num_voters++].m = down;
        }
        if (up > span->a && up < span->b) {
            span->voters[span->num_voters++].m = up;
        }
    }
}

static float spread_s(const struct rho_window_scan *scan)
{
    return scan->offset_max_s - scan->offset_min_s;
}

static float ends_m2(const struct span *span, float al)
{
    float from_m = (1.0f - al) * span->scan_a->sigma_max_m, to_m = al * span->scan_b->sigma_max_m;
    return from_m * from_m + to_m * to_m;
}

/* Reach of a voter's widest gate. Plots' own times move al by up to `slack`; the variance is convex in al. */
static float widest_reach_m(const struct search *search, const struct span *span,
                            const struct voter *voter)
{
    float sigma_m = voter->scan->sigma_max_m;
    float al = voter->after_s / span->gap_s;
    float slack = (spread_s(span->scan_a) + spread_s(span->scan_b)) / span->gap_s;
    float low_m2 = ends_m2(span, al - slack), high_m2 = ends_m2(span, al + slack);
    return rho_sqrt(search->reach_chi2 * (sigma_m * sigma_m + voter->process_m2 +
                                          (low_m2 > high_m2 ? low_m2 : high_m2)));
}

static void open_span(struct search *search, unsigned a, unsigned b, struct span *span)
{
    struct rho_window *window = &search->initiator->window;
    *span = (struct span){.a = a, .b = b};
    span->scan_a = rho_window_scan_at(window, a);
    span->scan_b = rho_window_scan_at(window, b);
    span->gap_s = search->time_s[b] - search->time_s[a];
    span->misses_outside = search->num_scans - (b - a + 1u);
    if (!search->is_isotropic) {
        span->slack_m =
            rho_sqrt(RHO_GATE_CHI2_2D * (span->scan_a->sigma_max_m * span->scan_a->sigma_max_m +
                                         span->scan_b->sigma_max_m * span->scan_b->sigma_max_m));
    }
    order_votes(span);
    for (unsigned k = 0; k < span->num_voters; k++) {
        struct voter *voter = &span->voters[k];
        voter->scan = rho_window_scan_at(window, voter->m);
        voter->after_s = search->time_s[voter->m] - search->time_s[a];
        if (search->fit_process_m2 > 0.0f) {
            voter->process_m2 = rho_initiator_process_gap_m2(search, a, voter->m, b);
        }
        voter->reach_m = widest_reach_m(search, span, voter);
    }
}

/* The voter's plot nearest to where the kernel says, in the gate of all three plots' noise; -1: none. */
static int vote(struct search *search, const struct voter *voter, struct kernel *kernel)
{
    struct rho_window_query *query = &kernel->query;
    float al = (voter->after_s - kernel->from->offset_s) / kernel->duration_s;
    query->x_m = kernel->from->x_m + al * kernel->dx_m;
    query->y_m = kernel->from->y_m + al * kernel->dy_m;
    query->variance_m2 =
        (1.0f - al) * (1.0f - al) * kernel->from_m2 + al * al * kernel->to_m2 + voter->process_m2;
    query->reach_m = voter->reach_m;
    return rho_window_nearest(voter->scan, query, &search->initiator->work.window);
}

/* Lets the scans between vote, and offers the kernel as a candidate where enough do. */
static void try_kernel(struct search *search, const struct span *span, struct kernel *kernel)
{
    struct plot_set set = {.mask = 1u << span->a | 1u << span->b, .hits = 2};
    unsigned misses = span->misses_outside;
    for (unsigned k = 0; k < span->num_voters; k++) {
        const struct voter *voter = &span->voters[k];
        int plot = search->is_isotropic ? vote(search, voter, kernel)
                                        : rho_initiator_own_vote(search, voter, kernel);
        if (plot >= 0) {
            set.mask |= 1u << voter->m;
            set.hits++;
            set.plot[voter->m] = (uint16_t)plot;
        } else if (++misses > search->num_scans - search->min_scans) {
            return;
        }
    }
    set.plot[span->a] = (uint16_t)(kernel->from - span->scan_a->plots);
    set.plot[span->b] = (uint16_t)(kernel->to - span->scan_b->plots);
    rho_initiator_offer(search, &set);
}

static float squared(float v)
{
    return v * v;
}

/* The noise of a kernel's ends. 0 where their range rates or heights contradict it. */
static int complete(const struct search *search, const struct span *span, struct kernel *kernel)
{
    search->initiator->work.seeds = rho_count(search->initiator->work.seeds, 1);
    if (!search->is_isotropic) {
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
/* A kernel whose first plot has an ambiguous range rate is as many kernels as that can mean. */
static void try_aliases(struct search *search, const struct span *span, struct kernel *kernel)
{
    struct aliases aliases;
    if (search->is_isotropic ||
        !rho_initiator_open_aliases(span->scan_a, kernel->from, &kernel->place, &aliases)) {
        try_kernel(search, span, kernel);
        return;
    }
    struct rho_window_place place = kernel->place;
    for (int i = aliases.first; i <= aliases.last; i++) {
        rho_initiator_take_alias(&aliases, i, &place, &kernel->place);
        if (rho_initiator_own_end(span, kernel)) {
            try_kernel(search, span, kernel);
        }
    }
}
#endif

/* The earlier end of kernels. */
struct start {
    const struct rho_window_plot *plot;
    struct rho_window_noise noise; /* not isotropic: its covariance */
};

#if RHO_SECTORS
/* Plots of the turn's earlier sectors have been the ends of kernels when they came. */
static int is_new(const struct search *search, const struct rho_window_plot *plot)
{
    return !search->newest || plot->offset_s >= search->newest->offset_min_s;
}

/* Bins that may hold the end of a kernel that begins here; none where rows end before they begin. */
static struct rho_window_bins bins_of_ends(const struct search *search,
                                           const struct rho_window_scan *scan,
                                           const struct rho_window_plot *from, float far_m)
{
    struct rho_extent near = {from->x_m - far_m, from->x_m + far_m, from->y_m - far_m,
                              from->y_m + far_m};
    if (search->newest) {
        const struct rho_extent *newest = &search->newest->extent;
        near.x_min_m = near.x_min_m > newest->x_min_m ? near.x_min_m : newest->x_min_m;
        near.x_max_m = near.x_max_m < newest->x_max_m ? near.x_max_m : newest->x_max_m;
        near.y_min_m = near.y_min_m > newest->y_min_m ? near.y_min_m : newest->y_min_m;
        near.y_max_m = near.y_max_m < newest->y_max_m ? near.y_max_m : newest->y_max_m;
    }
    if (!(near.x_min_m <= near.x_max_m && near.y_min_m <= near.y_max_m)) {
        return (struct rho_window_bins){.row_first = 1, .row_last = 0};
    }
    return rho_window_bins_under(scan, near.x_min_m, near.x_max_m, near.y_min_m, near.y_max_m);
}
#else
static int is_new(const struct search *search, const struct rho_window_plot *plot)
{
    (void)search, (void)plot;
    return 1;
}

static struct rho_window_bins bins_of_ends(const struct search *search,
                                           const struct rho_window_scan *scan,
                                           const struct rho_window_plot *from, float far_m)
{
    (void)search;
    return rho_window_bins_under(scan, from->x_m - far_m, from->x_m + far_m, from->y_m - far_m,
                                 from->y_m + far_m);
}
#endif

static void pair_with(struct search *search, const struct span *span, const struct start *start,
                      unsigned j)
{
    const struct rho_window_plot *from = start->plot, *to = &span->scan_b->plots[j];
    const struct rho_initiator_config *config = &search->initiator->config;
    float dx_m = to->x_m - from->x_m, dy_m = to->y_m - from->y_m;
    float duration_s = span->gap_s + to->offset_s - from->offset_s;
    float distance2_m2 = dx_m * dx_m + dy_m * dy_m;
    float near_m = config->v_min_mps * duration_s - span->slack_m;
    float far_m = config->v_max_mps * duration_s + span->slack_m;
    if (!(duration_s > 0.0f && distance2_m2 <= far_m * far_m &&
          (near_m < 0.0f || distance2_m2 >= near_m * near_m)) ||
        (span->scan_b->marks[j] & search->skip_flags) || !is_new(search, to)) {
        return;
    }
    struct kernel kernel;
    kernel.from = from;
    kernel.to = to;
    kernel.dx_m = dx_m;
    kernel.dy_m = dy_m;
    kernel.duration_s = duration_s;
    kernel.noise_a = start->noise;
    if (complete(search, span, &kernel)) {
#if RHO_AMBIGUOUS_RANGE_RATES
        try_aliases(search, span, &kernel);
#else
        try_kernel(search, span, &kernel);
#endif
    }
}

/* Pairs a plot of scan a with every plot of scan b that the speed limits allow. */
static void pair_from(struct search *search, const struct span *span, unsigned i)
{
    const struct rho_window_plot *from = &span->scan_a->plots[i];
    const struct rho_window_scan *scan = span->scan_b;
    float far_m =
        search->initiator->config.v_max_mps * (span->gap_s + scan->offset_max_s - from->offset_s) +
        span->slack_m;
    struct rho_window_bins bins = bins_of_ends(search, scan, from, far_m);
    if (RHO_SECTORS && bins.row_first > bins.row_last) {
        return;
    }
    struct start first = {.plot = from};
    if (!search->is_isotropic) {
        first.noise = rho_window_noise(span->scan_a, from);
    }
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned end = start[bins.column_last + 1];
        for (unsigned j = start[bins.column_first]; j < end; j++) {
            pair_with(search, span, &first, j);
        }
    }
}

static void search_span(struct search *search, unsigned a, unsigned b)
{
    struct span span;
    if (!(search->time_s[b] > search->time_s[a])) {
        return; /* scans of one instant make no kernel */
    }
    open_span(search, a, b, &span);
    for (unsigned i = 0; i < span.scan_a->num_plots; i++) {
        if (!(span.scan_a->marks[i] & search->skip_flags)) {
            pair_from(search, &span, i);
        }
    }
}

/* A kernel of M votes spans at least M scans; longer spans predict better and come first. */
void rho_initiator_try_kernels(struct search *search)
{
    unsigned last = search->num_scans - 1u;
    unsigned first_b = search->kind == RHO_SEARCH_NEWEST ? last : search->min_scans - 1u;
    for (unsigned a = 0; a + search->min_scans <= search->num_scans; a++) {
        for (unsigned b = last; b >= first_b && b - a + 1u >= search->min_scans; b--) {
            search_span(search, a, b);
        }
    }
}
