/* SPDX-License-Identifier: MIT */
#include "scene/scene_shipped.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "scene/scene.h"

#define SCENE_BYTES_MAX (16u << 20)

static char *read_file(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    size_t room = 0;
    char *text = NULL;
    int byte;

    if (!file) {
        fail(EXIT_USAGE, "%s: %s", path, strerror(errno));
    }
    *length = 0;
    while ((byte = getc(file)) != EOF) {
        text = must_make_room_for_one(text, *length, &room, 1);
        text[(*length)++] = (char)byte;
        if (*length > SCENE_BYTES_MAX) {
            fail(EXIT_USAGE, "%s: larger than 16 MiB, the limit for a scene", path);
        }
    }
    if (ferror(file)) {
        fail(EXIT_USAGE, "%s: %s", path, strerror(errno));
    }
    fclose(file);
    text = must_make_room_for_one(text, *length, &room, 1);
    text[*length] = '\0';
    return text;
}

const char *scene_shipped_name(size_t index)
{
    return shipped_scenes[index].name;
}

struct scene *scene_load_by_name(const char *name, const char *const *sets, size_t num_sets)
{
    size_t length, index = 0;

    if (strchr(name, '/') || path_ends_with(name, ".json")) {
        char *text = read_file(name, &length);

        return scene_read(name, text, length, sets, num_sets);
    }
    while (shipped_scenes[index].name && strcmp(shipped_scenes[index].name, name) != 0) {
        index++;
    }
    if (!shipped_scenes[index].name) {
        return NULL;
    }
    return scene_read(name, must_copy_text(shipped_scenes[index].text),
                      strlen(shipped_scenes[index].text), sets, num_sets);
}
