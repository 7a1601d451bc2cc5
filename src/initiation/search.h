/* SPDX-License-Identifier: MIT */
/*
 * search: what one search of the initiator carries from phase to phase, and the functions of each
 * phase. Private to src/initiation.
 */
#ifndef RHOTRACK_SEARCH_H
#define RHOTRACK_SEARCH_H

#include "rhotrack/detail/measurement.h"
#include "rhotrack/initiator.h"

#define LOG_PI 1.14472989f
#define LOG_TWO_PI 1.83787707f
#define LOG_HALF (-0.69314718f)

/* Normal deviates below which 95 % and 99.9 % of a distribution lie. */
#define SIGMAS_95 1.6449f
#define SIGMAS_99_9 3.0902f

/* Targets climb or sink by up to this share of v_max. */
#define CLIMB_SHARE 0.5f

/* Meanings of an ambiguous range rate to either side that are tried. More of them say little. */
#define ALIASES_MAX 8

/*
 * Whether long spans may need more votes than M. Where few plots are held that saves little, and
 * its code is left out.
 */
#define HAS_SPAN_HITS (RHO_MAX_PLOTS > 64)

struct search {
    struct rho_initiator *initiator;
    enum rho_search kind;
    unsigned wanted_mask; /* scans that must vote: the newest, or none in particular */
    unsigned num_scans;   /* N: scans held */
    float scans_seen;     /* the same; a revolution that has only begun counts by its share */
    /*
     * The newest input is a further sector of a revolution. The map and the thresholds are those of
     * its first sector; the plots of the newest scan are not in the map.
     */
    int is_continued;
    const struct rho_window_sector *newest; /* kernels end in this sector; NULL: anywhere */
    unsigned min_scans;                     /* M */
    float time_s[RHO_MAX_SCANS];            /* of the scans, after the newest: <= 0 */
    float interval_s;                       /* usual time between scans */
    int has_more;                           /* a scan has heights or range rates */
    float gate_chi2;                        /* of the widest gate */
    /*
     * Noise of a single radar, 0 where not known. sigma_near_m or sigma_per_m times the range,
     * whichever is larger, bounds every plot's; sigma_least_m is the smallest of the scans' maxima.
     */
    float sigma_near_m, sigma_per_m, sigma_least_m;
    int has_one_noise; /* every plot has noise of one axis, and no height or range rate */
    int is_isotropic;  /* the same, and sets are straight; ask rho_initiator_is_isotropic */
    float log_pd[RHO_MAX_SCANS], log_miss[RHO_MAX_SCANS]; /* by scan: ln pd, ln(1 - pd) */
    float log_ratio[RHO_MAX_SCANS]; /* by scan: ln of its sensor's clutter over the mean */
    float log_prior;                /* ln of the density of births over area and velocity */
    float process_m2[RHO_MAX_SCANS * (RHO_MAX_SCANS + 1) / 2]; /* displacements by process noise */
    float fit_process_m2; /* its largest residual variance about a fitted line */
    float turn_mps2;      /* sd of a set's acceleration in the plane; 0: sets are straight */
    float log_turn;       /* ln of the prior of that acceleration; 0 for straight sets */
    float log_turning;    /* the same while turns are assumed */
    uint16_t skip_flags;  /* plots with these marks are passed over */
    float score_min_nat;  /* a set below this score is no candidate */
    int keeps_rate;       /* thresholds follow from false_tracks_per_hour, and fits must be good */
    uint32_t work_max;    /* of this search; 0: no limit */
    uint32_t limit_units; /* work that may be done for now */
    int is_partial;       /* some of the work was left out */
    struct rho_initiator_resume next; /* where the next search begins */
    int is_left_out; /* the plots of the set that is scored are not in the density map */
};

/*
 * The fast path: noise of one axis in every scan, nothing else measured, straight sets. A build
 * without Cartesian plots has none.
 */
static inline int rho_initiator_is_isotropic(const struct search *search)
{
    return (RHO_SCAN_KINDS & 1) != 0 && search->is_isotropic;
}

/* A track: position and velocity at the time of the newest scan. */
struct line_fit {
    float x_m, y_m, vx_mps, vy_mps;
    float ax_mps2, ay_mps2; /* 0: straight */
    int has_z;              /* z_m and vz_mps are known; never in the isotropic path */
    float z_m, vz_mps;
};

/* How good a set is as a track. */
struct set_score {
    int32_t mnat;
    float chi2;          /* of the residual ... */
    unsigned dimensions; /* ... which has so many */
};

/* The plots of a hypothesis, by age order of their scans. */
struct plot_set {
    unsigned mask;
    unsigned hits;
    uint16_t plot[RHO_MAX_SCANS];
};

/* The plot of a hypothesis in scan m, and its own time. */
static inline const struct rho_window_plot *
rho_initiator_plot(const struct search *search, const struct plot_set *set, unsigned m)
{
    return &rho_window_scan_at(&search->initiator->window, m)->plots[set->plot[m]];
}

