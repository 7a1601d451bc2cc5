/* SPDX-License-Identifier: MIT */
/*
 * What scan_assembler.h says, once more and in the plainest way: lists, wide integers, no memory
 * saved. Good messages alone are shown to it; what is no message is counted by the test.
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
    uint32_t bucket;
    int has_first,
        has_no_turn;   /* of its newest scan: its part 0 came; it was refused for want of a turn */
    struct look first; /* part 0 of its newest scan, as it came first */
    struct rho_scan_assembler_place place;
    /* believed since it began or was followed, the first one first */
    int32_t numbers[MODEL_NUMBERS];
    unsigned num_numbers;
    struct model_stray strays[RHO_SCAN_ASSEMBLER_STRAYS]; /* the last one first */
    unsigned num_strays;
};

struct model_scan {
    enum model_state state;
    struct model_source *source;
    int kind, id, num_parts;
    int is_late, is_alone; /* came behind a newer one; its sensor's numbers hold no more */
    struct rho_scan_assembler_place place;
    int64_t heard_us;
    int is_here[8];
    struct look parts[8];
};

static struct {
    struct rho_scan_assembler_config config;
    struct rho_scan_assembler_counters counters;
    struct model_source sources[RHO_MAX_SENSORS], stranger, share; /* share: plots of newcomers */
    unsigned newcomers; /* scans, since another sensor's */
    struct model_scan scans[RHO_MAX_OPEN_SCANS];
    int64_t clock_us, out_us; /* out: the newest one that went out, on this clock */
    int has_clock, has_out, is_restart, is_pressed;
} model;

static inline void model_start(const struct rho_scan_assembler_config *config)
{
    memset(&model, 0, sizeof model);
    model.config = *config;
    model.stranger.bucket = config->flood_per_s;
    model.share.bucket = config->stranger_plots_per_s;
}

/*
 * ---- numbers and times of one sensor ----------------------------------------------------------
 */

static inline wide model_past(int64_t from_us, int64_t to_us)
{
    return to_us > from_us ? (wide)to_us - from_us : 0;
}

static inline wide model_apart(int64_t a, int64_t b)
{
    return a > b ? (wide)a - b : (wide)b - a;
}

/* The shorter way round from one number to another. */
static inline wide model_ahead(int32_t scan, int32_t from)
{
    wide ahead = (wide)scan - from;
    const wide turn = (wide)1 << 32;

    return ahead >= turn / 2 ? ahead - turn : ahead < -turn / 2 ? ahead + turn : ahead;
}

static inline int model_agrees(const struct rho_scan_assembler_place *next,
                               const struct rho_scan_assembler_place *last)
{
    wide ahead = model_ahead(next->scan, last->scan);

    return next->epoch == last->epoch && ahead > 0 && ahead <= RHO_SCAN_ASSEMBLER_SKIP_MAX &&
           next->time_us > last->time_us &&
           model_apart(next->time_us, last->time_us) <= model.config.jump_max_us;
}

/* The stray with the most scans that it agrees with; of equals the last one. */
static inline int model_find_stray(const struct model_source *source,
                                   const struct rho_scan_assembler_place *place)
{
    int found = -1;

    for (unsigned i = 0; i < source->num_strays; i++) {
        if (model_agrees(place, &source->strays[i].place) &&
            (found < 0 || source->strays[i].count > source->strays[found].count)) {
            found = (int)i;
        }
    }
    return found;
}

static inline enum model_verdict model_judge_ahead(const struct model_source *source,
                                                   const struct rho_scan_assembler_place *place,
                                                   wide ahead, int64_t now_us)
{
    wide took = (wide)place->time_us - source->place.time_us;
    wide usual = ahead * source->interval_us, silent = model_past(source->heard_us, now_us);
    wide longest = usual > silent ? usual : silent, most = longest + longest / 2 + 10000;

    if (took <= 0 || took > model.config.jump_max_us) {
        return M_TIME;
    }
    if (source->interval_us > 0 && took > most) {
        return M_TIME;
    }
    /* less than three quarters of the usual time, but for jitter */
    return source->interval_us > 0 && ahead > 1 && took + 10000 < usual - usual / 4 ? M_NUMBER
                                                                                    : M_NEXT;
}

