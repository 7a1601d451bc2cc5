/* SPDX-License-Identifier: MIT */
#include "live/duplicate_senders.h"

#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "rhotrack/message.h"

#define SECOND_US 1000000
#define TOLD_US (60 * SECOND_US)   /* interval of warnings that a sensor may have another sender */
#define TURN_US (12 * SECOND_US)   /* revolution of a slow radar's antenna */
#define FORGET_US (60 * SECOND_US) /* a channel unheard for so long may lose its place */

static bool is_same_sender(const struct transport_sender *one, const struct transport_sender *other)
{
    return one->address == other->address && one->port == other->port;
}

/* ---- Sensors ---- */

/*
 * Parses the sensor_id in a channel's name, strictly: anyone on the network names channels, and the
 * name is printed.
 */
static bool parse_sensor_id(const char *text, int16_t *sensor_id)
{
    const char *digits = text + (*text == '-');
    const size_t count = strspn(digits, "0123456789");
    long id;

    if (count < 1 || count > 5 || digits[count] != '\0') {
        return false;
    }
    id = strtol(text, NULL, 10);
    *sensor_id = (int16_t)id;
    return id >= INT16_MIN && id <= INT16_MAX;
}

bool duplicate_senders_sensor_id(const char *channel, int16_t *sensor_id)
{
    static const char *const beginnings[] = {
        RHO_MESSAGE_POLAR_SCAN_CHANNEL, RHO_MESSAGE_PLOT_SCAN_CHANNEL,
        RHO_MESSAGE_BEARING_SCAN_CHANNEL, RHO_MESSAGE_DIRECTION_SCAN_CHANNEL};

    for (size_t i = 0; i < sizeof beginnings / sizeof *beginnings; i++) {
        if (text_begins_with(channel, beginnings[i])) {
            return parse_sensor_id(channel + strlen(beginnings[i]), sensor_id);
        }
    }
    return false;
}

/* Number of the list's channels of a sender, or of all senders of its address. */
static unsigned channels_held(const struct duplicate_senders *senders,
                              const struct transport_sender *sender, bool is_by_address)
{
    unsigned held = 0;

    for (unsigned i = 0; i < SENDERS_CHANNELS; i++) {
        const struct transport_sender *other = &senders->channels[i].last;

        held += is_by_address ? other->address == sender->address : is_same_sender(other, sender);
    }
    return held;
}

/*
 * The last channel of the sender with the most channels; of the address first, as a stranger has
 * more ports than addresses.
 */
static struct sender_channel *last_channel_of_most(struct duplicate_senders *senders)
{
    struct sender_channel *last = &senders->channels[0];
    unsigned most = 0;

    for (unsigned i = 0; i < SENDERS_CHANNELS; i++) {
        struct sender_channel *channel = &senders->channels[i];
        const unsigned held =
            channels_held(senders, &channel->last, true) * (SENDERS_CHANNELS + 1) +
            channels_held(senders, &channel->last, false);

        if (held > most || (held == most && channel->since_us > last->since_us)) {
            most = held;
            last = channel;
        }
    }
    return last;
}

/* The place that a new channel of the sender may take in a full list; NULL: none. */
static struct sender_channel *find_place_to_take(struct duplicate_senders *senders,
                                                 const struct transport_sender *sender,
                                                 int64_t now_us)
{
    struct sender_channel *place = &senders->channels[0];
    bool is_by_address;

    for (unsigned i = 1; i < SENDERS_CHANNELS; i++) {
        if (senders->channels[i].heard_us < place->heard_us) {
            place = &senders->channels[i];
        }
    }
    if (now_us >= place->heard_us + FORGET_US) {
        return place;
    }
    if (2 * channels_held(senders, sender, false) >= SENDERS_CHANNELS) {
        return NULL; /* none can have more; says so in less time where a stranger has many names */
    }
    place = last_channel_of_most(senders);
    is_by_address = place->last.address != sender->address;
    return channels_held(senders, &place->last, is_by_address) >
                   channels_held(senders, sender, is_by_address) + 1
               ? place
               : NULL;
}

