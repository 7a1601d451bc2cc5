/* SPDX-License-Identifier: MIT */
/*
 * What the maneuver experiment draws: paths against their integrals, noise against its variance,
 * clutter in its beam. Seeds are fixed; bounds are four standard deviations wide (the comment at
 * each).
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "experiment_maneuver.h"

#define SEED 4711
#define STREAM 1
#define PI 3.141592653589793
#define RADIUS_RATIO 0.010471784116245792 /* sine of 0.6 degrees */

static void assert_near(double value, double expected, double most)
{
    if (!(fabs(value - expected) <= most)) {
        fail_msg("%.9g, expected %.9g +- %.3g", value, expected, most);
    }
}

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Nothing by chance: the path alone. */
static struct maneuver_setting quiet(enum maneuver_profile profile, enum maneuver_truth truth)
{
    return (struct maneuver_setting){.profile = profile,
                                     .pull_g = 10.0,
                                     .truth = truth,
                                     .sensor = MANEUVER_PLACES,
                                     .pd = 1.0,
                                     .beam = MANEUVER_AT_TRUTH,
                                     .accel_max_g = 12.0};
}

static struct maneuver_scene draw(const struct maneuver_setting *setting, uint64_t run)
{
    struct maneuver_scene scene;
    maneuver_scene_draw(&scene, setting, SEED, STREAM, run);
    return scene;
}

/* ---- paths ----------------------------------------------------------------------------------- */

static const double start_mps[3] = {-600.0, -500.0, 0.0};

static void profiles_pull_when_they_say(void **state)
{
    (void)state;
    static const struct {
        enum maneuver_profile profile;
        double t_s;
        int side;
    } sides[] = {
        {MANEUVER_POPUP, 9.99, 0}, {MANEUVER_POPUP, 10.0, 1},  {MANEUVER_POPUP, 13.99, 1},
        {MANEUVER_POPUP, 14.0, 0}, {MANEUVER_POPUP, 18.0, -1}, {MANEUVER_POPUP, 25.99, -1},
        {MANEUVER_POPUP, 26.0, 0}, {MANEUVER_POPUP, 30.0, 1},  {MANEUVER_POPUP, 34.0, 0},
        {MANEUVER_WEAVE, 7.99, 0}, {MANEUVER_WEAVE, 8.0, 1},   {MANEUVER_WEAVE, 12.0, -1},
        {MANEUVER_WEAVE, 20.0, 1}, {MANEUVER_WEAVE, 28.0, -1}, {MANEUVER_WEAVE, 32.0, 0},
        {MANEUVER_TURN, 7.99, 0},  {MANEUVER_TURN, 8.0, 1},    {MANEUVER_TURN, 14.0, 0},
        {MANEUVER_TURN, 16.0, -1}, {MANEUVER_TURN, 28.0, 0},   {MANEUVER_TURN, 30.0, 1},
        {MANEUVER_TURN, 36.0, 0},  {MANEUVER_STRAIGHT, 11, 0},
    };
    for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++) {
        if (maneuver_side(sides[i].profile, sides[i].t_s) != sides[i].side) {
            fail_msg("%s at %g s", maneuver_profile_names[sides[i].profile], sides[i].t_s);
        }
    }
}

static void accelerations_have_their_size_and_direction(void **state)
{
    (void)state;
    const double now_mps[3] = {100.0, -700.0, 50.0};
    double accel[3];
    maneuver_accel(MANEUVER_POPUP, 20.0, 90.0, start_mps, now_mps, accel);
    assert_near(accel[0], 0.0, 0.0);
    assert_near(accel[1], 0.0, 0.0);
    assert_near(accel[2], -90.0, 0.0);
    maneuver_accel(MANEUVER_WEAVE, 9.0, 90.0, start_mps, now_mps, accel);
    assert_near(accel[0] * start_mps[0] + accel[1] * start_mps[1], 0.0, 1e-9);
    assert_true(start_mps[0] * accel[1] - start_mps[1] * accel[0] > 0.0); /* to the left */
    assert_near(length(accel), 90.0, 1e-9);
    maneuver_accel(MANEUVER_TURN, 17.0, 90.0, start_mps, now_mps, accel);
    assert_near(accel[0] * now_mps[0] + accel[1] * now_mps[1], 0.0, 1e-9);
    assert_true(now_mps[0] * accel[1] - now_mps[1] * accel[0] < 0.0); /* to the right */
    assert_near(length(accel), 90.0, 1e-9);
    assert_near(accel[2], 0.0, 0.0);
}

