/* SPDX-License-Identifier: MIT */
#include "node_initiation.h"
#include "node_settings_defaults.h"
#include "rhotrack/paper_starts.h"

static struct rho_paper_starts starts;
static struct rho_passive_paper paper;

/* Keeps the paper's rho cells where RHO_MAX_RHO_CELLS of them cover the range, else widens them. */
static void widen_cells_to_range(struct rho_hough_config *hough, float range_m)
{
    const float cell_m = 2.0f * range_m / (float)(RHO_MAX_RHO_CELLS - 2);
    if (cell_m > hough->rho_cell_m) {
        hough->eps_rho_m *= cell_m / hough->rho_cell_m;
        hough->rho_cell_m = cell_m;
    }
    hough->rho_max_m = 0.5f * (float)(RHO_MAX_RHO_CELLS - 1) * hough->rho_cell_m;
}

static enum rho_status init_passive_paper(void)
{
    struct rho_passive_paper_config search;
    rho_passive_paper_config_default(&search);
    return rho_passive_paper_init(&paper, sizeof paper, &search);
}

enum rho_status track_starts_init(const struct node_config *config)
{
    struct rho_paper_starts_config own;
    enum rho_status status;
    rho_paper_starts_config_default(&own, RHO_HOUGH_NHT_C);
    own.hough.v_min_mps = config->initiator.v_min_mps;
    own.hough.v_max_mps = config->initiator.v_max_mps;
    widen_cells_to_range(&own.hough, NODE_RANGE_MAX_M);
    status = rho_paper_starts_init(&starts, sizeof starts, &own);
    return status == RHO_OK ? init_passive_paper() : status;
}

void track_starts_set_bearings(struct rho_node_config *config)
{
    config->apart_max_m = paper.batch.apart_max_m;
}

/*
 * Starts tracks from a closed frame of bearings; where its sensors do not fit the batch, begins a
 * new batch.
 */
static enum rho_status start_tracks_from_closed_frame(const struct rho_node_config *node)
{
    struct rho_frame_view view;
    if (!rho_frames_closed(node->frames, &view) ||
        rho_passive_paper_step(&paper, node->tracker, &view.frame, node->report) == RHO_OK) {
        return RHO_OK;
    }
    return init_passive_paper();
}

enum rho_status node_step_and_start_tracks(struct rho_node *node)
{
    const struct rho_node_config *config = &node->config;
    const int is_frame = node->due == RHO_NODE_FRAME;
    const enum rho_status status = rho_node_step(node, NULL);
    if (status != RHO_OK) {
        return status;
    }
    return is_frame ? start_tracks_from_closed_frame(config)
                    : rho_paper_starts_step(&starts, config->tracker, &node->scan, config->report);
}

const struct rho_initiator *track_starts_initiator_or_null(void)
{
    return NULL;
}
