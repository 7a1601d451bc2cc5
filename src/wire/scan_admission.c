/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "policy.h"
#include "scan_internal.h"

enum { SEEN_SCANS = 32 /* scan numbers in source.seen: its bits */ };

/* Numbers */

static int are_near_times(int64_t a_us, int64_t b_us, int64_t most_us)
{
    return rho_elapsed_us(a_us, b_us) <= (uint64_t)most_us &&
           rho_elapsed_us(b_us, a_us) <= (uint64_t)most_us;
}

/* Difference of two scan numbers, which wrap at 32 bits. */
static int32_t scan_number_difference(int32_t scan, int32_t from)
{
    int64_t difference = (int64_t)scan - from;
    if (difference > INT32_MAX) {
        difference -= (int64_t)1 << 32;
    } else if (difference < INT32_MIN) {
        difference += (int64_t)1 << 32;
    }
    return (int32_t)difference;
}

static int is_later_within_jump(const struct rho_scan_assembler_config *config, int64_t time_us,
                                int64_t from_us)
{
    return time_us > from_us && are_near_times(time_us, from_us, config->jump_max_us);
}

/* 1 where took_us, less jitter, is above 3/2 of longest_us; 64 bits do not overflow. */
static int is_over_3_halves(uint64_t took_us, uint64_t longest_us)
{
    return took_us > JITTER_US && took_us - JITTER_US > longest_us &&
           took_us - JITTER_US - longest_us > longest_us / 2;
}

/* 1 where took_us, with jitter, is below 3/4 of usual_us. */
static int is_under_3_quarters(uint64_t took_us, uint64_t usual_us)
{
    return took_us + JITTER_US < usual_us - usual_us / 4;
}

/* Classifies a scan by its number and time against its sensor's newest scan. */
static enum scan_verdict classify_by_sequence(const struct rho_scan_assembler_config *config,
                                              const struct rho_scan_assembler_source *source,
                                              const struct rho_scan_assembler_place *place,
                                              int64_t now_us)
{
    const struct rho_scan_assembler_place *newest = &source->place;
    const int32_t ahead = scan_number_difference(place->scan, newest->scan);
    if (place->epoch != newest->epoch || ahead > RHO_SCAN_ASSEMBLER_SKIP_MAX ||
        ahead <= -SEEN_SCANS) {
        return SCAN_WRONG_NUMBER;
    }
    if (ahead <= 0) {
        /*
         * An older number with a newer time: the sensor's numbering was set back. With a time far
         * back its clock was set, too.
         */
        if (ahead < 0 && place->time_us > newest->time_us) {
            return SCAN_WRONG_NUMBER;
        }
        if (!are_near_times(place->time_us, newest->time_us, config->jump_max_us)) {
            return SCAN_WRONG_TIME;
        }
        return source->seen >> -ahead & 1u ? SCAN_DUPLICATE : SCAN_TOO_LATE;
    }
    /*
     * Numbers and times of a sensor advance together. A scan that took longer than its number, or
     * the silence before it, explains has a wrong time; a scan that skips more numbers than there
     * was time for has a wrong number. Accepted, such a scan would make the next ones look old.
     */
    const uint64_t took_us = rho_elapsed_us(place->time_us, newest->time_us);
    const uint64_t usual_us = (uint64_t)ahead * source->interval_us;
    const uint64_t silent_us = rho_elapsed_us(now_us, source->heard_us);
    if (!is_later_within_jump(config, place->time_us, newest->time_us)) {
        return SCAN_WRONG_TIME;
    }
    if (source->interval_us == 0) {
        return SCAN_NEXT;
    }
    if (is_over_3_halves(took_us, usual_us > silent_us ? usual_us : silent_us)) {
        return SCAN_WRONG_TIME;
    }
    return ahead > 1 && is_under_3_quarters(took_us, usual_us) ? SCAN_WRONG_NUMBER : SCAN_NEXT;
}

/* The longest series of refused scans that a scan may continue; NULL: it continues none. */
static const struct rho_scan_assembler_stray *
find_refused_series(const struct rho_scan_assembler_config *config,
                    const struct rho_scan_assembler_source *source,
                    const struct rho_scan_assembler_place *place)
{
    const struct rho_scan_assembler_stray *most = NULL;
    for (unsigned i = 0; i < RHO_SCAN_ASSEMBLER_STRAYS; i++) {
        const struct rho_scan_assembler_stray *stray = &source->strays[i];
        const int32_t ahead = scan_number_difference(place->scan, stray->place.scan);
        if (stray->scans > (most ? most->scans : 0) && place->epoch == stray->place.epoch &&
            ahead >= 1 && ahead <= RHO_SCAN_ASSEMBLER_SKIP_MAX &&
            is_later_within_jump(config, place->time_us, stray->place.time_us)) {
            most = stray;
        }
    }
    return most;
}

