/* SPDX-License-Identifier: MIT */
/*
 * The initiator's inside: what one search carries around. Private to src/initiation/initiator*.c.
 */
#ifndef RHOTRACK_INITIATOR_SEARCH_H
#define RHOTRACK_INITIATOR_SEARCH_H

#include "rhotrack/initiator.h"
#include "rhotrack/measurement.h"

#define LOG_PI 1.14472989f
#define LOG_TWO_PI 1.83787707f
#define LOG_HALF (-0.69314718f)

/* Targets climb or sink by up to this share of v_max. */
#define CLIMB_SHARE 0.5f

/* Meanings of an ambiguous range rate, either way: beyond, it says next to nothing. */
#define ALIASES_MAX 8

struct search {
    struct rho_initiator *initiator;
    enum rho_search kind;
    /* scans that must have voted: the newest, or none in particular */
    unsigned wanted_mask;
    unsigned num_scans; /* N: scans held */
#if RHO_SECTORS
    float scans_seen; /* the same; of the newest the share of a turn that it has seen */
    /* a further sector of the newest scan: the map and the thresholds are those of its first, and the plots of that scan are
     * not in the map */
    int is_continued;
    const struct rho_window_sector *newest; /* kernels end there; NULL: anywhere */
#endif
    unsigned min_scans;          /* M */
    float time_s[RHO_MAX_SCANS]; /* of the scans, after the newest: <= 0 */
    float interval_s;            /* usual time between scans */
    int has_more;                /* a scan has heights or range rates */
    float reach_chi2;            /* of the widest gate */
    /* one radar's noise: no plot's is above both; of the scan whose plots have the least, the largest. 0: not known */
    float sigma_near_m, sigma_per_m, sigma_least_m;
    int has_one_noise; /* no scan has noise of two axes, heights or range rates */
    int is_isotropic;  /* the same, and sets are straight; private: rho_initiator_is_isotropic */
    float log_pd[RHO_MAX_SCANS], log_miss[RHO_MAX_SCANS]; /* by scan: ln pd, ln(1 - pd) */
    float log_ratio[RHO_MAX_SCANS]; /* by scan: ln of its sensor's clutter over the mean's */
    float log_prior;                /* ln of the births' density over area and velocity */
    /* displacement covariance by process noise */
    float process_m2[RHO_MAX_SCANS * (RHO_MAX_SCANS + 1) / 2];
    float fit_process_m2; /* its largest residual variance about a fitted line */
    float turn_mps2;      /* sets are scored as a target's that turns: of what sd; 0: straight */
    float log_turn;       /* ln of how likely that is beforehand; of straight ones 0 */
    float log_turning;    /* the same of turns, once they were tried */
    uint16_t skip_flags;  /* plots that look-ups pass over */
    float score_min_nat;  /* sets below are no candidates */
    int keeps_rate;       /* thresholds follow from false_tracks_per_hour, fits must be good */
    uint32_t work_max;    /* of this search; 0: no limit */
    uint32_t limit_units; /* that may be spent for now */
    int is_partial;       /* some of the work was left out */
    struct rho_initiator_turn next; /* where the next search begins */
    int is_left_out; /* the set that is scored: its plots are not in the map, so none are taken out of it */
};

/*
 * No scan has noise of two axes, heights or range rates, and sets are straight: the fast path,
 * where the build has one.
 */
static inline int rho_initiator_is_isotropic(const struct search *search)
{
    return (RHO_SCAN_KINDS & 1) != 0 && search->is_isotropic;
}

/* Thresholds that clutter reaches as rarely as wanted. */
struct rate {
    float start_nat, confirm_nat;
    unsigned min_scans;
};

/* A track: position and speed at the newest scan's time. */
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
    unsigned dimensions; /* ... that has so many */
};

/* The plots of a hypothesis, by age order. */
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

/* initiator_votes.c: before a search */
void rho_initiator_prepare(struct search *search);
float rho_initiator_log_room(const struct search *search, int has_z, unsigned heights,
                             unsigned range_rates);

