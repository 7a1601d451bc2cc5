/* SPDX-License-Identifier: MIT */
/*
 * known_tracks: the tracks that are followed already, as candidates beside new ones. A known track
 * has the better of two scores: of the bearings that it took, where it expected them, and of a fit
 * to all bearings from its own state. So a track that turns is not blamed for it.
 */
#include <string.h>

#include "passive_search.h"
#include "policy.h"

/* Whether nobody has the bearing, or one whom a challenge may take it from. */
static int is_in_play(const struct rho_passive_search *search, uint32_t track_id)
{
    for (uint32_t i = 0; i < search->num_known; i++) {
        if (search->known[i].track_id == track_id) {
            return !search->known[i].is_safe;
        }
    }
    return track_id == 0;
}

void rho_passive_block_bearings(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    const struct rho_batch *batch = &passive->batch;
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            for (unsigned i = 0; i < batch->num_bearings[k][s]; i++) {
                passive->is_claimed[k][s][i] =
                    is_in_play(search, batch->bearings[k][s][i].owner.track_id)
                        ? RHO_PASSIVE_FREE
                        : RHO_PASSIVE_BLOCKED;
            }
        }
    }
}

/* The track with the bearings that it took; looks of sensors that did not see it are misses. */
static void claim_taken(const struct rho_passive_search *search, uint32_t track_id,
                        struct rho_passive_candidate *candidate)
{
    const struct rho_batch *batch = &search->passive->batch;
    memset(candidate->claim, 0, sizeof candidate->claim);
    candidate->hits = 0;
    candidate->score_nat = 0.0f;
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            float gain_nat =
                batch->was_seen[k][s] && rho_passive_is_in_view(search, k, s, candidate->state_m)
                    ? search->miss_nat
                    : 0.0f;
            for (unsigned i = 0; i < batch->num_bearings[k][s]; i++) {
                const struct rho_batch_owner *owner = &batch->bearings[k][s][i].owner;
                if (owner->track_id == track_id) {
                    candidate->claim[k][s] = (uint8_t)(i + 1u);
                    candidate->hits++;
                    gain_nat = search->hit_nat + owner->density_nat;
                }
            }
            candidate->score_nat += gain_nat;
        }
    }
}

void rho_passive_list_known(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    for (uint32_t i = 0; i < search->num_known; i++) {
        const struct rho_passive_known *known = &search->known[i];
        struct rho_passive_candidate taken, fitted;
        float chi2;
        taken.state_m[RHO_PASSIVE_DX] = known->vx_mps * search->half_s;
        taken.state_m[RHO_PASSIVE_DY] = known->vy_mps * search->half_s;
        taken.state_m[RHO_PASSIVE_X] =
            known->x_m - search->middle_x_m - taken.state_m[RHO_PASSIVE_DX];
        taken.state_m[RHO_PASSIVE_Y] =
            known->y_m - search->middle_y_m - taken.state_m[RHO_PASSIVE_DY];
        taken.state_m[RHO_PASSIVE_DZ] = known->vz_mps * search->half_s;
        taken.state_m[RHO_PASSIVE_Z] = known->z_m - taken.state_m[RHO_PASSIVE_DZ];
        memcpy(fitted.state_m, taken.state_m, sizeof fitted.state_m);
        const int matching =
            RHO_PASSIVE_ALSO_CLAIMED | (known->is_level ? 0 : RHO_PASSIVE_BY_SLOPE);
        if (known->is_safe) { /* bearings on its way were its own before it began */
            rho_passive_claim_nearest(search, matching, &fitted);
            rho_passive_mark_claims(passive, &fitted, RHO_PASSIVE_BLOCKED);
            continue;
        }
        claim_taken(search, known->track_id, &taken);
        rho_passive_fit_nearest(search, !known->is_level, fitted.state_m);
        rho_passive_claim_nearest(search, RHO_PASSIVE_ALSO_CLAIMED | RHO_PASSIVE_BY_SLOPE, &fitted);
        const int is_better =
            rho_passive_score_claimed(search, &fitted, &chi2) && fitted.score_nat > taken.score_nat;
        struct rho_passive_candidate *candidate = &passive->candidates[passive->num_candidates++];
        *candidate = is_better ? fitted : taken;
        candidate->score_nat += KNOWN_NAT;
        candidate->known = (uint16_t)(i + 1u);
    }
}
