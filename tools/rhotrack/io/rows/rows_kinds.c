/* SPDX-License-Identifier: MIT */
/*
 * rows_kinds: the list of all kinds of rows, and the kind of a channel.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/rows/rows_in_memory.h"

const struct rows_kind *const rows_kinds[NUM_ROWS_KINDS] = {
    [ROWS_PLOTS] = &rows_kind_plots,       [ROWS_POLAR] = &rows_kind_polar,
    [ROWS_BEARINGS] = &rows_kind_bearings, [ROWS_TRUTH] = &rows_kind_truth,
    [ROWS_TRACKS] = &rows_kind_tracks,
};

/* Whether a text is a sensor number as channels have it: without leading zeros or a plus sign. */
static bool is_sensor_number(const char *text)
{
    char again[16];
    long number;

    errno = 0;
    number = strtol(text, NULL, 10);
    if (errno || number < INT16_MIN || number > INT16_MAX) {
        return false;
    }
    snprintf(again, sizeof again, "%ld", number);
    return strcmp(again, text) == 0;
}

bool rows_kind_has_channel(const struct rows_kind *kind, const char *channel)
{
    const size_t length = strlen(kind->channel);

    return strncmp(channel, kind->channel, length) == 0 &&
           (kind->has_sensor ? is_sensor_number(channel + length) : channel[length] == '\0');
}

const struct rows_kind *rows_kind_of_channel(const char *channel)
{
    for (int i = 0; i < NUM_ROWS_KINDS; i++) {
        const struct rows_kind *kind = rows_kinds[i];

        if (rows_kind_has_channel(kind, channel) ||
            (kind->wider && rows_kind_has_channel(kind->wider, channel))) {
            return kind;
        }
    }
    return NULL;
}
