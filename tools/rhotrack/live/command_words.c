/* SPDX-License-Identifier: MIT */
#include "live/command_words.h"

#include <inttypes.h>
#include <string.h>

#include "rhotrack/command.h"

const struct command_action command_actions[COMMAND_ACTIONS] = {
    {"start", RHO_MESSAGE_COMMAND_START, 0, "x_m y_m", "sigma_m vx_mps vy_mps sigma_mps"},
    {"drop", RHO_MESSAGE_COMMAND_DROP, 1, "", ""},
    {"renumber", RHO_MESSAGE_COMMAND_RENUMBER, 2, "", ""},
    {"freeze", RHO_MESSAGE_COMMAND_FREEZE, 1, "", ""},
    {"thaw", RHO_MESSAGE_COMMAND_THAW, 1, "", ""},
    {"exclude", RHO_MESSAGE_COMMAND_EXCLUDE, 0, "x_m y_m x_max_m y_max_m", ""},
    {"include", RHO_MESSAGE_COMMAND_INCLUDE, 0, "x_m y_m", ""},
};

float *command_words_member(struct rho_message_command *command, const char *key, size_t length)
{
    const struct {
        const char *name;
        float *value;
    } members[] = {{"x_m", &command->x_m},         {"y_m", &command->y_m},
                   {"x_max_m", &command->x_max_m}, {"y_max_m", &command->y_max_m},
                   {"sigma_m", &command->sigma_m}, {"sigma_mps", &command->sigma_mps},
                   {"vx_mps", &command->vx_mps},   {"vy_mps", &command->vy_mps}};

    for (size_t i = 0; i < sizeof members / sizeof *members; i++) {
        if (strlen(members[i].name) == length && strncmp(members[i].name, key, length) == 0) {
            return members[i].value;
        }
    }
    return NULL;
}

/* Prints the members that a list of keys names. */
static void print_members(const struct rho_message_command *command, const char *keys, FILE *to)
{
    struct rho_message_command copy = *command;

    for (const char *key = keys; *key; key += strcspn(key, " "), key += strspn(key, " ")) {
        const int length = (int)strcspn(key, " ");

        fprintf(to, " %.*s=%.7g", length, key,
                (double)*command_words_member(&copy, key, (size_t)length));
    }
}

void command_words_print(const struct rho_message_command *command, FILE *to)
{
    for (int i = 0; i < COMMAND_ACTIONS; i++) {
        const struct command_action *action = &command_actions[i];

        if (action->action == command->action) {
            fputs(action->name, to);
            if (action->num_numbers > 0) {
                fprintf(to, " %" PRId32, command->track_id);
            }
            if (action->num_numbers > 1) {
                fprintf(to, " %" PRId32, command->new_id);
            }
            print_members(command, action->keys, to);
            print_members(command, action->more, to);
        }
    }
}

const char *command_words_refusal(int8_t status)
{
    switch (status) {
    case RHO_ERROR_VALUE:
        return "no such track or place, or an identity that is taken";
    case RHO_ERROR_STATE:
        return "the track is tentative, or the node has made no step";
    case RHO_ERROR_CAPACITY:
        return "there is no room";
    default:
        return rho_status_name((enum rho_status)status);
    }
}

void command_words_setting_refusal(const struct rho_message_setting_answer *answer,
                                   char why[COMMAND_REASON_BYTES])
{
    const char *fault = rho_command_setting_name(answer->fault_field);
    const char *text = rho_status_name((enum rho_status)answer->status);

    if (fault) {
        snprintf(why, COMMAND_REASON_BYTES, "%s %g is not within %g .. %g", fault,
                 (double)answer->value, (double)answer->min, (double)answer->max);
        return;
    }
    if (answer->status == RHO_ERROR_VALUE) {
        snprintf(why, COMMAND_REASON_BYTES, "%s is a whole number",
                 rho_command_setting_name(answer->field));
        return;
    }
    if (answer->status == RHO_ERROR_CONFIG) {
        text = "a sensor's own range_min_m or range_max_m forbids it";
    } else if (answer->status == RHO_ERROR_STATE) {
        text = "the node has made no step";
    }
    snprintf(why, COMMAND_REASON_BYTES, "%s", text);
}

void command_words_setting_values(const struct rho_settings *settings,
                                  float values[COMMAND_SETTINGS + 1])
{
    const float all[COMMAND_SETTINGS + 1] = {
        [RHO_MESSAGE_SETTING_V_MIN_MPS] = settings->v_min_mps,
        [RHO_MESSAGE_SETTING_V_MAX_MPS] = settings->v_max_mps,
        [RHO_MESSAGE_SETTING_ACCEL_MAX_MPS2] = settings->accel_max_mps2,
        [RHO_MESSAGE_SETTING_PD] = settings->pd,
        [RHO_MESSAGE_SETTING_SCAN_INTERVAL_S] = settings->scan_interval_s,
        [RHO_MESSAGE_SETTING_SIGMA_RANGE_M] = settings->sigma_range_m,
        [RHO_MESSAGE_SETTING_SIGMA_AZIMUTH_RAD] = settings->sigma_azimuth_rad,
        [RHO_MESSAGE_SETTING_SIGMA_ELEVATION_RAD] = settings->sigma_elevation_rad,
        [RHO_MESSAGE_SETTING_SIGMA_RANGE_RATE_MPS] = settings->sigma_range_rate_mps,
        [RHO_MESSAGE_SETTING_SIGMA_RAD] = settings->sigma_rad,
        [RHO_MESSAGE_SETTING_RANGE_MIN_M] = settings->range_min_m,
        [RHO_MESSAGE_SETTING_RANGE_MAX_M] = settings->range_max_m,
        [RHO_MESSAGE_SETTING_SCANS] = settings->scans,
        [RHO_MESSAGE_SETTING_MIN_SCANS] = settings->min_scans,
        [RHO_MESSAGE_SETTING_COAST_SCANS_MAX] = settings->coast_scans_max,
        [RHO_MESSAGE_SETTING_FALSE_TRACKS_PER_HOUR] = settings->false_tracks_per_hour,
        [RHO_MESSAGE_SETTING_WORK_MAX] = (float)settings->work_max,
        [RHO_MESSAGE_SETTING_STANDING] = (float)settings->standing,
    };

    memcpy(values, all, sizeof all);
}