int rho_scan_may_begin_sequence(const struct rho_scan_assembler_config *config,
                                const struct rho_scan_assembler_source *source,
                                const struct rho_scan_assembler_place *place,
                                enum scan_verdict verdict)
{
    const int32_t behind = scan_number_difference(source->place.scan, place->scan);
    /*
     * A duplicate or out-of-sequence scan may show that the sensor's numbers begin again where no
     * older number is remembered, or the scan continues a series of refused ones. Copies of single
     * scans, by another way through the network, do neither.
     */
    return verdict == SCAN_WRONG_NUMBER || verdict == SCAN_WRONG_TIME ||
           (FOLLOWS_REPEATS && (verdict == SCAN_DUPLICATE || verdict == SCAN_TOO_LATE) &&
            behind > 0 &&
            (source->seen >> behind <= 1u || find_refused_series(config, source, place)));
}

int rho_scan_is_in_time(const struct rho_scan_assembler *assembler,
                        enum rho_scan_assembler_kind kind, int64_t time_us)
{
    const int64_t late_max_us = RHO_SCAN_ASSEMBLER_IS(kind, RHO_SCAN_ASSEMBLER_BEARINGS)
                                    ? 0
                                    : assembler->config.late_max_us;
    return rho_elapsed_us(assembler->out_us, time_us) <= (uint64_t)late_max_us;
}

/*
 * An out-of-sequence scan is usable where its number was skipped, its time fits the number, and the
 * tracker still takes it. Otherwise its number stays skipped: the right scan may still come. Until
 * the first scan on a new clock has gone out, the number need not be skipped: the scan may have
 * been refused before.
 */
static int is_usable_out_of_sequence(const struct rho_scan_assembler *assembler,
                                     const struct rho_scan_assembler_source *source,
                                     const struct rho_scan_assembler_place *place)
{
    const uint32_t behind = (uint32_t)scan_number_difference(
        source->place.scan, place->scan); /* 1 .. SEEN_SCANS - 1, as it is SCAN_TOO_LATE */
    const uint64_t before_us = rho_elapsed_us(source->place.time_us, place->time_us);
    const uint64_t usual_us = (uint64_t)behind * source->interval_us;
    const int was_refused = FOLLOWS_REPEATS && assembler->is_restart;
    return source->off_clock == 0 && ((source->skipped >> behind & 1u) || was_refused) &&
           before_us > 0 && !is_under_3_quarters(before_us, usual_us) &&
           !is_over_3_halves(before_us, usual_us) &&
           rho_scan_is_in_time(assembler, (enum rho_scan_assembler_kind)source->kind,
                               place->time_us);
}

enum scan_verdict rho_scan_classify(const struct rho_scan_assembler *assembler,
                                    const struct rho_scan_assembler_source *source,
                                    const struct rho_scan_assembler_place *place, int64_t now_us)
{
    const struct rho_scan_assembler_config *config = &assembler->config;
    if (source->scans == 0) {
        return SCAN_NEXT;
    }
    const enum scan_verdict verdict = classify_by_sequence(config, source, place, now_us);
    if (TAKES_LATE && verdict == SCAN_TOO_LATE &&
        is_usable_out_of_sequence(assembler, source, place)) {
        return SCAN_OUT_OF_SEQUENCE;
    }
    if (rho_scan_may_begin_sequence(config, source, place, verdict)) {
        const struct rho_scan_assembler_stray *stray = find_refused_series(config, source, place);
        if (stray && stray->scans + 1 >= config->follow_scans) {
            return SCAN_RESTARTS_SENSOR;
        }
    }
    return verdict;
}