/* Between the first number and the newest one, 31 back at most, and it has not come. */
static inline int model_is_skipped(const struct model_source *source, int32_t scan)
{
    wide behind = model_ahead(source->place.scan, scan);

    for (unsigned i = 0; i < source->num_numbers; i++) {
        if (source->numbers[i] == scan) {
            return 0;
        }
    }
    return behind > 0 && behind <= 31 && source->num_numbers > 0 &&
           (model_ahead(scan, source->numbers[0]) > 0 || (model.is_restart && RHO_MAX_SENSORS > 1));
}

/* Not behind what has gone out by more than a tracker takes. */
static inline int model_is_in_time(int kind, int64_t time_us)
{
    wide late_max = kind == RHO_SCAN_ASSEMBLER_BEARINGS ? 0 : model.config.late_max_us;

    return !model.has_out || (wide)model.out_us - time_us <= late_max;
}

static inline int model_is_of_use(const struct model_source *source,
                                  const struct rho_scan_assembler_place *place)
{
    wide behind = model_ahead(source->place.scan, place->scan);
    wide before = (wide)source->place.time_us - place->time_us;
    wide usual = behind * source->interval_us;

    return source->off == 0 && model_is_skipped(source, place->scan) && before > 0 &&
           before + 10000 >= usual - usual / 4 && before <= usual + usual / 2 + 10000 &&
           model_is_in_time(source->kind, place->time_us);
}

/* No older number, of those 31 back at most, has come; or the scans before it were such. */
static inline int model_begins_again(const struct model_source *source,
                                     const struct rho_scan_assembler_place *place)
{
    for (unsigned i = 0; i < source->num_numbers; i++) {
        if (model_ahead(place->scan, source->numbers[i]) > 0 &&
            model_ahead(source->place.scan, source->numbers[i]) <= 31) {
            return RHO_MAX_SENSORS > 1 && model_find_stray(source, place) >= 0;
        }
    }
    return RHO_MAX_SENSORS > 1;
}

/* Refused, but a restart of the sensor if more of the kind come. */
static inline int model_is_stray(const struct model_source *source,
                                 const struct rho_scan_assembler_place *place,
                                 enum model_verdict verdict)
{
    return verdict == M_NUMBER || verdict == M_TIME ||
           ((verdict == M_DOUBLE || verdict == M_LATE) && place->scan != source->place.scan &&
            model_begins_again(source, place));
}

