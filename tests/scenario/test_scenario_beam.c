/* SPDX-License-Identifier: MIT */
/*
 * Scenarios popup, weave, hard-turn: the path beside one that is integrated in small steps, and what the beam sees: is its
 * chance what the parameters say? Seeds are fixed; bounds are four standard deviations of a sample's mean or variance.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "scenario.h"

#define SEED 4711
#define PI 3.141592653589793
#define G_MPS2 9.80665
#define SCANS 161
#define DT_S 0.25

static const char *const names[] = {"popup", "weave", "hard-turn"};

static struct simulation *simulate(const char *name, const char *const *settings, uint64_t run)
{
    struct parameters parameters;

    parameters_default(&parameters);
    for (; settings && *settings; settings++) {
        parameters_set(&parameters, *settings);
    }
    scenario_suggest(name, &parameters);
    return scenario_simulate(name, &parameters, SEED, run);
}

static void assert_within(const char *what, double value, double expected, double most)
{
    if (!(fabs(value - expected) <= most)) {
        print_message("%s: %.7g, expected %.7g +- %.3g\n", what, value, expected, most);
    }
    assert_true(fabs(value - expected) <= most);
}

struct sample {
    double count, sum, squares;
};

static void add(struct sample *sample, double value)
{
    sample->count += 1.0;
    sample->sum += value;
    sample->squares += value * value;
}

/* Mean, variance, and how far the sample's variance may be off: normal 2 / n, uniform 4 / (5 n) of its square. */
static void assert_sample(const char *what, const struct sample *sample, double mean,
                          double variance, double kurtosis)
{
    double found = sample->sum / sample->count;

    assert_true(sample->count >= 1000.0);
    assert_within(what, found, mean, 4.0 * sqrt(variance / sample->count));
    assert_within(what, sample->squares / sample->count - found * found, variance,
                  4.0 * variance * sqrt(kurtosis / sample->count));
}

#define NORMAL 2.0
#define UNIFORM 0.8

/* ---- paths -------------------------------------------------------------------------------------- */

static const char *const no_noise[] = {"true_noise_mps2=0", "true_noise_m=0", "true_noise_mps=0",
                                       NULL};

/* As it is written down: how often 10 g it pulls at a time, up, to the left, or to the left of where it flies. */
static double pull_of(int scenario, double t)
{
    if (scenario == 0) {
        return t < 10 ? 0 : t < 14 ? 1 : t < 18 ? 0 : t < 26 ? -1 : t < 30 ? 0 : t < 34 ? 1 : 0;
    }
    if (scenario == 1) {
        return t < 8 ? 0 : t < 12 ? 1 : t < 20 ? -1 : t < 28 ? 1 : t < 32 ? -1 : 0;
    }
    return t < 8 ? 0 : t < 14 ? 1 : t < 16 ? 0 : t < 28 ? -1 : t < 30 ? 0 : t < 36 ? 1 : 0;
}

/* Steps of half a millisecond; over each scan interval a turn's acceleration keeps its direction, as the scenario's. */
static void integrate(int scenario, double accel_mps2, double states[SCANS][6])
{
    enum { STEPS = 500 };
    double x[6] = {50000.0, 35000.0, 300.0, -600.0, -500.0, 0.0};
    double speed = sqrt(610000.0), heading = atan2(-500.0, -600.0), h = DT_S / STEPS;

    for (int scan = 0; scan < SCANS; scan++) {
        double pull = accel_mps2 * pull_of(scenario, scan * DT_S + 1e-6);
        double a[3] = {-pull * sin(heading), pull * cos(heading), 0.0};

        if (scenario == 0) {
            a[0] = a[1] = 0.0;
            a[2] = pull;
        }
        memcpy(states[scan], x, sizeof x);
        for (int i = 0; i < STEPS; i++) { /* the mean of the velocities at both ends */
            for (int k = 0; k < 3; k++) {
                x[k] += h * (x[k + 3] + a[k] * h / 2.0);
                x[k + 3] += a[k] * h;
            }
        }
        heading += scenario == 2 ? pull / speed * DT_S : 0.0;
    }
}

static void paths_are_those_of_the_pulls(void **state)
{
    (void)state;
    for (int scenario = 0; scenario < 3; scenario++) {
        static double states[SCANS][6];
        struct simulation *simulation = simulate(names[scenario], no_noise, 0);

        integrate(scenario, 10.0 * G_MPS2, states);
        assert_int_equal(simulation->num_scans, SCANS);
        assert_int_equal(simulation->num_targets, 1);
        for (int scan = 0; scan < SCANS; scan++) {
            const struct truth_point *at = &simulation->truth[scan];
            const double found[] = {at->x_m, at->y_m, at->z_m, at->vx_mps, at->vy_mps, at->vz_mps};

            assert_within("time", at->t_s, scan * DT_S, 1e-9);
            for (int k = 0; k < 6; k++) {
                assert_within(names[scenario], found[k], states[scan][k], 1e-6);
            }
        }
        simulation_free(simulation);
    }
}

