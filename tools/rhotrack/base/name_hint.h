/* SPDX-License-Identifier: MIT */
/* name_hint: which known name was meant by an unknown one? */
#ifndef RHOTRACK_TOOL_NAME_HINT_H
#define RHOTRACK_TOOL_NAME_HINT_H

#include <stddef.h>

/* Names by index, NULL past the last. */
typedef const char *(*name_by_index)(size_t index);

/* The name with the fewest edits to the wanted one, or NULL where none is near. */
const char *name_hint_nearest(const char *wanted, name_by_index name);

#endif
