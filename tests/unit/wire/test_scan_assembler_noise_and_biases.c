/* SPDX-License-Identifier: MIT */
/*
 * How a message's plots and bearings are completed: places, noise, biases, and the description of
 * the sensor.
 */
#include <math.h>

#include "rhotrack/tracker.h"
#include "scan_assembler_setup.h"

static uint8_t buffer[DATAGRAM];

#define KNOWN_BIAS_US 250000

static void set_known_sensor(const struct rho_scan_assembler_sensor *sensor)
{
    assert_int_equal(rho_scan_assembler_set_sensor(&assembler, sensor), RHO_OK);
}

static struct rho_scan_assembler_sensor known_sensor(void)
{
    struct rho_scan_assembler_sensor known = usual_config().other;

    known.sensor = (struct rho_sensor){.sensor_id = 7,
                                       .x_m = 100.0f,
                                       .y_m = -200.0f,
                                       .z_m = 30.0f,
                                       .pd = 0.8f,
                                       .range_max_m = 50000.0f,
                                       .range_bias_m = 12.0f,
                                       .azimuth_bias_rad = 0.02f,
                                       .time_bias_s = 0.25f};
    known.noise = (struct rho_scan_assembler_noise){.sigma_m = 21.0f,
                                                    .sigma_mps = 2.1f,
                                                    .sigma_range_m = 22.0f,
                                                    .sigma_azimuth_rad = 0.011f,
                                                    .sigma_elevation_rad = 0.012f,
                                                    .sigma_range_rate_mps = 2.3f,
                                                    .sigma_rad = 0.013f};
    return known;
}

/*
 * ---- plots ------------------------------------------------------------------------------------
 */

/* Takes a message of one plot; bias_us: the configured bias of the sensor's clock. */
static void take_message_of_plot(int16_t sensor_id, int8_t kind,
                                 const struct rho_message_plot *plot, int64_t bias_us)
{
    struct rho_message_plot_scan_head head = {
        .utime = 1000, .scan = 1, .sensor_id = sensor_id, .kind = kind, .num_parts = 1};
    struct rho_message_writer writer;

    assert_int_equal(rho_message_plot_scan_begin(&writer, buffer, sizeof buffer, &head), RHO_OK);
    assert_int_equal(rho_message_plot_scan_add(&writer, plot), RHO_OK);
    assert_int_equal(take_bytes(channel_of(RHO_SCAN_ASSEMBLER_PLOTS, sensor_id), buffer,
                                end_message(&writer), 0),
                     RHO_OK);
    expect_next_scan(0, sensor_id, 1000 - bias_us);
    assert_int_equal(item.scan.num_plots, 1);
}

static void a_plot_keeps_its_values(void **state)
{
    static const uint32_t measures[7] = {[2] = 0,
                                         [3] = RHO_MEASURES_Z,
                                         [4] = RHO_MEASURES_VELOCITY,
                                         [6] = RHO_MEASURES_Z | RHO_MEASURES_VELOCITY};
    const struct rho_message_plot plot = {.dt_us = -77,
                                          .x_m = 1.0f,
                                          .y_m = 2.0f,
                                          .z_m = 3.0f,
                                          .vx_mps = 4.0f,
                                          .vy_mps = 5.0f,
                                          .vz_mps = 6.0f,
                                          .sigma_m = 7.0f,
                                          .sigma_mps = 8.0f,
                                          .snr_db = 9.0f};
    const struct rho_plot want = {.offset_us = -77,
                                  .x_m = 1.0f,
                                  .y_m = 2.0f,
                                  .z_m = 3.0f,
                                  .vx_mps = 4.0f,
                                  .vy_mps = 5.0f,
                                  .vz_mps = 6.0f,
                                  .sigma_range_m = 7.0f,
                                  .sigma_cross_m = 7.0f,
                                  .sigma_up_m = 7.0f,
                                  .sigma_mps = 8.0f,
                                  .sigma_range_rate_mps = 1.0f,
                                  .snr_db = 9.0f};

    (void)state;
    for (int8_t kind = 2; kind <= 6; kind++) {
        if (kind != 5) {
            start_assembler();
            take_message_of_plot(3, kind, &plot, 0);
            assert_int_equal(item.kind, RHO_SCAN_ASSEMBLER_PLOTS);
            assert_int_equal(item.scan.measures, measures[kind]);
            assert_memory_equal(item.scan.plots, &want, sizeof want);
            assert_int_equal(item.has_sensor, 0);
        }
    }
}

