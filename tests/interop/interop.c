/* SPDX-License-Identifier: MIT */
/*
 * The library's messages compared with those of lcm-gen's C, and with other runtimes by files:
 * interop c N : N random messages of each type from one codec to the other, both ways
 * interop write FOLDER N : N random messages of each type to FOLDER/TYPE.log
 * interop read FOLDER N : files of another runtime: our decode, values compared, our encode
 * interop vectors : the text of tests/vectors/message_vectors.h, made by lcm-gen's C alone
 * Files are LCM event logs: each message is followed by an event on the channel VALUES that holds
 * its numbers in the order of their names. So a codec that swaps two members in both directions is
 * detected. One line `ok` or `FAIL` for each check.
 */
#include <stdarg.h>
#include <stdio.h>

#include "lcm_gen_codecs.h"
#include "unit/wire/message_codecs.h"

#define EVENT_MAGIC 0xeda1da01u
#define EVENT_HEADER_BYTES 28
#define MEMBERS_MAX 64

static int num_failed;

static void print_check(bool good, const char *format, ...)
{
    va_list arguments;

    printf(good ? "ok   " : "FAIL ");
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    printf("\n");
    num_failed += !good;
}

/* Makes signalling NaNs quiet, as converting to Python's float, a double, does. */
static void make_nans_quiet(const struct message_shape *shape, void *message)
{
    for (struct walk w = walk_members(shape, message); walk_to_next(&w);) {
        const uint64_t bits = load_bits(w.at, w.member->width);

        if (w.member->is_float && (bits & 0x7fffffff) > 0x7f800000) {
            store_bits(w.at, w.member->width, bits | 0x00400000);
        }
    }
}

/* ---- lcm-gen's C ---- */

/* Our encode, lcm-gen's decode and encode: the same values and bytes. */
static bool is_our_message_read_by_lcm_gen(size_t type, uint64_t *state)
{
    const struct message_shape *shape = &our_shapes[type], *theirs = &their_shapes[type];
    _Alignas(8) char message[MESSAGE_STRUCT_MAX], other[MESSAGE_STRUCT_MAX];
    uint8_t bytes[MESSAGE_BYTES_MAX], other_bytes[MESSAGE_BYTES_MAX];
    size_t size = 0;
    bool is_good;

    fill_with_random_bits(shape, message, draw_count(shape, state), state);
    if (codecs[type].encode(message, bytes, sizeof bytes, &size) != RHO_OK ||
        their_codecs[type].decode(bytes, (int)size, other) != (int)size) {
        return false;
    }
    is_good = are_numbers_equal(shape, message, theirs, other) &&
              their_codecs[type].encode(other_bytes, sizeof other_bytes, other) == (int)size &&
              memcmp(bytes, other_bytes, size) == 0;
    their_codecs[type].cleanup(other);
    return is_good;
}

/* lcm-gen's encode, our decode and encode: the same values and bytes. */
static bool is_lcm_gen_message_read_by_us(size_t type, uint64_t *state)
{
    const struct message_shape *shape = &our_shapes[type], *theirs = &their_shapes[type];
    _Alignas(8) char message[MESSAGE_STRUCT_MAX], other[MESSAGE_STRUCT_MAX];
    _Alignas(8) char list[MESSAGE_STRUCT_MAX];
    uint8_t bytes[MESSAGE_BYTES_MAX], our_bytes[MESSAGE_BYTES_MAX];
    size_t size = 0;
    int written;

    set_list_memory(theirs, other, list);
    fill_with_random_bits(theirs, other, draw_count(theirs, state), state);
    written = their_codecs[type].encode(bytes, sizeof bytes, other);
    return written > 0 && codecs[type].decode(bytes, (size_t)written, message) == RHO_OK &&
           are_numbers_equal(shape, message, theirs, other) &&
           codecs[type].encode(message, our_bytes, sizeof our_bytes, &size) == RHO_OK &&
           size == (size_t)written && memcmp(bytes, our_bytes, size) == 0;
}

