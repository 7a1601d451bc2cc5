/* SPDX-License-Identifier: MIT */
/*
 * Snapshots: after loading one taken at any step, all further reports have the same bytes; invalid
 * images are refused and change nothing.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "random_draws.h"
#include "rhotrack/initiator.h"
#include "rhotrack/passive.h"
#include "rhotrack/snapshot.h"
#include "rhotrack/tracker.h"
#include "step_looks.h"

#define PI 3.14159265358979323846
#define EVENTS_MAX 96
#define PLOTS_MAX 80
#define TARGETS 4
#define PASSIVE_SENSORS 2
#define BEARINGS_MAX 6

struct pipeline {
    struct rho_tracker tracker;
    struct rho_initiator initiators[2]; /* of sensors 0 and 1 */
    struct rho_passive passive;
};

/* A scan of plots, or a frame of bearings. */
struct event {
    int is_frame;
    struct rho_scan scan;
    struct rho_plot plots[PLOTS_MAX];
    struct rho_frame frame;
    struct rho_bearing_scan looks[PASSIVE_SENSORS];
    struct rho_bearing bearings[PASSIVE_SENSORS][BEARINGS_MAX];
};

static struct event events[EVENTS_MAX];
static int num_events;
static uint64_t hashes[EVENTS_MAX]; /* hashes of the reports of a run without snapshots */
static struct pipeline chain, other;
static struct rho_report report;
static uint8_t *image;
static size_t image_bytes;

/*
 * ---- scenes -----------------------------------------------------------------------------------
 */

static double target_coordinate_at_m(int target, double t_s, int axis)
{
    const double from_m[TARGETS][2] = {{-12e3, 9e3}, {9e3, 12e3}, {2e3, 14e3}, {-9e3, 16e3}};
    const double speed_mps[TARGETS][2] = {{180, 40}, {-150, 20}, {60, -90}, {30, 160}};
    /* all targets accelerate from 40 s on */
    const double bent_mps2 = t_s > 40.0 && axis == 1 ? -2.0 : 0.0;
    return from_m[target][axis] + speed_mps[target][axis] * t_s +
           0.5 * bent_mps2 * (t_s - 40.0) * (t_s - 40.0);
}

static struct rho_plot *add_plot(struct event *event, double x_m, double y_m)
{
    struct rho_plot *plot = &event->plots[event->scan.num_plots++];
    assert_true(event->scan.num_plots <= PLOTS_MAX);
    *plot = (struct rho_plot){
        .x_m = (float)x_m, .y_m = (float)y_m, .sigma_range_m = 25.0f, .sigma_cross_m = 60.0f};
    return plot;
}

static struct event *add_event(double t_s)
{
    struct event *event = &events[num_events++];
    assert_true(num_events <= EVENTS_MAX);
    memset(event, 0, sizeof *event);
    event->scan.time_us = event->frame.time_us = (int64_t)(t_s * 1e6);
    return event;
}

static int is_in_sector(double x_m, double y_m, double from_rad, double to_rad)
{
    const double azimuth_rad = atan2(y_m, x_m);
    return azimuth_rad >= from_rad && azimuth_rad < to_rad;
}

/* Adds a radar's scan of a sector: targets, of which one in ten is missed, and clutter. */
static void add_scan(double t_s, int32_t sensor_id, double from_rad, double to_rad, int clutter)
{
    struct event *event = add_event(t_s);
    const int is_whole = to_rad - from_rad > 6.0;
    event->scan.sensor_id = sensor_id;
    event->scan.sector_from_rad = is_whole ? 0.0f : (float)from_rad;
    event->scan.sector_to_rad = is_whole ? 0.0f : (float)to_rad;
    for (int target = 0; target < TARGETS; target++) {
        const int32_t offset_us = (int32_t)uniform(0.0, 1e5);
        const double own_s = t_s + offset_us * 1e-6;
        double x_m = target_coordinate_at_m(target, own_s, 0),
               y_m = target_coordinate_at_m(target, own_s, 1);
        const int is_seen = uniform(0.0, 1.0) < 0.9;
        x_m += 25.0 * normal();
        y_m += 25.0 * normal();
        if (is_seen && is_in_sector(x_m, y_m, from_rad, to_rad)) {
            add_plot(event, x_m, y_m)->offset_us = offset_us;
        }
    }
    for (int i = 0; i < clutter; i++) {
        const double azimuth_rad = uniform(from_rad, to_rad), range_m = uniform(1e3, 25e3);
        add_plot(event, range_m * cos(azimuth_rad), range_m * sin(azimuth_rad));
    }
}

static void add_frame(double t_s)
{
    struct event *event = add_event(t_s);
    event->is_frame = 1;
    for (int sensor = 0; sensor < PASSIVE_SENSORS; sensor++) {
        struct rho_bearing_scan *look = &event->looks[event->frame.num_scans++];
        *look = (struct rho_bearing_scan){.time_us = event->frame.time_us,
                                          .sensor_id = 10 + sensor,
                                          .x_m = sensor ? 8e3f : -8e3f,
                                          .z_m = sensor ? 40.0f : 0.0f};
        for (int target = 0; target < TARGETS; target++) {
            const double bearing_rad = atan2(target_coordinate_at_m(target, t_s, 1),
                                             target_coordinate_at_m(target, t_s, 0) - look->x_m);
            if (uniform(0.0, 1.0) < 0.9) {
                event->bearings[sensor][look->num_bearings++] = (struct rho_bearing){
                    .bearing_rad = (float)(bearing_rad + 0.002 * normal()),
                    .sigma_rad = 0.002f,
                    /* of one sensor, constant: the draws stay those of scenes without */
                    .elevation_rad = 0.02f + 0.01f * (float)target,
                    .sigma_elevation_rad = sensor ? 0.01f : 0.0f};
            }
        }
    }
}

