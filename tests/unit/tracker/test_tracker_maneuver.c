/* SPDX-License-Identifier: MIT */
/*
 * What the tracker's gates achieve: a turn, targets side by side, a full pull with misses, a pool
 * that is too small. Figures beside the limits are measured in these runs.
 */
#include "gates_scene.h"

#define NUM_RUNS 40

/* ---- a turn ---------------------------------------------------------------------------------- */

#define TURN_FROM_S 20
#define TURN_TO_S 40
#define TURN_SCANS 60
#define TURN_MPS2 19.6 /* 2 g, in m/s^2 */

/* Means over the runs, for each scan. */
struct figures {
    double probability[TURN_SCANS], across_mps2[TURN_SCANS], error2_m2[TURN_SCANS];
    unsigned lost;
};

static void note_track(struct figures *figures, int k)
{
    const struct rho_track_report *track = confirmed_track_nearest_to_target(0, k, 200.0);
    if (track == NULL) {
        figures->lost++;
        return;
    }
    struct target at = target_on_its_turning_path_at(&scene.target[0], k);
    double across_mps2 = cos(at.course_rad) * (double)track->accel_mps2[1] -
                         sin(at.course_rad) * (double)track->accel_mps2[0];
    assert_float_equal(track->accel_mps2[2], 0.0f, 0.0f);
    figures->probability[k] += (double)track->maneuver_probability / NUM_RUNS;
    figures->across_mps2[k] += across_mps2 / NUM_RUNS;
    figures->error2_m2[k] += pow(distance_m(track, 0, k), 2.0) / NUM_RUNS;
}

/* A left turn at 250 m/s, seen once a second with 10 m noise and some misses. */
static struct figures mean_figures_of_turn(uint8_t gate, int has_inputs)
{
    struct figures figures = {0};
    for (unsigned run = 0; run < NUM_RUNS; run++) {
        set_up_scene(gate, 1000 + run);
        if (has_inputs) {
            estimate_inputs();
        }
        scene.num_targets = 1;
        scene.target[0] =
            (struct target){-6000.0, -3000.0, 0.0, 250.0, 0.3, TURN_MPS2, TURN_FROM_S, TURN_TO_S};
        scene.pd = 0.9;
        begin_tracker();
        for (int k = 0; k < TURN_SCANS; k++) {
            step_tracker(k);
            if (k >= 8) {
                note_track(&figures, k);
            }
        }
        assert_int_equal(tracker.counters.updates_refused, 0);
    }
    return figures;
}

static double mean_of(const double *values, int from, int to)
{
    double sum = 0.0;
    for (int k = from; k < to; k++) {
        sum += values[k] / (to - from);
    }
    return sum;
}

static void print_figures(const char *name, const struct figures *figures)
{
    print_message(
        "%s: straight p %.2f, %.1f m/s^2; four scans into the turn p %.2f, %.1f; turn p "
        "%.2f, %.1f; after p %.2f, %.1f; rms %.1f, %.1f, %.1f m\n",
        name, mean_of(figures->probability, 10, 21), mean_of(figures->across_mps2, 10, 21),
        figures->probability[24], figures->across_mps2[24], mean_of(figures->probability, 28, 41),
        mean_of(figures->across_mps2, 28, 41), mean_of(figures->probability, 48, 60),
        mean_of(figures->across_mps2, 48, 60), sqrt(mean_of(figures->error2_m2, 10, 21)),
        sqrt(mean_of(figures->error2_m2, 21, 41)), sqrt(mean_of(figures->error2_m2, 48, 60)));
}

/*
 * Accelerations are remembered for 8 s, and a manoeuvre may end at any time: of 19.6 m/s^2 the mean
 * shows 11. The probability has a floor, as a manoeuvring model without acceleration fits straight
 * flight as well.
 */
static void gate_best_reports_a_turn(void **state)
{
    (void)state;
    struct figures figures = mean_figures_of_turn(RHO_TRACKER_BEST, 0);
    print_figures("best", &figures);
    assert_int_equal(figures.lost, 0);
    assert_true(mean_of(figures.probability, 10, 21) < 0.25); /* measured 0.18 */
    assert_true(fabs(mean_of(figures.across_mps2, 10, 21)) < 0.5);
    assert_true(figures.probability[24] > 0.7);                            /* measured 0.85 */
    assert_true(figures.across_mps2[24] > 10.0);                           /* measured 14.4 */
    assert_true(mean_of(figures.probability, 28, 41) > 0.65);              /* measured 0.73 */
    assert_in_range(10.0 * mean_of(figures.across_mps2, 28, 41), 95, 196); /* measured 10.9 m/s^2 */
    assert_true(mean_of(figures.probability, 48, 60) < 0.25);              /* measured 0.18 */
    assert_true(fabs(mean_of(figures.across_mps2, 48, 60)) < 0.5);
    assert_true(mean_of(figures.error2_m2, 10, 21) < 13.0 * 13.0); /* measured 10.8 m */
    assert_true(mean_of(figures.error2_m2, 21, 41) < 18.5 * 18.5); /* measured 15.6 m */
}

