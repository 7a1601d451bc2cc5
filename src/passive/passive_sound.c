/* SPDX-License-Identifier: MIT */
/*
 * passive_sound: whether a passive initiator of unknown origin (a snapshot) can be worked with.
 */
#include "passive_search.h"

int rho_passive_is_sound(const struct rho_passive *passive)
{
    const struct rho_frame too_new = {.time_us = INT64_MAX}; /* of what is initialised no state, but the time is refused */
    return rho_passive_is_usable(&passive->config) && rho_batch_is_sound(&passive->batch) &&
           passive->batch.scans_max == passive->config.scans &&
           passive->num_tracks <= RHO_MAX_PASSIVE_TRACKS &&
           rho_passive_accepts(passive, &too_new) == RHO_ERROR_VALUE;
}
