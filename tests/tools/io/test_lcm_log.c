/* SPDX-License-Identifier: MIT */
/* LCM logs: hand-written bytes, round trips, and the events found after every kind of damage. */
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

#define MAX_BYTES (1u << 20)

/* The log that a test puts together. */
struct bytes {
    uint8_t data[MAX_BYTES];
    size_t size;
};
static struct bytes the_log;

static void append_bytes(struct bytes *bytes, const void *data, size_t size)
{
    assert_true(bytes->size + size <= MAX_BYTES);
    memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
}

static void append_number(struct bytes *bytes, uint64_t value, int size)
{
    for (int i = size - 1; i >= 0; i--) {
        uint8_t byte = (uint8_t)(value >> (8 * i));

        append_bytes(bytes, &byte, 1);
    }
}

/* Appends an event in the format of the specification, with lengths that may be wrong. */
static void append_event_with_lengths(struct bytes *bytes, int64_t number, const char *channel,
                                      const char *data, uint32_t channel_length,
                                      uint32_t data_length)
{
    append_number(bytes, 0xEDA1DA01u, 4);
    append_number(bytes, (uint64_t)number, 8);
    append_number(bytes, (uint64_t)(1000 + number), 8);
    append_number(bytes, channel_length, 4);
    append_number(bytes, data_length, 4);
    append_bytes(bytes, channel, strlen(channel));
    append_bytes(bytes, data, strlen(data));
}

static void append_event(struct bytes *bytes, int64_t number, const char *channel, const char *data)
{
    append_event_with_lengths(bytes, number, channel, data, (uint32_t)strlen(channel),
                              (uint32_t)strlen(data));
}

static void append_skip_text(char *text, size_t skipped)
{
    if (skipped > 0) {
        sprintf(text + strlen(text), "-%zu ", skipped);
    }
}

static const char *events_found_as_text(const uint8_t *data, size_t size)
{
    static char text[4000];
    size_t at = 0, skipped = 0, count;
    struct lcm_log_event event;

    text[0] = '\0';
    while (at < size) {
        /* memory of exactly this size, so that a sanitizer sees every byte read behind it */
        uint8_t *exact = malloc(size - at);
        enum lcm_log_found found;

        memcpy(exact, data + at, size - at);
        found = lcm_log_parse(exact, size - at, true, &event, &count);
        assert_int_not_equal(found, LCM_LOG_MORE);
        assert_true(count > 0 && count <= size - at);
        if (found == LCM_LOG_EVENT) {
            append_skip_text(text, skipped);
            skipped = 0;
            sprintf(text + strlen(text), "%ld:%s:%.*s ", (long)event.number, event.channel,
                    (int)event.size, (const char *)event.data);
        } else {
            skipped += count;
        }
        free(exact);
        at += count;
    }
    append_skip_text(text, skipped);
    return text;
}

static void assert_events_found(const char *expected)
{
    assert_string_equal(events_found_as_text(the_log.data, the_log.size), expected);
}

static int clear_the_log(void **state)
{
    (void)state;
    the_log.size = 0;
    return 0;
}

static void write_the_log(char *path)
{
    int file;

    strcpy(path, "/tmp/rhotrack-log-XXXXXX");
    file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, the_log.data, the_log.size), (long)the_log.size);
    close(file);
}

static const uint8_t reference[] = {
    0xED, 0xA1, 0xDA, 0x01,                         /* sync word */
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x07, /* number */
    0x00, 0x06, 0x0A, 0x24, 0x18, 0x1E, 0x40, 0x03, /* utime */
    0x00, 0x00, 0x00, 0x02,                         /* length of the channel's name */
    0x00, 0x00, 0x00, 0x03,                         /* length of the data */
    'A',  'B',  0xFF, 0x00, 0x7F,
};