/*
 * One test in 20 detects an input where there is none; a real input has the right size once it is
 * detected.
 */
static void input_estimation_reports_a_turn(void **state)
{
    (void)state;
    struct figures figures = mean_figures_of_turn(RHO_TRACKER_NEAREST, 1);
    print_figures("inputs", &figures);
    assert_true(figures.lost <= 3); /* measured: 1 scan more than 200 m off */
    assert_true(mean_of(figures.probability, 10, 21) < 0.1);
    assert_true(figures.probability[25] > 0.85); /* measured 0.95 */
    assert_true(mean_of(figures.probability, 28, 41) > 0.95);
    assert_in_range(10.0 * mean_of(figures.across_mps2, 28, 41), 170,
                    250); /* measured 21.5 m/s^2 */
    assert_true(mean_of(figures.probability, 48, 60) < 0.1);
    assert_true(mean_of(figures.error2_m2, 21, 41) < 30.0 * 30.0); /* measured 21.9 m */
}

static void plain_filters_report_no_acceleration(void **state)
{
    (void)state;
    for (int gate = RHO_TRACKER_HOUGH; gate <= RHO_TRACKER_NEAREST; gate++) {
        struct figures figures = mean_figures_of_turn((uint8_t)gate, 0);
        print_figures(gate == RHO_TRACKER_HOUGH ? "hough" : "nearest", &figures);
        assert_int_equal(figures.lost, 0);
        for (int k = 0; k < TURN_SCANS; k++) {
            assert_true(!(figures.probability[k] > 0.0) && !(fabs(figures.across_mps2[k]) > 0.0));
        }
    }
}

/* ---- targets side by side -------------------------------------------------------------------- */

static void set_up_pair_side_by_side(double apart_m)
{
    scene.num_targets = 2;
    scene.target[0] = (struct target){-6000.0, 3000.0, 0.0, 200.0, 0.2, 0.0, 0.0, 0.0};
    scene.target[1] = scene.target[0];
    scene.target[1].x_m -= apart_m * sin(0.2);
    scene.target[1].y_m += apart_m * cos(0.2);
    scene.pd = 0.9;
}

/* Counts runs after whose 60 scans both targets have the tracks of the beginning. */
static unsigned count_runs_with_identities_kept(uint8_t gate, float accel_max_mps2, double apart_m)
{
    unsigned kept = 0;
    for (unsigned run = 0; run < NUM_RUNS; run++) {
        uint32_t ids[2] = {0, 0};
        unsigned same = 0;
        set_up_scene(gate, 2000 + run);
        config.accel_max_mps2 = accel_max_mps2;
        set_up_pair_side_by_side(apart_m);
        begin_tracker();
        for (int k = 0; k < 68; k++) {
            step_tracker(k);
            for (unsigned i = 0; i < 2; i++) {
                const struct rho_track_report *track =
                    confirmed_track_nearest_to_target(i, k, k < 60 ? 25.0 : 50.0);
                ids[i] = k == 8 && track ? track->track_id : ids[i];
                same += k == 67 && track && track->track_id == ids[i];
            }
        }
        kept += ids[0] != ids[1] && same == 2;
    }
    return kept;
}

/*
 * Targets 50 m apart, sigma 10 m, P_D 0.9. The acceleration limit sets how far a track searches
 * after a miss: identities are swapped by misses of one target and then of the other.
 */
static void targets_side_by_side_keep_their_identities(void **state)
{
    (void)state;
    unsigned calm = count_runs_with_identities_kept(RHO_TRACKER_BEST, 5.0f, 50.0);
    unsigned agile = count_runs_with_identities_kept(RHO_TRACKER_BEST, 30.0f, 50.0);
    unsigned agile_nearest = count_runs_with_identities_kept(RHO_TRACKER_NEAREST, 30.0f, 50.0);
    print_message("side by side: accel_max 5 m/s^2: best %u; 30: best %u, nearest %u of %d\n", calm,
                  agile, agile_nearest, NUM_RUNS);
    assert_true(calm >= 39);                  /* measured 40 */
    assert_true(agile >= 37);                 /* measured 40 */
    assert_true(agile >= agile_nearest + 15); /* measured 16 */
}

