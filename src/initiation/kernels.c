/* SPDX-License-Identifier: MIT */
/*
 * kernels: a pair of plots far apart in time, and the scans between that vote for its line and
 * speed.
 */
#include "rhotrack/detail/approx.h"
#include "search.h"

/* A pair of plots, for which the scans between vote. */
struct kernel {
    const struct rho_window_plot *from, *to;
    float dx_m, dy_m;
    float duration_s;
    float gate_share;
    int misses_max;
    float from_m2, to_m2;                     /* isotropic: the variances of the ends */
    struct rho_window_query query;            /* ... and what every scan is asked alike */
    struct rho_window_noise noise_a, noise_b; /* anisotropic: the covariances of the ends */
    struct rho_window_place place;            /* ... and what every scan is asked alike */
};

/* ---- plots with their own covariance, height and range rate ---------------------------------- */

static int both_measure(const struct span *span, uint32_t what)
{
    return (span->scan_a->measures & span->scan_b->measures & what) != 0;
}

/* The velocity of the kernel with its noise. The position is filled in for each vote. */
static struct rho_window_place velocity_of(const struct search *search, const struct span *span,
                                           const struct kernel *kernel)
{
    const struct rho_window_noise *a = &kernel->noise_a, *b = &kernel->noise_b;
    float per_s = 1.0f / kernel->duration_s, per_s2 = per_s * per_s;
    struct rho_window_place place = {
        .vx_mps = kernel->dx_m * per_s,
        .vy_mps = kernel->dy_m * per_s,
        .factor = 1.0f,
        .has_z = both_measure(span, RHO_MEASURES_Z),
        .skip_flags = search->skip_flags,
    };
    if (search->has_more) {
        float turned_mps = 0.5f * search->turn_mps2 * kernel->duration_s;
        float turned = turned_mps * turned_mps;
        place.velocity_noise = (struct rho_window_noise){
            (a->xx_m2 + b->xx_m2) * per_s2 + turned, (a->xy_m2 + b->xy_m2) * per_s2,
            (a->yy_m2 + b->yy_m2) * per_s2 + turned, (a->zz_m2 + b->zz_m2) * per_s2};
    }
    if (place.has_z) {
        place.vz_mps = (kernel->to->z_m - kernel->from->z_m) * per_s;
    }
    return place;
}

static int agrees_with_range_rate(const struct rho_window_scan *scan,
                                  const struct rho_window_plot *plot,
                                  const struct rho_window_place *place)
{
    return !(scan->measures & RHO_MEASURES_RANGE_RATE) ||
           rho_window_range_rate_distance2(scan, plot, place) <= RHO_GATE_CHI2_1D;
}

static int climbs_too_fast(const struct search *search, const struct rho_window_place *place)
{
    float over_mps = (place->vz_mps < 0.0f ? -place->vz_mps : place->vz_mps) -
                     CLIMB_SHARE * search->initiator->config.v_max_mps;
    return place->has_z && over_mps > 0.0f &&
           over_mps * over_mps > RHO_GATE_CHI2_1D * place->velocity_noise.zz_m2;
}

static int complete_anisotropic(const struct search *search, const struct span *span,
                                struct kernel *kernel)
{
    kernel->noise_a = rho_window_noise(span->scan_a, kernel->from);
    kernel->place = velocity_of(search, span, kernel);
    return !search->has_more ||
           (!climbs_too_fast(search, &kernel->place) &&
            agrees_with_range_rate(span->scan_a, kernel->from, &kernel->place) &&
            agrees_with_range_rate(span->scan_b, kernel->to, &kernel->place));
}

/*
 * The voter's plot nearest to the predicted place, in the gate of the three plots' covariances; -1:
 * none.
 */
