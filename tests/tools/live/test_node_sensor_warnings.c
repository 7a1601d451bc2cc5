/* SPDX-License-Identifier: MIT */
/*
 * Three radars over the same targets, live. One becomes biased, blind or silent: RHO_SENSORS and
 * one line on standard error report it, and report when it is over; nothing is reported of healthy
 * sensors.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "live/node_core.h"
#include "live/node_sensor_warnings.h"
#include "rhotrack/message.h"

#define START_US INT64_C(1790000000000000) /* microseconds since 1970, in 2026 */
#define ROUND_US INT64_C(4000000)
#define SENSORS 3
#define TARGETS 8
#define SIGMA_M 30.0

enum fault { WELL, BIASED, BLIND, STOPPED };

struct live {
    struct parameters parameters;
    struct node_core *core;
    struct node_sensors said;
    FILE *lines;
    char *text; /* text written to the stream lines */
    size_t text_size;
    struct random random;
    struct rho_message_sensor_list list; /* the last list of sensors */
    unsigned lists;
    struct rho_message_learned learned; /* the last message of learned values */
    struct rho_message_life life;       /* the last message of tracks' lives */
    unsigned lives;
};

static void keep_sent_message(void *context, const char *channel, const uint8_t *data, size_t size)
{
    struct live *live = context;

    if (strcmp(channel, RHO_MESSAGE_SENSOR_LIST_CHANNEL) == 0) {
        assert_int_equal(rho_message_sensor_list_decode(data, size, &live->list), RHO_OK);
        assert_int_equal(rho_message_sensor_list_validate(&live->list, NULL), RHO_OK);
        live->lists++;
    } else if (strcmp(channel, RHO_MESSAGE_LEARNED_CHANNEL) == 0) {
        assert_int_equal(rho_message_learned_decode(data, size, &live->learned), RHO_OK);
        assert_int_equal(rho_message_learned_validate(&live->learned, NULL), RHO_OK);
    } else if (strcmp(channel, RHO_MESSAGE_LIFE_CHANNEL) == 0) {
        assert_int_equal(rho_message_life_decode(data, size, &live->life), RHO_OK);
        assert_int_equal(rho_message_life_validate(&live->life, NULL), RHO_OK);
        live->lives++;
    }
}

static void print_sensor_changes(void *context, const struct rho_report *report)
{
    struct live *live = context;

    (void)report;
    node_sensors_print_changes(&live->said, live->core, live->lines);
}

/* Sets a parameter as a file for --config would. */
static void set_parameter(struct live *live, const char *name, const char *value)
{
    char reason[PARAMETER_REASON_BYTES];

    assert_true(parameters_assign(&live->parameters, name, value, SOURCE_CONFIG, reason));
}

static struct live *open_node_core(void)
{
    struct live *live = calloc(1, sizeof *live);
    const struct node_core_events events = {
        .context = live, .send = keep_sent_message, .stepped = print_sensor_changes};

    assert_non_null(live);
    parameters_set_defaults(&live->parameters);
    set_parameter(live, "v_max_mps", "400");
    /* the default of 30 would follow such a bias as a manoeuvre */
    set_parameter(live, "accel_max_mps2", "10");
    set_parameter(live, "sensor.1.pd", "0.9");
    set_parameter(live, "sensor.2.pd", "0.9");
    set_parameter(live, "sensor.3.pd", "0.9");
    live->random = random_start(5, 0, 0);
    live->lines = open_memstream(&live->text, &live->text_size);
    assert_non_null(live->lines);
    live->core = node_core_open(&live->parameters, 1, &events);
    return live;
}

static void close_node_core(struct live *live)
{
    node_core_close(live->core);
    fclose(live->lines);
    free(live->text);
    free(live);
}

/* Targets on straight lines, 90 km apart. */
static void add_plots_of_targets(struct live *live, struct rho_message_plot_scan *scan, double t_s,
                                 enum fault fault)
{
    const double shift_m = fault == BIASED ? 4.0 * SIGMA_M : 0.0;

