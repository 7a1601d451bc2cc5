/* SPDX-License-Identifier: MIT */
/*
 * The reader of INI files (--config) and of --set, on any text: it is refused with one line, or
 * every parameter is within its limits and the library accepts the configurations made from it. The
 * first byte: 1 runs the library, too; behind the file follow assignments of --set, each after a
 * byte 1.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "catch_reader_fail.h"
#include "check.h"
#include "io/csv/local_frame.h"
#include "settings/parameters.h"

#define SETS_MAX 8
#define BETWEEN 1 /* byte that separates the assignments */

static struct parameters parameters;
static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_scan_assembler assembler;
static FILE *nowhere;

struct reading {
    char *path;
    char *sets[SETS_MAX];
    size_t num_sets;
    bool asks_library;
};

static void check_set_value_is_within_limits(struct parameter_text text, double value,
                                             enum parameter_source source)
{
    if (source != SOURCE_UNSET) {
        CHECK(value >= text.min && value <= text.max); /* false for NaN, too */
        CHECK(!text.is_integer || !(floor(value) < value));
    }
}

static void check_all_values_are_within_limits(void)
{
    for (int id = 0; id < NUM_PARAMETERS; id++) {
        check_set_value_is_within_limits(parameters_text((enum parameter_id)id),
                                         parameters.value[id], parameters.source[id]);
    }
    CHECK(parameters.num_sensors <= RHO_MAX_SENSORS && parameters.num_allowed <= RHO_MAX_SENSORS);
    for (size_t i = 0; i < parameters.num_sensors; i++) {
        const struct sensor_parameters *sensor = &parameters.sensors[i];

        for (int id = 0; id < NUM_SENSOR_PARAMETERS; id++) {
            check_set_value_is_within_limits(parameters_sensor_text((enum sensor_parameter_id)id),
                                             sensor->value[id], sensor->source[id]);
        }
        for (size_t k = 0; k < i; k++) {
            CHECK(parameters.sensors[k].sensor_id != sensor->sensor_id);
        }
    }
}

/* The library accepts the configurations of parameters that passed their checks. */
static void check_library_takes_configs(void)
{
    struct rho_tracker_config maintain;
    struct rho_initiator_config start;
    struct rho_sensor sensor;

    parameters_to_tracker(&parameters, &maintain);
    parameters_to_initiator(&parameters, &start);
    /* the gate none exists in the command maintain alone */
    if (parameters.value[PARAMETER_GATE] < RHO_NUM_TRACKER_GATES) {
        CHECK(rho_tracker_init(&tracker, sizeof tracker, &maintain) == RHO_OK);
        for (size_t i = 0; i < parameters.num_sensors; i++) {
            CHECK(parameters_to_sensor(&parameters, parameters.sensors[i].sensor_id, &sensor));
            CHECK(rho_tracker_set_sensor(&tracker, &sensor) == RHO_OK);
        }
    }
    CHECK(rho_initiator_init(&initiator, sizeof initiator, &start) == RHO_OK);
    parameters_to_assembler(&parameters, &assembler);
}

static void read_config(void *context)
{
    const struct reading *reading = context;

    parameters_set_defaults(&parameters);
    parameters_load_ini(&parameters, reading->path);
    for (size_t i = 0; i < reading->num_sets; i++) {
        parameters_set_assignment(&parameters, reading->sets[i]);
    }
    parameters_locate_sensors(&parameters);
    parameters_check_together(&parameters);
    check_all_values_are_within_limits();
    parameters_print_table(&parameters, nowhere);
    if (reading->asks_library) {
        check_library_takes_configs();
    }
}

/*
 * Creates what PROJ keeps for the whole process before the first run's memory is counted; PROJ
 * works without its database.
 */
static void open_what_the_process_keeps(void)
{
    CHECK(setenv("PROJ_DATA", "/nonexistent", 1) == 0);
    parameters_set_defaults(&parameters);
    local_frame_close(parameters_open_local_frame(&parameters));
    nowhere = fopen("/dev/null", "w");
    CHECK(nowhere);
    refusal_install_hooks();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct reading reading = {0};
    char *text, *at;

    if (!nowhere) {
        open_what_the_process_keeps();
    }
    if (size == 0) {
        return 0;
    }
    text = malloc(size);
    CHECK(text);
    memcpy(text, data + 1, size - 1);
    text[size - 1] = '\0';
    for (at = memchr(text, BETWEEN, size); at && reading.num_sets < SETS_MAX;
         at = strchr(at, BETWEEN)) {
        *at++ = '\0';
        reading.sets[reading.num_sets++] = at;
    }
    /* the file may contain zero bytes, the assignments before this one end at a byte 1 */
    reading.path = refusal_write_file(
        data + 1, reading.num_sets > 0 ? (size_t)(reading.sets[0] - text) - 1 : size - 1);
    reading.asks_library = data[0] & 1;
    refusal_is_refused(read_config, &reading);
    free(text);
    return 0;
}
