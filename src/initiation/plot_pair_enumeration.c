/* SPDX-License-Identifier: MIT */
/*
 * plot_pair_enumeration: finds all kernels that end in a given plot.
 *
 * There are two ways to enumerate them, and the cheaper one is taken for each span of scans. Either
 * each pair of a first plot and the last plot is a kernel, for which the scans between vote. Or a
 * vote near the end, the third plot, is taken first: the line from the last plot through it,
 * extended backwards, tells where the first plots of kernels with this vote lie.
 */
#include "rhotrack/detail/approx.h"
#include "search.h"

/* Rounding error of a place computed from sums of coordinates, as a share of these. */
#define ROUNDING_SHARE 1e-6f

/* Units of work after which the boxes searched so far are charged. */
#define CHARGED_UNITS 64u

/*
 * Largest gate, as a share of a target's travel, for which a box of first plots is not cut off at
 * the places that a target can reach.
 */
#define NARROW_SHARE 0.25f

/*
 * Most rows of bins in which near plots are counted bin by bin; with more, whole rows are counted.
 */
#define NEAR_ROWS 16

/*
 * Costs in plots compared, for the choice between the two ways of enumeration: the test of a first
 * plot, a kernel, a look-up; and the mean number of look-ups of a pair.
 */
#define FIRST_PLOTS 0.5f
#define KERNEL_PLOTS 3.0f
#define LOOKUP_PLOTS 3.0f
#define LOOKUPS_OF_PAIR 2.0f
#define SHARE_IN_GATE 0.5f /* share of the plots in a gate's square that are in the gate */

/* ---- spans ----------------------------------------------------------------------------------- */

static float plot_time_spread_s(const struct rho_window_scan *scan)
{
    return scan->offset_max_s - scan->offset_min_s;
}

/*
 * Largest variance, by the noise of both ends, of a place interpolated at this fraction of a span.
 */
static float largest_interpolated_variance_m2(const struct span *span, float fraction)
{
    float from_m = (1.0f - fraction) * span->scan_a->sigma_max_m,
          to_m = fraction * span->scan_b->sigma_max_m;
    return from_m * from_m + to_m * to_m;
}

/*
 * Process noise and widest gate of scan m as a voter of the span. The plots' own times shift the
 * interpolation factor al by up to `slack`; the variance is convex in al, so the extremes bound it.
 */
static struct voter make_voter(const struct search *search, const struct span *span, unsigned m)
{
    struct voter voter = {0.0f, 0.0f};
    float sigma_m = rho_window_scan_at(&search->initiator->window, m)->sigma_max_m;
    float al = (search->time_s[m] - search->time_s[span->a]) / span->gap_s;
    float slack =
        (plot_time_spread_s(span->scan_a) + plot_time_spread_s(span->scan_b)) / span->gap_s;
    float low_m2 = largest_interpolated_variance_m2(span, al - slack),
          high_m2 = largest_interpolated_variance_m2(span, al + slack);
    if (search->fit_process_m2 > 0.0f) {
        voter.process_m2 = rho_initiator_process_variance_off_line_m2(search, span->a, m, span->b);
    }
    float bend_m = 0.5f * search->turn_mps2 * (search->time_s[m] - search->time_s[span->a]) *
                   (search->time_s[span->b] - search->time_s[m]);
    voter.process_m2 += bend_m * bend_m;
    voter.gate_radius_m = rho_sqrt(search->gate_chi2 * (sigma_m * sigma_m + voter.process_m2 +
                                                        (low_m2 > high_m2 ? low_m2 : high_m2)));
    return voter;
}

/* True where no plot of a scan of the span is earlier than a plot of the scan before it. */
static int are_plots_in_time_order(const struct search *search, const struct span *span)
{
    for (unsigned m = span->a; m < span->b; m++) {
        const struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, m);
        const struct rho_window_scan *next = rho_window_scan_at(&search->initiator->window, m + 1u);
        if (!(search->time_s[m] + scan->offset_max_s <=
              search->time_s[m + 1u] + next->offset_min_s)) {
            return 0;
        }
    }
    return 1;
}

