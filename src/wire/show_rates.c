/* SPDX-License-Identifier: MIT */
/* show_rates: sends ghosts, votes and hypotheses of a step, each kind within its rate. */
#include "rhotrack/publish.h"

#include <string.h>

#include "message_clamps.h"
#include "show_writers.h"

enum {
    MAGIC = 0x53484f57, /* "SHOW" */
    SECOND_US = 1000000,
    ALL_KINDS = (1 << RHO_NUM_SHOW_KINDS) - 1
};

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
        config->messages_per_s > 10000) {
        return RHO_ERROR_CONFIG;
    }
    const struct rho_show_config kept = *config; /* config may point into *show */
    memset(show, 0, sizeof *show);
    show->config = kept;
    show->magic = MAGIC;
    return RHO_OK;
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

void rho_show_begin(struct rho_show *show, const struct rho_show_source *source, int64_t now_us)
{
    if (!show || show->magic != MAGIC) {
        return;
    }
    const int64_t cost_us =
        (SECOND_US + show->config.messages_per_s - 1) / show->config.messages_per_s;
    for (unsigned kind = 0; kind < RHO_NUM_SHOW_KINDS; kind++) {
        struct rho_show_rate *rate = &show->rates[kind];
        rate->left = 0;
        if (!source || !source->tracker || !source->report || !(show->config.kinds >> kind & 1u)) {
            continue;
        }
        const uint32_t all = kind == RHO_SHOW_GHOSTS  ? rho_show_count_ghosts(source)
                             : kind == RHO_SHOW_VOTES ? rho_show_count_accumulators(show, source)
                                                      : source->report->num_tracks;
        add_elapsed_credit(rate, now_us);
        /* Whole matrices and accumulators, or as many tracks as the credit pays for, are sent. */
        int64_t most = rate->credit_us > 0 ? all : 0;
        if (kind == RHO_SHOW_HYPOTHESES && most > 0) {
            most = (rate->credit_us - 1) / cost_us + 1;
        }
        rate->left = most < (int64_t)all ? (uint32_t)most : all;
        rate->at = 0;
        rate->credit_us -= (int64_t)rate->left * cost_us;
        rate->not_sent = rho_count(rate->not_sent, all - rate->left);
    }
}

/* Row of the track to be shown next: the one with the next identity after the last shown one. */
static unsigned choose_next_track(struct rho_show *show, const struct rho_report *report)
{
    unsigned track = 0;
    while (track < report->num_tracks && report->tracks[track].track_id <= show->last_track_id) {
        track++;
    }
    track = track < report->num_tracks ? track : 0;
    show->last_track_id = report->tracks[track].track_id;
    return track;
}

const char *rho_show_next(struct rho_show *show, const struct rho_show_source *source,
                          uint8_t *buffer, size_t capacity, size_t *size)
{
    if (!show || show->magic != MAGIC || !source || !buffer || !size ||
        capacity < RHO_SHOW_MAX_SIZE) {
        return NULL;
    }
    struct rho_show_output output = {.capacity = capacity};
    output.buffer = buffer;
    for (unsigned kind = 0; kind < RHO_NUM_SHOW_KINDS; kind++) {
        struct rho_show_rate *rate = &show->rates[kind];
        output.not_sent = rho_clamp_to_int32(rate->not_sent);
        while (rate->left > 0) {
            const uint32_t number = rate->at++;
            rate->left--;
            const enum rho_status status =
                kind == RHO_SHOW_GHOSTS ? rho_show_write_ghosts(source, number, &output)
                : kind == RHO_SHOW_VOTES
                    ? rho_show_write_accumulator(show, source, number, &output)
                    : rho_show_write_hypotheses(source, choose_next_track(show, source->report),
                                                &output);
            if (status == RHO_OK && rho_message_end(&output.writer, size) == RHO_OK) {
                return output.channel;
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
