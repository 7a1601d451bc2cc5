/* SPDX-License-Identifier: MIT */
#include "io/log/message_shift.h"

#include "base/big_endian.h"
#include "rhotrack/message.h"

/* Byte offsets of a message's first members, and their sizes. */
enum { UTIME_AT = 8, SCAN_AT = 16, EPOCH_AT = 20, TIME_BYTES = 8, NUMBER_BYTES = 4 };

static bool has_scan_number(const uint8_t *data, size_t size)
{
    switch (rho_message_type_of(data, size)) {
    case RHO_MESSAGE_TYPE_PLOT_SCAN:
    case RHO_MESSAGE_TYPE_POLAR_SCAN:
    case RHO_MESSAGE_TYPE_BEARING_SCAN:
    case RHO_MESSAGE_TYPE_DIRECTION_SCAN:
    case RHO_MESSAGE_TYPE_TRACK_LIST:
    case RHO_MESSAGE_TYPE_PEAK_LIST:
    case RHO_MESSAGE_TYPE_TRUTH_LIST:
    case RHO_MESSAGE_TYPE_STATUS:
    case RHO_MESSAGE_TYPE_WORK:
    case RHO_MESSAGE_TYPE_SENSOR_LIST:
    case RHO_MESSAGE_TYPE_LEARNED:
    case RHO_MESSAGE_TYPE_LIFE:
    case RHO_MESSAGE_TYPE_CLUTTER_MAP:
    case RHO_MESSAGE_TYPE_GHOST_MATRIX:
    case RHO_MESSAGE_TYPE_ACCUMULATOR:
    case RHO_MESSAGE_TYPE_PLANE:
    case RHO_MESSAGE_TYPE_HYPOTHESES:
        return size >= SCAN_AT + NUMBER_BYTES;
    default:
        return false;
    }
}

static bool has_epoch_number(const uint8_t *data, size_t size)
{
    enum rho_message_type type = rho_message_type_of(data, size);

    return has_scan_number(data, size) && type != RHO_MESSAGE_TYPE_PEAK_LIST &&
           type != RHO_MESSAGE_TYPE_TRUTH_LIST && size >= EPOCH_AT + NUMBER_BYTES;
}

bool message_scan_number(const uint8_t *data, size_t size, int32_t *scan)
{
    if (!has_scan_number(data, size)) {
        return false;
    }
    *scan = (int32_t)load_big_endian(data + SCAN_AT, NUMBER_BYTES);
    return true;
}

void message_shift_in_time(uint8_t *data, size_t size, int64_t time_us, uint32_t scans)
{
    int64_t utime;

    if (has_scan_number(data, size) &&
        !__builtin_add_overflow((int64_t)load_big_endian(data + UTIME_AT, TIME_BYTES), time_us,
                                &utime)) {
        store_big_endian(data + UTIME_AT, (uint64_t)utime, TIME_BYTES);
        store_big_endian(data + SCAN_AT, load_big_endian(data + SCAN_AT, NUMBER_BYTES) + scans,
                         NUMBER_BYTES);
    }
}

void message_replace_epoch_number(uint8_t *data, size_t size, int32_t from, int32_t to)
{
    if (has_epoch_number(data, size) &&
        (int32_t)load_big_endian(data + EPOCH_AT, NUMBER_BYTES) == from) {
        store_big_endian(data + EPOCH_AT, (uint64_t)to, NUMBER_BYTES);
    }
}
