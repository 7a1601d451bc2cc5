/* SPDX-License-Identifier: MIT */
#include "scene/json_value_reader.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/name_hint.h"

#define PLACE_BYTES 256
#define DEPTH_MAX 16
#define WHAT_BYTES 512
#define KEY_BYTES 64

/* The functions below scan text that has been parsed as valid JSON. */
static const char *skip_space(const char *at)
{
    return at + strspn(at, " \t\r\n");
}

static const char *skip_string(const char *at)
{
    for (at++; *at && *at != '"'; at++) {
        if (*at == '\\' && at[1]) {
            at++;
        }
    }
    return *at ? at + 1 : at;
}

static const char *skip_value(const char *at)
{
    int depth = 0;

    do {
        at = skip_space(at);
        if (*at == '"') {
            at = skip_string(at);
        } else if (*at == '{' || *at == '[') {
            depth++;
            at++;
        } else if (*at == '}' || *at == ']') {
            depth--;
            at++;
        } else if (*at == ',' || *at == ':') {
            at++;
        } else {
            size_t length = strcspn(at, " \t\r\n,:]}");

            at += length;
            if (length == 0) {
                return at;
            }
        }
    } while (depth > 0 && *at);
    return at;
}

/* Lists the places from the root of the file down to `place`; returns their number. */
static size_t list_places_from_root(const struct json_place *place,
                                    const struct json_place *chain[DEPTH_MAX])
{
    size_t count = 0;

    for (const struct json_place *one = place; one->above && count < DEPTH_MAX; one = one->above) {
        count++;
    }
    for (size_t i = count; i > 0; i--) {
        chain[i - 1] = place;
        place = place->above;
    }
    return count;
}

/*
 * Text position of a member of the object or list that begins at `at`: of its key, or of the list
 * element. NULL where there is none.
 */
static const char *find_member_in_text(const char *at, const struct json_place *place)
{
    size_t index = 0;

    if (*at != '{' && *at != '[') {
        return NULL;
    }
    for (at = skip_space(at + 1); *at && *at != '}' && *at != ']'; index++) {
        if (place->key) {
            const char *key = at;
            size_t length = strlen(place->key);

            if (!strncmp(key + 1, place->key, length) && key[1 + length] == '"') {
                return key;
            }
            at = skip_space(skip_string(at));
            at = *at == ':' ? skip_space(at + 1) : at;
        } else if (index == place->index) {
            return at;
        }
        at = skip_space(skip_value(at));
        at = *at == ',' ? skip_space(at + 1) : at;
    }
    return NULL;
}

/* Text position of a place, or of the nearest place above it that the text has; never NULL. */
static const char *find_nearest_place_in_text(const struct json_place *place)
{
    const struct json_place *chain[DEPTH_MAX];
    size_t count = list_places_from_root(place, chain);
    const char *at = skip_space(place->file->text);

    for (size_t i = 0; i < count; i++) {
        const char *member, *value = at;

        if (i > 0 && chain[i - 1]->key) { /* skip from the key to its value */
            value = skip_space(skip_string(at));
            value = *value == ':' ? skip_space(value + 1) : value;
        }
        member = find_member_in_text(value, chain[i]);
        if (!member) {
            return at;
        }
        at = member;
    }
    return at;
}

static size_t line_number_at(const char *text, const char *at)
{
    size_t line = 1;

    for (; text < at; text++) {
        line += *text == '\n';
    }
    return line;
}

static void format_place(const struct json_place *place, char text[PLACE_BYTES])
{
    const struct json_place *chain[DEPTH_MAX];
    size_t count = list_places_from_root(place, chain), used = 0;

    text[0] = '\0';
    for (size_t i = 0; i < count && used < PLACE_BYTES; i++) {
        if (chain[i]->key) {
            snprintf(text + used, PLACE_BYTES - used, "%s%s", used > 0 ? "." : "", chain[i]->key);
        } else {
            snprintf(text + used, PLACE_BYTES - used, "[%zu]", chain[i]->index);
        }
        used = strlen(text);
    }
}

static _Noreturn void fail_at_place(const struct json_place *place, const char *what)
{
    char where[PLACE_BYTES];

    format_place(place, where);
    fail(EXIT_USAGE, "%s:%zu: %s%s%s", place->file->name,
         line_number_at(place->file->text, find_nearest_place_in_text(place)), where,
         where[0] ? ": " : "", what);
}

void json_fail(const struct json_place *place, const char *format, ...)
{
    char what[WHAT_BYTES];
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    fail_at_place(place, what);
}

static struct json_place place_of_key(const struct json_object *object, const char *key)
{
    return (struct json_place){.file = object->place.file, .above = &object->place, .key = key};
}

