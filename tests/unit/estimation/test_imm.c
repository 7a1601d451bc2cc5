/* SPDX-License-Identifier: MIT */
/*
 * The interacting multiple model filter, compared with full matrices in double precision
 * (imm_reference.h).
 */
#include <float.h>
#include <string.h>

#include "dense_filter.h"
#include "imm_reference.h"
#include "one_bearing.h"

#define NUM(array) (sizeof(array) / sizeof((array)[0]))

static struct rho_imm_model random_model(void)
{
    struct rho_imm_model model;

    rho_imm_model_default(&model, (float)pow(10.0, uniform(0.0, 2.2)),
                          (float)pow(10.0, uniform(1.5, 3.0)));
    return model;
}

/* ---- steps ---------------------------------------------------------------------------------- */

/*
 * Tolerances of step coefficients for 1 ms to 10^4 s and memories of 0.5 to 1000 s, in brackets the
 * largest errors seen; noise is relative to products of sigmas.
 */
#define RESPONSE_RELATIVE 1.5e-6 /* (5.2e-7) */
#define NOISE_RELATIVE 2.5e-6    /* (7.7e-7) */
#define CHANGE_ABSOLUTE 2e-7     /* (8e-8) */
#define BACK_RELATIVE 4e-6       /* (1.8e-6) */

static struct rho_imm_model model_with_memory(double memory_s)
{
    return (struct rho_imm_model){.quiet_density = 2.0f,
                                  .drive_density = 50.0f,
                                  .memory_s = (float)memory_s,
                                  .steady_s = 8.0f,
                                  .maneuver_s = 8.0f,
                                  .speed_sigma_mps = 300.0f,
                                  .accel_sigma_mps2 = 100.0f};
}

static void steps_agree_with_singers_model_and_the_markov_chain(void **state)
{
    double worst_response = 0.0, worst_noise = 0.0, worst_change = 0.0;

    (void)state;
    for (int n = 0; n < 1500; ++n) {
        struct rho_imm_model model = model_with_memory(0.5 * pow(10.0, uniform(0.0, 3.301)));
        const float dt_s = (float)pow(10.0, uniform(-3.0, 4.0));
        model.steady_s = (float)pow(10.0, uniform(0.0, 3.0));
        if (n % 3) {
            model.calm_density = 0.02f;
            model.calm_s = (float)pow(10.0, uniform(0.0, 4.0));
            model.settle_s = (float)pow(10.0, uniform(0.0, 3.0));
        }
        double response[3], q[3][3];
        struct rho_imm_step step;

        rho_imm_prepare_step(&step, &model, dt_s);
        singer_response(dt_s, model.memory_s, response);
        singer_noise(dt_s, model.memory_s, q);
        worst_response = fmax(worst_response, fabs(step.position_by_accel / response[0] - 1.0));
        worst_response = fmax(worst_response, fabs(step.velocity_by_accel / response[1] - 1.0));
        worst_response = fmax(worst_response, fabs(step.accel_by_accel - response[2]));
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j <= i; ++j) {
                const double scale = model.drive_density * sqrt(q[i][i] * q[j][j]);

                worst_noise =
                    fmax(worst_noise,
                         fabs(step.noise[RHO_AT(i, j)] - model.drive_density * q[i][j]) / scale);
            }
        }
        const double begins = 1.0 / model.steady_s, ends = 1.0 / model.maneuver_s;
        const double moved = -expm1(-dt_s * (begins + ends)) / (begins + ends);
        worst_change = fmax(worst_change, fabs(step.begins - begins * moved));
        worst_change = fmax(worst_change, fabs(step.ends - ends * moved));
        const double calm_s =
            /* calm targets manoeuvre no sooner than agile ones */
            fmax(model.calm_s, model.steady_s);
        const double calm_begins = n % 3 ? fmin(-expm1(-dt_s / calm_s), begins * moved) : 0.0;
        worst_change = fmax(worst_change, fabs(step.calm_begins - calm_begins));
        assert_true(step.calm_begins <= step.begins);
        worst_change =
            fmax(worst_change, fabs(step.settles - (n % 3 ? -expm1(-dt_s / model.settle_s) : 0.0)));
        assert_true((step.odds_over > 0.0f) == (n % 3 != 0));
        assert_true(step.quiet_density == model.quiet_density &&
                    step.calm_density == model.calm_density);
        assert_true(step.dt_s == dt_s);
        for (int i = 0; i < 3; ++i) { /* dt^3/3, dt^2/2, dt: white noise of density 1 */
            const double quiet = pow(dt_s, 3 - i) / (3 - i);
            assert_float_equal(step.quiet_noise[i], quiet, 1e-6 * quiet);
        }
        assert_true(step.begins >= 0.0f && step.ends >= 0.0f &&
                    step.begins + step.ends <= 1.0f + 2e-7f);
    }
    assert_true(worst_response <= RESPONSE_RELATIVE);
    assert_true(worst_noise <= NOISE_RELATIVE);
    assert_true(worst_change <= CHANGE_ABSOLUTE);
}

