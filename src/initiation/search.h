/* SPDX-License-Identifier: MIT */
/*
 * search: the state that one search of the initiator carries from phase to phase, and the functions
 * of each phase. Private to src/initiation.
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

/* Largest climb or sink rate of targets, as a share of v_max. */
#define CLIMB_SHARE 0.5f

/*
 * Most aliases of an ambiguous range rate that are tried on either side. More of them carry little
 * information.
 */
#define ALIASES_MAX 8

/*
 * True where long spans may need more votes than M. Builds that hold few plots leave that out, as
 * it saves little there.
 */
#define HAS_SPAN_HITS (RHO_MAX_PLOTS > 64)

struct search {
    struct rho_initiator *initiator;
    enum rho_search kind;
    unsigned wanted_mask; /* bits of the scans that must vote: the newest, or none in a batch */
    unsigned num_scans;   /* N: number of scans held */
    /* number of scans held; a revolution that has only begun counts by its share */
    float scans_seen;
    /*
     * the newest input is a further sector of a revolution. Density map and thresholds are then
     * those of its first sector; the map does not count the plots of the newest scan
     */
    int is_continued;
    /* the sector in which kernels end; NULL: kernels may end in any plot of the last scan */
    const struct rho_window_sector *newest;
    unsigned min_scans;          /* M: votes that a track needs */
    float time_s[RHO_MAX_SCANS]; /* times of the scans relative to the newest: <= 0 */
    float interval_s;            /* usual time between scans */
    int has_more;                /* a scan measures heights or range rates */
    float gate_chi2;             /* limit of the NIS in the widest gate */
    /*
     * bounds of the noise of a single radar, 0 where not known: each plot's sigma is at most the
     * larger of sigma_near_m and sigma_per_m times its range; sigma_least_m is the smallest of the
     * scans' largest sigmas
     */
    float sigma_near_m, sigma_per_m, sigma_least_m;
    int has_one_noise; /* every plot has isotropic noise, and no height or range rate */
    /*
     * noise is isotropic and sets are straight; ask rho_initiator_takes_isotropic_path, which
     * knows the build
     */
    int is_isotropic;
    float log_pd[RHO_MAX_SCANS], log_miss[RHO_MAX_SCANS]; /* by scan: ln pd, ln(1 - pd) */
    /* by scan: ln of the clutter density of its sensor over the mean of all sensors */
    float log_ratio[RHO_MAX_SCANS];
    float log_prior; /* ln of the density of births over area and velocity */
    /* covariance of the displacements by process noise between scans */
    float process_m2[RHO_MAX_SCANS * (RHO_MAX_SCANS + 1) / 2];
    /* largest variance by which process noise moves a plot off a fitted line */
    float fit_process_m2;
    /* standard deviation of a set's acceleration in the plane; 0: sets are straight */
    float turn_mps2;
    float log_turn;      /* ln of the prior of a turn; 0 for straight sets */
    float log_turning;   /* value that log_turn takes while sets may turn */
    uint16_t skip_flags; /* plots with any of these marks are skipped */
    float score_min_nat; /* lowest score of a candidate */
    int keeps_rate; /* thresholds keep false_tracks_per_hour, and chi-square of fits is limited */
    uint32_t work_max;    /* limit of the search's work, units; 0: none */
    uint32_t limit_units; /* limit of the work until the end of the current plot or phase */
    int is_partial;       /* plots or candidates were left out for lack of work */
    struct rho_initiator_resume next; /* the plot with which the next search begins */
    int is_left_out; /* the density map does not count the plots of the set that is scored */
};

/*
 * True where the search takes the fast path: isotropic noise in every scan, positions alone
 * measured, straight sets. Constant 0 in a build without Cartesian plots.
 */
static inline int rho_initiator_takes_isotropic_path(const struct search *search)
{
    return (RHO_SCAN_KINDS & 1) != 0 && search->is_isotropic;
}

