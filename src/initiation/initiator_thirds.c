/* SPDX-License-Identifier: MIT */
/*
 * initiator_thirds: the kernels that end in a plot, by pairs of plots or by their first votes: the third plot first.
 */
#include "initiator_search.h"
#include "rhotrack/approx.h"

/* What rounding may take off a place that sums of coordinates tell, as a share of these. */
#define ROUNDING_SHARE 1e-6f

/* A crowd is counted bin by bin in so many rows at most. */
#define CROWD_ROWS 16

/* What a kernel and a look-up cost in plots compared, for the choice between the two ways alone. */
#define FIRST_PLOTS 0.5f
#define KERNEL_PLOTS 3.0f
#define LOOKUP_PLOTS 3.0f
#define LOOKUPS_OF_PAIR 2.0f
#define SHARE_IN_GATE 0.5f /* of the plots under a gate's square */

/* ---- spans ------------------------------------------------------------------------------------ */

static float spread_s(const struct rho_window_scan *scan)
{
    return scan->offset_max_s - scan->offset_min_s;
}

static float ends_m2(const struct span *span, float al)
{
    float from_m = (1.0f - al) * span->scan_a->sigma_max_m, to_m = al * span->scan_b->sigma_max_m;
    return from_m * from_m + to_m * to_m;
}

/* Widest gate of scan m. Plots' own times move al by up to `slack`; the variance is convex in al. */
static struct voter voter_of(const struct search *search, const struct span *span, unsigned m)
{
    struct voter voter = {0.0f, 0.0f};
    float sigma_m = rho_window_scan_at(&search->initiator->window, m)->sigma_max_m;
    float al = (search->time_s[m] - search->time_s[span->a]) / span->gap_s;
    float slack = (spread_s(span->scan_a) + spread_s(span->scan_b)) / span->gap_s;
    float low_m2 = ends_m2(span, al - slack), high_m2 = ends_m2(span, al + slack);
    if (search->fit_process_m2 > 0.0f) {
        voter.process_m2 = rho_initiator_process_gap_m2(search, span->a, m, span->b);
    }
    float bend_m = 0.5f * search->turn_mps2 * (search->time_s[m] - search->time_s[span->a]) *
                   (search->time_s[span->b] - search->time_s[m]);
    voter.process_m2 += bend_m * bend_m;
    voter.reach_m = rho_sqrt(search->reach_chi2 * (sigma_m * sigma_m + voter.process_m2 +
                                                   (low_m2 > high_m2 ? low_m2 : high_m2)));
    return voter;
}

/* Whether no plot of these scans is earlier than one of the scan before. */
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
    span->is_ordered = (uint8_t)is_ordered(search, span);
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

/* A kernel of M votes spans at least M scans; scans of one instant make none. */
void rho_initiator_open_fan(struct search *search, unsigned b, struct fan *fan)
{
    struct voter *voters = fan->voters;
    fan->num_spans = 0;
    for (unsigned a = 0; a + search->min_scans <= b + 1u; a++) {
        if (search->time_s[b] > search->time_s[a]) {
            struct span *span = &fan->spans[fan->num_spans++];
            span->a = (uint8_t)a;
            span->b = (uint8_t)b;
            open_span(search, span, voters);
            voters += b - a - 1u;
        }
    }
}

/* ---- plots in a square ------------------------------------------------------------------------ */

struct box {
    float x0_m, x1_m, y0_m, y1_m;
};

static struct box box_about(const struct rho_window_plot *plot, float reach_m)
{
    return (struct box){plot->x_m - reach_m, plot->x_m + reach_m, plot->y_m - reach_m,
                        plot->y_m + reach_m};
}

static struct rho_window_bins bins_under(struct search *search, const struct rho_window_scan *scan,
                                         const struct box *box)
{
    struct rho_window_bins bins =
        rho_window_bins_under(scan, box->x0_m, box->x1_m, box->y0_m, box->y1_m);
    rho_initiator_charge(search, (uint32_t)(bins.row_last - bins.row_first) + 1u);
    return bins;
}

/* Plots in the bins under it. */
static unsigned count_in(struct search *search, const struct rho_window_scan *scan,
                         const struct box *box)
{
    struct rho_window_bins bins = bins_under(search, scan, box);
    unsigned count = 0;
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        count += (unsigned)(start[bins.column_last + 1] - start[bins.column_first]);
    }
    return count;
}

