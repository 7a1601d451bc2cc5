/* SPDX-License-Identifier: MIT */
/* How long calm targets keep straight is learned from what established tracks do. */
#include "tracker_setup.h"

#define SIGMA_M 40.0
#define SPEED_MPS 200.0
#define TURN_S 4.0
#define MEMORY_S 1600.0
#define ESTABLISHED_HITS 16
#define TARGETS 6

/*
 * Targets that fly round and round far apart, each on a square of straight sides, or on a circle.
 */
static int turn;

static void begin_turns(void)
{
    begin_tracker_by_rate(31);
    turn = 0;
}

/*
 * Straight ones keep straight; others turn by 180 degrees at 15 m/s^2 once a minute, all to and
 * fro.
 */
static void fly(int turns, int num_targets, int has_turns)
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

static unsigned grown_tracks(void)
{
    unsigned count = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        count += report.tracks[i].hits >= ESTABLISHED_HITS;
    }
    return count;
}

static double calm_s(void)
{
    return (double)tracker.hypotheses.model.calm_s;
}

/* Grown tracks of which the scan before said that they surely manoeuvre, or not. */
static unsigned grown_that_turn(const struct rho_report *before, int turns)
{
    unsigned count = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        for (unsigned k = 0; k < before->num_tracks; k++) {
            count += before->tracks[k].track_id == report.tracks[i].track_id &&
                     report.tracks[i].hits >= ESTABLISHED_HITS &&
                     turns == (before->tracks[k].maneuver_probability > 0.9f);
        }
    }
    return count;
}

/*
 * Six targets keep straight: as the rule has it in double, in doublings, until eight times the
 * first figure.
 */
static void straight_targets_are_calmer(void **state)
{
    (void)state;
    static struct rho_report before;
    double straight_s = 0.0, turning_s = 0.0, expected_s = 300.0;
    begin_turns();
    memset(&before, 0, sizeof before);
    for (int k = 0; k < 700; k++) {
        /* tracks count from their 16th hit on, the very first a scan later */
        const double counts_s = k > 0 && grown_tracks() > 0 ? TURN_S : 0.0;
        fly(1, TARGETS, 0);
        const double kept = exp(-TURN_S / MEMORY_S);
        straight_s = kept * straight_s + counts_s * grown_that_turn(&before, 0);
        turning_s = kept * turning_s + counts_s * grown_that_turn(&before, 1);
        const double all_s = 1200.0 + straight_s;
        const double turns = 4.0 + turning_s / (double)tracker.hypotheses.model.maneuver_s;
        expected_s *= expected_s < 2400.0 && all_s / turns >= 2.0 * expected_s ? 2.0 : 1.0;
        assert_true(fabs(calm_s() - expected_s) < 1e-3);
        assert_true(k > 40 || calm_s() <= 300.0);
        before = report;
    }
    print_message("straight %.0f s, expected %.0f s, turning %.0f s\n", (double)tracker.straight_s,
                  straight_s, (double)tracker.turning_s);
    assert_int_equal(grown_tracks(), TARGETS);
    assert_true(fabs((double)tracker.straight_s / straight_s - 1.0) < 1e-3);
    assert_true(calm_s() >= 1200.0);
    /* no more than eight times as long */
    tracker.straight_s = 1e6f;
    fly(5, TARGETS, 0);
    assert_true(fabs(calm_s() - 2400.0) < 1e-3);
}

/* The same sky, known and not: the learned one has the smaller covariances. */
static void what_is_learned_is_used(void **state)
{
    (void)state;
    double variance[2];
    for (int is_held = 0; is_held < 2; is_held++) {
        begin_turns();
        for (int k = 0; k < 300; k++) {
            fly(1, TARGETS, 0);
            tracker.straight_s = is_held ? 0.0f : tracker.straight_s;
        }
        assert_true(fabs(calm_s() - (is_held ? 300.0 : 1200.0)) < 1e-3);
        variance[is_held] = 0.0;
        for (unsigned i = 0; i < report.num_tracks; i++) {
            variance[is_held] += (double)report.tracks[i].covariance[9];
        }
    }
    print_message("variance of vx %.2f learned, %.2f not\n", variance[0], variance[1]);
    assert_true(variance[0] < 0.6 * variance[1]);
}

static void turns_take_it_back(void **state)
{
    (void)state;
    begin_turns();
    fly(300, TARGETS, 0);
    assert_true(calm_s() >= 1200.0);
    /* other targets, which turn once a minute; the straight ones are gone */
    fly(250, TARGETS, 1);
    print_message("calm_s %.0f; straight %.0f s, turning %.0f s\n", calm_s(),
                  (double)tracker.straight_s, (double)tracker.turning_s);
    assert_true(calm_s() <= 300.0);
    assert_true(tracker.turning_s > 100.0f);
}

/*
 * A minute in which nobody looked teaches nothing, nor do new tracks; and then calm targets are
 * what they were at first.
 */
static void silence_teaches_nothing(void **state)
{
    (void)state;
    begin_turns();
    fly(10, TARGETS, 0);
    assert_true(report.num_tracks > 0);
    assert_true(tracker.straight_s <= 0.0f);
    fly(40, TARGETS, 0);
    const float before_s = tracker.straight_s;
    assert_true(before_s > 100.0f);
    fly(250, TARGETS, 0);
    assert_true(calm_s() >= 1200.0);
    const float straight_s = tracker.straight_s;
    step_at(TURN_S * turn + 61.0);
    assert_true(calm_s() <= 300.0);
    assert_true(tracker.straight_s < 0.1f * straight_s);
    fly(3, TARGETS, 0);
    assert_true(calm_s() <= 300.0);
    step_at(TURN_S * turn + 3600.0);
    assert_true(tracker.straight_s < 0.2f * straight_s && calm_s() <= 300.0);
}

/* Slow antennas look once in less than a minute: nothing is forgotten for that. */
static void slow_looks_are_no_silence(void **state)
{
    (void)state;
    begin_turns();
    fly(300, TARGETS, 0);
    assert_true(calm_s() >= 1200.0);
    step_at(TURN_S * (turn - 1) + 45.0);
    assert_true(calm_s() >= 1200.0);
}

/* Two states of the chain have no calm one; and gates without hypotheses none at all. */
static void where_nothing_is_calm_nothing_is_learned(void **state)
{
    (void)state;
    begin_turns();
    tracker.hypotheses.model.calm_s = 0.0f;
    fly(60, 2, 0);
    assert_true(calm_s() <= 0.0);
    use_usual_configs(3);
    config.gate = RHO_TRACKER_NEAREST;
    begin_tracker();
    turn = 0;
    fly(60, 2, 0);
    assert_true(tracker.straight_s <= 0.0f && report.num_tracks == 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(straight_targets_are_calmer),
        cmocka_unit_test(what_is_learned_is_used),
        cmocka_unit_test(turns_take_it_back),
        cmocka_unit_test(silence_teaches_nothing),
        cmocka_unit_test(slow_looks_are_no_silence),
        cmocka_unit_test(where_nothing_is_calm_nothing_is_learned),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
