/* SPDX-License-Identifier: MIT */
#include "io/csv/sensor_names.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* The names of a run's files, and their numbers; a run has its sensors by name or by number. */
static struct {
    char text[SENSOR_NAME_BYTES];
    int32_t sensor_id;
} names[RHO_MAX_SENSORS];
static unsigned num_names;
static bool has_numbers;

static bool is_number_taken(const struct parameters *parameters, int32_t sensor_id)
{
    bool is_taken = parameters_has_sensor(parameters, sensor_id) ||
                    parameters_sensor_name(parameters, sensor_id) != NULL;

    for (unsigned i = 0; i < num_names; i++) {
        is_taken |= names[i].sensor_id == sensor_id;
    }
    return is_taken;
}

static int32_t number_of_new_name(const struct parameters *parameters, const char *name)
{
    int32_t sensor_id = 1;

    for (size_t i = 0; i < parameters->num_names; i++) {
        if (strcmp(parameters->names[i].text, name) == 0) {
            return parameters->names[i].sensor_id;
        }
    }
    while (is_number_taken(parameters, sensor_id)) {
        sensor_id++;
    }
    return sensor_id;
}

static bool read_name(const struct row_check *check, const struct parameters *parameters,
                      const char *name, int32_t *sensor_id)
{
    for (unsigned i = 0; i < num_names; i++) {
        if (strcmp(names[i].text, name) == 0) {
            *sensor_id = names[i].sensor_id;
            return true;
        }
    }
    if (has_numbers) {
        return row_refuse_cell(check, COL_SENSOR_ID, "is not an integer, as those before it are");
    }
    if (num_names == RHO_MAX_SENSORS) {
        return row_refuse_cell(check, COL_SENSOR_ID, "is one name of a sensor too many");
    }
    names[num_names].sensor_id = number_of_new_name(parameters, name);
    snprintf(names[num_names].text, sizeof names[num_names].text, "%s", name);
    *sensor_id = names[num_names++].sensor_id;
    fprintf(stderr, "rhotrack: %s: sensor %d is %s\n", check->columns->table->path, (int)*sensor_id,
            name);
    return true;
}

/* A name is printed: letters, digits and what is harmless between them. */
static bool is_name(const char *text)
{
    size_t length = isalpha((unsigned char)*text) ? 1 : 0;

    while (length > 0 && (isalnum((unsigned char)text[length]) ||
                          (text[length] && strchr(" _-.:/+#", text[length])))) {
        length++;
    }
    return length > 0 && length < SENSOR_NAME_BYTES && text[length] == '\0';
}

bool sensor_names_read(const struct row_check *check, const struct parameters *parameters,
                       int32_t *sensor_id)
{
    char buffer[TABLE_TEXT_BYTES];
    const char *text = table_cell_text(check->columns->table, check->row,
                                       check->columns->at[COL_SENSOR_ID], buffer);

    if (is_name(text)) {
        return read_name(check, parameters, text, sensor_id);
    }
    if (!row_read_int32(check, COL_SENSOR_ID, sensor_id)) {
        return false;
    }
    if (num_names > 0) {
        return row_refuse_cell(check, COL_SENSOR_ID, "is no name, as those before it are");
    }
    has_numbers = true;
    return true;
}