static void a_target_of_no_heading_weaves_to_plus_y(void **state)
{
    (void)state;
    const double none[3] = {0.0, 0.0, 0.0};
    double accel[3];
    maneuver_accel(MANEUVER_WEAVE, 9.0, 90.0, none, none, accel);
    assert_near(accel[0], 0.0, 0.0);
    assert_near(accel[1], 90.0, 0.0);
}

/* By pulse: height and climb of a pop-up in closed form. */
static double popup_height_m(double t_s, double pull_mps2)
{
    static const double from_s[] = {10, 18, 30}, to_s[] = {14, 26, 34}, side[] = {1, -1, 1};
    double height_m = 300.0;
    for (int i = 0; i < 3; i++) {
        double pulled_s = fmin(fmax(t_s - from_s[i], 0.0), to_s[i] - from_s[i]);
        double after_s = fmax(t_s - to_s[i], 0.0);
        height_m += side[i] * pull_mps2 * (pulled_s * pulled_s / 2.0 + pulled_s * after_s);
    }
    return height_m;
}

static void a_physical_popup_is_its_integral(void **state)
{
    (void)state;
    struct maneuver_setting setting = quiet(MANEUVER_POPUP, MANEUVER_PHYSICAL);
    struct maneuver_scene scene = draw(&setting, 0);
    for (size_t scan = 0; scan < MANEUVER_SCANS; scan++) {
        double t_s = 0.25 * (double)scan;
        assert_near(scene.truth[scan][0], 50e3 - 600.0 * t_s, 1e-6);
        assert_near(scene.truth[scan][1], 35e3 - 500.0 * t_s, 1e-6);
        assert_near(scene.truth[scan][2], popup_height_m(t_s, 98.0665), 1e-6);
        assert_near(scene.radius_m[scan], length(scene.truth[scan]) * RADIUS_RATIO, 1e-9);
        assert_memory_equal(scene.measured[scan], scene.truth[scan], sizeof scene.truth[scan]);
    }
    assert_near(scene.truth[MANEUVER_SCANS - 1][2], 300.0, 1e-6);
}

/*
 * The paper's D moves the velocity alone: a pull that has lasted n intervals is n T^2 / 2 behind in
 * place, an a.
 */
static void a_literal_pull_is_late_in_place(void **state)
{
    (void)state;
    struct maneuver_setting literal = quiet(MANEUVER_POPUP, MANEUVER_LITERAL);
    struct maneuver_setting physical = quiet(MANEUVER_POPUP, MANEUVER_PHYSICAL);
    struct maneuver_scene a = draw(&literal, 0), b = draw(&physical, 0);
    for (size_t scan = 40; scan <= 56; scan++) {
        double behind_m = 98.0665 * (double)(scan - 40) * 0.25 * 0.25 / 2.0;
        assert_near(b.truth[scan][2] - a.truth[scan][2], behind_m, 1e-6);
        assert_near(b.truth[scan][5] - a.truth[scan][5], 0.0, 1e-9);
    }
}

static void a_weave_ends_on_its_heading_and_a_turn_turns(void **state)
{
    (void)state;
    struct maneuver_setting weave = quiet(MANEUVER_WEAVE, MANEUVER_PHYSICAL);
    struct maneuver_setting turn = quiet(MANEUVER_TURN, MANEUVER_PHYSICAL);
    struct maneuver_scene weaving = draw(&weave, 0), turning = draw(&turn, 0);
    for (int i = 0; i < 3; i++) {
        assert_near(weaving.truth[MANEUVER_SCANS - 1][i + 3], start_mps[i], 1e-6);
    }
    for (size_t scan = 32; scan < 56;
         scan++) { /* 8 to 14 s: the plan turns by a T / v an interval */
        const double *now = turning.input_mps2[scan], *next = turning.input_mps2[scan + 1];
        double angle_rad = remainder(atan2(next[1], next[0]) - atan2(now[1], now[0]), 2 * PI);
        assert_near(length(now), 98.0665, 1e-9);
        if (scan < 55) {
            assert_near(angle_rad, 98.0665 * 0.25 / hypot(600.0, 500.0), 1e-9);
        }
    }
}

/* ---- chance ---------------------------------------------------------------------------------- */

#define RUNS 40
#define STEPS (RUNS * (MANEUVER_SCANS - 1))