static void set_up_scan_span_and_voting_scans(struct search *search, struct span *span,
                                              struct voter *voters)
{
    struct rho_window *window = &search->initiator->window;
    span->scan_a = rho_window_scan_at(window, span->a);
    span->scan_b = rho_window_scan_at(window, span->b);
    span->gap_s = search->time_s[span->b] - search->time_s[span->a];
    span->misses_max = (uint8_t)(span->b - span->a + 1u - search->min_scans);
    if (HAS_SPAN_HITS) {
        unsigned hits = search->initiator->span_hits[span->a];
        hits = hits > search->min_scans ? hits : search->min_scans;
        span->misses_amid = (int8_t)(span->b - span->a + 1 - (int)hits);
    }
    span->voters = voters;
    span->slack_m = 0.0f;
    if (!rho_initiator_takes_isotropic_path(search)) {
        span->slack_m =
            rho_sqrt(RHO_GATE_CHI2_2D * (span->scan_a->sigma_max_m * span->scan_a->sigma_max_m +
                                         span->scan_b->sigma_max_m * span->scan_b->sigma_max_m));
    }
    for (unsigned m = span->a + 1u; m < span->b; m++) {
        voters[span->b - m - 1u] = make_voter(search, span, m);
    }
}

/*
 * True where some spans need more votes than M. The rule is used where all scans before the last
 * are of one sensor and cover the same sector: elsewhere misses weigh less.
 */
static int do_some_spans_need_more_votes(struct search *search, const struct span_list *list)
{
    struct rho_window *window = &search->initiator->window;
    int has_more = 0;
    for (unsigned n = 0; n < list->num_spans; n++) {
        has_more |= list->spans[n].misses_amid < (int)list->spans[n].misses_max;
    }
    const struct rho_window_scan *first = rho_window_scan_at(window, 0);
    for (unsigned m = 1; m < search->num_scans; m++) {
        const struct rho_window_scan *scan = rho_window_scan_at(window, m);
        has_more &=
            scan->sensor.sensor_id == first->sensor.sensor_id &&
            (m + 1u == search->num_scans ||
             (rho_is_within(scan->sector_from_rad, first->sector_from_rad,
                            first->sector_from_rad) &&
              rho_is_within(scan->sector_to_rad, first->sector_to_rad, first->sector_to_rad)));
    }
    return has_more && search->keeps_rate;
}

/*
 * Lists the spans of kernels that end in scan b: a kernel of M votes spans at least M scans. Scans
 * of one time make no span.
 */
void rho_initiator_list_spans_ending_at(struct search *search, unsigned b, struct span_list *list)
{
    struct voter *voters = list->voters;
    list->num_spans = list->ordered = 0;
    for (unsigned a = 0; a + search->min_scans <= b + 1u; a++) {
        if (search->time_s[b] > search->time_s[a]) {
            struct span *span = &list->spans[list->num_spans++];
            span->a = (uint8_t)a;
            span->b = (uint8_t)b;
            set_up_scan_span_and_voting_scans(search, span, voters);
            list->ordered |=
                (uint8_t)(are_plots_in_time_order(search, span) << (list->num_spans - 1u));
            voters += b - a - 1u;
        }
    }
    list->has_span_hits = HAS_SPAN_HITS && do_some_spans_need_more_votes(search, list);
}

/* ---- plots in a square ----------------------------------------------------------------------- */

struct box {
    float x0_m, x1_m, y0_m, y1_m;
};

static struct box square_about_plot(const struct rho_window_plot *plot, float gate_radius_m)
{
    return (struct box){plot->x_m - gate_radius_m, plot->x_m + gate_radius_m,
                        plot->y_m - gate_radius_m, plot->y_m + gate_radius_m};
}

