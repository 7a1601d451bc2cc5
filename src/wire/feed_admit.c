/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "feed_parts.h"

#define SECOND_US 1000000
#define SEEN_SCANS 32   /* bits of source.seen */
#define JITTER_US 10000 /* of a sensor's scans, whatever their interval */
#define LEAD_SHARE                                                                                 \
    8 /* of jump_max: how far clocks of different sensors may be apart, beside hold */

/* ---- Times ---- */

static int is_near(int64_t a_us, int64_t b_us, int64_t most_us)
{
    return rho_elapsed_us(a_us, b_us) <= (uint64_t)most_us &&
           rho_elapsed_us(b_us, a_us) <= (uint64_t)most_us;
}

/* ---- Flood ---- */

int rho_feed_draw(struct rho_feed_bucket *bucket, uint32_t count, uint32_t per_s, int64_t now_us)
{
    /* A clock that went back must not leave the bucket empty until it has caught up. */
    if (rho_elapsed_us(now_us, bucket->full_us) >= SECOND_US || now_us < bucket->full_us) {
        bucket->full_us = now_us;
        bucket->left = per_s;
    }
    if (bucket->left < count) {
        return 0;
    }
    bucket->left -= count;
    return 1;
}

/* ---- Numbers ---- */

/* How far a number is from another; numbers wrap. */
static int32_t steps(int32_t scan, int32_t from)
{
    int64_t difference = (int64_t)scan - from;

    if (difference > INT32_MAX) {
        difference -= (int64_t)1 << 32;
    } else if (difference < INT32_MIN) {
        difference += (int64_t)1 << 32;
    }
    return (int32_t)difference;
}

static int is_later(const struct rho_feed_config *config, int64_t time_us, int64_t from_us)
{
    return time_us > from_us && is_near(time_us, from_us, config->jump_max_us);
}

/* The scan may come next after the one at `from`. */
static int goes_on(const struct rho_feed_config *config, const struct rho_feed_place *place,
                   const struct rho_feed_place *from)
{
    int32_t ahead = steps(place->scan, from->scan);

    return place->epoch == from->epoch && ahead >= 1 && ahead <= RHO_FEED_SKIP_MAX &&
           is_later(config, place->time_us, from->time_us);
}

/* Beyond 3/2 of the other; the product may be beyond 64 bits. */
static int is_half_as_long_again(uint64_t took_us, uint64_t longest_us)
{
    return took_us > longest_us && took_us - longest_us > longest_us / 2;
}

/*
 * Numbers and times of a sensor go on together. What takes longer than its numbers, or the silence before it, account
 * for has a wrong time; what skips more numbers than there was time for has a wrong number. Believed, either would make
 * the scans that follow look old.
 */
static enum feed_verdict judge_pace(const struct rho_feed_config *config,
                                    const struct rho_feed_source *source,
                                    const struct rho_feed_place *place, int64_t now_us)
{
    int32_t ahead = steps(place->scan, source->place.scan);
    uint64_t took_us = rho_elapsed_us(place->time_us, source->place.time_us);
    uint64_t usual_us = (uint64_t)ahead * source->interval_us;
    uint64_t silent_us = rho_elapsed_us(now_us, source->heard_us);
    uint64_t longest_us = usual_us > silent_us ? usual_us : silent_us;

    if (!is_later(config, place->time_us, source->place.time_us)) {
        return FEED_STRAY_TIME;
    }
    if (source->interval_us == 0) {
        return FEED_NEXT;
    }
    if (took_us > JITTER_US && is_half_as_long_again(took_us - JITTER_US, longest_us)) {
        return FEED_STRAY_TIME;
    }
    return ahead > 1 && took_us + JITTER_US < usual_us - usual_us / 4 ? FEED_STRAY_NUMBER
                                                                      : FEED_NEXT;
}

