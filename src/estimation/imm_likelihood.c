/* SPDX-License-Identifier: MIT */
/*
 * imm_likelihood: the likelihood of a plot under both models.
 */
#include <float.h>
#include <string.h>

#include "imm_plane_update.h"
#include "rhotrack/detail/approx.h"

#define LOG_TWO_PI 1.83787707f
#define ROOT_TWO_PI 2.50662827f
#define LOG_TWO 0.6931473f /* ln 2, rounded up */

/*
 * If one model is within the gate, the other one is used up to this NIS: its density may be higher,
 * as its covariance is smaller.
 */
#define NIS_COUNTS_MAX (2.0f * RHO_IMM_GATE)
/* NIS of a model that is not used: larger than that of any model that is. */
#define NIS_BEYOND_ALL (2.0f * NIS_COUNTS_MAX)

/*
 * One model's estimate, and how a plot scores under it. Positions and velocities have the same
 * indices in both models.
 */
struct model_view {
    const float *state, *covariance;
    const float *projected; /* covariances of the predicted range rate with the state */
    float expected_mps, rate_variance;
    float nis;
    float root; /* 1 / sqrt(det S), S the innovation covariance: the density's factor */
    int counts;
};

/*
 * Fills *out and covariance for a plot with isotropic noise, which needs no line-of-sight frame.
 * Returns 0 if the noise is not isotropic.
 */
static int prepare_plot_if_isotropic(struct rho_measurement *out, float covariance[6],
                                     const struct rho_plot *plot, uint32_t measures,
                                     const struct rho_sensor *sensor)
{
    const struct rho_sigma_factors factors = rho_measurement_sigma_factors(sensor);
    const int has_z = (measures & RHO_MEASURES_Z) != 0;
    const float sigma_m = plot->sigma_range_m;
    const float variance = sigma_m * sigma_m * (factors.range * factors.range);
    if (plot->sigma_cross_m < sigma_m || plot->sigma_cross_m > sigma_m ||
        factors.range < factors.cross || factors.range > factors.cross ||
        (has_z && (plot->sigma_up_m < sigma_m || plot->sigma_up_m > sigma_m))) {
        return 0;
    }
    out->place_m[0] = plot->x_m;
    out->place_m[1] = plot->y_m;
    out->place_m[2] = has_z ? plot->z_m : 0.0f;
    out->cos_azimuth = out->cos_elevation = 1.0f;
    out->sin_azimuth = out->sin_elevation = 0.0f;
    out->variance_m2[0] = out->variance_m2[1] = out->variance_m2[2] = variance;
    out->has_z = has_z;
    out->is_isotropic = 1;
    covariance[RHO_XX] = covariance[RHO_YY] = covariance[RHO_ZZ] = variance;
    covariance[RHO_YX] = covariance[RHO_ZX] = covariance[RHO_ZY] = 0.0f;
    return 1;
}

void rho_imm_prepare_plot(struct rho_imm_plot *seen, const struct rho_plot *plot, uint32_t measures,
                          const struct rho_sensor *sensor)
{
    seen->measures = measures;
    seen->plot = plot;
    seen->sensor = sensor;
    if (prepare_plot_if_isotropic(&seen->position, seen->covariance, plot, measures, sensor)) {
        return;
    }
    rho_measurement_from_plot(plot, measures, sensor, &seen->position);
    rho_measurement_covariance(&seen->position, seen->covariance);
}

/* ---- independent axes ------------------------------------------------------------------------ */

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

