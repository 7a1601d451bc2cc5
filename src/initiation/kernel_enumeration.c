/* SPDX-License-Identifier: MIT */
/*
 * kernel_enumeration: all kernels that end in a plot.
 *
 * There are two ways to them, and the cheaper one is taken for each span of scans. Either each pair
 * of plots is a kernel, for which the scans between vote; or a vote is found first, the third plot,
 * whose line from the ending tells where the kernels with this vote begin.
 */
#include "rhotrack/detail/approx.h"
#include "search.h"

/* Rounding error of a place computed from sums of coordinates, as a share of these. */
#define ROUNDING_SHARE 1e-6f

/* Units of boxes that are charged together. */
#define CHARGED_UNITS 64u

/* Boxes whose gates are narrower than this share of a target's travel need not be cut off there. */
#define NARROW_SHARE 0.25f

/* Near plots are counted bin by bin up to this number of rows. */
#define NEAR_ROWS 16

/* Costs of a kernel and a look-up in plots compared, for the choice between the two ways alone. */
#define FIRST_PLOTS 0.5f
#define KERNEL_PLOTS 3.0f
#define LOOKUP_PLOTS 3.0f
#define LOOKUPS_OF_PAIR 2.0f
#define SHARE_IN_GATE 0.5f /* of the plots under a gate's square */

/* ---- spans ----------------------------------------------------------------------------------- */

static float time_spread_s(const struct rho_window_scan *scan)
{
    return scan->offset_max_s - scan->offset_min_s;
}

static float noise_of_ends_m2(const struct span *span, float al)
{
    float from_m = (1.0f - al) * span->scan_a->sigma_max_m, to_m = al * span->scan_b->sigma_max_m;
    return from_m * from_m + to_m * to_m;
}

/*
 * Widest gate of scan m. The plots' own times shift al by up to `slack`; the variance is convex in
 * al.
 */
static struct voter voter_of(const struct search *search, const struct span *span, unsigned m)
{
    struct voter voter = {0.0f, 0.0f};
    float sigma_m = rho_window_scan_at(&search->initiator->window, m)->sigma_max_m;
    float al = (search->time_s[m] - search->time_s[span->a]) / span->gap_s;
    float slack = (time_spread_s(span->scan_a) + time_spread_s(span->scan_b)) / span->gap_s;
    float low_m2 = noise_of_ends_m2(span, al - slack), high_m2 = noise_of_ends_m2(span, al + slack);
    if (search->fit_process_m2 > 0.0f) {
        voter.process_m2 = rho_initiator_process_variance_m2(search, span->a, m, span->b);
    }
    float bend_m = 0.5f * search->turn_mps2 * (search->time_s[m] - search->time_s[span->a]) *
                   (search->time_s[span->b] - search->time_s[m]);
    voter.process_m2 += bend_m * bend_m;
    voter.gate_radius_m = rho_sqrt(search->gate_chi2 * (sigma_m * sigma_m + voter.process_m2 +
                                                        (low_m2 > high_m2 ? low_m2 : high_m2)));
    return voter;
}

/* True where no plot of these scans is earlier than one of the scan before. */
static int is_ordered(const struct search *search, const struct span *span)
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

static void open_span(struct search *search, struct span *span, struct voter *voters)
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
    if (!rho_initiator_is_isotropic(search)) {
        span->slack_m =
            rho_sqrt(RHO_GATE_CHI2_2D * (span->scan_a->sigma_max_m * span->scan_a->sigma_max_m +
                                         span->scan_b->sigma_max_m * span->scan_b->sigma_max_m));
    }
    for (unsigned m = span->a + 1u; m < span->b; m++) {
        voters[span->b - m - 1u] = voter_of(search, span, m);
    }
}

/*
 * True where some spans need more votes than M. The rule holds where all scans before the end are
 * one sensor's looks in the same sector: other misses may say less.
 */