enum scene { CLUTTER, SECTORS, BEARINGS, MIXED };

static void draw_scene(enum scene scene)
{
    num_events = 0;
    random_state = 11;
    for (int k = 0; k < 24; k++) {
        if (scene == CLUTTER) {
            add_scan(3.0 * k, 0, -PI, PI, 40);
        } else if (scene == SECTORS && k < 12) {
            for (int sector = 0; sector < 8; sector++) {
                add_scan(4.0 * k + 0.5 * sector, 0, -PI + sector * PI / 4,
                         -PI + (sector + 1) * PI / 4, 5);
            }
        } else if (scene == BEARINGS) {
            add_frame(5.0 * k);
        } else if (scene == MIXED) {
            add_scan(3.0 * k, k % 2, -PI, PI, 20);
            if (k % 3 == 2) {
                add_frame(3.0 * k + 1.0);
            }
        }
    }
}

/*
 * ---- pipelines --------------------------------------------------------------------------------
 */

static void init_pipeline(uint8_t gate, int is_input_estimated)
{
    struct rho_tracker_config maintain;
    struct rho_initiator_config start;
    struct rho_passive_config passive;
    struct rho_sensor radar = {
        .sensor_id = 1, .x_m = 100.0f, .pd = 0.85f, .range_max_m = 40e3f, .range_bias_m = 3.0f};
    memset(&chain, 0, sizeof chain);
    memset(&maintain, 0, sizeof maintain);
    memset(&start, 0, sizeof start);
    rho_tracker_config_default(&maintain);
    rho_initiator_config_default(&start);
    rho_passive_config_default(&passive);
    maintain.gate = gate;
    maintain.input.is_estimated = (uint16_t)is_input_estimated;
    maintain.v_max_mps = start.v_max_mps = 400.0f;
    maintain.accel_max_mps2 = 10.0f;
    assert_int_equal(rho_tracker_init(&chain.tracker, sizeof chain.tracker, &maintain), RHO_OK);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(
            rho_initiator_init(&chain.initiators[i], sizeof chain.initiators[i], &start), RHO_OK);
    }
    assert_int_equal(rho_passive_init(&chain.passive, sizeof chain.passive, &passive), RHO_OK);
    assert_int_equal(rho_tracker_set_sensor(&chain.tracker, &radar), RHO_OK);
}

static void step_pipeline(struct pipeline *at, const struct event *drawn)
{
    struct event event = *drawn;
    memset(&report, 0xa5, sizeof report);
    event.scan.plots = event.plots;
    event.frame.scans = event.looks;
    for (int sensor = 0; sensor < PASSIVE_SENSORS; sensor++) {
        event.looks[sensor].bearings = event.bearings[sensor];
    }
    assert_int_equal(event.is_frame
                         ? step_looks(&at->tracker, &at->passive, NULL, &event.frame, &report)
                         : rho_tracker_step(&at->tracker, &at->initiators[event.scan.sensor_id],
                                            &event.scan, &report),
                     RHO_OK);
}

/* FNV-1a hash of bytes, continued from `hash`. */
static uint64_t hash_bytes(const void *data, size_t size, uint64_t hash)
{
    const uint8_t *bytes = data;
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ bytes[i]) * UINT64_C(1099511628211);
    }
    return hash;
}

static uint64_t hash_report(void)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    hash = hash_bytes(&report.time_us, sizeof report.time_us, hash);
    hash = hash_bytes(report.fates_total, sizeof report.fates_total, hash);
    hash = hash_bytes(report.fates, report.num_plots, hash);
    hash = hash_bytes(report.ended, report.num_ended * sizeof report.ended[0], hash);
    return hash_bytes(report.tracks, report.num_tracks * sizeof report.tracks[0], hash);
}

static unsigned snapshot_parts_of(struct pipeline *at, struct rho_snapshot_part parts[4])
{
    parts[0] =
        (struct rho_snapshot_part){RHO_SNAPSHOT_TRACKER, 0, &at->tracker, sizeof at->tracker};
    parts[1] = (struct rho_snapshot_part){RHO_SNAPSHOT_INITIATOR, 0, &at->initiators[0],
                                          sizeof at->initiators[0]};
    parts[2] = (struct rho_snapshot_part){RHO_SNAPSHOT_INITIATOR, 1, &at->initiators[1],
                                          sizeof at->initiators[1]};
    parts[3] =
        (struct rho_snapshot_part){RHO_SNAPSHOT_PASSIVE, -7, &at->passive, sizeof at->passive};
    return 4;
}

static void save_image(struct pipeline *at)
{
    struct rho_snapshot_part parts[4];
    const unsigned num_parts = snapshot_parts_of(at, parts);
    size_t length = 0;
    image_bytes = rho_snapshot_size(parts, num_parts);
    assert_true(image_bytes > 0);
    image = image ? image : malloc(image_bytes);
    assert_non_null(image);
    memset(image, 0xa5, image_bytes);
    assert_int_equal(rho_snapshot_save(parts, num_parts, 0, image, image_bytes, &length), RHO_OK);
    assert_int_equal(length, image_bytes);
}

