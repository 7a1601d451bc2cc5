/* SPDX-License-Identifier: MIT */
/*
 * plot_pair_votes: a kernel is a pair of plots far apart in time; the scans between vote for the
 * straight track through them.
 *
 * An ambiguous range rate has aliases, its possible values a span apart. The velocity between the
 * plots of a kernel excludes most of them. Each of the others is tried, and sharpens the velocity
 * along the line of sight as an unambiguous range rate would.
 */
#include "kernels.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

/* A kernel: its first and last plot, and the look-ups of votes in the scans between. */
struct kernel {
    const struct rho_window_plot *from, *to;
    float dx_m, dy_m;
    float duration_s;
    float gate_share;
    int misses_max;
    /* covariances of first and last plot; isotropic noise: xx_m2 alone, the variance */
    struct rho_window_plot_noise noise_a, noise_b;
    /* look-up of a vote, with the values common to all scans */
    struct rho_window_place place;
};

/* Aliases of a range rate: its error is seen.error_mps + i span_mps, i from first to last. */
struct aliases {
    struct rho_window_range_rate seen;
    float span_mps;
    int first, last;
};

static int is_range_rate_in_gate(const struct rho_window_scan *scan,
                                 const struct rho_window_plot *plot,
                                 const struct rho_window_place *place)
{
    return !(scan->measures & RHO_MEASURES_RANGE_RATE) ||
           rho_window_range_rate_nis(scan, plot, place) <= RHO_GATE_CHI2_1D;
}

/*
 * Sets the noise of a kernel's plots and the look-up of votes. Returns 0 where range rates or
 * heights of the plots contradict the kernel's velocity.
 */
static int set_up_kernel(struct search *search, const struct span *span, struct kernel *kernel)
{
    const struct rho_window_plot_noise *a = &kernel->noise_a, *b = &kernel->noise_b;
    struct rho_window_place *place = &kernel->place;
    search->initiator->work.seeds = rho_count(search->initiator->work.seeds, 1);
    if (rho_search_is_isotropic(search)) {
        kernel->noise_a.xx_m2 = rho_square(rho_window_larger_sigma_m(kernel->from));
        kernel->noise_b.xx_m2 = rho_square(rho_window_larger_sigma_m(kernel->to));
        place->vx_mps = kernel->dx_m / kernel->duration_s;
        place->vy_mps = kernel->dy_m / kernel->duration_s;
        place->factor = 1.0f;
        place->skip_flags = search->skip_flags;
        return 1;
    }
    rho_search_charge(search, search->has_more ? MORE_UNITS : OWN_NOISE_UNITS);
    kernel->noise_a = rho_window_plot_noise(span->scan_a, kernel->from);
    float per_s = 1.0f / kernel->duration_s, per_s2 = per_s * per_s;
    *place = (struct rho_window_place){
        .vx_mps = kernel->dx_m * per_s,
        .vy_mps = kernel->dy_m * per_s,
        .factor = 1.0f,
        .has_z = (span->scan_a->measures & span->scan_b->measures & RHO_MEASURES_Z) != 0,
        .skip_flags = search->skip_flags,
    };
    if (!search->has_more) {
        return 1;
    }
    float turned = rho_square(0.5f * search->turn_mps2 * kernel->duration_s), over_mps = 0.0f;
    place->velocity_noise = (struct rho_window_plot_noise){
        (a->xx_m2 + b->xx_m2) * per_s2 + turned, (a->xy_m2 + b->xy_m2) * per_s2,
        (a->yy_m2 + b->yy_m2) * per_s2 + turned, (a->zz_m2 + b->zz_m2) * per_s2};
    if (place->has_z) {
        place->vz_mps = (kernel->to->z_m - kernel->from->z_m) * per_s;
        over_mps = rho_magnitude(place->vz_mps) - CLIMB_SHARE * search->initiator->config.v_max_mps;
    }
    const int climbs_too_fast =
        over_mps > 0.0f && over_mps * over_mps > RHO_GATE_CHI2_1D * place->velocity_noise.zz_m2;
    return !climbs_too_fast && is_range_rate_in_gate(span->scan_a, kernel->from, place) &&
           is_range_rate_in_gate(span->scan_b, kernel->to, place);
}