/* Compared with F2 F1 and F2 Q1 F2^T + Q2 of two steps. */
static void two_short_steps_equal_one_long_step(void **state)
{
    double worst_response = 0.0, worst_noise = 0.0;

    (void)state;
    for (int n = 0; n < 5000; ++n) {
        const struct rho_imm_model model = model_with_memory(0.5 * pow(10.0, uniform(0.0, 3.301)));
        const float first_s = (float)(model.memory_s * pow(10.0, uniform(-3.0, 1.5)));
        const float second_s = (float)(first_s * pow(10.0, uniform(-1.0, 1.0)));
        struct rho_imm_step a, b, both;

        rho_imm_prepare_step(&a, &model, first_s);
        rho_imm_prepare_step(&b, &model, second_s);
        rho_imm_prepare_step(&both, &model, first_s + second_s);
        const double f[3][3] = {{1.0, second_s, b.position_by_accel},
                                {0.0, 1.0, b.velocity_by_accel},
                                {0.0, 0.0, b.accel_by_accel}};
        const double response[3] = {a.position_by_accel, a.velocity_by_accel, a.accel_by_accel};
        const float expected[3] = {both.position_by_accel, both.velocity_by_accel,
                                   both.accel_by_accel};
        double q[3][3];

        for (int i = 0; i < 3; ++i) {
            double sum = 0.0;

            for (int j = 0; j < 3; ++j) {
                sum += f[i][j] * response[j];
                q[i][j] = b.noise[RHO_AT(i, j)];
                for (int k = 0; k < 9; ++k) {
                    q[i][j] += f[i][k / 3] * a.noise[RHO_AT(k / 3, k % 3)] * f[j][k % 3];
                }
            }
            worst_response = fmax(worst_response,
                                  fabs(sum - expected[i]) / fmax(expected[i], i == 2 ? 1.0 : 0.0));
        }
        for (int i = 0; i < 9; ++i) {
            const double scale = sqrt(q[i / 3][i / 3] * q[i % 3][i % 3]);

            worst_noise =
                fmax(worst_noise, fabs(q[i / 3][i % 3] - both.noise[RHO_AT(i / 3, i % 3)]) / scale);
        }
        const double begins = a.begins * (1.0 - b.ends) + (1.0 - a.begins) * b.begins;
        const double ends = a.ends * (1.0 - b.begins) + (1.0 - a.ends) * b.ends;
        assert_float_equal(both.begins, begins, 4e-7);
        assert_float_equal(both.ends, ends, 4e-7);
    }
    assert_true(worst_response <= RESPONSE_RELATIVE);
    assert_true(worst_noise <= NOISE_RELATIVE);
}

static void a_step_backwards_is_the_inverse_without_noise(void **state)
{
    double worst = 0.0;

    (void)state;
    for (int n = 0; n < 5000; ++n) {
        struct rho_imm_model model = model_with_memory(0.5 * pow(10.0, uniform(0.0, 3.301)));
        const float dt_s = (float)(model.memory_s * pow(10.0, uniform(-4.0, 0.7)));
        model.calm_s = model.settle_s = n % 2 ? 100.0f : 0.0f;
        struct rho_imm_step forth, back;

        rho_imm_prepare_step(&forth, &model, dt_s);
        rho_imm_prepare_step(&back, &model, -dt_s);
        const double f = forth.position_by_accel, g = forth.velocity_by_accel;
        const double h = forth.accel_by_accel;
        /* expected: acceleration 1 / h, velocity -g / h, position (g dt - f) / h */
        worst = fmax(worst, fabs(back.accel_by_accel * h - 1.0));
        worst = fmax(worst, fabs(back.velocity_by_accel * h / g + 1.0));
        worst = fmax(worst, fabs(back.position_by_accel * h / (g * dt_s - f) - 1.0));
        for (int i = 0; i < 6; ++i) {
            assert_true(back.noise[i] == 0.0f);
        }
        for (int i = 0; i < 3; ++i) {
            assert_true(back.quiet_noise[i] == 0.0f);
        }
        assert_true(back.begins == 0.0f && back.ends == 0.0f && back.dt_s == -dt_s);
        assert_true(back.calm_begins == 0.0f && back.settles == 0.0f);
    }
    assert_true(worst <= BACK_RELATIVE);
}

static void a_step_of_no_time_changes_nothing(void **state)
{
    struct rho_imm_model model = model_with_memory(3.0);
    struct rho_imm_step step;

    (void)state;
    model.calm_s = model.settle_s = 100.0f;
    rho_imm_prepare_step(&step, &model, 0.0f);
    assert_true(step.dt_s == 0.0f && step.begins == 0.0f && step.ends == 0.0f &&
                step.position_by_accel == 0.0f);
    assert_true(step.calm_begins == 0.0f && step.settles == 0.0f);
    assert_true(step.velocity_by_accel == 0.0f && step.accel_by_accel == 1.0f);
    for (int i = 0; i < 6; ++i) {
        assert_true(step.noise[i] == 0.0f);
    }
}

/* ---- sequences of plots --------------------------------------------------------------------- */

struct course {
    const char *name;
    uint32_t measures;
    int num_axes; /* of the first estimate */
    /* share of scans that measure heights, too; the first height opens the axis */
    double share_of_z;
    double own_share;      /* share of plots with different noise along, across and up */
    double dt_min, dt_max; /* smallest and largest interval, s */
    double offset_s;       /* plots' own times differ from the scan's by up to this, either way */
    double bearing_share;  /* share of scans that have a bearing instead of a plot */
    double violence;       /* factor on the target's acceleration; sigmas are divided by it */
    int has_two_states;    /* there are no calm targets */
    struct reference_worst by_step, by_mean;
};

/*
 * Bounds are twice the largest errors of thirty times as many sequences, with gcc and clang. After
 * one step errors are of float rounding. The mean of a whole sequence is as near, but for courses
 * in which a first height left its speed unknown: each update raises that variance, 10^6 m^2/s^2,
 * by 2^-20 of itself, and the next height removes nearly all of it. Rounding lasts longer in the
 * steady filter of calm targets, whose memory is longer.
 */
#define CALM_BY_STEP 6e-6
#define CALM_BY_RATE 5e-3 /* the square of an innovation that is a difference of range rates */
#define CALM_BY_MEAN 0.15