static void noise_comes_from_message_else_sensor_else_default(void **state)
{
    const struct rho_message_plot said = {.sigma_m = 7.0f, .sigma_mps = 8.0f}, silent = {.x_m = 0};
    struct rho_scan_assembler_sensor known = known_sensor();

    (void)state;
    for (int is_known = 0; is_known < 2; is_known++) {
        for (int is_said = 0; is_said < 2; is_said++) {
            start_assembler();
            if (is_known) {
                set_known_sensor(&known);
            }
            take_message_of_plot(7, 6, is_said ? &said : &silent, is_known ? KNOWN_BIAS_US : 0);
            const struct rho_plot *plot = &item.scan.plots[0];
            assert_true(plot->sigma_range_m == (is_said ? 7.0f : is_known ? 21.0f : 10.0f));
            assert_true(plot->sigma_cross_m == plot->sigma_range_m);
            assert_true(plot->sigma_up_m == plot->sigma_range_m);
            assert_true(plot->sigma_mps == (is_said ? 8.0f : is_known ? 2.1f : 1.0f));
            assert_int_equal(item.has_sensor, is_known);
            assert_int_equal(item.sensor.sensor_id, 7);
            assert_true(item.sensor.x_m == (is_known ? 100.0f : 0.0f));
            assert_true(item.sensor.pd == (is_known ? 0.8f : 0.9f));
        }
    }
}

static void with_gives_other_items_describe_unknown_sensors(void **state)
{
    const struct rho_message_plot plot = {.x_m = 0};
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    config.gives_other = 1;
    config.other.sensor.pd = 0.55f;
    config.other.sensor.sensor_id = 99;
    start_assembler_with(&config);
    take_message_of_plot(3, 2, &plot, 0);
    assert_int_equal(item.has_sensor, 1);
    assert_int_equal(item.sensor.sensor_id, 3);
    assert_true(item.sensor.pd == 0.55f);
}

/*
 * ---- polar ------------------------------------------------------------------------------------
 */

static void take_message_of_polar_plots(const struct rho_message_polar_scan_head *head,
                                        unsigned count, const struct rho_message_polar_plot *plots)
{
    struct rho_message_writer writer;

    assert_int_equal(rho_message_polar_scan_begin(&writer, buffer, sizeof buffer, head), RHO_OK);
    for (unsigned i = 0; i < count; i++) {
        assert_int_equal(rho_message_polar_scan_add(&writer, &plots[i]), RHO_OK);
    }
    assert_int_equal(take_bytes(channel_of(RHO_SCAN_ASSEMBLER_POLAR, head->sensor_id), buffer,
                                end_message(&writer), 0),
                     RHO_OK);
}

static float uniform(float from, float to)
{
    return from + (to - from) * ((float)random_below(1000001) * 1e-6f);
}

