/* SPDX-License-Identifier: MIT */
/*
 * ASTERIX records compared with what libasterix reads and writes; records cut short, data blocks,
 * and invalid bytes.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "io/asterix/asterix_codec.h"
#include "vectors/asterix_vectors.h"

#define COUNT(list) (sizeof(list) / sizeof(*(list)))
#define RECORD_MAX 4096

static size_t bytes_of_hex(const char *hex, uint8_t *bytes)
{
    size_t size = strlen(hex) / 2;

    assert_true(size <= RECORD_MAX);
    for (size_t i = 0; i < size; i++) {
        const char digits[3] = {hex[2 * i], hex[2 * i + 1], '\0'};

        bytes[i] = (uint8_t)strtoul(digits, NULL, 16);
    }
    return size;
}

/* Checks an optional value as libasterix decodes it; NAN: absent. */
static void check_optional_value(bool is_there, double value, double expected)
{
    assert_int_equal(is_there, !isnan(expected));
    if (is_there) {
        assert_true(fabs(value - expected) <= 1e-12 * fabs(expected));
    }
}

/*
 * Reads the record of a test vector into `bytes` and checks the length of every item; every shorter
 * record is refused.
 */
static struct asterix_record check_record(uint8_t category, const char *hex,
                                          uint8_t bytes[RECORD_MAX], const uint16_t *sizes,
                                          size_t places)
{
    size_t size = bytes_of_hex(hex, bytes);
    struct asterix_record record, cut;
    struct asterix_error error = {.reason = ""};

    assert_true(asterix_record_read(category, bytes, size, &record, &error));
    assert_int_equal(record.size, size);
    for (size_t i = 0; i < places; i++) {
        assert_int_equal(record.items[i] != NULL, sizes[i] > 0);
        assert_int_equal(record.sizes[i], sizes[i]);
    }
    for (size_t shorter = 0; shorter < size; shorter++) {
        uint8_t *exact = malloc(shorter + 1); /* nothing behind the record may be read */

        memcpy(exact, bytes, shorter);
        error.reason[0] = '\0';
        assert_false(asterix_record_read(category, exact, shorter, &cut, &error));
        assert_true(error.at <= shorter && error.reason[0]);
        free(exact);
    }
    return record;
}

static void test_cat048_plots(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(vectors_48); i++) {
        const double *v = vectors_48[i].values;
        uint8_t bytes[RECORD_MAX];
        struct asterix_record record = check_record(ASTERIX_PLOTS, vectors_48[i].hex, bytes,
                                                    vectors_48[i].sizes, VECTORS_48_PLACES);
        struct asterix_plot plot;
        bool has_second = !isnan(v[6]);

        asterix_plot_read(&record, &plot);
        check_optional_value(plot.source.is_given, plot.source.sac, v[0]);
        check_optional_value(plot.source.is_given, plot.source.sic, v[1]);
        check_optional_value(plot.has_time, plot.time_128 / 128.0, v[2]);
        check_optional_value(plot.has_type, plot.type, v[3]);
        check_optional_value(plot.has_type, plot.is_simulated, v[4]);
        check_optional_value(plot.has_type, plot.is_fixed, v[5]);
        check_optional_value(has_second, plot.is_test, v[6]);
        check_optional_value(has_second, plot.is_beyond, v[7]);
        check_optional_value(plot.has_position, plot.range * ASTERIX_RANGE_M / 1852, v[8]);
        check_optional_value(plot.has_position, plot.azimuth * 360.0 / ASTERIX_TURN, v[9]);
        check_optional_value(plot.has_mode_a, plot.mode_a, v[10]);
        check_optional_value(plot.has_level, plot.is_level_bad, fmax(v[11], v[12]));
        check_optional_value(plot.has_level, plot.level / 4.0, v[13]);
        check_optional_value(plot.has_height, plot.height * 25.0, v[14]);
        check_optional_value(plot.has_doppler, plot.is_doppler_bad, v[15]);
        check_optional_value(plot.has_doppler, plot.doppler_mps, v[16]);
        check_optional_value(plot.has_track, plot.track, v[17]);
        check_optional_value(plot.has_address, plot.address, v[18]);
    }
}

