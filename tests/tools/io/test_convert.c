/* SPDX-License-Identifier: MIT */
/*
 * Messages to CSV rows and back: random messages of every kind come back byte by byte; which rows
 * form a scan; several files merged by time.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/random.h"
#include "io/log/lcm_log.h"
#include "io/log/message_source.h"
#include "io/rows/rows_from_messages.h"
#include "io/rows/rows_to_csv.h"
#include "rhotrack/message.h"

#define MAX_MESSAGES 400

/* Messages that were made, in order of time. */
struct sent {
    int64_t utime;
    char channel[64];
    uint8_t data[1500];
    size_t size;
};

static struct sent sent[MAX_MESSAGES];
static size_t num_sent;
static struct random dice;

static uint64_t random_number_below(uint64_t n)
{
    return random_below(&dice, n);
}

/* A random float within +-limit: round, tiny, the limit itself, both zeros. */
static float draw_float(float limit)
{
    switch (random_number_below(8)) {
    case 0:
        return 0.0f;
    case 1:
        return -0.0f;
    case 2:
        return random_number_below(2) ? limit : -limit;
    case 3:
        return (float)(random_uniform(&dice) * 1e-30);
    case 4:
        return (float)((double)random_number_below(2000) - 1000.0) * (limit / 1000.0f);
    default:
        return (float)((random_uniform(&dice) - 0.5) * 2.0 * (double)limit);
    }
}

/* A random float of 0 or above. */
static float draw_sigma(float limit)
{
    float value = draw_float(limit);

    return value > 0.0f ? value : random_number_below(2) ? 0.0f : limit / 3.0f;
}

static struct sent *add_sent_message(const char *prefix, int sensor_id, int64_t utime)
{
    struct sent *message = &sent[num_sent++];

    assert_true(num_sent <= MAX_MESSAGES);
    message->utime = utime;
    if (sensor_id == INT32_MAX) {
        strcpy(message->channel, prefix);
    } else {
        sprintf(message->channel, "%s%d", prefix, sensor_id);
    }
    return message;
}

