/* SPDX-License-Identifier: MIT */
#include "io/turns/revolutions.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/scans/scan_reader.h"
#include "rhotrack/detail/window.h"

/* A sensor, and where its turn under way stands in the list. */
struct looker {
    int32_t sensor_id;
    int64_t last_us;           /* of its newest scan */
    struct rho_window *window; /* NULL as long as it looks all round */
    bool is_open;              /* the turn is in the list, at */
    size_t at;
};

struct reading {
    struct revolutions revolutions;
    struct looker *lookers;
    size_t num_lookers, capacity;
};

/* ---- Sensors ---- */

static struct looker *find_looker(struct reading *reading, const struct rho_scan *scan)
{
    struct looker *looker;

    for (size_t i = 0; i < reading->num_lookers; i++) {
        if (reading->lookers[i].sensor_id == scan->sensor_id) {
            return &reading->lookers[i];
        }
    }
    reading->lookers = must_grow(reading->lookers, reading->num_lookers, &reading->capacity,
                                 sizeof *reading->lookers);
    looker = &reading->lookers[reading->num_lookers++];
    *looker = (struct looker){.sensor_id = scan->sensor_id, .last_us = INT64_MIN};
    return looker;
}

static bool is_whole_circle(const struct rho_scan *scan)
{
    return scan->sector_from_rad <= scan->sector_to_rad &&
           scan->sector_from_rad >= scan->sector_to_rad;
}

/*
 * Whether the scan is a further sector of the sensor's turn. The window sees the sectors, not their
 * plots.
 */
static bool continues_turn(struct looker *looker, const struct rho_scan *scan,
                           const struct rho_sensor *sensor)
{
    struct rho_scan bare = *scan;
    uint32_t left_unused = 0;
    bool is_further;

    if (!looker->window) {
        if (is_whole_circle(scan)) {
            return false;
        }
        looker->window = must_alloc(sizeof *looker->window);
        if (rho_window_init(looker->window, sizeof *looker->window, 1, NULL, 0) != RHO_OK) {
            fail(EXIT_RUNTIME, "turns: the library refuses a window");
        }
    }
    bare.num_plots = 0;
    is_further = rho_window_continues(looker->window, &bare, sensor) != 0;
    if (rho_window_push(looker->window, &bare, sensor, NULL, &left_unused) != RHO_OK) {
        fail(EXIT_USAGE, "sensor %" PRId32 ": the sector %g .. %g rad is none", scan->sensor_id,
             (double)scan->sector_from_rad, (double)scan->sector_to_rad);
    }
    return is_further;
}

/* ---- Turns ---- */

static void add_plots_to_turn(struct revolution *turn, const struct rho_scan *scan)
{
    size_t count = (size_t)turn->scan.num_plots + scan->num_plots;
    int32_t after_us = (int32_t)(scan->time_us - turn->scan.time_us); /* the window has its limit */

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

static void add_sector_to_turn(struct revolution *turn, struct looker *looker,
                               const struct rho_scan *scan)
{
    const struct rho_window_scan *whole = rho_window_scan_at(looker->window, 0);

    add_plots_to_turn(turn, scan);
    turn->scan.sector_from_rad = whole->sector_from_rad;
    turn->scan.sector_to_rad = whole->sector_to_rad;
}

/* The oldest one goes. */
static void drop_oldest_turn(struct reading *reading)
{
    struct revolutions *revolutions = &reading->revolutions;

    free(revolutions->list[0].plots);
    memmove(revolutions->list, revolutions->list + 1,
            --revolutions->count * sizeof *revolutions->list);
    for (size_t i = 0; i < reading->num_lookers; i++) {
        reading->lookers[i].is_open &= reading->lookers[i].at > 0;
        reading->lookers[i].at -= reading->lookers[i].is_open;
    }
}

static void begin_turn(struct reading *reading, struct looker *looker, const struct rho_scan *scan,
                       const struct rho_sensor *sensor)
{
    struct revolutions *revolutions = &reading->revolutions;
    struct revolution turn = {.scan = *scan, .has_sensor = sensor};
    size_t at;

    revolutions->total++;
    looker->is_open =
        revolutions->count < revolutions->max || revolutions->list[0].scan.time_us <= scan->time_us;
    if (!looker->is_open) {
        return; /* it is not among the last ones */
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
    for (size_t i = 0; i < reading->num_lookers; i++) {
        reading->lookers[i].at += reading->lookers[i].at >= at;
    }
    looker->at = at;
    looker->is_open = true; /* not the one that was dropped */
}

static void take_scan(struct reading *reading, const struct rho_scan *scan,
                      const struct rho_sensor *sensor)
{
    struct looker *looker = find_looker(reading, scan);

    if (scan->time_us < looker->last_us) {
        reading->revolutions.late++;
        return;
    }
    looker->last_us = scan->time_us;
    if (!continues_turn(looker, scan, sensor)) {
        begin_turn(reading, looker, scan, sensor);
    } else if (looker->is_open) { /* else its turn is not among the last ones */
        add_sector_to_turn(&reading->revolutions.list[looker->at], looker, scan);
    }
}

struct revolutions revolutions_read_last(struct scan_reader *reader, size_t max)
{
    struct reading reading = {.revolutions.max = max};
    const struct rho_scan *scan;

    reading.revolutions.list = must_calloc(max, sizeof *reading.revolutions.list);
    while ((scan = scan_reader_next(reader))) {
        take_scan(&reading, scan, scan_reader_sensor(reader));
    }
    for (size_t i = 0; i < reading.num_lookers; i++) {
        free(reading.lookers[i].window);
    }
    free(reading.lookers);
    say_only_last_taken(max, reading.revolutions.total, "scans");
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
