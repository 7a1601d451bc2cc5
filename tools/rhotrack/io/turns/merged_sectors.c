/* SPDX-License-Identifier: MIT */
#include "io/turns/merged_sectors.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/scans/plot_reader.h"
#include "rhotrack/detail/window.h"

/* A sensor, and the place of its current turn in the list. */
struct turning_sensor {
    int32_t sensor_id;
    int64_t last_us;           /* time of the sensor's newest scan */
    struct rho_window *window; /* NULL until the sensor gives a sector */
    bool is_open;              /* the current turn is in the list of turns, at index `at` */
    size_t at;
};

struct reading {
    struct revolutions revolutions;
    struct turning_sensor *sensors;
    size_t num_sensors, capacity;
};

static struct turning_sensor *find_or_add_sensor(struct reading *reading,
                                                 const struct rho_scan *scan)
{
    struct turning_sensor *turning;

    for (size_t i = 0; i < reading->num_sensors; i++) {
        if (reading->sensors[i].sensor_id == scan->sensor_id) {
            return &reading->sensors[i];
        }
    }
    reading->sensors = must_make_room_for_one(reading->sensors, reading->num_sensors,
                                              &reading->capacity, sizeof *reading->sensors);
    turning = &reading->sensors[reading->num_sensors++];
    *turning = (struct turning_sensor){.sensor_id = scan->sensor_id, .last_us = INT64_MIN};
    return turning;
}

static bool is_whole_circle(const struct rho_scan *scan)
{
    return scan->sector_from_rad <= scan->sector_to_rad &&
           scan->sector_from_rad >= scan->sector_to_rad;
}

/*
 * Pushes the scan, without its plots, to the sensor's window. Returns whether it is a further
 * sector of the sensor's current turn.
 */
static bool push_and_test_turn_continues(struct turning_sensor *turning,
                                         const struct rho_scan *scan,
                                         const struct rho_sensor *sensor)
{
    struct rho_scan bare = *scan;
    uint32_t left_unused = 0;
    bool is_further;

    if (!turning->window) {
        if (is_whole_circle(scan)) {
            return false;
        }
        turning->window = must_alloc(sizeof *turning->window);
        if (rho_window_init(turning->window, sizeof *turning->window, 1, NULL) != RHO_OK) {
            fail(EXIT_RUNTIME, "turns: the library refuses a window");
        }
    }
    bare.num_plots = 0;
    is_further = rho_window_continues_newest(turning->window, &bare, sensor) != 0;
    if (rho_window_push(turning->window, &bare, sensor, NULL, &left_unused) != RHO_OK) {
        fail(EXIT_USAGE, "sensor %" PRId32 ": the sector %g .. %g rad is not valid",
             scan->sensor_id, (double)scan->sector_from_rad, (double)scan->sector_to_rad);
    }
    return is_further;
}

static void add_plots_to_turn(struct revolution *turn, const struct rho_scan *scan)
{
    size_t count = (size_t)turn->scan.num_plots + scan->num_plots;
    /* fits int32: the window limits the duration of a turn */
    int32_t after_us = (int32_t)(scan->time_us - turn->scan.time_us);

    if (scan->num_plots == 0) {
        return;
    }
    turn->scan.measures =
        turn->scan.num_plots == 0 ? scan->measures : turn->scan.measures & scan->measures;
    turn->plots = must_realloc(turn->plots, count * sizeof *turn->plots);
    memcpy(turn->plots + turn->scan.num_plots, scan->plots, scan->num_plots * sizeof *turn->plots);
    for (size_t i = turn->scan.num_plots; i < count; i++) {
        turn->plots[i].offset_us += after_us;
    }
    turn->scan.plots = turn->plots;
    turn->scan.num_plots = (uint32_t)count;
}

