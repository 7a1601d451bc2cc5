/* SPDX-License-Identifier: MIT */
/* parse: parses numbers and times of files and parameters. */
#ifndef RHOTRACK_TOOL_PARSE_H
#define RHOTRACK_TOOL_PARSE_H

#include <stdbool.h>
#include <stdint.h>

/* Functions that return a text return NULL and set the value, or the reason of the failure. */

/*
 * Parses a plain decimal number within float range; NaN, Inf, hexadecimal and trailing text fail.
 */
const char *parse_number_or_give_reason(const char *cell, double *value);

/*
 * Parses the number at the head of a list, up to a blank or comma, and advances *list behind it; on
 * failure *list stays.
 */
const char *parse_next_number(const char **list, double *value);

/*
 * Parses decimal seconds as microseconds, rounded to nearest; exact, without floating point, where
 * the number has no exponent. |t| <= 4e12 s.
 */
const char *parse_time_us_or_give_reason(const char *cell, int64_t *time_us);

/*
 * Parses YYYY-MM-DDThh:mm:ss[.f][Z|+hh:mm] (or with a blank for the T) as microseconds since 1970;
 * UTC without a zone. Returns false for other texts.
 */
bool iso_time_to_us(const char *text, int64_t *time_us);

/* Parses a whole number within the range of int32_t. */
const char *parse_int32_or_give_reason(const char *cell, int32_t *value);

#endif