static inline enum model_verdict model_judge(const struct model_source *source,
                                             const struct rho_scan_assembler_place *place,
                                             int64_t now_us)
{
    wide ahead = model_ahead(place->scan, source->place.scan);
    enum model_verdict verdict;
    int stray = model_find_stray(source, place);

    if (source->believed == 0) {
        return M_NEXT;
    }
    if (place->epoch != source->place.epoch || ahead > RHO_SCAN_ASSEMBLER_SKIP_MAX || ahead < -31) {
        verdict = M_NUMBER;
    } else if (ahead > 0) {
        verdict = model_judge_ahead(source, place, ahead, now_us);
    } else if (ahead < 0 && place->time_us > source->place.time_us) {
        verdict = M_NUMBER;
    } else if (model_apart(place->time_us, source->place.time_us) > model.config.jump_max_us) {
        verdict = M_TIME;
    } else {
        verdict = model_is_of_use(source, place) ? M_SKIPPED : M_LATE;
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
    } else if (at < 0) { /* of the fewest scans the one that is there longest */
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

static inline void model_believe(struct model_source *source,
                                 const struct rho_scan_assembler_place *place,
                                 enum model_verdict verdict, int64_t now_us)
{
    int stray = model_find_stray(source, place), is_first = source->believed == 0;
    struct rho_scan_assembler_place from =
        verdict == M_FOLLOW ? source->strays[stray].place : source->place;
    wide ahead = model_ahead(place->scan, from.scan);

    if (!is_first) {
        wide interval_us = ((wide)place->time_us - from.time_us) / ahead;
        if (verdict == M_NEXT && source->interval_us > 0) {
            interval_us = source->interval_us + (interval_us - source->interval_us) / 4;
        }
        source->interval_us = interval_us > 0 ? interval_us : 1;
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
    if (!is_first && model_past(source->heard_us, now_us) <= model.config.jump_max_us) {
        source->known_us += model_past(source->heard_us, now_us);
    }
    source->known_us = source->known_us > RHO_SCAN_ASSEMBLER_TRUST_US ? RHO_SCAN_ASSEMBLER_TRUST_US
                                                                      : source->known_us;
    source->heard_us = now_us;
    source->believed++;
}

/*
 * ---- the common clock -------------------------------------------------------------------------
 */

static inline wide model_lead(void)
{
    return model.config.jump_max_us / 8 + model.config.hold_us;
}

static inline int model_says_other(const struct model_source *other, int64_t time_us,
                                   int64_t now_us)
{
    wide now_there = model_past(other->heard_us, now_us);
    wide lead = other->interval_us > 0 ? model_lead()
                                       : (wide)model.config.jump_max_us + model.config.hold_us;

    if (now_there < 2 * other->interval_us) {
        now_there = 2 * other->interval_us;
    }
    return (wide)time_us > other->place.time_us + now_there + lead ||
           (wide)time_us < other->place.time_us - lead;
}

static inline int model_is_live(const struct model_source *source, int64_t now_us)
{
    return source->used && source->believed > 0 &&
           model_past(source->heard_us, now_us) <= model.config.jump_max_us;
}

static inline int model_is_proven(const struct model_source *source)
{
    return source->believed >= model.config.follow_scans;
}

/* Three of its intervals, an eighth to half of jump_max_us; one and a quarter of them anyhow. */
static inline int model_is_present(const struct model_source *source, int64_t now_us)
{
    wide least_us = model.config.jump_max_us / 8, most_us = model.config.jump_max_us / 2;
    wide silent_us = 3 * (wide)source->interval_us;
    wide next_us = (wide)source->interval_us + source->interval_us / 4;

    silent_us = silent_us < least_us ? least_us : silent_us > most_us ? most_us : silent_us;
    silent_us = silent_us < next_us ? next_us : silent_us;
    return model_is_live(source, now_us) && model_past(source->heard_us, now_us) <= silent_us;
}

/* Less than half as long heard as another one that still sends, which is heard for a minute. */
static inline int model_is_new(const struct model_source *source, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct model_source *other = &model.sources[i];
        wide half_us = other->known_us / 2;

        if (model_is_present(other, now_us) && model_is_proven(other) &&
            other->known_us >= RHO_SCAN_ASSEMBLER_EQUALS_US &&
            (source ? source->known_us : 0) < half_us) {
            return 1;
        }
    }
    return 0;
}

static inline int model_has_say(const struct model_source *source, int64_t now_us)
{
    return source->off == 0 && model_is_live(source, now_us) && model_is_proven(source) &&
           !model_is_new(source, now_us);
}

/*
 * Nobody who has a say has sent what is not older, nor says by its own clock that what it sends for
 * then is here.
 */
static inline int model_is_early(const struct model_scan *scan, int64_t now_us)
{
    int asked = 0;

    if (!model_is_new(scan->source, scan->heard_us) || now_us == INT64_MAX) {
        return 0;
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        const struct model_scan *other = &model.scans[i];
        if (other->state == M_OPEN && other->place.time_us < scan->place.time_us &&
            !model_is_new(other->source, scan->heard_us)) {
            return 1;
        }
    }
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct model_source *other = &model.sources[i];
        wide ahead = (wide)scan->place.time_us - other->place.time_us;

        if (model_has_say(other, scan->heard_us)) {
            if (ahead <= 0 || (wide)now_us >= other->heard_us + ahead + model.config.hold_us) {
                return 0;
            }
            asked = 1;
        }
    }
    return asked;
}

static inline int model_is_off(const struct model_source *source, int64_t time_us, int64_t now_us)
{
    int yes[2] = {0}, no[2] = {0};

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct model_source *other = &model.sources[i];
        if (other != source && other->off == 0 && model_is_live(other, now_us)) {
            int p = model_has_say(other, now_us);
            yes[p] += !model_says_other(other, time_us, now_us);
            no[p] += model_says_other(other, time_us, now_us);
        }
    }
    int p = yes[1] + no[1] > 0;
    return model.has_clock &&
           (no[p] > yes[p] || model_apart(time_us, model.clock_us) > model.config.jump_max_us);
}

