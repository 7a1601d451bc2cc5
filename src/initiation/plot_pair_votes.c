/* SPDX-License-Identifier: MIT */
/*
 * plot_pair_votes: a kernel is a pair of plots far apart in time; the scans between vote for the
 * straight track through them.
 */
#include "rhotrack/detail/approx.h"
#include "search.h"

/* A kernel: its first and last plot, and the look-ups of votes in the scans between. */
struct kernel {
    const struct rho_window_plot *from, *to;
    float dx_m, dy_m;
    float duration_s;
    float gate_share;
    int misses_max;
    float from_m2, to_m2; /* isotropic noise: the variances of first and last plot */
    /* isotropic noise: look-up of a vote, with the values common to all scans */
    struct rho_window_query query;
    /* anisotropic noise: the covariances of first and last plot */
    struct rho_window_plot_noise_covariance noise_a, noise_b;
    /* anisotropic noise: look-up of a vote, with the values common to all scans */
    struct rho_window_place place;
};

/* ---- plots with their own covariance, height and range rate ---------------------------------- */

static int do_both_ends_measure(const struct span *span, uint32_t what)
{
    return (span->scan_a->measures & span->scan_b->measures & what) != 0;
}

/*
 * Velocity of a kernel with its covariance, as a look-up of votes. The position is filled in for
 * each scan.
 */
static struct rho_window_place make_vote_query_with_kernel_velocity(const struct search *search,
                                                                    const struct span *span,
                                                                    const struct kernel *kernel)
{
    const struct rho_window_plot_noise_covariance *a = &kernel->noise_a, *b = &kernel->noise_b;
    float per_s = 1.0f / kernel->duration_s, per_s2 = per_s * per_s;
    struct rho_window_place place = {
        .vx_mps = kernel->dx_m * per_s,
        .vy_mps = kernel->dy_m * per_s,
        .factor = 1.0f,
        .has_z = do_both_ends_measure(span, RHO_MEASURES_Z),
        .skip_flags = search->skip_flags,
    };
    if (search->has_more) {
        float turned_mps = 0.5f * search->turn_mps2 * kernel->duration_s;
        float turned = turned_mps * turned_mps;
        place.velocity_noise = (struct rho_window_plot_noise_covariance){
            (a->xx_m2 + b->xx_m2) * per_s2 + turned, (a->xy_m2 + b->xy_m2) * per_s2,
            (a->yy_m2 + b->yy_m2) * per_s2 + turned, (a->zz_m2 + b->zz_m2) * per_s2};
    }
    if (place.has_z) {
        place.vz_mps = (kernel->to->z_m - kernel->from->z_m) * per_s;
    }
    return place;
}

static int is_range_rate_in_gate(const struct rho_window_scan *scan,
                                 const struct rho_window_plot *plot,
                                 const struct rho_window_place *place)
{
    return !(scan->measures & RHO_MEASURES_RANGE_RATE) ||
           rho_window_range_rate_nis(scan, plot, place) <= RHO_GATE_CHI2_1D;
}

static int climbs_too_fast(const struct search *search, const struct rho_window_place *place)
{
    float over_mps = (place->vz_mps < 0.0f ? -place->vz_mps : place->vz_mps) -
                     CLIMB_SHARE * search->initiator->config.v_max_mps;
    return place->has_z && over_mps > 0.0f &&
           over_mps * over_mps > RHO_GATE_CHI2_1D * place->velocity_noise.zz_m2;
}

static int set_up_anisotropic_kernel_if_plausible(const struct search *search,
                                                  const struct span *span, struct kernel *kernel)
{
    kernel->noise_a = rho_window_plot_noise_covariance(span->scan_a, kernel->from);
    kernel->place = make_vote_query_with_kernel_velocity(search, span, kernel);
    return !search->has_more ||
           (!climbs_too_fast(search, &kernel->place) &&
            is_range_rate_in_gate(span->scan_a, kernel->from, &kernel->place) &&
            is_range_rate_in_gate(span->scan_b, kernel->to, &kernel->place));
}

/*
 * Index of the plot of scan m nearest to the kernel's predicted place, in the gate of the
 * covariances of all three plots; -1: none.
 */
static int find_voting_plot_index_anisotropic(struct search *search, const struct span *span,
                                              unsigned m, struct kernel *kernel)
{
    const struct voter *voter = &span->voters[span->b - m - 1u];
    const struct rho_window_plot_noise_covariance *a = &kernel->noise_a, *b = &kernel->noise_b;
    struct rho_window_place *place = &kernel->place;
    float after_s = search->time_s[m] - search->time_s[span->a];
    float al = (after_s - kernel->from->offset_s) / kernel->duration_s;
    float from = (1.0f - al) * (1.0f - al), to = al * al, process_m2 = voter->process_m2;
    place->x_m = kernel->from->x_m + al * kernel->dx_m;
    place->y_m = kernel->from->y_m + al * kernel->dy_m;
    place->z_m = kernel->from->z_m + al * (kernel->to->z_m - kernel->from->z_m);
    place->noise = (struct rho_window_plot_noise_covariance){
        from * a->xx_m2 + to * b->xx_m2 + process_m2, from * a->xy_m2 + to * b->xy_m2,
        from * a->yy_m2 + to * b->yy_m2 + process_m2, from * a->zz_m2 + to * b->zz_m2 + process_m2};
    place->gate_radius_m = kernel->gate_share * voter->gate_radius_m;
    return rho_window_nearest_plot_anisotropic(rho_window_scan_at(&search->initiator->window, m),
                                               place, &search->initiator->work.window);
}

