/* SPDX-License-Identifier: MIT */
/* The mean time that calm targets fly straight is learned from established tracks. */
#include "tracker_setup.h"

#define SIGMA_M 40.0
#define SPEED_MPS 200.0
#define TURN_S 4.0
#define MEMORY_S 1600.0
#define ESTABLISHED_HITS 16
#define TARGETS 6

/* Targets circle far apart, each on a square of straight sides or on a circle. */
static int turn;

static void start_tracker(void)
{
    begin_tracker_by_rate(31);
    turn = 0;
}

/* Straight targets stay straight; the others turn by 180 degrees at 15 m/s^2 once a minute. */
static void fly_turns_of_antenna(int turns, int num_targets, int has_turns)
{
    const double radius_m = SPEED_MPS * SPEED_MPS / 15.0, half_s = 60.0;
    const double bend_s = 3.141592653589793 * radius_m / SPEED_MPS;
    for (int k = 0; k < turns; k++, turn++) {
        const double t_s = TURN_S * turn;
        for (int i = 0; i < num_targets; i++) {
            double x_m = -80000.0 + SPEED_MPS * t_s, y_m = 20000.0 * i;
            if (has_turns) {
                const double in_s = fmod(t_s, 2.0 * half_s);
                const double there_s = fmod(in_s, half_s), side = in_s < half_s ? 1.0 : -1.0;
                const double angle = (there_s - (half_s - bend_s)) / bend_s * 3.141592653589793;
                const double straight_s = angle < 0.0 ? there_s : half_s - bend_s;
                const double begin_m = side * -0.5 * SPEED_MPS * (half_s - bend_s);
                x_m = begin_m + side * SPEED_MPS * straight_s;
                x_m += angle < 0.0 ? 0.0 : side * radius_m * sin(angle);
                y_m +=
                    side * -radius_m + (angle < 0.0 ? 0.0 : side * radius_m * (1.0 - cos(angle)));
            }
            add_noisy_plot(x_m, y_m, SIGMA_M);
        }
        step_at(t_s);
    }
}

static unsigned count_established_tracks(void)
{
    unsigned count = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        count += report.tracks[i].hits >= ESTABLISHED_HITS;
    }
    return count;
}

static double learned_manoeuvre_interval_s(void)
{
    return (double)tracker.hypotheses.model.calm_s;
}

/* Counts established tracks that surely manoeuvred in the scan before (turns 1), or did not (0). */
static unsigned count_established_tracks_by_manoeuvre(const struct rho_report *before,
                                                      int has_manoeuvred)
{
    unsigned count = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        for (unsigned k = 0; k < before->num_tracks; k++) {
            count += before->tracks[k].track_id == report.tracks[i].track_id &&
                     report.tracks[i].hits >= ESTABLISHED_HITS &&
                     has_manoeuvred == (before->tracks[k].maneuver_probability > 0.9f);
        }
    }
    return count;
}

/*
 * Six straight targets: the interval follows the formula in double precision, doubling until eight
 * times its first value.
 */
static void straight_targets_lengthen_the_manoeuvre_interval(void **state)
{
    (void)state;
    static struct rho_report before;
    double straight_s = 0.0, turning_s = 0.0, expected_s = 300.0;
    start_tracker();
    memset(&before, 0, sizeof before);
    for (int k = 0; k < 700; k++) {
        /* tracks count from their 16th hit on, and from the next scan in the first case */
        const double counts_s = k > 0 && count_established_tracks() > 0 ? TURN_S : 0.0;
        fly_turns_of_antenna(1, TARGETS, 0);
        const double kept = exp(-TURN_S / MEMORY_S);
        straight_s =
            kept * straight_s + counts_s * count_established_tracks_by_manoeuvre(&before, 0);
        turning_s = kept * turning_s + counts_s * count_established_tracks_by_manoeuvre(&before, 1);
        const double all_s = 1200.0 + straight_s;
        const double turns = 4.0 + turning_s / (double)tracker.hypotheses.model.maneuver_s;
        expected_s *= expected_s < 2400.0 && all_s / turns >= 2.0 * expected_s ? 2.0 : 1.0;
        assert_true(fabs(learned_manoeuvre_interval_s() - expected_s) < 1e-3);
        assert_true(k > 40 || learned_manoeuvre_interval_s() <= 300.0);
        before = report;
    }
    print_message("straight %.0f s, expected %.0f s, turning %.0f s\n", (double)tracker.straight_s,
                  straight_s, (double)tracker.turning_s);
    assert_int_equal(count_established_tracks(), TARGETS);
    assert_true(fabs((double)tracker.straight_s / straight_s - 1.0) < 1e-3);
    assert_true(learned_manoeuvre_interval_s() >= 1200.0);
    /* eight times the first value is the limit */
    tracker.straight_s = 1e6f;
    fly_turns_of_antenna(5, TARGETS, 0);
    assert_true(fabs(learned_manoeuvre_interval_s() - 2400.0) < 1e-3);
}

