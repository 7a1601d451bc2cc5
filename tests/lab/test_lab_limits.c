/* SPDX-License-Identifier: MIT */
/*
 * Pass bars of the experiments: on which side of its bar a figure is, which figures are no numbers,
 * and how both are written as JSON and as a table.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lab_limits.h"

typedef void add_figure(struct verdicts *verdicts, double value, double bar, const char *what, ...);

static int is_bar_held(add_figure *add, double value, double bar)
{
    struct verdicts verdicts = verdicts_start();
    add(&verdicts, value, bar, "figure");
    int held = verdicts.held;
    assert_int_equal(verdicts.held + verdicts.missed, 1);
    verdicts_free(&verdicts);
    return held;
}

static void a_value_equal_to_its_bar_holds_it(void **state)
{
    (void)state;
    assert_true(is_bar_held(verdicts_add_at_most, 1.5, 2.0));
    assert_true(is_bar_held(verdicts_add_at_most, 2.0, 2.0));
    assert_false(is_bar_held(verdicts_add_at_most, 2.000001, 2.0));
    assert_true(is_bar_held(verdicts_add_at_most, -3.0, -2.0));
    assert_true(is_bar_held(verdicts_add_at_least, 2.5, 2.0));
    assert_true(is_bar_held(verdicts_add_at_least, 2.0, 2.0));
    assert_false(is_bar_held(verdicts_add_at_least, 1.999999, 2.0));
    assert_false(is_bar_held(verdicts_add_at_least, -3.0, -2.0));
}

/* Ten tenths, added one by one, give a little less than one. */
static void rounding_errors_of_sums_do_not_miss_a_bar(void **state)
{
    double sum = 0.0;
    (void)state;
    for (int i = 0; i < 10; i++) {
        sum += 0.1;
    }
    assert_true(sum < 1.0);
    assert_true(is_bar_held(verdicts_add_at_least, sum, 1.0));
    assert_true(is_bar_held(verdicts_add_at_most, 2.0 - sum, 1.0));
}

/* A mean over nothing is NaN, a ratio to nothing is infinite: both miss their bar. */
static void nan_and_infinity_miss_every_bar(void **state)
{
    (void)state;
    assert_false(is_bar_held(verdicts_add_at_most, NAN, 2.0));
    assert_false(is_bar_held(verdicts_add_at_least, NAN, 2.0));
    assert_false(is_bar_held(verdicts_add_at_most, INFINITY, 2.0));
    assert_false(is_bar_held(verdicts_add_at_least, -INFINITY, 2.0));
}

/* Five figures: two hold their bar, three miss it, two of them NaN or infinite. */
static struct verdicts five_example_verdicts(void)
{
    struct verdicts verdicts = verdicts_start();
    verdicts_add_at_most(&verdicts, 1.25, 2.0, "%s at %g", "ratio", 10.0);
    verdicts_add_at_least(&verdicts, 0.96, 0.95, "share of %d", 7);
    verdicts_add_at_least(&verdicts, 0.5, 0.95, "\"quoted\"");
    verdicts_add_at_most(&verdicts, NAN, 2.0, "mean of nothing");
    verdicts_add_at_most(&verdicts, INFINITY, 2.0, "ratio to nothing");
    return verdicts;
}

static const cJSON *verdicts_read_back_from_json(struct verdicts *verdicts)
{
    cJSON *object = cJSON_CreateObject();
    verdicts_move_to_json(verdicts, object);
    char *text = cJSON_Print(object);
    cJSON_Delete(object);
    object = cJSON_Parse(text);
    free(text);
    assert_non_null(object);
    return object;
}

static const cJSON *bar_at(const cJSON *root, int i)
{
    return cJSON_GetArrayItem(cJSON_GetObjectItem(root, "bars"), i);
}

static double number_of_member(const cJSON *object, const char *name)
{
    const cJSON *item = cJSON_GetObjectItem(object, name);
    assert_true(cJSON_IsNumber(item));
    return item->valuedouble;
}

static int are_equal_numbers(double a, double b)
{
    return fabs(a - b) < 1e-12;
}

static void json_holds_each_value_and_its_bar(void **state)
{
    static const char *const whats[] = {"ratio at 10", "share of 7", "\"quoted\"",
                                        "mean of nothing", "ratio to nothing"};
    static const int held[] = {1, 1, 0, 0, 0};
    struct verdicts verdicts = five_example_verdicts();
    (void)state;
    const cJSON *root = verdicts_read_back_from_json(&verdicts);
    assert_true(are_equal_numbers(number_of_member(root, "bars_held"), 2.0));
    assert_true(are_equal_numbers(number_of_member(root, "bars_missed"), 3.0));
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(root, "bars")), 5);
    for (int i = 0; i < 5; i++) {
        assert_string_equal(cJSON_GetObjectItem(bar_at(root, i), "what")->valuestring, whats[i]);
        assert_int_equal(cJSON_IsTrue(cJSON_GetObjectItem(bar_at(root, i), "held")), held[i]);
    }
    assert_true(are_equal_numbers(number_of_member(bar_at(root, 0), "value"), 1.25));
    assert_true(are_equal_numbers(number_of_member(bar_at(root, 0), "at_most"), 2.0));
    assert_null(cJSON_GetObjectItem(bar_at(root, 0), "at_least"));
    assert_true(are_equal_numbers(number_of_member(bar_at(root, 1), "at_least"), 0.95));
    assert_null(cJSON_GetObjectItem(bar_at(root, 1), "at_most"));
    /* JSON has neither NaN nor infinity */
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(bar_at(root, 3), "value")));
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(bar_at(root, 4), "value")));
    cJSON_Delete((cJSON *)root);
    verdicts_free(&verdicts);
}

static void the_table_ends_with_counts_of_held_and_missed_bars(void **state)
{
    struct verdicts verdicts = five_example_verdicts();
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    (void)state;
    verdicts_print(&verdicts, out);
    fclose(out);
    const char *last = "\n\n2 bars held, 3 missed\n";
    assert_string_equal(text + strlen(text) - strlen(last), last);
    assert_int_equal(verdicts.table.num_rows, 1 + 5);
    assert_string_equal(text_table_cell(&verdicts.table, 1, 0), "ratio at 10");
    assert_string_equal(text_table_cell(&verdicts.table, 1, 1), "1.25");
    assert_string_equal(text_table_cell(&verdicts.table, 1, 2), "<= 2");
    assert_string_equal(text_table_cell(&verdicts.table, 1, 3), "ok");
    assert_string_equal(text_table_cell(&verdicts.table, 3, 2), ">= 0.95");
    assert_string_equal(text_table_cell(&verdicts.table, 3, 3), "MISSED");
    assert_string_equal(text_table_cell(&verdicts.table, 4, 3), "MISSED");
    free(text);
    verdicts_free(&verdicts);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_value_equal_to_its_bar_holds_it),
        cmocka_unit_test(rounding_errors_of_sums_do_not_miss_a_bar),
        cmocka_unit_test(nan_and_infinity_miss_every_bar),
        cmocka_unit_test(json_holds_each_value_and_its_bar),
        cmocka_unit_test(the_table_ends_with_counts_of_held_and_missed_bars),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