static inline float rho_initiator_plot_time_s(const struct search *search,
                                              const struct plot_set *set, unsigned m)
{
    return search->time_s[m] + rho_initiator_plot(search, set, m)->offset_s;
}

/* ---- before the search ----------------------------------------------------------------------- */

/* clutter_density.c: measured anew, or as the first sector of the revolution had it */
void rho_initiator_prepare_density(struct search *search);
/* The density without plots of these marks, but with more_plots besides. */
void rho_initiator_measure_density(struct search *search, uint16_t skip_flags, float more_plots);
float rho_initiator_area_m2(const struct rho_initiator *initiator);
float rho_initiator_mean_density(const struct rho_initiator *initiator, float x_m, float y_m);
/* ln of the density that hit m of a set is compared with */
float rho_initiator_log_density(const struct search *search, const struct plot_set *set,
                                unsigned m);

/* clutter_memory.c: takes the oldest scan in before it leaves the window */
void rho_initiator_add_to_memory(struct rho_initiator *initiator);
/*
 * The window's density at a place, raised to the remembered one where that is significantly more.
 */
float rho_initiator_memory_density(const struct rho_initiator *initiator, float x_m, float y_m,
                                   float density_per_m2);

/* process_noise.c */
void rho_initiator_prepare_process_noise(struct search *search);
/*
 * How far it bends tracks that begin in scan `first` off their fit: the largest variance, the sum.
 */
float rho_initiator_bend_m2(const struct search *search, unsigned first, float *sum_m2);
/* Variance of the place in scan m between the places in scans a and b. */
float rho_initiator_process_variance_m2(const struct search *search, unsigned a, unsigned m,
                                        unsigned b);

/* prior.c */
void rho_initiator_prepare_prior(struct search *search);
/* ln of the heights and range rates that clutter and births are spread over */
float rho_initiator_log_volume(const struct search *search, int has_z, unsigned heights,
                               unsigned range_rates);

/* distributions.c */
float rho_initiator_chi2_limit(unsigned dimensions, float sigmas);
float rho_initiator_log_factorial(unsigned n);

/* start_thresholds.c: M, and the scores that start and confirm a track */
void rho_initiator_set_thresholds(struct search *search);
void rho_initiator_update_thresholds(struct search *search);
/* ln of the prior of a turn, by the thresholds */
float rho_initiator_log_turn_prior(const struct search *search);
/* Sets are those of turning targets from here on, or of straight ones. */
void rho_initiator_assume_turns(struct search *search, int turns);

/* ---- work ------------------------------------------------------------------------------------ */

/* search_budget.c: work done so far, in units */
uint32_t rho_initiator_spent(const struct search *search);
int rho_initiator_is_spent(const struct search *search);
void rho_initiator_charge(const struct search *search, uint32_t units);
void rho_initiator_close_budget(struct search *search);

/* ---- kernels --------------------------------------------------------------------------------- */

/* A scan between two others: it votes for kernels from one to the other. */
struct voter {
    float process_m2;    /* variance of its place between them, by process noise and turns */
    float gate_radius_m; /* of the widest gate */
};

#define SPANS_MAX (RHO_MAX_SCANS - 2)

/* Rounding may add this factor to the distance of a vote from its kernel. */
#define GATE_ROUNDING 1.001f

/* The values common to all kernels from scan a to scan b. */
struct span {
    uint8_t a, b;
    uint8_t misses_max; /* scans between that need not vote, by M */
    int8_t misses_amid; /* ... amid clutter; below 0: no kernel of the span can start a track */
    const struct rho_window_scan *scan_a, *scan_b;
    float gap_s;                /* between the scans' times */
    float slack_m;              /* what noise may add to the distance of a pair; 0: isotropic */
    const struct voter *voters; /* by scans before b, the one before it first */
};

/* The last plot of kernels. */
struct ending {
    const struct rho_window_plot *plot;
    /*
     * Shares of the widest gates that the noise of plots within a target's travel of this one
     * needs: in any direction, and along the line of sight.
     */
    float gate_share, along_share;
    float gate_rounded;            /* the first one, with what rounding may add */
    float along_x, along_y;        /* the line of sight, or 0, 0 */
    float rounding_m;              /* of a place that is extrapolated from here, in float32 */
    int is_clear;                  /* M holds for all spans */
    struct rho_window_noise noise; /* covariance of the plot, not in the isotropic path */
};

/* Scans between that need not vote for kernels with this end; below 0: there are none. */
static inline int rho_initiator_misses_max(const struct span *span, const struct ending *ending)
{
    return !HAS_SPAN_HITS || ending->is_clear ? (int)span->misses_max : (int)span->misses_amid;
}

/* The vote of a kernel that is nearest to its end: plot `index`, `gap` scans before. gap 0: any. */
struct first_vote {
    unsigned gap, index;
};

