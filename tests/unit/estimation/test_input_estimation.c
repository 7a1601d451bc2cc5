/* SPDX-License-Identifier: MIT */
/*
 * Input estimation and its decisions, compared with an augmented Kalman filter in double precision.
 */
#include "dense_filter_slope_measurement.h"
#include "input_estimation_reference.h"
#include "kalman_checks.h"

#include "rhotrack/detail/input_estimation.h"

#define STEPS 160

/*
 * Tolerance between the two-stage and the augmented filter, both in double precision; positions are
 * about 1e4.
 */
#define DOUBLE_RELATIVE 1e-9
#define POSITION_SIZE 1e4

/*
 * Tolerances of the library, in sigmas and relative to variances; largest seen: 1.1e-3 and 2e-5.
 * With noise along the line of sight, where inputs have one or two digits after many plots, 2.3e-2
 * and 4e-4 are seen.
 */
static const struct tolerance {
    double sigmas, variance;
} tight = {2e-3, 5e-5}, loose = {6e-2, 1e-3};

#define ROUNDING 5e-7
#define TOSS_UP 0.01 /* a decision this near to the threshold, in sigmas, may go either way */

/* --- a target and its plots ------------------------------------------------------------------ */

enum noise_kind { POSITION_VELOCITY, POSITION, POLAR };

struct scene {
    enum noise_kind kind;
    double sigma_m, sigma_cross_m; /* sigma_cross_m counts for POLAR alone */
    double input_mps2[3], from_s, to_s;
    double pd;
    struct ref_setting setting;
};

static const struct scene plain = {
    .kind = POSITION_VELOCITY,
    .sigma_m = 1.0,
    .sigma_cross_m = 1.0,
    .input_mps2 = {30.0, -60.0, 98.0},
    .from_s = 6.0,
    .to_s = 18.0,
    .pd = 1.0,
    .setting = {.dt = 0.25,
                .v0 = 500.0,
                .gamma = 1.0,
                .threshold = 1.96,
                .q_position = 1.0,
                .q_velocity = 1.0},
};

static void set_fixed_initial_truth(double truth[6])
{
    const double at[6] = {50e3, 35e3, 300.0, -600.0, -500.0, 0.0};

    memcpy(truth, at, sizeof at);
}

static void move_truth(double truth[6], const struct scene *scene, double t_s)
{
    const double dt = scene->setting.dt;
    const int is_on = t_s > scene->from_s && t_s <= scene->to_s;

    for (int axis = 0; axis < 3; ++axis) {
        const double input = is_on ? scene->input_mps2[axis] : 0.0;

        truth[axis] += dt * truth[axis + 3] + input * dt * dt / 2.0;
        truth[axis + 3] += dt * input;
    }
}

/* A measurement for the library and for the references: the same numbers, rounded to float. */
struct look {
    int num_elements; /* 6, 3, or 0 for a polar plot */
    float values[6], variance;
    struct rho_measurement seen;
    struct ref_measured reference;
};

static void measure_elements(struct look *look, const double truth[6], const struct scene *scene)
{
    look->num_elements = scene->kind == POSITION_VELOCITY ? 6 : 3;
    look->variance = (float)(scene->sigma_m * scene->sigma_m);
    look->reference.num = look->num_elements;
    for (int i = 0; i < look->num_elements; ++i) {
        look->values[i] = (float)(truth[i] + scene->sigma_m * normal());
        look->reference.rows[i][i] = 1.0;
        look->reference.values[i] = look->values[i];
        look->reference.r[i][i] = look->variance;
    }
}