/* A variance of n normal numbers is within 4 sqrt(2 / n) of itself. */
static void assert_variance(double sum2, size_t count, double expected)
{
    assert_near(sum2 / (double)count, expected, 4.0 * sqrt(2.0 / (double)count) * expected);
}

static void literal_noise_is_in_each_element(void **state)
{
    (void)state;
    struct maneuver_setting setting = quiet(MANEUVER_STRAIGHT, MANEUVER_LITERAL);
    setting.noise = 4.0;
    setting.sensor = MANEUVER_VELOCITIES;
    setting.sigma_m = 3.0;
    setting.sigma_mps = 0.5;
    double place2 = 0.0, velocity2 = 0.0, off2 = 0.0, off_mps2 = 0.0;
    for (uint64_t run = 0; run < RUNS; run++) {
        struct maneuver_scene scene = draw(&setting, run);
        for (size_t scan = 1; scan < MANEUVER_SCANS; scan++) {
            const double *was = scene.truth[scan - 1], *is = scene.truth[scan];
            for (int i = 0; i < 3; i++) {
                place2 += pow(is[i] - was[i] - 0.25 * was[i + 3], 2.0);
                velocity2 += pow(is[i + 3] - was[i + 3], 2.0);
                off2 += pow(scene.measured[scan][i] - is[i], 2.0);
                off_mps2 += pow(scene.measured[scan][i + 3] - is[i + 3], 2.0);
            }
        }
    }
    assert_variance(place2, 3 * STEPS, 4.0);
    assert_variance(velocity2, 3 * STEPS, 4.0);
    assert_variance(off2, 3 * STEPS, 9.0);
    assert_variance(off_mps2, 3 * STEPS, 0.25);
}

static void physical_noise_is_an_acceleration(void **state)
{
    (void)state;
    struct maneuver_setting setting = quiet(MANEUVER_STRAIGHT, MANEUVER_PHYSICAL);
    setting.noise = 2.0;
    double accel2 = 0.0;
    for (uint64_t run = 0; run < RUNS; run++) {
        struct maneuver_scene scene = draw(&setting, run);
        for (size_t scan = 1; scan < MANEUVER_SCANS; scan++) {
            const double *was = scene.truth[scan - 1], *is = scene.truth[scan];
            for (int i = 0; i < 3; i++) {
                double accel_mps2 = (is[i + 3] - was[i + 3]) / 0.25;
                accel2 += accel_mps2 * accel_mps2;
                assert_near(is[i], was[i] + 0.25 * was[i + 3] + accel_mps2 * 0.03125, 1e-6);
            }
        }
    }
    assert_variance(accel2, 3 * STEPS, 4.0);
}

/* Share of 40 x 158 looks: sd sqrt(.3 x .7 / 6320) = .0058. */
static void targets_are_seen_as_often_as_they_should(void **state)
{
    (void)state;
    struct maneuver_setting setting = quiet(MANEUVER_STRAIGHT, MANEUVER_PHYSICAL);
    size_t seen = 0;
    setting.pd = 0.7;
    for (uint64_t run = 0; run < RUNS; run++) {
        struct maneuver_scene scene = draw(&setting, run);
        assert_true(scene.is_seen[0] && scene.is_seen[1] && scene.is_seen[2]);
        for (size_t scan = MANEUVER_CLEAN_SCANS; scan < MANEUVER_SCANS; scan++) {
            seen += scene.is_seen[scan];
        }
    }
    assert_near((double)seen / (RUNS * (MANEUVER_SCANS - MANEUVER_CLEAN_SCANS)), 0.7, 0.023);
}

/*
 * d^2 of what a polar radar measures, with its true covariance, at its true place: n in the mean,
 * sd sqrt(2 n / looks).
 */
static void check_polar(enum maneuver_sensor sensor, size_t axes)
{
    struct maneuver_setting setting = quiet(MANEUVER_WEAVE, MANEUVER_PHYSICAL);
    struct double_gaussian truth = {.mean = {0.0}};
    double sum = 0.0, mean_m[3] = {0.0};
    setting.sensor = sensor;
    setting.sigma_m = 15.0;
    setting.sigma_rad = 3e-3;
    for (uint64_t run = 0; run < RUNS; run++) {
        struct maneuver_scene scene = draw(&setting, run);
        for (size_t scan = 0; scan < MANEUVER_SCANS; scan++) {
            struct double_measured measured = maneuver_measured(&scene, scan);
            assert_int_equal(measured.size, axes);
            memcpy(truth.mean, scene.truth[scan], sizeof scene.truth[scan]);
            sum += double_gaussian_distance2(&truth, &measured, NULL);
            for (size_t i = 0; i < 3; i++) {
                mean_m[i] += (measured.value[i] - truth.mean[i]) / (RUNS * MANEUVER_SCANS);
            }
        }
    }
    double looks = RUNS * MANEUVER_SCANS;
    assert_near(sum / looks, (double)axes, 4.0 * sqrt(2.0 * (double)axes / looks));
    for (size_t i = 0; i < 3; i++) { /* sd below 180 m / sqrt(looks) */
        assert_near(mean_m[i], 0.0, 4.0 * 180.0 / sqrt(looks));
    }
}

