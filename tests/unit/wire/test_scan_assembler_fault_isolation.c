/* SPDX-License-Identifier: MIT */
/*
 * Two radars of separate coverage, and faults of every kind in the messages of one: the tracker's
 * results for the other radar are compared bit by bit with those without faults.
 */
#include <math.h>

#include "rhotrack/initiator.h"
#include "rhotrack/tracker.h"
#include "scan_assembler_setup.h"

#define SCANS 60
#define FIRST_FAULT 20
#define LAST_FAULT 45
#define REACH_M 30000.0f
#define TARGETS 3
#define CLUTTER 6
#define PARTS 3

/* Size of the struct up to its padding. */
#define TRACK_BYTES (offsetof(struct rho_track_report, num_hypotheses) + sizeof(uint16_t))

enum radar { FAULTY, GOOD, NUM_RADARS };

static const float radar_x_m[NUM_RADARS] = {0.0f, 200000.0f};
static const int64_t phase_us[NUM_RADARS] = {0, 500000};

/*
 * The tracker's report within the good radar's coverage after its scan. Identities are excluded, as
 * all tracks share them.
 */
struct measurement_row {
    int64_t time_us;
    unsigned num_tracks;
    uint32_t fates[RHO_NUM_FATES];
    struct rho_track_report tracks[RHO_MAX_TRACKS < 32 ? RHO_MAX_TRACKS : 32];
};

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;
static struct measurement_row clean[SCANS + 1], records[SCANS + 1];
static unsigned num_records, steps_of[NUM_RADARS];

/*
 * ---- messages ---------------------------------------------------------------------------------
 */

static uint32_t hash_of(uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t h = a * 2654435761u ^ b * 2246822519u ^ c * 3266489917u;

    h = (h ^ h >> 15) * 2246822519u;
    return h ^ h >> 13;
}

static float spread_bits(uint32_t bits, float size)
{
    return size * ((float)(bits & 0xffffu) / 32768.0f - 1.0f);
}

struct message {
    enum radar radar;
    int32_t look; /* index of the plots */
    int32_t scan, epoch;
    int64_t time_us;
    int16_t part;
    int16_t sensor_id; /* 0: the radar's own id */
};

static int16_t sensor_of_message(const struct message *message)
{
    return message->sensor_id > 0 ? message->sensor_id : (int16_t)(message->radar + 1);
}

static size_t write_message(const struct message *message, uint8_t *buffer)
{
    struct rho_message_plot_scan_head head = {
        .utime = message->time_us,
        .scan = message->scan,
        .epoch = message->epoch,
        .sensor_id = sensor_of_message(message),
        .kind = RHO_MESSAGE_PLOT_SCAN_POSITION_2D,
        .part = message->part,
        .num_parts = PARTS,
    };
    struct rho_message_writer writer;

    assert_int_equal(rho_message_plot_scan_begin(&writer, buffer, DATAGRAM, &head), RHO_OK);
    for (uint32_t i = (uint32_t)message->part; i < TARGETS + CLUTTER; i += PARTS) {
        uint32_t bits = hash_of((uint32_t)message->look, i, (uint32_t)message->radar);
        int is_target = i < TARGETS;
        float t_s = (float)message->look;
        struct rho_message_plot plot = {
            .x_m =
                radar_x_m[message->radar] + spread_bits(bits, is_target ? 15.0f : 0.7f * REACH_M),
            .y_m = spread_bits(bits >> 16, is_target ? 15.0f : 0.7f * REACH_M),
            .sigma_m = 10.0f,
        };
        if (is_target) {
            plot.x_m += -8000.0f + 150.0f * t_s;
            plot.y_m += 6000.0f * (float)i - 5000.0f + 50.0f * t_s;
        }
        if (!is_target || bits % 10 > 0) {
            assert_int_equal(rho_message_plot_scan_add(&writer, &plot), RHO_OK);
        }
    }
    return end_message(&writer);
}

/* Assembler, tracker and recorded reports */

static void record_report_of_good_radar(void)
{
    struct measurement_row *record = &records[num_records++];

    assert_true(num_records <= SCANS);
    memset(record, 0, sizeof *record);
    record->time_us = report.time_us;
    memcpy(record->fates, report.fates_total, sizeof record->fates);
    for (unsigned i = 0; i < report.num_tracks; i++) {
        if (fabsf(report.tracks[i].state[0] - radar_x_m[GOOD]) < 2.0f * REACH_M) {
            memcpy(&record->tracks[record->num_tracks], &report.tracks[i], TRACK_BYTES);
            record->tracks[record->num_tracks++].track_id = 0;
        }
    }
}

