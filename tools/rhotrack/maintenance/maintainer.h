/* SPDX-License-Identifier: MIT */
/*
 * maintainer: one track that is never dropped, through one of the library's gates: what `maintain`
 * and the Python package step. hough, nearest and none (a plot drawn at random) are the library's
 * input and gate modules, best its hypotheses.
 */
#ifndef RHOTRACK_TOOL_MAINTAINER_H
#define RHOTRACK_TOOL_MAINTAINER_H

#include <stdbool.h>
#include <stddef.h>

#include "base/random.h"
#include "rhotrack/detail/hypotheses.h"
#include "rhotrack/detail/kalman.h"
#include "rhotrack/detail/track.h"
#include "rhotrack/types.h"
#include "settings/parameters.h"

#define MAINTAINER_ROW_MAX INT16_MAX /* best does not look at plots behind this row of a scan */

enum maintainer_gate { MAINTAIN_BEST, MAINTAIN_HOUGH, MAINTAIN_NEAREST, MAINTAIN_NONE };

struct maintainer; /* opaque: the library's objects, sized once */

struct maintainer_estimate {
    struct rho_kalman kalman; /* corrected by the input, or the mean over hypotheses */
    float accel_mps2[3];
    float
        /* best: of the manoeuvring model; else 1 where an input is present, 0 else */
        maneuver_probability;
    unsigned num_hypotheses; /* best; else 1 */
};

/* Opened as the parameters say; the gate of velocities needs scans that measure them. */
struct maintainer *maintainer_new(enum maintainer_gate gate, bool has_input_estimation,
                                  const struct parameters *parameters);
void maintainer_free(struct maintainer *maintainer);

/*
 * Another track with the same parameters, which shares the memory of hypotheses of the first: at
 * most MAINTAINERS_BESIDE with the first, which is freed last.
 */
#define MAINTAINERS_BESIDE (RHO_MAX_HYPOTHESES / RHO_HYPOTHESES_OF_TRACK)
struct maintainer *maintainer_new_beside(const struct maintainer *first);

/* Of the library's objects that hold the track. */
size_t maintainer_state_bytes(const struct maintainer *maintainer);

/* ---- Scan by scan, as `maintain` does it ---- */

/*
 * The first plot of all scans starts the track; a scan that does not cover its predicted place says
 * nothing of it. Returns the row of the plot that was taken, -1 for none; other arguments as those
 * of maintainer_update. A scan that the gate cannot use is an error of usage.
 */
int maintainer_step(struct maintainer *maintainer, const struct rho_scan *scan,
                    const struct rho_sensor *sensor, double log_density, struct random *random);

/* The track as it is now, of no meaning before it started: state, hits, misses, the last row. */
bool maintainer_is_started(const struct maintainer *maintainer);
const struct rho_track_report *maintainer_report(struct maintainer *maintainer);

/* ---- The parts of a step ---- */

/*
 * The first plot starts the track: its place and, where measured, its velocity, with their noise.
 */
void maintainer_start(struct maintainer *maintainer, int64_t time_us, const struct rho_plot *plot,
                      uint32_t measures, const struct rho_sensor *sensor);

/* Moves to a scan's time. Then where a beam should look: the (best hypothesis') predicted place. */
void maintainer_predict(struct maintainer *maintainer, int64_t time_us);
void maintainer_predicted_place(const struct maintainer *maintainer, double place_m[3]);

/*
 * Takes the scan that it was predicted to: chooses a plot and updates with it. Returns the row of
 * the plot (best: of the best hypothesis), -1 for none. log_density: ln of the clutter's density in
 * all that the scan measures, per m (m^2, m^3) and (m/s)^3; NAN: to be estimated from the scans.
 * pd: of the target. random: for none.
 */
int maintainer_update(struct maintainer *maintainer, const struct rho_scan *scan,
                      const struct rho_sensor *sensor, double log_density, double pd,
                      struct random *random);

void maintainer_estimate(const struct maintainer *maintainer, struct maintainer_estimate *estimate);

/*
 * Squared Mahalanobis distance of a place (and velocity) from the prediction, over its dimensions:
 * NIS / dim.
 */
double maintainer_nis(const struct maintainer *maintainer, const struct rho_plot *plot,
                      uint32_t measures);

/*
 * Updates that were refused: the track coasted; and predictions over gaps so long that it started
 * again.
 */
unsigned long maintainer_num_refused(const struct maintainer *maintainer);

#endif