static enum rho_status load_image(struct pipeline *at, size_t size)
{
    struct rho_snapshot_part parts[4];
    return rho_snapshot_load(parts, snapshot_parts_of(at, parts), image, size);
}

/*
 * ---- further steps after loading --------------------------------------------------------------
 */

static void compare_run_from_snapshots(enum scene scene, uint8_t gate, int is_input_estimated)
{
    unsigned confirmed = 0;
    draw_scene(scene);
    init_pipeline(gate, is_input_estimated);
    for (int k = 0; k < num_events; k++) {
        step_pipeline(&chain, &events[k]);
        hashes[k] = hash_report();
        confirmed += report.num_tracks > 0 && report.tracks[0].status == RHO_TRACK_CONFIRMED;
    }
    assert_true(confirmed > 3);
    /* large objects are compared after some steps only, to save time */
    const int stride = RHO_MAX_PLOTS > 1000 ? (num_events > 40 ? 13 : 5) : 1;
    init_pipeline(gate, is_input_estimated);
    for (int k = 0; k <= num_events; k++) {
        if (k % stride == 0 || k == num_events) {
            save_image(&chain);
            memset(&other, 0xc3, sizeof other);
            assert_int_equal(load_image(&other, image_bytes), RHO_OK);
            assert_memory_equal(&other.tracker, &chain.tracker, sizeof other.tracker);
            assert_memory_equal(&other.initiators, &chain.initiators, sizeof other.initiators);
            assert_memory_equal(&other.passive, &chain.passive, sizeof other.passive);
            for (int after = k; after < num_events; after++) {
                step_pipeline(&other, &events[after]);
                assert_true(hash_report() == hashes[after]);
            }
        }
        if (k < num_events) {
            step_pipeline(&chain, &events[k]);
        }
    }
    assert_memory_equal(&other.tracker, &chain.tracker, sizeof other.tracker);
}

static void test_a_radar_in_clutter_continues_identically(void **state)
{
    (void)state;
    compare_run_from_snapshots(CLUTTER, RHO_TRACKER_BEST, 0);
}

static void test_sectors_continue_identically(void **state)
{
    (void)state;
    compare_run_from_snapshots(SECTORS, RHO_TRACKER_BEST, 0);
}

static void test_bearings_continue_identically(void **state)
{
    (void)state;
    compare_run_from_snapshots(BEARINGS, RHO_TRACKER_BEST, 0);
}

static void test_two_radars_and_bearings_continue_identically(void **state)
{
    (void)state;
    compare_run_from_snapshots(MIXED, RHO_TRACKER_BEST, 0);
}

static void test_single_filter_gates_continue_identically(void **state)
{
    (void)state;
    compare_run_from_snapshots(MIXED, RHO_TRACKER_NEAREST, 0);
    compare_run_from_snapshots(CLUTTER, RHO_TRACKER_HOUGH, 1);
}

/*
 * ---- images in pieces -------------------------------------------------------------------------
 */

static void make_image(void)
{
    draw_scene(MIXED);
    init_pipeline(RHO_TRACKER_BEST, 0);
    for (int k = 0; k < 20; k++) {
        step_pipeline(&chain, &events[k]);
    }
    save_image(&chain);
}

static void test_an_image_saved_in_pieces_is_the_same(void **state)
{
    const size_t sizes[] = {1, 7, 64, 256, 4096, 65536};
    struct rho_snapshot_part parts[4];
    uint8_t page[65536];
    (void)state;
    make_image();
    const unsigned num_parts = snapshot_parts_of(&chain, parts);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        /* with small pages the last 500 bytes alone, to save time */
        size_t length, at = sizes[i] < 256 ? image_bytes - 500 : 0;
        do {
            assert_int_equal(rho_snapshot_save(parts, num_parts, at, page, sizes[i], &length),
                             RHO_OK);
            assert_memory_equal(page, image + at, length);
            at += length;
            assert_true(length == sizes[i] || at == image_bytes);
        } while (length > 0);
        assert_int_equal(at, image_bytes);
    }
}

/* Loads the image in pieces of `size` bytes; returns the status of the last one. */
static enum rho_status load_in_pieces(struct rho_snapshot_loader *loader, size_t size)
{
    enum rho_status status = RHO_OK;
    for (unsigned pass = 0; pass < RHO_SNAPSHOT_PASSES; pass++) {
        for (size_t at = 0; at < image_bytes && status == RHO_OK; at += size) {
            const size_t left = image_bytes - at;
            status = rho_snapshot_take(loader, image + at, left < size ? left : size);
        }
    }
    return status;
}

static void test_an_image_is_loaded_in_pieces(void **state)
{
    const size_t sizes[] = {13, 24, 64, 1000, 65536, 100000000};
    struct rho_snapshot_loader loader;
    struct rho_snapshot_part parts[4];
    (void)state;
    make_image();
    const unsigned num_parts = snapshot_parts_of(&other, parts);
    for (size_t i = RHO_MAX_PLOTS > 1000 ? 4 : 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        memset(&other, 0x3c, sizeof other);
        assert_int_equal(rho_snapshot_begin(&loader, parts, num_parts), RHO_OK);
        assert_int_equal(load_in_pieces(&loader, sizes[i]), RHO_OK);
        assert_int_equal(loader.passes, RHO_SNAPSHOT_PASSES);
        assert_memory_equal(&other.tracker, &chain.tracker, sizeof other.tracker);
        assert_memory_equal(&other.initiators, &chain.initiators, sizeof other.initiators);
        assert_memory_equal(&other.passive, &chain.passive, sizeof other.passive);
        assert_int_equal(rho_snapshot_take(&loader, image, 1), RHO_ERROR_STATE);
    }
}

