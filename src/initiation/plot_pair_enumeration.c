/* SPDX-License-Identifier: MIT */
/*
 * plot_pair_enumeration: finds all kernels that end in a given plot.
 *
 * There are two ways to enumerate them, and the cheaper one is taken for each span of scans. Either
 * each pair of a first plot and the last plot is a kernel, for which the scans between vote. Or a
 * vote near the end, the third plot, is taken first: the line from the last plot through it,
 * extended backwards, tells where the first plots of kernels with this vote lie.
 */
#include "candidates.h"
#include "clutter_density.h"
#include "kernels.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "target_model.h"

/* Most rows of bins in which near plots are counted bin by bin; beyond, by whole rows. */
enum { NEAR_ROWS = 16 };

static float plot_time_spread_s(const struct rho_window_scan *scan)
{
    return scan->offset_max_s - scan->offset_min_s;
}

/* Largest variance, by the noise of both ends, of a place at this fraction of a span. */
static float interpolated_variance_m2(const struct span *span, float fraction)
{
    float from_m = (1.0f - fraction) * span->scan_a->sigma_max_m,
          to_m = fraction * span->scan_b->sigma_max_m;
    return from_m * from_m + to_m * to_m;
}

/*
 * Sets the scans, votes and voters of a span. A voter's gate: the plots' own times shift the
 * interpolation factor al by up to `slack`; the variance is convex in al, so the extremes bound it.
 */
static void set_up_span(struct search *search, struct span *span, struct voter *voters)
{
    span->scan_a = rho_search_scan(search, span->a);
    span->scan_b = rho_search_scan(search, span->b);
    span->gap_s = search->time_s[span->b] - search->time_s[span->a];
    span->misses_max = (uint8_t)(span->b - span->a + 1u - search->min_scans);
    if (HAS_SPAN_HITS) {
        unsigned hits = search->initiator->span_hits[span->a];
        hits = hits > search->min_scans ? hits : search->min_scans;
        span->misses_amid = (int8_t)(span->b - span->a + 1 - (int)hits);
    }
    span->voters = voters;
    span->slack_m = 0.0f;
    if (!rho_search_is_isotropic(search)) {
        span->slack_m =
            rho_sqrt(RHO_GATE_CHI2_2D * (span->scan_a->sigma_max_m * span->scan_a->sigma_max_m +
                                         span->scan_b->sigma_max_m * span->scan_b->sigma_max_m));
    }
    const float slack =
        (plot_time_spread_s(span->scan_a) + plot_time_spread_s(span->scan_b)) / span->gap_s;
    for (unsigned m = span->a + 1u; m < span->b; m++) {
        struct voter *voter = &voters[span->b - m - 1u];
        const float sigma_m = rho_search_scan(search, m)->sigma_max_m;
        const float after_s = search->time_s[m] - search->time_s[span->a];
        const float al = after_s / span->gap_s;
        const float low_m2 = interpolated_variance_m2(span, al - slack);
        const float high_m2 = interpolated_variance_m2(span, al + slack);
        const float bend_m =
            0.5f * search->turn_mps2 * after_s * (search->time_s[span->b] - search->time_s[m]);
        voter->process_m2 = search->fit_process_m2 > 0.0f
                                ? rho_target_off_line_m2(search, span->a, m, span->b)
                                : 0.0f;
        voter->process_m2 += bend_m * bend_m;
        voter->gate_radius_m = rho_sqrt(search->gate_chi2 * (sigma_m * sigma_m + voter->process_m2 +
                                                             rho_larger(low_m2, high_m2)));
    }
}

/* True where no plot of a scan of the span is earlier than a plot of the scan before it. */
static int are_plots_in_time_order(const struct search *search, const struct span *span)
{
    for (unsigned m = span->a; m < span->b; m++) {
        if (!(search->time_s[m] + rho_search_scan(search, m)->offset_max_s <=
              search->time_s[m + 1u] + rho_search_scan(search, m + 1u)->offset_min_s)) {
            return 0;
        }
    }
    return 1;
}

