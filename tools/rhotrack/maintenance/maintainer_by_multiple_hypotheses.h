/* SPDX-License-Identifier: MIT */
/*
 * maintainer_by_multiple_hypotheses: the maintainer's gate best: multiple hypotheses, each with two
 * motion models.
 */
#ifndef RHOTRACK_TOOL_MAINTAINER_BY_MULTIPLE_HYPOTHESES_H
#define RHOTRACK_TOOL_MAINTAINER_BY_MULTIPLE_HYPOTHESES_H

#include "maintenance/maintainer_of_one_track.h"

struct maintainer_hypotheses;

/*
 * Each function does what its namesake of maintainer_of_one_track.h does for the gate best. The
 * start takes an estimate (kalman) at time_us, and log_density is never NAN.
 */
struct maintainer_hypotheses *maintainer_hypotheses_new(const struct parameters *parameters);
struct maintainer_hypotheses *
maintainer_hypotheses_new_sharing_pool(const struct maintainer_hypotheses *first);
void maintainer_hypotheses_free(struct maintainer_hypotheses *best);
size_t maintainer_hypotheses_state_bytes(void);
void maintainer_hypotheses_start(struct maintainer_hypotheses *best, int64_t time_us,
                                 int64_t scan_us, const struct rho_kalman *kalman,
                                 const struct rho_sensor *sensor);
/*
 * Returns false where the gap is too long to predict: the hypotheses are dropped, and the last
 * estimate stays until the next start.
 */
bool maintainer_hypotheses_predict(struct maintainer_hypotheses *best, int64_t time_us);
void maintainer_hypotheses_predicted_place(const struct maintainer_hypotheses *best,
                                           double place_m[3]);
int maintainer_hypotheses_update(struct maintainer_hypotheses *best, const struct rho_scan *scan,
                                 const struct rho_sensor *sensor, double log_density, double pd);
void maintainer_hypotheses_mean_estimate(const struct maintainer_hypotheses *best,
                                         struct maintainer_estimate *estimate);
double maintainer_hypotheses_nis_of_mean_per_dimension(const struct maintainer_hypotheses *best,
                                                       const struct rho_plot *plot,
                                                       uint32_t measures);
unsigned long maintainer_hypotheses_num_updates_refused(const struct maintainer_hypotheses *best);

#endif