#define ENCODE(struct_name, message, to)                                                           \
    do {                                                                                           \
        struct sent *at = (to);                                                                    \
        assert_int_equal(rho_message_##struct_name##_validate(message, NULL), RHO_OK);             \
        assert_int_equal(                                                                          \
            rho_message_##struct_name##_encode(message, at->data, sizeof at->data, &at->size),     \
            RHO_OK);                                                                               \
    } while (0)

static int number_of_parts(int count, int most)
{
    return count > most ? (count + most - 1) / most : 1;
}

static int number_in_part(int count, int most, int part)
{
    int rest = count - part * most;

    return rest < most ? rest : most;
}

/*
 * Random times of plots after their scan, ascending. In half of the scans all are at the scan's
 * time.
 */
static void draw_plot_times(int32_t *dt_us, int count)
{
    bool has_own = random_number_below(2);
    int32_t at_us = has_own && random_number_below(2) ? -(int32_t)random_number_below(1000000) : 0;

    for (int i = 0; i < count; i++) {
        dt_us[i] = at_us;
        at_us += has_own ? (int32_t)random_number_below(20000) : 0;
    }
}

static void add_sent_plot_scan(int sensor_id, int32_t scan, int64_t utime)
{
    static const int8_t kinds[] = {2, 3, 4, 6};
    int32_t dt_us[100];
    int count = random_number_below(3) ? (int)random_number_below(100) : 0,
        parts = number_of_parts(count, RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS);
    struct rho_message_plot_scan message = {
        .utime = utime,
        .scan = scan,
        .epoch = 7 + sensor_id,
        .sensor_id = (int16_t)sensor_id,
        .kind = count ? kinds[random_number_below(4)] : 2,
        .num_parts = (int16_t)parts,
        .sector_from_rad = random_number_below(2) ? 0.0f : draw_float(6.2f),
        .sector_to_rad = random_number_below(2) ? 0.0f : draw_float(6.2f)};

    draw_plot_times(dt_us, count);
    for (int part = 0; part < parts; part++) {
        message.part = (int16_t)part;
        message.num_plots = (int16_t)number_in_part(count, RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS, part);
        for (int i = 0; i < message.num_plots; i++) {
            bool has_velocity = message.kind >= 4, has_height = message.kind % 3 == 0;

            message.plots[i] = (struct rho_message_plot){
                .dt_us = dt_us[part * RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS + i],
                .x_m = draw_float(2e6f),
                .y_m = draw_float(2e6f),
                .z_m = has_height ? draw_float(2e6f) : 0.0f,
                .vx_mps = has_velocity ? draw_float(2e4f) : 0.0f,
                .vy_mps = has_velocity ? draw_float(2e4f) : 0.0f,
                .vz_mps = has_velocity ? draw_float(2e4f) : 0.0f,
                .sigma_m = draw_sigma(1e5f),
                .sigma_mps = draw_sigma(1e5f),
                .snr_db = draw_float(1000.0f)};
        }
        ENCODE(plot_scan, &message, add_sent_message("RHO_PLOTS_", sensor_id, utime));
    }
}

/* each part has its own sigmas; only then may a part end before it is full */
static void add_sent_polar_scan(int sensor_id, int32_t scan, int64_t utime)
{
    int parts = 1 + (int)random_number_below(4);
    int32_t dt_us[4 * RHO_MESSAGE_POLAR_SCAN_MAX_POLAR_PLOTS], *own_us = dt_us;
    struct rho_message_polar_scan message = {
        .utime = utime,
        .scan = scan,
        .epoch = -1,
        .sensor_id = (int16_t)sensor_id,
        .has_elevation = (int8_t)random_number_below(2),
        .has_range_rate = (int8_t)random_number_below(2),
        .num_parts = (int16_t)parts,
        .sensor_x_m = draw_float(2e6f),
        .sensor_y_m = random_number_below(2) ? 0.0f : draw_float(2e6f),
        .sensor_z_m = random_number_below(2) ? 0.0f : draw_float(2e6f)};

    draw_plot_times(dt_us, 4 * RHO_MESSAGE_POLAR_SCAN_MAX_POLAR_PLOTS);
    for (int part = 0; part < parts; part++) {
        message.part = (int16_t)part;
        message.num_polar_plots =
            1 + (int16_t)random_number_below(RHO_MESSAGE_POLAR_SCAN_MAX_POLAR_PLOTS);
        message.sigma_range_m = 10.0f + (float)part;
        message.sigma_azimuth_rad = draw_sigma(0.5f);
        message.sigma_elevation_rad = draw_sigma(0.5f);
        message.sigma_range_rate_mps = draw_sigma(1e5f);
        for (int i = 0; i < message.num_polar_plots; i++) {
            message.polar_plots[i] = (struct rho_message_polar_plot){
                .dt_us = *own_us++,
                .range_m = draw_sigma(2e6f),
                .azimuth_rad = draw_float(3.1415927f),
                .elevation_rad = message.has_elevation ? draw_float(1.5707964f) : 0.0f,
                .range_rate_mps = message.has_range_rate ? draw_float(2e4f) : 0.0f,
                .snr_db = draw_float(1000.0f)};
        }
        ENCODE(polar_scan, &message, add_sent_message("RHO_POLAR_", sensor_id, utime));
    }
}

static void add_sent_bearing_scan(int sensor_id, int32_t scan, int64_t utime)
{
    struct rho_message_bearing_scan message = {
        .utime = utime,
        .scan = scan,
        .epoch = 5,
        .sensor_id = (int16_t)sensor_id,
        .sensor_x_m = (float)sensor_id * 1e6f,
        .sensor_y_m = 0.1f,
        .sigma_rad = draw_sigma(0.5f),
        .num_bearings = (int16_t)random_number_below(RHO_MESSAGE_BEARING_SCAN_MAX_BEARING_RAD + 1)};

    for (int i = 0; i < message.num_bearings; i++) {
        message.bearing_rad[i] = draw_float(3.1415927f);
    }
    ENCODE(bearing_scan, &message, add_sent_message("RHO_BEARINGS_", sensor_id, utime));
}

static void add_sent_direction_scan(int sensor_id, int32_t scan, int64_t utime)
{
    struct rho_message_direction_scan message = {
        .utime = utime,
        .scan = scan,
        .epoch = 5,
        .sensor_id = (int16_t)sensor_id,
        .sensor_x_m = draw_float(2e6f),
        .sensor_y_m = draw_float(2e6f),
        .sensor_z_m = draw_float(2e6f),
        .sigma_rad = draw_sigma(0.5f),
        .sigma_elevation_rad = draw_sigma(0.5f),
        .num_directions =
            (int16_t)random_number_below(RHO_MESSAGE_DIRECTION_SCAN_MAX_DIRECTIONS + 1)};
    int32_t dt_us = -(int32_t)random_number_below(2);

    if (random_number_below(2)) {
        message.sector_from_rad = draw_float(6.2831855f);
        message.sector_to_rad = draw_float(6.2831855f);
    }
    for (int i = 0; i < message.num_directions; i++) {
        const bool has_elevation = random_number_below(2);

        message.directions[i] = (struct rho_message_direction){
            .dt_us = dt_us,
            .bearing_rad = draw_float(3.1415927f),
            .elevation_rad = has_elevation ? draw_float(1.5707964f) : 0.0f,
            .snr_db = draw_float(1000.0f),
            .has_elevation = (int8_t)has_elevation};
        dt_us += (int32_t)random_number_below(3);
    }
    ENCODE(direction_scan, &message, add_sent_message("RHO_DIRECTIONS_", sensor_id, utime));
}

static void add_sent_truth_list(int sensor_id, int32_t scan, int64_t utime)
{
    int count = 1 + (int)random_number_below(120),
        parts = number_of_parts(count, RHO_MESSAGE_TRUTH_LIST_MAX_TARGETS);
    struct rho_message_truth_list message = {
        .utime = utime, .scan = scan, .num_parts = (int16_t)parts};

    (void)sensor_id;
    for (int part = 0; part < parts; part++) {
        message.part = (int16_t)part;
        message.num_targets =
            (int16_t)number_in_part(count, RHO_MESSAGE_TRUTH_LIST_MAX_TARGETS, part);
        for (int i = 0; i < message.num_targets; i++) {
            message.targets[i] =
                (struct rho_message_truth){.target_id = (int32_t)random_bits(&dice),
                                           .x_m = draw_float(2e6f),
                                           .y_m = draw_float(2e6f),
                                           .z_m = draw_float(2e6f),
                                           .vx_mps = draw_float(2e4f),
                                           .vy_mps = draw_float(2e4f),
                                           .vz_mps = draw_float(2e4f)};
        }
        ENCODE(truth_list, &message, add_sent_message("RHO_TRUTH", INT32_MAX, utime));
    }
}

static struct rho_message_track draw_track(void)
{
    struct rho_message_track track = {.track_id = (int32_t)random_bits(&dice),
                                      .status = (int8_t)(1 + random_number_below(4)),
                                      .hits = (int16_t)random_number_below(32768),
                                      .misses = (int16_t)random_number_below(32768),
                                      .sensor_id =
                                          (int16_t)((int)random_number_below(65536) - 32768),
                                      .plot = (int16_t)((int)random_number_below(32769) - 1),
                                      .update_age_us = (int32_t)random_number_below(2147483648u),
                                      .x_m = draw_float(3e38f),
                                      .y_m = draw_float(3e38f),
                                      .z_m = draw_float(3e38f),
                                      .vx_mps = draw_float(3e38f),
                                      .vy_mps = draw_float(3e38f),
                                      .vz_mps = draw_float(3e38f),
                                      .ax_mps2 = draw_float(3e38f),
                                      .ay_mps2 = draw_float(3e38f),
                                      .az_mps2 = draw_float(3e38f),
                                      .score_nat = draw_float(3e38f),
                                      .maneuver_probability = draw_sigma(1.0f)};

    for (int i = 0; i < 21; i++) {
        track.covariance[i] = draw_float(1e6f);
    }
    return track;
}

static void add_sent_track_list(int sensor_id, int32_t scan, int64_t utime)
{
    int count = 1 + (int)random_number_below(30),
        parts = number_of_parts(count, RHO_MESSAGE_TRACK_LIST_MAX_TRACKS);
    struct rho_message_track_list message = {.utime = utime,
                                             .scan = scan,
                                             .epoch = 3,
                                             .num_tracks_total = (int16_t)count,
                                             .num_parts = (int16_t)parts};

    (void)sensor_id;
    for (int part = 0; part < parts; part++) {
        message.part = (int16_t)part;
        message.num_tracks =
            (int16_t)number_in_part(count, RHO_MESSAGE_TRACK_LIST_MAX_TRACKS, part);
        for (int i = 0; i < message.num_tracks; i++) {
            message.tracks[i] = draw_track();
        }
        ENCODE(track_list, &message, add_sent_message("RHO_TRACKS", INT32_MAX, utime));
    }
}

/* Writes the messages as a CSV file, in an order that a network may deliver them in. */
static void write_sent_messages_as_csv(const char *path, const struct rows_kind *kind,
                                       bool is_shuffled)
{
    struct rows_collection collection;
    size_t order[MAX_MESSAGES];
    FILE *file = fopen(path, "w");
    char reason[ROWS_FROM_MESSAGES_REASON_BYTES];

    assert_non_null(file);
    rows_from_messages_start(&collection, kind);
    for (size_t i = 0; i < num_sent; i++) {
        size_t other = is_shuffled ? random_number_below(i + 1) : i;

        order[i] = order[other];
        order[other] = i;
    }
    for (size_t i = 0; i < num_sent; i++) {
        const struct sent *message = &sent[order[i]];

        assert_null(rows_from_messages_add(&collection, message->channel, message->data,
                                           message->size, reason));
    }
    rows_from_messages_sort(&collection);
    assert_int_equal(collection.messages_again, 0);
    assert_int_equal(collection.scans_incomplete, 0);
    rows_write_csv(file, &collection.rows, true);
    fclose(file);
    rows_from_messages_free(&collection);
}

static void assert_csv_gives_sent_messages(char *path)
{
    struct message_source *source;
    struct message_event event;
    struct parameters parameters;

    parameters_set_defaults(&parameters);
    source = message_source_open(&path, 1, &parameters, false);
    for (size_t i = 0; i < num_sent; i++) {
        assert_true(message_source_next(source, &event));
        assert_true(event.utime == sent[i].utime);
        assert_string_equal(event.channel, sent[i].channel);
        assert_int_equal(event.size, sent[i].size);
        assert_memory_equal(event.data, sent[i].data, event.size);
    }
    assert_false(message_source_next(source, &event));
    message_source_close(source);
}

static void check_round_trip(int kind, void (*send)(int sensor_id, int32_t scan, int64_t utime),
                             bool is_shuffled)
{
    char path[] = "/tmp/rhotrack-convert-XXXXXX";

    close(mkstemp(path));
    for (int round = 0; round < 40; round++) {
        int64_t utime = (int64_t)random_number_below(7999999000000000000u) - 3999999500000000000;

        dice = random_start(3, (uint64_t)kind, (uint64_t)round);
        num_sent = 0;
        for (int i = 0; i < 30; i++) {
            send(i % 3 - 1, (int32_t)(INT32_MAX - 2 + (uint32_t)i / 3), utime);
            utime += 1 + (int64_t)random_number_below(1000000);
        }
        write_sent_messages_as_csv(path, rows_kinds[kind], is_shuffled);
        assert_csv_gives_sent_messages(path);
    }
    unlink(path);
}

static void plots_survive_the_round_trip_through_csv(void **state)
{
    (void)state;
    check_round_trip(ROWS_PLOTS, add_sent_plot_scan, false);
}

static void polar_plots_survive_the_round_trip_through_csv(void **state)
{
    (void)state;
    check_round_trip(ROWS_POLAR, add_sent_polar_scan, false);
}

static void bearings_survive_the_round_trip_through_csv(void **state)
{
    (void)state;
    check_round_trip(ROWS_BEARINGS, add_sent_bearing_scan, false);
    check_round_trip(ROWS_BEARINGS, add_sent_direction_scan, false);
}

static void truth_survives_the_round_trip_through_csv(void **state)
{
    (void)state;
    check_round_trip(ROWS_TRUTH, add_sent_truth_list, false);
}

static void tracks_survive_the_round_trip_through_csv(void **state)
{
    (void)state;
    check_round_trip(ROWS_TRACKS, add_sent_track_list, false);
}

static void parts_in_any_order_are_written_in_the_right_order(void **state)
{
    (void)state;
    check_round_trip(ROWS_PLOTS, add_sent_plot_scan, true);
    check_round_trip(ROWS_POLAR, add_sent_polar_scan, true);
    check_round_trip(ROWS_TRACKS, add_sent_track_list, true);
}

static void write_text(char *path, const char *text)
{
    int file;

    strcpy(path, "/tmp/rhotrack-convert-XXXXXX");
    file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, text, strlen(text)), (long)strlen(text));
    close(file);
}

