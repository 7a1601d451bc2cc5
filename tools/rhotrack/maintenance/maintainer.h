/* SPDX-License-Identifier: MIT */
/*
 * maintainer: one track alone in a tracker of its own, from its first plot on and never dropped,
 * for the command maintain and the Python package. The tracker is stepped without an initiator.
 */
#ifndef RHOTRACK_TOOL_MAINTAINER_H
#define RHOTRACK_TOOL_MAINTAINER_H

#include <stdbool.h>
#include <stddef.h>

#include "base/random.h"
#include "rhotrack/tracker.h"
#include "settings/parameters.h"

/* The tracker's gates in their order, and a plot drawn at random. */
enum maintainer_gate { MAINTAIN_BEST, MAINTAIN_HOUGH, MAINTAIN_NEAREST, MAINTAIN_NONE };

struct maintainer; /* opaque */

/* Creates a maintainer; gate hough needs measured velocities. */
struct maintainer *maintainer_new(enum maintainer_gate gate, bool has_input_estimation,
                                  const struct parameters *parameters);
void maintainer_free(struct maintainer *maintainer);

/* Bytes of the library's objects that hold the track. */
size_t maintainer_state_bytes(const struct maintainer *maintainer);

/*
 * Steps one scan. The first plot of all scans starts the track; a track that the tracker ended
 * starts again at the plot nearest to its last place. Returns the row of the plot taken, -1 for
 * none. Exit 2 for a scan that the gate cannot use.
 *   sensor       NULL: not described
 *   log_density  ln of the clutter density over all measured quantities, per m (m^2, m^3) and
 *                (m/s)^3; NAN: estimated from the scans. Used by the gate best alone
 *   random       used by the gate none alone
 */
int maintainer_step(struct maintainer *maintainer, const struct rho_scan *scan,
                    const struct rho_sensor *sensor, double log_density, struct random *random);

/* The fates of the last scan's plots; plots that no track took are HELD. */
const uint32_t *maintainer_fates(const struct maintainer *maintainer);

/* The track after the last step: its state, hits and misses; undefined before it started. */
bool maintainer_is_started(const struct maintainer *maintainer);
const struct rho_track_report *maintainer_report(const struct maintainer *maintainer);

/*
 * Fills the started track as predicted to a time, and the place where a beam should look: that of
 * the best hypothesis.
 */
void maintainer_predict(const struct maintainer *maintainer, int64_t time_us,
                        struct rho_track_report *predicted, double place_m[3]);

/* Number of updates that the filter refused, where the track coasted, and of its new starts. */
unsigned long maintainer_refusals(const struct maintainer *maintainer);

#endif