/* ---- pairs ------------------------------------------------------------------------------------ */

/* How far a target may have been from the plot in the scan, noise apart. */
static float run_m(const struct search *search, const struct ending *ending, unsigned b, unsigned m)
{
    const struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, m);
    float time_s = search->time_s[b] - search->time_s[m] + ending->plot->offset_s;
    float most_s = time_s - scan->offset_min_s;
    return most_s > 0.0f ? search->initiator->config.v_max_mps * most_s : 0.0f;
}

/* Offers the kernel from plot i of scan a where enough scans vote for it. */
static void try_pair(struct search *search, const struct span *span, const struct ending *ending,
                     const struct first_vote *first, unsigned i)
{
    struct plot_set set;
    int next = 0;
    do {
        if (rho_initiator_vote_for(search, span, ending, first, i, &next, &set)) {
            rho_initiator_offer(search, &set);
        }
    } while (next > 0);
}

static int try_pairs(struct search *search, const struct span *span, const struct ending *ending)
{
    static const struct first_vote any = {.gap = 0};
    const struct rho_window_scan *scan = span->scan_a;
    struct box box =
        box_about(ending->plot, run_m(search, ending, span->b, span->a) + span->slack_m);
    struct rho_window_bins bins = bins_under(search, scan, &box);
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

/* ---- the third plot first --------------------------------------------------------------------- */

static float least(float a, float b)
{
    return a < b ? a : b;
}

static float most(float a, float b)
{
    return a > b ? a : b;
}

/* A vote before the ending, and the target that both show. */
struct third {
    struct first_vote first;
    float before_s; /* its time before the ending's; 0: plots of one instant */
    float vx_mps, vy_mps;
};

/*
 * Where that target has been in scan a: the gate of the vote, seen from there. All kernels that have both begin in the box. 0
 * where no target can.
 */
static int extrapolate(const struct search *search, const struct span *span,
                       const struct ending *ending, const struct third *third, struct box *box)
{
    const struct rho_window_plot *to = ending->plot;
    float begin_s = span->gap_s + to->offset_s - span->scan_a->offset_min_s;
    float end_s = span->gap_s + to->offset_s - span->scan_a->offset_max_s;
    float far_m = search->initiator->config.v_max_mps * begin_s + span->slack_m;
    *box = box_about(to, far_m);
    if (!(third->before_s > 0.0f)) {
        return 1;
    }
    float reach_m =
        begin_s / third->before_s *
        (REACH_ROUNDING * ending->reach_share * span->voters[third->first.gap - 1u].reach_m +
         ending->rounding_m);
    float x0_m = to->x_m - third->vx_mps * begin_s, x1_m = to->x_m - third->vx_mps * end_s;
    float y0_m = to->y_m - third->vy_mps * begin_s, y1_m = to->y_m - third->vy_mps * end_s;
    box->x0_m = most(box->x0_m, least(x0_m, x1_m) - reach_m);
    box->x1_m = least(box->x1_m, most(x0_m, x1_m) + reach_m);
    box->y0_m = most(box->y0_m, least(y0_m, y1_m) - reach_m);
    box->y1_m = least(box->y1_m, most(y0_m, y1_m) + reach_m);
    return box->x0_m <= box->x1_m && box->y0_m <= box->y1_m;
}

/* Kernels of the span that begin there. */
static void try_begins(struct search *search, const struct span *span, const struct ending *ending,
                       const struct third *third)
{
    const struct rho_window_scan *scan = span->scan_a;
    struct box box;
    uint32_t passed = 0;
    if (!extrapolate(search, span, ending, third, &box)) {
        return;
    }
    struct rho_window_bins bins =
        rho_window_bins_under(scan, box.x0_m, box.x1_m, box.y0_m, box.y1_m);
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned i = start[bins.column_first], end = start[bins.column_last + 1];
        passed += end - i + 1u;
        for (; i < end; i++) {
            const struct rho_window_plot *plot = &scan->plots[i];
            if (plot->x_m >= box.x0_m && plot->x_m <= box.x1_m && plot->y_m >= box.y0_m &&
                plot->y_m <= box.y1_m) {
                try_pair(search, span, ending, &third->first, i);
            }
        }
    }
    rho_initiator_charge(search, passed);
}

