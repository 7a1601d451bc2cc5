/* SPDX-License-Identifier: MIT */
/*
 * imm_match: how well both models predicted a plot.
 */
#include <string.h>

#include "imm_axes.h"
#include "rhotrack/approx.h"

#define LOG_TWO_PI 1.83787707f

/* A model beyond the gate still counts beside one within it: its density may be the higher one, as it is narrower. */
#define COUNTS_MAX (2.0f * RHO_IMM_GATE)

/* What one model says of a plot. Both models' positions and velocities have the same places. */
struct view {
    const float *state, *covariance;
    float distance2, log_det;
    int counts;
};

/* Isotropic noise has no frame: nothing to find it for. */
static int open_isotropic(struct rho_measurement *out, const struct rho_plot *plot,
                          uint32_t measures)
{
    const int has_z = (measures & RHO_MEASURES_Z) != 0;
    const float sigma_m = plot->sigma_range_m, variance = sigma_m * sigma_m;
    if (plot->sigma_cross_m < sigma_m || plot->sigma_cross_m > sigma_m ||
        (has_z && (plot->sigma_up_m < sigma_m || plot->sigma_up_m > sigma_m))) {
        return 0;
    }
    *out = (struct rho_measurement){.place_m = {plot->x_m, plot->y_m, has_z ? plot->z_m : 0.0f},
                                    .cos_azimuth = 1.0f,
                                    .cos_elevation = 1.0f,
                                    .variance_m2 = {variance, variance, variance},
                                    .has_z = has_z,
                                    .is_isotropic = 1};
    return 1;
}

void rho_imm_open_plot(struct rho_imm_plot *seen, const struct rho_plot *plot, uint32_t measures,
                       const struct rho_sensor *sensor)
{
    seen->measures = measures;
    seen->plot = plot;
    seen->sensor = sensor;
    if (open_isotropic(&seen->position, plot, measures)) {
        return;
    }
    rho_measurement_open(plot, measures, sensor, &seen->position);
    rho_measurement_covariance(&seen->position, seen->covariance);
}

/* ---- independent axes ------------------------------------------------------------------------- */

static float velocity_of(const struct rho_plot *plot, int axis)
{
    return axis == 0 ? plot->vx_mps : axis == 1 ? plot->vy_mps : plot->vz_mps;
}

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
    if (view->counts) {
        view->log_det = rho_log(det);
    }
}

