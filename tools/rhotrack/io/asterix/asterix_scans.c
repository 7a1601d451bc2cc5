/* SPDX-License-Identifier: MIT */
#include "io/asterix/asterix_scans.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/asterix/asterix_radar.h"

#define PERIOD_MIN_128 (ASTERIX_TIME_HZ / 2) /* shorter than any radar's turn */
#define SILENT_128 (60 * ASTERIX_TIME_HZ)    /* a radar silent for this time is not waited for */

struct asterix_scans {
    int64_t hold_128, interval_128, wait_128;
    bool is_by_turn;
    struct asterix_radar *sensors; /* ASTERIX_MAX_SENSORS elements */
    size_t num_sensors;
    bool has_start, has_clock, is_over;
    int64_t start_128; /* reference near the time of the first record */
    bool has_hint;
    int64_t hint_128;           /* a full time of day, which resolves truncated ones */
    int64_t clock_128;          /* latest time of all radars */
    struct asterix_scan *ready; /* complete scans to be taken; each owns its plots */
    size_t num_ready, ready_capacity, next_ready;
    struct asterix_scan_plot *given; /* plots of the scan handed out last */
    struct asterix_counts counts;
};

int64_t asterix_time_us(int64_t time_128)
{
    int64_t half_us = time_128 * (1000000 / (ASTERIX_TIME_HZ / 2));

    return (half_us + (half_us > 0)) / 2;
}

struct asterix_scans *asterix_scans_open(const struct asterix_rules *rules)
{
    struct asterix_scans *scans = must_calloc(1, sizeof *scans);

    scans->hold_128 = llround(rules->hold_s * ASTERIX_TIME_HZ);
    scans->interval_128 = llround(rules->interval_s * ASTERIX_TIME_HZ);
    scans->wait_128 = llround(rules->wait_s * ASTERIX_TIME_HZ);
    scans->is_by_turn = rules->is_by_turn;
    scans->sensors = must_calloc(ASTERIX_MAX_SENSORS, sizeof *scans->sensors);
    return scans;
}

void asterix_scans_close(struct asterix_scans *scans)
{
    if (!scans) {
        return;
    }
    for (size_t i = 0; i < scans->num_sensors; i++) {
        asterix_radar_free(&scans->sensors[i]);
    }
    for (size_t i = scans->next_ready; i < scans->num_ready; i++) {
        free((void *)scans->ready[i].marks);
    }
    free(scans->given);
    free(scans->ready);
    free(scans->sensors);
    free(scans);
}

void asterix_scans_set_day(struct asterix_scans *scans, int64_t time_128)
{
    scans->has_start = true;
    scans->start_128 = time_128;
}

size_t asterix_scans_num_sensors(const struct asterix_scans *scans)
{
    return scans->num_sensors;
}

bool asterix_scans_sensor_has_place(const struct asterix_scans *scans, size_t index,
                                    int32_t *sensor_id)
{
    *sensor_id = scans->sensors[index].sensor_id;
    return scans->sensors[index].place.is_given;
}

const struct asterix_counts *asterix_scans_counts(const struct asterix_scans *scans)
{
    return &scans->counts;
}

/* The radar's state, begun where it is new; NULL where there is no room for another radar. */
static struct asterix_radar *find_or_add_sensor(struct asterix_scans *scans,
                                                const struct asterix_source *source)
{
    int32_t sensor_id = asterix_sensor_id(source);
    size_t i = 0;

    while (i < scans->num_sensors && scans->sensors[i].sensor_id != sensor_id) {
        i++;
    }
    if (i == scans->num_sensors) {
        if (i == ASTERIX_MAX_SENSORS) {
            return NULL;
        }
        scans->sensors[scans->num_sensors++].sensor_id = sensor_id;
    }
    return &scans->sensors[i];
}

/* Order by time, then by azimuth. */
static int compare_plots(const void *a, const void *b)
{
    const struct asterix_scan_plot *one = a, *other = b;
    int order = (one->time_128 > other->time_128) - (one->time_128 < other->time_128);

    return order ? order : (one->azimuth > other->azimuth) - (one->azimuth < other->azimuth);
}

/*
 * Queues a complete look or turn as a scan: sorts its plots by time, and keeps only quantities that
 * all of them have.
 */
