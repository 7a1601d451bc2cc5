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

/* 1 where took_us, with jitter, is below 3/4 of usual_us. */
static int is_under_3_quarters(uint64_t took_us, uint64_t usual_us)
{
    return took_us + JITTER_US < usual_us - usual_us / 4;
}

/* A time at a pace of part_us in whole_us (0: as it is). Floats are small code, exact to 1e-7. */
static uint32_t scale_us(uint64_t time_us, uint32_t part_us, uint32_t whole_us)
{
    const uint32_t limited_us = time_us < UINT32_MAX ? (uint32_t)time_us : UINT32_MAX;
    if (!HAS_OTHERS || whole_us == 0) {
        return limited_us;
    }
    const float scaled_us = (float)limited_us * ((float)part_us / (float)whole_us);
    return scaled_us < 4.29e9f ? (uint32_t)scaled_us : UINT32_MAX; /* below 2^32 */
}

/*
 * Times that a sensor's clock may show. It goes on from its newest scan as the reception clock
 * does, or at its pace where a record is played. An overdue sensor's may have stood.
 */
struct clock_span {
    int64_t first_us, last_us;
};

static struct clock_span read_clock(const struct rho_scan_assembler_source *source, int64_t now_us)
{
    const uint64_t overdue_us = PRESENT_INTERVALS * (uint64_t)source->interval_us;
    const uint64_t since_us =
        scale_us(rho_elapsed_us(now_us, source->heard_us), source->told_us, source->known_us);
    return (struct clock_span){
        source->place.time_us +
            (int64_t)(since_us < overdue_us || !HAS_OTHERS ? since_us : overdue_us),
        source->place.time_us + (int64_t)(since_us + source->delay_us)};
}

/* How far the time of a scan that its network has delayed is off a sensor's clock. */
static uint64_t clock_error_us(const struct rho_scan_assembler_source *source, int64_t time_us,
                               uint64_t delay_us, int64_t now_us)
{
    const struct clock_span clock = read_clock(source, now_us);
    return rho_elapsed_us(clock.first_us, time_us + (int64_t)delay_us) +
           rho_elapsed_us(time_us, clock.last_us);
}

