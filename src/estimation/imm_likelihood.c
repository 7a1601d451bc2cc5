/* SPDX-License-Identifier: MIT */
/* imm_likelihood: the likelihood of a plot under both models. */
#include <float.h>
#include <string.h>

#include "imm_plane_update.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

/* Largest NIS of a model beside one in the gate: its smaller covariance may mean more density. */
#define NIS_COUNTS_MAX (RHO_IMM_GATE * 2.0f)
/* NIS of a model that is not used: larger than that of any model that is. */
#define NIS_BEYOND_ALL (NIS_COUNTS_MAX * 2.0f)

/* A model's estimate and a plot's score; places and velocities have the same indices in both. */
struct model_view {
    const float *state, *covariance;
    const float *projected; /* covariances of the predicted range rate with the state */
    float expected_mps, rate_variance;
    float nis;
    float root; /* 1 / sqrt(det S), S the innovation covariance: the density's factor */
    int counts;
};

void rho_imm_prepare_plot(struct rho_imm_plot *seen, const struct rho_plot *plot, uint32_t measures,
                          const struct rho_sensor *sensor)
{
    const struct rho_sigma_factors factors = rho_measurement_sigma_factors(sensor);
    const int has_z = (measures & RHO_MEASURES_Z) != 0;
    const float sigma_m = plot->sigma_range_m;
    seen->measures = measures;
    seen->plot = plot;
    seen->sensor = sensor;
    if (plot->sigma_cross_m < sigma_m || plot->sigma_cross_m > sigma_m ||
        factors.range < factors.cross || factors.range > factors.cross ||
        (has_z && (plot->sigma_up_m < sigma_m || plot->sigma_up_m > sigma_m))) {
        rho_measurement_from_plot(plot, measures, sensor, &seen->position);
        rho_measurement_covariance(&seen->position, seen->covariance);
        return;
    }
    /* isotropic noise needs no line-of-sight frame */
    const float variance = sigma_m * sigma_m * (factors.range * factors.range);
    seen->position = (struct rho_measurement){
        .place_m = {plot->x_m, plot->y_m, has_z ? plot->z_m : 0.0f},
        .cos_azimuth = 1.0f,
        .cos_elevation = 1.0f,
        .variance_m2 = {variance, variance, variance},
        .has_z = has_z,
        .is_isotropic = 1,
    };
    seen->covariance[RHO_XX] = seen->covariance[RHO_YY] = seen->covariance[RHO_ZZ] = variance;
    seen->covariance[RHO_YX] = seen->covariance[RHO_ZX] = seen->covariance[RHO_ZY] = 0.0f;
}

/* Sets NIS, density factor and use of a model for a position on independent axes. */
static inline void set_position_score(struct model_view *view, const struct rho_imm_plot *seen,
                                      int has_z)
{
    const float *p = view->covariance, noise = seen->position.variance_m2[0];
    const float sx = p[RHO_XX] + noise, sy = p[RHO_YY] + noise;
    const float dx = seen->position.place_m[0] - view->state[RHO_X];
    const float dy = seen->position.place_m[1] - view->state[RHO_Y];
    float det = sx * sy;
    view->nis = (dx * dx * sy + dy * dy * sx) / det;
    if (has_z) {
        const float sz = p[RHO_ZZ] + noise, dz = seen->position.place_m[2] - view->state[RHO_Z];
        view->nis += dz * dz / sz;
        det *= sz;
    }
    view->counts = view->nis <= NIS_COUNTS_MAX && det > 0.0f;
    view->root = rho_inverse_sqrt(det);
}