/* True if `other` still has the bytes 0x3c everywhere. */
static int is_other_unchanged(void)
{
    const uint8_t *bytes = (const uint8_t *)&other;
    return bytes[0] == 0x3c && memcmp(bytes, bytes + 1, sizeof other - 1) == 0;
}

static void assert_pieces_refused(size_t at, enum rho_status expected)
{
    struct rho_snapshot_loader loader;
    struct rho_snapshot_part parts[4];
    const unsigned num_parts = snapshot_parts_of(&other, parts);
    image[at] ^= 4u;
    memset(&other, 0x3c, sizeof other);
    assert_int_equal(rho_snapshot_begin(&loader, parts, num_parts), RHO_OK);
    assert_int_equal(load_in_pieces(&loader, 4096), expected);
    assert_true(loader.passes > RHO_SNAPSHOT_PASSES);
    assert_true(is_other_unchanged());
    assert_int_equal(rho_snapshot_take(&loader, image, 1), RHO_ERROR_STATE);
    image[at] ^= 4u;
}

static void test_damaged_images_in_pieces_are_refused(void **state)
{
    struct rho_snapshot_loader loader;
    struct rho_snapshot_part parts[4];
    (void)state;
    make_image();
    assert_pieces_refused(3, RHO_ERROR_TYPE);
    assert_pieces_refused(8, RHO_ERROR_TYPE);
    assert_pieces_refused(15, RHO_ERROR_SIZE);
    assert_pieces_refused(16, RHO_ERROR_COUNT);
    assert_pieces_refused(24 + 2 * 16 + 4, RHO_ERROR_COUNT); /* the id of a part */
    assert_pieces_refused(5000, RHO_ERROR_VALUE);
    assert_pieces_refused(image_bytes - 1, RHO_ERROR_VALUE);
    /* an image without its last byte is never loaded */
    const unsigned num_parts = snapshot_parts_of(&other, parts);
    assert_int_equal(rho_snapshot_begin(&loader, parts, num_parts), RHO_OK);
    assert_int_equal(rho_snapshot_take(&loader, image, image_bytes - 1), RHO_OK);
    assert_int_equal(loader.passes, 0);
    assert_int_equal(rho_snapshot_take(&loader, NULL, 1), RHO_ERROR_NULL);
    assert_int_equal(rho_snapshot_begin(NULL, parts, num_parts), RHO_ERROR_NULL);
    /* bytes that changed between the two passes leave no valid object */
    assert_int_equal(rho_snapshot_take(&loader, image + image_bytes - 1, 1), RHO_OK);
    assert_int_equal(loader.passes, 1);
    image[5000] ^= 4u;
    assert_int_equal(rho_snapshot_take(&loader, image, image_bytes), RHO_ERROR_VALUE);
    assert_int_equal(other.tracker.magic, 0);
    assert_false(rho_initiator_is_sound(&other.initiators[1]));
}

static void test_a_step_between_saved_pieces_makes_the_image_invalid(void **state)
{
    struct rho_snapshot_part parts[4];
    size_t length, rest;
    (void)state;
    make_image();
    const unsigned num_parts = snapshot_parts_of(&chain, parts);
    assert_int_equal(rho_snapshot_save(parts, num_parts, 0, image, image_bytes / 2, &length),
                     RHO_OK);
    step_pipeline(&chain, &events[20]);
    assert_int_equal(
        rho_snapshot_save(parts, num_parts, length, image + length, image_bytes - length, &rest),
        RHO_OK);
    assert_int_equal(length + rest, image_bytes);
    assert_int_equal(load_image(&other, image_bytes), RHO_ERROR_VALUE);
}