/* Checks the values of a CAT001 plot or track record. */
static void check_cat001_plot(const struct asterix_record *record, bool is_track, const double *v)
{
    struct asterix_plot plot;

    assert_int_equal(record->is_track, is_track);
    asterix_plot_read(record, &plot);
    check_optional_value(plot.source.is_given, plot.source.sac, v[0]);
    check_optional_value(plot.source.is_given, plot.source.sic, v[1]);
    check_optional_value(plot.has_time, plot.time_128 / 128.0, v[2]);
    assert_int_equal(plot.is_time_truncated, plot.has_time);
    check_optional_value(plot.has_type, is_track, v[3]);
    check_optional_value(plot.has_type, plot.is_simulated, v[4]);
    check_optional_value(plot.has_type, plot.type, v[5]);
    check_optional_value(plot.has_type, plot.is_fixed, v[6]);
    check_optional_value(!isnan(v[7]), plot.is_test, v[7]);
    check_optional_value(plot.has_position, plot.range * ASTERIX_RANGE_M / 1852, v[8]);
    check_optional_value(plot.has_position, plot.azimuth * 360.0 / ASTERIX_TURN, v[9]);
    check_optional_value(plot.has_mode_a, plot.mode_a, v[10]);
    check_optional_value(plot.has_level, plot.is_level_bad, fmax(v[11], v[12]));
    check_optional_value(plot.has_level, plot.level / 4.0, v[13]);
    check_optional_value(plot.has_track, plot.track, v[14]);
    assert_false(plot.has_height || plot.has_doppler || plot.is_beyond);
}

static void test_cat001_plots(void **state)
{
    uint8_t bytes[RECORD_MAX];

    (void)state;
    for (size_t i = 0; i < COUNT(vectors_1_plot); i++) {
        struct asterix_record record = check_record(ASTERIX_OLD_PLOTS, vectors_1_plot[i].hex, bytes,
                                                    vectors_1_plot[i].sizes, VECTORS_1_PLOT_PLACES);

        check_cat001_plot(&record, false, vectors_1_plot[i].values);
    }
    for (size_t i = 0; i < COUNT(vectors_1_track); i++) {
        struct asterix_record record =
            check_record(ASTERIX_OLD_PLOTS, vectors_1_track[i].hex, bytes, vectors_1_track[i].sizes,
                         VECTORS_1_TRACK_PLACES);

        check_cat001_plot(&record, true, vectors_1_track[i].values);
    }
}

static void test_cat002_service_messages(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(vectors_2); i++) {
        const double *v = vectors_2[i].values;
        uint8_t bytes[RECORD_MAX];
        struct asterix_record record = check_record(ASTERIX_OLD_SERVICE, vectors_2[i].hex, bytes,
                                                    vectors_2[i].sizes, VECTORS_2_PLACES);
        struct asterix_service service;

        asterix_service_read(&record, &service);
        check_optional_value(service.source.is_given, service.source.sac, v[0]);
        check_optional_value(service.source.is_given, service.source.sic, v[1]);
        check_optional_value(service.has_type, service.type, v[2]);
        check_optional_value(service.has_sector, service.sector * 360.0 / 256, v[3]);
        check_optional_value(service.has_time, service.time_128 / 128.0, v[4]);
        check_optional_value(service.has_period, service.period_128 / 128.0, v[5]);
        assert_false(service.place.is_given);
    }
}

/*
 * Items in random field sequence (RFS), which libasterix does not encode: by hand from the
 * specification.
 */
