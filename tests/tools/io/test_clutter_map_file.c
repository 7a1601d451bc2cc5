/* SPDX-License-Identifier: MIT */
/*
 * A clutter map's file that is changed at any byte, or cut at any length, is set aside as it is,
 * and nothing of it is taken.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "io/output/clutter_map_file.h"
#include "tools/state_folder.h"

static struct parameters parameters;
static struct rho_clutter_map map, empty, loaded;
static char text[4096], now[4096];
static size_t size;

/* Writes a map of two echoes, and the returns of one class, to the file `map`. */
static void write_map(void)
{
    parameters_set_defaults(&parameters);
    rho_clutter_map_init(&empty, 0.0f);
    map = empty;
    assert_int_equal(rho_clutter_map_teach(&map, 1, 20344.6f, -7512.2f, 11.2f, 24.9f, 147), RHO_OK);
    assert_int_equal(rho_clutter_map_teach(&map, 7, 1.5f, 3e4f, 30.0f, 30.0f, 6), RHO_OK);
    assert_int_equal(rho_clutter_map_teach_returns(&map, 12, 6, 1, 512.6f, 260.1f), RHO_OK);
    assert_true(clutter_map_file_write("map", &map));
    assert_int_equal(count_files(), 1);
    size = read_whole_file("map", text, sizeof text);
}

static bool restore(void)
{
    bool is_free;

    loaded = empty;
    listen_to_stderr();
    is_free = clutter_map_file_restore("map", &parameters, &loaded);
    end_of_listening();
    return is_free;
}

static void assert_set_aside(const char *what, size_t at, const char *bytes, size_t length)
{
    write_whole_file("map", bytes, length);
    if (!restore() || is_file("map") || count_files() != 1 ||
        !strstr(said, "; set aside as map.damaged; the clutter map starts empty\n") ||
        memcmp(&loaded, &empty, sizeof empty) != 0) {
        fail_msg("%s %zu: said: %s", what, at, said);
    }
    assert_int_equal(read_whole_file("map.damaged", now, sizeof now), length);
    assert_memory_equal(now, bytes, length);
    assert_int_equal(remove("map.damaged"), 0);
}

static void a_map_comes_back(void **state)
{
    (void)state;
    write_map();
    assert_true(restore());
    assert_string_equal(said, "rhotrack: map: 2 echoes\n");
    assert_true(clutter_map_file_write("map", &loaded));
    assert_int_equal(read_whole_file("map", now, sizeof now), size);
    assert_memory_equal(now, text, size);
    assert_memory_equal(text + size - 18, "# CRC-32 ", 9);
    empty_state_folder();
}

static void a_map_with_any_byte_changed_is_set_aside(void **state)
{
    (void)state;
    write_map();
    for (size_t at = 0; at < size; at++) {
        text[at] = (char)(text[at] ^ 1 << at % 8);
        assert_set_aside("byte", at, text, size);
        text[at] = (char)(text[at] ^ 1 << at % 8);
    }
    empty_state_folder();
}

static void a_map_of_any_other_length_is_set_aside(void **state)
{
    static const char zeros[sizeof text];

    (void)state;
    write_map();
    for (size_t length = 1; length < size; length++) {
        assert_set_aside("length", length, text, length);
    }
    memcpy(text + size, text, 100);
    for (size_t more = 1; more <= 100; more++) {
        assert_set_aside("length", size + more, text, size + more);
    }
    for (size_t length = 1; length <= size; length += 7) {
        assert_set_aside("zeros of length", length, zeros, length);
    }
    write_whole_file("map", text, 0);
    assert_true(restore());
    assert_string_equal(said, "rhotrack: map: is empty; the clutter map starts empty\n");
    empty_state_folder();
}

/* Files by hand and of earlier versions have no checksum. */
static void a_map_without_a_checksum_is_read(void **state)
{
    const char *rows;

    (void)state;
    write_map();
    rows = strstr(text, "sensor_id,");
    write_whole_file("map", rows, size - (size_t)(rows - text) - 18);
    assert_true(restore());
    assert_string_equal(said, "rhotrack: map: 2 echoes\n");
    assert_memory_equal(&loaded, &map, sizeof map);
    assert_set_aside("without its last line, length", size - 18, text, size - 18);
    assert_set_aside("without its head, length", size, rows, size - (size_t)(rows - text));
    empty_state_folder();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_map_comes_back),
        cmocka_unit_test(a_map_with_any_byte_changed_is_set_aside),
        cmocka_unit_test(a_map_of_any_other_length_is_set_aside),
        cmocka_unit_test(a_map_without_a_checksum_is_read),
    };

    return cmocka_run_group_tests(tests, enter_state_folder, leave_state_folder);
}
