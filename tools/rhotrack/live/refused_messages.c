/* SPDX-License-Identifier: MIT */
#include "live/refused_messages.h"

#include <stdio.h>
#include <string.h>

/* Counters by which the assembler refuses the first scans of a sensor that restarted. */
enum cause { WRONG_NUMBER = 0, WRONG_TIME, DUPLICATE, TOO_LATE, NUM_CAUSES };

static uint32_t *counter_of_cause(struct rho_scan_assembler_counters *counters, unsigned cause)
{
    uint32_t *const all[NUM_CAUSES] = {&counters->scans_bad, &counters->clock_jumps,
                                       &counters->scans_duplicate, &counters->scans_late};

    return all[cause];
}

static uint32_t count_of_refusal_cause(const struct rho_scan_assembler_counters *counters,
                                       unsigned cause)
{
    struct rho_scan_assembler_counters copy = *counters;

    return *counter_of_cause(&copy, cause);
}

/* The counter that rose between the two states; NUM_CAUSES: none of them did. */
static unsigned find_refusal_cause(const struct rho_scan_assembler_counters *before,
                                   const struct rho_scan_assembler_counters *after)
{
    unsigned cause = WRONG_NUMBER;

    while (cause < NUM_CAUSES &&
           count_of_refusal_cause(before, cause) == count_of_refusal_cause(after, cause)) {
        cause++;
    }
    return cause;
}

static void drop_messages_of_channel(struct refused_messages *refused, const char *channel)
{
    for (unsigned i = 0; i < REFUSED_MESSAGES_MAX; i++) {
        if (strcmp(refused->of[i].channel, channel) == 0) {
            refused->of[i].channel[0] = '\0';
            refused->count--;
        }
    }
}

void refused_messages_keep(struct refused_messages *refused, const char *channel,
                           const uint8_t *data, size_t size,
                           const struct rho_scan_assembler_counters *before,
                           const struct rho_scan_assembler_counters *after)
{
    struct refused_message *message = &refused->of[refused->next];
    const unsigned cause = find_refusal_cause(before, after);

    if (after->scans_accepted != before->scans_accepted) {
        if (refused->count > 0) {
            drop_messages_of_channel(refused, channel);
        }
    } else if (cause < NUM_CAUSES && size <= sizeof message->data &&
               strlen(channel) < sizeof message->channel) {
        refused->count += message->channel[0] == '\0';
        snprintf(message->channel, sizeof message->channel, "%s", channel);
        message->cause = (uint8_t)cause;
        message->size = (uint16_t)size;
        memcpy(message->data, data, size);
        refused->next = (refused->next + 1) % REFUSED_MESSAGES_MAX;
    }
}

/*
 * Feeds a refused message to the assembler again. If the assembler now counts it as late, `taken`
 * compensates that count, as the message was in time when it first came.
 */
static void feed_message_again(const struct refused_message *message,
                               struct rho_scan_assembler *assembler, int64_t now_us,
                               struct rho_scan_assembler_counters *taken)
{
    const struct rho_scan_assembler_counters before = assembler->counters;

    if (rho_scan_assembler_take(assembler, message->channel, message->data, message->size,
                                now_us) != RHO_OK) {
        return;
    }
    taken->scans_late += assembler->counters.scans_late - before.scans_late;
    if (find_refusal_cause(&before, &assembler->counters) >= TOO_LATE) {
        ++*counter_of_cause(taken, message->cause);
    } else {
        ++*counter_of_cause(taken, find_refusal_cause(&before, &assembler->counters));
    }
}

void refused_messages_retry(struct refused_messages *refused, const char *channel,
                            struct rho_scan_assembler *assembler, int64_t now_us,
                            struct rho_scan_assembler_counters *taken)
{
    for (unsigned i = 0; i < REFUSED_MESSAGES_MAX && refused->count > 0; i++) {
        const struct refused_message *message =
            &refused->of[(refused->next + i) % REFUSED_MESSAGES_MAX];

        if (strcmp(message->channel, channel) == 0) {
            feed_message_again(message, assembler, now_us, taken);
        }
    }
    drop_messages_of_channel(refused, channel);
}

static uint32_t subtract_saturating(uint32_t count, uint32_t part)
{
    return count > part ? count - part : 0;
}

struct rho_scan_assembler_counters
refused_messages_correct(const struct rho_scan_assembler_counters *counters,
                         const struct rho_scan_assembler_counters *taken)
{
    struct rho_scan_assembler_counters shown = *counters;

    for (unsigned cause = WRONG_NUMBER; cause < NUM_CAUSES; cause++) {
        *counter_of_cause(&shown, cause) = subtract_saturating(
            count_of_refusal_cause(counters, cause), count_of_refusal_cause(taken, cause));
    }
    return shown;
}