static void test_items_in_random_field_sequence(void **state)
{
    /* a plot: item 010, then RFS of item 040 (FRN 3) and item 141 (FRN 7) */
    static const uint8_t plot[] = {0x81, 0x01, 0x02, 10, 20, 2, 3, 1, 2, 3, 4, 7, 5, 6};
    struct asterix_record record;
    struct asterix_error error = {.reason = ""};

    (void)state;
    assert_true(asterix_record_read(ASTERIX_OLD_PLOTS, plot, sizeof plot, &record, &error));
    assert_int_equal(record.size, sizeof plot);
    assert_int_equal(record.sizes[20], 9);
}

static void test_cat034_service_messages(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(vectors_34); i++) {
        const double *v = vectors_34[i].values;
        uint8_t bytes[RECORD_MAX];
        struct asterix_record record = check_record(ASTERIX_SERVICE, vectors_34[i].hex, bytes,
                                                    vectors_34[i].sizes, VECTORS_34_PLACES);
        struct asterix_service service;

        asterix_service_read(&record, &service);
        check_optional_value(service.has_type, service.type, v[0]);
        check_optional_value(service.has_sector, service.sector * 360.0 / 256, v[1]);
        check_optional_value(service.has_time, service.time_128 / 128.0, v[2]);
        check_optional_value(service.has_period, service.period_128 / 128.0, v[3]);
        if (fabs(v[5]) > 90) {
            assert_false(service.place.is_given); /* latitude beyond a pole */
        } else {
            check_optional_value(service.place.is_given, service.place.alt_m, v[4]);
            check_optional_value(service.place.is_given, service.place.lat_deg, v[5]);
            check_optional_value(service.place.is_given, service.place.lon_deg, v[6]);
        }
    }
}

static void test_cat062_tracks_are_read(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(vectors_62); i++) {
        const double *v = vectors_62[i].values;
        uint8_t bytes[RECORD_MAX];
        struct asterix_record record = check_record(ASTERIX_TRACKS, vectors_62[i].hex, bytes,
                                                    vectors_62[i].sizes, VECTORS_62_PLACES);
        struct asterix_track track;

        asterix_track_read(&record, &track);
        check_optional_value(track.has_number, track.number, v[0]);
        check_optional_value(track.has_time, track.time_128 / 128.0, v[1]);
        check_optional_value(track.has_status, track.is_tentative, v[2]);
        check_optional_value(!isnan(v[3]), track.is_last, v[3]);
        check_optional_value(!isnan(v[4]), track.is_first, v[4]);
        check_optional_value(!isnan(v[5]), track.is_coasting, v[5]);
        check_optional_value(track.has_place, track.x_m, v[6]);
        check_optional_value(track.has_place, track.y_m, v[7]);
        check_optional_value(track.has_geodetic, track.lat_deg, v[8]);
        check_optional_value(track.has_geodetic, track.lon_deg, v[9]);
        check_optional_value(track.has_velocity, track.vx_mps, v[10]);
        check_optional_value(track.has_velocity, track.vy_mps, v[11]);
        check_optional_value(track.has_accel, track.ax_mps2, v[12]);
        check_optional_value(track.has_accel, track.ay_mps2, v[13]);
        check_optional_value(track.has_altitude, track.alt_m / 0.3048, v[14]);
        check_optional_value(track.has_climb, track.climb_mps / 0.3048 * 60, v[15]);
        if (!isnan(v[16]) && !isnan(v[18])) {
            check_optional_value(track.has_sigma, track.sigma_x_m, v[16]);
            check_optional_value(track.has_sigma, track.sigma_y_m, v[17]);
            check_optional_value(track.has_sigma, track.sigma_vx_mps, v[18]);
            check_optional_value(track.has_sigma, track.sigma_vy_mps, v[19]);
        }
    }
}

static struct asterix_track track_of_values(const double *v)
{
    const double foot_m = 0.3048;

