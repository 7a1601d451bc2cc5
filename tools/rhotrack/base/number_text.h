/* SPDX-License-Identifier: MIT */
/* number_text: numbers as files and parameters write them. */
#ifndef RHOTRACK_TOOL_NUMBER_TEXT_H
#define RHOTRACK_TOOL_NUMBER_TEXT_H

#include <stdbool.h>
#include <stdint.h>

/* All return NULL and set the value, or return the reason as a constant text. */

/* Plain decimal, within float range; NaN, Inf, hexadecimal and trailing text are refused. */
const char *text_to_number(const char *cell, double *value);

/*
 * The number at the head of a list, up to a blank or a comma; *list is behind it then, else it
 * stays.
 */
const char *text_to_next_number(const char **list, double *value);

/*
 * A decimal number of seconds in microseconds, rounded to nearest, without a detour over floating
 * point where it has no exponent; |t| <= 4e12 s.
 */
const char *text_to_time_us(const char *cell, int64_t *time_us);

/*
 * YYYY-MM-DDThh:mm:ss[.f][Z|+hh:mm], or a blank for the T, in microseconds since 1970, UTC where no
 * zone is said. false: it is none.
 */
bool iso_time_to_us(const char *text, int64_t *time_us);

/* A whole number within int32_t. */
const char *text_to_int32(const char *cell, int32_t *value);

#endif