/* The sensor restarts not behind what has gone out, and nobody else tells the time. */
static inline int model_is_set_back(const struct model_source *source, int64_t time_us,
                                    int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct model_source *other = &model.sources[i];
        if (other != source && other->off == 0 && model_is_live(other, now_us)) {
            return 0;
        }
    }
    return RHO_MAX_SENSORS > 1 && model.has_out && time_us <= model.out_us;
}

static inline int model_wins(const struct model_source *source, int64_t time_us, int64_t now_us)
{
    unsigned with = 1, against = 0;

    if (model_is_new(source, now_us)) {
        return 0;
    }

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct model_source *other = &model.sources[i];
        if (other != source && model_is_live(other, now_us) && !model_is_new(other, now_us)) {
            against += other->off == 0 && model_is_proven(other);
            with += other->off >= model.config.follow_scans &&
                    !model_says_other(other, time_us, now_us);
        }
    }
    if (with != against) {
        return with > against;
    }
    return model_apart(time_us, now_us) <= model_lead() &&
           model_apart(model.clock_us, now_us) > model_lead();
}

static inline void model_set_clock(int64_t time_us, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct model_source *source = &model.sources[i];
        if (!model_says_other(source, time_us, now_us)) {
            source->off = 0;
        } else if (source->off == 0) {
            source->off = 1;
        }
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (model.scans[i].state == M_OPEN || model.scans[i].state == M_WHOLE) {
            model.scans[i].state = M_FREE;
            model.counters.scans_late += !model.scans[i].is_late; /* else it was counted */
        }
    }
    model.is_restart = 1;
    model.has_out = 0;
}

static inline int model_keeps_clock(struct model_source *source, int64_t time_us,
                                    enum model_verdict verdict, int64_t now_us)
{
    if (model_is_off(source, time_us, now_us) ||
        (verdict == M_FOLLOW && model_is_set_back(source, time_us, now_us))) {
        source->off = verdict == M_FOLLOW && source->off < model.config.follow_scans
                          ? model.config.follow_scans
                          : source->off + (source->off < UINT8_MAX);
        if (source->off < model.config.follow_scans || !model_wins(source, time_us, now_us)) {
            return 0;
        }
        model_set_clock(time_us, now_us);
    }
    source->off = 0;
    model.clock_us = model.has_clock && model_is_new(source, now_us) ? model.clock_us : time_us;
    model.has_clock = 1;
    return 1;
}

/*
 * ---- messages ---------------------------------------------------------------------------------
 */

static inline struct model_scan *model_in_state(enum model_state state)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (model.scans[i].state == state) {
            return &model.scans[i];
        }
    }
    return NULL;
}