/* Sets NIS, density factor and use of a model for position and velocity, independent axes. */
static void set_velocity_score(struct model_view *view, const struct rho_imm_plot *seen,
                               int num_axes)
{
    const float *p = view->covariance, noise = seen->plot->sigma_mps * seen->plot->sigma_mps;
    float det[RHO_AXES] = {1.0f, 1.0f, 1.0f};
    view->nis = 0.0f;
    for (int axis = 0; axis < num_axes; axis++) {
        const float *by_v = &p[axis_rows[axis][1]];
        const float s = p[axis_rows[axis][0]] + seen->position.variance_m2[0];
        const float factor = by_v[0] / s;
        const float rest = by_v[RHO_AXES] + noise - factor * by_v[0];
        const float off_m = seen->position.place_m[axis] - view->state[axis];
        const float off_mps = plot_velocity_component(seen->plot, axis) -
                              view->state[RHO_AXES + axis] - factor * off_m;
        det[axis] = s * rest;
        view->nis += off_m * off_m / s + off_mps * off_mps / rest;
    }
    view->counts = view->nis <= NIS_COUNTS_MAX && det[0] > 0.0f && det[1] > 0.0f && det[2] > 0.0f;
    /* one root for each axis: the product of six variances may overflow */
    view->root = rho_inverse_sqrt(det[0]) * rho_inverse_sqrt(det[1]) * rho_inverse_sqrt(det[2]);
}

static float rate_noise_variance(const struct rho_imm_plot *seen)
{
    return seen->plot->sigma_range_rate_mps * seen->plot->sigma_range_rate_mps;
}

/* False where the model's position is the sensor's, and no range rate is defined. */
static int has_predicted_rate(const struct model_view *view)
{
    return view->rate_variance >= 0.0f;
}

/* The general case: NIS of positions, velocities and, if measured, a range rate, axes coupled. */
static void set_general_score(struct model_view *view, const struct rho_imm_plot *seen,
                              const struct rho_imm_match *match)
{
    const int n = match->num_axes;
    float d[2 * RHO_AXES + 1], s[RHO_TRIANGLE(2 * RHO_AXES + 1)], log_det = 0.0f;
    int num = 2 * n;
    for (int i = 0; i < n; i++) {
        float *row = &s[RHO_TRIANGLE(n + i)];
        d[i] = seen->position.place_m[i] - view->state[i];
        d[n + i] = plot_velocity_component(seen->plot, i) - view->state[RHO_AXES + i];
        for (int j = 0; j < n; j++) {
            row[j] = view->covariance[COVARIANCE_AT(i, 1, j, 0)];
        }
        for (int j = 0; j <= i; j++) {
            s[RHO_AT(i, j)] = view->covariance[RHO_AT(i, j)] + seen->covariance[RHO_AT(i, j)];
            row[n + j] = view->covariance[COVARIANCE_AT(i, 1, j, 1)];
        }
        row[n + i] += seen->plot->sigma_mps * seen->plot->sigma_mps;
    }
    view->counts = !match->has_range_rate || has_predicted_rate(view);
    if (match->has_range_rate && view->counts) {
        float *row = &s[RHO_TRIANGLE(num)];
        memcpy(row, view->projected, (size_t)n * sizeof *row);
        memcpy(row + n, view->projected + RHO_AXES, (size_t)n * sizeof *row);
        row[num] = view->rate_variance + rate_noise_variance(seen);
        d[num++] = rho_measurement_innovation_mps(seen->sensor, seen->plot->range_rate_mps,
                                                  view->expected_mps);
    }
    /* an ambiguous range rate that cannot be unfolded has the density 1 / span */
    const int is_unclear = match->has_range_rate && view->counts &&
                           !rho_measurement_unfold_rate(seen->sensor, num, s, d);
    num -= is_unclear;
    view->counts =
        view->counts && rho_linalg_gated_nis(num, s, d, NIS_COUNTS_MAX, &view->nis, &log_det);
    view->root = rho_exp(-0.5f * log_det);
    if (is_unclear) {
        view->root *= RHO_ROOT_TWO_PI / seen->sensor->range_rate_span_mps;
    }
}

