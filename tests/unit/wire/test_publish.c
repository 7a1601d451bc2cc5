/* SPDX-License-Identifier: MIT */
/* Reports, candidates and counters as messages: receivers read the values that were published. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/publish.h"

#define PART RHO_MESSAGE_TRACK_LIST_MAX_TRACKS

static struct rho_report report;
static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_passive passive;
static struct rho_scan_assembler assembler;
static struct rho_message_track_list list;
static struct rho_message_peak_list peaks;
static struct rho_message_status status;
static struct rho_message_place place;

/*
 * ---- tracks -----------------------------------------------------------------------------------
 */

static void fill_report(unsigned num_tracks, unsigned num_ended)
{
    memset(&report, 0, sizeof report);
    report.time_us = -5;
    report.num_tracks = (uint16_t)num_tracks;
    report.num_ended = (uint16_t)num_ended;
    for (unsigned i = 0; i < num_tracks; i++) {
        struct rho_track_report *track = &report.tracks[i];

        track->track_id = 10 + i;
        track->status = (enum rho_track_status)(RHO_TRACK_TENTATIVE + i % 3);
        track->hits = (uint16_t)(i + 1);
        track->misses = (uint16_t)(2 * i);
        track->sensor_id = -(int32_t)i;
        track->plot = (int32_t)i - 1;
        track->update_age_us = 7 * (int32_t)i;
        track->score_nat = 0.5f * (float)i;
        track->maneuver_probability = 0.25f;
        for (unsigned k = 0; k < 6; k++) {
            track->state[k] = (float)(100 * i + k);
        }
        for (unsigned k = 0; k < 3; k++) {
            track->accel_mps2[k] = (float)k + 0.5f;
        }
        for (unsigned k = 0; k < 21; k++) {
            track->covariance[k] = (float)(1000 * i + k);
        }
    }
    for (unsigned i = 0; i < num_ended; i++) {
        report.ended[i] = 5000 + i;
    }
}

/* Publishes a part and decodes it from a buffer of exactly its size. */
static void publish_and_read_part(uint16_t part)
{
    uint8_t *buffer = malloc(RHO_MESSAGE_TRACK_LIST_MAX_SIZE);
    size_t size = 0, same = 0;

    assert_non_null(buffer);
    assert_int_equal(
        rho_publish_tracks(&report, 77, 88, part, buffer, RHO_MESSAGE_TRACK_LIST_MAX_SIZE, &size),
        RHO_OK);
    assert_int_equal(rho_message_track_list_decode(buffer, size, &list), RHO_OK);
    assert_int_equal(rho_message_track_list_validate(&list, &place), RHO_OK);
    free(buffer);
    buffer = malloc(size);
    assert_non_null(buffer);
    assert_int_equal(rho_publish_tracks(&report, 77, 88, part, buffer, size, &same), RHO_OK);
    assert_int_equal(same, size);
    for (size_t less = 0; less < size; less += 1 + less / 40) {
        same = 12345;
        assert_int_equal(rho_publish_tracks(&report, 77, 88, part, buffer, less, &same),
                         RHO_ERROR_CAPACITY);
        assert_int_equal(same, 12345);
    }
    free(buffer);
}

static void assert_message_equals_track(const struct rho_message_track *message,
                                        const struct rho_track_report *track)
{
    assert_int_equal(message->track_id, track->track_id);
    assert_int_equal(message->status, track->status == RHO_TRACK_TENTATIVE   ? 1
                                      : track->status == RHO_TRACK_CONFIRMED ? 2
                                                                             : 3);
    assert_int_equal(message->hits, track->hits);
    assert_int_equal(message->misses, track->misses);
    assert_int_equal(message->sensor_id, track->sensor_id);
    assert_int_equal(message->plot, track->plot);
    assert_int_equal(message->update_age_us, track->update_age_us);
    assert_memory_equal(&message->x_m, track->state, 6 * sizeof(float));
    assert_memory_equal(&message->ax_mps2, track->accel_mps2, 3 * sizeof(float));
    assert_true(message->score_nat == track->score_nat);
    assert_true(message->maneuver_probability == track->maneuver_probability);
    assert_memory_equal(message->covariance, track->covariance, sizeof message->covariance);
}

