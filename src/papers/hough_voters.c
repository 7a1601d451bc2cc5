/* SPDX-License-Identifier: MIT */
/* hough_voters: the plots that voted for a cell, the track through them; memberships. */
#include "hough_search.h"

#include "rhotrack/detail/approx.h"

/* The cell whose voters are wanted, and the range of lines that vote for it. */
struct cell_query {
    struct rho_hough *hough;
    const struct rho_hough_points *points;
    int32_t row, column;
    struct rho_line line; /* line through the centre of the cell */
    /* largest differences in rho and theta of a line that votes for the cell */
    float rho_m, theta_rad;
    uint32_t theta_shares[RHO_HOUGH_REACH_MAX + 1], rho_shares[RHO_HOUGH_REACH_MAX + 1];
};

/*
 * Whether a line within rho_m and theta_rad of `line` can go through plot i: the plot's distance
 * from `line` is at most rho_m plus the effect of the angle at the plot's range.
 */
static int may_be_on_line(const struct rho_hough_points *points, uint32_t i, struct rho_line line,
                          float rho_m, float theta_rad)
{
    float x_m = points->at.x_m[i], y_m = points->at.y_m[i];
    float off_m = x_m * rho_cos(line.theta_rad) + y_m * rho_sin(line.theta_rad) - line.rho_m;
    float range_m = rho_sqrt(x_m * x_m + y_m * y_m);
    /* one part in a hundred and 0.1 m for rounding */
    float most_m = (rho_m + range_m * theta_rad * (1.0f + theta_rad)) * 1.01f + 0.1f;
    return off_m <= most_m && -off_m <= most_m;
}

static int is_plot_near(const struct cell_query *query, uint32_t i)
{
    return may_be_on_line(query->points, i, query->line, query->rho_m, query->theta_rad);
}

/* Finds the two nearest kernels of a line: pairs of plots of the two scans before `scan`. */
static struct rho_hough_nearest search_kernels(const struct rho_hough *hough,
                                               const struct rho_hough_points *points, unsigned scan,
                                               struct rho_line line)
{
    float rho_m = 2.0f * hough->config.eps_rho_m, theta_rad = 2.0f * hough->config.eps_theta_rad;
    struct rho_hough_nearest nearest = {.count = 0};
    uint32_t middle = rho_hough_scan_start(points, scan - 1u), end = points->at.scan_end[scan - 1u];
    for (uint32_t i = rho_hough_scan_start(points, scan - 2u); i < middle; i++) {
        for (uint32_t j = middle; j < end && may_be_on_line(points, i, line, rho_m, theta_rad);
             j++) {
            struct rho_hough_pair pair = {i, j};
            if (may_be_on_line(points, j, line, rho_m, theta_rad) &&
                rho_hough_speed_check(hough, points, pair) == RHO_SPEED_WITHIN) {
                rho_hough_rank_kernel(hough, line, rho_hough_line_through_pair(points, pair), pair,
                                      &nearest);
            }
        }
    }
    return nearest;
}

struct rho_hough_memberships rho_hough_memberships_of_pair(const struct rho_hough *hough,
                                                           const struct rho_hough_points *points,
                                                           unsigned scan,
                                                           struct rho_hough_pair pair)
{
    if (scan < 2 || !rho_hough_uses_kernels(hough) ||
        rho_hough_speed_check(hough, points, pair) != RHO_SPEED_WITHIN) {
        return (struct rho_hough_memberships){0};
    }
    struct rho_line line = rho_hough_line_through_pair(points, pair);
    struct rho_hough_nearest nearest = search_kernels(hough, points, scan, line);
    return rho_hough_vote_of_line(hough, points, line, &nearest).of;
}