/* 300 m again after the pop-up; on a line beside its first after the weave; back to its heading after the turns. */
static void the_target_levels_off(void **state)
{
    struct simulation *popup = simulate("popup", no_noise, 0);
    struct simulation *weave = simulate("weave", no_noise, 0);
    struct simulation *turn = simulate("hard-turn", no_noise, 0);
    const struct truth_point *last = &popup->truth[SCANS - 1];
    double highest_m = 0.0;
    const double aside_m = 16.0 * 10.0 * G_MPS2; /* 8 s^2 of the first pull, and of the last */
    (void)state;

    for (int scan = 0; scan < SCANS; scan++) {
        const struct truth_point *at = &turn->truth[scan];

        highest_m = fmax(highest_m, popup->truth[scan].z_m);
        assert_within("speed", hypot(at->vx_mps, at->vy_mps), sqrt(610000.0),
                      40.0); /* pulls keep their direction over an interval: 5 % more */
        assert_within("height", at->z_m, 300.0, 1e-9);
    }
    assert_within("popup", last->z_m, 300.0, 1e-6);
    assert_within("popup", last->vz_mps, 0.0, 1e-9);
    assert_true(highest_m > 3000.0);
    last = &weave->truth[SCANS - 1];
    assert_within("weave", last->x_m, 50000.0 - 600.0 * 40.0 + aside_m * 500.0 / 781.02497, 1e-2);
    assert_within("weave", last->y_m, 35000.0 - 500.0 * 40.0 - aside_m * 600.0 / 781.02497, 1e-2);
    assert_within("weave", last->vx_mps, -600.0, 1e-9);
    assert_within("weave", last->vy_mps, -500.0, 1e-9);
    last = &turn->truth[SCANS - 1];
    assert_within("turn", atan2(last->vy_mps, last->vx_mps), atan2(-500.0, -600.0), 0.02);
    simulation_free(popup);
    simulation_free(weave);
    simulation_free(turn);
}

static void accel_g_is_what_it_pulls(void **state)
{
    const char *const settings[] = {"accel_g=3", "true_noise_mps2=0", NULL};
    struct simulation *simulation = simulate("popup", settings, 0);
    (void)state;

    for (int scan = 40; scan < 56; scan++) {
        assert_within("3 g", simulation->truth[scan + 1].vz_mps - simulation->truth[scan].vz_mps,
                      3.0 * G_MPS2 * DT_S, 1e-9);
    }
    simulation_free(simulation);
}

/* What a scan interval adds to velocity and place, beside the pull; all axes, the first 8 s. */
static void sample_noise(const char *const *settings, struct sample *velocity, struct sample *place,
                         struct sample *both, double place_of_velocity_s)
{
    for (uint64_t run = 0; run < 50; run++) {
        struct simulation *simulation = simulate("weave", settings, run);

        for (int scan = 0; scan < 32; scan++) {
            const struct truth_point *a = &simulation->truth[scan], *b = a + 1;
            const double dv[] = {b->vx_mps - a->vx_mps, b->vy_mps - a->vy_mps,
                                 b->vz_mps - a->vz_mps};
            const double dx[] = {b->x_m - a->x_m - DT_S * a->vx_mps,
                                 b->y_m - a->y_m - DT_S * a->vy_mps,
                                 b->z_m - a->z_m - DT_S * a->vz_mps};

            for (int k = 0; k < 3; k++) {
                add(velocity, dv[k]);
                add(place, dx[k] - place_of_velocity_s * dv[k]);
                add(both, dv[k] * dx[k]);
            }
        }
        simulation_free(simulation);
    }
}

static void physical_noise_is_an_acceleration(void **state)
{
    struct sample velocity = {0}, place = {0}, both = {0};
    (void)state;

    sample_noise(NULL, &velocity, &place, &both, DT_S / 2.0);
    assert_sample("velocity", &velocity, 0.0, 0.25, NORMAL); /* 2 m/s^2 for 0.25 s */
    assert_within("place", sqrt(place.squares / place.count), 0.0, 1e-9);
}

static void literal_noise_is_the_identity(void **state)
{
    const char *const settings[] = {"true_model=literal", "true_noise_m=3", NULL};
    struct sample velocity = {0}, place = {0}, both = {0};
    (void)state;

    sample_noise(settings, &velocity, &place, &both, 0.0);
    assert_sample("velocity", &velocity, 0.0, 1.0, NORMAL);
    assert_sample("place", &place, 0.0, 9.0, NORMAL);
    assert_within("both", both.sum / both.count, 0.0, 4.0 * 3.0 / sqrt(both.count));
}

