/* SPDX-License-Identifier: MIT */
/*
 * The rules of scan_assembler.h as a plain model: lists, wide integers, no memory saved. It is
 * given valid messages only; the test itself counts invalid ones.
 */
#ifndef SCAN_ASSEMBLER_MODEL_H
#define SCAN_ASSEMBLER_MODEL_H

#include "scan_assembler_setup.h"

#define MODEL_NUMBERS 4096

typedef __int128 wide;

enum model_verdict { M_NEXT, M_FOLLOW, M_DOUBLE, M_SKIPPED, M_LATE, M_NUMBER, M_TIME };
enum model_state { M_FREE, M_OPEN, M_WHOLE, M_OUT };

struct model_stray {
    struct rho_scan_assembler_place place;
    unsigned count;
};

struct model_source {
    int used, kind, id;
    unsigned believed, off;
    int64_t heard_us, bucket_us;
    wide interval_us, known_us;
    wide told_us, delay_us; /* its own time since it was heard first; of its newest scan */
    uint32_t bucket;
    int has_first,
        /* part 0 of its newest scan came; that scan was refused as newcomers share their turns */
        has_no_turn;
    struct look first; /* part 0 of its newest scan as first received */
    struct rho_scan_assembler_place place;
    /* accepted numbers since the last restart, oldest first */
    int32_t numbers[MODEL_NUMBERS];
    unsigned num_numbers;
    struct model_stray strays[RHO_SCAN_ASSEMBLER_STRAYS]; /* strays, newest first */
    unsigned num_strays;
};

struct model_scan {
    enum model_state state;
    struct model_source *source;
    int kind, id, num_parts;
    /* received behind a newer scan; no older number of its sensor is known */
    int is_late, is_alone;
    struct rho_scan_assembler_place place;
    int64_t heard_us;
    int is_here[8];
    struct look parts[8];
};

static struct {
    struct rho_scan_assembler_config config;
    struct rho_scan_assembler_counters counters;
    /* share: plots of all newcomers together */
    struct model_source sources[RHO_MAX_SENSORS], stranger, share;
    unsigned newcomers; /* scans of newcomers since another sensor's scan */
    struct model_scan scans[RHO_MAX_OPEN_SCANS];
    int64_t clock_us, out_us; /* out: time of the newest given scan, on this clock */
    int has_clock, has_out, is_restart, is_pressed;
} model;

static inline void model_start(const struct rho_scan_assembler_config *config)
{
    memset(&model, 0, sizeof model);
    model.config = *config;
    model.stranger.bucket = config->flood_per_s;
    model.share.bucket = config->stranger_plots_per_s;
}

/* Numbers and times of one sensor */

static inline wide model_elapsed_us(int64_t from_us, int64_t to_us)
{
    return to_us > from_us ? (wide)to_us - from_us : 0;
}

static inline wide model_time_difference_us(int64_t a, int64_t b)
{
    return a > b ? (wide)a - b : (wide)b - a;
}

/* Difference of scan numbers, the shorter way round their wrap. */
static inline wide model_numbers_ahead(int32_t scan, int32_t from)
{
    wide ahead = (wide)scan - from;
    const wide turn = (wide)1 << 32;

    return ahead >= turn / 2 ? ahead - turn : ahead < -turn / 2 ? ahead + turn : ahead;
}

static inline int model_is_plausible_successor(const struct rho_scan_assembler_place *next,
                                               const struct rho_scan_assembler_place *last)
{
    wide ahead = model_numbers_ahead(next->scan, last->scan);

    return next->epoch == last->epoch && ahead > 0 && ahead <= RHO_SCAN_ASSEMBLER_SKIP_MAX &&
           next->time_us > last->time_us &&
           model_time_difference_us(next->time_us, last->time_us) <= model.config.jump_max_us;
}

/* The stray with the most scans that this scan continues; of equals the last one. */
static inline int model_find_stray(const struct model_source *source,
                                   const struct rho_scan_assembler_place *place)
{
    int found = -1;

    for (unsigned i = 0; i < source->num_strays; i++) {
        if (model_is_plausible_successor(place, &source->strays[i].place) &&
            (found < 0 || source->strays[i].count > source->strays[found].count)) {
            found = (int)i;
        }
    }
    return found;
}

/* Of times as the library computes them: up to 2^32, by floats. */
static inline wide model_scale_us(wide time_us, wide part_us, wide whole_us)
{
    float scaled_us = (float)(uint32_t)(time_us < UINT32_MAX ? time_us : UINT32_MAX) *
                      ((float)(uint32_t)part_us / (float)(uint32_t)whole_us);

    return scaled_us < 4.29e9f ? (uint32_t)scaled_us : UINT32_MAX;
}