/*
 * True where some spans need more votes than M. The rule is used where all scans before the last
 * are of one sensor and cover the same sector: elsewhere misses weigh less.
 */
static int need_spans_more_votes(struct search *search, const struct span_list *list)
{
    int has_more = 0;
    for (unsigned n = 0; n < list->num_spans; n++) {
        has_more |= list->spans[n].misses_amid < (int)list->spans[n].misses_max;
    }
    const struct rho_window_scan *first = rho_search_scan(search, 0);
    for (unsigned m = 1; m < search->num_scans; m++) {
        const struct rho_window_scan *scan = rho_search_scan(search, m);
        has_more &= scan->sensor.sensor_id == first->sensor.sensor_id &&
                    (m + 1u == search->num_scans ||
                     (rho_is_equal(scan->sector_from_rad, first->sector_from_rad) &&
                      rho_is_equal(scan->sector_to_rad, first->sector_to_rad)));
    }
    return has_more && search->keeps_rate;
}

/* A kernel of M votes spans at least M scans. Scans of one time make no span. */
void rho_kernels_list_spans(struct search *search, unsigned b, struct span_list *list)
{
    struct voter *voters = list->voters;
    list->num_spans = list->ordered = 0;
    for (unsigned a = 0; a + search->min_scans <= b + 1u; a++) {
        if (search->time_s[b] > search->time_s[a]) {
            struct span *span = &list->spans[list->num_spans++];
            span->a = (uint8_t)a;
            span->b = (uint8_t)b;
            set_up_span(search, span, voters);
            list->ordered |=
                (uint8_t)(are_plots_in_time_order(search, span) << (list->num_spans - 1u));
            voters += b - a - 1u;
        }
    }
    list->has_span_hits = HAS_SPAN_HITS && need_spans_more_votes(search, list);
}

static struct rho_extent square_about_plot(const struct rho_window_plot *plot, float gate_radius_m)
{
    return (struct rho_extent){plot->x_m - gate_radius_m, plot->x_m + gate_radius_m,
                               plot->y_m - gate_radius_m, plot->y_m + gate_radius_m};
}

static struct rho_window_bins charge_bins(struct search *search, const struct rho_window_scan *scan,
                                          const struct rho_extent *box)
{
    struct rho_window_bins bins = rho_window_bins_under(scan, box);
    rho_search_charge(search, (uint32_t)(bins.row_last - bins.row_first) + 1u);
    return bins;
}

/* Number of plots in the bins that a box touches. */
static unsigned count_plots_under_box(struct search *search, const struct rho_window_scan *scan,
                                      const struct rho_extent *box)
{
    struct rho_window_bins bins = charge_bins(search, scan, box);
    unsigned count = 0;
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        count += (unsigned)(start[bins.column_last + 1] - start[bins.column_first]);
    }
    return count;
}

/* Longest travel of a target from scan m to the kernels' last plot, without noise. */
static float target_travel_max_m(const struct search *search, const struct ending *ending,
                                 unsigned b, unsigned m)
{
    const struct rho_window_scan *scan = rho_search_scan(search, m);
    float time_s = search->time_s[b] - search->time_s[m] + ending->plot->offset_s;
    float most_s = time_s - scan->offset_min_s;
    return most_s > 0.0f ? search->initiator->config.v_max_mps * most_s : 0.0f;
}

/* Makes candidates of the kernels from plot i: several where a range rate is ambiguous. */
static void add_candidates_of_pair(struct search *search, const struct span *span,
                                   const struct ending *ending, const struct first_vote *first,
                                   unsigned i)
{
    struct plot_set set;
    int next = 0;
    do {
        if (rho_kernel_collect_votes(search, span, ending, first, i, &next, &set)) {
            rho_candidates_add(search, &set);
        }
    } while (next > 0);
}

