/* SPDX-License-Identifier: MIT */
#include "settings/parameters.h"

#include <string.h>

static void print_parameter_row(FILE *out, const struct parameter_text *text, const char *value,
                                enum parameter_source source)
{
    char initial[PARAMETER_VALUE_BYTES] = "unset", range[48];

    if (text->has_default) {
        parameters_value_text(text, text->value, initial);
    }
    snprintf(range, sizeof range, "%.9g .. %.9g", text->min, text->max);
    if (text->choices) {
        snprintf(range, sizeof range, "%s%s", text->choices, text->is_sum ? ", joined by +" : "");
    }
    fprintf(out, "%-22s %-7s %10s  %-24s %10s  %-8s %s\n", text->name, text->unit, initial, range,
            value, parameters_source_name(source), text->text);
}

static void print_sensor_values(FILE *out, const struct sensor_parameters *sensor)
{
    for (int i = 0; i < NUM_SENSOR_PARAMETERS; i++) {
        struct parameter_text text = parameters_sensor_text((enum sensor_parameter_id)i);
        char name[40], value[32];

        if (sensor->source[i] == SOURCE_UNSET) {
            continue;
        }
        snprintf(name, sizeof name, "sensor.%d.%s", (int)sensor->sensor_id, text.name);
        snprintf(value, sizeof value, "%.9g", sensor->value[i]);
        text.name = name;
        print_parameter_row(out, &text, value, sensor->source[i]);
    }
}

static void print_sensor_names(const struct parameters *parameters, FILE *out)
{
    for (size_t i = 0; i < parameters->num_names; i++) {
        const struct sensor_name *named = &parameters->names[i];
        char key[40];
        const struct parameter_text text = {
            .name = key, .unit = "-", .choices = "text", .text = "how it is called"};

        snprintf(key, sizeof key, "sensor.%d.name", (int)named->sensor_id);
        print_parameter_row(out, &text, named->text, named->source);
    }
}

static void print_sensor_keys(FILE *out)
{
    fputs("\nA sensor's own (--set sensor.N.key=value, or [sensor N] in the --config file):\n",
          out);
    for (int i = 0; i < NUM_SENSOR_PARAMETERS; i++) {
        struct parameter_text text = parameters_sensor_text((enum sensor_parameter_id)i);
        char range[48];

        snprintf(range, sizeof range, "%.9g .. %.9g", text.min, text.max);
        fprintf(out, "%-22s %-7s %10s  %-24s %10s  %-8s %s\n", text.name, text.unit, "", range, "",
                "", text.text);
    }
    fprintf(out, "%-22s %-7s %10s  %-24s %10s  %-8s %s\n", "name", "-", "", "text", "", "",
            "how it is called, in a node's lines and metrics");
}

static void print_zone_keys(FILE *out)
{
    fputs(
        "\nA zone's (--set zone.N.key=value, or [zone N] in the --config file), where tracks are "
        "counted:\n"
        "corners_m   3 to 8 corners, x y, x y, ...     heading_rad  of a lane\n"
        "margin_m    so far outside a track has left   queue_mps    slower tracks are its queue\n",
        out);
}

static void print_allowed_sensors(const struct parameters *parameters, FILE *out)
{
    const struct parameter_text text = {.name = "sensors_allowed",
                                        .unit = "-",
                                        .choices = "numbers of sensors",
                                        .text = "messages: of these sensors alone; unset: of all"};
    char list[8 * RHO_MAX_SENSORS] = "-";
    size_t length = 0;

    for (size_t i = 0; i < parameters->num_allowed; i++) {
        length += (size_t)snprintf(list + length, sizeof list - length, "%s%d", i ? " " : "",
                                   parameters->allowed[i]);
    }
    print_parameter_row(out, &text, list, parameters->allowed_source);
}

static void print_reflectors(const struct parameters *parameters, FILE *out)
{
    const struct parameter_text text = {.name = "reflectors",
                                        .unit = "m",
                                        .choices = "x y x y of a wall, ...",
                                        .text = "walls that show targets a second time"};
    char list[PARAMETER_REFLECTORS_BYTES];

    parameters_reflectors_text(parameters, list);
    print_parameter_row(out, &text, list, parameters->reflectors_source);
}

void parameters_print_table(const struct parameters *parameters, FILE *out)
{
    fprintf(out, "%-22s %-7s %10s  %-24s %10s  %-8s %s\n", "name", "unit", "default", "range",
            "value", "source", "meaning");
    for (int i = 0; i < NUM_PARAMETERS; i++) {
        struct parameter_text text = parameters_text((enum parameter_id)i);
        char value[PARAMETER_VALUE_BYTES] = "-";

        if (parameters->source[i] != SOURCE_UNSET) {
            parameters_value_text(&text, parameters->value[i], value);
        }
        print_parameter_row(out, &text, value, parameters->source[i]);
    }
    print_allowed_sensors(parameters, out);
    print_reflectors(parameters, out);
    for (size_t i = 0; i < parameters->num_sensors; i++) {
        print_sensor_values(out, &parameters->sensors[i]);
    }
    print_sensor_names(parameters, out);
    print_sensor_keys(out);
    print_zone_keys(out);
}
