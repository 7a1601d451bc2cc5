/* SPDX-License-Identifier: MIT */
/* settle: after starts, images end, each track has one estimate, bodies are updated and split. */
#include "phases.h"

void rho_step_settle(struct step *step)
{
    rho_removal_of_images(step);
    if (!(RHO_SECTORS && rho_retrodiction_return(step))) {
        rho_step_merge_estimates(step);
        rho_life_doubt_places(step->tracker, &step->look);
    }
    rho_targets_split(step);
}
