/* SPDX-License-Identifier: MIT */
/* node_windows: the initiation windows of radars, and which two radars share one (node.h). */
#include "../wire/scan_internal.h"
#include "node_parts.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"

/*
 * Coverages are much the same where the distance of the radars plus the difference of their ranges
 * is at most this share of the shorter range: each then sees about half of the other's coverage.
 */
#define APART_MAX 0.8f
/*
 * Largest ratio of two radars' revolution times in a shared window; smaller for pairing again after
 * a separation, so that radars do not pair and part repeatedly.
 */
#define TURNS_MAX 1.5f
#define TURNS_AGAIN_MAX 1.4f

static struct rho_initiator *window_at(struct rho_node *node, unsigned place)
{
    return RHO_MAX_WINDOWS > 1 && place > 0 ? node->windows.more[place - 1] : NODE_INITIATOR(node);
}

struct rho_initiator *rho_node_window(struct rho_node *node, unsigned place)
{
    return RHO_SEARCHES && rho_node_is_ready(node) && place < node->windows.count
               ? window_at(node, place)
               : NULL;
}

const struct rho_initiator *rho_node_windows_newest(const struct rho_node *node)
{
    return RHO_MAX_WINDOWS > 1 && node->windows.newest > 0
               ? node->windows.more[node->windows.newest - 1]
               : NODE_INITIATOR(node);
}

size_t rho_node_storage_size(unsigned num_windows)
{
    return num_windows * sizeof(struct rho_initiator);
}

int rho_node_wants_storage(const struct rho_node *node)
{
    return RHO_MAX_WINDOWS > 1 && RHO_SEARCHES && rho_node_is_ready(node) &&
           !rho_node_is_plots_by_paper(node) && node->options.windows != RHO_NODE_ONE &&
           node->windows.has_sensor && node->windows.count == node->windows.num_places &&
           node->windows.num_places < RHO_MAX_WINDOWS;
}

enum rho_status rho_node_add_storage(struct rho_node *node, void *memory, size_t size)
{
    struct rho_initiator *first = memory;
    const enum rho_status status = node_check(node, memory);
    if (status != RHO_OK) {
        return status;
    }
    if ((uintptr_t)memory % sizeof(int64_t) != 0) {
        return RHO_ERROR_VALUE;
    }
    if (size < sizeof *first) {
        return RHO_ERROR_SIZE;
    }
    if (!(RHO_SEARCHES) || node->windows.num_places >= RHO_MAX_WINDOWS) {
        return RHO_ERROR_CAPACITY;
    }
    for (size_t i = 0; RHO_MAX_WINDOWS > 1 && i < size / sizeof *first &&
                       node->windows.num_places < RHO_MAX_WINDOWS;
         i++) {
        node->windows.more[node->windows.num_places++ - 1u] = first + i;
    }
    return RHO_OK;
}

enum rho_status rho_node_windows_init(struct rho_node *node,
                                      const struct rho_initiator_config *config)
{
    node->windows.count = 1;
    node->windows.newest = 0;
    node->windows.has_sensor = 0;
    node->windows.sensor_id[0] = 0;
    if (node->windows.num_places == 0) {
        node->windows.num_places = 1;
    }
    return RHO_SEARCHES
               ? rho_initiator_init(NODE_INITIATOR(node), sizeof *NODE_INITIATOR(node), config)
               : RHO_OK;
}

static int are_alike(const struct rho_tracker_sensor *one_row,
                     const struct rho_tracker_sensor *other_row, float turns_max)
{
    const struct rho_sensor *one = &one_row->sensor, *other = &other_row->sensor;
    const float x_m = one->x_m - other->x_m, y_m = one->y_m - other->y_m;
    const float apart_m = rho_sqrt(x_m * x_m + y_m * y_m);
    const float shorter_m = rho_smaller(one->range_max_m, other->range_max_m);
    const float longer_m = rho_larger(one->range_max_m, other->range_max_m);
    const float one_s = one_row->pace.interval_s, other_s = other_row->pace.interval_s;
    const int is_known = one_s > 0.0f && other_s > 0.0f;
    return rho_angle_is_circle(one->sector_from_rad, one->sector_to_rad) &&
           rho_angle_is_circle(other->sector_from_rad, other->sector_to_rad) &&
           apart_m + (longer_m - shorter_m) <= APART_MAX * shorter_m &&
           (!is_known || rho_larger(one_s, other_s) <= turns_max * rho_smaller(one_s, other_s));
}

/* Place of the sensor's window, or where it would be. */
static unsigned place_of(const struct rho_node_window_list *windows, int32_t sensor_id)
{
    unsigned place = windows->has_sensor ? 0 : windows->count;
    while (place < windows->count && windows->sensor_id[place] != sensor_id) {
        place++;
    }
    return place;
}

/* A stranger's messages would take half of a window. */
static int may_share(const struct rho_node *node, int32_t sensor_id, int is_live)
{
    const struct rho_scan_assembler *assembler = &node->assembler;
    return !is_live || rho_scan_sensor(assembler, sensor_id) != &assembler->config.other;
}

