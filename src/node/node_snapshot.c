/* SPDX-License-Identifier: MIT */
/* node_snapshot: the parts of a node as one image of bytes, and a node from an image. */
#include "node_parts.h"

/* Identifier of the tracker's part: how sensors share the windows of the snapshot. */
enum { OF_NOBODY, OF_SENSORS, OF_ALL, OF_PAIRS };

/* Identifiers of the settings' parts: as at the start, and as changed by operators. */
enum { SETTINGS_TOLD, SETTINGS_NOW };

static int32_t sharing_code(const struct rho_node *node)
{
    return RHO_MAX_WINDOWS == 1 || node->options.windows == RHO_NODE_ONE ? OF_ALL
           : !node->windows.has_sensor                                   ? OF_NOBODY
           : node->options.windows == RHO_NODE_PAIRS                     ? OF_PAIRS
                                                                         : OF_SENSORS;
}

unsigned rho_node_list_parts(struct rho_node *node, struct rho_snapshot_part *parts)
{
    unsigned count = 0;
    if (!rho_node_is_ready(node) || !parts) {
        return 0;
    }
    parts[count++] = (struct rho_snapshot_part){RHO_SNAPSHOT_TRACKER, sharing_code(node),
                                                &node->tracker, sizeof node->tracker};
    for (unsigned i = 0; rho_node_window(node, i); i++) {
        parts[count++] =
            (struct rho_snapshot_part){RHO_SNAPSHOT_INITIATOR, node->windows.sensor_id[i],
                                       rho_node_window(node, i), sizeof(struct rho_initiator)};
    }
    if (RHO_NODE_HAS_PASSIVE) {
        parts[count++] = (struct rho_snapshot_part){RHO_SNAPSHOT_PASSIVE, 0, NODE_PASSIVE(node),
                                                    sizeof *NODE_PASSIVE(node)};
    }
    parts[count++] = (struct rho_snapshot_part){RHO_SNAPSHOT_SETTINGS, SETTINGS_TOLD, &node->told,
                                                sizeof node->told};
    parts[count++] = (struct rho_snapshot_part){RHO_SNAPSHOT_SETTINGS, SETTINGS_NOW,
                                                &node->settings, sizeof node->settings};
    if (RHO_LEARNS_REFLECTORS && node->options.learns_reflectors) {
        parts[count++] = (struct rho_snapshot_part){RHO_SNAPSHOT_REFLECTORS, 0, NODE_LEARNING(node),
                                                    sizeof *NODE_LEARNING(node)};
    }
    return count;
}

/* An image and the parts that it has. */
struct saved {
    const uint8_t *image;
    unsigned num_parts;
    struct rho_snapshot_part parts[RHO_NODE_PARTS];
};

static const void *object_of(const struct saved *saved, unsigned place)
{
    return saved->image + rho_snapshot_offset(saved->parts, saved->num_parts, place);
}

/* Lists an image, and finds the settings that the node had when it was saved. */
static enum rho_status list_image(struct saved *saved, const void *image, size_t size,
                                  const struct rho_settings **settings)
{
    const enum rho_status status =
        rho_snapshot_list(image, size, saved->parts, RHO_NODE_PARTS, &saved->num_parts);
    saved->image = image;
    if (status != RHO_OK) {
        return status;
    }
    for (unsigned i = 0; i < saved->num_parts && saved->num_parts <= RHO_NODE_PARTS; i++) {
        if (saved->parts[i].kind == RHO_SNAPSHOT_SETTINGS && saved->parts[i].id == SETTINGS_NOW) {
            *settings = object_of(saved, i);
            return rho_settings_check(*settings, NULL);
        }
    }
    return RHO_ERROR_CONFIG;
}

enum rho_status rho_node_saved_settings(const void *image, size_t size,
                                        struct rho_settings *settings)
{
    struct saved saved;
    const struct rho_settings *now;
    const enum rho_status status =
        settings ? list_image(&saved, image, size, &now) : RHO_ERROR_NULL;
    if (status == RHO_OK) {
        *settings = *now;
    }
    return status;
}

/* Begins the windows anew, empty, with the sensors of those in the image. */
static enum rho_status add_saved_windows(struct rho_node *node, const struct saved *saved)
{
    if (RHO_SEARCHES) {
        (void)!rho_node_windows_init(node, &NODE_INITIATOR(node)->config);
    }
    for (unsigned i = 1; i < saved->num_parts && RHO_MAX_WINDOWS > 1 && RHO_SEARCHES &&
                         node->options.windows != RHO_NODE_ONE &&
                         (saved->parts[0].id == OF_SENSORS || saved->parts[0].id == OF_PAIRS);
         i++) {
        if (saved->parts[i].kind == RHO_SNAPSHOT_INITIATOR &&
            !rho_node_windows_add(node, saved->parts[i].id)) {
            return RHO_ERROR_CAPACITY;
        }
    }
    node->windows.newest = 0;
    return RHO_OK;
}

/*
 * True where the image's objects have these configurations, and those of the node that no setting
 * changes.
 */
static int has_same_configs(const struct saved *saved, const struct rho_node *node,
                            const struct rho_node_config *config)
{
    int is_same = 1;
    for (unsigned i = 0; i < saved->num_parts && is_same; i++) {
        const struct rho_snapshot_part *part = &saved->parts[i];
        if (part->kind == RHO_SNAPSHOT_TRACKER) {
            const struct rho_tracker *tracker = object_of(saved, i);
            is_same = node_equals(&tracker->config, &config->tracker, sizeof config->tracker);
        } else if (RHO_SEARCHES && part->kind == RHO_SNAPSHOT_INITIATOR) {
            const struct rho_initiator *window = object_of(saved, i);
            is_same = node_equals(&window->config, &config->initiator, sizeof config->initiator);
        } else if (RHO_NODE_HAS_PASSIVE && part->kind == RHO_SNAPSHOT_PASSIVE) {
            const struct rho_passive *passive = object_of(saved, i);
            is_same =
                node_equals(&passive->config, &NODE_PASSIVE(node)->config, sizeof passive->config);
        } else if (part->kind == RHO_SNAPSHOT_SETTINGS && part->id == SETTINGS_TOLD) {
            is_same = node_equals(object_of(saved, i), &node->told, sizeof node->told);
        }
    }
    return is_same;
}

enum rho_status rho_node_load(struct rho_node *node, const void *image, size_t size)
{
    struct saved saved;
    struct rho_snapshot_part own[RHO_NODE_PARTS];
    struct rho_node_config config;
    const struct rho_settings *now;
    enum rho_status status = node_check(node, image);
    if (status == RHO_OK) {
        status = list_image(&saved, image, size, &now);
    }
    if (status == RHO_OK) {
        status = rho_node_settings_prepare(node, now, &config);
    }
    if (status == RHO_OK) {
        status = add_saved_windows(node, &saved);
    }
    if (status != RHO_OK) {
        return status;
    }
    if (!has_same_configs(&saved, node, &config)) {
        return RHO_ERROR_CONFIG;
    }
    const struct rho_settings before = node->settings;
    status = rho_snapshot_load(own, rho_node_list_parts(node, own), image, size);
    if (status == RHO_OK) {
        node->settings = before; /* from which the sensors' descriptions change */
        rho_node_settings_adopt(node, now);
        node->is_restored = 1;
    }
    return status == RHO_ERROR_COUNT ? RHO_ERROR_CONFIG : status; /* other parts */
}