static const struct course courses[] = {
    {.name = "level",
     .num_axes = 2,
     .dt_min = 0.25,
     .dt_max = 0.25,
     .by_step = {2e-6, 2e-5, 2e-6, 3e-6, 7e-6, 0.0},
     .by_mean = {2e-2, 2e-2, 9e-3, 2e-2, 0.0, 0.0}},
    {.name = "in space",
     .num_axes = 3,
     .measures = RHO_MEASURES_Z,
     .dt_min = 0.25,
     .dt_max = 0.25,
     .by_step = {2e-6, 2e-5, 8e-7, 5e-6, 1e-5, 0.0},
     .by_mean = {2e-2, 2e-2, 6e-3, 2e-2, 0.0, 0.0}},
    {.name = "any interval",
     .num_axes = 3,
     .measures = RHO_MEASURES_Z,
     .dt_min = 0.05,
     .dt_max = 20.0,
     .by_step = {3e-5, 6e-5, 8e-7, 2e-5, 9e-6, 0.0},
     .by_mean = {8e-2, 2e-1, 1e-2, 3e-1, 0.0, 0.0}},
    {.name = "velocities",
     .num_axes = 2,
     .measures = RHO_MEASURES_VELOCITY,
     .dt_min = 0.1,
     .dt_max = 4.0,
     .by_step = {3e-4, 2e-4, 2e-5, 7e-5, 2e-4, 0.0},
     .by_mean = {7e-3, 1.2e-2, 6e-3, 2e-2, 0.0, 0.0}},
    {.name = "velocities in space",
     .num_axes = 3,
     .measures = RHO_MEASURES_Z | RHO_MEASURES_VELOCITY,
     .dt_min = 0.1,
     .dt_max = 4.0,
     .by_step = {7e-4, 2e-4, 7e-4, 7e-4, 3e-4, 0.0},
     .by_mean = {1e-2, 2e-2, 7e-3, 2e-2, 0.0, 0.0}},
    {.name = "heights later",
     .num_axes = 2,
     .share_of_z = 0.1,
     .dt_min = 0.1,
     .dt_max = 4.0,
     .by_step = {2e-5, 2e-5, 9e-7, 6e-6, 1e-5, 0.0},
     .by_mean = {8e-1, 6e0, 2e-1, 2e0, 0.0, 0.0}},
    {.name = "own times",
     .num_axes = 2,
     .share_of_z = 0.2,
     .dt_min = 1.0,
     .dt_max = 4.0,
     .offset_s = 0.5,
     .by_step = {8e-6, 1e-5, 9e-7, 6e-6, 7e-6, 0.0},
     .by_mean = {2e0, 8e0, 4e-1, 2e0, 0.0, 0.0}},
    {.name = "violent",
     .num_axes = 3,
     .measures = RHO_MEASURES_Z,
     .dt_min = 0.1,
     .dt_max = 0.6,
     .violence = 6.0,
     .by_step = {3e-5, 1e-4, 4e-6, 9e-6, 2e-5, 0.0},
     .by_mean = {2e0, 9e-1, 7e-1, 3e0, 0.0, 0.0}},
    {.name = "violent, ellipses, velocities",
     .num_axes = 2,
     .measures = RHO_MEASURES_VELOCITY,
     .own_share = 0.2,
     .dt_min = 0.1,
     .dt_max = 0.6,
     .violence = 6.0,
     .by_step = {3e-3, 2e-4, 5e-5, 5e-4, 2e-3, 0.0},
     .by_mean = {1e0, 2e0, 5e-2, 5e-1, 0.0, 0.0}},
    {.name = "ellipses",
     .num_axes = 2,
     .own_share = 1.0,
     .dt_min = 0.1,
     .dt_max = 4.0,
     .by_step = {5e-4, 4e-5, 6e-5, 3e-4, 7e-4, 0.0},
     .by_mean = {2e-2, 2e-1, 4e-3, 2e-2, 0.0, 0.0}},
    {.name = "ellipsoids",
     .num_axes = 3,
     .measures = RHO_MEASURES_Z,
     .own_share = 1.0,
     .dt_min = 0.1,
     .dt_max = 4.0,
     .by_step = {1e-3, 4e-5, 7e-5, 4e-4, 8e-4, 0.0},
     .by_mean = {2e-2, 2e-1, 4e-3, 5e-2, 0.0, 0.0}},
    {.name = "ellipses now and then",
     .num_axes = 2,
     .share_of_z = 0.1,
     .own_share = 0.1,
     .dt_min = 0.1,
     .dt_max = 4.0,
     .offset_s = 0.5,
     .by_step = {2e-1, 2e-1, 4e-5, 3e-4, 4e-4, 0.0},
     .by_mean = {9e-1, 2e1, 5e-1, 2e0, 0.0, 0.0}},
    {.name = "ellipsoids, velocities",
     .num_axes = 3,
     .measures = RHO_MEASURES_Z | RHO_MEASURES_VELOCITY,
     .own_share = 1.0,
     .dt_min = 0.1,
     .dt_max = 4.0,
     .by_step = {3e-3, 8e-4, 2e-4, 4e-4, 8e-4, 0.0},
     .by_mean = {5e-2, 2e-1, 8e-3, 8e-2, 0.0, 0.0}},
    {.name = "range rates",
     .num_axes = 2,
     .measures = RHO_MEASURES_RANGE_RATE,
     .own_share = 0.5,
     .dt_min = 0.1,
     .dt_max = 4.0,
     .by_step = {4e-2, 8e-4, 9e-5, 6e-4, 2e-3, 0.0},
     .by_mean = {2e-2, 3e-1, 2e-2, 2e-1, 0.0, 0.0}},
    {.name = "everything",
     .num_axes = 3,
     .measures = RHO_MEASURES_Z | RHO_MEASURES_VELOCITY | RHO_MEASURES_RANGE_RATE,
     .own_share = 0.5,
     .dt_min = 0.1,
     .dt_max = 4.0,
     .offset_s = 0.5,
     .by_step = {2e-3, 9e-4, 2e-3, 3e-2, 6e-2, 0.0},
     .by_mean = {3e-2, 2e1, 2e-2, 7e-2, 0.0, 0.0}},
    {.name = "range rates, heights later",
     .num_axes = 2,
     .measures = RHO_MEASURES_RANGE_RATE,
     .share_of_z = 0.1,
     .own_share = 0.5,
     .dt_min = 0.1,
     .dt_max = 4.0,
     .by_step = {3e-2, 2e-3, 4e-4, 7e-4, 1e-3, 0.0},
     .by_mean = {2e-1, 1e0, 5e-2, 2e0, 0.0, 0.0}},
    {.name = "bearings",
     .num_axes = 2,
     .own_share = 0.3,
     .dt_min = 0.1,
     .dt_max = 4.0,
     .bearing_share = 0.4,
     .by_step = {6e-4, 2e-5, 3e-4, 9e-4, 5e-4, 0.0},
     .by_mean = {2.2e-2, 6e0, 9e-3, 6e-2, 0.0, 0.0}},
    {.name = "bearings, heights later",
     .num_axes = 2,
     .share_of_z = 0.1,
     .dt_min = 0.1,
     .dt_max = 4.0,
     .bearing_share = 0.2,
     .by_step = {7e-4, 2e-5, 2e-4, 5e-4, 6e-6, 0.0},
     .by_mean = {2e0, 3e0, 2e-1, 2e0, 0.0, 0.0}},
    {.name = "level, two states",
     .num_axes = 2,
     .dt_min = 0.25,
     .dt_max = 4.0,
     .has_two_states = 1,
     .by_step = {2e-5, 7e-6, 8e-7, 5e-6, 8e-6, 0.0},
     .by_mean = {6e-3, 5e-3, 3e-3, 7e-3, 0.0, 0.0}},
};

