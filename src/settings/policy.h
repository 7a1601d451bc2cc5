/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_SETTINGS_POLICY_H
#define RHOTRACK_SETTINGS_POLICY_H

/*
 * Share of the largest acceleration that the initiator assumes turning targets to keep for a
 * window: few turn at their limit for so long. Half: targets in a long turn start late. Twice: the
 * initiator's tolerance grows, and with it the score that clutter reaches.
 */
#define TURN_SHARE 0.2f

/*
 * Scan intervals by which the network may delay a scan. Half: scans that were overtaken by two
 * others are dropped. Twice: the tracker accepts older scans than networks deliver.
 */
#define LATE_SCANS 2.0f

/*
 * Span of the passive paper's cells of rho over range_max_m: range_max_m either way, and room for
 * the sensors' own places. Half: lines farther off than two thirds of range_max_m have no cell.
 * Twice: cells are twice as wide, and close targets share one.
 */
#define PASSIVE_SPAN 2.56f

#endif