/* Index of scan m's plot nearest to the kernel, in the gate of all three plots' noise; or -1. */
static int find_vote(struct search *search, const struct span *span, unsigned m,
                     struct kernel *kernel)
{
    const struct voter *voter = &span->voters[span->b - m - 1u];
    const struct rho_window_scan *scan = rho_search_scan(search, m);
    struct rho_window_work *work = &search->initiator->work.window;
    const float process_m2 = voter->process_m2;
    float after_s = search->time_s[m] - search->time_s[span->a];
    float al = (after_s - kernel->from->offset_s) / kernel->duration_s;
    const struct rho_window_plot_noise *a = &kernel->noise_a, *b = &kernel->noise_b;
    struct rho_window_place *place = &kernel->place;
    float from = (1.0f - al) * (1.0f - al), to = al * al;
    place->x_m = kernel->from->x_m + al * kernel->dx_m;
    place->y_m = kernel->from->y_m + al * kernel->dy_m;
    place->gate_radius_m = kernel->gate_share * voter->gate_radius_m;
    if (rho_search_is_isotropic(search)) {
        place->noise.xx_m2 = from * a->xx_m2 + to * b->xx_m2 + process_m2;
        return rho_window_nearest_isotropic(scan, place, RHO_GATE_CHI2_2D, work);
    }
    place->z_m = kernel->from->z_m + al * (kernel->to->z_m - kernel->from->z_m);
    place->noise = (struct rho_window_plot_noise){
        from * a->xx_m2 + to * b->xx_m2 + process_m2, from * a->xy_m2 + to * b->xy_m2,
        from * a->yy_m2 + to * b->yy_m2 + process_m2, from * a->zz_m2 + to * b->zz_m2 + process_m2};
    return rho_window_nearest_plot(scan, place, work);
}

static void add_vote(struct plot_set *set, unsigned m, int plot_index)
{
    set->mask |= 1u << m;
    set->hits++;
    set->plot[m] = (uint16_t)plot_index;
}

/*
 * Adds vote `first` where it is its scan's nearest plot to the kernel, and no scan nearer to the
 * end votes. Returns 0 elsewhere: such kernels are tried with another first vote.
 */
static int add_first_vote(struct search *search, const struct span *span,
                          const struct first_vote *first, struct kernel *kernel,
                          struct plot_set *set)
{
    unsigned m = span->b - first->gap;
    if (find_vote(search, span, m, kernel) != (int)first->index) {
        return 0;
    }
    add_vote(set, m, (int)first->index);
    while (++m < span->b) {
        if (find_vote(search, span, m, kernel) >= 0) {
            return 0;
        }
    }
    return 1;
}

/*
 * Collects the votes of the scans between a kernel's plots. Returns 1 where they are enough. Apart
 * from the first vote, the scan in the middle votes first, then its neighbours outwards: the middle
 * has the narrowest gate and rejects most kernels.
 */
static int collect_votes(struct search *search, const struct span *span,
                         const struct first_vote *first, struct kernel *kernel,
                         struct plot_set *set)
{
    *set = (struct plot_set){.mask = 1u << span->a | 1u << span->b, .hits = 2};
    set->plot[span->a] = (uint16_t)(kernel->from - span->scan_a->plots);
    set->plot[span->b] = (uint16_t)(kernel->to - span->scan_b->plots);
    if (first->gap > 0 && !add_first_vote(search, span, first, kernel, set)) {
        return 0;
    }
    int misses = first->gap > 0 ? (int)first->gap - 1 : 0;
    unsigned middle = (span->a + span->b + 1u) / 2u;
    for (unsigned k = 0; k + 1u < (unsigned)span->b - span->a; k++) {
        unsigned m = k % 2u ? middle - (k + 1u) / 2u : middle + k / 2u;
        if (m + first->gap >= span->b && first->gap > 0) {
            continue;
        }
        int plot = find_vote(search, span, m, kernel);
        if (plot >= 0) {
            add_vote(set, m, plot);
        } else if (++misses > kernel->misses_max) {
            return 0;
        }
    }
    return 1;
}

/* Whole ambiguity spans that fit into `spans`, at most ALIASES_MAX. */
static int limited_whole_spans(float spans)
{
    return spans < (float)ALIASES_MAX ? (int)spans : ALIASES_MAX;
}

/* Lists the aliases that agree with a place's velocity. Returns 0 where there is no ambiguity. */
static int list_aliases(const struct rho_window_scan *scan, const struct rho_window_plot *plot,
                        const struct rho_window_place *place, struct aliases *aliases)
{
    if (!(scan->measures & RHO_MEASURES_RANGE_RATE) ||
        !rho_measurement_is_ambiguous(&scan->sensor) ||
        !rho_window_compare_range_rate(scan, plot, place, &aliases->seen)) {
        return 0;
    }
    aliases->span_mps = scan->sensor.range_rate_span_mps;
    float reach_mps = rho_sqrt(RHO_GATE_CHI2_1D * aliases->seen.variance);
    /* the nearest alias is in the gate, or nearly: at least that one is listed */
    float error_mps = aliases->seen.error_mps;
    aliases->last =
        limited_whole_spans(rho_larger(reach_mps - error_mps, 0.0f) / aliases->span_mps);
    aliases->first =
        -limited_whole_spans(rho_larger(reach_mps + error_mps, 0.0f) / aliases->span_mps);
    return 1;
}

/*
 * Kalman update of a place's velocity by alias i of the range rate: V - V u u^T V / s^2. The
 * correction of the velocity itself goes to more_mps.
 */
