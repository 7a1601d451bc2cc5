/* SPDX-License-Identifier: MIT */
/*
 * plot_votes: the plane of a method of the papers, as it votes for the last scans' plots; of the
 * neutrosophic one beside it truth, indeterminacy and falsity, C_T, C_I and C_F.
 */
#ifndef RHOTRACK_TOOL_PLOT_VOTES_H
#define RHOTRACK_TOOL_PLOT_VOTES_H

#include "io/turns/revolutions.h"
#include "picture/picture.h"
#include "settings/method.h"

/* What is to be drawn, found before a picture is begun. */
struct plot_votes;

/* Exit 2 where the method has no accumulator of plots, or its cells do not hold the plots. */
struct plot_votes *plot_votes_find(enum method method, const struct revolutions *revolutions,
                                   const struct parameters *parameters);
void plot_votes(struct picture *picture, const struct plot_votes *votes);
void plot_votes_free(struct plot_votes *votes);

#endif
