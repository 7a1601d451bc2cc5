/* SPDX-License-Identifier: MIT */
/*
 * imm_match: how well both models predicted a plot.
 */
#include <float.h>
#include <string.h>

#include "imm_plane.h"
#include "rhotrack/approx.h"

#define LOG_TWO_PI 1.83787707f
#define ROOT_TWO_PI 2.50662827f
#define LOG_TWO 0.6931473f /* rounded up */

/* A model beyond the gate still counts beside one within it: its density may be the higher one, as it is narrower. */
#define COUNTS_MAX (2.0f * RHO_IMM_GATE)
/* Of one that does not count: farther than all that do. */
#define BEYOND_ALL (2.0f * COUNTS_MAX)

/* What one model says of a plot. Both models' positions and velocities have the same places. */
struct view {
    const float *state, *covariance;
    const float *projected; /* of the range rate that it expects */
    float expected_mps, rate_variance;
    float distance2;
    float
        root; /* of the inverse determinant of the innovation's covariance: what the density is in proportion to */
    int counts;
};

/* Isotropic noise has no frame: nothing to find it for. */
static int open_isotropic(struct rho_measurement *out, float covariance[6],
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
    covariance[RHO_AT(0, 0)] = covariance[RHO_AT(1, 1)] = covariance[RHO_AT(2, 2)] = variance;
    covariance[RHO_AT(1, 0)] = covariance[RHO_AT(2, 0)] = covariance[RHO_AT(2, 1)] = 0.0f;
    return 1;
}

void rho_imm_open_plot(struct rho_imm_plot *seen, const struct rho_plot *plot, uint32_t measures,
                       const struct rho_sensor *sensor)
{
    seen->measures = measures;
    seen->plot = plot;
    seen->sensor = sensor;
    if (open_isotropic(&seen->position, seen->covariance, plot, measures, sensor)) {
        return;
    }
    rho_measurement_open(plot, measures, sensor, &seen->position);
    rho_measurement_covariance(&seen->position, seen->covariance);
}

/* ---- independent axes ------------------------------------------------------------------------- */

static inline void view_places(struct view *view, const struct rho_imm_plot *seen, int has_z)
{
    const float *p = view->covariance, noise = seen->position.variance_m2[0];
    const float sx = p[RHO_AT(0, 0)] + noise, sy = p[RHO_AT(1, 1)] + noise;
    const float dx = seen->position.place_m[0] - view->state[0];
    const float dy = seen->position.place_m[1] - view->state[1];
    float det = sx * sy;
    view->distance2 = (dx * dx * sy + dy * dy * sx) / det;
    if (has_z) {
        const float sz = p[RHO_AT(2, 2)] + noise, dz = seen->position.place_m[2] - view->state[2];
        view->distance2 += dz * dz / sz;
        det *= sz;
    }
    view->counts = view->distance2 <= COUNTS_MAX && det > 0.0f;
    view->root = rho_inverse_sqrt(det);
}

/* Position and velocity of one axis: a distance, and the factor of the determinant. */
static float axis_distance2(const struct view *view, const struct rho_imm_plot *seen, int axis,
                            float *det)
{
    const float *p = view->covariance, noise = seen->plot->sigma_mps * seen->plot->sigma_mps;
    const float *by_v = &p[axis_rows[axis][1]];
    const float s = p[axis_rows[axis][0]] + seen->position.variance_m2[0];
    const float factor = by_v[0] / s;
    const float rest = by_v[NUM_AXES] + noise - factor * by_v[0];
    const float off_m = seen->position.place_m[axis] - view->state[axis];
    const float off_mps =
        velocity_of(seen->plot, axis) - view->state[NUM_AXES + axis] - factor * off_m;
    *det = s * rest;
    return off_m * off_m / s + off_mps * off_mps / rest;
}

static void view_places_and_velocities(struct view *view, const struct rho_imm_plot *seen,
                                       int num_axes)
{
    float det[NUM_AXES] = {1.0f, 1.0f, 1.0f};
    view->distance2 = 0.0f;
    for (int axis = 0; axis < num_axes; axis++) {
        view->distance2 += axis_distance2(view, seen, axis, &det[axis]);
    }
    view->counts = view->distance2 <= COUNTS_MAX && det[0] > 0.0f && det[1] > 0.0f && det[2] > 0.0f;
    /* apart: the product of six variances may be no number */
    view->root = rho_inverse_sqrt(det[0]) * rho_inverse_sqrt(det[1]) * rho_inverse_sqrt(det[2]);
}

