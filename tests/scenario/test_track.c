/* SPDX-License-Identifier: MIT */
/*
 * Simulated scenarios through rho_tracker_step, scan by scan: is each target followed by one track,
 * without false tracks? gospa_compare pairs tracks with targets. Seeds are fixed; the comment at
 * each case gives the result over many other seeds.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "evaluation/gospa.h"
#include "rhotrack/tracker.h"
#include "scenario_simulation.h"
#include "scene/scene_observe.h"

#define CUTOFF_M 500.0
#define TARGETS_MAX 64

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;
static struct rho_plot plots[RHO_MAX_PLOTS];

/* Counts from scan `from` on, when every target has had time to be found. */
struct outcome {
    size_t targets, targets_found; /* targets_found: at the last scan */
    size_t points, points_tracked; /* targets times scans; those paired with a track */
    size_t false_rows, switches;
    unsigned confirmed; /* tracks confirmed in the whole run */
    double rmse_m;
};

struct following {
    struct outcome outcome;
    uint32_t track_of[TARGETS_MAX]; /* identity of the last paired track; 0: none yet */
    double squared_m2;
};

static void start_tracker(const struct parameters *parameters)
{
    struct rho_tracker_config tracker_config;
    struct rho_initiator_config initiator_config;

    parameters_to_tracker(parameters, &tracker_config);
    parameters_to_initiator(parameters, &initiator_config);
    assert_int_equal(RHO_OK, rho_tracker_init(&tracker, sizeof tracker, &tracker_config));
    assert_int_equal(RHO_OK, rho_initiator_init(&initiator, sizeof initiator, &initiator_config));
}

static void step_scan(const struct simulated_scan *simulated, double sigma_m)
{
    struct rho_scan scan = {.time_us = llround(simulated->t_s * 1e6),
                            .num_plots = (uint32_t)simulated->num_plots,
                            .plots = plots};

    assert_true(simulated->num_plots <= RHO_MAX_PLOTS);
    for (size_t i = 0; i < simulated->num_plots; i++) {
        plots[i] = (struct rho_plot){.x_m = (float)simulated->plots[i].x_m,
                                     .y_m = (float)simulated->plots[i].y_m,
                                     .sigma_range_m = (float)sigma_m,
                                     .sigma_cross_m = (float)sigma_m};
    }
    assert_int_equal(RHO_OK, rho_tracker_step(&tracker, &initiator, &scan, &report));
}

/* Places of the confirmed and coasting tracks of the report. */
static size_t confirmed_places_of_report(struct gospa_place places[RHO_MAX_TRACKS],
                                         uint32_t ids[RHO_MAX_TRACKS])
{
    size_t count = 0;

    for (size_t i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];
        if (track->status != RHO_TRACK_TENTATIVE) {
            ids[count] = track->track_id;
            places[count++] = (struct gospa_place){.x_m = (double)track->state[0],
                                                   .y_m = (double)track->state[1]};
        }
    }
    return count;
}

static void count_pair(struct following *following, size_t target, uint32_t track_id)
{
    uint32_t *last = &following->track_of[target];

    following->outcome.points_tracked++;
    following->outcome.targets_found++;
    following->outcome.switches += *last != 0 && *last != track_id;
    *last = track_id;
}

static void pair_tracks_with_targets(struct following *following, const struct truth_point *truth,
                                     size_t num_targets)
{
    static struct gospa_place places[RHO_MAX_TRACKS];
    static uint32_t ids[RHO_MAX_TRACKS];
    struct gospa_place targets[TARGETS_MAX] = {{0}};
    int track_of[TARGETS_MAX];
    size_t num_tracks = confirmed_places_of_report(places, ids);
    struct gospa gospa;

    for (size_t i = 0; i < num_targets; i++) {
        targets[i] = (struct gospa_place){.x_m = truth[i].x_m, .y_m = truth[i].y_m};
    }
    gospa = gospa_compare(targets, num_targets, places, num_tracks, CUTOFF_M, track_of);
    following->outcome.targets_found = 0;
    following->outcome.points += num_targets;
    following->outcome.false_rows += gospa.false_tracks;
    following->squared_m2 += gospa.localisation_m2;
    for (size_t i = 0; i < num_targets; i++) {
        if (track_of[i] >= 0) {
            count_pair(following, i, ids[track_of[i]]);
        }
    }
}