static void compare_codecs(int num_messages)
{
    uint64_t state = 1;

    for (size_t i = 0; i < NUM_CODECS; i++) {
        int num_ours = 0, num_theirs = 0;

        for (int k = 0; k < num_messages; k++) {
            num_ours += is_our_message_read_by_lcm_gen(i, &state);
            num_theirs += is_lcm_gen_message_read_by_us(i, &state);
        }
        print_check(num_ours == num_messages, "%s: %d of %d messages of ours read by lcm-gen's C",
                    our_shapes[i].name, num_ours, num_messages);
        print_check(num_theirs == num_messages, "%s: %d of %d messages of lcm-gen's C read by us",
                    our_shapes[i].name, num_theirs, num_messages);
    }
}

/* ---- Files ---- */

static int compare_member_names(const void *a, const void *b)
{
    return strcmp((*(const struct message_member *const *)a)->name,
                  (*(const struct message_member *const *)b)->name);
}

static uint8_t *put_members_by_name(uint8_t *to, const char *at,
                                    const struct message_member *members, size_t num_members,
                                    const struct message_member *counter)
{
    const struct message_member *sorted[MEMBERS_MAX];
    size_t count = 0;

    for (size_t i = 0; i < num_members; i++) {
        sorted[count++] = &members[i];
    }
    if (counter) {
        sorted[count++] = counter;
    }
    qsort(sorted, count, sizeof sorted[0], compare_member_names);
    for (size_t i = 0; i < count; i++) {
        for (unsigned k = 0; k < sorted[i]->count; k++) {
            to = put_big_endian(
                to, sorted[i]->width,
                load_bits(at + sorted[i]->offset + (size_t)k * sorted[i]->width, sorted[i]->width));
        }
    }
    return to;
}

/*
 * Encodes the numbers in order of their members' names: first those before the list with its count,
 * then element by element.
 */
static size_t encode_values_by_name(const struct message_shape *shape, void *message,
                                    uint8_t *values)
{
    uint8_t *to = put_members_by_name(values, message, shape->members, shape->num_members,
                                      shape->most > 0 ? &shape->counter : NULL);

    for (int i = 0; i < message_count(shape, message); i++) {
        to = put_members_by_name(to, message_element(shape, message, i), shape->element_members,
                                 shape->num_element_members, NULL);
    }
    return (size_t)(to - values);
}

static void write_event(FILE *file, int number, const char *channel, const uint8_t *data,
                        size_t size)
{
    uint8_t header[EVENT_HEADER_BYTES], *to = put_big_endian(header, 4, EVENT_MAGIC);

    to = put_big_endian(to, 8, (uint64_t)number);
    to = put_big_endian(to, 8, (uint64_t)number);
    to = put_big_endian(to, 4, strlen(channel));
    (void)put_big_endian(to, 4, size);
    fwrite(header, 1, sizeof header, file);
    fwrite(channel, 1, strlen(channel), file);
    fwrite(data, 1, size, file);
}

static FILE *open_log(const char *folder, const char *type, const char *mode)
{
    char path[4096];
    FILE *file;

    snprintf(path, sizeof path, "%s/%s.log", folder, type);
    file = fopen(path, mode);
    if (!file) {
        perror(path);
        exit(1);
    }
    return file;
}

static void write_random_logs(const char *folder, int num_messages)
{
    _Alignas(8) char message[MESSAGE_STRUCT_MAX];
    uint8_t bytes[MESSAGE_BYTES_MAX];
    uint64_t state = 2;
    size_t size = 0;

    for (size_t i = 0; i < NUM_CODECS; i++) {
        const struct message_shape *shape = &our_shapes[i];
        FILE *file = open_log(folder, shape->name, "wb");

        for (int k = 0; k < num_messages; k++) {
            fill_with_random_bits(shape, message, draw_count(shape, &state), &state);
            make_nans_quiet(shape, message);
            if (codecs[i].encode(message, bytes, sizeof bytes, &size) != RHO_OK) {
                print_check(false, "%s: not encoded", shape->name);
            }
            write_event(file, 2 * k, shape->name, bytes, size);
            write_event(file, 2 * k + 1, "VALUES", bytes,
                        encode_values_by_name(shape, message, bytes));
        }
        if (fclose(file) != 0) {
            print_check(false, "%s: not written", shape->name);
        }
    }
}

/*
 * Reads the next event's data, which must be on this channel; 0 at the end or on another channel.
 */
