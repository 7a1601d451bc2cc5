/* SPDX-License-Identifier: MIT */
/*
 * Walking through points by identity; an empty list has no memory (a null pointer was once moved by
 * 0).
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

static void identities_come_one_by_one(void **state)
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
        cmocka_unit_test(identities_come_one_by_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