/* NIS of the position and velocity of one axis; *det gets the axis' factor of det S. */
static float axis_position_velocity_nis(const struct model_view *view,
                                        const struct rho_imm_plot *seen, int axis, float *det)
{
    const float *p = view->covariance, noise = seen->plot->sigma_mps * seen->plot->sigma_mps;
    const float *by_v = &p[axis_rows[axis][1]];
    const float s = p[axis_rows[axis][0]] + seen->position.variance_m2[0];
    const float factor = by_v[0] / s;
    const float rest = by_v[NUM_AXES] + noise - factor * by_v[0];
    const float off_m = seen->position.place_m[axis] - view->state[axis];
    const float off_mps =
        plot_velocity_component(seen->plot, axis) - view->state[NUM_AXES + axis] - factor * off_m;
    *det = s * rest;
    return off_m * off_m / s + off_mps * off_mps / rest;
}

/* Sets NIS, density factor and use of a model for position and velocity, independent axes. */
static void set_position_velocity_vector_score(struct model_view *view,
                                               const struct rho_imm_plot *seen, int num_axes)
{
    float det[NUM_AXES] = {1.0f, 1.0f, 1.0f};
    view->nis = 0.0f;
    for (int axis = 0; axis < num_axes; axis++) {
        view->nis += axis_position_velocity_nis(view, seen, axis, &det[axis]);
    }
    view->counts = view->nis <= NIS_COUNTS_MAX && det[0] > 0.0f && det[1] > 0.0f && det[2] > 0.0f;
    /* one root for each axis: the product of six variances may overflow */
    view->root = rho_inverse_sqrt(det[0]) * rho_inverse_sqrt(det[1]) * rho_inverse_sqrt(det[2]);
}

/* ---- coupled axes ---------------------------------------------------------------------------- */

/* Innovation d and its covariance s: at most three positions, three velocities and a range rate. */
struct innovation {
    float d[7];
    float s[RHO_TRIANGLE(7)];
    int num;
};

static void set_position_innovation(const struct model_view *view, const struct rho_imm_plot *seen,
                                    int num_axes, struct innovation *out)
{
    for (int i = 0; i < num_axes; i++) {
        out->d[i] = seen->position.place_m[i] - view->state[i];
        for (int j = 0; j <= i; j++) {
            out->s[RHO_AT(i, j)] = view->covariance[RHO_AT(i, j)] + seen->covariance[RHO_AT(i, j)];
        }
    }
    out->num = num_axes;
}

static void append_velocity_innovation(const struct model_view *view,
                                       const struct rho_imm_plot *seen, int num_axes,
                                       struct innovation *out)
{
    for (int i = 0; i < num_axes; i++) {
        float *row = &out->s[RHO_TRIANGLE(num_axes + i)];
        out->d[num_axes + i] = plot_velocity_component(seen->plot, i) - view->state[NUM_AXES + i];
        for (int j = 0; j < num_axes; j++) {
            row[j] = view->covariance[COVARIANCE_AT(i, 1, j, 0)];
        }
        for (int j = 0; j <= i; j++) {
            row[num_axes + j] = view->covariance[COVARIANCE_AT(i, 1, j, 1)];
        }
        row[num_axes + i] += seen->plot->sigma_mps * seen->plot->sigma_mps;
    }
    out->num = 2 * num_axes;
}

static float range_rate_noise_variance(const struct rho_imm_plot *seen)
{
    return seen->plot->sigma_range_rate_mps * seen->plot->sigma_range_rate_mps;
}

static float range_rate_innovation(const struct model_view *view, const struct rho_imm_plot *seen)
{
    return rho_measurement_range_rate_innovation_mps(seen->sensor, seen->plot->range_rate_mps,
                                                     view->expected_mps);
}

/* Appends the range rate to the innovation of positions and velocities. */
static void append_range_rate_innovation(const struct model_view *view,
                                         const struct rho_imm_plot *seen, int num_axes,
                                         struct innovation *out)
{
    float *row = &out->s[RHO_TRIANGLE(out->num)];
    memcpy(row, view->projected, (size_t)num_axes * sizeof *row);
    memcpy(row + num_axes, view->projected + NUM_AXES, (size_t)num_axes * sizeof *row);
    row[out->num] = view->rate_variance + range_rate_noise_variance(seen);
    out->d[out->num++] = range_rate_innovation(view, seen);
}

