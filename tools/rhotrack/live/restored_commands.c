/* SPDX-License-Identifier: MIT */
#include "live/restored_commands.h"

#include "base/common.h"
#include "live/command_words.h"
#include "rhotrack/command.h"
#include "rhotrack/operator.h"

static unsigned print_areas(const struct rho_tracker *tracker, const char *path, FILE *to)
{
    for (unsigned i = 0; i < tracker->num_excluded; i++) {
        const struct rho_extent *area = &tracker->excluded[i];
        const struct rho_message_command command = {.action = RHO_MESSAGE_COMMAND_EXCLUDE,
                                                    .x_m = area->x_min_m,
                                                    .y_m = area->y_min_m,
                                                    .x_max_m = area->x_max_m,
                                                    .y_max_m = area->y_max_m};

        fprintf(to, "rhotrack: %s: by an earlier command: ", path);
        command_words_print(&command, to);
        fputs("\n", to);
    }
    return tracker->num_excluded;
}

static unsigned print_settings(const struct rho_node *node, const char *path, FILE *to)
{
    float told[COMMAND_SETTINGS + 1], now[COMMAND_SETTINGS + 1];
    unsigned lines = 0;

    command_words_setting_values(&node->told, told);
    command_words_setting_values(&node->settings, now);
    for (int field = 1; field <= COMMAND_SETTINGS; field++) {
        if (now[field] < told[field] || now[field] > told[field]) {
            lines++;
            fprintf(to, "rhotrack: %s: by an earlier command: set %s %.7g, configured: %.7g\n",
                    path, rho_command_setting_name(field), (double)now[field], (double)told[field]);
        }
    }
    return lines;
}

static unsigned print_frozen_tracks(const struct rho_tracker *tracker, const char *path, FILE *to)
{
    unsigned frozen = 0;

    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        frozen += tracker->tracks[i].is_frozen;
    }
    if (frozen > 0) {
        fprintf(to, "rhotrack: %s: by an earlier command: frozen tracks: %u\n", path, frozen);
    }
    return frozen > 0;
}

unsigned restored_commands_print(const struct rho_node *node, const char *path, FILE *to)
{
    unsigned lines = print_areas(&node->tracker, path, to);

    lines += print_settings(node, path, to);
    lines += print_frozen_tracks(&node->tracker, path, to);
    if (lines > 0) {
        fprintf(to, "rhotrack: %s: %s\n", path,
                node->options.takes_commands
                    ? "the node goes on with these; a start without --commands leaves them out"
                    : "the node runs without --commands, and leaves these out");
    }
    return lines;
}

/* A sensor that the parameters do not describe would keep the description that a setting made. */
static void describe_sensors_again(struct rho_tracker *tracker, const struct parameters *parameters)
{
    for (unsigned i = 0; i < tracker->num_sensors; i++) {
        struct rho_sensor sensor = tracker->sensors[i].sensor, own;

        parameters_sensor_or_default(parameters, sensor.sensor_id, &own);
        sensor.pd = own.pd;
        sensor.range_min_m = own.range_min_m;
        sensor.range_max_m = own.range_max_m;
        must_succeed(rho_tracker_set_sensor(tracker, &sensor), "sensor");
    }
}

void restored_commands_undo(struct rho_tracker *tracker, const struct parameters *parameters)
{
    while (tracker->num_excluded > 0) {
        must_succeed(rho_tracker_include_place(tracker, tracker->excluded[0].x_min_m,
                                               tracker->excluded[0].y_min_m),
                     "include");
    }
    /* before its first step a tracker has no report that rho_tracker_freeze_track takes */
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        tracker->tracks[i].is_frozen = 0;
    }
    describe_sensors_again(tracker, parameters);
}
