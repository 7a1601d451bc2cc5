/* SPDX-License-Identifier: MIT */
/*
 * Reference of the papers' initiation methods in double precision, written for clarity, not speed:
 * every pair is compared with every pair, and all votes are sorted by cell. The library shares its
 * inputs only. A line, length or kernel near a limit, where float and double may differ, counts
 * both ways: a cell has the least and the most votes possible, and the value of exact arithmetic.
 */
#ifndef RHOTRACK_TESTS_HOUGH_REFERENCE_H
#define RHOTRACK_TESTS_HOUGH_REFERENCE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/hough.h"

#define REFERENCE_PI 3.14159265358979323846
#define CELL_SLACK 1e-3 /* share of a cell */
#define EPS_SLACK 1e-3  /* share of eps */
#define GATE_SLACK 1e-6 /* share of a length */
#define VOTE_SLACK 2e-4 /* distance from the threshold F */

static struct rho_hough_config config;

#define PLOTS_MAX 70000

static float x_m[PLOTS_MAX], y_m[PLOTS_MAX], t_s[PLOTS_MAX];
static uint32_t scan_end[RHO_ACCUMULATOR_SCANS_MAX + 1];
static struct rho_hough_points points = {.at = {.x_m = x_m, .y_m = y_m, .scan_end = scan_end},
                                         .t_s = t_s};
static uint64_t random_state = 1;

/* Random numbers without libm, so that plots are equal on every machine. */
static inline double uniform(double from, double to)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return from + (to - from) * (double)(random_state >> 11) / 9007199254740992.0;
}

static inline double normal(void)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += uniform(0.0, 1.0);
    }
    return sum;
}

static inline unsigned poisson_of_100(void)
{
    unsigned count = 0;
    for (double product = uniform(0.0, 1.0); product > 3.720075976020836e-44; count++) {
        product *= uniform(0.0, 1.0);
    }
    return count;
}

static inline unsigned num_plots(void)
{
    return points.at.num_scans ? scan_end[points.at.num_scans - 1] : 0;
}

static inline void start_scan(void)
{
    unsigned before = num_plots();
    assert_true(points.at.num_scans < RHO_ACCUMULATOR_SCANS_MAX);
    scan_end[points.at.num_scans++] = before;
}

static inline void add_plot(double x, double y, double t)
{
    uint32_t *end = &scan_end[points.at.num_scans - 1];
    assert_true(*end < PLOTS_MAX);
    x_m[*end] = (float)x;
    y_m[*end] = (float)y;
    t_s[(*end)++] = (float)t;
}

/*
 * Adds two kernels in two scans and a plot in the third one: the pair along y = 1000 is 12 m from
 * one kernel, 30 m from the other, and 9 m from the line between them.
 */
static inline void set_scene_of_pair_between_two_kernels(void)
{
    points.at.num_scans = 0;
    start_scan();
    add_plot(100.0, 1012.0, 0.0);
    add_plot(100.0, 970.0, 0.0);
    start_scan();
    add_plot(500.0, 1012.0, 2.0);
    add_plot(500.0, 970.0, 2.0);
    add_plot(500.0, 1000.0, 2.0);
    start_scan();
    add_plot(1100.0, 1000.0, 4.0);
}

/* Noise is drawn for x first, as the order in which arguments are evaluated is the compiler's. */
static inline void add_noisy_plot(double x, double y, double t, double noise_m)
{
    double dx = noise_m * normal();
    add_plot(x + dx, y + noise_m * normal(), t);
}

static inline void add_plot_in_rectangle(double x_from, double x_to, double y_from, double y_to,
                                         double t)
{
    double x = uniform(x_from, x_to);
    add_plot(x, uniform(y_from, y_to), t);
}

static inline unsigned scan_start(unsigned scan)
{
    return scan ? scan_end[scan - 1] : 0;
}

static inline unsigned scan_of(unsigned plot)
{
    unsigned scan = 0;
    while (plot >= scan_end[scan]) {
        scan++;
    }
    return scan;
}

/*
 * Adds the three targets of the paper's Table 1, 2 s from scan to scan, with noise; clutter has 10
 * plots a km^2 on average.
 */
static inline void add_scene_of_table_1(unsigned num_scans, double noise_m, int has_clutter)
{
    const double targets[3][4] = {{300.0, 280.0, 400.0, 49.0},
                                  {3000.0, -173.2, 300.0, -100.0},
                                  {2100.0, -173.2, 1300.0, -100.0}};
    points.at.num_scans = 0;
    for (unsigned scan = 0; scan < num_scans; scan++) {
        double t = 2.0 * scan;
        start_scan();
        for (int i = 0; i < 3; i++) {
            const double *at = targets[i];
            add_noisy_plot(at[0] + at[1] * t, at[2] + at[3] * t, t, noise_m);
        }
        for (unsigned n = has_clutter ? poisson_of_100() : 0; n > 0; n--) {
            add_plot_in_rectangle(0.0, 4000.0, -1000.0, 1500.0, t);
        }
    }
}