static void queue_complete_scan(struct asterix_scans *scans, struct asterix_radar *sensor,
                                struct asterix_open_scan *open)
{
    struct asterix_scan scan = {.sensor_id = sensor->sensor_id,
                                .is_numbered = open->has_look || scans->interval_128 > 0,
                                .number = ++sensor->scan,
                                .is_turn = !open->has_look || open->look.advance == ASTERIX_TURN,
                                .look = open->look,
                                .time_128 = open->look.start_128,
                                .place = sensor->place,
                                .marks = open->marks.list,
                                .count = open->marks.count};

    if (scan.count > 0) {
        qsort(open->marks.list, scan.count, sizeof *open->marks.list, compare_plots);
    }
    asterix_keep_common_quantities(&open->marks, &sensor->place, &scans->counts);
    scans->counts.placed += scan.count;
    scans->ready = must_make_room_for_one(scans->ready, scans->num_ready, &scans->ready_capacity,
                                          sizeof *scans->ready);
    scans->ready[scans->num_ready++] = scan;
}

static void queue_turn_as_scan(struct asterix_scans *scans, struct asterix_radar *sensor)
{
    if (sensor->has_turn) {
        sensor->has_turn = false;
        queue_complete_scan(scans, sensor, &sensor->turn);
        sensor->turn = (struct asterix_open_scan){.has_look = false};
    }
}

/* Takes the radar's oldest open look as complete: it becomes a scan, or is added to the turn. */
static void finish_oldest_look(struct asterix_scans *scans, struct asterix_radar *sensor)
{
    struct asterix_open_scan open = asterix_radar_take_scan(sensor);

    if (!scans->is_by_turn || !open.has_look) {
        queue_complete_scan(scans, sensor, &open);
        return;
    }
    if (!asterix_radar_extend_turn(sensor, &open)) {
        queue_turn_as_scan(scans, sensor);
        (void)asterix_radar_extend_turn(sensor, &open);
    }
    if (sensor->turn.look.advance == ASTERIX_TURN) {
        queue_turn_as_scan(scans, sensor);
    }
}

static void finish_looks_until(struct asterix_scans *scans, struct asterix_radar *sensor,
                               int64_t time_128)
{
    while (sensor->num_open > 0 && sensor->open[0].look.end_128 <= time_128) {
        finish_oldest_look(scans, sensor);
    }
}

/* Ends all looks of the radar and its turn, and drops plots that fit none. */
static void finish_all_scans_of_sensor(struct asterix_scans *scans, struct asterix_radar *sensor)
{
    if (sensor->has_crossings) {
        asterix_radar_end_last_look(sensor, scans->hold_128);
    }
    finish_looks_until(scans, sensor, INT64_MAX);
    queue_turn_as_scan(scans, sensor);
    asterix_radar_drop_waiting(sensor, true, &scans->counts);
}

bool asterix_scans_next(struct asterix_scans *scans, struct asterix_scan *scan)
{
    free(scans->given);
    scans->given = NULL;
    if (scans->next_ready == scans->num_ready) {
        scans->next_ready = scans->num_ready = 0;
        return false;
    }
    *scan = scans->ready[scans->next_ready++];
    scans->given = (struct asterix_scan_plot *)scan->marks;
    return true;
}

int64_t asterix_scans_settled_time_128(const struct asterix_scans *scans)
{
    int64_t settled_128 = INT64_MAX;

    for (size_t i = 0; i < scans->num_sensors && !scans->is_over; i++) {
        struct asterix_radar *sensor = &scans->sensors[i];

        if (sensor->has_clock && scans->clock_128 - sensor->seen_128 <= SILENT_128) {
            int64_t time_128 = asterix_radar_settled_time(sensor, scans->hold_128);

            settled_128 = time_128 < settled_128 ? time_128 : settled_128;
        }
    }
    return settled_128;
}

/* Ends the scans of radars that have been silent too long. */
static void finish_scans_of_silent_sensors(struct asterix_scans *scans)
{
    for (size_t i = 0; i < scans->num_sensors; i++) {
        struct asterix_radar *sensor = &scans->sensors[i];

        if (sensor->has_clock && scans->clock_128 - sensor->seen_128 > SILENT_128 &&
            (sensor->num_open > 0 || sensor->waiting.count > 0)) {
            finish_all_scans_of_sensor(scans, sensor);
        }
    }
}

/*
 * Converts a record's time of day to a continuous time, and advances the clocks. Returns false for
 * a bad time.
 */
