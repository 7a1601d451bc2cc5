/* SPDX-License-Identifier: MIT */
/* plots: plots of a look near a place, their work and scores. Private from src/tracker on. */
#ifndef RHOTRACK_PLOTS_H
#define RHOTRACK_PLOTS_H

#include "sight.h"

/*
 * plot_index.c: iterates over rows of plots, a superset of the held plots in a rectangle:
 *     struct plots_near near = rho_plots_near(tracker, x_min_m, x_max_m, y_min_m, y_max_m);
 *     for (uint32_t row; rho_plots_next(look, &near, &row);)
 */
struct plots_near {
    uint32_t next, end;       /* places in the strip or box that is read */
    unsigned box;             /* the box that is read next */
    struct rho_extent within; /* the rectangle, sides included */
};

/* Sorts the scan's held plots into strips, or bounds their boxes. */
void rho_plots_index(struct rho_tracker *tracker, struct rho_look *look);
struct plots_near rho_plots_near(const struct rho_tracker *tracker, float x_min_m, float x_max_m,
                                 float y_min_m, float y_max_m);
int rho_plots_next_box(const struct rho_look *look, struct plots_near *near);

static inline int rho_plots_next(const struct rho_look *look, struct plots_near *near,
                                 uint32_t *row)
{
    if (near->next >= near->end && (RHO_PLOT_STRIPS > 1 || !rho_plots_next_box(look, near))) {
        return 0;
    }
    *row = RHO_PLOT_STRIPS > 1 ? look->tracker->strips.plots[near->next] : near->next;
    near->next++;
    return 1;
}

/* True where a plot is in the iterator's rectangle, sides included. */
static inline int rho_plots_is_within(const struct plots_near *near, const struct rho_plot *plot)
{
    return rho_extent_holds(&near->within, plot->x_m, plot->y_m);
}

/* Upper bound of the number of plots that the iterator has still to give. */
static inline uint32_t rho_plots_max_near(const struct rho_look *look,
                                          const struct plots_near *near)
{
    return RHO_PLOT_STRIPS > 1 ? near->end - near->next : look->num_gated;
}

/*
 * work_budget.c: chooses the plots near a track that are scored within work_max. A phase begins;
 * then for each waiting track, where there may be more plots near it than its share allows, they
 * are counted by octaves of squared distance, and the nearest are chosen
 */
#define RHO_WORK_OCTAVES 40u
/*
 * A phase may do work_max / N units of work, with N for claims and for updates each; for groups;
 * for echoes of clutter; for second plots; for second plots of new tracks; for images.
 */
#define RHO_WORK_TRACKS_SHARE 4u
#define RHO_WORK_GROUPS_SHARE RHO_WORK_TRACKS_SHARE
#define RHO_WORK_ECHOES_SHARE (RHO_WORK_TRACKS_SHARE * 2u)
#define RHO_WORK_SECOND_SHARE (RHO_WORK_ECHOES_SHARE * 2u)
#define RHO_WORK_STARTS_SHARE RHO_WORK_SECOND_SHARE
#define RHO_WORK_IMAGES_SHARE RHO_WORK_SECOND_SHARE
/* Plots that an iteration passes over for one unit of work. */
#define RHO_WORK_PASSED_A_UNIT 4u
/* The plots near a track that are to be scored: the nearest ones that its share allows. */
struct plot_choice {
    uint32_t most, units;                 /* plots that may be scored; units of work for each */
    uint32_t num_near;                    /* plots counted near the track */
    int is_partial;                       /* not all plots near the track are chosen */
    unsigned last;                        /* farthest octave of distance with chosen plots */
    uint32_t of_last;                     /* plots of that octave that may still be chosen */
    uint16_t in_octave[RHO_WORK_OCTAVES]; /* plots counted in each octave */
};
/* Begins a phase in which tracks score plots, with a reserved share for each track in view. */
void rho_work_begin_shares(const struct rho_look *look, struct rho_work *work);
/* Begins a phase that may do work_max / divisor units of work. */
void rho_work_begin_phase(const struct rho_tracker *tracker, struct rho_work *work,
                          uint32_t divisor);
