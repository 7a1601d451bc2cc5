/* SPDX-License-Identifier: MIT */
/*
 * hough_pairs: pairs of plots of successive scans, the lines through them, and their votes, which
 * in NHT depend on kernels, the pairs of the two scans before.
 */
#include "hough_search.h"

#include <string.h>

#include "rhotrack/detail/approx.h"

int rho_hough_uses_kernels(const struct rho_hough *hough)
{
    return hough->config.method == RHO_HOUGH_NHT_A || hough->config.method == RHO_HOUGH_NHT_C;
}

enum rho_hough_speed_check rho_hough_speed_check(const struct rho_hough *hough,
                                                 const struct rho_hough_points *points,
                                                 struct rho_hough_pair pair)
{
    float dx_m = points->at.x_m[pair.second] - points->at.x_m[pair.first];
    float dy_m = points->at.y_m[pair.second] - points->at.y_m[pair.first];
    float dt_s = points->t_s[pair.second] - points->t_s[pair.first];
    float least_m = hough->config.v_min_mps * dt_s, most_m = hough->config.v_max_mps * dt_s;
    float distance2 = dx_m * dx_m + dy_m * dy_m;
    if (!(distance2 > 0.0f)) {
        return RHO_SPEED_NO_LINE;
    }
    return dt_s > 0.0f && distance2 >= least_m * least_m && distance2 <= most_m * most_m
               ? RHO_SPEED_WITHIN
               : RHO_SPEED_OUTSIDE;
}

struct rho_line rho_hough_line_through_pair(const struct rho_hough_points *points,
                                            struct rho_hough_pair pair)
{
    float x_m = points->at.x_m[pair.first], y_m = points->at.y_m[pair.first];
    return rho_angle_line(x_m, y_m, points->at.x_m[pair.second] - x_m,
                          points->at.y_m[pair.second] - y_m);
}

/*
 * Squared distance of two lines in units of eps, (drho / eps)^2 + (dtheta / eps)^2; negative where
 * either difference is more than 2 eps.
 */
static float line_distance2(const struct rho_hough *hough, struct rho_line a, struct rho_line b)
{
    float drho_m = a.rho_m - b.rho_m, dtheta_rad = a.theta_rad - b.theta_rad;
    if (dtheta_rad > RHO_HALF_PI ||
        dtheta_rad < -RHO_HALF_PI) { /* (-rho, theta +- pi) is the same line, and nearer */
        dtheta_rad += dtheta_rad > 0.0f ? -RHO_PI : RHO_PI;
        drho_m = a.rho_m + b.rho_m;
    }
    float rho = drho_m / hough->config.eps_rho_m;
    float theta = dtheta_rad / hough->config.eps_theta_rad;
    return rho * rho <= 4.0f && theta * theta <= 4.0f ? rho * rho + theta * theta : -1.0f;
}

void rho_hough_rank_kernel(const struct rho_hough *hough, struct rho_line line,
                           struct rho_line kernel, struct rho_hough_pair pair,
                           struct rho_hough_nearest *nearest)
{
    float distance2 = line_distance2(hough, line, kernel);
    if (distance2 < 0.0f) {
        return;
    }
    uint32_t rank = nearest->count;
    for (; rank > 0; rank--) {
        const struct rho_hough_pair other = nearest->pair[rank - 1u];
        float least2 = nearest->distance2[rank - 1u];
        int is_lower =
            pair.first != other.first ? pair.first < other.first : pair.second < other.second;
        if (distance2 > least2 || (!(distance2 < least2) && !is_lower)) {
            break;
        }
    }
    if (rank == 0) {
        nearest->distance2[1] = nearest->distance2[0];
        nearest->pair[1] = nearest->pair[0];
    }
    if (rank < 2) {
        nearest->distance2[rank] = distance2;
        nearest->pair[rank] = pair;
        nearest->count += nearest->count < 2;
    }
}

/*
 * Indeterminacy of a line: Gaussian of its distance from the line midway between the two nearest
 * kernels; 0 where there are not two kernels or they are farther than 2 eps.
 */
static float kernel_indeterminacy(const struct rho_hough *hough,
                                  const struct rho_hough_points *points, struct rho_line line,
                                  const struct rho_hough_nearest *nearest)
{
    const struct rho_hough_pair *a = &nearest->pair[0], *b = &nearest->pair[1];
    const float *x_m = points->at.x_m, *y_m = points->at.y_m;
    float first_x_m = 0.5f * (x_m[a->first] + x_m[b->first]);
    float first_y_m = 0.5f * (y_m[a->first] + y_m[b->first]);
    float dx_m = 0.5f * (x_m[a->second] + x_m[b->second]) - first_x_m;
    float dy_m = 0.5f * (y_m[a->second] + y_m[b->second]) - first_y_m;
    if (nearest->count < 2 || !(dx_m * dx_m + dy_m * dy_m > 0.0f)) {
        return 0.0f;
    }
    struct rho_line between = rho_angle_line(first_x_m, first_y_m, dx_m, dy_m);
    float distance2 = line_distance2(hough, line, between);
    return distance2 < 0.0f ? 0.0f : rho_exp(-0.5f * distance2);
}