/*
 * Eight targets abreast, 60 m apart, all seen, with wide gates: more of the others' plots are in a
 * gate than a hypothesis lists, which must not displace a target's own plot. When they did, 28 of 4
 * 640 plots were not claimed and started 9 more tracks. Of 46 400 plots 6 lie outside the narrow
 * gate of a calm track, 3 of them in these runs.
 */
static void targets_in_formation_claim_all_their_plots(void **state)
{
    (void)state;
    unsigned unclaimed = 0, started = 0, started_before = 0;
    for (unsigned run = 0; run < 20; run++) {
        set_up_scene(RHO_TRACKER_BEST, 7000 + run);
        config.accel_max_mps2 = 60.0f;
        scene.interval_s = 2.0;
        scene.num_targets = 8;
        for (unsigned i = 0; i < 8; i++) {
            scene.target[i] = (struct target){.x_m = -6000.0, .y_m = 60.0 * i, .speed_mps = 200.0};
        }
        begin_tracker();
        for (int k = 0; k < 39; k++) {
            step_tracker(k);
            started_before = k < 10 ? tracker.counters.tracks_started : started_before;
            unclaimed += k < 10 ? 0 : num_plots - report.fates_total[RHO_FATE_CLAIMED];
        }
        started += tracker.counters.tracks_started - started_before;
    }
    print_message("a formation: %u plots not claimed, %u tracks started later\n", unclaimed,
                  started);
    assert_true(unclaimed <= 4);
    assert_true(started <= 1);
}

/* ---- a pull of the full acceleration --------------------------------------------------------- */

/*
 * Straight, 20 scans with accel_max, straight; a quarter of the plots is missing, with some
 * clutter.
 */
static unsigned count_runs_followed_through_pull(uint8_t gate, double interval_s)
{
    unsigned kept = 0;
    for (unsigned run = 0; run < NUM_RUNS; run++) {
        uint32_t track_id = 0;
        set_up_scene(gate, 3000 + run);
        scene.num_targets = 1;
        scene.interval_s = interval_s;
        scene.target[0] = (struct target){
            -6000.0,          0.0, 0.0, 300.0, 0.0, run % 2 ? 30.0 : -30.0, 20.5 * interval_s,
            40.5 * interval_s};
        scene.pd = 0.75;
        scene.clutter = 10.0;
        begin_tracker();
        for (int k = 0; k < 60; k++) {
            step_tracker(k);
            const struct rho_track_report *track =
                confirmed_track_nearest_to_target(0, interval_s * k, 150.0);
            track_id = k == 19 && track ? track->track_id : track_id;
            kept += k == 59 && track && track->track_id == track_id;
        }
    }
    return kept;
}

static void gate_best_follows_pulls_of_the_full_acceleration(void **state)
{
    (void)state;
    unsigned best_1s = count_runs_followed_through_pull(RHO_TRACKER_BEST, 1.0);
    unsigned best_2s = count_runs_followed_through_pull(RHO_TRACKER_BEST, 2.0);
    unsigned nearest_1s = count_runs_followed_through_pull(RHO_TRACKER_NEAREST, 1.0);
    print_message("a pull: 1 s: best %u, nearest %u; 2 s: best %u of %d\n", best_1s, nearest_1s,
                  best_2s, NUM_RUNS);
    assert_true(best_1s >= 37);    /* measured 39 */
    assert_true(best_2s >= 37);    /* measured 39 */
    assert_true(nearest_1s <= 32); /* measured 23: such losses are why best is the default */
}

/* ---- a pool of too few hypotheses ------------------------------------------------------------ */

/*
 * As many targets as tracks, each in so much clutter that it needs eight hypotheses, with three
 * available for each.
 */
static void set_up_crowd(uint8_t gate, uint64_t seed)
{
    set_up_scene(gate, seed);
    scene.num_targets = RHO_MAX_TRACKS < SCENE_TARGETS_MAX ? RHO_MAX_TRACKS : SCENE_TARGETS_MAX;
    for (unsigned i = 0; i < scene.num_targets; i++) {
        struct target *target = &scene.target[i];
        *target = (struct target){.speed_mps = 60.0, .course_rad = 0.2 * i};
        target->x_m = -4000.0 + 1500.0 * (i % 6u);
        target->y_m = -4000.0 + 1500.0 * (i / 6u);
    }
    scene.sigma_m = 80.0;
    scene.half_area_m = 5000.0;
    scene.clutter = 200.0;
    scene.pd = 0.95;
    scene.interval_s = 2.0;
    begin_tracker();
}