static void hand_written_bytes_are_parsed_as_an_event(void **state)
{
    struct lcm_log_event event;
    size_t count = 0;
    (void)state;

    assert_int_equal(lcm_log_parse(reference, sizeof reference, true, &event, &count),
                     LCM_LOG_EVENT);
    assert_int_equal(count, sizeof reference);
    assert_int_equal(event.number, 7);
    assert_int_equal(event.utime, INT64_C(0x00060A24181E4003));
    assert_string_equal(event.channel, "AB");
    assert_int_equal(event.size, 3);
    assert_memory_equal(event.data, "\xFF\0\x7F", 3);
}

static void the_writer_writes_the_hand_written_bytes(void **state)
{
    char *text = NULL;
    size_t size = 0;
    struct lcm_log_writer writer = {.file = open_memstream(&text, &size), .number = 7};
    (void)state;

    assert_true(lcm_log_write(&writer, INT64_C(0x00060A24181E4003), "AB",
                              (const uint8_t *)"\xFF\0\x7F", 3));
    fclose(writer.file);
    assert_int_equal(writer.number, 8);
    assert_int_equal(size, sizeof reference);
    assert_memory_equal(text, reference, size);
    free(text);
}

static void the_writer_refuses_bad_channels_and_sizes(void **state)
{
    char *text = NULL, channel[LCM_LOG_MAX_CHANNEL + 2];
    size_t size = 0;
    struct lcm_log_writer writer = {.file = open_memstream(&text, &size)};
    (void)state;

    memset(channel, 'c', sizeof channel);
    channel[sizeof channel - 1] = '\0';
    assert_false(lcm_log_write(&writer, 0, "", reference, 1));
    assert_false(lcm_log_write(&writer, 0, channel, reference, 1));
    assert_false(lcm_log_write(&writer, 0, "A", reference, (size_t)LCM_LOG_MAX_DATA + 1));
    assert_true(lcm_log_write(&writer, 0, channel + 1, NULL, 0));
    fclose(writer.file);
    assert_int_equal(writer.number, 1);
    assert_int_equal(size, LCM_LOG_HEADER_BYTES + LCM_LOG_MAX_CHANNEL);
    free(text);
}

static void the_writer_reports_a_full_disk(void **state)
{
    struct lcm_log_writer writer = {.file = fopen("/dev/full", "w")};
    static uint8_t data[1 << 16];
    (void)state;

    assert_non_null(writer.file);
    assert_false(lcm_log_write(&writer, 0, "A", data, sizeof data));
    fclose(writer.file);
}

static void negative_numbers_and_times_are_read_back(void **state)
{
    static const int64_t values[] = {0, -1, INT64_MIN, INT64_MAX, -4000000000000000000};
    struct lcm_log_event event;
    char *text = NULL;
    size_t size = 0, count;
    (void)state;

    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        struct lcm_log_writer writer = {.file = open_memstream(&text, &size),
                                        .number = i ? values[i] : 0};

        assert_true(lcm_log_write(&writer, values[i], "A", NULL, 0));
        fclose(writer.file);
        assert_int_equal(lcm_log_parse((uint8_t *)text, size, true, &event, &count), LCM_LOG_EVENT);
        assert_true(event.number == values[i] && event.utime == values[i]);
        free(text);
    }
}

static void all_events_of_an_intact_log_are_found(void **state)
{
    (void)state;
    append_event(&the_log, 0, "A", "one");
    append_event(&the_log, 1, "LONGER", "");
    append_event(&the_log, 2, "A", "three");
    assert_events_found("0:A:one 1:LONGER: 2:A:three ");
}

static void garbage_around_events_is_skipped(void **state)
{
    (void)state;
    append_bytes(&the_log, "garbage", 7);
    append_event(&the_log, 0, "A", "one");
    append_bytes(&the_log, "x", 1);
    append_event(&the_log, 1, "A", "two");
    append_bytes(&the_log, "\xED\xA1\xDA", 3); /* three bytes of a sync word */
    append_event(&the_log, 2, "A", "three");
    append_bytes(&the_log, "\0\0", 2);
    assert_events_found("-7 0:A:one -1 1:A:two -3 2:A:three -2 ");
}