/* Tries a kernel from each reachable plot of the first scan. Returns 0 where the work is spent. */
static int try_pairs(struct search *search, const struct span *span, const struct ending *ending)
{
    static const struct first_vote any = {.gap = 0};
    const struct rho_window_scan *scan = span->scan_a;
    struct rho_extent box = square_about_plot(
        ending->plot, target_travel_max_m(search, ending, span->b, span->a) + span->slack_m);
    struct rho_window_bins bins = charge_bins(search, scan, &box);
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned end = start[bins.column_last + 1];
        rho_search_charge(search, end - start[bins.column_first]);
        for (unsigned i = start[bins.column_first]; i < end; i++) {
            add_candidates_of_pair(search, span, ending, &any, i);
        }
        if (rho_search_is_over_limit(search)) {
            return 0;
        }
    }
    return 1;
}

/* Values for lines from the kernels' last plot, through any third plot, to an earlier scan. */
struct extrapolation {
    float begin_s; /* time from the scan's first plot to the kernels' last plot */
    float far_m;   /* most that a target travels in that time, noise included */
    float third_m; /* gate radius of the third plot, rounding included */
};

static struct extrapolation extrapolation_to_scan(const struct search *search,
                                                  const struct rho_window_scan *scan,
                                                  const struct ending *ending, float gap_s,
                                                  float third_m, float slack_m)
{
    const float begin_s = gap_s + ending->plot->offset_s - scan->offset_min_s;
    return (struct extrapolation){
        .begin_s = begin_s,
        .far_m = search->initiator->config.v_max_mps * begin_s + slack_m,
        .third_m = ending->gate_rounded * third_m + ending->rounding_m,
    };
}

/* A third plot: a vote before the kernels' last plot, and its displacement from there. */
struct third {
    struct first_vote first;
    /* 1 / time between the third plot and the last plot; 0 where the third is not earlier */
    float per_s;
    float dx_m, dy_m;
};

/*
 * Box in an earlier scan that holds the plots of kernels with this third plot: the gate of the
 * third plot, extended backwards from the last plot of the kernels, plus the scan's own gate. A
 * narrow box of plots of one time is that. Others are widened by the travel over the plot times and
 * clipped to far_m about the last plot, which no target exceeds; at least an edge is left.
 */
static struct rho_extent extrapolate_box(const struct rho_window_scan *scan,
                                         const struct ending *ending, const struct third *third,
                                         const struct extrapolation *to_scan, float own_m)
{
    const struct rho_window_plot *to = ending->plot;
    const float ratio = to_scan->begin_s * third->per_s;
    const float gate_radius_m = ratio * to_scan->third_m + own_m;
    const float x_m = to->x_m + third->dx_m * ratio, y_m = to->y_m + third->dy_m * ratio;
    struct rho_extent box = {x_m - gate_radius_m, x_m + gate_radius_m, y_m - gate_radius_m,
                             y_m + gate_radius_m};
    if (HAS_SPAN_HITS && ratio > 0.0f && gate_radius_m < NARROW_SHARE * to_scan->far_m &&
        scan->offset_min_s >= scan->offset_max_s) {
        return box;
    }
    const struct rho_extent all = square_about_plot(ending->plot, to_scan->far_m);
    if (!(third->per_s > 0.0f)) {
        return all;
    }
    const float spread = plot_time_spread_s(scan) * third->per_s;
    const float later_x_m = spread * third->dx_m, later_y_m = spread * third->dy_m;
    struct rho_extent fitted = {
        .x_min_m = rho_larger(box.x_min_m - rho_larger(later_x_m, 0.0f), all.x_min_m),
        .y_min_m = rho_larger(box.y_min_m - rho_larger(later_y_m, 0.0f), all.y_min_m)};
    fitted.x_max_m = rho_larger(
        fitted.x_min_m, rho_smaller(box.x_max_m - rho_smaller(later_x_m, 0.0f), all.x_max_m));
    fitted.y_max_m = rho_larger(
        fitted.y_min_m, rho_smaller(box.y_max_m - rho_smaller(later_y_m, 0.0f), all.y_max_m));
    return fitted;
}