static void polar_plots_are_converted_as_by_measurement(void **state)
{
    (void)state;
    random_state = 4;
    for (unsigned round = 0; round < 400; round++) {
        struct rho_scan_assembler_sensor known = known_sensor();
        struct rho_message_polar_plot plots[5];
        struct rho_message_polar_scan_head head = {.utime = 5,
                                                   .sensor_id = 7,
                                                   .num_parts = 1,
                                                   .has_elevation = (int8_t)(round & 1u),
                                                   .has_range_rate = (int8_t)(round >> 1 & 1u)};
        int is_known = round >> 2 & 1, is_said = round >> 3 & 1, has_place = round >> 4 & 1;
        struct rho_scan_assembler_noise noise = is_known ? known.noise : usual_config().other.noise;
        struct rho_sensor sensor = is_known ? known.sensor : usual_config().other.sensor;

        if (is_said) {
            head.sigma_range_m = noise.sigma_range_m = 31.0f;
            head.sigma_azimuth_rad = noise.sigma_azimuth_rad = 0.021f;
            head.sigma_elevation_rad = noise.sigma_elevation_rad = 0.022f;
            head.sigma_range_rate_mps = noise.sigma_range_rate_mps = 3.1f;
        }
        if (has_place) {
            head.sensor_x_m = sensor.x_m = -400.0f;
            head.sensor_y_m = sensor.y_m = round % 3 == 0 ? 0.0f : 10.0f;
            head.sensor_z_m = sensor.z_m = round % 5 == 0 ? 0.0f : 20.0f;
        }
        sensor.sensor_id = 7;
        for (unsigned i = 0; i < 5; i++) {
            plots[i] = (struct rho_message_polar_plot){.dt_us = (int32_t)random_below(1000),
                                                       .range_m = uniform(100.0f, 1e5f),
                                                       .azimuth_rad = uniform(-3.1f, 3.1f),
                                                       .elevation_rad = uniform(-1.0f, 1.0f),
                                                       .range_rate_mps = uniform(-99.0f, 99.0f),
                                                       .snr_db = uniform(0.0f, 50.0f)};
        }
        start_assembler();
        if (is_known) {
            set_known_sensor(&known);
        }
        take_message_of_polar_plots(&head, 5, plots);
        expect_next_scan(0, 7, is_known ? 5 - KNOWN_BIAS_US : 5);
        assert_int_equal(item.kind, RHO_SCAN_ASSEMBLER_POLAR);
        assert_int_equal(item.has_sensor, is_known || has_place);
        assert_memory_equal(&item.sensor, &sensor, sizeof sensor);
        sensor.time_bias_s = 0.0f; /* time bias other than 0 */
        for (unsigned i = 0; i < 5; i++) {
            struct rho_polar_plot polar = {.offset_us = plots[i].dt_us,
                                           .range_m = plots[i].range_m,
                                           .azimuth_rad = plots[i].azimuth_rad,
                                           .elevation_rad = plots[i].elevation_rad,
                                           .range_rate_mps = plots[i].range_rate_mps,
                                           .snr_db = plots[i].snr_db,
                                           .sigma_range_m = noise.sigma_range_m,
                                           .sigma_azimuth_rad = noise.sigma_azimuth_rad,
                                           .sigma_elevation_rad = noise.sigma_elevation_rad,
                                           .sigma_range_rate_mps = noise.sigma_range_rate_mps};
            struct rho_plot want;
            uint32_t measures = (head.has_elevation ? RHO_MEASURES_Z : 0) |
                                (head.has_range_rate ? RHO_MEASURES_RANGE_RATE : 0);

            assert_int_equal(item.scan.measures, measures);
            assert_int_equal(rho_measurement_from_polar(&polar, measures, &sensor, &want), RHO_OK);
            assert_memory_equal(&item.scan.plots[i], &want, sizeof want);
        }
    }
}

static void plots_without_a_place_keep_their_row_and_are_invalid(void **state)
{
    static struct rho_tracker tracker;
    static struct rho_report report;
    const struct rho_message_polar_plot plots[] = {{.range_m = 1000.0f},
                                                   {.range_m = 0.0f},
                                                   {.range_m = 2000.0f},
                                                   /* range smaller than the range bias */
                                                   {.range_m = 5.0f},
                                                   {.range_m = 3000.0f}};
    struct rho_message_polar_scan_head head = {.sensor_id = 7, .num_parts = 1};
    struct rho_scan_assembler_sensor known = known_sensor();
    struct rho_tracker_config config;

    (void)state;
    start_assembler();
    set_known_sensor(&known);
    take_message_of_polar_plots(&head, 5, plots);
    expect_next_scan(0, 7, -KNOWN_BIAS_US);
    assert_int_equal(item.scan.num_plots, 5);
    rho_tracker_config_default(&config);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &item.sensor), RHO_OK);
    assert_int_equal(rho_tracker_step(&tracker, NULL, &item.scan, &report), RHO_OK);
    for (unsigned i = 0; i < 5; i++) {
        assert_int_equal(report.fates[i], i % 2 ? RHO_FATE_INVALID : RHO_FATE_NO_ROOM);
    }
}