/*
 * 0.1 rad would shorten places by 0.005 of their range an angle; sd of the mean .01 / sqrt(looks)
 * an angle.
 */
static void polar_places_do_not_fall_short(void **state)
{
    (void)state;
    struct maneuver_setting setting = quiet(MANEUVER_STRAIGHT, MANEUVER_PHYSICAL);
    double along = 0.0, looks = RUNS * MANEUVER_SCANS;
    setting.sensor = MANEUVER_POLAR_3D;
    setting.sigma_rad = 0.1;
    for (uint64_t run = 0; run < RUNS; run++) {
        struct maneuver_scene scene = draw(&setting, run);
        for (size_t scan = 0; scan < MANEUVER_SCANS; scan++) {
            const double *is = scene.measured[scan], *of = scene.truth[scan];
            double range_m = length(of);
            along += (is[0] * of[0] + is[1] * of[1] + is[2] * of[2]) / (range_m * range_m) - 1.0;
        }
    }
    assert_near(along / looks, 0.0, 4.0 * 0.0142 / sqrt(looks));
}

static void polar_noise_has_its_covariance(void **state)
{
    (void)state;
    check_polar(MANEUVER_POLAR, 2);
    check_polar(MANEUVER_POLAR_3D, 3);
}

static void a_polar_target_without_heights_stays_level(void **state)
{
    (void)state;
    struct maneuver_setting setting = quiet(MANEUVER_POPUP, MANEUVER_PHYSICAL);
    setting.sensor = MANEUVER_POLAR;
    setting.noise = 2.0;
    struct maneuver_scene scene = draw(&setting, 0);
    for (size_t scan = 0; scan < MANEUVER_SCANS; scan++) {
        assert_near(scene.truth[scan][2], 0.0, 0.0);
        assert_near(scene.measured[scan][2], 0.0, 0.0);
    }
    assert_int_equal(maneuver_measures(&setting), 0);
}

/* ---- looks ----------------------------------------------------------------------------------- */

static struct maneuver_setting cluttered(enum maneuver_sensor sensor, enum maneuver_beam beam)
{
    struct maneuver_setting setting = quiet(MANEUVER_STRAIGHT, MANEUVER_PHYSICAL);
    setting.sensor = sensor;
    setting.beam = beam;
    setting.clutter = 7;
    setting.sigma_m = 10.0;
    setting.sigma_mps = 2.0;
    return setting;
}

static void the_clean_scans_hold_the_target_alone(void **state)
{
    (void)state;
    struct maneuver_setting setting = cluttered(MANEUVER_PLACES, MANEUVER_AT_PREDICTION);
    const double nowhere_m[3] = {0.0, 0.0, 0.0};
    struct maneuver_scene scene;
    struct maneuver_look look;
    setting.pd = 0.0;
    scene = draw(&setting, 0);
    for (size_t scan = 0; scan < MANEUVER_CLEAN_SCANS; scan++) {
        maneuver_look_fill(&look, &scene, scan, nowhere_m, nowhere_m);
        assert_int_equal(look.scan.num_plots, 1);
        assert_int_equal(look.target_row, 0);
    }
    maneuver_look_fill(&look, &scene, MANEUVER_CLEAN_SCANS, nowhere_m, nowhere_m);
    assert_int_equal(look.scan.num_plots, 7);
    assert_int_equal(look.target_row, -1);
}

struct beam_sums {
    double shares;  /* of the volume within the plot's distance: uniform in 0 .. 1 */
    double along_m; /* of x from the centre over the radius */
    size_t plots, rows[8];
};