#define MISSED 0.1 /* share of scans without a plot */
#define SEQUENCES_OF_COURSE 12
#define SCANS_OF_SEQUENCE 60

struct truth {
    double x[6], until_s, accel[3];
};

static struct truth random_truth(double speed_mps)
{
    struct truth truth = {.until_s = 0.0};

    for (int i = 0; i < 3; ++i) {
        truth.x[i] = i < 2 ? uniform(-6e4, 6e4) : uniform(3000.0, 9000.0);
        truth.x[3 + i] = uniform(-0.6, 0.6) * (i < 2 ? speed_mps : 20.0);
    }
    return truth;
}

/* Moves with constant acceleration, which changes now and then and is 0 half of the time. */
static void move_truth(struct truth *truth, double dt, const struct rho_imm_model *model,
                       double violence)
{
    truth->until_s -= dt;
    if (truth->until_s <= 0.0) {
        const double scale =
            uniform(0.0, 1.0) < 0.5 ? 0.0 : 0.5 * violence * model->accel_sigma_mps2;

        for (int i = 0; i < 3; ++i) {
            truth->accel[i] = (i < 2 ? scale : 0.1 * scale) * normal();
        }
        truth->until_s = uniform(2.0, 8.0);
    }
    for (int i = 0; i < 3; ++i) {
        const double most = i < 2 ? model->speed_sigma_mps : 50.0;

        truth->x[i] += dt * truth->x[3 + i] + 0.5 * dt * dt * truth->accel[i];
        truth->x[3 + i] += dt * truth->accel[i];
        if (fabs(truth->x[3 + i]) > most) {
            truth->accel[i] = 0.0;
            truth->x[3 + i] = copysign(most, truth->x[3 + i]);
        }
    }
}

static struct rho_plot random_plot(const struct course *course, const struct truth *truth,
                                   const struct rho_sensor *sensor)
{
    const int has_own = uniform(0.0, 1.0) < course->own_share;
    const double sigma = 10.0 * pow(10.0, uniform(-0.5, 0.5)) / fmax(1.0, course->violence);
    const double rate_d[3] = {truth->x[0] - sensor->x_m, truth->x[1] - sensor->y_m,
                              truth->x[2] - sensor->z_m};
    const double range =
        sqrt(rate_d[0] * rate_d[0] + rate_d[1] * rate_d[1] + rate_d[2] * rate_d[2]);
    struct rho_plot plot = {.sigma_range_m = (float)sigma,
                            .sigma_cross_m = (float)sigma,
                            .sigma_up_m = (float)sigma,
                            .sigma_mps = (float)uniform(1.0, 20.0),
                            .sigma_range_rate_mps = (float)uniform(0.5, 3.0)};
    float *const place[3] = {&plot.x_m, &plot.y_m, &plot.z_m};
    float *const speed[3] = {&plot.vx_mps, &plot.vy_mps, &plot.vz_mps};

    if (has_own) {
        plot.sigma_cross_m *= (float)uniform(1.0, 12.0);
        plot.sigma_up_m *= (float)uniform(1.0, 12.0);
    }
    for (int i = 0; i < 3; ++i) {
        *place[i] = (float)(truth->x[i] + sigma * normal());
        *speed[i] = (float)(truth->x[3 + i] + plot.sigma_mps * normal());
        plot.range_rate_mps += (float)(truth->x[3 + i] * rate_d[i] / range);
    }
    plot.range_rate_mps += (float)(plot.sigma_range_rate_mps * normal());
    return plot;
}

static struct rho_kalman random_first_estimate(const struct truth *truth, int num_axes)
{
    struct rho_kalman kalman;

    rho_kalman_init(&kalman);
    for (int axis = 0; axis < num_axes; ++axis) {
        assert_int_equal(rho_kalman_open_axis(&kalman, axis,
                                              (float)(truth->x[axis] + 20.0 * normal()), 400.0f,
                                              10000.0f),
                         RHO_OK);
        kalman.state[3 + axis] = (float)(truth->x[3 + axis] + 100.0 * normal());
    }
    return kalman;
}

struct pair {
    struct rho_imm_model model;
    struct rho_imm imm;
    struct reference reference; /* follows the whole sequence independently */
    struct reference_worst by_step,
        by_mean; /* by_step: both models after one step; by_mean: the mean of the whole sequence */
    int num_in_gate, num_plots;
};

static void compare_pair(struct pair *pair, const struct reference *same,
                         const struct reference *before)
{
    reference_compare(&pair->imm, same, before, &pair->by_step);
    reference_compare_mean(&pair->imm, &pair->reference, &pair->by_mean);
}

static void predict_pair(struct pair *pair, float dt_s, int is_prediction)
{
    const struct reference before = reference_of(&pair->imm);
    struct reference same = before;
    struct rho_imm_step step;

    rho_imm_prepare_step(&step, &pair->model, dt_s);
    assert_int_equal(is_prediction ? rho_imm_predict(&pair->imm, &step)
                                   : rho_imm_predict_unmixed(&pair->imm, &step),
                     RHO_OK);
    if (is_prediction) {
        const int returns =
            is_manoeuvre_likely_enough_to_mix_back(&pair->model, before.probability);

        reference_predict(&pair->reference, &pair->model, dt_s, returns);
        reference_predict(&same, &pair->model, dt_s, returns);
    } else {
        reference_predict_unmixed(&pair->reference, &pair->model, dt_s);
        reference_predict_unmixed(&same, &pair->model, dt_s);
    }
    compare_pair(pair, &same, &before);
}

static void keep_largest(double *worst, double difference)
{
    *worst = fmax(*worst, fabs(difference));
}