/*
 * ---- bearings ---------------------------------------------------------------------------------
 */

static void bearings_are_corrected_by_the_sensors_biases(void **state)
{
    struct look look = {.time_us = 9,
                        .sensor_id = 7,
                        .kind = RHO_SCAN_ASSEMBLER_BEARINGS,
                        .count = 3,
                        .tag = -3141};
    struct rho_scan_assembler_sensor known = known_sensor();

    (void)state;
    for (int sign = -1; sign <= 1; sign++) {
        start_assembler();
        known.sensor.azimuth_bias_rad = 0.02f * (float)sign;
        known.sensor.time_bias_s = 0.25f * (float)sign;
        set_known_sensor(&known);
        take_message(&look, 0);
        expect_next_scan(0, 7, 9 - KNOWN_BIAS_US * sign);
        assert_int_equal(item.kind, RHO_SCAN_ASSEMBLER_BEARINGS);
        assert_int_equal(item.has_sensor, 1);
        assert_true(item.bearings.x_m == 5.0f && item.bearings.y_m == -6.0f);
        assert_true(item.sensor.x_m == 5.0f && item.sensor.y_m == -6.0f);
        assert_true(item.bearings.sector_from_rad == 0.0f && item.bearings.sector_to_rad == 0.0f);
        for (unsigned i = 0; i < 3; i++) {
            const struct rho_bearing *bearing = &item.bearings.bearings[i];
            double want = remainder(-3.141 + 0.001 * i - 0.02 * sign, 2.0 * acos(-1.0));

            assert_true(fabs(bearing->bearing_rad - want) < 1e-6);
            assert_int_equal(bearing->offset_us, 0);
            assert_true(bearing->sigma_rad == 0.013f);
        }
    }
}

static void noise_of_bearings_comes_from_message_else_default(void **state)
{
    struct rho_message_bearing_scan_head head = {.sensor_id = 3, .sigma_rad = 0.25f};
    struct rho_message_writer writer;
    float bearing_rad = 1.0f;

    (void)state;
    for (int is_said = 0; is_said < 2; is_said++) {
        head.sigma_rad = is_said ? 0.25f : 0.0f;
        start_assembler();
        assert_int_equal(rho_message_bearing_scan_begin(&writer, buffer, sizeof buffer, &head),
                         RHO_OK);
        assert_int_equal(rho_message_bearing_scan_add(&writer, &bearing_rad), RHO_OK);
        assert_int_equal(take_bytes("RHO_BEARINGS_3", buffer, end_message(&writer), 0), RHO_OK);
        expect_next_scan(0, 3, 0);
        assert_true(item.bearings.bearings[0].sigma_rad == (is_said ? 0.25f : 0.00175f));
        assert_true(item.bearings.bearings[0].bearing_rad == 1.0f);
        assert_int_equal(item.bearings.bearings[0].offset_us, 0);
        assert_int_equal(item.has_sensor, 0);
    }
}

/* Two directions, one without an elevation, of a scan of sensor 3. */
static size_t pack_directions(const struct rho_message_direction_scan_head *head)
{
    static const struct rho_message_direction directions[2] = {
        {.dt_us = -7,
         .bearing_rad = 1.0f,
         .elevation_rad = -0.5f,
         .snr_db = 11.0f,
         .has_elevation = 1},
        {.dt_us = 9, .bearing_rad = -3.14f, .elevation_rad = 0.25f}};
    struct rho_message_writer writer;

    assert_int_equal(rho_message_direction_scan_begin(&writer, buffer, sizeof buffer, head),
                     RHO_OK);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(rho_message_direction_scan_add(&writer, &directions[i]), RHO_OK);
    }
    return end_message(&writer);
}

