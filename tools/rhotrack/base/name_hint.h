/* SPDX-License-Identifier: MIT */
/* name_hint: the known name that is most similar to a misspelled one ("did you mean ...?"). */
#ifndef RHOTRACK_TOOL_NAME_HINT_H
#define RHOTRACK_TOOL_NAME_HINT_H

#include <stddef.h>

/* Returns the known name with this index, NULL past the last one. */
typedef const char *(*name_by_index)(size_t index);

/* The known name with the fewest edits from the wanted one; NULL where none is similar. */
const char *name_hint_nearest(const char *wanted, name_by_index name);

#endif