/* The line of sight is that to the noisy plot, as in the library. */
static void measure_polar_plot(struct look *look, const double truth[6], const struct scene *scene)
{
    static const double origin[3] = {0.0, 0.0, 0.0};
    struct rho_plot plot = {.sigma_range_m = (float)scene->sigma_m,
                            .sigma_cross_m = (float)scene->sigma_cross_m,
                            .sigma_up_m = (float)(0.5 * scene->sigma_cross_m)};
    const double variance[3] = {pow(plot.sigma_range_m, 2), pow(plot.sigma_cross_m, 2),
                                pow(plot.sigma_up_m, 2)};
    const struct dense_place there = dense_place_of(origin, truth, 3, variance);
    double noise[3], at[3];
    double l[3][3] = {{0.0}};

    for (int i = 0; i < 3; ++i) {
        noise[i] = normal();
        at[i] = truth[i];
        for (int j = 0; j <= i; ++j) { /* Cholesky factor of the noise covariance */
            double rest = there.r[i][j];
            for (int k = 0; k < j; ++k) {
                rest -= l[i][k] * l[j][k];
            }
            l[i][j] = i == j ? sqrt(rest) : rest / l[j][j];
            at[i] += l[i][j] * noise[j];
        }
    }
    plot.x_m = (float)at[0];
    plot.y_m = (float)at[1];
    plot.z_m = (float)at[2];
    rho_measurement_from_plot(&plot, RHO_MEASURES_Z, NULL, &look->seen);
    const double seen_at[3] = {plot.x_m, plot.y_m, plot.z_m};
    const struct dense_place place = dense_place_of(origin, seen_at, 3, variance);
    look->reference.num = 3;
    for (int i = 0; i < 3; ++i) {
        look->reference.rows[i][i] = 1.0;
        look->reference.values[i] = seen_at[i];
        memcpy(look->reference.r[i], place.r[i], sizeof place.r[i]);
    }
}

static struct look measure(const double truth[6], const struct scene *scene)
{
    struct look look = {.num_elements = 0};

    if (scene->kind == POLAR) {
        measure_polar_plot(&look, truth, scene);
    } else {
        measure_elements(&look, truth, scene);
    }
    return look;
}

/* ---- library and augmented filter ----------------------------------------------------------- */

struct pair {
    struct rho_input_config config;
    struct rho_input input;
    struct ref_augmented augmented;
};

static struct rho_input_config config_of(const struct scene *scene)
{
    struct rho_input_config config;

    rho_input_config_default(&config);
    config.model = scene->setting.is_physical ? RHO_INPUT_PHYSICAL : RHO_INPUT_LITERAL;
    config.sigma_mps2 = (float)sqrt(scene->setting.v0);
    config.gamma = (float)scene->setting.gamma;
    config.threshold = (float)scene->setting.threshold;
    config.noise_density = (float)scene->setting.density;
    config.noise_m = (float)sqrt(scene->setting.q_position);
    config.noise_mps = (float)sqrt(scene->setting.q_velocity);
    return config;
}

static struct pair start_pair_at_true_state(const struct scene *scene, const double truth[6])
{
    struct pair pair = {.config = config_of(scene)};
    struct rho_kalman kalman = opened_filter(3, 500.0f, 500.0f);

    for (int i = 0; i < STATES; ++i) {
        kalman.state[i] = (float)truth[i];
    }
    assert_int_equal(rho_input_start(&pair.input, &pair.config, &kalman), RHO_OK);
    ref_augmented_start(&pair.augmented, truth, 500.0, 500.0, scene->setting.v0);
    return pair;
}

static void update_input(struct pair *pair, const struct look *look)
{
    if (look->num_elements == 0) {
        assert_int_equal(rho_input_update_position(&pair->input, &pair->config, &look->seen),
                         RHO_OK);
    }
    for (int i = 0; i < look->num_elements; ++i) {
        assert_int_equal(rho_input_update_element(&pair->input, &pair->config, i, look->values[i],
                                                  look->variance),
                         RHO_OK);
    }
}

static struct tolerance tolerance_of(const struct scene *scene)
{
    return scene->kind == POLAR ? loose : tight;
}

static void assert_estimate_near_reference(const struct rho_kalman *estimate,
                                           const struct ref_augmented *augmented,
                                           struct tolerance may_be)
{
    for (int i = 0; i < STATES; ++i) {
        const double sigma = sqrt(augmented->p[i][i]);

        assert_float_equal(estimate->state[i], augmented->x[i],
                           may_be.sigmas * sigma + ROUNDING * fabs(augmented->x[i]));
        for (int j = 0; j <= i; ++j) {
            assert_float_equal(estimate->covariance[RHO_AT(i, j)], augmented->p[i][j],
                               may_be.variance * sigma * sqrt(augmented->p[j][j]));
        }
    }
    assert_true(is_positive_definite(estimate));
}

