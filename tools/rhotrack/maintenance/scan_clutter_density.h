/* SPDX-License-Identifier: MIT */
/*
 * scan_clutter_density: estimates the clutter density about a track from the track's own scans.
 *
 * The region in which clutter appears is unknown: it may be a beam about the target, or a whole
 * country. The plots of past scans (each scan weighs 0.9 of the next), except the one nearest to
 * the track, tell its size: their covariance S about the mean of their own scan, pooled over scans,
 * so that scans of two such plots contribute, and a region that moves does no harm. Uniform clutter
 * fills a volume of about
 *
 *   pi^(d/2) / Gamma(d/2 + 1)  (d + 2)^(d/2)  sqrt(det S)
 *
 * which is exact for a ball or an ellipsoid, and 0.89 of a box in 3-D. S is no narrower than the
 * plots' noise on any axis, and its correlations are shrunk where few plots support them. The
 * density is max(mean number of plots - pd, 0.1) over the volume. Places, velocities and range
 * rates have separate volumes, which are multiplied: jointly, velocities that depend on places
 * would fill no volume. Scans without two plots besides the track's do not change S. Before the
 * first such scan the standard deviation is taken as 1 km (1 km/s).
 */
#ifndef RHOTRACK_TOOL_SCAN_CLUTTER_DENSITY_H
#define RHOTRACK_TOOL_SCAN_CLUTTER_DENSITY_H

#include "rhotrack/types.h"

struct scan_clutter_density;

struct scan_clutter_density *scan_clutter_density_new(void);
void scan_clutter_density_free(struct scan_clutter_density *density);

/*
 * Adds a scan to its sensor's statistics, and returns ln of the clutter density over all quantities
 * that the scan measures: per m^2 or m^3, (m/s)^2 or (m/s)^3 of velocities, and m/s of range rates.
 * place_m: predicted place of the track.
 */
double scan_clutter_density_add(struct scan_clutter_density *density, const struct rho_scan *scan,
                                const double place_m[3], double pd);

#endif
