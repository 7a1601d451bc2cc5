/* SPDX-License-Identifier: MIT */
#include "node_initiation.h"
#include "rhotrack/passive.h"

static struct rho_initiator initiator;
static struct rho_passive passive;

enum rho_status track_starts_init(const struct node_config *config)
{
    enum rho_status status = rho_initiator_init(&initiator, sizeof initiator, &config->initiator);
    if (status == RHO_OK && NODE_HAS_BEARINGS) {
        struct rho_passive_config search;
        rho_passive_config_default(&search);
        status = rho_passive_init(&passive, sizeof passive, &search);
    }
    return status;
}

void track_starts_set_bearings(struct rho_node_config *config)
{
    if (NODE_HAS_BEARINGS) {
        config->passive = &passive;
    }
}

enum rho_status node_step_and_start_tracks(struct rho_node *node)
{
    return rho_node_step(node, &initiator);
}

const struct rho_initiator *track_starts_initiator_or_null(void)
{
    return &initiator;
}