static enum feed_verdict judge_known(const struct rho_feed_config *config,
                                     const struct rho_feed_source *source,
                                     const struct rho_feed_place *place, int64_t now_us)
{
    const struct rho_feed_place *newest = &source->place;
    int32_t ahead = steps(place->scan, newest->scan);

    if (place->epoch != newest->epoch || ahead > RHO_FEED_SKIP_MAX || ahead <= -SEEN_SCANS) {
        return FEED_STRAY_NUMBER;
    }
    if (ahead > 0) {
        return judge_pace(config, source, place, now_us);
    }
    /* An old number with a new time is no old scan: the numbers fell back. With one far back, the clock did, too. */
    if (ahead < 0 && place->time_us > newest->time_us) {
        return FEED_STRAY_NUMBER;
    }
    if (!is_near(place->time_us, newest->time_us, config->jump_max_us)) {
        return FEED_STRAY_TIME;
    }
    return source->seen >> -ahead & 1u ? FEED_DUPLICATE : FEED_LATE;
}

/* Those that were not believed, and that the scan may come next after: the most; NULL: none. */
static const struct rho_feed_stray *find_stray(const struct rho_feed_config *config,
                                               const struct rho_feed_source *source,
                                               const struct rho_feed_place *place)
{
    const struct rho_feed_stray *most = NULL;

    for (unsigned i = 0; i < RHO_FEED_STRAYS; i++) {
        const struct rho_feed_stray *stray = &source->strays[i];

        if (stray->scans > (most ? most->scans : 0) && goes_on(config, place, &stray->place)) {
            most = stray;
        }
    }
    return most;
}

int rho_feed_is_in_time(const struct rho_feed *feed, enum rho_feed_kind kind, int64_t time_us)
{
    int64_t late_max_us = RHO_FEED_IS(kind, RHO_FEED_BEARINGS) ? 0 : feed->config.late_max_us;

    return rho_elapsed_us(feed->out_us, time_us) <= (uint64_t)late_max_us;
}

/*
 * A late scan is of use where its number was skipped, its time goes with the number, and the tracker still takes it.
 * Otherwise it is not remembered: the real one may still come.
 */
static int is_of_use(const struct rho_feed *feed, const struct rho_feed_source *source,
                     const struct rho_feed_place *place)
{
    uint32_t behind = (uint32_t)steps(source->place.scan, place->scan); /* 1 .. SEEN_SCANS - 1 */
    uint64_t before_us = rho_elapsed_us(source->place.time_us, place->time_us);
    uint64_t usual_us = (uint64_t)behind * source->interval_us;

    return source->off_clock == 0 && (source->skipped >> behind & 1u) && before_us > 0 &&
           before_us + JITTER_US >= usual_us - usual_us / 4 &&
           !(before_us > JITTER_US && is_half_as_long_again(before_us - JITTER_US, usual_us)) &&
           rho_feed_is_in_time(feed, (enum rho_feed_kind)source->kind, place->time_us);
}

enum feed_verdict rho_feed_judge(const struct rho_feed *feed, const struct rho_feed_source *source,
                                 const struct rho_feed_place *place, int64_t now_us)
{
    const struct rho_feed_config *config = &feed->config;
    const struct rho_feed_stray *stray;
    enum feed_verdict verdict;

    if (source->scans == 0) {
        return FEED_NEXT;
    }
    verdict = judge_known(config, source, place, now_us);
    if (verdict == FEED_STRAY_NUMBER || verdict == FEED_STRAY_TIME) {
        stray = find_stray(config, source, place);
        if (stray && stray->scans + 1 >= config->follow_scans) {
            return FEED_FOLLOW;
        }
    }
    return verdict == FEED_LATE && is_of_use(feed, source, place) ? FEED_SKIPPED : verdict;
}

/* What gives way to the next stray: of the fewest scans the one that was there longest. */
static unsigned weakest(const struct rho_feed_source *source)
{
    unsigned least = 0;

    for (unsigned i = 1; i < RHO_FEED_STRAYS; i++) {
        least = source->strays[i].scans <= source->strays[least].scans ? i : least;
    }
    return least;
}

