/* SPDX-License-Identifier: MIT */
/*
 * plots_beside_tracks: finds body_max_m, the length of the longest target that gives several plots
 * a scan, in scans that were tracked without it.
 *
 * Such a target has several tracks, of equal velocities, each with a plot of its own. The distances
 * of their plots are of all lengths up to the target's. Targets of one plot each that move together
 * keep distances from each other that the sensor resolves, in a convoy or a formation equal ones.
 */
#ifndef RHOTRACK_TOOL_PLOTS_BESIDE_TRACKS_H
#define RHOTRACK_TOOL_PLOTS_BESIDE_TRACKS_H

#include <stdint.h>

#include "rhotrack/tracker.h"

#define BESIDE_RINGS 60 /* rings of distance, ten a decade, from 0.01 m to twice RHO_LIMIT_BODY_M */

/* Statistics of a run; all zero at the start. */
struct plots_beside_tracks {
    uint64_t looks;      /* claimed plots of confirmed tracks */
    uint64_t unresolved; /* looks with a plot of such a track within the noise */
    /* plots of tracks of equal velocity, looks by the nearest one; the last: farther, or none */
    uint64_t plots[BESIDE_RINGS + 1], nearest[BESIDE_RINGS + 1];
};

/* Adds a scan, and the report of the tracker's step. */
void plots_beside_tracks_add_scan(struct plots_beside_tracks *beside, const struct rho_scan *scan,
                                  const struct rho_report *report);

struct found_body {
    double body_max_m;        /* 0: no body is found */
    double plots, distance_m; /* mean number of plots beside a track's, most of them so near */
};

struct found_body plots_beside_tracks_find_body(const struct plots_beside_tracks *beside);

/* The members of a found body as a JSON object; the caller owns it. */
struct cJSON;
struct cJSON *found_body_json(const struct found_body *body);

#endif
