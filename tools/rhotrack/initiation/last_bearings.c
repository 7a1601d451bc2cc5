/* SPDX-License-Identifier: MIT */
#include "initiation/last_bearings.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/scans/bearing_reader.h"
#include "pipeline/hidden_turns.h"
#include "pipeline/pipeline.h"

/* No smaller than the distance of two sensors at any time. */
static double sensor_distance_m(const struct frame_sensor *a, const struct frame_sensor *b)
{
    return hypot((double)a->x_m - (double)b->x_m, (double)a->y_m - (double)b->y_m) + a->moves_m +
           b->moves_m;
}

double bearing_sensors_max_distance_m(const struct frame_sensor *sensors, size_t count)
{
    double apart_m = 0;

    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < i; j++) {
            apart_m = fmax(apart_m, sensor_distance_m(&sensors[i], &sensors[j]));
        }
    }
    return apart_m;
}

static void check_sensor_distance(const struct frame_sensor *a, const struct frame_sensor *b,
                                  double apart_max_m, const struct parameters *parameters)
{
    double apart_m = sensor_distance_m(a, b);

    if (apart_m > apart_max_m) {
        fail(EXIT_USAGE,
             "sensors %d and %d are %.0f m apart; with cells of d_rho_m %.9g and range_max_m %.9g "
             "they may be %.0f m apart at most",
             (int)a->sensor_id, (int)b->sensor_id, apart_m, parameters->value[PARAMETER_D_RHO_M],
             parameters->value[PARAMETER_RANGE_MAX_M], apart_max_m);
    }
}

void bearing_sensors_check(const struct frame_sensor *sensors, size_t count,
                           const struct rho_batch *batch, const struct parameters *parameters)
{
    if (count > RHO_MAX_PASSIVE_SENSORS) {
        fail(EXIT_USAGE, "%zu passive sensors; at most %d are searched together", count,
             RHO_MAX_PASSIVE_SENSORS);
    }
    for (size_t i = 1; i < count; i++) {
        for (size_t j = 0; j < i; j++) {
            check_sensor_distance(&sensors[j], &sensors[i], (double)batch->apart_max_m, parameters);
        }
    }
}

static void push_and_count_frame(struct last_bearings *batch, const struct bearings_search *search,
                                 const struct rho_frame *frame)
{
    size_t count = 0;
    uint8_t *fates;

    for (uint32_t i = 0; i < frame->num_scans; i++) {
        count += frame->scans[i].num_bearings;
    }
    fates = must_alloc(count + 1);
    memset(fates, RHO_FATE_HELD, count + 1);
    int64_t start_us = monotonic_clock_us();
    must_succeed(search->push(search->object, frame, fates), "passive");
    batch->wall_us += monotonic_clock_us() - start_us;
    for (size_t i = 0; i < count; i++) {
        batch->num_lost += fates[i] != RHO_FATE_HELD;
    }
    free(fates);
    batch->first_us = batch->frames == 0 ? frame->time_us : batch->first_us;
    batch->frames++;
    batch->bearings += count;
    batch->time_us = frame->time_us;
}

struct bearing_reader *last_bearings_open(const struct command_line *line,
                                          struct parameters *parameters)
{
    struct bearing_reader *reader = bearing_reader_open(line->arguments, line->num_arguments,
                                                        &line->parameters, line->keep_going);
    const struct frame_sensor *sensors;
    size_t count;

    bearing_reader_need_two(reader);
    sensors = bearing_reader_sensors(reader, &count);
    parameters->passive_apart_m = bearing_sensors_max_distance_m(sensors, count);
    return reader;
}

struct last_bearings last_bearings_search_and_close(const struct bearings_search *search,
                                                    struct bearing_reader *reader,
                                                    const struct parameters *parameters)
{
    struct last_bearings batch = {.wall_us = 0};
    const struct frame_sensor *sensors;
    const struct rho_frame *frame;
    size_t num_sensors;

    sensors = bearing_reader_sensors(reader, &num_sensors);
    bearing_sensors_check(sensors, num_sensors, search->batch, parameters);
    bearing_reader_keep_last(reader, search->batch->scans_max);
    while ((frame = bearing_reader_next(reader))) {
        push_and_count_frame(&batch, search, frame);
    }
    int64_t start_us = monotonic_clock_us();
    must_succeed(search->search(search->object), "passive");
    batch.wall_us += monotonic_clock_us() - start_us;
    bearing_reader_report(reader);
    if (batch.num_lost) {
        fprintf(stderr, "rhotrack: %" PRIu64 " bearings beyond %d a scan are left out\n",
                batch.num_lost, RHO_MAX_BEARINGS);
    }
    hidden_turns_print(batch.time_us - batch.first_us, batch.frames, parameters, stderr);
    bearing_reader_close(reader);
    return batch;
}