/* Scores and updates the library and both references with a plot, and compares. */
static void update_pair_with_plot(struct pair *pair, const struct rho_plot *plot, uint32_t measures,
                                  const struct rho_sensor *sensor)
{
    const struct reference_plot seen_by_same = {plot, measures, sensor};
    const struct reference before = reference_of(&pair->imm);
    const struct reference_match here = reference_match_plot(&before, &seen_by_same);
    const struct reference_match there = reference_match_plot(&pair->reference, &seen_by_same);
    struct reference same = before;
    struct rho_imm_plot seen;
    struct rho_imm_match match;

    rho_imm_prepare_plot(&seen, plot, measures, sensor);
    pair->num_plots++;
    if (!rho_imm_score_plot(&pair->imm, &seen, &match)) {
        assert_true(here.nearest2 > 0.99 * RHO_IMM_GATE);
        return;
    }
    assert_true(here.nearest2 < 1.01 * RHO_IMM_GATE);
    assert_int_equal(match.num_axes, same.has_z && (measures & RHO_MEASURES_Z) ? 3 : 2);
    assert_int_equal(match.has_velocity, (measures & RHO_MEASURES_VELOCITY) != 0);
    assert_int_equal(match.has_range_rate, (measures & RHO_MEASURES_RANGE_RATE) != 0);
    keep_largest(&pair->by_step.distance2, match.nis - here.nearest2);
    keep_largest(&pair->by_step.log_likelihood, match.log_likelihood - here.log_likelihood);
    keep_largest(&pair->by_mean.log_likelihood, match.log_likelihood - there.log_likelihood);
    pair->num_in_gate++;
    assert_int_equal(rho_imm_update(&pair->imm, &pair->model, &seen, &match), RHO_OK);
    reference_update(&pair->reference, &pair->model, &seen_by_same, there.probability);
    reference_update(&same, &pair->model, &seen_by_same, here.probability);
    compare_pair(pair, &same, &before);
    assert_int_equal(pair->imm.is_coupled, !pair->reference.is_apart);
}

static void update_pair_with_bearing(struct pair *pair, const struct truth *truth,
                                     const struct rho_sensor *from)
{
    const struct reference before = reference_of(&pair->imm);
    const float sigma_rad = (float)uniform(1e-3, 2e-2);
    const float bearing_rad =
        (float)(atan2(truth->x[1] - from->y_m, truth->x[0] - from->x_m) + sigma_rad * normal());
    struct reference same = before;
    float gain_nat = 0.0f;

    assert_int_equal(
        update_imm_by_bearing(&pair->imm, from->x_m, from->y_m, bearing_rad, sigma_rad, &gain_nat),
        RHO_OK);
    keep_largest(&pair->by_step.log_likelihood,
                 gain_nat - reference_update_bearing_and_log_density(&same, from->x_m, from->y_m,
                                                                     bearing_rad, sigma_rad));
    keep_largest(&pair->by_mean.log_likelihood,
                 gain_nat - reference_update_bearing_and_log_density(
                                &pair->reference, from->x_m, from->y_m, bearing_rad, sigma_rad));
    compare_pair(pair, &same, &before);
}

static void follow_course(const struct course *course, struct pair *pair)
{
    const struct rho_sensor sensor = {
        .x_m = (float)uniform(-1e5, 1e5), .y_m = (float)uniform(-1e5, 1e5), .z_m = 50.0f};

    pair->model = random_model();
    if (course->has_two_states) {
        pair->model.calm_s = pair->model.settle_s = 0.0f;
    }
    struct truth truth = random_truth(pair->model.speed_sigma_mps);
    const struct rho_kalman first = random_first_estimate(&truth, course->num_axes);

    rho_imm_start(&pair->imm, &pair->model, &first);
    reference_start(&pair->reference, &pair->model, &first);
    for (int k = 0; k < SCANS_OF_SEQUENCE; ++k) {
        const float dt_s = (float)uniform(course->dt_min, course->dt_max);
        const float offset_s = (float)uniform(-course->offset_s, course->offset_s);
        const uint32_t z = uniform(0.0, 1.0) < course->share_of_z ? RHO_MEASURES_Z : 0;
        const int is_missed = uniform(0.0, 1.0) < MISSED;

        move_truth(&truth, dt_s, &pair->model, fmax(1.0, course->violence));
        predict_pair(pair, dt_s, 1);
        if (is_missed) {
            continue;
        }
        if (uniform(0.0, 1.0) < course->bearing_share) {
            update_pair_with_bearing(pair, &truth, &sensor);
            continue;
        }
        if (course->offset_s > 0.0) { /* to the plot's own time and back */
            struct truth then = truth;

            predict_pair(pair, offset_s, 0);
            for (int i = 0; i < 3; ++i) {
                then.x[i] += offset_s * then.x[3 + i];
            }
            const struct rho_plot plot = random_plot(course, &then, &sensor);
            update_pair_with_plot(pair, &plot, course->measures | z, &sensor);
            predict_pair(pair, -offset_s, 0);
            continue;
        }
        const struct rho_plot plot = random_plot(course, &truth, &sensor);
        update_pair_with_plot(pair, &plot, course->measures | z, &sensor);
    }
}

static void assert_within(const struct reference_worst *worst, const struct reference_worst *bar,
                          double calm)
{
    assert_true(worst->state <= bar->state);
    assert_true(worst->covariance <= bar->covariance);
    assert_true(worst->probability <= bar->probability);
    assert_true(worst->log_likelihood <= bar->log_likelihood);
    assert_true(worst->distance2 <= bar->distance2);
    assert_true(worst->calm <= calm);
}

static void sequences_of_plots_agree_with_the_full_matrix_reference(void **state)
{
    (void)state;
    for (size_t c = 0; c < NUM(courses); ++c) {
        const struct course *course = &courses[c];
        struct pair pair = {.num_plots = 0};

        dense_seed = 7 + c;
        for (int n = 0; n < SEQUENCES_OF_COURSE; ++n) {
            follow_course(course, &pair);
        }
        assert_within(&pair.by_step, &course->by_step,
                      course->has_two_states                         ? 0.0
                      : (course->measures & RHO_MEASURES_RANGE_RATE) ? CALM_BY_RATE
                                                                     : CALM_BY_STEP);
        assert_within(&pair.by_mean, &course->by_mean, course->has_two_states ? 0.0 : CALM_BY_MEAN);
        assert_true(pair.num_in_gate * 10 >= pair.num_plots * 6);
    }
}

/* ---- mixing ---------------------------------------------------------------------------------- */