static int vote_anisotropic(struct search *search, const struct span *span, unsigned m,
                            struct kernel *kernel)
{
    const struct voter *voter = &span->voters[span->b - m - 1u];
    const struct rho_window_noise *a = &kernel->noise_a, *b = &kernel->noise_b;
    struct rho_window_place *place = &kernel->place;
    float after_s = search->time_s[m] - search->time_s[span->a];
    float al = (after_s - kernel->from->offset_s) / kernel->duration_s;
    float from = (1.0f - al) * (1.0f - al), to = al * al, process_m2 = voter->process_m2;
    place->x_m = kernel->from->x_m + al * kernel->dx_m;
    place->y_m = kernel->from->y_m + al * kernel->dy_m;
    place->z_m = kernel->from->z_m + al * (kernel->to->z_m - kernel->from->z_m);
    place->noise = (struct rho_window_noise){
        from * a->xx_m2 + to * b->xx_m2 + process_m2, from * a->xy_m2 + to * b->xy_m2,
        from * a->yy_m2 + to * b->yy_m2 + process_m2, from * a->zz_m2 + to * b->zz_m2 + process_m2};
    place->gate_radius_m = kernel->gate_share * voter->gate_radius_m;
    return rho_window_nearest_to(rho_window_scan_at(&search->initiator->window, m), place,
                                 &search->initiator->work.window);
}

/* ---- votes ----------------------------------------------------------------------------------- */

/*
 * The voter's plot nearest to the predicted place, in the gate of the three plots' noise; -1: none.
 */
static int vote_of_scan(struct search *search, const struct span *span, unsigned m,
                        struct kernel *kernel)
{
    if (!rho_initiator_is_isotropic(search)) {
        return vote_anisotropic(search, span, m, kernel);
    }
    const struct voter *voter = &span->voters[span->b - m - 1u];
    struct rho_window_query *query = &kernel->query;
    float after_s = search->time_s[m] - search->time_s[span->a];
    float al = (after_s - kernel->from->offset_s) / kernel->duration_s;
    query->x_m = kernel->from->x_m + al * kernel->dx_m;
    query->y_m = kernel->from->y_m + al * kernel->dy_m;
    query->variance_m2 =
        (1.0f - al) * (1.0f - al) * kernel->from_m2 + al * al * kernel->to_m2 + voter->process_m2;
    query->gate_radius_m = kernel->gate_share * voter->gate_radius_m;
    return rho_window_nearest(rho_window_scan_at(&search->initiator->window, m), query,
                              &search->initiator->work.window);
}

static void add_vote(struct plot_set *set, unsigned m, int plot)
{
    set->mask |= 1u << m;
    set->hits++;
    set->plot[m] = (uint16_t)plot;
}

/*
 * True where vote `first` is the one nearest to the end of the kernel. Other kernels are tried with
 * their own first vote.
 */
static int has_first_vote(struct search *search, const struct span *span,
                          const struct first_vote *first, struct kernel *kernel,
                          struct plot_set *set)
{
    unsigned m = span->b - first->gap;
    if (vote_of_scan(search, span, m, kernel) != (int)first->index) {
        return 0;
    }
    add_vote(set, m, (int)first->index);
    while (++m < span->b) {
        if (vote_of_scan(search, span, m, kernel) >= 0) {
            return 0;
        }
    }
    return 1;
}

/*
 * Collects the votes of the scans between; 1 where they are enough. Before the first vote the scan
 * in the middle votes first, then its neighbours outwards: its gate is the narrowest and rejects
 * most.
 */
