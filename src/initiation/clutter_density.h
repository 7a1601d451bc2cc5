/* SPDX-License-Identifier: MIT */
/*
 * clutter_density: the density of clutter in the window of a search, in its scans and in the
 * hundred scans before. Private to src/initiation.
 */
#ifndef RHOTRACK_CLUTTER_DENSITY_H
#define RHOTRACK_CLUTTER_DENSITY_H

#include "search.h"

/* Measures the clutter density, or takes that of the revolution's first sector. */
void rho_density_begin(struct search *search);
/*
 * Measures the clutter density in the maps as they are laid out: counts all plots without a mark of
 * skip_flags, and adds more_plots to the mean.
 */
void rho_density_measure(struct search *search, uint16_t skip_flags, float more_plots);
/* Area over which clutter is spread: the window's extent, at least 1 m^2. */
float rho_density_area_m2(const struct rho_initiator *initiator);
/* Clutter density at a place, mean over the scans held, raised by the clutter memory. */
float rho_density_mean_at(const struct rho_initiator *initiator, float x_m, float y_m);
/*
 * ln of the clutter density that hit m of a set is compared with: the set's own plots are taken out
 * of the cell, and the clutter map's echoes are added.
 */
float rho_density_log_of_hit(const struct search *search, const struct plot_set *set, unsigned m);

/* Adds the window's oldest scan to the clutter memory before it leaves (clutter_memory.c). */
void rho_clutter_memory_add(struct rho_initiator *initiator);
/* Density at a place: density_per_m2, or the remembered one where that is significantly higher. */
float rho_clutter_memory_raise(const struct rho_initiator *initiator, float x_m, float y_m,
                               float density_per_m2);

#endif