void rho_scan_remember_refused(const struct rho_scan_assembler_config *config,
                               struct rho_scan_assembler_source *source,
                               const struct rho_scan_assembler_place *place)
{
    const struct rho_scan_assembler_stray *agrees = find_refused_series(config, source, place);
    /* stays below follow_scans: the scan that reaches it is accepted */
    const uint32_t scans = agrees ? agrees->scans + 1 : 1;
    unsigned at = 0; /* the series that it continues, or else replaces: the shortest, then oldest */
    for (unsigned i = 0; i < RHO_SCAN_ASSEMBLER_STRAYS; i++) {
        const struct rho_scan_assembler_place *stray = &source->strays[i].place;
        if (source->strays[i].scans > 0 && place->scan == stray->scan &&
            place->epoch == stray->epoch && place->time_us == stray->time_us) {
            return; /* another part, or a duplicate, of a remembered scan */
        }
        at = source->strays[i].scans <= source->strays[at].scans ? i : at;
    }
    at = agrees ? (unsigned)(agrees - source->strays) : at;
    memmove(source->strays + 1, source->strays, at * sizeof *source->strays);
    source->strays[0] = (struct rho_scan_assembler_stray){.place = *place, .scans = scans};
}

uint32_t rho_scan_set_newest(const struct rho_scan_assembler_config *config,
                             struct rho_scan_assembler_source *source,
                             const struct rho_scan_assembler_place *place,
                             enum scan_verdict verdict, int64_t now_us)
{
    const struct rho_scan_assembler_stray *stray =
        verdict == SCAN_RESTARTS_SENSOR ? find_refused_series(config, source, place) : NULL;
    const struct rho_scan_assembler_place *from = stray ? &stray->place : &source->place;
    const int is_next = verdict == SCAN_NEXT && source->scans > 0;
    const int32_t ahead = scan_number_difference(place->scan, from->scan);
    if (is_next || stray) {
        /* the scan follows the one before: ahead is above 0, and jump_max_us fits 32 bits */
        const uint32_t took_us = (uint32_t)(place->time_us - from->time_us);
        const int64_t interval_us = took_us / (uint32_t)ahead;
        int64_t mean_us = source->interval_us;
        mean_us = is_next && mean_us > 0 ? mean_us + (interval_us - mean_us) / 4 : interval_us;
        source->interval_us = (uint32_t)(mean_us > 0 ? mean_us : 1);
    }
    source->seen = is_next && ahead < SEEN_SCANS ? source->seen << ahead | 1u : 1u;
    source->skipped = !is_next             ? 0u
                      : ahead < SEEN_SCANS ? source->skipped << ahead | ((1u << ahead) - 2u)
                                           : ~1u;
    source->place = *place;
    source->check = CHECK_NONE;
    /* silence beyond jump_max_us does not add to known_us */
    const uint64_t more_us = source->scans > 0 ? rho_elapsed_us(now_us, source->heard_us) : 0;
    const uint32_t room_us = RHO_SCAN_ASSEMBLER_TRUST_US - source->known_us;
    if (more_us <= (uint64_t)config->jump_max_us) {
        source->known_us += more_us < room_us ? (uint32_t)more_us : room_us;
    }
    source->heard_us = now_us;
    memset(source->strays, 0, sizeof source->strays);
    source->scans = (uint16_t)(source->scans + (source->scans < UINT16_MAX));
    return is_next ? (uint32_t)(ahead - 1) : 0;
}

void rho_scan_mark_received(struct rho_scan_assembler_source *source, int32_t scan)
{
    const uint32_t bit = 1u << scan_number_difference(source->place.scan, scan);
    source->seen |= bit;
    source->skipped &= ~bit;
}

int rho_scan_awaits_previous(const struct rho_scan_assembler_source *source, int32_t scan)
{
    const int32_t behind = scan_number_difference(source->place.scan, scan);
    return behind >= 0 && behind < SEEN_SCANS - 1 && (source->skipped >> (behind + 1) & 1u);
}

int rho_scan_is_proven(const struct rho_scan_assembler_config *config,
                       const struct rho_scan_assembler_source *source)
{
    return source->scans >= config->follow_scans;
}

/* Newcomers */

int rho_scan_is_live(const struct rho_scan_assembler *assembler,
                     const struct rho_scan_assembler_source *source, int64_t now_us)
{
    return source->is_used && source->scans > 0 &&
           rho_elapsed_us(now_us, source->heard_us) <= (uint64_t)assembler->config.jump_max_us;
}

