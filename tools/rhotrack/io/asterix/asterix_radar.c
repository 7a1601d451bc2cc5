/* SPDX-License-Identifier: MIT */
#include "io/asterix/asterix_radar.h"

#include <stdlib.h>
#include <string.h>

#include "base/common.h"

/* a larger step in time must be confirmed by the next record */
#define JUMP_128 (60 * ASTERIX_TIME_HZ)
/* longest wait of a plot for its look: more than the slowest turn */
#define WAIT_128 (90 * ASTERIX_TIME_HZ)

/* The time nearest to the reference that has the given time of day. */
static int64_t unwrap_time_of_day(int64_t reference_128, uint32_t time_of_day_128)
{
    int64_t of_day = reference_128 % ASTERIX_DAY;
    int64_t later = (int64_t)time_of_day_128 - (of_day < 0 ? of_day + ASTERIX_DAY : of_day);

    if (later <= -ASTERIX_DAY / 2) {
        later += ASTERIX_DAY;
    } else if (later > ASTERIX_DAY / 2) {
        later -= ASTERIX_DAY;
    }
    return reference_128 + later;
}

static bool is_near_in_continuous_time(int64_t time_128, int64_t other_128)
{
    return time_128 - other_128 <= JUMP_128 && other_128 - time_128 <= JUMP_128;
}

bool asterix_radar_unwrap_time(struct asterix_radar *sensor, uint32_t time_of_day_128,
                               const int64_t *reference_128, int64_t *time_128)
{
    if (!sensor->has_clock) {
        *time_128 =
            reference_128 ? unwrap_time_of_day(*reference_128, time_of_day_128) : time_of_day_128;
        sensor->has_clock = true;
        sensor->first_128 = sensor->clock_128 = *time_128;
        return true;
    }
    *time_128 = unwrap_time_of_day(sensor->clock_128, time_of_day_128);
    if (!is_near_in_continuous_time(*time_128, sensor->clock_128)) {
        bool is_again =
            sensor->has_suspect && is_near_in_continuous_time(*time_128, sensor->suspect_128);

        sensor->has_suspect = true;
        sensor->suspect_128 = *time_128;
        if (!is_again || *time_128 < sensor->clock_128) {
            return false;
        }
    }
    sensor->has_suspect = false;
    sensor->clock_128 = *time_128 > sensor->clock_128 ? *time_128 : sensor->clock_128;
    return true;
}

static void add_plot_to_scan(struct asterix_scan_plots *marks, const struct asterix_scan_plot *mark)
{
    marks->list =
        must_make_room_for_one(marks->list, marks->count, &marks->capacity, sizeof *marks->list);
    marks->list[marks->count++] = *mark;
}

static struct asterix_open_scan *add_open_scan(struct asterix_radar *sensor,
                                               const struct asterix_look *look, bool has_look)
{
    struct asterix_open_scan *open;

    sensor->open = must_make_room_for_one(sensor->open, sensor->num_open, &sensor->open_capacity,
                                          sizeof *sensor->open);
    open = &sensor->open[sensor->num_open++];
    *open = (struct asterix_open_scan){.has_look = has_look, .look = *look};
    return open;
}

/*
 * Adds a plot to the open look that passed its azimuth nearest to its time. Returns false where
 * none did.
 */
static bool place_plot_in_look(struct asterix_radar *sensor, const struct asterix_scan_plot *mark,
                               int64_t hold_128)
{
    struct asterix_open_scan *nearest = NULL;
    int64_t least_128 = INT64_MAX, distance_128;

    for (size_t i = 0; i < sensor->num_open; i++) {
        struct asterix_open_scan *open = &sensor->open[i];

        if (open->has_look &&
            asterix_look_covers_plot(&open->look, mark->time_128, mark->azimuth, &distance_128) &&
            mark->time_128 >= open->look.start_128 - hold_128 && distance_128 < least_128) {
            nearest = open;
            least_128 = distance_128;
        }
    }
    if (nearest) {
        add_plot_to_scan(&nearest->marks, mark);
    }
    return nearest;
}