void rho_feed_note_stray(const struct rho_feed_config *config, struct rho_feed_source *source,
                         const struct rho_feed_place *place)
{
    const struct rho_feed_stray *agrees = find_stray(config, source, place);
    unsigned at = agrees ? (unsigned)(agrees - source->strays) : weakest(source);
    uint32_t scans = agrees ? agrees->scans + 1 : 1; /* below follow_scans: that one is followed */

    for (unsigned i = 0; i < RHO_FEED_STRAYS; i++) {
        const struct rho_feed_place *stray = &source->strays[i].place;

        if (source->strays[i].scans > 0 && place->scan == stray->scan &&
            place->epoch == stray->epoch && place->time_us == stray->time_us) {
            return; /* another part of it, or a double */
        }
    }
    memmove(source->strays + 1, source->strays, at * sizeof *source->strays);
    source->strays[0] = (struct rho_feed_stray){.place = *place, .scans = scans};
}

/* By hand, sixteen bits at a time: a divisor below 65536. The compiler's division of 64 bits is 900 bytes of code. */
static uint64_t divide(uint64_t value, uint32_t by)
{
    uint64_t quotient = 0;
    uint32_t rest = 0;

    for (int shift = 48; shift >= 0; shift -= 16) {
        rest = rest << 16 | (uint32_t)(value >> shift & 0xffffu);
        quotient |= (uint64_t)(rest / by) << shift;
        rest %= by;
    }
    return quotient;
}

static void note_interval(struct rho_feed_source *source, int64_t took_us, int32_t ahead,
                          int is_known)
{
    /* both are above 0 where one place goes on from another */
    int64_t interval_us = (int64_t)divide((uint64_t)took_us, (uint32_t)ahead);
    int64_t mean_us = source->interval_us;

    mean_us = is_known && mean_us > 0 ? mean_us + (interval_us - mean_us) / 4 : interval_us;
    source->interval_us = (uint32_t)(mean_us > 0 ? mean_us : 1);
}

/* Silence beyond jump_max is none of the time that it was heard. */
static void note_heard(const struct rho_feed_config *config, struct rho_feed_source *source,
                       int64_t now_us)
{
    uint64_t more_us = source->scans > 0 ? rho_elapsed_us(now_us, source->heard_us) : 0;
    uint32_t room_us = RHO_FEED_TRUST_US - source->known_us;

    if (more_us <= (uint64_t)config->jump_max_us) {
        source->known_us += more_us < room_us ? (uint32_t)more_us : room_us;
    }
    source->heard_us = now_us;
}

uint32_t rho_feed_note_place(const struct rho_feed_config *config, struct rho_feed_source *source,
                             const struct rho_feed_place *place, enum feed_verdict verdict,
                             int64_t now_us)
{
    const struct rho_feed_stray *stray =
        verdict == FEED_FOLLOW ? find_stray(config, source, place) : NULL;
    const struct rho_feed_place *from = stray ? &stray->place : &source->place;
    int is_next = verdict == FEED_NEXT && source->scans > 0;
    int32_t ahead = steps(place->scan, from->scan);

    if (is_next || stray) {
        note_interval(source, place->time_us - from->time_us, ahead, is_next);
    }
    source->seen = is_next && ahead < SEEN_SCANS ? source->seen << ahead | 1u : 1u;
    source->skipped = !is_next             ? 0u
                      : ahead < SEEN_SCANS ? source->skipped << ahead | ((1u << ahead) - 2u)
                                           : ~1u;
    source->place = *place;
    source->check = FEED_CHECK_NONE;
    note_heard(config, source, now_us);
    memset(source->strays, 0, sizeof source->strays);
    source->scans = (uint16_t)(source->scans + (source->scans < UINT16_MAX));
    return is_next ? (uint32_t)(ahead - 1) : 0;
}

void rho_feed_note_skipped(struct rho_feed_source *source, int32_t scan)
{
    uint32_t bit = 1u << steps(source->place.scan, scan);

    source->seen |= bit;
    source->skipped &= ~bit;
}

int rho_feed_awaits(const struct rho_feed_source *source, int32_t scan)
{
    int32_t behind = steps(source->place.scan, scan);

    return behind >= 0 && behind < SEEN_SCANS - 1 && (source->skipped >> (behind + 1) & 1u);
}

int rho_feed_is_proven(const struct rho_feed_config *config, const struct rho_feed_source *source)
{
    return source->scans >= config->follow_scans;
}

/* ---- Newcomers ---- */

#define PRESENT_INTERVALS 3ull