/* A track: place, velocity and acceleration at the time of the newest scan. */
struct line_fit {
    float x_m, y_m, vx_mps, vy_mps;
    float ax_mps2, ay_mps2; /* acceleration; 0: the track is straight */
    int has_z;              /* z_m and vz_mps are known; never with isotropic noise */
    float z_m, vz_mps;
};

/* Score of a set of plots as a track. */
struct set_score {
    int32_t mnat;
    float chi2;          /* chi-square of the residual */
    unsigned dimensions; /* degrees of freedom of the residual */
};

/*
 * A set of plots, one a scan at most, that may be a track: bits and indices by age order of the
 * scans.
 */
struct plot_set {
    unsigned mask;
    unsigned hits;
    uint16_t plot[RHO_MAX_SCANS];
};

/* The plot of a set in scan m. */
static inline const struct rho_window_plot *
rho_initiator_plot_of_set(const struct search *search, const struct plot_set *set, unsigned m)
{
    return &rho_window_scan_at(&search->initiator->window, m)->plots[set->plot[m]];
}

static inline float rho_initiator_plot_time_s(const struct search *search,
                                              const struct plot_set *set, unsigned scan_index)
{
    return search->time_s[scan_index] +
           rho_initiator_plot_of_set(search, set, scan_index)->offset_s;
}

/* ---- before the search ----------------------------------------------------------------------- */

/*
 * Measures the clutter density, or takes that of the revolution's first sector (clutter_density.c).
 */
void rho_initiator_measure_or_keep_density(struct search *search);
/* Measures the clutter density without plots of these marks, but with more_plots added. */
void rho_initiator_measure_density(struct search *search, uint16_t skip_flags, float more_plots);
/* Area over which clutter is spread: the window's extent, at least 1 m^2. */
float rho_initiator_area_m2(const struct rho_initiator *initiator);
/* Clutter density at a place, mean over the scans held, raised by the clutter memory. */
float rho_initiator_mean_clutter_density(const struct rho_initiator *initiator, float x_m,
                                         float y_m);
float rho_initiator_log_density_of_hit(const struct search *search, const struct plot_set *set,
                                       unsigned scan_index);

/*
 * Adds the window's oldest scan to the clutter memory before it leaves
 * (clutter_density_long_term.c).
 */
void rho_initiator_remember_oldest_scan(struct rho_initiator *initiator);
/*
 * Clutter density at a place: density_per_m2, or the remembered density where that is significantly
 * higher.
 */
float rho_initiator_density_with_memory(const struct rho_initiator *initiator, float x_m, float y_m,
                                        float density_per_m2);

/* Sets the covariance of displacements by process noise (straight_line_process_noise.c). */
void rho_initiator_set_process_noise(struct search *search);
float rho_initiator_largest_bend_variance_m2(const struct search *search, unsigned first,
                                             float *sum_m2);
/*
 * Variance by process noise of the place in scan m about the line between the places in scans a and
 * b.
 */
float rho_initiator_process_variance_off_line_m2(const struct search *search, unsigned a,
                                                 unsigned m, unsigned b);

/* Sets the detection probabilities and the density of births (prior.c). */
void rho_initiator_set_pd_and_birth_prior(struct search *search);
float rho_initiator_log_height_and_range_rate_volume(const struct search *search, int has_z,
                                                     unsigned heights, unsigned range_rates);

/* Quantile of chi-square at a normal deviate of `sigmas` (chi_square_and_log_factorial.c). */
float rho_initiator_chi2_limit(unsigned dimensions, float sigmas);
/* Natural logarithm of n factorial. */
float rho_initiator_log_factorial(unsigned n);