static void place_waiting_plots(struct asterix_radar *sensor, int64_t hold_128)
{
    size_t kept = 0;

    for (size_t i = 0; i < sensor->waiting.count; i++) {
        if (!place_plot_in_look(sensor, &sensor->waiting.list[i], hold_128)) {
            sensor->waiting.list[kept++] = sensor->waiting.list[i];
        }
    }
    sensor->waiting.count = kept;
}

/* Time of the earliest waiting plot; otherwise_128 where none waits. */
static int64_t first_waiting_plot_time(const struct asterix_radar *sensor, int64_t otherwise_128)
{
    int64_t first_128 = otherwise_128;

    for (size_t i = 0; i < sensor->waiting.count; i++) {
        int64_t time_128 = sensor->waiting.list[i].time_128;

        first_128 = time_128 < first_128 ? time_128 : first_128;
    }
    return first_128;
}

/*
 * Whether the radar has had no look: waiting plots may be placed in looks before the first
 * crossing.
 */
static bool is_before_first_look(const struct asterix_radar *sensor)
{
    return !sensor->has_closed && sensor->num_open == 0;
}

/*
 * Adds looks before the first one, back to the earliest waiting plot but at most one turn, at the
 * same rotation rate. Each is as wide as the first look, the earliest as wide as is left.
 */
static void add_looks_before_first(struct asterix_radar *sensor, const struct asterix_look *first)
{
    const int64_t turn_128 = asterix_look_turn_time_128(first);
    int64_t took_128 = first->start_128 - first_waiting_plot_time(sensor, first->start_128);
    uint32_t before, width; /* angle from the look's start to the first look; width of the look */

    if (!is_before_first_look(sensor)) {
        return;
    }
    took_128 = took_128 < turn_128 ? took_128 : turn_128;
    for (before = (uint32_t)(took_128 * ASTERIX_TURN / turn_128); before > 0; before -= width) {
        struct asterix_look look = {.from = (uint16_t)(first->from - before)};

        width = (before - 1) % first->advance + 1;
        look.advance = width;
        look.start_128 = first->start_128 - before * turn_128 / ASTERIX_TURN;
        look.end_128 = first->start_128 - (before - width) * turn_128 / ASTERIX_TURN;
        if (look.end_128 > look.start_128) {
            add_open_scan(sensor, &look, true);
        }
    }
}

static int64_t earliest_time_to_come(const struct asterix_radar *sensor, int64_t hold_128)
{
    int64_t settled_128 = sensor->clock_128 - hold_128;
    int64_t looks_128 = sensor->clock_128; /* start of the earliest look that is not complete */

    if (sensor->has_crossings && sensor->antenna.has_last && sensor->antenna.last_128 < looks_128) {
        looks_128 = sensor->antenna.last_128;
    }
    if (sensor->has_turn && sensor->turn.look.start_128 < looks_128) {
        looks_128 = sensor->turn.look.start_128;
    }
    for (size_t i = 0; i < sensor->num_open; i++) {
        int64_t start_128 = sensor->open[i].look.start_128;

        if (!sensor->open[i].has_look) {
            settled_128 = start_128 < settled_128 ? start_128 : settled_128;
        } else if (start_128 < looks_128) {
            looks_128 = start_128;
        }
    }
    looks_128 -= hold_128; /* a plot may be earlier than its look by hold_128 */
    settled_128 = looks_128 < settled_128 ? looks_128 : settled_128;
    return is_before_first_look(sensor) ? first_waiting_plot_time(sensor, settled_128)
                                        : settled_128;
}

int64_t asterix_radar_settled_time(struct asterix_radar *sensor, int64_t hold_128)
{
    int64_t settled_128 = earliest_time_to_come(sensor, hold_128);

    if (!sensor->has_settled || settled_128 > sensor->settled_128) {
        sensor->has_settled = true;
        sensor->settled_128 = settled_128;
    }
    return sensor->settled_128;
}

bool asterix_radar_end_look(struct asterix_radar *sensor, int64_t time_128, uint16_t azimuth,
                            int64_t hold_128, struct asterix_counts *counts)
{
    struct asterix_look look;
    bool is_gap;
    enum asterix_crossing crossing;

    if (!sensor->antenna.has_last && time_128 < asterix_radar_settled_time(sensor, hold_128)) {
        return false;
    }
    crossing = asterix_antenna_end_look(&sensor->antenna, time_128, azimuth, &look, &is_gap);
    sensor->has_crossings = true;
    counts->gaps += is_gap;
    if (crossing == ASTERIX_LOOKED) {
        add_looks_before_first(sensor, &look);
        add_open_scan(sensor, &look, true);
        place_waiting_plots(sensor, hold_128);
    }
    return crossing != ASTERIX_BACK;
}