/* Time since its newest scan by a sensor's clock, which may be played faster or slower. */
static inline wide model_clock_progress_us(const struct model_source *source, int64_t now_us)
{
    wide age_us = model_elapsed_us(source->heard_us, now_us);

    return source->known_us > 0  ? model_scale_us(age_us, source->told_us, source->known_us)
           : age_us < UINT32_MAX ? age_us
                                 : UINT32_MAX;
}

/* By its own clock, a sensor's scan could have come so much earlier. */
static inline wide model_delay_us(const struct model_source *source, int64_t time_us,
                                  int64_t now_us)
{
    wide now_there = source->place.time_us + source->delay_us;

    now_there += model_clock_progress_us(source, now_us);
    return now_there > time_us ? now_there - time_us : 0;
}

/* A clock may have stood for three intervals, and be ahead by the delay of the newest scan. */
static inline wide model_clock_error_us(const struct model_source *source, int64_t time_us,
                                        wide delay_us, int64_t now_us)
{
    wide most_us = model_clock_progress_us(source, now_us), least_us = 3 * source->interval_us;
    wide first_us = source->place.time_us + (most_us < least_us ? most_us : least_us);
    wide last_us = source->place.time_us + most_us + source->delay_us;

    return time_us > last_us               ? time_us - last_us
           : time_us + delay_us < first_us ? first_us - time_us - delay_us
                                           : 0;
}

static inline wide model_clock_tolerance_us(const struct model_source *source, int share)
{
    wide most_us = model.config.hold_us + model.config.jump_max_us;

    if (source->known_us > 0) { /* at the pace at which a record is played, where it is fast */
        most_us = model.config.hold_us + model.config.jump_max_us / share;
        most_us = model_scale_us(
            most_us, source->told_us > source->known_us ? source->told_us : source->known_us,
            source->known_us);
    }
    return most_us;
}

static inline enum model_verdict
model_judge_time_step_of_newer_number(const struct model_source *source,
                                      const struct rho_scan_assembler_place *place, wide ahead,
                                      int64_t now_us)
{
    wide took = (wide)place->time_us - source->place.time_us, usual = ahead * source->interval_us;
    wide most = model_clock_tolerance_us(source, 64);

    if (took <= 0 || took > model.config.jump_max_us) {
        return M_TIME;
    }
    if (source->interval_us > 0 && (took > usual + most || took < usual - most) &&
        model_clock_error_us(source, place->time_us, 0, now_us) > most) {
        return M_TIME;
    }
    /* less than three quarters of the usual time, but for jitter */
    return source->interval_us > 0 && ahead > 1 && took + 10000 < usual - usual / 4 ? M_NUMBER
                                                                                    : M_NEXT;
}

/* Whether a number between the first and the newest one, 31 back at most, has not come. */
static inline int model_is_skipped_number(const struct model_source *source, int32_t scan)
{
    wide behind = model_numbers_ahead(source->place.scan, scan);

    for (unsigned i = 0; i < source->num_numbers; i++) {
        if (source->numbers[i] == scan) {
            return 0;
        }
    }
    return behind > 0 && behind <= 31 && source->num_numbers > 0 &&
           (model_numbers_ahead(scan, source->numbers[0]) > 0 ||
            (model.is_restart && RHO_MAX_SENSORS > 1));
}

/* Whether a scan is not too old after the scans already given. */
static inline int model_is_within_late_max_of_last_given(int kind, int64_t time_us)
{
    wide late_max = kind == RHO_SCAN_ASSEMBLER_BEARINGS ? 0 : model.config.late_max_us;

    return !model.has_out || (wide)model.out_us - time_us <= late_max;
}

static inline int
model_is_timely_scan_of_skipped_number(const struct model_source *source,
                                       const struct rho_scan_assembler_place *place)
{
    wide behind = model_numbers_ahead(source->place.scan, place->scan);
    wide before = (wide)source->place.time_us - place->time_us;
    wide usual = behind * source->interval_us;

    return source->off == 0 && model_is_skipped_number(source, place->scan) && before > 0 &&
           before + 10000 >= usual - usual / 4 && before <= usual + usual / 2 + 10000 &&
           model_is_within_late_max_of_last_given(source->kind, place->time_us);
}

