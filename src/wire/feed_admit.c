/* SPDX-License-Identifier: MIT */
#include "feed_parts.h"

#define SECOND_US 1000000
#define SEEN_SCANS 32 /* bits of source.seen */

/* ---- Times ---- */

uint64_t rho_feed_elapsed_us(int64_t now_us, int64_t then_us)
{
    return now_us > then_us ? (uint64_t)now_us - (uint64_t)then_us : 0;
}

static int is_near(int64_t a_us, int64_t b_us, int64_t most_us)
{
    return rho_feed_elapsed_us(a_us, b_us) <= (uint64_t)most_us &&
           rho_feed_elapsed_us(b_us, a_us) <= (uint64_t)most_us;
}

/* ---- Flood ---- */

int rho_feed_draw(struct rho_feed_source *source, uint32_t flood_per_s, int64_t now_us)
{
    /* A clock that went back must not leave the bucket empty until it has caught up. */
    if (rho_feed_elapsed_us(now_us, source->bucket_us) >= SECOND_US || now_us < source->bucket_us) {
        source->bucket_us = now_us;
        source->bucket = flood_per_s;
    }
    if (source->bucket == 0) {
        return 0;
    }
    source->bucket--;
    return 1;
}

/* ---- Numbers ---- */

/* How far a number is from another; numbers wrap. */
static int32_t steps(int32_t scan, int32_t from)
{
    uint32_t difference = (uint32_t)scan - (uint32_t)from;

    return difference <= INT32_MAX ? (int32_t)difference : -(int32_t)(UINT32_MAX - difference) - 1;
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

static enum feed_verdict judge_known(const struct rho_feed_config *config,
                                     const struct rho_feed_source *source,
                                     const struct rho_feed_place *place)
{
    const struct rho_feed_place *newest = &source->place;
    int32_t ahead = steps(place->scan, newest->scan);

    if (place->epoch != newest->epoch || ahead > RHO_FEED_SKIP_MAX || ahead <= -SEEN_SCANS) {
        return FEED_STRAY_NUMBER;
    }
    if (ahead > 0) {
        return is_later(config, place->time_us, newest->time_us) ? FEED_NEXT : FEED_STRAY_TIME;
    }
    /* An old number with a new time is no old scan: the numbers fell back. */
    if (ahead < 0 && place->time_us > newest->time_us) {
        return FEED_STRAY_NUMBER;
    }
    return source->seen >> -ahead & 1u ? FEED_DUPLICATE : FEED_LATE;
}

enum feed_verdict rho_feed_judge(const struct rho_feed_config *config,
                                 const struct rho_feed_source *source,
                                 const struct rho_feed_place *place)
{
    enum feed_verdict verdict;

    if (source->scans == 0) {
        return FEED_NEXT;
    }
    verdict = judge_known(config, source, place);
    if ((verdict == FEED_STRAY_NUMBER || verdict == FEED_STRAY_TIME) &&
        source->strays + 1 >= config->follow_scans && goes_on(config, place, &source->stray)) {
        return FEED_FOLLOW;
    }
    return verdict;
}

void rho_feed_note_stray(const struct rho_feed_config *config, struct rho_feed_source *source,
                         const struct rho_feed_place *place)
{
    const struct rho_feed_place *stray = &source->stray;

    if (source->strays > 0 && place->scan == stray->scan && place->epoch == stray->epoch &&
        place->time_us == stray->time_us) {
        return; /* another part of it, or a double */
    }
    if (source->strays > 0 && goes_on(config, place, stray)) {
        source->strays++; /* stays below follow_scans: that one is followed */
    } else {
        source->strays = 1;
    }
    source->stray = *place;
}

uint32_t rho_feed_note_place(struct rho_feed_source *source, const struct rho_feed_place *place,
                             enum feed_verdict verdict, int64_t now_us)
{
    int32_t ahead = steps(place->scan, source->place.scan);
    int is_next = verdict == FEED_NEXT && source->scans > 0;

    source->seen = is_next && ahead < SEEN_SCANS ? source->seen << ahead | 1u : 1u;
    source->place = *place;
    source->heard_us = now_us;
    source->strays = 0;
    source->scans = (uint16_t)(source->scans + (source->scans < UINT16_MAX));
    return is_next ? (uint32_t)(ahead - 1) : 0;
}

/* ---- The common clock ---- */

/* More live sensors agree on the time than on the clock; of equally many, the reception clock prefers it. */
static int is_outvoted(const struct rho_feed *feed, const struct rho_feed_source *source,
                       int64_t time_us, int64_t now_us)
{
    int64_t most_us = feed->config.jump_max_us;
    unsigned with = 1, against = 0;

    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_feed_source *other = &feed->sources[i];

        if (!other->is_used || other == source || other->scans == 0 ||
            rho_feed_elapsed_us(now_us, other->heard_us) > (uint64_t)most_us) {
            continue;
        }
        if (other->off_clock == 0) {
            against++;
        } else if (other->off_clock >= feed->config.follow_scans &&
                   is_near(other->place.time_us, time_us, most_us)) {
            with++;
        }
    }
    return with > against || (with == against && is_near(time_us, now_us, most_us) &&
                              !is_near(feed->clock_us, now_us, most_us));
}

/* Who tells the new time is on the clock from now on, all others are off it. */
static void follow(struct rho_feed *feed, int64_t time_us)
{
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        struct rho_feed_source *source = &feed->sources[i];

        if (is_near(source->place.time_us, time_us, feed->config.jump_max_us)) {
            source->off_clock = 0;
        } else if (source->off_clock == 0) {
            source->off_clock = 1;
        }
    }
    feed->is_restart = 1;
}

int rho_feed_is_on_clock(struct rho_feed *feed, struct rho_feed_source *source, int64_t time_us,
                         enum feed_verdict verdict, int64_t now_us)
{
    if (feed->has_clock && !is_near(time_us, feed->clock_us, feed->config.jump_max_us)) {
        /* The scans that a sensor's new numbers were followed for have shown its new time as well. */
        if (verdict == FEED_FOLLOW && source->off_clock < feed->config.follow_scans) {
            source->off_clock = feed->config.follow_scans;
        } else if (source->off_clock < UINT16_MAX) {
            source->off_clock++;
        }
        if (source->off_clock < feed->config.follow_scans ||
            !is_outvoted(feed, source, time_us, now_us)) {
            return 0;
        }
        follow(feed, time_us);
    }
    source->off_clock = 0;
    feed->clock_us = time_us;
    feed->has_clock = 1;
    return 1;
}