static void update_velocity(const struct aliases *aliases, int i,
                            const struct rho_window_place *place, struct rho_window_place *known)
{
    const struct rho_window_plot_noise *noise = &place->velocity_noise;
    const float *u = aliases->seen.along;
    const float toward[3] = {noise->xx_m2 * u[0] + noise->xy_m2 * u[1],
                             noise->xy_m2 * u[0] + noise->yy_m2 * u[1], noise->zz_m2 * u[2]};
    float per_variance = 1.0f / aliases->seen.variance;
    float share = (aliases->seen.error_mps + (float)i * aliases->span_mps) * per_variance;
    *known = *place;
    for (int k = 0; k < 3; k++) {
        known->more_mps[k] = toward[k] * share;
    }
    /* a little less than all: rounding in float32 must not make a variance negative */
    per_variance *= 1.0f - 4.0e-6f;
    known->velocity_noise.xx_m2 -= toward[0] * toward[0] * per_variance;
    known->velocity_noise.xy_m2 -= toward[0] * toward[1] * per_variance;
    known->velocity_noise.yy_m2 -= toward[1] * toward[1] * per_variance;
    known->velocity_noise.zz_m2 -= toward[2] * toward[2] * per_variance;
}

/* True where vote `first` may be in the gate of the kernel, by the widest gate of its scan. */
static int may_first_vote(const struct search *search, const struct span *span,
                          const struct ending *ending, const struct first_vote *first,
                          const struct kernel *kernel)
{
    if (first->gap == 0) {
        return 1;
    }
    unsigned m = span->b - first->gap;
    const struct rho_window_plot *plot = &rho_search_scan(search, m)->plots[first->index];
    const struct voter *voter = &span->voters[first->gap - 1u];
    float after_s = search->time_s[m] - search->time_s[span->a];
    float al = (after_s + plot->offset_s - kernel->from->offset_s) / kernel->duration_s;
    float x_m = kernel->from->x_m + al * kernel->dx_m - plot->x_m;
    float y_m = kernel->from->y_m + al * kernel->dy_m - plot->y_m;
    float gate_radius_m =
        GATE_ROUNDING * ending->gate_share * voter->gate_radius_m + ending->rounding_m;
    float along_m = x_m * ending->along_x + y_m * ending->along_y;
    float along_max_m =
        GATE_ROUNDING * ending->along_share * voter->gate_radius_m + ending->rounding_m;
    return x_m * x_m + y_m * y_m <= gate_radius_m * gate_radius_m &&
           along_m * along_m <= along_max_m * along_max_m;
}

int rho_kernel_collect_votes(struct search *search, const struct span *span,
                             const struct ending *ending, const struct first_vote *first,
                             unsigned i, int *next_alias, struct plot_set *set)
{
    const struct rho_initiator_config *config = &search->initiator->config;
    const struct rho_window_plot *from = &span->scan_a->plots[i], *to = ending->plot;
    const int number = *next_alias;
    struct kernel kernel;
    *next_alias = 0;
    kernel.from = from;
    kernel.to = to;
    kernel.dx_m = to->x_m - from->x_m;
    kernel.dy_m = to->y_m - from->y_m;
    kernel.duration_s = span->gap_s + to->offset_s - from->offset_s;
    kernel.gate_share = ending->gate_share;
    kernel.misses_max = rho_span_misses_max(span, ending);
    kernel.noise_b = ending->noise;
    /* a target can have the kernel's speed, noise allowed for */
    float distance2_m2 = kernel.dx_m * kernel.dx_m + kernel.dy_m * kernel.dy_m;
    float near_m = config->v_min_mps * kernel.duration_s - span->slack_m;
    float far_m = config->v_max_mps * kernel.duration_s + span->slack_m;
    if ((span->scan_a->marks[i] & search->skip_flags) || !(kernel.duration_s > 0.0f) ||
        !(distance2_m2 <= far_m * far_m) || !(near_m < 0.0f || distance2_m2 >= near_m * near_m) ||
        !may_first_vote(search, span, ending, first, &kernel) || rho_search_is_over_limit(search) ||
        !set_up_kernel(search, span, &kernel)) {
        return 0;
    }
    struct aliases aliases;
    if (!RHO_AMBIGUOUS_RANGE_RATES || rho_search_is_isotropic(search) ||
        !list_aliases(span->scan_a, from, &kernel.place, &aliases)) {
        return collect_votes(search, span, first, &kernel, set);
    }
    /* the aliases of the first plot's range rate, up to the first one with enough votes */
    struct rho_window_place place = kernel.place;
    for (int k = aliases.first + number; k <= aliases.last; k++) {
        rho_search_charge(search, ALIAS_UNITS);
        update_velocity(&aliases, k, &place, &kernel.place);
        if (is_range_rate_in_gate(span->scan_b, to, &kernel.place) &&
            collect_votes(search, span, first, &kernel, set)) {
            *next_alias = k + 1 - aliases.first;
            return 1;
        }
        if (k < aliases.last && rho_search_is_over_limit(search)) {
            search->is_partial = 1;
            return 0;
        }
    }
    return 0;
}