/* No older number of the 31 before the newest has come, or the scan continues a stray. */
static inline int model_is_restart_candidate(const struct model_source *source,
                                             const struct rho_scan_assembler_place *place)
{
    for (unsigned i = 0; i < source->num_numbers; i++) {
        if (model_numbers_ahead(place->scan, source->numbers[i]) > 0 &&
            model_numbers_ahead(source->place.scan, source->numbers[i]) <= 31) {
            return RHO_MAX_SENSORS > 1 && model_find_stray(source, place) >= 0;
        }
    }
    return RHO_MAX_SENSORS > 1;
}

/* Whether a refused scan may be the beginning of the sensor's restart. */
static inline int model_is_stray(const struct model_source *source,
                                 const struct rho_scan_assembler_place *place,
                                 enum model_verdict verdict)
{
    return verdict == M_NUMBER || verdict == M_TIME ||
           ((verdict == M_DOUBLE || verdict == M_LATE) && place->scan != source->place.scan &&
            model_is_restart_candidate(source, place));
}

static inline enum model_verdict model_judge_scan(const struct model_source *source,
                                                  const struct rho_scan_assembler_place *place,
                                                  int64_t now_us)
{
    wide ahead = model_numbers_ahead(place->scan, source->place.scan);
    enum model_verdict verdict;
    int stray = model_find_stray(source, place);

    if (source->believed == 0) {
        return M_NEXT;
    }
    if (place->epoch != source->place.epoch || ahead > RHO_SCAN_ASSEMBLER_SKIP_MAX || ahead < -31) {
        verdict = M_NUMBER;
    } else if (ahead > 0) {
        verdict = model_judge_time_step_of_newer_number(source, place, ahead, now_us);
    } else if (ahead < 0 && place->time_us > source->place.time_us) {
        verdict = M_NUMBER;
    } else if (model_time_difference_us(place->time_us, source->place.time_us) >
               model.config.jump_max_us) {
        verdict = M_TIME;
    } else {
        verdict = model_is_timely_scan_of_skipped_number(source, place) ? M_SKIPPED : M_LATE;
        for (unsigned i = 0; i < source->num_numbers; i++) {
            verdict = source->numbers[i] == place->scan ? M_DOUBLE : verdict;
        }
    }
    if (model_is_stray(source, place, verdict) && stray >= 0 &&
        source->strays[stray].count + 1 >= model.config.follow_scans) {
        return M_FOLLOW;
    }
    return verdict;
}

static inline void model_remember_stray(struct model_source *source,
                                        const struct rho_scan_assembler_place *place)
{
    int at = model_find_stray(source, place);
    struct model_stray stray = {*place, at >= 0 ? source->strays[at].count + 1 : 1};

    for (unsigned i = 0; i < source->num_strays; i++) {
        if (memcmp(&source->strays[i].place, place, sizeof *place) == 0) {
            return;
        }
    }
    if (at < 0 && source->num_strays < RHO_SCAN_ASSEMBLER_STRAYS) {
        at = (int)source->num_strays++;
    } else if (at < 0) { /* of strays with fewest scans the oldest */
        at = 0;
        for (int i = 1; i < RHO_SCAN_ASSEMBLER_STRAYS; i++) {
            at = source->strays[i].count <= source->strays[at].count ? i : at;
        }
    }
    for (int i = at; i > 0; i--) {
        source->strays[i] = source->strays[i - 1];
    }
    source->strays[0] = stray;
}

static inline void model_accept_scan(struct model_source *source,
                                     const struct rho_scan_assembler_place *place,
                                     enum model_verdict verdict, int64_t now_us)
{
    int stray = model_find_stray(source, place), is_first = source->believed == 0;
    struct rho_scan_assembler_place from =
        verdict == M_FOLLOW ? source->strays[stray].place : source->place;
    wide ahead = model_numbers_ahead(place->scan, from.scan);
    wide more_us = model_elapsed_us(source->heard_us, now_us);

    source->delay_us =
        verdict == M_NEXT && !is_first ? model_delay_us(source, place->time_us, now_us) : 0;
    if (!is_first) {
        wide interval_us = ((wide)place->time_us - from.time_us) / ahead;
        if (verdict == M_NEXT && source->interval_us > 0) {
            interval_us = source->interval_us + (interval_us - source->interval_us) / 4;
        }
        source->interval_us = interval_us > 0 ? interval_us : 1;
        source->delay_us = model_scale_us(
            source->delay_us, model.config.jump_max_us - ((wide)place->time_us - from.time_us) / 2,
            model.config.jump_max_us);
    }
    if (verdict == M_NEXT && !is_first) {
        model.counters.scans_lost += (uint32_t)(ahead - 1);
    }
    if (verdict == M_FOLLOW || source->num_numbers == MODEL_NUMBERS) {
        source->num_numbers = 0;
    }
    source->numbers[source->num_numbers++] = place->scan;
    source->num_strays = 0;
    source->has_first = source->has_no_turn = 0;
    source->place = *place;
    if (!is_first && more_us <= model.config.jump_max_us &&
        more_us <= RHO_SCAN_ASSEMBLER_TRUST_US - source->known_us) {
        source->known_us += more_us;
        source->told_us += verdict == M_NEXT ? (wide)place->time_us - from.time_us : more_us;
        source->told_us = source->told_us > UINT32_MAX ? UINT32_MAX : source->told_us;
    }
    source->heard_us = now_us;
    source->believed++;
}