/* Vote of a pair for the queried cell; weight 0: the pair does not vote for it. */
static struct rho_hough_vote pair_vote_for_cell(const struct cell_query *query, unsigned scan,
                                                struct rho_hough_pair pair)
{
    const struct rho_hough *hough = query->hough;
    const struct rho_hough_points *points = query->points;
    const struct rho_hough_vote none = {.weight = 0};
    enum rho_hough_speed_check speed = rho_hough_speed_check(hough, points, pair);
    int takes_all = hough->config.method == RHO_HOUGH_MHT;
    if (speed == RHO_SPEED_NO_LINE || (speed == RHO_SPEED_OUTSIDE && !takes_all)) {
        return none;
    }
    struct rho_line line = rho_hough_line_through_pair(points, pair);
    int32_t column = rho_hough_column_of_rho(hough, line.rho_m);
    int is_spread = hough->config.method == RHO_HOUGH_NHT_C;
    if (column < 0) {
        return none;
    }
    int32_t rows = rho_hough_row_of_theta(hough, line.theta_rad) - query->row;
    int32_t all = hough->theta_cells;
    if (2 * rows > all || 2 * rows < -all) { /* nearer across the ends of theta; rho is reversed */
        rows += rows > 0 ? -all : all;
        column = hough->rho_cells - 1 - column;
    }
    rows = rows < 0 ? -rows : rows;
    int32_t columns = column < query->column ? query->column - column : column - query->column;
    if (rows > (is_spread ? hough->theta_reach : 0) ||
        columns > (is_spread ? hough->rho_reach : 0)) {
        return none;
    }
    if (!rho_hough_uses_kernels(hough)) {
        return (struct rho_hough_vote){.weight = RHO_HOUGH_VOTE};
    }
    if (scan < 2) {
        return none;
    }
    struct rho_hough_nearest nearest = search_kernels(hough, points, scan, line);
    struct rho_hough_vote vote = rho_hough_vote_of_line(hough, points, line, &nearest);
    uint32_t *parts[] = {&vote.weight, &vote.of.truth, &vote.of.indeterminacy, &vote.of.falsity};
    for (unsigned i = 0; is_spread && i < sizeof parts / sizeof parts[0]; i++) {
        *parts[i] =
            rho_hough_scale_votes(rho_hough_scale_votes(*parts[i], query->theta_shares[rows]),
                                  query->rho_shares[columns]);
    }
    return vote;
}

/*
 * Sum of the votes for the queried cell of plot i paired with each plot of the next scan
 * (next_else_previous) or of the previous one; adds their memberships to *sums.
 */
static uint32_t votes_of_plot_pairs(const struct cell_query *query, unsigned scan, uint32_t i,
                                    int next_else_previous, struct rho_hough_memberships *sums)
{
    const struct rho_hough_points *points = query->points;
    unsigned other = next_else_previous ? scan + 1u : scan - 1u;
    uint32_t votes = 0;
    for (uint32_t j = rho_hough_scan_start(points, other); j < points->at.scan_end[other]; j++) {
        if (is_plot_near(query, j)) {
            struct rho_hough_pair pair = {next_else_previous ? i : j, next_else_previous ? j : i};
            struct rho_hough_vote vote =
                pair_vote_for_cell(query, next_else_previous ? other : scan, pair);
            votes = rho_count(votes, vote.weight);
            sums->truth = rho_count(sums->truth, vote.of.truth);
            sums->indeterminacy = rho_count(sums->indeterminacy, vote.of.indeterminacy);
            sums->falsity = rho_count(sums->falsity, vote.of.falsity);
        }
    }
    return votes;
}

/* Sums of the least-squares fit of position over time, relative to the first plot. */
struct sums {
    float x0_m, y0_m, t0_s, n, t, tt, x, tx, y, ty;
};

static void add_plot_to_fit(const struct cell_query *query, unsigned scan, uint32_t i,
                            struct sums *sums, struct rho_hough_track *track)
{
    const struct rho_accumulator_points *at = &query->points->at;
    if (track->num_plots == 0) {
        sums->x0_m = at->x_m[i];
        sums->y0_m = at->y_m[i];
        sums->t0_s = query->points->t_s[i];
    }
    float t = query->points->t_s[i] - sums->t0_s, x = at->x_m[i] - sums->x0_m,
          y = at->y_m[i] - sums->y0_m;
    sums->n += 1.0f;
    sums->t += t;
    sums->tt += t * t;
    sums->x += x;
    sums->tx += t * x;
    sums->y += y;
    sums->ty += t * y;
    track->num_plots = rho_count(track->num_plots, 1);
    track->scans = (uint16_t)(track->scans + !(track->mask >> scan & 1u));
    track->mask = (uint16_t)(track->mask | 1u << scan);
}