static void assert_inputs_near_reference(const struct rho_input *input,
                                         const struct ref_augmented *augmented,
                                         struct tolerance may_be)
{
    for (int a = 0; a < 3; ++a) {
        const double sigma = sqrt(augmented->p[6 + a][6 + a]);

        assert_float_equal(input->input_mps2[a], augmented->x[6 + a],
                           may_be.sigmas * sigma + ROUNDING * fabs(augmented->x[6 + a]));
        for (int b = 0; b <= a; ++b) {
            assert_float_equal(input->variance[RHO_AT(a, b)], augmented->p[6 + a][6 + b],
                               may_be.variance * sigma * sqrt(augmented->p[6 + b][6 + b]));
        }
    }
}

static void predict_pair_and_assert_agreement(struct pair *pair, const struct scene *scene)
{
    struct rho_kalman estimate;

    assert_int_equal(rho_input_predict(&pair->input, &pair->config, (float)scene->setting.dt),
                     RHO_OK);
    ref_augmented_predict(&pair->augmented, &scene->setting);
    rho_input_gate_estimate(&pair->input, &estimate);
    assert_estimate_near_reference(&estimate, &pair->augmented, tolerance_of(scene));
}

/* Returns 0 if the decisions differ and the reference's was a toss-up. */
static int decide_pair_and_return_agreement(struct pair *pair, const struct scene *scene)
{
    const double margin =
        ref_augmented_drop_inputs_and_margin_sigmas(&pair->augmented, &scene->setting);
    struct rho_kalman estimate;

    rho_input_decide(&pair->input, &pair->config);
    if (margin < TOSS_UP && (int)pair->input.present != pair->augmented.present) {
        return 0;
    }
    assert_int_equal(pair->input.present, pair->augmented.present);
    rho_input_estimate(&pair->input, &estimate);
    assert_estimate_near_reference(&estimate, &pair->augmented, tolerance_of(scene));
    assert_inputs_near_reference(&pair->input, &pair->augmented, tolerance_of(scene));
    return 1;
}

struct tally {
    int onsets, stops, steps;
};

/* Runs until the end, or until a toss-up is decided differently. */
static void compare_run(const struct scene *scene, struct tally *tally)
{
    double truth[6];

    set_fixed_initial_truth(truth);
    struct pair pair = start_pair_at_true_state(scene, truth);
    for (int k = 1; k <= STEPS; ++k) {
        const int before = pair.augmented.present;

        move_truth(truth, scene, scene->setting.dt * k);
        predict_pair_and_assert_agreement(&pair, scene);
        const struct look look = measure(truth, scene);
        const double chance = uniform(0.0, 1.0);
        if (chance >= scene->pd) {
            continue;
        }
        update_input(&pair, &look);
        ref_augmented_update(&pair.augmented, &look.reference);
        if (!decide_pair_and_return_agreement(&pair, scene)) {
            return;
        }
        tally->onsets += (pair.augmented.present & ~before) != 0;
        tally->stops += (before & ~pair.augmented.present) != 0;
        tally->steps++;
    }
}

/* ---- two-stage and augmented filter --------------------------------------------------------- */

static void assert_two_stage_equals_augmented(const struct ref_two_stage *t,
                                              const struct ref_augmented *a)
{
    double x[6], p[6][6];

    ref_two_stage_correct(t, x, p);
    for (int i = 0; i < 6; ++i) {
        assert_float_equal(x[i], a->x[i], DOUBLE_RELATIVE * POSITION_SIZE);
        for (int j = 0; j < 6; ++j) {
            assert_float_equal(p[i][j], a->p[i][j],
                               DOUBLE_RELATIVE * fmax(1.0, sqrt(a->p[i][i] * a->p[j][j])));
        }
    }
    for (int i = 0; i < 3; ++i) {
        assert_float_equal(t->u[i], a->x[6 + i], DOUBLE_RELATIVE * fmax(1.0, fabs(a->x[6 + i])));
        for (int j = 0; j < 3; ++j) {
            assert_float_equal(t->v[i][j], a->p[6 + i][6 + j],
                               DOUBLE_RELATIVE *
                                   fmax(1.0, sqrt(a->p[6 + i][6 + i] * a->p[6 + j][6 + j])));
        }
    }
}