struct line {
    double rho, theta;
};

struct place {
    long theta, rho;
};

static inline long num_theta(void)
{
    return (long)ceil(REFERENCE_PI / (double)config.theta_cell_rad);
}

static inline long num_rho(void)
{
    return lround(2.0 * (double)config.rho_max_m / (double)config.rho_cell_m);
}

/* The same line with theta in [0, pi). */
static inline struct line wrapped_line(struct line line)
{
    while (line.theta < 0.0) {
        line = (struct line){-line.rho, line.theta + REFERENCE_PI};
    }
    while (line.theta >= REFERENCE_PI) {
        line = (struct line){-line.rho, line.theta - REFERENCE_PI};
    }
    return line;
}

static inline struct line line_through_point(double x, double y, double dx, double dy)
{
    return wrapped_line((struct line){(dx * y - dy * x) / sqrt(dx * dx + dy * dy), atan2(dx, -dy)});
}

static inline struct line line_of_plots(unsigned a, unsigned b)
{
    double x = (double)x_m[a], y = (double)y_m[a];
    return line_through_point(x, y, (double)x_m[b] - x, (double)y_m[b] - y);
}

static inline struct place place_of(struct line line)
{
    return (struct place){
        (long)floor(line.theta / (double)config.theta_cell_rad),
        (long)floor((line.rho + (double)config.rho_max_m) / (double)config.rho_cell_m)};
}

static inline int is_in_plane(struct place place)
{
    return place.theta >= 0 && place.theta < num_theta() && place.rho >= 0 && place.rho < num_rho();
}

/* Beyond the ends of theta a cell continues with the opposite rho. */
static inline struct place wrapped_place(struct place place)
{
    if (place.theta < 0 || place.theta >= num_theta()) {
        place.theta += place.theta < 0 ? num_theta() : -num_theta();
        place.rho = num_rho() - 1 - place.rho;
    }
    return place;
}

static inline uint32_t sort_key_of_place(struct place place)
{
    return (uint32_t)(place.theta * num_rho() + place.rho);
}

/* Distance of two lines in rho and theta, by the nearer of (rho, theta) and (-rho, theta +- pi). */
static inline struct line line_offset(struct line from, struct line to)
{
    double dtheta = to.theta - from.theta, rho = to.rho;
    if (fabs(dtheta) > REFERENCE_PI / 2.0) {
        dtheta += dtheta > 0.0 ? -REFERENCE_PI : REFERENCE_PI;
        rho = -rho;
    }
    return (struct line){rho - from.rho, dtheta};
}

static inline double gaussian_of_offset(struct line offset)
{
    double rho = offset.rho / (double)config.eps_rho_m;
    double theta = offset.theta / (double)config.eps_theta_rad;
    return exp(-(rho * rho + theta * theta) / 2.0);
}

enum verdict { NO, MAYBE, YES };

static inline enum verdict verdict_below_limit(double value, double limit, double slack)
{
    return value <= limit - slack ? YES : value <= limit + slack ? MAYBE : NO;
}

static inline enum verdict lesser_verdict(enum verdict a, enum verdict b)
{
    return a < b ? a : b;
}

static inline enum verdict is_within_neighbourhood(struct line offset)
{
    double rho = fabs(offset.rho) / (double)config.eps_rho_m;
    double theta = fabs(offset.theta) / (double)config.eps_theta_rad;
    return lesser_verdict(verdict_below_limit(rho, 2.0, EPS_SLACK),
                          verdict_below_limit(theta, 2.0, EPS_SLACK));
}

struct pair {
    unsigned a, b;
    struct line line;
    enum verdict gated;
};

struct pairs {
    struct pair *list;
    size_t num;
};

static inline double pair_length_m(unsigned a, unsigned b)
{
    return hypot((double)x_m[b] - (double)x_m[a], (double)y_m[b] - (double)y_m[a]);
}

static inline enum verdict is_pair_within_speed_limits(unsigned a, unsigned b)
{
    double dt = (double)t_s[b] - (double)t_s[a], d = pair_length_m(a, b);
    if (dt <= 0.0) {
        return NO;
    }
    return lesser_verdict(verdict_below_limit((double)config.v_min_mps * dt, d, GATE_SLACK * d),
                          verdict_below_limit(d, (double)config.v_max_mps * dt, GATE_SLACK * d));
}

/* Pairs of scans `scan` - 1 and `scan` that may vote; two plots in one place make no line. */
static inline struct pairs voting_pairs_of_scan(unsigned scan)
{
    struct pairs pairs = {NULL, 0};
    if (scan == 0) {
        return pairs;
    }
    size_t from = scan_start(scan - 1), middle = scan_end[scan - 1], end = scan_end[scan];
    pairs.list = malloc(((middle - from) * (end - middle) + 1) * sizeof *pairs.list);
    for (unsigned a = (unsigned)from; a < middle; a++) {
        for (unsigned b = (unsigned)middle; b < end; b++) {
            enum verdict gated = is_pair_within_speed_limits(a, b);
            if (pair_length_m(a, b) > 0.0 && (gated != NO || config.method == RHO_HOUGH_MHT)) {
                pairs.list[pairs.num++] = (struct pair){a, b, line_of_plots(a, b), gated};
            }
        }
    }
    return pairs;
}

