/* SPDX-License-Identifier: MIT */
/* Where a window's plots lie. Private to src/window/window*.c. */
#ifndef RHOTRACK_WINDOW_EXTENT_H
#define RHOTRACK_WINDOW_EXTENT_H

#include "rhotrack/detail/window.h"

/* After a scan was pushed: the area that is not given follows the plots held. */
void rho_window_follow_extent(struct rho_window *window);

#endif
