/* SPDX-License-Identifier: MIT */
/*
 * ghost_matrix: which crossings of two sensors' bearings can be targets, and which are ghosts.
 *
 * Sensors a and b with m and n bearings have m n crossings, of which at most min(m, n) are targets.
 * The ghost matrix holds one element a crossing, M(i, j) = delta_ij, the angle between the
 * bearings; 0: no target.
 *
 *            b0    b1    b2         elimination: 0 if the bearings do not meet within range_max
 *      a0  [ .     .31   0   ]  <-  pruning: if every beam has a target, the only
 *      a1  [ .22   .35   .07 ]      crossing of a beam is one, and the other beam has no
 *      a2  [ 0     .29   .04 ]      further target: a0 removes b1 from a1 and a2
 *
 * The literal rule assumes one target on a beam at most, and is right if both sensors see every
 * target and nothing else. After a false alarm or a miss, the only crossing of a beam may be a
 * ghost, which then removes a target. The safe rule acts only where the bearings do not contradict
 * this assumption: a has as many bearings as b, and there is a complete matching, which pairs each
 * bearing with one of the other sensor. Then a crossing that is in no complete matching is a ghost.
 * This removes all that the literal rule removes, and more: where two beams of a meet the same two
 * beams of b and no others, a third beam of a has no target on those beams of b.
 *
 * Source: passive Hough transform paper (see bearing_crossing.h), section 3, steps 1 to 2.6.
 *
 * Stack: 32 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_GHOST_MATRIX_H
#define RHOTRACK_GHOST_MATRIX_H

#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/detail/bearing_crossing.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

/*
 * Why a crossing of two bearings is kept as a possible target, or eliminated as a ghost: its fate
 * as a crossing, or the rule that prunes it.
 */
enum rho_ghost_reason {
    RHO_GHOST_KEPT = RHO_CROSSING_MEETS,
    RHO_GHOST_SIDES = RHO_CROSSING_SIDES,
    RHO_GHOST_APART = RHO_CROSSING_APART, /* step 1.1 */
    RHO_GHOST_RANGE = RHO_CROSSING_RANGE, /* step 1.2.1 */
    /* the bearing of b belongs to another bearing of a, which has no other crossing (step 2.3) */
    RHO_GHOST_ROW,
    /* the bearing of a belongs to another bearing of b, which has no other crossing (step 2.5) */
    RHO_GHOST_COLUMN,
    RHO_GHOST_UNMATCHED, /* safe rule: the crossing is in no complete matching */
    RHO_NUM_GHOST_REASONS
};

enum rho_ghost_rule {
    RHO_GHOST_NO_RULE, /* no pruning: crossings are eliminated by side and range alone */
    RHO_GHOST_LITERAL, /* pruning by steps 2 to 2.6 of the paper */
    RHO_GHOST_SAFE     /* pruning by complete matchings, where the bearings have one */
};

struct rho_ghost_matrix {
    uint16_t rows, columns; /* number of bearings of sensor a (rows) and of sensor b (columns) */
    /* M(i, j), the angle between bearing i of a and bearing j of b; 0: ghost */
    float delta_rad[RHO_MAX_BEARINGS][RHO_MAX_BEARINGS];
    uint8_t reason[RHO_MAX_BEARINGS][RHO_MAX_BEARINGS]; /* enum rho_ghost_reason of each crossing */
};

/*
 * Fills the matrix with the crossings of two sensors' bearings, and eliminates crossings by side
 * and range.
 *   bearings_a_rad, bearings_b_rad  num_a and num_b bearings, one scan of each sensor
 *   range_max_m  largest range of either sensor, > 0
 * Errors: NULL, CAPACITY (more than RHO_MAX_BEARINGS), VALUE (a bearing not finite, range_max_m not
 * positive); *matrix is unchanged. Cost: num_a num_b crossings. Stack: 190 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_ghost_fill(struct rho_ghost_matrix *matrix,
                                              const struct rho_crossing_base *base,
                                              const float *bearings_a_rad, unsigned num_a,
                                              const float *bearings_b_rad, unsigned num_b,
                                              float range_max_m);

/*
 * Prunes ghosts from a filled matrix by a rule. Returns the number of crossings removed.
 * Cost: RHO_MAX_BEARINGS^3 at most. Stack: 300 bytes.
 */
unsigned rho_ghost_prune(struct rho_ghost_matrix *matrix, enum rho_ghost_rule rule);

/* Name of a reason in lower case ("kept", "sides", ...); "unknown" for any other value. */
const char *rho_ghost_reason_name(enum rho_ghost_reason reason);

RHO_END_C

#endif