/* initiator_density.c: what the scans tell of clutter */
float rho_initiator_area_m2(const struct rho_initiator *initiator);
float rho_initiator_mean_density(const struct rho_initiator *initiator, float x_m, float y_m);
void rho_initiator_begin_density(
    struct search *search); /* measured anew, or as the turn's first sector had it */
void rho_initiator_measure_density(struct search *search, uint16_t skip_flags, float more_plots);
float rho_initiator_log_density(const struct search *search, const struct plot_set *set,
                                unsigned m);

/* initiator_memory.c: the oldest scan is about to leave the window; what the memory makes of the window's density */
#if RHO_MAX_CLUTTER_CELLS > 0
void rho_initiator_remember(struct rho_initiator *initiator);
float rho_initiator_remembered(const struct rho_initiator *initiator, float x_m, float y_m,
                               float density_per_m2);
#else
static inline float rho_initiator_remembered(const struct rho_initiator *initiator, float x_m,
                                             float y_m, float density_per_m2)
{
    (void)initiator, (void)x_m, (void)y_m;
    return density_per_m2;
}
#endif

/* initiator_rate.c: thresholds for a wanted rate of chance tracks */
void rho_initiator_find_rate(struct search *search, struct rate *rate);
void rho_initiator_use_rate(struct search *search, const struct rate *rate);

/*
 * initiator_rate.c: ln of how likely a target turns, by the thresholds; and sets are a turning
 * target's from here on, or a straight one's
 */
float rho_initiator_log_turning(const struct search *search);
void rho_initiator_let_turn(struct search *search, int turns);

/* initiator_chance.c */
float rho_initiator_chi2_max(unsigned dimensions);
float rho_initiator_log_factorial(unsigned n);

/* initiator_fit.c: least squares and the score */
void rho_initiator_prepare_process(struct search *search);
float rho_initiator_bend_m2(const struct search *search, unsigned first, float *sum_m2);
float rho_initiator_process_gap_m2(const struct search *search, unsigned a, unsigned m, unsigned b);
int rho_initiator_fit(const struct search *search, const struct plot_set *set,
                      struct line_fit *fit);
int rho_initiator_settle(struct search *search, struct plot_set *set, struct line_fit *fit);
void rho_initiator_collect(struct search *search, const struct line_fit *fit, float factor,
                           struct plot_set *set);
int32_t rho_initiator_mnat(float nat);
int rho_initiator_score(const struct search *search, const struct plot_set *set,
                        const struct line_fit *fit, struct set_score *score);

/* A scan between two others: it votes for kernels from one to the other. */
struct voter {
    float process_m2; /* process noise of its place between them */
    float reach_m;    /* of the widest gate */
};

#define SPANS_MAX (RHO_MAX_SCANS - 2)

/*
 * What rounding may add to a vote's distance from its kernel: wherever a kernel is passed over
 * for it, by the same factor.
 */
#define REACH_ROUNDING 1.001f

/* What all kernels from scan a to scan b share. */
struct span {
    uint8_t a, b;
    uint8_t misses_max; /* scans between that need not vote */
    uint8_t is_ordered; /* no plot of a scan from a to b is earlier than one of the scan before */
    const struct rho_window_scan *scan_a, *scan_b;
    float gap_s;                /* between the scans' times */
    float slack_m;              /* what noise may add to the distance of a pair; 0: isotropic */
    const struct voter *voters; /* by scans before b, the one before it first */
};

/* The last plot of kernels. */
struct ending {
    const struct rho_window_plot *plot;
    /* of the widest gates: what the noise of plots a target's way from there allows, and what of it along its line of sight */
    float reach_share, along_share;
    float along_x, along_y; /* that line, or 0, 0 */
    float rounding_m;       /* what float32 may take off a place that a target has come from */
    struct rho_window_noise noise; /* not isotropic: its covariance */
};

/* A kernel's vote nearest to its end: plot `index`, so many scans before. gap 0: any, or none. */
struct first_vote {
    unsigned gap, index;
};

