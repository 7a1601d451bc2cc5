/* SPDX-License-Identifier: MIT */
/*
 * experiment_rotating: the same flights as the library sees them by sectors, by whole turns, and as
 * if the antenna looked everywhere at once.
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_ROTATING_H
#define RHOTRACK_TOOL_EXPERIMENT_ROTATING_H

#include "base/grid.h"
#include "pipeline/pipeline.h"
#include "scene/scene_observe.h"
#include "verdicts.h"

enum rotating_case {
    ROTATING_SECTORS = 0, /* each plot at its own time, a step a sector */
    ROTATING_TURNS,       /* each plot at its own time, a step a turn, at its end */
    ROTATING_AT_ONCE,     /* all seen at the turn's end */
    ROTATING_CASES
};
extern const char *const rotating_names[ROTATING_CASES];

/* One case of one run. */
struct rotating_result {
    int targets;
    int found;        /* with a confirmed track after seven turns */
    int tracked;      /* at the end */
    int false_tracks; /* confirmed, never a target's */
    /* errors of confirmed tracks at the reports that have their plots: squares */
    double sum_m2, sum_m2ps2;
    size_t count;
    double step_max_us;    /* the longest step */
    double latency_max_us; /* from a plot's time to the end of the step that took it */
};

/* The scene, which the caller frees, and what a tracker is told of it. */
struct scene *rotating_scene(void);

/*
 * step_us: the time of each step so far, of which the least counts; room for the run's scans,
 * INFINITY at first.
 */
struct rotating_result rotating_follow(enum rotating_case of, const struct parameters *parameters,
                                       const struct scene_run *run, struct pipeline *chain,
                                       double *step_us);

/* One case over all runs. */
struct rotating_figures {
    double found, tracked, false_a_run, rmse_m, rmse_mps;
    double step_max_us, latency_max_ms; /* of the runs that were timed */
    /*
     * the first of these, sector by sector: the step in which it was the first one; INFINITY: it
     * was not
     */
    double *step_us;
    size_t num_sectors;
    double sector_s;
};

/* ROTATING_CASES, to be freed by rotating_figures_free. */
struct rotating_figures *rotating_measure(uint64_t seed, size_t num_runs);
void rotating_figures_free(struct rotating_figures *figures);

struct grid rotating_grid(const struct rotating_figures *figures);
struct verdicts rotating_verdicts(const struct rotating_figures *figures);

#endif
