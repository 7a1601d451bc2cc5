/* SPDX-License-Identifier: MIT */
#include "io/turns/turn_search.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/common.h"

#define PLOTS_MIN 20 /* fewest plots from which a rule is found */
#define TURN_MIN_S 0.5
#define TURN_MAX_S 50.0     /* longest turn; with its jitter it stays below RHO_LIMIT_OFFSET_US */
#define SPAN_S 120.0        /* longest time of the plots fitted: an antenna's rate drifts */
#define SPAN_SPARSE_S 300.0 /* longest time of the plots fitted where SPAN_S has too few */
#define SPARSE 60           /* fewest plots in SPAN_S for which SPAN_S is long enough */
#define FITTED_MAX 300      /* largest number of plots that a rate is fitted to */
#define STEPS_A_LOBE 6      /* rotation rates tried for each turn more or less within the span */
#define CONCENTRATION 0.8   /* least concentration of azimuths about a turning antenna; 1: exact */
#define BETTER 0.05         /* a faster rate must raise the concentration by more than this */
#define PLOTS_A_TURN 1.5    /* fewest plots a turn: with fewer, each plot is a scan */
/* share of steps reachable for one target above which there are no turns */
#define TARGET_SHARE 0.5
#define BINS 72 /* bins of azimuth */
/* least ratio of the shortest gap between bursts to the longest within one */
#define GAP_RATIO 3.0
#define LOOKS_MIN 5    /* fewest bursts */
#define EVEN_SHARE 0.8 /* least share of bursts that come at regular intervals */
/* share of rows without a measurement, to plots, above which times are those of looks */
#define EMPTY_SHARE 0.05
#define EVEN 0.15 /* tolerance of a regular interval, relative to the median interval */
/* antennas take longer for a turn: rows this close are parts of a scan */
#define SOON_S 1.0
/* ratio of the longest step in time to the median above which rows form scans */
#define IRREGULAR 3.0

#define TURN_RAD (2 * M_PI)

static double seconds_between(const struct turn_plot *plots, size_t from, size_t to)
{
    return (double)(plots[to].time_us - plots[from].time_us) * 1e-6;
}

static double plot_azimuth(const struct turn_plot *plot)
{
    return atan2(plot->y_m, plot->x_m);
}

/* Times and azimuths of the plots to which a rotation rate is fitted. */
struct fitted {
    size_t count;
    double after_s[FITTED_MAX], azimuth_rad[FITTED_MAX];
};

/* Length of the mean of the unit vectors at the azimuths, each turned back by rate times time. */
static double azimuth_concentration(const struct fitted *fitted, double rate_rad_s)
{
    double x = 0, y = 0;

    for (size_t i = 0; i < fitted->count; i++) {
        const double angle = fitted->azimuth_rad[i] - rate_rad_s * fitted->after_s[i];

        x += cos(angle);
        y += sin(angle);
    }
    return hypot(x, y) / (double)fitted->count;
}

/* Samples evenly spaced plots of the first SPAN_S seconds; returns how many plots the span has. */
static size_t sample_first_span(const struct turn_plot *plots, size_t count, struct fitted *fitted)
{
    size_t num = 0, stride;

    while (num < count && (seconds_between(plots, 0, num) <= SPAN_S ||
                           (num < SPARSE && seconds_between(plots, 0, num) <= SPAN_SPARSE_S))) {
        num++;
    }
    stride = (num + FITTED_MAX - 1) / FITTED_MAX;
    fitted->count = 0;
    for (size_t i = 0; i < num; i += stride) {
        fitted->after_s[fitted->count] = seconds_between(plots, 0, i);
        fitted->azimuth_rad[fitted->count++] = plot_azimuth(&plots[i]);
    }
    return num;
}

/* The rate of highest concentration within one step to either side, in tenths of a step. */
static double refine_turn_rate(const struct fitted *fitted, double rate_rad_s, double step)
{
    double best = rate_rad_s, highest = azimuth_concentration(fitted, rate_rad_s);

    for (int i = -10; i <= 10; i++) {
        const double rate = rate_rad_s + 0.1 * i * step;
        const double found = azimuth_concentration(fitted, rate);

        if (found > highest) {
            highest = found;
            best = rate;
        }
    }
    return best;
}

