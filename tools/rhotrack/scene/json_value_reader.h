/* SPDX-License-Identifier: MIT */
/*
 * json_value_reader: reads values of a JSON file and checks them.
 *
 * Any error ends the program with exit 2 and one line that names the file, the line and the key:
 * `rhotrack: FILE:12: radars[0].turn_s: -4 is outside 0.001 .. 3600`. Keys of an object that were
 * never asked for are errors, too: json_refuse_unknown_keys reports them after the last read.
 */
#ifndef RHOTRACK_TOOL_JSON_VALUE_READER_H
#define RHOTRACK_TOOL_JSON_VALUE_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct cJSON;

#define JSON_KEYS_MAX 64

struct json_file {
    const char *name; /* file name for messages */
    const char *text;
    struct cJSON *root;
};

/* Position of a value in the file: a key or an index within the place above. */
struct json_place {
    const struct json_file *file;
    const struct json_place *above; /* enclosing place; NULL for the whole file */
    const char *key;                /* key of the value; NULL for element `index` of a list */
    size_t index;
};

struct json_object {
    struct json_place place;
    const struct cJSON *item;
    const char *asked[JSON_KEYS_MAX];
    size_t num_asked;
};

struct json_list {
    struct json_place place;
    const struct cJSON *item; /* the list; NULL where the key is missing: an empty list */
    size_t count;
};

struct json_span {
    double lo, hi;
};

/*
 * Parses the text, which stays the caller's and must live as long as the file. Exits with 2 and the
 * line where it is not a JSON object.
 */
struct json_file json_open(const char *name, const char *text, size_t length);
/*
 * Assigns a value by a path: `radars.0.pd=0.7` or `radars[0].pd=0.7`. The value, JSON or plain
 * text, replaces or adds a member, and may be appended to a list. Exits with 2, naming the most
 * similar key, where the path does not exist.
 */
void json_assign_by_path(struct json_file *file, const char *assignment);

void json_close(struct json_file *file);

_Noreturn void json_fail(const struct json_place *place, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
_Noreturn void json_fail_key(const struct json_object *object, const char *key, const char *format,
                             ...) __attribute__((format(printf, 3, 4)));

struct json_object json_root(const struct json_file *file);

/*
 * json_has_key: whether the key is there. The readers return the value of a key, or `otherwise`
 * where the key is missing; numbers outside min .. max are errors.
 */
bool json_has_key(struct json_object *object, const char *key);
double json_read_number(struct json_object *object, const char *key, double min, double max,
                        double otherwise);
uint64_t json_read_count(struct json_object *object, const char *key, uint64_t min, uint64_t max,
                         uint64_t otherwise);
bool json_read_flag(struct json_object *object, const char *key, bool otherwise);
const char *json_read_text(struct json_object *object, const char *key, const char *otherwise);

/* Reads a span: a number, which is both ends, or a list of two numbers in ascending order. */
struct json_span json_read_span(struct json_object *object, const char *key, double min, double max,
                                struct json_span otherwise);

/* Reads a list of exactly `count` numbers within min .. max. False where the key is missing. */
bool json_read_numbers(struct json_object *object, const char *key, size_t count, double min,
                       double max, double *numbers);

/*
 * Reads a list of two numbers within -max .. max; leaves *x and *y as they are where the key is
 * missing.
 */
void json_read_xy(struct json_object *object, const char *key, double max, double *x, double *y);

/* Reads a text that must be one of `words`, and returns its index. */
size_t json_read_choice(struct json_object *object, const char *key, const char *const *words,
                        size_t count, size_t otherwise);

/* Exits with 2 where the key is missing. */
void json_require_key(struct json_object *object, const char *key);

/* Exits with 2 where both of two exclusive keys are there. */
void json_exclude_keys(struct json_object *object, const char *key, const char *other);

/*
 * json_read_list: a list of at most max elements, empty where the key is missing. json_read_object:
 * the object of a key; false where it is missing. The others read element `index` of a list.
 */
struct json_list json_read_list(struct json_object *object, const char *key, size_t max);
bool json_read_object(struct json_object *object, const char *key, struct json_object *below);
struct json_object json_element(const struct json_list *list, size_t index);
void json_element_numbers(const struct json_list *list, size_t index, size_t count, double min,
                          double max, double *numbers);
double json_element_number(const struct json_list *list, size_t index, double min, double max);

/* Exits with 2 where the object has a key that no function above was asked for. */
void json_refuse_unknown_keys(const struct json_object *object);

#endif
