/* SPDX-License-Identifier: MIT */
/*
 * node_initiation: how the node starts tracks. A node is linked with one of
 *
 *     initiation_by_library.c    the library's initiator, for bearings its passive search
 *     initiation_by_papers.c     the papers' methods: Hough transforms of plots and bearings
 *
 * which firmware.mk chooses by the node's configuration.
 */
#ifndef NODE_INITIATION_H
#define NODE_INITIATION_H

#include "lcm_datagram_node.h"
#include "rhotrack/node.h"

/* 1 where the library handles bearings; else their code and memory are left out of the node. */
#define NODE_HAS_BEARINGS RHO_SCAN_ASSEMBLER_HAS(RHO_SCAN_ASSEMBLER_BEARINGS)

/*
 * Initialises the initiators; called together with the tracker's init at the start and at restarts.
 * Errors are those of the init functions.
 */
RHO_MUST_CHECK enum rho_status track_starts_init(const struct node_config *config);

/* Sets in the node's config how frames of bearings start tracks. */
void track_starts_set_bearings(struct rho_node_config *config);

/* Calls rho_node_step, and starts tracks from its scan or frame. */
RHO_MUST_CHECK enum rho_status node_step_and_start_tracks(struct rho_node *node);

/* The initiator whose state the node publishes; NULL where there is none. */
const struct rho_initiator *track_starts_initiator_or_null(void);

#endif
