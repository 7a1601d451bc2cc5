/* SPDX-License-Identifier: MIT */
/*
 * scene_json: a JSON file's values, checked while they are read.
 *
 * Whatever is wrong ends the program with exit 2 and one line that names the file, its line and the
 * place, `rhotrack: FILE:12: radars[0].turn_s: -4 is outside 0.001 .. 3600`. Keys that nobody asked
 * for are wrong, too: after its last key is read, an object is closed.
 */
#ifndef RHOTRACK_TOOL_SCENE_JSON_H
#define RHOTRACK_TOOL_SCENE_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct cJSON;

#define JSON_KEYS_MAX 64

struct json_file {
    const char *name; /* as messages say it */
    const char *text;
    struct cJSON *root;
};

/* Where a value stands: a key or an index, below another place. */
struct json_place {
    const struct json_file *file;
    const struct json_place *above; /* NULL: the whole file */
    const char *key;                /* NULL: the element of a list */
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
    const struct cJSON *item; /* NULL: an empty one */
    size_t count;
};

struct json_span {
    double lo, hi;
};

/*
 * The text stays the caller's, and must live as long as the file. Exit 2 with the line where it is
 * no JSON object.
 */
struct json_file json_open(const char *name, const char *text, size_t length);
/*
 * `radars.0.pd=0.7` or `radars[0].pd=0.7`: the value, JSON or a text, takes the place of what
 * stands there, or is added; behind the last element of a list, too. Exit 2, with the nearest,
 * where there is no such place.
 */
void json_assign_by_path(struct json_file *file, const char *assignment);

void json_close(struct json_file *file);

_Noreturn void json_fail(const struct json_place *place, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
_Noreturn void json_fail_key(const struct json_object *object, const char *key, const char *format,
                             ...) __attribute__((format(printf, 3, 4)));

struct json_object json_root(const struct json_file *file);

/* A value, or `otherwise` where it is not there. */
bool json_has_key(struct json_object *object, const char *key);
double json_read_number(struct json_object *object, const char *key, double min, double max,
                        double otherwise);
uint64_t json_read_count(struct json_object *object, const char *key, uint64_t min, uint64_t max,
                         uint64_t otherwise);
bool json_read_flag(struct json_object *object, const char *key, bool otherwise);
const char *json_read_text(struct json_object *object, const char *key, const char *otherwise);

/* A number, which is both ends, or a list of two, the first not above the second. */
struct json_span json_read_span(struct json_object *object, const char *key, double min, double max,
                                struct json_span otherwise);

/* So many numbers in a list, within min .. max. False where it is not there. */
bool json_read_numbers(struct json_object *object, const char *key, size_t count, double min,
                       double max, double *numbers);

/* The index of a word. */
size_t json_read_choice(struct json_object *object, const char *key, const char *const *words,
                        size_t count, size_t otherwise);

/* A member that is required: exit 2 where it is missing. */
void json_require_key(struct json_object *object, const char *key);

/* Of two keys that exclude each other: exit 2 where both are there. */
void json_exclude_keys(struct json_object *object, const char *key, const char *other);

/*
 * A list of objects or numbers, empty where it is not there; an object below a key, false where it
 * is not there.
 */
struct json_list json_read_list(struct json_object *object, const char *key, size_t max);
bool json_read_object(struct json_object *object, const char *key, struct json_object *below);
struct json_object json_element(const struct json_list *list, size_t index);
void json_element_numbers(const struct json_list *list, size_t index, size_t count, double min,
                          double max, double *numbers);
double json_element_number(const struct json_list *list, size_t index, double min, double max);

/* Exit 2 where the object has a key that was never asked for. */
void json_refuse_unknown_keys(const struct json_object *object);

#endif