/* Tolerated error of a sensor's clock; of one whose pace is unknown, by all of jump_max_us. */
static uint64_t clock_tolerance_us(const struct rho_scan_assembler_config *config,
                                   const struct rho_scan_assembler_source *source, int share)
{
    const uint32_t known_us = source->known_us;
    const uint32_t told_us = source->told_us > known_us ? source->told_us : known_us;
    const int64_t jump_us = config->jump_max_us / (HAS_OTHERS && known_us == 0 ? 1 : share);
    return scale_us((uint64_t)(config->hold_us + jump_us), told_us, known_us);
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
     * A time that fits neither its number nor its reception is wrong; so is a number that skips
     * more than there was time for. Accepted, such a scan would make the next ones look old.
     */
    const uint64_t took_us = rho_elapsed_us(place->time_us, newest->time_us);
    const uint64_t usual_us = (uint64_t)ahead * source->interval_us;
    if (!is_later_within_jump(config, place->time_us, newest->time_us)) {
        return SCAN_WRONG_TIME;
    }
    const uint64_t most_us = clock_tolerance_us(config, source, OWN_CLOCK_SHARE);
    if (source->interval_us > 0 && clock_error_us(source, place->time_us, 0, now_us) > most_us &&
        !are_near_times((int64_t)took_us, (int64_t)usual_us, (int64_t)most_us)) {
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
           before_us <= usual_us + usual_us / 2 + JITTER_US &&
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
    /* of a scan that follows the one before: ahead is above 0, and jump_max_us fits 32 bits */
    const uint32_t took_us = (uint32_t)rho_elapsed_us(place->time_us, from->time_us);
    const uint32_t jump_max_us = (uint32_t)config->jump_max_us;
    source->delay_us =
        HAS_OTHERS && is_next
            ? scale_us(rho_elapsed_us(read_clock(source, now_us).last_us, place->time_us),
                       jump_max_us - took_us / DELAY_JUMPS, jump_max_us)
            : 0;
    if (is_next || stray) {
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
    if (HAS_OTHERS && more_us <= (uint64_t)config->jump_max_us &&
        more_us <= RHO_SCAN_ASSEMBLER_TRUST_US - source->known_us) {
        source->known_us += (uint32_t)more_us;
        source->told_us = rho_count(source->told_us, is_next ? took_us : (uint32_t)more_us);
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
    const uint64_t most_us = (uint64_t)assembler->config.jump_max_us / CLOCK_OFFSET_SHARE;
    uint32_t eldest_us = 0;
    for (unsigned i = 0; HAS_OTHERS && i < RHO_MAX_SENSORS && !assembler->config.is_record; i++) {
        const struct rho_scan_assembler_source *source = &assembler->sources[i];
        const uint64_t silent_us = rho_elapsed_us(now_us, source->heard_us);
        /* A silent sensor must make no other one a newcomer: it would hold its scans for ever. */
        if (source->known_us > eldest_us && rho_scan_is_proven(&assembler->config, source) &&
            rho_scan_is_live(assembler, source, now_us) &&
            (silent_us <= most_us ||
             silent_us <= PRESENT_INTERVALS * (uint64_t)source->interval_us)) {
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
    const uint32_t eldest_us = rho_scan_eldest_known_us(assembler, slot->heard_us);
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

/* 1 where a time is not on a sensor's clock. */
static int is_time_off_sensor(const struct rho_scan_assembler_config *config,
                              const struct rho_scan_assembler_source *source, int64_t time_us,
                              int64_t now_us)
{
    return clock_error_us(source, time_us, 0, now_us) >
           clock_tolerance_us(config, source, CLOCK_OFFSET_SHARE);
}

/*
 * 1 where a time is off the clocks of most live sensors on the common clock; newcomers and unproven
 * ones vote where there are no others. A clock that has stepped may be off by half of its step, one
 * that was off as by its own. Without a vote, a restart before the last scan sets the clock back.
 */
static int is_time_off_most(const struct rho_scan_assembler *assembler,
                            const struct rho_scan_assembler_source *source, int64_t time_us,
                            enum scan_verdict verdict, int64_t now_us)
{
    const struct rho_scan_assembler_config *config = &assembler->config;
    const uint32_t eldest_us = rho_scan_eldest_known_us(assembler, now_us);
    const int is_restart = verdict == SCAN_RESTARTS_SENSOR;
    const int was_off = !is_restart && source->off_clock >= config->follow_scans;
    const uint64_t delay_us = is_restart || source->scans == 0
                                  ? 0
                                  : rho_elapsed_us(read_clock(source, now_us).last_us, time_us);
    const uint64_t step_us = clock_error_us(source, time_us, 0, now_us);
    const int has_stepped =
        is_restart && step_us > clock_tolerance_us(config, source, OWN_CLOCK_SHARE);
    int votes[2] = {0}, balance[2] = {0};
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *other = &assembler->sources[i];
        if (other != source && other->off_clock == 0 &&
            rho_scan_is_live(assembler, other, now_us)) {
            const int counts = may_vote_on_clock(assembler, other, eldest_us, now_us);
            const uint64_t off_us = clock_error_us(other, time_us, delay_us, now_us);
            const uint64_t most_us =
                clock_tolerance_us(config, other, was_off ? OWN_CLOCK_SHARE : CLOCK_OFFSET_SHARE);
            votes[counts]++;
            balance[counts] += off_us > most_us || (has_stepped && off_us > step_us / 2) ? 1 : -1;
        }
    }
    return votes[0] + votes[1] > 0 ? balance[votes[1] > 0] > 0
                                   : is_restart && time_us <= assembler->out_us;
}

/*
 * 1 where more live sensors agree on a new time than proven ones are on the common clock, newcomers
 * left out. Between equal numbers the reception clock decides.
 */
static int has_new_time_majority(const struct rho_scan_assembler *assembler,
                                 const struct rho_scan_assembler_source *source, int64_t time_us,
                                 int64_t now_us)
{
    const struct rho_scan_assembler_config *config = &assembler->config;
    const int64_t most_us = config->hold_us + config->jump_max_us / CLOCK_OFFSET_SHARE;
    const uint32_t eldest_us = rho_scan_eldest_known_us(assembler, now_us);
    unsigned with = 1, against = 0, right = 0;
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
            against += (unsigned)rho_scan_is_proven(config, other);
            right += !is_time_off_sensor(config, other, now_us, now_us);
        } else if (other->off_clock >= config->follow_scans) {
            with += !is_time_off_sensor(config, other, time_us, now_us);
        }
    }
    return with > against ||
           (with == against && right == 0 && are_near_times(time_us, now_us, most_us));
}

enum scan_clock rho_scan_update_clock(struct rho_scan_assembler *assembler,
                                      struct rho_scan_assembler_source *source, int64_t time_us,
                                      enum scan_verdict verdict, int64_t now_us)
{
    const struct rho_scan_assembler_config *config = &assembler->config;
    enum scan_clock clock = CLOCK_COMMON;
    if (assembler->has_clock &&
        (!are_near_times(time_us, assembler->clock_us, config->jump_max_us) ||
         (HAS_OTHERS && is_time_off_most(assembler, source, time_us, verdict, now_us)))) {
        /* the refused scans before a sensor's restart have shown its new time, too */
        const unsigned least = verdict == SCAN_RESTARTS_SENSOR ? config->follow_scans : 1u;
        const unsigned off = source->off_clock + (source->off_clock < UINT8_MAX ? 1u : 0u);
        source->off_clock = (uint8_t)(off > least ? off : least);
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
