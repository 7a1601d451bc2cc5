/* SPDX-License-Identifier: MIT */
/*
 * Lives of tracks as messages in parts: receivers read the rates in use, and for each track the
 * probabilities that its target exists and is visible.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/publish.h"

#define PART_TRACKS RHO_MESSAGE_LIFE_MAX_TRACKS
/* Two full parts and a bit, or as many as the build has room for. */
#define TRACKS (RHO_MAX_TRACKS < 2 * PART_TRACKS + 30 ? RHO_MAX_TRACKS : 2 * PART_TRACKS + 30)

static struct rho_tracker tracker;
static struct rho_message_life life;

static void start_tracker(void)
{
    struct rho_tracker_config config;

    rho_tracker_config_default(&config);
    config.coast_scans_max = 5;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    tracker.time_us = 1234567;
}

/* Tracks that differ in number, and in both probabilities. */
static void fill_tracks(unsigned num_tracks)
{
    for (unsigned i = 0; i < num_tracks; i++) {
        tracker.tracks[i].track_id = 1000 + 3 * i;
        tracker.tracks[i].visible = (float)i / (float)(2 * num_tracks);
        tracker.tracks[i].hidden = 0.25f;
    }
    tracker.num_tracks = (uint16_t)num_tracks;
}

/* Publishes a part into a buffer of exactly its size, and decodes it as receivers do. */
static void publish_and_read_part(uint16_t part)
{
    uint8_t buffer[RHO_MESSAGE_LIFE_MAX_SIZE], *exact;
    size_t size = 0, same = 0;

    assert_int_equal(rho_publish_life(&tracker, 77, 5, part, buffer, sizeof buffer, &size), RHO_OK);
    exact = malloc(size);
    assert_non_null(exact);
    assert_int_equal(rho_publish_life(&tracker, 77, 5, part, exact, size, &same), RHO_OK);
    assert_int_equal(same, size);
    assert_memory_equal(exact, buffer, size);
    assert_int_equal(rho_message_life_decode(exact, size, &life), RHO_OK);
    assert_int_equal(rho_message_life_validate(&life, NULL), RHO_OK);
    free(exact);
}

static void before_learning_rates_are_those_of_the_start(void **state)
{
    (void)state;
    start_tracker();
    publish_and_read_part(0);
    assert_int_equal(life.utime, 1234567);
    assert_int_equal(life.scan, 77);
    assert_int_equal(life.epoch, 5);
    assert_float_equal(life.death_rate, 1.0f / 200.0f, 1e-8f);
    assert_float_equal(life.hide_rate, 1.0f / 200.0f, 1e-8f);
    assert_float_equal(life.appear_rate, 1.0f / 3.5f, 1e-6f);
    assert_float_equal(life.lived_scans, 0.0f, 0.0f);
    assert_int_equal(life.num_tracks_total, 0);
    assert_int_equal(life.part, 0);
    assert_int_equal(life.num_parts, 1);
    assert_int_equal(life.num_tracks, 0);
}

/* Eight deaths and 18 returns in 600 scans, beside the 400 that count from the start. */
static void learned_rates_sent_are_those_in_use(void **state)
{
    (void)state;
    start_tracker();
    tracker.lived = 600.0f;
    tracker.gone = 8.0f;
    tracker.returned = 18.0f;
    publish_and_read_part(0);
    assert_float_equal(life.death_rate, 0.01f, 1e-8f);
    assert_float_equal(life.hide_rate, 0.02f, 1e-8f);
    assert_float_equal(life.lived_scans, 600.0f, 0.0f);
    const struct rho_tracker_life used = rho_tracker_life(&tracker);
    assert_true(life.death_rate == used.death && life.hide_rate == used.hide);
    assert_true(life.appear_rate == used.appear && life.lived_scans == used.lived_scans);
}