static void all_tracks_are_sent_once_in_their_order(void **state)
{
    (void)state;
    for (unsigned tracks = 0; tracks <= 30; tracks++) {
        for (unsigned ended = 0; ended <= 12; ended += 3) {
            unsigned entry = 0, total = tracks + ended;

            fill_report(tracks, ended);
            unsigned parts = total == 0 ? 1 : (total + PART - 1) / PART;
            assert_int_equal(rho_publish_num_parts(&report), parts);
            for (unsigned part = 0; part < parts; part++) {
                publish_and_read_part((uint16_t)part);
                assert_int_equal(list.utime, -5);
                assert_int_equal(list.scan, 77);
                assert_int_equal(list.epoch, 88);
                assert_int_equal(list.part, part);
                assert_int_equal(list.num_parts, parts);
                assert_int_equal(list.num_tracks_total, total);
                for (int i = 0; i < list.num_tracks; i++, entry++) {
                    if (entry < tracks) {
                        assert_message_equals_track(&list.tracks[i], &report.tracks[entry]);
                    } else {
                        struct rho_message_track want = {
                            .track_id = (int32_t)(5000 + entry - tracks), .status = 4, .plot = -1};
                        uint8_t is[RHO_MESSAGE_TRACK_MAX_SIZE], must[RHO_MESSAGE_TRACK_MAX_SIZE];
                        size_t size = 0;

                        assert_int_equal(
                            rho_message_track_encode(&list.tracks[i], is, sizeof is, &size), 0);
                        assert_int_equal(rho_message_track_encode(&want, must, sizeof must, &size),
                                         0);
                        assert_memory_equal(is, must, size);
                    }
                }
            }
            assert_int_equal(entry, total);
        }
    }
}

static void a_full_report_is_sent_in_parts(void **state)
{
    unsigned seen = 0;

    (void)state;
    fill_report(RHO_MAX_TRACKS, RHO_MAX_TRACKS);
    for (uint16_t part = 0; part < rho_publish_num_parts(&report); part++) {
        publish_and_read_part(part);
        seen += (unsigned)list.num_tracks;
    }
    assert_int_equal(seen, 2 * RHO_MAX_TRACKS);
    assert_int_equal(list.num_tracks_total, 2 * RHO_MAX_TRACKS);
}

static void tracks_in_doubt_are_left_out(void **state)
{
    unsigned seen = 0;

    (void)state;
    fill_report(30, 3);
    for (unsigned i = 0; i < 30; i += 3) {
        report.tracks[i].is_in_doubt = 1;
    }
    assert_int_equal(rho_publish_num_parts(&report), (20 + 3 + PART - 1) / PART);
    for (uint16_t part = 0; part < rho_publish_num_parts(&report); part++) {
        publish_and_read_part(part);
        assert_int_equal(list.num_tracks_total, 23);
        for (int i = 0; i < list.num_tracks; i++, seen++) {
            if (seen < 20) { /* those of each three that are not the first */
                assert_message_equals_track(&list.tracks[i],
                                            &report.tracks[seen / 2 * 3 + seen % 2 + 1]);
            } else {
                assert_int_equal(list.tracks[i].status, 4);
            }
        }
    }
    assert_int_equal(seen, 23);
}

static void numbers_beyond_their_fields_are_clamped(void **state)
{
    (void)state;
    fill_report(2, 1);
    report.tracks[0].hits = report.tracks[0].misses = UINT16_MAX;
    report.tracks[0].plot = 40000;
    report.tracks[0].sensor_id = 32768;
    report.tracks[0].track_id = 0x80000003u;
    report.tracks[1].sensor_id = -32769;
    report.tracks[1].plot = -1;
    report.tracks[1].hits = 32767;
    report.tracks[1].update_age_us = INT32_MAX;
    report.ended[0] = UINT32_MAX;
    publish_and_read_part(0);
    assert_int_equal(list.tracks[0].hits, 32767);
    assert_int_equal(list.tracks[0].misses, 32767);
    assert_int_equal(list.tracks[0].plot, 32767);
    assert_int_equal(list.tracks[0].sensor_id, -1);
    assert_int_equal(list.tracks[0].track_id, 3);
    assert_int_equal(list.tracks[1].sensor_id, -1);
    assert_int_equal(list.tracks[1].plot, -1);
    assert_int_equal(list.tracks[1].hits, 32767);
    assert_int_equal(list.tracks[1].update_age_us, INT32_MAX);
    assert_int_equal(list.tracks[2].track_id, INT32_MAX);
    report.tracks[0].sensor_id = 32767;
    report.tracks[1].sensor_id = -32768;
    publish_and_read_part(0);
    assert_int_equal(list.tracks[0].sensor_id, 32767);
    assert_int_equal(list.tracks[1].sensor_id, -32768);
}

