/* SPDX-License-Identifier: MIT */
/*
 * memory: memcpy, memmove, memset and memcmp, which compilers call implicitly, so that the node
 * needs no C library. Copies words where both sides are aligned. A tenth of newlib's size. Compiled
 * with -fno-builtin and without -flto: a compiler would turn these loops into calls of themselves.
 */
#include <stddef.h>
#include <stdint.h>

#define WORD 4u

/* Declared here because there is no string.h without a C library. */
void *memcpy(void *restrict to, const void *restrict from, size_t size);
void *memmove(void *to, const void *from, size_t size);
void *memset(void *to, int value, size_t size);
int memcmp(const void *one, const void *other, size_t size);

static int are_word_aligned(const void *one, const void *other)
{
    return (((uintptr_t)one | (uintptr_t)other) & (WORD - 1u)) == 0;
}

/*
 * Copies from the first byte to the last: correct for overlapping ranges if `out` is before `in`.
 */
static void copy_ascending(uint8_t *out, const uint8_t *in, size_t size)
{
    if (are_word_aligned(out, in)) {
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
    copy_ascending(to, from, size);
    return to;
}

void *memmove(void *to, const void *from, size_t size)
{
    uint8_t *out = to;
    const uint8_t *in = from;
    if (out <= in) {
        copy_ascending(out, in, size);
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
    if (are_word_aligned(out, out)) {
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
