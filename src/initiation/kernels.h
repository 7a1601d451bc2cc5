/* SPDX-License-Identifier: MIT */
/*
 * kernels: pairs of plots far apart in time, the spans of scans between them, and the votes of
 * these scans. Private to src/initiation.
 */
#ifndef RHOTRACK_KERNELS_H
#define RHOTRACK_KERNELS_H

#include "search.h"

/* A scan between the first and the last scan of a span, which votes for the kernels of the span. */
struct voter {
    /* variance of a track's place in the voting scan, by process noise and turns */
    float process_m2;
    float gate_radius_m; /* radius of the widest gate of its votes */
};

#define SPANS_MAX (RHO_MAX_SCANS - 2)

/* A span: the values common to all kernels from scan a to scan b. */
struct span {
    uint8_t a, b;
    uint8_t misses_max; /* scans between a and b that need not vote, by M */
    /* scans between that need no vote where clutter is not thin; below 0: no kernel can start */
    int8_t misses_amid;
    const struct rho_window_scan *scan_a, *scan_b;
    float gap_s; /* time from scan a to scan b */
    /* most that noise adds to the distance of a kernel's plots; 0 with isotropic noise */
    float slack_m;
    const struct voter *voters; /* scans between a and b, from b backwards */
};

/* The last plot of kernels, and the gates of their votes. */
struct ending {
    const struct rho_window_plot *plot;
    /*
     * shares of the widest gates' radius that suffice for the noise of plots within a target's
     * travel of this plot: in any direction, and along the line of sight
     */
    float gate_share, along_share;
    float gate_rounded;     /* gate_share, with an allowance for rounding */
    float along_x, along_y; /* unit vector of the line of sight; 0, 0: not used */
    float rounding_m;       /* rounding error of places extrapolated from this plot, in float32 */
    int is_clear;           /* clutter here is thin: M votes suffice in all spans */
    struct rho_window_plot_noise noise; /* covariance of the plot; not set with isotropic noise */
};

/* Scans between that need no vote for kernels with this last plot; below 0: no kernels. */
static inline int rho_span_misses_max(const struct span *span, const struct ending *ending)
{
    return !HAS_SPAN_HITS || ending->is_clear ? (int)span->misses_max : (int)span->misses_amid;
}

/* A kernel's last vote: plot `index`, `gap` scans before the end. gap 0: not prescribed. */
struct first_vote {
    unsigned gap, index;
};

/* The spans of all kernels that end in one scan, the longest first. */
struct span_list {
    uint8_t num_spans;
    uint8_t has_span_hits; /* where clutter is not thin some spans need more votes than M */
    /* a bit a span: each scan's plots are not earlier than those of the scan before */
    uint8_t ordered;
    struct span spans[SPANS_MAX];
    struct voter voters[SPANS_MAX * (SPANS_MAX + 1) / 2]; /* voters of all spans, span by span */
};

/* Bounds the noise of a single radar by range, for narrower gates (vote_gates.c). */
void rho_vote_gates_bound(struct search *search);
/* Sets the shares of the widest gates that kernels need that end in this plot. */
void rho_vote_gates_of_ending(const struct search *search, float far_m, struct ending *ending);

/*
 * Collects the votes for the kernel from plot i of the span's first scan to `ending`. Returns 0
 * where they are too few. An ambiguous range rate makes several kernels of one pair: *next_alias, 0
 * at first, tells with which alias to continue, and is 0 after the last (plot_pair_votes.c).
 */
int rho_kernel_collect_votes(struct search *search, const struct span *span,
                             const struct ending *ending, const struct first_vote *first,
                             unsigned i, int *next_alias, struct plot_set *set);

/* Lists the spans of kernels that end in scan b (plot_pair_enumeration.c). */
void rho_kernels_list_spans(struct search *search, unsigned b, struct span_list *list);
/*
 * Number of plots, in the scan before the last, that a target in plot j may have come from: a
 * measure of the cost of the kernels that end there.
 */
unsigned rho_kernels_count_near(struct search *search, const struct span_list *list, unsigned j);
/* Tries all kernels that end in plot j. Returns 0 where the work is spent. */
int rho_kernels_try_ending(struct search *search, const struct span_list *list, unsigned j);

/* Tries all kernels of straight targets within the limit of work (search_order.c). */
void rho_kernels_try_straight(struct search *search);
/* Tries kernels of turning targets that end in the newest scan, with the work that is left. */
void rho_kernels_try_turning(struct search *search);

#endif