/*
 * A message of plots as "time in ms:sensor#scan/epoch(plots)"; any other message as its channel's
 * name.
 */
static const char *describe_message(const struct message_event *event, char *text)
{
    struct rho_message_plot_scan plots;

    if (rho_message_plot_scan_decode(event->data, event->size, &plots) != RHO_OK) {
        sprintf(text, "%ld:%s ", (long)(event->utime / 1000), event->channel);
    } else {
        sprintf(text, "%ld:%d#%d/%d(%d) ", (long)(event->utime / 1000), plots.sensor_id, plots.scan,
                plots.epoch, plots.num_plots);
        assert_true(event->utime == plots.utime);
    }
    return text;
}

static const char *describe_all_messages(char *const *paths, int num_paths, double interval_s,
                                         bool keep_going)
{
    static char text[2000];
    char one[100];
    struct message_event event;
    struct message_source *source;
    struct parameters parameters;

    parameters_set_defaults(&parameters);
    parameters.value[PARAMETER_SCAN_INTERVAL_S] = interval_s;
    source = message_source_open(paths, num_paths, &parameters, keep_going);
    text[0] = '\0';
    while (message_source_next(source, &event)) {
        strcat(text, describe_message(&event, one));
    }
    message_source_close(source);
    return text;
}

static void assert_csv_gives(const char *csv, double interval_s, const char *expected)
{
    char path[40], *paths[] = {path};

    write_text(path, csv);
    assert_string_equal(describe_all_messages(paths, 1, interval_s, false), expected);
    unlink(path);
}