static int is_plot_in_box(const struct rho_window_plot *plot, const struct box *box)
{
    return plot->x_m >= box->x0_m && plot->x_m <= box->x1_m && plot->y_m >= box->y0_m &&
           plot->y_m <= box->y1_m;
}

static struct rho_window_bins charge_bins_under_box(struct search *search,
                                                    const struct rho_window_scan *scan,
                                                    const struct box *box)
{
    struct rho_window_bins bins =
        rho_window_bins_under(scan, box->x0_m, box->x1_m, box->y0_m, box->y1_m);
    rho_initiator_charge_work(search, (uint32_t)(bins.row_last - bins.row_first) + 1u);
    return bins;
}

/* Number of plots in the bins that a box touches. */
static unsigned count_plots_under_box(struct search *search, const struct rho_window_scan *scan,
                                      const struct box *box)
{
    struct rho_window_bins bins = charge_bins_under_box(search, scan, box);
    unsigned count = 0;
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        count += (unsigned)(start[bins.column_last + 1] - start[bins.column_first]);
    }
    return count;
}

/* ---- pairs ----------------------------------------------------------------------------------- */

/*
 * Longest distance that a target may have travelled between scan m and the kernels' last plot,
 * without noise.
 */
static float target_travel_max_m(const struct search *search, const struct ending *ending,
                                 unsigned b, unsigned m)
{
    const struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, m);
    float time_s = search->time_s[b] - search->time_s[m] + ending->plot->offset_s;
    float most_s = time_s - scan->offset_min_s;
    return most_s > 0.0f ? search->initiator->config.v_max_mps * most_s : 0.0f;
}

/*
 * Makes candidates of the kernels from plot i of scan a for which enough scans vote: several where
 * a range rate is ambiguous.
 */
static void add_candidates_of_pair(struct search *search, const struct span *span,
                                   const struct ending *ending, const struct first_vote *first,
                                   unsigned first_plot_index)
{
    struct plot_set set;
    int next = 0;
    do {
        if (rho_initiator_collect_votes_of_plot_pair(search, span, ending, first, first_plot_index,
                                                     &next, &set)) {
            rho_initiator_add_set_as_candidate(search, &set);
        }
    } while (next > 0);
}

/* Tries a kernel from each reachable plot of the first scan. Returns 0 where the work is spent. */
static int add_candidates_of_pairs_until_work_limit(struct search *search, const struct span *span,
                                                    const struct ending *ending)
{
    static const struct first_vote any = {.gap = 0};
    const struct rho_window_scan *scan = span->scan_a;
    struct box box = square_about_plot(
        ending->plot, target_travel_max_m(search, ending, span->b, span->a) + span->slack_m);
    struct rho_window_bins bins = charge_bins_under_box(search, scan, &box);
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned end = start[bins.column_last + 1];
        rho_initiator_charge_work(search, end - start[bins.column_first]);
        for (unsigned i = start[bins.column_first]; i < end; i++) {
            add_candidates_of_pair(search, span, ending, &any, i);
        }
        if (rho_initiator_is_work_limit_exceeded(search)) {
            return 0;
        }
    }
    return 1;
}

/* ---- the third plot first -------------------------------------------------------------------- */

/*
 * Widest gates over several spans: of the third plot, and of the scan that is looked up next; and
 * the most that noise adds to a target's travel.
 */
struct widest_gates {
    float third_m, own_m, slack_m;
};

/*
 * Values for extending lines from the last plot of kernels, through any third plot, back to an
 * earlier scan.
 */
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
 * Widens a box for the spread of its scan's plot times, `spread` times the displacement of the
 * third plot, and clips it to far_m about the last plot, which no target exceeds. At least an edge
 * is left.
 */