static bool unwrap_time_and_advance_clocks(struct asterix_scans *scans,
                                           struct asterix_radar *sensor, uint32_t time_of_day_128,
                                           int64_t *time_128)
{
    const int64_t *reference_128 = scans->has_clock   ? &scans->clock_128
                                   : scans->has_start ? &scans->start_128
                                                      : NULL;

    if (time_of_day_128 >= ASTERIX_DAY ||
        !asterix_radar_unwrap_time(sensor, time_of_day_128, reference_128, time_128)) {
        return false;
    }
    if (!scans->has_clock || sensor->clock_128 > scans->clock_128) {
        scans->clock_128 = sensor->clock_128;
    }
    scans->has_clock = true;
    sensor->seen_128 = scans->clock_128;
    return true;
}

/* Full time of day of a truncated one (modulo 512 s), nearest to the radar's newest known time. */
static uint32_t untruncated_time_of_day(const struct asterix_scans *scans,
                                        const struct asterix_radar *sensor, uint32_t truncated_128)
{
    const int64_t near_128 = sensor->has_clock  ? sensor->clock_128
                             : scans->has_clock ? scans->clock_128
                             : scans->has_hint  ? scans->hint_128
                             : scans->has_start ? scans->start_128
                                                : (int64_t)truncated_128;
    const int64_t later_128 = (int16_t)(uint16_t)((uint64_t)truncated_128 - (uint64_t)near_128);
    const int64_t of_day_128 = (near_128 + later_128) % ASTERIX_DAY;

    return (uint32_t)(of_day_128 < 0 ? of_day_128 + ASTERIX_DAY : of_day_128);
}

/*
 * Once wait_128 is over, takes a radar without crossings as one that reports none, and forms scans
 * of its plots that waited.
 */
static void end_wait_for_crossings_if_due(struct asterix_scans *scans, struct asterix_radar *sensor)
{
    if (sensor->is_known || sensor->has_crossings ||
        sensor->clock_128 - sensor->first_128 < scans->wait_128) {
        return;
    }
    sensor->is_known = true;
    if (sensor->waiting.count > 0) {
        qsort(sensor->waiting.list, sensor->waiting.count, sizeof *sensor->waiting.list,
              compare_plots);
    }
    for (size_t i = 0; i < sensor->waiting.count; i++) {
        asterix_radar_add_timed_plot(sensor, &sensor->waiting.list[i], scans->interval_128);
    }
    sensor->waiting.count = 0;
}

/*
 * Forms the scans that are complete after a record of the radar, and ends those of silent radars.
 */
static void finish_due_scans(struct asterix_scans *scans, struct asterix_radar *sensor)
{
    end_wait_for_crossings_if_due(scans, sensor);
    finish_looks_until(scans, sensor, sensor->clock_128 - scans->hold_128);
    if (sensor->has_crossings) {
        asterix_radar_drop_waiting(sensor, false, &scans->counts);
    }
    finish_scans_of_silent_sensors(scans);
}

/* The counter of the reason for which a plot is left out, or NULL where it is used. */
static uint64_t *counter_if_left_out(struct asterix_counts *counts, const struct asterix_plot *plot)
{
    if (plot->is_simulated || plot->is_test || plot->is_fixed) {
        return &counts->not_real;
    }
    if (plot->has_type && plot->type == 0) {
        return &counts->no_detection;
    }
    if (!plot->source.is_given || !plot->has_time || !plot->has_position || plot->range == 0 ||
        plot->is_beyond) {
        return &counts->incomplete;
    }
    return NULL;
}

static struct asterix_scan_plot make_scan_plot(const struct asterix_plot *plot, int64_t time_128,
                                               struct asterix_counts *counts)
{
    struct asterix_scan_plot mark = {
        .time_128 = time_128, .range = plot->range, .azimuth = plot->azimuth};

    mark.has_alt = plot->has_height || (plot->has_level && !plot->is_level_bad);
    mark.alt = plot->has_height ? plot->height : plot->level;
    mark.has_doppler = plot->has_doppler && !plot->is_doppler_bad;
    mark.doppler_mps = plot->doppler_mps;
    counts->levels_bad += plot->has_level && plot->is_level_bad;
    counts->dopplers_bad += plot->has_doppler && plot->is_doppler_bad;
    counts->dopplers_raw += plot->has_raw_doppler && !plot->has_doppler;
    return mark;
}

