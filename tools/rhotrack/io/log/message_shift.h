/* SPDX-License-Identifier: MIT */
/*
 * message_shift: the same message at another time. All messages of rhotrack begin with their
 * fingerprint, utime and scan (lcm_types/), and those of sensors and of tracks go on with epoch;
 * these bytes are replaced, the others stay as they are.
 */
#ifndef RHOTRACK_TOOL_MESSAGE_SHIFT_H
#define RHOTRACK_TOOL_MESSAGE_SHIFT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The number of a message's scan. False: none of rhotrack's messages that have one. */
bool message_scan_number(const uint8_t *data, size_t size, int32_t *scan);

/*
 * Later by time_us, scan higher by scans (it wraps). Leaves other messages, and times that would go
 * beyond int64, alone.
 */
void message_shift_in_time(uint8_t *data, size_t size, int64_t time_us, uint32_t scans);

/* Another epoch where it is `from`. */
void message_set_epoch(uint8_t *data, size_t size, int32_t from, int32_t to);

#endif