/* Finds or adds the entry of the message's channel; NULL where there is no room. */
static struct sender_channel *find_or_add_channel(struct duplicate_senders *senders,
                                                  const struct transport_message *message,
                                                  int64_t now_us)
{
    struct sender_channel *channel;

    for (unsigned i = 0; i < senders->num_channels; i++) {
        if (strcmp(senders->channels[i].name, message->channel) == 0) {
            return &senders->channels[i];
        }
    }
    if (senders->num_channels == SENDERS_CHANNELS) {
        channel = find_place_to_take(senders, &message->sender, now_us);
    } else {
        channel = &senders->channels[senders->num_channels++];
    }
    if (channel) {
        *channel = (struct sender_channel){.last = message->sender, .since_us = now_us};
        snprintf(channel->name, sizeof channel->name, "%s", message->channel);
    }
    return channel;
}

static void print_sender_warning(struct duplicate_senders *senders,
                                 const struct sender_channel *channel, const char *what,
                                 const struct transport_sender *one, const char *between,
                                 const struct transport_sender *other, const char *end, FILE *to)
{
    senders->lines++;
    fprintf(to, "rhotrack: sensor %s has %s", strrchr(channel->name, '_') + 1, what);
    transport_print_sender(one, to);
    fputs(between, to);
    transport_print_sender(other, to);
    fputs(end, to);
}

static void note_sender_change(struct duplicate_senders *senders, struct sender_channel *channel,
                               const struct transport_sender *sender, int64_t now_us, FILE *to)
{
    const bool is_back = is_same_sender(&channel->before, sender);
    const bool is_told = channel->told_us > 0 && now_us < channel->told_us + TOLD_US;
    const bool is_live = channel->heard_us > 0 && now_us < channel->heard_us + TURN_US;

    if (is_back && !channel->is_named && to) {
        print_sender_warning(senders, channel, "two senders: ", &channel->before, " and ",
                             &channel->last, "; each needs a number of its own\n", to);
    } else if (!is_back && !is_told && is_live && to) {
        channel->told_us = now_us;
        print_sender_warning(senders, channel, "another sender, ", sender, ", until now ",
                             &channel->last, ": a restart, or two at once\n", to);
    }
    channel->is_named = is_back;
    channel->before = channel->last;
    channel->last = *sender;
}

static void note_sensor_message(struct duplicate_senders *senders,
                                const struct transport_message *message, int64_t now_us, FILE *to)
{
    struct sender_channel *channel = find_or_add_channel(senders, message, now_us);

    if (!channel) {
        return;
    }
    if (!is_same_sender(&channel->last, &message->sender)) {
        note_sender_change(senders, channel, &message->sender, now_us, to);
    }
    channel->heard_us = now_us;
}

/* ---- Nodes ---- */

static void note_node_message(struct duplicate_senders *senders,
                              const struct transport_sender *sender, FILE *to)
{
    for (unsigned i = 0; i < SENDERS_NODES; i++) {
        if (is_same_sender(&senders->nodes[i], sender)) {
            return;
        }
    }
    senders->nodes[senders->num_nodes++ % SENDERS_NODES] = *sender;
    if (to) {
        senders->lines++;
        fputs("rhotrack: another node publishes tracks here: ", to);
        transport_print_sender(sender, to);
        fputs("\n", to);
    }
}

void duplicate_senders_note_message(struct duplicate_senders *senders,
                                    const struct transport_message *message, int64_t now_us,
                                    FILE *to)
{
    int16_t sensor_id;

    if (message->sender.port == 0) {
        return; /* no sender is known: a file, or a transport of liblcm */
    }
    if (now_us >= senders->lines_us + SECOND_US) {
        senders->lines_us = now_us;
        senders->lines = 0;
    }
    to = senders->lines < SENDERS_LINES ? to : NULL;
    if (duplicate_senders_sensor_id(message->channel, &sensor_id)) {
        note_sensor_message(senders, message, now_us, to);
    } else if (!message->sender.is_own &&
               strcmp(message->channel, RHO_MESSAGE_STATUS_CHANNEL) == 0) {
        note_node_message(senders, &message->sender, to);
    }
}
