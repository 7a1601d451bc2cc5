/* SPDX-License-Identifier: MIT */
/* node_settings: puts changed settings into a running node and the descriptions of its sensors. */
#include "node_parts.h"

static int is_same(float a, float b)
{
    return !(a < b || a > b);
}

/* A value of a description that equals the setting follows it. */
#define FOLLOW(part, value)                                                                        \
    (part)->value = is_same((part)->value, before->value) ? now->value : (part)->value

/*
 * The description as it follows changed settings. A range that it does not state follows where the
 * setting has changed.
 */
static void follow_settings(struct rho_scan_assembler_sensor *known,
                            const struct rho_settings *before, const struct rho_settings *now)
{
    struct rho_sensor *sensor = &known->sensor;
    struct rho_scan_assembler_noise *noise = &known->noise;
    FOLLOW(sensor, pd);
    FOLLOW(sensor, range_min_m);
    if (!is_same(before->range_max_m, now->range_max_m) && sensor->range_max_m >= RANGE_UNKNOWN_M) {
        sensor->range_max_m = now->range_max_m;
    }
    FOLLOW(sensor, range_max_m);
    FOLLOW(noise, sigma_range_m);
    FOLLOW(noise, sigma_azimuth_rad);
    FOLLOW(noise, sigma_elevation_rad);
    FOLLOW(noise, sigma_range_rate_mps);
    FOLLOW(noise, sigma_rad);
}

static int has_usable_ranges(const struct rho_node *node, const struct rho_settings *settings)
{
    for (unsigned i = 0; i < node->assembler.num_known; i++) {
        struct rho_scan_assembler_sensor known = node->assembler.known[i];
        follow_settings(&known, &node->settings, settings);
        if (!(known.sensor.range_min_m < known.sensor.range_max_m)) {
            return 0;
        }
    }
    return 1;
}

enum rho_status rho_node_set_settings(struct rho_node *node, const struct rho_settings *settings)
{
    struct rho_node_config config;
    enum rho_status status = node_check(node, settings);
    if (status != RHO_OK) {
        return status;
    }
    if (rho_settings_check(settings, NULL) != RHO_OK || !has_usable_ranges(node, settings)) {
        return RHO_ERROR_CONFIG;
    }
    config.tracker = node->tracker.config;
    if (RHO_SEARCHES) {
        config.initiator = NODE_INITIATOR(node)->config;
    }
    rho_settings_apply(settings, &config.tracker, RHO_SEARCHES ? &config.initiator : NULL, NULL);
    status = rho_node_reconfigure(node, &config);
    if (status == RHO_OK) {
        for (unsigned i = 0; i < node->assembler.num_known; i++) {
            follow_settings(&node->assembler.known[i], &node->settings, settings);
        }
        follow_settings(&node->assembler.config.other, &node->settings, settings);
        node->settings = *settings;
    }
    return status;
}
