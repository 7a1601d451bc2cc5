/* SPDX-License-Identifier: MIT */
/*
 * false_track_rate: the expected number of tracks that clutter alone makes, by their scores.
 * Private to src/initiation.
 *
 * Of all sets of h clutter plots in given scans, the expected number whose score reaches s is
 * (src/DESIGN.md derives it)
 *
 *     E(s) = births pd^h (1 - pd)^misses e^-c y^k / k!,      y = c - s,
 *
 * with c the score of a perfect fit, 2 k the dimensions of its residual (chi2 / 2 = c - score), and
 * births the targets expected in the prior.
 */
#ifndef RHOTRACK_FALSE_TRACK_RATE_H
#define RHOTRACK_FALSE_TRACK_RATE_H

#include "search.h"

/* Classes of places with similar clutter and noise. */
#define CLASSES_MAX 8

/* Patterns: first scan, and number of hits up to the newest. */
#define PATTERNS_MAX ((RHO_MAX_SCANS - 2) * (RHO_MAX_SCANS - 1) / 2)

struct place_class {
    float log_density;                                  /* of the clutter there */
    float log_range, log_cross, log_up, log_range_rate; /* ln of the sigmas */
    float share;                                        /* its share of the area */
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
struct pattern_score {
    float weight;   /* births, pattern of hits, choices of scans and e^-c, over Gamma(k + 1) */
    float best_nat; /* c */
};

/* The model of the false tracks that clutter makes in a window. */
struct false_tracks {
    const struct search *search;
    int has_z, has_range_rate;
    /* ln of how many range rates look alike, mean over the scans; 0 where none is ambiguous */
    float log_aliases;
    /* how far process noise bends tracks that begin in a scan: summed over their scans */
    float bend_m2[RHO_MAX_SCANS];
    unsigned num_classes, num_patterns;
    unsigned least_hits; /* patterns with fewer do not count */
    struct place_class classes[CLASSES_MAX];
    struct pattern patterns[PATTERNS_MAX];
    struct pattern_score scores[CLASSES_MAX][PATTERNS_MAX];
};

/* Fills the model of the search's window. */
void rho_initiator_model_false_tracks(const struct search *search, struct false_tracks *model);

/*
 * False tracks of one search that are new at start_nat and whose score reaches s_nat at once.
 * Counting ends at `enough`; FLT_MAX counts all.
 */
float rho_initiator_false_sets_above(const struct false_tracks *model, float s_nat, float start_nat,
                                     float enough);

/* Share of the false tracks started at start_nat whose next place is still in the area. */
float rho_initiator_share_staying_inside(const struct false_tracks *model, float start_nat);

/*
 * Score that one more perfect hit adds to a tentative track, in the class with the most clutter per
 * noise cell.
 */
float rho_initiator_gain_of_hit(const struct false_tracks *model);

/*
 * Fewest hits, the model's least at least, with which sets from scan `first` to the newest reach
 * the threshold in any class; N + 1 where none do.
 */
unsigned rho_initiator_least_hits_from(const struct false_tracks *model, unsigned first,
                                       float start_nat);

/* Clutter plots in the noise of a plot, in the class with the least. */
float rho_initiator_thinnest_clutter(const struct false_tracks *model);

/* True where targets with the least number of hits reach the threshold in spite of their chi2. */
int rho_initiator_lets_targets_start(const struct false_tracks *model, float start_nat);

#endif