#define HEADER "t_s,sensor_id,x_m,y_m\n"
#define NUMBERED "t_s,sensor_id,x_m,y_m,scan,epoch\n"

static void rows_of_one_time_form_a_scan(void **state)
{
    (void)state;
    assert_csv_gives(HEADER "1,4,1,1\n1,5,1,1\n1,4,1,1\n2,5,,\n2,4,1,1\n", 0.0,
                     "1000:4#1/1(2) 1000:5#1/1(1) 2000:5#2/1(0) 2000:4#2/1(1) ");
}

#define BEARINGS "t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad"

static void bearings_that_say_more_are_directions(void **state)
{
    (void)state;
    assert_csv_gives(BEARINGS "\n1,4,0,0,1\n1,5,9,0,1\n2,4,0,0,\n", 1.0,
                     "1000:RHO_BEARINGS_4 1000:RHO_BEARINGS_5 2000:RHO_BEARINGS_4 ");
    assert_csv_gives(BEARINGS ",elevation_rad,sensor_z_m,sector_from_rad,sector_to_rad,snr_db\n"
                              "1,4,0,0,1,,0,0,0,0\n",
                     0.0, "1000:RHO_BEARINGS_4 ");
    assert_csv_gives(BEARINGS ",elevation_rad\n1,4,0,0,1,\n2,4,0,0,1,0\n", 0.0,
                     "1000:RHO_DIRECTIONS_4 2000:RHO_DIRECTIONS_4 ");
    assert_csv_gives(BEARINGS ",sensor_z_m\n1,4,0,0,1,3\n", 0.0, "1000:RHO_DIRECTIONS_4 ");
    assert_csv_gives(BEARINGS ",sector_from_rad,sector_to_rad\n1,4,0,0,1,0,2\n", 0.0,
                     "1000:RHO_DIRECTIONS_4 ");
    assert_csv_gives(BEARINGS ",snr_db\n1,4,0,0,1,-2\n", 0.0, "1000:RHO_DIRECTIONS_4 ");
    assert_csv_gives(BEARINGS "\n1,4,0,0,1\n2,4,0,0.5,1\n", 0.0,
                     "1000:RHO_DIRECTIONS_4 2000:RHO_DIRECTIONS_4 ");
    assert_csv_gives(BEARINGS "\n1,4,0,0,1\n1.5,4,0,0,1\n", 1.0, "1000:RHO_DIRECTIONS_4 ");
}

