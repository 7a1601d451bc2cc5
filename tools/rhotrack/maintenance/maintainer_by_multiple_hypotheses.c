/* SPDX-License-Identifier: MIT */
#include "maintenance/maintainer_by_multiple_hypotheses.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "maintenance/plot_distance.h"
#include "pipeline/pipeline.h"
#include "rhotrack/detail/hypotheses.h"

#define NO_SLOT RHO_HYPOTHESES_SLOTS

struct maintainer_hypotheses {
    /* the track's slot in the pool; NO_SLOT: no hypotheses are left */
    uint16_t slot;
    int64_t time_us;                    /* time of the last scan or prediction, or of the start */
    struct rho_hypotheses_estimate now; /* estimate after the last prediction or update */
    bool has_sensor;
    struct rho_sensor sensor;
    unsigned long refused;
    bool is_first; /* this maintainer allocated the pool, and frees it */
    struct rho_hypotheses *pool;
};

struct maintainer_hypotheses *maintainer_hypotheses_new(const struct parameters *parameters)
{
    struct maintainer_hypotheses *best = must_calloc(1, sizeof *best);
    struct rho_imm_model model;

    rho_imm_model_default(&model, (float)parameters->value[PARAMETER_ACCEL_MAX_MPS2],
                          (float)parameters->value[PARAMETER_V_MAX_MPS]);
    best->is_first = true;
    best->slot = NO_SLOT;
    best->pool = must_alloc(sizeof *best->pool);
    must_succeed(rho_hypotheses_init(best->pool, sizeof *best->pool, &model), "hypotheses");
    return best;
}

struct maintainer_hypotheses *
maintainer_hypotheses_new_sharing_pool(const struct maintainer_hypotheses *first)
{
    struct maintainer_hypotheses *best = must_calloc(1, sizeof *best);

    best->pool = first->pool;
    best->slot = NO_SLOT;
    return best;
}

void maintainer_hypotheses_free(struct maintainer_hypotheses *best)
{
    if (best && best->is_first) {
        free(best->pool);
    }
    free(best);
}

size_t maintainer_hypotheses_state_bytes(void)
{
    return RHO_HYPOTHESES_OF_TRACK * sizeof(struct rho_hypothesis);
}

static void refresh_estimate(struct maintainer_hypotheses *best)
{
    must_succeed(rho_hypotheses_estimate(best->pool, best->slot, best->time_us, &best->now),
                 "estimate");
}

void maintainer_hypotheses_start(struct maintainer_hypotheses *best, int64_t time_us,
                                 int64_t scan_us, const struct rho_kalman *kalman,
                                 const struct rho_sensor *sensor)
{
    best->has_sensor = sensor;
    if (sensor) {
        best->sensor = *sensor;
    }
    rho_hypotheses_close(best->pool, best->slot); /* a restarted track has a slot */
    must_succeed(rho_hypotheses_open(best->pool, kalman, time_us, &best->slot), "start");
    best->time_us = scan_us;
    refresh_estimate(best);
}

bool maintainer_hypotheses_predict(struct maintainer_hypotheses *best, int64_t time_us)
{
    if (rho_hypotheses_predict(best->pool, best->slot, time_us) != RHO_OK) {
        rho_hypotheses_close(best->pool, best->slot);
        best->slot = NO_SLOT; /* the freed slot may be given to another track */
        return false;
    }
    best->time_us = time_us;
    refresh_estimate(best);
    return true;
}

void maintainer_hypotheses_predicted_place(const struct maintainer_hypotheses *best,
                                           double place_m[3])
{
    const struct rho_hypothesis *heaviest = rho_hypotheses_at(best->pool, best->slot, 0);
    struct rho_kalman kalman = best->now.kalman; /* used where no hypothesis is left */

    if (heaviest) {
        rho_imm_estimate(&heaviest->imm, &kalman, NULL);
    }
    for (int i = 0; i < 3; i++) {
        place_m[i] = (double)kalman.state[i];
    }
}

static void score_reachable_plots_of_scan(struct maintainer_hypotheses *best,
                                          const struct rho_scan *scan,
                                          const struct rho_sensor *sensor, double log_density,
                                          double pd)
{
    /*
     * the log density covers all measured quantities, so that it stands in for the density per m^2
     */
    struct rho_hypotheses_clutter clutter = {.log_per_m2 = (float)log_density};
    struct rho_hypotheses_box reach;
    float log_pd = (float)log(pd), gain_nat;

    rho_hypotheses_clear_candidates_get_gate_box(best->pool, best->slot, &reach);
    for (uint32_t i = 0; i < scan->num_plots && i <= MAINTAINER_ROW_MAX; i++) {
        const struct rho_plot *plot = &scan->plots[i];
        struct rho_imm_plot seen;

        if (rho_measurement_is_valid_plot(plot, scan->measures) &&
            rho_hypotheses_is_in_box(best->pool, best->slot, &reach, plot, scan->measures)) {
            rho_imm_prepare_plot(&seen, plot, scan->measures, sensor);
            (void)rho_hypotheses_score_plot(best->pool, best->slot, &seen,
                                            scan->time_us + plot->offset_us, (int16_t)i, log_pd,
                                            &clutter, &gain_nat);
        }
    }
}

int maintainer_hypotheses_update(struct maintainer_hypotheses *best, const struct rho_scan *scan,
                                 const struct rho_sensor *sensor, double log_density, double pd)
{
    struct rho_hypotheses_scan seen = {.time_us = scan->time_us,
                                       .measures = scan->measures,
                                       .plots = scan->plots,
                                       .sensor = sensor,
                                       .log_miss = (float)log1p(-pd)};
    struct rho_hypotheses_outcome outcome;
    uint32_t before;

    best->has_sensor = sensor;
    if (sensor) {
        best->sensor = *sensor;
    }
    score_reachable_plots_of_scan(best, scan, sensor, log_density, pd);
    before = best->pool->updates_refused;
    must_succeed(rho_hypotheses_commit(best->pool, best->slot, &seen, &outcome), "commit");
    best->refused += best->pool->updates_refused - before;
    refresh_estimate(best);
    return outcome.row;
}

void maintainer_hypotheses_mean_estimate(const struct maintainer_hypotheses *best,
                                         struct maintainer_estimate *estimate)
{
    *estimate = (struct maintainer_estimate){
        .kalman = best->now.kalman,
        .maneuver_probability = best->now.maneuver_probability,
        .num_hypotheses = rho_hypotheses_count(best->pool, best->slot),
    };
    for (int i = 0; i < 3; i++) {
        estimate->accel_mps2[i] = best->now.accel_mps2[i];
    }
}

double maintainer_hypotheses_nis_of_mean_per_dimension(const struct maintainer_hypotheses *best,
                                                       const struct rho_plot *plot,
                                                       uint32_t measures)
{
    int dimensions = 1;
    double distance2 = plot_squared_mahalanobis(
        &best->now.kalman, plot, measures, best->has_sensor ? &best->sensor : NULL, &dimensions);

    return distance2 / dimensions;
}

unsigned long maintainer_hypotheses_num_updates_refused(const struct maintainer_hypotheses *best)
{
    return best->refused;
}
