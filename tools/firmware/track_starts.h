/* SPDX-License-Identifier: MIT */
/*
 * track_starts: how tracks of the node start. A node has one of
 *
 *     track_starts_best.c    the library's initiator, for bearings its passive search
 *     track_starts_paper.c   the papers' methods: Hough transforms of plots and of bearings
 *
 * which firmware.mk chooses by the node's configuration.
 */
#ifndef TRACK_STARTS_H
#define TRACK_STARTS_H

#include "node.h"
#include "rhotrack/node.h"

/* A node of a library without bearings carries none of their code and memory. */
#define NODE_HAS_BEARINGS RHO_SCAN_ASSEMBLER_HAS(RHO_SCAN_ASSEMBLER_BEARINGS)

/* With the tracker: at the start, and where it begins anew. Errors: those of the objects' init. */
RHO_MUST_CHECK enum rho_status track_starts_open(const struct node_config *config);

/* How the node's frames of bearings start tracks. */
void track_starts_of_bearings(struct rho_node_config *config);

/* rho_node_step, and the tracks that start. */
RHO_MUST_CHECK enum rho_status track_starts_step(struct rho_node *node);

/* What the node's messages tell of; NULL: there is none. */
const struct rho_initiator *track_starts_initiator(void);

#endif
