/* SPDX-License-Identifier: MIT */
#include "io/asterix/asterix_antenna.h"

#include "io/asterix/asterix_codec.h"

#define TURN_MAX_128                                                                               \
    (60 * ASTERIX_TIME_HZ)              /* longest interval of crossings: a longer one is a pause */
#define AGAIN_128 (ASTERIX_TIME_HZ / 2) /* shorter than any radar's turn */

static int64_t absolute(int64_t value)
{
    return value < 0 ? -value : value;
}

int64_t asterix_look_turn_time_128(const struct asterix_look *look)
{
    return (look->end_128 - look->start_128) * ASTERIX_TURN / look->advance;
}

/*
 * Whether crossings are missing: the time since the newest one exceeds the expected time by more
 * than half a turn.
 */
static bool is_gap_before_crossing(const struct asterix_antenna *antenna, int64_t took_128,
                                   uint32_t advance)
{
    if (antenna->period_128 == 0) {
        return took_128 > TURN_MAX_128;
    }
    return took_128 - antenna->period_128 * advance / ASTERIX_TURN > antenna->period_128 / 2;
}

/* Whether the newest crossing is reported again: same azimuth, less than half a turn later. */
static bool is_repeated_crossing(const struct asterix_antenna *antenna, int64_t took_128,
                                 uint16_t azimuth)
{
    int64_t limit_128 = antenna->period_128 > 0 ? antenna->period_128 / 2 : AGAIN_128;

    return azimuth == antenna->last && absolute(took_128) < limit_128;
}

static enum asterix_crossing start_look_at_crossing(struct asterix_antenna *antenna,
                                                    int64_t time_128, uint16_t azimuth)
{
    antenna->has_last = true;
    antenna->last_128 = time_128;
    antenna->last = azimuth;
    return ASTERIX_BEGUN;
}

enum asterix_crossing asterix_antenna_end_look(struct asterix_antenna *antenna, int64_t time_128,
                                               uint16_t azimuth, struct asterix_look *look,
                                               bool *is_gap)
{
    int64_t took_128 = time_128 - antenna->last_128;
    uint32_t advance = (uint16_t)(azimuth - antenna->last);

    *is_gap = false;
    advance = advance == 0 ? ASTERIX_TURN : advance;
    if (!antenna->has_last) {
        return start_look_at_crossing(antenna, time_128, azimuth);
    }
    if (is_repeated_crossing(antenna, took_128, azimuth)) {
        return ASTERIX_AGAIN;
    }
    if (took_128 <= 0) {
        return ASTERIX_BACK;
    }
    if (is_gap_before_crossing(antenna, took_128, advance)) {
        *is_gap = true;
        return start_look_at_crossing(antenna, time_128, azimuth);
    }
    *look = (struct asterix_look){.start_128 = antenna->last_128,
                                  .end_128 = time_128,
                                  .from = antenna->last,
                                  .advance = advance};
    if (!antenna->is_period_said) {
        antenna->period_128 = asterix_look_turn_time_128(look);
    }
    start_look_at_crossing(antenna, time_128, azimuth);
    return ASTERIX_LOOKED;
}

bool asterix_look_covers_plot(const struct asterix_look *look, int64_t time_128, uint16_t azimuth,
                              int64_t *distance_128)
{
    uint32_t offset = (uint16_t)(azimuth - look->from);
    int64_t there_128;

    if (offset >= look->advance) {
        return false;
    }
    there_128 = look->start_128 + (look->end_128 - look->start_128) * offset / look->advance;
    *distance_128 = absolute(time_128 - there_128);
    return 2 * *distance_128 <= asterix_look_turn_time_128(look);
}

bool asterix_antenna_look_so_far(const struct asterix_antenna *antenna, int64_t time_128,
                                 struct asterix_look *look)
{
    int64_t took_128 = time_128 - antenna->last_128, advance;

    if (!antenna->has_last || antenna->period_128 == 0 || took_128 <= 0 ||
        took_128 > TURN_MAX_128) {
        return false;
    }
    advance = took_128 * ASTERIX_TURN / antenna->period_128;
    if (advance == 0 || advance > ASTERIX_TURN) {
        return false;
    }
    *look = (struct asterix_look){.start_128 = antenna->last_128,
                                  .end_128 = time_128,
                                  .from = antenna->last,
                                  .advance = (uint32_t)advance};
    return true;
}