/* The literal input moves velocities only. */
static void a_literal_pull_moves_no_place_at_once(void **state)
{
    const char *const settings[] = {"true_model=literal", "true_noise_m=0", "true_noise_mps=0",
                                    NULL};
    struct simulation *simulation = simulate("popup", settings, 0);
    (void)state;

    assert_within("before", simulation->truth[40].vz_mps, 0.0, 1e-9);
    assert_within("velocity", simulation->truth[41].vz_mps, 10.0 * G_MPS2 * DT_S, 1e-9);
    assert_within("place", simulation->truth[41].z_m, 300.0, 1e-9);
    simulation_free(simulation);
}

/* ---- what the beam sees ------------------------------------------------------------------------- */

static const char *const with_velocity[] = {"velocity=1", "sigma_mps=3", "clutter_per_scan=10",
                                            NULL};

/* Clutter: how far in the beam's radius, cubed (uniform in a ball: 0 .. 1), and along each axis. */
static void clutter_fills_half_the_beam(void **state)
{
    struct sample cubes = {0}, axes[3] = {{0}};
    (void)state;

    for (uint64_t run = 0; run < 4; run++) {
        struct simulation *simulation = simulate("popup", with_velocity, run);

        for (int scan = 0; scan < SCANS; scan++) {
            const struct simulated_scan *seen = &simulation->scans[scan];
            const struct truth_point *at = &simulation->truth[scan];
            double radius_m = sqrt(at->x_m * at->x_m + at->y_m * at->y_m + at->z_m * at->z_m) *
                              sin(0.6 * PI / 180.0);

            assert_int_equal(seen->num_plots, scan < 3 ? 1 : 11);
            for (size_t i = 0; i < seen->num_plots; i++) {
                const struct simulated_plot *plot = &seen->plots[i];
                const double off[] = {(plot->x_m - at->x_m) / radius_m,
                                      (plot->y_m - at->y_m) / radius_m,
                                      (plot->z_m - at->z_m) / radius_m};
                double length = sqrt(off[0] * off[0] + off[1] * off[1] + off[2] * off[2]);

                if (plot->target_id < 0) {
                    assert_true(length <= 1.0 + 1e-9);
                    add(&cubes, length * length * length);
                    for (int k = 0; k < 3; k++) {
                        add(&axes[k], off[k]);
                    }
                }
            }
        }
        simulation_free(simulation);
    }
    assert_sample("radius^3", &cubes, 0.5, 1.0 / 12.0, UNIFORM);
    for (int k = 0; k < 3; k++) {
        assert_sample("axis", &axes[k], 0.0, 0.2, 8.0 / 7.0); /* kurtosis 15/7 */
    }
}

static void clutter_velocities_are_ways_from_the_last_place(void **state)
{
    struct simulation *simulation = simulate("weave", with_velocity, 0);
    (void)state;

    for (int scan = 3; scan < SCANS; scan++) {
        const struct simulated_scan *seen = &simulation->scans[scan];
        const struct truth_point *last = &simulation->truth[scan - 1];

        for (size_t i = 0; i < seen->num_plots; i++) {
            const struct simulated_plot *plot = &seen->plots[i];

            if (plot->target_id < 0) {
                assert_within("vx", plot->vx_mps, (plot->x_m - last->x_m) / DT_S, 1e-6);
                assert_within("vy", plot->vy_mps, (plot->y_m - last->y_m) / DT_S, 1e-6);
                assert_within("vz", plot->vz_mps, (plot->z_m - last->z_m) / DT_S, 1e-6);
            }
        }
    }
    simulation_free(simulation);
}

static void detections_have_their_noise_and_rate(void **state)
{
    const char *const settings[] = {"velocity=1",  "sigma_mps=3",    "sigma_m=7",
                                    "true_pd=0.9", "clean_scans=20", NULL};
    struct sample place = {0}, velocity = {0};
    double seen = 0.0, scans = 0.0;
    (void)state;

    for (uint64_t run = 0; run < 20; run++) {
        struct simulation *simulation = simulate("hard-turn", settings, run);

        for (int scan = 0; scan < SCANS; scan++) {
            const struct truth_point *at = &simulation->truth[scan];
            const struct simulated_scan *look = &simulation->scans[scan];

            assert_int_equal(look->num_plots > 4, scan >= 20 && look->num_plots == 5);
            for (size_t i = 0; i < look->num_plots; i++) {
                const struct simulated_plot *plot = &look->plots[i];

                if (plot->target_id == 0) {
                    add(&place, plot->x_m - at->x_m);
                    add(&place, plot->y_m - at->y_m);
                    add(&place, plot->z_m - at->z_m);
                    add(&velocity, plot->vx_mps - at->vx_mps);
                    add(&velocity, plot->vy_mps - at->vy_mps);
                    add(&velocity, plot->vz_mps - at->vz_mps);
                    seen += scan >= 20;
                } else {
                    assert_true(scan >= 20);
                }
            }
            scans += scan >= 20;
        }
        simulation_free(simulation);
    }
    assert_sample("place", &place, 0.0, 49.0, NORMAL);
    assert_sample("velocity", &velocity, 0.0, 9.0, NORMAL);
    assert_within("detected", seen / scans, 0.9, 4.0 * sqrt(0.09 / scans));
    assert_int_equal((int)(place.count / 3.0 - seen), 20 * 20);
}

