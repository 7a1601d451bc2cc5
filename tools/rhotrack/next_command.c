/* SPDX-License-Identifier: MIT */
#include "next_command.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/common.h"

/* Prints a word on standard error, quoted for the shell where needed. */
static void print_quoted_shell_word(const char *word, bool is_first)
{
    const bool is_plain =
        *word && strspn(word, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                              "_-+=./,:@%") == strlen(word);

    fputs(is_first ? "" : " ", stderr);
    if (is_plain) {
        fputs(word, stderr);
        return;
    }
    fputc('\'', stderr);
    for (; *word; word++) {
        fputs(*word == '\'' ? "'\\''" : (char[2]){*word, '\0'}, stderr);
    }
    fputc('\'', stderr);
}

void next_command_print(const struct command_line *line, const char *const *words)
{
    if (!isatty(STDERR_FILENO)) {
        return;
    }
    fputs("rhotrack: next: ", stderr);
    print_quoted_shell_word(program_invocation_name, true);
    for (; *words; words++) {
        print_quoted_shell_word(*words, false);
    }
    for (size_t i = 0; i < line->num_settings; i++) {
        print_quoted_shell_word(line->settings[i], false);
    }
    fputc('\n', stderr);
}

void next_command_print_page(const struct command_line *line, char *const *files, int num_files,
                             const char *tracks)
{
    const char **words = must_calloc((size_t)num_files + 6, sizeof *words);
    const int stem = (int)strlen(tracks) - (int)strlen(".csv");
    char *page = must_calloc((size_t)stem + sizeof ".html", 1);
    size_t count = 0;

    memcpy(page, tracks, (size_t)stem);
    memcpy(page + stem, ".html", sizeof ".html");
    words[count++] = "plot";
    words[count++] = "tracks";
    for (int i = 0; i < num_files; i++) {
        words[count++] = files[i];
    }
    words[count++] = tracks;
    words[count++] = "-o";
    words[count++] = page;
    next_command_print(line, words);
    free(page);
    free(words);
}

char *next_command_find_beside(const char *path, const char *name)
{
    const char *slash = strrchr(path, '/');
    const size_t length = slash ? (size_t)(slash - path) + 1 : 0;
    char *beside = must_calloc(length + strlen(name) + 1, 1);
    struct stat status;

    memcpy(beside, path, length);
    memcpy(beside + length, name, strlen(name));
    if (stat(beside, &status) == 0 && S_ISREG(status.st_mode)) {
        return beside;
    }
    free(beside);
    return NULL;
}

/* True where the header has all columns that the option value "NAME=COLUMN,..." maps. */
static bool header_has_mapped_columns(const char *header, const char *columns)
{
    while ((columns = strchr(columns, '='))) {
        const size_t length = strcspn(++columns, ",");

        if (!memmem(header, strlen(header), columns, length)) {
            return false;
        }
    }
    return true;
}

bool next_command_can_read(const struct command_line *line, const char *path)
{
    FILE *file = fopen(path, "r");
    char *header = NULL, *row = NULL;
    size_t room = 0, row_room = 0;
    bool can = file && getline(&header, &room, file) > 0 && getline(&row, &row_room, file) > 0;

    for (size_t i = 0; can && i < line->num_settings; i += 2) {
        can = strcmp(line->settings[i], "--columns") != 0 ||
              header_has_mapped_columns(header, line->settings[i + 1]);
    }
    free(header);
    free(row);
    if (file) {
        fclose(file);
    }
    return can;
}
