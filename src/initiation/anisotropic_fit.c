/* SPDX-License-Identifier: MIT */
/*
 * anisotropic_fit: as isotropic_fit, for straight or turning tracks through plots that have
 * covariances, heights and range rates of their own.
 */
#include <float.h>
#include <string.h>

#include "candidates.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"
#include "target_model.h"

enum {
    /* most equations of a plot: position along, across and above the line of sight; range rate */
    ROWS_MAX = 3 + 1,
    /* most unknowns of a fit: position and velocity in x, y, z; acceleration in x, y */
    UNKNOWNS_MAX = 3 + 3 + 2,
};

/*
 * Regression of a track through a set of plots. Position and velocity are the unknowns, and the
 * acceleration of turning targets. Each plot gives an equation for every axis of its noise, and one
 * for its range rate, linearised at the fit of the positions alone. Times count from the middle of
 * the set in units of `unit_s`, positions from the middle plot, to keep the unknowns alike in size.
 */
struct regression {
    const struct search *search;
    const struct plot_set *set;
    int axes; /* dimensions of position: 2, or 3 where two plots or more have heights */
    int unknowns;
    float middle_s, unit_s;
    float origin_m[3];
    int has_point; /* `unknown` holds a solution, at which range rates can be linearised */
    /*
     * solution: position in `axes` components; velocity times unit_s in as many; and for turning
     * sets the acceleration times unit_s^2 in x and y
     */
    float unknown[UNKNOWNS_MAX];
    float factor[RHO_TRIANGLE(UNKNOWNS_MAX)]; /* Cholesky factor of the normal equations */
};

/* One scalar equation of the regression: row . unknown = value + noise. */
struct equation {
    float row[UNKNOWNS_MAX];
    float value, variance;
};

static float scaled_plot_time(const struct regression *of, unsigned m)
{
    float t_s = rho_search_plot_time_s(of->search, of->set, m);
    return (t_s - of->middle_s) / of->unit_s;
}

static int make_position_equations(const struct regression *of, unsigned m,
                                   struct equation *equations)
{
    const struct rho_window_scan *scan = rho_search_scan(of->search, m);
    struct rho_plot plot = rho_window_unpack_plot(scan, of->set->plot[m]);
    struct rho_measurement seen;
    rho_measurement_from_plot(&plot, of->axes == 3 ? scan->measures : 0u, &scan->sensor, &seen);
    float ca = seen.cos_azimuth, sa = seen.sin_azimuth;
    float ce = seen.cos_elevation, se = seen.sin_elevation;
    const float axes[3][3] = {{ce * ca, ce * sa, se}, {-sa, ca, 0.0f}, {-se * ca, -se * sa, ce}};
    const float time = scaled_plot_time(of, m);
    int count = seen.has_z ? 3 : 2;
    for (int k = 0; k < count; k++) {
        struct equation *equation = &equations[k];
        *equation = (struct equation){.variance = seen.variance_m2[k] + of->search->fit_process_m2};
        for (int i = 0; i < of->axes; i++) {
            equation->row[i] = axes[k][i];
            equation->row[of->axes + i] = time * axes[k][i];
            equation->value += axes[k][i] * (seen.place_m[i] - of->origin_m[i]);
        }
        for (int i = 2 * of->axes; i < of->unknowns; i++) {
            equation->row[i] = 0.5f * time * time * axes[k][i - 2 * of->axes];
        }
    }
    return count;
}

static int make_range_rate_equation(const struct regression *of, unsigned m,
                                    struct equation *equation)
{
    const struct rho_window_scan *scan = rho_search_scan(of->search, m);
    const struct rho_window_plot *plot = &scan->plots[of->set->plot[m]];
    float state[6] = {0.0f}, derivative[6], rate_mps, time = scaled_plot_time(of, m);
    if (!of->has_point || !(scan->measures & RHO_MEASURES_RANGE_RATE)) {
        return 0;
    }
    for (int i = 0; i < of->axes; i++) {
        const float *v = &of->unknown[of->axes];
        float a = i < of->unknowns - 2 * of->axes ? v[of->axes + i] : 0.0f;
        state[i] = of->origin_m[i] + of->unknown[i] + time * (v[i] + 0.5f * time * a);
        state[i + 3] = (v[i] + time * a) / of->unit_s;
    }
    if (!rho_measurement_predict_rate(state, &scan->sensor, of->axes == 3, derivative, &rate_mps)) {
        return 0;
    }
    equation->value = rho_measurement_innovation_mps(&scan->sensor, plot->range_rate_mps, rate_mps);
    for (int i = 0; i < of->axes; i++) {
        equation->row[i] = derivative[i];
        equation->row[of->axes + i] = time * derivative[i] + derivative[i + 3] / of->unit_s;
    }
    for (int i = 2 * of->axes; i < of->unknowns; i++) {
        int axis = i - 2 * of->axes;
        equation->row[i] =
            time * (0.5f * time * derivative[axis] + derivative[axis + 3] / of->unit_s);
    }
    for (int i = 0; i < of->unknowns; i++) {
        equation->value += equation->row[i] * of->unknown[i];
    }
    float sigma_mps = rho_window_decode_sigma(plot->sigma_range_rate);
    equation->variance = sigma_mps * sigma_mps;
    return 1;
}

