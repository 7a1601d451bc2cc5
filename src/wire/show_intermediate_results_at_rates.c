/* SPDX-License-Identifier: MIT */
/*
 * show_intermediate_results_at_rates: sends ghosts, votes and hypotheses of a step as messages,
 * each kind within its rate.
 */
#include "rhotrack/publish.h"

#include <string.h>

#include "message_clamps.h"
#include "show_writers.h"

#define MAGIC 0x53484f57u /* "SHOW" */
#define SECOND_US 1000000
#define RATE_MAX 10000u
#define ALL_KINDS ((1u << RHO_NUM_SHOW_KINDS) - 1u)

void rho_show_config_default(struct rho_show_config *config)
{
    *config = (struct rho_show_config){.kinds = ALL_KINDS, .messages_per_s = 50};
}

enum rho_status rho_show_init(struct rho_show *show, size_t size,
                              const struct rho_show_config *config)
{
    if (!show || !config) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *show) {
        return RHO_ERROR_SIZE;
    }
    if (config->kinds == 0 || config->kinds > ALL_KINDS || config->messages_per_s == 0 ||
        config->messages_per_s > RATE_MAX) {
        return RHO_ERROR_CONFIG;
    }
    const struct rho_show_config kept = *config; /* config may point into *show */
    memset(show, 0, sizeof *show);
    show->config = kept;
    show->magic = MAGIC;
    return RHO_OK;
}

/* ---- rates ----------------------------------------------------------------------------------- */

static int64_t message_cost_us(const struct rho_show *show)
{
    return (SECOND_US + show->config.messages_per_s - 1) / show->config.messages_per_s;
}

static void add_elapsed_credit(struct rho_show_rate *rate, int64_t now_us)
{
    if (!rate->has_time || now_us < rate->since_us) {
        rate->credit_us = SECOND_US;
    } else {
        const uint64_t more_us = (uint64_t)now_us - (uint64_t)rate->since_us;
        rate->credit_us += (int64_t)(more_us < 2 * SECOND_US ? more_us : 2 * SECOND_US);
        rate->credit_us = rate->credit_us < SECOND_US ? rate->credit_us : SECOND_US;
    }
    rate->since_us = now_us;
    rate->has_time = 1;
}

/* Plans to send `sent` of a step's messages, takes their cost off the credit, counts the others. */
static void plan_messages_and_spend_credit(const struct rho_show *show, struct rho_show_rate *rate,
                                           uint32_t sent, uint32_t all)
{
    rate->left = sent;
    rate->at = 0;
    rate->credit_us -= (int64_t)sent * message_cost_us(show);
    rate->not_sent = rho_count(rate->not_sent, all - sent);
}

/* Number of messages, one a track, that the credit pays for: at most `all`. */
static uint32_t num_affordable_messages(const struct rho_show *show,
                                        const struct rho_show_rate *rate, uint32_t all)
{
    const int64_t most =
        rate->credit_us > 0 ? (rate->credit_us - 1) / message_cost_us(show) + 1 : 0;
    return most < (int64_t)all ? (uint32_t)most : all;
}

/* ---- a step ---------------------------------------------------------------------------------- */

static uint32_t num_messages_of_kind(const struct rho_show *show,
                                     const struct rho_show_source *source, unsigned kind)
{
    return kind == RHO_SHOW_GHOSTS  ? rho_show_count_ghost_matrix_messages(source)
           : kind == RHO_SHOW_VOTES ? rho_show_count_accumulator_messages(show, source)
                                    : source->report->num_tracks;
}

void rho_show_begin(struct rho_show *show, const struct rho_show_source *source, int64_t now_us)
{
    if (!show || show->magic != MAGIC) {
        return;
    }
    for (unsigned kind = 0; kind < RHO_NUM_SHOW_KINDS; kind++) {
        struct rho_show_rate *rate = &show->rates[kind];
        rate->left = 0;
        if (!source || !source->tracker || !source->report || !(show->config.kinds >> kind & 1u)) {
            continue;
        }
        const uint32_t all = num_messages_of_kind(show, source, kind);
        add_elapsed_credit(rate, now_us);
        plan_messages_and_spend_credit(show, rate,
                                       kind == RHO_SHOW_HYPOTHESES
                                           ? num_affordable_messages(show, rate, all)
                                       : rate->credit_us > 0 ? all
                                                             : 0,
                                       all);
    }
}

/* Row of the track to be shown next: the one with the next identity after the last shown one. */
static unsigned choose_next_track_to_show(struct rho_show *show, const struct rho_report *report)
{
    unsigned track = 0;
    while (track < report->num_tracks && report->tracks[track].track_id <= show->last_track_id) {
        track++;
    }
    track = track < report->num_tracks ? track : 0;
    show->last_track_id = report->tracks[track].track_id;
    return track;
}

static const char *write_message_and_give_channel(struct rho_show *show,
                                                  const struct rho_show_source *source,
                                                  unsigned kind, uint32_t number,
                                                  const struct rho_show_output *output)
{
    return kind == RHO_SHOW_GHOSTS ? rho_show_write_ghost_matrix_part(source, number, output)
           : kind == RHO_SHOW_VOTES
               ? rho_show_write_accumulator_or_picture(show, source, number, output)
               : rho_show_write_hypotheses_message(
                     source, choose_next_track_to_show(show, source->report), output);
}

const char *rho_show_next(struct rho_show *show, const struct rho_show_source *source,
                          uint8_t *buffer, size_t capacity, size_t *size)
{
    if (!show || show->magic != MAGIC || !source || !buffer || !size ||
        capacity < RHO_SHOW_MAX_SIZE) {
        return NULL;
    }
    struct rho_show_output output;
    output.buffer = buffer;
    output.capacity = capacity;
    output.size = size;
    for (unsigned kind = 0; kind < RHO_NUM_SHOW_KINDS; kind++) {
        struct rho_show_rate *rate = &show->rates[kind];
        output.not_sent = rho_clamp_to_int32(rate->not_sent);
        while (rate->left > 0) {
            rate->left--;
            const char *channel =
                write_message_and_give_channel(show, source, kind, rate->at++, &output);
            if (channel) {
                return channel;
            }
        }
    }
    return NULL;
}

uint32_t rho_show_not_sent(const struct rho_show *show, enum rho_show_kind kind)
{
    return show && show->magic == MAGIC && (unsigned)kind < RHO_NUM_SHOW_KINDS
               ? show->rates[kind].not_sent
               : 0;
}