/* Adds a scan's plots to its turn, and widens the sector of the turn to that of the window. */
static void extend_turn_by_sector(struct revolution *turn, struct turning_sensor *turning,
                                  const struct rho_scan *scan)
{
    const struct rho_window_scan *whole = rho_window_scan_at(turning->window, 0);

    add_plots_to_turn(turn, scan);
    turn->scan.sector_from_rad = whole->sector_from_rad;
    turn->scan.sector_to_rad = whole->sector_to_rad;
}

static void drop_oldest_turn(struct reading *reading)
{
    struct revolutions *revolutions = &reading->revolutions;

    free(revolutions->list[0].plots);
    memmove(revolutions->list, revolutions->list + 1,
            --revolutions->count * sizeof *revolutions->list);
    for (size_t i = 0; i < reading->num_sensors; i++) {
        reading->sensors[i].is_open &= reading->sensors[i].at > 0;
        reading->sensors[i].at -= reading->sensors[i].is_open;
    }
}

/* Begins a turn, unless it lies before the turns that are kept. */
static void begin_turn(struct reading *reading, struct turning_sensor *turning,
                       const struct rho_scan *scan, const struct rho_sensor *sensor)
{
    struct revolutions *revolutions = &reading->revolutions;
    struct revolution turn = {.scan = *scan, .has_sensor = sensor};
    size_t at;

    revolutions->total++;
    turning->is_open =
        revolutions->count < revolutions->max || revolutions->list[0].scan.time_us <= scan->time_us;
    if (!turning->is_open) {
        return; /* older than all turns kept, of which there are enough */
    }
    if (revolutions->count == revolutions->max) {
        drop_oldest_turn(reading);
    }
    turn.sensor = sensor ? *sensor : turn.sensor;
    turn.scan.plots = NULL;
    turn.scan.num_plots = 0;
    add_plots_to_turn(&turn, scan);
    for (at = revolutions->count++;
         at > 0 && revolutions->list[at - 1].scan.time_us > scan->time_us; at--) {
        revolutions->list[at] = revolutions->list[at - 1];
    }
    revolutions->list[at] = turn;
    for (size_t i = 0; i < reading->num_sensors; i++) {
        reading->sensors[i].at += reading->sensors[i].at >= at;
    }
    turning->at = at;
    turning->is_open = true; /* set again: drop_oldest_turn may have cleared it */
}

static void extend_or_begin_turn_by_scan(struct reading *reading, const struct rho_scan *scan,
                                         const struct rho_sensor *sensor)
{
    struct turning_sensor *turning = find_or_add_sensor(reading, scan);

    if (scan->time_us < turning->last_us) {
        reading->revolutions.late++;
        return;
    }
    turning->last_us = scan->time_us;
    if (!push_and_test_turn_continues(turning, scan, sensor)) {
        begin_turn(reading, turning, scan, sensor);
    } else if (turning->is_open) { /* else the turn was dropped, or never kept */
        extend_turn_by_sector(&reading->revolutions.list[turning->at], turning, scan);
    }
}

struct revolutions revolutions_read_last(struct plot_reader *reader, size_t max)
{
    struct reading reading = {.revolutions.max = max};
    const struct rho_scan *scan;

    reading.revolutions.list = must_calloc(max, sizeof *reading.revolutions.list);
    while ((scan = plot_reader_next(reader))) {
        extend_or_begin_turn_by_scan(&reading, scan, plot_reader_sensor(reader));
    }
    for (size_t i = 0; i < reading.num_sensors; i++) {
        free(reading.sensors[i].window);
    }
    free(reading.sensors);
    print_if_only_last_taken(max, reading.revolutions.total, "scans");
    if (reading.revolutions.late > 0) {
        fprintf(stderr, "rhotrack: %" PRIu64 " scans that came late are left out\n",
                reading.revolutions.late);
    }
    return reading.revolutions;
}

void revolutions_free(struct revolutions *revolutions)
{
    for (size_t i = 0; i < revolutions->count; i++) {
        free(revolutions->list[i].plots);
    }
    free(revolutions->list);
    *revolutions = (struct revolutions){.max = revolutions->max};
}