static struct box widen_box_by_time_spread_and_clip(const struct box *box,
                                                    const struct ending *ending,
                                                    const struct third *third, float spread,
                                                    float far_m)
{
    const struct box all = square_about_plot(ending->plot, far_m);
    if (!(third->per_s > 0.0f)) {
        return all;
    }
    const float x_m = spread * third->dx_m, y_m = spread * third->dy_m;
    struct box fitted = {.x0_m = rho_larger(box->x0_m - rho_larger(x_m, 0.0f), all.x0_m),
                         .y0_m = rho_larger(box->y0_m - rho_larger(y_m, 0.0f), all.y0_m)};
    fitted.x1_m =
        rho_larger(fitted.x0_m, rho_smaller(box->x1_m - rho_smaller(x_m, 0.0f), all.x1_m));
    fitted.y1_m =
        rho_larger(fitted.y0_m, rho_smaller(box->y1_m - rho_smaller(y_m, 0.0f), all.y1_m));
    return fitted;
}

/*
 * Box in an earlier scan that holds the plots of kernels with this third plot: the gate of the
 * third plot, extended backwards from the last plot of the kernels, plus the scan's own gate.
 */
static struct box extrapolate_box(const struct rho_window_scan *scan, const struct ending *ending,
                                  const struct third *third, const struct extrapolation *to_scan,
                                  float own_m)
{
    const struct rho_window_plot *to = ending->plot;
    const float ratio = to_scan->begin_s * third->per_s;
    const float gate_radius_m = ratio * to_scan->third_m + own_m;
    const float x_m = to->x_m + third->dx_m * ratio, y_m = to->y_m + third->dy_m * ratio;
    struct box box = {x_m - gate_radius_m, x_m + gate_radius_m, y_m - gate_radius_m,
                      y_m + gate_radius_m};
    if (HAS_SPAN_HITS && ratio > 0.0f && gate_radius_m < NARROW_SHARE * to_scan->far_m &&
        scan->offset_min_s >= scan->offset_max_s) {
        return box;
    }
    return widen_box_by_time_spread_and_clip(
        &box, ending, third, (scan->offset_max_s - scan->offset_min_s) * third->per_s,
        to_scan->far_m);
}

/*
 * Tries the kernels of a span whose first plots lie in the box that the third plot leaves. Returns
 * the work of searching the box, in units.
 */
static uint32_t try_first_plots_in_box_and_return_work(struct search *search,
                                                       const struct span *span,
                                                       const struct ending *ending,
                                                       const struct third *third,
                                                       const struct extrapolation *to_scan)
{
    const struct rho_window_scan *scan = span->scan_a;
    const struct box box = extrapolate_box(scan, ending, third, to_scan, 0.0f);
    uint32_t passed = 0;
    struct rho_window_bins bins =
        rho_window_bins_under(scan, box.x0_m, box.x1_m, box.y0_m, box.y1_m);
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned i = start[bins.column_first], end = start[bins.column_last + 1];
        passed += end - i + 1u;
        for (; i < end; i++) {
            if (is_plot_in_box(&scan->plots[i], &box)) {
                add_candidates_of_pair(search, span, ending, &third->first, i);
            }
        }
    }
    return passed;
}

/*
 * True where the scan before the third plot's has a plot that may vote for kernels with this third
 * plot. Adds the work to *passed.
 */
static int has_voting_plot_in_scan_before_third(const struct rho_window_scan *scan,
                                                const struct ending *ending,
                                                const struct third *third,
                                                const struct extrapolation *to_scan, float own_m,
                                                uint32_t *passed)
{
    const struct box box = extrapolate_box(scan, ending, third, to_scan, own_m);
    const struct rho_window_bins bins =
        rho_window_bins_under(scan, box.x0_m, box.x1_m, box.y0_m, box.y1_m);
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned i = start[bins.column_first], end = start[bins.column_last + 1];
        *passed += end - i + 1u;
        for (; i < end; i++) {
            if (is_plot_in_box(&scan->plots[i], &box)) {
                return 1;
            }
        }
    }
    return 0;
}

/*
 * Spans of among_mask whose misses allow the vote nearest to the end to be `gap` scans
 * before the end; a bit each.
 */
