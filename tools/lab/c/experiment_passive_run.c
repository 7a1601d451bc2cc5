/* SPDX-License-Identifier: MIT */
/* experiment_passive_run: one run of a case: pruning, the paper's method, the default. */
#include <math.h>
#include <time.h>

#include "base/common.h"
#include "experiment_passive.h"
#include "pipeline/pipeline.h"

#define DEG_RAD (3.141592653589793 / 180.0)

/* ---- pruning --------------------------------------------------------------------------------- */

static void count_removed(struct passive_pruning_run *run, const struct passive_scene *scene,
                          size_t scan, enum rho_ghost_rule rule)
{
    struct rho_ghost_matrix matrix = passive_matrix(scene, scan, 0, 1, rule);
    for (size_t i = 0; i < matrix.rows; i++) {
        for (size_t j = 0; j < matrix.columns; j++) {
            bool is_target = passive_is_target(scene, scan, 0, i, 1, j);
            bool is_gone = matrix.reason[i][j] != RHO_GHOST_KEPT;
            run->targets += rule == RHO_GHOST_NO_RULE && is_target;
            run->ghosts += rule == RHO_GHOST_NO_RULE && !is_target;
            run->targets_lost[rule] += is_target && is_gone;
            run->ghosts_removed[rule] += !is_target && is_gone;
        }
    }
}

struct passive_pruning_run passive_pruning_run(const struct passive_pruning_case *of,
                                               struct random *random)
{
    struct passive_pruning_run run = {0};
    struct passive_scene scene = passive_scene_draw(&of->setting, random);
    for (size_t scan = 0; scan < PASSIVE_SCANS; scan++) {
        for (int rule = 0; rule < PASSIVE_RULES; rule++) {
            count_removed(&run, &scene, scan, (enum rho_ghost_rule)rule);
        }
    }
    passive_scene_free(&scene);
    return run;
}

/* ---- the paper's method ---------------------------------------------------------------------- */

#define NEAR_THETA_RAD (6.0 * DEG_RAD)
#define NEAR_RHO_M 3000.0

void passive_paper_search(struct rho_passive_paper *paper, const struct passive_scene *scene,
                          unsigned sensors, unsigned votes_min, enum rho_ghost_rule rule)
{
    struct rho_passive_paper_config config;
    rho_passive_paper_config_default(&config);
    config.scans = PASSIVE_SCANS;
    config.votes_min = (uint16_t)votes_min;
    config.range_max_m = (float)PASSIVE_RANGE_MAX_M;
    config.rule = rule;
    must_succeed(rho_passive_paper_init(paper, sizeof *paper, &config), "passive_paper");
    for (size_t scan = 0; scan < PASSIVE_SCANS; scan++) {
        struct passive_frame frame;
        passive_frame_fill(&frame, scene, scan, sensors);
        must_succeed(rho_passive_paper_push(paper, &frame.frame, frame.fates), "passive_paper");
    }
    must_succeed(rho_passive_paper_search(paper), "passive_paper");
}

static bool is_near(const struct rho_passive_paper_line *line, const struct passive_scene *scene,
                    size_t target)
{
    struct truth_point truth = passive_truth(scene, target, 0.0);
    struct passive_line found = {line->rho_m, line->theta_rad};
    struct passive_line of = passive_line_of(truth.x_m, truth.y_m, truth.vx_mps, truth.vy_mps);
    struct passive_line off = passive_line_off(&found, &of);
    return off.theta_rad < NEAR_THETA_RAD && off.rho_m < NEAR_RHO_M;
}

struct passive_matched passive_lines_match(const struct rho_passive_paper *paper,
                                           const struct passive_scene *scene)
{
    struct passive_matched matched = {0, 0};
    bool is_found[PASSIVE_TARGETS_MAX] = {false};
    for (unsigned i = 0; i < paper->num_lines; i++) {
        bool is_ghost = true;
        for (size_t target = 0; target < scene->of->targets; target++) {
            if (is_near(&paper->lines[i], scene, target)) {
                is_ghost = false;
                matched.found += !is_found[target];
                is_found[target] = true;
            }
        }
        matched.ghosts += is_ghost;
    }
    return matched;
}

