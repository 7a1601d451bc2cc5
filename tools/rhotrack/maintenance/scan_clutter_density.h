/* SPDX-License-Identifier: MIT */
/*
 * scan_clutter_density: how dense is the clutter about a track, as its scans themselves tell?
 *
 * Nothing is said of where clutter can be: a beam that follows its target, or a whole country. So
 * the plots of the last scans (each scan counts 0.9 of the next), but for the one nearest to the
 * track, say how far they spread: their covariance S about the mean of their own scan, pooled, so
 * that scans of two plots tell something too and a region that moves does no harm. Uniform clutter
 * fills a volume of about
 *
 * pi^(d/2) / Gamma(d/2 + 1)  (d + 2)^(d/2)  sqrt(det S)         exact for a ball or ellipsoid, 0.89
 * of a box in 3-D
 *
 * with S no narrower than the plots' noise on any axis, and its correlations taken back where few
 * plots tell them. The density is max(mean number of plots - pd, 0.1) over the volume. Places,
 * velocities and range rates each have a volume of their own, and these multiply: clutter whose
 * velocity follows from its place would fill none together. Scans without two plots beside the
 * track's say nothing of it. Until two plots beside the track's were seen in one scan, a standard
 * deviation of 1 km (1 km/s) is taken.
 */
#ifndef RHOTRACK_TOOL_SCAN_CLUTTER_DENSITY_H
#define RHOTRACK_TOOL_SCAN_CLUTTER_DENSITY_H

#include "rhotrack/types.h"

struct scan_clutter_density;

struct scan_clutter_density *scan_clutter_density_new(void);
void scan_clutter_density_free(struct scan_clutter_density *density);

/*
 * Takes a scan in, and returns ln of the density in all that it measures: per m^2 or m^3, and
 * (m/s)^2 or ^3 where there are velocities, and m/s where there are range rates. place_m: where the
 * track is predicted. Each sensor has its own.
 */
double scan_clutter_density_log(struct scan_clutter_density *density, const struct rho_scan *scan,
                                const double place_m[3], double pd);

#endif