static void step_item(void)
{
    assert_int_equal(item.is_restart, 0);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &item.sensor), RHO_OK);
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &item.scan, &report), RHO_OK);
    if (item.scan.sensor_id - 1 < NUM_RADARS) {
        steps_of[item.scan.sensor_id - 1]++;
    }
    if (item.scan.sensor_id - 1 == GOOD) {
        record_report_of_good_radar();
    }
}

static void step_all_items(int64_t now_us)
{
    while (rho_scan_assembler_next(&assembler, now_us, &item)) {
        step_item();
    }
}

static void send_bytes(const char *channel, const uint8_t *bytes, size_t size, int64_t now_us)
{
    while (take_bytes(channel, bytes, size, now_us) == RHO_ERROR_CAPACITY) {
        if (rho_scan_assembler_next(&assembler, now_us, &item)) {
            step_item();
        }
    }
    step_all_items(now_us);
}

static void send_message(const struct message *message, int64_t now_us)
{
    uint8_t buffer[DATAGRAM];
    size_t size = write_message(message, buffer);

    send_bytes(channel_of(RHO_SCAN_ASSEMBLER_PLOTS, sensor_of_message(message)), buffer, size,
               now_us);
}

/*
 * ---- faults -----------------------------------------------------------------------------------
 */

/*
 * First the faults after which all scans of the faulty radar still arrive, then those that lose
 * some.
 */
enum fault {
    NONE,
    DOUBLE_PARTS,
    DOUBLE_SCANS,
    LATE_DOUBLES,
    PARTS_REORDERED,
    NOT_FINITE,
    WRONG_FINGERPRINT,
    HOSTILE_COUNT,
    TRUNCATED,
    TRAILING,
    WRONG_SENSOR,
    EXTRA_JUMPS,
    FAR_FUTURE,
    SKIPPED_NUMBERS,
    OTHER_EPOCH,
    JUNK,
    FORGED_SENSORS,
    NUM_HARMLESS,
    FLOOD = NUM_HARMLESS,
    LOST_SCANS,
    LOST_PARTS,
    SCANS_REORDERED,
    CLOCK_AHEAD_18_S,
    CLOCK_AHEAD_1_H,
    CLOCK_BACK,
    RESTART,
    SILENT,
    NUM_FAULTS
};

static const char *const fault_names[NUM_FAULTS] = {
    "none",         "double parts",    "double scans",
    "late doubles", "parts reordered", "not finite",
    "fingerprint",  "hostile count",   "truncated",
    "trailing",     "wrong sensor",    "extra jumps",
    "far future",   "skipped",         "other epoch",
    "junk",         "forged sensors",  "flood",
    "lost scans",   "lost parts",      "scans reordered",
    "18 s ahead",   "1 h ahead",       "clock back",
    "restart",      "silent"};

static void send_damaged_message(enum fault fault, const struct message *message, int64_t now_us)
{
    uint8_t buffer[DATAGRAM + 1] = {0};
    size_t size = write_message(message, buffer);
    const char *channel = channel_of(RHO_SCAN_ASSEMBLER_PLOTS, FAULTY + 1);

    if (fault == NOT_FINITE && size > 100) {
        memset(buffer + size - 20, 0xff, 8);
    } else if (fault == WRONG_FINGERPRINT) {
        buffer[7] ^= 0x10;
    } else if (fault == HOSTILE_COUNT) {
        buffer[39] = (uint8_t)random_below(256);
        buffer[40] = (uint8_t)(35 + random_below(200));
    } else if (fault == TRUNCATED) {
        size = random_below((uint32_t)size);
    } else if (fault == TRAILING) {
        size += 1;
    } else if (fault == WRONG_SENSOR) {
        channel = channel_of(RHO_SCAN_ASSEMBLER_PLOTS, FAULTY + 7);
    } else if (fault == JUNK) {
        for (size_t i = 0; i < size; i++) {
            buffer[i] = (uint8_t)random_below(256);
        }
    }
    for (unsigned i = 0; i < (fault == FLOOD ? 12000 : 1); i++) {
        send_bytes(channel, buffer, fault == FLOOD ? 4 : size, now_us);
    }
}

/* Sends a valid message with a false value. */
static void send_false_message(enum fault fault, struct message message, int64_t now_us)
{
    if (fault == FORGED_SENSORS) {
        message.sensor_id = (int16_t)(100 + random_below(30000));
        message.time_us += 5 * SECOND_US + random_below(1000000000);
    } else if (fault == EXTRA_JUMPS) {
        message.scan++;
        message.time_us += (int64_t)(random_below(2) ? 1 : -1) * random_below(2000000000);
    } else if (fault == FAR_FUTURE) {
        message.scan++;
        message.time_us = RHO_LIMIT_TIME_US - random_below(1000);
    } else if (fault == SKIPPED_NUMBERS) {
        message.scan += 2 + (int32_t)random_below(1000000);
        message.time_us += SECOND_US;
    } else {
        message.epoch += 1 + (int32_t)random_below(1000000);
    }
    send_message(&message, now_us);
}