/*
 * NIS of a range rate, given the position innovation. expected_off: range rate innovation that the
 * position innovation predicts; `explained`: variance that it explains. *det gets the range rate's
 * factor of det S. An ambiguous range rate that cannot be unfolded has the density 1 / span.
 */
static inline float range_rate_nis(const struct model_view *view, const struct rho_imm_plot *seen,
                                   float expected_off, float explained, float *det)
{
    const float variance = view->rate_variance + rate_noise_variance(seen) - explained;
    float off = seen->plot->range_rate_mps - view->expected_mps;
    *det = variance;
    if (rho_measurement_is_ambiguous(seen->sensor)) {
        const float span_mps = seen->sensor->range_rate_span_mps;
        if (!rho_measurement_can_unfold(seen->sensor, variance)) {
            *det = variance > 0.0f ? span_mps * span_mps * (1.0f / RHO_TWO_PI) : variance;
            return 0.0f;
        }
        off = expected_off + rho_measurement_innovation_mps(seen->sensor, off, expected_off);
    }
    off -= expected_off;
    return off * off / variance;
}

/* NIS of a position with height, and a range rate if measured: S = L D L^T written out. */
static void set_coupled_score(struct model_view *view, const struct rho_imm_plot *seen,
                              int has_rate)
{
    const float *p = view->covariance, *r = seen->covariance, *rate = view->projected;
    const float s00 = p[RHO_XX] + r[RHO_XX], s10 = p[RHO_YX] + r[RHO_YX], l10 = s10 / s00;
    const float s20 = p[RHO_ZX] + r[RHO_ZX], l20 = s20 / s00;
    const float s11 = p[RHO_YY] + r[RHO_YY] - l10 * s10;
    const float c21 = p[RHO_ZY] + r[RHO_ZY] - l20 * s10, l21 = c21 / s11;
    const float s22 = p[RHO_ZZ] + r[RHO_ZZ] - l20 * s20 - l21 * c21;
    const float d0 = seen->position.place_m[0] - view->state[RHO_X];
    const float d1 = seen->position.place_m[1] - view->state[RHO_Y] - l10 * d0;
    const float d2 = seen->position.place_m[2] - view->state[RHO_Z] - l20 * d0 - l21 * d1;
    const float to0 = d0 / s00, to1 = d1 / s11, to2 = d2 / s22;
    float nis = d0 * to0 + d1 * to1 + d2 * to2, rate_det = 1.0f;
    if (has_rate) {
        const float rate0 = rate[RHO_X], rate1 = rate[RHO_Y] - l10 * rate0;
        const float rate2 = rate[RHO_Z] - l20 * rate0 - l21 * rate1;
        nis += range_rate_nis(view, seen, rate0 * to0 + rate1 * to1 + rate2 * to2,
                              rate0 * rate0 / s00 + rate1 * rate1 / s11 + rate2 * rate2 / s22,
                              &rate_det);
    }
    view->nis = nis;
    view->counts = nis <= NIS_COUNTS_MAX && s11 > 0.0f && s22 > 0.0f && rate_det > 0.0f &&
                   (!has_rate || has_predicted_rate(view));
    if (view->counts) {
        /* two roots: the product of four variances may overflow */
        view->root = rho_inverse_sqrt(s00 * s11 * s22) * rho_inverse_sqrt(rate_det);
    }
}

/*
 * Mixture density and model probability from both models' NIS and factors (probability / sqrt(det
 * S)). The smaller NIS is taken out of both exponents, so that their sum cannot underflow.
 */
static inline void combine_models(const float factor[2], const float nis[2], int num_dimensions,
                                  struct rho_imm_match *match)
{
    float s = factor[0], m = factor[1];
    if (nis[0] <= nis[1]) {
        match->nis = nis[0];
        m *= rho_exp(0.5f * (nis[0] - nis[1]));
    } else {
        match->nis = nis[1];
        s *= rho_exp(0.5f * (nis[1] - nis[0]));
    }
    match->probability = m / (s + m);
    match->log_likelihood =
        rho_log(s + m) - 0.5f * (match->nis + (float)num_dimensions * RHO_LOG_TWO_PI);
}