uint32_t rho_scan_eldest_known_us(const struct rho_scan_assembler *assembler, int64_t now_us)
{
    const uint64_t jump_max_us = (uint64_t)assembler->config.jump_max_us;
    uint32_t eldest_us = 0;
    for (unsigned i = 0; i < RHO_MAX_SENSORS && !assembler->config.is_record; i++) {
        const struct rho_scan_assembler_source *source = &assembler->sources[i];
        const uint64_t silent_us = rho_elapsed_us(now_us, source->heard_us);
        const uint64_t interval_us = source->interval_us;
        /*
         * Counts where the next scan is not overdue, or the sensor was heard not long ago. Silent
         * sensors must make no other one a newcomer: their clocks would hold its scans for ever.
         */
        if (source->known_us > eldest_us && rho_scan_is_proven(&assembler->config, source) &&
            rho_scan_is_live(assembler, source, now_us) &&
            (silent_us <= interval_us + interval_us / 4 ||
             (silent_us <= jump_max_us / 2 && (silent_us <= jump_max_us / CLOCK_OFFSET_SHARE ||
                                               silent_us <= PRESENT_INTERVALS * interval_us)))) {
            eldest_us = source->known_us;
        }
    }
    return eldest_us;
}

int rho_scan_is_newcomer(uint32_t known_us, uint32_t eldest_us)
{
    return eldest_us >= RHO_SCAN_ASSEMBLER_EQUALS_US && known_us < eldest_us / 2;
}

/* 1 where a live sensor has a vote: on the common clock, proven, and no newcomer. */
static int may_vote_on_clock(const struct rho_scan_assembler *assembler,
                             const struct rho_scan_assembler_source *source, uint32_t eldest_us,
                             int64_t now_us)
{
    return source->off_clock == 0 && rho_scan_is_live(assembler, source, now_us) &&
           rho_scan_is_proven(&assembler->config, source) &&
           !rho_scan_is_newcomer(source->known_us, eldest_us);
}

int64_t rho_scan_held_until_us(const struct rho_scan_assembler *assembler,
                               const struct rho_scan_assembler_slot *slot)
{
    const uint32_t eldest_us =
        HAS_OTHERS ? rho_scan_eldest_known_us(assembler, slot->heard_us) : 0u;
    int64_t first_us = INT64_MAX;
    int is_asked = 0;
    if (!HAS_OTHERS ||
        !rho_scan_is_newcomer(assembler->sources[slot->source].known_us, eldest_us)) {
        return INT64_MIN;
    }
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *source = &assembler->sources[i];
        if (may_vote_on_clock(assembler, source, eldest_us, slot->heard_us)) {
            /* when the sensor's own scan of that time would have come, hold_us included */
            const uint64_t ahead_us = rho_elapsed_us(slot->place.time_us, source->place.time_us);
            const int64_t wait_us = (int64_t)ahead_us + assembler->config.hold_us;
            int64_t until_us =
                source->heard_us > INT64_MAX - wait_us ? INT64_MAX : source->heard_us + wait_us;
            until_us = ahead_us == 0 ? INT64_MIN : until_us;
            first_us = until_us < first_us ? until_us : first_us;
            is_asked = 1;
        }
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        const struct rho_scan_assembler_slot *other = &assembler->slots[i];
        if (other->state == SLOT_OPEN && other->place.time_us < slot->place.time_us &&
            !rho_scan_is_newcomer(assembler->sources[other->source].known_us, eldest_us)) {
            return INT64_MAX;
        }
    }
    return is_asked ? first_us : INT64_MIN;
}

/* The common clock */

/*
 * 1 where a time is not on a sensor's clock: it is farther ahead of the sensor's newest scan than
 * the age of that scan, or far before it. After a sensor's first scan the tolerance is jump_max_us:
 * its interval, and the speed at which a record is played, are still unknown.
 */
static int is_time_off_sensor(const struct rho_scan_assembler_config *config,
                              const struct rho_scan_assembler_source *source, int64_t time_us,
                              int64_t now_us)
{
    const int64_t share_us =
        source->interval_us > 0 ? config->jump_max_us / CLOCK_OFFSET_SHARE : config->jump_max_us;
    const uint64_t offset_max_us = (uint64_t)(config->hold_us + share_us);
    const uint64_t ahead_us = rho_elapsed_us(time_us, source->place.time_us);
    uint64_t old_us = rho_elapsed_us(now_us, source->heard_us);
    old_us = old_us > 2ull * source->interval_us ? old_us : 2ull * source->interval_us;
    return (ahead_us > offset_max_us && ahead_us - offset_max_us > old_us) ||
           rho_elapsed_us(source->place.time_us, time_us) > offset_max_us;
}

/*
 * 1 where a time is off the clocks of most live sensors on the common clock. Newcomers and unproven
 * sensors vote only where there are no others.
 */