static inline unsigned model_parts_here(const struct model_scan *scan)
{
    unsigned count = 0;

    for (int i = 0; i < scan->num_parts; i++) {
        count += (unsigned)scan->is_here[i];
    }
    return count;
}

static inline void model_close(struct model_scan *scan)
{
    scan->state = M_WHOLE;
    model.counters.scans_incomplete += model_parts_here(scan) < (unsigned)scan->num_parts;
}

static inline struct model_source *model_find(int kind, int id)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct model_source *source = &model.sources[i];
        if (source->used && source->kind == kind && source->id == id) {
            return source;
        }
    }
    return NULL;
}

static inline int model_is_open_of(const struct model_scan *scan, const struct model_source *source)
{
    return source && scan->state == M_OPEN && scan->source == source;
}

static inline void model_close_all_of(const struct model_source *source)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (model_is_open_of(&model.scans[i], source)) {
            model_close(&model.scans[i]);
        }
    }
}

static inline void model_forget_numbers_of(const struct model_source *source)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        model.scans[i].is_alone |= model.scans[i].source == source;
    }
}

static inline struct model_source *model_find_room(int64_t now_us)
{
    struct model_source *room = NULL;

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct model_source *source = &model.sources[i];
        if (!source->used) {
            room = source;
            break;
        }
        int is_kept = model_is_proven(source) && source->off == 0 &&
                      model_past(source->heard_us, now_us) <= model.config.jump_max_us;
        if (!is_kept && (!room || source->heard_us < room->heard_us)) {
            room = source;
        }
    }
    return room;
}

static inline void model_add(struct model_source *room, const struct look *look)
{
    model_close_all_of(room);
    model_forget_numbers_of(room);
    memset(room, 0, sizeof *room);
    room->used = 1;
    room->kind = look->kind;
    room->id = look->sensor_id;
    room->bucket = model.config.flood_per_s;
    room->bucket_us = model.stranger.bucket_us;
}

static inline int model_is_same(const struct look *a, const struct look *b)
{
    return a->time_us == b->time_us && a->scan == b->scan && a->epoch == b->epoch &&
           a->part == b->part && parts_of(a) == parts_of(b) && a->count == b->count &&
           a->tag == b->tag;
}

static inline void model_count_double(const struct model_source *source, const struct look *look)
{
    int is_other = look->part == 0 && look->scan == source->place.scan && source->has_first &&
                   !model_is_same(look, &source->first);

    model.counters.scans_other += (uint32_t)is_other;
    model.counters.scans_duplicate += !is_other;
}

static inline void model_add_part(struct model_scan *scan, const struct look *look, int64_t now_us)
{
    if (scan->is_here[look->part]) {
        model_count_double(scan->source, look);
    } else if (model_parts_here(scan) > 0 &&
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
        if (model_parts_here(scan) == (unsigned)scan->num_parts) {
            model_close(scan);
        }
    }
}

/* One of all newcomers together between two of the others. */
static inline int model_may_begin(int is_new)
{
    if (is_new && model.newcomers > 0) {
        model.counters.messages_flooded++;
        return 0;
    }
    model.newcomers = (unsigned)is_new;
    return 1;
}

static inline void model_begin(struct model_source *source, const struct look *look,
                               enum model_verdict verdict, int is_new, int64_t now_us)
{
    struct rho_scan_assembler_place place = {look->time_us, look->scan, look->epoch};
    struct model_scan *scan;

    if (verdict == M_SKIPPED) {
        source->numbers[source->num_numbers++] = look->scan;
    } else {
        model_close_all_of(source);
        if (verdict == M_FOLLOW) {
            model_forget_numbers_of(source);
        }
        model_believe(source, &place, verdict, now_us);
    }
    model.counters.sensor_restarts += verdict == M_FOLLOW;
    if (verdict != M_SKIPPED && !model_keeps_clock(source, look->time_us, verdict, now_us)) {
        model.counters.clock_jumps++;
        return;
    }
    if (verdict != M_SKIPPED && !model_may_begin(is_new)) {
        source->has_no_turn = 1;
        return;
    }
    model.counters.scans_accepted++;
    scan = model_in_state(M_FREE);
    *scan = (struct model_scan){.state = M_OPEN,
                                .source = source,
                                .kind = look->kind,
                                .id = look->sensor_id,
                                .num_parts = parts_of(look),
                                .is_late = verdict == M_SKIPPED,
                                .place = place};
    model_add_part(scan, look, now_us);
}