/* False where the model's position is the sensor's, and no range rate is defined. */
static int has_predicted_range_rate(const struct model_view *view)
{
    return view->rate_variance >= 0.0f;
}

/*
 * NIS of positions, velocities and, if measured, a range rate, on coupled axes: the general case.
 */
static void set_position_velocity_rate_score(struct model_view *view,
                                             const struct rho_imm_plot *seen,
                                             const struct rho_imm_match *match)
{
    struct innovation innovation;
    float log_det = 0.0f;
    set_position_innovation(view, seen, match->num_axes, &innovation);
    append_velocity_innovation(view, seen, match->num_axes, &innovation);
    view->counts = !match->has_range_rate || has_predicted_range_rate(view);
    if (match->has_range_rate && view->counts) {
        append_range_rate_innovation(view, seen, match->num_axes, &innovation);
    }
    /* an ambiguous range rate that cannot be unfolded has the density 1 / span */
    const int is_unclear = match->has_range_rate && view->counts &&
                           !rho_measurement_unfold_range_rate(seen->sensor, innovation.num,
                                                              innovation.s, innovation.d);
    innovation.num -= is_unclear;
    view->counts = view->counts && rho_linalg_gated_nis(innovation.num, innovation.s, innovation.d,
                                                        NIS_COUNTS_MAX, &view->nis, &log_det);
    view->root = rho_exp(-0.5f * log_det);
    if (is_unclear) {
        view->root *= ROOT_TWO_PI / seen->sensor->range_rate_span_mps;
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
    const float variance = view->rate_variance + range_rate_noise_variance(seen) - explained;
    float off = seen->plot->range_rate_mps - view->expected_mps;
    *det = variance;
    if (rho_measurement_has_ambiguous_range_rates(seen->sensor)) {
        const float span_mps = seen->sensor->range_rate_span_mps;
        if (!rho_measurement_can_unfold_range_rate(seen->sensor, variance)) {
            *det = variance > 0.0f ? span_mps * span_mps * (1.0f / RHO_TWO_PI) : variance;
            return 0.0f;
        }
        off = expected_off +
              rho_measurement_range_rate_innovation_mps(seen->sensor, off, expected_off);
    }
    off -= expected_off;
    return off * off / variance;
}

/*
 * NIS of a position with height and, if measured, a range rate, on coupled axes: S = L D L^T
 * written out.
 */
static void set_position_3d_rate_score(struct model_view *view, const struct rho_imm_plot *seen,
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
                   (!has_rate || has_predicted_range_rate(view));
    if (view->counts) {
        /* two roots: the product of four variances may overflow */
        view->root = rho_inverse_sqrt(s00 * s11 * s22) * rho_inverse_sqrt(rate_det);
    }
}

/* ---- both models ----------------------------------------------------------------------------- */

/*
 * Mixture density and model probability from both models' NIS and factors (probability / sqrt(det
 * S)). The smaller NIS is taken out of both exponents, so that their sum cannot underflow.
 */
static inline void combine_model_likelihoods(const float factor[2], const float nis[2],
                                             int num_dimensions, struct rho_imm_match *match)
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
        rho_log(s + m) - 0.5f * (match->nis + (float)num_dimensions * LOG_TWO_PI);
}

static int is_valid_log_likelihood(float log_likelihood)
{
    return log_likelihood >= -1e6f && log_likelihood <= 1e6f;
}

/* Lower bound of a model's probability: rounding to 0 would exclude the model for good. */
#define SHARE_MIN 1.0e-9f

static inline float floored_probability(float share)
{
    return share > SHARE_MIN ? share : SHARE_MIN;
}