/* Slowest rotation rate at which the azimuths agree with a turning antenna; 0: none. */
static double find_slowest_fitting_turn_rate(const struct fitted *fitted)
{
    const double span_s = fitted->after_s[fitted->count - 1];
    const double step = TURN_RAD / (STEPS_A_LOBE * span_s);
    /* one step more on both sides of the fastest rate */
    const size_t num = (size_t)(TURN_RAD / TURN_MIN_S / step) + 2;
    double *found = must_calloc(2 * num + 1, sizeof *found), highest = 0, rate = 0;

    for (size_t i = 0; i <= 2 * num; i++) {
        found[i] = azimuth_concentration(fitted, ((double)i - (double)num) * step);
        highest = fmax(highest, found[i]);
    }
    for (size_t k = 0; k < num && rate >= 0 && rate <= 0; k++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            const size_t i = sign < 0 ? num - k : num + k;

            if (found[i] >= fmax(highest - BETTER, CONCENTRATION) && found[i] >= found[i - 1] &&
                found[i] >= found[i + 1]) {
                rate = ((double)i - (double)num) * step;
                break;
            }
        }
        if (k <= STEPS_A_LOBE / 2 && (found[num + k] >= highest - BETTER)) {
            break; /* the azimuths concentrate without turning: the radar looks in one direction */
        }
    }
    free(found);
    return rate > 0 || rate < 0 ? refine_turn_rate(fitted, rate, step) : 0;
}

static size_t end_of_plots_at_time(const struct turn_plot *plots, size_t count, size_t first)
{
    size_t end = first + 1;

    while (end < count && plots[end].time_us == plots[first].time_us) {
        end++;
    }
    return end;
}

/* Whether any plot of one time is within way_m of any plot of the next time. */
static bool is_any_step_within(const struct turn_plot *plots, size_t first, size_t next, size_t end,
                               double way_m)
{
    for (size_t i = first; i < next; i++) {
        for (size_t j = next; j < end; j++) {
            if (hypot(plots[j].x_m - plots[i].x_m, plots[j].y_m - plots[i].y_m) <= way_m) {
                return true;
            }
        }
    }
    return false;
}

/* Whether one target alone may have caused the plots: most steps in time are within its speed. */
static bool may_be_one_target(const struct turn_plot *plots, size_t count, double v_max_mps)
{
    size_t slow = 0, steps = 0, first = 0, next = end_of_plots_at_time(plots, count, 0);

    while (next < count) {
        const size_t end = end_of_plots_at_time(plots, count, next);

        slow += is_any_step_within(plots, first, next, end,
                                   v_max_mps * seconds_between(plots, first, next));
        steps++;
        first = next;
        next = end;
    }
    return (double)slow > TARGET_SHARE * (double)steps;
}

/* Middle of the longest run of azimuth bins that have the fewest plots. */
static double find_emptiest_azimuth(const struct turn_plot *plots, size_t count)
{
    size_t hits[BINS] = {0}, least = count, best = 0, longest = 0, run = 0;

    for (size_t i = 0; i < count; i++) {
        const double share = plot_azimuth(&plots[i]) / TURN_RAD;

        hits[(size_t)((share - floor(share)) * BINS) % BINS]++;
    }
    for (size_t i = 0; i < BINS; i++) {
        least = hits[i] < least ? hits[i] : least;
    }
    for (size_t i = 0; i < 2 * BINS; i++) {
        run = hits[i % BINS] == least ? run + 1 : 0;
        if (run > longest && run <= BINS) {
            longest = run;
            best = i;
        }
    }
    return remainder(((double)best + 1 - 0.5 * (double)longest) * TURN_RAD / BINS, TURN_RAD);
}

static bool find_rule_by_azimuths(const struct turn_plot *plots, size_t count, double v_max_mps,
                                  struct turn_rule *rule)
{
    struct fitted fitted;
    const size_t num = sample_first_span(plots, count, &fitted);
    double span_s, turn_s;

    if (num < PLOTS_MIN) {
        return false;
    }
    span_s = fitted.after_s[fitted.count - 1];
    if (span_s < 2 * TURN_MIN_S) {
        return false;
    }
    rule->rate_rad_s = find_slowest_fitting_turn_rate(&fitted);
    if (fabs(rule->rate_rad_s) < TURN_RAD / TURN_MAX_S) {
        return false;
    }
    turn_s = TURN_RAD / fabs(rule->rate_rad_s);
    if (span_s < 2 * turn_s || (double)num * turn_s < PLOTS_A_TURN * span_s ||
        may_be_one_target(plots, num, v_max_mps)) {
        return false;
    }
    rule->kind = TURN_AZIMUTHS;
    rule->turn_s = turn_s;
    rule->cut_rad = find_emptiest_azimuth(plots, count);
    return true;
}

static int compare_int64(const void *a, const void *b)
{
    const int64_t one = *(const int64_t *)a, other = *(const int64_t *)b;

    return (one > other) - (one < other);
}