/* Spans of which a vote so many scans before the end may be the first; bit n of by_votes: those to look for. */
static unsigned spans_of_gap(const struct fan *fan, unsigned by_votes, unsigned gap)
{
    unsigned spans = 0;
    for (unsigned n = 0; n < fan->num_spans; n++) {
        if ((by_votes >> n & 1u) && gap <= fan->spans[n].misses_max + 1u) {
            spans |= 1u << n;
        }
    }
    return spans;
}

/* How far votes of so many scans before may be from the ending: a target's way, what noise adds to the speed, and the gate. */
static float far_of_gap(const struct search *search, const struct fan *fan,
                        const struct ending *ending, unsigned spans, unsigned gap)
{
    unsigned b = fan->spans[0].b;
    float far_m = 0.0f;
    for (unsigned n = 0; n < fan->num_spans; n++) {
        const struct span *span = &fan->spans[n];
        if (spans >> n & 1u) {
            far_m = most(far_m, span->slack_m + REACH_ROUNDING * span->voters[gap - 1u].reach_m);
        }
    }
    return far_m + ending->rounding_m + REACH_ROUNDING * run_m(search, ending, b, b - gap);
}

static void try_third(struct search *search, const struct fan *fan, const struct ending *ending,
                      unsigned spans, unsigned gap, unsigned k)
{
    unsigned b = fan->spans[0].b;
    const struct rho_window_plot *plot =
        &rho_window_scan_at(&search->initiator->window, b - gap)->plots[k];
    const struct rho_window_plot *to = ending->plot;
    float before_s = search->time_s[b] - search->time_s[b - gap] + to->offset_s - plot->offset_s;
    float per_s = before_s > 0.0f ? 1.0f / before_s : 0.0f;
    const struct third third = {.first = {.gap = gap, .index = k},
                                .before_s = before_s,
                                .vx_mps = (to->x_m - plot->x_m) * per_s,
                                .vy_mps = (to->y_m - plot->y_m) * per_s};
    for (unsigned n = 0; spans >> n; n++) {
        if (spans >> n & 1u) {
            try_begins(search, &fan->spans[n], ending, &third);
        }
    }
}

/* Kernels of these spans whose first vote is so many scans before the end. */
static int try_gap(struct search *search, const struct fan *fan, const struct ending *ending,
                   unsigned spans, unsigned gap)
{
    const struct rho_window_scan *scan =
        rho_window_scan_at(&search->initiator->window, fan->spans[0].b - gap);
    float far_m = far_of_gap(search, fan, ending, spans, gap);
    struct box box = box_about(ending->plot, far_m);
    struct rho_window_bins bins = bins_under(search, scan, &box);
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned end = start[bins.column_last + 1];
        rho_initiator_charge(search, end - start[bins.column_first]);
        for (unsigned k = start[bins.column_first]; k < end; k++) {
            float dx_m = scan->plots[k].x_m - ending->plot->x_m;
            float dy_m = scan->plots[k].y_m - ending->plot->y_m;
            if (dx_m * dx_m + dy_m * dy_m > far_m * far_m ||
                (scan->marks[k] & search->skip_flags)) {
                continue;
            }
            try_third(search, fan, ending, spans, gap, k);
            if (rho_initiator_is_spent(search)) {
                return 0;
            }
        }
    }
    return 1;
}

/* ---- which way -------------------------------------------------------------------------------- */

/*
 * Whether fewer plots are compared where kernels are looked for by their first votes: where plots lie far apart against
 * their noise. counts: of the plots that a target may have come from, by scans before, in all of these.
 */
