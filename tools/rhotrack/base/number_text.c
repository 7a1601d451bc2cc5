/* SPDX-License-Identifier: MIT */
#include "base/number_text.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const char *skip_digits(const char *c)
{
    while (*c >= '0' && *c <= '9') {
        c++;
    }
    return c;
}

/* True for [+-]digits[.digits][e[+-]digits] with a digit before the exponent. */
static bool is_decimal(const char *cell)
{
    const char *start = cell + (*cell == '+' || *cell == '-');
    const char *c = skip_digits(start);
    bool has_digits = c > start;

    if (*c == '.') {
        start = ++c;
        c = skip_digits(c);
        has_digits |= c > start;
    }
    if (has_digits && (*c == 'e' || *c == 'E')) {
        c++;
        start = c += *c == '+' || *c == '-';
        c = skip_digits(c);
        has_digits = c > start;
    }
    return has_digits && !*c;
}

static const char *why_not_decimal(const char *cell)
{
    const char *word = cell + (*cell == '+' || *cell == '-');

    if (!*cell) {
        return "is empty";
    }
    if (!strcasecmp(word, "nan") || !strcasecmp(word, "inf") || !strcasecmp(word, "infinity")) {
        return "is not finite";
    }
    return "is not a number";
}

const char *text_to_number(const char *cell, double *value)
{
    double number;

    if (!is_decimal(cell)) {
        return why_not_decimal(cell);
    }
    number = strtod(cell, NULL);
    if (!(fabs(number) <= (double)FLT_MAX)) {
        return "is out of the range of float32";
    }
    *value = number;
    return NULL;
}

/* Seconds without exponent, digit by digit; the caller has checked form and range. */
static int64_t exact_time_us(const char *cell)
{
    const char *c = cell + (*cell == '+' || *cell == '-');
    int64_t time_us = 0;

    for (; *c >= '0' && *c <= '9'; c++) {
        time_us = 10 * time_us + (*c - '0');
    }
    if (*c == '.') {
        c++;
    }
    for (int i = 0; i < 6; i++) {
        time_us = 10 * time_us + (*c ? *c++ - '0' : 0);
    }
    if (*c >= '5') {
        time_us++;
    }
    return *cell == '-' ? -time_us : time_us;
}

const char *text_to_time_us(const char *cell, int64_t *time_us)
{
    double seconds;
    const char *reason = text_to_number(cell, &seconds);

    if (reason) {
        return reason;
    }
    if (!(fabs(seconds) <= 4e12)) {
        return "is beyond 4e12 s";
    }
    *time_us = strpbrk(cell, "eE") ? (int64_t)llround(seconds * 1e6) : exact_time_us(cell);
    return NULL;
}

const char *text_to_int32(const char *cell, int32_t *value)
{
    const char *digits = cell + (*cell == '+' || *cell == '-');
    long number;

    if (!*cell) {
        return "is empty";
    }
    if (digits == skip_digits(digits) || *skip_digits(digits)) {
        return "is not an integer";
    }
    errno = 0;
    number = strtol(cell, NULL, 10);
    if (errno || number < INT32_MIN || number > INT32_MAX) {
        return "is out of the range of a 32-bit integer";
    }
    *value = (int32_t)number;
    return NULL;
}