/* ---- coupled axes ----------------------------------------------------------------------------- */

/* Innovation and its covariance, at most three places, three velocities and a range rate. */
struct innovation {
    float d[7];
    float s[RHO_TRIANGLE(7)];
    int num;
};

static void add_position(const struct view *view, const struct rho_imm_plot *seen, int num_axes,
                         struct innovation *out)
{
    for (int i = 0; i < num_axes; i++) {
        out->d[i] = seen->position.place_m[i] - view->state[i];
        for (int j = 0; j <= i; j++) {
            out->s[RHO_AT(i, j)] = view->covariance[RHO_AT(i, j)] + seen->covariance[RHO_AT(i, j)];
        }
    }
    out->num = num_axes;
}

static void add_velocity(const struct view *view, const struct rho_imm_plot *seen, int num_axes,
                         struct innovation *out)
{
    for (int i = 0; i < num_axes; i++) {
        float *row = &out->s[RHO_TRIANGLE(num_axes + i)];
        out->d[num_axes + i] = velocity_of(seen->plot, i) - view->state[NUM_AXES + i];
        for (int j = 0; j < num_axes; j++) {
            row[j] = view->covariance[PLACE(i, 1, j, 0)];
        }
        for (int j = 0; j <= i; j++) {
            row[num_axes + j] = view->covariance[PLACE(i, 1, j, 1)];
        }
        row[num_axes + i] += seen->plot->sigma_mps * seen->plot->sigma_mps;
    }
    out->num = 2 * num_axes;
}

static float rate_noise(const struct rho_imm_plot *seen)
{
    return seen->plot->sigma_range_rate_mps * seen->plot->sigma_range_rate_mps;
}

static float rate_off(const struct view *view, const struct rho_imm_plot *seen)
{
    return rho_measurement_range_rate_error_mps(seen->sensor, seen->plot->range_rate_mps,
                                                view->expected_mps);
}

/* After places and velocities. */
static void add_range_rate(const struct view *view, const struct rho_imm_plot *seen, int num_axes,
                           struct innovation *out)
{
    float *row = &out->s[RHO_TRIANGLE(out->num)];
    memcpy(row, view->projected, (size_t)num_axes * sizeof *row);
    memcpy(row + num_axes, view->projected + NUM_AXES, (size_t)num_axes * sizeof *row);
    row[out->num] = view->rate_variance + rate_noise(seen);
    out->d[out->num++] = rate_off(view, seen);
}

/* A model that is in the sensor's own place expects no range rate, and says nothing. */
static int expects_rate(const struct view *view)
{
    return view->rate_variance >= 0.0f;
}

/* Velocities too: of any number of dimensions. */
static void view_all(struct view *view, const struct rho_imm_plot *seen,
                     const struct rho_imm_match *match)
{
    struct innovation innovation;
    float log_det = 0.0f;
    add_position(view, seen, match->num_axes, &innovation);
    add_velocity(view, seen, match->num_axes, &innovation);
    view->counts = !match->has_range_rate || expects_rate(view);
    if (match->has_range_rate && view->counts) {
        add_range_rate(view, seen, match->num_axes, &innovation);
    }
#if RHO_AMBIGUOUS_RANGE_RATES
    /* which range rate is meant may be unclear: then any is as likely, with the density 1 / span */
    int is_unclear = match->has_range_rate && view->counts &&
                     !rho_measurement_unfold_range_rate(seen->sensor, innovation.num, innovation.s,
                                                        innovation.d);
    innovation.num -= is_unclear;
#endif
    view->counts = view->counts && rho_linalg_match(innovation.num, innovation.s, innovation.d,
                                                    COUNTS_MAX, &view->distance2, &log_det);
    view->root = rho_exp(-0.5f * log_det);
#if RHO_AMBIGUOUS_RANGE_RATES
    if (is_unclear) {
        view->root *= ROOT_TWO_PI / seen->sensor->range_rate_span_mps;
    }
#endif
}