static inline void model_refuse(struct model_source *source, const struct look *look,
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

static inline int model_draw(struct model_source *source, uint32_t count, uint32_t most,
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

/* Newcomers' scans that are early count for little. */
static inline struct model_scan *model_weak_one(int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (model.scans[i].state == M_OPEN && (!model_is_proven(model.scans[i].source) ||
                                               model_is_new(model.scans[i].source, now_us))) {
            return &model.scans[i];
        }
    }
    return NULL;
}

static inline struct model_scan *model_first(enum model_state state, int64_t now_us)
{
    struct model_scan *first = NULL;

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct model_scan *scan = &model.scans[i];
        if (scan->state != state || model_is_early(scan, now_us)) {
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
 * It goes out where another needs room; no proven sensor's scan is made late or cut short by that.
 */
static inline struct model_scan *model_spare_one(int64_t now_us)
{
    struct model_scan *whole = model_first(M_WHOLE, now_us);

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS && whole; i++) {
        struct model_scan *scan = &model.scans[i];

        if (scan->state == M_OPEN && model_is_proven(scan->source) &&
            !model_is_new(scan->source, now_us) && scan->place.time_us < whole->place.time_us) {
            return model_weak_one(now_us);
        }
    }
    return whole ? whole : model_weak_one(now_us);
}

static inline int model_is_late_one(const struct model_scan *scan)
{
    return (scan->state == M_OPEN || scan->state == M_WHOLE) && scan->is_late;
}

static inline int model_open_late_one_of(const struct model_source *source)
{
    int count = 0;

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        count += model_is_open_of(&model.scans[i], source) && model.scans[i].is_late;
    }
    return count > 0;
}

static inline void model_drop_one(int is_new, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct model_scan *scan = &model.scans[i];
        int is_waiting = scan->state == M_OPEN || scan->state == M_WHOLE;
        int is_early = is_waiting && !is_new && model_is_early(scan, now_us);

        int is_elder_s = is_new && !model_is_new(scan->source, now_us);

        if (is_early || (model_is_late_one(scan) && !is_elder_s)) {
            model.counters.sensors_no_room += (uint32_t)is_early;
            scan->state = M_FREE;
            return;
        }
    }
}

static inline void model_drop_useless(void)
{
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct model_scan *scan = &model.scans[i];

        if (model_is_late_one(scan) && !model_is_in_time(scan->kind, scan->place.time_us)) {
            scan->state = M_FREE;
        }
    }
}