/* Sets M, and the scores that start and confirm a track (start_thresholds.c). */
void rho_initiator_set_min_scans_and_thresholds(struct search *search);
/* Finds the thresholds anew, for the clutter density measured last. */
void rho_initiator_update_thresholds(struct search *search);
float rho_initiator_log_turn_prior(const struct search *search);
/* Takes sets as those of turning targets from here on, or of straight ones. */
void rho_initiator_assume_turning_targets(struct search *search, int turns);

/* ---- work ------------------------------------------------------------------------------------ */

/* Units of work that the search has done so far (search_budget.c). */
uint32_t rho_initiator_work_spent(const struct search *search);
/* True where the work exceeds its current limit. */
int rho_initiator_is_work_limit_exceeded(const struct search *search);
/* Adds units to the work done. */
void rho_initiator_charge_work(const struct search *search, uint32_t units);
void rho_initiator_record_work_and_resume_place(struct search *search);

/* ---- kernels --------------------------------------------------------------------------------- */

/* A scan between the first and the last scan of a span, which votes for the kernels of the span. */
struct voter {
    /* variance of a track's place in the voting scan, by process noise and turns */
    float process_m2;
    float gate_radius_m; /* radius of the widest gate of its votes */
};

#define SPANS_MAX (RHO_MAX_SCANS - 2)

/* Factor by which rounding may increase the distance of a vote from its kernel. */
#define GATE_ROUNDING 1.001f

/* A span: the values common to all kernels from scan a to scan b. */
struct span {
    uint8_t a, b;
    uint8_t misses_max; /* scans between a and b that need not vote, by M */
    /*
     * scans between that need not vote where clutter is not thin; below 0: no kernel of the span
     * can start a track there
     */
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
    struct rho_window_plot_noise_covariance
        noise; /* covariance of the plot; not set with isotropic noise */
};

/*
 * Number of scans between that need not vote for kernels of the span with this last plot; below 0:
 * the span has no kernels.
 */
static inline int rho_initiator_misses_max(const struct span *span, const struct ending *ending)
{
    return !HAS_SPAN_HITS || ending->is_clear ? (int)span->misses_max : (int)span->misses_amid;
}

/*
 * The vote of a kernel nearest to its end: plot `index` of the scan `gap` scans before the end. gap
 * 0: not prescribed.
 */
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

/* Bounds the noise of a single radar by range, for narrower gates (vote_gates_by_range.c). */
void rho_initiator_bound_noise_per_metre_of_range(struct search *search);
void rho_initiator_set_gate_shares_of_ending_plot(const struct search *search, float far_m,
                                                  struct ending *ending);

/*
 * Aliases of an ambiguous range rate: its error is seen.error_mps + i span_mps, i from first to
 * last.
 */
struct aliases {
    struct rho_window_range_rate seen;
    float span_mps;
    int first, last;
};

/*
 * Lists the aliases of a plot's range rate that agree with the velocity of a place. Returns 0 where
 * the range rate is not ambiguous (range_rate_ambiguity.c).
 */
int rho_initiator_find_aliases_if_ambiguous(const struct rho_window_scan *scan,
                                            const struct rho_window_plot *plot,
                                            const struct rho_window_place *place,
                                            struct aliases *aliases);
/* Sets *known to the place with its velocity corrected by alias i of the range rate. */
void rho_initiator_update_kernel_velocity_by_alias(const struct aliases *aliases, int i,
                                                   const struct rho_window_place *place,
                                                   struct rho_window_place *known);

/*
 * Collects the votes for the kernel from plot i of the span's first scan to `ending`. Returns 0
 * where they are too few. An ambiguous range rate makes several kernels of one pair: *next_alias, 0
 * at first, tells with which alias to continue, and is 0 after the last (plot_pair_votes.c).
 */
int rho_initiator_collect_votes_of_plot_pair(struct search *search, const struct span *span,
                                             const struct ending *ending,
                                             const struct first_vote *first, unsigned i,
                                             int *next_alias, struct plot_set *set);