static void a_truncated_log_keeps_its_whole_events(void **state)
{
    size_t whole;
    (void)state;

    append_event(&the_log, 0, "A", "one");
    whole = the_log.size;
    append_event(&the_log, 1, "A", "two");
    for (size_t size = whole; size < the_log.size; size++) {
        char expected[40] = "0:A:one ";

        append_skip_text(expected, size - whole);
        assert_string_equal(events_found_as_text(the_log.data, size), expected);
    }
}

/* Whatever bytes are cut out of the middle, the events around them are found. */
static void bytes_cut_out_lose_only_the_event_they_belong_to(void **state)
{
    static const char *const whole = "0:A:zero 1:B:one 2:C:two 3:D:three ";
    size_t ends[5] = {0};
    (void)state;

    for (int i = 0; i < 4; i++) {
        append_event(&the_log, i, (const char *[]){"A", "B", "C", "D"}[i],
                     (const char *[]){"zero", "one", "two", "three"}[i]);
        ends[i + 1] = the_log.size;
    }
    assert_events_found(whole);
    for (size_t from = ends[1]; from < ends[2]; from++) {
        for (size_t to = from + 1; to <= ends[2]; to++) {
            struct bytes *holed = malloc(sizeof *holed);
            const char *found;

            holed->size = 0;
            append_bytes(holed, the_log.data, from);
            append_bytes(holed, the_log.data + to, the_log.size - to);
            found = events_found_as_text(holed->data, holed->size);
            assert_ptr_equal(strstr(found, "0:A:zero "), found);
            assert_non_null(strstr(found, "2:C:two 3:D:three "));
            free(holed);
        }
    }
}

/*
 * Every value of every header byte, but for lengths that end exactly at another event: that could
 * be a log inside an event.
 */
static void a_corrupt_header_byte_loses_that_event_alone(void **state)
{
    size_t start_of_second, end_of_second, start_of_last;
    (void)state;

    append_event(&the_log, 0, "A", "zero");
    start_of_second = the_log.size;
    append_event(&the_log, 1, "BCD", "one");
    end_of_second = the_log.size;
    append_event(&the_log, 2, "C", "two");
    start_of_last = the_log.size;
    append_event(&the_log, 3, "D", "three");
    for (size_t at = 0; at < LCM_LOG_HEADER_BYTES; at++) {
        uint8_t *byte = the_log.data + start_of_second + at, right = *byte;

        for (int value = 0; value < 256; value++) {
            size_t longer = at == LCM_LOG_HEADER_BYTES - 1 ? (size_t)value - right : 0;
            const char *found;

            if (longer == start_of_last - end_of_second || longer == the_log.size - end_of_second) {
                continue;
            }
            *byte = (uint8_t)value;
            found = events_found_as_text(the_log.data, the_log.size);
            assert_ptr_equal(strstr(found, "0:A:zero "), found);
            assert_non_null(strstr(found, "2:C:two 3:D:three "));
        }
        *byte = right;
    }
}

static void events_of_impossible_lengths_are_skipped(void **state)
{
    static const uint32_t lengths[][2] = {
        {0, 3},          {64, 3},          {0x7FFFFFFF, 3},          {0xFFFFFFFF, 3},
        {1, 0xFFFFFFFF}, {1, 0x80000000},  {1, 0x7FFFFFFF},          {0xFFFFFFFF, 0xFFFFFFFF},
        {1, 1000},       {1, 0x04000000u}, {1, LCM_LOG_MAX_DATA + 1}};
    (void)state;

    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        the_log.size = 0;
        append_event(&the_log, 0, "A", "one");
        append_event_with_lengths(&the_log, 1, "A", "two", lengths[i][0], lengths[i][1]);
        append_event(&the_log, 2, "A", "three");
        assert_events_found("0:A:one -32 2:A:three ");
    }
}