/*
 * Tries the kernels of a span whose first plots lie in the box that the third plot leaves. Returns
 * the work of searching the box, in units.
 */
static uint32_t try_first_plots(struct search *search, const struct span *span,
                                const struct ending *ending, const struct third *third,
                                const struct extrapolation *to_scan)
{
    const struct rho_window_scan *scan = span->scan_a;
    const struct rho_extent box = extrapolate_box(scan, ending, third, to_scan, 0.0f);
    uint32_t passed = 0;
    struct rho_window_bins bins = rho_window_bins_under(scan, &box);
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned i = start[bins.column_first], end = start[bins.column_last + 1];
        passed += end - i + 1u;
        for (; i < end; i++) {
            if (rho_extent_holds(&box, scan->plots[i].x_m, scan->plots[i].y_m)) {
                add_candidates_of_pair(search, span, ending, &third->first, i);
            }
        }
    }
    return passed;
}

/* True where the scan before the third plot's may vote, too. Adds the work to *passed. */
static int has_vote_before_third(const struct rho_window_scan *scan, const struct ending *ending,
                                 const struct third *third, const struct extrapolation *to_scan,
                                 float own_m, uint32_t *passed)
{
    const struct rho_extent box = extrapolate_box(scan, ending, third, to_scan, own_m);
    const struct rho_window_bins bins = rho_window_bins_under(scan, &box);
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned i = start[bins.column_first], end = start[bins.column_last + 1];
        *passed += end - i + 1u;
        for (; i < end; i++) {
            if (rho_extent_holds(&box, scan->plots[i].x_m, scan->plots[i].y_m)) {
                return 1;
            }
        }
    }
    return 0;
}

/* Spans of among_mask whose misses allow the last vote to be `gap` scans before the end. */
static unsigned spans_allowing_gap(const struct span_list *list, const struct ending *ending,
                                   unsigned among_mask, unsigned gap)
{
    unsigned spans = 0;
    for (unsigned n = 0; n < list->num_spans; n++) {
        if ((among_mask >> n & 1u) &&
            (int)gap <= rho_span_misses_max(&list->spans[n], ending) + 1) {
            spans |= 1u << n;
        }
    }
    return spans;
}

/*
 * Tries the kernels, of the spans in a bit mask, whose vote nearest to the end is `gap` scans
 * before the end. Returns 0 where the work is spent.
 */
