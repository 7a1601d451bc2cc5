/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_BASE_POLICY_H
#define RHOTRACK_BASE_POLICY_H

/*
 * Sectors are stated in degrees with a decimal or two, so ends that are meant to meet differ by a
 * milliradian at most. Half: sectors written to a tenth of a degree no longer close the circle.
 * Twice: an overlap of a tenth of a degree counts as none.
 */
#define END_TOLERANCE_RAD 1.0e-3f

#endif