static void compare_two_stage_with_augmented(const struct scene *scene)
{
    double truth[6];
    struct ref_two_stage stages;
    struct ref_augmented augmented;

    set_fixed_initial_truth(truth);
    ref_two_stage_start(&stages, truth, 500.0, 500.0, scene->setting.v0);
    ref_augmented_start(&augmented, truth, 500.0, 500.0, scene->setting.v0);
    for (int k = 1; k <= STEPS; ++k) {
        move_truth(truth, scene, scene->setting.dt * k);
        ref_two_stage_predict(&stages, &scene->setting);
        ref_augmented_predict(&augmented, &scene->setting);
        const struct look look = measure(truth, scene);
        ref_two_stage_update(&stages, &look.reference);
        ref_augmented_update(&augmented, &look.reference);
        assert_two_stage_equals_augmented(&stages, &augmented);
    }
}

static void the_papers_two_stage_filter_equals_an_augmented_filter(void **state)
{
    (void)state;
    for (int kind = POSITION_VELOCITY; kind <= POLAR; ++kind) {
        for (int is_physical = kind != POSITION_VELOCITY; is_physical <= 1; ++is_physical) {
            struct scene scene = plain;

            scene.kind = (enum noise_kind)kind;
            scene.setting.is_physical = is_physical;
            scene.sigma_m = kind == POSITION_VELOCITY ? 1.0 : 10.0;
            scene.sigma_cross_m = 150.0;
            compare_two_stage_with_augmented(&scene);
        }
    }
}

/*
 * A threshold of nearly 0 makes every input significant, so that there are no decisions to differ.
 */
static void the_library_agrees_with_the_augmented_filter(void **state)
{
    (void)state;
    for (int kind = POSITION_VELOCITY; kind <= POLAR; ++kind) {
        for (int is_physical = kind != POSITION_VELOCITY; is_physical <= 1; ++is_physical) {
            struct scene scene = plain;
            double truth[6];

            scene.kind = (enum noise_kind)kind;
            scene.setting.is_physical = is_physical;
            scene.setting.threshold = 1e-12;
            scene.sigma_m = kind == POSITION_VELOCITY ? 1.0 : 10.0;
            scene.sigma_cross_m = 150.0;
            set_fixed_initial_truth(truth);
            struct pair pair = start_pair_at_true_state(&scene, truth);
            for (int k = 1; k <= STEPS; ++k) {
                struct rho_kalman estimate;

                move_truth(truth, &scene, scene.setting.dt * k);
                predict_pair_and_assert_agreement(&pair, &scene);
                const struct look look = measure(truth, &scene);
                update_input(&pair, &look);
                ref_augmented_update(&pair.augmented, &look.reference);
                rho_input_decide(&pair.input, &pair.config);
                assert_int_equal(pair.input.present, 7);
                pair.augmented.present = 7;
                rho_input_estimate(&pair.input, &estimate);
                assert_estimate_near_reference(&estimate, &pair.augmented, tolerance_of(&scene));
                assert_inputs_near_reference(&pair.input, &pair.augmented, tolerance_of(&scene));
            }
        }
    }
}

/* --- decisions ------------------------------------------------------------------------------- */

static void compare_runs(const struct scene *scene, int runs, struct tally least)
{
    struct tally tally = {0, 0, 0};

    for (int n = 0; n < runs; ++n) {
        compare_run(scene, &tally);
    }
    assert_true(tally.onsets >= least.onsets);
    assert_true(tally.stops >= least.stops);
    assert_true(tally.steps >= least.steps);
}

static void decisions_agree_with_measured_velocities(void **state)
{
    (void)state;
    for (int n = 0; n < 4; ++n) {
        struct scene scene = plain;

        scene.setting.is_physical = n % 2;
        scene.setting.gamma = n / 2 ? 0.5 : 1.0;
        compare_runs(&scene, 20, (struct tally){20, n / 2 ? 60 : 5, 3000});
    }
}

static void decisions_agree_with_positions_alone_and_misses(void **state)
{
    struct scene scene = plain;

    (void)state;
    scene.kind = POSITION;
    scene.sigma_m = 10.0;
    scene.pd = 0.8;
    scene.setting.is_physical = 1;
    scene.setting.gamma = 0.9;
    scene.setting.v0 = 1e4;
    scene.setting.q_position = 0.0;
    scene.setting.q_velocity = 0.0;
    scene.setting.density = 20.0;
    compare_runs(&scene, 20, (struct tally){20, 30, 2000});
}