static int try_third_plots(struct search *search, const struct span_list *list,
                           const struct ending *ending, unsigned spans, unsigned gap)
{
    const unsigned b = list->spans[0].b;
    const struct rho_window_scan *scan = rho_search_scan(search, b - gap), *next = scan;
    struct extrapolation to_first[SPANS_MAX], to_next = {0};
    float far_m = 0.0f, own_m = 0.0f; /* far_m: to the third plot, with noise and gates */
    for (unsigned n = 0; spans >> n; n++) {
        const struct span *span = &list->spans[n];
        if (spans >> n & 1u) {
            const float third_m = span->voters[gap - 1u].gate_radius_m;
            to_first[n] = extrapolation_to_scan(search, span->scan_a, ending, span->gap_s, third_m,
                                                span->slack_m);
            far_m = rho_larger(far_m, span->slack_m + GATE_ROUNDING * third_m);
        }
    }
    far_m = far_m + ending->rounding_m +
            GATE_ROUNDING * target_travel_max_m(search, ending, b, b - gap);
    struct rho_extent box = square_about_plot(ending->plot, far_m);
    struct rho_window_bins bins = charge_bins(search, scan, &box);
    const float gap_s = search->time_s[b] - search->time_s[b - gap] + ending->plot->offset_s;
    /* spans that allow no further miss: their kernels need a vote of the next scan back, too */
    const unsigned full = !HAS_SPAN_HITS || ending->is_clear
                              ? 0u
                              : spans & ~spans_allowing_gap(list, ending, spans, gap + 1u);
    if (full != 0) {
        float third_m = 0.0f, slack_m = 0.0f; /* widest of these spans */
        for (unsigned n = 0; n < list->num_spans; n++) {
            const struct span *span = &list->spans[n];
            if (full >> n & 1u) {
                third_m = rho_larger(third_m, span->voters[gap - 1u].gate_radius_m);
                slack_m = rho_larger(slack_m, span->slack_m);
                if (span->a + gap + 1u < span->b) {
                    own_m = rho_larger(own_m, span->voters[gap].gate_radius_m);
                }
            }
        }
        next = rho_search_scan(search, b - gap - 1u);
        to_next = extrapolation_to_scan(search, next, ending,
                                        search->time_s[b] - search->time_s[b - gap - 1u], third_m,
                                        slack_m + GATE_ROUNDING * own_m);
        own_m = ending->gate_rounded * own_m;
    }
    struct third third = {.first = {.gap = gap}};
    uint32_t passed = 0;
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned k = start[bins.column_first], end = start[bins.column_last + 1];
        passed += end - k;
        for (; k < end; k++) {
            third.dx_m = scan->plots[k].x_m - ending->plot->x_m;
            third.dy_m = scan->plots[k].y_m - ending->plot->y_m;
            if (third.dx_m * third.dx_m + third.dy_m * third.dy_m > far_m * far_m ||
                (scan->marks[k] & search->skip_flags)) {
                continue;
            }
            const float before_s = gap_s - scan->plots[k].offset_s;
            third.per_s = before_s > 0.0f ? 1.0f / before_s : 0.0f;
            third.first.index = k;
            unsigned tried = spans;
            if ((full & (full - 1u)) != 0 &&
                !has_vote_before_third(next, ending, &third, &to_next, own_m, &passed)) {
                tried &= ~full;
            }
            for (unsigned n = 0; tried >> n; n++) {
                if (tried >> n & 1u) {
                    passed +=
                        try_first_plots(search, &list->spans[n], ending, &third, &to_first[n]);
                }
            }
            if (passed >= CHARGED_UNITS) {
                rho_search_charge(search, passed);
                passed = 0;
                if (rho_search_is_over_limit(search)) {
                    return 0;
                }
            }
        }
    }
    rho_search_charge(search, passed);
    return !rho_search_is_over_limit(search);
}

/*
 * True where enumeration by third plots compares fewer plots than by pairs: where plots lie far
 * apart against their noise. counts[gap]: as in rho_kernels_try_ending.
 */
static int are_third_plots_cheaper(struct search *search, const struct span *span,
                                   const struct ending *ending, const unsigned *counts)
{
    unsigned width = span->b - span->a;
    unsigned gaps = (unsigned)rho_span_misses_max(span, ending) + 1u, thirds = counts[gaps];
    unsigned pairs = counts[width] - counts[width - 1u];
    if (pairs == 0 || thirds == 0) {
        return pairs > 0; /* without a third plot there is no kernel, and no cost */
    }
    const struct rho_window_scan *before = rho_search_scan(search, span->b - 1u);
    float gate_radius_m = ending->gate_share * span->voters[0].gate_radius_m;
    float ratio = span->gap_s / (search->time_s[span->b] - search->time_s[span->b - 1u]);
    struct rho_extent gate = square_about_plot(ending->plot, gate_radius_m), firsts;
    firsts = square_about_plot(
        ending->plot,
        rho_smaller(gate_radius_m * ratio, target_travel_max_m(search, ending, span->b, span->a)));
    float lookup = LOOKUP_PLOTS + (float)count_plots_under_box(search, before, &gate);
    float found = (float)count_plots_under_box(search, span->scan_a, &firsts), by_votes = 0.0f;
    float in_gate = SHARE_IN_GATE * ending->along_share / ending->gate_share;
    for (unsigned gap = 1; gap <= gaps; gap++) {
        float kernel = LOOKUP_PLOTS + (float)(gap + 1u) * lookup;
        by_votes +=
            (float)(counts[gap] - counts[gap - 1u]) *
            (1.0f + LOOKUP_PLOTS + found * (FIRST_PLOTS + in_gate * kernel) / (float)(gap * gap));
    }
    return by_votes < (float)pairs * (LOOKUP_PLOTS + LOOKUPS_OF_PAIR * lookup);
}