static void check_look(struct beam_sums *sums, const struct maneuver_scene *scene, size_t scan)
{
    const struct maneuver_setting *of = scene->of;
    double centre_m[3] = {scene->truth[scan][0] + 80.0, scene->truth[scan][1] - 60.0,
                          scene->truth[scan][2]};
    const double previous_m[3] = {4e4, 3e4, 200.0};
    struct maneuver_look look;
    maneuver_look_fill(&look, scene, scan, centre_m, previous_m);
    assert_int_equal(look.scan.num_plots, 8);
    assert_int_equal(look.scan.time_us, 250000 * (int64_t)scan);
    sums->rows[look.target_row]++;
    for (int row = 0; row < 8; row++) {
        const struct rho_plot *plot = &look.plots[row];
        double at_m[3] = {(double)plot->x_m, (double)plot->y_m, (double)plot->z_m}, off_m[3];
        const double v_mps[3] = {(double)plot->vx_mps, (double)plot->vy_mps, (double)plot->vz_mps};
        for (int i = 0; i < 3; i++) {
            off_m[i] = at_m[i] - centre_m[i];
            if (row != look.target_row && of->sensor == MANEUVER_VELOCITIES) {
                assert_near(previous_m[i] + 0.25 * v_mps[i], at_m[i], 0.02);
            } else if (row == look.target_row) {
                assert_near(at_m[i], scene->measured[scan][i], 0.01);
            }
        }
        if (row != look.target_row) {
            double share = length(off_m) / scene->radius_m[scan];
            assert_true(share <= 1.0 + 1e-5);
            sums->shares += pow(share, of->sensor == MANEUVER_POLAR ? 2.0 : 3.0);
            sums->along_m += off_m[0] / scene->radius_m[scan];
            sums->plots++;
        }
    }
}

/*
 * 7 x 158 x 10 plots: sd of a uniform mean .29 / sqrt(11060) = .0028; of x over the radius at most
 * .5 / 105 = .0048. Rows: 1580 looks, each an eighth: sd 13.
 */
static void check_beam(enum maneuver_sensor sensor, enum maneuver_beam beam)
{
    struct maneuver_setting setting = cluttered(sensor, beam);
    struct beam_sums sums = {.plots = 0};
    for (uint64_t run = 0; run < 10; run++) {
        struct maneuver_scene scene = draw(&setting, run);
        for (size_t scan = MANEUVER_CLEAN_SCANS; scan < MANEUVER_SCANS; scan++) {
            check_look(&sums, &scene, scan);
        }
    }
    assert_near(sums.shares / (double)sums.plots, 0.5, 0.0112);
    assert_near(sums.along_m / (double)sums.plots, 0.0, 0.0192);
    for (int row = 0; row < 8; row++) {
        assert_near((double)sums.rows[row], 1580.0 / 8.0, 52.0);
    }
}

static void clutter_fills_the_beam_where_it_looks(void **state)
{
    (void)state;
    check_beam(MANEUVER_PLACES, MANEUVER_AT_PREDICTION);
    check_beam(MANEUVER_VELOCITIES, MANEUVER_AT_TRUTH);
    check_beam(MANEUVER_POLAR, MANEUVER_ALL_ROUND);
}

static void a_target_outside_the_beam_is_not_seen(void **state)
{
    (void)state;
    static const struct {
        enum maneuver_beam beam;
        double off_radii;
        bool is_seen;
    } looks[] = {{MANEUVER_AT_PREDICTION, 0.99, true},
                 {MANEUVER_AT_PREDICTION, 1.01, false},
                 {MANEUVER_ALL_ROUND, 1.01, true}};
    for (size_t i = 0; i < sizeof looks / sizeof looks[0]; i++) {
        struct maneuver_setting setting = cluttered(MANEUVER_PLACES, looks[i].beam);
        struct maneuver_scene scene = draw(&setting, 3);
        struct maneuver_look look;
        double centre_m[3];
        memcpy(centre_m, scene.truth[50], sizeof centre_m);
        centre_m[2] += looks[i].off_radii * scene.radius_m[50];
        maneuver_look_fill(&look, &scene, 50, centre_m, centre_m);
        assert_int_equal(look.target_row >= 0, looks[i].is_seen);
        assert_int_equal(look.scan.num_plots, 7 + looks[i].is_seen);
    }
}