static int collect_votes(struct search *search, const struct span *span,
                         const struct first_vote *first, struct kernel *kernel,
                         struct plot_set *set)
{
    *set = (struct plot_set){.mask = 1u << span->a | 1u << span->b, .hits = 2};
    set->plot[span->a] = (uint16_t)(kernel->from - span->scan_a->plots);
    set->plot[span->b] = (uint16_t)(kernel->to - span->scan_b->plots);
    if (first->gap > 0 && !has_first_vote(search, span, first, kernel, set)) {
        return 0;
    }
    int misses = first->gap > 0 ? (int)first->gap - 1 : 0;
    unsigned middle = (span->a + span->b + 1u) / 2u;
    for (unsigned k = 0; k + 1u < (unsigned)span->b - span->a; k++) {
        unsigned m = k % 2u ? middle - (k + 1u) / 2u : middle + k / 2u;
        if (m + first->gap >= span->b && first->gap > 0) {
            continue;
        }
        int plot = vote_of_scan(search, span, m, kernel);
        if (plot >= 0) {
            add_vote(set, m, plot);
        } else if (++misses > kernel->misses_max) {
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
 * Units of a kernel besides its votes: with the plots' own covariances; with heights or range
 * rates; and for each alias of a range rate.
 */
#define OWN_UNITS 4u
#define MORE_UNITS 16u
#define ALIAS_UNITS 8u

/* Fills in the noise of the kernel's ends. 0 where their range rates or heights contradict it. */
static int complete_kernel(struct search *search, const struct span *span, struct kernel *kernel)
{
    search->initiator->work.seeds = rho_count(search->initiator->work.seeds, 1);
    if (!rho_initiator_is_isotropic(search)) {
        rho_initiator_charge(search, search->has_more ? MORE_UNITS : OWN_UNITS);
        return complete_anisotropic(search, span, kernel);
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

/*
 * A kernel whose first plot has an ambiguous range rate is tried for each alias, from number `next`
 * on, up to the first with enough votes.
 */
static int vote_aliases(struct search *search, const struct span *span,
                        const struct first_vote *first, struct kernel *kernel, int *next,
                        struct plot_set *set)
{
    struct aliases aliases;
    int number = *next;
    *next = 0;
    if (!RHO_AMBIGUOUS_RANGE_RATES || rho_initiator_is_isotropic(search) ||
        !rho_initiator_open_aliases(span->scan_a, kernel->from, &kernel->place, &aliases)) {
        return collect_votes(search, span, first, kernel, set);
    }
    struct rho_window_place place = kernel->place;
    for (int i = aliases.first + number; i <= aliases.last; i++) {
        rho_initiator_charge(search, ALIAS_UNITS);
        rho_initiator_apply_alias(&aliases, i, &place, &kernel->place);
        if (agrees_with_range_rate(span->scan_b, kernel->to, &kernel->place) &&
            collect_votes(search, span, first, kernel, set)) {
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

/* True where the speed is a target's, within noise. */
static int has_target_speed(const struct search *search, const struct span *span,
                            const struct kernel *kernel)
{
    const struct rho_initiator_config *config = &search->initiator->config;
    float distance2_m2 = kernel->dx_m * kernel->dx_m + kernel->dy_m * kernel->dy_m;
    float near_m = config->v_min_mps * kernel->duration_s - span->slack_m;
    float far_m = config->v_max_mps * kernel->duration_s + span->slack_m;
    return kernel->duration_s > 0.0f && distance2_m2 <= far_m * far_m &&
           (near_m < 0.0f || distance2_m2 >= near_m * near_m);
}

/* True where the first vote may be in the gate of this kernel. */
static int may_have_first_vote(const struct search *search, const struct span *span,
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
    float gate_radius_m =
        GATE_ROUNDING * ending->gate_share * voter->gate_radius_m + ending->rounding_m;
    float along_m = x_m * ending->along_x + y_m * ending->along_y;
    float along_max_m =
        GATE_ROUNDING * ending->along_share * voter->gate_radius_m + ending->rounding_m;
    return x_m * x_m + y_m * y_m <= gate_radius_m * gate_radius_m &&
           along_m * along_m <= along_max_m * along_max_m;
}

int rho_initiator_vote_for_kernel(struct search *search, const struct span *span,
                                  const struct ending *ending, const struct first_vote *first,
                                  unsigned i, int *next, struct plot_set *set)
{
    const struct rho_window_plot *from = &span->scan_a->plots[i], *to = ending->plot;
    struct kernel kernel;
    kernel.from = from;
    kernel.to = to;
    kernel.dx_m = to->x_m - from->x_m;
    kernel.dy_m = to->y_m - from->y_m;
    kernel.duration_s = span->gap_s + to->offset_s - from->offset_s;
    kernel.gate_share = ending->gate_share;
    kernel.misses_max = rho_initiator_misses_max(span, ending);
    kernel.noise_b = ending->noise;
    if ((span->scan_a->marks[i] & search->skip_flags) || !has_target_speed(search, span, &kernel) ||
        !may_have_first_vote(search, span, ending, first, &kernel) ||
        rho_initiator_is_spent(search) || !complete_kernel(search, span, &kernel)) {
        *next = 0;
        return 0;
    }
    return vote_aliases(search, span, first, &kernel, next, set);
}
