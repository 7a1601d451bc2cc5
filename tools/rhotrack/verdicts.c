/* SPDX-License-Identifier: MIT */
#include "verdicts.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#define ROUNDING 1e-9 /* of sums of counts */

struct verdicts verdicts_start(void)
{
    return (struct verdicts){.grid = grid_start(1, "what must hold|measured|bar|verdict"),
                             .json = cJSON_CreateArray()};
}

static void add(struct verdicts *verdicts, const char *what, double value, const char *relation,
                double bar, int is_held)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "what", what);
    cJSON_AddItemToObject(object, "value",
                          isfinite(value) ? cJSON_CreateNumber(value) : cJSON_CreateNull());
    cJSON_AddNumberToObject(object, relation[0] == '<' ? "at_most" : "at_least", bar);
    cJSON_AddBoolToObject(object, "held", is_held);
    cJSON_AddItemToArray(verdicts->json, object);
    grid_row(&verdicts->grid, "%s|%.4g|%s %.4g|%s", what, value, relation, bar,
             is_held ? "ok" : "MISSED");
    verdicts->held += is_held;
    verdicts->missed += !is_held;
}

#define FORMAT_WHAT(text)                                                                          \
    char text[160];                                                                                \
    va_list list;                                                                                  \
    va_start(list, what);                                                                          \
    vsnprintf(text, sizeof text, what, list);                                                      \
    va_end(list)

void verdicts_at_most(struct verdicts *verdicts, double value, double bar, const char *what, ...)
{
    FORMAT_WHAT(text);
    add(verdicts, text, value, "<=", bar, value <= bar + ROUNDING);
}

void verdicts_at_least(struct verdicts *verdicts, double value, double bar, const char *what, ...)
{
    FORMAT_WHAT(text);
    add(verdicts, text, value, ">=", bar, value >= bar - ROUNDING);
}

void verdicts_to_json(struct verdicts *verdicts, cJSON *object)
{
    cJSON_AddItemToObject(object, "bars", verdicts->json);
    cJSON_AddNumberToObject(object, "bars_held", verdicts->held);
    cJSON_AddNumberToObject(object, "bars_missed", verdicts->missed);
    verdicts->json = NULL;
}

void verdicts_print(const struct verdicts *verdicts, FILE *out)
{
    grid_print(&verdicts->grid, out);
    fprintf(out, "\n%d bars held, %d missed\n", verdicts->held, verdicts->missed);
}

void verdicts_free(struct verdicts *verdicts)
{
    cJSON_Delete(verdicts->json);
    grid_free(&verdicts->grid);
}