/* One model is certain or nearly so: shares of the other are tiny, and none may exceed 1. */
static void mixing_agrees_with_the_reference_for_nearly_certain_models(void **state)
{
    static const float probabilities[] = {0.0f,    1e-30f,   1e-8f,       1e-4f, 0.5f,
                                          0.9999f, 0.99999f, 0.99999994f, 1.0f};
    static const float intervals_s[] = {1e-6f, 1e-5f, 2e-5f, 3e-5f, 1e-4f, 1e-2f, 1.0f, 1e3f};
    /* -1: a chain of two states, without calm targets */
    static const float calms[] = {-1.0f, 0.0f, 0.5f, 0.99999994f, 1.0f};
    const size_t num_pairs = NUM(probabilities) * NUM(intervals_s);
    struct reference_worst worst[2] = {{.state = 0.0}}; /* of two states, of three */

    (void)state;
    for (size_t n = 0; n < num_pairs * NUM(calms); ++n) {
        const float calm = calms[n / num_pairs];
        struct rho_imm_model model = model_with_memory(5.0);
        struct truth truth = random_truth(200.0);
        const struct rho_kalman first = random_first_estimate(&truth, 3);
        struct rho_imm imm;
        struct rho_imm_step step;

        model.steady_s = 500.0f;
        model.maneuver_s = n % 2 ? 500.0f : 60.0f;
        if (calm >= 0.0f) {
            model.calm_density = 0.1f;
            model.calm_s = 300.0f;
            model.settle_s = 60.0f;
        }
        rho_imm_start(&imm, &model, &first);
        imm.probability = probabilities[n % NUM(probabilities)];
        imm.calm = calm > 0.0f ? calm : 0.0f;
        imm.state[0] += 30.0f;
        imm.state[4] -= 5.0f;
        imm.state[6] = 40.0f;
        imm.steady.covariance[RHO_AT(0, 0)] *= 0.01f;
        rho_imm_prepare_step(&step, &model, intervals_s[n / NUM(probabilities) % NUM(intervals_s)]);
        const struct reference before = reference_of(&imm);
        struct reference expected = before;

        reference_predict(&expected, &model, step.dt_s,
                          is_manoeuvre_likely_enough_to_mix_back(&model, before.probability));
        assert_int_equal(rho_imm_predict(&imm, &step), RHO_OK);
        assert_float_equal(imm.probability, expected.probability, 2e-7);
        /* share of all targets: as a share of the steady ones it may be rounding alone */
        assert_float_equal((1.0 - expected.probability) * imm.calm,
                           (1.0 - expected.probability) * expected.calm, 3e-7);
        if (step.begins >=
            1e-5f) { /* smaller shares have a large relative error: 3e-8, one rounding of 0.5 */
            reference_compare(&imm, &expected, &before, &worst[calm >= 0.0f]);
        }
    }
    /* largest seen: 6.1e-6, 7.8e-5 */
    assert_true(worst[0].state <= 3e-5 && worst[0].covariance <= 3e-4);
    /* largest seen: 7.6e-5, 1.9e-4 */
    assert_true(worst[1].state <= 2e-4 && worst[1].covariance <= 6e-4);
}

/* ---- coupled and decoupled axes ------------------------------------------------------------- */

/*
 * Steps a decoupled and a coupled filter with the same plots. Only mixing makes them differ: it
 * couples axes in which the models' means are apart.
 */
static void compare_coupled_and_decoupled(struct rho_imm both[2], const struct rho_imm_model *model,
                                          int num_axes, double across,
                                          struct reference_worst *worst)
{
    struct rho_imm_step step;

    rho_imm_prepare_step(&step, model, 0.5f);
    for (int k = 1; k <= 40; ++k) {
        const double t = 0.5 * k;
        const struct rho_plot plot = {.x_m = (float)(4000.0 + 200.0 * t + 5.0 * normal()),
                                      .y_m =
                                          (float)(across * (300.0 * sin(0.3 * t) + 5.0 * normal())),
                                      .z_m = (float)(2000.0 + across * 5.0 * normal()),
                                      .sigma_range_m = 5.0f,
                                      .sigma_cross_m = 5.0f,
                                      .sigma_up_m = 5.0f};
        struct rho_imm_match match[2];
        struct rho_kalman estimate[2];
        struct rho_imm_plot seen;

        rho_imm_prepare_plot(&seen, &plot, num_axes == 3 ? RHO_MEASURES_Z : 0, NULL);
        for (int i = 0; i < 2; ++i) {
            assert_int_equal(rho_imm_predict(&both[i], &step), RHO_OK);
            assert_true(rho_imm_score_plot(&both[i], &seen, &match[i]));
            assert_int_equal(rho_imm_update(&both[i], model, &seen, &match[i]), RHO_OK);
            rho_imm_estimate(&both[i], &estimate[i], NULL);
        }
        keep_largest(&worst->log_likelihood, match[0].log_likelihood - match[1].log_likelihood);
        keep_largest(&worst->probability, match[0].probability - match[1].probability);
        for (int i = 0; i < 3 + num_axes; ++i) {
            const double sigma = sqrt(estimate[1].covariance[RHO_AT(i, i)]);

            if (sigma > 0.0) {
                keep_largest(&worst->state, (estimate[0].state[i] - estimate[1].state[i]) / sigma);
            }
        }
    }
    assert_false(both[0].is_coupled);
    assert_true(both[1].is_coupled);
}

static void compare_paths_of_targets(double across, struct reference_worst *worst)
{
    struct rho_imm_model model;

    rho_imm_model_default(&model, 30.0f, 300.0f);
    for (int n = 0; n < 40; ++n) {
        const int num_axes = 2 + n % 2;
        struct rho_imm both[2];
        struct rho_kalman first;

        rho_kalman_init(&first);
        for (int axis = 0; axis < num_axes; ++axis) {
            assert_int_equal(rho_kalman_open_axis(&first, axis,
                                                  axis == 0   ? 4000.0f
                                                  : axis == 1 ? 0.0f
                                                              : 2000.0f,
                                                  25.0f, 2500.0f),
                             RHO_OK);
        }
        first.state[3] = 200.0f;
        first.state[4] = (float)(90.0 * across);
        rho_imm_start(&both[0], &model, &first);
        both[1] = both[0];
        both[1].is_coupled = 1;
        compare_coupled_and_decoupled(both, &model, num_axes, across, worst);
    }
}

/*
 * For motion along one axis both filters agree. For a turning target mixing couples x and y in the
 * coupled filter: the largest differences are 0.44 sigmas, 0.3 of probability, 0.62 nat.
 */