static inline enum rho_status model_take(const struct look *look, int64_t now_us)
{
    struct model_source *source = model_find(look->kind, look->sensor_id);
    int is_new = model_is_new(source, now_us);
    struct model_source *drawn = source && !is_new ? source : &model.stranger;
    struct rho_scan_assembler_place place = {look->time_us, look->scan, look->epoch};
    enum model_verdict verdict;

    if (!model_draw(drawn, 1, model.config.flood_per_s, now_us) ||
        (is_new &&
         !model_draw(&model.share, look->count, model.config.stranger_plots_per_s, now_us))) {
        return RHO_OK;
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct model_scan *scan = &model.scans[i];

        if (model_is_open_of(scan, source) && scan->place.scan == look->scan &&
            scan->place.epoch == look->epoch) {
            model_add_part(scan, look, now_us);
            return RHO_OK;
        }
    }
    verdict = source ? model_judge(source, &place, now_us) : M_NEXT;
    if (verdict != M_NEXT && verdict != M_FOLLOW && verdict != M_SKIPPED) {
        model_refuse(source, look, verdict);
        return RHO_OK;
    }
    if (verdict == M_SKIPPED) {
        if (model_may_begin(is_new)) {
            model.counters.scans_late++;
            if (model_in_state(M_FREE) &&
                (parts_of(look) == 1 || !model_open_late_one_of(source))) {
                model_begin(source, look, verdict, is_new, now_us);
            }
        }
        return RHO_OK;
    }
    if (!source && !model_find_room(now_us)) {
        model.counters.sensors_no_room++;
        return RHO_OK;
    }
    if (!model_in_state(M_FREE)) {
        model_drop_one(is_new, now_us);
    }
    if (!model_in_state(M_FREE)) {
        int may_cut = (source && model_is_proven(source) && !is_new) || model_spare_one(now_us);

        if (!may_cut && !model_in_state(M_OUT)) {
            model.counters.sensors_no_room++;
            return RHO_OK;
        }
        model.is_pressed = 1;
        drawn->bucket++;
        model.share.bucket += is_new ? look->count : 0u;
        return RHO_ERROR_CAPACITY;
    }
    if (!source) {
        source = model_find_room(now_us);
        model_add(source, look);
    }
    model_begin(source, look, verdict, is_new, now_us);
    return RHO_OK;
}

/*
 * ---- what goes out ----------------------------------------------------------------------------
 */

static inline int model_was_held(const struct model_scan *scan, int64_t now_us)
{
    return now_us == INT64_MAX || (wide)now_us - scan->heard_us >= model.config.hold_us ||
           (wide)scan->heard_us - now_us > model.config.hold_us;
}

static inline int model_one_was_held(int64_t now_us)
{
    int count = 0;

    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        count += model.scans[i].state == M_WHOLE && model_was_held(&model.scans[i], now_us) &&
                 !model_is_early(&model.scans[i], now_us);
    }
    return count > 0;
}

static inline int model_has_turn(const struct model_scan *scan, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct model_source *other = &model.sources[i];
        if (model_is_live(other, now_us) && other->off == 0 &&
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
        /* the number before it is missing, and one interval earlier is before this scan */
        if ((other->state == M_OPEN || other->state == M_WHOLE) && !other->is_late &&
            !other->is_alone &&
            model_is_skipped(other->source, (int32_t)((uint32_t)other->place.scan - 1u)) &&
            other->place.scan != other->source->numbers[0] &&
            (ahead < 0 ? 0 : ahead) < other->source->interval_us) {
            return 0;
        }
    }
    return 1;
}

/* The scan that goes out; NULL: none. It stays readable until the next call. */
static inline const struct model_scan *model_next(int64_t now_us, int *is_restart)
{
    struct model_scan *scan = model_in_state(M_OUT), *open;

    if (scan) {
        scan->state = M_FREE;
    }
    model.is_pressed = model.is_pressed && !model_in_state(M_FREE);
    model_drop_useless();
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        if (model.scans[i].state == M_OPEN && model_was_held(&model.scans[i], now_us) &&
            (model.config.hold_us > 0 || now_us == INT64_MAX)) {
            model_close(&model.scans[i]);
        }
    }
    scan = model_first(M_WHOLE, now_us);
    open = model_first(M_OPEN, now_us);
    if (model.is_pressed) {
        scan = model_spare_one(now_us) ? model_spare_one(now_us) : scan ? scan : open;
        if (scan && scan->state == M_OPEN) {
            model_close(scan);
        }
    } else if (scan && model.config.hold_us > 0 && model_one_was_held(now_us) && open &&
               open->place.time_us < scan->place.time_us) {
        model_close(open); /* it would be late */
        scan = open;
    } else if (scan && !model_one_was_held(now_us) && !model_has_turn(scan, now_us)) {
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