/* All methods of a case see the same. */
static void clutter_does_not_depend_on_who_looks(void **state)
{
    (void)state;
    struct maneuver_setting setting = cluttered(MANEUVER_PLACES, MANEUVER_AT_PREDICTION);
    struct maneuver_scene scene = draw(&setting, 5);
    struct maneuver_look a, b;
    double other_m[3] = {scene.truth[70][0] + 64.0, scene.truth[70][1], scene.truth[70][2]};
    maneuver_look_fill(&a, &scene, 70, scene.truth[70], scene.truth[69]);
    maneuver_look_fill(&b, &scene, 70, other_m, scene.truth[69]);
    assert_int_equal(a.target_row, b.target_row);
    for (int row = 0; row < 8; row++) {
        double moved_m = row == a.target_row ? 0.0 : 64.0;
        assert_near((double)b.plots[row].x_m - (double)a.plots[row].x_m, moved_m, 0.01);
        assert_near((double)b.plots[row].y_m, (double)a.plots[row].y_m, 0.0);
    }
}

static void the_density_is_that_of_the_beam(void **state)
{
    (void)state;
    struct maneuver_setting setting = cluttered(MANEUVER_PLACES, MANEUVER_AT_PREDICTION);
    struct maneuver_scene scene = draw(&setting, 0);
    double r = scene.radius_m[9], ball = 4.0 / 3.0 * PI;
    assert_near(exp(maneuver_log_density(&scene, 9)) * ball * r * r * r, 7.0, 1e-6);
    setting.sensor = MANEUVER_VELOCITIES;
    assert_near(exp(maneuver_log_density(&scene, 9)) * ball * ball * pow(r, 6.0) * 64.0, 7.0, 1e-6);
    setting.sensor = MANEUVER_POLAR;
    assert_near(exp(maneuver_log_density(&scene, 9)) * PI * r * r, 7.0, 1e-6);
    setting.clutter = 0;
    assert_near(exp(maneuver_log_density(&scene, 9)) * PI * r * r, 0.1, 1e-6);
}

static void plots_say_their_noise(void **state)
{
    (void)state;
    struct maneuver_setting setting = cluttered(MANEUVER_VELOCITIES, MANEUVER_AT_TRUTH);
    struct maneuver_scene scene = draw(&setting, 0);
    struct rho_plot plot = maneuver_plot(&scene, 0);
    assert_near((double)plot.sigma_range_m, 10.0, 1e-6);
    assert_near((double)plot.sigma_up_m, 10.0, 1e-6);
    assert_near((double)plot.sigma_mps, 2.0, 1e-6);
    setting.truth = MANEUVER_LITERAL; /* the paper's P(0|0) */
    plot = maneuver_plot(&scene, 0);
    assert_near(pow((double)plot.sigma_cross_m, 2.0), 500.0, 1e-3);
    assert_near(pow((double)plot.sigma_mps, 2.0), 500.0, 1e-3);
    plot = maneuver_plot(&scene, 1);
    assert_near((double)plot.sigma_cross_m, 10.0, 1e-6);
    setting.sensor = MANEUVER_POLAR_3D;
    setting.sigma_rad = 3e-3;
    plot = maneuver_plot(&scene, 1);
    assert_near((double)plot.sigma_range_m, 10.0, 1e-6);
    assert_near((double)plot.sigma_cross_m, length(scene.measured[1]) * 3e-3, 1e-3);
    assert_near((double)plot.sigma_up_m, length(scene.measured[1]) * 3e-3, 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(profiles_pull_when_they_say),
        cmocka_unit_test(accelerations_have_their_size_and_direction),
        cmocka_unit_test(a_target_of_no_heading_weaves_to_plus_y),
        cmocka_unit_test(a_physical_popup_is_its_integral),
        cmocka_unit_test(a_literal_pull_is_late_in_place),
        cmocka_unit_test(a_weave_ends_on_its_heading_and_a_turn_turns),
        cmocka_unit_test(literal_noise_is_in_each_element),
        cmocka_unit_test(physical_noise_is_an_acceleration),
        cmocka_unit_test(targets_are_seen_as_often_as_they_should),
        cmocka_unit_test(polar_places_do_not_fall_short),
        cmocka_unit_test(polar_noise_has_its_covariance),
        cmocka_unit_test(a_polar_target_without_heights_stays_level),
        cmocka_unit_test(the_clean_scans_hold_the_target_alone),
        cmocka_unit_test(clutter_fills_the_beam_where_it_looks),
        cmocka_unit_test(a_target_outside_the_beam_is_not_seen),
        cmocka_unit_test(clutter_does_not_depend_on_who_looks),
        cmocka_unit_test(the_density_is_that_of_the_beam),
        cmocka_unit_test(plots_say_their_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
