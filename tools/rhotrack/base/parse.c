/* SPDX-License-Identifier: MIT */
#include "base/parse.h"

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

const char *parse_number_or_give_reason(const char *cell, double *value)
{
    double number;

    if (!is_decimal(cell)) {
        const char *word = cell + (*cell == '+' || *cell == '-');

        if (!*cell) {
            return "is empty";
        }
        if (!strcasecmp(word, "nan") || !strcasecmp(word, "inf") || !strcasecmp(word, "infinity")) {
            return "is not finite";
        }
        return "is not a number";
    }
    number = strtod(cell, NULL);
    if (!(fabs(number) <= (double)FLT_MAX)) {
        return "is out of the range of float32";
    }
    *value = number;
    return NULL;
}

const char *parse_next_number(const char **list, double *value)
{
    const size_t bytes = strcspn(*list, " \t,");
    char cell[32];
    const char *reason;

    if (bytes >= sizeof cell) {
        return "is too long for a number";
    }
    memcpy(cell, *list, bytes);
    cell[bytes] = '\0';
    reason = parse_number_or_give_reason(cell, value);
    *list += reason ? 0 : bytes;
    return reason;
}

/*
 * Converts decimal seconds without exponent to microseconds digit by digit, rounding to nearest.
 * The caller has checked form and range.
 */
static int64_t decimal_seconds_to_us(const char *cell)
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

const char *parse_time_us_or_give_reason(const char *cell, int64_t *time_us)
{
    double seconds;
    const char *reason = parse_number_or_give_reason(cell, &seconds);

    if (reason) {
        return reason;
    }
    if (!(fabs(seconds) <= 4e12)) {
        return "is beyond 4e12 s";
    }
    *time_us = strpbrk(cell, "eE") ? (int64_t)llround(seconds * 1e6) : decimal_seconds_to_us(cell);
    return NULL;
}

const char *parse_int32_or_give_reason(const char *cell, int32_t *value)
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

/* Days from 1970-01-01 to a date of the Gregorian calendar. */
static int64_t days_since_1970(int year, int month, int day)
{
    int64_t from_march = month > 2 ? month - 3 : month + 9;
    int64_t years = month > 2 ? year : year - 1;

    return 365 * years + years / 4 - years / 100 + years / 400 + (153 * from_march + 2) / 5 + day -
           1 - 719468;
}

/* Reads numbers at the 9s of a pattern such as "9999-99-99"; its other characters must match. */
static bool read_digits_by_pattern(const char *text, const char *pattern, int *numbers)
{
    for (; *pattern; pattern++, text++) {
        if (*pattern != '9') {
            if (*text != *pattern) {
                return false;
            }
            numbers++;
        } else if ((*text >= '0' && *text <= '9')) {
            *numbers = 10 * *numbers + (*text - '0');
        } else {
            return false;
        }
    }
    return true;
}

/* Reads a time zone, "", "Z" or "+hh:mm", as its offset from UTC in minutes. */
static bool parse_time_zone(const char *text, int *minutes)
{
    int parts[2] = {0};

    *minutes = 0;
    if (*text == '\0' || strcmp(text, "Z") == 0) {
        return true;
    }
    if ((*text != '+' && *text != '-') || strlen(text) != 6 ||
        !read_digits_by_pattern(text + 1, "99:99", parts) || parts[0] > 23 || parts[1] > 59) {
        return false;
    }
    *minutes = (*text == '-' ? -1 : 1) * (60 * parts[0] + parts[1]);
    return true;
}

bool iso_time_to_us(const char *text, int64_t *time_us)
{
    int at[6] = {0}, zone;
    int64_t part_us = 0;

    if ((!read_digits_by_pattern(text, "9999-99-99T99:99:99", at) &&
         (memset(at, 0, sizeof at), !read_digits_by_pattern(text, "9999-99-99 99:99:99", at))) ||
        at[1] < 1 || at[1] > 12 || at[2] < 1 || at[2] > 31 || at[3] > 23 || at[4] > 59 ||
        at[5] > 60) {
        return false;
    }
    text += 19;
    if (*text == '.' || *text == ',') {
        int64_t weight_us = 100000;

        for (text++; (*text >= '0' && *text <= '9'); text++, weight_us /= 10) {
            part_us += weight_us * (*text - '0');
        }
    }
    if (!parse_time_zone(text, &zone)) {
        return false;
    }
    *time_us =
        (((days_since_1970(at[0], at[1], at[2]) * 24 + at[3]) * 60 + at[4] - zone) * 60 + at[5]) *
            INT64_C(1000000) +
        part_us;
    return true;
}
