/* SPDX-License-Identifier: MIT */
/*
 * An operator's settings: each message changes only the field of its name; values out of range are
 * answered with the range and change nothing.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/command.h"

static struct rho_settings settings, before;
static struct rho_message_setting_answer answer;

static enum rho_status set_field(int field, float value)
{
    const struct rho_message_setting setting = {
        .number = 77, .field = (int16_t)field, .value = value};
    before = settings;
    memset(&answer, 0xee, sizeof answer);
    const enum rho_status status = rho_command_set(&setting, &settings, &answer);
    assert_int_equal(answer.number, 77);
    assert_int_equal(answer.field, field);
    assert_int_equal(answer.status, status);
    assert_true(answer.utime == 0 && answer.scan == 0 && answer.epoch == 0);
    assert_int_equal(rho_message_setting_answer_validate(&answer, NULL),
                     field >= 0 ? RHO_OK : RHO_ERROR_VALUE);
    if (status != RHO_OK) {
        assert_memory_equal(&before, &settings, sizeof settings);
    }
    return status;
}

static void each_setting_changes_its_field_only(void **state)
{
    const struct {
        int field;
        const char *name;
        float *value;
        int applies;
    } fields[] = {
        {RHO_MESSAGE_SETTING_V_MIN_MPS, "v_min_mps", &settings.v_min_mps, 1},
        {RHO_MESSAGE_SETTING_V_MAX_MPS, "v_max_mps", &settings.v_max_mps, 1},
        {RHO_MESSAGE_SETTING_ACCEL_MAX_MPS2, "accel_max_mps2", &settings.accel_max_mps2, 1},
        {RHO_MESSAGE_SETTING_PD, "pd", &settings.pd, 3},
        {RHO_MESSAGE_SETTING_SCAN_INTERVAL_S, "scan_interval_s", &settings.scan_interval_s, 1},
        {RHO_MESSAGE_SETTING_SIGMA_RANGE_M, "sigma_range_m", &settings.sigma_range_m, 4},
        {RHO_MESSAGE_SETTING_SIGMA_AZIMUTH_RAD, "sigma_azimuth_rad", &settings.sigma_azimuth_rad,
         4},
        {RHO_MESSAGE_SETTING_SIGMA_ELEVATION_RAD, "sigma_elevation_rad",
         &settings.sigma_elevation_rad, 4},
        {RHO_MESSAGE_SETTING_SIGMA_RANGE_RATE_MPS, "sigma_range_rate_mps",
         &settings.sigma_range_rate_mps, 4},
        {RHO_MESSAGE_SETTING_SIGMA_RAD, "sigma_rad", &settings.sigma_rad, 4},
        {RHO_MESSAGE_SETTING_RANGE_MIN_M, "range_min_m", &settings.range_min_m, 3},
        {RHO_MESSAGE_SETTING_RANGE_MAX_M, "range_max_m", &settings.range_max_m, 3},
        {RHO_MESSAGE_SETTING_FALSE_TRACKS_PER_HOUR, "false_tracks_per_hour",
         &settings.false_tracks_per_hour, 1},
    };
    (void)state;
    rho_settings_default(&settings);
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        const float value = *fields[i].value > 0.0f ? 0.5f * *fields[i].value : 0.25f;
        assert_string_equal(rho_command_setting_name(fields[i].field), fields[i].name);
        assert_int_equal(set_field(fields[i].field, value), RHO_OK);
        assert_int_equal(answer.applies, fields[i].applies);
        assert_true(answer.value == value && *fields[i].value == value);
        /* cleared, so that the comparison shows that no other field has changed */
        *fields[i].value = 0.0f;
        struct rho_settings after = settings;
        settings = before;
        *fields[i].value = 0.0f;
        assert_memory_equal(&after, &settings, sizeof settings);
        *fields[i].value = value;
    }
    assert_int_equal(set_field(RHO_MESSAGE_SETTING_SCANS, 6.0f), RHO_OK);
    assert_int_equal(settings.scans, 6);
    assert_int_equal(answer.applies, RHO_MESSAGE_SETTING_ANSWER_WINDOW);
    assert_int_equal(set_field(RHO_MESSAGE_SETTING_MIN_SCANS, 4.0f), RHO_OK);
    assert_int_equal(settings.min_scans, 4);
    assert_int_equal(set_field(RHO_MESSAGE_SETTING_COAST_SCANS_MAX, 9.0f), RHO_OK);
    assert_int_equal(settings.coast_scans_max, 9);
    assert_int_equal(set_field(RHO_MESSAGE_SETTING_WORK_MAX, 70000.0f), RHO_OK);
    assert_int_equal(settings.work_max, 70000);
    assert_int_equal(set_field(RHO_MESSAGE_SETTING_STANDING, 1.0f), RHO_OK);
    assert_int_equal(settings.standing, RHO_STANDING_TARGETS);
    assert_int_equal(set_field(RHO_MESSAGE_SETTING_STANDING, 2.0f), RHO_ERROR_CONFIG);
    assert_null(rho_command_setting_name(0));
    assert_null(rho_command_setting_name(19));
    assert_null(rho_command_setting_name(-1));
}