static size_t read_event(FILE *file, const char *channel, uint8_t data[MESSAGE_BYTES_MAX])
{
    uint8_t header[EVENT_HEADER_BYTES];
    char name[64] = "";
    size_t length, size;

    if (fread(header, 1, sizeof header, file) != sizeof header) {
        return 0;
    }
    length = header[23];
    size = (size_t)header[26] << 8 | header[27];
    if (length >= sizeof name || size > MESSAGE_BYTES_MAX ||
        fread(name, 1, length, file) != length || strcmp(name, channel) != 0) {
        return 0;
    }
    return fread(data, 1, size, file) == size ? size : 0;
}

static void check_logs(const char *folder, int num_messages)
{
    _Alignas(8) char message[MESSAGE_STRUCT_MAX];
    uint8_t bytes[MESSAGE_BYTES_MAX], values[MESSAGE_BYTES_MAX], ours[MESSAGE_BYTES_MAX];
    size_t size, values_size, our_size = 0;

    for (size_t i = 0; i < NUM_CODECS; i++) {
        const struct message_shape *shape = &our_shapes[i];
        FILE *file = open_log(folder, shape->name, "rb");
        int num_read = 0, num_good = 0;

        while ((size = read_event(file, shape->name, bytes)) > 0) {
            values_size = read_event(file, "VALUES", values);
            num_read++;
            num_good += codecs[i].decode(bytes, size, message) == RHO_OK &&
                        encode_values_by_name(shape, message, ours) == values_size &&
                        memcmp(values, ours, values_size) == 0 &&
                        codecs[i].encode(message, ours, sizeof ours, &our_size) == RHO_OK &&
                        our_size == size && memcmp(bytes, ours, size) == 0;
        }
        print_check(num_read == num_messages && num_good == num_read,
                    "%s: %d of %d messages read by us", shape->name, num_good, num_read);
        fclose(file);
    }
}

/* ---- Vectors ---- */

static void print_hex(const uint8_t *bytes, int size)
{
    for (int i = 0; i < size; i++) {
        printf("%s%02x", i % 56 == 0 ? "\n        \"" : "", bytes[i]);
        printf("%s", i % 56 == 55 || i + 1 == size ? "\"" : "");
    }
    printf("},\n");
}

static void print_vectors(void)
{
    _Alignas(8) char message[MESSAGE_STRUCT_MAX], list[MESSAGE_STRUCT_MAX];
    uint8_t bytes[MESSAGE_BYTES_MAX];

    printf("/* SPDX-License-Identifier: MIT */\n"
           "/* Made by make_message_vectors.sh: messages as the C of lcm-gen 1.3.1 encodes them. "
           "Contents: fill_golden in "
           "tests/unit/wire/message_shape.h. */\n"
           "#include \"unit/wire/message_shape.h\"\n\n"
           "static const struct {\n    const char *name;\n    enum golden golden;\n    const char "
           "*hex;\n"
           "} message_vectors[] = {\n");
    for (size_t i = 0; i < NUM_CODECS; i++) {
        for (enum golden golden = 0; golden < NUM_GOLDEN; golden++) {
            static const char *const names[] = {"EMPTY", "TYPICAL", "FULL", "EXTREME"};

            set_list_memory(&their_shapes[i], message, list);
            fill_golden(&their_shapes[i], message, golden);
            printf("    {\"%s\", GOLDEN_%s,", their_shapes[i].name, names[golden]);
            print_hex(bytes, their_codecs[i].encode(bytes, sizeof bytes, message));
        }
    }
    printf("};\n");
}

int main(int argc, char **argv)
{
    const char *mode = argc > 1 ? argv[1] : "";

    if (strcmp(mode, "c") == 0 && argc == 3) {
        compare_codecs(atoi(argv[2]));
    } else if (strcmp(mode, "write") == 0 && argc == 4) {
        write_random_logs(argv[2], atoi(argv[3]));
    } else if (strcmp(mode, "read") == 0 && argc == 4) {
        check_logs(argv[2], atoi(argv[3]));
    } else if (strcmp(mode, "vectors") == 0 && argc == 2) {
        print_vectors();
    } else {
        fprintf(stderr, "usage: interop c N | write FOLDER N | read FOLDER N | vectors\n");
        return 2;
    }
    return num_failed > 0;
}