static int make_plot_equations(const struct regression *of, unsigned m, struct equation *equations)
{
    int count = make_position_equations(of, m, equations);
    return count + make_range_rate_equation(of, m, &equations[count]);
}

/* Prior variance of an acceleration component, in the units of the regression's unknowns. */
static float acceleration_prior_variance(const struct regression *of)
{
    float turn_m = of->search->turn_mps2 * of->unit_s * of->unit_s;
    return turn_m * turn_m;
}

/* Solves the normal equations of the set. Returns 0 where they do not determine the unknowns. */
static int solve_unknowns(struct regression *of)
{
    rho_search_charge(of->search, SOLVE_UNITS * rho_count_bits(of->set->mask));
    float *normal = of->factor, right[UNKNOWNS_MAX] = {0.0f}; /* `normal` is factorised in place */
    const int unknowns = of->unknowns;
    for (int i = 0; i < RHO_TRIANGLE(UNKNOWNS_MAX); i++) {
        normal[i] = 0.0f;
    }
    for (int i = 2 * of->axes; i < unknowns; i++) {
        normal[RHO_AT(i, i)] = 1.0f / acceleration_prior_variance(of);
    }
    for (unsigned m = 0; m < of->search->num_scans; m++) {
        struct equation equations[ROWS_MAX];
        if (!(of->set->mask >> m & 1u)) {
            continue;
        }
        int count = make_plot_equations(of, m, equations);
        for (int i = 0; i < count; i++) {
            float weight = 1.0f / equations[i].variance;
            for (int k = 0; k < unknowns; k++) {
                float weighted = weight * equations[i].row[k];
                right[k] += weighted * equations[i].value;
                for (int j = 0; j <= k; j++) {
                    normal[RHO_AT(k, j)] += weighted * equations[i].row[j];
                }
            }
        }
    }
    if (rho_linalg_cholesky(unknowns, normal, normal) != RHO_OK) {
        return 0;
    }
    rho_linalg_forward(unknowns, of->factor, right);
    rho_linalg_backward(unknowns, of->factor, right);
    for (int i = 0; i < unknowns; i++) {
        of->unknown[i] = right[i];
    }
    return 1;
}

/*
 * Sets the number of unknowns, the origin and the units of a regression. Returns the number of
 * solutions to make: 2 with range rates, 1 without, 0 where all plots have one time.
 */
static int set_up_regression(struct regression *of)
{
    const struct search *search = of->search;
    float first_s = 0.0f, last_s = 0.0f;
    unsigned seen = 0, heights = 0, range_rates = 0;
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (!(of->set->mask >> m & 1u)) {
            continue;
        }
        float t_s = rho_search_plot_time_s(search, of->set, m);
        first_s = seen == 0 || t_s < first_s ? t_s : first_s;
        last_s = seen == 0 || t_s > last_s ? t_s : last_s;
        heights += (rho_search_scan(search, m)->measures & RHO_MEASURES_Z) != 0;
        range_rates += (rho_search_scan(search, m)->measures & RHO_MEASURES_RANGE_RATE) != 0;
        if (seen++ <= of->set->hits / 2u) {
            const struct rho_window_plot *plot = rho_search_plot(search, of->set, m);
            of->origin_m[0] = plot->x_m;
            of->origin_m[1] = plot->y_m;
            of->origin_m[2] = plot->z_m;
        }
    }
    of->axes = heights >= 2u ? 3 : 2;
    of->unknowns = 2 * of->axes + (search->turn_mps2 > 0.0f ? 2 : 0);
    of->middle_s = 0.5f * (first_s + last_s);
    of->unit_s = 0.5f * (last_s - first_s);
    return of->unit_s > 0.0f ? range_rates > 0 ? 2 : 1 : 0;
}

static float normalised_residual2(const struct regression *of, const struct equation *equation)
{
    float residual = equation->value;
    for (int i = 0; i < of->unknowns; i++) {
        residual -= equation->row[i] * of->unknown[i];
    }
    return residual * residual / equation->variance;
}