/*
 * A range rate after the places: what these say of it, by their L and D. Returns its squared
 * distance, and in *det its factor of the determinant. Which range rate is meant may be unclear:
 * then any is as likely, with the density 1 / span.
 */
static inline float view_rate(const struct view *view, const struct rho_imm_plot *seen,
                              float expected_off, float explained, float *det)
{
    const float variance = view->rate_variance + rate_noise(seen) - explained;
    float off = seen->plot->range_rate_mps - view->expected_mps;
    *det = variance;
#if RHO_AMBIGUOUS_RANGE_RATES
    if (rho_measurement_has_span(seen->sensor)) {
        const float span_mps = seen->sensor->range_rate_span_mps;
        if (!rho_measurement_is_range_rate_clear(seen->sensor, variance)) {
            *det = variance > 0.0f ? span_mps * span_mps * (1.0f / RHO_TWO_PI) : variance;
            return 0.0f;
        }
        off = expected_off + rho_measurement_range_rate_error_mps(seen->sensor, off, expected_off);
    }
#endif
    off -= expected_off;
    return off * off / variance;
}

/* The same in space. */
static void view_space(struct view *view, const struct rho_imm_plot *seen, int has_rate)
{
    const float *p = view->covariance, *r = seen->covariance, *rate = view->projected;
    const float s00 = p[0] + r[0], s10 = p[1] + r[1], l10 = s10 / s00;
    const float s20 = p[3] + r[3], l20 = s20 / s00;
    const float s11 = p[2] + r[2] - l10 * s10;
    const float c21 = p[4] + r[4] - l20 * s10, l21 = c21 / s11;
    const float s22 = p[5] + r[5] - l20 * s20 - l21 * c21;
    const float d0 = seen->position.place_m[0] - view->state[0];
    const float d1 = seen->position.place_m[1] - view->state[1] - l10 * d0;
    const float d2 = seen->position.place_m[2] - view->state[2] - l20 * d0 - l21 * d1;
    const float to0 = d0 / s00, to1 = d1 / s11, to2 = d2 / s22;
    float distance2 = d0 * to0 + d1 * to1 + d2 * to2, rate_det = 1.0f;
    if (has_rate) {
        const float rate0 = rate[0], rate1 = rate[1] - l10 * rate0;
        const float rate2 = rate[2] - l20 * rate0 - l21 * rate1;
        distance2 +=
            view_rate(view, seen, rate0 * to0 + rate1 * to1 + rate2 * to2,
                      rate0 * rate0 / s00 + rate1 * rate1 / s11 + rate2 * rate2 / s22, &rate_det);
    }
    view->distance2 = distance2;
    view->counts = distance2 <= COUNTS_MAX && s11 > 0.0f && s22 > 0.0f && rate_det > 0.0f &&
                   (!has_rate || expects_rate(view));
    if (view->counts) {
        /* apart: the product of four variances may be no number */
        view->root = rho_inverse_sqrt(s00 * s11 * s22) * rho_inverse_sqrt(rate_det);
    }
}

/* ---- both models ------------------------------------------------------------------------------ */

/*
 * Factors and distances of both models; the nearer one's exponent is taken out of both densities, so that their sum is a
 * number.
 */
static inline void combine(const float factor[2], const float distance2[2], int num_dimensions,
                           struct rho_imm_match *match)
{
    float s = factor[0], m = factor[1];
    if (distance2[0] <= distance2[1]) {
        match->distance2 = distance2[0];
        m *= rho_exp(0.5f * (distance2[0] - distance2[1]));
    } else {
        match->distance2 = distance2[1];
        s *= rho_exp(0.5f * (distance2[1] - distance2[0]));
    }
    match->probability = m / (s + m);
    match->log_likelihood =
        rho_log(s + m) - 0.5f * (match->distance2 + (float)num_dimensions * LOG_TWO_PI);
}

static int is_likelihood(float log_likelihood)
{
    return log_likelihood >= -1e6f && log_likelihood <= 1e6f;
}