static int is_by_votes(struct search *search, const struct span *span, const struct ending *ending,
                       const unsigned *counts)
{
    unsigned width = span->b - span->a, thirds = counts[span->misses_max + 1u];
    unsigned pairs = counts[width] - counts[width - 1u];
    if (!span->is_ordered || pairs == 0 || thirds == 0) {
        return span->is_ordered &&
               pairs > 0; /* without a third plot there is nothing to look for */
    }
    const struct rho_window_scan *before =
        rho_window_scan_at(&search->initiator->window, span->b - 1u);
    float reach_m = ending->reach_share * span->voters[0].reach_m;
    float ratio = span->gap_s / (search->time_s[span->b] - search->time_s[span->b - 1u]);
    struct box gate = box_about(ending->plot, reach_m), firsts;
    firsts =
        box_about(ending->plot, least(reach_m * ratio, run_m(search, ending, span->b, span->a)));
    float lookup = LOOKUP_PLOTS + (float)count_in(search, before, &gate);
    float found = (float)count_in(search, span->scan_a, &firsts), by_votes = 0.0f;
    float in_gate = SHARE_IN_GATE * ending->along_share / ending->reach_share;
    for (unsigned gap = 1; gap <= span->misses_max + 1u; gap++) {
        float kernel = KERNEL_PLOTS + (float)(gap + 1u) * lookup;
        by_votes +=
            (float)(counts[gap] - counts[gap - 1u]) *
            (1.0f + LOOKUP_PLOTS + found * (FIRST_PLOTS + in_gate * kernel) / (float)(gap * gap));
    }
    return by_votes < (float)pairs * (KERNEL_PLOTS + LOOKUPS_OF_PAIR * lookup);
}

/* Plots of the scan before that a target may have come from: the more there are, the more the kernels cost. Where that is many
 * rows of bins, all of these rows count: that is known at once. */
unsigned rho_initiator_crowd(struct search *search, const struct fan *fan, unsigned j)
{
    const struct span *widest = &fan->spans[0];
    const struct ending ending = {.plot = &widest->scan_b->plots[j]};
    const struct rho_window_scan *scan =
        rho_window_scan_at(&search->initiator->window, widest->b - 1u);
    float far_m = run_m(search, &ending, widest->b, widest->b - 1u) + widest->voters[0].reach_m;
    struct box box = box_about(ending.plot, far_m);
    struct rho_window_bins bins =
        rho_window_bins_under(scan, box.x0_m, box.x1_m, box.y0_m, box.y1_m);
    if (bins.row_last - bins.row_first < CROWD_ROWS) {
        return count_in(search, scan, &box);
    }
    rho_initiator_charge(search, 1);
    return (unsigned)(scan->bin_start[(bins.row_last + 1) * scan->bins_x] -
                      scan->bin_start[bins.row_first * scan->bins_x]);
}

static void count_before(struct search *search, const struct fan *fan, const struct ending *ending,
                         unsigned *counts)
{
    unsigned b = fan->spans[0].b;
    counts[0] = 0;
    for (unsigned gap = 1; gap <= b - fan->spans[0].a; gap++) {
        struct box box = box_about(ending->plot, run_m(search, ending, b, b - gap));
        const struct rho_window_scan *scan =
            rho_window_scan_at(&search->initiator->window, b - gap);
        counts[gap] = counts[gap - 1u] + count_in(search, scan, &box);
    }
}

int rho_initiator_try_ending(struct search *search, const struct fan *fan, unsigned j)
{
    const struct span *widest = &fan->spans[0];
    struct ending ending = {.plot = &widest->scan_b->plots[j]};
    unsigned counts[RHO_MAX_SCANS] = {0}, by_votes = 0;
    if (rho_initiator_is_spent(search)) {
        return 0;
    }
    float far_m = run_m(search, &ending, widest->b, widest->a);
    ending.rounding_m = ROUNDING_SHARE * (most(ending.plot->x_m, -ending.plot->x_m) +
                                          most(ending.plot->y_m, -ending.plot->y_m) + far_m);
    if (!rho_initiator_is_isotropic(search)) {
        ending.noise = rho_window_noise(widest->scan_b, ending.plot);
    }
    rho_initiator_find_reach(search, far_m + widest->slack_m + widest->voters[0].reach_m, &ending);
    count_before(search, fan, &ending, counts);
    for (unsigned n = 0; n < fan->num_spans; n++) {
        if (is_by_votes(search, &fan->spans[n], &ending, counts)) {
            by_votes |= 1u << n;
        } else if (!try_pairs(search, &fan->spans[n], &ending)) {
            return 0;
        }
    }
    for (unsigned gap = 1; spans_of_gap(fan, by_votes, gap) != 0; gap++) {
        if (!try_gap(search, fan, &ending, spans_of_gap(fan, by_votes, gap), gap)) {
            return 0;
        }
    }
    return 1;
}