static void test_the_parts_of_an_image_are_listed(void **state)
{
    struct rho_snapshot_part parts[3], none;
    unsigned num_parts = 0;
    (void)state;
    make_image();
    memset(&none, 0, sizeof none);
    memset(parts, 0, sizeof parts);
    assert_int_equal(rho_snapshot_list(image, image_bytes, &none, 0, &num_parts), RHO_OK);
    assert_int_equal(num_parts, 4);
    assert_int_equal(rho_snapshot_list(image, image_bytes, parts, 3, &num_parts), RHO_OK);
    assert_int_equal(num_parts, 4);
    assert_int_equal(parts[0].kind, RHO_SNAPSHOT_TRACKER);
    assert_int_equal(parts[2].kind, RHO_SNAPSHOT_INITIATOR);
    assert_int_equal(parts[2].id, 1);
    assert_int_equal(parts[2].size, sizeof(struct rho_initiator));
    assert_int_equal(rho_snapshot_offset(parts, 4, 0), 24 + 4 * 16);
    assert_memory_equal(image + rho_snapshot_offset(parts, 4, 2), &chain.initiators[1],
                        sizeof chain.initiators[1]);
    assert_int_equal(rho_snapshot_list(image, image_bytes, parts, 3, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_snapshot_list(image, image_bytes - 1, parts, 3, &num_parts),
                     RHO_ERROR_SHORT);
}

/*
 * ---- refused images ---------------------------------------------------------------------------
 */

/* Expects the image refused and `other`, filled with 0x3c, unchanged. */
static void assert_image_refused(size_t size, enum rho_status expected)
{
    memset(&other, 0x3c, sizeof other);
    assert_int_equal(load_image(&other, size), expected);
    assert_true(is_other_unchanged());
}

/* CRC-32 by the definition in the standard, bit by bit for each table entry. */
static uint32_t reference_crc_32(const uint8_t *bytes, size_t size)
{
    static uint32_t table[256];
    uint32_t crc = UINT32_MAX;
    for (uint32_t byte = 0; table[255] == 0 && byte < 256; byte++) {
        table[byte] = byte;
        for (int bit = 0; bit < 8; bit++) {
            table[byte] = table[byte] & 1u ? table[byte] >> 1 ^ 0xedb88320u : table[byte] >> 1;
        }
    }
    for (size_t i = 0; i < size; i++) {
        crc = crc >> 8 ^ table[(crc ^ bytes[i]) & 255u];
    }
    return ~crc;
}

static void write_checksum(void)
{
    const uint32_t crc = reference_crc_32(image, image_bytes - 4);
    for (int i = 0; i < 4; i++) {
        image[image_bytes - 4 + (size_t)i] = (uint8_t)(crc >> 8 * i);
    }
}

static void test_checksum_is_crc_32(void **state)
{
    static const uint8_t digits[] = "123456789";
    uint8_t last[4];
    (void)state;
    assert_true(reference_crc_32(digits, 9) == 0xcbf43926u);
    make_image();
    memcpy(last, image + image_bytes - 4, 4);
    write_checksum();
    assert_memory_equal(last, image + image_bytes - 4, 4);
}

static void test_one_wrong_bit_is_refused(void **state)
{
    (void)state;
    make_image();
    /* the header, the end, and some bytes between; fewer for large objects */
    const int is_big = RHO_MAX_PLOTS > 1000;
    const size_t stride = (image_bytes - 200) / (is_big ? 12 : 1500), fine = is_big ? 9 : 1;
    for (size_t at = 0; at < image_bytes;) {
        const uint8_t was = image[at];
        image[at] = (uint8_t)(was ^ 1u << at % 8);
        memset(&other.tracker, 0x3c, 64);
        assert_int_not_equal(load_image(&other, image_bytes), RHO_OK);
        assert_int_equal(((const uint8_t *)&other.tracker)[9], 0x3c);
        image[at] = was;
        const size_t next = at + (at < 100 || at >= image_bytes - 20 ? fine : stride);
        at = at < image_bytes - 20 && next > image_bytes - 20 ? image_bytes - 20 : next;
    }
    assert_int_equal(load_image(&other, image_bytes), RHO_OK);
}

static void test_cut_or_foreign_images_are_refused(void **state)
{
    (void)state;
    make_image();
    assert_image_refused(image_bytes - 1, RHO_ERROR_SHORT);
    assert_image_refused(31, RHO_ERROR_SHORT);
    assert_image_refused(0, RHO_ERROR_SHORT);
    image[0] ^= 1u;
    assert_image_refused(image_bytes, RHO_ERROR_TYPE);
    image[0] ^= 1u;
    image[8]++; /* version */
    write_checksum();
    assert_image_refused(image_bytes, RHO_ERROR_TYPE);
    image[8]--;
    image[12] ^= 0x80u; /* layout */
    write_checksum();
    assert_image_refused(image_bytes, RHO_ERROR_SIZE);
    image[12] ^= 0x80u;
    write_checksum();
    image[image_bytes - 1] ^= 1u;
    assert_image_refused(image_bytes, RHO_ERROR_VALUE);
    image[image_bytes - 1] ^= 1u;
    image[20]++; /* a wrong number of parts */
    write_checksum();
    assert_image_refused(image_bytes, RHO_ERROR_VALUE);
    image[20]--;
    write_checksum();
    assert_int_equal(load_image(&other, image_bytes), RHO_OK);
    /* bytes after the image are ignored */
    image = realloc(image, image_bytes + 100);
    assert_non_null(image);
    assert_int_equal(load_image(&other, image_bytes + 100), RHO_OK);
}

static void test_parts_that_differ_from_the_image_are_refused(void **state)
{
    struct rho_snapshot_part parts[4];
    uint8_t small[8];
    size_t length;
    (void)state;
    make_image();
    (void)snapshot_parts_of(&other, parts);
    assert_int_equal(rho_snapshot_load(parts, 3, image, image_bytes), RHO_ERROR_COUNT);
    parts[2].id = 2;
    assert_int_equal(rho_snapshot_load(parts, 4, image, image_bytes), RHO_ERROR_COUNT);
    parts[2].id = 1;
    parts[0].size--;
    assert_int_equal(rho_snapshot_load(parts, 4, image, image_bytes), RHO_ERROR_SIZE);
    assert_int_equal(rho_snapshot_save(parts, 4, 0, small, sizeof small, &length), RHO_ERROR_SIZE);
    assert_int_equal(rho_snapshot_size(parts, 4), 0);
    parts[0].size++;
    parts[0].kind = (enum rho_snapshot_kind)9;
    assert_int_equal(rho_snapshot_load(parts, 4, image, image_bytes), RHO_ERROR_VALUE);
    parts[0].kind = RHO_SNAPSHOT_TRACKER;
    parts[3].object = NULL;
    assert_int_equal(rho_snapshot_load(parts, 4, image, image_bytes), RHO_ERROR_NULL);
    assert_int_equal(rho_snapshot_load(NULL, 4, image, image_bytes), RHO_ERROR_NULL);
    assert_int_equal(load_image(&other, image_bytes), RHO_OK);
    (void)snapshot_parts_of(&other, parts);
    assert_int_equal(rho_snapshot_load(parts, 4, NULL, image_bytes), RHO_ERROR_NULL);
    assert_int_equal(rho_snapshot_load(parts, 4, image + 1, image_bytes - 1), RHO_ERROR_VALUE);
    assert_int_equal(rho_snapshot_save(parts, 4, 0, NULL, 9, &length), RHO_ERROR_NULL);
    assert_int_equal(rho_snapshot_save(parts, 4, 0, small, 8, NULL), RHO_ERROR_NULL);
    memset(&other.passive, 0, sizeof other.passive);
    assert_int_equal(rho_snapshot_save(parts, 4, 0, small, sizeof small, &length), RHO_ERROR_STATE);
}

/* Address in the image of a field of the object that is this part. */
static uint8_t *field_in_image(unsigned part, size_t field)
{
    struct rho_snapshot_part parts[4];
    size_t at = 24 + 4 * 16;
    (void)snapshot_parts_of(&chain, parts);
    for (unsigned i = 0; i < part; i++) {
        at += (parts[i].size + 7) / 8 * 8;
    }
    return image + at + field;
}

/* Expects an image refused in which one field is invalid and the checksum right. */
static void assert_invalid_field_refused(unsigned part, size_t field, const void *value,
                                         size_t size)
{
    static unsigned count;
    uint8_t was[16];
    uint8_t *bytes = field_in_image(part, field);
    if (RHO_MAX_PLOTS > 1000 && count++ % 6 != 0) {
        return; /* large objects take long: all fields are tested in the other profile */
    }
    memcpy(was, bytes, size);
    memcpy(bytes, value, size);
    write_checksum();
    assert_image_refused(image_bytes, RHO_ERROR_VALUE);
    if (RHO_MAX_PLOTS < 1000) { /* in pieces an invalid object is found once it is loaded */
        struct rho_snapshot_loader loader;
        struct rho_snapshot_part parts[4];
        const unsigned num_parts = snapshot_parts_of(&other, parts);
        assert_int_equal(rho_snapshot_begin(&loader, parts, num_parts), RHO_OK);
        assert_int_equal(load_in_pieces(&loader, 65536), RHO_ERROR_VALUE);
        assert_int_equal(other.tracker.magic, 0);
    }
    memcpy(bytes, was, size);
    write_checksum();
}

#define NONSENSE(part, type, field, ctype, value)                                                  \
    do {                                                                                           \
        const ctype wrong = (value);                                                               \
        assert_invalid_field_refused(part, offsetof(struct type, field), &wrong, sizeof wrong);    \
    } while (0)

static void test_invalid_elevations_are_refused(void)
{
    NONSENSE(3, rho_passive, batch.bearings[0][1][0].slope, float, NAN);
    NONSENSE(3, rho_passive, batch.bearings[0][1][0].slope, float, 1e30f);
    NONSENSE(3, rho_passive, batch.bearings[0][1][0].slope, float, -11.0f);
    NONSENSE(3, rho_passive, batch.bearings[0][1][0].sigma_slope, float, NAN);
    NONSENSE(3, rho_passive, batch.bearings[0][1][0].sigma_slope, float, INFINITY);
    NONSENSE(3, rho_passive, batch.bearings[0][1][0].sigma_slope, float, 101.0f);
    NONSENSE(3, rho_passive, batch.bearings[0][1][0].sigma_slope, float, -1e-6f);
    NONSENSE(3, rho_passive, batch.looks[0][1].z_m, float, NAN);
    NONSENSE(3, rho_passive, batch.looks[0][1].z_m, float, 2.1e6f);
}

static void test_invalid_fields_with_a_right_checksum_are_refused(void **state)
{
    const float nan = NAN;
    (void)state;
    make_image();
    assert_true(chain.tracker.num_tracks > 1);
    NONSENSE(0, rho_tracker, magic, uint32_t, 1);
    NONSENSE(0, rho_tracker, num_tracks, uint16_t, RHO_MAX_TRACKS + 1);
    NONSENSE(0, rho_tracker, num_tracks, uint16_t, UINT16_MAX);
    NONSENSE(0, rho_tracker, num_sensors, uint16_t, RHO_MAX_SENSORS + 1);
    NONSENSE(0, rho_tracker, num_rows, uint16_t, RHO_MAX_SENSORS + 1);
    NONSENSE(0, rho_tracker, sensors[0].pace.interval_s, float, nan);
    NONSENSE(0, rho_tracker, tracks[0].seen_us, int64_t, INT64_MAX);
    NONSENSE(0, rho_tracker, time_us, int64_t, INT64_MIN);
    NONSENSE(0, rho_tracker, config.gate, uint8_t, RHO_NUM_TRACKER_GATES);
    NONSENSE(0, rho_tracker, config.v_max_mps, float, -1.0f);
    NONSENSE(0, rho_tracker, assignment.magic, uint32_t, 0);
    NONSENSE(0, rho_tracker, extent.x_max_m, float, nan);
    NONSENSE(0, rho_tracker, sensors[0].sensor.pd, float, 2.0f);
    NONSENSE(0, rho_tracker, sensors[0].learned.log_noise[1], float, nan);
    NONSENSE(0, rho_tracker, sensors[0].learned.innovations, uint16_t, 1001);
    NONSENSE(0, rho_tracker, sensors[0].looks, float, nan);
    NONSENSE(0, rho_tracker, sensors[0].hits, float, 1e8f);
    NONSENSE(0, rho_tracker, sensors[0].places[5].hits, float, -1.0f);
    NONSENSE(0, rho_tracker, sensors[0].places[0].looks, float, nan);
    NONSENSE(0, rho_tracker, sensors[0].places[RHO_PD_PLACES - 1].excess, float, -1.5f);
    NONSENSE(0, rho_tracker, config.learn_noise_min, float, 0.0f);
    NONSENSE(0, rho_tracker, config.learn_noise_max, float, nan);
    NONSENSE(0, rho_tracker, config.learn_pd_min, float, 1.5f);
    NONSENSE(0, rho_tracker, tracks[1].slot, uint16_t, RHO_HYPOTHESES_SLOTS);
    NONSENSE(0, rho_tracker, tracks[1].slot, uint16_t, chain.tracker.tracks[0].slot);
    NONSENSE(0, rho_tracker, tracks[0].filter, uint8_t, RHO_TRACK_INPUT);
    NONSENSE(0, rho_tracker, tracks[0].status, uint8_t, 77);
    NONSENSE(0, rho_tracker, tracks[0].kalman.state[2], float, nan);
    NONSENSE(0, rho_tracker, hypotheses.magic, uint32_t, 0);
    NONSENSE(0, rho_tracker, hypotheses.num_free, uint16_t, UINT16_MAX);
    NONSENSE(0, rho_tracker, hypotheses.num_free, uint16_t,
             (uint16_t)(chain.tracker.hypotheses.num_free - 1));
    NONSENSE(0, rho_tracker, hypotheses.spare[0], uint16_t, RHO_MAX_HYPOTHESES);
    NONSENSE(0, rho_tracker, hypotheses.spare[0], uint16_t, chain.tracker.hypotheses.spare[1]);
    NONSENSE(0, rho_tracker, hypotheses.num_of[0], uint8_t, 200);
    NONSENSE(0, rho_tracker, hypotheses.model.memory_s, float, nan);
    NONSENSE(0, rho_tracker, hypotheses.step.calm_begins, float, 2.0f);
    NONSENSE(0, rho_tracker, hypotheses.step.quiet_density, float, nan);
    NONSENSE(0, rho_tracker, seldom, float, nan);
    NONSENSE(0, rho_tracker, established, float, -1.0f);
    NONSENSE(0, rho_tracker, straight_s, float, nan);
    NONSENSE(0, rho_tracker, turning_s, float, -1.0f);
    NONSENSE(0, rho_tracker, wanted_per_hour, float, nan);
    NONSENSE(0, rho_tracker, counted_us, int64_t, INT64_MAX);
#if RHO_MAX_ECHOES > 0
    unsigned echo = 0;
    while (chain.tracker.clutter_map.echoes[echo].hits == 0) {
        assert_true(++echo < RHO_MAX_ECHOES);
    }
    const struct rho_echo *kept = &chain.tracker.clutter_map.echoes[echo];
    const size_t in_tracker = (size_t)((const uint8_t *)kept - (const uint8_t *)&chain.tracker);
    const uint8_t region = RHO_ECHO_TABLES;
    assert_invalid_field_refused(0, in_tracker + offsetof(struct rho_echo, region), &region, 1);
    assert_invalid_field_refused(0, in_tracker + offsetof(struct rho_echo, along), &nan,
                                 sizeof nan);
    NONSENSE(0, rho_tracker, clutter_map.tables[0][1].looks[0][0], float, nan);
    NONSENSE(0, rho_tracker, clutter_map.exact_plots, float,
             chain.tracker.clutter_map.rate_plots + 1.0f);
#endif
    NONSENSE(1, rho_initiator, magic, uint32_t, 0);
    NONSENSE(1, rho_initiator, config.scans, uint16_t, RHO_MAX_SCANS + 1);
    NONSENSE(1, rho_initiator, num_candidates, uint16_t, RHO_MAX_CANDIDATES + 1);
    NONSENSE(1, rho_initiator, num_maps, uint16_t, RHO_MAX_DENSITY_MAPS + 1);
    NONSENSE(1, rho_initiator, density[0].columns, uint8_t, RHO_MAX_DENSITY_CELLS + 1);
    NONSENSE(1, rho_initiator, density[0].rows, uint8_t, 0);
    NONSENSE(1, rho_initiator, density[0].scans, float, 0.0f);
    NONSENSE(1, rho_initiator, density[0].mean, float, -1.0f);
    NONSENSE(1, rho_initiator, config.work_max, uint32_t, UINT32_MAX);
    NONSENSE(1, rho_initiator, config.turn_mps2, float, -1.0f);
    NONSENSE(1, rho_initiator, budget.resume.cost_class, uint16_t, RHO_INITIATOR_CLASSES);
    NONSENSE(1, rho_initiator, budget.resume.plot, uint16_t, RHO_MAX_PLOTS);
    NONSENSE(1, rho_initiator, window.magic, uint32_t, 0);
    NONSENSE(1, rho_initiator, window.num_scans, uint16_t, RHO_MAX_SCANS + 1);
    NONSENSE(1, rho_initiator, window.first, uint16_t, RHO_MAX_SCANS);
    NONSENSE(1, rho_initiator, window.ring[0].num_plots, uint16_t, RHO_MAX_PLOTS + 1);
    NONSENSE(1, rho_initiator, window.ring[0].bins_x, uint16_t, UINT16_MAX);
    NONSENSE(1, rho_initiator, window.ring[0].bins_y, uint16_t, 0);
    NONSENSE(1, rho_initiator, window.ring[0].bin_start[1], uint16_t, UINT16_MAX);
    NONSENSE(1, rho_initiator, window.ring[0].plots[0].x_m, float, 1.9e6f);
    NONSENSE(1, rho_initiator, window.ring[0].plots[0].y_m, float, nan);
    NONSENSE(1, rho_initiator, window.ring[0].time_us, int64_t, INT64_MAX);
    NONSENSE(3, rho_passive, magic, uint32_t, 0);
    NONSENSE(3, rho_passive, num_tracks, uint16_t, RHO_MAX_PASSIVE_TRACKS + 1);
    NONSENSE(3, rho_passive, config.pd, float, 0.0f);
    NONSENSE(3, rho_passive, batch.num_scans, uint16_t, RHO_MAX_PASSIVE_SCANS + 1);
    NONSENSE(3, rho_passive, batch.num_sensors, uint16_t, RHO_MAX_PASSIVE_SENSORS + 1);
    NONSENSE(3, rho_passive, batch.num_bearings[0][0], uint8_t, RHO_MAX_BEARINGS + 1);
    NONSENSE(3, rho_passive, batch.sensors[1].x_m, float, 3e6f);
    NONSENSE(3, rho_passive, batch.looks[0][1].y_m, float, nan);
    NONSENSE(3, rho_passive, batch.was_seen[0][0], uint8_t, 2);
    NONSENSE(3, rho_passive, batch.time_us[1], int64_t, chain.passive.batch.time_us[0]);
    NONSENSE(3, rho_passive, batch.newest_us, int64_t, INT64_MAX);
    NONSENSE(3, rho_passive, batch.bearings[0][0][0].bearing_rad, float, nan);
    NONSENSE(3, rho_passive, batch.bearings[0][0][0].owner.density_nat, float, nan);
    test_invalid_elevations_are_refused();
    assert_int_equal(load_image(&other, image_bytes), RHO_OK);
}

static void test_objects_without_data_are_saved_and_loaded(void **state)
{
    (void)state;
    init_pipeline(RHO_TRACKER_BEST, 0);
    save_image(&chain);
    memset(&other, 0xc3, sizeof other);
    assert_int_equal(load_image(&other, image_bytes), RHO_OK);
    assert_memory_equal(&other.tracker, &chain.tracker, sizeof other.tracker);
    memset(&chain, 0, sizeof chain);
    assert_false(rho_tracker_is_sound(&chain.tracker));
    assert_false(rho_initiator_is_sound(&chain.initiators[0]));
    assert_false(rho_passive_is_sound(&chain.passive));
    /* an image may have no parts */
    size_t length;
    assert_int_equal(rho_snapshot_save(NULL, 0, 0, image, image_bytes, &length), RHO_OK);
    assert_int_equal(length, rho_snapshot_size(NULL, 0));
    assert_int_equal(rho_snapshot_load(NULL, 0, image, length), RHO_OK);
}

/*
 * An initiator alone may hold plots of rows from RHO_MAX_PLOTS on; once these could not be saved.
 */
static void test_a_held_plot_beyond_the_capacity_row_can_be_saved(void **state)
{
    static struct rho_plot plots[RHO_MAX_PLOTS + 2];
    static uint8_t fates[RHO_MAX_PLOTS + 2];
    const struct rho_scan scan = {.num_plots = RHO_MAX_PLOTS + 2, .plots = plots};
    struct rho_initiator *initiator = &chain.initiators[0];
    uint32_t left_unused = 0;
    (void)state;
    init_pipeline(RHO_TRACKER_BEST, 0);
    memset(fates, RHO_FATE_INVALID, sizeof fates);
    plots[RHO_MAX_PLOTS + 1] =
        (struct rho_plot){.x_m = 5e3f, .sigma_range_m = 20.0f, .sigma_cross_m = 20.0f};
    fates[RHO_MAX_PLOTS + 1] = RHO_FATE_HELD;
    assert_int_equal(rho_initiator_push(initiator, &scan, NULL, fates, &left_unused), RHO_OK);
    assert_int_equal(fates[RHO_MAX_PLOTS + 1], RHO_FATE_HELD);
    assert_true(rho_initiator_is_sound(initiator));
    save_image(&chain);
    assert_int_equal(load_image(&other, image_bytes), RHO_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_radar_in_clutter_continues_identically),
        cmocka_unit_test(test_sectors_continue_identically),
        cmocka_unit_test(test_bearings_continue_identically),
        cmocka_unit_test(test_two_radars_and_bearings_continue_identically),
        cmocka_unit_test(test_single_filter_gates_continue_identically),
        cmocka_unit_test(test_an_image_saved_in_pieces_is_the_same),
        cmocka_unit_test(test_an_image_is_loaded_in_pieces),
        cmocka_unit_test(test_damaged_images_in_pieces_are_refused),
        cmocka_unit_test(test_a_step_between_saved_pieces_makes_the_image_invalid),
        cmocka_unit_test(test_the_parts_of_an_image_are_listed),
        cmocka_unit_test(test_checksum_is_crc_32),
        cmocka_unit_test(test_one_wrong_bit_is_refused),
        cmocka_unit_test(test_cut_or_foreign_images_are_refused),
        cmocka_unit_test(test_parts_that_differ_from_the_image_are_refused),
        cmocka_unit_test(test_invalid_fields_with_a_right_checksum_are_refused),
        cmocka_unit_test(test_objects_without_data_are_saved_and_loaded),
        cmocka_unit_test(test_a_held_plot_beyond_the_capacity_row_can_be_saved),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