/* Chi-square of the fitted acceleration against its prior. */
static float acceleration_chi2(const struct regression *of)
{
    float sum = 0.0f;
    for (int i = 2 * of->axes; i < of->unknowns; i++) {
        sum += of->unknown[i] * of->unknown[i] / acceleration_prior_variance(of);
    }
    return sum;
}

/* Span between the aliases of a sensor's range rates; the widest of all where it has none. */
static float alias_span_mps(const struct rho_sensor *sensor)
{
    return rho_measurement_is_ambiguous(sensor) ? sensor->range_rate_span_mps
                                                : RHO_LIMIT_SPAN_MAX_MPS;
}

/*
 * The scan of the set whose range rate has the widest ambiguity span, so the fewest aliases;
 * RHO_MAX_SCANS where no range rate is ambiguous.
 */
static unsigned scan_with_widest_span(const struct regression *of)
{
    unsigned widest = RHO_MAX_SCANS;
    float most_mps = 0.0f;
    int is_ambiguous = 0;
    for (unsigned m = 0; m < of->search->num_scans; m++) {
        const struct rho_window_scan *scan = rho_search_scan(of->search, m);
        if (!(of->set->mask >> m & 1u) || !(scan->measures & RHO_MEASURES_RANGE_RATE)) {
            continue;
        }
        is_ambiguous = is_ambiguous || rho_measurement_is_ambiguous(&scan->sensor);
        if (alias_span_mps(&scan->sensor) > most_mps) {
            most_mps = alias_span_mps(&scan->sensor);
            widest = m;
        }
    }
    return is_ambiguous ? widest : RHO_MAX_SCANS;
}

/* A range rate against the fit of the positions, with the Kalman gain of the fit by it. */
struct first_rate {
    float error_mps, span_mps, variance;
    float gain[UNKNOWNS_MAX];
};

/* Sets the innovation of scan m's range rate and its gain. Returns 0 without a range rate. */
static int compare_first_rate(const struct regression *of, unsigned m, struct first_rate *first)
{
    struct equation equation = {.variance = 0.0f};
    const int unknowns = of->unknowns;
    if (!make_range_rate_equation(of, m, &equation)) {
        return 0;
    }
    first->span_mps = alias_span_mps(&rho_search_scan(of->search, m)->sensor);
    first->error_mps = equation.value;
    first->variance = equation.variance;
    for (int i = 0; i < unknowns; i++) {
        first->error_mps -= equation.row[i] * of->unknown[i];
        first->gain[i] = equation.row[i];
    }
    rho_linalg_forward(unknowns, of->factor, first->gain);
    for (int i = 0; i < unknowns; i++) {
        first->variance += first->gain[i] * first->gain[i];
    }
    rho_linalg_backward(unknowns, of->factor, first->gain);
    return 1;
}

/* Moves the positions' fit by an innovation, and solves with all range rates linearised there. */
static int solve_with_alias(struct regression *of, const float *position_fit,
                            const struct first_rate *first, float alias_innovation_mps)
{
    for (int k = 0; k < of->unknowns; k++) {
        of->unknown[k] =
            position_fit[k] + first->gain[k] * (alias_innovation_mps / first->variance);
    }
    return solve_unknowns(of);
}

/*
 * The positions alone leave several aliases of the range rates. An alias of one range rate
 * determines those of the others. As all are equally likely, the fit with least chi-square is kept.
 */
static int solve_with_best_alias(struct regression *of, unsigned widest_scan)
{
    float places[UNKNOWNS_MAX];
    struct first_rate first;
    float least = FLT_MAX, best_mps = 0.0f;
    const float v_max_mps = of->search->initiator->config.v_max_mps * of->unit_s;
    const float *v = &of->unknown[of->axes];
    of->has_point = 1;
    if (!compare_first_rate(of, widest_scan, &first)) {
        return solve_unknowns(of);
    }
    float reach_mps = rho_sqrt(RHO_GATE_CHI2_1D * first.variance);
    if (reach_mps > (float)ALIASES_MAX * first.span_mps) {
        of->has_point = 0;
        return 1;
    }
    memcpy(places, of->unknown, sizeof places);
    for (int i = -ALIASES_MAX; i <= ALIASES_MAX; i++) {
        float error_mps = first.error_mps + (float)i * first.span_mps;
        if (i != 0 && !(error_mps <= reach_mps && error_mps >= -reach_mps)) {
            continue;
        }
        if (!solve_with_alias(of, places, &first, error_mps) ||
            !(v[0] * v[0] + v[1] * v[1] <= v_max_mps * v_max_mps)) {
            continue;
        }
        float chi2 = acceleration_chi2(of);
        for (unsigned m = 0; m < of->search->num_scans; m++) {
            struct equation equations[ROWS_MAX];
            int count = of->set->mask >> m & 1u ? make_plot_equations(of, m, equations) : 0;
            for (int k = 0; k < count; k++) {
                chi2 += normalised_residual2(of, &equations[k]);
            }
        }
        if (chi2 < least) {
            least = chi2;
            best_mps = error_mps;
        }
    }
    /* the best fit is solved again: keeping the fit of each alias would take half of the stack */
    return least < FLT_MAX && solve_with_alias(of, places, &first, best_mps);
}