static int is_live(const struct rho_feed *feed, const struct rho_feed_source *source,
                   int64_t now_us)
{
    return source->is_used && source->scans > 0 &&
           rho_elapsed_us(now_us, source->heard_us) <= (uint64_t)feed->config.jump_max_us;
}

/* It is still sending: who has fallen silent makes nobody a newcomer, or its clock would hold the others for good. */
static int is_present(const struct rho_feed *feed, const struct rho_feed_source *source,
                      int64_t now_us)
{
    uint64_t silent_us = rho_elapsed_us(now_us, source->heard_us);
    uint64_t jump_max_us = (uint64_t)feed->config.jump_max_us;

    return is_live(feed, source, now_us) && silent_us <= jump_max_us / 2 &&
           (silent_us <= jump_max_us / LEAD_SHARE ||
            silent_us <= PRESENT_INTERVALS * source->interval_us);
}

uint32_t rho_feed_eldest_us(const struct rho_feed *feed, int64_t now_us)
{
    uint32_t eldest_us = 0;

    for (unsigned i = 0; i < RHO_MAX_SENSORS && !feed->config.is_record; i++) {
        const struct rho_feed_source *source = &feed->sources[i];

        if (source->known_us > eldest_us && rho_feed_is_proven(&feed->config, source) &&
            is_present(feed, source, now_us)) {
            eldest_us = source->known_us;
        }
    }
    return eldest_us;
}

int rho_feed_is_new(uint32_t known_us, uint32_t eldest_us)
{
    return eldest_us >= RHO_FEED_EQUALS_US && known_us < eldest_us / 2;
}

/* It tells the common time, and is none of those that have no say in it. */
static int has_say(const struct rho_feed *feed, const struct rho_feed_source *source,
                   uint32_t eldest_us, int64_t now_us)
{
    return source->off_clock == 0 && is_live(feed, source, now_us) &&
           rho_feed_is_proven(&feed->config, source) &&
           !rho_feed_is_new(source->known_us, eldest_us);
}

/* When by its own clock it is time_us, and what it sent itself for that time would be here. */
static int64_t comes_to_us(const struct rho_feed *feed, const struct rho_feed_source *source,
                           int64_t time_us)
{
    uint64_t ahead_us = rho_elapsed_us(time_us, source->place.time_us);
    int64_t wait_us = (int64_t)ahead_us + feed->config.hold_us; /* times are within their limit */

    if (ahead_us == 0) {
        return INT64_MIN;
    }
    return source->heard_us > INT64_MAX - wait_us ? INT64_MAX : source->heard_us + wait_us;
}

int64_t rho_feed_early_until_us(const struct rho_feed *feed, const struct rho_feed_slot *slot)
{
    uint32_t eldest_us = rho_feed_eldest_us(feed, slot->heard_us);
    int64_t first_us = INT64_MAX, until_us;
    int is_asked = 0;

    if (!rho_feed_is_new(feed->sources[slot->source].known_us, eldest_us)) {
        return INT64_MIN;
    }
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        if (has_say(feed, &feed->sources[i], eldest_us, slot->heard_us)) {
            until_us = comes_to_us(feed, &feed->sources[i], slot->place.time_us);
            first_us = until_us < first_us ? until_us : first_us;
            is_asked = 1;
        }
    }
    for (unsigned i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        const struct rho_feed_slot *other = &feed->slots[i];

        if (other->state == FEED_SLOT_OPEN && other->place.time_us < slot->place.time_us &&
            !rho_feed_is_new(feed->sources[other->source].known_us, eldest_us)) {
            return INT64_MAX;
        }
    }
    return is_asked ? first_us : INT64_MIN;
}

/* ---- The common clock ---- */

/*
 * The scan's time is not this sensor's: it is farther ahead of its newest scan than that is old, or far back. Of a
 * sensor with one scan so far nobody knows when the next is due, nor how fast a record is played.
 */
