/* SPDX-License-Identifier: MIT */
/*
 * search: the state that one search of the initiator carries from phase to phase, sets of plots,
 * and the search's work. Private to src/initiation.
 */
#ifndef RHOTRACK_SEARCH_H
#define RHOTRACK_SEARCH_H

#include "rhotrack/detail/measurement.h"
#include "rhotrack/initiator.h"

#define LOG_PI 1.14472989f
#define LOG_TWO_PI 1.83787707f
#define LOG_HALF (-0.69314718f)

/* Costs in units of work, of about 20 to 90 instructions: a plot compared, or a row of bins. */
enum {
    KERNEL_UNITS = 2,
    LOOKUP_UNITS = 3,
    FIT_UNITS = 400,
    SOLVE_UNITS = 50,    /* anisotropic regression: of each plot, beyond those of the fit */
    OWN_NOISE_UNITS = 4, /* kernel with covariances of its plots; with heights or range rates */
    MORE_UNITS = 16,
    ALIAS_UNITS = 8,      /* each alias of a range rate */
    RESCORED_UNITS = 100, /* second score of an accepted candidate */
    SORTED_IN_UNIT = 2,   /* moves of a candidate in a sort, in one unit */
    COMPARED_IN_UNIT = 2, /* candidates whose plots are compared, in one unit */
    PASSED_IN_UNIT = 8,   /* candidates of a list that are passed, in one unit */
    CHARGED_UNITS = 64,   /* boxes of plots are charged after as much work */
};

/* Most aliases of an ambiguous range rate, either way: more carry little information. */
enum { ALIASES_MAX = 8 };

/* True where long spans may need more votes than M: not in small builds, where it saves little. */
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
     * a single radar's noise, 0 where not known: a plot's sigma is at most sigma_near_m or, if
     * larger, sigma_per_m times its range; sigma_least_m: smallest of the scans' largest sigmas
     */
    float sigma_near_m, sigma_per_m, sigma_least_m;
    int has_one_noise; /* every plot has isotropic noise, and no height or range rate */
    /* isotropic noise, straight sets; ask rho_search_is_isotropic, which knows the build */
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
static inline int rho_search_is_isotropic(const struct search *search)
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

/* Plots, one a scan at most, that may be a track: bits and indices by age order of the scans. */
struct plot_set {
    unsigned mask;
    unsigned hits;
    uint16_t plot[RHO_MAX_SCANS];
};

/* The scan of age order m. */
static inline struct rho_window_scan *rho_search_scan(const struct search *search, unsigned m)
{
    return rho_window_scan_at(&search->initiator->window, m);
}

/* The plot of a set in scan m, and its time relative to the newest scan. */
static inline const struct rho_window_plot *rho_search_plot(const struct search *search,
                                                            const struct plot_set *set, unsigned m)
{
    return &rho_search_scan(search, m)->plots[set->plot[m]];
}

static inline float rho_search_plot_time_s(const struct search *search, const struct plot_set *set,
                                           unsigned m)
{
    return search->time_s[m] + rho_search_plot(search, set, m)->offset_s;
}

/* Units of work that the search has done so far (search_budget.c). */
uint32_t rho_search_work_spent(const struct search *search);
/* True where the work exceeds its current limit. */
int rho_search_is_over_limit(const struct search *search);
/* Adds units to the work done. */
void rho_search_charge(const struct search *search, uint32_t units);
/* Records the work of a search, whether it was partial, and where the next search begins. */
void rho_search_record_work(struct search *search);

/* Sets M, and the scores that start and confirm a track (start_thresholds.c). */
void rho_thresholds_set(struct search *search);
/* Finds the thresholds anew, for the clutter density measured last. */
void rho_thresholds_update(struct search *search);
/* ln of the prior of a turn, at these thresholds. */
float rho_thresholds_log_turn(const struct search *search);

/* True where every field of a configuration is within its range (initiator.c). */
int rho_initiator_is_usable_config(const struct rho_initiator_config *config);

#endif
