/* SPDX-License-Identifier: MIT */
/*
 * A search of a scene compared with the truth: the best fit with the true association of bearings,
 * and figures over many scenes.
 */
#ifndef TRUE_ASSOCIATION_H
#define TRUE_ASSOCIATION_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "passive_scene.h"
#include "rhotrack/passive.h"

static struct rho_passive passive;
static struct scene scene;

/*
 * Maximum likelihood with the true association, in double precision: place at mid-batch and
 * velocity.
 */
struct fit {
    double state[4], covariance[4][4];
};

/* Time of the newest frame. */
static inline double last_time_s(void)
{
    double last_s = scene.time_s[scene.scans - 1];
    for (unsigned s = 0; s < scene.sensors && scene.has_single_scans; s++) {
        last_s = fmax(last_s, look_time_s(&scene, scene.scans - 1, s));
    }
    return last_s;
}

/* Half the time from the first frame to the newest. */
static inline double half_batch_s(void)
{
    return 0.5 * (last_time_s() - scene.time_s[0]);
}

static inline double mid_batch_time_s(void)
{
    return 0.5 * (scene.time_s[0] + last_time_s());
}

/* Gauss-Jordan without pivoting, as a is positive definite. */
static inline void invert_matrix(double a[4][4], double inverse[4][4])
{
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            inverse[i][j] = i == j;
        }
    }
    for (int i = 0; i < 4; i++) {
        double pivot = a[i][i];
        for (int j = 0; j < 4; j++) {
            a[i][j] /= pivot;
            inverse[i][j] /= pivot;
        }
        for (int row = 0; row < 4; row++) {
            double factor = row == i ? 0.0 : a[row][i];
            for (int j = 0; j < 4; j++) {
                a[row][j] -= factor * a[i][j];
                inverse[row][j] -= factor * inverse[i][j];
            }
        }
    }
}

struct normal_equations {
    double a[4][4], b[4];
};

static inline void add_bearing_to_normal_equations(struct normal_equations *equations,
                                                   const double state[4], unsigned k, unsigned s,
                                                   const struct rho_bearing *seen)
{
    double t_s = look_time_s(&scene, k, s) - mid_batch_time_s();
    double dx_m = state[0] + t_s * state[2] - look_x_m(&scene, k, s);
    double dy_m = state[1] + t_s * state[3] - look_y_m(&scene, k, s);
    double range2 = dx_m * dx_m + dy_m * dy_m, weight = 1.0 / pow(seen->sigma_rad, 2.0);
    double off_rad = remainder(seen->bearing_rad - atan2(dy_m, dx_m), 2.0 * PI);
    double row[4] = {-dy_m / range2, dx_m / range2, -t_s * dy_m / range2, t_s * dx_m / range2};
    for (int i = 0; i < 4; i++) {
        equations->b[i] += weight * row[i] * off_rad;
        for (int j = 0; j < 4; j++) {
            equations->a[i][j] += weight * row[i] * row[j];
        }
    }
}

static inline struct normal_equations normal_equations_of_target(int target, const double state[4])
{
    struct normal_equations equations = {.b = {0}};
    for (int i = 2; i < 4; i++) {
        equations.a[i][i] = 1.0 / (500.0 * 500.0);
        equations.b[i] = -state[i] / (500.0 * 500.0);
    }
    for (unsigned k = 0; k < scene.scans; k++) {
        for (unsigned s = 0; s < scene.sensors; s++) {
            const struct look *look = &scene.look[k][s];
            for (unsigned i = 0; i < look->count; i++) {
                if (look->target[i] == target && !look->is_absent) {
                    add_bearing_to_normal_equations(&equations, state, k, s, &look->bearings[i]);
                }
            }
        }
    }
    return equations;
}

static inline struct fit fit_with_true_association(unsigned target)
{
    const struct target *truth = &scene.target[target];
    struct fit fit = {.state = {target_x_m(truth, mid_batch_time_s()),
                                target_y_m(truth, mid_batch_time_s()), truth->vx_mps,
                                truth->vy_mps}};
    for (int step = 0; step < 12; step++) {
        struct normal_equations equations = normal_equations_of_target((int)target, fit.state);
        invert_matrix(equations.a, fit.covariance);
        for (int i = 0; i < 4; i++) {
            for (int j = 0; j < 4; j++) {
                fit.state[i] += fit.covariance[i][j] * equations.b[j];
            }
        }
    }
    return fit;
}

struct figures {
    unsigned runs, targets, found, ghosts;
    double error2, best_error2, nees;
};

