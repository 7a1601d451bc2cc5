/* SPDX-License-Identifier: MIT */
/* window_extent: the rectangle in which a window's plots lie. Private to src/window. */
#ifndef RHOTRACK_WINDOW_EXTENT_H
#define RHOTRACK_WINDOW_EXTENT_H

#include "rhotrack/detail/window.h"

/* Updates the extent of a window without a given area by the plots held, after a push. */
void rho_window_update_extent(struct rho_window *window);

#endif