    for (int i = 0; i < TARGETS; i++) {
        const double heading = 0.7 * i, speed = 150.0 + 10.0 * i;
        const double dx_m = SIGMA_M * random_normal(&live->random);
        const double dy_m = SIGMA_M * random_normal(&live->random);

        if (random_uniform(&live->random) < 0.9 && fault != BLIND) {
            scan->plots[scan->num_plots++] = (struct rho_message_plot){
                .x_m = (float)(90000.0 * (i % 4) - 135000.0 + speed * cos(heading) * t_s + dx_m +
                               shift_m),
                .y_m = (float)(90000.0 * (i / 4) + speed * sin(heading) * t_s + dy_m + shift_m),
                .sigma_m = (float)SIGMA_M};
        }
    }
}

static void take_radar_scan(struct live *live, int16_t sensor_id, int32_t round, enum fault fault)
{
    static struct rho_message_plot_scan scan;
    const int64_t time_us = START_US + round * ROUND_US + sensor_id * INT64_C(1000000);
    uint8_t buffer[RHO_MESSAGE_PLOT_SCAN_MAX_SIZE];
    char channel[32];
    size_t size;

    scan = (struct rho_message_plot_scan){.utime = time_us,
                                          .scan = round,
                                          .sensor_id = sensor_id,
                                          .kind = RHO_MESSAGE_PLOT_SCAN_POSITION_2D,
                                          .num_parts = 1};
    add_plots_of_targets(live, &scan, (double)(time_us - START_US) / 1e6, fault);
    assert_int_equal(rho_message_plot_scan_encode(&scan, buffer, sizeof buffer, &size), RHO_OK);
    snprintf(channel, sizeof channel, "%s%d", RHO_MESSAGE_PLOT_SCAN_CHANNEL, sensor_id);
    node_core_take_message(live->core, channel, buffer, size, time_us);
}

/* Steps rounds of all radars; sensor 1 has the fault. */
static void run_rounds(struct live *live, int32_t from, int32_t to, enum fault fault)
{
    for (int32_t round = from; round < to; round++) {
        for (int16_t sensor_id = 1; sensor_id <= SENSORS; sensor_id++) {
            if (sensor_id > 1 || fault != STOPPED) {
                take_radar_scan(live, sensor_id, round, sensor_id == 1 ? fault : WELL);
            }
        }
        node_core_tick(live->core, START_US + (round + 1) * ROUND_US);
        node_sensors_print_changes(&live->said, live->core, live->lines);
    }
    const struct node_core_losses none = {.reports_not_printed = 0};
    node_core_send_status(live->core, &none);
    fflush(live->lines);
}

static const struct rho_message_sensor *sensor_in_list(const struct live *live, int16_t sensor_id)
{
    for (int i = 0; i < live->list.num_sensors; i++) {
        if (live->list.sensors[i].sensor_id == sensor_id) {
            return &live->list.sensors[i];
        }
    }
    fail_msg("sensor %d is not in the list", sensor_id);
    return NULL;
}

static void expect_other_sensors_well(const struct live *live)
{
    assert_int_equal(live->list.num_sensors, SENSORS);
    for (int16_t sensor_id = 2; sensor_id <= SENSORS; sensor_id++) {
        const struct rho_message_sensor *sensor = sensor_in_list(live, sensor_id);

        assert_int_equal(sensor->is_doubted + sensor->is_silent + sensor->is_off_clock, 0);
        assert_int_equal(sensor->watched, 16);
        assert_in_range((int)(100.0f * sensor->seen_share), 60, 100);
        assert_in_range((int)(100.0f * sensor->innovation_factor), 30, 250);
        assert_int_equal(sensor->interval_us, ROUND_US);
    }
}

static void no_warning_names_a_healthy_sensor(void **state)
{
    struct live *live = open_node_core();

    (void)state;
    run_rounds(live, 0, 60, WELL);
    expect_other_sensors_well(live);
    assert_int_equal(sensor_in_list(live, 1)->is_doubted, 0);
    assert_int_equal(sensor_in_list(live, 1)->scans, 60);
    node_sensors_print_all(live->core, live->lines);
    fflush(live->lines);
    assert_string_equal(live->text, "");
    close_node_core(live);
}