/* Lists the spans of kernels that end in scan b (plot_pair_enumeration.c). */
void rho_initiator_list_spans_ending_at(struct search *search, unsigned b, struct span_list *list);
/*
 * Number of plots, in the scan before the last, that a target in plot j may have come from: a
 * measure of the cost of the kernels that end there.
 */
unsigned rho_initiator_count_previous_plots_near(struct search *search,
                                                 const struct span_list *list, unsigned j);
/* Tries all kernels that end in plot j. Returns 0 where the work is spent. */
int rho_initiator_finish_kernels_ending_at_plot(struct search *search, const struct span_list *list,
                                                unsigned j);

/* Tries all kernels of straight targets within the limit of work (plot_pair_search_order.c). */
void rho_initiator_try_straight_kernels(struct search *search);
/* Tries kernels of turning targets that end in the newest scan, with the work that is left. */
void rho_initiator_try_turning_kernels_with_work_left(struct search *search);

/* ---- candidates ------------------------------------------------------------------------------ */

/*
 * Converts nats to integer thousandths, limited to a million nats
 * (track_fit_associate_and_score.c).
 */
int32_t rho_initiator_nat_to_mnat(float nat);
int rho_initiator_fit_track_if_determined(const struct search *search, const struct plot_set *set,
                                          struct line_fit *fit);
void rho_initiator_associate_plots(struct search *search, const struct line_fit *fit,
                                   float variance_factor, struct plot_set *set);
int rho_initiator_refine_set(struct search *search, struct plot_set *set, struct line_fit *fit);
int rho_initiator_score_set_if_determined(const struct search *search, const struct plot_set *set,
                                          const struct line_fit *fit, struct set_score *score);

/*
 * Arithmetic of track_fit_associate_and_score.c for isotropic noise (isotropic_fit.c) and for all
 * other plots (anisotropic_fit.c).
 */
int rho_initiator_fit_isotropic(const struct search *search, const struct plot_set *set,
                                struct line_fit *fit);
int rho_initiator_nearest_plot_isotropic(struct search *search, const struct line_fit *fit,
                                         float variance_factor, unsigned m);
int rho_initiator_log_likelihood_isotropic(const struct search *search, const struct plot_set *set,
                                           struct set_score *score, float *nat);
int rho_initiator_fit_anisotropic(const struct search *search, const struct plot_set *set,
                                  struct line_fit *fit);
int rho_initiator_nearest_plot_anisotropic(struct search *search, const struct line_fit *fit,
                                           float variance_factor, unsigned m);
int rho_initiator_log_likelihood_anisotropic(const struct search *search,
                                             const struct plot_set *set, struct set_score *score,
                                             float *nat);

/*
 * Numbers of candidates that make a unit of work: when a list is passed, and when plots are
 * compared.
 */
#define PASSED_IN_UNIT 8u
#define COMPARED_IN_UNIT 2u

int rho_initiator_make_candidate_not_yet_listed(struct search *search, struct plot_set *set,
                                                struct rho_candidate *candidate);
/* Makes a candidate of a set and lists it; a full list drops the lowest score (candidates.c). */
void rho_initiator_add_set_as_candidate(struct search *search, struct plot_set *set);
/* True where a score reaches the start threshold and, if a rate is kept, chi-square is small. */
int rho_initiator_passes_thresholds(const struct search *search, const struct set_score *score);
int rho_initiator_unpack_and_assume_its_turning(struct search *search,
                                                const struct rho_candidate *candidate,
                                                struct plot_set *set, struct line_fit *fit);

/* Keeps candidates by score so that no two share more than one plot (candidate_selection.c). */
void rho_initiator_select_candidates(struct search *search);
/* Scores candidates anew, likely targets' plots left out of the clutter, and drops low scores. */
void rho_initiator_rescore_and_drop_weak(struct search *search);

/* True where every field of a configuration is within its range (initiator.c). */
int rho_initiator_is_usable_config(const struct rho_initiator_config *config);

#endif