static unsigned mask_of_spans_allowing_gap(const struct span_list *list,
                                           const struct ending *ending, unsigned among_mask,
                                           unsigned gap)
{
    unsigned spans = 0;
    for (unsigned n = 0; n < list->num_spans; n++) {
        if ((among_mask >> n & 1u) &&
            (int)gap <= rho_initiator_misses_max(&list->spans[n], ending) + 1) {
            spans |= 1u << n;
        }
    }
    return spans;
}

/* Widest gates of the spans in a bit mask, whose third plot is `gap` scans before the last. */
static struct widest_gates widest_gates_of_spans(const struct span_list *list, unsigned span_mask,
                                                 unsigned gap)
{
    struct widest_gates widest = {0.0f, 0.0f, 0.0f};
    for (unsigned n = 0; n < list->num_spans; n++) {
        const struct span *span = &list->spans[n];
        if (span_mask >> n & 1u) {
            widest.third_m = rho_larger(widest.third_m, span->voters[gap - 1u].gate_radius_m);
            widest.slack_m = rho_larger(widest.slack_m, span->slack_m);
            if (span->a + gap + 1u < span->b) {
                widest.own_m = rho_larger(widest.own_m, span->voters[gap].gate_radius_m);
            }
        }
    }
    widest.slack_m += GATE_ROUNDING * widest.own_m;
    return widest;
}

/*
 * For each span in a bit mask, sets the values for extending lines back to its first scan, where
 * the third plot is `gap` scans before the last. Returns the most that noise and gate add to a
 * target's travel to the third plot.
 */
static float set_extrapolations_to_first_scan_and_slack_m(const struct search *search,
                                                          const struct span_list *list,
                                                          const struct ending *ending,
                                                          unsigned span_mask, unsigned gap,
                                                          struct extrapolation *to_first)
{
    float far_m = 0.0f;
    for (unsigned n = 0; span_mask >> n; n++) {
        const struct span *span = &list->spans[n];
        if (span_mask >> n & 1u) {
            const float third_m = span->voters[gap - 1u].gate_radius_m;
            to_first[n] = extrapolation_to_scan(search, span->scan_a, ending, span->gap_s, third_m,
                                                span->slack_m);
            far_m = rho_larger(far_m, span->slack_m + GATE_ROUNDING * third_m);
        }
    }
    return far_m;
}

/*
 * Tries the kernels, of the spans in a bit mask, whose vote nearest to the end is `gap` scans
 * before the end. Returns 0 where the work is spent.
 */
static int add_candidates_by_third_plots(struct search *search, const struct span_list *list,
                                         const struct ending *ending, unsigned spans, unsigned gap)
{
    const unsigned b = list->spans[0].b;
    const struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, b - gap);
    struct extrapolation to_first[SPANS_MAX];
    const float far_m =
        set_extrapolations_to_first_scan_and_slack_m(search, list, ending, spans, gap, to_first) +
        ending->rounding_m + GATE_ROUNDING * target_travel_max_m(search, ending, b, b - gap);
    struct box box = square_about_plot(ending->plot, far_m);
    struct rho_window_bins bins = charge_bins_under_box(search, scan, &box);
    const float gap_s = search->time_s[b] - search->time_s[b - gap] + ending->plot->offset_s;
    /* spans that allow no further miss: their kernels need a vote of the next scan back, too */
    const unsigned full = !HAS_SPAN_HITS || ending->is_clear
                              ? 0u
                              : spans & ~mask_of_spans_allowing_gap(list, ending, spans, gap + 1u);
    const struct rho_window_scan *next = scan;
    struct extrapolation to_next = {0};
    float own_m = 0.0f;
    if (full != 0) {
        const struct widest_gates widest = widest_gates_of_spans(list, full, gap);
        next = rho_window_scan_at(&search->initiator->window, b - gap - 1u);
        to_next = extrapolation_to_scan(search, next, ending,
                                        search->time_s[b] - search->time_s[b - gap - 1u],
                                        widest.third_m, widest.slack_m);
        own_m = ending->gate_rounded * widest.own_m;
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
            if ((full & (full - 1u)) != 0 && !has_voting_plot_in_scan_before_third(
                                                 next, ending, &third, &to_next, own_m, &passed)) {
                tried &= ~full;
            }
            for (unsigned n = 0; tried >> n; n++) {
                if (tried >> n & 1u) {
                    passed += try_first_plots_in_box_and_return_work(search, &list->spans[n],
                                                                     ending, &third, &to_first[n]);
                }
            }
            if (passed >= CHARGED_UNITS) {
                rho_initiator_charge_work(search, passed);
                passed = 0;
                if (rho_initiator_is_work_limit_exceeded(search)) {
                    return 0;
                }
            }
        }
    }
    rho_initiator_charge_work(search, passed);
    return !rho_initiator_is_work_limit_exceeded(search);
}