static void slightly_wrong_lengths_are_noticed(void **state)
{
    (void)state;
    append_event_with_lengths(&the_log, 0, "A", "one", 1,
                              10); /* data_length reaches into the next event */
    append_event(&the_log, 1, "A", "two");
    append_event_with_lengths(&the_log, 2, "A", "three", 1,
                              2); /* the rest of the data is garbage */
    append_event(&the_log, 3, "A", "four");
    append_event_with_lengths(&the_log, 4, "A",
                              "\xED\xA1\xDA\x01"
                              "five",
                              1, 20); /* a false sync word before the event */
    append_event(&the_log, 5, "A", "six");
    assert_events_found("-32 1:A:two 2:A:th -3 3:A:four -37 5:A:six ");
}

static void an_event_with_too_long_a_channel_is_skipped(void **state)
{
    char channel[LCM_LOG_MAX_CHANNEL + 2];
    (void)state;

    memset(channel, 'c', sizeof channel);
    channel[sizeof channel - 1] = '\0';
    append_event(&the_log, 0, channel, "one");
    append_event(&the_log, 1, channel + 1, "two");
    assert_string_equal(strchr(events_found_as_text(the_log.data, the_log.size), '1'),
                        "1:ccccccccccccccccccccc"
                        "cccccccccccccccccccccccccccccccccccccccccc:two ");
}

static void an_event_with_a_nul_in_its_channel_is_skipped(void **state)
{
    (void)state;
    append_event_with_lengths(&the_log, 0, "AB", "one", 2, 3);
    the_log.data[LCM_LOG_HEADER_BYTES + 1] = '\0';
    append_event(&the_log, 1, "A", "two");
    assert_events_found("-33 1:A:two ");
}

static void sync_words_inside_data_begin_no_event(void **state)
{
    (void)state;
    append_event(&the_log, 0, "A", "\xED\xA1\xDA\x01");
    append_event(&the_log, 1, "A", "\xED\xA1\xDA\x01 and more, longer than a header is");
    append_event(&the_log, 2, "A", "end");
    assert_events_found(
        "0:A:\xED\xA1\xDA\x01 1:A:\xED\xA1\xDA\x01 and more, longer than a header is "
        "2:A:end ");
}

/* A log inside an event of another log stays data if the outer event is whole. */
static void a_log_inside_an_event_stays_data(void **state)
{
    static struct bytes inner;
    char *text = NULL;
    size_t size = 0, count;
    struct lcm_log_writer writer = {.file = open_memstream(&text, &size)};
    struct lcm_log_event event;
    (void)state;

    inner.size = 0;
    append_event(&inner, 5, "IN", "side");
    assert_true(lcm_log_write(&writer, 0, "OUT", inner.data, inner.size));
    assert_true(lcm_log_write(&writer, 0, "OUT", inner.data, inner.size));
    fclose(writer.file);
    assert_int_equal(lcm_log_parse((uint8_t *)text, size, true, &event, &count), LCM_LOG_EVENT);
    assert_int_equal(count, size / 2);
    assert_int_equal(event.size, inner.size);
    free(text);
}

static void sync_words_inside_garbage_begin_no_event(void **state)
{
    (void)state;
    append_bytes(&the_log, "\xED\xA1\xDA\x01\xED\xA1\xDA\x01\xED\xA1\xDA\x01", 12);
    append_event(&the_log, 0, "A", "one");
    append_bytes(&the_log, "\xED\xED\xA1\xED\xA1\xDA\xED\xA1\xDA\x01 thirty bytes that say nothing",
                 40);
    append_event(&the_log, 1, "A", "two");
    append_bytes(&the_log, "x\xED", 2);
    append_event(&the_log, 2, "A", "three");
    append_bytes(&the_log, "\xED\xA1\xDA\x01", 4);
    assert_events_found("-12 0:A:one -40 1:A:two -2 2:A:three -4 ");
}

static void the_parser_asks_for_more_bytes_until_an_event_is_certain(void **state)
{
    struct lcm_log_event event;
    size_t count = 0, whole;
    (void)state;

    append_event(&the_log, 0, "AB", "one");
    whole = the_log.size;
    append_event(&the_log, 1, "AB", "two");
    for (size_t size = 0; size < whole + 4; size++) {
        enum lcm_log_found found = lcm_log_parse(the_log.data, size, false, &event, &count);

        assert_int_equal(found, LCM_LOG_MORE);
        assert_true(count > size && count <= whole + 4);
    }
    assert_int_equal(lcm_log_parse(the_log.data, whole + 4, false, &event, &count), LCM_LOG_EVENT);
    assert_int_equal(count, whole);
}