static int is_valid_log_likelihood(float log_likelihood)
{
    return log_likelihood >= -1e6f && log_likelihood <= 1e6f;
}

static inline float floored_probability(float share)
{
    return rho_larger(share, PROBABILITY_MIN);
}

float rho_imm_weigh_models(float *probability, const float likelihood[2])
{
    const float steady = floored_probability(1.0f - *probability) * likelihood[0];
    const float manoeuvre = floored_probability(*probability) * likelihood[1];
    if (steady + manoeuvre > 0.0f) { /* else the measurement is all but impossible to both */
        *probability = manoeuvre / (steady + manoeuvre);
    }
    return steady + manoeuvre;
}

/* Returns 0 where neither model's NIS is in the gate, or the density is not usable. */
static inline int combine_if_in_gate(const float factor[2], const float nis[2], int num_dimensions,
                                     struct rho_imm_match *match)
{
    if (!(nis[0] <= RHO_IMM_GATE || nis[1] <= RHO_IMM_GATE)) {
        return 0;
    }
    combine_models(factor, nis, num_dimensions, match);
    return is_valid_log_likelihood(match->log_likelihood);
}

/*
 * NIS of a position without height and, if measured, a range rate: S = L D L^T written out. *factor
 * gets share / sqrt(det S). NIS_BEYOND_ALL and factor 0 where the model is not used.
 */
static inline float nis_in_plane(const struct model_view *view, const struct rho_imm_plot *seen,
                                 int has_rate, float share, float *factor)
{
    const float *p = view->covariance, *r = seen->covariance, *rate = view->projected;
    const float s00 = p[RHO_XX] + r[RHO_XX], s10 = p[RHO_YX] + r[RHO_YX];
    const float inverse0 = 1.0f / s00, l10 = s10 * inverse0;
    const float s11 = p[RHO_YY] + r[RHO_YY] - l10 * s10, inverse1 = 1.0f / s11;
    const float d0 = seen->position.place_m[0] - view->state[RHO_X];
    const float d1 = seen->position.place_m[1] - view->state[RHO_Y] - l10 * d0;
    const float to0 = d0 * inverse0, to1 = d1 * inverse1;
    float nis = d0 * to0 + d1 * to1, det = s00 * s11, rate_det = 1.0f;
    int counts = s11 > 0.0f;
    if (has_rate) {
        const float rate0 = rate[RHO_X], rate1 = rate[RHO_Y] - l10 * rate0;
        nis += range_rate_nis(view, seen, rate0 * to0 + rate1 * to1,
                              rate0 * rate0 * inverse0 + rate1 * rate1 * inverse1, &rate_det);
        det *= rate_det;
        counts = counts && rate_det > 0.0f && has_predicted_rate(view);
    }
    if (!(counts && nis <= NIS_COUNTS_MAX)) {
        *factor = 0.0f;
        return NIS_BEYOND_ALL;
    }
    *factor = floored_probability(share) * rho_inverse_sqrt(det);
    return nis;
}