static struct outcome follow_scenario(const char *name, const struct parameters *parameters,
                                      uint64_t seed, size_t from)
{
    struct simulation *simulation = scenario_simulate(name, parameters, seed, 0);
    struct following following = {.outcome.targets = simulation->num_targets};
    struct outcome *outcome = &following.outcome;

    assert_true(simulation->num_targets <= TARGETS_MAX);
    start_tracker(parameters);
    for (size_t scan = 0; scan < simulation->num_scans; scan++) {
        step_scan(&simulation->scans[scan], simulation->sigma_m);
        if (scan >= from) {
            pair_tracks_with_targets(&following, simulation->truth + scan * simulation->num_targets,
                                     simulation->num_targets);
        }
    }
    outcome->confirmed = tracker.counters.tracks_confirmed;
    outcome->rmse_m = sqrt(following.squared_m2 / (double)(outcome->points_tracked + 1));
    simulation_free(simulation);
    return *outcome;
}

/* Sum over seeds 1 .. num_seeds. */
static struct outcome sum_over_seeds(const char *name, const struct parameters *parameters,
                                     uint64_t num_seeds, size_t from)
{
    struct outcome sum = {0};

    for (uint64_t seed = 1; seed <= num_seeds; seed++) {
        struct outcome one = follow_scenario(name, parameters, seed, from);
        sum.targets += one.targets;
        sum.targets_found += one.targets_found;
        sum.points += one.points;
        sum.points_tracked += one.points_tracked;
        sum.false_rows += one.false_rows;
        sum.switches += one.switches;
        sum.confirmed += one.confirmed;
        sum.rmse_m += one.rmse_m / (double)num_seeds;
    }
    print_message("%s: %zu of %zu found, %.4f complete, %zu false rows, %zu switches, %u tracks "
                  "confirmed, %.1f m\n",
                  name, sum.targets_found, sum.targets,
                  (double)sum.points_tracked / (double)(sum.points ? sum.points : 1),
                  sum.false_rows, sum.switches, sum.confirmed, sum.rmse_m);
    return sum;
}

/* The outcome for a scene with one radar that measures x and y. */
static struct outcome follow_scene(const char *name, const char *duration,
                                   const struct parameters *parameters, uint64_t seed, size_t from)
{
    struct scene *scene = scene_load_by_name(name, &duration, 1);
    struct scene_run *run = scene_observe(scene, seed, 0);
    struct following following = {.outcome.targets = run->num_paths};

    assert_true(run->num_paths <= 1);
    start_tracker(parameters);
    for (size_t i = 0; i < run->num_scans; i++) {
        const struct scene_scan *seen = &run->scans[i];
        struct simulated_plot list[RHO_MAX_PLOTS];
        struct simulated_scan scan = {seen->end_s, seen->num_plots, list};
        struct truth_point truth = {.target_id = 0};

        if (run->num_paths > 0) {
            struct motion at = path_motion_at(&run->paths[0], seen->end_s);

            truth = (struct truth_point){.x_m = at.x_m, .y_m = at.y_m};
        }
        assert_true(seen->num_plots <= RHO_MAX_PLOTS);
        for (size_t k = 0; k < seen->num_plots; k++) {
            list[k] = (struct simulated_plot){.x_m = seen->plots[k].x_m, .y_m = seen->plots[k].y_m};
        }
        step_scan(&scan, scene->sensors[0].sigma_m);
        if (i >= from) {
            pair_tracks_with_targets(&following, &truth, run->num_paths);
        }
    }
    following.outcome.confirmed = tracker.counters.tracks_confirmed;
    scene_run_free(run);
    scene_free(scene);
    return following.outcome;
}