static void the_reader_gives_events_and_counts_skipped_bytes(void **state)
{
    struct lcm_log_counts counts;
    struct lcm_log_reader *reader;
    struct lcm_log_event event;
    char path[40];
    (void)state;

    append_bytes(&the_log, "abc", 3);
    append_event(&the_log, 0, "A", "one");
    append_bytes(&the_log, "d\xED\xA1\xDA\x01", 5);
    append_event(&the_log, 1, "B", "two");
    append_bytes(&the_log, reference, sizeof reference - 1);
    write_the_log(path);
    reader = lcm_log_open(path);
    assert_true(lcm_log_next(reader, &event));
    assert_int_equal(event.offset, 3);
    assert_int_equal(event.utime, 1000);
    assert_true(lcm_log_next(reader, &event));
    assert_int_equal(event.offset, 3 + 32 + 5);
    assert_string_equal(event.channel, "B");
    assert_false(lcm_log_next(reader, &event));
    assert_false(lcm_log_next(reader, &event));
    counts = lcm_log_counts(reader);
    assert_int_equal(counts.events, 2);
    assert_int_equal(counts.places_skipped, 3);
    assert_int_equal(counts.bytes_skipped, 8 + sizeof reference - 1);
    lcm_log_close(reader);
    unlink(path);
}

static void log_files_are_recognised_by_name_or_sync_word(void **state)
{
    char path[40];
    (void)state;

    append_bytes(&the_log, reference, sizeof reference);
    write_the_log(path);
    assert_true(lcm_log_is_log(path));
    unlink(path);
    assert_true(lcm_log_is_log("anything.lcm"));
    assert_false(lcm_log_is_log("none.csv"));
    assert_false(lcm_log_is_log("/tmp"));
    the_log.data[3] = 2;
    write_the_log(path);
    assert_false(lcm_log_is_log(path));
    unlink(path);
}

/* Events of all sizes across the edges of any read buffer, with garbage in between. */
static void events_across_buffer_edges_are_read_whole(void **state)
{
    static uint8_t data[1 << 18];
    struct random random = random_start(5, 0, 0);
    char path[] = "/tmp/rhotrack-log-XXXXXX";
    int descriptor = mkstemp(path);
    struct lcm_log_writer writer = {.file = fdopen(descriptor, "w")};
    struct lcm_log_reader *reader;
    struct lcm_log_event event;
    uint64_t garbage = 0;
    (void)state;

    for (int i = 0; i < 300; i++) {
        size_t size = random_below(&random, i % 50 ? 3000 : sizeof data);

        memset(data, i, size);
        assert_true(lcm_log_write(&writer, i, "CHANNEL", data, size));
        if (i % 7 == 3) {
            fwrite("garbage", 7, 1, writer.file);
            garbage += 7;
        }
    }
    fclose(writer.file);
    reader = lcm_log_open(path);
    random = random_start(5, 0, 0);
    for (int i = 0; i < 300; i++) {
        assert_true(lcm_log_next(reader, &event));
        assert_int_equal(event.number, i);
        assert_int_equal(event.size, random_below(&random, i % 50 ? 3000 : sizeof data));
        memset(data, i, event.size);
        assert_memory_equal(event.data, data, event.size);
    }
    assert_false(lcm_log_next(reader, &event));
    assert_int_equal(lcm_log_counts(reader).bytes_skipped, garbage);
    lcm_log_close(reader);
    unlink(path);
}

/*
 * Headers that all claim 60 MB of data: the bytes are scanned once or twice, not once for each
 * header.
 */
