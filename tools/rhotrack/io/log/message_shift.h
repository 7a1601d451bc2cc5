/* SPDX-License-Identifier: MIT */
/*
 * message_shift: changes the time, scan number and epoch in an encoded message,
 * for playing a file again. All messages of rhotrack begin with fingerprint, utime and scan
 * (lcm_types/), and those of sensors and of tracks go on with epoch; the other bytes stay as they
 * are.
 */
#ifndef RHOTRACK_TOOL_MESSAGE_SHIFT_H
#define RHOTRACK_TOOL_MESSAGE_SHIFT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Reads the scan number of an encoded message. Returns false for messages without a scan number. */
bool message_scan_number(const uint8_t *data, size_t size, int32_t *scan);

/*
 * Adds time_us to a message's utime, and scans (modulo 2^32) to its scan number. Other messages,
 * and those whose time would exceed int64, stay as they are.
 */
void message_shift_in_time(uint8_t *data, size_t size, int64_t time_us, uint32_t scans);

/* Replaces a message's epoch by `to` where it is `from`. */
void message_replace_epoch_number(uint8_t *data, size_t size, int32_t from, int32_t to);

#endif
