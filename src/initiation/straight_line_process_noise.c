/* SPDX-License-Identifier: MIT */
/*
 * straight_line_process_noise: variances by which accelerations that change from scan to scan move
 * a target off a straight line.
 */
#include "rhotrack/detail/linalg.h"
#include "search.h"

/* Displacement at scan m, for an acceleration of 1 m/s^2 from scan l to scan l + 1. */
static float displacement_per_acceleration_s2(const struct search *search, unsigned l, unsigned m)
{
    if (m <= l) {
        return 0.0f;
    }
    float interval_s = search->time_s[l + 1] - search->time_s[l];
    return interval_s * (0.5f * interval_s + search->time_s[m] - search->time_s[l + 1]);
}

/*
 * Variances by which process noise bends a track off its own fit over the scans from `first` on:
 * the diagonal of H K H, K the covariance of process noise, H the projection off straight lines.
 * Returns the largest; *sum_m2: their sum.
 */
float rho_initiator_largest_bend_variance_m2(const struct search *search, unsigned first,
                                             float *sum_m2)
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

void rho_initiator_set_process_noise(struct search *search)
{
    float variance = search->initiator->config.process_noise_mps2;
    variance *= variance;
    for (unsigned i = 0; i < search->num_scans; i++) {
        for (unsigned j = 0; j <= i; j++) {
            float sum = 0.0f;
            for (unsigned l = 0; l < j; l++) {
                sum += displacement_per_acceleration_s2(search, l, i) *
                       displacement_per_acceleration_s2(search, l, j);
            }
            search->process_m2[RHO_AT(i, j)] = variance * sum;
        }
    }
    search->fit_process_m2 =
        variance > 0.0f ? rho_initiator_largest_bend_variance_m2(search, 0, &(float){0.0f}) : 0.0f;
}

float rho_initiator_process_variance_off_line_m2(const struct search *search, unsigned a,
                                                 unsigned m, unsigned b)
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