/* Neither model is ruled out for good: rounding makes a probability 1, and the next plot may be the other's. */
#define SHARE_MIN 1.0e-9f

static inline float believable(float share)
{
    return share > SHARE_MIN ? share : SHARE_MIN;
}

void rho_imm_judge_scalar(struct rho_imm *imm, const float off[2], const float variance[2],
                          float *gain_nat)
{
    struct rho_imm_match match;
    const float factor[2] = {believable(1.0f - imm->probability) * rho_inverse_sqrt(variance[0]),
                             believable(imm->probability) * rho_inverse_sqrt(variance[1])};
    const float distance2[2] = {off[0] * off[0] / variance[0], off[1] * off[1] / variance[1]};
    combine(factor, distance2, 1, &match);
    imm->probability = match.probability;
    *gain_nat = match.log_likelihood;
}

/* By the shortest way. */
static void look(struct view *view, const struct rho_imm *imm, const struct rho_imm_plot *seen,
                 const struct rho_imm_match *match)
{
    const int is_coupled = imm->is_coupled || !seen->position.is_isotropic;
    if (match->has_velocity && (is_coupled || match->has_range_rate)) {
        view_all(view, seen, match);
    } else if (match->has_velocity) {
        view_places_and_velocities(view, seen, match->num_axes);
    } else if (!is_coupled && !match->has_range_rate) {
        view_places(view, seen, match->num_axes > 2);
    } else {
        view_space(view, seen, match->has_range_rate);
    }
}

static int weigh_models(const float factor[2], const float distance2[2], int num_dimensions,
                        struct rho_imm_match *match)
{
    if (!(distance2[0] <= RHO_IMM_GATE || distance2[1] <= RHO_IMM_GATE)) {
        return 0;
    }
    combine(factor, distance2, num_dimensions, match);
    return is_likelihood(match->log_likelihood);
}

/* What a plot in the plane says to both models alike. */
struct plane_plot {
    float x_m, y_m, xx_m2, xy_m2, yy_m2;
    int has_rate;
};

/*
 * Places in the plane, and a range rate: S = L D L^T by hand. Returns the squared distance, and in
 * *factor what the density is in proportion to, times share; of what does not count, and of no
 * number, a distance beyond all that do and 0.
 */
static inline float view_plane(const struct view *view, const struct plane_plot *plot,
                               const struct rho_imm_plot *seen, float share, float *factor)
{
    const float *p = view->covariance, *rate = view->projected;
    const float s00 = p[0] + plot->xx_m2, s10 = p[1] + plot->xy_m2;
    const float inverse0 = 1.0f / s00, l10 = s10 * inverse0;
    const float s11 = p[2] + plot->yy_m2 - l10 * s10, inverse1 = 1.0f / s11;
    const float d0 = plot->x_m - view->state[0];
    const float d1 = plot->y_m - view->state[1] - l10 * d0;
    const float to0 = d0 * inverse0, to1 = d1 * inverse1;
    float distance2 = d0 * to0 + d1 * to1, det = s00 * s11, rate_det = 1.0f;
    int counts = s11 > 0.0f;
    if (plot->has_rate) {
        const float rate0 = rate[0], rate1 = rate[1] - l10 * rate0;
        distance2 += view_rate(view, seen, rate0 * to0 + rate1 * to1,
                               rate0 * rate0 * inverse0 + rate1 * rate1 * inverse1, &rate_det);
        det *= rate_det;
        counts = counts && rate_det > 0.0f && expects_rate(view);
    }
    if (!(counts && distance2 <= COUNTS_MAX)) {
        *factor = 0.0f;
        return BEYOND_ALL;
    }
    *factor = believable(share) * rho_inverse_sqrt(det);
    return distance2;
}

/* What one model expects; 0: it is in the sensor's own place. */
static int open_rate(const float *state, const float *covariance, const struct rho_sensor *sensor,
                     float *expected_mps, float *variance, float projected[RHO_KALMAN_STATES])
{
    struct rho_kalman_row rate;
    struct rho_kalman at;
    take_leading(&at, state, covariance);
    if (!rho_kalman_see_range_rate(&at, sensor, 0.0f, FLT_MIN, &rate)) {
        return 0;
    }
    *expected_mps = -rate.innovation;
    *variance = rate.variance + rho_linalg_project6(at.covariance, rate.row, projected);
    return 1;
}