/* The text is FROM, a number, TO, and nothing more. Returns the number. */
static double number_between(const char *text, const char *from, const char *to)
{
    char *behind;
    double number;

    assert_memory_equal(text, from, strlen(from));
    number = strtod(text + strlen(from), &behind);
    assert_string_equal(behind, to);
    return number;
}

static void a_biased_sensor_is_warned_of_once(void **state)
{
    struct live *live = open_node_core();
    double times;

    (void)state;
    run_rounds(live, 0, 30, WELL);
    assert_string_equal(live->text, "");
    run_rounds(live, 30, 60, BIASED);
    print_message("%s", live->text);
    expect_other_sensors_well(live);
    assert_int_equal(sensor_in_list(live, 1)->is_doubted, 1);
    assert_true(sensor_in_list(live, 1)->innovation_factor > 4.0f);
    times = number_between(live->text, "rhotrack: sensor 1 is suspect: its innovations are ",
                           " times what its sigmas say\n");
    assert_true(times >= 2.0 && times < 4.0);
    node_sensors_print_all(live->core, live->lines);
    fflush(live->lines);
    assert_non_null(strstr(live->text, "say\nrhotrack: sensor 1 contradicts the others\n"));
    close_node_core(live);
}

static void a_sensor_no_longer_biased_is_trusted_again(void **state)
{
    struct live *live = open_node_core();
    const char *second;

    (void)state;
    run_rounds(live, 0, 30, WELL);
    run_rounds(live, 30, 60, BIASED);
    run_rounds(live, 60, 90, WELL);
    second = strchr(live->text, '\n');
    assert_non_null(second);
    assert_string_equal(second + 1, "rhotrack: sensor 1 is trusted again\n");
    assert_int_equal(sensor_in_list(live, 1)->is_doubted, 0);
    expect_other_sensors_well(live);
    close_node_core(live);
}

static void a_sensor_that_sees_nothing_is_warned_of(void **state)
{
    struct live *live = open_node_core();

    (void)state;
    run_rounds(live, 0, 30, WELL);
    run_rounds(live, 30, 60, BLIND);
    assert_int_equal(sensor_in_list(live, 1)->is_doubted, 1);
    assert_true(sensor_in_list(live, 1)->seen_share < 0.3f);
    expect_other_sensors_well(live);
    number_between(live->text, "rhotrack: sensor 1 is suspect: it sees ",
                   " % of the tracks that others see\n");
    close_node_core(live);
}

static void a_stopped_sensor_is_reported_silent(void **state)
{
    struct live *live = open_node_core();

    (void)state;
    run_rounds(live, 0, 30, WELL);
    run_rounds(live, 30, 36,
               STOPPED); /* the stopped sensor's last scan was at 117 s; now it is 144 s */
    assert_string_equal(live->text, "");
    assert_int_equal(sensor_in_list(live, 1)->is_silent, 0);
    run_rounds(live, 36, 60, STOPPED);
    assert_int_equal(sensor_in_list(live, 1)->is_silent, 1);
    expect_other_sensors_well(live);
    number_between(live->text, "rhotrack: sensor 1 is silent: nothing on RHO_PLOTS_1 for ", " s\n");
    run_rounds(live, 60, 75, WELL);
    assert_int_equal(sensor_in_list(live, 1)->is_silent, 0);
    assert_non_null(strstr(live->text, " s\nrhotrack: sensor 1 is heard again\n"));
    close_node_core(live);
}