static struct parameters parameters_of(const char *scenario)
{
    struct parameters parameters;

    parameters_set_defaults(&parameters);
    scenario_suggest_parameters(scenario, &parameters);
    return parameters;
}

static void traffic_is_tracked_without_false_tracks_or_identity_switches(void **state)
{
    struct parameters parameters = parameters_of("traffic");
    struct outcome outcome;
    (void)state;

    parameters_suggest(&parameters, PARAMETER_NUM_SCANS, 40);
    parameters_suggest(&parameters, PARAMETER_CLUTTER_PER_SCAN, 250);
    outcome = sum_over_seeds("traffic", &parameters, 4, 10);
    assert_int_equal(outcome.targets, 200);
    assert_true(outcome.targets_found >= 198);
    assert_true((double)outcome.points_tracked >= 0.99 * (double)outcome.points);
    assert_true(outcome.false_rows <= 10);
    assert_true(outcome.switches <= 2);
    assert_true(outcome.confirmed <= 203);
    assert_true(outcome.rmse_m < 67.0); /* the plots' own RMS error is 71 m */
}

static void crossing_targets_keep_their_track_identities(void **state)
{
    struct parameters parameters = parameters_of("crossing");
    struct outcome outcome;
    (void)state;

    parameters_suggest(&parameters, PARAMETER_NUM_SCANS, 20);
    outcome = sum_over_seeds("crossing", &parameters, 40, 8);
    assert_true(outcome.targets_found >= 117);
    assert_true((double)outcome.points_tracked >= 0.98 * (double)outcome.points);
    assert_true(outcome.switches <= 4);
    assert_true(outcome.rmse_m < 14.0); /* the plots' own RMS error is 14.1 m */
}

static void targets_crossing_at_a_small_angle_keep_their_identities(void **state)
{
    struct parameters parameters = parameters_of("crossing-angle");
    struct outcome outcome;
    (void)state;

    parameters_suggest(&parameters, PARAMETER_NUM_SCANS, 20);
    outcome = sum_over_seeds("crossing-angle", &parameters, 40, 8);
    assert_true(outcome.targets_found >= 77);
    assert_true(outcome.switches <= 8);
}

static void a_slowly_turning_target_is_followed(void **state)
{
    struct parameters parameters;
    struct outcome outcome = {0};
    (void)state;

    parameters_set_defaults(&parameters);
    parameters_suggest(&parameters, PARAMETER_V_MIN_MPS, 100);
    parameters_suggest(&parameters, PARAMETER_V_MAX_MPS, 400);
    parameters_suggest(&parameters, PARAMETER_ACCEL_MAX_MPS2, 10);
    for (uint64_t seed = 1; seed <= 40; seed++) {
        struct outcome one = follow_scene("slow-turn", "duration_s=40", &parameters, seed, 10);

        outcome.targets_found += one.targets_found;
        outcome.switches += one.switches;
    }
    print_message("slow-turn: %zu of 40 found, %zu switches\n", outcome.targets_found,
                  outcome.switches);
    assert_true(outcome.targets_found >= 33);
    assert_true(outcome.switches <= 2);
}

static void clutter_alone_confirms_hardly_any_track(void **state)
{
    /* targets of the same speed in the same area as the scenario crossing */
    struct parameters parameters = parameters_of("crossing");
    unsigned confirmed = 0;
    (void)state;

    for (uint64_t seed = 1; seed <= 10; seed++) {
        struct outcome one = follow_scene("clutter", "duration_s=80", &parameters, seed, 0);

        assert_int_equal(one.targets, 0);
        confirmed += one.confirmed;
    }
    assert_true(confirmed <= 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(traffic_is_tracked_without_false_tracks_or_identity_switches),
        cmocka_unit_test(crossing_targets_keep_their_track_identities),
        cmocka_unit_test(targets_crossing_at_a_small_angle_keep_their_identities),
        cmocka_unit_test(a_slowly_turning_target_is_followed),
        cmocka_unit_test(clutter_alone_confirms_hardly_any_track),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