void rho_imm_predict_range_rates(struct rho_imm_rates *rates, const struct rho_imm *imm,
                                 const struct rho_sensor *sensor)
{
    const float *states[2] = {imm->steady.state, imm->state};
    const float *covariances[2] = {imm->steady.covariance, imm->covariance};
    const int has_height = has_estimate_on_axis(imm, RHO_Z);
    for (int i = 0; i < 2; i++) {
        float *projected = rates->projected[i];
        struct plane_rate level;
        if (has_height) {
            struct rho_kalman at;
            struct rho_kalman_row rate;
            load_kinematics(&at, states[i], covariances[i]);
            if (rho_kalman_linearise_rate(&at, sensor, 0.0f, FLT_MIN, &rate)) {
                rates->expected_mps[i] = -rate.innovation;
                rates->variance[i] =
                    rate.variance + rho_linalg_project6(at.covariance, rate.row, projected);
                continue;
            }
        } else if (rho_imm_plane_rate(states[i], covariances[i], sensor, &level)) {
            float spread[RHO_PLANE_MANOEUVRE];
            rates->expected_mps[i] = level.expected_mps;
            rates->variance[i] =
                level.nonlinearity +
                rho_imm_plane_project_rate(RHO_PLANE_STEADY, covariances[i], level.row, spread);
            projected[RHO_X] = spread[0];
            projected[RHO_Y] = spread[1];
            projected[RHO_Z] = 0.0f;
            projected[RHO_VX] = spread[2];
            projected[RHO_VY] = spread[3];
            projected[RHO_VZ] = 0.0f;
            continue;
        }
        rates->expected_mps[i] = 0.0f; /* the model's position is the sensor's */
        rates->variance[i] = -1.0f;
        memset(projected, 0, sizeof rates->projected[i]);
    }
}

int rho_imm_score_plot(const struct rho_imm *imm, const struct rho_imm_plot *seen,
                       struct rho_imm_match *match)
{
    struct rho_imm_rates rates = {.expected_mps = {0.0f, 0.0f}};
    if (seen->measures & RHO_MEASURES_RANGE_RATE) {
        rho_imm_predict_range_rates(&rates, imm, seen->sensor);
    }
    return rho_imm_score_with_rates(imm, &rates, seen, match);
}

/* Sets the view on the steady model (0) or the manoeuvring one (1), with its range rate. */
static inline void view_model(struct model_view *view, int model, const struct rho_imm *imm,
                              const struct rho_imm_rates *rates, int has_rate)
{
    view->state = model == 0 ? imm->steady.state : imm->state;
    view->covariance = model == 0 ? imm->steady.covariance : imm->covariance;
    view->projected = rates->projected[model];
    if (has_rate) {
        view->expected_mps = rates->expected_mps[model];
        view->rate_variance = rates->variance[model];
    }
}

int rho_imm_score_with_rates(const struct rho_imm *imm, const struct rho_imm_rates *rates,
                             const struct rho_imm_plot *seen, struct rho_imm_match *match)
{
    const float share[2] = {1.0f - imm->probability, imm->probability};
    const int is_coupled = imm->is_coupled || !seen->position.is_isotropic;
    const int has_rate = (seen->measures & RHO_MEASURES_RANGE_RATE) != 0;
    float factor[2], nis[2];
    match->num_axes = seen->position.has_z && has_estimate_on_axis(imm, RHO_Z) ? 3 : 2;
    match->has_velocity = (seen->measures & RHO_MEASURES_VELOCITY) != 0;
    match->has_range_rate = (uint8_t)has_rate;
    /* each kind of plot by the cheapest function; those of most radars have no height */
    if (match->num_axes < 3 && !match->has_velocity && (is_coupled || has_rate)) {
        for (int i = 0; i < 2; i++) {
            struct model_view view;
            view_model(&view, i, imm, rates, has_rate);
            nis[i] = nis_in_plane(&view, seen, has_rate, share[i], &factor[i]);
        }
        return combine_if_in_gate(factor, nis, 2 + has_rate, match);
    }
    for (int i = 0; i < 2; i++) {
        struct model_view view;
        view_model(&view, i, imm, rates, has_rate);
        if (match->has_velocity && (is_coupled || has_rate)) {
            set_general_score(&view, seen, match);
        } else if (match->has_velocity) {
            set_velocity_score(&view, seen, match->num_axes);
        } else if (is_coupled || has_rate) {
            set_coupled_score(&view, seen, has_rate);
        } else {
            set_position_score(&view, seen, match->num_axes > 2);
        }
        nis[i] = view.counts ? view.nis : NIS_BEYOND_ALL;
        factor[i] = view.counts ? floored_probability(share[i]) * view.root : 0.0f;
    }
    return combine_if_in_gate(factor, nis,
                              (match->has_velocity ? 2 : 1) * match->num_axes + has_rate, match);
}