static void the_decoupled_filter_equals_the_coupled_one_for_motion_along_an_axis(void **state)
{
    struct reference_worst straight = {.state = 0.0}, slanted = straight;

    (void)state;
    compare_paths_of_targets(0.0, &straight);
    compare_paths_of_targets(1.0, &slanted);
    assert_true(straight.state <= 1e-3 && straight.probability <= 1e-3);
    assert_true(straight.log_likelihood <= 1e-3);
    assert_true(slanted.state <= 0.7 && slanted.probability <= 0.45);
    assert_true(slanted.log_likelihood <= 1.0);
}

/* A gate prepared for many plots of equal noise gives the score of each plot by itself. */
static void a_prepared_gate_scores_as_a_single_plot_does(void **state)
{
    int num_in_gate = 0;

    (void)state;
    for (int n = 0; n < 3000; ++n) {
        const struct rho_imm_model model = random_model();
        const uint32_t measures = n % 3 ? RHO_MEASURES_Z : 0u;
        struct truth truth = random_truth(model.speed_sigma_mps);
        const struct rho_kalman first = random_first_estimate(&truth, 2 + n % 2);
        const float sigma_m = (float)pow(10.0, uniform(-1.0, 1.5));
        const float less = n % 4 ? 1e-4f : 1.0f;
        struct rho_imm_gate gate;
        struct rho_imm_step step;
        struct rho_imm imm;

        rho_imm_prepare_step(&step, &model, (float)pow(10.0, uniform(-2.0, 0.5)));
        rho_imm_start(&imm, &model, &first);
        imm.probability = (float)uniform(0.0, 1.0);
        for (int i = 0; i < 45; ++i) {
            imm.covariance[i] *= less;
            imm.steady.covariance[i % 21] *= i < 21 ? less : 1.0f;
        }
        assert_int_equal(rho_imm_predict(&imm, &step), RHO_OK);
        assert_true(rho_imm_prepare_gate(&gate, &imm, sigma_m * sigma_m, measures != 0));
        for (int k = 0; k < 5; ++k) {
            const double reach = 4.0 * k * sqrt(imm.covariance[0] + sigma_m * sigma_m) / 3.0;
            const struct rho_plot plot = {.x_m = imm.state[0] + (float)(reach * normal()),
                                          .y_m = imm.state[1] + (float)(reach * normal()),
                                          .z_m = imm.state[2] + (float)(reach * normal()),
                                          .sigma_range_m = sigma_m,
                                          .sigma_cross_m = sigma_m,
                                          .sigma_up_m = sigma_m};
            struct rho_imm_match one;
            struct rho_imm_plot seen;
            float log_likelihood, probability;

            rho_imm_prepare_plot(&seen, &plot, measures, NULL);
            const float *place_m = seen.position.place_m;
            const int is_near = rho_imm_score_plot(&imm, &seen, &one);
            assert_int_equal(
                rho_imm_score_in_gate(&gate, place_m, -FLT_MAX, &log_likelihood, &probability),
                is_near);
            if (!is_near) {
                continue;
            }
            assert_float_equal(log_likelihood, one.log_likelihood, 2e-5);
            assert_float_equal(probability, one.probability, 1e-5);
            assert_int_equal(gate.num_axes, one.num_axes);
            assert_true(one.has_velocity == 0 && one.has_range_rate == 0);
            /* with a limit: a likelier plot always has a score, one less likely by ln 2 never */
            assert_true(rho_imm_score_in_gate(&gate, place_m, nextafterf(log_likelihood, -INFINITY),
                                              &log_likelihood, &probability));
            assert_false(rho_imm_score_in_gate(&gate, place_m, log_likelihood + 0.694f,
                                               &log_likelihood, &probability));
            num_in_gate++;
        }
        imm.is_coupled = 1;
        assert_false(rho_imm_prepare_gate(&gate, &imm, sigma_m * sigma_m, measures != 0));
    }
    assert_true(num_in_gate > 3000);
}

/* ---- first estimates, bearings, range rates ------------------------------------------------- */

static void both_models_start_from_the_given_estimate(void **state)
{
    (void)state;
    for (int n = 0; n < 200; ++n) {
        const struct rho_imm_model model = random_model();
        struct rho_kalman first, mean;
        struct rho_imm imm;
        float accel_mps2[3] = {7.0f, 7.0f, 7.0f};

        random_covariance(first.covariance, 2.0);
        for (int i = 0; i < 6; ++i) {
            first.state[i] = (float)(100.0 * normal());
        }
        rho_imm_start(&imm, &model, &first);
        assert_true(imm.is_coupled && imm.probability == 0.5f);
        assert_memory_equal(&imm.steady, &first, sizeof first);
        assert_memory_equal(imm.state, first.state, sizeof first.state);
        for (int i = 6; i < 9; ++i) {
            assert_true(imm.state[i] == 0.0f);
            for (int j = 0; j <= i; ++j) {
                assert_float_equal(imm.covariance[RHO_AT(i, j)],
                                   i == j ? pow(model.accel_sigma_mps2, 2) : 0.0,
                                   1e-6 * pow(model.accel_sigma_mps2, 2) + 1e-8);
            }
        }
        rho_imm_estimate(&imm, &mean, accel_mps2);
        assert_memory_equal(mean.state, first.state, sizeof first.state);
        assert_true(accel_mps2[0] == 0.0f && accel_mps2[1] == 0.0f && accel_mps2[2] == 0.0f);
    }
}

/* Covariances within an axis do not couple the filter, any one between axes does. */
static void one_covariance_between_axes_makes_the_filter_coupled(void **state)
{
    const struct rho_imm_model model = model_with_memory(5.0);

    (void)state;
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < i; ++j) {
            struct rho_kalman first = {.state = {0.0f}, .covariance = {0.0f}};
            struct rho_imm imm;

            for (int k = 0; k < 6; ++k) {
                first.covariance[RHO_AT(k, k)] = 100.0f;
            }
            first.covariance[RHO_AT(i, j)] = i % 2 ? -1.0f : 1.0f;
            rho_imm_start(&imm, &model, &first);
            assert_int_equal(imm.is_coupled, i % 3 != j % 3);
        }
    }
}

