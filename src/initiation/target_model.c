/* SPDX-License-Identifier: MIT */
/*
 * target_model: detection probabilities, the density of births over area and velocity, and the
 * variances by which accelerations that change from scan to scan move a target off a straight line.
 */
#include "target_model.h"

#include "clutter_density.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"

/* Displacement at scan m, for an acceleration of 1 m/s^2 from scan l to scan l + 1. */
static float displacement_s2(const struct search *search, unsigned l, unsigned m)
{
    if (m <= l) {
        return 0.0f;
    }
    float interval_s = search->time_s[l + 1] - search->time_s[l];
    return interval_s * (0.5f * interval_s + search->time_s[m] - search->time_s[l + 1]);
}

/* The diagonal of H K H, K the covariance of process noise, H the projection off lines. */
float rho_target_bend_m2(const struct search *search, unsigned first, float *sum_m2)
{
    unsigned end = search->num_scans;
    float n = (float)(end - first), mean_s = 0.0f, spread_s2 = 0.0f, largest_m2 = 0.0f;
    float project[RHO_MAX_SCANS];
    *sum_m2 = 0.0f;
    for (unsigned m = first; m < end; m++) {
        mean_s += search->time_s[m] / n;
    }
    for (unsigned m = first; m < end; m++) {
        spread_s2 += (search->time_s[m] - mean_s) * (search->time_s[m] - mean_s);
    }
    for (unsigned r = first; r < end && spread_s2 > 0.0f; r++) {
        float bend = 0.0f;
        for (unsigned m = first; m < end; m++) {
            float lever = (search->time_s[r] - mean_s) * (search->time_s[m] - mean_s) / spread_s2;
            project[m] = (r == m ? 1.0f : 0.0f) - 1.0f / n - lever;
        }
        for (unsigned i = first; i < end; i++) {
            for (unsigned j = first; j < end; j++) {
                bend += project[i] * search->process_m2[RHO_AT(i, j)] * project[j];
            }
        }
        *sum_m2 += bend;
        largest_m2 = bend > largest_m2 ? bend : largest_m2;
    }
    return largest_m2;
}

float rho_target_off_line_m2(const struct search *search, unsigned a, unsigned m, unsigned b)
{
    float al = (search->time_s[m] - search->time_s[a]) / (search->time_s[b] - search->time_s[a]);
    const unsigned scan[3] = {a, m, b};
    const float weight[3] = {al - 1.0f, 1.0f, -al};
    float sum = 0.0f;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            sum += weight[i] * weight[j] * search->process_m2[RHO_AT(scan[i], scan[j])];
        }
    }
    return sum > 0.0f ? sum : 0.0f;
}

void rho_target_model_set(struct search *search)
{
    const struct rho_initiator_config *config = &search->initiator->config;
    float variance = config->process_noise_mps2;
    variance *= variance;
    for (unsigned i = 0; i < search->num_scans; i++) {
        for (unsigned j = 0; j <= i; j++) {
            float sum = 0.0f;
            for (unsigned l = 0; l < j; l++) {
                sum += displacement_s2(search, l, i) * displacement_s2(search, l, j);
            }
            search->process_m2[RHO_AT(i, j)] = variance * sum;
        }
    }
    search->fit_process_m2 = variance > 0.0f ? rho_target_bend_m2(search, 0, &(float){0.0f}) : 0.0f;
    for (unsigned m = 0; m < search->num_scans; m++) {
        float sensor_pd = rho_search_scan(search, m)->sensor.pd;
        float pd = sensor_pd > 0.0f ? sensor_pd : config->pd;
        search->log_pd[m] = rho_log(pd);
        search->log_miss[m] = rho_log(1.0f - pd);
    }
    /*
     * births are uniform over the area and over the ring of allowed velocities; half a target is
     * expected in area and window, so that one target and none are equally likely
     */
    search->log_prior =
        LOG_HALF - rho_log(rho_density_area_m2(search->initiator)) - LOG_PI -
        rho_log(config->v_max_mps * config->v_max_mps - config->v_min_mps * config->v_min_mps);
}

float rho_target_log_volume(const struct search *search, int has_z, unsigned heights,
                            unsigned range_rates)
{
    float v_max_mps = search->initiator->config.v_max_mps;
    float room = (float)range_rates * rho_log(2.0f * v_max_mps);
    if (has_z) {
        room += ((float)heights - 1.0f) * rho_log(RHO_CLUTTER_HEIGHT_M) -
                rho_log(2.0f * CLIMB_SHARE * v_max_mps);
    }
    return room;
}

void rho_target_assume_turns(struct search *search, int turns)
{
    search->turn_mps2 = turns ? search->initiator->config.turn_mps2 : 0.0f;
    search->log_turn = turns ? search->log_turning : 0.0f;
    search->is_isotropic = search->has_one_noise && !turns;
}

float rho_chi2_quantile(unsigned dimensions, float sigmas)
{
    float f = 2.0f / (9.0f * (float)dimensions);
    float root = 1.0f - f + sigmas * rho_sqrt(f);
    return (float)dimensions * root * root * root;
}

float rho_log_factorial(unsigned n)
{
    float sum = 0.0f;
    for (unsigned i = 2; i <= n; i++) {
        sum += rho_log((float)i);
    }
    return sum;
}
