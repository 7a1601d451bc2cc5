/* SPDX-License-Identifier: MIT */
/*
 * Iterating over points by identity; the empty list is a null pointer, which an earlier version
 * advanced by 0.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "picture/picture_data.h"

static void an_empty_list_has_no_identities(void **state)
{
    (void)state;
    const struct plot_points none = {0};
    struct plot_points one;
    size_t at = 0;
    assert_false(picture_data_next_identity(&none, &at, &one));
    assert_int_equal(at, 0);
}

static void points_are_grouped_by_identity(void **state)
{
    (void)state;
    struct plot_point list[3] = {{.id = 4}, {.id = 4}, {.id = 9}};
    const struct plot_points points = {.list = list, .count = 3};
    struct plot_points one;
    size_t at = 0;
    assert_true(picture_data_next_identity(&points, &at, &one));
    assert_int_equal(one.count, 2);
    assert_true(picture_data_next_identity(&points, &at, &one));
    assert_int_equal(one.count, 1);
    assert_int_equal(one.list[0].id, 9);
    assert_false(picture_data_next_identity(&points, &at, &one));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_list_has_no_identities),
        cmocka_unit_test(points_are_grouped_by_identity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