/* Noise along the line of sight couples the axes and so the inputs and their decisions. */
static void decisions_agree_with_noise_along_the_line_of_sight(void **state)
{
    struct scene scene = plain;

    (void)state;
    scene.kind = POLAR;
    scene.sigma_m = 15.0;
    scene.sigma_cross_m = 120.0;
    scene.pd = 0.9;
    scene.setting.dt = 1.0;
    scene.setting.is_physical = 1;
    scene.setting.v0 = 1e4;
    scene.setting.density = 5.0;
    scene.to_s = 60.0;
    for (int n = 0; n < 2; ++n) {
        scene.setting.gamma = n ? 0.8 : 1.0;
        compare_runs(&scene, 20, (struct tally){30, n ? 50 : 1, 2000});
    }
}

/* ---- measurements that are linearised -------------------------------------------------------- */

/* A pair after ten seconds, in the last four of which all axes have inputs. */
static struct pair manoeuvring_pair(const struct scene *scene, double truth[6])
{
    set_fixed_initial_truth(truth);
    struct pair pair = start_pair_at_true_state(scene, truth);
    for (int k = 1; k <= 40; ++k) {
        move_truth(truth, scene, scene->setting.dt * k);
        predict_pair_and_assert_agreement(&pair, scene);
        const struct look look = measure(truth, scene);
        update_input(&pair, &look);
        ref_augmented_update(&pair.augmented, &look.reference);
        assert_true(decide_pair_and_return_agreement(&pair, scene));
    }
    assert_int_equal(pair.input.present, 7);
    return pair;
}

static struct dense estimate_of_augmented(const struct ref_augmented *augmented)
{
    struct dense d;

    for (int i = 0; i < 6; ++i) {
        d.x[i] = augmented->x[i];
        memcpy(d.p[i], augmented->p[i], sizeof d.p[i]);
    }
    return d;
}

/* Updates the augmented filter by one row, linearised at its estimate. */
static void update_by_row(struct ref_augmented *augmented, const struct dense_measurement *m)
{
    struct ref_measured z = {.num = 1, .values = {m->y[0]}, .r = {{m->r[0][0]}}};

    for (int i = 0; i < 6; ++i) {
        z.rows[0][i] = m->h[0][i];
        z.values[0] += m->h[0][i] * augmented->x[i];
    }
    ref_augmented_update(augmented, &z);
}

static void assert_pair_agrees(const struct pair *pair)
{
    struct rho_kalman estimate;

    rho_input_estimate(&pair->input, &estimate);
    assert_estimate_near_reference(&estimate, &pair->augmented, loose);
    assert_inputs_near_reference(&pair->input, &pair->augmented, loose);
}

static void range_rates_are_linearised_at_the_corrected_estimate(void **state)
{
    const struct rho_sensor sensor = {.x_m = 42000.0f, .y_m = 28000.0f, .z_m = 100.0f};
    const double from[3] = {42000.0, 28000.0, 100.0};
    double truth[6];

    (void)state;
    for (int is_physical = 0; is_physical <= 1; ++is_physical) {
        struct scene scene = plain;

        scene.setting.is_physical = is_physical;
        struct pair pair = manoeuvring_pair(&scene, truth);
        const struct dense before = estimate_of_augmented(&pair.augmented);
        const struct dense_measurement m = dense_range_rate(&before, from, 3, -760.0, 0.25);
        update_by_row(&pair.augmented, &m);
        assert_int_equal(
            rho_input_update_range_rate(&pair.input, &pair.config, &sensor, -760.0f, 0.25f),
            RHO_OK);
        assert_pair_agrees(&pair);
    }
}

/*
 * A bearing in metres across the line of sight; the linearisation error has the variance (var a var
 * c + cov^2) / range^2 for errors a along and c across.
 */