static void rows_within_scan_interval_form_a_scan(void **state)
{
    (void)state;
    assert_csv_gives(HEADER "1,4,,\n1.5,4,1,1\n2,5,1,1\n4.9,4,1,1\n5,4,1,1\n6,5,1,1\n", 4.0,
                     "1000:4#1/1(2) 2000:5#1/1(1) 5000:4#2/1(1) 6000:5#2/1(1) ");
}

static void rows_of_one_scan_number_form_a_scan(void **state)
{
    (void)state;
    assert_csv_gives(NUMBERED "1,4,1,1,7,1\n2,4,1,1,8,1\n3,4,1,1,7,1\n4,5,1,1,7,1\n5,4,1,1,8,2\n",
                     0.0, "1000:4#7/1(2) 2000:4#8/1(1) 4000:5#7/1(1) 5000:4#8/2(1) ");
}

/* A scan number that appears again after a minute is another scan: the counter was restarted. */
static void a_scan_number_used_again_later_is_another_scan(void **state)
{
    (void)state;
    assert_csv_gives(NUMBERED "0,4,1,1,7,1\n60,4,1,1,7,1\n60.000001,4,1,1,7,1\n", 0.0,
                     "0:4#7/1(2) 60000:4#7/1(1) ");
}

static void a_row_without_a_plot_sets_the_time_of_its_scan(void **state)
{
    (void)state;
    assert_csv_gives(NUMBERED "1,4,1,1,7,1\n2,4,,,7,1\n3,4,1,1,7,1\n", 0.0, "2000:4#7/1(2) ");
}