/* The common clock */

static inline int model_contradicts_time(const struct model_source *other, int64_t time_us,
                                         int64_t now_us)
{
    return model_clock_error_us(other, time_us, 0, now_us) > model_clock_tolerance_us(other, 8);
}

static inline int model_was_heard_lately(const struct model_source *source, int64_t now_us)
{
    return source->used && source->believed > 0 &&
           model_elapsed_us(source->heard_us, now_us) <= model.config.jump_max_us;
}

static inline int model_is_proven(const struct model_source *source)
{
    return source->believed >= model.config.follow_scans;
}

/* Silent for at most three of its intervals, or an eighth of jump_max_us. */
static inline int model_is_still_sending(const struct model_source *source, int64_t now_us)
{
    wide least_us = model.config.jump_max_us / 8, silent_us = 3 * source->interval_us;

    return model_was_heard_lately(source, now_us) &&
           model_elapsed_us(source->heard_us, now_us) <=
               (silent_us < least_us ? least_us : silent_us);
}

/*
 * Known for less than half the time of another sensor that still sends and was heard for a minute.
 */
static inline int model_is_newcomer(const struct model_source *source, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct model_source *other = &model.sources[i];
        wide half_us = other->known_us / 2;

        if (model_is_still_sending(other, now_us) && model_is_proven(other) &&
            other->known_us >= RHO_SCAN_ASSEMBLER_EQUALS_US &&
            (source ? source->known_us : 0) < half_us) {
            return 1;
        }
    }
    return 0;
}

static inline int model_has_vote(const struct model_source *source, int64_t now_us)
{
    return source->off == 0 && model_was_heard_lately(source, now_us) && model_is_proven(source) &&
           !model_is_newcomer(source, now_us);
}

/*
 * Early: no sensor with a vote has sent a scan as new, or has a clock that has reached this time.
 */
static inline int model_is_early_newcomer_scan(const struct model_scan *scan, int64_t now_us)
{
    int asked = 0;

    if (!model_is_newcomer(scan->source, scan->heard_us) || now_us == INT64_MAX) {
        return 0;
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        const struct model_scan *other = &model.scans[i];
        if (other->state == M_OPEN && other->place.time_us < scan->place.time_us &&
            !model_is_newcomer(other->source, scan->heard_us)) {
            return 1;
        }
    }
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct model_source *other = &model.sources[i];
        wide ahead = (wide)scan->place.time_us - other->place.time_us;

        if (model_has_vote(other, scan->heard_us)) {
            if (ahead <= 0 || (wide)now_us >= other->heard_us + ahead + model.config.hold_us) {
                return 0;
            }
            asked = 1;
        }
    }
    return asked;
}

/*
 * A clock that steps must come nearer to the others' than half of the step. One that was off comes
 * back as near as to its own. Without others, only a restart before scans that were given is off.
 */
static inline int model_is_outvoted(const struct model_source *source, int64_t time_us,
                                    enum model_verdict verdict, int64_t now_us)
{
    int yes[2] = {0}, no[2] = {0}, was_off = source->off >= model.config.follow_scans;
    wide delay_us =
        verdict == M_NEXT && source->believed > 0 ? model_delay_us(source, time_us, now_us) : 0;
    wide step_us = model_clock_error_us(source, time_us, 0, now_us);
    int is_step = verdict == M_FOLLOW && step_us > model_clock_tolerance_us(source, 64);

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct model_source *other = &model.sources[i];
        if (other != source && other->off == 0 && model_was_heard_lately(other, now_us)) {
            int p = model_has_vote(other, now_us), share = was_off && verdict == M_NEXT ? 64 : 8;
            wide error_us = model_clock_error_us(other, time_us, delay_us, now_us);
            int is_off = error_us > model_clock_tolerance_us(other, share) ||
                         (is_step && error_us > step_us / 2);

            yes[p] += !is_off;
            no[p] += is_off;
        }
    }
    if (yes[0] + no[0] + yes[1] + no[1] == 0 && RHO_MAX_SENSORS > 1 && verdict == M_FOLLOW &&
        model.has_out && time_us <= model.out_us) {
        return 1;
    }
    int p = yes[1] + no[1] > 0;
    return no[p] > yes[p] ||
           model_time_difference_us(time_us, model.clock_us) > model.config.jump_max_us;
}