static void bad_arguments_of_publishing_are_refused(void **state)
{
    uint8_t buffer[RHO_MESSAGE_TRACK_LIST_MAX_SIZE];
    size_t size = 3;

    (void)state;
    fill_report(PART, 0);
    assert_int_equal(rho_publish_num_parts(NULL), 1);
    assert_int_equal(rho_publish_tracks(NULL, 0, 0, 0, buffer, sizeof buffer, &size),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_publish_tracks(&report, 0, 0, 0, NULL, sizeof buffer, &size),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_publish_tracks(&report, 0, 0, 0, buffer, sizeof buffer, NULL),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_publish_tracks(&report, 0, 0, 1, buffer, sizeof buffer, &size),
                     RHO_ERROR_VALUE);
    assert_int_equal(rho_publish_tracks(&report, 0, 0, UINT16_MAX, buffer, sizeof buffer, &size),
                     RHO_ERROR_VALUE);
    assert_int_equal(rho_publish_peaks(NULL, NULL, 0, 0, NULL, 99, &size), RHO_ERROR_NULL);
    assert_int_equal(rho_publish_peaks(NULL, NULL, 0, 0, buffer, 99, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_publish_peaks(NULL, NULL, 0, 0, buffer, 5, &size), RHO_ERROR_CAPACITY);
    assert_int_equal(size, 3);
    rho_publish_status(NULL, NULL, NULL, NULL);
}

/*
 * ---- peaks ------------------------------------------------------------------------------------
 */

static void publish_and_read_peaks(int has_initiator, int has_passive)
{
    uint8_t buffer[RHO_MESSAGE_PEAK_LIST_MAX_SIZE];
    size_t size = 0;

    assert_int_equal(rho_publish_peaks(has_initiator ? &initiator : NULL,
                                       has_passive ? &passive : NULL, 1234, 56, buffer,
                                       sizeof buffer, &size),
                     RHO_OK);
    assert_int_equal(rho_message_peak_list_decode(buffer, size, &peaks), RHO_OK);
    assert_int_equal(rho_message_peak_list_validate(&peaks, &place), RHO_OK);
    assert_int_equal(peaks.utime, 1234);
    assert_int_equal(peaks.scan, 56);
}

static void fill_candidates(unsigned num_candidates, unsigned num_passive)
{
    memset(&initiator, 0, sizeof initiator);
    memset(&passive, 0, sizeof passive);
    initiator.num_candidates = (uint16_t)num_candidates;
    passive.num_tracks = (uint16_t)num_passive;
    for (unsigned i = 0; i < num_candidates; i++) {
        double heading = 0.1 + 0.37 * i;
        initiator.candidates[i] = (struct rho_candidate){.hits = (uint16_t)(3 + i),
                                                         .score_mnat = 12500 + (int32_t)i,
                                                         .x_m = 1000.0f * (float)i - 7000.0f,
                                                         .y_m = 300.0f,
                                                         .vx_mps = (float)(90.0 * cos(heading)),
                                                         .vy_mps = (float)(90.0 * sin(heading))};
    }
    for (unsigned i = 0; i < num_passive; i++) {
        passive.tracks[i] = (struct rho_passive_track){
            .x_m = 5.0f, .y_m = 7.0f, .vy_mps = 2.0f, .score_mnat = 1500, .scans = 0xb};
        for (unsigned sensor = 0; sensor < i % (RHO_MAX_PASSIVE_SENSORS + 1); sensor++) {
            passive.tracks[i].claim[(i + sensor) % RHO_MAX_PASSIVE_SCANS][sensor] = 2;
            passive.tracks[i].claim[0][sensor] = 1; /* several scans of a sensor count it once */
        }
    }
}

static void a_peak_holds_the_line_of_its_candidate(void **state)
{
    (void)state;
    fill_candidates(20, 0);
    publish_and_read_peaks(1, 0);
    assert_int_equal(peaks.num_peaks, 20);
    for (int i = 0; i < 20; i++) {
        const struct rho_message_peak *peak = &peaks.peaks[i];
        const struct rho_candidate *candidate = &initiator.candidates[i];
        double theta = peak->theta_rad;
        double rho = (double)candidate->x_m * cos(theta) + (double)candidate->y_m * sin(theta);
        double across =
            (double)candidate->vx_mps * cos(theta) + (double)candidate->vy_mps * sin(theta);

        assert_true(fabs(rho - (double)peak->rho_m) < 0.01);
        assert_true(fabs(across) < 1e-3);
        assert_true(fabs((double)peak->speed_mps - 90.0) < 1e-3);
        assert_true(fabs((double)peak->score_nat - (12.5 + 0.001 * i)) < 1e-5);
        assert_int_equal(peak->scans_hit, 3 + i);
        assert_int_equal(peak->sensor_pairs, 0);
    }
}

static void sensor_pairs_count_sensors_with_a_claim(void **state)
{
    const unsigned tracks = RHO_MAX_PASSIVE_SENSORS + 1 < RHO_MAX_PASSIVE_TRACKS
                                ? RHO_MAX_PASSIVE_SENSORS + 1
                                : RHO_MAX_PASSIVE_TRACKS;

    (void)state;
    fill_candidates(2, tracks);
    publish_and_read_peaks(1, 1);
    assert_int_equal(peaks.num_peaks, 2 + tracks);
    for (unsigned i = 0; i < tracks; i++) {
        assert_int_equal(peaks.peaks[2 + i].sensor_pairs, i * (i > 0 ? i - 1 : 0) / 2);
        assert_int_equal(peaks.peaks[2 + i].scans_hit, 3);
        assert_true(peaks.peaks[2 + i].score_nat == 1.5f);
        assert_true(peaks.peaks[2 + i].speed_mps == 2.0f);
        assert_true(fabs((double)peaks.peaks[2 + i].rho_m - 5.0) < 1e-4);
    }
    publish_and_read_peaks(0, 1);
    assert_int_equal(peaks.num_peaks, tracks);
    publish_and_read_peaks(0, 0);
    assert_int_equal(peaks.num_peaks, 0);
}

static void the_best_peaks_are_sent(void **state)
{
    (void)state;
    fill_candidates(RHO_MAX_CANDIDATES, RHO_MAX_PASSIVE_TRACKS);
    publish_and_read_peaks(1, 1);
    unsigned all = RHO_MAX_CANDIDATES + RHO_MAX_PASSIVE_TRACKS;
    assert_int_equal(peaks.num_peaks, all < 48 ? all : 48);
}

static void candidates_at_rest_have_a_line(void **state)
{
    (void)state;
    fill_candidates(1, 1);
    initiator.candidates[0].vx_mps = initiator.candidates[0].vy_mps = 0.0f;
    passive.tracks[0].vy_mps = 0.0f;
    publish_and_read_peaks(1, 1);
    assert_true(peaks.peaks[0].speed_mps == 0.0f && peaks.peaks[0].theta_rad == 0.0f);
    assert_true(peaks.peaks[0].rho_m == initiator.candidates[0].x_m);
    assert_true(peaks.peaks[1].rho_m == 5.0f);
}

/*
 * ---- status -----------------------------------------------------------------------------------
 */

/* Compares encoded bytes, as structs have padding. */
static void assert_same_status(const struct rho_message_status *want)
{
    uint8_t is[RHO_MESSAGE_STATUS_MAX_SIZE], must[RHO_MESSAGE_STATUS_MAX_SIZE];
    size_t size = 0;

    assert_int_equal(rho_message_status_encode(&status, is, sizeof is, &size), RHO_OK);
    assert_int_equal(rho_message_status_encode(want, must, sizeof must, &size), RHO_OK);
    assert_memory_equal(is, must, size);
}

static void every_status_field_comes_from_its_counter(void **state)
{
    struct rho_message_status want;

    (void)state;
    memset(&tracker, 0, sizeof tracker);
    memset(&initiator, 0, sizeof initiator);
    memset(&assembler, 0, sizeof assembler);
    assembler.counters = (struct rho_scan_assembler_counters){.messages_bad = 1,
                                                              .messages_wrong_type = 2,
                                                              .messages_flooded = 4,
                                                              .scans_accepted = 8,
                                                              .scans_late = 16,
                                                              .scans_duplicate = 32,
                                                              .scans_lost = 64,
                                                              .scans_bad = 128,
                                                              .scans_incomplete = 256,
                                                              .clock_jumps = 512,
                                                              .sensor_restarts = 1024,
                                                              .sensors_no_room = 2048,
                                                              .bearings_in = 4096,
                                                              .plots_no_room = 8192};
    tracker.counters = (struct rho_tracker_counters){.scans_late = 1000000,
                                                     .plots_in = 2000000,
                                                     .plots_initiated = 3000000,
                                                     .plots_clutter = 4000000};
    for (uint32_t fate = 0; fate < RHO_NUM_FATES; fate++) {
        tracker.counters.fates[fate] = 10000000 * (fate + 1);
    }
    tracker.time_us = 4711;
    initiator.density_per_m2 = 2.5e-7f;
    rho_publish_status(&assembler, &tracker, &initiator, &status);
    want = (struct rho_message_status){
        .utime = 4711,
        .messages_bad = 1,
        .messages_wrong_type = 2,
        .messages_flooded = 4,
        .scans_accepted = 8,
        .scans_late = 16 + 1000000,
        .scans_duplicate = 32,
        .scans_lost = 64,
        .scans_bad = 128 + 2048,
        .scans_incomplete = 256,
        .clock_jumps = 512,
        .sensor_restarts = 1024,
        .bearings_in = 4096,
        .plots_in = 2000000 + 8192,
        .plots_initiated = 3000000,
        .plots_clutter = 4000000,
        .plots_claimed = 10000000 * (RHO_FATE_CLAIMED + 1),
        .plots_held = 10000000 * (RHO_FATE_HELD + 1),
        .ghosts_pruned = 10000000 * (RHO_FATE_GHOST + 1),
        .inputs_stale = 10000000 * (RHO_FATE_STALE + 1),
        .inputs_invalid = 10000000 * (RHO_FATE_INVALID + 1),
        .inputs_no_room = 10000000 * (RHO_FATE_NO_ROOM + 1) + 8192,
        .clutter_per_km2 = 2.5e-7f * 1.0e6f,
    };
    assert_same_status(&want);
    assert_int_equal(rho_message_status_validate(&status, &place), RHO_OK);
}

static void full_counters_are_clamped(void **state)
{
    (void)state;
    memset(&assembler.counters, 0xff, sizeof assembler.counters);
    memset(&tracker.counters, 0xff, sizeof tracker.counters);
    tracker.num_tracks = 0;
    rho_publish_status(&assembler, &tracker, NULL, &status);
    assert_int_equal(rho_message_status_validate(&status, &place), RHO_OK);
    for (const int32_t *field = &status.scans_accepted; field <= &status.ghosts_pruned; field++) {
        /* the caller's; and no frames of bearings are counted any more */
        int is_zero = field == &status.fragments_refused || field == &status.frames_incomplete;
        assert_int_equal(*field, is_zero ? 0 : INT32_MAX);
    }
}

static void status_of_null_objects_is_all_zero(void **state)
{
    struct rho_message_status zeros;

    (void)state;
    memset(&zeros, 0, sizeof zeros);
    memset(&status, 0x5a, sizeof status);
    rho_publish_status(NULL, NULL, NULL, &status);
    assert_true(status.utime == 0 && status.scan == 0 && status.ghosts_pruned == 0);
    assert_true(status.tracks_coasting == 0 && status.clutter_per_km2 == 0.0f);
    assert_int_equal(rho_message_status_validate(&status, &place), RHO_OK);
}

/* Work */

static void the_work_message_holds_the_trackers_work(void **state)
{
    struct rho_message_work work, zeros;

    (void)state;
    memset(&work, 0x5a, sizeof work);
    memset(&zeros, 0, sizeof zeros);
    rho_publish_work(NULL, &work);
    assert_memory_equal(&work, &zeros, sizeof work);
    tracker.time_us = 77;
    tracker.work = (struct rho_tracker_work){
        .work = 1, .work_worst = 22, .partial_steps = 333, .plots_not_tried = UINT32_MAX};
    tracker.config.work_max = 55555;
    rho_publish_work(&tracker, &work);
    assert_int_equal(rho_message_work_validate(&work, &place), RHO_OK);
    assert_int_equal(work.utime, 77);
    assert_int_equal(work.work_max, 55555);
    assert_int_equal(work.work, 1);
    assert_int_equal(work.work_worst, 22);
    assert_int_equal(work.partial_steps, 333);
    assert_int_equal(work.plots_not_tried, UINT32_MAX);
    assert_true(work.scan == 0 && work.epoch == 0 && work.num_steps == 0);
    assert_true(work.reports_not_printed == 0 && work.events_not_logged == 0);
    rho_publish_work(&tracker, NULL);
}

/* Three targets come, are seen and go, the first one at the beginning or at the end. */
static void check_status_while_three_targets_come_and_go(int is_first)
{
    struct rho_tracker_config config;
    struct rho_initiator_config initiator_config;
    int most = 0;

    rho_tracker_config_default(&config);
    rho_initiator_config_default(&initiator_config);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &initiator_config), RHO_OK);
    for (int k = 0; k < 60; k++) {
        struct rho_plot plots[3];
        struct rho_scan scan = {.time_us = k * INT64_C(1000000), .plots = plots};
        unsigned live[4] = {0};

        for (int i = 0; i < 3; i++) {
            if (k < 20 + 10 * (is_first ? i : 2 - i)) {
                plots[scan.num_plots++] = (struct rho_plot){.x_m = 100.0f * (float)k,
                                                            .y_m = 5000.0f * (float)i,
                                                            .sigma_range_m = 10.0f,
                                                            .sigma_cross_m = 10.0f,
                                                            .sigma_up_m = 10.0f};
            }
        }
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
        for (unsigned i = 0; i < report.num_tracks; i++) {
            live[report.tracks[i].status]++;
        }
        rho_publish_status(NULL, &tracker, NULL, &status);
        assert_int_equal(status.tracks_tentative, live[RHO_TRACK_TENTATIVE]);
        assert_int_equal(status.tracks_confirmed, live[RHO_TRACK_CONFIRMED]);
        assert_int_equal(status.tracks_coasting, live[RHO_TRACK_COASTING]);
        most = status.tracks_confirmed > most ? status.tracks_confirmed : most;
        for (uint16_t part = 0; part < rho_publish_num_parts(&report); part++) {
            publish_and_read_part(part);
        }
    }
    assert_int_equal(most, 3);
    assert_int_equal(report.num_tracks, 0);
}

static void ended_tracks_are_not_counted_in_the_status(void **state)
{
    (void)state;
    check_status_while_three_targets_come_and_go(0);
    check_status_while_three_targets_come_and_go(1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_tracks_are_sent_once_in_their_order),
        cmocka_unit_test(a_full_report_is_sent_in_parts),
        cmocka_unit_test(tracks_in_doubt_are_left_out),
        cmocka_unit_test(numbers_beyond_their_fields_are_clamped),
        cmocka_unit_test(bad_arguments_of_publishing_are_refused),
        cmocka_unit_test(a_peak_holds_the_line_of_its_candidate),
        cmocka_unit_test(sensor_pairs_count_sensors_with_a_claim),
        cmocka_unit_test(the_best_peaks_are_sent),
        cmocka_unit_test(candidates_at_rest_have_a_line),
        cmocka_unit_test(every_status_field_comes_from_its_counter),
        cmocka_unit_test(full_counters_are_clamped),
        cmocka_unit_test(status_of_null_objects_is_all_zero),
        cmocka_unit_test(the_work_message_holds_the_trackers_work),
        cmocka_unit_test(ended_tracks_are_not_counted_in_the_status),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