/* The times between successive rows, sorted, the shortest first. */
static int64_t *list_sorted_time_steps(const struct turn_plot *plots, size_t count)
{
    int64_t *steps = must_calloc(count, sizeof *steps);

    for (size_t i = 1; i < count; i++) {
        steps[i - 1] = plots[i].time_us - plots[i - 1].time_us;
    }
    qsort(steps, count - 1, sizeof *steps, compare_int64);
    return steps;
}

/*
 * Whether the bursts that gaps longer than gap_us separate begin at regular intervals; sets *turn_s
 * to their median interval.
 */
static bool find_regular_burst_interval(const struct turn_plot *plots, size_t count, int64_t gap_us,
                                        double *turn_s)
{
    int64_t *starts = must_calloc(count, sizeof *starts);
    size_t num = 0, even = 0, last = 0;

    for (size_t i = 1; i < count; i++) {
        if (plots[i].time_us - plots[i - 1].time_us > gap_us) {
            starts[num++] = plots[i].time_us - plots[last].time_us;
            last = i;
        }
    }
    *turn_s = 0;
    if (num >= LOOKS_MIN) {
        qsort(starts, num, sizeof *starts, compare_int64);
        const size_t middle = num / 2;

        *turn_s = (double)starts[middle] * 1e-6;
    }
    for (size_t i = 0; i < num; i++) {
        even += fabs((double)starts[i] * 1e-6 - *turn_s) <= EVEN * *turn_s;
    }
    free(starts);
    return num >= LOOKS_MIN && (double)even >= EVEN_SHARE * (double)num;
}

static bool find_rule_by_time_gaps(const struct turn_plot *plots, size_t count,
                                   const int64_t *steps, struct turn_rule *rule)
{
    double widest = GAP_RATIO, turn_s;

    /* two plots a burst or more: steps within bursts are at least half of all */
    for (size_t i = count / 2; i + LOOKS_MIN < count; i++) {
        const double within = fmax((double)steps[i - 1], 1.0), between = (double)steps[i];

        if (between >= widest * within) {
            widest = between / within;
            rule->gap_us = (int64_t)sqrt(within * between);
        }
    }
    if (rule->gap_us == 0 || !find_regular_burst_interval(plots, count, rule->gap_us, &turn_s) ||
        turn_s > TURN_MAX_S) {
        return false;
    }
    rule->kind = TURN_GAPS;
    rule->turn_s = turn_s;
    return true;
}

/* Number of plots that share their time with others, and how much such plots share a direction. */
struct simultaneous {
    size_t count;
    /* weighted mean, over these times, of the length of the mean unit vector */
    double concentration;
};

static struct simultaneous measure_simultaneous_plots(const struct turn_plot *plots, size_t count)
{
    struct simultaneous simultaneous = {.count = 0};

    for (size_t first = 0, end; first < count; first = end) {
        double x = 0, y = 0;

        end = end_of_plots_at_time(plots, count, first);
        for (size_t i = first; end - first > 1 && i < end; i++) {
            x += cos(plot_azimuth(&plots[i]));
            y += sin(plot_azimuth(&plots[i]));
        }
        simultaneous.count += end - first > 1 ? end - first : 0;
        simultaneous.concentration += hypot(x, y);
    }
    simultaneous.concentration /= (double)(simultaneous.count > 0 ? simultaneous.count : 1);
    return simultaneous;
}

struct turn_rule turn_search_find_rule(const struct turn_plot *plots, size_t count,
                                       size_t num_empty, double v_max_mps)
{
    const struct simultaneous simultaneous = measure_simultaneous_plots(plots, count);
    const bool are_scans = simultaneous.count > count / 2;
    struct turn_rule rule = {.kind = TURN_NONE};
    int64_t *steps;

    if (count < PLOTS_MIN || (are_scans && simultaneous.concentration < CONCENTRATION) ||
        find_rule_by_azimuths(plots, count, v_max_mps, &rule) || are_scans ||
        (double)num_empty > EMPTY_SHARE * (double)count) {
        return rule;
    }
    steps = list_sorted_time_steps(plots, count);
    if (!find_rule_by_time_gaps(plots, count, steps, &rule)) {
        const size_t middle = count / 2;

        rule.turn_s = (double)steps[middle] * 1e-6;
        if (rule.turn_s < SOON_S && (double)steps[count - 2] * 1e-6 > IRREGULAR * rule.turn_s) {
            rule.kind = TURN_UNKNOWN;
        }
    }
    free(steps);
    return rule;
}