void json_fail_key(const struct json_object *object, const char *key, const char *format, ...)
{
    struct json_place place = place_of_key(object, key);
    char what[WHAT_BYTES];
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    fail_at_place(&place, what);
}

struct json_file json_open(const char *name, const char *text, size_t length)
{
    struct json_file file = {.name = name, .text = text};
    const char *end = NULL;

    if (memchr(text, '\0', length)) {
        fail(EXIT_USAGE, "%s: not a text file", name);
    }
    file.root = cJSON_ParseWithOpts(text, &end, 0);
    if (!file.root && (!end || !*skip_space(end))) {
        fail(EXIT_USAGE, "%s:%zu: not valid JSON: it ends too early, or has an extra comma", name,
             line_number_at(text, text + length));
    }
    if (!file.root) {
        fail(EXIT_USAGE, "%s:%zu: not valid JSON near '%.*s'", name, line_number_at(text, end),
             (int)strcspn(end, "\r\n"), end);
    }
    end = skip_space(end);
    if (*end) {
        fail(EXIT_USAGE, "%s:%zu: more text after the end of the scene", name,
             line_number_at(text, end));
    }
    if (!cJSON_IsObject(file.root)) {
        fail(EXIT_USAGE, "%s:1: a scene is a JSON object, {...}", name);
    }
    return file;
}

void json_close(struct json_file *file)
{
    cJSON_Delete(file->root);
    file->root = NULL;
}

/*
 * Parses one step of a path, `key`, `[3]` or `3`, and moves *path behind it; *index is -1 for a
 * key. False where it is none of these.
 */
static bool parse_path_step(const char **path, char key[KEY_BYTES], int *index)
{
    bool is_bracketed = **path == '[';
    const char *start = *path + (is_bracketed || **path == '.');
    size_t length = strcspn(start, is_bracketed ? "]=" : ".[=");
    bool is_number = length > 0 && length < 7 && strspn(start, "0123456789") >= length;

    snprintf(key, KEY_BYTES, "%.*s", (int)length, start);
    *index = is_number ? (int)strtol(start, NULL, 10) : -1;
    *path = start + length;
    if (!is_bracketed) {
        return length > 0 && length < KEY_BYTES;
    }
    *path += **path == ']';
    return is_number && (*path)[-1] == ']';
}

static cJSON *child_at_path_step(cJSON *item, const char *key, int index)
{
    if (index >= 0) {
        return cJSON_IsArray(item) ? cJSON_GetArrayItem(item, index) : NULL;
    }
    return cJSON_IsObject(item) ? cJSON_GetObjectItemCaseSensitive(item, key) : NULL;
}

static bool set_child_at_path_step(cJSON *item, const char *key, int index, cJSON *value)
{
    if (index < 0) {
        return cJSON_IsObject(item) && (cJSON_ReplaceItemInObjectCaseSensitive(item, key, value) ||
                                        cJSON_AddItemToObject(item, key, value));
    }
    if (!cJSON_IsArray(item) || index > cJSON_GetArraySize(item)) {
        return false;
    }
    return index < cJSON_GetArraySize(item) ? cJSON_ReplaceItemInArray(item, index, value)
                                            : cJSON_AddItemToArray(item, value);
}

/* Object whose member names hinted_member_name gives: name_hint_nearest passes no context. */
static const cJSON *hinted_item;

static const char *hinted_member_name(size_t index)
{
    const cJSON *member = cJSON_GetArrayItem(hinted_item, (int)index);

    return member ? member->string : NULL;
}

/* Exits with an error for an assignment whose path does not exist, naming the most similar key. */
static _Noreturn void fail_unknown_path(const char *assignment, const cJSON *item, const char *key)
{
    const char *hint = NULL;

    if (cJSON_IsArray(item)) {
        fail(EXIT_USAGE, "--set %s: the scene has no such element: '%s' of a list of %d",
             assignment, key, cJSON_GetArraySize(item));
    }
    if (cJSON_IsObject(item)) {
        hinted_item = item;
        hint = name_hint_nearest(key, hinted_member_name);
    }
    fail(EXIT_USAGE, "--set %s: the scene has no such key: '%s'%s%s%s", assignment, key,
         hint ? ", did you mean '" : "", hint ? hint : "", hint ? "'?" : "");
}

void json_assign_by_path(struct json_file *file, const char *assignment)
{
    const char *path = assignment, *equals = strchr(assignment, '=');
    cJSON *item = file->root, *value, *below;
    char key[KEY_BYTES];
    int index;

    if (!equals || equals == assignment) {
        fail(EXIT_USAGE, "--set %s: not of the form place=value", assignment);
    }
    value = cJSON_ParseWithOpts(equals + 1, NULL, 1);
    value = value ? value : cJSON_CreateString(equals + 1);
    for (;;) {
        if (!parse_path_step(&path, key, &index) ||
            (*path != '=' && *path != '.' && *path != '[')) {
            fail(EXIT_USAGE, "--set %s: not of the form place=value", assignment);
        }
        if (*path == '=') {
            break;
        }
        below = child_at_path_step(item, key, index);
        if (!below) {
            fail_unknown_path(assignment, item, key);
        }
        item = below;
    }
    if (!set_child_at_path_step(item, key, index, value)) {
        fail_unknown_path(assignment, item, key);
    }
}