/* Counts targets that have a track after the run among clutter. */
static unsigned count_targets_followed_in_crowd(uint8_t gate, uint64_t seed, unsigned *least_free)
{
    unsigned followed = 0;
    set_up_crowd(gate, seed);
    for (int k = 0; k < 40; k++) {
        step_tracker(k); /* step_tracker checks that each track has a hypothesis and none is lost */
        *least_free =
            tracker.hypotheses.num_free < *least_free ? tracker.hypotheses.num_free : *least_free;
    }
    for (unsigned i = 0; i < scene.num_targets; i++) {
        followed += confirmed_track_nearest_to_target(i, 2.0 * 39.0, 400.0) != NULL;
    }
    assert_int_equal(tracker.counters.updates_refused, 0);
    return followed;
}

/* 128 targets in all: with a pool of eight hypotheses a track 115 are followed. */
static void a_small_pool_of_hypotheses_is_shared_among_tracks(void **state)
{
    (void)state;
    if (RHO_MAX_TRACKS > SCENE_TARGETS_MAX) {
        skip(); /* a workstation's track table is too large to fill in a unit test */
    }
    unsigned best = 0, nearest = 0;
    for (uint64_t seed = 5; seed < 9; seed++) {
        unsigned least_free = RHO_MAX_HYPOTHESES;
        nearest += count_targets_followed_in_crowd(RHO_TRACKER_NEAREST, seed, &least_free);
        assert_int_equal(least_free, RHO_MAX_HYPOTHESES);
        assert_int_equal(tracker.counters.hypotheses_cut, 0);
        best += count_targets_followed_in_crowd(RHO_TRACKER_BEST, seed, &least_free);
        assert_int_equal(least_free, 0);
        assert_true(tracker.counters.hypotheses_cut > 1000); /* measured 4 300 */
        assert_int_equal(tracker.counters.hypotheses_cut, tracker.hypotheses.hypotheses_cut);
    }
    print_message("a small pool: best %u, nearest %u\n", best, nearest);
    assert_true(best >= 102);          /* measured 108 */
    assert_true(best >= nearest + 10); /* measured 88 */
    scene.num_targets = 0;
    scene.clutter = 0.0;
    for (int k = 40; k < 64; k++) { /* at first the misses of all are taken for the sensor's */
        step_tracker(k);
    }
    assert_int_equal(tracker.hypotheses.num_free, RHO_MAX_HYPOTHESES);
}

/*
 * More targets than tracks, and long tentative phases: missed tentative tracks are replaced by
 * candidates with more plots, and their hypotheses are freed (each step checks that no slot stays
 * open).
 */
static void replaced_tentative_tracks_free_their_hypotheses(void **state)
{
    (void)state;
    if (RHO_MAX_TRACKS >= SCENE_TARGETS_MAX) {
        skip(); /* a workstation's track table is too large to fill in a unit test */
    }
    unsigned gave_way = 0;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        set_up_scene(RHO_TRACKER_BEST, seed);
        initiation.false_tracks_per_hour = 1e-6f;
        scene.num_targets = SCENE_TARGETS_MAX;
        for (unsigned i = 0; i < SCENE_TARGETS_MAX; i++) {
            scene.target[i] = (struct target){.x_m = -8000.0 + 3000.0 * (i % 6u),
                                              .y_m = -8000.0 + 2500.0 * (i / 6u),
                                              .speed_mps = 150.0};
        }
        scene.pd = 0.7;
        scene.clean_scans = 0;
        begin_tracker();
        for (int k = 0; k < 15; k++) {
            const uint32_t started = tracker.counters.tracks_started;
            const int is_full = tracker.num_tracks == RHO_MAX_TRACKS;
            step_tracker(k);
            gave_way += is_full ? tracker.counters.tracks_started - started : 0;
        }
    }
    assert_true(gave_way > 20); /* measured 55 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gate_best_reports_a_turn),
        cmocka_unit_test(input_estimation_reports_a_turn),
        cmocka_unit_test(plain_filters_report_no_acceleration),
        cmocka_unit_test(targets_side_by_side_keep_their_identities),
        cmocka_unit_test(targets_in_formation_claim_all_their_plots),
        cmocka_unit_test(gate_best_follows_pulls_of_the_full_acceleration),
        cmocka_unit_test(a_small_pool_of_hypotheses_is_shared_among_tracks),
        cmocka_unit_test(replaced_tentative_tracks_free_their_hypotheses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
