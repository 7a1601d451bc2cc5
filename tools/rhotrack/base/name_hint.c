/* SPDX-License-Identifier: MIT */
#include "base/name_hint.h"

#include <string.h>

enum { LENGTH_MAX = 40 };

static size_t smaller_size(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Levenshtein distance: the fewest insertions, deletions and replacements that turn a into b. */
static size_t edit_distance(const char *a, const char *b)
{
    size_t length = strlen(b), row[LENGTH_MAX + 1];

    for (size_t j = 0; j <= length; j++) {
        row[j] = j;
    }
    for (size_t i = 1; a[i - 1]; i++) {
        size_t diagonal = row[0];

        row[0] = i;
        for (size_t j = 1; j <= length; j++) {
            size_t replaced = diagonal + (a[i - 1] != b[j - 1]);

            diagonal = row[j];
            row[j] = smaller_size(replaced, smaller_size(row[j], row[j - 1]) + 1);
        }
    }
    return row[length];
}

const char *name_hint_nearest(const char *wanted, name_by_index name)
{
    size_t length = strlen(wanted), best_edits = length / 3 + 2;
    const char *best = NULL, *known;

    if (length > LENGTH_MAX) {
        return NULL;
    }
    for (size_t i = 0; (known = name(i)); i++) {
        size_t n = strlen(known) <= LENGTH_MAX ? edit_distance(wanted, known) : LENGTH_MAX;

        if (n < best_edits) {
            best_edits = n;
            best = known;
        }
    }
    return best;
}