static const char *json_kind_name(const cJSON *item)
{
    return cJSON_IsObject(item)   ? "an object"
           : cJSON_IsArray(item)  ? "a list"
           : cJSON_IsString(item) ? "a text"
           : cJSON_IsNumber(item) ? "a number"
           : cJSON_IsBool(item)   ? "true or false"
                                  : "null";
}

/* Makes a json_object of a value; exits with an error where it is no object or has a key twice. */
static struct json_object checked_object(struct json_place place, const cJSON *item)
{
    struct json_object object = {.place = place, .item = item};

    if (!cJSON_IsObject(item)) {
        json_fail(&place, "must be an object, {...}, but is %s", json_kind_name(item));
    }
    for (const cJSON *one = item->child; one; one = one->next) {
        for (const cJSON *other = one->next; other; other = other->next) {
            if (!strcmp(one->string, other->string)) {
                json_fail_key(&object, one->string, "occurs twice");
            }
        }
    }
    return object;
}

struct json_object json_root(const struct json_file *file)
{
    return checked_object((struct json_place){.file = file}, file->root);
}

/* The value of the key or NULL; the key is noted as known, for json_refuse_unknown_keys. */
static const cJSON *get_and_note_key(struct json_object *object, const char *key)
{
    size_t i = 0;

    while (i < object->num_asked && strcmp(object->asked[i], key) != 0) {
        i++;
    }
    if (i == object->num_asked) {
        if (object->num_asked == JSON_KEYS_MAX) {
            fail(EXIT_RUNTIME, "an object with too many keys");
        }
        object->asked[object->num_asked++] = key;
    }
    return cJSON_GetObjectItemCaseSensitive(object->item, key);
}

bool json_has_key(struct json_object *object, const char *key)
{
    return get_and_note_key(object, key) != NULL;
}

void json_require_key(struct json_object *object, const char *key)
{
    if (!get_and_note_key(object, key)) {
        json_fail(&object->place, "%s is missing", key);
    }
}

void json_exclude_keys(struct json_object *object, const char *key, const char *other)
{
    if (get_and_note_key(object, key) && get_and_note_key(object, other)) {
        json_fail_key(object, other, "does not go with %s", key);
    }
}

static double checked_number(const struct json_place *place, const cJSON *item, double min,
                             double max)
{
    if (!cJSON_IsNumber(item)) {
        json_fail(place, "must be a number, but is %s", json_kind_name(item));
    }
    if (!(item->valuedouble >= min && item->valuedouble <= max)) {
        json_fail(place, "%.10g is outside %.10g .. %.10g", item->valuedouble, min, max);
    }
    return item->valuedouble;
}

double json_read_number(struct json_object *object, const char *key, double min, double max,
                        double otherwise)
{
    struct json_place place = place_of_key(object, key);
    const cJSON *item = get_and_note_key(object, key);

    return item ? checked_number(&place, item, min, max) : otherwise;
}

uint64_t json_read_count(struct json_object *object, const char *key, uint64_t min, uint64_t max,
                         uint64_t otherwise)
{
    double number = json_read_number(object, key, (double)min, (double)max, (double)otherwise);

    if (number != floor(number)) {
        json_fail_key(object, key, "%.10g is not a whole number", number);
    }
    return (uint64_t)number;
}

bool json_read_flag(struct json_object *object, const char *key, bool otherwise)
{
    const cJSON *item = get_and_note_key(object, key);

    if (item && !cJSON_IsBool(item)) {
        json_fail_key(object, key, "must be true or false, but is %s", json_kind_name(item));
    }
    return item ? cJSON_IsTrue(item) : otherwise;
}

const char *json_read_text(struct json_object *object, const char *key, const char *otherwise)
{
    const cJSON *item = get_and_note_key(object, key);

    if (item && !cJSON_IsString(item)) {
        json_fail_key(object, key, "must be a text, but is %s", json_kind_name(item));
    }
    return item ? item->valuestring : otherwise;
}

static void read_numbers(const struct json_place *place, const cJSON *item, size_t count,
                         double min, double max, double *numbers)
{
    size_t i = 0;

    if (!cJSON_IsArray(item) || (size_t)cJSON_GetArraySize(item) != count) {
        json_fail(place, "must be a list of %zu numbers", count);
    }
    for (const cJSON *one = item->child; one; one = one->next, i++) {
        struct json_place below = {.file = place->file, .above = place, .index = i};

        numbers[i] = checked_number(&below, one, min, max);
    }
}