/* One pair of plots. */
struct kernel {
    const struct rho_window_plot *from, *to;
    float dx_m, dy_m;
    float duration_s;
    float reach_share;
    float from_m2, to_m2;                     /* isotropic: the ends' variances */
    struct rho_window_query query;            /* and what is asked of every scan alike */
    struct rho_window_noise noise_a, noise_b; /* else: their covariances */
    struct rho_window_place place;            /* the same */
};

#if RHO_AMBIGUOUS_RANGE_RATES
/* What an ambiguous range rate can mean, as far as a velocity allows: error + i span, i from first to last. */
struct aliases {
    struct rho_window_range_rate seen;
    float span_mps;
    int first, last;
};

/* initiator_alias.c: 0 where the plot's range rate is not ambiguous; the place as alias i makes it known */
int rho_initiator_open_aliases(const struct rho_window_scan *scan,
                               const struct rho_window_plot *plot,
                               const struct rho_window_place *place, struct aliases *aliases);
void rho_initiator_take_alias(const struct aliases *aliases, int i,
                              const struct rho_window_place *place, struct rho_window_place *known);

/* initiator_own.c: does the range rate of the kernel's last plot agree with it? */
int rho_initiator_own_end(const struct span *span, const struct kernel *kernel);
#endif

/* initiator.c: every field within its range */
int rho_initiator_is_usable(const struct rho_initiator_config *config);

/* initiator_reach.c: what is known of noise, and what it is within far_m of an ending's plot */
void rho_initiator_prepare_reach(struct search *search);
void rho_initiator_find_reach(const struct search *search, float far_m, struct ending *ending);

/* initiator_kernels.c: the votes for the kernel from plot i of the span's first scan; 0 where they are too few. A kernel may be
 * several: *next, 0 at first, tells where to go on, and is 0 after the last */
int rho_initiator_vote_for(struct search *search, const struct span *span,
                           const struct ending *ending, const struct first_vote *first, unsigned i,
                           int *next, struct plot_set *set);

/* All kernels that end in one scan. */
struct fan {
    unsigned num_spans;
    struct span spans[SPANS_MAX];                         /* the longest first */
    struct voter voters[SPANS_MAX * (SPANS_MAX + 1) / 2]; /* theirs, span by span */
};

/* initiator_thirds.c: all spans that end in scan b; offers what enough scans vote for of the kernels that end in plot j of it.
 * 0 where the limit on what is spent ended that */
void rho_initiator_open_fan(struct search *search, unsigned b, struct fan *fan);
unsigned rho_initiator_crowd(struct search *search, const struct fan *fan, unsigned j);
int rho_initiator_try_ending(struct search *search, const struct fan *fan, unsigned j);

/* initiator_budget.c: what the search has spent, and may; all kernels, as far as that goes; what that was */
uint32_t rho_initiator_spent(const struct search *search);
int rho_initiator_is_spent(const struct search *search);
void rho_initiator_charge(const struct search *search, uint32_t units);
void rho_initiator_try_kernels(struct search *search);
void rho_initiator_try_turning_kernels(struct search *search);
void rho_initiator_close_budget(struct search *search);

/* initiator_own.c: the same with each plot's own covariance, height and range rate */
int rho_initiator_own_kernel(const struct search *search, const struct span *span,
                             struct kernel *kernel);
int rho_initiator_own_vote(struct search *search, const struct span *span, unsigned m,
                           struct kernel *kernel);
int rho_initiator_own_fit(const struct search *search, const struct plot_set *set,
                          struct line_fit *fit);
int rho_initiator_own_nearest(struct search *search, const struct line_fit *fit, float factor,
                              unsigned m);
int rho_initiator_own_evidence(const struct search *search, const struct plot_set *set,
                               float *log_likelihood, float *chi2, unsigned *dimensions);

/* initiator_select.c: the list of candidates */
void rho_initiator_offer(struct search *search, struct plot_set *set);
void rho_initiator_select(struct search *search);
void rho_initiator_judge(struct search *search);

#endif