/* One kind of RHO_SENSORS is both bearings and directions: the line names both channels. */
static void a_stopped_sensor_of_directions_is_named_with_its_channel(void **state)
{
    struct live *live = open_node_core();
    uint8_t buffer[RHO_MESSAGE_DIRECTION_SCAN_MAX_SIZE];
    size_t size;

    (void)state;
    for (int32_t round = 0; round < 10; round++) {
        const struct rho_message_direction_scan scan = {.utime = START_US + round * ROUND_US,
                                                        .scan = round,
                                                        .sensor_id = 7,
                                                        .sigma_rad = 0.01f,
                                                        .sigma_elevation_rad = 0.01f};

        assert_int_equal(rho_message_direction_scan_encode(&scan, buffer, sizeof buffer, &size),
                         RHO_OK);
        node_core_take_message(live->core, RHO_MESSAGE_DIRECTION_SCAN_CHANNEL "7", buffer, size,
                               scan.utime);
        run_rounds(live, round, round + 1, WELL);
    }
    run_rounds(live, 10, 40, WELL);
    number_between(live->text,
                   "rhotrack: sensor 7 is silent: nothing on RHO_BEARINGS_7 or RHO_DIRECTIONS_7 "
                   "for ",
                   " s\n");
    close_node_core(live);
}

/*
 * A sensor of a single scan, which anybody may have forged, causes no warning when it falls silent.
 */
static void a_sensor_of_a_single_scan_is_not_warned_of(void **state)
{
    struct live *live = open_node_core();

    (void)state;
    run_rounds(live, 0, 10, WELL);
    take_radar_scan(live, 9, 10, WELL);
    run_rounds(live, 10, 40, WELL);
    assert_int_equal(sensor_in_list(live, 9)->scans, 1);
    assert_int_equal(sensor_in_list(live, 9)->is_silent, 1);
    fflush(live->lines);
    assert_null(strstr(live->text, "sensor 9"));
    close_node_core(live);
}

/* Tracks seen by two radars teach the P_D of each, but not its noise. */
static void learned_values_are_sent_of_one_sensor_at_a_time(void **state)
{
    struct live *live = open_node_core();
    const struct node_core_losses none = {.reports_not_printed = 0};
    const struct rho_message_learned *learned = &live->learned;

    (void)state;
    run_rounds(live, 0, 40, WELL);
    for (int call = 1; call < 7; call++) {
        node_core_send_status(live->core, &none);
        assert_int_equal(learned->sensor_id, 1 + call % SENSORS);
        assert_int_equal(learned->scan, live->list.scan);
        assert_int_equal(learned->epoch, live->list.epoch);
        assert_true(learned->looks > 0);
        assert_float_equal(learned->pd_stated, 0.9f, 0.0f);
        assert_float_equal(learned->pd[0], 0.9f, 0.0f);
        assert_float_equal(learned->sigma_range_factor, 1.0f, 0.0f);
    }
    close_node_core(live);
}

static void lives_of_tracks_are_sent_with_each_status(void **state)
{
    struct live *live = open_node_core();

    (void)state;
    run_rounds(live, 0, 40, WELL);
    assert_int_equal(live->lives, live->lists);
    assert_int_equal(live->life.scan, live->list.scan);
    assert_int_equal(live->life.epoch, live->list.epoch);
    assert_int_equal(live->life.num_tracks, TARGETS);
    assert_true(live->life.lived_scans > 0.0f);
    for (int i = 0; i < live->life.num_tracks; i++) {
        assert_true(live->life.tracks[i].existence > 0.9f);
        assert_true(live->life.tracks[i].visibility <= live->life.tracks[i].existence);
    }
    close_node_core(live);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_warning_names_a_healthy_sensor),
        cmocka_unit_test(a_biased_sensor_is_warned_of_once),
        cmocka_unit_test(a_sensor_no_longer_biased_is_trusted_again),
        cmocka_unit_test(a_sensor_that_sees_nothing_is_warned_of),
        cmocka_unit_test(a_stopped_sensor_is_reported_silent),
        cmocka_unit_test(a_stopped_sensor_of_directions_is_named_with_its_channel),
        cmocka_unit_test(a_sensor_of_a_single_scan_is_not_warned_of),
        cmocka_unit_test(learned_values_are_sent_of_one_sensor_at_a_time),
        cmocka_unit_test(lives_of_tracks_are_sent_with_each_status),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
