/* SPDX-License-Identifier: MIT */
/* command_set: sets one parameter by an operator's setting message, and fills the answer. */
#include <string.h>

#include "rhotrack/command.h"

enum number_kind { AS_FLOAT, AS_UINT16, AS_UINT32 };

/* A member of rho_settings that a message can set, by the number that the message gives it. */
struct setting_field {
    const char *name;
    size_t place;
    enum number_kind kind;
    int8_t applies;
};

#define FIELD(field, kind, applies)                                                                \
    {                                                                                              \
#field, offsetof(struct rho_settings, field), kind, RHO_MESSAGE_SETTING_ANSWER_##applies   \
    }

static const struct setting_field *find_field(int number)
{
    static const struct setting_field fields[RHO_MESSAGE_SETTING_STANDING + 1] = {
        [RHO_MESSAGE_SETTING_V_MIN_MPS] = FIELD(v_min_mps, AS_FLOAT, STEP),
        [RHO_MESSAGE_SETTING_V_MAX_MPS] = FIELD(v_max_mps, AS_FLOAT, STEP),
        [RHO_MESSAGE_SETTING_ACCEL_MAX_MPS2] = FIELD(accel_max_mps2, AS_FLOAT, STEP),
        [RHO_MESSAGE_SETTING_PD] = FIELD(pd, AS_FLOAT, SENSOR),
        [RHO_MESSAGE_SETTING_SCAN_INTERVAL_S] = FIELD(scan_interval_s, AS_FLOAT, STEP),
        [RHO_MESSAGE_SETTING_SIGMA_RANGE_M] = FIELD(sigma_range_m, AS_FLOAT, PLOT),
        [RHO_MESSAGE_SETTING_SIGMA_AZIMUTH_RAD] = FIELD(sigma_azimuth_rad, AS_FLOAT, PLOT),
        [RHO_MESSAGE_SETTING_SIGMA_ELEVATION_RAD] = FIELD(sigma_elevation_rad, AS_FLOAT, PLOT),
        [RHO_MESSAGE_SETTING_SIGMA_RANGE_RATE_MPS] = FIELD(sigma_range_rate_mps, AS_FLOAT, PLOT),
        [RHO_MESSAGE_SETTING_SIGMA_RAD] = FIELD(sigma_rad, AS_FLOAT, PLOT),
        [RHO_MESSAGE_SETTING_RANGE_MIN_M] = FIELD(range_min_m, AS_FLOAT, SENSOR),
        [RHO_MESSAGE_SETTING_RANGE_MAX_M] = FIELD(range_max_m, AS_FLOAT, SENSOR),
        [RHO_MESSAGE_SETTING_SCANS] = FIELD(scans, AS_UINT16, WINDOW),
        [RHO_MESSAGE_SETTING_MIN_SCANS] = FIELD(min_scans, AS_UINT16, STEP),
        [RHO_MESSAGE_SETTING_COAST_SCANS_MAX] = FIELD(coast_scans_max, AS_UINT16, STEP),
        [RHO_MESSAGE_SETTING_FALSE_TRACKS_PER_HOUR] = FIELD(false_tracks_per_hour, AS_FLOAT, STEP),
        [RHO_MESSAGE_SETTING_WORK_MAX] = FIELD(work_max, AS_UINT32, STEP),
        [RHO_MESSAGE_SETTING_STANDING] = FIELD(standing, AS_UINT32, STEP),
    };
    return number > 0 && number <= RHO_MESSAGE_SETTING_STANDING ? &fields[number] : 0;
}

const char *rho_command_setting_name(int field)
{
    const struct setting_field *found = find_field(field);
    return found ? found->name : 0;
}

/* Number of the field of a name; 0: there is none. */
static int16_t number_of_name(const char *name)
{
    const struct setting_field *field;
    for (int16_t number = 1; (field = find_field(number)); number++) {
        size_t i = 0;
        while (name[i] && name[i] == field->name[i]) {
            i++;
        }
        if (name[i] == field->name[i]) {
            return number;
        }
    }
    return 0;
}

/*
 * Stores a value in its field; a whole number too large for the field's type becomes its maximum,
 * which the check refuses. Returns 0 for a fraction in a field of whole numbers.
 */
static int store_value(const struct setting_field *field, float value,
                       struct rho_settings *settings)
{
    char *at = (char *)settings + field->place;
    const int is_count = value >= 0.0f && value < 4.0e9f;
    const uint32_t whole = is_count ? (uint32_t)value : UINT32_MAX;
    const uint16_t half = whole < UINT16_MAX ? (uint16_t)whole : UINT16_MAX;
    if (field->kind == AS_FLOAT) {
        memcpy(at, &value, sizeof value);
        return 1;
    }
    if (field->kind == AS_UINT16) {
        memcpy(at, &half, sizeof half);
    } else {
        memcpy(at, &whole, sizeof whole);
    }
    return !is_count || !((float)whole < value);
}

enum rho_status rho_command_set(const struct rho_message_setting *setting,
                                struct rho_settings *settings,
                                struct rho_message_setting_answer *answer)
{
    if (!setting || !settings || !answer) {
        return RHO_ERROR_NULL;
    }
    const struct setting_field *field = find_field(setting->field);
    struct rho_settings changed = *settings;
    struct rho_settings_fault fault = {0};
    const int is_number = rho_are_finite(&setting->value, 1);
    enum rho_status status = RHO_ERROR_VALUE;
    *answer = (struct rho_message_setting_answer){.number = setting->number,
                                                  .field = setting->field,
                                                  .applies = field ? field->applies : 0,
                                                  .value = is_number ? setting->value : 0.0f};
    if (field && is_number && store_value(field, setting->value, &changed)) {
        status = rho_settings_check(&changed, &fault);
    }
    answer->status = (int8_t)status;
    if (status == RHO_OK) {
        *settings = changed;
    } else if (fault.field) {
        answer->fault_field = number_of_name(fault.field);
        answer->value = answer->fault_field == setting->field ? setting->value : fault.value;
        answer->min = fault.min;
        answer->max = fault.max;
    }
    return status;
}