static void send_scan_with_fault(enum fault fault, int32_t look, int64_t time_us, int64_t now_us)
{
    struct message message = {
        .radar = FAULTY, .look = look, .scan = look, .epoch = 5, .time_us = time_us};
    static const int16_t orders[4][PARTS] = {{2, 1, 0}, {1, 2, 0}, {0, 2, 1}, {2, 0, 1}};
    const int is_extra =
        (fault >= NOT_FINITE && fault <= WRONG_SENSOR) || fault == JUNK || fault == FLOOD;
    const int is_lie = (fault >= EXTRA_JUMPS && fault <= OTHER_EPOCH) || fault == FORGED_SENSORS;

    if (fault == SILENT || (fault == LOST_SCANS && hash_of((uint32_t)look, 0, 9) % 2)) {
        return;
    }
    message.time_us += fault == CLOCK_AHEAD_18_S  ? 18 * SECOND_US
                       : fault == CLOCK_AHEAD_1_H ? 3600 * SECOND_US
                       : fault == CLOCK_BACK      ? -3600 * SECOND_US
                                                  : 0;
    if (fault == RESTART) {
        message.epoch = 6;
        message.scan -= FIRST_FAULT;
    }
    if (fault == SCANS_REORDERED && look % 3 == 0) {
        return; /* sent after the next scan */
    }
    for (int16_t i = 0; i < PARTS; i++) {
        message.part = fault == PARTS_REORDERED ? orders[look % 4][i] : i;
        if (is_extra) {
            send_damaged_message(fault, &message, now_us);
        }
        if (is_lie) {
            send_false_message(fault, message, now_us);
        }
        if (fault != LOST_PARTS || hash_of((uint32_t)look, (uint32_t)i, 3) % 3 > 0) {
            send_message(&message, now_us);
        }
        if (fault == DOUBLE_PARTS) {
            send_message(&message, now_us);
        }
    }
    for (int16_t i = 0; i < PARTS; i++) {
        message.part = i;
        if (fault == SCANS_REORDERED && look % 3 == 1) {
            struct message late = message;
            late.look--;
            late.scan--;
            late.time_us -= SECOND_US;
            send_message(&late, now_us);
        }
        if (fault == LATE_DOUBLES && look > 4) {
            struct message late = message;
            late.look -= 3;
            late.scan -= 3;
            late.time_us -= 3 * SECOND_US;
            send_message(&late, now_us);
        }
        if (fault == DOUBLE_SCANS) {
            send_message(&message, now_us);
        }
    }
}

static void start_objects(uint8_t gate)
{
    struct rho_scan_assembler_config config = usual_config();
    struct rho_tracker_config tracker_config;
    struct rho_initiator_config initiator_config;

    config.gives_other = 1;
    start_assembler_with(&config);
    for (int32_t radar = 0; radar < NUM_RADARS; radar++) {
        struct rho_scan_assembler_sensor sensor = config.other;
        sensor.sensor.sensor_id = radar + 1;
        sensor.sensor.x_m = radar_x_m[radar];
        sensor.sensor.range_max_m = REACH_M;
        assert_int_equal(rho_scan_assembler_set_sensor(&assembler, &sensor), RHO_OK);
    }
    rho_tracker_config_default(&tracker_config);
    rho_initiator_config_default(&initiator_config);
    tracker_config.gate = gate;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &tracker_config), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &initiator_config), RHO_OK);
    num_records = 0;
    memset(steps_of, 0, sizeof steps_of);
    random_state = 77;
}

static void run_with_fault(uint8_t gate, enum fault fault)
{
    int64_t now_us = 0;

    start_objects(gate);
    for (int32_t look = 0; look < SCANS; look++) {
        int64_t time_us = look * SECOND_US;
        int is_faulty = look >= FIRST_FAULT && look < LAST_FAULT;

        now_us = time_us + 3000;
        send_scan_with_fault(is_faulty ? fault : NONE, look, time_us, now_us);
        step_all_items(now_us + HOLD_US);
        now_us = time_us + phase_us[GOOD] + 3000;
        for (int16_t part = 0; part < PARTS; part++) {
            struct message message = {.radar = GOOD,
                                      .look = look,
                                      .scan = 1000 + look,
                                      .time_us = time_us + phase_us[GOOD],
                                      .part = part};
            send_message(&message, now_us);
        }
        step_all_items(now_us + HOLD_US);
    }
}

