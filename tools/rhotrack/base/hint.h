/* SPDX-License-Identifier: MIT */
/* hint: which known name was meant by an unknown one? */
#ifndef RHOTRACK_TOOL_HINT_H
#define RHOTRACK_TOOL_HINT_H

#include <stddef.h>

/* Names by index, NULL past the last. */
typedef const char *(*hint_name)(size_t index);

/* The name with the fewest edits to the wanted one, or NULL where none is near. */
const char *hint_nearest(const char *wanted, hint_name name);

#endif
