/* SPDX-License-Identifier: MIT */
/*
 * The scenes of the maneuver experiment: paths, noise, misses, and clutter around where the beam
 * looks.
 */
#include <math.h>
#include <string.h>

#include "experiment_maneuver.h"
#include "rhotrack/measurement.h"

#define PI 3.141592653589793
#define HALF_BEAM_RAD (0.6 * PI / 180.0)
#define INTERVAL_US 250000
#define START_SIGMA 22.360679774997898 /* root of the paper's 500: P(0|0) */
#define CLUTTER_STREAM 100000          /* beside the scene's */
#define CLUTTER_FLOOR 0.1              /* plots that a scan without clutter counts as having */

static const double start_m[3] = {50e3, 35e3, 300.0};
static const double start_mps[3] = {-600.0, -500.0, 0.0};

int64_t maneuver_time_us(size_t scan)
{
    return (int64_t)scan * INTERVAL_US;
}

unsigned maneuver_axes(const struct maneuver_setting *setting)
{
    return setting->sensor == MANEUVER_POLAR ? 2 : 3;
}

uint32_t maneuver_measures(const struct maneuver_setting *setting)
{
    uint32_t measures = maneuver_axes(setting) == 3 ? RHO_MEASURES_Z : 0;
    return setting->sensor == MANEUVER_VELOCITIES ? measures | RHO_MEASURES_VELOCITY : measures;
}