struct passive_paper_run passive_paper_run(const struct passive_paper_case *of,
                                           struct rho_passive_paper *paper, struct random *random)
{
    struct passive_paper_run run = {.targets = of->setting.targets};
    struct passive_scene scene = passive_scene_draw(&of->setting, random);
    for (int rule = 0; rule < PASSIVE_RULES; rule++) {
        if (of->has_rule[rule]) {
            passive_paper_search(paper, &scene, PASSIVE_ALL_SENSORS, of->votes_min,
                                 (enum rho_ghost_rule)rule);
            run.by_rule[rule] = passive_lines_match(paper, &scene);
        }
    }
    passive_scene_free(&scene);
    return run;
}

/* ---- the default ----------------------------------------------------------------------------- */

#define FOUND_NEAR_M 1000.0
#define FOUND_NEAR_SIGMAS 4.0

/* Of this thread: what else runs does not count. */
static double processor_us(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e6 + (double)now.tv_nsec / 1e3;
}

static double search(struct rho_passive *passive, const struct passive_scene *scene)
{
    struct rho_passive_config config;
    rho_passive_config_default(&config);
    must_succeed(rho_passive_init(passive, sizeof *passive, &config), "passive");
    for (size_t scan = 0; scan < PASSIVE_SCANS; scan++) {
        struct passive_frame frame;
        passive_frame_fill(&frame, scene, scan, PASSIVE_ALL_SENSORS);
        must_succeed(rho_passive_push(passive, &frame.frame, frame.fates), "passive");
    }
    double start_us = processor_us();
    must_succeed(rho_passive_search(passive), "passive");
    return processor_us() - start_us;
}

/* With the target's own bearings, at mid-batch. */
static struct clairvoyant_course best_fit(const struct passive_scene *scene, size_t target)
{
    struct clairvoyant_bearing bearings[PASSIVE_SCANS * SCENARIO_SENSORS_MAX];
    struct truth_point truth = passive_truth(scene, target, passive_middle_s(scene));
    double start[4] = {truth.x_m, truth.y_m, truth.vx_mps, truth.vy_mps};
    size_t count = 0;
    for (size_t i = 0; i < PASSIVE_SCANS * scene->of->sensors; i++) {
        const struct simulated_look *look = &scene->simulation->looks[i];
        for (size_t j = 0; j < look->num_bearings; j++) {
            if (look->bearings[j].target_id == (int)target) {
                bearings[count++] = (struct clairvoyant_bearing){
                    .t_s = scene->times_s[i / scene->of->sensors] - truth.t_s,
                    .sensor_x_m = scene->plan.passive.sensors[look->sensor].x_m,
                    .sensor_y_m = scene->plan.passive.sensors[look->sensor].y_m,
                    .bearing_rad = look->bearings[j].bearing_rad,
                    .sigma_rad = scene->plan.passive.sigma_rad,
                };
            }
        }
    }
    return clairvoyant_bearings_fit(bearings, count, start);
}

/* A track's place at mid-batch, and its velocity. */
static void state_at_middle(const struct passive_scene *scene,
                            const struct rho_passive_track *track, double state[4])
{
    double back_s = scene->times_s[PASSIVE_SCANS - 1] - passive_middle_s(scene);
    state[0] = (double)track->x_m - back_s * (double)track->vx_mps;
    state[1] = (double)track->y_m - back_s * (double)track->vy_mps;
    state[2] = (double)track->vx_mps;
    state[3] = (double)track->vy_mps;
}

static double nees_of(const struct passive_scene *scene, const struct rho_passive_track *track,
                      size_t target)
{
    struct truth_point truth = passive_truth(scene, target, scene->times_s[PASSIVE_SCANS - 1]);
    double off[4] = {(double)track->x_m - truth.x_m, (double)track->y_m - truth.y_m,
                     (double)track->vx_mps - truth.vx_mps, (double)track->vy_mps - truth.vy_mps};
    double covariance[4][4];
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            int row = i > j ? i : j, column = i > j ? j : i;
            covariance[i][j] = (double)track->covariance[row * (row + 1) / 2 + column];
        }
    }
    return clairvoyant_nees(off, (const double(*)[4])covariance);
}

