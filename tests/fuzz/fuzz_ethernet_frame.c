/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as an Ethernet frame of the firmware example: an accepted payload lies within the
 * frame, and the frame built from it is accepted, too.
 */
#include <stdint.h>
#include <string.h>

#include "../../tools/firmware/board/udp_frame.h"
#include "check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const struct udp_frame_host host = {.mac = {2, 0, 0, 0, 0, 1}, .address = {10, 0, 0, 1}};
    uint8_t frame[UDP_FRAME_MAX];
    const uint8_t *payload = NULL, *again = NULL;
    size_t length = udp_frame_find_payload(data, size, &payload);

    if (length == 0) {
        return 0;
    }
    CHECK(payload >= data + UDP_FRAME_HEAD && length <= size - (size_t)(payload - data));
    if (length <= UDP_FRAME_MAX - UDP_FRAME_HEAD) {
        memcpy(frame + UDP_FRAME_HEAD, payload, length);
        size_t built = udp_frame_build_around_payload(frame, &host, 1, length);
        CHECK(built == UDP_FRAME_HEAD + length);
        CHECK(udp_frame_find_payload(frame, built, &again) == length &&
              again == frame + UDP_FRAME_HEAD);
    }
    return 0;
}