static void a_new_epoch_restarts_the_scan_counter(void **state)
{
    (void)state;
    assert_csv_gives("t_s,sensor_id,x_m,y_m,epoch\n1,4,1,1,6\n2,4,1,1,6\n3,4,1,1,9\n", 0.0,
                     "1000:4#1/6(1) 2000:4#2/6(1) 3000:4#1/9(1) ");
}

/* Steps of two sensors at one time report the tracks twice. */
static void a_track_id_repeated_at_one_time_begins_a_new_list(void **state)
{
    char path[40], *name = path;
    static const int expected[][2] = {{1, 2}, {2, 3}, {3, 1}};
    struct parameters parameters;
    struct message_source *source;
    struct message_event event;
    (void)state;

    parameters_set_defaults(&parameters);
    write_text(path, "t_s,track_id,status,x_m,y_m\n1,1,confirmed,0,0\n1,2,tentative,0,0\n"
                     "1,1,confirmed,0,0\n1,2,coasting,0,0\n1,3,tentative,0,0\n2,1,deleted,0,0\n");
    source = message_source_open(&name, 1, &parameters, false);
    for (int i = 0; i < 3; i++) {
        struct rho_message_track_list tracks;

        assert_true(message_source_next(source, &event));
        assert_int_equal(rho_message_track_list_decode(event.data, event.size, &tracks), RHO_OK);
        assert_int_equal(tracks.scan, expected[i][0]);
        assert_int_equal(tracks.num_tracks, expected[i][1]);
        assert_int_equal(tracks.num_tracks_total, expected[i][1]);
        assert_int_equal(tracks.tracks[0].plot, -1);
    }
    assert_false(message_source_next(source, &event));
    message_source_close(source);
    unlink(path);
}