static void directions_are_bearings_with_elevations_where_they_have_them(void **state)
{
    const struct rho_message_direction_scan_head head = {.utime = 4,
                                                         .sensor_id = 3,
                                                         .sensor_x_m = 10.0f,
                                                         .sensor_y_m = 20.0f,
                                                         .sensor_z_m = 30.0f,
                                                         .sigma_rad = 0.25f,
                                                         .sigma_elevation_rad = 0.125f,
                                                         .sector_from_rad = -1.0f,
                                                         .sector_to_rad = 2.0f};
    struct rho_scan_assembler_sensor known = known_sensor();
    const struct rho_bearing *bearings;

    (void)state;
    start_assembler();
    known.sensor.sensor_id = 3;
    known.sensor.azimuth_bias_rad = 0.02f;
    known.sensor.time_bias_s = 0.25f;
    set_known_sensor(&known);
    assert_int_equal(take_bytes("RHO_DIRECTIONS_3", buffer, pack_directions(&head), 0), RHO_OK);
    expect_next_scan(0, 3, 4 - KNOWN_BIAS_US);
    bearings = item.bearings.bearings;
    assert_int_equal(item.kind, RHO_SCAN_ASSEMBLER_BEARINGS);
    assert_true(item.bearings.x_m == 10.0f && item.bearings.y_m == 20.0f);
    assert_true(item.bearings.z_m == 30.0f && item.sensor.z_m == 30.0f);
    assert_true(item.bearings.sector_from_rad == -1.0f && item.bearings.sector_to_rad == 2.0f);
    assert_int_equal(item.bearings.num_bearings, 2);
    assert_int_equal(bearings[0].offset_us, -7);
    assert_int_equal(bearings[1].offset_us, 9);
    assert_true(fabs(bearings[0].bearing_rad - 0.98) < 1e-6);
    assert_true(fabs(bearings[1].bearing_rad - (2.0 * acos(-1.0) - 3.16)) < 1e-6);
    assert_true(bearings[0].sigma_rad == 0.25f && bearings[1].sigma_rad == 0.25f);
    assert_true(bearings[0].elevation_rad == -0.5f && bearings[0].sigma_elevation_rad == 0.125f);
    assert_true(bearings[1].sigma_elevation_rad == 0.0f);
    assert_true(bearings[0].snr_db == 11.0f && bearings[1].snr_db == 0.0f);
    assert_int_equal(assembler.counters.bearings_in, 2);
}

/* Both kinds of messages are of one sensor, whose numbers go on. */
static void directions_follow_bearings_of_their_sensor(void **state)
{
    struct look look = {.scan = 1, .sensor_id = 3, .kind = RHO_SCAN_ASSEMBLER_BEARINGS, .count = 1};
    const struct rho_message_direction_scan_head head = {.utime = 9, .scan = 2, .sensor_id = 3};
    size_t size;

    (void)state;
    start_assembler();
    take_message(&look, 0);
    expect_next_scan(0, 3, 0);
    assert_true(item.bearings.bearings[0].sigma_elevation_rad == 0.0f);
    size = pack_directions(&head);
    assert_int_equal(take_bytes("RHO_BEARINGS_3", buffer, size, 0), RHO_OK);
    assert_int_equal(assembler.counters.messages_wrong_type, 1);
    assert_int_equal(take_bytes("RHO_DIRECTIONS_4", buffer, size, 0), RHO_OK);
    assert_int_equal(assembler.counters.messages_bad, 1);
    assert_int_equal(take_bytes("RHO_DIRECTIONS_3", buffer, size, 0), RHO_OK);
    expect_next_scan(0, 3, 9);
    assert_true(item.bearings.bearings[0].sigma_rad == 0.00175f);
    assert_true(item.bearings.bearings[0].sigma_elevation_rad == 0.003f);
    assert_int_equal(take_bytes("RHO_DIRECTIONS_3", buffer, size, 0), RHO_OK);
    assert_int_equal(assembler.counters.scans_duplicate, 1);
    assert_int_equal(assembler.counters.scans_accepted, 2);
}

/*
 * ---- clocks -----------------------------------------------------------------------------------
 */