/* ---- votes ----------------------------------------------------------------------------------- */

/*
 * Index of the plot of scan m nearest to the kernel's predicted place, in the gate of the noise of
 * all three plots; -1: none.
 */
static int find_voting_plot_index_in_scan(struct search *search, const struct span *span,
                                          unsigned m, struct kernel *kernel)
{
    if (!rho_initiator_takes_isotropic_path(search)) {
        return find_voting_plot_index_anisotropic(search, span, m, kernel);
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
    return rho_window_nearest_plot_in_sigmas_isotropic(
        rho_window_scan_at(&search->initiator->window, m), query, &search->initiator->work.window);
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
static int add_first_vote_if_nearest(struct search *search, const struct span *span,
                                     const struct first_vote *first, struct kernel *kernel,
                                     struct plot_set *set)
{
    unsigned m = span->b - first->gap;
    if (find_voting_plot_index_in_scan(search, span, m, kernel) != (int)first->index) {
        return 0;
    }
    add_vote(set, m, (int)first->index);
    while (++m < span->b) {
        if (find_voting_plot_index_in_scan(search, span, m, kernel) >= 0) {
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
    if (first->gap > 0 && !add_first_vote_if_nearest(search, span, first, kernel, set)) {
        return 0;
    }
    int misses = first->gap > 0 ? (int)first->gap - 1 : 0;
    unsigned middle = (span->a + span->b + 1u) / 2u;
    for (unsigned k = 0; k + 1u < (unsigned)span->b - span->a; k++) {
        unsigned m = k % 2u ? middle - (k + 1u) / 2u : middle + k / 2u;
        if (m + first->gap >= span->b && first->gap > 0) {
            continue;
        }
        int plot = find_voting_plot_index_in_scan(search, span, m, kernel);
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
 * Units of work of a kernel besides its votes: with covariances of the plots; with heights or range
 * rates too; and for each alias of a range rate.
 */
#define OWN_UNITS 4u
#define MORE_UNITS 16u
#define ALIAS_UNITS 8u

/*
 * Sets the noise of a kernel's plots and the look-up of votes. Returns 0 where range rates or
 * heights of the plots contradict the kernel's velocity.
 */
static int set_up_kernel(struct search *search, const struct span *span, struct kernel *kernel)
{
    search->initiator->work.seeds = rho_count(search->initiator->work.seeds, 1);
    if (!rho_initiator_takes_isotropic_path(search)) {
        rho_initiator_charge_work(search, search->has_more ? MORE_UNITS : OWN_UNITS);
        return set_up_anisotropic_kernel_if_plausible(search, span, kernel);
    }
    kernel->from_m2 = squared(rho_window_larger_sigma_m(kernel->from));
    kernel->to_m2 = squared(rho_window_larger_sigma_m(kernel->to));
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
 * Collects the votes of a kernel. Where its first plot has an ambiguous range rate, each alias is
 * tried from number *next_alias on, up to the first one with enough votes; *next_alias becomes the
 * number behind that, or 0.
 */
static int collect_votes_with_next_alias(struct search *search, const struct span *span,
                                         const struct first_vote *first, struct kernel *kernel,
                                         int *next_alias, struct plot_set *set)
{
    struct aliases aliases;
    int number = *next_alias;
    *next_alias = 0;
    if (!RHO_AMBIGUOUS_RANGE_RATES || rho_initiator_takes_isotropic_path(search) ||
        !rho_initiator_find_aliases_if_ambiguous(span->scan_a, kernel->from, &kernel->place,
                                                 &aliases)) {
        return collect_votes(search, span, first, kernel, set);
    }
    struct rho_window_place place = kernel->place;
    for (int i = aliases.first + number; i <= aliases.last; i++) {
        rho_initiator_charge_work(search, ALIAS_UNITS);
        rho_initiator_update_kernel_velocity_by_alias(&aliases, i, &place, &kernel->place);
        if (is_range_rate_in_gate(span->scan_b, kernel->to, &kernel->place) &&
            collect_votes(search, span, first, kernel, set)) {
            *next_alias = i + 1 - aliases.first;
            return 1;
        }
        if (i < aliases.last && rho_initiator_is_work_limit_exceeded(search)) {
            search->is_partial = 1;
            return 0;
        }
    }
    return 0;
}

/* True where a target can have the kernel's speed, noise allowed for. */
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

/* True where vote `first` may be in the gate of the kernel, by the widest gate of its scan. */
static int is_first_vote_in_widest_gate(const struct search *search, const struct span *span,
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

int rho_initiator_collect_votes_of_plot_pair(struct search *search, const struct span *span,
                                             const struct ending *ending,
                                             const struct first_vote *first, unsigned i,
                                             int *next_alias, struct plot_set *set)
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
        !is_first_vote_in_widest_gate(search, span, ending, first, &kernel) ||
        rho_initiator_is_work_limit_exceeded(search) || !set_up_kernel(search, span, &kernel)) {
        *next_alias = 0;
        return 0;
    }
    return collect_votes_with_next_alias(search, span, first, &kernel, next_alias, set);
}
