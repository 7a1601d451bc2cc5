/* SPDX-License-Identifier: MIT */
/*
 * lcm_log: reading and writing LCM event logs, as lcm-logger writes and lcm-logplayer reads them.
 *
 * An event is the sync word 0xEDA1DA01, int64 event number, int64 utime (us), int32 length of the
 * channel, int32 length of the data, channel, data; big endian. The reader trusts none of these
 * numbers: bytes that form no whole event are skipped up to the next sync word, and counted. Damage
 * can make an event's length too large, so that it covers the events after it: an event that is not
 * followed by a sync word is therefore skipped where another whole event header begins inside it.
 */
#ifndef RHOTRACK_TOOL_LCM_LOG_H
#define RHOTRACK_TOOL_LCM_LOG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define LCM_LOG_HEADER_BYTES 28u
/* offsets in an event's header: length of the channel, length of the data */
#define LCM_LOG_CHANNEL_AT 20u
#define LCM_LOG_DATA_AT 24u
#define LCM_LOG_MAX_CHANNEL 63u /* longest channel name in characters, as in LCM's datagrams */
#define LCM_LOG_MAX_DATA (UINT32_C(64) << 20)

struct lcm_log_event {
    int64_t number, utime;
    char channel[LCM_LOG_MAX_CHANNEL + 1];
    const uint8_t *data; /* the event's payload, inside the buffer that was parsed */
    size_t size;
    uint64_t offset; /* byte offset of the event in its file */
};

enum lcm_log_found {
    /* the bytes begin with an event of *count bytes; all of *event but offset is set */
    LCM_LOG_EVENT,
    LCM_LOG_SKIP, /* the first *count bytes belong to no event, and are to be skipped */
    LCM_LOG_MORE  /* *count bytes are needed before the outcome is known; never with is_end */
};

/*
 * Parses the beginning of a buffer: an event, bytes to skip, or too few bytes. is_end: no bytes of
 * the file follow the buffer. For an event or a skip *count is at most size (0 only where size is 0
 * at the end), for LCM_LOG_MORE it is beyond size. Accepts any bytes. Cost: proportional to *count.
 */
enum lcm_log_found lcm_log_parse(const uint8_t *data, size_t size, bool is_end,
                                 struct lcm_log_event *event, size_t *count);

struct lcm_log_reader;

/*
 * Whether a file is an LCM log: its name ends with .lcm, or it is a plain file that begins with a
 * sync word.
 */
bool lcm_log_is_log(const char *path);

/*
 * Opens a log for reading. Errors: exit 2. Memory: a few times the longest event; a false length in
 * a damaged log does not enlarge it beyond the bytes that the file really has.
 */
struct lcm_log_reader *lcm_log_open(const char *path);

/*
 * Reads the next event, valid until the next call. Returns false after the last event. Exit 2 where
 * the file cannot be read.
 */
bool lcm_log_next(struct lcm_log_reader *reader, struct lcm_log_event *event);

struct lcm_log_counts {
    uint64_t events;
    uint64_t bytes_skipped, places_skipped;
};
struct lcm_log_counts lcm_log_counts(const struct lcm_log_reader *reader);

/* Number of bytes of the file that have been parsed, skipped ones included. */
uint64_t lcm_log_position(const struct lcm_log_reader *reader);

/* Reports skipped bytes on standard error: the first few places each, then a sum. */
void lcm_log_report_skipped(const struct lcm_log_reader *reader);
void lcm_log_close(struct lcm_log_reader *reader);

/*
 * Fills an event's header; channel_bytes and data_bytes are the lengths in bytes of the parts that
 * follow it.
 */
void lcm_log_put_header(uint8_t header[LCM_LOG_HEADER_BYTES], int64_t number, int64_t utime,
                        size_t channel_bytes, size_t data_bytes);

/* Bytes of a whole event, header included, from the lengths of its channel and data. */
uint64_t lcm_log_event_bytes(uint64_t channel_bytes, uint64_t data_bytes);

/* Writer of events, numbered from 0. The caller opens, flushes and closes the file. */
struct lcm_log_writer {
    FILE *file;
    int64_t number; /* event number of the next event */
};

/*
 * Writes one event. Returns false where writing failed (errno says why), or where the channel name
 * or the data is too long for a log, or the channel name is empty.
 */
bool lcm_log_write(struct lcm_log_writer *writer, int64_t utime, const char *channel,
                   const uint8_t *data, size_t size);

/* Writes one event like lcm_log_write; exit 1 with the file's name where that fails. */
void lcm_log_must_write(struct lcm_log_writer *writer, const char *path, int64_t utime,
                        const char *channel, const uint8_t *data, size_t size);

#endif