/* A vote in exact arithmetic, and the least and most that float may make of it. */
struct vote_bounds {
    double value, least, most;
};

struct near {
    const struct pair *kernel;
    double mu;
};

struct nearest {
    struct near best[3];
    double surely; /* mu of the best kernel that is not near a limit */
    int is_vague;
};

static inline void insert_nearest(struct nearest *nearest, struct near near)
{
    for (int i = 0; i < 3; i++) {
        if (!nearest->best[i].kernel || near.mu > nearest->best[i].mu) {
            struct near pushed = nearest->best[i];
            nearest->best[i] = near;
            near = pushed;
        }
        if (!near.kernel) {
            return;
        }
    }
}

static inline struct nearest nearest_kernels(const struct pair *pair, const struct pairs *kernels)
{
    struct nearest nearest = {.surely = 0.0};
    for (size_t i = 0; i < kernels->num; i++) {
        const struct pair *kernel = &kernels->list[i];
        if (fabs(fabs(pair->line.rho) - fabs(kernel->line.rho)) > 3.0 * (double)config.eps_rho_m) {
            continue; /* too far for either sign of rho */
        }
        struct line away = line_offset(pair->line, kernel->line);
        enum verdict counts = lesser_verdict(kernel->gated, is_within_neighbourhood(away));
        if (counts != NO) {
            insert_nearest(&nearest, (struct near){kernel, gaussian_of_offset(away)});
            nearest.is_vague |= counts == MAYBE;
        }
        if (counts == YES) {
            nearest.surely = fmax(nearest.surely, gaussian_of_offset(away));
        }
    }
    return nearest;
}

static inline struct vote_bounds indeterminacy_bounds(const struct pair *pair,
                                                      const struct nearest *nearest)
{
    const struct pair *p = nearest->best[0].kernel, *q = nearest->best[1].kernel;
    if (!q) {
        return (struct vote_bounds){0.0, 0.0, nearest->is_vague ? 1.0 : 0.0};
    }
    double x = ((double)x_m[p->a] + (double)x_m[q->a]) / 2.0;
    double y = ((double)y_m[p->a] + (double)y_m[q->a]) / 2.0;
    double dx = ((double)x_m[p->b] + (double)x_m[q->b]) / 2.0 - x;
    double dy = ((double)y_m[p->b] + (double)y_m[q->b]) / 2.0 - y;
    int is_tied = nearest->best[2].kernel && nearest->best[1].mu - nearest->best[2].mu < 1e-3;
    if (nearest->is_vague || is_tied || hypot(dx, dy) < 200.0) {
        return (struct vote_bounds){0.0, 0.0, 1.0};
    }
    struct line away = line_offset(pair->line, line_through_point(x, y, dx, dy));
    double mu = gaussian_of_offset(away);
    enum verdict counts = is_within_neighbourhood(away);
    return (struct vote_bounds){counts == NO ? 0.0 : mu, counts == YES ? mu : 0.0,
                                counts == NO ? 0.0 : mu};
}

static inline struct vote_bounds neutrosophic_vote_bounds(const struct pair *pair,
                                                          const struct pairs *kernels)
{
    double f = (double)config.lambda_k * (double)config.p_false * (double)config.p_false;
    struct nearest nearest = nearest_kernels(pair, kernels);
    double t = nearest.best[0].mu;
    struct vote_bounds bounds = {t, nearest.surely, t};
    if (nearest.best[0].kernel && config.uses_indeterminacy) {
        struct vote_bounds i = indeterminacy_bounds(pair, &nearest);
        bounds =
            (struct vote_bounds){fmax(t, i.value), fmax(bounds.least, i.least), fmax(t, i.most)};
    }
    bounds.value = bounds.value < f ? 0.0 : bounds.value;
    bounds.least = bounds.least < f + VOTE_SLACK ? 0.0 : bounds.least;
    bounds.most = bounds.most < f - VOTE_SLACK ? 0.0 : bounds.most;
    return bounds;
}

static inline struct vote_bounds vote_bounds_of_pair(const struct pair *pair,
                                                     const struct pairs *kernels)
{
    struct vote_bounds bounds = {1.0, 1.0, 1.0};
    if (config.method == RHO_HOUGH_MHT) {
        return bounds;
    }
    if (config.method != RHO_HOUGH_IHT) {
        bounds = neutrosophic_vote_bounds(pair, kernels);
    }
    if (pair->gated != YES) {
        bounds.least = 0.0;
    }
    return bounds;
}

#endif
