/* SPDX-License-Identifier: MIT */
#include "maintainer_best.h"

#include <stdlib.h>

#include "common.h"

static _Noreturn void fail_planned(void)
{
    fail(EXIT_USAGE, "--gate best is not in this version; there are: hough, nearest, none");
}

struct maintainer_best *maintainer_best_new(const struct parameters *parameters)
{
    (void)parameters;
    fail_planned();
}

void maintainer_best_free(struct maintainer_best *best)
{
    free(best);
}

size_t maintainer_best_bytes(void)
{
    return 0;
}

void maintainer_best_start(struct maintainer_best *best, int64_t time_us,
                           const struct rho_plot *plot, uint32_t measures,
                           const struct rho_sensor *sensor)
{
    (void)best, (void)time_us, (void)plot, (void)measures, (void)sensor;
    fail_planned();
}

void maintainer_best_predict(struct maintainer_best *best, int64_t time_us)
{
    (void)best, (void)time_us;
    fail_planned();
}

void maintainer_best_where(const struct maintainer_best *best, double place_m[3])
{
    (void)best;
    place_m[0] = place_m[1] = place_m[2] = 0.0;
    fail_planned();
}

int maintainer_best_update(struct maintainer_best *best, const struct rho_scan *scan,
                           const struct rho_sensor *sensor, double log_density, double pd)
{
    (void)best, (void)scan, (void)sensor, (void)log_density, (void)pd;
    fail_planned();
}

void maintainer_best_estimate(const struct maintainer_best *best,
                              struct maintainer_estimate *estimate)
{
    (void)best, (void)estimate;
    fail_planned();
}

double maintainer_best_nis(const struct maintainer_best *best, const struct rho_plot *plot,
                           uint32_t measures)
{
    (void)best, (void)plot, (void)measures;
    fail_planned();
}

unsigned long maintainer_best_refused(const struct maintainer_best *best)
{
    (void)best;
    fail_planned();
}
