/* SPDX-License-Identifier: MIT */
/*
 * passive_sound: whether a passive initiator of unknown origin (a snapshot) can be worked with.
 */
#include "passive_search.h"

int rho_passive_is_sound(const struct rho_passive *passive)
{
    return rho_passive_is_usable(&passive->config) && rho_batch_is_sound(&passive->batch) &&
           passive->batch.scans_max == passive->config.scans &&
           passive->num_tracks <= RHO_MAX_PASSIVE_TRACKS &&
           rho_passive_accepts(passive, NULL) == RHO_ERROR_NULL; /* STATE: not initialised */
}