void rho_imm_update_probability(struct rho_imm *imm, const float off[2], const float variance[2],
                                float *gain_nat)
{
    struct rho_imm_match match;
    const float factor[2] = {floored_probability(1.0f - imm->probability) *
                                 rho_inverse_sqrt(variance[0]),
                             floored_probability(imm->probability) * rho_inverse_sqrt(variance[1])};
    const float nis[2] = {off[0] * off[0] / variance[0], off[1] * off[1] / variance[1]};
    combine_model_likelihoods(factor, nis, 1, &match);
    imm->probability = match.probability;
    *gain_nat = match.log_likelihood;
}

/* Scores a plot under one model, each kind of plot by the cheapest function. */
static void score_under_model(struct model_view *view, const struct rho_imm *imm,
                              const struct rho_imm_plot *seen, const struct rho_imm_match *match)
{
    const int is_coupled = imm->is_coupled || !seen->position.is_isotropic;
    if (match->has_velocity && (is_coupled || match->has_range_rate)) {
        set_position_velocity_rate_score(view, seen, match);
    } else if (match->has_velocity) {
        set_position_velocity_vector_score(view, seen, match->num_axes);
    } else if (!is_coupled && !match->has_range_rate) {
        set_position_score(view, seen, match->num_axes > 2);
    } else {
        set_position_3d_rate_score(view, seen, match->has_range_rate);
    }
}

/* Returns 0 where neither model's NIS is in the gate, or the density is not usable. */
static int combine_models_if_in_gate(const float factor[2], const float nis[2], int num_dimensions,
                                     struct rho_imm_match *match)
{
    if (!(nis[0] <= RHO_IMM_GATE || nis[1] <= RHO_IMM_GATE)) {
        return 0;
    }
    combine_model_likelihoods(factor, nis, num_dimensions, match);
    return is_valid_log_likelihood(match->log_likelihood);
}

/* A plot's position in the plane and its covariance, and whether its range rate is scored. */
struct plane_plot {
    float x_m, y_m, xx_m2, xy_m2, yy_m2;
    int has_rate;
};

/*
 * NIS of a position without height and, if measured, a range rate: S = L D L^T written out. *factor
 * gets share / sqrt(det S). NIS_BEYOND_ALL and factor 0 where the model is not used.
 */
static inline float position_2d_rate_nis(const struct model_view *view,
                                         const struct plane_plot *plot,
                                         const struct rho_imm_plot *seen, float share,
                                         float *factor)
{
    const float *p = view->covariance, *rate = view->projected;
    const float s00 = p[RHO_XX] + plot->xx_m2, s10 = p[RHO_YX] + plot->xy_m2;
    const float inverse0 = 1.0f / s00, l10 = s10 * inverse0;
    const float s11 = p[RHO_YY] + plot->yy_m2 - l10 * s10, inverse1 = 1.0f / s11;
    const float d0 = plot->x_m - view->state[RHO_X];
    const float d1 = plot->y_m - view->state[RHO_Y] - l10 * d0;
    const float to0 = d0 * inverse0, to1 = d1 * inverse1;
    float nis = d0 * to0 + d1 * to1, det = s00 * s11, rate_det = 1.0f;
    int counts = s11 > 0.0f;
    if (plot->has_rate) {
        const float rate0 = rate[RHO_X], rate1 = rate[RHO_Y] - l10 * rate0;
        nis += range_rate_nis(view, seen, rate0 * to0 + rate1 * to1,
                              rate0 * rate0 * inverse0 + rate1 * rate1 * inverse1, &rate_det);
        det *= rate_det;
        counts = counts && rate_det > 0.0f && has_predicted_range_rate(view);
    }
    if (!(counts && nis <= NIS_COUNTS_MAX)) {
        *factor = 0.0f;
        return NIS_BEYOND_ALL;
    }
    *factor = floored_probability(share) * rho_inverse_sqrt(det);
    return nis;
}

/*
 * Range rate that one model with a height predicts, its variance and covariances with the state.
 * Returns 0 where the position is the sensor's.
 */
