/* SPDX-License-Identifier: MIT */
#include "live/standby.h"

#include <string.h>

#include "base/common.h"
#include "rhotrack/message.h"

/* So long a silence is waited for; by the clock's last digits, which two nodes do not share. */
static int64_t silence_us(int64_t now_us)
{
    return STANDBY_SILENT_US + now_us % STANDBY_CHANCE_US;
}

struct standby standby_open(int64_t now_us, const char *url)
{
    if (!transport_url_tells_senders(url)) {
        fail(EXIT_USAGE, "node: --standby needs udpm://...: other URLs tell no sender");
    }
    return (struct standby){.is_on = true,
                            .heard_us = now_us,
                            .wait_us = silence_us(now_us),
                            .turn_us = now_us,
                            .any_us = now_us};
}

static void print_change(const char *what, const struct transport_sender *other, FILE *to)
{
    if (to) {
        fputs("rhotrack: standby: ", to);
        if (other) {
            transport_print_sender(other, to);
            fputs(" ", to);
        }
        fprintf(to, "%s\n", what);
    }
}

static void note_work(struct standby *standby, int64_t now_us)
{
    standby->was_stopped |= now_us > standby->turn_us + STANDBY_STOPPED_US;
    standby->turn_us = now_us;
}

void standby_note_message(struct standby *standby, const struct transport_message *message,
                          int64_t now_us)
{
    note_work(standby, now_us);
    if (!message->sender.is_own) {
        /* who was stopped was not deaf: it has it all to read */
        if (!standby->was_stopped && now_us > standby->any_us + STANDBY_DEAF_US) {
            standby->deaf_us = now_us;
        }
        standby->any_us = now_us;
    }
}

/* True of one that publishes, as does another, and goes on: top of standby.h. */
static bool stands_against(struct standby *standby, int64_t now_us)
{
    const bool was_deaf = standby->deaf_us > 0 && now_us < standby->deaf_us + STANDBY_DEAF_US;

    if (!standby->is_publishing || standby->was_stopped || was_deaf ||
        now_us < standby->began_us + STANDBY_RIVAL_US) {
        return false;
    }
    if (now_us > standby->heard_us + STANDBY_SILENT_US) {
        standby->rival_us = now_us;
    }
    return now_us < standby->rival_us + STANDBY_RIVAL_US;
}

bool standby_hear(struct standby *standby, const struct transport_message *message, int64_t now_us,
                  int32_t *epoch, FILE *to)
{
    const struct transport_sender *other = &message->sender;
    const bool is_same = standby->is_heard && other->address == standby->other.address &&
                         other->port == standby->other.port;
    struct rho_message_status status;
    const bool is_against = stands_against(standby, now_us);

    standby->heard_us = now_us;
    if (is_against) {
        return false;
    }
    if (!is_same) {
        standby->wait_us = silence_us(now_us);
        print_change("publishes; this node is silent", other, to);
    }
    standby->other = *other;
    standby->is_heard = true;
    standby->is_publishing = false;
    if (strcmp(message->channel, RHO_MESSAGE_STATUS_CHANNEL) != 0 ||
        rho_message_status_decode(message->data, message->size, &status) != RHO_OK) {
        return false;
    }
    *epoch = status.epoch;
    return true;
}

bool standby_take_turn(struct standby *standby, bool has_read_all, int64_t now_us, FILE *to)
{
    const bool was_stopped = standby->was_stopped;

    /* all that was said until it was seen to have been stopped, not before */
    standby->was_stopped = was_stopped && !has_read_all;
    note_work(standby, now_us);
    if (!standby->is_on || standby->was_stopped) {
        return false;
    }
    if (standby->is_publishing || now_us < standby->heard_us + standby->wait_us) {
        return standby->is_publishing && was_stopped;
    }
    print_change(standby->is_heard ? "is silent; this node publishes"
                                   : "no other node publishes; this one does",
                 standby->is_heard ? &standby->other : NULL, to);
    standby->is_publishing = true;
    standby->began_us = now_us;
    standby->is_heard = false;
    return true;
}

bool standby_may_send(const struct standby *standby, int64_t now_us)
{
    return !standby->is_on || (standby->is_publishing && !standby->was_stopped &&
                               now_us <= standby->turn_us + STANDBY_STOPPED_US);
}

int64_t standby_due_us(const struct standby *standby)
{
    return standby->is_on ? standby->turn_us + STANDBY_TURN_US : INT64_MAX;
}