/* The sensor that names the window: the scan's, or one described before it that shares with it. */
static int32_t sensor_of_window(const struct rho_node *node, const struct rho_scan *scan,
                                int is_live)
{
    const struct rho_tracker *tracker = &node->tracker;
    uint8_t is_paired[RHO_MAX_SENSORS] = {0};
    if (!rho_angle_is_circle(scan->sector_from_rad, scan->sector_to_rad)) {
        return scan->sensor_id;
    }
    for (unsigned i = 0; i < tracker->num_sensors; i++) {
        const struct rho_tracker_sensor *one = &tracker->sensors[i];
        for (unsigned j = i + 1; j < tracker->num_sensors && !is_paired[i]; j++) {
            const struct rho_tracker_sensor *other = &tracker->sensors[j];
            const int32_t other_id = other->sensor.sensor_id;
            /* it had a window of its own before: it has parted from one that it shared */
            const int is_again = place_of(&node->windows, other_id) < node->windows.count;
            is_paired[i] = !is_paired[j] && may_share(node, one->sensor.sensor_id, is_live) &&
                           may_share(node, other_id, is_live) &&
                           are_alike(one, other, is_again ? TURNS_AGAIN_MAX : TURNS_MAX);
            is_paired[j] |= is_paired[i];
            if (is_paired[i] && other_id == scan->sensor_id) {
                return one->sensor.sensor_id;
            }
        }
    }
    return scan->sensor_id;
}

/* Pushes a held scan into another window; plots that started tracks are marked as claimed. */
static void copy_held_scan(struct rho_node *node, struct rho_initiator *to,
                           const struct rho_window_scan *held)
{
    struct rho_plot *plots = NODE_UNPACKED(node);
    uint8_t *fates = NODE_FATES(node);
    uint32_t left_unused = 0;
    for (unsigned i = 0; i < held->num_plots && plots && fates; i++) {
        plots[i] = rho_window_unpack_plot(held, i);
        fates[i] = held->marks[i] & RHO_WINDOW_INITIATED ? RHO_FATE_CLAIMED : RHO_FATE_HELD;
    }
    const struct rho_scan scan = {.time_us = held->time_us,
                                  .sensor_id = held->sensor.sensor_id,
                                  .measures = held->measures,
                                  .sector_from_rad = held->sector_from_rad,
                                  .sector_to_rad = held->sector_to_rad,
                                  .num_plots = held->num_plots,
                                  .plots = plots};
    (void)!rho_initiator_push(to, &scan, rho_window_sensor_if_described(held), fates,
                              &left_unused); /* it was pushed before */
}

/* Copies a sensor's scans from the windows it shared into its new one. */
static void copy_shared_scans(struct rho_node *node, struct rho_initiator *to, int32_t sensor_id)
{
    for (unsigned i = 0; RHO_SEARCHES && RHO_MAX_WINDOWS > 1 && i + 1u < node->windows.count; i++) {
        struct rho_window *shared = &window_at(node, i)->window;
        for (unsigned m = 0; m < shared->num_scans; m++) {
            const struct rho_window_scan *held = rho_window_scan_at(shared, m);
            if (held->sensor.sensor_id == sensor_id) {
                copy_held_scan(node, to, held);
            }
        }
    }
}

struct rho_initiator *rho_node_windows_add(struct rho_node *node, int32_t sensor_id)
{
    struct rho_node_window_list *windows = &node->windows;
    if (!windows->has_sensor) { /* the first window exists before its sensor */
        windows->has_sensor = 1;
        windows->sensor_id[0] = sensor_id;
    }
    const unsigned place = place_of(windows, sensor_id);
    if (place == windows->count) {
        if (place == windows->num_places ||
            rho_initiator_init(window_at(node, place), sizeof *NODE_INITIATOR(node),
                               &NODE_INITIATOR(node)->config) != RHO_OK) {
            return NULL;
        }
        windows->sensor_id[place] = sensor_id;
        windows->count++;
        copy_shared_scans(node, window_at(node, place), sensor_id);
    }
    windows->newest = (uint16_t)place;
    return window_at(node, place);
}

struct rho_initiator *rho_node_windows_find(struct rho_node *node, const struct rho_scan *scan,
                                            int is_live)
{
    struct rho_initiator *window = NODE_INITIATOR(node);
    if (RHO_MAX_WINDOWS > 1 && node->options.windows != RHO_NODE_ONE) {
        struct rho_node_window_list *windows = &node->windows;
        const int32_t sensor_id = node->options.windows == RHO_NODE_PAIRS
                                      ? sensor_of_window(node, scan, is_live)
                                      : scan->sensor_id;
        window = rho_node_windows_add(node, sensor_id);
        if (!window || (windows->newest == RHO_MAX_WINDOWS - 1 &&
                        windows->sensor_id[windows->newest] == sensor_id)) {
            node->windows.shared = rho_count(node->windows.shared, 1);
            windows->newest = (uint16_t)(windows->count - 1u);
            window = window_at(node, windows->newest);
        }
    }
    return window;
}
