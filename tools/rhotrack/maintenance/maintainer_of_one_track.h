/* SPDX-License-Identifier: MIT */
/*
 * maintainer_of_one_track: maintains one track that is never dropped, for the command maintain and
 * the Python package. The gates hough, nearest and none (a plot drawn at random) use the library's
 * Kalman filter with input estimation, the gate best its multiple hypotheses.
 */
#ifndef RHOTRACK_TOOL_MAINTAINER_OF_ONE_TRACK_H
#define RHOTRACK_TOOL_MAINTAINER_OF_ONE_TRACK_H

#include <stdbool.h>
#include <stddef.h>

#include "base/random.h"
#include "rhotrack/detail/hypotheses.h"
#include "rhotrack/detail/kalman.h"
#include "rhotrack/detail/track.h"
#include "rhotrack/types.h"
#include "settings/parameters.h"

/* Highest row of a scan that the gate best can take as a plot. */
#define MAINTAINER_ROW_MAX INT16_MAX

enum maintainer_gate { MAINTAIN_BEST, MAINTAIN_HOUGH, MAINTAIN_NEAREST, MAINTAIN_NONE };

struct maintainer; /* opaque; holds the library's objects, and is allocated once */

struct maintainer_estimate {
    struct rho_kalman kalman; /* state with the estimated input; gate best: mean over hypotheses */
    float accel_mps2[3];
    /* gate best: probability of the manoeuvring model; other gates: 1 while an input is present */
    float maneuver_probability;
    unsigned num_hypotheses; /* hypotheses of the gate best; 1 for other gates */
};

/*
 * Creates a maintainer with the parameters' filter settings; gate hough needs measured velocities.
 */
struct maintainer *maintainer_new(enum maintainer_gate gate, bool has_input_estimation,
                                  const struct parameters *parameters);
void maintainer_free(struct maintainer *maintainer);

/*
 * Creates a maintainer with the same parameters that shares the first one's pool of hypotheses. At
 * most MAINTAINERS_BESIDE maintainers, including the first, can share it; the first is freed last.
 */
#define MAINTAINERS_BESIDE (RHO_MAX_HYPOTHESES / RHO_HYPOTHESES_OF_TRACK)
struct maintainer *maintainer_new_sharing_pool(const struct maintainer *first);

/* Size of the library's objects that hold the track, in bytes. */
size_t maintainer_state_bytes(const struct maintainer *maintainer);

/* ---- Scan by scan, as `maintain` does it ---- */

/*
 * Steps one scan. The first plot of all scans starts the track; a scan that does not cover the
 * predicted place neither updates the track nor counts as a miss. Returns the row of the plot
 * taken, -1 for none. Exit 2 for a scan that the gate cannot use; other arguments as in
 * maintainer_update_and_get_row.
 */
int maintainer_step_and_get_row(struct maintainer *maintainer, const struct rho_scan *scan,
                                const struct rho_sensor *sensor, double log_density,
                                struct random *random);

/* The track after the last step: state, hits, misses, last row; undefined before it started. */
bool maintainer_is_started(const struct maintainer *maintainer);
const struct rho_track_report *maintainer_report(struct maintainer *maintainer);

/* ---- The parts of a step ---- */

/* Starts the track from a plot: its place and, where measured, its velocity, with their noise. */
void maintainer_start(struct maintainer *maintainer, int64_t time_us, const struct rho_plot *plot,
                      uint32_t measures, const struct rho_sensor *sensor);

/*
 * Predicts the track to a scan's time. The predicted place, of the best hypothesis for the gate
 * best, is where a beam should be steered.
 */
void maintainer_predict(struct maintainer *maintainer, int64_t time_us);
void maintainer_predicted_place(const struct maintainer *maintainer, double place_m[3]);

/*
 * Chooses a plot of the scan that the track was predicted to, and updates the track with it.
 * Returns the row of the plot (gate best: of the best hypothesis), -1 for none.
 *   log_density  ln of the clutter density over all measured quantities, per m (m^2, m^3) and
 *                (m/s)^3; NAN: estimated from the scans
 *   pd           detection probability of the target
 *   random       used by the gate none alone
 */
int maintainer_update_and_get_row(struct maintainer *maintainer, const struct rho_scan *scan,
                                  const struct rho_sensor *sensor, double log_density, double pd,
                                  struct random *random);

void maintainer_estimate(const struct maintainer *maintainer, struct maintainer_estimate *estimate);

/*
 * Squared Mahalanobis distance of a plot from the prediction, divided by the number of measured
 * dimensions: its mean is 1 for a consistent filter.
 */
double maintainer_nis_per_dimension(const struct maintainer *maintainer,
                                    const struct rho_plot *plot, uint32_t measures);

/*
 * Number of updates that were refused, where the track coasted, and of predictions that were
 * refused, where the track restarted.
 */
unsigned long maintainer_num_filter_refusals(const struct maintainer *maintainer);

#endif