static inline int model_wins_clock_vote(const struct model_source *source, int64_t time_us,
                                        int64_t now_us)
{
    unsigned with = 1, against = 0, right = 0;
    wide most_us = model.config.jump_max_us / 8 + model.config.hold_us;

    if (model_is_newcomer(source, now_us)) {
        return 0;
    }

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct model_source *other = &model.sources[i];
        if (other != source && model_was_heard_lately(other, now_us) &&
            !model_is_newcomer(other, now_us)) {
            against += other->off == 0 && model_is_proven(other);
            right += other->off == 0 && !model_contradicts_time(other, now_us, now_us);
            with += other->off >= model.config.follow_scans &&
                    !model_contradicts_time(other, time_us, now_us);
        }
    }
    if (with != against) {
        return with > against;
    }
    return right == 0 && model_time_difference_us(time_us, now_us) <= most_us;
}

static inline void model_restart_on_new_clock(int64_t time_us, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct model_source *source = &model.sources[i];
        if (!model_contradicts_time(source, time_us, now_us)) {
            source->off = 0;
        } else if (source->off == 0) {
            source->off = 1;
        }
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (model.scans[i].state == M_OPEN || model.scans[i].state == M_WHOLE) {
            model.scans[i].state = M_FREE;
            /* late scans were counted on arrival */
            model.counters.scans_late += !model.scans[i].is_late;
        }
    }
    model.is_restart = 1;
    model.has_out = 0;
}

static inline int model_update_clock(struct model_source *source, int64_t time_us,
                                     enum model_verdict verdict, int64_t now_us)
{
    if (model.has_clock && model_is_outvoted(source, time_us, verdict, now_us)) {
        source->off = verdict == M_FOLLOW && source->off < model.config.follow_scans
                          ? model.config.follow_scans
                          : source->off + (source->off < UINT8_MAX);
        if (source->off < model.config.follow_scans ||
            !model_wins_clock_vote(source, time_us, now_us)) {
            return 0;
        }
        model_restart_on_new_clock(time_us, now_us);
    }
    source->off = 0;
    model.clock_us =
        model.has_clock && model_is_newcomer(source, now_us) ? model.clock_us : time_us;
    model.has_clock = 1;
    return 1;
}

/* Messages */

static inline struct model_scan *model_scan_in_state(enum model_state state)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (model.scans[i].state == state) {
            return &model.scans[i];
        }
    }
    return NULL;
}

static inline unsigned model_count_parts(const struct model_scan *scan)
{
    unsigned count = 0;

    for (int i = 0; i < scan->num_parts; i++) {
        count += (unsigned)scan->is_here[i];
    }
    return count;
}

static inline void model_end_scan(struct model_scan *scan)
{
    scan->state = M_WHOLE;
    model.counters.scans_incomplete += model_count_parts(scan) < (unsigned)scan->num_parts;
}

static inline struct model_source *model_find_source(int kind, int id)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct model_source *source = &model.sources[i];
        if (source->used && source->kind == kind && source->id == id) {
            return source;
        }
    }
    return NULL;
}

static inline int model_is_open_scan_of(const struct model_scan *scan,
                                        const struct model_source *source)
{
    return source && scan->state == M_OPEN && scan->source == source;
}

static inline void model_end_scans_of(const struct model_source *source)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (model_is_open_scan_of(&model.scans[i], source)) {
            model_end_scan(&model.scans[i]);
        }
    }
}

static inline void model_wait_for_no_scan_before_those_of(const struct model_source *source)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        model.scans[i].is_alone |= model.scans[i].source == source;
    }
}

static inline struct model_source *model_find_place_for_source(int64_t now_us)
{
    struct model_source *room = NULL;

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct model_source *source = &model.sources[i];
        if (!source->used) {
            room = source;
            break;
        }
        wide silent_us = model_elapsed_us(source->heard_us, now_us);
        int is_kept = model_is_proven(source) && source->off == 0 &&
                      (silent_us <= model.config.jump_max_us || silent_us <= source->known_us);
        if (!is_kept && (!room || source->heard_us < room->heard_us)) {
            room = source;
        }
    }
    return room;
}