static double norm(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* ---- the truth ------------------------------------------------------------------------------- */

/* The velocity of a target that flies as planned. A turn keeps its speed. */
static void fly_as_planned(double velocity_mps[3], enum maneuver_profile profile,
                           const double accel_mps2[3], double t_s)
{
    if (profile != MANEUVER_TURN) {
        for (int i = 0; i < 3; i++) {
            velocity_mps[i] += accel_mps2[i] * MANEUVER_INTERVAL_S;
        }
        return;
    }
    double angle_rad = maneuver_side(profile, t_s) * norm(accel_mps2) * MANEUVER_INTERVAL_S /
                       hypot(velocity_mps[0], velocity_mps[1]);
    double x_mps = velocity_mps[0], y_mps = velocity_mps[1];
    velocity_mps[0] = cos(angle_rad) * x_mps - sin(angle_rad) * y_mps;
    velocity_mps[1] = sin(angle_rad) * x_mps + cos(angle_rad) * y_mps;
}

static void draw_inputs(struct maneuver_scene *scene)
{
    const struct maneuver_setting *of = scene->of;
    double velocity_mps[3];
    memcpy(velocity_mps, start_mps, sizeof velocity_mps);
    for (size_t scan = 0; scan < MANEUVER_SCANS; scan++) {
        double t_s = (double)scan * MANEUVER_INTERVAL_S;
        maneuver_accel(of->profile, t_s, of->pull_g * MANEUVER_G_MPS2, start_mps, velocity_mps,
                       scene->input_mps2[scan]);
        fly_as_planned(velocity_mps, of->profile, scene->input_mps2[scan], t_s);
    }
}

static void move(const struct maneuver_setting *of, const double from[6],
                 const double input_mps2[3], double to[6], struct random *random)
{
    const double t_s = MANEUVER_INTERVAL_S;
    for (unsigned i = 0; i < 3; i++) {
        double place_noise, velocity_noise,
            accel_mps2 = i < maneuver_axes(of) ? input_mps2[i] : 0.0;
        if (of->truth == MANEUVER_LITERAL) {
            place_noise = sqrt(of->noise) * random_normal(random);
            velocity_noise = sqrt(of->noise) * random_normal(random);
        } else {
            double noise_mps2 = of->noise * random_normal(random) * (i < maneuver_axes(of));
            place_noise = (accel_mps2 + noise_mps2) * t_s * t_s / 2.0;
            velocity_noise = noise_mps2 * t_s;
        }
        to[i] = from[i] + t_s * from[i + 3] + place_noise;
        to[i + 3] = from[i + 3] + accel_mps2 * t_s + velocity_noise;
    }
}

static void draw_truth(struct maneuver_scene *scene, struct random *random)
{
    memcpy(scene->truth[0], start_m, sizeof start_m);
    memcpy(scene->truth[0] + 3, start_mps, sizeof start_mps);
    if (maneuver_axes(scene->of) == 2) {
        scene->truth[0][2] = 0.0;
    }
    for (size_t scan = 0; scan < MANEUVER_SCANS; scan++) {
        if (scan > 0) {
            move(scene->of, scene->truth[scan - 1], scene->input_mps2[scan - 1], scene->truth[scan],
                 random);
        }
        scene->radius_m[scan] = norm(scene->truth[scan]) * sin(HALF_BEAM_RAD);
    }
}

/* ---- what is measured ------------------------------------------------------------------------ */

static bool is_polar(const struct maneuver_setting *setting)
{
    return setting->sensor == MANEUVER_POLAR || setting->sensor == MANEUVER_POLAR_3D;
}

static double elevation_of(const struct maneuver_setting *of, const double place_m[3])
{
    return maneuver_axes(of) == 3 ? atan2(place_m[2], hypot(place_m[0], place_m[1])) : 0.0;
}

/*
 * The mean of what noisy angles say falls short by cos's mean, exp(-sigma^2 / 2) an angle: it is
 * taken out again, in the plane and of the height.
 */
static void measure_polar(const struct maneuver_setting *of, const double truth[6], double out[6],
                          struct random *random)
{
    double range_m = norm(truth) + of->sigma_m * random_normal(random);
    double azimuth_rad = atan2(truth[1], truth[0]) + of->sigma_rad * random_normal(random);
    double elevation_rad = elevation_of(of, truth),
           short_of = exp(-of->sigma_rad * of->sigma_rad / 2.0);
    double ground_m = range_m / short_of, height_m = 0.0;
    if (maneuver_axes(of) == 3) {
        elevation_rad += of->sigma_rad * random_normal(random);
        height_m = range_m * sin(elevation_rad) / short_of;
        ground_m *= cos(elevation_rad) / short_of;
    }
    out[0] = ground_m * cos(azimuth_rad);
    out[1] = ground_m * sin(azimuth_rad);
    out[2] = height_m;
    out[3] = out[4] = out[5] = 0.0;
}

static void measure(const struct maneuver_setting *of, const double truth[6], double out[6],
                    struct random *random)
{
    if (is_polar(of)) {
        measure_polar(of, truth, out, random);
        return;
    }
    for (int i = 0; i < 3; i++) {
        out[i] = truth[i] + of->sigma_m * random_normal(random);
        out[i + 3] = truth[i + 3] + of->sigma_mps * random_normal(random);
    }
}

void maneuver_scene_draw(struct maneuver_scene *scene, const struct maneuver_setting *of,
                         uint64_t seed, uint64_t stream, uint64_t run)
{
    struct random random = random_start(seed, stream, run);
    *scene = (struct maneuver_scene){.of = of, .seed = seed, .stream = stream, .run = run};
    draw_inputs(scene);
    draw_truth(scene, &random);
    for (size_t scan = 0; scan < MANEUVER_SCANS; scan++) {
        measure(of, scene->truth[scan], scene->measured[scan], &random);
        scene->is_seen[scan] = random_uniform(&random) < of->pd || scan < MANEUVER_CLEAN_SCANS;
    }
}

static bool is_always_seen(const struct maneuver_scene *scene, size_t scan)
{
    return scan < MANEUVER_CLEAN_SCANS || scene->of->beam != MANEUVER_AT_PREDICTION;
}

bool maneuver_is_in_beam(const struct maneuver_scene *scene, size_t scan, const double centre_m[3])
{
    double off_m[3] = {0.0, 0.0, 0.0};
    for (unsigned i = 0; i < maneuver_axes(scene->of); i++) {
        off_m[i] = scene->truth[scan][i] - centre_m[i];
    }
    return norm(off_m) <= scene->radius_m[scan] || is_always_seen(scene, scan);
}

/* ---- the target's plot ----------------------------------------------------------------------- */

/* R in axes along, cross and up of the true line of sight, turned to x, y, z. */
static void true_covariance(const struct maneuver_setting *of, const double truth[6],
                            double covariance[6][6])
{
    double range_m = norm(truth), across_m = range_m * of->sigma_rad;
    double a = atan2(truth[1], truth[0]), e = elevation_of(of, truth);
    const double frame[3][3] = {{cos(e) * cos(a), cos(e) * sin(a), sin(e)},
                                {-sin(a), cos(a), 0.0},
                                {-sin(e) * cos(a), -sin(e) * sin(a), cos(e)}};
    const double variance_m2[3] = {of->sigma_m * of->sigma_m, across_m * across_m,
                                   across_m * across_m};
    for (unsigned i = 0; i < maneuver_axes(of); i++) {
        for (unsigned j = 0; j < maneuver_axes(of); j++) {
            for (unsigned k = 0; k < maneuver_axes(of); k++) {
                covariance[i][j] += variance_m2[k] * frame[k][i] * frame[k][j];
            }
        }
    }
}

struct double_measured maneuver_measured(const struct maneuver_scene *scene, size_t scan)
{
    const struct maneuver_setting *of = scene->of;
    struct double_measured measured = {
        .size = of->sensor == MANEUVER_VELOCITIES ? 6 : maneuver_axes(of)};
    memcpy(measured.value, scene->measured[scan], sizeof measured.value);
    if (is_polar(of)) {
        true_covariance(of, scene->truth[scan], measured.covariance);
        return measured;
    }
    for (int i = 0; i < 3; i++) {
        measured.covariance[i][i] = of->sigma_m * of->sigma_m;
        measured.covariance[i + 3][i + 3] = of->sigma_mps * of->sigma_mps;
    }
    return measured;
}

static struct rho_plot plot_at(const struct maneuver_setting *of, const double state[6])
{
    double across_m = is_polar(of) ? norm(state) * of->sigma_rad : of->sigma_m;
    return (struct rho_plot){.x_m = (float)state[0],
                             .y_m = (float)state[1],
                             .z_m = (float)state[2],
                             .vx_mps = (float)state[3],
                             .vy_mps = (float)state[4],
                             .vz_mps = (float)state[5],
                             .sigma_range_m = (float)of->sigma_m,
                             .sigma_cross_m = (float)across_m,
                             .sigma_up_m = (float)across_m,
                             .sigma_mps = (float)of->sigma_mps};
}

/* The paper starts with P(0|0) = 500 I: its first plot says so of itself. */
struct rho_plot maneuver_plot(const struct maneuver_scene *scene, size_t scan)
{
    struct rho_plot plot = plot_at(scene->of, scene->measured[scan]);
    if (scan == 0 && scene->of->truth == MANEUVER_LITERAL) {
        plot.sigma_range_m = plot.sigma_cross_m = plot.sigma_up_m = (float)START_SIGMA;
        plot.sigma_mps = (float)START_SIGMA;
    }
    return plot;
}

/* ---- clutter --------------------------------------------------------------------------------- */

/* Uniform in the unit sphere, or disc. */
static void draw_within(unsigned axes, double at[3], struct random *random)
{
    do {
        at[2] = 0.0;
        for (unsigned i = 0; i < axes; i++) {
            at[i] = random_between(random, -1.0, 1.0);
        }
    } while (norm(at) > 1.0);
}

static struct rho_plot clutter_plot(const struct maneuver_scene *scene, size_t scan,
                                    const double centre_m[3], const double previous_m[3],
                                    struct random *random)
{
    double at[3], state[6];
    draw_within(maneuver_axes(scene->of), at, random);
    for (int i = 0; i < 3; i++) {
        state[i] = centre_m[i] + scene->radius_m[scan] * at[i];
        state[i + 3] = (state[i] - previous_m[i]) / MANEUVER_INTERVAL_S;
    }
    return plot_at(scene->of, state);
}

void maneuver_look_fill(struct maneuver_look *look, const struct maneuver_scene *scene, size_t scan,
                        const double centre_m[3], const double previous_m[3])
{
    struct random random = random_start(scene->seed, scene->stream + CLUTTER_STREAM,
                                        scene->run * MANEUVER_SCANS + scan);
    unsigned clutter = scan < MANEUVER_CLEAN_SCANS ? 0 : scene->of->clutter, count = 0;
    bool is_seen = scene->is_seen[scan] && maneuver_is_in_beam(scene, scan, centre_m);
    unsigned row = (unsigned)random_below(&random, clutter + 1);
    for (unsigned i = 0; i < clutter; i++) {
        count += is_seen && i == row;
        look->plots[count++] = clutter_plot(scene, scan, centre_m, previous_m, &random);
    }
    look->target_row = is_seen ? (int)row : -1;
    if (is_seen) {
        look->plots[row] = maneuver_plot(scene, scan);
    }
    look->scan = (struct rho_scan){.time_us = maneuver_time_us(scan),
                                   .measures = maneuver_measures(scene->of),
                                   .num_plots = clutter + is_seen,
                                   .plots = look->plots};
}

double maneuver_log_density(const struct maneuver_scene *scene, size_t scan)
{
    const struct maneuver_setting *of = scene->of;
    double radius = scene->radius_m[scan], count = fmax((double)of->clutter, CLUTTER_FLOOR);
    double space =
        maneuver_axes(of) == 3 ? 4.0 / 3.0 * PI * pow(radius, 3.0) : PI * radius * radius;
    if (of->sensor == MANEUVER_VELOCITIES) {
        space *= 4.0 / 3.0 * PI * pow(radius / MANEUVER_INTERVAL_S, 3.0);
    }
    return log(count / space);
}