static void files_are_merged_by_time(void **state)
{
    char first[40], second[40], third[48], *paths[] = {first, second, third};
    struct lcm_log_writer writer;
    (void)state;

    write_text(first, HEADER "1,4,1,1\n3,4,1,1\n4,4,1,1\n");
    write_text(second, HEADER "0,5,1,1\n3,5,1,1\n");
    write_text(third, "");
    writer = (struct lcm_log_writer){.file = fopen(third, "w")};
    assert_true(lcm_log_write(&writer, 2000000, "ANY", (const uint8_t *)"x", 1));
    assert_true(lcm_log_write(&writer, 500000, "LATE", (const uint8_t *)"x", 1));
    assert_true(lcm_log_write(&writer, 3000000, "END", (const uint8_t *)"x", 1));
    fclose(writer.file);
    assert_string_equal(describe_all_messages(paths, 3, 0.0, false),
                        "0:5#1/1(1) 1000:4#1/1(1) 2000:ANY 500:LATE 3000:4#2/1(1) 3000:5#2/1(1) "
                        "3000:END 4000:4#3/1(1) ");
    for (int i = 0; i < 3; i++) {
        unlink(paths[i]);
    }
}

static void keep_going_skips_bad_rows(void **state)
{
    char path[40], *paths[] = {path};
    (void)state;

    write_text(path, HEADER "1,4,1,1\n1,4,x,1\n1,40000,1,1\n0,4,1,1\n1,4,3e6,1\n1,4,1\n2,4,1,1\n");
    assert_string_equal(describe_all_messages(paths, 1, 0.0, true), "1000:4#1/1(1) 2000:4#2/1(1) ");
    unlink(path);
}

/*
 * 100 plots of a scan, every other one with another sigma: each change begins a part, and the order
 * is kept.
 */
static void messages_of_parts_keep_the_order_of_rows(void **state)
{
    char text[8000] = "t_s,sensor_id,range_m,azimuth_rad,sigma_range_m\n", path[40], *name = path;
    struct rho_message_polar_scan scan;
    struct message_source *source;
    struct message_event event;
    struct parameters parameters;
    int plot = 0;
    (void)state;

    for (int i = 0; i < 200; i++) {
        sprintf(text + strlen(text), "1,4,%d,0,%d\n", i + 1, i < 120 ? 9 : 8 + i % 2);
    }
    write_text(path, text);
    parameters_set_defaults(&parameters);
    source = message_source_open(&name, 1, &parameters, false);
    for (int part = 0; message_source_next(source, &event); part++) {
        assert_int_equal(rho_message_polar_scan_decode(event.data, event.size, &scan), RHO_OK);
        assert_int_equal(scan.part, part);
        /* parts of 54, 54, 12 plots, and 80 parts of one plot */
        assert_int_equal(scan.num_parts, 83);
        for (int i = 0; i < scan.num_polar_plots; i++) {
            assert_true(scan.polar_plots[i].range_m == (float)++plot);
        }
    }
    assert_int_equal(plot, 200);
    message_source_close(source);
    unlink(path);
}