/* Where the box has many rows of bins all plots of these rows count, which costs no more. */
unsigned rho_kernels_count_near(struct search *search, const struct span_list *list, unsigned j)
{
    const struct span *widest = &list->spans[0];
    const struct ending ending = {.plot = &widest->scan_b->plots[j]};
    const struct rho_window_scan *scan = rho_search_scan(search, widest->b - 1u);
    float far_m = target_travel_max_m(search, &ending, widest->b, widest->b - 1u) +
                  widest->voters[0].gate_radius_m;
    struct rho_extent box = square_about_plot(ending.plot, far_m);
    struct rho_window_bins bins = rho_window_bins_under(scan, &box);
    if (bins.row_last - bins.row_first < NEAR_ROWS) {
        return count_plots_under_box(search, scan, &box);
    }
    rho_search_charge(search, 1);
    return (unsigned)(scan->bin_start[(bins.row_last + 1) * scan->bins_x] -
                      scan->bin_start[bins.row_first * scan->bins_x]);
}

int rho_kernels_try_ending(struct search *search, const struct span_list *list, unsigned j)
{
    const struct rho_initiator *initiator = search->initiator;
    const struct span *widest = &list->spans[0];
    const struct rho_window_plot *plot = &widest->scan_b->plots[j];
    struct ending ending = {.plot = plot};
    /* by gap: plots in the last `gap` scans that a target in the plot may have come from */
    unsigned counts[RHO_MAX_SCANS] = {0}, by_votes = 0;
    if (rho_search_is_over_limit(search)) {
        return 0;
    }
    float far_m = target_travel_max_m(search, &ending, widest->b, widest->a);
    /* float32 rounds a place computed from sums of coordinates by less than a millionth of these */
    ending.rounding_m =
        1e-6f * (rho_larger(plot->x_m, -plot->x_m) + rho_larger(plot->y_m, -plot->y_m) + far_m);
    if (!rho_search_is_isotropic(search)) {
        ending.noise = rho_window_plot_noise(widest->scan_b, plot);
    }
    rho_vote_gates_of_ending(search, far_m + widest->slack_m + widest->voters[0].gate_radius_m,
                             &ending);
    ending.gate_rounded = GATE_ROUNDING * ending.gate_share;
    /* where clutter is thinner than at all sampled places, sets with fewer hits may start */
    ending.is_clear = !HAS_SPAN_HITS || !list->has_span_hits ||
                      rho_density_mean_at(initiator, plot->x_m, plot->y_m) *
                              rho_window_decode_sigma(plot->sigma_range) *
                              rho_window_decode_sigma(plot->sigma_cross) <
                          initiator->thin_clutter;
    for (unsigned gap = 1; gap <= (unsigned)widest->b - widest->a; gap++) {
        struct rho_extent box = square_about_plot(
            plot, target_travel_max_m(search, &ending, widest->b, widest->b - gap));
        counts[gap] = counts[gap - 1u] +
                      count_plots_under_box(search, rho_search_scan(search, widest->b - gap), &box);
    }
    for (unsigned n = 0; n < list->num_spans; n++) {
        if (rho_span_misses_max(&list->spans[n], &ending) < 0) {
            continue;
        }
        if ((list->ordered >> n & 1u) &&
            are_third_plots_cheaper(search, &list->spans[n], &ending, counts)) {
            by_votes |= 1u << n;
        } else if (!try_pairs(search, &list->spans[n], &ending)) {
            return 0;
        }
    }
    for (unsigned gap = 1; spans_allowing_gap(list, &ending, by_votes, gap) != 0; gap++) {
        const unsigned spans = spans_allowing_gap(list, &ending, by_votes, gap);
        if (!try_third_plots(search, list, &ending, spans, gap)) {
            return 0;
        }
    }
    return 1;
}
