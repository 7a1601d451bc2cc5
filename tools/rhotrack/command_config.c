/* SPDX-License-Identifier: MIT */
/* config: prints every parameter with unit, default, range, and the value now with its source. */
#include <cjson/cJSON.h>
#include <stdio.h>

#include "commands.h"
#include "common.h"

static cJSON *parameter_json(const struct parameter_text *text, double value,
                             enum parameter_source source)
{
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "unit", text->unit);
    if (text->has_default) {
        cJSON_AddNumberToObject(object, "default", text->value);
    } else {
        cJSON_AddNullToObject(object, "default");
    }
    cJSON_AddNumberToObject(object, "min", text->min);
    cJSON_AddNumberToObject(object, "max", text->max);
    if (source != SOURCE_UNSET) {
        cJSON_AddNumberToObject(object, "value", value);
    } else {
        cJSON_AddNullToObject(object, "value");
    }
    cJSON_AddStringToObject(object, "source", parameters_source_name(source));
    return object;
}

static void print_json(const struct parameters *parameters)
{
    cJSON *object = cJSON_CreateObject();

    for (int i = 0; i < NUM_PARAMETERS; i++) {
        struct parameter_text text = parameters_text((enum parameter_id)i);

        cJSON_AddItemToObject(object, text.name,
                              parameter_json(&text, parameters->value[i], parameters->source[i]));
    }
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
    json_print(object);
}

int command_config(struct command_line *line)
{
    struct output output;

    parameters_check(&line->parameters);
    if (line->json) {
        print_json(&line->parameters);
        return 0;
    }
    output = output_open(NULL);
    parameters_print(&line->parameters, output.file);
    output_close(&output);
    return 0;
}