static int has_span_hits(struct search *search, const struct fan *fan)
{
    struct rho_window *window = &search->initiator->window;
    int has_more = 0;
    for (unsigned n = 0; n < fan->num_spans; n++) {
        has_more |= fan->spans[n].misses_amid < (int)fan->spans[n].misses_max;
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

/* A kernel of M votes spans at least M scans; scans of one instant make none. */
void rho_initiator_open_fan(struct search *search, unsigned b, struct fan *fan)
{
    struct voter *voters = fan->voters;
    fan->num_spans = fan->ordered = 0;
    for (unsigned a = 0; a + search->min_scans <= b + 1u; a++) {
        if (search->time_s[b] > search->time_s[a]) {
            struct span *span = &fan->spans[fan->num_spans++];
            span->a = (uint8_t)a;
            span->b = (uint8_t)b;
            open_span(search, span, voters);
            fan->ordered |= (uint8_t)(is_ordered(search, span) << (fan->num_spans - 1u));
            voters += b - a - 1u;
        }
    }
    fan->has_span_hits = HAS_SPAN_HITS && has_span_hits(search, fan);
}

/* ---- plots in a square ----------------------------------------------------------------------- */

struct box {
    float x0_m, x1_m, y0_m, y1_m;
};

static struct box box_about(const struct rho_window_plot *plot, float gate_radius_m)
{
    return (struct box){plot->x_m - gate_radius_m, plot->x_m + gate_radius_m,
                        plot->y_m - gate_radius_m, plot->y_m + gate_radius_m};
}

static int is_in_box(const struct rho_window_plot *plot, const struct box *box)
{
    return plot->x_m >= box->x0_m && plot->x_m <= box->x1_m && plot->y_m >= box->y0_m &&
           plot->y_m <= box->y1_m;
}

static struct rho_window_bins
bins_under_box(struct search *search, const struct rho_window_scan *scan, const struct box *box)
{
    struct rho_window_bins bins =
        rho_window_bins_under(scan, box->x0_m, box->x1_m, box->y0_m, box->y1_m);
    rho_initiator_charge(search, (uint32_t)(bins.row_last - bins.row_first) + 1u);
    return bins;
}

/* Number of plots in the bins under the box. */
static unsigned count_plots_in_box(struct search *search, const struct rho_window_scan *scan,
                                   const struct box *box)
{
    struct rho_window_bins bins = bins_under_box(search, scan, box);
    unsigned count = 0;
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        count += (unsigned)(start[bins.column_last + 1] - start[bins.column_first]);
    }
    return count;
}

/* ---- pairs ----------------------------------------------------------------------------------- */

/* Distance that a target may have travelled between the ending and the scan, without noise. */
static float travel_max_m(const struct search *search, const struct ending *ending, unsigned b,
                          unsigned m)
{
    const struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, m);
    float time_s = search->time_s[b] - search->time_s[m] + ending->plot->offset_s;
    float most_s = time_s - scan->offset_min_s;
    return most_s > 0.0f ? search->initiator->config.v_max_mps * most_s : 0.0f;
}

/* Makes a candidate of the kernel from plot i of scan a where enough scans vote for it. */
static void try_pair(struct search *search, const struct span *span, const struct ending *ending,
                     const struct first_vote *first, unsigned i)
{
    struct plot_set set;
    int next = 0;
    do {
        if (rho_initiator_vote_for_kernel(search, span, ending, first, i, &next, &set)) {
            rho_initiator_add_candidate(search, &set);
        }
    } while (next > 0);
}

static int try_pairs(struct search *search, const struct span *span, const struct ending *ending)
{
    static const struct first_vote any = {.gap = 0};
    const struct rho_window_scan *scan = span->scan_a;
    struct box box =
        box_about(ending->plot, travel_max_m(search, ending, span->b, span->a) + span->slack_m);
    struct rho_window_bins bins = bins_under_box(search, scan, &box);
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned end = start[bins.column_last + 1];
        rho_initiator_charge(search, end - start[bins.column_first]);
        for (unsigned i = start[bins.column_first]; i < end; i++) {
            try_pair(search, span, ending, &any, i);
        }
        if (rho_initiator_is_spent(search)) {
            return 0;
        }
    }
    return 1;
}

/* ---- the third plot first -------------------------------------------------------------------- */

/* Gates of the third plot and of the vote in the box, and what noise adds to a target's travel. */
struct reach {
    float third_m, own_m, slack_m;
};

/* What the boxes in an earlier scan have in common, whichever the third plot is. */
struct way {
    float begin_s; /* from the scan's first plot to the ending */
    float far_m;   /* most that a target travels in this time, with noise */
    float third_m; /* gate of the third plot, with what rounding may add */
};

static struct way way_from(const struct search *search, const struct rho_window_scan *scan,
                           const struct ending *ending, float gap_s, float third_m, float slack_m)
{
    const float begin_s = gap_s + ending->plot->offset_s - scan->offset_min_s;
    return (struct way){
        .begin_s = begin_s,
        .far_m = search->initiator->config.v_max_mps * begin_s + slack_m,
        .third_m = ending->gate_rounded * third_m + ending->rounding_m,
    };
}

