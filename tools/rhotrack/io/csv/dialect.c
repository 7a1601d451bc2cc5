/* SPDX-License-Identifier: MIT */
#include "io/csv/dialect.h"

#include <stdbool.h>
#include <string.h>

char dialect_find_delimiter(const char *line, size_t length)
{
    static const char delimiters[] = ",;\t";

    for (const char *delimiter = delimiters; *delimiter; delimiter++) {
        bool is_quoted = false;

        for (size_t i = 0; i < length; i++) {
            is_quoted ^= line[i] == '"';
            if (line[i] == *delimiter && !is_quoted) {
                return *delimiter;
            }
        }
    }
    return memchr(line, '"', length) ? ',' : ' ';
}

size_t dialect_join_blanks(const char *line, size_t length, char *copy)
{
    size_t used = 0;

    for (size_t i = 0; i < length; i++) {
        if (line[i] == '\r' || line[i] == '\n') {
            copy[used++] = line[i];
        } else if (line[i] != ' ' && line[i] != '\t') {
            if (used > 0 && (line[i - 1] == ' ' || line[i - 1] == '\t')) {
                copy[used++] = ',';
            }
            copy[used++] = line[i];
        }
    }
    return used;
}

void dialect_point_for_comma(char *cell)
{
    char *comma = strchr(cell, ',');

    if (comma && cell[strspn(cell, "+-0123456789,eE")] == '\0' && !strchr(comma + 1, ',')) {
        *comma = '.';
    }
}