/* The target's row is anywhere in the scan. */
static void plots_are_in_random_order(void **state)
{
    struct sample rows = {0};
    (void)state;

    for (uint64_t run = 0; run < 8; run++) {
        struct simulation *simulation = simulate("popup", NULL, run);

        for (int scan = 3; scan < SCANS; scan++) {
            for (size_t i = 0; i < simulation->scans[scan].num_plots; i++) {
                if (simulation->scans[scan].plots[i].target_id == 0) {
                    add(&rows, (double)i);
                }
            }
        }
        simulation_free(simulation);
    }
    assert_sample("row", &rows, 2.0, 2.0, 0.7); /* uniform on 0 .. 4: kurtosis 1.7 */
}

static bool are_same(const struct simulated_scan *one, const struct simulated_scan *other)
{
    bool are = one->num_plots == other->num_plots;

    for (size_t i = 0; are && i < one->num_plots; i++) {
        const struct simulated_plot *a = &one->plots[i], *b = &other->plots[i];
        const double values[][2] = {{a->x_m, b->x_m},       {a->y_m, b->y_m},
                                    {a->z_m, b->z_m},       {a->vx_mps, b->vx_mps},
                                    {a->vy_mps, b->vy_mps}, {a->vz_mps, b->vz_mps}};

        are = a->target_id == b->target_id;
        for (int k = 0; k < 6; k++) {
            are = are && memcmp(&values[k][0], &values[k][1], sizeof(double)) == 0;
        }
    }
    return are;
}

/* A seed and run give the same data; another gives others; velocities change nothing but themselves. */
static void seeds_decide(void **state)
{
    struct simulation *one = simulate("popup", NULL, 0), *same = simulate("popup", NULL, 0);
    struct simulation *other = simulate("popup", NULL, 1);
    const char *const settings[] = {"velocity=1", NULL};
    struct simulation *more = simulate("popup", settings, 0);
    (void)state;

    for (int scan = 0; scan < SCANS; scan++) {
        assert_true(are_same(&one->scans[scan], &same->scans[scan]));
        assert_true(are_same(&one->scans[scan], &more->scans[scan]));
        assert_false(are_same(&one->scans[scan], &other->scans[scan]));
    }
    assert_true(more->beam.has_velocity && !one->beam.has_velocity);
    simulation_free(one);
    simulation_free(same);
    simulation_free(other);
    simulation_free(more);
}

/* What the tracker is told: 1.2 times what the target pulls, and speeds that it reaches. */
static void limits_follow_the_pull(void **state)
{
    struct parameters parameters;
    (void)state;

    parameters_default(&parameters);
    scenario_suggest("popup", &parameters);
    assert_within("10 g", parameters.value[PARAMETER_ACCEL_MAX_MPS2], 12.0 * G_MPS2, 1e-9);
    assert_within("speed", parameters.value[PARAMETER_V_MAX_MPS], 1000.0, 1e-9);
    parameters_default(&parameters);
    parameters_set(&parameters, "accel_g=30");
    scenario_suggest("popup", &parameters);
    assert_within("30 g", parameters.value[PARAMETER_ACCEL_MAX_MPS2], 36.0 * G_MPS2, 1e-9);
    assert_within("speed", parameters.value[PARAMETER_V_MAX_MPS],
                  sqrt(610000.0 + 120.0 * 120.0 * G_MPS2 * G_MPS2), 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_are_those_of_the_pulls),
        cmocka_unit_test(the_target_levels_off),
        cmocka_unit_test(accel_g_is_what_it_pulls),
        cmocka_unit_test(physical_noise_is_an_acceleration),
        cmocka_unit_test(literal_noise_is_the_identity),
        cmocka_unit_test(a_literal_pull_moves_no_place_at_once),
        cmocka_unit_test(clutter_fills_half_the_beam),
        cmocka_unit_test(clutter_velocities_are_ways_from_the_last_place),
        cmocka_unit_test(detections_have_their_noise_and_rate),
        cmocka_unit_test(plots_are_in_random_order),
        cmocka_unit_test(seeds_decide),
        cmocka_unit_test(limits_follow_the_pull),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
