/* SPDX-License-Identifier: MIT */
/* node_snapshot: the parts of a node as one image of bytes, and a node from an image. */
#include <string.h>

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

static enum rho_status list_image(struct saved *saved, const void *image, size_t size)
{
    enum rho_status status =
        rho_snapshot_list(image, size, saved->parts, RHO_NODE_PARTS, &saved->num_parts);
    saved->image = image;
    return status == RHO_OK && saved->num_parts > RHO_NODE_PARTS ? RHO_ERROR_CONFIG : status;
}

static const void *object_of(const struct saved *saved, unsigned place)
{
    return saved->image + rho_snapshot_offset(saved->parts, saved->num_parts, place);
}

/* The settings with this identifier in an image; NULL where it has none. */
static const struct rho_settings *saved_settings(const struct saved *saved, int32_t id)
{
    for (unsigned i = 0; i < saved->num_parts; i++) {
        if (saved->parts[i].kind == RHO_SNAPSHOT_SETTINGS && saved->parts[i].id == id) {
            return object_of(saved, i);
        }
    }
    return NULL;
}

enum rho_status rho_node_saved_settings(const void *image, size_t size,
                                        struct rho_settings *settings)
{
    struct saved saved;
    const struct rho_settings *now;
    enum rho_status status;
    if (!settings) {
        return RHO_ERROR_NULL;
    }
    status = list_image(&saved, image, size);
    now = status == RHO_OK ? saved_settings(&saved, SETTINGS_NOW) : NULL;
    if (status == RHO_OK && (!now || rho_settings_check(now, NULL) != RHO_OK)) {
        return RHO_ERROR_CONFIG;
    }
    if (now) {
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

static int has_same_parts(const struct saved *saved, const struct rho_snapshot_part *own,
                          unsigned num_own)
{
    for (unsigned i = 0; i < num_own && num_own == saved->num_parts; i++) {
        if (saved->parts[i].kind != own[i].kind || saved->parts[i].id != own[i].id) {
            return 0;
        }
    }
    return num_own == saved->num_parts;
}

/* True where the image's objects have the configurations of the node's. */
static int has_same_configs(const struct saved *saved, const struct rho_snapshot_part *own)
{
    int is_same = 1;
    for (unsigned i = 0; i < saved->num_parts && is_same; i++) {
        const uint8_t *one = object_of(saved, i), *other = own[i].object;
        size_t at = 0, size = 0; /* of the configuration in the object */
        if (own[i].kind == RHO_SNAPSHOT_TRACKER) {
            at = offsetof(struct rho_tracker, config);
            size = sizeof(struct rho_tracker_config);
        } else if (own[i].kind == RHO_SNAPSHOT_INITIATOR) {
            at = offsetof(struct rho_initiator, config);
            size = sizeof(struct rho_initiator_config);
        } else if (own[i].kind == RHO_SNAPSHOT_PASSIVE) {
            at = offsetof(struct rho_passive, config);
            size = sizeof(struct rho_passive_config);
        } else if (own[i].kind == RHO_SNAPSHOT_SETTINGS) {
            size = sizeof(struct rho_settings);
        }
        is_same = memcmp(one + at, other + at, size) == 0;
    }
    return is_same;
}

/* Loads an image whose operator's settings the node has. */
static enum rho_status load_alike(struct rho_node *node, const struct saved *saved, size_t size)
{
    struct rho_snapshot_part own[RHO_NODE_PARTS];
    enum rho_status status = add_saved_windows(node, saved);
    const unsigned num_own = rho_node_list_parts(node, own);
    if (status != RHO_OK) {
        return status;
    }
    if (!has_same_parts(saved, own, num_own) || !has_same_configs(saved, own)) {
        return RHO_ERROR_CONFIG;
    }
    return rho_snapshot_load(own, num_own, saved->image, size);
}

/* Settings are copied whole, so that equal ones have equal padding. */
static int has_equal_bytes(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct rho_settings)) == 0;
}

enum rho_status rho_node_load(struct rho_node *node, const void *image, size_t size)
{
    struct saved saved;
    struct rho_settings before;
    const struct rho_settings *now;
    enum rho_status status = node_check(node, image);
    if (status == RHO_OK) {
        status = list_image(&saved, image, size);
    }
    if (status != RHO_OK) {
        return status;
    }
    before = node->settings;
    now = saved_settings(&saved, SETTINGS_NOW);
    if (!now || (!has_equal_bytes(now, &before) && rho_node_set_settings(node, now) != RHO_OK)) {
        return RHO_ERROR_CONFIG;
    }
    status = load_alike(node, &saved, size);
    if (status == RHO_OK) {
        node->is_restored = 1;
    } else if (!has_equal_bytes(&node->settings, &before)) {
        (void)!rho_node_set_settings(node, &before); /* they were taken before */
    }
    return status;
}