static int predict_range_rate_3d(const float *state, const float *covariance,
                                 const struct rho_sensor *sensor, float *expected_mps,
                                 float *variance, float projected[RHO_KALMAN_STATES])
{
    struct rho_kalman_row rate;
    struct rho_kalman at;
    load_kinematics(&at, state, covariance);
    if (!rho_kalman_linearise_range_rate(&at, sensor, 0.0f, FLT_MIN, &rate)) {
        return 0;
    }
    *expected_mps = -rate.innovation;
    *variance = rate.variance + rho_linalg_project6(at.covariance, rate.row, projected);
    return 1;
}

static int predict_range_rate_2d(const float *state, const float *covariance,
                                 const struct rho_sensor *sensor, float *expected_mps,
                                 float *variance, float projected[RHO_KALMAN_STATES])
{
    struct plane_rate rate;
    float spread[RHO_PLANE_MANOEUVRE];
    if (!rho_imm_plane_predict_range_rate(state, covariance, sensor, &rate)) {
        return 0;
    }
    *expected_mps = rate.expected_mps;
    *variance = rate.nonlinearity +
                rho_imm_plane_project_range_rate(RHO_PLANE_STEADY, covariance, rate.row, spread);
    projected[RHO_X] = spread[0];
    projected[RHO_Y] = spread[1];
    projected[RHO_Z] = 0.0f;
    projected[RHO_VX] = spread[2];
    projected[RHO_VY] = spread[3];
    projected[RHO_VZ] = 0.0f;
    return 1;
}

void rho_imm_predict_range_rates(struct rho_imm_rates *rates, const struct rho_imm *imm,
                                 const struct rho_sensor *sensor)
{
    const float *states[2] = {imm->steady.state, imm->state};
    const float *covariances[2] = {imm->steady.covariance, imm->covariance};
    const int has_height = has_estimate_on_axis(imm, 2);
    for (int i = 0; i < 2; i++) {
        float *expected_mps = &rates->expected_mps[i], *variance = &rates->variance[i];
        float *projected = rates->projected[i];
        if (!(has_height ? predict_range_rate_3d(states[i], covariances[i], sensor, expected_mps,
                                                 variance, projected)
                         : predict_range_rate_2d(states[i], covariances[i], sensor, expected_mps,
                                                 variance, projected))) {
            *expected_mps = 0.0f;
            *variance = -1.0f;
            memset(projected, 0, sizeof rates->projected[i]);
        }
    }
}

int rho_imm_predict_rates_and_score_plot(const struct rho_imm *imm, const struct rho_imm_plot *seen,
                                         struct rho_imm_match *match)
{
    struct rho_imm_rates rates = {.expected_mps = {0.0f, 0.0f}};
    if (seen->measures & RHO_MEASURES_RANGE_RATE) {
        rho_imm_predict_range_rates(&rates, imm, seen->sensor);
    }
    return rho_imm_score_plot_with_rates(imm, &rates, seen, match);
}

/*
 * True for a plot of a position without height, with coupled axes or a range rate: the plots of
 * most radars.
 */
static int can_score_in_plane(const struct rho_imm *imm, const struct rho_imm_plot *seen,
                              const struct rho_imm_match *match)
{
    return match->num_axes < 3 && !match->has_velocity &&
           (imm->is_coupled || !seen->position.is_isotropic || match->has_range_rate);
}

