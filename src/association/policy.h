/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_ASSOCIATION_POLICY_H
#define RHOTRACK_ASSOCIATION_POLICY_H

/*
 * Least share of a hypothesis in the mean, e^-9 of the best one, hypotheses.c: less likely ones
 * have no visible effect. Half or twice: 0.7 nat more or less of hypotheses are computed, and the
 * mean moves in its fourth digit.
 */
#define SHARE_SHOWN_MIN 1.2340980e-4f

/*
 * Largest loss of a hypothesis' weight at one update for a speed above the limit, nat: 10 of
 * the 17 within which hypotheses are kept, hypotheses_scan.c. Half: a history that is too fast
 * lasts more updates. Twice: one plot far off ends it at once.
 */
#define SPEED_LOSS_MAX_NAT 10.0f

#endif