static inline void model_add_source(struct model_source *room, const struct look *look)
{
    model_end_scans_of(room);
    model_wait_for_no_scan_before_those_of(room);
    memset(room, 0, sizeof *room);
    room->used = 1;
    room->kind = look->kind;
    room->id = look->sensor_id;
    room->bucket = model.config.flood_per_s;
    room->bucket_us = model.stranger.bucket_us;
}

static inline int model_are_parts_equal(const struct look *a, const struct look *b)
{
    return a->time_us == b->time_us && a->scan == b->scan && a->epoch == b->epoch &&
           a->part == b->part && parts_of(a) == parts_of(b) && a->count == b->count &&
           a->tag == b->tag;
}

static inline void model_count_double(const struct model_source *source, const struct look *look)
{
    int is_other = look->part == 0 && look->scan == source->place.scan && source->has_first &&
                   !model_are_parts_equal(look, &source->first);

    model.counters.scans_other += (uint32_t)is_other;
    model.counters.scans_duplicate += !is_other;
}

static inline void model_add_part(struct model_scan *scan, const struct look *look, int64_t now_us)
{
    if (scan->is_here[look->part]) {
        model_count_double(scan->source, look);
    } else if (model_count_parts(scan) > 0 &&
               (look->time_us != scan->place.time_us || parts_of(look) != scan->num_parts)) {
        model.counters.scans_bad++;
    } else {
        scan->is_here[look->part] = 1;
        scan->parts[look->part] = *look;
        if (look->part == 0 && look->scan == scan->source->place.scan) {
            scan->source->has_first = 1;
            scan->source->first = *look;
        }
        scan->heard_us = now_us;
        model.counters.bearings_in += look->kind == RHO_SCAN_ASSEMBLER_BEARINGS ? look->count : 0;
        if (model_count_parts(scan) == (unsigned)scan->num_parts) {
            model_end_scan(scan);
        }
    }
}

/* Newcomers together may begin one scan between two scans of other sensors. */
static inline int model_take_newcomers_turn_to_begin_scan(int is_new)
{
    if (is_new && model.newcomers > 0) {
        model.counters.messages_flooded++;
        return 0;
    }
    model.newcomers = (unsigned)is_new;
    return 1;
}

static inline void model_begin_scan(struct model_source *source, const struct look *look,
                                    enum model_verdict verdict, int is_new, int64_t now_us)
{
    struct rho_scan_assembler_place place = {look->time_us, look->scan, look->epoch};
    struct model_scan *scan;
    int is_on_clock = 1;

    if (verdict == M_SKIPPED) {
        source->numbers[source->num_numbers++] = look->scan;
    } else {
        model_end_scans_of(source);
        if (verdict == M_FOLLOW) {
            model_wait_for_no_scan_before_those_of(source);
        }
        is_on_clock = model_update_clock(source, look->time_us, verdict, now_us);
        model_accept_scan(source, &place, verdict, now_us);
    }
    model.counters.sensor_restarts += verdict == M_FOLLOW;
    if (!is_on_clock) {
        model.counters.clock_jumps++;
        return;
    }
    if (verdict != M_SKIPPED && !model_take_newcomers_turn_to_begin_scan(is_new)) {
        source->has_no_turn = 1;
        return;
    }
    model.counters.scans_accepted++;
    scan = model_scan_in_state(M_FREE);
    *scan = (struct model_scan){.state = M_OPEN,
                                .source = source,
                                .kind = look->kind,
                                .id = look->sensor_id,
                                .num_parts = parts_of(look),
                                .is_late = verdict == M_SKIPPED,
                                .place = place};
    model_add_part(scan, look, now_us);
}

static inline void model_refuse_part(struct model_source *source, const struct look *look,
                                     enum model_verdict verdict)
{
    struct rho_scan_assembler_place place = {look->time_us, look->scan, look->epoch};

    if (model_is_stray(source, &place, verdict)) {
        model_remember_stray(source, &place);
    }
    model.counters.scans_bad += verdict == M_NUMBER;
    model.counters.clock_jumps += verdict == M_TIME || (verdict == M_DOUBLE && source->off > 0);
    if (verdict == M_DOUBLE && source->off == 0) {
        if (source->has_no_turn && look->scan == source->place.scan) {
            model.counters.messages_flooded++;
        } else {
            model_count_double(source, look);
        }
    }
    model.counters.scans_late += verdict == M_LATE;
}

