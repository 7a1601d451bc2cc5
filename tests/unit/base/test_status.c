/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/types.h"

static void every_status_has_its_name(void **state)
{
    (void)state;
    assert_int_equal(RHO_OK, 0);
    assert_string_equal(rho_status_name(RHO_OK), "ok");
    assert_string_equal(rho_status_name(RHO_ERROR_NULL), "null");
    assert_string_equal(rho_status_name(RHO_ERROR_SIZE), "size");
    assert_string_equal(rho_status_name(RHO_ERROR_CONFIG), "config");
    assert_string_equal(rho_status_name(RHO_ERROR_VALUE), "value");
    assert_string_equal(rho_status_name(RHO_ERROR_CAPACITY), "capacity");
    assert_string_equal(rho_status_name(RHO_ERROR_SINGULAR), "singular");
    assert_string_equal(rho_status_name(RHO_ERROR_STATE), "state");
    assert_string_equal(rho_status_name(RHO_ERROR_SHORT), "short");
    assert_string_equal(rho_status_name(RHO_ERROR_TYPE), "type");
    assert_string_equal(rho_status_name(RHO_ERROR_COUNT), "count");
    assert_string_equal(rho_status_name(RHO_ERROR_TRAILING), "trailing");
    assert_int_equal(RHO_NUM_STATUS, 12);
}

static void names_of_statuses_differ(void **state)
{
    (void)state;
    for (int i = 0; i < RHO_NUM_STATUS; ++i) {
        assert_string_not_equal(rho_status_name((enum rho_status)i), "unknown");
        for (int j = 0; j < i; ++j) {
            assert_string_not_equal(rho_status_name((enum rho_status)i),
                                    rho_status_name((enum rho_status)j));
        }
    }
}

static void statuses_out_of_range_are_named_unknown(void **state)
{
    const int others[] = {RHO_NUM_STATUS, RHO_NUM_STATUS + 1, 255, 256, INT32_MAX, -1, INT32_MIN};

    (void)state;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        enum rho_status status;
        const int value = others[i];

        /* memcpy: converting such a value to the enum is implementation-defined. */
        _Static_assert(sizeof status == sizeof value, "an enum of another size");
        memcpy(&status, &value, sizeof status);
        assert_string_equal(rho_status_name(status), "unknown");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_status_has_its_name),
        cmocka_unit_test(names_of_statuses_differ),
        cmocka_unit_test(statuses_out_of_range_are_named_unknown),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
