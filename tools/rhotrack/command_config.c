/* SPDX-License-Identifier: MIT */
/* config: prints every parameter with unit, default, range, and the value now with its source. */
#include <cjson/cJSON.h>
#include <stdio.h>

#include "base/common.h"
#include "commands.h"
#include "settings/initiation_methods.h"

/* Adds a parameter's value to JSON: a string where the parameter has choices, else a number. */
static void add_parameter_value(cJSON *object, const char *name, const struct parameter_text *text,
                                double value)
{
    char word[PARAMETER_VALUE_BYTES];

    if (text->choices) {
        cJSON_AddStringToObject(object, name, parameters_value_text(text, value, word));
    } else {
        cJSON_AddNumberToObject(object, name, value);
    }
}

static cJSON *parameter_json(const struct parameter_text *text, double value,
                             enum parameter_source source)
{
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "unit", text->unit);
    if (text->has_default) {
        add_parameter_value(object, "default", text, text->value);
    } else {
        cJSON_AddNullToObject(object, "default");
    }
    if (text->choices) {
        cJSON_AddStringToObject(object, "choices", text->choices);
    } else {
        cJSON_AddNumberToObject(object, "min", text->min);
        cJSON_AddNumberToObject(object, "max", text->max);
    }
    if (source != SOURCE_UNSET) {
        add_parameter_value(object, "value", text, value);
    } else {
        cJSON_AddNullToObject(object, "value");
    }
    cJSON_AddStringToObject(object, "source", parameters_source_name(source));
    return object;
}

static cJSON *allowed_sensors_json(const struct parameters *parameters)
{
    cJSON *object = cJSON_CreateObject(), *list = cJSON_AddArrayToObject(object, "value");

    for (size_t i = 0; i < parameters->num_allowed; i++) {
        cJSON_AddItemToArray(list, cJSON_CreateNumber(parameters->allowed[i]));
    }
    cJSON_AddStringToObject(object, "source", parameters_source_name(parameters->allowed_source));
    return object;
}

static cJSON *sensor_name_json(const struct sensor_name *named)
{
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "value", named->text);
    cJSON_AddStringToObject(object, "source", parameters_source_name(named->source));
    return object;
}

static void print_parameters_json(const struct parameters *parameters)
{
    cJSON *object = cJSON_CreateObject();

    for (int i = 0; i < NUM_PARAMETERS; i++) {
        struct parameter_text text = parameters_text((enum parameter_id)i);

        cJSON_AddItemToObject(object, text.name,
                              parameter_json(&text, parameters->value[i], parameters->source[i]));
    }
    cJSON_AddItemToObject(object, "sensors_allowed", allowed_sensors_json(parameters));
    for (size_t s = 0; s < parameters->num_sensors; s++) {
        const struct sensor_parameters *sensor = &parameters->sensors[s];

        for (int i = 0; i < NUM_SENSOR_PARAMETERS; i++) {
            struct parameter_text text = parameters_sensor_text((enum sensor_parameter_id)i);
            char name[40];

            if (sensor->source[i] == SOURCE_UNSET) {
                continue;
            }
            snprintf(name, sizeof name, "sensor.%d.%s", (int)sensor->sensor_id, text.name);
            cJSON_AddItemToObject(object, name,
                                  parameter_json(&text, sensor->value[i], sensor->source[i]));
        }
    }
    for (size_t s = 0; s < parameters->num_names; s++) {
        const struct sensor_name *named = &parameters->names[s];
        char name[40];

        snprintf(name, sizeof name, "sensor.%d.name", (int)named->sensor_id);
        cJSON_AddItemToObject(object, name, sensor_name_json(named));
    }
    json_print_and_delete(object);
}

int command_config(struct command_line *line)
{
    struct output output;

    if (line->method) {
        method_suggest_parameters(method_must_find(line->method), &line->parameters);
    }
    parameters_check_together(&line->parameters);
    if (line->json) {
        print_parameters_json(&line->parameters);
        return 0;
    }
    output = output_open(NULL);
    parameters_print_table(&line->parameters, output.file);
    output_close(&output);
    return 0;
}