void asterix_radar_place_plot(struct asterix_radar *sensor, const struct asterix_scan_plot *mark,
                              int64_t hold_128)
{
    if (!place_plot_in_look(sensor, mark, hold_128)) {
        add_plot_to_scan(&sensor->waiting, mark);
    }
}

/* The newest open scan that began before a time, else the oldest; NULL where none is open. */
static struct asterix_open_scan *find_scan_begun_before(struct asterix_radar *sensor,
                                                        int64_t time_128)
{
    size_t at = sensor->num_open;

    while (at > 1 && time_128 < sensor->open[at - 1].look.start_128) {
        at--;
    }
    return at > 0 ? &sensor->open[at - 1] : NULL;
}

void asterix_radar_add_timed_plot(struct asterix_radar *sensor,
                                  const struct asterix_scan_plot *mark, int64_t interval_128)
{
    struct asterix_look look = {.start_128 = mark->time_128,
                                .end_128 = mark->time_128 + interval_128,
                                .advance = ASTERIX_TURN};
    struct asterix_open_scan *open =
        interval_128 > 0 ? find_scan_begun_before(sensor, mark->time_128) : NULL;

    if (!open || mark->time_128 >= open->look.end_128) {
        add_plot_to_scan(&add_open_scan(sensor, &look, false)->marks, mark);
        return;
    }
    if (mark->time_128 < open->look.start_128) {
        open->look.start_128 = mark->time_128;
    }
    add_plot_to_scan(&open->marks, mark);
}

void asterix_radar_drop_waiting(struct asterix_radar *sensor, bool all,
                                struct asterix_counts *counts)
{
    size_t kept = 0;

    for (size_t i = 0; i < sensor->waiting.count; i++) {
        const struct asterix_scan_plot *mark = &sensor->waiting.list[i];

        if (!all && mark->time_128 >= sensor->clock_128 - WAIT_128) {
            sensor->waiting.list[kept++] = *mark;
        } else {
            counts->unplaced++;
        }
    }
    sensor->waiting.count = kept;
}

void asterix_radar_end_last_look(struct asterix_radar *sensor, int64_t hold_128)
{
    struct asterix_look look;

    if (sensor->waiting.count > 0 &&
        asterix_antenna_look_so_far(&sensor->antenna, sensor->clock_128, &look)) {
        add_open_scan(sensor, &look, true);
        place_waiting_plots(sensor, hold_128);
    }
    sensor->antenna.has_last = false;
}

struct asterix_open_scan asterix_radar_take_scan(struct asterix_radar *sensor)
{
    struct asterix_open_scan open = sensor->open[0];

    sensor->num_open--;
    memmove(sensor->open, sensor->open + 1, sensor->num_open * sizeof *sensor->open);
    sensor->has_closed = true;
    return open;
}

bool asterix_radar_extend_turn(struct asterix_radar *sensor, struct asterix_open_scan *open)
{
    struct asterix_open_scan *turn = &sensor->turn;

    if (!sensor->has_turn) {
        *turn = *open;
        sensor->has_turn = true;
        return true;
    }
    if (open->look.start_128 != turn->look.end_128 ||
        turn->look.advance + open->look.advance > ASTERIX_TURN) {
        return false;
    }
    turn->look.end_128 = open->look.end_128;
    turn->look.advance += open->look.advance;
    for (size_t i = 0; i < open->marks.count; i++) {
        add_plot_to_scan(&turn->marks, &open->marks.list[i]);
    }
    free(open->marks.list);
    return true;
}

void asterix_radar_free(struct asterix_radar *sensor)
{
    for (size_t i = 0; i < sensor->num_open; i++) {
        free(sensor->open[i].marks.list);
    }
    free(sensor->open);
    free(sensor->turn.marks.list);
    free(sensor->waiting.list);
}
