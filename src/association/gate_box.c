/* SPDX-License-Identifier: MIT */
/* gate_box: the box that holds the gates of all hypotheses of a track (hypotheses.h). */
#include "hypotheses_pool.h"
#include "rhotrack/detail/approx.h"

struct element_span {
    float min, max, variance_max;
};

/* Extends the range of values by one value; the span's variance is the largest of all. */
static inline void extend_span(struct element_span *span, float value, float variance)
{
    span->min = value < span->min ? value : span->min;
    span->max = value > span->max ? value : span->max;
    span->variance_max = variance > span->variance_max ? variance : span->variance_max;
}

/* Range and largest variance of an element of the state, over a slot's hypotheses and models. */
static struct element_span span_of_element(const struct rho_hypotheses *pool, uint16_t slot,
                                           int element)
{
    const int variance = RHO_AT(element, element);
    struct element_span span = {1e30f, -1e30f, 0.0f};
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_imm *imm = &pool->nodes[pool->node_of[slot][i]].imm;
        extend_span(&span, imm->state[element], imm->covariance[variance]);
        if (element < RHO_KALMAN_STATES) {
            extend_span(&span, imm->steady.state[element], imm->steady.covariance[variance]);
        }
    }
    return span;
}

/* Largest distance of a plot in the gate from an estimate with the span's largest variance. */
static float gate_half_width(const struct element_span *span)
{
    return RHO_IMM_GATE_SIGMAS * rho_sqrt(span->variance_max);
}

/* Largest magnitude of three elements of the state, from `first` on, with its uncertainty. */
static float largest_magnitude(const struct rho_hypotheses *pool, uint16_t slot, int first)
{
    float most = 0.0f;
    for (int axis = 0; axis < 3; axis++) {
        const struct element_span span = span_of_element(pool, slot, first + axis);
        const float one = (span.max > -span.min ? span.max : -span.min) + gate_half_width(&span);
        most = one > most ? one : most;
    }
    return most;
}

void rho_hypotheses_gate_box(struct rho_hypotheses *pool, uint16_t slot,
                             struct rho_hypotheses_box *box)
{
    if (!rho_hypotheses_is_open(pool, slot)) {
        return;
    }
    int have_height = 1;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        struct rho_hypothesis *at = &pool->nodes[pool->node_of[slot][i]];
        at->num_candidates = 0;
        have_height &= at->imm.covariance[RHO_AT(2, 2)] > 0.0f;
    }
    /* gates are of no slot: the estimates have moved since */
    pool->gate_slot = RHO_HYPOTHESES_SLOTS;
    if (!box) {
        return;
    }
    const struct element_span x = span_of_element(pool, slot, 0),
                              y = span_of_element(pool, slot, 1);
    const float x_m = gate_half_width(&x), y_m = gate_half_width(&y);
    /* no limits of z: a hypothesis without a height ignores the height of a plot */
    struct element_span z = {0.0f, 0.0f, 0.0f};
    float z_m = 1e30f;
    if (have_height) {
        z = span_of_element(pool, slot, 2);
        z_m = gate_half_width(&z);
    }
    *box = (struct rho_hypotheses_box){
        .x_min_m = x.min - x_m,
        .x_max_m = x.max + x_m,
        .y_min_m = y.min - y_m,
        .y_max_m = y.max + y_m,
        .z_min_m = z.min - z_m,
        .z_max_m = z.max + z_m,
        .speed_max_mps = -1.0f,
        .accel_max_mps2 = -1.0f,
        .sigma_factor = 1.0f,
    };
}

float rho_hypotheses_box_margin_m(const struct rho_hypotheses *pool, uint16_t slot,
                                  struct rho_hypotheses_box *box, float sigma_max_m,
                                  float offset_max_s)
{
    const float slack_m = RHO_IMM_GATE_SIGMAS * sigma_max_m, t_s = offset_max_s;
    if (!(t_s > 0.0f)) {
        return slack_m;
    }
    /* a target moves by its speed and acceleration, and by process noise */
    const struct rho_imm_model *model = &pool->model;
    const float noise_m2 =
        t_s * t_s * t_s *
        (model->quiet_density * (1.0f / 3.0f) + model->drive_density * t_s * t_s * (1.0f / 20.0f));
    if (box->speed_max_mps < 0.0f) {
        box->speed_max_mps = largest_magnitude(pool, slot, RHO_KALMAN_STATES - 3);
        box->accel_max_mps2 = largest_magnitude(pool, slot, RHO_KALMAN_STATES);
    }
    return slack_m + (t_s * (box->speed_max_mps + 0.5f * t_s * box->accel_max_mps2) +
                      RHO_IMM_GATE_SIGMAS * rho_sqrt(noise_m2));
}

int rho_hypotheses_is_in_box(const struct rho_hypotheses *pool, uint16_t slot,
                             struct rho_hypotheses_box *box, const struct rho_plot *plot,
                             uint32_t measures)
{
    float sigma_m = rho_plot_sigma_m(plot);
    if ((measures & RHO_MEASURES_Z) && plot->sigma_up_m > sigma_m) {
        sigma_m = plot->sigma_up_m; /* at high elevation the noise across is partly horizontal */
    }
    sigma_m *= box->sigma_factor;
    float slack_m = RHO_IMM_GATE_SIGMAS * sigma_m; /* the margin of a plot without an own time */
    if (plot->offset_us != 0) {
        slack_m = rho_hypotheses_box_margin_m(pool, slot, box, sigma_m,
                                              (float)plot->offset_us *
                                                  (plot->offset_us < 0 ? -1e-6f : 1e-6f));
    }
    return plot->x_m >= box->x_min_m - slack_m && plot->x_m <= box->x_max_m + slack_m &&
           plot->y_m >= box->y_min_m - slack_m && plot->y_m <= box->y_max_m + slack_m &&
           (!(measures & RHO_MEASURES_Z) ||
            (plot->z_m >= box->z_min_m - slack_m && plot->z_m <= box->z_max_m + slack_m));
}