    return (struct asterix_track){
        .source = {true, (uint8_t)v[0], (uint8_t)v[1]},
        .time_128 = (uint32_t)v[2],
        .number = (uint16_t)v[3],
        .is_monosensor = v[4] > 0,
        .is_tentative = v[5] > 0,
        .is_last = v[6] > 0,
        .is_first = v[7] > 0,
        .is_coasting = v[8] > 0,
        .has_place = true,
        .x_m = v[9] / 2,
        .y_m = v[10] / 2,
        .has_velocity = true,
        .vx_mps = v[11] / 4,
        .vy_mps = v[12] / 4,
        .has_accel = true,
        .ax_mps2 = v[13] / 4,
        .ay_mps2 = v[14] / 4,
        .has_geodetic = !isnan(v[15]),
        .lat_deg = v[15] * 180 / 33554432,
        .lon_deg = v[16] * 180 / 33554432,
        .has_altitude = !isnan(v[17]),
        .alt_m = v[17] * 6.25 * foot_m,
        .has_climb = !isnan(v[18]),
        .climb_mps = v[18] * 6.25 * foot_m / 60,
        .has_sigma = !isnan(v[19]),
        .sigma_x_m = v[19] / 2,
        .sigma_y_m = v[20] / 2,
        .sigma_vx_mps = v[21] / 4,
        .sigma_vy_mps = v[22] / 4,
    };
}

static void test_cat062_tracks_are_written(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(vectors_tracks); i++) {
        struct asterix_track track = track_of_values(vectors_tracks[i].values);
        uint8_t expected[RECORD_MAX], bytes[ASTERIX_TRACK_BYTES];
        size_t size = bytes_of_hex(vectors_tracks[i].hex, expected);

        assert_int_equal(asterix_track_encode(&track, bytes), size);
        assert_memory_equal(bytes, expected, size);
    }
}

/* Values too large for their item become its largest value. */
static void test_values_beyond_an_item_become_its_largest(void **state)
{
    struct asterix_track track = {.has_place = true,
                                  .x_m = 1e7,
                                  .y_m = -1e7,
                                  .has_velocity = true,
                                  .vx_mps = 2e4,
                                  .vy_mps = -2e4,
                                  .has_sigma = true,
                                  .sigma_x_m = 1e6,
                                  .sigma_vx_mps = 1e3};
    uint8_t bytes[ASTERIX_TRACK_BYTES];
    size_t size = asterix_track_encode(&track, bytes);
    struct asterix_record record;
    struct asterix_error error;

    (void)state;
    assert_true(asterix_record_read(ASTERIX_TRACKS, bytes, size, &record, &error));
    asterix_track_read(&record, &track);
    assert_true(track.x_m == 4194303.5 && track.y_m == -4194304.0);
    assert_true(track.vx_mps == 8191.75 && track.vy_mps == -8192.0);
    assert_true(track.sigma_x_m == 32767.5 && track.sigma_vx_mps == 63.75);
}

static void check_bad_record(uint8_t category, const char *hex, size_t at, const char *reason)
{
    uint8_t bytes[RECORD_MAX];
    size_t size = bytes_of_hex(hex, bytes);
    struct asterix_record record;
    struct asterix_error error = {.reason = ""};

    assert_false(asterix_record_read(category, bytes, size, &record, &error));
    assert_string_equal(error.reason, reason);
    assert_int_equal(error.at, at);
}