static int open_plane_rate(const float *state, const float *covariance,
                           const struct rho_sensor *sensor, float *expected_mps, float *variance,
                           float projected[RHO_KALMAN_STATES])
{
    struct plane_rate rate;
    float spread[RHO_PLANE_MANOEUVRE];
    if (!rho_imm_plane_see_rate(state, covariance, sensor, &rate)) {
        return 0;
    }
    *expected_mps = rate.expected_mps;
    *variance =
        rate.bend + rho_imm_plane_project_rate(RHO_PLANE_STEADY, covariance, rate.row, spread);
    projected[0] = spread[0];
    projected[1] = spread[1];
    projected[2] = 0.0f;
    projected[3] = spread[2];
    projected[4] = spread[3];
    projected[5] = 0.0f;
    return 1;
}

void rho_imm_open_rates(struct rho_imm_rates *rates, const struct rho_imm *imm,
                        const struct rho_sensor *sensor)
{
    const float *states[2] = {imm->steady.state, imm->state};
    const float *covariances[2] = {imm->steady.covariance, imm->covariance};
    const int has_height = is_open(imm, 2);
    for (int i = 0; i < 2; i++) {
        float *expected_mps = &rates->expected_mps[i], *variance = &rates->variance[i];
        float *projected = rates->projected[i];
        if (!(has_height
                  ? open_rate(states[i], covariances[i], sensor, expected_mps, variance, projected)
                  : open_plane_rate(states[i], covariances[i], sensor, expected_mps, variance,
                                    projected))) {
            *expected_mps = 0.0f;
            *variance = -1.0f;
            memset(projected, 0, sizeof rates->projected[i]);
        }
    }
}

int rho_imm_weigh(const struct rho_imm *imm, const struct rho_imm_plot *seen,
                  struct rho_imm_match *match)
{
    struct rho_imm_rates rates = {.expected_mps = {0.0f, 0.0f}};
    if (seen->measures & RHO_MEASURES_RANGE_RATE) {
        rho_imm_open_rates(&rates, imm, seen->sensor);
    }
    return rho_imm_weigh_with(imm, &rates, seen, match);
}

/* Places in the plane, of coupled axes or plots, or with range rates: most radars' plots. */
static int is_of_plane(const struct rho_imm *imm, const struct rho_imm_plot *seen,
                       const struct rho_imm_match *match)
{
    return match->num_axes < 3 && !match->has_velocity &&
           (imm->is_coupled || !seen->position.is_isotropic || match->has_range_rate);
}