/* A vote before the ending, and the way between the two. */
struct third {
    struct first_vote first;
    float per_s; /* 1 / its time before the ending's; 0: plots of one instant */
    float dx_m, dy_m;
};

/*
 * Makes room for the plots' own times, which spread over this share of the way to the third plot,
 * and cuts off where no target can have come from. At least an edge is left.
 */
static struct box widen_and_clip_box(const struct box *box, const struct ending *ending,
                                     const struct third *third, float spread, float far_m)
{
    const struct box all = box_about(ending->plot, far_m);
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
 * The box in an earlier scan with the kernels that have this vote: the gate of the vote,
 * extrapolated from the ending.
 */
static struct box predict_box(const struct rho_window_scan *scan, const struct ending *ending,
                              const struct third *third, const struct way *way, float own_m)
{
    const struct rho_window_plot *to = ending->plot;
    const float ratio = way->begin_s * third->per_s;
    const float gate_radius_m = ratio * way->third_m + own_m;
    const float x_m = to->x_m + third->dx_m * ratio, y_m = to->y_m + third->dy_m * ratio;
    struct box box = {x_m - gate_radius_m, x_m + gate_radius_m, y_m - gate_radius_m,
                      y_m + gate_radius_m};
    if (HAS_SPAN_HITS && ratio > 0.0f && gate_radius_m < NARROW_SHARE * way->far_m &&
        scan->offset_min_s >= scan->offset_max_s) {
        return box;
    }
    return widen_and_clip_box(&box, ending, third,
                              (scan->offset_max_s - scan->offset_min_s) * third->per_s, way->far_m);
}

/* Tries the kernels of the span that begin in that box. Returns the units that the box takes. */
static uint32_t try_first_plots(struct search *search, const struct span *span,
                                const struct ending *ending, const struct third *third,
                                const struct way *way)
{
    const struct rho_window_scan *scan = span->scan_a;
    const struct box box = predict_box(scan, ending, third, way, 0.0f);
    uint32_t passed = 0;
    struct rho_window_bins bins =
        rho_window_bins_under(scan, box.x0_m, box.x1_m, box.y0_m, box.y1_m);
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned i = start[bins.column_first], end = start[bins.column_last + 1];
        passed += end - i + 1u;
        for (; i < end; i++) {
            if (is_in_box(&scan->plots[i], &box)) {
                try_pair(search, span, ending, &third->first, i);
            }
        }
    }
    return passed;
}

/* True where a plot of the scan before the third plot's may vote for its kernels. */
static int can_previous_scan_vote(const struct rho_window_scan *scan, const struct ending *ending,
                                  const struct third *third, const struct way *way, float own_m,
                                  uint32_t *passed)
{
    const struct box box = predict_box(scan, ending, third, way, own_m);
    const struct rho_window_bins bins =
        rho_window_bins_under(scan, box.x0_m, box.x1_m, box.y0_m, box.y1_m);
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned i = start[bins.column_first], end = start[bins.column_last + 1];
        *passed += end - i + 1u;
        for (; i < end; i++) {
            if (is_in_box(&scan->plots[i], &box)) {
                return 1;
            }
        }
    }
    return 0;
}

/*
 * The spans whose first vote may be `gap` scans before the end, of those in by_votes; a bit each.
 */
static unsigned spans_of_gap(const struct fan *fan, const struct ending *ending, unsigned by_votes,
                             unsigned gap)
{
    unsigned spans = 0;
    for (unsigned n = 0; n < fan->num_spans; n++) {
        if ((by_votes >> n & 1u) &&
            (int)gap <= rho_initiator_misses_max(&fan->spans[n], ending) + 1) {
            spans |= 1u << n;
        }
    }
    return spans;
}

/* The widest gates of these spans. */
static struct reach widest_reach(const struct fan *fan, unsigned spans, unsigned gap)
{
    struct reach reach = {0.0f, 0.0f, 0.0f};
    for (unsigned n = 0; n < fan->num_spans; n++) {
        const struct span *span = &fan->spans[n];
        if (spans >> n & 1u) {
            reach.third_m = rho_larger(reach.third_m, span->voters[gap - 1u].gate_radius_m);
            reach.slack_m = rho_larger(reach.slack_m, span->slack_m);
            if (span->a + gap + 1u < span->b) {
                reach.own_m = rho_larger(reach.own_m, span->voters[gap].gate_radius_m);
            }
        }
    }
    reach.slack_m += GATE_ROUNDING * reach.own_m;
    return reach;
}

