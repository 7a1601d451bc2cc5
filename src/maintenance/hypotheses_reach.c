/* SPDX-License-Identifier: MIT */
/*
 * hypotheses_reach: a scan begins: the box that holds the gates of all hypotheses of a slot.
 */
#include "hypotheses_pool.h"
#include "rhotrack/approx.h"

/* Square root of the gate: how far, in standard deviations, a plot may be. */
#define GATE_SIGMAS 5.4772256f

struct span {
    float min, max, variance_max;
};

static void widen(struct span *span, float value, float variance)
{
    span->min = value < span->min ? value : span->min;
    span->max = value > span->max ? value : span->max;
    span->variance_max = variance > span->variance_max ? variance : span->variance_max;
}

/* Places, speeds and, of the manoeuvring model, accelerations: what the triangle's diagonal holds. */
static void widen_all(struct span spans[RHO_IMM_STATES], const float *state,
                      const float *covariance, int num)
{
    for (int i = 0; i < num; i++) {
        widen(&spans[i], state[i], *covariance);
        covariance += i + 2;
    }
}

static float far_of(const struct span *span)
{
    return GATE_SIGMAS * rho_sqrt(span->variance_max);
}

/* Either way on any axis, with its uncertainty. */
static float most_of(const struct span spans[3])
{
    float most = 0.0f;
    for (int axis = 0; axis < 3; axis++) {
        const struct span *span = &spans[axis];
        float one = (span->max > -span->min ? span->max : -span->min) + far_of(span);
        most = one > most ? one : most;
    }
    return most;
}

static void fill_reach(const struct rho_hypotheses *pool, uint16_t slot,
                       struct rho_hypotheses_reach *reach)
{
    struct span spans[RHO_IMM_STATES];
    int have_heights = 1;
    for (int i = 0; i < RHO_IMM_STATES; i++) {
        spans[i] = (struct span){1e30f, -1e30f, 0.0f};
    }
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        const struct rho_imm *imm = &pool->nodes[pool->node_of[slot][i]].imm;
        widen_all(spans, imm->steady.state, imm->steady.covariance, RHO_KALMAN_STATES);
        widen_all(spans, imm->state, imm->covariance, RHO_IMM_STATES);
        have_heights &= imm->covariance[RHO_AT(2, 2)] > 0.0f;
    }
    /* a hypothesis without a height does not mind that of a plot */
    const float x_m = far_of(&spans[0]), y_m = far_of(&spans[1]);
    const float z_m = have_heights ? far_of(&spans[2]) : 1e30f;
    *reach = (struct rho_hypotheses_reach){
        .x_min_m = spans[0].min - x_m,
        .x_max_m = spans[0].max + x_m,
        .y_min_m = spans[1].min - y_m,
        .y_max_m = spans[1].max + y_m,
        .z_min_m = spans[2].min - z_m,
        .z_max_m = spans[2].max + z_m,
        .speed_max_mps = most_of(&spans[3]),
        .accel_max_mps2 = most_of(&spans[6]),
        .quiet_density = pool->model.quiet_density,
        .drive_density = pool->model.drive_density,
    };
}

void rho_hypotheses_look(struct rho_hypotheses *pool, uint16_t slot,
                         struct rho_hypotheses_reach *reach)
{
    if (!pool || !rho_hypotheses_is_open(pool, slot)) {
        return;
    }
    for (unsigned i = 0; i < pool->num_of[slot]; i++) {
        pool->nodes[pool->node_of[slot][i]].num_candidates = 0;
    }
    pool->gate_slot = RHO_HYPOTHESES_SLOTS; /* nobody's: estimates have moved since */
    if (reach) {
        fill_reach(pool, slot, reach);
    }
}

/* How far a target may come until a plot's own time, by what it does now and by noise. */
static float drift_m(const struct rho_hypotheses_reach *reach, int32_t offset_us)
{
    if (offset_us == 0) {
        return 0.0f;
    }
    const float t_s = (float)offset_us * (offset_us < 0 ? -1e-6f : 1e-6f);
    const float noise_m2 =
        t_s * t_s * t_s *
        (reach->quiet_density * (1.0f / 3.0f) + reach->drive_density * t_s * t_s * (1.0f / 20.0f));
    return t_s * (reach->speed_max_mps + 0.5f * t_s * reach->accel_max_mps2) +
           GATE_SIGMAS * rho_sqrt(noise_m2);
}

int rho_hypotheses_reaches(const struct rho_hypotheses_reach *reach, const struct rho_plot *plot,
                           uint32_t measures)
{
    float sigma_m = rho_plot_sigma_m(plot);
    if ((measures & RHO_MEASURES_Z) && plot->sigma_up_m > sigma_m) {
        sigma_m = plot->sigma_up_m; /* a high line of sight brings it down */
    }
    float slack_m = GATE_SIGMAS * sigma_m + drift_m(reach, plot->offset_us);
    return plot->x_m >= reach->x_min_m - slack_m && plot->x_m <= reach->x_max_m + slack_m &&
           plot->y_m >= reach->y_min_m - slack_m && plot->y_m <= reach->y_max_m + slack_m &&
           (!(measures & RHO_MEASURES_Z) ||
            (plot->z_m >= reach->z_min_m - slack_m && plot->z_m <= reach->z_max_m + slack_m));
}
