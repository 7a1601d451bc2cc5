/* SPDX-License-Identifier: MIT */
/*
 * What the parts of a track share: its life cycle and evidence (track.c), its estimate (track_filter.c). Private to them.
 */
#ifndef RHOTRACK_TRACK_PARTS_H
#define RHOTRACK_TRACK_PARTS_H

#include "rhotrack/track.h"

void rho_track_apply(struct rho_track *track, enum rho_track_event event);
void rho_track_add_score(struct rho_track *track, int32_t mnat);
void rho_track_count_hit(struct rho_track *track);

#endif