/* All kernels that end in one scan. */
struct fan {
    uint8_t num_spans;
    uint8_t has_span_hits; /* some spans need more votes than M, where that holds */
    uint8_t ordered; /* bits: no plot of the span's scans is earlier than one of the scan before */
    struct span spans[SPANS_MAX];                         /* the longest first */
    struct voter voters[SPANS_MAX * (SPANS_MAX + 1) / 2]; /* theirs, span by span */
};

/*
 * vote_gate.c: the noise of a single radar; the gates about an ending, for plots within far_m of it
 */
void rho_initiator_prepare_vote_gates(struct search *search);
void rho_initiator_find_vote_gate(const struct search *search, float far_m, struct ending *ending);

/* The candidates of an ambiguous range rate: error + i span, i from first to last. */
struct aliases {
    struct rho_window_range_rate seen;
    float span_mps;
    int first, last;
};

/* range_rate_ambiguity.c: 0 where the plot's range rate is not ambiguous */
int rho_initiator_open_aliases(const struct rho_window_scan *scan,
                               const struct rho_window_plot *plot,
                               const struct rho_window_place *place, struct aliases *aliases);
/* *known: the place with its velocity as alias i has it */
void rho_initiator_apply_alias(const struct aliases *aliases, int i,
                               const struct rho_window_place *place,
                               struct rho_window_place *known);

/*
 * kernels.c: the votes for the kernel from plot i of the span's first scan to the ending. 0 where
 * they are too few. An ambiguous range rate makes several kernels of one pair: *next, 0 at first,
 * tells where to continue, and is 0 after the last.
 */
int rho_initiator_vote_for_kernel(struct search *search, const struct span *span,
                                  const struct ending *ending, const struct first_vote *first,
                                  unsigned i, int *next, struct plot_set *set);

/* kernel_enumeration.c: the spans that end in scan b */
void rho_initiator_open_fan(struct search *search, unsigned b, struct fan *fan);
/* Plots of the scan before that a target in plot j may have come from: what its kernels cost. */
unsigned rho_initiator_count_plots_near(struct search *search, const struct fan *fan, unsigned j);
/* Tries all kernels that end in plot j; 0 where the limit on work stopped that. */
int rho_initiator_try_kernels_to(struct search *search, const struct fan *fan, unsigned j);

/* kernel_schedule.c: all kernels, as far as the work goes */
void rho_initiator_try_kernels(struct search *search);
void rho_initiator_try_turning_kernels(struct search *search);

/* ---- candidates ------------------------------------------------------------------------------ */

/* track_fit.c: nats as thousandths; least squares; 0 where the plots do not determine a track */
int32_t rho_initiator_mnat(float nat);
int rho_initiator_fit(const struct search *search, const struct plot_set *set,
                      struct line_fit *fit);
/* The plots nearest to the fitted track; factor widens the gate's variance. */
void rho_initiator_associate_plots(struct search *search, const struct line_fit *fit, float factor,
                                   struct plot_set *set);
/* Fit and association in turns; 0 where too few scans vote, or no target is so fast. */
int rho_initiator_refine_set(struct search *search, struct plot_set *set, struct line_fit *fit);
int rho_initiator_score_set(const struct search *search, const struct plot_set *set,
                            const struct line_fit *fit, struct set_score *score);

/*
 * isotropic_fit.c and anisotropic_fit.c: the arithmetic of track_fit.c for the two kinds of noise
 */
int rho_initiator_fit_isotropic(const struct search *search, const struct plot_set *set,
                                struct line_fit *fit);
int rho_initiator_nearest_isotropic(struct search *search, const struct line_fit *fit, float factor,
                                    unsigned m);
int rho_initiator_likelihood_isotropic(const struct search *search, const struct plot_set *set,
                                       struct set_score *score, float *nat);
int rho_initiator_fit_anisotropic(const struct search *search, const struct plot_set *set,
                                  struct line_fit *fit);
int rho_initiator_nearest_anisotropic(struct search *search, const struct line_fit *fit,
                                      float factor, unsigned m);
int rho_initiator_likelihood_anisotropic(const struct search *search, const struct plot_set *set,
                                         struct set_score *score, float *nat);

/* Candidates passed in a list, and compared by their plots, that make a unit of work. */
#define PASSED_IN_UNIT 8u
#define COMPARED_IN_UNIT 2u

/* candidates.c: refines and scores a set; 0 where it is no candidate, or one that is listed */
int rho_initiator_make_candidate(struct search *search, struct plot_set *set,
                                 struct rho_candidate *candidate);
void rho_initiator_add_candidate(struct search *search, struct plot_set *set);
int rho_initiator_is_good_enough(const struct search *search, const struct set_score *score);
/* Its plots and its track; sets are straight or turning from here on, as it is. */
int rho_initiator_open_candidate(struct search *search, const struct rho_candidate *candidate,
                                 struct plot_set *set, struct line_fit *fit);

/* candidate_selection.c: no two candidates share plots; then the score against clutter alone */
void rho_initiator_select_candidates(struct search *search);
void rho_initiator_rescore_candidates(struct search *search);

/* initiator.c: every field within its range */
int rho_initiator_is_usable(const struct rho_initiator_config *config);

#endif