static void false_lengths_do_not_make_the_parser_slow(void **state)
{
    struct lcm_log_reader *reader;
    struct lcm_log_event event;
    char path[40];
    (void)state;

    for (int i = 0; i < 30000; i++) {
        append_event_with_lengths(&the_log, i, "A", "one", 1, 60u << 20);
    }
    append_event(&the_log, 30000, "A", "end");
    write_the_log(path);
    reader = lcm_log_open(path);
    assert_true(lcm_log_next(reader, &event));
    assert_int_equal(event.number, 30000);
    assert_false(lcm_log_next(reader, &event));
    assert_int_equal(lcm_log_counts(reader).bytes_skipped, 30000 * 32);
    lcm_log_close(reader);
    unlink(path);
}

/*
 * Pieces of logs in random order: every byte is accounted for, and the file reader finds what the
 * parser finds.
 */
static void in_random_pieces_of_logs_every_byte_is_accounted_for(void **state)
{
    struct random random = random_start(11, 0, 0);
    (void)state;

    for (int round = 0; round < 3000; round++) {
        the_log.size = 0;
        for (int piece = 0; piece < 12; piece++) {
            static const char *const words[] = {"\xED", "\xED\xA1", "\xED\xA1\xDA\x01", "x"};
            uint64_t which = random_below(&random, 7);

            if (which < 4) {
                append_bytes(&the_log, words[which], strlen(words[which]));
            } else if (which == 4) {
                append_number(&the_log, random_below(&random, 1000), 8);
            } else if (which == 5) {
                append_event_with_lengths(&the_log, piece, "C", "data",
                                          (uint32_t)random_below(&random, 4),
                                          (uint32_t)random_below(&random, 60));
            } else {
                append_event(&the_log, piece, "CH", "data");
            }
        }
        (void)events_found_as_text(the_log.data, the_log.size);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(hand_written_bytes_are_parsed_as_an_event, clear_the_log),
        cmocka_unit_test_setup(the_writer_writes_the_hand_written_bytes, clear_the_log),
        cmocka_unit_test_setup(the_writer_refuses_bad_channels_and_sizes, clear_the_log),
        cmocka_unit_test_setup(the_writer_reports_a_full_disk, clear_the_log),
        cmocka_unit_test_setup(negative_numbers_and_times_are_read_back, clear_the_log),
        cmocka_unit_test_setup(all_events_of_an_intact_log_are_found, clear_the_log),
        cmocka_unit_test_setup(garbage_around_events_is_skipped, clear_the_log),
        cmocka_unit_test_setup(a_truncated_log_keeps_its_whole_events, clear_the_log),
        cmocka_unit_test_setup(bytes_cut_out_lose_only_the_event_they_belong_to, clear_the_log),
        cmocka_unit_test_setup(a_corrupt_header_byte_loses_that_event_alone, clear_the_log),
        cmocka_unit_test_setup(events_of_impossible_lengths_are_skipped, clear_the_log),
        cmocka_unit_test_setup(slightly_wrong_lengths_are_noticed, clear_the_log),
        cmocka_unit_test_setup(an_event_with_too_long_a_channel_is_skipped, clear_the_log),
        cmocka_unit_test_setup(an_event_with_a_nul_in_its_channel_is_skipped, clear_the_log),
        cmocka_unit_test_setup(sync_words_inside_data_begin_no_event, clear_the_log),
        cmocka_unit_test_setup(a_log_inside_an_event_stays_data, clear_the_log),
        cmocka_unit_test_setup(sync_words_inside_garbage_begin_no_event, clear_the_log),
        cmocka_unit_test_setup(the_parser_asks_for_more_bytes_until_an_event_is_certain,
                               clear_the_log),
        cmocka_unit_test_setup(the_reader_gives_events_and_counts_skipped_bytes, clear_the_log),
        cmocka_unit_test_setup(log_files_are_recognised_by_name_or_sync_word, clear_the_log),
        cmocka_unit_test_setup(events_across_buffer_edges_are_read_whole, clear_the_log),
        cmocka_unit_test_setup(false_lengths_do_not_make_the_parser_slow, clear_the_log),
        cmocka_unit_test_setup(in_random_pieces_of_logs_every_byte_is_accounted_for, clear_the_log),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