/*
 * The same scene with learned and with default interval: the learned one gives smaller covariances.
 */
static void a_learned_interval_reduces_covariances(void **state)
{
    (void)state;
    double variance[2];
    for (int is_held = 0; is_held < 2; is_held++) {
        start_tracker();
        for (int k = 0; k < 300; k++) {
            fly_turns_of_antenna(1, TARGETS, 0);
            tracker.straight_s = is_held ? 0.0f : tracker.straight_s;
        }
        assert_true(fabs(learned_manoeuvre_interval_s() - (is_held ? 300.0 : 1200.0)) < 1e-3);
        variance[is_held] = 0.0;
        for (unsigned i = 0; i < report.num_tracks; i++) {
            variance[is_held] += (double)report.tracks[i].covariance[9];
        }
    }
    print_message("variance of vx %.2f learned, %.2f not\n", variance[0], variance[1]);
    assert_true(variance[0] < 0.6 * variance[1]);
}

static void turning_targets_shorten_the_interval_again(void **state)
{
    (void)state;
    start_tracker();
    fly_turns_of_antenna(300, TARGETS, 0);
    assert_true(learned_manoeuvre_interval_s() >= 1200.0);
    /* the straight targets have gone, others turn once a minute */
    fly_turns_of_antenna(250, TARGETS, 1);
    print_message("calm_s %.0f; straight %.0f s, turning %.0f s\n", learned_manoeuvre_interval_s(),
                  (double)tracker.straight_s, (double)tracker.turning_s);
    assert_true(learned_manoeuvre_interval_s() <= 300.0);
    assert_true(tracker.turning_s > 100.0f);
}

/*
 * A minute without looks and new tracks teach nothing; then calm targets have the interval of the
 * beginning.
 */
static void a_silent_minute_forgets_the_learned_interval(void **state)
{
    (void)state;
    start_tracker();
    fly_turns_of_antenna(10, TARGETS, 0);
    assert_true(report.num_tracks > 0);
    assert_true(tracker.straight_s <= 0.0f);
    fly_turns_of_antenna(40, TARGETS, 0);
    const float before_s = tracker.straight_s;
    assert_true(before_s > 100.0f);
    fly_turns_of_antenna(250, TARGETS, 0);
    assert_true(learned_manoeuvre_interval_s() >= 1200.0);
    const float straight_s = tracker.straight_s;
    step_at(TURN_S * turn + 61.0);
    assert_true(learned_manoeuvre_interval_s() <= 300.0);
    assert_true(tracker.straight_s < 0.1f * straight_s);
    fly_turns_of_antenna(3, TARGETS, 0);
    assert_true(learned_manoeuvre_interval_s() <= 300.0);
    step_at(TURN_S * turn + 3600.0);
    assert_true(tracker.straight_s < 0.2f * straight_s && learned_manoeuvre_interval_s() <= 300.0);
}

/*
 * 45 s without a look, as between looks of a slow antenna, are no silence: nothing is forgotten.
 */
static void a_pause_of_45_s_keeps_the_interval(void **state)
{
    (void)state;
    start_tracker();
    fly_turns_of_antenna(300, TARGETS, 0);
    assert_true(learned_manoeuvre_interval_s() >= 1200.0);
    step_at(TURN_S * (turn - 1) + 45.0);
    assert_true(learned_manoeuvre_interval_s() >= 1200.0);
}

/* Two motion models have no calm state, and gates without hypotheses learn no interval at all. */
static void without_a_calm_model_no_interval_is_learned(void **state)
{
    (void)state;
    start_tracker();
    tracker.hypotheses.model.calm_s = 0.0f;
    fly_turns_of_antenna(60, 2, 0);
    assert_true(learned_manoeuvre_interval_s() <= 0.0);
    use_usual_configs(3);
    config.gate = RHO_TRACKER_NEAREST;
    begin_tracker();
    turn = 0;
    fly_turns_of_antenna(60, 2, 0);
    assert_true(tracker.straight_s <= 0.0f && report.num_tracks == 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(straight_targets_lengthen_the_manoeuvre_interval),
        cmocka_unit_test(a_learned_interval_reduces_covariances),
        cmocka_unit_test(turning_targets_shorten_the_interval_again),
        cmocka_unit_test(a_silent_minute_forgets_the_learned_interval),
        cmocka_unit_test(a_pause_of_45_s_keeps_the_interval),
        cmocka_unit_test(without_a_calm_model_no_interval_is_learned),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