static void rows_from_messages_counts_doubles_and_refuses_bad_messages(void **state)
{
    struct rows_collection collection;
    char reason[ROWS_FROM_MESSAGES_REASON_BYTES];
    (void)state;

    dice = random_start(1, 0, 0);
    num_sent = 0;
    while (num_sent < 3) { /* draws until one scan has several parts */
        num_sent = 0;
        add_sent_plot_scan(4, 1, 1000);
    }
    rows_from_messages_start(&collection, &rows_kind_plots);
    for (size_t i = 0; i < 2; i++) {
        assert_null(
            rows_from_messages_add(&collection, "RHO_PLOTS_4", sent[0].data, sent[0].size, reason));
    }
    assert_string_equal(
        rows_from_messages_add(&collection, "RHO_PLOTS_5", sent[1].data, sent[1].size, reason),
        "sensor_id is not that of the channel");
    assert_string_equal(
        rows_from_messages_add(&collection, "RHO_PLOTS_4", sent[1].data, sent[1].size - 1, reason),
        "too short for a plot_scan_t");
    assert_string_equal(
        rows_from_messages_add(&collection, "RHO_PLOTS_4", sent[1].data, sent[1].size + 1, reason),
        "too long for a plot_scan_t");
    sent[1].data[0] ^= 1;
    assert_string_equal(
        rows_from_messages_add(&collection, "RHO_PLOTS_4", sent[1].data, sent[1].size, reason),
        "not a plot_scan_t, or of another version");
    sent[1].data[0] ^= 1;
    sent[1].data[26] = 1; /* changes the kind */
    assert_string_equal(
        rows_from_messages_add(&collection, "RHO_PLOTS_4", sent[1].data, sent[1].size, reason),
        "kind is outside the range of a plot_scan_t");
    rows_from_messages_sort(&collection);
    assert_int_equal(collection.messages_again, 1);
    assert_int_equal(collection.scans_incomplete, 1);
    assert_int_equal(collection.rows.count, RHO_MESSAGE_PLOT_SCAN_MAX_PLOTS);
    rows_from_messages_free(&collection);
}

static void channel_names_tell_the_kind_of_rows(void **state)
{
    (void)state;
    assert_ptr_equal(rows_kind_of_channel("RHO_PLOTS_0"), &rows_kind_plots);
    assert_ptr_equal(rows_kind_of_channel("RHO_POLAR_-32768"), &rows_kind_polar);
    assert_ptr_equal(rows_kind_of_channel("RHO_BEARINGS_32767"), &rows_kind_bearings);
    assert_ptr_equal(rows_kind_of_channel("RHO_DIRECTIONS_7"), &rows_kind_bearings);
    assert_null(rows_kind_of_channel("RHO_DIRECTIONS_07"));
    assert_ptr_equal(rows_kind_of_channel("RHO_TRUTH"), &rows_kind_truth);
    assert_ptr_equal(rows_kind_of_channel("RHO_TRACKS"), &rows_kind_tracks);
    assert_null(rows_kind_of_channel("RHO_PLOTS_"));
    assert_null(rows_kind_of_channel("RHO_PLOTS_01"));
    assert_null(rows_kind_of_channel("RHO_PLOTS_+1"));
    assert_null(rows_kind_of_channel("RHO_PLOTS_32768"));
    assert_null(rows_kind_of_channel("RHO_PLOTS_99999999999999999999"));
    assert_null(rows_kind_of_channel("RHO_PLOTS_1 "));
    assert_null(rows_kind_of_channel("RHO_TRACKS2"));
    assert_null(rows_kind_of_channel("RHO_STATUS"));
    assert_null(rows_kind_of_channel(""));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plots_survive_the_round_trip_through_csv),
        cmocka_unit_test(polar_plots_survive_the_round_trip_through_csv),
        cmocka_unit_test(bearings_survive_the_round_trip_through_csv),
        cmocka_unit_test(truth_survives_the_round_trip_through_csv),
        cmocka_unit_test(tracks_survive_the_round_trip_through_csv),
        cmocka_unit_test(parts_in_any_order_are_written_in_the_right_order),
        cmocka_unit_test(rows_of_one_time_form_a_scan),
        cmocka_unit_test(bearings_that_say_more_are_directions),
        cmocka_unit_test(rows_within_scan_interval_form_a_scan),
        cmocka_unit_test(rows_of_one_scan_number_form_a_scan),
        cmocka_unit_test(a_scan_number_used_again_later_is_another_scan),
        cmocka_unit_test(a_row_without_a_plot_sets_the_time_of_its_scan),
        cmocka_unit_test(a_new_epoch_restarts_the_scan_counter),
        cmocka_unit_test(a_track_id_repeated_at_one_time_begins_a_new_list),
        cmocka_unit_test(files_are_merged_by_time),
        cmocka_unit_test(keep_going_skips_bad_rows),
        cmocka_unit_test(messages_of_parts_keep_the_order_of_rows),
        cmocka_unit_test(rows_from_messages_counts_doubles_and_refuses_bad_messages),
        cmocka_unit_test(channel_names_tell_the_kind_of_rows),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