static inline int model_draw_from_bucket(struct model_source *source, uint32_t count, uint32_t most,
                                         int64_t now_us)
{
    if (now_us < source->bucket_us || (wide)now_us - source->bucket_us >= SECOND_US) {
        source->bucket_us = now_us;
        source->bucket = most;
    }
    if (source->bucket < count) {
        model.counters.messages_flooded++;
        return 0;
    }
    source->bucket -= count;
    return 1;
}

/* Scans of newcomers and unproven sensors give way first. */
static inline struct model_scan *model_scan_of_weak_sensor(int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (model.scans[i].state == M_OPEN && (!model_is_proven(model.scans[i].source) ||
                                               model_is_newcomer(model.scans[i].source, now_us))) {
            return &model.scans[i];
        }
    }
    return NULL;
}

static inline struct model_scan *model_earliest_scan(enum model_state state, int64_t now_us)
{
    struct model_scan *first = NULL;

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct model_scan *scan = &model.scans[i];
        if (scan->state != state || model_is_early_newcomer_scan(scan, now_us)) {
            continue;
        }
        if (!first || scan->place.time_us < first->place.time_us ||
            (scan->place.time_us == first->place.time_us &&
             (scan->id < first->id || (scan->id == first->id && scan->kind < first->kind)))) {
            first = scan;
        }
    }
    return first;
}

/*
 * The whole scan given when another needs room; no proven sensor's scan becomes late or incomplete
 * by it.
 */
static inline struct model_scan *model_scan_given_for_room(int64_t now_us)
{
    struct model_scan *whole = model_earliest_scan(M_WHOLE, now_us);

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS && whole; i++) {
        struct model_scan *scan = &model.scans[i];

        if (scan->state == M_OPEN && model_is_proven(scan->source) &&
            !model_is_newcomer(scan->source, now_us) &&
            scan->place.time_us < whole->place.time_us) {
            return model_scan_of_weak_sensor(now_us);
        }
    }
    return whole ? whole : model_scan_of_weak_sensor(now_us);
}

static inline int model_is_waiting_scan_of_skipped_number(const struct model_scan *scan)
{
    return (scan->state == M_OPEN || scan->state == M_WHOLE) && scan->is_late;
}

static inline int model_has_open_late_scan(const struct model_source *source)
{
    int count = 0;

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        count += model_is_open_scan_of(&model.scans[i], source) && model.scans[i].is_late;
    }
    return count > 0;
}

static inline void model_drop_early_or_late_scan_for_room(int is_new, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct model_scan *scan = &model.scans[i];
        int is_waiting = scan->state == M_OPEN || scan->state == M_WHOLE;
        int is_early = is_waiting && !is_new && model_is_early_newcomer_scan(scan, now_us);

        int is_elder_s = is_new && !model_is_newcomer(scan->source, now_us);

        if (is_early || (model_is_waiting_scan_of_skipped_number(scan) && !is_elder_s)) {
            model.counters.sensors_no_room += (uint32_t)is_early;
            scan->state = M_FREE;
            return;
        }
    }
}

static inline void model_drop_too_late_scans(void)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct model_scan *scan = &model.scans[i];

        if (model_is_waiting_scan_of_skipped_number(scan) &&
            !model_is_within_late_max_of_last_given(scan->kind, scan->place.time_us)) {
            scan->state = M_FREE;
        }
    }
}

static inline enum rho_status model_take_part(const struct look *look, int64_t now_us)
{
    struct model_source *source = model_find_source(look->kind, look->sensor_id);
    int is_new = model_is_newcomer(source, now_us);
    struct model_source *drawn = source && !is_new ? source : &model.stranger;
    struct rho_scan_assembler_place place = {look->time_us, look->scan, look->epoch};
    enum model_verdict verdict;

    if (!model_draw_from_bucket(drawn, 1, model.config.flood_per_s, now_us) ||
        (is_new && !model_draw_from_bucket(&model.share, look->count,
                                           model.config.stranger_plots_per_s, now_us))) {
        return RHO_OK;
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct model_scan *scan = &model.scans[i];

        if (model_is_open_scan_of(scan, source) && scan->place.scan == look->scan &&
            scan->place.epoch == look->epoch) {
            model_add_part(scan, look, now_us);
            return RHO_OK;
        }
    }
    verdict = source ? model_judge_scan(source, &place, now_us) : M_NEXT;
    if (verdict != M_NEXT && verdict != M_FOLLOW && verdict != M_SKIPPED) {
        model_refuse_part(source, look, verdict);
        return RHO_OK;
    }
    if (verdict == M_SKIPPED) {
        if (model_take_newcomers_turn_to_begin_scan(is_new)) {
            model.counters.scans_late++;
            if (model_scan_in_state(M_FREE) &&
                (parts_of(look) == 1 || !model_has_open_late_scan(source))) {
                model_begin_scan(source, look, verdict, is_new, now_us);
            }
        }
        return RHO_OK;
    }
    if (!source && !model_find_place_for_source(now_us)) {
        model.counters.sensors_no_room++;
        return RHO_OK;
    }
    if (!model_scan_in_state(M_FREE)) {
        model_drop_early_or_late_scan_for_room(is_new, now_us);
    }
    if (!model_scan_in_state(M_FREE)) {
        int may_cut =
            (source && model_is_proven(source) && !is_new) || model_scan_given_for_room(now_us);

        if (!may_cut && !model_scan_in_state(M_OUT)) {
            model.counters.sensors_no_room++;
            return RHO_OK;
        }
        model.is_pressed = 1;
        drawn->bucket++;
        model.share.bucket += is_new ? look->count : 0u;
        return RHO_ERROR_CAPACITY;
    }
    if (!source) {
        source = model_find_place_for_source(now_us);
        model_add_source(source, look);
    }
    model_begin_scan(source, look, verdict, is_new, now_us);
    return RHO_OK;
}