static uint32_t to_vote_parts(float membership)
{
    return (uint32_t)(membership * (float)RHO_HOUGH_VOTE + 0.5f);
}

struct rho_hough_vote rho_hough_vote_of_line(const struct rho_hough *hough,
                                             const struct rho_hough_points *points,
                                             struct rho_line line,
                                             const struct rho_hough_nearest *nearest)
{
    const struct rho_hough_config *config = &hough->config;
    const float f = config->lambda_k * config->p_false * config->p_false;
    const float t = nearest->count > 0 ? rho_exp(-0.5f * nearest->distance2[0]) : 0.0f;
    const float i = kernel_indeterminacy(hough, points, line, nearest);
    const float vote = config->uses_indeterminacy && i > t ? i : t;
    return (struct rho_hough_vote){
        .weight = f > vote ? 0 : to_vote_parts(vote),
        .of = {to_vote_parts(t), to_vote_parts(i), to_vote_parts(f < 1.0f ? f : 1.0f)}};
}

/*
 * Bin of a kernel's line. Bins are at least 2 eps wide in rho and theta, with a whole number over
 * [0, pi), so that all kernels near a line are in its bin or the eight bins around it, also across
 * the ends of theta. The bins share a fixed number of hash chains.
 */
struct bin {
    int32_t theta, rho;
};

static int32_t count_theta_bins(const struct rho_hough *hough)
{
    return (int32_t)(RHO_PI / (2.0f * hough->config.eps_theta_rad));
}

static int32_t bin_of_rho(const struct rho_hough *hough, float rho_m)
{
    float place = rho_m / (2.0f * hough->config.eps_rho_m);
    int32_t bin = (int32_t)place;
    return (float)bin > place ? bin - 1 : bin;
}

static struct bin bin_of_line(const struct rho_hough *hough, struct rho_line line)
{
    return (struct bin){rho_angle_clamped_theta_cell(line.theta_rad, count_theta_bins(hough)),
                        bin_of_rho(hough, line.rho_m)};
}

static uint16_t *chain_of_bin(struct rho_hough *hough, struct bin bin)
{
    uint32_t key = (uint32_t)bin.theta * 0x9e3779b1u ^ (uint32_t)bin.rho * 0x85ebca77u;
    return &hough->work.sparse.step.kernels.heads[(key ^ key >> 16) % RHO_HOUGH_CHAINS];
}

/*
 * Makes the pairs of the two scans before into kernels, in hash chains by bin. They are chained
 * from last to first, so that each chain is in the order of the plots.
 */
static void hash_previous_kernels(struct rho_hough_pass *pass, unsigned scan)
{
    struct rho_hough *hough = pass->hough;
    struct rho_hough_kernel *list = hough->work.sparse.step.kernels.list[(scan - 1u) & 1u];
    uint32_t count = pass->num_kernels[(scan - 1u) & 1u];
    pass->most_kernels = count > pass->most_kernels ? count : pass->most_kernels;
    pass->num_kernels[scan & 1u] = 0;
    memset(hough->work.sparse.step.kernels.heads, 0, sizeof hough->work.sparse.step.kernels.heads);
    for (uint32_t i = count; i > 0; i--) {
        struct rho_line line = {list[i - 1u].rho_m, list[i - 1u].theta_rad};
        uint16_t *head = chain_of_bin(hough, bin_of_line(hough, line));
        list[i - 1u].next = *head;
        *head = (uint16_t)i;
    }
}

/* Finds the two kernels nearest to a line, in the bins around the line's own. */
static struct rho_hough_nearest find_nearest_kernels(const struct rho_hough_pass *pass,
                                                     unsigned scan, struct rho_line line)
{
    struct rho_hough *hough = pass->hough;
    const struct rho_hough_kernel *list = hough->work.sparse.step.kernels.list[(scan - 1u) & 1u];
    uint32_t first = rho_hough_scan_start(pass->points, scan - 2u);
    uint32_t second = rho_hough_scan_start(pass->points, scan - 1u);
    struct rho_hough_nearest nearest = {.count = 0};
    int32_t bins = count_theta_bins(hough);
    int32_t middle = rho_angle_clamped_theta_cell(line.theta_rad, bins);
    for (int32_t theta = middle - 1; theta <= middle + 1; theta++) {
        int is_turned = theta < 0 || theta >= bins;
        int32_t rho = bin_of_rho(hough, is_turned ? -line.rho_m : line.rho_m);
        for (int32_t j = rho - 1; j <= rho + 1; j++) {
            struct bin bin = {theta < 0 ? bins - 1 : theta < bins ? theta : 0, j};
            for (uint16_t i = *chain_of_bin(hough, bin); i > 0; i = list[i - 1u].next) {
                const struct rho_hough_kernel *kernel = &list[i - 1u];
                struct rho_line at = {kernel->rho_m, kernel->theta_rad};
                struct bin in = bin_of_line(hough, at);
                struct rho_hough_pair pair = {first + kernel->first, second + kernel->second};
                if (in.theta == bin.theta && in.rho == bin.rho) { /* chains hold other bins too */
                    rho_hough_rank_kernel(hough, line, at, pair, &nearest);
                }
            }
        }
    }
    return nearest;
}

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* What a pair's vote adds to the component's sum in its cell. */
static uint32_t component_of_vote(enum rho_hough_component component,
                                  const struct rho_hough_vote *vote)
{
    const struct rho_hough_memberships of = vote->of;
    const uint32_t parts[RHO_NUM_HOUGH_COMPONENTS] = {
        [RHO_HOUGH_VOTES] = vote->weight,
        [RHO_HOUGH_TRUTH] = of.truth,
        [RHO_HOUGH_INDETERMINACY] = of.indeterminacy,
        [RHO_HOUGH_FALSITY] = of.falsity,
        [RHO_HOUGH_LARGEST] = larger(of.truth, larger(of.indeterminacy, of.falsity))};
    return parts[component];
}

