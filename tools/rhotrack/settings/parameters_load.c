/* SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <errno.h>
#include <ini.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "settings/parameters.h"

/*
 * State of loading an INI file. inih does not pass line numbers to its handler, so they are counted
 * where inih reads a line.
 */
struct loading {
    struct parameters *parameters;
    const char *path;
    FILE *file;
    unsigned line;
};

static char *read_and_count_line(char *buffer, int size, void *user)
{
    struct loading *loading = user;
    char *line = fgets(buffer, size, loading->file);

    if (!line) {
        if (ferror(loading->file)) {
            fail(EXIT_USAGE, "%s: %s", loading->path, strerror(errno));
        }
        return NULL;
    }
    loading->line++;
    if (strlen(line) + 1 == (size_t)size && line[strlen(line) - 1] != '\n') {
        fail(EXIT_USAGE, "%s:%u: line longer than %d characters", loading->path, loading->line,
             size - 2);
    }
    return line;
}

/*
 * Prefix of keys in an INI section: "sensor.3." for "sensor 3", "" for the main sections; returns
 * false for unknown sections.
 */
static bool key_prefix_of_section(const char *section, char *prefix, size_t bytes)
{
    static const char *const kinds[] = {"sensor", "zone"};

    *prefix = '\0';
    if (!*section || !strcmp(section, "rhotrack")) {
        return true;
    }
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const char *number = section + strlen(kinds[i]);

        if (!strncmp(section, kinds[i], strlen(kinds[i])) && isspace((unsigned char)*number)) {
            number += strspn(number, " \t");
            snprintf(prefix, bytes, "%s.%.12s.", kinds[i], number);
            return true;
        }
    }
    return false;
}

static int assign_ini_value(void *user, const char *section, const char *name, const char *value)
{
    struct loading *loading = user;
    char prefix[32], key[128], reason[PARAMETER_REASON_BYTES];

    if (!key_prefix_of_section(section, prefix, sizeof prefix)) {
        fail(EXIT_USAGE,
             "%s:%u: unknown section [%s]; there are [rhotrack], [sensor N] and [zone N]",
             loading->path, loading->line, section);
    }
    snprintf(key, sizeof key, "%s%.80s", prefix, name);
    if (!parameters_assign(loading->parameters, key, value, SOURCE_CONFIG, reason)) {
        fail(EXIT_USAGE, "%s:%u: %s", loading->path, loading->line, reason);
    }
    return 1;
}

void parameters_load_ini(struct parameters *parameters, const char *path)
{
    static char comment_marks[] = ";#";
    struct loading loading = {parameters, path, fopen(path, "r"), 0};
    int bad_line;

    if (!loading.file) {
        fail(EXIT_USAGE, "%s: %s", path, strerror(errno));
    }
    ini_allow_multiline = false; /* indented lines do not continue the value above */
    ini_inline_comment_prefixes = comment_marks;
    ini_stop_on_first_error = true;
    ini_use_stack = false;
    ini_initial_alloc = ini_max_line = 400;
    bad_line = ini_parse_stream(read_and_count_line, &loading, assign_ini_value, &loading);
    if (bad_line < 0) {
        fail(EXIT_RUNTIME, "out of memory");
    }
    if (bad_line) {
        fail(EXIT_USAGE, "%s:%d: neither [section] nor key = value", path, bad_line);
    }
    fclose(loading.file);
}