/* ---- which way ------------------------------------------------------------------------------- */

/*
 * True where enumeration by third plots compares fewer plots than by pairs: where plots lie far
 * apart against their noise. counts[gap]: plots in the last `gap` scans that a target in the last
 * plot may have come from.
 */
static int is_cheaper_by_third_plots(struct search *search, const struct span *span,
                                     const struct ending *ending, const unsigned *counts)
{
    unsigned width = span->b - span->a;
    unsigned gaps = (unsigned)rho_initiator_misses_max(span, ending) + 1u, thirds = counts[gaps];
    unsigned pairs = counts[width] - counts[width - 1u];
    if (pairs == 0 || thirds == 0) {
        return pairs > 0; /* without a third plot there is no kernel, and no cost */
    }
    const struct rho_window_scan *before =
        rho_window_scan_at(&search->initiator->window, span->b - 1u);
    float gate_radius_m = ending->gate_share * span->voters[0].gate_radius_m;
    float ratio = span->gap_s / (search->time_s[span->b] - search->time_s[span->b - 1u]);
    struct box gate = square_about_plot(ending->plot, gate_radius_m), firsts;
    firsts = square_about_plot(
        ending->plot,
        rho_smaller(gate_radius_m * ratio, target_travel_max_m(search, ending, span->b, span->a)));
    float lookup = LOOKUP_PLOTS + (float)count_plots_under_box(search, before, &gate);
    float found = (float)count_plots_under_box(search, span->scan_a, &firsts), by_votes = 0.0f;
    float in_gate = SHARE_IN_GATE * ending->along_share / ending->gate_share;
    for (unsigned gap = 1; gap <= gaps; gap++) {
        float kernel = KERNEL_PLOTS + (float)(gap + 1u) * lookup;
        by_votes +=
            (float)(counts[gap] - counts[gap - 1u]) *
            (1.0f + LOOKUP_PLOTS + found * (FIRST_PLOTS + in_gate * kernel) / (float)(gap * gap));
    }
    return by_votes < (float)pairs * (KERNEL_PLOTS + LOOKUPS_OF_PAIR * lookup);
}

/*
 * Number of plots, in the scan before the list's last, that a target in plot j may have come from.
 * Where the box has many rows of bins all plots of these rows count, as their number is known at
 * once.
 */
unsigned rho_initiator_count_previous_plots_near(struct search *search,
                                                 const struct span_list *list, unsigned j)
{
    const struct span *widest = &list->spans[0];
    const struct ending ending = {.plot = &widest->scan_b->plots[j]};
    const struct rho_window_scan *scan =
        rho_window_scan_at(&search->initiator->window, widest->b - 1u);
    float far_m = target_travel_max_m(search, &ending, widest->b, widest->b - 1u) +
                  widest->voters[0].gate_radius_m;
    struct box box = square_about_plot(ending.plot, far_m);
    struct rho_window_bins bins =
        rho_window_bins_under(scan, box.x0_m, box.x1_m, box.y0_m, box.y1_m);
    if (bins.row_last - bins.row_first < NEAR_ROWS) {
        return count_plots_under_box(search, scan, &box);
    }
    rho_initiator_charge_work(search, 1);
    return (unsigned)(scan->bin_start[(bins.row_last + 1) * scan->bins_x] -
                      scan->bin_start[bins.row_first * scan->bins_x]);
}