/*
 * ---- comparisons ------------------------------------------------------------------------------
 */

static void faults_without_lost_scans_change_no_bit(void **state)
{
    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        run_with_fault(gate, NONE);
        memcpy(clean, records, sizeof clean);
        assert_int_equal(clean[SCANS - 1].num_tracks, TARGETS);
        for (unsigned fault = NONE; fault < NUM_HARMLESS; fault++) {
            run_with_fault(gate, (enum fault)fault);
            if (num_records != SCANS || memcmp(clean, records, sizeof clean) != 0) {
                fail_msg("gate %u: %s", gate, fault_names[fault]);
            }
            assert_int_equal(steps_of[FAULTY], SCANS); /* no scan of its own is lost, either */
        }
    }
}

/* How far a track differs from the run without the fault. */
/* Only the score may differ, as it is compared with the clutter, whose map all sensors share. */
static void are_tracks_equal_but_for_score(const struct rho_track_report *is,
                                           const struct rho_track_report *was)
{
    assert_int_equal(is->status, was->status);
    assert_int_equal(is->hits, was->hits);
    assert_int_equal(is->misses, was->misses);
    assert_int_equal(is->plot, was->plot);
    assert_int_equal(is->update_age_us, was->update_age_us);
    assert_memory_equal(is->state, was->state, sizeof was->state);
    assert_memory_equal(is->covariance, was->covariance, sizeof was->covariance);
    assert_memory_equal(is->accel_mps2, was->accel_mps2, sizeof was->accel_mps2);
    assert_memory_equal(&is->maneuver_probability, &was->maneuver_probability, sizeof(float));
}

/* If scans of one radar are missing, tracks outside its coverage are the same to the last bit. */
static void lost_scans_of_one_radar_change_no_track_of_the_other(void **state)
{
    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        run_with_fault(gate, NONE);
        memcpy(clean, records, sizeof clean);
        for (unsigned fault = NUM_HARMLESS; fault < NUM_FAULTS; fault++) {
            run_with_fault(gate, (enum fault)fault);
            assert_int_equal(num_records, SCANS);
            if (fault == SCANS_REORDERED) { /* reordered scans all arrive in the end */
                assert_int_equal(steps_of[FAULTY], SCANS);
            } else {
                assert_in_range(steps_of[FAULTY], SCANS - (LAST_FAULT - FIRST_FAULT) - 2,
                                SCANS - 1);
            }
            for (unsigned i = 0; i < SCANS; i++) {
                assert_int_equal(records[i].time_us, clean[i].time_us);
                assert_int_equal(records[i].num_tracks, clean[i].num_tracks);
                for (unsigned k = 0; k < clean[i].num_tracks; k++) {
                    are_tracks_equal_but_for_score(&records[i].tracks[k], &clean[i].tracks[k]);
                }
            }
        }
    }
}

/* Each fault is counted by its own counter and by no other. */
static void every_fault_is_counted_by_its_counter(void **state)
{
    const uint32_t faulty = LAST_FAULT - FIRST_FAULT, messages = faulty * PARTS;

    (void)state;
    for (unsigned fault = NONE; fault < NUM_HARMLESS; fault++) {
        struct rho_scan_assembler_counters want = {.scans_accepted = 2 * SCANS};

        run_with_fault(RHO_TRACKER_NEAREST, (enum fault)fault);
        switch ((enum fault)fault) {
        case DOUBLE_PARTS:
        case DOUBLE_SCANS:
        case LATE_DOUBLES:
            want.scans_duplicate = messages;
            break;
        case NOT_FINITE:
        case HOSTILE_COUNT:
        case TRUNCATED:
        case TRAILING:
        case WRONG_SENSOR:
            want.messages_bad = messages;
            break;
        case WRONG_FINGERPRINT:
        case JUNK:
            want.messages_wrong_type = messages;
            break;
        case EXTRA_JUMPS:
        case FAR_FUTURE:
        case FORGED_SENSORS:
            want.clock_jumps = messages;
            break;
        case SKIPPED_NUMBERS:
        case OTHER_EPOCH:
            want.scans_bad = messages;
            break;
        default:
            break;
        }
        expect_counters_are(want);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faults_without_lost_scans_change_no_bit),
        cmocka_unit_test(lost_scans_of_one_radar_change_no_track_of_the_other),
        cmocka_unit_test(every_fault_is_counted_by_its_counter),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