static inline void open_view(struct view *view, int model, const struct rho_imm *imm,
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

/* Apart: it runs for each plot in the gate of each hypothesis. */
static int weigh_in_plane(const struct rho_imm *imm, const struct rho_imm_rates *rates,
                          const struct rho_imm_plot *seen, struct rho_imm_match *match)
{
    const struct plane_plot plot = {
        .x_m = seen->position.place_m[0],
        .y_m = seen->position.place_m[1],
        .xx_m2 = seen->covariance[RHO_AT(0, 0)],
        .xy_m2 = seen->covariance[RHO_AT(1, 0)],
        .yy_m2 = seen->covariance[RHO_AT(1, 1)],
        .has_rate = match->has_range_rate,
    };
    const float share[2] = {1.0f - imm->probability, imm->probability};
    float factor[2], distance2[2];
    for (int i = 0; i < 2; i++) {
        struct view view;
        open_view(&view, i, imm, rates, plot.has_rate);
        distance2[i] = view_plane(&view, &plot, seen, share[i], &factor[i]);
    }
    return weigh_models(factor, distance2, 2 + plot.has_rate, match);
}

int rho_imm_weigh_with(const struct rho_imm *imm, const struct rho_imm_rates *rates,
                       const struct rho_imm_plot *seen, struct rho_imm_match *match)
{
    const float share[2] = {1.0f - imm->probability, imm->probability};
    float factor[2], distance2[2];
    match->num_axes = seen->position.has_z && is_open(imm, 2) ? 3 : 2;
    match->has_velocity = (seen->measures & RHO_MEASURES_VELOCITY) != 0;
    match->has_range_rate = (seen->measures & RHO_MEASURES_RANGE_RATE) != 0;
    if (is_of_plane(imm, seen, match)) {
        return weigh_in_plane(imm, rates, seen, match);
    }
    for (int i = 0; i < 2; i++) {
        struct view view;
        open_view(&view, i, imm, rates, match->has_range_rate);
        look(&view, imm, seen, match);
        distance2[i] = view.counts ? view.distance2 : BEYOND_ALL;
        factor[i] = view.counts ? believable(share[i]) * view.root : 0.0f;
    }
    return weigh_models(factor, distance2,
                        (match->has_velocity ? 2 : 1) * match->num_axes + match->has_range_rate,
                        match);
}

/* ---- many plots of one noise -------------------------------------------------------------------- */

static void open_model(struct rho_imm_gate *gate, int model, const float *state,
                       const float *covariance, float variance_m2, float share)
{
    float *centre_m = gate->centre_m[model], *inverse = gate->half_inverse[model];
    const float sx = covariance[RHO_AT(0, 0)] + variance_m2;
    const float sy = covariance[RHO_AT(1, 1)] + variance_m2;
    float det = sx * sy;
    centre_m[0] = state[0];
    centre_m[1] = state[1];
    centre_m[2] = state[2];
    inverse[0] = 0.5f / sx;
    inverse[1] = 0.5f / sy;
    inverse[2] = 0.0f;
    if (gate->num_axes > 2) {
        const float sz = covariance[RHO_AT(2, 2)] + variance_m2;
        inverse[2] = 0.5f / sz;
        det *= sz;
    }
    gate->log_factor[model] =
        rho_log(share * rho_inverse_sqrt(det)) - 0.5f * LOG_TWO_PI * (float)gate->num_axes;
}

int rho_imm_open_gate(struct rho_imm_gate *gate, const struct rho_imm *imm, float variance_m2,
                      int has_z)
{
    if (imm->is_coupled) {
        return 0;
    }
    gate->num_axes = has_z && is_open(imm, 2) ? 3 : 2;
    open_model(gate, 0, imm->steady.state, imm->steady.covariance, variance_m2,
               believable(1.0f - imm->probability));
    open_model(gate, 1, imm->state, imm->covariance, variance_m2, believable(imm->probability));
    return is_likelihood(gate->log_factor[0]) && is_likelihood(gate->log_factor[1]);
}

/* Half of the squared distance. */
static inline float half_in(const float centre_m[3], const float half_inverse[3],
                            const float place_m[3])
{
    const float dx = place_m[0] - centre_m[0], dy = place_m[1] - centre_m[1];
    const float dz = place_m[2] - centre_m[2];
    return dx * dx * half_inverse[0] + dy * dy * half_inverse[1] + dz * dz * half_inverse[2];
}

/* ln of a model's part in a plot's density; of one that does not count, of next to nothing. */
static inline float log_part(float log_factor, float half)
{
    return log_factor - (half <= 0.5f * COUNTS_MAX ? half : 1e6f);
}

/* ln(e^s + e^m) is at most that of the larger one and ln 2, and at least the larger one. */
int rho_imm_weigh_in(const struct rho_imm_gate *gate, const float place_m[3], float enough,
                     float *log_likelihood, float *probability)
{
    const float to_s = half_in(gate->centre_m[0], gate->half_inverse[0], place_m);
    const float to_m = half_in(gate->centre_m[1], gate->half_inverse[1], place_m);
    if (!(to_s <= 0.5f * RHO_IMM_GATE || to_m <= 0.5f * RHO_IMM_GATE)) {
        return 0;
    }
    const float s = log_part(gate->log_factor[0], to_s), m = log_part(gate->log_factor[1], to_m);
    const float most = s > m ? s : m, least = s > m ? m : s;
    if (!(most + LOG_TWO > enough)) {
        return 0;
    }
    const float ratio = rho_exp(least - most), share = 1.0f / (1.0f + ratio);
    *probability = s > m ? ratio * share : share;
    *log_likelihood = most + rho_log_one_plus(ratio);
    return 1;
}
