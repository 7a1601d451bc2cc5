/* SPDX-License-Identifier: MIT */
#include "scene/scene_random_streams.h"

struct random scene_random_stream(uint64_t seed, uint64_t run, enum stream_kind kind,
                                  uint64_t source, uint64_t item, uint64_t part)
{
    /* kind is in the high bits: scenarios written in C use small numbers as this argument */
    struct random first = random_start(seed, ((uint64_t)kind << 48) + source, run);

    return random_start(random_bits(&first), item, part);
}

double random_in_span(struct random *random, struct json_span span)
{
    return random_between(random, span.lo, span.hi);
}