bool json_read_numbers(struct json_object *object, const char *key, size_t count, double min,
                       double max, double *numbers)
{
    struct json_place place = place_of_key(object, key);
    const cJSON *item = get_and_note_key(object, key);

    if (item) {
        read_numbers(&place, item, count, min, max, numbers);
    }
    return item != NULL;
}

void json_read_xy(struct json_object *object, const char *key, double max, double *x, double *y)
{
    double numbers[2] = {*x, *y};

    json_read_numbers(object, key, 2, -max, max, numbers);
    *x = numbers[0];
    *y = numbers[1];
}

struct json_span json_read_span(struct json_object *object, const char *key, double min, double max,
                                struct json_span otherwise)
{
    struct json_place place = place_of_key(object, key);
    const cJSON *item = get_and_note_key(object, key);
    double ends[2] = {0, 0};

    if (!item) {
        return otherwise;
    }
    if (cJSON_IsNumber(item)) {
        ends[0] = ends[1] = checked_number(&place, item, min, max);
    } else if (!cJSON_IsArray(item) || cJSON_GetArraySize(item) != 2) {
        json_fail(&place, "must be a number or a list of two, [least, most]");
    } else {
        read_numbers(&place, item, 2, min, max, ends);
    }
    if (ends[0] > ends[1]) {
        json_fail(&place, "the first, %.10g, is above the second, %.10g", ends[0], ends[1]);
    }
    return (struct json_span){ends[0], ends[1]};
}

size_t json_read_choice(struct json_object *object, const char *key, const char *const *words,
                        size_t count, size_t otherwise)
{
    const char *text = json_read_text(object, key, NULL);
    char all[256] = "";

    if (!text) {
        return otherwise;
    }
    for (size_t i = 0; i < count; i++) {
        if (!strcmp(text, words[i])) {
            return i;
        }
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s", i > 0 ? ", " : "", words[i]);
    }
    json_fail_key(object, key, "'%s' is none of %s", text, all);
}

bool json_read_object(struct json_object *object, const char *key, struct json_object *below)
{
    const cJSON *item = get_and_note_key(object, key);

    if (item) {
        *below = checked_object(place_of_key(object, key), item);
    }
    return item != NULL;
}

struct json_list json_read_list(struct json_object *object, const char *key, size_t max)
{
    struct json_list list = {.place = place_of_key(object, key),
                             .item = get_and_note_key(object, key)};

    if (list.item && !cJSON_IsArray(list.item)) {
        json_fail(&list.place, "must be a list, [...], but is %s", json_kind_name(list.item));
    }
    list.count = list.item ? (size_t)cJSON_GetArraySize(list.item) : 0;
    if (list.count > max) {
        json_fail(&list.place, "has %zu elements; at most %zu are allowed", list.count, max);
    }
    return list;
}

static struct json_place place_of_element(const struct json_list *list, size_t index)
{
    return (struct json_place){.file = list->place.file, .above = &list->place, .index = index};
}

struct json_object json_element(const struct json_list *list, size_t index)
{
    return checked_object(place_of_element(list, index),
                          cJSON_GetArrayItem(list->item, (int)index));
}

void json_element_numbers(const struct json_list *list, size_t index, size_t count, double min,
                          double max, double *numbers)
{
    struct json_place place = place_of_element(list, index);

    read_numbers(&place, cJSON_GetArrayItem(list->item, (int)index), count, min, max, numbers);
}

double json_element_number(const struct json_list *list, size_t index, double min, double max)
{
    struct json_place place = place_of_element(list, index);

    return checked_number(&place, cJSON_GetArrayItem(list->item, (int)index), min, max);
}

/* Object whose known keys hinted_key_name gives: name_hint_nearest passes no context. */
static const struct json_object *hinted_object;

static const char *hinted_key_name(size_t index)
{
    return index < hinted_object->num_asked ? hinted_object->asked[index] : NULL;
}

void json_refuse_unknown_keys(const struct json_object *object)
{
    for (const cJSON *one = object->item->child; one; one = one->next) {
        const char *hint;
        size_t i = 0;

        while (i < object->num_asked && strcmp(object->asked[i], one->string) != 0) {
            i++;
        }
        if (i < object->num_asked) {
            continue;
        }
        hinted_object = object;
        hint = name_hint_nearest(one->string, hinted_key_name);
        if (hint) {
            json_fail_key(object, one->string, "unknown key, did you mean '%s'?", hint);
        }
        json_fail_key(object, one->string, "unknown key");
    }
}