static void process_plot(struct asterix_scans *scans, const struct asterix_plot *plot)
{
    uint64_t *count = counter_if_left_out(&scans->counts, plot);
    struct asterix_radar *sensor;
    uint32_t of_day_128 = plot->time_128;
    int64_t time_128;

    scans->counts.plots++;
    if (count) {
        (*count)++;
        return;
    }
    sensor = find_or_add_sensor(scans, &plot->source);
    if (sensor && plot->is_time_truncated) {
        of_day_128 = untruncated_time_of_day(scans, sensor, plot->time_128);
    }
    if (!sensor) {
        scans->counts.no_room++;
    } else if (!unwrap_time_and_advance_clocks(scans, sensor, of_day_128, &time_128)) {
        scans->counts.bad_times++;
    } else {
        const struct asterix_scan_plot mark = make_scan_plot(plot, time_128, &scans->counts);

        if (mark.time_128 < asterix_radar_settled_time(sensor, scans->hold_128)) {
            scans->counts.late++;
        } else if (!sensor->is_known || sensor->has_crossings) {
            asterix_radar_place_plot(sensor, &mark, scans->hold_128);
        } else {
            asterix_radar_add_timed_plot(sensor, &mark, scans->interval_128);
        }
        finish_due_scans(scans, sensor);
    }
}

static void note_place_and_period(struct asterix_radar *sensor,
                                  const struct asterix_service *service)
{
    if (!sensor->place.is_given) {
        sensor->place = service->place;
    }
    if (service->has_period && service->period_128 >= PERIOD_MIN_128) {
        sensor->antenna.period_128 = service->period_128;
        sensor->antenna.is_period_said = true;
    }
}

static bool is_crossing(const struct asterix_service *service)
{
    return service->has_type && service->has_time &&
           (service->type == ASTERIX_NORTH ||
            (service->type == ASTERIX_SECTOR && service->has_sector));
}

static void process_service(struct asterix_scans *scans, const struct asterix_service *service)
{
    struct asterix_radar *sensor =
        service->source.is_given ? find_or_add_sensor(scans, &service->source) : NULL;
    uint16_t azimuth = service->type == ASTERIX_NORTH ? 0 : (uint16_t)(service->sector << 8);
    int64_t time_128;

    scans->counts.services++;
    if (sensor) {
        note_place_and_period(sensor, service);
    }
    if (service->has_type && service->type != ASTERIX_NORTH && service->type != ASTERIX_SECTOR) {
        scans->counts.services_other++;
    } else if (!sensor || !is_crossing(service) ||
               !unwrap_time_and_advance_clocks(scans, sensor, service->time_128, &time_128) ||
               !asterix_radar_end_look(sensor, time_128, azimuth, scans->hold_128,
                                       &scans->counts)) {
        scans->counts.services_left++;
    } else {
        finish_due_scans(scans, sensor);
    }
}

void asterix_scans_take_record(struct asterix_scans *scans, const struct asterix_record *record)
{
    if (asterix_category_is_plots(record->category)) {
        struct asterix_plot plot;

        asterix_plot_read(record, &plot);
        process_plot(scans, &plot);
    } else if (asterix_category_is_service(record->category)) {
        struct asterix_service service;

        asterix_service_read(record, &service);
        process_service(scans, &service);
    }
}

void asterix_scans_preview_record(struct asterix_scans *scans, const struct asterix_record *record)
{
    struct asterix_radar *sensor = NULL;

    if (asterix_category_is_plots(record->category)) {
        struct asterix_plot plot;

        asterix_plot_read(record, &plot);
        sensor = plot.source.is_given ? find_or_add_sensor(scans, &plot.source) : NULL;
    } else if (asterix_category_is_service(record->category)) {
        struct asterix_service service;

        asterix_service_read(record, &service);
        sensor = service.source.is_given ? find_or_add_sensor(scans, &service.source) : NULL;
        if (sensor) {
            note_place_and_period(sensor, &service);
            sensor->has_crossings |= is_crossing(&service);
            if (service.has_time && !scans->has_hint) {
                scans->has_hint = true;
                scans->hint_128 = service.time_128;
            }
        }
    }
    if (sensor) {
        sensor->is_known = true;
    }
}

void asterix_scans_finish(struct asterix_scans *scans)
{
    for (size_t i = 0; i < scans->num_sensors; i++) {
        struct asterix_radar *sensor = &scans->sensors[i];

        if (sensor->has_clock && !sensor->is_known && !sensor->has_crossings) {
            scans->wait_128 = 0;
            end_wait_for_crossings_if_due(scans, sensor);
        }
        finish_all_scans_of_sensor(scans, sensor);
    }
    scans->is_over = true;
}