static void values_out_of_range_are_answered_with_the_range(void **state)
{
    (void)state;
    rho_settings_default(&settings);
    assert_int_equal(set_field(RHO_MESSAGE_SETTING_PD, 1.5f), RHO_ERROR_CONFIG);
    assert_int_equal(answer.fault_field, RHO_MESSAGE_SETTING_PD);
    assert_true(answer.value == 1.5f && answer.min == 0.01f && answer.max == 0.999f);
    assert_int_equal(set_field(RHO_MESSAGE_SETTING_PD, NAN), RHO_ERROR_VALUE);
    assert_int_equal(set_field(RHO_MESSAGE_SETTING_SCANS, INFINITY), RHO_ERROR_VALUE);
    /* this value would put another field out of range */
    assert_int_equal(set_field(RHO_MESSAGE_SETTING_V_MIN_MPS, 50.0f), RHO_OK);
    assert_int_equal(set_field(RHO_MESSAGE_SETTING_V_MAX_MPS, 40.0f), RHO_ERROR_CONFIG);
    assert_int_equal(answer.fault_field, RHO_MESSAGE_SETTING_V_MIN_MPS);
    assert_true(answer.value == 50.0f && answer.min == 0.0f && answer.max == 40.0f);
    static const float none[] = {-1.0f, 2.0f, 1e6f, 1e30f, -1e30f};
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++) {
        assert_int_equal(set_field(RHO_MESSAGE_SETTING_SCANS, none[i]), RHO_ERROR_CONFIG);
        assert_int_equal(answer.fault_field, RHO_MESSAGE_SETTING_SCANS);
        assert_true(answer.value == none[i] && answer.min == 3.0f);
        assert_true(answer.max == (float)RHO_MAX_SCANS);
    }
    assert_int_equal(set_field(RHO_MESSAGE_SETTING_WORK_MAX, 2e8f), RHO_ERROR_CONFIG);
    assert_int_equal(set_field(RHO_MESSAGE_SETTING_SCANS, 5.5f), RHO_ERROR_VALUE);
    assert_int_equal(answer.fault_field, 0);
    assert_int_equal(set_field(0, 1.0f), RHO_ERROR_VALUE);
    assert_int_equal(answer.applies, 0);
    assert_int_equal(set_field(19, 1.0f), RHO_ERROR_VALUE);
    assert_int_equal(set_field(-3, 1.0f), RHO_ERROR_VALUE);
}

static void null_pointers_are_refused(void **state)
{
    const struct rho_message_setting setting = {.field = 1};
    (void)state;
    assert_int_equal(rho_command_set(NULL, &settings, &answer), RHO_ERROR_NULL);
    assert_int_equal(rho_command_set(&setting, NULL, &answer), RHO_ERROR_NULL);
    assert_int_equal(rho_command_set(&setting, &settings, NULL), RHO_ERROR_NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_setting_changes_its_field_only),
        cmocka_unit_test(values_out_of_range_are_answered_with_the_range),
        cmocka_unit_test(null_pointers_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
