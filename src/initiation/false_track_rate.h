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

/* Largest number of classes of places with similar clutter and noise. */
enum { CLASSES_MAX = 8 };

/* Number of patterns: pairs of a first scan and a number of hits up to the newest scan. */
#define PATTERNS_MAX ((RHO_MAX_SCANS - 2) * (RHO_MAX_SCANS - 1) / 2)

struct place_class {
    float log_density; /* ln of the clutter density there, plots a m^2 and scan */
    /* ln of the sigmas of plots there */
    float log_range, log_cross, log_up, log_range_rate;
    float share; /* share of the area that places of the class have */
};

/* A pattern: sets of so many hits, the first one in the same scan, the last in the newest. */
struct pattern {
    uint16_t first, hits;
    float log_choices; /* ln of the number of choices of the scans between */
    float spread_s2;   /* mean spread of the hits' times, by mean_hit_spread_s2 */
    float inside;      /* share of tracks of this duration that stay in the area */
    float half_dimensions;
    float most; /* largest chi2 / 2 of a fit that is accepted */
};

/* Score and weight of a pattern in one class of places. */
struct pattern_score {
    /* expected sets for a margin of 1 nat: births, hits, misses, choices, e^-c over Gamma(k + 1) */
    float weight;
    float best_nat; /* c: score of a perfect fit */
};

/* Model of the false tracks that clutter makes in the window of a search. */
struct false_tracks {
    const struct search *search;
    int has_z, has_range_rate;
    /* ln of the number of aliases of a range rate, mean over the scans; 0: none is ambiguous */
    float log_aliases;
    /* by first scan of a track: variance by which process noise bends it, summed over its scans */
    float bend_m2[RHO_MAX_SCANS];
    unsigned num_classes, num_patterns;
    unsigned least_hits; /* patterns with fewer hits start no track */
    struct place_class classes[CLASSES_MAX];
    struct pattern patterns[PATTERNS_MAX];
    struct pattern_score scores[CLASSES_MAX][PATTERNS_MAX];
};

/* Fills the model for the window of a search. */
void rho_false_tracks_model(const struct search *search, struct false_tracks *model);
/*
 * Expected number of false tracks of one search whose score reaches score_nat at once, and which
 * had not reached start_nat before. Counting ends at `stop_at_sum`; FLT_MAX counts all.
 */
float rho_false_tracks_above(const struct false_tracks *model, float score_nat, float start_nat,
                             float stop_at_sum);
/* Share of the false tracks started at start_nat that are still in the area at the next scan. */
float rho_false_tracks_staying(const struct false_tracks *model, float start_nat);
/* Score that one more perfect hit adds to a tentative track, least of all classes of places. */
float rho_false_tracks_least_gain(const struct false_tracks *model);
/*
 * Fewest hits, at least the model's least_hits, with which sets from scan `first` to the newest
 * reach start_nat in any class; N + 1 where none do.
 */
unsigned rho_false_tracks_least_hits(const struct false_tracks *model, unsigned first,
                                     float start_nat);
/* Clutter plots within the noise of a plot, in the class of places with the fewest; at most 1. */
float rho_false_tracks_thinnest(const struct false_tracks *model);
/* True where at least half of the targets with the least number of hits reach start_nat. */
int rho_false_tracks_let_start(const struct false_tracks *model, float start_nat);

#endif
