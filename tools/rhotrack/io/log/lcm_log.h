/* SPDX-License-Identifier: MIT */
/*
 * lcm_log: LCM event logs, as lcm-logger writes and lcm-logplayer reads them.
 *
 * An event is the sync word 0xEDA1DA01, int64 event number, int64 utime (us), int32 length of the
 * channel, int32 length of the data, channel, data; big endian. The reader trusts none of these
 * numbers: what is no whole event is skipped up to the next sync word, and counted. Damage can make
 * an event longer than it was, over the events behind it: one that is not followed by another sync
 * word is therefore none where a whole header begins inside it.
 */
#ifndef RHOTRACK_TOOL_LCM_LOG_H
#define RHOTRACK_TOOL_LCM_LOG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define LCM_LOG_SYNC UINT32_C(0xEDA1DA01)
#define LCM_LOG_HEADER_BYTES 28u
#define LCM_LOG_CHANNEL_AT 20u /* in the header: the channel's length, the data's */
#define LCM_LOG_DATA_AT 24u
#define LCM_LOG_MAX_CHANNEL 63u /* characters, as in LCM's datagrams; at least one, and no NUL */
#define LCM_LOG_MAX_DATA (UINT32_C(64) << 20)

struct lcm_log_event {
    int64_t number, utime;
    char channel[LCM_LOG_MAX_CHANNEL + 1];
    const uint8_t *data; /* inside the bytes that were parsed */
    size_t size;
    uint64_t offset; /* of the event in its file */
};

/* ---- Bytes ---- */

enum lcm_log_found {
    /* the bytes begin with an event, *count bytes long; all of *event but offset is set */
    LCM_LOG_EVENT,
    LCM_LOG_SKIP, /* the first *count bytes belong to no event */
    LCM_LOG_MORE  /* it cannot be told before *count bytes are there; never at the end */
};

/*
 * Tells what the bytes begin with. is_end: nothing comes behind them. *count is never 0, but where
 * size is 0 and it is the end; of an event or a skip it is at most size, of MORE it is beyond. Any
 * bytes will do. Cost: proportional to *count.
 */
enum lcm_log_found lcm_log_parse(const uint8_t *data, size_t size, bool is_end,
                                 struct lcm_log_event *event, size_t *count);

/* ---- Files ---- */

struct lcm_log_reader;

/*
 * Whether a file is a log: a name that ends with .lcm, or a file (no pipe) that begins with a sync
 * word.
 */
bool lcm_log_is_log(const char *path);

/*
 * Errors: exit 2. Memory: a few times the longest event; of a log that lies about lengths what is
 * really there.
 */
struct lcm_log_reader *lcm_log_open(const char *path);

/*
 * The next event, valid until the next call. Returns false after the last. Bytes that cannot be
 * read: exit 2.
 */
bool lcm_log_next(struct lcm_log_reader *reader, struct lcm_log_event *event);

struct lcm_log_counts {
    uint64_t events;
    uint64_t bytes_skipped, places_skipped;
};
struct lcm_log_counts lcm_log_counts(const struct lcm_log_reader *reader);

/* How many bytes of the file are parsed. */
uint64_t lcm_log_position(const struct lcm_log_reader *reader);

/* Tells on standard error what was skipped: the first few places, then a sum. */
void lcm_log_report_skipped(const struct lcm_log_reader *reader);
void lcm_log_close(struct lcm_log_reader *reader);

/* ---- Writing ---- */

/* An event's header; channel and data: their bytes, which follow it. */
void lcm_log_put_header(uint8_t header[LCM_LOG_HEADER_BYTES], int64_t number, int64_t utime,
                        size_t channel, size_t data);

/* An event's bytes, with its header. */
uint64_t lcm_log_event_bytes(uint64_t channel, uint64_t data);

/* The file is the caller's: to be opened, flushed, and closed. Numbers go up from 0. */
struct lcm_log_writer {
    FILE *file;
    int64_t number; /* of the next event */
};

/*
 * Returns false where the file did not take it (errno says why), or the channel or the size is none
 * of a log.
 */
bool lcm_log_write(struct lcm_log_writer *writer, int64_t utime, const char *channel,
                   const uint8_t *data, size_t size);

/* The same; where it would return false: exit 1 with the file's name. */
void lcm_log_must_write(struct lcm_log_writer *writer, const char *path, int64_t utime,
                        const char *channel, const uint8_t *data, size_t size);

#endif