/* Also near the sensor, where the line of sight is uncertain. */
static void predicted_range_rates_agree_with_the_kalman_filters(void **state)
{
    const struct rho_sensor sensor = {
        .sensor_id = 1, .x_m = 300.0f, .y_m = -200.0f, .z_m = 40.0f, .range_max_m = 1e6f};
    struct rho_imm_model model = random_model();

    (void)state;
    for (int n = 0; n < 500; ++n) {
        struct rho_kalman at;
        struct rho_imm imm;
        struct rho_imm_rates rates;
        struct rho_kalman_row row;
        float projected[RHO_KALMAN_STATES];
        const float range_m = (float)pow(10.0, uniform(1.5, 4.0));
        rho_kalman_init(&at);
        for (int axis = 0; axis < 2; ++axis) {
            assert_int_equal(rho_kalman_open_axis(&at, axis, range_m, 0.04f * range_m * range_m,
                                                  (float)uniform(10.0, 1e4)),
                             RHO_OK);
            at.state[3 + axis] = (float)uniform(-300.0, 300.0);
        }
        at.covariance[RHO_AT(1, 0)] = (float)uniform(-0.03, 0.03) * range_m * range_m;
        at.covariance[RHO_AT(4, 0)] = (float)uniform(-0.1, 0.1) * range_m;
        at.covariance[RHO_AT(4, 3)] = (float)uniform(-8.0, 8.0);
        rho_imm_start(&imm, &model, &at);
        rho_imm_predict_range_rates(&rates, &imm, &sensor);
        assert_true(rho_kalman_linearise_rate(&at, &sensor, 0.0f, FLT_MIN, &row));
        const float variance =
            row.variance + rho_linalg_project6(at.covariance, row.row, projected);
        for (int i = 0; i < 2; ++i) {
            assert_true(fabsf(rates.expected_mps[i] + row.innovation) <= 1e-3f);
            assert_true(fabsf(rates.variance[i] - variance) <= 1e-4f * variance);
            for (int k = 0; k < RHO_KALMAN_STATES; ++k) {
                assert_true(fabsf(rates.projected[i][k] - projected[k]) <=
                            1e-4f * sqrtf(variance * at.covariance[RHO_AT(k, k)]));
            }
        }
    }
}

static void a_bearing_from_the_targets_place_changes_nothing(void **state)
{
    const struct rho_imm_model model = model_with_memory(5.0);
    struct truth truth = random_truth(200.0);
    const struct rho_kalman first = random_first_estimate(&truth, 2);
    struct rho_bearing_mix mixes[2] = {{.hit = 0.0f}, {.hit = 0.0f}};
    struct one_bearing at;
    float gain_nat, density, variance_rad2;
    struct rho_imm imm;

    (void)state;
    rho_imm_start(&imm, &model, &first);
    const struct rho_imm before = imm;
    const struct rho_weighed_bearings *look =
        one_bearing_in_row(&at, 0, 0, first.state[0], first.state[1], 0.3f, 0.01f, 0.5f);
    assert_int_equal(rho_imm_score_bearing(&imm, look, 0, &density, &variance_rad2), 0);
    rho_imm_mix_bearing(&imm, look, 0, mixes);
    assert_int_equal(rho_imm_update_bearings(&imm, look, mixes, &gain_nat), RHO_OK);
    assert_float_equal(gain_nat, (float)log(0.5), 1e-6f); /* that of a miss */
    assert_memory_equal(&imm, &before, sizeof imm);
}

/*
 * Compares the scores of a plot with a range rate, with and without rates prepared for its sensor.
 */
static void scores_with_prepared_range_rates_equal_scores_without(void **state)
{
    const struct rho_imm_model model = model_with_memory(5.0);
    const struct rho_sensor sensor = {.x_m = -300.0f, .y_m = 40.0f};
    int num_near = 0;

    (void)state;
    for (int n = 0; n < 200; ++n) {
        struct rho_kalman at;
        struct rho_imm imm;
        struct rho_imm_rates rates;
        struct rho_imm_match one, other;
        struct rho_imm_plot seen;

        rho_kalman_init(&at);
        for (int axis = 0; axis < 2; ++axis) {
            assert_int_equal(rho_kalman_open_axis(&at, axis, 5000.0f, 400.0f, 100.0f), RHO_OK);
            at.state[3 + axis] = (float)uniform(-100.0, 100.0);
        }
        const struct rho_plot plot = {.x_m = (float)(5000.0 + 40.0 * normal()),
                                      .y_m = (float)(5000.0 + 40.0 * normal()),
                                      .range_rate_mps = (float)uniform(-140.0, 140.0),
                                      .sigma_range_m = 20.0f,
                                      .sigma_cross_m = 30.0f,
                                      .sigma_up_m = 20.0f,
                                      .sigma_range_rate_mps = 2.0f};
        rho_imm_start(&imm, &model, &at);
        rho_imm_predict_range_rates(&rates, &imm, &sensor);
        rho_imm_prepare_plot(&seen, &plot, RHO_MEASURES_RANGE_RATE, &sensor);
        const int is_near = rho_imm_score_plot(&imm, &seen, &one);
        assert_int_equal(rho_imm_score_with_rates(&imm, &rates, &seen, &other), is_near);
        if (is_near) {
            assert_float_equal(one.log_likelihood, other.log_likelihood, 1e-3);
            assert_float_equal(one.probability, other.probability, 1e-4);
            num_near++;
        }
    }
    assert_in_range(num_near, 20, 180);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_agree_with_singers_model_and_the_markov_chain),
        cmocka_unit_test(two_short_steps_equal_one_long_step),
        cmocka_unit_test(a_step_backwards_is_the_inverse_without_noise),
        cmocka_unit_test(a_step_of_no_time_changes_nothing),
        cmocka_unit_test(sequences_of_plots_agree_with_the_full_matrix_reference),
        cmocka_unit_test(mixing_agrees_with_the_reference_for_nearly_certain_models),
        cmocka_unit_test(the_decoupled_filter_equals_the_coupled_one_for_motion_along_an_axis),
        cmocka_unit_test(a_prepared_gate_scores_as_a_single_plot_does),
        cmocka_unit_test(both_models_start_from_the_given_estimate),
        cmocka_unit_test(one_covariance_between_axes_makes_the_filter_coupled),
        cmocka_unit_test(predicted_range_rates_agree_with_the_kalman_filters),
        cmocka_unit_test(a_bearing_from_the_targets_place_changes_nothing),
        cmocka_unit_test(scores_with_prepared_range_rates_equal_scores_without),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
