/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_ZONES_POLICY_H
#define RHOTRACK_ZONES_POLICY_H

/*
 * Speed at which a track leaves a queue, over the speed queue_mps below which it joins it. Half: a
 * track whose speed varies about queue_mps joins and leaves at each step. Twice: a vehicle that has
 * driven off is counted in the queue for longer.
 */
#define QUEUE_LEFT 2.0f

#endif