/* A sum that rounding has brought above 1 is a probability all the same. */
static void probabilities_are_those_of_the_track(void **state)
{
    (void)state;
    start_tracker();
    fill_tracks(3);
    tracker.tracks[0].visible = 0.5f;
    tracker.tracks[0].hidden = 0.375f;
    tracker.tracks[1].visible = 0.0f;
    tracker.tracks[1].hidden = 0.0f;
    tracker.tracks[2].track_id = UINT32_MAX;
    tracker.tracks[2].visible = 0.75f;
    tracker.tracks[2].hidden = 0.250005f;
    publish_and_read_part(0);
    assert_int_equal(life.num_tracks, 3);
    assert_int_equal(life.num_tracks_total, 3);
    assert_int_equal(life.tracks[0].track_id, 1000);
    assert_float_equal(life.tracks[0].existence, 0.875f, 0.0f);
    assert_float_equal(life.tracks[0].visibility, 0.5f, 0.0f);
    assert_int_equal(life.tracks[1].track_id, 1003);
    assert_float_equal(life.tracks[1].existence, 0.0f, 0.0f);
    assert_float_equal(life.tracks[1].visibility, 0.0f, 0.0f);
    assert_int_equal(life.tracks[2].track_id, INT32_MAX); /* the identity is beyond int32_t */
    assert_float_equal(life.tracks[2].existence, 1.0f, 0.0f);
    assert_float_equal(life.tracks[2].visibility, 0.75f, 0.0f);
}

static void each_track_is_sent_once(void **state)
{
    const int num_parts = (TRACKS + PART_TRACKS - 1) / PART_TRACKS;
    unsigned track = 0;

    (void)state;
    start_tracker();
    fill_tracks(TRACKS);
    for (uint16_t part = 0; part < num_parts; part++) {
        publish_and_read_part(part);
        assert_int_equal(life.part, part);
        assert_int_equal(life.num_parts, num_parts);
        assert_int_equal(life.num_tracks_total, TRACKS);
        assert_int_equal(life.num_tracks,
                         part + 1 < num_parts ? PART_TRACKS : TRACKS - part * PART_TRACKS);
        assert_int_equal(life.utime, 1234567);
        assert_float_equal(life.death_rate, 1.0f / 200.0f, 1e-8f);
        for (int i = 0; i < life.num_tracks; i++, track++) {
            const struct rho_track *sent = &tracker.tracks[track];

            assert_int_equal(life.tracks[i].track_id, sent->track_id);
            assert_true(life.tracks[i].visibility == sent->visible);
            assert_true(life.tracks[i].existence == sent->visible + sent->hidden);
        }
    }
    assert_int_equal(track, TRACKS);
}

/* A hundred tracks fill one part; the next one takes a second. */
static void a_full_part_needs_no_second(void **state)
{
    (void)state;
    if (RHO_MAX_TRACKS <= PART_TRACKS) {
        skip();
    }
    start_tracker();
    fill_tracks(PART_TRACKS);
    publish_and_read_part(0);
    assert_int_equal(life.num_parts, 1);
    assert_int_equal(life.num_tracks, PART_TRACKS);
    fill_tracks(PART_TRACKS + 1);
    publish_and_read_part(1);
    assert_int_equal(life.num_parts, 2);
    assert_int_equal(life.num_tracks, 1);
}

static void bad_arguments_of_publishing_are_refused(void **state)
{
    uint8_t buffer[RHO_MESSAGE_LIFE_MAX_SIZE];
    size_t needed = 0, size = 12345;

    (void)state;
    start_tracker();
    fill_tracks(5);
    assert_int_equal(rho_publish_life(NULL, 0, 0, 0, buffer, sizeof buffer, &size), RHO_ERROR_NULL);
    assert_int_equal(rho_publish_life(&tracker, 0, 0, 0, NULL, sizeof buffer, &size),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_publish_life(&tracker, 0, 0, 0, buffer, sizeof buffer, NULL),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_publish_life(&tracker, 0, 0, 1, buffer, sizeof buffer, &size),
                     RHO_ERROR_VALUE);
    assert_int_equal(rho_publish_life(&tracker, 0, 0, UINT16_MAX, buffer, sizeof buffer, &size),
                     RHO_ERROR_VALUE);
    assert_int_equal(rho_publish_life(&tracker, 0, 0, 0, buffer, sizeof buffer, &needed), RHO_OK);
    for (size_t less = 0; less < needed; less++) {
        assert_int_equal(rho_publish_life(&tracker, 0, 0, 0, buffer, less, &size),
                         RHO_ERROR_CAPACITY);
    }
    assert_int_equal(size, 12345);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(before_learning_rates_are_those_of_the_start),
        cmocka_unit_test(learned_rates_sent_are_those_in_use),
        cmocka_unit_test(probabilities_are_those_of_the_track),
        cmocka_unit_test(each_track_is_sent_once),
        cmocka_unit_test(a_full_part_needs_no_second),
        cmocka_unit_test(bad_arguments_of_publishing_are_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