static void test_bad_records_are_refused_with_reason(void **state)
{
    (void)state;
    check_bad_record(48, "", 0,
                     "the field specification of a record of CAT048 goes beyond its data block");
    check_bad_record(48, "0101010101010101", 0,
                     "the field specification of a record of CAT048 goes beyond its data block");
    check_bad_record(48, "010101010000", 0,
                     "the field specification of a record of CAT048 has 5 bytes");
    check_bad_record(34, "010200", 2, "I034/SP has a length of 0");
    check_bad_record(62, "400000", 0, "a record of CAT062 has an item at the undefined place 2");
    check_bad_record(48, "8001", 1, "I048/010 goes beyond its data block");
    check_bad_record(48, "21ff", 0,
                     "the field specification of a record of CAT048 goes beyond its data block");
    check_bad_record(48, "20ffff", 1, "I048/020 goes beyond its data block");
    check_bad_record(48, "0120ff", 2, "I048/250 goes beyond its data block");
    check_bad_record(48, "010104a0", 3, "I048/120 has an item at the undefined place 3");
    check_bad_record(48, "01010440ff00", 4, "I048/120/RDS goes beyond its data block");
    check_bad_record(48, "010101040000", 4, "I048/SP has a length of 0");
    check_bad_record(34, "0440", 1, "I034/050 has an item at the undefined place 2");
    check_bad_record(9, "80", 0, "category 9 is not known");
    check_bad_record(1, "c0010203", 3, "I001/020 goes beyond its data block");
    check_bad_record(1, "010102", 3, "I001/RFS goes beyond its data block");
    check_bad_record(1, "0101020110", 3, "I001/RFS has an item at the undefined place 16");
    check_bad_record(1, "0101020115", 3, "I001/RFS has an item at the undefined place 21");
    check_bad_record(1, "01010202", 3, "I001/RFS has an item at the undefined place 0");
    check_bad_record(1, "010102010301", 5, "I001/040 goes beyond its data block");
    check_bad_record(1, "c1014001020000", 2,
                     "a record of CAT001 has an item at the undefined place 16");
    check_bad_record(2, "0108", 1, "a record of CAT002 has an item at the undefined place 12");
}

static void test_category_and_size_of_data_blocks_are_read(void **state)
{
    const uint8_t block[] = {48, 0, 6, 1, 2, 3, 99};
    struct asterix_block read;
    struct asterix_error error = {.reason = ""};

    (void)state;
    assert_true(asterix_block_read(block, sizeof block, &read, &error));
    assert_int_equal(read.category, 48);
    assert_ptr_equal(read.records, block + 3);
    assert_int_equal(read.size, 3);
    assert_false(asterix_block_read(block, 5, &read, &error));
    assert_string_equal(error.reason,
                        "a data block of category 48 has 6 bytes, but only 5 are left");
    assert_false(asterix_block_read(block, 2, &read, &error));
    assert_string_equal(error.reason, "a data block has at least 3 bytes, but only 2 are left");
    assert_false(asterix_block_read((const uint8_t[]){62, 0, 2}, 3, &read, &error));
    assert_string_equal(error.reason,
                        "a data block of category 62 has an invalid length of 2 bytes");
    assert_int_equal(error.at, 1);
}

static void test_sensor_id_of_sac_and_sic(void **state)
{
    (void)state;
    assert_int_equal(asterix_sensor_id(&(struct asterix_source){true, 0, 1}), 1);
    assert_int_equal(asterix_sensor_id(&(struct asterix_source){true, 25, 201}), 6601);
    assert_int_equal(asterix_sensor_id(&(struct asterix_source){true, 127, 255}), 32767);
    assert_int_equal(asterix_sensor_id(&(struct asterix_source){true, 128, 0}), -32768);
    assert_int_equal(asterix_sensor_id(&(struct asterix_source){true, 255, 255}), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cat048_plots),
        cmocka_unit_test(test_cat034_service_messages),
        cmocka_unit_test(test_cat001_plots),
        cmocka_unit_test(test_cat002_service_messages),
        cmocka_unit_test(test_items_in_random_field_sequence),
        cmocka_unit_test(test_cat062_tracks_are_read),
        cmocka_unit_test(test_cat062_tracks_are_written),
        cmocka_unit_test(test_values_beyond_an_item_become_its_largest),
        cmocka_unit_test(test_bad_records_are_refused_with_reason),
        cmocka_unit_test(test_category_and_size_of_data_blocks_are_read),
        cmocka_unit_test(test_sensor_id_of_sac_and_sic),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