static inline double nees_of(const struct rho_passive_track *track, const struct target *truth)
{
    double last_s = last_time_s();
    double off[4] = {track->x_m - target_x_m(truth, last_s), track->y_m - target_y_m(truth, last_s),
                     track->vx_mps - truth->vx_mps, track->vy_mps - truth->vy_mps};
    double a[4][4], inverse[4][4], sum = 0.0;
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            int row = i > j ? i : j, column = i > j ? j : i;
            a[i][j] = track->covariance[row * (row + 1) / 2 + column];
        }
    }
    invert_matrix(a, inverse);
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            sum += off[i] * inverse[i][j] * off[j];
        }
    }
    return sum;
}

/* Distance of a track from a target at mid-batch. */
static inline double mid_batch_error_m(const struct rho_passive_track *track,
                                       const struct target *truth)
{
    double half_s = half_batch_s();
    return hypot(track->x_m - half_s * track->vx_mps - target_x_m(truth, mid_batch_time_s()),
                 track->y_m - half_s * track->vy_mps - target_y_m(truth, mid_batch_time_s()));
}

/*
 * Returns the nearest track within max(1 km, 4 standard deviations) that no other target has taken;
 * num_tracks: none.
 */
static inline unsigned find_nearest_free_track(unsigned target, const struct fit *best,
                                               const uint8_t *is_taken)
{
    double least_m = fmax(1000.0, 4.0 * sqrt(best->covariance[0][0] + best->covariance[1][1]));
    unsigned nearest = passive.num_tracks;
    for (unsigned i = 0; i < passive.num_tracks; i++) {
        double off_m = mid_batch_error_m(&passive.tracks[i], &scene.target[target]);
        if (!is_taken[i] && off_m < least_m) {
            least_m = off_m;
            nearest = i;
        }
    }
    return nearest;
}

static inline void add_figures(struct figures *figures)
{
    uint8_t is_taken[RHO_MAX_PASSIVE_TRACKS] = {0};
    unsigned found = 0;
    for (unsigned i = 0; i < scene.targets; i++) {
        const struct target *truth = &scene.target[i];
        struct fit best = fit_with_true_association(i);
        unsigned at = find_nearest_free_track(i, &best, is_taken);
        if (at < passive.num_tracks) {
            is_taken[at] = 1;
            found++;
            figures->error2 += pow(mid_batch_error_m(&passive.tracks[at], truth), 2.0);
            figures->best_error2 +=
                pow(best.state[0] - target_x_m(truth, mid_batch_time_s()), 2.0) +
                pow(best.state[1] - target_y_m(truth, mid_batch_time_s()), 2.0);
            double nees = nees_of(&passive.tracks[at], truth);
            assert_true(nees > 0.0);
            figures->nees += nees;
        }
    }
    figures->runs++;
    figures->targets += scene.targets;
    figures->found += found;
    figures->ghosts += passive.num_tracks - found;
}

/* Draws `from` anew for each run and sums the figures. */
static inline struct figures figures_of_scenes(const struct scene *from, unsigned runs)
{
    struct figures figures = {0};
    for (unsigned run = 0; run < runs; run++) {
        scene = *from;
        draw_scene(&scene);
        assert_int_equal(search_scene(&passive, &scene), RHO_OK);
        assert_true(are_tracks_finite_with_right_claims(&passive));
        add_figures(&figures);
    }
    return figures;
}

static inline double found_share(const struct figures *figures)
{
    return figures->targets > 0 ? (double)figures->found / figures->targets : 0.0;
}

static inline double ghosts_a_run(const struct figures *figures)
{
    return (double)figures->ghosts / figures->runs;
}

static inline double error_ratio(const struct figures *figures)
{
    return sqrt(figures->error2 / figures->best_error2);
}

static inline void print_figures(const char *what, const struct figures *figures)
{
    print_message("%s: found %.4f, ghosts a run %.4f, rmse %.0f m (%.3f of the best), NEES %.2f\n",
                  what, found_share(figures), ghosts_a_run(figures),
                  sqrt(figures->error2 / figures->found), error_ratio(figures),
                  figures->nees / figures->found);
}

static inline void sum_figures(struct figures *sum, const struct figures *figures)
{
    sum->runs += figures->runs;
    sum->targets += figures->targets;
    sum->found += figures->found;
    sum->ghosts += figures->ghosts;
    sum->error2 += figures->error2;
    sum->best_error2 += figures->best_error2;
    sum->nees += figures->nees;
}

static inline void draw_seeded_scene(const struct scene *from, uint64_t seed)
{
    random_state = seed;
    scene = *from;
    draw_scene(&scene);
}

static inline void search_into(struct rho_passive *into)
{
    assert_int_equal(search_scene(into, &scene), RHO_OK);
    assert_true(are_tracks_finite_with_right_claims(into));
}

#endif
