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

/* The descriptions of known sensors; the last one is that of all others. */
static struct rho_scan_assembler_sensor *description_at(struct rho_node *node, unsigned place)
{
    struct rho_scan_assembler *assembler = &node->assembler;
    return place < assembler->num_known ? &assembler->known[place] : &assembler->config.other;
}

enum rho_status rho_node_settings_prepare(struct rho_node *node,
                                          const struct rho_settings *settings,
                                          struct rho_node_config *config)
{
    if (rho_settings_check(settings, NULL) != RHO_OK) {
        return RHO_ERROR_CONFIG;
    }
    config->tracker = node->tracker.config;
    if (RHO_SEARCHES) {
        config->initiator = NODE_INITIATOR(node)->config;
    }
    if (node_equals(settings, &node->settings, sizeof *settings)) {
        return RHO_OK;
    }
    for (unsigned i = 0; i <= node->assembler.num_known; i++) {
        struct rho_scan_assembler_sensor known = *description_at(node, i);
        follow_settings(&known, &node->settings, settings);
        if (!(known.sensor.range_min_m < known.sensor.range_max_m)) {
            return RHO_ERROR_CONFIG;
        }
    }
    rho_settings_apply(settings, &config->tracker, RHO_SEARCHES ? &config->initiator : NULL, NULL);
    return RHO_OK;
}

void rho_node_settings_adopt(struct rho_node *node, const struct rho_settings *settings)
{
    const struct rho_settings before = node->settings;
    for (unsigned i = 0; i <= node->assembler.num_known; i++) {
        follow_settings(description_at(node, i), &before, settings);
    }
    node->settings = *settings;
}

enum rho_status rho_node_set_settings(struct rho_node *node, const struct rho_settings *settings)
{
    struct rho_node_config config;
    enum rho_status status = node_check(node, settings);
    if (status == RHO_OK) {
        status = rho_node_settings_prepare(node, settings, &config);
    }
    if (status == RHO_OK) {
        status = rho_node_reconfigure(node, &config);
    }
    if (status == RHO_OK) {
        rho_node_settings_adopt(node, settings);
    }
    return status;
}