/* Votes for a pair by its nearest kernels, and keeps it as a kernel for the next scan's pairs. */
static void vote_with_kernels(struct rho_hough_pass *pass, unsigned scan, struct rho_line line,
                              struct rho_hough_pair pair)
{
    const struct rho_hough *hough = pass->hough;
    const struct rho_hough_points *points = pass->points;
    uint32_t *count = &pass->num_kernels[scan & 1u];
    int32_t row = rho_hough_row_of_theta(hough, line.theta_rad);
    if (scan > 1 && rho_hough_has_row(hough, pass->voting, row)) {
        struct rho_hough_nearest nearest = find_nearest_kernels(pass, scan, line);
        struct rho_hough_vote vote = rho_hough_vote_of_line(hough, points, line, &nearest);
        uint32_t votes = component_of_vote(pass->component, &vote);
        if (votes > 0) {
            rho_hough_add_votes(pass, line, votes);
        }
    }
    if (scan + 1u == points->at.num_scans || !rho_hough_has_row(hough, pass->held, row)) {
        return;
    }
    if (*count == RHO_MAX_HOUGH_KERNELS) {
        pass->found.kernels_dropped = rho_count(pass->found.kernels_dropped, 1);
        pass->is_full = 1;
        return;
    }
    pass->hough->work.sparse.step.kernels.list[scan & 1u][(*count)++] = (struct rho_hough_kernel){
        .rho_m = line.rho_m,
        .theta_rad = line.theta_rad,
        .first = (uint16_t)(pair.first - rho_hough_scan_start(points, scan - 1u)),
        .second = (uint16_t)(pair.second - rho_hough_scan_start(points, scan))};
}

/* Lets one plot of the scan before vote with each plot of this scan that the method pairs. */
static void vote_pairs_of_plot(struct rho_hough_pass *pass, unsigned scan, uint32_t first)
{
    const struct rho_hough *hough = pass->hough;
    const struct rho_accumulator_points *at = &pass->points->at;
    uint32_t end = at->scan_end[scan];
    int takes_all = hough->config.method == RHO_HOUGH_MHT;
    for (uint32_t i = rho_hough_scan_start(pass->points, scan); i < end; i++) {
        struct rho_hough_pair pair = {first, i};
        enum rho_hough_speed_check speed = rho_hough_speed_check(hough, pass->points, pair);
        pass->found.candidates = rho_count(pass->found.candidates, speed == RHO_SPEED_WITHIN);
        if (speed != RHO_SPEED_WITHIN && !(takes_all && speed == RHO_SPEED_OUTSIDE)) {
            continue;
        }
        float dx_m = at->x_m[i] - at->x_m[first], dy_m = at->y_m[i] - at->y_m[first];
        float from = pass->from_x * dx_m + pass->from_y * dy_m;
        float to = pass->to_x * dx_m + pass->to_y * dy_m;
        if (pass->can_reject && !(from * to <= 0.0f)) {
            continue; /* one sign at both borders: the line is certainly in none of the held rows */
        }
        struct rho_line line = rho_hough_line_through_pair(pass->points, pair);
        if (rho_hough_uses_kernels(hough)) {
            vote_with_kernels(pass, scan, line, pair);
        } else if (rho_hough_has_row(hough, pass->wanted,
                                     rho_hough_row_of_theta(hough, line.theta_rad))) {
            rho_hough_add_votes(pass, line, RHO_HOUGH_VOTE);
        }
    }
}

void rho_hough_vote_pairs(struct rho_hough_pass *pass)
{
    const struct rho_hough_points *points = pass->points;
    rho_hough_clear_cells(pass);
    for (unsigned scan = 1; scan < points->at.num_scans; scan++) {
        uint32_t end = points->at.scan_end[scan - 1u];
        if (rho_hough_uses_kernels(pass->hough)) {
            hash_previous_kernels(pass, scan);
        }
        for (uint32_t i = rho_hough_scan_start(points, scan - 1u); i < end; i++) {
            vote_pairs_of_plot(pass, scan, i);
            if (pass->is_full && pass->stops_when_full) {
                return;
            }
        }
    }
}