/*
 * The ways to the first plots of these spans, whose first vote is `gap` scans before the end.
 * Returns what noise and the gate add to the distance of this vote from the ending.
 */
static float open_ways(const struct search *search, const struct fan *fan,
                       const struct ending *ending, unsigned spans, unsigned gap, struct way *ways)
{
    float far_m = 0.0f;
    for (unsigned n = 0; spans >> n; n++) {
        const struct span *span = &fan->spans[n];
        if (spans >> n & 1u) {
            const float third_m = span->voters[gap - 1u].gate_radius_m;
            ways[n] = way_from(search, span->scan_a, ending, span->gap_s, third_m, span->slack_m);
            far_m = rho_larger(far_m, span->slack_m + GATE_ROUNDING * third_m);
        }
    }
    return far_m;
}

/* Tries the kernels of these spans whose first vote is `gap` scans before the end. */
static int try_third_plots(struct search *search, const struct fan *fan,
                           const struct ending *ending, unsigned spans, unsigned gap)
{
    const unsigned b = fan->spans[0].b;
    const struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, b - gap);
    struct way ways[SPANS_MAX];
    const float far_m = open_ways(search, fan, ending, spans, gap, ways) + ending->rounding_m +
                        GATE_ROUNDING * travel_max_m(search, ending, b, b - gap);
    struct box box = box_about(ending->plot, far_m);
    struct rho_window_bins bins = bins_under_box(search, scan, &box);
    const float gap_s = search->time_s[b] - search->time_s[b - gap] + ending->plot->offset_s;
    /* spans without further misses: where the next scan has no vote there is no kernel of them */
    const unsigned full = !HAS_SPAN_HITS || ending->is_clear
                              ? 0u
                              : spans & ~spans_of_gap(fan, ending, spans, gap + 1u);
    const struct rho_window_scan *next = scan;
    struct way next_way = {0};
    float own_m = 0.0f;
    if (full != 0) {
        const struct reach reach = widest_reach(fan, full, gap);
        next = rho_window_scan_at(&search->initiator->window, b - gap - 1u);
        next_way = way_from(search, next, ending, search->time_s[b] - search->time_s[b - gap - 1u],
                            reach.third_m, reach.slack_m);
        own_m = ending->gate_rounded * reach.own_m;
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
                !can_previous_scan_vote(next, ending, &third, &next_way, own_m, &passed)) {
                tried &= ~full;
            }
            for (unsigned n = 0; tried >> n; n++) {
                if (tried >> n & 1u) {
                    passed += try_first_plots(search, &fan->spans[n], ending, &third, &ways[n]);
                }
            }
            if (passed >= CHARGED_UNITS) {
                rho_initiator_charge(search, passed);
                passed = 0;
                if (rho_initiator_is_spent(search)) {
                    return 0;
                }
            }
        }
    }
    rho_initiator_charge(search, passed);
    return !rho_initiator_is_spent(search);
}

/* ---- which way ------------------------------------------------------------------------------- */

/*
 * True where the way by votes compares fewer plots: where plots lie far apart against their noise.
 * counts: plots that a target in the ending may have come from, summed over the last scans.
 */