static int is_time_off_most(const struct rho_scan_assembler *assembler,
                            const struct rho_scan_assembler_source *source, int64_t time_us,
                            int64_t now_us)
{
    const uint32_t eldest_us = rho_scan_eldest_known_us(assembler, now_us);
    int votes[2] = {0}, balance[2] = {0};
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *other = &assembler->sources[i];
        if (other != source && other->off_clock == 0 &&
            rho_scan_is_live(assembler, other, now_us)) {
            const int counts = may_vote_on_clock(assembler, other, eldest_us, now_us);
            votes[counts]++;
            balance[counts] +=
                is_time_off_sensor(&assembler->config, other, time_us, now_us) ? 1 : -1;
        }
    }
    return balance[votes[1] > 0] > 0;
}

/*
 * 1 where more live sensors agree on a new time than proven ones are on the common clock, newcomers
 * left out. Between equal numbers the reception clock decides.
 */
static int has_new_time_majority(const struct rho_scan_assembler *assembler,
                                 const struct rho_scan_assembler_source *source, int64_t time_us,
                                 int64_t now_us)
{
    const int64_t offset_max_us =
        assembler->config.hold_us + assembler->config.jump_max_us / CLOCK_OFFSET_SHARE;
    const uint32_t eldest_us = rho_scan_eldest_known_us(assembler, now_us);
    unsigned with = 1, against = 0;
    if (rho_scan_is_newcomer(source->known_us, eldest_us)) {
        return 0;
    }
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *other = &assembler->sources[i];
        if (other == source || !rho_scan_is_live(assembler, other, now_us) ||
            rho_scan_is_newcomer(other->known_us, eldest_us)) {
            continue;
        }
        if (other->off_clock == 0) {
            against += (unsigned)rho_scan_is_proven(&assembler->config, other);
        } else if (other->off_clock >= assembler->config.follow_scans) {
            with += !is_time_off_sensor(&assembler->config, other, time_us, now_us);
        }
    }
    return with > against || (with == against && are_near_times(time_us, now_us, offset_max_us) &&
                              !are_near_times(assembler->clock_us, now_us, offset_max_us));
}

/*
 * 1 where a restarted sensor sets the common clock back: its time is not after the scans that went
 * out, and no other live sensor is on the common clock.
 */
static int is_clock_set_back(const struct rho_scan_assembler *assembler,
                             const struct rho_scan_assembler_source *source, int64_t time_us,
                             int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *other = &assembler->sources[i];
        if (other != source && other->off_clock == 0 &&
            rho_scan_is_live(assembler, other, now_us)) {
            return 0;
        }
    }
    return time_us <= assembler->out_us;
}

enum scan_clock rho_scan_update_clock(struct rho_scan_assembler *assembler,
                                      struct rho_scan_assembler_source *source, int64_t time_us,
                                      enum scan_verdict verdict, int64_t now_us)
{
    const struct rho_scan_assembler_config *config = &assembler->config;
    enum scan_clock clock = CLOCK_COMMON;
    if (assembler->has_clock &&
        (!are_near_times(time_us, assembler->clock_us, config->jump_max_us) ||
         (HAS_OTHERS && is_time_off_most(assembler, source, time_us, now_us)) ||
         (FOLLOWS_REPEATS && verdict == SCAN_RESTARTS_SENSOR &&
          is_clock_set_back(assembler, source, time_us, now_us)))) {
        /* the refused scans before a sensor's restart have shown its new time, too */
        if (verdict == SCAN_RESTARTS_SENSOR && source->off_clock < config->follow_scans) {
            source->off_clock = (uint8_t)config->follow_scans;
        } else if (source->off_clock < UINT8_MAX) {
            source->off_clock++;
        }
        if (source->off_clock < config->follow_scans ||
            (HAS_OTHERS && !has_new_time_majority(assembler, source, time_us, now_us))) {
            return CLOCK_OTHER;
        }
        /* sensors whose clocks agree with the new time are on the common clock, all others off */
        for (unsigned i = 0; HAS_OTHERS && i < RHO_MAX_SENSORS; i++) {
            struct rho_scan_assembler_source *other = &assembler->sources[i];
            if (!is_time_off_sensor(config, other, time_us, now_us)) {
                other->off_clock = 0;
            } else if (other->off_clock == 0) {
                other->off_clock = 1;
            }
        }
        assembler->is_restart = 1;
        assembler->out_us = INT64_MIN;
        clock = CLOCK_SET;
    }
    source->off_clock = 0;
    if (!assembler->has_clock || !HAS_OTHERS ||
        !rho_scan_is_newcomer(source->known_us, rho_scan_eldest_known_us(assembler, now_us))) {
        assembler->clock_us = time_us;
    }
    assembler->has_clock = 1;
    return clock;
}