/*
 * One clock is a second behind, one is right: all scans are taken and given in the order in which
 * they were made.
 */
static void scans_are_sorted_by_time_without_clock_bias(void **state)
{
    struct rho_scan_assembler_sensor known = known_sensor();

    (void)state;
    for (uint8_t kind = 0; kind < RHO_NUM_SCAN_ASSEMBLER_KINDS; kind++) {
        start_assembler();
        known.sensor.time_bias_s = -1.0f;
        set_known_sensor(&known);
        for (int32_t k = 1; k <= 20; k++) {
            struct look right = {.time_us = k * SECOND_US, .scan = k, .sensor_id = 3, .kind = kind},
                        behind = right;

            behind.sensor_id = 7;
            behind.time_us -= SECOND_US / 2;
            take_message(&right, k * SECOND_US);
            expect_next_scan(INT64_MAX, 3, k * SECOND_US);
            take_message(&behind, k * SECOND_US + SECOND_US / 2);
            expect_next_scan(INT64_MAX, 7, k * SECOND_US + SECOND_US / 2);
        }
        assert_int_equal(assembler.counters.scans_accepted, 40);
        assert_int_equal(assembler.counters.clock_jumps, 0);
        assert_int_equal(assembler.counters.scans_late, 0);
    }
}

/* Within hold_us, a scan of a clock that is ahead waits for one that was made before it. */
static void a_scan_of_a_clock_ahead_waits_for_older_ones(void **state)
{
    struct rho_scan_assembler_sensor known = known_sensor();
    struct look ahead = {.time_us = 3 * SECOND_US, .scan = 1, .sensor_id = 7},
                right = {.time_us = 2 * SECOND_US - 5000, .scan = 1, .sensor_id = 3};

    (void)state;
    known.sensor.time_bias_s = 1.0f; /* its true time is 2 s */
    for (int comes_first = 0; comes_first < 2; comes_first++) {
        start_assembler();
        set_known_sensor(&known);
        ahead.scan = right.scan = 1;
        take_message(comes_first ? &ahead : &right, 0);
        take_message(comes_first ? &right : &ahead, HOLD_US / 2);
        expect_next_scan(INT64_MAX, 3, 2 * SECOND_US - 5000);
        expect_next_scan(INT64_MAX, 7, 2 * SECOND_US);
    }
}

static void times_beyond_the_limit_without_bias_are_refused(void **state)
{
    struct rho_scan_assembler_sensor known = known_sensor();
    const int64_t times_us[] = {-RHO_LIMIT_TIME_US, RHO_LIMIT_TIME_US};

    (void)state;
    for (unsigned i = 0; i < 2; i++) {
        for (int beyond = 0; beyond < 2; beyond++) {
            struct look look = {.time_us = times_us[i], .scan = 1, .sensor_id = 7};

            start_assembler();
            known.sensor.time_bias_s = i == (unsigned)beyond ? -10.0f : 10.0f;
            set_known_sensor(&known);
            take_message(&look, 0);
            assert_int_equal(assembler.counters.messages_bad, beyond);
            assert_int_equal(assembler.counters.scans_accepted, 1 - beyond);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plot_keeps_its_values),
        cmocka_unit_test(noise_comes_from_message_else_sensor_else_default),
        cmocka_unit_test(with_gives_other_items_describe_unknown_sensors),
        cmocka_unit_test(polar_plots_are_converted_as_by_measurement),
        cmocka_unit_test(plots_without_a_place_keep_their_row_and_are_invalid),
        cmocka_unit_test(bearings_are_corrected_by_the_sensors_biases),
        cmocka_unit_test(noise_of_bearings_comes_from_message_else_default),
        cmocka_unit_test(directions_are_bearings_with_elevations_where_they_have_them),
        cmocka_unit_test(directions_follow_bearings_of_their_sensor),
        cmocka_unit_test(scans_are_sorted_by_time_without_clock_bias),
        cmocka_unit_test(a_scan_of_a_clock_ahead_waits_for_older_ones),
        cmocka_unit_test(times_beyond_the_limit_without_bias_are_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
