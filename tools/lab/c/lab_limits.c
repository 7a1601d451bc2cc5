/* SPDX-License-Identifier: MIT */
#include "lab_limits.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

#include "base/common.h"

#define ROUNDING 1e-9 /* tolerance for rounding in sums of counts */

struct verdicts verdicts_start(void)
{
    return (struct verdicts){.table = text_table_start(1, "what must hold|measured|bar|verdict"),
                             .json = cJSON_CreateArray()};
}

struct bar {
    const char *relation; /* "<=" or ">=" */
    double value;
    bool is_held;
};

/* Adds the figure and its bar to the table, to the JSON and to the count held or missed. */
static void add_verdict(struct verdicts *verdicts, double value, const struct bar *bar,
                        const char *format, va_list list)
{
    char what[160];
    cJSON *object = cJSON_CreateObject();
    vsnprintf(what, sizeof what, format, list);
    cJSON_AddStringToObject(object, "what", what);
    json_add_number_or_null(object, "value", value);
    cJSON_AddNumberToObject(object, bar->relation[0] == '<' ? "at_most" : "at_least", bar->value);
    cJSON_AddBoolToObject(object, "held", bar->is_held);
    cJSON_AddItemToArray(verdicts->json, object);
    text_table_add_row(&verdicts->table, "%s|%.4g|%s %.4g|%s", what, value, bar->relation,
                       bar->value, bar->is_held ? "ok" : "MISSED");
    verdicts->held += bar->is_held;
    verdicts->missed += !bar->is_held;
}

void verdicts_add_at_most(struct verdicts *verdicts, double value, double bar, const char *what,
                          ...)
{
    struct bar at_most = {"<=", bar, value <= bar + ROUNDING};
    va_list list;
    va_start(list, what);
    add_verdict(verdicts, value, &at_most, what, list);
    va_end(list);
}

void verdicts_add_at_least(struct verdicts *verdicts, double value, double bar, const char *what,
                           ...)
{
    struct bar at_least = {">=", bar, value >= bar - ROUNDING};
    va_list list;
    va_start(list, what);
    add_verdict(verdicts, value, &at_least, what, list);
    va_end(list);
}

void verdicts_move_to_json(struct verdicts *verdicts, cJSON *object)
{
    cJSON_AddItemToObject(object, "bars", verdicts->json);
    cJSON_AddNumberToObject(object, "bars_held", verdicts->held);
    cJSON_AddNumberToObject(object, "bars_missed", verdicts->missed);
    verdicts->json = NULL;
}

void verdicts_print(const struct verdicts *verdicts, FILE *out)
{
    text_table_print(&verdicts->table, out);
    fprintf(out, "\n%d bars held, %d missed\n", verdicts->held, verdicts->missed);
}

void verdicts_free(struct verdicts *verdicts)
{
    cJSON_Delete(verdicts->json);
    text_table_free(&verdicts->table);
}