/*
 * Pair methods: whether plot i is in a pair that voted for the queried cell. The pair's votes are
 * added to the track with its second plot.
 */
static int add_pair_votes_of_plot(const struct cell_query *query, unsigned scan, uint32_t i,
                                  struct rho_hough_track *track)
{
    if (!is_plot_near(query, i)) {
        return 0;
    }
    /* not added to the track here: these votes count with the plots of the next scan */
    struct rho_hough_memberships behind = {0};
    uint32_t before = scan > 0 ? votes_of_plot_pairs(query, scan, i, 0, &track->sums) : 0;
    track->votes = rho_count(track->votes, before);
    return before > 0 || (scan + 1u < query->points->at.num_scans &&
                          votes_of_plot_pairs(query, scan, i, 1, &behind) > 0);
}

void rho_hough_fit_track_to_voters(struct rho_hough *hough, const struct rho_hough_points *points,
                                   unsigned theta_cell, unsigned rho_cell, float at_s,
                                   struct rho_hough_track *track)
{
    const struct rho_hough_config *config = &hough->config;
    int is_spread = config->method == RHO_HOUGH_NHT_C;
    float rows = is_spread ? hough->theta_reach : 0.0f;
    float columns = is_spread ? hough->rho_reach : 0.0f;
    struct cell_query query = {
        .hough = hough,
        .points = points,
        .row = (int32_t)theta_cell,
        .column = (int32_t)rho_cell,
        .line = {rho_hough_rho_m(hough, rho_cell), rho_hough_theta_rad(hough, theta_cell)},
        .rho_m = (columns + 0.5f) * config->rho_cell_m,
        .theta_rad = (rows + 1.0f) * config->theta_cell_rad};
    *track = (struct rho_hough_track){.votes = 0};
    if (is_spread) {
        rho_hough_spread_weights(query.theta_shares, hough->theta_reach, config->theta_cell_rad,
                                 config->eps_theta_rad);
        rho_hough_spread_weights(query.rho_shares, hough->rho_reach, config->rho_cell_m,
                                 config->eps_rho_m);
    }
    struct sums sums = {.n = 0.0f};
    for (unsigned scan = 0, i = 0; scan < points->at.num_scans; scan++) {
        for (; i < points->at.scan_end[scan]; i++) {
            int has_voted;
            if (config->method == RHO_HOUGH_HT) {
                int column = rho_accumulator_cell_of_point(&hough->work.accumulator, theta_cell,
                                                           points->at.x_m[i], points->at.y_m[i]);
                int is_again = config->votes == RHO_VOTES_SCANS && (track->mask >> scan & 1u);
                has_voted = column == query.column;
                track->votes =
                    rho_count(track->votes, has_voted && !is_again ? RHO_HOUGH_VOTE : 0u);
            } else {
                has_voted = add_pair_votes_of_plot(&query, scan, i, track);
            }
            if (has_voted) {
                add_plot_to_fit(&query, scan, i, &sums, track);
            }
        }
    }
    float divisor = sums.n * sums.tt - sums.t * sums.t;
    float n = sums.n > 0.0f ? sums.n : 1.0f, ahead_s = at_s - sums.t0_s - sums.t / n;
    track->has_velocity = track->scans >= 2 && divisor > 1.0e-6f * sums.n * sums.tt;
    if (track->has_velocity) {
        track->vx_mps = (sums.n * sums.tx - sums.t * sums.x) / divisor;
        track->vy_mps = (sums.n * sums.ty - sums.t * sums.y) / divisor;
    }
    track->x_m = sums.x0_m + sums.x / n + track->vx_mps * ahead_s;
    track->y_m = sums.y0_m + sums.y / n + track->vy_mps * ahead_s;
}
