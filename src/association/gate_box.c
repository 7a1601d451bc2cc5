/* SPDX-License-Identifier: MIT */
/*
 * gate_box: the box that holds the gates of all hypotheses of a slot, as a scan begins.
 */
#include "hypotheses_pool.h"
#include "rhotrack/detail/approx.h"

/* Square root of the gate: how far, in standard deviations, a plot may be. */
#define GATE_SIGMAS 5.4772256f

struct span {
    float min, max, variance_max;
};

static inline void include_in_span(struct span *span, float value, float variance)
{
    span->min = value < span->min ? value : span->min;
    span->max = value > span->max ? value : span->max;
    span->variance_max = variance > span->variance_max ? variance : span->variance_max;
}

/* One element of all hypotheses' states, of both models. */
static struct span span_of_element(const struct rho_hypotheses *pool, uint16_t slot, int element)
{
    const int variance = RHO_AT(element, element);
    struct span span = {1e30f, -1e30f, 0.0f};
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_imm *imm = &pool->nodes[pool->node_of[slot][i]].imm;
        include_in_span(&span, imm->state[element], imm->covariance[variance]);
        if (element < RHO_KALMAN_STATES) {
            include_in_span(&span, imm->steady.state[element], imm->steady.covariance[variance]);
        }
    }
    return span;
}

static float gate_reach(const struct span *span)
{
    return GATE_SIGMAS * rho_sqrt(span->variance_max);
}

/* The largest of three elements from `first` on, without sign, with its uncertainty. */
static float largest_magnitude(const struct rho_hypotheses *pool, uint16_t slot, int first)
{
    float most = 0.0f;
    for (int axis = 0; axis < 3; axis++) {
        const struct span span = span_of_element(pool, slot, first + axis);
        const float one = (span.max > -span.min ? span.max : -span.min) + gate_reach(&span);
        most = one > most ? one : most;
    }
    return most;
}

static int have_heights(const struct rho_hypotheses *pool, uint16_t slot)
{
    int have = 1;
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        have &= pool->nodes[pool->node_of[slot][i]].imm.covariance[RHO_AT(2, 2)] > 0.0f;
    }
    return have;
}

static void fill_box(const struct rho_hypotheses *pool, uint16_t slot,
                     struct rho_hypotheses_box *box)
{
    const struct span x = span_of_element(pool, slot, 0), y = span_of_element(pool, slot, 1);
    const float x_m = gate_reach(&x), y_m = gate_reach(&y);
    /* a hypothesis without a height ignores that of a plot */
    struct span z = {0.0f, 0.0f, 0.0f};
    float z_m = 1e30f;
    if (have_heights(pool, slot)) {
        z = span_of_element(pool, slot, 2);
        z_m = gate_reach(&z);
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

void rho_hypotheses_begin_scan(struct rho_hypotheses *pool, uint16_t slot,
                               struct rho_hypotheses_box *box)
{
    if (!pool || !rho_hypotheses_is_open(pool, slot)) {
        return;
    }
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        pool->nodes[pool->node_of[slot][i]].num_candidates = 0;
    }
    pool->gate_slot = RHO_HYPOTHESES_SLOTS; /* of no slot: estimates have moved since */
    if (box) {
        fill_box(pool, slot, box);
    }
}

/* How far a target may move until a plot's own time, by its speed and acceleration and by noise. */
static float drift_m(const struct rho_hypotheses *pool, uint16_t slot,
                     struct rho_hypotheses_box *box, float t_s)
{
    const struct rho_imm_model *model = &pool->model;
    const float noise_m2 =
        t_s * t_s * t_s *
        (model->quiet_density * (1.0f / 3.0f) + model->drive_density * t_s * t_s * (1.0f / 20.0f));
    if (box->speed_max_mps < 0.0f) {
        box->speed_max_mps = largest_magnitude(pool, slot, RHO_KALMAN_STATES - 3);
        box->accel_max_mps2 = largest_magnitude(pool, slot, RHO_KALMAN_STATES);
    }
    return t_s * (box->speed_max_mps + 0.5f * t_s * box->accel_max_mps2) +
           GATE_SIGMAS * rho_sqrt(noise_m2);
}

float rho_hypotheses_box_margin_m(const struct rho_hypotheses *pool, uint16_t slot,
                                  struct rho_hypotheses_box *box, float sigma_m, float offset_s)
{
    const float slack_m = GATE_SIGMAS * sigma_m;
    return offset_s > 0.0f ? slack_m + drift_m(pool, slot, box, offset_s) : slack_m;
}

int rho_hypotheses_is_in_box(const struct rho_hypotheses *pool, uint16_t slot,
                             struct rho_hypotheses_box *box, const struct rho_plot *plot,
                             uint32_t measures)
{
    float sigma_m = rho_plot_sigma_m(plot);
    if ((measures & RHO_MEASURES_Z) && plot->sigma_up_m > sigma_m) {
        sigma_m = plot->sigma_up_m; /* a high line of sight brings it down */
    }
    const float slack_m = rho_hypotheses_box_margin_m(pool, slot, box, sigma_m * box->sigma_factor,
                                                      (float)plot->offset_us *
                                                          (plot->offset_us < 0 ? -1e-6f : 1e-6f));
    return plot->x_m >= box->x_min_m - slack_m && plot->x_m <= box->x_max_m + slack_m &&
           plot->y_m >= box->y_min_m - slack_m && plot->y_m <= box->y_max_m + slack_m &&
           (!(measures & RHO_MEASURES_Z) ||
            (plot->z_m >= box->z_min_m - slack_m && plot->z_m <= box->z_max_m + slack_m));
}
