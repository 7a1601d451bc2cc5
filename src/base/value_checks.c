/* SPDX-License-Identifier: MIT */
#include "rhotrack/types.h"

#include <float.h>

static const char fate_names[RHO_NUM_FATES][8] = {
    [RHO_FATE_CLAIMED] = "claimed", [RHO_FATE_HELD] = "held",       [RHO_FATE_GHOST] = "ghost",
    [RHO_FATE_STALE] = "stale",     [RHO_FATE_INVALID] = "invalid", [RHO_FATE_NO_ROOM] = "no_room",
};

/*
 * Converts to the nearest float: bits shifted out set the last bit, which decides the rounding.
 * Compilers' own conversion from 64 bits would link double arithmetic into firmware. Divides by
 * 1e6, as a factor of 1e-6f is not exact in binary: one rounding for spans up to 2^24 us.
 */
static float us_to_seconds(uint64_t span_us)
{
    float scale = 1.0f;
    while (span_us > UINT32_MAX) {
        span_us = span_us >> 1 | (span_us & 1u);
        scale *= 2.0f;
    }
    return (float)(uint32_t)span_us * scale / 1.0e6f;
}

const char *rho_fate_name(enum rho_fate fate)
{
    const unsigned value = (unsigned)fate;
    return value < RHO_NUM_FATES ? fate_names[value] : "unknown";
}

/* Counts bits in pairs, then in groups of four and eight, then all together. */
unsigned rho_count_bits(uint32_t mask)
{
    mask = mask - (mask >> 1 & 0x55555555u);
    mask = (mask & 0x33333333u) + (mask >> 2 & 0x33333333u);
    mask = (mask + (mask >> 4)) & 0x0f0f0f0fu;
    return (unsigned)((mask * 0x01010101u) >> 24);
}

/* The difference needs 64 bits and a sign, which is taken first; the magnitude is unsigned. */
float rho_seconds_between(int64_t from_us, int64_t to_us)
{
    const uint64_t from = (uint64_t)from_us;
    const uint64_t to = (uint64_t)to_us;
    return from_us <= to_us ? us_to_seconds(to - from) : -us_to_seconds(from - to);
}

uint64_t rho_elapsed_us(int64_t now_us, int64_t then_us)
{
    return now_us <= then_us ? 0 : (uint64_t)now_us - (uint64_t)then_us;
}

int rho_is_within(float v, float lo, float hi)
{
    return v >= lo && v <= hi && rho_is_finite(v);
}

int rho_are_within(const float *values, size_t count, float lo, float hi)
{
    for (size_t i = 0; i < count; i++) {
        if (!rho_is_within(values[i], lo, hi)) {
            return 0;
        }
    }
    return 1;
}

int rho_are_finite(const float *values, size_t count)
{
    return rho_are_within(values, count, -FLT_MAX, FLT_MAX);
}

int rho_is_stored_time(int64_t time_us)
{
    const int64_t most_us = RHO_LIMIT_TIME_US + 4 * (int64_t)RHO_LIMIT_OFFSET_US;
    return time_us >= -most_us && time_us <= most_us;
}

float rho_plot_sigma_m(const struct rho_plot *plot)
{
    return plot->sigma_range_m > plot->sigma_cross_m ? plot->sigma_range_m : plot->sigma_cross_m;
}

int rho_is_coordinate(float v_m)
{
    return rho_is_within(v_m, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M);
}