/*
 * Sets counts[gap] to the number of plots in the last `gap` scans that a target in the kernels'
 * last plot may have come from.
 */
static void count_reachable_plots_up_to_gap(struct search *search, const struct span_list *list,
                                            const struct ending *ending, unsigned *counts)
{
    unsigned b = list->spans[0].b;
    counts[0] = 0;
    for (unsigned gap = 1; gap <= b - list->spans[0].a; gap++) {
        struct box box =
            square_about_plot(ending->plot, target_travel_max_m(search, ending, b, b - gap));
        const struct rho_window_scan *scan =
            rho_window_scan_at(&search->initiator->window, b - gap);
        counts[gap] = counts[gap - 1u] + count_plots_under_box(search, scan, &box);
    }
}

/*
 * True where clutter at a plot is thinner than at all sampled places: sets that end there may start
 * tracks with fewer hits than their span needs elsewhere.
 */
static int is_in_thin_clutter(const struct search *search, const struct rho_window_plot *plot)
{
    const struct rho_initiator *initiator = search->initiator;
    return rho_initiator_mean_clutter_density(initiator, plot->x_m, plot->y_m) *
               rho_window_decode_sigma(plot->sigma_range) *
               rho_window_decode_sigma(plot->sigma_cross) <
           initiator->thin_clutter;
}

int rho_initiator_finish_kernels_ending_at_plot(struct search *search, const struct span_list *list,
                                                unsigned j)
{
    const struct span *widest = &list->spans[0];
    struct ending ending = {.plot = &widest->scan_b->plots[j]};
    unsigned counts[RHO_MAX_SCANS] = {0}, by_votes = 0;
    if (rho_initiator_is_work_limit_exceeded(search)) {
        return 0;
    }
    float far_m = target_travel_max_m(search, &ending, widest->b, widest->a);
    ending.rounding_m = ROUNDING_SHARE * (rho_larger(ending.plot->x_m, -ending.plot->x_m) +
                                          rho_larger(ending.plot->y_m, -ending.plot->y_m) + far_m);
    if (!rho_initiator_takes_isotropic_path(search)) {
        ending.noise = rho_window_plot_noise_covariance(widest->scan_b, ending.plot);
    }
    rho_initiator_set_gate_shares_of_ending_plot(
        search, far_m + widest->slack_m + widest->voters[0].gate_radius_m, &ending);
    ending.gate_rounded = GATE_ROUNDING * ending.gate_share;
    ending.is_clear =
        !HAS_SPAN_HITS || !list->has_span_hits || is_in_thin_clutter(search, ending.plot);
    count_reachable_plots_up_to_gap(search, list, &ending, counts);
    for (unsigned n = 0; n < list->num_spans; n++) {
        if (rho_initiator_misses_max(&list->spans[n], &ending) < 0) {
            continue;
        }
        if ((list->ordered >> n & 1u) &&
            is_cheaper_by_third_plots(search, &list->spans[n], &ending, counts)) {
            by_votes |= 1u << n;
        } else if (!add_candidates_of_pairs_until_work_limit(search, &list->spans[n], &ending)) {
            return 0;
        }
    }
    for (unsigned gap = 1; mask_of_spans_allowing_gap(list, &ending, by_votes, gap) != 0; gap++) {
        const unsigned spans = mask_of_spans_allowing_gap(list, &ending, by_votes, gap);
        if (!add_candidates_by_third_plots(search, list, &ending, spans, gap)) {
            return 0;
        }
    }
    return 1;
}
