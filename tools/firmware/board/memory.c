/* SPDX-License-Identifier: MIT */
/*
 * memory: what compilers call without being asked, so that the node needs no C library. Words where
 * both sides are on word boundaries, as the library's objects are. A tenth of newlib's size.
 * Compiled with -fno-builtin, and without -flto: a compiler would make calls of themselves of these
 * loops.
 */
#include <stddef.h>
#include <stdint.h>

#define WORD 4u

/* No string.h: there is no C library. */
void *memcpy(void *restrict to, const void *restrict from, size_t size);
void *memmove(void *to, const void *from, size_t size);
void *memset(void *to, int value, size_t size);
int memcmp(const void *one, const void *other, size_t size);

static int are_aligned(const void *one, const void *other)
{
    return (((uintptr_t)one | (uintptr_t)other) & (WORD - 1u)) == 0;
}

/* From the first byte on: right also where `to` lies before what is left of `from`. */
static void copy_up(uint8_t *out, const uint8_t *in, size_t size)
{
    if (are_aligned(out, in)) {
        for (; size >= WORD; size -= WORD, out += WORD, in += WORD) {
            *(uint32_t *)(void *)out = *(const uint32_t *)(const void *)in;
        }
    }
    while (size-- > 0) {
        *out++ = *in++;
    }
}

void *memcpy(void *restrict to, const void *restrict from, size_t size)
{
    copy_up(to, from, size);
    return to;
}

void *memmove(void *to, const void *from, size_t size)
{
    uint8_t *out = to;
    const uint8_t *in = from;
    if (out <= in) {
        copy_up(out, in, size);
        return to;
    }
    while (size-- > 0) {
        out[size] = in[size];
    }
    return to;
}

void *memset(void *to, int value, size_t size)
{
    uint8_t *out = to;
    const uint32_t word = (uint8_t)value * 0x01010101u;
    if (are_aligned(out, out)) {
        for (; size >= WORD; size -= WORD, out += WORD) {
            *(uint32_t *)(void *)out = word;
        }
    }
    while (size-- > 0) {
        *out++ = (uint8_t)value;
    }
    return to;
}

int memcmp(const void *one, const void *other, size_t size)
{
    const uint8_t *a = one, *b = other;
    for (; size > 0; size--, a++, b++) {
        if (*a != *b) {
            return *a - *b;
        }
    }
    return 0;
}
