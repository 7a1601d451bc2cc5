/* SPDX-License-Identifier: MIT */
/* start_thresholds: votes and scores that start and confirm tracks. Private to src/initiation. */
#ifndef RHOTRACK_START_THRESHOLDS_H
#define RHOTRACK_START_THRESHOLDS_H

#include "search.h"

/* Sets M, and the scores that start and confirm a track. */
void rho_thresholds_set(struct search *search);
/* Finds the thresholds anew, for the clutter density measured last. */
void rho_thresholds_update(struct search *search);
/* ln of the prior of a turn, at these thresholds. */
float rho_thresholds_log_turn(const struct search *search);

#endif