static int votes_are_cheaper(struct search *search, const struct span *span,
                             const struct ending *ending, const unsigned *counts)
{
    unsigned width = span->b - span->a;
    unsigned gaps = (unsigned)rho_initiator_misses_max(span, ending) + 1u, thirds = counts[gaps];
    unsigned pairs = counts[width] - counts[width - 1u];
    if (pairs == 0 || thirds == 0) {
        return pairs > 0; /* without a third plot there is nothing to look for */
    }
    const struct rho_window_scan *before =
        rho_window_scan_at(&search->initiator->window, span->b - 1u);
    float gate_radius_m = ending->gate_share * span->voters[0].gate_radius_m;
    float ratio = span->gap_s / (search->time_s[span->b] - search->time_s[span->b - 1u]);
    struct box gate = box_about(ending->plot, gate_radius_m), firsts;
    firsts = box_about(ending->plot, rho_smaller(gate_radius_m * ratio,
                                                 travel_max_m(search, ending, span->b, span->a)));
    float lookup = LOOKUP_PLOTS + (float)count_plots_in_box(search, before, &gate);
    float found = (float)count_plots_in_box(search, span->scan_a, &firsts), by_votes = 0.0f;
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
 * Where the box has many rows of bins, all plots of these rows count: their number is known at
 * once.
 */
unsigned rho_initiator_count_plots_near(struct search *search, const struct fan *fan, unsigned j)
{
    const struct span *widest = &fan->spans[0];
    const struct ending ending = {.plot = &widest->scan_b->plots[j]};
    const struct rho_window_scan *scan =
        rho_window_scan_at(&search->initiator->window, widest->b - 1u);
    float far_m =
        travel_max_m(search, &ending, widest->b, widest->b - 1u) + widest->voters[0].gate_radius_m;
    struct box box = box_about(ending.plot, far_m);
    struct rho_window_bins bins =
        rho_window_bins_under(scan, box.x0_m, box.x1_m, box.y0_m, box.y1_m);
    if (bins.row_last - bins.row_first < NEAR_ROWS) {
        return count_plots_in_box(search, scan, &box);
    }
    rho_initiator_charge(search, 1);
    return (unsigned)(scan->bin_start[(bins.row_last + 1) * scan->bins_x] -
                      scan->bin_start[bins.row_first * scan->bins_x]);
}

static void count_reachable(struct search *search, const struct fan *fan,
                            const struct ending *ending, unsigned *counts)
{
    unsigned b = fan->spans[0].b;
    counts[0] = 0;
    for (unsigned gap = 1; gap <= b - fan->spans[0].a; gap++) {
        struct box box = box_about(ending->plot, travel_max_m(search, ending, b, b - gap));
        const struct rho_window_scan *scan =
            rho_window_scan_at(&search->initiator->window, b - gap);
        counts[gap] = counts[gap - 1u] + count_plots_in_box(search, scan, &box);
    }
}

/*
 * True where clutter is thinner than at the sampled places: sets that end here may start tracks
 * with fewer hits than their spans want elsewhere.
 */
static int is_in_thin_clutter(const struct search *search, const struct rho_window_plot *plot)
{
    const struct rho_initiator *initiator = search->initiator;
    return rho_initiator_mean_density(initiator, plot->x_m, plot->y_m) *
               rho_window_sigma(plot->sigma_range) * rho_window_sigma(plot->sigma_cross) <
           initiator->thin_clutter;
}

int rho_initiator_try_kernels_to(struct search *search, const struct fan *fan, unsigned j)
{
    const struct span *widest = &fan->spans[0];
    struct ending ending = {.plot = &widest->scan_b->plots[j]};
    unsigned counts[RHO_MAX_SCANS] = {0}, by_votes = 0;
    if (rho_initiator_is_spent(search)) {
        return 0;
    }
    float far_m = travel_max_m(search, &ending, widest->b, widest->a);
    ending.rounding_m = ROUNDING_SHARE * (rho_larger(ending.plot->x_m, -ending.plot->x_m) +
                                          rho_larger(ending.plot->y_m, -ending.plot->y_m) + far_m);
    if (!rho_initiator_is_isotropic(search)) {
        ending.noise = rho_window_noise(widest->scan_b, ending.plot);
    }
    rho_initiator_find_vote_gate(search, far_m + widest->slack_m + widest->voters[0].gate_radius_m,
                                 &ending);
    ending.gate_rounded = GATE_ROUNDING * ending.gate_share;
    ending.is_clear =
        !HAS_SPAN_HITS || !fan->has_span_hits || is_in_thin_clutter(search, ending.plot);
    count_reachable(search, fan, &ending, counts);
    for (unsigned n = 0; n < fan->num_spans; n++) {
        if (rho_initiator_misses_max(&fan->spans[n], &ending) < 0) {
            continue;
        }
        if ((fan->ordered >> n & 1u) &&
            votes_are_cheaper(search, &fan->spans[n], &ending, counts)) {
            by_votes |= 1u << n;
        } else if (!try_pairs(search, &fan->spans[n], &ending)) {
            return 0;
        }
    }
    for (unsigned gap = 1; spans_of_gap(fan, &ending, by_votes, gap) != 0; gap++) {
        const unsigned spans = spans_of_gap(fan, &ending, by_votes, gap);
        if (!try_third_plots(search, fan, &ending, spans, gap)) {
            return 0;
        }
    }
    return 1;
}