/* Sets the view on the steady model (0) or the manoeuvring one (1), with its range rate. */
static inline void fill_view_of_model(struct model_view *view, int model, const struct rho_imm *imm,
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

/*
 * Scores a plot without height: a function apart, as it runs for each plot in the gate of each
 * hypothesis.
 */
static int score_in_plane(const struct rho_imm *imm, const struct rho_imm_rates *rates,
                          const struct rho_imm_plot *seen, struct rho_imm_match *match)
{
    const struct plane_plot plot = {
        .x_m = seen->position.place_m[0],
        .y_m = seen->position.place_m[1],
        .xx_m2 = seen->covariance[RHO_XX],
        .xy_m2 = seen->covariance[RHO_YX],
        .yy_m2 = seen->covariance[RHO_YY],
        .has_rate = match->has_range_rate,
    };
    const float share[2] = {1.0f - imm->probability, imm->probability};
    float factor[2], nis[2];
    for (int i = 0; i < 2; i++) {
        struct model_view view;
        fill_view_of_model(&view, i, imm, rates, plot.has_rate);
        nis[i] = position_2d_rate_nis(&view, &plot, seen, share[i], &factor[i]);
    }
    return combine_models_if_in_gate(factor, nis, 2 + plot.has_rate, match);
}

int rho_imm_score_plot_with_rates(const struct rho_imm *imm, const struct rho_imm_rates *rates,
                                  const struct rho_imm_plot *seen, struct rho_imm_match *match)
{
    const float share[2] = {1.0f - imm->probability, imm->probability};
    float factor[2], nis[2];
    match->num_axes = seen->position.has_z && has_estimate_on_axis(imm, 2) ? 3 : 2;
    match->has_velocity = (seen->measures & RHO_MEASURES_VELOCITY) != 0;
    match->has_range_rate = (seen->measures & RHO_MEASURES_RANGE_RATE) != 0;
    if (can_score_in_plane(imm, seen, match)) {
        return score_in_plane(imm, rates, seen, match);
    }
    for (int i = 0; i < 2; i++) {
        struct model_view view;
        fill_view_of_model(&view, i, imm, rates, match->has_range_rate);
        score_under_model(&view, imm, seen, match);
        nis[i] = view.counts ? view.nis : NIS_BEYOND_ALL;
        factor[i] = view.counts ? floored_probability(share[i]) * view.root : 0.0f;
    }
    return combine_models_if_in_gate(
        factor, nis, (match->has_velocity ? 2 : 1) * match->num_axes + match->has_range_rate,
        match);
}

/* ---- many plots of one noise ----------------------------------------------------------------- */

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
        rho_log(share * rho_inverse_sqrt(det)) - 0.5f * LOG_TWO_PI * (float)gate->num_axes;
}

int rho_imm_prepare_gate_if_uncoupled(struct rho_imm_gate *gate, const struct rho_imm *imm,
                                      float variance_m2, int has_z)
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

/*
 * ln of a model's term of the mixture density; half: half of the NIS. Next to nothing for a model
 * that is not used.
 */
static inline float log_density_of_model(float log_factor, float half)
{
    return log_factor - (half <= 0.5f * NIS_COUNTS_MAX ? half : 1e6f);
}

/*
 * Scores a position of the gate's noise. ln(e^s + e^m) lies between max(s, m) and max(s, m) + ln 2:
 * log_likelihood_to_exceed is compared with the upper bound.
 */
int rho_imm_score_position_in_gate(const struct rho_imm_gate *gate, const float place_m[3],
                                   float log_likelihood_to_exceed, float *log_likelihood,
                                   float *probability)
{
    const float to_s = half_nis(gate->centre_m[0], gate->half_inverse[0], place_m);
    const float to_m = half_nis(gate->centre_m[1], gate->half_inverse[1], place_m);
    if (!(to_s <= 0.5f * RHO_IMM_GATE || to_m <= 0.5f * RHO_IMM_GATE)) {
        return 0;
    }
    const float s = log_density_of_model(gate->log_factor[0], to_s),
                m = log_density_of_model(gate->log_factor[1], to_m);
    const float most = s > m ? s : m, least = s > m ? m : s;
    if (!(most + LOG_TWO > log_likelihood_to_exceed)) {
        return 0;
    }
    const float ratio = rho_exp(least - most), share = 1.0f / (1.0f + ratio);
    *probability = s > m ? ratio * share : share;
    *log_likelihood = most + rho_log_one_plus(ratio);
    return 1;
}