/* Position and velocity of one axis: a distance, and the factor of the determinant. */
static float axis_distance2(const struct view *view, const struct rho_imm_plot *seen, int axis,
                            float *det)
{
    const float *p = view->covariance, noise = seen->plot->sigma_mps * seen->plot->sigma_mps;
    const float s = p[axis_places[axis][0]] + seen->position.variance_m2[0];
    const float factor = p[axis_places[axis][1]] / s;
    const float rest = p[axis_places[axis][2]] + noise - factor * p[axis_places[axis][1]];
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
    if (view->counts) {
        /* apart: the product of six variances may be no number */
        view->log_det = rho_log(det[0] * det[1]) + rho_log(det[2]);
    }
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
    const struct rho_measurement *position = &seen->position;
    for (int i = 0; i < num_axes; i++) {
        out->d[i] = position->place_m[i] - view->state[i];
        for (int j = 0; j <= i; j++) {
            float noise = !position->is_isotropic ? seen->covariance[RHO_AT(i, j)]
                          : i == j                ? position->variance_m2[0]
                                                  : 0.0f;
            out->s[RHO_AT(i, j)] = view->covariance[RHO_AT(i, j)] + noise;
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

/* A range rate touches all states: its row times the covariance, and that times the row. */
static int add_range_rate(const struct view *view, const struct rho_imm_plot *seen, int num_axes,
                          int has_velocity, struct innovation *out)
{
    const struct rho_plot *plot = seen->plot;
    struct rho_kalman at;
    struct rho_kalman_row rate;
    float projected[RHO_KALMAN_STATES], *row = &out->s[RHO_TRIANGLE(out->num)];
    memcpy(at.state, view->state, sizeof at.state);
    memcpy(at.covariance, view->covariance, sizeof at.covariance);
    if (!rho_kalman_see_range_rate(&at, seen->sensor, plot->range_rate_mps,
                                   plot->sigma_range_rate_mps * plot->sigma_range_rate_mps,
                                   &rate)) {
        return 0;
    }
    float variance = rho_linalg_project6(at.covariance, rate.row, projected);
    memcpy(row, projected, (size_t)num_axes * sizeof *row);
    if (has_velocity) {
        memcpy(row + num_axes, projected + NUM_AXES, (size_t)num_axes * sizeof *row);
    }
    row[out->num] = variance + rate.variance;
    out->d[out->num++] = rate.innovation;
    return 1;
}

/* A model that is in the sensor's own place has no range rate, and says nothing. */
static void view_coupled(struct view *view, const struct rho_imm_plot *seen,
                         const struct rho_imm_match *match)
{
    struct innovation innovation;
    add_position(view, seen, match->num_axes, &innovation);
    if (match->has_velocity) {
        add_velocity(view, seen, match->num_axes, &innovation);
    }
    view->counts = !match->has_range_rate ||
                   add_range_rate(view, seen, match->num_axes, match->has_velocity, &innovation);
    view->counts = view->counts && rho_linalg_match(innovation.num, innovation.s, innovation.d,
                                                    COUNTS_MAX, &view->distance2, &view->log_det);
}

/* ---- both models ------------------------------------------------------------------------------ */

/*
 * -2 ln of a model's density but for the constant; the density over both is that of the better one, and the share of the
 * other beside it.
 */
static void combine(const struct view views[2], float probability, int num_dimensions,
                    struct rho_imm_match *match)
{
    const float steady = views[0].distance2 + views[0].log_det;
    const float manoeuvre = views[1].distance2 + views[1].log_det;
    float least = steady, s = 1.0f - probability, m = 0.0f;
    if (!views[0].counts || (views[1].counts && manoeuvre < steady)) {
        least = manoeuvre;
        m = probability;
        s = views[0].counts ? s * rho_exp(0.5f * (manoeuvre - steady)) : 0.0f;
    } else if (views[1].counts) {
        m = probability * rho_exp(0.5f * (steady - manoeuvre));
    }
    match->probability = m / (s + m);
    match->log_likelihood = rho_log(s + m) - 0.5f * (least + (float)num_dimensions * LOG_TWO_PI);
}

static int is_in_gate(const struct view views[2], struct rho_imm_match *match)
{
    match->distance2 = 2.0f * COUNTS_MAX;
    for (int i = 0; i < 2; i++) {
        if (views[i].counts && views[i].distance2 < match->distance2) {
            match->distance2 = views[i].distance2;
        }
    }
    return match->distance2 <= RHO_IMM_GATE;
}

void rho_imm_judge_scalar(struct rho_imm *imm, const float off[2], const float variance[2],
                          float *gain_nat)
{
    struct view views[2] = {{0, 0, 0.0f, 0.0f, 1}, {0, 0, 0.0f, 0.0f, 1}};
    struct rho_imm_match match = {.distance2 = 0.0f};
    for (int i = 0; i < 2; i++) {
        views[i].distance2 = off[i] * off[i] / variance[i];
        views[i].log_det = rho_log(variance[i]);
    }
    combine(views, imm->probability, 1, &match);
    imm->probability = match.probability;
    *gain_nat = match.log_likelihood;
}

int rho_imm_weigh(const struct rho_imm *imm, const struct rho_imm_plot *seen,
                  struct rho_imm_match *match)
{
    struct view views[2] = {{imm->steady.state, imm->steady.covariance, 0.0f, 0.0f, 0},
                            {imm->state, imm->covariance, 0.0f, 0.0f, 0}};
    match->num_axes = seen->position.has_z && is_open(imm, 2) ? 3 : 2;
    match->has_velocity = (seen->measures & RHO_MEASURES_VELOCITY) != 0;
    match->has_range_rate = (seen->measures & RHO_MEASURES_RANGE_RATE) != 0;
    const int num_dimensions =
        (match->has_velocity ? 2 : 1) * match->num_axes + match->has_range_rate;
    for (int i = 0; i < 2; i++) {
        if (imm->is_coupled || !seen->position.is_isotropic || match->has_range_rate) {
            view_coupled(&views[i], seen, match);
        } else if (match->has_velocity) {
            view_places_and_velocities(&views[i], seen, match->num_axes);
        } else {
            view_places(&views[i], seen, match->num_axes > 2);
        }
    }
    if (!is_in_gate(views, match)) {
        return 0;
    }
    combine(views, imm->probability, num_dimensions, match);
    return match->log_likelihood >= -1e6f && match->log_likelihood <= 1e6f;
}
