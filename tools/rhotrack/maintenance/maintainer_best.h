/* SPDX-License-Identifier: MIT */
/*
 * maintainer_best: the library's default as a maintainer steps it: a track's hypotheses over two
 * motions.
 */
#ifndef RHOTRACK_TOOL_MAINTAINER_BEST_H
#define RHOTRACK_TOOL_MAINTAINER_BEST_H

#include "maintenance/maintainer.h"

struct maintainer_best;

/*
 * Each as the call of maintainer.h that is named alike; it starts from an estimate of time_us,
 * log_density is a number.
 */
struct maintainer_best *maintainer_best_new(const struct parameters *parameters);
struct maintainer_best *maintainer_best_new_beside(const struct maintainer_best *first);
void maintainer_best_free(struct maintainer_best *best);
size_t maintainer_best_bytes(void);
void maintainer_best_start(struct maintainer_best *best, int64_t time_us, int64_t scan_us,
                           const struct rho_kalman *kalman, const struct rho_sensor *sensor);
/*
 * False where nothing sensible could be said any more: nothing is left but the last estimate, until
 * a start.
 */
bool maintainer_best_predict(struct maintainer_best *best, int64_t time_us);
void maintainer_best_predicted_place(const struct maintainer_best *best, double place_m[3]);
int maintainer_best_update(struct maintainer_best *best, const struct rho_scan *scan,
                           const struct rho_sensor *sensor, double log_density, double pd);
void maintainer_best_estimate(const struct maintainer_best *best,
                              struct maintainer_estimate *estimate);
double maintainer_best_nis(const struct maintainer_best *best, const struct rho_plot *plot,
                           uint32_t measures);
unsigned long maintainer_best_num_refused(const struct maintainer_best *best);

#endif