static struct dense_measurement bearing_row(const struct dense *d, double x, double y,
                                            double bearing, double sigma)
{
    struct dense_measurement m = {.num_rows = 1};
    const double dx = d->x[0] - x, dy = d->x[1] - y, range = hypot(dx, dy);
    const double a[2] = {dx / range, dy / range}, c[2] = {-dy / range, dx / range};
    double aa = 0.0, ac = 0.0, cc = 0.0;

    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            aa += a[i] * d->p[i][j] * a[j];
            ac += a[i] * d->p[i][j] * c[j];
            cc += c[i] * d->p[i][j] * c[j];
        }
        m.h[0][i] = c[i];
    }
    m.y[0] = range * (bearing - atan2(dy, dx));
    m.r[0][0] = pow(sigma * range, 2) + (aa * cc + ac * ac) / (range * range);
    return m;
}

static void bearings_are_linearised_at_the_corrected_estimate(void **state)
{
    struct scene scene = plain;
    double truth[6];

    (void)state;
    scene.setting.is_physical = 1;
    struct pair pair = manoeuvring_pair(&scene, truth);
    const struct dense before = estimate_of_augmented(&pair.augmented);
    const float bearing = (float)atan2(truth[1] - 30e3, truth[0] - 45e3) + 1e-4f;
    const struct dense_measurement m = bearing_row(&before, 45e3, 30e3, bearing, 1e-4f);
    update_by_row(&pair.augmented, &m);
    assert_int_equal(
        rho_input_update_bearing(&pair.input, &pair.config, 45e3f, 30e3f, bearing, 1e-4f), RHO_OK);
    assert_pair_agrees(&pair);
}

static void slopes_are_linearised_at_the_corrected_estimate(void **state)
{
    double truth[6];

    (void)state;
    for (int is_physical = 0; is_physical <= 1; ++is_physical) {
        struct scene scene = plain;

        scene.setting.is_physical = is_physical;
        struct pair pair = manoeuvring_pair(&scene, truth);
        const struct dense before = estimate_of_augmented(&pair.augmented);
        const double range = hypot(truth[0] - 45e3, truth[1] - 30e3);
        const struct rho_slope slope = {.x_m = 45e3f,
                                        .y_m = 30e3f,
                                        .z_m = 20.0f,
                                        .value = (float)((truth[2] - 20.0) / range + 3e-4),
                                        .sigma = 2e-4f};
        const struct dense_measurement m = dense_slope(&before, &slope);
        update_by_row(&pair.augmented, &m);
        assert_int_equal(rho_input_update_slope(&pair.input, &pair.config, &slope), RHO_OK);
        assert_pair_agrees(&pair);
    }
}

/* Inputs of x and y are present; the height is that of the line to the corrected place. */
static void a_first_slope_opens_a_height_of_the_corrected_estimate(void **state)
{
    const struct rho_slope slope = {.x_m = 45e3f, .y_m = 30e3f, .value = 0.3f, .sigma = 0.01f};
    struct rho_input_config config = config_of(&plain);
    struct rho_kalman kalman = opened_filter(2, 500.0f, 500.0f), corrected, seen;
    double truth[6];
    struct rho_input input;

    (void)state;
    set_fixed_initial_truth(truth);
    for (int i = 0; i < STATES; ++i) {
        kalman.state[i] = i % 3 < 2 ? (float)truth[i] : 0.0f;
    }
    config.model = RHO_INPUT_PHYSICAL;
    assert_int_equal(rho_input_start(&input, &config, &kalman), RHO_OK);
    for (int k = 1; k <= 40; ++k) {
        move_truth(truth, &plain, plain.setting.dt * k);
        assert_int_equal(rho_input_predict(&input, &config, (float)plain.setting.dt), RHO_OK);
        for (int axis = 0; axis < 2; ++axis) {
            const float value = (float)(truth[axis] + normal());
            assert_int_equal(rho_input_update_element(&input, &config, axis, value, 1.0f), RHO_OK);
        }
        rho_input_decide(&input, &config);
    }
    assert_true(input.present != 0);
    rho_input_estimate(&input, &corrected);
    const struct dense before = dense_of(corrected.state, corrected.covariance);
    const struct dense_measurement m = dense_slope(&before, &slope);
    const double variance = dense_innovation_variance(&before, &m);
    assert_int_equal(rho_input_update_slope(&input, &config, &slope), RHO_OK);
    rho_input_estimate(&input, &seen);
    assert_true(rho_kalman_has_axis(&seen, 2));
    assert_float_equal(seen.state[2], m.y[0], 0.1 * sqrt(variance));
    assert_float_equal(seen.covariance[RHO_AT(2, 2)], variance, 0.02 * variance);
    assert_float_equal(seen.covariance[RHO_AT(5, 5)], config.velocity_variance, 1.0);
}