static bool has_own_alone(const struct passive_scene *scene, const struct rho_passive_track *track,
                          size_t target)
{
    for (size_t scan = 0; scan < PASSIVE_SCANS; scan++) {
        for (size_t sensor = 0; sensor < scene->of->sensors; sensor++) {
            unsigned claim = track->claim[scan][sensor];
            if (claim > 0 &&
                passive_look(scene, scan, sensor)->bearings[claim - 1].target_id != (int)target) {
                return false;
            }
        }
    }
    return true;
}

static struct passive_line line_off(const double state[4], const struct truth_point *truth)
{
    struct passive_line line = passive_line_of(state[0], state[1], state[2], state[3]);
    struct passive_line of = passive_line_of(truth->x_m, truth->y_m, truth->vx_mps, truth->vy_mps);
    return passive_line_off(&line, &of);
}

static struct passive_hit hit_of(const struct passive_scene *scene, size_t target,
                                 const struct rho_passive_track *track,
                                 const struct clairvoyant_course *fit)
{
    struct truth_point truth = passive_truth(scene, target, passive_middle_s(scene));
    double state[4];
    state_at_middle(scene, track, state);
    return (struct passive_hit){
        .off_m = hypot(state[0] - truth.x_m, state[1] - truth.y_m),
        .fit_off_m = hypot(fit->state[0] - truth.x_m, fit->state[1] - truth.y_m),
        .line_off = line_off(state, &truth),
        .fit_line_off = line_off(fit->state, &truth),
        .nees = nees_of(scene, track, target),
        .is_own = has_own_alone(scene, track, target),
    };
}

/* Mean distance over the batch. */
static double apart_m(const struct passive_scene *scene, size_t target, const double state[4])
{
    double sum_m = 0.0;
    for (size_t scan = 0; scan < PASSIVE_SCANS; scan++) {
        struct truth_point truth = passive_truth(scene, target, scene->times_s[scan]);
        double t_s = truth.t_s - passive_middle_s(scene);
        sum_m +=
            hypot(state[0] + t_s * state[2] - truth.x_m, state[1] + t_s * state[3] - truth.y_m);
    }
    return sum_m / PASSIVE_SCANS;
}

/*
 * Of the tracks that are no other target's, and within max(1 km, 4 standard deviations of the fit)
 * at mid-batch, the nearest over the whole batch: targets can meet at its middle. -1: none.
 */
static int find_track(const struct passive_scene *scene, size_t target,
                      const struct rho_passive *passive, const struct clairvoyant_course *fit,
                      const bool *is_taken)
{
    struct truth_point truth = passive_truth(scene, target, passive_middle_s(scene));
    double sigma_m = sqrt(fit->covariance[0][0] + fit->covariance[1][1]);
    double near_m = fmax(FOUND_NEAR_M, FOUND_NEAR_SIGMAS * sigma_m), least_m = INFINITY;
    int nearest = -1;
    for (int i = 0; i < (int)passive->num_tracks; i++) {
        double state[4];
        state_at_middle(scene, &passive->tracks[i], state);
        double off_m = hypot(state[0] - truth.x_m, state[1] - truth.y_m);
        double mean_m = apart_m(scene, target, state);
        if (!is_taken[i] && off_m < near_m && mean_m < least_m) {
            least_m = mean_m;
            nearest = i;
        }
    }
    return nearest;
}

static void match_tracks(struct passive_default_run *run, const struct rho_passive *passive,
                         const struct passive_scene *scene)
{
    bool is_taken[RHO_MAX_PASSIVE_TRACKS] = {false};
    for (size_t target = 0; target < scene->of->targets; target++) {
        struct clairvoyant_course fit = best_fit(scene, target);
        int at = find_track(scene, target, passive, &fit, is_taken);
        if (at >= 0) {
            is_taken[at] = true;
            run->hits[run->found++] = hit_of(scene, target, &passive->tracks[at], &fit);
        }
    }
    run->ghosts = passive->num_tracks - run->found;
}

struct passive_default_run passive_default_run(const struct passive_default_case *of,
                                               struct rho_passive *passive, struct random *random)
{
    struct passive_default_run run = {0};
    struct passive_scene scene = passive_scene_draw(&of->setting, random);
    run.search_us = search(passive, &scene);
    match_tracks(&run, passive, &scene);
    passive_scene_free(&scene);
    return run;
}