static inline void rho_work_spend(struct rho_work *work, uint32_t units)
{
    work->spent = rho_count(work->spent, units);
}

/* Releases the reserved share of one waiting track. */
static inline void rho_work_release_share(struct rho_work *work)
{
    work->share.waiting -= work->share.waiting > 0 ? 1u : 0u;
}

static inline int rho_work_is_spent(struct rho_work *work)
{
    return work->spent > work->share.end;
}

struct plot_choice rho_work_begin_choice(const struct rho_look *look, struct rho_work *work,
                                         const struct rho_track *track);
void rho_work_count_plot(struct plot_choice *choice, const struct rho_track *track,
                         const struct rho_plot *plot);
void rho_work_limit_choice(struct rho_work *work, struct plot_choice *choice);
/* True where a plot is chosen; its units of work are spent. */
int rho_work_take_plot(struct rho_work *work, struct plot_choice *choice,
                       const struct rho_track *track, const struct rho_plot *plot);
/* Units of work that are left for the initiator's search; 0: no limit. */
uint32_t rho_work_left_for_search(const struct rho_look *look, struct rho_work *work);
/* Adds the work of a step to the tracker's, and tells the report whether it was partial. */
void rho_work_record(struct rho_tracker *tracker, const struct rho_work *work,
                     struct rho_report *report);

/* track.c: converts nats to integer thousandths, within the range of the assignment's costs. */
int32_t rho_score_to_mnat(float nat);
/* plot_scores.c: scores of pairs of a track and a plot or bearing, for the assignment */
/* Makes the gate of a track about its merged estimate. measures: of the scan; 0 for bearings. */
void rho_score_open_gate(const struct rho_look *look, const struct rho_track *track,
                         uint32_t measures, struct rho_gate *gate);
/*
 * Adds a track (row) and an input (column) as a pair to the assignment. gain_nat: score over that
 * of a miss; a pair always costs less than a miss.
 */
void rho_score_add_pair(struct rho_tracker *tracker, unsigned row, uint32_t column, float gain_nat);
/* Score of a pair over clutter. Returns 0 where the pair was not added; *gain_nat stays. */
int rho_score_pair_gain(const struct rho_look *look, unsigned row, int column, float *gain_nat);
/* Removes an ended track's row from the assignment, and moves later rows up by one. */
void rho_score_remove_row(struct rho_tracker *tracker, unsigned row);

/* Solves the assignment, and counts plots that were dropped for lack of room in gates. */
void rho_score_solve(struct rho_tracker *tracker);

/* Log-likelihood ratio of a plot in a Kalman gate; log_density: rho_clutter_log_at_track. */
float rho_score_plot(const struct rho_look *look, const struct rho_track *track,
                     const struct rho_gate_result *result, float log_density, uint32_t row);
/* ln of the probability of a miss; 0 where the scan counts no miss of the track. */
float rho_score_log_miss(const struct rho_look *look, const struct rho_track *track);
/*
 * Iterates over the plots near a track with hypotheses that are not assigned to another track, each
 * scored by every hypothesis; gain_nat is the score over clutter:
 *     rho_score_begin(tracker, look, work, row, &scores);
 *     while (rho_score_next(tracker, look, work, &scores, &plot, &gain_nat))
 */
struct plot_scores {
    unsigned track_row;
    float log_pd;
    struct rho_hypotheses_clutter clutter;
    struct rho_hypotheses_box box;
    struct plots_near near;
    struct plot_choice choice;
};
void rho_score_begin(struct rho_tracker *tracker, const struct rho_look *look,
                     struct rho_work *work, unsigned row, struct plot_scores *scores);
int rho_score_next(struct rho_tracker *tracker, const struct rho_look *look, struct rho_work *work,
                   struct plot_scores *scores, uint32_t *plot, float *gain_nat);
/* A plot of the scan with its time, sensor and row, as rho_track_update_by_plot takes it. */
struct rho_track_plot rho_score_track_plot(const struct rho_look *look, int row);

#endif
