/* SPDX-License-Identifier: MIT */
/* tracker_setup: initialises and reconfigures a tracker. src/step/step.c processes a scan. */
#include "rhotrack/tracker.h"

#include <stddef.h>
#include <string.h>

#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/recurring_clutter_map.h"
#include "step.h"

#define ALL_PLANES (RHO_GATE_PLANE_XY | RHO_GATE_PLANE_XZ | RHO_GATE_PLANE_YZ)

/* The build fails where the RAM formula of config.h is no longer an upper bound. */
typedef char rho_assert_tracker_ram[sizeof(struct rho_tracker) <= RHO_RAM_TRACKER_BYTES ? 1 : -1];

enum rho_track_filter rho_tracker_filter(const struct rho_tracker_config *config)
{
    if (config->gate == RHO_TRACKER_BEST) {
        return RHO_TRACK_HYPOTHESES;
    }
    return config->input.is_estimated ? RHO_TRACK_INPUT : RHO_TRACK_KALMAN;
}

void rho_tracker_config_default(struct rho_tracker_config *config)
{
    *config = (struct rho_tracker_config){
        .pd = 0.9f,
        .v_max_mps = 700.0f,
        .accel_max_mps2 = 30.0f,
        .learn_noise_min = 0.7f,
        .learn_noise_max = 4.0f,
        .learn_pd_min = 0.1f,
        .coast_scans_max = 5,
        .work_max = RHO_WORK_MAX,
        .gate = RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) ? RHO_TRACKER_BEST : RHO_TRACKER_NEAREST,
        .planes = ALL_PLANES,
        .theta_cell_rad = 5.0f * (RHO_PI / 180.0f),
        .late_max_s = RHO_SECTORS ? 20.0f : 0.0f,
    };
    rho_input_config_default(&config->input);
    config->input.is_estimated = (RHO_FILTERS) == 1 << RHO_TRACK_INPUT;
}

int rho_tracker_is_usable(const struct rho_tracker_config *config)
{
    return rho_is_within(config->pd, 0.01f, 0.999f) &&
           rho_is_within(config->v_max_mps, 1.0f, RHO_LIMIT_SPEED_MPS) &&
           rho_is_within(config->accel_max_mps2, 0.0f, 1000.0f) &&
           rho_is_within(config->steady_s, 0.0f, 1e5f) &&
           rho_is_within(config->v_min_mps, 0.0f, config->v_max_mps) &&
           (!RHO_SECTORS || rho_is_within(config->late_max_s, 0.0f, 60.0f)) &&
           rho_is_within(config->learn_noise_min, 0.1f, 1.0f) &&
           rho_is_within(config->learn_noise_max, 1.0f, 10.0f) &&
           rho_is_within(config->learn_pd_min, 0.1f, 1.0f) && config->coast_scans_max >= 1 &&
           config->coast_scans_max <= UINT8_MAX && config->gate < RHO_NUM_TRACKER_GATES &&
           config->standing < RHO_NUM_STANDING && RHO_HAS_FILTER(rho_tracker_filter(config)) &&
           (config->gate != RHO_TRACKER_BEST || RHO_MAX_HYPOTHESES > RHO_MAX_TRACKS) &&
           (config->gate != RHO_TRACKER_HOUGH || RHO_HAS_FILTER(RHO_TRACK_INPUT)) &&
           (!RHO_HAS_FILTER(RHO_TRACK_INPUT) || rho_input_is_usable(&config->input)) &&
           config->planes > 0 && config->planes <= ALL_PLANES &&
           rho_is_within(config->theta_cell_rad, 1e-3f, RHO_HALF_PI) &&
           rho_is_within(config->hough_window_m, 0.0f, 2.0f * RHO_LIMIT_POSITION_M) &&
           config->work_max <= RHO_LIMIT_WORK;
}

static struct rho_imm_model motion_model(const struct rho_tracker_config *config)
{
    struct rho_imm_model model;
    rho_imm_model_default(&model, config->accel_max_mps2, config->v_max_mps);
    model.speed_max_mps = config->v_max_mps;
    if (config->steady_s > model.steady_s) {
        model.steady_s = config->steady_s;
    }
    return model;
}

/* Prepares a cleared tracker for its first step; its clutter map is initialised. */
static enum rho_status begin_tracking(struct rho_tracker *tracker)
{
    tracker->next_track_id = 1;
    tracker->extent = (struct rho_extent){1.0f, 0.0f, 1.0f, 0.0f};
    if (RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES)) {
        const struct rho_imm_model model = motion_model(&tracker->config);
        const enum rho_status status =
            rho_hypotheses_init(&tracker->hypotheses, sizeof tracker->hypotheses, &model);
        if (status != RHO_OK) {
            return status;
        }
    }
    tracker->magic = RHO_TRACKER_MAGIC;
    return rho_assignment_init(&tracker->assignment, sizeof tracker->assignment);
}

enum rho_status rho_tracker_init(struct rho_tracker *tracker, size_t size,
                                 const struct rho_tracker_config *config)
{
    if (!tracker || !config) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *tracker) {
        return RHO_ERROR_SIZE;
    }
    if (!rho_tracker_is_usable(config)) {
        return RHO_ERROR_CONFIG;
    }
    const struct rho_tracker_config copy = *config;
    memset(tracker, 0, sizeof *tracker);
    tracker->config = copy;
    if (RHO_MAX_ECHOES > 0) {
        rho_clutter_map_init(&tracker->clutter_map, copy.v_min_mps);
    }
    return begin_tracking(tracker);
}

enum rho_status rho_tracker_restart(struct rho_tracker *tracker)
{
    const enum rho_status status = rho_tracker_check(tracker, 1);
    if (status != RHO_OK) {
        return status;
    }
    const float body_max_m = tracker->bodies.length_max_m, clutter = tracker->clutter_per_m2;
    /* config, counters and work stand between the two */
    memset(tracker, 0, offsetof(struct rho_tracker, config));
    memset((uint8_t *)tracker + offsetof(struct rho_tracker, sensors), 0,
           offsetof(struct rho_tracker, clutter_map) - offsetof(struct rho_tracker, sensors));
    memset(&tracker->bodies, 0, sizeof tracker->bodies);
    tracker->bodies.length_max_m = body_max_m;
    tracker->clutter_per_m2 = clutter;
    if (RHO_MAX_ECHOES > 0) {
        rho_clutter_map_restart(&tracker->clutter_map);
    }
    return begin_tracking(tracker);
}

enum rho_status rho_tracker_reconfigure(struct rho_tracker *tracker,
                                        const struct rho_tracker_config *config)
{
    enum rho_status status = rho_tracker_check(tracker, config != 0);
    if (status != RHO_OK || !rho_tracker_is_usable(config)) {
        return status != RHO_OK ? status : RHO_ERROR_CONFIG;
    }
    if (tracker->num_tracks > 0 &&
        rho_tracker_filter(config) != rho_tracker_filter(&tracker->config)) {
        return RHO_ERROR_STATE;
    }
    if (RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES)) {
        const struct rho_imm_model model = motion_model(config);
        status = rho_hypotheses_set_model(&tracker->hypotheses, &model);
        if (status != RHO_OK) {
            return status;
        }
    }
    if (RHO_MAX_ECHOES > 0 && config->standing > tracker->config.standing) {
        memset(tracker->clutter_map.echoes, 0, sizeof tracker->clutter_map.echoes);
    }
    tracker->config = *config;
    if (RHO_MAX_ECHOES > 0) {
        tracker->clutter_map.v_min_mps = config->v_min_mps;
    }
    return RHO_OK;
}