static int is_elsewhere(const struct rho_feed_config *config, const struct rho_feed_source *other,
                        int64_t time_us, int64_t now_us)
{
    int64_t share_us =
        other->interval_us > 0 ? config->jump_max_us / LEAD_SHARE : config->jump_max_us;
    uint64_t lead_us = (uint64_t)(config->hold_us + share_us);
    uint64_t ahead_us = rho_elapsed_us(time_us, other->place.time_us);
    uint64_t old_us = rho_elapsed_us(now_us, other->heard_us);

    old_us = old_us > 2ull * other->interval_us ? old_us : 2ull * other->interval_us;
    return (ahead_us > lead_us && ahead_us - lead_us > old_us) ||
           rho_elapsed_us(other->place.time_us, time_us) > lead_us;
}

/* Most live sensors on the clock say that the time is another one. Where none has a say the others do. */
static int is_contradicted(const struct rho_feed *feed, const struct rho_feed_source *source,
                           int64_t time_us, int64_t now_us)
{
    uint32_t eldest_us = rho_feed_eldest_us(feed, now_us);
    int votes[2] = {0}, balance[2] = {0}, counts;

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_feed_source *other = &feed->sources[i];

        if (other != source && other->off_clock == 0 && is_live(feed, other, now_us)) {
            counts = has_say(feed, other, eldest_us, now_us);
            votes[counts]++;
            balance[counts] += is_elsewhere(&feed->config, other, time_us, now_us) ? 1 : -1;
        }
    }
    return balance[votes[1] > 0] > 0;
}

/*
 * More live sensors agree on the time than proven ones on the clock, without the newcomers; of equally many the reception
 * clock decides.
 */
static int is_outvoted(const struct rho_feed *feed, const struct rho_feed_source *source,
                       int64_t time_us, int64_t now_us)
{
    int64_t lead_us = feed->config.hold_us + feed->config.jump_max_us / LEAD_SHARE;
    uint32_t eldest_us = rho_feed_eldest_us(feed, now_us);
    unsigned with = 1, against = 0;

    if (rho_feed_is_new(source->known_us, eldest_us)) {
        return 0;
    }
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_feed_source *other = &feed->sources[i];

        if (other == source || !is_live(feed, other, now_us) ||
            rho_feed_is_new(other->known_us, eldest_us)) {
            continue;
        }
        if (other->off_clock == 0) {
            against += (unsigned)rho_feed_is_proven(&feed->config, other);
        } else if (other->off_clock >= feed->config.follow_scans) {
            with += !is_elsewhere(&feed->config, other, time_us, now_us);
        }
    }
    return with > against || (with == against && is_near(time_us, now_us, lead_us) &&
                              !is_near(feed->clock_us, now_us, lead_us));
}

/* Who tells the new time is on the clock from now on, all others are off it, and what they sent is of no use. */
static void follow(struct rho_feed *feed, int64_t time_us, int64_t now_us)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct rho_feed_source *source = &feed->sources[i];

        if (!is_elsewhere(&feed->config, source, time_us, now_us)) {
            source->off_clock = 0;
        } else if (source->off_clock == 0) {
            source->off_clock = 1;
        }
    }
    feed->is_restart = 1;
    feed->out_us = INT64_MIN;
    rho_feed_drop_slots(feed);
}

int rho_feed_is_on_clock(struct rho_feed *feed, struct rho_feed_source *source, int64_t time_us,
                         enum feed_verdict verdict, int64_t now_us)
{
    if (feed->has_clock && (!is_near(time_us, feed->clock_us, feed->config.jump_max_us) ||
                            is_contradicted(feed, source, time_us, now_us))) {
        /* The scans that a sensor's new numbers were followed for have shown its new time as well. */
        if (verdict == FEED_FOLLOW && source->off_clock < feed->config.follow_scans) {
            source->off_clock = (uint8_t)feed->config.follow_scans;
        } else if (source->off_clock < UINT8_MAX) {
            source->off_clock++;
        }
        if (source->off_clock < feed->config.follow_scans ||
            !is_outvoted(feed, source, time_us, now_us)) {
            return 0;
        }
        follow(feed, time_us, now_us);
    }
    source->off_clock = 0;
    if (!feed->has_clock || !rho_feed_is_new(source->known_us, rho_feed_eldest_us(feed, now_us))) {
        feed->clock_us = time_us;
    }
    feed->has_clock = 1;
    return 1;
}