static void fill_gate_of_model(struct rho_imm_gate *gate, int model, const float *state,
                               const float *covariance, float variance_m2, float share)
{
    float *centre_m = gate->centre_m[model], *inverse = gate->half_inverse[model];
    const float sx = covariance[RHO_XX] + variance_m2;
    const float sy = covariance[RHO_YY] + variance_m2;
    float det = sx * sy;
    centre_m[0] = state[RHO_X];
    centre_m[1] = state[RHO_Y];
    centre_m[2] = state[RHO_Z];
    inverse[0] = 0.5f / sx;
    inverse[1] = 0.5f / sy;
    inverse[2] = 0.0f;
    if (gate->num_axes > 2) {
        const float sz = covariance[RHO_ZZ] + variance_m2;
        inverse[2] = 0.5f / sz;
        det *= sz;
    }
    gate->log_factor[model] =
        rho_log(share * rho_inverse_sqrt(det)) - 0.5f * RHO_LOG_TWO_PI * (float)gate->num_axes;
}

int rho_imm_prepare_gate(struct rho_imm_gate *gate, const struct rho_imm *imm, float variance_m2,
                         int has_z)
{
    if (imm->is_coupled) {
        return 0;
    }
    gate->num_axes = has_z && has_estimate_on_axis(imm, 2) ? 3 : 2;
    fill_gate_of_model(gate, 0, imm->steady.state, imm->steady.covariance, variance_m2,
                       floored_probability(1.0f - imm->probability));
    fill_gate_of_model(gate, 1, imm->state, imm->covariance, variance_m2,
                       floored_probability(imm->probability));
    return is_valid_log_likelihood(gate->log_factor[0]) &&
           is_valid_log_likelihood(gate->log_factor[1]);
}

/* Half of a plot's NIS under one model; half_inverse: 1 / (2 S) of each axis. */
static inline float half_nis(const float centre_m[3], const float half_inverse[3],
                             const float place_m[3])
{
    const float dx = place_m[0] - centre_m[0], dy = place_m[1] - centre_m[1];
    const float dz = place_m[2] - centre_m[2];
    return dx * dx * half_inverse[0] + dy * dy * half_inverse[1] + dz * dz * half_inverse[2];
}

/* ln of a model's term of the mixture, next to nothing if unused; half: half of the NIS. */
static inline float log_density_of_model(float log_factor, float half)
{
    return log_factor - (half <= 0.5f * NIS_COUNTS_MAX ? half : 1e6f);
}

/*
 * Scores a position of the gate's noise. ln(e^s + e^m) lies between max(s, m) and max(s, m) + ln 2
 * (rounded up): log_likelihood_to_exceed is compared with the upper bound.
 */
int rho_imm_score_in_gate(const struct rho_imm_gate *gate, const float place_m[3],
                          float log_likelihood_to_exceed, float *log_likelihood, float *probability)
{
    const float to_s = half_nis(gate->centre_m[0], gate->half_inverse[0], place_m);
    const float to_m = half_nis(gate->centre_m[1], gate->half_inverse[1], place_m);
    if (!(to_s <= 0.5f * RHO_IMM_GATE || to_m <= 0.5f * RHO_IMM_GATE)) {
        return 0;
    }
    const float s = log_density_of_model(gate->log_factor[0], to_s),
                m = log_density_of_model(gate->log_factor[1], to_m);
    const float most = s > m ? s : m, least = s > m ? m : s;
    if (!(most + 0.6931473f > log_likelihood_to_exceed)) {
        return 0;
    }
    const float ratio = rho_exp(least - most), share = 1.0f / (1.0f + ratio);
    *probability = s > m ? ratio * share : share;
    *log_likelihood = most + rho_log_one_plus(ratio);
    return 1;
}
