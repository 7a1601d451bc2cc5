/* SPDX-License-Identifier: MIT */
/*
 * initiator_chance: how many tracks clutter makes by chance, by their scores. Private to initiator_chance.c and
 * initiator_rate.c.
 *
 * Of all sets of h clutter plots in given scans, the expected number whose score reaches s is (src/DESIGN.md derives
 * it)
 *
 *     E(s) = births pd^h (1 - pd)^misses e^-c y^k / k!,      y = c - s,
 *
 * with c the score of a perfect fit, 2 k the dimensions of its residual (chi2 / 2 = c - score), and births the targets
 * expected in the prior.
 */
#ifndef RHOTRACK_INITIATOR_CHANCE_H
#define RHOTRACK_INITIATOR_CHANCE_H

#include "initiator_search.h"

/* Places with about the same clutter and noise. */
#define CLASSES_MAX 8

/* first scan to newest, and hits among them */
#define PATTERNS_MAX ((RHO_MAX_SCANS - 2) * (RHO_MAX_SCANS - 1) / 2)

struct place_class {
    float log_density;                                  /* of the clutter there */
    float log_range, log_cross, log_up, log_range_rate; /* of the sigmas */
    float share;                                        /* of the area */
};

/* Sets with the same number of hits, from the same first scan. */
struct pattern {
    uint16_t first, hits;
    float log_choices; /* of the scans between */
    float spread_s2;   /* mean_spread_s2 */
    float inside;      /* share of tracks so long that stay in the area */
    float half_dimensions;
    float most; /* chi2 / 2 that a fit may have */
};

/* A pattern in one class of places. */
struct reach {
    float weight;   /* births, pattern of hits, choices of scans and e^-c, over Gamma(k + 1) */
    float best_nat; /* c */
};

/* All of them. */
struct chance {
    const struct search *search;
    int has_z, has_range_rate;
#if RHO_AMBIGUOUS_RANGE_RATES
    float
        log_aliases; /* ln of how many range rates are taken for one, mean over the scans; 0: none are ambiguous */
#endif
    float bend_m2
        [RHO_MAX_SCANS]; /* by process noise, of tracks from this scan on: sum over the scans */
    unsigned num_classes, num_patterns;
    unsigned least_hits; /* patterns with fewer do not count */
    struct place_class classes[CLASSES_MAX];
    struct pattern patterns[PATTERNS_MAX];
    struct reach reaches[CLASSES_MAX][PATTERNS_MAX];
};

/* Lays out the search's window. */
void rho_initiator_lay_chance(const struct search *search, struct chance *chance);

/*
 * Chance tracks a search that are new at start_nat, and whose score reaches s_nat at once. Counting
 * ends where they are more than enough: FLT_MAX counts all.
 */
float rho_initiator_sets_above(const struct chance *chance, float s_nat, float start_nat,
                               float enough);

/* Share of the tracks that start by chance at start_nat whose next place is still in the area. */
float rho_initiator_stay_inside(const struct chance *chance, float start_nat);

/* What one more perfect hit adds to a tentative track, in the class with the most clutter a noise cell. */
float rho_initiator_gain_of_hit(const struct chance *chance);

/* Does the threshold leave room for a target's chi2, with the least number of hits? */
int rho_initiator_leaves_room(const struct chance *chance, float start_nat);

#endif