/* Fits positions, then range rates, too. Returns 0 where the plots determine no track. */
static int run_regression(struct regression *of)
{
    int rounds = set_up_regression(of);
    const unsigned widest =
        RHO_AMBIGUOUS_RANGE_RATES && rounds > 1 ? scan_with_widest_span(of) : RHO_MAX_SCANS;
    if (widest < RHO_MAX_SCANS) {
        return solve_unknowns(of) && solve_with_best_alias(of, widest);
    }
    for (int i = 0; i < rounds; i++) {
        if (!solve_unknowns(of)) {
            return 0;
        }
        of->has_point = 1;
    }
    return rounds > 0;
}

int rho_anisotropic_fit(const struct search *search, const struct plot_set *set,
                        struct line_fit *fit)
{
    struct regression of = {.search = search, .set = set};
    float place_m[3] = {0.0f}, velocity_mps[3] = {0.0f}, accel_mps2[2] = {0.0f};
    if (!run_regression(&of)) {
        return 0;
    }
    for (int i = 2 * of.axes; i < of.unknowns; i++) {
        accel_mps2[i - 2 * of.axes] = of.unknown[i] / (of.unit_s * of.unit_s);
    }
    for (int i = 0; i < of.axes; i++) {
        float a = i < 2 ? accel_mps2[i] : 0.0f, back_s = -of.middle_s;
        velocity_mps[i] = of.unknown[of.axes + i] / of.unit_s;
        place_m[i] =
            of.origin_m[i] + of.unknown[i] + (velocity_mps[i] + 0.5f * a * back_s) * back_s;
        velocity_mps[i] += a * back_s;
    }
    *fit = (struct line_fit){
        .x_m = place_m[0],
        .y_m = place_m[1],
        .vx_mps = velocity_mps[0],
        .vy_mps = velocity_mps[1],
        .ax_mps2 = accel_mps2[0],
        .ay_mps2 = accel_mps2[1],
        .has_z = of.axes == 3,
        .z_m = place_m[2],
        .vz_mps = velocity_mps[2],
    };
    return 1;
}

/* Heights and range rates count relative to their density as clutter. */
int rho_anisotropic_likelihood(const struct search *search, const struct plot_set *set,
                               struct set_score *score, float *nat)
{
    struct regression of = {.search = search, .set = set};
    unsigned rows = 0, heights = 0, range_rates = 0;
    float log_noise = 0.0f, log_aliases = 0.0f;
    if (!run_regression(&of)) {
        return 0;
    }
    score->chi2 = acceleration_chi2(&of);
    for (int i = 2 * of.axes; i < of.unknowns; i++) {
        log_noise += rho_log(acceleration_prior_variance(&of));
    }
    for (unsigned m = 0; m < search->num_scans; m++) {
        const struct rho_window_scan *scan = rho_search_scan(search, m);
        struct equation equations[ROWS_MAX];
        if (!(set->mask >> m & 1u)) {
            continue;
        }
        unsigned count = (unsigned)make_plot_equations(&of, m, equations);
        for (unsigned i = 0; i < count; i++) {
            score->chi2 += normalised_residual2(&of, &equations[i]);
            log_noise += rho_log(equations[i].variance);
        }
        rows += count;
        unsigned has_z = of.axes == 3 && (scan->measures & RHO_MEASURES_Z) ? 1u : 0u;
        heights += has_z;
        range_rates += count - 2u - has_z;
        if (rho_measurement_is_ambiguous(&scan->sensor)) {
            log_aliases +=
                (float)(count - 2u - has_z) *
                rho_measurement_log_aliases(&scan->sensor, search->initiator->config.v_max_mps);
        }
    }
    unsigned unknowns = 2u * (unsigned)of.axes;
    float log_fisher =
        rho_linalg_log_determinant(of.unknowns, of.factor) + (float)unknowns * rho_log(of.unit_s);
    score->dimensions = rows - unknowns;
    *nat = -0.5f * ((float)score->dimensions * LOG_TWO_PI + log_noise + log_fisher + score->chi2) +
           rho_target_log_volume(search, of.axes == 3, heights, range_rates) - log_aliases;
    return 1;
}