/* Scans that are given */

static inline int model_was_held(const struct model_scan *scan, int64_t now_us)
{
    return now_us == INT64_MAX || (wide)now_us - scan->heard_us >= model.config.hold_us ||
           (wide)scan->heard_us - now_us > model.config.hold_us;
}

static inline int model_any_scan_was_held(int64_t now_us)
{
    int count = 0;

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        count += model.scans[i].state == M_WHOLE && model_was_held(&model.scans[i], now_us) &&
                 !model_is_early_newcomer_scan(&model.scans[i], now_us);
    }
    return count > 0;
}

static inline int model_is_no_older_scan_expected(const struct model_scan *scan, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct model_source *other = &model.sources[i];
        if (model_was_heard_lately(other, now_us) && other->off == 0 &&
            other->place.time_us < scan->place.time_us) {
            return 0;
        }
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        const struct model_scan *other = &model.scans[i];
        wide ahead = (wide)other->place.time_us - scan->place.time_us;

        if (other->state == M_OPEN && ahead < 0) {
            return 0;
        }
        /* the number before is missing, and one interval earlier is before this scan */
        if ((other->state == M_OPEN || other->state == M_WHOLE) && !other->is_late &&
            !other->is_alone &&
            model_is_skipped_number(other->source, (int32_t)((uint32_t)other->place.scan - 1u)) &&
            other->place.scan != other->source->numbers[0] &&
            (ahead < 0 ? 0 : ahead) < other->source->interval_us) {
            return 0;
        }
    }
    return 1;
}

/* The scan that is given next; NULL: none. It stays readable until the next call. */
static inline const struct model_scan *model_next_scan(int64_t now_us, int *is_restart)
{
    struct model_scan *scan = model_scan_in_state(M_OUT), *open;

    if (scan) {
        scan->state = M_FREE;
    }
    model.is_pressed = model.is_pressed && !model_scan_in_state(M_FREE);
    model_drop_too_late_scans();
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (model.scans[i].state == M_OPEN && model_was_held(&model.scans[i], now_us) &&
            (model.config.hold_us > 0 || now_us == INT64_MAX)) {
            model_end_scan(&model.scans[i]);
        }
    }
    scan = model_earliest_scan(M_WHOLE, now_us);
    open = model_earliest_scan(M_OPEN, now_us);
    if (model.is_pressed) {
        scan = model_scan_given_for_room(now_us) ? model_scan_given_for_room(now_us)
               : scan                            ? scan
                                                 : open;
        if (scan && scan->state == M_OPEN) {
            model_end_scan(scan);
        }
    } else if (scan && model.config.hold_us > 0 && model_any_scan_was_held(now_us) && open &&
               open->place.time_us < scan->place.time_us) {
        model_end_scan(open); /* it would be late after the given scan */
        scan = open;
    } else if (scan && !model_any_scan_was_held(now_us) &&
               !model_is_no_older_scan_expected(scan, now_us)) {
        return NULL;
    }
    model.is_pressed = 0;
    if (scan) {
        scan->state = M_OUT;
        model.out_us = model.has_out && model.out_us > scan->place.time_us ? model.out_us
                                                                           : scan->place.time_us;
        model.has_out = 1;
        *is_restart = model.is_restart;
        model.is_restart = 0;
    }
    return scan;
}

#endif