static void slopes_that_are_not_measured_change_nothing(void **state)
{
    double truth[6];

    (void)state;
    struct pair pair = manoeuvring_pair(&plain, truth);
    const struct rho_input before = pair.input;
    struct rho_slope slope = {.x_m = 45e3f, .y_m = 30e3f, .value = 0.3f};
    assert_int_equal(rho_input_update_slope(&pair.input, &pair.config, &slope), RHO_OK);
    assert_memory_equal(&pair.input, &before, sizeof before);
    struct rho_kalman corrected;
    rho_input_estimate(&pair.input, &corrected);
    slope = (struct rho_slope){
        .x_m = corrected.state[0], .y_m = corrected.state[1], .value = 0.3f, .sigma = 0.01f};
    assert_int_equal(rho_input_update_slope(&pair.input, &pair.config, &slope), RHO_OK);
    assert_memory_equal(&pair.input, &before, sizeof before);
}

/* In a manoeuvre the bare filter is kilometres off; the height is that at the corrected range. */
static void a_first_slope_in_a_manoeuvre_has_the_corrected_range(void **state)
{
    const struct rho_slope slope = {.value = 0.3f, .sigma = 1e-3f};
    struct rho_kalman kalman = opened_filter(2, 500.0f, 500.0f), corrected;
    double at[2] = {30000.0, 20000.0}, v[2] = {-200.0, -150.0};
    struct rho_input_config config;
    struct rho_input input;

    (void)state;
    rho_input_config_default(&config);
    config.model = RHO_INPUT_PHYSICAL;
    config.sigma_mps2 = 20.0f;
    config.noise_density = 1.0f;
    config.noise_m = config.noise_mps = 0.0f;
    for (int i = 0; i < 2; ++i) {
        kalman.state[i] = (float)at[i];
        kalman.state[i + 3] = (float)v[i];
    }
    assert_int_equal(rho_input_start(&input, &config, &kalman), RHO_OK);
    for (int k = 0; k < 15; ++k) {
        assert_int_equal(rho_input_predict(&input, &config, 2.0f), RHO_OK);
        for (int i = 0; i < 2; ++i) {
            const double input_mps2 = k > 8 ? 30.0 : 0.0;
            at[i] += 2.0 * v[i] + 2.0 * input_mps2;
            v[i] += 2.0 * input_mps2;
            assert_int_equal(rho_input_update_element(&input, &config, i,
                                                      (float)(at[i] + 50.0 * normal()), 2500.0f),
                             RHO_OK);
        }
        rho_input_decide(&input, &config);
    }
    assert_int_equal(input.present, 3);
    assert_int_equal(rho_input_update_slope(&input, &config, &slope), RHO_OK);
    rho_input_estimate(&input, &corrected);
    print_message("height %.0f, true %.0f, sigma %.0f\n", (double)corrected.state[2],
                  0.3 * hypot(at[0], at[1]), sqrt((double)corrected.covariance[RHO_AT(2, 2)]));
    assert_float_equal(corrected.state[2],
                       0.3 * hypot((double)corrected.state[0], (double)corrected.state[1]), 5.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_papers_two_stage_filter_equals_an_augmented_filter),
        cmocka_unit_test(the_library_agrees_with_the_augmented_filter),
        cmocka_unit_test(decisions_agree_with_measured_velocities),
        cmocka_unit_test(decisions_agree_with_positions_alone_and_misses),
        cmocka_unit_test(decisions_agree_with_noise_along_the_line_of_sight),
        cmocka_unit_test(range_rates_are_linearised_at_the_corrected_estimate),
        cmocka_unit_test(bearings_are_linearised_at_the_corrected_estimate),
        cmocka_unit_test(slopes_are_linearised_at_the_corrected_estimate),
        cmocka_unit_test(a_first_slope_opens_a_height_of_the_corrected_estimate),
        cmocka_unit_test(slopes_that_are_not_measured_change_nothing),
        cmocka_unit_test(a_first_slope_in_a_manoeuvre_has_the_corrected_range),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
